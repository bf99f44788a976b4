#include "render/visibility/sparse_hits_internal.h"

#include "base/memory.h"
#include "base/pool.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define BEND 0.25f /* largest ratio of third differences of hits to first ones */
/* largest ratio of fourth differences: the error is 3/128 of 8 samples times that, along each axis */
#define EVEN 0.02f
#define SPARE 16 /* padding that vector loads read past the end */

void wr_sparse_hits_fini(WrSparseHits *knots)
{
    wr_free(knots->numbers);
    wr_free(knots->even);
    wr_free(knots->count);
    wr_free(knots->crossed);
    wr_free(knots->place);
    wr_free(knots->shown);
    *knots = (WrSparseHits){ 0 };
}

/* Allocates cleared memory of that size. */
static bool make_room(WrSparseHits *knots, int across, int down, int blocks)
{
    const size_t all = (size_t)across * (size_t)down;
    if (!knots->numbers || knots->across != across || knots->down != down ||
        knots->blocks != blocks) {
        wr_sparse_hits_fini(knots);
        knots->numbers =
            wr_try_alloc(WR_KNOT_NUMBERS * all + SPARE, sizeof *knots->numbers, "knots", NULL);
        knots->even = wr_try_alloc(all, 1, "knots", NULL);
        knots->count = wr_try_alloc(all, 1, "knots", NULL);
        knots->crossed = wr_try_alloc(all, 1, "knots", NULL);
        knots->place = wr_try_alloc(all, 1, "knots", NULL);
        knots->shown = wr_try_alloc((size_t)blocks, 1, "knots", NULL);
    }
    if (!knots->numbers || !knots->even || !knots->count || !knots->crossed || !knots->place ||
        !knots->shown)
        return false;
    knots->u = knots->numbers, knots->v = knots->numbers + all;
    memset(knots->numbers, 0, (WR_KNOT_NUMBERS * all + SPARE) * sizeof *knots->numbers);
    memset(knots->count, 0, all);
    memset(knots->crossed, 0, all);
    memset(knots->shown, 0, (size_t)blocks);
    knots->across = across, knots->down = down, knots->blocks = blocks;
    return true;
}

/* ---- hits and blocks ---- */

static void solve_some(const WrSparseHitsJob *job, WrStrip *strip)
{
    const WrSparseHitsRequest *ask = job->ask;
    const WrView *view = job->view;
    if (strip->count == 0) return;
    WrNewton how = ask->newton;
    how.last *= 0.125f, how.steps++;
    if (ask->sheet) ask->wide->newton(ask->sheet, job->rays, &how, false, strip);
    else ask->kernels->polish[view->shape_d.kind](job->rays, &view->shape, &how, strip);
}

static void keep_numbers(WrSparseHits *knots, size_t row, const WrStrip *strip)
{
    const float *const from[WR_KNOT_NUMBERS] = { strip->u,   strip->v,   strip->px,  strip->py,
                                                 strip->pz,  strip->pux, strip->puy, strip->puz,
                                                 strip->pvx, strip->pvy, strip->pvz };
    const size_t plane = (size_t)knots->across * (size_t)knots->down;
    for (size_t k = 0; k < WR_KNOT_NUMBERS; k++)
        for (int i = 0; i < strip->count; i++)
            knots->numbers[k * plane + row + (size_t)strip->index[i]] = from[k][i];
}

/* Solves, by Newton's method, the hits that exactly one triangle covers. With several triangles the first one
   would depend on thread timing, so these have no position. */
static void solve_row(int y, int worker, void *ctx)
{
    const WrSparseHitsJob *job = ctx;
    WrSparseHits *knots = job->knots;
    WrStrip *strip = &job->strips[worker];
    const size_t row = (size_t)y * (size_t)knots->across;
    for (int x = 0; x < knots->across;) {
        for (strip->count = 0; x < knots->across && strip->count < WR_SPAN; x++) {
            const size_t at = row + (size_t)x;
            if (knots->count[at] != 1) {
                knots->u[at] = knots->v[at] = 0;
                continue;
            }
            strip->index[strip->count] = x;
            strip->x[strip->count] = (float)((x - WR_SPARSE_HITS_AROUND) * WR_KNOT);
            strip->y[strip->count] = (float)((y + knots->top) * WR_KNOT);
            strip->u[strip->count] = knots->u[at];
            strip->v[strip->count++] = knots->v[at];
        }
        solve_some(job, strip);
        keep_numbers(knots, row, strip);
    }
}

/* Difference from a to b; round 1: the shorter way on a circle, 0: on a line. Branch-free, so that rows
   vectorise. */
static inline float way(float a, float b, float round)
{
    const float d = b - a;
    return d + round * ((float)(d < -0.5f) - (float)(d > 0.5f));
}

/* Flag of the block at a hit, besides evenness_both's bits: it shows one sheet. */
#define SINGLE 16

