/* Adaptive sampling (dials.h, WrRefine).

   By contrast: first one sample a pixel. Where light varies smoothly the pixel follows from that sample and its
   neighbours (kern_adaptive_body.h). Elsewhere K of the K x K samples are taken, and all K x K where those
   disagree with the neighbours' prediction. By bound: one sample, or all. A pixel that ends at K x K has the
   bits of `supersample`; no pixel depends on the division into tiles. */
#include "field/scheme_list.h"
#include "render/frame/tile.h"
#include "render/frame/tile_internal.h"
#include "render/pipeline/pipeline.h"
#include "render/visibility/raster.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { WR_OPEN = 1, WR_OPEN_ALL = 2 }; /* the pixel needs more samples; needs all of them */

/* Above this many texels per pixel, neighbours predict little: K samples are taken and have to agree more
   closely. */
#define WR_FINE 2.0f

/* Thresholds for the pixels that show one object. */
typedef struct WrRefineRule {
    float texels[2]; /* per pixel along u and v, of the fetched textures */
    float most;      /* largest error allowed of the estimate */
    bool some;       /* K samples are tried before all K x K */
    bool all;        /* for this object, fewer than all would cost more */
} WrRefineRule;

typedef struct WrRefiner {
    const WrTileJob *job; /* target of the pixels */
    /* objects that may cover the tile, the nearest first */
    const WrTileJob *objects[WR_OBJECTS_MAX];
    int count;
    bool among; /* the picture has several objects */
    int index;  /* several objects: the tile's index, for WrTileJob.seen */
    WrTileScratch *scratch;
    WrTilePart part;
    float contrast;
    bool by_bound;
    /* by WrTileJob.object; `nothing`: the background's */
    WrRefineRule rules[WR_OBJECTS_MAX], nothing;
    unsigned char rook[WR_TILE_SAMPLES_H]; /* column of the chosen sample in each row */
} WrRefiner;

/* True if the object may cover that part of the picture. */
static inline bool wr_refine_touches(const WrTileJob *job, WrTilePart part)
{
    if (wr_plan_runs(job->plan, WR_EFFECT_BESIDE)) return true;
    part = wr_tile_touched(job, part);
    return part.w > 0 && part.h > 0;
}

/* Makes `job` the object of the following samples. */
static inline void wr_refine_turn_to(const WrRefiner *r, const WrTileJob *job)
{
    if (r->among) r->scratch->notes = wr_dirty_open(job->seen, r->index, 0, 0);
}

/* Depth beyond which the whole object is hidden (E52). */
static inline float wr_refine_limit(const WrTileJob *job, WrTileScratch *scratch)
{
    if (!wr_plan_runs(job->plan, WR_EFFECT_HIDDEN)) return wr_tile_hidden_from(job);
    wr_did(scratch, WR_EFFECT_HIDDEN);
    return -INFINITY;
}

/* ---- probe ---- */

/* Estimate of whether adaptive sampling pays in this view: a few small blocks of the picture are refined and
   counted. */

#define BLOCK_W 8 /* pixels */
#define BLOCK_H 4
#define AREA 3000 /* pixels of the view for each block, ... */
#define LEAST 16  /* ... and the least number of blocks */
#define MAX_MOST 128
/* mesh blocks: above this each probe is slow, because it traverses them all, so only ... */
#define HEAVY 4096
#define FEW 5   /* ... this many probes are taken */
#define SURE 12 /* after this many blocks the answer may be clear */

/* Measured costs, in samples of plain supersampling. With a mesh each sample costs more, so the overhead counts
   less.
   Fitted to timings of many scenes; only their ratios decide. */
#define FIRST 1.9 /* a first sample, its share of the ring, and the test */
#define FIRST_MESH 1.7
#define FIRST_BOUND 7.0 /* with a bound */
#define MORE 1.6        /* each further sample: they are scattered */
#define MORE_MESH 1.2
#define DEPTH 0.15 /* one cell of the depth tile, which is filled for all of them */
#define GAIN 0.85  /* of plain supersampling's cost: above this the gain is too small */

typedef struct Spent {
    double adaptive, plain;
} Spent;

/* Counts the first samples of the block that hit something: inside it, and with the ring.
   centre[][] has a ring of WR_REFINE_RING pixels around the block. */
