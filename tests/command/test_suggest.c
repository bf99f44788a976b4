/* Every word that a user can mistype, with one letter swapped, missing or doubled: the message suggests the correct
   one. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/help.h"
#include "export/export.h"
#include "export/map_sets.h"

#include <ctype.h>
#include <string.h>

#define WORD_MAX 96

/* ---- mistyped words ---- */

/* One edit apart: a letter more or less, another letter, or two neighbours swapped. Independent of the program's
   distance function. */
static bool one_edit(const char *a, const char *b)
{
    size_t n = strlen(a), m = strlen(b), same = 0;
    if (n > m) return one_edit(b, a);
    while (same < n && tolower((unsigned char)a[same]) == tolower((unsigned char)b[same])) same++;
    if (m == n + 1) return strcasecmp(a + same, b + same + 1) == 0;
    if (m != n || same == n) return false;
    if (strcasecmp(a + same + 1, b + same + 1) == 0) return true;
    return same + 1 < n && tolower((unsigned char)a[same]) == tolower((unsigned char)b[same + 1]) &&
           tolower((unsigned char)a[same + 1]) == tolower((unsigned char)b[same]) &&
           strcasecmp(a + same + 2, b + same + 2) == 0;
}

/* Typo i of a word; false past the last. Three kinds at each position. */
static bool typo(const char *word, int i, char out[WORD_MAX + 2])
{
    const size_t n = strlen(word), at = (size_t)i / 3;
    if (at >= n) return false;
    strcpy(out, word);
    if (i % 3 == 0 && at + 1 < n) {
        out[at] = word[at + 1];
        out[at + 1] = word[at];
    } else if (i % 3 == 1) {
        memmove(out + at, out + at + 1, n - at);
    } else if (i % 3 == 2) {
        memmove(out + at + 1, out + at, n - at + 1);
    }
    return true;
}

/* The program's answer to a mistyped word. */
typedef void (*Ask)(const void *ctx, const char *typed, WrError *err);

typedef struct Tally {
    int asked, suggested;
} Tally;

/* The answer must suggest `word`, and every other word of the list that is as near. */
static void check_answer(const char *word, const char *typed, WrWordList list, const void *ctx,
                         const WrError *err, Tally *tally)
{
    const char *near = strstr(err->text, "did you mean ");
    char first[WORD_MAX + 40];
    int others = 0;
    for (int k = 0; list(ctx, k); k++) {
        const char *other = list(ctx, k);
        others += strcmp(other, word) != 0 && strlen(other) > 1 && one_edit(typed, other);
    }
    snprintf(first, sizeof first, "%.*s", near ? (int)strcspn(near, "?") : 0, near ? near : "");
    tally->asked++;
    if (others > 1) return;
    if (!strstr(first, word)) fail_msg("\"%s\" for %s: %s", typed, word, err->text);
    tally->suggested++;
}

static void check_list(WrWordList list, const void *ctx, Ask ask, const void *ask_ctx, Tally *tally)
{
    char typed[WORD_MAX + 2], word[WORD_MAX + 1];
    for (int i = 0; list(ctx, i); i++) {
        snprintf(word, sizeof word, "%s", list(ctx, i));
        for (int k = 0; strlen(word) > 2 && typo(word, k, typed); k++) {
            bool another = false;
            for (int j = 0; list(ctx, j); j++) another |= strcasecmp(list(ctx, j), typed) == 0;
            if (another || !isalpha((unsigned char)*typed)) continue;
            WrError err = { "accepted" };
            ask(ask_ctx, typed, &err);
            if (strcmp(err.text, "another name") == 0) continue;
            check_answer(word, typed, list, ctx, &err, tally);
        }
    }
}

/* ---- lines ---- */

static const char *verb_at(const void *ctx, int i)
{
    (void)ctx;
    return i < wr_command_count ? wr_commands[i]->name : NULL;
}

