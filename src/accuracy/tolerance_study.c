/* A sample of a picture's blocks at every rung. */
#include "accuracy/tolerance_inner.h"

#include "base/clock.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Of the blocks: 8 x 8 samples on the larger sample cost about as much as 16 x 16 on the smaller. */
#define SHARE_SMALL 0.026
#define SHARE_LARGE 0.05
#define SPARE 0.45 /* 8 x 8 is a reference where it is off by less than so much of the tolerance */

#define MOMENTS_FROM 0.008 /* RMS: their model of the slopes is seldom nearer */

/* Ways that are not measured lie between two that are. */
enum { POINT, MOMENTS, TWO, THREE, FOUR, FIVE, SIX, EIGHT, TEN, TWELVE, SIXTEEN };
const Way wr_study_ways[WR_STUDY_WAYS] = {
    [POINT] = { WR_AA_POINT, 1, 0, 0 },
    [MOMENTS] = { WR_AA_MOMENTS, 1, 0, 0 },
    [TWO] = { WR_AA_SUPERSAMPLE, 2, 0, 0 },
    [THREE] = { WR_AA_SUPERSAMPLE, 3, 0, 0 },
    [FOUR] = { WR_AA_SUPERSAMPLE, 4, 0, 0 },
    [FIVE] = { WR_AA_SUPERSAMPLE, 5, FOUR, EIGHT },
    [SIX] = { WR_AA_SUPERSAMPLE, 6, FOUR, EIGHT },
    [EIGHT] = { WR_AA_SUPERSAMPLE, 8, 0, 0 },
    [TEN] = { WR_AA_SUPERSAMPLE, 10, EIGHT, SIXTEEN },
    [TWELVE] = { WR_AA_SUPERSAMPLE, 12, EIGHT, SIXTEEN },
    [SIXTEEN] = { WR_AA_SUPERSAMPLE, 16, 0, 0 },
};

/* ---- frames ---- */

/* *work: processor seconds, but for what the setting needed to be made first; may be NULL. */
static bool render(Study *study, const WrScene *scene, const unsigned char *only, WrFrame *frame,
                   double *work, WrError *err)
{
    WrFrameRequest request = *study->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = only;
    request.keep = false;
    request.normals = NULL;
    const double start = wr_clock_seconds(), worked = wr_clock_process_seconds();
    if (!wr_renderer_frame(study->renderer, &request, frame, err)) return false;
    const double wall = wr_clock_seconds() - start, spent = wr_clock_process_seconds() - worked;
    const double made = frame->times.prepare < wall ? frame->times.prepare : wall;
    study->wall += wall;
    study->work += spent;
    if (work) *work = wall > 0 ? spent * (wall - made) / wall : 0;
    return true;
}

WrScene *wr_study_scene(const Study *study, Place place)
{
    WrScene *scene = wr_scene_clone(study->request->scene);
    const Way *way = &wr_study_ways[place.way];
    scene->scheme = study->schemes[place.scheme];
    scene->bump = study->modes[place.mode];
    scene->dials.aa = way->aa;
    scene->dials.samples = way->samples;
    scene->dials.spread = WR_SPREAD_REGULAR;
    scene->dials.footprint = WR_FOOTPRINT_ANISOTROPIC;
    scene->dials.moments = WR_MOMENTS_LEAN;
    scene->tolerance = (WrTolerance){ WR_TOLERANCE_NONE, 0 };
    return scene;
}

static void mask_sample(Study *study)
{
    for (int64_t b = 0; b < study->block_count; b++) study->mask[b] = study->block[b].sampled;
}

/* ---- the rungs ---- */

static void list_rungs(Study *study)
{
    const WrScene *scene = study->request->scene;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    /* On a curved surface finding (u,v) takes so long that cheaper slopes are not worth their tables. */
    if (table && wr_surfaces[scene->shape.kind]->flat) {
        study->schemes[study->scheme_count++] = WR_SCHEME_CENTRAL;
        study->schemes[study->scheme_count++] = WR_SCHEME_BSPLINE_FIT;
    } else {
        study->schemes[study->scheme_count++] = table ? WR_SCHEME_BSPLINE_FIT : scene->scheme;
    }
    if (scene->bump == WR_BUMP_INVARIANT) {
        study->modes[study->mode_count++] = WR_BUMP_INVARIANT;
    } else {
        study->modes[study->mode_count++] = WR_BUMP_NONE;
        study->modes[study->mode_count++] = WR_BUMP_BLINN;
        if (!wr_surfaces[scene->shape.kind]->flat)
            study->modes[study->mode_count++] = WR_BUMP_EXACT;
    }
}

