/* stage_parallax_body.h - ray march from the base to the relief above its tangent plane (parallax.h). Part of
   pipeline_body.h.

   At parameter t along its direction d from the base, a ray is g in front of the relief: g = side (rise t + bend
   t^2 - F), above 0 until the hit. A step is at most as long as g allows by the relief's steepest slope, and at
   least so long that a fixed number of steps is enough. */

#define LAST_STEPS 8 /* alternately bisection and secant steps */

/* March state of a strip's rays. */
typedef struct March {
    REAL a[WR_SPAN], b[WR_SPAN]; /* change of u and v per unit of t */
    /* height above the base on the visible side: rise t + bend t^2; rise <= 0 */
    REAL rise[WR_SPAN], bend[WR_SPAN];
    REAL side[WR_SPAN];                  /* 1; on back faces -1 */
    REAL from[WR_SPAN], to[WR_SPAN];     /* limits of t; then the last step */
    REAL before[WR_SPAN], past[WR_SPAN]; /* g at both limits */
    /* step in t per unit of g, 0: unknown; and the shortest step in t */
    REAL pace[WR_SPAN], least[WR_SPAN];
    bool below[WR_SPAN];                        /* the surface ends where the ray enters */
    REAL dx[WR_SPAN], dy[WR_SPAN], dz[WR_SPAN]; /* d, of any length; only for shells */
    bool misses[WR_SPAN];   /* a ray that leaves the volume hits nothing; afterwards: it missed */
    int on[WR_SPAN], count; /* indices of the rays that still march */
    int met[WR_SPAN], met_count;
} March;

/* The smallest t where rise t + bend t^2 equals h. false: there is none; then the t where it comes nearest. */
static bool reaches(REAL rise, REAL bend, REAL h, REAL *t)
{
    const REAL squared = rise * rise + 4 * bend * h;
    const REAL down = rise - (REAL)sqrt((double)(squared > 0 ? squared : 0));
    *t = down != 0 ? 2 * h / down : 0;
    return squared >= 0;
}

/* Limits t on one axis to the table's end, or to half a period. */
static void limit_axis(const WrParallax *p, int axis, REAL at, REAL move, int i, March *m)
{
    if (move == 0 && (p->closed[axis] || (at >= 0 && at <= 1))) return;
    if (move == 0) {
        m->to[i] = m->from[i], m->misses[i] = true;
        return;
    }
    const int end = move > 0; /* the end at which it leaves */
    const REAL half = (REAL)0.5 / (REAL)fabs((double)move);
    const REAL first = p->closed[axis] ? -half : ((REAL)(1 - end) - at) / move;
    const REAL last = p->closed[axis] ? half : ((REAL)end - at) / move;
    if (m->from[i] < first) m->from[i] = first, m->below[i] = p->ends[axis][1 - end];
    if (m->to[i] > last) m->to[i] = last, m->misses[i] = p->ends[axis][end];
}

/* Interval of t in which the ray is inside the volume of the relief. false: it is empty. */
static bool limit_ray(const WrParallax *p, const Strip *s, int i, March *m)
{
    const REAL rise = m->rise[i], bend = m->bend[i];
    const bool front = m->side[i] > 0;
    const REAL top = (REAL)(front ? p->high : -p->low), bottom = (REAL)(front ? p->low : -p->high);
    if (!reaches(rise, bend, top, &m->from[i]) && bend > 0) {
        m->misses[i] = true;
        return false;
    }
    if (!reaches(rise, bend, bottom, &m->to[i]) && bend > 0) {
        m->to[i] = -rise / bend - m->from[i]; /* it leaves symmetrically to its entry */
        m->misses[i] = true;
    }
    limit_axis(p, 0, s->u[i], m->a[i], i, m);
    limit_axis(p, 1, s->v[i], m->b[i], i, m);
    if (m->from[i] < m->to[i]) return true;
    m->misses[i] = m->misses[i] || m->below[i];
    return false;
}

