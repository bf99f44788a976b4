/* Adaptive sampling (dials.h, WrRefine).

   By contrast: first one sample a pixel. Where light varies smoothly the pixel follows from that sample and its
   neighbours (kern_adaptive_body.h). Elsewhere K of the K x K samples are taken, and all K x K where those
   disagree with the neighbours' prediction. By bound: one sample, or all. A pixel that ends at K x K has the
   bits of `supersample`; no pixel depends on the division into tiles. */
#include "render/frame/adaptive_internal.h"
#include "render/visibility/silhouette.h"
#include "field/scheme_list.h"
#include "render/pipeline/pipeline.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define RING WR_REFINE_RING
#define EDGES_ALONE                                                                                \
    0.02f /* a `contrast` this large means speed first: the first samples are trusted */
/* Added where coverage differs: one sample is then off by more than any contrast (kern_adaptive_body.h). */
#define OUTLINE 1e6f
/* The mean of one random point in each of K x K cells has a deviation of about 0.29 / K^2 of the slope; this is
   four times that. */
#define JITTER 1.16

static void finer_texels(const WrColourLook *look, double *w, double *h)
{
    if (!look->rgba) return;
    *w = fmax(*w, fabs(look->ru) * look->width);
    *h = fmax(*h, fabs(look->rv) * look->height);
}

/* Texels per pixel along u and v, of the table or of the pictures, whichever are finer; 0: nothing is fetched. */
static void count_texels(const WrTileJob *job, float texels[2])
{
    const bool colour = wr_plan_calls(job->plan, WR_EFFECT_COLOUR);
    const bool table =
        wr_plan_calls(job->plan, WR_EFFECT_BUMP) && job->plan->source == WR_SOURCE_TABLE;
    const double w = table ? fabs(job->look.ru) * job->look.width : 0;
    const double h = table ? fabs(job->look.rv) * job->look.height : 0;
    double cw = 0, ch = 0;
    if (colour) finer_texels(&job->colour.near, &cw, &ch);
    for (int k = 0; k < WR_FACET_KINDS && wr_plan_calls(job->plan, WR_EFFECT_FACETS); k++)
        finer_texels(&job->facets[k].near, &cw, &ch);
    cw = fmax(cw, job->grain_texels[0]), ch = fmax(ch, job->grain_texels[1]);
    const bool map = wr_plan_calls(job->plan, WR_EFFECT_NORMALS);
    const double mw = map ? fabs(job->relief.ru) * job->relief.width : 0;
    const double mh = map ? fabs(job->relief.rv) * job->relief.height : 0;
    texels[0] = (float)fmax(mw, w > cw ? w : cw);
    texels[1] = (float)fmax(mh, h > ch ? h : ch);
}

/* True if light has steps, not only kinks, where texels meet (kern_adaptive_body.h). */
static bool slopes_jump(const WrPlan *plan)
{
    return plan->source == WR_SOURCE_TABLE &&
           wr_plan_calls(plan, WR_EFFECT_BUMP) && /* when bump is forced on, there are no slopes */
           (plan->scheme == WR_SCHEME_NEAREST || plan->scheme == WR_SCHEME_BILINEAR);
}

static WrRefineRule rule_of(const WrTileJob *job, float contrast, bool rooks)
{
    const bool jumps = slopes_jump(job->plan) || job->plan->grain != WR_SOLID_TEXTURE_OFF;
    WrRefineRule rule = { .most = jumps ? contrast / 2 : contrast,
                          .some = rooks && !jumps,
                          .all = job->plan->sampling == WR_SAMPLING_ALL };
    if (contrast < EDGES_ALONE) count_texels(job, rule.texels);
    return rule;
}

/* The rules of all objects; the background uses the strictest of them. */
static void make_rules(WrRefiner *r, const WrTileJob *jobs, int count, bool rooks)
{
    r->nothing = (WrRefineRule){ .most = r->contrast, .some = rooks };
    for (int i = 0; i < count; i++) {
        const WrRefineRule rule = rule_of(&jobs[i], r->contrast, rooks);
        r->rules[jobs[i].object] = rule;
        r->nothing.most = fminf(r->nothing.most, rule.most);
        r->nothing.some &= rule.some;
    }
}

static bool is_looked_up(const WrRefineRule *rule)
{
    return rule->texels[0] > 0 || rule->texels[1] > 0;
}

/* ---- the first samples -------------------------------------------------------------------------- */

/* Clears the tile and the ring around it. */
static void empty(const WrRefiner *r)
{
    WrTileScratch *s = r->scratch;
    const size_t wide = (size_t)(r->part.w + 2 * RING);
    for (int y = 0; y < r->part.h + 2 * RING; y++) {
        memset(s->centre[y], 0, wide * sizeof s->centre[0][0]);
        memset(s->uv[y], 0, wide * sizeof s->uv[0][0]);
        for (size_t x = 0; x < wide && r->count > 1; x++)
            s->nearest[y][x] = (WrNearest){ INFINITY, 0 };
    }
}

