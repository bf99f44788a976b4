/* Actions of layers and selections: each is one command line. */
#include "ui/app/actions.h"
#include "ui/canvas/outline.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/layer_choice.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/focus.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "command/linked_copies.h"
#include "document/document.h"
#include "field/field.h"

#include <stdio.h>

/* Number of the active layer in command lines. */
static int number(const WrApp *app)
{
    return wr_app_document(app)->active + 1;
}

static const WrLayer *active(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    return &document->layers[document->active];
}

static int count(const WrApp *app)
{
    return wr_app_document(app)->layer_count;
}

/* ---- layers: the chosen ones change together ---- */

static bool all(const WrLayer *layer)
{
    (void)layer;
    return true;
}

static bool generated(const WrLayer *layer)
{
    return layer->line != NULL;
}

static bool grouping(const WrLayer *layer)
{
    return layer->is_group;
}

static bool can_rasterize(const WrLayer *layer)
{
    return generated(layer) || grouping(layer);
}

/* The chosen layers that the action fits; returns their number. */
static int chosen_of(const WrApp *app, bool (*fits)(const WrLayer *), bool out[WR_LAYERS_MAX])
{
    const WrChosenLayers *chosen = wr_app_chosen(app);
    int n = 0;
    for (int i = 0; i < WR_LAYERS_MAX; i++) {
        out[i] = i < count(app) && chosen->chosen[i] && fits(&wr_app_document(app)->layers[i]);
        n += out[i];
    }
    return n;
}

static void run_chosen(WrApp *app, const char *form, bool (*fits)(const WrLayer *),
                       const char *rest)
{
    bool layers[WR_LAYERS_MAX];
    if (chosen_of(app, fits, layers)) wr_layers_run(app, form, layers, rest);
}

static int chosen_count(const WrApp *app)
{
    return wr_chosen_count(wr_app_chosen(app));
}

void wr_act_layer_add(WrApp *app)
{
    wr_app_run_line(app, "layer add");
}

void wr_act_layer_duplicate(WrApp *app)
{
    wr_layers_run_to(app, "duplicate", "", wr_chosen_highest(wr_app_chosen(app)) + 1);
}

void wr_act_layer_link(WrApp *app)
{
    wr_app_run_linef(app, "layer duplicate %d linked=on", number(app));
}

void wr_act_layer_delete(WrApp *app)
{
    run_chosen(app, "delete", all, "");
}

void wr_act_layer_rename(WrApp *app)
{
    wr_layer_rename_start(app, wr_app_document(app)->active);
}

void wr_act_layer_merge(WrApp *app)
{
    WrText line = { 0 };
    wr_text_add(&line, "layer merge ");
    wr_layers_print(wr_app_chosen(app)->chosen, &line);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_act_layer_flatten(WrApp *app)
{
    wr_app_run_slow(app, "layer flatten");
}

void wr_act_layer_clear(WrApp *app)
{
    run_chosen(app, "clear", wr_layer_holds, "");
}

void wr_act_layer_solo(WrApp *app)
{
    if (wr_is_solo(app)) wr_app_run_line(app, "layer solo off");
    else wr_app_run_linef(app, "layer solo %d", number(app));
}

void wr_act_layer_raise(WrApp *app)
{
    wr_layers_step(app, 1);
}

void wr_act_layer_lower(WrApp *app)
{
    wr_layers_step(app, -1);
}

void wr_act_layer_above(WrApp *app)
{
    wr_layer_pick_next(app, 1);
}

void wr_act_layer_below(WrApp *app)
{
    wr_layer_pick_next(app, -1);
}

void wr_act_layer_show(WrApp *app)
{
    run_chosen(app, "set", all, active(app)->visible ? "visible=off" : "visible=on");
}

void wr_act_layer_lock(WrApp *app)
{
    run_chosen(app, "set", all, active(app)->locked ? "lock=off" : "lock=on");
}

void wr_act_layer_choose_all(WrApp *app)
{
    wr_layer_pick_all(app);
}

/* ---- masks ---- */

static void mask_from(WrApp *app, const char *what)
{
    wr_app_run_linef(app, "layer mask %d from=%s", number(app), what);
}

void wr_act_mask_selection(WrApp *app)
{
    mask_from(app, "selection");
}

void wr_act_mask_white(WrApp *app)
{
    mask_from(app, "white");
}

void wr_act_mask_black(WrApp *app)
{
    mask_from(app, "black");
}

void wr_act_mask_none(WrApp *app)
{
    mask_from(app, "none");
}

void wr_act_mask_height(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_HEIGHT);
    app->selecting->to_mask = true;
}

void wr_act_mask_slope(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_SLOPE);
    app->selecting->to_mask = true;
}

void wr_act_mask_live(WrApp *app)
{
    if (active(app)->mask_line ||
        wr_app_run_linef(app, "layer mask %d live=curvature", number(app)))
        wr_dialog_open(app, WR_DIALOG_MASK);
}

bool wr_can_mask_live(const WrApp *app)
{
    return number(app) > 1;
}

void wr_act_mask_invert(WrApp *app)
{
    mask_from(app, "inverse");
}

void wr_act_mask_edit(WrApp *app)
{
    wr_app_run_linef(app, "layer use %d part=%s", number(app),
                     active(app)->on_mask ? "heights" : "mask");
}

void wr_act_mask_alone(WrApp *app)
{
    bool alone = !wr_app_shows_mask(app);
    if (alone && !active(app)->on_mask) wr_act_mask_edit(app);
    app->mask_alone = alone;
    wr_app_redraw(app);
}

void wr_act_select_mask(WrApp *app)
{
    wr_app_run_linef(app, "select mask %d", number(app));
}

/* ---- availability ---- */