static bool is_form(const char *word)
{
    WrForm form;
    for (int i = 0; i < wr_command_count; i++)
        if (wr_commands[i]->form && wr_command_form(wr_commands[i], word, &form) >= 0) return true;
    return false;
}

static void parse(const char *line, WrError *err)
{
    WrCall *call = NULL;
    if (wr_call_parse(line, false, &call, err)) wr_call_free(call);
}

static void verbs_are_suggested(void **state)
{
    (void)state;
    Tally tally = { 0 };
    char typed[WORD_MAX + 2];
    for (int i = 0; i < wr_command_count; i++)
        for (int k = 0; typo(wr_commands[i]->name, k, typed); k++) {
            WrError err = { "accepted" };
            if (wr_command_find(typed) || is_form(typed)) continue;
            parse(typed, &err);
            check_answer(wr_commands[i]->name, typed, verb_at, NULL, &err, &tally);
        }
    assert_true(tally.suggested > 500);
}

typedef struct Form {
    const WrCommand *command;
    int index; /* -1: the command has none */
    WrForm row;
    WrArgSpec specs[WR_ARGS_MAX];
    int count;
} Form;

static const char *form_at(const void *ctx, int i)
{
    static WrForm row;
    const WrCommand *command = ctx;
    return command->form(i, &row) ? row.name : NULL;
}

static void ask_form(const void *ctx, const char *typed, WrError *err)
{
    const WrCommand *command = ctx;
    char line[300];
    snprintf(line, sizeof line, "%s %s", command->name, typed);
    parse(line, err);
}

static void forms_are_suggested(void **state)
{
    (void)state;
    Tally tally = { 0 };
    for (int i = 0; i < wr_command_count; i++)
        if (wr_commands[i]->form)
            check_list(form_at, wr_commands[i], ask_form, wr_commands[i], &tally);
    assert_true(tally.suggested > 1000);
}

static const char *name_at(const void *ctx, int i)
{
    const Form *form = ctx;
    for (int k = 0; k < form->count; k++)
        if (!form->specs[k].positional && i-- == 0) return form->specs[k].name;
    return NULL;
}

static void ask_name(const void *ctx, const char *typed, WrError *err)
{
    const Form *form = ctx;
    char line[300];
    for (int k = 0; k < form->count; k++)
        if (form->specs[k].also && strcmp(form->specs[k].also, typed) == 0) {
            wr_fail(err, "another name");
            return;
        }
    snprintf(line, sizeof line, "%s %s %s=1", form->command->name,
             form->index >= 0 ? form->row.name : "", typed);
    parse(line, err);
}

static const char *word_at(const void *ctx, int i)
{
    return wr_arg_word(ctx, i);
}

static void ask_choice(const void *ctx, const char *typed, WrError *err)
{
    WrArg arg = { .choice = -1 };
    if (wr_arg_parse(ctx, "x", typed, &arg, err)) wr_arg_fini(&arg);
}

static void visit(const Form *form, Tally *names, Tally *choices)
{
    check_list(name_at, form, ask_name, form, names);
    for (int k = 0; k < form->count; k++) {
        const WrArgSpec *spec = &form->specs[k];
        if (spec->type == WR_ARG_CHOICE) check_list(word_at, spec, ask_choice, spec, choices);
    }
}

static void names_and_values_are_suggested(void **state)
{
    (void)state;
    Tally names = { 0 }, choices = { 0 };
    static Form form;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = form.command = wr_commands[i];
        for (int k = command->form ? 0 : -1; k < 0 || command->form(k, &form.row); k++) {
            form.index = k;
            form.count = wr_command_specs(command, k, form.specs);
            visit(&form, &names, &choices);
            if (k < 0) break;
        }
    }
    assert_true(names.suggested > 10000);
    assert_true(choices.suggested > 5000);
}

/* ---- exports ---- */

