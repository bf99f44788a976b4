/* Masks: their sources, and edits of them as of heights. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "brush/brush.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"

#include <math.h>

#define SHAPE                                                                                      \
    "select ellipse centre=0.31,0.62 radii=0.27,0.33", "select feather by=3.7",                    \
        "select rect from=0.71,0.13 to=1.09,0.4 mode=add"

static const WrLayer *layer(const WrSession *s, int number)
{
    return &doc(s)->layers[number - 1];
}

static double unit(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

/* A layer 2 whose mask is the shape, and edits go there. */
static WrSession *on_mask(void)
{
    return session_of((const char *[]){ "table 150x90 wrap=clamp-v", "grid cells=4x3",
                                        "layer add top", "dab 0.4,0.4 radius=35 strength=0.7",
                                        SHAPE, "layer mask 2 from=selection", "select none",
                                        "layer use 2 part=mask", NULL });
}

/* The shape as heights of the only layer. */
static WrSession *as_heights(void)
{
    return session_of(
        (const char *[]){ "table 150x90 wrap=clamp-v", SHAPE, "fill 1", "select none", NULL });
}

static const char *const edits[] = { "fill 0.4",
                                     "fill 7",
                                     "grid cells=3x3 width=5 high=2",
                                     "dab 0.4,0.6 radius=25 strength=0.7",
                                     "dab 0.4,0.6 radius=25 mode=lower strength=1.7",
                                     "stroke points=0.1,0.9;0.9,0.8,0.3 radius=12 mode=lower",
                                     "stroke points=0.2,0.9;0.7,0.5 radius=20 mode=erase",
                                     "stroke points=0.2,0.9;0.7,0.5 radius=20 mode=smooth",
                                     "stroke preset=rope radius=14 points=0.1,0.2;0.5,0.3",
                                     "shape ellipse middle=0.3,0.6 radii=0.3,0.2 paint=fill turn=9",
                                     "ramp cone from=0.3,0.5 to=0.6,0.6 blend=add",
                                     "noise perlin seed=3 amplitude=1.3",
                                     "pattern bricks blend=replace",
                                     "text Ab size=50",
                                     "adjust levels gamma=1.5 out-high=3 out-low=-0.2",
                                     "adjust blur sigma=2.3",
                                     "adjust offset du=17 dv=-8",
                                     "adjust invert" };
#define EDIT_COUNT (sizeof edits / sizeof *edits)

static void check_mask(const WrSession *masked, const WrSession *heights, const char *line)
{
    const WrField *mask = layer(masked, 2)->mask, *h = layer(heights, 1)->heights;
    for (int j = 0; j < 90; j++)
        for (int i = 0; i < 150; i++)
            if ((double)wr_field_get(mask, i, j) != unit(wr_field_get(h, i, j)))
                fail_msg("%s: the mask is %.9g at %d,%d, not %.9g", line,
                         (double)wr_field_get(mask, i, j), i, j, unit(wr_field_get(h, i, j)));
}

static void every_edit_does_to_a_mask_what_it_does_to_heights_kept_to_0_and_1(void **state)
{
    (void)state;
    for (size_t k = 0; k < EDIT_COUNT; k++)
        for (int selected = 0; selected < 2; selected++) {
            WrSession *masked = on_mask(), *heights = as_heights();
            const WrHash before = wr_field_hash(layer(masked, 2)->heights);
            WrSession *both[] = { masked, heights };
            for (int i = 0; i < 2; i++) {
                if (selected) must_run(both[i], "select ellipse centre=0.5,0.4 radii=0.3,0.3");
                must_run(both[i], edits[k]);
            }
            check_mask(masked, heights, edits[k]);
            assert_true(wr_hash_equal(before, wr_field_hash(layer(masked, 2)->heights)));
            must_run(masked, "undo");
            must_run(heights, "undo");
            check_mask(masked, heights, "undo");
            wr_session_free(masked);
            wr_session_free(heights);
        }
}

