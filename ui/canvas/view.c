#include "ui/canvas/view.h"

#include "base/exactmath.h"

#include <math.h>
#include <stdlib.h>

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

void wr_view_zoom_range(const WrCanvasView *view, double *low, double *high)
{
    double longer = view->table_w > view->table_h ? view->table_w : view->table_h;
    *low = clamp(64.0 / longer, 1.0 / 128.0, 1.0);
    *high = 128.0;
}

void wr_view_turn_of(double degrees, double *c, double *s)
{
    double quarters = degrees / 90.0;
    *c = cos(degrees * WR_RAD_PER_DEG);
    *s = sin(degrees * WR_RAD_PER_DEG);
    /* cos and sin of quarter turns are off by 1e-16, which would blur a picture rotated by them. */
    if (quarters == rint(quarters)) *c = rint(*c), *s = rint(*s);
}

void wr_view_fit(WrCanvasView *view, double margin)
{
    double free = 1.0 - margin, c, s;
    wr_view_turn_of(view->turn, &c, &s);
    double wide = fabs(c) * view->table_w + fabs(s) * view->table_h;
    double tall = fabs(s) * view->table_w + fabs(c) * view->table_h;
    double zoom = fmin(view->w * free / wide, view->h * free / tall);
    double low, high;
    wr_view_zoom_range(view, &low, &high);
    view->zoom = clamp(zoom, low, high);
    view->centre_x = view->table_w / 2.0;
    view->centre_y = view->table_h / 2.0;
}

void wr_view_step(const WrCanvasView *view, double dx, double dy, double *px, double *py)
{
    double c = 1.0, s = 0.0, x = view->mirrored ? -view->zoom * dx : view->zoom * dx,
           y = view->zoom * dy;
    if (view->turn != 0.0) wr_view_turn_of(view->turn, &c, &s);
    *px = c * x - s * y;
    *py = s * x + c * y;
}

void wr_view_step_back(const WrCanvasView *view, double dx, double dy, double *x, double *y)
{
    double c = 1.0, s = 0.0;
    if (view->turn != 0.0) wr_view_turn_of(view->turn, &c, &s);
    double across = (c * dx + s * dy) / view->zoom;
    *x = view->mirrored ? -across : across;
    *y = (c * dy - s * dx) / view->zoom;
}

static bool is_odd(double k)
{
    return fmod(k, 2.0) != 0.0;
}

void wr_view_tiling_shift(const WrCanvasView *view, int i, int j, double *dx, double *dy)
{
    *dx = view->tiling == WR_TILING_BRICK && is_odd(j) ? view->table_w / 2.0 : 0.0;
    *dy = view->tiling == WR_TILING_HALF_DROP && is_odd(i) ? view->table_h / 2.0 : 0.0;
}

static void from_pixel(const WrCanvasView *view, double px, double py, double *x, double *y)
{
    wr_view_step_back(view, px - view->x - view->w / 2.0, py - view->y - view->h / 2.0, x, y);
    *x += view->centre_x;
    *y += view->centre_y;
}

void wr_view_to_texel(const WrCanvasView *view, double px, double py, double *x, double *y)
{
    from_pixel(view, px, py, x, y);
    if (view->tiling == WR_TILING_HALF_DROP && is_odd(floor(*x / view->table_w)))
        *y -= view->table_h / 2.0;
    if (view->tiling == WR_TILING_BRICK && is_odd(floor(*y / view->table_h)))
        *x -= view->table_w / 2.0;
}

void wr_view_place(const WrCanvasView *view, double x, double y, double *px, double *py)
{
    wr_view_step(view, x - view->centre_x, y - view->centre_y, px, py);
    *px += view->x + view->w / 2.0;
    *py += view->y + view->h / 2.0;
}

void wr_view_to_pixel(const WrCanvasView *view, double x, double y, double *px, double *py)
{
    if (view->tiling == WR_TILING_HALF_DROP && is_odd(floor(x / view->table_w)))
        y += view->table_h / 2.0;
    else if (view->tiling == WR_TILING_BRICK && is_odd(floor(y / view->table_h)))
        x += view->table_w / 2.0;
    wr_view_place(view, x, y, px, py);
}

void wr_view_bounds(const WrCanvasView *view, double low[2], double high[2])
{
    for (int k = 0; k < 4; k++) {
        double at[2];
        from_pixel(view, view->x + (k & 1 ? view->w : 0), view->y + (k & 2 ? view->h : 0), &at[0],
                   &at[1]);
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = k == 0 ? at[axis] : fmin(low[axis], at[axis]);
            high[axis] = k == 0 ? at[axis] : fmax(high[axis], at[axis]);
        }
    }
}

