#include "render/reference/reference_mesh.h"

#include "base/error.h"
#include "base/memory.h"
#include "render/reference/reference_patch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAF 4
#define SLACK 1e-14

struct WrReferenceBox {
    WrReferenceBounds about;
    /* triangles of a leaf; else 0, and first is the index of the first of two boxes */
    int32_t first, count;
};

static WrVec3 corner(const WrTriangles *t, int32_t i, int k)
{
    const float *p = t->corners[t->triangles[i].corner[k]].p;
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* ---- the tree ---- */

/* Three times the mean of a triangle's corners along an axis. */
static double middle(const WrTriangles *t, int32_t i, int axis)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += wr_reference_part(corner(t, i, k), axis);
    return sum;
}

static void measure(const WrReferenceMesh *m, WrReferenceBox *box)
{
    box->about = wr_reference_bounds();
    for (int32_t i = box->first; i < box->first + box->count; i++)
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 3; axis++)
                wr_reference_bounds_add(&box->about, axis,
                                        wr_reference_part(corner(m->source, m->order[i], k), axis));
}

/* Moves the triangles below the middle of the box's longest side to the front; returns their number. If all are
   on one side, half of them. */
static int32_t divide(WrReferenceMesh *m, const WrReferenceBox *box)
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (box->about.high[k] - box->about.low[k] > box->about.high[axis] - box->about.low[axis])
            axis = k;
    const double at = 1.5 * (box->about.low[axis] + box->about.high[axis]);
    int32_t below = 0;
    for (int32_t i = 0; i < box->count; i++) {
        int32_t *own = &m->order[box->first + i], *to = &m->order[box->first + below];
        if (middle(m->source, *own, axis) >= at) continue;
        const int32_t moved = *own;
        *own = *to, *to = moved;
        below++;
    }
    return below > 0 && below < box->count ? below : box->count / 2;
}

bool wr_reference_mesh_init(WrReferenceMesh *mesh, WrTriangles *source, WrError *err)
{
    const size_t count = (size_t)source->triangle_count;
    *mesh = (WrReferenceMesh){ .source = source, .box_count = 1 };
    mesh->boxes = wr_try_alloc(2 * count, sizeof *mesh->boxes, "the reference's tree", err);
    mesh->order =
        mesh->boxes ? wr_try_alloc(count, sizeof *mesh->order, "the reference's tree", err) : NULL;
    if (!mesh->order) return false;
    for (size_t i = 0; i < count; i++) mesh->order[i] = (int32_t)i;
    mesh->boxes[0] = (WrReferenceBox){ .first = 0, .count = source->triangle_count };
    for (int32_t i = 0; i < mesh->box_count; i++) {
        WrReferenceBox *box = &mesh->boxes[i];
        measure(mesh, box);
        if (box->count <= LEAF) continue;
        const int32_t below = divide(mesh, box), child = mesh->box_count;
        mesh->boxes[child] = (WrReferenceBox){ .first = box->first, .count = below };
        mesh->boxes[child + 1] =
            (WrReferenceBox){ .first = box->first + below, .count = box->count - below };
        mesh->box_count += 2;
        box->first = child, box->count = 0;
    }
    return true;
}

void wr_reference_mesh_fini(WrReferenceMesh *mesh)
{
    wr_triangles_free(mesh->source);
    wr_free(mesh->boxes);
    wr_free(mesh->order);
    wr_free(mesh->tangents);
    *mesh = (WrReferenceMesh){ 0 };
}

/* ---- rays ---- */

/* The ray's longest axis is z, and positions are sheared so that the ray runs along it. */
typedef struct Shear {
    int x, y, z;
    double sx, sy, sz;
} Shear;

static Shear shear_of(WrVec3 d)
{
    Shear s = { .z = 0 };
    for (int k = 1; k < 3; k++)
        if (fabs(wr_reference_part(d, k)) > fabs(wr_reference_part(d, s.z))) s.z = k;
    s.x = (s.z + 1) % 3, s.y = (s.z + 2) % 3;
    s.sz = 1 / wr_reference_part(d, s.z);
    s.sx = wr_reference_part(d, s.x) * s.sz, s.sy = wr_reference_part(d, s.y) * s.sz;
    return s;
}

/* Woop, Benthin and Wald: the edge functions e0, e1, e2 of the sheared triangle decide; a ray on an edge (0)
   counts as inside for both neighbours, so that no ray passes between them. */
static void test(const WrReferenceMesh *m, int32_t i, bool cull, const WrReferenceRay *ray,
                 const Shear *s, WrReferenceHit *best)
{
    double x[3], y[3], z[3];
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = corner(m->source, i, k);
        const WrVec3 w = v3_sub(p[k], ray->q);
        z[k] = wr_reference_part(w, s->z) * s->sz;
        x[k] = wr_reference_part(w, s->x) - s->sx * wr_reference_part(w, s->z);
        y[k] = wr_reference_part(w, s->y) - s->sy * wr_reference_part(w, s->z);
    }
    const double e0 = x[2] * y[1] - y[2] * x[1], e1 = x[0] * y[2] - y[0] * x[2],
                 e2 = x[1] * y[0] - y[1] * x[0], det = e0 + e1 + e2;
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return;
    if (det == 0) return;
    const double t = (e0 * z[0] + e1 * z[1] + e2 * z[2]) / det;
    if (!(t > ray->s_min) || t >= best->s) return;
    const WrVec3 n = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    if (cull && v3_dot(n, ray->d) >= 0) return;
    best->s = t;
    best->triangle = i;
    best->share[0] = e1 / det, best->share[1] = e2 / det;
}

