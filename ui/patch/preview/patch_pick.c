#include "ui/patch/preview/patch_pick.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/vec.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/data.h"
#include "surface/ray_tree.h"
#include "surface/surface.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#define NET 96  /* grid cells along a side of a curved surface */
#define FLAT 8  /* grid cells of a flat one with straight edges */
#define BLOCK 8 /* cells along a block's side */
#define NEWTON_STEPS 12
#define HAIR 0.3          /* pixels */
#define CLOSE_ENOUGH 1e-7 /* pixels */
/* fraction of the object's radius: a surface nearer by more than this hides the point */
#define HIDDEN_BY 0.02
#define COINCIDE 1e-3 /* of the radius: objects nearer to each other share a surface */

typedef struct Knot {
    double x, y, close; /* pixels; 1/depth or -depth: larger is nearer */
    bool out;           /* behind the eye */
} Knot;

typedef struct Bounds {
    double x0, y0, x1, y1;
} Bounds;

struct WrPatchPick {
    WrShape shape;
    const WrSurfaceInfo *info;
    double axes[9], shift[3]; /* object space -> right, up, forward of the camera */
    double scale_x,
        scale_y; /* pixels per unit right (up) at depth 1; at any depth if orthographic */
    double middle_x, middle_y, radius;
    bool orthographic;
    /* objects of triangles */
    WrTriangles *mesh; /* shared; NULL: any other */
    WrRayTree *tree;   /* owned; NULL: not needed yet, or no memory */
    WrPlacement place;
    int cells;      /* along a side */
    Knot *knots;    /* [faces][cells + 1][cells + 1], owned */
    Bounds *bounds; /* [faces][cells / BLOCK][cells / BLOCK], owned */
};

/* ---- projection ---- */

static WrVec3 turned(const WrPatchPick *pick, WrVec3 p)
{
    const double *a = pick->axes;
    return (WrVec3){ a[0] * p.x + a[1] * p.y + a[2] * p.z, a[3] * p.x + a[4] * p.y + a[5] * p.z,
                     a[6] * p.x + a[7] * p.y + a[8] * p.z };
}

/* Camera space: z is the depth. */
static WrVec3 seen_from_eye(const WrPatchPick *pick, WrVec3 p)
{
    WrVec3 q = turned(pick, p);
    return (WrVec3){ q.x + pick->shift[0], q.y + pick->shift[1], q.z + pick->shift[2] };
}

static bool to_pixel(const WrPatchPick *pick, WrVec3 c, double *x, double *y)
{
    double over = pick->orthographic ? 1.0 : 1.0 / c.z;
    if (!pick->orthographic && !(c.z > 1e-6 * pick->radius)) return false;
    *x = pick->middle_x + pick->scale_x * c.x * over;
    *y = pick->middle_y - pick->scale_y * c.y * over;
    return true;
}

static Knot knot_at(const WrPatchPick *pick, int face, double u, double v)
{
    WrSurfacePoint s;
    wr_surface_at(&pick->shape, face, u, v, &s);
    WrVec3 c = seen_from_eye(pick, s.p);
    Knot knot = { .out = true };
    knot.out = !to_pixel(pick, c, &knot.x, &knot.y);
    knot.close = pick->orthographic ? -c.z : 1.0 / c.z;
    return knot;
}

/* ---- grid of projected points ---- */

static const Knot *knots_of(const WrPatchPick *pick, int face)
{
    size_t side = (size_t)pick->cells + 1;
    return pick->knots + (size_t)face * side * side;
}

static Bounds bound_block(const WrPatchPick *pick, const Knot *knots, int bu, int bv)
{
    Bounds b = { DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX };
    for (int j = bv * BLOCK; j <= (bv + 1) * BLOCK; j++) {
        for (int i = bu * BLOCK; i <= (bu + 1) * BLOCK; i++) {
            const Knot *k = &knots[j * (pick->cells + 1) + i];
            if (k->out) continue;
            b.x0 = fmin(b.x0, k->x);
            b.y0 = fmin(b.y0, k->y);
            b.x1 = fmax(b.x1, k->x);
            b.y1 = fmax(b.y1, k->y);
        }
    }
    return b;
}

