#include "ui/canvas/view.h"

#include "base/exactmath.h"

#include <SDL.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

static void view_keep_near(WrCanvasView *view);

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Zoom limits; zoom 1 is 100 %. From 1/128, or the zoom at which the longer side is 64 pixels if that is larger, up
   to 128 pixels per texel. */
static void view_zoom_range(const WrCanvasView *view, double *low, double *high)
{
    double longer = view->table_w > view->table_h ? view->table_w : view->table_h;
    *low = clamp(64.0 / longer, 1.0 / 128.0, 1.0);
    *high = 128.0;
}

/* Cosine and sine of a rotation in degrees; quarter turns are exact. */
static void view_turn_of(double degrees, double *c, double *s)
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
    view_turn_of(view->turn, &c, &s);
    double wide = fabs(c) * view->table_w + fabs(s) * view->table_h;
    double tall = fabs(s) * view->table_w + fabs(c) * view->table_h;
    double zoom = fmin(view->w * free / wide, view->h * free / tall);
    double low, high;
    view_zoom_range(view, &low, &high);
    view->zoom = clamp(zoom, low, high);
    view->centre_x = view->table_w / 2.0;
    view->centre_y = view->table_h / 2.0;
}

void wr_view_step(const WrCanvasView *view, double dx, double dy, double *px, double *py)
{
    double c = 1.0, s = 0.0, x = view->mirrored ? -view->zoom * dx : view->zoom * dx,
           y = view->zoom * dy;
    if (view->turn != 0.0) view_turn_of(view->turn, &c, &s);
    *px = c * x - s * y;
    *py = s * x + c * y;
}

