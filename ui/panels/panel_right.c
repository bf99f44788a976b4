/* Right panel: one tab above, the layers below. Without room for both, the layers are a tab too. A long tab replaces
   the layers if they would leave it only a few rows. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panels.h"
#include "ui/app/state/action.h"
#include "ui/canvas/tools/tool.h"

#include <SDL.h>

#define LONG_UNITS 320 /* least height of a long tab above the layers */
#define MAX_TABS 16

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
    SDL_Rect head, room = below_head(app->layout->lower, labels, 2, &head);
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
    const WrTab *tabs = app->registry->tabs;
    const int own = app->registry->tab_count;
    const char *labels[MAX_TABS + 1];
    app->accuracy->error_open = app->accuracy->plot_open = false;
    if (app->layout->panel.w <= 0) return;
    bool split = app->layout->lower.w > 0;
    int count = split ? own : own + 1, *tab = &app->settings->tab;
    for (int i = 0; i < own; i++) labels[i] = tabs[i].label;
    labels[own] = "Layers";
    if (*tab < 0 || *tab >= count) *tab = 0;
    SDL_Rect head, whole = app->layout->panel, low = app->layout->lower;
    bool inspects =
        tabs[*tab < own ? *tab : 0].draw == wr_panel_accuracy && app->accuracy->inspector.shown;
    bool covers =
        split && *tab < own && tabs[*tab].is_long && !inspects && whole.h < wr_gui_px(LONG_UNITS);
    if (covers) whole.h = low.y + low.h - whole.y;
    SDL_Rect room = below_head(whole, labels, count, &head);
    wr_gui_area_begin("##tabs", WR_AREA_BAR, head, WR_COLOUR_BAR);
    wr_gui_tabs("tabs", labels, count, tab);
    wr_gui_area_end();
    if (split && !covers) lower(app);
    if (room.h <= 0) return;
    if (*tab == own) {
        wr_panel_layers(app, room);
        return;
    }
    if (tabs[*tab].fill) {
        tabs[*tab].fill(app, room);
        return;
    }
    wr_gui_area_begin(labels[*tab], WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    if (tabs[*tab].edits) wr_busy_hold(app);
    tabs[*tab].draw(app);
    if (tabs[*tab].edits) wr_busy_hold_end();
    wr_gui_area_end();
}

/* ---- option row below the menu ---- */

/* The current tool and its options. */

void wr_panel_options(WrApp *app)
{
    const WrTool *tool = wr_tool_now(app);
    const WrAction *action = wr_action_find(app, tool->action);
    if (app->layout->options.w <= 0) return;
    wr_gui_area_begin("##options", WR_AREA_BAR, app->layout->options, WR_COLOUR_BAR);
    bool wide = app->width >= wr_gui_px(1060) || !tool->options;
    if (wide) wr_gui_text(WR_FONT_BOLD, WR_COLOUR_STRONG, action->label);
    if (tool->options) {
        tool->options(app);
    } else {
        wr_gui_same_line(14);
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, tool->help);
    }
    wr_gui_area_end();
}
