#include "render/visibility/sparse_hits.h"

#include "base/memory.h"
#include "base/pool.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define WR_KNOT_STEP (WR_KNOT * 256) /* 1/256 samples from hit to hit */

typedef struct WrSparseHitsJob {
    WrSparseHits *knots;
    const WrViewMesh *mesh;
    const WrView *view;
    const WrSparseHitsRequest *ask;
    const WrRays *rays;
    bool mirrored;
    float step_u;         /* from vertex to vertex */
    WrStrip *strips;      /* [threads] */
    unsigned char *sheet; /* [threads][across] */
    int behind;           /* a vertex is behind the near plane */
} WrSparseHitsJob;

static inline int32_t wr_sparse_hits_floor(int32_t x)
{
    return x >= 0 ? x / WR_KNOT_STEP : -((-x + WR_KNOT_STEP - 1) / WR_KNOT_STEP);
}

static inline int wr_sparse_hits_clamped(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* The blocks that a rectangle of 1/256 samples overlaps, enlarged by one sample on each side. */
typedef struct WrSparseHitsBlocks {
    int x0, y0, x1, y1; /* x0 <= x <= x1, in rows of the hits' grid */
} WrSparseHitsBlocks;

static inline WrSparseHitsBlocks wr_sparse_hits_blocks(const WrSparseHits *knots, int32_t x0,
                                                       int32_t y0, int32_t x1, int32_t y1)
{
    return (WrSparseHitsBlocks){
        wr_sparse_hits_clamped(wr_sparse_hits_floor(x0 - 256) + WR_SPARSE_HITS_AROUND, 0,
                               knots->across),
        wr_sparse_hits_clamped(wr_sparse_hits_floor(y0 - 256) - knots->top, 0, knots->down),
        wr_sparse_hits_clamped(wr_sparse_hits_floor(x1 + 256) + WR_SPARSE_HITS_AROUND, -1,
                               knots->across - 1),
        wr_sparse_hits_clamped(wr_sparse_hits_floor(y1 + 256) - knots->top, -1, knots->down - 1)
    };
}

/* ---- cover ---- */

/* Coverage of sparse hits by triangles, and of blocks by edges at which the number of covering triangles can
   change. */

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static void cross_rectangle(WrSparseHits *knots, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const WrSparseHitsBlocks b = wr_sparse_hits_blocks(knots, x0, y0, x1, y1);
    for (int y = b.y0; y <= b.y1; y++)
        for (int x = b.x0; x <= b.x1; x++)
            __atomic_store_n(&knots->crossed[(size_t)y * (size_t)knots->across + (size_t)x], 1,
                             __ATOMIC_RELAXED);
}

/* Marks the blocks that the edge between two vertices crosses. */
static void cross_edge(const WrSparseHitsJob *job, size_t a, size_t b)
{
    const int32_t *x = job->mesh->sx, *y = job->mesh->sy;
    cross_rectangle(job->knots, least(x[a], x[b]), least(y[a], y[b]), most(x[a], x[b]),
                    most(y[a], y[b]));
}

/* Orientation of a drawn triangle: its side towards the viewer; 0: it is not drawn. */
static int side_of(const WrSparseHitsJob *job, size_t a, size_t b, size_t c)
{
    const int32_t *x = job->mesh->sx, *y = job->mesh->sy;
    const int64_t area = ((int64_t)x[b] - x[a]) * ((int64_t)y[c] - y[a]) -
                         ((int64_t)y[b] - y[a]) * ((int64_t)x[c] - x[a]);
    if (area == 0 || (job->view->cull && (area > 0) != job->mirrored)) return 0;
    return area > 0 ? 1 : -1;
}

/* A cell's corners in order: i, j; i + 1, j; both + 1; i, j + 1. */
typedef struct Cell {
    int64_t x[4], y[4]; /* 1/256 samples */
    int i, j;
} Cell;

static Cell cell_at(const WrViewMesh *mesh, int i, int j)
{
    const size_t at = (size_t)j * ((size_t)mesh->mu + 1) + (size_t)i, low = at + (size_t)mesh->mu;
    const int32_t *x = mesh->sx, *y = mesh->sy;
    return (Cell){ { x[at], x[at + 1], x[low + 2], x[low + 1] },
                   { y[at], y[at + 1], y[low + 2], y[low + 1] },
                   i,
                   j };
}

/* An edge function in whole numbers, as in raster.c. */
typedef struct Edge {
    int64_t dx, dy, at;
} Edge;

static inline Edge edge_of(const Cell *cell, int from, int to, int64_t x, int64_t y)
{
    const int64_t dx = cell->x[to] - cell->x[from], dy = cell->y[to] - cell->y[from];
    return (Edge){ dx, dy, dx * (y - cell->y[from]) - dy * (x - cell->x[from]) };
}

static inline Edge turned(Edge e)
{
    return (Edge){ -e.dx, -e.dy, -e.at };
}

/* True if the point is on the inner side, or on the edge itself if that is a top or left one. side: of the
   triangle. */
static inline bool within(Edge e, int side)
{
    if (side < 0) e = turned(e);
    return e.at > 0 || (e.at == 0 && (e.dy < 0 || (e.dy == 0 && e.dx < 0)));
}

/* Counts a further triangle that covers a hit and stores its interpolated u, v. Counts above two are equivalent
   to two. */
static void cover_knot(const WrSparseHitsJob *job, size_t at, const Cell *cell, const int of[3],
                       const int64_t share[3])
{
    const WrViewMesh *mesh = job->mesh;
    WrSparseHits *knots = job->knots;
    float w = 0, u = 0, v = 0;
    if (__atomic_load_n(&knots->count[at], __ATOMIC_RELAXED) > 1 ||
        __atomic_fetch_add(&knots->count[at], 1, __ATOMIC_RELAXED) != 0)
        return;
    for (int k = 0; k < 3; k++) {
        const int i = cell->i + (of[k] == 1 || of[k] == 2), j = cell->j + of[k] / 2;
        const size_t vertex = (size_t)j * ((size_t)mesh->mu + 1) + (size_t)i;
        const float own = (float)share[k] * (job->view->perspective ? mesh->close[vertex] : 1.0f);
        w += own, u += own * (float)i * job->step_u, v += own * mesh->v[j];
    }
    knots->u[at] = w != 0 ? u / w : 0;
    knots->v[at] = w != 0 ? v / w : 0;
}

static void meet_knot(const WrSparseHitsJob *job, const Cell *cell, int one, int two, int kx,
                      int ky)
{
    const WrSparseHits *knots = job->knots;
    static const int first[3] = { 0, 1, 2 }, second[3] = { 0, 2, 3 };
    const int64_t x = (int64_t)(kx - WR_SPARSE_HITS_AROUND) * WR_KNOT_STEP + 128;
    const int64_t y = (int64_t)(ky + knots->top) * WR_KNOT_STEP + 128;
    const size_t at = (size_t)ky * (size_t)knots->across + (size_t)kx;
    const Edge across = edge_of(cell, 0, 2, x, y), back = turned(across);
    const Edge a = edge_of(cell, 0, 1, x, y), b = edge_of(cell, 1, 2, x, y);
    const Edge c = edge_of(cell, 2, 3, x, y), d = edge_of(cell, 3, 0, x, y);
    if (one && within(a, one) && within(b, one) && within(back, one))
        cover_knot(job, at, cell, first, (const int64_t[3]){ b.at, back.at, a.at });
    if (two && within(across, two) && within(c, two) && within(d, two))
        cover_knot(job, at, cell, second, (const int64_t[3]){ c.at, d.at, across.at });
}

/* The first hit at x or beyond, for vertices in front of the eye and near the picture. */
static inline int knot_from(int64_t x)
{
    return (int)((uint32_t)(x + (1 << 28) - 129) / WR_KNOT_STEP) + 1 - (1 << 28) / WR_KNOT_STEP;
}

static inline int64_t lower(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static inline int64_t upper(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* Hits from..to - 1 between the least and the largest of four positions. */
static inline void knots_between(const int64_t at[4], int from, int end, int *first, int *to)
{
    const int64_t low = lower(lower(at[0], at[1]), lower(at[2], at[3]));
    const int64_t high = upper(upper(at[0], at[1]), upper(at[2], at[3]));
    *first = wr_sparse_hits_clamped(knot_from(low) + from, 0, end);
    *to = wr_sparse_hits_clamped(knot_from(high + 1) + from, 0, end);
}

static void cover_cell(const WrSparseHitsJob *job, int i, int j, int one, int two)
{
    const WrSparseHits *knots = job->knots;
    const Cell cell = cell_at(job->mesh, i, j);
    int x0, x1, y0, y1;
    knots_between(cell.x, WR_SPARSE_HITS_AROUND, knots->across, &x0, &x1);
    knots_between(cell.y, -knots->top, knots->down, &y0, &y1);
    for (int ky = y0; ky < y1; ky++)
        for (int kx = x0; kx < x1; kx++) meet_knot(job, &cell, one, two, kx, ky);
}

/* Orientations of a row's triangles. */
typedef struct Sides {
    signed char one[WR_MESH_MOST], two[WR_MESH_MOST];
} Sides;

/* Marks the mesh's block as visible. */
static void note_shown(const WrSparseHitsJob *job, int i, int j)
{
    const int block = j / WR_MESH_BLOCK * job->mesh->blocks_u + i / WR_MESH_BLOCK;
    __atomic_store_n(&job->knots->shown[block], 1, __ATOMIC_RELAXED);
}

/* A cell with a vertex outside the guard band has unknown orientations: 0 and 0. */
static void find_sides(WrSparseHitsJob *job, int j, Sides *sides)
{
    const WrViewMesh *mesh = job->mesh;
    const size_t pitch = (size_t)mesh->mu + 1;
    for (int i = 0; i < mesh->mu; i++) {
        const size_t a = (size_t)j * pitch + (size_t)i, c = a + pitch;
        const unsigned char *o = mesh->out;
        sides->one[i] = sides->two[i] = 0;
        if (!(o[a] | o[a + 1] | o[c] | o[c + 1])) {
            sides->one[i] = (signed char)side_of(job, a, a + 1, c + 1);
            sides->two[i] = (signed char)side_of(job, a, c + 1, c);
            continue;
        }
        const int behind = (o[a] == WR_VERTEX_BEHIND) + (o[a + 1] == WR_VERTEX_BEHIND) +
                           (o[c] == WR_VERTEX_BEHIND) + (o[c + 1] == WR_VERTEX_BEHIND);
        if (behind > 0 && behind < 4) __atomic_store_n(&job->behind, 1, __ATOMIC_RELAXED);
        if (behind > 0) continue;
        const int32_t *x = mesh->sx, *y = mesh->sy;
        note_shown(job, i, j);
        cross_rectangle(job->knots, least(least(x[a], x[a + 1]), least(x[c], x[c + 1])),
                        least(least(y[a], y[a + 1]), least(y[c], y[c + 1])),
                        most(most(x[a], x[a + 1]), most(x[c], x[c + 1])),
                        most(most(y[a], y[a + 1]), most(y[c], y[c + 1])));
    }
}

static void cover_row(const WrSparseHitsJob *job, int j, const Sides *sides)
{
    for (int i = 0; i < job->mesh->mu; i++) {
        if (!(sides->one[i] | sides->two[i])) continue;
        note_shown(job, i, j);
        cover_cell(job, i, j, sides->one[i], sides->two[i]);
    }
}

static bool same_vertex(const WrViewMesh *mesh, size_t a, size_t b)
{
    return mesh->out[a] == WR_VERTEX_IN && mesh->out[b] == WR_VERTEX_IN &&
           mesh->sx[a] == mesh->sx[b] && mesh->sy[a] == mesh->sy[b];
}

/* Edges within a row, and the ends of u. */
static void cross_row(const WrSparseHitsJob *job, int j, const Sides *sides)
{
    const WrViewMesh *mesh = job->mesh;
    const int last = mesh->mu - 1;
    const size_t pitch = (size_t)mesh->mu + 1, at = (size_t)j * pitch, low = at + pitch;
    const size_t end = (size_t)mesh->mu;
    for (size_t i = 0; i < end; i++) {
        if (sides->one[i] != sides->two[i]) cross_edge(job, at + i, low + i + 1);
        if (i > 0 && sides->two[i] != sides->one[i - 1]) cross_edge(job, at + i, low + i);
    }
    const bool joined = mesh->newton.closed_u && same_vertex(mesh, at, at + end) &&
                        same_vertex(mesh, low, low + end);
    if (joined ? sides->two[0] != sides->one[last] : sides->two[0]) cross_edge(job, at, low);
    if (!joined && sides->one[last]) cross_edge(job, at + end, low + end);
}

/* Edges between the row and the one above; NULL: an end of v. */
static void cross_between(const WrSparseHitsJob *job, int j, const signed char *above,
                          const signed char *below)
{
    const size_t at = (size_t)j * ((size_t)job->mesh->mu + 1), end = (size_t)job->mesh->mu;
    for (size_t i = 0; i < end; i++)
        if ((above ? above[i] : 0) != (below ? below[i] : 0)) cross_edge(job, at + i, at + i + 1);
}

/* Ends of v. */
static void cross_ends(WrSparseHitsJob *job, const Sides *first, Sides *other)
{
    const WrViewMesh *mesh = job->mesh;
    const size_t end = (size_t)mesh->mv * ((size_t)mesh->mu + 1);
    bool joined = mesh->newton.closed_v;
    for (size_t i = 0; i <= (size_t)mesh->mu && joined; i++) joined = same_vertex(mesh, i, end + i);
    find_sides(job, mesh->mv - 1, other);
    if (joined) {
        cross_between(job, 0, other->two, first->one);
        return;
    }
    cross_between(job, 0, NULL, first->one);
    cross_between(job, mesh->mv, other->two, NULL);
}

/* Coverage of hits and crossed blocks, for a row of the mesh's blocks; ctx: WrSparseHitsJob. */
static void sparse_hits_meet_rows(int block, int worker, void *ctx)
{
    (void)worker;
    WrSparseHitsJob *job = ctx;
    Sides above, here;
    const int from = block * WR_MESH_BLOCK;
    if (from > 0) find_sides(job, from - 1, &above);
    for (int j = from; j < from + WR_MESH_BLOCK; j++) {
        find_sides(job, j, &here);
        cover_row(job, j, &here);
        cross_row(job, j, &here);
        if (j > 0) cross_between(job, j, above.two, here.one);
        else cross_ends(job, &here, &above);
        above = here;
    }
}

/* ---- Use of sparse hits in a tile of samples ---- */

bool wr_sparse_hits_deep(const WrSparseHits *knots, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const WrSparseHitsBlocks b = wr_sparse_hits_blocks(knots, x0, y0, x1, y1);
    for (int y = b.y0; y <= b.y1; y++) {
        const unsigned char *row = knots->place + (size_t)y * (size_t)knots->across;
        for (int x = b.x0; x <= b.x1; x++)
            if (row[x] == WR_SPARSE_HITS_DEPTH) return true;
    }
    return false;
}

/* u, v of a whole block. */
static void fill_block(const WrSparseHits *k, const WrWide *wide, int x, int y, int shift, float *u,
                       float *v, int pitch)
{
    const size_t at = (size_t)(y - shift / 3) * (size_t)k->across + (size_t)(x - shift % 3);
    const WrWideKnots how = { k->across, shift % 3, shift / 3, pitch };
    wide->between(k->u + at, &how, k->closed_u, u);
    wide->between(k->v + at, &how, k->closed_v, v);
}

/* The part of a block inside a tile, relative to the block's hit; `to`: position of that hit. */
typedef struct Part {
    int x0, y0, x1, y1;
    ptrdiff_t to;
} Part;

static Part part_of(const WrSparseHits *k, int x, int y, const WrDepthTile *tile)
{
    const int gx = (x - WR_SPARSE_HITS_AROUND) * WR_KNOT - tile->x,
              gy = (y + k->top) * WR_KNOT - tile->y;
    return (Part){ gx < 0 ? -gx : 0, gy < 0 ? -gy : 0,
                   gx + WR_KNOT > tile->w ? tile->w - gx : WR_KNOT,
                   gy + WR_KNOT > tile->h ? tile->h - gy : WR_KNOT, (ptrdiff_t)gy * tile->w + gx };
}

static void put_close(const Part *part, float close, WrDepthTile *tile)
{
    for (int y = part->y0; y < part->y1; y++)
        for (int x = part->x0; x < part->x1; x++)
            tile->close[part->to + (ptrdiff_t)y * tile->w + x] = close;
}

/* Removes the triangles' samples from a block that is interpolated. */
static void clear_part(const WrSparseHits *k, int x, int y, WrDepthTile *tile)
{
    const Part part = part_of(k, x, y, tile);
    put_close(&part, -FLT_MAX, tile);
}

static void fill_part(const WrSparseHits *k, const WrWide *wide, int x, int y, int shift,
                      WrDepthTile *tile)
{
    const Part part = part_of(k, x, y, tile);
    float u[WR_KNOT * WR_KNOT], v[WR_KNOT * WR_KNOT];
    put_close(&part, 0, tile);
    if (part.x1 - part.x0 == WR_KNOT && part.y1 - part.y0 == WR_KNOT) {
        fill_block(k, wide, x, y, shift, tile->u + part.to, tile->v + part.to, tile->w);
        return;
    }
    fill_block(k, wide, x, y, shift, u, v, WR_KNOT);
    for (int row = part.y0; row < part.y1; row++)
        for (int i = part.x0; i < part.x1; i++) {
            tile->u[part.to + (ptrdiff_t)row * tile->w + i] = u[row * WR_KNOT + i];
            tile->v[part.to + (ptrdiff_t)row * tile->w + i] = v[row * WR_KNOT + i];
        }
}

void wr_sparse_hits_report(const WrSparseHits *knots, WrDepthTile *tile)
{
    const int x1 = (tile->x + tile->w - 1) / WR_KNOT + WR_SPARSE_HITS_AROUND;
    const int y1 = (tile->y + tile->h - 1) / WR_KNOT - knots->top;
    tile->knots = knots;
    for (int y = tile->y / WR_KNOT - knots->top; y <= y1; y++)
        for (int x = tile->x / WR_KNOT + WR_SPARSE_HITS_AROUND; x <= x1; x++) {
            const int place = knots->place[(size_t)y * (size_t)knots->across + (size_t)x];
            tile->untold |= place == WR_SPARSE_HITS_DEPTH || place >= WR_SPARSE_HITS_BETWEEN;
            tile->deep |= place == WR_SPARSE_HITS_DEPTH;
        }
}

void wr_sparse_hits_fill(const WrSparseHits *knots, const WrWide *wide, WrDepthTile *tile)
{
    const int x1 = (tile->x + tile->w - 1) / WR_KNOT + WR_SPARSE_HITS_AROUND;
    const int y1 = (tile->y + tile->h - 1) / WR_KNOT - knots->top;
    for (int y = tile->y / WR_KNOT - knots->top; y <= y1; y++)
        for (int x = tile->x / WR_KNOT + WR_SPARSE_HITS_AROUND; x <= x1; x++) {
            const int place = knots->place[(size_t)y * (size_t)knots->across + (size_t)x];
            if (place == WR_SPARSE_HITS_SHEET && tile->deep) clear_part(knots, x, y, tile);
            if (place >= WR_SPARSE_HITS_BETWEEN)
                fill_part(knots, wide, x, y, place - WR_SPARSE_HITS_BETWEEN, tile);
        }
}

void wr_sparse_hits_row(const WrSparseHits *knots, const WrWide *wide, int x, int y, int count,
                        int at, WrStrip *strip)
{
    const int left = x / WR_KNOT + WR_SPARSE_HITS_AROUND - 1, above = y / WR_KNOT - knots->top - 1;
    const size_t first = (size_t)above * (size_t)knots->across + (size_t)left;
    const WrWideRow row = { .numbers = knots->numbers + first,
                            .plane = (size_t)knots->across * (size_t)knots->down,
                            .across = knots->across,
                            .down = y % WR_KNOT,
                            .skip = x % WR_KNOT,
                            .x = (float)x,
                            .y = (float)y };
    wide->sheet_row(&row, count, at, strip);
}

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
    if (!wr_pool_run(pool, job->mesh->blocks_v, sparse_hits_meet_rows, job) || job->behind)
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
