/* What a setting of all three axes does, from what was measured of each. */
#include "accuracy/tolerance_inner.h"

#include <math.h>

#define CAUTION 2.5 /* standard errors that are added to a sum */

double wr_study_cautious(const Study *study, const Measure *measure)
{
    double sum = 0, variance = 0;
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        sum += measure->sum[k];
        variance += measure->variance[k];
    }
    return sum + CAUTION * sqrt(variance);
}

double wr_study_rms(const Study *study, const Measure *measure)
{
    return sqrt(wr_study_cautious(study, measure) / (3 * fmax(study->pixels, 1)));
}

double wr_study_seconds(const Study *study, int kind, Place place)
{
    const Pair *pair = &study->pair[place.scheme][place.mode];
    const double pace = study->work > 0 ? study->wall / study->work : 1;
    return pace * (place.way == WAY_POINT ? pair->point_pace : pair->two_pace) *
           study->way_seconds[place.way][kind];
}

static void take(Measure *out, const Measure *from, int kind)
{
    out->sum[kind] = from->sum[kind];
    out->variance[kind] = from->variance[kind];
    out->most[kind] = from->most[kind];
}

/* What the reference itself is off. The errors of ways that are far from it are independent of its own,
   which is a part of the difference, half of it at most; those of ways with half as many samples a side
   may have the same sign. */
void wr_study_mend(const Study *study, int kind, int way, Measure *out)
{
    const Measure *top = &study->way[study->top];
    if (2 * wr_study_ways[way].samples < wr_study_ways[study->top].samples) {
        out->sum[kind] = fmax(0.5 * out->sum[kind], out->sum[kind] - top->sum[kind]);
    } else {
        out->sum[kind] += top->sum[kind];
        out->variance[kind] += top->variance[kind];
    }
}

/* Errors of formulas and of sampling are not quite independent: coarser slopes are smoother, and alias
   less. How much they have in common, -1..1, tell 2 x 2 samples, where all three are known:
       |a + b|^2 = |a|^2 + |b|^2 + 2 r |a| |b|. */
static double in_common(const Study *study, const Pair *pair, int kind)
{
    const double a = pair->own.sum[kind], b = study->way[WAY_TWO].sum[kind];
    if (!(a > 0 && b > 0)) return 0;
    return fmax(-1, fmin(1, (pair->two.sum[kind] - a - b) / (2 * sqrt(a * b))));
}

static void add_formulas(const Study *study, const Pair *pair, int kind, Measure *out)
{
    const double a = pair->own.sum[kind], b = out->sum[kind];
    out->sum[kind] = fmax(0, a + b + 2 * in_common(study, pair, kind) * sqrt(a * b));
    out->variance[kind] += pair->own.variance[kind];
    out->most[kind] += pair->own.most[kind];
}

void wr_study_predict(const Study *study, int kind, Place place, Measure *out)
{
    const Pair *pair = &study->pair[place.scheme][place.mode];
    const bool best =
        place.scheme == study->scheme_count - 1 && place.mode == study->mode_count - 1;
    if (place.way == WAY_POINT && pair->tried) {
        take(out, &pair->point, kind);
    } else if (place.way == WAY_TWO && pair->tried) {
        take(out, &pair->two, kind);
    } else {
        take(out, &study->way[place.way], kind);
        if (!best) add_formulas(study, pair, kind, out);
    }
    if (place.way != study->top) wr_study_mend(study, kind, place.way, out);
}
