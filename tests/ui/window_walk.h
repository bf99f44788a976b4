/* window_walk.h - a walk through everything a window without a display can show: tabs, dialogs, tools, generators,
   kinds of objects, each for one or two frames that are not drawn. Include after test.h. */
#pragma once
#include "window.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "brush/preset.h"
#include "command/session.h"
#include "field/ops.h"
#include "generate/generator.h"
#include "surface/surface.h"

#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/app.h"
#include "ui/app/canvas_view.h"
#include "ui/app/loop.h"
#include "ui/app/state/action.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/dropped_files.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/overwrite_question.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/panels/panel_history.h"
#include "ui/app/state/background_command.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_status.h"
#include "ui/panels/panels.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/tool.h"

#include <SDL.h>
#include <sys/wait.h>
#include <unistd.h>

/* Opens place `which` of a kind; false past the last, or if it does not exist. */
typedef struct Walk Walk;
typedef bool WalkOpen(Walk *walk, int which);

struct Walk {
    WrApp *app;
    WrPool *pool;
    WrSession *session;
    WrAppOptions options;
    char where[120]; /* name of the open place */
    WalkOpen *open;  /* opens it again: open(walk, which) */
    int which;
    void (*shown)(Walk *walk); /* called at each place; NULL: a frame is made */
};

static inline void walk_run(Walk *walk, const char *line)
{
    WrError err = { "" };
    if (!wr_session_run(walk->session, line, &err)) fail_msg("%s: %s", line, err.text);
}

/* A document that uses all features. */
static inline void walk_fill(Walk *walk)
{
    static const char *const lines[] = { "table 64x48", "surface torus", "layer add",
                                         "pattern bricks",
                                         "layer mask 2 from=height low=0.2 high=0.9" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) walk_run(walk, lines[i]);
}

/* That document in a window with the given language. */
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
    walk_fill(walk);
    walk->options = (WrAppOptions){
        .session = walk->session, .threads = 1, .file_given = true, .width = 1280, .height = 800
    };
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    walk->app = wr_store_new();
    walk->app->options = &walk->options;
    walk->app->session = walk->session;
    if (!wr_app_begin(walk->app, &err)) fail_msg("%s", err.text);
    wr_gui_reports_all = wr_gui_folds_open = true;
    walk->app->hints = walk->app->file->starter = true; /* as at the first start */
    walk->app->hand->on_canvas = true;
}

static inline void walk_close(Walk *walk)
{
    wr_gui_reports_all = wr_gui_folds_open = false;
    wr_app_end(walk->app);
    wr_free(walk->app);
    wr_session_free(walk->session);
    wr_pool_free(walk->pool);
}

/* All panels show their content. */
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

/* All places of a kind, in turn. */
static inline void walk_each(Walk *walk, WalkOpen *open, void (*close)(Walk *walk))
{
    walk->open = open;
    for (walk->which = 0; open(walk, walk->which); walk->which++) {
        if (walk->shown) walk->shown(walk);
        else walk_frame(walk);
        if (close) close(walk);
    }
    walk->open = NULL;
}

static inline bool walk_name(Walk *walk, const char *format, const char *what)
{
    snprintf(walk->where, sizeof walk->where, format, what);
    return true;
}

static inline void walk_point(Walk *walk, double x, double y)
{
    wr_gui_event(walk->app->gui,
                 &(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = (int)x, .y = (int)y } });
    walk_frame(walk);
}

static inline void walk_button(Walk *walk, Uint8 which, bool down, double x, double y)
{
    wr_gui_event(walk->app->gui,
                 &(SDL_Event){ .button = { .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                           .button = which,
                                           .state = down ? SDL_PRESSED : SDL_RELEASED,
                                           .clicks = 1,
                                           .x = (int)x,
                                           .y = (int)y } });
    walk_frame(walk);
}

static inline bool walk_open_tab(Walk *walk, int which)
{
    WrApp *app = walk->app;
    if (which >= app->registry->tab_count) return false;
    app->settings->tab = which;
    app->settings->inspector = which % 2 == 1;
    return walk_name(walk, "tab %s", app->registry->tabs[which].label);
}

static inline void walk_tabs(Walk *walk)
{
    walk_each(walk, walk_open_tab, NULL);
    walk->app->settings->tab = 0;
}

static inline bool walk_open_tool(Walk *walk, int which)
{
    if (which >= walk->app->registry->tool_count) return false;
    wr_tool_choose(walk->app, which);
    return walk_name(walk, "tool %s", walk->app->registry->tools[which]->action);
}

static inline void walk_tools(Walk *walk)
{
    walk_each(walk, walk_open_tool, NULL);
    wr_tool_choose(walk->app, 0);
}

