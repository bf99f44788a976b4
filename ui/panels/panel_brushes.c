/* The Brushes tab: brushes, stamps, presets of generators and cells as pictures, by group, with a search. Below the brushes
   are the brush parameters; without room for both, one of them at a time. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"
#include "ui/panels/stock.h"
#include "ui/canvas/view.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/canvas/tools/preset_browser.h"

#include "brush/preset.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TILE_UNITS 56
#define PICTURE_UNITS 80 /* of the other lists */
#define LARGE_UNITS 120
#define BOTH_UNITS 460  /* least height for showing both parts */
#define KINDS_UNITS 262 /* least width for buttons of the four lists */
#define GROUPS_MAX 64
#define FIXED_GROUPS 3    /* all, favourites, recently used */
#define CHECK_SECONDS 2.0 /* between two looks into the user's folder */

/* ---- filter ---- */

typedef struct Groups {
    const char *labels[GROUPS_MAX];
    char texts[GROUPS_MAX][96];
    int count;
} Groups;

static bool same(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

static const WrStockList *list_now(const WrApp *app)
{
    return &wr_stock[app->shelf->kind];
}

static void add_group(Groups *g, const char *group)
{
    for (int i = FIXED_GROUPS; i < g->count; i++)
        if (same(g->texts[i], group)) return;
    if (g->count >= GROUPS_MAX || !group[0]) return;
    snprintf(g->texts[g->count], sizeof g->texts[0], "%s", group);
    g->labels[g->count] = g->texts[g->count];
    g->count++;
}

static void find_groups(WrApp *app, Groups *g)
{
    const WrStockList *list = list_now(app);
    g->labels[0] = "All";
    g->labels[1] = "Favourites";
    g->labels[2] = "Used last";
    g->count = FIXED_GROUPS;
    for (int i = 0, count = list->count(app); i < count; i++) {
        WrStockItem item = { "", "", "", "" };
        list->item(app, i, &item);
        add_group(g, item.group);
    }
}

static bool belongs(const WrApp *app, const Groups *g, const WrStockItem *item)
{
    int group = app->shelf->group[app->shelf->kind];
    if (app->shelf->search[0]) {
        char text[700];
        snprintf(text, sizeof text, "%s %s %s", item->name, item->group, item->words);
        for (char *c = text; *c; c++)
            if (*c == '_' || *c == '-' || *c == '/') *c = ' ';
        return wr_search_score(text, app->shelf->search) > 0;
    }
    if (group == 0) return true;
    if (group == 1) return wr_settings_find_favourite(app->settings, item->id) >= 0;
    return group >= FIXED_GROUPS && group < g->count && same(g->texts[group], item->group);
}

/* The index of an id in the list; -1: it is gone. */
static int find(WrApp *app, const char *id)
{
    const WrStockList *list = list_now(app);
    for (int i = 0, count = list->count(app); i < count; i++) {
        WrStockItem item = { "", "", "", "" };
        list->item(app, i, &item);
        if (same(item.id, id)) return i;
    }
    return -1;
}

/* ---- context menu of an entry ---- */

static void entry_menu(WrApp *app)
{
    WrPresetBrowser *shelf = app->shelf;
    const WrStockList *list = list_now(app);
    char id[sizeof shelf->pressed];
    if (!wr_gui_popup_begin("preset")) return;
    memcpy(id, shelf->pressed, sizeof id);
    int index = find(app, id);
    bool liked = wr_settings_find_favourite(app->settings, id) >= 0;
    if (wr_gui_menu_item(liked ? "No favourite any more" : "Favourite", NULL, liked, true))
        wr_settings_set_favourite(app->settings, id, !liked);
    if (wr_gui_menu_item("Choose", NULL, false, index >= 0)) list->choose(app, index);
    if (list->remove && wr_gui_menu_item("Delete", NULL, false, index >= 0) &&
        !list->remove(app, index))
        wr_app_say(app, "Only presets of your own can be deleted");
    wr_gui_popup_end();
}

/* ---- tiles ---- */

typedef struct Flow { /* layout of tiles in rows */
    double side;
    int columns, count;
    bool held; /* the pointer holds the dragged tile */
} Flow;

static void next_place(Flow *flow)
{
    if (flow->count % flow->columns) wr_gui_same_line(4);
    else if (flow->count > 0) wr_gui_space(-4);
    flow->count++;
}

static void tile_tip(const WrStockList *list, const WrStockItem *item)
{
    char tip[400];
    const char *help = list->drop_help ? wr_words(list->drop_help) : NULL;
    snprintf(tip, sizeof tip, "%s%s%s%s%.150s", item->name, item->group[0] ? "\n" : "", item->group,
             help ? "\n" : "", help ? help : "");
    wr_gui_as_it_is(true);
    wr_gui_tip(tip);
    wr_gui_as_it_is(false);
}

static void tile(WrApp *app, Flow *flow, int index, const WrStockItem *item)
{
    WrPresetBrowser *shelf = app->shelf;
    const WrStockList *list = list_now(app);
    bool liked = wr_settings_find_favourite(app->settings, item->id) >= 0;
    next_place(flow);
    wr_gui_push_id(index + 1);
    SDL_Texture *picture =
        wr_gui_will_see(flow->side) ? list->picture(app, index, (int)flow->side) : NULL;
    int pressed =
        wr_gui_tile("tile", picture, flow->side, list->chosen && list->chosen(app, index), liked);
    if (wr_gui_held()) {
        shelf->dragged = index + 1;
        flow->held = true;
    }
    tile_tip(list, item);
    wr_gui_pop_id();
    if (pressed == 1) list->choose(app, index);
    if (pressed != 2) return;
    snprintf(shelf->pressed, sizeof shelf->pressed, "%.250s", item->id);
    wr_gui_popup_open("preset");
}

/* Brushes only: the other lists note no uses. */
static void used_last(WrApp *app, Flow *flow)
{
    for (int i = 0; i < WR_USED_MAX && app->settings->used[i]; i++) {
        WrStockItem item = { "", "", "", "" };
        int index = find(app, app->settings->used[i]);
        if (index < 0) continue;
        list_now(app)->item(app, index, &item);
        tile(app, flow, index, &item);
    }
}

/* A held tile follows the pointer; over the canvas it shows its effect, and a release there applies it. */
static void carry(WrApp *app, const Flow *flow)
{
    WrPresetBrowser *shelf = app->shelf;
    const WrStockList *list = list_now(app);
    double x, y, u, v;
    int index = shelf->dragged - 1;
    if (index < 0) return;
    wr_gui_carry(NULL, 0, &x, &y);
    bool over = wr_layout_inside(&app->layout->canvas, (int)x, (int)y);
    wr_view_to_uv(app->view, x, y, &u, &v);
    const bool cancelled = wr_gui_escape_pressed();
    if (cancelled) wr_gui_let_go();
    const bool held = flow->held && !cancelled;
    if (held && !(over && list->hover))
        wr_gui_carry(list->picture(app, index, (int)flow->side), flow->side, &x, &y);
    if (list->hover && (over || !held)) list->hover(app, index, u, v, over && held);
    if (held) return;
    shelf->dragged = 0;
    if (over && !cancelled) list->drop(app, index, u, v);
}

static void tiles(WrApp *app, const Groups *groups)
{
    const WrPresetBrowser *shelf = app->shelf;
    const WrStockList *list = list_now(app);
    double gap = wr_gui_px(4), room = wr_gui_available() + gap;
    double units = shelf->large                      ? LARGE_UNITS
                   : shelf->kind == WR_STOCK_BRUSHES ? TILE_UNITS
                                                     : PICTURE_UNITS;
    Flow flow = { .columns = (int)(room / (wr_gui_px(units) + gap) + 0.5) };
    flow.columns = flow.columns > 0 ? flow.columns : 1;
    flow.side = floor(room / flow.columns - gap); /* tiles are enlarged to fill the row */
    if (shelf->group[shelf->kind] == 2 && !shelf->search[0]) {
        used_last(app, &flow);
    } else {
        const int count = list->count(app);
        for (int i = 0; i < count && i < list->count(app); i++) {
            WrStockItem item = { "", "", "", "" };
            list->item(app, i, &item);
            if (belongs(app, groups, &item)) tile(app, &flow, i, &item);
        }
    }
    if (flow.count == 0)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            shelf->search[0] ? "Nothing matches these words."
                                             : "No favourites yet: right-click a brush to add it.");
    carry(app, &flow);
    entry_menu(app);
}

