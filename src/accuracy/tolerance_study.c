/* A sample of a picture's blocks at every rung. */
#include "accuracy/tolerance_inner.h"

#include "base/clock.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Of the blocks: 8 x 8 samples on the larger sample cost about as much as 16 x 16 on the smaller. */
#define SHARE_SMALL 0.018
#define SHARE_LARGE 0.055
#define SPARE 0.6 /* 8 x 8 is a reference where it is off by less than so much of the tolerance */

#define HOPE 0.12 /* of the change by 2 x 2 samples: finer than that, 8 x 8 will not serve */

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

/* *work: processor seconds, but for what the setting needed to be made first; may be NULL. */
static bool render(Study *study, const WrScene *scene, const unsigned char *only, WrFrame *frame,
                   double *work, WrError *err)
{
    WrFrameRequest request = *study->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = only;
    request.keep = false;
    request.hold = true;
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
    scene->dials.footprint = WR_FOOTPRINT_ISOTROPIC;
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
    if (table) {
        study->schemes[study->scheme_count++] = WR_SCHEME_BILINEAR;
        study->schemes[study->scheme_count++] = WR_SCHEME_BSPLINE_FIT;
    } else {
        study->schemes[study->scheme_count++] = scene->scheme;
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

/* One sample and 2 x 2 with a pair of slopes and normal, against the reference and the best pair's own.
   two: those of the best pair, of the sample. */
static bool study_pair(Study *study, int scheme, int mode, const float *two, const double paces[2],
                       WrError *err)
{
    Pair *pair = &study->pair[scheme][mode];
    double seconds[2];
    if (!try_place(study, (Place){ scheme, mode, WAY_POINT }, study->other, &seconds[0], err))
        return false;
    wr_study_compare(study, study->best, study->other, &pair->point);
    if (!try_place(study, (Place){ scheme, mode, WAY_TWO }, study->other, &seconds[1], err))
        return false;
    wr_study_compare(study, study->best, study->other, &pair->two);
    wr_study_compare(study, two, study->other, &pair->own);
    pair->point_pace = paces[0] > 0 ? fmin(1, seconds[0] / paces[0]) : 1;
    pair->two_pace = paces[1] > 0 ? fmin(1, seconds[1] / paces[1]) : 1;
    return pair->tried = true;
}

/* Relief may lie in blocks that were not drawn. What the bump does to one sample a pixel is known for the
   whole picture when it was rendered without; how much of that the sample has seen. */
static bool weigh_relief(Study *study, const float *one, WrError *err)
{
    Measure seen;
    double whole[WR_CHOICE_KINDS];
    WrFrame frame;
    WrScene *scene = wr_study_scene(study, (Place){ study->scheme_count - 1, 0, WAY_POINT });
    const bool good = render(study, scene, NULL, &frame, NULL, err);
    wr_scene_free(scene);
    if (!good) return false;
    wr_study_whole(study, &frame, whole);
    wr_study_gather(study, &frame, study->other);
    wr_study_compare(study, one, study->other, &seen);
    for (int i = 0; i < study->scheme_count; i++)
        for (int j = 0; j < study->mode_count; j++) {
            Pair *pair = &study->pair[i][j];
            for (int k = 1; pair->tried && k < WR_CHOICE_KINDS; k++) {
                const double missed = fmax(0, whole[k] - seen.sum[k]);
                const double own = pair->own.sum[k];
                const double more = seen.sum[k] > 0 ? missed * fmin(1, own / seen.sum[k]) : missed;
                pair->point.sum[k] += more;
                pair->two.sum[k] += more;
                pair->own.sum[k] += more;
            }
        }
    return true;
}

/* Slopes and normals, all with all; without a normal slopes do not matter. Never taken for dearer than
   the best. */
static bool study_pairs(Study *study, WrError *err)
{
    const int s = study->scheme_count - 1, m = study->mode_count - 1;
    double paces[2];
    const size_t floats = wr_study_floats(study);
    float *one = wr_alloc(floats, sizeof *one), *two = wr_alloc(floats, sizeof *two);
    bool good = try_place(study, best_with(study, WAY_POINT), one, &paces[0], err) &&
                try_place(study, best_with(study, WAY_TWO), two, &paces[1], err);
    for (int i = s; i >= 0; i--)
        for (int j = m; good && j >= 0; j--) {
            const bool none = study->modes[j] == WR_BUMP_NONE;
            if ((i < s || j < m) && (!none || i == s))
                good = study_pair(study, i, j, two, paces, err);
        }
    if (good && m > 0 && study->modes[0] == WR_BUMP_NONE) good = weigh_relief(study, one, err);
    study->pair[s][m] = (Pair){ .tried = true,
                                .point = study->way[WAY_POINT],
                                .two = study->way[WAY_TWO],
                                .point_pace = 1,
                                .two_pace = 1 };
    wr_free(one);
    wr_free(two);
    return good;
}

/* One way on the sample. A sample takes as long everywhere, so its time by kind follows from the pixels. */
static bool run_way(Study *study, int way, float *out, WrError *err)
{
    WrFrame frame;
    WrScene *scene = wr_study_scene(study, best_with(study, way));
    double work = 0, *seconds = study->way_seconds[way];
    mask_sample(study);
    const bool good = render(study, scene, study->mask, &frame, &work, err);
    wr_scene_free(scene);
    if (!good) return false;
    const double grid = wr_study_ways[way].samples;
    const double each = frame.shaded > 0 ? work * grid * grid / (double)frame.shaded : 0;
    memset(seconds, 0, sizeof study->way_seconds[way]);
    for (int64_t b = 0; b < study->block_count; b++)
        seconds[study->block[b].kind] += each * study->block[b].covered;
    wr_study_gather(study, &frame, out);
    return study->tried[way] = true;
}

/* The reference's own error from the last doubling, by the usual order 3/2 at edges:
   e(2k) = d(k, 2k) / (2^(3/2) - 1). Not where outlines run along the rows: there both may be off alike. */
static void judge_top(Study *study, const Measure *half)
{
    Measure *top = &study->way[study->top];
    const double share = 1 / (sqrt(8.0) - 1), squared = share * share;
    double aligned[WR_CHOICE_KINDS];
    wr_study_aligned(study, study->best, wr_study_ways[study->top].samples, aligned);
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        top->sum[k] = fmax(squared * half->sum[k], aligned[k]);
        top->variance[k] = squared * squared * half->variance[k];
        top->most[k] = share * half->most[k];
    }
}

static bool compare_way(Study *study, int way, WrError *err)
{
    if (!run_way(study, way, study->other, err)) return false;
    wr_study_compare(study, study->best, study->other, &study->way[way]);
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
    const Measure *low = &study->way[at->low], *high = &study->way[at->high];
    const double from = wr_study_ways[at->low].samples, to = wr_study_ways[at->high].samples;
    const double part = log(at->samples / from) / log(to / from);
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        study->way[way].sum[k] = between(low->sum[k], high->sum[k], part);
        study->way[way].variance[k] = between(low->variance[k], high->variance[k], part);
        study->way[way].most[k] = between(low->most[k], high->most[k], part);
        study->way_seconds[way][k] =
            between(study->way_seconds[at->low][k], study->way_seconds[at->high][k], part);
    }
    study->tried[way] = true;
}

