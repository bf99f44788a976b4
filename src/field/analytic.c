#include "field/analytic.h"

#include "base/exactmath.h"
#include "field/field.h"

#include <math.h>

/* x^n by n multiplications, in one order on every processor. */
static double power(double x, int n)
{
    double p = 1.0;
    for (int k = 0; k < n; k++) p *= x;
    return p;
}

/* d(x^n)/dx */
static double power_slope(double x, int n)
{
    return n > 0 ? n * power(x, n - 1) : 0.0;
}

/* F += a u^i v^j; F_u += a i u^(i-1) v^j; F_v += a j u^i v^(j-1). Neither is periodic: u and v are reduced to [0,1) first. */
static void add_poly(const WrAnalyticTerm *term, double u, double v, double sum[3])
{
    double pu = power(u, term->i), pv = power(v, term->j);
    sum[0] += term->a * (pu * pv);
    sum[1] += term->a * (power_slope(u, term->i) * pv);
    sum[2] += term->a * (pu * power_slope(v, term->j));
}

/* F += a cos(2 pi i u + a_u) cos(2 pi j v + a_v), an exactly periodic term since i and j are integers; angles are in turns,
   so that no multiple of pi is rounded. F_u = -2 pi i a sin() cos(), F_v = -2 pi j a cos() sin(). */
static void add_fourier(const WrAnalyticTerm *term, double u, double v, double sum[3])
{
    double sin_u, cos_u, sin_v, cos_v;
    wr_sincos_turns(term->i * u + term->phase_u_deg / 360.0, &sin_u, &cos_u);
    wr_sincos_turns(term->j * v + term->phase_v_deg / 360.0, &sin_v, &cos_v);
    sum[0] += term->a * (cos_u * cos_v);
    sum[1] -= term->a * (2.0 * WR_PI * term->i * (sin_u * cos_v));
    sum[2] -= term->a * (2.0 * WR_PI * term->j * (cos_u * sin_v));
}

/*   F| <= sum |a_k|, since u^i v^j and the products of cosines stay within -1..1 on [0,1)^2. */
double wr_analytic_amplitude(const WrAnalytic *analytic)
{
    double sum = 0;
    for (int k = 0; k < analytic->count; k++) sum += fabs(analytic->terms[k].a);
    return sum;
}

void wr_analytic_sample(const WrAnalytic *analytic, double u, double v, double *f, double *fu,
                        double *fv)
{
    double sum[3] = { 0.0, 0.0, 0.0 }; /* F, dF/du, dF/dv */
    u = wr_field_reduce(u, 1.0);
    v = wr_field_reduce(v, 1.0);
    for (int k = 0; k < analytic->count; k++) {
        if (analytic->kind == WR_ANALYTIC_POLY) add_poly(&analytic->terms[k], u, v, sum);
        if (analytic->kind == WR_ANALYTIC_FOURIER) add_fourier(&analytic->terms[k], u, v, sum);
    }
    if (f) *f = sum[0];
    if (fu) *fu = sum[1];
    if (fv) *fv = sum[2];
}
