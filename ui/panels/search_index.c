/* The index of the search. Rows come from drawing each place once off screen, so that a new row is found without a list;
   rows that are hidden at present come from the tables they are made of. */
#include "ui/panels/search_index.h"
#include "ui/panels/picture_grid.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/app/state/search_words.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/tool.h"
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/help/guide.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/words.h"

#include "base/memory.h"
#include "base/text.h"
#include "brush/library.h"
#include "brush/preset.h"
#include "command/command_table.h"
#include "command/session.h"
#include "field/ops.h"
#include "generate/generator.h"
#include "scene/light_preset.h"
#include "scene/material_preset.h"
#include "scene/param.h"
#include "scene/stock_model.h"
#include "surface/surface.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

#define ARROW "  >  " /* between the parts of a place */
#define TALL 4000     /* pixels; all parts of a tab have room */

/* ---- one entry ---- */

static char *folded(const char *text)
{
    WrText out = { 0 };
    wr_search_fold(text, &out);
    char *owned = out.length > 0 ? wr_strdup(out.data) : NULL;
    wr_text_fini(&out);
    return owned;
}

/* Length of a label without the dots of a dialog's action. */
static size_t bare_length(const char *label)
{
    const size_t length = strlen(label);
    return length > 3 && strcmp(label + length - 3, "...") == 0 ? length - 3 : length;
}

/* Whether a row of the synonyms is for this English label at this place. */
static bool is_for(const WrSearchWords *words, const char *label, const char *const where[3])
{
    const char *slash = strchr(words->label, '/'), *own = slash ? slash + 1 : words->label;
    const size_t length = bare_length(label);
    if (strlen(own) != length || strncmp(own, label, length) != 0) return false;
    for (int i = 0; slash && i < 3 && where && where[i]; i++)
        if (strlen(where[i]) == (size_t)(slash - words->label) &&
            strncmp(where[i], words->label, strlen(where[i])) == 0)
            return true;
    return !slash;
}

/* Synonyms of an entry, in English and in the window's language, and further words. */
static char *synonyms(const char *label, const char *const where[3], const char *also)
{
    WrText all = { 0 };
    if (also) wr_text_addf(&all, "%s,", also);
    for (const WrSearchWords *w = wr_search_words; w->label; w++) {
        if (!is_for(w, label, where)) continue;
        wr_text_addf(&all, "%s,", w->words);
        if (wr_words(w->words) != w->words) wr_text_addf(&all, "%s,", wr_words(w->words));
    }
    char *result = folded(wr_text_get(&all));
    wr_text_fini(&all);
    return result;
}

/* label: English, or composed; where: parts of the place, English, up to two; NULL: none. help: English. */
static WrSearchEntry *add(WrSearchIndex *index, WrSearchKind kind, const char *label,
                          const char *const where[3], const char *help, const char *also)
{
    const char *said = kind == WR_SEARCH_COMMAND ? label : wr_words(label);
    WrSearchEntry entry = { .kind = kind, .label = wr_strdup(said), .help = help };
    WrText shown = { 0 }, english = { 0 };
    for (int i = 0; where && i < 3 && where[i]; i++) {
        wr_text_addf(&shown, "%s%s", shown.length > 0 ? ARROW : "", wr_words(where[i]));
        wr_text_addf(&english, ",%s", where[i]);
    }
    entry.where = wr_strdup(wr_text_get(&shown));
    if (said != label) entry.field[WR_SEARCH_ENGLISH] = folded(label);
    wr_text_add(&english, wr_text_get(&shown));
    entry.field[WR_SEARCH_LABEL] = folded(entry.label);
    entry.field[WR_SEARCH_ALSO] = synonyms(label, where, also);
    entry.field[WR_SEARCH_PLACE] = folded(wr_text_get(&english));
    wr_text_fini(&shown);
    wr_text_fini(&english);
    wr_array_push(&index->entries, entry);
    return &index->entries.data[index->entries.count - 1];
}

static void fold_help(WrSearchEntry *entry)
{
    WrText both = { 0 };
    if (!entry->help) return;
    wr_text_addf(&both, "%s %s", entry->help, wr_words(entry->help));
    entry->field[WR_SEARCH_HELP] = folded(wr_text_get(&both));
    wr_text_fini(&both);
}

