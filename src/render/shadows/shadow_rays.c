/* Shadow casters: closed forms and facets, and the visibility of a lamp past them. */
#include "render/shadows/shadow_rays.h"

#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/tessellation/displacement_lookup.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

bool wr_shadow_rays_asked(const WrScene *scene)
{
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        const WrVec3 c = light->colour;
        if (light->shadow && light->strength != 0 && (c.x != 0 || c.y != 0 || c.z != 0))
            return true;
    }
    return false;
}

bool wr_shadow_rays_spares_itself(const WrShadowRaysBody *body)
{
    const WrSurfaceInfo *info = wr_surfaces[body->shape.kind];
    if (body->rise > 0) return false;
    return info->convex_closed || (info->flat && !info->held);
}

/* ---- closed forms ---- */

static void take_quads(WrShadowRaysBody *body)
{
    const WrSurfaceInfo *info = wr_surfaces[body->shape.kind];
    body->endless = wr_shape_endless(&body->shape);
    body->quad_count = info->faces;
    for (int face = 0; face < info->faces; face++) {
        const WrSurfaceCell c = wr_surface_cell(&body->shape, face);
        WrSurfacePoint at;
        WrShadowRaysQuad *quad = &body->quads[face];
        wr_surface_at(&body->shape, face, c.u0, c.v0, &at);
        quad->from = at.p, quad->normal = at.n_unit;
        quad->along = v3_scale(at.pu, 1 / v3_dot(at.pu, at.pu) / (c.u1 - c.u0));
        quad->across = v3_scale(at.pv, 1 / v3_dot(at.pv, at.pv) / (c.v1 - c.v0));
    }
}

static bool meets_quads(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most)
{
    for (int k = 0; k < body->quad_count; k++) {
        const WrShadowRaysQuad *quad = &body->quads[k];
        const double fall = v3_dot(d, quad->normal);
        const double t = fall != 0 ? v3_dot(v3_sub(quad->from, o), quad->normal) / fall : 0;
        if (!(t > 0 && t < most)) continue;
        const WrVec3 w = v3_sub(v3_mad(o, d, t), quad->from);
        const double x = v3_dot(w, quad->along), y = v3_dot(w, quad->across);
        if (body->endless || (x >= 0 && x <= 1 && y >= 0 && y <= 1)) return true;
    }
    return false;
}

/* Real roots of a t^2 + 2 b t + c, without cancellation. */
static bool roots_of(double a, double b, double c, double t[2])
{
    const double left = b * b - a * c;
    if (!(left >= 0)) return false;
    const double q = b < 0 ? -b + sqrt(left) : -b - sqrt(left);
    t[0] = a != 0 ? q / a : INFINITY, t[1] = q != 0 ? c / q : INFINITY;
    return true;
}

static bool meets_sphere(const WrShape *shape, WrVec3 o, WrVec3 d, double most)
{
    const double R = shape->value[0];
    double t[2];
    if (!roots_of(v3_dot(d, d), v3_dot(o, d), v3_dot(o, o) - R * R, t)) return false;
    return (t[0] > 0 && t[0] < most) || (t[1] > 0 && t[1] < most);
}

/* Open tube or cone: x^2 + y^2 = (r + k w)^2, with w = z measured from the middle, within half the height. */
static bool meets_tube(double r, double k, double H, WrVec3 o, WrVec3 d, double most)
{
    const double wide = r + k * o.z, grows = k * d.z;
    double t[2];
    if (!roots_of(d.x * d.x + d.y * d.y - grows * grows, o.x * d.x + o.y * d.y - wide * grows,
                  o.x * o.x + o.y * o.y - wide * wide, t))
        return false;
    for (int i = 0; i < 2; i++)
        if (t[i] > 0 && t[i] < most && fabs(o.z + t[i] * d.z) <= H / 2) return true;
    return false;
}

bool wr_shadow_rays_meets(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most)
{
    const double *value = body->shape.value;
    if (body->triangles) return wr_shadow_rays_tree_meets(body, o, d, most);
    switch (wr_surfaces[body->shape.kind]->inversion) {
    case WR_INVERT_PLANE:
    case WR_INVERT_CUBE: return meets_quads(body, o, d, most);
    case WR_INVERT_SPHERE: return meets_sphere(&body->shape, o, d, most);
    case WR_INVERT_CYLINDER: return meets_tube(value[0], 0, value[1], o, d, most);
    case WR_INVERT_CONE:
        return meets_tube(value[0] / 2, -value[0] / value[1], value[1], o, d, most);
    case WR_INVERT_MESH:
        return wr_shadow_rays_meets_torus(&body->shape, o, d, most); /* all others have facets */
    case WR_INVERT_TRIANGLES: break;
    }
    return false;
}

/* ---- bodies ---- */

void wr_shadow_rays_body_fini(WrShadowRaysBody *body)
{
    wr_triangles_free(body->triangles);
    wr_free(body->boxes);
    wr_free(body->order);
    *body = (WrShadowRaysBody){ 0 };
}

/* Hash of F, for a displaced surface. */
static WrHash relief_of(const WrScene *scene, const WrField *field)
{
    const WrAnalytic *formula = &scene->analytic;
    WrHash hash;
    const bool table = formula->kind == WR_ANALYTIC_OFF;
    const uint64_t key = table ? wr_field_key(field) : 0;
    const double by[3] = { scene->height, scene->replicate_u, scene->replicate_v };
    const int how[2] = { (int)scene->scheme, (int)formula->kind };
    hash = wr_hash_bytes(&key, sizeof key, (WrHash){ 1, 1 });
    hash = wr_hash_bytes(by, sizeof by, hash);
    hash = wr_hash_bytes(how, sizeof how, hash);
    for (int k = 0; k < formula->count && !table; k++) {
        const WrAnalyticTerm *term = &formula->terms[k];
        const double terms[5] = { term->i, term->j, term->a, term->phase_u_deg, term->phase_v_deg };
        hash = wr_hash_bytes(terms, sizeof terms, hash);
    }
    return hash;
}

