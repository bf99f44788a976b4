/* Dabs of libmypaint along a path: positions, values, and termination for any preset or path. */
#include "test.h"

#include "base/array.h"
#include "base/error.h"
#include "base/text.h"
#include "brush/mypaint_engine.h"

typedef struct Record {
    WR_ARRAY(WrDab) dabs;
    double (*ground)(double x, double y);
} Record;

static void keep(void *ctx, const WrDab *dab)
{
    Record *record = ctx;
    wr_array_push(&record->dabs, *dab);
}

static double height_at(void *ctx, double x, double y, double radius)
{
    Record *record = ctx;
    (void)radius;
    return record->ground ? record->ground(x, y) : 0.0;
}

static WrPreset *preset_of(const char *settings)
{
    WrText text = { 0 };
    WrError err;
    wr_text_addf(&text, "{\"version\": 3, \"settings\": {%s}}", settings);
    WrPreset *preset = wr_preset_parse(text.data, text.length, "toy", NULL, &err);
    if (!preset) fail_msg("%s", err.text);
    wr_text_fini(&text);
    return preset;
}

static void run(Record *record, const WrBrush *brush, const WrEnginePoint *points, int count)
{
    WrDabSink sink = { record, keep, height_at };
    WrEngine *engine = wr_engine_new(brush, &sink);
    record->dabs.count = 0;
    for (int i = 0; i < count; i++) {
        wr_engine_push(engine, &points[i]);
        while (wr_engine_step(engine)) continue;
    }
    wr_engine_pen_up(engine);
    while (wr_engine_step(engine)) continue;
    wr_engine_free(engine);
    for (int i = 0; i < record->dabs.count; i++) {
        const WrDab *dab = &record->dabs.data[i];
        assert_true(isfinite(dab->x) && isfinite(dab->y) && isfinite(dab->dx) && isfinite(dab->dy));
        assert_true(isfinite(dab->radius) && dab->radius > 0 && isfinite(dab->angle_rad));
        assert_true(dab->alpha > 0 && dab->alpha <= 1 && dab->aspect >= 1);
        assert_true(dab->hardness > 0 && dab->hardness <= 1 && dab->drag >= 0 && dab->drag <= 1);
        assert_true(isfinite(dab->dragged) && dab->falloff == WR_FALLOFF_MYPAINT);
    }
}

/* An even, straight motion in `events` steps. */
static void run_line(Record *record, const WrBrush *brush, WrEnginePoint a, WrEnginePoint b,
                     int events)
{
    WrEnginePoint *points = wr_alloc((size_t)events + 1, sizeof *points);
    for (int i = 0; i <= events; i++) {
        double t = (double)i / events;
        points[i] = (WrEnginePoint){ a.x + t * (b.x - a.x),
                                     a.y + t * (b.y - a.y),
                                     a.pressure + t * (b.pressure - a.pressure),
                                     a.tilt_x,
                                     a.tilt_y,
                                     t * b.seconds,
                                     0 };
    }
    run(record, brush, points, events + 1);
    wr_free(points);
}

static WrBrush plain(WrPreset *preset, double radius)
{
    WrBrush brush = wr_preset_brush(preset);
    brush.radius = radius;
    brush.hardness = 0.5;
    return brush;
}

static WrEnginePoint at(double x, double y, double seconds)
{
    return (WrEnginePoint){ .x = x, .y = y, .pressure = 1, .seconds = seconds };
}

#define STILL "\"anti_aliasing\": {\"base_value\": 0}"

/* ---- positions of dabs ---- */

