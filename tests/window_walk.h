/* window_walk.h - a window without a display that is led through all that it can show: its tabs, dialogs, tools,
   generators and kinds of things, each for a picture or two that nobody draws. After test.h. */
#pragma once
#include "test_window.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/rows.h"
#include "base/text.h"
#include "brush/preset.h"
#include "command/session.h"
#include "field/ops.h"
#include "generate/generator.h"
#include "surface/surface.h"

#include "ui/accuracy/accuracy.h"
#include "ui/app/app.h"
#include "ui/app/canvas_view.h"
#include "ui/app/loop.h"
#include "ui/app/store.h"
#include "ui/desk/action.h"
#include "ui/desk/app_options.h"
#include "ui/desk/desk.h"
#include "ui/desk/dialog.h"
#include "ui/desk/document.h"
#include "ui/desk/hand.h"
#include "ui/desk/layout.h"
#include "ui/desk/replace.h"
#include "ui/desk/roster.h"
#include "ui/desk/session_view.h"
#include "ui/desk/settings.h"
#include "ui/generate/generate_hand.h"
#include "ui/gui/gui.h"
#include "ui/gui/words.h"
#include "ui/jobs/files.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/panels/panel_status.h"
#include "ui/panels/panels.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/tools/shelf.h"
#include "ui/tools/tool.h"

#include <SDL.h>

typedef struct Walk {
    WrApp *app;
    WrPool *pool;
    WrSession *session;
    WrAppOptions options;
    char where[120];                  /* what is shown */
    void (*shown)(struct Walk *walk); /* is told of each place; NULL: a picture of it is made */
} Walk;

static inline void walk_run(Walk *walk, const char *line)
{
    WrError err = { "" };
    if (!wr_session_run(walk->session, line, &err)) fail_msg("%s: %s", line, err.text);
}

/* A document that has something of everything, in a window that speaks a language. */
static inline void walk_open(Walk *walk, const char *language)
{
    WrError err = { "" };
    unsetenv("LC_ALL");
    setenv("LC_MESSAGES", "en_GB.UTF-8", 1);
    setenv("LANGUAGE", language, 1);
    memset(walk, 0, sizeof *walk);
    walk->pool = wr_pool_new(1);
    const WrSessionOptions how = { .pool = walk->pool, .outputs = true };
    walk->session = wr_session_new(&how);
    static const char *const lines[] = { "table 64x48", "surface torus", "layer add",
                                         "pattern bricks",
                                         "layer mask 2 from=height low=0.2 high=0.9" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) walk_run(walk, lines[i]);
    walk->options = (WrAppOptions){
        .session = walk->session, .threads = 1, .file_given = true, .width = 1280, .height = 800
    };
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    walk->app = wr_store_new();
    walk->app->options = &walk->options;
    walk->app->session = walk->session;
    if (!wr_app_begin(walk->app, &err)) fail_msg("%s", err.text);
    wr_gui_tells_all = true;
    walk->app->hints = walk->app->file->starter = true; /* as in the first window */
    walk->app->hand->on_canvas = true;
}

static inline void walk_close(Walk *walk)
{
    wr_gui_tells_all = false;
    wr_app_end(walk->app);
    wr_free(walk->app);
    wr_session_free(walk->session);
    wr_pool_free(walk->pool);
}

/* All panels say what they hold. */
static inline void walk_frame(Walk *walk)
{
    WrApp *app = walk->app;
    int width, height;
    SDL_GetRendererOutputSize(app->renderer, &width, &height);
    wr_gui_frame_begin(app->gui, width, height, 0.02);
    wr_app_draw_parts(app, false);
    wr_gui_frame_end(app->gui);
}

static inline void walk_show(Walk *walk, const char *format, const char *what)
{
    snprintf(walk->where, sizeof walk->where, format, what);
    if (walk->shown) walk->shown(walk);
    else walk_frame(walk);
}

static inline void walk_tabs(Walk *walk)
{
    WrApp *app = walk->app;
    for (int i = 0; i <= app->roster->tab_count; i++) {
        app->settings->tab = i;
        app->accuracy->inspector.shown = i % 2 == 1;
        walk_show(walk, "tab %s",
                  i < app->roster->tab_count ? app->roster->tabs[i].label : "Layers");
    }
    app->settings->tab = 0;
}

static inline void walk_tools(Walk *walk)
{
    for (int i = 0; i < walk->app->roster->tool_count; i++) {
        wr_tool_choose(walk->app, i);
        walk_show(walk, "tool %s", walk->app->roster->tools[i]->action);
    }
    wr_tool_choose(walk->app, 0);
}

/* Each by the action that opens it where there is one, so that it has what it needs. */
static inline void walk_dialogs(Walk *walk)
{
    static const char *const actions[] = {
        "new",          "open",        "save_as",       "export",         "maps",
        "render",       "film",        "search",        "preferences",    "symmetry",
        "preset_save",  "select_grow", "select_shrink", "select_feather", "select_height",
        "select_slope", "mask_height", "mask_slope",    "table_size",     "fill",
        "grid",         "hard_cases",  "tablet",        "about",          "help",
        "import",       NULL
    };
    WrApp *app = walk->app;
    for (const char *const *a = actions; *a; a++) {
        wr_action_run(app, *a);
        walk_show(walk, "dialog of %s", *a);
        walk_frame(walk);
        if (app->dialog->now != WR_DIALOG_NONE) wr_dialog_close(app);
    }
    for (const WrOpInfo *op = wr_ops; op->name; op++) {
        char name[64];
        snprintf(name, sizeof name, "adjust_%.50s", op->name);
        wr_action_run(app, name);
        walk_show(walk, "dialog of %s", name);
        walk_frame(walk); /* it has measured itself */
        if (app->dialog->now != WR_DIALOG_NONE) wr_dialog_close(app);
    }
    const WrLibrary *library = wr_shelf_library(app); /* ours come first; each has curves */
    if (wr_library_count(library) > 0) wr_shelf_choose(app, wr_library_entry(library, 0)->id);
    assert_non_null(app->shelf->preset);
    walk_show(walk, "preset %s", "soft");
    for (int i = 0; i < wr_preset_setting_count(); i++) {
        if (wr_preset_setting(i)->use == WR_SETTING_IGNORED) continue;
        wr_dialog_dynamics_open(app, i);
        walk_show(walk, "curves of %s", wr_preset_setting(i)->name);
    }
    wr_dialog_close(app);
    wr_shelf_choose(app, WR_ROUND);
    wr_dialog_open(app, WR_DIALOG_UNSAVED);
    walk_show(walk, "dialog %s", "unsaved");
    wr_dialog_close(app);
}

static inline void walk_generators(Walk *walk)
{
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            char name[WR_GENERATE_ACTION];
            wr_generate_action(g, name);
            wr_action_run(walk->app, name);
            walk_show(walk, "generator %s", name);
        }
    wr_tool_choose(walk->app, 0);
}

static inline void walk_surfaces(Walk *walk)
{
    wr_tab_show(walk->app, "Scene");
    for (int i = 0; i < WR_SURFACE_COUNT; i++) {
        WrError err;
        char line[64];
        snprintf(line, sizeof line, "surface %s", wr_surfaces[i]->name);
        wr_session_run(walk->session, line, &err); /* those that need a file stay as they were */
        walk_show(walk, "surface %s", wr_surfaces[i]->name);
    }
}

static inline void walk_all(Walk *walk)
{
    walk_tabs(walk);
    walk_tools(walk);
    walk_dialogs(walk);
    walk_generators(walk);
    walk_surfaces(walk);
}
