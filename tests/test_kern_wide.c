/* test_kern_wide.c - the kernels of several stages at once against the stages themselves, in the plain C of "ref": codes are
   the same, all else is within the bound of fast arithmetic. */
#include "test.h"

#include "base/kernmath.h"
#include "base/memory.h"
#include "base/vec.h"
#include "render/kern.h"
#include "render/kern_wide.h"
#include "render/srgb_codes.h"

#define FAST_BOUND 2e-4 /* scene/dials.h: of 1, or of the value if that is larger */

typedef struct Sets {
    const WrKernels *ref;
    const WrWide *wide;
    const char *name;
} Sets;

/* Set i of those that this processor has; false: no more, or not that one (name NULL). */
static bool set_of(int i, Sets *sets)
{
    const char *const names[] = { "v3", "v4" };
    if (i >= 2) return false;
    const WrKernels *fast = wr_kernels_get(names[i], true, NULL);
    *sets = (Sets){ wr_kernels_get("ref", false, NULL), fast ? wr_wide_of(fast) : NULL, names[i] };
    return true;
}

static float between(TestRandom *random, double low, double high)
{
    return (float)(low + (high - low) * test_random(random));
}

static double off_by(double got, double want)
{
    return fabs(got - want) / fmax(fabs(want), 1);
}

/* ---- codes ---- */

static void expect_codes(const Sets *sets, const uint32_t *bins, const WrStrip *strip, bool grey)
{
    uint32_t want[WR_SPAN], got[WR_SPAN + 1];
    got[strip->count] = 0x12345678U;
    const int odd = sets->ref->codes(bins, strip, want);
    assert_int_equal(sets->wide->codes(bins, strip, grey, got), odd);
    for (int i = 0; i < strip->count; i++)
        if (got[i] != want[i])
            fail_msg("%s: %.9g %.9g %.9g is %08x, not %08x", sets->name, (double)strip->cr[i],
                     (double)strip->cg[i], (double)strip->cb[i], got[i], want[i]);
    assert_true(got[strip->count] == 0x12345678U);
}

/* A number near a border, anywhere, beyond both ends, or none. */
static float some_light(TestRandom *random, int kind)
{
    const int border = 1 + (int)(255 * test_random(random));
    const float at = wr_srgb_borders[border];
    const int32_t ulps = (int32_t)(9 * test_random(random)) - 4;
    if (kind < 5) return wr_bits_float(wr_float_bits(at) + ulps);
    if (kind < 7) return at * between(random, 1 - 4e-6, 1 + 4e-6);
    if (kind < 10) return (float)exp2(-14 * test_random(random));
    if (kind < 11) return between(random, -1, 2);
    if (kind < 12) return between(random, 0.0031, 0.0032);
    return (float[4]){ NAN, INFINITY, -INFINITY, 0 }[(int)(4 * test_random(random))];
}

static void codes_are_those_of_the_table(void **state)
{
    (void)state;
    static uint32_t bins[WR_CODE_BINS + 1];
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    Sets sets;
    wr_code_bins_fill(bins);
    assert_null(wr_wide_codes_of(wr_kernels_get("ref", false, NULL)));
    for (int s = 0; set_of(s, &sets); s++) {
        TestRandom random = { 11 };
        const WrKernels *exact = wr_kernels_get(sets.name, false, NULL);
        if (sets.wide) assert_true(wr_wide_codes_of(exact) == sets.wide->codes);
        for (int round = 0; sets.wide && round < 600; round++) {
            const bool grey = round % 3 == 0;
            strip->count = 1 + (int)(WR_SPAN * test_random(&random));
            for (int i = 0; i < strip->count; i++) {
                const int kinds = round % 2 ? 12 : 13;
                strip->cr[i] = some_light(&random, (int)(kinds * test_random(&random)));
                strip->cg[i] = some_light(&random, (int)(kinds * test_random(&random)));
                strip->cb[i] = some_light(&random, (int)(kinds * test_random(&random)));
                if (grey) strip->cg[i] = strip->cb[i] = strip->cr[i];
            }
            expect_codes(&sets, bins, strip, grey);
        }
    }
    wr_free(strip);
}

