/* Search: the results for a text, from the index of everything that the window shows; the line of a command can be typed
   here. */
#include "ui/panels/panel_search.h"
#include "ui/app/state/action.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/canvas/tools/tool.h"
#include "ui/panels/picture_grid.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/error.h"
#include "command/command_line.h"
#include "command/command_table.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS 12 /* seen without scrolling */
#define ROW_UNITS 28

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

/* True for a whole command line with values, such as "step off 2". Without values, as "noise perlin", words search. */
static bool is_line(const char *text)
{
    WrCall *call;
    WrError err = { "" };
    if (!strpbrk(text, "=0123456789") || !wr_call_parse(text, false, &call, &err)) return false;
    wr_call_free(call);
    return true;
}

/* Help of that command in place of the list; Return runs the line. */
static void command_line(WrApp *app, const WrCommand *command, bool enter)
{
    char line[sizeof app->finder->text];
    wr_gui_list_begin("found", ROW_UNITS * ROWS * wr_gui_scale() + wr_gui_px(12));
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, command->help);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                        "Enter runs the line. The guide explains the commands (F1). For example:");
    wr_gui_as_it_is(true);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, command->example);
    wr_gui_as_it_is(false);
    wr_gui_list_end();
    if (!enter) return;
    snprintf(line, sizeof line, "%s", app->finder->text);
    wr_dialog_close(app);
    wr_app_run_line(app, line);
}

/* ---- results ---- */

static const char *icon_of(const WrApp *app, const WrSearchEntry *entry)
{
    const int tool = entry->action ? wr_tool_find(app, entry->action) : -1;
    switch (entry->kind) {
    case WR_SEARCH_TOOL: return tool >= 0 ? app->registry->tools[tool]->icon : WR_ICON_BRUSH;
    case WR_SEARCH_ACTION: return WR_ICON_PLAY;
    case WR_SEARCH_ROW:
    case WR_SEARCH_CHOICE:
    case WR_SEARCH_OPTION: return WR_ICON_TUNE;
    case WR_SEARCH_GENERATOR: return WR_ICON_GRID;
    case WR_SEARCH_OPERATION: return WR_ICON_WAND;
    case WR_SEARCH_FILTER: return WR_ICON_COPY;
    case WR_SEARCH_MODEL: return WR_ICON_CUBE;
    case WR_SEARCH_MATERIAL: return WR_ICON_DROP;
    case WR_SEARCH_BRUSH: return WR_ICON_BRUSH;
    case WR_SEARCH_PAGE: return WR_ICON_HELP;
    case WR_SEARCH_COMMAND:
    case WR_SEARCH_KINDS: break;
    }
    return WR_ICON_CLOSED;
}

static SDL_Texture *picture_of(WrApp *app, const WrSearchEntry *entry)
{
    if (entry->kind == WR_SEARCH_BRUSH) return wr_thumb_of(app, entry->item, wr_gui_px(52));
    if (entry->pictures) return wr_picture_of(app, (WrThumbKind)(entry->pictures - 1), entry->item);
    return NULL;
}

/* After the frame, when the dialog is closed: panels can be opened then. text: number of the entry. */
static void open_entry(WrApp *app, const char *text)
{
    const int entry = atoi(text);
    if (entry < app->finder->index.entries.count)
        wr_search_index_open(app, &app->finder->index.entries.data[entry]);
}

static void choose(WrApp *app, int entry)
{
    WrFinder *finder = app->finder;
    const WrSearchEntry *e = &finder->index.entries.data[entry];
    char number[16];
    if (e->kind == WR_SEARCH_COMMAND) {
        snprintf(finder->text, sizeof finder->text, "%.60s ", e->action);
        finder->fill = finder->line = true;
        wr_app_redraw(app);
        return;
    }
    snprintf(number, sizeof number, "%d", entry);
    wr_dialog_close(app);
    wr_deferred(app, open_entry, number);
}

/* Icon or picture, name, place, and the keys of an action. */
static bool row(WrApp *app, const WrSearchEntry *entry, int i, bool chosen)
{
    char keys[32] = "";
    const WrAction *action =
        entry->action && !entry->row ? wr_action_find(app, entry->action) : NULL;
    const bool enabled = !action || wr_action_can(app, action);
    const WrRow r = wr_gui_row_begin(i, ROW_UNITS, chosen);
    if (chosen && i != app->finder->seen) wr_gui_row_see(); /* else the wheel scrolls */
    if (chosen) app->finder->seen = i;
    const double side = wr_gui_px(22), left = wr_gui_px(44);
    SDL_Texture *picture = picture_of(app, entry);
    wr_gui_row_set_cursor(wr_gui_px(picture ? 10 : 13), picture ? side : 0);
    if (picture) wr_gui_image(picture, side, side);
    else wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, icon_of(app, entry));
    if (action) wr_keys_label(app->keys, action->name, keys);
    const double wide = wr_gui_text_width(WR_FONT_SMALL, keys);
    const double right = wr_gui_row_width() - wide - wr_gui_px(wide > 0 ? 28 : 14);
    wr_gui_as_it_is(true); /* translated in the index */
    const double place = wr_gui_text_width(WR_FONT_SMALL, entry->where);
    double name = wr_gui_text_width(WR_FONT_TEXT, entry->label) + wr_gui_px(2);
    const double room = right - left;
    if (name > 0.6 * room && name + place > room)
        name = fmax(0.6 * room, room - place - wr_gui_px(12));
    wr_gui_row_set_cursor(left, 0);
    wr_gui_text_cut(WR_FONT_TEXT, enabled ? WR_COLOUR_TEXT : WR_COLOUR_FAINT, entry->label, name);
    wr_gui_row_set_cursor(left + name + wr_gui_px(12), 0);
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, entry->where,
                    fmax(0, room - name - wr_gui_px(12)));
    wr_gui_row_set_cursor(wr_gui_row_width() - wide - wr_gui_px(14), 0);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, keys);
    wr_gui_as_it_is(false);
    wr_gui_row_end();
    return r.clicked && enabled;
}

