/* occlusion_wide_body.h - the sweep of occlusion_kern.h for processors with eight lanes of 64 bits,
   included by occlusion_body.h.

   The same integer comparisons give the same bits. The candidate of a row is gathered as one number,
   and the two halves of the lanes stop independently.
   Private to this module.
   Intentionally without an include guard. */

/* Half of the lanes: row * LANES + lane of the candidate, its height difference in the lower half, and
 * the row that may be visible behind it. */
typedef struct Half {
    __m512i at, rise, next;
} Half;

/* STEEPER of the scalar code; returns the lanes that advanced. here: row * LANES + lane of the present
 * row. Distances are multiplied by LANES on both sides, and below 2^25. */
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

/* The first two steps, from known data; returns the lanes that advanced twice. */
ALWAYS __mmask8 half_known(Half *half, __m512i last, __m512i low, __m512i here, int sign)
{
    const __mmask8 went = half_step(half, last, low, here, sign);
    half->next = _mm512_mask_mov_epi64(last, went, half->next);
    if (!went) return 0;
    return went & half_step(half, half->next, low, here, sign);
}

/* The next step of those lanes. */
ALWAYS __mmask8 half_on(Half *half, __mmask8 on, const int64_t *seen, __m512i low, __m512i here,
                        int sign)
{
    half->next = _mm512_mask_i64gather_epi64(half->next, on, half->at, seen, 8);
    return on & half_step(half, half->next, low, here, sign);
}

ALWAYS void half_note(const Half *half, __m512i low, int64_t *seen)
{
    const __m512i top =
        _mm512_and_si512(_mm512_set1_epi64(0xffffffff), _mm512_add_epi64(low, half->rise));
    _mm512_storeu_si512(seen, _mm512_or_si512(_mm512_slli_epi64(half->at, 32), top));
}

ALWAYS __m512i both(__m512i a, __m512i b)
{
    return _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi64_epi32(a)),
                              _mm512_cvtepi64_epi32(b), 1);
}

ALWAYS void put_halves(const Half *a, const Half *b, int32_t s, int sign, float scale, float *slope)
{
    const __m512i at = _mm512_srai_epi32(both(a->at, b->at), 4), row = _mm512_set1_epi32(s);
    const __m512i away = sign > 0 ? _mm512_sub_epi32(at, row) : _mm512_sub_epi32(row, at);
    const __m512 rows = _mm512_max_ps(_mm512_cvtepi32_ps(away), _mm512_set1_ps(1));
    const __m512 rise = _mm512_cvtepi32_ps(both(a->rise, b->rise));
    const __m512 best = _mm512_mul_ps(_mm512_set1_ps(scale), _mm512_div_ps(rise, rows));
    _mm512_storeu_ps(slope, _mm512_max_ps(best, _mm512_setzero_ps()));
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

ALWAYS void sweep_row(const WrSkySweep *w, int i, int sign, float scale, Half *a, Half *b,
                      float *restrict slope)
{
    const int32_t s = w->rows[i], first = w->rows[i > 0 ? i - 1 : 0];
    const int32_t *h = w->h + s * LANES, *high = w->h + first * LANES;
    const __m512i low[2] = { half_row(h), half_row(h + 8) };
    const __m512i here[2] = { half_place(s, 0), half_place(s, 1) };
    const int64_t *seen = w->seen + first * LANES;
    a->at = half_place(first, 0), a->rise = _mm512_sub_epi64(half_row(high), low[0]);
    b->at = half_place(first, 1), b->rise = _mm512_sub_epi64(half_row(high + 8), low[1]);
    if (i > 0) {
        __mmask8 on_a = half_known(a, _mm512_loadu_si512(seen), low[0], here[0], sign);
        __mmask8 on_b = half_known(b, _mm512_loadu_si512(seen + 8), low[1], here[1], sign);
        while (on_a | on_b) {
            if (on_a) on_a = half_on(a, on_a, w->seen, low[0], here[0], sign);
            if (on_b) on_b = half_on(b, on_b, w->seen, low[1], here[1], sign);
        }
    }
    half_note(a, low[0], w->seen + s * LANES);
    half_note(b, low[1], w->seen + s * LANES + 8);
    if (i == 0) a->next = _mm512_loadu_si512(w->seen + s * LANES);
    if (i == 0) b->next = _mm512_loadu_si512(w->seen + s * LANES + 8);
    if (i >= w->from) put_halves(a, b, s, sign, scale, slope + s * LANES);
}

static void sweep(const WrSkySweep *given, double scale, float *restrict slope)
{
    const WrSkySweep w = *given;
    const float times = (float)scale;
    Half a = { .next = _mm512_setzero_si512() }, b = a; /* the first row has a known `next` */
    if (w.rows[0] > w.rows[w.count - 1])
        for (int i = 0; i < w.count; i++) sweep_row(&w, i, 1, times, &a, &b, slope);
    else
        for (int i = 0; i < w.count; i++) sweep_row(&w, i, -1, times, &a, &b, slope);
}
