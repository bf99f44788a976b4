/* sheet.h - whole tables in double, for algorithms that cannot work tile by tile; used by
   terrain, erosion, normal maps and pictures.
   Private to this module. */
#pragma once
#include "base/progress.h"
#include "field/wrap.h"
#include "generate/generator.h"
#include "generate/tile_builder.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrSheet {
    int width, height;
    WrWrap wrap[2]; /* u, v */
    double *z;      /* [height][width] rows from the top; owned */
} WrSheet;

/* A sheet of zeros. Errors: out of memory. */
bool wr_sheet_init(WrSheet *sheet, int width, int height, const WrWrap wrap[2], WrError *err);
/* Reads a table. */
bool wr_sheet_read(WrSheet *sheet, const WrField *field, WrError *err);
bool wr_sheet_copy(WrSheet *sheet, const WrSheet *from, WrError *err);
void wr_sheet_fini(WrSheet *sheet); /* a zeroed one is allowed */
/* For loops over whole tables: false if the loop should stop at texel k because of cancellation, which
 * is checked at intervals; the caller then discards the table. */
static inline bool wr_sheet_goes_on(size_t k)
{
    return k % 16384 != 0 || !wr_progress_stopped();
}
/* Lowest and highest. */
void wr_sheet_range(const WrSheet *sheet, double *low, double *high);

/* Resizes a sheet: on an axis with fewer texels each is the mean of its area, with more by Catmull-Rom
 * interpolation. Rounds to float. */
bool wr_sheet_resize(WrSheet *sheet, int width, int height, const WrGenerateJob *job, WrError *err);

/* Converts to a new table, rounded to float: values beyond its range are clamped, NaN becomes 0. */
WrField *wr_sheet_field(const WrSheet *sheet, WrError *err);
/* Converts the sheet, of the job's size, to the output. */
bool wr_sheet_relief(const WrSheet *sheet, const WrGenerateJob *job, WrRelief *out, WrError *err);

/* Index of a neighbour i of an axis of n, i any number: wrapped on a ring, else the last texel. */
static inline int wr_sheet_index(int i, int n, WrWrap wrap)
{
    if (i >= 0 && i < n) return i;
    if (wrap == WR_WRAP_CLAMP) return i < 0 ? 0 : n - 1;
    i %= n;
    return i < 0 ? i + n : i;
}

/* Calls rows(ctx, first, end) for bands of the sheet's rows on the pool until all are done. report:
 * reports the progress from 0 to 1. Errors: "cancelled". */
typedef void (*WrSheetRows)(const void *ctx, int first, int end);
bool wr_sheet_run(const WrSheet *sheet, const WrGenerateJob *job, bool report, WrSheetRows rows,
                  const void *ctx, WrError *err);
