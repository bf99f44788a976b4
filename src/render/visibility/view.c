#include "render/visibility/view.h"
#include "render/plan/plan_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "scene/scene.h"
#include "base/vec.h"

#include <math.h>
#include <string.h>

/* World position -> kernel position.
   Kernel units are object units times a power of two after which the radius is 1 .. 2: exact in float, and
   squares neither overflow nor underflow (HC09). All rays and surfaces below are in these units. */
static WrVec3 bring_in(const WrPlacement *place, double scale, WrVec3 w)
{
    return v3_scale(wr_world_to_object(place, w), scale);
}

static void store(double out[3], WrVec3 a)
{
    out[0] = a.x, out[1] = a.y, out[2] = a.z;
}

static void narrow(float out[3], const double in[3])
{
    for (int k = 0; k < 3; k++) out[k] = (float)in[k];
}

static void narrow_rays(const WrRaysd *in, WrRays *out)
{
    narrow(out->q0, in->q0), narrow(out->qx, in->qx), narrow(out->qy, in->qy);
    narrow(out->d0, in->d0), narrow(out->dx, in->dx), narrow(out->dy, in->dy);
    narrow(out->eye, in->eye), narrow(out->toward, in->toward);
    out->s_min = (float)in->s_min;
    out->perspective = in->perspective;
}

/* If the eye is nearer than this, in radii, rays start at it instead of the object's centre, so that points very
   close to the eye are as exact as their distance. */
#define CLOSE 1.5
/* and if its height above an infinite plane is below this part of the distance to the plane's centre */
#define LOW 1e-4

/* Rays as affine functions of the sample's grid position (i, j), whose centre is (i + 1/2, j + 1/2).
   The ray of grid position (i, j) is q0 + i qx + j qy + s (d0 + i dx + j dy). Its origin lies in the plane
   through the object's centre, so that s and positions are small differences and not large numbers with the
   eye's distance in them (HC154). */
static void make_rays(const WrView *view, WrVec3 centre, double grid_w, double grid_h,
                      WrRaysd *rays)
{
    const WrVec3 ahead = v3_sub(centre, view->eye);
    const double away = v3_len(ahead);
    /* then the near part is not straight ahead */
    const bool low = view->endless && fabs(view->eye.z) < LOW * away;
    const bool close = away < CLOSE * view->radius || low;
    double depth = close ? 0.0 : v3_dot(ahead, view->forward); /* depth of the reference plane */
    WrVec3 middle = v3_mad(view->eye, view->ahead, depth);
    WrVec3 x = v3_scale(view->across, 2.0 * view->half_w / grid_w);
    WrVec3 y = v3_scale(view->above, -2.0 * view->half_h / grid_h);
    WrVec3 corner =
        v3_add(v3_scale(view->across, -view->half_w), v3_scale(view->above, view->half_h));
    corner = v3_add(corner, v3_add(v3_scale(x, 0.5), v3_scale(y, 0.5)));
    const WrVec3 zero = { 0, 0, 0 };
    double spread = view->perspective ? depth : 1.0;
    store(rays->q0, v3_mad(middle, corner, spread));
    store(rays->qx, v3_scale(x, spread));
    store(rays->qy, v3_scale(y, spread));
    store(rays->d0, view->perspective ? v3_add(view->ahead, corner) : view->ahead);
    store(rays->dx, view->perspective ? x : zero);
    store(rays->dy, view->perspective ? y : zero);
    rays->s_min = view->near - depth;
    rays->perspective = view->perspective;
    store(rays->eye, view->eye);
    store(rays->toward, v3_neg(view->ahead));
}

/* Eye and view direction for lighting. */
static void make_lit(WrView *view, const WrPlacement *place)
{
    WrRaysd *rays = &view->lit.rays_d;
    view->lit = view->grids[view->grid_count - 1];
    if (!view->stretched) return;
    store(rays->eye, v3_times(view->eye, place->stretch));
    store(rays->toward, v3_neg(wr_place_turn_back(place, place->forward)));
    narrow_rays(rays, &view->lit.rays);
}

