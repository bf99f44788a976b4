/* Scheduling of measurements, and their results. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_schedule.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/patch/patch.h"
#include "ui/patch/preview/preview.h"
#include "ui/app/jobs/job.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/stroke_input.h"

#include "accuracy/accuracy_benchmark.h"
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_table.h"
#include "command/session.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "field/scheme.h"
#include "field/scheme_list.h"
#include "render/reference/reference.h"
#include "scene/dials.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void note_view(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    const WrField *field = wr_app_field(app);
    const WrScene *scene = wr_app_scene(app);
    const SDL_Rect *room = &app->layout->patch;
    WrTables *tables =
        wr_document_tables(wr_app_document(app), scene, &app->patch->table_cache, NULL);
    bool same = a->field && wr_field_key(a->field) == wr_field_key(field) && a->scene == scene &&
                wr_tables_same(a->tables, tables) && a->turn_deg == app->patch->turn_deg &&
                a->width == room->w && a->height == room->h;
    if (same) {
        wr_tables_free(tables);
        return;
    }
    WrField *fresh = wr_field_share(field);
    WrScene *shared = wr_scene_share(scene);
    wr_field_free(a->field);
    if (a->scene) wr_scene_free(a->scene);
    a->field = fresh;
    a->scene = shared;
    wr_tables_free(a->tables);
    a->tables = tables;
    a->turn_deg = app->patch->turn_deg;
    a->width = room->w;
    a->height = room->h;
    a->state++;
    a->changed_at = wr_clock_seconds();
    if (a->measuring && a->measures != WR_WORK_CASES) { /* it concerns another state */
        wr_job_cancel(a->measure);
        a->measuring = false;
    }
    wr_job_cancel(a->looker);
    a->look_of = 0;
}

static bool same_dials(const WrScene *a, const WrScene *b)
{
    for (int d = 0; d < WR_DIAL_COUNT; d++)
        if (wr_dials[d].get(a) != wr_dials[d].get(b)) return false;
    return true;
}

static int rung_of(const WrAccuracy *a, const WrScene *scene)
{
    int found = -1;
    for (int i = 0; a->plot && found < 0 && i < a->plot->benchmark.count; i++) {
        WrScene *with = wr_setting_apply(&a->plot->benchmark.rungs[i].setting, a->plot->scene);
        if (same_dials(with, scene)) found = i;
        wr_scene_free(with);
    }
    return found;
}

static void look_for_fit(WrAccuracy *a)
{
    if (a->fits_of == a->state) return;
    a->fits_of = a->state;
    a->fits = a->plot && a->plot_key == wr_field_key(a->field) && a->plot_turn == a->turn_deg;
    a->rung = -1;
    if (!a->fits) return;
    char *base = wr_accuracy_base(a->scene);
    a->fits = strcmp(base, a->plot_base) == 0;
    wr_free(base);
    if (a->fits) a->rung = rung_of(a, a->scene);
}

bool wr_accuracy_plot_fits(const WrApp *app)
{
    look_for_fit(app->accuracy);
    return app->accuracy->fits;
}

int wr_accuracy_current_rung(const WrApp *app)
{
    look_for_fit(app->accuracy);
    return app->accuracy->rung;
}

/* ---- results ---- */

static void take_benchmark(WrAccuracy *a, WrWork *work)
{
    wr_work_free(a->plot);
    wr_free(a->plot_base);
    a->plot = work;
    a->plot_base = wr_accuracy_base(work->scene);
    a->plot_key = wr_field_key(work->field);
    a->plot_turn = work->turn_deg;
    a->plot_hot = -1;
    a->fits_of = 0;
}

static void take_measured(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    WrWork *work = wr_job_take(a->measure);
    if (!work) return;
    a->measuring = false;
    if (work->kind == WR_WORK_ERROR) {
        a->error_of = work->of;
        a->error_why = work->done ? (WrError){ "" } : work->err;
        if (work->done) {
            wr_work_free(a->error);
            a->error = work;
            return;
        }
    } else if (work->kind == WR_WORK_BENCHMARK) {
        a->plot_failed = work->of; /* once is enough; a new state is tried again */
        if (work->done) {
            take_benchmark(a, work);
            return;
        }
        if (strcmp(work->err.text, "cancelled") != 0) wr_app_fail(app, &work->err);
    } else if (work->kind == WR_WORK_ILLUSION && work->done) {
        wr_work_free(a->illusion);
        a->illusion = work;
        return;
    } else if (work->done) {
        wr_free(a->cases.report);
        a->cases.report = work->report;
        work->report = NULL;
    } else if (strcmp(work->err.text, "cancelled") != 0) {
        wr_app_fail(app, &work->err);
    }
    wr_work_free(work);
}

