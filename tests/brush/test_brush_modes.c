/* Coverage-based modes: the result for a height, against closed forms and slow models; opacity, flow, selection,
   mark; and the hard cases of strokes for every mode. */
#include "brush_help.h"

#include "base/error.h"

#include <float.h>

enum { W = 96, H = 80 };

/* Fill everything by half. */
static void fill_half(WrField *field, const WrBrush *brush, const WrField *below)
{
    WrField *cover = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.5f, NULL);
    WrBrushGround ground = { .field = field, .below = below, .neutral = 0.75f };
    WrError err;
    assert_true(wr_brush_fill(&ground, brush, cover, 0.3, 0.6, &err));
    wr_field_free(cover);
}

static int wrap(int i, int n)
{
    return (i % n + n) % n;
}

/* Largest (sign 1), smallest (sign -1) or mean (0) of the texels within reach + 1/2. */
static double around(const WrField *f, int i, int j, int reach, int sign)
{
    double best = -1e30, sum = 0, count = 0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            if (x * x + y * y > (reach + 0.5) * (reach + 0.5)) continue;
            double h = wr_field_get(f, wrap(i + x, W), wrap(j + y, H));
            best = fmax(best, sign * h);
            sum += h;
            count++;
        }
    return sign ? sign * best : sum / count;
}

/* Target height of a mode for height f of texel (i, j), as in brush.h. */
static double aim(const WrField *start, const WrBrush *b, int i, int j)
{
    double f = wr_field_get(start, i, j);
    int reach = (int)b->reach;
    switch (b->mode) {
    case WR_BRUSH_RAISE: return f + b->strength;
    case WR_BRUSH_LOWER: return f - b->strength;
    case WR_BRUSH_TO: return f + copysign(fmin(b->strength, fabs(b->to - f)), b->to - f);
    case WR_BRUSH_FLATTEN: return wr_field_get(start, (int)(0.3 * W), (int)(0.4 * H));
    case WR_BRUSH_LIFT: return fmax(f, b->to);
    case WR_BRUSH_CUT: return fmin(f, b->to);
    case WR_BRUSH_ERASE: return 0.75;
    case WR_BRUSH_CLONE: return wr_field_get(start, wrap(i + W / 4, W), wrap(j - H / 8, H));
    case WR_BRUSH_SHARPEN: return 2 * f - around(start, i, j, reach, 0);
    case WR_BRUSH_DILATE: return around(start, i, j, reach, 1);
    case WR_BRUSH_ERODE: return around(start, i, j, reach, -1);
    default: return f;
    }
}

static void half_a_cover_goes_half_the_way_in_every_covering_mode(void **state)
{
    (void)state;
    for (int mode = 0; mode < WR_BRUSH_SMOOTH; mode++)
        for (int reach = 1; reach < 12; reach += 5) {
            WrField *start = rough(W, H, WR_WRAP_PERIODIC), *field = wr_field_share(start);
            WrBrush brush = brush_of((WrBrushMode)mode, 10);
            brush.reach = reach;
            fill_half(field, &brush, NULL);
            for (int j = 0; j < H; j++)
                for (int i = 0; i < W; i++) {
                    double f = wr_field_get(start, i, j);
                    assert_near(wr_field_get(field, i, j), f + 0.5 * (aim(start, &brush, i, j) - f),
                                1e-7);
                }
            wr_field_free(start);
            wr_field_free(field);
        }
}

static void moving_modes_refuse_to_fill(void **state)
{
    (void)state;
    for (int mode = WR_BRUSH_SMOOTH; mode < WR_BRUSH_MODE_COUNT; mode++) {
        WrField *field = torus(W, H);
        WrBrush brush = brush_of((WrBrushMode)mode, 10);
        WrBrushGround ground = { .field = field };
        WrError err = { "" };
        assert_false(wr_brush_fill(&ground, &brush, field, 0, 0, &err));
        assert_non_null(strstr(err.text, wr_brush_modes[mode].name));
        wr_field_free(field);
    }
}