void wr_view_step_back(const WrCanvasView *view, double dx, double dy, double *x, double *y)
{
    double c = 1.0, s = 0.0;
    if (view->turn != 0.0) view_turn_of(view->turn, &c, &s);
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
    view_turn_of(view->turn, &c, &s);
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

void wr_view_middle(const WrCanvasView *view, double at[2])
{
    wr_view_to_uv(view, view->x + view->w / 2.0, view->y + view->h / 2.0, &at[0], &at[1]);
    for (int k = 0; k < 2; k++) at[k] -= floor(at[k]);
}

/* Move the centre so that the position `x`, `y`, ignoring the tiling's shifts, is under the pixel. */
static void put_under(WrCanvasView *view, double px, double py, double x, double y)
{
    double after_x, after_y;
    from_pixel(view, px, py, &after_x, &after_y);
    view->centre_x += x - after_x;
    view->centre_y += y - after_y;
    view_keep_near(view);
}

void wr_view_zoom_at(WrCanvasView *view, double px, double py, double zoom)
{
    double x, y, low, high;
    from_pixel(view, px, py, &x, &y);
    view_zoom_range(view, &low, &high);
    view->zoom = clamp(zoom, low, high);
    put_under(view, px, py, x, y);
}

void wr_view_turn_at(WrCanvasView *view, double px, double py, double degrees)
{
    double x, y;
    from_pixel(view, px, py, &x, &y);
    view->turn = wr_signed_degrees(degrees);
    put_under(view, px, py, x, y);
}

void wr_view_pan(WrCanvasView *view, double dx, double dy)
{
    double x, y;
    wr_view_step_back(view, dx, dy, &x, &y);
    view->centre_x -= x;
    view->centre_y -= y;
    view_keep_near(view);
}

static void view_keep_near(WrCanvasView *view)
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

/* ---- rotated picture ---- */

#define PARTS 256 /* subdivisions of a pixel in the weights */

typedef struct Turn {
    double c, s;
} Turn;

static Turn turn_of(double degrees)
{
    Turn turn;
    view_turn_of(degrees, &turn.c, &turn.s);
    return turn;
}

/* a + (b - a) t / PARTS for all four channels, two at a time. */
static uint32_t blend(uint32_t a, uint32_t b, uint32_t t)
{
    const uint32_t mask = 0x00ff00ffu;
    uint32_t even = (a & mask) * (PARTS - t) + (b & mask) * t;
    uint32_t odd = (a >> 8 & mask) * (PARTS - t) + (b >> 8 & mask) * t;
    return (even >> 8 & mask) | (odd & 0xff00ff00u);
}

static int within(int at, int size)
{
    return at < 0 ? 0 : at >= size ? size - 1 : at;
}

/* Positions are integers in units of 2^-32 pixel: quarter turns are exact, and rows do not drift. */
#define FIXED 4294967296.0

typedef struct Source {
    const uint32_t *pixels;
    int w, h;
} Source;

static uint32_t between(const Source *from, int64_t x, int64_t y)
{
    int left = (int)(x >> 32), top = (int)(y >> 32);
    uint32_t tx = (uint32_t)(x >> 24) & (PARTS - 1), ty = (uint32_t)(y >> 24) & (PARTS - 1);
    bool inside = left >= 0 && top >= 0 && left + 1 < from->w && top + 1 < from->h;
    int x0 = inside ? left : within(left, from->w),
        x1 = inside ? left + 1 : within(left + 1, from->w);
    int y0 = inside ? top : within(top, from->h), y1 = inside ? top + 1 : within(top + 1, from->h);
    const uint32_t *upper = from->pixels + (size_t)y0 * (size_t)from->w;
    const uint32_t *lower = from->pixels + (size_t)y1 * (size_t)from->w;
    return blend(blend(upper[x0], upper[x1], tx), blend(lower[x0], lower[x1], tx), ty);
}

void wr_canvas_turn(const uint32_t *from, int from_w, int from_h, uint32_t *to, int to_w, int to_h,
                    double degrees, SDL_Rect rect)
{
    const Turn t = turn_of(degrees);
    const Source source = { from, from_w, from_h };
    const int64_t step_x = llrint(t.c * FIXED), step_y = llrint(-t.s * FIXED);
    for (int j = rect.y; j < rect.y + rect.h; j++) {
        const double dx = rect.x + 0.5 - to_w / 2.0, dy = j + 0.5 - to_h / 2.0;
        /* half a pixel, and rounding to the nearest subdivision */
        const double half = 0.5 - 0.5 / PARTS;
        int64_t x = llrint((t.c * dx + t.s * dy + from_w / 2.0 - half) * FIXED);
        int64_t y = llrint((t.c * dy - t.s * dx + from_h / 2.0 - half) * FIXED);
        uint32_t *out = to + (size_t)j * (size_t)to_w + (size_t)rect.x;
        for (int i = 0; i < rect.w; i++, x += step_x, y += step_y) out[i] = between(&source, x, y);
    }
}

SDL_Rect wr_canvas_turned_rect(SDL_Rect rect, int from_w, int from_h, int to_w, int to_h,
                               double degrees)
{
    Turn t = turn_of(degrees);
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (int k = 0; k < 4; k++) {
        double dx = rect.x + (k & 1 ? rect.w : 0) - from_w / 2.0;
        double dy = rect.y + (k & 2 ? rect.h : 0) - from_h / 2.0;
        double x = t.c * dx - t.s * dy + to_w / 2.0, y = t.s * dx + t.c * dy + to_h / 2.0;
        x0 = fmin(x0, x), x1 = fmax(x1, x);
        y0 = fmin(y0, y), y1 = fmax(y1, y);
    }
    SDL_Rect whole = { 0, 0, to_w, to_h }, out = { (int)floor(x0) - 2, (int)floor(y0) - 2, 0, 0 };
    out.w = (int)ceil(x1) + 2 - out.x;
    out.h = (int)ceil(y1) + 2 - out.y;
    return SDL_IntersectRect(&out, &whole, &out) ? out : (SDL_Rect){ 0, 0, 0, 0 };
}
