#include "ui/app/idle_probe.h"
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/input.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/action.h"
#include "ui/app/state/layout.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/patch/patch.h"
#include "ui/input/pen.h"
#include "ui/patch/preview/preview.h"
#include "ui/canvas/tools/stroke_input.h"

#include "base/array.h"
#include "base/memory.h"
#include "field/field.h"
#include "system/clock.h"
#include "system/fd.h"
#include "system/thread.h"

#include <SDL.h>
#include <stdio.h>
#include <stdlib.h>

/* A finished worker's result may be fetched one step later and then request a frame. */
#define CALM_STEPS 3

struct WrIdleProbe {
    Uint32 ask_event;
    int fifo;
    WrThread thread;
    int asked, answered; /* request counts; used by the window's thread */
    int calm;            /* consecutive idle steps since the newest request */
};

static void push(const WrIdleProbe *rest)
{
    SDL_Event event = { .type = rest->ask_event };
    SDL_PushEvent(&event);
}

/* The byte 'q' ends the thread: only the program itself writes it. */
static void *thread_main(void *ctx)
{
    const WrIdleProbe *rest = ctx;
    char byte;
    while (wr_fd_read(rest->fifo, &byte, 1) == 1 && byte != 'q') push(rest);
    return NULL;
}

WrIdleProbe *wr_idle_probe_new(Uint32 ask_event)
{
    const char *path = getenv("WRINKLE_REST");
    int fifo = path && *path ? wr_fd_open(path, WR_OPEN_READ | WR_OPEN_WRITE) : -1;
    if (fifo < 0) return NULL;
    WrIdleProbe *rest = wr_alloc(1, sizeof *rest);
    rest->ask_event = ask_event;
    rest->fifo = fifo;
    if (wr_thread_begin(&rest->thread, thread_main, rest)) return rest;
    wr_fd_close(fifo);
    wr_free(rest);
    return NULL;
}

void wr_idle_probe_free(WrIdleProbe *rest)
{
    if (!rest) return;
    if (wr_fd_write(rest->fifo, "q", 1)) wr_thread_join(rest->thread);
    wr_fd_close(rest->fifo);
    wr_free(rest);
}

void wr_idle_probe_requested(WrApp *app)
{
    WrIdleProbe *rest = app->rest;
    if (!rest) return;
    rest->asked++;
    rest->calm = 0;
    wr_pen_sync(app->pen); /* afterwards all events of the server are in SDL's queue */
}

static bool is_calm(WrApp *app, bool busy)
{
    const WrPatch *p = app->patch;
    /* A held widget and alternating pictures may last for ever, so they do not count. */
    bool held = wr_gui_holds_mouse(app->gui);
    bool patch = p->outstanding || wr_patch_next_time(app) > 0.0 ||
                 !wr_preview_settled(app->preview) ||
                 wr_preview_picture(app->preview)->serial != p->serial;
    return !busy && !(patch && app->layout->patch.w > 0) && !(app->redraw > 0 && app->visible) &&
           !wr_strokes_waits(app) && !wr_accuracy_pending(app) &&
           !(wr_gui_has_pending_timer(app->gui) && !held) && !wr_pen_replaying(app->pen) &&
           wr_pen_waiting(app->pen) == 0 && !wr_input_waits(app) && !wr_deferred_waits(app, NULL);
}

void wr_idle_probe_step(WrApp *app, bool busy)
{
    WrIdleProbe *rest = app->rest;
    if (!rest || rest->answered == rest->asked) return;
    if (!is_calm(app, busy)) {
        rest->calm = 0;
        return; /* pending work starts the next step */
    }
    if (++rest->calm < CALM_STEPS) {
        SDL_Event nothing = { .type = app->ready_event };
        SDL_PushEvent(&nothing);
        return;
    }
    wr_pen_sync(app->pen); /* the server has the frame */
    rest->answered = rest->asked;
    fprintf(stderr, "at rest %d", rest->answered);
    float lit[4];
    if (wr_gui_lit_row(app->gui, lit))
        fprintf(stderr, " row %.0f %.0f %.0f %.0f", lit[0], lit[1], lit[2], lit[3]);
    fputc('\n', stderr);
    fflush(stderr);
}

/* Release of memory kept for the next table or picture, after an idle period of the window. */

#define ALONE_SECONDS 20.0

static double next_time(const WrApp *app)
{
    const bool done = app->busy || app->thrifty_at >= app->input_at;
    return done ? 0.0 : app->input_at + ALONE_SECONDS;
}

static void update(WrApp *app)
{
    if (app->busy) app->thrifty_at = 0.0; /* a running command's memory is released afterwards */
    const double due = next_time(app), now = wr_clock_seconds();
    if (due == 0.0 || now < due) return;
    wr_field_trim();
    app->thrifty_at = now;
}

const WrPart wr_part_thrift = { .next_time = next_time, .update = update };