void wr_shadow_rays_body_size(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                              bool moves)
{
    const WrTriangles *held = scene->triangles;
    const bool moved = moves && wr_is_raised(scene);
    const WrHash raised = moved ? relief_of(scene, field) : (WrHash){ 0, 0 };
    const bool same = body->radius > 0 && wr_hash_equal(body->raised, raised) &&
                      memcmp(&body->shape, &scene->shape, sizeof body->shape) == 0;
    if (same && (!body->triangles || !held || held->key == body->triangles->key)) return;
    wr_shadow_rays_body_fini(body);
    body->shape = scene->shape;
    body->radius = wr_shape_radius(&scene->shape);
    body->raised = raised;
    if (moved) body->rise = wr_raised_most(scene, field);
}

/* Of the object's radius: more than the error of single-precision positions. */
#define ROUNDING 0x1p-19
/* Of the object's radius, for surfaces that are drawn as patches and cast shadows as the triangles cut from them. */
#define PATCHY 0x1p-10

/* Of the mesh surfaces only the torus has a closed form. */
static bool needs_facets(const WrShadowRaysBody *body)
{
    const bool mesh = wr_surfaces[body->shape.kind]->inversion == WR_INVERT_MESH;
    return body->rise > 0 || (mesh && body->shape.kind != WR_SURFACE_torus);
}

bool wr_shadow_rays_body_update(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                                WrError *err)
{
    const WrInversion how = wr_surfaces[scene->shape.kind]->inversion;
    if (body->made) return true;
    body->lift = ROUNDING * body->radius;
    if (wr_surfaces[scene->shape.kind]->held) {
        body->triangles =
            scene->triangles ? wr_triangles_share(scene->triangles) : wr_triangles_square();
        if (body->triangles->patches) body->lift = PATCHY * body->radius;
    } else if (needs_facets(body)) {
        if (!wr_shadow_rays_facets(body, scene, field, err)) return false;
    } else if (how == WR_INVERT_PLANE || how == WR_INVERT_CUBE) {
        take_quads(body);
    }
    if (body->triangles && !wr_shadow_rays_tree_update(body, err)) return false;
    return body->made = true;
}

/* ---- lamps ---- */

/* True if the caster may block the lamp: tests its bounding sphere against the cone of rays to the lamp. */
static bool may_meet(const WrShadowRaysTo *to, WrVec3 p, WrVec3 l, double away, double spread)
{
    const WrVec3 off = v3_sub(to->middle, p);
    const double along = v3_dot(off, l), r = to->radius;
    if (!(r < INFINITY)) return true;
    if (along < -r || along - r > away) return false;
    const double reach = r + spread * fmax(along + r, 0);
    return v3_dot(off, off) - along * along <= reach * reach * (1 + 1e-9);
}

static bool is_hidden(const WrShadowRaysTo *to, WrVec3 p, WrVec3 l, double away)
{
    const double *m = to->m;
    const WrVec3 o = { m[0] * p.x + m[1] * p.y + m[2] * p.z + to->from.x,
                       m[3] * p.x + m[4] * p.y + m[5] * p.z + to->from.y,
                       m[6] * p.x + m[7] * p.y + m[8] * p.z + to->from.z };
    const WrVec3 d = { m[0] * l.x + m[1] * l.y + m[2] * l.z, m[3] * l.x + m[4] * l.y + m[5] * l.z,
                       m[6] * l.x + m[7] * l.y + m[8] * l.z };
    return wr_shadow_rays_meets(to->body, o, d, away);
}

/* True if any caster blocks that point of the lamp. */
static bool any_hides(const WrShadowRays *cast, const int *near, int count, WrVec3 p, WrVec3 n,
                      WrVec3 l, double away)
{
    const double up = v3_dot(n, l);
    const WrVec3 level = up < 0 ? v3_mad(l, n, -up) : l;
    for (int k = 0; k < count; k++) {
        const WrShadowRaysTo *to = &cast->to[near[k]];
        if (is_hidden(to, p, to->own ? level : l, away)) return true;
    }
    return false;
}

double wr_shadow_rays_share(const WrShadowRays *cast, int count, WrVec3 p, WrVec3 n, WrVec3 l,
                            double away, double radius)
{
    int near[WR_OBJECTS_MAX], nearby = 0, seen = 0;
    const WrVec3 from = v3_mad(p, n, cast->lift);
    const bool round = radius > 0 && cast->rays > 1;
    double sine = 0, cosine = 1;
    if (round) wr_sincos_turns(radius / (2 * WR_PI), &sine, &cosine);
    const double spread = sine / cosine;
    for (int i = 0; i < count; i++)
        if (may_meet(&cast->to[i], from, l, away, spread)) near[nearby++] = i;
    if (nearby == 0) return 1;
    if (!round) return any_hides(cast, near, nearby, from, n, l, away) ? 0 : 1;
    const WrVec3 least = fabs(l.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    const WrVec3 a = v3_unit(v3_cross(l, least), least), b = v3_cross(l, a);
    for (int k = 0; k < cast->rays; k++) {
        const WrVec3 aside = v3_mad(v3_scale(a, cast->disc[k][0]), b, cast->disc[k][1]);
        const WrVec3 to = v3_unit(v3_mad(l, aside, spread), l);
        seen += !any_hides(cast, near, nearby, from, n, to, away);
    }
    return (double)seen / cast->rays;
}
