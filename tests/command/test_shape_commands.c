/* shape, flood, ramp as commands: areas, outlines, edges, selections and layers. */
#include "test.h"
#include "session_help.h"

#include "base/exactmath.h"
#include "base/progress.h"
#include "command/session.h"

static double sum_of(const WrSession *s)
{
    const WrField *f = wr_document_field(doc(s));
    double sum = 0;
    for (int j = 0; j < wr_field_height(f); j++)
        for (int i = 0; i < wr_field_width(f); i++) sum += wr_field_get(f, i, j);
    return sum;
}

/* A fill that raises by 1 covers as many texels as its area. */
static void fills_cover_the_area_of_their_shapes(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        double area, tolerance;
    } known[] = {
        { "shape rectangle a=0.1,0.2 b=0.6,0.7", 100 * 50, 0.01 },
        { "shape rectangle a=0.1,0.2 b=0.6,0.7 turn=37", 100 * 50, 0.05 },
        { "shape rectangle a=0.1,0.2 b=0.6,0.7 corner=20", 100 * 50 - (4 - WR_PI) * 400, 0.3 },
        { "shape ellipse middle=0.5,0.5 radii=0.3,0.2", WR_PI * 60 * 20, 0.5 },
        { "shape ellipse middle=0.95,0.02 radii=0.3,0.2 turn=45", WR_PI * 60 * 20, 0.5 },
        { "shape polygon points=0.1,0.1;0.6,0.1;0.1,0.9", 100 * 80 / 2.0, 0.05 },
        { "shape polygon points=0.9,0.1;1.4,0.1;0.9,0.9", 100 * 80 / 2.0, 0.05 },
        { "shape path points=0.2,0.1;0.2,0.6;0.6,0.6;0.6,0.1", 0.6 * 80 * 50, 0.3 },
        { "shape ellipse middle=0.2,0.2 radii=0.05,0.1 repeat=3x2", 6 * WR_PI * 10 * 10, 0.5 },
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char line[200];
        WrSession *s = session_of((const char *[]){ "table 200x100", NULL });
        snprintf(line, sizeof line, "%s paint=fill strength=1", known[i].line);
        must_run(s, line);
        if (fabs(sum_of(s) - known[i].area) > known[i].tolerance)
            fail_msg("%s: %.9g, should be %.9g", line, sum_of(s), known[i].area);
        wr_session_free(s);
    }
}

static void an_outline_is_the_stroke_along_it(void **state)
{
    (void)state;
    WrSession *a = session_of((const char *[]){
        "table 200x100", "shape polygon points=0.2,0.2;0.6,0.2;0.6,0.7 radius=6 strength=1",
        NULL });
    WrSession *b = session_of(
        (const char *[]){ "table 200x100",
                          "stroke points=0.2,0.2;0.4,0.2;0.6,0.2;0.6,0.45;0.6,0.7;0.4,0.45;0.2,0.2 "
                          "radius=6 strength=1",
                          NULL });
    for (int j = 0; j < 100; j++)
        for (int i = 0; i < 200; i++) assert_near(f_at(a, i, j), f_at(b, i, j), 1e-5);
    wr_session_free(a);
    wr_session_free(b);
}

/* The side of a rectangle is longer than half the table, where strokes take the shorter way round. */
static void hc73_a_long_side_goes_the_way_it_is_drawn(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 100x100", "shape rectangle a=0.1,0.1 b=0.9,0.9 radius=3 strength=1", NULL });
    assert_true(f_at(s, 50, 89) == 1); /* the lower side's middle */
    assert_true(f_at(s, 10, 50) == 1);
    assert_true(f_at(s, 0, 89) == 0); /* beyond its ends, across the edge */
    assert_true(f_at(s, 50, 50) == 0);
    must_run(s, "fill 0"); /* one around the whole table, and half again */
    must_run(s, "shape path points=0.1,0.5;0.6,0.5;1.1,0.5;1.6,0.5 radius=3 strength=1");
    for (int i = 0; i < 100; i++) assert_true(f_at(s, i, 50) == 1);
    wr_session_free(s);
}

