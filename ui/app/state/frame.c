/* Services of the window for all components: redraw, layout, scale, keys. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "system/path.h"

#include <SDL.h>
#include <stdlib.h>
#include <string.h>

void wr_app_redraw(WrApp *app)
{
    bool held = app->hand->grab != WR_GRAB_NONE;
    /* Widgets need a second frame to settle; not while the pointer drags in a view. */
    if (!held) app->redraw = 2;
    else if (app->redraw < 1) app->redraw = 1;
}

void wr_app_make_layout(WrApp *app)
{
    SDL_GetRendererOutputSize(app->renderer, &app->width, &app->height);
    WrLayoutInput in = { .width = app->width,
                         .height = app->height,
                         .menu_height = app->menu_height,
                         .scale = wr_gui_scale(),
                         .divider = app->settings->divider,
                         .views = app->settings->views,
                         .tools = app->registry->tool_count + WR_STRIP_MORE,
                         .panels = app->settings->panels,
                         .lower = app->settings->lower,
                         .side_width = app->settings->side_width,
                         .side_left = app->settings->side_left,
                         .hide_strip = app->settings->hide_strip,
                         .hide_options = app->settings->hide_options };
    *app->layout = wr_layout_make(&in);
}

double wr_app_wanted_scale(const WrApp *app)
{
    const char *forced = getenv("WRINKLE_SCALE");
    double scale;
    if (forced && wr_number_parse(forced, strlen(forced), &scale) && scale >= 0.75 && scale <= 3.0)
        return scale;
    return app->settings->scale > 0.0 ? app->settings->scale : app->display_scale;
}

void wr_app_set_scale(WrApp *app, double setting)
{
    app->settings->scale = setting;
    wr_app_redraw(app);
}

/* Load the built-in keys, the chosen map, and the user's own file. */
void wr_app_read_keys(WrApp *app)
{
    WrError map_err;
    wr_keys_free(app->keys);
    app->keys = wr_keys_new();
    int map = app->settings->key_map;
    if (map > 0 && map < WR_KEY_MAPS && !wr_keys_read(app->keys, wr_key_maps[map].text, &map_err))
        wr_app_fail(app, &map_err);
    if (app->latency) return; /* only the built-in keys */
    char *path = wr_config_path("keys.conf"), *text = NULL;
    size_t length;
    WrError err;
    if (path && wr_path_can_read(path) && wr_file_read(path, 1 << 16, &text, &length, &err) &&
        !wr_keys_read(app->keys, text, &err)) {
        wr_error_prefix(&err, "%s: ", path);
        wr_app_fail(app, &err);
    }
    wr_free(text);
    wr_free(path);
}