static bool is_filter(const WrApp *app)
{
    return active(app)->filter.op != NULL;
}

/* The line of a shape or a ramp has no sliders: it is changed as text. */
static bool is_edited_as_text(const char *line)
{
    WrCall *call = NULL;
    const bool known = line && wr_call_parse(line, false, &call, NULL);
    const bool text = known && !wr_line_links(line) && !wr_call_generator(call);
    wr_call_free(call);
    return text;
}

static void edit_as_text(WrApp *app)
{
    WrText line = { 0 };
    wr_text_addf(&line, "layer set %d from=", number(app));
    wr_text_add_word(&line, active(app)->line);
    wr_search_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_act_filter_edit(WrApp *app)
{
    if (is_edited_as_text(active(app)->line)) edit_as_text(app);
    else if (wr_line_links(active(app)->line)) wr_dialog_open(app, WR_DIALOG_LINK);
    else if (generated(active(app))) wr_generate_edit_layer(app, wr_app_document(app)->active);
    else wr_filter_edit(app);
}

void wr_act_layer_rasterize(WrApp *app)
{
    run_chosen(app, "rasterize", can_rasterize, "");
}

bool wr_can_rasterize(const WrApp *app)
{
    bool layers[WR_LAYERS_MAX];
    return chosen_of(app, can_rasterize, layers) > 0;
}

void wr_act_layer_group(WrApp *app)
{
    WrText line = { 0 };
    wr_text_add(&line, "layer group of=");
    wr_layers_print(wr_app_chosen(app)->chosen, &line);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_act_layer_ungroup(WrApp *app)
{
    run_chosen(app, "ungroup", grouping, "");
}

bool wr_can_ungroup(const WrApp *app)
{
    bool layers[WR_LAYERS_MAX];
    return chosen_of(app, grouping, layers) > 0;
}

bool wr_has_values(const WrApp *app)
{
    return is_filter(app) || generated(active(app));
}

bool wr_can_several_layers(const WrApp *app)
{
    return count(app) > 1;
}

bool wr_can_delete(const WrApp *app)
{
    const WrLayerBlock block = wr_layer_block(wr_app_document(app), wr_app_chosen(app)->chosen);
    return count(app) > block.rows;
}

bool wr_can_lower(const WrApp *app)
{
    const WrLayerBlock block = wr_layer_block(wr_app_document(app), wr_app_chosen(app)->chosen);
    return block.lowest > 0;
}

bool wr_has_below(const WrApp *app)
{
    return number(app) > 1;
}

/* One layer: it and the one below in its group are visible, and that one is unlocked. Of several, the command reports the reason if they cannot. */
bool wr_can_merge(const WrApp *app)
{
    const WrLayer *layer = active(app);
    const WrDocument *document = wr_app_document(app);
    if (chosen_count(app) > 1 || layer->is_group) return true;
    if (wr_layers_first_sibling(document->layers, document->active) == document->active)
        return false;
    return layer->visible && layer[-1].visible && !layer[-1].locked;
}

bool wr_can_change_all(const WrApp *app)
{
    for (int i = 0; i < count(app); i++)
        if (wr_app_document(app)->layers[i].locked) return false;
    return true;
}

bool wr_can_flatten(const WrApp *app)
{
    return wr_can_several_layers(app) && wr_can_change_all(app);
}

bool wr_can_link(const WrApp *app)
{
    return !active(app)->filter.op;
}

bool wr_has_heights(const WrApp *app)
{
    return wr_layer_holds(active(app));
}

bool wr_can_clear(const WrApp *app)
{
    bool layers[WR_LAYERS_MAX];
    return chosen_of(app, wr_layer_holds, layers) > 0;
}

bool wr_can_raise(const WrApp *app)
{
    return wr_chosen_highest(wr_app_chosen(app)) + 1 < count(app);
}

bool wr_has_above(const WrApp *app)
{
    return number(app) < count(app);
}

bool wr_can_mask_selection(const WrApp *app)
{
    return wr_app_document(app)->selection != NULL;
}

bool wr_has_mask(const WrApp *app)
{
    return active(app)->mask != NULL;
}

bool wr_is_mask_edited(const WrApp *app)
{
    return active(app)->on_mask;
}

bool wr_is_solo(const WrApp *app)
{
    return wr_app_document(app)->solo == wr_app_document(app)->active;
}

bool wr_is_layer_shown(const WrApp *app)
{
    return active(app)->visible;
}

bool wr_is_layer_locked(const WrApp *app)
{
    return active(app)->locked;
}

/* ---- selections ---- */

/* While the keys belong to a row of the layers' list, they choose layers. */
void wr_act_select_all(WrApp *app)
{
    const unsigned ring = wr_gui_focus_now(app->gui);
    if (ring && ring == app->layers->ring) wr_layer_pick_all(app);
    else wr_app_run_line(app, "select all");
}

void wr_act_select_none(WrApp *app)
{
    wr_app_run_line(app, "select none");
}

void wr_act_select_invert(WrApp *app)
{
    wr_app_run_line(app, "select invert");
}

void wr_act_select_grow(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_GROW);
}

void wr_act_select_shrink(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_SHRINK);
}

void wr_act_select_feather(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_FEATHER);
}

void wr_act_select_height(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_HEIGHT);
}

void wr_act_select_slope(WrApp *app)
{
    wr_dialog_select_open(app, WR_OUTLINE_SLOPE);
}

/* ---- the table ---- */

void wr_act_offset_half(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    char line[96];
    snprintf(line, sizeof line, "adjust offset du=%d dv=%d%s", wr_field_width(field) / 2,
             wr_field_height(field) / 2, count(app) > 1 ? " layers=all" : "");
    wr_app_run_slow(app, line);
}
