/* The noise's inner loops: every instruction set of this processor is bit-identical to the plain one. */
#include "test.h"

#include "noise/octave_kernels.h"

#include <math.h>
#include <string.h>

static WrOctave octave_of(WrNoiseKind kind, WrFade fade, double cells)
{
    WrOctave octave = { .noise = { .kind = kind, .fade = fade, .dim = 2 } };
    octave.noise.lattice = (WrLattice){ .seed = 5, .period = { (int)cells, (int)cells } };
    octave.frequency[0] = octave.frequency[1] = cells;
    octave.offset[0] = 0.37;
    return octave;
}

/* All processing of a row of texels, with one set. */
typedef struct Made {
    WrNoiseColumns columns;
    WrNoiseLattice near, far;
    WrNoiseBlended blended;
    float f[WR_NOISE_STRIP], fx[WR_NOISE_STRIP], fy[WR_NOISE_STRIP];
    float sum[WR_NOISE_STRIP], magnitudes[WR_NOISE_STRIP];
} Made;

static void make(const WrNoiseKernels *kern, const WrOctave *octave, int i, int width, int count,
                 Made *made)
{
    memset(made, 0, sizeof *made);
    WrNoiseColumns *columns = &made->columns;
    columns->count = count;
    columns->narrow = 2.0 * octave->frequency[0] <= width;
    kern->place(&wr_fades[octave->noise.fade], octave->frequency[0], octave->offset[0], i, width,
                columns);
    columns->points = columns->cell[count - 1] + 2;
    for (int k = 0; k < columns->points; k++)
        columns->chain[k] = wr_mix32((uint32_t)k + (uint32_t)(int)columns->first);
    for (int k = 0; k < 16; k++) {
        columns->set[0][k] = 0.1f * (float)k - 0.7f;
        columns->set[1][k] = 0.9f - 0.13f * (float)k;
    }
    kern->prescribe(octave->noise.kind, columns, 12345, &made->near);
    kern->prescribe(octave->noise.kind, columns, 99, &made->far);
    kern->blend(columns->points, &made->near, &made->far, 0.3f, 0.22f, 1.4f, &made->blended);
    kern->heights(columns, &made->blended, made->f);
    kern->slopes(columns, &made->blended, made->fx, made->fy);
    kern->add(0.25f, made->f, count, made->sum);
    kern->add_magnitude(0.5f, 0.25f, made->f, count, made->magnitudes);
}

static void assert_same_row(const Made *a, const Made *b)
{
    size_t bytes = sizeof *a->f * (size_t)a->columns.count;
    assert_int_equal(a->columns.points, b->columns.points);
    assert_memory_equal(a->f, b->f, bytes);
    assert_memory_equal(a->fx, b->fx, bytes);
    assert_memory_equal(a->fy, b->fy, bytes);
    assert_memory_equal(a->sum, b->sum, sizeof a->sum);
    assert_memory_equal(a->magnitudes, b->magnitudes, sizeof a->magnitudes);
}

/* From cells that span the strip to one cell per texel, where gather from few vectors is not possible. */
static void all_instruction_sets_give_the_same_bits(void **state)
{
    (void)state;
    static const WrNoiseKind kinds[] = { WR_NOISE_VALUE, WR_NOISE_GRADIENT, WR_NOISE_PERLIN };
    static const int cells[] = { 1, 2, 7, 64, 127, 255, 256, 257, 511, 512 };
    static Made plain, other;
    for (int index = 1; wr_noise_kernels_at(index); index++)
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 10; c++)
                for (int count = 1; count <= WR_NOISE_STRIP; count++) {
                    WrOctave octave = octave_of(kinds[k], (WrFade)(count % 3), cells[c]);
                    int i = count * 7 % (512 - WR_NOISE_STRIP);
                    make(&wr_noise_kernels_v1, &octave, i, 512, count, &plain);
                    make(wr_noise_kernels_at(index), &octave, i, 512, count, &other);
                    assert_same_row(&plain, &other);
                }
}

