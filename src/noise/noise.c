#include "noise/noise.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "noise/noise_internal.h"

#include <math.h>
#include <string.h>

/* A period of any integer number of cells, on one to three axes.
   step: the period must be a multiple of it, along each axis; 0 means that no period exists. works = false: no
   such noise in that dimension. always: the construction has no aperiodic form. */
#define ANY                                                                                        \
    {                                                                                              \
        [0] = { .works = true, .step = { 1 } }, [1] = { .works = true, .step = { 1, 1 } }, [2] = { \
            .works = true,                                                                         \
            .step = { 1, 1, 1 }                                                                    \
        }                                                                                          \
    }

WR_ROWS(wr_noises);
const WrNoiseInfo wr_noises[WR_NOISE_KIND_COUNT] = {
    [WR_ROW(WR_NOISE_VALUE)] = { .name = "value",
                                 .label = "value",
                                 .help = "Blends random heights that stand on a square lattice.",
                                 .cells = true,
                                 .repeat = ANY },
    [WR_ROW(WR_NOISE_GRADIENT)] = { .name = "gradient",
                                    .label = "gradient",
                                    .help = "Meets random heights and random slopes on a square "
                                            "lattice.",
                                    .cells = true,
                                    .repeat = ANY },
    [WR_ROW(WR_NOISE_PERLIN)] = { .name = "perlin",
                                  .label = "Perlin",
                                  .help = "Is 0 with a slope from a fixed set on a square lattice.",
                                  .cells = true,
                                  .repeat = ANY },
    [WR_ROW(WR_NOISE_SIMPLEX)] = { .name = "simplex",
                                   .label = "simplex",
                                   .help = "Adds round bumps on a lattice of triangles or "
                                           "tetrahedra; in 2D it cannot repeat.",
                                   .repeat = { [1] = { .works = true },
                                               [2] = { .works = true, .step = { 3, 3, 3 } } } },
    [WR_ROW(WR_NOISE_SHEARED)] = { .name = "sheared",
                                   .label = "simplex on sheared triangles",
                                   .help =
                                       "Simplex noise on triangles of base 1 and height 1, which "
                                       "repeat.",
                                   .repeat = { [1] = { .works = true, .step = { 1, 2 } } } },
    [WR_ROW(WR_NOISE_TORUS)] = { .name = "torus",
                                 .label = "simplex on a torus",
                                 .help = "4D simplex noise on a torus: repeats, without favoured "
                                         "directions.",
                                 .repeat = { [1] = { .works = true,
                                                     .always = true,
                                                     .step = { 1, 1 } } } },
    [WR_ROW(WR_NOISE_CUBES)] = { .name = "cubes",
                                 .label = "Perlin on a torus",
                                 .help = "4D Perlin noise on a torus: the cubes that 4D simplices "
                                         "are cheaper than.",
                                 .repeat = { [1] = { .works = true,
                                                     .always = true,
                                                     .step = { 1, 1 } } } },
};
WR_ROWS_END(wr_noises, WR_NOISE_KIND_COUNT);
#undef ANY

int wr_noise_find(const char *name)
{
    for (int k = 0; k < WR_NOISE_KIND_COUNT; k++)
        if (strcmp(wr_noises[k].name, name) == 0) return k;
    return -1;
}

static bool check_period(const WrNoise *noise, int axis, WrError *err)
{
    const WrNoiseInfo *info = &wr_noises[noise->kind];
    const WrNoiseRepeat *repeat = &info->repeat[noise->dim - 1];
    int period = noise->lattice.period[axis], step = repeat->step[axis];
    char name = "xyz"[axis];
    if (period < 0 || period > WR_LATTICE_MAX)
        return wr_fail(err, "%s noise: period %d along %c: must be 0 (none) to %d cells",
                       info->name, period, name, WR_LATTICE_MAX);
    if (period == 0) {
        if (repeat->always || noise->lattice.source == WR_LATTICE_DATA)
            return wr_fail(err, "%s noise%s needs a period along %c: at least %d cells", info->name,
                           repeat->always ? "" : " from data", name, step);
        return true;
    }
    if (step == 0)
        return wr_fail(err,
                       "simplex noise in 2D cannot repeat on a square (its lattice is skewed by an "
                       "irrational amount): use sheared or torus, or period 0");
    if (period % step)
        return wr_fail(err, "%s noise: period %d along %c: must be a multiple of %d cells",
                       info->name, period, name, step);
    return true;
}

