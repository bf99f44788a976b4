#include "surface/ray_tree.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define LEAF 4   /* triangles */
#define BINS 16  /* along an axis */
#define DEEP 48  /* levels of SAH splits; below them lists are halved, 23 levels at most */
#define STACK 80 /* more than all levels */
/* Of the largest coordinate, by which boxes are padded: above the rounding of a ray from 10^8 times as far. */
#define PAD 0x1p-22

/* Children of an inner node are beside each other. */
typedef struct Node {
    float low[3], high[3];
    int32_t first, count; /* triangles of a leaf; or the first child, and 0 */
} Node;

typedef struct Box {
    float low[3], high[3];
} Box;

/* Positions of a triangle, in the order of the leaves. */
typedef struct Facet {
    float p[3][3];
    int32_t index;
} Facet;

struct WrRayTree {
    WrTriangles *mesh;
    Node *nodes;
    Facet *facets;
    int32_t node_count;
    int refs;
};

/* ---- building ---- */

typedef struct Builder {
    WrRayTree *tree;
    Box *boxes;     /* [count] of triangles, by index - first */
    int32_t *order; /* [count] */
    float pad;
} Builder;

typedef struct Bin {
    Box box;
    int32_t count;
} Bin;

static const Box nothing = { { FLT_MAX, FLT_MAX, FLT_MAX }, { -FLT_MAX, -FLT_MAX, -FLT_MAX } };

static void hold(Box *box, const float low[3], const float high[3])
{
    for (int k = 0; k < 3; k++) {
        box->low[k] = low[k] < box->low[k] ? low[k] : box->low[k];
        box->high[k] = high[k] > box->high[k] ? high[k] : box->high[k];
    }
}

static double area(const Box *box)
{
    const double x = (double)box->high[0] - (double)box->low[0];
    const double y = (double)box->high[1] - (double)box->low[1];
    const double z = (double)box->high[2] - (double)box->low[2];
    return x * y + y * z + z * x;
}

static double centre(const Box *box, int axis)
{
    return (double)box->low[axis] + (double)box->high[axis]; /* twice */
}

/* A split plane: triangles with a bin below `bin` go to the first child. */
typedef struct Split {
    double low, scale; /* bin of a centre x: (x - low) scale */
    int axis, bin;     /* axis -1: no plane separates the centres */
} Split;

static int bin_of(const Split *split, const Box *box)
{
    const int bin = (int)((centre(box, split->axis) - split->low) * split->scale);
    return bin < BINS - 1 ? bin : BINS - 1;
}

/* The cheapest of the planes between the bins of one axis by the surface area heuristic: areas times counts. */
static void try_axis(const Bin bins[BINS], Split at, double *least, Split *best)
{
    double right[BINS] = { 0 };
    Box box = nothing;
    int32_t count = 0;
    for (int i = BINS - 1; i > 0; i--) {
        hold(&box, bins[i].box.low, bins[i].box.high);
        count += bins[i].count;
        right[i] = count > 0 ? count * area(&box) : INFINITY;
    }
    box = nothing, count = 0;
    for (int i = 1; i < BINS; i++) {
        hold(&box, bins[i - 1].box.low, bins[i - 1].box.high);
        count += bins[i - 1].count;
        const double cost = count > 0 ? count * area(&box) + right[i] : INFINITY;
        if (cost < *least) *least = cost, *best = at, best->bin = i;
    }
}

static Split find_split(const Builder *b, int32_t first, int32_t count)
{
    Split best = { .axis = -1 };
    double least = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (int32_t i = first; i < first + count; i++) {
            const double x = centre(&b->boxes[b->order[i]], axis);
            low = x < low ? x : low, high = x > high ? x : high;
        }
        const Split at = { .low = low, .scale = BINS / (high - low), .axis = axis };
        if (!(high > low) || !(at.scale < INFINITY)) continue;
        Bin bins[BINS];
        for (int i = 0; i < BINS; i++) bins[i] = (Bin){ .box = nothing };
        for (int32_t i = first; i < first + count; i++) {
            const Box *box = &b->boxes[b->order[i]];
            Bin *bin = &bins[bin_of(&at, box)];
            hold(&bin->box, box->low, box->high);
            bin->count++;
        }
        try_axis(bins, at, &least, &best);
    }
    return best;
}

