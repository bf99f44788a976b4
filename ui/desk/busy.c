/* What may take long runs on a thread of its own while the window stays alive.

   Meanwhile only that thread touches the session. The window shows a snapshot of the document from before:
   the patch turns and can be turned, the canvas can be moved and zoomed, and actions that only change how either is
   looked at are done at once (wr_meanwhile); the panels stand still. Whatever else is pressed is refused, and the bar says
   so. */
#include "ui/desk/busy.h"
#include "ui/canvas/view.h"
#include "ui/desk/action.h"
#include "ui/desk/action_list.h"
#include "ui/desk/desk.h"
#include "ui/desk/keys.h"
#include "ui/desk/later.h"
#include "ui/desk/layout.h"
#include "ui/desk/line_words.h"
#include "ui/desk/messages.h"
#include "ui/desk/roster.h"
#include "ui/desk/session_view.h"
#include "ui/gui/gui.h"
#include "ui/gui/kept.h"
#include "ui/gui/theme.h"
#include "ui/pen/pen.h"
#include "ui/jobs/job.h"
#include "ui/jobs/trial.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/estimate.h"
#include "command/inner.h"
#include "command/session.h"
#include "document/document.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define QUIET_SECONDS 0.05   /* what takes less is not noticed: not even events are looked at */
#define MOMENT_SECONDS 0.2   /* what takes less shows no bar */
#define PICTURE_SECONDS 0.03 /* between pictures meanwhile */
#define REFUSED_SECONDS 2.0  /* the bar says that it refused something */

typedef struct Work {
    WrBusyWork *work;
    void *ctx;
    WrError err;
    bool ok;
} Work;

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    (void)pool;
    (void)progress; /* the work finds it as its thread's own */
    Work *work = arg;
    work->ok = work->work(work->ctx, &work->err);
}

static void drop(void *arg)
{
    (void)arg; /* it stands on the caller's stack */
}

/* ---- the window meanwhile ---- */

/* One wait: what is shown, and what was pressed. */
typedef struct Wait {
    WrApp *app;
    WrJob *job;
    const char *what;
    double since, refused_at; /* clock */
    double expected;          /* seconds, estimated before; 0: not known */
    double furthest;          /* fraction: bars do not go back */
    SDL_Texture *behind;      /* the window as it was last drawn; owned */
    int behind_w, behind_h;
    bool panning, close, cancelled;
    bool file_chosen, asked;  /* the desktop's dialog, and a test, spoke: answered afterwards */
    WR_ARRAY(SDL_Event) kept; /* while the journal is tended: all of the hand's, in order */
    WR_ARRAY(char *) dropped; /* files, in order: opened afterwards; SDL's */
} Wait;

static void grab(Wait *wait)
{
    WrApp *app = wait->app;
    int w = app->width, h = app->height;
    uint32_t *pixels = wr_try_alloc((size_t)w * (size_t)h, 4, "a picture of the window", NULL);
    if (!pixels) return;
    if (SDL_RenderReadPixels(app->renderer, NULL, SDL_PIXELFORMAT_ARGB8888, pixels, w * 4) == 0)
        wait->behind = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                         SDL_TEXTUREACCESS_STATIC, w, h);
    if (wait->behind) {
        SDL_SetTextureBlendMode(wait->behind, SDL_BLENDMODE_NONE);
        SDL_SetTextureColorMod(wait->behind, 150, 150, 150); /* it does not answer */
        wr_gui_sdl_update(wait->behind, NULL, pixels, w * 4);
    }
    wait->behind_w = w;
    wait->behind_h = h;
    wr_free(pixels);
}

static void cancel(Wait *wait)
{
    wait->cancelled = true;
    wr_job_interrupt(wait->job);
}

/* What the estimate leaves, until progress says better. */
static void time_left(const Wait *wait, double took, char text[WR_PROGRESS_LEFT])
{
    wr_progress_left(wait->furthest, took, text);
    int rest = (int)fmin(wait->expected - took + 0.5, 1e6);
    if (!text[0] && rest > 0)
        snprintf(text, WR_PROGRESS_LEFT, "~%d:%02d left", rest / 60, rest % 60);
}

/* What it does, or what it has to say of what was asked for meanwhile. */
static const char *words(const Wait *wait, bool refused)
{
    return refused                   ? "Not while this is being done: wait or cancel"
           : wait->close             ? "Closes when this is done: wait or cancel"
           : wait->dropped.count > 0 ? "The dropped file opens when this is done"
                                     : wait->what;
}

/* Narrow windows have shorter words and a shorter bar, but all of it. */
static double squeezed(double wide, double share)
{
    double lacking = fmax(0.0, wr_gui_px(830) - wr_gui_width());
    return fmax(wr_gui_px(20), wr_gui_px(wide) - share * lacking);
}

