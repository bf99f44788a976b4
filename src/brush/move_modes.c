#include <math.h>
#include <string.h>

#include "brush/displace_modes.h"

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
