/* SPDX-License-Identifier: MIT
   The panel on the right: one tab at a time above, the layers below; where there is no room for both,
   the layers are a tab too. What needs many rows takes the layers' place where they leave it only a few. */
#include "ui/accuracy.h"
#include "ui/generate_hand.h"

#include <string.h>

static const struct {
    const char *label;
    void (*draw)(WrApp *app);
    void (*fill)(WrApp *app, SDL_Rect room); /* instead: has areas of its own */
    bool is_long;
} tabs[] = {
    { "Brushes", NULL, wr_panel_brushes, false },  { "Scene", wr_panel_scene, NULL, false },
    { "Plan", wr_panel_plan, NULL, false },        { "History", wr_panel_history, NULL, false },
    { "Generate", NULL, wr_panel_generate, true }, { "Accuracy", wr_panel_accuracy, NULL, true }
};
#define TABS ((int)(sizeof tabs / sizeof *tabs))

int wr_panel_right_tab(const char *label)
{
    for (int i = 0; i < TABS; i++)
        if (strcmp(tabs[i].label, label) == 0) return i;
    return 0;
}

#define LONG_UNITS 400 /* that a long tab needs above the layers */

static SDL_Rect below_head(SDL_Rect room, const char *const *labels, int count, SDL_Rect *head)
{
    *head = room;
    head->h = wr_gui_px(32) * wr_gui_tab_rows(labels, count, room.w);
    room.y += head->h;
    room.h -= head->h;
    return room;
}

static void lower(WrApp *app)
{
    static const char *const labels[] = { "Layers", "Inspector" };
    SDL_Rect head, room = below_head(app->layout.lower, labels, 2, &head);
    WrInspector *inspector = &app->accuracy->inspector;
    int tab = inspector->shown;
    wr_gui_area_begin("##lower_tabs", WR_AREA_BAR, head, WR_COLOUR_BAR);
    wr_gui_tabs("lower", labels, 2, &tab);
    wr_gui_area_end();
    inspector->shown = tab == 1;
    if (!inspector->shown) {
        wr_panel_layers(app, room);
        return;
    }
    wr_gui_area_begin("##inspector", WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    wr_panel_inspector(app);
    wr_gui_area_end();
}

void wr_panel_right(WrApp *app)
{
    const char *labels[TABS + 1];
    app->accuracy->error_open = app->accuracy->plot_open = false;
    if (app->layout.panel.w <= 0) return;
    bool split = app->layout.lower.w > 0;
    int count = split ? TABS : TABS + 1, *tab = &app->settings.tab;
    for (int i = 0; i < TABS; i++) labels[i] = tabs[i].label;
    labels[TABS] = "Layers";
    if (*tab < 0 || *tab >= count) *tab = 0;
    SDL_Rect head, whole = app->layout.panel, low = app->layout.lower;
    bool inspects =
        tabs[*tab < TABS ? *tab : 0].draw == wr_panel_accuracy && app->accuracy->inspector.shown;
    bool covers =
        split && *tab < TABS && tabs[*tab].is_long && !inspects && whole.h < wr_gui_px(LONG_UNITS);
    if (covers) whole.h = low.y + low.h - whole.y;
    SDL_Rect room = below_head(whole, labels, count, &head);
    wr_gui_area_begin("##tabs", WR_AREA_BAR, head, WR_COLOUR_BAR);
    wr_gui_tabs("tabs", labels, count, tab);
    wr_gui_area_end();
    if (split && !covers) lower(app);
    if (room.h <= 0) return;
    if (*tab == TABS) {
        wr_panel_layers(app, room);
        return;
    }
    if (tabs[*tab].fill) {
        tabs[*tab].fill(app, room);
        return;
    }
    wr_gui_area_begin(labels[*tab], WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    tabs[*tab].draw(app);
    wr_gui_area_end();
}
