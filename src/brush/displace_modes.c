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

/* One axis of the box: from *low, *count texels. If the box would exceed a periodic table, it is the whole axis once: each
   texel is moved once per dab. */
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

float *wr_mover_reserve(WrMover *mover, size_t floats)
{
    if (mover->size >= floats) return mover->memory;
    wr_free(mover->memory);
    mover->size = floats + floats / 2;
    mover->memory = wr_try_alloc(mover->size, sizeof(float), "a dab", NULL);
    if (!mover->memory) mover->size = 0;
    return mover->memory;
}

/* Weights of one row of the box: the dab's, times opacity and selection. `at`: scratch. */
static void weigh_row(const WrStrokeResolver *maker, const WrDabShape *shape, const WrMoveBox *box,
                      int i, int j, float *weights, float *chosen)
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
static void weigh(const WrStrokeResolver *maker, const WrDabShape *shape, const WrMoveBox *box,
                  int i, int j, float *weights)
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

void wr_move_write_mark(const WrStrokeResolver *maker, const float *weights, int count, float *mark)
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

static void write_row(const WrStrokeResolver *maker, const WrMoveBox *box, int i, int j,
                      const float *from, const float *weights)
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
            wr_move_write_mark(
                maker, weights + x, run,
                wr_field_tile_write(maker->ground.mark, texel / WR_TILE, j / WR_TILE) + at);
    }
}

static void write_back(const WrStrokeResolver *maker, const WrMoveBox *box, int i, int j)
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
    const WrStrokeResolver *maker = &cover->maker;
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

/* A fraction of the dab moves towards `dragged`; the weights of the mode are reduced. f' = f + w drag (dragged - f) + (1 -
   drag) (f_mode - f). */
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
    if (!wr_mover_reserve(mover, 4 * texels + spare)) return false;
    *weights = mover->memory;
    box->weights = *weights;
    box->heights = *weights + texels;
    box->fresh = box->heights + texels;
    *before = box->fresh + texels;
    box->spare = *before + texels;
    return true;
}

/* Unlike covering modes, moving ones read present heights and write them at once, dab after dab. The box of heights is copied
   out with the margin that the mode reads, changed in plain memory, and written back where the weight is above 0. */
