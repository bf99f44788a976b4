/* Relief as a closed triangle mesh in millimetres, for 3D printing and milling.

   A point of the relief is P + F n of the scene's surface, stretched as the object is, times millimetres per
   unit. The domain of (u,v) is divided into squares, each into two right triangles. A triangle from which a
   sample is too far is bisected at its longest side, together with the triangle beyond that side, so that no
   edge ever has a vertex of another triangle inside it. Sides of the domain that are one curve in space (a seam,
   an edge of a cube) share one set of points, and a side that is a single point (a pole) has one: so the mesh is
   closed wherever the surface is.

   Samples are all texels' centres, and for a coarse table points between: every texel's own height is tested.
   The error of a sample is its distance from the triangle that represents it, with corners rounded to the file's
   32-bit floats. */

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "export/job.h"
#include "export/mesh_solid.h"
#include "export/solid_body.h"
#include "field/field.h"
#include "render/tessellation/facet.h"
#include "render/tessellation/mesh_relief.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "system/thread.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- the solid under construction ---- */

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

#define WR_SOLID_FACES 6
#define WR_SOLID_SAMPLES ((int64_t)1 << 28) /* maximum */

/* A position in the domain that maps to a point: a seam has two, a pole many. */
typedef struct WrSolidLocation {
    double u, v;
    int32_t face;
} WrSolidLocation;

typedef struct WrSolidTriangle {
    int32_t point
        [3]; /* anticlockwise from outside; the side from corner 0 to corner 1 is the next one to be bisected */
    int32_t across[3]; /* the triangle beyond the side opposite corner k; -1: none */
    int32_t face;
    float error; /* mm: largest distance of its samples; below 0: not measured */
    double u[3], v[3];
} WrSolidTriangle;

/* Samples of one face: i, j stand for u = (first_u + i + 1/2) step_u and v = (first_v + j + 1/2) step_v. */
typedef struct WrSolidLattice {
    double first_u, first_v, step_u, step_v;
    int count_u, count_v;
    float (*at)[3]; /* [count_v][count_u], mm; owned */
} WrSolidLattice;

typedef struct WrSolid {
    const WrScene *scene;
    const WrField *field;
    WrPool *pool;
    double size;       /* mm: longest side of the smooth surface */
    double true_width; /* mm: its width instead; 0: use size */
    double error;      /* requested error, mm */
    int32_t most;      /* triangles of the relief, without its back */
    double thickness;  /* mm below the lowest sample; 0: filled, open ends closed flat */
    WrVec3 stretch, cofactor, middle; /* a point is (stretch P - middle) scale */
    double scale;                     /* mm per object unit */
    int faces;
    WrSolidLattice lattice[WR_SOLID_FACES];
    double low, high; /* of F over the samples and points, object units */
    WR_ARRAY(WrSolidTriangle) relief;
    WR_ARRAY(WrSolidLocation) locations; /* of all points, in their order */
    WR_ARRAY(int32_t) first;             /* index of each point's first sight */
    WrSolidBody body;
    double worst; /* mm: the largest error of all */
} WrSolid;

/* A closed body in five steps: squares of two triangles cover each face of the surface's (u,v) domain (solid_lay); sides
   at the same position are joined across seams, faces and poles; triangles are bisected until every sample of the relief is
   within the error (solid_refine); the border becomes a back with walls, or caps (solid_close); the mesh is turned
   outwards and written. Triangles share points by number, so the mesh is watertight by construction, not by comparing rounded
   positions. */
/* ---- The initial squares of a relief, and the sides that they share ---- */

#define LINES 200  /* maximum lines in one direction */
#define CORNERS 64 /* maximum rows at which Pv is discontinuous */
#define SPREAD 16  /* maximum squares along a long side per square along the other */
#define SAME 1e-9  /* tolerance of equal positions, relative to the surface's radius */
#define TRIED 5    /* points along a side that are compared */
#define SEEN 8     /* samples along a side that is a single point, for its height */

typedef struct Node {
    WrSolidLocation location;
    /* union-find of nodes at one position: the smallest number, or one on the way to it */
    int32_t root;
} Node;

