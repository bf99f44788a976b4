/* Tables filled with noise, against the same noise point by point. */
#include "test.h"

#include "base/error.h"
#include "base/pool.h"
#include "noise/texel_grid.h"

#define MAX_MOST (640 * 300)
static float f[MAX_MOST], fu[MAX_MOST], fv[MAX_MOST], again[MAX_MOST], again_u[MAX_MOST],
    again_v[MAX_MOST];

static WrOctavesPlan plan_of(const WrOctaves *octaves)
{
    WrOctavesPlan plan;
    WrError err = { "" };
    if (!wr_octaves_plan(octaves, NULL, &plan, &err)) fail_msg("%s", err.text);
    return plan;
}

/* The bounds stated in texel_grid.h. */
static void tolerances(const WrOctavesPlan *plan, double *height, double slope[2])
{
    double amplitudes = 0.0, sloped[2] = { 0 };
    for (int k = 0; k < plan->used; k++) {
        amplitudes += plan->octave[k].amplitude;
        for (int a = 0; a < 2; a++)
            sloped[a] += plan->octave[k].amplitude * plan->octave[k].frequency[a];
    }
    *height = 1e-6 * amplitudes;
    for (int a = 0; a < 2; a++) slope[a] = 5e-6 * sloped[a];
}

static void assert_grid_is_points(const WrOctavesPlan *plan, int width, int height)
{
    assert_true(width * height <= MAX_MOST);
    WrNoiseGrid grid = { width, height, 0, 0, width, height };
    wr_octaves_grid(plan, &grid, f, fu, fv, (size_t)width);
    wr_octaves_grid(plan, &grid, again, NULL, NULL, (size_t)width);
    double allowed, sloped[2];
    tolerances(plan, &allowed, sloped);
    for (int k = 0; k < width * height; k += 1 + k % 13) {
        double p[2] = { (k % width + 0.5) / width, 1.0 - (k / width + 0.5) / height }, d[2];
        assert_near(f[k], wr_octaves_at(plan, p, d), allowed);
        assert_near(fu[k], d[0], sloped[0]);
        assert_near(fv[k], d[1], sloped[1]);
        assert_true(same_bits(f[k], again[k]));
    }
}

static void a_grid_of_any_kind_is_the_point_function_at_texel_centres(void **state)
{
    (void)state;
    const int sizes[][2] = { { 256, 64 }, { 300, 47 }, { 1, 1 }, { 7, 90 } };
    for (int kind = 0; kind < WR_NOISE_KIND_COUNT; kind++)
        for (int fade = 0; fade < (wr_noises[kind].cells ? WR_FADE_COUNT : 1); fade++)
            for (int k = 0; k < 4; k++)
                for (int tile = 0; tile < 2; tile++) {
                    WrOctaves octaves = wr_octaves_default(2);
                    octaves.kind = (WrNoiseKind)kind;
                    octaves.fade = (WrFade)fade;
                    octaves.tile = tile;
                    octaves.cells[1] = 6;
                    octaves.count = 5;
                    WrOctavesPlan plan;
                    if (!wr_octaves_plan(&octaves, NULL, &plan, NULL)) continue;
                    if (fade == WR_FADE_LINEAR && sizes[k][0] == 7) continue; /* below */
                    assert_grid_is_points(&plan, sizes[k][0], sizes[k][1]);
                }
}

/* On creases a float and a double may be on either side of 0: one texel in 2000 may have another slope. */
static void grids_of_every_mode_are_the_point_function(void **state)
{
    (void)state;
    enum { W = 320, H = 64 };
    for (int mode = 0; mode < WR_OCTAVES_MODE_COUNT; mode++) {
        WrOctaves octaves = wr_octaves_default(2);
        octaves.mode = (WrOctavesMode)mode;
        octaves.ridge_offset = 0.95;
        octaves.count = 6;
        WrOctavesPlan plan = plan_of(&octaves);
        double allowed, sloped[2];
        tolerances(&plan, &allowed, sloped);
        wr_octaves_grid(&plan, &(WrNoiseGrid){ W, H, 0, 0, W, H }, f, fu, fv, W);
        int far = 0;
        for (int k = 0; k < W * H; k++) {
            double p[2] = { (k % W + 0.5) / W, 1.0 - (k / W + 0.5) / H }, d[2];
            assert_near(f[k], wr_octaves_at(&plan, p, d), allowed);
            far += !(fabs(fu[k] - d[0]) <= sloped[0] && fabs(fv[k] - d[1]) <= sloped[1]);
        }
        assert_true(far <= (mode == WR_OCTAVES_FBM ? 0 : W * H / 2000));
    }
}

