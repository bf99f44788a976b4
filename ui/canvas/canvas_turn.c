#include "ui/canvas/canvas_turn.h"

#include <SDL.h>
#include <math.h>
#include <stddef.h>

#define DEGREE 0.017453292519943295
#define PARTS 256 /* of a pixel, in the weights */

typedef struct Turn {
    double c, s;
} Turn;

static Turn turn_of(double degrees)
{
    Turn turn = { cos(degrees * DEGREE), sin(degrees * DEGREE) };
    if (degrees / 90.0 == rint(degrees / 90.0)) turn = (Turn){ rint(turn.c), rint(turn.s) };
    return turn;
}

/* a + (b - a) t / PARTS of all four channels, two at a time. */
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

void wr_canvas_turn(const uint32_t *from, int from_w, int from_h, uint32_t *to, int to_w, int to_h,
                    double degrees, SDL_Rect rect)
{
    Turn t = turn_of(degrees);
    for (int j = rect.y; j < rect.y + rect.h; j++) {
        double dy = j + 0.5 - to_h / 2.0;
        for (int i = rect.x; i < rect.x + rect.w; i++) {
            double dx = i + 0.5 - to_w / 2.0;
            double x = t.c * dx + t.s * dy + from_w / 2.0 - 0.5 + 0.5 / PARTS;
            double y = t.c * dy - t.s * dx + from_h / 2.0 - 0.5 + 0.5 / PARTS;
            double fx = floor(x), fy = floor(y);
            int x0 = within((int)fx, from_w), x1 = within((int)fx + 1, from_w);
            const uint32_t *upper = from + (size_t)within((int)fy, from_h) * (size_t)from_w;
            const uint32_t *lower = from + (size_t)within((int)fy + 1, from_h) * (size_t)from_w;
            uint32_t tx = (uint32_t)((x - fx) * PARTS), ty = (uint32_t)((y - fy) * PARTS);
            to[(size_t)j * (size_t)to_w + (size_t)i] =
                blend(blend(upper[x0], upper[x1], tx), blend(lower[x0], lower[x1], tx), ty);
        }
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
