/* The generators as commands: blending of their output into the active layer. */
#include "test.h"
#include "session_help.h"

#include "base/error.h"
#include "base/progress.h"
#include "command/commands.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"

static WrHash hash_after(const char *const *lines)
{
    WrSession *s = session_of(lines);
    WrHash hash = wr_session_hash(s);
    wr_session_free(s);
    return hash;
}

static void replace_puts_what_is_made_in_the_layers_place(void **state)
{
    (void)state;
    static const char *const lines[] = { "table 64x32", "fill 7",
                                         "formula poly c=1,0,2;0,0,1 offset=0.5", NULL };
    WrSession *s = session_of(lines);
    for (int i = 0; i < 64; i++)
        assert_near((double)f_at(s, i, 3), 1.5 + 2.0 * (i + 0.5) / 64.0, 1e-6);
    wr_session_free(s);
}

/* Each blend by its own formula on one texel's heights. */
static void blends_join_heights_by_their_formulas(void **state)
{
    (void)state;
    static const struct {
        const char *blend;
        double want; /* of 0.5 with 0.75 made */
    } cases[] = { { "add", 1.25 },
                  { "subtract", -0.25 },
                  { "max", 0.75 },
                  { "min", 0.5 },
                  { "replace", 0.75 },
                  { "multiply", 0.375 },
                  { "mix", 0.75 },
                  { "smooth-max radius=0.5", 0.75 + 0.5 * 0.5 * 0.5 / 4.0 },
                  { "smooth-max radius=0", 0.75 } };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WrSession *s = wr_session_new(NULL);
        char line[200];
        must_run(s, "table 16x16");
        must_run(s, "fill 0.5");
        snprintf(line, sizeof line, "formula poly c=0,0,0.75 blend=%s", cases[k].blend);
        must_run(s, line);
        assert_near((double)f_at(s, 5, 5), cases[k].want, 1e-6);
        wr_session_free(s);
    }
}

static void a_selection_weighs_what_is_made_and_raises_the_layers_cover(void **state)
{
    (void)state;
    static const char *const lines[] = { "table 128x128", "layer add made blend=replace",
                                         "select rect from=0,0 to=0.5,1", "formula poly c=0,0,1",
                                         NULL };
    WrSession *s = session_of(lines);
    const WrLayer *layer = &doc(s)->layers[1];
    assert_true(wr_field_get(layer->heights, 10, 10) == 1.0f);
    assert_true(wr_field_get(layer->heights, 100, 10) == 0.0f);
    assert_true(wr_field_get(layer->cover, 10, 10) == 1.0f);
    assert_true(wr_field_get(layer->cover, 100, 10) == 0.0f);
    assert_true(f_at(s, 10, 10) == 1.0f && f_at(s, 100, 10) == 0.0f);
    wr_session_free(s);
}

/* Of 2 x 2 tiles, only the selected one is changed. */
static void tiles_that_come_out_as_they_were_stay_the_very_tiles(void **state)
{
    (void)state;
    static const char *const lines[] = { "table 128x128", "noise perlin",
                                         "select rect from=0,0.5 to=0.5,1", NULL };
    WrSession *s = session_of(lines);
    WrField *before = wr_field_share(doc(s)->layers[0].heights);
    must_run(s, "pattern bricks blend=add");
    const WrField *after = doc(s)->layers[0].heights;
    for (int ty = 0; ty < 2; ty++)
        for (int tx = 0; tx < 2; tx++) {
            bool same = wr_field_tile(before, tx, ty) == wr_field_tile(after, tx, ty);
            assert_true(same == !(tx == 0 && ty == 0));
        }
    must_run(s, "select none");
    wr_field_free(before);
    before = wr_field_share(doc(s)->layers[0].heights);
    must_run(s, "formula poly c=0,0,0 blend=add");
    for (int k = 0; k < 4; k++)
        assert_ptr_equal(wr_field_tile(before, k % 2, k / 2),
                         wr_field_tile(doc(s)->layers[0].heights, k % 2, k / 2));
    wr_field_free(before);
    wr_session_free(s);
}

static void locked_and_hidden_layers_are_refused(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "layer set 1 lock=on");
    must_fail(s, "pattern bricks", "locked");
    must_run(s, "layer set 1 lock=off visible=off");
    must_fail(s, "noise perlin", "hidden");
    wr_session_free(s);
}

static void mistakes_are_told_by_command_and_parameter(void **state)
{
    (void)state;
    static const char *const bad[][2] = { { "pattern brick", "bricks" },
                                          { "pattern", "KIND is missing" },
                                          { "pattern bricks joint=-1", "joint=-1" },
                                          { "pattern bricks across=2.5", "across=2.5" },
                                          { "pattern bricks bond=loose", "one of running" },
                                          { "pattern bricks joints=3", "did you mean joint" },
                                          { "pattern weave across=7", "multiple of 2" },
                                          { "pattern stripes across=0 rows=0", "other than 0" },
                                          { "noise perlin ratio=1", "above 1" },
                                          { "noise perlin blend=over", "one of add" },
                                          { "noise perlin radius=-1", "radius=-1" },
                                          { "noise perlin origin=1", "2 numbers" },
                                          { "formula poly", "c= is missing" },
                                          { "formula poly c=1,2", "i,j,a" },
                                          { "formula poly c=1,2.5,3", "whole" } };
    WrSession *s = wr_session_new(NULL);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) must_fail(s, bad[k][0], bad[k][1]);
    wr_session_free(s);
}

static void they_are_undone_and_redone_bit_for_bit(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 100x80");
    WrHash before = wr_session_hash(s);
    must_run(s, "pattern cracks seed=5");
    WrHash after = wr_session_hash(s);
    must_run(s, "undo");
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    must_run(s, "redo");
    assert_true(wr_hash_equal(after, wr_session_hash(s)));
    assert_string_equal(wr_session_last_command(s), "pattern cracks seed=5");
    wr_session_free(s);
}

