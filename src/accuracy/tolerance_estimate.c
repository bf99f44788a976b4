/* Error estimate of a block from the change between levels, and tests of a few blocks at a much finer level, in
   case two levels agree on a wrong value. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Error relative to c, the square of the change from k to 2k samples a side, if errors fall as k^-p:
     outlines, p = 3/2   the finer has 1/9 of c if both are independent, 0.3 if they have the same sign;
     noise finer than the samples, p = 1   1/5;   smooth, p = 2   1/9, and the coarser 16/9.
   The fall of c from one step to the next distinguishes them roughly: by 8, by 4, by 16. */
#define FINER 0.18
#define COARSER_LEAST 1.0
#define COARSER_MOST 1.8
#define FALL 8.0 /* of c from one step to the next: assumed for prediction ... */
#define FALL_MOST                                                                                  \
    2.0 /* ... and for the largest of many pixels, which falls more slowly than the mean */
#define FELL 14.0 /* largest credible fall: a smaller step than that is chance */
#define FELL_MOST 3.0
static const double finer_most[LEVELS] = { 0, 0.85, 0.85, 0.75, 0.7 };

/* The actual errors of blocks that climbed correct the estimates of the others: from this number on, within
   these bounds. */
#define LEARNT_LEAST 6
#define LEARNT_LOW 0.4
#define LEARNT_HIGH 4.0

#define HIDDEN 0.125 /* part of the squares along a side of a neighbour: one of its BLOCK pixels */

/* Probing: the picks, the level of each probe, and the share of the picture's cost for all of them. */
#define PROBED 3
static const int probe_level[PROBED] = { 2, 3, 3 };
#define PROBING 0.25
#define GROWN 1.5   /* probing is repeated when the number of blocks has grown by this factor */
#define CAUTION 1.0 /* standard errors added to a ratio of the sample */
#define FEW 4       /* with fewer probes a ratio is uncertain: only large deviations count */
#define FAR 2.0
#define LEAST_WEIGHT 0.7
#define MOST_WEIGHT 1000.0
#define WORSE 1.15 /* a larger factor requires a new pick */

/* ---- error of a block ---- */

static Change larger(Change a, Change b)
{
    return (Change){ fmax(a.squares, b.squares), fmax(a.most, b.most) };
}

static Change times(Change a, double squares, double most)
{
    return (Change){ a.squares * squares, a.most * most };
}

/* At a level: by the step to it, but at least the prediction of the steps before. */
static Change predicted(const Block *block, int level)
{
    if (level == 0) return times(block->change[1], COARSER_LEAST, 1);
    Change off = block->step[level];
    double fall = FINER, fall_most = finer_most[level];
    for (int n = level; n >= 1; n--) {
        off = larger(off, times(block->change[n], fall, fall_most));
        fall /= FELL;
        fall_most /= FELL_MOST;
    }
    return off;
}

/* Factor from the step from a level to the next. */
static double coarser(const Block *block, int level)
{
    const double before = block->change[level].squares, after = block->change[level + 1].squares;
    if (level == 0 || !(after > 0)) return COARSER_LEAST;
    return fmax(COARSER_LEAST, fmin(COARSER_MOST, before / after / 9));
}

/* Prediction `above` levels higher, from the error here. */
static Change off_above(Change here, int above)
{
    return times(here, pow(1 / FALL, above), pow(1 / FALL_MOST, above));
}

/* At its own level, corrected by the results of others of its kind. */
static Change off_here(const Study *study, const Block *block)
{
    const int level = block->level;
    const Learnt *learnt = &study->learnt[level][block->edge];
    const Change off = predicted(block, level);
    if (learnt->blocks < LEARNT_LEAST || !(learnt->predicted > 0)) return off;
    const double caution = 1 + 1 / sqrt((double)learnt->blocks);
    const double right = caution * learnt->measured / learnt->predicted;
    return times(off, fmax(LEARNT_LOW, fmin(LEARNT_HIGH, right)), 1);
}

/* Change of a neighbour's pixels along the common side, or at the common corner, from the level below. At a
   level that it was not rendered at, half as much for each further level. */
static Change beside(const Block *other, int u, int v, int level)
{
    const int seen = level < 1 ? 1 : level < other->level ? level : other->level;
    if (seen == 0 || !other->shown) return (Change){ 0, 0 };
    const Change *across = &other->side[seen][u < 0 ? RIGHT : LEFT];
    const Change *along = &other->side[seen][v < 0 ? LOWER : UPPER];
    const Change common = u == 0   ? *along
                          : v == 0 ? *across
                                   : (Change){ fmin(across->squares, along->squares),
                                               fmin(across->most, along->most) };
    const int above = level > seen ? level - seen : 0;
    return times(common, pow(0.25, above), pow(0.5, above));
}

