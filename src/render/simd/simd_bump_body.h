/* simd_bump_body.h - SIMD versions of n from Pu x Pv and of Blinn's n' for any frame (kern_bump_body.h). Part of
   simd_v3.c and simd_v4.c, after simd_newton_body.h and simd_sphere_body.h. */

/* n and |N| of Pu x Pv; false: at some sample N is not clearly longer than `noise`. */
static bool wide_cross(float noise, WrStrip *strip)
{
    const int count = strip->count;
    Wide least = w_all(FLT_MAX);
    for (int i = 0; i < count; i += WIDE) {
        const WideVec n = w_cross(W_LOAD3(strip, pu, i), W_LOAD3(strip, pv, i));
        const Wide nn = w_dot(n, n), inv = w_rsqrt(w_max(nn, w_all(1e-37f)));
        W_STORE3(strip, n, i, w_scale(n, inv));
        w_store(strip->n_len + i, nn * inv);
        least = w_min(least, w_among(w_first_bits(count - i), nn, least));
    }
    return -w_largest(w_all(0.0f) - least) > fmaxf(noise * noise, 1e-30f);
}

/* n' of N' = N + D, computed 2^30 times as long; on N's side. */
ALWAYS WideVec blinn_wide(WideVec pu, WideVec pv, WideVec n, Wide size, Wide fu, Wide fv)
{
    const Wide large = w_all(0x1p30f);
    const WideVec way = w_mad(w_scale(pv, large * fu), pu, w_all(-0x1p30f) * fv);
    const WideVec bent = w_mad(w_cross(n, way), n, large * size);
    return w_unit_or(bent, n);
}

ALWAYS Wide blinn_strip(const WrRays *rays, const bool near, WrStrip *strip)
{
    const WideVec viewer = w_alike(near ? rays->eye : rays->toward);
    const int count = strip->count;
    Wide most = w_all(0.0f);
    for (int i = 0; i < count; i += WIDE) {
        const WideVec n = W_LOAD3(strip, n, i), p = near ? W_LOAD3(strip, p, i) : viewer;
        const Wide fu = w_load(strip->fu + i), fv = w_load(strip->fv + i);
        const WideVec bent = blinn_wide(W_LOAD3(strip, pu, i), W_LOAD3(strip, pv, i), n,
                                        w_load(strip->n_len + i), fu, fv);
        const Wide ahead = w_dot(n, near ? w_sub(viewer, p) : viewer);
        const Wide side = w_pick(w_less(ahead, w_all(0.0f)), w_all(-1.0f), w_all(1.0f));
        W_STORE3(strip, b, i, w_scale(bent, side));
        most = w_max(most, w_among(w_first_bits(count - i), w_max(w_abs(fu), w_abs(fv)), most));
    }
    return most;
}

static bool wide_blinn(const WrRays *rays, WrStrip *strip)
{
    const Wide most =
        rays->perspective ? blinn_strip(rays, true, strip) : blinn_strip(rays, false, strip);
    return w_largest(most) <= GENTLE;
}
