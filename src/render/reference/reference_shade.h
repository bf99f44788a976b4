/* reference_shade.h - shading of a surface point, from normal to light, for the reference. Private to the
   reference. */
#pragma once
#include "base/vec.h"
#include "noise/octaves.h"
#include "render/reference/reference_relief.h"
#include "render/reference/reference_intersect.h"
#include "scene/scene.h"
#include "shade/bump_mode.h"
#include "shade/reflection.h"

#include <stdbool.h>

typedef struct WrReferenceStage WrReferenceStage;

/* ---- environment light ---- */

/* Environment light for the reference: a lamp's formulas integrated over all
   directions. Private to the reference. Uses its own fetch and none of the renderer's kernels, harmonics or
   lobes. */

typedef struct WrScene WrScene;

/* A part of the sphere, as one lamp: the mean direction of its light, and that light times its solid angle over
   pi. */
typedef struct WrReferenceSector {
    WrVec3 where; /* the object's axes; unit */
    double rgb[3];
} WrReferenceSector;

/* The part of an integral over directions that one sample computes, standing for all. The samples of a pixel
   take different parts, so that together they cover each several times. */
typedef struct WrReferenceShare {
    int part, of; /* 0 <= part < of; of 1: all */
} WrReferenceShare;

/* directions of facets along each axis, over which highlights are summed */
#define WR_REFERENCE_FACETS 48

typedef struct WrReferenceSurround {
    WrReferenceSector *sectors; /* [count], owned; NULL: no environment */
    int count;
    double rotation[9];
    double turn[2];                        /* cosine and sine of the user's turn */
    double around[WR_REFERENCE_FACETS][2]; /* rotations of facets about the normal */
} WrReferenceSurround;

/* ---- shading ---- */

/* An object as a shadow caster: without culling, back faces and hidden faces included. */
typedef struct WrReferenceCaster {
    WrReferenceView view; /* its members are borrowed from the stage's view */
    const WrReferenceStage *stage;
} WrReferenceCaster;

/* Everything shared by the samples of one picture; read only while they are computed. */
struct WrReferenceStage {
    const WrScene *scene; /* borrowed */
    WrReferenceView view;
    WrReferenceTable table; /* empty if F is a formula or has no height */
    WrReferenceSurround surround;
    /* of a displaced surface, after wr_reference_stage_raise; else without sheets */
    WrReferenceRaised raised;
    WrMatter matter;             /* for models other than Blinn-Phong */
    WrMatter *rough;             /* `matter` for 256ths of roughness, if roughness varies; owned */
    WrOctavesPlan grain;         /* the solid texture's noise */
    WrBumpMode bump;             /* the mode that the reference considers true */
    bool periodic_u, periodic_v; /* of the colour picture, equal to the table's */
    double shadow;    /* height range, scene units, of a relief that casts shadows; else 0 */
    double relief;    /* height range of a relief that casts shadows or occludes; else 0 */
    double texels[2]; /* texels of the table along u and v of the patch */
    bool parallax;    /* rays continue to the relief, which is between these two: */
    double lowest, highest, cells[2]; /* and has one bend in each of this many cells */
    /* [caster_count], borrowed: all objects of the picture; or NULL */
    const WrReferenceCaster *casters;
    int caster_count;
};

/* Prepares a stage. field may be NULL if the scene's F is a formula. table: also computes its coefficients.
   Errors: no field; an invalid camera; no memory. Call fini even then. */
bool wr_reference_stage_init(WrReferenceStage *stage, const WrField *field, const WrScene *scene,
                             double turn_deg, int width, int height, bool table, WrPool *pool,
                             WrError *err);
/* True if F displaces the surface itself. */
bool wr_reference_displaced(const WrScene *scene);
/* Makes rays intersect P + F n of a displaced surface; the stage must not move in memory. Errors: as
   wr_reference_raised_init. */
bool wr_reference_stage_raise(WrReferenceStage *stage, const WrField *field, WrPool *pool,
                              WrError *err);
void wr_reference_stage_fini(WrReferenceStage *stage); /* also for a zeroed one */

/* F with height and replication: the formula, or the spline of the stage's table. */
void wr_reference_height(const WrReferenceStage *stage, double u, double v, double *f, double *fu,
                         double *fv);
/* F at a hit, with the weights of a mesh (surface/relief_weights.h). */
void wr_reference_height_at(const WrReferenceStage *stage, const WrReferenceHit *hit, double *f,
                            double *fu, double *fv);
/* Adds the slopes of the scene's normal map. */
void wr_reference_add_map(const WrReferenceStage *stage, const WrReferenceHit *hit,
                          const WrSurfacePoint *at, double *fu, double *fv);
/* n', unit, by the formulas of shade/bump.h written out if their numbers have ordinary size, by that module
   otherwise. */
WrVec3 wr_reference_normal(WrBumpMode mode, const WrSurfacePoint *at, double f, double fu,
                           double fv);
/* +1 if n points to the viewer's side of the surface, -1 on back faces. */
double wr_reference_side(const WrReferenceView *view, const WrSurfacePoint *at);
/* I = C (ka + sum kd L max(0, n'.l)) + sum ks L max(0, n'.h)^s, with the material's gate of the highlight.
   perturbed: n' facing the viewer. share: of environment light. */
void wr_reference_light(const WrReferenceStage *stage, const WrSurfacePoint *at,
                        const WrReferenceHit *hit, WrVec3 perturbed, WrReferenceShare share,
                        double rgb[3]);

/* Adds one light of strength 1: own is multiplied by the surface's colour, white is not. matter: of the
   material. */
void wr_reference_lamp(const WrMaterial *material, const WrMatter *matter, WrVec3 n, WrVec3 l,
                       WrVec3 v, const double colour[3], double own[3], double *white);

typedef struct WrReferenceSample {
    double rgb[3];
    WrVec3 normal; /* n' facing the viewer */
    bool lost;
    /* 1; less for a plane that fades towards the horizon; rgb is already multiplied by it */
    double cover;
    double depth; /* distance from the eye along the view, world units */
} WrReferenceSample;
/* The reference's intensity at (x, y), pixels from the top left corner; false outside the object. */
bool wr_reference_sample(const WrReferenceStage *stage, double x, double y, WrReferenceShare share,
                         WrReferenceSample *out);

/* ---- shadows of objects ---- */

/* Shadows of objects, for the reference: rays against the objects' own forms, in
   double. Private to the reference. */

/* Makes an object a shadow caster. The stage must not move in memory. */
void wr_reference_caster(WrReferenceCaster *caster, const WrReferenceStage *stage);
