/* kern_body.h - the bodies of all span kernels. Included once by each kern_*.c, which defines
   WR_KERN_TABLE, WR_KERN_NAME and WR_KERN_EXACT for the table at its end. Plain loops over structure-of-arrays strips; no
   branch inside but ?: on scalars, no library call that does not vectorise.
   A header without a guard, by intention. */
#include "base/kernmath.h"
#include "render/kern.h"

#include <float.h>
#include <stddef.h>
#include <string.h>

#define WR_FORMULA_FLOAT
#include "surface/formula.h"
#define WR_SURFACE_FORMULAS
#include "surface/surface_list.h"
#undef WR_SURFACE_FORMULAS

#ifdef WR_KERN_PLAIN
#define SIMD
#else
#define SIMD _Pragma("omp simd")
#endif
#define FLAT __attribute__((flatten)) /* a loop with a call left in it does not vectorise */
#define MISS FLT_MAX
#define STEEP 1e12f /* slopes beyond this are scaled down together with N: the direction stays */

#define LOAD3(strip, name, i) ((WrVec3f){ strip->name##x[i], strip->name##y[i], strip->name##z[i] })
#define STORE3(strip, name, i, vec)                                                                \
    (strip->name##x[i] = (vec).x, strip->name##y[i] = (vec).y, strip->name##z[i] = (vec).z)

static inline WrVec3f affine(const float o[3], const float x[3], float gx)
{
    return (WrVec3f){ o[0] + gx * x[0], o[1] + gx * x[1], o[2] + gx * x[2] };
}

/* The start of a row: q and d at (0, gy). */
typedef struct Row {
    float q[3], d[3];
} Row;

static inline Row row_at(const WrRays *rays, float gy)
{
    Row row;
    for (int k = 0; k < 3; k++) {
        row.q[k] = rays->q0[k] + gy * rays->qy[k];
        row.d[k] = rays->d0[k] + gy * rays->dy[k];
    }
    return row;
}

/* Keep the samples that hit, in order; s moves along. */
static inline int compact(int count, WrStrip *strip)
{
    int hits = 0;
    for (int i = 0; i < count; i++) {
        strip->index[hits] = i;
        strip->s[hits] = strip->s[i];
        hits += strip->s[i] < MISS;
    }
    strip->count = hits;
    return hits;
}

static inline float clamp01(float x)
{
    x = x > 0.0f ? x : 0.0f;
    return x < 1.0f ? x : 1.0f;
}

static inline float max3(float a, float b, float c)
{
    a = a > b ? a : b;
    return a > c ? a : c;
}

/* a / |a|, `otherwise` where a is 0: scaled by its largest component first, so no square overflows. */
static inline WrVec3f unit_or(WrVec3f a, WrVec3f otherwise)
{
    float m = max3(fabsf(a.x), fabsf(a.y), fabsf(a.z));
    float k = m > 0.0f ? m : 1.0f;
    float x = a.x / k, y = a.y / k, z = a.z / k;
    float len = sqrtf(x * x + y * y + z * z);
    float inv = 1.0f / (m > 0.0f ? len : 1.0f);
    return (WrVec3f){ m > 0.0f ? x * inv : otherwise.x, m > 0.0f ? y * inv : otherwise.y,
                      m > 0.0f ? z * inv : otherwise.z };
}

#include "render/kern_hit_body.h"
#include "render/kern_surface_body.h"
#include "render/kern_look_body.h"
#include "render/kern_bump_body.h"
#include "render/kern_light_body.h"

const WrKernels WR_KERN_TABLE = {
    .name = WR_KERN_NAME,
    .exact = WR_KERN_EXACT,
    .hit_sphere = kern_hit_sphere,
    .hit_cylinder = kern_hit_cylinder,
    .hit_cone = kern_hit_cone,
    .hit_quad = kern_hit_quad,
#define WR_X(name) [WR_SURFACE_##name] = kern_polish_##name,
    .polish = {
#include "surface/surface_list.h"
    },
#define WR_X(name) [WR_SURFACE_##name] = kern_points_##name,
    .points = {
#include "surface/surface_list.h"
    },
#define WR_X(name) [WR_SURFACE_##name] = kern_geometry_##name,
    .geometry = {
#include "surface/surface_list.h"
    },
#define WR_X(name) [WR_SURFACE_##name] = kern_curvature_##name,
    .curvature = {
#include "surface/surface_list.h"
    },
    .look = {
        [WR_SCHEME_NEAREST] = kern_look_nearest,
        [WR_SCHEME_BILINEAR] = kern_look_bilinear,
        [WR_SCHEME_CENTRAL] = kern_look_central,
        [WR_SCHEME_BSPLINE] = kern_look_bspline,
        [WR_SCHEME_BSPLINE_FIT] = kern_look_bspline,
        [WR_SCHEME_CATMULL] = kern_look_catmull,
    },
    .bump = {
        [WR_BUMP_NONE] = kern_bump_none,
        [WR_BUMP_BLINN] = kern_bump_blinn,
        [WR_BUMP_INVARIANT] = kern_bump_invariant,
        [WR_BUMP_EXACT] = kern_bump_exact,
    },
    .colour = kern_colour,
    .view = kern_view,
    .begin = kern_begin,
    .light = kern_light,
    .diffuse = kern_diffuse,
    .specular = kern_specular,
    .finish = kern_finish,
};
