/* Boxes: a cell is evaluated at 3 x 3 points. The bilinear patches of its four quarters are inside the box of
   these points, and the surface within (|P'uu| du^2 + 2 |P'uv| du dv + |P'vv| dv^2) / 8 of them. The second
   derivatives are estimated from the change of the first ones between the points. */
#include "render/reference/reference_displaced.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/vec.h"

#include <math.h>
#include <stdint.h>

/* Floats, rounded outwards. */
typedef struct WrRaisedBox {
    float low[3], high[3];
    /* of a cell: largest sine of the angle between its normals and the middle one; 2: unknown */
    float sine;
} WrRaisedBox;

typedef enum WrRaisedKind {
    WR_RAISED_FACE,
    /* along an edge: its first parameter follows the edge, its second leads across */
    WR_RAISED_STRIP,
    WR_RAISED_CORNER /* of three faces: the parallelogram between two strips' ends */
} WrRaisedKind;

/* An edge of a face: 0 v lowest, 1 v highest, 2 u lowest, 3 u highest. */
typedef struct WrRaisedEdge {
    int face, side;
    bool back; /* it runs in the opposite direction */
} WrRaisedEdge;

#define WR_RAISED_LEVELS 24
struct WrRaisedSheet {
    WrRaisedKind kind;
    WrSurfaceCell domain;    /* of its parameters */
    WrRaisedEdge edge, mate; /* a strip's own edge, and the one that it connects to */
    int face;
    double u, v;             /* a corner's position ... */
    WrVec3 p, across, aside; /* ... and its parallelogram */
    int nu, nv, levels;
    WrRaisedBox *boxes[WR_RAISED_LEVELS]; /* [ceil(nu / 2^l) * ceil(nv / 2^l)]; owned */
};

typedef struct WrRaisedPoint {
    WrVec3 p, pu, pv;
} WrRaisedPoint;

/* Finds strips and corners where sheets separate: at most WR_RAISED_JOINTS into out; returns their number. */
#define WR_RAISED_JOINTS 128

/* ---- edges ---- */

/* Closing pieces of a displaced surface where its domain ends: strips along edges shared by two sheets, and
   corners of a cube. */

#define SIDES 4
#define LOOKS 64      /* test points along an edge for a gap between the sheets */
#define ALIKE 1e-6    /* tolerance of equal positions, in sizes of the object */
#define PARTED 1e-9   /* tolerance of equal heights */
#define PARALLEL 1e-9 /* tolerance: 1 minus the cosine of two normals */
#define STEP 1e-5     /* step of a difference along an edge */

typedef struct End {
    WrVec3 p, n;
    double f, u, v;
} End;

/* u and v of the patch at t, 0..1, along an edge. */
static void raised_edge_at(const WrReferenceRaised *raised, WrRaisedEdge edge, double t, double *u,
                           double *v)
{
    const WrSurfaceCell c = wr_surface_cell(raised->shape, edge.face);
    const double along = edge.back ? 1 - t : t;
    *u = edge.side == 2 ? c.u0 : edge.side == 3 ? c.u1 : c.u0 + along * (c.u1 - c.u0);
    *v = edge.side == 0 ? c.v0 : edge.side == 1 ? c.v1 : c.v0 + along * (c.v1 - c.v0);
}

static End end_of(const WrReferenceRaised *raised, WrRaisedEdge edge, double t)
{
    WrSurfacePoint at;
    End end;
    double fu, fv;
    raised_edge_at(raised, edge, t, &end.u, &end.v);
    wr_surface_at(raised->shape, edge.face, end.u, end.v, &at);
    raised->height(raised->ctx, end.u, end.v, &end.f, &fu, &fv);
    end.p = at.p, end.n = at.n_unit;
    return end;
}

/* Displacement of a point shared by two sheets: onto both their planes; if those are almost parallel, the mean
   displacement. */
static WrVec3 shared(const End *a, const End *b)
{
    const double c = v3_dot(a->n, b->n), most = fmax(fabs(a->f), fabs(b->f));
    const double left = 1 - c * c;
    if (left > PARALLEL) {
        const WrVec3 d = v3_add(v3_scale(a->n, (a->f - c * b->f) / left),
                                v3_scale(b->n, (b->f - c * a->f) / left));
        if (v3_len(d) <= 2 * most) return d;
    }
    const WrVec3 none = { 0, 0, 0 };
    return v3_scale(v3_unit(v3_add(a->n, b->n), none), (a->f + b->f) / 2);
}

