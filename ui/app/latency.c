/* Latency measurement: a thread scribbles with a simulated mouse at real speed, and each frame records the events it
   shows. */
#include "ui/app/latency.h"
#include "ui/app/app.h"
#include "ui/app/loop.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/view.h"
#include "ui/patch/patch.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/patch/preview/preview.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/font_list.h"
#include "image/image.h"
#include "system/clock.h"
#include "system/process.h"
#include "system/thread.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EVENTS_A_SECOND 125
#define STROKE_EVENTS 500 /* events per stroke; then the button is released briefly */
#define PAUSE_EVENTS 25
#define SETTLE_SECONDS 1.5 /* before the first event: first frames, caches */
#define MAX_SECONDS 60.0   /* limit for the start with a large table */
#define BUSY 0.10          /* processor load above which the window is not idle */
#define LAST_SECONDS 5.0   /* time after the last event for its display */

struct WrLatency {
    int64_t count; /* number of events */
    /* [count] clock when the system had event i; written by the thread before it is sent, read
       after its arrival */
    double *at;
    float *delay[3]; /* [count] ms until displayed: pointer, canvas, preview */
    int64_t seen[3]; /* events displayed so far */
    bool *paints;    /* [count] the button is pressed */
    int64_t pictures;
    SDL_Rect room; /* of the canvas */
    Uint32 window_id;
    volatile int stop; /* atomic */
    WrThread thread;
};

/* ---- the scribble ---- */

/* Pseudo-random motion in circles and zigzags that never repeats; 0..1 in both directions. */
static void scribble(double t, double *x, double *y)
{
    *x = 0.5 + 0.28 * sin(2.9 * t) + 0.13 * sin(11.3 * t + 1) + 0.02 * sin(47 * t);
    *y = 0.5 + 0.26 * cos(2.3 * t) + 0.14 * sin(9.1 * t) + 0.02 * cos(53 * t);
}

static SDL_Event event_at(const WrLatency *latency, int64_t i)
{
    int64_t phase = i % (STROKE_EVENTS + PAUSE_EVENTS);
    double x, y;
    SDL_Event event = { 0 };
    scribble((double)i / EVENTS_A_SECOND, &x, &y);
    int px = latency->room.x + (int)(x * latency->room.w);
    int py = latency->room.y + (int)(y * latency->room.h);
    if (phase == 0 || phase == STROKE_EVENTS) {
        event.button =
            (SDL_MouseButtonEvent){ .type = phase == 0 ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                    .timestamp = SDL_GetTicks(),
                                    .windowID = latency->window_id,
                                    .button = SDL_BUTTON_LEFT,
                                    .state = phase == 0 ? SDL_PRESSED : SDL_RELEASED,
                                    .clicks = 1,
                                    .x = px,
                                    .y = py };
    } else {
        event.motion = (SDL_MouseMotionEvent){ .type = SDL_MOUSEMOTION,
                                               .timestamp = SDL_GetTicks(),
                                               .windowID = latency->window_id,
                                               .x = px,
                                               .y = py };
    }
    return event;
}

static void *feed(void *arg)
{
    WrLatency *latency = arg;
    double start = wr_clock_seconds();
    for (int64_t i = 0; i < latency->count; i++) {
        double wait = start + (double)i / EVENTS_A_SECOND - wr_clock_seconds();
        if (__atomic_load_n(&latency->stop, __ATOMIC_RELAXED)) break;
        if (wait > 0.0) SDL_Delay((Uint32)(wait * 1e3 + 0.5));
        SDL_Event event = event_at(latency, i);
        latency->at[i] = wr_clock_seconds();
        SDL_PushEvent(&event);
    }
    return NULL;
}

/* ---- displayed events ---- */

static void note(WrLatency *latency, int which, int64_t upto, double now)
{
    int64_t *seen = &latency->seen[which];
    for (; *seen < upto && *seen < latency->count; (*seen)++)
        latency->delay[which][*seen] = (float)((now - latency->at[*seen]) * 1e3);
}