static void make_net(WrPatchPick *pick)
{
    int n = pick->cells, faces = pick->info->faces, blocks = n / BLOCK;
    size_t side = (size_t)n + 1;
    pick->knots = wr_alloc((size_t)faces * side * side, sizeof *pick->knots);
    pick->bounds = wr_alloc((size_t)faces * (size_t)blocks * (size_t)blocks, sizeof *pick->bounds);
    for (int face = 0; face < faces; face++) {
        Knot *knots = pick->knots + (size_t)face * side * side;
        const WrSurfaceCell cell = wr_surface_cell(&pick->shape, face);
        for (int j = 0; j <= n; j++)
            for (int i = 0; i <= n; i++)
                knots[(size_t)j * side + (size_t)i] =
                    knot_at(pick, face, cell.u0 + (cell.u1 - cell.u0) * i / n,
                            cell.v0 + (cell.v1 - cell.v0) * j / n);
        for (int b = 0; b < blocks * blocks; b++)
            pick->bounds[face * blocks * blocks + b] =
                bound_block(pick, knots, b % blocks, b / blocks);
    }
}

WrPatchPick *wr_patch_pick_new(const WrScene *scene, double turn_deg, int width, int height,
                               WrError *err)
{
    WrPlacement at;
    if (width < 1 || height < 1) {
        wr_fail(err, "a view of %d x %d pixels: must be at least 1 x 1", width, height);
        return NULL;
    }
    double aspect = (double)width / height;
    if (!wr_scene_place(scene, turn_deg, aspect, &at, err)) return NULL;
    WrPatchPick *pick = wr_alloc(1, sizeof *pick);
    pick->shape = scene->shape;
    wr_shape_borrow_data(&pick->shape, wr_surface_data_share(scene->shape.data));
    pick->info = wr_surfaces[scene->shape.kind];
    pick->orthographic = at.orthographic;
    pick->radius = at.radius * at.size;
    const WrVec3 axes[3] = { at.right, at.up, at.forward };
    for (int k = 0; k < 3; k++) {
        const double *r = at.rotation;
        WrVec3 a = axes[k];
        for (int c = 0; c < 3; c++)
            pick->axes[3 * k + c] = at.size * (a.x * r[c] + a.y * r[3 + c] + a.z * r[6 + c]);
    }
    const WrVec3 centre = turned(pick, at.centre), from = v3_sub(at.position, at.eye);
    pick->shift[0] = v3_dot(at.right, from) - centre.x;
    pick->shift[1] = v3_dot(at.up, from) - centre.y;
    pick->shift[2] = v3_dot(at.forward, from) - centre.z;
    pick->middle_x = width / 2.0;
    pick->middle_y = height / 2.0;
    pick->scale_x = pick->middle_x / (at.half_height * aspect);
    pick->scale_y = pick->middle_y / at.half_height;
    pick->place = at;
    if (pick->info->held && scene->triangles) {
        pick->mesh = wr_triangles_share(scene->triangles);
        return pick;
    }
    const WrInversion inversion = pick->info->inversion;
    const bool straight = inversion == WR_INVERT_PLANE || inversion == WR_INVERT_CUBE;
    pick->cells = straight ? FLAT : NET;
    make_net(pick);
    return pick;
}

void wr_patch_pick_free(WrPatchPick *pick)
{
    if (!pick) return;
    wr_surface_data_free((WrSurfaceData *)pick->shape.data);
    wr_free(pick->knots);
    wr_free(pick->bounds);
    wr_ray_tree_free(pick->tree);
    wr_triangles_free(pick->mesh);
    wr_free(pick);
}

/* ---- objects of triangles ---- */

