/* Building blocks of the Accuracy panel: the plot's axes and points, and the schedule of measurements. */
#include "test.h"

#include "ui/accuracy/accuracy_plan.h"
#include "ui/accuracy/accuracy_plot.h"

/* ---- the plot ---- */

static bool is_round(double x)
{
    const double e = floor(log10(x) + 1e-9), m = x / pow(10, e);
    return fabs(m - 1) < 1e-9 || fabs(m - 2) < 1e-9 || fabs(m - 5) < 1e-9;
}

static void an_axis_holds_every_value_between_round_ends(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int k = 0; k < 500; k++) {
        double values[7];
        WrPlotAxis axis;
        for (int i = 0; i < 7; i++) values[i] = pow(10, 24 * test_random(&random) - 12);
        if (k % 2)
            for (int i = 1; i < 7; i++) values[i] = values[0];
        assert_true(wr_plot_axis(values, 7, &axis));
        assert_true(is_round(axis.low) && is_round(axis.high));
        assert_true(axis.high / axis.low > 3.1);
        for (int i = 0; i < 7; i++) {
            const double place = wr_plot_place(&axis, values[i]);
            assert_true(place > 0 && place < 1);
        }
    }
}

static void values_that_have_no_logarithm_do_not_count(void **state)
{
    (void)state;
    const double nothing[] = { 0, -1, (double)NAN, (double)INFINITY };
    const double some[] = { 0, 3, (double)NAN, (double)INFINITY, -4 };
    WrPlotAxis axis = { 1, 2 };
    assert_false(wr_plot_axis(nothing, 4, &axis));
    assert_false(wr_plot_axis(NULL, 0, &axis));
    assert_true(axis.low == 1 && axis.high == 2);
    assert_true(wr_plot_axis(some, 5, &axis));
    assert_true(axis.low < 3 && axis.high > 3 && axis.high <= 20);
    assert_true(wr_plot_place(&axis, 0) == 0 && wr_plot_place(&axis, -1) == 0);
}

static void ticks_are_round_ascend_and_are_never_too_many(void **state)
{
    (void)state;
    static const WrPlotAxis axes[] = { { 1, 10 }, { 0.002, 0.5 }, { 1e-9, 1e9 }, { 5, 20 } };
    for (size_t k = 0; k < sizeof axes / sizeof *axes; k++)
        for (int room = 2; room <= 12; room++) {
            double ticks[12];
            const int count = wr_plot_ticks(&axes[k], ticks, room);
            assert_true(count <= room);
            for (int i = 0; i < count; i++) {
                assert_true(is_round(ticks[i]));
                assert_true(ticks[i] >= axes[k].low * 0.999 && ticks[i] <= axes[k].high * 1.001);
                assert_true(i == 0 || ticks[i] > ticks[i - 1]);
            }
        }
    double ticks[12];
    assert_int_equal(wr_plot_ticks(&axes[0], ticks, 12), 4); /* 1 2 5 10 */
    assert_true(ticks[0] == 1 && ticks[1] == 2 && ticks[2] == 5 && ticks[3] == 10);
    assert_int_equal(wr_plot_ticks(&axes[0], ticks, 3), 2);  /* 1 10 */
    assert_int_equal(wr_plot_ticks(&axes[1], ticks, 12), 8); /* .002 .005 .01 .02 .05 .1 .2 .5 */
    assert_true(ticks[0] == 0.002 && ticks[7] == 0.5);
}

static void places_go_by_ratios(void **state)
{
    (void)state;
    const WrPlotAxis axis = { 0.01, 100 };
    assert_near(wr_plot_place(&axis, 0.01), 0, 1e-15);
    assert_near(wr_plot_place(&axis, 0.1), 0.25, 1e-12);
    assert_near(wr_plot_place(&axis, 1), 0.5, 1e-12);
    assert_near(wr_plot_place(&axis, 100), 1, 1e-12);
}

static void the_nearest_point_is_found_only_within_reach(void **state)
{
    (void)state;
    const double points[][2] = { { 0, 0 }, { 10, 0 }, { 10, 4 }, { 10, 4 } };
    assert_int_equal(wr_plot_nearest(points, 4, 9, 1, 5), 1);
    assert_int_equal(wr_plot_nearest(points, 4, 10, 3, 5), 2); /* the first of two that are equal */
    assert_int_equal(wr_plot_nearest(points, 4, 5, 0, 4.9), -1);
    assert_int_equal(wr_plot_nearest(points, 4, 5, 0, 5), 0);
    assert_int_equal(wr_plot_nearest(points, 0, 5, 0, 500), -1);
}

