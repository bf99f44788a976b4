/* kern_body.h - the bodies of all span kernels. Compiled once for each kernel set (wr_kern of CMakeLists.txt
   and of render), which defines WR_SET_TABLE and WR_SET_NAME for the table at its end, WR_KERN_FAST for fast
   arithmetic, WR_KERN_DOUBLE for double precision, and WR_KERN_PLAIN for one sample at a time. Plain loops
   over structure-of-arrays strips; no branches except ?: on scalars, no library call that does not vectorise.
   Deliberately without a guard. */
#include "base/enum_rows.h"
#include "field/scheme_list.h"
#include "shade/reflection_models.h"
#include "noise/lattice.h"
#include "render/kernels/kern.h"
#include "render/kernels/kern_double_math.h"
#include "render/textures/slope_pyramid.h"
#include "render/frame/pixel_encode.h"

#include <float.h>
#include <stddef.h>
#include <string.h>

#ifdef WR_KERN_PLAIN
#define R_EACH
#else
#define R_EACH _Pragma("omp simd")
#endif
#ifdef WR_KERN_DOUBLE
#include "surface/precision.h"
#undef r_sincos_turns
#define r_sincos_turns wr_sincos_turns_r
#undef r_exp2
#undef r_log2
#undef r_atan2
#undef r_is_finite
#undef r_pow01
#undef r_pow_near
#define r_exp2 wr_exp2_double
#define r_log2(x) wr_log2_below_r(x, 1.0 - (x))
#define r_atan2 wr_atan2_r
#define r_pow01(x, s) wr_pow_below_r(x, 1.0 - (x), s)
#define r_pow_near(x, s) wr_exp2_double((s)*wr_log2_below_r(x, 1.0 - (x)))
#define r_atan2_turns wr_atan2_turns_r
#define r_pow_below wr_pow_below_r
#define r_scale_down wr_scale_down_r
#define r_is_finite wr_is_finite_r
#define r_floor floor
/* 2^6 units of the last place (float: 2^5): a smaller difference of products counts as rounding */
#define ROUNDED K_(0x1p-46)
#define STRIP WrStripd
#define RAYS WrRaysd
#define QUAD WrQuadd
#define LOOK WrLookd
#define LIGHT WrKernLightd
#define SHINE WrKernShined
#define MATERIAL WrKernMateriald
#define MATTER WrKernMatterd
#define SURROUND WrKernSurroundd
#define MIRROR WrKernMirrord
#define GRAIN WrKernGraind
#define VARY WrKernVaryd
#define REFLECT_KERNEL WrReflectKerneld
#define LOOK_KERNEL WrLookKerneld
#define SKYLINE WrKernHorizond
#define NEWTON WrNewtond
#define KERNELS WrKernelsd
#define WR_FORMULA_FLOAT /* only the formulas, without the surfaces' rows */
#else
#define WR_FORMULA_FLOAT
#include "surface/precision.h"
#define r_atan2_turns wr_atan2_turns_f
#define r_pow_below wr_pow_below_f
#define r_scale_down wr_scale_down_f
#define r_floor floorf
#define ROUNDED K_(0x1p-18)
#define STRIP WrStrip
#define RAYS WrRays
#define QUAD WrQuad
#define LOOK WrLook
#define LIGHT WrKernLight
#define SHINE WrKernShine
#define MATERIAL WrKernMaterial
#define MATTER WrKernMatter
#define SURROUND WrKernSurround
#define MIRROR WrKernMirror
#define GRAIN WrKernGrain
#define VARY WrKernVary
#define REFLECT_KERNEL WrReflectKernel
#define LOOK_KERNEL WrLookKernel
#define SKYLINE WrKernHorizon
#define NEWTON WrNewton
#define KERNELS WrKernels
#endif
/* X-macro: each surface of the list instantiates the loops of the kernel, so that its formula is inlined and
   vectorised. */
#define WR_SURFACE_FORMULAS
#include "surface/surface_list.h"
#undef WR_SURFACE_FORMULAS

#ifdef WR_KERN_PLAIN
#define SIMD
#define SIMD_SUM(sum)
#define SIMD_RUN(sum, least, most)
#else
#define SIMD _Pragma("omp simd")
#define SIMD_SUM(sum) WR_PRAGMA(omp simd reduction(+ : sum))
#define SIMD_RUN(sum, least, most)                                                                 \
    WR_PRAGMA(omp simd reduction(+ : sum) reduction(min : least) reduction(max : most))
#endif
#define WR_PRAGMA(text) _Pragma(#text)
#define FLAT __attribute__((flatten)) /* a loop that still contains a call does not vectorise */
#define MISS FLT_MAX
#define LANES 16 /* unrolled samples where speed matters; divides WR_SPAN */
/* Upper limit of long loops: the remainder after whole vectors would take as long as many vectors. The extra
   results are written past the strip's count and never read. */
#define WHOLE(count) (((count) + LANES - 1) & -LANES)
/* larger slopes are scaled down together with N: the direction does not change */
#define STEEP 1e12f

