/* app.h - a complete window without a display, for tests that send events. Include after test.h. */
#pragma once
#include "window.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "command/session.h"
#include "system/clock.h"

#include "ui/app/loop.h"
#include "ui/app/input.h"
#include "ui/app/state/action.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command_internal.h"
#include "ui/app/state/document.h"
#include "ui/canvas/tools/stroke_input.h"

#include <SDL.h>

#define PATIENCE 120.0 /* seconds of waiting before a test fails */

typedef struct Bench {
    WrPool *pool;
    WrSession *session;
    WrAppOptions options;
    WrApp *app;
} Bench;

static inline void begin_with(Bench *bench, const WrAppOptions *options)
{
    WrError err = { "" };
    if (!getenv("XDG_STATE_HOME")) fail_msg("the group has no folder of its own: enter_window");
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    bench->pool = wr_pool_new(1);
    bench->session = wr_session_new(&(WrSessionOptions){ .pool = bench->pool, .outputs = true });
    if (!wr_session_run(bench->session, "table 64x64", &err)) fail_msg("%s", err.text);
    bench->options = *options;
    bench->options.session = bench->session;
    bench->options.threads = 1;
    bench->app = wr_store_new();
    bench->app->options = &bench->options;
    bench->app->session = bench->session;
    if (!wr_app_begin(bench->app, &err)) fail_msg("%s", err.text);
    double end = wr_clock_seconds() + PATIENCE;
    while (bench->app->drawn_at == 0.0 && wr_clock_seconds() < end) wr_app_step(bench->app);
    assert_true(bench->app->drawn_at > 0.0);
    bench->app->file->clean_revision = wr_session_revision(bench->session);
}

static inline void begin(Bench *bench)
{
    begin_with(bench, &(WrAppOptions){ .file_given = true, .width = 900, .height = 700 });
}

static inline void finish(Bench *bench)
{
    wr_app_end(bench->app);
    wr_free(bench->app);
    wr_session_free(bench->session);
    wr_pool_free(bench->pool);
}

/* Run until a frame is drawn, even if nothing has changed, and every event is handled: events wait for frames. */
static inline void draw_again(WrApp *app)
{
    const double before = app->drawn_at;
    double end = wr_clock_seconds() + PATIENCE;
    while ((app->drawn_at == before || wr_input_waits(app)) && wr_clock_seconds() < end) {
        app->redraw = 2;
        SDL_PushEvent(&(SDL_Event){ .type = app->ready_event });
        wr_app_step(app);
    }
}

/* True while a command runs, or an action waits behind one: work in the background, such as saving memory, may begin at any time,
   and a line that comes meanwhile runs after it. */
static inline bool is_working(const WrApp *app)
{
    return app->busy || app->waits->items.count > 0 || wr_deferred_waits(app, NULL) ||
           app->brush->jobs.count > 0;
}

/* Run the main loop until no command runs or waits. */
static inline void settle(Bench *bench)
{
    for (int i = 0; i < 6; i++) draw_again(bench->app);
    const double end = wr_clock_seconds() + PATIENCE;
    while (is_working(bench->app) && wr_clock_seconds() < end) wr_app_step(bench->app);
    assert_false(is_working(bench->app));
}

/* Pointer events as from the system. */
static inline void push_motion(const WrApp *app, int x, int y)
{
    SDL_PushEvent(&(SDL_Event){
        .motion = {
            .type = SDL_MOUSEMOTION, .windowID = SDL_GetWindowID(app->window), .x = x, .y = y } });
}

static inline void push_button(const WrApp *app, bool down, int which, int x, int y)
{
    SDL_PushEvent(&(SDL_Event){ .button = { .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                            .windowID = SDL_GetWindowID(app->window),
                                            .button = (Uint8)which,
                                            .state = down ? SDL_PRESSED : SDL_RELEASED,
                                            .clicks = 1,
                                            .x = x,
                                            .y = y } });
}
