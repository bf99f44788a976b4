/* A sample of a picture's blocks at every rung. */
#include "accuracy/tolerance_inner.h"

#include "base/clock.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Of the blocks: 8 x 8 samples on three times as many cost about as much as 16 x 16. */
#define SHARE 0.018
#define LARGER 3
#define LEAST 4    /* blocks of a stratum */
#define SPARE 0.75 /* 8 x 8 is a reference where it is off by less than so much of the tolerance */
#define HOPE 0.075 /* of the change by 2 x 2 samples: finer than that, 16 x 16 are needed */
#define FINEST 0.1 /* finer than that, the best setting is nearly all that will do */

#define PASS 0.02 /* of one sample a pixel: what a pass takes beyond a frame of nothing */

#define MOMENTS_TEXELS 4   /* a pixel of the object: more of them take longer than they may save */
#define MOMENTS_FROM 0.008 /* RMS: their model of the slopes is seldom nearer */

const Way wr_study_ways[WAY_COUNT] = {
    [WAY_POINT] = { WR_AA_POINT, 1, 0, 0 },
    [WAY_MOMENTS] = { WR_AA_MOMENTS, 1, 0, 0 },
    [WAY_TWO] = { WR_AA_SUPERSAMPLE, 2, 0, 0 },
    [WAY_THREE] = { WR_AA_SUPERSAMPLE, 3, 0, 0 },
    [WAY_FOUR] = { WR_AA_SUPERSAMPLE, 4, 0, 0 },
    [WAY_FIVE] = { WR_AA_SUPERSAMPLE, 5, WAY_FOUR, WAY_EIGHT },
    [WAY_SIX] = { WR_AA_SUPERSAMPLE, 6, WAY_FOUR, WAY_EIGHT },
    [WAY_EIGHT] = { WR_AA_SUPERSAMPLE, 8, 0, 0 },
    [WAY_TEN] = { WR_AA_SUPERSAMPLE, 10, WAY_EIGHT, WAY_SIXTEEN },
    [WAY_TWELVE] = { WR_AA_SUPERSAMPLE, 12, WAY_EIGHT, WAY_SIXTEEN },
    [WAY_SIXTEEN] = { WR_AA_SUPERSAMPLE, 16, 0, 0 },
};

/* ---- frames ---- */

WrScene *wr_study_scene(const Study *study, Place place)
{
    WrScene *scene = wr_scene_clone(study->request->scene);
    const Way *way = &wr_study_ways[place.way];
    scene->scheme = study->schemes[place.scheme];
    scene->bump = study->modes[place.mode];
    scene->dials.aa = way->aa;
    scene->dials.samples = way->samples;
    scene->dials.spread = WR_SPREAD_REGULAR;
    scene->dials.footprint = WR_FOOTPRINT_ISOTROPIC;
    scene->dials.moments = WR_MOMENTS_LEAN;
    scene->tolerance = (WrTolerance){ WR_TOLERANCE_NONE, 0 };
    return scene;
}

bool wr_study_render(Study *study, Place place, const unsigned char *only, WrFrame *frame,
                     double *work, WrError *err)
{
    WrScene *scene = wr_study_scene(study, place);
    WrFrameRequest request = *study->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = only;
    request.keep = false;
    request.hold = true;
    request.normals = NULL;
    const double start = wr_clock_seconds(), worked = wr_clock_process_seconds();
    const bool good = wr_renderer_frame(study->renderer, &request, frame, err);
    const double wall = wr_clock_seconds() - start, spent = wr_clock_process_seconds() - worked;
    wr_scene_free(scene);
    if (!good) return false;
    const double made = frame->times.prepare < wall ? frame->times.prepare : wall;
    study->wall += wall;
    study->work += spent;
    if (work) *work = wall > 0 ? spent * (wall - made) / wall : 0;
    return true;
}

static void mask_sample(Study *study)
{
    for (int64_t b = 0; b < study->block_count; b++) study->mask[b] = study->block[b].sampled;
}

/* ---- the rungs ---- */

