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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_text_that_the_window_shows_has_a_translation),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