/* ---- the tab ---- */

static void head(WrApp *app, const Groups *groups, bool both)
{
    static const char *const parts[] = { "Presets", "This brush" };
    const char *kinds[WR_STOCK_KINDS];
    WrPresetBrowser *shelf = app->shelf;
    const int before = shelf->kind;
    for (int i = 0; i < WR_STOCK_KINDS; i++) kinds[i] = wr_stock[i].label;
    if (wr_gui_available() < wr_gui_px(KINDS_UNITS))
        wr_gui_choice("kind", 0, kinds, WR_STOCK_KINDS, &shelf->kind);
    else wr_gui_segments("kind", kinds, NULL, WR_STOCK_KINDS, &shelf->kind);
    if (shelf->kind != before) return; /* the groups are those of the previous list */
    if (!both && shelf->kind == WR_STOCK_BRUSHES) {
        wr_gui_segments("part", parts, NULL, 2, &shelf->part);
        if (shelf->part == 1) return;
    }
    int *group = &shelf->group[shelf->kind];
    double half = (wr_gui_available() - wr_gui_px(30)) / 2.0 - wr_gui_px(3);
    if (*group >= groups->count) *group = 0;
    wr_gui_hint_field("##search", list_now(app)->hint, half, shelf->search, sizeof shelf->search);
    wr_gui_same_line(6);
    wr_gui_disable(shelf->search[0] != '\0');
    wr_gui_choice("group", half, groups->labels, groups->count, group);
    wr_gui_disable_end();
    wr_gui_same_line(6);
    if (wr_gui_icon_button("large", WR_ICON_GRID, 24, shelf->large)) shelf->large = !shelf->large;
    wr_gui_tip("Large pictures");
}

