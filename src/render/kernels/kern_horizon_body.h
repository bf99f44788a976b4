/* kern_horizon_body.h - visibility of a lamp above the table's horizon (field/horizon.h), and ambient occlusion.
   Part of kern_body.h.

   The surface is approximated by its tangent plane. l's part in it is a Pu + b Pv, so a step t towards the lamp
   is t (a, b) in u and v, and t n.l upwards. The lamp is hidden if F rises by more than n.l per t somewhere
   along the way. */

/* Fetch positions of a strip in the horizon pictures, where `asks` is set; elsewhere the share is known. */
typedef struct Skyline {
    int at[WR_SPAN];                    /* the texel up and left, in a picture */
    REAL right[WR_SPAN], down[WR_SPAN]; /* fractions past it */
    int first[WR_SPAN], next[WR_SPAN];  /* the two neighbouring directions */
    REAL turn[WR_SPAN];                 /* fraction between them */
    /* slope of the lamp, and the factor from table units per texel to it */
    REAL up[WR_SPAN], far[WR_SPAN];
    int asks[WR_SPAN];
    REAL tap[2][4 * WR_SPAN]; /* of both directions: upper row, lower row */
} Skyline;

/* Position of (x, y) among the table's directions: 0 <= at <= directions. */
ALWAYS REAL direction_of(REAL x, REAL y, REAL directions)
{
    const REAL wide = r_abs(x), high = r_abs(y);
    const bool upright = high > wide;
    const REAL side = upright ? (y > K_(0) ? K_(1) : K_(3)) : (x < K_(0) ? K_(2) : K_(0));
    const REAL along = upright ? y : x, across = upright ? -x : y;
    const REAL t = across / (along != K_(0) ? along : K_(1));
    const REAL at = (side + t * K_(0.5)) * directions * K_(0.25);
    return at < K_(0) ? at + directions : at;
}

/* x - 1/2 texels on a periodic axis of n texels, 0 <= result < n. */
ALWAYS REAL texel_of(REAL x, REAL n)
{
    const REAL at = (x - r_floor(x)) * n - K_(0.5);
    return at < K_(0) ? at + n : at;
}

ALWAYS void place_look(const SKYLINE *h, const STRIP *strip, int i, Skyline *to)
{
    const REAL x = texel_of(h->ru * strip->u[i], (REAL)h->width);
    const REAL y = texel_of(-(h->rv * strip->v[i]), (REAL)h->height);
    const REAL column = r_floor(x), row = r_floor(y);
    to->at[i] = among((int)row, h->height) * (h->width + 1) + among((int)column, h->width);
    to->right[i] = x - column;
    to->down[i] = y - row;
}

/* Position of the lamp above the sample's tangent plane, and its share if that is known without a fetch. */
ALWAYS void find_lamp(const SKYLINE *h, const LIGHT *light, const bool point, const bool round,
                      const STRIP *strip, int i, REAL *share, Skyline *to)
{
    const VEC where = { light->where[0], light->where[1], light->where[2] };
    const VEC pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i), n = LOAD3(strip, n, i);
    const VEC l = point ? light_toward(LOAD3(strip, p, i), where) : where;
    const REAL e = v_dot(pu, pu), f = v_dot(pu, pv), g = v_dot(pv, pv), det = e * g - f * f;
    const REAL lu = v_dot(l, pu), lv = v_dot(l, pv), up = v_dot(l, n);
    /* The horizons do not apply to back faces: their share is 1. */
    const bool faces = (v_dot(LOAD3(strip, b, i), n) > K_(0)) & (det > K_(0));
    const REAL inv = K_(1) / (faces ? det : K_(1));
    const REAL x = (g * lu - f * lv) * inv * (h->ru * (REAL)h->width);
    const REAL y = (f * lu - e * lv) * inv * (h->rv * (REAL)h->height);
    const REAL far = r_sqrt(x * x + y * y) * h->relief, directions = (REAL)h->directions;
    const REAL at = direction_of(x, y, directions), whole = r_floor(at);
    const int k = among((int)(whole < directions ? whole : K_(0)), h->directions);
    const bool above = !round & (up > far * h->steepest), under = !round & (up < K_(0));
    to->first[i] = k;
    to->next[i] = k + 1 < h->directions ? k + 1 : 0;
    to->turn[i] = at - whole;
    to->up[i] = up;
    to->far[i] = far;
    to->asks[i] = (faces & !above & !under) ? 1 : 0;
    share[i] = (faces & under) ? K_(0) : K_(1);
}

/* Two neighbouring texels of the upper and of the lower row. */
ALWAYS void copy_taps(const float *from, int pitch, REAL *tap)
{
    tap[0] = (REAL)from[0], tap[1] = (REAL)from[1];
    tap[2] = (REAL)from[pitch], tap[3] = (REAL)from[pitch + 1];
}

