/* pipe_map_body.h - the normal map: its slopes, or the vectors that it holds in axes of the place, as slopes that are
   added to the table's. A part of pipe_body.h. */

/* ---- look-ups ------------------------------------------------------------------------------------ */

/* Level 1 is the map itself (relief.h), whose texels are not spread. */
static void flush_map(const WrTileJob *job, const Batch *batch, Strip *strip,
                      WrTileScratch *scratch, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    Strip *near = NEAR_OF(scratch), *far = FAR_OF(scratch);
    (void)watch;
    for (int i = 0; i < near->count; i++) near->level[i] = (REAL)1;
    for (int i = 0; i < far->count; i++)
        far->level[i] = (far->level[i] > (REAL)1 ? far->level[i] : (REAL)1) + (REAL)1;
    if (near->count > 0) k->look_pyramid(MAP_OF(job), false, near);
    if (far->count > 0) k->look_pyramid(MAP_OF(job), runs(job, WR_EFFECT_SPREAD), far);
    sum_batch(batch, near, far, strip);
    near->count = far->count = 0;
}

/* The same of vectors, which stand where slopes do. */
static void flush_vectors(const WrTileJob *job, const Batch *batch, Strip *strip,
                          WrTileScratch *scratch, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    Strip *const both[2] = { NEAR_OF(scratch), FAR_OF(scratch) };
    (void)watch;
    for (int s = 0; s < 2; s++) {
        Strip *at = both[s];
        for (int i = 0; i < at->count; i++)
            at->level[i] = s && at->level[i] > (REAL)1 ? at->level[i] + (REAL)1 : (REAL)(1 + s);
        if (at->count > 0) k->colour_pyramid(MAP_OF(job), at);
        for (int i = 0; i < at->count; i++) {
            at->f[i] = at->cb[i], at->fu[i] = at->cr[i], at->fv[i] = at->cg[i];
            at->suu[i] = at->suv[i] = at->svv[i] = 0;
        }
    }
    sum_batch(batch, both[0], both[1], strip);
    both[0]->count = both[1]->count = 0;
}

static void map_levels(const WrTileJob *job, const Rays *rays, Strip *strip)
{
    const Kernels *k = KERNELS_OF(job);
    const REAL last = (REAL)(MAP_OF(job)->pyramid->levels - 2);
    if (job->plan->map_filtered) {
        (job->triangles ? k->footprint_met : k->footprint)(rays, MAP_OF(job), 1, strip);
        k->spread(MAP_OF(job), job->plan->map_anisotropic, strip);
    }
    for (int i = 0; i < strip->count; i++) {
        if (!job->plan->map_filtered) strip->level[i] = 0, strip->taps[i] = 1;
        else if (strip->level[i] > last) strip->level[i] = last;
    }
}

/* ---- axes of a place ----------------------------------------------------------------------------- */

typedef struct Axis {
    REAL x, y, z;
} Axis;

typedef struct Axes {
    Axis t, b, n;
} Axes;

static Axis axis(REAL x, REAL y, REAL z)
{
    return (Axis){ x, y, z };
}

