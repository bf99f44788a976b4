#include "render/reference/reference_occlusion.h"

#include "base/exactmath.h"
#include "render/reference/reference_shade.h"

#include <math.h>

#define DISC 48  /* points on an area lamp */
#define ROUND 48 /* directions around a point */

/* True if the ray to the lamp hits the displaced surface before the lamp. */
static bool meets_relief(const WrReferenceStage *stage, WrVec3 p, WrVec3 perturbed, WrVec3 l,
                         double away)
{
    const WrReferenceRay ray = { v3_mad(p, perturbed, 1e-7 * stage->raised.size), l, 0 };
    WrReferenceHit hit;
    return wr_reference_raised_hit(&stage->raised, &ray, &hit) && hit.s < away;
}

/* True if the relief hides a lamp in direction l. Above the tangent plane the ray rises by n.l per length, and
   (a, b) is its motion in u and v: it is marched in steps of an eighth of a texel until it is above everything. */
static bool is_hidden(const WrReferenceStage *stage, const WrSurfacePoint *at, double u, double v,
                      WrVec3 l)
{
    const double e = v3_dot(at->pu, at->pu), f = v3_dot(at->pu, at->pv), g = v3_dot(at->pv, at->pv);
    const double lu = v3_dot(l, at->pu), lv = v3_dot(l, at->pv), det = e * g - f * f;
    const double up = v3_dot(l, at->n_unit);
    if (!(det > 0) || wr_reference_side(&stage->view, at) < 0) return false;
    if (up < 0) return true;
    const double a = (g * lu - f * lv) / det, b = (e * lv - f * lu) / det;
    const double moves = hypot(a * stage->texels[0], b * stage->texels[1]);
    const double farthest = 4 * (stage->texels[0] + stage->texels[1]);
    double from, fu, fv, here;
    wr_reference_height(stage, u, v, &from, &fu, &fv);
    for (double way = 0.125; moves > 0 && way < farthest; way += 0.125) {
        const double t = way / moves;
        if (t * up > stage->shadow) return false;
        wr_reference_height(stage, u + t * a, v + t * b, &here, &fu, &fv);
        if (here - from > t * up) return true;
    }
    return false;
}

static bool hides(const WrReferenceStage *stage, const WrSurfacePoint *at, double u, double v,
                  WrVec3 perturbed, WrVec3 l, double away)
{
    return stage->raised.count > 0 ? meets_relief(stage, at->p, perturbed, l, away)
                                   : is_hidden(stage, at, u, v, l);
}

/* Two unit vectors perpendicular to d. */
static void across(WrVec3 d, WrVec3 *a, WrVec3 *b)
{
    const WrVec3 least = fabs(d.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    *a = v3_unit(v3_cross(d, least), (WrVec3){ 0, 0, 1 });
    *b = v3_cross(d, *a);
}

double wr_reference_lamp_share(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                               double v, WrVec3 perturbed, WrVec3 l, double away, double radius,
                               WrReferenceShare share)
{
    if (!(radius > 0)) return hides(stage, at, u, v, perturbed, l, away) ? 0 : 1;
    WrVec3 a, b;
    int seen = 0, all = 0;
    across(l, &a, &b);
    for (int k = share.part % DISC; k < DISC;
         k += share.of, all++) { /* evenly spread over the disc, by the golden angle */
        const double r = radius * sqrt((k + 0.5) / DISC), turn = 2.39996322972865 * k;
        const WrVec3 side = v3_mad(v3_scale(a, cos(turn)), b, sin(turn));
        const WrVec3 to = v3_mad(v3_scale(l, cos(r)), side, sin(r));
        seen += !hides(stage, at, u, v, perturbed, to, away);
    }
    return (double)seen / all;
}

/* Tangent of the horizon's elevation along w, a unit vector in the tangent plane: marched in quarters of a texel
   until nothing can be higher. */
static double horizon_along(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                            double v, WrVec3 w)
{
    const double e = v3_dot(at->pu, at->pu), f = v3_dot(at->pu, at->pv), g = v3_dot(at->pv, at->pv);
    const double wu = v3_dot(w, at->pu), wv = v3_dot(w, at->pv), det = e * g - f * f;
    if (!(det > 0)) return 0;
    const double a = (g * wu - f * wv) / det, b = (e * wv - f * wu) / det;
    const double moves = hypot(a * stage->texels[0], b * stage->texels[1]);
    double from, fu, fv, here, best = 0;
    wr_reference_height(stage, u, v, &from, &fu, &fv);
    for (double way = 0.25; moves > 0 && way < stage->texels[0] + stage->texels[1]; way += 0.25) {
        const double t = way / moves;
        if (t * best > stage->relief) break;
        wr_reference_height(stage, u + t * a, v + t * b, &here, &fu, &fv);
        best = fmax(best, (here - from) / t);
    }
    return best;
}

double wr_reference_open(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                         double v, WrVec3 perturbed)
{
    WrVec3 a, b;
    const WrVec3 n = wr_reference_side(&stage->view, at) < 0 ? v3_neg(perturbed) : perturbed;
    const double up = v3_dot(n, at->n_unit);
    double sum = 0;
    across(at->n_unit, &a, &b);
    for (int k = 0; k < ROUND; k++) {
        const double phi = 2 * WR_PI * (k + 0.5) / ROUND;
        const WrVec3 w = v3_mad(v3_scale(a, cos(phi)), b, sin(phi));
        const double out = v3_dot(n, w);
        const double h = fmax(atan(horizon_along(stage, at, u, v, w)), atan2(-out, up));
        sum += up * cos(h) * cos(h) / 2 + out * ((WR_PI / 2 - h) / 2 - sin(2 * h) / 4);
    }
    return fmin(fmax(2 * sum / ROUND, 0), 1);
}
