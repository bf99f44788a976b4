/* terrain.h - whole tables in double, for what cannot be made tile by tile; and what terrain and pictures
   share.
   Private to this module. */
#pragma once
#include "base/progress.h"
#include "field/wrap.h"
#include "generate/tile_builder.h"
#include "generate/param.h"

#include <stdbool.h>

typedef struct WrSheet {
    int width, height;
    WrWrap wrap[2]; /* u, v */
    double *z;      /* [height][width] rows from the top; owned */
} WrSheet;

/* Of zeros. Errors: no memory. */
bool wr_sheet_new(WrSheet *sheet, int width, int height, const WrWrap wrap[2], WrError *err);
/* What a table holds. */
bool wr_sheet_read(WrSheet *sheet, const WrField *field, WrError *err);
bool wr_sheet_copy(WrSheet *sheet, const WrSheet *from, WrError *err);
void wr_sheet_fini(WrSheet *sheet); /* fine on a zeroed one */
/* In loops over whole tables: should texel k be done? Looks only now and then; where somebody wants it to stop, who
 * made the table throws it away. */
static inline bool wr_sheet_goes_on(size_t k)
{
    return k % 16384 != 0 || !wr_progress_stopped();
}
/* Lowest and highest. */
void wr_sheet_range(const WrSheet *sheet, double *low, double *high);

/* Bring it to another number of texels: each the mean of what it covers where there are fewer than before
 * along an axis, by Catmull and Rom's cubic where there are more. Through float. */
bool wr_sheet_resize(WrSheet *sheet, int width, int height, const WrGenerateJob *job, WrError *err);

/* As a new table, rounded to float: beyond its range clamped, not a number 0. */
WrField *wr_sheet_field(const WrSheet *sheet, WrError *err);
/* The sheet, of the job's size, as what comes out. */
bool wr_sheet_relief(const WrSheet *sheet, const WrGenerateJob *job, WrNormalMips *out,
                     WrError *err);

/* The neighbour of texel i of n, `step` beyond -n..n away: round the ring, or the last texel. */
static inline int wr_sheet_index(int i, int n, WrWrap wrap)
{
    if (i >= 0 && i < n) return i;
    if (wrap == WR_WRAP_CLAMP) return i < 0 ? 0 : n - 1;
    i %= n;
    return i < 0 ? i + n : i;
}

/* Call rows(ctx, first, end) for bands of the sheet's rows until all are done, on the pool. report:
 * tell the progress from 0 to 1. Errors: "cancelled". */
typedef void (*WrSheetRows)(const void *ctx, int first, int end);
bool wr_sheet_run(const WrSheet *sheet, const WrGenerateJob *job, bool report, WrSheetRows rows,
                  const void *ctx, WrError *err);

/* ---- rows: parameters and functions, by file ---- */

#define WR_TERRAIN(name)                                                                           \
    extern const WrParam wr_params_##name[];                                                       \
    bool wr_terrain_##name(const WrParamValue *values, const WrGenerateJob *job,                   \
                           WrNormalMips *out, WrError *err)
WR_TERRAIN(fractal);   /* terrain_fractal.c */
WR_TERRAIN(terraces);  /* terrain_terraces.c */
WR_TERRAIN(thermal);   /* erode_thermal.c */
WR_TERRAIN(hydraulic); /* erode_water.c */
WR_TERRAIN(elevation); /* terrain_elevation.c */
#undef WR_TERRAIN