static void the_plain_set_is_always_there_and_the_best_one_is_among_them(void **state)
{
    (void)state;
    bool found = false;
    assert_ptr_equal(wr_noise_kernels_at(0), &wr_noise_kernels_v1);
    for (int index = 0; wr_noise_kernels_at(index); index++)
        found |= wr_noise_kernels_at(index) == wr_noise_kernels();
    assert_true(found);
}

/* Fused addition of rows of texels, against the separate steps with the plain set. */
static void counting_rows_in_at_once_gives_the_bits_of_the_steps(void **state)
{
    (void)state;
    static const int cells[] = { 1, 7, 50, 64, 110, 127, 200, 255, 256 };
    static Made made;
    static WrNoiseRows rows;
    for (int index = 0; wr_noise_kernels_at(index); index++)
        for (int c = 0; c < 9; c++)
            for (int count = 1; count <= WR_NOISE_STRIP; count += count < 20 ? 1 : 11) {
                const WrNoiseKernels *kern = wr_noise_kernels_at(index);
                WrOctave octave = octave_of(WR_NOISE_GRADIENT, WR_FADE_QUINTIC, cells[c]);
                make(&wr_noise_kernels_v1, &octave, count * 5, 512, count, &made);
                assert_true(made.columns.narrow);
                rows.count = 9;
                kern->stand(&wr_fades[WR_FADE_CUBIC], cells[c], 0.21, 100, 333, &rows);
                for (int m = 0; m < 2; m++) {
                    float sums[9][WR_NOISE_STRIP + 1], steps[9][WR_NOISE_STRIP + 1];
                    WrNoiseShare share = { .factor = 0.3f, .below = 0.1f, .magnitude = m };
                    for (int k = 0; k < 9 * (WR_NOISE_STRIP + 1); k++)
                        sums[k / (WR_NOISE_STRIP + 1)][k % (WR_NOISE_STRIP + 1)] = (float)k * 0.01f;
                    memcpy(steps, sums, sizeof steps);
                    kern->sum(&made.columns, &made.near, &made.far, &rows, 2, 5, share, sums[2],
                              WR_NOISE_STRIP + 1);
                    for (int j = 2; j < 7; j++) {
                        const WrNoiseKernels *plain = &wr_noise_kernels_v1;
                        plain->blend(made.columns.points, &made.near, &made.far, rows.y[j],
                                     rows.alpha[j], rows.rate[j], &made.blended);
                        plain->heights(&made.columns, &made.blended, made.f);
                        if (m) plain->add_magnitude(0.3f, 0.1f, made.f, count, steps[j]);
                        else plain->add(0.3f, made.f, count, steps[j]);
                    }
                    assert_memory_equal(sums, steps, sizeof sums);
                }
            }
}

/* Positions of rows, and heights scaled to their range. */
static void rows_and_scales_are_their_formulas(void **state)
{
    (void)state;
    static WrNoiseRows rows;
    for (int index = 0; wr_noise_kernels_at(index); index++)
        for (int count = 1; count <= WR_NOISE_BAND; count++) {
            rows.count = count;
            wr_noise_kernels_at(index)->stand(&wr_fades[WR_FADE_QUINTIC], 37, 0.21, 100, 333,
                                              &rows);
            float f[WR_NOISE_BAND + 1];
            for (int k = 0; k <= count; k++) f[k] = (float)k * 0.37f - 3.0f;
            wr_noise_kernels_at(index)->scale(0.1, 1e30, count, f);
            for (int k = 0; k < count; k++) {
                double t = 37 * (1.0 - (100 + k + 0.5) / 333) + 0.21, y = t - floor(t);
                assert_true(rows.whole[k] == floor(t) && rows.y[k] == (float)y);
                assert_true(rows.alpha[k] == (float)wr_fade_value(&wr_fades[WR_FADE_QUINTIC], y));
                assert_true(f[k] == (float)(0.1 + 1e30 * (double)((float)k * 0.37f - 3.0f)));
            }
            assert_true(f[count] == (float)count * 0.37f - 3.0f);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_instruction_sets_give_the_same_bits),
        cmocka_unit_test(the_plain_set_is_always_there_and_the_best_one_is_among_them),
        cmocka_unit_test(counting_rows_in_at_once_gives_the_bits_of_the_steps),
        cmocka_unit_test(rows_and_scales_are_their_formulas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