bool wr_patch_pick_is_mesh(const WrPatchPick *pick)
{
    return pick->mesh != NULL;
}

bool wr_patch_pick_project_point(const WrPatchPick *pick, WrVec3 p, double *x, double *y)
{
    const WrVec3 from = v3_sub(wr_object_to_world(&pick->place, p), pick->place.eye);
    const WrVec3 c = { v3_dot(from, pick->place.right), v3_dot(from, pick->place.up),
                       v3_dot(from, pick->place.forward) };
    return to_pixel(pick, c, x, y);
}

/* Depth at which orthographic rays start: before the object. */
static double before_object(const WrPlacement *at)
{
    return v3_dot(v3_sub(at->position, at->eye), at->forward) - 2.0 * at->radius * at->size;
}

WrVec3 wr_patch_pick_eye(const WrPatchPick *pick)
{
    const WrPlacement *at = &pick->place;
    const double back = pick->orthographic ? 1e4 * at->radius * at->size - before_object(at) : 0.0;
    return wr_world_to_object(at, v3_mad(at->eye, at->forward, -back));
}

/* The ray of a pixel in the object's space. */
static void ray_of(const WrPatchPick *pick, double x, double y, WrVec3 *o, WrVec3 *d)
{
    const WrPlacement *at = &pick->place;
    const double across = (x - pick->middle_x) / pick->scale_x;
    const double down = (y - pick->middle_y) / pick->scale_y;
    const WrVec3 beside = v3_mad(v3_scale(at->right, across), at->up, -down);
    WrVec3 from = at->eye;
    if (pick->orthographic) from = v3_mad(v3_add(from, beside), at->forward, before_object(at));
    const WrVec3 way = pick->orthographic ? at->forward : v3_add(at->forward, beside);
    *o = wr_world_to_object(at, from);
    *d = v3_sub(wr_world_to_object(at, v3_add(from, way)), *o);
}

static void fill_spot(const WrPatchPick *pick, const WrRayHit *hit, WrVec3 d, WrPatchSpot *spot)
{
    const WrTriangleCorner *c[3];
    WrVec3 p[3], grad_v, none = { 0, 0, 0 };
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        c[k] = wr_triangle_corner(pick->mesh, hit->triangle, k);
        p[k] = v3_load(c[k]->p);
        uv[k][0] = (double)c[k]->u, uv[k][1] = (double)c[k]->v;
        spot->u += hit->share[k] * uv[k][0];
        spot->v += hit->share[k] * uv[k][1];
        spot->p = v3_mad(spot->p, p[k], hit->share[k]);
    }
    WrVec3 gradient = none;
    if (!wr_triangle_gradients(p, (const double(*)[2])uv, &spot->n, &gradient, &grad_v))
        spot->n = v3_unit(v3_neg(d), d);
    else spot->along = v3_unit(v3_cross(grad_v, spot->n), none);
    if (v3_dot(spot->along, gradient) < 0) spot->along = v3_neg(spot->along);
    spot->back = v3_dot(spot->n, d) > 0;
    if (spot->back) spot->n = v3_neg(spot->n);
    const WrPlacement *at = &pick->place;
    const WrVec3 from = v3_sub(wr_object_to_world(at, spot->p), at->eye);
    spot->depth = v3_dot(from, at->forward);
    spot->pixel = (pick->orthographic ? 1.0 : spot->depth) / (pick->scale_y * at->size);
}

static bool hit_mesh(WrPatchPick *pick, double x, double y, WrPatchSpot *out)
{
    WrVec3 o, d;
    WrRayHit hit;
    if (!pick->tree) pick->tree = wr_ray_tree_new(pick->mesh, 0, pick->mesh->triangle_count, NULL);
    if (!pick->tree) return false;
    ray_of(pick, x, y, &o, &d);
    if (!wr_ray_tree_closest(pick->tree, o, d, INFINITY, false, &hit)) return false;
    WrPatchSpot spot = { .x = x, .y = y };
    fill_spot(pick, &hit, d, &spot);
    *out = spot;
    return true;
}

