/* Inner loops of normal maps: every instruction set against the formulas, one texel at a time. */
#include "test.h"

#include "export/normal_kern.h"

#define COUNT WR_NORMAL_STRIP
#define PITCH (COUNT + 5)

static float texels[3][PITCH];
static double taps[3][PITCH];

static void fill(double size, uint64_t seed)
{
    TestRandom random = { seed };
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < PITCH; i++) {
            texels[j][i] = (float)((test_random(&random) - 0.5) * size);
            taps[j][i] = texels[j][i];
        }
}

static double step(WrNormalStencil stencil, int j, int i, int dj, int di)
{
    return stencil == WR_STENCIL_FORWARD ? taps[j + dj][i + di] - taps[j][i]
                                         : 0.5 * (taps[j + dj][i + di] - taps[j - dj][i - di]);
}

static void tilt(const WrNormalJob *job, int i, double *x, double *y)
{
    double right = step(job->stencil, 1, i, 0, 1), down = step(job->stencil, 1, i, 1, 0);
    if (job->stencil == WR_STENCIL_SPLINE) {
        right =
            (step(job->stencil, 0, i, 0, 1) + 4.0 * right + step(job->stencil, 2, i, 0, 1)) / 6.0;
        down =
            (step(job->stencil, 1, i - 1, 1, 0) + 4.0 * down + step(job->stencil, 1, i + 1, 1, 0)) /
            6.0;
    }
    *x = -job->height * (job->width * right) / job->cell_w;
    *y = -job->height * (-job->rows * down) / job->cell_h;
}

/* Value of a code, except at the border between two. */
static void check_code(int code, long double last, long double n)
{
    long double exact = last * (n / 2 + 0.5L), part = exact - floorl(exact);
    if (fabsl(part - 0.5L) > 1e-9L) assert_int_equal(code, (int)floorl(exact + 0.5L));
}

static void check_codes(const WrNormalKernels *kern, WrNormalJob *job, const double *x,
                        const double *y, int count)
{
    uint8_t bytes[3 * COUNT + 1];
    uint16_t words[3 * COUNT + 1];
    float floats[3 * COUNT + 1];
    bytes[3 * count] = 77, words[3 * count] = 777, floats[3 * count] = 7.0f;
    job->last = 255.0;
    kern->codes8(job, x, y, count, bytes);
    job->last = 65535.0;
    kern->codes16(job, x, y, count, words);
    kern->floats(job, x, y, count, floats);
    for (int i = 0; i < count; i++) {
        long double length = sqrtl((long double)x[i] * x[i] + (long double)y[i] * y[i] + 1.0L);
        const long double n[3] = { x[i] / length, job->green * (y[i] / length), 1.0L / length };
        for (int c = 0; c < 3; c++) {
            check_code(bytes[3 * i + c], 255.0L, n[c]);
            check_code(words[3 * i + c], 65535.0L, n[c]);
            assert_near(floats[3 * i + c], (double)(n[c] / 2 + 0.5L), 0x1p-24);
        }
    }
    assert_true(bytes[3 * count] == 77 && words[3 * count] == 777 && floats[3 * count] == 7.0f);
}

static void tilts_and_codes_are_their_formulas_for_any_count(void **state)
{
    (void)state;
    static const double cells[][2] = { { 1, 1 }, { 2, 0.25 }, { 1, 0.7 }, { 3, 1 } };
    static const double sizes[] = { 1e-40, 1e-6, 1.0, 1e30 };
    for (int index = 0; wr_normal_kernels_at(index); index++)
        for (int stencil = 0; stencil < 3; stencil++)
            for (int k = 0; k < 16; k++)
                for (int count = 1; count <= COUNT; count += count < 40 ? 1 : 31) {
                    const WrNormalKernels *kern = wr_normal_kernels_at(index);
                    WrNormalJob job = { .stencil = (WrNormalStencil)stencil,
                                        .height = 0.3,
                                        .cell_w = cells[k % 4][0],
                                        .cell_h = cells[k % 4][1],
                                        .width = 100,
                                        .rows = 33,
                                        .green = k % 3 ? -1.0 : 1.0 };
                    double x[COUNT], y[COUNT], wide[PITCH];
                    fill(sizes[k / 4], (uint64_t)k);
                    kern->widen(texels[1], PITCH, wide);
                    assert_memory_equal(wide, taps[1], sizeof wide);
                    assert_true(kern->tilts(&job, &taps[1][2], PITCH, count, x, y));
                    for (int i = 0; i < count; i++) {
                        double right, up;
                        tilt(&job, i + 2, &right, &up);
                        assert_true(same_bits(x[i], right) && same_bits(y[i], up));
                    }
                    check_codes(kern, &job, x, y, count);
                }
}