static const char *option_at(const void *ctx, int i)
{
    return ((const WrExportKind *)ctx)->options[i].name;
}

static void ask_option(const void *ctx, const char *typed, WrError *err)
{
    WrExportOptions options = wr_export_default();
    wr_export_option(ctx, &options, typed, "1", err);
}

static void names_of_exports_are_suggested(void **state)
{
    (void)state;
    Tally tally = { 0 };
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        check_list(option_at, &wr_export_kinds[i], ask_option, &wr_export_kinds[i], &tally);
    assert_true(tally.suggested > 2000);
}

static const char *set_at(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_MAP_SET_ROWS ? wr_map_set_rows[i].name : NULL;
}

static void ask_set(const void *ctx, const char *typed, WrError *err)
{
    (void)ctx;
    wr_map_set_free(wr_map_set_find(typed, err));
}

static void sets_are_suggested(void **state)
{
    (void)state;
    Tally tally = { 0 };
    check_list(set_at, NULL, ask_set, NULL, &tally);
    assert_true(tally.suggested > 100);
}

/* ---- values without names ---- */

/* A value for each named argument: one in the middle of its range, or its first word. */
static bool value_for(const WrArgSpec *spec, WrText *text)
{
    wr_text_clear(text);
    if (spec->type == WR_ARG_CHOICE) wr_text_add(text, wr_arg_word(spec, 0));
    else wr_arg_fallback_print(spec, text);
    return text->length > 0 && spec->type != WR_ARG_TEXT && spec->type != WR_ARG_LIST;
}

/* For any command: one value too many suggests an argument that accepts it, or lists the command's arguments. */
static void check_extra(const Form *form, const WrArgSpec *spec, int *named)
{
    WrText value = { 0 }, line = { 0 };
    WrError err = { "accepted" };
    if (value_for(spec, &value)) {
        wr_text_addf(&line, "%s %s", form->command->name, form->index >= 0 ? form->row.name : "");
        for (int k = 0; k < 4; k++) wr_text_addf(&line, " %s", wr_text_get(&value));
        parse(wr_text_get(&line), &err);
        assert_string_not_equal(err.text, "accepted");
        if (strstr(err.text, "needs a name")) {
            assert_non_null(strstr(err.text, "did you mean "));
            assert_non_null(strstr(err.text, wr_text_get(&value)));
            ++*named;
        }
    }
    wr_text_fini(&line);
    wr_text_fini(&value);
}

static void values_without_a_name_are_given_one(void **state)
{
    (void)state;
    static Form form;
    int named = 0;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = form.command = wr_commands[i];
        for (int k = command->form ? 0 : -1; k < 0 || command->form(k, &form.row); k++) {
            form.index = k;
            form.count = wr_command_specs(command, k, form.specs);
            for (int a = 0; a < form.count; a++)
                if (!form.specs[a].positional) check_extra(&form, &form.specs[a], &named);
            if (k < 0) break;
        }
    }
    assert_true(named > 500);
}

