/* kern_triangle_body.h - ray hits on triangles given by number: position, normal, u and v, and the vectors for
   bump. Part of kern_body.h.

   With edges e1, e2 from the first corner, N = e1 x e2 and w = P - A a point has the shares
     l1 = (w x e2) . N / N^2,  l2 = (e1 x w) . N / N^2
   of the other corners, whose gradients are e2 x N / N^2 and N x e1 / N^2: so an interpolated value, u and v
   included, has a gradient without tangents, whatever the (u,v) of the triangle are.

   The normal formulas use Pu, Pv and |N|. Here they get Pv = n x grad u, Pu = grad v x n and |N| = 1: then
     n x (Fu Pv - Fv Pu) = -(Fu grad u + Fv grad v), projected across n,
   which is the surface gradient's n' = unit(n - g), exact for sheared, mirrored and collinear (u,v). On a patch
   these are its own Pu / |N| and Pv / |N|. */

/* The corners of a strip's triangles, side by side: eight numbers each. */
typedef struct Corners {
    _Alignas(64) REAL row[24][WR_SPAN];
} Corners;

ALWAYS VEC corner_p(const Corners *at, int k, int i, REAL scale)
{
    return (VEC){ at->row[8 * k][i] * scale, at->row[8 * k + 1][i] * scale,
                  at->row[8 * k + 2][i] * scale };
}

ALWAYS VEC corner_n(const Corners *at, int k, int i)
{
    return (VEC){ at->row[8 * k + 3][i], at->row[8 * k + 4][i], at->row[8 * k + 5][i] };
}

static void gather_corners(const WrTriangleLook *look, const STRIP *strip, Corners *out)
{
    for (int i = 0; i < strip->count; i++) {
        const int32_t *corner = look->triangles + 3 * (size_t)strip->u[i];
        for (int k = 0; k < 3; k++) {
            const float *from = look->corners + 8 * (size_t)corner[k];
            for (int j = 0; j < 8; j++) out->row[8 * k + j][i] = (REAL)from[j];
        }
    }
}

/* The share of a corner, clamped, even if the ray misses the triangle: samples are at most half a 256th outside. */
ALWAYS REAL share_of(REAL x)
{
    x = x > K_(0) ? x : K_(0); /* NaN as well */
    return x < K_(2) ? x : K_(2);
}

#define HORIZON                                                                                    \
    K_(1e-4) /* smallest distance that a normal keeps from the viewer's horizon, as a cosine */

/* A normal that faces away from the viewer although its face does not, or the other way round, is moved to the
   horizon: otherwise outlines of coarse meshes would show back faces. */
ALWAYS VEC before_horizon(VEC n, VEC face, VEC to_viewer)
{
    VEC out = v_scale(face, v_dot(face, n) < K_(0) ? K_(-1) : K_(1));
    VEC way = unit_or(to_viewer, out);
    REAL side = v_dot(out, way) < K_(0) ? K_(-1) : K_(1);
    REAL lift = HORIZON - side * v_dot(n, way);
    VEC lifted = unit_or(v_mad(n, way, side * lift), out);
    return choose(lift > K_(0), lifted, n);
}

/* Parameters shared by all samples of a strip, in scalars: an array read in the loop, or a choice by a flag
   behind a pointer, would prevent vectorisation. */
typedef struct Meeting {
    VEC q0, qx, qy, d0, dx, dy;
    VEC eye;   /* or the direction towards it */
    REAL move; /* weight of the position in the view direction: -1 in perspective, else 0 */
    REAL scale;
} Meeting;

ALWAYS VEC v_read(const REAL *from)
{
    return (VEC){ from[0], from[1], from[2] };
}

ALWAYS Meeting meeting_of(const RAYS *rays, REAL scale)
{
    return (Meeting){ v_read(rays->q0),
                      v_read(rays->qx),
                      v_read(rays->qy),
                      v_read(rays->d0),
                      v_read(rays->dx),
                      v_read(rays->dy),
                      v_read(rays->perspective ? rays->eye : rays->toward),
                      rays->perspective ? K_(-1) : K_(0),
                      scale };
}

/* Normal, u and v, and Pu and Pv at the point with shares l1, l2 of a face with edges e1, e2. lifted: a normal that
   the face's side contradicts is moved to the horizon. */
ALWAYS void frame_on_face(const Corners *corners, VEC e1, VEC e2, REAL l1, REAL l2,
                          const bool lifted, VEC to_viewer, const bool smooth, const bool mapped,
                          const bool sloped, STRIP *strip, int i)
{
    const VEC up = { 0, 0, 1 };
    VEC cross = v_cross(e1, e2);
    REAL square = v_dot(cross, cross);
    REAL inv = square > K_(1e-37) ? K_(1) / square : K_(0);
    VEC face = unit_or(cross, up), n = corner_n(corners, 0, i);
    if (smooth) {
        VEC n1 = v_sub(corner_n(corners, 1, i), n), n2 = v_sub(corner_n(corners, 2, i), n);
        n = unit_or(v_mad(v_mad(n, n1, l1), n2, l2), face);
    }
    if (lifted) n = before_horizon(n, face, to_viewer);
    STORE3(strip, n, i, n);
    strip->n_len[i] = K_(1);
    if (!mapped) return;

    REAL u0 = corners->row[6][i], v0 = corners->row[7][i];
    REAL u1 = corners->row[14][i] - u0, v1 = corners->row[15][i] - v0;
    REAL u2 = corners->row[22][i] - u0, v2 = corners->row[23][i] - v0;
    strip->u[i] = u0 + (l1 * u1 + l2 * u2);
    strip->v[i] = v0 + (l1 * v1 + l2 * v2);
    if (!sloped) return;
    VEC g1 = v_scale(v_cross(e2, cross), inv), g2 = v_scale(v_cross(cross, e1), inv);
    VEC gu = v_mad(v_scale(g1, u1), g2, u2), gv = v_mad(v_scale(g1, v1), g2, v2);
    STORE3(strip, pu, i, v_cross(gv, n));
    STORE3(strip, pv, i, v_cross(n, gu));
}

