/* The initial squares of a relief, and the sides that they share. */
#include "base/memory.h"
#include "base/enum_rows.h"
#include "export/solid.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

#define LINES 200  /* maximum lines in one direction */
#define CORNERS 64 /* maximum rows at which Pv is discontinuous */
#define SPREAD 16  /* maximum squares along a long side per square along the other */
#define SAME 1e-9  /* tolerance of equal positions, relative to the surface's radius */
#define TRIED 5    /* points along a side that are compared */
#define SEEN 8     /* samples along a side that is a single point, for its height */

typedef struct Node {
    WrSolidSight sight;
    /* union-find of nodes at one position: the smallest number, or one on the way to it */
    int32_t root;
} Node;

/* A triangle's side on the border of the domain. */
typedef struct Side {
    int32_t triangle, slot, from, to; /* from, to: nodes */
    WrSolidSight ends[2];
    WrVec3 at[TRIED];
    bool point; /* the side is a single point */
} Side;

typedef struct Base {
    WrSolid *solid;
    double u[LINES], v[LINES];
    int count_u, count_v; /* number of squares */
    WR_ARRAY(Node) nodes;
    WR_ARRAY(Side) sides;
} Base;

/* ---- lines ---- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Numbers of squares along u and v that make them nearly square on the surface; multiples of four where it is
   curved. */
static void count_squares(const WrShape *shape, WrSurfaceCell cell, int *nu, int *nv)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    WrSurfacePoint o;
    wr_surface_at(shape, 0, (cell.u0 + cell.u1) / 2, (cell.v0 + cell.v1) / 2, &o);
    const double ratio = v3_len(o.pu) * (cell.u1 - cell.u0) / (v3_len(o.pv) * (cell.v1 - cell.v0));
    *nu = *nv = info->flat && !info->closed_u ? 1 : 4;
    if (!isfinite(ratio) || !(ratio > 0.0)) return;
    *nu *= (int)fmin(fmax(rint(ratio), 1.0), SPREAD);
    *nv *= (int)fmin(fmax(rint(1.0 / ratio), 1.0), SPREAD);
}

static void lay_lines(Base *base, const WrShape *shape, int face)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const WrSurfaceCell cell = wr_surface_cell(shape, face);
    double corners[CORNERS];
    const int most = info->corners ? info->corners(shape, corners, CORNERS) : 0;
    count_squares(shape, cell, &base->count_u, &base->count_v);
    for (int i = 0; i <= base->count_u; i++)
        base->u[i] = cell.u0 + (cell.u1 - cell.u0) * i / base->count_u;
    for (int j = 0; j <= base->count_v; j++)
        base->v[j] = cell.v0 + (cell.v1 - cell.v0) * j / base->count_v;
    const int even = base->count_v;
    for (int k = 0; k < most; k++) {
        bool there = false;
        for (int j = 0; j <= even; j++) there |= fabs(base->v[j] - corners[k]) < SAME;
        if (!there) base->v[++base->count_v] = corners[k];
    }
    qsort(base->v, (size_t)base->count_v + 1, sizeof *base->v, compare);
}

/* ---- squares ---- */

static WrSolidTriangle triangle_of(const Base *base, int face, int a, int b, int c)
{
    const int32_t node[3] = { a, b, c };
    WrSolidTriangle t = { .face = face, .error = -1.0f, .across = { -1, -1, -1 } };
    for (int k = 0; k < 3; k++) {
        t.point[k] = node[k];
        t.u[k] = base->nodes.data[node[k]].sight.u;
        t.v[k] = base->nodes.data[node[k]].sight.v;
    }
    return t;
}

/* Two triangles per square, below and above its diagonal, with their neighbours in the face. */
static void lay_face(Base *base, int face)
{
    WrSolid *s = base->solid;
    const int nu = base->count_u, nv = base->count_v;
    const int32_t node = base->nodes.count, first = s->relief.count;
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i <= nu; i++) {
            Node n = { { base->u[i], base->v[j], face }, base->nodes.count };
            wr_array_push(&base->nodes, n);
        }
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < nu; i++) {
            const int a = node + j * (nu + 1) + i, b = a + 1, d = a + nu + 1, c = d + 1;
            const int32_t at = first + 2 * (j * nu + i);
            WrSolidTriangle low = triangle_of(base, face, c, a, b);
            WrSolidTriangle high = triangle_of(base, face, a, c, d);
            low.across[2] = at + 1;
            high.across[2] = at;
            if (j > 0) low.across[0] = at - 2 * nu + 1;
            if (i + 1 < nu) low.across[1] = at + 3;
            if (j + 1 < nv) high.across[0] = at + 2 * nu;
            if (i > 0) high.across[1] = at - 2;
            wr_array_push(&s->relief, low);
            wr_array_push(&s->relief, high);
        }
}