static void erasing_leads_to_what_lies_below_and_lowers_the_mark(void **state)
{
    (void)state;
    WrField *field = rough(W, H, WR_WRAP_PERIODIC), *below = rolled(field, 5, 9);
    WrField *mark = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.8f, NULL);
    WrBrush brush = brush_of(WR_BRUSH_ERASE, 9);
    brush.hardness = 1;
    brush.opacity = 0.75;
    WrBrushGround ground = { .field = field, .mark = mark, .below = below };
    WrField *start = wr_field_share(field);
    wr_brush_dab_on(&ground, &brush, (40 + 0.5) / W, 1 - (30 + 0.5) / H);
    double f = wr_field_get(start, 42, 31), to = wr_field_get(below, 42, 31);
    assert_near(wr_field_get(field, 42, 31), f + 0.75 * (to - f), 1e-7);
    assert_near(wr_field_get(mark, 42, 31), 0.8 * 0.25, 1e-7);
    assert_true(wr_field_get(mark, 60, 31) == 0.8f);
    wr_field_free(start);
    wr_field_free(field);
    wr_field_free(below);
    wr_field_free(mark);
}

static const WrSample cross[] = {
    { .u = 0.2, .v = 0.2, .pressure = 1 }, { .u = 0.6, .v = 0.6, .pressure = 1 },
    { .u = 0.6, .v = 0.2, .pressure = 1 }, { .u = 0.2, .v = 0.6, .pressure = 1 },
    { .u = 0.4, .v = 0.4, .pressure = 1 }, { .u = 0.2, .v = 0.2, .pressure = 1 }
};

static float highest(const WrField *field)
{
    float low, high;
    wr_field_range(field, &low, &high);
    return high;
}

static void opacity_caps_the_stroke_flow_reaches_the_cap_and_buildup_passes_it(void **state)
{
    (void)state;
    WrBrush brush = brush_of(WR_BRUSH_RAISE, 8);
    brush.strength = 1;
    brush.opacity = 0.375;
    WrField *once = torus(W, H), *flow = torus(W, H), *weak = torus(W, H), *grown = torus(W, H);
    run_stroke(once, &brush, cross, 6);
    assert_true(highest(once) == 0.375f);
    brush.flow = 0.4;
    run_stroke(flow, &brush, cross, 6);
    assert_true(highest(flow) <= 0.375f && highest(flow) > 0.3749f);
    brush.flow = 0.001;
    run_stroke(weak, &brush, cross, 6);
    assert_true(highest(weak) < 0.1f && highest(weak) > 0.001f * 0.375f);
    brush.flow = 0.4;
    brush.buildup = true;
    run_stroke(grown, &brush, cross, 6);
    assert_true(highest(grown) > 2);
    wr_field_free(once);
    wr_field_free(flow);
    wr_field_free(weak);
    wr_field_free(grown);
}

/* Two dabs of alpha a at one position: 1 - (1 - a)^2, and 2 a. */
static void dabs_gather_as_the_rules_say(void **state)
{
    (void)state;
    for (int buildup = 0; buildup < 2; buildup++) {
        WrField *field = torus(W, H);
        WrBrush brush = brush_of(WR_BRUSH_RAISE, 20);
        brush.strength = 1;
        brush.flow = 0.3;
        brush.spacing = 0.2; /* 4 texels */
        brush.hardness = 0.9;
        brush.buildup = buildup;
        WrSample samples[] = { at(0.5, 0.5, 1), at(0.5 + 4.2 / W, 0.5, 1) };
        run_stroke(field, &brush, samples, 2);
        assert_near(wr_field_get(field, W / 2, H / 2), buildup ? 0.6 : 0.51, 1e-7);
        wr_field_free(field);
    }
}

