#include "render/reference/reference_view.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "scene/scene.h"
#include "base/vec.h"

#include <math.h>

/* Transforms a direction. */
static WrVec3 world_to_object(const WrPlacement *place, WrVec3 w)
{
    const double *m = place->rotation;
    return (WrVec3){ m[0] * w.x + m[3] * w.y + m[6] * w.z, m[1] * w.x + m[4] * w.y + m[7] * w.z,
                     m[2] * w.x + m[5] * w.y + m[8] * w.z };
}

/* Transforms a point: w = position + size M S (p - centre), S the stretch along the object's axes. */
static WrVec3 point_to_object(const WrPlacement *place, WrVec3 w)
{
    const WrVec3 away = world_to_object(place, v3_sub(w, place->position)), s = place->stretch;
    return (WrVec3){ away.x / s.x / place->size + place->centre.x,
                     away.y / s.y / place->size + place->centre.y,
                     away.z / s.z / place->size + place->centre.z };
}

/* Transforms a direction by the inverse of the stretch. */
static WrVec3 way_to_object(const WrPlacement *place, WrVec3 w)
{
    const WrVec3 own = world_to_object(place, w), s = place->stretch;
    return (WrVec3){ own.x / s.x, own.y / s.y, own.z / s.z };
}

WrVec3 wr_reference_stretched(const WrReferenceView *view, WrVec3 p)
{
    return v3_times(p, view->stretch);
}

WrVec3 wr_reference_normal_stretched(const WrReferenceView *view, WrVec3 n)
{
    const WrVec3 turned = v3_times(n, view->cofactor), none = { 0, 0, 0 };
    return view->stretched ? v3_unit(turned, none) : n;
}

static void take_lights(WrReferenceView *view, const WrScene *scene, const WrPlacement *place)
{
    view->lights = wr_alloc((size_t)scene->light_count + 1, sizeof *view->lights);
    view->light_count = scene->light_count;
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        WrReferenceLight *out = &view->lights[i];
        const WrVec3 ahead = { 0, 0, 1 };
        out->point = wr_light_kinds[light->kind].placed;
        out->where = out->point ? v3_times(point_to_object(place, light->where), place->stretch)
                                : v3_unit(world_to_object(place, light->where), ahead);
        out->radius = light->size_deg * (WR_PI / 180);
        out->shadow = light->shadow;
        out->rgb[0] = light->colour.x * light->strength;
        out->rgb[1] = light->colour.y * light->strength;
        out->rgb[2] = light->colour.z * light->strength;
    }
}

/* Hides the back faces of a closed box seen from outside. */
static void hide_faces(WrReferenceView *view)
{
    bool away[6] = { false }, outside = false;
    for (int face = 0; face < view->info->faces; face++) {
        WrSurfacePoint at;
        const WrSurfaceCell c = wr_surface_cell(view->shape, face);
        wr_surface_at(view->shape, face, (c.u0 + c.u1) / 2, (c.v0 + c.v1) / 2, &at);
        WrVec3 to = view->perspective ? v3_sub(view->eye, at.p) : view->toward;
        away[face] = !(v3_dot(to, at.n_unit) > 0);
        outside = outside || !away[face];
    }
    for (int face = 0; face < view->info->faces; face++)
        view->hidden[face] = view->info->convex_closed && outside && away[face];
}

static bool take_mesh(WrReferenceView *view, const WrScene *scene, WrError *err)
{
    WrTriangles *mesh =
        scene->triangles ? wr_triangles_share(scene->triangles) : wr_triangles_square();
    if (mesh->patches) {
        view->mesh.source = mesh; /* contains the patches */
        return wr_reference_bezier_init(&view->bezier, mesh->patches, err);
    }
    const WrNormalFrame frame = wr_scene_frame(scene);
    const bool framed =
        scene->normals.image && (frame == WR_FRAME_MIKK || frame == WR_FRAME_LECTURE);
    return wr_reference_mesh_init(&view->mesh, mesh, err) &&
           (!framed || wr_reference_mesh_frame(&view->mesh, frame, err));
}

bool wr_reference_view_init(WrReferenceView *view, const WrScene *scene, double turn_deg, int width,
                            int height, WrError *err)
{
    *view = (WrReferenceView){ .shape = &scene->shape,
                               .info = wr_surfaces[scene->shape.kind],
                               .width = width,
                               .height = height };
    WrPlacement place;
    const double aspect = (double)width / height;
    if (!wr_scene_place(scene, turn_deg, aspect, &place, err)) return false;
    view->place = place;
    view->perspective = !place.orthographic;
    view->size = place.size;
    for (int i = 0; i < 9; i++) view->rotation[i] = place.rotation[i];
    view->eye = point_to_object(&place, place.eye);
    view->right = way_to_object(&place, place.right);
    view->up = way_to_object(&place, place.up);
    view->forward = way_to_object(&place, place.forward);
    view->toward = v3_neg(view->forward);
    view->deep = v3_times(world_to_object(&place, place.forward), place.stretch);
    view->stretched = place.stretched;
    view->stretch = place.stretch;
    view->cofactor = place.cofactor;
    view->lit_eye = v3_times(view->eye, place.stretch);
    view->lit_toward = v3_neg(world_to_object(&place, place.forward));
    view->half_h = place.half_height / (view->perspective ? 1 : place.size);
    view->half_w = view->half_h * aspect;
    const WrVec3 from_eye = v3_sub(place.centre, view->eye);
    view->depth = v3_dot(from_eye, view->deep);
    view->middle = v3_mad(view->eye, view->forward, view->depth);
    view->s_min = WR_NEAR_PLANE * place.radius - view->depth;
    const bool closed = view->info->held ? scene->triangles && scene->triangles->closed
                                         : view->info->closed_u && view->info->closed_v;
    view->cull = closed && (!view->perspective || v3_len(from_eye) > place.radius);
    hide_faces(view);
    take_lights(view, scene, &place);
    if (view->info->held) return take_mesh(view, scene, err);
    return view->info->inversion != WR_INVERT_MESH ||
           wr_reference_patches_init(&view->patches, view->shape, err);
}

