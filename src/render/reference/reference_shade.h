/* reference_shade.h - from a place on the surface to its normal and its light, for the reference.
   Layer 5, private to the reference. */
#pragma once
#include "noise/octaves.h"
#include "render/reference/reference_displaced.h"
#include "render/reference/reference_environment.h"
#include "render/reference/reference_heights.h"
#include "render/reference/reference_view.h"
#include "scene/scene.h"
#include "shade/bump_mode.h"

#include <stdbool.h>

typedef struct WrReferenceStage WrReferenceStage;

/* An object as shadow rays meet it: its backs and hidden faces are there. */
typedef struct WrReferenceCaster {
    WrReferenceView view; /* its members borrowed from the stage's own */
    const WrReferenceStage *stage;
} WrReferenceCaster;

/* All that samples of one picture share; read only while they are taken. */
struct WrReferenceStage {
    const WrScene *scene; /* borrowed */
    WrReferenceView view;
    WrReferenceTable table; /* empty where F is a formula or has no height */
    WrReferenceSurround surround;
    WrReferenceRaised raised; /* of a displaced surface, once it was raised; else without sheets */
    WrMatter matter;          /* of models other than Blinn-Phong's */
    WrMatter *rough; /* the same by 256ths of roughness, where a solid texture drives it; owned */
    WrOctavesPlan grain;         /* the solid texture's noise */
    WrBumpMode bump;             /* what the reference takes for the truth */
    bool periodic_u, periodic_v; /* of the colour picture, as of the table */
    double
        shadow; /* scene units from the lowest to the highest of a relief that throws shadows; else 0 */
    double relief;                    /* the same whether it throws shadows or occludes */
    double texels[2];                 /* of the table along u and v of the patch */
    bool parallax;                    /* rays go on to the relief, which lies between these two: */
    double lowest, highest, cells[2]; /* and has one bend in each of so many cells */
    const WrReferenceCaster
        *casters; /* [caster_count], borrowed: all objects of the picture; or NULL */
    int caster_count;
};

/* field may be NULL where the scene's F is a formula. table: also find its coefficients.
 * Errors: no field; a camera that cannot look; no memory. Call fini even then. */
bool wr_reference_stage_init(WrReferenceStage *stage, const WrField *field, const WrScene *scene,
                             double turn_deg, int width, int height, bool table, WrPool *pool,
                             WrError *err);
/* Does F move the surface itself? */
bool wr_reference_displaced(const WrScene *scene);
/* Rays meet P + F n from now on, of a surface that is displaced; the stage stays where it is. Errors: those of
 * wr_reference_raised_init. */
bool wr_reference_stage_raise(WrReferenceStage *stage, const WrField *field, WrPool *pool,
                              WrError *err);
void wr_reference_stage_fini(WrReferenceStage *stage); /* fine on a zeroed one */

/* F with height and replication: the formula, or the spline of the stage's table. */
void wr_reference_height(const WrReferenceStage *stage, double u, double v, double *f, double *fu,
                         double *fv);
/* What the scene's normal map adds to the slopes there. */
void wr_reference_add_map(const WrReferenceStage *stage, const WrReferenceHit *hit,
                          const WrSurfacePoint *at, double *fu, double *fv);
/* n', unit, by the formulas of shade/bump.h written out where their numbers are of ordinary size, by that
 * module's own where they are not. */
WrVec3 wr_reference_normal(WrBumpMode mode, const WrSurfacePoint *at, double f, double fu,
                           double fv);
/* +1 where n points to the viewer's side of the surface, -1 where its back is seen. */
double wr_reference_side(const WrReferenceView *view, const WrSurfacePoint *at);
/* I = C (ka + sum kd L max(0, n'.l)) + sum ks L max(0, n'.h)^s, the highlight gated as the material says.
 * perturbed: n' towards the viewer's side. share: of what surroundings send. */
void wr_reference_light(const WrReferenceStage *stage, const WrSurfacePoint *at,
                        const WrReferenceHit *hit, WrVec3 perturbed, WrReferenceShare share,
                        double rgb[3]);

/* What one light of strength 1 adds: in the surface's colour, and in its own. matter: of the material. */
void wr_reference_lamp(const WrMaterial *material, const WrMatter *matter, WrVec3 n, WrVec3 l,
                       WrVec3 v, const double colour[3], double own[3], double *white);

typedef struct WrReferenceSample {
    double rgb[3];
    WrVec3 normal; /* n' towards the viewer's side */
    bool lost;
    double cover; /* 1; of a plane that fades towards the horizon less; rgb holds it already */
    double depth; /* before the eye, along the view, in the world */
} WrReferenceSample;
/* The reference's intensity at (x, y), pixels from the top left corner; false where the object is not. */
bool wr_reference_sample(const WrReferenceStage *stage, double x, double y, WrReferenceShare share,
                         WrReferenceSample *out);
