/* Pens without a tablet and without an X server: curve, values, queue, files. */
#include "test.h"

#include "base/error.h"

#include "ui/input/pen_internal.h"

#include <unistd.h>

/* ---- the curve ---- */

static WrPenCurve curve_of(double minimum, double maximum, double gain, double x0, double y0,
                           double x1, double y1)
{
    return (WrPenCurve){ minimum, maximum, gain, { x0, x1 }, { y0, y1 }, 2 };
}

static void assert_same_curve(const WrPenCurve *a, const WrPenCurve *b)
{
    assert_true(same_bits(a->minimum, b->minimum) && same_bits(a->maximum, b->maximum) &&
                same_bits(a->gain, b->gain));
    assert_int_equal(a->count, b->count);
    for (int i = 0; i < a->count; i++)
        assert_true(same_bits(a->x[i], b->x[i]) && same_bits(a->y[i], b->y[i]));
}

/* A valid curve with points anywhere, the edges included. */
static WrPenCurve random_curve(TestRandom *r)
{
    for (;;) {
        WrPenCurve c = curve_of(0.5 * test_random(r), 0.5 + 0.5 * test_random(r), 1.0,
                                test_random(r), test_random(r), test_random(r), test_random(r));
        if (test_random(r) < 0.2) c.x[0] = 0.0;
        if (test_random(r) < 0.2) c.x[1] = 1.0;
        if (test_random(r) < 0.2) c.y[0] = c.y[1];
        for (int left = (int)(4 * test_random(r)); left > 0 && c.x[c.count - 1] < 0.95; left--) {
            const int k = c.count++;
            c.x[k] = c.x[k - 1] + (1.0 - c.x[k - 1]) * (0.1 + 0.8 * test_random(r));
            c.y[k] = c.y[k - 1] + (1.0 - c.y[k - 1]) * test_random(r);
        }
        if (wr_pen_curve_valid(&c)) return c;
    }
}

static void the_curve_at_first_is_the_straight_line(void **state)
{
    (void)state;
    WrPenCurve c = wr_pen_curve_default();
    for (int i = 0; i <= 1000; i++)
        assert_true(same_bits(wr_pen_curve_apply(&c, i / 1000.0), i / 1000.0));
}

static void the_curve_goes_through_its_points_and_both_ends(void **state)
{
    (void)state;
    TestRandom r = { 1 };
    for (int i = 0; i < 500; i++) {
        WrPenCurve c = random_curve(&r);
        double span = c.maximum - c.minimum;
        for (int k = 0; k < c.count; k++)
            assert_near(wr_pen_curve_apply(&c, c.minimum + c.x[k] * span), c.y[k], 1e-7);
        if (c.x[0] > 0.0) assert_near(wr_pen_curve_apply(&c, c.minimum), 0.0, 0.0);
        if (c.x[c.count - 1] < 1.0) assert_near(wr_pen_curve_apply(&c, c.maximum), 1.0, 0.0);
    }
}

static void more_pressure_is_never_less_whatever_the_curve(void **state)
{
    (void)state;
    TestRandom r = { 2 };
    for (int i = 0; i < 300; i++) {
        WrPenCurve c = random_curve(&r);
        double last = 0.0;
        for (int k = 0; k <= 2000; k++) {
            double p = wr_pen_curve_apply(&c, k / 2000.0);
            assert_true(p >= last - 1e-14 && p <= 1.0);
            last = p;
        }
    }
}

/* Between samples the curve bends, but has no corner: one-sided slopes at a point agree to the first
   order of the step. */
static void the_curve_is_smooth_at_its_points(void **state)
{
    (void)state;
    WrPenCurve c = curve_of(0, 1, 1, 0.3, 0.6, 0.7, 0.8);
    for (int k = 0; k < 2; k++) {
        double last = 1.0;
        for (double h = 0.01; h > 1e-4; h /= 2) {
            double y = wr_pen_curve_apply(&c, c.x[k]);
            double left = (y - wr_pen_curve_apply(&c, c.x[k] - h)) / h;
            double right = (wr_pen_curve_apply(&c, c.x[k] + h) - y) / h;
            assert_true(fabs(left - right) < 0.6 * last);
            last = fabs(left - right);
        }
    }
}

static void minimum_and_maximum_are_where_it_begins_and_is_full(void **state)
{
    (void)state;
    WrPenCurve c = curve_of(0.2, 0.8, 1, 0.25, 0.25, 0.75, 0.75);
    assert_near(wr_pen_curve_apply(&c, 0.1), 0.0, 0.0);
    assert_near(wr_pen_curve_apply(&c, 0.2), 0.0, 0.0);
    assert_near(wr_pen_curve_apply(&c, 0.5), 0.5, 1e-15);
    assert_near(wr_pen_curve_apply(&c, 0.8), 1.0, 0.0);
    assert_near(wr_pen_curve_apply(&c, 0.9), 1.0, 0.0);
    c.gain = 0.5;
    assert_near(wr_pen_curve_apply(&c, 0.9), 0.5, 0.0);
    c.gain = 4.0;
    assert_near(wr_pen_curve_apply(&c, 0.5), 1.0, 0.0);
}