/* First samples of one object on those pixels. */
static void first_of(const WrRefiner *r, const WrTileJob *job, WrTilePart on)
{
    WrTileScratch *s = r->scratch;
    wr_refine_turn_to(r, job);
    WrDepthTile tile = wr_tile_depth(job, 1, on.x, on.y, on.w, on.h, s);
    const int left = on.x - r->part.x + RING, top = on.y - r->part.y + RING;
    const double start = wr_clock_seconds();
    for (int y = 0; y < tile.h; y++) {
        WrSink sink = { .rgba = s->centre[top + y][left] };
        if (r->by_bound) {
            for (int x = 0; x < on.w; x++) s->bound[y][x] = INFINITY;
            sink.bound = s->bound[y], sink.pixel = 1;
        } else if (is_looked_up(&r->rules[job->object])) {
            sink.uv = s->uv[top + y][left];
        }
        if (r->count > 1) sink.nearest = &s->nearest[top + y][left];
        job->pipe->row(job, 1, &tile, y, &sink, s);
    }
    s->all_strips += wr_clock_seconds() - start;
}

static WrTilePart grown(WrTilePart part, int by)
{
    return (WrTilePart){ part.x - by, part.y - by, part.w + 2 * by, part.h + 2 * by };
}

/* True if every sample there is nearer than `from`, so that anything behind is hidden. */
static bool is_filled(const WrRefiner *r, float from)
{
    for (int y = 0; y < r->part.h + 2 * RING; y++)
        for (int x = 0; x < r->part.w + 2 * RING; x++)
            if (!(r->scratch->nearest[y][x].depth < from)) return false;
    return true;
}

/* One sample a pixel, with a ring of two pixels round the tile, also beyond the picture. So the choice of pixels
   does not depend on the division into tiles. */
static void first_samples(const WrRefiner *r)
{
    const WrTilePart on = grown(r->part, r->by_bound ? 0 : RING);
    empty(r);
    for (int i = 0; i < r->count; i++) {
        const WrTileJob *job = r->objects[i];
        if (i > 0 && is_filled(r, wr_refine_limit(job, r->scratch))) break;
        first_of(r, job, on);
    }
}

/* ---- which pixels need more ---------------------------------------------------------------------- */

static void open_by_bound(const WrRefiner *r)
{
    WrTileScratch *s = r->scratch;
    for (int y = 0; y < r->part.h; y++) {
        const float(*row)[4] = (const float(*)[4])s->centre[y + RING] + RING;
        for (int x = 0; x < r->part.w; x++) {
            const bool closed = row[x][3] > 0.0f
                                    ? s->bound[y][x] <= r->contrast
                                    : wr_outline_misses(r->job, r->part.x + x, r->part.y + y);
            s->open[y][x] = closed ? 0 : WR_OPEN_ALL;
        }
        memcpy(wr_tile_pixel(r->job, r->part.x, r->part.y + y), row,
               (size_t)r->part.w * sizeof *row);
    }
}

/* Opens the pixels around a point of the picture, given in 1/256 samples. */
static void open_about(const WrRefiner *r, const WrRasterVertex *point)
{
    const double per = 256.0 * r->job->samples;
    const double px = floor(point->x / per) - r->part.x, py = floor(point->y / per) - r->part.y;
    for (int k = 0; k < 9; k++) {
        const double x = px + k % 3 - 1, y = py + k / 3 - 1;
        if (x >= 0 && y >= 0 && x < r->part.w && y < r->part.h)
            r->scratch->open[(int)y][(int)x] = WR_OPEN_ALL;
    }
}

static void open_tips(const WrRefiner *r, const WrTileJob *job)
{
    WrRasterVertex tips[WR_OUTLINE_TIPS];
    const int count = wr_outline_tips(job, tips);
    for (int k = 0; k < count; k++) open_about(r, &tips[k]);
}

/* Index of the object that the pixel's first sample shows; -1: background. */
static int shown_at(const WrRefiner *r, int x, int y)
{
    const WrTileScratch *s = r->scratch;
    if (s->centre[y + RING][x + RING][3] == 0.0f) return -1;
    return r->count > 1 ? s->nearest[y + RING][x + RING].object : r->objects[0]->object;
}

/* True if a neighbouring pixel shows another object, whose light predicts nothing for this one. */
static bool meets_another(const WrRefiner *r, int x, int y)
{
    const int own = shown_at(r, x, y);
    if (r->count < 2) return false;
    for (int k = 0; k < 9; k++)
        if (shown_at(r, x + k % 3 - 1, y + k / 3 - 1) != own) return true;
    return false;
}

/* Texels per pixel along row y, each pixel by its own object. */
static void count_row(const WrRefiner *r, int y)
{
    WrTileScratch *s = r->scratch;
    const float *uv[3];
    float line[WR_REFINE_W];
    for (int k = 0; k < 3; k++) uv[k] = s->uv[y + RING - 1 + k][RING - 1];
    memset(s->texels[y], 0, (size_t)r->part.w * sizeof s->texels[y][0]);
    for (int i = 0; i < r->count; i++) {
        const int object = r->objects[i]->object;
        const WrRefineRule *rule = &r->rules[object];
        if (!is_looked_up(rule)) continue;
        r->job->kernels->texels(uv, r->part.w, rule->texels, r->count > 1 ? line : s->texels[y]);
        for (int x = 0; x < r->part.w && r->count > 1; x++)
            if (shown_at(r, x, y) == object) s->texels[y][x] = line[x];
    }
}

