/* Scheduling of measurements, and their results. */
#include "ui/accuracy/accuracy.h"
#include "ui/accuracy/accuracy_plan.h"
#include "ui/accuracy/accuracy_work.h"
#include "ui/state/app_state.h"
#include "ui/state/layout.h"
#include "ui/state/messages.h"
#include "ui/state/roster.h"
#include "ui/state/session_view.h"
#include "ui/patch/patch.h"
#include "ui/preview/preview.h"
#include "ui/jobs/job.h"

#include "accuracy/ladder.h"
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_table.h"
#include "document/object_tables.h"
#include "field/field.h"
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
    for (int i = 0; a->plot && found < 0 && i < a->plot->ladder.count; i++) {
        WrScene *with = wr_setting_apply(&a->plot->ladder.rungs[i].setting, a->plot->scene);
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

static void take_ladder(WrAccuracy *a, WrWork *work)
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
    } else if (work->kind == WR_WORK_LADDER) {
        a->plot_failed = work->of; /* once is enough; a new state is tried again */
        if (work->done) {
            take_ladder(a, work);
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

static WrAccuracyMoment moment(const WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    WrAccuracyMoment m = { .now = wr_clock_seconds(),
                           .changed_at = a->changed_at,
                           .rests = wr_accuracy_rests(app),
                           .open = a->error_open || a->look == WR_PATCH_ERROR,
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
    if (a->illusion_wanted && !a->measuring && wr_accuracy_rests(app)) {
        a->illusion_wanted = false;
        measure(app, WR_WORK_ILLUSION);
        return;
    }
    WrAccuracyMoment m = moment(app);
    switch (wr_accuracy_next(&m, &due)) {
    case WR_ACCURACY_NOTHING: break;
    case WR_ACCURACY_ERROR: measure(app, WR_WORK_ERROR); return;
    case WR_ACCURACY_LADDER:
        a->plot_asked = false;
        measure(app, WR_WORK_LADDER);
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
    if (!in->shown || !in->have || app->layout->patch.w <= 0) return;
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

void wr_accuracy_update(WrApp *app)
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

double wr_accuracy_next_time(const WrApp *app)
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

bool wr_accuracy_works(WrApp *app)
{
    return wr_accuracy_busy(app, WR_WORK_LADDER, NULL) ||
           wr_accuracy_busy(app, WR_WORK_ILLUSION, NULL) ||
           wr_accuracy_busy(app, WR_WORK_CASES, NULL);
}

const WrPart wr_part_accuracy = { .update = wr_accuracy_update,
                                  .next_time = wr_accuracy_next_time,
                                  .works = wr_accuracy_works,
                                  .draw = wr_accuracy_draw,
                                  .forget = wr_accuracy_forget };
