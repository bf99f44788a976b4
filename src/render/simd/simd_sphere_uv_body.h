/* simd_sphere_uv_body.h - SIMD u and v of a sphere from n. Part of simd_set_body.h. */

/* The angle in turns from sine and cosine, both non-negative, by the smaller one times `by`; error up to 2e-7. */
ALWAYS Wide turns_of(Wide sine, Wide cosine, Wide by)
{
    const Wide s = w_min(sine, cosine) * by, w = s * s;
    const Wide high =
        w_all(0.00955011882f) + w * (w_all(-0.00352944806f) + w * w_all(0.0150733879f));
    const Wide a = s * (w_all(0.159154847f) +
                        w * (w_all(0.0265393257f) + w * (w_all(0.0116312345f) + w * high)));
    return w_pick(w_less(cosine, sine), w_all(0.25f) - a, a);
}

/* n contains all sines and cosines, except the distance from the axis. by: 1 / |n|. */
ALWAYS void put_parameters_of(WideVec n, Wide by, WrStrip *strip, int i)
{
    const Wide zero = w_all(0.0f), one = w_all(1.0f), half = w_all(0.5f);
    const Wide flat = n.x * n.x + n.y * n.y, inv = w_rsqrt(w_max(flat, w_all(1e-37f)));
    Wide u = turns_of(w_abs(n.y), w_abs(n.x), inv);
    u = w_pick(w_less(n.x, zero), half - u, u);
    u = w_pick(w_less(n.y, zero), one - u, u);
    const Wide a = turns_of(w_abs(n.z), flat * inv, by);
    w_store(strip->u + i, w_kept(w_less(u, one), u));
    w_store(strip->v + i, w_min(w_max(half + w_all(2.0f) * w_signed(a, n.z), zero), one));
}

static void put_parameters(WrStrip *strip)
{
    for (int i = 0; i < strip->count; i += WIDE)
        put_parameters_of(W_LOAD3(strip, n, i), w_all(1.0f), strip, i);
}