/* few: where nearly all will be the best setting, others are hardly worth a look. */
static void list_rungs(Study *study, bool few)
{
    const WrScene *scene = study->request->scene;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    study->scheme_count = study->mode_count = 0;
    if (table && !few) {
        study->schemes[study->scheme_count++] = WR_SCHEME_BILINEAR;
        study->schemes[study->scheme_count++] = WR_SCHEME_CENTRAL;
    }
    study->schemes[study->scheme_count++] = table ? WR_SCHEME_BSPLINE_FIT : scene->scheme;
    if (scene->bump == WR_BUMP_INVARIANT) {
        study->modes[study->mode_count++] = WR_BUMP_INVARIANT;
    } else {
        study->modes[study->mode_count++] = WR_BUMP_NONE;
        study->modes[study->mode_count++] = WR_BUMP_BLINN;
        if (!wr_surfaces[scene->shape.kind]->flat)
            study->modes[study->mode_count++] = WR_BUMP_EXACT;
    }
}

bool wr_study_try(Study *study, Place place, float *out, double *work, WrError *err)
{
    WrFrame frame;
    double all;
    mask_sample(study);
    if (!wr_study_render(study, place, study->mask, &frame, &all, err)) return false;
    if (work) *work = frame.shaded > 0 ? all / (double)frame.shaded : 0;
    wr_study_gather(study, frame.rgba, out);
    return true;
}

/* ---- ways ---- */

/* One way on the sample. A sample takes as long everywhere. */
static bool run_way(Study *study, int way, float *out, WrError *err)
{
    const double grid = wr_study_ways[way].samples;
    if (!wr_study_try(study, wr_best_place(study, way), out, &study->each[way], err)) return false;
    study->each[way] *= grid * grid;
    return study->tried[way] = true;
}

static void compare_way(Study *study, int way, const float *with)
{
    wr_study_compare(study, study->best, with, study->size.of, &study->way[way]);
}

static bool measure_way(Study *study, int way, WrError *err)
{
    if (!run_way(study, way, study->other, err)) return false;
    compare_way(study, way, study->other);
    return true;
}

/* Between two numbers of samples errors fall as a power of them. */
static double between(double a, double b, double part)
{
    return a > 0 && b > 0 ? pow(a, 1 - part) * pow(b, part) : (1 - part) * a + part * b;
}

static void interpolate(Study *study, int way)
{
    const Way *at = &wr_study_ways[way];
    const int below = at->low, above = at->high < study->top ? at->high : study->top;
    const Rate *low = &study->way[below], *high = &study->way[above];
    const double from = wr_study_ways[below].samples, to = wr_study_ways[above].samples;
    const double part = log(at->samples / from) / log(to / from);
    for (int s = 1; s < STRATA; s++) {
        study->way[way].ratio[s] = between(low->ratio[s], high->ratio[s], part);
        study->way[way].spread[s] = between(low->spread[s], high->spread[s], part);
        study->way[way].most[s] = between(low->most[s], high->most[s], part);
    }
    study->each[way] = between(study->each[below], study->each[above], part);
    study->tried[way] = true;
}

/* Ways against the one at the top. Moments need tables of their own: only where many samples would be
   needed without. */
static bool study_ways(Study *study, double fine, WrError *err)
{
    bool good = study->tried[study->top] || run_way(study, study->top, study->best, err);
    study->tried[WAY_POINT] = true; /* by pair, from whole pictures */
    for (int i = 0; good && i < study->top; i++)
        if (i == WAY_EIGHT) compare_way(study, i, study->middle); /* there already */
        else if (i != WAY_MOMENTS && wr_study_ways[i].high == 0 && !study->tried[i])
            good = measure_way(study, i, err);
    if (!good) return false;
    wr_study_judge_top(study, study->top == WAY_EIGHT ? WAY_FOUR : WAY_EIGHT);
    for (int i = WAY_TWO; i < study->top; i++)
        if (wr_study_ways[i].high == 0) wr_study_mend(study, &study->size, &study->way[i]);
    for (int i = 0; i < study->top; i++)
        if (wr_study_ways[i].high > 0) interpolate(study, i);
    const bool rough =
        fine >= MOMENTS_FROM && wr_study_rate_rms(study, &study->way[WAY_TWO], &study->size) > fine;
    const bool bump = study->modes[study->mode_count - 1] != WR_BUMP_NONE;
    const WrField *field = study->request->field;
    const double texels = (double)wr_field_width(field) * wr_field_height(field);
    return !rough || !bump || texels > MOMENTS_TEXELS * study->pixels ||
           study->request->scene->analytic.kind != WR_ANALYTIC_OFF ||
           measure_way(study, WAY_MOMENTS, err);
}

