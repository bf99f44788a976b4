/* The blur's inner loop: every instruction set against the explicit sum, and against each other. */
#include "test.h"

#include "base/hash.h"
#include "field/filter_kernels.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define REACH 43
#define LANES WR_TAPS_LANES
#define PITCH 256
#define COUNT 11 /* elements: fours and a rest */
#define ROWS (2 * REACH + COUNT)
#define TO 19 /* distance in floats of the result's elements: there is a gap */
#define MIDDLE (&heights[REACH][REACH])

static float heights[ROWS][PITCH], weights[REACH + 1];

static int fill(void **state)
{
    (void)state;
    for (int j = 0; j < ROWS; j++)
        for (int i = 0; i < PITCH; i++)
            heights[j][i] =
                (float)((double)wr_mix32((uint32_t)(j * PITCH + i)) * 0x1p-32 * 3.0 - 1.0);
    for (int k = 0; k <= REACH; k++) weights[k] = 1.0f / (float)(80 + k);
    return 0;
}

/* Elements in sequence, and below each other. */
static const ptrdiff_t steps[] = { LANES, PITCH };

static void each_texel_gets_its_taps_along_rows_and_columns(void **state)
{
    (void)state;
    for (int index = 0; wr_taps_at(index); index++)
        for (int s = 0; s < 2; s++) {
            float sum[COUNT * TO];
            wr_taps_at(index)->add(weights, REACH, MIDDLE, steps[s], COUNT, sum, TO);
            for (int i = 0; i < COUNT * LANES; i++) {
                const float *c = MIDDLE + i / LANES * steps[s] + i % LANES;
                double exact = 0;
                for (int k = 1; k <= REACH; k++)
                    exact += (double)weights[k] * ((double)c[-k * steps[s]] +
                                                   (double)c[k * steps[s]] - 2.0 * (double)*c);
                /* 43 sums of at most 43/80 * 12 in float: each rounds by 2^-24 of it */
                assert_float_equal(sum[i / LANES * TO + i % LANES], exact, 43 * 7 * 0x1p-23);
            }
        }
}

static void all_instruction_sets_give_the_same_bits_for_any_count_and_reach(void **state)
{
    (void)state;
    for (int index = 1; wr_taps_at(index); index++)
        for (int count = 0; count <= COUNT; count++)
            for (int reach = 0; reach <= REACH; reach++) {
                const ptrdiff_t step = steps[reach % 2];
                float plain[COUNT * TO], other[COUNT * TO];
                for (int i = 0; i < COUNT * TO; i++) plain[i] = other[i] = 77.0f;
                wr_taps_v1.add(weights, reach, MIDDLE + 1, step, count, plain, TO);
                wr_taps_at(index)->add(weights, reach, MIDDLE + 1, step, count, other, TO);
                assert_memory_equal(plain, other, sizeof plain);
                for (int i = 0; i < COUNT * TO; i++) /* nothing else is written */
                    if (i % TO >= LANES || i / TO >= count) assert_true(other[i] == 77.0f);
            }
}

static void smoothing_adds_the_sum_to_the_height(void **state)
{
    (void)state;
    for (int index = 0; wr_taps_at(index); index++)
        for (int count = 1; count <= COUNT; count++)
            for (int s = 0; s < 2; s++) {
                float sum[COUNT * TO], smooth[COUNT * TO];
                wr_taps_v1.add(weights, REACH, MIDDLE + 2, steps[s], count, sum, TO);
                wr_taps_at(index)->smooth(weights, REACH, MIDDLE + 2, steps[s], count, smooth, TO);
                for (int i = 0; i < count * LANES; i++) {
                    const int at = i / LANES * TO + i % LANES;
                    const float height = MIDDLE[2 + i / LANES * steps[s] + i % LANES];
                    assert_true(smooth[at] == height + sum[at]);
                }
            }
}

static void turned_rows_are_columns(void **state)
{
    (void)state;
    for (int index = 0; wr_taps_at(index); index++) {
        float out[LANES * TO];
        for (int i = 0; i < LANES * TO; i++) out[i] = 77.0f;
        wr_taps_at(index)->turn(&heights[3][5], PITCH, out, TO);
        for (int i = 0; i < LANES * TO; i++)
            assert_true(out[i] == (i % TO < LANES ? heights[3 + i % TO][5 + i / TO] : 77.0f));
    }
}

/* Integers, so that sums are exact in any order. */
static void boxes_are_their_sums_to_the_nearest_whole_number(void **state)
{
    (void)state;
    enum { L = WR_BOX_LANES, N = 60 };
    for (int index = 0; wr_taps_at(index); index++)
        for (int r = 0; r < 20; r++) {
            const WrBox box = { r, 0.3 + 0.03 * r, 1.0 / (2 * r + 1 + 2 * (0.3 + 0.03 * r)) };
            static double in[(N + 60) * L], out[(N + 1) * L];
            for (int k = 0; k < (N + 60) * L; k++)
                in[k] = (double)((int64_t)wr_mix32((uint32_t)(k + r)) << 8) - 0x1p39;
            out[N * L] = 77.0;
            wr_taps_at(index)->box(&box, in, N, out);
            for (int i = 0; i < N; i++)
                for (int lane = 0; lane < L; lane++) {
                    double sum = 0;
                    for (int k = 1; k <= 2 * r + 1; k++) sum += in[(i + k) * L + lane];
                    double ends = in[i * L + lane] + in[(i + 2 * r + 2) * L + lane];
                    assert_true(out[i * L + lane] == rint((sum + box.end * ends) * box.inverse));
                }
            assert_true(out[N * L] == 77.0);
        }
}

