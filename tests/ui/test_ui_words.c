/* Translations of the window: a walk through all its texts; each text of the program must have one in every language. */
#include "test.h"

#include "window_walk.h"

#include "command/command_table.h"

#include "render/plan/plan.h"
#include "shade/reflection.h"
#include "ui/app/registry_list.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/keys.h"
#include "ui/panels/panel_search.h"

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define TEXTS_MAX 16000
#define SEEN 65536

/* True for texts of the program itself: not composed ones, and not the user's. */
extern const char __executable_start[], _end[];

static struct {
    const char *text[TEXTS_MAX];
    int count, asked;
    const char *seen[SEEN]; /* hash table of addresses: most texts are requested in every frame */
} requests;

static const char *lacking; /* the text that a language lacks */

static bool has_words(const char *text)
{
    for (const char *c = text; *c; c++)
        if (((*c | 32) >= 'a' && (*c | 32) <= 'z') && ((c[1] | 32) >= 'a' && (c[1] | 32) <= 'z'))
            return true;
    return false;
}

static void note(const char *english)
{
    requests.asked++;
    if (english < __executable_start || english >= _end || !has_words(english)) return;
    size_t at = (uintptr_t)english % SEEN;
    while (requests.seen[at] && requests.seen[at] != english) at = (at + 1) % SEEN;
    if (requests.seen[at]) return;
    assert_true(requests.count < TEXTS_MAX);
    requests.seen[at] = requests.text[requests.count++] = english;
}

static void note_lacking(const char *english)
{
    lacking = english;
}

static void print_text(const char *text)
{
    printf("no text in %s: \"", wr_words_language());
    for (const char *c = text; *c; c++) {
        if (*c == '\n') printf("\\n");
        else if (*c == '"' || *c == '\\') printf("\\%c", *c);
        else putchar(*c);
    }
    printf("\"\n");
}

/* 1 if the present language has no translation of a text. */
static int lacks(const char *english)
{
    lacking = NULL;
    wr_words_missed = note_lacking;
    wr_words(english);
    wr_words_missed = NULL;
    if (lacking) print_text(lacking);
    return lacking != NULL;
}

/* Chooses a translation of the table; false: English, or a build without msgfmt. */
static bool speaks(int language)
{
    wr_words_choose(language);
    return language > 0 && strcmp(wr_words_language(), "en") != 0 &&
           strcmp(wr_words_language(), wr_languages[language].code) == 0;
}

static void every_text_that_the_window_shows_has_a_translation(void **state)
{
    (void)state;
    Walk walk;
    int missing = 0, languages = 0;
    memset(&requests, 0, sizeof requests);
    walk_open(&walk, "de");
    wr_words_requested = note;
    walk_all(&walk);
    wr_words_requested = NULL;
    walk_close(&walk);
    for (int l = 0; l < wr_language_count; l++) {
        if (!speaks(l)) continue;
        languages++;
        for (int i = 0; i < requests.count; i++) missing += lacks(requests.text[i]);
    }
    if (languages == 0) skip();
    assert_int_equal(languages, wr_language_count - 2); /* not the system's, not English */
    assert_int_equal(missing, 0);
    assert_true(requests.count > 1000);
    assert_true(requests.asked > 10 * requests.count);
}

/* Page titles are read from files, so the walk does not recognise them as texts of the program. */
static void every_page_of_the_guide_has_a_title_in_every_language(void **state)
{
    (void)state;
    DIR *folder = opendir(WR_SOURCE_DIR "/ui/guide");
    assert_non_null(folder);
    int pages = 0, missing = 0;
    for (const struct dirent *file; (file = readdir(folder));) {
        char path[600], line[200] = "";
        if (!strstr(file->d_name, ".md")) continue;
        snprintf(path, sizeof path, WR_SOURCE_DIR "/ui/guide/%s", file->d_name);
        FILE *page = fopen(path, "r");
        assert_non_null(page);
        assert_non_null(fgets(line, sizeof line, page));
        fclose(page);
        line[strcspn(line, "\n")] = 0;
        assert_true(strncmp(line, "# ", 2) == 0);
        pages++;
        for (int l = 0; l < wr_language_count; l++)
            if (speaks(l)) missing += lacks(line + 2);
    }
    closedir(folder);
    assert_int_equal(missing, 0);
    assert_true(pages > 20);
}

