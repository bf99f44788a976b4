/* zbuffer.h - a depth buffer over the table: triangles and solids seen from straight above, in
   parallel projection along -Z (Blinn 1978, figure 7: the Z values are the bump function).
   Private to this module.

   Texel coordinates: texel (i, j) has its centre at x = i, y = j, y down; z, also in texels, rises
   towards the viewer. On periodic axes every primitive exists with all its images. Depth is exact at
   texels' centres. If only a part of a texel is covered, without its centre, depth is taken at the
   covered sample nearest to the centre. If the rims of solids cross a texel shared with other solids,
   or one part of a solid hides another, it is the mean over the covered samples. Coverage counts 16
   samples of a texel, no two in one row or column of sixteenths. Corners of triangles are rounded to
   1/1024 texel for coverage only, and edges follow the top-left rule, so that closed meshes have no
   cracks and no texel is counted twice. The greatest height wins, and of equal ones the first (HC80):
   the bytes are the same on any number of threads. Positions are rounded to 2^-20 texel (wr_z_place),
   so that a move by whole texels preserves every bit. */
#pragma once
#include "generate/generator.h"
#include "generate/zbuffer_intersect.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define WR_Z_SAMPLES 16
#define WR_Z_REACH 524288.0 /* maximum distance from the origin, in texels */
/* maximum pieces of all primitives and their images in tiles of the table */
#define WR_Z_ENTRIES 16777216

/* Rounds to 2^-20 texel: sums of such positions with whole texels are exact. */
static inline double wr_z_place(double x)
{
    return rint(x * 1048576.0) / 1048576.0;
}

typedef struct WrZTriangle {
    double x[3], y[3], z[3]; /* x, y from wr_z_place where rolls matter */
} WrZTriangle;

/* Solids of unit size about their origin, axes along Z. */
typedef enum WrZShape {
    WR_Z_SPHERE,   /* radius 1 */
    WR_Z_BOX,      /* -1..1 on each axis */
    WR_Z_CYLINDER, /* radius 1, z -1..1 */
    WR_Z_CONE,     /* radius 1 at z = -1, apex at z = 1 */
    WR_Z_CAPSULE,  /* radius 1, centres of its ends at z = -param and param; param >= 0 */
    WR_Z_TORUS,    /* ring of radius 1 in the plane z = 0, tube of radius param, 0 < param < 1 */
    WR_Z_LETTERS,  /* the body of `letters`, one texel of it per unit */
    WR_Z_SHAPES
} WrZShape;

/* The members used for many solids come first: see zbuffer.c. */
typedef struct WrZSolid {
    WrZShape shape;
    bool level;   /* its top is horizontal */
    bool round;   /* a sphere, an upright capsule, or a flat torus: rotationally symmetric about its
                  axis */
    double at[3]; /* texels: position of its origin, x and y by wr_z_place */
    double ring, tube; /* texels: radii of a flat torus */
    double middle;     /* z of the centre of the upper round end, or of the ring */
    double peak;       /* maximum z */
    double dome[6]; /* for a sphere, (x, y) from `at`: its top is d0 x + d1 y + d2 sqrt(rest) above
                    `at`, rest = 1 - d3 x x - d4 (y - d5 x)^2 */
    double param;
    const WrZLetters *letters; /* borrowed */
    /* row-major: unit solid -> texels (rotation and scale), y down */
    double pose[9];
    double inverse[9];               /* of pose */
    double left, right, top, bottom; /* texels from `at`: its bounding box */
} WrZSolid;

/* A rotation by angles about X, then Y, then Z, in degrees, right-handed with y up: rows of Rz Ry Rx. */
void wr_z_turn(const double rotate_deg[3], double out[9]);

/* Sets a solid scaled by size (texels per unit, on each axis), then rotated by `turn` (rows of a
 * rotation, y up). letters: for WR_Z_LETTERS, else NULL. Errors: a size not above 0, non-finite
 * numbers. */
bool wr_zsolid_set(WrZSolid *solid, WrZShape shape, double param, const WrZLetters *letters,
                   const double size[3], const double turn[9], const double at[3], WrError *err);

/* Height of its highest point above its origin, texels. Not for letters. */
double wr_zsolid_rise(const WrZSolid *solid);
/* The largest z of the solid at (x, y), texels; false beside it. */
bool wr_zsolid_top(const WrZSolid *solid, double x, double y, double *z);
/* wr_zsolid_top at many positions; -inf beside it. */
void wr_zsolid_tops(const WrZSolid *solid, int count, const double *x, const double *y, double *z);
/* True if no part of it is within `reach` texels of (x, y); false is inconclusive. */
bool wr_zsolid_far(const WrZSolid *solid, double x, double y, double reach);
static inline bool wr_zsolid_convex(const WrZSolid *solid)
{
    return solid->shape != WR_Z_TORUS && solid->shape != WR_Z_LETTERS;
}

typedef struct WrZScene {
    const WrZSolid *solids; /* [solid_count], before the triangles where heights are equal */
    int64_t solid_count;
    const WrZTriangle *triangles; /* [triangle_count]; either orientation; without area: ignored */
    int64_t triangle_count;
    double floor;         /* texels: lower parts are invisible and do not cover */
    double soft;          /* texels above the floor over which coverage fades in; 0: none */
    double scale, offset; /* height = offset + scale z, table units */
    bool hidden;          /* also draws hidden primitives, which changes no bit: for tests */
} WrZScene;

/* Draws the scene. Hidden primitives cost very little, whatever their size and number. Errors:
 * coordinates not finite or beyond WR_Z_REACH, with the index of the first one; more than WR_Z_ENTRIES
 * pieces; out of memory; cancelled. */
bool wr_zbuffer_draw(const WrZScene *scene, const WrGenerateJob *job, WrRelief *out, WrError *err);

/* Number of squares of 8 x 8 texels in which this process has drawn solids, for tests that count work. */
int64_t wr_zbuffer_squares(void);
