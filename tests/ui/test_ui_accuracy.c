/* Building blocks of the Accuracy panel: the schedule of measurements, and comparisons of two pictures. */
#include "test.h"

#include "ui/panels/accuracy/accuracy_schedule.h"

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

static void the_error_waits_a_moment_and_the_benchmark_for_the_error(void **state)
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
    assert_near(due, m.changed_at + WR_ACCURACY_BENCHMARK_REST, 1e-9);
    m.now = due;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_BENCHMARK);
    m.plot_known = true;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_NOTHING);
    m.plot_asked = true; /* again, and at once */
    m.now = m.changed_at;
    assert_int_equal(wr_accuracy_next(&m, &due), WR_ACCURACY_BENCHMARK);
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
    assert_near(wr_accuracy_split_from_pointer(150, 100, 200, 10), 0.25, 1e-12);
    assert_near(wr_accuracy_split_from_pointer(0, 100, 200, 10), 0.05, 1e-12);
    assert_near(wr_accuracy_split_from_pointer(900, 100, 200, 10), 0.95, 1e-12);
    assert_near(wr_accuracy_split_from_pointer(900, 100, 10, 10), 0.5, 1e-12);
    assert_near(wr_accuracy_split_from_pointer(5, 0, 0, 10), 0.5, 1e-12);
}

static void a_fitted_picture_keeps_its_shape(void **state)
{
    (void)state;
    int w, h;
    wr_accuracy_picture_size(1000, 500, 256, &w, &h);
    assert_int_equal(w, 256);
    assert_int_equal(h, 128);
    wr_accuracy_picture_size(100, 50, 256, &w, &h);
    assert_int_equal(w, 100);
    assert_int_equal(h, 50);
    wr_accuracy_picture_size(4000, 2, 256, &w, &h);
    assert_int_equal(w, 256);
    assert_int_equal(h, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_measured_while_the_hand_works_or_nobody_looks),
        cmocka_unit_test(the_error_waits_a_moment_and_the_benchmark_for_the_error),
        cmocka_unit_test(two_pictures_flicker_twice_a_second),
        cmocka_unit_test(the_line_between_two_pictures_stays_in_reach),
        cmocka_unit_test(a_fitted_picture_keeps_its_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
