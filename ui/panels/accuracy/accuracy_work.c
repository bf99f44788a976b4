#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/panels/accuracy/accuracy_schedule.h"
#include "ui/app/jobs/job.h"
#include "ui/toolkit/words.h"

#include "accuracy/illusion.h"
#include "accuracy/accuracy_benchmark.h"
#include "accuracy/metrics.h"
#include "accuracy/tolerance.h"
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/vec.h"
#include "command/command_table.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "hardcases/hardcases.h"
#include "render/frame/frame.h"
#include "render/reference/reference.h"
#include "scene/dials.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "shade/bump.h"
#include "surface/surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- inspector ---- */

#define SAME_PLACE                                                                                 \
    1e-3 /* of the patch: at a smaller distance the pixel shows the requested position */

/* ---- visibility ---- */

/* Project a point of the object to a pixel of the view; false behind the eye. */
static bool project(const WrWork *work, WrVec3 p, double *x, double *y)
{
    WrPlacement at;
    if (!wr_scene_place(work->scene, work->turn_deg, (double)work->width / work->height, &at, NULL))
        return false;
    const WrVec3 from = v3_sub(wr_object_to_world(&at, p), at.eye);
    const double depth = v3_dot(from, at.forward);
    if (!(depth > 0)) return false;
    const double half = at.orthographic ? at.half_height : at.half_height * depth;
    const double scale = work->height / (2 * half);
    *x = work->width / 2.0 + scale * v3_dot(from, at.right);
    *y = work->height / 2.0 - scale * v3_dot(from, at.up);
    return true;
}

/* Quantities independent of a pixel, at u, v of the patch's first face. */
static void probe_at(const WrScene *scene, const WrField *field, double u, double v, WrProbe *out)
{
    *out = (WrProbe){ .hit = true, .u = u, .v = v };
    WrSurfacePoint *at = &out->at;
    wr_surface_at(&scene->shape, 0, u, v, at);
    wr_scene_slopes(scene, field, at, u, v, &out->f, &out->fu, &out->fv);
    out->d = wr_bump_d(at->n_unit, at->pu, at->pv, out->fu, out->fv);
    out->a = wr_bump_axis(at->pu, at->pv, out->fu, out->fv);
    WrVec3 perturbed[WR_BUMP_COUNT];
    for (int mode = 0; mode < WR_BUMP_COUNT; mode++)
        perturbed[mode] = wr_bump_unit_normal((WrBumpMode)mode, at->n, at->n_unit, at->pu, at->pv,
                                              at->n_u, at->n_v, out->f, out->fu, out->fv);
    out->perturbed = perturbed[scene->bump];
    out->perturbed_exact = perturbed[WR_BUMP_EXACT];
    out->tilt_deg = wr_bump_tilt_deg(at->n_unit, out->perturbed);
    out->dropped_deg = wr_bump_tilt_deg(out->perturbed_exact, perturbed[WR_BUMP_BLINN]);
}

/* Distance between two values of a parameter, the shorter way if it is periodic. */
static double apart(double a, double b)
{
    const double d = fabs(a - b);
    return d < 1 - d ? d : 1 - d;
}

/* Depth of a point of that object before the eye. */
static double depth_of(const WrWork *work, const WrScene *scene, WrVec3 p)
{
    WrPlacement at;
    if (!wr_scene_place(scene, work->turn_deg, (double)work->width / work->height, &at, NULL))
        return INFINITY;
    return v3_dot(v3_sub(wr_object_to_world(&at, p), at.eye), at.forward);
}

/* Probe the nearest object at that pixel; without a hit, the active one, which is not hit either. */
static bool probe_nearest(WrWork *work)
{
    const WrField *const *fields = wr_tables_fields(work->tables);
    double nearest = INFINITY;
    bool good = true;
    work->probe = (WrProbe){ 0 };
    for (int i = 0; good && i < wr_scene_object_count(work->scene); i++) {
        const double aspect = (double)work->width / work->height;
        if (!wr_scene_shows(work->scene, i, aspect)) continue;
        WrScene *part = wr_scene_object_alone(work->scene, i, aspect);
        const WrField *field = fields && fields[i] ? fields[i] : work->field;
        WrProbe seen;
        good = wr_reference_probe(field, part, work->width, work->height, work->turn_deg, work->x,
                                  work->y, &seen, &work->err);
        const double depth = good && seen.hit ? depth_of(work, part, seen.at.p) : INFINITY;
        if (depth < nearest) nearest = depth, work->probe = seen, work->object = i;
        wr_scene_free(part);
    }
    return good;
}

