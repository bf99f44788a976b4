/* brush_kernels_body.h - implementation of the loops of brush_kernels.h, compiled once for each
   instruction set (wr_kern of CMakeLists.txt). Intentionally without an include guard. */
#include "brush/brush_kernels.h"

#include <math.h>
#include <string.h>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

/* Smoothstep of the squared distance between the radius and the inner radius. It is clamped to those
 * two before the root is computed, where sqrt(r r) is r again, so that no constant of 0 or 1 makes
 * compilers branch; at the inner radius s is within a rounding of 1, and the result, which is flat
 * there, is 1 to the last bit of a float. */
static inline double profile(const WrCapsule *c, double d2)
{
    d2 = d2 < c->radius2 ? d2 : c->radius2;
    d2 = d2 > c->inner2 ? d2 : c->inner2;
    double s = (c->radius - sqrt(d2)) * c->inverse_edge;
    return s * s * (3.0 - 2.0 * s);
}

/* Integers as doubles, since few processors convert integers to doubles in whole vectors. */
static const double steps[WR_TILE] = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21,
    22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43,
    44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63,
};

/* Texel x + steps[i] of a dab's row; that sum is exact, so a texel has the same bits wherever its run
 * begins. ey2: the row's squared distance. */
static inline float dab_cover(const WrCapsule *c, double ey2, double x, int i)
{
    double ex = (x + steps[i]) - c->x;
    return (float)(c->pressure * profile(c, ex * ex + ey2));
}

/* start + strength cover; where cover is 0 the bits of start. No sum overflows: half of FLT_MAX's last
 * place is 1e31, so FLT_MAX + 1e30 rounds to FLT_MAX. */
static inline float raised(double strength, float start, float cover)
{
    float made = (float)(start + strength * cover);
    return cover > 0.0f ? made : start;
}

/* True if the block of texels from x on is nearer than the inner radius: there the squared distance is
 * clamped to one number, so coverage is constant, bit for bit. */
static inline bool is_flat(const WrCapsule *c, double ey2, double x)
{
    double left = fabs(x - c->x), right = fabs(x + (WR_BRUSH_BLOCK - 1) - c->x);
    double far = left > right ? left : right;
    return far * far + ey2 < c->inner2;
}

static void dab(const WrCapsule *capsule, double y, double x, int count, float *restrict cover)
{
    const WrCapsule c = *capsule;
    double ey = y - c.y, ey2 = ey * ey;
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK) {
        if (is_flat(&c, ey2, x + b)) {
#pragma omp simd
            for (int i = b; i < b + WR_BRUSH_BLOCK; i++) cover[i] = c.most;
            continue;
        }
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) cover[i] = dab_cover(&c, ey2, x, i);
    }
}

static inline double cut(double x)
{
    x = x < 0x1p30 ? x : 0x1p30;
    return x > -0x1p30 ? x : -0x1p30;
}

static void dab_rows(const WrCapsule *capsule, double y, int count, WrDabRows *rows)
{
    const WrCapsule c = *capsule;
    const double slack = 1e-3; /* texels: more than rounding errors, with negligible cost */
    double low[WR_TILE], high[WR_TILE], flat_low[WR_TILE], flat_high[WR_TILE];
    count = (count + WR_DAB_BLOCK - 1) & -WR_DAB_BLOCK; /* whole vectors */
#pragma omp simd
    for (int k = 0; k < count; k++) {
        double ey = (y + steps[k]) - c.y, outer = c.radius2 - ey * ey, inner = c.inner2 - ey * ey;
        double half = sqrt(outer > 0.0 ? outer : 0.0) + slack;
        double flat = sqrt(inner > 0.0 ? inner : 0.0) - slack;
        half = outer > 0.0 ? half : -2.0;
        flat = inner > 0.0 ? flat : -2.0;
        low[k] = floor(cut(c.x - half));
        high[k] = floor(cut(c.x + half));
        flat_low[k] = floor(cut(c.x - flat));
        flat_high[k] = floor(cut(c.x + flat));
    }
#pragma omp simd
    for (int k = 0; k < count; k++) {
        rows->low[k] = (int)low[k];
        rows->high[k] = (int)high[k];
        rows->flat_low[k] = (int)flat_low[k] + 1;
        rows->flat_high[k] = (int)flat_high[k];
    }
}