ALWAYS REAL mix_taps(const REAL *tap, REAL right, REAL down)
{
    const REAL high = tap[0] + right * (tap[1] - tap[0]);
    const REAL low = tap[2] + right * (tap[3] - tap[2]);
    return high + down * (low - high);
}

/* As wr_horizon_lamp: `up` is the slope of the lamp, `slope` that of the horizon, both per unit of the way
   towards the lamp. */
ALWAYS REAL share_above(REAL up, REAL slope, REAL radius)
{
    const REAL left = K_(1) - up * up, flat = r_sqrt(left > K_(0) ? left : K_(0));
    const REAL over = (r_atan2(up, flat) - r_atan2(slope, flat)) / radius;
    const REAL x = over > K_(-1) ? (over < K_(1) ? over : K_(1)) : K_(-1);
    const REAL y = r_sqrt(K_(1) - x * x);
    const REAL share = K_(0.5) + (x * y + r_atan2(x, y)) * K_(0.31830988618379067);
    return over >= K_(1) ? K_(1) : over <= K_(-1) ? K_(0) : share;
}

ALWAYS WrSeen see_lamp(const LIGHT *light, const SKYLINE *h, const bool point, const bool round,
                       const STRIP *strip, REAL *restrict share)
{
    const int count = strip->count;
    const size_t plane = ((size_t)h->width + 1) * ((size_t)h->height + 1);
    const REAL radius = (REAL)light->radius;
    Skyline to;
    int asks = 0, less = 0, some = 0;
    SIMD for (int i = 0; i < count; i++)
    {
        place_look(h, strip, i, &to);
    }
    SIMD_SUM(asks) for (int i = 0; i < count; i++)
    {
        find_lamp(h, light, point, round, strip, i, share, &to);
        asks += to.asks[i];
    }
    if (asks > 0) {
        for (int i = 0; i < count; i++) {
            /* unused fetches read a nearby address */
            const size_t at = to.asks[i] ? (size_t)to.at[i] : 0;
            const size_t first = to.asks[i] ? (size_t)to.first[i] * plane : 0;
            const size_t next = to.asks[i] ? (size_t)to.next[i] * plane : 0;
            copy_taps(h->slope + first + at, h->width + 1, to.tap[0] + 4 * i);
            copy_taps(h->slope + next + at, h->width + 1, to.tap[1] + 4 * i);
        }
        SIMD for (int i = 0; i < count; i++)
        {
            const REAL a = mix_taps(to.tap[0] + 4 * i, to.right[i], to.down[i]);
            const REAL b = mix_taps(to.tap[1] + 4 * i, to.right[i], to.down[i]);
            const REAL slope = to.far[i] * (a + to.turn[i] * (b - a)), up = to.up[i];
            const REAL hard = up < slope ? K_(0) : K_(1);
            const REAL seen = round ? share_above(up, slope, radius) : hard;
            share[i] = to.asks[i] ? seen : share[i];
        }
    }
    SIMD_SUM(less) for (int i = 0; i < count; i++)
    {
        less += share[i] < K_(1) ? 1 : 0;
    }
    SIMD_SUM(some) for (int i = 0; i < count; i++)
    {
        some += share[i] > K_(0) ? 1 : 0;
    }
    return less == 0 ? WR_SEEN_WHOLE : some == 0 ? WR_SEEN_NOT : WR_SEEN_PART;
}

FLAT static WrSeen kern_shadow(const LIGHT *light, const SKYLINE *h, const STRIP *strip,
                               REAL share[WR_SPAN])
{
    const bool round = light->radius > 0;
    if (light->point && round) return see_lamp(light, h, true, true, strip, share);
    if (light->point) return see_lamp(light, h, true, false, strip, share);
    if (round) return see_lamp(light, h, false, true, strip, share);
    return see_lamp(light, h, false, false, strip, share);
}

FLAT static void kern_open(const SKYLINE *h, const STRIP *strip, REAL share[WR_SPAN])
{
    const int count = strip->count;
    Skyline to;
    SIMD for (int i = 0; i < count; i++)
    {
        place_look(h, strip, i, &to);
    }
    for (int i = 0; i < count; i++) copy_taps(h->open + to.at[i], h->width + 1, to.tap[0] + 4 * i);
    SIMD for (int i = 0; i < count; i++)
    {
        share[i] = mix_taps(to.tap[0] + 4 * i, to.right[i], to.down[i]);
    }
}

FLAT static void kern_veil(const REAL share[WR_SPAN], const REAL *before, int count, REAL *to)
{
    if (!before) {
        SIMD for (int i = 0; i < count; i++)
        {
            to[i] = share[i] * to[i];
        }
        return;
    }
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL kept = before[i] + share[i] * (to[i] - before[i]);
        to[i] = share[i] < K_(1) ? kept : to[i];
    }
}
