/* kern_environment_body.h - environment light on strips. Part of kern_body.h; the formulas are in
   shade/environment_map_body.h. */

ALWAYS void surround_strip(const SURROUND *how, const bool turns, const int shares, STRIP *strip)
{
    const SURROUND s = *how;
    const REAL own_r = s.kd * s.colour[0], own_g = s.kd * s.colour[1], own_b = s.kd * s.colour[2];
    const REAL even_r = reflect_positive(s.form[0][0]), even_g = reflect_positive(s.form[1][0]),
               even_b = reflect_positive(s.form[2][0]);
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC n = LOAD3(strip, b, i);
        const REAL x = shares ? surround_root(n, LOAD3(strip, v, i)) : K_(1);
        const REAL matt = shares ? s.kd * surround_share(s.matt, x) : s.kd;
        const REAL again = shares > 1 ? s.kd * surround_share(s.again, x) : K_(0);
        REAL r = matt, g = matt, b = matt;
        if (shares > 1) {
            r += again * reflect_kept(own_r * strip->cr[i], s.mean);
            g += again * reflect_kept(own_g * strip->cg[i], s.mean);
            b += again * reflect_kept(own_b * strip->cb[i], s.mean);
        }
        strip->dr[i] += r * (turns ? surround_light(s.form[0], n) : even_r);
        strip->dg[i] += g * (turns ? surround_light(s.form[1], n) : even_g);
        strip->db[i] += b * (turns ? surround_light(s.form[2], n) : even_b);
    }
}

#define SURROUND_ROW(turns, shares)                                                                \
    FLAT static void kern_surround_##turns##shares(const SURROUND *how, STRIP *strip)              \
    {                                                                                              \
        surround_strip(how, turns, shares, strip);                                                 \
    }
SURROUND_ROW(0, 0)
SURROUND_ROW(0, 1)
SURROUND_ROW(0, 2)
SURROUND_ROW(1, 0)
SURROUND_ROW(1, 1)
SURROUND_ROW(1, 2)

/* low for NaN */
ALWAYS REAL between(REAL x, REAL low, REAL high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* First tap and fractions in the picture for the mirrored directions. */
ALWAYS void find_mirrored(const MIRROR *how, STRIP *strip)
{
    const MIRROR m = *how;
    const REAL W = (REAL)m.width, H = (REAL)m.height;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC r = surround_mirrored(LOAD3(strip, b, i), LOAD3(strip, v, i));
        const VEC d = { m.axes[0] * r.x + m.axes[1] * r.y + m.axes[2] * r.z,
                        m.axes[3] * r.x + m.axes[4] * r.y + m.axes[5] * r.z,
                        m.axes[6] * r.x + m.axes[7] * r.y + m.axes[8] * r.z };
        const REAL round = r_atan2_turns(d.x, -d.z), u = round < K_(0.5) ? round : round - K_(1);
        const REAL up = r_atan2_turns(d.y, r_sqrt(d.x * d.x + d.z * d.z));
        const REAL v = up < K_(0.5) ? up : up - K_(1);
        /* stays inside the picture even with rounding errors or NaN */
        const REAL x = between(W * (u + K_(0.5)) - K_(0.5), K_(-0.5), W - K_(0.5));
        const REAL y = between(H * (K_(0.5) - K_(2) * v) - K_(0.5), K_(-0.5), H - K_(0.5));
        const REAL a = r_floor(x), b = r_floor(y);
        strip->at[i] = (int)b * m.pitch + (int)a;
        strip->ta[i] = x - a;
        strip->tb[i] = y - b;
    }
}

ALWAYS void add_mirrored(const MIRROR *how, const bool even, STRIP *strip)
{
    const MIRROR m = *how;
    const REAL *restrict const texel = strip->top;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL x = surround_root(LOAD3(strip, b, i), LOAD3(strip, v, i));
        const REAL own = m.strength * surround_share(m.own, x);
        const REAL white = m.strength * surround_share(m.white, x);
        const REAL r = even ? m.even[0] : texel[4 * i], g = even ? m.even[1] : texel[4 * i + 1];
        const REAL b = even ? m.even[2] : texel[4 * i + 2];
        strip->dr[i] += own * r, strip->dg[i] += own * g, strip->db[i] += own * b;
        strip->sr[i] += white * r, strip->sg[i] += white * g, strip->sb[i] += white * b;
    }
}

FLAT static void kern_mirror(const MIRROR *how, STRIP *strip)
{
    find_mirrored(how, strip);
    mix_texels(how->rgba, how->pitch, strip);
    add_mirrored(how, false, strip);
}

FLAT static void kern_mirror_even(const MIRROR *how, STRIP *strip)
{
    add_mirrored(how, true, strip);
}
