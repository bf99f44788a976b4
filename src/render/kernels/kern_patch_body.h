/* kern_patch_body.h - ray hits on bicubic patches (surface/patches.h). Part of kern_body.h, after
   kern_triangle_body.h, whose conventions for Pu, Pv it keeps.

   The triangle of a sample yields the patch and approximate (u,v). Newton's method then finds the patch's own
   point on the ray; position, normal and tangents are the patch's.

   The chart yields the table's u and v as whole multiples of the patch's: with grad u = Pv x n / |N| and grad v =
   n x Pu / |N|, for table's u = c1 u + c2 v, v = c4 u + c5 v
     Pv := n x grad u = (c1 Pv - c2 Pu) / |N|      Pu := grad v x n = (c5 Pu - c4 Pv) / |N| */

#define PATCH_SPAN 64 /* samples at a time: their patches stay in the first-level cache */
#define PATCH_FLOATS 56

/* The patches of PATCH_SPAN samples, side by side; and each sample's triangle normal. */
typedef struct PatchRows {
    _Alignas(64) REAL row[PATCH_FLOATS][PATCH_SPAN];
    REAL face[3][PATCH_SPAN];
    REAL weak[PATCH_SPAN]; /* 1: |N| is almost 0 */
} PatchRows;

static void gather_patches(const WrTriangleLook *look, const STRIP *strip, int at, int count,
                           PatchRows *out)
{
    const REAL scale = (REAL)look->scale;
    const float *last = NULL;
    for (int i = 0; i < count; i++) {
        const float *from =
            look->patches + PATCH_FLOATS * (size_t)look->patch_of[(int32_t)strip->u[at + i]];
        if (from == last) {
            for (int k = 0; k < PATCH_FLOATS; k++) out->row[k][i] = out->row[k][i - 1];
            continue;
        }
        for (int k = 0; k < 48; k++) out->row[k][i] = (REAL)from[k] * scale;
        for (int k = 48; k < PATCH_FLOATS; k++) out->row[k][i] = (REAL)from[k];
        last = from;
    }
}

ALWAYS VEC patch_point(const PatchRows *rows, int k, int i)
{
    return (VEC){ rows->row[3 * k][i], rows->row[3 * k + 1][i], rows->row[3 * k + 2][i] };
}

ALWAYS VEC mixed3(VEC a, VEC b, VEC c, REAL k0, REAL k1, REAL k2)
{
    return v_mad(v_mad(v_scale(a, k0), b, k1), c, k2);
}

/* Point and derivative along u of the row of control points that begins at k. Differences come first, so that
   coincident points give 0. */
ALWAYS void patch_row(const PatchRows *rows, int k, int i, FN(BezierBasis) b, VEC *p, VEC *d)
{
    const VEC c0 = patch_point(rows, k, i), c1 = patch_point(rows, k + 1, i);
    const VEC c2 = patch_point(rows, k + 2, i), c3 = patch_point(rows, k + 3, i);
    *p = v_mad(mixed3(c0, c1, c2, b.b0, b.b1, b.b2), c3, b.b3);
    *d = mixed3(v_sub(c1, c0), v_sub(c2, c1), v_sub(c3, c2), K_(3) * b.d0, K_(3) * b.d1,
                K_(3) * b.d2);
}

/* P, Pu, Pv of sample i. */
ALWAYS void patch_plane(const PatchRows *rows, int i, REAL u, REAL v, VEC *p, VEC *pu, VEC *pv)
{
    const FN(BezierBasis) bu = FN(bezier_basis)(u), bv = FN(bezier_basis)(v);
    VEC p0, p1, p2, p3, d0, d1, d2, d3;
    patch_row(rows, 0, i, bu, &p0, &d0);
    patch_row(rows, 4, i, bu, &p1, &d1);
    patch_row(rows, 8, i, bu, &p2, &d2);
    patch_row(rows, 12, i, bu, &p3, &d3);
    *p = v_mad(mixed3(p0, p1, p2, bv.b0, bv.b1, bv.b2), p3, bv.b3);
    *pu = v_mad(mixed3(d0, d1, d2, bv.b0, bv.b1, bv.b2), d3, bv.b3);
    *pv = mixed3(v_sub(p1, p0), v_sub(p2, p1), v_sub(p3, p2), K_(3) * bv.d0, K_(3) * bv.d1,
                 K_(3) * bv.d2);
}