/* An edge of the picture that passes through a neighbour (an outline, a crease, the end of the relief or a pole)
   may end in a corner or along a side of this block where none of its samples hits it: then its own levels agree
   on the same wrong colour. The hidden error is at most the change of the neighbour's nearest pixels. */
static Change hidden(const Study *study, const Block *block, int level)
{
    const int64_t b = block - study->block;
    const int at_u = (int)(b % study->blocks_u), at_v = (int)(b / study->blocks_u);
    Change most = { 0, 0 };
    for (int v = -1; v <= 1; v++)
        for (int u = -1; u <= 1; u++) {
            if ((u == 0 && v == 0) || at_u + u < 0 || at_u + u >= study->blocks_u || at_v + v < 0 ||
                at_v + v >= study->blocks_v)
                continue;
            most = larger(most, beside(block + (int64_t)v * study->blocks_u + u, u, v, level));
        }
    return times(most, HIDDEN, 1);
}

/* From its own pictures only. */
static Change off_seen(const Study *study, const Block *block, int level)
{
    const Change here = off_here(study, block);
    if (level == block->level) return here;
    if (level < block->level) {
        const Change *next = &block->change[level + 1];
        return larger(block->step[level],
                      (Change){ coarser(block, level) * next->squares, next->most + here.most });
    }
    if (block->level == 0)
        return off_above(times(block->change[1], FINER, finer_most[1]), level - 1);
    const int above = level - block->level;
    const Change step = times(block->step[block->level], pow(0.25, above), pow(0.5, above));
    return larger(step, off_above(here, above));
}

static Change off_samples(const Study *study, const Block *block, int level)
{
    return larger(off_seen(study, block, level), hidden(study, block, level));
}

Change wr_study_off(const Study *study, const Block *block, int pair, int level)
{
    const Doubt *doubt = &study->doubt[level];
    const Change off = times(off_samples(study, block, level), doubt->weight, doubt->weight_most);
    const Change formula = pair > 0 ? block->formula[pair] : (Change){ 0, 0 };
    return (Change){ off.squares + formula.squares, off.most + formula.most };
}

void wr_study_learn(Study *study)
{
    memset(study->learnt, 0, sizeof study->learnt);
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        for (int level = 1; block->shown && level < block->level; level++) {
            Learnt *learnt = &study->learnt[level][block->edge];
            learnt->predicted += predicted(block, level).squares;
            learnt->measured += coarser(block, level) * block->change[level + 1].squares;
            learnt->blocks++;
        }
    }
}

double wr_study_rms(const Study *study, double squares)
{
    return sqrt(squares / (3 * fmax(study->pixels, 1)));
}

/* ---- probes ---- */

typedef struct Probe {
    int64_t block;
    double off; /* estimated error, squares */
} Probe;

static int by_off(const void *a, const void *b)
{
    const Probe *x = a, *y = b;
    if (x->off != y->off) return x->off < y->off ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

/* All blocks of a pick, by increasing error. The caller frees. */
static Probe *list_picked(const Study *study, int pick, int64_t *count)
{
    Probe *list = wr_alloc((size_t)study->count + 1, sizeof *list);
    *count = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown || block->pick != pick) continue;
        list[(*count)++] = (Probe){ b, wr_study_off(study, block, block->pair, pick).squares };
    }
    qsort(list, (size_t)*count, sizeof *list, by_off);
    return list;
}

/* Draws blocks at equal steps of the errors' cumulative sum, each raised by half the mean, so that blocks with
   small estimates are included. Puts them into the mask; returns their number. */
static int64_t draw(Study *study, const Probe *list, int64_t count, int64_t wanted,
                    double *floor_off)
{
    double sum = 0, passed = 0;
    int64_t drawn = 0;
    for (int64_t i = 0; i < count; i++) sum += list[i].off;
    *floor_off = 0.5 * sum / (double)count + 1e-15;
    sum += *floor_off * (double)count;
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = 0;
    for (int64_t i = 0; i < count; i++) {
        passed += list[i].off + *floor_off;
        if (passed * (double)wanted < ((double)drawn + 0.5) * sum) continue;
        while (passed * (double)wanted >= ((double)drawn + 0.5) * sum) drawn++;
        study->mask[list[i].block] = 1;
    }
    drawn = 0;
    for (int64_t b = 0; b < study->count; b++) drawn += study->mask[b];
    return drawn;
}