/* Test of five hits: 1: four of them bend gently enough for a cubic to predict from; 2: all hardly bend. across:
   change of a step along the other axis. */
static inline int evenness(float k0, float k1, float k2, float k3, float k4, float across,
                           float round)
{
    const float a = way(k0, k1, round), b = way(k1, k2, round);
    const float c = way(k2, k3, round), d = way(k3, k4, round);
    const float by = fabsf(b) + fabsf(across), third = a - 2 * b + c, fourth = b - 2 * c + d;
    const float jump = round * (fabsf(k4 - k0) + fabsf(k2 - k1));
    const int gentle = fabsf(third) < BEND * by, even = fabsf(fourth - third) < EVEN * by;
    return gentle + 2 * (even & (jump < 0.5f));
}

/* Evenness of a parameter's hits along both axes: bits 0 and 1 along x, 2 and 3 along y. */
static inline int evenness_both(const float *const row[5], size_t x, float round)
{
    const float *r = row[0] + x, *below = row[1] + x;
    const int along = evenness(r[0], r[1], r[2], r[3], r[4], way(r[1], below[1], round), round);
    const int down = evenness(r[0], below[0], row[2][x], row[3][x], row[4][x],
                              way(below[0], below[1], round), round);
    return along + 4 * down;
}

/* Evenness of the hits to the right of each hit of a row, and of those below; undefined past the last. */
static void even_row(int y, int worker, void *ctx)
{
    (void)worker;
    const WrSparseHitsJob *job = ctx;
    WrSparseHits *k = job->knots;
    const size_t across = (size_t)k->across, start = (size_t)y * across;
    const unsigned char *restrict count = k->count + start, *restrict crossed = k->crossed + start;
    const float round_u = k->closed_u ? 1.0f : 0.0f, round_v = k->closed_v ? 1.0f : 0.0f;
    unsigned char *restrict even = k->even + start;
    const float *u[5], *v[5];
    for (int i = 0; i < 5; i++) {
        const size_t row = (size_t)(y + i < k->down ? y + i : k->down - 1) * across;
        u[i] = k->u + row, v[i] = k->v + row;
    }
#pragma omp simd
    for (size_t x = 0; x < across; x++) {
        const int own = evenness_both(u, x, round_u) & evenness_both(v, x, round_v);
        even[x] = (unsigned char)((count[x] == 1) * (own + SINGLE * (crossed[x] == 0)));
    }
}

/* True if all of four hits, `step` apart, are that even. */
static bool are_even(const unsigned char *even, size_t step, int bit)
{
    return even[0] & even[step] & even[2 * step] & even[3 * step] & bit;
}

/* True if the 4 x 4 hits from there on can be interpolated. */
static bool is_smooth(const WrSparseHits *k, int x, int y)
{
    const size_t across = (size_t)k->across;
    const unsigned char *even = k->even + (size_t)y * across + (size_t)x;
    return are_even(even, across, 1) && are_even(even, 1, 4);
}

/* True if the 3 x 3 blocks from there on each show one sheet. */
static bool are_single(const WrSparseHits *k, int x, int y)
{
    const size_t across = (size_t)k->across;
    if (x < 0 || y < 0 || x + 3 >= k->across || y + 3 >= k->down) return false;
    const unsigned char *a = k->even + (size_t)y * across + (size_t)x, *b = a + across;
    const unsigned char *c = b + across;
    return a[0] & a[1] & a[2] & b[0] & b[1] & b[2] & c[0] & c[1] & c[2] & SINGLE;
}

static unsigned char place_of(const WrSparseHits *k, int x, int y)
{
    static const unsigned char shifts[] = { 4, 1, 3, 5, 7, 0, 2, 6, 8 };
    const size_t at = (size_t)y * (size_t)k->across + (size_t)x;
    if (k->crossed[at]) return WR_SPARSE_HITS_DEPTH;
    if (k->count[at] != 1) return k->count[at] ? WR_SPARSE_HITS_DEPTH : WR_SPARSE_HITS_NOTHING;
    for (int i = 0; i < 9; i++)
        if (are_single(k, x - shifts[i] % 3, y - shifts[i] / 3) &&
            is_smooth(k, x - shifts[i] % 3, y - shifts[i] / 3))
            return (unsigned char)(WR_SPARSE_HITS_BETWEEN + shifts[i]);
    return WR_SPARSE_HITS_DEPTH;
}

/* Finds the blocks of a row that are interpolated without solving: their 3 x 3 blocks show one sheet, and the 6
   x 6 hits around are even. */