static void nothing_changes_where_nothing_is_selected_in_any_mode(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            WrField *start = rough(W, H, WR_WRAP_PERIODIC), *field = wr_field_share(start);
            WrField *selection = torus(W, H), *mark = torus(W, H), *whole = wr_field_share(start);
            for (int j = 0; j < H; j++)
                for (int i = 0; i < W / 2; i++) wr_field_set(selection, i, j, 1);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 9), tip);
            WrBrushGround ground = { .field = field, .mark = mark, .selection = selection };
            run_on(&ground, &brush, cross, 6);
            int changed = 0;
            for (int j = 0; j < H; j++)
                for (int i = 0; i < W; i++) {
                    bool same = same_bits(wr_field_get(field, i, j), wr_field_get(start, i, j));
                    changed += !same;
                    if (i >= W / 2) assert_true(same && wr_field_get(mark, i, j) == 0);
                }
            assert_true(changed > 100);
            assert_true(mode == WR_BRUSH_ERASE || highest(mark) > 0.04f);
            wr_field_fill(selection, 1);
            wr_field_free(ground.field);
            ground.field = wr_field_share(start);
            run_on(&ground, &brush, cross, 6);
            run_stroke(whole, &brush, cross, 6);
            assert_true(same_heights(whole, ground.field));
            wr_field_free(start);
            wr_field_free(ground.field);
            wr_field_free(selection);
            wr_field_free(mark);
            wr_field_free(whole);
        }
    wr_tip_free(tip);
}

static void hc69_a_dab_on_the_corner_is_the_rolled_one_in_every_mode(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++)
            for (int large = 0; large < 2; large++) {
                WrField *middle = rough(128, 128, WR_WRAP_PERIODIC);
                WrField *corner = rolled(middle, 64, 64);
                WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, large ? 70 : 13), tip);
                WrSample a[] = { at(0.5, 0.5, 1), at(0.5625, 0.53125, 1) };
                WrSample b[] = { at(0, 0, 1), at(0.0625, 0.03125, 1) };
                run_stroke(middle, &brush, a, 2);
                run_stroke(corner, &brush, b, 2);
                WrField *back = rolled(corner, 64, 64);
                /* sums over texels have another order: a mean may differ in its last bit */
                bool sums = mode == WR_BRUSH_SHARPEN || mode == WR_BRUSH_LEVEL;
                if (sums) assert_true(largest_difference(back, middle) < 1e-6);
                else assert_true(same_heights(back, middle));
                wr_field_free(middle);
                wr_field_free(corner);
                wr_field_free(back);
            }
    wr_tip_free(tip);
}

static void hc70_no_radius_is_too_large_for_any_mode(void **state)
{
    (void)state;
    const double radii[] = { 33, 70, 1e4, 1e9, INFINITY };
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++)
            for (int r = 0; r < 5; r++)
                for (int wraps = 0; wraps < 2; wraps++) {
                    WrField *field = rough(64, 40, wraps ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP);
                    WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, radii[r]), tip);
                    run_stroke(field, &brush, cross, 3);
                    float low, high;
                    wr_field_range(field, &low, &high);
                    assert_true(low > -10 && high < 10);
                    wr_field_free(field);
                }
    wr_tip_free(tip);
}

/* With flow, a texel processed twice would be visible. */
static void hc70_a_huge_dab_with_flow_meets_each_texel_once(void **state)
{
    (void)state;
    const double radii[] = { 200, 1e6, 1e9 };
    for (int r = 0; r < 3; r++)
        for (int aspect = 1; aspect < 3; aspect++) {
            WrField *field = torus(70, 33);
            WrBrush brush = brush_of(WR_BRUSH_RAISE, radii[r]);
            brush.hardness = 1;
            brush.flow = 0.5;
            brush.aspect = aspect;
            wr_brush_dab(field, &brush, 0.31, 0.9);
            float low, high;
            wr_field_range(field, &low, &high);
            assert_true(low == 0.125f && high == 0.125f);
            wr_field_free(field);
        }
}

