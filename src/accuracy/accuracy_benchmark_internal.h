/* accuracy_benchmark_internal.h - rendering and timing of settings, shared by all measurements. Private to this module. */
#pragma once
#include "accuracy/accuracy_benchmark.h"
#include "render/frame/frame.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrBench {
    const WrAccuracyBenchmarkRequest *request;
    WrPool *pool;         /* borrowed */
    WrRenderer *renderer; /* owned */
    float *normals;       /* [height][width][3], owned; NULL: not requested */
} WrBench;

bool wr_bench_frame(const WrBench *bench, const WrScene *scene, float *normals, WrFrame *frame,
                    WrError *err);
/* Seconds of one frame, after an untimed one. */
bool wr_bench_frame_seconds(const WrBench *bench, const WrScene *scene, double *seconds,
                            int64_t *shaded, WrError *err);
/* On one thread the thread's own work, else wall time. */
double wr_bench_now(const WrBench *bench);
void wr_bench_sort(double *times, int count);
/* Quantile `part`, 0..1, of sorted numbers, interpolated between neighbours. */
double wr_bench_quantile(const double *sorted, int count, double part);
bool wr_bench_render_reference(const WrAccuracyBenchmarkRequest *request, WrPool *pool,
                               WrReference *out, WrError *err);
