#include "ui/app/canvas_chip.h"
#include "ui/canvas/canvas.h"
#include "ui/state/app_state.h"
#include "ui/state/layout.h"
#include "ui/state/session_view.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/enum_rows.h"
#include "field/maps.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>

const WrCanvasMapRow wr_canvas_maps[WR_CANVAS_SHOWN] = {
    [WR_CANVAS_HEIGHTS] = { .name = "Heights" },
    [WR_CANVAS_OCCLUSION] = { "Occlusion", WR_FIELD_MAP_OCCLUSION, WR_CANVAS_GREY, 0, 1 },
    [WR_CANVAS_CAVITY] = { "Cavity", WR_FIELD_MAP_CAVITY, WR_CANVAS_GREY, 0, 0 },
    [WR_CANVAS_CURVATURE] = { "Curvature", WR_FIELD_MAP_CURVATURE, WR_CANVAS_SIGNED, -0.2, 0.2 },
    [WR_CANVAS_SLOPE] = { "Steepness", WR_FIELD_MAP_SLOPE, WR_CANVAS_GREY, 0, 90 },
    [WR_CANVAS_ROUGHNESS] = { "Roughness", WR_FIELD_MAP_ROUGHNESS, WR_CANVAS_GREY, 0, 1 },
    [WR_CANVAS_LIT] = { "Relief", WR_FIELD_MAP_SLOPE_U, WR_CANVAS_RELIEF, 0, 1, true },
    [WR_CANVAS_BENT] = { "Normals", WR_FIELD_MAP_SLOPE_U, WR_CANVAS_NORMALS, 0, 1, true },
};

#define LOOKS 3 /* displays of heights */

/* ---- range popup ---- */

/* Colour ramp over all existing or displayed heights, lowest first, in the canvas colours: heights beyond the range
   are visible at its ends. */
static void ramp(const WrApp *app, const char *id, double wide, double tall)
{
    const WrCanvasRange *r = app->map_shown ? app->map_range : app->range;
    double low = fmin(r->low, r->table_low), high = fmax(r->high, r->table_high);
    WrPad pad = wr_gui_pad_begin(id, wide, tall);
    for (int x = 0; x < (int)pad.w; x++) {
        double height = low + (high - low) * (x + 0.5) / pad.w;
        wr_gui_draw_fill(pad.x + x, pad.y, 1, pad.h, wr_canvas_colour(app->canvas, height), 0);
    }
    wr_gui_pad_end();
}

static void ramp_tip(const WrApp *app)
{
    const WrCanvasRange *r = app->map_shown ? app->map_range : app->range;
    char tip[160];
    bool beyond = r->table_low < r->low || r->table_high > r->high;
    snprintf(tip, sizeof tip, wr_words("The %s goes from %.4g to %.4g%s"),
             wr_words(app->map_shown ? "map" : "table"), r->table_low, r->table_high,
             beyond ? wr_words(": some of it lies beyond the range that is shown") : "");
    wr_gui_tip(tip);
}

static bool is_unit(const WrCanvasLook *look)
{
    return !look->automatic && look->low == 0.0 && look->high == 1.0;
}

static void choose_way(WrApp *app, int way)
{
    WrCanvasLook *look = &app->settings->look;
    look->automatic = way == 0;
    if (way == 0) wr_canvas_fit_range(app->canvas);
    if (way == 0) return;
    look->low = way == 1 ? 0.0 : app->range->low;
    look->high = way == 1 ? 1.0 : app->range->high;
}

/* Choice of display in two rows: the table and its slopes, and maps of it. */
static void choose_shown(WrCanvasLook *look)
{
    static const WrCanvasShown rows[2][4] = {
        { WR_CANVAS_HEIGHTS, WR_CANVAS_LIT, WR_CANVAS_SLOPE, WR_CANVAS_BENT },
        { WR_CANVAS_OCCLUSION, WR_CANVAS_CAVITY, WR_CANVAS_CURVATURE, WR_CANVAS_ROUGHNESS }
    };
    for (int r = 0; r < 2; r++) {
        const char *names[4];
        int now = -1;
        for (int i = 0; i < 4; i++) {
            names[i] = wr_canvas_maps[rows[r][i]].name;
            if (rows[r][i] == look->shown) now = i;
        }
        if (wr_gui_segments(r ? "maps" : "shown", names, NULL, 4, &now)) look->shown = rows[r][now];
        wr_gui_tip("The table itself, or a map of it that follows the brush");
    }
}

