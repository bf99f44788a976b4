/* ladder.h - what each approximation costs: settings of the dials, each with its measured time and error
   against the reference, on one scene.
   Layer 6. */
#pragma once
#include "accuracy/metrics.h"
#include "base/error.h"
#include "base/text.h"
#include "scene/dials.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrProgress WrProgress;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

#define WR_SETTING_DIALS 6
#define WR_LADDER_RUNS 9 /* timed runs of a setting, at least */

/* What differs from the scene as it stands: so many dials at these values. */
typedef struct WrSetting {
    int count;
    int dial[WR_SETTING_DIALS]; /* WrDialId */
    double value[WR_SETTING_DIALS];
} WrSetting;

/* The scene with that setting, all of its objects with its scheme and normals; the caller frees it. */
WrScene *wr_setting_apply(const WrSetting *setting, const WrScene *scene);
/* The scene's own, all that matters of it: "scheme=central mode=blinn aa=supersample samples=4". */
void wr_setting_present(const WrScene *scene, WrText *text);
/* "scheme=bspline aa=supersample samples=4"; "as it stands" for none. */
void wr_setting_print(const WrSetting *setting, WrText *text);

typedef struct WrRung {
    WrSetting setting;
    char full[240]; /* all dials that matter with it, not only what differs */
    WrAxis axis;    /* that it stands on; WR_AXIS_COUNT: a combination, or the scene as it stands */
    bool current;   /* the scene as it stands */
    bool model; /* another model (invariant), not an approximation: never placed in an error plot */
    bool front; /* on the Pareto front of (seconds, errors.rms) */
    WrError note;    /* why a rung could not be measured; else empty, and the numbers below hold */
    double seconds;  /* median time of a frame: processor time on one thread, else wall time */
    double spread;   /* half the distance between the quartiles, seconds */
    int runs;        /* timed */
    int64_t shaded;  /* samples of a frame */
    WrErrors errors; /* with the scene's other dials as they stand */
    /* RMS with the dials of the other axes at their best, so that this axis' approximation is left alone;
       NAN for combinations */
    double own_rms;
    /* Of arithmetic, and dearer by its meaning than another value of the same dial, yet farther from the
       reference (own_rms): the program is at fault. Then that value and its own_rms. */
    bool fault;
    double fault_than, fault_rms;
} WrRung;

typedef struct WrLadder {
    WrRung *rungs; /* [count], owned */
    int count;
    WrReference reference;
    int width, height, threads;
    double
        arithmetic_rms; /* as own_rms: of the scene's own arithmetic; NAN where that axis was not measured */
    double blinn_phong,
        blinn_colour; /* measured ratios beside the paper's 4 and 2: frame time with bump
                                         over without, and over that with a colour picture; NAN where the
                                         scene does not allow it */
} WrLadder;

typedef struct WrLadderRequest {
    const WrField *const *fields; /* as in WrFrameRequest; NULL: `field` is that of all objects */
    const WrField *field;
    const WrScene *scene;
    int width, height; /* pixels */
    double turn_deg;
    int threads;          /* 1: pinned to one processor; 0: all */
    int runs;             /* 0: WR_LADDER_RUNS */
    int most;             /* of the reference's samples; 0: its own */
    double budget;        /* seconds for all of it; 0: none. Runs are cut, rungs never */
    WrAxis axis;          /* that alone; WR_AXIS_COUNT: all, and the combinations */
    WrProgress *progress; /* may be NULL; reports and cancels */
    /* Called with each measured rung's picture, [height][width][4], for difference pictures; may be NULL. */
    bool (*seen)(void *ctx, const WrRung *rung, const float *rgba, const WrReference *reference,
                 WrError *err);
    void *ctx;
} WrLadderRequest;

/* Zero-initialise *out. Settings are timed interleaved (1, 2, 3, 1, 2, 3, ...), so that drift of the
   machine hits all alike; errors from one untimed frame each. */
bool wr_ladder_measure(const WrLadderRequest *request, WrLadder *out, WrError *err);
void wr_ladder_fini(WrLadder *ladder);
/* Mark the rungs that no other beats in both time and error; models and unmeasured rungs are never on it. */
void wr_ladder_front(WrLadder *ladder);

/* Mark the rungs that are at fault; scene: that which was measured. */
void wr_ladder_faults(WrLadder *ladder, const WrScene *scene);
/* "heights=double is farther from the reference (1e-02) than heights=float (1e-05)"; false without a fault. */
bool wr_ladder_fault_print(const WrRung *rung, WrText *text);

/* The settings that wr_ladder_measure tries: the scene as it stands, each rung of each dial that matters,
 * one at a time, and the combinations that matter. Writes at most `room` rungs, of which only setting,
 * axis, current and model are set; returns how many there are. */
int wr_ladder_settings(const WrScene *scene, WrAxis axis, WrRung *out, int room);
/* The scene with the dials of all axes but one at their best; the caller frees it. */
WrScene *wr_ladder_best_but(const WrScene *scene, WrAxis axis);