/* Heights along the line of a circle: an additional dab at the joint would be visible. */
static void a_closed_outline_has_no_doubled_dab_where_it_meets_itself(void **state)
{
    (void)state;
    static const char *const brushes[] = { "buildup=on flow=0.1 spacing=0.5", "flow=0.3",
                                           "spacing=2.5 buildup=on",
                                           "mode=raise radius=7.3 flow=0.2" };
    for (size_t k = 0; k < sizeof brushes / sizeof *brushes; k++) {
        char line[200];
        WrSession *s = session_of((const char *[]){ "table 256x256", NULL });
        snprintf(line, sizeof line, "shape ellipse middle=0.5,0.5 radii=0.3,0.3 strength=1%s %s",
                 strstr(brushes[k], "radius") ? "" : " radius=6", brushes[k]);
        must_run(s, line);
        double joint = 0, most = 0; /* the joint is at the right end */
        for (int turn = 0; turn < 360; turn++) {
            double x = 127.5 + 76.8 * cos(turn * WR_RAD_PER_DEG);
            double y = 127.5 - 76.8 * sin(turn * WR_RAD_PER_DEG), sum = 0;
            for (int j = -8; j <= 8; j++)
                for (int i = -8; i <= 8; i++) sum += f_at(s, (int)rint(x) + i, (int)rint(y) + j);
            if (turn < 8 || turn > 352) joint = fmax(joint, sum);
            else most = fmax(most, sum);
        }
        if (joint > 1.03 * most || joint < 0.8 * most)
            fail_msg("%s: %g at the joint, %g elsewhere", line, joint, most);
        wr_session_free(s);
    }
}

static void shapes_move_with_whole_texels_across_the_edges(void **state)
{
    (void)state;
    static const char *const shapes[][2] = {
        { "shape ellipse middle=0.25,0.5 radii=0.125,0.25 turn=30 paint=fill",
          "shape ellipse middle=0.75,1.25 radii=0.125,0.25 turn=30 paint=fill" },
        { "shape rectangle a=0.125,0.25 b=0.375,0.5 corner=5 radius=4",
          "shape rectangle a=0.625,1 b=0.875,1.25 corner=5 radius=4" }
    };
    for (int k = 0; k < 2; k++) {
        WrSession *a = session_of((const char *[]){ "table 128x64", shapes[k][0], NULL });
        WrSession *b = session_of((const char *[]){ "table 128x64", shapes[k][1], NULL });
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 128; i++)
                assert_near(f_at(a, i, j), f_at(b, (i + 64) % 128, (j + 16) % 64), 1e-7);
        assert_true(sum_of(a) > 10);
        wr_session_free(a);
        wr_session_free(b);
    }
}

static void a_flood_fills_one_part_of_the_composite_on_the_active_layer(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 128x128", "grid cells=4x4 width=8 high=1",
                                                "layer add top blend=max",
                                                "flood 0.1,0.1 mode=to to=3 strength=9", NULL });
    const WrLayer *top = &doc(s)->layers[1];
    int filled = 0;
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++) { /* the lower left cell, between its lines */
            bool in = i >= 4 && i < 28 && j >= 100 && j < 124;
            assert_true(f_at(s, i, j) ==
                        (in ? 3.0f : wr_field_get(doc(s)->layers[0].heights, i, j)));
            assert_true(wr_field_get(top->cover, i, j) == (in ? 1.0f : 0.0f));
            filled += in;
        }
    assert_int_equal(filled, 24 * 24);
    must_run(s, "select flood 0,0 tolerance=0.5"); /* the lines, across all edges */
    int selected = 0;
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++) selected += wr_field_get(doc(s)->selection, i, j) == 1;
    assert_int_equal(selected, 128 * 128 - 16 * 24 * 24);
    must_run(s, "select flood 0.1,0.1 mode=add");
    must_run(s, "layer use 1");
    must_run(s, "fill 7");
    assert_true(f_at(s, 50, 50) == 0);
    assert_true(wr_field_get(doc(s)->layers[0].heights, 10, 110) == 7);
    wr_session_free(s);
}

