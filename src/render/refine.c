/* Adaptive sampling (dials.h, WrRefine). By contrast: one sample a pixel; where light bends evenly the pixel follows
   from that and its neighbours (kern_smooth_body.h); elsewhere K of the K x K, which are all wherever those do not
   agree with what the neighbours told. By bound: one sample, or all. A pixel that comes to K x K holds what
   `supersample` makes of it, bit for bit; none depends on how the picture is cut into tiles. */
#include "render/pipe.h"
#include "render/outline.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define RING WR_REFINE_RING
#define MOST WR_TILE_SAMPLES_H /* K at most */
/* The K samples may each be off what the neighbours tell by so many times `contrast`, their mean by that. */
#define SAMPLE_OFF 4.0f
/* Of pixels with more texels than that along them the neighbours say little: K samples are taken, which have to agree better. */
#define FINE 2.0f
#define FINE_OFF 1.5f
#define EDGES_ALONE                                                                                \
    0.02f /* a `contrast` of as much is for pictures in a hurry: there they are believed */
/* Where coverage differs one sample is off by more than any contrast (kern_smooth_body.h). */
#define OUTLINE 1e6f
/* The mean of one place anywhere in each of K x K cells is off by about 0.29 / K^2 of the slope; four times that. */
#define JITTER 1.16

enum { OPEN = 1, OPEN_ALL = 2 }; /* a pixel needs more; all */

typedef struct Refiner {
    const WrTileJob *job;
    WrTileScratch *scratch;
    WrTilePart part;
    float contrast;
    bool by_bound;
    bool some;                /* K of the samples are tried before all */
    float texels[2];          /* along u and v, of what is looked up */
    unsigned char rook[MOST]; /* the column of the one in each row */
} Refiner;

/* Texels along u and v, of the table or of the colour picture, whichever are finer; 0: none is looked up. */
static void count_texels(const WrTileJob *job, float texels[2])
{
    const bool colour = wr_plan_calls(job->plan, WR_EFFECT_COLOUR);
    const bool table =
        wr_plan_calls(job->plan, WR_EFFECT_BUMP) && job->plan->source == WR_SOURCE_TABLE;
    const double w = table ? fabs(job->look.ru) * job->look.width : 0;
    const double h = table ? fabs(job->look.rv) * job->look.height : 0;
    const double cw = colour ? fabs(job->colour.ru) * job->colour.width : 0;
    const double ch = colour ? fabs(job->colour.rv) * job->colour.height : 0;
    const bool map = wr_plan_calls(job->plan, WR_EFFECT_NORMALS);
    const double mw = map ? fabs(job->relief.ru) * job->relief.width : 0;
    const double mh = map ? fabs(job->relief.rv) * job->relief.height : 0;
    texels[0] = (float)fmax(mw, w > cw ? w : cw);
    texels[1] = (float)fmax(mh, h > ch ? h : ch);
}

/* ---- the first samples -------------------------------------------------------------------------- */

/* One sample a pixel, with a ring of two pixels round the tile, also beyond the picture: so what is refined does not
   depend on how the picture is cut into tiles. */
static void first_samples(Refiner *r)
{
    WrTileScratch *s = r->scratch;
    const WrTileJob *job = r->job;
    const WrTilePart *p = &r->part;
    const int ring = r->by_bound ? 0 : RING;
    WrDepthTile tile =
        wr_tile_depth(job, 1, p->x - ring, p->y - ring, p->w + 2 * ring, p->h + 2 * ring, s);
    const double start = wr_clock_seconds();
    for (int y = 0; y < tile.h; y++) {
        float(*row)[4] = s->centre[y + RING - ring] + (RING - ring);
        memset(row, 0, (size_t)tile.w * sizeof *row);
        WrSink sink = { .rgba = row[0] };
        if (r->by_bound) {
            for (int x = 0; x < p->w; x++) s->bound[y][x] = INFINITY;
            sink.bound = s->bound[y], sink.pixel = 1;
        } else if (r->texels[0] > 0 || r->texels[1] > 0) {
            sink.uv = s->uv[y][0];
            memset(sink.uv, 0, (size_t)tile.w * sizeof s->uv[0][0]);
        }
        job->pipe->row(job, 1, &tile, y, &sink, s);
    }
    s->all_strips += wr_clock_seconds() - start;
}

/* ---- which pixels need more ---------------------------------------------------------------------- */