/* ---- the sample ---- */

static void draw(Study *study, double share, int64_t least)
{
    wr_study_draw(study, share, least);
    wr_free(study->best);
    wr_free(study->other);
    study->best = wr_alloc(wr_study_floats(study), sizeof *study->best);
    study->other = wr_alloc(wr_study_floats(study), sizeof *study->other);
    memset(study->tried, 0, sizeof study->tried);
}

/* Take 8 x 8 samples for the reference. *off: what they are off, by what 4 x 4 differ from them. */
static bool try_middle(Study *study, double *off, WrError *err)
{
    study->top = WAY_EIGHT;
    draw(study, LARGER * SHARE, LEAST);
    if (!run_way(study, WAY_EIGHT, study->best, err) || !measure_way(study, WAY_FOUR, err))
        return false;
    wr_study_judge_top(study, WAY_FOUR);
    *off = wr_study_rate_rms(study, &study->way[WAY_EIGHT], &study->size);
    return true;
}

/* 8 x 8 samples of the blocks of this sample, taken from those of the one before where it holds them all. */
static bool keep_middle(Study *study, const float *before, const unsigned char *was, WrError *err)
{
    const size_t packed = wr_study_floats(study) / (size_t)study->sample_count;
    float *out = study->middle;
    for (int64_t b = 0; b < study->block_count; b++) {
        if (study->block[b].sampled && !was[b])
            return run_way(study, WAY_EIGHT, study->middle, err);
        if (study->block[b].sampled) {
            memcpy(out, before, packed * sizeof *out);
            out += packed;
        }
        if (was[b]) before += packed;
    }
    return study->tried[WAY_EIGHT] = true;
}

static bool take_top(Study *study, int top, WrError *err)
{
    float *before = study->best;
    unsigned char *was = wr_alloc((size_t)study->block_count, 1);
    for (int64_t b = 0; b < study->block_count; b++) was[b] = study->block[b].sampled;
    study->best = NULL;
    study->top = top;
    draw(study, SHARE, LEAST);
    study->middle = wr_alloc(wr_study_floats(study), sizeof *study->middle);
    const bool good = before ? keep_middle(study, before, was, err)
                             : run_way(study, WAY_EIGHT, study->middle, err);
    wr_free(before);
    wr_free(was);
    return good;
}

/* 8 x 8 samples if they are near enough; else 12 x 12, if those will be, or 16 x 16. */
static bool find_reference(Study *study, double fine, double change, WrError *err)
{
    double off = INFINITY;
    if (change * HOPE <= fine && !try_middle(study, &off, err)) return false;
    if (off <= SPARE * fine) return true;
    const bool twelve = off * pow(8.0 / 12, 1.5) <= SPARE * fine;
    return take_top(study, twelve ? WAY_TWELVE : WAY_SIXTEEN, err);
}

/* ---- the whole picture ---- */

/* The whole picture with one sample a pixel and with 2 x 2: what that changes is most of what one sample
   is off, and blocks are sorted and drawn by it. work: processor seconds of each. */
static bool survey(Study *study, double work[2], WrError *err)
{
    WrFrame frame;
    return wr_study_render(study, wr_best_place(study, WAY_POINT), NULL, &frame, &work[0], err) &&
           wr_packed_make(study, frame.rgba, &study->one, err) &&
           wr_study_render(study, wr_best_place(study, WAY_TWO), NULL, &frame, &work[1], err) &&
           wr_packed_make(study, frame.rgba, &study->two, err);
}

/* What a covered pixel takes, from the whole pictures of one and of 2 x 2 samples; single blocks are a little
   slower, all ways alike. And what one more pass over the picture takes. */
static bool find_times(Study *study, const double work[2], WrError *err)
{
    WrFrame frame;
    double covered = 0;
    memset(study->mask, 0, (size_t)study->block_count);
    const double before = study->work;
    if (!wr_study_render(study, wr_best_place(study, WAY_POINT), study->mask, &frame, NULL, err))
        return false;
    study->pass = study->work - before + PASS * work[0];
    for (int k = 1; k < KINDS; k++) covered += (double)study->covered[k];
    const double two = covered > 0 ? work[1] / covered : 0;
    const double tempo = study->each[WAY_TWO] > 0 && two > 0 ? two / study->each[WAY_TWO] : 1;
    for (int way = 0; way < WAY_COUNT; way++) study->each[way] *= fmax(0.5, fmin(1, tempo));
    study->each[WAY_POINT] = covered > 0 ? work[0] / covered : 0;
    return true;
}

