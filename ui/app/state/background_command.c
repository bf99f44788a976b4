/* Long commands on a worker thread; the rules are in background_command.h. */
#include "ui/app/state/background_command.h"
#include "ui/app/state/background_command_internal.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/dropped_files.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/job.h"
#include "ui/app/state/layout.h"
#include "ui/toolkit/theme.h"
#include "ui/app/state/session_view.h"

#include "base/array.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "command/session.h"
#include "document/document.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define QUIET_SECONDS 0.05 /* shorter work is not noticeable */
#define LOOKS_MS 3         /* between checks for completion while no events are handled */

/* ---- running ---- */

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    (void)pool;
    (void)progress; /* passed through thread-local storage */
    WrBusy *busy = arg;
    busy->ok = busy->work(busy->session, busy->ctx, &busy->err);
}

static void drop(void *arg)
{
    (void)arg; /* owned by the window */
}

static bool is_done(WrBusy *busy)
{
    if (!busy->is_done) busy->is_done = wr_job_take(busy->job) != NULL;
    return busy->is_done;
}

bool wr_busy_begin(WrApp *app, const WrBusy *like)
{
    static const WrJobKind kind = { run, drop };
    WrBusy *busy = wr_alloc(1, sizeof *busy);
    *busy = *like;
    busy->session = app->session;
    busy->what = wr_strdup(like->what);
    busy->since = wr_clock_seconds();
    busy->refused_at = -1e9;
    busy->in_frame = app->in_frame;
    busy->picture = app->drawn_at;
    busy->job = wr_job_new(&kind, 1, app->job_event);
    app->session = wr_session_snapshot(busy->session);
    app->busy = busy;
    wr_job_start(busy->job, busy);
    const double quiet = like->quiet > 0 ? like->quiet : QUIET_SECONDS;
    while (!is_done(busy) && wr_clock_seconds() - busy->since < quiet) SDL_Delay(1);
    if (!busy->is_done) wr_app_redraw(app);
    return busy->is_done;
}

void wr_busy_wait(WrApp *app)
{
    WrBusy *busy = app->busy;
    while (!is_done(busy))
        if (app->in_frame) SDL_Delay(LOOKS_MS);
        else app->registry->step(app);
}

/* Handle delayed events: the result of the file dialog, then a request to close, which offers to save unsaved work. */
static void catch_up(const WrApp *app, const WrBusy *busy)
{
    if (busy->file_chosen) SDL_PushEvent(&(SDL_Event){ .type = app->file_event });
    if (busy->closes) SDL_PushEvent(&(SDL_Event){ .type = SDL_QUIT });
}

bool wr_busy_end(WrApp *app, WrError *err)
{
    WrBusy *busy = app->busy;
    const bool ok = busy->ok;
    wr_session_free(app->session);
    app->session = busy->session;
    app->busy = NULL;
    app->gave_up = busy->cancelled && !ok;
    if (busy->cancelled && busy->kind != WR_BUSY_TEND) app->waits->given_up = true;
    if (!ok && err) *err = busy->err;
    catch_up(app, busy);
    wr_job_free(busy->job);
    wr_free(busy->what);
    wr_free(busy);
    wr_app_redraw(app);
    return ok;
}

void wr_busy_stop(WrApp *app)
{
    WrError err = { "" };
    WrBusy *busy = app->busy;
    if (!busy) return;
    wr_job_interrupt(busy->job);
    while (!is_done(busy)) SDL_Delay(LOOKS_MS);
    WrBusyDone *after = busy->after;
    void *ctx = busy->after_ctx;
    const bool ok = wr_busy_end(app, &err);
    if (after) after(app, ctx, ok, &err);
}

bool wr_busy_run(WrApp *app, WrBusyKind kind, const char *what, WrBusyWork *work, void *ctx,
                 WrError *err)
{
    wr_busy_settle(app);
    app->gave_up = false;
    if (app->busy) {
        wr_busy_refuse(app);
        return wr_fail(err, "%s: busy: another command is running", what);
    }
    if (app->drawn_at == 0.0) return work(app->session, ctx, err);
    const WrBusy busy = { .kind = kind, .what = (char *)what, .work = work, .ctx = ctx };
    if (!wr_busy_begin(app, &busy)) wr_busy_wait(app);
    return wr_busy_end(app, err);
}

static void forget(WrApp *app, void *ctx, bool ok, const WrError *err)
{
    (void)app;
    (void)ctx;
    (void)ok;
    (void)err;
}

void wr_background_upkeep_start(WrApp *app, const char *what, WrBusyWork *work, void *ctx)
{
    WrError err;
    if (app->busy) return;
    if (app->drawn_at == 0.0) {
        work(app->session, ctx, &err);
        return;
    }
    const WrBusy busy = {
        .kind = WR_BUSY_TEND, .what = (char *)what, .work = work, .ctx = ctx, .after = forget
    };
    if (wr_busy_begin(app, &busy)) wr_busy_end(app, NULL);
}

