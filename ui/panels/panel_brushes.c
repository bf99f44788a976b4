/* The Brushes tab: presets as pictures, by collection and group, with a search; below them the brush parameters.
   Without room for both, one of them at a time. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/search_score.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panels.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/thumbs.h"

#include "base/array.h"
#include "base/memory.h"
#include "brush/library.h"
#include "brush/preset.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TILE_UNITS 52
#define BOTH_UNITS 460 /* least height for showing both parts */
#define GROUPS_MAX 64
#define FIXED_GROUPS 3 /* all, favourites, recently used */

/* ---- filter ---- */

typedef struct Groups {
    const char *labels[GROUPS_MAX];
    char texts[GROUPS_MAX][64];
    const char *collection[GROUPS_MAX], *group[GROUPS_MAX];
    int count;
} Groups;

static bool same(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

static const char *collection_label(const char *collection)
{
    return same(collection, "user")       ? "My own"
           : same(collection, "wrinkle")  ? "Relief"
           : same(collection, "mypaint2") ? "MyPaint"
           : same(collection, "mypaint1") ? "MyPaint 1"
                                          : collection;
}

static void add_group(Groups *g, const char *collection, const char *group)
{
    for (int i = FIXED_GROUPS; i < g->count; i++)
        if (same(g->collection[i], collection) && same(g->group[i], group)) return;
    if (g->count >= GROUPS_MAX) return;
    int at = g->count++;
    g->collection[at] = collection;
    g->group[at] = group;
    const char *label = collection_label(collection);
    if (group[0]) snprintf(g->texts[at], sizeof g->texts[at], "%.20s: %.38s", label, group);
    else snprintf(g->texts[at], sizeof g->texts[at], "%.60s", label);
    g->labels[at] = g->texts[at];
}

static void find_groups(const WrLibrary *library, Groups *g)
{
    g->labels[0] = "All";
    g->labels[1] = "Favourites";
    g->labels[2] = "Used last";
    g->count = FIXED_GROUPS;
    for (int i = 0; i < wr_library_count(library); i++) {
        const WrPresetEntry *e = wr_library_entry(library, i);
        add_group(g, e->collection, e->group ? e->group : "");
    }
}

static bool belongs(const WrApp *app, const Groups *g, const WrPresetEntry *entry)
{
    int group = app->shelf->group;
    char text[200];
    snprintf(text, sizeof text, "%.90s %.90s", entry->name, entry->group ? entry->group : "");
    for (char *c = text; *c; c++)
        if (*c == '_' || *c == '-' || *c == '/') *c = ' ';
    if (app->shelf->search[0] && wr_search_score(text, app->shelf->search) == 0) return false;
    if (app->shelf->search[0] || group == 0) return true;
    if (group == 1) return wr_settings_find_favourite(app->settings, entry->id) >= 0;
    return group >= FIXED_GROUPS && group < g->count &&
           same(g->collection[group], entry->collection) &&
           same(g->group[group], entry->group ? entry->group : "");
}

/* ---- context menu of a preset ---- */

static void preset_menu(WrApp *app)
{
    WrPresetBrowser *shelf = app->shelf;
    char id[sizeof shelf->pressed];
    if (!wr_gui_popup_begin("preset")) return;
    memcpy(id, shelf->pressed, sizeof id);
    bool liked = wr_settings_find_favourite(app->settings, id) >= 0;
    if (wr_gui_menu_item(liked ? "No favourite any more" : "Favourite", NULL, liked, true))
        wr_settings_set_favourite(app->settings, id, !liked);
    if (wr_gui_menu_item("Choose", NULL, false, true)) wr_preset_browser_choose(app, id);
    bool own = strncmp(id, "user/", 5) == 0;
    if (wr_gui_menu_item("Delete", NULL, false, own)) wr_preset_browser_delete(app, id);
    wr_gui_popup_end();
}

/* ---- tiles ---- */

typedef struct Flow { /* layout of tiles in rows */
    double side;
    int columns, count;
} Flow;

static void next_place(Flow *flow)
{
    if (flow->count % flow->columns) wr_gui_same_line(4);
    else if (flow->count > 0) wr_gui_space(-4);
    flow->count++;
}

/* id: WR_ROUND for index -1. */
static void tile(WrApp *app, Flow *flow, int index, const char *id, const char *name)
{
    const WrPresetEntry *entry = index < 0 ? NULL : wr_library_entry(app->shelf->library, index);
    bool liked = wr_settings_find_favourite(app->settings, id) >= 0;
    next_place(flow);
    wr_gui_push_id(index + 2);
    SDL_Texture *picture =
        wr_gui_will_see(flow->side) ? wr_thumb_of(app, index, (int)flow->side) : NULL;
    int pressed =
        wr_gui_tile("tile", picture, flow->side, same(id, wr_preset_browser_chosen(app)), liked);
    char tip[300];
    snprintf(tip, sizeof tip, "%.200s%s%.60s", name, entry && entry->group ? "\n" : "",
             entry && entry->group ? entry->group : "");
    wr_gui_as_it_is(index >= 0);
    wr_gui_tip(tip);
    wr_gui_as_it_is(false);
    wr_gui_pop_id();
    if (pressed == 1) wr_preset_browser_choose(app, id);
    if (pressed != 2) return;
    snprintf(app->shelf->pressed, sizeof app->shelf->pressed, "%s", id);
    wr_gui_popup_open("preset");
}

static void used_last(WrApp *app, Flow *flow)
{
    for (int i = 0; i < WR_USED_MAX && app->settings->used[i]; i++) {
        char *id = wr_strdup(app->settings->used[i]); /* choosing a preset reorders the list */
        int index = wr_preset_browser_find(app, id);
        if (index >= 0 || same(id, WR_ROUND))
            tile(app, flow, index, id, index < 0 ? "Round brush" : strchr(id, '/') + 1);
        wr_free(id);
    }
}

static void tiles(WrApp *app, const Groups *groups)
{
    const WrLibrary *library = wr_preset_browser_library(app);
    double gap = wr_gui_px(4), room = wr_gui_available() + gap;
    Flow flow = { .columns = (int)(room / (wr_gui_px(TILE_UNITS) + gap) + 0.5) };
    flow.columns = flow.columns > 0 ? flow.columns : 1;
    flow.side = floor(room / flow.columns - gap); /* tiles are enlarged to fill the row */
    if (app->shelf->group == 2 && !app->shelf->search[0]) {
        used_last(app, &flow);
    } else {
        bool liked = wr_settings_find_favourite(app->settings, WR_ROUND) >= 0;
        bool round = app->shelf->search[0] ? wr_search_score("round brush", app->shelf->search) > 0
                                           : app->shelf->group != 1 || liked;
        if (round) tile(app, &flow, -1, WR_ROUND, "Round brush: exact on every machine");
        for (int i = 0; i < wr_library_count(library); i++) {
            const WrPresetEntry *entry = wr_library_entry(library, i);
            if (!belongs(app, groups, entry)) continue;
            tile(app, &flow, i, entry->id, entry->name);
            if (app->shelf->library != library) break; /* a preset was removed */
        }
    }
    if (flow.count == 0)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            app->shelf->search[0] ? "No brush has these words."
                                                  : "None yet: press one with the right button.");
    preset_menu(app);
}