static void hc71_odd_radii_do_nothing_or_one_texel_in_every_mode(void **state)
{
    (void)state;
    const double radii[] = { 0, -1, NAN, -INFINITY, 0.3 };
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++)
            for (int r = 0; r < 5; r++) {
                WrField *start = rough(64, 40, WR_WRAP_PERIODIC), *field = wr_field_share(start);
                WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, radii[r]), tip);
                wr_brush_dab(field, &brush, 0.4, 0.4);
                int changed = 0;
                for (int j = 0; j < 40; j++)
                    for (int i = 0; i < 64; i++)
                        changed += wr_field_get(field, i, j) != wr_field_get(start, i, j);
                assert_true(changed <= (radii[r] > 0));
                if (radii[r] > 0 && mode == WR_BRUSH_RAISE) assert_int_equal(changed, 1);
                wr_field_free(start);
                wr_field_free(field);
            }
    wr_tip_free(tip);
}

static void hc72_a_hundred_equal_samples_are_one_dab_in_every_mode(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            WrField *many = rough(W, H, WR_WRAP_PERIODIC), *one = wr_field_share(many);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 9), tip);
            WrSample samples[100];
            for (int k = 0; k < 100; k++) samples[k] = at(0.31, 0.77, 1);
            run_stroke(many, &brush, samples, 100);
            wr_brush_dab(one, &brush, 0.31, 0.77);
            assert_true(same_heights(many, one));
            wr_field_free(many);
            wr_field_free(one);
        }
    wr_tip_free(tip);
}

static void hc73_a_stroke_over_the_seam_is_the_rolled_one_in_every_mode(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            WrField *inside = rough(128, 64, WR_WRAP_PERIODIC), *seam = rolled(inside, 64, 32);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 5), tip);
            WrSample a[] = { at(0.4375, 0.375, 1), at(0.5625, 0.625, 0.5), at(0.75, 0.5, 1) };
            WrSample b[] = { at(0.9375, 0.875, 1), at(0.0625, 0.125, 0.5), at(0.25, 0, 1) };
            run_stroke(inside, &brush, a, 3);
            run_stroke(seam, &brush, b, 3);
            WrField *back = rolled(seam, 64, 32);
            /* positions along the path are rounded to 2^-20 texel, and sums differ in order */
            assert_true(largest_difference(back, inside) < 2e-6);
            wr_field_free(inside);
            wr_field_free(seam);
            wr_field_free(back);
        }
    wr_tip_free(tip);
}

static void hc74_wild_samples_leave_finite_heights_in_every_mode(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    const double wild[] = { NAN, INFINITY, -INFINITY, -3, 1e300, 1 };
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            WrField *field = rough(W, H, WR_WRAP_CLAMP);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 9), tip);
            WrStroke *stroke = wr_stroke_new(field, &brush);
            for (int k = 0; k < 36; k++)
                wr_stroke_add(stroke, (WrSample){ .u = k % 5 ? 0.02 * k : wild[k / 6],
                                                  .v = 0.3 + 0.01 * k,
                                                  .pressure = wild[k % 6],
                                                  .tilt_x = wild[k / 6],
                                                  .tilt_y = 1,
                                                  .seconds = wild[k / 6] });
            wr_stroke_finish(stroke);
            float low, high;
            wr_field_range(field, &low, &high);
            assert_true(low > -100 && high < 100);
            wr_field_free(field);
        }
    wr_tip_free(tip);
}

/* Positions along a path are sums with rounding errors far below 2^-20 texel, to which positions are then rounded: a
 * dab may be displaced by one such step, 1e-6 texel. */
static void hc75_one_event_or_a_thousand_in_every_mode_and_way(void **state)
{
    (void)state;
    static WrSample many[1001];
    WrTip *tip = arrow_tip();
    for (int k = 0; k <= 1000; k++)
        many[k] = at(0.125 + 0.375 * k / 1000, 0.2 + 0.3 * k / 1000, 0.75);
    const WrSample two[] = { many[0], many[1000] };
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            WrField *a = rough(256, 128, WR_WRAP_PERIODIC), *b = wr_field_share(a);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 12), tip);
            run_stroke(a, &brush, many, 1001);
            run_stroke(b, &brush, two, 2);
            assert_true(largest_difference(a, b) < 2e-5);
            wr_field_free(a);
            wr_field_free(b);
        }
    wr_tip_free(tip);
}

