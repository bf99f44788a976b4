/* The relief for the reference: heights, displacement and parallax, by methods that the renderer does not use. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/vec.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "render/reference/reference_relief.h"
#include "render/reference/reference_shade.h"
#include "render/tessellation/dice.h"
#include "render/tessellation/mesh_relief.h"
#include "render/visibility/parallax.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <stdint.h>

/* ---- heights ---- */

/* Inverse of the filter (1, 4, 1) / 6 as two recursions (Unser): with z = sqrt(3) - 2
     p[i] = 6 T[i] + z p[i-1]      upwards
     c[i] = z (c[i+1] - p[i])      downwards
   The influence of the start decays by a factor z = -0.268 per texel, so starting REACH texels beyond the ends,
   with the extended texels, leaves an error of 3e-37. */

#define REACH 64
#define BLOCK 32 /* columns that are filtered side by side */

typedef struct Filter {
    WrReferenceTable *table;
    const WrField *field;
    double z;
} Filter;

/* Value number i, any i, of n values `stride` apart, extended according to the axis.
   On a clamped axis the texels outside continue the parabola through the outermost three (Lagrange's form):
   T[-1] = 3 T[0] - 3 T[1] + T[2]. With fewer than three texels the last one repeats. */
static double texel(const double *in, size_t stride, int n, int i, bool periodic)
{
    if (periodic) return in[(size_t)((i % n + n) % n) * stride];
    if (i >= 0 && i < n) return in[(size_t)i * stride];
    const double *end = i < 0 ? in : in + (size_t)(n - 1) * stride;
    if (n < 3) return *end;
    const ptrdiff_t inward = i < 0 ? (ptrdiff_t)stride : -(ptrdiff_t)stride;
    const double x = i < 0 ? i : n - 1 - i; /* below 0: outwards from the end */
    return end[0] * ((x - 1) * (x - 2) / 2) - end[inward] * (x * (x - 2)) +
           end[2 * inward] * (x * (x - 1) / 2);
}

/* Replaces in [count + 2 REACH][lanes], from number -REACH on, by the coefficients.
   in[i * lanes + k]: the lane runs fastest, so that the inner loop is contiguous. Both recursions start from
   their fixed points of a constant sequence, 6 T / (1 - z) and -z p / (1 - z); that guess is wrong by at most
   the change within the REACH texels, and decays as said above. */
static void recurse(double *in, int count, int lanes, double z)
{
    const int total = count + 2 * REACH;
    for (int k = 0; k < lanes; k++) in[k] *= 6 / (1 - z);
    for (int i = 1; i < total; i++) {
        double *now = in + (size_t)i * (size_t)lanes;
        for (int k = 0; k < lanes; k++) now[k] = 6 * now[k] + z * now[k - lanes];
    }
    double *last = in + (size_t)(total - 1) * (size_t)lanes;
    for (int k = 0; k < lanes; k++) last[k] *= -z / (1 - z);
    for (int i = total - 2; i >= 0; i--) {
        double *now = in + (size_t)i * (size_t)lanes;
        for (int k = 0; k < lanes; k++) now[k] = z * (now[k + lanes] - now[k]);
    }
}

/* Texels of row j -> coefficients along u, in the table's row j + 2.
   Heights are stored minus the table's first texel (HC48): a large common offset would cost digits of the
   differences. Rows of table->c are `pitch` = width + 4 doubles; texel (i, j) is at row j + 2, column i + 2,
   so that the four taps i - 1 .. i + 2 of a point exist for i = -1 .. width - 1 without a test. */
static void filter_row(int j, int worker, void *ctx)
{
    (void)worker;
    const Filter *filter = ctx;
    WrReferenceTable *table = filter->table;
    const int n = table->width;
    float *texels = wr_alloc((size_t)n, sizeof *texels);
    double *row = wr_alloc((size_t)n, sizeof *row);
    double *wide = wr_alloc((size_t)n + 2 * REACH, sizeof *wide);
    wr_field_read(filter->field, 0, j, n, 1, texels, (size_t)n);
    for (int i = 0; i < n; i++) row[i] = (double)texels[i] - table->base;
    for (int i = -REACH; i < n + REACH; i++)
        wide[i + REACH] = texel(row, 1, n, i, table->periodic_u);
    recurse(wide, n, 1, filter->z);
    double *out = table->c + (size_t)(j + 2) * table->pitch;
    for (int i = 0; i < n + 4; i++) out[i] = wide[i - 2 + REACH];
    wr_free(wide);
    wr_free(row);
    wr_free(texels);
}

/* Coefficients along v for BLOCK columns.
   Reads rows 2 .. n + 1, which filter_row wrote, and writes all n + 4 rows, the margins included. It runs in
   place: `wide` holds a copy of the block's columns. */
