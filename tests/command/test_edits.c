/* Edits: refusals, limits by selections, table operations on layers. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "command/session.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "image/image.h"

#include <unistd.h>

static const char *const edits[] = { "fill 2",
                                     "grid cells=3x3 width=5 high=2",
                                     "dab 0.4,0.6 radius=25 strength=0.7",
                                     "dab 0.4,0.6 radius=25 strength=9 mode=to to=-1",
                                     "dab 0.4,0.6 radius=0.5 strength=0.7",
                                     "stroke points=0.1,0.9;0.9,0.8,0.3 radius=12 mode=lower",
                                     "image g.png fit=table",
                                     "adjust levels gamma=1.5 out-high=3",
                                     "adjust blur sigma=2",
                                     "adjust offset du=17",
                                     "stroke points=0.2,0.9;0.7,0.5 radius=20 mode=erase",
                                     "stroke points=0.2,0.9;0.7,0.5 radius=20 mode=dilate reach=6",
                                     "stroke points=0.2,0.9;0.7,0.5 radius=20 flow=0.4",
                                     "shape rectangle a=0.1,0.3 b=0.6,0.9 corner=9 radius=12",
                                     "shape ellipse middle=0.3,0.6 radii=0.3,0.2 paint=fill turn=9",
                                     "flood 0,0 tolerance=0.2 strength=2",
                                     "ramp cone from=0.3,0.5 to=0.6,0.6",
                                     "layer clear" };
#define EDIT_COUNT (sizeof edits / sizeof *edits)

static void edits_of_locked_and_hidden_layers_are_refused(void **state)
{
    (void)state;
    WrError err;
    const struct {
        const char *line, *word;
    } ways[] = { { "layer set top lock=on", "layer 2 \"top\" is locked" },
                 { "layer set top visible=off", "layer 2 \"top\" is hidden" },
                 { "layer solo 1", "layer 2 \"top\" is not shown while layer 1 is alone" } };
    for (size_t k = 0; k < 3; k++) {
        WrSession *s =
            session_of((const char *[]){ "table 60x60", "layer add top", ways[k].line, NULL });
        for (size_t i = 0; i < EDIT_COUNT - (k > 0); i++) must_fail(s, edits[i], ways[k].word);
        assert_false(wr_session_stroke_begin(s, "stroke radius=3", &err));
        assert_non_null(strstr(err.text, ways[k].word));
        assert_false(wr_session_in_stroke(s));
        wr_session_free(s);
    }
    WrSession *s = session_of(
        (const char *[]){ "layer add top", "layer set top lock=on", "layer use 1", NULL });
    must_fail(s, "layer delete top", "is locked");
    must_fail(s, "layer merge top", "is locked");
    must_fail(s, "layer flatten", "is locked");
    must_fail(s, "layer mask top from=white", "is locked");
    must_fail(s, "adjust add amount=1 layers=all", "is locked");
    must_run(s, "adjust crop width=64 height=32"); /* all tables have one size, locked or not */
    wr_session_free(s);
}

/* ---- selections ---- */

static const char *const before_edit[] = { "table 150x90 wrap=clamp-v", "grid cells=4x3",
                                           "dab 0.5,0.5 radius=40 strength=0.3", NULL };

static void every_edit_keeps_to_the_selection(void **state)
{
    (void)state;
    for (size_t k = 0; k < EDIT_COUNT; k++) {
        WrSession *old = session_of(before_edit), *all = session_of(before_edit);
        WrSession *part = session_of(before_edit);
        must_run(all, edits[k]);
        must_run(part, "select ellipse centre=0.3,0.6 radii=0.3,0.3");
        must_run(part, "select feather by=4");
        must_run(part, "select rect from=0.25,0.5 to=0.4,0.7 mode=add");
        must_run(part, edits[k]);
        const WrField *selection = doc(part)->selection;
        int in = 0, out = 0, partly = 0;
        for (int j = 0; j < 90; j++)
            for (int i = 0; i < 150; i++) {
                float a = f_at(old, i, j), b = f_at(all, i, j), c = f_at(part, i, j);
                float s = wr_field_get(selection, i, j);
                if (s == 0) assert_true(same_bits(a, c));
                /* a brush with coverage c makes one rounding of old + s c strength */
                assert_near(c, a + (double)s * ((double)b - a), 1e-6);
                in += s == 1;
                out += s == 0;
                partly += s > 0 && s < 1 && a != b && c != a;
            }
        assert_true(in > 100 && out > 1000);
        assert_true(partly > 0 || strstr(edits[k], "radius=0.5"));
        wr_session_free(old);
        wr_session_free(all);
        wr_session_free(part);
    }
}