/* Number of lattice points of data; 0 if it exceeds possible memory.
   The data index is c[0] + period[0] (c[1] + period[1] c[2]): x runs fastest. */
static size_t data_points(const WrNoise *noise)
{
    size_t count = 1;
    for (int a = 0; a < noise->dim; a++)
        if (__builtin_mul_overflow(count, (size_t)noise->lattice.period[a], &count)) return 0;
    return count <= SIZE_MAX / (WR_NOISE_AXES * sizeof(double)) ? count : 0;
}

static bool check_finite(const double *data, size_t count, const char *what, WrError *err)
{
    for (size_t k = 0; k < count; k++)
        if (!isfinite(data[k]))
            return wr_fail(err, "noise from data: %s %zu is not a finite number", what, k);
    return true;
}

static bool check_data(const WrNoise *noise, WrError *err)
{
    const WrLattice *lattice = &noise->lattice;
    const char *name = wr_noises[noise->kind].name;
    size_t count = data_points(noise);
    if (count == 0) return wr_fail(err, "%s noise from data: the lattice is too large", name);
    if (!lattice->values) return wr_fail(err, "%s noise from data: there are no values", name);
    if (!check_finite(lattice->values, count, "value", err)) return false;
    if (noise->kind == WR_NOISE_VALUE) return true;
    if (!lattice->slopes) return wr_fail(err, "%s noise from data: there are no slopes", name);
    return check_finite(lattice->slopes, count * (size_t)noise->dim, "slope", err);
}

bool wr_noise_check(const WrNoise *noise, WrError *err)
{
    if ((int)noise->kind < 0 || noise->kind >= WR_NOISE_KIND_COUNT)
        return wr_fail(err, "noise kind %d: must be 0..%d", (int)noise->kind,
                       WR_NOISE_KIND_COUNT - 1);
    const WrNoiseInfo *info = &wr_noises[noise->kind];
    if ((int)noise->fade < 0 || noise->fade >= WR_FADE_COUNT)
        return wr_fail(err, "fade %d: must be 0..%d", (int)noise->fade, WR_FADE_COUNT - 1);
    if (noise->dim < 1 || noise->dim > WR_NOISE_AXES)
        return wr_fail(err, "noise in %d dimensions: must be 1..%d", noise->dim, WR_NOISE_AXES);
    if (!info->repeat[noise->dim - 1].works)
        return wr_fail(err, "%s noise in %dD: there is %s", info->name, noise->dim,
                       info->repeat[2].works ? "2D and 3D only" : "2D only");
    WrLatticeSource source = noise->lattice.source;
    if ((int)source < 0 || source >= WR_LATTICE_SOURCE_COUNT)
        return wr_fail(err, "lattice source %d: must be 0..%d", (int)source,
                       WR_LATTICE_SOURCE_COUNT - 1);
    if (source != WR_LATTICE_HASH && !info->cells)
        return wr_fail(err, "%s noise computes slopes from the integer hash only", info->name);
    if (source == WR_LATTICE_LECTURE && noise->dim > 2)
        return wr_fail(err, "the lecture's hash has two coordinates, not three; use 1D or 2D");
    if (source == WR_LATTICE_DATA && noise->kind == WR_NOISE_PERLIN)
        return wr_fail(err,
                       "perlin noise from data: its slopes are a fixed set; use gradient noise "
                       "with values of 0");
    for (int a = 0; a < noise->dim; a++)
        if (!check_period(noise, a, err)) return false;
    return source != WR_LATTICE_DATA || check_data(noise, err);
}

/* The factor that scales perlin noise to -1..1. With unit slopes sum w_k |t - p_k| is at most sqrt(sum
 * w_k |t - p_k|^2) (the weights add up to 1), and each axis's part of that sum, (1 - alpha) x^2 + alpha
 * (1 - x)^2, is at most 1/4, for each fade: so |f| <= sqrt(d)/2. */
