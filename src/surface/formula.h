/* formula.h - lets each surface's formulas be written once and compiled in double (surface.c) and in
   single precision (the render kernels, where they must stay free of branches and library calls so
   that loops over them vectorise: choose with ?:).
   Include with WR_FORMULA_FLOAT defined or not, then surface_list.h with WR_SURFACE_FORMULAS. A surface
   file has no include guard and defines
       static inline void FN(torus_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
   which fills every member of *o, and, in double only (#ifndef WR_FORMULA_FLOAT), its row
       static const WrSurfaceInfo torus_row = { ... .at = torus_at_d ... };                        */
#include "base/exactmath.h"
#include "base/kernmath.h"
#include "base/vec.h"
#include "surface/surface.h"

#undef REAL
#undef VEC
#undef POINT
#undef SHAPE
#undef FN
#undef K_
#undef r_sincos_turns
#undef r_sqrt
#undef r_abs
#ifdef WR_FORMULA_FLOAT
#define REAL float
#define VEC WrVec3f
#define POINT WrSurfacePointf
#define SHAPE WrShapef
#define FN(name) name##_f
#define K_(x) ((float)(x)) /* a constant */
#define r_sincos_turns wr_sincos_turns_f
#define r_sqrt sqrtf
#define r_abs fabsf
#else
#define REAL double
#define VEC WrVec3
#define POINT WrSurfacePoint
#define SHAPE WrShape
#define FN(name) name##_d
#define K_(x) (x)
#define r_sincos_turns wr_sincos_turns
#define r_sqrt sqrt
#define r_abs fabs
#endif