static void hostile_pressures_and_curves_give_a_pressure(void **state)
{
    (void)state;
    const double bad[] = { NAN, INFINITY, -INFINITY, -1, 2, 1e308, -0.0 };
    WrPenCurve plain = wr_pen_curve_default();
    assert_near(wr_pen_curve_apply(&plain, NAN), 0.0, 0.0);
    assert_near(wr_pen_curve_apply(&plain, -3.0), 0.0, 0.0);
    assert_near(wr_pen_curve_apply(&plain, 3.0), 1.0, 0.0);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        for (int place = 0; place < 7; place++) {
            double v[7] = { 0, 1, 1, 0.25, 0.1, 0.75, 0.9 };
            v[place] = bad[i];
            WrPenCurve c = curve_of(v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
            for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
                double p = wr_pen_curve_apply(&c, bad[k]);
                assert_true(p >= 0.0 && p <= 1.0);
            }
        }
    }
}

static void a_curve_survives_its_line_to_the_last_bit(void **state)
{
    (void)state;
    TestRandom r = { 3 };
    for (int i = 0; i < 200; i++) {
        WrPenCurve c = random_curve(&r), back;
        char line[WR_PEN_CURVE_TEXT];
        c.gain = 0.1 + test_random(&r);
        wr_pen_curve_print(&c, line, sizeof line);
        assert_true(wr_pen_curve_parse(line, &back));
        assert_same_curve(&c, &back);
    }
}

static void a_line_that_is_no_curve_changes_nothing(void **state)
{
    (void)state;
    const char *const lines[] = { "",
                                  "0 1 1 0.25 0.25 0.75",
                                  "0 1 1 0.25 0.25 0.75 0.75 1",
                                  "0 1 1 0.25 0.25 0.75 0.75 ",
                                  "1 0 1 0.25 0.25 0.75 0.75",
                                  "0 1 0 0.25 0.25 0.75 0.75",
                                  "0 1 1 0.75 0.25 0.25 0.75",
                                  "0 1 1 0.25 0.75 0.75 0.25",
                                  "0 1 1 nan 0.25 0.75 0.75",
                                  "0 1 1 0.25  0.25 0.75 0.75",
                                  "0 1 1 0.25 0.25 0.75 1.5",
                                  "0 1 1 0.25 0.25 0.75 0.75;",
                                  "0 1 1 0.25 0.25 0.75 0.75;0.8",
                                  "0 1 1 0.25 0.25 0.75 0.75;0.8,0.7",
                                  "0 1 1 0.25 0.25 0.75 0.75;0.7,0.8",
                                  "0 1 1 0.25 0.25 0.75 0.75;0.8,0.8 x",
                                  ("0 1 1 0.1 0.1 0.2 0.2;0.3,0.3;0.4,0.4;0.5,0.5;0.6,0.6;0.7,0.7;"
                                   "0.8,0.8;0.9,0.9"),
                                  "a b c d e f g" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrPenCurve c = curve_of(0.1, 0.9, 2, 0.2, 0.3, 0.4, 0.5), before = c;
        if (wr_pen_curve_parse(lines[i], &c)) fail_msg("'%s' is taken for a curve", lines[i]);
        assert_same_curve(&c, &before);
    }
}

/* ---- pressure for a mouse ---- */

static double after(WrFakePressure *fake, double speed, double seconds)
{
    double p = fake->now;
    for (double t = 0.0; t < seconds; t += 0.008) p = wr_fake_pressure(fake, speed * 0.008, 0.008);
    return p;
}

static void a_slow_mouse_presses_hard_and_a_fast_one_lightly(void **state)
{
    (void)state;
    WrFakePressure fake = { .by_speed = true, .slow = 100, .fast = 1100, .least = 0.2, .now = 1 };
    assert_near(after(&fake, 50, 2), 1.0, 1e-6);
    assert_near(after(&fake, 5000, 2), 0.2, 1e-6);
    assert_near(after(&fake, 600, 2), 0.6, 1e-6); /* half-way */
    double before = fake.now;
    assert_near(wr_fake_pressure(&fake, 1e6, 0.0), before, 0.0);
    assert_true(wr_fake_pressure(&fake, 0.0, 0.001) < before + 0.05); /* no jumps */
}

static void without_speed_the_keys_hold_the_pressure(void **state)
{
    (void)state;
    WrFakePressure fake = { .held = 0.35, .slow = 1, .fast = 2, .now = 1 };
    assert_near(wr_fake_pressure(&fake, 1000, 0.01), 0.35, 0.0);
    fake.held = 7;
    assert_near(wr_fake_pressure(&fake, 1000, 0.01), 1.0, 0.0);
}

static void hostile_motions_give_a_pressure(void **state)
{
    (void)state;
    const double bad[] = { NAN, INFINITY, -INFINITY, -1, 0, 1e308, 1e-308 };
    const int n = (int)(sizeof bad / sizeof *bad);
    for (int i = 0; i < n * n * n * n; i++) {
        WrFakePressure fake = { .by_speed = true,
                                .slow = bad[i % n],
                                .fast = bad[i / n % n],
                                .least = bad[i / n / n % n],
                                .now = bad[i / n / n / n % n] };
        for (int k = 0; k < n * n; k++) {
            double p = wr_fake_pressure(&fake, bad[k % n], bad[k / n]);
            assert_true(p >= 0.0 && p <= 1.0);
        }
    }
}

/* ---- values of a device ---- */