static void open_by_bound(const Refiner *r)
{
    WrTileScratch *s = r->scratch;
    for (int y = 0; y < r->part.h; y++) {
        const float(*row)[4] = (const float(*)[4])s->centre[y + RING] + RING;
        for (int x = 0; x < r->part.w; x++) {
            const bool closed = row[x][3] > 0.0f
                                    ? s->bound[y][x] <= r->contrast
                                    : wr_outline_misses(r->job, r->part.x + x, r->part.y + y);
            s->open[y][x] = closed ? 0 : OPEN_ALL;
        }
        memcpy(wr_tile_pixel(r->job, r->part.x, r->part.y + y), row,
               (size_t)r->part.w * sizeof *row);
    }
}

/* Has the light steps where texels meet, and not only bends (kern_smooth_body.h)? */
static bool slopes_jump(const WrPlan *plan)
{
    return plan->source == WR_SOURCE_TABLE &&
           wr_plan_calls(plan, WR_EFFECT_BUMP) && /* forced, it has no slopes */
           (plan->scheme == WR_SCHEME_NEAREST || plan->scheme == WR_SCHEME_BILINEAR);
}

/* The pixels about a point of the picture, in 1/256 samples. */
static void open_about(const Refiner *r, const WrRasterVertex *point)
{
    const double per = 256.0 * r->job->samples;
    const double px = floor(point->x / per) - r->part.x, py = floor(point->y / per) - r->part.y;
    for (int k = 0; k < 9; k++) {
        const double x = px + k % 3 - 1, y = py + k / 3 - 1;
        if (x >= 0 && y >= 0 && x < r->part.w && y < r->part.h)
            r->scratch->open[(int)y][(int)x] = OPEN_ALL;
    }
}

static void open_tips(const Refiner *r)
{
    WrRasterVertex tips[WR_OUTLINE_TIPS];
    const int count = wr_outline_tips(r->job, tips);
    for (int k = 0; k < count; k++) open_about(r, &tips[k]);
}

static void open_by_contrast(const Refiner *r)
{
    WrTileScratch *s = r->scratch;
    const float cells = (float)(r->job->samples * r->job->samples);
    const bool jittered = r->job->plan->spread == WR_SPREAD_JITTERED;
    const float weight = (jittered ? 1.0f : 1.0f - 1.0f / cells) / 24.0f;
    const float slope = jittered ? (float)JITTER / 2 / cells : 0;
    const float most = slopes_jump(r->job->plan) ? r->contrast / 2 : r->contrast;
    const float finest =
        FINE * sqrtf((float)r->job->samples); /* K samples are about so much nearer */
    for (int y = 0; y < r->part.h; y++) {
        const float *rows[5], *uv[3];
        for (int k = 0; k < 5; k++) rows[k] = s->centre[y + k][0];
        for (int k = 0; k < 3; k++) uv[k] = s->uv[y + RING - 1 + k][RING - 1];
        if (r->texels[0] > 0 || r->texels[1] > 0)
            r->job->kernels->texels(uv, r->part.w, r->texels, s->texels[y]);
        else memset(s->texels[y], 0, (size_t)r->part.w * sizeof s->texels[y][0]);
        r->job->kernels->smooth(rows, r->part.w, weight, slope,
                                wr_tile_pixel(r->job, r->part.x, r->part.y + y), s->bound[y]);
        for (int x = 0; x < r->part.w; x++) {
            const float off = s->bound[y][x];
            const float fine = s->texels[y][x];
            const bool all = !r->some || off > OUTLINE || fine > finest;
            s->open[y][x] = off <= most && fine <= FINE ? 0 : all ? OPEN_ALL : OPEN;
        }
    }
}

/* ---- more samples -------------------------------------------------------------------------------- */

/* For K = 4, 8, 12, ...: one place in each row and column, such that a quarter turn keeps them: their mean is that of
   all K x K of whatever bends evenly. */
static bool place_rooks(Refiner *r)
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

/* Samples that wait for a full strip, and where they go. */
typedef struct Queue {
    const Refiner *r;
    const WrDepthTile *tile;
    float (*to[WR_SPAN])[4];
} Queue;