static void filter_columns(int block, int worker, void *ctx)
{
    (void)worker;
    const Filter *filter = ctx;
    WrReferenceTable *table = filter->table;
    const int n = table->height, first = block * BLOCK;
    const int left = (int)table->pitch - first, lanes = left < BLOCK ? left : BLOCK;
    double *wide = wr_alloc(((size_t)n + 2 * REACH) * (size_t)lanes, sizeof *wide);
    const double *in = table->c + 2 * table->pitch + first;
    for (int j = -REACH; j < n + REACH; j++)
        for (int k = 0; k < lanes; k++)
            wide[(size_t)(j + REACH) * (size_t)lanes + (size_t)k] =
                texel(in + k, table->pitch, n, j, table->periodic_v);
    recurse(wide, n, lanes, filter->z);
    for (int j = 0; j < n + 4; j++)
        for (int k = 0; k < lanes; k++)
            table->c[(size_t)j * table->pitch + (size_t)(first + k)] =
                wide[(size_t)(j - 2 + REACH) * (size_t)lanes + (size_t)k];
    wr_free(wide);
}

bool wr_reference_table_init(WrReferenceTable *table, const WrField *field, WrPool *pool,
                             WrError *err)
{
    WrReferenceTable made = { .width = wr_field_width(field),
                              .height = wr_field_height(field),
                              .periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                              .periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC,
                              .base = wr_field_get(field, 0, 0) };
    made.pitch = (size_t)made.width + 4;
    made.c = wr_try_alloc(made.pitch * ((size_t)made.height + 4), sizeof *made.c,
                          "the reference's table", err);
    if (!made.c) return false;
    Filter filter = { &made, field, sqrt(3.0) - 2.0 };
    wr_pool_run(pool, made.height, filter_row, &filter);
    wr_pool_run(pool, (int)((made.pitch + BLOCK - 1) / BLOCK), filter_columns, &filter);
    *table = made;
    return true;
}

void wr_reference_table_fini(WrReferenceTable *table)
{
    wr_free(table->c);
    *table = (WrReferenceTable){ 0 };
}

/* Weights of four coefficients for the value at a = 0..1 past the second, and of their three differences for the
   slope.
   Uniform cubic B-spline; the slope is that of the quadratic B-spline of the differences c[k+1] - c[k]. In
   this form the slope of a flat table is exactly 0 (HC47); derivative weights of the four coefficients sum to
   rounding noise. */
static void weights(double a, double w[4], double d[3])
{
    const double b = 1 - a;
    w[0] = b * b * b / 6;
    w[1] = 2.0 / 3 - a * a * (1 - a / 2);
    w[2] = 2.0 / 3 - b * b * (1 - b / 2);
    w[3] = a * a * a / 6;
    d[0] = b * b / 2;
    d[1] = 0.5 + a * b;
    d[2] = a * a / 2;
}

/* r u reduced to the table: 0..1, and whether F varies there. */
static double replicated(double u, double replicate, bool periodic, bool *varies)
{
    *varies = true;
    if (periodic) return wr_field_reduce(u, replicate);
    const double x = replicate * u;
    *varies = x >= 0 && x <= 1;
    return x > 0 ? x < 1 ? x : 1 : 0;
}

static double bounded(double x)
{
    return x > DBL_MAX ? DBL_MAX : x < -DBL_MAX ? -DBL_MAX : x;
}

/* F = h T and, by the chain rule, Fu = h W r dT/dx; rows run down, so Fv has a minus sign. x = W u - 1/2
   because texel centres are at half-integers. Outside a clamped axis the weights are those of its end and the
   slope is 0. */
void wr_reference_table_at(const WrReferenceTable *table, const WrScene *scene, double u, double v,
                           double *f, double *fu, double *fv)
{
    *f = *fu = *fv = 0;
    if (!table->c) return;
    const double ru = scene->replicate_u, rv = scene->replicate_v;
    bool varies_u, varies_v;
    const double tu = replicated(u, ru, table->periodic_u, &varies_u);
    const double tv = replicated(v, rv, table->periodic_v, &varies_v);
    const double x = table->width * tu - 0.5, y = table->height * (1 - tv) - 0.5;
    const double i = floor(x), j = floor(y);
    double wx[4], dx[3], wy[4], dy[3], across[4], slope[4];
    weights(x - i, wx, dx);
    weights(y - j, wy, dy);
    const double *c = table->c + (size_t)((int)j + 1) * table->pitch + (size_t)((int)i + 1);
    for (int r = 0; r < 4; r++, c += table->pitch) {
        across[r] = wx[0] * c[0] + wx[1] * c[1] + wx[2] * c[2] + wx[3] * c[3];
        slope[r] = dx[0] * (c[1] - c[0]) + dx[1] * (c[2] - c[1]) + dx[2] * (c[3] - c[2]);
    }
    const double value =
        wy[0] * across[0] + wy[1] * across[1] + wy[2] * across[2] + wy[3] * across[3];
    const double right = wy[0] * slope[0] + wy[1] * slope[1] + wy[2] * slope[2] + wy[3] * slope[3];
    const double down = dy[0] * (across[1] - across[0]) + dy[1] * (across[2] - across[1]) +
                        dy[2] * (across[3] - across[2]);
    const double h = scene->height;
    *f = bounded(h * (table->base + value));
    if (varies_u) *fu = bounded(bounded(h * (right * table->width)) * ru);
    if (varies_v) *fv = bounded(bounded(h * (0.0 - down * table->height)) * rv);
}

