/* Coverage of sparse hits by triangles, and of blocks by edges at which the number of covering triangles can
   change. */
#include "render/visibility/sparse_hits_internal.h"

#include <stdbool.h>

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

void wr_sparse_hits_meet_rows(int block, int worker, void *ctx)
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
