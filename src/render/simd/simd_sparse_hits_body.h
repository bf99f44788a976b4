/* simd_sparse_hits_body.h - SIMD bicubic interpolation between sparse hits (sparse_hits.h). Part of simd_v3.c
   and simd_v4.c. */

/* Weights of the four hits in the cubic at t, in steps from the first. */
#define CUBIC_0(t) (-((t)-1) * ((t)-2) * ((t)-3) / 6)
#define CUBIC_1(t) ((t) * ((t)-2) * ((t)-3) / 2)
#define CUBIC_2(t) (-(t) * ((t)-1) * ((t)-3) / 2)
#define CUBIC_3(t) ((t) * ((t)-1) * ((t)-2) / 6)
#define EIGHTHS(f, a)                                                                              \
    f((a)), f((a) + 0.125f), f((a) + 0.25f), f((a) + 0.375f), f((a) + 0.5f), f((a) + 0.625f),      \
        f((a) + 0.75f), f((a) + 0.875f)
#define TWENTY_FOUR(f)                                                                             \
    {                                                                                              \
        EIGHTHS(f, 0.0f), EIGHTHS(f, 1.0f), EIGHTHS(f, 2.0f)                                       \
    }

_Alignas(32) static const float cubic[4][24] = { TWENTY_FOUR(CUBIC_0), TWENTY_FOUR(CUBIC_1),
                                                 TWENTY_FOUR(CUBIC_2), TWENTY_FOUR(CUBIC_3) };

/* Those weights for a block's rows, along x: the lanes of one block, or of two neighbouring blocks, which need
   five hits. */
#ifdef __AVX512DQ__
#define KNOTS_SEEN 5
#define NO_EIGHTHS 0, 0, 0, 0, 0, 0, 0, 0
_Alignas(64) static const
    float seen[KNOTS_SEEN][16] = { { EIGHTHS(CUBIC_0, 1.0f), NO_EIGHTHS },
                                   { EIGHTHS(CUBIC_1, 1.0f), EIGHTHS(CUBIC_0, 1.0f) },
                                   { EIGHTHS(CUBIC_2, 1.0f), EIGHTHS(CUBIC_1, 1.0f) },
                                   { EIGHTHS(CUBIC_3, 1.0f), EIGHTHS(CUBIC_2, 1.0f) },
                                   { NO_EIGHTHS, EIGHTHS(CUBIC_3, 1.0f) } };
#else
#define KNOTS_SEEN 4
_Alignas(32) static const float seen[KNOTS_SEEN][8] = { { EIGHTHS(CUBIC_0, 1.0f) },
                                                        { EIGHTHS(CUBIC_1, 1.0f) },
                                                        { EIGHTHS(CUBIC_2, 1.0f) },
                                                        { EIGHTHS(CUBIC_3, 1.0f) } };
#endif

#define KNOTS_ROW 48 /* size of a strip's samples, as whole vectors */

/* Sparse hits interpolated along y for one row of samples: one number per column. */
static void knots_of_row(const WrWideRow *row, int columns, float out[WR_KNOT_NUMBERS][KNOTS_ROW])
{
    const Wide w0 = w_all(cubic[0][8 + row->down]), w1 = w_all(cubic[1][8 + row->down]);
    const Wide w2 = w_all(cubic[2][8 + row->down]), w3 = w_all(cubic[3][8 + row->down]);
    const ptrdiff_t next = row->across;
    for (size_t k = 0; k < WR_KNOT_NUMBERS; k++) {
        const float *from = row->numbers + k * row->plane;
        for (int i = 0; i < columns; i += WIDE) {
            Wide a = w0 * w_load(from + i);
            a = w_fma(w1, w_load(from + next + i), a);
            a = w_fma(w2, w_load(from + 2 * next + i), a);
            w_store(out[k] + i, w_fma(w3, w_load(from + 3 * next + i), a));
        }
    }
}

/* A number at the samples from a column on. A sample's bits are the same in either half: the weights of foreign
   hits add 0. */
ALWAYS Wide number_from(const float *column)
{
    Wide a = w_load(seen[0]) * w_all(column[0]);
    for (int i = 1; i < KNOTS_SEEN; i++) a = w_fma(w_load(seen[i]), w_all(column[i]), a);
    return a;
}

static void wide_sheet_row(const WrWideRow *row, int count, int at, WrStrip *strip)
{
    float *const to[WR_KNOT_NUMBERS] = { strip->u,   strip->v,   strip->px,  strip->py,
                                         strip->pz,  strip->pux, strip->puy, strip->puz,
                                         strip->pvx, strip->pvy, strip->pvz };
    float own[WR_KNOT_NUMBERS][KNOTS_ROW], some[WIDE];
    const int end = row->skip + count;
    /* the hits with weight 0 must be numbers, too */
    knots_of_row(row, (end + 7) / 8 + KNOTS_SEEN, own);
    for (int i = 0; i < end; i += WIDE) {
        const int skip = i == 0 ? row->skip : 0, left = end - i < WIDE ? end - i : WIDE;
        const bool whole = skip == 0 && left == WIDE;
        for (int k = 0; k < WR_KNOT_NUMBERS; k++) {
            Wide a = number_from(own[k] + i / 8);
            if (k < 2) a = w_min(w_max(a, w_all(0.0f)), w_all(1.0f));
            float *out = to[k] + at + i - row->skip;
            if (whole) w_store(out, a);
            else {
                w_store(some, a);
                memcpy(out + skip, some + skip, (size_t)(left - skip) * sizeof *some);
            }
        }
    }
    for (int i = 0; i < count; i++) strip->x[at + i] = row->x + (float)i, strip->y[at + i] = row->y;
}

/* Difference of a hit from the first one, the shorter way round. */
ALWAYS float knot_from_first(float first, float knot, bool closed)
{
    const float d = knot - first;
    if (!closed) return d;
    return d > 0.5f ? d - 1.0f : d < -0.5f ? d + 1.0f : d;
}

ALWAYS __m256 within(__m256 a, bool closed)
{
    const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1.0f);
    if (!closed) return _mm256_min_ps(_mm256_max_ps(a, zero), one);
    const __m256 turn = a - _mm256_floor_ps(a);
    return _mm256_and_ps(turn, _mm256_cmp_ps(turn, one, _CMP_LT_OQ));
}

ALWAYS void between_knots(const float *knot, const WrWideKnots *how, const bool closed, float *out)
{
    const __m256 start = _mm256_set1_ps(knot[0]);
    const float *along = cubic[0] + 8 * how->column, *down = cubic[0] + 8 * how->row;
    __m256 row[4];
    for (int j = 0; j < 4; j++) {
        const float *from = knot + j * how->across;
        row[j] = _mm256_setzero_ps();
        for (int i = 0; i < 4; i++)
            row[j] =
                _mm256_fmadd_ps(_mm256_load_ps(along + 24 * i),
                                _mm256_set1_ps(knot_from_first(knot[0], from[i], closed)), row[j]);
    }
    for (int y = 0; y < 8; y++) {
        __m256 a = start;
        for (int j = 0; j < 4; j++)
            a = _mm256_fmadd_ps(_mm256_set1_ps(down[24 * j + y]), row[j], a);
        _mm256_storeu_ps(out + y * how->pitch, within(a, closed));
    }
}

static void wide_between(const float *knot, const WrWideKnots *how, bool closed, float *out)
{
    if (closed) between_knots(knot, how, true, out);
    else between_knots(knot, how, false, out);
}