static void count_first(const WrTileScratch *scratch, int w, int h, int ring, int *within, int *all)
{
    *within = *all = 0;
    for (int y = -ring; y < h + ring; y++)
        for (int x = -ring; x < w + ring; x++) {
            const bool met = scratch->centre[y + WR_REFINE_RING][x + WR_REFINE_RING][3] > 0;
            *all += met;
            *within += met && y >= 0 && y < h && x >= 0 && x < w;
        }
}

static void spend_block(const WrTileJob *job, int x, int y, WrTileScratch *scratch, Spent *spent)
{
    WrTileJob own = *job;
    const int w = job->width < BLOCK_W ? job->width : BLOCK_W;
    const int h = job->height < BLOCK_H ? job->height : BLOCK_H;
    const bool bound = job->plan->refine == WR_REFINE_BOUND;
    const double cells = (double)job->samples * job->samples;
    int within, all;
    own.rgba = scratch->mean[0];
    own.rgba_pitch = (size_t)w;
    own.x0 = x < 0 ? 0 : x > job->width - w ? job->width - w : x;
    own.y0 = y < 0 ? 0 : y > job->height - h ? job->height - h : y;
    memset(scratch->mean, 0, (size_t)(w * h) * sizeof *scratch->mean);
    wr_refine_tile(&own, own.x0, own.y0, w, h, scratch);
    count_first(scratch, w, h, bound ? 0 : WR_REFINE_RING, &within, &all);
    const double more = (double)(scratch->met - all);
    double area = 0;
    for (int i = 0; i < w * h; i++) area += (double)scratch->mean[i][3];
    spent->plain += cells * area;
    const bool tiled = job->mesh || job->triangles;
    const double first = bound ? FIRST_BOUND : tiled ? FIRST_MESH : FIRST;
    spent->adaptive += first * within + (tiled ? MORE_MESH : MORE) * more +
                       (tiled && more > 0 ? DEPTH * cells * area : 0);
}

/* True if more blocks would hardly change the answer. */
static bool clear(const Spent *spent)
{
    return spent->plain > 0 &&
           (spent->adaptive > 1.3 * spent->plain || spent->adaptive < 0.5 * spent->plain);
}

/* Blocks are spread evenly over the view, but not in rows, with which relief may be in step: they lie at
   multiples of 1/p and 1/p^2, p the plastic number.
   The plastic number is the real root of p^3 = p + 1; these multiples (R2 sequence, Roberts 2018) are evenly
   spread for any count. */
#define ACROSS 0xc13fa9a9U /* of 2^32 */
#define DOWN 0x91e10da5U

static int place(int k, uint32_t step, int room)
{
    return (int)(((uint64_t)((uint32_t)(k + 1) * step) * (uint64_t)room) >> 32);
}

/* True if each probe is slow: cells near the eye that need clipping are visited by every one. */
static bool is_heavy(const WrViewMesh *mesh)
{
    const int count = mesh->blocks_u * mesh->blocks_v;
    for (int i = 0; i < count; i++)
        if (mesh->blocks[i].clipped) return true;
    return count > HEAVY;
}

bool wr_refine_pays(const WrTileJob *job, WrTileScratch *scratch)
{
    const WrView *view = job->view;
    const int w = view->x1 - view->x0, h = view->y1 - view->y0;
    if (w < 6 * BLOCK_W || h < 6 * BLOCK_W) return true; /* too small to measure */
    WrTileJob own = *job;
    Spent spent = { 0 };
    own.codes = NULL, own.normals = NULL, own.map = NULL, own.seen = NULL;
    scratch->notes = (WrDirtyNotes){ 0 };
    const int64_t area = (int64_t)w * h / AREA;
    const bool heavy = job->triangles || (job->mesh && is_heavy(job->mesh));
    const int count = heavy ? FEW : area < LEAST ? LEAST : area > MAX_MOST ? MAX_MOST : (int)area;
    for (int k = 0; k < count && !(k >= SURE && clear(&spent)); k++)
        spend_block(&own, view->x0 + place(k, ACROSS, w - BLOCK_W),
                    view->y0 + place(k, DOWN, h - BLOCK_H), scratch, &spent);
    return !(spent.adaptive > GAIN * spent.plain);
}

/* ---- samples ---- */

/* Further samples for open pixels: K of the K x K, then the others where those are not enough. */

#define RING WR_REFINE_RING
#define MAX_SAMPLES WR_TILE_SAMPLES_H /* largest K */
/* Largest deviation of each of the K samples, and of their mean, from the neighbours' prediction, in multiples
   of `contrast`. */
