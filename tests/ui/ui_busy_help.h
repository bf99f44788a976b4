/* ui_busy_help.h - long work beside a window without a display, which ends when the test has seen the expected state.
   Include after test.h. */
#pragma once
#include "app.h"

#include "base/error.h"
#include "base/progress.h"
#include "command/session.h"
#include "system/clock.h"

#include "ui/app/input.h"
#include "ui/app/state/background_command_internal.h"

#include <SDL.h>
#include <unistd.h>

typedef struct Long {
    WrApp *app;
    WrBusyKind kind;
    SDL_Event events[3]; /* sent meanwhile */
    int count;
    bool gives_up; /* it ends when cancelled */
    bool in_vain;  /* the window did not handle them */

    /* Called by the window's thread after each frame meanwhile, until it returns true: then the work ends. Or
       NULL. */
    bool (*watch)(struct Long *work);
    int stage;        /* for `watch` */
    volatile int end; /* atomic */
    const char *line; /* run at its end, or NULL */
} Long;

static Long *watched;

static inline void picture_drawn(WrApp *app)
{
    if (!watched || !app->busy || __atomic_load_n(&watched->end, __ATOMIC_RELAXED)) return;
    if (watched->watch(watched)) __atomic_store_n(&watched->end, 1, __ATOMIC_RELEASE);
    app->redraw = 2; /* and another frame */
}

static inline bool untaken(const Long *work)
{
    for (int i = 0; i < work->count; i++)
        if (SDL_HasEvent(work->events[i].type)) return true;
    return wr_input_waits(work->app);
}

static inline bool take_long(WrSession *session, void *ctx, WrError *err)
{
    Long *work = ctx;
    for (int i = 0; i < work->count; i++) SDL_PushEvent(&work->events[i]);
    double end = wr_clock_seconds() + PATIENCE;
    while (untaken(work) && wr_clock_seconds() < end) usleep(1000);
    work->in_vain = untaken(work);
    while (work->gives_up && !wr_progress_stopped() && wr_clock_seconds() < end) usleep(1000);
    while (work->watch && !work->gives_up && !__atomic_load_n(&work->end, __ATOMIC_ACQUIRE) &&
           wr_clock_seconds() < end)
        usleep(1000);
    if (work->line && !wr_session_run(session, work->line, err)) return false;
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

static inline bool run(Long *work, WrError *err)
{
    watched = work->watch ? work : NULL;
    work->app->drawn = picture_drawn;
    bool good = wr_busy_run(work->app, work->kind, "Something long", take_long, work, err);
    watched = NULL;
    assert_false(work->in_vain);
    if (work->watch && !work->end) fail_msg("it was not seen: stage %d", work->stage);
    return good;
}

static inline SDL_Event key(Uint32 type, SDL_Keycode code)
{
    SDL_KeyboardEvent event = { .type = type, .keysym = { .sym = code } };
    return (SDL_Event){ .key = event };
}

static inline SDL_Event button(Uint32 type, int x, int y)
{
    SDL_MouseButtonEvent event = { .type = type, .button = SDL_BUTTON_LEFT, .x = x, .y = y };
    return (SDL_Event){ .button = event };
}
