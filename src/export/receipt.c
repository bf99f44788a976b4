/* Verification of an exported file on disk against the expected values. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "export/job.h"
#include "image/image.h"
#include "system/thread.h"

#include <math.h>

/* Rows as read back, and the expected numbers: the same rows as floats that were never encoded. */
typedef struct Receipt {
    int first; /* row */
    const float *have, *want;
    WrMutex lock;
    double worst; /* so far; for normals the square of a sine (turned) */
    int bad_row;  /* the first row outside its bound, or INT32_MAX */
} Receipt;

/* Largest deviation of a code from its number, in codes: rounding, and dither before it. The thousandth is for
   numbers that were rounded to float. */
static double code_bound(const WrExportJob *job)
{
    return (job->options.dither ? 1.0 : 0.5) + 0x1p-10;
}

/* ---- numbers ---- */

/* The number that a value of the file represents. */
static double decode(const WrExportJob *job, float value)
{
    const WrExportReport *report = &job->report;
    if (!report->ranged) return value;
    const double last = wr_export_last_code(job);
    const double code = round(last * value), step = (report->code_high - report->code_low) / last;
    if (report->zero_code >= 0) return step * (code - report->zero_code);
    return report->code_low + step * code;
}

static double clamp(const WrExportReport *report, double x)
{
    if (!report->ranged) return x;
    return x < report->code_low ? report->code_low : x > report->code_high ? report->code_high : x;
}

/* Numbers outside the range are counted as clipped, so they are compared with the range's ends. */
static double number_error(const WrExportJob *job, float have, float want, bool *bad)
{
    const WrExportReport *report = &job->report;
    const double should = clamp(report, want), error = fabs(decode(job, have) - should);
    double bound = job->options.half ? fabs(should) * 0x1p-11 + 0x1p-25 : 0.0;
    if (report->ranged)
        bound =
            code_bound(job) * (report->code_high - report->code_low) / wr_export_last_code(job) +
            fabs(should) * 0x1p-22;
    *bad |= !(error <= bound);
    return error;
}

/* ---- normals ---- */

/* Of the angle between two normals as n/2 + 1/2: the square of its sine, beyond 90 degrees 2 minus that. */
static double turned(const float *have, const float *want)
{
    const double a[3] = { 2.0 * have[0] - 1, 2.0 * have[1] - 1, 2.0 * have[2] - 1 };
    const double b[3] = { 2.0 * want[0] - 1, 2.0 * want[1] - 1, 2.0 * want[2] - 1 };
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
                 z = a[0] * b[1] - a[1] * b[0];
    const double aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    const double bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    const double square = (x * x + y * y + z * z) / (aa * bb);
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.0 ? 2.0 - square : square;
}

static double degrees(double turned)
{
    const double sine = sqrt(turned <= 1.0 ? turned : fmax(2.0 - turned, 0.0));
    const double angle = wr_asin(fmin(sine, 1.0)) * (180.0 / WR_PI);
    return turned <= 1.0 ? angle : 180.0 - angle;
}

/* Largest deviation of a component. 2^-24: both are floats of up to 1. */
static double component_bound(const WrExportJob *job)
{
    if (job->options.depth != 32) return code_bound(job) / wr_export_last_code(job) + 0x1p-24;
    return job->options.half ? 0x1p-12 : 0.0;
}

/* The maximum of a row and of `worst`. The sine of the angle between two vectors is at most their distance
   divided by the length of either, and `want` has length 1: so the exact angle is computed only for few. */
static double worst_normal(const float *have, const float *want, size_t count, double bound,
                           double worst, bool *bad)
{
    for (size_t i = 0; i < 3 * count; i += 3) {
        const double x = (double)have[i] - want[i], y = (double)have[i + 1] - want[i + 1];
        const double z = (double)have[i + 2] - want[i + 2];
        const double square = x * x + y * y + z * z;
        const bool within = (fabs(x) <= bound) & (fabs(y) <= bound) & (fabs(z) <= bound);
        if (within & (4.0 * square <= 0.99 * worst)) continue;
        *bad |= !within;
        const double error = square == 0.0 ? 0.0 : turned(have + i, want + i);
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

/* ---- a strip ---- */

static void note(Receipt *receipt, double worst, int bad_row)
{
    wr_mutex_lock(&receipt->lock);
    if (!(worst <= receipt->worst)) receipt->worst = worst;
    if (bad_row < receipt->bad_row) receipt->bad_row = bad_row;
    wr_mutex_unlock(&receipt->lock);
}

static void compare_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    Receipt *receipt = ctx;
    const bool normals = job->kind->green != 0.0;
    const size_t row = (size_t)job->width * (size_t)job->channels;
    const double bound = component_bound(job);
    double worst = 0.0;
    int bad_row = INT32_MAX;
    for (int j = 0; j < rows; j++) {
        size_t at = (size_t)(y - receipt->first + j) * row;
        bool bad = false;
        if (normals)
            worst =
                worst_normal(receipt->have + at, receipt->want + at, row / 3, bound, worst, &bad);
        for (size_t i = at; i < at + row && !normals; i++) {
            const double error = number_error(job, receipt->have[i], receipt->want[i], &bad);
            if (!(error <= worst)) worst = error;
        }
        if (bad && bad_row == INT32_MAX) bad_row = y + j;
    }
    note(receipt, worst, bad_row);
}

/* The expected rows as floats; counters that they update are discarded. */
static float *wanted(const WrExportJob *job, int y, int rows)
{
    WrExportJob plain = *job;
    plain.options.depth = 32;
    plain.options.dither = false;
    float *want =
        wr_alloc_unset((size_t)job->width * (size_t)job->channels * (size_t)rows, sizeof *want);
    job->kind->rows(&plain, y, rows, want);
    return want;
}

bool wr_export_receipt(void *ctx, int y, int rows, const float *values, bool exact, WrError *err)
{
    WrExportJob *job = ctx;
    WrExportReport *report = &job->report;
    float *want = wanted(job, y, rows);
    Receipt receipt = { .first = y, .have = values, .want = want, .bad_row = INT32_MAX };
    wr_mutex_init(&receipt.lock);
    wr_export_run(job, y, rows, compare_piece, &receipt);
    wr_mutex_fini(&receipt.lock);
    wr_free(want);
    const double worst = job->kind->green != 0.0 ? degrees(receipt.worst) : receipt.worst;
    report->seen = true;
    if (!(worst <= report->worst)) report->worst = worst;
    if (!exact || receipt.bad_row == INT32_MAX) return true;
    return wr_fail(err, "row %d is wrong by up to %.3g%s, which is more than %s", receipt.bad_row,
                   worst, job->kind->green != 0.0 ? " degrees" : "",
                   job->options.half          ? "rounding to 16-bit floats may do"
                   : job->options.depth == 32 ? "floats are wrong by"
                   : job->options.dither      ? "a dithered code may be"
                                              : "half a code");
}
