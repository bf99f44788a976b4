#include "brush/displace_modes.h"

#include "base/memory.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

void wr_mover_fini(WrMover *mover)
{
    wr_free(mover->memory);
    *mover = (WrMover){ 0 };
}

/* One axis of the box: from *low, *count texels. */
static bool axis(double p, double reach, double margin, int n, WrWrap wrap, int *low, int *count)
{
    WrWindow w = wr_window(p, 0.0, reach, n, wrap);
    if (w.low > w.high) return false;
    int more = margin < n ? (int)ceil(margin) : n;
    *low = w.low - more;
    *count = w.high - w.low + 1 + 2 * more;
    if (wrap == WR_WRAP_CLAMP) {
        int end = *low + *count < n ? *low + *count : n;
        *low = *low > 0 ? *low : 0;
        *count = end - *low;
    } else if (*count > n) {
        if (w.high - w.low + 1 == n) *low = w.low; /* the nearest image of the window */
        *count = n;
    }
    return true;
}

/* Limits a vector longer than the table. */
static double short_way(double d, int n, WrWrap wrap)
{
    if (!isfinite(d)) return 0.0;
    if (fabs(d) <= n) return d;
    return wrap == WR_WRAP_PERIODIC ? d - n * rint(d / n) : d > 0.0 ? n : -n;
}

static bool reserve(WrMover *mover, size_t floats)
{
    if (mover->size >= floats) return true;
    wr_free(mover->memory);
    mover->size = floats + floats / 2;
    mover->memory = wr_try_alloc(mover->size, sizeof(float), "a dab", NULL);
    if (!mover->memory) mover->size = 0;
    return mover->memory;
}

/* Weights of one row of the box: the dab's, times opacity and selection. `at`: scratch. */
static void weigh_row(const WrMaker *maker, const WrDabShape *shape, const WrMoveBox *box, int i,
                      int j, float *weights, float *chosen)
{
    float opacity = (float)maker->brush.opacity;
    wr_shape_row(shape, j, i, box->pitch, weights);
    if (maker->ground.selection)
        wr_read_box(maker->ground.selection, i, j, box->width, 1, box->pitch, chosen);
    for (int x = 0; x < box->width; x++) {
        float s = maker->ground.selection ? chosen[x] : 1.0f;
        s = s > 0.0f ? s : 0.0f;
        weights[x] *= opacity * (s < 1.0f ? s : 1.0f);
    }
    for (int x = box->width; x < box->pitch; x++) weights[x] = 0.0f;
}

/* Processes rows in runs of 64, the maximum count of kernels. */
static void weigh(const WrMaker *maker, const WrDabShape *shape, const WrMoveBox *box, int i, int j,
                  float *weights)
{
    for (int y = 0; y < box->height; y++) {
        float *row = weights + (size_t)y * (size_t)box->pitch;
        for (int x = 0; x < box->pitch; x += WR_TILE) {
            WrMoveBox part = *box;
            part.pitch = box->pitch - x < WR_TILE ? box->pitch - x : WR_TILE;
            part.width = box->width - x < part.pitch ? box->width - x : part.pitch;
            weigh_row(maker, shape, &part, i + x, j + y, row + x, box->spare);
        }
    }
}

static void write_mark(const WrMaker *maker, const float *weights, int count, float *mark)
{
    for (int i = 0; i < count; i++) {
        float w = weights[i];
        if (maker->work->lowers_mark) mark[i] = w > 0.0f ? mark[i] * (1.0f - w) : mark[i];
        else mark[i] = mark[i] < w ? w : mark[i];
    }
}

static bool any_weight(const float *weights, int count)
{
    int any = 0;
    for (int i = 0; i < count; i++) any |= weights[i] > 0.0f;
    return any;
}

