#include "ui/canvas/view.h"

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

void wr_view_fit(WrCanvasView *view, double margin)
{
    double free = 1.0 - margin;
    double zoom = fmin(view->w * free / view->table_w, view->h * free / view->table_h);
    double low, high;
    wr_view_zoom_range(view, &low, &high);
    view->zoom = clamp(zoom, low, high);
    view->centre_x = view->table_w / 2.0;
    view->centre_y = view->table_h / 2.0;
}

double wr_view_across(const WrCanvasView *view)
{
    return view->mirrored ? -view->zoom : view->zoom;
}

void wr_view_to_texel(const WrCanvasView *view, double px, double py, double *x, double *y)
{
    *x = view->centre_x + (px - view->x - view->w / 2.0) / wr_view_across(view);
    *y = view->centre_y + (py - view->y - view->h / 2.0) / view->zoom;
}

void wr_view_to_pixel(const WrCanvasView *view, double x, double y, double *px, double *py)
{
    *px = view->x + view->w / 2.0 + (x - view->centre_x) * wr_view_across(view);
    *py = view->y + view->h / 2.0 + (y - view->centre_y) * view->zoom;
}

void wr_view_to_uv(const WrCanvasView *view, double px, double py, double *u, double *v)
{
    double x, y;
    wr_view_to_texel(view, px, py, &x, &y);
    *u = x / view->table_w;
    *v = 1.0 - y / view->table_h;
}

void wr_view_zoom_at(WrCanvasView *view, double px, double py, double zoom)
{
    double x, y, low, high, after_x, after_y;
    wr_view_to_texel(view, px, py, &x, &y);
    wr_view_zoom_range(view, &low, &high);
    view->zoom = clamp(zoom, low, high);
    wr_view_to_texel(view, px, py, &after_x, &after_y);
    view->centre_x += x - after_x;
    view->centre_y += y - after_y;
    wr_view_keep_near(view);
}

void wr_view_pan(WrCanvasView *view, double dx, double dy)
{
    view->centre_x -= dx / wr_view_across(view);
    view->centre_y -= dy / view->zoom;
    wr_view_keep_near(view);
}

void wr_view_keep_near(WrCanvasView *view)
{
    view->centre_x -= floor(view->centre_x / view->table_w) * view->table_w;
    view->centre_y -= floor(view->centre_y / view->table_h) * view->table_h;
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
