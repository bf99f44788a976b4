#include "render/reference/reference_parallax.h"

#include "base/exactmath.h"
#include "field/field.h"
#include "render/visibility/parallax.h"

#include <math.h>

/* ---- shell ---- */

/* Parallax of round bases for the reference: a ray through the shell that contains the relief, by short even
   steps; its height above the base has a closed form. */

#define PER_CELL 6    /* steps */
#define PARTS 32      /* of a way, for counting its cells */
#define LEAST 48      /* minimum steps of a whole way */
#define MAX_MOST 6000 /* maximum steps of a whole way */
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
    return (int)fmin(fmax(LEAST, ceil(PER_CELL * cells)), MAX_MOST);
}

/* Hit on the relief of a base that has a shell (wr_parallax_has_shell), without the point. */
static bool reference_shell(const WrReferenceStage *stage, const WrReferenceRay *ray,
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

/* A ray above the base that it hit: (u,v)(t) = base + t (a, b), height(t) = t (rise + t bend). */
typedef struct Way {
    const WrReferenceStage *stage;
    double u, v, a, b, rise, bend, side;
    double first, last; /* range of t */
    bool opens, leaves; /* it enters, or leaves, where there is no relief */
} Way;

bool wr_reference_has_parallax(const WrScene *scene)
{
    return scene->parallax && !wr_reference_displaced(scene) && scene->height != 0 &&
           !wr_shape_without_parallax(&scene->shape);
}

/* A spline through a table exceeds its range by at most that range on both sides. */
void wr_reference_parallax_init(WrReferenceStage *stage, const WrField *field,
                                const double cells[2])
{
    const WrScene *scene = stage->scene;
    const WrAnalytic *formula = &scene->analytic;
    double low = 0, high = 0;
    if (formula->kind != WR_ANALYTIC_OFF) {
        for (int k = 0; k < formula->count; k++) high += fabs(formula->terms[k].a);
        low = -high;
    } else {
        float least, most;
        wr_field_range(field, &least, &most);
        const double range = (double)most - (double)least;
        low = (double)least - range, high = (double)most + range;
    }
    stage->parallax = true;
    stage->view.beyond = wr_surfaces[scene->shape.kind]->inversion == WR_INVERT_PLANE;
    stage->lowest = fmin(low * scene->height, high * scene->height);
    stage->highest = fmax(low * scene->height, high * scene->height);
    stage->cells[0] = cells[0], stage->cells[1] = cells[1];
}

/* True if the surface ends at that end of an axis, rather than shrinking to a point. */
static bool ends_there(const WrShape *shape, bool across, double end)
{
    WrSurfacePoint p, q;
    wr_surface_at(shape, 0, across ? 0.23 : end, across ? end : 0.23, &p);
    wr_surface_at(shape, 0, across ? 0.71 : end, across ? end : 0.71, &q);
    const double apart = v3_len(v3_sub(p.p, q.p));
    return apart > 1e-9 * (v3_len(p.p) + v3_len(q.p));
}

static double above_shell(const Way *w, double t)
{
    double f, fu, fv;
    wr_reference_height(w->stage, w->u + t * w->a, w->v + t * w->b, &f, &fu, &fv);
    return t * (w->rise + t * w->bend) - w->side * f;
}

/* t where the height is h, on the way down. false: the ray is never at that height. */
static bool down_to(const Way *w, double h, double *t)
{
    const double part = w->rise * w->rise + 4 * w->bend * h;
    const double root = sqrt(fmax(part, 0));
    /* t = (-rise - root) / (2 bend), without cancellation */
    *t = root - w->rise > 0 ? -2 * h / (root - w->rise) : 0;
    return part >= 0;
}

static void clip(Way *w, const WrShape *shape, bool across)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const double at = across ? w->v : w->u, move = across ? w->b : w->a;
    const bool round = across ? info->closed_v : info->closed_u;
    if (move == 0 && !round && (at < 0 || at > 1)) w->last = w->first, w->leaves = true;
    if (move == 0) return;
    const double far = round ? at + copysign(0.5, move) : move > 0 ? 1 : 0;
    const double near = round ? at - copysign(0.5, move) : move > 0 ? 0 : 1;
    if ((near - at) / move > w->first) {
        w->first = (near - at) / move;
        w->opens = !round && ends_there(shape, across, near);
    }
    if ((far - at) / move < w->last) {
        w->last = (far - at) / move;
        w->leaves = !round && ends_there(shape, across, far);
    }
}