static void take_look(WrApp *app)
{
    WrWork *work = wr_job_take(app->accuracy->looker);
    if (!work) return;
    if (work->done) wr_accuracy_lay(app, work);
    else wr_app_fail(app, &work->err);
    if (work->done && work->kind == WR_WORK_ILLUSION) { /* its numbers go to the panel */
        wr_work_free(app->accuracy->illusion);
        app->accuracy->illusion = work;
        return;
    }
    wr_work_free(work);
}

static void name_object(const WrWork *work, WrInspector *inspector)
{
    char buffer[WR_OBJECT_LABEL];
    const bool several = wr_scene_object_count(work->scene) > 1;
    snprintf(inspector->object, sizeof inspector->object, "%s",
             several ? wr_scene_object_label(work->scene, work->object, buffer) : "");
}

static void take_probe(WrApp *app)
{
    WrInspector *inspector = &app->accuracy->inspector;
    WrWork *work = wr_job_take(app->accuracy->prober);
    if (!work) return;
    inspector->known = work->done && work->probe.hit;
    inspector->seen = work->seen;
    inspector->probe = work->probe;
    name_object(work, inspector);
    inspector->copied = false;
    wr_work_free(work);
}

/* ---- due work ---- */

static WrWork *new_work(WrApp *app, WrWorkKind kind, WrWorkTools *tools)
{
    WrAccuracy *a = app->accuracy;
    WrWork *work = wr_work_new(kind, tools, a->field, a->scene, a->turn_deg, a->width, a->height);
    work->of = a->state;
    work->tables = wr_tables_share(a->tables);
    return work;
}

static void measure(WrApp *app, WrWorkKind kind)
{
    WrAccuracy *a = app->accuracy;
    wr_job_start(a->measure, new_work(app, kind, &a->measure_tools));
    a->measuring = true;
    a->measures = kind;
}

/* True if a result of the error, the plot or the map would be seen. */
static bool is_seen(const WrAccuracy *a)
{
    return a->error_open || a->look == WR_PATCH_ERROR;
}

/* A measurement needs all processors, some for minutes: it ends when its tab is left, and begins again with the tab. */
static void stop_unseen(WrAccuracy *a)
{
    if (!a->measuring || a->measures == WR_WORK_CASES || is_seen(a)) return;
    wr_job_cancel(a->measure);
    a->measuring = false;
    if (a->measures == WR_WORK_ILLUSION) a->illusion_wanted = true;
}

static WrAccuracyMoment moment(const WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    WrAccuracyMoment m = { .now = wr_clock_seconds(),
                           .changed_at = a->changed_at,
                           .rests = wr_accuracy_rests(app),
                           .open = is_seen(a),
                           .plot_open = a->plot_open,
                           .plot_asked = a->plot_asked,
                           .error_known = a->error_of == a->state,
                           .busy = a->measuring };
    if (m.rests && !m.busy && m.plot_open)
        m.plot_known = a->plot_failed == a->state || wr_accuracy_current_rung(app) >= 0;
    return m;
}

static void begin_measuring(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    double due;
    if (a->cases.wanted &&
        !wr_accuracy_busy(app, WR_WORK_CASES, NULL)) { /* the user waits for them */
        a->cases.wanted = false;
        measure(app, WR_WORK_CASES); /* replaces running work, which restarts later */
        return;
    }
    if (a->illusion_wanted && is_seen(a) && !a->measuring && wr_accuracy_rests(app)) {
        a->illusion_wanted = false;
        measure(app, WR_WORK_ILLUSION);
        return;
    }
    WrAccuracyMoment m = moment(app);
    switch (wr_accuracy_next(&m, &due)) {
    case WR_ACCURACY_NOTHING: break;
    case WR_ACCURACY_ERROR: measure(app, WR_WORK_ERROR); return;
    case WR_ACCURACY_BENCHMARK:
        a->plot_asked = false;
        measure(app, WR_WORK_BENCHMARK);
        return;
    }
}

static bool compares(const WrAccuracy *a)
{
    return a->look == WR_PATCH_SPLIT || a->look == WR_PATCH_FLICKER || a->hold_b;
}

/* True if pictures or a map are needed, missing and not yet requested. */
static bool look_missing(const WrAccuracy *a)
{
    if (a->look == WR_PATCH_ERROR && !a->hold_b) return false;
    if (!compares(a) && (a->look == WR_PATCH_PLAIN || a->look == WR_PATCH_RAN)) return false;
    int kind = compares(a) ? WR_PATCH_SPLIT : (int)a->look;
    return a->look_of != a->state || a->look_kind != kind ||
           (compares(a) && a->look_serial != a->b_serial);
}

