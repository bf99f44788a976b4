/* Side panel: one tab above, the layers below. Without room for both, the layers are a tab too. A long tab replaces
   the layers if they would leave it only a few rows. Tabs can be torn off into floating panels. */
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
#include "ui/app/state/action_list.h"
#include "ui/canvas/tools/tool.h"

#include "base/memory.h"
#include "base/text.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define LONG_UNITS 320 /* least height of a long tab above the layers */
#define WIDE_UNITS 560 /* width for two columns of sections */
#define TAB_UNITS 32
#define MAX_TABS 16

/* ---- tabs in floating panels ---- */

/* Entry of a tab in the list of floating panels, -1: it is docked; and its place in units. */
static int float_of(const WrApp *app, int tab, SDL_Rect *place)
{
    char *const *floats = app->settings->floats;
    for (int i = 0; i < WR_FLOATS_MAX && floats[i]; i++) {
        SDL_Rect r;
        int label = 0;
        if (sscanf(floats[i], "%d %d %d %d %n", &r.x, &r.y, &r.w, &r.h, &label) < 4 || !label)
            continue;
        if (strcmp(floats[i] + label, app->registry->tabs[tab].label) != 0) continue;
        if (place) *place = r;
        return i;
    }
    return -1;
}

static bool is_docked(const WrApp *app, int tab)
{
    return float_of(app, tab, NULL) < 0;
}