ALWAYS REAL within_patch(REAL t)
{
    t = t > K_(0) ? t : K_(0);
    return t < K_(1) ? t : K_(1);
}

ALWAYS REAL at_most(REAL t, REAL most)
{
    t = t > -most ? t : -most; /* NaN included */
    return t < most ? t : most;
}

/* A point of the patch during the iteration. */
typedef struct PatchPoint {
    REAL u, v;
    VEC p, pu, pv;
} PatchPoint;

ALWAYS PatchPoint patch_at(const PatchRows *rows, int i, REAL u, REAL v)
{
    PatchPoint at = { .u = u, .v = v };
    patch_plane(rows, i, u, v, &at.p, &at.pu, &at.pv);
    return at;
}

/* A step of Newton's method towards the ray q + s d, limited to a triangle's reach: if the ray lies almost in
   the patch it would lead anywhere. */
ALWAYS PatchPoint patch_step(const PatchRows *rows, int i, VEC q, VEC d, PatchPoint at)
{
    VEC gap = v_sub(q, at.p), a = v_cross(at.pv, d), b = v_cross(d, at.pu);
    REAL det = v_dot(at.pu, a);
    REAL inv = K_(1) / (r_abs(det) > K_(1e-30) ? det : K_(1e-30));
    REAL u = within_patch(at.u + at_most(v_dot(gap, a) * inv, rows->row[54][i]));
    REAL v = within_patch(at.v + at_most(v_dot(gap, b) * inv, rows->row[55][i]));
    return patch_at(rows, i, u, v);
}

/* Unrolled: an inner loop would prevent vectorising the loop over samples. */
ALWAYS PatchPoint solve_patch(const PatchRows *rows, int i, VEC q, VEC d, REAL u, REAL v)
{
    PatchPoint at = patch_step(rows, i, q, d, patch_at(rows, i, u, v));
#ifdef WR_KERN_DOUBLE
    at = patch_step(rows, i, q, d, patch_step(rows, i, q, d, at));
#endif
    return patch_step(rows, i, q, d, at);
}

/* The chart's two scales, and the parameters shared by all samples. */
typedef struct PatchMeeting {
    Meeting all;
    REAL scale_u, scale_v;
} PatchMeeting;

/* Stores the point, its unit normal n and 1 / |N| in the strip. */
ALWAYS void put_patch(const PatchMeeting *m, const PatchRows *rows, const PatchPoint *met, VEC n,
                      REAL inv, STRIP *strip, int at, int i)
{
    const VEC p = met->p, pu = met->pu, pv = met->pv;
    const REAL u = met->u, v = met->v;
    const VEC face = { rows->face[0][i], rows->face[1][i], rows->face[2][i] };
    STORE3(strip, p, at + i, p);
    n = before_horizon(n, face, v_mad(m->all.eye, p, m->all.move));
    STORE3(strip, n, at + i, n);
    strip->n_len[at + i] = K_(1);
    const REAL c0 = rows->row[48][i], c1 = rows->row[49][i], c2 = rows->row[50][i];
    const REAL c3 = rows->row[51][i], c4 = rows->row[52][i], c5 = rows->row[53][i];
    strip->u[at + i] = (c0 + (c1 * u + c2 * v)) * m->scale_u;
    strip->v[at + i] = (c3 + (c4 * u + c5 * v)) * m->scale_v;
    VEC tv = v_scale(v_sub(v_scale(pv, c1), v_scale(pu, c2)), inv * m->scale_u);
    VEC tu = v_scale(v_sub(v_scale(pu, c5), v_scale(pv, c4)), inv * m->scale_v);
    STORE3(strip, pu, at + i, tu);
    STORE3(strip, pv, at + i, tv);
}

