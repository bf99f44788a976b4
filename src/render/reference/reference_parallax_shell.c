/* Parallax of round bases for the reference: a ray through the shell that contains the relief, by short even
   steps; its height above the base has a closed form. */
#include "base/exactmath.h"
#include "render/reference/reference_parallax.h"

#include <math.h>

#define PER_CELL 6 /* steps */
#define PARTS 32   /* of a way, for counting its cells */
#define LEAST 48   /* minimum steps of a whole way */
#define MOST 6000  /* maximum steps of a whole way */
#define HALVINGS 48

typedef struct Shell {
    const WrReferenceStage *stage;
    const WrReferenceRay *ray;
    double R, H; /* H: height of a tube, which ends there; INFINITY: it is a sphere */
} Shell;

static WrVec3 place(const Shell *shell, double s)
{
    return v3_mad(shell->ray->q, shell->ray->d, s);
}

static void parameters(const Shell *shell, WrVec3 p, double *u, double *v)
{
    const double turns = wr_atan2(p.y, p.x) / (2 * WR_PI), flat = sqrt(p.x * p.x + p.y * p.y);
    *u = turns - floor(turns);
    *v = shell->H < INFINITY ? 0.5 + p.z / shell->H : 0.5 + wr_atan2(p.z, flat) / WR_PI;
    *v = fmin(fmax(*v, 0), 1);
}

static double above(const Shell *shell, double s)
{
    const WrVec3 p = place(shell, s);
    const double z = shell->H < INFINITY ? 0 : p.z;
    double u, v, f, fu, fv;
    parameters(shell, p, &u, &v);
    wr_reference_height(shell->stage, u, v, &f, &fu, &fv);
    return sqrt(p.x * p.x + p.y * p.y + z * z) - shell->R - f;
}

/* Interval in which the ray is at most r from the centre, or from the axis. */
static bool within_reach(const Shell *shell, double r, double part[2])
{
    const bool tube = shell->H < INFINITY;
    WrVec3 q = shell->ray->q, d = shell->ray->d;
    if (tube) q.z = d.z = 0;
    const double dd = v3_dot(d, d), foot = dd > 1e-30 ? -v3_dot(q, d) / dd : 0;
    const WrVec3 nearest = v3_mad(q, d, foot);
    const double left = r * r - v3_dot(nearest, nearest);
    if (!(r > 0 && left >= 0)) return false;
    const double half = dd > 1e-30 ? sqrt(left / dd) : INFINITY;
    part[0] = foot - half, part[1] = foot + half;
    return true;
}

static void clip_ends(const Shell *shell, double part[2])
{
    const double z = shell->ray->q.z, dz = shell->ray->d.z;
    if (!(shell->H < INFINITY)) return;
    const double a = (-shell->H / 2 - z) / dz, b = (shell->H / 2 - z) / dz;
    part[0] = fmax(part[0], fmin(a, b)), part[1] = fmin(part[1], fmax(a, b));
}

static int steps_of(const Shell *shell, const double part[2])
{
    double cells = 0, last[2] = { 0, 0 };
    for (int k = 0; k <= PARTS; k++) {
        double u, v;
        parameters(shell, place(shell, part[0] + (part[1] - part[0]) * k / PARTS), &u, &v);
        const double round = fabs(u - last[0]);
        if (k > 0)
            cells += fmin(round, 1 - round) * shell->stage->cells[0] +
                     fabs(v - last[1]) * shell->stage->cells[1];
        last[0] = u, last[1] = v;
    }
    return (int)fmin(fmax(LEAST, ceil(PER_CELL * cells)), MOST);
}

bool wr_reference_shell(const WrReferenceStage *stage, const WrReferenceRay *ray,
                        WrReferenceHit *hit, double *side)
{
    const WrShape *shape = stage->view.shape;
    const bool tube = stage->view.info->inversion == WR_INVERT_CYLINDER;
    const Shell shell = { stage, ray, shape->value[0], tube ? shape->value[1] : INFINITY };
    double part[2], wall[2], low[2];
    if (!within_reach(&shell, shell.R + stage->highest, wall)) return false;
    part[0] = wall[0], part[1] = wall[1];
    clip_ends(&shell, part);
    part[0] = fmax(part[0], ray->s_min);
    if (!(part[0] < part[1])) return false;
    const bool by_wall = part[0] == wall[0];
    double s = part[0];
    *side = by_wall || above(&shell, s) > 0 ? 1 : -1;
    bool met = by_wall && above(&shell, s) <= 0;
    if (*side > 0 && within_reach(&shell, shell.R + stage->lowest, low) && low[0] > s)
        part[1] = fmin(part[1], low[0] + 1e-9 * (part[1] - part[0]));
    const int steps = met ? 0 : steps_of(&shell, part);
    for (int k = 1; k <= steps && !met; k++) {
        double from = s, to = part[0] + (part[1] - part[0]) * k / steps;
        s = to;
        if (*side * above(&shell, to) > 0) continue;
        for (int half = 0; half < HALVINGS; half++) {
            const double mid = (from + to) / 2;
            if (*side * above(&shell, mid) > 0) from = mid;
            else to = mid;
        }
        s = to, met = true;
    }
    if (!met) return false;
    *hit = (WrReferenceHit){ .s = s };
    parameters(&shell, place(&shell, s), &hit->u, &hit->v);
    return true;
}