static REAL dot3(const REAL a[3], const REAL b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void ray_of(const Rays *rays, const Strip *s, int i, REAL d[3])
{
    for (int c = 0; c < 3; c++) d[c] = rays->d0[c] + s->x[i] * rays->dx[c] + s->y[i] * rays->dy[c];
}

/* Motion of a sample's ray in (u,v) over the base. false: u and v are undefined there. */
static bool aim_ray(const WrParallax *p, const Rays *rays, const Strip *s, int i, March *m)
{
    const REAL pu[3] = { s->pux[i], s->puy[i], s->puz[i] };
    const REAL pv[3] = { s->pvx[i], s->pvy[i], s->pvz[i] };
    const REAL n[3] = { s->nx[i], s->ny[i], s->nz[i] };
    const REAL nu[3] = { s->nux[i], s->nuy[i], s->nuz[i] };
    const REAL nv[3] = { s->nvx[i], s->nvy[i], s->nvz[i] };
    const REAL e = dot3(pu, pu), f = dot3(pu, pv), g = dot3(pv, pv), det = e * g - f * f;
    REAL d[3], turn[3], way[3];
    ray_of(rays, s, i, d);
    const REAL du = dot3(d, pu), dv = dot3(d, pv), up = dot3(d, n);
    m->side[i] = up > 0 ? -1 : 1;
    m->rise[i] = m->side[i] * up;
    m->a[i] = m->b[i] = m->bend[i] = 0;
    if (!(det > 0)) return false;
    m->a[i] = (g * du - f * dv) / det;
    m->b[i] = (e * dv - f * du) / det;
    for (int c = 0; c < 3 && p->bent; c++) {
        turn[c] = m->a[i] * nu[c] + m->b[i] * nv[c];
        way[c] = m->a[i] * pu[c] + m->b[i] * pv[c];
    }
    if (p->bent) m->bend[i] = m->side[i] * dot3(turn, way) / 2;
    return true;
}

/* Largest speed of a ray, and its shortest step: half a texel, if the number of steps suffices. */
static void pace_ray(const WrParallax *p, int i, March *m)
{
    const double a = fabs((double)m->a[i]), b = fabs((double)m->b[i]);
    const double from = (double)m->from[i], to = (double)m->to[i];
    const double turns =
        fabs((double)m->rise[i]) + 2 * fabs((double)m->bend[i]) * fmax(fabs(from), fabs(to));
    const double steep = (a > 0 ? p->steep[0] * a : 0) + (b > 0 ? p->steep[1] * b : 0);
    const double texels = (to - from) * (a * p->texels[0] + b * p->texels[1]);
    const double steps = p->texels[0] > 0 ? fmin(2 + 2 * texels, p->steps) : p->steps;
    m->pace[i] = steep < INFINITY && turns + steep > 0 ? (REAL)(1 / (turns + steep)) : 0;
    m->least[i] = (REAL)((to - from) / fmax(1, floor(steps)));
}

/* Ray march through the shell of a round base's relief. Part of pipeline_body.h,
   included by stage_parallax_body.h. The shell is the base grown by the highest F, so rays that miss the base
   can hit it (parallax.h).

   A ray is foot + t d, with foot the point nearest the base's centre. Height above the base is |.| - R for a
   sphere, and that of x and y alone for a tube; u and v are those of the point. These formulas are exact. */

/* An interval of t; from > to: empty; -1e15..1e15: the whole ray. */
typedef struct Part {
    REAL from, to;
} Part;

static bool is_tube(const WrTileJob *job)
{
    return job->plan->inversion == WR_INVERT_CYLINDER;
}

/* True if all rays run parallel to a tube with relief. The tube's kernel intersects the wall and would find no
   hit. */
static bool go_along(const WrTileJob *job, const Rays *rays)
{
    const REAL aside = rays->d0[0] * rays->d0[0] + rays->d0[1] * rays->d0[1];
    return job->parallax.shell && is_tube(job) && !rays->perspective && !(aside > (REAL)1e-30);
}

/* Makes every sample a candidate. */
static void take_all(int count, Strip *s)
{
    for (int i = 0; i < count; i++) s->index[i] = i;
    s->count = count;
}

/* |foot + t d|^2 = cc + 2 bb t + aa t^2; for a tube, of x and y only. */
typedef struct Reach {
    REAL aa, bb, cc;
} Reach;

static Reach reach_of(const WrTileJob *job, const Strip *s, int i, const REAL d[3])
{
    const REAL z = is_tube(job) ? 0 : 1;
    return (Reach){ d[0] * d[0] + d[1] * d[1] + z * d[2] * d[2],
                    s->px[i] * d[0] + s->py[i] * d[1] + z * s->pz[i] * d[2],
                    s->px[i] * s->px[i] + s->py[i] * s->py[i] + z * s->pz[i] * s->pz[i] };
}

/* Interval where the distance is at most r. */
static Part within_reach(const Reach *w, REAL r)
{
    const Part none = { 1, -1 }, all = { -(REAL)1e15, (REAL)1e15 };
    if (!(r > 0)) return none;
    if (!(w->aa > (REAL)1e-30)) return w->cc <= r * r ? all : none;
    const REAL middle = -w->bb / w->aa, left = r * r - (w->cc + w->bb * middle);
    if (!(left >= 0)) return none;
    const REAL half = (REAL)sqrt((double)(left / w->aa));
    return (Part){ middle - half, middle + half };
}

static REAL clamped(REAL x, Part to)
{
    return x > to.from ? (x < to.to ? x : to.to) : to.from;
}

static REAL least_reach(const Reach *w, Part of)
{
    const REAL t = w->aa > 0 ? clamped(-w->bb / w->aa, of) : of.from;
    const REAL squared = w->cc + t * (2 * w->bb + t * w->aa);
    return squared > 0 ? (REAL)sqrt((double)squared) : 0;
}

/* Interval between the tube's ends. */
static Part between_ends(REAL half, REAL z, REAL dz)
{
    if (dz == 0) return z < -half || z > half ? (Part){ 1, -1 } : (Part){ -(REAL)1e15, (REAL)1e15 };
    const REAL a = (-half - z) / dz, b = (half - z) / dz;
    return a < b ? (Part){ a, b } : (Part){ b, a };
}

/* Moves the ray's origin, P, to its foot. Returns the distance from the ray's original start to the foot. */
static REAL stand_at_foot(const Rays *rays, Strip *s, int i, March *m)
{
    REAL d[3], q[3];
    ray_of(rays, s, i, d);
    for (int c = 0; c < 3; c++) q[c] = rays->q0[c] + s->x[i] * rays->qx[c] + s->y[i] * rays->qy[c];
    const REAL far = -dot3(q, d) / dot3(d, d);
    s->px[i] = q[0] + far * d[0], s->py[i] = q[1] + far * d[1], s->pz[i] = q[2] + far * d[2];
    m->dx[i] = d[0], m->dy[i] = d[1], m->dz[i] = d[2];
    return far;
}

/* Interval of t in the shell. below: the ray does not enter through the wall. false: it misses the shell. */
static bool enter_shell(const WrTileJob *job, const Rays *rays, Strip *s, int i, March *m)
{
    const REAL near = rays->s_min - stand_at_foot(rays, s, i, m);
    const REAL d[3] = { m->dx[i], m->dy[i], m->dz[i] };
    const Reach w = reach_of(job, s, i, d);
    const Part wall = within_reach(&w, VIEWED(job->view, shell).value[0]);
    Part in = wall;
    if (is_tube(job)) {
        const REAL half = (REAL)0.5 * VIEWED(job->view, shape).value[1];
        const Part ends = between_ends(half, s->pz[i], d[2]);
        if (ends.from > in.from) in.from = ends.from;
        if (ends.to < in.to) in.to = ends.to;
    }
    if (near > in.from) in.from = near;
    m->from[i] = in.from, m->to[i] = in.to;
    m->side[i] = 1;
    m->misses[i] = true;
    m->below[i] = in.from > wall.from;
    return in.from < in.to;
}

/* Ends the interval at the lowest F, which a ray cannot pass; a ray that began below the relief meets it from
   there. */
static void leave_shell(const WrTileJob *job, const Strip *s, int i, March *m)
{
    const REAL d[3] = { m->dx[i], m->dy[i], m->dz[i] };
    const Reach w = reach_of(job, s, i, d);
    const Part low = within_reach(&w, VIEWED(job->view, shape).value[0] + (REAL)job->parallax.low);
    if (m->side[i] < 0) {
        const Part wall = within_reach(&w, VIEWED(job->view, shell).value[0]);
        m->misses[i] = m->to[i] < wall.to; /* leaves through a tube's end */
        if (low.from <= low.to && low.to > m->from[i]) m->from[i] = low.to;
    } else if (low.from <= low.to && low.from >= m->from[i] && low.from < m->to[i]) {
        m->to[i] = low.from, m->misses[i] = false;
    }
}

/* Points along the rays, with their u and v. */
static void place_shell(const WrTileJob *job, const Strip *s, const March *m, const int *list,
                        int count, const REAL *t, Strip *near)
{
    near->count = count;
    for (int k = 0; k < count; k++) {
        const int i = list[k];
        near->px[k] = s->px[i] + t[i] * m->dx[i];
        near->py[k] = s->py[i] + t[i] * m->dy[i];
        near->pz[k] = s->pz[i] + t[i] * m->dz[i];
    }
    KERNELS_OF(job)->round[job->plan->inversion].params(&VIEWED(job->view, shape), near);
}

/* Height of one of those points above the base. */
static REAL over_base(const WrTileJob *job, const Strip *near, int k)
{
    const REAL x = near->px[k], y = near->py[k], z = is_tube(job) ? 0 : near->pz[k];
    return (REAL)sqrt((double)(x * x + y * y + z * z)) - VIEWED(job->view, shape).value[0];
}

/* Number of texels along the rays, from start, middle and end; into `least`. */
static void count_texels(const WrTileJob *job, const Strip *s, March *m, REAL *t,
                         WrTileScratch *scratch)
{
    const WrParallax *p = &job->parallax;
    Strip *near = NEAR_OF(scratch);
    REAL u[WR_SPAN], v[WR_SPAN];
    for (int part = 0; part <= 2; part++) {
        for (int k = 0; k < m->count; k++) {
            const int i = m->on[k];
            t[i] = m->from[i] + (m->to[i] - m->from[i]) * (REAL)part / 2;
        }
        place_shell(job, s, m, m->on, m->count, t, near);
        for (int k = 0; k < m->count; k++) {
            const double round = part ? fabs((double)(near->u[k] - u[k])) : 0;
            const double along = fmin(round, 1 - round);
            const double up = part ? fabs((double)(near->v[k] - v[k])) : 0;
            const REAL passed = (REAL)(along * p->texels[0] + up * p->texels[1]);
            m->least[m->on[k]] = part ? m->least[m->on[k]] + passed : 0;
            u[k] = near->u[k], v[k] = near->v[k];
        }
    }
}

/* As pace_ray: u changes by (foot x d)_z / (2 pi r^2), r from the axis; v of a sphere by |foot| |d| / (pi r^2),
   r from the centre. */
static void pace_shell(const WrTileJob *job, const Strip *s, int i, March *m)
{
    const WrParallax *p = &job->parallax;
    const REAL d[3] = { m->dx[i], m->dy[i], m->dz[i] };
    const REAL foot[3] = { s->px[i], s->py[i], s->pz[i] };
    const Part way = { m->from[i], m->to[i] };
    const Reach all = reach_of(job, s, i, d);
    const Reach flat = { d[0] * d[0] + d[1] * d[1], foot[0] * d[0] + foot[1] * d[1],
                         foot[0] * foot[0] + foot[1] * foot[1] };
    const double axis = (double)least_reach(&flat, way), middle = (double)least_reach(&all, way);
    const double turn = fabs((double)(foot[0] * d[1] - foot[1] * d[0]));
    const double rise = sqrt((double)(dot3(foot, foot) * dot3(d, d))) / (WR_PI * middle * middle);
    const double a = turn / (2 * WR_PI * axis * axis);
    const double b = is_tube(job) ? fabs((double)(d[2] / VIEWED(job->view, shape).value[1])) : rise;
    const double steep = (a > 0 ? p->steep[0] * a : 0) + (b > 0 ? p->steep[1] * b : 0);
    const double texels = (double)m->least[i];
    const double steps = p->texels[0] > 0 ? fmin(2 + 2 * texels, p->steps) : p->steps;
    const double falls = sqrt((double)all.aa) + steep;
    m->pace[i] = falls > 0 && falls < INFINITY ? (REAL)(1 / falls) : 0;
    m->least[i] = (REAL)((double)(way.to - way.from) / fmax(1, floor(steps)));
}

static void look_ahead(const WrTileJob *job, const Strip *s, const March *m, const int *list,
                       int count, const REAL *t, REAL *g, WrTileScratch *scratch);

/* Starts the strip's rays from the shell (compare set_out, which starts them from the base). */
static void set_out_shell(const WrTileJob *job, const Rays *rays, Strip *s, March *m, REAL *t,
                          WrTileScratch *scratch)
{
    int left = 0, under = 0, inside[WR_SPAN];
    m->count = m->met_count = 0;
    for (int i = 0; i < s->count; i++) {
        const bool goes = enter_shell(job, rays, s, i, m);
        t[i] = m->from[i];
        if (goes) m->on[m->count++] = i;
    }
    look_ahead(job, s, m, m->on, m->count, t, m->before, scratch);
    for (int k = 0; k < m->count; k++) {
        const int i = m->on[k];
        const bool met = !(m->before[i] > 0);
        if (met && !m->below[i]) { /* on the shell itself */
            m->misses[i] = false;
            continue;
        }
        m->side[i] = met ? -1 : 1;
        leave_shell(job, s, i, m);
        t[i] = m->from[i];
        if (met) inside[under++] = i;
        m->on[left++] = i;
    }
    m->count = left;
    look_ahead(job, s, m, inside, under, t, m->before, scratch);
    count_texels(job, s, m, t, scratch);
    for (int k = 0; k < m->count; k++) pace_shell(job, s, m->on[k], m);
}

/* g at t of the listed rays. */
static void look_ahead(const WrTileJob *job, const Strip *s, const March *m, const int *list,
                       int count, const REAL *t, REAL *g, WrTileScratch *scratch)
{
    Strip *near = NEAR_OF(scratch);
    const bool shell = job->parallax.shell;
    near->count = count;
    for (int k = 0; k < count && !shell; k++) {
        const int i = list[k];
        near->u[k] = s->u[i] + t[i] * m->a[i];
        near->v[k] = s->v[i] + t[i] * m->b[i];
    }
    if (shell) place_shell(job, s, m, list, count, t, near);
    if (job->plan->source == WR_SOURCE_FORMULA) look_analytic(job, near);
    else look_heights(job, near, scratch);
    for (int k = 0; k < count; k++) {
        const int i = list[k];
        const REAL base =
            shell ? m->side[i] * over_base(job, near, k) : t[i] * (m->rise[i] + t[i] * m->bend[i]);
        g[i] = base - m->side[i] * near->f[k];
    }
}

/* Starts the strip's rays. A ray that begins below the relief either entered below the edge of a surface that
   ends, and misses it, or stays at its start. t: end of each ray, as far as it is known. */
static void set_out(const WrTileJob *job, const Rays *rays, const Strip *s, March *m, REAL *t,
                    WrTileScratch *scratch)
{
    const WrParallax *p = &job->parallax;
    int left = 0;
    m->count = m->met_count = 0;
    for (int i = 0; i < s->count; i++) {
        m->below[i] = m->misses[i] = false;
        t[i] = 0;
        if (!aim_ray(p, rays, s, i, m)) continue;
        const bool goes = limit_ray(p, s, i, m);
        t[i] = goes ? m->from[i] : m->to[i];
        if (!goes) continue;
        pace_ray(p, i, m);
        m->on[m->count++] = i;
    }
    look_ahead(job, s, m, m->on, m->count, t, m->before, scratch);
    for (int k = 0; k < m->count; k++) {
        const int i = m->on[k];
        if (m->before[i] > 0) m->on[left++] = i;
        else m->misses[i] = m->below[i];
    }
    m->count = left;
}

/* One step of all rays that still march. */
static void step_on(const WrTileJob *job, const Strip *s, March *m, REAL *t, REAL *g,
                    WrTileScratch *scratch)
{
    int left = 0;
    for (int k = 0; k < m->count; k++) {
        const int i = m->on[k];
        const REAL far = m->pace[i] * m->before[i];
        t[i] = m->from[i] + (far > m->least[i] ? far : m->least[i]);
        if (!(t[i] < m->to[i])) t[i] = m->to[i];
    }
    look_ahead(job, s, m, m->on, m->count, t, g, scratch);
    for (int k = 0; k < m->count; k++) {
        const int i = m->on[k];
        const bool met = !(g[i] > 0), over = !(t[i] < m->to[i]);
        if (met) {
            m->to[i] = t[i], m->past[i] = g[i];
            m->misses[i] = false;
            m->met[m->met_count++] = i;
        } else if (!over) {
            m->from[i] = t[i], m->before[i] = g[i];
            m->on[left++] = i;
        }
    }
    m->count = left;
}

static REAL straight(const March *m, int i)
{
    const REAL all = m->before[i] - m->past[i];
    return all > 0 ? m->from[i] + (m->to[i] - m->from[i]) * (m->before[i] / all) : m->to[i];
}

/* Refines the hits within the last step. */
static void close_in(const WrTileJob *job, const Strip *s, March *m, REAL *t, REAL *g,
                     WrTileScratch *scratch)
{
    for (int step = 0; step <= LAST_STEPS; step++) {
        for (int k = 0; k < m->met_count; k++) {
            const int i = m->met[k];
            t[i] = step % 2 ? (m->from[i] + m->to[i]) / 2 : straight(m, i);
        }
        if (step == LAST_STEPS || m->met_count == 0) break;
        look_ahead(job, s, m, m->met, m->met_count, t, g, scratch);
        for (int k = 0; k < m->met_count; k++) {
            const int i = m->met[k];
            if (g[i] > 0) m->from[i] = t[i], m->before[i] = g[i];
            else m->to[i] = t[i], m->past[i] = g[i];
        }
    }
}

static REAL once_round(bool closed, REAL x)
{
    if (closed) return x - (REAL)floor((double)x);
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

/* Moves samples to the hits on the relief; samples without a hit are removed. s->s: the visible side. */
static void move_samples(const WrTileJob *job, const Rays *rays, const March *m, const REAL *t,
                         Strip *s)
{
    const WrParallax *p = &job->parallax;
    const bool endless = job->view->endless;
    int kept[WR_SPAN], count = 0;
    for (int i = 0; i < s->count; i++) {
        REAL d[3];
        if (m->misses[i]) continue;
        kept[count++] = i;
        ray_of(rays, s, i, d);
        s->px[i] += t[i] * d[0], s->py[i] += t[i] * d[1], s->pz[i] += t[i] * d[2];
        s->s[i] = m->side[i];
        if (p->shell) continue;
        s->u[i] += t[i] * m->a[i], s->v[i] += t[i] * m->b[i];
        if (endless) continue;
        s->u[i] = once_round(p->closed[0], s->u[i]);
        s->v[i] = once_round(p->closed[1], s->v[i]);
    }
    if (count < s->count) keep_samples(kept, count, s);
    if (p->shell) round_of(job)->params(&VIEWED(job->view, shape), s);
}

/* Moves the strip's samples from the base to the relief: their u, v, P. */
static void meet_relief(const WrTileJob *job, const Rays *rays, int face, Strip *s,
                        WrTileScratch *scratch, Watch *watch)
{
    const WrSurfaceKind kind = job->view->shape_d.kind;
    March m;
    REAL t[WR_SPAN], g[WR_SPAN];
    if (s->count == 0) return;
    if (job->parallax.shell) {
        set_out_shell(job, rays, s, &m, t, scratch);
    } else {
        KERNELS_OF(job)->geometry[kind](&VIEWED(job->view, shape), face, s);
        if (job->parallax.bent)
            KERNELS_OF(job)->curvature[kind](&VIEWED(job->view, shape), face, s);
        set_out(job, rays, s, &m, t, scratch);
    }
    while (m.count > 0) step_on(job, s, &m, t, g, scratch);
    close_in(job, s, &m, t, g, scratch);
    move_samples(job, rays, &m, t, s);
    did(watch, WR_EFFECT_PARALLAX);
    watch_lap(watch, WR_STAGE_PARALLAX);
}

/* Height of the hit above the base, where P now is: for the shadow of the base (stage_shadow_body.h). */
static void keep_lift(Strip *s)
{
    for (int i = 0; i < s->count; i++)
        s->f[i] = (s->bx[i] - s->px[i]) * s->nx[i] + (s->by[i] - s->py[i]) * s->ny[i] +
                  (s->bz[i] - s->pz[i]) * s->nz[i];
}

/* Turns n' to the side that the ray came from, whichever side of the base that is. */
static void face_ray(const Rays *rays, const REAL *side, Strip *s)
{
    const REAL *at = rays->perspective ? rays->eye : rays->toward;
    const REAL move = rays->perspective ? (REAL)1 : (REAL)0;
    for (int i = 0; i < s->count; i++) {
        const REAL to = s->nx[i] * (at[0] - move * s->px[i]) +
                        s->ny[i] * (at[1] - move * s->py[i]) + s->nz[i] * (at[2] - move * s->pz[i]);
        const REAL sign = (to < 0) == (side[i] < 0) ? (REAL)1 : (REAL)-1;
        s->bx[i] *= sign, s->by[i] *= sign, s->bz[i] *= sign;
    }
}
