/* Question for the use of dropped pictures. One click, or Enter for the likely one. */
#include "ui/panels/panels.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/dropped_files.h"
#include "ui/app/state/messages.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/canvas/tools/tool_transform.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/text.h"
#include "command/command_line.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

static void as_layer(WrApp *app, const char *path)
{
    WrError err;
    if (!wr_transform_paste(app, path, NULL, &err)) wr_app_fail(app, &err);
}

static void as_stamp(WrApp *app, const char *path)
{
    const int tool = wr_tool_find(app, WR_ACT(stamp));
    if (app->tool != tool) wr_tool_choose(app, tool);
    wr_stamp_file_chosen(app, path);
}

/* A generator layer of the heights that have these normals. */
static void as_normals(WrApp *app, const char *path)
{
    WrText from = { 0 }, line = { 0 };
    wr_text_add(&from, "picture normals ");
    wr_text_add_word(&from, path);
    wr_text_add(&line, "layer add ");
    wr_text_add_file_name(&line, path);
    wr_text_add(&line, " from=");
    wr_text_add_word(&line, wr_text_get(&from));
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&from);
    wr_text_fini(&line);
}

WR_ROWS(uses);
static const struct {
    const char *label, *help;
    void (*take)(WrApp *app, const char *path);
    bool each; /* of several files, else of the first one */
} uses[] = {
    [WR_ROW(WR_DROP_LAYER)] = { "New layer", "White is high; then drag it into place", as_layer,
                                true },
    [WR_ROW(WR_DROP_STAMP)] = { "Stamp", "For the stamp tool", as_stamp, true },
    [WR_ROW(WR_DROP_COLOUR)] = { "Colour", "Colours the object, over u and v", wr_map_take_colour,
                                 false },
    [WR_ROW(WR_DROP_NORMALS)] = { "Normal map", "Adds the heights of the normal map as a layer",
                                  as_normals, true },
    [WR_ROW(WR_DROP_SURROUND)] = { "Environment", "An HDRI that lights the scene from all sides",
                                   wr_light_take_surround, false },
    [WR_ROW(WR_DROP_OPEN)] = { "New document", "Opens the picture as a new document",
                               wr_app_open_path, false },
};
WR_ROWS_END(uses, WR_DROP_USES);

static void take(WrApp *app, const char *text)
{
    const int use = text[0] - '0';
    WrDroppedFiles *dropped = app->dropped, files = *dropped;
    *dropped = (WrDroppedFiles){ .width = 0 };
    for (int i = 0; i < (uses[use].each ? files.paths.count : 1); i++)
        uses[use].take(app, files.paths.data[i]);
    wr_dropped_free(&files);
}

static void picture(WrApp *app)
{
    const WrDroppedFiles *d = app->dropped;
    SDL_Texture **texture = &app->dropped_picture;
    if (app->dialog->fresh || !*texture) {
        wr_panel_drop_forget(app);
        *texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STATIC,
                                     d->shown_w, d->shown_h);
        if (*texture) wr_gui_sdl_update(*texture, NULL, d->rgb, 3 * d->shown_w);
    }
    if (*texture) wr_gui_image(*texture, wr_gui_px(d->shown_w), wr_gui_px(d->shown_h));
}

void wr_panel_drop_forget(WrApp *app)
{
    if (app->dropped_picture) SDL_DestroyTexture(app->dropped_picture);
    app->dropped_picture = NULL;
}

static void describe(const WrDroppedFiles *d)
{
    char text[300];
    const char *path = d->paths.data[0], *slash = strrchr(path, '/');
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, slash ? slash + 1 : path, wr_gui_available());
    snprintf(text, sizeof text, "%d \xc3\x97 %d", d->width, d->height);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    if (d->paths.count > 1) {
        snprintf(text, sizeof text, wr_words("and %d more"), d->paths.count - 1);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    }
    wr_gui_as_it_is(false);
}

void wr_dialog_drop(WrApp *app)
{
    const WrDroppedFiles *d = app->dropped;
    int use = -1;
    if (d->paths.count == 0) {
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin("Use the picture as", 480)) return;
    picture(app);
    describe(d);
    wr_gui_space(6);
    for (int i = 0; i < WR_DROP_USES; i++) {
        if (wr_gui_button(uses[i].label, i == (int)d->guess)) use = i;
        wr_gui_same_line(10);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, uses[i].help);
    }
    const bool key = !app->dialog->fresh;
    if (key && wr_gui_return_pressed()) use = (int)d->guess;
    wr_gui_space(6);
    const bool cancel = wr_gui_button("Cancel", false) || (key && wr_gui_escape_pressed());
    wr_gui_dialog_end();
    if (use < 0 && !cancel) return;
    wr_dialog_close(app);
    if (cancel) wr_dropped_free(app->dropped);
    else wr_deferred(app, take, (const char[]){ (char)('0' + use), '\0' });
}
