#include "generate/sheet.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/ops.h"

#include <float.h>
#include <string.h>

#define ROWS 16            /* maximum rows of a piece of work ... */
#define PIECE_TEXELS 16384 /* ... and texels, if these are more than a row */
#define BATCH 64           /* pieces between two reports */

bool wr_sheet_init(WrSheet *sheet, int width, int height, const WrWrap wrap[2], WrError *err)
{
    double *z = wr_try_alloc((size_t)width * (size_t)height, sizeof *z, "a table of heights", err);
    if (!z) return false;
    *sheet = (WrSheet){ .width = width, .height = height, .wrap = { wrap[0], wrap[1] }, .z = z };
    return true;
}

/* Copying large tables may take seconds on a busy machine: checks for cancellation at some rows. */
static bool gives_up(int j, WrError *err)
{
    return j % ROWS == 0 && wr_progress_stopped() && !wr_fail(err, "cancelled");
}

bool wr_sheet_read(WrSheet *sheet, const WrField *field, WrError *err)
{
    const WrWrap wrap[2] = { wr_field_wrap_u(field), wr_field_wrap_v(field) };
    int width = wr_field_width(field), height = wr_field_height(field);
    float *row = wr_alloc((size_t)width, sizeof *row);
    bool good = wr_sheet_init(sheet, width, height, wrap, err);
    bool made = good;
    for (int j = 0; good && j < height; j++) {
        wr_field_read(field, 0, j, width, 1, row, (size_t)width);
        for (int i = 0; i < width; i++)
            sheet->z[(size_t)j * (size_t)width + (size_t)i] = (double)row[i];
        good = !gives_up(j, err);
    }
    if (made && !good) wr_sheet_fini(sheet);
    wr_free(row);
    return good;
}

bool wr_sheet_copy(WrSheet *sheet, const WrSheet *from, WrError *err)
{
    if (!wr_sheet_init(sheet, from->width, from->height, from->wrap, err)) return false;
    const size_t width = (size_t)from->width;
    bool good = true;
    for (int j = 0; good && j < from->height; j++) {
        memcpy(sheet->z + (size_t)j * width, from->z + (size_t)j * width, width * sizeof *from->z);
        good = !gives_up(j, err);
    }
    if (!good) wr_sheet_fini(sheet);
    return good;
}

void wr_sheet_fini(WrSheet *sheet)
{
    wr_free(sheet->z);
    *sheet = (WrSheet){ .z = NULL };
}

void wr_sheet_range(const WrSheet *sheet, double *low, double *high)
{
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    *low = *high = sheet->z[0];
    for (size_t k = 1; k < count; k++) {
        if (!wr_sheet_goes_on(k)) return;
        if (sheet->z[k] < *low) *low = sheet->z[k];
        if (sheet->z[k] > *high) *high = sheet->z[k];
    }
}

static float to_float(double z)
{
    if (!(z == z)) return 0.0f;
    return z > (double)FLT_MAX ? FLT_MAX : z < -(double)FLT_MAX ? -FLT_MAX : (float)z;
}

WrField *wr_sheet_field(const WrSheet *sheet, WrError *err)
{
    int width = sheet->width;
    WrField *field = wr_field_new(width, sheet->height, sheet->wrap[0], sheet->wrap[1], 0.0f, err);
    if (!field) return NULL;
    float *row = wr_alloc((size_t)width, sizeof *row);
    bool good = true;
    for (int j = 0; good && j < sheet->height; j++) {
        for (int i = 0; i < width; i++)
            row[i] = to_float(sheet->z[(size_t)j * (size_t)width + (size_t)i]);
        wr_field_write(field, 0, j, width, 1, row, (size_t)width);
        good = !gives_up(j, err);
    }
    wr_free(row);
    if (good) return field;
    wr_field_free(field);
    return NULL;
}

/* One axis after the other, since the filter depends on the axis. Fewer texels need the mean over each new texel; more need
   an interpolation without blocks. */
static WrField *resized(const WrField *field, int width, int height, const WrGenerateJob *job,
                        WrError *err)
{
    bool fewer = width < wr_field_width(field) || height < wr_field_height(field);
    const double param[] = { width, height, fewer ? WR_RESIZE_BOX : WR_RESIZE_CATMULL };
    const WrProgress quiet = { .cancel = job->progress ? job->progress->cancel : NULL };
    const WrOpOptions options = { .pool = job->pool, .progress = &quiet };
    return wr_op_run(wr_op_find("resize"), field, param, &options, err);
}

bool wr_sheet_resize(WrSheet *sheet, int width, int height, const WrGenerateJob *job, WrError *err)
{
    if (width == sheet->width && height == sheet->height) return true;
    WrField *field = wr_sheet_field(sheet, err);
    WrField *across = field ? resized(field, width, sheet->height, job, err) : NULL;
    WrField *whole = across ? resized(across, width, height, job, err) : NULL;
    WrSheet made = { .z = NULL };
    bool good = whole && wr_sheet_read(&made, whole, err);
    if (good) {
        wr_sheet_fini(sheet);
        *sheet = made;
    }
    wr_field_free(field);
    wr_field_free(across);
    wr_field_free(whole);
    return good;
}

bool wr_sheet_relief(const WrSheet *sheet, const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const WrWrap wrap[2] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    WrSheet same = *sheet;
    same.wrap[0] = wrap[0];
    same.wrap[1] = wrap[1];
    WrField *heights = wr_sheet_field(&same, err);
    if (!heights) return false;
    *out = (WrRelief){ .heights = heights };
    return true;
}

typedef struct Run {
    int height, from; /* rows; pieces done before */
    int rows_of;      /* rows of a piece */
    const WrProgress *progress;
    WrSheetRows rows;
    const void *ctx;
} Run;

static void run_rows(int index, int worker, void *ctx)
{
    (void)worker;
    const Run *run = ctx;
    int first = (run->from + index) * run->rows_of;
    int end = first + run->rows_of < run->height ? first + run->rows_of : run->height;
    if (!wr_progress_cancelled(run->progress)) run->rows(run->ctx, first, end);
}

bool wr_sheet_run(const WrSheet *sheet, const WrGenerateJob *job, bool report, WrSheetRows rows,
                  const void *ctx, WrError *err)
{
    /* Wide tables have pieces of fewer rows, so that cancellation is equally fast for any size. */
    const int fit = PIECE_TEXELS / sheet->width;
    const int each = fit < 1 ? 1 : fit < ROWS ? fit : ROWS;
    int pieces = (sheet->height + each - 1) / each;
    Run run = { sheet->height, 0, each, job->progress, rows, ctx };
    for (; run.from < pieces; run.from += BATCH) {
        int count = pieces - run.from < BATCH ? pieces - run.from : BATCH;
        if (report && !wr_progress_step(job->progress, (double)run.from / pieces)) break;
        wr_pool_run(job->pool, count, run_rows, &run);
    }
    return wr_progress_cancelled(job->progress) ? wr_fail(err, "cancelled") : true;
}
