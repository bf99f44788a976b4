/* parallax.h - parameters of parallax: intersection of eye rays with the relief above the tangent plane, with
   self-occlusion (E85). Private to the renderer.

   A ray q + t d that hits the base at (u,v) moves by t (a, b) in u and v, where d = a Pu + b Pv + (d.n) n. Its
   height above the base is then t (d.n) + t^2 / 2 (a n_u + b n_v).(a Pu + b Pv), which includes the base's
   curvature. The ray ends where this equals F. Flat bases: exact; curved ones: up to the third order of the
   distance.

   A ray that leaves u, v of 0..1 where the surface ends, or the space between the lowest and the highest F, hits
   nothing. Rays that pass beside a plane may hit relief standing on it. A relief is seen from above: parts that
   would be visible from below its edge are left out.

   Spheres and cylinders: the offset surface at one distance is again a sphere or a cylinder. Rays pass through
   the shell between the lowest and the highest of these, and each point has its own u, v and height. So they hit
   the displaced surface itself, from inside too, and its outline extends beyond the base's
   (stage_parallax_body.h). For other curved bases the outline stays within the base's own: a torus' shell
   is a torus, which has no closed-form intersection here; that of a cone has a round tip; and surfaces from
   profiles and formulas could only be sampled.

   Otherwise this is relief mapping or parallax occlusion mapping, on curved bases with a quadric (Oliveira,
   Policarpo, An Efficient Representation for Surface Details, UFRGS RP-351, 2005). */
#pragma once
#include "render/plan/plan.h"
#include "render/textures/height_copies.h"

typedef struct WrField WrField;
typedef struct WrScene WrScene;

/* Bounds of the heights that fetches return; table units, per texel. */
typedef struct WrHeightBounds {
    uint64_t key; /* key of the measured table */
    WrCopyKind copy;
    WrPrecision precision;
    bool known;
    double low, high, steep[2]; /* of F; of |Fu|, |Fv|, the largest */
} WrHeightBounds;

/* In kernel units, by u and v of the patch. */
typedef struct WrParallax {
    int steps;        /* maximum steps of a ray, before the final bisections */
    double low, high; /* F */
    double steep[2];  /* largest |Fu|, |Fv|; INFINITY: unknown */
    double texels[2]; /* texels along u and v; 0: F is a formula */
    bool closed[2];   /* u, v are periodic */
    bool ends[2][2];  /* the surface ends at 0 and at 1, and that border is not a single point */
    bool bent;        /* the base is curved */
    bool shell;       /* rays pass through the shell around it (stage_parallax_body.h) */
} WrParallax;

/* True if the offset surface has the same kind as the base, a closed-form intersection, and the same u and v.
   Then rays pass through the shell that contains the relief. */
bool wr_parallax_has_shell(const WrShape *shape);
/* Updates the bounds of the copy that the plan's scheme fetches from, after an edit. */
void wr_height_bounds_update(WrHeightBounds *bounds, const WrTable *table, WrScheme scheme,
                             const WrField *field);
/* Fills the parameters. scale: scene units -> kernel units. bounds: of a table; not read with a formula. */
void wr_parallax_fill(WrParallax *parallax, const WrScene *scene, const WrField *field,
                      const WrHeightBounds *bounds, const WrPlan *plan, double scale);
/* Lowest and highest F, in units of which a table unit has `unit`. */
void wr_parallax_range(const WrScene *scene, const WrHeightBounds *bounds, const WrPlan *plan,
                       double unit, double range[2]);
