#include "noise/octaves.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

/* ---- sum ---- */

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

/* N = sum r^-i f(s^i p + offset_i) (L6) and its modes; the gradient by the chain rule with s^i n0. */
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

/* n(p + amount w(p)): the gradient is d + amount W^T d, with W the Jacobian of the warp. */
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

const char *const wr_octaves_words[] = { WR_OCTAVES_MODES(WR_WORD) NULL };

WrOctaves wr_octaves_default(int dim)
{
    return (WrOctaves){
        .kind = WR_NOISE_PERLIN,
        .fade = WR_FADE_QUINTIC,
        .dim = dim,
        .tile = true,
        .count = 8,
        .ratio = 2.0,
        .step = 2.0,
        .cells = { 4.0, 4.0, 4.0 },
        .seed = 1,
        .scatter = true,
        .ridge_offset = 1.0,
        .ridge_gain = 2.0,
    };
}

/* Octave i has n0 s^i cells; one cell must have two texels at least (HC62). */
int wr_octaves_usable(double n0, double s, int texels)
{
    double limit = texels > 0 ? 0.5 * texels : WR_LATTICE_MAX;
    if (limit > WR_LATTICE_MAX) limit = WR_LATTICE_MAX;
    int usable = 0;
    for (double n = n0; usable < WR_OCTAVES_MAX && n <= limit; n *= s) usable++;
    return usable;
}

static bool check_number(const char *what, double value, double low, double high, WrError *err)
{
    if (value >= low && value <= high) return true;
    char bad[WR_NUMBER_SIZE], from[WR_NUMBER_SIZE], to[WR_NUMBER_SIZE];
    return wr_fail(err, "noise octaves: %s %s: must be %s..%s", what, wr_number_print(value, bad),
                   wr_number_print(low, from), wr_number_print(high, to));
}

static bool check_above_one(const char *what, double value, WrError *err)
{
    if (value > 1.0 && isfinite(value)) return true;
    char bad[WR_NUMBER_SIZE];
    return wr_fail(err, "noise octaves: %s %s: must be above 1 and finite", what,
                   wr_number_print(value, bad));
}

/* At least one cell per period; a cell of 1e-9 is the limit where frequency * p stays exact enough. */
static bool check_cells(const WrOctaves *octaves, WrError *err)
{
    for (int a = 0; a < octaves->dim; a++) {
        const char what[] = { 'c', 'e', 'l', 'l', 's', ' ',      'a',
                              'l', 'o', 'n', 'g', ' ', "xyz"[a], 0 };
        double low = octaves->tile ? 1.0 : 1e-9;
        if (!check_number(what, octaves->cells[a], low, WR_LATTICE_MAX, err)) return false;
    }
    return true;
}

static bool check_octaves(const WrOctaves *octaves, WrError *err)
{
    if (octaves->dim < 1 || octaves->dim > WR_NOISE_AXES)
        return wr_fail(err, "noise in %d dimensions: must be 1..%d", octaves->dim, WR_NOISE_AXES);
    if (octaves->count < 1 || octaves->count > WR_OCTAVES_MAX)
        return wr_fail(err, "noise of %d octaves: must be 1..%d", octaves->count, WR_OCTAVES_MAX);
    if ((int)octaves->mode < 0 || octaves->mode >= WR_OCTAVES_MODE_COUNT)
        return wr_fail(err, "octave mode %d: must be 0..%d", (int)octaves->mode,
                       WR_OCTAVES_MODE_COUNT - 1);
    if (octaves->source == WR_LATTICE_DATA)
        return wr_fail(err, "octaves of noise from data: one table cannot be the lattice of all of "
                            "them; use the hash");
    if (!check_above_one("amplitude ratio r =", octaves->ratio, err) ||
        !check_above_one("frequency step s =", octaves->step, err) || !check_cells(octaves, err))
        return false;
    if (octaves->mode == WR_OCTAVES_RIDGED &&
        (!check_number("ridge offset", octaves->ridge_offset, 0.0, 10.0, err) ||
         !check_number("ridge gain", octaves->ridge_gain, 0.0, 100.0, err)))
        return false;
    for (int k = 0; octaves->offsets && k < octaves->count * octaves->dim; k++)
        if (!check_number("offset", octaves->offsets[k], -1e9, 1e9, err)) return false;
    return true;
}

/* The number of cells nearest to n that is a valid period of the kind, at least one step.
   HC68: the rounded count is used both as frequency and as period, so that the table tiles exactly for any s. */