static void begin_looking(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    if (!look_missing(a) || !wr_accuracy_rests(app) ||
        wr_clock_seconds() < a->changed_at + WR_ACCURACY_LOOK_REST)
        return;
    bool pair = compares(a);
    const WrWorkKind map = a->look == WR_PATCH_LACKS ? WR_WORK_ILLUSION : WR_WORK_MAP;
    WrWork *work = new_work(app, pair ? WR_WORK_PAIR : map, &a->look_tools);
    work->map = wr_accuracy_map_of(a->look);
    if (pair) work->other = wr_accuracy_scene(app, 1);
    a->look_of = a->state;
    a->look_kind = pair ? WR_PATCH_SPLIT : (int)a->look;
    a->look_serial = a->b_serial;
    wr_job_start(a->looker, work);
}

static void begin_probing(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    WrInspector *in = &a->inspector;
    if (!app->settings->inspector || !in->have || app->layout->patch.w <= 0) return;
    if (in->asked_of == a->state && in->asked_table == in->on_table && in->asked_x == in->x &&
        in->asked_y == in->y)
        return;
    if (wr_job_busy(a->prober, NULL, NULL))
        return; /* the newest position is requested after the present one */
    in->asked_of = a->state;
    in->asked_table = in->on_table;
    in->asked_x = in->x;
    in->asked_y = in->y;
    WrWork *work = new_work(app, WR_WORK_PROBE, &a->probe_tools);
    work->on_table = in->on_table;
    work->x = in->on_table ? in->x : in->x * a->width;
    work->y = in->on_table ? in->y : in->y * a->height;
    wr_job_start(a->prober, work);
}

static void note_times(WrApp *app)
{
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    if (picture->serial == app->accuracy->full_times.serial || picture->level < WR_PREVIEW_FULL)
        return;
    app->accuracy->full_times = *picture;
    app->accuracy->full_times.bgra = NULL;
    app->accuracy->full_times.kept = NULL;
}

/* Fetch finished work and start due work; once before each frame. */
static void accuracy_update(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    if (app->drawn_at == 0.0) return;
    if (a->hold_key != SDLK_UNKNOWN && SDL_GetKeyboardFocus() != app->window)
        a->hold_b = false; /* the key's release would be missed */
    note_view(app);
    note_times(app);
    take_measured(app);
    take_look(app);
    take_probe(app);
    stop_unseen(a);
    if (!app->visible) return;
    begin_measuring(app);
    begin_looking(app);
    wr_inspector_follow(app);
    begin_probing(app);
    double next;
    if (a->look != WR_PATCH_FLICKER || a->pair[1].of != a->state) return;
    bool shown = wr_accuracy_flicker(wr_clock_seconds(), a->flicker_since, &next);
    if (shown != a->flicker_shown) wr_app_redraw(app);
}

/* Clock of the next work; 0: none. */
static double next_work(const WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    double due = 0.0, next = a->changed_at + WR_ACCURACY_LOOK_REST;
    if (!app->visible || app->drawn_at == 0.0) return 0.0;
    WrAccuracyMoment m = moment(app);
    wr_accuracy_next(&m, &due);
    if (look_missing(a) && m.rests && (due == 0.0 || next < due)) due = next;
    return due;
}

bool wr_accuracy_pending(const WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    return a->measuring || wr_job_busy(a->looker, NULL, NULL) ||
           wr_job_busy(a->prober, NULL, NULL) || next_work(app) > 0.0;
}

static double accuracy_next_time(const WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    double due = next_work(app), next;
    if (!app->visible || app->drawn_at == 0.0) return 0.0;
    if (a->look == WR_PATCH_FLICKER && !a->hold_b && a->pair[1].of == a->state) {
        wr_accuracy_flicker(wr_clock_seconds(), a->flicker_since, &next);
        if (due == 0.0 || next < due) due = next;
    }
    return due;
}

bool wr_accuracy_busy(WrApp *app, WrWorkKind kind, double *fraction)
{
    WrAccuracy *a = app->accuracy;
    return a->measuring && a->measures == kind && wr_job_busy(a->measure, fraction, NULL);
}

static void accuracy_forget(WrApp *app);