/* ---- displaced surfaces ---- */

/* Boxes: a cell is evaluated at 3 x 3 points. The bilinear patches of its four quarters are inside the box of
   these points, and the surface within (|P'uu| du^2 + 2 |P'uv| du dv + |P'vv| dv^2) / 8 of them. The second
   derivatives are estimated from the change of the first ones between the points. */

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

/* u and v of the patch at t, 0..1, along an edge.
   A strip's parameter u follows the edge, 0 .. 1 whatever the surface's own range is; v leads from the sheet's
   displaced edge (v = 0) to the shared point (v = 1). */
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
   displacement.
   Solves d.n_a = f_a and d.n_b = f_b in the plane of the two normals; c = n_a.n_b, and 1 - c^2 is the
   determinant of the system. It is small for almost parallel normals, where d would grow without bound; hence
   the limit of twice the larger height. Both sheets compute the same d, so that their strips meet without a
   gap (HC124). */
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

/* As raised_at, for strips and corners.
   The tangent along a strip is a central difference, as strip_at has no closed derivative; P is bilinear
   across, so Pv and the blend of the two ends' tangents are exact in v. */
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

/* True if both are one edge in space, in equal or opposite direction.
   Two points that are not symmetric about the middle: an edge and its reverse agree at neither. */
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

/* P' = P + F n, Pu' = Pu + Fu n + F n_u, Pv' = Pv + Fv n + F n_v (equation B4, no term dropped). */
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

/* The normals are sampled at the 3 x 3 points alone; 20 % and 0.01 are the margin for those between. 2 marks a
   cell whose normals turn by more than 84 degrees: nothing is concluded from it. */
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

/* For a quarter of the cell, of sides du/2 and dv/2, Taylor's bound is
       (|P'uu| du^2 + 2 |P'uv| du dv + |P'vv| dv^2) / 32.
   Neighbouring points are half a cell apart, so |P'uu| du = 2 change(pu, 1) and |P'uv| dv = 2 change(pu, 3);
   P'uv is also 2 change(pv, 1) / du, and the two estimates are averaged. Together this is bend / 8. */
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

/* ceil(n / 2^level), the number of boxes of a level along an axis; odd counts leave a last box with one child. */
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

#define MESH_ERROR 0x1p-12
#define MESH_MOST 2000000

/* The triangles of the picture's relief (mesh_relief.h), but finer, with the heights of the table's spline as everywhere
   in the reference. */
bool wr_reference_raised_mesh_init(WrReferenceRaised *raised, const WrScene *scene,
                                   const WrField *field, WrPool *pool, WrError *err)
{
    WrMeshRelief relief = { 0 };
    WrRaised spline = { 0 };
    WrScene *own = wr_scene_clone(scene);
    own->scheme = WR_SCHEME_BSPLINE_FIT;
    *raised = (WrReferenceRaised){ .base = scene->triangles ? wr_triangles_share(scene->triangles)
                                                            : wr_triangles_square(),
                                   .size = wr_shape_radius(&scene->shape),
                                   .sheets = wr_alloc(1, sizeof *raised->sheets),
                                   .count = 1 };
    bool good = wr_raised_init(&spline, own, field, err);
    const WrMeshReliefRequest ask = { .scene = spline.scene,
                                      .field = spline.field,
                                      .pool = pool,
                                      .mesh = raised->base,
                                      .stretch = { 1, 1, 1 },
                                      .scale = 1,
                                      .error = MESH_ERROR * raised->base->radius,
                                      .fine = true,
                                      .most = MESH_MOST };
    good = good && wr_mesh_relief_make(&relief, &ask, err);
    if (good && relief.triangles.count == 0)
        good = wr_fail(err, "the mesh has too many texels of the table for the reference");
    WrTriangles *facets = good ? wr_mesh_relief_triangles(&relief, &raised->base_of, err) : NULL;
    good = facets && wr_reference_mesh_init(&raised->facets, facets, err);
    wr_mesh_relief_fini(&relief);
    wr_raised_fini(&spline);
    wr_scene_free(own);
    return good;
}

