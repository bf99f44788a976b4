/* kern_wide_body.h - vectors as wide as a register, for kernels that are worth writing so: compilers have no reciprocal
   root of 16 numbers and no look-up in registers. Included by each kern_wide_*.c, which the build gives the flags of a
   set; without one there are no such kernels. WIDE numbers are a vector; masks have a lane for each.
   A header without a guard, by intention. */
#include "render/kern_wide.h"

#define ALWAYS static inline __attribute__((always_inline))
#ifdef __AVX2__
#include <immintrin.h>

#ifdef __AVX512DQ__
#define WIDE 16
typedef __m512 Wide;
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
/* a where the mask is, else 0. */
ALWAYS Wide w_kept(WideMask mask, Wide a)
{
    return _mm512_maskz_mov_ps(mask, a);
}
ALWAYS Wide w_rsqrt_estimate(Wide a)
{
    return _mm512_rsqrt14_ps(a);
}
/* 2^a; a is whole. */
ALWAYS Wide w_power(Wide a)
{
    return _mm512_scalef_ps(_mm512_set1_ps(1.0f), a);
}
ALWAYS Wide w_nearest(Wide a)
{
    return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#else
#define WIDE 8
typedef __m256 Wide;
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
ALWAYS Wide w_rsqrt_estimate(Wide a)
{
    return _mm256_rsqrt_ps(a);
}
ALWAYS Wide w_power(Wide a)
{
    const __m256i bits = _mm256_add_epi32(_mm256_cvtps_epi32(a), _mm256_set1_epi32(127));
    return _mm256_castsi256_ps(_mm256_slli_epi32(bits, 23));
}
ALWAYS Wide w_nearest(Wide a)
{
    return _mm256_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#endif

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

/* 1 / sqrt(a) of what is above 1e-37: an estimate of 12 bits or more and a step of Newton's. */
ALWAYS Wide w_rsqrt(Wide a)
{
    const Wide y = w_rsqrt_estimate(a);
    return y * (w_all(1.5f) - w_all(0.5f) * a * y * y);
}
#endif
