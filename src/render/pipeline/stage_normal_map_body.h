/* stage_normal_map_body.h - normal mapping: the map's slopes, or its vectors in local axes converted to slopes,
   are added to the table's slopes or combined with them. Part of pipeline_body.h. */

/* ---- fetches ------------------------------------------------------------------------------------- */

/* Level 1 is the map itself (mips.h), whose texels have no spread. */
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

/* Sums up a batch of vector fetches, which use the buffers of slopes. */
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
        (met_whole(job) ? k->footprint_met : k->footprint)(rays, MAP_OF(job), 1, strip);
        k->spread(MAP_OF(job), job->plan->map_anisotropic, strip);
    }
    for (int i = 0; i < strip->count; i++) {
        if (!job->plan->map_filtered) strip->level[i] = 0, strip->taps[i] = 1;
        else if (strip->level[i] > last) strip->level[i] = last;
    }
}

/* ---- local axes --------------------------------------------------------------------------------- */

typedef struct Axes {
    VEC t, b, n;
} Axes;

static REAL length_of(VEC a)
{
    return (REAL)sqrt((double)v_dot(a, a));
}

/* Unit vector; 0 for the zero vector. */
static VEC unit_of(VEC a)
{
    const REAL length = length_of(a), inv = length > (REAL)0 ? (REAL)1 / length : (REAL)0;
    return v_scale(a, inv);
}

static VEC read_vec(const float *from)
{
    return (VEC){ (REAL)from[0], (REAL)from[1], (REAL)from[2] };
}

/* n of sample i as the kernels stored it. */
static VEC normal_of(const Strip *strip, int i)
{
    return (VEC){ strip->nx[i], strip->ny[i], strip->nz[i] };
}

static VEC along_u(const Strip *strip, int i)
{
    return (VEC){ strip->pux[i], strip->puy[i], strip->puz[i] };
}

static VEC along_v(const Strip *strip, int i)
{
    return (VEC){ strip->pvx[i], strip->pvy[i], strip->pvz[i] };
}

static Axes patch_axes(WrNormalFrame frame, const Strip *strip, int i)
{
    const VEC n = normal_of(strip, i);
    const VEC pu = along_u(strip, i);
    const VEC pv = along_v(strip, i);
    if (frame == WR_FRAME_LECTURE) return (Axes){ unit_of(pu), unit_of(pv), n };
    const VEC t = unit_of(v_mad(pu, n, -v_dot(pu, n)));
    return (Axes){ t, v_cross(n, t), n };
}

/* The corner's position in kernel units, minus `from`. */
static VEC corner_from(const WrTriangleLook *look, int32_t corner, VEC from)
{
    const VEC p = read_vec(look->corners + 8 * (size_t)corner);
    return v_sub(v_scale(p, (REAL)look->scale), from);
}

/* Barycentric shares of a triangle's second and third corner at the sample. */
static void shares_of(const WrTriangleLook *look, const int32_t *corner, const Strip *strip, int i,
                      REAL share[3])
{
    const VEC zero = { 0, 0, 0 }, a = corner_from(look, corner[0], zero);
    const VEC e1 = corner_from(look, corner[1], a), e2 = corner_from(look, corner[2], a);
    const VEC w = { strip->px[i] - a.x, strip->py[i] - a.y, strip->pz[i] - a.z };
    const VEC cross = v_cross(e1, e2);
    const REAL square = v_dot(cross, cross);
    const REAL inv = square > (REAL)0 ? (REAL)1 / square : (REAL)0;
    share[1] = v_dot(v_cross(w, e2), cross) * inv;
    share[2] = v_dot(v_cross(e1, w), cross) * inv;
    share[0] = (REAL)1 - share[1] - share[2];
}

/* The face of the mesh at the sample, and the shares of its corners. */
static size_t face_at(const WrTriangleLook *look, const Strip *strip, int i, REAL share[3])
{
    const size_t triangle = (size_t)strip->triangle[i];
    const int32_t *corner = look->triangles + 3 * triangle;
    shares_of(look, corner, strip, i, share);
    if (!look->base_of) return triangle;
    const REAL own[3] = { share[0], share[1], share[2] }; /* of a triangle of the relief */
    share[1] = share[2] = (REAL)0;
    for (int k = 0; k < 3; k++)
        for (int c = 1; c < 3; c++)
            share[c] += own[k] * (REAL)look->corners[8 * (size_t)corner[k] + 5 + (size_t)c];
    share[0] = (REAL)1 - share[1] - share[2];
    return (size_t)look->base_of[triangle];
}

