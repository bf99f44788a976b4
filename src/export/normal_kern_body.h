/* normal_kern_body.h - the loops of normal_kern.h, compiled once for each instruction set (wr_kern of
   CMakeLists.txt). Deliberately without a guard. */
#include "export/normal_kern.h"

#include <math.h>
#include <string.h>
#ifdef __SSSE3__
#include <immintrin.h>
#endif

#define HALVED 64 /* texels that are halved at once */
#define ALWAYS static inline __attribute__((always_inline))

static void widen(const float *restrict in, int count, double *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) out[i] = in[i];
}

/* Difference over three taps in a row or in a column, `step` apart. */
ALWAYS double difference(WrNormalStencil stencil, const double *at, ptrdiff_t step)
{
    return stencil == WR_STENCIL_FORWARD ? at[step] - at[0] : 0.5 * (at[step] - at[-step]);
}

ALWAYS double slope(WrNormalStencil stencil, const double *at, ptrdiff_t along, ptrdiff_t aside)
{
    if (stencil != WR_STENCIL_SPLINE) return difference(stencil, at, along);
    return (difference(stencil, at - aside, along) + 4.0 * difference(stencil, at, along) +
            difference(stencil, at + aside, along)) /
           6.0;
}

/* True for a power of two: multiplying by its inverse yields the quotient's bits, and is much faster. */
static bool is_power(double cell)
{
    int exponent;
    return frexp(cell, &exponent) == 0.5 && exponent > -500 && exponent < 500;
}

ALWAYS bool tilts_of(const WrNormalJob *job, WrNormalStencil stencil, bool divides,
                     const double *restrict at, ptrdiff_t pitch, int count, double *restrict x,
                     double *restrict y)
{
    double height = job->height, width = job->width, rows = job->rows;
    double cell_w = job->cell_w, cell_h = job->cell_h, over_w = 1.0 / cell_w, over_h = 1.0 / cell_h;
    double wild = 0.0;
#pragma omp simd reduction(+ : wild)
    for (int i = 0; i < count; i++) {
        /* z = height F over a cell of cell_w x cell_h: dz/dx = height F_u / cell_w and F_u = width dF/dtexel. Rows run down,
           v up, hence -rows for F_v. The order of the operations is that of the formula in double, so that all sets make the
           same bytes. */
        double tx = -height * (width * slope(stencil, at + i, 1, pitch));
        double ty = -height * (-rows * slope(stencil, at + i, pitch, 1));
        tx = divides ? tx / cell_w : tx * over_w;
        ty = divides ? ty / cell_h : ty * over_h;
        x[i] = tx;
        y[i] = ty;
        double far = fabs(tx) + fabs(ty); /* NaN if either is */
        wild += far < WR_NORMAL_PLAIN ? 0.0 : 1.0;
    }
    return wild == 0.0;
}

static bool tilts(const WrNormalJob *job, const double *at, ptrdiff_t pitch, int count, double *x,
                  double *y)
{
    bool divides = !is_power(job->cell_w) || !is_power(job->cell_h);
    switch (job->stencil) {
    case WR_STENCIL_FORWARD: return tilts_of(job, WR_STENCIL_FORWARD, true, at, pitch, count, x, y);
    case WR_STENCIL_SPLINE: return tilts_of(job, WR_STENCIL_SPLINE, true, at, pitch, count, x, y);
    case WR_STENCIL_CENTRAL: break;
    }
    return divides ? tilts_of(job, WR_STENCIL_CENTRAL, true, at, pitch, count, x, y)
                   : tilts_of(job, WR_STENCIL_CENTRAL, false, at, pitch, count, x, y);
}

/* round(last (n/2 + 1/2)) of a non-negative number. */
ALWAYS int32_t code_of(double last, double n)
{
    double x = last * (n / 2.0 + 0.5);
    int32_t whole = (int32_t)x;
    return whole + (x - whole >= 0.5 ? 1 : 0);
}