static void a_texel_has_the_same_bits_in_any_rectangle(void **state)
{
    (void)state;
    enum { W = 600, H = 120 };
    TestRandom r = { 15 };
    for (int kind = 0; kind < WR_NOISE_KIND_COUNT; kind++) {
        WrOctaves octaves = wr_octaves_default(2);
        octaves.kind = (WrNoiseKind)kind;
        octaves.tile = kind != WR_NOISE_SIMPLEX;
        octaves.mode = (WrOctavesMode)(kind % WR_OCTAVES_MODE_COUNT);
        octaves.cells[0] = 5;
        WrOctavesPlan plan = plan_of(&octaves);
        wr_octaves_grid(&plan, &(WrNoiseGrid){ W, H, 0, 0, W, H }, f, fu, fv, W);
        for (int n = 0; n < 12; n++) {
            int i = (int)(W * test_random(&r)), j = (int)(H * test_random(&r));
            int count_i = 1 + (int)((W - i) * test_random(&r));
            int count_j = 1 + (int)((H - j) * test_random(&r));
            size_t pitch = (size_t)count_i + 3;
            for (int k = 0; k < count_j * (int)pitch; k++) again[k] = -77.0f;
            wr_octaves_grid(&plan, &(WrNoiseGrid){ W, H, i, j, count_i, count_j }, again, again_u,
                            again_v, pitch);
            for (int y = 0; y < count_j; y++) {
                size_t from = (size_t)(j + y) * W + (size_t)i, to = (size_t)y * pitch;
                size_t bytes = (size_t)count_i * sizeof(float);
                assert_memory_equal(again + to, f + from, bytes);
                assert_memory_equal(again_u + to, fu + from, bytes);
                assert_memory_equal(again_v + to, fv + from, bytes);
                for (int k = 0; k < 3; k++) assert_true(again[to + (size_t)count_i + k] == -77.0f);
            }
        }
    }
}

/* Offsets of whole texels roll the table: frequency * texels / width more cells, exact for powers of
 * two. */
static void hc68_offsets_of_whole_texels_roll_the_table(void **state)
{
    (void)state;
    enum { W = 256, H = 128, RIGHT = 37, UP = 11 };
    WrOctaves octaves = wr_octaves_default(2);
    octaves.count = 5;
    double offsets[10] = { 0 };
    octaves.offsets = offsets;
    WrOctavesPlan still = plan_of(&octaves);
    for (int k = 0; k < 5; k++) {
        offsets[2 * k] = -ldexp(4.0, k) * RIGHT / W;
        offsets[2 * k + 1] = -ldexp(4.0, k) * UP / H;
    }
    WrOctavesPlan moved = plan_of(&octaves);
    WrNoiseGrid grid = { W, H, 0, 0, W, H };
    wr_octaves_grid(&still, &grid, f, fu, fv, W);
    wr_octaves_grid(&moved, &grid, again, again_u, again_v, W);
    for (int k = 0; k < W * H; k++) {
        int from = (k / W + UP) % H * W + (k % W - RIGHT + W) % W;
        assert_true(same_bits(again[k], f[from]));
        assert_true(same_bits(again_u[k], fu[from]) && same_bits(again_v[k], fv[from]));
    }
}

typedef struct Fill {
    const WrOctavesPlan *plan;
    float *out;
} Fill;

static void fill_rows(int index, int worker, void *ctx)
{
    (void)worker;
    const Fill *fill = ctx;
    WrNoiseGrid grid = { 320, 320, 0, 20 * index, 320, 20 };
    wr_octaves_grid(fill->plan, &grid, fill->out + (size_t)index * 20 * 320, NULL, NULL, 320);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    WrOctaves octaves = wr_octaves_default(2);
    WrOctavesPlan plan = plan_of(&octaves);
    wr_octaves_grid(&plan, &(WrNoiseGrid){ 320, 320, 0, 0, 320, 320 }, f, NULL, NULL, 320);
    const int threads[] = { 1, 2, 7, 16 };
    for (int k = 0; k < 4; k++) {
        memset(again, 0, sizeof again);
        WrPool *pool = wr_pool_new(threads[k]);
        wr_pool_run(pool, 16, fill_rows, &(Fill){ &plan, again });
        wr_pool_free(pool);
        assert_memory_equal(again, f, 320 * 320 * sizeof *f);
    }
}

/* Half of the texels of 4 cells per texel along x are on the lattice; and lattices finer than texels use another code
 * path than coarse ones. */
static void hc63_fine_lattices_are_filled_too(void **state)
{
    (void)state;
    WrOctaves octaves = wr_octaves_default(2);
    octaves.count = 2;
    octaves.scatter = false;
    octaves.cells[0] = 256, octaves.cells[1] = 64;
    WrOctavesPlan plan = plan_of(&octaves);
    assert_grid_is_points(&plan, 128, 32);
    for (int k = 0; k < 128 * 32; k++) assert_true(f[k] == 0.0f);
    octaves.cells[0] = 131;
    plan = plan_of(&octaves);
    assert_grid_is_points(&plan, 128, 32);
    octaves.kind = WR_NOISE_VALUE;
    octaves.source = WR_LATTICE_LECTURE;
    octaves.cells[0] = 64;
    plan = plan_of(&octaves);
    assert_grid_is_points(&plan, 128, 32);
}

static void without_usable_octaves_a_table_is_flat(void **state)
{
    (void)state;
    WrOctaves octaves = wr_octaves_default(2);
    WrOctavesPlan plan;
    assert_true(wr_octaves_plan(&octaves, (int[]){ 6, 6 }, &plan, NULL));
    assert_int_equal(plan.used, 0);
    memset(f, 1, sizeof f);
    wr_octaves_grid(&plan, &(WrNoiseGrid){ 6, 6, 0, 0, 6, 6 }, f, fu, fv, 6);
    for (int k = 0; k < 36; k++) assert_true(f[k] == 0.0f && fu[k] == 0.0f && fv[k] == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_of_any_kind_is_the_point_function_at_texel_centres),
        cmocka_unit_test(grids_of_every_mode_are_the_point_function),
        cmocka_unit_test(a_texel_has_the_same_bits_in_any_rectangle),
        cmocka_unit_test(hc68_offsets_of_whole_texels_roll_the_table),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(hc63_fine_lattices_are_filled_too),
        cmocka_unit_test(without_usable_octaves_a_table_is_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
