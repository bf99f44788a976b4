/* Relief over a normal map: the combined normal against rotations and against displaced surfaces, neither of which
   shares a formula with it. */
#include "test.h"

#include "base/vec.h"
#include "shade/bump.h"

#define TURN 57.29577951308232 /* degrees per radian */

static WrVec3 random_vector(TestRandom *random)
{
    return (WrVec3){ 2 * test_random(random) - 1, 2 * test_random(random) - 1,
                     2 * test_random(random) - 1 };
}

static WrVec3 unit(WrVec3 a)
{
    return v3_scale(a, 1 / v3_len(a));
}

static double apart(WrVec3 a, WrVec3 b)
{
    return v3_len(v3_sub(unit(a), unit(b)));
}

/* n, and a gradient across it of any steepness up to `most`. */
static WrVec3 random_gradient(TestRandom *random, WrVec3 n, double most)
{
    const WrVec3 a = random_vector(random);
    const WrVec3 across = unit(v3_mad(a, n, -v3_dot(a, n)));
    return v3_scale(across, most * test_random(random));
}

/* The vector turned about a unit axis (Rodrigues). */
static WrVec3 turned(WrVec3 a, WrVec3 axis, double angle)
{
    const WrVec3 aside = v3_scale(v3_cross(axis, a), sin(angle));
    const WrVec3 along = v3_scale(axis, v3_dot(axis, a) * (1 - cos(angle)));
    return v3_add(v3_mad(along, a, cos(angle)), aside);
}

static void a_flat_relief_or_a_flat_map_leaves_the_other(void **state)
{
    const WrVec3 zero = { 0, 0, 0 };
    TestRandom random = { 7 };
    (void)state;
    for (int i = 0; i < 3000; i++) {
        const WrVec3 n = unit(random_vector(&random));
        const WrVec3 g = random_gradient(&random, n, pow(10, 6 * test_random(&random) - 3));
        for (int c = 0; c < WR_COMBINE_COUNT; c++) {
            const WrVec3 alone = v3_sub(n, g), map = wr_bump_combined((WrCombine)c, n, g, zero);
            assert_true(memcmp(&map, &alone, sizeof map) == 0);
            assert_true(apart(wr_bump_combined((WrCombine)c, n, zero, g), alone) < 1e-15);
        }
    }
}

/* Barre-Brisebois and Hill: t = n1 + (0,0,1), u = (-x2, -y2, z2), r = t (t.u) / t_z - u, which is unit; and the
   rotation itself, about n x m by the angle between them. */
static void reoriented_is_the_rotation_of_the_relief(void **state)
{
    TestRandom random = { 11 };
    (void)state;
    for (int i = 0; i < 5000; i++) {
        const WrVec3 up = { 0, 0, 1 };
        const WrVec3 n = i % 2 ? up : unit(random_vector(&random));
        const WrVec3 g = random_gradient(&random, n, i % 3 ? 1.5 : 30);
        const WrVec3 b = random_gradient(&random, n, i % 5 ? 0.7 : 8);
        const WrVec3 m = unit(v3_sub(n, g)), d = unit(v3_sub(n, b));
        const WrVec3 got = unit(wr_bump_combined(WR_COMBINE_REORIENTED, n, g, b));
        const WrVec3 axis = v3_cross(n, m);
        const double sine = v3_len(axis);
        if (sine > 1e-9)
            assert_true(apart(got, turned(d, unit(axis), atan2(sine, v3_dot(n, m)))) < 1e-11);
        if (i % 2 == 0) continue;
        const WrVec3 t = v3_add(m, up), u = { -d.x, -d.y, d.z };
        const WrVec3 r = v3_sub(v3_scale(t, v3_dot(t, u) / t.z), u);
        assert_near(v3_len(r), 1, 1e-12);
        assert_true(v3_len(v3_sub(got, r)) < 1e-11);
    }
}