double wr_noise_perlin_scale(int dim)
{
    static const double scale[] = { 2.0, 1.41421356237309505, 0.81649658092772603 };
    return scale[dim - 1];
}

/* One hash of the point is the value; slopes are derived from it by a second hash per axis, so that value and
   slope are independent. */
static double prescribed_by_hash(const WrNoise *noise, const uint32_t *c, double *slope)
{
    uint32_t h = wr_lattice_hash(noise->lattice.seed, c, noise->dim);
    if (noise->kind == WR_NOISE_PERLIN) {
        const double *g = wr_lattice_gradient(noise->dim, h);
        double scale = wr_noise_perlin_scale(noise->dim);
        for (int a = 0; a < noise->dim; a++) slope[a] = scale * g[a];
        return 0.0;
    }
    for (int a = 0; a < noise->dim; a++)
        slope[a] =
            noise->kind == WR_NOISE_GRADIENT ? wr_lattice_number(wr_lattice_slope_hash(h, a)) : 0.0;
    return wr_lattice_number(h);
}

/* L13: fract(5678.1234 sin(12.3456 x + 78.910 y + 1.1235 + salt)), double only; float results are uncorrelated
   (HC66). Slopes of axis a use the next salts. Values 0..1 are scaled to -1..1. */
static double prescribed_by_lecture(const WrNoise *noise, const uint32_t *c, double *slope)
{
    double x = c[0], y = noise->dim > 1 ? c[1] : 0.0, salt = noise->lattice.seed;
    if (noise->kind == WR_NOISE_PERLIN) {
        uint32_t h = (uint32_t)(wr_hash_lecture(x, y, salt) * 0x1p32);
        const double *g = wr_lattice_gradient(noise->dim, h);
        for (int a = 0; a < noise->dim; a++) slope[a] = wr_noise_perlin_scale(noise->dim) * g[a];
        return 0.0;
    }
    for (int a = 0; a < noise->dim; a++)
        slope[a] = noise->kind == WR_NOISE_GRADIENT
                       ? 2.0 * wr_hash_lecture(x, y, salt + 1.0 + a) - 1.0
                       : 0.0;
    return 2.0 * wr_hash_lecture(x, y, salt) - 1.0;
}

static double prescribed_by_data(const WrNoise *noise, const uint32_t *c, double *slope)
{
    const WrLattice *lattice = &noise->lattice;
    size_t at = 0;
    for (int a = noise->dim - 1; a >= 0; a--) at = at * (size_t)lattice->period[a] + c[a];
    for (int a = 0; a < noise->dim; a++)
        slope[a] = noise->kind == WR_NOISE_GRADIENT
                       ? lattice->slopes[at * (size_t)noise->dim + (size_t)a]
                       : 0.0;
    return lattice->values[at];
}

double wr_noise_lattice_value(const WrNoise *noise, const uint32_t *c, double *slope)
{
    switch (noise->lattice.source) {
    case WR_LATTICE_DATA: return prescribed_by_data(noise, c, slope);
    case WR_LATTICE_LECTURE: return prescribed_by_lecture(noise, c, slope);
    default: return prescribed_by_hash(noise, c, slope);
    }
}

/* A convex combination of planes f_k + g_k.(t - p_k): |f| <= max |f_k| + max |g| sqrt(d)/2. Slopes from the
   hash are in -1..1 per axis, so |g| <= sqrt(d), which is 1 + d/2 in all. */
double wr_noise_bound(const WrNoise *noise)
{
    const WrLattice *lattice = &noise->lattice;
    double half_diagonal = 0.5 * sqrt(noise->dim), value = 0.0, slope2 = 0.0;
    if (lattice->source != WR_LATTICE_DATA)
        return noise->kind == WR_NOISE_GRADIENT ? 1.0 + 0.5 * noise->dim : 1.0;
    size_t count = data_points(noise), dim = (size_t)noise->dim;
    for (size_t k = 0; k < count; k++) {
        double sum = 0.0;
        for (size_t a = 0; a < dim && noise->kind == WR_NOISE_GRADIENT; a++)
            sum += lattice->slopes[k * dim + a] * lattice->slopes[k * dim + a];
        slope2 = sum > slope2 ? sum : slope2;
        value = fabs(lattice->values[k]) > value ? fabs(lattice->values[k]) : value;
    }
    return value + sqrt(slope2) * half_diagonal;
}

