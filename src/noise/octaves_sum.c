#include "noise/octaves.h"

#include <math.h>

/* A sum in progress: N, its gradient, and for ridges the weight of the next octave. */
typedef struct Sum {
    double n, d[WR_NOISE_AXES];
    double w, dw[WR_NOISE_AXES];
} Sum;

/* d|f|/df, with sign(0) = 0: the mean of its values on both sides of a crease. */
static double sign(double f)
{
    return (f > 0.0) - (f < 0.0);
}

/* S = w (o - |f|)^2;  dS = dw (o - |f|)^2 - 2 w (o - |f|) d|f|;  the next w = min(1, gain S). */
static void add_ridge(const WrOctavesPlan *plan, double amplitude, double f, const double *d,
                      Sum *sum)
{
    double h = plan->ridge_offset - fabs(f), signal = sum->w * (h * h);
    double next = plan->ridge_gain * signal;
    sum->n += amplitude * signal;
    for (int a = 0; a < plan->dim; a++) {
        double ds = sum->dw[a] * (h * h) - 2.0 * sum->w * h * sign(f) * d[a];
        sum->d[a] += amplitude * ds;
        sum->dw[a] = next < 1.0 ? plan->ridge_gain * ds : 0.0;
    }
    sum->w = next < 1.0 ? next : 1.0;
}

static void add_octave(const WrOctavesPlan *plan, const WrOctave *octave, const double *p, Sum *sum)
{
    double t[WR_NOISE_AXES], d[WR_NOISE_AXES], amplitude = octave->amplitude;
    for (int a = 0; a < plan->dim; a++) t[a] = octave->frequency[a] * p[a] + octave->offset[a];
    double f = wr_noise_at(&octave->noise, t, d);
    for (int a = 0; a < plan->dim; a++) d[a] *= octave->frequency[a];
    if (plan->mode == WR_OCTAVES_RIDGED) {
        add_ridge(plan, amplitude, f, d, sum);
        return;
    }
    double factor = amplitude;
    if (plan->mode == WR_OCTAVES_TURBULENCE) factor = amplitude * sign(f);
    if (plan->mode == WR_OCTAVES_BILLOW) factor = 2.0 * amplitude * sign(f);
    sum->n += factor * f - (plan->mode == WR_OCTAVES_BILLOW ? amplitude : 0.0);
    for (int a = 0; a < plan->dim; a++) sum->d[a] += factor * d[a];
}

double wr_octaves_at(const WrOctavesPlan *plan, const double *p, double *slope)
{
    Sum sum = { .w = 1.0 };
    double place[WR_NOISE_AXES];
    for (int a = 0; a < plan->dim; a++) place[a] = wr_noise_reduce(p[a], plan->tile ? 1.0 : 0.0);
    for (int i = 0; i < plan->used; i++) add_octave(plan, &plan->octave[i], place, &sum);
    for (int a = 0; slope && a < plan->dim; a++) slope[a] = sum.d[a];
    return sum.n;
}

double wr_octaves_warped_at(const WrOctavesPlan *plan, const WrOctavesPlan *const *warp,
                            double amount, const double *p, double *slope)
{
    int dim = plan->dim;
    double at[WR_NOISE_AXES] = { 0 }, dw[WR_NOISE_AXES][WR_NOISE_AXES], d[WR_NOISE_AXES];
    for (int a = 0; a < dim; a++) {
        double place = wr_noise_reduce(p[a], plan->tile ? 1.0 : 0.0);
        at[a] = place + amount * wr_octaves_at(warp[a], p, dw[a]);
    }
    double n = wr_octaves_at(plan, at, d);
    for (int b = 0; slope && b < dim; b++) {
        double sum = d[b];
        for (int a = 0; a < dim; a++) sum += amount * d[a] * dw[a][b];
        slope[b] = sum;
    }
    return n;
}

void wr_octaves_span(const WrOctavesPlan *plan, size_t count, const double *const *p, double *f,
                     double *const *slope)
{
    for (size_t i = 0; i < count; i++) {
        double at[WR_NOISE_AXES] = { 0 }, d[WR_NOISE_AXES];
        for (int a = 0; a < plan->dim; a++) at[a] = p[a][i];
        f[i] = wr_octaves_at(plan, at, d);
        for (int a = 0; slope && a < plan->dim; a++)
            if (slope[a]) slope[a][i] = d[a];
    }
}
