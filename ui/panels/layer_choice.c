#include "ui/panels/layer_choice.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/panel_layers.h"

#include "base/text.h"
#include "command/session.h"

#include <stdio.h>
#include <string.h>

/* Layers that the list does not show are not chosen by ranges. */
static void drop_unlisted(const WrApp *app, WrChosenLayers *chosen)
{
    const WrLayerRows rows = wr_layer_rows(wr_app_document(app));
    for (int i = 0; i < chosen->count; i++)
        if (rows.layer[wr_layer_rows_find(&rows, i)] != i) chosen->chosen[i] = false;
}

bool wr_layer_pick(WrApp *app, int index, WrChoosing how)
{
    char line[32];
    WrChosenLayers *chosen = wr_app_chosen(app);
    const int active = wr_app_document(app)->active;
    const int next = wr_chosen_pick(chosen, active, index, how);
    if (how == WR_CHOOSE_RANGE) drop_unlisted(app, chosen);
    wr_app_redraw(app);
    if (next == active) return false;
    snprintf(line, sizeof line, "layer use %d", next + 1);
    wr_chosen_expect_active(chosen, next, chosen->chosen);
    return wr_app_run_line(app, line);
}

void wr_layer_pick_all(WrApp *app)
{
    WrChosenLayers *chosen = wr_app_chosen(app);
    wr_chosen_range(chosen, 0, WR_LAYERS_MAX - 1);
    drop_unlisted(app, chosen);
    wr_app_redraw(app);
}

void wr_layer_pick_next(WrApp *app, int way)
{
    const WrLayerRows rows = wr_layer_rows(wr_app_document(app));
    const int row = wr_layer_rows_find(&rows, wr_app_document(app)->active) - way;
    if (row >= 0 && row < rows.count) wr_layer_pick(app, rows.layer[row], WR_CHOOSE_ONLY);
}

const bool *wr_layers_of_row(const WrApp *app, int index, bool out[WR_LAYERS_MAX])
{
    const WrChosenLayers *chosen = wr_app_chosen(app);
    if (chosen->chosen[index]) memcpy(out, chosen->chosen, sizeof chosen->chosen);
    else
        for (int i = 0; i < WR_LAYERS_MAX; i++) out[i] = i == index;
    return out;
}

static void add_line(WrText *line, const char *form, const bool layers[WR_LAYERS_MAX],
                     const char *rest)
{
    wr_text_addf(line, "layer %s ", form);
    wr_layers_print(layers, line);
    if (*rest) wr_text_addf(line, " %s", rest);
}

bool wr_layers_run(WrApp *app, const char *form, const bool layers[WR_LAYERS_MAX], const char *rest)
{
    WrText line = { 0 };
    add_line(&line, form, layers, rest);
    const bool ran = wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
    return ran;
}

bool wr_layers_run_to(WrApp *app, const char *form, const char *rest, int first)
{
    WrText line = { 0 };
    bool next[WR_LAYERS_MAX] = { false };
    WrChosenLayers *chosen = wr_app_chosen(app);
    const WrDocument *document = wr_app_document(app);
    const WrLayerBlock block = wr_layer_block(document, chosen->chosen);
    for (int i = 0; i < block.count; i++) {
        first += wr_layer_block_rows(document, &block, i);
        next[first - 1] = true;
    }
    add_line(&line, form, chosen->chosen, rest);
    wr_chosen_expect(chosen, wr_text_get(&line), next);
    const bool ran = wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
    return ran;
}

bool wr_layers_move(WrApp *app, const bool layers[WR_LAYERS_MAX], const WrLayerDrop *drop)
{
    char rest[48], group[24] = "";
    const WrDocument *document = wr_app_document(app);
    bool groups = false;
    for (int i = 0; i < document->layer_count; i++) groups |= document->layers[i].is_group;
    if (drop->in >= 0) snprintf(group, sizeof group, " in=%d", drop->in + 1);
    else if (groups) snprintf(group, sizeof group, " in=none");
    snprintf(rest, sizeof rest, "to=%d%s", drop->to, group);
    if (memcmp(layers, wr_app_chosen(app)->chosen, sizeof(bool[WR_LAYERS_MAX])) == 0)
        return wr_layers_run_to(app, "move", rest, drop->first);
    return wr_layers_run(app, "move", layers, rest);
}

void wr_layers_step(WrApp *app, int way)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayerRows rows = wr_layer_rows(document);
    const bool *chosen = wr_app_chosen(app)->chosen;
    const WrLayerBlock block = wr_layer_block(document, chosen);
    const WrLayerDrop drop = wr_layer_step(document, &rows, &block, way);
    if (drop.to) wr_layers_move(app, chosen, &drop);
}
