/* Dialog of starters: finished documents to begin with, as pictures. Each is a script in starters/, with a picture of
   the same name beside it; its first line is "# Title - description". */
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/picture_grid.h"

#include "base/array.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

#define TILE 130 /* units */

struct WrStarterList {
    struct {
        char *path, *title, *help; /* owned */
    } row[WR_PICTURES_MAX];
    int count;
};

/* The title and the description in a script's first line; the caller frees both. */
static void read_title(const char *path, char **title, char **help)
{
    char line[256] = "";
    const size_t got = wr_file_peek(path, line, sizeof line - 1);
    line[got] = '\0';
    line[strcspn(line, "\n")] = '\0';
    char *start = line + strspn(line, "# "), *dash = strstr(start, " - ");
    *help = wr_strdup(dash ? dash + 3 : "");
    if (dash) *dash = '\0';
    *title = wr_strdup(start);
}

static int by_path(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void list_folder(WrStarterList *list, const char *path)
{
    WrFolder *folder = wr_folder_open(path);
    const char *name;
    char ending[16];
    while (folder && list->count < WR_PICTURES_MAX && (name = wr_folder_next(folder)) != NULL)
        if (strcmp(wr_path_ending(name, ending), "wrinkle") == 0)
            list->row[list->count++].path = wr_path_join(path, name);
    wr_folder_close(folder);
    qsort(list->row, (size_t)list->count, sizeof *list->row, by_path);
    for (int i = 0; i < list->count; i++)
        read_title(list->row[i].path, &list->row[i].title, &list->row[i].help);
}

static const WrStarterList *starters_of(WrApp *app)
{
    WrText path = { 0 };
    if (!app->starters) {
        app->starters = wr_alloc(1, sizeof *app->starters);
        if (wr_data_find("starters", &path)) list_folder(app->starters, wr_text_get(&path));
        wr_text_fini(&path);
    }
    return app->starters;
}

void wr_starters_free(WrApp *app)
{
    for (int i = 0; app->starters && i < app->starters->count; i++) {
        wr_free(app->starters->row[i].path);
        wr_free(app->starters->row[i].title);
        wr_free(app->starters->row[i].help);
    }
    wr_free(app->starters);
    app->starters = NULL;
}

static void starter_item(const WrApp *app, int i, WrPictureItem *out)
{
    const char *path = app->starters->row[i].path;
    out->title = app->starters->row[i].title, out->help = app->starters->row[i].help;
    wr_text_add_n(&out->path, path, strlen(path) - strlen("wrinkle"));
    wr_text_add(&out->path, "jpg");
}

void wr_dialog_starters(WrApp *app)
{
    const WrStarterList *list = starters_of(app);
    if (!wr_gui_dialog_begin("New from a starter", 4 * (TILE + 6) + 50)) return;
    const int pressed =
        wr_picture_grid(app, WR_PICTURES_STARTERS, "Starters", list->count, TILE, -1, starter_item);
    if (!list->count)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            "The starters were not found: set WRINKLE_DATA to the folder that "
                            "holds them, or install the program.");
    wr_dialog_close_button(app, "Cancel");
    if (pressed >= 0) {
        wr_dialog_close(app);
        wr_app_open_path(app, list->row[pressed].path);
    }
    wr_gui_dialog_end();
}