static void a_full_selection_changes_nothing_about_an_edit(void **state)
{
    (void)state;
    for (size_t k = 0; k < EDIT_COUNT; k++) {
        WrSession *all = session_of(before_edit), *part = session_of(before_edit);
        must_run(part, "select all");
        must_run(all, edits[k]);
        must_run(part, edits[k]);
        assert_true(same_field(wr_document_field(doc(all)), wr_document_field(doc(part))));
        must_run(part, "select none");
        assert_true(wr_hash_equal(wr_session_hash(all), wr_session_hash(part)));
        wr_session_free(all);
        wr_session_free(part);
    }
}

static void a_stroke_drawn_live_keeps_to_the_selection_and_marks_the_layer(void **state)
{
    (void)state;
    WrError err;
    const char *const lines[] = { "table 200x200", "layer add blend=replace",
                                  "select rect from=0.2,0.2 to=0.61,0.7", "select feather by=2",
                                  NULL };
    WrSession *live = session_of(lines), *line = session_of(lines);
    must_run(line, "stroke points=0.1,0.1;0.3,0.5,0.5;0.9,0.6 radius=15 strength=0.5");
    const WrSample samples[] = { { .u = 0.1, .v = 0.1, .pressure = 1 },
                                 { .u = 0.3, .v = 0.5, .pressure = 0.5 },
                                 { .u = 0.9, .v = 0.6, .pressure = 1 } };
    assert_true(wr_session_stroke_begin(live, "stroke radius=15 strength=0.5", &err));
    for (int i = 0; i < 3; i++) assert_true(wr_session_stroke_add(live, &samples[i], 1, &err));
    assert_false(wr_session_run(live, "undo", &err));
    assert_false(wr_session_history_go(live, 0, &err));
    assert_true(wr_session_stroke_end(live, &err));
    assert_true(wr_hash_equal(wr_session_hash(live), wr_session_hash(line)));
    const WrLayer *layer = &doc(live)->layers[1];
    int painted = 0;
    for (int j = 0; j < 200; j++)
        for (int i = 0; i < 200; i++) { /* raised by strength times coverage, within rounding */
            assert_near(wr_field_get(layer->heights, i, j), 0.5 * wr_field_get(layer->cover, i, j),
                        1e-7);
            assert_true(wr_field_get(layer->cover, i, j) <=
                        wr_field_get(doc(live)->selection, i, j));
            painted += wr_field_get(layer->cover, i, j) > 0;
        }
    assert_true(painted > 1000);
    assert_true(wr_session_stroke_begin(live, "stroke radius=30", &err));
    assert_true(wr_session_stroke_add(live, samples, 3, &err));
    wr_session_stroke_cancel(live);
    assert_true(wr_hash_equal(wr_session_hash(live), wr_session_hash(line)));
    wr_session_free(live);
    wr_session_free(line);
}