static void scales_end_at_round_numbers_and_numbers_are_short(void **state)
{
    (void)state;
    char text[16];
    assert_near(wr_plot_round_up(0.7), 1, 1e-12);
    assert_near(wr_plot_round_up(1), 1, 1e-12);
    assert_near(wr_plot_round_up(1.01), 2, 1e-12);
    assert_near(wr_plot_round_up(0.0021), 0.005, 1e-15);
    assert_near(wr_plot_round_up(51), 100, 1e-9);
    assert_near(wr_plot_round_up(0), 1, 0);
    assert_near(wr_plot_round_up((double)NAN), 1, 0);
    TestRandom random = { 9 };
    for (int i = 0; i < 1000; i++) {
        const double x = pow(10, 40 * test_random(&random) - 20) * (i % 2 ? 1 : -1);
        assert_true(strlen(wr_plot_number(x, text)) <= 8);
        assert_near(strtod(text, NULL) / x, 1, 0.06);
    }
    assert_string_equal(wr_plot_number(0, text), "0");
    assert_string_equal(wr_plot_number(0.02, text), "0.02");
    assert_string_equal(wr_plot_number(250, text), "250");
}

/* ---- when ---- */

static const WrAccuracyMoment quiet = {
    .now = 100, .changed_at = 50, .rests = true, .open = true, .plot_open = true
};

static void nothing_is_measured_while_the_hand_works_or_nobody_looks(void **state)
{
    (void)state;
    double due = -1;
    WrAccuracyMoment m = quiet;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_ERROR);
    m.rests = false;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    assert_true(due == 0); /* an idle program waits only for events */
    m = quiet;
    m.busy = true;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    assert_true(due == 0);
    m = quiet;
    m.open = m.plot_open = false;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    assert_true(due == 0);
    m = quiet;
    m.error_known = m.plot_known = true;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    assert_true(due == 0);
}

static void the_error_waits_a_moment_and_the_ladder_for_the_error(void **state)
{
    (void)state;
    double due;
    WrAccuracyMoment m = quiet;
    m.now = m.changed_at + 0.5 * WR_ACCURACY_REST;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    assert_near(due, m.changed_at + WR_ACCURACY_REST, 1e-9);
    m.now = due;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_ERROR);
    m.error_known = true;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    assert_near(due, m.changed_at + WR_ACCURACY_LADDER_REST, 1e-9);
    m.now = due;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_LADDER);
    m.plot_known = true;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    m.plot_asked = true; /* again, and at once */
    m.now = m.changed_at;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_LADDER);
}

static void two_pictures_flicker_twice_a_second(void **state)
{
    (void)state;
    double next, now = 7;
    int changes = 0;
    bool shown = wr_accuracy_flicker(now, 7, &next);
    assert_false(shown);
    while (now < 12 - 1e-9) {
        assert_true(next > now);
        now = next + 1e-9;
        const bool other = wr_accuracy_flicker(now, 7, &next);
        assert_true(other != shown);
        shown = other;
        changes++;
    }
    assert_in_range(changes, 19, 21); /* in five seconds, both ways */
}

static void the_line_between_two_pictures_stays_in_reach(void **state)
{
    (void)state;
    assert_near(wr_accuracy_split_at(150, 100, 200, 10), 0.25, 1e-12);
    assert_near(wr_accuracy_split_at(0, 100, 200, 10), 0.05, 1e-12);
    assert_near(wr_accuracy_split_at(900, 100, 200, 10), 0.95, 1e-12);
    assert_near(wr_accuracy_split_at(900, 100, 10, 10), 0.5, 1e-12);
    assert_near(wr_accuracy_split_at(5, 0, 0, 10), 0.5, 1e-12);
}

static void a_fitted_picture_keeps_its_shape(void **state)
{
    (void)state;
    int w, h;
    wr_accuracy_fit(1000, 500, 256, &w, &h);
    assert_int_equal(w, 256);
    assert_int_equal(h, 128);
    wr_accuracy_fit(100, 50, 256, &w, &h);
    assert_int_equal(w, 100);
    assert_int_equal(h, 50);
    wr_accuracy_fit(4000, 2, 256, &w, &h);
    assert_int_equal(w, 256);
    assert_int_equal(h, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_axis_holds_every_value_between_round_ends),
        cmocka_unit_test(values_that_have_no_logarithm_do_not_count),
        cmocka_unit_test(ticks_are_round_ascend_and_are_never_too_many),
        cmocka_unit_test(places_go_by_ratios),
        cmocka_unit_test(the_nearest_point_is_found_only_within_reach),
        cmocka_unit_test(scales_end_at_round_numbers_and_numbers_are_short),
        cmocka_unit_test(nothing_is_measured_while_the_hand_works_or_nobody_looks),
        cmocka_unit_test(the_error_waits_a_moment_and_the_ladder_for_the_error),
        cmocka_unit_test(two_pictures_flicker_twice_a_second),
        cmocka_unit_test(the_line_between_two_pictures_stays_in_reach),
        cmocka_unit_test(a_fitted_picture_keeps_its_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
