/* Selections by height and slope, their combination, and the builder of selections made row by row. */
#include "field/select.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/select_internal.h"

#include <math.h>
#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

static bool fail(WrError *err, const char *what, const char *name, double value, const char *right)
{
    return wr_fail(err, "selection by %s: %s %.9g: must be %s", what, name, value, right);
}

/* Processes a group of tile rows at a time. */
typedef struct Build {
    WrSelectRows make;
    void *ctx;
    int width, height, first; /* first row of the group */
    float level;
    float *rows;  /* [group][WR_TILE][width] */
    bool *failed; /* [group] */
} Build;

static void build_piece(int index, int worker, void *ctx)
{
    Build *build = ctx;
    int j = build->first + index * WR_TILE, rows = min_int(WR_TILE, build->height - j);
    size_t count = (size_t)rows * (size_t)build->width;
    float *out = build->rows + (size_t)index * WR_TILE * (size_t)build->width;
    for (size_t i = 0; i < count; i++) out[i] = build->level;
    build->failed[index] = !build->make(build->ctx, worker, j, rows, out);
}

static bool build_group(Build *build, int count, WrField *field, WrPool *pool, WrError *err)
{
    if (!wr_pool_run(pool, count, build_piece, build)) return wr_fail(err, "cancelled");
    for (int k = 0; k < count; k++) {
        if (build->failed[k]) return wr_fail(err, "selection: not enough memory");
        int j = build->first + k * WR_TILE;
        wr_field_write(field, 0, j, build->width, min_int(WR_TILE, build->height - j),
                       build->rows + (size_t)k * WR_TILE * (size_t)build->width,
                       (size_t)build->width);
    }
    return true;
}

WrField *wr_select_build(const WrField *like, float level, WrSelectRows make, void *ctx,
                         WrPool *pool, const WrProgress *progress, WrError *err)
{
    Build build = { .make = make,
                    .ctx = ctx,
                    .width = wr_field_width(like),
                    .height = wr_field_height(like),
                    .level = level };
    int group = min_int(2 * wr_pool_threads(pool), wr_field_tiles_v(like));
    build.rows = wr_try_alloc((size_t)group * WR_TILE * (size_t)build.width, sizeof *build.rows,
                              "selection", err);
    if (!build.rows) return NULL;
    build.failed = wr_alloc((size_t)group, sizeof *build.failed);
    WrField *field = wr_field_new(build.width, build.height, wr_field_wrap_u(like),
                                  wr_field_wrap_v(like), level, err);
    bool good = true;
    for (int ty = 0; good && ty < wr_field_tiles_v(like); ty += group) {
        build.first = ty * WR_TILE;
        if (!wr_progress_step(progress, (double)ty / wr_field_tiles_v(like)))
            good = wr_fail(err, "cancelled");
        else
            good =
                build_group(&build, min_int(group, wr_field_tiles_v(like) - ty), field, pool, err);
    }
    wr_free(build.rows);
    wr_free(build.failed);
    if (good) return field;
    wr_field_free(field);
    return NULL;
}

/* 1 in low..high, falling linearly to 0 at `soft` outside. */
typedef struct Band {
    const WrField *field;
    double low, high, soft;
    double relief;  /* slope only */
    float *scratch; /* slope only: [threads][WR_TILE + 2][pitch] */
    size_t pitch;
} Band;

static float in_band(const Band *band, double x)
{
    double outside = x < band->low ? band->low - x : x > band->high ? x - band->high : 0.0;
    if (outside <= 0.0) return 1.0f;
    return outside < band->soft ? (float)(1.0 - outside / band->soft) : 0.0f;
}

static bool height_rows(void *ctx, int worker, int j, int rows, float *out)
{
    (void)worker;
    const Band *band = ctx;
    int width = wr_field_width(band->field);
    wr_field_read(band->field, 0, j, width, rows, out, (size_t)width);
    for (size_t i = 0; i < (size_t)rows * (size_t)width; i++) out[i] = in_band(band, out[i]);
    return true;
}

