/* Lines to which the frame of Free transform snaps. */
#include "ui/canvas/tools/transform_snap.h"
#include "ui/canvas/overlays/snap_grid.h"
#include "ui/canvas/view.h"
#include "ui/app/state/session_view.h"

#include "command/session.h"
#include "document/document.h"
#include "field/field.h"

#include <math.h>

#define NEARLY_ALL 0.9    /* fraction of an axis that counts as filled */
#define TEXELS_MAX 0x1p26 /* of all layers: more would delay the press of the mouse */

static const WrField *content_of(const WrLayer *layer, bool mask)
{
    return mask ? layer->mask : layer->cover ? layer->cover : layer->heights;
}

WrSelectBox wr_content_box(const WrDocument *document, const bool layers[WR_LAYERS_MAX])
{
    const WrField *fields[WR_LAYERS_MAX], *like = document->layers[0].heights;
    const int w = wr_field_width(like), h = wr_field_height(like);
    int count = 0, chosen = 0;
    for (int i = 0; i < document->layer_count; i++) chosen += layers[i];
    for (int i = 0; i < document->layer_count; i++) {
        const WrLayer *layer = &document->layers[i];
        const bool mask = layer->on_mask && chosen == 1;
        if (layers[i] && (mask || wr_layer_holds(layer))) fields[count++] = content_of(layer, mask);
    }
    WrSelectBox box;
    if (!wr_select_box_all(fields, count, &box)) return (WrSelectBox){ 0, 0, w, h };
    if (box.count_i > NEARLY_ALL * w) box.i = 0, box.count_i = w;
    if (box.count_j > NEARLY_ALL * h) box.j = 0, box.count_j = h;
    return box;
}

void wr_snap_measure(const WrApp *app, const bool moved[WR_LAYERS_MAX], WrSnapOthers *others)
{
    const WrDocument *document = wr_app_document(app);
    const uint64_t revision = wr_session_revision(app->session);
    const double texels = (double)app->view->table_w * app->view->table_h * document->layer_count;
    if (others->measured && others->revision == revision) return;
    *others = (WrSnapOthers){ .measured = true, .revision = revision };
    if (texels > TEXELS_MAX) return;
    for (int i = document->layer_count - 1; i >= 0 && others->count < WR_SNAP_OTHERS; i--) {
        const WrLayer *layer = &document->layers[i];
        if (moved[i] || !wr_layer_holds(layer) || !wr_document_shows(document, i)) continue;
        bool one[WR_LAYERS_MAX] = { false };
        one[i] = true;
        others->box[others->count++] = wr_content_box(document, one);
    }
}

/* Keep the nearer one of a line and its copies in other cells. */
static void offer(double line, double period, double at, double *best)
{
    if (period > 0.0) line += period * rint((at - line) / period);
    if (!(fabs(line - at) >= fabs(*best - at))) *best = line;
}

double wr_snap_line(const WrApp *app, const WrSnapOthers *others, int axis, double at)
{
    static const double parts[] = { 0.0, 1.0 / 4, 1.0 / 3, 1.0 / 2, 2.0 / 3, 3.0 / 4 };
    const double cell = axis ? app->view->table_h : app->view->table_w;
    const double grid = wr_grid_step(app, axis);
    double best = INFINITY;
    if (grid > 0.0) offer(0.0, grid, at, &best);
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        offer(parts[k] * cell, cell, at, &best);
    for (int i = 0; i < others->count; i++) {
        const WrSelectBox *box = &others->box[i];
        const int from = axis ? box->j : box->i, count = axis ? box->count_j : box->count_i;
        for (int k = 0; k <= 2; k++) offer(from + 0.5 * k * count, cell, at, &best);
    }
    return best;
}