/* A triangle's side on the border of the domain. */
typedef struct Side {
    int32_t triangle, slot, from, to; /* from, to: nodes */
    WrSolidLocation ends[2];
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
    /* Aspect of the middle cell on the surface, |Pu| du / (|Pv| dv): bisection keeps the shape of its triangles, so they must
       start nearly square. */
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
        t.u[k] = base->nodes.data[node[k]].location.u;
        t.v[k] = base->nodes.data[node[k]].location.v;
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
            /* Corners a b below, d c above. The longest side, the diagonal a c, must be opposite to corner 2 (refine):
               triangles (c, a, b) and (a, c, d). across[k] is the neighbour opposite to corner k; squares are numbered row by
               row, two triangles each. */
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

static WrSolidLocation between(const WrSolidLocation ends[2], double t)
{
    return (WrSolidLocation){ ends[0].u + (ends[1].u - ends[0].u) * t,
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
            side.ends[0] = base->nodes.data[side.from].location;
            side.ends[1] = base->nodes.data[side.to].location;
            for (int p = 0; p < TRIED; p++) {
                const WrSolidLocation at = between(side.ends, p / (TRIED - 1.0));
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

/* Sides on the domain's border: those of length 0 are poles; of the others each pair that is one curve in opposite directions
   is a seam. Quadratic in their number, which is at most a few thousand. Two sides are compared at TRIED points, since a
   seam's ends alone also agree for two different arcs. */
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

/* ---- points of the body ---- */

static int32_t solid_add_point(WrSolid *solid, const WrSolidLocation *locations, int count);

/* A point with all sights of a node: those joined with it, and those along sides that are a single point. */
static int32_t point_of(Base *base, int32_t root)
{
    WR_ARRAY(WrSolidLocation) seen = { 0 };
    for (int32_t i = root; i < base->nodes.count; i++)
        if (root_of(base, i) == root) wr_array_push(&seen, base->nodes.data[i].location);
    for (int i = 0; i < base->sides.count; i++) {
        const Side *side = &base->sides.data[i];
        if (!side->point || root_of(base, side->from) != root) continue;
        for (int k = 1; k < SEEN; k++) {
            WrSolidLocation at = between(side->ends, (double)k / SEEN);
            wr_array_push(&seen, at);
        }
    }
    const int32_t point = solid_add_point(base->solid, seen.data, seen.count);
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

/* Builds the squares and joins shared sides. */
static void solid_lay(WrSolid *solid)
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

/* ---- solid samples ---- */

/* Samples for measuring a solid: all texels' centres, and points between those of a coarse table. */

#define FINEST 2000 /* minimum samples along each direction for the smallest error */
#define COARSEST 64 /* minimum for the largest error */
#define CLOSE                                                                                      \
    16.0 /* times sqrt(size / error): the sagitta between two samples on a sphere is 1/100 of the error */

/* Samples along one direction of a face, from `from` to `to`. A texel's centre is at k + 1/2 texels from 0, and
   is a sample if each texel has an odd number of them. Texel k's centre is at (k + 1/2) / texels. With an odd number m of
   samples a texel, at (n + 1/2) / (m texels), sample n = m k + (m - 1) / 2 is that centre. */
static bool lay_direction(double texels, double fine, double from, double to, double *first,
                          double *step, int *count)
{
    const double there = fmax(texels * (to - from), 1.0);
    double each = ceil(fine / there);
    each += fmod(each, 2.0) == 0.0;
    *step = 1.0 / (fmax(texels, 1.0) * each);
    *first = ceil(from / *step - 0.5);
    const double last = floor(to / *step - 0.5);
    *count = (int)fmin(last - *first + 1.0, 1e9);
    return last - *first < 1e9;
}

/* The lattice of a face is float[count_v][count_u][3], owned by the solid, u fastest: positions in millimetres of the
   displaced surface P + F n, scaled. */
static bool lay_lattice(WrSolid *solid, int face, int64_t *samples, WrError *err)
{
    const WrScene *scene = solid->scene;
    const WrSurfaceCell cell = wr_surface_cell(&scene->shape, face);
    WrSolidLattice *l = &solid->lattice[face];
    const double fine = fmin(fmax(CLOSE * sqrt(solid->size / solid->error), COARSEST), FINEST);
    const bool fits_u = lay_direction(wr_field_width(solid->field) * fabs(scene->replicate_u), fine,
                                      cell.u0, cell.u1, &l->first_u, &l->step_u, &l->count_u);
    const bool fits_v = lay_direction(wr_field_height(solid->field) * fabs(scene->replicate_v),
                                      fine, cell.v0, cell.v1, &l->first_v, &l->step_v, &l->count_v);
    *samples += (int64_t)l->count_u * l->count_v;
    if (fits_u && fits_v && *samples <= WR_SOLID_SAMPLES) return true;
    return wr_fail(
        err, "the surface has more than %lld texels: fewer repeats (replicate), or a smaller table",
        (long long)WR_SOLID_SAMPLES);
}

/* ---- positions ---- */

typedef struct Work {
    WrSolid *solid;
    int face;
    WrMutex lock;
    bool bad; /* exceeds single precision */
} Work;

static void note(Work *work, double low, double high, bool bad)
{
    wr_mutex_lock(&work->lock);
    work->solid->low = fmin(work->solid->low, low);
    work->solid->high = fmax(work->solid->high, high);
    work->bad |= bad;
    wr_mutex_unlock(&work->lock);
}

static void put(const WrSolid *s, const WrSurfacePoint *o, double f, float out[3])
{
    const WrVec3 p = v3_mad(o->p, o->n_unit, f);
    out[0] = (float)((s->stretch.x * p.x - s->middle.x) * s->scale);
    out[1] = (float)((s->stretch.y * p.y - s->middle.y) * s->scale);
    out[2] = (float)((s->stretch.z * p.z - s->middle.z) * s->scale);
}

static void sample_row(int j, int worker, void *ctx)
{
    (void)worker;
    Work *work = ctx;
    const WrSolid *s = work->solid;
    const WrSolidLattice *l = &s->lattice[work->face];
    double low = INFINITY, high = -INFINITY, u[WR_HEIGHTS_RUN], v[WR_HEIGHTS_RUN],
           f[WR_HEIGHTS_RUN];
    bool bad = false;
    for (int from = 0; from < l->count_u; from += WR_HEIGHTS_RUN) {
        const int count = l->count_u - from < WR_HEIGHTS_RUN ? l->count_u - from : WR_HEIGHTS_RUN;
        for (int i = 0; i < count; i++) {
            u[i] = (l->first_u + from + i + 0.5) * l->step_u;
            v[i] = (l->first_v + j + 0.5) * l->step_v;
        }
        wr_scene_heights(s->scene, s->field, count, u, v, f);
        for (int i = 0; i < count; i++) {
            float *at = l->at[(size_t)j * (size_t)l->count_u + (size_t)(from + i)];
            WrSurfacePoint o;
            wr_surface_at(&s->scene->shape, work->face, u[i], v[i], &o);
            put(s, &o, f[i], at);
            low = fmin(low, f[i]);
            high = fmax(high, f[i]);
            bad |= !(fabsf(at[0]) < 1e18f && fabsf(at[1]) < 1e18f && fabsf(at[2]) < 1e18f);
        }
    }
    note(work, low, high, bad);
}

/* Computes positions and heights of all samples. */
static bool solid_sample(WrSolid *solid, WrError *err)
{
    int64_t samples = 0;
    bool good = true;
    for (int face = 0; face < solid->faces && good; face++)
        good = lay_lattice(solid, face, &samples, err);
    Work work = { .solid = solid };
    wr_mutex_init(&work.lock);
    for (int face = 0; face < solid->faces && good; face++) {
        WrSolidLattice *l = &solid->lattice[face];
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, (double)face / solid->faces, (face + 1.0) / solid->faces);
        work.face = face;
        l->at = wr_try_alloc((size_t)l->count_u * (size_t)l->count_v, sizeof *l->at,
                             "a solid's samples", err);
        good = l->at && (wr_pool_run_with_progress(solid->pool, l->count_v, sample_row, &work) ||
                         wr_fail(err, "cancelled"));
        wr_progress_set(whole);
    }
    wr_mutex_fini(&work.lock);
    if (good && work.bad)
        good =
            wr_fail(err, "the relief is too high for a solid of that size: reduce the bump height");
    return good;
}

/* ---- solid refine ---- */

/* Bisection of triangles that are too far from a sample. Each triangle is measured against all samples inside
   it. All new ones are measured at once, by any number of threads; those that fail are then bisected one after
   the other, so that the result does not depend on the threads. */

#define PIECE 128 /* triangles measured by one thread at a time */
/* relative to the distance of two samples: smaller triangles are not bisected */
#define LEAST 0.0625
#define SLACK 1e-6 /* relative to that distance: samples on a side are in both triangles */

/* ---- samples in a triangle ---- */

/* Interval of the row v of the domain inside the triangle; false: empty. The row cuts a triangle in one interval of u; the
   minimum and maximum over its three sides are its ends. */
static bool row_of(const WrSolidTriangle *t, double v, double *from, double *to)
{
    *from = INFINITY, *to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const int n = (k + 1) % 3;
        const double low = fmin(t->v[k], t->v[n]), high = fmax(t->v[k], t->v[n]);
        if (v < low || v > high) continue;
        const double part = high > low ? (v - t->v[k]) / (t->v[n] - t->v[k]) : 0.0;
        const double u = t->u[k] + (t->u[n] - t->u[k]) * part;
        *from = fmin(*from, high > low ? u : fmin(t->u[k], t->u[n]));
        *to = fmax(*to, high > low ? u : fmax(t->u[k], t->u[n]));
    }
    return *from <= *to;
}

static int first_at(double x, double step, double first)
{
    return (int)fmax(ceil(x / step - 0.5 - first - SLACK), 0.0);
}

static int last_at(double x, double step, double first, int count)
{
    return (int)fmin(floor(x / step - 0.5 - first + SLACK), count - 1.0);
}

/* The largest distance of its samples, or one that exceeds `enough`. */
static double error_of(const WrSolid *s, const WrSolidTriangle *t, double enough)
{
    const WrSolidLattice *l = &s->lattice[t->face];
    const WrFacet facet = wr_facet_of((const float(*)[3])s->body.points, t->point);
    const double low = fmin(t->v[0], fmin(t->v[1], t->v[2]));
    const double high = fmax(t->v[0], fmax(t->v[1], t->v[2]));
    const int last = last_at(high, l->step_v, l->first_v, l->count_v);
    double worst = 0.0;
    for (int j = first_at(low, l->step_v, l->first_v); j <= last; j++) {
        const double v = (l->first_v + j + 0.5) * l->step_v;
        double from, to;
        if (wr_progress_stopped()) break;
        if (!row_of(t, fmin(fmax(v, low), high), &from, &to)) continue;
        const int end = last_at(to, l->step_u, l->first_u, l->count_u);
        for (int i = first_at(from, l->step_u, l->first_u); i <= end; i++) {
            const float *at = l->at[(size_t)j * (size_t)l->count_u + (size_t)i];
            const double d = wr_facet_distance2(&facet, (WrVec3){ at[0], at[1], at[2] });
            if (!(d <= worst)) worst = d;
        }
        if (!(worst <= enough * enough)) break;
    }
    return sqrt(worst);
}

typedef struct RefineWork {
    WrSolid *solid;
    const int32_t *fresh;
    int32_t count;
} RefineWork;

static void measure_piece(int index, int worker, void *ctx)
{
    (void)worker;
    const RefineWork *work = ctx;
    WrSolid *s = work->solid;
    int32_t end = (index + 1) * PIECE < work->count ? (index + 1) * PIECE : work->count;
    for (int32_t i = index * PIECE; i < end; i++) {
        WrSolidTriangle *t = &s->relief.data[work->fresh[i]];
        t->error = (float)error_of(s, t, s->error);
    }
}

/* ---- bisection ---- */

/* True unless the triangle is smaller than the distance of its samples, where bisection improves nothing. */
static bool can_halve(const WrSolid *s, const WrSolidTriangle *t)
{
    const WrSolidLattice *l = &s->lattice[t->face];
    const double du = fmax(t->u[0], fmax(t->u[1], t->u[2])) - fmin(t->u[0], fmin(t->u[1], t->u[2]));
    const double dv = fmax(t->v[0], fmax(t->v[1], t->v[2])) - fmin(t->v[0], fmin(t->v[1], t->v[2]));
    return du > LEAST * l->step_u || dv > LEAST * l->step_v;
}

static WrSolidLocation middle_of_triangle(const WrSolidTriangle *t)
{
    return (WrSolidLocation){ (t->u[0] + t->u[1]) / 2, (t->v[0] + t->v[1]) / 2, t->face };
}

static int32_t middle_point(WrSolid *s, const WrSolidTriangle *t, const WrSolidTriangle *beyond)
{
    if (t->point[0] == t->point[1]) return t->point[0]; /* a pole */
    WrSolidLocation locations[2] = { middle_of_triangle(t) };
    int count = 1;
    if (beyond) {
        locations[1] = middle_of_triangle(beyond);
        count += locations[1].face != locations[0].face || locations[1].u != locations[0].u ||
                 locations[1].v != locations[0].v;
    }
    return solid_add_point(s, locations, count);
}

/* Replaces a neighbour's number in a triangle. */
static void tell(WrSolid *s, int32_t triangle, int32_t was, int32_t now)
{
    if (triangle < 0) return;
    for (int k = 0; k < 3; k++)
        if (s->relief.data[triangle].across[k] == was) {
            s->relief.data[triangle].across[k] = now;
            return;
        }
}

/* Divides into (2, 0, m), which keeps its number, and (1, 2, m); returns the second's. The neighbour beyond side
   0 1 is set by the caller. */
static int32_t halve(WrSolid *s, int32_t index, int32_t point)
{
    const WrSolidTriangle t = s->relief.data[index];
    const WrSolidLocation m = middle_of_triangle(&t);
    const int32_t other = s->relief.count;
    const WrSolidTriangle a = {
        { t.point[2], t.point[0], point }, { -1, other, t.across[1] }, t.face, -1.0f,
        { t.u[2], t.u[0], m.u },           { t.v[2], t.v[0], m.v }
    };
    const WrSolidTriangle b = {
        { t.point[1], t.point[2], point }, { index, -1, t.across[0] }, t.face, -1.0f,
        { t.u[1], t.u[2], m.u },           { t.v[1], t.v[2], m.v }
    };
    s->relief.data[index] = a;
    wr_array_push(&s->relief, b);
    tell(s, t.across[0], index, other);
    return other;
}

/* Bisects the two triangles at the longest side of one; before that the neighbour, until that side is its
   longest, too. Rivara's longest-side bisection in its conforming form: corner 2 is opposite to the side that is bisected
   next (newest-vertex bisection), a neighbour whose own such side is another is bisected first. No T-junctions arise, and
   angles stay bounded away from 0. The recursion ends since each step goes to a triangle of an earlier generation. */
static void refine(WrSolid *s, int32_t index)
{
    int32_t beyond;
    while ((beyond = s->relief.data[index].across[2]) >= 0 &&
           s->relief.data[beyond].across[2] != index)
        refine(s, beyond);
    const WrSolidTriangle *t = &s->relief.data[index];
    const int32_t m = middle_point(s, t, beyond >= 0 ? &s->relief.data[beyond] : NULL);
    const int32_t half = halve(s, index, m);
    if (beyond < 0) return;
    const int32_t far = halve(s, beyond, m);
    s->relief.data[index].across[0] = far;
    s->relief.data[half].across[1] = beyond;
    s->relief.data[beyond].across[0] = half;
    s->relief.data[far].across[1] = index;
}

/* Bisects all that failed. Returns the number of bisections; -1 if there are too many triangles. */
static int32_t halve_bad(WrSolid *s, const int32_t *fresh, int32_t count)
{
    int32_t halved = 0;
    for (int32_t i = 0; i < count; i++) {
        const WrSolidTriangle *t = &s->relief.data[fresh[i]];
        if (!(t->error > s->error) || !can_halve(s, t)) continue;
        refine(s, fresh[i]);
        halved++;
        if (s->relief.count > s->most) return -1;
        if (halved % 4096 == 0 && wr_progress_stopped()) return 0;
    }
    return halved;
}

static int32_t find_fresh(const WrSolid *s, int32_t *fresh)
{
    int32_t count = 0;
    for (int32_t i = 0; i < s->relief.count; i++)
        if (s->relief.data[i].error < 0.0f) fresh[count++] = i;
    return count;
}

static bool settle(WrSolid *s, WrError *err)
{
    s->worst = 0.0;
    for (int32_t i = 0; i < s->relief.count; i++)
        if (!(s->relief.data[i].error <= s->worst)) s->worst = s->relief.data[i].error;
    if (s->worst <= s->error) return true;
    return wr_fail(err,
                   "error=%.6g: cannot be reached: the smallest possible is %.3g mm; give a larger "
                   "error or size",
                   s->error, s->worst);
}

/* With more triangles than there may be: an error that needs fewer. laid: triangles before all bisections. */
static double fitting_error(const WrSolid *s, int32_t laid)
{
    const int32_t step = wr_fitting_error_step(s->relief.count);
    double sum = 0.0;
    for (int32_t i = 0; i < s->relief.count; i += step)
        sum += step * error_of(s, &s->relief.data[i], INFINITY);
    return wr_fitting_error(sum, laid, s->most);
}

/* Bisects triangles until every sample's error is at most `error`. */
static bool solid_refine(WrSolid *solid, WrExportJob *job, WrError *err)
{
    const int32_t laid = solid->relief.count;
    int32_t halved = 1;
    /* Each round measures new triangles only (error < 0) and ends when none fails. Progress 1 - 8 / (8 + round) is an
       estimate: the number of rounds is unknown before. */
    for (int round = 0; halved > 0; round++) {
        int32_t *fresh = wr_try_alloc((size_t)solid->relief.count, sizeof *fresh, "a solid", err);
        if (!fresh) return false;
        RefineWork work = { solid, fresh, find_fresh(solid, fresh) };
        wr_pool_run(solid->pool, (work.count + PIECE - 1) / PIECE, measure_piece, &work);
        halved = wr_progress_stopped() ? 0 : halve_bad(solid, fresh, work.count);
        wr_free(fresh);
        if (!wr_progress_report(1.0 - 8.0 / (8.0 + round))) return wr_fail(err, "cancelled");
    }
    if (halved == 0) return settle(solid, err);
    return wr_export_solid_full(job, fitting_error(solid, laid), err);
}

/* ---- Back of a relief, walls around it, and caps over open ends: they close the mesh ---- */

/* Border of the relief: the next point along it, for each point; -1: inside. */
typedef struct Border {
    int32_t *next;  /* [points] */
    int32_t *start; /* [loops]: a point of each loop */
    int loops;
} Border;

/* ---- the border ---- */

static bool twice(WrError *err)
{
    return wr_fail(err, "the surface touches itself at its border: it cannot become a closed body");
}

/* Each border side a -> b follows its triangle's orientation, so a border point has one successor; a second one means that
   the surface touches itself at that point, and no wall can separate inside from outside there. */
static bool find_next(const WrSolid *s, Border *border, int32_t *count, WrError *err)
{
    memset(border->next, 0xff, (size_t)s->body.point_count * sizeof *border->next);
    for (int32_t i = 0; i < s->relief.count; i++)
        for (int k = 0; k < 3; k++) {
            const WrSolidTriangle *t = &s->relief.data[i];
            const int32_t a = t->point[(k + 1) % 3], b = t->point[(k + 2) % 3];
            if (t->across[k] >= 0 || a == b) continue;
            if (border->next[a] >= 0) return twice(err);
            border->next[a] = b;
            ++*count;
        }
    return true;
}

static bool find_border(const WrSolid *s, Border *border, WrError *err)
{
    const size_t points = (size_t)s->body.point_count;
    int32_t count = 0;
    border->next = wr_try_alloc(points, sizeof *border->next, "a solid", err);
    if (!border->next || !find_next(s, border, &count, err)) return false;
    bool *seen = wr_try_alloc(points, sizeof *seen, "a solid", err);
    border->start = wr_try_alloc((size_t)count + 1, sizeof *border->start, "a solid", err);
    bool good = seen && border->start;
    for (int32_t i = 0; i < s->body.point_count && good; i++) {
        if (border->next[i] < 0 || seen[i]) continue;
        border->start[border->loops++] = i;
        for (int32_t at = i; good && !seen[at]; at = border->next[at]) {
            seen[at] = true;
            good = border->next[at] >= 0 || twice(err);
        }
    }
    wr_free(seen);
    return good;
}

/* ---- (u,v) ---- */

static int32_t sights_end(const WrSolid *s, int32_t point)
{
    return point + 1 < s->first.count ? s->first.data[point + 1] : s->locations.count;
}

/* (u,v) of points a and b, neighbours on a border. A point on a seam has a sight at each end of u: the nearest pair is taken,
   so that u does not jump between a and b. */
static void side_locations(const WrSolid *s, int32_t a, int32_t b, WrSolidLocation out[2])
{
    double least = INFINITY;
    for (int32_t i = s->first.data[a]; i < sights_end(s, a); i++)
        for (int32_t j = s->first.data[b]; j < sights_end(s, b); j++) {
            const WrSolidLocation *p = &s->locations.data[i], *q = &s->locations.data[j];
            const double far = fabs(p->u - q->u) + fabs(p->v - q->v);
            if (least < INFINITY && !(far < least)) continue;
            least = far;
            out[0] = *p, out[1] = *q;
        }
}

static void triangle_locations(const WrSolidTriangle *t, WrSolidLocation out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (WrSolidLocation){ t->u[k], t->v[k], t->face };
}

/* ---- a fan over a loop ---- */

/* Centre of a loop of points, and its axis of rotation; `map` converts point numbers. The centre weighs sides by their
   length, so that it does not depend on the number of points; the axis is the sum of (p - m) x (q - m), twice the area vector
   of the loop. */
static WrVec3 middle_of_loop(const WrSolid *s, const Border *b, const int32_t *map, int32_t start,
                             WrVec3 *up)
{
    WrVec3 sum = { 0, 0, 0 };
    double whole = 0.0;
    int32_t i = start;
    do {
        const WrVec3 p = wr_solid_body_point(&s->body, map[i]),
                     q = wr_solid_body_point(&s->body, map[b->next[i]]);
        const double length = v3_len(v3_sub(q, p));
        sum = v3_add(sum, v3_scale(v3_add(p, q), length / 2));
        whole += length;
        i = b->next[i];
    } while (i != start);
    const WrVec3 middle = v3_scale(sum, 1.0 / whole);
    *up = (WrVec3){ 0, 0, 0 };
    do {
        const WrVec3 p = v3_sub(wr_solid_body_point(&s->body, map[i]), middle);
        *up = v3_add(*up,
                     v3_cross(p, v3_sub(wr_solid_body_point(&s->body, map[b->next[i]]), middle)));
        i = b->next[i];
    } while (i != start);
    return middle;
}

static void solid_add_triangle(WrSolid *solid, const int32_t corners[3],
                               const WrSolidLocation at[3]);

/* Adds triangles from all its sides to a point in its middle; false and none if that point does not see all of
   them. */
static bool fan(WrSolid *s, const Border *b, const int32_t *map, int32_t start)
{
    WrVec3 up;
    const WrVec3 middle = middle_of_loop(s, b, map, start, &up);
    const float at[3] = { (float)middle.x, (float)middle.y, (float)middle.z };
    const int32_t centre = wr_solid_body_add_point(&s->body, at);
    int32_t i = start;
    bool good = true;
    do {
        good =
            good && v3_dot(wr_solid_body_area(&s->body, map[i], map[b->next[i]], centre), up) > 0;
        i = b->next[i];
    } while (i != start);
    if (!good) {
        s->body.point_count--;
        return false;
    }
    do {
        WrSolidLocation uv[3];
        side_locations(s, b->next[i], i, uv);
        uv[2] = (WrSolidLocation){ (uv[0].u + uv[1].u) / 2, (uv[0].v + uv[1].v) / 2, uv[0].face };
        solid_add_triangle(s, (const int32_t[3]){ map[b->next[i]], map[i], centre }, uv);
        i = b->next[i];
    } while (i != start);
    return true;
}

/* ---- backs ---- */

static void solid_point_position(WrSolid *solid, const WrSolidLocation *locations, int count,
                                 bool back, float out[3]);

static int32_t add_back_point(WrSolid *s, int32_t of)
{
    const int32_t first = s->first.data[of];
    float at[3];
    solid_point_position(s, s->locations.data + first, sights_end(s, of) - first, true, at);
    return wr_solid_body_add_point(&s->body, at);
}

/* True if its back faces another way than the triangle. A mirrored object's triangles are clockwise. */
static bool folds(const WrSolid *s, const WrSolidTriangle *t, const int32_t *back)
{
    const double way = s->stretch.x * s->stretch.y * s->stretch.z;
    const int32_t *p = t->point;
    WrVec3 out = { 0, 0, 0 };
    for (int k = 0; k < 3; k++)
        out = v3_add(out, v3_sub(wr_solid_body_point(&s->body, p[k]),
                                 wr_solid_body_point(&s->body, back[p[k]])));
    return !(v3_dot(wr_solid_body_area(&s->body, back[p[0]], back[p[1]], back[p[2]]), out) * way >
             0);
}

static bool is_pole(const WrSolidTriangle *t)
{
    const int32_t *p = t->point;
    return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
}

/* Adds the relief's triangles again, at the back. */
static bool add_shell(WrSolid *s, int32_t *back, int32_t points, WrError *err)
{
    for (int32_t i = 0; i < points; i++)
        if (back[i] < 0) back[i] = add_back_point(s, i);
    for (int32_t i = 0; i < s->relief.count; i++) {
        const WrSolidTriangle *t = &s->relief.data[i];
        if (is_pole(t)) continue;
        if (i % 4096 == 0 && wr_progress_stopped()) return wr_fail(err, "cancelled");
        if (folds(s, t, back))
            return wr_fail(err,
                           "thickness=%.6g: too thick for the curvature of the surface: use less, "
                           "or 0 for a solid",
                           s->thickness);
        WrSolidLocation at[3];
        triangle_locations(t, at);
        solid_add_triangle(
            s, (const int32_t[3]){ back[t->point[1]], back[t->point[0]], back[t->point[2]] },
            (const WrSolidLocation[3]){ at[1], at[0], at[2] });
    }
    return true;
}

/* A wall is two triangles per border side, (b, a, a') and (b, a', b') with back points a', b'. Its (u,v) repeats that of the
   border: the wall has no area of its own in the texture. */
static void add_walls(WrSolid *s, const Border *border, const int32_t *back, int32_t points)
{
    for (int32_t a = 0; a < points; a++) {
        const int32_t b = border->next[a];
        if (b < 0) continue;
        WrSolidLocation at[2];
        side_locations(s, a, b, at);
        solid_add_triangle(s, (const int32_t[3]){ b, a, back[a] },
                           (const WrSolidLocation[3]){ at[1], at[0], at[0] });
        solid_add_triangle(s, (const int32_t[3]){ b, back[a], back[b] },
                           (const WrSolidLocation[3]){ at[1], at[0], at[1] });
    }
}

static bool add_back(WrSolid *s, const Border *border, WrError *err)
{
    const int32_t points = s->body.point_count;
    int32_t *back = wr_try_alloc((size_t)points, sizeof *back, "a solid", err);
    if (!back) return false;
    memset(back, 0xff, (size_t)points * sizeof *back);
    for (int32_t i = 0; i < points; i++)
        if (border->next[i] >= 0) back[i] = add_back_point(s, i);
    const bool flat = wr_surfaces[s->scene->shape.kind]->flat && border->loops == 1;
    const bool good =
        (flat && fan(s, border, back, border->start[0])) || add_shell(s, back, points, err);
    if (good) add_walls(s, border, back, points);
    wr_free(back);
    return good;
}

static bool add_caps(WrSolid *s, const Border *border, WrError *err)
{
    const int32_t points = s->body.point_count;
    int32_t *same = wr_try_alloc((size_t)points, sizeof *same, "a solid", err);
    if (!same) return false;
    for (int32_t i = 0; i < points; i++) same[i] = i;
    bool good = true;
    for (int l = 0; l < border->loops && good; l++)
        good =
            fan(s, border, same, border->start[l]) ||
            wr_fail(
                err,
                "an open end is not flat and cannot be closed: thickness=MM makes a wall instead");
    wr_free(same);
    return good;
}

/* ---- the body ---- */

static bool check_body(const WrSolid *s, WrError *err)
{
    for (int32_t i = 0; i < s->body.triangle_count; i++) {
        const int32_t *t = s->body.triangles[i];
        const WrVec3 n = wr_solid_body_area(&s->body, t[0], t[1], t[2]);
        if (!(v3_dot(n, n) > 0))
            return wr_fail(err, "the surface has a place without area and cannot become a closed "
                                "body; a larger error may avoid it");
    }
    return true;
}

/* Adds the back, and walls between it and the relief. */
static bool solid_close(WrSolid *solid, WrError *err)
{
    Border border = { 0 };
    for (int32_t i = 0; i < solid->relief.count; i++) {
        const WrSolidTriangle *t = &solid->relief.data[i];
        WrSolidLocation at[3];
        triangle_locations(t, at);
        if (!is_pole(t)) solid_add_triangle(solid, t->point, at);
    }
    bool good = find_border(solid, &border, err);
    if (good && border.loops > 0)
        good = solid->thickness > 0 ? add_back(solid, &border, err) : add_caps(solid, &border, err);
    wr_free(border.next);
    wr_free(border.start);
    good = good && check_body(solid, err) && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    if (good && wr_solid_body_volume(&solid->body) <
                    0.0) /* a mirrored object, or normals that point inwards */
        wr_solid_body_reverse(&solid->body);
    return good;
}

/* samples along each direction of a face, to find its size: they include quarters */
#define BOX_STEPS 64
#define SHARP                                                                                      \
    0.0625 /* of |mean normal|^2, at least: a point is displaced by at most 16 times its height */
#define SHEET 2.0 /* mm: default thickness of an open surface */

/* ---- displaced points ---- */

/* Approximate d with n . d = f for all of several normals: mean f along the mean normal m, over |m|^2. */
static WrVec3 moved(WrVec3 normals, double f, int count)
{
    const WrVec3 m = v3_scale(normals, 1.0 / count);
    return v3_scale(m, f / count / fmax(v3_dot(m, m), SHARP));
}

static double height_at(WrSolid *s, const WrSolidLocation *at)
{
    double f;
    wr_scene_height(s->scene, s->field, at->u, at->v, &f, NULL, NULL);
    s->low = fmin(s->low, f);
    s->high = fmax(s->high, f);
    return f;
}

/* Position of a point in the file, from its sights. With `back` at the lowest height, and `thickness` below
   that.
   A point seen from several faces or sides of a seam is displaced along all of its normals n_i: the d of least squares with
   n_i . d = f. At the back, f is the lowest height, and `across` shifts the point by the thickness along the normals of the
   scaled object (cofactor n, NUMERICS.md HC33). */
static void solid_point_position(WrSolid *solid, const WrSolidLocation *locations, int count,
                                 bool back, float out[3])
{
    WrVec3 p = { 0, 0, 0 }, n = p, across = p;
    double f = 0.0;
    for (int i = 0; i < count; i++) {
        WrSurfacePoint o;
        wr_surface_at(&solid->scene->shape, locations[i].face, locations[i].u, locations[i].v, &o);
        p = v3_add(p, o.p);
        n = v3_add(n, o.n_unit);
        const WrVec3 c = { solid->cofactor.x * o.n_unit.x, solid->cofactor.y * o.n_unit.y,
                           solid->cofactor.z * o.n_unit.z };
        across = v3_add(across, v3_unit(c, o.n_unit));
        f += back ? solid->low : height_at(solid, &locations[i]);
    }
    p = v3_add(v3_scale(p, 1.0 / count), moved(n, f, count));
    const WrVec3 at = { (solid->stretch.x * p.x - solid->middle.x) * solid->scale,
                        (solid->stretch.y * p.y - solid->middle.y) * solid->scale,
                        (solid->stretch.z * p.z - solid->middle.z) * solid->scale };
    const WrVec3 under =
        back ? moved(across, -solid->thickness * count, count) : (WrVec3){ 0, 0, 0 };
    const WrVec3 end = v3_add(at, under);
    out[0] = (float)end.x, out[1] = (float)end.y, out[2] = (float)end.z;
}

/* Adds a point with these sights; returns its number. */
static int32_t solid_add_point(WrSolid *solid, const WrSolidLocation *locations, int count)
{
    float at[3];
    wr_array_push(&solid->first, solid->locations.count);
    for (int i = 0; i < count; i++) wr_array_push(&solid->locations, locations[i]);
    solid_point_position(solid, locations, count, false, at);
    return wr_solid_body_add_point(&solid->body, at);
}

/* at: (u,v) of the corners. */
static void solid_add_triangle(WrSolid *solid, const int32_t corners[3],
                               const WrSolidLocation at[3])
{
    float uv[3][2];
    for (int k = 0; k < 3; k++) {
        uv[k][0] = (float)(at[k].u * solid->scene->replicate_u);
        uv[k][1] = (float)(at[k].v * solid->scene->replicate_v);
    }
    wr_solid_body_add_triangle(&solid->body, corners, uv);
}

/* ---- the scene in millimetres ---- */

static void grow(WrVec3 *low, WrVec3 *high, WrVec3 p)
{
    *low = (WrVec3){ fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z) };
    *high = (WrVec3){ fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z) };
}

/* Scales the longest side of the smooth surface to `size`, and moves its middle to the origin. */
static void set_scale(WrSolid *s)
{
    WrVec3 low = { INFINITY, INFINITY, INFINITY }, high = { -INFINITY, -INFINITY, -INFINITY };
    for (int face = 0; face < s->faces; face++) {
        const WrSurfaceCell c = wr_surface_cell(&s->scene->shape, face);
        for (int k = 0; k < (BOX_STEPS + 1) * (BOX_STEPS + 1); k++) {
            const double i = k % (BOX_STEPS + 1), j = k / (BOX_STEPS + 1);
            WrSurfacePoint o;
            wr_surface_at(&s->scene->shape, face, c.u0 + (c.u1 - c.u0) * i / BOX_STEPS,
                          c.v0 + (c.v1 - c.v0) * j / BOX_STEPS, &o);
            grow(&low, &high,
                 (WrVec3){ s->stretch.x * o.p.x, s->stretch.y * o.p.y, s->stretch.z * o.p.z });
        }
    }
    const WrVec3 d = v3_sub(high, low);
    s->middle = v3_scale(v3_add(low, high), 0.5);
    s->scale = s->true_width > 0 ? s->true_width / d.x : s->size / fmax(d.x, fmax(d.y, d.z));
}

/* A plane has its cells' width and height, if they are stated in millimetres. */
static WrScene *true_scene(const WrExportJob *job, WrSolid *s)
{
    const WrScene *scene = job->scene;
    if (!scene->cell.mm || job->options.solid_size > 0 || scene->shape.kind != WR_SURFACE_plane)
        return NULL;
    s->true_width = scene->cell.w * fabs(scene->replicate_u);
    if (!(s->true_width > 0)) return NULL;
    set_scale(s);
    WrScene *own = wr_scene_clone(scene);
    own->height = scene->cell.height / s->scale;
    return own;
}

#define FITTING_TRIES 8

static bool check(const WrExportJob *job, WrError *err)
{
    const WrExportOptions *o = &job->options;
    if (o->solid_thickness > 0 && wr_surfaces[job->scene->shape.kind]->held)
        return wr_fail(err,
                       "thickness=%.6g: only for parametric surfaces, not for meshes: leave it out",
                       o->solid_thickness);
    if (!(o->solid_size >= 0) || !(o->solid_error > 0) || o->solid_thickness < 0)
        return wr_fail(err, "size %g, error %g, thickness %g: must be above 0, in millimetres",
                       o->solid_size, o->solid_error, o->solid_thickness);
    return true;
}

/* A tube is filled unless a thickness is given; a sheet must have one. */
static double thickness_of(const WrExportJob *job)
{
    const double requested = job->options.solid_thickness;
    return requested > 0.0 || !wr_surfaces[job->scene->shape.kind]->open ? requested : SHEET;
}

/* ---- the export ---- */

static bool make(WrSolid *s, WrExportJob *job, WrError *err)
{
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.4);
    bool good = solid_sample(s, err);
    wr_progress_set(whole);
    if (!good) return false;
    solid_lay(s);
    wr_progress_enter(&part, 0.4, 1.0);
    good = solid_refine(s, job, err);
    wr_progress_set(whole);
    return good && solid_close(s, err);
}