/* At any position within the count. */
static void one_slope_beyond_all_bounds_is_told(void **state)
{
    (void)state;
    const double bad[] = { NAN, INFINITY, -INFINITY, 1e300, -1e101 };
    for (int index = 0; wr_normal_kernels_at(index); index++)
        for (int at = 0; at < 40; at++)
            for (int k = 0; k < 5; k++) {
                WrNormalJob job = { .height = 1, .cell_w = 1, .cell_h = 1, .width = 1, .rows = 1 };
                double x[COUNT], y[COUNT];
                fill(1.0, 3);
                taps[1][at + 3] = bad[k]; /* to the right of texel at */
                assert_false(
                    wr_normal_kernels_at(index)->tilts(&job, &taps[1][2], PITCH, at + 1, x, y));
                if (at > 0)
                    assert_true(
                        wr_normal_kernels_at(index)->tilts(&job, &taps[1][2], PITCH, at, x, y));
            }
}

/* Number of uncertain blocks among the texels of a row from the third on; the others have the formula's codes. */
static int check_near(const WrNormalKernels *kern, const WrNormalJob *job, int count)
{
    uint8_t bytes[3 * COUNT + 1];
    const int whole = count / WR_NORMAL_BLOCK;
    bytes[3 * count] = 77;
    const uint32_t doubtful = kern->nearly8(job, &texels[1][2], PITCH, count, bytes);
    assert_true(bytes[3 * count] == 77 && (uint64_t)doubtful >> whole == 0);
    int doubts = 0;
    for (int k = 0; k < whole; k++) doubts += doubtful >> k & 1;
    for (int i = 0; i < whole * WR_NORMAL_BLOCK; i++) {
        double x, y;
        if (doubtful >> i / WR_NORMAL_BLOCK & 1) continue;
        tilt(job, i + 2, &x, &y);
        long double length = sqrtl((long double)x * x + (long double)y * y + 1.0L);
        check_code(bytes[3 * i], 255.0L, x / length);
        check_code(bytes[3 * i + 1], 255.0L, job->green * (y / length));
        check_code(bytes[3 * i + 2], 255.0L, 1.0L / length);
    }
    return doubts;
}

static void codes_in_single_precision_are_right_or_in_doubt(void **state)
{
    (void)state;
    for (int index = 0; wr_normal_kernels_at(index); index++)
        for (int k = 0; k < 200; k++) {
            const WrNormalKernels *kern = wr_normal_kernels_at(index);
            WrNormalJob job = { .stencil = k % 2 ? WR_STENCIL_CENTRAL : WR_STENCIL_FORWARD,
                                .height = 0.31,
                                .cell_w = 1,
                                .cell_h = 0.7,
                                .width = 100,
                                .rows = 33,
                                .last = 255,
                                .green = k % 3 ? -1.0 : 1.0 };
            const int count = COUNT - k % 37, blocks = count / WR_NORMAL_BLOCK;
            fill(k % 4 ? 0.07 : 5.0, (uint64_t)k); /* ordinary, and nearly vertical */
            assert_true(check_near(kern, &job, count) < blocks / 2);
            /* in the support of that block and its two neighbours */
            texels[1][2 + 16] = k % 8 < 4 ? INFINITY : NAN;
            assert_true(check_near(kern, &job, count) >= 1);
            fill(1e30, (uint64_t)k); /* their squares overflow float */
            assert_int_equal(check_near(kern, &job, count), blocks);
            fill(0.0, 0); /* level: codes must be certain, since such texels are frequent */
            assert_int_equal(check_near(kern, &job, count), 0);
        }
}

/* Heights for which the first or second component of one texel in sixteen is within a few hundred-thousandths of the
 * border between two codes. */
static void fill_near_edges(const WrNormalJob *job, bool second, TestRandom *random)
{
    const double to[2] = { job->height * job->width / 2 / job->cell_w,
                           job->height * job->rows / 2 / job->cell_h };
    memset(texels, 0, sizeof texels);
    for (int i = 2 + (int)(test_random(random) * 16); i < COUNT; i += 16) {
        const double code = floor(20 + 215 * test_random(random)) + 0.5;
        const double n = 2 * (code + (test_random(random) - 0.5) * 2e-4) / 255 - 1;
        const double other = test_random(random) * 3 - 1;
        const double own = n * sqrt((1 + other * other) / (1 - n * n));
        texels[1][i + 1] = (float)(-(second ? other : own) / to[0]);
        texels[2][i] = (float)(job->green * (second ? own : other) / to[1]);
    }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < PITCH; i++) taps[j][i] = texels[j][i];
}

static void codes_beside_the_edges_between_them_are_right_or_in_doubt(void **state)
{
    (void)state;
    TestRandom random = { 77 };
    for (int index = 0; wr_normal_kernels_at(index); index++)
        for (int k = 0; k < 300; k++) {
            const WrNormalJob job = { .stencil = WR_STENCIL_CENTRAL,
                                      .height = 0.37,
                                      .cell_w = 1.3,
                                      .cell_h = 1,
                                      .width = 211,
                                      .rows = 97,
                                      .last = 255,
                                      .green = k % 3 ? -1.0 : 1.0 };
            fill_near_edges(&job, k % 2, &random);
            check_near(wr_normal_kernels_at(index), &job, COUNT);
        }
}

