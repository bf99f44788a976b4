/* pipe_shadow_body.h - shadows that the relief throws on itself: a lamp is seen where it stands above the horizon of the
   table in its direction (field/horizon.h). A part of pipe_body.h.

   The surface is its tangent plane there: l's part in it is a Pu + b Pv, so that a way of t towards the lamp is t (a, b) in
   u and v, and t n.l upwards. The lamp is hidden where F rises by more than n.l per t somewhere on that way. */

/* Where (x, y) points among the table's directions: 0 <= at < directions. */
static REAL direction_of(REAL x, REAL y, int directions)
{
    const REAL wide = x < 0 ? -x : x, high = y < 0 ? -y : y;
    const bool upright = high > wide;
    const int side = upright ? (y > 0 ? 1 : 3) : (x < 0 ? 2 : 0);
    const REAL along = upright ? y : x, across = upright ? -x : y;
    const REAL t = along != 0 ? across / along : 0;
    const REAL at = ((REAL)side + t / 2) * (REAL)directions / 4;
    return at < 0 ? at + (REAL)directions : at;
}

/* The whole number below x, without a call where instructions are few. */
static REAL below(REAL x)
{
    const REAL whole = (REAL)(int64_t)x;
    return whole > x ? whole - 1 : whole;
}

/* x - 1/2 of texels on an axis of n that repeats: the texel and its neighbour, and how far past it. */
static REAL texel_of(REAL x, int n, int out[2])
{
    const REAL at = (x - below(x)) * (REAL)n - (REAL)0.5;
    const int low = (int)below(at);
    out[0] = low < 0 ? n - 1 : low < n ? low : n - 1;
    out[1] = out[0] + 1 < n ? out[0] + 1 : 0;
    return at - (REAL)low;
}

/* Of texels, the horizon's slope at u, v of the table towards (x, y). */
static REAL horizon_at(const WrHorizon *h, REAL x, REAL y, REAL u, REAL v)
{
    const REAL at = direction_of(x, y, h->directions);
    const int k = (int)at < h->directions ? (int)at : h->directions - 1;
    const int next = k + 1 < h->directions ? k + 1 : 0;
    const REAL turn = at - (REAL)k;
    int column[2], row[2];
    const REAL right = texel_of(u, h->width, column), down = texel_of(-v, h->height, row);
    REAL slope = 0;
    for (int corner = 0; corner < 4; corner++) {
        const size_t place =
            (size_t)row[corner / 2] * (size_t)h->width + (size_t)column[corner % 2];
        const float *of = h->slope + place * (size_t)h->directions;
        const REAL weight = (corner % 2 ? right : 1 - right) * (corner / 2 ? down : 1 - down);
        slope += weight * ((REAL)of[k] + turn * ((REAL)of[next] - (REAL)of[k]));
    }
    return slope;
}

/* The share of a round lamp of that angular radius that stands above the horizon: `up` it rises and `slope` the horizon does,
   both per unit of the way towards it. */
static REAL share_above(REAL up, REAL slope, double radius)
{
    if (!(radius > 0)) return up < slope ? (REAL)0 : (REAL)1;
    const double over = (double)up, flat = sqrt(fmax(1 - over * over, 0));
    return (REAL)wr_horizon_lamp(wr_atan2(over, flat), wr_atan2((double)slope, flat), radius);
}

/* The share of a lamp in direction l that the sample sees. All of it where its back is seen: there the table is another. */
static REAL share_of(const WrTileJob *job, const Strip *s, int i, REAL lx, REAL ly, REAL lz,
                     double radius)
{
    const REAL pux = s->pux[i], puy = s->puy[i], puz = s->puz[i];
    const REAL pvx = s->pvx[i], pvy = s->pvy[i], pvz = s->pvz[i];
    const REAL nx = s->nx[i], ny = s->ny[i], nz = s->nz[i];
    const REAL e = pux * pux + puy * puy + puz * puz, f = pux * pvx + puy * pvy + puz * pvz;
    const REAL g = pvx * pvx + pvy * pvy + pvz * pvz, det = e * g - f * f;
    const REAL lu = lx * pux + ly * puy + lz * puz, lv = lx * pvx + ly * pvy + lz * pvz;
    const REAL up = lx * nx + ly * ny + lz * nz;
    const REAL facing = s->bx[i] * nx + s->by[i] * ny + s->bz[i] * nz;
    if (!(facing > 0) || !(det > 0)) return 1;
    const WrHorizon *h = job->horizon;
    const REAL ru = (REAL)job->look_double.ru, rv = (REAL)job->look_double.rv;
    const REAL x = (g * lu - f * lv) / det * ru * (REAL)h->width;
    const REAL y = -(e * lv - f * lu) / det * rv * (REAL)h->height;
    const REAL far = (REAL)sqrt((double)(x * x + y * y)) * (REAL)job->relief_height;
    if (!(radius > 0) && up > far * (REAL)h->steepest) return 1; /* above the steepest of all */
    return share_above(up, far * horizon_at(h, x, y, ru * s->u[i], rv * s->v[i]), radius);
}

/* What the strip's samples see of a lamp; false: all of it, everywhere. */
static bool seen_of(const WrTileJob *job, const WR_T(WrKernLight) * light, const Strip *s,
                    REAL share[WR_SPAN])
{
    bool any = false;
    for (int i = 0; i < s->count; i++) {
        REAL l[3] = { light->where[0], light->where[1], light->where[2] };
        if (light->point) {
            const REAL d[3] = { l[0] - s->px[i], l[1] - s->py[i], l[2] - s->pz[i] };
            const REAL square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            const REAL inv = square > 0 ? 1 / (REAL)sqrt((double)square) : 0;
            for (int c = 0; c < 3; c++) l[c] = d[c] * inv;
        }
        share[i] = share_of(job, s, i, l[0], l[1], l[2], light->radius);
        any |= share[i] < 1;
    }
    return any;
}

/* The sums of the light so far, before a lamp adds to them. */
typedef struct Sums {
    REAL of[6][WR_SPAN];
} Sums;

static void keep_sums(const Strip *s, Sums *sums)
{
    const REAL *const from[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    for (int k = 0; k < 6; k++) memcpy(sums->of[k], from[k], (size_t)s->count * sizeof(REAL));
}

/* The lamp, which the strip has added, as far as it is seen. */
static void shadow_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, const Sums *before,
                         Strip *s, Watch *watch)
{
    REAL *const to[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    REAL share[WR_SPAN];
    const bool any = seen_of(job, light, s, share);
    for (int i = 0; i < s->count && any; i++)
        for (int k = 0; k < 6 && share[i] < 1; k++)
            to[k][i] = before->of[k][i] + share[i] * (to[k][i] - before->of[k][i]);
    did(watch, WR_EFFECT_SHADOW);
    watch_lap(watch, WR_STAGE_SHADOW);
}