/* Every form of every family, from the table: its defaults run, and the stored line produces the same. */
static void every_form_runs_and_replays_to_the_same_bits(void **state)
{
    (void)state;
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family && g->name; g++) {
            bool alone = true;
            for (int i = 0; g->params[i].name; i++)
                if (g->params[i].kind == WR_PARAM_FILE ||
                    (g->params[i].kind == WR_PARAM_TEXT && !g->params[i].fallback_text))
                    alone = false;
            if (!alone) continue;
            WrSession *s = wr_session_new(NULL);
            char line[200];
            bool poly = strcmp(g->name, "poly") == 0, fourier = strcmp(g->name, "fourier") == 0;
            snprintf(line, sizeof line, "%s %s%s blend=add", f->name, g->name,
                     poly      ? " c=1,1,0.5"
                     : fourier ? " terms=1,2,0.5"
                               : "");
            must_run(s, "table 72x40 wrap=clamp-u");
            must_run(s, line);
            const char *lines[] = { "table 72x40 wrap=clamp-u", wr_session_last_command(s), NULL };
            if (!wr_hash_equal(hash_after(lines), wr_session_hash(s)))
                fail_msg("%s does not replay", line);
            wr_session_free(s);
        }
}

/* The verb is in the table of commands with a form for each row. */
static void each_family_with_rows_is_a_verb(void **state)
{
    (void)state;
    for (const WrFamily *f = wr_families; f->name; f++) {
        if (!f->rows->family) continue;
        for (const WrGenerator *g = f->rows; g->family; g++)
            if (wr_blend_find(g->blend) < 0) fail_msg("%s: no blend %s", g->label, g->blend);
        const WrCommand *c = wr_command_find(f->name);
        if (!c) fail_msg("%s is no verb", f->name);
        WrForm form;
        for (int i = 0; c->form && f->rows[i].family; i++) {
            assert_true(c->form(i, &form));
            assert_string_equal(form.name, f->rows[i].name);
        }
    }
}

static volatile int stop = 1;

static void a_cancelled_generator_leaves_everything_as_it_was(void **state)
{
    (void)state;
    const WrProgress progress = { .cancel = &stop };
    WrSession *s = wr_session_new(NULL);
    must_run(s, "pattern dots");
    WrHash before = wr_session_hash(s);
    WrError err = { "" };
    wr_progress_set(&progress);
    assert_false(wr_session_run(s, "pattern bricks", &err));
    wr_progress_set(NULL);
    assert_non_null(strstr(err.text, "cancelled"));
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

static void keep_note(void *ctx, const char *text)
{
    snprintf(ctx, 400, "%s", text);
}

static void what_a_generator_has_to_say_reaches_the_sessions_notes(void **state)
{
    (void)state;
    char note[400] = "";
    WrSessionOptions options = { .note = keep_note, .note_ctx = note };
    WrSession *s = wr_session_new(&options);
    must_run(s, "table 64x64");
    must_run(s, "noise perlin octaves=12");
    assert_non_null(strstr(note, "octave 5 and finer"));
    wr_session_free(s);
}

/* A generated tile may replace the old one unchanged, except where the layer has another level at the table's
   edge. */
static void what_replaces_a_layer_is_the_same_whatever_lay_there(void **state)
{
    (void)state;
    static const char *const sizes[] = { "table 128x128", "table 100x70", "table 1x1",
                                         "table 65x200" };
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const char *plain[] = { sizes[k], "noise perlin cells=3 level=0.2", NULL };
        const char *over[] = { sizes[k], "fill 0.7", "formula poly c=1,0,1",
                               "noise perlin cells=3 level=0.2", NULL };
        const char *filled[] = { sizes[k], "fill 0.7", "noise perlin cells=3 level=0.2", NULL };
        WrSession *s[3] = { session_of(plain), session_of(over), session_of(filled) };
        WrHash hash = wr_field_hash(doc(s[0])->layers[0].heights);
        for (int n = 1; n < 3; n++) {
            WrHash other = wr_field_hash(doc(s[n])->layers[0].heights);
            assert_memory_equal(&hash, &other, sizeof hash);
        }
        must_run(s[0], "formula poly c=0,0,-0 blend=replace");
        assert_true(same_bits(f_at(s[0], 0, 0), 0.0)); /* never -0 */
        must_run(s[0], "undo");
        WrHash back = wr_field_hash(doc(s[0])->layers[0].heights);
        assert_memory_equal(&hash, &back, sizeof hash);
        for (int n = 0; n < 3; n++) wr_session_free(s[n]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(replace_puts_what_is_made_in_the_layers_place),
        cmocka_unit_test(blends_join_heights_by_their_formulas),
        cmocka_unit_test(a_selection_weighs_what_is_made_and_raises_the_layers_cover),
        cmocka_unit_test(tiles_that_come_out_as_they_were_stay_the_very_tiles),
        cmocka_unit_test(locked_and_hidden_layers_are_refused),
        cmocka_unit_test(mistakes_are_told_by_command_and_parameter),
        cmocka_unit_test(they_are_undone_and_redone_bit_for_bit),
        cmocka_unit_test(every_form_runs_and_replays_to_the_same_bits),
        cmocka_unit_test(each_family_with_rows_is_a_verb),
        cmocka_unit_test(a_cancelled_generator_leaves_everything_as_it_was),
        cmocka_unit_test(what_a_generator_has_to_say_reaches_the_sessions_notes),
        cmocka_unit_test(what_replaces_a_layer_is_the_same_whatever_lay_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
