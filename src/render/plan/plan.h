/* plan.h - render plan: the effects that a scene needs, with reasons, and the shortest list of stages for a
   correct picture. Nothing outside the plan is computed, allocated or kept. Rules are named E1, E2, ... as in
   the guide, ui/guide/plan.md, whose table is generated from this one. */
#pragma once
#include "field/scheme.h"
#include "scene/dials.h"
#include "scene/normal_map_frame.h"
#include "shade/bump_mode.h"
#include "shade/solid_texture.h"
#include "shade/reflection.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrDials WrDials;
typedef struct WrScene WrScene;

/* Justification for leaving an effect out. */
typedef enum WrProof {
    WR_PROOF_IDENTICAL, /* I: identical bits */
    WR_PROOF_BOUNDED,   /* B: within a stated bound */
    WR_PROOF_POLICY,    /* P: changes the picture, by the user's choice */
    WR_PROOF_COUNT
} WrProof;

/* The subject of each row of the plan; also the order in which `explain` prints. */
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
    WR_EFFECT_REORIENTED,
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

/* A set of effects: one bit for each. */
typedef uint64_t WrEffects;
#define WR_EFFECT_BIT(effect) ((WrEffects)1 << (effect))
_Static_assert(WR_EFFECT_COUNT <= 64, "a bit for each effect");

/* Timed stages of the renderer. */
typedef enum WrStage {
    WR_STAGE_VISIBILITY, /* closed-form ray hits, or triangles into the depth tile */
    WR_STAGE_NEWTON,
    WR_STAGE_PARAMETERS, /* u and v of the hits */
    WR_STAGE_GEOMETRY,
    WR_STAGE_PARALLAX, /* rays from the base to the relief */
    WR_STAGE_CURVATURE,
    WR_STAGE_FOOTPRINT,
    WR_STAGE_LOOK,    /* F, Fu, Fv */
    WR_STAGE_PYRAMID, /* F, Fu, Fv from the pyramid */
    WR_STAGE_NORMALS, /* a normal map's slopes */
    WR_STAGE_BUMP,
    WR_STAGE_SPREAD,
    WR_STAGE_COLOUR,
    WR_STAGE_TINT,   /* the colour picture, filtered over footprints */
    WR_STAGE_FACETS, /* roughness and metalness pictures */
    WR_STAGE_GRAIN,  /* solid textures */
    WR_STAGE_DIFFUSE,
    WR_STAGE_SPECULAR,
    WR_STAGE_SURROUND,  /* diffuse light of the environment */
    WR_STAGE_MIRROR,    /* reflection of the environment */
    WR_STAGE_SHADOW,    /* shadows of the relief */
    WR_STAGE_CAST,      /* shadows of objects */
    WR_STAGE_OCCLUSION, /* ambient occlusion by the relief */
    WR_STAGE_LIGHT,     /* a single light, in one pass */
    WR_STAGE_BOUND,
    WR_STAGE_HALF, /* rounding to half precision */
    WR_STAGE_RESOLVE,
    WR_STAGE_STORE,
    WR_STAGE_CLEAR,
    WR_STAGE_BETWEEN, /* depth test between several objects */
    WR_STAGE_COUNT
} WrStage;

/* Decision of a row for a scene. */
typedef enum WrVerdict {
    WR_VERDICT_NONE,   /* not applicable: the scene has nothing for it to do */
    WR_VERDICT_SPARED, /* it could run, but the row's proof shows that it need not */
    WR_VERDICT_RUN
} WrVerdict;

typedef struct WrPlanRow {
    const char *rule;  /* "E6" */
    const char *name;  /* "bump" */
    WrVerdict verdict; /* without forced effects */
    bool run;          /* final decision; the renderer reads only this */
    bool ran;          /* set by the code that ran it, in the last frame */
    WrProof proof;
    char reason[160];      /* one sentence */
    int64_t tiles, pixels; /* tiles and shaded samples on which it ran in the last frame */
    /* its time in the last frame, summed over threads; 0: it has no time of its own */
    double seconds;
    double ns_per_pixel; /* `seconds` divided by the frame's samples, ns */
} WrPlanRow;