/* Checks common to both kinds of band. */
static bool check_band(const Band *band, const char *what, WrError *err)
{
    if (!isfinite(band->low)) return fail(err, what, "low", band->low, "finite");
    if (!isfinite(band->high)) return fail(err, what, "high", band->high, "finite");
    if (band->low > band->high)
        return wr_fail(err, "selection by %s: low %.9g: must not be above high, %.9g", what,
                       band->low, band->high);
    if (!(band->soft >= 0.0) || !isfinite(band->soft))
        return fail(err, what, "soft", band->soft, "0 or more and finite");
    return true;
}

WrField *wr_select_height(const WrField *field, double low, double high, double soft, WrPool *pool,
                          WrError *err)
{
    Band band = { .field = field, .low = low, .high = high, .soft = soft };
    if (!check_band(&band, "height", err)) return NULL;
    float level = in_band(&band, wr_field_level(field));
    return wr_select_build(field, level, height_rows, &band, pool, wr_progress_here(), err);
}

static bool slope_rows(void *ctx, int worker, int j, int rows, float *out)
{
    const Band *band = ctx;
    int width = wr_field_width(band->field);
    size_t pitch = band->pitch;
    float *in = band->scratch + (size_t)worker * (WR_TILE + 2) * pitch;
    wr_field_read(band->field, -1, j - 1, width + 2, rows + 2, in, pitch);
    for (int y = 0; y < rows; y++) {
        const float *at = in + (size_t)(y + 1) * pitch + 1;
        for (int i = 0; i < width; i++) {
            double su = 0.5 * ((double)at[i + 1] - at[i - 1]);
            double sv = 0.5 * ((double)at[(size_t)i + pitch] - at[i - (int64_t)pitch]);
            double slope = band->relief * sqrt(su * su + sv * sv);
            double angle = slope > 0.0 ? wr_atan2(slope, 1.0) / WR_RAD_PER_DEG : 0.0;
            out[(size_t)y * (size_t)width + (size_t)i] = in_band(band, angle);
        }
    }
    return true;
}

static bool check_slope(const Band *band, WrError *err)
{
    if (!check_band(band, "slope", err)) return false;
    if (band->low < 0.0) return fail(err, "slope", "low", band->low, "0..90 degrees");
    if (band->high > 90.0) return fail(err, "slope", "high", band->high, "0..90 degrees");
    if (!(band->relief > 0.0) || !isfinite(band->relief))
        return fail(err, "slope", "relief", band->relief, "above 0 and finite");
    return true;
}

WrField *wr_select_slope(const WrField *field, double relief, double low, double high, double soft,
                         WrPool *pool, WrError *err)
{
    Band band = { .field = field, .low = low, .high = high, .soft = soft, .relief = relief };
    if (!check_slope(&band, err)) return NULL;
    band.pitch = (size_t)wr_field_width(field) + 2;
    size_t threads = (size_t)wr_pool_threads(pool);
    band.scratch = wr_try_alloc(threads * (WR_TILE + 2) * band.pitch, sizeof *band.scratch,
                                "selection by slope", err);
    if (!band.scratch) return NULL;
    WrField *result = wr_select_build(field, in_band(&band, 0.0), slope_rows, &band, pool,
                                      wr_progress_here(), err);
    wr_free(band.scratch);
    return result;
}

WR_ROWS(wr_select_modes);
const char *const wr_select_modes[WR_SELECT_MODES + 1] = {
    [WR_ROW(WR_SELECT_REPLACE)] = "replace",
    [WR_ROW(WR_SELECT_ADD)] = "add",
    [WR_ROW(WR_SELECT_SUBTRACT)] = "subtract",
    [WR_ROW(WR_SELECT_INTERSECT)] = "intersect",
};
WR_ROWS_END(wr_select_modes, WR_SELECT_MODES);

