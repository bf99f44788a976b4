/* Writing of one export as a picture file: its rows, its label, its levels. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/kernmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "document/document_file.h"
#include "export/job.h"
#include "export/mip_files.h"
#include "field/field.h"
#include "image/image.h"
#include "image/sidecar.h"
#include "scene/scene.h"
#include "system/fd.h"
#include "system/thread.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* write.c: a WrRowSeen of the job that compares rows read back from disk; the largest error goes into the
   report. */
static bool export_receipt(void *ctx, int y, int rows, const float *values, bool exact,
                           WrError *err);

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;

/* ---- raw file ---- */

#define STRIP WR_IMAGE_STRIP

/* ---- numbers as bytes ---- */

static size_t number_bytes(const WrExportJob *job)
{
    return (size_t)job->options.depth / 8;
}

/* Reverses the byte order, in both directions. */
static void turn_round(unsigned char *bytes, size_t count, size_t each)
{
    for (unsigned char *at = bytes; at < bytes + count * each; at += each)
        for (size_t k = 0; k < each / 2; k++) {
            const unsigned char kept = at[k];
            at[k] = at[each - 1 - k];
            at[each - 1 - k] = kept;
        }
}

static bool is_big_here(void)
{
    const uint16_t one = 1;
    return *(const unsigned char *)&one == 0;
}

static void widen(const WrExportJob *job, const void *bytes, size_t count, float *out)
{
    const uint8_t *codes = bytes;
    const uint16_t *words = bytes;
    for (size_t k = 0; k < count; k++)
        out[k] = job->options.depth == 8    ? (float)codes[k] / 255.0f
                 : job->options.depth == 16 ? (float)words[k] / 65535.0f
                                            : ((const float *)bytes)[k];
}

typedef struct Strips {
    WrExportJob *job;
    WrFileTarget *target;
    size_t row, each; /* numbers per row; bytes per number */
    unsigned char *bytes;
    float *values;
} Strips;

static bool fail_by_system(const Strips *s, WrError *err)
{
    char why[WR_FILE_WHY];
    return wr_file_fail(s->target, wr_file_why(errno, why), err);
}

/* Raw numbers: row by row from the top, channels interleaved, no header; size and byte order are in the sidecar only. */
static bool write_strip(const Strips *s, int y, int rows, WrError *err)
{
    const size_t count = (size_t)rows * s->row;
    s->job->kind->rows(s->job, y, rows, s->bytes);
    if (s->job->options.big != is_big_here()) turn_round(s->bytes, count, s->each);
    return wr_file_put(s->target, s->bytes, count * s->each, err);
}

/* Strips are read back from the file, not from memory, and compared with rows that are computed again as floats. */
static bool see_strip(const Strips *s, int y, int rows, WrError *err)
{
    const size_t count = (size_t)rows * s->row, size = count * s->each;
    const int64_t at = (int64_t)((size_t)y * s->row * s->each);
    for (size_t have = 0; have < size;) {
        const int64_t n =
            wr_fd_read_at(s->target->fd, s->bytes + have, size - have, at + (int64_t)have);
        if (n < 0) return fail_by_system(s, err);
        if (n == 0) return wr_file_fail(s->target, "it does not read back as it was written", err);
        have += (size_t)n;
    }
    if (s->job->options.big != is_big_here()) turn_round(s->bytes, count, s->each);
    widen(s->job, s->bytes, count, s->values);
    return export_receipt(s->job, y, rows, s->values, true, err) ||
           wr_file_fail(s->target, err ? err->text : "", err);
}

typedef bool Step(const Strips *s, int y, int rows, WrError *err);

static bool each_strip(const Strips *s, Step *step, double from, double to, WrError *err)
{
    const int height = s->job->height;
    for (int y = 0; y < height; y += STRIP) {
        if (!wr_progress_report(from + (to - from) * y / height)) return wr_fail(err, "cancelled");
        if (!step(s, y, height - y < STRIP ? height - y : STRIP, err)) return false;
    }
    return true;
}

static bool write_numbers(WrExportJob *job, WrFileTarget *target, WrError *err)
{
    const size_t row = (size_t)job->width * (size_t)job->channels;
    Strips s = { job, target, row, number_bytes(job), NULL, NULL };
    s.bytes = wr_try_alloc(row * STRIP, s.each, "rows of a picture", err);
    s.values =
        s.bytes ? wr_try_alloc(row * STRIP, sizeof *s.values, "rows of a picture", err) : NULL;
    const bool good = s.values && each_strip(&s, write_strip, 0, 0.7, err) &&
                      each_strip(&s, see_strip, 0.7, 1, err);
    wr_free(s.bytes);
    wr_free(s.values);
    return good;
}

