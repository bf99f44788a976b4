/* simd_sphere_slope_filter_body.h - SIMD slopes of a sphere filtered over each pixel's footprint, with one isotropic fetch as
   in kern_filter_body.h. Part of simd_set_body.h.

   Footprints are those of kern_filter_body.h, simplified for a sphere: Pu and Pv are perpendicular, 2 pi flat
   and pi long, flat = nx^2 + ny^2. For most pixels a cheaper test shows that they are below a texel: a step of
   the pixel, w, is at most |w| / (n.v) along the surface, in either direction. */

#define TURN_LONG 0.159154943f /* 1 / 2 pi */
#define HALF_LONG 0.318309886f /* 1 / pi */

/* The steps of a pixel, in radii, and values shared by a row's footprints. */
typedef struct Prints {
    WideVec qx, dx, qy, dy, eye; /* eye: or the direction towards it */
    Wide a, b;                   /* squares of texels along u and v: a / flat, b */
    Wide step, away;             /* largest |w|^2; 1 + |eye|^2 */
    Wide last;
} Prints;

static float square_of(const float v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static Prints prints_of(const WrRays *rays, const WrShapef *shape, const WrLook *look)
{
    const float by = 1.0f / shape->value[0], *toward = rays->perspective ? rays->eye : rays->toward;
    const float u = TURN_LONG * (float)look->width * (float)look->ru;
    const float v = HALF_LONG * (float)look->height * (float)look->rv;
    const float x = square_of(rays->perspective ? rays->dx : rays->qx);
    const float y = square_of(rays->perspective ? rays->dy : rays->qy);
    const Wide in = w_all(by), near = rays->perspective ? in : w_all(1.0f);
    Prints p = { w_scale(w_alike(rays->qx), in),
                 w_scale(w_alike(rays->dx), in),
                 w_scale(w_alike(rays->qy), in),
                 w_scale(w_alike(rays->dy), in),
                 w_scale(w_alike(toward), near),
                 w_all(u * u),
                 w_all(v * v),
                 w_all(by * by * (x > y ? x : y)),
                 w_all(1.0f),
                 w_all((float)(look->pyramid->levels - 1)) };
    p.away = w_dot(p.eye, p.eye) + w_all(1.0f);
    return p;
}

/* Lanes whose footprint may be larger than a texel. */
ALWAYS WideMask may_be_wide(const Prints *p, const bool near, WideVec n, Wide flat, Wide inv)
{
    const Wide e = w_dot(n, p->eye), texels = p->step * w_max(p->a, p->b * flat);
    if (!near) return w_less(w_all(0.999f) * e * e * flat, texels);
    /* |w| is the distance to the eye times |dx| / |d|; n.v is (n.eye - 1) divided by that distance. */
    const Wide way = (p->away - e - e) * inv, facing = w_max(e - w_all(1.0f), w_all(0.0f));
    return w_less(w_all(0.999f) * facing * facing * flat, way * way * texels);
}

/* Squared length of a step in texels; s: of the ray; d_by_dn: d / (n.d). */
ALWAYS Wide texels_of(const Prints *p, WideVec q, WideVec d, WideVec n, Wide s, WideVec d_by_dn,
                      Wide inv_flat)
{
    const WideVec w = w_mad(q, d, s), a = w_mad(w, d_by_dn, -w_dot(n, w));
    const Wide round = a.y * n.x - a.x * n.y;
    return (p->a * (round * round) * inv_flat + p->b * (a.z * a.z)) * inv_flat;
}

/* Squared length of the longer side, texels. */
ALWAYS Wide longer_of(const Prints *p, const RowRays *row, Wide x, WideVec n, Wide flat, Wide inv)
{
    const WideVec q = w_mad(row->q, row->qx, x), d = w_mad(row->d, row->dx, x);
    const Wide toward = w_dot(n, d), s = (toward - w_dot(q, d)) * inv * inv;
    const Wide dn = w_min(toward, w_all(-1e-6f) * w_reciprocal(inv));
    const WideVec d_by_dn = w_scale(d, w_reciprocal(dn));
    const Wide inv_flat = w_reciprocal(w_max(flat, w_all(1e-30f)));
    const Wide r = texels_of(p, p->qx, p->dx, n, s, d_by_dn, inv_flat);
    const Wide w = texels_of(p, p->qy, p->dy, n, s, d_by_dn, inv_flat);
    return w_min(w_max(w_max(r, w), w_all(1.0f)), w_all(1e30f));
}

/* Stores the levels of WIDE samples; returns the number above level 0. */
ALWAYS int put_levels(Wide longer, Wide last, unsigned of, float *level)
{
    _Alignas(64) float square[WIDE];
    w_store(square, longer);
    W_EACH for (int k = 0; k < WIDE; k++) level[k] = 0.5f * wr_log2_f(square[k]);
    const Wide at = w_min(w_load(level), last);
    w_store(level, at);
    return __builtin_popcount(w_bits(w_less(w_all(0.0f), at)) & of);
}

ALWAYS int footprints(const Prints *p, const RowRays *row, const bool near, float gx,
                      WrStrip *strip)
{
    const int count = strip->count, first = strip->index[0];
    int wide = 0;
    for (int i = 0; i < count; i += WIDE) {
        const WideVec n = W_LOAD3(strip, n, i);
        const Wide inv = w_load(strip->s + i), flat = n.x * n.x + n.y * n.y;
        const unsigned of = w_first_bits(count - i);
        w_store(strip->level + i, w_all(0.0f));
        if (!(w_bits(may_be_wide(p, near, n, flat, inv)) & of)) continue;
        const Wide longer = longer_of(p, row, row_places(gx, first + i), n, flat, inv);
        wide += put_levels(longer, p->last, of, strip->level + i);
    }
    return wide;
}

static int wide_footprint(const WrRays *rays, const WrShapef *shape, const WrLook *look, float gx,
                          float gy, WrStrip *strip)
{
    const Prints p = prints_of(rays, shape, look);
    const RowRays row = row_rays(rays, shape, gy);
    return rays->perspective ? footprints(&p, &row, true, gx, strip)
                             : footprints(&p, &row, false, gx, strip);
}

/* ---- the pyramid ---- */

static bool wide_filters(const WrLook *look)
{
    return looks_central(look) && look->reach == 0.0f && look->pyramid &&
           look->pyramid->kind == WR_PYRAMID_SLOPES;
}

/* For each level: texels across, down and per row. */
typedef struct Levels {
    float width[WR_PYRAMID_LEVELS], height[WR_PYRAMID_LEVELS];
    int pitch[WR_PYRAMID_LEVELS];
} Levels;

/* Fetch positions of WIDE samples: in the lower level and in the next. */
typedef struct Places {
    _Alignas(64) int level[2][WIDE];
    _Alignas(64) int at[2][WIDE];
    _Alignas(64) float a[2][WIDE];
    _Alignas(64) float b[2][WIDE];
    _Alignas(64) float part[WIDE];
} Places;

ALWAYS void place_far(const Levels *of, int last, const WrStrip *strip, int i, Places *to)
{
    for (int n = 0; n < 2; n++) W_EACH for (int k = 0; k < WIDE; k++)
        {
            const int whole = (int)strip->level[i + k], low = (whole > 1 ? whole : 1) + n;
            const int l = low < last ? low : last;
            const float x = of->width[l] * strip->tu[i + k] - 0.5f;
            const float y = of->height[l] * (1.0f - strip->tv[i + k]) - 0.5f;
            const float across = floorf(x), down = floorf(y);
            to->level[n][k] = l;
            to->at[n][k] = ((int)down + 1) * of->pitch[l] + (int)across + 1;
            to->a[n][k] = x - across;
            to->b[n][k] = y - down;
            if (n == 0) to->part[k] = strip->level[i + k] - (float)low;
        }
}

/* Fu, Fv of one level. */
ALWAYS __m128 far_texel(const WrPyramid *pyramid, const Places *places, int n, int k)
{
    const WrPyramidLevel *level = &pyramid->level[places->level[n][k]];
    const float *at = level->data + 4 * (ptrdiff_t)places->at[n][k];
    const __m256 top = _mm256_loadu_ps(at);
    const __m256 low = _mm256_loadu_ps(at + 4 * (ptrdiff_t)level->pitch);
    const __m256 both = top + _mm256_set1_ps(places->b[n][k]) * (low - top);
    const __m128 left = _mm256_castps256_ps128(both), right = _mm256_extractf128_ps(both, 1);
    return left + _mm_set1_ps(places->a[n][k]) * (right - left);
}

/* Means for the lanes of a vector that are above level 0, into far, 4 numbers per sample. */
ALWAYS void look_far(const WrPyramid *pyramid, const Levels *of, const WrStrip *strip, int i,
                     int count, float *far)
{
    Places places;
    place_far(of, pyramid->levels - 1, strip, i, &places);
    for (int k = 0; k < WIDE && i + k < count; k++) {
        if (!(strip->level[i + k] > 0.0f)) continue;
        __m128 mean = far_texel(pyramid, &places, 0, k);
        if (places.part[k] > 0.0f)
            mean += _mm_set1_ps(places.part[k]) * (far_texel(pyramid, &places, 1, k) - mean);
        _mm_store_ps(far + 4 * k, mean);
    }
}

/* Mixes table and pyramid by level; before scaling. */
ALWAYS void mix_far(const float *far, WrStrip *strip, int i)
{
    W_EACH for (int k = 0; k < WIDE; k++)
    {
        const float level = strip->level[i + k], part = level < 1.0f ? level : 1.0f;
        const float fu = strip->fu[i + k], fv = strip->fv[i + k];
        strip->fu[i + k] = level > 0.0f ? fu + part * (far[4 * k] - fu) : fu;
        strip->fv[i + k] = level > 0.0f ? fv + part * (far[4 * k + 1] - fv) : fv;
    }
}

static bool any_level(const WrStrip *strip, int i, int count)
{
    const unsigned of = w_first_bits(count - i);
    return (w_bits(w_less(w_all(0.0f), w_load(strip->level + i))) & of) != 0;
}

static void wide_filtered(const WrLook *look, WrStrip *strip)
{
    const WrPyramid *pyramid = look->pyramid;
    const int count = strip->count;
    _Alignas(64) float far[4 * WIDE] = { 0 };
    Levels of = { 0 };
    for (int l = 0; l < pyramid->levels; l++) {
        of.width[l] = (float)pyramid->level[l].width;
        of.height[l] = (float)pyramid->level[l].height;
        of.pitch[l] = pyramid->level[l].pitch;
    }
    central_slopes(look, true, strip);
    for (int i = 0; i < count; i += WIDE) {
        if (!any_level(strip, i, count)) continue;
        look_far(pyramid, &of, strip, i, count, far);
        mix_far(far, strip, i);
    }
    scale_slopes(look, strip);
}