#define LOAD3(strip, name, i) ((VEC){ strip->name##x[i], strip->name##y[i], strip->name##z[i] })
#define STORE3(strip, name, i, vec)                                                                \
    (strip->name##x[i] = (vec).x, strip->name##y[i] = (vec).y, strip->name##z[i] = (vec).z)

#define ALWAYS static inline __attribute__((always_inline))

/* o + y gy + x gx: of a ray, at (gx, gy) of the grid. Scalars only: an array in the body of a loop stays in
   memory and prevents vectorisation. */
ALWAYS VEC affine(const REAL o[3], const REAL y[3], const REAL x[3], REAL gy, REAL gx)
{
    return (VEC){ o[0] + gy * y[0] + gx * x[0], o[1] + gy * y[1] + gx * x[1],
                  o[2] + gy * y[2] + gx * x[2] };
}

#define RAY_Q(rays, gy, gx) affine((rays)->q0, (rays)->qy, (rays)->qx, gy, gx)
#define RAY_D(rays, gy, gx) affine((rays)->d0, (rays)->dy, (rays)->dx, gy, gx)

/* Keeps the samples that hit, in order, with the arrays in `move`. Most hits are neighbours: whole runs move.
   MISS in strip->s marks samples without a hit. `index` is the position before compaction. Unconditional
   stores and hits += 0 or 1 avoid a branch that would be mispredicted at every edge. */
ALWAYS int compact(int count, STRIP *strip, REAL *const *move, const int moves)
{
    int hits = 0, first = count, last = 0;
    SIMD_RUN(hits, first, last) for (int i = 0; i < count; i++)
    {
        const bool hit = strip->s[i] < MISS;
        const int from = hit ? i : count, to = hit ? i : 0;
        hits += hit ? 1 : 0;
        first = from < first ? from : first;
        last = to > last ? to : last;
    }
    strip->count = hits;
    if (hits == 0) return 0;
    if (last - first + 1 == hits) {
        SIMD for (int i = 0; i < hits; i++)
        {
            strip->index[i] = first + i;
        }
        for (int k = 0; k < moves && first > 0; k++)
            memmove(move[k], move[k] + first, (size_t)hits * sizeof *move[k]);
        return hits;
    }
    hits = 0;
    for (int i = 0; i < count; i++) {
        strip->index[hits] = i;
        for (int k = 0; k < moves; k++) move[k][hits] = move[k][i];
        hits += strip->s[i] < MISS;
    }
    return hits;
}

/* Keeps the points that hit; `spread`: their grid positions as well. */
ALWAYS int compact_points(int count, const bool spread, STRIP *strip)
{
    REAL *const move[] = { strip->px, strip->py, strip->pz, strip->x, strip->y };
    return compact(count, strip, move, spread ? 5 : 3);
}

static inline REAL clamp01(REAL x)
{
    x = x > 0.0f ? x : 0.0f;
    return x < 1.0f ? x : 1.0f;
}

ALWAYS REAL larger(REAL a, REAL b)
{
    return a > b ? a : b;
}

ALWAYS REAL smaller(REAL a, REAL b)
{
    return a < b ? a : b;
}

/* Clamps an index to 0 .. n - 1, also one converted from NaN.
   NaN converts to the smallest int, which becomes 0: the fetch stays within the table. */
ALWAYS int among(int i, int n)
{
    i = i < n ? i : n - 1;
    return i < 0 ? 0 : i;
}

ALWAYS VEC choose(bool condition, VEC a, VEC b)
{
    return (VEC){ condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z };
}

ALWAYS REAL longest(VEC a)
{
    return larger(larger(r_abs(a.x), r_abs(a.y)), r_abs(a.z));
}

/* a / |a|, or `otherwise` if a is 0 or not finite. It is scaled by a power of two first, so that no square
   overflows. */
ALWAYS VEC unit_or(VEC a, VEC otherwise)
{
    REAL m = longest(a);
    VEC b = v_scale(a, r_scale_down(m));
    bool good = (m > 0.0f) & r_is_finite(m);
    /* the choice comes after the division: a masked division is slow */
    REAL inv = K_(1) / r_sqrt(v_dot(b, b));
    return (VEC){ good ? b.x * inv : otherwise.x, good ? b.y * inv : otherwise.y,
                  good ? b.z * inv : otherwise.z };
}

/* Order of inclusion: formulas before the loops that inline them; kern_filter_body.h's footprints are read by
   the solid texture. */
#include "render/kernels/kern_ray_hit_body.h"
#include "render/kernels/kern_surface_body.h"
#include "render/kernels/kern_triangle_body.h"
#include "render/kernels/kern_patch_body.h"
#include "render/kernels/kern_fetch_body.h"
#include "render/kernels/kern_bump_body.h"
#include "shade/light_body.h"
#include "render/kernels/kern_light_body.h"
#include "shade/reflection_body.h"
#include "render/kernels/kern_reflection_body.h"
#include "shade/environment_map_body.h"
#include "render/kernels/kern_environment_body.h"
#include "render/kernels/kern_svbrdf_body.h"
#include "render/kernels/kern_horizon_body.h"
#include "render/kernels/kern_unlit_body.h"
#include "render/kernels/kern_filter_body.h"
#include "shade/solid_texture_body.h"
#include "render/kernels/kern_solid_texture_body.h"
#include "render/kernels/kern_slope_moments_body.h"
#include "render/kernels/kern_intensity_bound_body.h"
#include "render/kernels/kern_encode_body.h"
#ifndef WR_KERN_DOUBLE
#include "render/kernels/kern_adaptive_body.h"
#endif

WR_ROWS(kern_looks);
static LOOK_KERNEL const kern_looks[] = {
    [WR_ROW(WR_SCHEME_NEAREST)] = kern_look_nearest,
    [WR_ROW(WR_SCHEME_BILINEAR)] = kern_look_bilinear,
    [WR_ROW(WR_SCHEME_CENTRAL)] = kern_look_central,
    [WR_ROW(WR_SCHEME_BSPLINE)] = kern_look_bspline,
    [WR_ROW(WR_SCHEME_BSPLINE_FIT)] = kern_look_bspline,
    [WR_ROW(WR_SCHEME_CATMULL)] = kern_look_catmull,
};
WR_ROWS_END(kern_looks, WR_SCHEME_COUNT);

/* Fields that only one precision has are absent in the other (WrKernels, WrKernelsd). */
WR_ROWS(kernels);
const KERNELS WR_SET_TABLE = {
    .name = WR_SET_NAME,
#ifndef WR_KERN_FAST
    .exact = true,
#endif
    .hit_quad = kern_hit_quad,
    .hit_quad_at = kern_hit_quad_at,
    .round = {
        [WR_INVERT_SPHERE] = ROUND(sphere),
        [WR_INVERT_CYLINDER] = ROUND(cylinder),
        [WR_INVERT_CONE] = ROUND(cone),
    },
#ifndef WR_KERN_DOUBLE
    .cover = kern_cover,
#endif
    .covered = kern_covered,
#define WR_X(name) [WR_SURFACE_##name] = kern_polish_##name,
    .polish = {
#include "surface/surface_list.h"
    },
#define WR_X(name) [WR_SURFACE_##name] = kern_points_##name,
    .points = {
#include "surface/surface_list.h"
    },
    .recall = kern_recall,
    .meet = kern_meet,
#define WR_X(name) [WR_SURFACE_##name] = kern_resume_##name,
    .resume = {
#include "surface/surface_list.h"
    },
#define WR_X(name) [WR_SURFACE_##name] = kern_frame_##name,
    .frame = {
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
    .look = kern_looks,
    .footprint = kern_footprint,
    .footprint_met = kern_footprint_met,
    .spread = kern_spread,
    .look_pyramid = kern_look_pyramid,
    .bump = {
        [WR_ROW(WR_BUMP_NONE)] = kern_bump_none,
        [WR_ROW(WR_BUMP_BLINN)] = kern_bump_blinn,
        [WR_ROW(WR_BUMP_INVARIANT)] = kern_bump_invariant,
        [WR_ROW(WR_BUMP_EXACT)] = kern_bump_exact,
    },
#ifdef WR_KERN_FAST
    .bend = { [WR_INVERT_SPHERE] = kern_bend_sphere },
#endif
    .widen = kern_widen,
    .colour = kern_colour,
    .colour_pyramid = kern_colour_pyramid,
    .grain = kern_grain,
    .grain_bump = kern_grain_bump,
    .grain_rough = kern_grain_rough,
    .view = kern_view,
    .begin = kern_begin,
    .light = kern_light,
    .diffuse = kern_diffuse,
    .specular = kern_specular,
    .specular_lean = kern_specular_lean,
    .specular_toksvig = kern_specular_toksvig,
    .reflect = kern_reflects,
    .faces = kern_faces,
    .gathered = kern_gathered,
    .survey = kern_survey,
    .reflect_vary = kern_reflect_vary,
    .surround_vary = kern_surround_vary,
    .mirror_vary = kern_mirror_vary,
    .surround = { { kern_surround_00, kern_surround_01, kern_surround_02 },
                  { kern_surround_10, kern_surround_11, kern_surround_12 } },
    .mirror = kern_mirror,
    .mirror_even = kern_mirror_even,
    .tint = kern_tint,
    .shadow = kern_shadow,
    .open = kern_open,
    .veil = kern_veil,
#ifndef WR_KERN_DOUBLE
    .shade = { { SHADE_ROWS(0, 0), SHADE_ROWS(0, 1) }, { SHADE_ROWS(1, 0), SHADE_ROWS(1, 1) } },
    .smooth = kern_smooth,
    .texels = kern_texels,
#endif
    .finish = kern_finish,
    .reach = kern_reach,
    .behind = kern_behind,
    .behind_bumped = kern_behind_bumped,
    .ambient = kern_ambient,
    .codes = kern_codes,
    .codes_over = kern_codes_over,
    .codes_behind = kern_codes_behind,
    .bound_sphere = kern_bound_sphere,
    .bound_quad = kern_bound_quad,
    .bound_slopes = kern_bound_slopes,
    .bound_normal = kern_bound_normal,
    .bound_light = kern_bound_light,
};
WR_ROWS_END(kernels, WR_BUMP_COUNT);
