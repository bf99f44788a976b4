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

/* x - 1/2 of texels on an axis of n that repeats: the texel and its neighbour, and how far past it. */
static REAL texel_of(REAL x, int n, int out[2])
{
    const REAL at = (x - (REAL)floor((double)x)) * (REAL)n - (REAL)0.5;
    const int low = (int)floor((double)at);
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

/* Does the relief hide a lamp in direction l from the sample? Not where its back is seen: there the table is another. */
static bool is_hidden(const WrTileJob *job, const Strip *s, int i)
{
    const REAL *const l[3] = { s->lx, s->ly, s->lz }, *const n[3] = { s->nx, s->ny, s->nz };
    const REAL *const pu[3] = { s->pux, s->puy, s->puz }, *const pv[3] = { s->pvx, s->pvy, s->pvz };
    const REAL *const bent[3] = { s->bx, s->by, s->bz };
    REAL e = 0, f = 0, g = 0, lu = 0, lv = 0, up = 0, facing = 0;
    for (int c = 0; c < 3; c++) {
        e += pu[c][i] * pu[c][i], f += pu[c][i] * pv[c][i], g += pv[c][i] * pv[c][i];
        lu += l[c][i] * pu[c][i], lv += l[c][i] * pv[c][i];
        up += l[c][i] * n[c][i], facing += bent[c][i] * n[c][i];
    }
    const REAL det = e * g - f * f;
    if (!(facing > 0) || !(det > 0)) return false;
    const WrHorizon *h = job->horizon;
    const REAL ru = (REAL)job->look_double.ru, rv = (REAL)job->look_double.rv;
    const REAL x = (g * lu - f * lv) / det * ru * (REAL)h->width;
    const REAL y = -(e * lv - f * lu) / det * rv * (REAL)h->height;
    const REAL far = (REAL)sqrt((double)(x * x + y * y)) * (REAL)job->relief_height;
    if (up > far * (REAL)h->steepest) return false; /* above the steepest horizon of all */
    return up < far * horizon_at(h, x, y, ru * s->u[i], rv * s->v[i]);
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

/* The lamp whose direction the strip has added nothing where it is hidden. */
static void shadow_strip(const WrTileJob *job, const Sums *before, Strip *s, Watch *watch)
{
    REAL *const to[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    for (int i = 0; i < s->count; i++) {
        if (!is_hidden(job, s, i)) continue;
        for (int k = 0; k < 6; k++) to[k][i] = before->of[k][i];
    }
    did(watch, WR_EFFECT_SHADOW);
    watch_lap(watch, WR_STAGE_SHADOW);
}
