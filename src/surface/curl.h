/* curl.h - the unit square with its corner rolled up, without stretching, round a cylinder of
   radius R past the line u + v = q.

     sigma = (u + v)/sqrt 2,  tau = (v - u)/sqrt 2,  alpha = max(0, (sigma - q/sqrt 2) / R)
     sigma' = sigma where alpha = 0, else q/sqrt 2 + R sin alpha
     P = ((sigma' - tau)/sqrt 2, (sigma' + tau)/sqrt 2, R (1 - cos alpha))

   An isometry: Pu.Pu = Pv.Pv = 1, Pu.Pv = 0, |N| = 1. The curvature jumps at the line, where the
   second derivatives are those of the flat side. */

R_INLINE void FN(curl_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL h = K_(0.70710678118654752440);        /* 1 / sqrt 2 */
    const REAL per_turn = K_(0.15915494309189533577); /* 1 / (2 pi) */
    REAL radius = s->value[0], line = s->value[1] * h;
    REAL sigma = (u + v) * h, past = sigma - line;
    REAL alpha = past > K_(0) ? past / radius : K_(0);
    REAL S, C;
    r_sincos_turns(alpha * per_turn, &S, &C);
    REAL rolled = past > K_(0) ? line + radius * S : sigma;
    /* (sigma' -+ tau)/sqrt 2 = u and v, minus the shortening of sigma by rolling: exact on the flat
       side. */
    REAL taken = past > K_(0) ? (sigma - rolled) * h : K_(0);
    o->p = (VEC){ u - taken, v - taken, radius * (K_(1) - C) };
    o->pu = (VEC){ K_(0.5) * (C + K_(1)), K_(0.5) * (C - K_(1)), h * S };
    o->pv = (VEC){ o->pu.y, o->pu.x, h * S };
    REAL k = past > K_(0) ? K_(1) / radius : K_(0);
    REAL half = K_(0.5) * k;
    o->puu = o->puv = o->pvv = (VEC){ -half * h * S, -half * h * S, half * C };
    o->n = o->n_unit = (VEC){ -h * S, -h * S, C };
    o->n_len = K_(1);
    o->n_u = o->n_v = (VEC){ -half * C, -half * C, -k * h * S };
}

#ifndef WR_FORMULA_FLOAT
static const WrSurfaceInfo curl_row = {
    .name = "curl",
    .label = "Curled corner",
    .help = "the unit square, its upper right corner rolled up without stretching",
    .params = { { "R", 1, { 0.15 }, 0.01, 1e6, false, "radius of the roll" },
                { "q", 1, { 1.2 }, 0, 2, false, "rolled where u + v > q" } },
    .pose_deg = { -20, 15, 0 },
    .centre = { 0.5, 0.5, 0 },
    .open = true,
    .faces = 1,
    .unit_sized = true,
    .inversion = WR_INVERT_MESH,
    .at = curl_at_d,
};
#endif
