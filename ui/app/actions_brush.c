/* Actions of the brush: parameters, modes, presets, symmetry, key maps. */
#include "ui/app/actions.h"
#include "ui/canvas/canvas.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/symmetry.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/app/jobs/files.h"
#include "ui/canvas/tools/stroke_input.h"

#include "brush/brush.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

static void scale_radius(WrApp *app, double factor)
{
    bool stamp = wr_tool_now(app) == &wr_tool_stamp;
    double *radius = stamp ? &app->stamp->radius : &app->settings->brush.radius;
    double old = *radius > 0.0 ? *radius : 48.0, r = old * factor;
    r = r < 10.0 ? rint(r * 10.0) / 10.0 : rint(r);
    if (r == old) r += factor > 1.0 ? 0.1 : -0.1;
    *radius = clamp(r, 0.5, 16384.0);
}

void wr_act_size_up(WrApp *app)
{
    scale_radius(app, 1.15);
}

void wr_act_size_down(WrApp *app)
{
    scale_radius(app, 1.0 / 1.15);
}

static void add_hardness(WrApp *app, double step)
{
    app->settings->brush.hardness =
        clamp(rint((app->settings->brush.hardness + step) * 20.0) / 20.0, 0, 1);
}

void wr_act_hardness_up(WrApp *app)
{
    add_hardness(app, 0.05);
}

void wr_act_hardness_down(WrApp *app)
{
    add_hardness(app, -0.05);
}

/* Steps of two digits: 0.1, 0.12, 0.14, 0.17 ... For modes without strength, opacity in steps of 1/20. */
static void scale_strength(WrApp *app, double factor)
{
    WrBrush *brush = &app->settings->brush;
    if (!(wr_brush_modes[brush->mode].uses & WR_USES_STRENGTH)) {
        double step = factor > 1.0 ? 0.05 : -0.05;
        brush->opacity = clamp(rint((brush->opacity + step) * 20.0) / 20.0, 0.05, 1.0);
        return;
    }
    double *strength = wr_strength_setting(app);
    double s = clamp(*strength * factor, 1e-4, wr_paints_mask(app) ? 1.0 : 1e6);
    double unit = pow(10.0, floor(log10(s)) - 1.0), digits = rint(s / unit);
    /* Division by a power of ten yields the double nearest to the decimal number; a product with 0.01 would not. */
    *strength = unit < 1.0 ? digits / rint(1.0 / unit) : digits * unit;
}

void wr_act_strength_up(WrApp *app)
{
    scale_strength(app, 1.2);
}

void wr_act_strength_down(WrApp *app)
{
    scale_strength(app, 1.0 / 1.2);
}

/* Each of the two modes keeps its own strength once it was changed. */
void wr_act_swap_mode(WrApp *app)
{
    WrBrush *brush = &app->settings->brush;
    double other = app->settings->other_strength, own = brush->strength;
    const bool heights = !wr_paints_mask(app);
    brush->mode = brush->mode == WR_BRUSH_RAISE ? WR_BRUSH_LOWER : WR_BRUSH_RAISE;
    if (heights && other > 0.0) brush->strength = other;
    if (heights) app->settings->other_strength = own;
}

void wr_act_level_mode(WrApp *app)
{
    app->settings->brush.mode = WR_BRUSH_TO;
}

/* Reset mode and strength to the initial values. */
void wr_act_reset_values(WrApp *app)
{
    WrBrush *brush = &app->settings->brush, own = wr_preset_browser_own(app);
    if (!wr_tool_now(app)->mode) brush->mode = own.mode;
    brush->strength = own.strength;
    app->settings->mask_strength = 1.0;
    brush->to = own.to;
    brush->opacity = own.opacity;
    brush->flow = own.flow;
    app->settings->other_strength = 0.0;
    wr_app_say(app, "Mode, strength, height, opacity and flow are reset to the brush's own");
}

/* Change the brush's target height by 1/20 of the displayed range. */
static void move_height(WrApp *app, int steps)
{
    WrBrush *brush = &app->settings->brush;
    if (!(wr_brush_modes[brush->mode].uses & WR_USES_TO)) {
        wr_act_level_mode(app);
    } else {
        double step = fabs(app->range->high - app->range->low) / 20.0;
        double unit = step > 0.0 ? pow(10.0, floor(log10(step))) : 0.01;
        step = fmax(rint(step / unit), 1.0) * unit;
        brush->to = rint((brush->to + steps * step) / unit * 10.0) / (10.0 / unit) + 0.0;
    }
    wr_app_say(app, "Towards the height %.4g", brush->to);
}