static Place best_with(const Study *study, int way)
{
    return (Place){ study->scheme_count - 1, study->mode_count - 1, way };
}

/* One setting on the whole sample, into *out. seconds: of it, processor time. */
static bool try_place(Study *study, Place place, float *out, double *seconds, WrError *err)
{
    WrFrame frame;
    WrScene *scene = wr_study_scene(study, place);
    mask_sample(study);
    const bool good = render(study, scene, study->mask, &frame, seconds, err);
    if (good) wr_study_gather(study, &frame, out);
    wr_scene_free(scene);
    return good;
}

/* Of the whole picture. */
static double rms_of(const Study *study, const Effect *effect)
{
    double sum = 0;
    for (int k = 1; k < WR_CHOICE_KINDS; k++) sum += effect->squares[k];
    return sqrt(sum / (3 * fmax(study->pixels, 1)));
}

/* One rung of an axis against the best, on 2 x 2 samples: they show what differs. */
static bool study_rung(Study *study, Place place, const float *best, Effect *effect, WrError *err)
{
    if (!try_place(study, place, study->other, &effect->seconds[0], err)) return false;
    wr_study_compare(study, best, study->other, effect->squares, effect->most);
    return effect->tried = true;
}

/* Without bump the renderer drops the tables that all other settings need, and making them again takes longer
   than the measurement. So the error is first seen on a relief of almost no height, which keeps them. */
static bool study_none(Study *study, const float *best, double fine, WrError *err)
{
    WrFrame frame;
    Effect *none = &study->of_mode[0];
    WrScene *scene = wr_study_scene(study, best_with(study, TWO));
    scene->height *= 1e-9;
    mask_sample(study);
    const bool good = render(study, scene, study->mask, &frame, NULL, err);
    wr_scene_free(scene);
    if (!good) return false;
    wr_study_gather(study, &frame, study->other);
    wr_study_compare(study, best, study->other, none->squares, none->most);
    if (rms_of(study, none) > fine) return true; /* untried: nobody will want it */
    return study_rung(study, (Place){ study->scheme_count - 1, 0, TWO }, best, none, err);
}

/* Slopes and normals against the best of their axis. */
static bool study_formulas(Study *study, double fine, WrError *err)
{
    const Place top = best_with(study, TWO);
    double seconds;
    float *best = wr_alloc(wr_study_floats(study), sizeof *best);
    bool good = try_place(study, top, best, &seconds, err);
    study->of_scheme[top.scheme] = (Effect){ .tried = true, .seconds = { seconds } };
    study->of_mode[top.mode] = (Effect){ .tried = true, .seconds = { seconds } };
    for (int i = 1; good && i < top.mode; i++)
        good = study_rung(study, (Place){ top.scheme, i, TWO }, best, &study->of_mode[i], err);
    if (good && top.mode > 0) good = study_none(study, best, fine, err);
    for (int i = 0; good && i < top.scheme; i++)
        good = study_rung(study, (Place){ i, top.mode, TWO }, best, &study->of_scheme[i], err);
    wr_free(best);
    return good;
}

/* One way on the sample. A sample takes as long everywhere, so its time by kind follows from the pixels. */
static bool run_way(Study *study, int way, float *out, WrError *err)
{
    WrFrame frame;
    Effect *effect = &study->of_way[way];
    WrScene *scene = wr_study_scene(study, best_with(study, way));
    double work = 0;
    *effect = (Effect){ 0 };
    mask_sample(study);
    const bool good = render(study, scene, study->mask, &frame, &work, err);
    wr_scene_free(scene);
    if (!good) return false;
    const double grid = wr_study_ways[way].samples;
    const double each = frame.shaded > 0 ? work * grid * grid / (double)frame.shaded : 0;
    for (int64_t b = 0; b < study->block_count; b++)
        effect->seconds[study->block[b].kind] += each * study->block[b].covered;
    wr_study_gather(study, &frame, out);
    return effect->tried = true;
}