/* ---- spheres ---- */

typedef struct Scenery {
    WrRays rays;
    WrShapef shape;
    WrKernLight light;
    WrKernShine shine;
    WrKernMaterial material;
} Scenery;

static WrVec3 some_unit(TestRandom *random)
{
    const WrVec3 a = { between(random, -1, 1), between(random, -1, 1), between(random, -1, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

static void put3(float to[3], WrVec3 a)
{
    to[0] = (float)a.x, to[1] = (float)a.y, to[2] = (float)a.z;
}

/* A ball from anywhere outside, some 100 samples wide or much more. */
static Scenery some_scenery(TestRandom *random)
{
    Scenery s = { .shine = { between(random, 0.05, 1), between(random, 15, 300),
                             test_random(random) < 0.5 } };
    WrShape shape;
    wr_shape_default(WR_SURFACE_sphere, &shape);
    shape.value[0] = between(random, 0.6, 1.7);
    wr_shape_scaled(&shape, 1, &s.shape);
    const double R = shape.value[0], away = R * (1.2 + 6 * test_random(random));
    const WrVec3 back = some_unit(random), eye = v3_scale(back, away);
    const WrVec3 right = v3_unit(v3_cross(some_unit(random), back), (WrVec3){ 1, 0, 0 });
    const WrVec3 up = v3_cross(back, right);
    const double half = 1.3 * R, step = 2 * half / (90 + 900 * test_random(random));
    const WrVec3 corner = v3_mad(v3_scale(right, -half), up, half);
    s.rays.perspective = test_random(random) < 0.7;
    put3(s.rays.eye, eye), put3(s.rays.toward, back);
    put3(s.rays.q0, corner);
    put3(s.rays.qx, v3_scale(right, step)), put3(s.rays.qy, v3_scale(up, -step));
    put3(s.rays.d0, v3_scale(back, -1));
    s.rays.s_min = (float)(-away + 0.01 * R);
    if (test_random(random) < 0.1) s.rays.s_min = (float)(-0.8 * R); /* the near plane cuts it */
    if (s.rays.perspective) { /* through the eye: q - eye = away d */
        put3(s.rays.d0, v3_scale(v3_sub(corner, eye), 1 / away));
        put3(s.rays.dx, v3_scale(right, step / away));
        put3(s.rays.dy, v3_scale(up, -step / away));
    }
    s.light.point = test_random(random) < 0.4;
    put3(s.light.where, v3_scale(some_unit(random), s.light.point ? R * 3 : 1));
    s.material = (WrKernMaterial){ between(random, 0, 0.3), between(random, 0, 1), { 1, 1, 1 } };
    const float strength = test_random(random) < 0.3 ? 40.0f : 1.0f;
    const bool grey = test_random(random) < 0.3;
    for (int c = 0; c < 3; c++) {
        s.light.rgb[c] = grey ? strength : strength * between(random, 0.1, 1);
        if (!grey) s.material.rgb[c] = between(random, 0, 1);
    }
    return s;
}

/* The stages: what is met, and its frame. */
static void met_by_stages(const Sets *sets, const Scenery *s, float gx, float gy, int count,
                          WrStrip *strip)
{
    const WrRound *round = &sets->ref->round[WR_INVERT_SPHERE];
    round->hit(&s->rays, &s->shape, gx, gy, count, strip);
    round->params(&s->shape, strip);
    round->tangents(&s->shape, strip);
    round->normals(&s->shape, strip);
}

/* How far apart are they as turns? */
static double turns_off(double a, double b)
{
    const double d = fabs(a - b);
    return fmin(d, fabs(1 - d));
}

/* Nearly along the surface rounding tells whether it is met, and where. */
static bool is_grazing(const Scenery *s, const WrStrip *strip, int i)
{
    const WrVec3 p = { strip->px[i], strip->py[i], strip->pz[i] };
    const WrVec3 n = { strip->nx[i], strip->ny[i], strip->nz[i] };
    const WrVec3 eye = { s->rays.eye[0], s->rays.eye[1], s->rays.eye[2] };
    const WrVec3 toward = { s->rays.toward[0], s->rays.toward[1], s->rays.toward[2] };
    const WrVec3 v = s->rays.perspective ? v3_unit(v3_sub(eye, p), n) : toward;
    return v3_dot(n, v) < 0.03;
}

/* Walk the samples that both have; those that one alone has lie at the outline. Returns how many were compared. */
typedef void Compare(const WrStrip *got, int i, const WrStrip *want, int k, const char *set);

static int compare(const Scenery *s, const WrStrip *got, const WrStrip *want, const char *set,
                   Compare *each)
{
    int both = 0;
    for (int i = 0, k = 0; i < got->count || k < want->count;) {
        const int a = i < got->count ? got->index[i] : 1 << 20;
        const int b = k < want->count ? want->index[k] : 1 << 20;
        if (a == b && !is_grazing(s, want, k)) each(got, i, want, k, set), both++;
        if (b < a && !is_grazing(s, want, k)) fail_msg("%s: sample %d is not met", set, b);
        if (a < b && want->count > 0 && a > want->index[0] + 9 &&
            a < want->index[want->count - 1] - 9)
            fail_msg("%s: sample %d is met", set, a);
        i += a <= b, k += b <= a;
    }
    return both;
}

static void same_place(const WrStrip *got, int i, const WrStrip *want, int k, const char *set)
{
    const float *const a[] = { got->px, got->py, got->pz, got->nx, got->ny, got->nz, got->v };
    const float *const b[] = {
        want->px, want->py, want->pz, want->nx, want->ny, want->nz, want->v
    };
    const double flat = hypot(want->nx[k], want->ny[k]);
    for (int c = 0; c < 7; c++)
        if (off_by(a[c][i], b[c][k]) > FAST_BOUND)
            fail_msg("%s: number %d is %.9g, not %.9g", set, c, (double)a[c][i], (double)b[c][k]);
    if (turns_off(got->u[i], want->u[k]) * flat > 1e-5 || got->u[i] < 0 || got->u[i] >= 1)
        fail_msg("%s: u is %.9g, not %.9g", set, (double)got->u[i], (double)want->u[k]);
}

static void same_colour(const WrStrip *got, int i, const WrStrip *want, int k, const char *set)
{
    const float *const a[] = { got->cr, got->cg, got->cb }, *const b[] = { want->cr, want->cg,
                                                                           want->cb };
    for (int c = 0; c < 3; c++)
        if (off_by(a[c][i], b[c][k]) > 3 * FAST_BOUND) /* point, normal and light: three stages */
            fail_msg("%s: channel %d is %.9g, not %.9g", set, c, (double)a[c][i], (double)b[c][k]);
}

/* The same of the same sample, whatever its place in the strip. */
static void give_picture(WrStrip *strip)
{
    for (int k = 0; k < strip->count; k++) {
        const float x = (float)strip->index[k];
        strip->cr[k] = 0.5f + 0.5f * sinf(x), strip->cg[k] = 0.5f + 0.5f * sinf(3 * x + 1);
        strip->cb[k] = 0.5f + 0.5f * sinf(7 * x + 2);
    }
}

/* Level ones, and some that are steeper than any surface. */
static void give_slopes(int round, WrStrip *strip)
{
    for (int k = 0; k < strip->count; k++) {
        const float x = (float)strip->index[k] + (float)round;
        strip->fu[k] = round % 7 ? 2 * sinf(5 * x) : 0.0f;
        strip->fv[k] = 2 * sinf(11 * x) * (round % 11 == 3 ? 1e30f : 1.0f);
    }
}

static bool is_behind(const WrKernLight *light, const WrStrip *strip, int k)
{
    const float *where = light->where, from = light->point ? 1.0f : 0.0f;
    return strip->bx[k] * (where[0] - from * strip->px[k]) +
               strip->by[k] * (where[1] - from * strip->py[k]) +
               strip->bz[k] * (where[2] - from * strip->pz[k]) <
           1e-4f;
}

/* Rows of many views: points, light of smooth ones, and of bent ones. */
static void spheres_are_those_of_the_stages(void **state)
{
    (void)state;
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    Sets sets;
    for (int i = 0; set_of(i, &sets); i++) {
        TestRandom random = { 5 };
        int places = 0, lit[2] = { 0, 0 };
        for (int round = 0; sets.wide && round < 1500; round++) {
            const Scenery s = some_scenery(&random);
            const WrKernLight *light = &s.light;
            const float gx = (float)(int)(400 * test_random(&random));
            const float gy = (float)(int)(500 * test_random(&random));
            const int count = 1 + (int)(WR_SPAN * test_random(&random));
            bool dark;
            if (!sets.wide->narrow(light, &s.shine)) continue;
            met_by_stages(&sets, &s, gx, gy, count, want);
            if (!sets.wide->sphere(&s.rays, &s.shape, gx, gy, count, true, got)) continue;
            sets.wide->points(&s.shape, got);
            places += compare(&s, got, want, sets.name, same_place);
            give_slopes(round, want);
            give_slopes(round, got);
            const bool near = s.rays.perspective, pictured = round & 1;
            for (int way = 0; way < 2; way++) { /* bent, and as it is */
                give_picture(got), give_picture(want);
                sets.ref->bump[way ? WR_BUMP_NONE : WR_BUMP_BLINN](&s.rays, want);
                sets.ref->shade[light->point][near][1][pictured](&s.rays, light, &s.shine,
                                                                 &s.material, want);
                if (!sets.wide->sphere_light(&s.rays, &s.shape, light, &s.shine, &s.material, gx,
                                             gy, pictured, !way, &dark, got)) {
                    assert_true(!way && round % 11 == 3); /* too steep */
                    continue;
                }
                lit[way] += compare(&s, got, want, sets.name, same_colour);
                for (int k = 0; k < want->count && dark; k++)
                    assert_true(is_behind(light, want, k));
            }
        }
        if (sets.wide) assert_true(places > 20000 && lit[0] > 20000 && lit[1] > 20000);
    }
    wr_free(got);
    wr_free(want);
}

/* The light alone, from any n' and P. */
static void one_lamp_is_that_of_the_stages(void **state)
{
    (void)state;
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    Sets sets;
    for (int i = 0; set_of(i, &sets); i++) {
        TestRandom random = { 9 };
        int done = 0;
        for (int round = 0; sets.wide && round < 400; round++) {
            const Scenery s = some_scenery(&random);
            const bool pictured = round & 1;
            want->count = 1 + (int)(WR_SPAN * test_random(&random));
            for (int k = 0; k < WR_SPAN; k++) {
                const WrVec3 n = some_unit(&random), p = v3_scale(some_unit(&random), 0.9);
                want->bx[k] = (float)n.x, want->by[k] = (float)n.y, want->bz[k] = (float)n.z;
                want->px[k] = (float)p.x, want->py[k] = (float)p.y, want->pz[k] = (float)p.z;
                want->cr[k] = between(&random, 0, 1), want->cg[k] = between(&random, 0, 1);
                want->cb[k] = between(&random, 0, 1);
            }
            *got = *want;
            if (!sets.wide->shade(&s.rays, &s.light, &s.shine, &s.material, pictured, got))
                continue;
            sets.ref->shade[s.light.point][s.rays.perspective][1][pictured](
                &s.rays, &s.light, &s.shine, &s.material, want);
            for (int k = 0; k < want->count; k++, done++) same_colour(got, k, want, k, sets.name);
        }
        if (sets.wide) assert_true(done > 20000);
    }
    wr_free(got);
    wr_free(want);
}

/* A colour picture, seen once and several times, in single numbers. */
static void colours_are_those_of_the_stages(void **state)
{
    (void)state;
    const int w = 23, h = 14, pitch = w + 2;
    float *rgba = wr_alloc((size_t)(pitch * (h + 2)), 4 * sizeof *rgba);
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    TestRandom random = { 4 };
    Sets sets;
    for (int i = 0; i < 4 * pitch * (h + 2); i++) rgba[i] = between(&random, 0, 1);
    for (int i = 0; set_of(i, &sets); i++)
        for (int round = 0; sets.wide && round < 40; round++) {
            const double more = round % 3;
            const WrColourLook look = { rgba,           pitch,         w, h, 1 + more, 1 + 2 * more,
                                        round % 5 != 4, round % 7 != 6 };
            want->count = 1 + (int)(WR_SPAN * test_random(&random));
            for (int k = 0; k < want->count; k++) {
                want->u[k] = between(&random, 0, 1), want->v[k] = between(&random, 0, 1);
            }
            want->u[0] = 0, want->v[0] = 1;
            *got = *want;
            assert_true(sets.wide->colour(&look, got) == (look.periodic_u && look.periodic_v));
            sets.ref->colour(&look, want);
            for (int k = 0; k < want->count && look.periodic_u && look.periodic_v; k++)
                same_colour(got, k, want, k, sets.name);
        }
    wr_free(rgba);
    wr_free(got);
    wr_free(want);
}

/* Slopes of a table, likewise; heights that are wanted too, axes that end, and places in double are not for these. */
static void slopes_are_those_of_the_stages(void **state)
{
    (void)state;
    const int w = 19, h = 31, pitch = w + 2 * WR_APRON + 3;
    float *gradient = wr_alloc((size_t)(pitch * (h + 2 * WR_APRON)), 2 * sizeof *gradient);
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    TestRandom random = { 4 };
    Sets sets;
    for (int i = 0; i < 2 * pitch * (h + 2 * WR_APRON); i++) gradient[i] = between(&random, -2, 2);
    for (int i = 0; set_of(i, &sets); i++)
        for (int round = 0; sets.wide && round < 40; round++) {
            const WrLook look = { .heights = round % 9 == 8 ? gradient : NULL,
                                  .gradient = gradient,
                                  .pitch = pitch,
                                  .width = w,
                                  .height = h,
                                  .ru = 1 + round % 3,
                                  .rv = 1 + round % 2,
                                  .periodic_u = round % 5 != 4,
                                  .periodic_v = round % 7 != 6,
                                  .wide = round % 11 == 10,
                                  .scale_f = 1,
                                  .scale_u = 1.3f,
                                  .scale_v = round == 20 ? 3e38f : 0.7f };
            const bool can = look.periodic_u && look.periodic_v && !look.wide && !look.heights;
            want->count = 1 + (int)(WR_SPAN * test_random(&random));
            for (int k = 0; k < want->count; k++) {
                want->u[k] = between(&random, 0, 1), want->v[k] = between(&random, 0, 1);
            }
            want->u[0] = 0, want->v[0] = 1;
            *got = *want;
            assert_true(sets.wide->central(&look, true, got) == can);
            sets.ref->look[WR_SCHEME_CENTRAL](&look, want);
            for (int k = 0; k < want->count && can; k++) {
                assert_near(off_by(got->fu[k], want->fu[k]), 0, FAST_BOUND);
                assert_near(off_by(got->fv[k], want->fv[k]), 0, FAST_BOUND);
                assert_true(got->tu[k] == want->tu[k] && got->tv[k] == want->tv[k]);
            }
        }
    wr_free(gradient);
    wr_free(got);
    wr_free(want);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_are_those_of_the_table),
        cmocka_unit_test(spheres_are_those_of_the_stages),
        cmocka_unit_test(one_lamp_is_that_of_the_stages),
        cmocka_unit_test(colours_are_those_of_the_stages),
        cmocka_unit_test(slopes_are_those_of_the_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