void wr_reference_view_fini(WrReferenceView *view)
{
    wr_free(view->lights);
    wr_reference_patches_fini(&view->patches);
    wr_reference_bezier_fini(&view->bezier);
    wr_reference_mesh_fini(&view->mesh);
    *view = (WrReferenceView){ 0 };
}

WrReferenceRay wr_reference_view_ray(const WrReferenceView *view, double x, double y)
{
    const double across = (2 * x / view->width - 1) * view->half_w;
    const double above = (1 - 2 * y / view->height) * view->half_h;
    const WrVec3 aside = v3_mad(v3_scale(view->right, across), view->up, above);
    if (!view->perspective)
        return (WrReferenceRay){ v3_add(view->middle, aside), view->forward, view->s_min };
    return (WrReferenceRay){ v3_mad(view->middle, aside, view->depth), v3_add(view->forward, aside),
                             view->s_min };
}

void wr_reference_view_spread(const WrReferenceView *view, WrReferenceRay *per_x,
                              WrReferenceRay *per_y)
{
    const WrVec3 x = v3_scale(view->right, 2 * view->half_w / view->width);
    const WrVec3 y = v3_scale(view->up, -2 * view->half_h / view->height), none = { 0, 0, 0 };
    const double far = view->perspective ? view->depth : 1;
    *per_x = (WrReferenceRay){ v3_scale(x, far), view->perspective ? x : none, 0 };
    *per_y = (WrReferenceRay){ v3_scale(y, far), view->perspective ? y : none, 0 };
}

/* The angle of (x, y) in turns, 0 <= u < 1. */
static double turns(double y, double x)
{
    const double u = wr_atan2(y, x) / (2 * WR_PI), up = u < 0 ? u + 1 : u;
    return up < 1 ? up : 0;
}

static double within(double t)
{
    return t > 0 ? t < 1 ? t : 1 : 0;
}

/* Roots relative to the foot of the perpendicular from the centre: R^2 - foot^2 is not a difference of large
   squares, however far the ray starts. The nearer root counts unless it is in front of the near plane. */
static bool hit_sphere(const WrReferenceView *view, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    const double R = view->shape->value[0], dd = v3_dot(ray->d, ray->d);
    const double foot = -v3_dot(ray->q, ray->d) / dd;
    const WrVec3 nearest = v3_mad(ray->q, ray->d, foot);
    const double left = R * R - v3_dot(nearest, nearest);
    if (!(left >= 0)) return false;
    double half = sqrt(left / dd);
    if (foot - half > ray->s_min) half = -half;
    if (!(foot + half > ray->s_min)) return false;
    const WrVec3 p = v3_mad(nearest, ray->d, half);
    *hit = (WrReferenceHit){
        .s = foot + half,
        .u = turns(p.y, p.x),
        .v = within(0.5 + wr_atan2(p.z, sqrt(p.x * p.x + p.y * p.y)) / WR_PI),
    };
    return true;
}

/* As the sphere, in x and y only; rays parallel to the axis hit nothing, because the tube is open. */
static bool hit_cylinder(const WrReferenceView *view, const WrReferenceRay *ray,
                         WrReferenceHit *hit)
{
    const double R = view->shape->value[0];
    const double dd = ray->d.x * ray->d.x + ray->d.y * ray->d.y;
    if (!(dd > 1e-30)) return false;
    const double foot = -(ray->q.x * ray->d.x + ray->q.y * ray->d.y) / dd;
    const double x = ray->q.x + foot * ray->d.x, y = ray->q.y + foot * ray->d.y;
    const double left = R * R - (x * x + y * y);
    if (!(left >= 0)) return false;
    const double half = sqrt(left / dd), H = view->shape->value[1];
    for (int k = -1; k <= 1; k += 2) { /* the nearer root between the rims */
        const double s = foot + k * half;
        const WrVec3 p = v3_mad(ray->q, ray->d, s);
        if (!(s > ray->s_min && fabs(p.z) <= H / 2)) continue;
        *hit = (WrReferenceHit){ .s = s, .u = turns(p.y, p.x), .v = within(0.5 + p.z / H) };
        return true;
    }
    return false;
}

