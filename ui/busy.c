/* SPDX-License-Identifier: MIT
   What may take long runs on a thread of its own while the window stays alive, and what is asked for
   inside a picture of the window is done after it. */
#include "ui/job.h"
#include "ui/state.h"

#include "base/clock.h"

#include <string.h>

#define MOMENT_SECONDS 0.2   /* what takes less shows nothing */
#define PICTURE_SECONDS 0.04 /* between pictures meanwhile */

typedef struct Work {
    WrBusyWork *work;
    void *ctx;
    WrError err;
    bool ok;
} Work;

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    (void)pool;
    (void)progress;
    Work *work = arg;
    work->ok = work->work(work->ctx, &work->err);
}

static void drop(void *arg)
{
    (void)arg; /* it stands on the caller's stack */
}

/* ---- the window meanwhile ---- */

/* The window as it was last drawn. */
static SDL_Texture *grab(const WrApp *app)
{
    int w = app->width, h = app->height;
    uint32_t *pixels = wr_try_alloc((size_t)w * (size_t)h, 4, "a picture of the window", NULL);
    if (!pixels) return NULL;
    SDL_Texture *texture = NULL;
    if (SDL_RenderReadPixels(app->renderer, NULL, SDL_PIXELFORMAT_ARGB8888, pixels, w * 4) == 0)
        texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                    SDL_TEXTUREACCESS_STATIC, w, h);
    if (texture) {
        SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_NONE);
        SDL_UpdateTexture(texture, NULL, pixels, w * 4);
    }
    wr_free(pixels);
    return texture;
}

static void draw(WrApp *app, SDL_Texture *behind, const char *what, double seconds)
{
    SDL_Rect room = app->layout.status;
    int tall = wr_gui_px(28);
    char text[24];
    if (room.w <= 0) room = (SDL_Rect){ 0, app->height - tall, app->width, tall };
    wr_gui_frame_begin(app->gui, app->width, app->height, PICTURE_SECONDS);
    SDL_SetRenderDrawColor(app->renderer, 0x26, 0x26, 0x26, 255);
    SDL_RenderClear(app->renderer);
    if (behind) SDL_RenderCopy(app->renderer, behind, NULL, NULL);
    wr_patch_draw(app);
    wr_gui_area_begin("##busy", WR_AREA_BAR, room, WR_COLOUR_BAR);
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, what, wr_gui_px(280));
    wr_gui_same_line(12);
    wr_gui_move_to(wr_gui_px(310));
    wr_gui_progress(wr_gui_px(220), -1.0);
    wr_gui_same_line(12);
    snprintf(text, sizeof text, "%.1f s", seconds);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    if (app->options->cancel) {
        wr_gui_same_line(12);
        if (wr_gui_chip(NULL, "Cancel"))
            __atomic_store_n(app->options->cancel, 1, __ATOMIC_RELAXED);
        wr_gui_tip("Escape");
    }
    wr_gui_area_end();
    wr_gui_frame_end(app->gui);
    SDL_RenderPresent(app->renderer);
}

/* Clicks go to the button, Escape cancels, a request to close waits. */
static void take_events(WrApp *app, bool *close)
{
    SDL_Event event;
    while (SDL_PollEvent(&event)) {
        bool escape = event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE;
        if (escape && app->options->cancel)
            __atomic_store_n(app->options->cancel, 1, __ATOMIC_RELAXED);
        if (event.type == SDL_QUIT ||
            (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_CLOSE))
            *close = true;
        if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
        wr_gui_event(app->gui, &event);
    }
}

static void wait_for(WrApp *app, WrJob *job, const char *what, double since)
{
    SDL_Texture *behind = grab(app);
    bool close = false;
    while (!wr_job_take(job)) {
        take_events(app, &close);
        wr_patch_turn_on(app);
        if (app->visible) draw(app, behind, what, wr_clock_seconds() - since);
        SDL_Delay((Uint32)(PICTURE_SECONDS * 1000.0));
    }
    if (behind) SDL_DestroyTexture(behind);
    wr_gui_release_all(app->gui);
    if (close) SDL_PushEvent(&(SDL_Event){ .type = SDL_QUIT });
    wr_app_redraw(app);
}

bool wr_busy_run(WrApp *app, const char *what, WrBusyWork *work, void *ctx, WrError *err)
{
    static const WrJobKind kind = { run, drop };
    if (app->in_frame || app->drawn_at == 0.0) return work(ctx, err);
    Work here = { .work = work, .ctx = ctx };
    double since = wr_clock_seconds();
    WrJob *job = wr_job_new(&kind, 1, app->job_event);
    wr_job_start(job, &here);
    bool done = false;
    while (!done && wr_clock_seconds() - since < MOMENT_SECONDS) {
        done = wr_job_take(job) != NULL;
        if (!done) SDL_Delay(1);
    }
    if (!done) wait_for(app, job, what, since);
    wr_job_free(job);
    if (app->options->cancel) __atomic_store_n(app->options->cancel, 0, __ATOMIC_RELAXED);
    if (!here.ok) *err = here.err;
    return here.ok;
}

/* ---- later ---- */

/* The window is first drawn without the dialog or menu that asked for it. */
static void put_off(WrApp *app)
{
    app->later.since = wr_clock_seconds();
    wr_app_redraw(app);
}

typedef struct Line {
    WrSession *session;
    const char *text;
} Line;

static bool run_line(void *ctx, WrError *err)
{
    const Line *line = ctx;
    return wr_session_run(line->session, line->text, err);
}

void wr_app_run_slow(WrApp *app, const char *line)
{
    if (app->in_frame) {
        wr_free(app->later.line);
        app->later.line = wr_strdup(line);
        put_off(app);
        return;
    }
    WrError err;
    char what[64];
    wr_hand_let_go(app);
    snprintf(what, sizeof what, "%.48s", line);
    Line call = { app->session, line };
    bool ok = wr_busy_run(app, what, run_line, &call, &err);
    if (!ok) wr_app_fail(app, &err);
    wr_app_try_end(app);
    wr_app_take_notes(app);
    wr_app_title(app);
    wr_app_redraw(app);
}

void wr_later_action(WrApp *app, const char *name)
{
    app->later.action = wr_action_find(name);
    put_off(app);
}

void wr_later_recover(WrApp *app, const char *journal, bool beyond)
{
    app->later.beyond = beyond;
    wr_free(app->later.journal);
    app->later.journal = wr_strdup(journal);
    put_off(app);
}

void wr_later_file(WrApp *app, WrFilePurpose purpose, const char *path)
{
    wr_free(app->later.path);
    app->later.path = wr_strdup(path);
    app->later.purpose = purpose;
    put_off(app);
}

void wr_later_run(WrApp *app)
{
    WrLater later = app->later;
    if (!later.action && !later.line && !later.path && !later.journal) return;
    if (app->visible && app->drawn_at <= later.since) return;
    app->later = (WrLater){ 0 };
    if (later.line) wr_app_run_slow(app, later.line);
    if (later.action) wr_action_run(app, later.action->name);
    if (later.path) wr_app_file_chosen(app, later.purpose, later.path);
    if (later.journal) wr_recover(app, later.journal, later.beyond);
    wr_free(later.line);
    wr_free(later.path);
    wr_free(later.journal);
    wr_app_redraw(app);
}