static float join(WrSelectMode mode, float a, float b)
{
    float other = mode == WR_SELECT_SUBTRACT ? 1.0f - b : b;
    if (mode == WR_SELECT_REPLACE) return b;
    return mode == WR_SELECT_ADD ? (a > b ? a : b) : (a < other ? a : other);
}

/* True if b at `level` leaves every a unchanged. */
static bool keeps(WrSelectMode mode, float level)
{
    return mode == WR_SELECT_INTERSECT ? level >= 1.0f : mode != WR_SELECT_REPLACE && level <= 0.0f;
}

static double row_part(const WrField *field, int ty)
{
    return (double)ty / wr_field_tiles_v(field);
}

static void join_tile(WrField *out, const WrField *a, const WrField *b, WrSelectMode mode, int tx,
                      int ty)
{
    const float *ta = wr_field_tile(a, tx, ty), *tb = wr_field_tile(b, tx, ty);
    float *to = wr_field_tile_write(out, tx, ty);
    float la = wr_field_level(a), lb = wr_field_level(b);
    for (int i = 0; i < TEXELS; i++) to[i] = join(mode, ta ? ta[i] : la, tb ? tb[i] : lb);
}

WrField *wr_select_combine(const WrField *a, const WrField *b, WrSelectMode mode, WrError *err)
{
    if (mode == WR_SELECT_REPLACE) return wr_field_share(b);
    if (!a) return mode == WR_SELECT_SUBTRACT ? wr_select_invert(b) : wr_field_share(b);
    if (!wr_field_alike(a, b)) {
        wr_fail(err, "selection of %dx%d texels: must have the size and edges of the other, %dx%d",
                wr_field_width(b), wr_field_height(b), wr_field_width(a), wr_field_height(a));
        return NULL;
    }
    bool sparse = keeps(mode, wr_field_level(b));
    WrField *out = sparse ? wr_field_share(a)
                          : wr_field_new(wr_field_width(a), wr_field_height(a), wr_field_wrap_u(a),
                                         wr_field_wrap_v(a),
                                         join(mode, wr_field_level(a), wr_field_level(b)), err);
    for (int ty = 0; ty < wr_field_tiles_v(a) && wr_progress_report(row_part(a, ty)); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(a); tx++)
            if (wr_field_tile(b, tx, ty) || (!sparse && wr_field_tile(a, tx, ty)))
                join_tile(out, a, b, mode, tx, ty);
    return out;
}

WrField *wr_select_invert(const WrField *a)
{
    WrField *out = wr_field_new(wr_field_width(a), wr_field_height(a), wr_field_wrap_u(a),
                                wr_field_wrap_v(a), 1.0f - wr_field_level(a), NULL);
    for (int ty = 0; ty < wr_field_tiles_v(a) && wr_progress_report(row_part(a, ty)); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(a); tx++) {
            const float *from = wr_field_tile(a, tx, ty);
            if (!from) continue;
            float *to = wr_field_tile_write(out, tx, ty);
            for (int i = 0; i < TEXELS; i++) to[i] = 1.0f - from[i];
        }
    return out;
}

/* Blurs and clamps: rounding may move the blurred sum slightly outside 0..1. */
WrField *wr_select_feather(const WrField *a, double sigma, WrPool *pool, WrError *err)
{
    const WrOpInfo *blur = wr_op_find("blur"), *clamp = wr_op_find("clamp");
    WrOpOptions options = { .pool = pool, .progress = wr_progress_here() };
    if (sigma == 0.0) return wr_field_share(a);
    WrField *blurred = wr_op_run(blur, a, &sigma, &options, err);
    if (!blurred) return NULL;
    const double range[2] = { 0.0, 1.0 };
    WrField *result = wr_op_run(clamp, blurred, range, &options, err);
    wr_field_free(blurred);
    return result;
}