/* ---- description file ---- */

static void add_number(WrText *text, const char *name, double value)
{
    wr_text_addf(text, "  \"%s\": ", name);
    wr_text_add_number(text, value);
    wr_text_add(text, ",\n");
}

static void add_pair(WrText *text, const char *name, double a, double b)
{
    wr_text_addf(text, "  \"%s\": [", name);
    wr_text_add_number(text, a);
    wr_text_add(text, ", ");
    wr_text_add_number(text, b);
    wr_text_add(text, "],\n");
}

/* Adds the labels, which are our own words and numbers and need no escaping. */
static void add_labels(const WrExportJob *job, WrText *text)
{
    wr_text_add(text, "  \"labels\": {");
    for (int k = 0; k < job->attribute_count; k++)
        wr_text_addf(text, "%s\n    \"%s\": \"%s\"", k ? "," : "", job->attribute_names[k],
                     wr_text_get(&job->attribute_texts[k]));
    wr_text_add(text, "\n  }\n}\n");
}

/* JSON has only finite numbers, and these are finite. */
static void tell(const WrExportJob *job, const char *sha256, WrText *text)
{
    const WrExportReport *report = &job->report;
    const double w = job->options.cell_w, h = job->options.cell_h;
    wr_text_addf(text, "{\n  \"kind\": \"%s\",\n  \"width\": %d,\n  \"height\": %d,\n",
                 job->kind->name, job->width, job->height);
    wr_text_addf(text, "  \"channels\": %d,\n  \"type\": \"%s\",\n  \"endian\": \"%s\",\n",
                 job->channels,
                 job->options.half          ? "f16"
                 : job->options.depth == 8  ? "u8"
                 : job->options.depth == 16 ? "u16"
                                            : "f32",
                 job->options.big ? "big" : "little");
    if (job->channels == 1) {
        add_number(text, "low", report->ranged ? report->code_low : report->low);
        add_number(text, "high", report->ranged ? report->code_high : report->high);
    }
    if (report->zero_code >= 0) add_number(text, "zero_code", report->zero_code);
    add_pair(text, "cell", w, h);
    const int border = job->options.border;
    add_pair(text, "texel", w / (job->width - border), h / (job->height - border));
    add_number(text, "height_of_1", job->scene->height);
    wr_text_addf(text, "  \"unit\": \"%s\",\n", job->scene->cell.mm ? "mm" : "scene");
    if (report->convention) wr_text_addf(text, "  \"convention\": \"%s\",\n", report->convention);
    wr_text_addf(text, "  \"sha256\": \"%s\",\n", sha256);
    add_labels(job, text);
}

/* Writes the description of the last written file, in the same group of files (base/file.h). The group renames all its files
   at the end, so the checksum is computed from the temporary file of the picture. */
static bool export_sidecar(WrExportJob *job, const char *path, WrError *err)
{
    WrText name = { 0 }, text = { 0 };
    char sha256[65];
    const char *written = wr_file_group_last();
    wr_sidecar_name(path, &name);
    bool good = wr_sha256_file(written ? written : path, sha256, err);
    if (good) {
        tell(job, sha256, &text);
        good = wr_file_write(wr_text_get(&name), wr_text_get(&text), text.length, err);
    }
    wr_text_fini(&text);
    wr_text_fini(&name);
    return good;
}

/* Writes the job's rows as numbers, which are verified before the file is renamed. */
static bool export_numbers(WrExportJob *job, const char *path, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (write_numbers(job, &target, err)) return wr_file_commit(&target, err);
    wr_file_abort(&target);
    return false;
}

/* ---- Verification of an exported file on disk against the expected values ---- */

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
    /* Bounds of one value: half precision rounds by 2^-11 of it, or 2^-25 in the subnormal range; codes by half a step, twice
       that with dither, plus 2^-22 for the floats between. A plain float must be exact. */
    double bound = job->options.half ? fabs(should) * 0x1p-11 + 0x1p-25 : 0.0;
    if (report->ranged)
        bound =
            code_bound(job) * (report->code_high - report->code_low) / wr_export_last_code(job) +
            fabs(should) * 0x1p-22;
    *bad |= !(error <= bound);
    return error;
}

