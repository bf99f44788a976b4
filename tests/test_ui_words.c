/* The window's words: all that it can show is led past, and each text of the program's own has a German one. */
#include "test.h"

#include "window_walk.h"

#define MISSED_MOST 4000

/* Texts of the program itself: not what was put together out of them, and not the user's. */
extern const char __executable_start[], _end[];

static struct {
    const char *text[MISSED_MOST];
    int count, asked;
} missed;

static bool has_words(const char *text)
{
    for (const char *c = text; *c; c++)
        if (((*c | 32) >= 'a' && (*c | 32) <= 'z') && ((c[1] | 32) >= 'a' && (c[1] | 32) <= 'z'))
            return true;
    return false;
}

static void note(const char *english)
{
    missed.asked++;
    if (english < __executable_start || english >= _end || !has_words(english)) return;
    for (int i = 0; i < missed.count; i++)
        if (strcmp(missed.text[i], english) == 0) return;
    if (missed.count < MISSED_MOST) missed.text[missed.count++] = english;
}

static void print_text(const char *text)
{
    printf("no German text: \"");
    for (const char *c = text; *c; c++) {
        if (*c == '\n') printf("\\n");
        else if (*c == '"' || *c == '\\') printf("\\%c", *c);
        else putchar(*c);
    }
    printf("\"\n");
}

static void every_text_that_the_window_shows_has_a_translation(void **state)
{
    (void)state;
    Walk walk;
    walk_open(&walk, "de");
    if (strcmp(wr_words_language(), "de") != 0) { /* built without msgfmt */
        walk_close(&walk);
        skip();
    }
    missed.count = missed.asked = 0;
    wr_words_missed = note;
    walk_all(&walk);
    wr_words_missed = NULL;
    walk_close(&walk);
    for (int i = 0; i < missed.count; i++) print_text(missed.text[i]);
    assert_int_equal(missed.count, 0);
    assert_true(missed.asked > 1000); /* numbers and names were among what was asked for */
}

/* ---- room ---- */

static struct {
    Walk *walk;
    char text[200][80]; /* told once each */
    int count, told;
} cuts;

static void note_cut(const char *text, double width, double room)
{
    const Walk *walk = cuts.walk;
    char short_text[80];
    snprintf(short_text, sizeof short_text, "%.79s", text);
    cuts.count++;
    for (int i = 0; i < cuts.told; i++)
        if (strcmp(cuts.text[i], short_text) == 0) return;
    if (cuts.told < 200) memcpy(cuts.text[cuts.told++], short_text, sizeof short_text);
    printf("cut in %s, %s, %d x %d at %g: \"%s\" is %.0f of %.0f pixels\n", wr_words_language(),
           walk->where, walk->app->width, walk->app->height, wr_gui_scale(), text, width, room);
}

static void no_text_is_cut(void **state)
{
    (void)state;
    static const char *const languages[] = { "en", "de" };
    static const double scales[] = { 0.75, 1, 1.25, 1.5, 2, 3 };
    static const int sizes[][2] = {
        { 1280, 720 }, { 1366, 768 }, { 1440, 900 }, { 1920, 1080 }, { 3840, 2160 }
    };
    int total = 0;
    for (int l = 0; l < 2; l++) {
        WrError err;
        Walk walk;
        walk_open(&walk, languages[l]);
        cuts.walk = &walk;
        cuts.count = cuts.told = 0;
        for (int s = 0; s < 6; s++) {
            if (!wr_gui_set_scale(walk.app->gui, scales[s], &err)) fail_msg("%s", err.text);
            for (int k = 0; k < 5; k++) {
                if (sizes[k][0] < 900 * scales[s] || sizes[k][1] < 500 * scales[s]) continue;
                SDL_SetWindowSize(walk.app->window, sizes[k][0], sizes[k][1]);
                walk_show(&walk, "%s", "the first picture");
                wr_gui_cut = note_cut;
                const bool narrow = k == 0 || sizes[k - 1][0] < 900 * scales[s];
                if (narrow) walk_all(&walk);
                else walk_tabs(&walk), walk_tools(&walk);
                wr_gui_cut = NULL;
            }
        }
        walk_close(&walk);
        total += cuts.count;
    }
    assert_int_equal(total, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_text_that_the_window_shows_has_a_translation),
        cmocka_unit_test(no_text_is_cut),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
