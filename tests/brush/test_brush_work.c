/* Processing of strokes: in parts, by several threads, by any instruction set; and symmetry copies. */
#include "brush_help.h"

#include "base/error.h"
#include "brush/preset.h"

enum { W = 128, H = 128 };

static const WrSample path[] = { { .u = 0.2, .v = 0.3, .pressure = 0.4 },
                                 { .u = 0.35, .v = 0.55, .pressure = 1, .seconds = 0.05 },
                                 { .u = 0.6, .v = 0.5, .pressure = 0.7, .seconds = 0.1 },
                                 { .u = 0.55, .v = 0.2, .pressure = 0.9, .seconds = 0.2 },
                                 { .u = 0.9, .v = 0.15, .pressure = 0.5, .seconds = 0.3 } };
enum { POINTS = 5 };

static WrPreset *soft_preset(void)
{
    const char text[] =
        "{\"version\":3,\"settings\":{\"offset_by_random\":{\"base_value\":0.5,\"inputs\":{}},"
        "\"opaque_multiply\":{\"base_value\":0,\"inputs\":{\"pressure\":[[0,0],[1,1]]}}}}";
    WrPreset *preset = wr_preset_parse(text, sizeof text - 1, "soft", NULL, NULL);
    assert_non_null(preset);
    return preset;
}

static void the_bits_do_not_depend_on_how_the_work_is_cut(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    WrPreset *preset = soft_preset();
    TestRandom random = { 21 };
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way <= WAY_COUNT; way++) {
            WrField *whole = rough(W, H, WR_WRAP_PERIODIC), *cut = wr_field_share(whole);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 9), tip);
            if (way == WAY_COUNT) brush.preset = preset;
            run_stroke(whole, &brush, path, POINTS);
            WrStroke *stroke = wr_stroke_new(cut, &brush);
            for (int k = 0; k < POINTS; k++) {
                wr_stroke_push(stroke, path[k]);
                for (int n = (int)(9 * test_random(&random)); n > 0; n--) {
                    wr_stroke_work(stroke, n % 3 ? 0 : -1);
                    wr_field_free(wr_field_share(cut)); /* as in a preview */
                }
            }
            while (wr_stroke_work(stroke, 0)) {
            }
            assert_false(wr_stroke_work(stroke, 1));
            wr_stroke_finish(stroke);
            assert_true(same_heights(whole, cut));
            wr_field_free(whole);
            wr_field_free(cut);
        }
    wr_preset_free(preset);
    wr_tip_free(tip);
}

static void an_abandoned_stroke_draws_nothing_more(void **state)
{
    (void)state;
    WrField *field = rough(W, H, WR_WRAP_PERIODIC), *before = wr_field_share(field);
    WrBrush brush = brush_of(WR_BRUSH_RAISE, 9);
    WrStroke *stroke = wr_stroke_new(field, &brush);
    for (int k = 0; k < POINTS; k++) wr_stroke_push(stroke, path[k]);
    wr_stroke_abandon(stroke);
    assert_true(wr_field_key(field) == wr_field_key(before));
    wr_stroke_abandon(NULL);
    wr_field_free(field);
    wr_field_free(before);
}

/* A brush larger than many tiles: heights are the largest coverage of all motions, each drawn as a stroke of its own. The ends of
   motions are dabs there, which may differ in the last bit. */
