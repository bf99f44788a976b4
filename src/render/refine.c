/* Adaptive sampling: one sample at each pixel's centre, then 2 x 2, 4 x 4, ... K x K where they are called
   for (dials.h, WrRefine). A pixel that comes to K x K holds what `supersample` makes of it, bit for bit. */
#include "render/pipe.h"
#include "base/vec.h"
#include "system/clock.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Of k x k samples that lie apart by d the mean is off by d / 2k at most, mostly by far less, and by what it moved from
   the level before: `contrast` lets as much pass as it moved, and so many times k of d. */
#define EDGE_STEPS 4
#define EDGE_BESIDE 8.0f
enum {
    OPEN = 1,
    OPEN_BESIDE = 2
}; /* a pixel needs more; at least 4 x 4, for an edge that may pass beside */

typedef struct Refiner {
    const WrTileJob *job;
    WrTileScratch *scratch;
    WrTilePart part;
    float contrast;
    bool by_bound;
} Refiner;

/* ---- the first samples -------------------------------------------------------------------------- */

/* One sample a pixel, a ring of one pixel round the tile included: so what is refined does not depend on
   how the picture is cut into tiles. */
static void first_samples(Refiner *r)
{
    WrTileScratch *s = r->scratch;
    const WrTileJob *job = r->job;
    const int ring = r->by_bound ? 0 : 1;
    int x0 = r->part.x - ring, y0 = r->part.y - ring;
    int x1 = r->part.x + r->part.w + ring, y1 = r->part.y + r->part.h + ring;
    x0 = x0 < 0 ? 0 : x0, y0 = y0 < 0 ? 0 : y0;
    x1 = x1 > job->width ? job->width : x1, y1 = y1 > job->height ? job->height : y1;
    WrDepthTile tile = wr_tile_depth(job, 1, x0, y0, x1 - x0, y1 - y0, s);
    memset(s->centre, 0, sizeof s->centre);
    const double start = wr_clock_seconds();
    for (int y = y0; y < y1; y++) {
        const int at_y = y - r->part.y + 1, at_x = x0 - r->part.x + 1;
        WrSink sink = { .rgba = s->centre[at_y][at_x] };
        for (int x = 0; x < WR_REFINE_W + 2; x++) s->bound[at_y][x] = INFINITY;
        if (r->by_bound) sink.bound = &s->bound[at_y][at_x], sink.pixel = 1;
        job->pipe->row(job, 1, &tile, y - y0, &sink, s);
    }
    s->all_strips += wr_clock_seconds() - start;
}

/* The largest difference of any channel; what is no number differs by infinity. */
static float apart(const float a[4], const float b[4])
{
    float most = 0;
    for (int c = 0; c < 4; c++) {
        const float d = fabsf(a[c] - b[c]);
        most = d <= most ? most : d <= FLT_MAX ? d : INFINITY;
    }
    return most;
}

/* An even slope has its mean in its middle: what counts is how far a pixel is from the mean of two opposite
   neighbours, twice that, so that an edge counts for its height. At the picture's border and where an outline
   passes, where nothing tells a slope from an edge: how far from either. */
static float bend(const float a[4], const float pixel[4], const float b[4])
{
    float middle[4];
    if (a[3] != pixel[3] || b[3] != pixel[3]) return fmaxf(apart(a, pixel), apart(b, pixel));
    for (int c = 0; c < 4; c++) middle[c] = 2 * pixel[c] - a[c];
    return apart(middle, b);
}

/* How far the pixel stands out from its eight neighbours. */
static float stands_out(const Refiner *r, int x, int y)
{
    static const int ways[4][2] = { { 1, 0 }, { 0, 1 }, { 1, 1 }, { 1, -1 } };
    const WrTileScratch *s = r->scratch;
    const float *pixel = s->centre[y + 1][x + 1];
    float most = 0;
    for (int way = 0; way < 4; way++) {
        const float *sides[2] = { NULL, NULL };
        for (int side = 0; side < 2; side++) {
            const int dx = side ? -ways[way][0] : ways[way][0];
            const int dy = side ? -ways[way][1] : ways[way][1];
            const int px = r->part.x + x + dx, py = r->part.y + y + dy;
            if (px < 0 || py < 0 || px >= r->job->width || py >= r->job->height) continue;
            sides[side] = s->centre[y + 1 + dy][x + 1 + dx];
        }
        if (sides[0] && sides[1]) most = fmaxf(most, bend(sides[0], pixel, sides[1]));
        else if (sides[0] || sides[1])
            most = fmaxf(most, apart(sides[0] ? sides[0] : sides[1], pixel));
    }
    return most;
}

