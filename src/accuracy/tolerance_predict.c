/* What a setting of all three axes does, from what was measured of each. */
#include "accuracy/tolerance_inner.h"

#include <math.h>

#define CAUTION 2.5 /* standard errors that are added to a sum */
#define SCATTERED                                                                                  \
    0.12 /* of the time: blocks of several settings lie scattered, and short rows are slower */

double wr_study_cautious(const Error strata[STRATA])
{
    double sum = 0, variance = 0;
    for (int s = 1; s < STRATA; s++) {
        sum += strata[s].sum;
        variance += strata[s].spread * strata[s].spread;
    }
    return sum + CAUTION * sqrt(variance);
}

double wr_study_rms(const Study *study, double squares)
{
    return sqrt(squares / (3 * fmax(study->pixels, 1)));
}

static Error rated(const Rate *rate, int stratum, double control)
{
    return (Error){ rate->ratio[stratum] * control, rate->spread[stratum] * control,
                    rate->most[stratum] };
}

double wr_study_rate_rms(const Study *study, const Rate *rate, const Control *control)
{
    Error strata[STRATA] = { { 0, 0, 0 } };
    for (int k = 1; k < KINDS; k++) {
        const Error kind = rated(rate, wr_stratum(k), control->sum[k]);
        strata[wr_stratum(k)].sum += kind.sum;
        strata[wr_stratum(k)].spread += kind.spread;
    }
    return wr_study_rms(study, wr_study_cautious(strata));
}

double wr_study_seconds(const Study *study, int kind, Place place)
{
    const double pace = study->work > 0 ? study->wall / study->work : 1;
    return pace * study->pair[place.scheme][place.mode].pace * study->each[place.way] *
           (double)study->covered[kind];
}

double wr_study_passes(const Study *study, double seconds, int passes)
{
    const double pace = study->work > 0 ? study->wall / study->work : 1;
    return passes > 1 ? (1 + SCATTERED) * seconds + (passes - 1) * pace * study->pass : seconds;
}

/* Errors of formulas and of sampling are not quite independent: coarser slopes are smoother, and alias
   less. How much they have in common, -1..1, tell 2 x 2 samples, where all three are known:
       |a + b|^2 = |a|^2 + |b|^2 + 2 r |a| |b|. */
static double in_common(double both, double a, double b)
{
    if (!(a > 0 && b > 0)) return 0;
    return fmax(-1, fmin(1, (both - a - b) / (2 * sqrt(a * b))));
}

/* The controls of a kind or of a block. */
typedef struct Known {
    int stratum;
    double size, change, formula; /* of Study, of Pair */
} Known;

/* A pair that is not the best with more than one sample. */
static Error with_formulas(const Study *study, const Pair *pair, int way, Known known)
{
    const Error two = rated(&study->way[WAY_TWO], known.stratum, known.size);
    const Error own = rated(&pair->own, known.stratum, known.formula);
    const Error both = rated(&pair->two, known.stratum, two.sum + own.sum);
    if (way == WAY_TWO) return both;
    Error out = rated(&study->way[way], known.stratum, known.size);
    const double r = in_common(both.sum, two.sum, own.sum);
    out.sum = fmax(0, out.sum + own.sum + 2 * r * sqrt(out.sum * own.sum));
    out.spread = hypot(out.spread, own.spread);
    out.most += own.most;
    return out;
}

static Error predict(const Study *study, Place place, Known known)
{
    const Pair *pair = &study->pair[place.scheme][place.mode];
    const bool best = wr_same_place(place, wr_best_place(study, place.way));
    if (place.way == WAY_POINT) return rated(&pair->point, known.stratum, known.change);
    if (best) return rated(&study->way[place.way], known.stratum, known.size);
    return with_formulas(study, pair, place.way, known);
}

Error wr_study_predict(const Study *study, int kind, Place place)
{
    const Pair *pair = &study->pair[place.scheme][place.mode];
    const Known known = { wr_stratum(kind), study->size.sum[kind], pair->change.sum[kind],
                          pair->formula.sum[kind] };
    return predict(study, place, known);
}

double wr_study_predict_block(const Study *study, int64_t block, Place place)
{
    const Pair *pair = &study->pair[place.scheme][place.mode];
    const Known known = { study->block[block].stratum, (double)study->size.of[block],
                          (double)pair->change.of[block], (double)pair->formula.of[block] };
    return predict(study, place, known).sum;
}
