/* Closing pieces of a displaced surface where its domain ends: strips along edges shared by two sheets, and
   corners of a cube. */
#include "render/reference/reference_displaced_internal.h"

#include "base/vec.h"

#include <math.h>

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

void wr_raised_edge_at(const WrReferenceRaised *raised, WrRaisedEdge edge, double t, double *u,
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
    wr_raised_edge_at(raised, edge, t, &end.u, &end.v);
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

void wr_raised_joint_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
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

int wr_raised_joints(const WrReferenceRaised *raised, WrRaisedSheet out[WR_RAISED_JOINTS])
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
