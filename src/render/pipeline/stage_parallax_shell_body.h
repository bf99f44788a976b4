/* stage_parallax_shell_body.h - ray march through the shell of a round base's relief. Part of pipeline_body.h,
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
    round_of(job)->params(&VIEWED(job->view, shape), near);
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