bool wr_accuracy_probe(WrWork *work)
{
    double x = work->x, y = work->y;
    WrProbe seen;
    const WrField *field = wr_tables_at_hand(work->tables, work->scene, work->field);
    work->seen = true;
    work->object = work->scene->chosen;
    if (!work->on_table && wr_scene_object_count(work->scene) > 1) return probe_nearest(work);
    if (!work->on_table)
        return wr_reference_probe(field, work->scene, work->width, work->height, work->turn_deg, x,
                                  y, &work->probe, &work->err);
    probe_at(work->scene, field, x, y, &work->probe);
    work->seen = project(work, work->probe.at.p, &x, &y) && x >= 0 && y >= 0 && x < work->width &&
                 y < work->height &&
                 wr_reference_probe(field, work->scene, work->width, work->height, work->turn_deg,
                                    x, y, &seen, NULL) &&
                 seen.hit && seen.face == 0 && apart(seen.u, work->probe.u) < SAME_PLACE &&
                 apart(seen.v, work->probe.v) < SAME_PLACE;
    if (work->seen) work->probe = seen;
    return true;
}

/* ---- output ---- */

static WrProbeRow one(const char *name, double value, const char *unit, const char *help)
{
    return (WrProbeRow){ name, unit, help, 1, { value } };
}

static WrProbeRow vector(const char *name, WrVec3 v, const char *help)
{
    return (WrProbeRow){ name, "", help, 3, { v.x, v.y, v.z } };
}

int wr_accuracy_probe_rows(const WrProbe *p, bool seen, WrProbeRow rows[WR_PROBE_ROWS])
{
    const WrSurfacePoint *at = &p->at;
    int n = 0;
    rows[n++] = (WrProbeRow){ "u, v", "", "Parameters of the patch", 2, { p->u, p->v } };
    rows[n++] = vector("P", at->p, "The point, object space, scene units");
    rows[n++] = vector("Pu", at->pu, "dP/du");
    rows[n++] = vector("Pv", at->pv, "dP/dv");
    rows[n++] = vector("N", at->n, "Pu x Pv, not unit");
    rows[n++] = one("|N|", at->n_len, "", "Its length");
    rows[n++] = one("F", p->f, "", "Height in scene units: bump height times the table's value");
    rows[n++] = one("Fu", p->fu, "", "dF/du, replication included");
    rows[n++] = one("Fv", p->fv, "", "dF/dv, replication included");
    rows[n++] = vector("D", p->d, "Fu (n x Pv) - Fv (n x Pu), n = N/|N|: the vector added to N");
    rows[n++] = vector("A", p->a, "Fv Pu - Fu Pv: the axis about which the normal is rotated");
    rows[n++] = vector("n'", p->perturbed, "The bumped unit normal, by the scene's formula");
    rows[n++] = one("tilt", p->tilt_deg, "\xc2\xb0", "Angle between N and n'");
    rows[n++] = one("tan", at->n_len > 0 ? v3_len(p->d) / at->n_len : (double)NAN, "",
                    "|D| / |N|, the tangent of the paper's angle");
    rows[n++] =
        one("dropped", p->dropped_deg, "\xc2\xb0",
            "Angle between the paper's n' and the exact one: the effect of the omitted terms in F");
    if (!seen) return n;
    rows[n++] = (WrProbeRow){ "dx, dy/dX",
                              "tx",
                              "The pixel's side to the right in the table, in texels",
                              2,
                              { p->footprint[0], p->footprint[1] } };
    rows[n++] = (WrProbeRow){ "dx, dy/dY",
                              "tx",
                              "The pixel's side down in the table, in texels",
                              2,
                              { p->footprint[2], p->footprint[3] } };
    rows[n++] =
        one("level", p->level, "", "Mip level: log2 of the footprint's longer side in texels");
    rows[n++] = (WrProbeRow){ "samples",
                              "",
                              "Samples along each side of the pixel, as set by the dials",
                              2,
                              { p->samples, p->samples } };
    rows[n++] = (WrProbeRow){
        "RGB", "", "Linear intensity at this point", 3, { p->rgb[0], p->rgb[1], p->rgb[2] }
    };
    return n;
}