/* One sample. smooth: interpolates normals; mapped: u and v; sloped: their gradients. */
ALWAYS void meet_triangle(const Meeting *all, const Corners *corners, const bool smooth,
                          const bool mapped, const bool sloped, STRIP *strip, int i)
{
    const REAL x = strip->x[i], y = strip->y[i], scale = all->scale;
    VEC q = v_mad(v_mad(all->q0, all->qy, y), all->qx, x);
    VEC d = v_mad(v_mad(all->d0, all->dy, y), all->dx, x);
    VEC a = corner_p(corners, 0, i, scale);
    VEC e1 = v_sub(corner_p(corners, 1, i, scale), a);
    VEC e2 = v_sub(corner_p(corners, 2, i, scale), a);
    VEC cross = v_cross(e1, e2);
    REAL square = v_dot(cross, cross);
    REAL inv = square > K_(1e-37) ? K_(1) / square : K_(0);
    REAL toward = v_dot(cross, d);
    REAL s = v_dot(cross, v_sub(a, q)) / (toward != K_(0) ? toward : K_(1));
    VEC w = v_sub(v_mad(q, d, s), a);
    REAL l1 = share_of(v_dot(v_cross(w, e2), cross) * inv);
    REAL l2 = share_of(v_dot(v_cross(e1, w), cross) * inv);
    REAL sum = l1 + l2, less = sum > K_(1) ? K_(1) / sum : K_(1);
    l1 *= less;
    l2 *= less;
    VEC p = v_mad(v_mad(a, e1, l1), e2, l2);
    STORE3(strip, p, i, p);
    frame_on_face(corners, e1, e2, l1, l2, true, v_mad(all->eye, p, all->move), smooth, mapped,
                  sloped, strip, i);
}

#define MEET(smooth, mapped, sloped)                                                               \
    SIMD for (int i = 0; i < count; i++)                                                           \
    {                                                                                              \
        meet_triangle(&all, &corners, smooth, mapped, sloped, strip, i);                           \
    }

/* Relief on a mesh: the hit is on a triangle of the relief, the frame is that of the mesh's face below it. */
FLAT static void meet_relief(const RAYS *rays, const WrTriangleLook *look, bool smooth, bool sloped,
                             STRIP *strip)
{
    const int count = strip->count;
    const Meeting all = meeting_of(rays, (REAL)look->scale);
    const WrTriangleLook faces = { .corners = look->base_corners,
                                   .triangles = look->base_triangles };
    const VEC none = { 0, 0, 0 };
    REAL triangle[WR_SPAN];
    Corners corners;
    gather_corners(look, strip, &corners);
    for (int i = 0; i < count; i++) triangle[i] = strip->u[i];
    SIMD for (int i = 0; i < count; i++)
    {
        meet_triangle(&all, &corners, false, true, false, strip, i);
    }
    REAL l1[WR_SPAN], l2[WR_SPAN];
    for (int i = 0; i < count; i++) {
        l1[i] = share_of(strip->u[i]), l2[i] = share_of(strip->v[i]);
        strip->u[i] = (REAL)look->base_of[(size_t)triangle[i]];
    }
    gather_corners(&faces, strip, &corners);
    for (int i = 0; i < count; i++) {
        VEC a = corner_p(&corners, 0, i, all.scale);
        VEC e1 = v_sub(corner_p(&corners, 1, i, all.scale), a);
        VEC e2 = v_sub(corner_p(&corners, 2, i, all.scale), a);
        frame_on_face(&corners, e1, e2, l1[i], l2[i], false, none, smooth, true, sloped, strip, i);
    }
}

/* For triangles whose numbers are in u. Without `mapped`, u and v are unchanged. */
FLAT static void meet_plain(const RAYS *rays, const WrTriangleLook *look, bool smooth, bool mapped,
                            bool sloped, STRIP *strip)
{
    const int count = strip->count;
    const Meeting all = meeting_of(rays, (REAL)look->scale);
    Corners corners;
    gather_corners(look, strip, &corners);
    if (sloped && smooth) {
        MEET(true, true, true)
    } else if (sloped) {
        MEET(false, true, true)
    } else if (mapped && smooth) {
        MEET(true, true, false)
    } else if (mapped) {
        MEET(false, true, false)
    } else if (smooth) {
        MEET(true, false, false)
    } else {
        MEET(false, false, false)
    }
}