static void entry_fini(WrSearchEntry *entry)
{
    wr_free(entry->label);
    wr_free(entry->where);
    wr_free(entry->action);
    wr_free(entry->section);
    wr_free(entry->row);
    if (entry->own_help) wr_free((char *)entry->help);
    for (int i = 0; i < WR_SEARCH_FIELDS; i++) wr_free(entry->field[i]);
}

void wr_search_index_free(WrSearchIndex *index)
{
    for (int i = 0; i < index->entries.count; i++) entry_fini(&index->entries.data[i]);
    wr_array_free(&index->entries);
    *index = (WrSearchIndex){ .made = index->made + 1 };
}

/* ---- rows as they are drawn ---- */

typedef struct Drawing {
    WrApp *app;
    WrSearchIndex *index;
    WrSearchEntry place; /* action, tab and part of the rows */
    const char *title;   /* of the place, English */
    int which;           /* tab, tool or dialog */
    int first;           /* index of the place's first entry */
    int last;            /* index of the newest row; -1: none */
    char section[128];
} Drawing;

static bool has_letters(const char *text)
{
    for (const char *c = text; *c; c++)
        if (((*c | 32) >= 'a' && (*c | 32) <= 'z') || (unsigned char)*c >= 0xc3) return true;
    return false;
}

static bool is_button(const char *label)
{
    static const char *const buttons[] = { "Cancel", "Close", "Done", "Stop", "Apply", "OK" };
    for (size_t i = 0; i < sizeof buttons / sizeof *buttons; i++)
        if (strcmp(label, buttons[i]) == 0) return true;
    return false;
}

static bool is_action(const WrApp *app, const char *label)
{
    for (const WrAction *a = app->registry->actions; a->name; a++)
        if (strncmp(a->label, label, bare_length(a->label)) == 0 &&
            bare_length(a->label) == bare_length(label))
            return true;
    return false;
}

static bool is_known(const Drawing *d, const char *row)
{
    for (int i = d->first; i < d->index->entries.count; i++) {
        const WrSearchEntry *e = &d->index->entries.data[i];
        if (e->kind == WR_SEARCH_ROW && strcmp(e->row, row) == 0 &&
            strcmp(e->section, d->section) == 0)
            return true;
    }
    return false;
}

static void locate(WrSearchEntry *entry, const Drawing *d, const char *row)
{
    entry->action = d->place.action ? wr_strdup(d->place.action) : NULL;
    entry->tab = d->place.tab;
    entry->part = d->place.part;
    entry->section = wr_strdup(d->section);
    entry->row = wr_strdup(row);
}

static void report(void *ctx, WrRowText kind, const char *text)
{
    Drawing *d = ctx;
    const char *where[3] = { d->title, d->section[0] ? d->section : NULL, NULL };
    if (kind == WR_ROW_SECTION) {
        snprintf(d->section, sizeof d->section, "%s", text);
        d->last = -1;
    } else if (kind == WR_ROW_LABEL || kind == WR_ROW_BUTTON) {
        d->last = -1;
        if (!has_letters(text) || is_button(text) || is_known(d, text)) return;
        if (d->place.action && is_action(d->app, text)) return; /* its button */
        locate(add(d->index, WR_SEARCH_ROW, text, where, NULL, NULL), d, text);
        d->last = d->index->entries.count - 1;
        d->index->entries.data[d->last].button = kind == WR_ROW_BUTTON;
    } else if (d->last < 0) {
        return;
    } else if (kind == WR_ROW_CHOICE) {
        char row[256];
        snprintf(row, sizeof row, "%s", d->index->entries.data[d->last].row);
        where[d->section[0] ? 2 : 1] = row;
        if (has_letters(text))
            locate(add(d->index, WR_SEARCH_CHOICE, text, where, NULL, NULL), d, row);
    } else if (!d->index->entries.data[d->last].help) {
        d->index->entries.data[d->last].help = wr_strdup(text);
        d->index->entries.data[d->last].own_help = true;
    }
}

static void draw_tab(void *ctx)
{
    const Drawing *d = ctx;
    const WrTab *tab = &d->app->registry->tabs[d->which];
    const SDL_Rect room = { 0, 0, wr_gui_px(400), TALL };
    if (tab->fill) {
        tab->fill(d->app, room);
        return;
    }
    wr_gui_area_begin(tab->label, WR_AREA_PANEL, room, WR_COLOUR_PANEL);
    tab->draw(d->app);
    if (tab->second) tab->second(d->app);
    wr_gui_area_end();
}