/* ---- the tab ---- */

static void head(WrApp *app, const Groups *groups, bool both)
{
    static const char *const parts[] = { "Presets", "This brush" };
    WrPresetBrowser *shelf = app->shelf;
    if (!both) {
        wr_gui_segments("part", parts, NULL, 2, &shelf->part);
        if (shelf->part == 1) return;
    }
    double half = wr_gui_available() / 2.0 - wr_gui_px(3);
    if (shelf->group >= groups->count) shelf->group = 0;
    wr_gui_hint_field("##search", "Search brushes", half, shelf->search, sizeof shelf->search);
    wr_gui_same_line(6);
    wr_gui_disable(shelf->search[0] != '\0');
    wr_gui_choice("group", half, groups->labels, groups->count, &shelf->group);
    wr_gui_disable_end();
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

void wr_panel_brushes(WrApp *app, SDL_Rect room)
{
    Groups groups = { .count = 0 };
    find_groups(wr_preset_browser_library(app), &groups);
    bool both = room.h >= wr_gui_px(BOTH_UNITS);
    int part = both ? 0 : app->shelf->part;
    SDL_Rect top = cut_top(&room, wr_gui_px(12) + (both || part == 1 ? 1 : 2) * wr_gui_px(34));
    SDL_Rect list = both ? cut_top(&room, (int)(room.h * 0.44)) : room;
    SDL_Rect name = both ? cut_top(&room, wr_gui_px(38)) : (SDL_Rect){ 0 };
    if (!both && part == 0 && list.h > wr_gui_px(120)) {
        name = list;
        name.h = wr_gui_px(38);
        list.h -= name.h;
        name.y = list.y + list.h;
    }
    wr_gui_area_begin("##brushes_head", WR_AREA_PANEL, top, WR_COLOUR_PANEL);
    head(app, &groups, both);
    wr_gui_area_end();
    if (both || part == 0) {
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
