/* Over the patch: two pictures to compare, maps of one quantity, their labels and scales. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_schedule.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/retained_frame.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/patch/patch.h"
#include "ui/patch/preview/preview.h"

#include "accuracy/plot.h"
#include "accuracy/metrics.h"
#include "base/array.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "render/reference/reference.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define GRASP_UNITS 7 /* on both sides of the divider */

WR_ROWS(wr_patch_look_names);
const char *const wr_patch_look_names[WR_PATCH_LOOKS] = {
    [WR_ROW(WR_PATCH_PLAIN)] = "Picture",        [WR_ROW(WR_PATCH_SPLIT)] = "Split A | B",
    [WR_ROW(WR_PATCH_FLICKER)] = "Flicker A, B", [WR_ROW(WR_PATCH_ERROR)] = "Error",
    [WR_ROW(WR_PATCH_DROPPED)] = "Dropped term", [WR_ROW(WR_PATCH_TILT)] = "Slope of the bump",
    [WR_ROW(WR_PATCH_LEVEL)] = "Mip level",      [WR_ROW(WR_PATCH_HEIGHT)] = "Heights",
    [WR_ROW(WR_PATCH_NORMAL)] = "Normals",       [WR_ROW(WR_PATCH_LACKS)] = "Beside displacement",
    [WR_ROW(WR_PATCH_RAN)] = "Effects that ran",
};
WR_ROWS_END(wr_patch_look_names, WR_PATCH_LOOKS);

void wr_accuracy_set_view(WrApp *app, WrPatchLook look)
{
    WrAccuracy *a = app->accuracy;
    a->look = look;
    a->look_of = 0;
    a->flicker_since = wr_clock_seconds();
    app->patch->look.ran = look == WR_PATCH_RAN;
    if (look != WR_PATCH_PLAIN && look != WR_PATCH_RAN)
        app->settings->turning = false; /* compared pictures must be static */
    wr_app_redraw(app);
}

/* ---- textures ---- */

static void put(WrApp *app, WrPatchLayer *layer, const uint8_t *bgra, int width, int height,
                uint64_t of)
{
    if (!layer->texture || layer->width != width || layer->height != height) {
        if (layer->texture) SDL_DestroyTexture(layer->texture);
        layer->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                           SDL_TEXTUREACCESS_STREAMING, width, height);
        layer->width = layer->height = 0;
        if (!layer->texture) return;
        SDL_SetTextureBlendMode(layer->texture, SDL_BLENDMODE_NONE);
        SDL_SetTextureScaleMode(layer->texture, SDL_ScaleModeLinear);
        layer->width = width;
        layer->height = height;
    }
    wr_gui_sdl_update(layer->texture, NULL, bgra, 4 * width);
    layer->of = of;
    if (app->redraw < 1) app->redraw = 1;
}

static const WrProbeMap map_kinds[WR_PATCH_LOOKS] = {
    [WR_PATCH_DROPPED] = WR_MAP_DROPPED, [WR_PATCH_TILT] = WR_MAP_TILT,
    [WR_PATCH_LEVEL] = WR_MAP_LEVEL,     [WR_PATCH_HEIGHT] = WR_MAP_HEIGHT,
    [WR_PATCH_NORMAL] = WR_MAP_NORMAL,
};

WrProbeMap wr_accuracy_map_of(WrPatchLook look)
{
    return map_kinds[look];
}

static WrPatchLook look_of(WrProbeMap map)
{
    for (int i = WR_PATCH_DROPPED; i < WR_PATCH_RAN; i++)
        if (map_kinds[i] == map) return (WrPatchLook)i;
    return WR_PATCH_PLAIN;
}

static void colour_of(int look, double value, double low, double full, uint8_t rgb[3])
{
    if (look != WR_PATCH_NORMAL) {
        wr_heat_colour((value - low) / (full - low), rgb);
        return;
    }
    for (int c = 0; c < 3; c++) rgb[c] = (uint8_t)((int)value >> (16 - 8 * c) & 255);
}

