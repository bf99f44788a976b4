/* Measurement of the machine's peak rates. Compiled with -ffp-contract=fast: a product and a sum are one instruction on
   processors that have it. */
#include "base/cpu.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "bench/peak.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define DRAM_BYTES (256 << 20) /* all threads together: more than caches hold */
#define DRAM_MIN (8 << 20)     /* per thread */

const char *const wr_peak_builds[WR_PEAK_BUILDS] = { "v1", "v3", "v4" };
const char *const wr_peak_levels[WR_PEAK_LEVELS] = { "L1", "L2", "DRAM" };

/* ---- arithmetic ---- */

#define NUMBERS 256
#define SUMS 16 /* operations on each number in a round */

typedef struct Sums {
    /* Repeat `rounds` times: x = x k + c, SUMS times on each of x's NUMBERS. */
    void (*run)(long rounds, float k, float c, float *x);
} Sums;

/* Sixteen dependent operations per number: loads and stores between them are then negligible, and the processor
   overlaps the chains of several numbers. The vectors are as wide as the level's registers. */
#define FOUR(v) (v) = (v)*k + c, (v) = (v)*k + c, (v) = (v)*k + c, (v) = (v)*k + c
#define DEFINE_SUMS(level, lanes, features)                                                        \
    features static void run_##level(long rounds, float k, float c, float *x)                      \
    {                                                                                              \
        typedef float Vector __attribute__((vector_size(4 * (lanes)), aligned(4), may_alias));     \
        Vector *block = (Vector *)x;                                                               \
        for (long r = 0; r < rounds; r++)                                                          \
            for (int i = 0; i < NUMBERS / (lanes); i++) {                                          \
                Vector v = block[i];                                                               \
                FOUR(v), FOUR(v), FOUR(v), FOUR(v);                                                \
                block[i] = v;                                                                      \
            }                                                                                      \
    }                                                                                              \
    static const Sums sums_##level = { run_##level };

#ifdef __x86_64__
DEFINE_SUMS(v1, 4, )
DEFINE_SUMS(v3, 8, __attribute__((target("avx2,fma"))))
DEFINE_SUMS(v4, 16, __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,fma"))))
static const WrCpuBuilds builds = { &sums_v1, &sums_v3, &sums_v4 };
#else
DEFINE_SUMS(v1, 4, )
static const WrCpuBuilds builds = { &sums_v1, NULL, NULL };
#endif

/* Work of one thread. */
typedef struct Piece {
    const Sums *sums;
    long rounds;
    char *block; /* the first half is copied to the second and back */
    size_t half;
    float x[NUMBERS];
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

/* Threads, their pieces and the interrupt of a measurement. */
typedef struct Machine {
    WrPool *pool;
    Piece *pieces;
    int count;
    const volatile int *cancel;
} Machine;

/* Seconds of all pieces at once, the best of the rounds; the first warms the memory and is not counted. */
static double best(const Machine *on, WrPiece work, int rounds)
{
    double least = INFINITY;
    for (int k = -1; k < rounds && !wr_cancel_requested(on->cancel); k++) {
        const double start = wr_clock_seconds();
        wr_pool_run(on->pool, on->count, work, on->pieces);
        const double seconds = wr_clock_seconds() - start;
        if (k >= 0 && seconds < least) least = seconds;
    }
    return least > 0 ? least : INFINITY;
}

static void measure_sums(const Machine *on, bool quick, WrPeaks *peaks)
{
    const long rounds = quick ? 10000 : 100000;
    const double sums = on->count * (double)rounds * NUMBERS * SUMS;
    for (int b = 0; b < WR_PEAK_BUILDS; b++) {
        const Sums *build = wr_cpu_build(&builds, b);
        if (!build) continue;
        for (int i = 0; i < on->count; i++)
            on->pieces[i].sums = build, on->pieces[i].rounds = rounds;
        peaks->gflops[b] = 2e-9 * sums / best(on, sum, quick ? 3 : 7);
    }
}

static void measure_copies(const Machine *on, bool quick, WrPeaks *peaks)
{
    /* bytes per thread and round, at least the block once */
    const double moved = quick ? 0x1p27 : 0x1p30;
    for (int level = 0; level < WR_PEAK_LEVELS; level++) {
        const size_t half = (size_t)peaks->bytes[level] / 2;
        const long rounds = (long)fmax(1, moved / peaks->bytes[level]);
        for (int i = 0; i < on->count; i++)
            on->pieces[i].half = half, on->pieces[i].rounds = rounds;
        peaks->gbytes[level] =
            1e-9 * on->count * (double)rounds * peaks->bytes[level] / best(on, copy, quick ? 2 : 5);
    }
}

/* Write to every page: untouched zero pages would share one physical page. */
static void touch(char *memory, size_t size, const volatile int *cancel)
{
    const size_t step = (size_t)8 << 20;
    for (size_t at = 0; at < size && !wr_cancel_requested(cancel); at += step)
        memset(memory + at, 1, size - at < step ? size - at : step);
}

bool wr_peaks_measure(WrPool *pool, bool quick, const volatile int *cancel, WrPeaks *peaks,
                      WrError *err)
{
    const int count = wr_pool_threads(pool);
    const size_t most =
        DRAM_BYTES / (size_t)count > DRAM_MIN ? DRAM_BYTES / (size_t)count : (size_t)DRAM_MIN;
    *peaks = (WrPeaks){ .bytes = { 16 << 10, 512 << 10, (double)most } };
    Piece *pieces = wr_alloc((size_t)count, sizeof *pieces);
    const Machine on = { pool, pieces, count, cancel };
    char *memory = wr_try_alloc((size_t)count, most, "the copies of a measurement", err);
    bool good = memory != NULL;
    if (memory) {
        touch(memory, (size_t)count * most, cancel);
        for (int i = 0; i < count; i++) pieces[i].block = memory + (size_t)i * most;
        measure_sums(&on, quick, peaks);
        measure_copies(&on, quick, peaks);
        good = !wr_cancel_requested(cancel) || wr_fail(err, "interrupted");
    }
    wr_free(memory);
    wr_free(pieces);
    return good;
}
