/* Ambient occlusion and horizons of tables: against a search over every texel of the lines, in double precision, and
   against closed forms. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "field/occlusion.h"
#include "field/occlusion_kern.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static uint32_t seed = 1978;

static double random_between(double low, double high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (seed / 4294967296.0);
}

static WrField *field_of(int w, int h, WrWrap u, WrWrap v)
{
    return wr_field_new(w, h, u, v, 0.0f, NULL);
}

static WrField *rough(int w, int h, WrWrap u, WrWrap v)
{
    WrField *field = field_of(w, h, u, v);
    for (int k = 0; k < w * h; k++)
        wr_field_set(field, k % w, k / w, (float)random_between(-1, 1.3));
    return field;
}

typedef struct Map {
    WrOcclusion how;
    WrMapPart part;
    float *p, *q, *out;
} Map;

static Map map_of(const WrField *field, int directions, int reach)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    Map map = {
        { field, 1.7, 0.83, 1.21, directions, reach }, { 0, 0, w, h, (size_t)w + 3 }, 0, 0, 0
    };
    map.p = wr_alloc(map.part.pitch * (size_t)h, sizeof(float));
    map.q = wr_alloc(map.part.pitch * (size_t)h, sizeof(float));
    map.out = wr_alloc(map.part.pitch * (size_t)h, sizeof(float));
    return map;
}

static void free_map(Map *map)
{
    wr_free(map->p), wr_free(map->q), wr_free(map->out);
}

static double out_at(const Map *map, int i, int j)
{
    return (double)map->out[(size_t)j * map->part.pitch + (size_t)i];
}

static int turned(int at, int n, WrWrap wrap)
{
    return wrap == WR_WRAP_PERIODIC ? (at % n + n) % n : at < 0 ? 0 : at < n ? at : n - 1;
}

static double texel(const WrField *f, int i, int j)
{
    return (double)wr_field_get(f, turned(i, wr_field_width(f), wr_field_wrap_u(f)),
                                turned(j, wr_field_height(f), wr_field_wrap_v(f)));
}

/* Height after a step of t texels in direction k: linear between two texels. */
static double on_line(const WrField *f, int i, int j, double x, double y, int t)
{
    const double u = i + t * x, v = j - t * y;
    const int a = (int)floor(u), b = (int)floor(v);
    const double s = u - a, r = v - b;
    return (1 - s) * (1 - r) * texel(f, a, b) + s * (1 - r) * texel(f, a + 1, b) +
           (1 - s) * r * texel(f, a, b + 1) + s * r * texel(f, a + 1, b + 1);
}

/* Direction k of n around the square, from u to v. */
static void square(int k, int n, double *x, double *y)
{
    const double turn = 8.0 * k / n; /* eighths */
    if (turn <= 1) *x = 1, *y = turn;
    else if (turn < 3) *x = 2 - turn, *y = 1;
    else if (turn <= 5) *x = -1, *y = 4 - turn;
    else if (turn < 7) *x = turn - 6, *y = -1;
    else *x = 1, *y = turn - 8;
}

static double looked(const Map *map, int i, int j, int k, int far)
{
    const WrOcclusion *how = &map->how;
    double x, y, best = 0;
    square(k, how->directions, &x, &y);
    const double step = hypot(x * how->texel_w, y * how->texel_h);
    const double from = texel(how->field, i, j);
    for (int t = 1; t <= far; t++)
        best = fmax(best, how->height * (on_line(how->field, i, j, x, y, t) - from) / (t * step));
    return best;
}

static const int sizes[][2] = { { 1, 1 }, { 1, 5 },  { 6, 1 }, { 2, 3 },
                                { 7, 9 }, { 11, 8 }, { 6, 14 } };

