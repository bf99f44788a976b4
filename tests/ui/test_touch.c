/* Fingers without a window: presses that are delayed, grips of two fingers, taps. */
#include "test.h"

#include "ui/input/touch.h"

#include <math.h>

#define MANY 64

static WrTouch touch;
static WrTouchOut reports[MANY];
static int count;

static void send(WrTouchKind kind, int64_t id, double x, double y, double seconds)
{
    const WrFinger finger = { .id = id, .x = x, .y = y, .pressure = 0.5, .seconds = seconds };
    if (count + WR_TOUCH_OUT > MANY) count = 0;
    count += wr_touch_event(&touch, kind, &finger, reports + count);
}

static int begin_test(void **state)
{
    (void)state;
    touch = (WrTouch){ 0 };
    count = 0;
    return 0;
}

static void a_press_waits_for_the_first_motion(void **state)
{
    (void)state;
    send(WR_TOUCH_DOWN, 7, 100, 50, 1.0);
    send(WR_TOUCH_MOVE, 7, 103, 52, 1.1);
    assert_int_equal(count, 0);
    send(WR_TOUCH_MOVE, 7, 120, 52, 1.2);
    assert_int_equal(count, 2);
    assert_int_equal(reports[0].report, WR_TOUCH_PRESS);
    assert_true(reports[0].x == 100 && reports[0].y == 50 && reports[0].seconds == 1.0);
    assert_int_equal(reports[1].report, WR_TOUCH_MOTION);
    assert_true(reports[1].x == 120 && reports[1].y == 52);
    send(WR_TOUCH_MOVE, 7, 121, 52, 1.3); /* from then on every motion counts */
    send(WR_TOUCH_UP, 7, 122, 53, 1.4);
    assert_int_equal(count, 4);
    assert_int_equal(reports[2].report, WR_TOUCH_MOTION);
    assert_int_equal(reports[3].report, WR_TOUCH_RELEASE);
    assert_true(reports[3].x == 122);
}

static void a_finger_that_rests_makes_a_dab(void **state)
{
    (void)state;
    send(WR_TOUCH_DOWN, 7, 100, 50, 1.0);
    send(WR_TOUCH_UP, 7, 101, 50, 4.0);
    assert_int_equal(count, 2);
    assert_int_equal(reports[0].report, WR_TOUCH_PRESS);
    assert_int_equal(reports[1].report, WR_TOUCH_RELEASE);
}

/* The point of the picture that was under (x, y) before the grip. */
static void carry(const WrTouchOut *out, double *x, double *y)
{
    const WrGrip *g = &out->grip;
    const double a = g->turn_deg * M_PI / 180.0;
    const double dx = *x - (out->x - g->dx), dy = *y - (out->y - g->dy);
    *x = out->x + g->scale * (cos(a) * dx - sin(a) * dy);
    *y = out->y + g->scale * (sin(a) * dx + cos(a) * dy);
}

/* Whatever two fingers do, both stay on their points of the picture. */
static void two_fingers_hold_their_points(void **state)
{
    (void)state;
    TestRandom r = { 5 };
    double x[2] = { 200, 500 }, y[2] = { 300, 310 };
    for (int i = 0; i < 2; i++) send(WR_TOUCH_DOWN, i, x[i], y[i], 1.0 + 0.05 * i);
    send(WR_TOUCH_MOVE, 0, x[0] += 3, y[0], 1.2); /* below the threshold */
    assert_int_equal(count, 0);
    send(WR_TOUCH_MOVE, 0, x[0] -= 40, y[0] += 120, 1.3); /* turns by more than the threshold */
    assert_int_equal(count, 1);
    assert_true(reports[0].begins && reports[0].grip.turn_deg == 0.0);
    for (int k = 0; k < 2000; k++) {
        const int i = (int)(test_random_u64(&r) & 1);
        double was_x[2] = { x[0], x[1] }, was_y[2] = { y[0], y[1] };
        x[i] = 50 + 900 * test_random(&r);
        y[i] = 50 + 700 * test_random(&r);
        if (hypot(x[1] - x[0], y[1] - y[0]) < 30) x[i] += 100;
        count = 0;
        send(WR_TOUCH_MOVE, i, x[i], y[i], 1.4 + k * 0.01);
        assert_int_equal(count, 1);
        assert_int_equal(reports[0].report, WR_TOUCH_GRIP);
        assert_false(reports[0].begins);
        for (int f = 0; f < 2; f++) {
            carry(&reports[0], &was_x[f], &was_y[f]);
            assert_near(was_x[f], x[f], 1e-9);
            assert_near(was_y[f], y[f], 1e-9);
        }
    }
    count = 0;
    send(WR_TOUCH_UP, 0, x[0], y[0], 30);
    send(WR_TOUCH_MOVE, 1, 5, 5, 30.1); /* the last finger does nothing any more */
    send(WR_TOUCH_UP, 1, 5, 5, 30.2);
    assert_int_equal(count, 0);
}

