/* occlusion_body.h - implementation of the loops of occlusion_kern.h, compiled once for each instruction
   set (wr_kern of CMakeLists.txt). Intentionally without an include guard. */
#include "field/occlusion_kern.h"

#include <math.h>
#include <string.h>
#ifdef __AVX512DQ__
#include <immintrin.h>
#endif

#define LANES WR_SKY_LANES
#define AHEAD 8 /* rows compared together */
#define STEEPEST 0x1p20f
#define ALWAYS static inline __attribute__((always_inline))

/* True if any lane is nonzero. A reduction inside the loops that fill the lanes would prevent
 * vectorisation. */
ALWAYS bool any(const int32_t *restrict lane)
{
    uint64_t pair[LANES / 2];
    memcpy(pair, lane, sizeof pair);
    return ((pair[0] | pair[1]) | (pair[2] | pair[3])) |
           ((pair[4] | pair[5]) | (pair[6] | pair[7]));
}

#ifdef __AVX512DQ__
/* ---- the sweep for processors with eight lanes of 64 bits ---- */

/* The same integer comparisons give the same bits. The candidate of a row is gathered as one number,
   and the two halves of the lanes stop independently. */

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
#else
/* Horizon candidate of each lane of row s: the row, its height difference, and the row that may be
 * visible behind it (with its height in the lower half). */
typedef struct Candidate {
    int32_t at[LANES];
    double rise[LANES];
    int64_t next[LANES];
} Candidate;

/* Compares the slope to the point in `seen` with that to lane l's candidate; if it is steeper, it
 * becomes the candidate. */
#define STEEPER(l)                                                                                 \
    const int32_t c = candidate->at[l], n = (int32_t)(seen >> 32);                                 \
    const double farther = (double)((int32_t)seen - low[l]);                                       \
    const int go =                                                                                 \
        farther * (double)(sign * (c - s)) > candidate->rise[l] * (double)(sign * (n - s));        \
    candidate->at[l] = go ? n : c;                                                                 \
    candidate->rise[l] = go ? farther : candidate->rise[l]

/* One step of the active lanes; true if any lane advanced. `next` is undefined in lanes that have
 * stopped. */
ALWAYS bool step_on(const int32_t *restrict low, const int64_t *restrict memory, int32_t s,
                    int32_t sign, Candidate *restrict candidate, int32_t *restrict on)
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int64_t seen = on[l] ? memory[candidate->at[l] * LANES + l] : candidate->next[l];
        STEEPER(l);
        candidate->next[l] = seen;
        on[l] &= go;
    }
    return any(on);
}

/* The first two steps, whose data is known from the previous row: its final candidate, and the row
 * visible behind that. */
ALWAYS bool step_known(const int32_t *restrict low, const int64_t *restrict last, int32_t s,
                       int32_t sign, Candidate *restrict candidate, int32_t *restrict on)
{
    int32_t went[LANES];
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int64_t seen = last[l];
        STEEPER(l);
        candidate->next[l] = go ? candidate->next[l] : seen;
        went[l] = go;
    }
    if (!any(went)) return false;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int64_t seen = candidate->next[l];
        STEEPER(l);
        on[l] = went[l] & go;
    }
    return any(on);
}

ALWAYS void note(const int32_t *restrict low, const Candidate *restrict candidate,
                 int64_t *restrict seen)
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        seen[l] =
            (int64_t)candidate->at[l] << 32 | (uint32_t)(low[l] + (int32_t)candidate->rise[l]);
    }
}

ALWAYS void put_slopes(const Candidate *restrict candidate, int32_t s, int32_t sign, float scale,
                       float *restrict slope)
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int32_t away = sign * (candidate->at[l] - s);
        const float best = scale * ((float)(int32_t)candidate->rise[l] / (float)(away ? away : 1));
        slope[l] = best > 0 ? best : 0;
    }
}