/* Tangent frame of a triangle: interpolated from its corners. As in MikkTSpace, B is the cross product of the
   interpolated vectors, not normalised. */
static Axes triangle_axes(const WrTileJob *job, const Strip *strip, int i)
{
    const WrTriangleLook *look = &job->triangle_look;
    REAL share[3];
    const size_t triangle = face_at(look, strip, i, share);
    const int32_t *corner = (look->base_of ? look->base_triangles : look->triangles) + 3 * triangle;
    const float *corners = look->base_of ? look->base_corners : look->corners;
    const float *frames = job->frames->corner + 3 * triangle * WR_CORNER_FRAME;
    Axes out = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    for (int k = 0; k < 3; k++) {
        const float *f = frames + k * WR_CORNER_FRAME, *c = corners + 8 * (size_t)corner[k];
        out.t = v_mad(out.t, read_vec(f), share[k]);
        out.b = v_mad(out.b, read_vec(f + 3), share[k]);
        out.n = v_mad(out.n, read_vec(c + 3), share[k]);
    }
    if (job->plan->map_frame == WR_FRAME_LECTURE) {
        /* the lecture normalises all three interpolated vectors, N as well as T and B */
        out.t = unit_of(out.t), out.b = unit_of(out.b), out.n = unit_of(out.n);
    } else { /* b.x holds the handedness, +1 or -1 */
        out.b = v_scale(v_cross(out.n, out.t), out.b.x);
    }
    return out;
}

/* ---- vectors to slopes --------------------------------------------------------------------------- */

/* Factor by which a gradient dotted with Pu and Pv becomes Fu and Fv. */
static REAL slopes_per_gradient(const WrTileJob *job, const Strip *strip, int i, VEC g)
{
    const VEC n = normal_of(strip, i);
    const VEC pu = along_u(strip, i);
    const VEC pv = along_v(strip, i);
    REAL k = (REAL)1;
    /* Pu and Pv are the gradients of v and u, rotated by 90 degrees about n; |N| is 1 */
    if (met_whole(job)) {
        const REAL along = v_dot(n, v_cross(pu, pv)), size = length_of(pu) * length_of(pv);
        k = along > (REAL)1e-6 * size || -along > (REAL)1e-6 * size ? (REAL)1 / along : (REAL)0;
    }
    if (job->plan->bump == WR_BUMP_INVARIANT) {
        const REAL gu = v_dot(g, pu), gv = v_dot(g, pv);
        const REAL size = (REAL)sqrt((double)(gu * gu + gv * gv));
        const REAL even = size > (REAL)0 ? length_of(g) / size : (REAL)0;
        k = k < (REAL)0 ? -even : k > (REAL)0 ? even : (REAL)0;
    }
    return k;
}

/* The gradient whose normal is m, limited to the steepest slope that the map reader allows. */
static VEC gradient_of(VEC m, VEC n)
{
    const REAL z = v_dot(n, m), least = (REAL)WR_NORMAL_MIN * length_of(m);
    const REAL inv = z > least ? (REAL)-1 / z : least > (REAL)0 ? (REAL)-1 / least : (REAL)0;
    return v_scale(v_mad(m, n, -z), inv);
}

/* Covariance of slopes. */
typedef struct Spread {
    REAL uu, uv, vv;
} Spread;

static Spread spread_of(const Strip *strip, int i)
{
    return (Spread){ strip->suu[i], strip->suv[i], strip->svv[i] };
}

/* That of u[0] x + u[1] y and v[0] x + v[1] y, from that of x and y. */
static Spread carried(Spread of, const REAL u[2], const REAL v[2])
{
    return (Spread){ u[0] * u[0] * of.uu + (REAL)2 * u[0] * u[1] * of.uv + u[1] * u[1] * of.vv,
                     u[0] * v[0] * of.uu + (u[0] * v[1] + u[1] * v[0]) * of.uv +
                         u[1] * v[1] * of.vv,
                     v[0] * v[0] * of.uu + (REAL)2 * v[0] * v[1] * of.uv + v[1] * v[1] * of.vv };
}

