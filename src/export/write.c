/* Writing of one export as a picture file: its rows, its label, its levels. */
#include "export/mip_files.h"

#include "base/error.h"
#include "base/kernmath.h"
#include "base/memory.h"
#include "document/document_file.h"
#include "export/job.h"
#include "export/raw_file.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HALF_MOST 65520.0f /* smaller values become at most 65504 */

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
        if (!(fabsf(values[k]) < HALF_MOST))
            return wr_fail(err, "row %d holds %g: 16-bit floats reach to 65504; depth=32 holds it",
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
            return wr_fail(err, "row %d of the level of %dx%d is not what was written",
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
                wr_certificate_word(wr_certificate_order(&job->report.seam)));
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
    out[0].seen = wr_export_receipt;
    out[0].ctx = job;
    const int count = job->kind->levels ? add_levels(job, &levels, above, out) : 1;
    bool ok =
        job->numbers ? wr_export_numbers(job, path, err) : wr_image_write(path, out, count, err);
    if (ok && job->sidecar) ok = wr_export_sidecar(job, path, err);
    job->report.unseen = !job->report.seen;
    forget_attributes(job);
    wr_levels_free(&levels);
    return ok;
}
