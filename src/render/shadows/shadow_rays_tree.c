/* Bounding box tree of triangles: each box is split in halves along its widest side. */
#include "base/error.h"
#include "base/memory.h"
#include "render/shadows/shadow_rays.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>

#define LEAF 4  /* triangles */
#define DEEP 64 /* stack depth: twice the largest possible number of levels */
/* by which triangles extend over their edges, so that no ray passes between two */
#define SEAM 1e-9

static void empty(float box[6])
{
    for (int k = 0; k < 3; k++) box[k] = FLT_MAX, box[k + 3] = -FLT_MAX;
}

static void hold(float box[6], const float p[3])
{
    for (int k = 0; k < 3; k++) {
        box[k] = p[k] < box[k] ? p[k] : box[k];
        box[k + 3] = p[k] > box[k + 3] ? p[k] : box[k + 3];
    }
}

/* Twice the centre of a triangle's box along an axis. */
static float middle(const WrTriangles *t, int32_t i, int axis)
{
    const int32_t *corner = t->triangles[i].corner;
    const float a = t->corners[corner[0]].p[axis], b = t->corners[corner[1]].p[axis];
    const float c = t->corners[corner[2]].p[axis];
    const float low = a < b ? a : b, high = a < b ? b : a;
    return (c < low ? c : low) + (c > high ? c : high);
}

/* Partitions order[first .. end): the first `split - first` along the axis come before all others (Hoare's
   selection). */
static void part_at(const WrTriangles *t, int32_t *order, int32_t first, int32_t end, int32_t split,
                    int axis)
{
    while (end - first > 1) {
        const float pivot = middle(t, order[first + (end - first) / 2], axis);
        int32_t i = first, k = end - 1;
        while (i <= k) {
            while (middle(t, order[i], axis) < pivot) i++;
            while (middle(t, order[k], axis) > pivot) k--;
            if (i > k) break;
            const int32_t swap = order[i];
            order[i++] = order[k], order[k--] = swap;
        }
        if (split <= k) end = k + 1;
        else if (split >= i) first = i;
        else return;
    }
}

static void hold_triangles(const WrShadowRaysBody *body, int32_t first, int32_t end, float box[6])
{
    const WrTriangles *t = body->triangles;
    empty(box);
    for (int32_t i = first; i < end; i++)
        for (int c = 0; c < 3; c++) hold(box, t->corners[t->triangles[body->order[i]].corner[c]].p);
}

static int widest_axis(const float box[6])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (box[k + 3] - box[k] > box[axis + 3] - box[axis]) axis = k;
    return axis;
}

/* The first triangle below a box, one of the 2^level neighbouring boxes of its level. */
static int32_t first_of(const WrShadowRaysBody *body, int32_t box, int32_t beside)
{
    const int64_t count = body->triangles->triangle_count;
    return (int32_t)(count * box / beside);
}

bool wr_shadow_rays_tree_update(WrShadowRaysBody *body, WrError *err)
{
    const int32_t count = body->triangles->triangle_count;
    int32_t leaves = 1;
    while ((int64_t)leaves * LEAF < count) leaves *= 2;
    body->boxes = wr_try_alloc(2 * (size_t)leaves, sizeof *body->boxes, "boxes for shadows", err);
    if (body->boxes)
        body->order = wr_try_alloc((size_t)count, sizeof *body->order, "boxes for shadows", err);
    if (!body->order) return false;
    body->leaves = leaves;
    for (int32_t i = 0; i < count; i++) body->order[i] = i;
    for (int32_t beside = 1; beside <= leaves; beside *= 2)
        for (int32_t k = 0; k < beside; k++) {
            const int32_t first = first_of(body, k, beside), end = first_of(body, k + 1, beside);
            float *box = body->boxes[beside - 1 + k];
            hold_triangles(body, first, end, box);
            if (beside < leaves)
                part_at(body->triangles, body->order, first, end,
                        first_of(body, 2 * k + 1, 2 * beside), widest_axis(box));
        }
    return true;
}

typedef struct Ray {
    double o[3], d[3], by[3], most; /* by: 1 / d */
} Ray;

static bool meets_box(const Ray *ray, const float box[6])
{
    double near = 0, far = ray->most;
    for (int k = 0; k < 3; k++) {
        const double a = ((double)box[k] - ray->o[k]) * ray->by[k];
        const double b = ((double)box[k + 3] - ray->o[k]) * ray->by[k];
        const double in = a < b ? a : b, out = a < b ? b : a;
        near = in > near ? in : near;
        far = out < far ? out : far;
    }
    return near <= far + 1e-12 * (far < 0 ? -far : far);
}

static WrVec3 place(const float p[3])
{
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* Ray-triangle intersection by Moeller and Trumbore (1997), two-sided. */
static bool meets_triangle(const WrTriangles *t, int32_t i, WrVec3 o, WrVec3 d, double most)
{
    const int32_t *corner = t->triangles[i].corner;
    const WrVec3 a = place(t->corners[corner[0]].p);
    const WrVec3 e = v3_sub(place(t->corners[corner[1]].p), a);
    const WrVec3 f = v3_sub(place(t->corners[corner[2]].p), a);
    const WrVec3 p = v3_cross(d, f), w = v3_sub(o, a);
    const double det = v3_dot(e, p);
    if (det == 0) return false;
    const double x = v3_dot(w, p) / det;
    if (!(x >= -SEAM && x <= 1 + SEAM)) return false;
    const WrVec3 q = v3_cross(w, e);
    const double y = v3_dot(d, q) / det, s = v3_dot(f, q) / det;
    return y >= -SEAM && x + y <= 1 + SEAM && s > 0 && s < most;
}

bool wr_shadow_rays_tree_meets(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most)
{
    const double tiny = 1e-30 * fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
    Ray ray = { { o.x, o.y, o.z }, { d.x, d.y, d.z }, { 0 }, most };
    int32_t stack[DEEP];
    int depth = 0;
    for (int k = 0; k < 3; k++)
        ray.by[k] = 1 / (fabs(ray.d[k]) > tiny ? ray.d[k] : copysign(tiny, ray.d[k]));
    stack[depth++] = 0;
    while (depth > 0) {
        const int32_t at = stack[--depth];
        if (!meets_box(&ray, body->boxes[at])) continue;
        if (at < body->leaves - 1) {
            stack[depth++] = 2 * at + 2, stack[depth++] = 2 * at + 1;
            continue;
        }
        const int32_t leaf = at - body->leaves + 1, end = first_of(body, leaf + 1, body->leaves);
        for (int32_t i = first_of(body, leaf, body->leaves); i < end; i++)
            if (meets_triangle(body->triangles, body->order[i], o, d, most)) return true;
    }
    return false;
}
