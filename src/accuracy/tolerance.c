/* Choice under a tolerance: a table of settings, a picture, a check and at most one correction. */
#include "accuracy/tolerance.h"

#include "accuracy/tolerance_internal.h"
#include "base/error.h"
#include "base/text.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

/* ---- settings ---- */

#define CONTRAST 0.25 /* of adaptive samples: part of the tolerance */
#define CONTRAST_MAX 0.01

WrScene *wr_dial_set_apply(const WrDialSet *set, const WrScene *from, bool fine)
{
    const WrTolerance *tolerance = &from->tolerance;
    WrScene *scene = wr_scene_clone(from);
    WrDials *dials = &scene->dials;
    const bool every = fine || tolerance->kind == WR_TOLERANCE_TIME;
    scene->scheme = set->scheme;
    scene->bump = set->mode;
    wr_scene_set_all_slopes(scene, true, true);
    dials->aa = set->samples == 1 ? WR_AA_POINT : every ? WR_AA_SUPERSAMPLE : WR_AA_ADAPTIVE;
    dials->samples = set->samples;
    dials->spread = fine ? WR_SPREAD_JITTERED : WR_SPREAD_REGULAR;
    dials->refine = WR_REFINE_CONTRAST;
    if (dials->aa == WR_AA_ADAPTIVE)
        dials->contrast = fmin(CONTRAST_MAX, CONTRAST * tolerance->value);
    dials->mesh = set->mesh;
    scene->tolerance = (WrTolerance){ WR_TOLERANCE_NONE, 0 };
    return scene;
}

/* ---- table of prices and errors ---- */

static const int samples_tried[] = { 1, 2, 3, 4, 6, 8, 12, WR_SAMPLES_MAX };
#define TRIED ((int)(sizeof samples_tried / sizeof *samples_tried))

typedef struct Row {
    WrDialSet set;
    bool best; /* the best slopes and normal, and the finer mesh; else those of the scene */
    double price;
} Row;

/* Price and expected error of each setting; the last row is the finest. */
typedef struct Table {
    Row rows[2 * TRIED];
    int count;
    double own_error; /* of the scene's own slopes, normal and mesh */
    double one;       /* of one sample a pixel; k x k have one / k^order */
    double order;
    bool max; /* these are largest errors, else root mean squares */
} Table;

/* Expected errors of pictures with little detail: rms, and the largest. Outlines have the order 3/2. */
#define EVEN_RMS 0.002
#define EVEN_MAX 0.02
#define OWN_PART                                                                                   \
    0.5 /* error of the scene's own slopes and normal, relative to that of one sample */
#define ORDER 1.5

#define FINER_MESH 1.05 /* factor of the price */

static int finer_mesh(const WrScene *scene, int mesh)
{
    const WrDial *dial = &wr_dials[WR_DIAL_MESH];
    return (!dial->matters || dial->matters(scene)) && mesh < (int)dial->high ? mesh + 1 : mesh;
}

/* The best slopes and normal of all objects, and a finer mesh. */
static WrDialSet best_set(const WrScene *scene)
{
    WrDialSet best = { scene->scheme, WR_BUMP_BLINN, finer_mesh(scene, scene->dials.mesh), 1 };
    if (scene->analytic.kind == WR_ANALYTIC_OFF) best.scheme = WR_SCHEME_BSPLINE_FIT;
    for (int i = 0; i < wr_scene_object_count(scene); i++)
        if (!wr_surfaces[wr_scene_object(scene, i)->shape.kind]->flat) best.mode = WR_BUMP_EXACT;
    if (scene->bump == WR_BUMP_INVARIANT) best.mode = WR_BUMP_INVARIANT;
    return best;
}

static void add_rows(Table *table, WrDialSet set, bool best, double price)
{
    for (int i = 0; i < TRIED; i++) {
        set.samples = samples_tried[i];
        table->rows[table->count++] = (Row){ set, best, price * set.samples * set.samples };
    }
}

