/* Stroke stabilizer: the follower of the pointer, smooth or on a string. */
#include "test.h"

#include "ui/input/stroke_smoothing.h"

#include <math.h>
#include <stdint.h>

typedef struct Line {
    WrSmoothingPoint points[8192];
    int count;
} Line;

static WrSmoothingPoint at(double x, double y)
{
    return (WrSmoothingPoint){ .x = x, .y = y, .pressure = 1 };
}

static void move(WrSmoothing *steady, double x, double y, Line *line)
{
    WrSmoothingPoint out[WR_SMOOTHING_POINTS], to = at(x, y);
    int count = wr_smoothing_move(steady, &to, out);
    assert_in_range(count, 0, WR_SMOOTHING_POINTS);
    for (int i = 0; line && i < count; i++) line->points[line->count++] = out[i];
}

static WrSmoothing begin(WrSmoothingKind kind, double length, double x, double y)
{
    WrSmoothing steady;
    WrSmoothingPoint from = at(x, y);
    wr_smoothing_begin(&steady, kind, length, &from);
    return steady;
}

/* The same path from (0,0) through corners, each leg in `pieces` motions. */
static WrSmoothing walk(WrSmoothingKind kind, int pieces)
{
    static const double corner[][2] = {
        { 90, 20 }, { 40, 140 }, { 200, 60 }, { 190, 70 }, { 0, 0 }
    };
    WrSmoothing steady = begin(kind, 35, 0, 0);
    double x = 0, y = 0;
    for (size_t c = 0; c < sizeof corner / sizeof *corner; c++) {
        for (int i = 1; i <= pieces; i++) {
            double t = (double)i / pieces;
            move(&steady, x + t * (corner[c][0] - x), y + t * (corner[c][1] - y), NULL);
        }
        x = corner[c][0];
        y = corner[c][1];
    }
    return steady;
}

static void without_steadying_every_place_of_the_pointer_comes_through(void **state)
{
    (void)state;
    WrSmoothing steady = begin(WR_SMOOTHING_OFF, 50, 3, 4);
    WrSmoothingPoint out[WR_SMOOTHING_POINTS];
    WrSmoothingPoint to = { .x = 10.25, .y = -7.5, .pressure = 0.3, .tilt_x = 0.1, .seconds = 2 };
    assert_int_equal(wr_smoothing_move(&steady, &to, out), 1);
    assert_memory_equal(&out[0], &to, sizeof to);
    assert_int_equal(wr_smoothing_move(&steady, &to, out), 1); /* resting, pressing harder */
    assert_int_equal(wr_smoothing_end(&steady, true, out), 0);
    /* a length of 0 is no smoothing either */
    steady = begin(WR_SMOOTHING_STRING, 0, 3, 4);
    assert_int_equal(wr_smoothing_move(&steady, &to, out), 1);
    assert_true(out[0].x == to.x && out[0].y == to.y);
}

static void on_a_straight_way_the_smooth_line_lags_as_the_equation_says(void **state)
{
    (void)state;
    const double length = 30;
    for (double way = 1; way < 400; way *= 1.7) {
        WrSmoothing steady = begin(WR_SMOOTHING_SMOOTH, length, 5, 8);
        move(&steady, 5 + 0.6 * way, 8 + 0.8 * way, NULL);
        double follows = way - length * (1 - exp(-way / length));
        assert_near(steady.follower.x, 5 + 0.6 * follows, 1e-9);
        assert_near(steady.follower.y, 8 + 0.8 * follows, 1e-9);
    }
}

static void a_string_that_hangs_slack_moves_nothing(void **state)
{
    (void)state;
    WrSmoothing steady = begin(WR_SMOOTHING_STRING, 40, 100, 100);
    WrSmoothingPoint out[WR_SMOOTHING_POINTS];
    for (int i = 0; i < 200; i++) {
        double a = 0.37 * i, r = 39.9 * (i % 10) / 10.0;
        WrSmoothingPoint to = at(100 + r * cos(a), 100 + r * sin(a));
        assert_int_equal(wr_smoothing_move(&steady, &to, out), 0);
    }
    assert_true(steady.follower.x == 100 && steady.follower.y == 100);
}

static void a_string_pulled_straight_is_as_long_as_it_is(void **state)
{
    (void)state;
    WrSmoothing steady = begin(WR_SMOOTHING_STRING, 40, 0, 0);
    move(&steady, 100, 0, NULL);
    assert_near(steady.follower.x, 60, 1e-9);
    assert_near(steady.follower.y, 0, 1e-9);
}

static void a_string_pulled_aside_draws_the_tractrix(void **state)
{
    (void)state;
    /* The pointer is at the origin, the string hangs down along +y and is pulled along +x: x = s - L tanh(s/L), y = L
       / cosh(s/L). */
    const double length = 50;
    WrSmoothing steady = begin(WR_SMOOTHING_STRING, length, 0, 0);
    move(&steady, 0, -length, NULL); /* just taut: no motion yet */
    assert_near(steady.follower.y, 0, 1e-9);
    Line line = { .count = 0 };
    move(&steady, 130, -length, &line);
    assert_true(line.count > 20);
    for (int i = 0; i < line.count; i++) {
        double s = 130.0 * (i + 1) / line.count;
        assert_near(line.points[i].x, s - length * tanh(s / length), 1e-6);
        assert_near(line.points[i].y + length, length / cosh(s / length), 1e-6);
    }
}

