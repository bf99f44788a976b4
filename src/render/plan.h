/* plan.h - which effects a scene calls for, and why: the shortest list of stages that gives the right
   picture. Nothing that is not on it is computed, allocated or kept.
   Layer 5. Rules are named E1, E2, ... as in the guide, ui/guide/plan.md, whose table is made from this one. */
#pragma once
#include "scene/scene.h"

/* How leaving an effect out is justified. */
typedef enum WrProof {
    WR_PROOF_IDENTICAL, /* I: the same bits */
    WR_PROOF_BOUNDED,   /* B: within a stated bound */
    WR_PROOF_POLICY     /* P: changes the picture, by the user's choice */
} WrProof;

/* What a row of the plan decides about; also the order in which `explain` prints. */
typedef enum WrEffect {
    WR_EFFECT_DIFFUSE,
    WR_EFFECT_SPECULAR,
    WR_EFFECT_COLOUR,
    WR_EFFECT_BUMP,
    WR_EFFECT_GRADIENT,
    WR_EFFECT_WIDE,
    WR_EFFECT_INVARIANT,
    WR_EFFECT_EXACT,
    WR_EFFECT_CURVATURE,
    WR_EFFECT_SAMPLES,
    WR_EFFECT_BOUND,
    WR_EFFECT_FILTER,
    WR_EFFECT_BACK,
    WR_EFFECT_DEPTH,
    WR_EFFECT_NEWTON,
    WR_EFFECT_PERSPECTIVE,
    WR_EFFECT_AGAIN,
    WR_EFFECT_SPREAD,
    WR_EFFECT_ROUNDED,
    WR_EFFECT_DOUBLE,
    WR_EFFECT_HALF,
    WR_EFFECT_COUNT
} WrEffect;

/* What is always true of an effect. */
typedef struct WrEffectInfo {
    const char *rule, *name; /* "E6", "bump" */
    WrProof proof;
    const char *left_out; /* when, for the guide */
} WrEffectInfo;
extern const WrEffectInfo wr_effects[WR_EFFECT_COUNT];

typedef struct WrPlanRow {
    const char *rule; /* "E6" */
    const char *name; /* "bump" */
    bool run;
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

/* The decision, read by the renderer. */
typedef struct WrPlan {
    WrPlanRow rows[WR_EFFECT_COUNT];
    bool diffuse, specular, colour;
    WrBumpMode bump; /* as simplified: NONE where the table has no slope, BLINN for exact on a flat
                            base, ... */
    bool need_heights;   /* F itself, not only its slopes */
    bool curvature;      /* n_u, n_v */
    bool gradient_table; /* central, nearest: slopes come from the table of central differences */
    bool wide;           /* reduce r u in double */
    bool mesh;           /* no closed form: mesh, depth buffer, Newton */
    int samples;         /* K of K x K; 1 where one sample is taken */
    WrSampling sampling;
    bool normals;     /* n' is worked out: a light depends on it, or the caller wants it */
    bool pyramid;     /* slopes are filtered over the pixel's footprint */
    bool anisotropic; /* of several look-ups */
    bool moments;     /* and their spread widens the highlight */
    bool lean;        /* by the whole covariance; else by its trace */
    bool bounded;     /* adaptive: a bound on the intensity's change is known here */
    bool shading_double, shading_half;
    /* What the last frame took: with the rows' seconds this adds up to `work`, the time of all threads together:
       preparing by the clock, the rest by the clock for each thread. */
    double cost[WR_COST_COUNT], work;
    int64_t shaded; /* its samples */
} WrPlan;

/* Of frames that make one picture: costs are added, a row runs that ran in any. */
void wr_plan_add(WrPlan *sum, const WrPlan *more);
/* The row about back faces once the eye is known. closed: the surface is; outside: and seen from there, so that its
   back is not looked at. */
void wr_plan_back(WrPlan *plan, bool closed, bool outside);

/* The row about rendering tiles again (E29), which the renderer decides: it alone knows the last frame. */
void wr_plan_again(WrPlan *plan, bool refresh, const char *reason);

/* What the planner may ask of the table; the renderer's caches answer. */
typedef struct WrTableFacts {
    bool flat;       /* every texel equal */
    bool zero;       /* every texel 0 */
    bool slope_free; /* the gradient table is 0 everywhere, though the table is not flat */
    bool normals;    /* the caller wants n' itself */
} WrTableFacts;

/* everything: leave nothing out that could be left out without changing a bit (class I); for comparing. */
void wr_plan_build(WrPlan *plan, const WrScene *scene, const WrDials *dials,
                   const WrTableFacts *facts, bool everything);
/* "I", "B", "P" */
const char *wr_proof_letter(WrProof proof);