/* Values as colours, low .. full; the background where there is no value. */
static void lay_map(WrApp *app, const WrWork *work, int look)
{
    WrPatchLayer *layer = &app->accuracy->map;
    const size_t count = (size_t)work->measured_w * (size_t)work->measured_h;
    uint8_t *bgra = wr_alloc(count, 4);
    const bool range = look == WR_PATCH_HEIGHT;
    const double low = range ? work->low : 0, full = !range ? wr_plot_round_up(work->high)
                                                     : work->high > work->low ? work->high
                                                                              : work->low + 1;
    for (size_t i = 0; i < count; i++) {
        uint8_t rgb[3] = { 0x2e, 0x2f, 0x30 };
        if (!isnan(work->values[i])) colour_of(look, (double)work->values[i], low, full, rgb);
        bgra[4 * i] = rgb[2];
        bgra[4 * i + 1] = rgb[1];
        bgra[4 * i + 2] = rgb[0];
        bgra[4 * i + 3] = 255;
    }
    put(app, layer, bgra, work->measured_w, work->measured_h, work->of);
    layer->look = look;
    layer->low = low;
    layer->full = full;
    wr_free(bgra);
}

/* The three errors of each pixel as colours, as in the file of `accuracy --illusion --map`. */
static void lay_lacks(WrApp *app, const WrWork *work)
{
    const WrIllusion *it = &work->illusion;
    const size_t count = (size_t)it->width * (size_t)it->height;
    uint8_t *bgra = wr_alloc(count, 4);
    for (size_t i = 0; i < count; i++) {
        uint8_t rgb[3];
        wr_illusion_colour(it, i, rgb);
        for (int c = 0; c < 3; c++) bgra[4 * i + 2 - (size_t)c] = rgb[c];
        bgra[4 * i + 3] = 255;
    }
    put(app, &app->accuracy->map, bgra, it->width, it->height, work->of);
    app->accuracy->map.look = WR_PATCH_LACKS;
    wr_free(bgra);
}

void wr_accuracy_lay(WrApp *app, const WrWork *work)
{
    WrAccuracy *a = app->accuracy;
    if (work->kind == WR_WORK_ILLUSION) {
        lay_lacks(app, work);
    } else if (work->kind == WR_WORK_PAIR) {
        for (int i = 0; i < 2; i++)
            put(app, &a->pair[i], work->bgra[i], work->width, work->height, work->of);
        a->flicker_since = wr_clock_seconds();
    } else if (work->kind == WR_WORK_ERROR) {
        lay_map(app, work, WR_PATCH_ERROR);
    } else {
        lay_map(app, work, look_of(work->map));
    }
}

/* ---- drawing ---- */

static bool pair_ready(const WrAccuracy *a)
{
    return a->pair[1].texture && a->pair[0].of == a->state && a->pair[1].of == a->state;
}

static bool map_ready(const WrAccuracy *a)
{
    return a->map.texture && a->map.of == a->state && a->map.look == (int)a->look;
}

/* First pixel column of B. */
static int line_x(const WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    return room->x + (int)lround(room->w * app->accuracy->split);
}

static bool shows_split(const WrAccuracy *a)
{
    return a->look == WR_PATCH_SPLIT && !a->hold_b && pair_ready(a);
}

static void draw_split(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    WrAccuracy *a = app->accuracy;
    SDL_Rect left = { room->x, room->y, line_x(app) - room->x, room->h };
    SDL_Rect right = { left.x + left.w, room->y, room->w - left.w, room->h };
    WrRetainedFrame *kept = wr_gui_kept(app->gui);
    wr_retained_frame_copy(kept, a->pair[0].texture, &(SDL_Rect){ 0, 0, left.w, left.h }, &left);
    wr_retained_frame_copy(kept, a->pair[1].texture, &(SDL_Rect){ left.w, 0, right.w, right.h },
                           &right);
}

