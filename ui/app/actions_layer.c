/* Actions of layers and selections: each is one command line. */
#include "ui/app/actions.h"
#include "ui/canvas/outline.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panels.h"

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

/* ---- layers ---- */

void wr_act_layer_add(WrApp *app)
{
    wr_app_run_line(app, "layer add");
}

void wr_act_layer_duplicate(WrApp *app)
{
    wr_app_run_linef(app, "layer duplicate %d", number(app));
}

void wr_act_layer_delete(WrApp *app)
{
    wr_app_run_linef(app, "layer delete %d", number(app));
}

void wr_act_layer_rename(WrApp *app)
{
    wr_layer_rename_start(app, wr_app_document(app)->active);
}

void wr_act_layer_merge(WrApp *app)
{
    char line[48];
    snprintf(line, sizeof line, "layer merge %d", number(app));
    wr_app_run_slow(app, line);
}

void wr_act_layer_flatten(WrApp *app)
{
    wr_app_run_slow(app, "layer flatten");
}

void wr_act_layer_clear(WrApp *app)
{
    wr_app_run_linef(app, "layer clear %d", number(app));
}

void wr_act_layer_solo(WrApp *app)
{
    if (wr_is_solo(app)) wr_app_run_line(app, "layer solo off");
    else wr_app_run_linef(app, "layer solo %d", number(app));
}

void wr_act_layer_raise(WrApp *app)
{
    wr_app_run_linef(app, "layer move %d to=%d", number(app), number(app) + 1);
}

void wr_act_layer_lower(WrApp *app)
{
    wr_app_run_linef(app, "layer move %d to=%d", number(app), number(app) - 1);
}

void wr_act_layer_above(WrApp *app)
{
    if (number(app) < count(app)) wr_app_run_linef(app, "layer use %d", number(app) + 1);
}

void wr_act_layer_below(WrApp *app)
{
    if (number(app) > 1) wr_app_run_linef(app, "layer use %d", number(app) - 1);
}

void wr_act_layer_show(WrApp *app)
{
    wr_app_run_linef(app, "layer set %d visible=%s", number(app),
                     active(app)->visible ? "off" : "on");
}

void wr_act_layer_lock(WrApp *app)
{
    wr_app_run_linef(app, "layer set %d lock=%s", number(app), active(app)->locked ? "off" : "on");
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

void wr_act_filter_edit(WrApp *app)
{
    if (wr_is_generated(app)) wr_generate_edit_layer(app, wr_app_document(app)->active);
    else wr_filter_edit(app);
}

void wr_act_layer_rasterize(WrApp *app)
{
    wr_app_run_linef(app, "layer rasterize %d", number(app));
}

void wr_act_layer_group(WrApp *app)
{
    wr_app_run_linef(app, "layer group of=%d", number(app));
}

void wr_act_layer_ungroup(WrApp *app)
{
    wr_app_run_linef(app, "layer ungroup %d", number(app));
}

bool wr_is_group(const WrApp *app)
{
    return active(app)->is_group;
}

bool wr_can_rasterize(const WrApp *app)
{
    return wr_is_generated(app) || wr_is_group(app);
}

bool wr_is_generated(const WrApp *app)
{
    return active(app)->line != NULL;
}

bool wr_has_values(const WrApp *app)
{
    return is_filter(app) || wr_is_generated(app);
}

bool wr_can_several_layers(const WrApp *app)
{
    return count(app) > 1;
}

bool wr_has_below(const WrApp *app)
{
    return number(app) > 1;
}

bool wr_can_lower(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    return wr_layers_first(document->layers, document->active) > 0;
}

/* Both layers are visible, and the one below, in the same group, is unlocked. */
bool wr_can_merge_down(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = active(app);
    if (layer->is_group) return true;
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

bool wr_has_heights(const WrApp *app)
{
    return wr_layer_holds(active(app));
}

bool wr_can_raise(const WrApp *app)
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

void wr_act_select_all(WrApp *app)
{
    wr_app_run_line(app, "select all");
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