bool wr_study_begin(Study *study, WrRenderer *renderer, const WrFrameRequest *request, double fine,
                    WrError *err)
{
    *study = (Study){ .renderer = renderer,
                      .request = request,
                      .blocks_u = (request->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK,
                      .blocks_v = (request->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK };
    double work[2];
    study->block_count = (int64_t)study->blocks_u * study->blocks_v;
    study->block = wr_alloc((size_t)study->block_count, sizeof *study->block);
    study->mask = wr_alloc((size_t)study->block_count, 1);
    list_rungs(study, false);
    if (!survey(study, work, err)) return false;
    const double change = wr_study_sort(study);
    if (study->all[STRATUM_EMPTY] == study->block_count) return true;
    list_rungs(study, fine < FINEST * change);
    if (!find_reference(study, fine, change, err)) return false;
    return study_ways(study, fine, err) && wr_study_pairs(study, fine, change, work[0], err) &&
           find_times(study, work, err);
}

void wr_study_fini(Study *study)
{
    wr_free(study->block);
    wr_free(study->mask);
    wr_packed_fini(&study->one);
    wr_packed_fini(&study->two);
    wr_free(study->middle);
    wr_free(study->best);
    wr_free(study->other);
    wr_control_fini(&study->size);
    for (int i = 0; i < SCHEMES_MAX; i++)
        for (int j = 0; j < MODES_MAX; j++) {
            wr_control_fini(&study->pair[i][j].change);
            wr_control_fini(&study->pair[i][j].formula);
        }
    *study = (Study){ 0 };
}

/* ---- the outcome ---- */

/* The sample with each kind at its place, into study->other. */
static bool render_places(Study *study, const Place places[KINDS], WrError *err)
{
    WrFrame frame;
    bool done[KINDS] = { true };
    for (int k = 1; k < KINDS; k++) {
        if (done[k] || study->blocks[k] == 0) continue;
        for (int64_t b = 0; b < study->block_count; b++)
            study->mask[b] =
                study->block[b].sampled && wr_same_place(places[study->block[b].kind], places[k]);
        for (int other = k; other < KINDS; other++)
            done[other] = done[other] || wr_same_place(places[other], places[k]);
        if (!wr_study_render(study, places[k], study->mask, &frame, NULL, err)) return false;
    }
    wr_study_gather(study, frame.rgba, study->other);
    return true;
}

/* To the truth: what differs from the reference, and what is the reference. */
static void add_reference(const Study *study, const Place places[KINDS], Error seen[STRATA])
{
    const Rate *top = &study->way[study->top];
    double within[STRATA] = { 0 }, itself[STRATA] = { 0 };
    for (int k = 1; k < KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        const double own = top->ratio[wr_stratum(k)] * study->size.sum[k];
        if (places[k].way == study->top) itself[wr_stratum(k)] += own;
        else within[wr_stratum(k)] += own;
    }
    for (int s = 1; s < STRATA; s++)
        seen[s].sum = wr_study_mended(study->aligned[s], seen[s].sum, within[s]) + itself[s];
}

bool wr_study_check(Study *study, const Place places[KINDS], Error seen[STRATA],
                    double foretold[STRATA], WrError *err)
{
    Rate rate;
    if (!render_places(study, places, err)) return false;
    float *control = wr_alloc((size_t)study->block_count, sizeof *control);
    memset(foretold, 0, STRATA * sizeof *foretold);
    for (int64_t b = 0; b < study->block_count; b++) {
        const Block *block = &study->block[b];
        if (block->stratum == STRATUM_EMPTY) continue;
        control[b] = (float)(wr_study_predict_block(study, b, places[block->kind]) +
                             1e-9 * (double)study->size.of[b]);
        foretold[block->stratum] += (double)control[b];
    }
    wr_study_compare(study, study->best, study->other, control, &rate);
    wr_free(control);
    for (int s = 1; s < STRATA; s++)
        seen[s] =
            (Error){ rate.ratio[s] * foretold[s], rate.spread[s] * foretold[s], rate.most[s] };
    add_reference(study, places, seen);
    return true;
}