static Table table_of_scene(const WrScene *scene)
{
    const bool max = scene->tolerance.kind == WR_TOLERANCE_MAX;
    const WrDialSet best = best_set(scene);
    WrDialSet own = { scene->scheme, scene->bump, scene->dials.mesh, 1 };
    if (own.mode == WR_BUMP_NONE) own.mode = WR_BUMP_BLINN;
    const double price = wr_price_sample(scene, best.scheme, best.mode);
    double own_price = wr_price_sample(scene, own.scheme, own.mode);
    if (own_price >= price) own = best, own.mesh = scene->dials.mesh, own_price = price;
    const bool finer = own.mesh != best.mesh;
    Table table = { .one = max ? EVEN_MAX : EVEN_RMS, .order = ORDER, .max = max };
    table.own_error = OWN_PART * table.one;
    if (finer || own.scheme != best.scheme || own.mode != best.mode)
        add_rows(&table, own, false, own_price);
    add_rows(&table, best, true, price * (finer ? FINER_MESH : 1));
    return table;
}

static double expected_error(const Table *table, const Row *row)
{
    const double own = row->best ? 0 : table->own_error;
    const double sampling = table->one * pow(row->set.samples, -table->order);
    return table->max ? own + sampling : hypot(own, sampling);
}

/* The cheapest setting above a price whose expected error is at most `error`; if there is none, the finest. */
static const Row *find_cheapest(const Table *table, double error, double above)
{
    const Row *best = &table->rows[table->count - 1];
    for (const Row *row = table->rows; row < table->rows + table->count; row++)
        if (row->price > above && row->price < best->price && expected_error(table, row) <= error)
            best = row;
    return best;
}

/* The setting with the highest price within a limit; if there is none, the cheapest. */
static const Row *find_within(const Table *table, double price)
{
    const Row *best = table->rows;
    for (const Row *row = table->rows; row < table->rows + table->count; row++)
        if (row->price <= price && row->price > best->price) best = row;
    return best;
}

/* ---- picture, check and correction ---- */

#define AIM 0.8 /* part of the tolerance that a correction aims at */
/* Range of the measured order of the error in the samples a side, */
#define ORDER_MIN 0.8
#define ORDER_MAX 1.7
#define ORDER_HIDDEN                                                                               \
    0.1 /* and its correction: the finer blocks have an error of their own, which lowers it */

typedef struct Run {
    WrStudy study;
    WrCheck check;
    Table table;
    const Row *first, *last; /* settings of the first picture, and of the result */
    WrCheckError first_error, error;
} Run;

static double error_of_kind(const Run *run, WrCheckError error)
{
    return run->table.max ? error.max : error.rms;
}

static bool render_picture(Run *run, const Row *row, WrError *err)
{
    run->last = row;
    return wr_study_render(&run->study, &row->set, NULL, false, err);
}

/* Measures the last picture. The finer blocks of an earlier check are used again if they are fine enough. */
static bool check_picture(Run *run, int samples, WrError *err)
{
    WrCheck *check = &run->check;
    const WrDialSet *set = &run->last->set;
    WrDialSet fine = best_set(run->study.request->scene);
    fine.mesh = finer_mesh(run->study.request->scene, set->mesh);
    fine.samples = samples;
    wr_check_copy(check, check->picture, false);
    if (check->fine_samples < 2 * set->samples || check->fine_mesh < fine.mesh) {
        if (!wr_check_render(check, &fine, check->fine, err)) return false;
        check->fine_samples = fine.samples;
        check->fine_mesh = fine.mesh;
    }
    run->error = wr_check_error(check, check->picture, check->fine, true);
    return true;
}

static double difference(const Run *run, const float *a, const float *b)
{
    return error_of_kind(run, wr_check_error(&run->check, a, b, false));
}

/* Replaces the table's expected errors by the measured ones: of the slopes and normal, and of the samples, whose order
   follows from twice as many. */