static void dabs_lie_on_the_way_at_the_spacing_of_the_preset(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL ", \"dabs_per_actual_radius\": {\"base_value\": 4}");
    WrBrush brush = plain(preset, 10.0);
    run_line(&record, &brush, at(5, 7, 0), at(305, 407, 1), 1);
    assert_in_range(record.dabs.count, 199, 201); /* 500 texels, 2.5 apart */
    for (int i = 0; i < record.dabs.count; i++) {
        const WrDab *dab = &record.dabs.data[i];
        double along = (dab->x - 5) * 0.6 + (dab->y - 7) * 0.8;
        assert_near((dab->x - 5) * 0.8 - (dab->y - 7) * 0.6, 0.0, 1e-3);
        assert_near(along, 2.5 * (i + 1), 0.01);
        assert_near(dab->radius, 10.0, 1e-4);
        assert_near(dab->hardness, 0.5, 1e-6);
        assert_near(dab->dx, i == 0 ? 0 : 1.5, 0.01);
        assert_near(dab->dy, i == 0 ? 0 : 2.0, 0.01);
    }
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void hc75_one_event_or_a_thousand_give_the_same_dabs(void **state)
{
    (void)state;
    Record one = { 0 }, many = { 0 };
    WrPreset *preset = preset_of(
        "\"opaque\": {\"base_value\": 0.3, \"inputs\": {\"pressure\": [[0, 0], [1, 0.5]]}}, "
        "\"radius_logarithmic\": {\"base_value\": 2, \"inputs\": {\"speed1\": [[0, 0], [4, 1]]}}, "
        "\"slow_tracking\": {\"base_value\": 1}, \"offset_by_random\": {\"base_value\": 0.5}");
    WrBrush brush = plain(preset, 8.0);
    WrEnginePoint from = at(20, 30, 0), to = at(420, 130, 0.7);
    from.pressure = 0.2;
    run_line(&one, &brush, from, to, 1);
    run_line(&many, &brush, from, to, 1000);
    assert_in_range(one.dabs.count, many.dabs.count - 1, many.dabs.count + 1);
    assert_true(one.dabs.count > 20);
    for (int i = 0; i < one.dabs.count && i < many.dabs.count; i++) {
        /* far less than a dab's spacing of 4 texels */
        assert_near(one.dabs.data[i].x, many.dabs.data[i].x, 0.05);
        assert_near(one.dabs.data[i].y, many.dabs.data[i].y, 0.05);
        assert_near(one.dabs.data[i].alpha, many.dabs.data[i].alpha, 1e-3);
    }
    wr_array_free(&one.dabs);
    wr_array_free(&many.dabs);
    wr_preset_free(preset);
}

