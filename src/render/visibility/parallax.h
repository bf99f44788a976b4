/* parallax.h - where the eye's rays meet the relief over the tangent plane of the surface: parallax, with the outlines of what
   lies in front of what (E85).

   A ray q + t d that meets the base at (u,v) moves by t (a, b) in u and v, where d = a Pu + b Pv + (d.n) n. It is then
   t (d.n) + t^2 / 2 (a n_u + b n_v).(a Pu + b Pv) above the base, whose curvature is taken along with it, and ends where that
   is F. Flat bases: exactly; curved ones up to the third order of the way.
   A ray that leaves u, v of 0..1 where the surface ends, or the space between the lowest and the highest F, meets nothing.
   Those that pass beside a plane may meet what stands on it. A relief is seen from above: what would be seen from below its edge
   is left out.
   Spheres and cylinders: what lies at one distance over them is a sphere or a cylinder. Rays go through the shell between the lowest
   and the highest of these and ask each place for its own u, v and height, so that they meet the displaced surface itself, from
   within too, and its outline is seen beyond the base's (stage_parallax_shell_body.h). Of other curved bases outlines stay within the base's
   own: a torus' shell is a torus, which rays do not meet in closed form here, that of a cone has a round tip, and bodies out of
   profiles and formulas have none but by sampling.
   Elsewhere this is relief mapping or parallax occlusion mapping, of curved bases by a quadric (Oliveira, Policarpo, An Efficient
   Representation for Surface Details, UFRGS RP-351, 2005).
   Layer 5, private to the renderer. */
#pragma once
#include "render/plan/plan.h"
#include "render/textures/height_copies.h"

typedef struct WrField WrField;
typedef struct WrScene WrScene;

/* What holds of the heights that look-ups find; table units, per texel. */
typedef struct WrNormalMipsBounds {
    uint64_t key; /* of the table that they were found of */
    WrCopyKind copy;
    WrPrecision precision;
    bool known;
    double low, high, steep[2]; /* of F; of |Fu|, |Fv|, the largest */
} WrNormalMipsBounds;

/* Kernel units, by u and v of the patch. */
typedef struct WrParallax {
    int steps;        /* most of a ray, before the last ones that bisect */
    double low, high; /* F */
    double steep[2];  /* largest |Fu|, |Fv|; INFINITY: not known */
    double texels[2]; /* along u and v; 0: it is a formula */
    bool closed[2];   /* u, v go round */
    bool ends[2][2];  /* the surface ends at 0 and at 1, and is no point there */
    bool bent;        /* the base is curved */
    bool shell;       /* rays go through the shell about it (stage_parallax_shell_body.h) */
} WrParallax;

/* Is what lies at one distance over the base a surface of its own kind, met in closed form, whose points have its u and v? Then
   rays go through the shell that holds the relief. */
bool wr_parallax_has_shell(const WrShape *shape);
/* Bounds of the copy that the plan's scheme looks up, found anew after an edit. */
void wr_normal_mips_bounds_bring(WrNormalMipsBounds *bounds, const WrTable *table, WrScheme scheme,
                                 const WrField *field);
/* scale: scene units -> kernel units. bounds: of a table; not read of a formula. */
void wr_parallax_fill(WrParallax *parallax, const WrScene *scene, const WrField *field,
                      const WrNormalMipsBounds *bounds, const WrPlan *plan, double scale);
/* Lowest and highest F, units of which there are `unit` to one of the table. */
void wr_parallax_range(const WrScene *scene, const WrNormalMipsBounds *bounds, const WrPlan *plan,
                       double unit, double range[2]);