/* ---- picking ---- */

/* The nearest cell under a pixel: its depth, and (u, v) interpolated from its corners. */
typedef struct Found {
    double close, u, v;
    int face;
    bool any;
} Found;

static void try_triangle(const Knot *const k[3], const double uv[3][2], double x, double y,
                         int face, Found *best)
{
    if (k[0]->out || k[1]->out || k[2]->out) return;
    double ax = k[1]->x - k[0]->x, ay = k[1]->y - k[0]->y;
    double bx = k[2]->x - k[0]->x, by = k[2]->y - k[0]->y;
    double area = ax * by - ay * bx;
    if (!(fabs(area) > 1e-12)) return;
    double px = x - k[0]->x, py = y - k[0]->y;
    double s = (px * by - py * bx) / area, t = (ax * py - ay * px) / area;
    const double slip = 1e-6; /* cells overlap slightly, to leave no gaps */
    if (!(s >= -slip && t >= -slip && s + t <= 1.0 + slip)) return;
    double close = (1.0 - s - t) * k[0]->close + s * k[1]->close + t * k[2]->close;
    if (best->any && close <= best->close) return;
    best->any = true;
    best->close = close;
    best->face = face;
    best->u = uv[0][0] + s * (uv[1][0] - uv[0][0]) + t * (uv[2][0] - uv[0][0]);
    best->v = uv[0][1] + s * (uv[1][1] - uv[0][1]) + t * (uv[2][1] - uv[0][1]);
}

static void try_cell(const WrPatchPick *pick, int face, int i, int j, double x, double y,
                     Found *best)
{
    int n = pick->cells;
    const Knot *k = knots_of(pick, face) + (size_t)j * ((size_t)n + 1) + (size_t)i;
    const Knot *const a[3] = { k, k + 1, k + n + 2 }, *const b[3] = { k, k + n + 2, k + n + 1 };
    const WrSurfaceCell c = wr_surface_cell(&pick->shape, face);
    const double du = (c.u1 - c.u0) / n, dv = (c.v1 - c.v0) / n;
    double u0 = c.u0 + du * i, u1 = c.u0 + du * (i + 1), v0 = c.v0 + dv * j,
           v1 = c.v0 + dv * (j + 1);
    const double ua[3][2] = { { u0, v0 }, { u1, v0 }, { u1, v1 } };
    const double ub[3][2] = { { u0, v0 }, { u1, v1 }, { u0, v1 } };
    try_triangle(a, ua, x, y, face, best);
    try_triangle(b, ub, x, y, face, best);
}

static Found find(const WrPatchPick *pick, double x, double y)
{
    Found best = { .any = false };
    int blocks = pick->cells / BLOCK;
    for (int face = 0; face < pick->info->faces; face++) {
        const Bounds *bounds = pick->bounds + face * blocks * blocks;
        for (int b = 0; b < blocks * blocks; b++) {
            if (x < bounds[b].x0 || x > bounds[b].x1 || y < bounds[b].y0 || y > bounds[b].y1)
                continue;
            int i0 = b % blocks * BLOCK, j0 = b / blocks * BLOCK;
            for (int c = 0; c < BLOCK * BLOCK; c++)
                try_cell(pick, face, i0 + c % BLOCK, j0 + c / BLOCK, x, y, &best);
        }
    }
    return best;
}