/* Moves the triangles of the first child to the front; returns their number. */
static int32_t part(Builder *b, int32_t first, int32_t count, const Split *split)
{
    int32_t i = first, end = first + count;
    while (i < end) {
        if (bin_of(split, &b->boxes[b->order[i]]) < split->bin) {
            i++;
            continue;
        }
        const int32_t swap = b->order[--end];
        b->order[end] = b->order[i], b->order[i] = swap;
    }
    return i - first;
}

static void set_box(const Builder *b, Node *node, int32_t first, int32_t count)
{
    Box box = nothing;
    for (int32_t i = first; i < first + count; i++)
        hold(&box, b->boxes[b->order[i]].low, b->boxes[b->order[i]].high);
    for (int k = 0; k < 3; k++)
        node->low[k] = box.low[k] - b->pad, node->high[k] = box.high[k] + b->pad;
}

typedef struct Todo {
    int32_t node, first, count;
    int depth;
} Todo;

static bool build(Builder *b, int32_t all)
{
    Todo stack[STACK];
    int top = 0;
    Node *nodes = b->tree->nodes;
    b->tree->node_count = 1;
    stack[top++] = (Todo){ 0, 0, all, 0 };
    while (top > 0) {
        const Todo at = stack[--top];
        Node *node = &nodes[at.node];
        set_box(b, node, at.first, at.count);
        node->first = at.first, node->count = at.count;
        if (at.count <= LEAF) continue;
        if (at.count > 4096 && wr_progress_stopped()) return false;
        Split split = { .axis = -1 };
        if (at.depth < DEEP) split = find_split(b, at.first, at.count);
        const int32_t left = split.axis < 0 ? at.count / 2 : part(b, at.first, at.count, &split);
        node->first = b->tree->node_count, node->count = 0;
        b->tree->node_count += 2;
        stack[top++] = (Todo){ node->first + 1, at.first + left, at.count - left, at.depth + 1 };
        stack[top++] = (Todo){ node->first, at.first, left, at.depth + 1 };
    }
    return true;
}

static void measure(Builder *b, const WrTriangles *mesh, int32_t first, int32_t count)
{
    float largest = 0;
    for (int32_t i = 0; i < count; i++) {
        b->order[i] = i;
        b->boxes[i] = nothing;
        for (int k = 0; k < 3; k++) {
            const float *p = mesh->corners[mesh->triangles[first + i].corner[k]].p;
            hold(&b->boxes[i], p, p);
        }
        for (int k = 0; k < 3; k++) {
            const float m = fmaxf(fabsf(b->boxes[i].low[k]), fabsf(b->boxes[i].high[k]));
            largest = m > largest ? m : largest;
        }
    }
    b->pad = largest * (float)PAD;
}

static void copy_facets(const Builder *b, int32_t first, int32_t count)
{
    const WrTriangles *mesh = b->tree->mesh;
    for (int32_t i = 0; i < count; i++) {
        Facet *facet = &b->tree->facets[i];
        facet->index = first + b->order[i];
        for (int k = 0; k < 3; k++)
            memcpy(facet->p[k], mesh->corners[mesh->triangles[facet->index].corner[k]].p,
                   sizeof facet->p[k]);
    }
}

WrRayTree *wr_ray_tree_new(const WrTriangles *mesh, int32_t first, int32_t count, WrError *err)
{
    static const char purpose[] = "a tree of triangles";
    const size_t n = (size_t)count;
    WrRayTree *tree = wr_alloc(1, sizeof *tree);
    Builder b = { .tree = tree };
    WR_ASSERT(count > 0);
    tree->refs = 1;
    tree->mesh = wr_triangles_share(mesh);
    bool good = (b.boxes = wr_try_alloc_unset(n, sizeof *b.boxes, purpose, err)) &&
                (b.order = wr_try_alloc_unset(n, sizeof *b.order, purpose, err)) &&
                (tree->nodes = wr_try_alloc_unset(2 * n, sizeof *tree->nodes, purpose, err)) &&
                (tree->facets = wr_try_alloc_unset(n, sizeof *tree->facets, purpose, err));
    if (good) {
        measure(&b, mesh, first, count);
        good = build(&b, count) || wr_fail(err, "cancelled");
        if (good) copy_facets(&b, first, count);
    }
    wr_free(b.boxes);
    wr_free(b.order);
    if (good) return tree;
    wr_ray_tree_free(tree);
    return NULL;
}