/* The grids of 1, 2, 4, ... below K samples a side, and of K.
   They serve passes with fewer samples than K, such as the first samples of adaptive sampling. */
static void make_grids(WrView *view, WrVec3 centre)
{
    const int K = view->samples;
    for (int k = 1; view->grid_count == 0 || k <= K; k = k == K ? K + 1 : 2 * k < K ? 2 * k : K) {
        WrViewGrid *grid = &view->grids[view->grid_count++];
        grid->k = k;
        make_rays(view, centre, (double)(view->grid_w / K * k), (double)(view->grid_h / K * k),
                  &grid->rays_d);
        narrow_rays(&grid->rays_d, &grid->rays);
    }
}

const WrViewGrid *wr_view_grid(const WrView *view, int k)
{
    int i = 0;
    while (i + 1 < view->grid_count && view->grids[i].k != k) i++;
    WR_ASSERT(view->grids[i].k == k);
    return &view->grids[i];
}

/* ---- bounds of the object in the picture ----

   Intervals of x/depth and y/depth, or, orthographic, of x and y, along the camera axes. */

typedef struct Extent {
    double x0, y0, x1, y1;
} Extent;

static const Extent everything = { -INFINITY, -INFINITY, INFINITY, INFINITY };

/* Range of x/z on the sphere of radius r with its centre at (x, z), z > r: the slopes of its tangents through
   the eye.
   In the plane of eye and axis the tangents have slopes (x z +- r sqrt(x^2 + z^2 - r^2)) / (z^2 - r^2).
   Differences of squares are written as products, which keep their digits when the eye is close to the sphere. */
static void tangents(double x, double z, double r, double *least, double *most)
{
    const double half = r * sqrt(fmax(0, x * x + (z - r) * (z + r))), dd = (z - r) * (z + r);
    *least = (x * z - half) / dd;
    *most = (x * z + half) / dd;
}

static Extent extent_of_ball(const WrView *view, WrVec3 centre, double r)
{
    const WrVec3 to = v3_sub(centre, view->eye);
    const double x = v3_dot(to, view->right), y = v3_dot(to, view->up);
    const double z = v3_dot(to, view->forward);
    Extent e = { x - r, y - r, x + r, y + r };
    if (!view->perspective) return e;
    if (!(z > 1.001 * r)) return everything;
    tangents(x, z, r, &e.x0, &e.x1);
    tangents(y, z, r, &e.y0, &e.y1);
    return e;
}

/* Bounds of planar faces: of all their corners, if those are in front of the eye. */
static Extent extent_of_quads(const WrView *view)
{
    Extent e = { INFINITY, INFINITY, -INFINITY, -INFINITY };
    for (int i = 0; i < 4 * view->quad_count; i++) {
        const WrQuadd *quad = &view->quads_d[i / 4];
        WrVec3 p = { quad->origin[0], quad->origin[1], quad->origin[2] };
        const WrVec3 eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
        const WrVec3 ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
        p = v3_mad(p, eu, (i & 1 ? quad->u1 : quad->u0) / v3_dot(eu, eu));
        p = v3_mad(p, ev, (i >> 1 & 1 ? quad->v1 : quad->v0) / v3_dot(ev, ev));
        p = v3_sub(p, view->eye);
        const double z = view->perspective ? v3_dot(p, view->forward) : 1;
        if (!(z > view->near)) return everything;
        const double x = v3_dot(p, view->right) / z, y = v3_dot(p, view->up) / z;
        e = (Extent){ fmin(e.x0, x), fmin(e.y0, y), fmax(e.x1, x), fmax(e.y1, y) };
    }
    return e;
}

/* A pixel clamped to 0 .. size.
   The cast is safe: NaN and numbers beyond the picture are clamped first. */
static int pixel_at(double x, int size)
{
    return x > 0 ? x < size ? (int)x : size : 0;
}

/* radius: of the bounding sphere.
   2 and 3 pixels of margin: rounding, samples off the pixel's centre, and tiles of whole pixels. */
