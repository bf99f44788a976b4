/* plan.h - which effects a scene calls for, and why: the shortest list of stages that gives the right
   picture. Nothing that is not on it is computed, allocated or kept.
   Layer 5. Rule names E1.. are those of the planner's table (README, "The plan"). */
#pragma once
#include "scene/scene.h"

/* How a decision is proved. */
typedef enum WrProof {
    WR_PROOF_IDENTICAL, /* I: leaving it out gives the same bits */
    WR_PROOF_BOUNDED,   /* B: within a stated bound */
    WR_PROOF_POLICY     /* P: changes the picture by choice */
} WrProof;

typedef struct WrPlanEffect {
    const char *rule; /* "E6" */
    const char *name; /* "bump" */
    bool run;
    WrProof proof;
    char reason[160];    /* one sentence */
    int64_t tiles, pixels; /* that it ran on in the last frame */
    double ns_per_pixel; /* measured in the last frame; 0 if it did not run */
} WrPlanEffect;

#define WR_PLAN_MAX 32

/* Stages in force, read by the renderer. */
typedef struct WrPlan {
    WrPlanEffect effects[WR_PLAN_MAX];
    int count;
    bool diffuse, specular, colour;
    WrBumpMode bump;      /* as simplified: NONE where the table is proved flat, BLINN for exact on flat
                             surfaces, ... */
    bool need_f;          /* heights themselves, not only slopes */
    bool curvature;       /* n_u, n_v */
    bool gradient_table;  /* central, nearest: from the table of central differences */
    bool newton, perspective, depth_buffer;
    int samples;          /* K of K x K */
} WrPlan;

/* What the planner may ask of the table without reading it all: filled by the renderer's caches. */
typedef struct WrTableFacts {
    bool flat;          /* every texel equal */
    bool slope_free;    /* the scheme's gradient is 0 everywhere (flat, or invisible to the scheme) */
} WrTableFacts;

void wr_plan_build(const WrScene *scene, const WrDials *dials, const WrTableFacts *facts,
                   bool everything, WrPlan *plan);
const WrPlanEffect *wr_plan_find(const WrPlan *plan, const char *rule);