#define SAMPLE_OFF 4.0f
#define FINE_OFF 1.5f /* as SAMPLE_OFF, for pixels with many texels */

/* ---- more samples -------------------------------------------------------------------------------- */

/* For K = 4, 8, 12, ...: one sample in each row and column, a set that a quarter turn maps to itself. For any
   quadratic function its mean equals that of all K x K samples.
   A quarter turn maps the set to itself, so the means of x, y, xy and x^2 - y^2 vanish; one sample in each row
   and column has the same mean of x^2 and y^2 as the whole grid. */
static bool refine_rooks(WrRefiner *r)
{
    const int k = r->job->samples, quarter = k / 4;
    if (k % 4 != 0 || r->job->plan->spread == WR_SPREAD_JITTERED) return false;
    for (int c = 0; c < quarter; c++) {
        const int x = c, y = c & 1 ? k - 1 - (c + quarter) : c + quarter;
        r->rook[x] = (unsigned char)y;
        r->rook[y] = (unsigned char)(k - 1 - x);
        r->rook[k - 1 - x] = (unsigned char)(k - 1 - y);
        r->rook[k - 1 - y] = (unsigned char)x;
    }
    return true;
}

/* A list of pixels, the objects that they may show, and the depth tile of one of them. */
typedef struct Batch {
    const WrRefiner *r;
    WrTilePart part; /* of the tile */
    const WrTileJob *objects[WR_OBJECTS_MAX];
    int count;
    bool tiled;
    const WrTileJob *of; /* owner of the depth tile; NULL: none yet */
    WrDepthTile tile;
} Batch;

/* Samples of one object that wait for a full strip, and their destinations.
   Destinations are pointers into sample[][]; a strip is drawn when WR_SPAN samples are queued, whatever pixels
   they belong to. */
typedef struct Queue {
    const Batch *batch;
    const WrTileJob *job;
    bool first;  /* no object was drawn before it */
    float limit; /* depth beyond which the object is hidden */
    float (*to[WR_SPAN])[4];
} Queue;

/* Depth and object of a sample, where there are several objects. */
static WrNearest *nearest_of(WrTileScratch *s, float (*sample)[4])
{
    return &s->nearest[0][0] + (sample - &s->sample[0][0]);
}

static void empty_queue(Queue *queue)
{
    WrTileScratch *s = queue->batch->r->scratch;
    const WrTileJob *job = queue->job;
    float line[WR_SPAN][4];
    WrNearest nearest[WR_SPAN];
    const int count = s->scatter.count;
    const bool several = queue->batch->count > 1;
    if (count == 0) return;
    if (queue->first) memset(line, 0, (size_t)count * sizeof line[0]);
    for (int i = 0; i < count && several; i++) {
        if (!queue->first) memcpy(line[i], queue->to[i], sizeof line[i]);
        nearest[i] = queue->first ? (WrNearest){ INFINITY, 0 } : *nearest_of(s, queue->to[i]);
    }
    WrSink sink = { .rgba = line[0], .nearest = several ? nearest : NULL };
    const double start = wr_clock_seconds();
    job->pipe->points(job, job->samples, &queue->batch->tile, &sink, s);
    s->all_strips += wr_clock_seconds() - start;
    for (int i = 0; i < count; i++) memcpy(queue->to[i], line[i], sizeof line[i]);
    for (int i = 0; i < count && several; i++) *nearest_of(s, queue->to[i]) = nearest[i];
    s->scatter.count = 0;
}

/* Queues sample (i, j) of the tile's pixel (x, y). */
static void queue_sample(Queue *queue, const unsigned char at[2], int i, int j, float (*to)[4])
{
    const WrRefiner *r = queue->batch->r;
    const WrDepthTile *tile = &queue->batch->tile;
    WrScatter *places = &r->scratch->scatter;
    const int k = r->job->samples, n = places->count;
    const int x = (r->part.x + at[0]) * k + i, y = (r->part.y + at[1]) * k + j;
    const int cell = (y - tile->y) * tile->w + x - tile->x;
    const signed char *shift = tile->shift ? tile->shift + 2 * cell : NULL;
    if (!queue->first && nearest_of(r->scratch, to)->depth < queue->limit) return;
    places->x[n] = x + (shift ? shift[0] / 256.0 : 0);
    places->y[n] = y + (shift ? shift[1] / 256.0 : 0);
    places->cell[n] = cell;
    queue->to[n] = to;
    if (++places->count == WR_SPAN) empty_queue(queue);
}

