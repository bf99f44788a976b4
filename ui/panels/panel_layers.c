/* Layers panel, top layer first. Every change is a command line. */
#include "ui/panels/panel_layers.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/panels/layer_choice.h"
#include "ui/panels/layer_drag.h"
#include "ui/panels/missing_files.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/focus.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/linked_copies.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROW_UNITS 34
#define THUMB_UNITS 26

void wr_panel_layers_forget(WrApp *app)
{
    wr_thumb_list_free(&app->layers->thumbs);
    wr_thumb_list_free(&app->layers->steps);
    wr_chosen_free(app->chosen);
}

/* ---- settings of the chosen layers: the active one's are shown ---- */

static void try_opacity(WrApp *app, int index, double opacity)
{
    const WrLayer *layer = &wr_app_document(app)->layers[index];
    WrEditPreviewRequest ask = {
        .layer = index, .blend = layer->blend, .opacity = (float)opacity, .radius = layer->radius
    };
    memcpy(ask.also, wr_app_chosen(app)->chosen, sizeof ask.also);
    wr_app_try(app, &ask);
}

static void try_radius(WrApp *app, int index, double radius)
{
    const WrLayer *layer = &wr_app_document(app)->layers[index];
    WrEditPreviewRequest ask = {
        .layer = index, .blend = layer->blend, .opacity = layer->opacity, .radius = (float)radius
    };
    wr_app_try(app, &ask);
}

/* text: as " opacity=0.5" */
static void set_chosen(WrApp *app, const char *text)
{
    wr_app_try_end(app);
    wr_layers_run(app, "set", wr_app_chosen(app)->chosen, text + 1);
}

static void set_number(WrApp *app, const char *name, double value)
{
    WrText text = { 0 };
    wr_line_number(&text, name, value);
    set_chosen(app, wr_text_get(&text));
    wr_text_fini(&text);
}

/* True if there was room for a radius. */
static void settings(WrApp *app, int index)
{
    static const WrNumber opacity_spec = { .low = 0,
                                           .high = 100,
                                           .reset = 100,
                                           .decimals = 0,
                                           .unit = "%",
                                           .tip = "Opacity of the layer" };
    static const WrNumber radius_spec = {
        .low = 0,
        .high = 1,
        .hard_low = 0,
        .hard_high = 1e30,
        .reset = 0.1,
        .decimals = 3,
        .tip = "Height difference within which the blend rounds the crease"
    };
    const char *labels[WR_BLEND_COUNT];
    const WrLayer *layer = &wr_app_document(app)->layers[index];
    for (int i = 0; i < WR_BLEND_COUNT; i++) labels[i] = wr_blends[i].label;
    int blend = (int)layer->blend;
    double percent = rint((double)layer->opacity * 1e4) / 100.0, radius = (double)layer->radius;
    wr_gui_label("Blend");
    bool chosen = wr_gui_choice("blend", 0, labels, WR_BLEND_COUNT, &blend);
    wr_gui_tip(wr_blends[layer->blend].help);
    if (chosen) {
        char text[64];
        snprintf(text, sizeof text, " blend=%s", wr_blends[blend].name);
        set_chosen(app, text);
        return;
    }
    wr_gui_label("Opacity");
    WrEdit edit = wr_gui_number("opacity", 0, &opacity_spec, &percent);
    if (edit == WR_EDIT_LIVE) try_opacity(app, index, percent / 100.0);
    if (edit == WR_EDIT_DONE) {
        set_number(app, "opacity", wr_line_round(percent / 100.0, 6));
        return;
    }
    if (!wr_blends[layer->blend].uses_radius) return;
    wr_gui_label("Radius");
    edit = wr_gui_number("radius", 0, &radius_spec, &radius);
    if (edit == WR_EDIT_LIVE) try_radius(app, index, radius);
    if (edit == WR_EDIT_DONE) set_number(app, "radius", wr_line_round(radius, 6));
}

/* ---- rows ---- */

