/* Slopes and normals: cheaper ones beside the best, and what was measured against the reference beside the truth. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <math.h>

/* Of the change by 2 x 2 samples: for less a third choice of slopes gains little. */
#define TIGHT 0.4
/* Of the tolerance: what formulas are off hardly matters, or is too much but where there is little relief. */
#define SLIGHT 0.3
#define FAR 3

/* Of what the last doubling says of the reference: as much along outlines with the rows is that they are off. Of
   outlines that do not run with them 0.4 at most was seen, by chance, of those that do 0.5 at least. */
#define ALIGNED 0.45

#define DOUBT 0.1 /* of what formulas change on the whole picture */

/* ---- against the truth ---- */

/* The reference's own error from what `half` differs from it, squared, as errors fall by the usual order 3/2 at
   edges: from k to 2k samples a side both of the same sign, e(2k) = d(k, 2k) / (2^(3/2) - 1). For less than a
   doubling that would say more than d itself: there independent, e^2 = r^2 / (1 + r^2) d^2, and half as
   much again. Not where outlines run along the rows: there both may be off alike. */
static double own_share(int half, int top)
{
    const double r = pow((double)half / top, 1.5);
    return top >= 2 * half ? r * r / ((1 - r) * (1 - r)) : 1.5 * r * r / (1 + r * r);
}

void wr_study_judge_top(Study *study, int half_way)
{
    const Rate *half = &study->way[half_way];
    Rate *top = &study->way[study->top];
    const double squared =
        own_share(wr_study_ways[half_way].samples, wr_study_ways[study->top].samples);
    const double share = sqrt(squared);
    double along[STRATA], size[STRATA];
    wr_study_aligned(study, study->best, wr_study_ways[study->top].samples, along);
    wr_control_strata(&study->size, size);
    for (int s = 1; s < STRATA; s++) {
        const double least = size[s] > 0 ? along[s] / size[s] : 0;
        study->aligned[s] = least > ALIGNED * squared * half->ratio[s];
        top->ratio[s] = fmax(squared * half->ratio[s], least);
        top->spread[s] = squared * half->spread[s];
        top->most[s] = share * half->most[s];
    }
}

/* From a sum of squares that was measured against the reference to what it would be against the truth. The
   errors of the two are mostly independent: then the reference's own is a part of the difference, half of it
   at most. Along aligned outlines both have the same sign. */
double wr_study_mended(bool aligned, double measured, double own)
{
    const double both = sqrt(measured) + sqrt(own);
    return aligned ? both * both : fmax(0.5 * measured, measured - own);
}

/* control: that the rate is by. */
static void mend(const Study *study, const double control[STRATA], Rate *rate)
{
    double size[STRATA];
    wr_control_strata(&study->size, size);
    for (int s = 1; s < STRATA; s++) {
        if (!(control[s] > 0)) continue;
        const double own = study->way[study->top].ratio[s] * size[s];
        rate->ratio[s] =
            wr_study_mended(study->aligned[s], rate->ratio[s] * control[s], own) / control[s];
    }
}

void wr_study_mend(const Study *study, const Control *control, Rate *rate)
{
    double sum[STRATA];
    wr_control_strata(control, sum);
    mend(study, sum, rate);
}

/* ---- slopes and normals ---- */

/* What 2 x 2 are foretold to be off with a pair: the best pair's own, and what its formulas add. The caller
   frees. sum: of it, by stratum. */
static float *foretell_two(const Study *study, const Pair *pair, double sum[STRATA])
{
    float *out = wr_alloc((size_t)study->block_count, sizeof *out);
    for (int64_t b = 0; b < study->block_count; b++) {
        const int s = study->block[b].stratum;
        if (s == STRATUM_EMPTY) continue;
        out[b] = (float)(study->way[WAY_TWO].ratio[s] * (double)study->size.of[b] +
                         pair->own.ratio[s] * (double)pair->formula.of[b] +
                         1e-9 * (double)study->size.of[b]);
        sum[s] += (double)out[b];
    }
    return out;
}