static void empty_queue(Queue *queue)
{
    WrTileScratch *s = queue->r->scratch;
    const WrTileJob *job = queue->r->job;
    float line[WR_SPAN][4];
    const int count = s->scatter.count;
    if (count == 0) return;
    memset(line, 0, (size_t)count * sizeof line[0]);
    WrSink sink = { .rgba = line[0] };
    const double start = wr_clock_seconds();
    job->pipe->points(job, job->samples, queue->tile, &sink, s);
    s->all_strips += wr_clock_seconds() - start;
    for (int i = 0; i < count; i++) memcpy(queue->to[i], line[i], sizeof line[i]);
    s->scatter.count = 0;
}

/* Sample (i, j) of the tile's pixel (x, y). */
static void queue_sample(Queue *queue, const unsigned char at[2], int i, int j, float (*to)[4])
{
    const Refiner *r = queue->r;
    const WrDepthTile *tile = queue->tile;
    WrScatter *places = &r->scratch->scatter;
    const int k = r->job->samples, n = places->count;
    const int x = (r->part.x + at[0]) * k + i, y = (r->part.y + at[1]) * k + j;
    const int cell = (y - tile->y) * tile->w + x - tile->x;
    const signed char *shift = tile->shift ? tile->shift + 2 * cell : NULL;
    places->x[n] = x + (shift ? shift[0] / 256.0 : 0);
    places->y[n] = y + (shift ? shift[1] / 256.0 : 0);
    places->cell[n] = cell;
    queue->to[n] = to;
    if (++places->count == WR_SPAN) empty_queue(queue);
}

/* The samples of `count` pixels of the list, K x K each, one pixel's after the other. */
static float (*samples_of(const Refiner *r, int at))[4]
{
    const int k = r->job->samples;
    return &r->scratch->sample[0][0] + (size_t)at * (size_t)(k * k);
}

static void sample_rooks(const Refiner *r, const WrDepthTile *tile, int first, int count)
{
    Queue queue = { .r = r, .tile = tile };
    const int k = r->job->samples;
    r->scratch->scatter.count = 0;
    for (int n = 0; n < count; n++)
        for (int j = 0; j < k; j++)
            queue_sample(&queue, r->scratch->list[first + n], r->rook[j], j,
                         samples_of(r, n) + j * k + r->rook[j]);
    empty_queue(&queue);
}

/* All, or those that are none of the K; of pixels that are open still. */
static void sample_rest(const Refiner *r, const WrDepthTile *tile, int first, int count)
{
    Queue queue = { .r = r, .tile = tile };
    const WrTileScratch *s = r->scratch;
    const int k = r->job->samples;
    r->scratch->scatter.count = 0;
    for (int n = 0; n < count; n++) {
        const unsigned char *at = s->list[first + n];
        if (!s->open[at[1]][at[0]]) continue;
        for (int j = 0; j < k; j++)
            for (int i = 0; i < k; i++)
                if (!r->some || i != r->rook[j])
                    queue_sample(&queue, at, i, j, samples_of(r, n) + j * k + i);
    }
    empty_queue(&queue);
}

/* The sum of count colours, in pairs, into the first; they are overwritten. */
static void sum_pairs(float (*x)[4], int count)
{
    for (; count > 1; count = (count + 1) / 2) {
        for (int i = 0; i < count / 2; i++)
            for (int c = 0; c < 4; c++) x[i][c] = x[2 * i][c] + x[2 * i + 1][c];
        if (count & 1) memcpy(x[count / 2], x[count - 1], sizeof *x);
    }
}

/* What the neighbours tell of light about a pixel's centre. */
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

/* Is the mean of the K samples enough? Then it is the pixel's. */
static bool rooks_agree(const Refiner *r, const unsigned char at[2], float (*sample)[4])
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
            most = off <= most ? most : off; /* what is no number stays */
        }
        if (rook[j][3] != centre[3]) return false;
    }
    const bool fine = r->scratch->texels[at[1]][at[0]] > FINE;
    if (!(most <= (fine ? FINE_OFF : SAMPLE_OFF) * r->contrast)) return false;
    sum_pairs(rook, k);
    for (int c = 0; c < 4; c++) {
        rook[0][c] /= (float)k;
        if (!(fabsf(rook[0][c] - pixel[c]) <= r->contrast)) return false;
    }
    memcpy(pixel, rook[0], sizeof rook[0]);
    return true;
}

/* The last level's number in the place of the one before. */
static void map_samples(const Refiner *r, const unsigned char at[2], int k)
{
    if (!r->job->map) return;
    uint8_t *map = &r->job->map[wr_tile_place(r->job, r->part.x + at[0], r->part.y + at[1])];
    *map = (uint8_t)(*map % WR_MAP_SAMPLES | wr_tile_map_samples(k));
}

