/* occlusion_wide_body.h - the sweep of occlusion_kern.h for processors that hold eight lanes of 64 bits, part of
   occlusion_body.h's text: the same comparisons in whole numbers, so the same bits. What a row looks at is gathered as
   one number, and the two halves of the lanes stop by themselves.
   Layer 1, private to this room. A header without a guard, by intention. */

/* Half of the lanes: row * LANES + lane of what is looked at, and in the lower halves how much higher it is. */
typedef struct Half {
    __m512i at, rise;
} Half;

/* As step_on of what was seen from there; which lanes went on. here: row * LANES + lane of the row that looks. Distances
 * are LANES times too long on both sides, and below 2^25. */
ALWAYS __mmask8 half_step(Half *half, __m512i seen, __m512i low, __m512i here, int sign)
{
    const __m512i next = _mm512_srai_epi64(seen, 32), farther = _mm512_sub_epi32(seen, low);
    const __m512i a = _mm512_mul_epi32(farther, _mm512_sub_epi64(half->at, here));
    const __m512i b = _mm512_mul_epi32(half->rise, _mm512_sub_epi64(next, here));
    const __mmask8 go = sign > 0 ? _mm512_cmpgt_epi64_mask(a, b) : _mm512_cmpgt_epi64_mask(b, a);
    half->at = _mm512_mask_mov_epi64(half->at, go, next);
    half->rise = _mm512_mask_mov_epi64(half->rise, go, farther);
    return go;
}

ALWAYS void half_note(const Half *half, __m512i low, int64_t *seen)
{
    const __m512i top =
        _mm512_and_si512(_mm512_set1_epi64(0xffffffff), _mm512_add_epi64(low, half->rise));
    _mm512_storeu_si512(seen, _mm512_or_si512(_mm512_slli_epi64(half->at, 32), top));
}

ALWAYS void half_put(const Half *half, __m512i here, int sign, double scale, float *slope)
{
    const __m512i from = sign > 0 ? here : half->at, to = sign > 0 ? half->at : here;
    const __m512d rows =
        _mm512_mul_pd(_mm512_set1_pd(1.0 / LANES), _mm512_cvtepi64_pd(_mm512_sub_epi64(to, from)));
    const __m512d rise = _mm512_cvtepi32_pd(_mm512_cvtepi64_epi32(half->rise));
    const __m512d best = _mm512_mul_pd(
        _mm512_set1_pd(scale), _mm512_div_pd(rise, _mm512_max_pd(rows, _mm512_set1_pd(1.0))));
    _mm256_storeu_ps(slope, _mm512_cvtpd_ps(_mm512_max_pd(best, _mm512_setzero_pd())));
}

ALWAYS __m512i half_row(const int32_t *h)
{
    return _mm512_cvtepi32_epi64(_mm256_loadu_si256((const __m256i *)h));
}

ALWAYS __m512i half_place(int32_t row, int half)
{
    return _mm512_add_epi64(_mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7),
                            _mm512_set1_epi64((int64_t)row * LANES + half * 8));
}

ALWAYS void sweep_row(const WrSkySweep *w, int i, int sign, double scale, float *restrict slope)
{
    const int32_t s = w->rows[i], first = i > 0 ? w->rows[i - 1] : s;
    const int32_t *h = w->h + s * LANES, *high = w->h + first * LANES;
    const __m512i low[2] = { half_row(h), half_row(h + 8) };
    const __m512i here[2] = { half_place(s, 0), half_place(s, 1) };
    Half a = { half_place(first, 0), _mm512_sub_epi64(half_row(high), low[0]) };
    Half b = { half_place(first, 1), _mm512_sub_epi64(half_row(high + 8), low[1]) };
    const int64_t *seen = w->seen + first * LANES;
    __mmask8 on_a = 0, on_b = 0;
    if (i > 0) {
        on_a = half_step(&a, _mm512_loadu_si512(seen), low[0], here[0], sign);
        on_b = half_step(&b, _mm512_loadu_si512(seen + 8), low[1], here[1], sign);
    }
    while (on_a | on_b) {
        if (on_a)
            on_a = half_step(&a, _mm512_i64gather_epi64(a.at, w->seen, 8), low[0], here[0], sign);
        if (on_b)
            on_b = half_step(&b, _mm512_i64gather_epi64(b.at, w->seen, 8), low[1], here[1], sign);
    }
    half_note(&a, low[0], w->seen + s * LANES);
    half_note(&b, low[1], w->seen + s * LANES + 8);
    if (i < w->from) return;
    half_put(&a, here[0], sign, scale, slope + s * LANES);
    half_put(&b, here[1], sign, scale, slope + s * LANES + 8);
}

static void sweep(const WrSkySweep *given, double scale, float *restrict slope)
{
    const WrSkySweep w = *given;
    if (w.rows[0] > w.rows[w.count - 1])
        for (int i = 0; i < w.count; i++) sweep_row(&w, i, 1, scale, slope);
    else
        for (int i = 0; i < w.count; i++) sweep_row(&w, i, -1, scale, slope);
}