static void steps_go_to_and_from_heights_alike_along_and_across(void **state)
{
    (void)state;
    enum { L = WR_BOX_LANES };
    const double scales[] = { 0x1p40, 0x1p-88, 0x1p160 };
    for (int index = 0; wr_taps_at(index); index++)
        for (int n = 0; n < 3; n++) {
            const double scale = scales[n], step = 1.0 / scale;
            double row[40 * L], across[L], both[40 * L];
            float was[40], along[40], side[L];
            for (int k = 0; k < 40; k++) was[k] = along[k] = heights[n][k] * (float)(0x1p38 * step);
            wr_taps_at(index)->to_steps(scale, was, 40, row);
            for (int k = 0; k < 40; k++) {
                assert_true(row[k * L] == rint((double)was[k] * scale));
                both[k * L] = k % 3 ? 2.0 * row[k * L] + (double)(k * 1001) : 2.0 * row[k * L];
            }
            wr_taps_at(index)->add_steps(scale, step, both, 40, along);
            for (int k = 0; k < 40; k++) {
                double x = (double)was[k] + (0.5 * both[k * L] - row[k * L]) * step;
                assert_true(along[k] == (float)x && (k % 3 || along[k] == was[k]));
            }
            wr_taps_at(index)->to_steps_across(scale, was, across);
            for (int k = 0; k < L; k++) {
                assert_true(across[k] == row[k * L]);
                side[k] = was[k];
                across[k] = both[k * L];
            }
            wr_taps_at(index)->add_steps_across(scale, step, across, side);
            for (int k = 0; k < L; k++) assert_true(side[k] == along[k]);
            float end = -3e38f;
            along[0] = side[0] = end;
            both[0] = across[0] = -1e300;
            wr_taps_at(index)->add_steps(0x1p-88, 0x1p88, both, 1, along);
            wr_taps_at(index)->add_steps_across(0x1p-88, 0x1p88, across, side);
            assert_true(along[0] == -3.4028234663852886e38f && side[0] == along[0]);
        }
}

static void a_flat_neighbourhood_adds_exactly_nothing(void **state)
{
    (void)state;
    static float flat[ROWS * LANES];
    for (int i = 0; i < ROWS * LANES; i++) flat[i] = 0.7312f;
    for (int index = 0; wr_taps_at(index); index++) {
        float sum[COUNT * LANES];
        wr_taps_at(index)->add(weights, REACH, flat + REACH * LANES, LANES, COUNT, sum, LANES);
        for (int i = 0; i < COUNT * LANES; i++) assert_true(sum[i] == 0.0f);
    }
}

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Equal heights and NaN keep their bits, overflows become the limits; nothing else is written. */
static void settled_heights_are_finite_and_keep_their_bits(void **state)
{
    (void)state;
    enum { ROW = 71, MORE = 5 };
    const float odd[] = { NAN, -NAN, INFINITY, -INFINITY, -0.0f, 0.0f };
    for (int index = 0; wr_taps_at(index); index++)
        for (int columns = 1; columns <= ROW; columns++) {
            float before[MORE * (ROW + 3)], now[MORE * ROW], want[MORE * ROW];
            bool differs = false;
            for (int k = 0; k < MORE * (ROW + 3); k++) before[k] = heights[k % 7][k / 7];
            for (int k = 0; k < MORE * ROW; k++) {
                const int y = k / ROW, x = k % ROW;
                float *was = &before[y * (ROW + 3) + x];
                const float kept = (k + columns) % 3 ? *was : odd[(k + columns) / 3 % 6];
                if (k % 5 == 0) *was = k % 2 ? -0.0f : 0.0f;
                now[k] = columns % 4 ? *was : (k + columns) % 7 ? kept : heights[9][k % 200];
                if (columns % 4 == 0 && k % 11 == 0) now[k] = -*was;
                want[k] = now[k];
                if (x >= columns) continue;
                want[k] = isnan(now[k]) || now[k] == *was ? *was : fminf(FLT_MAX, now[k]);
                want[k] = fmaxf(-FLT_MAX, want[k]);
                differs |= bits_of(want[k]) != bits_of(*was);
            }
            assert_true(differs ==
                        wr_taps_at(index)->settle(before, ROW + 3, now, ROW, columns, MORE));
            assert_memory_equal(now, want, sizeof now);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_texel_gets_its_taps_along_rows_and_columns),
        cmocka_unit_test(all_instruction_sets_give_the_same_bits_for_any_count_and_reach),
        cmocka_unit_test(boxes_are_their_sums_to_the_nearest_whole_number),
        cmocka_unit_test(steps_go_to_and_from_heights_alike_along_and_across),
        cmocka_unit_test(smoothing_adds_the_sum_to_the_height),
        cmocka_unit_test(turned_rows_are_columns),
        cmocka_unit_test(a_flat_neighbourhood_adds_exactly_nothing),
        cmocka_unit_test(settled_heights_are_finite_and_keep_their_bits),
    };
    return cmocka_run_group_tests(tests, fill, NULL);
}