static void draw_options(void *ctx)
{
    const Drawing *d = ctx;
    const WrTool *tool = d->app->registry->tools[d->which];
    const SDL_Rect room = { 0, 0, TALL, wr_gui_px(40) };
    wr_gui_area_begin("##options", WR_AREA_BAR, room, WR_COLOUR_BAR);
    if (tool->options) tool->options(d->app);
    wr_gui_area_end();
}

static void draw_dialog(void *ctx)
{
    const Drawing *d = ctx;
    d->app->registry->dialogs[d->which].draw(d->app);
}

/* first: index of the first entry whose rows are not repeated; -1: all are new. */
static void list(Drawing *d, void (*draw)(void *ctx), const char *title, WrSearchEntry place,
                 int first)
{
    d->title = title;
    d->place = place;
    d->first = first >= 0 ? first : d->index->entries.count;
    d->last = -1;
    d->section[0] = '\0';
    wr_gui_list_rows(d->app->gui, TALL, TALL, draw, report, d);
}

static void add_tab(const Drawing *d, const char *label)
{
    const char *const where[3] = { "Tab" };
    if (is_action(d->app, label)) return;
    WrSearchEntry *entry = add(d->index, WR_SEARCH_ACTION, label, where, NULL, NULL);
    entry->tab = label;
    entry->part = d->app->shelf->part;
}

static void list_tabs(Drawing *d)
{
    const WrTab *tabs = d->app->registry->tabs;
    for (d->which = 0; d->which < d->app->registry->tab_count; d->which++) {
        const char *label = tabs[d->which].label;
        add_tab(d, label);
        if (tabs[d->which].unlisted) continue;
        list(d, draw_tab, label, (WrSearchEntry){ .tab = label, .part = 1 }, -1);
    }
}

static void list_tools(Drawing *d)
{
    WrApp *app = d->app;
    const int tool = app->tool, width = app->width, first = d->index->entries.count;
    app->width = TALL;
    for (d->which = 0; d->which < app->registry->tool_count; d->which++) {
        const char *action = app->registry->tools[d->which]->action;
        const WrAction *named = wr_action_find(app, action);
        app->tool = d->which;
        if (named)
            list(d, draw_options, named->label, (WrSearchEntry){ .action = (char *)action }, first);
    }
    app->tool = tool;
    app->width = width;
}

static void list_dialogs(Drawing *d)
{
    WrApp *app = d->app;
    const WrDialogState dialog = *app->dialog;
    const WrForms forms = *app->forms;
    for (d->which = 0; d->which < WR_DIALOG_COUNT; d->which++) {
        const WrDialogRow *row = &app->registry->dialogs[d->which];
        const WrAction *action = row->action ? wr_action_find(app, row->action) : NULL;
        if (!action || !wr_action_can(app, action)) continue;
        app->dialog->now = (WrDialog)d->which;
        app->dialog->fresh = true;
        list(d, draw_dialog, action->label, (WrSearchEntry){ .action = (char *)row->action }, -1);
    }
    *app->dialog = dialog;
    *app->forms = forms;
}

/* ---- places of actions ---- */

#define MENU_LEVELS 4

typedef struct MenuPlace {
    const char *action; /* in the registry */
    char menu[2][80];   /* English */
} MenuPlace;

typedef struct Menus {
    WrApp *app;
    WR_ARRAY(MenuPlace) places;
    char path[MENU_LEVELS][80];
    int depth;
} Menus;

static void report_menu(void *ctx, WrRowText kind, const char *text)
{
    Menus *m = ctx;
    if (kind == WR_ROW_MENU) {
        if (m->depth < MENU_LEVELS) snprintf(m->path[m->depth], sizeof m->path[0], "%s", text);
        m->depth++;
    } else if (kind == WR_ROW_MENU_END) {
        m->depth--;
    } else if (kind == WR_ROW_LABEL && m->depth > 0) {
        const WrAction *action = wr_action_find(m->app, text);
        MenuPlace place = { .action = action ? action->name : NULL };
        for (int i = 0; i < 2 && i < m->depth; i++)
            memcpy(place.menu[i], m->path[i], sizeof place.menu[i]);
        if (action) wr_array_push(&m->places, place);
    }
}