/* Start and end of a strip at t. */
static void strip_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double t,
                     WrVec3 *from, WrVec3 *to)
{
    const End a = end_of(raised, sheet->edge, t), b = end_of(raised, sheet->mate, t);
    *from = v3_mad(a.p, a.n, a.f);
    *to = v3_add(a.p, shared(&a, &b));
}

/* As wr_raised_at, for strips and corners. */
static void raised_joint_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                            double v, WrRaisedPoint *out)
{
    if (sheet->kind == WR_RAISED_CORNER) {
        *out = (WrRaisedPoint){ v3_mad(v3_mad(sheet->p, sheet->across, u), sheet->aside, v),
                                sheet->across, sheet->aside };
        return;
    }
    WrVec3 from, to, low[2], high[2];
    const double below = fmax(u - STEP, 0), above = fmin(u + STEP, 1);
    strip_at(raised, sheet, u, &from, &to);
    strip_at(raised, sheet, below, &low[0], &low[1]);
    strip_at(raised, sheet, above, &high[0], &high[1]);
    out->pv = v3_sub(to, from);
    out->p = v3_mad(from, out->pv, v);
    const WrVec3 a = v3_sub(high[0], low[0]), b = v3_sub(high[1], low[1]);
    out->pu = v3_scale(v3_mad(a, v3_sub(b, a), v), 1 / (above - below));
}

static bool same_place(const WrReferenceRaised *raised, WrVec3 a, WrVec3 b)
{
    return v3_len(v3_sub(a, b)) < ALIKE * raised->size;
}

/* True if both are one edge in space, in equal or opposite direction. */
static bool mates(const WrReferenceRaised *raised, WrRaisedEdge a, WrRaisedEdge *b)
{
    const double t[2] = { 0.287, 0.731 };
    for (int back = 0; back < 2; back++) {
        b->back = back == 1;
        bool same = true;
        for (int k = 0; k < 2; k++)
            same =
                same && same_place(raised, end_of(raised, a, t[k]).p, end_of(raised, *b, t[k]).p);
        if (same) return true;
    }
    return false;
}

/* True if it is an edge, not a point, and the strip along it has a width. */
static bool parts(const WrReferenceRaised *raised, const WrRaisedSheet *sheet)
{
    if (same_place(raised, end_of(raised, sheet->edge, 0.287).p,
                   end_of(raised, sheet->edge, 0.731).p))
        return false;
    for (int k = 0; k <= LOOKS; k++) {
        WrVec3 from, to;
        strip_at(raised, sheet, (double)k / LOOKS, &from, &to);
        if (v3_len(v3_sub(to, from)) > PARTED * raised->size) return true;
    }
    return false;
}

static WrRaisedEdge edge_number(int k)
{
    return (WrRaisedEdge){ .face = k / SIDES, .side = k % SIDES };
}

static int find_strips(const WrReferenceRaised *raised, WrRaisedSheet *out)
{
    const int edges = SIDES * wr_surfaces[raised->shape->kind]->faces;
    int count = 0;
    for (int i = 0; i < edges; i++)
        for (int k = 0; k < edges; k++) {
            WrRaisedSheet strip = { .kind = WR_RAISED_STRIP,
                                    .domain = { 0, 1, 0, 1 },
                                    .edge = edge_number(i),
                                    .mate = edge_number(k) };
            strip.face = strip.edge.face;
            if (k == i || !mates(raised, strip.edge, &strip.mate) || !parts(raised, &strip))
                continue;
            if (count < WR_RAISED_JOINTS / 2) out[count++] = strip;
        }
    return count;
}

/* The corner piece between the ends of two strips of one face. */
static bool corner_of(const WrReferenceRaised *raised, const WrRaisedSheet *a,
                      const WrRaisedSheet *b, int which, WrRaisedSheet *out)
{
    const double s = which % 2, t = (double)(which / 2);
    const End at = end_of(raised, a->edge, s), other = end_of(raised, b->edge, t);
    if (!same_place(raised, at.p, other.p)) return false;
    WrVec3 from, to, aside;
    strip_at(raised, a, s, &from, &to);
    *out = (WrRaisedSheet){ .kind = WR_RAISED_CORNER,
                            .domain = { 0, 1, 0, 1 },
                            .face = a->edge.face,
                            .u = at.u,
                            .v = at.v,
                            .p = from,
                            .across = v3_sub(to, from) };
    strip_at(raised, b, t, &from, &aside);
    out->aside = v3_sub(aside, from);
    return v3_len(v3_cross(out->across, out->aside)) > 0;
}