static void corners_within_a_step_are_not_cut(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL ", \"dabs_per_actual_radius\": {\"base_value\": 2}");
    WrBrush brush = plain(preset, 2.0);
    /* Forth and back within one step of 1/256 s. */
    WrEnginePoint points[] = { at(0, 0, 0), at(50, 0, 0.001), at(50, 50, 0.002), at(0, 50, 0.003) };
    run(&record, &brush, points, 4);
    bool corner[2] = { false, false };
    for (int i = 0; i < record.dabs.count; i++) {
        const WrDab *dab = &record.dabs.data[i];
        assert_true(fabs(dab->y) < 0.01 || fabs(dab->x - 50) < 0.01 || fabs(dab->y - 50) < 0.01);
        corner[0] |= hypot(dab->x - 50, dab->y) < 1.01;
        corner[1] |= hypot(dab->x - 50, dab->y - 50) < 1.01;
    }
    assert_true(corner[0] && corner[1]);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void a_tap_makes_one_dab_where_it_is(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL ", \"slow_tracking\": {\"base_value\": 10}");
    WrBrush brush = plain(preset, 6.0);
    WrEnginePoint point = at(31, 47, 0);
    point.pressure = 0.5;
    run(&record, &brush, &point, 1);
    assert_int_equal(record.dabs.count, 1);
    assert_near(record.dabs.data[0].x, 31, 0.1);
    assert_near(record.dabs.data[0].y, 47, 1e-4);
    /* Opacity 1 times pressure 1/2, linearised for the 4 dabs that usually overlap. */
    assert_near(record.dabs.data[0].alpha, 1 - pow(0.5, 1 / (1 + 0.9 * 3)), 0.01);
    assert_true(record.dabs.data[0].dx == 0 && record.dabs.data[0].dy == 0);
    brush.radius = 0;
    run(&record, &brush, &point, 1);
    assert_int_equal(record.dabs.count, 0);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void points_without_time_move_at_400_texels_a_second(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of("\"dabs_per_actual_radius\": {\"base_value\": 0}, "
                                 "\"dabs_per_second\": {\"base_value\": 50}");
    WrBrush brush = plain(preset, 5.0);
    run_line(&record, &brush, at(0, 0, 0), at(800, 0, 0), 1);
    assert_in_range(record.dabs.count, 98, 101); /* 2 s */
    run_line(&record, &brush, at(0, 0, 0), at(800, 0, 0), 7);
    assert_in_range(record.dabs.count, 98, 101);
    run_line(&record, &brush, at(0, 0, 0), at(800, 0, 4), 7);
    assert_in_range(record.dabs.count, 198, 201);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void a_rest_sprays_for_as_long_as_it_lasts_but_for_a_second_at_most(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of("\"dabs_per_actual_radius\": {\"base_value\": 0}, "
                                 "\"dabs_per_second\": {\"base_value\": 100}");
    WrBrush brush = plain(preset, 5.0);
    static const double rests[][2] = {
        { 0.25, 25 }, { 0.5, 50 }, { 1, 100 }, { 30, 100 }, { 1e300, 100 }
    };
    for (size_t i = 0; i < sizeof rests / sizeof *rests; i++) {
        run_line(&record, &brush, at(9, 9, 0), at(9, 9, rests[i][0]), 1);
        assert_near(record.dabs.count, rests[i][1], 1.01);
    }
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

/* ---- values of dabs ---- */

static void angles_come_out_anticlockwise_as_seen(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset =
        preset_of("\"elliptical_dab_ratio\": {\"base_value\": 3}, \"direction_filter\": "
                  "{\"base_value\": 0}, \"elliptical_dab_angle\": {\"base_value\": 0, \"inputs\": "
                  "{\"direction\": [[0, 0], [180, 180]]}}");
    WrBrush brush = plain(preset, 4.0);
    run_line(&record, &brush, at(0, 0, 0), at(300, -100, 1), 1); /* to the right and up */
    const WrDab *last = &record.dabs.data[record.dabs.count - 1];
    assert_near(last->aspect, 3, 1e-6);
    double turns = (last->angle_rad - atan2(100, 300)) / 3.14159265358979; /* an axis has no sign */
    assert_near(turns - rint(turns), 0, 1e-3);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void tilt_leans_as_mypaint_says(void **state)
{
    (void)state;
    Record record = { 0 };
    /* The dab is offset by 10 radii (rotated by a quarter turn) to the side of the pen's tilt. */
    WrPreset *preset = preset_of(STILL ", \"offset_angle_asc\": {\"base_value\": 10}");
    WrBrush brush = plain(preset, 4.0);
    static const double tilts[][4] = {
        /* tilt; path to the right, down */
        { 0, 0.5, 40, 0 },
        { -0.5, 0, 0, 40 },
        { 0, -0.5, -40, 0 },
        { 0.5, 0, 0, -40 },
    };
    for (size_t i = 0; i < 4; i++) {
        WrEnginePoint point = at(100, 100, 0);
        point.tilt_x = tilts[i][0];
        point.tilt_y = tilts[i][1];
        run(&record, &brush, &point, 1);
        assert_int_equal(record.dabs.count, 1);
        assert_near(record.dabs.data[0].x, 100 + tilts[i][2], 0.2);
        assert_near(record.dabs.data[0].y, 100 + tilts[i][3], 0.2);
    }
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

/* An art pen that is turned turns the dabs, the short way from one sample to the next: from 150 to 210 degrees, not back
   through 0. */
static void the_turn_of_the_pen_turns_the_dabs(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(
        STILL ", \"elliptical_dab_ratio\": {\"base_value\": 3}, \"elliptical_dab_angle\": "
              "{\"base_value\": 0, \"inputs\": {\"barrel_rotation\": [[-180, -180], "
              "[180, 180]]}}");
    WrBrush brush = plain(preset, 4.0);
    WrEnginePoint points[2] = { at(100, 100, 0), at(300, 100, 1) };
    points[0].turn_deg = 150;
    points[1].turn_deg = -150;
    run(&record, &brush, points, 2);
    assert_in_range(record.dabs.count, 50, 300);
    for (int i = 0; i < record.dabs.count; i++) {
        const WrDab *dab = &record.dabs.data[i];
        const double turn = 150 + 60 * (dab->x - 100) / 200; /* clockwise; the angle is not */
        const double turns = (-dab->angle_rad * 57.29577951308232 - turn) / 180;
        assert_near(turns - rint(turns), 0, 0.02);
    }
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static double step_ground(double x, double y)
{
    (void)y;
    return x < 100 ? -5e6 : 7.0;
}

static void smudging_drags_heights_of_any_size(void **state)
{
    (void)state;
    Record record = { .ground = step_ground };
    WrPreset *preset = preset_of("\"smudge\": {\"base_value\": 0.25}, \"smudge_length\": "
                                 "{\"base_value\": 0.5}");
    WrBrush brush = plain(preset, 5.0);
    run_line(&record, &brush, at(20, 50, 0), at(400, 50, 1), 1);
    assert_true(record.dabs.count > 20);
    double before = -5e6;
    for (int i = 0; i < record.dabs.count; i++) {
        const WrDab *dab = &record.dabs.data[i];
        assert_near(dab->drag, 0.25, 1e-6);
        assert_true(dab->dragged >= before - 1e-3 && dab->dragged <= 7.0 + 1e-3);
        if (dab->x < 90) assert_near(dab->dragged, -5e6, 1);
        before = dab->dragged;
    }
    assert_near(before, 7.0, 0.5); /* the earlier height fades gradually */
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void length_1_drags_the_first_height_for_ever(void **state)
{
    (void)state;
    Record record = { .ground = step_ground };
    WrPreset *preset = preset_of("\"smudge\": {\"base_value\": 1}, \"smudge_length\": "
                                 "{\"base_value\": 1}");
    WrBrush brush = plain(preset, 5.0);
    run_line(&record, &brush, at(20, 50, 0), at(400, 50, 1), 1);
    assert_true(record.dabs.count > 20);
    for (int i = 0; i < record.dabs.count; i++) assert_near(record.dabs.data[i].dragged, -5e6, 1);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void flow_and_the_erasing_part_are_in_alpha(void **state)
{
    (void)state;
    static const struct {
        const char *settings;
        double flow, alpha;
    } rows[] = { { "\"opaque_linearize\": {\"base_value\": 0}", 1, 1 },
                 { "\"opaque_linearize\": {\"base_value\": 0}", 0.25, 0.25 },
                 { "\"opaque_linearize\": {\"base_value\": 0}, \"eraser\": {\"base_value\": 0.2}",
                   1, 0.8 },
                 { "\"opaque_linearize\": {\"base_value\": 0}, \"eraser\": {\"base_value\": 0.7}",
                   0.5, 0.35 } };
    Record record = { 0 };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrPreset *preset = preset_of(rows[i].settings);
        WrBrush brush = plain(preset, 6.0);
        brush.flow = rows[i].flow;
        run_line(&record, &brush, at(0, 0, 0), at(100, 0, 1), 1);
        assert_true(record.dabs.count > 10);
        assert_near(record.dabs.data[5].alpha, rows[i].alpha, 1e-6);
        wr_preset_free(preset);
    }
    wr_array_free(&record.dabs);
}

static void the_brush_turns_and_scatters_dabs_on_top_of_its_preset(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL ", \"direction_filter\": {\"base_value\": 0}, "
                                       "\"dabs_per_actual_radius\": {\"base_value\": 4}");
    WrBrush brush = plain(preset, 8.0);
    run_line(&record, &brush, at(0, 0, 0), at(300, 0, 1), 1);
    assert_near(record.dabs.data[9].angle_rad, 0.0, 1e-12); /* round dabs are not rotated */
    brush.follow = true;
    brush.angle_deg = 30.0;
    brush.aspect = 2.0;
    run_line(&record, &brush, at(0, 0, 0), at(300, -300, 1), 1); /* to the right and up */
    assert_near(record.dabs.data[9].angle_rad, (45.0 + 30.0) * 3.14159265358979 / 180.0, 1e-3);
    assert_near(record.dabs.data[9].aspect, 2.0, 1e-6);
    brush.jitter_place = 0.5;
    brush.jitter_angle_deg = 20.0;
    brush.jitter_size = 0.25;
    run_line(&record, &brush, at(0, 0, 0), at(3000, 0, 1), 1);
    double low[3] = { 1e9, 1e9, 1e9 }, high[3] = { -1e9, -1e9, -1e9 };
    for (int i = 0; i < record.dabs.count; i++) {
        const WrDab *dab = &record.dabs.data[i];
        double values[3] = { dab->y, dab->angle_rad * 180 / 3.14159265358979, dab->radius };
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], values[k]);
            high[k] = fmax(high[k], values[k]);
        }
    }
    /* Of 1500 dabs some come close to each end, and none exceeds it. */
    assert_true(low[0] > -4.01 && low[0] < -3.6 && high[0] < 4.01 && high[0] > 3.6);
    assert_true(low[1] > 9.9 && low[1] < 11 && high[1] < 50.1 && high[1] > 49);
    assert_true(low[2] > 5.99 && low[2] < 6.1 && high[2] < 8.01 && high[2] > 7.9);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

/* ---- chance ---- */

static bool same_dabs(const Record *a, const Record *b)
{
    if (a->dabs.count != b->dabs.count) return false;
    for (int i = 0; i < a->dabs.count; i++)
        if (a->dabs.data[i].x != b->dabs.data[i].x || a->dabs.data[i].y != b->dabs.data[i].y)
            return false;
    return true;
}

static void the_seed_alone_chooses_what_is_random(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "\"offset_by_random\": {\"base_value\": 1}", "\"tracking_noise\": {\"base_value\": 1}",
        "\"offset_x\": {\"base_value\": 0, \"inputs\": {\"random\": [[0, -1], [1, 1]]}}"
    };
    Record a = { 0 }, b = { 0 }, c = { 0 };
    for (size_t i = 0; i < 3; i++) {
        WrPreset *preset = preset_of(settings[i]);
        WrBrush brush = plain(preset, 6.0);
        brush.seed = 3;
        run_line(&a, &brush, at(0, 0, 0), at(300, 0, 1), 1);
        run_line(&b, &brush, at(0, 0, 0), at(300, 0, 1), 1);
        assert_true(same_dabs(&a, &b));
        brush.seed = (uint64_t)3 << 32;
        run_line(&b, &brush, at(0, 0, 0), at(300, 0, 1), 1);
        brush.seed = 4;
        run_line(&c, &brush, at(0, 0, 0), at(300, 0, 1), 1);
        assert_false(same_dabs(&a, &b) || same_dabs(&a, &c) || same_dabs(&b, &c));
        wr_preset_free(preset);
    }
    wr_array_free(&a.dabs);
    wr_array_free(&b.dabs);
    wr_array_free(&c.dabs);
}

/* ---- sizes ---- */

static void large_radii_go_beyond_the_librarys_limit_of_1000(void **state)
{
    (void)state;
    static const double radii[] = { 0.2, 1, 511, 513, 1500, 5000, 1e6 };
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL);
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        WrBrush brush = plain(preset, radii[i]);
        double length = 20 * radii[i] < 60000 ? 20 * radii[i] : 60000;
        run_line(&record, &brush, at(100, 100, 0), at(100 + length, 100, 1), 1);
        assert_true(record.dabs.count > 0);
        for (int k = 0; k < record.dabs.count; k++)
            assert_near(record.dabs.data[k].radius, radii[i], 1e-5 * radii[i]);
        if (radii[i] < 1000) assert_in_range(record.dabs.count, 38, 40);
    }
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void dabs_stay_in_place_far_from_the_corner(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL ", \"dabs_per_actual_radius\": {\"base_value\": 1}");
    WrBrush brush = plain(preset, 40.0);
    double x = 3e9 + 0.25;
    WrEnginePoint points[8];
    for (int i = 0; i < 8; i++) points[i] = at(x + 60000.0 * i, -7e5 + 1000.0 * i, 0);
    run(&record, &brush, points, 8);
    assert_in_range(record.dabs.count, 10490, 10512);
    for (int i = 0; i < record.dabs.count; i++) {
        const WrDab *dab = &record.dabs.data[i];
        assert_near(dab->y, -7e5 + (dab->x - x) / 60.0, 0.05);
        if (i > 0) assert_near(hypot(dab->dx, dab->dy), 40.0, 0.1);
    }
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

/* ---- nothing runs away ---- */

static void a_way_beyond_all_tables_ends_soon(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of(STILL);
    WrBrush brush = plain(preset, 50.0);
    WrEnginePoint points[] = { at(0, 0, 0), at(4e9, 1e9, 0), at(-1e300, 0, 0), at(10, 10, 0) };
    run(&record, &brush, points, 4);
    assert_in_range(record.dabs.count, 1000, 20000);
    const WrDab *last = &record.dabs.data[record.dabs.count - 1];
    assert_near(last->x, 10, 30);
    assert_near(last->y, 10, 30);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

static void presets_that_would_flood_a_step_with_dabs_do_not(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "\"dabs_per_actual_radius\": {\"base_value\": 1e6}, \"dabs_per_basic_radius\": "
        "{\"base_value\": 1e6}, \"dabs_per_second\": {\"base_value\": 1e6}",
        /* Curves are extrapolated beyond their last point: here to 1e30 and more. */
        "\"elliptical_dab_ratio\": {\"base_value\": 1, \"inputs\": {\"speed1\": [[0, 0], [1e-30, "
        "9]]}}",
        "\"dabs_per_second\": {\"base_value\": 0, \"inputs\": {\"pressure\": [[0, 0], [1e-30, "
        "9]]}}",
        "\"dabs_per_actual_radius\": {\"base_value\": 2, \"inputs\": {\"pressure\": [[0, 0], "
        "[1e-38, "
        "200]]}}",
        "\"radius_logarithmic\": {\"base_value\": 2, \"inputs\": {\"pressure\": [[0, 0], [1e-20, "
        "-8]]}}, \"dabs_per_actual_radius\": {\"base_value\": 64}",
        "\"gridmap_scale\": {\"base_value\": -10, \"inputs\": {\"pressure\": [[0, 0], [1e-20, "
        "-20]]}}, "
        "\"hardness\": {\"base_value\": 0.5, \"inputs\": {\"gridmap_x\": [[0, -0.1], [256, 0.1]]}}",
        "\"offset_multiplier\": {\"base_value\": 3, \"inputs\": {\"pressure\": [[0, 0], [1e-20, "
        "5]]}}, "
        "\"offset_x\": {\"base_value\": 40}, \"offset_by_speed\": {\"base_value\": 3, \"inputs\": "
        "{\"pressure\": [[0, 0], [1e-30, 6]]}}",
    };
    Record record = { 0 };
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        WrPreset *preset = preset_of(settings[i]);
        WrBrush brush = plain(preset, 0.3);
        WrEnginePoint points[] = { at(0, 0, 0), at(5000, 0, 0.004), at(5000, 0, 0.008) };
        run(&record, &brush, points, 3);
        assert_true(record.dabs.count < 400000);
        wr_preset_free(preset);
    }
    wr_array_free(&record.dabs);
}

