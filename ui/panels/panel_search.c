/* Search: menu actions, table operations, generators, surfaces and materials; and every command, whose line can then
   be typed here. */
#include "ui/panels/panel_search.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "command/command_table.h"
#include "field/ops.h"
#include "generate/generator.h"
#include "scene/light_preset.h"
#include "scene/material_preset.h"
#include "scene/stock_model.h"
#include "surface/surface.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

#define FOUND_MAX 12
#define COMMAND "command:" /* name prefix of rows that are commands */
#define LINE "line:"       /* name prefix of rows that are whole lines */

typedef struct Found {
    char name[64], label[80];
    const char *help; /* one line of help; borrowed from a table */
    int score;
} Found;

/* Keep the best matches; equal scores stay in the order of their table. also: further searched text besides label and
   help, or NULL. */
static void offer(Found found[FOUND_MAX], int *count, const Found *one, const char *also,
                  const char *query)
{
    int score = wr_search_score(wr_words(one->label), query), at = *count;
    if (score == 0) score = wr_search_score(one->label, query); /* try the English label too */
    if (score == 0 && also && wr_search_score(also, query) > 0) score = 1;
    if (score == 0 &&
        (wr_search_score(wr_words(one->help), query) > 0 || wr_search_score(one->help, query) > 0))
        score = 1;
    if (score == 0) return;
    while (at > 0 && found[at - 1].score < score) at--;
    if (at >= FOUND_MAX) return;
    int last = *count < FOUND_MAX ? *count : FOUND_MAX - 1;
    memmove(found + at + 1, found + at, (size_t)(last - at) * sizeof *found);
    found[at] = *one;
    found[at].score = score;
    if (*count < FOUND_MAX) (*count)++;
}

static int find_actions(const WrApp *app, Found found[FOUND_MAX])
{
    int count = 0;
    const char *query = app->finder->text;
    for (const WrAction *a = app->registry->actions; a->name; a++)
        if (strcmp(a->name, WR_ACT(search)) != 0) {
            Found one = { .help = wr_action_help(app, a) };
            snprintf(one.name, sizeof one.name, "%.60s", a->name);
            snprintf(one.label, sizeof one.label, "%.78s", a->label);
            offer(found, &count, &one, NULL, query);
        }
    for (const WrOpInfo *op = wr_ops; op->name; op++) {
        char also[120];
        Found one = { .help = op->help };
        snprintf(one.name, sizeof one.name, "adjust_%.50s", op->name);
        snprintf(one.label, sizeof one.label, "%.60s...", wr_words(op->label));
        snprintf(also, sizeof also, "%.60s %.40s", op->label, op->name);
        offer(found, &count, &one, also, query);
        if (op->reshapes) continue;
        snprintf(one.name, sizeof one.name, "filter_%.50s", op->name);
        snprintf(one.label, sizeof one.label, wr_words("Filter layer: %s..."), wr_words(op->label));
        offer(found, &count, &one, also, query);
    }
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            char name[WR_GENERATE_ACTION], also[300];
            Found one = { .help = g->help };
            wr_generate_action(g, name);
            snprintf(one.name, sizeof one.name, "%.60s", name);
            snprintf(one.label, sizeof one.label, g->name ? "%.30s: %.40s" : "%.30s",
                     wr_words(f->label), wr_words(g->label));
            snprintf(also, sizeof also, "%.30s %.30s %.30s %.130s", f->name, g->name ? g->name : "",
                     g->label, g->help);
            offer(found, &count, &one, also, query);
        }
    return count;
}

/* The line that sets a row of a table, under its subject and title. */
static void offer_line(Found found[FOUND_MAX], int *count, const char *verb, const char *name,
                       const char *subject, const char *title, const char *help, const char *query)
{
    Found one = { .help = help };
    snprintf(one.name, sizeof one.name, LINE "%s%.30s", verb, name);
    snprintf(one.label, sizeof one.label, "%.30s: %.40s", wr_words(subject), wr_words(title));
    offer(found, count, &one, title, query);
}

/* Surfaces, materials, models and light presets by name (torus, gold), as lines. */
static void find_lines(Found found[FOUND_MAX], int *count, const char *query)
{
    for (int i = 0; i < WR_SURFACE_COUNT; i++) {
        const WrSurfaceInfo *surface = wr_surfaces[i];
        Found one = { .help = surface->help };
        if (surface->held || surface->make)
            continue; /* needs a file or a text, which the line lacks */
        snprintf(one.name, sizeof one.name, LINE "surface %.40s", surface->name);
        snprintf(one.label, sizeof one.label, "%.30s: %.40s", wr_words("Patch"),
                 wr_words(surface->label));
        offer(found, count, &one, surface->label, query);
    }
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++) {
        const WrMaterialPreset *preset = &wr_material_presets[i];
        offer_line(found, count, "material preset=", preset->name, "Material", preset->title,
                   preset->help, query);
    }
    for (int i = 0; i < WR_STOCK_MODELS; i++) {
        const WrStockModel *model = &wr_stock_models[i];
        offer_line(found, count, "model ", model->name, "Model", model->title, model->help, query);
    }
    for (int i = 0; i < WR_LIGHT_PRESETS; i++) {
        const WrLightPreset *preset = &wr_light_presets[i];
        offer_line(found, count, "light preset ", preset->name, "Light", preset->title,
                   preset->help, query);
    }
}

/* Search all tables, commands last. */
static int find(const WrApp *app, Found found[FOUND_MAX])
{
    const char *query = app->finder->text;
    int count = find_actions(app, found);
    for (const WrCommand *const *c = wr_commands; *c; c++) {
        Found one = { .help = (*c)->help };
        snprintf(one.name, sizeof one.name, COMMAND "%.40s", (*c)->name);
        snprintf(one.label, sizeof one.label, "%.20s: %.55s", (*c)->name, wr_words((*c)->help));
        offer(found, &count, &one, NULL, query);
    }
    find_lines(found, &count, query);
    return count;
}