static int raised_joints(const WrReferenceRaised *raised, WrRaisedSheet out[WR_RAISED_JOINTS])
{
    const int strips = find_strips(raised, out);
    int count = strips;
    for (int i = 0; i < strips; i++)
        for (int k = i + 1; k < strips; k++)
            for (int which = 0; which < 4 && count < WR_RAISED_JOINTS; which++)
                if (out[i].edge.face == out[k].edge.face &&
                    corner_of(raised, &out[i], &out[k], which, &out[count]))
                    count++;
    return count;
}

#define SAFETY 2.0 /* for bends measured at 3 x 3 points */
#define ROUND 48   /* minimum number of cells along a whole curved surface */
#define STEPS 24   /* maximum steps of Newton's method */
#define SETTLED 1e-12
#define TOUCHES                                                                                    \
    1e-13 /* in sizes of the object: a point this near the ray is a hit even if steps remain longer */
#define UNDECIDED 1e-10
#define SLACK 1e-7 /* of a cell: extension beyond its border, so that no hit is lost between two */

static void raised_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                      double v, WrRaisedPoint *out)
{
    if (sheet->kind != WR_RAISED_FACE) {
        raised_joint_at(raised, sheet, u, v, out);
        return;
    }
    WrSurfacePoint at;
    double f, fu, fv;
    wr_surface_at(raised->shape, sheet->face, u, v, &at);
    raised->height(raised->ctx, u, v, &f, &fu, &fv);
    out->p = v3_mad(at.p, at.n_unit, f);
    out->pu = v3_mad(v3_mad(at.pu, at.n_unit, fu), at.n_u, f);
    out->pv = v3_mad(v3_mad(at.pv, at.n_unit, fv), at.n_v, f);
}

/* Converts the sheet's parameters to a position on the surface. */
static void raised_place(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                         double v, WrReferenceHit *hit)
{
    hit->face = sheet->kind == WR_RAISED_STRIP ? sheet->edge.face : sheet->face;
    hit->u = u, hit->v = v;
    if (sheet->kind == WR_RAISED_STRIP) raised_edge_at(raised, sheet->edge, u, &hit->u, &hit->v);
    if (sheet->kind == WR_RAISED_CORNER) hit->u = sheet->u, hit->v = sheet->v;
}

/* ---- boxes ---- */

static void include(WrVec3 *low, WrVec3 *high, WrVec3 p)
{
    *low = (WrVec3){ fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z) };
    *high = (WrVec3){ fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z) };
}

static float outward(double x, float towards)
{
    const float near = (float)x;
    return (towards < 0 ? (double)near <= x : (double)near >= x) ? near : nextafterf(near, towards);
}

static WrRaisedBox box_of(WrVec3 low, WrVec3 high, double grow, double sine)
{
    const double a[3] = { low.x, low.y, low.z }, b[3] = { high.x, high.y, high.z };
    WrRaisedBox box = { .sine = (float)sine };
    for (int k = 0; k < 3; k++) {
        box.low[k] = outward(a[k] - grow, -INFINITY);
        box.high[k] = outward(b[k] + grow, INFINITY);
    }
    return box;
}

/* Largest change of the tangents between neighbouring points: along rows of 3 if by is 1, along columns if 3. */
static double change(const WrVec3 *t, int by)
{
    double most = 0;
    for (int k = 0; k < 9; k++)
        if (by == 1 ? k % 3 < 2 : k < 6) most = fmax(most, v3_len(v3_sub(t[k + by], t[k])));
    return most;
}

static double spread_of(const WrVec3 *pu, const WrVec3 *pv)
{
    const WrVec3 none = { 0, 0, 0 }, middle = v3_unit(v3_cross(pu[4], pv[4]), none);
    double most = 0;
    for (int k = 0; k < 9; k++) {
        const WrVec3 n = v3_unit(v3_cross(pu[k], pv[k]), none);
        const double along = v3_dot(n, middle);
        most = fmax(most, along > 0.1 ? v3_len(v3_cross(n, middle)) : 2);
    }
    return 1.2 * most + 0.01;
}