/* ---- search ---- */

static const char *listed[1000];
static int listed_count;

static void note_listed(const char *action)
{
    if (listed_count < 1000) listed[listed_count++] = action;
}

static void every_action_stands_in_a_menu(void **state)
{
    (void)state;
    Walk walk;
    walk_open(&walk, "en");
    listed_count = 0;
    wr_menu_listed = note_listed;
    walk_frame(&walk);
    wr_menu_listed = NULL;
    int missing = 0;
    for (const WrAction *a = walk.app->registry->actions; a->name; a++) {
        bool there = false;
        for (int i = 0; i < listed_count && !there; i++) there = strcmp(listed[i], a->name) == 0;
        if (!there) printf("%s (%s) is in no menu\n", a->name, a->label), missing++;
    }
    walk_close(&walk);
    assert_int_equal(missing, 0);
}

static bool menu_told[1000];

static void note_help(const char *english)
{
    const WrRegistry *registry = &wr_registry;
    for (int i = 0; registry->actions[i].name; i++)
        if (registry->helps[i] == english) menu_told[i] = true;
}

/* A separate line with more information than the name, shown in menus. */
static void every_action_has_a_help_line(void **state)
{
    (void)state;
    Walk walk;
    walk_open(&walk, "en");
    wr_words_requested = note_help;
    walk_frame(&walk);
    wr_words_requested = NULL;
    int without = 0;
    const WrRegistry *registry = walk.app->registry;
    for (int i = 0; registry->actions[i].name; i++) {
        const WrAction *a = &registry->actions[i];
        const char *help = wr_action_help(walk.app, a);
        bool own = help && strlen(help) > 14 && strcmp(help, a->label) != 0 && menu_told[i];
        for (int j = 0; j < i && own; j++) own = strcmp(help, registry->helps[j]) != 0;
        if (!own) printf("%s (%s): \"%s\"\n", a->name, a->label, help ? help : "nothing");
        without += !own;
    }
    walk_close(&walk);
    assert_int_equal(without, 0);
}

static const char *searched_help;
static bool requested;

static void note_request(const char *english)
{
    requested = requested || strcmp(english, searched_help) == 0;
}

/* Only the help of the current model is shown, as a tip, and the plan only of a picture: no walk through the panels requests
   the others. */
static void every_reflection_model_and_effect_has_words(void **state)
{
    (void)state;
    int missing = 0;
    for (int l = 0; l < wr_language_count; l++)
        for (int i = 0; i < wr_reflect_count && speaks(l); i++)
            missing += lacks(wr_reflects[i].help);
    for (int l = 0; l < wr_language_count; l++)
        for (int i = 0; i < WR_EFFECT_COUNT && speaks(l); i++) missing += lacks(wr_effects[i].name);
    assert_int_equal(missing, 0);
}

static int lacking_helps(const WrArgSpec *args)
{
    int missing = 0;
    for (; args && args->name; args++) missing += args->help && lacks(args->help);
    return missing;
}

/* The dialog Change step shows the help of each value as a tip. */
static void every_value_of_an_edit_has_a_help_line(void **state)
{
    (void)state;
    int missing = 0;
    for (int l = 0; l < wr_language_count; l++)
        for (const WrCommand *const *c = wr_commands; *c && speaks(l); c++) {
            if ((*c)->kind != WR_CLASS_EDIT && (*c)->kind != WR_CLASS_SCENE) continue;
            missing += lacking_helps((*c)->args) + lacking_helps((*c)->more);
            WrForm form;
            for (int i = 0; (*c)->form && (*c)->form(i, &form); i++)
                missing += lacking_helps(form.args);
        }
    assert_int_equal(missing, 0);
}

