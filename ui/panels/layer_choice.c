#include "ui/panels/layer_choice.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/panel_layers.h"

#include "base/text.h"
#include "command/session.h"

#include <stdio.h>
#include <string.h>

WrChosenLayers *wr_app_chosen(const WrApp *app)
{
    WrChosenLayers *chosen = &app->layers->chosen;
    wr_chosen_follow(chosen, wr_app_document(app), wr_session_last_command(app->session));
    return chosen;
}

bool wr_layer_pick(WrApp *app, int index, WrChoosing how)
{
    char line[32];
    WrChosenLayers *chosen = wr_app_chosen(app);
    const int active = wr_app_document(app)->active;
    const int next = wr_chosen_pick(chosen, active, index, how);
    wr_app_redraw(app);
    if (next == active) return false;
    snprintf(line, sizeof line, "layer use %d", next + 1);
    wr_chosen_expect(chosen, line, chosen->chosen);
    return wr_app_run_line(app, line);
}

void wr_layer_pick_all(WrApp *app)
{
    wr_chosen_range(wr_app_chosen(app), 0, WR_LAYERS_MAX - 1);
    wr_app_redraw(app);
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
    bool next[WR_LAYERS_MAX];
    WrChosenLayers *chosen = wr_app_chosen(app);
    const int end = first + wr_chosen_count(chosen);
    for (int i = 0; i < WR_LAYERS_MAX; i++) next[i] = i >= first && i < end;
    add_line(&line, form, chosen->chosen, rest);
    wr_chosen_expect(chosen, wr_text_get(&line), next);
    const bool ran = wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
    return ran;
}

bool wr_layers_move(WrApp *app, const bool layers[WR_LAYERS_MAX], int to)
{
    char rest[24];
    snprintf(rest, sizeof rest, "to=%d", to);
    if (memcmp(layers, wr_app_chosen(app)->chosen, sizeof(bool[WR_LAYERS_MAX])) == 0)
        return wr_layers_run_to(app, "move", rest, to - 1);
    return wr_layers_run(app, "move", layers, rest);
}
