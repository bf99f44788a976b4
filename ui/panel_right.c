/* SPDX-License-Identifier: MIT
   The panel on the right: one tab at a time above, the layers below; where there is no room for both,
   the layers are a tab too. */
#include "ui/state.h"

#include <string.h>

static const struct {
    const char *label;
    void (*draw)(WrApp *app);
} tabs[] = { { "Brushes", NULL }, /* has areas of its own */
             { "Scene", wr_panel_scene },
             { "Plan", wr_panel_plan },
             { "History", wr_panel_history } };
#define TABS ((int)(sizeof tabs / sizeof *tabs))

static SDL_Rect below_head(SDL_Rect room, SDL_Rect *head)
{
    *head = room;
    head->h = wr_gui_px(32);
    room.y += head->h;
    room.h -= head->h;
    return room;
}

static void lower(WrApp *app)
{
    static const char *const labels[] = { "Layers" };
    SDL_Rect head, room = below_head(app->layout.lower, &head);
    int only = 0;
    wr_gui_area_begin("##lower_tabs", WR_AREA_BAR, head, WR_COLOUR_BAR);
    wr_gui_tabs("lower", labels, 1, &only);
    wr_gui_area_end();
    wr_panel_layers(app, room);
}

void wr_panel_right(WrApp *app)
{
    const char *labels[TABS + 1];
    if (app->layout.panel.w <= 0) return;
    bool split = app->layout.lower.w > 0;
    int count = split ? TABS : TABS + 1, *tab = &app->settings.tab;
    for (int i = 0; i < TABS; i++) labels[i] = tabs[i].label;
    labels[TABS] = "Layers";
    if (*tab < 0 || *tab >= count) *tab = 0;
    SDL_Rect head, room = below_head(app->layout.panel, &head);
    wr_gui_area_begin("##tabs", WR_AREA_BAR, head, WR_COLOUR_BAR);
    wr_gui_tabs("tabs", labels, count, tab);
    wr_gui_area_end();
    if (split) lower(app);
    if (room.h <= 0) return;
    if (*tab == TABS) {
        wr_panel_layers(app, room);
        return;
    }
    if (!tabs[*tab].draw) {
        wr_panel_brushes(app, room);
        return;
    }
    wr_gui_area_begin(labels[*tab], WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    tabs[*tab].draw(app);
    wr_gui_area_end();
}
