/* test_fused_fetches.c - table and texture fetches of fused kernels, against the stages in the plain C of "ref". */
#include "fused_help.h"
#include "field/scheme_list.h"

#include "render/textures/slope_pyramid.h"

/* A colour texture, shown once and tiled, with single values. */
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

/* Slopes of a table, in the same ways; not for requests with heights, clamped axes, and positions in double. */
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

/* ---- filtered slopes ---- */

/* Mip levels of unrelated numbers, with unrelated aprons. */
static WrPyramid some_pyramid(TestRandom *random, int width, int height)
{
    WrPyramid pyramid = { 0 };
    assert_true(wr_pyramid_allocate(&pyramid, WR_PYRAMID_SLOPES, width, height, NULL));
    for (int l = 1; l < pyramid.levels; l++) {
        const WrPyramidLevel *at = &pyramid.level[l];
        for (int i = 0; i < 4 * at->pitch * (at->height + 2); i++)
            at->data[i] = between(random, -2, 2);
    }
    return pyramid;
}

static void same_level(const WrStrip *got, int i, const WrStrip *want, int k, const char *set)
{
    if (off_by(got->level[i], want->level[k]) > FAST_BOUND)
        fail_msg("%s: level %.9g, not %.9g", set, (double)got->level[i], (double)want->level[k]);
}

/* Pixels of many sizes, texels of any shape; the number above level 0 is returned. */
static void footprints_are_those_of_the_stages(void **state)
{
    (void)state;
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    Sets sets;
    for (int i = 0; set_of(i, &sets); i++) {
        TestRandom random = { 17 };
        int levels[2] = { 0, 0 };
        for (int round = 0; sets.wide && round < 500; round++) {
            const Scenery s = some_scenery(&random);
            const int w = 2 + (int)(900 * test_random(&random));
            const int h = 2 + (int)(900 * test_random(&random));
            const WrPyramid sizes = { .kind = WR_PYRAMID_SLOPES, .levels = 3 + round % 8 };
            const WrLook look = { .width = w,
                                  .height = h,
                                  .ru = between(&random, 0.2, 3),
                                  .rv = between(&random, -3, 3),
                                  .pyramid = &sizes };
            const float gx = (float)(int)(400 * test_random(&random));
            const float gy = (float)(int)(500 * test_random(&random));
            const int count = 1 + (int)(WR_SPAN * test_random(&random));
            int above = 0;
            met_by_stages(&sets, &s, gx, gy, count, want);
            if (!sets.wide->sphere(NULL, &s.rays, &s.shape, gx, gy, count, true, got)) continue;
            if (got->count == 0) continue;
            for (int k = 0; k < want->count; k++)
                want->x[k] = gx + (float)want->index[k], want->y[k] = gy;
            sets.ref->footprint(&s.rays, &look, 1, want);
            sets.ref->spread(&look, false, want);
            const int told = sets.wide->footprint(&s.rays, &s.shape, &look, gx, gy, got);
            for (int k = 0; k < got->count; k++) above += got->level[k] > 0;
            assert_int_equal(told, above);
            levels[above > 0] += compare(&s, got, want, sets.name, same_level);
        }
        if (sets.wide) assert_true(levels[0] > 3000 && levels[1] > 3000);
    }
    wr_free(got);
    wr_free(want);
}

/* Result of the stages: from the table, the pyramid, or both. */
static void filtered_by_stages(const Sets *sets, const WrLook *look, WrStrip *far, WrStrip *strip)
{
    *far = *strip;
    sets->ref->look[WR_SCHEME_CENTRAL](look, strip);
    sets->ref->look_pyramid(look, false, far);
    for (int k = 0; k < strip->count; k++) {
        const float part = fminf(strip->level[k], 1);
        strip->fu[k] += part * (far->fu[k] - strip->fu[k]);
        strip->fv[k] += part * (far->fv[k] - strip->fv[k]);
    }
}

static void filtered_slopes_are_those_of_the_stages(void **state)
{
    (void)state;
    const int w = 29, h = 46, pitch = w + 2 * WR_APRON + 1;
    float *gradient = wr_alloc((size_t)(pitch * (h + 2 * WR_APRON)), 2 * sizeof *gradient);
    WrStrip *got = wr_alloc(1, sizeof *got), *want = wr_alloc(1, sizeof *want);
    WrStrip *far = wr_alloc(1, sizeof *far);
    TestRandom random = { 23 };
    WrPyramid pyramid = some_pyramid(&random, w, h);
    Sets sets;
    for (int i = 0; i < 2 * pitch * (h + 2 * WR_APRON); i++) gradient[i] = between(&random, -2, 2);
    for (int i = 0; set_of(i, &sets); i++)
        for (int round = 0; sets.wide && round < 60; round++) {
            WrLook look = { .gradient = gradient,
                            .pitch = pitch,
                            .width = w,
                            .height = h,
                            .ru = 1 + round % 3,
                            .rv = 1 + round % 2,
                            .periodic_u = round % 5 != 4,
                            .periodic_v = round % 7 != 6,
                            .scale_f = 1,
                            .scale_u = 1.3f,
                            .scale_v = 0.7f,
                            .reach = round % 9 == 8 ? 3 : 0,
                            .pyramid = &pyramid };
            const bool can = look.periodic_u && look.periodic_v && look.reach == 0;
            assert_true(sets.wide->filters(&look) == can);
            if (!can) continue;
            want->count = 1 + (int)(WR_SPAN * test_random(&random));
            for (int k = 0; k < want->count; k++) {
                const bool level = (k / 7 + round) % 3 == 0;
                want->u[k] = between(&random, 0, 1), want->v[k] = between(&random, 0, 1);
                want->level[k] = level ? 0 : between(&random, 0, pyramid.levels - 1);
            }
            want->u[0] = 0, want->v[0] = 1;
            want->level[want->count / 2] = (float)(pyramid.levels - 1);
            want->level[want->count / 3] = 1;
            *got = *want;
            sets.wide->filtered(&look, got);
            filtered_by_stages(&sets, &look, far, want);
            for (int k = 0; k < want->count; k++) {
                assert_near(off_by(got->fu[k], want->fu[k]), 0, FAST_BOUND);
                assert_near(off_by(got->fv[k], want->fv[k]), 0, FAST_BOUND);
                assert_true(got->tu[k] == want->tu[k] && got->tv[k] == want->tv[k]);
            }
        }
    wr_pyramid_drop(&pyramid);
    wr_free(gradient);
    wr_free(got);
    wr_free(want);
    wr_free(far);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_are_those_of_the_stages),
        cmocka_unit_test(slopes_are_those_of_the_stages),
        cmocka_unit_test(footprints_are_those_of_the_stages),
        cmocka_unit_test(filtered_slopes_are_those_of_the_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