void wr_accuracy_draw(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    WrAccuracy *a = app->accuracy;
    if (a->look == WR_PATCH_ERROR && a->error && a->error->of == a->state &&
        (a->map.of != a->state || a->map.look != WR_PATCH_ERROR))
        wr_accuracy_lay(app, a->error);
    if (room->w <= 0) return;
    if (shows_split(a)) {
        draw_split(app);
    } else if (a->hold_b || a->look == WR_PATCH_FLICKER) {
        double next;
        if (!pair_ready(a)) return;
        a->flicker_shown =
            a->hold_b || wr_accuracy_flicker(wr_clock_seconds(), a->flicker_since, &next);
        wr_retained_frame_copy(wr_gui_kept(app->gui), a->pair[a->flicker_shown].texture, NULL,
                               room);
    } else if (map_ready(a)) {
        wr_retained_frame_copy(wr_gui_kept(app->gui), a->map.texture, NULL, room);
    }
}

/* ---- divider ---- */

bool wr_accuracy_on_line(const WrApp *app, double x, double y)
{
    const SDL_Rect *room = &app->layout->patch;
    return shows_split(app->accuracy) && y >= room->y && y < room->y + room->h &&
           fabs(x - line_x(app)) <= GRASP_UNITS * wr_gui_scale();
}

void wr_accuracy_drag_line(WrApp *app, double x)
{
    const SDL_Rect *room = &app->layout->patch;
    app->accuracy->split =
        wr_accuracy_split_from_pointer(x, room->x, room->w, 12.0 * wr_gui_scale());
    wr_app_redraw(app);
}

/* ---- labels ---- */

/* A text chip with its left (anchor 0) or right (1) end at x and its lower edge at y. */
static void chip(double x, double y, double anchor, double most, const char *letter,
                 const char *words)
{
    const double s = wr_gui_scale(), pad = 7 * s, tall = 22 * s;
    const double head = wr_gui_text_width(WR_FONT_BOLD, letter);
    char cut[160];
    snprintf(cut, sizeof cut, "%.150s", words);
    size_t length = strlen(cut);
    const double gap = letter[0] && cut[0] ? 7 * s : 0, room = most - head - gap - 2 * pad;
    while (length > 4 && wr_gui_text_width(WR_FONT_SMALL, cut) > room) {
        cut[--length] = '\0';
        memcpy(cut + length - 3, "...", 3);
    }
    const double body = wr_gui_text_width(WR_FONT_SMALL, cut), wide = head + gap + body + 2 * pad;
    const double left = x - anchor * wide, top = y - tall;
    wr_gui_draw_fill(left, top, wide, tall, WR_COLOUR_CHIP, 3 * s);
    wr_gui_draw_text(left + pad, top + floor((tall - wr_gui_line_height(WR_FONT_BOLD)) / 2),
                     WR_FONT_BOLD, WR_COLOUR_STRONG, letter);
    wr_gui_draw_text(left + pad + head + gap,
                     top + floor((tall - wr_gui_line_height(WR_FONT_SMALL)) / 2), WR_FONT_SMALL,
                     WR_COLOUR_TEXT, cut);
}

static void side_label(const WrApp *app, int side, double x, double anchor, double most)
{
    const SDL_Rect *room = &app->layout->patch;
    WrText words = { 0 };
    wr_accuracy_dials_text(app, side, &words);
    chip(x, room->y + room->h - 12 * wr_gui_scale(), anchor, most, side ? "B" : "A",
         wr_text_get(&words));
    wr_text_fini(&words);
}

static void split_labels(const WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    const double s = wr_gui_scale(), x = line_x(app);
    /* Labels are at the outer corners, so that they do not cover the other picture; leave room for the ring. */
    const double left = room->x + 12 * s, right = room->x + room->w - 40 * s;
    const double middle = room->y + room->h / 2.0;
    wr_gui_draw_fill(x - 2 * s, room->y, 4 * s, room->h, 0x80101010u, 0);
    wr_gui_draw_fill(x - floor(s / 2), room->y, floor(s) > 1 ? floor(s) : 1, room->h, 0xfff0f0f0u,
                     0);
    wr_gui_draw_disc(x, middle, 9 * s, 0xff202020u);
    wr_gui_draw_circle(x, middle, 9 * s, 0xfff0f0f0u, 1.5 * s);
    for (int i = -1; i <= 1; i += 2)
        wr_gui_draw_fill(x + i * 3 * s - s / 2, middle - 3 * s, s, 6 * s, 0xfff0f0f0u, 0);
    side_label(app, 0, left, 0, fmax(24 * s, fmin(x - 10 * s, room->x + room->w * 0.5) - left));
    side_label(app, 1, right, 1, fmax(24 * s, right - fmax(x + 10 * s, room->x + room->w * 0.5)));
}