/* The three codes, in separate planes. */
ALWAYS void codes(const WrNormalJob *job, const double *restrict x, const double *restrict y,
                  int count, int32_t (*restrict plane)[WR_NORMAL_STRIP])
{
    double last = job->last, green = job->green;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        double inverse = 1.0 / sqrt(x[i] * x[i] + y[i] * y[i] + 1.0);
        plane[0][i] = code_of(last, x[i] * inverse);
        plane[1][i] = code_of(last, green * (y[i] * inverse));
        plane[2][i] = code_of(last, inverse);
    }
}

/* Packs three 8-bit codes per texel. */
ALWAYS void pack8(int32_t (*restrict plane)[WR_NORMAL_STRIP], int count, uint8_t *restrict out)
{
    int i = 0;
#ifdef __AVX512BW__
    /* Each 128-bit lane packs four 32-bit texels to 12 bytes; the compression then closes the gaps of 4 bytes between the
       lanes. */
    const __m512i three = _mm512_broadcast_i32x4(
        _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1));
    for (; i + 16 <= count; i += 16) {
        const __m512i red = _mm512_loadu_si512(plane[0] + i),
                      green = _mm512_loadu_si512(plane[1] + i);
        const __m512i blue = _mm512_slli_epi32(_mm512_loadu_si512(plane[2] + i), 16);
        const __m512i word =
            _mm512_or_si512(_mm512_or_si512(red, _mm512_slli_epi32(green, 8)), blue);
        const __m512i bytes = _mm512_shuffle_epi8(word, three);
        _mm512_mask_storeu_epi32(out + 3 * i, 0xfff, _mm512_maskz_compress_epi32(0x7777, bytes));
    }
#endif
    /* writes four bytes per texel; the next texel overwrites the last one */
    for (; i + 1 < count; i++) {
        uint32_t word =
            (uint32_t)plane[0][i] | (uint32_t)plane[1][i] << 8 | (uint32_t)plane[2][i] << 16;
        memcpy(out + 3 * i, &word, sizeof word);
    }
    for (int c = 0; c < 3 && i < count; c++) out[3 * i + c] = (uint8_t)plane[c][i];
}

static void codes8(const WrNormalJob *job, const double *x, const double *y, int count,
                   uint8_t *restrict out)
{
    int32_t plane[3][WR_NORMAL_STRIP];
    codes(job, x, y, count, plane);
    pack8(plane, count, out);
}

/* Normals' 8-bit codes in single precision, with a flag for codes that may be wrong
   (normal_kern.h, nearly8). Included only by normal_kern_body.h, once for each instruction set. Which codes are
   in doubt differs between them; the others are right. Deliberately without a guard.

   A component n becomes the float n 255/2 + 128 + 256, which is in [256, 512): its bits are the exponent, eight
   bits of code, rounded down, and FRACTION more. Its errors, with e = 2^-24: a tilt has the relative error 3 e
   (difference, factor, product), which moves n by 2.4 e at most, since the length changes too; the squared
   length's own roundings are 3 e of it, 1.5 e of n; root and quotient, or estimate and Newton's step, with 255/2
   times it 4 e; the product with the tilt 1 e. Together less than 9 e of a component, which is 2.3 units of
   2^-FRACTION of a code; the last sum is off by half a unit. */

#define FRACTION 15
#define NEAR 4.0f /* in doubt within this many units of an edge */
#define MIDDLE                                                                                     \
    (384.0f + NEAR / (1 << FRACTION)) /* so that near an edge the fraction is below 2 NEAR */
#define EDGE ((1 << FRACTION) - 8)    /* the fraction's bits that are then 0 */

/* A job's parameters in single precision. */
typedef struct Nearly {
    ptrdiff_t back, up; /* offsets from a texel to the first of the two texels of a difference */
    float to_x, to_y;   /* factor from difference to tilt */
} Nearly;

ALWAYS Nearly nearly_of(const WrNormalJob *job, ptrdiff_t pitch)
{
    const bool forward = job->stencil == WR_STENCIL_FORWARD;
    const double half = forward ? 1.0 : 0.5;
    return (Nearly){ forward ? 0 : 1, forward ? 0 : pitch,
                     (float)(-job->height * job->width * half / job->cell_w),
                     (float)(job->green * job->height * job->rows * half / job->cell_h) };
}

#ifdef __AVX512BW__