/* ---- pixels that the object leaves out ----------------------------------------------------------- */

static WrVec3 sum3(const double a[3], const double b[3], double x, const double c[3], double y)
{
    return (WrVec3){ a[0] + x * b[0] + y * c[0], a[1] + x * b[1] + y * c[1],
                     a[2] + x * b[2] + y * c[2] };
}

/* A ray passes the ball farther off than rays of the pixel lie apart. */
static bool misses_ball(const WrView *view, const WrRaysd *rays, double x, double y)
{
    const double R = view->shape_d.value[0];
    WrVec3 d = sum3(rays->d0, rays->dx, x, rays->dy, y),
           q = sum3(rays->q0, rays->qx, x, rays->qy, y);
    double dd = v3_dot(d, d), m = v3_dot(q, d) / dd, near = -m;
    WrVec3 foot = v3_mad(q, d, near);
    const double zero[3] = { 0 };
    WrVec3 across =
        v3_mad(sum3(rays->qx, zero, 0, zero, 0), sum3(rays->dx, zero, 0, zero, 0), near);
    WrVec3 down = v3_mad(sum3(rays->qy, zero, 0, zero, 0), sum3(rays->dy, zero, 0, zero, 0), near);
    double slack = 0.51 * (v3_len(across) + v3_len(down));
    return v3_len(foot) - slack > R * (1 + 1e-5);
}

/* All four corners lie beyond the same edge of the quad, or none meets its plane in front. */
static bool misses_quad(const WrView *view, const WrRaysd *rays, const WrQuadd *quad, double x,
                        double y)
{
    int left = 0, right = 0, below = 0, above = 0, behind = 0;
    const double zero[3] = { 0 };
    WrVec3 o = sum3(quad->origin, zero, 0, zero, 0), n = sum3(quad->normal, zero, 0, zero, 0);
    double first = 0;
    (void)view;
    for (int k = 0; k < 4; k++) {
        double cx = x + (k & 1 ? 0.501 : -0.501), cy = y + (k & 2 ? 0.501 : -0.501);
        WrVec3 d = sum3(rays->d0, rays->dx, cx, rays->dy, cy);
        WrVec3 q = sum3(rays->q0, rays->qx, cx, rays->qy, cy);
        double dn = v3_dot(d, n);
        if (k == 0) first = dn;
        if (dn * first <= 0) return false; /* the horizon crosses the pixel */
        double s = v3_dot(v3_sub(o, q), n) / dn;
        WrVec3 p = v3_sub(v3_mad(q, d, s), o);
        double u = p.x * quad->eu[0] + p.y * quad->eu[1] + p.z * quad->eu[2];
        double v = p.x * quad->ev[0] + p.y * quad->ev[1] + p.z * quad->ev[2];
        left += u<-1e-6, right += u> 1 + 1e-6, below += v<-1e-6, above += v> 1 + 1e-6;
        behind += s <= rays->s_min;
    }
    if (behind > 0) return behind == 4;
    return left == 4 || right == 4 || below == 4 || above == 4;
}

/* Is a pixel whose centre shows nothing empty for certain? */
static bool surely_empty(const Refiner *r, int x, int y)
{
    const WrView *view = r->job->view;
    const WrRaysd *rays = &wr_view_grid(view, 1)->rays_d;
    double gx = r->part.x + x, gy = r->part.y + y;
    if (r->job->plan->inversion == WR_INVERT_SPHERE) return misses_ball(view, rays, gx, gy);
    for (int i = 0; i < view->quad_count; i++)
        if (!misses_quad(view, rays, &view->quads_d[i], gx, gy)) return false;
    return true;
}