static void draw_menu(void *ctx)
{
    wr_panel_menu(((Menus *)ctx)->app);
}

static void list_menus(Menus *menus)
{
    const bool all = wr_gui_reports_all;
    const double height = menus->app->menu_height;
    wr_gui_reports_all = true; /* opens the menus */
    wr_gui_list_rows(menus->app->gui, TALL, TALL, draw_menu, report_menu, menus);
    wr_gui_reports_all = all;
    menus->app->menu_height = (int)height;
}

static const MenuPlace *menu_of(const Menus *menus, const char *action)
{
    for (int i = 0; i < menus->places.count; i++)
        if (strcmp(menus->places.data[i].action, action) == 0) return &menus->places.data[i];
    return NULL;
}

/* ---- tables ---- */

static void finish(WrSearchEntry *entry, const char *action)
{
    entry->action = wr_strdup(action);
    fold_help(entry);
}

/* A row of the index for a value whose row is drawn only in some situations. */
static void add_option(WrSearchIndex *index, const char *label, const char *const where[3],
                       const char *help, WrSearchEntry place)
{
    WrSearchEntry *entry = add(index, WR_SEARCH_OPTION, label, where, help, NULL);
    entry->action = place.action ? wr_strdup(place.action) : NULL;
    entry->tab = place.tab;
    entry->part = place.part;
    entry->section = wr_strdup(place.section ? place.section : "");
    entry->row = wr_strdup(label);
    fold_help(entry);
}

static void add_actions(WrApp *app, WrSearchIndex *index)
{
    Menus menus = { .app = app };
    list_menus(&menus);
    for (const WrAction *a = app->registry->actions; a->name; a++) {
        if (strcmp(a->name, WR_ACT(search)) == 0) continue;
        const bool tool = wr_tool_find(app, a->name) >= 0;
        const MenuPlace *menu = menu_of(&menus, a->name);
        const char *const where[3] = { tool   ? "Tools"
                                       : menu ? menu->menu[0]
                                              : NULL,
                                       !tool && menu && menu->menu[1][0] ? menu->menu[1] : NULL };
        finish(add(index, tool ? WR_SEARCH_TOOL : WR_SEARCH_ACTION, a->label, where,
                   wr_action_help(app, a), NULL),
               a->name);
    }
    wr_array_free(&menus.places);
}

static void add_operations(WrSearchIndex *index)
{
    for (const WrOpInfo *op = wr_ops; op->name; op++) {
        char action[64];
        const char *const where[3] = { "Layer" }, *const of[3] = { "Layer", op->label };
        const char *const filters[3] = { "Filter layer" };
        snprintf(action, sizeof action, "adjust_%.50s", op->name);
        finish(add(index, WR_SEARCH_OPERATION, op->label, where, op->help, op->name), action);
        for (const WrOpParam *p = op->params; p->name; p++)
            add_option(index, p->label, of, p->help, (WrSearchEntry){ .action = action });
        if (op->reshapes) continue;
        snprintf(action, sizeof action, "filter_%.50s", op->name);
        finish(add(index, WR_SEARCH_FILTER, op->label, filters, op->help, op->name), action);
    }
}

static void add_generators(WrSearchIndex *index)
{
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            char action[WR_GENERATE_ACTION];
            const char *const where[3] = { "Generate", g->name ? f->label : NULL };
            const char *const of[3] = { "Generate", g->label };
            wr_generate_action(g, action);
            finish(add(index, WR_SEARCH_GENERATOR, g->label, where, g->help, g->name), action);
            for (const WrParam *p = g->params; p->name; p++)
                add_option(index, p->label, of, p->help, (WrSearchEntry){ .action = action });
        }
}

/* The label of a surface's number in the scene panel. */
static void surface_label(const char *help, char label[128])
{
    snprintf(label, 128, "%.96s", wr_words(help));
    if (label[0] >= 'a' && label[0] <= 'z') label[0] = (char)(label[0] - 'a' + 'A');
}