/* The command whose line is being typed: the text starts with its verb and a space. */
static const WrCommand *typed(const char *text)
{
    char verb[40];
    const size_t length = strcspn(text, " ");
    if (text[length] != ' ' || length >= sizeof verb) return NULL;
    memcpy(verb, text, length);
    verb[length] = '\0';
    return wr_command_find(verb);
}

/* Help of that command in place of the list; Return runs the line. */
static void command_line(WrApp *app, const WrCommand *command, bool enter)
{
    char line[sizeof app->finder->text];
    wr_gui_list_begin("found", 26.0 * FOUND_MAX * wr_gui_scale() + wr_gui_px(12));
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, command->help);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                        "Enter carries the line out. Its values are on the guide's pages of the "
                        "commands (F1). For example:");
    wr_gui_as_it_is(true);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, command->example);
    wr_gui_as_it_is(false);
    wr_gui_list_end();
    if (!enter) return;
    snprintf(line, sizeof line, "%s", app->finder->text);
    wr_dialog_close(app);
    wr_app_run_line(app, line);
}

static void run(WrApp *app, const char *name)
{
    WrFinder *finder = app->finder;
    if (strncmp(name, COMMAND, strlen(COMMAND)) == 0) {
        snprintf(finder->text, sizeof finder->text, "%.60s ", name + strlen(COMMAND));
        finder->fill = finder->line = true;
        wr_app_redraw(app);
        return;
    }
    wr_dialog_close(app);
    if (strncmp(name, LINE, strlen(LINE)) == 0) wr_app_run_line(app, name + strlen(LINE));
    else wr_action_run(app, name);
}

static bool row(const WrApp *app, const Found *found, int i, bool chosen)
{
    char keys[32];
    const WrAction *action = wr_action_find(app, found->name);
    bool enabled = !action || wr_action_can(app, action);
    WrRow r = wr_gui_row_begin(i, 26, chosen);
    wr_gui_row_set_cursor(wr_gui_px(14), 0);
    wr_gui_text_cut(WR_FONT_TEXT, enabled ? WR_COLOUR_TEXT : WR_COLOUR_FAINT, found->label,
                    wr_gui_row_width() - wr_gui_px(150));
    wr_keys_label(app->keys, found->name, keys);
    double wide = wr_gui_text_width(WR_FONT_SMALL, keys);
    wr_gui_row_set_cursor(wr_gui_row_width() - wide - wr_gui_px(14), 0);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, keys);
    wr_gui_row_end();
    wr_gui_tip(found->help);
    return r.clicked && enabled;
}

/* Help of the chosen row, always two lines high, so that the dialog keeps its size. */
static void help_line(const Found *found)
{
    wr_gui_list_begin("help", 2.6 * wr_gui_line_height(WR_FONT_SMALL) + wr_gui_px(16));
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, found->help);
    wr_gui_list_end();
}

void wr_search_line(WrApp *app, const char *line)
{
    if (strlen(line) >= sizeof app->finder->text) {
        wr_app_say(app, "The line of this layer is too long to be shown here");
        return;
    }
    *app->finder = (WrFinder){ .fill = true, .line = true };
    strcpy(app->finder->text, line);
    wr_dialog_open(app, WR_DIALOG_SEARCH);
}

void wr_dialog_search(WrApp *app)
{
    Found found[FOUND_MAX];
    WrFinder *finder = app->finder;
    if (app->dialog->fresh && !finder->fill) *finder = (WrFinder){ 0 };
    if (!wr_gui_dialog_begin("Search actions", 460)) return;
    char before[sizeof finder->text];
    memcpy(before, finder->text, sizeof before);
    bool enter = wr_gui_text_field("##find", 0, finder->text, sizeof finder->text,
                                   app->dialog->fresh || finder->fill || finder->empty);
    const WrCommand *command = typed(finder->text);
    finder->fill = false;
    finder->line = finder->line && command;
    if (command && (finder->line || find_actions(app, found) == 0)) {
        command_line(app, command, enter);
        if (!app->dialog->fresh && wr_gui_escape_pressed()) wr_dialog_close(app);
        wr_gui_dialog_end();
        return;
    }
    if (strcmp(before, finder->text) != 0) finder->chosen = 0;
    int count = find(app, found), go = -1;
    if (wr_gui_key_pressed(SDL_SCANCODE_DOWN)) finder->chosen++;
    if (wr_gui_key_pressed(SDL_SCANCODE_UP)) finder->chosen--;
    finder->chosen = finder->chosen < 0 ? 0 : finder->chosen >= count ? count - 1 : finder->chosen;
    if (finder->chosen < 0) finder->chosen = 0;
    wr_gui_list_begin("found", 26.0 * FOUND_MAX * wr_gui_scale() + wr_gui_px(12));
    wr_gui_space(-6);
    for (int i = 0; i < count; i++)
        if (row(app, &found[i], i, i == finder->chosen)) go = i;
    if (count == 0) wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "No action has these words.");
    wr_gui_list_end();
    if (count > 0) help_line(&found[finder->chosen]);
    /* Return with an empty field must not run the first row. */
    finder->empty = enter && !finder->text[0] && finder->chosen == 0;
    if (enter && count > 0 && !finder->empty) go = finder->chosen;
    if (go >= 0) run(app, found[go].name);
    else if (!app->dialog->fresh && wr_gui_escape_pressed()) wr_dialog_close(app);
    wr_gui_dialog_end();
}
