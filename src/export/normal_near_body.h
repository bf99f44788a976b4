/* normal_near_body.h - normals' 8-bit codes in single precision, with a flag for codes that may be wrong
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