void wr_layer_rename_start(WrApp *app, int index)
{
    WrLayersState *hand = app->layers;
    hand->renamed = index;
    hand->fresh = true;
    SDL_utf8strlcpy(hand->name, wr_app_document(app)->layers[index].name, sizeof hand->name);
    wr_app_redraw(app);
}

static void finish_rename(WrApp *app, bool keep)
{
    WrLayersState *hand = app->layers;
    int index = hand->renamed;
    const WrDocument *document = wr_app_document(app);
    hand->renamed = -1;
    if (!keep || index >= document->layer_count || hand->name[0] == '\0' ||
        strcmp(hand->name, document->layers[index].name) == 0)
        return;
    WrText line = { 0 };
    wr_text_addf(&line, "layer rename %d ", index + 1);
    wr_text_add_word(&line, hand->name);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

static void name_field(WrApp *app, double width)
{
    WrLayersState *hand = app->layers;
    bool first = hand->fresh;
    bool done = wr_gui_text_field("##name", width, hand->name, sizeof hand->name, first);
    bool left = wr_gui_field_left();
    hand->fresh = false;
    if (done) finish_rename(app, true);
    else if (left) finish_rename(app, !wr_gui_escape_pressed());
}

static void describe(const WrLayer *layer, char *text, size_t size)
{
    /* the default of filters */
    const bool plain = layer->filter.op && layer->blend == WR_BLEND_MIX;
    wr_words_print(text, size, "%s %.4g %%",
                   wr_words(plain ? "filter" : wr_blends[layer->blend].name),
                   rint((double)layer->opacity * 1000.0) / 10.0);
}

/* The name, with blend mode and opacity beside it, or below it in a narrow panel. */
static void row_name(const WrLayer *layer, double x, double right, bool shown, bool active)
{
    WrColour ink = !shown ? WR_COLOUR_MUTED : active ? WR_COLOUR_STRONG : WR_COLOUR_TEXT;
    char text[64];
    describe(layer, text, sizeof text);
    double wide = wr_gui_text_width(WR_FONT_SMALL, text), gap = wr_gui_px(6);
    if (right - x - wide - gap >= wr_gui_text_width(WR_FONT_TEXT, layer->name)) {
        wr_gui_row_set_cursor(right - wide, 0);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
        wr_gui_row_set_cursor(x, 0);
        wr_gui_as_it_is(true);
        wr_gui_text(WR_FONT_TEXT, ink, layer->name);
        wr_gui_as_it_is(false);
        return;
    }
    double line = wr_gui_line_height(WR_FONT_TEXT);
    wr_gui_row_set_cursor(x, 2.35 * line);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT, ink, layer->name, right - x);
    wr_gui_as_it_is(false);
    wr_gui_row_set_cursor(x, 0.15 * line);
    const char *share = wide > right - x ? strrchr(text, ' ') : NULL; /* "100 %": its number */
    while (share && share > text && share[-1] != ' ') share--;
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, share ? share : text, right - x);
}

/* Handle a click on a layer's picture: it becomes the target of edits; with Alt, toggle the display of the mask
   alone. */
static bool choose_part(WrApp *app, int i, bool mask)
{
    const WrDocument *document = wr_app_document(app);
    bool alone = mask && (app->hand->mods & WR_MOD_ALT), there = document->active == i;
    if (alone) app->mask_alone = !(there && wr_app_shows_mask(app));
    wr_app_redraw(app);
    if (there && document->layers[i].on_mask == mask) return false;
    return wr_app_run_linef(app, "layer use %d part=%s", i + 1, mask ? "mask" : "heights");
}