/* The six moments of bump slopes, and means of four, for every instruction set; overflows are reported. */
static void moments_are_products_and_their_means(void **state)
{
    (void)state;
    TestRandom random = { 154 };
    float f[COUNT], six[6 * COUNT + 1], below[6 * COUNT], mean[6 * COUNT / 2 + 1];
    double s[COUNT], t[COUNT];
    for (int i = 0; i < COUNT; i++) {
        f[i] = (float)(test_random(&random) * 9 - 4);
        s[i] = test_random(&random) * 3 - 2, t[i] = test_random(&random) * 5 - 2;
    }
    for (int i = 0; i < 6 * COUNT; i++) below[i] = (float)(test_random(&random) * 7 - 3);
    for (int n = 0; n < 3; n++) {
        const WrNormalKernels *kern = wr_normal_kernels_at(n);
        for (int count = 2; kern && count <= COUNT; count += 2 + count / 3 * 2) {
            six[6 * count] = mean[3 * count] = 77;
            assert_true(kern->moments(f, s, t, count, 3e38f, 0x1p63, six));
            kern->halve(six, below, count / 2, mean);
            assert_true(six[6 * count] == 77 && mean[3 * count] == 77);
            for (int i = 0; i < count; i++) {
                const double want[6] = { (double)f[i], s[i],        t[i],
                                         s[i] * s[i],  t[i] * t[i], s[i] * t[i] };
                for (int c = 0; c < 6; c++) assert_true(six[6 * i + c] == (float)want[c]);
            }
            for (int i = 0; i < 3 * count; i++) {
                const int at = i / 6 * 12 + i % 6;
                const long double sum = (long double)six[at] + (long double)six[at + 6] +
                                        (long double)below[at] + (long double)below[at + 6];
                assert_true(mean[i] == (float)(double)(sum / 4));
            }
        }
        if (!kern) continue;
        const double wild[] = { NAN, INFINITY, 0x1.8p63, -0x1.8p63 };
        for (int k = 0; k < 12; k++) {
            const int at = 5 * k;
            const float kept = f[at];
            const double kept_s = s[at], kept_t = t[at];
            if (k % 3 == 0) f[at] = k < 6 ? (float)wild[k / 3] : 3.2e38f;
            if (k % 3 == 1) s[at] = wild[k / 3];
            if (k % 3 == 2) t[at] = wild[k / 3];
            assert_false(kern->moments(f, s, t, 61, 3e38f, 0x1p63, six));
            f[at] = kept, s[at] = kept_s, t[at] = kept_t;
        }
    }
}

/* Codes rounded by the C library: numbers at the border between two codes, extreme numbers, random numbers; clamped
   values are counted. */
static void codes_of_numbers_are_rounded_cut_and_counted(void **state)
{
    (void)state;
    static const WrMapCodes kinds[] = {
        { 255, -0.31, 1.73, 0, 255, -0.31, 1.42 },
        { 127, 0, 0.77, 128, 255, -0.77, 0.77 },
        { 65535, 0.2, 3.1, 0, 65535, 0.2, 3.3 },
        { 32767, 0, 9, 32768, 65535, -9, 9 },
        { 255, -4, 510, 0, 255, -4, 506 } /* halves */,
        { 127, 0, 254, 128, 255, -254, 254 }, /* of both signs */
        { 0, 0, 1, 128, 255, 0, 0 }           /* all are 0 */
    };
    TestRandom random = { 99 };
    for (int index = 0; wr_normal_kernels_at(index); index++)
        for (int k = 0; k < 7 * 36; k++) {
            const WrMapCodes *c = &kinds[k % 7];
            const int count = 1 + (k * 7) % COUNT;
            float x[COUNT];
            int32_t code[COUNT + 1];
            int64_t outside = 0;
            for (int i = 0; i < count; i++) {
                const double any = c->low + (1.2 * test_random(&random) - 0.1) * (c->high - c->low);
                x[i] = k % 7 == 4 || k % 7 == 5 ? (float)floor(any) : (float)any;
                if (i % 31 == 7) x[i] = i % 2 ? 3e38f : -3e38f;
                if (i % 17 == 3) x[i] = (float)c->high;
            }
            code[count] = 77;
            const int64_t told = wr_normal_kernels_at(index)->codes_of(c, x, count, code);
            for (int i = 0; i < count; i++) {
                const double number = x[i];
                const double want = c->zero + round(c->times * (number - c->less) / c->by);
                assert_int_equal(code[i], (int)fmin(fmax(want, 0), c->last));
                outside += number < c->low || number > c->high;
            }
            assert_true(told == outside && code[count] == 77);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tilts_and_codes_are_their_formulas_for_any_count),
        cmocka_unit_test(one_slope_beyond_all_bounds_is_told),
        cmocka_unit_test(codes_in_single_precision_are_right_or_in_doubt),
        cmocka_unit_test(codes_beside_the_edges_between_them_are_right_or_in_doubt),
        cmocka_unit_test(moments_are_products_and_their_means),
        cmocka_unit_test(codes_of_numbers_are_rounded_cut_and_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
