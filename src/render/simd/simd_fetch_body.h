/* simd_fetch_body.h - SIMD fetches of slopes and colours from tables that are periodic in both directions, in
   the steps of kern_fetch_body.h: positions, four texels per sample, arithmetic. Part of simd_set_body.h. */

#define W_EACH _Pragma("omp simd")

/* x - floor(x) rounds to 1 for tiny negative x: that is the position 0 of the next period. */
ALWAYS float turned(float x)
{
    const float turn = x - floorf(x);
    return turn < 1.0f ? turn : 0.0f;
}

ALWAYS float held(float x)
{
    x = x < FLT_MAX ? x : FLT_MAX;
    return x > -FLT_MAX ? x : -FLT_MAX;
}

/* Layout of a table's texels.
   apron: texels beside the table that repeat its opposite edge, so that the right and lower neighbour need no
   wrap. */
typedef struct Texels {
    int width, height, pitch, apron;
    float ru, rv;
} Texels;

ALWAYS void place_texels(const Texels *of, const bool noted, WrStrip *strip)
{
    const int pitch = of->pitch, apron = of->apron, count = strip->count;
    const float W = (float)of->width, H = (float)of->height, ru = of->ru, rv = of->rv;
    W_EACH for (int k = 0; k < count; k++)
    {
        const float tu = turned(ru * strip->u[k]), tv = turned(rv * strip->v[k]);
        const float x = W * tu - 0.5f, y = H * (1.0f - tv) - 0.5f;
        const float i = floorf(x), j = floorf(y);
        if (noted) strip->tu[k] = tu, strip->tv[k] = tv;
        strip->at[k] = ((int)j + apron) * pitch + (int)i + apron;
        strip->ta[k] = x - i;
        strip->tb[k] = y - j;
    }
}

/* Loads two floats into lanes 0 and 1. */
ALWAYS __m128 w_two(const float *from)
{
    return _mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(const void *)from));
}

/* Heights of fewer bits and positions in double take the general loops. */
static bool looks_central(const WrLook *look)
{
    return look->periodic_u && look->periodic_v && !look->wide && !look->heights;
}

/* Bilinear central differences (theorem in kern_fetch_body.h), before they are scaled. */
ALWAYS void central_slopes(const WrLook *look, const bool noted, WrStrip *strip)
{
    const int count = strip->count;
    const ptrdiff_t row = 2 * (ptrdiff_t)look->pitch;
    const float *gradient = look->gradient;
    const Texels of = { look->width, look->height,    look->pitch,
                        WR_APRON,    (float)look->ru, (float)look->rv };
    place_texels(&of, noted, strip);
    /* Fu, Fv of the left texel, then of the right; two samples at once. */
    const __m256i each = _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1);
    for (int k = 0; k < count; k += 2) {
        const float *at = gradient + 2 * (ptrdiff_t)strip->at[k];
        const float *next = gradient + 2 * (ptrdiff_t)strip->at[k + 1 < count ? k + 1 : k];
        const __m256 top = _mm256_loadu2_m128(next, at),
                     low = _mm256_loadu2_m128(next + row, at + row);
        const __m256 b =
            _mm256_permutevar8x32_ps(_mm256_castps128_ps256(w_two(strip->tb + k)), each);
        _mm256_store_ps(strip->top + 4 * k, top + b * (low - top));
    }
    const float *restrict const column = strip->top;
    W_EACH for (int k = 0; k < count; k++)
    {
        const float fu = column[4 * k], fv = column[4 * k + 1], a = strip->ta[k];
        strip->fu[k] = fu + a * (column[4 * k + 2] - fu);
        strip->fv[k] = fv + a * (column[4 * k + 3] - fv);
    }
}

/* The copy holds dF/du of the table's cell; the scale adds height and replication, u = r u' (shade/slope.h). */
ALWAYS void scale_slopes(const WrLook *look, WrStrip *strip)
{
    const float scale_u = look->scale_u, scale_v = look->scale_v;
    const int count = strip->count;
    W_EACH for (int k = 0; k < count; k++)
    {
        strip->fu[k] = held(scale_u * strip->fu[k]);
        strip->fv[k] = held(scale_v * strip->fv[k]);
    }
}

static bool wide_central(const WrLook *look, bool noted, WrStrip *strip)
{
    if (!looks_central(look)) return false;
    if (noted) central_slopes(look, true, strip);
    else central_slopes(look, false, strip);
    scale_slopes(look, strip);
    return true;
}

/* C, with neighbouring texels loaded at once. */
static bool wide_colour(const WrColourLook *look, WrStrip *strip)
{
    const int count = strip->count;
    const ptrdiff_t row = 4 * (ptrdiff_t)look->pitch;
    if (!look->periodic_u || !look->periodic_v) return false;
    const Texels of = {
        look->width, look->height, look->pitch, 1, (float)look->ru, (float)look->rv
    };
    place_texels(&of, false, strip);
    for (int k = 0; k < count; k += 8) /* prefetches data that the next rows will probably read */
        _mm_prefetch((const char *)(look->rgba + 4 * (ptrdiff_t)strip->at[k] + 2 * row),
                     _MM_HINT_T0);
    for (int k = 0; k < count; k++) {
        const float *at = look->rgba + 4 * (ptrdiff_t)strip->at[k];
        const __m256 top = _mm256_loadu_ps(at), low = _mm256_loadu_ps(at + row);
        const __m256 both = top + _mm256_set1_ps(strip->tb[k]) * (low - top);
        const __m128 left = _mm256_castps256_ps128(both), right = _mm256_extractf128_ps(both, 1);
        _mm_store_ps(strip->top + 4 * k, left + _mm_set1_ps(strip->ta[k]) * (right - left));
    }
    const float *restrict const texel = strip->top;
    W_EACH for (int k = 0; k < count; k++)
    {
        strip->cr[k] = texel[4 * k];
        strip->cg[k] = texel[4 * k + 1];
        strip->cb[k] = texel[4 * k + 2];
    }
    return true;
}