static int add_pen(WrPen *pen, const char *name, bool eraser, double low, double high)
{
    int index = wr_pen_unit(pen, name, eraser, false);
    WrPenDevice *d = &pen->units.data[index].shown;
    d->there = d->has_place = d->has_tilt = d->has_turn = true;
    d->has_pressure = high > low;
    d->pressure_low = low;
    d->pressure_high = high;
    return index;
}

static WrPenEvent feed(WrPen *pen, int index, WrPenKind kind, double pressure, double seconds)
{
    WrPenEvent e = { 0 };
    WrPenReading r = { .kind = kind,
                       .button = kind == WR_PEN_DOWN || kind == WR_PEN_UP ? 1 : 0,
                       .x = 10.5 + seconds,
                       .y = 20.25,
                       .pressure = pressure,
                       .tilt_x = 0.25,
                       .tilt_y = -0.5,
                       .seconds = seconds };
    wr_pen_feed(pen, index, &r);
    wr_pen_newest(pen, &e);
    return e;
}

static void pressure_is_its_share_of_the_range(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int stylus = add_pen(pen, "stylus", false, -100, 300);
    assert_near(feed(pen, stylus, WR_PEN_MOTION, -100, 1).raw, 0.0, 0.0);
    assert_near(feed(pen, stylus, WR_PEN_DOWN, 0, 2).raw, 0.25, 1e-15);
    WrPenEvent e = feed(pen, stylus, WR_PEN_MOTION, 300, 3);
    assert_near(e.raw, 1.0, 0.0);
    assert_near(e.pressure, 1.0, 0.0);
    assert_int_equal(e.held, 2);
    assert_near(e.tilt_x, 0.25, 0.0);
    assert_near(e.x, 13.5, 0.0);
    e = feed(pen, stylus, WR_PEN_UP, -100, 4);
    assert_int_equal(e.held, 0);
    assert_int_equal(e.button, 1);
    const WrPenDevice *d = wr_pen_device(pen, stylus);
    assert_true(d->pressure_moves);
    assert_int_equal(d->events, 4);
    assert_int_equal(d->presses, 1);
    assert_int_equal(d->bad_values, 0);
    assert_near(d->raw_least, 0.25, 1e-15);
    assert_near(d->raw_most, 1.0, 0.0);
    assert_string_equal(wr_pen_diagnosis(pen, stylus), "");
    wr_pen_free(pen);
}

static void values_that_are_no_numbers_are_counted_and_the_last_good_one_stays(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int stylus = add_pen(pen, "stylus", false, 0, 2047);
    feed(pen, stylus, WR_PEN_MOTION, 0, 1);
    feed(pen, stylus, WR_PEN_DOWN, 1023.5, 2);
    assert_near(feed(pen, stylus, WR_PEN_MOTION, NAN, 3).raw, 0.5, 0.0);
    assert_near(feed(pen, stylus, WR_PEN_MOTION, INFINITY, 4).raw, 0.5, 0.0);
    assert_near(feed(pen, stylus, WR_PEN_MOTION, 1e9, 5).raw, 1.0, 0.0);
    assert_near(feed(pen, stylus, WR_PEN_MOTION, -5, 6).raw, 0.0, 0.0);
    assert_int_equal(wr_pen_device(pen, stylus)->bad_values, 4);
    WrPenReading r = { .x = NAN, .y = 3, .tilt_x = 9, .tilt_y = NAN, .seconds = NAN };
    WrPenEvent e;
    wr_pen_feed(pen, stylus, &r);
    assert_true(wr_pen_newest(pen, &e));
    assert_near(e.x, 16.5, 0.0);
    assert_near(e.tilt_x, 1.0, 0.0);
    assert_near(e.tilt_y, -0.5, 0.0);
    assert_near(e.seconds, 6.0, 0.0);
    assert_int_equal(wr_pen_device(pen, stylus)->bad_values, 7);
    assert_non_null(strstr(wr_pen_diagnosis(pen, stylus), "7 of its values"));
    wr_pen_free(pen);
}

static void a_device_that_promises_pressure_and_never_moves_it_presses_fully(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int dead = add_pen(pen, "dead", false, 0, 1), live = add_pen(pen, "live", false, 0, 1);
    for (int i = 0; i < 40; i++) {
        feed(pen, dead, i == 0 ? WR_PEN_DOWN : WR_PEN_MOTION, 0, i);
        feed(pen, live, i == 0 ? WR_PEN_DOWN : WR_PEN_MOTION, 0.01 * i, i);
    }
    assert_near(feed(pen, dead, WR_PEN_MOTION, 0, 50).pressure, 1.0, 0.0);
    assert_near(feed(pen, live, WR_PEN_MOTION, 0, 50).pressure, 0.0, 0.0);
    assert_non_null(strstr(wr_pen_diagnosis(pen, dead), "should have pressure"));
    assert_null(strstr(wr_pen_diagnosis(pen, live), "should have pressure"));
    assert_near(feed(pen, dead, WR_PEN_UP, 0, 51).pressure, 1.0, 0.0);
    assert_near(feed(pen, dead, WR_PEN_MOTION, 0, 52).pressure, 0.0, 0.0); /* hovers */
    assert_near(feed(pen, dead, WR_PEN_DOWN, 0, 53).pressure, 1.0, 0.0);
    /* its pressure works after all */
    assert_near(feed(pen, dead, WR_PEN_MOTION, 0.5, 54).pressure, 0.5, 0.0);
    assert_near(feed(pen, dead, WR_PEN_MOTION, 0, 55).pressure, 0.0, 0.0);
    wr_pen_free(pen);
}