static bool update_table(Run *run, WrError *err)
{
    WrCheck *check = &run->check;
    Table *table = &run->table;
    WrDialSet set = table->rows[table->count - 1].set;
    const double total = difference(run, check->picture, check->fine);
    double sampling = total;
    set.samples = run->first->set.samples;
    if (!run->first->best) {
        if (!wr_check_render(check, &set, check->other, err)) return false;
        table->own_error = difference(run, check->picture, check->other);
        sampling = difference(run, check->other, check->fine);
    }
    if (2 * set.samples < check->fine_samples) {
        set.samples *= 2;
        if (!wr_check_render(check, &set, check->other, err)) return false;
        const double twice = difference(run, check->other, check->fine);
        table->order = twice > 0 ? log2(sampling / twice) + ORDER_HIDDEN : ORDER_MAX;
        table->order = fmax(ORDER_MIN, fmin(ORDER_MAX, table->order));
    }
    table->one = error_of_kind(run, run->error) / fmax(total, 1e-12) * sampling *
                 pow(run->first->set.samples, table->order);
    return true;
}

/* value: the error, or for a time the price of the whole picture. */
static bool choose(Run *run, double value, bool timed, WrError *err)
{
    const Table *table = &run->table;
    run->first = timed ? table->rows : find_cheapest(table, value, 0);
    if (!render_picture(run, run->first, err)) return false;
    if (run->study.covered < 1) return true;
    if (!wr_check_begin(&run->check, &run->study, err)) return false;
    const Row *within = timed ? find_within(table, value / run->study.covered) : run->first;
    if (within != run->first && !render_picture(run, run->first = within, err)) return false;
    const int samples = run->first->set.samples;
    if (!check_picture(run, (samples > 2 ? 2 : 4) * samples, err)) return false;
    run->first_error = run->error;
    if (!timed && error_of_kind(run, run->error) > value &&
        run->first != table->rows + table->count - 1) {
        if (!update_table(run, err)) return false;
        const Row *next = find_cheapest(table, AIM * value, run->first->price);
        if (!render_picture(run, next, err) || !check_picture(run, 2 * next->set.samples, err))
            return false;
    }
    wr_check_copy(&run->check, run->check.picture, true);
    return true;
}

/* ---- result ---- */

void wr_choice_fini(WrChoice *choice)
{
    wr_scene_free(choice->dials);
    wr_scene_free((WrScene *)choice->scene);
    *choice = (WrChoice){ 0 };
}

static bool holds(const WrTolerance *tolerance, const WrChoice *choice)
{
    switch (tolerance->kind) {
    case WR_TOLERANCE_RMS: return choice->rms <= tolerance->value;
    case WR_TOLERANCE_MAX: return choice->max <= tolerance->value;
    case WR_TOLERANCE_TIME: return choice->seconds <= tolerance->value;
    case WR_TOLERANCE_NONE:
    case WR_TOLERANCE_COUNT: break;
    }
    return true;
}