/* a progress bar is visible */
static bool accuracy_works(WrApp *app)
{
    return wr_accuracy_busy(app, WR_WORK_BENCHMARK, NULL) ||
           wr_accuracy_busy(app, WR_WORK_ILLUSION, NULL) ||
           wr_accuracy_busy(app, WR_WORK_CASES, NULL);
}

const WrPart wr_part_accuracy = { .update = accuracy_update,
                                  .next_time = accuracy_next_time,
                                  .works = accuracy_works,
                                  .draw = wr_accuracy_draw,
                                  .forget = accuracy_forget };

/* ---- changes of dials ---- */

/* Of A, the scene, by commands; of B, which is only in the window. */

/* Initial dials of B: almost no error. */
static void give_b(WrAccuracy *a, const WrScene *scene)
{
    if (a->b_given) return;
    a->b_given = true;
    for (int d = 0; d < WR_DIAL_COUNT; d++) a->b[d] = wr_dials[d].get(scene);
    a->b[WR_DIAL_SCHEME] = WR_SCHEME_BSPLINE_FIT;
    if (a->b[WR_DIAL_NORMAL] != WR_BUMP_INVARIANT) a->b[WR_DIAL_NORMAL] = WR_BUMP_EXACT;
    a->b[WR_DIAL_AA] = WR_AA_SUPERSAMPLE;
    a->b[WR_DIAL_SAMPLES] = 8;
}

double wr_accuracy_dial(const WrApp *app, int side, int dial)
{
    if (side == 1) give_b(app->accuracy, wr_app_scene(app));
    return side == 1 ? app->accuracy->b[dial] : wr_dials[dial].get(wr_app_scene(app));
}

WrScene *wr_accuracy_scene(const WrApp *app, int side)
{
    WrScene *scene = wr_scene_clone(wr_app_scene(app));
    for (int d = 0; d < WR_DIAL_COUNT; d++) wr_dials[d].set(scene, wr_accuracy_dial(app, side, d));
    scene->tolerance.kind = WR_TOLERANCE_NONE;
    return scene;
}

static void add_dial(WrText *line, int dial, double value)
{
    const WrDial *d = &wr_dials[dial];
    if (line->length == 0) wr_text_add(line, d->command);
    wr_text_addf(line, " %s=", d->name);
    if (d->choices > 0) wr_text_add(line, d->choice((int)value));
    else wr_text_add_number(line, value);
}

/* Set the scene's dials with as few commands as possible. */
static void set_all(WrApp *app, const double value[WR_DIAL_COUNT])
{
    static const char *const verbs[] = { "bump", "material", "dials" };
    wr_app_settle(app);
    wr_app_live_end(app);
    if (wr_app_scene(app)->tolerance.kind != WR_TOLERANCE_NONE &&
        !wr_app_run_line(app, "tolerance off"))
        return;
    for (int v = 0; v < (int)(sizeof verbs / sizeof *verbs); v++) {
        WrText line = { 0 };
        for (int d = 0; d < WR_DIAL_COUNT; d++)
            if (strcmp(wr_dials[d].command, verbs[v]) == 0 &&
                wr_dials[d].get(wr_app_scene(app)) != value[d])
                add_dial(&line, d, value[d]);
        if (line.length > 0) wr_app_run_line(app, wr_text_get(&line));
        wr_text_fini(&line);
    }
}

static void set_b(WrApp *app, const double value[WR_DIAL_COUNT])
{
    WrAccuracy *a = app->accuracy;
    memcpy(a->b, value, sizeof a->b);
    a->b_given = true;
    a->b_serial++;
    wr_app_redraw(app);
}

void wr_accuracy_set_dial(WrApp *app, int side, int dial, double value)
{
    if (side == 1) {
        wr_accuracy_dial(app, side, dial);
        app->accuracy->b[dial] = value;
        app->accuracy->b_serial++;
        return;
    }
    WrText line = { 0 };
    add_dial(&line, dial, value);
    wr_scene_run(app, &line);
}

static void read_all(const WrScene *scene, double value[WR_DIAL_COUNT])
{
    for (int d = 0; d < WR_DIAL_COUNT; d++) value[d] = wr_dials[d].get(scene);
}

void wr_accuracy_take_rung(WrApp *app, int side, int rung)
{
    const WrAccuracy *a = app->accuracy;
    double value[WR_DIAL_COUNT];
    if (!a->plot || rung < 0 || rung >= a->plot->benchmark.count) return;
    WrScene *scene = wr_setting_apply(&a->plot->benchmark.rungs[rung].setting, a->plot->scene);
    read_all(scene, value);
    wr_scene_free(scene);
    if (side == 1) set_b(app, value);
    else set_all(app, value);
}