static void a_large_stroke_is_the_largest_of_its_motions(void **state)
{
    (void)state;
    enum { COUNT = 7, WIDE = 1100, TALL = 900 };
    WrPool *pool = wr_pool_new(3);
    TestRandom r = { 77 };
    for (int k = 0; k < 4; k++) {
        const WrWrap wrap = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrBrush brush = brush_of(WR_BRUSH_RAISE, 130 + 260 * test_random(&r));
        brush.strength = 1;
        brush.hardness = k % 3 ? test_random(&r) : 0;
        brush.pressure =
            WR_PRESSURE_NONE; /* falling pressure: the dab at a motion's start is above it */
        WrSample s[COUNT];
        WrField *field = wr_field_new(WIDE, TALL, wrap, wrap, 0, NULL), *pairs[COUNT - 1];
        for (int i = 0; i < COUNT; i++)
            s[i] = (WrSample){ .u = test_random(&r),
                               .v = test_random(&r),
                               .pressure = test_random(&r) };
        const WrBrushGround ground = { .field = field, .pool = pool };
        WrStroke *stroke = wr_stroke_new_on(&ground, &brush);
        for (int i = 0; i < COUNT; i++) {
            wr_stroke_push(stroke, s[i]);
            while (wr_stroke_work(stroke, 0)) assert_true(wr_stroke_drawn(stroke) <= i + 1);
            assert_int_equal(wr_stroke_drawn(stroke), i + 1);
        }
        wr_stroke_finish(stroke);
        for (int i = 0; i + 1 < COUNT; i++) {
            pairs[i] = wr_field_new(WIDE, TALL, wrap, wrap, 0, NULL);
            run_stroke(pairs[i], &brush, s + i, 2);
        }
        for (int j = 0; j < TALL; j += 5)
            for (int i = 0; i < WIDE; i++) {
                double most = 0;
                for (int n = 0; n + 1 < COUNT; n++)
                    most = fmax(most, (double)wr_field_get(pairs[n], i, j));
                assert_near((double)wr_field_get(field, i, j), most, 2e-7);
            }
        for (int i = 0; i + 1 < COUNT; i++) wr_field_free(pairs[i]);
        wr_field_free(field);
    }
    wr_pool_free(pool);
}

/* Motions of a large brush wait and are added together, and those that cannot raise a tile are passed over: one by one they give the
   same bits. Some follow each other closely, as those of a pen do. */
static void a_large_stroke_does_not_depend_on_what_is_added_together(void **state)
{
    (void)state;
    enum { COUNT = 70, WIDE = 1103, TALL = 911 };
    WrPool *pool = wr_pool_new(3);
    TestRandom r = { 31 };
    for (int k = 0; k < 4; k++) {
        const WrWrap wrap_u = k & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        const WrWrap wrap_v = k & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrBrush brush = brush_of(WR_BRUSH_RAISE, 257 + 400 * test_random(&r));
        brush.hardness = k == 2 ? 0 : test_random(&r);
        WrField *alone = wr_field_new(WIDE, TALL, wrap_u, wrap_v, 0.3f, NULL);
        WrField *together = wr_field_share(alone);
        const WrBrushGround ground = { .field = together, .pool = pool };
        WrStroke *one = wr_stroke_new(alone, &brush), *all = wr_stroke_new_on(&ground, &brush);
        WrSample s = { .u = test_random(&r), .v = test_random(&r), .pressure = 0.5 };
        for (int i = 0; i < COUNT; i++) {
            const double far = i % 16 == 15 ? 0.7 : 0.05;
            s.u += far * (test_random(&r) - 0.5), s.v += far * (test_random(&r) - 0.5);
            s.pressure = 0.2 + 0.8 * test_random(&r);
            wr_stroke_add(one, s);
            wr_stroke_push(all, s);
        }
        wr_stroke_finish(one);
        wr_stroke_finish(all);
        assert_true(same_heights(alone, together));
        wr_field_free(alone);
        wr_field_free(together);
    }
    wr_pool_free(pool);
}

static void several_threads_give_the_same_bits(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(4);
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode += test_step(3, 6))
        for (int way = 0; way < WAY_COUNT; way += 2) {
            WrField *one = rough(1100, 900, WR_WRAP_PERIODIC), *four = wr_field_share(one);
            WrField *marks[] = { torus(1100, 900), torus(1100, 900) };
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 600), tip);
            WrBrushGround a = { .field = one, .mark = marks[0] };
            WrBrushGround b = { .field = four, .mark = marks[1], .pool = pool };
            run_on(&a, &brush, path, 2);
            run_on(&b, &brush, path, 2);
            assert_true(same_heights(one, four) && same_heights(marks[0], marks[1]));
            if (wr_mode_work((WrBrushMode)mode)->cover) {
                assert_true(wr_brush_fill(&a, &brush, marks[0], 0, 0, NULL));
                assert_true(wr_brush_fill(&b, &brush, marks[1], 0, 0, NULL));
                assert_true(same_heights(one, four));
            }
            wr_field_free(one);
            wr_field_free(four);
            wr_field_free(marks[0]);
            wr_field_free(marks[1]);
        }
    wr_tip_free(tip);
    wr_pool_free(pool);
}