static void a_device_without_pressure_presses_fully_while_it_is_down(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int plain = add_pen(pen, "plain pen", false, 0, 0);
    assert_near(feed(pen, plain, WR_PEN_MOTION, 7, 1).pressure, 0.0, 0.0);
    assert_near(feed(pen, plain, WR_PEN_DOWN, 7, 2).pressure, 1.0, 0.0);
    assert_near(feed(pen, plain, WR_PEN_MOTION, 7, 3).pressure, 1.0, 0.0);
    assert_near(feed(pen, plain, WR_PEN_UP, 7, 4).pressure, 1.0, 0.0);
    assert_near(feed(pen, plain, WR_PEN_MOTION, 7, 5).pressure, 0.0, 0.0);
    assert_non_null(strstr(wr_pen_diagnosis(pen, plain), "no pressure"));
    assert_int_equal(wr_pen_device(pen, plain)->bad_values, 0);
    wr_pen_free(pen);
}

static void the_curve_of_a_device_is_found_by_its_name_now_and_later(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    WrPenCurve half = curve_of(0, 1, 0.5, 0.25, 0.25, 0.75, 0.75), bad = half;
    wr_pen_keep_curve(pen, "later", &half);
    int later = add_pen(pen, "later", false, 0, 1), other = add_pen(pen, "other", false, 0, 1);
    int eraser = add_pen(pen, "later", true, 0, 1);
    assert_near(feed(pen, later, WR_PEN_DOWN, 1, 1).pressure, 0.5, 0.0);
    assert_near(feed(pen, eraser, WR_PEN_DOWN, 1, 1).pressure, 0.5, 0.0);
    assert_near(feed(pen, other, WR_PEN_DOWN, 1, 1).pressure, 1.0, 0.0);
    wr_pen_set_curve(pen, other, &half);
    assert_near(feed(pen, other, WR_PEN_MOTION, 1, 2).pressure, 0.5, 0.0);
    bad.gain = NAN;
    wr_pen_set_curve(pen, other, &bad);
    wr_pen_set_curve(pen, 99, &half);
    assert_near(feed(pen, other, WR_PEN_MOTION, 1, 3).pressure, 0.5, 0.0);
    wr_pen_free(pen);
}

static void buttons_are_held_from_their_press_to_their_release(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int stylus = add_pen(pen, "stylus", false, 0, 1);
    const struct {
        WrPenKind kind;
        int button;
        unsigned held;
        bool comes;
    } steps[] = { { WR_PEN_DOWN, 2, 4, true },   { WR_PEN_DOWN, 1, 6, true },
                  { WR_PEN_DOWN, 1, 6, false },                              /* twice */
                  { WR_PEN_UP, 2, 2, true },     { WR_PEN_UP, 3, 2, false }, /* never down */
                  { WR_PEN_DOWN, 4, 2, false },                              /* a wheel */
                  { WR_PEN_DOWN, -1, 2, false }, { WR_PEN_LOST, 0, 0, true },
                  { WR_PEN_UP, 1, 0, false } };
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        WrPenEvent e = { 0 };
        int64_t before = wr_pen_total(pen);
        WrPenReading r = { .kind = steps[i].kind, .button = steps[i].button, .seconds = (double)i };
        wr_pen_feed(pen, stylus, &r);
        assert_int_equal(wr_pen_total(pen) - before, steps[i].comes);
        assert_true(wr_pen_newest(pen, &e));
        assert_int_equal(e.held, steps[i].held);
    }
    wr_pen_free(pen);
}

static void a_lost_device_lets_go_once_and_with_its_last_pressure(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int stylus = add_pen(pen, "stylus", false, 0, 400);
    wr_pen_lose(pen, stylus);
    assert_int_equal(wr_pen_total(pen), 0);
    feed(pen, stylus, WR_PEN_MOTION, 0, 1);
    WrPenEvent e = feed(pen, stylus, WR_PEN_DOWN, 100, 2);
    assert_true(wr_pen_moves_mouse(pen) && wr_pen_in_range(pen));
    wr_pen_lose(pen, stylus);
    wr_pen_lose(pen, stylus);
    assert_int_equal(wr_pen_total(pen), 3);
    assert_true(wr_pen_newest(pen, &e));
    assert_int_equal(e.kind, WR_PEN_LOST);
    assert_int_equal(e.held, 0);
    assert_near(e.pressure, 0.25, 1e-15);
    assert_near(e.x, 12.5, 0.0);
    wr_pen_free(pen);
}

static void server_times_go_on_where_their_32_bits_wrap(void **state)
{
    (void)state;
    WrPenUnit unit = { 0 };
    double first = wr_pen_seconds(&unit, 0xfffffff0u);
    assert_near(wr_pen_seconds(&unit, 0xfffffffau) - first, 0.010, 1e-9);
    assert_near(wr_pen_seconds(&unit, 0x00000010u) - first, 0.032, 1e-9);
    assert_near(wr_pen_seconds(&unit, 0x0000000fu) - first, 0.032, 1e-9); /* never back */
    assert_near(wr_pen_seconds(&unit, 0x00000020u) - first, 0.048, 1e-9);
}

