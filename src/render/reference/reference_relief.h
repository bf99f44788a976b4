/* reference_relief.h - the relief for the reference: heights, displaced surfaces, their difference to bump mapping, parallax.
   Private to the reference. */
#pragma once
#include "render/reference/reference.h"
#include "render/reference/reference_intersect.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrReferenceStage WrReferenceStage;

/* ---- heights ---- */

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

typedef struct WrReferenceTable {
    int width, height; /* texels */
    bool periodic_u, periodic_v;
    /* subtracted from all texels first, so that a flat table has a slope of exactly 0 */
    double base;
    double *c;    /* [height + 4][width + 4] coefficients of F - base, two beyond each end; owned */
    size_t pitch; /* width + 4 */
} WrReferenceTable;

/* Computes the coefficients: (c[i-1] + 4 c[i] + c[i+1]) / 6 = T[i] on each axis. Missing texels of a clamped
   axis are on the quadratic through the three at its end (the end repeated if there are fewer). Errors: no
   memory. Same bits for any number of threads. */
bool wr_reference_table_init(WrReferenceTable *table, const WrField *field, WrPool *pool,
                             WrError *err);
void wr_reference_table_fini(WrReferenceTable *table); /* also for a zeroed one */

/* F and its derivatives at (u, v) of the patch, height and replication included, as in wr_scene_height; beyond
   the ends of a clamped axis F is constant and its slope 0. A table without coefficients yields 0. */
void wr_reference_table_at(const WrReferenceTable *table, const WrScene *scene, double u, double v,
                           double *f, double *fu, double *fv);

/* ---- displaced surfaces ---- */

/* Ray intersection with a displaced surface P + F n, for the reference. Private to the
   reference. Cells of about a texel with bounding boxes, a pyramid of those, and Newton's method in the cells
   that the ray enters. No facets.

   Where the domain ends two sheets may separate: at edges of a cube, at a seam across which F is not periodic.
   There the surface continues straight, from E + F n to the point nearest to both planes that E was displaced
   to; at a cube's corners to the point on all three. */

/* F and its derivatives by u and v of the patch. */
typedef void WrReferenceHeight(const void *ctx, double u, double v, double *f, double *fu,
                               double *fv);

typedef struct WrRaisedSheet WrRaisedSheet;
typedef struct WrReferenceRaised {
    const WrShape *shape; /* borrowed */
    WrReferenceHeight *height;
    const void *ctx;       /* borrowed: argument of height */
    WrRaisedSheet *sheets; /* [count], owned; count 0: the surface is not displaced */
    int count;
    double size; /* of the object with its relief, object units */
    /* Relief on a mesh: triangles within 2^-12 of its radius, their faces, and the mesh; else unused. */
    WrReferenceMesh facets;
    int32_t *base_of;
    WrTriangles *base;
} WrReferenceRaised;

#define WR_RAISED_MAX 0x400000 /* cells */

/* Builds cells and boxes. cells: numbers over all of u and v for which F has at most one bend per cell. Errors:
   more cells than WR_RAISED_MAX; no memory. Call fini even then. */
bool wr_reference_raised_init(WrReferenceRaised *raised, const WrShape *shape,
                              WrReferenceHeight *height, const void *ctx, const double cells[2],
                              WrPool *pool, WrError *err);
/* The same for the scene's mesh. field: NULL with a formula. */
bool wr_reference_raised_mesh_init(WrReferenceRaised *raised, const WrScene *scene,
                                   const WrField *field, WrPool *pool, WrError *err);
void wr_reference_raised_fini(WrReferenceRaised *raised); /* also for a zeroed one */
/* Nearest hit beyond s_min: fills s, u, v, face and lost; of a mesh the triangle and share of the base. */
bool wr_reference_raised_hit(const WrReferenceRaised *raised, const WrReferenceRay *ray,
                             WrReferenceHit *hit);

/* ---- displacement against bump mapping ---- */

/* Difference between displacement and bump mapping: screen position and light
   of surface points. Both at the same u and v, in double, without shadows. */

typedef struct WrMoved {
    int64_t places;            /* pixels whose centre shows the displaced surface */
    double way_mean, way_most; /* distance in pixels between the images of P and P + F n */
    /* linear intensity: P + F n with its own normal minus P with the bump mode's */
    double light_rms;
} WrMoved;

/* Measures the scene's displaced objects; others are ignored and hide nothing. Errors: as wr_reference_render. */
bool wr_reference_displacement_difference(const WrReferenceRequest *request, WrPool *pool,
                                          WrMoved *out, WrError *err);

/* ---- parallax ---- */

/* Parallax for the reference: ray march from the base to the relief above its tangent
   plane, or through the shell of a round base (parallax.h), by short even steps and bisection, in double.
   Private to the reference. */

/* True if the scene uses parallax and it is supported. */
bool wr_reference_has_parallax(const WrScene *scene);
/* Prepares the range of F, object units, and the number of cells with at most one bend each; field may be NULL
   if F is a formula. */
void wr_reference_parallax_init(WrReferenceStage *stage, const WrField *field,
                                const double cells[2]);
/* Hit of the ray on the relief: the base's point there with P on the ray; side: 1, or -1 on back faces. false:
   no hit. */
bool wr_reference_parallax(const WrReferenceStage *stage, const WrReferenceRay *ray,
                           WrReferenceHit *hit, WrSurfacePoint *at, double *side);