/* The blend of p and q along an axis: f = p + alpha (q - p), so that
 * df/da = p_a + alpha (q_a - p_a) + alpha' (q - p), and without the last term along the other axes. */
static WrNoiseBlend blend(const WrNoiseBlend *p, const WrNoiseBlend *q, int dim, int axis,
                          double alpha, double rate)
{
    WrNoiseBlend out = { .f = p->f + alpha * (q->f - p->f) };
    for (int b = 0; b < dim; b++) out.d[b] = p->d[b] + alpha * (q->d[b] - p->d[b]);
    out.d[axis] += rate * (q->f - p->f);
    return out;
}

/* Blends 2^dim corners along each axis in turn; corner k is at 1 along axis a if bit a of k is set. x:
 * the position in the cube, 0..1. corner is overwritten. Returns f, its gradient in slope[dim].
   corner[k]: bit a of k is 1 at the far side of axis a. Blending axis 0 halves the array, pairs being
   neighbours; then axis 1 and so on. 2^d - 1 blends; corners are overwritten. */
static double noise_blend(const WrFadeInfo *fade, int dim, const double *x, WrNoiseBlend *corner,
                          double *slope)
{
    for (int a = 0; a < dim; a++) {
        const double alpha = wr_fade_value(fade, x[a]), rate = wr_fade_slope(fade, x[a]);
        for (int k = 0; k < 1 << (dim - 1 - a); k++)
            corner[k] = blend(&corner[2 * k], &corner[2 * k + 1], dim, a, alpha, rate);
    }
    for (int a = 0; a < dim; a++) slope[a] = corner[0].d[a];
    return corner[0].f;
}

/* Value, gradient and perlin noise: successive blends along each axis of the 2^d corners' planes
 * lambda_k = f_k + g_k . (t - p_k).
 * t is reduced to 0 .. period; far wraps to 0 by comparison, not by a ceiling, which would be wrong at
 * integers (L9). */
static double cells(const WrNoise *noise, const double *t, double *slope)
{
    const WrFadeInfo *fade = &wr_fades[noise->fade];
    int dim = noise->dim;
    double x[WR_NOISE_AXES];
    uint32_t near[WR_NOISE_AXES], far[WR_NOISE_AXES];
    for (int a = 0; a < dim; a++) {
        double whole = floor(t[a]);
        x[a] = t[a] - whole;
        near[a] = (uint32_t)(int64_t)whole;
        far[a] = near[a] + 1;
        if (noise->lattice.period[a] && far[a] == (uint32_t)noise->lattice.period[a]) far[a] = 0;
    }
    WrNoiseBlend corner[1 << WR_NOISE_AXES];
    for (int k = 0; k < 1 << dim; k++) {
        uint32_t c[WR_NOISE_AXES];
        for (int a = 0; a < dim; a++) c[a] = k >> a & 1 ? far[a] : near[a];
        corner[k].f = wr_noise_lattice_value(noise, c, corner[k].d);
        for (int a = 0; a < dim; a++)
            corner[k].f += corner[k].d[a] * (k >> a & 1 ? x[a] - 1.0 : x[a]);
    }
    return noise_blend(fade, dim, x, corner, slope);
}

/* cells() of 2D perlin noise from the hash, without slopes: the same operations in the same order, so the same bits, in less
   than half the time. Patterns evaluate it several times a texel. */