static void none_of_many_events_is_lost_however_late_they_are_taken(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    int stylus = add_pen(pen, "stylus", false, 0, 1), next = 0;
    WrPenEvent e;
    for (int i = 0; i < 100000; i++) {
        feed(pen, stylus, i == 0 ? WR_PEN_DOWN : WR_PEN_MOTION, 0.5, i);
        for (int k = 0; i % 3000 == 2999 && k < 2500; k++) {
            assert_true(wr_pen_next(pen, &e));
            assert_near(e.seconds, next, 0.0);
            next++;
        }
    }
    assert_int_equal(wr_pen_total(pen), 100000);
    assert_int_equal(wr_pen_waiting(pen), 100000 - next);
    while (wr_pen_next(pen, &e)) assert_near(e.seconds, next++, 0.0);
    assert_int_equal(next, 100000);
    for (int64_t i = 100000 - WR_PEN_KEEP; i < 100000; i++) {
        assert_true(wr_pen_event_at(pen, i, &e));
        assert_near(e.seconds, (double)i, 0.0);
    }
    assert_false(wr_pen_event_at(pen, 100000, &e));
    assert_false(wr_pen_event_at(pen, 0, &e));
    assert_false(wr_pen_event_at(pen, -1, &e));
    wr_pen_free(pen);
}

static SDL_Event key_at(Uint32 type, Uint32 milliseconds)
{
    SDL_Event event = { .key = { .type = type, .timestamp = milliseconds } };
    return event;
}

static int taken_before(WrPen *pen, const SDL_Event *event)
{
    WrPenEvent e;
    int count = 0;
    while (wr_pen_next_before(pen, event, &e)) count++;
    return count;
}

static void what_pens_did_before_a_key_is_taken_before_it(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    WrPenEvent e;
    int stylus = add_pen(pen, "stylus", false, 0, 1);
    SDL_Event first = key_at(SDL_KEYDOWN, 10), second = key_at(SDL_KEYUP, 10);
    SDL_Event lost = key_at(SDL_KEYDOWN, 11), third = key_at(SDL_MOUSEBUTTONDOWN, 12);
    SDL_Event never = key_at(SDL_KEYDOWN, 13);
    wr_pen_mark(pen, &first); /* before the pen did anything */
    for (int i = 0; i < 5; i++) feed(pen, stylus, i ? WR_PEN_MOTION : WR_PEN_DOWN, 0.5, i);
    wr_pen_mark(pen, &second);
    feed(pen, stylus, WR_PEN_UP, 0, 5);
    wr_pen_mark(pen, &lost); /* read by another loop */
    feed(pen, stylus, WR_PEN_DOWN, 0.5, 6);
    wr_pen_mark(pen, &third);
    feed(pen, stylus, WR_PEN_UP, 0, 7);
    assert_int_equal(taken_before(pen, &first), 0);
    assert_int_equal(taken_before(pen, &second), 5);
    assert_int_equal(taken_before(pen, &never), 0);
    assert_int_equal(taken_before(pen, &third), 2);
    assert_int_equal(taken_before(pen, &third), 0); /* already requested */
    assert_int_equal(wr_pen_waiting(pen), 1);
    assert_true(wr_pen_next(pen, &e) && e.kind == WR_PEN_UP);
    for (Uint32 i = 0; i < 100000; i++) { /* keys alone do not pile up */
        SDL_Event key = key_at(SDL_KEYDOWN, 100 + i);
        wr_pen_mark(pen, &key);
    }
    assert_true(pen->marks.count < 1000);
    wr_pen_free(pen);
}

static void names_stay_on_one_line_and_whole_characters(void **state)
{
    (void)state;
    WrPen *pen = wr_pen_new(NULL);
    char name[256] = "a\nb\t";
    for (int i = 4; i < 200; i += 2) memcpy(name + i, "\xc3\xa9", 3);
    int index = wr_pen_unit(pen, name, false, false);
    const char *kept = wr_pen_device(pen, index)->name;
    assert_memory_equal(kept, "a b \xc3\xa9", 6);
    assert_int_equal(strlen(kept), 94); /* 4 and 45 pairs: the next would be truncated */
    assert_int_equal(wr_pen_unit(pen, name, false, false), index);
    assert_string_equal(wr_pen_device(pen, wr_pen_unit(pen, "", false, false))->name, "?");
    wr_pen_free(pen);
}

/* ---- files ---- */

static char folder[64];

static const char *path_of(const char *name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *bytes, size_t length)
{
    FILE *file = fopen(path_of("pen"), "w");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/wrinkle-pen-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(path_of("pen"));
    return rmdir(folder);
}

static void play_something(WrPen *pen)
{
    TestRandom r = { 4 };
    int stylus = add_pen(pen, "My tablet  stylus", false, 0, 2047);
    int eraser = add_pen(pen, "My tablet  stylus", true, 0, 2047);
    for (int i = 0; i < 3000; i++) {
        WrPenReading reading = { .kind = (WrPenKind)(test_random_u64(&r) % 3),
                                 .button = 1 + (int)(test_random_u64(&r) % 3),
                                 .x = 1000.0 * test_random(&r),
                                 .y = 900.0 * test_random(&r) - 20.0,
                                 .pressure = 2047.0 * test_random(&r),
                                 .tilt_x = 2.0 * test_random(&r) - 1.0,
                                 .tilt_y = test_random(&r),
                                 .turn_deg = i % 3 == 0 ? 0.0 : 1000.0 * test_random(&r),
                                 .seconds = i * 0.001 };
        wr_pen_feed(pen, i % 400 < 300 ? stylus : eraser, &reading);
    }
    const WrPenEvent grip = { .kind = WR_PEN_GRIP,
                              .device = stylus,
                              .button = 1,
                              .held = pen->units.data[stylus].held,
                              .x = 3.5,
                              .grip = { -3.25, 1.0 / 3.0, 1.07, -12.5 },
                              .seconds = 3.5 };
    wr_pen_push(pen, &grip);
    feed(pen, stylus, WR_PEN_CANCEL, 0, 3.6);
    const WrPenEvent tap = { .kind = WR_PEN_TAP, .device = stylus, .button = 4, .seconds = 3.7 };
    wr_pen_push(pen, &tap);
    feed(pen, stylus, WR_PEN_UP, 0, 4);
    feed(pen, stylus, WR_PEN_DOWN, 0.3, 5); /* and stays down */
}

