#include "render/reference/reference_shadow_rays.h"

#include "surface/triangles.h"

#include <math.h>

#define DISC 64    /* points on an area lamp */
#define ABOVE 1e-7 /* of the object's radius: height of the rays' origin above the surface */

void wr_reference_caster(WrReferenceCaster *caster, const WrReferenceStage *stage)
{
    *caster = (WrReferenceCaster){ stage->view, stage };
    caster->view.cull = caster->view.beyond = false;
    for (int k = 0; k < 6; k++) caster->view.hidden[k] = false;
}

static WrVec3 to_world(const WrReferenceView *view, WrVec3 w)
{
    const double *m = view->rotation;
    return (WrVec3){ m[0] * w.x + m[1] * w.y + m[2] * w.z, m[3] * w.x + m[4] * w.y + m[5] * w.z,
                     m[6] * w.x + m[7] * w.y + m[8] * w.z };
}

/* The triangle's geometric normal, which is not its shading normal. */
static WrVec3 flat_normal(const WrTriangles *t, int32_t triangle, WrVec3 n)
{
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *from = t->corners[t->triangles[triangle].corner[k]].p;
        p[k] = (WrVec3){ (double)from[0], (double)from[1], (double)from[2] };
    }
    return v3_unit(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])), n);
}

/* The surface's normal on the visible side, in world proportions. */
static WrVec3 outward(const WrReferenceStage *stage, const WrSurfacePoint *at,
                      const WrReferenceHit *hit, WrVec3 perturbed)
{
    const WrReferenceView *view = &stage->view;
    WrSurfacePoint flat = *at;
    if (stage->raised.count > 0) return perturbed;
    if (view->info->held && !view->bezier.source)
        flat.n_unit = flat_normal(view->mesh.source, hit->triangle, at->n_unit);
    return wr_reference_normal_stretched(view,
                                         v3_scale(flat.n_unit, wr_reference_side(view, &flat)));
}

static bool meets(const WrReferenceCaster *caster, WrVec3 from, WrVec3 l, double away)
{
    const WrPlacement *place = &caster->view.place;
    const WrReferenceRay ray = { wr_place_object(place, from),
                                 v3_scale(wr_place_shrink_back(place, l), 1 / place->size), 0 };
    WrReferenceHit hit;
    const bool met = caster->stage->raised.count > 0
                         ? wr_reference_raised_hit(&caster->stage->raised, &ray, &hit)
                         : wr_reference_view_hit(&caster->view, &ray, &hit);
    return met && hit.s < away;
}

static bool is_hidden(const WrReferenceStage *stage, WrVec3 from, WrVec3 n, WrVec3 l, double away)
{
    const double up = v3_dot(n, l);
    const WrVec3 level = up < 0 ? v3_mad(l, n, -up) : l;
    for (int i = 0; i < stage->caster_count; i++) {
        const WrReferenceCaster *caster = &stage->casters[i];
        const bool own = caster->stage == stage;
        /* computed by the relief's own shadows */
        if (own && stage->raised.count > 0 && stage->shadow > 0) continue;
        if (meets(caster, from, own ? level : l, away)) return true;
    }
    return false;
}

double wr_reference_cast_share(const WrReferenceStage *stage, const WrSurfacePoint *at,
                               const WrReferenceHit *hit, WrVec3 perturbed, WrVec3 l, double away,
                               double radius, WrReferenceShare share)
{
    const WrReferenceView *view = &stage->view;
    const WrVec3 n = to_world(view, outward(stage, at, hit, perturbed)), to = to_world(view, l);
    const double far = away * view->size;
    /* with parallax, the point on the base, which is the shadow caster */
    WrSurfacePoint foot = *at;
    if (stage->parallax) wr_reference_view_at(view, hit, &foot);
    const WrVec3 p = wr_place_world(&view->place, foot.p);
    const WrVec3 from = v3_mad(p, n, ABOVE * view->place.radius * view->size);
    if (!(radius > 0)) return is_hidden(stage, from, n, to, far) ? 0 : 1;
    const WrVec3 least = fabs(to.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    const WrVec3 a = v3_unit(v3_cross(to, least), least), b = v3_cross(to, a);
    int seen = 0, all = 0;
    for (int k = share.part % DISC; k < DISC; k += share.of) {
        const double r = tan(radius) * sqrt((k + 0.5) / DISC), turn = 2.39996322972865332 * k;
        const WrVec3 aside = v3_mad(v3_scale(a, cos(turn)), b, sin(turn));
        seen += !is_hidden(stage, from, n, v3_unit(v3_mad(to, aside, r), to), far);
        all++;
    }
    return (double)seen / all;
}