static void the_line_does_not_depend_on_how_the_way_was_cut_into_events(void **state)
{
    (void)state;
    const WrSmoothingKind kinds[] = { WR_SMOOTHING_SMOOTH, WR_SMOOTHING_STRING };
    for (int k = 0; k < 2; k++) {
        WrSmoothing once = walk(kinds[k], 1);
        for (int pieces = 2; pieces <= 1000; pieces = 3 * pieces + 1) {
            WrSmoothing cut = walk(kinds[k], pieces);
            assert_near(cut.follower.x, once.follower.x, 1e-6);
            assert_near(cut.follower.y, once.follower.y, 1e-6);
        }
        /* and it differs from the pointer's own path */
        assert_true(hypot(once.follower.x, once.follower.y) > 5);
    }
}

static void a_string_never_stretches(void **state)
{
    (void)state;
    WrSmoothing steady = begin(WR_SMOOTHING_STRING, 25, 0, 0);
    uint32_t random = 1;
    for (int i = 0; i < 20000; i++) {
        random = random * 1664525u + 1013904223u;
        double x = (random >> 8) % 400;
        random = random * 1664525u + 1013904223u;
        move(&steady, x, (random >> 8) % 300, NULL);
        double long_now =
            hypot(steady.pointer.x - steady.follower.x, steady.pointer.y - steady.follower.y);
        assert_true(long_now <= 25 * (1 + 1e-9));
    }
}

static void a_shaking_hand_draws_a_calmer_line(void **state)
{
    (void)state;
    for (int k = WR_SMOOTHING_SMOOTH; k <= WR_SMOOTHING_STRING; k++) {
        WrSmoothing steady = begin((WrSmoothingKind)k, 40, 0, 0);
        Line line = { .count = 0 };
        for (int i = 1; i <= 300; i++) move(&steady, 2.0 * i, i % 2 ? 4 : -4, &line);
        double worst = 0;
        for (int i = line.count / 2; i < line.count; i++)
            worst = fmax(worst, fabs(line.points[i].y));
        assert_true(worst < 1.0); /* of 4 */
    }
}

static void pressure_is_that_of_the_pointer_on_its_way(void **state)
{
    (void)state;
    WrSmoothing steady = begin(WR_SMOOTHING_SMOOTH, 20, 0, 0);
    WrSmoothingPoint to = { .x = 60, .y = 0, .pressure = 0.4, .tilt_y = -0.6, .seconds = 0.5 };
    WrSmoothingPoint out[WR_SMOOTHING_POINTS];
    int count = wr_smoothing_move(&steady, &to, out);
    assert_true(count > 2);
    for (int i = 0; i < count; i++) {
        double t = (i + 1.0) / count;
        assert_near(out[i].pressure, 1 - 0.6 * t, 1e-12);
        assert_near(out[i].tilt_y, -0.6 * t, 1e-12);
        assert_near(out[i].seconds, 0.5 * t, 1e-12);
    }
}

static void a_smooth_line_ends_at_the_pointer_and_one_on_a_string_if_asked(void **state)
{
    (void)state;
    WrSmoothingPoint out;
    WrSmoothing steady = begin(WR_SMOOTHING_SMOOTH, 20, 0, 0);
    move(&steady, 50, 10, NULL);
    assert_int_equal(wr_smoothing_end(&steady, false, &out), 1);
    assert_true(out.x == 50 && out.y == 10);
    assert_int_equal(wr_smoothing_end(&steady, false, &out), 0);
    steady = begin(WR_SMOOTHING_STRING, 20, 0, 0);
    move(&steady, 50, 10, NULL);
    assert_int_equal(wr_smoothing_end(&steady, false, &out), 0);
    assert_int_equal(wr_smoothing_end(&steady, true, &out), 1);
    assert_true(out.x == 50 && out.y == 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_steadying_every_place_of_the_pointer_comes_through),
        cmocka_unit_test(on_a_straight_way_the_smooth_line_lags_as_the_equation_says),
        cmocka_unit_test(a_string_that_hangs_slack_moves_nothing),
        cmocka_unit_test(a_string_pulled_straight_is_as_long_as_it_is),
        cmocka_unit_test(a_string_pulled_aside_draws_the_tractrix),
        cmocka_unit_test(the_line_does_not_depend_on_how_the_way_was_cut_into_events),
        cmocka_unit_test(a_string_never_stretches),
        cmocka_unit_test(a_shaking_hand_draws_a_calmer_line),
        cmocka_unit_test(pressure_is_that_of_the_pointer_on_its_way),
        cmocka_unit_test(a_smooth_line_ends_at_the_pointer_and_one_on_a_string_if_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