static void free_solid(WrSolid *s)
{
    for (int face = 0; face < WR_SOLID_FACES; face++) wr_free(s->lattice[face].at);
    wr_array_free(&s->relief);
    wr_array_free(&s->locations);
    wr_array_free(&s->first);
    wr_solid_body_fini(&s->body);
}

static void report_body(WrExportJob *job, const WrSolidBody *body)
{
    WrVec3 low, high;
    wr_solid_body_bounds(body, &low, &high);
    job->report.triangles = body->triangle_count;
    job->report.solid_allowed = job->options.solid_error;
    job->report.solid_volume = job->report.solid_open ? 0.0 : wr_solid_body_volume(body);
    job->report.solid_size[0] = high.x - low.x;
    job->report.solid_size[1] = high.y - low.y;
    job->report.solid_size[2] = high.z - low.z;
}

/* A surface by a formula. */
static bool make_solid(WrExportJob *job, WrSolidBody *body, WrError *err)
{
    WrSolid s = { .scene = job->scene,
                  .field = job->field,
                  .pool = job->pool,
                  .size = job->options.solid_size > 0 ? job->options.solid_size : 100,
                  .error = job->options.solid_error,
                  .most = job->options.solid_most,
                  .thickness = thickness_of(job),
                  .faces = wr_surfaces[job->scene->shape.kind]->faces,
                  .low = INFINITY,
                  .high = -INFINITY };
    wr_scene_stretch(job->scene, &s.stretch, &s.cofactor);
    WrScene *own = true_scene(job, &s);
    if (own) s.scene = own;
    else set_scale(&s);
    const bool good = make(&s, job, err);
    job->report.solid_error = s.worst;
    job->report.solid_relief = (s.high - s.low) * s.scale;
    job->report.low = s.low;
    job->report.high = s.high;
    *body = s.body;
    s.body = (WrSolidBody){ 0 };
    free_solid(&s);
    wr_scene_free(own);
    return good;
}

