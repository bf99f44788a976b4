/* plan.h - which effects a scene calls for, and why: the shortest list of stages that gives the right
   picture. Nothing that is not on it is computed, allocated or kept.
   Layer 5. Rules are named E1, E2, ... as in the guide, ui/guide/plan.md, whose table is made from this one. */
#pragma once
#include "field/scheme.h"
#include "scene/dials.h"
#include "scene/normal_frame.h"
#include "shade/bump_mode.h"
#include "shade/solid_texture.h"
#include "shade/reflection.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrDials WrDials;
typedef struct WrScene WrScene;

/* How leaving an effect out is justified. */
typedef enum WrProof {
    WR_PROOF_IDENTICAL, /* I: the same bits */
    WR_PROOF_BOUNDED,   /* B: within a stated bound */
    WR_PROOF_POLICY,    /* P: changes the picture, by the user's choice */
    WR_PROOF_COUNT
} WrProof;

/* What a row of the plan decides about; also the order in which `explain` prints. */
typedef enum WrEffect {
    WR_EFFECT_DIFFUSE,
    WR_EFFECT_SPECULAR,
    WR_EFFECT_MODEL,
    WR_EFFECT_KEPT,
    WR_EFFECT_SURROUND,
    WR_EFFECT_HARMONICS,
    WR_EFFECT_MIRROR,
    WR_EFFECT_BLUR,
    WR_EFFECT_COLOUR,
    WR_EFFECT_TINT,
    WR_EFFECT_FACETS,
    WR_EFFECT_VARIED,
    WR_EFFECT_EMBOSSED,
    WR_EFFECT_GRAIN,
    WR_EFFECT_OCTAVES,
    WR_EFFECT_FADED,
    WR_EFFECT_NORMALS,
    WR_EFFECT_DISPLACED,
    WR_EFFECT_PARALLAX,
    WR_EFFECT_BUMP,
    WR_EFFECT_GRADIENT,
    WR_EFFECT_WIDE,
    WR_EFFECT_INVARIANT,
    WR_EFFECT_EXACT,
    WR_EFFECT_CURVATURE,
    WR_EFFECT_SHADOW,
    WR_EFFECT_CAST,
    WR_EFFECT_OCCLUSION,
    WR_EFFECT_SAMPLES,
    WR_EFFECT_BOUND,
    WR_EFFECT_FILTER,
    WR_EFFECT_BACK,
    WR_EFFECT_DEPTH,
    WR_EFFECT_NEWTON,
    WR_EFFECT_PERSPECTIVE,
    WR_EFFECT_AGAIN,
    WR_EFFECT_STEADY,
    WR_EFFECT_BESIDE,
    WR_EFFECT_SPREAD,
    WR_EFFECT_WIDENED,
    WR_EFFECT_FACED,
    WR_EFFECT_FAINT,
    WR_EFFECT_ROUNDED,
    WR_EFFECT_DOUBLE,
    WR_EFFECT_HALF,
    WR_EFFECT_PARAMETERS,
    WR_EFFECT_TANGENTS,
    WR_EFFECT_DARK,
    WR_EFFECT_GROUND,
    WR_EFFECT_HIDDEN,
    WR_EFFECT_BETWEEN,
    WR_EFFECT_SMOOTH,
    WR_EFFECT_BLOCKS,
    WR_EFFECT_HORIZON,
    WR_EFFECT_COUNT
} WrEffect;

/* A set of effects: a bit for each. */
typedef uint64_t WrEffects;
#define WR_EFFECT_BIT(effect) ((WrEffects)1 << (effect))
_Static_assert(WR_EFFECT_COUNT <= 64, "a bit for each effect");