/* Limits the range of t. false: it is empty. */
static bool limit(Way *w, const WrShape *shape)
{
    const double high = w->side > 0 ? w->stage->highest : -w->stage->lowest;
    const double low = w->side > 0 ? w->stage->lowest : -w->stage->highest;
    if (!down_to(w, high, &w->first) && w->bend > 0) return false;
    w->leaves = !down_to(w, low, &w->last) && w->bend > 0;
    if (w->leaves) w->last = -w->rise / w->bend - w->first;
    clip(w, shape, false);
    clip(w, shape, true);
    return true;
}

/* The first t where the ray is not above the relief. */
static bool meet(const Way *w, double *t)
{
    const double all = w->last - w->first;
    const double cells =
        fabs(w->a) * all * w->stage->cells[0] + fabs(w->b) * all * w->stage->cells[1];
    const int steps = (int)fmin(fmax(LEAST, ceil(PER_CELL * cells)), MAX_MOST);
    double from = w->first;
    *t = from;
    if (!(all > 0)) {
        *t = w->last;
        return !w->leaves && !w->opens;
    }
    if (above_shell(w, from) <= 0) return !w->opens;
    for (int k = 1; k <= steps; k++) {
        double to = w->first + all * k / steps;
        if (above_shell(w, to) > 0) {
            from = to;
            continue;
        }
        for (int half = 0; half < HALVINGS; half++) {
            const double mid = (from + to) / 2;
            if (above_shell(w, mid) > 0) from = mid;
            else to = mid;
        }
        *t = to;
        return true;
    }
    *t = w->last;
    return !w->leaves;
}

static double within(bool round, double x)
{
    return round ? x - floor(x) : fmin(fmax(x, 0), 1);
}

/* Continues the ray to the relief. at: the base's point at the hit. */
static bool go_on(const WrReferenceStage *stage, const WrReferenceRay *ray, WrReferenceHit *hit,
                  WrSurfacePoint *at, double *side)
{
    const WrSurfaceInfo *info = stage->view.info;
    const double e = v3_dot(at->pu, at->pu), f = v3_dot(at->pu, at->pv), g = v3_dot(at->pv, at->pv);
    const double du = v3_dot(ray->d, at->pu), dv = v3_dot(ray->d, at->pv), det = e * g - f * f;
    const double up = v3_dot(ray->d, at->n_unit);
    double t;
    *side = up > 0 ? -1 : 1;
    if (!(det > 0)) return true;
    Way w = { .stage = stage, .u = hit->u, .v = hit->v, .side = *side, .rise = *side * up };
    w.a = (g * du - f * dv) / det, w.b = (e * dv - f * du) / det;
    const WrVec3 way = v3_add(v3_scale(at->pu, w.a), v3_scale(at->pv, w.b));
    const WrVec3 turn = v3_add(v3_scale(at->n_u, w.a), v3_scale(at->n_v, w.b));
    w.bend = *side * v3_dot(turn, way) / 2;
    if (info->flat) w.bend = 0;
    if (!limit(&w, stage->view.shape) || !meet(&w, &t)) return false;
    hit->s += t;
    hit->u = within(info->closed_u, w.u + t * w.a), hit->v = within(info->closed_v, w.v + t * w.b);
    const WrVec3 p = v3_mad(at->p, ray->d, t);
    wr_reference_view_at(&stage->view, hit, at);
    at->p = p;
    return true;
}

bool wr_reference_parallax(const WrReferenceStage *stage, const WrReferenceRay *ray,
                           WrReferenceHit *hit, WrSurfacePoint *at, double *side)
{
    if (!wr_parallax_has_shell(stage->view.shape)) {
        if (!wr_reference_view_hit(&stage->view, ray, hit)) return false;
        wr_reference_view_at(&stage->view, hit, at);
        return go_on(stage, ray, hit, at, side);
    }
    if (!reference_shell(stage, ray, hit, side)) return false;
    wr_reference_view_at(&stage->view, hit, at);
    at->p = v3_mad(ray->q, ray->d, hit->s);
    return true;
}