static void write_row(const WrMaker *maker, const WrMoveBox *box, int i, int j, const float *from,
                      const float *weights)
{
    int width = wr_field_width(maker->ground.field), run;
    for (int x = 0; x < box->width; x += run) {
        int texel;
        run = wr_tile_run(i + x, i + box->width - 1, width, &texel);
        if (!any_weight(weights + x, run)) continue;
        int at = j % WR_TILE * WR_TILE + texel % WR_TILE;
        float *tile = wr_field_tile_write(maker->ground.field, texel / WR_TILE, j / WR_TILE) + at;
        for (int k = 0; k < run; k++)
            if (weights[x + k] > 0.0f) tile[k] = from[x + k];
        if (maker->ground.mark)
            write_mark(maker, weights + x, run,
                       wr_field_tile_write(maker->ground.mark, texel / WR_TILE, j / WR_TILE) + at);
    }
}

static void write_back(const WrMaker *maker, const WrMoveBox *box, int i, int j)
{
    int height = wr_field_height(maker->ground.field);
    for (int y = 0; y < box->height; y++) {
        size_t row = (size_t)y * (size_t)box->pitch;
        int texel;
        wr_tile_run(j + y, j + y, height, &texel);
        write_row(maker, box, i, texel, box->heights + row, box->weights + row);
    }
}

static void target_row(WrCoverage *cover, const WrMoveBox *box, int i, int j, float *out)
{
    int width = wr_field_width(cover->maker.start), run;
    for (int x = 0; x < box->width; x += run) {
        int texel;
        run = wr_tile_run(i + x, i + box->width - 1, width, &texel);
        const float *target = wr_coverage_target(cover, texel / WR_TILE, j / WR_TILE);
        memcpy(out + x, target + j % WR_TILE * WR_TILE + texel % WR_TILE,
               (size_t)run * sizeof *out);
    }
}

/* A covering mode used in a moving dab: blends to its result for coverage 1, by the dab's weight. */
static void cover_box(WrCoverage *cover, WrMoveBox *box, int i, int j)
{
    const WrMaker *maker = &cover->maker;
    float *ones = box->spare, *target = ones + box->pitch;
    for (int x = 0; x < box->pitch; x++) ones[x] = 1.0f;
    memset(target, 0, (size_t)box->pitch * sizeof *target);
    for (int y = 0; y < box->height; y++) {
        size_t row = (size_t)y * (size_t)box->pitch;
        int texel;
        wr_tile_run(j + y, j + y, wr_field_height(maker->start), &texel);
        if (maker->targets.kind != WR_BLEND_TARGET_NONE) target_row(cover, box, i, texel, target);
        for (int x = 0; x < box->pitch; x += WR_TILE) {
            int count = box->pitch - x < WR_TILE ? box->pitch - x : WR_TILE;
            maker->work->cover(&maker->args, box->heights + row + x, ones, target + x, count,
                               box->fresh + row + x);
        }
    }
    size_t texels = (size_t)box->pitch * (size_t)box->height;
    for (size_t k = 0; k < texels; k++) {
        double f = box->heights[k], w = box->weights[k];
        box->heights[k] = wr_finite_float(f * (1.0 - w) + box->fresh[k] * w);
    }
}

/* A fraction of the dab moves towards `dragged`; the weights of the mode are reduced. */
static void drag_box(WrMoveBox *box, const float *before, double drag, double dragged)
{
    size_t texels = (size_t)box->pitch * (size_t)box->height;
    for (size_t k = 0; k < texels; k++) {
        double f = before[k], w = box->weights[k];
        double done = box->heights[k] - f; /* change by the mode */
        box->heights[k] = wr_finite_float(f + (w * drag * (dragged - f) + (1.0 - drag) * done));
    }
}

/* Memory layout: weights, heights, fresh, a copy for dragging, spare rows. */
static bool lay_out(WrMover *mover, WrMoveBox *box, float **weights, float **before)
{
    size_t texels = (size_t)box->pitch * (size_t)box->height;
    size_t spare = 6 * ((size_t)box->pitch + 2 * WR_REACH_MAX);
    if (!reserve(mover, 4 * texels + spare)) return false;
    *weights = mover->memory;
    box->weights = *weights;
    box->heights = *weights + texels;
    box->fresh = box->heights + texels;
    *before = box->fresh + texels;
    box->spare = *before + texels;
    return true;
}