static WrRaisedBox measure(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, int i,
                           int j)
{
    const WrSurfaceCell *d = &sheet->domain;
    const double du = (d->u1 - d->u0) / sheet->nu, dv = (d->v1 - d->v0) / sheet->nv;
    WrVec3 pu[9], pv[9], low, high;
    for (int k = 0; k < 9; k++) {
        WrRaisedPoint at;
        raised_at(raised, sheet, d->u0 + (i + k % 3 / 2.0) * du,
                  d->v0 + (j + (double)(k / 3) / 2) * dv, &at);
        if (k == 0) low = high = at.p;
        include(&low, &high, at.p);
        pu[k] = at.pu, pv[k] = at.pv;
    }
    const double bend =
        (change(pu, 1) * du + change(pu, 3) * du + change(pv, 1) * dv + change(pv, 3) * dv) / 2;
    return box_of(low, high, SAFETY * bend / 8 + 1e-12 * raised->size, spread_of(pu, pv));
}

static int halved(int n, int level)
{
    return (int)(((int64_t)n + ((int64_t)1 << level) - 1) >> level);
}

typedef struct Building {
    const WrReferenceRaised *raised;
    WrRaisedSheet *sheet;
} Building;

static void measure_row(int j, int worker, void *ctx)
{
    (void)worker;
    const Building *b = ctx;
    for (int i = 0; i < b->sheet->nu; i++)
        b->sheet->boxes[0][(size_t)j * (size_t)b->sheet->nu + (size_t)i] =
            measure(b->raised, b->sheet, i, j);
}

static WrRaisedBox join(const WrRaisedBox *a, const WrRaisedBox *b)
{
    WrRaisedBox box = { .sine = 2 };
    for (int k = 0; k < 3; k++) {
        box.low[k] = fminf(a->low[k], b->low[k]);
        box.high[k] = fmaxf(a->high[k], b->high[k]);
    }
    return box;
}

static void join_level(WrRaisedSheet *sheet, int level)
{
    const int wide = halved(sheet->nu, level), high = halved(sheet->nv, level);
    const int below = halved(sheet->nu, level - 1), rows = halved(sheet->nv, level - 1);
    for (int j = 0; j < high; j++)
        for (int i = 0; i < wide; i++) {
            const WrRaisedBox *from =
                sheet->boxes[level - 1] + (size_t)2 * (size_t)j * below + 2 * i;
            WrRaisedBox box = from[0];
            if (2 * i + 1 < below) box = join(&box, from + 1);
            if (2 * j + 1 < rows) box = join(&box, from + below);
            if (2 * i + 1 < below && 2 * j + 1 < rows) box = join(&box, from + below + 1);
            sheet->boxes[level][(size_t)j * (size_t)wide + (size_t)i] = box;
        }
}

static bool build(const WrReferenceRaised *raised, WrRaisedSheet *sheet, WrPool *pool, WrError *err)
{
    for (sheet->levels = 0; sheet->levels < WR_RAISED_LEVELS;) {
        const int level = sheet->levels++;
        const size_t wide = (size_t)halved(sheet->nu, level);
        const size_t high = (size_t)halved(sheet->nv, level);
        sheet->boxes[level] =
            wr_try_alloc(wide * high, sizeof(WrRaisedBox), "the reference's cells", err);
        if (!sheet->boxes[level]) return false;
        if (wide == 1 && high == 1) break;
    }
    Building building = { raised, sheet };
    wr_pool_run(pool, sheet->nv, measure_row, &building);
    for (int level = 1; level < sheet->levels; level++) join_level(sheet, level);
    return true;
}

/* ---- construction ---- */

static int cells_of(const WrReferenceRaised *raised, double share, double cells)
{
    const WrInversion way = wr_surfaces[raised->shape->kind]->inversion;
    const double least = way == WR_INVERT_PLANE || way == WR_INVERT_CUBE ? 1 : ROUND;
    return (int)fmin(fmax(ceil(share * cells), least), 2.0 * WR_RAISED_MAX);
}

