/* test_fused_kernels.c - fused kernels against the separate stages in the plain C of "ref": codes are equal, other values
   within the bound of fast arithmetic. Fetches of tables and textures: test_fused_fetches.c. */
#include "fused_help.h"

#include "render/frame/pixel_encode.h"

/* ---- codes ---- */

/* grey: the other channels are undefined. */
static void expect_codes(const Sets *sets, const uint32_t *bins, WrStrip *strip, bool grey)
{
    uint32_t want[WR_SPAN], got[WR_SPAN + 1];
    got[strip->count] = 0x12345678U;
    const int odd = sets->ref->codes(bins, strip, want);
    for (int i = 0; i < strip->count && grey; i++) strip->cg[i] = NAN, strip->cb[i] = 0.5f;
    assert_int_equal(sets->wide->codes(bins, strip, grey, got), odd);
    for (int i = 0; i < strip->count; i++)
        if (got[i] != want[i])
            fail_msg("%s: %.9g %.9g %.9g is %08x, not %08x", sets->name, (double)strip->cr[i],
                     (double)strip->cg[i], (double)strip->cb[i], got[i], want[i]);
    assert_true(got[strip->count] == 0x12345678U);
}

/* A number near a border, anywhere, beyond both ends, or NaN. */
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

static void same_parameters(const WrStrip *got, int i, const WrStrip *want, int k, const char *set)
{
    const double flat = hypot(want->nx[k], want->ny[k]);
    if (off_by(got->v[i], want->v[k]) > FAST_BOUND)
        fail_msg("%s: v is %.9g, not %.9g", set, (double)got->v[i], (double)want->v[k]);
    if (turns_off(got->u[i], want->u[k]) * flat > 1e-5 || got->u[i] < 0 || got->u[i] >= 1)
        fail_msg("%s: u is %.9g, not %.9g", set, (double)got->u[i], (double)want->u[k]);
}

static void same_place(const WrStrip *got, int i, const WrStrip *want, int k, const char *set)
{
    const float *const a[] = { got->px, got->py, got->pz, got->nx, got->ny, got->nz };
    const float *const b[] = { want->px, want->py, want->pz, want->nx, want->ny, want->nz };
    for (int c = 0; c < 6; c++)
        if (off_by(a[c][i], b[c][k]) > FAST_BOUND)
            fail_msg("%s: number %d is %.9g, not %.9g", set, c, (double)a[c][i], (double)b[c][k]);
    same_parameters(got, i, want, k, set);
}

/* Equal values for equal samples, at any position in the strip. */
static void give_picture(WrStrip *strip)
{
    for (int k = 0; k < strip->count; k++) {
        const float x = (float)strip->index[k];
        strip->cr[k] = 0.5f + 0.5f * sinf(x), strip->cg[k] = 0.5f + 0.5f * sinf(3 * x + 1);
        strip->cb[k] = 0.5f + 0.5f * sinf(7 * x + 2);
    }
}

/* Level ones, and some steeper than any surface. */
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

/* Rows of many views: points, lighting of smooth and of bent normals. */
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
            WrSphereRows ball;
            wr_sphere_rows_make(&ball, &s.rays, &s.shape, light);
            if (!sets.wide->sphere(round & 1 ? &ball : NULL, &s.rays, &s.shape, gx, gy, count, true,
                                   got))
                continue;
            sets.wide->points(&s.shape, got);
            places += compare(&s, got, want, sets.name, same_place);
            give_slopes(round, want);
            give_slopes(round, got);
            const bool near = s.rays.perspective, pictured = round & 2;
            for (int way = 0; way < 2; way++) { /* bent, and unchanged */
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

/* An integer exponent, however small, and a distant light. */
static void make_broad(TestRandom *random, Scenery *s)
{
    s->light.point = false;
    put3(s->light.where, some_unit(random));
    s->shine.shininess = floorf(between(random, 1, test_random(random) < 0.5 ? 20 : 140));
}

/* Result if the red channel suffices, and if a texture's colours are multiplied in. */
static void expect_smooth(const Sets *sets, const Scenery *s, const WrSphereRows *ball, float gx,
                          float gy, int count, const WrStrip *want, WrStrip *got)
{
    WrStrip *all = wr_alloc(1, sizeof *all);
    bool dark;
    *all = *got;
    assert_true(sets->wide->smooth(ball, &s->rays, &s->light, &s->shine, &s->material, gx, gy,
                                   count, WR_WIDE_RED, &dark, got));
    assert_memory_equal(got->index, all->index, (size_t)all->count * sizeof *all->index);
    for (int k = 0; k < all->count; k++) assert_true(got->cr[k] == all->cr[k]);
    assert_true(sets->wide->smooth(ball, &s->rays, &s->light, &s->shine, &s->material, gx, gy,
                                   count, WR_WIDE_LATER, &dark, got));
    for (int k = 0; k < got->count; k++) got->cr[k] = got->cg[k] = got->cb[k] = 1;
    sets->wide->paint(&s->rays, &s->light, &s->shine, &s->material, got);
    compare(s, got, want, sets->name, same_colour);
    compare(s, got, want, sets->name, same_parameters);
    wr_free(all);
}

/* Everything in one pass, from the ray to the colour. */
static void smooth_spheres_are_those_of_the_stages(void **state)
{
    (void)state;
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    Sets sets;
    for (int i = 0; set_of(i, &sets); i++) {
        TestRandom random = { 31 };
        int done = 0, darks = 0;
        for (int round = 0; sets.wide && round < 700; round++) {
            Scenery s = some_scenery(&random);
            make_broad(&random, &s);
            const float gx = (float)(int)(400 * test_random(&random));
            const float gy = (float)(int)(500 * test_random(&random));
            const int count = 1 + (int)(WR_SPAN * test_random(&random));
            WrSphereRows ball;
            bool dark;
            wr_sphere_rows_make(&ball, &s.rays, &s.shape, &s.light);
            met_by_stages(&sets, &s, gx, gy, count, want);
            sets.ref->bump[WR_BUMP_NONE](&s.rays, want);
            sets.ref->shade[0][s.rays.perspective][1][0](&s.rays, &s.light, &s.shine, &s.material,
                                                         want);
            if (!sets.wide->smooth(&ball, &s.rays, &s.light, &s.shine, &s.material, gx, gy, count,
                                   WR_WIDE_ALL, &dark, got)) {
                assert_true(!ball.shown || s.shine.shininess > 128.0f);
                continue;
            }
            assert_true(ball.shown && s.shine.shininess <= 128.0f);
            done += compare(&s, got, want, sets.name, same_colour);
            darks += dark && got->count > 0;
            for (int k = 0; k < want->count && dark; k++) assert_true(is_behind(&s.light, want, k));
            expect_smooth(&sets, &s, &ball, gx, gy, count, want, got);
        }
        if (sets.wide) assert_true(done > 20000 && darks > 20);
    }
    wr_free(got);
    wr_free(want);
}

/* Lighting alone, from any n' and P. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_are_those_of_the_table),
        cmocka_unit_test(spheres_are_those_of_the_stages),
        cmocka_unit_test(smooth_spheres_are_those_of_the_stages),
        cmocka_unit_test(one_lamp_is_that_of_the_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