/* ---- scales ---- */

static const struct {
    const char *title, *unit;
} scales[WR_PATCH_LOOKS] = {
    [WR_PATCH_ERROR] = { "Error of linear intensity", "" },
    [WR_PATCH_DROPPED] = { "Left out by the small-F approximation", "\xc2\xb0" },
    [WR_PATCH_TILT] = { "Angle between n and n'", "\xc2\xb0" },
    [WR_PATCH_LEVEL] = { "Mip level, log2 of texels a pixel", "" },
    [WR_PATCH_HEIGHT] = { "F times the height of the bump", "" },
};

static void draw_scale(const WrApp *app)
{
    const WrPatchLayer *map = &app->accuracy->map;
    const SDL_Rect *room = &app->layout->patch;
    const double s = wr_gui_scale(), pad = 10 * s, line = wr_gui_line_height(WR_FONT_SMALL);
    const double wide = fmin(280 * s, room->w - 56 * s), bar = wide - 2 * pad;
    const double tall = 2 * pad + 2 * line + 22 * s;
    const double left = room->x + 12 * s, top = room->y + room->h - 12 * s - tall;
    char text[64], number[16];
    if (bar < 60 * s) return;
    wr_gui_draw_fill(left, top, wide, tall, WR_COLOUR_CHIP, 3 * s);
    wr_gui_draw_text(left + pad, top + pad, WR_FONT_SMALL, WR_COLOUR_TEXT, scales[map->look].title);
    const double y = top + pad + line + 6 * s;
    const int steps = 96;
    for (int i = 0; i < steps; i++) {
        uint8_t rgb[3];
        const double x0 = floor(bar * i / steps), x1 = floor(bar * (i + 1) / steps);
        wr_heat_colour((i + 0.5) / steps, rgb);
        wr_gui_draw_fill(left + pad + x0, y, x1 - x0, 10 * s,
                         0xff000000u | (WrColour)rgb[0] << 16 | (WrColour)rgb[1] << 8 | rgb[2], 0);
    }
    wr_gui_draw_rect(left + pad, y, bar, 10 * s, WR_COLOUR_OFF, 1);
    for (int i = 0; i <= 2; i++) {
        snprintf(text, sizeof text, "%s%s%s",
                 wr_plot_number(map->low + (map->full - map->low) * i / 2, number),
                 scales[map->look].unit, i == 2 ? wr_words(" and up") : "");
        const double w = wr_gui_text_width(WR_FONT_SMALL, text);
        wr_gui_draw_text(left + pad + (bar - w) * i / 2, y + 14 * s, WR_FONT_SMALL, WR_COLOUR_LABEL,
                         text);
    }
}

/* ---- legend of the effect heatmap ---- */

#define RAN_LINES 12 /* limit */

/* Name of a colour and its effects; false: there is no such line. */
static bool ran_line(const WrPreviewPicture *picture, int i, WrHeatmapLine *line, WrText *text)
{
    if (i >= RAN_LINES || !wr_heatmap_line(&picture->counts, i, line)) return false;
    wr_heatmap_colour(line, text);
    wr_text_add(text, ": ");
    wr_heatmap_words(line, text);
    return true;
}