/* The samples of `count` pixels of the list, K x K each, pixel by pixel. */
static float (*samples_of(const WrRefiner *r, int at))[4]
{
    const int k = r->job->samples;
    return &r->scratch->sample[0][0] + (size_t)at * (size_t)(k * k);
}

/* Queues the K first samples of pixels that may suffice with them. */
static void queue_rooks(Queue *queue, int first, int count)
{
    const WrRefiner *r = queue->batch->r;
    const int k = r->job->samples;
    for (int n = 0; n < count; n++) {
        const unsigned char *at = r->scratch->list[first + n];
        if (r->scratch->open[at[1]][at[0]] != WR_OPEN) continue;
        for (int j = 0; j < k; j++)
            queue_sample(queue, at, r->rook[j], j, samples_of(r, n) + j * k + r->rook[j]);
    }
}

/* Queues the samples that open pixels still lack: all, or those outside the K. */
static void queue_rest(Queue *queue, int first, int count)
{
    const WrRefiner *r = queue->batch->r;
    const int k = r->job->samples;
    for (int n = 0; n < count; n++) {
        const unsigned char *at = r->scratch->list[first + n];
        const int open = r->scratch->open[at[1]][at[0]];
        if (!open) continue;
        for (int j = 0; j < k; j++)
            for (int i = 0; i < k; i++)
                if (open == WR_OPEN_ALL || i != r->rook[j])
                    queue_sample(queue, at, i, j, samples_of(r, n) + j * k + i);
    }
}

static void update_tile(Batch *batch, const WrTileJob *job)
{
    const WrRefiner *r = batch->r;
    const WrTilePart *part = &batch->part;
    const int k = job->samples;
    wr_refine_turn_to(r, job);
    if (!batch->tiled || batch->of == job) return;
    batch->tile = wr_tile_depth(job, k, (r->part.x + part->x) * k, (r->part.y + part->y) * k,
                                part->w * k, part->h * k, r->scratch);
    batch->of = job;
}

/* Draws samples of listed pixels, for all objects. */
static void sample_pixels(Batch *batch, void (*fill)(Queue *, int, int), int first, int count)
{
    WrTileScratch *s = batch->r->scratch;
    for (int i = 0; i < batch->count; i++) {
        const WrTileJob *job = batch->objects[i];
        Queue queue = { .batch = batch, .job = job, .first = i == 0 };
        if (i > 0) queue.limit = wr_refine_limit(job, s);
        update_tile(batch, job);
        s->scatter.count = 0;
        fill(&queue, first, count);
        empty_queue(&queue);
    }
}

static bool any_open(const WrRefiner *r, int first, int count, int least, int most)
{
    for (int n = first; n < first + count; n++) {
        const unsigned char *at = r->scratch->list[n];
        const int open = r->scratch->open[at[1]][at[0]];
        if (open >= least && open <= most) return true;
    }
    return false;
}

/* Sum of count colours, added in pairs, into the first one; the others are overwritten. */
static void sum_pairs(float (*x)[4], int count)
{
    for (; count > 1; count = (count + 1) / 2) {
        for (int i = 0; i < count / 2; i++)
            for (int c = 0; c < 4; c++) x[i][c] = x[2 * i][c] + x[2 * i + 1][c];
        if (count & 1) memcpy(x[count / 2], x[count - 1], sizeof *x);
    }
}

/* Linear and quadratic change of light around a pixel's centre, estimated from its neighbours.
   Central differences: f(dx, dy) = f0 + x dx + y dy + xx dx^2 + yy dy^2 + xy dx dy, with xx half the second
   difference. */
typedef struct Bend {
    float x[4], y[4], xx[4], yy[4], xy[4];
} Bend;

static Bend bend_at(const WrTileScratch *s, int x, int y)
{
    const float(*up)[4] = (const float(*)[4])s->centre[y + RING - 1] + x + RING;
    const float(*mid)[4] = (const float(*)[4])s->centre[y + RING] + x + RING;
    const float(*low)[4] = (const float(*)[4])s->centre[y + RING + 1] + x + RING;
    Bend b;
    for (int c = 0; c < 4; c++) {
        b.x[c] = (mid[1][c] - mid[-1][c]) / 2, b.y[c] = (low[0][c] - up[0][c]) / 2;
        b.xx[c] = (mid[1][c] + mid[-1][c]) / 2 - mid[0][c];
        b.yy[c] = (low[0][c] + up[0][c]) / 2 - mid[0][c];
        b.xy[c] = ((low[1][c] - low[-1][c]) - (up[1][c] - up[-1][c])) / 4;
    }
    return b;
}