/* A pinch that is not quite straight does not turn the picture. */
static void a_pinch_does_not_turn(void **state)
{
    (void)state;
    double scale = 1.0;
    send(WR_TOUCH_DOWN, 1, 400, 300, 1.0);
    send(WR_TOUCH_DOWN, 2, 500, 300, 1.05);
    for (int i = 1; i <= 50; i++) {
        count = 0;
        send(WR_TOUCH_MOVE, 2, 500 + 4 * i, 300 + 0.8 * i, 1.1 + 0.01 * i);
        assert_true(count == 0 || reports[0].grip.turn_deg == 0.0);
        if (count > 0) scale *= reports[0].grip.scale;
    }
    /* the first pixels, below the threshold, do not count */
    assert_true(scale > 300.0 / 115.0 && scale < 305.0 / 100.0);
}

static int taps(int fingers, double seconds, double way)
{
    touch = (WrTouch){ 0 };
    count = 0;
    for (int i = 0; i < fingers; i++) send(WR_TOUCH_DOWN, i, 100 + 80 * i, 200, 1.0 + 0.02 * i);
    send(WR_TOUCH_MOVE, fingers - 1, 100 + 80 * (fingers - 1) + way, 200, 1.1);
    for (int i = 0; i < fingers; i++) send(WR_TOUCH_UP, i, 100 + 80 * i, 200, 1.0 + seconds);
    int found = 0;
    for (int i = 0; i < count; i++)
        if (reports[i].report == WR_TOUCH_TAP) found = reports[i].fingers;
    assert_int_equal(touch.count, 0);
    return found;
}

static void short_touches_of_several_fingers_are_taps(void **state)
{
    (void)state;
    assert_int_equal(taps(1, 0.2, 0), 0);
    assert_int_equal(taps(2, 0.2, 3), 2);
    assert_int_equal(taps(3, 0.2, 0), 3);
    assert_int_equal(taps(2, 0.7, 0), 0);
    assert_int_equal(taps(2, 0.2, 30), 0);
}

static void a_second_finger_takes_back_a_young_stroke_only(void **state)
{
    (void)state;
    send(WR_TOUCH_DOWN, 1, 100, 100, 1.0);
    send(WR_TOUCH_MOVE, 1, 120, 100, 1.1);
    send(WR_TOUCH_DOWN, 2, 200, 100, 1.2);
    assert_int_equal(count, 3);
    assert_int_equal(reports[2].report, WR_TOUCH_CANCEL);
    send(WR_TOUCH_UP, 1, 120, 100, 1.25);
    send(WR_TOUCH_UP, 2, 200, 100, 1.3);
    assert_int_equal(count, 3); /* no release, and no tap */
    count = 0;
    send(WR_TOUCH_DOWN, 1, 100, 100, 2.0);
    send(WR_TOUCH_MOVE, 1, 120, 100, 2.1);
    send(WR_TOUCH_DOWN, 2, 200, 100, 2.9);
    send(WR_TOUCH_MOVE, 2, 220, 100, 2.95);
    send(WR_TOUCH_MOVE, 1, 130, 100, 3.0);
    send(WR_TOUCH_UP, 1, 131, 100, 3.1);
    send(WR_TOUCH_MOVE, 2, 400, 100, 3.2);
    send(WR_TOUCH_UP, 2, 400, 100, 3.3);
    const WrTouchReport all[] = { WR_TOUCH_PRESS, WR_TOUCH_MOTION, WR_TOUCH_MOTION,
                                  WR_TOUCH_RELEASE };
    assert_int_equal(count, 4);
    for (int i = 0; i < 4; i++) assert_int_equal(reports[i].report, all[i]);
}

/* Also if events of fingers are lost or doubled, presses end, and only then new ones begin. */
static void any_events_give_whole_strokes(void **state)
{
    (void)state;
    TestRandom r = { 6 };
    bool down = false;
    int presses = 0;
    for (int i = 0; i < 200000; i++) {
        count = 0;
        send((WrTouchKind)(test_random_u64(&r) % 3), (int64_t)(test_random_u64(&r) % 3),
             1000 * test_random(&r), 800 * test_random(&r), i * 0.03);
        for (int k = 0; k < count; k++) {
            const WrTouchReport report = reports[k].report;
            if (report == WR_TOUCH_PRESS) {
                assert_false(down);
                down = true;
                presses++;
            } else if (report == WR_TOUCH_GRIP || report == WR_TOUCH_TAP) {
                assert_false(down);
                assert_true(report == WR_TOUCH_TAP || reports[k].grip.scale > 0.0);
            } else {
                assert_true(down);
                down = report == WR_TOUCH_MOTION;
            }
        }
    }
    assert_true(presses > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_press_waits_for_the_first_motion, begin_test),
        cmocka_unit_test_setup(a_finger_that_rests_makes_a_dab, begin_test),
        cmocka_unit_test_setup(two_fingers_hold_their_points, begin_test),
        cmocka_unit_test_setup(a_pinch_does_not_turn, begin_test),
        cmocka_unit_test_setup(short_touches_of_several_fingers_are_taps, begin_test),
        cmocka_unit_test_setup(a_second_finger_takes_back_a_young_stroke_only, begin_test),
        cmocka_unit_test_setup(any_events_give_whole_strokes, begin_test),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