static void a_ramp_joins_what_is_there_as_its_blend_says(void **state)
{
    (void)state;
    const char *const blends[] = { "replace", "add", "max", "min" };
    for (int k = 0; k < 4; k++) {
        char line[160];
        WrSession *s =
            session_of((const char *[]){ "table 100x30", "grid cells=5x3 high=2", NULL });
        WrSession *old =
            session_of((const char *[]){ "table 100x30", "grid cells=5x3 high=2", NULL });
        must_run(s, "select rect from=0.2,0 to=0.8,1");
        snprintf(line, sizeof line, "ramp linear from=0,0.5 to=1,0.5 low=-1 high=1.5 blend=%s",
                 blends[k]);
        must_run(s, line);
        for (int i = 0; i < 100; i++) {
            double was = f_at(old, i, 5), t = -1 + 2.5 * (i + 0.5) / 100;
            double want = k == 0 ? t : k == 1 ? was + t : k == 2 ? fmax(was, t) : fmin(was, t);
            assert_near(f_at(s, i, 5), i >= 20 && i < 80 ? want : was, 1e-6);
        }
        wr_session_free(s);
        wr_session_free(old);
    }
    WrSession *s = session_of((const char *[]){ "table 8x8", NULL });
    must_fail(s, "ramp cone from=0.5,0.5 to=0.5,0.5", "same point");
    must_fail(s, "ramp linear from=0,0 to=2,0 fold=on", "along u");
    must_run(s, "ramp linear from=0,0 to=0.5,0 low=-3.4e38 high=3.4e38 blend=add");
    must_run(s, "ramp linear from=0,0 to=0.5,0 low=-3.4e38 high=3.4e38 blend=add");
    float low, high;
    wr_field_range(wr_document_field(doc(s)), &low, &high);
    assert_true(isfinite(low) && isfinite(high));
    wr_session_free(s);
}

static void what_is_cancelled_leaves_everything_as_it_was(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "flood 0.1,0.1",
        "select flood 0.1,0.1",
        "ramp cone from=0.5,0.5 to=0.5,1",
        "ramp linear from=0,0 to=1,0 blend=add",
        "shape ellipse middle=0.5,0.5 radii=0.3,0.2 paint=fill",
        "shape ellipse middle=0.5,0.5 radii=0.3,0.2 paint=outline",
    };
    volatile int stop = 1;
    const WrProgress progress = { .cancel = &stop };
    WrError err;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "grid cells=4x4");
    WrHash before = wr_session_hash(s);
    int steps = wr_session_history_position(s);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        wr_progress_set(&progress);
        assert_false(wr_session_run(s, lines[i], &err));
        wr_progress_set(NULL);
        assert_non_null(strstr(err.text, "cancelled"));
        assert_true(wr_hash_equal(wr_session_hash(s), before));
        assert_int_equal(wr_session_history_position(s), steps);
        must_run(s, lines[i]);
        assert_false(wr_hash_equal(wr_session_hash(s), before));
        must_run(s, "undo");
    }
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fills_cover_the_area_of_their_shapes),
        cmocka_unit_test(an_outline_is_the_stroke_along_it),
        cmocka_unit_test(hc73_a_long_side_goes_the_way_it_is_drawn),
        cmocka_unit_test(a_closed_outline_has_no_doubled_dab_where_it_meets_itself),
        cmocka_unit_test(shapes_move_with_whole_texels_across_the_edges),
        cmocka_unit_test(a_flood_fills_one_part_of_the_composite_on_the_active_layer),
        cmocka_unit_test(a_ramp_joins_what_is_there_as_its_blend_says),
        cmocka_unit_test(what_is_cancelled_leaves_everything_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