static inline void walk_close_dialog(Walk *walk)
{
    walk_frame(walk); /* its layout is measured */
    if (walk->app->dialog->now != WR_DIALOG_NONE) wr_dialog_close(walk->app);
    wr_app_try_end(walk->app); /* as by its Cancel */
}

/* True for actions that open a dialog: their labels end with dots, but for three. */
static inline bool walk_opens_dialog(const WrAction *action)
{
    static const char *const others[] = { "new", "help", "about" };
    const size_t length = strlen(action->label);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcmp(action->name, others[i]) == 0) return true;
    return length > 3 && strcmp(action->label + length - 3, "...") == 0;
}

/* Open each dialog by its action, so that it has its data. */
static inline bool walk_open_dialog(Walk *walk, int which)
{
    for (const WrAction *a = walk->app->registry->actions; a->name; a++) {
        if (!walk_opens_dialog(a) || which-- > 0) continue;
        walk->app->file->clean_revision = wr_session_revision(walk->session);
        wr_action_run(walk->app, a->name);
        return walk_name(walk, "dialog of %s", a->name);
    }
    return false;
}

static inline bool walk_open_adjust(Walk *walk, int which)
{
    char name[64];
    if (!wr_ops[which].name) return false;
    snprintf(name, sizeof name, "adjust_%.50s", wr_ops[which].name);
    wr_action_run(walk->app, name);
    return walk_name(walk, "dialog of %s", name);
}

static inline bool walk_open_preset(Walk *walk, int which)
{
    return which == 0 && walk_name(walk, "preset %s", "soft");
}

static inline bool walk_open_curves(Walk *walk, int which)
{
    int i = 0; /* of the used ones */
    for (; i < wr_preset_setting_count(); i++)
        if (wr_preset_setting(i)->use != WR_SETTING_IGNORED && which-- == 0) break;
    if (i == wr_preset_setting_count()) return false;
    wr_dialog_dynamics_open(walk->app, i);
    return walk_name(walk, "curves of %s", wr_preset_setting(i)->name);
}

/* Dialogs that no action opens, and that need no data. */
static inline bool walk_open_by_itself(Walk *walk, int which)
{
    static const struct {
        WrDialog dialog;
        const char *name;
    } rows[] = { { WR_DIALOG_UNSAVED, "unsaved" },
                 { WR_DIALOG_WELCOME, "welcome" },
                 { WR_DIALOG_TOUR, "tour" } };
    if (which >= (int)WR_LENGTH(rows)) return false;
    wr_dialog_open(walk->app, rows[which].dialog);
    return walk_name(walk, "dialog %s", rows[which].name);
}

/* The window's own file dialog, for each purpose. */
static inline bool walk_open_file(Walk *walk, int which)
{
    char title[64];
    if (which >= WR_FILE_PRESET) return false;
    wr_files_request_path(walk->app->files, (WrFilePurpose)which, NULL, "");
    wr_dialog_open(walk->app, WR_DIALOG_FILE);
    snprintf(title, sizeof title, "%d", which);
    return walk_name(walk, "file dialog of purpose %s", title);
}

/* The question before a generator layer is painted on. */
static inline bool walk_open_rasterize(Walk *walk, int which)
{
    if (which > 0) return false;
    wr_app_run_line(walk->app, "layer add dots from=\"pattern dots\"");
    return wr_rasterize_ask(walk->app) &&
           walk_name(walk, "question before %s is rasterized", "dots");
}

/* The question before a file is replaced, of each kind; the file is in the test's folder. */
static inline bool walk_open_replace(Walk *walk, int which)
{
    char path[600];
    if (which >= WR_REPLACE_KINDS) return false;
    snprintf(path, sizeof path, "%.500s/replaced-%d.wrinkle", getenv("XDG_STATE_HOME"), which);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    wr_replace_confirm(walk->app, (WrReplaceKind)which, WR_FILE_HISTORY, path);
    return walk_name(walk, "question before %s is replaced", path + strlen(path) - 18);
}

/* The journal of a program that has ended without saving, and the question that follows. */
static inline bool walk_open_recover(Walk *walk, int which)
{
    if (which > 0) return false;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        WrSession *session = wr_session_new(&(WrSessionOptions){ .journal = true });
        _exit(wr_session_run(session, "table 16x16", NULL) ? 0 : 1);
    }
    int status;
    assert_true(waitpid(child, &status, 0) == child && status == 0);
    wr_dialog_recover_open(walk->app);
    assert_int_equal(walk->app->dialog->now, WR_DIALOG_RECOVER);
    return walk_name(walk, "dialog %s", "recover");
}

/* It needs a linked copy. */
static inline bool walk_open_link(Walk *walk, int which)
{
    if (which > 0) return false;
    walk_run(walk, "layer add copy from=\"link 1\"");
    wr_action_run(walk->app, "filter_edit");
    assert_int_equal(walk->app->dialog->now, WR_DIALOG_LINK);
    return walk_name(walk, "dialog of a %s", "linked copy");
}