void wr_move_dab(WrMover *mover, WrCoverage *cover, const WrDabShape *shape, double radius,
                 double way_x, double way_y, double drag, double dragged)
{
    const WrStrokeResolver *maker = &cover->maker;
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

/* ---- move modes ---- */

/* fraction of the distance to the path by which one dab of pinch moves heights inwards */
#define PULL 0.2

static void swap(WrMoveBox *box)
{
    float *made = box->fresh;
    box->fresh = box->heights;
    box->heights = made;
}

/* Row y of `from` with `more` texels before and after: those of the opposite side if the sides meet,
 * else 0. */
static void wide_row(const WrMoveBox *box, const float *from, int y, int more, float *out)
{
    if (box->wraps_y) y = y % box->height < 0 ? y % box->height + box->height : y % box->height;
    if (y < 0 || y >= box->height) {
        memset(out, 0, (size_t)(box->width + 2 * more) * sizeof *out);
        return;
    }
    const float *row = from + (size_t)y * (size_t)box->pitch;
    memcpy(out + more, row, (size_t)box->width * sizeof *out);
    for (int k = 0; k < more; k++) {
        int left = (box->width - 1 - k % box->width), right = k % box->width;
        out[more - 1 - k] = box->wraps_x ? row[left] : 0.0f;
        out[more + box->width + k] = box->wraps_x ? row[right] : 0.0f;
    }
}

/* One pass between neighbours `stride` apart. Weights beyond the box are 0: no flow there. */
static void smooth_pass(WrMoveBox *box, int stride)
{
    int wide = box->width + 2 * stride;
    float *f = box->spare, *w = f + wide, *f_up = w + wide, *w_up = f_up + wide;
    float *f_down = w_up + wide, *w_down = f_down + wide;
    for (int y = 0; y < box->height; y++) {
        wide_row(box, box->heights, y, stride, f);
        wide_row(box, box->weights, y, stride, w);
        wide_row(box, box->heights, y - stride, stride, f_up);
        wide_row(box, box->weights, y - stride, stride, w_up);
        wide_row(box, box->heights, y + stride, stride, f_down);
        wide_row(box, box->weights, y + stride, stride, w_down);
        float *out = box->fresh + (size_t)y * (size_t)box->pitch;
        memcpy(out, box->heights + (size_t)y * (size_t)box->pitch,
               (size_t)box->pitch * sizeof *out);
        box->kernels->flow(f + stride, w + stride, f_up + stride, w_up + stride, f_down + stride,
                           w_down + stride, stride, box->width, out);
    }
    swap(box);
}

/* From far neighbours to near ones, so that the near passes smooth the artefacts of the far ones. */
void wr_move_smooth(WrMoveBox *box)
{
    for (int stride = box->reach; stride > 0; stride /= 2) smooth_pass(box, stride);
}

/* Weighted sums over the dab. */
typedef struct Fit {
    double w, x, y, f, xx, xy, yy, xf, yf;
} Fit;

static Fit sums(const WrMoveBox *box)
{
    Fit s = { 0 };
    for (int y = 0; y < box->height; y++) {
        const float *w = box->weights + (size_t)y * (size_t)box->pitch;
        const float *f = box->heights + (size_t)y * (size_t)box->pitch;
        double ey = y - box->y;
        for (int x = 0; x < box->width; x++) {
            double ex = x - box->x, wx = w[x] * ex, wy = w[x] * ey;
            s.w += w[x];
            s.x += wx;
            s.y += wy;
            s.f += (double)w[x] * f[x];
            s.xx += wx * ex;
            s.xy += wx * ey;
            s.yy += wy * ey;
            s.xf += wx * f[x];
            s.yf += wy * f[x];
        }
    }
    return s;
}

/* The least-squares plane f = mean + gx (ex - x) + gy (ey - y), from the covariances:
 *   (xx xy; xy yy) (gx, gy) = (xf, yf).
 * If all texels lie on one line it slopes along one axis only, and for one texel it is level. */
void wr_move_level(WrMoveBox *box)
{
    Fit s = sums(box);
    double x = s.x / s.w, y = s.y / s.w, f = s.f / s.w;
    double xx = s.xx / s.w - x * x, xy = s.xy / s.w - x * y, yy = s.yy / s.w - y * y;
    double xf = s.xf / s.w - x * f, yf = s.yf / s.w - y * f;
    double det = xx * yy - xy * xy, gx = 0.0, gy = 0.0;
    const double least = 1e-3; /* texels, squared */
    if (xx > least && yy > least && det > 1e-6 * xx * yy) {
        gx = (xf * yy - yf * xy) / det;
        gy = (yf * xx - xf * xy) / det;
    } else if (xx > least && xx >= yy) {
        gx = xf / xx;
    } else if (yy > least) {
        gy = yf / yy;
    }
    for (int row = 0; row < box->height; row++) {
        size_t at = (size_t)row * (size_t)box->pitch;
        double level = f + gy * (row - box->y - y);
        for (int column = 0; column < box->width; column++) {
            double plane = level + gx * (column - box->x - x),
                   w = box->weights[at + (size_t)column];
            double made = box->heights[at + (size_t)column] * (1.0 - w) + plane * w;
            box->heights[at + (size_t)column] = wr_finite_float(made);
        }
    }
}

/* index reduced to the box: wrapped if the sides meet, else clamped */
static int inside(int i, int n, bool wraps)
{
    if (wraps) return i % n < 0 ? i % n + n : i % n;
    return i < 0 ? 0 : i < n ? i : n - 1;
}

/* Bilinear. */
static float height_at(const WrMoveBox *box, double x, double y)
{
    double cx = floor(x), cy = floor(y), fx = x - cx, fy = y - cy;
    int i = inside((int)cx, box->width, box->wraps_x);
    int k = inside((int)cx + 1, box->width, box->wraps_x);
    size_t pitch = (size_t)box->pitch;
    const float *upper = box->heights + (size_t)inside((int)cy, box->height, box->wraps_y) * pitch;
    const float *lower =
        box->heights + (size_t)inside((int)cy + 1, box->height, box->wraps_y) * pitch;
    double above = upper[i] * (1.0 - fx) + upper[k] * fx;
    double below = lower[i] * (1.0 - fx) + lower[k] * fx;
    return (float)(above * (1.0 - fy) + below * fy);
}

/* Heights are moved from farther out: perpendicular to the path if it has a direction, else away from
 * its centre. */
double wr_move_pinch_margin(double radius, double way_x, double way_y)
{
    (void)way_x, (void)way_y;
    return 0.25 * radius + 2.0;
}

double wr_move_smear_margin(double radius, double way_x, double way_y)
{
    (void)radius;
    return fmax(fabs(way_x), fabs(way_y)) + 2.0;
}

void wr_move_pinch(WrMoveBox *box)
{
    double length2 = box->dx * box->dx + box->dy * box->dy;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            size_t at = (size_t)y * (size_t)box->pitch + (size_t)x;
            double w = PULL * box->weights[at], ex = x - box->x, ey = y - box->y;
            if (length2 > 0.0) {
                double along = (ex * box->dx + ey * box->dy) / length2;
                ex -= along * box->dx;
                ey -= along * box->dy;
            }
            box->fresh[at] = w > 0.0 ? height_at(box, x + w * ex, y + w * ey) : box->heights[at];
        }
    swap(box);
}

void wr_move_smear(WrMoveBox *box)
{
    if (box->dx == 0.0 && box->dy == 0.0) return;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            size_t at = (size_t)y * (size_t)box->pitch + (size_t)x;
            double f = box->heights[at], w = box->weights[at];
            double from = w > 0.0 ? height_at(box, x - box->dx, y - box->dy) : f;
            box->fresh[at] = w > 0.0 ? (float)(f * (1.0 - w) + from * w) : box->heights[at];
        }
    swap(box);
}
