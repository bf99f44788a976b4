/* SPDX-License-Identifier: MIT
   The panel on the right: one tab at a time. */
#include "ui/state.h"

#include <string.h>

static const struct {
    const char *label;
    void (*draw)(WrApp *app);
} tabs[] = { { "Scene", wr_panel_scene },
             { "Plan", wr_panel_plan },
             { "History", wr_panel_history } };
#define TABS ((int)(sizeof tabs / sizeof *tabs))

void wr_panel_right(WrApp *app)
{
    const char *labels[TABS];
    if (app->layout.panel.w <= 0) return;
    for (int i = 0; i < TABS; i++) labels[i] = tabs[i].label;
    if (app->settings.tab < 0 || app->settings.tab >= TABS) app->settings.tab = 0;
    SDL_Rect room = app->layout.panel, head = room;
    head.h = wr_gui_px(32);
    room.y += head.h;
    room.h -= head.h;
    wr_gui_area_begin("##tabs", WR_AREA_BAR, head, WR_COLOUR_BAR);
    wr_gui_tabs("tabs", labels, TABS, &app->settings.tab);
    wr_gui_area_end();
    if (room.h <= 0) return;
    wr_gui_area_begin(labels[app->settings.tab], WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    tabs[app->settings.tab].draw(app);
    wr_gui_area_end();
}

void wr_panel_history(WrApp *app)
{
    int count = wr_session_history_count(app->session);
    wr_gui_heading("WHAT WAS DONE");
    wr_gui_space(2);
    if (count == 0) {
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            "Nothing yet. Every change is one line of text here, as a script would "
                            "have it.");
        return;
    }
    int first = count > 300 ? count - 300 : 0;
    for (int i = count - 1; i >= first; i--) { /* newest on top */
        char line[120];
        const char *full = wr_session_history_line(app->session, i);
        snprintf(line, sizeof line, "%.96s%s", full, strlen(full) > 96 ? " ..." : "");
        wr_gui_push_id(i);
        wr_gui_text_wrapped(WR_FONT_SMALL, i == count - 1 ? WR_COLOUR_STRONG : WR_COLOUR_LABEL,
                            line);
        wr_gui_pop_id();
    }
}