static REAL axis_dot(Axis a, Axis b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static Axis axis_cross(Axis a, Axis b)
{
    return (Axis){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

/* a + k b */
static Axis axis_mad(Axis a, Axis b, REAL k)
{
    return (Axis){ a.x + k * b.x, a.y + k * b.y, a.z + k * b.z };
}

static REAL axis_length(Axis a)
{
    return (REAL)sqrt((double)axis_dot(a, a));
}

/* 0 where it is 0. */
static Axis axis_unit(Axis a)
{
    const REAL length = axis_length(a), inv = length > (REAL)0 ? (REAL)1 / length : (REAL)0;
    return (Axis){ a.x * inv, a.y * inv, a.z * inv };
}

static Axes patch_axes(WrNormalFrame frame, const Strip *strip, int i)
{
    const Axis n = axis(strip->nx[i], strip->ny[i], strip->nz[i]);
    const Axis pu = axis(strip->pux[i], strip->puy[i], strip->puz[i]);
    const Axis pv = axis(strip->pvx[i], strip->pvy[i], strip->pvz[i]);
    if (frame == WR_FRAME_LECTURE) return (Axes){ axis_unit(pu), axis_unit(pv), n };
    const Axis t = axis_unit(axis_mad(pu, n, -axis_dot(pu, n)));
    return (Axes){ t, axis_cross(n, t), n };
}

/* The corner's place, in the kernels' unit, less `from`. */
static Axis corner_from(const WrTriangleLook *look, int32_t corner, Axis from)
{
    const float *p = look->corners + 8 * (size_t)corner;
    const REAL s = (REAL)look->scale;
    return axis((REAL)p[0] * s - from.x, (REAL)p[1] * s - from.y, (REAL)p[2] * s - from.z);
}

/* The shares of a triangle's second and third corner in the sample's place. */
static void shares_of(const WrTriangleLook *look, const int32_t *corner, const Strip *strip, int i,
                      REAL share[3])
{
    const Axis zero = { 0, 0, 0 }, a = corner_from(look, corner[0], zero);
    const Axis e1 = corner_from(look, corner[1], a), e2 = corner_from(look, corner[2], a);
    const Axis w = axis(strip->px[i] - a.x, strip->py[i] - a.y, strip->pz[i] - a.z);
    const Axis cross = axis_cross(e1, e2);
    const REAL square = axis_dot(cross, cross);
    const REAL inv = square > (REAL)0 ? (REAL)1 / square : (REAL)0;
    share[1] = axis_dot(axis_cross(w, e2), cross) * inv;
    share[2] = axis_dot(axis_cross(e1, w), cross) * inv;
    share[0] = (REAL)1 - share[1] - share[2];
}

/* Of a triangle: what its corners have, mixed. By MikkTSpace B is the cross product of the two as they come out. */
static Axes triangle_axes(const WrTileJob *job, const Strip *strip, int i)
{
    const WrTriangleLook *look = &job->triangle_look;
    const size_t triangle = (size_t)strip->triangle[i];
    const int32_t *corner = look->triangles + 3 * triangle;
    const float *frames = job->frames->corner + 3 * triangle * WR_CORNER_FRAME;
    Axes out = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    REAL share[3];
    shares_of(look, corner, strip, i, share);
    for (int k = 0; k < 3; k++) {
        const float *f = frames + k * WR_CORNER_FRAME, *c = look->corners + 8 * (size_t)corner[k];
        out.t = axis_mad(out.t, axis((REAL)f[0], (REAL)f[1], (REAL)f[2]), share[k]);
        out.b = axis_mad(out.b, axis((REAL)f[3], (REAL)f[4], (REAL)f[5]), share[k]);
        out.n = axis_mad(out.n, axis((REAL)c[3], (REAL)c[4], (REAL)c[5]), share[k]);
    }
    if (job->plan->map_frame == WR_FRAME_LECTURE) {
        out.t = axis_unit(out.t), out.b = axis_unit(out.b);
    } else { /* b.x holds the sign */
        const Axis zero = { 0, 0, 0 };
        out.b = axis_mad(zero, axis_cross(out.n, out.t), out.b.x);
    }
    return out;
}

/* ---- from vectors to slopes ---------------------------------------------------------------------- */

/* What a gradient is multiplied by, dot Pu and dot Pv, to be Fu and Fv. */
static REAL slopes_per_gradient(const WrTileJob *job, const Strip *strip, int i, Axis g)
{
    const Axis n = axis(strip->nx[i], strip->ny[i], strip->nz[i]);
    const Axis pu = axis(strip->pux[i], strip->puy[i], strip->puz[i]);
    const Axis pv = axis(strip->pvx[i], strip->pvy[i], strip->pvz[i]);
    REAL k = (REAL)1;
    if (job->triangles) { /* Pu and Pv are the gradients of v and u, laid across n; |N| is 1 */
        const REAL along = axis_dot(n, axis_cross(pu, pv)),
                   size = axis_length(pu) * axis_length(pv);
        k = along > (REAL)1e-6 * size || -along > (REAL)1e-6 * size ? (REAL)1 / along : (REAL)0;
    }
    if (job->plan->bump == WR_BUMP_INVARIANT) {
        const REAL gu = axis_dot(g, pu), gv = axis_dot(g, pv);
        const REAL size = (REAL)sqrt((double)(gu * gu + gv * gv));
        const REAL even = size > (REAL)0 ? axis_length(g) / size : (REAL)0;
        k = k < (REAL)0 ? -even : k > (REAL)0 ? even : (REAL)0;
    }
    return k;
}

/* The gradient whose normal is m: no steeper than reading leaves any. */
static Axis gradient_of(Axis m, Axis n)
{
    const REAL z = axis_dot(n, m), least = (REAL)WR_NORMAL_LEAST * axis_length(m);
    const REAL inv = z > least ? (REAL)-1 / z : least > (REAL)0 ? (REAL)-1 / least : (REAL)0;
    const Axis zero = { 0, 0, 0 };
    return axis_mad(zero, axis_mad(m, n, -z), inv);
}

/* What has become of the map's numbers of a sample goes into its slopes: p and q along t and b of the place, with their
   covariance; or a vector of the object's axes, without. */
static void turn_into_slopes(const WrTileJob *job, Strip *strip, int i)
{
    const WrNormalFrame frame = job->plan->map_frame;
    const Axis n = axis(strip->nx[i], strip->ny[i], strip->nz[i]);
    const Axis pu = axis(strip->pux[i], strip->puy[i], strip->puz[i]);
    const Axis pv = axis(strip->pvx[i], strip->pvy[i], strip->pvz[i]);
    const Axis zero = { 0, 0, 0 };
    const bool object = frame == WR_FRAME_OBJECT;
    REAL p = strip->fu[i], q = strip->fv[i];
    Axes at = { zero, zero, n };
    if (!object) at = job->triangles ? triangle_axes(job, strip, i) : patch_axes(frame, strip, i);
    if (!object && !(axis_dot(at.t, at.t) > (REAL)0 && axis_dot(at.b, at.b) > (REAL)0)) p = q = 0;
    Axis m = axis_mad(axis_mad(at.n, at.t, -p), at.b, -q);
    if (object) m = axis(strip->fu[i], strip->fv[i], strip->f[i]);
    Axis g = gradient_of(m, n);
    if (object) g = axis_mad(zero, g, (REAL)job->scene->normals.strength);
    const REAL k = slopes_per_gradient(job, strip, i, g);
    strip->f[i] = 0;
    strip->fu[i] = k * axis_dot(g, pu);
    strip->fv[i] = k * axis_dot(g, pv);
    /* to first order the axes carry the covariance over */
    const REAL z = axis_dot(at.n, n), by = z > (REAL)0 ? k / z : (REAL)0;
    const REAL uu = by * axis_dot(at.t, pu), uv = by * axis_dot(at.b, pu);
    const REAL vu = by * axis_dot(at.t, pv), vv = by * axis_dot(at.b, pv);
    const REAL a = strip->suu[i], b = strip->suv[i], c = strip->svv[i];
    strip->suu[i] = uu * uu * a + (REAL)2 * uu * uv * b + uv * uv * c;
    strip->suv[i] = uu * vu * a + (uu * vv + uv * vu) * b + uv * vv * c;
    strip->svv[i] = vu * vu * a + (REAL)2 * vu * vv * b + vv * vv * c;
}

/* ---- together ------------------------------------------------------------------------------------ */

static void move_reals(REAL *to, const REAL *from, int count)
{
    memcpy(to, from, (size_t)count * sizeof *to);
}

/* Heights add where slopes add: the map's slopes, and what is spread about them, to what the strip has. That the two
   may go together is left out of their covariance. What the strip has waits in the places of what `widen` fills. */
static void look_map(const WrTileJob *job, const Rays *rays, Strip *strip, WrTileScratch *scratch,
                     Watch *watch)
{
    REAL *const sums[] = { strip->f, strip->fu, strip->fv, strip->suu, strip->suv, strip->svv };
    REAL *const kept[] = { strip->ex, strip->ey, strip->ez, strip->see, strip->sef, strip->sff };
    const bool none = job->plan->source == WR_SOURCE_NONE, filtered = runs(job, WR_EFFECT_FILTER);
    const WrNormalFrame frame = job->plan->map_frame;
    did(watch, WR_EFFECT_NORMALS);
    for (int c = 0; c < 6; c++) {
        if (none || (c >= 3 && !filtered))
            memset(kept[c], 0, (size_t)strip->count * sizeof *kept[c]);
        else move_reals(kept[c], sums[c], strip->count);
    }
    map_levels(job, rays, strip);
    look_along(job, frame == WR_FRAME_OBJECT ? flush_vectors : flush_map, strip, scratch, watch);
    for (int i = 0; i < strip->count && frame != WR_FRAME_GRADIENT; i++)
        turn_into_slopes(job, strip, i);
    for (int c = 0; c < 6; c++)
        for (int i = 0; i < strip->count; i++) sums[c][i] = kept[c][i] + sums[c][i];
    watch_lap(watch, WR_STAGE_NORMALS);
}