/* What the renderer's clocks tell apart. */
typedef enum WrStage {
    WR_STAGE_VISIBILITY, /* rays against closed forms, or triangles into the depth tile */
    WR_STAGE_NEWTON,
    WR_STAGE_PARAMETERS, /* u and v of the points that rays met */
    WR_STAGE_GEOMETRY,
    WR_STAGE_PARALLAX, /* rays from the base on to the relief */
    WR_STAGE_CURVATURE,
    WR_STAGE_FOOTPRINT,
    WR_STAGE_LOOK,    /* F, Fu, Fv */
    WR_STAGE_PYRAMID, /* the same from the pyramid */
    WR_STAGE_NORMALS, /* a normal map's slopes */
    WR_STAGE_BUMP,
    WR_STAGE_SPREAD,
    WR_STAGE_COLOUR,
    WR_STAGE_TINT,   /* the colour picture over footprints */
    WR_STAGE_FACETS, /* pictures of roughness and metalness */
    WR_STAGE_GRAIN,  /* solid textures */
    WR_STAGE_DIFFUSE,
    WR_STAGE_SPECULAR,
    WR_STAGE_SURROUND,  /* diffuse light of surroundings */
    WR_STAGE_MIRROR,    /* what is reflected of them */
    WR_STAGE_SHADOW,    /* lamps that the relief hides */
    WR_STAGE_CAST,      /* lamps that objects hide */
    WR_STAGE_OCCLUSION, /* sky that it hides */
    WR_STAGE_LIGHT,     /* all of a single light in one pass */
    WR_STAGE_BOUND,
    WR_STAGE_HALF, /* rounding to half precision */
    WR_STAGE_RESOLVE,
    WR_STAGE_STORE,
    WR_STAGE_CLEAR,
    WR_STAGE_BETWEEN, /* depths of several objects compared */
    WR_STAGE_COUNT
} WrStage;

/* What a row says of a scene. */
typedef enum WrVerdict {
    WR_VERDICT_NONE,   /* nothing in the scene asks for it: there is nothing to run */
    WR_VERDICT_SPARED, /* it could run, and by the row's proof need not */
    WR_VERDICT_RUN
} WrVerdict;

typedef struct WrPlanRow {
    const char *rule;  /* "E6" */
    const char *name;  /* "bump" */
    WrVerdict verdict; /* whatever is forced */
    bool run;          /* decided: all that the renderer asks */
    bool ran;          /* recorded by what did it, in the last frame */
    WrProof proof;
    char reason[160]; /* one sentence */
    int64_t tiles,
        pixels;     /* that it ran on in the last frame: tiles of the picture, samples shaded */
    double seconds; /* that it took of the last frame, of all threads; 0: nothing that is its own */
    double ns_per_pixel; /* the same over the frame's samples */
} WrPlanRow;

/* What a frame takes besides its effects. */
typedef enum WrCost {
    WR_COST_PREPARE,    /* copies of the table, pyramids, the view, the mesh */
    WR_COST_VISIBILITY, /* which samples the object covers, in closed form */
    WR_COST_GEOMETRY,   /* points, tangents and normals of the surface */
    WR_COST_LIGHT,      /* diffuse light and highlight of a single light, in one pass */
    WR_COST_STORE,      /* colours put together and stored */
    WR_COST_CLEAR,      /* tiles emptied, and those left out that hold nothing */
    WR_COST_REST,       /* what lies between the stages: samples moved, loops */
    WR_COST_WAIT,       /* threads without a tile */
    WR_COST_CHOOSE,     /* under a tolerance: everything but its frames */
    WR_COST_COUNT
} WrCost;
extern const char *const wr_cost_names[WR_COST_COUNT], *const wr_cost_reasons[WR_COST_COUNT];

/* How many samples a pixel takes. */
typedef enum WrSampling {
    WR_SAMPLING_ONE,     /* one at its centre */
    WR_SAMPLING_ALL,     /* K x K */
    WR_SAMPLING_ADAPTIVE /* one, then more up to K x K where they are called for */
} WrSampling;

/* What F is looked up in. */
typedef enum WrSource {
    WR_SOURCE_NONE, /* it is not */
    WR_SOURCE_FORMULA,
    WR_SOURCE_TABLE
} WrSource;

/* What look-ups in double read. */
typedef enum WrPrecision {
    WR_PRECISION_SINGLE,  /* nothing: look-ups are in single precision */
    WR_PRECISION_WIDENED, /* the single-precision numbers, as doubles */
    WR_PRECISION_DOUBLE   /* numbers that were never rounded to single precision */
} WrPrecision;

