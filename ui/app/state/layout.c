#include "ui/app/state/layout.h"

#include <SDL.h>
#include <math.h>

#define DIVIDER_UNITS 5
#define GRIP_UNITS 9 /* of a divider at a closed area, so that it is easily found */
#define VIEW_MIN_UNITS 120
#define PANEL_MIN_UNITS 190 /* smallest height of the upper part of the side panel */
#define LOWER_MIN_UNITS 160 /* smallest height of its lower part: one layer */
#define SIDE_MIN_UNITS 210  /* smallest width of the side panel */

static int clamp_int(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* A length in two parts with a divider between them. */
typedef struct Split {
    int first, divider, second;
} Split;

/* Each part keeps a minimum, or is closed if its share is less than half of that. */
static Split split(int size, double share, int least, double s)
{
    int d = (int)lround(DIVIDER_UNITS * s), grip = (int)lround(GRIP_UNITS * s);
    grip = grip < size ? grip : size;
    int first = (int)lround((size - d) * share), high = size - d - least;
    if (first < least / 2) return (Split){ 0, grip, size - grip };
    if (size - d - first < least / 2) return (Split){ size - grip, grip, 0 };
    first = high < least ? (size - d) / 2 : clamp_int(first, least, high);
    return (Split){ first, d, size - d - first };
}

static SDL_Rect shown(int x, int y, int w, int h)
{
    return w > 0 && h > 0 ? (SDL_Rect){ x, y, w, h } : (SDL_Rect){ 0 };
}

/* Split off the lower part of the side panel, if there is room for both. */
static void split_panel(WrLayout *out, double share, double s)
{
    int d = (int)lround(DIVIDER_UNITS * s), least = (int)lround(LOWER_MIN_UNITS * s);
    SDL_Rect whole = out->panel;
    int most = whole.h - d - (int)lround(PANEL_MIN_UNITS * s);
    if (most < least || whole.w <= 0) return;
    int lower = (int)lround((whole.h - d) * share);
    if (lower < least / 2) lower = 0, d = (int)lround(GRIP_UNITS * s);
    else lower = clamp_int(lower, least, most);
    out->panel.h = whole.h - d - lower;
    out->panel_divider = (SDL_Rect){ whole.x, whole.y + out->panel.h, whole.w, d };
    out->lower = shown(whole.x, whole.y + out->panel.h + d, whole.w, lower);
}

/* Width of the side panel in pixels: at most half of the window; 0: closed. */
static int side_width(const WrLayoutInput *in)
{
    const double s = in->scale;
    if (in->side_width < 0.0) return 0;
    int wide =
        clamp_int((int)lround(in->width * 0.208), (int)lround(250 * s), (int)lround(340 * s));
    if (in->side_width > 0.0) wide = (int)lround(fmax(in->side_width, SIDE_MIN_UNITS) * s);
    return wide < in->width / 2 ? wide : in->width / 2;
}

/* The areas around the views; returns the rectangle that is left for these. */
static SDL_Rect place_panels(const WrLayoutInput *in, WrLayout *out)
{
    const double s = in->scale;
    const int w = in->width, h = in->height, status = (int)lround(28 * s);
    const int options = in->hide_options ? 0 : (int)lround(44 * s);
    const int top = in->menu_height + options, tall = h - status - top;
    const int panel = side_width(in), side = (int)lround((panel ? DIVIDER_UNITS : GRIP_UNITS) * s);
    int strip = (int)lround(48 * s);
    if (in->tools * WR_TOOL_MIN * s > tall - 12 * s) strip = (int)lround(90 * s);
    if (in->hide_strip) strip = 0;
    const int left = in->side_left ? panel + side : strip, views = w - strip - panel - side;
    out->options = shown(0, in->menu_height, w, options);
    out->status = (SDL_Rect){ 0, h - status, w, status };
    out->strip = shown(in->side_left ? w - strip : 0, top, strip, tall);
    out->panel = shown(in->side_left ? 0 : w - panel, top, panel, tall);
    out->side = (SDL_Rect){ in->side_left ? panel : w - panel - side, top, side, tall };
    split_panel(out, in->lower, s);
    return (SDL_Rect){ left, top, views, tall };
}

WrLayout wr_layout_make(const WrLayoutInput *in)
{
    WrLayout out = { 0 };
    SDL_Rect room = { 0, in->menu_height, in->width, in->height - in->menu_height };
    if (in->panels) room = place_panels(in, &out);
    room.w = room.w > 1 ? room.w : 1;
    room.h = room.h > 1 ? room.h : 1;
    out.stacked = room.h > room.w && in->height > in->width;
    if (in->views == WR_VIEWS_CANVAS) out.canvas = room;
    if (in->views == WR_VIEWS_PATCH) out.patch = room;
    if (in->views != WR_VIEWS_BOTH) return out;
    const int least = (int)lround(VIEW_MIN_UNITS * in->scale);
    const Split c = split(out.stacked ? room.h : room.w, in->divider, least, in->scale);
    if (out.stacked) {
        out.canvas = shown(room.x, room.y, room.w, c.first);
        out.divider = (SDL_Rect){ room.x, room.y + c.first, room.w, c.divider };
        out.patch = shown(room.x, room.y + c.first + c.divider, room.w, c.second);
    } else {
        out.canvas = shown(room.x, room.y, c.first, room.h);
        out.divider = (SDL_Rect){ room.x + c.first, room.y, c.divider, room.h };
        out.patch = shown(room.x + c.first + c.divider, room.y, c.second, room.h);
    }
    return out;
}

double wr_layout_lower_at(const WrLayout *layout, int y)
{
    const SDL_Rect *d = &layout->panel_divider;
    double room = layout->panel.h + layout->lower.h;
    double end = layout->panel.y + room + d->h;
    double share = (end - y - d->h / 2.0) / fmax(room, 1.0);
    return share < 0.0 ? 0.0 : share > 0.95 ? 0.95 : share;
}

double wr_layout_divider_at(const WrLayout *layout, int x, int y)
{
    const SDL_Rect *c = &layout->canvas, *p = &layout->patch, *d = &layout->divider;
    const SDL_Rect *first = c->w > 0 ? c : d;
    double share = layout->stacked ? (y - first->y - d->h / 2.0) / (c->h + p->h)
                                   : (x - first->x - d->w / 2.0) / (c->w + p->w);
    return share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
}

double wr_layout_side_at(const WrLayout *layout, int width, double scale, int x)
{
    const SDL_Rect *d = &layout->side;
    const bool left = layout->panel.w > 0 ? layout->panel.x == 0 : d->x == 0;
    const double wide = ((left ? x : width - x) - d->w / 2.0) / scale;
    return wide < SIDE_MIN_UNITS / 2.0 ? -1.0 : wide;
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