void wr_accuracy_b_from_a(WrApp *app)
{
    double value[WR_DIAL_COUNT];
    read_all(wr_app_scene(app), value);
    set_b(app, value);
}

void wr_accuracy_swap_ab(WrApp *app)
{
    double a[WR_DIAL_COUNT], b[WR_DIAL_COUNT];
    for (int d = 0; d < WR_DIAL_COUNT; d++) b[d] = wr_accuracy_dial(app, 1, d);
    read_all(wr_app_scene(app), a);
    set_b(app, a);
    set_all(app, b);
}

void wr_accuracy_keep(WrApp *app)
{
    const WrChosen *chosen = &app->accuracy->full_times.chosen;
    if (chosen->any) set_all(app, chosen->dials);
}

void wr_accuracy_dials_text(const WrApp *app, int side, WrText *text)
{
    const WrTolerance *tolerance = &wr_app_scene(app)->tolerance;
    if (side == 0 && tolerance->kind != WR_TOLERANCE_NONE) {
        wr_text_addf(text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
        wr_text_add_number(text, tolerance->value);
        return;
    }
    WrScene *scene = wr_accuracy_scene(app, side);
    wr_text_addf(text, "%s %s", wr_bumps[scene->bump].name, wr_schemes[scene->scheme].name);
    const WrDials *dials = &scene->dials;
    const bool grid = dials->aa == WR_AA_SUPERSAMPLE || dials->aa == WR_AA_ADAPTIVE;
    if (dials->aa != WR_AA_SUPERSAMPLE)
        wr_text_addf(text, " %s", wr_dials[WR_DIAL_AA].choice((int)dials->aa));
    if (grid) wr_text_addf(text, " %d\xc3\x97%d", dials->samples, dials->samples);
    for (int d = WR_DIAL_SAMPLES + 1; d < WR_DIAL_COUNT;
         d++) { /* dials that differ between A and B */
        const WrDial *dial = &wr_dials[d];
        const double value = dial->get(scene);
        if ((dial->matters && !dial->matters(scene)) || value == wr_accuracy_dial(app, 1 - side, d))
            continue;
        wr_text_addf(text, " %s=", dial->name);
        if (dial->choices > 0) wr_text_add(text, dial->choice((int)value));
        else wr_text_add_number(text, value);
    }
    wr_scene_free(scene);
}

/* ---- creation and destruction of the accuracy state ---- */

void wr_accuracy_panel_new(WrApp *app)
{
    WrAccuracy *a = app->accuracy = wr_alloc(1, sizeof *a);
    WrWorkTools tools = { .isa = app->options->isa };
    a->measure_tools = a->look_tools = a->probe_tools = tools;
    /* One thread each, so that strokes and the preview are not slowed down. */
    a->measure = wr_job_new(&wr_work_jobs, 1, app->job_event);
    a->looker = wr_job_new(&wr_work_jobs, 1, app->job_event);
    a->prober = wr_job_new(&wr_work_jobs, 1, app->job_event);
    a->split = 0.5;
    a->plot_hot = -1;
    a->state = 1;
}

static void layer_forget(WrPatchLayer *layer)
{
    if (layer->texture) SDL_DestroyTexture(layer->texture);
    *layer = (WrPatchLayer){ 0 };
}

/* clock of the next necessary update; 0: only after events */
static void accuracy_forget(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    for (int i = 0; i < 2; i++) layer_forget(&a->pair[i]);
    layer_forget(&a->map);
    a->look_of = 0;
}

void wr_accuracy_free(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    if (!a) return;
    wr_job_free(a->measure);
    wr_job_free(a->looker);
    wr_job_free(a->prober);
    wr_work_tools_fini(&a->measure_tools);
    wr_work_tools_fini(&a->look_tools);
    wr_work_tools_fini(&a->probe_tools);
    accuracy_forget(app);
    wr_work_free(a->error);
    wr_work_free(a->plot);
    wr_work_free(a->illusion);
    wr_free(a->plot_base);
    wr_free(a->cases.report);
    wr_field_free(a->field);
    if (a->scene) wr_scene_free(a->scene);
    wr_tables_free(a->tables);
    wr_free(a);
    app->accuracy = NULL;
}

bool wr_accuracy_rests(const WrApp *app)
{
    bool turns = app->settings->turning && app->visible;
    bool held = app->hand->grab != WR_GRAB_NONE && app->hand->grab != WR_GRAB_SPLIT;
    return !turns && !held && !app->live && app->brush->jobs.count == 0 &&
           !wr_session_in_stroke(app->session) && app->layout->patch.w > 0;
}
