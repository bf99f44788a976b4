#include "ui/panels/layer_drag.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/layer_choice.h"
#include "ui/panels/panel_layers.h"

#include "document/document.h"

#include <math.h>

/* Position of the pointer in rows from the top. */
static double pointer_row(const WrLayerRow *row)
{
    return row->at + (row->row.pointer_y - row->row.top) / row->row.height;
}

/* ---- rows ---- */

double wr_layer_indent(int depth)
{
    return wr_gui_px(12) * depth;
}

/* Update and show the place where the dragged rows would land. */
static void follow_drag(WrApp *app, const WrLayerRow *row)
{
    bool moved[WR_LAYERS_MAX];
    const WrDocument *document = wr_app_document(app);
    const WrLayerBlock block = wr_layer_block(document, wr_layers_of_row(app, row->layer, moved));
    const WrLayerDrop drop = wr_layer_drop(document, row->rows, &block, pointer_row(row));
    const double height = row->row.height, list = row->row.top - height * row->at;
    const int depth = drop.in < 0 ? 0 : document->layers[drop.in].depth + 1;
    app->layers->drop = drop;
    if (drop.to && drop.row >= 0) wr_gui_drop_frame(list + height * drop.row, height);
    if (drop.row < 0) /* also where they are */
        wr_gui_drop_line(wr_layer_indent(depth), list + height * drop.line);
}

bool wr_layer_drag(WrApp *app, const WrLayerRow *row)
{
    WrLayersState *hand = app->layers;
    bool moved[WR_LAYERS_MAX];
    if (row->row.dragging && row->rows->count > 1 && !wr_busy_greys(app)) {
        hand->dragged = row->layer;
        follow_drag(app, row);
        return false;
    }
    if (hand->dragged != row->layer) return false;
    hand->dragged = -1;
    if (!row->row.dropped || !hand->drop.to) return false; /* cancelled, or at its own place */
    wr_layers_move(app, wr_layers_of_row(app, row->layer, moved), &hand->drop);
    return true;
}

bool wr_layer_is_dragged(const WrApp *app, int layer)
{
    bool moved[WR_LAYERS_MAX];
    if (app->layers->dragged < 0) return false;
    wr_layers_of_row(app, app->layers->dragged, moved);
    const WrDocument *document = wr_app_document(app);
    for (; layer >= 0; layer = wr_document_parent(document, layer))
        if (moved[layer]) return true;
    return false;
}

/* ---- eyes ---- */

static bool passed(const WrLayersState *hand, int at)
{
    const int from = hand->eyes_from, to = hand->eyes_to;
    return from >= 0 && at >= (from < to ? from : to) && at <= (from < to ? to : from);
}

static const WrLayer *layer_of(const WrApp *app, const WrLayerRows *rows, int at)
{
    return &wr_app_document(app)->layers[rows->layer[at]];
}

bool wr_layer_eye_shows(const WrApp *app, const WrLayerRow *row)
{
    const WrLayersState *hand = app->layers;
    if (!passed(hand, row->at) || hand->eyes_from >= row->rows->count)
        return layer_of(app, row->rows, row->at)->visible;
    const bool drags = hand->eyes_from != hand->eyes_to;
    return drags != layer_of(app, row->rows, hand->eyes_from)->visible;
}

static bool show(WrApp *app, const bool layers[WR_LAYERS_MAX], bool visible)
{
    return wr_layers_run(app, "set", layers, visible ? "visible=on" : "visible=off");
}

/* The eye is released: the rows that the drag passed become as the first one. */
static bool eyes_done(WrApp *app, const WrLayerRow *row)
{
    bool layers[WR_LAYERS_MAX] = { false };
    WrLayersState *hand = app->layers;
    for (int i = 0; i < row->rows->count; i++) layers[row->rows->layer[i]] = passed(hand, i);
    hand->eyes_from = -1;
    return show(app, layers, !layer_of(app, row->rows, row->at)->visible);
}

bool wr_layer_eye(WrApp *app, const WrLayerRow *row, bool pressed)
{
    bool layers[WR_LAYERS_MAX];
    WrLayersState *hand = app->layers;
    if (wr_gui_held()) {
        const int to = (int)floor(pointer_row(row)), last = row->rows->count - 1;
        if (hand->eyes_from < 0) hand->eyes_from = row->at;
        hand->eyes_to = to < 0 ? 0 : to > last ? last : to;
        if (!wr_gui_escape_pressed()) return false;
        wr_gui_let_go();
        hand->eyes_from = -1;
        return false;
    }
    const bool drags = hand->eyes_from == row->at && hand->eyes_to != row->at;
    if (drags) return eyes_done(app, row);
    if (hand->eyes_from == row->at) hand->eyes_from = -1;
    if (!pressed) return false;
    return show(app, wr_layers_of_row(app, row->layer, layers),
                !layer_of(app, row->rows, row->at)->visible);
}