/* HC122, HC155: all directions of small tables, with all wrap modes, as far as lines find new texels. */
static void horizons_are_what_looking_finds(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(2);
    for (int n = 0; n < 28; n++) {
        const int *size = sizes[n / 4];
        WrField *field = rough(size[0], size[1], n % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                               n / 2 % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        Map map = map_of(field, 4 << n % 4, n % 3 == 2 ? 5 : 0);
        if (n % 5 == 3) map.how.height = -0.9;
        for (int k = 0; k < map.how.directions; k++) {
            WrError err = { "" };
            if (!wr_occlusion_horizon(&map.how, &map.part, k, pool, map.out, &err))
                fail_msg("%s", err.text);
            for (int m = 0; m < size[0] * size[1]; m++) {
                const int i = m % size[0], j = m / size[0];
                const double want = looked(
                    &map, i, j, k, map.how.reach ? map.how.reach : 4 * size[0] * size[1] + 40);
                if (!(fabs(out_at(&map, i, j) - want) <= 3e-7 * (1 + want)))
                    fail_msg("%dx%d wrap %d, %d of %d at %d,%d: %.9g, not %.9g", size[0], size[1],
                             n % 4, k, map.how.directions, i, j, out_at(&map, i, j), want);
            }
        }
        free_map(&map);
        wr_field_free(field);
    }
    wr_pool_free(pool);
}

static void make(Map *map, WrPool *pool)
{
    WrError err = { "" };
    if (!wr_occlusion_make(&map->how, &map->part, map->p, map->q, pool, map->out, &err))
        fail_msg("%s", err.text);
}

/* Visible fraction of the sky for a plane with slopes p, q and these horizon slopes: the hemisphere's integral over
 * each sector, by its own angles. */
static double sky(const WrOcclusion *how, const double *slope, double p, double q)
{
    const double n = sqrt(1 + p * p + q * q);
    double sum = 0;
    for (int k = 0; k < how->directions; k++) {
        double x, y, at[3];
        for (int side = -1; side <= 1; side++) {
            square((k + side + how->directions) % how->directions, how->directions, &x, &y);
            at[side + 1] = atan2(y * how->texel_h, x * how->texel_w);
        }
        double wide = at[2] - at[0];
        while (wide < 0) wide += 2 * PI;
        const double out = -(p * cos(at[1]) + q * sin(at[1])) / n;
        const double h = fmax(atan(slope[k]), atan2(-out, 1 / n)), up = cos(h);
        sum += wide / 2 * (up * up / n / 2 + out * ((PI / 2 - h) / 2 - sin(2 * h) / 4));
    }
    return sum / PI;
}

static void occlusion_is_the_sky_that_horizons_leave(void **state)
{
    (void)state;
    WrField *field = rough(9, 7, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    for (int n = 0; n < 8; n++) {
        Map map = map_of(field, 4 << n % 4, n / 4 * 6);
        for (int k = 0; k < 63; k++) {
            const size_t at = (size_t)(k / 9) * map.part.pitch + (size_t)(k % 9);
            map.p[at] = (float)random_between(-1.5, 1.5);
            map.q[at] = (float)random_between(-1.5, 1.5);
        }
        make(&map, NULL);
        for (int k = 0; k < 63; k++) {
            const size_t at = (size_t)(k / 9) * map.part.pitch + (size_t)(k % 9);
            double slope[32];
            for (int d = 0; d < map.how.directions; d++)
                slope[d] = looked(&map, k % 9, k / 9, d, map.how.reach ? map.how.reach : 400);
            const double want = sky(&map.how, slope, (double)map.p[at], (double)map.q[at]);
            assert_near(map.out[at], fmin(fmax(want, 0), 1), 3e-6);
        }
        free_map(&map);
    }
    wr_field_free(field);
}

/* Level ground is open to the whole sky at any height; exactly 1. */
static void level_ground_sees_the_whole_sky(void **state)
{
    (void)state;
    WrField *field = field_of(23, 10, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    wr_field_fill(field, -7.3f);
    for (int n = 0; n < 8; n++) {
        Map map = map_of(field, 4 << n % 4, n / 4 * 9);
        make(&map, NULL);
        for (int k = 0; k < 230; k++) assert_true(out_at(&map, k % 23, k / 23) == 1.0);
        free_map(&map);
    }
    wr_field_free(field);
}

/* In the centre of a round pit: cos^2 of the rim's angle, R^2 / (R^2 + d^2). The rim is found within a texel. */
static void a_round_pit_sees_what_its_rim_leaves(void **state)
{
    (void)state;
    const int n = 257;
    WrField *field = field_of(n, n, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    const double rim = 80, deep = 45;
    for (int k = 0; k < n * n; k++)
        wr_field_set(field, k % n, k / n,
                     hypot(k % n - 128, k / n - 128) < rim ? (float)-deep : 0.0f);
    for (int directions = 8; directions <= 32; directions *= 2) {
        Map map = map_of(field, directions, directions == 16 ? 100 : 0);
        map.how.height = map.how.texel_w = map.how.texel_h = 1;
        make(&map, NULL);
        const double want = rim * rim / (rim * rim + deep * deep);
        assert_near(out_at(&map, 128, 128), want,
                    2 * deep * deep * rim / pow(rim * rim + deep * deep, 2));
        free_map(&map);
    }
    wr_field_free(field);
}

/* On the floor of a trench between walls at x1 and x2: 1/2 (1/sqrt(1 + d^2/x1^2) + 1/sqrt(1 + d^2/x2^2)); the error
 * falls with the square of the number of directions. */
static void a_trench_sees_what_its_walls_leave(void **state)
{
    (void)state;
    WrField *field = field_of(101, 101, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    const double deep = 13;
    for (int k = 0; k < 101 * 101; k++)
        wr_field_set(field, k % 101, k / 101, k % 101 > 20 && k % 101 < 60 ? (float)-deep : 0.0f);
    double off[3];
    for (int n = 0; n < 3; n++) {
        Map map = map_of(field, 8 << n, 0);
        map.how.height = map.how.texel_w = map.how.texel_h = 1;
        make(&map, NULL);
        off[n] = 0;
        for (int i = 21; i < 60; i++) {
            const double x1 = i - 20, x2 = 60 - i;
            const double want =
                0.5 / sqrt(1 + deep * deep / x1 / x1) + 0.5 / sqrt(1 + deep * deep / x2 / x2);
            off[n] = fmax(off[n], fabs(out_at(&map, i, 50) - want));
        }
        free_map(&map);
    }
    if (!(off[0] < 0.1 && off[1] < 0.045 && off[2] < 0.013))
        fail_msg("%g %g %g", off[0], off[1], off[2]);
    wr_field_free(field);
}

/* A cos 2 pi x: from the trough the horizon's slope is 2 pi A 0.724611 along x, where tan(y / 2) = y; with an error
   of second order in the texel size. */
static void the_horizon_of_a_trough_is_known(void **state)
{
    (void)state;
    const int n = 1000;
    WrField *field = field_of(n, 1, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    for (int i = 0; i < n; i++) wr_field_set(field, i, 0, (float)(0.37 * cos(2 * PI * i / n)));
    Map map = map_of(field, 4, 0);
    map.how.height = 1.5, map.how.texel_w = 1.0 / n;
    WrError err = { "" };
    for (int k = 0; k < 4; k += 2) {
        assert_true(wr_occlusion_horizon(&map.how, &map.part, k, NULL, map.out, &err));
        assert_near(out_at(&map, n / 2, 0), 2 * PI * 0.37 * 1.5 * 0.724611, 2e-5);
    }
    free_map(&map);
    wr_field_free(field);
}

/* A plane tilted against a level horizon is open to (1 + cos) / 2; against its own plane, everything. Both on wide level
   ground. */
static void a_tilted_plane_sees_what_it_faces(void **state)
{
    (void)state;
    WrField *field = field_of(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    for (int n = 0; n < 3; n++) {
        Map map = map_of(field, 8 << n, 0);
        map.how.texel_w = map.how.texel_h = 1;
        for (size_t k = 0; k < 8 * map.part.pitch; k++) map.p[k] = 0.4f, map.q[k] = -0.7f;
        make(&map, NULL);
        const double want = (1 + 1 / sqrt(1 + 0.16 + 0.49)) / 2;
        assert_near(out_at(&map, 3, 5), want, 0.03 / (1 << 2 * n));
        free_map(&map);
    }
    wr_field_free(field);
}

/* Odd and unequal sizes, including lines that do not close: rolled by whole texels, with other threads. */
static void a_moved_table_gives_the_moved_map(void **state)
{
    (void)state;
    const int shapes[][2] = { { 67, 41 }, { 64, 64 }, { 5, 130 }, { 1, 9 }, { 2, 3 } };
    for (int n = 0; n < 10; n++) {
        const int w = shapes[n / 2][0], h = shapes[n / 2][1], dx = w / 3 + 1, dy = h / 2;
        WrField *field = rough(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
        WrField *moved = field_of(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
        WrPool *pool = wr_pool_new(3);
        Map a = map_of(field, 32, n % 2 * 7), b = map_of(moved, 32, n % 2 * 7);
        for (int k = 0; k < w * h; k++) {
            const int i = (k % w + dx) % w, j = (k / w + dy) % h;
            const size_t from = (size_t)(k / w) * a.part.pitch + (size_t)(k % w);
            const size_t to = (size_t)j * a.part.pitch + (size_t)i;
            wr_field_set(moved, i, j, wr_field_get(field, k % w, k / w));
            b.p[to] = a.p[from] = (float)random_between(-1, 1);
            b.q[to] = a.q[from] = (float)random_between(-1, 1);
        }
        make(&a, NULL);
        make(&b, pool);
        for (int k = 0; k < w * h; k++)
            assert_true(out_at(&a, k % w, k / w) == out_at(&b, (k % w + dx) % w, (k / w + dy) % h));
        free_map(&a), free_map(&b);
        wr_pool_free(pool);
        wr_field_free(field), wr_field_free(moved);
    }
}

/* A part of the table within reach is bit-identical to that part of the whole map. */
static void a_part_is_that_of_the_whole(void **state)
{
    (void)state;
    WrField *field = rough(90, 70, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    Map all = map_of(field, 16, 11), part = map_of(field, 16, 11);
    make(&all, NULL);
    part.part = (WrMapPart){ 61, 33, 29, 37, 40 };
    make(&part, NULL);
    for (int k = 0; k < 29 * 37; k++)
        assert_true(part.out[(k / 29) * 40 + k % 29] == out_at(&all, 61 + k % 29, 33 + k / 29));
    free_map(&all), free_map(&part);
    wr_field_free(field);
}

enum { ROWS = 70, COUNT = ROWS * WR_SKY_LANES, SHARED = 77 };

/* Results of an instruction set for the same input. */
typedef struct Made {
    float slope[COUNT], loss[SHARED], best[SHARED];
    int32_t highest[WR_SKY_LANES], found;
} Made;

static void work_of(const WrSkyKernels *k, int turn, const int32_t *h, float (*in)[SHARED],
                    Made *made)
{
    static int64_t seen[COUNT];
    int rows[ROWS];
    for (int i = 0; i < ROWS; i++) rows[i] = turn ? ROWS - 1 - i : i;
    const WrSkySweep sweep = { h, seen, rows, ROWS, 0 };
    k->sweep(&sweep, 0.37, made->slope);
    for (int l = 0; l < WR_SKY_LANES; l++) made->highest[l] = 0x19000000;
    made->found =
        k->higher(turn ? h : h + COUNT - WR_SKY_LANES, turn ? 1 : -1, 1, ROWS, made->highest);
    const WrSkyRun runs[] = {
        { in[0], in[1], in[2], in[3], made->loss, 40 },
        { in[0] + 40, in[1] + 40, in[2] + 40, in[3] + 40, made->loss + 40, WR_SKY_LANES },
        { in[0] + 56, in[1] + 56, in[2] + 56, in[3] + 56, made->loss + 56, SHARED - 56 }
    };
    for (int pass = 0; pass < 3; pass++) {
        const WrSkyShare share = { 0.1f, 0.6f, 0.8f, 0.0625f, pass == 0, pass == 2 && turn };
        k->share(&share, runs, 3);
    }
    memset(made->best, 0, sizeof made->best);
    k->look(in[2], in[0], in[1], 0.25f, 0.7f, SHARED, made->best);
}

/* All instruction sets are bit-identical. */
static void kernels_agree_to_the_bit(void **state)
{
    (void)state;
    static int32_t h[COUNT];
    static float in[4][SHARED];
    static Made plain[2], other;
    for (int i = 0; i < COUNT; i++) h[i] = (int32_t)random_between(-0x1p29, 0x1p29);
    for (int i = 0; i < 4 * SHARED; i++)
        in[i / SHARED][i % SHARED] = (float)random_between(i / SHARED < 2 ? 0 : -2, 2);
    in[0][3] = 1e12f, in[1][70] = 3e9f, in[2][41] = 1e8f;
    for (int turn = 0; turn < 2; turn++) work_of(wr_sky_kernels_at(0), turn, h, in, &plain[turn]);
    for (int n = 2; n < 6; n++) {
        if (!wr_sky_kernels_at(n / 2)) continue;
        work_of(wr_sky_kernels_at(n / 2), n % 2, h, in, &other);
        assert_memory_equal(&other, &plain[n % 2], sizeof other);
    }
}

/* The next row in which a lane is higher: compared with a search over all of them, from every start, in both
   directions. */
static void the_next_higher_row_is_found(void **state)
{
    (void)state;
    int32_t h[ROWS * WR_SKY_LANES], highest[WR_SKY_LANES];
    for (int n = 0; n < 200; n++) {
        const int sign = n % 2 ? 1 : -1, from = n % ROWS, lane = n % WR_SKY_LANES;
        const int32_t *first = sign > 0 ? h : h + (ROWS - 1) * WR_SKY_LANES;
        for (int i = 0; i < ROWS * WR_SKY_LANES; i++) h[i] = (int32_t)random_between(0, 1000);
        for (int l = 0; l < WR_SKY_LANES; l++) highest[l] = l == lane ? 900 + n % 100 : 2000;
        int want = from;
        while (want < ROWS && first[sign * want * WR_SKY_LANES + lane] <= highest[lane]) want++;
        const int32_t top = want < ROWS ? first[sign * want * WR_SKY_LANES + lane] : highest[lane];
        assert_int_equal(wr_sky_kernels()->higher(first, sign, from, ROWS, highest), want);
        assert_int_equal(highest[lane], top);
        assert_int_equal(highest[(lane + 1) % WR_SKY_LANES], 2000);
    }
}

/* Cliffs and nearly vertical planes: compared with the formula in double precision. */
static void walls_are_walls(void **state)
{
    (void)state;
    const float steep[][4] = { { 1e12f, 0, 0.3f, 0 },  { 0, 3e30f, 0, -0.2f },
                               { 5e6f, 5e6f, 0, 0 },   { 2e5f, 1, 1e8f, 0 },
                               { 1, 1e30f, -1e7f, 3 }, { 1e6f, 0, 1e4f, -1e4f } };
    for (int n = 0; n < 6; n++) {
        const float *in = steep[n];
        float seen = 0;
        const WrSkyRun run = { in, in + 1, in + 2, in + 3, &seen, 1 };
        for (int pair = 0; pair < 2; pair++) {
            const WrSkyShare share = { 0, 0.6f, pair ? -0.8f : 0.8f, 0.25f, pair == 0, pair == 1 };
            wr_sky_kernels()->share(&share, &run, 1);
        }
        const double p = (double)in[2], q = (double)in[3], z = 1 / sqrt(1 + p * p + q * q);
        double want = 0;
        for (int k = 0; k < 4; k++) {
            const double way = k % 2 ? -1 : 1, s = way * (0.6 * p + (k < 2 ? 0.8 : -0.8) * q);
            const double h = fmax((double)in[k % 2], s);
            want += z * 0.25 * (1 / (1 + h * h) - s * (atan2(1, h) - h / (1 + h * h)));
        }
        assert_near(seen, fmin(fmax(want, 0), 1), 2e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(horizons_are_what_looking_finds),
        cmocka_unit_test(occlusion_is_the_sky_that_horizons_leave),
        cmocka_unit_test(level_ground_sees_the_whole_sky),
        cmocka_unit_test(a_round_pit_sees_what_its_rim_leaves),
        cmocka_unit_test(a_trench_sees_what_its_walls_leave),
        cmocka_unit_test(the_horizon_of_a_trough_is_known),
        cmocka_unit_test(a_tilted_plane_sees_what_it_faces),
        cmocka_unit_test(a_moved_table_gives_the_moved_map),
        cmocka_unit_test(a_part_is_that_of_the_whole),
        cmocka_unit_test(kernels_agree_to_the_bit),
        cmocka_unit_test(the_next_higher_row_is_found),
        cmocka_unit_test(walls_are_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