WrCellRange wr_view_cells(const WrCanvasView *view)
{
    double low[2], high[2];
    wr_view_bounds(view, low, high);
    return (WrCellRange){ (int)floor(low[0] / view->table_w) - 1,
                          (int)floor(high[0] / view->table_w) + 1,
                          (int)floor(low[1] / view->table_h) - 1,
                          (int)floor(high[1] / view->table_h) + 1 };
}

WrCanvasView wr_view_flat(const WrCanvasView *view)
{
    WrCanvasView flat = *view;
    double c, s;
    wr_view_turn_of(view->turn, &c, &s);
    flat.x = flat.y = 0;
    if (view->turn == 0.0) return flat;
    flat.turn = 0.0;
    flat.w = (int)ceil(fabs(c) * view->w + fabs(s) * view->h) + 2;
    flat.h = (int)ceil(fabs(s) * view->w + fabs(c) * view->h) + 2;
    return flat;
}

bool wr_view_same(const WrCanvasView *a, const WrCanvasView *b)
{
    return a->x == b->x && a->y == b->y && a->w == b->w && a->h == b->h &&
           a->table_w == b->table_w && a->table_h == b->table_h && a->zoom == b->zoom &&
           a->centre_x == b->centre_x && a->centre_y == b->centre_y && a->mirrored == b->mirrored &&
           a->turn == b->turn && a->tiling == b->tiling;
}

void wr_view_to_uv(const WrCanvasView *view, double px, double py, double *u, double *v)
{
    double x, y;
    wr_view_to_texel(view, px, py, &x, &y);
    *u = x / view->table_w;
    *v = 1.0 - y / view->table_h;
}

/* Move the centre so that the position `x`, `y`, ignoring the tiling's shifts, is under the pixel. */
static void put_under(WrCanvasView *view, double px, double py, double x, double y)
{
    double after_x, after_y;
    from_pixel(view, px, py, &after_x, &after_y);
    view->centre_x += x - after_x;
    view->centre_y += y - after_y;
    wr_view_keep_near(view);
}

void wr_view_zoom_at(WrCanvasView *view, double px, double py, double zoom)
{
    double x, y, low, high;
    from_pixel(view, px, py, &x, &y);
    wr_view_zoom_range(view, &low, &high);
    view->zoom = clamp(zoom, low, high);
    put_under(view, px, py, x, y);
}

void wr_view_turn_at(WrCanvasView *view, double px, double py, double degrees)
{
    double x, y;
    from_pixel(view, px, py, &x, &y);
    view->turn = degrees - 360.0 * rint(degrees / 360.0);
    put_under(view, px, py, x, y);
}

void wr_view_pan(WrCanvasView *view, double dx, double dy)
{
    double x, y;
    wr_view_step_back(view, dx, dy, &x, &y);
    view->centre_x -= x;
    view->centre_y -= y;
    wr_view_keep_near(view);
}

void wr_view_keep_near(WrCanvasView *view)
{
    /* a tiling that shifts every other copy has a period of two copies */
    double w = view->tiling == WR_TILING_HALF_DROP ? 2.0 * view->table_w : view->table_w;
    double h = view->tiling == WR_TILING_BRICK ? 2.0 * view->table_h : view->table_h;
    view->centre_x -= floor(view->centre_x / w) * w;
    view->centre_y -= floor(view->centre_y / h) * h;
}

/* Distance from x to the interval [0, size]. */
static double outside(double x, double size)
{
    return x < 0.0 ? -x : x > size ? x - size : 0.0;
}

int wr_view_outline_copies(const WrCanvasView *view, bool wraps_u, bool wraps_v, double x, double y,
                           double radius, WrShift copies[WR_VIEW_COPIES])
{
    double w = view->table_w, h = view->table_h;
    double home_x = wraps_u ? -floor(x / w) * w : 0.0;
    double home_y = wraps_v ? -floor(y / h) * h : 0.0;
    int count = 0;
    copies[count++] = (WrShift){ home_x, home_y };
    for (int j = -1; j <= 1; j++) {
        for (int i = -1; i <= 1; i++) {
            if ((i == 0 && j == 0) || (i && !wraps_u) || (j && !wraps_v)) continue;
            double dx = home_x + i * w, dy = home_y + j * h;
            double ox = outside(x + dx, w), oy = outside(y + dy, h);
            if (hypot(ox, oy) < radius) copies[count++] = (WrShift){ dx, dy };
        }
    }
    return count;
}