/* x^2 + y^2 = (R/H)^2 w^2, w = H/2 - z; the roots by t / a and c / t, and b^2 - a c by Lagrange's identity: no
   difference of values that are nearly equal at the tip. Relative to the ray's point nearest the tip. */
static bool hit_cone(const WrReferenceView *view, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    const double H = view->shape->value[1], slope = view->shape->value[0] / H;
    const WrVec3 d = ray->d, from = { ray->q.x, ray->q.y, ray->q.z - H / 2 };
    const double foot = -v3_dot(from, d) / v3_dot(d, d);
    const WrVec3 q = v3_mad(from, d, foot);
    const double w = -slope * q.z, dw = -slope * d.z;
    const double a = d.x * d.x + d.y * d.y - dw * dw, b = q.x * d.x + q.y * d.y - w * dw;
    const double c = q.x * q.x + q.y * q.y - w * w;
    const double x = q.x * dw - w * d.x, y = q.y * dw - w * d.y, z = q.x * d.y - q.y * d.x;
    const double disc = x * x + y * y - z * z;
    if (!(disc >= 0)) return false;
    const double t = b > 0 ? -b - sqrt(disc) : -b + sqrt(disc);
    const double s0 = a != 0 ? t / a : INFINITY, s1 = t != 0 ? c / t : 0;
    const double roots[2] = { fmin(s0, s1), fmax(s0, s1) };
    for (int k = 0; k < 2; k++) {
        const WrVec3 p = v3_mad(q, d, roots[k]);
        if (!(foot + roots[k] > ray->s_min && p.z <= 0 && p.z >= -H)) continue;
        *hit = (WrReferenceHit){ .s = foot + roots[k],
                                 .u = turns(p.y, p.x),
                                 .v = within(1 + p.z / H) };
        return true;
    }
    return false;
}

/* The plane of each visible face: (u,v) are the dot products with Pu and Pv, which are perpendicular. */
static bool hit_faces(const WrReferenceView *view, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    bool found = false;
    for (int face = 0; face < view->info->faces; face++) {
        if (view->hidden[face]) continue;
        WrSurfacePoint at;
        const WrSurfaceCell c = wr_surface_cell(view->shape, face);
        wr_surface_at(view->shape, face, c.u0, c.v0, &at);
        const double dn = v3_dot(ray->d, at.n_unit);
        const double s = v3_dot(v3_sub(at.p, ray->q), at.n_unit) / dn;
        if (!(dn != 0 && s > ray->s_min && isfinite(s)) || (found && s >= hit->s)) continue;
        const WrVec3 w = v3_sub(v3_mad(ray->q, ray->d, s), at.p);
        const double wide = c.u1 - c.u0, high = c.v1 - c.v0;
        const double x = v3_dot(w, at.pu) / v3_dot(at.pu, at.pu) / wide;
        const double y = v3_dot(w, at.pv) / v3_dot(at.pv, at.pv) / high;
        const double edge = 0x1p-48; /* a ray along the edge of two faces hits one */
        if (wr_shape_endless(view->shape) || view->beyond) {
            if (!(fmax(fabs(x), fabs(y)) <= WR_ENDLESS)) continue;
            *hit = (WrReferenceHit){ .s = s, .u = x, .v = y, .face = face };
            return true;
        }
        if (!(x >= -edge && x <= 1 + edge && y >= -edge && y <= 1 + edge)) continue;
        *hit = (WrReferenceHit){
            .s = s, .u = c.u0 + wide * within(x), .v = c.v0 + high * within(y), .face = face
        };
        found = true;
    }
    return found;
}

void wr_reference_view_at(const WrReferenceView *view, const WrReferenceHit *hit,
                          WrSurfacePoint *out)
{
    if (!view->info->held) {
        wr_surface_at(view->shape, hit->face, hit->u, hit->v, out);
        return;
    }
    if (view->bezier.source) {
        wr_reference_bezier_at(&view->bezier, hit, out);
        return;
    }
    wr_reference_mesh_at(&view->mesh, hit, view->perspective ? view->eye : view->toward,
                         view->perspective, out);
}

bool wr_reference_view_hit(const WrReferenceView *view, const WrReferenceRay *ray,
                           WrReferenceHit *hit)
{
    switch (view->info->inversion) {
    case WR_INVERT_SPHERE: return hit_sphere(view, ray, hit);
    case WR_INVERT_CYLINDER: return hit_cylinder(view, ray, hit);
    case WR_INVERT_CONE: return hit_cone(view, ray, hit);
    case WR_INVERT_PLANE:
    case WR_INVERT_CUBE: return hit_faces(view, ray, hit);
    case WR_INVERT_TRIANGLES:
        return view->bezier.source ? wr_reference_bezier_hit(&view->bezier, view->cull, ray, hit)
                                   : wr_reference_mesh_hit(&view->mesh, view->cull, ray, hit);
    case WR_INVERT_MESH: break;
    }
    return wr_reference_patches_hit(&view->patches, view->shape, view->cull, ray, hit);
}