void wr_reference_raised_fini(WrReferenceRaised *raised)
{
    wr_reference_mesh_fini(&raised->facets);
    wr_triangles_free(raised->base);
    wr_free(raised->base_of);
    for (int i = 0; i < raised->count; i++)
        for (int level = 0; level < raised->sheets[i].levels; level++)
            wr_free(raised->sheets[i].boxes[level]);
    wr_free(raised->sheets);
    *raised = (WrReferenceRaised){ 0 };
}

/* ---- ray search ---- */

/* The ray is q + s d with d of any length; s is comparable between sheets, so one `best` serves the whole
   search. */
typedef struct Search {
    const WrReferenceRaised *raised;
    const WrRaisedSheet *sheet;
    const WrReferenceRay *ray;
    double length;     /* of the ray's direction */
    double inverse[3]; /* 1 / direction, for each component */
    bool found;
    WrReferenceHit best;
} Search;

/* Ray parameter at which the box is entered, or INFINITY.
   Slab test. `inverse` is finite even for a component 0 of d (see reciprocal), because 0 * INFINITY would be
   NaN for a ray within a slab's plane. */
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

/* Accepts (u, v) within the cell plus SLACK: neighbours then overlap, and a hit on their common border is
   found twice rather than not at all. Only the nearest hit counts, so doubles do no harm. s is the foot of the
   point on the ray, not Newton's own value, which carries the remaining error of the step. */
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

/* Newton's method from (u, v); most: longest step, in cells.
   Solves (P'(u, v) - q) x d = 0 by two plane equations. Convergence is quadratic at regular points and linear
   at silhouettes, where Pu', Pv' and d are coplanar; there the steps may stay long although the point is on
   the ray already. So `off`, the distance from the ray, decides too: three steps without halving it end the
   search. A start that leaves the neighbouring cells is dropped: their own boxes cover those points. */
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

/* If the ray is steeper to the middle tangent plane than all normals of the cell deviate from the middle one,
   then n.d has one sign over the cell and the ray crosses it at most once: one start is enough. Otherwise
   there may be two crossings, or a tangent one, and five starts with short steps look for both. */
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

/* Pushes the box's four children onto the stack, the farthest first.
   Insertion sort of at most four. The nearest child is popped first, so `best` shrinks early and look_through
   discards the others by their entry alone. A level adds at most three entries to the stack: 4
   WR_RAISED_LEVELS is enough. */
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

/* From a triangle of the relief to the face of the mesh below it. */
static bool mesh_relief_hit(const WrReferenceRaised *raised, const WrReferenceRay *ray,
                            WrReferenceHit *hit)
{
    if (!wr_reference_mesh_hit(&raised->facets, false, ray, hit)) return false;
    const int32_t face = raised->base_of[hit->triangle];
    const double weight[3] = { 1 - hit->u - hit->v, hit->u, hit->v };
    hit->triangle = face;
    hit->share[0] = hit->u, hit->share[1] = hit->v;
    hit->u = hit->v = 0;
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &raised->base->corners[raised->base->triangles[face].corner[k]];
        hit->u += weight[k] * (double)c->u;
        hit->v += weight[k] * (double)c->v;
    }
    return true;
}

