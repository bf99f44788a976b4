/* Dialog of starters: finished documents to begin with, as pictures. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/picture_grid.h"

#include "ui/canvas/tools/preset_browser.h"

#define TILE 130 /* units */

static void starter_item(const WrApp *app, int i, WrPictureItem *out)
{
    const WrScript *starter = &app->shelf->starters.scripts.data[i];
    out->title = starter->title, out->help = starter->words;
    out->picture = starter->picture;
}

void wr_dialog_starters(WrApp *app)
{
    const WrScriptList *list = &app->shelf->starters;
    wr_script_list_find(&app->shelf->starters, "samples/starters");
    if (!wr_gui_dialog_begin("New from a starter", 4 * (TILE + 6) + 50)) return;
    const int pressed = wr_picture_grid(app, WR_THUMB_STARTER, "Starters", list->scripts.count,
                                        TILE, -1, starter_item);
    if (!list->scripts.count)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            "The starters were not found: set WRINKLE_DATA to the folder that "
                            "holds them, or install the program.");
    wr_dialog_close_button(app, "Cancel");
    if (pressed >= 0) {
        wr_dialog_close(app);
        wr_app_open_path(app, list->scripts.data[pressed].path);
    }
    wr_gui_dialog_end();
}