/* What the plan settles beyond whether an effect runs: X(effect, type, name), each owned by one row. The
   renderer reads these and the rows, and neither scene nor dials, to choose what it does.
     model       how lamps are reflected; blinn-phong where that comes to the same
     tint        share of highlights that has the surface's colour
     kept        never more light than came: the model's form of that name
     faint       as the dial of that name
     grain       the solid texture's pattern; off: none is worked out, of colours the first is all
     map_filtered, map_anisotropic    the normal map's slopes over footprints
     facets_filtered, facets_anisotropic    likewise roughness and metalness
     map_frame   what its vectors are turned by; gradient where there are none
     bump        as simplified: BLINN for exact on a flat base, ...
     scheme      how the table is looked up
     normals     the surface's geometry and n' are worked out
     horizons    directions in which the table's are kept, for shadows too
     rays        to a round lamp that objects may hide
     samples     K of K x K; 1 where one sample is taken
     anisotropic, tint_anisotropic    of several look-ups
     lean        by the whole covariance; else by its trace
     graded      what is mirrored is blurred as widely as each sample calls for
     inversion   how rays meet the surface
     mesh, newton, texels, dice, steps, spread, refine, contrast    as the dials of that name
     heights     what they are rounded to
     harmonics, gloss    as the dials of that name */
#define WR_PLAN_SETTINGS(X)                                                                        \
    X(MODEL, WrReflect, model)                                                                     \
    X(MODEL, double, tint)                                                                         \
    X(KEPT, bool, kept)                                                                            \
    X(HARMONICS, int, harmonics)                                                                   \
    X(BLUR, double, gloss)                                                                         \
    X(TINT, bool, tint_anisotropic)                                                                \
    X(FACETS, bool, facets_filtered)                                                               \
    X(FACETS, bool, facets_anisotropic)                                                            \
    X(GRAIN, WrSolidTextureKind, grain)                                                            \
    X(NORMALS, bool, map_filtered)                                                                 \
    X(NORMALS, bool, map_anisotropic)                                                              \
    X(NORMALS, WrNormalFrame, map_frame)                                                           \
    X(DISPLACED, double, dice)                                                                     \
    X(PARALLAX, int, steps)                                                                        \
    X(BUMP, WrBumpMode, bump)                                                                      \
    X(BUMP, WrSource, source)                                                                      \
    X(BUMP, WrScheme, scheme)                                                                      \
    X(CURVATURE, bool, normals)                                                                    \
    X(CAST, int, rays)                                                                             \
    X(OCCLUSION, int, horizons)                                                                    \
    X(SAMPLES, int, samples)                                                                       \
    X(SAMPLES, WrSampling, sampling)                                                               \
    X(SAMPLES, WrSpread, spread)                                                                   \
    X(SAMPLES, WrRefine, refine)                                                                   \
    X(SAMPLES, double, contrast)                                                                   \
    X(FILTER, bool, anisotropic)                                                                   \
    X(DEPTH, WrInversion, inversion)                                                               \
    X(DEPTH, int, mesh)                                                                            \
    X(NEWTON, int, newton)                                                                         \
    X(NEWTON, double, texels)                                                                      \
    X(SPREAD, bool, lean)                                                                          \
    X(SPREAD, bool, graded)                                                                        \
    X(FAINT, double, faint)                                                                        \
    X(ROUNDED, WrHeights, heights)                                                                 \
    X(DOUBLE, bool, shading_double)                                                                \
    X(DOUBLE, WrPrecision, precision)

/* The decision, read by the renderer. */
typedef struct WrPlan {
    WrPlanRow rows[WR_EFFECT_COUNT];
#define WR_PLAN_MEMBER(effect, type, name) type name;
    WR_PLAN_SETTINGS(WR_PLAN_MEMBER)
#undef WR_PLAN_MEMBER
    /* What the last frame took: with the rows' seconds this adds up to `work`, the time of all threads together:
       preparing by the clock, the rest by the clock for each thread. */
    double cost[WR_COST_COUNT], work;
    int64_t shaded; /* its samples */
} WrPlan;

static inline bool wr_plan_runs(const WrPlan *plan, WrEffect effect)
{
    return plan->rows[effect].run;
}

/* Does the scene itself call for it, whatever is forced? For what decides about a picture's bits. */
static inline bool wr_plan_calls(const WrPlan *plan, WrEffect effect)
{
    return plan->rows[effect].verdict == WR_VERDICT_RUN;
}