static void put_spread(Strip *strip, int i, Spread spread)
{
    strip->suu[i] = spread.uu, strip->suv[i] = spread.uv, strip->svv[i] = spread.vv;
}

/* Converts a sample's map values to slopes. Input: p and q along the local t and b, with their covariance; or a
   vector along the object's axes, without covariance. */
static void turn_into_slopes(const WrTileJob *job, Strip *strip, int i)
{
    const WrNormalFrame frame = job->plan->map_frame;
    const VEC n = normal_of(strip, i);
    const VEC pu = along_u(strip, i);
    const VEC pv = along_v(strip, i);
    const VEC zero = { 0, 0, 0 };
    const bool object = frame == WR_FRAME_OBJECT;
    REAL p = strip->fu[i], q = strip->fv[i];
    Axes at = { zero, zero, n };
    if (!object) at = met_whole(job) ? triangle_axes(job, strip, i) : patch_axes(frame, strip, i);
    if (!object && !(v_dot(at.t, at.t) > (REAL)0 && v_dot(at.b, at.b) > (REAL)0)) p = q = 0;
    VEC m = v_mad(v_mad(at.n, at.t, -p), at.b, -q);
    if (object) m = (VEC){ strip->fu[i], strip->fv[i], strip->f[i] };
    VEC g = gradient_of(m, n);
    if (object) g = v_scale(g, (REAL)job->scene->normals.strength);
    const REAL k = slopes_per_gradient(job, strip, i, g);
    strip->f[i] = 0;
    strip->fu[i] = k * v_dot(g, pu);
    strip->fv[i] = k * v_dot(g, pv);
    /* to first order the axes transform the covariance */
    const REAL z = v_dot(at.n, n), by = z > (REAL)0 ? k / z : (REAL)0;
    const REAL u[2] = { by * v_dot(at.t, pu), by * v_dot(at.b, pu) };
    const REAL v[2] = { by * v_dot(at.t, pv), by * v_dot(at.b, pv) };
    put_spread(strip, i, carried(spread_of(strip, i), u, v));
}

/* ---- relief over the map ------------------------------------------------------------------------- */

/* The combined normal n z - top (shade/bump.h) of the gradients g, the map's, and b, the relief's:
   top = g + w b - k s g, z = 1 - h s, s = g.b, with k = 1 / (1 + w), h = 1 for `reoriented` and k = h = 1 / w for
   `surface`. */
typedef struct Over {
    VEC g, b, top;
    REAL w, s, k, h, z;
    bool turned; /* reoriented */
} Over;

static Over over_map(WrCombine combine, VEC g, VEC b)
{
    Over at = { .g = g, .b = b, .turned = combine == WR_COMBINE_REORIENTED };
    at.w = (REAL)sqrt((double)((REAL)1 + v_dot(g, g)));
    at.s = v_dot(g, b);
    at.k = (REAL)1 / (at.turned ? (REAL)1 + at.w : at.w);
    at.h = at.turned ? (REAL)1 : at.k;
    at.top = v_mad(v_mad(g, b, at.w), g, -at.k * at.s);
    at.z = (REAL)1 - at.h * at.s;
    return at;
}

/* Change of the gradient top / z by small changes of g and b. k' = -k k w' in both. */
static VEC change_by(const Over *at, VEC dg, VEC db)
{
    const REAL dw = v_dot(at->g, dg) / at->w, ds = v_dot(dg, at->b) + v_dot(at->g, db);
    const REAL dk = -at->k * at->k * dw, dh = at->turned ? (REAL)0 : dk;
    const REAL least = (REAL)WR_NORMAL_MIN * (length_of(at->top) + (at->z > 0 ? at->z : -at->z));
    const REAL inv = (REAL)1 / (at->z > least ? at->z : least);
    VEC top = v_mad(v_mad(dg, at->b, dw), db, at->w);
    top = v_mad(v_mad(top, at->g, -dk * at->s - at->k * ds), dg, -at->k * at->s);
    return v_scale(v_mad(top, at->top, inv * (dh * at->s + at->h * ds)), inv);
}