static void bar(Wait *wait, double now)
{
    WrApp *app = wait->app;
    SDL_Rect room = app->layout->status;
    int tall = wr_gui_px(28);
    char seconds[24], left[WR_PROGRESS_LEFT];
    double fraction = 0.0, took = now - wait->since;
    bool refused = now - wait->refused_at < REFUSED_SECONDS;
    wr_job_busy(wait->job, &fraction, NULL);
    if (fraction > wait->furthest) wait->furthest = fraction;
    if (room.w <= 0) room = (SDL_Rect){ 0, app->height - tall, app->width, tall };
    wr_gui_area_begin("##busy", WR_AREA_BAR, room, refused ? WR_COLOUR_REFUSED : WR_COLOUR_BAR);
    double wide = squeezed(320, 0.6), long_bar = squeezed(220, 0.4);
    double end = wr_gui_px(30) + wide + long_bar;
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, words(wait, refused), wide);
    wr_gui_same_line(12);
    wr_gui_move_to(wr_gui_px(30) + wide);
    wr_gui_progress(long_bar, wait->furthest > 0.0 ? wait->furthest : -1.0);
    wr_gui_same_line(12);
    snprintf(seconds, sizeof seconds, "%.1f s", took);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, seconds);
    wr_gui_same_line(12);
    wr_gui_move_to(end + wr_gui_px(70));
    time_left(wait, took, left);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, wait->cancelled ? "cancelling" : left);
    wr_gui_same_line(12);
    wr_gui_move_to(end + wr_gui_px(160));
    if (wr_gui_chip(NULL, "Cancel")) cancel(wait);
    wr_gui_tip("Escape");
    wr_gui_area_end();
}

static void draw(Wait *wait, double now)
{
    WrApp *app = wait->app;
    wr_gui_aside_begin(app->gui);
    SDL_GetRendererOutputSize(app->renderer, &app->width, &app->height);
    wr_gui_frame_begin(app->gui, app->width, app->height, PICTURE_SECONDS);
    wr_app_make_layout(app);
    SDL_Rect place = { 0, 0, wait->behind_w, wait->behind_h };
    if (wait->behind) wr_kept_copy(wr_gui_kept(app->gui), wait->behind, NULL, &place);
    for (const WrPart *const *p = app->roster->parts; *p; p++)
        if ((*p)->draw) (*p)->draw(app);
    if (now - wait->since > MOMENT_SECONDS) bar(wait, now);
    wr_gui_frame_end(app->gui);
    wr_gui_aside_end(app->gui);
}

/* ---- what is pressed meanwhile ---- */

static bool over(const SDL_Rect *room, int x, int y)
{
    return wr_layout_inside(room, x, y);
}

/* The canvas can be moved and zoomed; true if the event was for it. */
static bool move_view(Wait *wait, const SDL_Event *event)
{
    WrApp *app = wait->app;
    int x, y;
    SDL_GetMouseState(&x, &y);
    if (event->type == SDL_MOUSEMOTION && wait->panning) {
        wr_view_pan(app->view, event->motion.xrel, event->motion.yrel);
        return true;
    }
    if (event->type == SDL_MOUSEBUTTONUP && wait->panning) {
        wait->panning = false;
        return true;
    }
    if (!over(&app->layout->canvas, x, y)) return false;
    if (event->type == SDL_MOUSEWHEEL) {
        double way = event->wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -1.0 : 1.0;
        double steps = way * (double)event->wheel.preciseY;
        wr_view_zoom_at(app->view, x, y, app->view->zoom * exp2(steps / 3.0));
        return true;
    }
    if (event->type != SDL_MOUSEBUTTONDOWN || event->button.button == SDL_BUTTON_RIGHT)
        return false;
    wait->panning = true;
    return true;
}

static bool is_modifier(SDL_Keycode key)
{
    return key == SDLK_LSHIFT || key == SDLK_RSHIFT || key == SDLK_LCTRL || key == SDLK_RCTRL ||
           key == SDLK_LALT || key == SDLK_RALT || key == SDLK_LGUI || key == SDLK_RGUI;
}

static bool wants_end(const Wait *wait, const SDL_Event *event)
{
    if (event->type == SDL_QUIT) return true;
    if (event->type == SDL_WINDOWEVENT) return event->window.event == SDL_WINDOWEVENT_CLOSE;
    if (event->type != SDL_KEYDOWN) return false;
    const char *action = wr_keys_find(wait->app->keys, event->key.keysym);
    return action && strcmp(action, WR_ACT(quit)) == 0;
}

/* Parts follow these even now. */
static void pass_on(WrApp *app, const SDL_Event *event)
{
    for (const WrPart *const *p = app->roster->parts; *p; p++)
        if ((*p)->event) (*p)->event(app, event);
}

/* Of what is not the user's hand: true if it was that. What the window is told holds at once; what is let go
   was pressed before. */