static bool row_mask(WrApp *app, int i, bool active, double *x)
{
    const WrLayer *layer = &wr_app_document(app)->layers[i];
    const double side = wr_gui_px(THUMB_UNITS);
    SDL_Texture *picture = wr_thumb_list_get(app, &app->layers->thumbs, 2 * i + 1, layer->mask,
                                             NULL, true, THUMB_UNITS);
    if (wr_gui_image_button("mask", picture, side, side, active && layer->on_mask))
        return choose_part(app, i, true);
    wr_gui_tip(layer->mask_line
                   ? "Its live mask: Alt+click to see it alone; the Layer menu changes its terms"
                   : "Its mask: click to paint on it, Alt+click to see it alone");
    *x += side + wr_gui_px(8);
    return false;
}

/* Open the values of a filter or a generator layer in the next frame, when it is active. */
static void edit_values(WrApp *app, int i)
{
    if (wr_app_document(app)->active != i && !wr_app_run_linef(app, "layer use %d", i + 1)) return;
    wr_action_run(app, WR_ACT(filter_edit));
}

/* The mark of a generator layer. */
static void row_generator(WrApp *app, int i, double *x)
{
    const double side = wr_gui_px(13);
    const char *missing = wr_missing_file(app, i);
    wr_gui_row_set_cursor(*x, side);
    const bool links = wr_line_links(wr_app_document(app)->layers[i].line);
    const char *icon = missing ? WR_ICON_ALERT : links ? WR_ICON_LINK : WR_ICON_TUNE;
    if (wr_gui_glyph("generator", icon, 13, missing ? WR_COLOUR_BAD : WR_COLOUR_CELL)) {
        if (missing) wr_missing_file_locate(app, i);
        else edit_values(app, i);
    }
    if (missing) {
        char tip[300];
        snprintf(tip, sizeof tip, wr_words("Its file %.200s is missing: click to locate it"),
                 missing);
        wr_gui_as_it_is(true);
        wr_gui_tip(tip);
        wr_gui_as_it_is(false);
    } else {
        wr_gui_tip(links ? "A linked copy, which follows its layer. Click to change its settings"
                         : "A generator layer. Click to change its settings");
    }
    *x += side + wr_gui_px(2);
    wr_gui_row_set_cursor(*x, wr_gui_px(THUMB_UNITS));
}

/* True if the list of layers has changed. */
static bool row_group(WrApp *app, int i, double *x)
{
    const WrLayer *group = &wr_app_document(app)->layers[i];
    const double side = wr_gui_px(16), folder = wr_gui_px(22);
    wr_gui_row_set_cursor(*x, side);
    bool pressed = wr_gui_glyph("fold", group->collapsed ? WR_ICON_CLOSED : WR_ICON_OPENED, 16,
                                WR_COLOUR_TEXT);
    wr_gui_tip(group->collapsed ? "Show the layers of this group in the list"
                                : "Hide the layers of this group in the list");
    wr_gui_row_set_cursor(*x + side, folder);
    pressed |= wr_gui_glyph("group", WR_ICON_FOLDER, 22, WR_COLOUR_CELL);
    wr_gui_tip("A group: its layers are composited on their own first");
    *x += side + folder + wr_gui_px(6);
    wr_gui_row_set_cursor(*x, wr_gui_px(THUMB_UNITS));
    return pressed && wr_app_run_linef(app, "layer set %d collapsed=%s", i + 1,
                                       group->collapsed ? "off" : "on");
}

/* Pictures of heights and mask, with a frame around the target of edits. True if a command was run. */
static bool row_pictures(WrApp *app, int i, bool active, double *x)
{
    const WrLayer *layer = &wr_app_document(app)->layers[i];
    double side = wr_gui_px(THUMB_UNITS), gap = wr_gui_px(8);
    wr_gui_row_set_cursor(*x, side);
    if (layer->is_group) {
        if (row_group(app, i, x)) return true;
        if (!layer->mask) return false;
        wr_gui_row_set_cursor(*x, side);
        return row_mask(app, i, active, x);
    }
    if (layer->filter.op) {
        if (wr_gui_glyph("filter", WR_ICON_TUNE, THUMB_UNITS, WR_COLOUR_CELL)) edit_values(app, i);
        wr_gui_tip("A filter layer. Click to change its settings");
        *x += side + gap;
        if (!layer->mask) return false;
        wr_gui_row_set_cursor(*x, side);
        return row_mask(app, i, active, x);
    }
    SDL_Texture *picture = wr_thumb_list_get(app, &app->layers->thumbs, 2 * i, layer->heights,
                                             layer->cover, false, THUMB_UNITS);
    if (layer->line) row_generator(app, i, x);
    if (!layer->mask) {
        wr_gui_image(picture, side, side);
        *x += side + gap;
        return false;
    }
    if (wr_gui_image_button("heights", picture, side, side, active && !layer->on_mask))
        return choose_part(app, i, false);
    wr_gui_tip("The layer's heights: click to edit them");
    *x += side + gap;
    wr_gui_row_set_cursor(*x, side);
    return row_mask(app, i, active, x);
}