static void fill_random(TestRandom *random, int count, float *out)
{
    for (int i = 0; i < count; i++) out[i] = (float)test_random(random);
}

static void every_set_of_kernels_gives_the_same_bits(void **state)
{
    (void)state;
    TestRandom random = { 31 };
    const WrBrushKernels *plain = wr_brush_kernels_at(0);
    for (int set = 1; set < WR_BRUSH_KERNELS; set++) {
        const WrBrushKernels *k = wr_brush_kernels_at(set);
        if (!k) continue;
        for (int n = 0; n < 400; n++) {
            int count = (n % 4 + 1) * WR_BRUSH_BLOCK;
            double r = 1 + 60 * test_random(&random), turn = test_random(&random);
            WrEllipse e = { .x = 40 * test_random(&random),
                            .y = 40 * test_random(&random),
                            .ux = cos(turn),
                            .uy = sin(turn),
                            .aspect = 1 + 3 * test_random(&random),
                            .radius2 = r * r,
                            .radius = r,
                            .inner2 = 0.3 * r * r,
                            .inverse_edge = 1 / (r - sqrt(0.3) * r),
                            .alpha = (float)test_random(&random),
                            .hardness = 0.7f,
                            .slope_in = (float)(1 / 0.7 - 1),
                            .slope_out = (float)(0.7 / 0.3),
                            .inverse_radius2 = (float)(1 / (r * r)) };
            float a[64], b[64], fresh[64], rest[2][64], rows[6][128];
            fill_random(&random, 64, fresh);
            k->ellipse(&e, 20, -5, count, a);
            plain->ellipse(&e, 20, -5, count, b);
            assert_memory_equal(a, b, (size_t)count * sizeof *a);
            k->soft(&e, 20, -5, count, a);
            plain->soft(&e, 20, -5, count, b);
            assert_memory_equal(a, b, (size_t)count * sizeof *a);
            fill_random(&random, 64, a);
            memcpy(b, a, sizeof a);
            k->soft_over(&e, 18, -5, count, a);
            plain->soft_over(&e, 18, -5, count, b);
            k->over(a, fresh, count);
            plain->over(b, fresh, count);
            memcpy(rest[0], fresh, sizeof fresh);
            memcpy(rest[1], fresh, sizeof fresh);
            k->sum(a, rest[0], fresh, count);
            plain->sum(b, rest[1], fresh, count);
            assert_memory_equal(a, b, (size_t)count * sizeof *a);
            assert_memory_equal(rest[0], rest[1], sizeof fresh);
            for (int row = 0; row < 6; row++) fill_random(&random, 128, rows[row]);
            int stride = n % 9 + 1;
            k->flow(rows[0] + 16, rows[1] + 16, rows[2], rows[3], rows[4], rows[5], stride,
                    count - n % 7, a);
            plain->flow(rows[0] + 16, rows[1] + 16, rows[2], rows[3], rows[4], rows[5], stride,
                        count - n % 7, b);
            assert_memory_equal(a, b, (size_t)count * sizeof *a);
        }
    }
}

/* Circles have a fast path, which `soft` has not; near and far, small and as large as possible. */
static void the_short_way_of_circles_gives_the_bits_of_the_long_one(void **state)
{
    (void)state;
    TestRandom random = { 32 };
    for (int set = 0; set < WR_BRUSH_KERNELS; set++) {
        const WrBrushKernels *k = wr_brush_kernels_at(set);
        for (int n = 0; k && n < 2000; n++) {
            double r = n % 3 ? 1 + 300 * test_random(&random) : 1e9 * test_random(&random) + 1;
            double hardness = 0.01 + 0.98 * test_random(&random);
            WrEllipse e = { .x = n % 7 ? 16384 * test_random(&random) : 20,
                            .y = 9 * test_random(&random) };
            e.ux = e.aspect = 1;
            e.uy = n % 2 ? -0.0 : 0.0;
            e.alpha = (float)test_random(&random);
            e.hardness = (float)hardness;
            e.slope_in = (float)(1 / hardness - 1);
            e.slope_out = (float)(hardness / (1 - hardness));
            e.inverse_radius2 = (float)(1 / (r * r));
            double x = floor(e.x + (2 * test_random(&random) - 1) * (r < 400 ? r : 400)),
                   y = n % 20;
            float a[64], b[64], fresh[64];
            fill_random(&random, 64, a);
            memcpy(b, a, sizeof a);
            k->soft(&e, y, x, 64, fresh);
            k->over(a, fresh, 64);
            k->soft_over(&e, y, x, 64, b);
            assert_memory_equal(a, b, sizeof a);
        }
    }
}

