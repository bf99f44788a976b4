#include "render/visibility/silhouette.h"

#include "base/vec.h"

#include <math.h>

static WrVec3 sum3(const double a[3], const double b[3], double x, const double c[3], double y)
{
    return (WrVec3){ a[0] + x * b[0] + y * c[0], a[1] + x * b[1] + y * c[1],
                     a[2] + x * b[2] + y * c[2] };
}

/* True if the ray's distance from the bounding sphere exceeds the distance of rays within the pixel. */
static bool misses_ball(const WrView *view, const WrRaysd *rays, double x, double y)
{
    const double R = view->shell_d.value[0];
    WrVec3 d = sum3(rays->d0, rays->dx, x, rays->dy, y),
           q = sum3(rays->q0, rays->qx, x, rays->qy, y);
    double dd = v3_dot(d, d), m = v3_dot(q, d) / dd, near = -m;
    WrVec3 foot = v3_mad(q, d, near);
    const double zero[3] = { 0 };
    WrVec3 across =
        v3_mad(sum3(rays->qx, zero, 0, zero, 0), sum3(rays->dx, zero, 0, zero, 0), near);
    WrVec3 down = v3_mad(sum3(rays->qy, zero, 0, zero, 0), sum3(rays->dy, zero, 0, zero, 0), near);
    double slack = 0.51 * (v3_len(across) + v3_len(down));
    return v3_len(foot) - slack > R * (1 + 1e-5);
}

/* True if all four corners of the pixel are outside the same edge of the quad, or none hits its plane in front. */
static bool misses_quad(const WrView *view, const WrRaysd *rays, const WrQuadd *quad, double x,
                        double y)
{
    int left = 0, right = 0, below = 0, above = 0, behind = 0;
    const double zero[3] = { 0 };
    WrVec3 o = sum3(quad->origin, zero, 0, zero, 0), n = sum3(quad->normal, zero, 0, zero, 0);
    double first = 0;
    (void)view;
    for (int k = 0; k < 4; k++) {
        double cx = x + (k & 1 ? 0.501 : -0.501), cy = y + (k & 2 ? 0.501 : -0.501);
        WrVec3 d = sum3(rays->d0, rays->dx, cx, rays->dy, cy);
        WrVec3 q = sum3(rays->q0, rays->qx, cx, rays->qy, cy);
        double dn = v3_dot(d, n);
        if (k == 0) first = dn;
        if (dn * first <= 0) return false; /* the horizon crosses the pixel */
        double s = v3_dot(v3_sub(o, q), n) / dn;
        WrVec3 p = v3_sub(v3_mad(q, d, s), o);
        double u = p.x * quad->eu[0] + p.y * quad->eu[1] + p.z * quad->eu[2];
        double v = p.x * quad->ev[0] + p.y * quad->ev[1] + p.z * quad->ev[2];
        left += u<quad->u0 - 1e-6, right += u> quad->u1 + 1e-6;
        below += v<quad->v0 - 1e-6, above += v> quad->v1 + 1e-6;
        behind += s <= rays->s_min;
    }
    if (behind > 0) return behind == 4;
    return left == 4 || right == 4 || below == 4 || above == 4;
}

bool wr_outline_misses(const WrTileJob *job, double x, double y)
{
    const WrView *view = job->view;
    const WrRaysd *rays = &wr_view_grid(view, 1)->rays_d;
    if (job->plan->inversion == WR_INVERT_SPHERE) return misses_ball(view, rays, x, y);
    for (int i = 0; i < view->quad_count; i++)
        if (!misses_quad(view, rays, &view->quads_d[i], x, y)) return false;
    return true;
}

/* Corner k of a planar face. */
static WrVec3 corner_of(const WrQuadd *quad, int k)
{
    const WrVec3 origin = { quad->origin[0], quad->origin[1], quad->origin[2] };
    const WrVec3 eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const WrVec3 ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    const double u = k % 2 ? quad->u1 : quad->u0, v = k / 2 % 2 ? quad->v1 : quad->v0;
    return v3_mad(v3_mad(origin, eu, u / v3_dot(eu, eu)), ev, v / v3_dot(ev, ev));
}

/* True if the scene shows that face. Back faces are drawn if nothing is culled (E25), but are hidden. */
static bool shown(const WrTileJob *job, const WrQuadd *quad)
{
    const WrView *view = job->view;
    const WrVec3 n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const WrVec3 to =
        view->perspective ? v3_sub(view->eye, corner_of(quad, 0)) : v3_neg(view->ahead);
    return wr_plan_calls(job->plan, WR_EFFECT_BACK) || v3_dot(to, n) > 0;
}

int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS])
{
    const WrView *view = job->view;
    const WrViewMesh *mesh = job->mesh;
    int count = 0;
    for (int k = 0; k < 4 * view->quad_count; k++)
        count += shown(job, &view->quads_d[k / 4]) &&
                 wr_raster_project(view, corner_of(&view->quads_d[k / 4], k), 0, 0, &tips[count]);
    for (int k = 0; mesh && k < 4; k++) {
        const int at = k / 2 * mesh->mv * (mesh->mu + 1) + k % 2 * mesh->mu;
        tips[count] = (WrRasterVertex){ .x = mesh->sx[at], .y = mesh->sy[at] };
        count += !mesh->out[at];
    }
    return count;
}