/* ---- more samples -------------------------------------------------------------------------------- */

/* How far the k x k samples lie apart. */
static float range_of(const float *sample, int k, size_t step)
{
    float low[4], high[4];
    memcpy(low, sample, sizeof low);
    memcpy(high, sample, sizeof high);
    for (int y = 0; y < k; y++)
        for (int x = 0; x < k; x++)
            for (int c = 0; c < 4; c++) {
                const float at = sample[(size_t)y * step + 4 * (size_t)x + (size_t)c];
                if (!(at >= low[c])) low[c] = at;
                if (!(at <= high[c])) high[c] = at;
            }
    return apart(low, high);
}

/* One row of the k x k samples of pixel px of the part into the scatter. */
static void scatter_run(const WrDepthTile *tile, int k, int px, int row, WrScatter *out)
{
    for (int i = 0; i < k; i++) {
        const int cell = row * tile->w + px * k + i, at = out->count++;
        const signed char *shift = tile->shift ? tile->shift + 2 * cell : NULL;
        out->x[at] = tile->x + px * k + i + (shift ? shift[0] / 256.0 : 0);
        out->y[at] = tile->y + row + (shift ? shift[1] / 256.0 : 0);
        out->cell[at] = cell;
    }
}

/* Runs of k neighbouring samples that wait for a full strip. */
typedef struct Queue {
    const Refiner *r;
    const WrDepthTile *tile;
    int k, count;
    struct {
        int row, x; /* samples of the part */
    } run[WR_SPAN];
} Queue;

static void empty_queue(Queue *queue)
{
    WrTileScratch *s = queue->r->scratch;
    const int k = queue->k;
    float line[WR_SPAN][4];
    if (queue->count == 0) return;
    memset(line, 0, (size_t)s->scatter.count * sizeof line[0]);
    WrSink sink = { .rgba = line[0] };
    const double start = wr_clock_seconds();
    queue->r->job->pipe->points(queue->r->job, k, queue->tile, &sink, s);
    s->all_strips += wr_clock_seconds() - start;
    for (int i = 0; i < queue->count; i++)
        memcpy(s->sample[queue->run[i].row][queue->run[i].x], line[i * k],
               (size_t)k * sizeof line[0]);
    queue->count = s->scatter.count = 0;
}

/* The samples of all open pixels of the part. */
static void sample_rows(const Refiner *r, WrTilePart part, int k, const WrDepthTile *tile)
{
    WrTileScratch *s = r->scratch;
    Queue queue = { .r = r, .tile = tile, .k = k };
    s->scatter.count = 0;
    for (int row = 0; row < part.h * k; row++)
        for (int p = 0; p < part.w; p++) {
            if (!s->open[part.y + row / k][part.x + p]) continue;
            if (s->scatter.count + k > WR_SPAN) empty_queue(&queue);
            queue.run[queue.count].row = row;
            queue.run[queue.count++].x = p * k;
            scatter_run(tile, k, p, row, &s->scatter);
        }
    empty_queue(&queue);
}

/* The last level's number in the place of the one before. */
static void map_samples(const Refiner *r, int x, int y, int k)
{
    uint8_t *at = &r->job->map[wr_tile_place(r->job, r->part.x + x, r->part.y + y)];
    *at = (uint8_t)(*at % WR_MAP_SAMPLES | wr_tile_map_samples(k));
}

