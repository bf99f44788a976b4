/* Choice of the stamp tool's picture. */
#include "ui/state/action.h"
#include "ui/state/action_list.h"
#include "ui/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/tools/preset_browser.h"
#include "ui/tools/stamps.h"
#include "ui/tools/thumbs.h"
#include "ui/tools/tool_stamp.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/text.h"

#include <SDL.h>
#include <string.h>

#define TILE_UNITS 64

/* Readable form of a file name: "wood-grain_2.png" is Wood grain 2. */
static void name_of(const char *path, WrText *out)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    wr_text_clear(out);
    for (size_t i = 0; i < length; i++) {
        char c = name[i] == '-' || name[i] == '_' ? ' ' : name[i];
        wr_text_addf(out, "%c", i == 0 && c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    }
}

static int index_of(const WrApp *app, const char *path)
{
    for (int i = 0; path && i < app->stamp->stamps.count; i++)
        if (strcmp(app->stamp->stamps.data[i], path) == 0) return i;
    return -1;
}

/* Add a file opened by the user to the list. */
static int offer(WrApp *app, const char *path)
{
    int index = index_of(app, path);
    if (index >= 0 || !path) return index;
    wr_array_push(&app->stamp->stamps, wr_strdup(path));
    return app->stamp->stamps.count - 1;
}

static void all(WrApp *app)
{
    int columns = 6, count = app->stamp->stamps.count, chosen = index_of(app, app->stamp->tip_path);
    double side = wr_gui_px(TILE_UNITS);
    int rows = (count + 1 + columns - 1) / columns;
    WrText name = { 0 };
    wr_gui_width_at_least(columns * (TILE_UNITS + 4) + 24);
    wr_gui_list_begin("stamps", (rows < 5 ? rows : 5) * (side + wr_gui_px(6)) + wr_gui_px(16));
    for (int i = -1; i < count; i++) {
        if ((i + 1) % columns) wr_gui_same_line(4);
        else if (i >= 0) wr_gui_space(-4);
        wr_gui_push_id(i + 1);
        SDL_Texture *picture = !wr_gui_will_see(side) ? NULL
                               : i < 0                ? wr_thumb_of(app, -1, wr_gui_px(52))
                                                      : wr_thumb_of_stamp(app, i, wr_gui_px(52));
        bool pressed = wr_gui_tile("stamp", picture, side, i == chosen, false) == 1;
        wr_gui_as_it_is(i >= 0);
        if (i >= 0) name_of(app->stamp->stamps.data[i], &name);
        wr_gui_tip(i < 0 ? "The round brush" : wr_text_get(&name));
        wr_gui_as_it_is(false);
        wr_gui_pop_id();
        if (pressed) wr_stamp_choose(app, i < 0 ? NULL : app->stamp->stamps.data[i]);
    }
    wr_gui_list_end();
    wr_text_fini(&name);
}

void wr_stamp_picker(WrApp *app)
{
    wr_stamps_find(app);
    int chosen = offer(app, app->stamp->tip_path);
    SDL_Texture *picture = chosen < 0 ? wr_thumb_of(app, -1, wr_gui_px(52))
                                      : wr_thumb_of_stamp(app, chosen, wr_gui_px(52));
    wr_gui_same_line(12);
    wr_gui_centre(wr_gui_px(32));
    if (wr_gui_tile("picture", picture, wr_gui_px(32), false, false)) {
        wr_gui_popup_open("stamps");
        app->redraw = 4; /* a list in a popup needs several frames for its layout */
    }
    wr_gui_centre_end(wr_gui_px(32));
    wr_gui_tip("Click to choose a picture; the wheel sizes the stamp");
    wr_gui_same_line(6);
    wr_gui_centre(wr_gui_px(28));
    if (wr_gui_glyph("open", WR_ICON_FOLDER, 28, WR_COLOUR_LABEL))
        wr_action_run(app, WR_ACT(stamp_open));
    wr_gui_centre_end(wr_gui_px(28));
    wr_gui_tip("Open a picture, a .gbr or a .gih as a stamp");
    if (!wr_gui_popup_begin("stamps")) return;
    all(app);
    wr_gui_popup_end();
}