/* `over` followed by `soft` equals `soft_over`. */
static void the_joined_kernel_does_what_its_two_parts_do(void **state)
{
    (void)state;
    const WrBrushKernels *k = wr_brush_kernels();
    WrEllipse e = { .x = 30, .y = 3, .ux = 1, .aspect = 2, .radius2 = 900, .alpha = 0.4f };
    e.hardness = 0.5f;
    e.slope_in = e.slope_out = 1;
    e.inverse_radius2 = 1 / 900.0f;
    float a[64] = { 0.25f }, b[64] = { 0.25f }, fresh[64];
    k->soft(&e, 1, 0, 64, fresh);
    k->over(a, fresh, 64);
    k->soft_over(&e, 1, 0, 64, b);
    assert_memory_equal(a, b, sizeof a);
    assert_true(a[30] > 0.3f && a[0] >= 0.25f);
}

/* ---- symmetry ---- */

static WrField *mirror_image(const WrField *field, bool in_u)
{
    int w = wr_field_width(field), h = wr_field_height(field);
    WrField *out = torus(w, h);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(out, in_u ? w - 1 - i : i, in_u ? j : h - 1 - j,
                         wr_field_get(field, i, j));
    return out;
}

/* The maximum of coverages is independent of order, so the picture equals its mirror image bit for bit; sums and
 * moved heights are processed in another order at the mirror axis. */
static void what_is_painted_with_a_mirror_is_its_own_mirror_image(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            if (mode == WR_BRUSH_CLONE || mode == WR_BRUSH_FLATTEN) continue; /* not symmetric */
            WrField *field = torus(W, H);
            for (int j = 0; j < H; j++)
                for (int i = 0; i < W; i++)
                    wr_field_set(field, i, j, (float)cos(0.37 * fabs(i - 63.5) + 0.2 * j));
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 7), tip);
            brush.symmetry.mirror_u = true;
            brush.symmetry.centre_u = brush.symmetry.centre_v = 0.5;
            WrSample left[] = { at(0.1, 0.2, 1), at(0.3, 0.6, 0.8), at(0.35, 0.3, 1) };
            run_stroke(field, &brush, left, 3); /* never closer to the axis than 12 texels */
            WrField *image = mirror_image(field, true);
            bool exact = mode != WR_BRUSH_SHARPEN && mode != WR_BRUSH_LEVEL;
            if (exact) assert_true(same_heights(image, field));
            else assert_true(largest_difference(image, field) < 1e-6);
            WrSample across[] = { at(0.3, 0.2, 1), at(0.7, 0.9, 0.8) };
            WrField *start = mirror_image(field, true);
            run_stroke(start, &brush, across, 2);
            WrField *other = mirror_image(start, true);
            if (way == WAY_PLAIN && exact && !wr_brush_modes[mode].moves)
                assert_true(same_heights(start, other));
            /* where both overlap, a moving copy processes the other's result: a part of it */
            double tolerance = wr_brush_modes[mode].moves ? 1.5 : 1e-5;
            assert_true(largest_difference(start, other) < tolerance);
            wr_field_free(field);
            wr_field_free(image);
            wr_field_free(start);
            wr_field_free(other);
        }
    wr_tip_free(tip);
}