/* Decides a pixel: 0: the prediction suffices; WR_OPEN: try K samples; WR_OPEN_ALL: take K x K. */
static int opened(const WrRefiner *r, int x, int y)
{
    const WrTileScratch *s = r->scratch;
    const int object = r->count > 1 ? shown_at(r, x, y) : r->objects[0]->object;
    const WrRefineRule *rule = object < 0 ? &r->nothing : &r->rules[object];
    const float off = s->bound[y][x], fine = s->texels[y][x];
    /* K samples lie closer together by about this factor */
    const float finest = WR_FINE * sqrtf((float)r->job->samples);
    const bool all = !rule->some || off > OUTLINE || fine > finest;
    if (r->among && (rule->all || meets_another(r, x, y))) return WR_OPEN_ALL;
    return off <= rule->most && fine <= WR_FINE ? 0 : all ? WR_OPEN_ALL : WR_OPEN;
}

/* weight: the mean of K x K samples has 1 - 1 / K^2 of the second-difference correction; slope: possible error
   of jittered samples. */
static void open_by_contrast(const WrRefiner *r)
{
    WrTileScratch *s = r->scratch;
    const float cells = (float)(r->job->samples * r->job->samples);
    const bool jittered = r->job->plan->spread == WR_SPREAD_JITTERED;
    const float weight = (jittered ? 1.0f : 1.0f - 1.0f / cells) / 24.0f;
    const float slope = jittered ? (float)JITTER / 2 / cells : 0;
    for (int y = 0; y < r->part.h; y++) {
        const float *rows[5];
        for (int k = 0; k < 5; k++) rows[k] = s->centre[y + k][0];
        count_row(r, y);
        r->job->kernels->smooth(rows, r->part.w, weight, slope,
                                wr_tile_pixel(r->job, r->part.x, r->part.y + y), s->bound[y]);
        for (int x = 0; x < r->part.w; x++) s->open[y][x] = (unsigned char)opened(r, x, y);
    }
}

/* Seconds of strips and rays so far; they are reported separately. */
static double told_elsewhere(const WrTileScratch *scratch)
{
    return scratch->all_strips + scratch->whole[WR_STAGE_VISIBILITY];
}

static void count_covered(const WrRefiner *r, int64_t before)
{
    WrTileScratch *s = r->scratch;
    s->met = s->covered - before;
    s->covered = before;
    for (int j = r->part.y; j < r->part.y + r->part.h; j++)
        for (int i = r->part.x; i < r->part.x + r->part.w; i++)
            s->covered += wr_tile_pixel(r->job, i, j)[3] > 0;
}

/* r: its objects are set; jobs: all objects of the picture. */
static void refine(WrRefiner *r, const WrTileJob *jobs, int count)
{
    WrTileScratch *s = r->scratch;
    const WrPlan *plan = r->job->plan;
    const double start = wr_clock_seconds(), before = told_elsewhere(s);
    const int64_t covered = s->covered;
    wr_did(s, WR_EFFECT_SAMPLES);
    make_rules(r, jobs, count, !r->by_bound && wr_refine_rooks(r));
    if (!r->by_bound || wr_plan_runs(plan, WR_EFFECT_BOUND)) {
        first_samples(r);
        if (r->by_bound) open_by_bound(r);
        else open_by_contrast(r);
        for (int i = 0; i < count && !r->by_bound; i++) open_tips(r, &jobs[i]);
    } else { /* no bound is known in this scene: K x K everywhere */
        memset(s->open, WR_OPEN_ALL, sizeof s->open);
    }
    wr_refine_more(r);
    count_covered(r, covered);
    s->whole[WR_STAGE_RESOLVE] += wr_clock_seconds() - start - (told_elsewhere(s) - before);
}

void wr_refine_tile(const WrTileJob *job, int x, int y, int w, int h, WrTileScratch *scratch)
{
    WrRefiner r = { .job = job,
                    .objects = { job },
                    .count = 1,
                    .scratch = scratch,
                    .part = { x, y, w, h },
                    .contrast = (float)job->plan->contrast,
                    .by_bound = job->plan->refine == WR_REFINE_BOUND };
    refine(&r, job, 1);
}

void wr_refine_group(const WrTileJob *canvas, const WrTileJob *jobs, int count, WrTilePart part,
                     int index, WrTileScratch *scratch)
{
    WrRefiner r = { .job = canvas,
                    .among = true,
                    .index = index,
                    .scratch = scratch,
                    .part = part,
                    .contrast = (float)canvas->plan->contrast };
    for (int i = 0; i < count; i++)
        if (wr_refine_touches(&jobs[i], grown(part, RING))) r.objects[r.count++] = &jobs[i];
    if (r.count > 0) refine(&r, jobs, count);
}