/* It needs a step, whose other values are shown too. */
static inline bool walk_open_step(Walk *walk, int which)
{
    if (which > 0) return false;
    walk_run(walk, "bump height=0.31 scheme=bspline");
    wr_step_edit(walk->app, wr_session_history_position(walk->session) - 1);
    assert_int_equal(walk->app->dialog->now, WR_DIALOG_STEP);
    return walk_name(walk, "dialog of a %s", "step");
}

/* It needs a file, in the test's folder. */
static inline bool walk_open_macro(Walk *walk, int which)
{
    char path[600];
    if (which > 0) return false;
    snprintf(path, sizeof path, "%.500s/macro.wrinkle", getenv("XDG_STATE_HOME"));
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("bump height=0.27\n", file);
    fclose(file);
    wr_macro_chosen(walk->app, path);
    assert_int_equal(walk->app->dialog->now, WR_DIALOG_MACRO);
    return walk_name(walk, "dialog of a %s", "macro");
}

/* It needs an object with a mesh. */
static inline bool walk_open_bake(Walk *walk, int which)
{
    if (which > 0) return false;
    walk_run(walk, "surface mesh file=" WR_SOURCE_DIR "/samples/accuracy/knot.ply");
    wr_action_run(walk->app, "bake");
    assert_int_equal(walk->app->dialog->now, WR_DIALOG_BAKE);
    return walk_name(walk, "dialog of %s", "bake");
}

static inline bool walk_open_drop(Walk *walk, int which)
{
    if (which > 0) return false;
    wr_app_drop(walk->app, WR_SOURCE_DIR "/samples/screenshot.png");
    return walk_name(walk, "dialog of %s", "a dropped picture");
}

static inline void walk_dialogs(Walk *walk)
{
    WrApp *app = walk->app;
    walk_each(walk, walk_open_dialog, walk_close_dialog);
    walk_each(walk, walk_open_adjust, walk_close_dialog);
    /* the program's own come first; each has curves */
    const WrLibrary *library = wr_preset_browser_library(app);
    if (wr_library_count(library) > 0)
        wr_preset_browser_choose(app, wr_library_entry(library, 0)->id);
    assert_non_null(app->shelf->preset);
    walk_each(walk, walk_open_preset, NULL);
    walk_each(walk, walk_open_curves, NULL);
    wr_dialog_close(app);
    wr_preset_browser_choose(app, WR_ROUND);
    walk_each(walk, walk_open_by_itself, walk_close_dialog);
    walk_each(walk, walk_open_file, walk_close_dialog);
    walk_each(walk, walk_open_replace, walk_close_dialog);
    walk_each(walk, walk_open_rasterize, walk_close_dialog);
    walk_each(walk, walk_open_recover, walk_close_dialog);
    walk_each(walk, walk_open_drop, walk_close_dialog);
    walk_each(walk, walk_open_bake, walk_close_dialog);
    walk_run(walk, "undo");
    walk_each(walk, walk_open_link, walk_close_dialog);
    walk_run(walk, "undo");
    walk_each(walk, walk_open_step, walk_close_dialog);
    walk_run(walk, "undo");
    walk_each(walk, walk_open_macro, walk_close_dialog);
}

static inline bool walk_open_generator(Walk *walk, int which)
{
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            if (which-- > 0) continue;
            char name[WR_GENERATE_ACTION];
            wr_generate_action(g, name);
            wr_action_run(walk->app, name);
            return walk_name(walk, "generator %s", name);
        }
    return false;
}

static inline void walk_generators(Walk *walk)
{
    walk_each(walk, walk_open_generator, NULL);
    wr_tool_choose(walk->app, 0);
}

static inline bool walk_open_surface(Walk *walk, int which)
{
    if (which >= WR_SURFACE_COUNT) return false;
    WrError err;
    char line[1024];
    wr_tab_show(walk->app, "Scene");
    const char *file =
        " file=" WR_SOURCE_DIR "/tests/image/cases/box_inch.3mf projection=cylindrical";
    snprintf(line, sizeof line, "surface %s%s", wr_surfaces[which]->name,
             which == WR_SURFACE_mesh ? file : "");
    wr_session_run(walk->session, line, &err); /* those that need a file keep the previous state */
    return walk_name(walk, "surface %s", wr_surfaces[which]->name);
}

static inline void walk_surfaces(Walk *walk)
{
    walk_each(walk, walk_open_surface, NULL);
}

static inline void walk_all(Walk *walk)
{
    walk_tabs(walk);
    walk_tools(walk);
    walk_dialogs(walk);
    walk_generators(walk);
    walk_surfaces(walk);
}