static void find_bounds(WrView *view, WrVec3 centre, double radius, int width, int height)
{
    const Extent e =
        view->quad_count > 0 ? extent_of_quads(view) : extent_of_ball(view, centre, radius);
    view->x0 = pixel_at((e.x0 / view->half_w + 1) / 2 * width - 2, width);
    view->x1 = pixel_at((e.x1 / view->half_w + 1) / 2 * width + 3, width);
    view->y0 = pixel_at((1 - e.y1 / view->half_h) / 2 * height - 2, height);
    view->y1 = pixel_at((1 - e.y0 / view->half_h) / 2 * height + 3, height);
}

/* Intersection of the ray through a point h above the plane with the plane. false: there is none, or it is
   unknown. */
static bool onto_plane(const WrView *view, const WrQuadd *quad, WrVec3 foot, double h, WrVec3 *out)
{
    const WrVec3 n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const WrVec3 p = v3_mad(foot, n, h), way = v3_sub(p, view->eye);
    const double eye = v3_dot(v3_sub(view->eye, foot), n), down = v3_dot(view->ahead, n);
    if (!view->perspective) {
        *out = v3_mad(p, view->ahead, -h / down);
        return fabs(down) > 1e-6;
    }
    const double part = eye / (eye - h);
    *out = v3_mad(view->eye, way, part);
    return part > 0 && part < 1e4;
}

/* Parallax moves the hit beyond the base's borders: the quad is widened to all points of the plane from which
   a ray may reach the relief over the patch. Eight corners suffice, because the map from the box to the plane
   preserves straight lines. */
#define WIDE 1024 /* in u and v, if no better bound is known */

void wr_view_widen(WrView *view, double low, double high)
{
    WrQuadd *quad = &view->quads_d[0];
    WrQuad *single = &view->quads[0];
    const WrVec3 eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const WrVec3 ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    const WrVec3 origin = { quad->origin[0], quad->origin[1], quad->origin[2] };
    double least[2] = { 0, 0 }, most[2] = { 1, 1 };
    for (int i = 0; i < 8; i++) {
        WrVec3 foot = v3_mad(origin, eu, (i & 1) / v3_dot(eu, eu)), at;
        foot = v3_mad(foot, ev, (i >> 1 & 1) / v3_dot(ev, ev));
        const bool known = onto_plane(view, quad, foot, i >> 2 ? high : low, &at);
        for (int k = 0; k < 2; k++) {
            const double x = v3_dot(v3_sub(at, origin), k ? ev : eu);
            least[k] = known ? fmin(least[k], x - 1e-6) : -WIDE;
            most[k] = known ? fmax(most[k], x + 1e-6) : WIDE;
        }
        if (!known) break;
    }
    quad->u0 = least[0], quad->u1 = most[0], quad->v0 = least[1], quad->v1 = most[1];
    quad->least = fmin(least[0], least[1]), quad->most = fmax(most[0], most[1]);
    single->u0 = (float)quad->u0, single->u1 = (float)quad->u1;
    single->v0 = (float)quad->v0, single->v1 = (float)quad->v1;
    single->least = (float)quad->least, single->most = (float)quad->most;
    find_bounds(view, (WrVec3){ 0, 0, 0 }, view->radius, view->grid_w / view->samples,
                view->grid_h / view->samples);
}

#define ENDLESS_TUBE 1e30 /* large, but representable as a float */

/* The shell sphere (or endless tube) contains the relief of a round base: rays start at it. */
void wr_view_grow(WrView *view, double more)
{
    const double radius = view->shape_d.value[0] + more;
    view->shell_d.value[0] = radius * (1 + 1e-6);
    view->shell.value[0] = (float)view->shell_d.value[0];
    if (wr_surfaces[view->shape_d.kind]->inversion == WR_INVERT_CYLINDER)
        view->shell_d.value[1] = view->shell.value[1] = (float)ENDLESS_TUBE;
    find_bounds(view, (WrVec3){ 0, 0, 0 }, view->radius + fmax(more, 0),
                view->grid_w / view->samples, view->grid_h / view->samples);
}