/* True if the mean of the K samples is accurate enough; it then becomes the pixel.
   Three tests: no sample is far from the quadratic prediction, coverage is that of the centre, and the mean
   agrees with the prediction of the first pass. NaN fails each comparison. */
static bool rooks_agree(const WrRefiner *r, const unsigned char at[2], float (*sample)[4])
{
    const int k = r->job->samples;
    const float *centre = r->scratch->centre[at[1] + RING][at[0] + RING];
    const Bend bend = bend_at(r->scratch, at[0], at[1]);
    float rook[MAX_SAMPLES][4];
    float most = 0, *pixel = wr_tile_pixel(r->job, r->part.x + at[0], r->part.y + at[1]);
    for (int j = 0; j < k; j++) {
        const float dx = ((float)r->rook[j] + 0.5f) / (float)k - 0.5f;
        const float dy = ((float)j + 0.5f) / (float)k - 0.5f;
        memcpy(rook[j], sample[j * k + r->rook[j]], sizeof rook[j]);
        for (int c = 0; c < 4; c++) {
            const float extrapolated = centre[c] +
                                       dx * (bend.x[c] + dx * bend.xx[c] + dy * bend.xy[c]) +
                                       dy * (bend.y[c] + dy * bend.yy[c]);
            const float off = fabsf(rook[j][c] - extrapolated);
            most = off <= most ? most : off; /* NaN is kept */
        }
        if (rook[j][3] != centre[3]) return false;
    }
    const bool fine = r->scratch->texels[at[1]][at[0]] > WR_FINE;
    if (!(most <= (fine ? FINE_OFF : SAMPLE_OFF) * r->contrast)) return false;
    sum_pairs(rook, k);
    for (int c = 0; c < 4; c++) {
        rook[0][c] /= (float)k;
        if (!(fabsf(rook[0][c] - pixel[c]) <= r->contrast)) return false;
    }
    memcpy(pixel, rook[0], sizeof rook[0]);
    return true;
}

/* Replaces the pixel's sample count in the effect map by the last level's. */
static void map_samples(const WrRefiner *r, const unsigned char at[2], int k)
{
    if (!r->job->map) return;
    uint8_t *map = &r->job->map[wr_tile_place(r->job, r->part.x + at[0], r->part.y + at[1])];
    *map = (uint8_t)(*map % WR_MAP_SAMPLES | wr_tile_encode_samples(k));
}

static void finish_rooks(const WrRefiner *r, int first, int count)
{
    WrTileScratch *s = r->scratch;
    int side = 1;
    while (side * side < r->job->samples) side++;
    for (int n = 0; n < count; n++) {
        const unsigned char *at = s->list[first + n];
        if (s->open[at[1]][at[0]] != WR_OPEN || !rooks_agree(r, at, samples_of(r, n))) continue;
        s->open[at[1]][at[0]] = 0;
        map_samples(r, at, side);
    }
}

static void finish_all(const WrRefiner *r, int first, int count)
{
    WrTileScratch *s = r->scratch;
    const int k = r->job->samples;
    for (int n = 0; n < count; n++) {
        const unsigned char *at = s->list[first + n];
        if (!s->open[at[1]][at[0]]) continue;
        wr_tile_mean(samples_of(r, n)[0], k, 4 * (size_t)k,
                     wr_tile_pixel(r->job, r->part.x + at[0], r->part.y + at[1]));
        map_samples(r, at, k);
    }
}

/* Samples as many listed pixels at once as the buffer holds.
   The list goes through two rounds: K samples for pixels marked WR_OPEN, then the rest for all that are still
   open. */
static void sample_list(Batch *batch, int count)
{
    const WrRefiner *r = batch->r;
    const int room = WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H / (r->job->samples * r->job->samples);
    for (int first = 0; first < count; first += room) {
        const int some = count - first < room ? count - first : room;
        if (any_open(r, first, some, WR_OPEN, WR_OPEN)) {
            sample_pixels(batch, queue_rooks, first, some);
            finish_rooks(r, first, some);
        }
        if (any_open(r, first, some, WR_OPEN, WR_OPEN_ALL))
            sample_pixels(batch, queue_rest, first, some);
        finish_all(r, first, some);
    }
}