/* ---- normals ---- */

/* Of the angle between two normals as n/2 + 1/2: the square of its sine, beyond 90 degrees 2 minus that.
   The sine |a x b| / (|a| |b|) keeps all digits of small angles, which the cosine loses (HC20). Squares are compared, and only
   the largest becomes an angle. */
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

/* The expected rows as floats; counters that they update are discarded. rows() runs a second time with depth 32: the expected
   values do not pass through the encoder that is verified. */
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

static bool export_receipt(void *ctx, int y, int rows, const float *values, bool exact,
                           WrError *err)
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
    return wr_fail(err, "row %d differs by up to %.3g%s, more than %s", receipt.bad_row, worst,
                   job->kind->green != 0.0 ? " degrees" : "",
                   job->options.half          ? "rounding to 16-bit floats may do"
                   : job->options.depth == 32 ? "floats are wrong by"
                   : job->options.dither      ? "a dithered code may be"
                                              : "half a code");
}

#define HALF_MAX 65520.0f /* smaller values become at most 65504 */

WrPixelType wr_export_pixels(int depth)
{
    return depth == 8 ? WR_PIXEL_U8 : depth == 16 ? WR_PIXEL_U16 : WR_PIXEL_F32;
}

/* ---- rows ---- */

/* Rounds floats to the nearest halves, if the file stores those. row: numbers. */
static bool round_rows(const WrExportJob *job, int y, int rows, size_t row, float *values,
                       WrError *err)
{
    for (size_t k = 0; job->options.half && k < (size_t)rows * row; k++) {
        if (!(fabsf(values[k]) < HALF_MAX))
            return wr_fail(err, "row %d contains %g: 16-bit floats reach only 65504; use depth=32",
                           y + (int)(k / row), (double)values[k]);
        values[k] = wr_round_half(values[k]);
    }
    return true;
}

static bool job_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    WrExportJob *job = ctx;
    job->kind->rows(job, y, rows, out);
    return round_rows(job, y, rows, (size_t)job->width * (size_t)job->channels, out, err);
}

/* A level above the first. */
typedef struct Above {
    const WrExportJob *job;
    const WrLevel *level;
} Above;

static bool level_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Above *above = ctx;
    const size_t row = (size_t)above->level->width * WR_LEVEL_CHANNELS;
    memcpy(out, above->level->data + (size_t)y * row, (size_t)rows * row * sizeof(float));
    return round_rows(above->job, y, rows, row, out, err);
}

static bool level_seen(void *ctx, int y, int rows, const float *values, bool exact, WrError *err)
{
    const Above *above = ctx;
    const size_t row = (size_t)above->level->width * WR_LEVEL_CHANNELS;
    const float *want = above->level->data + (size_t)y * row;
    (void)exact;
    for (size_t k = 0; k < (size_t)rows * row; k++)
        if (values[k] != (above->job->options.half ? wr_round_half(want[k]) : want[k]))
            return wr_fail(err, "row %d of the level of %dx%d differs from the one written",
                           y + (int)(k / row), above->level->width, above->level->height);
    return true;
}

/* ---- the file ---- */

/* Normals' kind by the actual axes instead of the requested name: readers rely on it. */
static const char *kind_told(const WrExportJob *job)
{
    const int *axes = job->options.axes;
    if (job->kind->green == 0.0 || job->kind->on_surface) return job->kind->name;
    if (axes[0] != 1 || abs(axes[1]) != 2 || axes[2] != 3) return "normal";
    return axes[1] > 0 ? "normal+y" : "normal-y";
}

/* Label of the seam in u and in v, and of the number of cells side by side; "open" if the picture is not one
   cell. */
static void describe_edges(WrExportJob *job)
{
    const WrSeam *pattern = &job->report.seam.pattern;
    const bool cell = !job->kind->on_surface && !job->options.atlas;
    WrText *edges = wr_export_attribute(job, "wrinkle:edges");
    wr_text_addf(edges, "%s,%s", cell ? wr_certificate_word(pattern->u.order) : "open",
                 cell ? wr_certificate_word(pattern->v.order) : "open");
    if (job->copies[0] > 1 || job->copies[1] > 1)
        wr_text_addf(wr_export_attribute(job, "wrinkle:copies"), "%d,%d",
                     job->copies[0] > 1 ? job->copies[0] : 1,
                     job->copies[1] > 1 ? job->copies[1] : 1);
}