/* A brush that covers the whole table evenly: the height is the number of dabs times flow and strength. In float
 * alone a sum of 1e6 times 1e-3 would be wrong by percents. */
static void hc76_very_many_dabs_add_up_and_stay_finite(void **state)
{
    (void)state;
    const char *full = getenv("WR_FULL");
    const int count = full && *full ? 1000000 : 10000;
    WrField *field = torus(64, 64);
    WrBrush brush = brush_of(WR_BRUSH_RAISE, 1e4);
    brush.hardness = 1;
    brush.buildup = true;
    brush.flow = 0.001;
    brush.spacing = 0.01; /* 100 texels */
    brush.strength = 0.5;
    WrStroke *stroke = wr_stroke_new(field, &brush);
    double way = 0;
    for (int k = 0; way <= (count - 0.5) * 100; k++, way += 25)
        wr_stroke_push(stroke,
                       at(k % 4 == 1 || k % 4 == 2 ? 25.0 / 64 : 0, k % 4 > 1 ? 25.0 / 64 : 0, 1));
    wr_stroke_finish(stroke);
    float low, high;
    wr_field_range(field, &low, &high);
    double expected = 0.5 * count * (double)0.001f;
    assert_near(low, expected, 1e-6 * expected);
    assert_true(low == high);
    brush.strength = 1e38;
    stroke = wr_stroke_new(field, &brush);
    for (int k = 0; k < 100000; k++) wr_stroke_push(stroke, at(k % 2 ? 0.4 : 0, 0, 1));
    wr_stroke_finish(stroke);
    wr_field_range(field, &low, &high);
    assert_true(high == FLT_MAX && low == FLT_MAX);
    wr_field_free(field);
}

static void every_mode_has_a_name_of_its_own(void **state)
{
    (void)state;
    for (int a = 0; a < WR_BRUSH_MODE_COUNT; a++) {
        const WrBrushModeInfo *info = &wr_brush_modes[a];
        assert_true(info->name && info->label && info->help && info->spacing > 0);
        assert_true(info->moves == (wr_mode_work((WrBrushMode)a)->move != NULL));
        assert_true(info->moves == (wr_mode_work((WrBrushMode)a)->cover == NULL));
        for (int b = 0; b < a; b++) assert_string_not_equal(info->name, wr_brush_modes[b].name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_a_cover_goes_half_the_way_in_every_covering_mode),
        cmocka_unit_test(moving_modes_refuse_to_fill),
        cmocka_unit_test(erasing_leads_to_what_lies_below_and_lowers_the_mark),
        cmocka_unit_test(opacity_caps_the_stroke_flow_reaches_the_cap_and_buildup_passes_it),
        cmocka_unit_test(dabs_gather_as_the_rules_say),
        cmocka_unit_test(nothing_changes_where_nothing_is_selected_in_any_mode),
        cmocka_unit_test(hc69_a_dab_on_the_corner_is_the_rolled_one_in_every_mode),
        cmocka_unit_test(hc70_no_radius_is_too_large_for_any_mode),
        cmocka_unit_test(hc70_a_huge_dab_with_flow_meets_each_texel_once),
        cmocka_unit_test(hc71_odd_radii_do_nothing_or_one_texel_in_every_mode),
        cmocka_unit_test(hc72_a_hundred_equal_samples_are_one_dab_in_every_mode),
        cmocka_unit_test(hc73_a_stroke_over_the_seam_is_the_rolled_one_in_every_mode),
        cmocka_unit_test(hc74_wild_samples_leave_finite_heights_in_every_mode),
        cmocka_unit_test(hc75_one_event_or_a_thousand_in_every_mode_and_way),
        cmocka_unit_test(hc76_very_many_dabs_add_up_and_stay_finite),
        cmocka_unit_test(every_mode_has_a_name_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
