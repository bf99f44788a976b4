/* Further samples for open pixels: K of the K x K, then the others where those are not enough (adaptive.c). */
#include "render/pipeline/pipeline.h"
#include "render/frame/adaptive_internal.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define RING WR_REFINE_RING
#define MOST WR_TILE_SAMPLES_H /* largest K */
/* Largest deviation of each of the K samples, and of their mean, from the neighbours' prediction, in multiples
   of `contrast`. */
#define SAMPLE_OFF 4.0f
#define FINE_OFF 1.5f /* as SAMPLE_OFF, for pixels with many texels */

/* ---- more samples -------------------------------------------------------------------------------- */

/* For K = 4, 8, 12, ...: one sample in each row and column, a set that a quarter turn maps to itself. For any
   quadratic function its mean equals that of all K x K samples. */
bool wr_refine_rooks(WrRefiner *r)
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

/* Samples of one object that wait for a full strip, and their destinations. */
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

static void bring_tile(Batch *batch, const WrTileJob *job)
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
        bring_tile(batch, job);
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

/* Linear and quadratic change of light around a pixel's centre, estimated from its neighbours. */
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

/* True if the mean of the K samples is accurate enough; it then becomes the pixel. */
static bool rooks_agree(const WrRefiner *r, const unsigned char at[2], float (*sample)[4])
{
    const int k = r->job->samples;
    const float *centre = r->scratch->centre[at[1] + RING][at[0] + RING];
    const Bend bend = bend_at(r->scratch, at[0], at[1]);
    float rook[MOST][4];
    float most = 0, *pixel = wr_tile_pixel(r->job, r->part.x + at[0], r->part.y + at[1]);
    for (int j = 0; j < k; j++) {
        const float dx = ((float)r->rook[j] + 0.5f) / (float)k - 0.5f;
        const float dy = ((float)j + 0.5f) / (float)k - 0.5f;
        memcpy(rook[j], sample[j * k + r->rook[j]], sizeof rook[j]);
        for (int c = 0; c < 4; c++) {
            const float told = centre[c] + dx * (bend.x[c] + dx * bend.xx[c] + dy * bend.xy[c]) +
                               dy * (bend.y[c] + dy * bend.yy[c]);
            const float off = fabsf(rook[j][c] - told);
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
    *map = (uint8_t)(*map % WR_MAP_SAMPLES | wr_tile_map_samples(k));
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

/* Samples as many listed pixels at once as the buffer holds. */
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
void wr_refine_more(const WrRefiner *r)
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