static bool make_any(WrExportJob *job, WrSolidBody *body, WrError *err)
{
    job->solid_guess = 0.0;
    return wr_surfaces[job->scene->shape.kind]->held ? wr_mesh_solid_make(job, body, err)
                                                     : make_solid(job, body, err);
}

bool wr_export_solid_full(WrExportJob *job, double guess, WrError *err)
{
    job->solid_guess = guess;
    return wr_fail(err,
                   "error=%.6g mm needs more than %d triangles: give a larger error, a smaller "
                   "size, or more triangles=",
                   job->options.solid_error, job->options.solid_most);
}

/* Two digits, rounded up, as the message prints and the option reads them. */
static double round_up(double x)
{
    const double unit = pow(10.0, floor(log10(x)) - 1.0);
    char text[32];
    snprintf(text, sizeof text, "%.2g", ceil(x / unit - 1e-9) * unit);
    wr_number_parse(text, strlen(text), &x);
    return x;
}

/* After a failure with too many triangles: tries errors from the guess on, and names the first that fits. */
static bool name_fitting(const WrExportJob *job, WrError *err)
{
    const double asked = job->options.solid_error;
    double error = job->solid_guess;
    for (int i = 0; i < FITTING_TRIES && error < INFINITY; i++) {
        WrExportJob trial = *job;
        WrSolidBody body = { 0 };
        WrError failed;
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, 1.0 - 1.0 / (2 << i), 1.0 - 1.0 / (4 << i));
        trial.options.solid_error = round_up(error);
        const bool good = make_any(&trial, &body, &failed);
        wr_solid_body_fini(&body);
        wr_progress_set(whole);
        if (good)
            return wr_fail(err,
                           "error=%.6g mm needs more than %d triangles: give error=%.6g, a smaller "
                           "size, or more triangles=",
                           asked, job->options.solid_most, trial.options.solid_error);
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
        if (!(trial.solid_guess > 0.0)) break; /* another failure */
        error = fmax(1.3 * error, trial.solid_guess);
    }
    return false;
}

bool wr_export_solid_make(WrExportJob *job, WrSolidBody *body, WrError *err)
{
    if (!check(job, err)) return false;
    if (!make_any(job, body, err)) return job->solid_guess > 0.0 && name_fitting(job, err);
    report_body(job, body);
    return true;
}

bool wr_export_solid_write(WrExportJob *job, const char *path, WrError *err)
{
    WrSolidBody body = { 0 };
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.7);
    bool good = wr_export_solid_make(job, &body, err);
    wr_progress_set(whole);
    if (good) {
        wr_progress_enter(&part, 0.7, 1.0);
        good = wr_solid_body_write(&body, job->kind->ending, path, err);
        wr_progress_set(whole);
    }
    wr_solid_body_fini(&body);
    return good;
}
