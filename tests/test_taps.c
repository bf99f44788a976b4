/* The blur's inner loop: every instruction set against the sum written out, and against one another. */
#include "test.h"

#include "base/hash.h"
#include "field/taps.h"

#include <math.h>
#include <string.h>

#define REACH 43
#define PITCH 256
#define COUNT 150
#define ROWS (2 * REACH + 1)

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

static void each_texel_gets_its_taps_along_rows_and_columns(void **state)
{
    (void)state;
    const ptrdiff_t steps[] = { 1, PITCH };
    for (int index = 0; wr_taps_at(index); index++)
        for (int s = 0; s < 2; s++) {
            const float *centre = &heights[REACH][REACH];
            float sum[COUNT];
            wr_taps_at(index)->add(weights, REACH, centre, steps[s], COUNT, sum);
            for (int i = 0; i < COUNT; i++) {
                double exact = 0;
                for (int k = 1; k <= REACH; k++)
                    exact += (double)weights[k] *
                             ((double)centre[i - k * steps[s]] + (double)centre[i + k * steps[s]] -
                              2.0 * (double)centre[i]);
                /* 43 sums of at most 43/80 * 12 in float: each rounds by 2^-24 of it */
                assert_float_equal(sum[i], exact, 43 * 7 * 0x1p-23);
            }
        }
}

static void all_instruction_sets_give_the_same_bits_for_any_count_and_reach(void **state)
{
    (void)state;
    for (int index = 1; wr_taps_at(index); index++)
        for (int count = 1; count <= COUNT; count += count < 70 ? 1 : 7)
            for (int reach = 0; reach <= REACH; reach += 1 + reach / 3) {
                float plain[COUNT + 1], other[COUNT + 1];
                for (int i = 0; i <= COUNT; i++) plain[i] = other[i] = 77.0f;
                wr_taps_v1.add(weights, reach, &heights[REACH][REACH + 1], PITCH, count, plain);
                wr_taps_at(index)->add(weights, reach, &heights[REACH][REACH + 1], PITCH, count,
                                       other);
                assert_memory_equal(plain, other, sizeof plain);
                assert_true(other[count] == 77.0f); /* nothing beyond the count is written */
            }
}

static void smoothing_adds_the_sum_to_the_height(void **state)
{
    (void)state;
    const ptrdiff_t steps[] = { 1, PITCH };
    for (int index = 0; wr_taps_at(index); index++)
        for (int count = 1; count <= COUNT; count += count < 70 ? 1 : 7)
            for (int s = 0; s < 2; s++) {
                const float *centre = &heights[REACH][REACH + 2];
                float sum[COUNT], smooth[COUNT + 1];
                smooth[count] = 77.0f;
                wr_taps_v1.add(weights, REACH, centre, steps[s], count, sum);
                wr_taps_at(index)->smooth(weights, REACH, centre, steps[s], count, smooth);
                for (int i = 0; i < count; i++) assert_true(smooth[i] == centre[i] + sum[i]);
                assert_true(smooth[count] == 77.0f);
            }
}

static void a_flat_neighbourhood_adds_exactly_nothing(void **state)
{
    (void)state;
    float flat[512], sum[COUNT];
    for (int i = 0; i < 512; i++) flat[i] = 0.7f;
    for (int index = 0; wr_taps_at(index); index++) {
        wr_taps_at(index)->add(weights, REACH, flat + 100, 1, COUNT, sum);
        for (int i = 0; i < COUNT; i++) assert_true(sum[i] == 0.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_texel_gets_its_taps_along_rows_and_columns),
        cmocka_unit_test(all_instruction_sets_give_the_same_bits_for_any_count_and_reach),
        cmocka_unit_test(smoothing_adds_the_sum_to_the_height),
        cmocka_unit_test(a_flat_neighbourhood_adds_exactly_nothing),
    };
    return cmocka_run_group_tests(tests, fill, NULL);
}