bool wr_reference_raised_hit(const WrReferenceRaised *raised, const WrReferenceRay *ray,
                             WrReferenceHit *hit)
{
    if (raised->base) return mesh_relief_hit(raised, ray, hit);
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

/* ---- displacement against bump mapping ---- */

typedef struct Row {
    int64_t places;
    double way, most, light;
} Row;

typedef struct Walk {
    const WrReferenceRequest *request;
    const WrReferenceStage *stage;
    Row *rows; /* [height] */
} Walk;

/* Screen position of an object's point, pixels.
   The view's axes are skewed if the object is stretched, so the coordinates come from Cramer's rule, with
   triple products and not with dot products. */
static void pixel_of(const WrReferenceView *view, WrVec3 p, double at[2])
{
    const WrVec3 from = v3_sub(p, view->perspective ? view->eye : view->middle);
    const WrVec3 a = v3_cross(view->up, view->forward), b = v3_cross(view->forward, view->right);
    const WrVec3 c = v3_cross(view->right, view->up);
    const double volume = v3_dot(view->right, a);
    const double deep = view->perspective ? v3_dot(from, c) / volume : 1;
    at[0] = view->width / 2 * (1 + v3_dot(from, a) / volume / deep / view->half_w);
    at[1] = view->height / 2 * (1 - v3_dot(from, b) / volume / deep / view->half_h);
}

/* The light of a point: with displacement, or with bump mapping. */
static void light_of(const WrReferenceStage *stage, WrSurfacePoint at, const WrReferenceHit *hit,
                     WrVec3 perturbed, double rgb[3])
{
    const WrReferenceView *view = &stage->view;
    const WrVec3 to = view->perspective ? v3_sub(view->eye, at.p) : view->toward;
    if (v3_dot(at.n_unit, to) < 0) perturbed = v3_neg(perturbed);
    wr_reference_light(stage, &at, hit, wr_reference_normal_stretched(view, perturbed),
                       (WrReferenceShare){ 0, 1 }, rgb);
}

/* Measures the same parameter (u, v) twice: on the base with the bumped normal, and displaced with the exact
   one. `way` is the parallax in pixels that bump mapping leaves out, `light` the squared shading difference
   (mean over channels). */
static void note(const Walk *walk, const WrReferenceRay *ray, const WrReferenceHit *hit, Row *row)
{
    const WrReferenceStage *stage = walk->stage;
    WrSurfacePoint at;
    double f, fu, fv, from[2], to[2], bumped[3], displaced[3];
    wr_reference_surface_point(&stage->view, hit, &at);
    wr_reference_height_at(stage, hit, &f, &fu, &fv);
    wr_reference_add_map(stage, hit, &at, &fu, &fv);
    light_of(stage, at, hit, wr_reference_normal(stage->scene->bump, &at, f, fu, fv), bumped);
    pixel_of(&stage->view, at.p, from);
    const WrVec3 own = wr_reference_normal(WR_BUMP_EXACT, &at, f, fu, fv);
    at.p = v3_mad(ray->q, ray->d, hit->s);
    pixel_of(&stage->view, at.p, to);
    light_of(stage, at, hit, own, displaced);
    const double way = hypot(to[0] - from[0], to[1] - from[1]);
    row->places++;
    row->way += way, row->most = fmax(row->most, way);
    for (int c = 0; c < 3; c++) row->light += pow(displaced[c] - bumped[c], 2) / 3;
}

static void walk_row(int y, int worker, void *ctx)
{
    (void)worker;
    const Walk *walk = ctx;
    if (wr_cancel_requested(walk->request->cancel)) return;
    for (int x = 0; x < walk->request->width; x++) {
        const WrReferenceRay ray = wr_reference_view_ray(&walk->stage->view, x + 0.5, y + 0.5);
        WrReferenceHit hit;
        if (wr_reference_raised_hit(&walk->stage->raised, &ray, &hit))
            note(walk, &ray, &hit, &walk->rows[y]);
    }
}

static bool walk_object(const WrReferenceRequest *request, int i, Row *rows, WrPool *pool,
                        WrError *err)
{
    const WrField *own = request->fields ? request->fields[i] : NULL;
    const WrField *field = own ? own : request->field;
    WrScene *part =
        wr_scene_object_alone(request->scene, i, (double)request->width / request->height);
    WrReferenceStage *stage = wr_alloc(1, sizeof *stage);
    part->material.shadow = false;
    const bool good = wr_reference_stage_init(stage, field, part, request->turn_deg, request->width,
                                              request->height, true, pool, err) &&
                      wr_reference_stage_raise(stage, field, pool, err);
    Walk walk = { request, stage, rows };
    if (good) wr_pool_run(pool, request->height, walk_row, &walk);
    wr_reference_stage_fini(stage);
    wr_free(stage);
    wr_scene_free(part);
    return good;
}

bool wr_reference_displacement_difference(const WrReferenceRequest *request, WrPool *pool,
                                          WrMoved *out, WrError *err)
{
    Row *rows = wr_alloc((size_t)request->height, sizeof *rows), all = { 0 };
    bool good = true;
    for (int i = 0; i < wr_scene_object_count(request->scene) && good; i++) {
        const WrScene *object = wr_scene_object(request->scene, i);
        if (!object->hidden && wr_reference_displaced(object))
            good = walk_object(request, i, rows, pool, err);
    }
    for (int y = 0; y < request->height; y++) {
        all.places += rows[y].places;
        all.way += rows[y].way, all.light += rows[y].light;
        all.most = fmax(all.most, rows[y].most);
    }
    wr_free(rows);
    if (good && wr_cancel_requested(request->cancel)) return wr_fail(err, "cancelled");
    const double count = all.places > 0 ? (double)all.places : 1;
    *out = (WrMoved){ all.places, all.way / count, all.most, sqrt(all.light / count) };
    return good;
}

/* ---- parallax through a shell ---- */

/* Parallax of round bases for the reference: a ray through the shell that contains the relief, by short even
   steps; its height above the base has a closed form. */

#define PER_CELL 6    /* steps */
#define PARTS 32      /* of a way, for counting its cells */
#define LEAST 48      /* minimum steps of a whole way */
#define MAX_MOST 6000 /* maximum steps of a whole way */
#define HALVINGS 48

typedef struct Shell {
    const WrReferenceStage *stage;
    const WrReferenceRay *ray;
    double R, H; /* H: height of a tube, which ends there; INFINITY: it is a sphere */
} Shell;

/* The height above the base is |p| - R for a sphere and hypot(x, y) - R for a tube: exact, unlike the parabola
   of `Way`. */
static WrVec3 point_at(const Shell *shell, double s)
{
    return v3_mad(shell->ray->q, shell->ray->d, s);
}

static void parameters(const Shell *shell, WrVec3 p, double *u, double *v)
{
    const double turns = wr_atan2(p.y, p.x) / (2 * WR_PI), flat = sqrt(p.x * p.x + p.y * p.y);
    *u = turns - floor(turns);
    *v = shell->H < INFINITY ? 0.5 + p.z / shell->H : 0.5 + wr_atan2(p.z, flat) / WR_PI;
    *v = fmin(fmax(*v, 0), 1);
}

/* Positive: the point is outside the displaced surface F(u, v) above the foot of p. */
static double above(const Shell *shell, double s)
{
    const WrVec3 p = point_at(shell, s);
    const double z = shell->H < INFINITY ? 0 : p.z;
    double u, v, f, fu, fv;
    parameters(shell, p, &u, &v);
    wr_reference_height(shell->stage, u, v, &f, &fu, &fv);
    return sqrt(p.x * p.x + p.y * p.y + z * z) - shell->R - f;
}

/* Interval in which the ray is at most r from the centre, or from the axis. */
static bool within_reach(const Shell *shell, double r, double part[2])
{
    const bool tube = shell->H < INFINITY;
    WrVec3 q = shell->ray->q, d = shell->ray->d;
    if (tube) q.z = d.z = 0;
    const double dd = v3_dot(d, d), foot = dd > 1e-30 ? -v3_dot(q, d) / dd : 0;
    const WrVec3 nearest = v3_mad(q, d, foot);
    const double left = r * r - v3_dot(nearest, nearest);
    if (!(r > 0 && left >= 0)) return false;
    const double half = dd > 1e-30 ? sqrt(left / dd) : INFINITY;
    part[0] = foot - half, part[1] = foot + half;
    return true;
}

static void clip_ends(const Shell *shell, double part[2])
{
    const double z = shell->ray->q.z, dz = shell->ray->d.z;
    if (!(shell->H < INFINITY)) return;
    const double a = (-shell->H / 2 - z) / dz, b = (shell->H / 2 - z) / dz;
    part[0] = fmax(part[0], fmin(a, b)), part[1] = fmin(part[1], fmax(a, b));
}

/* Steps per cell of the table, not per length: a feature narrower than a cell cannot exist in the interpolated
   relief. The path is measured by 32 chords; u jumps at the seam, so the shorter way round counts. */
static int steps_of(const Shell *shell, const double part[2])
{
    double cells = 0, last[2] = { 0, 0 };
    for (int k = 0; k <= PARTS; k++) {
        double u, v;
        parameters(shell, point_at(shell, part[0] + (part[1] - part[0]) * k / PARTS), &u, &v);
        const double round = fabs(u - last[0]);
        if (k > 0)
            cells += fmin(round, 1 - round) * shell->stage->cells[0] +
                     fabs(v - last[1]) * shell->stage->cells[1];
        last[0] = u, last[1] = v;
    }
    return (int)fmin(fmax(LEAST, ceil(PER_CELL * cells)), MAX_MOST);
}

/* Hit on the relief of a base that has a shell (wr_parallax_has_shell), without the point.
   The search starts where the ray enters the shell of radius R + highest, or, for a tube, where it passes an
   open end; `side` is -1 if it starts below the relief and hits it from within. A ray that reaches R + lowest
   has crossed the relief, so the interval can end there. The first step with a change of sign is bisected; 48
   halvings reach double precision. */
static bool reference_shell(const WrReferenceStage *stage, const WrReferenceRay *ray,
                            WrReferenceHit *hit, double *side)
{
    const WrShape *shape = stage->view.shape;
    const bool tube = stage->view.info->inversion == WR_INVERT_CYLINDER;
    const Shell shell = { stage, ray, shape->value[0], tube ? shape->value[1] : INFINITY };
    double part[2], wall[2], low[2];
    if (!within_reach(&shell, shell.R + stage->highest, wall)) return false;
    part[0] = wall[0], part[1] = wall[1];
    clip_ends(&shell, part);
    part[0] = fmax(part[0], ray->s_min);
    if (!(part[0] < part[1])) return false;
    const bool by_wall = part[0] == wall[0];
    double s = part[0];
    *side = by_wall || above(&shell, s) > 0 ? 1 : -1;
    bool met = by_wall && above(&shell, s) <= 0;
    if (*side > 0 && within_reach(&shell, shell.R + stage->lowest, low) && low[0] > s)
        part[1] = fmin(part[1], low[0] + 1e-9 * (part[1] - part[0]));
    const int steps = met ? 0 : steps_of(&shell, part);
    for (int k = 1; k <= steps && !met; k++) {
        double from = s, to = part[0] + (part[1] - part[0]) * k / steps;
        s = to;
        if (*side * above(&shell, to) > 0) continue;
        for (int half = 0; half < HALVINGS; half++) {
            const double mid = (from + to) / 2;
            if (*side * above(&shell, mid) > 0) from = mid;
            else to = mid;
        }
        s = to, met = true;
    }
    if (!met) return false;
    *hit = (WrReferenceHit){ .s = s };
    parameters(&shell, point_at(&shell, s), &hit->u, &hit->v);
    return true;
}

/* A ray above the base that it hit: (u,v)(t) = base + t (a, b), height(t) = t (rise + t bend).
   To second order in t. (a, b) is the velocity in parameters: the first fundamental form maps it to (d.Pu,
   d.Pv). The base falls away from its tangent plane by the second fundamental form, so height = t n.d + t^2/2
   (n_u a + n_v b).(Pu a + Pv b). t = 0 is the hit on the base, t < 0 lies before it; `side` is -1 for rays
   that arrive from behind, and `rise` <= 0. */
typedef struct Way {
    const WrReferenceStage *stage;
    double u, v, a, b, rise, bend, side;
    double first, last; /* range of t */
    bool opens, leaves; /* it enters, or leaves, where there is no relief */
} Way;

/* The range of F without a scan of the spline: a formula is bounded by its sum of amplitudes. */
bool wr_reference_has_parallax(const WrScene *scene)
{
    return scene->parallax && !wr_reference_displaced(scene) && scene->height != 0 &&
           !wr_shape_without_parallax(&scene->shape);
}

/* A spline through a table exceeds its range by at most that range on both sides. */
void wr_reference_parallax_init(WrReferenceStage *stage, const WrField *field,
                                const double cells[2])
{
    const WrScene *scene = stage->scene;
    const WrAnalytic *formula = &scene->analytic;
    double low = 0, high = 0;
    if (formula->kind != WR_ANALYTIC_OFF) {
        for (int k = 0; k < formula->count; k++) high += fabs(formula->terms[k].a);
        low = -high;
    } else {
        float least, most;
        wr_field_range(field, &least, &most);
        const double range = (double)most - (double)least;
        low = (double)least - range, high = (double)most + range;
    }
    stage->parallax = true;
    stage->view.beyond = wr_surfaces[scene->shape.kind]->inversion == WR_INVERT_PLANE;
    stage->lowest = fmin(low * scene->height, high * scene->height);
    stage->highest = fmax(low * scene->height, high * scene->height);
    stage->cells[0] = cells[0], stage->cells[1] = cells[1];
}

/* True if the surface ends at that end of an axis, rather than shrinking to a point. */
static bool ends_there(const WrShape *shape, bool across, double end)
{
    WrSurfacePoint p, q;
    wr_surface_at(shape, 0, across ? 0.23 : end, across ? end : 0.23, &p);
    wr_surface_at(shape, 0, across ? 0.71 : end, across ? end : 0.71, &q);
    const double apart = v3_len(v3_sub(p.p, q.p));
    return apart > 1e-9 * (v3_len(p.p) + v3_len(q.p));
}

static double above_shell(const Way *w, double t)
{
    double f, fu, fv;
    wr_reference_height(w->stage, w->u + t * w->a, w->v + t * w->b, &f, &fu, &fv);
    return t * (w->rise + t * w->bend) - w->side * f;
}

/* t where the height is h, on the way down. false: the ray is never at that height. */
static bool down_to(const Way *w, double h, double *t)
{
    const double part = w->rise * w->rise + 4 * w->bend * h;
    const double root = sqrt(fmax(part, 0));
    /* t = (-rise - root) / (2 bend), without cancellation */
    *t = root - w->rise > 0 ? -2 * h / (root - w->rise) : 0;
    return part >= 0;
}

/* A closed axis ends the search half a turn from the hit: beyond it the parabola describes the surface no
   more. An open axis ends at 0 and 1; where the surface itself ends there (not at a pole), a ray passes into
   the open. */
static void clip(Way *w, const WrShape *shape, bool across)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const double at = across ? w->v : w->u, move = across ? w->b : w->a;
    const bool round = across ? info->closed_v : info->closed_u;
    if (move == 0 && !round && (at < 0 || at > 1)) w->last = w->first, w->leaves = true;
    if (move == 0) return;
    const double far = round ? at + copysign(0.5, move) : move > 0 ? 1 : 0;
    const double near = round ? at - copysign(0.5, move) : move > 0 ? 0 : 1;
    if ((near - at) / move > w->first) {
        w->first = (near - at) / move;
        w->opens = !round && ends_there(shape, across, near);
    }
    if ((far - at) / move < w->last) {
        w->last = (far - at) / move;
        w->leaves = !round && ends_there(shape, across, far);
    }
}