void wr_move_dab(WrMover *mover, WrCoverage *cover, const WrDabShape *shape, double radius,
                 double way_x, double way_y, double drag, double dragged)
{
    const WrMaker *maker = &cover->maker;
    const WrField *field = maker->ground.field;
    way_x = short_way(way_x, wr_field_width(field), wr_field_wrap_u(field));
    way_y = short_way(way_y, wr_field_height(field), wr_field_wrap_v(field));
    const WrMoveMargin reads = wr_mode_work(maker->brush.mode)->margin;
    double margin = reads ? reads(radius, way_x, way_y) : 1.0;
    int i, j;
    WrMoveBox box = { .dx = way_x, .dy = way_y, .radius = radius, .kernels = shape->kernels };
    if (!axis(shape->x, shape->reach_x, margin, wr_field_width(field), wr_field_wrap_u(field), &i,
              &box.width) ||
        !axis(shape->y, shape->reach_y, margin, wr_field_height(field), wr_field_wrap_v(field), &j,
              &box.height))
        return;
    box.pitch = (box.width + WR_BRUSH_BLOCK - 1) / WR_BRUSH_BLOCK * WR_BRUSH_BLOCK;
    box.wraps_x = wr_field_wrap_u(field) == WR_WRAP_PERIODIC && box.width == wr_field_width(field);
    box.wraps_y =
        wr_field_wrap_v(field) == WR_WRAP_PERIODIC && box.height == wr_field_height(field);
    box.x = shape->x - i;
    box.y = shape->y - j;
    box.reach = (int)maker->brush.reach;
    float *weights, *before;
    if (!lay_out(mover, &box, &weights, &before)) return;
    weigh(maker, shape, &box, i, j, weights);
    size_t texels = (size_t)box.pitch * (size_t)box.height;
    if (!any_weight(weights, (int)texels)) return;
    memset(box.heights, 0, texels * sizeof *box.heights);
    wr_read_box(field, i, j, box.width, box.height, box.pitch, box.heights);
    drag = drag > 0.0 ? (drag < 1.0 ? drag : 1.0) : 0.0;
    if (drag > 0.0) memcpy(before, box.heights, texels * sizeof *before);
    if (maker->work->move) maker->work->move(&box);
    else cover_box(cover, &box, i, j);
    if (drag > 0.0 && isfinite(dragged)) drag_box(&box, before, drag, dragged);
    write_back(maker, &box, i, j);
}

/* For large discs a grid of texels, at most about 32 x 32. */
double wr_move_height(const WrField *field, double x, double y, double radius)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    if (!isfinite(x) || !isfinite(y)) return 0.0;
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) x -= width * floor(x / width);
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) y -= height * floor(y / height);
    double r = radius > 0.5 ? radius : 0.5;
    WrWindow columns = wr_window(x, 0.0, r, width, wr_field_wrap_u(field));
    WrWindow rows = wr_window(y, 0.0, r, height, wr_field_wrap_v(field));
    int step_i = 1 + (columns.high - columns.low) / 32, step_j = 1 + (rows.high - rows.low) / 32;
    double sum = 0.0, weights = 0.0;
    for (int j = rows.low; j <= rows.high; j += step_j)
        for (int i = columns.low; i <= columns.high; i += step_i) {
            double d2 = ((i - x) * (i - x) + (j - y) * (j - y)) / (r * r);
            double w = d2 < 1.0 ? 1.0 - d2 : 0.0;
            if (!(w > 0.0)) continue;
            int ti, tj;
            wr_tile_run(i, i, width, &ti);
            wr_tile_run(j, j, height, &tj);
            sum += w * wr_field_get(field, ti, tj);
            weights += w;
        }
    if (weights > 0.0) return sum / weights;
    double i = floor(x + 0.5), j = floor(y + 0.5);
    i = wr_field_wrap_u(field) == WR_WRAP_PERIODIC ? i - width * floor(i / width) : i;
    j = wr_field_wrap_v(field) == WR_WRAP_PERIODIC ? j - height * floor(j / height) : j;
    i = i > 0.0 ? (i < width ? i : width - 1.0) : 0.0;
    j = j > 0.0 ? (j < height ? j : height - 1.0) : 0.0;
    return wr_field_get(field, (int)i, (int)j);
}
