#include "ui/app/state/layout.h"

#include <SDL.h>
#include <math.h>

#define DIVIDER_UNITS 5
#define VIEW_MIN_UNITS 120
#define PANEL_MIN_UNITS 190 /* smallest width of the right panel */
#define LOWER_MIN_UNITS 270 /* smallest height of its lower part: three layers */

static int clamp_int(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* Width (height) of the canvas in an area of `size`: its share, but each view keeps a minimum. */
static int canvas_size(int size, double share, int divider, int least)
{
    int size_canvas = (int)lround((size - divider) * share);
    int high = size - divider - least;
    return high < least ? (size - divider) / 2 : clamp_int(size_canvas, least, high);
}

/* Split off the lower part of the right panel, if there is room for both. */
static void split_panel(WrLayout *out, double share, double s)
{
    int d = (int)lround(DIVIDER_UNITS * s), least = (int)lround(LOWER_MIN_UNITS * s);
    SDL_Rect whole = out->panel;
    int most = whole.h - d - (int)lround(PANEL_MIN_UNITS * s);
    if (most < least) return;
    int lower = clamp_int((int)lround((whole.h - d) * share), least, most);
    out->panel.h = whole.h - d - lower;
    out->panel_divider = (SDL_Rect){ whole.x, whole.y + out->panel.h, whole.w, d };
    out->lower = (SDL_Rect){ whole.x, whole.y + out->panel.h + d, whole.w, lower };
}

WrLayout wr_layout_make(const WrLayoutInput *in)
{
    WrLayout out = { 0 };
    double s = in->scale;
    int w = in->width, h = in->height;
    SDL_Rect room = { 0, in->menu_height, w, h - in->menu_height };
    if (in->panels) {
        int options = (int)lround(44 * s), status = (int)lround(28 * s),
            strip = (int)lround(48 * s);
        if (in->tools * WR_TOOL_MIN * s > room.h - options - status - 12 * s)
            strip = (int)lround(90 * s);
        int panel = clamp_int((int)lround(w * 0.208), (int)lround(250 * s), (int)lround(340 * s));
        panel = panel < w / 2 ? panel : w / 2;
        out.options = (SDL_Rect){ 0, room.y, w, options };
        out.status = (SDL_Rect){ 0, h - status, w, status };
        int top = room.y + options, tall = h - status - top;
        out.strip = (SDL_Rect){ 0, top, strip, tall };
        out.panel = (SDL_Rect){ w - panel, top, panel, tall };
        split_panel(&out, in->lower, s);
        room = (SDL_Rect){ strip, top, w - strip - panel, tall };
    }
    room.w = room.w > 1 ? room.w : 1;
    room.h = room.h > 1 ? room.h : 1;
    out.stacked = room.h > room.w && h > w;
    if (in->views == WR_VIEWS_CANVAS) out.canvas = room;
    if (in->views == WR_VIEWS_PATCH) out.patch = room;
    if (in->views != WR_VIEWS_BOTH) return out;
    int d = (int)lround(DIVIDER_UNITS * s), least = (int)lround(VIEW_MIN_UNITS * s);
    if (out.stacked) {
        int c = canvas_size(room.h, in->divider, d, least);
        out.canvas = (SDL_Rect){ room.x, room.y, room.w, c };
        out.divider = (SDL_Rect){ room.x, room.y + c, room.w, d };
        out.patch = (SDL_Rect){ room.x, room.y + c + d, room.w, room.h - c - d };
    } else {
        int c = canvas_size(room.w, in->divider, d, least);
        out.canvas = (SDL_Rect){ room.x, room.y, c, room.h };
        out.divider = (SDL_Rect){ room.x + c, room.y, d, room.h };
        out.patch = (SDL_Rect){ room.x + c + d, room.y, room.w - c - d, room.h };
    }
    return out;
}

double wr_layout_lower_at(const WrLayout *layout, int y)
{
    const SDL_Rect *d = &layout->panel_divider;
    double room = layout->panel.h + layout->lower.h;
    double share = (layout->lower.y + layout->lower.h - y - d->h / 2.0) / fmax(room, 1.0);
    return share < 0.05 ? 0.05 : share > 0.95 ? 0.95 : share;
}

double wr_layout_divider_at(const WrLayout *layout, int x, int y)
{
    const SDL_Rect *c = &layout->canvas, *p = &layout->patch, *d = &layout->divider;
    double share = layout->stacked ? (y - c->y - d->h / 2.0) / (c->h + p->h)
                                   : (x - c->x - d->w / 2.0) / (c->w + p->w);
    return share < 0.05 ? 0.05 : share > 0.95 ? 0.95 : share;
}

bool wr_layout_inside(const SDL_Rect *r, int x, int y)
{
    return x >= r->x && y >= r->y && x < r->x + r->w && y < r->y + r->h;
}

/* One axis: limit the length to the area, then move inside it. */
static void fit_axis(int from, int length, int before, int after, int *at, int *size)
{
    int most = length - before - after;
    if (*size > most && most > 0) *size = most;
    int last = from + length - after - *size;
    if (*at > last) *at = last;
    if (*at < from + before) *at = from + before;
}

bool wr_layout_window(const SDL_Rect *room, const SDL_Rect *now, const int borders[4],
                      SDL_Rect *fits)
{
    *fits = *now;
    fit_axis(room->x, room->w, borders[0], borders[2], &fits->x, &fits->w);
    fit_axis(room->y, room->h, borders[1], borders[3], &fits->y, &fits->h);
    return !SDL_RectEquals(fits, now);
}