static bool row_eye(WrApp *app, const WrLayerRow *row)
{
    const WrDocument *document = wr_app_document(app);
    const bool visible = wr_layer_eye_shows(app, row), alone = document->solo == row->layer;
    const bool same = visible == document->layers[row->layer].visible;
    const bool shown = same ? wr_document_shows(document, row->layer) : visible;
    const bool pressed = wr_gui_glyph("eye", visible ? WR_ICON_EYE : WR_ICON_EYE_OFF, 24,
                                      shown ? WR_COLOUR_TEXT : WR_COLOUR_OFF);
    if (wr_layer_eye(app, row, pressed)) return true;
    wr_gui_tip(alone     ? "Shown alone"
               : visible ? "Hide this layer, or all chosen ones; a drag hides more"
                         : "Show this layer, or all chosen ones; a drag shows more");
    return false;
}

static bool row_lock(WrApp *app, int i)
{
    bool layers[WR_LAYERS_MAX];
    const bool locked = wr_app_document(app)->layers[i].locked;
    if (wr_gui_glyph("lock", locked ? WR_ICON_LOCK : WR_ICON_UNLOCK, 24,
                     locked ? WR_COLOUR_CELL : WR_COLOUR_OFF))
        return wr_layers_run(app, "set", wr_layers_of_row(app, i, layers),
                             locked ? "lock=off" : "lock=on");
    wr_gui_tip(locked ? "Locked: the layer cannot be edited. Click to unlock"
                      : "Click to lock this layer, so that it cannot be edited");
    return false;
}

/* True if a command was run: the list of layers has changed. */
static bool row_parts(WrApp *app, const WrLayerRow *row, bool active)
{
    const WrDocument *document = wr_app_document(app);
    const int i = row->layer;
    const WrLayer *layer = &document->layers[i];
    const bool shown = wr_document_shows(document, i) && !wr_layer_is_dragged(app, i);
    double x = wr_gui_px(8), gap = wr_gui_px(8);
    double right = wr_gui_row_width() - wr_gui_px(34);
    wr_gui_row_set_cursor(x, wr_gui_px(24));
    if (row_eye(app, row)) return true;
    x += wr_gui_px(24) + gap + wr_layer_indent(layer->depth);
    if (row_pictures(app, i, active, &x)) return true;
    wr_gui_row_set_cursor(right, wr_gui_px(24));
    if (row_lock(app, i)) return true;
    if (app->layers->renamed == i) {
        wr_gui_row_set_cursor(x, 0);
        name_field(app, right - x - gap);
        return app->layers->renamed != i;
    }
    row_name(layer, x, right - gap / 2.0, shown, active);
    return false;
}

static bool has_values(const WrLayer *layer)
{
    return layer->filter.op || layer->line;
}

static WrChoosing choosing(int mods)
{
    if (mods & WR_MOD_SHIFT) return WR_CHOOSE_RANGE;
    return mods & WR_MOD_CTRL ? WR_CHOOSE_TOGGLE : WR_CHOOSE_ONLY;
}