WrRayTree *wr_ray_tree_share(const WrRayTree *tree)
{
    WrRayTree *shared = (WrRayTree *)tree; /* only the reference count changes */
    __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_ray_tree_free(WrRayTree *tree)
{
    if (!tree || __atomic_sub_fetch(&tree->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_triangles_free(tree->mesh);
    wr_free(tree->nodes);
    wr_free(tree->facets);
    wr_free(tree);
}

/* ---- rays ---- */

/* A ray, with the shear that makes it the z axis: x' = x - sx z, y' = y - sy z, z' = sz z, for coordinates about o
   in which z is d's largest component. x and y are exchanged if that one is negative, which keeps the sense of
   rotation. */
typedef struct Ray {
    double o[3], by[3]; /* by: 1 / d */
    int x, y, z;
    double sx, sy, sz;
    bool front, any;
    double most;
    WrRayHit *hit;
} Ray;

static Ray ray_of(WrVec3 o, WrVec3 d, double most, WrRayHit *hit)
{
    const double along[3] = { d.x, d.y, d.z };
    Ray ray = { .o = { o.x, o.y, o.z }, .most = most, .hit = hit };
    ray.z = fabs(d.x) > fabs(d.y) ? 0 : 1;
    if (fabs(d.z) > fabs(along[ray.z])) ray.z = 2;
    ray.x = (ray.z + 1) % 3, ray.y = (ray.z + 2) % 3;
    if (along[ray.z] < 0) {
        const int swap = ray.x;
        ray.x = ray.y, ray.y = swap;
    }
    ray.sx = along[ray.x] / along[ray.z];
    ray.sy = along[ray.y] / along[ray.z];
    ray.sz = 1 / along[ray.z];
    /* A component of 0 has the reciprocal of a tiny one: slabs then yield no NaN. */
    const double tiny = 1e-30 * fabs(along[ray.z]);
    for (int k = 0; k < 3; k++)
        ray.by[k] = 1 / (fabs(along[k]) > tiny ? along[k] : copysign(tiny, along[k]));
    return ray;
}

/* The slack is Ize's (2013), for the rounding of the two products. *near: where the ray enters. */
static bool meets_box(const Ray *ray, const Node *node, double *near)
{
    double from = 0, to = ray->most;
    for (int k = 0; k < 3; k++) {
        const double a = ((double)node->low[k] - ray->o[k]) * ray->by[k];
        const double b = ((double)node->high[k] - ray->o[k]) * ray->by[k];
        const double in = a < b ? a : b, out = a < b ? b : a;
        from = in > from ? in : from;
        to = out < to ? out : to;
    }
    *near = from;
    return from <= to * (1 + 0x1p-50);
}

/* On an edge that two triangles share, their edge functions have the same bits and opposite signs: at most one of
   the two excludes a ray, and an exact 0 excludes it from neither. */
static void meet_facet(Ray *ray, const Facet *facet)
{
    double x[3], y[3], z[3], e[3];
    for (int k = 0; k < 3; k++) {
        const double depth = (double)facet->p[k][ray->z] - ray->o[ray->z];
        x[k] = (double)facet->p[k][ray->x] - ray->o[ray->x] - ray->sx * depth;
        y[k] = (double)facet->p[k][ray->y] - ray->o[ray->y] - ray->sy * depth;
        z[k] = ray->sz * depth;
    }
    e[0] = x[2] * y[1] - y[2] * x[1];
    e[1] = x[0] * y[2] - y[0] * x[2];
    e[2] = x[1] * y[0] - y[1] * x[0];
    const bool below = e[0] < 0 || e[1] < 0 || e[2]<0, above = e[0]> 0 || e[1] > 0 || e[2] > 0;
    const double det = e[0] + e[1] + e[2];
    if (below == above || !(ray->front ? det > 0 : det != 0)) return;
    const double t = (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / det;
    const bool nearer = t < ray->most || (t == ray->most && ray->hit->triangle > facet->index);
    if (!(t > 0) || !nearer) return;
    ray->most = t;
    *ray->hit = (WrRayHit){ facet->index, t, { e[0] / det, e[1] / det, e[2] / det } };
}

/* Visits the nearer child first. Nodes as near as the present hit are visited too, for a tie's smaller index. */
static bool cast(const WrRayTree *tree, Ray *ray)
{
    struct {
        int32_t node;
        double near;
    } stack[STACK];
    int top = 0;
    double near[2];
    ray->hit->triangle = -1;
    if (!meets_box(ray, tree->nodes, near)) return false;
    stack[top].node = 0, stack[top++].near = near[0];
    while (top > 0) {
        top--;
        if (stack[top].near > ray->most) continue;
        const Node *node = &tree->nodes[stack[top].node];
        for (int32_t i = node->first; i < node->first + node->count; i++)
            meet_facet(ray, &tree->facets[i]);
        if (ray->any && ray->hit->triangle >= 0) return true;
        if (node->count > 0) continue;
        const bool a = meets_box(ray, &tree->nodes[node->first], &near[0]);
        const bool b = meets_box(ray, &tree->nodes[node->first + 1], &near[1]);
        const int later = near[1] < near[0] ? 0 : 1;
        const int32_t first = node->first;
        for (int k = 0; k < 2; k++) {
            const int child = k == 0 ? later : 1 - later;
            if (!(child ? b : a)) continue;
            stack[top].node = first + child, stack[top++].near = near[child];
        }
    }
    return ray->hit->triangle >= 0;
}

bool wr_ray_tree_closest(const WrRayTree *tree, WrVec3 o, WrVec3 d, double most, bool front,
                         WrRayHit *hit)
{
    Ray ray = ray_of(o, d, most, hit);
    ray.front = front;
    return cast(tree, &ray);
}

bool wr_ray_tree_any(const WrRayTree *tree, WrVec3 o, WrVec3 d, double most)
{
    WrRayHit hit;
    Ray ray = ray_of(o, d, most, &hit);
    ray.any = true;
    return cast(tree, &ray);
}

/* ---- distance of a point ---- */

static WrVec3 vector(const float p[3])
{
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* Squared distance of a point from the segment o + s e, p relative to o. */
static double segment_distance2(WrVec3 p, WrVec3 e)
{
    const double ee = v3_dot(e, e), s = ee > 0 ? fmin(1, fmax(0, v3_dot(p, e) / ee)) : 0;
    const WrVec3 off = v3_mad(p, e, -s);
    return v3_dot(off, off);
}

/* The distance from the plane where the foot is inside, else that from the nearest edge. */
static double facet_distance2(const Facet *facet, WrVec3 p)
{
    const WrVec3 a = vector(facet->p[0]), b = vector(facet->p[1]), c = vector(facet->p[2]);
    const WrVec3 e[3] = { v3_sub(b, a), v3_sub(c, b), v3_sub(a, c) };
    const WrVec3 from[3] = { v3_sub(p, a), v3_sub(p, b), v3_sub(p, c) };
    const WrVec3 n = v3_cross(e[0], e[1]);
    const double nn = v3_dot(n, n);
    bool inside = nn > 0;
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
        inside = inside && v3_dot(v3_cross(e[k], from[k]), n) >= 0;
        least = fmin(least, segment_distance2(from[k], e[k]));
    }
    const double high = v3_dot(n, from[0]);
    return inside ? high * high / nn : least;
}

static double box_distance2(const Node *node, const double p[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double below = (double)node->low[k] - p[k], above = p[k] - (double)node->high[k];
        const double off = fmax(0, fmax(below, above));
        sum += off * off;
    }
    return sum;
}

/* Of triangles at one distance the smallest index is taken, whatever the tree is like. */
double wr_ray_tree_nearest(const WrRayTree *tree, WrVec3 p, double most, int32_t *triangle)
{
    const double at[3] = { p.x, p.y, p.z };
    double least = most * most;
    int32_t stack[STACK], best = -1;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Node *node = &tree->nodes[stack[--top]];
        if (box_distance2(node, at) > least) continue;
        for (int32_t i = node->first; i < node->first + node->count; i++) {
            const double d2 = facet_distance2(&tree->facets[i], p);
            const int32_t index = tree->facets[i].index;
            if (d2 > least || (d2 == least && best >= 0 && index > best)) continue;
            least = d2, best = index;
        }
        if (node->count > 0) continue;
        const int near = box_distance2(&tree->nodes[node->first + 1], at) <
                         box_distance2(&tree->nodes[node->first], at);
        stack[top++] = node->first + 1 - near;
        stack[top++] = node->first + near;
    }
    if (triangle) *triangle = best;
    return sqrt(least);
}

double wr_ray_tree_distance(const WrRayTree *tree, WrVec3 p, double most)
{
    return wr_ray_tree_nearest(tree, p, most, NULL);
}