static void add_models(WrSearchIndex *index)
{
    const WrSearchEntry place = { .tab = "Scene", .section = "SURFACE" };
    for (int i = 0; i < WR_SURFACE_COUNT; i++) {
        const WrSurfaceInfo *surface = wr_surfaces[i];
        const char *const where[3] = { "Scene", "SURFACE", "Patch" };
        const char *const of[3] = { "Scene", "SURFACE", surface->label };
        char line[64], label[128];
        snprintf(line, sizeof line, "surface %.40s", surface->name);
        WrSearchEntry *entry =
            add(index, WR_SEARCH_MODEL, surface->label, where, surface->help, surface->name);
        entry->item = i;
        finish(entry, line);
        for (const WrSurfaceParam *p = surface->params;
             p->name && p - surface->params < WR_SURFACE_PARAMS; p++) {
            surface_label(p->help, label);
            if (p->components == 3) strcat(label, " x");
            if (p->components <= 3)
                add_option(index, p->ends[0] ? "Table" : label, of, p->help, place);
        }
        for (const WrSurfaceText *t = surface->texts;
             t->name && t - surface->texts < WR_SURFACE_TEXTS; t++)
            add_option(index, t->label, of, t->help, place);
    }
}

/* A row of a table with pictures, set by a line. */
static void add_picture(WrSearchIndex *index, WrSearchKind kind, WrThumbKind set, int i,
                        const char *section, const char *title, const char *help, const char *name,
                        const char *verb)
{
    const char *const where[3] = { "Scene", section };
    char line[64];
    snprintf(line, sizeof line, "%s%.40s", verb, name);
    WrSearchEntry *entry = add(index, kind, title, where, help, name);
    entry->item = i;
    entry->pictures = set + 1;
    finish(entry, line);
}

static void add_pictures(WrSearchIndex *index)
{
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++) {
        const WrMaterialPreset *preset = &wr_material_presets[i];
        add_picture(index, WR_SEARCH_MATERIAL, WR_THUMB_MATERIAL, i, "MATERIAL", preset->title,
                    preset->help, preset->name, "material preset=");
    }
    for (int i = 0; i < WR_STOCK_MODELS; i++) {
        const WrStockModel *model = &wr_stock_models[i];
        add_picture(index, WR_SEARCH_MODEL, WR_THUMB_MODEL, i, "SURFACE", model->title, model->help,
                    model->name, "model ");
    }
    for (int i = 0; i < WR_LIGHT_PRESETS; i++) {
        const WrLightPreset *preset = &wr_light_presets[i];
        add_picture(index, WR_SEARCH_MATERIAL, WR_THUMB_LIGHT, i, "LIGHT", preset->title,
                    preset->help, preset->name, "light preset ");
    }
}

static bool is_drawn(const WrSearchIndex *index, const char *tab, const char *section,
                     const char *label)
{
    for (int i = index->fixed; i < index->entries.count; i++) {
        const WrSearchEntry *e = &index->entries.data[i];
        if (e->row && e->tab && strcmp(e->tab, tab) == 0 && strcmp(e->row, label) == 0 &&
            (!section || strcmp(e->section, section) == 0))
            return true;
    }
    return false;
}

/* Section of the scene panel with the values of a command. */
static const char *section_of(const char *command)
{
    static const char *const sections[][2] = {
        { "material", "MATERIAL" }, { "grain", "SOLID TEXTURE" },
        { "light", "LIGHT" },       { "environment", "ENVIRONMENT" },
        { "camera", "CAMERA" },     { "background", "BACKGROUND" },
        { "object", "OBJECTS" },    { "cell", "REAL-WORLD SIZE" },
        { "bump", "BUMP" },         { "tone", "EXPOSURE" },
    };
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        if (strcmp(sections[i][0], command) == 0) return sections[i][1];
    return NULL;
}

/* Numbers of the scene and settings of brushes that have no row at present. */
static void add_hidden(WrSearchIndex *index)
{
    for (int i = 0; i < WR_SCENE_PARAM_COUNT; i++) {
        const WrSceneParam *p = &wr_scene_params[i];
        const char *section = section_of(p->command);
        const char *const where[3] = { "Scene", section };
        if (!p->label || is_drawn(index, "Scene", section, p->label)) continue;
        add_option(index, p->label, where, p->help,
                   (WrSearchEntry){ .tab = "Scene", .section = (char *)section });
        WrSearchEntry *entry = &index->entries.data[index->entries.count - 1];
        entry->kind = WR_SEARCH_ROW;
        entry->hidden = true;
    }
    for (int i = 0; i < wr_preset_setting_count(); i++) {
        const WrSettingInfo *info = wr_preset_setting(i);
        const char *const where[3] = { "Brushes" };
        if (info->use != WR_SETTING_IGNORED && !is_drawn(index, "Brushes", NULL, info->label))
            add_option(index, info->label, where, info->meaning,
                       (WrSearchEntry){ .tab = "Brushes", .part = 1 });
    }
}