/* Three codes in the lower bytes of each number; the highest byte is undefined. */
ALWAYS __m512i word_of(__m512i red, __m512i green, __m512i blue)
{
    enum { A_WHERE_C_ELSE_B = 0xe4 };
    const __m512i pair = _mm512_ternarylogic_epi32(_mm512_srli_epi32(green, FRACTION - 8),
                                                   _mm512_srli_epi32(red, FRACTION),
                                                   _mm512_set1_epi32(0xff00), A_WHERE_C_ELSE_B);
    return _mm512_ternarylogic_epi32(_mm512_slli_epi32(blue, 16 - FRACTION), pair,
                                     _mm512_set1_epi32(0xff0000), A_WHERE_C_ELSE_B);
}

/* A tilt of 0 has an exact code: flat tables have many. */
ALWAYS __mmask16 unless_level(__m512i bits, __m512 tilt)
{
    const __mmask16 edge = _mm512_testn_epi32_mask(bits, _mm512_set1_epi32(EDGE));
    return _mm512_mask_cmp_ps_mask(edge, tilt, _mm512_setzero_ps(), _CMP_NEQ_UQ);
}

/* 16 texels; true if one is in doubt. */
ALWAYS bool near_block(const Nearly *job, const float *at, ptrdiff_t pitch, __m512i *word)
{
    const __m512 one = _mm512_set1_ps(1.0f), middle = _mm512_set1_ps(MIDDLE);
    const __m512i edge = _mm512_set1_epi32(EDGE);
    const __m512 x =
        _mm512_mul_ps(_mm512_sub_ps(_mm512_loadu_ps(at + 1), _mm512_loadu_ps(at - job->back)),
                      _mm512_set1_ps(job->to_x));
    const __m512 y =
        _mm512_mul_ps(_mm512_sub_ps(_mm512_loadu_ps(at + pitch), _mm512_loadu_ps(at - job->up)),
                      _mm512_set1_ps(job->to_y));
    const __m512 length2 = _mm512_fmadd_ps(x, x, _mm512_fmadd_ps(y, y, one));
    const __m512 root = _mm512_rsqrt14_ps(length2); /* accurate to 2^-14; a Newton step follows */
    const __m512 step = _mm512_fnmadd_ps(_mm512_mul_ps(length2, root),
                                         _mm512_mul_ps(root, _mm512_set1_ps(127.5f * 0.5f)),
                                         _mm512_set1_ps(127.5f * 1.5f));
    const __m512 scale = _mm512_mul_ps(root, step);
    const __m512i red = _mm512_castps_si512(_mm512_fmadd_ps(x, scale, middle));
    const __m512i green = _mm512_castps_si512(_mm512_fmadd_ps(y, scale, middle));
    const __m512i blue = _mm512_castps_si512(_mm512_add_ps(scale, middle));
    const __mmask16 certain = _mm512_mask_test_epi32_mask(
        _mm512_mask_test_epi32_mask(_mm512_test_epi32_mask(blue, edge), red, edge), green, edge);
    *word = word_of(red, green, blue);
    if (__builtin_expect(certain == 0xffff, 1)) return false;
    return (_mm512_testn_epi32_mask(blue, edge) | unless_level(red, x) | unless_level(green, y)) !=
           0;
}

/* Stores the lower three bytes of 16 numbers, 48 in all. */
ALWAYS void put_words(__m512i word, uint8_t *out)
{
    const __m512i three = _mm512_broadcast_i32x4(
        _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1));
    const __m512i first = _mm512_setr_epi32(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 15, 15, 15, 15);
    const __m512i bytes = _mm512_permutexvar_epi32(first, _mm512_shuffle_epi8(word, three));
    _mm256_storeu_si256((__m256i *)(void *)out, _mm512_castsi512_si256(bytes));
    _mm_storeu_si128((__m128i *)(void *)(out + 32), _mm512_extracti32x4_epi32(bytes, 2));
}