/* Lists the open pixels of a part of the tile; the part shrinks to their bounding box. */
static int list_open(const WrRefiner *r, WrTilePart *part)
{
    WrTileScratch *s = r->scratch;
    int count = 0, x0 = WR_REFINE_W, x1 = 0, y0 = WR_REFINE_H, y1 = 0;
    for (int y = part->y; y < part->y + part->h; y++)
        for (int x = part->x; x < part->x + part->w; x++) {
            if (!s->open[y][x]) continue;
            s->list[count][0] = (unsigned char)x;
            s->list[count++][1] = (unsigned char)y;
            x0 = x < x0 ? x : x0, x1 = x >= x1 ? x + 1 : x1;
            y0 = y < y0 ? y : y0, y1 = y + 1;
        }
    *part = (WrTilePart){ x0, y0, x1 - x0, y1 - y0 };
    return count;
}

/* True if samples need a depth tile, or positions of their own tile. */
static bool is_tiled(const WrRefiner *r)
{
    bool tiled = r->count > 1;
    for (int i = 0; i < r->count; i++)
        tiled |= r->objects[i]->mesh || r->objects[i]->triangles ||
                 r->job->plan->spread == WR_SPREAD_JITTERED;
    return tiled;
}

static void sample_part(const WrRefiner *r, WrTilePart part, bool tiled)
{
    const int count = list_open(r, &part);
    Batch batch = { .r = r, .part = part, .tiled = tiled };
    const WrTilePart on = { r->part.x + part.x, r->part.y + part.y, part.w, part.h };
    if (count == 0) return;
    for (int i = 0; i < r->count; i++)
        if (r->count == 1 || wr_refine_touches(r->objects[i], on))
            batch.objects[batch.count++] = r->objects[i];
    if (batch.count == 0) batch.objects[batch.count++] = r->objects[0];
    sample_list(&batch, count);
}

/* In parts, where samples need a depth tile. */
static void refine_more(const WrRefiner *r)
{
    const int k = r->job->samples;
    const bool tiled = is_tiled(r);
    const int most_w = tiled ? WR_TILE_SAMPLES_W / 2 / k : r->part.w;
    const int most_h = tiled ? WR_TILE_SAMPLES_H / k : r->part.h;
    for (int y = 0; y < r->part.h; y += most_h)
        for (int x = 0; x < r->part.w; x += most_w) {
            WrTilePart part = { x, y, most_w, most_h };
            part.w = r->part.w - x < part.w ? r->part.w - x : part.w;
            part.h = r->part.h - y < part.h ? r->part.h - y : part.h;
            sample_part(r, part, tiled);
        }
}

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

/* Texels per pixel along u and v, of the table or of the pictures, whichever are finer; 0: nothing is fetched.
   Derivatives of (u, v) per pixel times these numbers are texels per pixel; normal maps and pictures count
   like the table. */
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
   does not depend on the division into tiles.
   A pixel's decision uses the 5 x 5 first samples around it. */
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

/* Opens the pixels around a point of the picture, given in 1/256 samples. Corners of the object (tips) lie between
   samples; near them neither the neighbours nor one sample show it. */
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

/* Decides a pixel: 0: the prediction suffices; WR_OPEN: try K samples; WR_OPEN_ALL: take K x K.
   finest: even K samples a side skip texels then, and all K x K are taken. */
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
   of jittered samples.
   With light f and second difference D the mean over the pixel is f + D / 24; over a regular k x k grid f + (1
   - 1/k^2) D / 24. */
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
static double timed_elsewhere(const WrTileScratch *scratch)
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
    const double start = wr_clock_seconds(), before = timed_elsewhere(s);
    const int64_t covered = s->covered;
    wr_did(s, WR_EFFECT_SAMPLES);
    make_rules(r, jobs, count, !r->by_bound && refine_rooks(r));
    if (!r->by_bound || wr_plan_runs(plan, WR_EFFECT_BOUND)) {
        first_samples(r);
        if (r->by_bound) open_by_bound(r);
        else open_by_contrast(r);
        for (int i = 0; i < count && !r->by_bound; i++) open_tips(r, &jobs[i]);
    } else { /* no bound is known in this scene: K x K everywhere */
        memset(s->open, WR_OPEN_ALL, sizeof s->open);
    }
    refine_more(r);
    count_covered(r, covered);
    s->whole[WR_STAGE_RESOLVE] += wr_clock_seconds() - start - (timed_elsewhere(s) - before);
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
