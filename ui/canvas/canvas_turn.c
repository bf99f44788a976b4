#include "ui/canvas/canvas_turn.h"
#include "ui/canvas/view.h"

#include <SDL.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define PARTS 256 /* subdivisions of a pixel in the weights */

typedef struct Turn {
    double c, s;
} Turn;

static Turn turn_of(double degrees)
{
    Turn turn;
    wr_view_turn_of(degrees, &turn.c, &turn.s);
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
