/* accuracy_benchmark.h - time and error of each approximation of a scene, measured against the reference. An
   approximation is a setting of a dial: a rung. */
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
#define WR_ACCURACY_BENCHMARK_RUNS 9 /* minimum number of timed runs of a setting */

/* Differences from the scene's own dials: `count` dials with these values. */
typedef struct WrSetting {
    int count;
    int dial[WR_SETTING_DIALS]; /* WrDialId */
    double value[WR_SETTING_DIALS];
} WrSetting;

/* The scene with that setting, applied to all of its objects; the caller frees it. */
WrScene *wr_setting_apply(const WrSetting *setting, const WrScene *scene);
/* "scheme=bspline aa=supersample samples=4"; "as it stands" for an empty setting. */
void wr_setting_print(const WrSetting *setting, WrText *text);

typedef struct WrRung {
    WrSetting setting;
    char full[240]; /* all relevant dials, not only the differences */
    WrAxis axis;    /* axis of the dial; WR_AXIS_COUNT: a combination, or the scene's own setting */
    bool current;   /* the scene's own setting */
    /* a different model (invariant), not an approximation: never shown in an error plot */
    bool model;
    bool front; /* on the Pareto front of (seconds, errors.rms) */
    /* reason why a rung could not be measured; else empty, and the numbers below are valid */
    WrError note;
    double seconds;  /* median time of a frame: processor time on one thread, else wall time */
    double spread;   /* half the interquartile range, seconds */
    int runs;        /* number of timed frames */
    int64_t shaded;  /* samples of a frame */
    WrErrors errors; /* with the scene's other dials unchanged */
    /* RMS with the dials of the other axes at their best, so that only this axis' approximation remains; NAN for
       combinations */
    double own_rms;
    /* Arithmetic only: a setting that is more expensive by definition than another value of the same dial, yet
       farther from the reference (own_rms): a fault of the program. Then that value and its own_rms. */
    bool fault;
    double fault_than, fault_rms;
} WrRung;

typedef struct WrAccuracyBenchmark {
    WrRung *rungs; /* [count], owned */
    int count;
    WrReference reference;
    int width, height, threads;
    /* as own_rms, for the scene's own arithmetic; NAN if that axis was not measured */
    double arithmetic_rms;
    /* measured ratios for the paper's 4 and 2: frame time with bump divided by that without, and by that with a
       colour picture; NAN if the scene does not allow it */
    double blinn_phong, blinn_colour;
} WrAccuracyBenchmark;

typedef struct WrAccuracyBenchmarkRequest {
    const WrField *const *fields; /* as in WrFrameRequest; NULL: `field` for all objects */
    const WrField *field;
    const WrScene *scene;
    int width, height; /* pixels */
    double turn_deg;
    int threads;          /* 1: pinned to one processor; 0: all */
    int runs;             /* 0: WR_ACCURACY_BENCHMARK_RUNS */
    int most;             /* limit of the reference's samples; 0: its default */
    double budget;        /* seconds in total; 0: unlimited. Reduces runs, never rungs */
    WrAxis axis;          /* a single axis; WR_AXIS_COUNT: all, and the combinations */
    WrProgress *progress; /* may be NULL; receives progress and cancels */
    /* Called with each measured rung's picture, [height][width][4], for difference pictures; may be NULL. */
    bool (*seen)(void *ctx, const WrRung *rung, const float *rgba, const WrReference *reference,
                 WrError *err);
    void *ctx;
} WrAccuracyBenchmarkRequest;

/* Measures the benchmark. Zero-initialise *out. Settings are timed interleaved (1, 2, 3, 1, 2, 3, ...), so that
   drift of the machine affects all equally; errors are from one untimed frame each. */
bool wr_accuracy_benchmark_measure(const WrAccuracyBenchmarkRequest *request,
                                   WrAccuracyBenchmark *out, WrError *err);
void wr_accuracy_benchmark_fini(WrAccuracyBenchmark *benchmark);
/* Marks the Pareto front: rungs that no other beats in both time and error; never models and unmeasured rungs. */
void wr_accuracy_benchmark_front(WrAccuracyBenchmark *benchmark);

/* Marks the rungs that are at fault; scene: the measured one. */
void wr_accuracy_benchmark_faults(WrAccuracyBenchmark *benchmark, const WrScene *scene);
/* "heights=double is farther from the reference (1e-02) than heights=float (1e-05)"; false without a fault. */
bool wr_accuracy_benchmark_fault_print(const WrRung *rung, WrText *text);

/* The settings that wr_accuracy_benchmark_measure tries: the scene's own, each rung of each relevant dial, one at a time,
   and the relevant combinations. Writes at most `room` rungs, of which only setting, axis, current and model are
   set; returns the total number. */
int wr_accuracy_benchmark_settings(const WrScene *scene, WrAxis axis, WrRung *out, int room);
/* The scene with the dials of all axes except one at their best; the caller frees it. */
WrScene *wr_accuracy_benchmark_best_except_axis(const WrScene *scene, WrAxis axis);