static bool take_note(Wait *wait, const SDL_Event *event)
{
    WrApp *app = wait->app;
    if (event->type == app->file_event) wait->file_chosen = true;
    else if (event->type == app->rest_event) wait->asked = true;
    else if (event->type == SDL_WINDOWEVENT || event->type == SDL_KEYUP) pass_on(app, event);
    else if (event->type == SDL_DROPFILE && event->drop.file)
        wr_array_push(&wait->dropped, event->drop.file);
    else return false;
    return event->type != SDL_WINDOWEVENT &&
           event->type != SDL_KEYUP; /* the widgets want those too */
}

/* A part's view is looked at. */
static bool look(WrApp *app, const SDL_Event *event)
{
    for (const WrPart *const *p = app->roster->parts; *p; p++)
        if ((*p)->look && (*p)->look(app, event)) return true;
    return false;
}

/* Keys of actions that touch nothing of what is worked on. */
static bool look_by_key(WrApp *app, const SDL_KeyboardEvent *event)
{
    int x, y;
    SDL_GetMouseState(&x, &y);
    const bool stops =
        event->keysym.sym == SDLK_SPACE && wr_layout_inside(&app->layout->patch, x, y);
    const char *name = stops ? WR_ACT(turn) : wr_keys_find(app->keys, event->keysym);
    for (const char *const *m = app->roster->meanwhile; name && *m; m++) {
        const WrAction *action = strcmp(*m, name) == 0 ? wr_action_find(app, name) : NULL;
        if (!action) continue;
        if (wr_action_can(app, action)) action->run(app);
        return true;
    }
    return false;
}

/* Escape cancels, a request to close waits, the bar's button is the bar's; all else is refused. */
static void take_event(Wait *wait, const SDL_Event *event)
{
    WrApp *app = wait->app;
    if (wants_end(wait, event)) {
        wait->close = true;
        return;
    }
    if (app->tending && event->type != SDL_WINDOWEVENT && event->type != app->file_event &&
        event->type != app->rest_event) {
        wr_array_push(&wait->kept, *event);
        return;
    }
    if (take_note(wait, event)) return;
    bool key = event->type == SDL_KEYDOWN && !is_modifier(event->key.keysym.sym);
    bool press = event->type == SDL_MOUSEBUTTONDOWN;
    if (key && event->key.keysym.sym == SDLK_ESCAPE) {
        cancel(wait);
        return;
    }
    if (move_view(wait, event) || look(app, event) || (key && look_by_key(app, &event->key)))
        return;
    wr_gui_event(app->gui, event);
    bool on_bar = event->type == SDL_MOUSEBUTTONDOWN &&
                  over(&app->layout->status, event->button.x, event->button.y);
    if (key || (press && !on_bar)) wait->refused_at = wr_clock_seconds();
}

static void take_events(Wait *wait)
{
    SDL_Event event;
    WrPenEvent pen;
    wr_gui_aside_begin(wait->app->gui);
    while (SDL_PollEvent(&event)) take_event(wait, &event);
    while (!wait->app->tending && wr_pen_next(wait->app->pen, &pen))
        if (pen.kind == WR_PEN_DOWN) wait->refused_at = wr_clock_seconds();
    wr_gui_aside_end(wait->app->gui);
}

/* ---- the wait ---- */

/* What was asked for meanwhile, in order; the wish to close comes last, since it asks about the rest. */
static void catch_up(Wait *wait)
{
    const WrApp *app = wait->app;
    if (app->tending) take_events(wait); /* what came last comes last */
    for (int i = 0; i < wait->kept.count; i++) SDL_PushEvent(&wait->kept.data[i]);
    if (wait->file_chosen) SDL_PushEvent(&(SDL_Event){ .type = app->file_event });
    for (int i = 0; i < wait->dropped.count; i++) {
        SDL_DropEvent drop = { .type = SDL_DROPFILE, .file = wait->dropped.data[i] };
        if (SDL_PushEvent(&(SDL_Event){ .drop = drop }) != 1) SDL_free(drop.file);
    }
    if (wait->asked) SDL_PushEvent(&(SDL_Event){ .type = app->rest_event });
    if (wait->close) SDL_PushEvent(&(SDL_Event){ .type = SDL_QUIT });
}

