/* zbuffer.h - a depth buffer over the table: what is seen of triangles and solids from straight above, by
   parallel projection along -Z (Blinn 1978, figure 7: the Z values are the bump function).
   Private to this module.

   Texel coordinates: texel (i, j) has its centre at x = i, y = j, y down; z, in texels as well, rises
   towards the viewer. On periodic axes everything is there with all its images.

   Depth is taken at texels' centres exactly; where only a part of a texel is covered, without its centre,
   at the covered sample nearest to the centre; where the rims of solids cross a texel that other solids
   are in, or one part of a solid hides another, the mean of what is seen at its covered samples. Coverage
   counts 16 samples of a texel, no two in one row or column of sixteenths. Of triangles, corners are
   rounded to 1/1024 texel for coverage alone, and edges follow the top-left rule, so that closed meshes
   have no cracks and no texel is counted twice. The greatest height wins, and of equal ones the first
   (HC80): the bytes are the same on any number of threads. Places are kept to 2^-20 texel (wr_z_place), so
   that what is moved by whole texels is the same in every bit. */
#pragma once
#include "generate/generator.h"
#include "generate/zbuffer_letters.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define WR_Z_SAMPLES 16
#define WR_Z_REACH 524288.0   /* texels from the origin that anything may reach */
#define WR_Z_ENTRIES 16777216 /* pieces of all things and their images in tiles of the table */

/* Texels, to 2^-20: sums of such places with whole texels are exact. */
static inline double wr_z_place(double x)
{
    return rint(x * 1048576.0) / 1048576.0;
}

typedef struct WrZTriangle {
    double x[3], y[3], z[3]; /* x, y as from wr_z_place where rolls matter */
} WrZTriangle;

/* Solids of unit size about their origin, axes along Z. */
typedef enum WrZShape {
    WR_Z_SPHERE,   /* radius 1 */
    WR_Z_BOX,      /* -1..1 on each axis */
    WR_Z_CYLINDER, /* radius 1, z -1..1 */
    WR_Z_CONE,     /* radius 1 at z = -1, apex at z = 1 */
    WR_Z_CAPSULE,  /* radius 1, centres of its ends at z = -param and param; param >= 0 */
    WR_Z_TORUS,    /* ring of radius 1 in the plane z = 0, tube of radius param, 0 < param < 1 */
    WR_Z_LETTERS,  /* what `letters` describes, one texel of it a unit */
    WR_Z_SHAPES
} WrZShape;

/* First what is looked at for each of many: see zbuffer_many.c. */
typedef struct WrZSolid {
    WrZShape shape;
    bool level; /* its top is level */
    bool
        round; /* a sphere, or an upright capsule, or a torus that lies flat: round about its axis */
    double at[3];      /* texels: where its origin stands, x and y by wr_z_place */
    double ring, tube; /* texels: radii of the torus that lies flat */
    double middle;     /* z of the middle of the upper round end, or of the ring */
    double peak;       /* no place is higher */
    double
        dome[6]; /* of a sphere, (x, y) from `at`: its top is d0 x + d1 y + d2 sqrt(rest) over `at`,
                       rest = 1 - d3 x x - d4 (y - d5 x)^2 */
    double param;
    const WrZLetters *letters;       /* borrowed */
    double pose[9];                  /* row-major: unit solid -> texels (turn and scale), y down */
    double inverse[9];               /* of pose */
    double left, right, top, bottom; /* texels from `at`: its bounding box */
} WrZSolid;

/* A turn by angles about X, then Y, then Z, in degrees, right-handed with y up: rows of Rz Ry Rx. */
void wr_z_turn(const double rotate_deg[3], double out[9]);

/* A solid scaled by size (texels for a unit, on each axis), then turned by `turn` (a rotation's rows, y up).
 * letters: of WR_Z_LETTERS, else NULL. Errors: a size that is not above 0, numbers that are not finite. */
bool wr_zsolid_set(WrZSolid *solid, WrZShape shape, double param, const WrZLetters *letters,
                   const double size[3], const double turn[9], const double at[3], WrError *err);

/* How high its highest place is over its origin, texels. Not for letters. */
double wr_zsolid_rise(const WrZSolid *solid);
/* The largest z of the solid over (x, y), texels; false beside it. */
bool wr_zsolid_top(const WrZSolid *solid, double x, double y, double *z);
/* The same over many places; -inf beside it. */
void wr_zsolid_tops(const WrZSolid *solid, int count, const double *x, const double *y, double *z);
/* Whether it is certainly nowhere within `reach` texels of (x, y); false may mean anything. */
bool wr_zsolid_far(const WrZSolid *solid, double x, double y, double reach);
static inline bool wr_zsolid_convex(const WrZSolid *solid)
{
    return solid->shape != WR_Z_TORUS && solid->shape != WR_Z_LETTERS;
}

typedef struct WrZScene {
    const WrZSolid *solids; /* [solid_count], before the triangles where heights are equal */
    int64_t solid_count;
    const WrZTriangle *triangles; /* [triangle_count]; either way round; without area: nothing */
    int64_t triangle_count;
    double floor;         /* texels: what is lower is not seen, nor covers */
    double soft;          /* texels above the floor over which coverage fades in; 0: at once */
    double scale, offset; /* height = offset + scale z, table units */
    bool hidden;          /* draw what is hidden too, which changes no bit: for tests */
} WrZScene;

/* What is hidden below others costs next to nothing, however large it is and however often it stands there.
 * Errors: coordinates that are not finite or beyond WR_Z_REACH, with the first one's number; more than
 * WR_Z_ENTRIES pieces; no memory; cancelled. */
bool wr_zbuffer_draw(const WrZScene *scene, const WrGenerateJob *job, WrNormalMips *out,
                     WrError *err);

/* Squares of 8 x 8 texels in which this process has drawn solids so far, for tests that count work. */
int64_t wr_zbuffer_squares(void);