/* The square of a column's distance; that sum is exact, so a texel has the same bits in any tile. */
static inline void squares(const WrCapsule *c, double x, double *restrict ex2)
{
#pragma omp simd
    for (int i = 0; i < WR_TILE; i++) {
        double ex = (x + steps[i]) - c->x;
        ex2[i] = ex * ex;
    }
}

/* Blocks of texels partly between the radii. */
#if defined __AVX512F__ && defined __AVX512VL__
/* The generic loop below in whole vectors of doubles, where compilers use two halves. full: the
 * pressure is 1. Beyond the radius s is negative instead of clamped: such texels are not stored. 2 s is
 * exact, so the sum with 3 may be a fused product. */
static inline __attribute__((always_inline)) void
raise_edge_by(bool full, const WrCapsule *c, const double *restrict ex2, double ey2,
              double strength, float *restrict heights, int from, int to)
{
    const __m512d radius = _mm512_set1_pd(c->radius), inverse = _mm512_set1_pd(c->inverse_edge);
    const __m512d least = _mm512_set1_pd(c->inner2), two = _mm512_set1_pd(2.0);
    const __m512d pressure = _mm512_set1_pd(c->pressure), by = _mm512_set1_pd(strength);
    const __m512d row = _mm512_set1_pd(ey2), three = _mm512_set1_pd(3.0);
    for (int b = from; b < to; b += WR_DAB_BLOCK) {
        const __m512d d2 = _mm512_max_pd(_mm512_add_pd(_mm512_loadu_pd(ex2 + b), row), least);
        const __m512d s = _mm512_mul_pd(_mm512_sub_pd(radius, _mm512_sqrt_pd(d2)), inverse);
        __m512d smooth = _mm512_mul_pd(_mm512_mul_pd(s, s), _mm512_fnmadd_pd(two, s, three));
        if (!full) smooth = _mm512_mul_pd(pressure, smooth);
        const __m256 cover = _mm512_cvtpd_ps(smooth), start = _mm256_loadu_ps(heights + b);
        __mmask8 any = _mm512_cmp_pd_mask(s, _mm512_setzero_pd(), _CMP_GT_OQ);
        if (!full) any &= _mm256_cmp_ps_mask(cover, _mm256_setzero_ps(), _CMP_GT_OQ);
        const __m512d made =
            _mm512_add_pd(_mm512_cvtps_pd(start), _mm512_mul_pd(by, _mm512_cvtps_pd(cover)));
        _mm256_mask_storeu_ps(heights + b, any, _mm512_cvtpd_ps(made));
    }
}

static inline void raise_edge(const WrCapsule *c, const double *restrict ex2, double ey2,
                              double strength, float *restrict heights, int from, int to)
{
    if (c->pressure == 1.0) raise_edge_by(true, c, ex2, ey2, strength, heights, from, to);
    else raise_edge_by(false, c, ex2, ey2, strength, heights, from, to);
}
#else
static inline void raise_edge(const WrCapsule *c, const double *restrict ex2, double ey2,
                              double strength, float *restrict heights, int from, int to)
{
    for (int b = from; b < to; b += WR_DAB_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_DAB_BLOCK; i++) {
            float cover = (float)(c->pressure * profile(c, ex2[i] + ey2));
            heights[i] = raised(strength, heights[i], cover);
        }
}
#endif

/* Texel by texel, where blocks must not be widened. */
static inline void raise_some(const WrCapsule *c, const double *ex2, double ey2, double strength,
                              float *heights, int from, int to)
{
    for (int i = from; i < to; i++)
        heights[i] = raised(strength, heights[i], (float)(c->pressure * profile(c, ex2[i] + ey2)));
}

/* If the summand is a float, the sum of floats equals the sum in double rounded to float: a double's 53
 * bits are more than twice a float's 24. */
static inline void raise_by_float(float by, float *restrict heights, int from, int to)
{
    for (int b = from; b < to; b += WR_DAB_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_DAB_BLOCK; i++) heights[i] += by;
}