static int repeat_cells(const WrOctaves *octaves, int axis, double n)
{
    int step = 1;
    if ((int)octaves->kind >= 0 && octaves->kind < WR_NOISE_KIND_COUNT)
        step = wr_noises[octaves->kind].repeat[octaves->dim - 1].step[axis];
    if (step == 0) step = 1; /* the check below reports that it cannot repeat */
    double steps = floor(n / step + 0.5), most = WR_LATTICE_MAX / step;
    return step * (int)(steps < 1.0 ? 1.0 : steps > most ? most : steps);
}

/* Octave i along one axis, n = n0 s^i. Scattered offsets are odd multiples of 1/64 below 64 cells,
 * never integers: no texel of a power-of-two table is lost in rounding them. */
static void place_octave(const WrOctaves *octaves, int i, int axis, double n, WrOctave *octave)
{
    double offset = 0.0;
    if (octaves->offsets) {
        offset = octaves->offsets[i * octaves->dim + axis];
    } else if (octaves->scatter) {
        uint32_t h = wr_mix32(octave->noise.lattice.seed + 0x27d4eb2fU * ((uint32_t)axis + 1U));
        offset = (double)((h >> 20) | 1U) / 64.0;
    }
    if (octaves->tile) {
        const int cells = repeat_cells(octaves, axis, n);
        const int first = repeat_cells(octaves, axis, octaves->cells[axis]);
        const int period = octaves->one_lattice && cells % first == 0 ? first : cells;
        octave->noise.lattice.period[axis] = period;
        octave->frequency[axis] = cells;
        octave->offset[axis] = wr_noise_reduce(offset, period);
    } else {
        octave->noise.lattice.period[axis] = 0;
        octave->frequency[axis] = n;
        octave->offset[axis] = offset;
    }
}

/* The largest value of one octave's term, for |f| <= most.
   Of 2 |f| - 1 for 0 <= |f| <= most, and of (o - |f|)^2 at either end. */
static double term_bound(const WrOctaves *octaves, double most)
{
    double o = octaves->ridge_offset, far = fabs(o - most);
    switch (octaves->mode) {
    case WR_OCTAVES_BILLOW: return fabs(2.0 * most - 1.0) > 1.0 ? fabs(2.0 * most - 1.0) : 1.0;
    case WR_OCTAVES_RIDGED: return far > o ? far * far : o * o;
    case WR_OCTAVES_FBM:
    case WR_OCTAVES_TURBULENCE:
    case WR_OCTAVES_MODE_COUNT: break;
    }
    return most;
}

/* Every octave has its own seed, otherwise their lattices would coincide at the origin and add up there. bound
   is the sum of amplitudes times bounds, an upper limit only. */
bool wr_octaves_plan(const WrOctaves *octaves, const int *texels, WrOctavesPlan *plan, WrError *err)
{
    if (!check_octaves(octaves, err)) return false;
    WrOctavesPlan made = { .mode = octaves->mode,
                           .dim = octaves->dim,
                           .tile = octaves->tile,
                           .ridge_offset = octaves->ridge_offset,
                           .ridge_gain = octaves->ridge_gain,
                           .asked = octaves->count,
                           .used = octaves->count };
    double n[WR_NOISE_AXES], amplitude = 1.0;
    for (int a = 0; a < made.dim; a++) {
        int usable = wr_octaves_usable(octaves->cells[a], octaves->step, texels ? texels[a] : 0);
        made.used = usable < made.used ? usable : made.used;
        n[a] = octaves->cells[a];
    }
    /* The first octave is checked even if it is unused, so that an error is always reported. */
    for (int i = 0; i < made.used || i == 0; i++) {
        WrOctave *octave = &made.octave[i];
        octave->noise = (WrNoise){ .kind = octaves->kind, .fade = octaves->fade, .dim = made.dim };
        octave->noise.lattice.source = octaves->source;
        const uint32_t lattice = octaves->one_lattice ? 0 : (uint32_t)i;
        octave->noise.lattice.seed = octaves->source == WR_LATTICE_LECTURE
                                         ? (octaves->seed + lattice) % 1000U
                                         : wr_mix32(octaves->seed + 0x9e3779b9U * lattice);
        octave->amplitude = amplitude;
        for (int a = 0; a < made.dim; a++) {
            place_octave(octaves, i, a, n[a], octave);
            n[a] *= octaves->step;
        }
        if (!wr_noise_check(&octave->noise, err)) return false;
        if (i < made.used)
            made.bound += amplitude * term_bound(octaves, wr_noise_bound(&octave->noise));
        amplitude /= octaves->ratio;
    }
    *plan = made;
    return true;
}