/* Processes row rows[i]; `last` of the previous row is known. */
ALWAYS void sweep_row(const WrSkySweep *w, int i, int32_t sign, float scale,
                      Candidate *restrict candidate, float *restrict slope)
{
    const int32_t s = w->rows[i], first = w->rows[i > 0 ? i - 1 : 0];
    const int32_t *low = w->h + s * LANES, *high = w->h + first * LANES;
    int32_t on[LANES];
    for (int l = 0; l < LANES; l++)
        candidate->at[l] = first, candidate->rise[l] = (double)(high[l] - low[l]);
    if (i == 0) {
        for (int l = 0; l < LANES; l++) candidate->next[l] = (int64_t)s << 32 | (uint32_t)low[l];
    } else if (step_known(low, w->seen + first * LANES, s, sign, candidate, on)) {
        while (step_on(low, w->seen, s, sign, candidate, on)) {
        }
    }
    note(low, candidate, w->seen + s * LANES);
    if (i >= w->from) put_slopes(candidate, s, sign, scale, slope + s * LANES);
}

static void sweep(const WrSkySweep *given, double scale, float *restrict slope)
{
    const WrSkySweep w = *given;
    const int32_t sign = w.rows[0] > w.rows[w.count - 1] ? 1 : -1;
    Candidate candidate;
    for (int i = 0; i < w.count; i++) sweep_row(&w, i, sign, (float)scale, &candidate, slope);
}
#undef STEEPER

#endif

ALWAYS bool passes(const int32_t *restrict row, const int32_t *restrict highest)
{
    int32_t over[LANES];
#pragma omp simd
    for (int l = 0; l < LANES; l++) over[l] = row[l] > highest[l];
    return any(over);
}

/* The highest of AHEAD rows. */
ALWAYS void crest(const int32_t *restrict h, ptrdiff_t step, int32_t *restrict top)
{
    int32_t most[LANES];
    memcpy(most, h, sizeof most);
    for (int k = 1; k < AHEAD; k++) {
#pragma omp simd
        for (int l = 0; l < LANES; l++)
            most[l] = h[k * step + l] > most[l] ? h[k * step + l] : most[l];
    }
    memcpy(top, most, sizeof most);
}

static int higher(const int32_t *h, int sign, int from, int count, int32_t *restrict highest)
{
    const ptrdiff_t step = sign * LANES;
    int32_t top[LANES];
    int k = from;
    while (k + AHEAD <= count) {
        crest(h + k * step, step, top);
        if (passes(top, highest)) break;
        k += AHEAD;
    }
    while (k < count && !passes(h + k * step, highest)) k++;
    if (k == count) return count;
    const int32_t *restrict row = h + k * step;
#pragma omp simd
    for (int l = 0; l < LANES; l++) highest[l] = row[l] > highest[l] ? row[l] : highest[l];
    return k;
}

/* The arc tangent of 0..1 by the first terms of its Chebyshev series; error 4e-8. */
ALWAYS float atan_small(float t)
{
    const float y = t * t;
    float sum = -0.00396025723f;
    sum = sum * y + 0.0215092542f;
    sum = sum * y - 0.0553816979f;
    sum = sum * y + 0.096016564f;
    sum = sum * y - 0.138920412f;
    sum = sum * y + 0.199430812f;
    sum = sum * y - 0.33329538f;
    sum = sum * y + 0.999999249f;
    return sum * t;
}

/* The effective horizon slope in a direction in which the plane rises by s. Beyond STEEPEST all are
 * equal: a wall. */
ALWAYS float horizon_of(float level, float horizon, float s)
{
    float h = horizon > level ? horizon : level;
    h = 2 * (h - level) < horizon ? 2 * (h - level) : horizon;
    h = h > s ? h : s;
    return h < STEEPEST ? h : STEEPEST;
}