static void wait_for(Wait *wait)
{
    WrApp *app = wait->app;
    grab(wait);
    wr_gui_release_all(app->gui);
    while (!wr_job_take(wait->job)) {
        double now = wr_clock_seconds();
        /* Before the bar stands, nothing is looked at: what is pressed then is kept, in order. */
        if (now - wait->since > MOMENT_SECONDS) take_events(wait);
        for (const WrPart *const *p = app->roster->parts; *p; p++)
            if ((*p)->meanwhile) (*p)->meanwhile(app);
        if (app->visible) draw(wait, now);
        double rest = PICTURE_SECONDS - (wr_clock_seconds() - now);
        if (rest > 0.0) SDL_WaitEventTimeout(NULL, (int)(rest * 1000.0) + 1);
    }
    if (wait->behind) SDL_DestroyTexture(wait->behind);
    wr_gui_aside_begin(app->gui);
    wr_gui_release_all(app->gui);
    wr_gui_aside_end(app->gui);
    catch_up(wait);
    wr_array_free(&wait->dropped);
    wr_array_free(&wait->kept);
    wr_app_redraw(app);
}

static bool run_beside(WrApp *app, const char *what, WrBusyWork *work, void *ctx, WrError *err)
{
    static const WrJobKind kind = { run, drop };
    Work here = { .work = work, .ctx = ctx };
    Wait wait = { .app = app,
                  .what = what,
                  .since = wr_clock_seconds(),
                  .refused_at = -1e9,
                  .expected = app->expected };
    wait.job = wr_job_new(&kind, 1, app->job_event);
    wr_job_start(wait.job, &here);
    bool done = false;
    while (!done && wr_clock_seconds() - wait.since < QUIET_SECONDS) {
        done = wr_job_take(wait.job) != NULL;
        if (!done) SDL_Delay(1);
    }
    if (!done) wait_for(&wait);
    wr_job_free(wait.job);
    app->gave_up = wait.cancelled && !here.ok;
    if (!here.ok) *err = here.err;
    return here.ok;
}

bool wr_busy_run(WrApp *app, const char *what, WrBusyWork *work, void *ctx, WrError *err)
{
    app->gave_up = false;
    if (app->shown) return wr_fail(err, "%s: not while something else is being done", what);
    if (app->drawn_at == 0.0) return work(ctx, err);
    app->shown = wr_document_share(wr_session_document(app->session));
    bool ok = run_beside(app, what, work, ctx, err);
    wr_document_free(app->shown);
    app->shown = NULL;
    return ok;
}

void wr_busy_fail(WrApp *app, const char *what, const WrError *err)
{
    if (app->gave_up) wr_app_say(app, "Cancelled: %s, nothing changed", what);
    else wr_app_fail(app, err);
}

/* ---- commands ---- */

typedef struct Line {
    WrSession *session;
    const char *text;
    const WrDocument *made; /* NULL: it is still to be made */
} Line;

static bool run_line(void *ctx, WrError *err)
{
    const Line *line = ctx;
    if (line->made) return wr_session_run_made(line->session, line->text, line->made, err);
    return wr_session_run(line->session, line->text, err);
}

static bool run_command(WrApp *app, const char *line, const WrDocument *made)
{
    WrError err;
    WrText words = { 0 };
    wr_hand_let_go(app); /* a stroke that is open would refuse it */
    wr_line_words(line, &words);
    const char *what = wr_text_get(&words);
    if (app->trying) wr_trial_stop(app->trial); /* nobody waits for it any more */
    Line call = { app->session, line, made };
    WrEstimate estimate;
    if (!made && wr_session_estimate(app->session, line, &estimate, NULL))
        app->expected = estimate.seconds;
    double since = wr_clock_seconds();
    bool ok = wr_busy_run(app, what, run_line, &call, &err);
    app->expected = 0.0;
    if (ok) wr_messages_overtake(app->messages, since);
    if (!ok) wr_busy_fail(app, what, &err);
    wr_text_fini(&words);
    wr_app_try_end(app);
    wr_app_take_notes(app);
    wr_app_title(app);
    wr_app_redraw(app);
    return ok;
}

bool wr_app_run_line(WrApp *app, const char *line)
{
    return run_command(app, line, NULL);
}

void wr_app_run_tried(WrApp *app, const char *line)
{
    const WrDocument *made = app->trying ? wr_trial_made(app->trial) : NULL;
    if (!made || !wr_session_takes_made(line)) {
        wr_app_run_slow(app, line);
        return;
    }
    WrDocument *kept = wr_document_share(made); /* the trial ends meanwhile */
    WrText notes = { 0 };
    wr_text_add(&notes, wr_trial_notes(app->trial));
    if (run_command(app, line, kept)) wr_app_say_lines(app, wr_text_get(&notes));
    wr_text_fini(&notes);
    wr_document_free(kept);
}

bool wr_app_run_linef(WrApp *app, const char *format, ...)
{
    char line[256];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    return wr_app_run_line(app, line);
}

static void run_later(WrApp *app, const char *line)
{
    wr_app_run_line(app, line);
}

void wr_app_run_slow(WrApp *app, const char *line)
{
    if (app->in_frame) wr_later(app, run_later, line);
    else wr_app_run_line(app, line);
}

bool wr_app_line_waits(const WrApp *app)
{
    return wr_later_waits(app, run_later);
}