char *wr_accuracy_probe_number_text(double value, char text[24])
{
    const double size = fabs(value);
    if (!isfinite(value))
        snprintf(text, 24, "%s", isnan(value) ? "\xe2\x80\x93" : value < 0 ? "-inf" : "inf");
    else if (value == rint(value) && size < 1e5) snprintf(text, 24, "%.0f", value + 0.0);
    else if (size < 5e-4 || size >= 1e5) wr_words_print(text, 24, "%.2e", value);
    else wr_words_print(text, 24, "%.*f", size < 10 ? 4 : size < 1000 ? 2 : 0, value);
    return text;
}

void wr_accuracy_probe_text(const WrProbe *probe, bool seen, WrText *text)
{
    WrProbeRow rows[WR_PROBE_ROWS];
    const int count = wr_accuracy_probe_rows(probe, seen, rows);
    for (int i = 0; i < count; i++) {
        wr_text_addf(text, "%-10s", rows[i].name);
        for (int k = 0; k < rows[i].count; k++) {
            wr_text_add(text, " ");
            wr_text_add_number(text, rows[i].value[k]);
        }
        wr_text_addf(text, "%s%s\n", rows[i].unit[0] ? " " : "", rows[i].unit);
    }
}

/* ---- creation and destruction ---- */

#define REFERENCE_SAMPLES 8  /* along a side, for the error of the static view */
#define BENCHMARK_SAMPLES 16 /* along a side, for the benchmark's reference */
#define BENCHMARK_RUNS 3
#define BENCHMARK_BUDGET 6.0 /* seconds for timed runs */

char *wr_accuracy_base(const WrScene *scene)
{
    WrScene *bare = wr_scene_clone(scene);
    WrScene *plain = wr_scene_new();
    WrText text = { 0 };
    for (int d = 0; d < WR_DIAL_COUNT; d++) wr_dials[d].set(bare, wr_dials[d].get(plain));
    bare->tolerance = plain->tolerance;
    for (const WrCommand *const *row = wr_commands, *c; (c = *row) != NULL; row++)
        if (c->print) c->print(bare, &text);
    wr_scene_free(plain);
    wr_scene_free(bare);
    char *out = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return out;
}

void wr_work_tools_fini(WrWorkTools *tools)
{
    for (int i = 0; i < 2; i++) wr_renderer_free(tools->renderer[i]);
    wr_reference_fini(&tools->kept);
    wr_free(tools->kept_of);
    *tools = (WrWorkTools){ 0 };
}

WrWork *wr_work_new(WrWorkKind kind, WrWorkTools *tools, const WrField *field, const WrScene *scene,
                    double turn_deg, int width, int height)
{
    WrWork *work = wr_alloc(1, sizeof *work);
    work->kind = kind;
    work->tools = tools;
    work->field = field ? wr_field_share(field) : NULL;
    work->scene = scene ? wr_scene_share(scene) : NULL;
    work->turn_deg = turn_deg;
    work->width = width;
    work->height = height;
    return work;
}

void wr_work_free(WrWork *work)
{
    if (!work) return;
    wr_field_free(work->field);
    wr_tables_free(work->tables);
    if (work->scene) wr_scene_free(work->scene);
    if (work->other) wr_scene_free(work->other);
    wr_free(work->values);
    wr_accuracy_benchmark_fini(&work->benchmark);
    wr_free(work->report);
    wr_illusion_fini(&work->illusion);
    for (int i = 0; i < 2; i++) wr_free(work->bgra[i]);
    wr_free(work);
}

/* ---- pictures ---- */

static WrRenderer *renderer(WrWorkTools *tools, int i, WrPool *pool, WrError *err)
{
    if (!tools->renderer[i]) tools->renderer[i] = wr_renderer_new(pool, tools->isa, err);
    return tools->renderer[i];
}

/* Render with the dials, or with those chosen by the tolerance. */
static bool render(WrWork *work, int i, WrPool *pool, const WrFrameRequest *request, WrFrame *frame)
{
    WrRenderer *r = renderer(work->tools, i, pool, &work->err);
    if (!r) return false;
    if (i == 1 || request->normals || request->scene->tolerance.kind == WR_TOLERANCE_NONE)
        return wr_renderer_frame(r, request, frame, &work->err);
    WrChoice choice = { 0 };
    bool good = wr_tolerance_choose(r, request, &choice, frame, &work->err);
    wr_choice_fini(&choice);
    frame->plan = NULL; /* it was borrowed from the choice */
    return good;
}

