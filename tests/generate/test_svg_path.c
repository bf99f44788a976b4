/* Path data as points: parsing, boxes of curves, moving, dividing, removing. */
#include "test.h"

#include "base/text.h"
#include "generate/svg_path.h"

static WrSvgPath parsed(const char *text)
{
    WrSvgPath path;
    if (!wr_svg_path_parse(text, &path)) fail_msg("refused: %s", text);
    return path;
}

static void check_text(const WrSvgPath *path, const char *want)
{
    WrText text = { 0 };
    wr_svg_path_print(path, 4, &text);
    assert_string_equal(wr_text_get(&text), want);
    wr_text_fini(&text);
}

static void commands_become_absolute(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "m1 2 3-4.5.5.25z l2,2", "M1,2 L4,-2.5 L4.5,-2.25 Z L3,4" },
        { "M1e1+2H7v-3Zm1,1h2", "M10,2 L7,2 L7,-1 Z M11,3 L13,3" },
        { "M0 0c1,2 3,4 5,6s1,1,2,2", NULL },
        { "M0,0Q1,2 3,3t2 1T9,9", NULL },
        { "M1,1a2 3 45 1 0 4,5 2,3,0,017,8", "M1,1 A2 3 45 1 0 5 6 A2 3 0 0 1 12 14" },
        { "M0,0 5,1 2,7", "M0,0 L5,1 L2,7" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrSvgPath path = parsed(cases[i][0]);
        if (cases[i][1]) check_text(&path, cases[i][1]);
        wr_svg_path_fini(&path);
    }
    WrSvgPath s = parsed(cases[2][0]), t = parsed(cases[3][0]);
    /* 2 (5,6) - (3,4) = (7,8); 2 (3,3) - (1,2) = (5,4), then 2 (5,4) - (5,4) */
    check_text(&s, "M0,0 C1,2 3,4 5,6 C7,8 6,7 7,8");
    check_text(&t, "M0,0 Q1,2 3,3 Q5,4 5,4 Q5,4 9,9");
    wr_svg_path_fini(&s);
    wr_svg_path_fini(&t);
    static const char *const wrong[] = { "",        "L1,1", "M1", "M1,1 L2",
                                         "M1,1 X3", "M1,.", "Z",  "M0,0A1 1 0 2 0 3 3",
                                         "M1e999,0" };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        WrSvgPath path;
        if (wr_svg_path_parse(wrong[i], &path)) fail_msg("accepted: %s", wrong[i]);
    }
}

static void check_box(const WrSvgPath *path, const double *want)
{
    WrSvgOutline outline;
    double box[4];
    wr_svg_path_outline(path, &outline);
    wr_svg_outline_box(&outline, box);
    for (int k = 0; k < 4; k++)
        if (fabs(box[k] - want[k]) > 2e-4) fail_msg("%d: %g, not %g", k, box[k], want[k]);
    wr_svg_outline_fini(&outline);
}

/* Circles by arcs reach their radius; the extremes of y = 3 t (1 - t)^2 a + 3 t^2 (1 - t) a are at t = 1/2: 3 a / 4. */
static void boxes_are_those_of_the_curves(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double box[4];
    } cases[] = {
        { "M-3,5 A7 7 0 0 1 11,5 A7 7 0 1 1 -3 5Z", { -3, -2, 14, 14 } },
        { "M2,0 C2,8 10,8 10,0", { 2, 0, 8, 6 } },
        { "M2,0 Q6,-8 10,0", { 2, -4, 8, 4 } },
        /* too small radii grow until they reach: a half circle of radius 4, below, as y runs down */
        { "M0,0 A1 1 0 0 0 8,0", { 0, 0, 8, 4 } },
        /* an ellipse of half axes 6 and 2, turned by 90 degrees */
        { "M0,-6 A6 2 90 0 1 0,6 A6 2 90 0 1 0,-6", { -2, -6, 4, 12 } },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrSvgPath path = parsed(cases[i].text);
        check_box(&path, cases[i].box);
        wr_svg_path_fini(&path);
    }
}

static void the_handles_of_a_moved_end_follow(void **state)
{
    (void)state;
    WrSvgPoint points[9];
    WrSvgPath path = parsed("M0,0 C1,1 4,4 5,5 C6,7 8,9 10,10 Z");
    assert_int_equal(wr_svg_path_points(&path, points, 9), 7);
    assert_true(points[3].x == 5.0 && !points[3].handle && points[2].handle &&
                points[2].of[0] == 5);
    wr_svg_path_move(&path, &points[3], 7.0, 2.0);
    check_text(&path, "M0,0 C1,1 6,1 7,2 C8,4 8,9 10,10 Z");
    wr_svg_path_points(&path, points, 9);
    wr_svg_path_move(&path, &points[1], 0.0, -1.0);
    check_text(&path, "M0,0 C0,-1 6,1 7,2 C8,4 8,9 10,10 Z");
    wr_svg_path_fini(&path);
}

static void a_divided_piece_keeps_its_form(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double x, y;
        int points;
    } cases[] = {
        { "M2,0 C2,8 10,8 10,0", 4, 5.4, 4 + 3 },
        { "M2,0 Q6,-8 10,0", 9, -2, 3 + 2 },
        { "M-3,5 A7 7 0 0 1 11,5 A7 7 0 1 1 -3 5Z", 4, 12, 3 + 1 },
        { "M1,1 9,1 9,8Z", 5, 4.6, 3 + 1 }, /* the side that Z closes */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrSvgPath path = parsed(cases[i].text);
        WrSvgOutline outline;
        WrSvgPoint points[16];
        double before[4], nearest = 1e9;
        wr_svg_path_outline(&path, &outline);
        wr_svg_outline_box(&outline, before);
        wr_svg_outline_fini(&outline);
        assert_true(wr_svg_path_divide(&path, cases[i].x, cases[i].y));
        check_box(&path, before);
        const int count = wr_svg_path_points(&path, points, 16);
        assert_int_equal(count, cases[i].points);
        for (int k = 0; k < count; k++)
            if (!points[k].handle)
                nearest = fmin(nearest, hypot(points[k].x - cases[i].x, points[k].y - cases[i].y));
        if (nearest > 0.3) fail_msg("%s: the new point is %g away", cases[i].text, nearest);
        wr_svg_path_fini(&path);
    }
}

static void removed_points_leave_a_path(void **state)
{
    (void)state;
    WrSvgPoint points[9];
    WrSvgPath path = parsed("M0,0 L5,0 C6,1 7,2 5,5 L0,5 Z");
    wr_svg_path_points(&path, points, 9);
    assert_true(wr_svg_path_remove(&path, &points[0])); /* the start */
    check_text(&path, "M5,0 C6,1 7,2 5,5 L0,5 Z");
    wr_svg_path_points(&path, points, 9);
    assert_true(wr_svg_path_remove(&path, &points[1])); /* a handle: straight */
    check_text(&path, "M5,0 L5,5 L0,5 Z");
    wr_svg_path_points(&path, points, 9);
    assert_false(wr_svg_path_remove(&path, &points[1])); /* two points cover nothing */
    wr_svg_path_fini(&path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_become_absolute),
        cmocka_unit_test(boxes_are_those_of_the_curves),
        cmocka_unit_test(the_handles_of_a_moved_end_follow),
        cmocka_unit_test(a_divided_piece_keeps_its_form),
        cmocka_unit_test(removed_points_leave_a_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