static void draw_ran(const WrApp *app)
{
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    const SDL_Rect *room = &app->layout->patch;
    const double s = wr_gui_scale(), pad = 10 * s, high = wr_gui_line_height(WR_FONT_SMALL) + 4 * s;
    const double swatch = 12 * s, most = room->w - 56 * s;
    WrText text[RAN_LINES] = { { 0 } };
    WrHeatmapLine line[RAN_LINES];
    double wide = 0;
    int count = 0;
    while (picture->ran && ran_line(picture, count, &line[count], &text[count])) {
        wide = fmax(wide, wr_gui_text_width(WR_FONT_SMALL, wr_text_get(&text[count])));
        count++;
    }
    wide = fmin(wide + swatch + 8 * s + 2 * pad, most);
    const double tall = count * high + 2 * pad - 4 * s;
    const double left = room->x + 12 * s, top = room->y + room->h - 12 * s - tall;
    const bool fits = count > 0 && wide > 60 * s && tall < room->h - 24 * s;
    if (fits) wr_gui_draw_fill(left, top, wide, tall, WR_COLOUR_CHIP, 3 * s);
    for (int i = 0; i < count; i++) {
        const double y = top + pad + i * high;
        const WrColour colour = 0xff000000u | (WrColour)line[i].rgb[0] << 16 |
                                (WrColour)line[i].rgb[1] << 8 | line[i].rgb[2];
        if (fits) {
            const double middle = y + (high - 4 * s - swatch) / 2 + s;
            wr_gui_draw_fill(left + pad, middle, swatch, swatch, colour, 2 * s);
            wr_gui_draw_rect(left + pad, middle, swatch, swatch, WR_COLOUR_MUTED, 1);
            wr_gui_draw_text(left + pad + swatch + 8 * s, y, WR_FONT_SMALL, WR_COLOUR_TEXT,
                             wr_text_get(&text[i]));
        }
        wr_text_fini(&text[i]);
    }
}

/* Meaning of the colours, and the height below which the errors are invisible. */
static void draw_lacks(const WrApp *app)
{
    const WrWork *work = app->accuracy->illusion;
    const SDL_Rect *room = &app->layout->patch;
    const double s = wr_gui_scale(), left = room->x + 12 * s, bottom = room->y + room->h - 12 * s;
    WrText text = { 0 };
    if (!work) return;
    wr_illusion_height(&work->illusion, &text);
    chip(left, bottom - 28 * s, 0, room->w - 56 * s, "",
         wr_words("red: outline, green: shading, blue: shadow"));
    chip(left, bottom, 0, room->w - 56 * s, "", wr_text_get(&text));
    wr_text_fini(&text);
}

static const char *waiting(const WrApp *app)
{
    if (app->settings->turning) return "when the patch rests";
    return wr_accuracy_rests(app) ? "in a moment" : "when the hand rests";
}

void wr_accuracy_overlay(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    const SDL_Rect *room = &app->layout->patch;
    const double s = wr_gui_scale();
    bool pair = a->look == WR_PATCH_SPLIT || a->look == WR_PATCH_FLICKER || a->hold_b;
    if (room->w <= 0 || (!pair && a->look == WR_PATCH_PLAIN)) return;
    wr_gui_draw_clip(*room);
    if (!pair && a->look == WR_PATCH_RAN) {
        draw_ran(app);
        wr_gui_draw_unclip();
        return;
    }
    bool ready = pair ? pair_ready(a) : map_ready(a);
    if (!ready) {
        char text[96];
        const char *name = wr_patch_look_names[a->hold_b ? WR_PATCH_FLICKER : a->look];
        bool failed =
            !pair && a->look == WR_PATCH_ERROR && a->error_of == a->state && a->error_why.text[0];
        snprintf(text, sizeof text, "%s: %s", wr_words(name),
                 failed ? wr_words("cannot be measured") : wr_words(waiting(app)));
        chip(room->x + 12 * s, room->y + room->h - 12 * s, 0, room->w - 56 * s, "", text);
    } else if (shows_split(a)) {
        split_labels(app);
    } else if (pair) {
        side_label(app, a->flicker_shown, room->x + 12 * s, 0, room->w - 56 * s);
    } else if (a->look == WR_PATCH_LACKS) {
        draw_lacks(app);
    } else if (a->look != WR_PATCH_NORMAL) {
        draw_scale(app);
    }
    wr_gui_draw_unclip();
}
