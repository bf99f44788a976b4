/* Adaptive sampling: one sample at each pixel's centre, then 2 x 2, 4 x 4, ... K x K where they are called
   for (dials.h, WrRefine). A pixel that comes to K x K holds what `supersample` makes of it, bit for bit. */
#include "render/pipe.h"
#include "base/clock.h"

#include <math.h>
#include <string.h>

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
    for (int y = y0; y < y1; y++) {
        const int at_y = y - r->part.y + 1, at_x = x0 - r->part.x + 1;
        WrSink sink = { .rgba = s->centre[at_y][at_x] };
        for (int x = 0; x < WR_REFINE_W + 2; x++) s->bound[at_y][x] = INFINITY;
        if (r->by_bound) sink.bound = &s->bound[at_y][at_x], sink.pixel = 1;
        job->pipe->row(job, 1, &tile, y - y0, &sink, s);
    }
}

static bool apart(const float a[4], const float b[4], float contrast)
{
    bool far = false;
    for (int c = 0; c < 4; c++) far |= !(fabsf(a[c] - b[c]) <= contrast);
    return far;
}

/* Does the pixel differ from one of its eight neighbours? */
static bool stands_out(const Refiner *r, int x, int y)
{
    const WrTileScratch *s = r->scratch;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            int px = r->part.x + x + dx, py = r->part.y + y + dy;
            if (px < 0 || py < 0 || px >= r->job->width || py >= r->job->height) continue;
            if (apart(s->centre[y + 1][x + 1], s->centre[y + 1 + dy][x + 1 + dx], r->contrast))
                return true;
        }
    return false;
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
    if (wr_surfaces[r->job->scene->shape.kind]->inversion == WR_INVERT_SPHERE)
        return misses_ball(view, rays, gx, gy);
    for (int i = 0; i < view->quad_count; i++)
        if (!misses_quad(view, rays, &view->quads_d[i], gx, gy)) return false;
    return true;
}

/* ---- more samples -------------------------------------------------------------------------------- */

/* Do neighbouring samples of the k x k differ, or any from the first (k = 2)? */
static bool rough(const Refiner *r, const float *sample, int k, size_t step, const float first[4])
{
    for (int y = 0; y < k; y++)
        for (int x = 0; x < k; x++) {
            const float *at = sample + (size_t)y * step + 4 * (size_t)x;
            if (x + 1 < k && apart(at, at + 4, r->contrast)) return true;
            if (y + 1 < k && apart(at, at + step, r->contrast)) return true;
            if (k == 2 && apart(at, first, r->contrast)) return true;
        }
    return false;
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
    queue->r->job->pipe->points(queue->r->job, k, queue->tile, &sink, s);
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
            float *sample = s->sample[y * k][x * k];
            *open = !last && rough(r, sample, k, step, s->centre[part.y + y + 1][part.x + x + 1]);
            size_t px = (size_t)(r->part.x + part.x + x), py = (size_t)(r->part.y + part.y + y);
            wr_tile_mean(sample, k, step, r->job->rgba + (py * (size_t)r->job->width + px) * 4);
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

/* Which pixels the first samples leave open. */
static bool open_pixels(Refiner *r)
{
    WrTileScratch *s = r->scratch;
    bool any = false;
    for (int y = 0; y < r->part.h; y++)
        for (int x = 0; x < r->part.w; x++) {
            bool open;
            if (!r->by_bound) open = stands_out(r, x, y);
            else if (s->centre[y + 1][x + 1][3] > 0.0f)
                open = !(s->bound[y + 1][x + 1] <= r->contrast);
            else open = !r->job->plan->bounded || !surely_empty(r, x, y);
            s->open[y][x] = open;
            any |= open;
            size_t at = (size_t)(r->part.y + y) * (size_t)r->job->width + (size_t)(r->part.x + x);
            memcpy(r->job->rgba + 4 * at, s->centre[y + 1][x + 1], 4 * sizeof(float));
        }
    return any && r->job->samples > 1;
}

void wr_refine_tile(const WrTileJob *job, int x, int y, int w, int h, WrTileScratch *scratch)
{
    const WrDials *dials = job->dials;
    Refiner r = {
        job, scratch, { x, y, w, h }, (float)dials->contrast, dials->refine == WR_REFINE_BOUND
    };
    const int64_t covered = scratch->covered;
    const int K = job->samples;
    if (!r.by_bound || job->plan->bounded) {
        first_samples(&r);
        double start = wr_clock_seconds();
        bool more = open_pixels(&r);
        scratch->seconds[WR_STAGE_RESOLVE] += wr_clock_seconds() - start;
        if (!r.by_bound)
            for (int k = 2; k < K && more; k *= 2) sample_level(&r, k, false);
        if (more) sample_level(&r, K, true);
    } else { /* no bound is known in this scene: K x K everywhere */
        memset(scratch->open, 1, sizeof scratch->open);
        sample_level(&r, K, true);
    }
    scratch->covered = covered;
    for (int j = y; j < y + h; j++)
        for (int i = x; i < x + w; i++)
            scratch->covered += job->rgba[4 * ((size_t)j * (size_t)job->width + (size_t)i) + 3] > 0;
}
