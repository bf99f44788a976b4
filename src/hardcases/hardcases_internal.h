/* hardcases_internal.h - functions shared by the measurements of the hard cases. Private to this module. */
#pragma once
#include "base/vec.h"
#include "field/wrap.h"
#include "hardcases/hardcases.h"
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "render/reference/reference.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* Kernel sets for float measurements: "ref" and another, both exact, and the other's fast form. */
#define WR_HARD_SETS 3

struct WrHardMeasurement {
    const WrKernels *kernels[WR_HARD_SETS]; /* the exact ones, then the fast one */
    int sets;                               /* number of exact ones: 1 if they are the same */
    int all;                                /* number including the fast one, if there is one */
    const WrKernelsd *wide[2];              /* in double; the second may be equal to the first */
    const char *isa;
    WrPool *pool;
    WrStrip *strip; /* scratch */
    WrStripd *wide_strip;
    uint64_t random;
    double nudge[WR_HARD_PRECISIONS];
    double worst[WR_HARD_PRECISIONS];
    int64_t checks[WR_HARD_PRECISIONS];
};

/* Reports a deviation, 0 or more; NaN counts as infinite. */
void wr_hard_record_error(WrHardMeasurement *gauge, WrHardPrecision precision, double deviation);
/* Reports |got - want|. */
void wr_hard_near(WrHardMeasurement *gauge, WrHardPrecision precision, double got, double want);
/* Reports one violation unless ok. */
void wr_hard_holds(WrHardMeasurement *gauge, WrHardPrecision precision, bool ok);

/* Random number, 0 <= x < 1, repeatable: splitmix64, reseeded for each case. */
double wr_hard_random(WrHardMeasurement *gauge);
double wr_hard_between(WrHardMeasurement *gauge, double low, double high);
float wr_hard_float(
    WrHardMeasurement *gauge); /* as wr_hard_random, exactly representable in float */

/* ---- points of surfaces ---- */

static inline WrVec3 wr_hard_vec(WrVec3f a)
{
    return (WrVec3){ (double)a.x, (double)a.y, (double)a.z };
}
static inline bool wr_hard_same(WrVec3 a, WrVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

WrShape wr_hard_shape(WrSurfaceKind kind);
/* The bicubic patch of the points f(i, j), i along u. */
WrShape wr_hard_bicubic_patch(WrVec3 (*point)(int i, int j));
/* A point by a kernel: P, Pu, Pv, n, |N|, n_u, n_v; the others 0. N is n |N|. The shape is scaled by `scale`, a
   power of two. */
WrSurfacePointf wr_hard_point(WrHardMeasurement *gauge, int set, const WrShape *shape, double scale,
                              int face, float u, float v);

/* Slopes and height at a point. */
typedef struct WrHardSlope {
    double f, fu, fv;
} WrHardSlope;
/* n' in double, normalised. */
WrVec3 wr_hard_bumped_normal(WrBumpMode mode, const WrSurfacePoint *at, WrHardSlope slope);
/* n' by a kernel, seen from the side of n (behind: from the other side). */
WrVec3 wr_hard_bumped_normal_f(WrHardMeasurement *gauge, int set, WrBumpMode mode,
                               const WrSurfacePointf *at, WrHardSlope slope, bool behind);
/* n' by the renderer's kernels in double: set 0 or 1. */
WrVec3 wr_hard_bumped_normal_wide(WrHardMeasurement *gauge, int set, WrBumpMode mode,
                                  const WrSurfacePoint *at, WrHardSlope slope);
/* The point converted to double, for formulas on float's own numbers. */
WrSurfacePoint wr_hard_point_to_double(const WrSurfacePointf *at);
/* The float point without the rounding of its computation: doubles rounded once. */
WrSurfacePointf wr_hard_narrow(const WrSurfacePoint *at);

/* ---- tables ---- */

/* A table of random heights in -0.5..0.5. Never NULL. */
WrField *wr_hard_random_table(WrHardMeasurement *gauge, int width, int height, WrWrap wrap);
/* A smooth table: a few waves of height about 1. */
WrField *wr_hard_waves(int width, int height);
bool wr_hard_equal(const WrField *a, const WrField *b);
/* Texel (i, j) of the result is texel (i + di, j + dj). Owned by the caller. */
WrField *wr_hard_rolled(const WrField *field, int di, int dj);

/* A fetch by wr_field_sample. */
WrHardSlope wr_hard_sample(const WrField *field, WrScheme scheme, double u, double v);
bool wr_hard_same_slope(WrHardSlope a, WrHardSlope b); /* every bit */

/* Sets the scene to rough terrain of 5 x 5 patches, 1 unit wide, seen from above or below and rotated at random. */
void wr_hard_ground(WrHardMeasurement *gauge, WrScene *scene);

/* ---- pictures ---- */

typedef struct WrHardShot {
    WrRenderer *renderer;
    WrFrame frame;
} WrHardShot;
bool wr_hard_shoot(WrHardMeasurement *gauge, const WrFrameRequest *request, WrHardShot *shot,
                   WrError *err);
void wr_hard_put_away(WrHardShot *shot);
/* Number of non-finite values of the picture. */
int64_t wr_hard_wild(const WrHardShot *shot);

/* The picture in double, by the reference: samples x samples a pixel. Zero-initialise *out; fini it. */
bool wr_hard_refer(WrHardMeasurement *gauge, const WrFrameRequest *request, int samples,
                   WrReference *out, WrError *err);
int64_t wr_hard_wild_reference(const WrReference *reference);

/* The picture in an arithmetic: exact, by the fast kernels, or in double. */
typedef enum WrHardWay { WR_HARD_EXACT, WR_HARD_FAST, WR_HARD_WIDE, WR_HARD_WAYS } WrHardWay;
bool wr_hard_shoot_by(WrHardMeasurement *gauge, const WrFrameRequest *request, WrHardWay way,
                      WrHardShot *shot, WrError *err);
/* Number of values by which two pictures of one size differ by more than `off`, including NaN. */
int64_t wr_hard_differ(const WrHardShot *a, const WrHardShot *b, double off);

/* One light of strength 1 on one point of a plane whose n is (0, 0, 1). */
typedef struct WrHardLit {
    WrVec3 perturbed, light, view; /* unit; for the reference perturbed.z and view.z are above 0 */
    double diffuse, specular, shininess;
    bool gate;
} WrHardLit;
/* Its diffuse and specular parts by the reference; ambient 0. */
bool wr_hard_shine(const WrHardLit *lit, double part[2], WrError *err);

/* ---- rows, by file; each list in order of ids ---- */

/* clang-format off */
#define WR_HARD_ROWS(X)                                                                            \
    X(surface) X(focal) X(bump) X(side) X(mesh)                                                    \
    X(table) X(flat) X(limits) X(pyramid)                                                          \
    X(noise) X(octaves) X(faces) X(tiling)                                                         \
    X(dab) X(stroke) X(stamp) X(undo)                                                              \
    X(sight) X(turn) X(light) X(reflect) X(surround) X(grain) X(horizon) X(raised)                                                                    \
    X(fans) X(maps) X(forms) X(patches) X(stretch) X(later) X(cast)
/* clang-format on */

typedef struct WrHardList {
    const WrHardCase *rows;
    int count;
} WrHardList;
#define WR_HARD_DECLARE(name) extern const WrHardList wr_hard_##name;
WR_HARD_ROWS(WR_HARD_DECLARE)
#undef WR_HARD_DECLARE

#define WR_HARD_LIST(name, list)                                                                   \
    const WrHardList wr_hard_##name = { (list), (int)(sizeof(list) / sizeof *(list)) }