static void add_tolerance(const WrTolerance *tolerance, WrText *text)
{
    wr_text_addf(text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
    wr_text_add_number(text, tolerance->value);
    if (tolerance->kind == WR_TOLERANCE_TIME) wr_text_add(text, " s");
}

void wr_choice_report(WrChoice *choice, const WrTolerance *tolerance, const char *more)
{
    WrText text = { 0 };
    add_tolerance(tolerance, &text);
    wr_text_addf(&text, ": %s; measured rms %.2g, max %.2g; %s", choice->met ? "met" : "MISSED",
                 choice->rms, choice->max, more);
    snprintf(choice->reason, sizeof choice->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

static void report(const Run *run, WrChoice *out)
{
    WrText more = { 0 };
    wr_text_addf(&more, "checked on %d blocks of %d x %d pixels%s; ", run->check.count,
                 WR_FRAME_BLOCK, WR_FRAME_BLOCK, run->check.all ? ", all" : "");
    if (run->last != run->first)
        wr_text_addf(&more, "the first setting had %.2g and was corrected once; ",
                     error_of_kind(run, run->first_error));
    if (!out->met && run->last == run->table.rows + run->table.count - 1)
        wr_text_add(&more, "no setting is finer; ");
    wr_text_addf(&more, "choosing and the picture took %.1f ms; one more such frame costs %.1f",
                 1e3 * out->spent, 1e3 * out->seconds);
    wr_choice_report(out, &out->scene->tolerance, wr_text_get(&more));
    wr_text_fini(&more);
}

static WrChoice result_of(const Run *run, double start, double price)
{
    const WrFrameRequest *request = run->study.request;
    const WrTolerance *tolerance = &request->scene->tolerance;
    WrChoice out = { .dials = wr_dial_set_apply(&run->last->set, request->scene, false),
                     .width = request->width,
                     .height = request->height,
                     .rms = run->error.rms,
                     .max = run->error.max,
                     .seconds = run->study.seconds,
                     .spent = wr_clock_seconds() - start,
                     .frames = run->study.frames,
                     .studies = 1,
                     .scene = wr_scene_share(request->scene),
                     .tables_key = wr_choice_tables_key(request),
                     .turn_deg = request->turn_deg };
    if (tolerance->kind == WR_TOLERANCE_TIME)
        out.seconds = price * run->study.covered * run->last->price;
    out.met = holds(tolerance, &out);
    report(run, &out);
    return out;
}

bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrFrame *frame, WrError *err)
{
    const WrTolerance *tolerance = &request->scene->tolerance;
    const double start = wr_clock_seconds();
    double price = 1;
    const bool timed = tolerance->kind == WR_TOLERANCE_TIME;
    if (tolerance->kind == WR_TOLERANCE_NONE)
        return wr_fail(err, "the scene has no tolerance: set one with `tolerance rms=0.004`");
    if (timed && !wr_price_seconds(renderer, &price, err)) return false;
    Run run = { .study = { .renderer = renderer, .request = request, .frame = frame },
                .table = table_of_scene(request->scene) };
    const bool good = choose(&run, tolerance->value / price, timed, err);
    if (good) {
        const WrChoice choice = result_of(&run, start, price);
        wr_choice_fini(out);
        *out = choice;
        out->plan = run.study.plan;
        out->plan.cost[WR_COST_CHOOSE] = fmax(0, out->spent - run.study.times.total);
        out->plan.work += out->plan.cost[WR_COST_CHOOSE];
        frame->plan = &out->plan;
        frame->covered = (int64_t)run.study.covered;
        frame->shaded = run.study.shaded;
        frame->times = run.study.times;
        frame->times.total = out->spent;
    }
    wr_check_fini(&run.check);
    return good;
}

/* ---- turn ---- */

#define STUDIED_MAX 8   /* frames for which dials are chosen ... */
#define STUDIED_SHARE 4 /* ... and at most one of this many */

static double price_of(const WrScene *dials)
{
    const double samples = dials->dials.aa == WR_AA_POINT ? 1 : dials->dials.samples;
    return wr_price_sample(dials, dials->scheme, dials->bump) * samples * samples;
}

/* The choice gets the dearer setting of both. */
static void merge(WrChoice *sum, WrChoice *more)
{
    if (price_of(more->dials) > price_of(sum->dials)) {
        WrScene *dials = sum->dials;
        sum->dials = more->dials;
        more->dials = dials;
        sum->seconds = more->seconds;
    }
    sum->met = sum->met && more->met;
    sum->rms = fmax(sum->rms, more->rms);
    sum->max = fmax(sum->max, more->max);
}

static void report_turn(WrChoice *choice, int count)
{
    WrText text = { 0 };
    add_tolerance(&choice->scene->tolerance, &text);
    wr_text_addf(&text,
                 ", %d frames: %s; dials chosen on %d of them for all; measured rms at most %.2g, "
                 "max %.2g; choosing took %.1f ms, each frame %.1f",
                 count, choice->met ? "met" : "MISSED", choice->studies, choice->rms, choice->max,
                 1e3 * choice->spent, 1e3 * choice->seconds);
    snprintf(choice->reason, sizeof choice->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

bool wr_tolerance_turn(WrRenderer *renderer, const WrFrameRequest *request, const double *turn_deg,
                       int count, WrChoice *out, WrError *err)
{
    const double start = wr_clock_seconds();
    const int share = count / STUDIED_SHARE;
    const int studied = share < 1 ? 1 : share < STUDIED_MAX ? share : STUDIED_MAX;
    WrChoice all = { 0 };
    for (int i = 0; i < studied; i++) {
        WrFrame frame;
        WrChoice one = { 0 };
        WrFrameRequest turned = *request;
        turned.turn_deg = turn_deg[(int64_t)i * count / studied];
        if (!wr_tolerance_choose(renderer, &turned, &one, &frame, err)) {
            wr_choice_fini(&all);
            return false;
        }
        if (all.dials) merge(&all, &one);
        else all = one;
        if (i > 0) wr_choice_fini(&one);
    }
    all.turning = true;
    all.studies = studied;
    all.spent = wr_clock_seconds() - start;
    report_turn(&all, count);
    wr_choice_fini(out);
    *out = all;
    return true;
}

/* ---- use ---- */

bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err)
{
    WrFrameRequest chosen = *request;
    chosen.scene = choice->dials;
    chosen.dials = NULL;
    chosen.keep = false;
    chosen.hold = true; /* the next picture's choice needs the table's copies */
    return wr_renderer_frame(renderer, &chosen, frame, err);
}

bool wr_tolerance_frame(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *choice,
                        WrFrame *frame, WrError *err)
{
    if (!wr_choice_fits(choice, request))
        return wr_tolerance_choose(renderer, request, choice, frame, err);
    if (!wr_choice_frame(renderer, request, choice, frame, err)) return false;
    /* it was read from text: the time is unknown */
    if (choice->studies == 0) choice->seconds = frame->times.total;
    return true;
}

void wr_choice_print(const WrChoice *choice, WrText *text)
{
    WrText bump = { 0 }, dials = { 0 };
    wr_dials_print(choice->dials, "bump", true, &bump);
    wr_dials_print(choice->dials, "dials", false, &dials);
    wr_text_addf(text, "whole picture: %s %s\n", wr_text_get(&bump), wr_text_get(&dials));
    wr_text_fini(&bump);
    wr_text_fini(&dials);
}

/* ---- identity ---- */

/* Of the tables of all visible objects; of the composite alone, if all use it. */
static WrHash identity(const WrFrameRequest *request, WrHash (*of)(const WrField *field))
{
    WrHash all = { 0, 0 };
    bool common = true;
    const int count = request->fields ? wr_scene_object_count(request->scene) : 0;
    for (int i = 0; i < count; i++) {
        const WrField *field = request->fields[i] ? request->fields[i] : request->field;
        const bool hidden = wr_scene_object(request->scene, i)->hidden;
        const WrHash own = hidden ? (WrHash){ 0, 0 } : of(field);
        common = common && !request->fields[i];
        all = wr_hash_bytes(&own, sizeof own, all);
    }
    return common ? of(request->field) : all;
}

static WrHash key_of(const WrField *field)
{
    return (WrHash){ wr_field_key(field), 0 };
}

uint64_t wr_choice_tables_key(const WrFrameRequest *request)
{
    return identity(request, key_of).low;
}

WrHash wr_choice_tables_hash(const WrFrameRequest *request)
{
    return identity(request, wr_field_hash);
}

bool wr_choice_fits(const WrChoice *choice, const WrFrameRequest *request)
{
    return choice->dials && choice->scene == request->scene &&
           choice->tables_key == wr_choice_tables_key(request) &&
           (choice->turning || choice->turn_deg == request->turn_deg) &&
           choice->width == request->width && choice->height == request->height;
}