/* The search finds commands by verb and then accepts the line; their help is translated. */
static void every_command_is_reached_by_the_search(void **state)
{
    (void)state;
    int missing = 0;
    for (int l = 0; l < wr_language_count; l++)
        for (const WrCommand *const *c = wr_commands; *c && speaks(l); c++)
            missing += lacks((*c)->help);
    assert_int_equal(missing, 0);
    Walk walk;
    walk_open(&walk, "de");
    for (const WrCommand *const *c = wr_commands; *c; c++) {
        char line[60];
        snprintf(line, sizeof line, "%s ", (*c)->name);
        wr_search_line(walk.app, line); /* as by its row in the list */
        searched_help = (*c)->help;
        requested = false;
        wr_words_requested = note_request;
        walk_frame(&walk);
        walk_frame(&walk);
        wr_words_requested = NULL;
        if (!requested) fail_msg("the search says nothing about '%s'", (*c)->name);
        wr_dialog_close(walk.app);
        walk_frame(&walk);
    }
    walk_close(&walk);
}

static void no_key_does_two_things(void **state)
{
    (void)state;
#define ROW(name, keys) { #name, keys },
    static const struct {
        const char *action, *keys;
    } rows[] = { WR_ACTIONS(ROW) WR_HELD_ACTIONS(ROW) WR_FAMILY_ACTIONS(ROW) };
#undef ROW
    struct {
        WrKey key;
        const char *action;
    } all[400];
    int count = 0;
    for (size_t i = 0; i < WR_LENGTH(rows); i++)
        for (const char *at = rows[i].keys; *at;) {
            const size_t length = strcspn(at, " ");
            WrKey key;
            WrError err;
            if (length > 0 && !wr_key_parse(at, length, &key, &err)) fail_msg("%s", err.text);
            for (int k = 0; k < count && length > 0; k++)
                if (all[k].key.code == key.code && all[k].key.mods == key.mods)
                    fail_msg("%.*s is of %s and of %s", (int)length, at, all[k].action,
                             rows[i].action);
            if (length > 0 && count < 400) {
                all[count].key = key;
                all[count++].action = rows[i].action;
            }
            at += length + (at[length] == ' ');
        }
    assert_true(count > 100);
}

/* ---- available width ---- */

static struct {
    Walk *walk;
    char text[200][80]; /* printed once each */
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
    static const double scales[] = { 0.75, 1, 1.25, 1.5, 2, 3 };
    static const int sizes[][2] = {
        { 1280, 720 }, { 1366, 768 }, { 1440, 900 }, { 1920, 1080 }, { 3840, 2160 }
    };
    int total = 0;
    for (int l = 1; l < wr_language_count; l++) {
        WrError err;
        Walk walk;
        walk_open(&walk, wr_languages[l].code);
        cuts.walk = &walk;
        cuts.count = cuts.told = 0;
        for (int s = 0; s < 6; s += test_amount(1, 5)) {
            if (s % 2 != l % 2 && !getenv("WR_FULL")) continue; /* half of the scales a language */
            if (!wr_gui_set_scale(walk.app->gui, scales[s], &err)) fail_msg("%s", err.text);
            for (int k = 0; k < 5; k++) {
                if (sizes[k][0] < 900 * scales[s] || sizes[k][1] < 500 * scales[s]) continue;
                SDL_SetWindowSize(walk.app->window, sizes[k][0], sizes[k][1]);
                walk_show(&walk, "%s", "the first picture");
                wr_gui_cut = note_cut;
                const bool narrow = k == 0 || sizes[k - 1][0] < 900 * scales[s];
                if (narrow) walk_all(&walk);
                else if (l == 1) walk_tabs(&walk); /* there is more room than in the narrowest */
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
        cmocka_unit_test(every_page_of_the_guide_has_a_title_in_every_language),
        cmocka_unit_test(every_action_stands_in_a_menu),
        cmocka_unit_test(every_action_has_a_help_line),
        cmocka_unit_test(every_reflection_model_and_effect_has_words),
        cmocka_unit_test(every_value_of_an_edit_has_a_help_line),
        cmocka_unit_test(every_command_is_reached_by_the_search),
        cmocka_unit_test(no_key_does_two_things),
        cmocka_unit_test(no_text_is_cut),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
