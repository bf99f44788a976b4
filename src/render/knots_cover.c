/* What triangles cover knots, and which blocks are crossed by edges at which their number can change. */
#include "render/knots_inner.h"

#include <stdbool.h>

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static void cross_rectangle(WrKnots *knots, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const WrKnotsBlocks b = wr_knots_blocks(knots, x0, y0, x1, y1);
    for (int y = b.y0; y <= b.y1; y++)
        for (int x = b.x0; x <= b.x1; x++)
            __atomic_store_n(&knots->crossed[(size_t)y * (size_t)knots->across + (size_t)x], 1,
                             __ATOMIC_RELAXED);
}

/* The edge between two vertices. */
static void cross_edge(const WrKnotsJob *job, size_t a, size_t b)
{
    const int32_t *x = job->mesh->sx, *y = job->mesh->sy;
    cross_rectangle(job->knots, least(x[a], x[b]), least(y[a], y[b]), most(x[a], x[b]),
                    most(y[a], y[b]));
}

/* How a triangle is drawn: 0: not at all; its side towards the viewer else. */
static int side_of(const WrKnotsJob *job, size_t a, size_t b, size_t c)
{
    const int32_t *x = job->mesh->sx, *y = job->mesh->sy;
    const int64_t area = ((int64_t)x[b] - x[a]) * ((int64_t)y[c] - y[a]) -
                         ((int64_t)y[b] - y[a]) * ((int64_t)x[c] - x[a]);
    if (area == 0 || (job->view->cull && (area > 0) != job->mirrored)) return 0;
    return area > 0 ? 1 : -1;
}

/* A triangle's corner as its knots are told from it. */
typedef struct Corner {
    int64_t x, y;
    float w, u, v; /* w: 1 / depth, or 1 */
} Corner;

static Corner corner_at(const WrKnotsJob *job, size_t at, int i, int j)
{
    const WrViewMesh *mesh = job->mesh;
    return (Corner){ mesh->sx[at], mesh->sy[at], job->view->perspective ? mesh->close[at] : 1.0f,
                     (float)i * job->step_u, mesh->v[j] };
}

/* e >= 0 left of the way from a to b, and on it where it is a top or left one (raster.c). */
static int64_t beside(const Corner *a, const Corner *b, int64_t x, int64_t y)
{
    const int64_t dx = b->x - a->x, dy = b->y - a->y;
    const bool owns = dy < 0 || (dy == 0 && dx < 0);
    return dx * (y - a->y) - dy * (x - a->x) - (owns ? 0 : 1);
}

static void cover_knot(const WrKnotsJob *job, const Corner *c, int kx, int ky)
{
    WrKnots *knots = job->knots;
    const int64_t x = (int64_t)(kx - WR_KNOTS_AROUND) * WR_KNOT_STEP + 128,
                  y = (int64_t)(ky + knots->top) * WR_KNOT_STEP + 128;
    const int64_t e0 = beside(&c[1], &c[2], x, y), e1 = beside(&c[2], &c[0], x, y);
    const int64_t e2 = beside(&c[0], &c[1], x, y);
    if ((e0 | e1 | e2) < 0) return;
    const size_t at = (size_t)ky * (size_t)knots->across + (size_t)kx;
    if (__atomic_fetch_add(&knots->count[at], 1, __ATOMIC_RELAXED) != 0) return;
    const float w0 = (float)e0 * c[0].w, w1 = (float)e1 * c[1].w, w2 = (float)e2 * c[2].w;
    const float all = w0 + w1 + w2, inv = all > 0 ? 1.0f / all : 0.0f;
    knots->u[at] = (w0 * c[0].u + w1 * c[1].u + w2 * c[2].u) * inv;
    knots->v[at] = (w0 * c[0].v + w1 * c[1].v + w2 * c[2].v) * inv;
}

/* The first knot at x or beyond. */
static int knot_from(int64_t x)
{
    return (int)-(int64_t)wr_knots_floor((int32_t)(128 - x));
}

static int64_t least3(int64_t a, int64_t b, int64_t c)
{
    return a < b ? a < c ? a : c : b < c ? b : c;
}