static void selections_are_what_their_forms_say(void **state)
{
    (void)state;
    WrSession *s =
        session_of((const char *[]){ "table 64x32", "grid cells=2x1 width=8 high=3", NULL });
    must_run(s, "select rect from=0.25,0.5 to=0.5,1");
    const WrField *a = doc(s)->selection;
    for (int j = 0; j < 32; j++)
        for (int i = 0; i < 64; i++)
            assert_true(wr_field_get(a, i, j) == (i >= 16 && i < 32 && j < 16));
    must_run(s, "select invert");
    assert_true(wr_field_get(doc(s)->selection, 16, 0) == 0);
    must_run(s, "select height low=2 high=4");
    for (int i = 0; i < 64; i++)
        assert_true(wr_field_get(doc(s)->selection, i, 9) == (f_at(s, i, 9) == 3));
    must_run(s, "select lasso points=0,0;1,0;1,1;0,1");
    assert_true(wr_field_get(doc(s)->selection, 63, 31) == 1);
    must_run(s, "select rect from=0,0 to=0.5,1 mode=subtract");
    assert_true(wr_field_get(doc(s)->selection, 31, 5) == 0 &&
                wr_field_get(doc(s)->selection, 32, 5) == 1);
    must_run(s, "select grow by=3");
    assert_true(wr_field_get(doc(s)->selection, 29, 5) == 1);
    must_run(s, "select shrink by=3");
    assert_true(wr_field_get(doc(s)->selection, 31, 5) == 0);
    must_run(s, "select slope low=20 high=90 relief=1");
    assert_true(wr_field_get(doc(s)->selection, 4, 9) == 1 &&
                wr_field_get(doc(s)->selection, 16, 9) == 0);
    must_run(s, "select none");
    assert_null(doc(s)->selection);
    must_fail(s, "select feather by=1", "nothing is selected");
    must_run(s, "select invert");
    assert_true(wr_field_get(doc(s)->selection, 3, 3) == 1);
    wr_session_free(s);
}

static void an_edit_within_a_selection_shares_the_tiles_that_it_leaves(void **state)
{
    (void)state;
    WrField *before = wr_field_new(300, 300, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0.5f, NULL);
    wr_field_set(before, 299, 299, 7);
    WrField *after = wr_field_share(before),
            *selection = wr_field_new(300, 300, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0, NULL);
    wr_field_fill(after, 3e38f);
    wr_field_set(selection, 10, 10, 1);
    wr_field_set(selection, 11, 10, 0.5f);
    WrField *mixed = wr_edit_within(before, after, selection);
    assert_true(wr_field_get(mixed, 10, 10) == 3e38f && wr_field_get(mixed, 12, 10) == 0.5f);
    assert_near(wr_field_get(mixed, 11, 10), 1.5e38, 1e32);
    assert_ptr_equal(wr_field_tile(mixed, 4, 4), wr_field_tile(before, 4, 4));
    assert_null(wr_field_tile(mixed, 1, 0));
    wr_field_free(before);
    wr_field_free(after);
    wr_field_free(selection);
    wr_field_free(mixed);
}

/* ---- table operations ---- */

static WrSession *rich(void)
{
    return session_of((const char *[]){
        "table 90x60", "grid cells=4x3", "layer add blend=max", "dab 0.3,0.4 radius=20 strength=2",
        "select ellipse centre=0.7,0.3 radii=0.2,0.2", "layer mask 2 from=selection",
        "layer add blend=multiply", "dab 0.8,0.2 radius=25 strength=0.5", "select feather by=2",
        NULL });
}

