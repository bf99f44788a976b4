#include "brush/tip_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

/* ---- creation ---- */

WrTip *wr_tip_blank(int cells)
{
    WrTip *tip = wr_alloc(1, sizeof *tip);
    tip->refs = 1;
    tip->cells = cells;
    tip->cell = wr_alloc((size_t)cells, sizeof *tip->cell);
    tip->ranks = 1;
    tip->rank[0] = cells;
    tip->rule[0] = WR_TIP_INCREMENTAL;
    return tip;
}

WrTip *wr_tip_share(const WrTip *tip)
{
    WrTip *shared = (WrTip *)tip; /* only the reference count changes, atomically */
    if (shared) __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_tip_free(WrTip *tip)
{
    if (!tip || __atomic_sub_fetch(&tip->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    for (int i = 0; i < tip->cells; i++) wr_free(tip->cell[i].values);
    wr_free(tip->cell);
    wr_free(tip->name);
    wr_free(tip);
}

bool wr_tip_cell_alloc(WrTip *tip, int cell, int width, int height, const char *what, WrError *err)
{
    if (width < 1 || width > WR_TIP_SIDE || height < 1 || height > WR_TIP_SIDE)
        return wr_fail(err, "%s: a tip of %dx%d pixels: each side must be 1..%d", what, width,
                       height, WR_TIP_SIDE);
    WrTipCell made = { .levels = 0 };
    size_t count = 0;
    for (int w = width, h = height;; w = (w + 1) / 2, h = (h + 1) / 2) {
        made.width[made.levels] = w;
        made.height[made.levels] = h;
        made.start[made.levels++] = count;
        count += (size_t)w * (size_t)h;
        if (w == 1 && h == 1) break;
    }
    size_t bytes = count * sizeof *made.values;
    if (bytes > WR_TIP_BYTES - tip->bytes)
        return wr_fail(err, "%s: over %u MB with its smaller sizes: a tip must be smaller", what,
                       WR_TIP_BYTES >> 20);
    made.values = wr_try_alloc(count, sizeof *made.values, "a brush tip", err);
    if (!made.values) return false;
    tip->bytes += bytes;
    tip->cell[cell] = made;
    return true;
}

static float unit(float x)
{
    return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f; /* NaN becomes 0 */
}

bool wr_tip_cell_finish(WrTip *tip, int cell, int codes, WrError *err)
{
    WrTipCell *c = &tip->cell[cell];
    size_t count = (size_t)c->width[0] * (size_t)c->height[0];
    if (codes > 0) {
        if (!wr_tip_smooth(c->values, c->width[0], c->height[0], err)) return false;
        for (size_t i = 0; i < count; i++) c->values[i] = unit(c->values[i] / (float)codes);
    } else {
        for (size_t i = 0; i < count; i++) c->values[i] = unit(c->values[i]);
    }
    for (int l = 1; l < c->levels; l++)
        wr_tip_halve(c->values + c->start[l - 1], c->width[l - 1], c->height[l - 1],
                     c->values + c->start[l], c->width[l], c->height[l]);
    return true;
}

WrTip *wr_tip_new(int width, int height, const float *values, int codes, WrError *err)
{
    if (codes < 0 || codes > 65535) {
        wr_fail(err, "a tip of %d codes: must be 0..65535", codes);
        return NULL;
    }
    WrTip *tip = wr_tip_blank(1);
    if (!wr_tip_cell_alloc(tip, 0, width, height, "tip", err)) goto fail;
    float *out = tip->cell[0].values;
    size_t count = (size_t)width * (size_t)height;
    for (size_t i = 0; i < count; i++) out[i] = unit(values[i]) * (float)(codes > 0 ? codes : 1);
    if (!wr_tip_cell_finish(tip, 0, codes, err)) goto fail;
    return tip;
fail:
    wr_tip_free(tip);
    return NULL;
}

WrTip *wr_tip_parse(const void *bytes, size_t size, const char *name, WrError *err)
{
    if (!wr_tip_is_gbr(bytes, size)) return wr_tip_parse_gih(bytes, size, name, err);
    WrTip *tip = wr_tip_blank(1);
    size_t used;
    if (!wr_tip_parse_gbr(tip, 0, bytes, size, &used, &tip->name, &tip->spacing, name, err)) {
        wr_tip_free(tip);
        return NULL;
    }
    return tip;
}

/* ---- queries ---- */

const char *wr_tip_name(const WrTip *tip)
{
    return tip->name ? tip->name : "";
}

double wr_tip_spacing(const WrTip *tip)
{
    return tip->spacing;
}

int wr_tip_cells(const WrTip *tip)
{
    return tip->cells;
}

void wr_tip_size(const WrTip *tip, int cell, int *width, int *height)
{
    *width = tip->cell[cell].width[0];
    *height = tip->cell[cell].height[0];
}

/* ---- selection of a cell ---- */

/* 0..rank - 1. The first cell of an angular rank points up, the following ones clockwise. */
static int angular(double direction_rad, int rank)
{
    double turns = isfinite(direction_rad) ? 0.25 - direction_rad / (2.0 * WR_PI) : 0.0;
    turns -= floor(turns);
    int index = (int)rint(turns * rank);
    return index < rank ? index : 0;
}

int wr_tip_pick(const WrTip *tip, uint64_t number, double direction_rad, double pressure,
                double random)
{
    int cell = 0;
    random = random > 0.0 ? random < 1.0 ? random : 0x1.fffffffffffffp-1 : 0.0;
    pressure = pressure > 0.0 ? pressure < 1.0 ? pressure : 1.0 : 0.0;
    for (int r = 0; r < tip->ranks; r++) {
        int rank = tip->rank[r], index = 0;
        switch (tip->rule[r]) {
        case WR_TIP_INCREMENTAL: index = (int)(number % (uint64_t)rank); break;
        case WR_TIP_RANDOM:
            random *= rank;
            index = (int)random;
            random -= index; /* the remainder is used for the next rank */
            break;
        case WR_TIP_ANGULAR: index = angular(direction_rad, rank); break;
        case WR_TIP_PRESSURE: index = (int)rint(pressure * (rank - 1)); break;
        case WR_TIP_CONSTANT: break;
        }
        cell = cell * rank + index;
    }
    return cell < tip->cells ? cell : 0;
}

/* ---- sampling ---- */

void wr_tip_view(const WrTip *tip, int cell, double scale, WrTipView *view)
{
    const WrTipCell *c = &tip->cell[cell];
    double depth = scale > 0.0 && scale < 1.0 ? -wr_log2(scale) : 0.0;
    if (!(scale > 0.0)) depth = WR_TIP_LEVELS;
    int level = depth < c->levels - 1 ? (int)depth : c->levels - 1;
    *view = (WrTipView){ .fine = c->values + c->start[level],
                         .fine_w = c->width[level],
                         .fine_h = c->height[level] };
    if (level == c->levels - 1 || depth == level) return;
    view->coarse = c->values + c->start[level + 1];
    view->coarse_w = c->width[level + 1];
    view->coarse_h = c->height[level + 1];
    view->mix = (float)(depth - level);
}

static float tap(const float *values, int w, int h, int i, int j)
{
    return i >= 0 && i < w && j >= 0 && j < h ? values[(size_t)j * (size_t)w + (size_t)i] : 0.0f;
}

/* Bilinear; the picture is surrounded by 0. */
static float bilinear(const float *values, int w, int h, double s, double t)
{
    double x = s * w - 0.5, y = t * h - 0.5;
    if (!(x > -1.0 && x < w && y > -1.0 && y < h)) return 0.0f;
    double i = floor(x), j = floor(y);
    float fx = (float)(x - i), fy = (float)(y - j);
    int column = (int)i, row = (int)j;
    float a = tap(values, w, h, column, row), b = tap(values, w, h, column + 1, row);
    float c = tap(values, w, h, column, row + 1), d = tap(values, w, h, column + 1, row + 1);
    float top = a + fx * (b - a), bottom = c + fx * (d - c);
    return top + fy * (bottom - top);
}

float wr_tip_value(const WrTipView *view, double s, double t)
{
    float fine = bilinear(view->fine, view->fine_w, view->fine_h, s, t);
    if (!view->coarse) return fine;
    float coarse = bilinear(view->coarse, view->coarse_w, view->coarse_h, s, t);
    return fine + view->mix * (coarse - fine);
}
