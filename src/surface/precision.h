/* precision.h - macros to compile each surface's formulas in double (surface.c) and in single precision
   (kernels).

   In the render kernels formulas must have no branches and library calls so that loops over them
   vectorise: choose with ?:. Include with WR_FORMULA_FLOAT defined or not, then surface_list.h with
   WR_SURFACE_FORMULAS. A surface file has no include guard and defines

       R_INLINE void FN(torus_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)

   which fills every member of *o, and, in double only (#ifndef WR_FORMULA_FLOAT), its row

       static const WrSurfaceInfo torus_row = { ... .at = torus_at_d ... };

   In a span loop keep the POINT inside a static inline function of one index that the loop calls, and
   the SHAPE in a local copy: gcc and clang then vectorise every surface (a POINT declared in the body
   of an `omp simd` loop becomes an array in memory and prevents vectorisation in gcc). */
#include "base/exactmath.h"
#include "base/kernmath.h"
#include "base/vec.h"
#include "surface/data.h"
#include "surface/surface.h"

#undef REAL
#undef VEC
#undef POINT
#undef SHAPE
#undef PROFILE
#undef FN
#undef K_
#undef R_INLINE
#undef R_MIN
#undef R_NOISE
#undef r_sincos_turns
#undef r_exp2
#undef r_log2
#undef r_atan2
#undef r_is_finite
#undef r_pow01
#undef r_pow_near
#undef r_sqrt
#undef r_abs
#ifdef WR_FORMULA_FLOAT
#define REAL float
#define VEC WrVec3f
#define POINT WrSurfacePointf
#define SHAPE WrShapef
#define PROFILE WrProfilef
#define FN(name) name##_f
#define K_(x) ((float)(x)) /* a constant */
#define R_MIN 0x1p-125f    /* above it a reciprocal is finite */
#define R_NOISE 0x1p-23f   /* a cross product below this fraction of its factors is rounding */
#define r_sincos_turns wr_sincos_turns_f
#define r_exp2 wr_exp2_f
#define r_log2 wr_log2_f
#define r_atan2 wr_atan2_f
#define r_is_finite wr_is_finite_f
#define r_pow01(x, s) wr_pow01_f(x, s)               /* 0 <= x <= 1, s >= 0; pow(0, 0) = 1 */
#define r_pow_near(x, s) wr_exp2_f((s)*wr_log2_f(x)) /* x > 0 and not far from 1, any s */
#define r_sqrt sqrtf
#define r_abs fabsf
#else
#define REAL double
#define VEC WrVec3
#define POINT WrSurfacePoint
#define SHAPE WrShape
#define PROFILE WrProfiled
#define FN(name) name##_d
#define K_(x) ((double)(x)) /* never an integer: K_(1) / K_(6) is a sixth */
#define R_MIN 0x1p-1021
#define R_NOISE 0x1p-47
#define r_sincos_turns wr_sincos_turns
#define r_exp2 wr_exp2
#define r_log2 wr_log2
#define r_atan2 wr_atan2
#define r_is_finite isfinite
#define r_pow01(x, s) wr_pow(x, s)
#define r_pow_near(x, s) wr_pow(x, s)
#define r_sqrt sqrt
#define r_abs fabs
#endif
/* Placed before loops over samples that must vectorise; defined by the kernels. */
#ifndef R_EACH
#define R_EACH
#endif
/* For larger helpers, which compilers would otherwise not inline into a span loop. */
#define R_INLINE static inline __attribute__((always_inline))