static bool planar(const WrSurfaceInfo *info)
{
    return info->inversion == WR_INVERT_PLANE || info->inversion == WR_INVERT_CUBE;
}

/* Object units -> kernel units: a power of two. */
static double scale_of(const WrSurfaceInfo *info, const WrPlacement *place)
{
    return info->unit_sized ? 1.0 : scalbn(1.0, -ilogb(place->radius));
}

/* Finds the planar faces towards the viewer: towards the eye, in kernel units, or, orthographic (NULL), against
   `forward`. True if there are any. */
static bool find_facing(const WrShape *shape, double scale, const WrVec3 *eye, WrVec3 forward,
                        bool facing[6])
{
    bool any = false;
    for (int face = 0; face < wr_surfaces[shape->kind]->faces; face++) {
        WrSurfacePoint at;
        wr_surface_at(shape, face, 0, 0, &at);
        const WrVec3 to = eye ? v3_sub(*eye, v3_scale(at.p, scale)) : v3_neg(forward);
        facing[face] = v3_dot(to, at.n_unit) > 0;
        any = any || facing[face];
    }
    return any;
}

/* If two faces that share an edge both face the viewer, or both face away, each extends beyond it by the
   rounding error of u and v, so that a ray along it hits one of them. At an outline neither does, because
   samples beside it do not belong to the object.
   The overlap is of the size of rounding: 2^-48 in double, 2^-21 in float. */
#define JOINT 0x1p-48
#define JOINT_SINGLE 0x1p-21f

/* True if such a face, other than `own`, contains that point. */
static bool joins(const WrShape *shape, const bool facing[6], int own, WrVec3 p)
{
    for (int face = 0; face < wr_surfaces[shape->kind]->faces; face++) {
        WrSurfacePoint at;
        if (face == own || facing[face] != facing[own]) continue;
        wr_surface_at(shape, face, 0, 0, &at);
        if (fabs(v3_dot(v3_sub(p, at.p), at.n_unit)) < 1e-9 * v3_len(at.pu)) return true;
    }
    return false;
}

static void bound_quad(const WrShape *shape, const bool facing[6], int own, WrQuadd *quad,
                       WrQuad *single)
{
    const WrSurfaceCell cell = wr_surface_cell(shape, own);
    const double sides[4] = { cell.u0, cell.u1, cell.v0, cell.v1 };
    double to[4];
    float to_single[4];
    for (int k = 0; k < 4; k++) {
        WrSurfacePoint at;
        wr_surface_at(shape, own, k < 2 ? sides[k] : (cell.u0 + cell.u1) / 2,
                      k < 2 ? (cell.v0 + cell.v1) / 2 : sides[k], &at);
        const bool joined = joins(shape, facing, own, at.p);
        const double more = joined ? k % 2 ? 1 : -1 : 0;
        to[k] = sides[k] + more * JOINT;
        to_single[k] = (float)sides[k] + (float)more * JOINT_SINGLE;
    }
    quad->u0 = to[0], quad->u1 = to[1], quad->v0 = to[2], quad->v1 = to[3];
    single->u0 = to_single[0], single->u1 = to_single[1];
    single->v0 = to_single[2], single->v1 = to_single[3];
    quad->least = single->least = 0, quad->most = single->most = 1;
}

/* Extends a quad beyond its sides, as far as rays are followed. */
static void unbound_quad(WrQuadd *quad, WrQuad *single)
{
    quad->u0 = quad->v0 = quad->least = -WR_ENDLESS;
    quad->u1 = quad->v1 = quad->most = WR_ENDLESS;
    single->u0 = single->v0 = single->least = (float)-WR_ENDLESS;
    single->u1 = single->v1 = single->most = (float)WR_ENDLESS;
}