static uint32_t nearly8(const WrNormalJob *given, const float *restrict at, ptrdiff_t pitch,
                        int count, uint8_t *restrict out)
{
    const Nearly job = nearly_of(given, pitch);
    uint32_t doubtful = 0;
    for (int k = 0; k < count / WR_NORMAL_BLOCK; k++, at += WR_NORMAL_BLOCK) {
        __m512i word;
        if (near_block(&job, at, pitch, &word)) doubtful |= 1u << k;
        put_words(word, out + (size_t)3 * WR_NORMAL_BLOCK * (size_t)k);
    }
    return doubtful;
}

#else

ALWAYS uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* A tilt of 0 has an exact code: flat tables have many. */
ALWAYS uint32_t in_doubt(uint32_t bits, bool asked)
{
    return asked & ((bits & EDGE) == 0);
}

ALWAYS void near_words(const Nearly *job, const float *restrict at, ptrdiff_t pitch, int count,
                       uint32_t *restrict word, uint32_t *restrict doubts)
{
    const ptrdiff_t back = job->back, up = job->up;
    const float to_x = job->to_x, to_y = job->to_y;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const float x = to_x * (at[i + 1] - at[i - back]), y = to_y * (at[i + pitch] - at[i - up]);
        const float length2 = x * x + y * y + 1.0f, scale = 127.5f * (1.0f / sqrtf(length2));
        const uint32_t red = bits_of(x * scale + MIDDLE), green = bits_of(y * scale + MIDDLE);
        const uint32_t blue = bits_of(scale + MIDDLE);
        word[i] = (red >> FRACTION & 0xff) | (green >> (FRACTION - 8) & 0xff00) |
                  (blue << (16 - FRACTION) & 0xff0000);
        doubts[i] = in_doubt(red, x != 0.0f) | in_doubt(green, y != 0.0f) | in_doubt(blue, true);
    }
}

/* Stores the lower three bytes of each number; their count is a multiple of four. */
ALWAYS void put_words(const uint32_t *restrict word, int count, uint8_t *restrict out)
{
    int i = 0;
#ifdef __SSSE3__
    const __m128i three = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
    for (; i + 8 <= count; i += 4) { /* four bytes too many, overwritten by the next store */
        const __m128i four = _mm_loadu_si128((const __m128i *)(const void *)(word + i));
        _mm_storeu_si128((__m128i *)(void *)(out + 3 * i), _mm_shuffle_epi8(four, three));
    }
#endif
    for (; i + 1 < count; i++) memcpy(out + 3 * i, word + i, sizeof *word); /* one byte too many */
    for (int c = 0; c < 3 && i < count; c++) out[3 * i + c] = (uint8_t)(word[i] >> 8 * c);
}

/* True if a number of the block is not 0. Inside the loop that computes them, this reduction would prevent
   vectorisation. */
ALWAYS bool any_of(const uint32_t *restrict lane)
{
    uint64_t pair[WR_NORMAL_BLOCK / 2];
    memcpy(pair, lane, sizeof pair);
    return ((pair[0] | pair[1]) | (pair[2] | pair[3])) |
           ((pair[4] | pair[5]) | (pair[6] | pair[7]));
}

static uint32_t nearly8(const WrNormalJob *given, const float *restrict at, ptrdiff_t pitch,
                        int count, uint8_t *restrict out)
{
    const Nearly job = nearly_of(given, pitch);
    const int blocks = count / WR_NORMAL_BLOCK, whole = blocks * WR_NORMAL_BLOCK;
    uint32_t word[WR_NORMAL_STRIP], doubts[WR_NORMAL_STRIP], doubtful = 0;
    near_words(&job, at, pitch, whole, word, doubts);
    put_words(word, whole, out);
    for (int k = 0; k < blocks; k++)
        doubtful |= (uint32_t)any_of(doubts + k * WR_NORMAL_BLOCK) << k;
    return doubtful;
}

#endif
#undef MIDDLE
#undef FRACTION
#undef NEAR
#undef EDGE

static void codes16(const WrNormalJob *job, const double *x, const double *y, int count,
                    uint16_t *restrict out)
{
    int32_t plane[3][WR_NORMAL_STRIP];
    codes(job, x, y, count, plane);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) out[3 * i + c] = (uint16_t)plane[c][i];
}