static void add_brushes(WrApp *app, WrSearchIndex *index)
{
    const WrLibrary *library = wr_preset_browser_library(app);
    for (int i = 0; i < wr_library_count(library); i++) {
        const WrPresetEntry *preset = wr_library_entry(library, i);
        const char *slash = strrchr(preset->name, '/');
        const char *const where[3] = { "Brushes", preset->group };
        char label[128];
        snprintf(label, sizeof label, "%.120s", slash ? slash + 1 : preset->name);
        for (char *c = label; *c; c++)
            if (*c == '_' || *c == '-') *c = ' ';
        if (label[0] >= 'a' && label[0] <= 'z') label[0] = (char)(label[0] - 32);
        WrSearchEntry *entry = add(index, WR_SEARCH_BRUSH, label, where, NULL, preset->id);
        entry->item = i;
        finish(entry, preset->id);
    }
    index->library = library;
}

static void add_heading(void *ctx, const char *page, const char *title, const char *heading)
{
    char place[300];
    const char *const where[3] = { "Guide", heading ? title : NULL };
    if (heading && strncmp(page, "commands", 8) == 0)
        return; /* the commands themselves are found */
    snprintf(place, sizeof place, "%.100s#%.190s", page, heading ? heading : "");
    finish(add(ctx, WR_SEARCH_PAGE, heading ? heading : title, where, NULL, NULL), place);
}

static void add_commands(WrSearchIndex *index)
{
    for (const WrCommand *const *c = wr_commands; *c; c++) {
        const char *const where[3] = { "Command" };
        finish(add(index, WR_SEARCH_COMMAND, (*c)->name, where, (*c)->help, NULL), (*c)->name);
    }
}

/* The part that depends on the language and the library alone. */
static void make_fixed(WrApp *app, WrSearchIndex *index)
{
    Drawing d = { .app = app, .index = index };
    wr_search_index_free(index);
    add_actions(app, index);
    add_operations(index);
    add_generators(index);
    add_models(index);
    add_pictures(index);
    list_tools(&d);
    list_dialogs(&d);
    add_brushes(app, index);
    wr_guide_headings(app, add_heading, index);
    add_commands(index);
    index->fixed = index->entries.count;
    snprintf(index->language, sizeof index->language, "%s", wr_words_language());
}

void wr_search_index_update(WrApp *app)
{
    WrSearchIndex *index = &app->finder->index;
    const uint64_t revision = wr_session_revision(app->session);
    const int redraw = app->redraw;
    const bool error_open = app->accuracy->error_open, plot_open = app->accuracy->plot_open;
    const bool same = index->fixed > 0 && index->library == wr_preset_browser_library(app) &&
                      strcmp(index->language, wr_words_language()) == 0;
    if (same && index->revision == revision) return;
    Drawing d = { .app = app, .index = index };
    if (!same) make_fixed(app, index);
    while (index->entries.count > index->fixed)
        entry_fini(&index->entries.data[--index->entries.count]);
    list_tabs(&d);
    add_hidden(index);
    for (int i = 0; i < index->entries.count; i++) {
        WrSearchEntry *e = &index->entries.data[i];
        if (e->row && e->help && !e->field[WR_SEARCH_HELP]) fold_help(e);
    }
    index->revision = revision;
    index->made++;
    app->accuracy->error_open = error_open;
    app->accuracy->plot_open = plot_open;
    app->redraw = redraw;
}

/* ---- the answer ---- */

/* Added to the rank: entries that act at once come before those that explain. Commands come last. */
static int bias_of(WrSearchKind kind)
{
    switch (kind) {
    case WR_SEARCH_TOOL: return 700;
    case WR_SEARCH_GENERATOR: return 650;
    case WR_SEARCH_OPERATION: return 620;
    case WR_SEARCH_ROW: return 610;
    case WR_SEARCH_ACTION: return 600;
    case WR_SEARCH_MODEL:
    case WR_SEARCH_MATERIAL: return 450;
    case WR_SEARCH_FILTER: return 300;
    case WR_SEARCH_CHOICE: return -2500;
    case WR_SEARCH_OPTION: return -3000;
    case WR_SEARCH_BRUSH: return -3500;
    case WR_SEARCH_PAGE: return -4000;
    case WR_SEARCH_COMMAND:
    case WR_SEARCH_KINDS: break;
    }
    return -100000;
}