static void add_quad(WrView *view, const WrShape *shape, const bool facing[6], int face)
{
    WrQuadd *quad = &view->quads_d[view->quad_count];
    WrQuad *single = &view->quads[view->quad_count];
    WrSurfacePoint at;
    wr_surface_at(shape, face, 0, 0, &at);
    WrVec3 pu = v3_scale(at.pu, view->scale), pv = v3_scale(at.pv, view->scale);
    store(quad->origin, v3_scale(at.p, view->scale));
    store(quad->normal, at.n_unit);
    store(quad->eu, v3_scale(pu, 1.0 / v3_dot(pu, pu)));
    store(quad->ev, v3_scale(pv, 1.0 / v3_dot(pv, pv)));
    narrow(single->origin, quad->origin), narrow(single->normal, quad->normal);
    narrow(single->eu, quad->eu), narrow(single->ev, quad->ev);
    if (wr_shape_endless(shape)) unbound_quad(quad, single);
    else bound_quad(shape, facing, face, quad, single);
    view->quad_face[view->quad_count++] = face;
}

/* Planar faces. Back faces come first, so that in a closed box, which is convex, the front faces cover them. */
static void make_quads(WrView *view, const WrShape *shape)
{
    bool facing[6];
    find_facing(shape, view->scale, view->perspective ? &view->eye : NULL, view->ahead, facing);
    for (int near = view->cull ? 1 : 0; near < 2; near++)
        for (int face = 0; face < wr_surfaces[shape->kind]->faces; face++)
            if (facing[face] == (near == 1)) add_quad(view, shape, facing, face);
}

bool wr_view_outside(const WrScene *scene, double radius, double turn_deg, int width, int height,
                     bool *outside, WrError *err)
{
    WrPlacement place;
    bool facing[6];
    if (!wr_scene_place_with_radius(scene, radius, turn_deg, (double)width / height, &place, err))
        return false;
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const double scale = scale_of(info, &place);
    const WrVec3 eye = bring_in(&place, scale, place.eye);
    if (planar(info)) {
        *outside = find_facing(&scene->shape, scale, place.orthographic ? NULL : &eye,
                               wr_place_shrink_back(&place, place.forward), facing);
        return true;
    }
    const WrVec3 away = v3_sub(eye, v3_scale(place.centre, scale));
    *outside = place.orthographic || v3_len(away) > place.radius * scale;
    return true;
}

/* Depth of objects in one scene is measured along the view direction from the camera's target, in world units;
   deep . p + deep_from for a point p in kernel units. */
static void find_depth(WrView *view, const WrCamera *camera, const WrPlacement *place)
{
    const WrVec3 centre = v3_scale(place->centre, view->scale);
    const WrVec3 deep = v3_scale(view->forward, place->size / view->scale);
    const double middle = v3_dot(place->forward, v3_sub(place->position, camera->target));
    store(view->deep, deep);
    view->deep_from = middle - v3_dot(deep, centre);
    view->nearest = view->endless ? -INFINITY : middle - place->radius * place->size;
}

bool wr_view_shows_light(const WrScene *scene, int k)
{
    bool any = false;
    for (int i = 0; i < scene->light_count; i++) any |= light_shines(&scene->lights[i]);
    return !any || light_shines(&scene->lights[k]);
}

static void make_lights(WrView *view, const WrScene *scene, const WrPlacement *place)
{
    const WrVec3 ahead = { 0, 0, 1 };
    view->lights = wr_alloc((size_t)scene->light_count + 1, sizeof *view->lights);
    view->lights_d = wr_alloc((size_t)scene->light_count + 1, sizeof *view->lights_d);
    view->light_count = 0;
    for (int k = 0; k < scene->light_count; k++) {
        const WrLight *light = &scene->lights[k];
        if (!wr_view_shows_light(scene, k)) continue;
        const int i = view->light_count++;
        WrKernLightd *out = &view->lights_d[i];
        out->point = wr_light_kinds[light->kind].placed;
        WrVec3 where = out->point
                           ? v3_times(bring_in(place, view->scale, light->where), place->stretch)
                           : v3_unit(wr_place_turn_back(place, light->where), ahead);
        store(out->where, where);
        store(out->rgb, v3_scale(light->colour, light->strength));
        out->radius = light->size_deg * (WR_PI / 180);
        view->lights[i].shadow = out->shadow = light->shadow;
        view->lights[i].radius = out->radius;
        view->lights[i].point = out->point;
        narrow(view->lights[i].where, out->where);
        narrow(view->lights[i].rgb, out->rgb);
    }
}