static void cover_knots(const WrKnotsJob *job, int side, Corner a, Corner b, Corner c)
{
    const WrKnots *knots = job->knots;
    const Corner corner[3] = { a, side > 0 ? b : c, side > 0 ? c : b };
    const int x0 =
        wr_knots_clamped(knot_from(least3(a.x, b.x, c.x)) + WR_KNOTS_AROUND, 0, knots->across);
    const int x1 = wr_knots_clamped(knot_from(1 - least3(-a.x, -b.x, -c.x)) + WR_KNOTS_AROUND, 0,
                                    knots->across);
    const int y0 = wr_knots_clamped(knot_from(least3(a.y, b.y, c.y)) - knots->top, 0, knots->down);
    const int y1 =
        wr_knots_clamped(knot_from(1 - least3(-a.y, -b.y, -c.y)) - knots->top, 0, knots->down);
    for (int ky = y0; ky < y1; ky++)
        for (int kx = x0; kx < x1; kx++) cover_knot(job, corner, kx, ky);
}

/* The sides of a row's triangles. */
typedef struct Sides {
    signed char one[WR_MESH_MOST], two[WR_MESH_MOST];
} Sides;

/* A cell with a vertex beyond the guard band may show anything where it lies: 0 and 0. */
static void find_sides(WrKnotsJob *job, int j, Sides *sides)
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
        cross_rectangle(job->knots, least(least(x[a], x[a + 1]), least(x[c], x[c + 1])),
                        least(least(y[a], y[a + 1]), least(y[c], y[c + 1])),
                        most(most(x[a], x[a + 1]), most(x[c], x[c + 1])),
                        most(most(y[a], y[a + 1]), most(y[c], y[c + 1])));
    }
}

/* Is there a knot between two places, 1/256 samples, of vertices before the eye and near the picture? */
static inline bool holds_knot(int32_t low, int32_t high)
{
    const uint32_t from = (uint32_t)(low + (1 << 28) - 129) / WR_KNOT_STEP;
    return (uint32_t)(high + (1 << 28) - 128) / WR_KNOT_STEP > from;
}

static bool cell_holds_knot(const WrKnotsJob *job, size_t a, size_t c)
{
    const int32_t *x = job->mesh->sx, *y = job->mesh->sy;
    return holds_knot(least(least(x[a], x[a + 1]), least(x[c], x[c + 1])),
                      most(most(x[a], x[a + 1]), most(x[c], x[c + 1]))) &&
           holds_knot(least(least(y[a], y[a + 1]), least(y[c], y[c + 1])),
                      most(most(y[a], y[a + 1]), most(y[c], y[c + 1])));
}

static void cover_row(const WrKnotsJob *job, int j, const Sides *sides)
{
    const size_t pitch = (size_t)job->mesh->mu + 1;
    for (int i = 0; i < job->mesh->mu; i++) {
        const size_t at = (size_t)j * pitch + (size_t)i, low = at + pitch;
        if ((!sides->one[i] && !sides->two[i]) || !cell_holds_knot(job, at, low)) continue;
        const Corner a = corner_at(job, at, i, j), d = corner_at(job, low + 1, i + 1, j + 1);
        if (sides->one[i]) cover_knots(job, sides->one[i], a, corner_at(job, at + 1, i + 1, j), d);
        if (sides->two[i]) cover_knots(job, sides->two[i], a, d, corner_at(job, low, i, j + 1));
    }
}

static bool same_vertex(const WrViewMesh *mesh, size_t a, size_t b)
{
    return mesh->out[a] == WR_VERTEX_IN && mesh->out[b] == WR_VERTEX_IN &&
           mesh->sx[a] == mesh->sx[b] && mesh->sy[a] == mesh->sy[b];
}

/* The edges of a row within itself, and where u begins and ends. */
static void cross_row(const WrKnotsJob *job, int j, const Sides *sides)
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

/* Those between it and the row above; NULL: v begins or ends there. */
static void cross_between(const WrKnotsJob *job, int j, const signed char *above,
                          const signed char *below)
{
    const size_t at = (size_t)j * ((size_t)job->mesh->mu + 1), end = (size_t)job->mesh->mu;
    for (size_t i = 0; i < end; i++)
        if ((above ? above[i] : 0) != (below ? below[i] : 0)) cross_edge(job, at + i, at + i + 1);
}

/* Where v begins and ends. */
static void cross_ends(WrKnotsJob *job, const Sides *first, Sides *other)
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

void wr_knots_meet_rows(int block, int worker, void *ctx)
{
    (void)worker;
    WrKnotsJob *job = ctx;
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