static void check_same(const WrPenEvent *a, const WrPenEvent *b)
{
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->device, b->device);
    assert_int_equal(a->eraser, b->eraser);
    assert_int_equal(a->button, b->button);
    assert_int_equal(a->held, b->held);
    assert_true(same_bits(a->x, b->x) && same_bits(a->y, b->y));
    assert_true(same_bits(a->raw, b->raw) && same_bits(a->pressure, b->pressure));
    assert_true(same_bits(a->tilt_x, b->tilt_x) && same_bits(a->tilt_y, b->tilt_y));
    assert_true(same_bits(a->seconds, b->seconds) && same_bits(a->turn_deg, b->turn_deg));
    assert_true(same_bits(a->grip.dx, b->grip.dx) && same_bits(a->grip.dy, b->grip.dy));
    assert_true(same_bits(a->grip.scale, b->grip.scale));
    assert_true(same_bits(a->grip.turn_deg, b->grip.turn_deg) && fabs(a->turn_deg) <= 180.0);
}

static void a_recorded_file_replayed_gives_the_same_events(void **state)
{
    (void)state;
    WrError err = { "" };
    WrPen *pen = wr_pen_new(NULL), *again = wr_pen_new(NULL);
    WrPenEvent e, f;
    assert_true(wr_pen_record(pen, path_of("pen"), &err));
    play_something(pen);
    assert_true(wr_pen_record(pen, "", &err));
    feed(pen, 0, WR_PEN_MOTION, 1, 6); /* after the end: not in the file */
    if (!wr_pen_replay(again, path_of("pen"), 0.0, &err)) fail_msg("%s", err.text);
    assert_true(wr_pen_replaying(again));
    int64_t count = wr_pen_total(pen) - 1;
    for (int64_t i = 0; i < count; i++) {
        assert_true(wr_pen_next(pen, &e));
        assert_true(wr_pen_next(again, &f));
        check_same(&e, &f);
    }
    assert_true(wr_pen_next(again, &f)); /* buttons still held at the file's end are released */
    assert_int_equal(f.kind, WR_PEN_LOST);
    assert_int_equal(f.held, 0);
    while (wr_pen_next(again, &f)) assert_int_equal(f.kind, WR_PEN_LOST);
    assert_false(wr_pen_replaying(again));
    assert_int_equal(wr_pen_device_count(again), 2);
    assert_string_equal(wr_pen_device(again, 0)->name, "My tablet  stylus");
    assert_true(wr_pen_device(again, 1)->eraser && wr_pen_device(again, 0)->has_tilt);
    wr_pen_free(pen);
    wr_pen_free(again);
}

static void a_replay_takes_the_place_of_devices(void **state)
{
    (void)state;
    WrError err = { "" };
    WrPen *pen = wr_pen_new(NULL);
    WrPenEvent e;
    assert_true(wr_pen_record(pen, path_of("pen"), &err));
    int stylus = add_pen(pen, "stylus", false, 0, 1);
    feed(pen, stylus, WR_PEN_DOWN, 0.5, 1);
    feed(pen, stylus, WR_PEN_UP, 0, 2);
    assert_true(wr_pen_record(pen, "", &err));
    feed(pen, stylus, WR_PEN_DOWN, 0.5, 3);
    while (wr_pen_next(pen, &e)) continue;
    assert_true(wr_pen_replay(pen, path_of("pen"), 0.0, &err));
    feed(pen, stylus, WR_PEN_MOTION, 0.7, 4); /* not delivered */
    const WrPenKind kinds[] = { WR_PEN_LOST, WR_PEN_DOWN, WR_PEN_UP };
    for (int i = 0; i < 3; i++) {
        assert_true(wr_pen_next(pen, &e));
        assert_int_equal(e.kind, kinds[i]);
    }
    assert_false(wr_pen_next(pen, &e));
    feed(pen, stylus, WR_PEN_MOTION, 0.7, 5);
    assert_true(wr_pen_next(pen, &e));
    assert_near(e.raw, 0.7, 0.0);
    wr_pen_free(pen);
}