/* Four quarter turns about the centre: the table equals itself rotated by 90 degrees. */
static void quarter_turns_are_exact(void **state)
{
    (void)state;
    WrField *field = torus(W, H);
    WrBrush brush = brush_of(WR_BRUSH_RAISE, 7);
    brush.symmetry = (WrSymmetry){ .radial = 4, .centre_u = 0.5, .centre_v = 0.5 };
    run_stroke(field, &brush, path, POINTS);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            assert_true(wr_field_get(field, i, j) == wr_field_get(field, H - 1 - j, i));
    wr_field_free(field);
}

static void repeats_by_whole_texels_are_rolled_bit_for_bit(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            if (mode == WR_BRUSH_SHARPEN || mode == WR_BRUSH_LEVEL) continue; /* sums */
            WrField *field = torus(W, H);
            for (int j = 0; j < H; j++)
                for (int i = 0; i < W; i++) /* the lattice's own period: 32 x 64, half-drop */
                    wr_field_set(field, i, j,
                                 (float)(((i % 32) * 7 + ((j + i / 32 * 32) % 64) * 3) % 11) / 11);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 5), tip);
            brush.to = 0.5;
            brush.source_u = 3.0 / W;
            brush.symmetry = (WrSymmetry){ .repeat_u = 4, .repeat_v = 2, .stagger = 0.5 };
            WrSample samples[] = { at(0.07, 0.2, 1), at(0.13, 0.32, 0.8) };
            run_stroke(field, &brush, samples, 2);
            WrField *column = rolled(field, 32, -32), *row = rolled(field, 0, 64);
            assert_true(same_heights(field, column) && same_heights(field, row));
            float low, high;
            wr_field_range(field, &low, &high);
            assert_true(high > low);
            wr_field_free(field);
            wr_field_free(column);
            wr_field_free(row);
        }
    wr_tip_free(tip);
}

static int distance_class(const WrCopy *a, const WrCopy *b, double x, double y)
{
    double dx = (a->a - b->a) * x + (a->b - b->b) * y + a->dx - b->dx;
    double dy = (a->c - b->c) * x + (a->d - b->d) * y + a->dy - b->dy;
    dx -= W * rint(dx / W);
    dy -= H * rint(dy / H);
    return dx * dx + dy * dy < 1e-12;
}

static void copies_are_isometries_all_different_and_the_first_is_the_stroke_itself(void **state)
{
    (void)state;
    static WrCopy copies[WR_COPIES_MAX];
    WrField *field = torus(W, H);
    const WrSymmetry cases[] = { { 0 },
                                 { .mirror_u = true, .centre_u = 0.3 },
                                 { .mirror_u = true, .mirror_v = true, .radial = 6 },
                                 { .mirror_v = true, .radial = 7, .centre_v = 0.1 },
                                 { .radial = 3, .repeat_u = 2, .repeat_v = 3, .stagger = 0.5 } };
    const int counts[] = { 1, 2, 12, 14, 18 };
    for (int k = 0; k < 4; k++) {
        int count = wr_symmetry_copies(&cases[k], field, copies);
        assert_int_equal(count, counts[k]);
        assert_true(copies[0].a == 1 && copies[0].b == 0 && copies[0].c == 0 && copies[0].d == 1 &&
                    copies[0].dx == 0 && copies[0].dy == 0 && !copies[0].flips);
        for (int i = 0; i < count; i++) {
            const WrCopy *c = &copies[i];
            assert_near(c->a * c->a + c->c * c->c, 1, 1e-14);
            assert_near(c->a * c->b + c->c * c->d, 0, 1e-14);
            assert_near(c->a * c->d - c->b * c->c, c->flips ? -1 : 1, 1e-14);
            for (int j = 0; j < i; j++) assert_false(distance_class(c, &copies[j], 17.3, 91.1));
        }
    }
    wr_field_free(field);
}

