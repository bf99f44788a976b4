/* grades.h - surroundings blurred by lobes of several widths, and the shares of light at steps of roughness: for surfaces whose
   roughness changes from sample to sample, or is widened by slopes.
   Layer 5, private to the renderer. Kept from frame to frame. */
#pragma once
#include "render/mirror.h"
#include "shade/vary.h"

typedef struct WrPlan WrPlan;
typedef struct WrScene WrScene;
typedef struct WrTileJob WrTileJob;

typedef struct WrGrades {
    WrMirror rung[WR_VARY_RUNGS]; /* those that are called for */
    WrReflectance of;             /* what vary was made of */
    double ks, tint;
    bool gated, there;
    WrVary vary;
} WrGrades;

bool wr_grades_bring(WrGrades *grades, const WrScene *scene, const WrPlan *plan, WrPool *pool,
                     WrError *err);
void wr_grades_fill(const WrGrades *grades, const WrScene *scene, WrTileJob *job);
void wr_grades_drop(WrGrades *grades);
void wr_grades_drop_rungs(WrGrades *grades); /* the shares of light, which take some time, stay */