static void a_stroke_in_progress_reaches_the_mask_at_once_and_can_be_given_up(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = on_mask();
    const WrHash before = wr_session_hash(s), mask = wr_field_hash(layer(s, 2)->mask);
    const WrSample samples[] = { { .u = 0.2, .v = 0.3, .pressure = 1 },
                                 { .u = 0.8, .v = 0.6, .pressure = 0.7 } };
    assert_true(wr_session_stroke_begin(s, "stroke radius=17.3 strength=0.9", &err));
    assert_true(wr_session_stroke_add(s, samples, 2, &err));
    assert_false(wr_hash_equal(mask, wr_field_hash(layer(s, 2)->mask)));
    wr_session_stroke_cancel(s);
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    assert_true(wr_session_stroke_begin(s, "stroke radius=17.3 strength=0.9", &err));
    assert_true(wr_session_stroke_add(s, samples, 2, &err));
    assert_true(wr_session_stroke_end(s, &err));
    const WrHash drawn = wr_session_hash(s);
    char line[300];
    snprintf(line, sizeof line, "%s", wr_session_last_command(s));
    must_run(s, "undo");
    must_run(s, line);
    assert_true(wr_hash_equal(drawn, wr_session_hash(s)));
    wr_session_free(s);
}

static void masks_come_from_heights_slopes_fills_and_themselves(void **state)
{
    (void)state;
    WrSession *s = on_mask();
    const char *const same[][2] = {
        { "select height low=0.3 high=0.8 soft=0.2",
          "layer mask 2 from=height low=0.3 high=0.8 soft=0.2" },
        { "select slope low=10 high=60 soft=5", "layer mask 2 from=slope low=10 high=60 soft=5" },
        { "select slope", "layer mask 2 from=slope" },
        { "select rect from=0.2,0.1 to=0.4,0.9", "layer mask 2 from=selection" },
    };
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        must_run(s, same[k][0]);
        must_run(s, same[k][1]);
        assert_true(same_field(doc(s)->selection, layer(s, 2)->mask));
        must_run(s, "select all");
        must_run(s, "select mask 2");
        assert_true(same_field(doc(s)->selection, layer(s, 2)->mask));
        must_run(s, "layer mask 2 from=inverse");
        for (int j = 0; j < 90; j += 7)
            for (int i = 0; i < 150; i++)
                assert_true(wr_field_get(layer(s, 2)->mask, i, j) ==
                            1.0f - wr_field_get(doc(s)->selection, i, j));
        must_run(s, "undo 3");
        must_run(s, "select none");
        must_run(s, "layer mask 2 from=white");
    }
    must_fail(s, "layer mask 2 from=height", "low= or high=");
    must_fail(s, "layer mask 2 from=white low=0", "low= belongs to");
    must_fail(s, "layer mask 1 from=inverse", "layer 1 has no mask");
    must_fail(s, "select mask 1", "layer 1 has no mask");
    must_fail(s, "layer use 1 part=mask", "`layer mask 1 from=white` adds one");
    must_run(s, "layer mask 2 from=none");
    assert_false(layer(s, 2)->on_mask);
    must_run(s, "fill 3"); /* heights again */
    assert_true(wr_field_get(layer(s, 2)->heights, 5, 5) == 3);
    wr_session_free(s);
}

static void files_keep_whether_edits_go_to_the_mask(void **state)
{
    (void)state;
    WrSessionOptions options = { .outputs = true };
    WrSession *s = wr_session_new(&options), *read = wr_session_new(NULL);
    const char *const lines[] = {
        "table 40x30",           "layer add top", "layer mask 2 from=white",
        "layer use 2 part=mask", "layer use 1",   "dab 0.2,0.2 radius=9.3 strength=0.6"
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) must_run(s, lines[i]);
    const char *const files[] = { "m.exr", "m.ora" };
    for (int k = 0; k < 2; k++) {
        char line[40];
        snprintf(line, sizeof line, "save %s", files[k]);
        must_run(s, line);
        snprintf(line, sizeof line, "open %s", files[k]);
        must_run(read, line);
        assert_true(layer(read, 2)->on_mask);
        assert_false(layer(read, 1)->on_mask);
        assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(read)));
    }
    wr_session_free(read);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_edit_does_to_a_mask_what_it_does_to_heights_kept_to_0_and_1),
        cmocka_unit_test(a_stroke_in_progress_reaches_the_mask_at_once_and_can_be_given_up),
        cmocka_unit_test(masks_come_from_heights_slopes_fills_and_themselves),
        cmocka_unit_test(files_keep_whether_edits_go_to_the_mask),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