static void four_quarter_turns_restore_every_bit(void **state)
{
    (void)state;
    WrSession *s = rich();
    WrHash before = wr_session_hash(s);
    must_run(s, "adjust rotate");
    const WrDocument *d = doc(s);
    assert_int_equal(wr_field_width(d->selection) * 1000 + wr_field_height(d->selection), 60090);
    for (int i = 0; i < d->layer_count; i++)
        assert_int_equal(wr_field_width(d->layers[i].heights), 60);
    assert_false(wr_hash_equal(before, wr_session_hash(s)));
    for (int i = 0; i < 3; i++) must_run(s, "adjust rotate");
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

static void offsetting_all_layers_rolls_the_composite(void **state)
{
    (void)state;
    WrSession *s = rich();
    must_run(s, "select none");
    WrField *before = wr_field_share(wr_document_field(doc(s)));
    must_run(s, "adjust offset du=13 dv=-7 layers=all");
    for (int j = 0; j < 60; j++)
        for (int i = 0; i < 90; i++)
            assert_true(f_at(s, (i + 13) % 90, (j + 7) % 60) == wr_field_get(before, i, j));
    wr_field_free(before);
    wr_session_free(s);
}

/* Between -1 and 1 a shift is a fraction of the side, rounded to whole texels: a third of 90, a sixth of 60; else
   texels. */
static void offsets_take_shares_of_the_side(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int du, dv;
    } rows[] = { { "adjust offset du=0.5 dv=-0.25 layers=all", 45, -15 },
                 { "adjust offset du=0.333333333 layers=all", 30, 0 },
                 { "adjust offset du=-0.01 dv=0.99 layers=all", -1, 59 },
                 { "adjust offset du=1 dv=-1 layers=all", 1, -1 } };
    for (int k = 0; k < 4; k++) {
        WrSession *s = rich();
        must_run(s, "select none");
        WrField *before = wr_field_share(wr_document_field(doc(s)));
        must_run(s, rows[k].line);
        for (int j = 0; j < 60; j++)
            for (int i = 0; i < 90; i++)
                assert_true(f_at(s, (i + rows[k].du + 90) % 90, (j - rows[k].dv + 60) % 60) ==
                            wr_field_get(before, i, j));
        wr_field_free(before);
        must_fail(s, "adjust offset du=1.5", "or a share of the side between -1 and 1");
        must_fail(s, "adjust crop x=0.5", "a whole number");
        wr_session_free(s);
    }
}

static void resizing_takes_layers_masks_and_selection_along(void **state)
{
    (void)state;
    WrSession *s = rich();
    must_run(s, "adjust resize width=45 height=97 filter=lanczos3");
    const WrDocument *d = doc(s);
    const WrField *fields[] = { d->layers[0].heights, d->layers[1].heights, d->layers[1].cover,
                                d->layers[1].mask,    d->layers[2].cover,   d->selection };
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        float low, high;
        assert_int_equal(wr_field_width(fields[i]) * 1000 + wr_field_height(fields[i]), 45097);
        wr_field_range(fields[i], &low, &high);
        if (i >= 2) assert_true(low >= 0 && high <= 1);
    }
    assert_null(d->layers[0].cover);
    wr_session_free(s);
}

static void table_starts_over_with_one_layer(void **state)
{
    (void)state;
    WrSession *s = rich();
    must_run(s, "table 20x10");
    assert_int_equal(doc(s)->layer_count, 1);
    assert_string_equal(doc(s)->layers[0].name, "base");
    assert_true(doc(s)->active == 0 && doc(s)->solo == -1);
    assert_null(doc(s)->selection);
    must_run(s, "undo");
    assert_int_equal(doc(s)->layer_count, 3);
    wr_session_free(s);
}

/* A picture for the edits to read. */
static int enter(void **state)
{
    uint8_t codes[12];
    for (int i = 0; i < 12; i++) codes[i] = (uint8_t)(17 * i);
    if (enter_folder(state) != 0) return -1;
    return wr_image_write_pixels("g.png", 4, 3, 1, WR_PIXEL_U8, true, codes, NULL) ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_of_locked_and_hidden_layers_are_refused),
        cmocka_unit_test(every_edit_keeps_to_the_selection),
        cmocka_unit_test(a_full_selection_changes_nothing_about_an_edit),
        cmocka_unit_test(a_stroke_drawn_live_keeps_to_the_selection_and_marks_the_layer),
        cmocka_unit_test(selections_are_what_their_forms_say),
        cmocka_unit_test(an_edit_within_a_selection_shares_the_tiles_that_it_leaves),
        cmocka_unit_test(four_quarter_turns_restore_every_bit),
        cmocka_unit_test(offsetting_all_layers_rolls_the_composite),
        cmocka_unit_test(offsets_take_shares_of_the_side),
        cmocka_unit_test(resizing_takes_layers_masks_and_selection_along),
        cmocka_unit_test(table_starts_over_with_one_layer),
    };
    return cmocka_run_group_tests(tests, enter, remove_folder);
}