static void range_popup(WrApp *app)
{
    WR_ROWS(looks);
    static const char *const looks[] = { [WR_ROW(WR_CANVAS_GREY)] = "Grey",
                                         [WR_ROW(WR_CANVAS_SIGNED)] = "Signed",
                                         [WR_ROW(WR_CANVAS_CONTOURS)] = "Contours" };
    WR_ROWS_END(looks, LOOKS);
    static const char *const ways[] = { "As the table", "0 to 1", "As it is now" };
    WrCanvasLook *look = &app->settings->look;
    int chosen = (int)look->colours, way = look->automatic ? 0 : is_unit(look) ? 1 : 2;
    if (!wr_gui_popup_begin("range")) return;
    choose_shown(look);
    if (look->shown != WR_CANVAS_HEIGHTS) {
        if (!wr_canvas_maps[look->shown].two) ramp(app, "wide", wr_gui_px(240), wr_gui_px(12));
        ramp_tip(app);
        wr_gui_popup_end();
        return;
    }
    if (wr_gui_segments("look", looks, NULL, LOOKS, &chosen))
        look->colours = (WrCanvasColours)chosen;
    if (wr_gui_segments("way", ways, NULL, 3, &way)) choose_way(app, way);
    ramp(app, "wide", wr_gui_px(240), wr_gui_px(12));
    ramp_tip(app);
    wr_gui_check("Mark heights beyond", &look->marks);
    wr_gui_tip("Warm above the range, cool below it");
    double field = 120 * wr_gui_scale();
    WrNumber low = { .low = -1,
                     .high = 1,
                     .hard_low = -1e30,
                     .hard_high = look->high - 1e-6,
                     .reset = 0,
                     .decimals = 3,
                     .tip = "Height shown as black" };
    WrNumber high = { .low = 0,
                      .high = 2,
                      .hard_low = look->low + 1e-6,
                      .hard_high = 1e30,
                      .reset = 1,
                      .decimals = 3,
                      .tip = "Height shown as white" };
    wr_gui_disable(look->automatic);
    double l = app->range->low, h = app->range->high;
    wr_gui_label("Black");
    if (wr_gui_number("low", field, &low, &l) && l < look->high) look->low = l;
    wr_gui_label("White");
    if (wr_gui_number("high", field, &high, &h) && h > look->low) look->high = h;
    wr_gui_enable();
    wr_gui_popup_end();
}

static void chip_text(const WrApp *app, const WrCanvasRange *range, char *text, size_t size)
{
    static const char *const looks[LOOKS] = { "Grey", "Signed", "Contours" };
    const WrCanvasLook *look = &app->settings->look;
    const WrCanvasMapRow *map = app->map_shown ? &wr_canvas_maps[look->shown] : NULL;
    const char *name = wr_words(wr_app_shows_mask(app) ? "Mask"
                                : map                  ? map->name
                                                       : looks[look->colours]);
    if (map && map->two) snprintf(text, size, "%s", name);
    else if (!map && !wr_app_shows_mask(app) && look->colours == WR_CANVAS_CONTOURS)
        snprintf(text, size, wr_words("Contours every %.3g"), wr_canvas_contour_step(app->canvas));
    else snprintf(text, size, "%s %.3g \xe2\x80\x93 %.3g", name, range->low, range->high);
}

/* Light direction of relief shading: a shaded ball in the corner; dragging it moves the light. */
static void light(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    WrCanvasLook *look = &app->settings->look;
    int gap = wr_gui_px(12), side = wr_gui_px(44);
    wr_gui_overlay_begin("##light", room->x + gap, room->y + wr_gui_px(48), 0, 0);
    WrPad pad = wr_gui_pad_begin("light", side, side);
    double r = 0.46 * side, x = pad.x + pad.w / 2, y = pad.y + pad.h / 2;
    if (pad.held) {
        double dx = (pad.pointer_x - x) / r, dy = (y - pad.pointer_y) / r, far = hypot(dx, dy);
        double most = far > 0.98 ? 0.98 / far : 1.0;
        look->light_x = dx * most;
        look->light_y = dy * most;
    }
    for (int i = 0; i < 12; i++) { /* from its dark rim towards the light */
        double t = i / 12.0;
        uint32_t g = (uint32_t)(70 + 175 * t);
        wr_gui_draw_disc(x + look->light_x * r * t * 0.9, y - look->light_y * r * t * 0.9,
                         r * (1.0 - t), 0xff000000u | g << 16 | g << 8 | g);
    }
    wr_gui_draw_disc(x + look->light_x * r * 0.9, y - look->light_y * r * 0.9, wr_gui_px(4),
                     0xffffd060u);
    wr_gui_pad_end();
    wr_gui_tip("Where the light comes from: drag it");
    wr_gui_overlay_end();
}

void wr_canvas_chip(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    int gap = wr_gui_px(12);
    char text[96];
    const WrCanvasLook *look = &app->settings->look;
    const WrCanvasRange *range = app->map_shown ? app->map_range : app->range;
    chip_text(app, range, text, sizeof text);
    wr_gui_overlay_begin("##range", room->x + gap, room->y + gap, 0, 0);
    wr_gui_next_id("range"); /* the numbers change under the pointer */
    if (wr_gui_chip(WR_ICON_DOWN, text)) wr_gui_popup_open("range");
    wr_gui_tip("The values shown, and which of them are black and white");
    /* Beside the range button, if there is room for the square at the right end. */
    bool ranged = !app->map_shown || !wr_canvas_maps[look->shown].two;
    if (ranged && room->w > wr_gui_text_width(WR_FONT_TEXT, text) + wr_gui_px(180)) {
        wr_gui_same_line(6);
        ramp(app, "narrow", wr_gui_px(64), wr_gui_line_height(WR_FONT_TEXT));
        ramp_tip(app);
    }
    range_popup(app);
    wr_gui_overlay_end();
    if (app->map_shown && look->shown == WR_CANVAS_LIT) light(app);
}