/* Directions, across n, in which Fu and Fv rise: Pv x n and n x Pu, |N| times their gradients. */
typedef struct Rise {
    VEC u, v;
} Rise;

static Rise rise_of(const Strip *strip, int i)
{
    const VEC n = normal_of(strip, i);
    return (Rise){ v_cross(along_v(strip, i), n), v_cross(n, along_u(strip, i)) };
}

/* The gradient of slopes; under `invariant` their length is its own. */
static VEC gradient_by(const WrTileJob *job, const Strip *strip, int i, Rise at, REAL fu, REAL fv)
{
    const VEC sum = v_mad(v_scale(at.u, fu), at.v, fv);
    if (job->plan->bump == WR_BUMP_INVARIANT)
        return v_scale(unit_of(sum), (REAL)sqrt((double)(fu * fu + fv * fv)));
    return v_scale(sum, strip->n_len[i] > (REAL)0 ? (REAL)1 / strip->n_len[i] : (REAL)0);
}

/* Spread of the relief's and of the map's slopes, to first order, each as a change of the combined ones. */
static Spread spread_over(const WrTileJob *job, const Strip *strip, int i, const Over *over,
                          Rise at, Spread own)
{
    const VEC none = { 0, 0, 0 }, pu = along_u(strip, i), pv = along_v(strip, i);
    const bool unit = job->plan->bump == WR_BUMP_INVARIANT;
    const REAL inv = strip->n_len[i] > (REAL)0 ? (REAL)1 / strip->n_len[i] : (REAL)0;
    const VEC a = unit ? unit_of(at.u) : v_scale(at.u, inv);
    const VEC b = unit ? unit_of(at.v) : v_scale(at.v, inv);
    const REAL au = v_dot(a, pu), bv = v_dot(b, pv);
    const VEC to_u = v_scale(pu, au != (REAL)0 ? (REAL)1 / au : (REAL)0);
    const VEC to_v = v_scale(pv, bv != (REAL)0 ? (REAL)1 / bv : (REAL)0);
    Spread sum = { 0, 0, 0 };
    for (int k = 0; k < 2; k++) {
        const VEC x = change_by(over, k ? a : none, k ? none : a);
        const VEC y = change_by(over, k ? b : none, k ? none : b);
        const Spread part =
            carried(k ? spread_of(strip, i) : own, (REAL[2]){ v_dot(to_u, x), v_dot(to_u, y) },
                    (REAL[2]){ v_dot(to_v, x), v_dot(to_v, y) });
        sum.uu += part.uu, sum.uv += part.uv, sum.vv += part.vv;
    }
    return sum;
}

/* Spreads of the relief's slopes, `kept`, and of the map's, the strip's, become that of the combined ones. */
static void combine_spreads(const WrTileJob *job, Strip *strip, REAL *const kept[6])
{
    for (int i = 0; i < strip->count; i++) {
        const REAL fu = kept[1][i], fv = kept[2][i];
        const Spread own = { kept[3][i], kept[4][i], kept[5][i] };
        if (fu == (REAL)0 && fv == (REAL)0 && own.uu + own.vv == (REAL)0) continue;
        const Rise at = rise_of(strip, i);
        const Over over =
            over_map(job->plan->combine, gradient_by(job, strip, i, at, strip->fu[i], strip->fv[i]),
                     gradient_by(job, strip, i, at, fu, fv));
        put_spread(strip, i, spread_over(job, strip, i, &over, at, own));
    }
}

/* Squares of products of two such gradients are within single precision. */
#define STEEPEST ((REAL)1e6)

static inline REAL square_root(REAL a)
{
    return (REAL)sqrt((double)a);
}

static inline REAL quotient(REAL a, REAL b)
{
    return b > (REAL)0 ? a / b : (REAL)0;
}

/* The relief's slopes over the map's, which are the strip's, become the strip's: over_map, gradient_of and
   slopes_per_gradient for all samples, without branches. Where the relief is level the map's keep their bits.
   turned, unit, whole: known where it is called, so that the loop is one of vectors. */