static void floats(const WrNormalJob *job, const double *restrict x, const double *restrict y,
                   int count, float *restrict out)
{
    float plane[3][WR_NORMAL_STRIP];
    double green = job->green;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        double inverse = 1.0 / sqrt(x[i] * x[i] + y[i] * y[i] + 1.0);
        plane[0][i] = (float)(x[i] * inverse / 2.0 + 0.5);
        plane[1][i] = (float)(green * (y[i] * inverse) / 2.0 + 0.5);
        plane[2][i] = (float)(inverse / 2.0 + 0.5);
    }
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) out[3 * i + c] = plane[c][i];
}

/* Two floats side by side, the first in the lower half, for one 64-bit store. */
ALWAYS uint64_t pair_of(float low, float high)
{
    uint32_t a, b;
    memcpy(&a, &low, sizeof a);
    memcpy(&b, &high, sizeof b);
    return (uint64_t)b << 32 | a;
}

static bool moments(const float *restrict f, const double *restrict s, const double *restrict t,
                    int count, float most, double steepest, float *restrict out)
{
    uint64_t pair[3][WR_NORMAL_STRIP];
    int wild = 0;
#pragma omp simd reduction(+ : wild)
    for (int i = 0; i < count; i++) {
        const double x = s[i], y = t[i];
        const float right = (float)x, down = (float)y;
        pair[0][i] = pair_of(f[i], right);
        pair[1][i] = pair_of(down, (float)(x * x));
        pair[2][i] = pair_of((float)(y * y), (float)(x * y));
        wild += ((fabsf(f[i]) <= most) & (fabs(x) <= steepest) & (fabs(y) <= steepest)) ? 0 : 1;
    }
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) memcpy(out + 6 * i + 2 * c, &pair[c][i], sizeof pair[c][i]);
    return wild == 0;
}

/* In runs and two loops: of one loop the compiler would make branches in place of vectors. */
static int64_t codes_of(const WrMapCodes *given, const float *restrict x, int count,
                        int32_t *restrict out)
{
    enum { RUN = 64 };
    const WrMapCodes c = *given;
    const int32_t zero = (int32_t)c.zero, last = (int32_t)c.last;
    int32_t outside = 0;
    for (int from = 0; from < count; from += RUN, x += RUN, out += RUN) {
        const int now = count - from < RUN ? count - from : RUN;
        double steps[RUN];
#pragma omp simd reduction(+ : outside)
        for (int i = 0; i < now; i++) {
            const double number = x[i], exact = c.times * (number - c.less) / c.by;
            /* clamped values are far outside all codes */
            const double least = exact > -0x1p20 ? exact : -0x1p20;
            steps[i] = least < 0x1p20 ? least : 0x1p20;
            outside += (number < c.low) | (number > c.high);
        }
#pragma omp simd
        for (int i = 0; i < now; i++) {
            const int32_t whole = (int32_t)steps[i];
            const double part = steps[i] - (double)whole;
            const int32_t code = zero + whole + (part >= 0.5) - (part <= -0.5);
            const int32_t positive = code > 0 ? code : 0;
            out[i] = positive < last ? positive : last;
        }
    }
    return outside;
}

static void halve(const float *restrict a, const float *restrict b, int count, float *restrict out)
{
    double sum[12 * HALVED];
    for (int x = 0; x < count; x += HALVED) {
        const int now = count - x < HALVED ? count - x : HALVED;
        const float *restrict p = a + 12 * (ptrdiff_t)x, *restrict q = b + 12 * (ptrdiff_t)x;
#pragma omp simd
        for (int i = 0; i < 12 * now; i++) sum[i] = 0.5 * (double)p[i] + 0.5 * (double)q[i];
        for (int i = 0; i < now; i++)
#pragma omp simd
            for (int c = 0; c < 6; c++)
                out[6 * (x + i) + c] = (float)(0.5 * sum[12 * i + c] + 0.5 * sum[12 * i + 6 + c]);
    }
}

const WrNormalKernels WR_SET_TABLE = {
    .name = WR_SET_NAME,
    .widen = widen,
    .tilts = tilts,
    .codes8 = codes8,
    .codes16 = codes16,
    .nearly8 = nearly8,
    .floats = floats,
    .moments = moments,
    .codes_of = codes_of,
    .halve = halve,
};