/* Help of the chosen row, always two lines high, so that the dialog keeps its size. */
static void help_line(const char *help)
{
    wr_gui_list_begin("help", 2.6 * wr_gui_line_height(WR_FONT_SMALL) + wr_gui_px(16));
    if (help) wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, help);
    wr_gui_list_end();
}

static void make_index(WrApp *app, const char *text)
{
    (void)text;
    wr_search_index_update(app);
}

void wr_search_open(WrApp *app)
{
    wr_search_index_update(app);
    wr_dialog_open(app, WR_DIALOG_SEARCH);
}

void wr_search_line(WrApp *app, const char *line)
{
    if (strlen(line) >= sizeof app->finder->text) {
        wr_app_say(app, "The line of this layer is too long to be shown here");
        return;
    }
    app->finder->fill = app->finder->line = true;
    strcpy(app->finder->text, line);
    wr_search_open(app);
}

static int step_chosen(WrFinder *finder, int count)
{
    if (wr_gui_key_pressed(SDL_SCANCODE_DOWN)) finder->chosen++;
    if (wr_gui_key_pressed(SDL_SCANCODE_UP)) finder->chosen--;
    finder->chosen = finder->chosen < 0 ? 0 : finder->chosen >= count ? count - 1 : finder->chosen;
    if (finder->chosen < 0) finder->chosen = 0;
    return finder->chosen;
}

/* Updates the results if the text or the index has changed. */
static void answer(WrFinder *finder)
{
    if (finder->found_at == finder->index.made && strcmp(finder->found_for, finder->text) == 0)
        return;
    finder->found_count =
        wr_search_index_find(&finder->index, finder->text, finder->found, WR_SEARCH_SHOWN);
    finder->found_at = finder->index.made;
    finder->seen = -1;
    memcpy(finder->found_for, finder->text, sizeof finder->found_for);
}

/* The entry that was chosen, or -1. */
static int results(WrApp *app, bool enter)
{
    WrFinder *finder = app->finder;
    const WrSearchEntry *entries = finder->index.entries.data;
    answer(finder);
    const WrSearchHit *found = finder->found;
    const int count = finder->found_count;
    const int chosen = step_chosen(finder, count);
    int go = -1;
    wr_gui_list_begin("found", ROW_UNITS * ROWS * wr_gui_scale() + wr_gui_px(12));
    wr_gui_space(-6);
    for (int i = 0; i < count; i++)
        if (row(app, &entries[found[i].entry], i, i == chosen)) go = found[i].entry;
    if (count == 0) wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "Nothing matches these words.");
    wr_gui_list_end();
    help_line(count > 0 ? entries[found[chosen].entry].help : NULL);
    /* Return with an empty field must not run the first row. */
    finder->empty = enter && !finder->text[0] && chosen == 0;
    return enter && count > 0 && !finder->empty ? found[chosen].entry : go;
}

void wr_dialog_search(WrApp *app)
{
    WrFinder *finder = app->finder;
    if (app->dialog->fresh && !finder->fill) {
        finder->text[0] = '\0';
        finder->line = finder->empty = false;
        finder->chosen = 0;
    }
    if (finder->index.fixed == 0 && !wr_deferred_waits(app, make_index))
        wr_deferred(app, make_index, ""); /* opened without the action */
    if (!wr_gui_dialog_begin("Search", 600)) return;
    char before[sizeof finder->text];
    memcpy(before, finder->text, sizeof before);
    bool enter = wr_gui_text_field("##find", 0, finder->text, sizeof finder->text,
                                   app->dialog->fresh || finder->fill || finder->empty);
    const WrCommand *command = typed(finder->text);
    finder->fill = false;
    finder->line = command && (finder->line || is_line(finder->text));
    if (strcmp(before, finder->text) != 0) finder->chosen = 0;
    int go = -1;
    if (command && finder->line) command_line(app, command, enter);
    else go = results(app, enter);
    if (go >= 0) choose(app, go);
    else if (!app->dialog->fresh && wr_gui_escape_pressed()) wr_dialog_close(app);
    wr_gui_dialog_end();
}

/* ---- the index before it is needed ---- */

#define AHEAD_SECONDS 2.0 /* after the start */

static double next_time(const WrApp *app)
{
    const bool made = app->finder->index.fixed > 0 || app->started_at <= 0;
    return made ? 0.0 : fmax(app->started_at, app->input_at) + AHEAD_SECONDS;
}

/* The first opening would take 50 ms or more: the guide's pages and the brushes are read. */
static void make_ahead(WrApp *app)
{
    const double due = next_time(app);
    if (due > 0.0 && wr_clock_seconds() >= due) wr_search_index_update(app);
}

const WrPart wr_part_search = { .update = make_ahead, .next_time = next_time };