/* wr_shape_scaled in double.
   In double: the float version clamps to the range of float. */
static void scale_shape(const WrShape *shape, double scale, WrShape *out)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    *out = *shape;
    out->scale = shape->scale * scale;
    int at = 0;
    for (int p = 0; p < WR_SURFACE_PARAMS && info->params[p].name; p++)
        for (int i = 0; i < info->params[p].components; i++, at++)
            out->value[at] = shape->value[at] * (info->params[p].length ? scale : 1.0);
}

/* An upper bound: the largest |F| at the nearest possible depth, times pixels per unit (E21, E50). -1:
   unknown. */
bool wr_view_rise(const WrScene *scene, const WrField *field, double radius, double turn_deg,
                  int width, int height, double *rise, WrError *err)
{
    WrPlacement place;
    float low, high;
    *rise = -1;
    if (!wr_scene_place_with_radius(scene, radius, turn_deg, (double)width / height, &place, err))
        return false;
    if (scene->analytic.kind != WR_ANALYTIC_OFF) return true;
    wr_field_range(field, &low, &high);
    const double most = fabs(scene->height) * fmax(fabs((double)low), fabs((double)high));
    const double reach = (place.radius + most) * place.size;
    const double depth = v3_dot(v3_sub(place.position, place.eye), place.forward) - reach;
    const double per = height / (2 * place.half_height) / (place.orthographic ? 1 : depth);
    if (place.orthographic || depth > 0) *rise = most * place.size * per;
    return true;
}

bool wr_view_init(WrView *view, const WrScene *scene, double radius, const WrPlan *plan,
                  double turn_deg, int width, int height, WrError *err)
{
    *view = (WrView){ .samples = plan->samples,
                      .grid_w = width * plan->samples,
                      .grid_h = height * plan->samples,
                      .perspective = wr_plan_runs(plan, WR_EFFECT_PERSPECTIVE),
                      .cull = !wr_plan_runs(plan, WR_EFFECT_BACK) };
    WrPlacement place;
    double aspect = (double)width / height;
    if (!wr_scene_place_with_radius(scene, radius, turn_deg, aspect, &place, err)) return false;
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    view->scale = scale_of(info, &place);
    view->radius = place.radius * view->scale;
    view->eye = bring_in(&place, view->scale, place.eye);
    view->right = wr_place_dual_back(&place, place.right);
    view->up = wr_place_dual_back(&place, place.up);
    view->forward = wr_place_dual_back(&place, place.forward);
    view->across = wr_place_shrink_back(&place, place.right);
    view->above = wr_place_shrink_back(&place, place.up);
    view->ahead = wr_place_shrink_back(&place, place.forward);
    memcpy(view->rotation, place.rotation, sizeof view->rotation);
    view->stretched = place.stretched;
    view->endless = wr_shape_endless(&scene->shape);
    store(view->stretch, place.stretch);
    store(view->cofactor, place.cofactor);
    view->half_h = place.half_height * (view->perspective ? 1.0 : view->scale / place.size);
    view->half_w = view->half_h * aspect;
    view->near = WR_NEAR_PLANE * view->radius;
    wr_shape_scaled(&scene->shape, view->scale, &view->shape);
    scale_shape(&scene->shape, view->scale, &view->shape_d);
    view->shell = view->shape, view->shell_d = view->shape_d;
    make_grids(view, v3_scale(place.centre, view->scale));
    make_lit(view, &place);
    if (planar(info)) make_quads(view, &scene->shape);
    find_bounds(view, v3_scale(place.centre, view->scale), view->radius, width, height);
    make_lights(view, scene, &place);
    find_depth(view, &scene->camera, &place);
    return true;
}

void wr_view_fini(WrView *view)
{
    wr_free(view->lights);
    wr_free(view->lights_d);
    view->lights = NULL;
    view->lights_d = NULL;
}