static int find(const WrSearchIndex *index, const WrSearchQuery *query, bool any, WrSearchHit *out,
                int most)
{
    int count = 0;
    for (int i = 0; i < index->entries.count; i++) {
        const WrSearchEntry *e = &index->entries.data[i];
        const int rank = wr_search_rank(query, (const char *const *)e->field, any);
        if (rank == 0) continue;
        const int score = rank + bias_of(e->kind) - (e->button ? 50 : 0);
        int at = count;
        while (at > 0 && out[at - 1].score < score) at--;
        if (at >= most) continue;
        const int last = count < most ? count++ : most - 1;
        memmove(out + at + 1, out + at, (size_t)(last - at) * sizeof *out);
        out[at] = (WrSearchHit){ i, score };
    }
    return count;
}

#define ALL 200
#define ALIKE 3

/* Many generators have values of one name: the first ones are enough. */
static bool is_flood(const WrSearchIndex *index, const WrSearchHit *kept, int count, int entry)
{
    const WrSearchEntry *e = &index->entries.data[entry];
    int alike = 0;
    for (int i = 0; i < count; i++) {
        const WrSearchEntry *other = &index->entries.data[kept[i].entry];
        alike += other->kind == e->kind && strcmp(other->label, e->label) == 0;
    }
    return e->kind == WR_SEARCH_OPTION && alike >= ALIKE;
}

/* An option of a tool or dialog is one click further away than an action of the same name. */
static void actions_first(const WrSearchIndex *index, WrSearchHit *hits, int count)
{
    for (int i = 0; i + 1 < count; i++) {
        const WrSearchEntry *option = &index->entries.data[hits[i].entry];
        const WrSearchEntry *other = &index->entries.data[hits[i + 1].entry];
        const WrSearchHit hit = hits[i];
        if (!option->row || !option->action || other->kind != WR_SEARCH_ACTION ||
            SDL_strcasecmp(option->label, other->label) != 0)
            continue;
        hits[i] = hits[i + 1];
        hits[i + 1] = hit;
    }
}

int wr_search_index_find(const WrSearchIndex *index, const char *text, WrSearchHit *out, int most)
{
    WrSearchQuery query;
    WrSearchHit all[ALL];
    wr_search_parse(text, &query);
    int count = find(index, &query, false, all, ALL), kept = 0;
    if (count == 0 && query.count > 1) count = find(index, &query, true, all, ALL);
    for (int i = 0; i < count && kept < most; i++)
        if (!is_flood(index, out, kept, all[i].entry)) out[kept++] = all[i];
    actions_first(index, out, kept);
    return kept;
}

/* ---- opening ---- */

void wr_search_index_open(WrApp *app, const WrSearchEntry *entry)
{
    switch (entry->kind) {
    case WR_SEARCH_COMMAND: break; /* its line is written in the search */
    case WR_SEARCH_PAGE: wr_guide_open(app, entry->action); break;
    case WR_SEARCH_BRUSH:
        wr_action_run(app, WR_ACT(brush));
        wr_preset_browser_choose(app, entry->action);
        break;
    case WR_SEARCH_MODEL:
        wr_app_run_line(app, entry->action);
        wr_scene_refit(app);
        break;
    case WR_SEARCH_MATERIAL: wr_app_run_line(app, entry->action); break;
    case WR_SEARCH_ACTION:
    case WR_SEARCH_TOOL:
    case WR_SEARCH_ROW:
    case WR_SEARCH_CHOICE:
    case WR_SEARCH_GENERATOR:
    case WR_SEARCH_OPERATION:
    case WR_SEARCH_FILTER:
    case WR_SEARCH_OPTION:
    case WR_SEARCH_KINDS:
        if (entry->action) wr_action_run(app, entry->action);
        if (entry->tab) app->shelf->part = entry->part;
        if (entry->tab) wr_tab_show(app, entry->tab);
        if (entry->row) wr_gui_light_row(app->gui, entry->section, entry->row);
    }
    wr_app_redraw(app);
}