static double perlin_2d(const WrNoise *noise, const double *t)
{
    const WrFadeInfo *fade = &wr_fades[noise->fade];
    const double scale = wr_noise_perlin_scale(2), x0 = floor(t[0]), y0 = floor(t[1]);
    const double x[2] = { t[0] - x0, t[0] - x0 - 1.0 }, y[2] = { t[1] - y0, t[1] - y0 - 1.0 };
    const uint32_t i = (uint32_t)(int64_t)x0, j = (uint32_t)(int64_t)y0;
    const uint32_t period_u = (uint32_t)noise->lattice.period[0];
    const uint32_t period_v = (uint32_t)noise->lattice.period[1];
    const uint32_t c[2] = { i, period_u && i + 1 == period_u ? 0 : i + 1 };
    const uint32_t part[2] = {
        wr_lattice_hash_part(j, 1),
        wr_lattice_hash_part(period_v && j + 1 == period_v ? 0 : j + 1, 1),
    };
    const uint32_t start = wr_lattice_hash_start(noise->lattice.seed);
    const double alpha_u = wr_fade_value(fade, x[0]), alpha_v = wr_fade_value(fade, y[0]);
    double f[2][2], row[2]; /* [v][u] */
    for (int u = 0; u < 2; u++) {
        const uint32_t link = wr_lattice_hash_link(start, wr_lattice_hash_part(c[u], 0));
        for (int v = 0; v < 2; v++) {
            const double *g = wr_lattice_gradient(2, wr_lattice_hash_link(link, part[v]));
            f[v][u] = 0.0 + scale * g[0] * x[u] + scale * g[1] * y[v];
        }
    }
    for (int v = 0; v < 2; v++) row[v] = f[v][0] + alpha_u * (f[v][1] - f[v][0]);
    return row[0] + alpha_v * (row[1] - row[0]);
}

/* A period is reduced exactly in double (HC61). Without a period coordinates beyond 2^40 are folded, so that
   the casts to integers are defined and fractions keep 12 bits. */
static double noise_simplex(const WrNoise *noise, const double *t, double *slope);

static double noise_sheared(const WrNoise *noise, const double *t, double *slope);

static double noise_torus(const WrNoise *noise, const double *t, double *slope);

static double noise_cubes(const WrNoise *noise, const double *t, double *slope);

double wr_noise_at(const WrNoise *noise, const double *t, double *slope)
{
    double reduced[WR_NOISE_AXES], unwanted[WR_NOISE_AXES];
    for (int a = 0; a < noise->dim; a++) {
        int period = noise->lattice.period[a];
        reduced[a] = wr_noise_reduce(t[a], period ? period : fabs(t[a]) > 0x1p40 ? 0x1p40 : 0.0);
    }
    if (!slope && noise->kind == WR_NOISE_PERLIN && noise->dim == 2 &&
        noise->lattice.source == WR_LATTICE_HASH)
        return perlin_2d(noise, reduced);
    if (!slope) slope = unwanted;
    switch (noise->kind) {
    case WR_NOISE_SIMPLEX: return noise_simplex(noise, reduced, slope);
    case WR_NOISE_SHEARED: return noise_sheared(noise, reduced, slope);
    case WR_NOISE_TORUS: return noise_torus(noise, reduced, slope);
    case WR_NOISE_CUBES: return noise_cubes(noise, reduced, slope);
    default: return cells(noise, reduced, slope);
    }
}

/* ---- simplex noise ---- */

/* Simplex noise. The skew T(p) = p + F (p_1 + ... + p_d), F = (sqrt(d+1) - 1)/d, maps the lattice of
   simplices to integer points; T^-1(q) = q - G (q_1 + ... + q_d), G = (1 - 1/sqrt(d+1))/d. In a unit
   cube the corners of the simplex that contains a point are reached from its lowest corner by stepping
   along the axes in order of decreasing fraction. A corner's support ends at the opposite face of its
   simplices, at distance sqrt(1/2) in any dimension: on a face, where rounding may select either
   simplex, the terms of the corners that differ are 0 or nearly 0 (HC67). */

#define MAX_MOST WR_NOISE_DIMENSIONS

typedef struct Skew {
    double f, g;
    double scale; /* scales |noise| to at most 1: c over the length of the set's gradients */
} Skew;

/* c is 1 / max of the sum of (1/2 - r_k^2)^4 r_k over a simplex, found by search, rounded down: 99.204
 * (the midpoint of an edge, where it is 81/2 sqrt(6)), 107.653, 108.567 for d = 2, 3, 4. */
static const Skew skews[MAX_MOST + 1] = {
    [2] = { 0.36602540378443865, 0.21132486540518712, 99.2 },
    [3] = { 1.0 / 3.0, 1.0 / 6.0, 107.6 / 1.41421356237309505 },
    [4] = { 0.30901699437494742, 0.13819660112501052, 108.5 / 1.73205080756887729 },
};