void wr_act_target_height_up(WrApp *app)
{
    move_height(app, 1);
}

void wr_act_target_height_down(WrApp *app)
{
    move_height(app, -1);
}

void wr_act_erase_mode(WrApp *app)
{
    WrBrush *brush = &app->settings->brush;
    if (brush->mode == WR_BRUSH_ERASE) {
        brush->mode = app->shelf->before == WR_BRUSH_ERASE ? WR_BRUSH_RAISE : app->shelf->before;
    } else {
        app->shelf->before = brush->mode;
        brush->mode = WR_BRUSH_ERASE;
    }
}

bool wr_is_erase_mode(const WrApp *app)
{
    return app->settings->brush.mode == WR_BRUSH_ERASE;
}

/* ---- presets ---- */

void wr_act_preset_next(WrApp *app)
{
    wr_preset_browser_step(app, 1);
}

void wr_act_preset_previous(WrApp *app)
{
    wr_preset_browser_step(app, -1);
}

void wr_act_favourite(WrApp *app)
{
    const char *id = wr_preset_browser_chosen(app);
    bool liked = wr_settings_find_favourite(app->settings, id) >= 0;
    wr_settings_set_favourite(app->settings, id, !liked);
}

bool wr_is_favourite(const WrApp *app)
{
    return wr_settings_find_favourite(app->settings, wr_preset_browser_chosen(app)) >= 0;
}

void wr_act_round_brush(WrApp *app)
{
    wr_preset_browser_choose(app, WR_ROUND);
}

bool wr_is_round_brush(const WrApp *app)
{
    return app->settings->brush.preset == NULL;
}

void wr_act_lock_size(WrApp *app)
{
    app->settings->lock_size = !app->settings->lock_size;
}

bool wr_is_lock_size(const WrApp *app)
{
    return app->settings->lock_size;
}

void wr_act_brush_curves(WrApp *app)
{
    wr_dialog_dynamics_open(app, -1);
}

void wr_act_preset_save(WrApp *app)
{
    const char *id = wr_preset_browser_chosen(app), *slash = strrchr(id, '/');
    SDL_utf8strlcpy(app->shelf->name, slash ? slash + 1 : "my brush", sizeof app->shelf->name);
    wr_dialog_open(app, WR_DIALOG_PRESET);
}

void wr_act_brushes(WrApp *app)
{
    app->settings->panels = true;
    app->settings->tab = 0;
}

/* ---- symmetry, keys ---- */

void wr_act_symmetry(WrApp *app)
{
    app->settings->symmetry_panel = !app->settings->symmetry_panel;
    if (!app->settings->symmetry_panel || app->settings->symmetric) return;
    app->settings->symmetric = true;
    wr_symmetry_apply(app);
}

bool wr_is_symmetry(const WrApp *app)
{
    return app->settings->symmetry_panel;
}

void wr_act_symmetry_toggle(WrApp *app)
{
    app->settings->symmetric = !app->settings->symmetric;
    wr_symmetry_apply(app);
}

bool wr_is_symmetry_on(const WrApp *app)
{
    return app->settings->symmetric;
}

static void set_keys(WrApp *app, int map)
{
    app->settings->key_map = map;
    wr_app_read_keys(app);
    wr_app_say(app, "%s: %s", wr_key_maps[map].label, wr_key_maps[map].help);
}

void wr_act_keys_paint(WrApp *app)
{
    set_keys(app, WR_KEYS_PAINT);
}

void wr_act_keys_sculpt(WrApp *app)
{
    set_keys(app, WR_KEYS_SCULPT);
}

bool wr_is_keys_paint(const WrApp *app)
{
    return app->settings->key_map == WR_KEYS_PAINT;
}

bool wr_is_keys_sculpt(const WrApp *app)
{
    return app->settings->key_map == WR_KEYS_SCULPT;
}

void wr_act_stamp_open(WrApp *app)
{
    wr_input_router_let_go(app);
    if (!wr_files_request_path(app->files, WR_FILE_STAMP, NULL, ""))
        wr_dialog_open(app, WR_DIALOG_FILE);
}