/* Ways against the one at the top. Moments need tables of their own: only where many samples would be
   needed without. */
static bool study_ways(Study *study, double fine, WrError *err)
{
    bool good = study->tried[study->top] || run_way(study, study->top, study->best, err);
    for (int i = 0; good && i < study->top; i++)
        if (i == WAY_EIGHT) /* there already, on this very sample */
            wr_study_compare(study, study->best, study->middle, &study->way[i]);
        else if (i != WAY_MOMENTS && wr_study_ways[i].high == 0 && !study->tried[i])
            good = compare_way(study, i, err);
    if (!good) return false;
    judge_top(study, &study->way[study->top == WAY_SIXTEEN ? WAY_EIGHT : WAY_FOUR]);
    for (int i = 0; i < study->top; i++)
        if (wr_study_ways[i].high > 0) interpolate(study, i);
    const bool rough = fine >= MOMENTS_FROM && wr_study_rms(study, &study->way[WAY_TWO]) > fine;
    const bool bump = study->modes[study->mode_count - 1] != WR_BUMP_NONE;
    const WrField *field = study->request->field;
    const double texels = (double)wr_field_width(field) * wr_field_height(field);
    return !rough || !bump || texels > MOMENTS_TEXELS * study->pixels ||
           study->request->scene->analytic.kind != WR_ANALYTIC_OFF ||
           compare_way(study, WAY_MOMENTS, err);
}

static void draw(Study *study, double share)
{
    wr_study_draw(study, share);
    wr_free(study->middle);
    wr_free(study->best);
    wr_free(study->other);
    study->middle = wr_alloc(wr_study_floats(study), sizeof *study->middle);
    study->best = wr_alloc(wr_study_floats(study), sizeof *study->best);
    study->other = wr_alloc(wr_study_floats(study), sizeof *study->other);
    memset(study->tried, 0, sizeof study->tried);
}

