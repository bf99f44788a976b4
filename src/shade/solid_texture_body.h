/* solid_texture_body.h - solid texture patterns averaged over a pixel, in closed form, for both
   precisions and every kernel.

   Included after light_body.h. Only ?:, no branches. No include guard: compiled once per precision. The
   reference renderer has its own formulas. t is the pattern coordinate of a pixel's centre, w the
   extent of the pixel: the side of a box.

     pulse     1 in the last part d of each turn: at t, or as a mean over t - w/2 .. t + w/2
     wave      1/2 + 1/2 sin 2 pi t;  the mean has the factor sin(pi w) / (pi w) of the sine
     square    1 in even cells, -1 in odd ones; a checker's mean is 1/2 - 1/2 of their product along three axes
     ramp      t, within 0 and 1 */

#define GRAIN_MIN K_(1e-7) /* a smaller box is treated as a point */

R_INLINE REAL grain_clamp(REAL x)
{
    x = x > K_(0) ? x : K_(0);
    return x < K_(1) ? x : K_(1);
}

R_INLINE REAL grain_pulse(REAL t, REAL d)
{
    return t - r_floor(t) >= K_(1) - d ? K_(1) : K_(0);
}

/* The fraction of a box of side w about x that is above 0, with per = 1 / w: no cancellation (HC118). */
R_INLINE REAL grain_step(REAL x, REAL per)
{
    return grain_clamp(x * per + K_(0.5));
}

/* The pulse's integral from 0 to t. */
R_INLINE REAL grain_sum(REAL t, REAL d)
{
    const REAL whole = r_floor(t), rest = t - whole - (K_(1) - d);
    return whole * d + (rest > K_(0) ? rest : K_(0));
}

R_INLINE REAL grain_pulse_mean(REAL t, REAL w, REAL d)
{
    const REAL f = t - r_floor(t), half = K_(0.5) * w;
    const REAL per = K_(1) / (w > GRAIN_MIN ? w : GRAIN_MIN);
    /* up to one turn: the pulses that begin at -d, 1 - d and 2 - d */
    const REAL near = grain_step(f + d, per) - grain_step(f, per) +
                      grain_step(f - (K_(1) - d), per) - grain_step(f - K_(1), per) +
                      grain_step(f - (K_(2) - d), per);
    const REAL far = (grain_sum(f + half, d) - grain_sum(f - half, d)) * per;
    const REAL mean = w < K_(1) ? near : far;
    return w > GRAIN_MIN ? mean : grain_pulse(t, d);
}

/* The remaining amplitude of an averaged sine: sin(pi w) / (pi w). */
R_INLINE REAL grain_fading(REAL w)
{
    REAL sine, cosine;
    const REAL half = K_(0.5) * w, wide = w > K_(1e-3) ? w : K_(1e-3);
    r_sincos_turns(half - r_floor(half), &sine, &cosine);
    return w > K_(1e-3) ? sine / (K_(3.14159265358979323846) * wide) : K_(1);
}

R_INLINE REAL grain_square_mean(REAL x, REAL w)
{
    return K_(1) - K_(2) * grain_pulse_mean(K_(0.5) * x, K_(0.5) * w, K_(0.5));
}

/* The ramp's integral from 0; and its mean. */
R_INLINE REAL grain_ramp_sum(REAL t)
{
    const REAL in = grain_clamp(t), over = t - K_(1);
    return K_(0.5) * in * in + (over > K_(0) ? over : K_(0));
}

R_INLINE REAL grain_ramp_mean(REAL t, REAL w)
{
    const REAL wide = w > K_(1e-3) ? w : K_(1e-3), half = K_(0.5) * wide;
    const REAL mean = (grain_ramp_sum(t + half) - grain_ramp_sum(t - half)) / wide;
    return w > K_(1e-3) ? grain_clamp(mean) : grain_clamp(t);
}

#define GRAIN_GONE K_(10) /* of y: zero from there on */

/* Average weight of an octave's centre value in its pixel mean: the factor with the least squared
   error, so that no pixel is worse than one sample, nor noisier than the truth. y = c x^2 from the
   number of cells x in the pixel and the noise's correlation; 1 / (1 + y) is within 0.03 of that factor
   up to 3 cells of value noise, 2 of |Perlin noise|, measured. 0 from GRAIN_GONE on. */
R_INLINE REAL grain_left(REAL y)
{
    const REAL left = K_(1.1) / (K_(1) + y) - K_(0.1);
    return left > K_(0) ? left : K_(0);
}

/* grain_left for slopes, whose detail is as fine as with the square root of 3 times as many cells. */
R_INLINE REAL grain_left_slope(REAL y)
{
    return grain_left(K_(3) * y);
}

/* Fraction of an octave's variance within the pixel that its slope does not represent. */
R_INLINE REAL grain_within(REAL y)
{
    const REAL slope = grain_left_slope(y);
    const REAL all = K_(2) * y / (K_(1) + K_(2) * y), rest = all - K_(2) * y * slope * slope;
    return y < GRAIN_GONE ? rest > K_(0) ? rest : K_(0) : K_(1);
}