/* Why a run of samples may be spared what the plan runs. */
typedef enum WrRun {
    WR_RUN_LEVEL = 1, /* no slope of the table is near */
    WR_RUN_DARK = 2,  /* all lights are behind it, however the table bends its normals */
    WR_RUN_DULL = 4,  /* no lamp's highlight is as bright as `dials faint=` */
    WR_RUN_KINDS = 8  /* all of them, some, none */
} WrRun;

/* What the planner may ask of the table, the view and the last frame; the renderer answers. */
typedef struct WrPlanFacts {
    bool flat;               /* every texel equal */
    bool zero;               /* every texel 0 */
    bool slope_free;         /* the gradient table is 0 everywhere, though the table is not flat */
    bool normals;            /* the caller wants n' itself */
    bool ends;               /* the table ends at an axis' ends: it does not repeat */
    bool outside;            /* the eye is outside a closed surface, for certain */
    bool lively;             /* adaptive: nearly all of the view's pixels need all samples */
    bool sighted;            /* what the view's samples look at is known from the last picture */
    bool steady;             /* and what light looks at of them */
    const char *steady_told; /* what becomes of those; NULL: they are new */
    int among;               /* objects that are shown; 0 or 1: this one alone */
    int hiders;              /* objects that can hide a lamp from this one, itself among them */
    double rise;             /* pixels that F could move a point at most; below 0: not known */
    bool rests;    /* the last picture is kept, and was made by the same plan of the same request */
    double sloped; /* the share of the table's tiles that have a slope; below 0: not known */
} WrPlanFacts;

/* Against the planner, for tests and as a yardstick. */
typedef enum WrForce {
    WR_FORCE_NONE,
    WR_FORCE_ON, /* where it could run */
    WR_FORCE_OFF /* where a picture is left without it */
} WrForce;

typedef struct WrPlanAsk {
    const WrScene *scene;
    const WrDials *dials;
    WrPlanFacts facts;
    const WrForce *force; /* [WR_EFFECT_COUNT]; NULL: nothing is forced */
    bool full;            /* all is forced on, but what would make the picture more exact */
} WrPlanAsk;

/* One effect: everything that is known of it stands in its row. */
typedef struct WrEffectInfo {
    const char *rule, *name; /* "E6", "bump" */
    WrProof proof;
    const char *bound;    /* of class B: how far off the picture is without it; else NULL */
    const char *left_out; /* when, for the guide */
    unsigned stages; /* bits of WrStage; of one that several own the last that runs has the time */
    bool only_way;   /* where it runs there is no picture without it */
    unsigned spared; /* bits of WrRun: runs of samples that are spared it where it runs */
    bool
        manner; /* it settles how a picture is made, never which: plans that differ in it make the same */
    bool finer; /* run where it could be left out, it makes the picture more exact: other bits */
    /* Does the scene call for it, and why? Rows before it are decided. */
    WrVerdict (*decide)(const WrPlan *plan, const WrPlanAsk *ask, const char **why);
    /* Fill what it owns of WR_PLAN_SETTINGS, once its row is decided; NULL: nothing. */
    void (*settle)(WrPlan *plan, const WrPlanAsk *ask);
} WrEffectInfo;
extern const WrEffectInfo wr_effects[WR_EFFECT_COUNT];

void wr_plan_build(WrPlan *plan, const WrPlanAsk *ask);
/* The rows once more that go by what is known when plans have been compared, and copies of the table made: those that
   settle how the picture is made. */
void wr_plan_again(WrPlan *plan, const WrPlanAsk *ask);
/* The rows about samples once more: whether a view is lively is known when it has been looked at. */
void wr_plan_samples(WrPlan *plan, const WrPlanAsk *ask);
/* Do both make the same picture of one scene? All that rows own is compared, but how it is made. */
bool wr_plan_same(const WrPlan *a, const WrPlan *b);
/* Of frames that make one picture: costs are added, a row runs that ran in any. */
void wr_plan_add(WrPlan *sum, const WrPlan *more);
/* A stage's seconds: to the effect that owns it, if one runs, else to the cost that it is part of. */
void wr_plan_charge(WrPlan *plan, WrStage stage, double seconds);

/* "I", "B", "P" */
const char *wr_proof_letter(WrProof proof);