void wr_busy_fail(WrApp *app, const char *what, const WrError *err)
{
    if (app->gave_up) wr_app_say(app, "Cancelled: %s, nothing changed", what);
    else wr_app_fail(app, err);
}

/* Cancel for the user: the work ends soon. */
static void busy_cancel(WrBusy *busy)
{
    busy->cancelled = true;
    wr_job_interrupt(busy->job);
}

/* ---- actions during a background command ---- */

bool wr_busy_refuses(const WrApp *app)
{
    return app->busy && app->busy->kind != WR_BUSY_TEND;
}

bool wr_busy_is_young(const WrApp *app)
{
    return app->busy && wr_clock_seconds() - app->busy->since < WR_BUSY_MOMENT;
}

bool wr_busy_greys(const WrApp *app)
{
    return wr_busy_refuses(app) && !wr_busy_is_young(app);
}

void wr_busy_hold(const WrApp *app)
{
    wr_gui_hold(wr_busy_greys(app) ? "Busy: wait, or cancel the work" : NULL);
}

void wr_busy_hold_end(void)
{
    wr_gui_hold_end();
}

bool wr_busy_refuse(WrApp *app)
{
    if (!wr_busy_refuses(app)) return false;
    app->busy->refused_at = wr_clock_seconds();
    wr_app_redraw(app);
    return true;
}

bool wr_busy_close(WrApp *app)
{
    if (!app->busy) return false;
    app->busy->closes = true;
    wr_app_redraw(app);
    return true;
}

bool wr_busy_lets_wait(const WrApp *app)
{
    return app->busy && app->busy->kind != WR_BUSY_ANOTHER;
}

void wr_busy_settle(WrApp *app)
{
    if (app->in_frame || app->waits->running) return;
    /* Work with a waiting caller is finished by that caller, not here. */
    while (app->busy ? !wr_busy_refuses(app) && app->busy->after : app->waits->items.count > 0) {
        if (app->busy) app->registry->step(app);
        wr_busy_update(app);
    }
}

/* ---- for the main loop ---- */

static void waits_run(WrApp *app);

void wr_busy_update(WrApp *app)
{
    WrBusy *busy = app->busy;
    WrError err = { "" };
    if (app->in_frame) return;
    if (busy && busy->after && is_done(busy)) {
        WrBusyDone *after = busy->after;
        void *ctx = busy->after_ctx;
        const bool ok = wr_busy_end(app, &err);
        after(app, ctx, ok, &err);
    }
    if (!app->busy) waits_run(app);
}

static void open_late(WrApp *app, const char *path, bool dropped)
{
    if (!dropped) wr_app_drop(app, path);
}

static void drop_file(WrApp *app, char *path)
{
    char words[300];
    snprintf(words, sizeof words, wr_words("%.200s opens"),
             strrchr(path, '/') ? strrchr(path, '/') + 1 : path);
    wr_busy_put_off(app, words, open_late, path, false);
    SDL_free(path);
}

/* Escape first closes the nearest open list, dialog, text field or drag; only then it cancels the command. */
static bool gives_up(const WrApp *app, const SDL_Event *event)
{
    return event->type == SDL_KEYDOWN && event->key.keysym.sym == SDLK_ESCAPE &&
           wr_busy_refuses(app) && app->dialog->now == WR_DIALOG_NONE &&
           !wr_gui_popup_open_now(app->gui) && !wr_gui_wants_text(app->gui) &&
           app->hand->grab == WR_GRAB_NONE;
}

bool wr_busy_event(WrApp *app, const SDL_Event *event)
{
    WrBusy *busy = app->busy;
    if (!busy) return false;
    if (event->type == app->file_event) {
        busy->file_chosen = true;
        return true;
    }
    if (event->type == SDL_DROPFILE) {
        if (event->drop.file) drop_file(app, event->drop.file);
        return true;
    }
    if (!gives_up(app, event)) return false;
    busy_cancel(busy);
    return true;
}

bool wr_busy_view_event(WrApp *app, const SDL_Event *event)
{
    if (!app->busy || app->dialog->now != WR_DIALOG_NONE) return false;
    const bool begins = event->type == SDL_MOUSEBUTTONDOWN || event->type == SDL_MOUSEWHEEL;
    if (begins && wr_gui_owns_point(app->gui, app->hand->x, app->hand->y)) return false;
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->view_event && (*p)->view_event(app, event)) return true;
    return false;
}

/* ---- progress of the background command, in place of the status line or over the canvas ---- */

/* Text, bar, remaining time, Cancel, and queued actions. */

#define REFUSED_SECONDS 2.0 /* duration of the note about a refused action */

