/* simd_vector_body.h - vector type of register width, with its operations, for hand-written kernels. Compilers
   do not generate reciprocal roots of 16 numbers or table look-ups in registers. Part of simd_set_body.h,
   for which the build sets the flags of an instruction set; without one there are no such kernels. A vector has
   WIDE numbers; a mask has one lane for each. Deliberately without a guard. */
#include "render/simd/simd_kernels.h"

#define ALWAYS static inline __attribute__((always_inline))
#ifdef __AVX2__
#include <immintrin.h>

#ifdef __AVX512DQ__
#define WIDE 16
typedef __m512 Wide;
typedef __m512i WideInt;
typedef __mmask16 WideMask;

ALWAYS Wide w_all(float x)
{
    return _mm512_set1_ps(x);
}
ALWAYS Wide w_load(const float *from)
{
    return _mm512_loadu_ps(from);
}
ALWAYS void w_store(float *to, Wide a)
{
    _mm512_storeu_ps(to, a);
}
ALWAYS Wide w_max(Wide a, Wide b)
{
    return _mm512_max_ps(a, b);
}
ALWAYS Wide w_min(Wide a, Wide b)
{
    return _mm512_min_ps(a, b);
}
ALWAYS WideMask w_less(Wide a, Wide b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
ALWAYS WideMask w_both(WideMask a, WideMask b)
{
    return a & b;
}
ALWAYS bool w_any(WideMask a)
{
    return a != 0;
}
/* a in the lanes of the mask, else 0. */
ALWAYS Wide w_kept(WideMask mask, Wide a)
{
    return _mm512_maskz_mov_ps(mask, a);
}
/* a in the lanes of the mask, else b. */
ALWAYS Wide w_pick(WideMask mask, Wide a, Wide b)
{
    return _mm512_mask_mov_ps(b, mask, a);
}
/* Bit k is lane k. */
ALWAYS unsigned w_bits(WideMask mask)
{
    return mask;
}
ALWAYS Wide w_abs(Wide a)
{
    return _mm512_abs_ps(a);
}
/* a in the lanes of the bits `of`, else b.
   The bits of w_bits; among lanes beyond the end of a strip, b keeps sums and maxima unchanged. */
ALWAYS Wide w_among(unsigned of, Wide a, Wide b)
{
    return _mm512_mask_mov_ps(b, (__mmask16)of, a);
}
/* Maximum of all lanes. */
ALWAYS float w_largest(Wide a)
{
    return _mm512_reduce_max_ps(a);
}
/* |a| with the sign of b. */
ALWAYS Wide w_signed(Wide a, Wide b)
{
    return _mm512_or_ps(_mm512_abs_ps(a), _mm512_and_ps(b, _mm512_set1_ps(-0.0f)));
}
/* 0, 1, 2 .. */
ALWAYS Wide w_count(void)
{
    return _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
ALWAYS void w_store_counted(int *to, int first)
{
    const __m512i count = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    _mm512_storeu_si512(to, _mm512_add_epi32(count, _mm512_set1_epi32(first)));
}
ALWAYS WideMask w_either(WideMask a, WideMask b)
{
    return a | b;
}
/* Truncates towards 0. */
ALWAYS WideInt w_whole(Wide a)
{
    return _mm512_cvttps_epi32(a);
}
ALWAYS WideInt w_load_int(const int32_t *from)
{
    return _mm512_loadu_si512(from);
}
ALWAYS void w_store_int(int32_t *to, WideInt a)
{
    _mm512_storeu_si512(to, a);
}
/* Stores the first lanes, those in the bits `of`. */
ALWAYS void w_store_some(int32_t *to, unsigned of, WideInt a)
{
    _mm512_mask_storeu_epi32(to, (__mmask16)of, a);
}
/* Infinite or NaN. */
ALWAYS WideMask w_odd(Wide a)
{
    return _mm512_fpclass_ps_mask(a, 0x99);
}
/* 1 <= a 2^k < 2, for positive numbers. */
ALWAYS Wide w_mantissa(Wide a)
{
    return _mm512_getmant_ps(a, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_zero);
}
/* 255 * 1.055 * 2^(k / 2.4) for 2^k <= a < 2^(k + 1), k from -9 to -1.
   Indexed by the low four bits of the exponent field: 127 - 9 = 118 is 6, 127 - 1 = 126 is 14. */
ALWAYS Wide w_curve_scale(Wide a)
{
    const Wide scale =
        _mm512_setr_ps(0, 0, 0, 0, 0, 0, 19.9954033f, 26.6906605f, 35.627758f, 47.5573502f,
                       63.4814453f, 84.7375641f, 113.111076f, 150.985184f, 201.541031f, 0);
    return _mm512_permutexvar_ps(_mm512_srli_epi32(_mm512_castps_si512(a), 23), scale);
}
ALWAYS WideInt w_opaque(WideInt r, WideInt g, WideInt b)
{
    const WideInt rg = _mm512_or_si512(_mm512_slli_epi32(r, 16), _mm512_slli_epi32(g, 8));
    return _mm512_or_si512(_mm512_or_si512(rg, b), _mm512_set1_epi32((int)0xff000000U));
}
ALWAYS Wide w_rsqrt_estimate(Wide a)
{
    return _mm512_rsqrt14_ps(a);
}
ALWAYS Wide w_reciprocal_estimate(Wide a)
{
    return _mm512_rcp14_ps(a);
}
/* 2^a for a whole number a. */
ALWAYS Wide w_power(Wide a)
{
    return _mm512_scalef_ps(_mm512_set1_ps(1.0f), a);
}
ALWAYS Wide w_nearest(Wide a)
{
    return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
/* a minus the nearest whole number. */
ALWAYS Wide w_off_nearest(Wide a)
{
    return _mm512_reduce_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#else
#define WIDE 8
typedef __m256 Wide;
typedef __m256i WideInt;
typedef __m256 WideMask;

ALWAYS Wide w_all(float x)
{
    return _mm256_set1_ps(x);
}
ALWAYS Wide w_load(const float *from)
{
    return _mm256_loadu_ps(from);
}
ALWAYS void w_store(float *to, Wide a)
{
    _mm256_storeu_ps(to, a);
}
ALWAYS Wide w_max(Wide a, Wide b)
{
    return _mm256_max_ps(a, b);
}
ALWAYS Wide w_min(Wide a, Wide b)
{
    return _mm256_min_ps(a, b);
}
ALWAYS WideMask w_less(Wide a, Wide b)
{
    return _mm256_cmp_ps(a, b, _CMP_LT_OQ);
}
ALWAYS WideMask w_both(WideMask a, WideMask b)
{
    return _mm256_and_ps(a, b);
}
ALWAYS bool w_any(WideMask a)
{
    return _mm256_movemask_ps(a) != 0;
}
ALWAYS Wide w_kept(WideMask mask, Wide a)
{
    return _mm256_and_ps(mask, a);
}
ALWAYS Wide w_pick(WideMask mask, Wide a, Wide b)
{
    return _mm256_blendv_ps(b, a, mask);
}
ALWAYS unsigned w_bits(WideMask mask)
{
    return (unsigned)_mm256_movemask_ps(mask);
}
ALWAYS Wide w_abs(Wide a)
{
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a);
}
ALWAYS WideMask w_lanes(unsigned of)
{
    const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i kept = _mm256_and_si256(_mm256_set1_epi32((int)of), bit);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(kept, bit));
}
ALWAYS Wide w_among(unsigned of, Wide a, Wide b)
{
    return _mm256_blendv_ps(b, a, w_lanes(of));
}
ALWAYS float w_largest(Wide a)
{
    float of[8], most;
    _mm256_storeu_ps(of, a);
    most = of[0];
    for (int i = 1; i < 8; i++) most = of[i] > most ? of[i] : most;
    return most;
}
ALWAYS Wide w_signed(Wide a, Wide b)
{
    return _mm256_or_ps(w_abs(a), _mm256_and_ps(b, _mm256_set1_ps(-0.0f)));
}
ALWAYS Wide w_count(void)
{
    return _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
}
ALWAYS void w_store_counted(int *to, int first)
{
    const __m256i count = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    _mm256_storeu_si256((__m256i *)to, _mm256_add_epi32(count, _mm256_set1_epi32(first)));
}
ALWAYS WideMask w_either(WideMask a, WideMask b)
{
    return _mm256_or_ps(a, b);
}
ALWAYS WideInt w_whole(Wide a)
{
    return _mm256_cvttps_epi32(a);
}
ALWAYS WideInt w_load_int(const int32_t *from)
{
    return _mm256_loadu_si256((const __m256i *)from);
}
ALWAYS void w_store_int(int32_t *to, WideInt a)
{
    _mm256_storeu_si256((__m256i *)to, a);
}
ALWAYS void w_store_some(int32_t *to, unsigned of, WideInt a)
{
    if (of == 255) { /* masked stores are slow on some processors */
        w_store_int(to, a);
        return;
    }
    _mm256_maskstore_epi32(to, _mm256_castps_si256(w_lanes(of)), a);
}
ALWAYS WideMask w_odd(Wide a)
{
    const __m256i high = _mm256_set1_epi32(0x7f800000);
    const __m256i bits = _mm256_and_si256(_mm256_castps_si256(a), high);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(bits, high));
}
/* For positive normal numbers: the fraction's bits with the exponent of 1. */
ALWAYS Wide w_mantissa(Wide a)
{
    const Wide low = _mm256_and_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(0x7fffff)));
    return _mm256_or_ps(low, _mm256_set1_ps(1.0f));
}
/* Low three bits of the exponent field: -8 is 7, -7 is 0, .. -1 is 6. -9 has 6 as well, hence the comparison. */
ALWAYS Wide w_curve_scale(Wide a)
{
    const Wide scale = _mm256_setr_ps(35.627758f, 47.5573502f, 63.4814453f, 84.7375641f,
                                      113.111076f, 150.985184f, 201.541031f, 26.6906605f);
    const Wide some =
        _mm256_permutevar8x32_ps(scale, _mm256_srli_epi32(_mm256_castps_si256(a), 23));
    const Wide low = _mm256_cmp_ps(a, _mm256_set1_ps(0x1p-8f), _CMP_LT_OQ);
    return _mm256_blendv_ps(some, _mm256_set1_ps(19.9954033f), low);
}
ALWAYS WideInt w_opaque(WideInt r, WideInt g, WideInt b)
{
    const WideInt rg = _mm256_or_si256(_mm256_slli_epi32(r, 16), _mm256_slli_epi32(g, 8));
    return _mm256_or_si256(_mm256_or_si256(rg, b), _mm256_set1_epi32((int)0xff000000U));
}
ALWAYS Wide w_rsqrt_estimate(Wide a)
{
    return _mm256_rsqrt_ps(a);
}
ALWAYS Wide w_reciprocal_estimate(Wide a)
{
    return _mm256_rcp_ps(a);
}
/* The exponent field is a + 127: valid for -126 <= a <= 127. */
ALWAYS Wide w_power(Wide a)
{
    const __m256i bits = _mm256_add_epi32(_mm256_cvtps_epi32(a), _mm256_set1_epi32(127));
    return _mm256_castsi256_ps(_mm256_slli_epi32(bits, 23));
}
ALWAYS Wide w_nearest(Wide a)
{
    return _mm256_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
ALWAYS Wide w_off_nearest(Wide a)
{
    return a - w_nearest(a);
}
#endif

/* The bits of the first `count` lanes, at most of all. */
ALWAYS unsigned w_first_bits(int count)
{
    return count < WIDE ? (1U << count) - 1 : (unsigned)((1ULL << WIDE) - 1);
}

typedef struct WideVec {
    Wide x, y, z;
} WideVec;

ALWAYS Wide w_dot(WideVec a, WideVec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
ALWAYS WideVec w_mad(WideVec a, WideVec b, Wide s)
{
    return (WideVec){ a.x + b.x * s, a.y + b.y * s, a.z + b.z * s };
}
ALWAYS WideVec w_sub(WideVec a, WideVec b)
{
    return (WideVec){ a.x - b.x, a.y - b.y, a.z - b.z };
}
ALWAYS WideVec w_scale(WideVec a, Wide s)
{
    return (WideVec){ a.x * s, a.y * s, a.z * s };
}
ALWAYS WideVec w_pick3(WideMask mask, WideVec a, WideVec b)
{
    return (WideVec){ w_pick(mask, a.x, b.x), w_pick(mask, a.y, b.y), w_pick(mask, a.z, b.z) };
}
ALWAYS WideVec w_alike(const float v[3])
{
    return (WideVec){ w_all(v[0]), w_all(v[1]), w_all(v[2]) };
}
#define W_LOAD3(strip, name, i)                                                                    \
    ((WideVec){ w_load((strip)->name##x + (i)), w_load((strip)->name##y + (i)),                    \
                w_load((strip)->name##z + (i)) })
#define W_STORE3(strip, name, i, vec)                                                              \
    (w_store((strip)->name##x + (i), (vec).x), w_store((strip)->name##y + (i), (vec).y),           \
     w_store((strip)->name##z + (i), (vec).z))

/* 1 / a: y' = y (2 - a y), which squares the relative error: of rcp, 1.5 2^-12, it leaves about 2^-23. */
ALWAYS Wide w_reciprocal(Wide a)
{
    const Wide y = w_reciprocal_estimate(a);
    return y + y * (w_all(1.0f) - a * y);
}

/* 1 / sqrt(a) for a above 1e-37: an estimate of 12 bits or more and one step of Newton's method.
   y' = y (3 - a y^2) / 2 has the relative error 3/2 e^2. Below the limit a is denormal, where the estimate is
   infinite. */
ALWAYS Wide w_rsqrt(Wide a)
{
    const Wide y = w_rsqrt_estimate(a), left = w_all(1.0f) - a * y * y;
    return y + w_all(0.5f) * y * left;
}

/* sqrt(a); below 1e-30 the root of 1e-30.
   So the result for 0 is finite and a ray that touches the outline needs no case. */
ALWAYS Wide w_root(Wide a)
{
    const Wide some = w_max(a, w_all(1e-30f));
    return some * w_rsqrt(some);
}
#endif
