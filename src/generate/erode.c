#include "generate/erode.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"

static int smaller(int n)
{
    return n < WR_ERODE_COARSE ? n : WR_ERODE_COARSE;
}

bool wr_erode_begin(WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    if (!wr_sheet_read(sheet, job->like, err)) return false;
    if (!job->coarse) return true;
    int width = smaller(sheet->width), height = smaller(sheet->height);
    double across = (double)width / sheet->width, up = (double)height / sheet->height;
    if (across < up) height = (int)(sheet->height * across + 0.5);
    else width = (int)(sheet->width * up + 0.5);
    if (wr_sheet_resize(sheet, width > 0 ? width : 1, height > 0 ? height : 1, job, err))
        return true;
    wr_sheet_fini(sheet);
    return false;
}

/* Adds after - before, resized to the table, to the table. */
static bool add_change(WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    WrSheet before = { .z = NULL }, whole = { .z = NULL };
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    bool good = wr_sheet_read(&whole, job->like, err) && wr_sheet_copy(&before, &whole, err) &&
                wr_sheet_resize(&before, sheet->width, sheet->height, job, err);
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++) sheet->z[k] -= before.z[k];
    good = good && wr_sheet_resize(sheet, whole.width, whole.height, job, err);
    count = (size_t)whole.width * (size_t)whole.height;
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++) sheet->z[k] += whole.z[k];
    wr_sheet_fini(&before);
    wr_sheet_fini(&whole);
    return good;
}

bool wr_erode_end(WrSheet *sheet, const WrGenerateJob *job, bool good, WrRelief *out, WrError *err)
{
    bool small =
        sheet->width != wr_field_width(job->like) || sheet->height != wr_field_height(job->like);
    good = good && (!small || add_change(sheet, job, err)) && wr_sheet_relief(sheet, job, out, err);
    wr_sheet_fini(sheet);
    return good;
}
