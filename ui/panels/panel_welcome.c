/* Dialogs of the first start: three beginnings, and a tour of the window. */
#include "ui/app/state/app_options.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/line.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/panels/panels.h"
#include "ui/panels/picture_grid.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document_file.h"
#include "system/path.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define TILE 170 /* units */

/* Only without a settings file, which the end of the first session writes, and without a document of the command line. */
void wr_welcome_open(WrApp *app)
{
    char *path = wr_config_path("window.conf");
    const bool first = path && !wr_path_is_there(path);
    wr_free(path);
    if (first && app->file->starter && app->dialog->now == WR_DIALOG_NONE)
        wr_dialog_open(app, WR_DIALOG_WELCOME);
}

/* ---- beginnings ---- */

static const char *const beginnings[] = { "bricks", "coin" };

/* The starter that beginning i opens. NULL: it opens a blank table, or the starter is missing. */
static const WrScript *starter_of(const WrApp *app, int i)
{
    if (i >= (int)WR_LENGTH(beginnings)) return NULL;
    const WrScriptList *list = &app->shelf->starters;
    WrText name = { 0 };
    const WrScript *found = NULL;
    wr_text_addf(&name, "/%s.wrinkle", beginnings[i]);
    for (int k = 0; k < list->scripts.count && !found; k++)
        if (strstr(list->scripts.data[k].path, wr_text_get(&name))) found = &list->scripts.data[k];
    wr_text_fini(&name);
    return found;
}

static void beginning(const WrApp *app, int i, WrPictureItem *out)
{
    const WrScript *starter = starter_of(app, i);
    if (starter) {
        out->title = starter->title, out->help = starter->words;
        out->picture = starter->picture;
        return;
    }
    out->title = "Blank", out->help = "an empty table on a sphere";
    wr_text_add(&out->lines, "table 16x16\nsurface sphere\ncamera fill aspect=1\n"
                             "dials aa=supersample samples=3\n");
}

static void begin_with(WrApp *app, int i)
{
    wr_dialog_close(app);
    const WrScript *starter = starter_of(app, i);
    if (starter) {
        wr_app_open_path(app, starter->path);
        return;
    }
    WrText lines = { 0 };
    const WrNewForm *form = &app->forms->fresh;
    wr_new_document_lines(form, wr_document_wrap_name(form->wrap), &lines);
    wr_deferred(app, wr_app_new_of, wr_text_get(&lines));
    wr_text_fini(&lines);
}

void wr_dialog_welcome(WrApp *app)
{
    wr_script_list_find(&app->shelf->starters, "samples/starters");
    if (!wr_gui_dialog_begin("Welcome to Wrinkle", 3 * (TILE + 6) + 50)) return;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT,
                        "Paint heights on the canvas at the left: the surface at the right shows "
                        "them as relief. Start with:");
    const bool there = starter_of(app, 0) && starter_of(app, 1);
    const int pressed =
        there ? wr_picture_grid(app, WR_THUMB_WELCOME, "Begin with", 3, TILE, -1, beginning) : -1;
    wr_gui_space(4);
    const bool tour = wr_gui_button("Take the tour", false);
    wr_gui_tip("Show the parts of the window in one minute");
    wr_gui_same_line(6);
    wr_dialog_close_button(app, "Skip");
    if (pressed >= 0) begin_with(app, pressed);
    else if (tour) {
        wr_dialog_close(app);
        wr_dialog_open(app, WR_DIALOG_TOUR);
    }
    wr_gui_dialog_end();
}

/* ---- the tour ---- */

typedef struct Stop {
    size_t rect; /* offset of the shown part in WrLayout */
    const char *words;
} Stop;

#define PART(member) offsetof(WrLayout, member)

static const Stop stops[] = {
    { PART(canvas), "The canvas is the table of heights. Drag to paint; a stroke across an edge "
                    "continues on the opposite side." },
    { PART(patch), "The patch shows the heights on a lit surface. Drag to turn it; the wheel "
                   "zooms." },
    { PART(strip), "The tools. Rest the pointer on one to read its name and key. B is the brush; "
                   "[ and ] change its size." },
    { PART(panel), "The tabs: brushes, patterns and text to generate, the scene with its surface, "
                   "material and lights." },
    { PART(lower), "The layers. Each has a blend, a mask and an eye; generated layers keep their "
                   "values." },
    { PART(status), "The status line has hints and errors. Ctrl+Z undoes, F1 opens the guide, and "
                    "File / Export maps writes height and normal maps." }
};

static const SDL_Rect *part_of(const WrApp *app)
{
    const char *layout = (const char *)app->layout;
    return (const SDL_Rect *)(const void *)(layout + stops[app->dialog->stop].rect);
}

void wr_dialog_tour(WrApp *app)
{
    const int count = WR_LENGTH(stops), wide = wr_gui_px(380), tall = wr_gui_px(170);
    const SDL_Rect *canvas = &app->layout->canvas;
    int *stop = &app->dialog->stop;
    char text[32];
    if (app->dialog->fresh) *stop = 0;
    if (!wr_gui_dialog_begin_at("Tour", (SDL_Rect){ canvas->x + wr_gui_px(16),
                                                    canvas->y + (canvas->h - tall) / 2, wide, 0 }))
        return;
    if (part_of(app)->w > 0) wr_gui_spotlight(part_of(app));
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, stops[*stop].words);
    snprintf(text, sizeof text, wr_words("%d of %d"), *stop + 1, count);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
    const int shown = *stop;
    wr_gui_space(4);
    wr_gui_disable(*stop == 0);
    if (wr_gui_button("Back##tour", false)) --*stop;
    wr_gui_disable_end();
    wr_gui_same_line(6);
    const bool last = *stop == count - 1;
    const bool key = !app->dialog->fresh && wr_gui_return_pressed();
    const bool next = wr_gui_button(last ? "Start painting" : "Next##tour", true) || key;
    wr_gui_same_line(6);
    const bool ends =
        wr_gui_button("End the tour", false) || (!app->dialog->fresh && wr_gui_escape_pressed());
    if (ends || (next && last)) wr_dialog_close(app);
    else if (next) ++*stop;
    if (*stop != shown) wr_app_redraw(app); /* the frame is drawn before the buttons are read */
    wr_gui_dialog_end();
}