static void waits_words(const WrApp *app, const char *between, char *text, size_t size);

/* The command's name, or a note about actions requested meanwhile. */
static void say(const WrApp *app, bool refused, double wide)
{
    const WrBusy *busy = app->busy;
    const int count = app->waits->items.count;
    char waits[300], text[400];
    if (refused || busy->closes || count == 0) {
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG,
                        refused        ? "Busy: wait, or cancel the work"
                        : busy->closes ? "Closes when this work is done: wait, or cancel it"
                                       : busy->what,
                        wide);
        return;
    }
    waits_words(app, ", ", waits, sizeof waits);
    snprintf(text, sizeof text, wr_words(count == 1 ? "%d thing waits: %s" : "%d things wait: %s"),
             count, waits);
    wr_gui_as_it_is(true); /* already translated */
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, text, wide);
    wr_gui_as_it_is(false);
}

/* Narrow windows have shorter texts and a shorter bar, but all parts. */
static double squeezed(double wide, double share, double whole)
{
    double lacking = fmax(0.0, wr_gui_px(whole) - wr_gui_width());
    return fmax(wr_gui_px(20), wr_gui_px(wide) - share * lacking);
}

static void waits_drop(WrApp *app, WrDropped why);

static void drop_button(WrApp *app)
{
    char waits[600];
    waits_words(app, "\n", waits, sizeof waits);
    wr_gui_same_line(12);
    const bool drops = wr_gui_chip(NULL, "Drop waiting actions");
    wr_gui_as_it_is(true);
    wr_gui_tip(waits);
    wr_gui_as_it_is(false);
    if (drops) waits_drop(app, WR_DROPPED_WISH);
}

static void bar(WrApp *app, bool refused, double now)
{
    WrBusy *busy = app->busy;
    char seconds[24], left[WR_TIME_LEFT];
    const double took = now - busy->since;
    const bool waits = app->waits->items.count > 0;
    const double whole = waits ? 970 : 830;
    const double wide = squeezed(320, 0.6, whole), long_bar = squeezed(220, 0.4, whole);
    const double end = wr_gui_px(30) + wide + long_bar;
    say(app, refused, wide);
    wr_gui_same_line(12);
    wr_gui_move_to(wr_gui_px(30) + wide);
    wr_gui_progress(long_bar, busy->furthest > 0.0 ? busy->furthest : -1.0);
    wr_gui_same_line(12);
    wr_words_print(seconds, sizeof seconds, "%.1f s", took);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, seconds);
    wr_gui_same_line(12);
    wr_gui_move_to(end + wr_gui_px(70));
    wr_time_left_words(&busy->left, busy->furthest, took, left);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, busy->cancelled ? "cancelling" : left);
    wr_gui_same_line(12);
    wr_gui_move_to(end + wr_gui_px(160));
    if (wr_gui_chip(NULL, "Cancel")) busy_cancel(busy);
    wr_gui_tip("Escape");
    if (waits) drop_button(app);
}

/* The middle of the canvas, for work that replaces the document; false: no room. */
static bool canvas_place(const WrApp *app, SDL_Rect *place)
{
    const SDL_Rect *room = &app->layout->canvas;
    const int wide = wr_gui_px(380), tall = wr_gui_px(148), most = room->w - wr_gui_px(24);
    place->w = wide < most ? wide : most;
    place->h = tall;
    place->x = room->x + (room->w - place->w) / 2;
    place->y = room->y + (room->h - tall) / 2;
    return app->busy->kind == WR_BUSY_ANOTHER && place->w > wr_gui_px(200) && room->h > tall;
}

/* The file, how far it is, the time and Cancel, over the document that is still shown. */
static void canvas_bar(WrApp *app, bool refused, double now)
{
    WrBusy *busy = app->busy;
    char left[WR_TIME_LEFT], text[WR_TIME_LEFT + 40];
    const char *path = app->file->opening ? app->file->opening : "", *slash = strrchr(path, '/');
    const double took = now - busy->since;
    say(app, refused, wr_gui_available());
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_BOLD, WR_COLOUR_STRONG, slash ? slash + 1 : path, wr_gui_available());
    wr_gui_as_it_is(false);
    wr_gui_progress(wr_gui_available(), busy->furthest > 0.0 ? busy->furthest : -1.0);
    if (wr_gui_chip(NULL, "Cancel")) busy_cancel(busy);
    wr_gui_tip("Escape");
    wr_gui_same_line(12);
    wr_time_left_words(&busy->left, busy->furthest, took, left);
    wr_words_print(text, sizeof text, "%.1f s  %s", took,
                   busy->cancelled ? wr_words("cancelling") : left);
    wr_gui_as_it_is(true);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    wr_gui_as_it_is(false);
}