/* k x k samples for the open pixels of a part of the tile; those that need no more are closed. */
static void sample_part(Refiner *r, WrTilePart part, int k, bool last)
{
    WrTileScratch *s = r->scratch;
    const size_t step = sizeof s->sample[0] / sizeof(float);
    bool any = false;
    for (int y = 0; y < part.h; y++)
        for (int x = 0; x < part.w; x++) any |= s->open[part.y + y][part.x + x];
    if (!any) return;
    WrDepthTile tile = wr_tile_depth(r->job, k, (r->part.x + part.x) * k, (r->part.y + part.y) * k,
                                     part.w * k, part.h * k, s);
    sample_rows(r, part, k, &tile);
    for (int y = 0; y < part.h; y++)
        for (int x = 0; x < part.w; x++) {
            unsigned char *open = &s->open[part.y + y][part.x + x];
            if (!*open) continue;
            if (r->job->map) map_samples(r, part.x + x, part.y + y, k);
            float *sample = s->sample[y * k][x * k], mean[4];
            float *pixel = wr_tile_pixel(r->job, r->part.x + part.x + x, r->part.y + part.y + y);
            const float range = last ? 0 : range_of(sample, k, step);
            wr_tile_mean(sample, k, step, mean); /* spoils the samples */
            const bool more = (*open == OPEN_BESIDE && k == 2) ||
                              apart(pixel, mean) > r->contrast ||
                              range > (float)(EDGE_STEPS * k) * r->contrast;
            *open = !last && more ? *open : 0;
            memcpy(pixel, mean, sizeof mean);
        }
}

static void sample_level(Refiner *r, int k, bool last)
{
    const int most_w = WR_TILE_SAMPLES_W / k, most_h = k < 32 ? 32 / k : 1;
    for (int y = 0; y < r->part.h; y += most_h)
        for (int x = 0; x < r->part.w; x += most_w) {
            WrTilePart part = { x, y, most_w, most_h };
            part.w = r->part.w - x < part.w ? r->part.w - x : part.w;
            part.h = r->part.h - y < part.h ? r->part.h - y : part.h;
            sample_part(r, part, k, last);
        }
}

/* By how far a pixel stands out. An edge's pixels stand out by its height; it may cut an eighth of one that the 2 x 2
   samples do not see. */
static unsigned char how_open(const Refiner *r, float out)
{
    return out > EDGE_BESIDE * r->contrast ? OPEN_BESIDE : out > r->contrast ? OPEN : 0;
}

/* Which pixels the first samples leave open. */
static bool open_pixels(Refiner *r)
{
    WrTileScratch *s = r->scratch;
    bool any = false;
    for (int y = 0; y < r->part.h; y++)
        for (int x = 0; x < r->part.w; x++) {
            unsigned char open;
            if (!r->by_bound) open = how_open(r, stands_out(r, x, y));
            else if (s->centre[y + 1][x + 1][3] > 0.0f)
                open = !(s->bound[y + 1][x + 1] <= r->contrast);
            else open = !surely_empty(r, x, y);
            s->open[y][x] = open;
            any |= open;
            memcpy(wr_tile_pixel(r->job, r->part.x + x, r->part.y + y), s->centre[y + 1][x + 1],
                   4 * sizeof(float));
        }
    return any && r->job->samples > 1;
}

/* What strips and rays took so far, which is told elsewhere. */
static double told_elsewhere(const WrTileScratch *scratch)
{
    return scratch->all_strips + scratch->whole[WR_STAGE_VISIBILITY];
}

void wr_refine_tile(const WrTileJob *job, int x, int y, int w, int h, WrTileScratch *scratch)
{
    const WrPlan *plan = job->plan;
    Refiner r = {
        job, scratch, { x, y, w, h }, (float)plan->contrast, plan->refine == WR_REFINE_BOUND
    };
    const double start = wr_clock_seconds(), before = told_elsewhere(scratch);
    wr_did(scratch, WR_EFFECT_SAMPLES);
    const int64_t covered = scratch->covered;
    const int K = job->samples;
    if (!r.by_bound || wr_plan_runs(plan, WR_EFFECT_BOUND)) {
        first_samples(&r);
        const bool more = open_pixels(&r);
        if (!r.by_bound)
            for (int k = 2; k < K && more; k *= 2) sample_level(&r, k, false);
        if (more) sample_level(&r, K, true);
    } else { /* no bound is known in this scene: K x K everywhere */
        memset(scratch->open, 1, sizeof scratch->open);
        sample_level(&r, K, true);
    }
    scratch->covered = covered;
    for (int j = y; j < y + h; j++)
        for (int i = x; i < x + w; i++) scratch->covered += wr_tile_pixel(job, i, j)[3] > 0;
    scratch->whole[WR_STAGE_RESOLVE] +=
        wr_clock_seconds() - start - (told_elsewhere(scratch) - before);
}