/* Clicks on the row, and arrow keys that come to it. True if a command was run. */
static bool row_pressed(WrApp *app, int i, const WrRow *row, bool chosen)
{
    const int mods = app->hand->mods & (WR_MOD_CTRL | WR_MOD_SHIFT);
    if (row->ringed) app->layers->ring = wr_gui_focus_now(app->gui);
    if (row->menu) app->layers->open = true;
    if (row->menu && !chosen) return wr_layer_pick(app, i, WR_CHOOSE_ONLY);
    if (row->reached) return wr_layer_pick(app, i, row->extends ? WR_CHOOSE_RANGE : WR_CHOOSE_ONLY);
    if (row->clicked && wr_layer_pick(app, i, choosing(mods))) return true;
    if (!row->doubled || mods) return false;
    if (has_values(&wr_app_document(app)->layers[i])) edit_values(app, i);
    else if (app->layers->renamed < 0) wr_layer_rename_start(app, i);
    return false;
}

/* Row `at` from the top. True if a command was run. */
static bool row(WrApp *app, const WrLayerRows *rows, int at)
{
    const int i = rows->layer[at];
    const bool active = wr_app_document(app)->active == i, chosen = wr_app_chosen(app)->chosen[i];
    const WrRowLook look = active ? WR_ROW_SELECTED : chosen ? WR_ROW_CHOSEN : WR_ROW_PLAIN;
    const WrLayerRow row = {
        .rows = rows, .at = at, .layer = i, .row = wr_gui_row_begin(i, ROW_UNITS, look)
    };
    const bool changed = row_parts(app, &row, active);
    wr_gui_row_end();
    return changed || wr_layer_drag(app, &row) || row_pressed(app, i, &row.row, chosen);
}

/* ---- context menu of a layer ---- */

/* Actions whose rows name a part of the menu; parts stand in their order. */
static void menu(WrApp *app)
{
    if (app->layers->open) wr_gui_popup_open("layer");
    app->layers->open = false;
    if (!wr_gui_popup_begin("layer")) return;
    const WrAction *actions = app->registry->actions;
    bool more = true;
    for (int part = 1; more; part++) {
        bool any = false;
        more = false;
        for (const WrAction *a = actions; a->name; a++) {
            more |= a->row_menu > part;
            if (a->row_menu != part) continue;
            if (!any && part > 1) wr_gui_menu_separator();
            any = true;
            wr_menu_item(app, a->name);
        }
    }
    wr_gui_popup_end();
}

/* ---- painting on a generator layer or a live mask ---- */

bool wr_rasterize_ask(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    if (!(layer->on_mask ? layer->mask_line : layer->line) || layer->locked ||
        !wr_document_shows(document, document->active))
        return false;
    wr_dialog_open(app, WR_DIALOG_RASTERIZE);
    return true;
}

void wr_dialog_rasterize(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    char text[WR_LAYER_NAME_MAX + 300];
    const bool mask = layer->on_mask;
    if (!(mask ? layer->mask_line : layer->line)) {
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin(mask ? "Rasterize this mask?" : "Rasterize this layer?", 440)) return;
    snprintf(text, sizeof text,
             mask ? wr_words("The mask of %s follows the layers below. Once rasterized, it can be "
                             "painted on, but no longer follows them. To keep both, add the "
                             "painted mask of a layer below as another term.")
                  : wr_words("The heights of %s come from a generator. Once rasterized, they can "
                             "be painted on, but the generator's values can no longer be changed. "
                             "To keep them, use a mask or a new layer above."),
             layer->name);
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, text);
    wr_gui_space(8);
    const int done = wr_dialog_buttons(app, "Rasterize", true);
    if (done) wr_dialog_close(app);
    if (done > 0 && mask) wr_app_run_linef(app, "layer mask %d live=off", document->active + 1);
    else if (done > 0) wr_action_run(app, WR_ACT(layer_rasterize));
    wr_gui_dialog_end();
}

/* ---- the panel ---- */