static void set_float(WrApp *app, int entry, int tab, const SDL_Rect *place)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%d %d %d %d %s", place->x, place->y, place->w, place->h,
                 app->registry->tabs[tab].label);
    wr_settings_set_text(&app->settings->floats[entry], wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_tab_tear_off(WrApp *app, int tab, int x, int y)
{
    char **floats = app->settings->floats;
    const double s = wr_gui_scale();
    int entry = 0;
    while (entry < WR_FLOATS_MAX && floats[entry]) entry++;
    if (entry == WR_FLOATS_MAX || !is_docked(app, tab)) return;
    const int wide = app->layout->panel.w > 0 ? app->layout->panel.w : wr_gui_px(300);
    const SDL_Rect place = { (int)(x / s), (int)(y / s), (int)(wide / s), 420 };
    set_float(app, entry, tab, &place);
    wr_app_redraw(app);
}

static void dock(WrApp *app, int tab)
{
    char **floats = app->settings->floats;
    const int entry = float_of(app, tab, NULL);
    wr_free(floats[entry]);
    for (int i = entry; i < WR_FLOATS_MAX; i++)
        floats[i] = i + 1 < WR_FLOATS_MAX ? floats[i + 1] : NULL;
    if (!app->registry->tabs[tab].below) app->settings->tab = tab;
    wr_app_redraw(app);
}

void wr_tabs_dock_all(WrApp *app)
{
    for (int i = 0; i < app->registry->tab_count; i++)
        if (!is_docked(app, i)) dock(app, i);
}

/* ---- content of a tab ---- */

static void column(WrApp *app, const WrTab *tab, const char *name, SDL_Rect room,
                   void (*draw)(WrApp *), void (*more)(WrApp *))
{
    wr_gui_area_begin(name, WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    wr_gui_pinnable(true);
    if (tab->edits) wr_busy_hold(app);
    draw(app);
    if (more) more(app);
    if (tab->edits) wr_busy_hold_end();
    wr_gui_area_end();
    wr_gui_pinnable(false);
}

static void content(WrApp *app, int index, SDL_Rect room)
{
    const WrTab *tab = &app->registry->tabs[index];
    char name[64];
    if (room.h <= 0) return;
    if (tab->fill) {
        tab->fill(app, room);
        return;
    }
    snprintf(name, sizeof name, "%s##tab", tab->label); /* a dialog may have the same name */
    if (!tab->second || room.w < wr_gui_px(WIDE_UNITS)) {
        column(app, tab, name, room, tab->draw, tab->second);
        return;
    }
    SDL_Rect half = { room.x, room.y, room.w / 2, room.h };
    column(app, tab, name, half, tab->draw, NULL);
    half = (SDL_Rect){ room.x + half.w, room.y, room.w - half.w, room.h };
    snprintf(name, sizeof name, "%s##2", tab->label);
    column(app, tab, name, half, tab->second, NULL);
}

/* ---- pinned rows ---- */

static bool has_pins(const WrApp *app)
{
    return app->settings->pins[0] != NULL;
}

static void pinned_of(WrApp *app, const WrTab *tab)
{
    const char *area = tab->draw ? tab->label : tab->rows_area;
    if (!area || !wr_gui_has_pins(area)) return;
    wr_gui_pins_begin(area);
    if (tab->edits) wr_busy_hold(app);
    if (tab->draw) tab->draw(app);
    else tab->rows(app);
    if (tab->second) tab->second(app);
    if (tab->edits) wr_busy_hold_end();
    wr_gui_pins_end();
}

/* Above the tabs, as tall as its rows in the last frame, but at most a third of the panel. */
static void pinned(WrApp *app, SDL_Rect *room)
{
    SDL_Rect area = *room;
    if (!has_pins(app)) return;
    const double most = room->h / 3.0;
    area.h = (int)(app->pins_height < most ? app->pins_height : most);
    if (area.h < wr_gui_px(46)) area.h = wr_gui_px(46);
    room->y += area.h;
    room->h -= area.h;
    wr_gui_area_begin("Pinned", WR_AREA_PANEL, area, WR_COLOUR_PANEL);
    wr_gui_pinnable(true);
    if (wr_gui_fold("PINNED", true))
        for (int i = 0; i < app->registry->tab_count; i++) pinned_of(app, &app->registry->tabs[i]);
    wr_gui_pinnable(false);
    const double height = wr_gui_content_height();
    if (height != app->pins_height) wr_app_redraw(app);
    app->pins_height = height;
    wr_gui_area_end();
}

/* ---- bars of tabs ---- */

typedef struct Bar {
    const char *labels[MAX_TABS];
    int tabs[MAX_TABS]; /* indices in the registry */
    int count;
} Bar;

/* The docked tabs above or below; all of them if there is only one bar. */
static Bar bar_of(const WrApp *app, bool below, bool all)
{
    Bar bar = { .count = 0 };
    for (int i = 0; i < app->registry->tab_count && bar.count < MAX_TABS; i++) {
        const WrTab *tab = &app->registry->tabs[i];
        if ((tab->below != below && !all) || !is_docked(app, i)) continue;
        bar.labels[bar.count] = tab->label;
        bar.tabs[bar.count++] = i;
    }
    return bar;
}

static int place_in(const Bar *bar, int tab)
{
    for (int i = 0; i < bar->count; i++)
        if (bar->tabs[i] == tab) return i;
    return 0;
}

static void tab_menu(WrApp *app, const Bar *bar)
{
    const int pressed = wr_gui_tab_menu();
    if (pressed >= 0) {
        app->tab_menu = bar->tabs[pressed];
        wr_gui_popup_open("tab_menu");
    }
    if (!wr_gui_popup_begin("tab_menu")) return;
    if (wr_gui_menu_item("Float this tab", NULL, false, true))
        wr_tab_tear_off(app, app->tab_menu, app->width / 3, app->height / 4);
    wr_menu_item(app, WR_ACT(side_left));
    wr_menu_item(app, WR_ACT(dock_all));
    wr_gui_popup_end();
}

/* The bar at the top of `room`, which is shortened; true if another tab was chosen. */
static bool show_bar(WrApp *app, const char *name, const Bar *bar, SDL_Rect *room, int *at)
{
    SDL_Rect head = *room;
    head.h = wr_gui_px(TAB_UNITS) * wr_gui_tab_rows(bar->labels, bar->count, room->w);
    room->y += head.h;
    room->h -= head.h;
    wr_gui_area_begin(name, WR_AREA_BAR, head, WR_COLOUR_BAR);
    const bool changed = wr_gui_tabs(name, bar->labels, bar->count, at);
    const int torn = wr_gui_tab_torn();
    if (torn >= 0) {
        wr_tab_tear_off(app, bar->tabs[torn], room->x, room->y);
        app->torn_tab = bar->tabs[torn] + 1;
    }
    tab_menu(app, bar);
    wr_gui_area_end();
    return changed;
}

static void lower(WrApp *app, const Bar *bar)
{
    SDL_Rect room = app->layout->lower;
    const int inspector = wr_tab_find(app, "Inspector");
    int at = app->settings->inspector ? place_in(bar, inspector) : 0;
    if (show_bar(app, "##lower_tabs", bar, &room, &at))
        app->settings->inspector = bar->tabs[at] == inspector;
    content(app, bar->tabs[at], room);
}

static void upper(WrApp *app)
{
    WrSettings *s = app->settings;
    const bool split = app->layout->lower.w > 0;
    const Bar low = bar_of(app, true, false), bar = bar_of(app, false, !split);
    SDL_Rect room = app->layout->panel, below = app->layout->lower;
    int at = place_in(&bar, s->tab);
    const WrTab *tab = bar.count ? &app->registry->tabs[bar.tabs[at]] : NULL;
    const bool inspects = tab && tab->draw == wr_panel_accuracy && s->inspector;
    const bool is_long = tab && tab->is_long && !inspects && room.h < wr_gui_px(LONG_UNITS);
    const bool covers = split && (is_long || low.count == 0);
    if (covers) room.h = below.y + below.h - room.y;
    pinned(app, &room);
    if (bar.count == 0) { /* all of them float */
        wr_gui_area_begin("##no_tabs", WR_AREA_BAR, room, WR_COLOUR_PANEL);
        wr_gui_area_end();
    } else {
        if (show_bar(app, "##tabs", &bar, &room, &at)) s->tab = bar.tabs[at];
        if (!split) s->inspector = bar.tabs[at] == wr_tab_find(app, "Inspector");
    }
    if (split && !covers) lower(app, &low);
    if (bar.count > 0) content(app, bar.tabs[at], room);
}

/* ---- floating panels ---- */

/* Places of the bars, where a floating panel is docked. */
static bool docks_at(const WrApp *app, int tab, SDL_Rect *bar)
{
    const WrLayout *l = app->layout;
    *bar = app->registry->tabs[tab].below && l->lower.w > 0 ? l->lower
           : l->panel.w > 0                                 ? l->panel
                                                            : l->side;
    if (l->panel.w > 0) bar->h = bar->h < wr_gui_px(TAB_UNITS) ? bar->h : wr_gui_px(TAB_UNITS);
    return bar->w > 0;
}

static void floating(WrApp *app, int tab)
{
    const double s = wr_gui_scale();
    const SDL_Rect bounds = { 0, app->menu_height, app->width, app->height - app->menu_height };
    SDL_Rect units, bar;
    const int entry = float_of(app, tab, &units);
    SDL_Rect rect = { (int)lround(units.x * s), (int)lround(units.y * s), (int)lround(units.w * s),
                      (int)lround(units.h * s) };
    const SDL_Rect before = rect;
    const WrFloat f =
        wr_gui_float_begin(app->registry->tabs[tab].label, &rect, bounds, app->torn_tab == tab + 1);
    content(app, tab, f.room);
    wr_gui_float_end();
    if (app->torn_tab == tab + 1) app->torn_tab = 0;
    const bool over = docks_at(app, tab, &bar) && wr_layout_inside(&bar, f.x, f.y);
    if (f.moving && over) wr_gui_drop_place(bar);
    units = (SDL_Rect){ (int)lround(rect.x / s), (int)lround(rect.y / s), (int)lround(rect.w / s),
                        (int)lround(rect.h / s) };
    if (!SDL_RectEquals(&rect, &before)) set_float(app, entry, tab, &units);
    if (f.docks || (f.dropped && over)) dock(app, tab);
}

void wr_panel_right(WrApp *app)
{
    app->accuracy->error_open = app->accuracy->plot_open = false;
    if (app->layout->panel.w > 0) upper(app);
    for (int i = 0; i < app->registry->tab_count && app->settings->panels; i++)
        if (!is_docked(app, i)) floating(app, i);
    if (!is_docked(app, wr_tab_find(app, "Inspector"))) app->settings->inspector = true;
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