/* Slopes of 1/2 on 1/2 along one axis: 2 atan(1/2) turned, 45 degrees added; on the plane tilted by 1/2 the relief's
   slope is 1/2 cos(atan(1/2)). */
static void half_on_half(void **state)
{
    const WrVec3 n = { 0, 0, 1 }, half = { -0.5, 0, 0 };
    const double tilt = atan(0.5);
    const double want[] = { atan(1), 2 * tilt, tilt + atan(0.5 * cos(tilt)) };
    (void)state;
    for (int c = 0; c < WR_COMBINE_COUNT; c++) {
        const WrVec3 r = wr_bump_combined((WrCombine)c, n, half, half);
        assert_near(atan2(r.x, r.z) * TURN, want[c] * TURN, 1e-12);
    }
    assert_near(want[1] * TURN, 53.13010235415598, 1e-12);
}

/* ---- displaced surfaces ---- */

/* Heights by u and v: waves of four directions, of the given slope at most each. */
typedef struct Waves {
    double slope, k[4][2], phase[4];
} Waves;

static Waves random_waves(TestRandom *random, double slope, double frequency)
{
    Waves waves = { .slope = slope };
    for (int i = 0; i < 4; i++) {
        const double angle = 6.283185307179586 * test_random(random);
        const double k = frequency * (0.7 + 0.6 * test_random(random));
        waves.k[i][0] = k * cos(angle), waves.k[i][1] = k * sin(angle);
        waves.phase[i] = 6.283185307179586 * test_random(random);
    }
    return waves;
}

static double waves_at(const Waves *waves, double u, double v, double *hu, double *hv)
{
    double h = 0;
    *hu = *hv = 0;
    for (int i = 0; i < 4; i++) {
        const double *k = waves->k[i], by = waves->slope / hypot(k[0], k[1]);
        const double x = k[0] * u + k[1] * v + waves->phase[i];
        h += by * sin(x);
        *hu += by * k[0] * cos(x), *hv += by * k[1] * cos(x);
    }
    return h;
}

/* The detailed surface over the simple one, which is the plane z = 0 with u = x, v = y. */
typedef struct Detailed {
    WrVec3 p, pu, pv, m, mu, mv; /* point, unit normal and their derivatives */
} Detailed;

static Detailed on_tilted_plane(double a, double b, double u, double v)
{
    const WrVec3 none = { 0, 0, 0 };
    return (Detailed){ { u, v, a * u + b * v },     { 1, 0, a }, { 0, 1, b },
                       unit((WrVec3){ -a, -b, 1 }), none,        none };
}

static Detailed on_ball(double u, double v)
{
    const double z = sqrt(1 - u * u - v * v);
    const WrVec3 p = { u, v, z }, pu = { 1, 0, -u / z }, pv = { 0, 1, -v / z };
    return (Detailed){ p, pu, pv, p, pu, pv };
}

/* Normal of p + h m, or of p + h (0,0,1). */
static WrVec3 displaced(const Detailed *at, bool along_base, const Waves *waves, double u, double v)
{
    const WrVec3 none = { 0, 0, 0 }, up = { 0, 0, 1 };
    double hu, hv;
    const double h = waves_at(waves, u, v, &hu, &hv);
    const WrVec3 m = along_base ? up : at->m;
    const WrVec3 tu = v3_mad(v3_mad(at->pu, m, hu), along_base ? none : at->mu, h);
    const WrVec3 tv = v3_mad(v3_mad(at->pv, m, hv), along_base ? none : at->mv, h);
    return unit(v3_cross(tu, tv));
}

static WrVec3 combined(WrCombine combine, const Detailed *at, const Waves *waves, double u,
                       double v)
{
    const WrVec3 n = { 0, 0, 1 };
    const WrVec3 g = { -at->m.x / at->m.z, -at->m.y / at->m.z, 0 };
    WrVec3 b = { 0, 0, 0 };
    waves_at(waves, u, v, &b.x, &b.y);
    return wr_bump_combined(combine, n, g, b);
}