/* The point at (u, v), and the Jacobian of its pixel position: { dx/du, dx/dv, dy/du, dy/dv }. */
static bool spot_at(const WrPatchPick *pick, int face, double u, double v, WrPatchSpot *out,
                    double slopes[4])
{
    WrSurfacePoint s;
    wr_surface_at(&pick->shape, face, u, v, &s);
    WrVec3 c = seen_from_eye(pick, s.p);
    WrPatchSpot spot = { .u = u, .v = v, .face = face, .depth = c.z };
    if (!to_pixel(pick, c, &spot.x, &spot.y)) return false;
    const WrVec3 d[2] = { turned(pick, s.pu), turned(pick, s.pv) };
    for (int k = 0; k < 2; k++) {
        double over = pick->orthographic ? 1.0 : 1.0 / c.z;
        double drift = pick->orthographic ? 0.0 : d[k].z * over;
        slopes[k] = pick->scale_x * over * (d[k].x - c.x * drift);
        slopes[2 + k] = -pick->scale_y * over * (d[k].y - c.y * drift);
    }
    *out = spot;
    return true;
}

static double into(double x, bool closed, double low, double high)
{
    if (closed) return x - floor(x);
    return x < low ? low : x > high ? high : x;
}

static bool invert(const double m[4], double out[4])
{
    double det = m[0] * m[3] - m[1] * m[2];
    double size = (fabs(m[0]) + fabs(m[2])) * (fabs(m[1]) + fabs(m[3]));
    if (!(fabs(det) > 1e-9 * size) || !(size > 0.0)) return false;
    out[0] = m[3] / det;
    out[1] = -m[1] / det;
    out[2] = -m[2] / det;
    out[3] = m[0] / det;
    return true;
}

static double off(const WrPatchSpot *spot, double x, double y)
{
    return hypot(spot->x - x, spot->y - y);
}

/* Newton's method from pixel to (u, v), with shorter steps if a full one increases the error. */
static bool polish(const WrPatchPick *pick, double x, double y, WrPatchSpot *spot)
{
    double slopes[4], inverse[4], longest = 2.0 / pick->cells;
    bool closed_u = pick->info->closed_u, closed_v = pick->info->closed_v;
    const WrSurfaceCell c = wr_surface_cell(&pick->shape, spot->face);
    if (!spot_at(pick, spot->face, spot->u, spot->v, spot, slopes)) return false;
    for (int step = 0; step < NEWTON_STEPS && off(spot, x, y) > CLOSE_ENOUGH; step++) {
        if (!invert(slopes, inverse)) break;
        double rx = x - spot->x, ry = y - spot->y;
        double du = inverse[0] * rx + inverse[1] * ry, dv = inverse[2] * rx + inverse[3] * ry;
        double reach = fmax(fabs(du), fabs(dv)), part = reach > longest ? longest / reach : 1.0;
        bool better = false;
        for (int half = 0; half < 6 && !better; half++, part /= 2.0) {
            WrPatchSpot next;
            double next_slopes[4];
            if (!spot_at(pick, spot->face, into(spot->u + part * du, closed_u, c.u0, c.u1),
                         into(spot->v + part * dv, closed_v, c.v0, c.v1), &next, next_slopes))
                continue;
            better = off(&next, x, y) < off(spot, x, y);
            if (!better) continue;
            *spot = next;
            for (int k = 0; k < 4; k++) slopes[k] = next_slopes[k];
        }
        if (!better) break;
    }
    return off(spot, x, y) < 1.0;
}

/* The grid's flat cells miss a thin rim of the object along its silhouette: search from slightly inside. */
static bool pick_near(const WrPatchPick *pick, double x, double y, WrPatchSpot *out)
{
    static const double around[4][2] = { { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, 1 } };
    for (int k = 0; k < 4; k++) {
        Found found = find(pick, x + HAIR * around[k][0], y + HAIR * around[k][1]);
        WrPatchSpot spot = { .u = found.u, .v = found.v, .face = found.face };
        if (!found.any || !polish(pick, x, y, &spot) || off(&spot, x, y) > 1e-3) continue;
        *out = spot;
        return true;
    }
    return false;
}

bool wr_patch_pick_at(WrPatchPick *pick, double x, double y, WrPatchSpot *out)
{
    if (pick->mesh) return hit_mesh(pick, x, y, out);
    Found found = find(pick, x, y);
    if (!found.any) return pick_near(pick, x, y, out);
    WrPatchSpot spot = { .u = found.u, .v = found.v, .face = found.face };
    if (!polish(pick, x, y, &spot)) return false;
    *out = spot;
    return true;
}