/* Limits the range of t. false: it is empty.
   The ray is at or below `high` between the two roots of height(t) = high. With bend > 0 it comes down, turns
   at -rise / (2 bend) and rises again: if it never reaches `low`, the interval ends at the mirror image of its
   start. */
static bool limit(Way *w, const WrShape *shape)
{
    const double high = w->side > 0 ? w->stage->highest : -w->stage->lowest;
    const double low = w->side > 0 ? w->stage->lowest : -w->stage->highest;
    if (!down_to(w, high, &w->first) && w->bend > 0) return false;
    w->leaves = !down_to(w, low, &w->last) && w->bend > 0;
    if (w->leaves) w->last = -w->rise / w->bend - w->first;
    clip(w, shape, false);
    clip(w, shape, true);
    return true;
}

/* The first t where the ray is not above the relief. */
static bool meet(const Way *w, double *t)
{
    const double all = w->last - w->first;
    const double cells =
        fabs(w->a) * all * w->stage->cells[0] + fabs(w->b) * all * w->stage->cells[1];
    const int steps = (int)fmin(fmax(LEAST, ceil(PER_CELL * cells)), MAX_MOST);
    double from = w->first;
    *t = from;
    if (!(all > 0)) {
        *t = w->last;
        return !w->leaves && !w->opens;
    }
    if (above_shell(w, from) <= 0) return !w->opens;
    for (int k = 1; k <= steps; k++) {
        double to = w->first + all * k / steps;
        if (above_shell(w, to) > 0) {
            from = to;
            continue;
        }
        for (int half = 0; half < HALVINGS; half++) {
            const double mid = (from + to) / 2;
            if (above_shell(w, mid) > 0) from = mid;
            else to = mid;
        }
        *t = to;
        return true;
    }
    *t = w->last;
    return !w->leaves;
}