static void a_replay_keeps_its_time_and_can_be_ended(void **state)
{
    (void)state;
    WrError err = { "" };
    WrPen *pen = wr_pen_new(NULL);
    WrPenEvent e;
    const char *text = "wrinkle-pen 1\ndevice 0 pen 1 1 0 1 a\n"
                       "down 1000 0 1 2 1 1 0.5 0.5 0 0\nmotion 1000.1 0 0 2 2 2 0.5 0.5 0 0\n"
                       "motion 99999 0 0 2 3 3 0.5 0.5 0 0\n";
    write_file(text, strlen(text));
    assert_true(wr_pen_replay(pen, path_of("pen"), 1.0, &err));
    assert_true(wr_pen_next(pen, &e));
    assert_int_equal(e.kind, WR_PEN_DOWN);
    assert_false(wr_pen_next(pen, &e)); /* it comes 0.1 seconds later */
    usleep(120000);
    assert_true(wr_pen_next(pen, &e));
    assert_near(e.x, 2.0, 0.0);
    assert_false(wr_pen_next(pen, &e));
    assert_true(wr_pen_replay(pen, "", 1.0, &err));
    assert_false(wr_pen_replaying(pen));
    assert_true(wr_pen_next(pen, &e));
    assert_int_equal(e.kind, WR_PEN_LOST);
    assert_false(wr_pen_next(pen, &e));
    wr_pen_free(pen);
}

#define HEAD "wrinkle-pen 1\ndevice 0 pen 1 1 0 1 a\n"

static void hostile_recordings_are_refused_with_their_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } files[] = {
        { "", ":1: the first line" },
        { "wrinkle-pen 2\n", ":1: the first line" },
        { "wrinkle-pen 1\n", "no event" },
        { HEAD, "no event" },
        { "wrinkle-pen 1\nmotion 0 0 0 0 1 1 0 0 0 0\n", ":2: device 0: is not declared" },
        { "wrinkle-pen 1\ndevice 64 pen 1 1 0 1 a\n", ":2: device '64'" },
        { "wrinkle-pen 1\ndevice -1 pen 1 1 0 1 a\n", ":2: device '-1'" },
        { "wrinkle-pen 1\ndevice 0.5 pen 1 1 0 1 a\n", ":2: device 0.5" },
        { "wrinkle-pen 1\ndevice 0 mouse 1 1 0 1 a\n", ":2: device of kind 'mouse'" },
        { "wrinkle-pen 1\ndevice 0 pen 2 1 0 1 a\n", ":2: pressure '2'" },
        { "wrinkle-pen 1\ndevice 0 pen 1 1 0 1\n", ":2: device 0: a name" },
        { "wrinkle-pen 1\ndevice 0 pen\n", ":2: a device is" },
        { HEAD "device 0 pen 1 1 0 1 b\n", ":3: device 0: is already declared" },
        { HEAD "wave 0 0 0 0 1 1 0 0 0 0\n", ":3: 'wave'" },
        { HEAD "motion 0 0 0 0 1 1 0 0 0\n", ":3: an event has 10 or 11 numbers, not 9" },
        { HEAD "motion 0 0 0 0 1 1 0 0 0 0 0 0\n", ":3: an event has 10 or 11 numbers, not 12" },
        { HEAD "motion 0 0 0 0 1 1 0 0 0 0 181\n", ":3: turn '181'" },
        { HEAD "grip 0 0 0 0 1 1 0 0 0 0 0\n", ":3: a grip has 15 numbers, not 11" },
        { HEAD "grip 0 0 0 0 1 1 0 0 0 0 0 1 1 0 0\n", ":3: scale '0'" },
        { HEAD "tap 0 0 11 0 1 1 0 0 0 0\n", ":3: button '11'" },
        { HEAD "cancel 0 0 1 0 1 1 0 0 0 0\n", ":3: button 1" },
        { HEAD "motion nan 0 0 0 1 1 0 0 0 0\n", ":3: seconds 'nan'" },
        { HEAD "motion 1e300 0 0 0 1 1 0 0 0 0\n", ":3: seconds" },
        { HEAD "motion 0 1e9 0 0 1 1 0 0 0 0\n", ":3: device '1e9'" },
        { HEAD "motion 0 0 0 0 inf 1 0 0 0 0\n", ":3: x 'inf'" },
        { HEAD "motion 0 0 0 0 1 1e7 0 0 0 0\n", ":3: y '1e7'" },
        { HEAD "motion 0 0 0 0 1 1 1.01 0 0 0\n", ":3: raw pressure '1.01'" },
        { HEAD "motion 0 0 0 0 1 1 0 -0.1 0 0\n", ":3: pressure '-0.1'" },
        { HEAD "motion 0 0 0 0 1 1 0 0 2 0\n", ":3: tilt x '2'" },
        { HEAD "motion 0 0 0 0 1 1 0 0 0 x\n", ":3: tilt y 'x'" },
        { HEAD "down 0 0 4 16 1 1 0 0 0 0\n", ":3: button '4'" },
        { HEAD "down 0 0 0 0 1 1 0 0 0 0\n", ":3: button 0" },
        { HEAD "motion 0 0 1 0 1 1 0 0 0 0\n", ":3: button 1" },
        { HEAD "down 0 0 1 0 1 1 0 0 0 0\n", ":3: held 0" },
        { HEAD "up 0 0 1 0 1 1 0 0 0 0\n", ":3: button 1 of device 0 is up already" },
        { HEAD "motion 0 0 0 2 1 1 0 0 0 0\n", ":3: held 2" },
        { HEAD "motion 2 0 0 0 1 1 0 0 0 0\n# so\n\nmotion 1 0 0 0 1 1 0 0 0 0\n",
          ":6: 1 seconds" },
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        WrError err = { "" };
        WrPen *pen = wr_pen_new(NULL);
        write_file(files[i].text, strlen(files[i].text));
        if (wr_pen_replay(pen, path_of("pen"), 0.0, &err)) fail_msg("taken: %s", files[i].text);
        if (!strstr(err.text, files[i].says))
            fail_msg("'%s' does not say '%s'", err.text, files[i].says);
        assert_false(wr_pen_replaying(pen));
        assert_int_equal(wr_pen_device_count(pen), 0);
        wr_pen_free(pen);
    }
}