/* ---- shared sides ---- */

static int32_t root_of(const Base *base, int32_t node)
{
    while (base->nodes.data[node].root != node) node = base->nodes.data[node].root;
    return node;
}

static void join_nodes(Base *base, int32_t a, int32_t b)
{
    a = root_of(base, a), b = root_of(base, b);
    if (a < b) base->nodes.data[b].root = a;
    else base->nodes.data[a].root = b;
}

static WrSolidSight between(const WrSolidSight ends[2], double t)
{
    return (WrSolidSight){ ends[0].u + (ends[1].u - ends[0].u) * t,
                           ends[0].v + (ends[1].v - ends[0].v) * t, ends[0].face };
}

static void find_sides(Base *base)
{
    const WrSolid *s = base->solid;
    for (int32_t i = 0; i < s->relief.count; i++)
        for (int k = 0; k < 3; k++) {
            const WrSolidTriangle *t = &s->relief.data[i];
            if (t->across[k] >= 0) continue;
            Side side = {
                .triangle = i, .slot = k, .from = t->point[(k + 1) % 3], .to = t->point[(k + 2) % 3]
            };
            side.ends[0] = base->nodes.data[side.from].sight;
            side.ends[1] = base->nodes.data[side.to].sight;
            for (int p = 0; p < TRIED; p++) {
                const WrSolidSight at = between(side.ends, p / (TRIED - 1.0));
                WrSurfacePoint o;
                wr_surface_at(&s->scene->shape, at.face, at.u, at.v, &o);
                side.at[p] = o.p;
            }
            wr_array_push(&base->sides, side);
        }
}

static bool one_point(const Side *side, double same)
{
    for (int p = 1; p < TRIED; p++)
        if (!(v3_len(v3_sub(side->at[p], side->at[0])) <= same)) return false;
    return true;
}

/* True if both are the same curve in opposite directions, as neighbours' sides are. */
static bool one_curve(const Side *a, const Side *b, double same)
{
    for (int p = 0; p < TRIED; p++)
        if (!(v3_len(v3_sub(a->at[p], b->at[TRIED - 1 - p])) <= same)) return false;
    return true;
}

static void join_sides(Base *base)
{
    WrSolidTriangle *relief = base->solid->relief.data;
    const double same = SAME * wr_shape_radius(&base->solid->scene->shape);
    for (int i = 0; i < base->sides.count; i++) {
        Side *a = &base->sides.data[i];
        a->point = one_point(a, same);
        if (a->point) join_nodes(base, a->from, a->to);
        for (int k = 0; k < i && !a->point; k++) {
            Side *b = &base->sides.data[k];
            if (b->point || relief[b->triangle].across[b->slot] >= 0 || !one_curve(a, b, same))
                continue;
            relief[a->triangle].across[a->slot] = b->triangle;
            relief[b->triangle].across[b->slot] = a->triangle;
            join_nodes(base, a->from, b->to);
            join_nodes(base, a->to, b->from);
            break;
        }
    }
}

/* ---- points ---- */

/* A point with all sights of a node: those joined with it, and those along sides that are a single point. */
static int32_t point_of(Base *base, int32_t root)
{
    WR_ARRAY(WrSolidSight) seen = { 0 };
    for (int32_t i = root; i < base->nodes.count; i++)
        if (root_of(base, i) == root) wr_array_push(&seen, base->nodes.data[i].sight);
    for (int i = 0; i < base->sides.count; i++) {
        const Side *side = &base->sides.data[i];
        if (!side->point || root_of(base, side->from) != root) continue;
        for (int k = 1; k < SEEN; k++) {
            WrSolidSight at = between(side->ends, (double)k / SEEN);
            wr_array_push(&seen, at);
        }
    }
    const int32_t point = wr_solid_add_point(base->solid, seen.data, seen.count);
    wr_array_free(&seen);
    return point;
}

static void number_points(Base *base)
{
    WrSolid *s = base->solid;
    int32_t *point = wr_alloc((size_t)base->nodes.count, sizeof *point);
    for (int32_t i = 0; i < base->nodes.count; i++) {
        const int32_t root = root_of(base, i);
        point[i] = root == i ? point_of(base, i) : point[root];
    }
    for (int32_t i = 0; i < s->relief.count; i++)
        for (int k = 0; k < 3; k++) {
            int32_t *at = &s->relief.data[i].point[k];
            *at = point[*at];
        }
    wr_free(point);
}

void wr_solid_lay(WrSolid *solid)
{
    Base base = { .solid = solid };
    for (int face = 0; face < solid->faces; face++) {
        lay_lines(&base, &solid->scene->shape, face);
        lay_face(&base, face);
    }
    find_sides(&base);
    join_sides(&base);
    number_points(&base);
    wr_array_free(&base.nodes);
    wr_array_free(&base.sides);
}