static void find_sheet(const WrSparseHits *k, int y, unsigned char *restrict sheet)
{
    const size_t across = (size_t)k->across;
    const unsigned char *const e = k->even + (size_t)y * across;
    const unsigned char *restrict far = e - 2 * across, *restrict up = e - across;
    const unsigned char *restrict low = e + across, *restrict end = e + 2 * across;
#pragma omp simd
    for (size_t x = 2; x < across - 3; x++) {
        const int single = up[x - 1] & up[x] & up[x + 1] & e[x - 1] & e[x] & e[x + 1] & low[x - 1] &
                           low[x] & low[x + 1] & SINGLE;
        const int along = up[x - 2] & e[x - 2] & low[x - 2] & end[x - 2] & up[x - 1] & e[x - 1] &
                          low[x - 1] & end[x - 1] & 2;
        const int down = far[x - 1] & far[x] & far[x + 1] & far[x + 2] & up[x - 1] & up[x] &
                         up[x + 1] & up[x + 2] & 8;
        sheet[x] = (single | along | down) == (SINGLE | 2 | 8);
    }
}

static void place_row(int y, int worker, void *ctx)
{
    const WrSparseHitsJob *job = ctx;
    WrSparseHits *knots = job->knots;
    unsigned char *place = knots->place + (size_t)y * (size_t)knots->across;
    unsigned char *sheet = job->sheet + (size_t)worker * (size_t)knots->across;
    memset(sheet, 0, (size_t)knots->across);
    if (job->ask->sheet && knots->across > 7 && y > 1 && y + 3 < knots->down)
        find_sheet(knots, y, sheet);
    for (int x = 0; x < knots->across; x++)
        place[x] = sheet[x] ? WR_SPARSE_HITS_SHEET : place_of(knots, x, y);
}

static void fill_key(const WrViewMesh *mesh, const WrView *view, const WrSparseHitsRequest *ask,
                     WrSparseHitsKey *key)
{
    memset(key, 0, sizeof *key); /* clears padding as well: keys are compared as bytes */
    memcpy(&key->sight, &mesh->sight, sizeof key->sight);
    memcpy(&key->shape, &mesh->shape, sizeof key->shape);
    const WrNewton *how = &ask->newton;
    key->newton.reach_u = how->reach_u, key->newton.reach_v = how->reach_v;
    key->newton.enough_u = how->enough_u, key->newton.enough_v = how->enough_v;
    key->newton.uu = how->uu, key->newton.uv = how->uv, key->newton.vv = how->vv;
    key->newton.last = how->last, key->newton.steps = how->steps;
    key->newton.closed_u = how->closed_u, key->newton.closed_v = how->closed_v;
    key->mu = mesh->mu, key->mv = mesh->mv, key->grid_w = view->grid_w;
    key->first = ask->first, key->rows = ask->rows;
    key->cull = view->cull;
    key->kernels = ask->kernels;
}

/* Computes all hits. */
static bool tie(WrSparseHitsJob *job, WrPool *pool)
{
    WrSparseHits *knots = job->knots;
    if (!wr_pool_run(pool, job->mesh->blocks_v, wr_sparse_hits_meet_rows, job) || job->behind)
        return false;
    return wr_pool_run(pool, knots->down, solve_row, job) &&
           wr_pool_run(pool, knots->down, even_row, job) &&
           wr_pool_run(pool, knots->down, place_row, job);
}

bool wr_sparse_hits_update(WrSparseHits *knots, const WrViewMesh *mesh, const WrView *view,
                           const WrSparseHitsRequest *ask, WrPool *pool)
{
    WrSparseHitsKey key;
    fill_key(mesh, view, ask, &key);
    if (knots->known && memcmp(&knots->key, &key, sizeof key) == 0) return true;
    const int last = (ask->first + ask->rows - 1) / WR_KNOT + 1;
    knots->known = false;
    const int top = ask->first / WR_KNOT - WR_SPARSE_HITS_AROUND;
    if (!make_room(knots, (view->grid_w - 1) / WR_KNOT + 2 + 2 * WR_SPARSE_HITS_AROUND,
                   last + 1 + WR_SPARSE_HITS_AROUND - top, mesh->blocks_u * mesh->blocks_v))
        return false;
    knots->top = top;
    knots->closed_u = mesh->newton.closed_u, knots->closed_v = mesh->newton.closed_v;
    const size_t threads = (size_t)wr_pool_threads(pool);
    WrSparseHitsJob job = { .knots = knots,
                            .mesh = mesh,
                            .view = view,
                            .ask = ask,
                            .rays = &wr_view_grid(view, view->samples)->rays,
                            .step_u = 1.0f / (float)mesh->mu,
                            .mirrored = view->stretch[0] * view->stretch[1] * view->stretch[2] < 0,
                            .strips = wr_alloc(threads, sizeof(WrStrip)),
                            .sheet = wr_alloc(threads, (size_t)knots->across) };
    knots->known = tie(&job, pool);
    memcpy(&knots->key, &key, sizeof key);
    wr_free(job.strips);
    wr_free(job.sheet);
    return knots->known;
}