bool wr_patch_pick_project(const WrPatchPick *pick, int face, double u, double v, WrPatchSpot *out,
                           bool *hidden)
{
    double slopes[4];
    if (pick->mesh || !spot_at(pick, face, u, v, out, slopes)) return false;
    if (!hidden) return true;
    Found nearest = find(pick, out->x, out->y);
    double depth = pick->orthographic ? -nearest.close : 1.0 / nearest.close;
    *hidden = nearest.any && depth < out->depth - HIDDEN_BY * pick->radius;
    return true;
}

bool wr_patch_pick_slopes(const WrPatchPick *pick, const WrPatchSpot *at, double jacobian[4])
{
    WrPatchSpot spot;
    double slopes[4];
    return !pick->mesh && spot_at(pick, at->face, at->u, at->v, &spot, slopes) &&
           invert(slopes, jacobian);
}

/* ---- picking among all objects ---- */

struct WrObjectPicks {
    WrPatchPick *pick[WR_OBJECTS_MAX]; /* one per object; NULL: hidden. Owned */
    int count;
};

static void take_tree(WrPatchPick *pick, const WrObjectPicks *before)
{
    for (int i = 0; pick->mesh && before && !pick->tree && i < before->count; i++) {
        const WrPatchPick *old = before->pick[i];
        if (!old || !old->mesh || old->mesh->key != pick->mesh->key) continue;
        if (old->tree) pick->tree = wr_ray_tree_share(old->tree);
    }
}

WrObjectPicks *wr_object_picks_new(const WrScene *scene, double turn_deg, int width, int height,
                                   const WrObjectPicks *before, WrError *err)
{
    WrObjectPicks *picks = wr_alloc(1, sizeof *picks);
    picks->count = wr_scene_object_count(scene);
    for (int i = 0; i < picks->count; i++) {
        const double aspect = height > 0 ? (double)width / height : 1;
        if (!wr_scene_shows(scene, i, aspect)) continue;
        WrScene *part = wr_scene_object_alone(scene, i, aspect);
        picks->pick[i] = wr_patch_pick_new(part, turn_deg, width, height, err);
        wr_scene_free(part);
        if (picks->pick[i]) {
            take_tree(picks->pick[i], before);
            continue;
        }
        wr_object_picks_free(picks);
        return NULL;
    }
    return picks;
}

void wr_object_picks_share_tree(WrObjectPicks *picks, const WrRayTree *tree, uint64_t mesh_key)
{
    for (int i = 0; i < picks->count; i++) {
        WrPatchPick *pick = picks->pick[i];
        if (!pick || !pick->mesh || pick->tree || pick->mesh->key != mesh_key) continue;
        pick->tree = wr_ray_tree_share(tree);
    }
}

void wr_object_picks_free(WrObjectPicks *picks)
{
    if (!picks) return;
    for (int i = 0; i < picks->count; i++) wr_patch_pick_free(picks->pick[i]);
    wr_free(picks);
}

int wr_object_picks_at(const WrObjectPicks *picks, int chosen, double x, double y, WrPatchSpot *out)
{
    int found = -1;
    for (int i = 0; i < picks->count; i++) {
        WrPatchSpot spot;
        if (!picks->pick[i] || !wr_patch_pick_at(picks->pick[i], x, y, &spot)) continue;
        const double close = COINCIDE * picks->pick[i]->radius;
        const double favour = i == chosen ? close : found == chosen ? -close : 0;
        if (found >= 0 && spot.depth >= out->depth + favour) continue;
        found = i;
        *out = spot;
    }
    return found;
}

const WrPatchPick *wr_object_picks_of(const WrObjectPicks *picks, int object)
{
    return object >= 0 && object < picks->count ? picks->pick[object] : NULL;
}
