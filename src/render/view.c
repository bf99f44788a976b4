#include "render/view.h"
#include "base/memory.h"

#include <math.h>

/* World direction -> object direction: the transpose of the placement's rotation. */
static WrVec3 turn_back(const WrPlacement *place, WrVec3 w)
{
    const double *m = place->rotation;
    return (WrVec3){ m[0] * w.x + m[3] * w.y + m[6] * w.z, m[1] * w.x + m[4] * w.y + m[7] * w.z,
                     m[2] * w.x + m[5] * w.y + m[8] * w.z };
}

/* World position -> kernel position. */
static WrVec3 bring_in(const WrPlacement *place, double scale, WrVec3 w)
{
    return v3_scale(v3_add(turn_back(place, w), place->centre), scale);
}

static void store(float out[3], WrVec3 a)
{
    out[0] = (float)a.x, out[1] = (float)a.y, out[2] = (float)a.z;
}

/* Rays as affine functions of the sample's grid position (i, j), whose centre is (i + 1/2, j + 1/2). */
static void make_rays(WrView *view, WrVec3 centre)
{
    WrRays *rays = &view->rays;
    double depth = v3_dot(v3_sub(centre, view->eye), view->forward); /* of the reference plane */
    WrVec3 middle = v3_mad(view->eye, view->forward, depth);
    WrVec3 x = v3_scale(view->right, 2.0 * view->half_w / view->grid_w);
    WrVec3 y = v3_scale(view->up, -2.0 * view->half_h / view->grid_h);
    WrVec3 corner = v3_add(v3_scale(view->right, -view->half_w), v3_scale(view->up, view->half_h));
    corner = v3_add(corner, v3_add(v3_scale(x, 0.5), v3_scale(y, 0.5)));
    const WrVec3 zero = { 0, 0, 0 };
    double spread = view->perspective ? depth : 1.0;
    store(rays->q0, v3_mad(middle, corner, spread));
    store(rays->qx, v3_scale(x, spread));
    store(rays->qy, v3_scale(y, spread));
    store(rays->d0, view->perspective ? v3_add(view->forward, corner) : view->forward);
    store(rays->dx, view->perspective ? x : zero);
    store(rays->dy, view->perspective ? y : zero);
    rays->s_min = (float)(view->near - depth);
    rays->perspective = view->perspective;
    store(rays->eye, view->eye);
    store(rays->toward, v3_neg(view->forward));
}

/* Planar faces; of a closed box seen from outside, only those that face the viewer. */
static void make_quads(WrView *view, const WrShape *shape)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    bool facing[6], outside = false;
    WrSurfacePoint at[6];
    for (int face = 0; face < info->faces; face++) {
        wr_surface_at(shape, face, 0, 0, &at[face]);
        WrVec3 origin = v3_scale(at[face].p, view->scale);
        WrVec3 to = view->perspective ? v3_sub(view->eye, origin) : v3_neg(view->forward);
        facing[face] = v3_dot(to, at[face].n_unit) > 0;
        outside = outside || facing[face];
    }
    for (int face = 0; face < info->faces; face++) {
        if (info->convex_closed && outside && !facing[face]) continue;
        WrQuad *quad = &view->quads[view->quad_count];
        WrVec3 pu = v3_scale(at[face].pu, view->scale), pv = v3_scale(at[face].pv, view->scale);
        store(quad->origin, v3_scale(at[face].p, view->scale));
        store(quad->normal, at[face].n_unit);
        store(quad->eu, v3_scale(pu, 1.0 / v3_dot(pu, pu)));
        store(quad->ev, v3_scale(pv, 1.0 / v3_dot(pv, pv)));
        view->quad_face[view->quad_count++] = face;
    }
}

static void make_lights(WrView *view, const WrScene *scene, const WrPlacement *place)
{
    const WrVec3 ahead = { 0, 0, 1 };
    view->lights = wr_alloc((size_t)scene->light_count + 1, sizeof *view->lights);
    view->light_count = scene->light_count;
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        WrKernLight *out = &view->lights[i];
        out->point = light->kind == WR_LIGHT_POINT;
        WrVec3 where = out->point ? bring_in(place, view->scale, light->where)
                                  : v3_unit(turn_back(place, light->where), ahead);
        store(out->where, where);
        store(out->rgb, v3_scale(light->colour, light->strength));
    }
}

bool wr_view_init(WrView *view, const WrScene *scene, double turn_deg, int width, int height,
                  int samples, WrError *err)
{
    *view = (WrView){ .grid_w = width * samples, .grid_h = height * samples };
    WrPlacement place;
    double aspect = (double)width / height;
    if (!wr_scene_place(scene, turn_deg, aspect, &place, err)) return false;
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    view->scale = info->unit_sized ? 1.0 : scalbn(1.0, -ilogb(place.radius));
    view->radius = place.radius * view->scale;
    view->perspective = !place.orthographic;
    view->eye = bring_in(&place, view->scale, place.eye);
    view->right = turn_back(&place, place.right);
    view->up = turn_back(&place, place.up);
    view->forward = turn_back(&place, place.forward);
    view->half_h = place.half_height * (view->perspective ? 1.0 : view->scale);
    view->half_w = view->half_h * aspect;
    view->cull = info->closed_u && info->closed_v &&
                 (!view->perspective ||
                  v3_len(v3_sub(view->eye, v3_scale(place.centre, view->scale))) > view->radius);
    view->near = 1e-5 * view->radius;
    wr_shape_scaled(&scene->shape, view->scale, &view->shape);
    make_rays(view, v3_scale(place.centre, view->scale));
    if (info->inversion == WR_INVERT_PLANE || info->inversion == WR_INVERT_CUBE)
        make_quads(view, &scene->shape);
    make_lights(view, scene, &place);
    return true;
}

void wr_view_fini(WrView *view)
{
    wr_free(view->lights);
    view->lights = NULL;
}