/* A valid file truncated or changed anywhere is refused, or produces events in range. */
static void a_damaged_recording_never_gives_events_out_of_range(void **state)
{
    (void)state;
    const char *text = HEAD "device 7 eraser 1 0 -5 2047 the other  end\n# a note\n"
                            "down 1.5 0 1 2 10.25 11 0.5 0.5 0.1 -0.2\n"
                            "motion 1.6 7 0 0 4 5 0 0 0 0\nlost 1.7 0 0 0 4 5 0.2 0.2 0 0\n";
    TestRandom r = { 5 };
    size_t length = strlen(text);
    int taken = 0;
    for (int i = 0; i < 1000; i++) {
        WrError err = { "" };
        char copy[512];
        memcpy(copy, text, length);
        for (int k = i % 3; k >= 0; k--)
            copy[test_random_u64(&r) % length] = "0129.- \n#e\0\xff"[test_random_u64(&r) % 12];
        size_t kept = i % 4 == 0 ? test_random_u64(&r) % length : length;
        write_file(copy, kept);
        WrPen *pen = wr_pen_new(NULL);
        if (wr_pen_replay(pen, path_of("pen"), 0.0, &err)) {
            WrPenEvent e;
            taken++;
            while (wr_pen_next(pen, &e)) {
                assert_in_range(e.device, 0, wr_pen_device_count(pen) - 1);
                assert_true(e.raw >= 0.0 && e.raw <= 1.0 && fabs(e.x) <= 1e6 && e.held < 16);
            }
        } else {
            assert_true(err.text[0] != '\0');
        }
        wr_pen_free(pen);
    }
    assert_true(taken > 30 && taken < 970);
}

static void files_that_cannot_be_opened_are_errors(void **state)
{
    (void)state;
    WrError err = { "" };
    WrPen *pen = wr_pen_new(NULL);
    assert_false(wr_pen_record(pen, path_of("no/such"), &err));
    assert_non_null(strstr(err.text, "no/such"));
    err.text[0] = '\0';
    assert_false(wr_pen_replay(pen, path_of("none"), 1.0, &err));
    assert_non_null(strstr(err.text, "none"));
    err.text[0] = '\0';
    assert_false(wr_pen_replay(pen, path_of("none"), NAN, &err));
    assert_true(err.text[0] != '\0');
    assert_true(wr_pen_record(pen, "/dev/full", &err)); /* a full disk fails at the end */
    feed(pen, add_pen(pen, "a", false, 0, 1), WR_PEN_MOTION, 0, 0);
    assert_false(wr_pen_record(pen, "", &err));
    assert_int_equal(wr_pen_total(pen), 1);
    wr_pen_free(pen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_curve_at_first_is_the_straight_line),
        cmocka_unit_test(the_curve_goes_through_its_points_and_both_ends),
        cmocka_unit_test(more_pressure_is_never_less_whatever_the_curve),
        cmocka_unit_test(the_curve_is_smooth_at_its_points),
        cmocka_unit_test(minimum_and_maximum_are_where_it_begins_and_is_full),
        cmocka_unit_test(hostile_pressures_and_curves_give_a_pressure),
        cmocka_unit_test(a_curve_survives_its_line_to_the_last_bit),
        cmocka_unit_test(a_line_that_is_no_curve_changes_nothing),
        cmocka_unit_test(a_slow_mouse_presses_hard_and_a_fast_one_lightly),
        cmocka_unit_test(without_speed_the_keys_hold_the_pressure),
        cmocka_unit_test(hostile_motions_give_a_pressure),
        cmocka_unit_test(pressure_is_its_share_of_the_range),
        cmocka_unit_test(values_that_are_no_numbers_are_counted_and_the_last_good_one_stays),
        cmocka_unit_test(a_device_that_promises_pressure_and_never_moves_it_presses_fully),
        cmocka_unit_test(a_device_without_pressure_presses_fully_while_it_is_down),
        cmocka_unit_test(the_curve_of_a_device_is_found_by_its_name_now_and_later),
        cmocka_unit_test(buttons_are_held_from_their_press_to_their_release),
        cmocka_unit_test(a_lost_device_lets_go_once_and_with_its_last_pressure),
        cmocka_unit_test(server_times_go_on_where_their_32_bits_wrap),
        cmocka_unit_test(none_of_many_events_is_lost_however_late_they_are_taken),
        cmocka_unit_test(what_pens_did_before_a_key_is_taken_before_it),
        cmocka_unit_test(names_stay_on_one_line_and_whole_characters),
        cmocka_unit_test(a_recorded_file_replayed_gives_the_same_events),
        cmocka_unit_test(a_replay_takes_the_place_of_devices),
        cmocka_unit_test(a_replay_keeps_its_time_and_can_be_ended),
        cmocka_unit_test(hostile_recordings_are_refused_with_their_line),
        cmocka_unit_test(a_damaged_recording_never_gives_events_out_of_range),
        cmocka_unit_test(files_that_cannot_be_opened_are_errors),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