static void drawn(WrApp *app)
{
    WrLatency *latency = app->latency;
    double now = wr_clock_seconds();
    latency->pictures++;
    note(latency, 0, app->hand->events, now);
    note(latency, 1, app->brush->shown, now);
    note(latency, 2, app->patch->seen, now);
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Sorts `ms` in place. */
static WrAppDelays percentiles(float *ms, int count)
{
    if (count == 0) return (WrAppDelays){ 0 };
    qsort(ms, (size_t)count, sizeof *ms, ascending);
    return (WrAppDelays){ (double)ms[count / 2], (double)ms[(int)(0.95 * count)],
                          (double)ms[(int)(0.99 * count)], (double)ms[count - 1] };
}

static WrAppDelays summarise(const WrLatency *latency, int which)
{
    float *ms = wr_alloc((size_t)latency->count, sizeof *ms);
    int count = 0;
    for (int64_t i = 0; i < latency->seen[which]; i++)
        if (latency->paints[i] || which == 0) ms[count++] = latency->delay[which][i];
    const WrAppDelays out = percentiles(ms, count);
    wr_free(ms);
    return out;
}

/* ---- the run ---- */

static void step_for(WrApp *app, double seconds)
{
    double end = wr_clock_seconds() + seconds;
    while (wr_clock_seconds() < end && !app->quit) {
        SDL_Event nothing = { .type = app->job_event }; /* ends a step that waits for events */
        SDL_PushEvent(&nothing);
        wr_app_step(app);
        SDL_Delay(4);
    }
}

static bool stopped(const WrApp *app)
{
    return app->quit || wr_cancel_requested(app->options->cancel);
}

/* ---- idle load ---- */

typedef struct Alarm {
    double seconds;
    Uint32 event;
    double at, processor; /* clock and processor time of the program when the timer fires */
    volatile int rang;    /* atomic */
} Alarm;

static void *ring(void *arg)
{
    Alarm *alarm = arg;
    SDL_Delay((Uint32)(alarm->seconds * 1e3));
    alarm->at = wr_clock_seconds();
    alarm->processor = wr_clock_process_seconds();
    __atomic_store_n(&alarm->rang, 1, __ATOMIC_RELEASE);
    SDL_Event event = { .type = alarm->event };
    SDL_PushEvent(&event);
    return NULL;
}

static void wait_once(WrApp *app)
{
    SDL_Event event;
    (void)app;
    SDL_WaitEvent(&event);
}

/* Processor load during repeated calls of `step` without input. */
static double share_of(WrApp *app, void (*step)(WrApp *app), double seconds)
{
    WrThread thread;
    Alarm alarm = { .seconds = seconds, .event = app->job_event };
    if (!wr_thread_begin(&thread, ring, &alarm)) return 0.0;
    const double start = wr_clock_seconds(), before = wr_clock_process_seconds();
    while (!__atomic_load_n(&alarm.rang, __ATOMIC_ACQUIRE) && !app->quit) step(app);
    wr_thread_join(thread);
    return (alarm.processor - before) / (alarm.at - start);
}

/* Without a display SDL polls for events a thousand times per second, which is not the window's load. */
static double measure_idle(WrApp *app, double seconds)
{
    const double both = share_of(app, wr_app_step, seconds);
    return fmax(0.0, both - share_of(app, wait_once, fmin(seconds, 2.0)));
}

/* Draw the first frames and fill caches, however long that lasts with a large table. */
static void settle(WrApp *app)
{
    const double end = wr_clock_seconds() + MAX_SECONDS;
    while (share_of(app, wr_app_step, 1.0) > BUSY && wr_clock_seconds() < end && !stopped(app))
        continue;
}

static bool all_seen(const WrLatency *latency)
{
    return latency->seen[1] >= latency->count && latency->seen[2] >= latency->count;
}

static bool measure(WrApp *app, WrLatency *latency, WrError *err)
{
    step_for(app, SETTLE_SECONDS);
    latency->room = app->layout->canvas;
    latency->window_id = SDL_GetWindowID(app->window);
    latency->pictures = 0;
    app->hand->events = 0;
    app->brush->taken = app->brush->shown = app->patch->seen = 0;
    if (latency->room.w <= 0) return wr_fail(err, "the window has no canvas");
    if (!wr_thread_begin(&latency->thread, feed, latency))
        return wr_fail(err, "no thread can be created");
    while (app->hand->events < latency->count && !stopped(app)) wr_app_step(app);
    __atomic_store_n(&latency->stop, 1, __ATOMIC_RELAXED);
    wr_thread_join(latency->thread);
    if (stopped(app)) return wr_fail(err, "interrupted");
    double end = wr_clock_seconds() + LAST_SECONDS;
    wr_input_router_let_go(app);
    while (!all_seen(latency) && wr_clock_seconds() < end) step_for(app, 0.02);
    if (latency->seen[1] == 0 || latency->seen[2] == 0)
        return wr_fail(err, "no painted stroke was ever shown");
    return true;
}

bool wr_app_latency(const WrAppOptions *options, WrAppLatency *out, WrError *err)
{
    if (!(out->seconds >= 0.5 && out->seconds <= 600.0))
        return wr_fail(err, "%g seconds of scribbling: must be 0.5..600", out->seconds);
    WrLatency latency = { .count = (int64_t)(out->seconds * EVENTS_A_SECOND) };
    latency.at = wr_alloc((size_t)latency.count, sizeof *latency.at);
    latency.paints = wr_alloc((size_t)latency.count, sizeof *latency.paints);
    for (int k = 0; k < 3; k++) latency.delay[k] = wr_alloc((size_t)latency.count, sizeof(float));
    for (int64_t i = 0; i < latency.count; i++)
        latency.paints[i] = i % (STROKE_EVENTS + PAUSE_EVENTS) < STROKE_EVENTS;
    WrAppOptions own = *options;
    own.width = out->width > 0 ? out->width : 1440;
    own.height = out->height > 0 ? out->height : 900;
    own.file_given = true;
    WrApp *app = wr_store_new();
    app->options = &own;
    app->session = options->session;
    app->latency = &latency;
    app->drawn = drawn;
    app->started_at = wr_clock_seconds();
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    bool good = wr_app_begin(app, err);
    if (good) {
        app->settings->turning = false;
        if (out->idle_seconds > 0.0) settle(app), out->idle = measure_idle(app, out->idle_seconds);
        app->settings->turning = out->turning;
        app->settings->brush.radius = out->radius;
        app->settings->brush.strength = 0.02;
        good = measure(app, &latency, err);
    }
    if (good) {
        out->events = latency.count;
        out->pictures = latency.pictures;
        out->pointer = summarise(&latency, 0);
        out->canvas = summarise(&latency, 1);
        out->preview = summarise(&latency, 2);
    }
    wr_app_end(app);
    wr_free(app);
    wr_free(latency.at);
    wr_free(latency.paints);
    for (int k = 0; k < 3; k++) wr_free(latency.delay[k]);
    return good;
}

/* ---- single changes ---- */

#define MOVE_SECONDS (1.0 / 60.0) /* between two pans or zooms */
#define MOMENT_SECONDS 30.0       /* limit for the display of one change */

/* Delays of all changes, in ms. */
typedef struct Moment {
    WR_ARRAY(float) first, exact, preview;
    /* clock of the first frame since the change, and of the first exact one; 0: none */
    double shown, finished;
} Moment;

/* Of the running measurement: `drawn` has no other argument than the window. */
static Moment *moment_now;

static void moment_drawn(WrApp *app)
{
    const double now = wr_clock_seconds();
    if (moment_now->shown == 0.0) moment_now->shown = now;
    if (moment_now->finished == 0.0 && !app->canvas_unfinished) moment_now->finished = now;
}

/* Step until everything is shown: canvas, patch and widgets. */
static void rest(WrApp *app, double seconds)
{
    const double end = wr_clock_seconds() + seconds;
    while (wr_clock_seconds() < end && !stopped(app) &&
           (app->canvas_unfinished || app->busy || !wr_preview_settled(app->preview) ||
            app->patch->outstanding))
        step_for(app, 0.004);
}

static bool change_by_line(WrApp *app, Moment *moment, const char *line, WrError *err)
{
    rest(app, MOMENT_SECONDS);
    step_for(app, 0.05);
    const int64_t tag = ++app->hand->events;
    const double start = wr_clock_seconds(), end = start + MOMENT_SECONDS;
    moment->shown = moment->finished = 0.0;
    if (!wr_app_run_line(app, line)) return wr_fail(err, "the window cannot run %s", line);
    while ((moment->finished == 0.0 || app->patch->seen < tag) && wr_clock_seconds() < end) {
        if (stopped(app)) return wr_fail(err, "interrupted");
        wr_app_step(app);
    }
    wr_array_push(&moment->first, (float)((moment->shown - start) * 1e3));
    wr_array_push(&moment->exact, (float)((moment->finished - start) * 1e3));
    wr_array_push(&moment->preview, (float)((wr_clock_seconds() - start) * 1e3));
    return true;
}

/* Pans and zooms between the whole table and a third of its size, about a moving point. */
static void move_view(WrApp *app, int i)
{
    WrCanvasView *view = app->view;
    const double x = view->x + view->w * (0.5 + 0.3 * sin(0.7 * i)),
                 y = view->y + view->h * (0.5 + 0.3 * cos(0.9 * i));
    if (i % 40 < 20) wr_view_pan(view, 11.0 + i % 7, 5.0 - i % 11);
    else wr_view_zoom_at(view, x, y, view->zoom * (i % 80 < 40 ? 1.06 : 1.0 / 1.06));
    wr_app_redraw(app);
}

static bool change_view(WrApp *app, Moment *moment, int i, WrError *err)
{
    const double start = wr_clock_seconds();
    moment->shown = moment->finished = 0.0;
    move_view(app, i);
    while (moment->shown == 0.0 || wr_clock_seconds() < start + MOVE_SECONDS) {
        if (stopped(app)) return wr_fail(err, "interrupted");
        if (moment->shown == 0.0) wr_app_step(app);
        else step_for(app, 0.001);
    }
    wr_array_push(&moment->first, (float)((moment->shown - start) * 1e3));
    return true;
}

static bool measure_moments(WrApp *app, Moment *moment, const WrAppMoments *wanted, WrError *err)
{
    int lines = 0;
    while (wanted->lines && wanted->lines[lines]) lines++;
    step_for(app, SETTLE_SECONDS);
    rest(app, MAX_SECONDS);
    app->hand->events = app->brush->taken = app->brush->shown = app->patch->seen = 0;
    for (int i = 0; i < wanted->rounds; i++)
        if (!(lines ? change_by_line(app, moment, wanted->lines[i % lines], err)
                    : change_view(app, moment, i, err)))
            return false;
    if (lines) return true;
    const double start = wr_clock_seconds();
    rest(app, MOMENT_SECONDS);
    wr_array_push(&moment->exact, (float)((wr_clock_seconds() - start) * 1e3));
    return true;
}

bool wr_app_moments(const WrAppOptions *options, WrAppMoments *out, WrError *err)
{
    if (!(out->rounds >= 1 && out->rounds <= 10000))
        return wr_fail(err, "%d changes: must be 1..10000", out->rounds);
    WrLatency latency = { 0 };
    Moment moment = { 0 };
    WrAppOptions own = *options;
    own.width = out->width > 0 ? out->width : 1440;
    own.height = out->height > 0 ? out->height : 900;
    own.file_given = true;
    WrApp *app = wr_store_new();
    app->options = &own;
    app->session = options->session;
    app->latency = &latency;
    app->drawn = moment_drawn;
    app->started_at = wr_clock_seconds();
    moment_now = &moment;
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    bool good = wr_app_begin(app, err);
    if (good) {
        app->settings->turning = false;
        good = measure_moments(app, &moment, out, err);
        rest(app, MOMENT_SECONDS);
        out->resident = wr_process_resident();
    }
    out->first = percentiles(moment.first.data, moment.first.count);
    out->exact = percentiles(moment.exact.data, moment.exact.count);
    out->preview = percentiles(moment.preview.data, moment.preview.count);
    wr_app_end(app);
    wr_free(app);
    wr_array_free(&moment.first);
    wr_array_free(&moment.exact);
    wr_array_free(&moment.preview);
    return good;
}

/* ---- frame times of the window on request ---- */

/* WRINKLE_TIMING: print milliseconds to the first frame at once, the rest at the end. A value above 1 is the clock at
   the start command: times are counted from it, and the window closes. */
static void report_first(WrApp *app)
{
    const char *asked = getenv("WRINKLE_TIMING");
    double from;
    if (!asked) return;
    const bool timed = wr_number_parse(asked, strlen(asked), &from) && from > 1;
    fprintf(stderr, "first picture after %.1f ms\n",
            (wr_clock_seconds() - (timed ? from : app->started_at)) * 1e3);
    if (timed) app->quit = true;
}

void wr_timing_note(WrApp *app, double seconds)
{
    WrTiming *t = app->timing;
    if (t->pictures++ == 0) report_first(app);
    /* Start the reader process and load the list of fonts after the first frames, so that the first picture file loads fast
       and the start is not delayed. */
    if (t->pictures == 2 && !app->latency) {
        wr_image_warm();
        wr_font_config_begin();
    }
    t->seconds += seconds;
    t->slowest = seconds > t->slowest ? seconds : t->slowest;
}

void wr_timing_report(const WrApp *app)
{
    const WrTiming *t = app->timing;
    const WrPreviewPicture *p = wr_preview_picture(app->preview);
    if (!getenv("WRINKLE_TIMING") || t->pictures == 0) return;
    fprintf(
        stderr,
        "%d pictures of the window, %.2f ms each, slowest %.2f ms; %llu of the patch in %.1f s\n",
        t->pictures, t->seconds / t->pictures * 1e3, t->slowest * 1e3,
        (unsigned long long)p->serial, wr_clock_seconds() - app->started_at);
}