/* Sky fraction lost in one direction, in which the plane rises by s, and in its opposite, by the
 * formula of wr_horizon_sky, over n_z; without terms that cancel over all directions. With a = 1 + h^2
 * and b = 1 + k^2 of both horizons it is
 *
 *   h (h - s) / a + k (k + s) / b + s (acot h - acot k),
 *
 * whose last bracket is the arc tangent of (k - h) / (1 + h k). One division serves all terms. */
ALWAYS float taken(float level, float ahead, float behind, float s)
{
    const float h = horizon_of(level, ahead, s), k = horizon_of(level, behind, -s);
    const float a = 1 + h * h, b = 1 + k * k, ab = a * b;
    const float num = h * (h - s) * b + k * (k + s) * a;
    const float over = k > h ? k - h : h - k, under = 1 + h * k;
    const int wide = over > under;
    const float x = wide ? under : over, y = wide ? over : under;
    const float inverse = 1.0f / (ab * y);
    const float small = atan_small(x * ab * inverse);
    const float angle = wide ? 1.57079637f - small : small;
    return num * y * inverse + s * (k > h ? angle : -angle);
}

/* `count` adjacent texels. */
ALWAYS void share_run(const WrSkyShare k, const WrSkyRun *run, int count, float *restrict loss)
{
    const float *restrict ahead = run->ahead, *restrict behind = run->behind;
    const float *restrict p = run->p, *restrict q = run->q;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const float s = p[i] * k.ux + q[i] * k.uy;
        loss[i] = k.weight * taken(k.level, ahead[i], behind[i], s);
    }
}

ALWAYS void add_run(const WrSkyShare *k, const float *restrict loss, int count, float *restrict out)
{
    if (k->first)
        for (int i = 0; i < count; i++) out[i] = loss[i];
    else
#pragma omp simd
        for (int i = 0; i < count; i++) out[i] += loss[i];
}

/* The remaining sky fraction after all directions. */
ALWAYS void finish_run(const WrSkyRun *run, int count, float *restrict out)
{
    const float *restrict p = run->p, *restrict q = run->q;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const float seen = (1.0f - out[i]) / sqrtf(1.0f + p[i] * p[i] + q[i] * q[i]);
        const float more = seen > 0 ? seen : 0;
        out[i] = more < 1.0f ? more : 1.0f;
    }
}

/* All reads come before all writes: rows of large tables are a multiple of 4096 bytes apart, where a
 * load would wait for every earlier store. */
static void share(const WrSkyShare *given, const WrSkyRun *runs, int count)
{
    float loss[WR_SKY_STRIP];
    const WrSkyShare k = *given;
    for (int r = 0, at = 0; r < count; at += runs[r++].count) {
        if (runs[r].count == LANES) share_run(k, &runs[r], LANES, loss + at);
        else share_run(k, &runs[r], runs[r].count, loss + at);
    }
    for (int r = 0, at = 0; r < count; at += runs[r++].count) {
        if (runs[r].count == LANES) add_run(&k, loss + at, LANES, runs[r].loss);
        else add_run(&k, loss + at, runs[r].count, runs[r].loss);
        if (k.last) finish_run(&runs[r], runs[r].count, runs[r].loss);
    }
}

static void look(const float *restrict c, const float *a, const float *b, float part, float inverse,
                 int count, float *restrict best)
{
    if (part == 0.0f) {
#pragma omp simd
        for (int i = 0; i < count; i++) {
            const float slope = (a[i] - c[i]) * inverse;
            best[i] = slope > best[i] ? slope : best[i];
        }
        return;
    }
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const float slope = (a[i] + part * (b[i] - a[i]) - c[i]) * inverse;
        best[i] = slope > best[i] ? slope : best[i];
    }
}

const WrSkyKernels WR_SET_TABLE = {
    .name = WR_SET_NAME,
    .sweep = sweep,
    .higher = higher,
    .share = share,
    .look = look,
};

#undef LANES
#undef ALWAYS