static bool cut_sheets(WrReferenceRaised *raised, const double cells[2], WrError *err)
{
    double all = 0;
    for (int i = 0; i < raised->count; i++) {
        WrRaisedSheet *sheet = &raised->sheets[i];
        const WrSurfaceCell *d = &sheet->domain;
        const bool upright = sheet->kind == WR_RAISED_STRIP && sheet->edge.side >= 2;
        sheet->nu = cells_of(raised, d->u1 - d->u0, cells[upright]);
        sheet->nv = sheet->kind == WR_RAISED_FACE ? cells_of(raised, d->v1 - d->v0, cells[1]) : 1;
        if (sheet->kind == WR_RAISED_CORNER) sheet->nu = 1;
        all += (double)sheet->nu * sheet->nv;
    }
    if (all <= WR_RAISED_MAX) return true;
    return wr_fail(err,
                   "the reference renders a displaced surface of at most %d texels, repeats "
                   "counted: this one has %.0f",
                   WR_RAISED_MAX, all);
}

bool wr_reference_raised_init(WrReferenceRaised *raised, const WrShape *shape,
                              WrReferenceHeight *height, const void *ctx, const double cells[2],
                              WrPool *pool, WrError *err)
{
    const int faces = wr_surfaces[shape->kind]->faces;
    *raised = (WrReferenceRaised){
        .shape = shape, .height = height, .ctx = ctx, .size = wr_shape_radius(shape)
    };
    raised->sheets = wr_alloc((size_t)faces + WR_RAISED_JOINTS, sizeof *raised->sheets);
    for (int face = 0; face < faces; face++)
        raised->sheets[face] =
            (WrRaisedSheet){ .face = face, .domain = wr_surface_cell(shape, face) };
    raised->count = faces + raised_joints(raised, raised->sheets + faces);
    if (!cut_sheets(raised, cells, err)) return false;
    for (int i = 0; i < raised->count; i++)
        if (!build(raised, &raised->sheets[i], pool, err)) return false;
    return true;
}

void wr_reference_raised_fini(WrReferenceRaised *raised)
{
    for (int i = 0; i < raised->count; i++)
        for (int level = 0; level < raised->sheets[i].levels; level++)
            wr_free(raised->sheets[i].boxes[level]);
    wr_free(raised->sheets);
    *raised = (WrReferenceRaised){ 0 };
}

/* ---- ray search ---- */

typedef struct Search {
    const WrReferenceRaised *raised;
    const WrRaisedSheet *sheet;
    const WrReferenceRay *ray;
    double length;     /* of the ray's direction */
    double inverse[3]; /* 1 / direction, for each component */
    bool found;
    WrReferenceHit best;
} Search;

/* Ray parameter at which the box is entered, or INFINITY. */
static double enters(const Search *search, const WrRaisedBox *box)
{
    const double q[3] = { search->ray->q.x, search->ray->q.y, search->ray->q.z };
    double in = -INFINITY, out = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double a = ((double)box->low[k] - q[k]) * search->inverse[k];
        const double b = ((double)box->high[k] - q[k]) * search->inverse[k];
        in = fmax(in, fmin(a, b)), out = fmin(out, fmax(a, b));
    }
    return in <= out && out > search->ray->s_min ? in : INFINITY;
}

typedef struct Cell {
    double u0, v0, du, dv;
} Cell;

static void offer(Search *search, const Cell *c, const WrRaisedPoint *at, double u, double v,
                  bool lost)
{
    const WrReferenceRay *ray = search->ray;
    const double x = (u - c->u0) / c->du, y = (v - c->v0) / c->dv;
    if (!(x >= -SLACK && x <= 1 + SLACK && y >= -SLACK && y <= 1 + SLACK)) return;
    const double s = v3_dot(v3_sub(at->p, ray->q), ray->d) / (search->length * search->length);
    if (!(s > ray->s_min) || (search->found && s >= search->best.s)) return;
    search->found = true;
    search->best = (WrReferenceHit){ .s = s, .lost = lost };
    raised_place(search->raised, search->sheet, u, v, &search->best);
}