static void lines_of_newcomers_are_answered(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "layer copy base", "did you mean duplicate?" },
        { "layer remove base", "did you mean delete" },
        { "layer select base", "did you mean use?" },
        { "layer opacity base 0.5", "did you mean layer add or layer set?" },
        { "layer hide base", "did you mean set?" },
        { "layer merge-down base", "did you mean merge?" },
        { "layer filter blur", "did you mean filter?" },
        { "layer set base mode=max", "did you mean blend=?" },
        { "layer set base alpha=0.5", "did you mean opacity=?" },
        { "layer mask base kind=slope", "did you mean live=?" },
        { "layer mask base live=edges", "did you mean wear or curvature?" },
        { "mask add kind=slope", "did you mean layer?" },
        { "instance base", "did you mean link?" },
        { "variant switch worn", "did you mean use?" },
        { "tolerance 0.004", "did you mean rms=0.004 or max=0.004?" },
        { "bump 0.1", "did you mean height=0.1?" },
        { "bump blinn", "did you mean mode=blinn?" },
        { "bump blin", "did you mean mode=blinn?" },
        { "text Hello World", "goes in quotes: \"Hello World\"" },
        { "light directional -1,1,2", "did you mean to=-1,1,2?" },
        { "light point 0,1,2", "did you mean at=0,1,2?" },
        { "light type=point", "did you mean light point?" },
        { "adjust offset=3", "did you mean adjust offset?" },
        { "sphere", "surface sphere" },
        { "Bump", "did you mean bump?" },
        { "table size=64x64", "did you mean table 64x64?" },
        { "surface sphere radius=2", "did you mean R=?" },
        { "light directional to=0,0,1 intensity=2", "did you mean strength=?" },
        { "object add cup location=0,0,1", "did you mean at=?" },
        { "adjust bricks", "did you mean pattern bricks?" },
        { "material color=1,0,0", "did you mean colour=?" },
        { "material colour=#ff0000", "# begins a comment" },
        { "dab 0.5,0.5 radius = 10", "write radius=VALUE, without spaces" },
        { "dab 0.5,0.5 --radius 10", "write radius=VALUE, without spaces" },
        { "dab 0.5,0.5 size=10", "did you mean radius=?" },
        { "dab x=0.5 y=0.5", "u,v stands without a name: must be 2 numbers" },
        { "dab 0.5,0.5 mode=add", "did you mean raise?" },
        { "stroke points=0,0 1,1", "after a semicolon: ...;1,1" },
        { "text 'Hello World'", "goes in quotes: \"Hello World\"" },
        { "rotate y=45", "x,y,z stands without a name: must be 3 numbers" },
        { "camera fov=40", "did you mean camera perspective or camera save?" },
        { "background 1,1,1", "did you mean background plain colour=1,1,1?" },
        { "layer 2", "unknown ACTION \"2\": must be one of" },
        { "surface ball", "did you mean sphere?" },
        { "noise perlin scale=5", "did you mean cells=?" },
        { "image pic.png fit", "write fit=VALUE" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrError err = { "accepted" };
        parse(rows[i][0], &err);
        if (!strstr(err.text, rows[i][1])) fail_msg("%s: %s", rows[i][0], err.text);
    }
}

/* ---- help ---- */

static void help_shows_one_argument(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrError err;
    assert_true(wr_help_command_part(wr_command_find("bump"), "mode", &text, &err));
    assert_non_null(strstr(wr_text_get(&text), "mode="));
    assert_null(strstr(wr_text_get(&text), "scheme="));
    assert_false(wr_help_command_part(wr_command_find("bump"), "moed", &text, &err));
    assert_non_null(strstr(err.text, "did you mean mode?"));
    wr_text_fini(&text);
}

/* Each form and each argument of each command has separate help. */
static void help_has_every_part(void **state)
{
    (void)state;
    static Form form;
    WrError err;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        for (int k = command->form ? 0 : -1; k < 0 || command->form(k, &form.row); k++) {
            form.count = wr_command_specs(command, k, form.specs);
            for (int a = 0; a < form.count; a++) {
                WrText text = { 0 };
                assert_true(wr_help_command_part(command, form.specs[a].name, &text, &err));
                assert_non_null(strstr(wr_text_get(&text), form.specs[a].name));
                wr_text_fini(&text);
            }
            if (k < 0) break;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verbs_are_suggested),
        cmocka_unit_test(forms_are_suggested),
        cmocka_unit_test(names_and_values_are_suggested),
        cmocka_unit_test(names_of_exports_are_suggested),
        cmocka_unit_test(sets_are_suggested),
        cmocka_unit_test(values_without_a_name_are_given_one),
        cmocka_unit_test(lines_of_newcomers_are_answered),
        cmocka_unit_test(help_shows_one_argument),
        cmocka_unit_test(help_has_every_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