/* Ratio of actual to estimated errors of the drawn blocks, each weighted by its drawing probability. */
typedef struct Ratio {
    double sum, squares;
    double most; /* ratio of the largest errors */
    int64_t count;
} Ratio;

static void add_probe(const Study *study, const Block *block, const float *fine, double floor_off,
                      Ratio *ratio)
{
    const Change off = wr_study_off(study, block, block->pair, block->pick);
    const Change seen = wr_block_change(fine, block->rgba[block->pick]);
    const double share = seen.squares / (off.squares + floor_off);
    ratio->sum += share;
    ratio->squares += share * share;
    if (off.most > 0) ratio->most = fmax(ratio->most, seen.most / off.most);
    ratio->count++;
}

/* Converts shares of estimate and floor to a factor of the estimate: the floors add up to half of the estimates. */
double wr_study_factor(double shares, double squares, int64_t count)
{
    const double n = (double)count, mean = shares / n;
    const double variance = fmax(0, squares / n - mean * mean) / fmax(1, n - 1);
    return 1.5 * (mean + CAUTION * sqrt(variance));
}

static double cautious(const Ratio *ratio)
{
    const double mean = ratio->sum / (double)ratio->count;
    if (ratio->count < FEW) return 1.5 * mean > FAR ? 1.5 * mean : 1;
    return wr_study_factor(ratio->sum, ratio->squares, ratio->count);
}

static bool render_picks(Study *study, int pick, WrError *err)
{
    unsigned char *chosen = wr_alloc((size_t)study->count, 1);
    bool good = true;
    for (int64_t b = 0; b < study->count; b++) chosen[b] = study->mask[b];
    for (int pair = 0; good && pair < study->pairs; pair++) {
        int64_t missing = 0;
        for (int64_t b = 0; b < study->count; b++) {
            const Block *block = &study->block[b];
            study->mask[b] = chosen[b] && block->pair == pair &&
                             !(block->rgba[pick] && block->pair_of[pick] == pair);
            missing += study->mask[b];
        }
        good = missing == 0 || wr_study_render(study, pair, pick, true, NULL, err);
    }
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = chosen[b];
    wr_free(chosen);
    return good;
}

/* Number of probes: at least one; in total about PROBING of the picture's cost. */
static int64_t probes_wanted(const Study *study, int pick, int64_t count)
{
    const double side = wr_level_side(probe_level[pick]);
    const double one = study->pair[0].price * side * side * WR_FRAME_BLOCK * WR_FRAME_BLOCK;
    const int64_t worth = (int64_t)(PROBING / PROBED * wr_study_cost(study) / one);
    return worth < 1 ? 1 : worth < count ? worth : count;
}

static bool probe_pick(Study *study, int pick, bool *worse, WrError *err)
{
    int64_t count;
    double floor_off;
    Ratio ratio = { 0, 0, 0, 0 };
    Probe *list = list_picked(study, pick, &count);
    const int64_t wanted = (double)count > GROWN * (double)study->doubt[pick].blocks
                               ? probes_wanted(study, pick, count)
                               : 0;
    const int64_t drawn = wanted > 0 ? draw(study, list, count, wanted, &floor_off) : 0;
    wr_free(list);
    if (drawn == 0) return true;
    float *fine = wr_try_alloc((size_t)drawn * BLOCK_FLOATS, sizeof *fine, "blocks", err);
    bool good = fine && render_picks(study, pick, err) &&
                wr_study_render(study, 0, probe_level[pick], false, fine, err);
    const float *at = fine;
    for (int64_t b = 0; good && b < study->count; b++) {
        if (!study->mask[b]) continue;
        add_probe(study, &study->block[b], at, floor_off, &ratio);
        at += BLOCK_FLOATS;
    }
    wr_free(fine);
    if (!good) return false;
    Doubt *doubt = &study->doubt[pick];
    doubt->blocks = count;
    const double factor = cautious(&ratio), before = doubt->weight;
    doubt->weight = fmax(LEAST_WEIGHT, fmin(MOST_WEIGHT, before * factor));
    doubt->weight_most *= fmax(1, ratio.most);
    *worse = *worse || factor > WORSE || ratio.most > WORSE;
    return true;
}

bool wr_study_probe(Study *study, bool *worse, WrError *err)
{

    *worse = false;
    for (int pick = 0; pick < PROBED; pick++)
        if (!probe_pick(study, pick, worse, err)) return false;
    return true;
}