static inline __attribute__((always_inline)) void
combine_loop(bool turned, bool unit, bool whole, const REAL *own_u, const REAL *own_v, Strip *strip)
{
    const int count = strip->count;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const VEC n = normal_of(strip, i), pu = along_u(strip, i), pv = along_v(strip, i);
        const VEC ru = v_cross(pv, n), rv = v_cross(n, pu);
        const REAL fu = strip->fu[i], fv = strip->fv[i], hu = own_u[i], hv = own_v[i];
        VEC g = v_mad(v_scale(ru, fu), rv, fv), b = v_mad(v_scale(ru, hu), rv, hv);
        const REAL lg = square_root(v_dot(g, g)), lb = square_root(v_dot(b, b));
        const REAL inv = quotient(1, strip->n_len[i]);
        const REAL kg = unit ? quotient(square_root(fu * fu + fv * fv), lg) : inv;
        const REAL kb = unit ? quotient(square_root(hu * hu + hv * hv), lb) : inv;
        g = v_scale(g, kg * lg > STEEPEST ? STEEPEST / lg : kg);
        b = v_scale(b, kb * lb > STEEPEST ? STEEPEST / lb : kb);
        const REAL w = square_root((REAL)1 + v_dot(g, g)), s = v_dot(g, b);
        const REAL k = (REAL)1 / (turned ? (REAL)1 + w : w), z = (REAL)1 - (turned ? s : k * s);
        const VEC top = v_mad(v_mad(g, b, w), g, -k * s);
        const REAL least = (REAL)WR_NORMAL_MIN * square_root(z * z + v_dot(top, top));
        const VEC sum = v_scale(top, (REAL)1 / (z > least ? z : least));
        const REAL gu = v_dot(sum, pu), gv = v_dot(sum, pv);
        REAL by = 1;
        if (whole) {
            const REAL along = v_dot(ru, pu), size = v_dot(pu, pu) * v_dot(pv, pv);
            by = along * along > (REAL)1e-12 * size ? (REAL)1 / along : (REAL)0;
        }
        if (unit) {
            const REAL even =
                quotient(square_root(v_dot(sum, sum)), square_root(gu * gu + gv * gv));
            by = by < (REAL)0 ? -even : by > (REAL)0 ? even : (REAL)0;
        }
        const bool level = (hu == (REAL)0) & (hv == (REAL)0);
        strip->fu[i] = level ? fu : by * gu;
        strip->fv[i] = level ? fv : by * gv;
    }
}

static void combine_slopes(const WrTileJob *job, REAL *const kept[6], Strip *strip)
{
    const REAL *u = kept[1], *v = kept[2];
    const bool turned = job->plan->combine == WR_COMBINE_REORIENTED, whole = met_whole(job);
    if (job->plan->bump == WR_BUMP_INVARIANT) combine_loop(turned, true, whole, u, v, strip);
    else if (whole && turned) combine_loop(true, false, true, u, v, strip);
    else if (whole) combine_loop(false, false, true, u, v, strip);
    else if (turned) combine_loop(true, false, false, u, v, strip);
    else combine_loop(false, false, false, u, v, strip);
}

/* ---- whole strip --------------------------------------------------------------------------------- */

static void move_reals(REAL *to, const REAL *from, int count)
{
    memcpy(to, from, (size_t)count * sizeof *to);
}

/* Heights add where slopes add: the map's slopes and their spread are added to the strip's, unless the object
   combines them otherwise. The correlation of the two is neglected. The strip's own values are held in buffers
   that `widen` fills later. */
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
    look_along(job, rays, frame == WR_FRAME_OBJECT ? flush_vectors : flush_map, NULL, strip,
               scratch, watch);
    for (int i = 0; i < strip->count && frame != WR_FRAME_GRADIENT; i++)
        turn_into_slopes(job, strip, i);
    if (runs(job, WR_EFFECT_REORIENTED)) {
        did(watch, WR_EFFECT_REORIENTED);
        if (runs(job, WR_EFFECT_SPREAD)) combine_spreads(job, strip, kept);
        combine_slopes(job, kept, strip);
        move_reals(strip->f, kept[0], strip->count);
    }
    for (int c = 0; c < 6 && !runs(job, WR_EFFECT_REORIENTED); c++)
        for (int i = 0; i < strip->count; i++) sums[c][i] = kept[c][i] + sums[c][i];
    watch_lap(watch, WR_STAGE_NORMALS);
}