/* Whole blocks of constant coverage. */
#if defined __AVX512F__ && defined __AVX512VL__
/* Compilers would combine two halves to one store, which costs more than it saves. */
static inline void raise_by(double by, float *restrict heights, int from, int to)
{
    const __m512d more = _mm512_set1_pd(by);
    for (int b = from; b < to; b += WR_DAB_BLOCK) {
        const __m512d start = _mm512_cvtps_pd(_mm256_loadu_ps(heights + b));
        _mm256_storeu_ps(heights + b, _mm512_cvtpd_ps(_mm512_add_pd(start, more)));
    }
}
#else
static inline void raise_by(double by, float *restrict heights, int from, int to)
{
    for (int b = from; b < to; b += WR_DAB_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_DAB_BLOCK; i++) heights[i] = (float)(heights[i] + by);
}
#endif

static void dab_tile(const WrCapsule *capsule, const WrDabPart *part, double strength,
                     float *restrict heights)
{
    enum { B = WR_DAB_BLOCK };
    const WrCapsule c = *capsule;
    const WrDabRows *rows = part->rows;
    double ex2[WR_TILE], by = strength * c.most;
    int first = (part->low + B - 1) & -B, last = (part->high + 1) & -B; /* whole blocks */
    squares(&c, part->x, ex2);
    for (int k = 0; k < part->count; k++, heights += WR_TILE) {
        double ey = (part->y + steps[k]) - c.y, ey2 = ey * ey;
        if (first > part->low || last <= part->high) {
            int head = first <= part->high ? first : part->high + 1;
            raise_some(&c, ex2, ey2, strength, heights, part->low, head);
            if (last >= first) raise_some(&c, ex2, ey2, strength, heights, last, part->high + 1);
        }
        int low = rows->low[k] - part->x, high = rows->high[k] - part->x;
        low = (low > first ? low : first) & -B;
        high = ((high < last ? high : last - 1) | (B - 1)) + 1;
        if (low >= high) continue;
        int flat_low = rows->flat_low[k] - part->x, flat_high = rows->flat_high[k] + 1 - part->x;
        flat_low = ((flat_low > low ? flat_low : low) + B - 1) & -B;
        flat_high = (flat_high < high ? flat_high : high) & -B;
        if (!(c.most > 0.0f) || flat_low >= flat_high) flat_low = flat_high = high;
        raise_edge(&c, ex2, ey2, strength, heights, low, flat_low);
        if (by == (double)(float)by) raise_by_float((float)by, heights, flat_low, flat_high);
        else raise_by(by, heights, flat_low, flat_high);
        raise_edge(&c, ex2, ey2, strength, heights, flat_high, high);
    }
}

static void motion(const WrCapsule *capsule, double y, double x, int count, float *restrict cover)
{
    const WrCapsule c = *capsule;
    double py = y - c.y, along = py * c.dy;
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) {
            double px = (x + steps[i]) - c.x, t = (px * c.dx + along) * c.inverse_length2;
            t = 0.5 * (t + fabs(t)); /* exactly 0 below 0 */
            t = t < 1.0 ? t : 1.0;
            double ex = px - t * c.dx, ey = py - t * c.dy;
            cover[i] = (float)((c.pressure + t * c.growth) * profile(&c, ex * ex + ey * ey));
        }
}

/* The squared distance to an ellipse's centre, with its short axis stretched to the long one. The sums
 * are arranged so that mirror images and quarter turns give the same bits. */
static inline double ellipse_d2(const WrEllipse *e, double ex, double ey)
{
    double along = ex * e->ux + ey * e->uy, across = (ey * e->ux - ex * e->uy) * e->aspect;
    return along * along + across * across;
}

static void ellipse(const WrEllipse *ellipse, double y, double x, int count, float *restrict cover)
{
    const WrEllipse e = *ellipse;
    const WrCapsule c = {
        .radius = e.radius, .radius2 = e.radius2, .inner2 = e.inner2, .inverse_edge = e.inverse_edge
    };
    double ey = y - e.y, alpha = e.alpha;
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++)
            cover[i] = (float)(alpha * profile(&c, ellipse_d2(&e, (x + steps[i]) - e.x, ey)));
}

/* True for an unrotated circle: then ellipse_d2 is ex ex + ey ey, bit for bit. */
static inline bool is_round(const WrEllipse *e)
{
    return e->ux == 1.0 && e->uy == 0.0 && e->aspect == 1.0;
}

