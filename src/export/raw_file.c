#include "export/raw_file.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/job.h"
#include "field/field.h"
#include "image/image.h"
#include "image/sidecar.h"
#include "scene/scene.h"
#include "system/fd.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

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

static bool write_strip(const Strips *s, int y, int rows, WrError *err)
{
    const size_t count = (size_t)rows * s->row;
    s->job->kind->rows(s->job, y, rows, s->bytes);
    if (s->job->options.big != is_big_here()) turn_round(s->bytes, count, s->each);
    return wr_file_put(s->target, s->bytes, count * s->each, err);
}

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
    return wr_export_receipt(s->job, y, rows, s->values, true, err) ||
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

bool wr_export_sidecar(WrExportJob *job, const char *path, WrError *err)
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

bool wr_export_numbers(WrExportJob *job, const char *path, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (write_numbers(job, &target, err)) return wr_file_commit(&target, err);
    wr_file_abort(&target);
    return false;
}