ALWAYS void meet_patch(const PatchMeeting *m, PatchRows *rows, STRIP *strip, int at, int i)
{
    const REAL x = strip->x[at + i], y = strip->y[at + i];
    VEC q = v_mad(v_mad(m->all.q0, m->all.qy, y), m->all.qx, x);
    VEC d = v_mad(v_mad(m->all.d0, m->all.dy, y), m->all.dx, x);
    const PatchPoint met = solve_patch(rows, i, q, d, strip->u[at + i], strip->v[at + i]);
    const VEC face = { rows->face[0][i], rows->face[1][i], rows->face[2][i] };
    VEC cross = v_cross(met.pu, met.pv);
    REAL size = r_sqrt(v_dot(cross, cross));
    REAL whole = FN(bezier_size)(v_sub(patch_point(rows, 15, i), patch_point(rows, 0, i))) +
                 FN(bezier_size)(v_sub(patch_point(rows, 12, i), patch_point(rows, 3, i)));
    const bool weak = !(size > K_(1e-6) * whole * whole);
    REAL inv = weak ? K_(0) : K_(1) / size;
    rows->weak[i] = weak ? K_(1) : K_(0);
    strip->s[at + i] = met.u; /* for weak points */
    strip->tu[at + i] = met.v;
    put_patch(m, rows, &met, choose(weak, face, v_scale(cross, inv)), inv, strip, at, i);
}

/* Where Pu x Pv almost vanishes the normal is a limit (bezier.h), and slopes along a direction without length
   are 0. */
static void meet_weak(const PatchMeeting *m, const PatchRows *rows, STRIP *strip, int at, int i)
{
    SHAPE shape = { .scale = 1 };
    POINT point;
    for (int k = 0; k < 48; k++) shape.value[k] = rows->row[k][i];
    const REAL u = strip->s[at + i], v = strip->tu[at + i];
    FN(bezier_at)(&shape, 0, u, v, &point);
    const REAL inv = point.n_len > K_(0) ? K_(1) / point.n_len : K_(0);
    const PatchPoint met = { u, v, point.p, point.pu, point.pv };
    put_patch(m, rows, &met, point.n_unit, inv, strip, at, i);
}

/* The (u,v) of the patch where the ray hits the triangle, and the triangle's normal. */
ALWAYS void begin_patch(const PatchMeeting *m, const Corners *corners, PatchRows *rows,
                        STRIP *strip, int at, int i)
{
    const REAL scale = m->all.scale;
    const VEC a = corner_p(corners, 0, at + i, scale), up = { 0, 0, 1 };
    VEC cross = v_cross(v_sub(corner_p(corners, 1, at + i, scale), a),
                        v_sub(corner_p(corners, 2, at + i, scale), a));
    VEC face = unit_or(cross, up);
    rows->face[0][i] = face.x, rows->face[1][i] = face.y, rows->face[2][i] = face.z;
    meet_triangle(&m->all, corners, false, true, false, strip, at + i);
}

FLAT static void meet_chunk(const PatchMeeting *m, const Corners *corners, PatchRows *rows,
                            STRIP *strip, int at, int count)
{
    SIMD for (int i = 0; i < count; i++)
    {
        begin_patch(m, corners, rows, strip, at, i);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        meet_patch(m, rows, strip, at, i);
    }
    for (int i = 0; i < count; i++)
        if (rows->weak[i] > K_(0)) meet_weak(m, rows, strip, at, i);
}

static void meet_patches(const RAYS *rays, const WrTriangleLook *look, STRIP *strip)
{
    const PatchMeeting m = { meeting_of(rays, (REAL)look->scale), (REAL)look->scale_u,
                             (REAL)look->scale_v };
    Corners corners;
    PatchRows rows;
    gather_corners(look, strip, &corners);
    for (int at = 0; at < strip->count; at += PATCH_SPAN) {
        const int left = strip->count - at, count = left < PATCH_SPAN ? left : PATCH_SPAN;
        gather_patches(look, strip, at, count, &rows);
        meet_chunk(&m, &corners, &rows, strip, at, count);
    }
}

static void kern_meet(const RAYS *rays, const WrTriangleLook *look, bool smooth, bool mapped,
                      bool sloped, STRIP *strip)
{
    if (look->patches) meet_patches(rays, look, strip);
    else if (look->base_of) meet_relief(rays, look, smooth, sloped, strip);
    else meet_plain(rays, look, smooth, mapped, sloped, strip);
}