/* Relief may lie in blocks that were not drawn. Where the sample has seen little of what a pair's formulas change,
   they are taken to be off with 2 x 2 samples as much as with one. */
static void doubt_unseen(Pair *pair)
{
    double all[STRATA];
    wr_control_strata(&pair->formula, all);
    for (int s = 1; s < STRATA; s++) {
        if (!(all[s] > 0)) continue;
        const double seen = pair->own.weighed[s] / all[s], part = DOUBT / (seen + DOUBT);
        pair->own.ratio[s] += part * (1 - pair->own.ratio[s]);
        pair->own.spread[s] = hypot((1 - part) * pair->own.spread[s], 0.5 * part);
    }
}

/* One sample a pixel with a pair: of the whole picture, and what the sample says of it. */
static void study_point(Study *study, const float *point, Pair *pair)
{
    wr_study_compare(study, study->best, point, pair->change.of, &pair->point);
    wr_study_mend(study, &pair->change, &pair->point);
}

/* A pair of slopes and normal: the whole picture with one sample a pixel, the sample with 2 x 2, against the
   reference and the best pair's own. two: those of the best pair, of the sample; one_work: processor seconds of
   its whole picture, than which none is taken to be dearer. */
static bool study_pair(Study *study, Place place, const float *two, double one_work, WrError *err)
{
    Pair *pair = &study->pair[place.scheme][place.mode];
    WrFrame frame;
    double work = 0;
    place.way = WAY_POINT;
    if (!wr_study_render(study, place, NULL, &frame, &work, err)) return false;
    wr_study_control(study, frame.rgba, pair);
    wr_study_gather(study, frame.rgba, study->other);
    study_point(study, study->other, pair);
    place.way = WAY_TWO;
    if (!wr_study_try(study, place, study->other, NULL, err)) return false;
    wr_study_compare(study, two, study->other, pair->formula.of, &pair->own);
    doubt_unseen(pair);
    double sum[STRATA] = { 0 };
    float *control = foretell_two(study, pair, sum);
    wr_study_compare(study, study->best, study->other, control, &pair->two);
    mend(study, sum, &pair->two);
    wr_free(control);
    pair->pace = one_work > 0 ? fmin(1, work / one_work) : 1;
    return pair->tried = true;
}

static void study_best_pair(Study *study, float *two)
{
    const Place at = wr_best_place(study, WAY_POINT);
    Pair *best = &study->pair[at.scheme][at.mode];
    wr_study_control(study, NULL, best);
    wr_study_gather_packed(study, &study->one, two);
    study_point(study, two, best);
    best->pace = 1;
    best->tried = true;
    wr_study_gather_packed(study, &study->two, two);
}

/* Slopes and normals, all with all; without a normal slopes do not matter. Left out is what can gain little: the
   exact normal with cheaper slopes where the paper's is hardly off, the paper's where it is far off, and central
   slopes where bilinear ones are hardly off or nearly all that the best slopes give is needed. */
bool wr_study_pairs(Study *study, double fine, double change, double one_work, WrError *err)
{
    const int s = study->scheme_count - 1, m = study->mode_count - 1;
    float *two = wr_alloc(wr_study_floats(study), sizeof *two);
    int first = m < 1 ? m : 1, last = m;
    bool good = true;
    study_best_pair(study, two);
    for (int j = m - 1; good && j >= 0; j--)
        good = study_pair(study, (Place){ s, j, WAY_POINT }, two, one_work, err);
    if (good && m > 1 && fine > 0) {
        const double off = wr_study_formula_rms(study, &study->pair[s][m - 1]);
        if (off < SLIGHT * fine) last = m - 1;
        if (off > FAR * fine) first = m;
    }
    for (int i = 0; i < s; i++) {
        if (i > 0 && fine > 0 &&
            (wr_study_formula_rms(study, &study->pair[0][last]) < SLIGHT * fine ||
             fine < TIGHT * change))
            break;
        for (int j = last; good && j >= first; j--)
            good = study_pair(study, (Place){ i, j, WAY_POINT }, two, one_work, err);
    }
    wr_free(two);
    return good;
}