static void points_that_are_not_numbers_do_no_harm(void **state)
{
    (void)state;
    Record record = { 0 };
    WrPreset *preset = preset_of("");
    WrBrush brush = plain(preset, 5.0);
    WrEnginePoint points[] = { at(NAN, 0, 0),
                               at(0, INFINITY, 0),
                               at(10, 10, NAN),
                               { 20, 10, NAN, NAN, NAN, 1, NAN },
                               at(60, 10, -5),
                               at(90, 10, 1e300),
                               { 99, 10, 9, 9, -9, -INFINITY, INFINITY } };
    run(&record, &brush, points, 7);
    assert_true(record.dabs.count > 10);
    for (int i = 0; i < record.dabs.count; i++)
        assert_true(record.dabs.data[i].x > 5 && record.dabs.data[i].x < 105);
    run(&record, &brush, points, 2); /* without a valid dab */
    assert_int_equal(record.dabs.count, 0);
    run(&record, &brush, points, 0);
    assert_int_equal(record.dabs.count, 0);
    wr_array_free(&record.dabs);
    wr_preset_free(preset);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dabs_lie_on_the_way_at_the_spacing_of_the_preset),
        cmocka_unit_test(hc75_one_event_or_a_thousand_give_the_same_dabs),
        cmocka_unit_test(corners_within_a_step_are_not_cut),
        cmocka_unit_test(a_tap_makes_one_dab_where_it_is),
        cmocka_unit_test(points_without_time_move_at_400_texels_a_second),
        cmocka_unit_test(a_rest_sprays_for_as_long_as_it_lasts_but_for_a_second_at_most),
        cmocka_unit_test(angles_come_out_anticlockwise_as_seen),
        cmocka_unit_test(tilt_leans_as_mypaint_says),
        cmocka_unit_test(the_turn_of_the_pen_turns_the_dabs),
        cmocka_unit_test(smudging_drags_heights_of_any_size),
        cmocka_unit_test(length_1_drags_the_first_height_for_ever),
        cmocka_unit_test(flow_and_the_erasing_part_are_in_alpha),
        cmocka_unit_test(the_brush_turns_and_scatters_dabs_on_top_of_its_preset),
        cmocka_unit_test(the_seed_alone_chooses_what_is_random),
        cmocka_unit_test(large_radii_go_beyond_the_librarys_limit_of_1000),
        cmocka_unit_test(dabs_stay_in_place_far_from_the_corner),
        cmocka_unit_test(a_way_beyond_all_tables_ends_soon),
        cmocka_unit_test(presets_that_would_flood_a_step_with_dabs_do_not),
        cmocka_unit_test(points_that_are_not_numbers_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