static void describe(WrExportJob *job)
{
    wr_text_add(wr_export_attribute(job, "wrinkle:kind"), kind_told(job));
    wr_text_add(wr_export_attribute(job, "wrinkle:wrap"),
                job->options.border ? "clamp" /* both ends are included */
                                    : wr_document_wrap_word(wr_field_wrap_u(job->field),
                                                            wr_field_wrap_v(job->field)));
    if (job->options.border) wr_text_add(wr_export_attribute(job, "wrinkle:border"), "on");
    WrText *cell = wr_export_attribute(job, "wrinkle:cell");
    wr_text_add_number(cell, job->options.cell_w);
    wr_text_add(cell, ",");
    wr_text_add_number(cell, job->options.cell_h);
    wr_text_add(wr_export_attribute(job, "wrinkle:unit"), job->scene->cell.mm ? "mm" : "scene");
    wr_text_add_number(wr_export_attribute(job, "wrinkle:height"),
                       job->options.strength * job->scene->height);
    wr_text_add(wr_export_attribute(job, "wrinkle:seam"),
                wr_certificate_word(wr_certificate_continuity(&job->report.seam)));
    describe_edges(job);
    job->kind->describe(job);
}

static WrImageOut part_of(const WrExportJob *job)
{
    return (WrImageOut){ .width = job->width,
                         .height = job->height,
                         .channels = job->channels,
                         .type = wr_export_pixels(job->options.depth),
                         .half = job->options.half,
                         .channel_names = job->kind->channel_names,
                         .pool = job->pool,
                         .data = true };
}

static int add_levels(const WrExportJob *job, const WrLevels *levels, Above *above, WrImageOut *out)
{
    out[0].levels = true;
    out[0].uvslopes = true;
    out[0].uvslopes_scale = job->options.uvslopes;
    for (int k = 1; k < levels->count; k++) {
        above[k] = (Above){ job, &levels->level[k] };
        out[k] = part_of(job);
        out[k].width = levels->level[k].width;
        out[k].height = levels->level[k].height;
        out[k].levels = true;
        out[k].rows = level_rows;
        out[k].seen = level_seen;
        out[k].ctx = &above[k];
    }
    return levels->count;
}

static void forget_attributes(WrExportJob *job)
{
    for (int i = 0; i < job->attribute_count; i++) wr_text_fini(&job->attribute_texts[i]);
    job->attribute_count = 0;
}

bool wr_export_write(WrExportJob *job, const char *path, WrError *err)
{
    WrImageAttribute attributes[WR_EXPORT_ATTRIBUTES];
    WrImageOut out[WR_LEVELS_MAX];
    Above above[WR_LEVELS_MAX];
    WrLevels levels = { 0 };
    /* `make` and `prepare` run before describe(): labels contain ranges and settings that they choose. Level k's rows refer
       to above[k] and levels, which must outlive the write. */
    const char *names[WR_EXPORT_CHANNELS];
    for (int i = 0; i < WR_EXPORT_CHANNELS; i++) names[i] = job->channel_names[i];
    wr_free(job->map);
    job->map = NULL;
    if (job->kind->make && !job->kind->make(job, err)) {
        forget_attributes(job);
        return false;
    }
    if (job->kind->prepare) job->kind->prepare(job);
    if (job->kind->levels && !wr_levels_make(&levels, job->width, job->height,
                                             wr_export_bump_slopes_level, job, job->pool, err)) {
        forget_attributes(job);
        return false;
    }
    describe(job);
    for (int i = 0; i < job->attribute_count; i++)
        attributes[i] =
            (WrImageAttribute){ job->attribute_names[i], wr_text_get(&job->attribute_texts[i]) };
    out[0] = part_of(job);
    if (job->channel_names[0][0]) out[0].channel_names = names;
    out[0].attributes = attributes;
    out[0].attribute_count = job->attribute_count;
    out[0].rows = job_rows;
    out[0].seen = export_receipt;
    out[0].ctx = job;
    const int count = job->kind->levels ? add_levels(job, &levels, above, out) : 1;
    bool ok = job->numbers ? export_numbers(job, path, err) : wr_image_write(path, out, count, err);
    if (ok && job->sidecar) ok = export_sidecar(job, path, err);
    job->report.unseen = !job->report.seen;
    forget_attributes(job);
    wr_levels_free(&levels);
    return ok;
}