/* A corner's term of the sum: (m^4)(g . x), m = reach - |x|^2 where that is positive; adds its gradient
 * m^4 g - 8 m^3 (g . x) x to slope.
 * The power 4 makes value, slope and second derivative continuous where m reaches 0. */
static double corner_part(int dim, double reach, const double *gradient, const double *x,
                          double *slope)
{
    double m = reach, dot = 0.0;
    for (int a = 0; a < dim; a++) {
        m -= x[a] * x[a];
        dot += gradient[a] * x[a];
    }
    if (m <= 0.0) return 0.0;
    double m2 = m * m, m4 = m2 * m2;
    for (int a = 0; a < dim; a++) slope[a] += m4 * gradient[a] - 8.0 * m2 * m * dot * x[a];
    return m4 * dot;
}

static int64_t floor_mod(int64_t a, int64_t n)
{
    int64_t r = a % n;
    return r < 0 ? r + n : r;
}

/* The hash of a lattice point. In 3D of 6 q_a - sum of q, which is invariant under a period (noise.h);
 * 6 P is 18 m. */
static uint32_t corner_hash(int dim, const WrLattice *lattice, const int64_t *q)
{
    uint32_t c[MAX_MOST] = { 0 };
    for (int a = 0; a < dim; a++) {
        int64_t index = dim == 3 ? 6 * q[a] - (q[0] + q[1] + q[2]) : q[a];
        if (dim == 3 && lattice->period[a])
            index = floor_mod(index, 6 * (int64_t)lattice->period[a]);
        c[a] = (uint32_t)index;
    }
    return wr_lattice_hash(lattice->seed, c, dim);
}

/* rank[a] counts the axes whose fraction is smaller: corner k has stepped along the k axes of highest rank.
   Ties go to the first axis; both choices are equal there (HC67). y = x - up + k G is the distance from corner
   k, back in the unskewed space. */
static double simplex(int dim, const WrLattice *lattice, const double *t, double *slope)
{
    const Skew *skew = &skews[dim];
    double sum = 0.0, base_sum = 0.0, base[MAX_MOST], x[MAX_MOST], f = 0.0;
    int rank[MAX_MOST] = { 0 };
    for (int a = 0; a < dim; a++) sum += t[a];
    for (int a = 0; a < dim; a++) {
        base[a] = floor(t[a] + sum * skew->f);
        base_sum += base[a];
    }
    for (int a = 0; a < dim; a++) {
        x[a] = t[a] - (base[a] - base_sum * skew->g);
        slope[a] = 0.0;
    }
    for (int a = 0; a < dim; a++)
        for (int b = a + 1; b < dim; b++) rank[x[a] >= x[b] ? a : b]++;
    for (int k = 0; k <= dim; k++) {
        double y[MAX_MOST];
        int64_t q[MAX_MOST];
        for (int a = 0; a < dim; a++) {
            int up = rank[a] >= dim - k;
            y[a] = x[a] - up + k * skew->g;
            q[a] = (int64_t)base[a] + up;
        }
        const double *gradient = wr_lattice_gradient(dim, corner_hash(dim, lattice, q));
        f += corner_part(dim, 0.5, gradient, y, slope);
    }
    for (int a = 0; a < dim; a++) slope[a] *= skew->scale;
    return f * skew->scale;
}

/* The simplex kinds; t reduced to one period, or within 2^40. slope as in wr_noise_at, never NULL. */
static double noise_simplex(const WrNoise *noise, const double *t, double *slope)
{
    return simplex(noise->dim, &noise->lattice, t, slope);
}

/* Triangles of base 1 and height 1: in (x + y/2, y) they are the halves of unit squares, and every
 * second row is directly above the first, so that an even number of rows repeats. The shortest height
 * is 1/sqrt(5/4), hence the reach 4/5. 10.92 is 1 over the largest sum, 1/(0.55^4), rounded down. A
 * lattice point is hashed by 2x and y. */