/* Costs of a frame outside its effects. */
typedef enum WrCost {
    WR_COST_PREPARE,    /* table copies, pyramids, the view, the mesh */
    WR_COST_VISIBILITY, /* coverage of samples, in closed form */
    WR_COST_GEOMETRY,   /* points, tangents and normals of the surface */
    WR_COST_LIGHT,      /* diffuse light and highlight of a single light, in one pass */
    WR_COST_STORE,      /* composing colours and storing them */
    WR_COST_CLEAR,      /* clearing tiles, and skipping empty ones */
    WR_COST_REST,       /* between the stages: moving samples, loops */
    WR_COST_WAIT,       /* idle threads without a tile */
    WR_COST_CHOOSE,     /* under a tolerance: everything except its frames */
    WR_COST_COUNT
} WrCost;
extern const char *const wr_cost_names[WR_COST_COUNT], *const wr_cost_reasons[WR_COST_COUNT];

/* Sampling of a pixel. */
typedef enum WrSampling {
    WR_SAMPLING_ONE,     /* one sample at its centre */
    WR_SAMPLING_ALL,     /* K x K */
    WR_SAMPLING_ADAPTIVE /* one, then more up to K x K where needed */
} WrSampling;

/* Source of F. */
typedef enum WrSource {
    WR_SOURCE_NONE, /* F is not fetched */
    WR_SOURCE_FORMULA,
    WR_SOURCE_TABLE
} WrSource;

/* Source numbers of fetches in double precision. */
typedef enum WrPrecision {
    WR_PRECISION_SINGLE,  /* none: fetches are in single precision */
    WR_PRECISION_WIDENED, /* single-precision numbers converted to double */
    WR_PRECISION_DOUBLE   /* double-precision numbers, never rounded to single */
} WrPrecision;

/* Settings of the plan beyond whether an effect runs: X(effect, type, name), each owned by one row. The renderer
   chooses by these and the rows alone, never by scene or dials.
     model       reflection model of lamps; blinn-phong where that is equivalent
     tint        share of highlights that has the surface's colour
     kept        energy conservation: the model's form of that name
     faint       as the dial of that name
     grain       pattern of the solid texture; off: none is computed, its first colour is used
     map_filtered, map_anisotropic    filtering of the normal map's slopes over footprints
     facets_filtered, facets_anisotropic    filtering of roughness and metalness
     map_frame   tangent frame of the normal map's vectors; gradient if it has none
     bump        after simplification: BLINN for exact on a flat base, ...
     scheme      interpolation scheme of the table
     combine     combination of the table's slopes with the normal map's
     normals     the surface's geometry and n' are computed
     horizons    number of horizon directions of the table, for shadows too
     rays        number of shadow rays to an area lamp
     samples     K of K x K; 1 if one sample is taken
     anisotropic, tint_anisotropic    filtering by several fetches along the footprint
     lean        widened by the whole covariance; else by its trace
     graded      mirrored environment blurred individually for each sample
     inversion   method of the ray intersection
     mesh, newton, texels, dice, steps, spread, refine, contrast    as the dials of that name
     heights     quantization of the heights
     harmonics, gloss    as the dials of that name */
#define WR_PLAN_SETTINGS(X)                                                                        \
    X(MODEL, int, model) /* WrReflect */                                                           \
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
    X(REORIENTED, WrCombine, combine)                                                              \
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

/* The plan of a frame, read by the renderer. */
typedef struct WrPlan {
    WrPlanRow rows[WR_EFFECT_COUNT];
#define WR_PLAN_MEMBER(effect, type, name) type name;
    WR_PLAN_SETTINGS(WR_PLAN_MEMBER)
#undef WR_PLAN_MEMBER
    /* Costs of the last frame. Together with the rows' seconds they add up to `work`, the time of all threads:
       preparation by wall time, the rest by each thread's time. */
    double cost[WR_COST_COUNT], work;
    int64_t shaded; /* samples shaded in the last frame */
} WrPlan;

static inline bool wr_plan_runs(const WrPlan *plan, WrEffect effect)
{
    return plan->rows[effect].run;
}

/* True if the scene itself needs the effect, ignoring forced ones. For decisions that affect a picture's bits. */
static inline bool wr_plan_calls(const WrPlan *plan, WrEffect effect)
{
    return plan->rows[effect].verdict == WR_VERDICT_RUN;
}