bool wr_busy_bar(WrApp *app)
{
    WrBusy *busy = app->busy;
    SDL_Rect room = app->layout->status, place;
    const double now = wr_clock_seconds();
    const int tall = wr_gui_px(28);
    double fraction = 0.0;
    if (!busy) return false;
    wr_job_busy(busy->job, &fraction, NULL);
    if (fraction > busy->furthest) busy->furthest = fraction;
    const bool refused = now - busy->refused_at < REFUSED_SECONDS;
    if (canvas_place(app, &place)) {
        wr_gui_area_begin("##opening", WR_AREA_PANEL, place,
                          refused ? WR_COLOUR_REFUSED : WR_COLOUR_PANEL);
        canvas_bar(app, refused, now);
        wr_gui_area_end();
        return false;
    }
    if (wr_busy_is_young(app)) return false;
    if (room.w <= 0) room = (SDL_Rect){ 0, app->height - tall, app->width, tall };
    wr_gui_area_begin("##busy", WR_AREA_BAR, room, refused ? WR_COLOUR_REFUSED : WR_COLOUR_BAR);
    bar(app, refused, now);
    wr_gui_area_end();
    return true;
}

/* ---- queue of actions requested during a background command ---- */

/* Run in order afterwards, or dropped with a message. */

/* Lines refer to layers by number, so another set or order of layers must change the key. */
static uint64_t layers_key(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    WrHash hash = { .low = (uint64_t)document->layer_count };
    for (int i = 0; i < document->layer_count; i++)
        hash = wr_hash_bytes(document->layers[i].name, strlen(document->layers[i].name), hash);
    return hash.low | 1;
}

void wr_busy_put_off(WrApp *app, const char *words, WrBusyLate *late, const char *text,
                     bool of_layers)
{
    wr_array_push(&app->waits->items, ((WrWaiting){ .late = late,
                                                    .text = wr_strdup(text),
                                                    .words = wr_strdup(words),
                                                    .layers = of_layers ? layers_key(app) : 0 }));
    wr_app_redraw(app);
}

bool wr_busy_runs_queue(const WrApp *app)
{
    return app->waits->running;
}

static WrWaiting take(WrWaits *waits, int index)
{
    WrWaiting taken = waits->items.data[index];
    waits->items.count--;
    memmove(waits->items.data + index, waits->items.data + index + 1,
            (size_t)(waits->items.count - index) * sizeof *waits->items.data);
    return taken;
}

static void fini(WrWaiting *waiting)
{
    wr_free(waiting->text);
    wr_free(waiting->words);
}

void wr_busy_take_back(WrApp *app, WrBusyLate *late, const char *text)
{
    WrWaits *waits = app->waits;
    for (int i = waits->items.count - 1; i >= 0; i--) {
        if (waits->items.data[i].late != late || strcmp(waits->items.data[i].text, text) != 0)
            continue;
        WrWaiting taken = take(waits, i);
        fini(&taken);
        wr_app_redraw(app);
        return;
    }
}

/* Names of the queued actions, separated by `between`. */
static void waits_words(const WrApp *app, const char *between, char *text, size_t size)
{
    const WrWaits *waits = app->waits;
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < waits->items.count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? between : "",
                                 waits->items.data[i].words);
}

/* With a message. */
static void waits_drop(WrApp *app, WrDropped why)
{
    char words[300];
    if (app->waits->items.count == 0) return;
    waits_words(app, ", ", words, sizeof words);
    while (app->waits->items.count > 0) {
        WrWaiting first = take(app->waits, 0);
        first.late(app, first.text, true);
        fini(&first);
    }
    if (why == WR_DROPPED_CANCELLED)
        wr_app_say(app, "Cancelled, with the actions that waited for it: %s", words);
    if (why == WR_DROPPED_LAYERS)
        wr_app_say(app, "Not done, because the layers have changed: %s", words);
    if (why == WR_DROPPED_WISH) wr_app_say(app, "Not done any more: %s", words);
}

static void waits_run(WrApp *app)
{
    WrWaits *waits = app->waits;
    if (waits->running) return;
    if (waits->given_up) waits_drop(app, WR_DROPPED_CANCELLED);
    waits->given_up = false;
    waits->running = true;
    while (waits->items.count > 0 && !app->busy) {
        if (waits->items.data[0].layers && waits->items.data[0].layers != layers_key(app)) {
            waits_drop(app, WR_DROPPED_LAYERS);
            break;
        }
        WrWaiting first = take(waits, 0);
        first.late(app, first.text, false);
        fini(&first);
        if (waits->given_up) break;
    }
    waits->running = false;
}

void wr_busy_free(WrApp *app)
{
    for (int i = 0; i < app->waits->items.count; i++) fini(&app->waits->items.data[i]);
    wr_array_free(&app->waits->items);
}