static double noise_sheared(const WrNoise *noise, const double *t, double *slope)
{
    static const double scale = 10.92;
    const WrLattice *lattice = &noise->lattice;
    double u = t[0] + 0.5 * t[1], iu = floor(u), iv = floor(t[1]), f = 0.0;
    bool right = u - iu >= t[1] - iv;
    slope[0] = slope[1] = 0.0;
    for (int k = 0; k < 3; k++) {
        int du = k == 2 || (k == 1 && right), dv = k == 2 || (k == 1 && !right);
        double u0 = iu + du, v0 = iv + dv, x[2] = { t[0] - (u0 - 0.5 * v0), t[1] - v0 };
        int64_t twice = 2 * (int64_t)u0 - (int64_t)v0, row = (int64_t)v0;
        if (lattice->period[0]) twice = floor_mod(twice, 2 * (int64_t)lattice->period[0]);
        if (lattice->period[1]) row = floor_mod(row, lattice->period[1]);
        uint32_t c[2] = { (uint32_t)twice, (uint32_t)row };
        uint32_t h = wr_lattice_hash(lattice->seed, c, 2);
        f += corner_part(2, 0.8, wr_lattice_gradient(2, h), x, slope);
    }
    for (int a = 0; a < 2; a++) slope[a] *= scale;
    return f * scale;
}

/* Perlin noise on the cubes of 4D. With unit gradients it is at most sqrt(4)/2 = 1
 * (wr_noise_perlin_scale); the gradients of the set have length sqrt(3). */
static double cubes(const WrLattice *lattice, const double *t, double *slope)
{
    static const double scale = 0.57735026918962576;
    double base[MAX_MOST], x[MAX_MOST];
    WrNoiseBlend corner[1 << MAX_MOST];
    for (int a = 0; a < MAX_MOST; a++) {
        base[a] = floor(t[a]);
        x[a] = t[a] - base[a];
    }
    for (int k = 0; k < 1 << MAX_MOST; k++) {
        uint32_t c[MAX_MOST];
        for (int a = 0; a < MAX_MOST; a++) c[a] = (uint32_t)((int64_t)base[a] + (k >> a & 1));
        const double *g =
            wr_lattice_gradient(MAX_MOST, wr_lattice_hash(lattice->seed, c, MAX_MOST));
        corner[k].f = 0.0;
        for (int a = 0; a < MAX_MOST; a++) {
            corner[k].d[a] = scale * g[a];
            corner[k].f += corner[k].d[a] * (x[a] - (k >> a & 1));
        }
    }
    return noise_blend(&wr_fades[WR_FADE_QUINTIC], MAX_MOST, x, corner, slope);
}

static double simplices(const WrLattice *lattice, const double *t, double *slope)
{
    return simplex(MAX_MOST, lattice, t, slope);
}

/* A period of P cells becomes a circle of circumference P: with R = P/(2 pi) and angle 2 pi t/P,
 * (p, q) = R (cos, sin) and df/dt = -sin df/dp + cos df/dq.
 * The torus (p, q, r, s) is flat: distances along it are those of the table, so the noise has no stretched
 * places. */
static double on_torus(const WrNoise *noise, const double *t, double *slope,
                       double (*four)(const WrLattice *, const double *, double *))
{
    double p[4], d[4], sine[2], cosine[2];
    WrLattice plain = { .seed = noise->lattice.seed };
    for (int a = 0; a < 2; a++) {
        double period = noise->lattice.period[a], radius = period / (2.0 * WR_PI);
        wr_sincos_turns(t[a] / period, &sine[a], &cosine[a]);
        p[2 * a] = radius * cosine[a];
        p[2 * a + 1] = radius * sine[a];
    }
    double f = four(&plain, p, d);
    for (int a = 0; a < 2; a++) slope[a] = cosine[a] * d[2 * a + 1] - sine[a] * d[2 * a];
    return f;
}

/* The simplex kinds; t reduced to one period, or within 2^40. slope as in wr_noise_at, never NULL. */
static double noise_torus(const WrNoise *noise, const double *t, double *slope)
{
    return on_torus(noise, t, slope, simplices);
}

/* The simplex kinds; t reduced to one period, or within 2^40. slope as in wr_noise_at, never NULL. */
static double noise_cubes(const WrNoise *noise, const double *t, double *slope)
{
    return on_torus(noise, t, slope, cubes);
}