bool wr_reference_mesh_hit(const WrReferenceMesh *m, bool cull, const WrReferenceRay *ray,
                           WrReferenceHit *hit)
{
    const Shear shear = shear_of(ray->d);
    WrReferenceHit best = { .s = INFINITY, .triangle = -1 };
    int32_t stack[256], height = 0;
    stack[height++] = 0;
    while (height > 0) {
        const WrReferenceBox *box = &m->boxes[stack[--height]];
        if (!wr_reference_bounds_met(&box->about, ray, best.s, SLACK)) continue;
        for (int32_t i = 0; i < box->count; i++)
            test(m, m->order[box->first + i], cull, ray, &shear, &best);
        if (box->count == 0 && height + 2 <= 256)
            stack[height++] = box->first, stack[height++] = box->first + 1;
    }
    if (best.triangle < 0) return false;
    const WrTriangles *t = m->source;
    const int32_t *c = t->triangles[best.triangle].corner;
    const double l[3] = { 1 - best.share[0] - best.share[1], best.share[0], best.share[1] };
    best.u = best.v = 0;
    for (int k = 0; k < 3; k++) {
        best.u += l[k] * (double)t->corners[c[k]].u;
        best.v += l[k] * (double)t->corners[c[k]].v;
    }
    *hit = best;
    return true;
}

/* ---- tangent frames ---- */

bool wr_reference_mesh_frame(WrReferenceMesh *mesh, WrNormalFrame frame, WrError *err)
{
    const WrTriangles *t = mesh->source;
    const size_t corners = 3 * (size_t)t->triangle_count;
    mesh->mikk = frame == WR_FRAME_MIKK;
    mesh->tangents = wr_try_alloc(corners, sizeof *mesh->tangents, "the reference's frames", err);
    return mesh->tangents && (mesh->mikk ? wr_tangents_mikk : wr_tangents_average)(
                                 t->corners, t->triangles, t->triangle_count, mesh->tangents, err);
}

bool wr_reference_mesh_axes(const WrReferenceMesh *mesh, const WrReferenceHit *hit, WrMapAxes *axes)
{
    const WrVec3 none = { 0, 0, 0 };
    const WrTriangles *t = mesh->source;
    const double l[3] = { 1 - hit->share[0] - hit->share[1], hit->share[0], hit->share[1] };
    double sign = 0;
    *axes = (WrMapAxes){ none, none, none };
    if (!mesh->tangents) return false;
    for (int k = 0; k < 3; k++) {
        const WrTangent *own = &mesh->tangents[3 * (size_t)hit->triangle + (size_t)k];
        const float *n = t->corners[t->triangles[hit->triangle].corner[k]].n;
        axes->t = v3_mad(axes->t, own->t, l[k]);
        axes->b = v3_mad(axes->b, own->b, l[k]);
        axes->n = v3_mad(axes->n, (WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, l[k]);
        sign += l[k] * own->sign;
    }
    if (mesh->mikk) axes->b = v3_scale(v3_cross(axes->n, axes->t), sign);
    else {
        axes->t = v3_unit(axes->t, none);
        axes->b = v3_unit(axes->b, none);
        axes->n = v3_unit(axes->n, none);
    }
    return v3_len(axes->t) > 0 && v3_len(axes->b) > 0;
}

/* ---- surface at a hit ---- */

static WrVec3 shading_normal(const WrTriangles *t, const WrReferenceHit *hit, WrVec3 face)
{
    const int32_t *c = t->triangles[hit->triangle].corner;
    const double l[3] = { 1 - hit->share[0] - hit->share[1], hit->share[0], hit->share[1] };
    WrVec3 n = { 0, 0, 0 };
    for (int k = 0; k < 3; k++) {
        const float *own = t->corners[c[k]].n;
        n = v3_mad(n, (WrVec3){ (double)own[0], (double)own[1], (double)own[2] }, l[k]);
    }
    return v3_unit(n, face);
}

/* The normal, moved to the visible side of its face. */
static WrVec3 seen_normal(WrVec3 n, WrVec3 face, WrVec3 to)
{
    const double least = 1e-4;
    const double front = v3_dot(face, n) < 0 ? -1 : 1;
    const double side = front * v3_dot(face, to) < 0 ? -1 : 1;
    const double now = side * v3_dot(n, to);
    if (now >= least) return n;
    return v3_unit(v3_mad(n, to, side * (least - now)), face);
}

void wr_reference_mesh_at(const WrReferenceMesh *m, const WrReferenceHit *hit, WrVec3 eye,
                          bool perspective, WrSurfacePoint *out)
{
    const WrTriangles *t = m->source;
    const int32_t *c = t->triangles[hit->triangle].corner;
    const WrVec3 none = { 0, 0, 0 };
    WrVec3 p[3], face = { 0, 0, 1 }, gu = none, gv = none;
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        p[k] = corner(t, hit->triangle, k);
        uv[k][0] = (double)t->corners[c[k]].u, uv[k][1] = (double)t->corners[c[k]].v;
    }
    (void)wr_triangle_gradients(p, (const double(*)[2])uv, &face, &gu, &gv);
    memset(out, 0, sizeof *out);
    out->p =
        v3_mad(v3_mad(p[0], v3_sub(p[1], p[0]), hit->share[0]), v3_sub(p[2], p[0]), hit->share[1]);
    const WrVec3 to = v3_unit(perspective ? v3_sub(eye, out->p) : eye, face);
    const WrVec3 n = seen_normal(shading_normal(t, hit, face), face, to);
    wr_reference_lay(n, gu, gv, out);
}