static WrFrameRequest request_of(const WrWork *work, const WrProgress *progress)
{
    return (WrFrameRequest){ .field = work->field,
                             .fields = wr_tables_fields(work->tables),
                             .scene = work->scene,
                             .width = work->width,
                             .height = work->height,
                             .turn_deg = work->turn_deg,
                             .cancel = progress->cancel };
}

static bool pair(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    for (int i = 0; i < 2; i++) {
        WrFrame frame;
        WrFrameRequest request = request_of(work, progress);
        if (i == 1) request.scene = work->other;
        if (!render(work, i, pool, &request, &frame)) return false;
        work->bgra[i] = wr_try_alloc((size_t)frame.width * (size_t)frame.height, 4,
                                     "the pictures to compare", &work->err);
        if (!work->bgra[i]) return false;
        const WrFrameCodes codes = wr_frame_codes_of(request.scene, false);
        wr_frame_to_srgb8(&frame, &codes, true, work->bgra[i], pool);
    }
    return true;
}

/* ---- measurements ---- */

/* Largest error of R, G and B in each pixel; NAN where both pictures are empty. */
static bool keep_errors(WrWork *work, const float *rgba, const WrReference *reference)
{
    const size_t count = (size_t)reference->width * (size_t)reference->height;
    work->values = wr_try_alloc(count, sizeof *work->values, "the map of errors", &work->err);
    if (!work->values) return false;
    for (size_t i = 0; i < count; i++) {
        const float *a = rgba + 4 * i;
        const double *b = reference->rgba + 4 * i;
        double most = 0;
        for (int c = 0; c < 3; c++) most = fmax(most, fabs((double)a[c] - b[c]));
        work->values[i] = a[3] > 0 || b[3] > 0 ? (float)most : NAN;
    }
    return true;
}

/* Text of all inputs of the reference picture: the scene without dials, except dials that change the model; tables,
   rotation, size. The caller frees it. */
static char *reference_key(const WrWork *work, const WrReferenceRequest *wanted)
{
    WrText text = { 0 };
    char *base = wr_accuracy_base(work->scene);
    const WrField *field = wanted->fields ? wanted->fields[0] : work->field;
    wr_text_addf(&text, "%d %d %d %d %d %llu ", wanted->width, wanted->height, wanted->most,
                 work->scene->bump == WR_BUMP_INVARIANT, (int)work->scene->material.energy,
                 field ? (unsigned long long)wr_field_key(field) : 0ULL);
    wr_text_add_number(&text, wanted->turn_deg);
    wr_text_addf(&text, "\n%s", base);
    wr_free(base);
    return text.data;
}

/* The reference picture: the cached one if its inputs are unchanged, as when dials are varied on a static scene. With
   several objects there is no cache, since its key would be incomplete. */
static bool update_reference(WrWork *work, const WrReferenceRequest *wanted, WrPool *pool)
{
    WrWorkTools *tools = work->tools;
    char *key = wr_scene_object_count(work->scene) == 1 ? reference_key(work, wanted) : NULL;
    if (key && tools->kept_of && strcmp(tools->kept_of, key) == 0) {
        wr_free(key);
        return true;
    }
    wr_free(tools->kept_of);
    tools->kept_of = NULL;
    if (!wr_reference_render(wanted, pool, &tools->kept, &work->err)) {
        wr_free(key);
        return false;
    }
    tools->kept_of = key;
    return true;
}

static bool compare(WrWork *work, WrPool *pool, const WrFrameRequest *request, const float *normals)
{
    WrFrame frame;
    const WrReference *reference = &work->tools->kept;
    WrReferenceRequest wanted = { .field = work->field,
                                  .fields = wr_tables_fields(work->tables),
                                  .scene = work->scene,
                                  .width = request->width,
                                  .height = request->height,
                                  .turn_deg = work->turn_deg,
                                  .first = REFERENCE_SAMPLES / 2,
                                  .most = REFERENCE_SAMPLES,
                                  .cancel = request->cancel };
    bool good = update_reference(work, &wanted, pool) && render(work, 0, pool, request, &frame);
    if (good) {
        wr_errors_measure(frame.rgba, normals, reference, NULL, &work->errors);
        work->samples = reference->samples;
        work->change = reference->last_rms;
        good = keep_errors(work, frame.rgba, reference);
    }
    return good;
}