/* The reference's own error from the last doubling, by the usual order 3/2 at edges:
   e(2k) = d(k, 2k) / (2^(3/2) - 1). Not where outlines run along the rows: there both may be off alike. */
static void judge_top(Study *study, const Effect *half)
{
    Effect *top = &study->of_way[study->top];
    const double share = 1 / (sqrt(8.0) - 1);
    double aligned[WR_CHOICE_KINDS];
    wr_study_aligned(study, study->best, wr_study_ways[study->top].samples, aligned);
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        top->squares[k] = fmax(share * share * half->squares[k], aligned[k]);
        top->most[k] = share * half->most[k];
    }
}

static bool compare_way(Study *study, int way, WrError *err)
{
    Effect *effect = &study->of_way[way];
    if (!run_way(study, way, study->other, err)) return false;
    wr_study_compare(study, study->best, study->other, effect->squares, effect->most);
    return true;
}

/* 8 x 8 samples are there already, on this very sample. */
static void recompare_middle(Study *study)
{
    Effect *effect = &study->of_way[EIGHT];
    wr_study_compare(study, study->best, study->middle, effect->squares, effect->most);
}

/* Between two numbers of samples errors fall as a power of them. */
static double between(double a, double b, double part)
{
    return a > 0 && b > 0 ? pow(a, 1 - part) * pow(b, part) : (1 - part) * a + part * b;
}

static void interpolate(Study *study, int way)
{
    const Way *at = &wr_study_ways[way];
    const Effect *low = &study->of_way[at->low], *high = &study->of_way[at->high];
    Effect *effect = &study->of_way[way];
    const double from = wr_study_ways[at->low].samples, to = wr_study_ways[at->high].samples;
    const double part = log(at->samples / from) / log(to / from);
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        effect->squares[k] = between(low->squares[k], high->squares[k], part);
        effect->most[k] = between(low->most[k], high->most[k], part);
        effect->seconds[k] = between(low->seconds[k], high->seconds[k], part);
    }
    effect->tried = true;
}

/* Ways against the one at the top. Moments need tables of their own: only where many samples would be
   needed without. */
static bool study_ways(Study *study, double fine, WrError *err)
{
    bool good = run_way(study, study->top, study->best, err);
    for (int i = 0; good && i < study->top; i++)
        if (i == EIGHT) recompare_middle(study);
        else if (i != MOMENTS && wr_study_ways[i].high == 0) good = compare_way(study, i, err);
    if (!good) return false;
    judge_top(study, &study->of_way[study->top == SIXTEEN ? EIGHT : FOUR]);
    for (int i = 0; i < study->top; i++)
        if (wr_study_ways[i].high > 0) interpolate(study, i);
    const bool rough = fine >= MOMENTS_FROM && rms_of(study, &study->of_way[THREE]) > fine;
    const bool bump = study->modes[study->mode_count - 1] != WR_BUMP_NONE;
    return !rough || !bump || study->request->scene->analytic.kind != WR_ANALYTIC_OFF ||
           compare_way(study, MOMENTS, err);
}

static void make_room(Study *study)
{
    wr_free(study->middle);
    wr_free(study->best);
    wr_free(study->other);
    study->middle = wr_alloc(wr_study_floats(study), sizeof *study->middle);
    study->best = wr_alloc(wr_study_floats(study), sizeof *study->best);
    study->other = wr_alloc(wr_study_floats(study), sizeof *study->other);
}

/* How far 8 x 8 samples are off, by what 4 x 4 differ from them on a small sample. */
static bool middle_serves(Study *study, double fine, bool *serves, WrError *err)
{
    study->top = EIGHT;
    if (!run_way(study, EIGHT, study->best, err) || !compare_way(study, FOUR, err)) return false;
    judge_top(study, &study->of_way[FOUR]);
    memcpy(study->middle, study->best, wr_study_floats(study) * sizeof *study->middle);
    *serves = rms_of(study, &study->of_way[EIGHT]) <= SPARE * fine;
    return true;
}