/* Newton's method from (u, v); most: longest step, in cells. */
static void solve(Search *search, const Cell *c, double u, double v, double most)
{
    const WrReferenceRay *ray = search->ray;
    const double size = search->raised->size;
    WrRaisedPoint at;
    double du = 0, dv = 0, nearest = INFINITY, off = INFINITY;
    for (int k = 0, stalled = 0; k < STEPS && stalled < 3; k++) {
        raised_at(search->raised, search->sheet, u, v, &at);
        off = v3_len(v3_cross(v3_sub(at.p, ray->q), ray->d)) / search->length;
        stalled = off < 0.5 * nearest ? 0 : stalled + 1;
        nearest = fmin(nearest, off);
        if (!wr_reference_newton_step(ray, at.p, at.pu, at.pv, &du, &dv)) break;
        if (fabs(du) + fabs(dv) < SETTLED) {
            offer(search, c, &at, u, v, false);
            return;
        }
        const double reach = fmax(fabs(du) / c->du, fabs(dv) / c->dv);
        const double share = reach > most ? most / reach : 1;
        u += share * du, v += share * dv;
        if (fabs((u - c->u0) / c->du - 0.5) > 2.5 || fabs((v - c->v0) / c->dv - 0.5) > 2.5) return;
    }
    if (off < UNDECIDED * size) offer(search, c, &at, u, v, !(off < TOUCHES * size));
}

static void try_cell(Search *search, const WrRaisedBox *box, int i, int j)
{
    const WrRaisedSheet *sheet = search->sheet;
    const WrSurfaceCell *d = &sheet->domain;
    const double du = (d->u1 - d->u0) / sheet->nu, dv = (d->v1 - d->v0) / sheet->nv;
    const Cell c = { d->u0 + i * du, d->v0 + j * dv, du, dv };
    const double u = c.u0 + du / 2, v = c.v0 + dv / 2;
    if (box->sine < 1) {
        WrRaisedPoint at;
        raised_at(search->raised, sheet, u, v, &at);
        const WrVec3 n = v3_cross(at.pu, at.pv);
        if (fabs(v3_dot(n, search->ray->d)) > (double)box->sine * v3_len(n) * search->length) {
            solve(search, &c, u, v, 2);
            return;
        }
    }
    static const double starts[5][2] = {
        { 0, 0 }, { -0.25, -0.25 }, { 0.25, 0.25 }, { -0.25, 0.25 }, { 0.25, -0.25 }
    };
    for (int k = 0; k < 5; k++)
        solve(search, &c, u + starts[k][0] * du, v + starts[k][1] * dv, 0.5);
}

typedef struct Entry {
    int level, i, j;
    double from;
} Entry;

/* Pushes the box's four children onto the stack, the farthest first. */
static int push_children(const Search *search, const Entry *at, Entry *stack, int depth)
{
    const WrRaisedSheet *sheet = search->sheet;
    const int level = at->level - 1, wide = halved(sheet->nu, level);
    const int high = halved(sheet->nv, level), first = depth;
    for (int k = 0; k < 4; k++) {
        const int i = 2 * at->i + k % 2, j = 2 * at->j + k / 2;
        if (i >= wide || j >= high) continue;
        const Entry e = {
            level, i, j, enters(search, &sheet->boxes[level][(size_t)j * (size_t)wide + (size_t)i])
        };
        if (!(e.from < INFINITY)) continue;
        int to = depth++;
        for (; to > first && stack[to - 1].from < e.from; to--) stack[to] = stack[to - 1];
        stack[to] = e;
    }
    return depth;
}

static void look_through(Search *search)
{
    const WrRaisedSheet *sheet = search->sheet;
    Entry stack[4 * WR_RAISED_LEVELS];
    int depth = 1;
    stack[0] = (Entry){ sheet->levels - 1, 0, 0, enters(search, sheet->boxes[sheet->levels - 1]) };
    while (depth > 0) {
        const Entry at = stack[--depth];
        if (!(at.from < INFINITY) || (search->found && at.from > search->best.s)) continue;
        if (at.level > 0) depth = push_children(search, &at, stack, depth);
        else
            try_cell(search, &sheet->boxes[0][(size_t)at.j * (size_t)sheet->nu + (size_t)at.i],
                     at.i, at.j);
    }
}

static double reciprocal(double d)
{
    return fabs(d) > 1e-150 ? 1 / d : d < 0 ? -1e150 : 1e150;
}

bool wr_reference_raised_hit(const WrReferenceRaised *raised, const WrReferenceRay *ray,
                             WrReferenceHit *hit)
{
    Search search = { .raised = raised, .ray = ray, .length = v3_len(ray->d) };
    search.inverse[0] = reciprocal(ray->d.x);
    search.inverse[1] = reciprocal(ray->d.y);
    search.inverse[2] = reciprocal(ray->d.z);
    for (int i = 0; i < raised->count; i++) {
        search.sheet = &raised->sheets[i];
        look_through(&search);
    }
    if (search.found) *hit = search.best;
    return search.found;
}