static bool measure_error(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    WrFrame frame;
    WrFrameRequest request = request_of(work, progress);
    wr_accuracy_picture_size(work->width, work->height, WR_ERROR_SIDE, &request.width,
                             &request.height);
    work->measured_w = request.width;
    work->measured_h = request.height;
    float *normals = wr_alloc((size_t)request.width * (size_t)request.height, 3 * sizeof *normals);
    const bool chosen = work->scene->tolerance.kind != WR_TOLERANCE_NONE;
    WrFrameRequest shown = request;
    shown.normals = normals;
    bool good = (chosen || render(work, 0, pool, &shown, &frame)) &&
                compare(work, pool, &request, chosen ? NULL : normals);
    wr_free(normals);
    return good;
}

static bool climb(WrWork *work, const WrProgress *progress)
{
    WrAccuracyBenchmarkRequest request = { .field = work->field,
                                           .fields = wr_tables_fields(work->tables),
                                           .scene = work->scene,
                                           .turn_deg = work->turn_deg,
                                           .threads = 1,
                                           .runs = BENCHMARK_RUNS,
                                           .most = BENCHMARK_SAMPLES,
                                           .budget = BENCHMARK_BUDGET,
                                           .axis = WR_AXIS_COUNT,
                                           .progress = (WrProgress *)progress };
    wr_accuracy_picture_size(work->width, work->height, WR_ACCURACY_BENCHMARK_SIDE, &request.width,
                             &request.height);
    return wr_accuracy_benchmark_measure(&request, &work->benchmark, &work->err);
}

static bool beside(WrWork *work, const WrProgress *progress)
{
    WrIllusionRequest request = { .field = work->field,
                                  .fields = wr_tables_fields(work->tables),
                                  .scene = work->scene,
                                  .turn_deg = work->turn_deg,
                                  .threads = 1,
                                  .isa = work->tools->isa,
                                  .progress = progress };
    wr_accuracy_picture_size(work->width, work->height, WR_ERROR_SIDE, &request.width,
                             &request.height);
    return wr_illusion_measure(&request, &work->illusion, &work->err);
}

static bool draw_map(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    wr_accuracy_picture_size(work->width, work->height, WR_MAP_SIDE, &work->measured_w,
                             &work->measured_h);
    work->values = wr_alloc((size_t)work->measured_w * (size_t)work->measured_h, sizeof(float));
    return wr_reference_map(wr_tables_at_hand(work->tables, work->scene, work->field), work->scene,
                            work->measured_w, work->measured_h, work->turn_deg, work->map, pool,
                            progress->cancel, work->values, &work->err);
}

static bool try_cases(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    WrHardRequest request = { .isa = work->tools->isa, .pool = pool, .progress = progress };
    work->report = wr_alloc(1, sizeof *work->report);
    return wr_hardcases_run(&request, work->report, &work->err);
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Percentiles limit the scale, so that silhouettes and poles do not darken the rest of a map. */
static void find_ends(WrWork *work)
{
    const size_t count = work->values ? (size_t)work->measured_w * (size_t)work->measured_h : 0;
    float *sorted = wr_alloc(count + 1, sizeof *sorted);
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(work->values[i])) sorted[n++] = work->values[i];
    qsort(sorted, n, sizeof *sorted, ascending);
    if (n > 0) work->low = (double)sorted[(size_t)(0.005 * (double)(n - 1))];
    if (n > 0) work->high = (double)sorted[(size_t)(0.995 * (double)(n - 1))];
    wr_free(sorted);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    WrWork *work = arg;
    switch (work->kind) {
    case WR_WORK_ERROR: work->done = measure_error(work, pool, progress); break;
    case WR_WORK_BENCHMARK: work->done = climb(work, progress); break;
    case WR_WORK_CASES: work->done = try_cases(work, pool, progress); break;
    case WR_WORK_ILLUSION: work->done = beside(work, progress); break;
    case WR_WORK_PAIR: work->done = pair(work, pool, progress); break;
    case WR_WORK_MAP: work->done = draw_map(work, pool, progress); break;
    case WR_WORK_PROBE: work->done = wr_accuracy_probe(work); break;
    }
    if (work->done) find_ends(work);
}

static void drop(void *arg)
{
    wr_work_free(arg);
}

const WrJobKind wr_work_jobs = { run, drop };