static void list(WrApp *app)
{
    wr_gui_space(-12); /* rows start at the panel's edge */
    const WrLayerRows rows = wr_layer_rows(wr_app_document(app));
    for (int i = 0; i < rows.count; i++)
        if (row(app, &rows, i)) break; /* the rest follows in the next frame */
    menu(app);
}

static void filter_button(WrApp *app)
{
    wr_gui_same_line(8);
    if (wr_gui_glyph("filters", WR_ICON_TUNE, 24, WR_COLOUR_TEXT)) wr_gui_popup_open("filters");
    wr_gui_tip("Add a filter layer: an operation on the layers below");
    if (!wr_gui_popup_begin("filters")) return;
    wr_menu_filters(app);
    wr_gui_popup_end();
}

static void foot(WrApp *app)
{
    static const struct {
        const char *action, *icon;
    } buttons[] = {
        { WR_ACT(layer_add), WR_ICON_PLUS },       { NULL, WR_ICON_TUNE },
        { WR_ACT(layer_duplicate), WR_ICON_COPY }, { WR_ACT(layer_delete), WR_ICON_DELETE },
        { WR_ACT(layer_merge), WR_ICON_MERGE },    { WR_ACT(layer_raise), WR_ICON_RAISE },
        { WR_ACT(layer_lower), WR_ICON_LOWER }
    };
    for (size_t i = 0; i < sizeof buttons / sizeof *buttons; i++) {
        if (!buttons[i].action) {
            filter_button(app);
            continue;
        }
        const WrAction *action = wr_action_find(app, buttons[i].action);
        bool enabled = wr_action_can(app, action);
        char keys[32], tip[WR_ACTION_LABEL + 40], label[WR_ACTION_LABEL];
        if (i) wr_gui_same_line(8);
        wr_gui_disable(!enabled);
        if (wr_gui_glyph(buttons[i].action, buttons[i].icon, 24,
                         enabled ? WR_COLOUR_TEXT : WR_COLOUR_OFF))
            wr_action_run(app, buttons[i].action);
        wr_gui_disable_end();
        snprintf(tip, sizeof tip, "%s   %s", wr_menu_label(app, action, label),
                 wr_keys_label(app->keys, buttons[i].action, keys));
        wr_gui_tip(tip);
    }
}

void wr_panel_layers(WrApp *app, SDL_Rect room)
{
    const WrDocument *document = wr_app_document(app);
    int active = document->active;
    bool smooth = wr_blends[document->layers[active].blend].uses_radius;
    SDL_Rect head = room, middle = room, bottom = room;
    double line = wr_gui_line_height(WR_FONT_TEXT) + wr_gui_px(12);
    const bool variants = wr_variant_count(document) > 0;
    head.h = wr_gui_px(20) + (int)(line * ((smooth ? 3 : 2) + variants));
    bottom.h = wr_gui_px(38);
    bottom.y = room.y + room.h - bottom.h;
    middle.y = room.y + head.h;
    middle.h = bottom.y - middle.y;
    wr_gui_area_begin("##layer_settings", WR_AREA_PANEL, head, WR_COLOUR_PANEL);
    wr_busy_hold(app);
    if (variants) wr_panel_variants(app);
    if (active < wr_app_document(app)->layer_count) settings(app, active);
    wr_busy_hold_end();
    wr_gui_area_end();
    if (middle.h > 0) {
        wr_gui_area_begin("##layers", WR_AREA_PANEL, middle, WR_COLOUR_LIST);
        list(app);
        wr_gui_area_end();
    }
    wr_gui_area_begin("##layer_buttons", WR_AREA_BAR, bottom, WR_COLOUR_BAR);
    foot(app);
    wr_gui_area_end();
}

static void another(WrApp *app)
{
    WrLayersState *hand = app->layers;
    hand->dragged = hand->renamed = hand->eyes_from = -1;
    wr_chosen_free(app->chosen);
    app->chosen->count = 0;
}

const WrPart wr_part_layers = { .another = another, .forget = wr_panel_layers_forget };
