/* Measurement of the machine's peak rates. */
#include "base/cpu.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "cli/bench_peak.h"
#include "cli/bench_peak_inner.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define DRAM_BYTES (256 << 20) /* all threads together: more than caches hold */
#define DRAM_LEAST (8 << 20)   /* per thread */

const char *const wr_peak_builds[WR_PEAK_BUILDS] = { "v1", "v3", "v4" };
const char *const wr_peak_levels[WR_PEAK_LEVELS] = { "L1", "L2", "DRAM" };
static const WrCpuBuilds builds = { &wr_peak_v1, &wr_peak_v3, &wr_peak_v4 };

/* Work of one thread. */
typedef struct Piece {
    const WrPeakSums *sums;
    long rounds;
    char *block; /* the first half is copied to the second and back */
    size_t half;
    float x[WR_PEAK_NUMBERS];
} Piece;

static void sum(int index, int worker, void *ctx)
{
    Piece *piece = (Piece *)ctx + index;
    (void)worker;
    piece->sums->run(piece->rounds, 0.75f, 0.25f, piece->x);
}

/* A volatile pointer: the compiler cannot remove copies whose result is unused. */
static void *(*volatile const copy_bytes)(void *, const void *, size_t) = memcpy;

static void copy(int index, int worker, void *ctx)
{
    const Piece *piece = (const Piece *)ctx + index;
    (void)worker;
    for (long k = 0; k < piece->rounds; k++) {
        const bool back = k & 1;
        copy_bytes(piece->block + (back ? 0 : piece->half), piece->block + (back ? piece->half : 0),
                   piece->half);
    }
}

/* Seconds of all pieces at once, the best of the rounds; the first warms the memory and is not counted. */
static double best(WrPool *pool, WrPiece work, Piece *pieces, int count, int rounds)
{
    double least = INFINITY;
    for (int k = -1; k < rounds; k++) {
        const double start = wr_clock_seconds();
        wr_pool_run(pool, count, work, pieces);
        const double seconds = wr_clock_seconds() - start;
        if (k >= 0 && seconds < least) least = seconds;
    }
    return least > 0 ? least : INFINITY;
}

static void measure_sums(WrPool *pool, Piece *pieces, int count, bool quick, WrPeaks *peaks)
{
    const long rounds = quick ? 10000 : 100000;
    const double sums = (double)count * (double)rounds * WR_PEAK_NUMBERS * WR_PEAK_SUMS;
    for (int b = 0; b < WR_PEAK_BUILDS; b++) {
        const WrPeakSums *build = wr_cpu_build(&builds, b);
        if (!build) continue;
        for (int i = 0; i < count; i++) pieces[i].sums = build, pieces[i].rounds = rounds;
        peaks->gflops[b] = 2e-9 * sums / best(pool, sum, pieces, count, quick ? 3 : 7);
    }
}

static void measure_copies(WrPool *pool, Piece *pieces, int count, bool quick, WrPeaks *peaks)
{
    /* bytes per thread and round, at least the block once */
    const double moved = quick ? 0x1p27 : 0x1p30;
    for (int level = 0; level < WR_PEAK_LEVELS; level++) {
        const size_t half = (size_t)peaks->bytes[level] / 2;
        const long rounds = (long)fmax(1, moved / peaks->bytes[level]);
        for (int i = 0; i < count; i++) pieces[i].half = half, pieces[i].rounds = rounds;
        peaks->gbytes[level] = 1e-9 * count * (double)rounds * peaks->bytes[level] /
                               best(pool, copy, pieces, count, quick ? 2 : 5);
    }
}

bool wr_peaks_measure(WrPool *pool, bool quick, WrPeaks *peaks, WrError *err)
{
    const int count = wr_pool_threads(pool);
    const size_t most =
        DRAM_BYTES / (size_t)count > DRAM_LEAST ? DRAM_BYTES / (size_t)count : (size_t)DRAM_LEAST;
    *peaks = (WrPeaks){ .bytes = { 16 << 10, 512 << 10, (double)most } };
    Piece *pieces = wr_alloc((size_t)count, sizeof *pieces);
    char *memory = wr_try_alloc((size_t)count, most, "the copies of a measurement", err);
    if (memory) {
        /* untouched zero pages would share one physical page */
        memset(memory, 1, (size_t)count * most);
        for (int i = 0; i < count; i++) pieces[i].block = memory + (size_t)i * most;
        measure_sums(pool, pieces, count, quick, peaks);
        measure_copies(pool, pieces, count, quick, peaks);
    }
    wr_free(memory);
    wr_free(pieces);
    return memory;
}