static double within(bool round, double x)
{
    return round ? x - floor(x) : fmin(fmax(x, 0), 1);
}

/* Continues the ray to the relief. at: the base's point at the hit.
   Steps: velocity in parameters, parabola above the base, limits, march, and the point at the relief. hit->s
   grows by t because d is the derivative of the ray by s. */
static bool go_on(const WrReferenceStage *stage, const WrReferenceRay *ray, WrReferenceHit *hit,
                  WrSurfacePoint *at, double *side)
{
    const WrSurfaceInfo *info = stage->view.info;
    const double e = v3_dot(at->pu, at->pu), f = v3_dot(at->pu, at->pv), g = v3_dot(at->pv, at->pv);
    const double du = v3_dot(ray->d, at->pu), dv = v3_dot(ray->d, at->pv), det = e * g - f * f;
    const double up = v3_dot(ray->d, at->n_unit);
    double t;
    *side = up > 0 ? -1 : 1;
    if (!(det > 0)) return true;
    Way w = { .stage = stage, .u = hit->u, .v = hit->v, .side = *side, .rise = *side * up };
    w.a = (g * du - f * dv) / det, w.b = (e * dv - f * du) / det;
    const WrVec3 way = v3_add(v3_scale(at->pu, w.a), v3_scale(at->pv, w.b));
    const WrVec3 turn = v3_add(v3_scale(at->n_u, w.a), v3_scale(at->n_v, w.b));
    w.bend = *side * v3_dot(turn, way) / 2;
    if (info->flat) w.bend = 0;
    if (!limit(&w, stage->view.shape) || !meet(&w, &t)) return false;
    hit->s += t;
    hit->u = within(info->closed_u, w.u + t * w.a), hit->v = within(info->closed_v, w.v + t * w.b);
    const WrVec3 p = v3_mad(at->p, ray->d, t);
    wr_reference_surface_point(&stage->view, hit, at);
    at->p = p;
    return true;
}

bool wr_reference_parallax(const WrReferenceStage *stage, const WrReferenceRay *ray,
                           WrReferenceHit *hit, WrSurfacePoint *at, double *side)
{
    if (!wr_parallax_has_shell(stage->view.shape)) {
        if (!wr_reference_view_hit(&stage->view, ray, hit)) return false;
        wr_reference_surface_point(&stage->view, hit, at);
        return go_on(stage, ray, hit, at, side);
    }
    if (!reference_shell(stage, ray, hit, side)) return false;
    wr_reference_surface_point(&stage->view, hit, at);
    at->p = v3_mad(ray->q, ray->d, hit->s);
    return true;
}