static void lattices_that_do_not_close_are_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    const WrSymmetry good[] = { { .repeat_u = 2, .stagger = 0.5 },
                                { .repeat_u = 3, .stagger = 1.0 / 3 },
                                { .radial = 360 },
                                { .repeat_u = 64, .repeat_v = 64 } };
    const WrSymmetry bad[] = { { .repeat_u = 3, .stagger = 0.5 },
                               { .stagger = 0.5 },
                               { .radial = 361 },
                               { .radial = -1 },
                               { .repeat_u = 65 },
                               { .stagger = 1 },
                               { .stagger = NAN },
                               { .centre_u = INFINITY },
                               { .repeat_v = -2 },
                               { .radial = 3, .repeat_u = 64, .repeat_v = 64 } };
    for (int k = 0; k < 4; k++) assert_true(wr_symmetry_check(&good[k], &err));
    for (int k = 0; k < 10; k++) {
        err.text[0] = 0;
        assert_false(wr_symmetry_check(&bad[k], &err));
        assert_true(strlen(err.text) > 10);
        WrField *field = torus(W, H);
        static WrCopy copies[WR_COPIES_MAX];
        assert_int_equal(wr_symmetry_copies(&bad[k], field, copies), 1);
        wr_field_free(field);
    }
}

/* The tip is mirrored in a mirrored copy and rotated in a rotated one. */
static void tips_are_mirrored_and_turned_with_their_copies(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    WrField *field = torus(W, H);
    WrBrush brush = brush_of(WR_BRUSH_RAISE, 15);
    brush.tip = tip;
    brush.angle_deg = 20;
    brush.symmetry =
        (WrSymmetry){ .mirror_u = true, .radial = 2, .centre_u = 0.5, .centre_v = 0.5 };
    wr_brush_dab(field, &brush, 0.2, 0.3);
    int painted = 0;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            float f = wr_field_get(field, i, j);
            painted += f > 0;
            assert_true(f == wr_field_get(field, W - 1 - i, j));
            assert_true(f == wr_field_get(field, W - 1 - i, H - 1 - j));
        }
    assert_true(painted > 400);
    wr_field_free(field);
    wr_tip_free(tip);
}

static void nothing_is_painted_over_the_ends_of_clamped_axes(void **state)
{
    (void)state;
    WrTip *tip = arrow_tip();
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++)
        for (int way = 0; way < WAY_COUNT; way++) {
            WrField *field = rough(W, H, WR_WRAP_CLAMP), *before = wr_field_share(field);
            WrBrush brush = brush_by(way, brush_of((WrBrushMode)mode, 9), tip);
            WrSample right[] = { at(0.97, 0.5, 1), at(1.4, 0.55, 1), at(1e9, 1e9, 1),
                                 at(1.5, 1e6, 1), at(1.2, 0.4, 1) };
            run_stroke(field, &brush, right, 5);
            int changed = 0;
            for (int j = 0; j < H; j++)
                for (int i = 0; i < W; i++) {
                    bool same = wr_field_get(field, i, j) == wr_field_get(before, i, j);
                    changed += !same;
                    if (i < 100 && j > 20) assert_true(same);
                }
            assert_true(changed > 10 || mode == WR_BRUSH_CUT || mode == WR_BRUSH_LIFT);
            wr_field_free(field);
            wr_field_free(before);
        }
    wr_tip_free(tip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bits_do_not_depend_on_how_the_work_is_cut),
        cmocka_unit_test(an_abandoned_stroke_draws_nothing_more),
        cmocka_unit_test(a_large_stroke_is_the_largest_of_its_motions),
        cmocka_unit_test(a_large_stroke_does_not_depend_on_what_is_added_together),
        cmocka_unit_test(several_threads_give_the_same_bits),
        cmocka_unit_test(every_set_of_kernels_gives_the_same_bits),
        cmocka_unit_test(the_short_way_of_circles_gives_the_bits_of_the_long_one),
        cmocka_unit_test(the_joined_kernel_does_what_its_two_parts_do),
        cmocka_unit_test(what_is_painted_with_a_mirror_is_its_own_mirror_image),
        cmocka_unit_test(quarter_turns_are_exact),
        cmocka_unit_test(repeats_by_whole_texels_are_rolled_bit_for_bit),
        cmocka_unit_test(copies_are_isometries_all_different_and_the_first_is_the_stroke_itself),
        cmocka_unit_test(lattices_that_do_not_close_are_refused),
        cmocka_unit_test(tips_are_mirrored_and_turned_with_their_copies),
        cmocka_unit_test(nothing_is_painted_over_the_ends_of_clamped_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