static SDL_Rect cut_top(SDL_Rect *room, int height)
{
    SDL_Rect top = *room;
    top.h = height < room->h ? height : room->h;
    room->y += top.h;
    room->h -= top.h;
    return top;
}

/* Below the pictures: the current brush and its actions. */
static void foot(WrApp *app)
{
    const char *id = wr_preset_browser_chosen(app), *slash = strchr(id, '/');
    bool liked = wr_settings_find_favourite(app->settings, id) >= 0;
    double wide = wr_gui_available() - wr_gui_px(3 * 30);
    wr_gui_text_cut(WR_FONT_BOLD, WR_COLOUR_STRONG, slash ? slash + 1 : "Round brush", wide);
    if (app->shelf->preset) wr_gui_tip(wr_preset_description(app->shelf->preset));
    wr_gui_same_line(0);
    wr_gui_move_to(wr_gui_width() - wr_gui_px(12 + 3 * 28));
    if (wr_gui_glyph("star", liked ? WR_ICON_STAR : WR_ICON_STAR_OFF, 24,
                     liked ? WR_COLOUR_CELL : WR_COLOUR_LABEL))
        wr_settings_set_favourite(app->settings, id, !liked);
    wr_gui_tip("Favourites are chosen by the keys , and .");
    wr_gui_same_line(4);
    if (wr_gui_glyph("save", WR_ICON_SAVE, 24, WR_COLOUR_LABEL))
        wr_action_run(app, WR_ACT(preset_save));
    wr_gui_tip("Save the brush as a preset of your own");
    wr_gui_same_line(4);
    bool own = strncmp(id, "user/", 5) == 0;
    wr_gui_disable(!own);
    if (wr_gui_glyph("delete", WR_ICON_DELETE, 24, own ? WR_COLOUR_LABEL : WR_COLOUR_OFF))
        wr_preset_browser_delete(app, id);
    wr_gui_disable_end();
    wr_gui_tip(own ? "Delete this preset" : "Only presets of your own can be deleted");
}

/* New pictures and presets in the user's folder appear while the list is shown. */
static void check_folder(WrApp *app)
{
    WrPresetBrowser *shelf = app->shelf;
    const double now = wr_clock_seconds();
    if (now - shelf->checked < CHECK_SECONDS) return;
    shelf->checked = now;
    if (wr_stamps_changed(app)) wr_preset_browser_refresh(app);
}

void wr_panel_brushes(WrApp *app, SDL_Rect room)
{
    Groups groups = { .count = 0 };
    const bool brushes = app->shelf->kind == WR_STOCK_BRUSHES;
    if (app->shelf->dragged == 0) check_folder(app);
    find_groups(app, &groups);
    bool both = brushes && room.h >= wr_gui_px(BOTH_UNITS);
    int part = both || !brushes ? 0 : app->shelf->part;
    int rows = 2 + (brushes && !both) - (part == 1);
    SDL_Rect top = cut_top(&room, wr_gui_px(18) + rows * wr_gui_px(29));
    SDL_Rect list = both ? cut_top(&room, (int)(room.h * 0.44)) : room;
    SDL_Rect name = both ? cut_top(&room, wr_gui_px(38)) : (SDL_Rect){ 0 };
    if (brushes && !both && part == 0 && list.h > wr_gui_px(120)) {
        name = list;
        name.h = wr_gui_px(38);
        list.h -= name.h;
        name.y = list.y + list.h;
    }
    wr_gui_area_begin("##brushes_head", WR_AREA_PANEL, top, WR_COLOUR_PANEL);
    head(app, &groups, both);
    wr_gui_area_end();
    if (part == 0) {
        wr_gui_area_begin("##brushes", WR_AREA_PANEL, list, WR_COLOUR_LIST);
        tiles(app, &groups);
        wr_gui_area_end();
    }
    if (name.h > 0) {
        wr_gui_area_begin("##brush_name", WR_AREA_BAR, name, WR_COLOUR_BAR);
        foot(app);
        wr_gui_area_end();
    }
    if (!both && part == 0) return;
    wr_gui_area_begin("##brush_values", WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    wr_gui_pinnable(true);
    wr_panel_brush(app);
    wr_gui_pinnable(false);
    wr_gui_area_end();
}

/* Clock of the next look into the user's folder, while the tab is shown. */
static double next_check(const WrApp *app)
{
    const WrSettings *s = app->settings;
    bool shown = app->visible && s->panels && app->registry->tabs[s->tab].fill == wr_panel_brushes;
    return shown ? app->shelf->checked + CHECK_SECONDS : 0.0;
}

static void look(WrApp *app)
{
    if (next_check(app) > 0.0) check_folder(app);
}

const WrPart wr_part_stock = { .update = look, .next_time = next_check };