/* A plane tilted by any slope: `surface` is the relief along its normal, `slopes` the one along z. */
static void on_a_tilted_plane_two_are_exact(void **state)
{
    TestRandom random = { 5 };
    (void)state;
    for (int i = 0; i < 3000; i++) {
        const Waves waves = random_waves(&random, 0.4 * test_random(&random), 20);
        const double a = 3 * test_random(&random) - 1.5, b = 3 * test_random(&random) - 1.5;
        const double u = test_random(&random), v = test_random(&random);
        const Detailed at = on_tilted_plane(a, b, u, v);
        const WrVec3 along = displaced(&at, false, &waves, u, v);
        const WrVec3 upright = displaced(&at, true, &waves, u, v);
        assert_true(apart(combined(WR_COMBINE_SURFACE, &at, &waves, u, v), along) < 1e-13);
        assert_true(apart(combined(WR_COMBINE_SLOPES, &at, &waves, u, v), upright) < 1e-13);
    }
}

/* Rms and largest angle, degrees, between the displaced surface's normal and each combination's, and the rms
   angle by which the relief turns the detailed surface's. */
typedef struct Off {
    double rms[WR_COMBINE_COUNT], most[WR_COMBINE_COUNT], relief;
} Off;

static Off ball_off(double base_deg, double slope)
{
    TestRandom random = { 3 };
    const int count = 20000;
    Off off = { .relief = 0 };
    for (int i = 0; i < count; i++) {
        const Waves waves = random_waves(&random, slope, 400);
        const double angle = 6.283185307179586 * test_random(&random);
        const double u = sin(base_deg / TURN) * cos(angle), v = sin(base_deg / TURN) * sin(angle);
        const Detailed at = on_ball(u, v);
        const WrVec3 truth = displaced(&at, false, &waves, u, v);
        off.relief += pow(apart(truth, at.m) * TURN, 2) / count;
        for (int c = 0; c < WR_COMBINE_COUNT; c++) {
            const double d = apart(combined((WrCombine)c, &at, &waves, u, v), truth) * TURN;
            off.rms[c] += d * d / count;
            off.most[c] = fmax(off.most[c], d);
        }
    }
    off.relief = sqrt(off.relief);
    for (int c = 0; c < WR_COMBINE_COUNT; c++) off.rms[c] = sqrt(off.rms[c]);
    return off;
}

/* A ball baked onto a plane, with waves 1/64 of its radius long along its normals. `surface` drops terms in the
   ball's curvature alone; reoriented is nearer than the sum, most where the map is steep. */
static void over_a_baked_ball_surface_is_nearest(void **state)
{
    static const double bases[] = { 10, 30, 45, 60 }, slopes[] = { 0.02, 0.2 };
    (void)state;
    for (int k = 0; k < 8; k++) {
        const Off off = ball_off(bases[k % 4], slopes[k / 4]);
        if (getenv("WR_SHOW"))
            printf(
                "map %2g deg, relief %.2f deg: slopes %.3f (%.2f), reoriented %.3f (%.2f), surface "
                "%.3f (%.2f)\n",
                bases[k % 4], off.relief, off.rms[0], off.most[0], off.rms[1], off.most[1],
                off.rms[2], off.most[2]);
        assert_true(off.rms[WR_COMBINE_SURFACE] < 0.02 * off.relief);
        assert_true(off.rms[WR_COMBINE_REORIENTED] < off.rms[WR_COMBINE_SLOPES]);
        assert_true(off.rms[WR_COMBINE_SURFACE] < off.rms[WR_COMBINE_REORIENTED]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_relief_or_a_flat_map_leaves_the_other),
        cmocka_unit_test(reoriented_is_the_rotation_of_the_relief),
        cmocka_unit_test(half_on_half),
        cmocka_unit_test(on_a_tilted_plane_two_are_exact),
        cmocka_unit_test(over_a_baked_ball_surface_is_nearest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