static void finish_rooks(const Refiner *r, int first, int count)
{
    WrTileScratch *s = r->scratch;
    int side = 1;
    while (side * side < r->job->samples) side++;
    for (int n = 0; n < count; n++) {
        const unsigned char *at = s->list[first + n];
        if (s->open[at[1]][at[0]] == OPEN_ALL || !rooks_agree(r, at, samples_of(r, n))) continue;
        s->open[at[1]][at[0]] = 0;
        map_samples(r, at, side);
    }
}

static void finish_all(const Refiner *r, int first, int count)
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

/* As many pixels of the list at once as there is room for samples. */
static void sample_list(const Refiner *r, const WrDepthTile *tile, int count)
{
    const int room = WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H / (r->job->samples * r->job->samples);
    for (int first = 0; first < count; first += room) {
        const int some = count - first < room ? count - first : room;
        if (r->some) {
            sample_rooks(r, tile, first, some);
            finish_rooks(r, first, some);
        }
        sample_rest(r, tile, first, some);
        finish_all(r, first, some);
    }
}

/* The open pixels of a part of the tile into the list; the part becomes their box. */
static int list_open(const Refiner *r, WrTilePart *part)
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

static void sample_part(const Refiner *r, WrTilePart part)
{
    const int k = r->job->samples, count = list_open(r, &part);
    WrDepthTile tile = { 0 };
    if (count == 0) return;
    if (r->job->mesh || r->job->triangles || r->job->plan->spread == WR_SPREAD_JITTERED)
        tile = wr_tile_depth(r->job, k, (r->part.x + part.x) * k, (r->part.y + part.y) * k,
                             part.w * k, part.h * k, r->scratch);
    sample_list(r, &tile, count);
}

/* All open pixels; by parts, where samples have a depth tile. */
static void sample_open(const Refiner *r)
{
    const int k = r->job->samples;
    const bool tiled =
        r->job->mesh || r->job->triangles || r->job->plan->spread == WR_SPREAD_JITTERED;
    const int most_w = tiled ? WR_TILE_SAMPLES_W / 2 / k : r->part.w;
    const int most_h = tiled ? WR_TILE_SAMPLES_H / k : r->part.h;
    for (int y = 0; y < r->part.h; y += most_h)
        for (int x = 0; x < r->part.w; x += most_w) {
            WrTilePart part = { x, y, most_w, most_h };
            part.w = r->part.w - x < part.w ? r->part.w - x : part.w;
            part.h = r->part.h - y < part.h ? r->part.h - y : part.h;
            sample_part(r, part);
        }
}

/* What strips and rays took so far, which is told elsewhere. */
static double told_elsewhere(const WrTileScratch *scratch)
{
    return scratch->all_strips + scratch->whole[WR_STAGE_VISIBILITY];
}

void wr_refine_tile(const WrTileJob *job, int x, int y, int w, int h, WrTileScratch *scratch)
{
    const WrPlan *plan = job->plan;
    Refiner r = { .job = job,
                  .scratch = scratch,
                  .part = { x, y, w, h },
                  .contrast = (float)plan->contrast,
                  .by_bound = plan->refine == WR_REFINE_BOUND };
    const double start = wr_clock_seconds(), before = told_elsewhere(scratch);
    wr_did(scratch, WR_EFFECT_SAMPLES);
    const int64_t covered = scratch->covered;
    if (r.contrast < EDGES_ALONE) count_texels(job, r.texels);
    r.some = !r.by_bound && !slopes_jump(plan) && place_rooks(&r);
    if (!r.by_bound || wr_plan_runs(plan, WR_EFFECT_BOUND)) {
        first_samples(&r);
        if (r.by_bound) open_by_bound(&r);
        else open_by_contrast(&r), open_tips(&r);
    } else { /* no bound is known in this scene: K x K everywhere */
        memset(scratch->open, OPEN_ALL, sizeof scratch->open);
    }
    sample_open(&r);
    scratch->met = scratch->covered - covered;
    scratch->covered = covered;
    for (int j = y; j < y + h; j++)
        for (int i = x; i < x + w; i++) scratch->covered += wr_tile_pixel(job, i, j)[3] > 0;
    scratch->whole[WR_STAGE_RESOLVE] +=
        wr_clock_seconds() - start - (told_elsewhere(scratch) - before);
}