bool wr_study_begin(Study *study, WrRenderer *renderer, const WrFrameRequest *request, double fine,
                    WrError *err)
{
    *study = (Study){ .renderer = renderer,
                      .request = request,
                      .blocks_u = (request->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK,
                      .blocks_v = (request->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK };
    WrFrame frame;
    bool serves;
    study->block_count = (int64_t)study->blocks_u * study->blocks_v;
    study->block = wr_alloc((size_t)study->block_count, sizeof *study->block);
    study->mask = wr_alloc((size_t)study->block_count, 1);
    list_rungs(study);
    WrScene *scene = wr_study_scene(study, best_with(study, 0));
    bool good = render(study, scene, NULL, &frame, NULL, err);
    wr_scene_free(scene);
    if (!good) return false;
    wr_study_sort(study, &frame);
    wr_study_draw(study, SHARE_SMALL);
    if (study->sample_count == 0) return true; /* an empty picture */
    make_room(study);
    if (!middle_serves(study, fine, &serves, err)) return false;
    if (serves) {
        wr_study_draw(study, SHARE_LARGE);
        make_room(study);
    } else {
        study->top = SIXTEEN;
    }
    return study_ways(study, fine, err) && study_formulas(study, fine, err);
}

void wr_study_fini(Study *study)
{
    wr_free(study->block);
    wr_free(study->mask);
    wr_free(study->middle);
    wr_free(study->best);
    wr_free(study->other);
    *study = (Study){ 0 };
}

/* ---- predictions ---- */

/* What another scheme or normal takes beside the best, on 2 x 2 samples; never taken for dearer. */
static double pace_of(const Effect *effect, const Effect *best)
{
    if (!(best->seconds[0] > 0)) return 1;
    return fmin(1, effect->seconds[0] / best->seconds[0]);
}

double wr_study_seconds(const Study *study, int kind, Place place)
{
    const double scheme =
        pace_of(&study->of_scheme[place.scheme], &study->of_scheme[study->scheme_count - 1]);
    const double mode =
        pace_of(&study->of_mode[place.mode], &study->of_mode[study->mode_count - 1]);
    const double pace = study->work > 0 ? study->wall / study->work : 1;
    return pace * scheme * mode * study->of_way[place.way].seconds[kind];
}

double wr_study_squares(const Study *study, int kind, Place place)
{
    /* Without bump the slopes do not matter. */
    const bool none = study->modes[place.mode] == WR_BUMP_NONE;
    return (none ? 0 : study->of_scheme[place.scheme].squares[kind]) +
           study->of_mode[place.mode].squares[kind] + study->of_way[place.way].squares[kind] +
           (place.way == study->top ? 0 : study->of_way[study->top].squares[kind]);
}

double wr_study_most(const Study *study, int kind, Place place)
{
    const bool none = study->modes[place.mode] == WR_BUMP_NONE;
    return (none ? 0 : study->of_scheme[place.scheme].most[kind]) +
           study->of_mode[place.mode].most[kind] + study->of_way[place.way].most[kind];
}

static bool same(Place a, Place b)
{
    return a.scheme == b.scheme && a.mode == b.mode && a.way == b.way;
}

bool wr_study_check(Study *study, const Place places[WR_CHOICE_KINDS],
                    double squares[WR_CHOICE_KINDS], double most[WR_CHOICE_KINDS], WrError *err)
{
    WrFrame frame;
    bool done[WR_CHOICE_KINDS] = { [KIND_EMPTY] = true }, good = true;
    for (int k = 1; good && k < WR_CHOICE_KINDS; k++) {
        if (done[k] || study->chosen[k] == 0) continue;
        for (int64_t b = 0; b < study->block_count; b++)
            study->mask[b] =
                study->block[b].sampled && same(places[study->block[b].kind], places[k]);
        for (int other = k; other < WR_CHOICE_KINDS; other++)
            done[other] = done[other] || same(places[other], places[k]);
        WrScene *scene = wr_study_scene(study, places[k]);
        good = render(study, scene, study->mask, &frame, NULL, err);
        wr_scene_free(scene);
    }
    if (!good) return false;
    wr_study_gather(study, &frame, study->other);
    wr_study_compare(study, study->best, study->other, squares, most);
    /* What the reference itself is off. */
    const Effect *top = &study->of_way[study->top];
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        squares[k] += top->squares[k];
        most[k] += top->most[k];
    }
    return true;
}
