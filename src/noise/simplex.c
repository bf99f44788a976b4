#include "noise/noise_internal.h"

#include "base/exactmath.h"

#include <math.h>

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
 * m^4 g - 8 m^3 (g . x) x to slope. */
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

double wr_noise_simplex(const WrNoise *noise, const double *t, double *slope)
{
    return simplex(noise->dim, &noise->lattice, t, slope);
}

/* Triangles of base 1 and height 1: in (x + y/2, y) they are the halves of unit squares, and every
 * second row is directly above the first, so that an even number of rows repeats. The shortest height
 * is 1/sqrt(5/4), hence the reach 4/5. 10.92 is 1 over the largest sum, 1/(0.55^4), rounded down. A
 * lattice point is hashed by 2x and y. */
double wr_noise_sheared(const WrNoise *noise, const double *t, double *slope)
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
    return wr_noise_blend(&wr_fades[WR_FADE_QUINTIC], MAX_MOST, x, corner, slope);
}

static double simplices(const WrLattice *lattice, const double *t, double *slope)
{
    return simplex(MAX_MOST, lattice, t, slope);
}

/* A period of P cells becomes a circle of circumference P: with R = P/(2 pi) and angle 2 pi t/P,
 * (p, q) = R (cos, sin) and df/dt = -sin df/dp + cos df/dq. */
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

double wr_noise_torus(const WrNoise *noise, const double *t, double *slope)
{
    return on_torus(noise, t, slope, simplices);
}

double wr_noise_cubes(const WrNoise *noise, const double *t, double *slope)
{
    return on_torus(noise, t, slope, cubes);
}