/* Take 8 x 8 samples for the reference, if they are near enough, by what 4 x 4 differ from them. */
static bool try_middle(Study *study, double fine, bool *serves, WrError *err)
{
    study->top = WAY_EIGHT;
    draw(study, SHARE_LARGE);
    if (!run_way(study, WAY_EIGHT, study->best, err) || !compare_way(study, WAY_FOUR, err))
        return false;
    judge_top(study, &study->way[WAY_FOUR]);
    *serves = wr_study_rms(study, &study->way[WAY_EIGHT]) <= SPARE * fine;
    return true;
}

static bool take_top(Study *study, WrError *err)
{
    study->top = WAY_SIXTEEN;
    draw(study, SHARE_SMALL);
    return run_way(study, WAY_EIGHT, study->middle, err);
}

/* The whole picture with one sample a pixel and with 2 x 2: what that changes is most of what one sample
   is off, and blocks are sorted and drawn by it. *change: root mean square. */
static bool survey(Study *study, double *change, WrError *err)
{
    const WrFrameRequest *request = study->request;
    const size_t floats = (size_t)request->width * (size_t)request->height * 4;
    WrFrame frame;
    study->one = wr_try_alloc(floats, sizeof *study->one, "picture", err);
    bool good = study->one != NULL;
    for (int way = WAY_POINT; good && way <= WAY_TWO; way += WAY_TWO - WAY_POINT) {
        WrScene *scene = wr_study_scene(study, best_with(study, way));
        good = render(study, scene, NULL, &frame, NULL, err);
        wr_scene_free(scene);
        if (good && way == WAY_POINT) memcpy(study->one, frame.rgba, floats * sizeof *study->one);
    }
    if (good) wr_study_sort(study, &frame);
    double sum = 0;
    for (int64_t b = 0; good && b < study->block_count; b++) sum += study->block[b].change;
    *change = sqrt(sum / (3 * fmax(study->pixels, 1)));
    return good;
}

bool wr_study_begin(Study *study, WrRenderer *renderer, const WrFrameRequest *request, double fine,
                    WrError *err)
{
    *study = (Study){ .renderer = renderer,
                      .request = request,
                      .blocks_u = (request->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK,
                      .blocks_v = (request->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK };
    double change;
    study->block_count = (int64_t)study->blocks_u * study->blocks_v;
    study->block = wr_alloc((size_t)study->block_count, sizeof *study->block);
    study->mask = wr_alloc((size_t)study->block_count, 1);
    list_rungs(study);
    if (!survey(study, &change, err)) return false;
    if (study->blocks[KIND_EMPTY] == study->block_count) return true;
    bool serves = change * HOPE <= fine;
    if (serves && !try_middle(study, fine, &serves, err)) return false;
    if (!serves && !take_top(study, err)) return false;
    return study_ways(study, fine, err) && study_pairs(study, err);
}

void wr_study_fini(Study *study)
{
    wr_free(study->block);
    wr_free(study->mask);
    wr_free(study->one);
    wr_free(study->middle);
    wr_free(study->best);
    wr_free(study->other);
    *study = (Study){ 0 };
}

bool wr_study_check(Study *study, const Place places[WR_CHOICE_KINDS], Measure *out, WrError *err)
{
    WrFrame frame;
    bool done[WR_CHOICE_KINDS] = { [KIND_EMPTY] = true }, good = true;
    for (int k = 1; good && k < WR_CHOICE_KINDS; k++) {
        if (done[k] || study->chosen[k] == 0) continue;
        for (int64_t b = 0; b < study->block_count; b++)
            study->mask[b] =
                study->block[b].sampled && wr_same_place(places[study->block[b].kind], places[k]);
        for (int other = k; other < WR_CHOICE_KINDS; other++)
            done[other] = done[other] || wr_same_place(places[other], places[k]);
        WrScene *scene = wr_study_scene(study, places[k]);
        good = render(study, scene, study->mask, &frame, NULL, err);
        wr_scene_free(scene);
    }
    if (!good) return false;
    wr_study_gather(study, &frame, study->other);
    wr_study_compare(study, study->best, study->other, out);
    for (int k = 1; k < WR_CHOICE_KINDS; k++)
        if (study->blocks[k] > 0) wr_study_mend(study, k, places[k].way, out);
    return true;
}