/* libmypaint's falloff of q = (d/R)^2: two straight lines that meet at q = hardness. */
static inline float soft_of(const WrEllipse *e, double d2)
{
    float q = (float)d2 * e->inverse_radius2;
    float near = 1.0f - q * e->slope_in, far = (1.0f - q) * e->slope_out;
    float value = q <= e->hardness ? near : far;
    return e->alpha * (value > 0.0f ? value : 0.0f);
}

static void soft(const WrEllipse *ellipse, double y, double x, int count, float *restrict cover)
{
    const WrEllipse e = *ellipse;
    double ey = y - e.y;
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++)
            cover[i] = soft_of(&e, ellipse_d2(&e, (x + steps[i]) - e.x, ey));
}

static void soft_over(const WrEllipse *ellipse, double y, double x, int count,
                      float *restrict cover)
{
    const WrEllipse e = *ellipse;
    double ey = y - e.y, ey2 = ey * ey;
    if (is_round(&e)) {
        for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
            for (int i = b; i < b + WR_BRUSH_BLOCK; i++) {
                double ex = (x + steps[i]) - e.x;
                cover[i] += (1.0f - cover[i]) * soft_of(&e, ex * ex + ey2);
            }
        return;
    }
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++)
            cover[i] += (1.0f - cover[i]) * soft_of(&e, ellipse_d2(&e, (x + steps[i]) - e.x, ey));
}

static void over(float *restrict cover, const float *restrict fresh, int count)
{
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) cover[i] += (1.0f - cover[i]) * fresh[i];
}

/* The rounding error of the sum is added to the rest. */
static void sum(float *restrict cover, float *restrict rest, const float *restrict fresh, int count)
{
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) {
            float a = cover[i], more = fresh[i] + rest[i], s = a + more;
            float back = s - a;
            rest[i] = (a - (s - back)) + (more - back);
            cover[i] = s;
        }
}

/* Flow from b to a: an eighth is exact, and keeps differences within float's range. Both sides of a
 * pair compute the same number with opposite sign. */
static inline float flux(float fa, float wa, float fb, float wb)
{
    float w = wa < wb ? wa : wb;
    return (1.6f * w) * (0.125f * fb - 0.125f * fa);
}

static void flow(const float *f, const float *w, const float *f_up, const float *w_up,
                 const float *f_down, const float *w_down, int stride, int count,
                 float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float across = flux(f[i], w[i], f[i - stride], w[i - stride]) +
                       flux(f[i], w[i], f[i + stride], w[i + stride]);
        float down = flux(f[i], w[i], f_up[i], w_up[i]) + flux(f[i], w[i], f_down[i], w_down[i]);
        out[i] = (f[i] + across) + down; /* this order never overflows */
    }
}

static bool grows(const float *cover, const float *fresh, int count)
{
    int any = 0;
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd reduction(| : any)
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) any |= cover[i] < fresh[i];
    return any;
}

static bool below(const float *cover, float most, int count)
{
    int any = 0;
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd reduction(| : any)
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) any |= cover[i] < most;
    return any;
}

static float least(const float *cover, int count)
{
    float low[WR_BRUSH_BLOCK], all = cover[0];
    memcpy(low, cover, sizeof low);
    for (int b = WR_BRUSH_BLOCK; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = 0; i < WR_BRUSH_BLOCK; i++)
            low[i] = cover[b + i] < low[i] ? cover[b + i] : low[i];
    for (int i = 0; i < WR_BRUSH_BLOCK; i++) all = low[i] < all ? low[i] : all;
    return all;
}

static void join(float *restrict cover, const float *restrict fresh, int count)
{
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++)
            cover[i] = cover[i] < fresh[i] ? fresh[i] : cover[i];
}

static void add(double strength, const float *start, const float *cover, int count, float *out)
{
    for (int b = 0; b < count; b += WR_BRUSH_BLOCK)
#pragma omp simd
        for (int i = b; i < b + WR_BRUSH_BLOCK; i++) out[i] = raised(strength, start[i], cover[i]);
}

const WrBrushKernels WR_SET_TABLE = {
    .name = WR_SET_NAME,
    .dab = dab,
    .dab_rows = dab_rows,
    .dab_tile = dab_tile,
    .motion = motion,
    .ellipse = ellipse,
    .soft = soft,
    .over = over,
    .sum = sum,
    .soft_over = soft_over,
    .flow = flow,
    .grows = grows,
    .below = below,
    .least = least,
    .join = join,
    .add = add,
};