/* Reasons for skipping an effect in a run of samples. */
typedef enum WrRun {
    WR_RUN_LEVEL = 1, /* no slope of the table is near */
    WR_RUN_DARK = 2,  /* all lights are behind the surface, however the table bends its normals */
    WR_RUN_DULL = 4,  /* no lamp's highlight reaches the brightness `dials faint=` */
    WR_RUN_KINDS = 8  /* number of combinations */
} WrRun;

/* Facts about table, view and last frame that the planner reads; the renderer fills them in. */
typedef struct WrPlanFacts {
    bool flat;       /* every texel equal */
    bool zero;       /* every texel 0 */
    bool slope_free; /* the gradient table is 0 everywhere, although the table is not flat */
    bool normals;    /* the caller requests n' itself */
    bool ends;       /* the table ends at the ends of an axis: it does not repeat */
    bool outside;    /* the eye is certainly outside a closed surface */
    bool lively;     /* adaptive: nearly all pixels of the view need all samples */
    bool uv_cached;  /* the uv cache holds the view */
    bool relight;    /* the relight cache holds it, too */
    const char *relight_status; /* status of the relight cache; NULL: it is new */
    int among;                  /* visible objects; 0 or 1: this one alone */
    int hiders;                 /* objects that can hide a lamp from this one, including itself */
    double rise;                /* largest displacement by F, in pixels; below 0: unknown */
    bool rests; /* the last picture is kept, and was made by the same plan for the same request */
    double sloped; /* share of the table's tiles that have a slope; below 0: unknown */
} WrPlanFacts;

/* Effects forced on or off, for tests and comparisons. */
typedef enum WrForce {
    WR_FORCE_NONE,
    WR_FORCE_ON, /* wherever it can run */
    WR_FORCE_OFF /* wherever a picture remains without it */
} WrForce;

typedef struct WrPlanRequest {
    const WrScene *scene;
    const WrDials *dials;
    WrPlanFacts facts;
    const WrForce *force; /* [WR_EFFECT_COUNT]; NULL: nothing is forced */
    bool full; /* everything is forced on, except effects that would make the picture more exact */
} WrPlanRequest;

/* Description of one effect: all facts about it are in its row. */
typedef struct WrEffectInfo {
    const char *rule, *name; /* "E6", "bump" */
    WrProof proof;
    const char *bound;    /* of class B: error of the picture without it; else NULL */
    const char *left_out; /* condition for leaving it out, for the guide */
    /* bits of WrStage; if several effects own a stage, the last one that runs gets its time */
    unsigned stages;
    bool only_way;   /* where it runs, there is no picture without it */
    unsigned spared; /* bits of WrRun: runs of samples in which it is skipped */
    bool manner;     /* it changes the method only: plans that differ in it make the same picture */
    bool finer; /* running it where it could be left out makes the picture more exact: other bits */
    /* Decides whether the scene needs it, and the reason. Rows before it are decided. */
    WrVerdict (*decide)(const WrPlan *plan, const WrPlanRequest *ask, const char **why);
    /* Fills its own WR_PLAN_SETTINGS once its row is decided; NULL: it has none. */
    void (*settle)(WrPlan *plan, const WrPlanRequest *ask);
} WrEffectInfo;
extern const WrEffectInfo wr_effects[WR_EFFECT_COUNT];

void wr_plan_build(WrPlan *plan, const WrPlanRequest *ask);
/* Decides again the rows that depend on comparing plans and on table copies; these change only the method, not
   the picture. */
void wr_plan_again(WrPlan *plan, const WrPlanRequest *ask);
/* Decides the sampling rows again, once adaptive sampling has probed the view. */
void wr_plan_samples(WrPlan *plan, const WrPlanRequest *ask);
/* True if both plans make the same picture of one scene. Compares everything that rows own, except the method. */
bool wr_plan_same(const WrPlan *a, const WrPlan *b);
/* Adds up frames that make one picture: costs are added; an effect has run if it ran in any frame. */
void wr_plan_add(WrPlan *sum, const WrPlan *more);
/* Adds a stage's seconds to the effect that owns it, if one runs, else to the cost that it belongs to. */
void wr_plan_charge(WrPlan *plan, WrStage stage, double seconds);

/* "I", "B", "P" */
const char *wr_proof_letter(WrProof proof);
