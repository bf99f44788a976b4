/* Choice of the cheapest pair and level for each block that together meet the tolerance. */
#include "accuracy/tolerance_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

#define MARGIN_RMS 0.93 /* parts of the tolerance that are used */
#define MARGIN_MAX 0.75
#define SCATTERED                                                                                  \
    0.12 /* of the time: blocks of several settings are scattered, and short rows are slower */

#define OPTIONS (PAIRS_MAX * LEVELS)

typedef struct Option {
    int pair, level;
    double cost;
    Change off;
} Option;

static double cost_of(const Study *study, const Block *block, int pair, int level)
{
    const double side = wr_level_side(level);
    return study->pair[pair].price * side * side * fmax(1, block->covered);
}

static int list_options(const Study *study, const Block *block, bool free_pairs,
                        Option out[OPTIONS])
{
    int count = 0;
    for (int pair = 0; pair < study->pairs; pair++)
        for (int level = 0; level < LEVELS; level++) {
            if (!free_pairs && pair != block->pair) continue;
            out[count++] = (Option){ pair, level, cost_of(study, block, pair, level),
                                     wr_study_off(study, block, pair, level) };
        }
    return count;
}

static void take(Block *block, const Option *option)
{
    block->pair = (signed char)option->pair;
    block->pick = (signed char)option->level;
}

/* ---- largest error: each cell separately ---- */

/* The next level's largest change is a poor estimate of the worst pixel if pixels are few: four blocks, two by
   two, get the finest level that one of them needs. */
#define CELL 2

static void raise_cell(Study *study, int u, int v)
{
    Block *highest = NULL;
    for (int pass = 0; pass < 2; pass++)
        for (int y = v; y < v + CELL && y < study->blocks_v; y++)
            for (int x = u; x < u + CELL && x < study->blocks_u; x++) {
                Block *block = &study->block[(int64_t)y * study->blocks_u + x];
                if (!block->shown) continue;
                if (pass > 0) {
                    block->pick = highest->pick;
                    block->pair = highest->pair;
                } else if (!highest || block->pick > highest->pick) {
                    highest = block;
                }
            }
}

/* Each block gets the cheapest option whose largest error is within the limit; if there is none, the most
   accurate. */
static void pick_most(Study *study, double most, bool free_pairs)
{
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        Option options[OPTIONS];
        if (!block->shown) continue;
        const int count = list_options(study, block, free_pairs, options);
        const Option *best = NULL, *nearest = &options[0];
        for (int i = 0; i < count; i++) {
            if (options[i].off.most < nearest->off.most) nearest = &options[i];
            if (options[i].off.most <= most && (!best || options[i].cost < best->cost))
                best = &options[i];
        }
        take(block, best ? best : nearest);
    }
    for (int v = 0; v < study->blocks_v; v += CELL)
        for (int u = 0; u < study->blocks_u; u += CELL) raise_cell(study, u, v);
}

/* ---- sum of errors: by gain per price ---- */

/* A step of a block to a more expensive option, on the lower hull of cost and error. */
typedef struct Step {
    int64_t block;
    Option to;
    double gain; /* decrease of squares per price */
    double more; /* price */
    double less; /* squares */
} Step;

static int by_cost(const void *a, const void *b)
{
    const Option *x = a, *y = b;
    if (x->cost != y->cost) return x->cost < y->cost ? -1 : 1;
    return (x->off.squares > y->off.squares) - (x->off.squares < y->off.squares);
}

static int by_gain(const void *a, const void *b)
{
    const Step *x = a, *y = b;
    if (x->gain != y->gain) return x->gain > y->gain ? -1 : 1;
    if (x->block != y->block) return x->block < y->block ? -1 : 1;
    return (x->to.cost > y->to.cost) - (x->to.cost < y->to.cost);
}

static double gain_of(const Option *from, const Option *to)
{
    return (from->off.squares - to->off.squares) / fmax(to->cost - from->cost, 1e-300);
}

/* Sorts options by cost; moves those on the lower convex hull to the front. Returns their number. */
static int hull(Option *options, int count)
{
    int kept = 0;
    qsort(options, (size_t)count, sizeof *options, by_cost);
    for (int i = 0; i < count; i++) {
        if (kept > 0 && options[i].off.squares >= options[kept - 1].off.squares) continue;
        while (kept > 1 && gain_of(&options[kept - 2], &options[kept - 1]) <=
                               gain_of(&options[kept - 2], &options[i]))
            kept--;
        options[kept++] = options[i];
    }
    return kept;
}

/* Sets every block to its cheapest option, and lists all steps from there, largest gain first. */
static Step *list_steps(Study *study, bool free_pairs, int64_t *count, Option *sum)
{
    Step *steps = wr_alloc((size_t)study->count * OPTIONS + 1, sizeof *steps);
    *count = 0;
    *sum = (Option){ 0, 0, 0, { 0, 0 } };
    for (int64_t b = 0; b < study->count; b++) {
        Option options[OPTIONS];
        if (!study->block[b].shown) continue;
        const int kept = hull(options, list_options(study, &study->block[b], free_pairs, options));
        take(&study->block[b], &options[0]);
        sum->cost += options[0].cost;
        sum->off.squares += options[0].off.squares;
        for (int i = 1; i < kept; i++)
            steps[(*count)++] = (Step){ b, options[i], gain_of(&options[i - 1], &options[i]),
                                        options[i].cost - options[i - 1].cost,
                                        options[i - 1].off.squares - options[i].off.squares };
    }
    qsort(steps, (size_t)*count, sizeof *steps, by_gain);
    return steps;
}

/* One setting for all that meets `squares` for less than `cost`, or -1. */
static int find_uniform(const Study *study, double squares, double cost)
{
    int found = -1;
    for (int at = 0; at < study->pairs * LEVELS; at++) {
        Option sum = { 0, 0, 0, { 0, 0 } };
        for (int64_t b = 0; b < study->count; b++) {
            const Block *block = &study->block[b];
            if (!block->shown) continue;
            sum.cost += cost_of(study, block, at / LEVELS, at % LEVELS);
            sum.off.squares += wr_study_off(study, block, at / LEVELS, at % LEVELS).squares;
        }
        if (sum.off.squares > squares || sum.cost >= cost) continue;
        cost = sum.cost;
        found = at;
    }
    return found;
}

/* Greedy: steps by decreasing gain until the sum of squares is small enough. On a convex hull the gains of one
   block's steps decrease, so its steps are taken in order. */
static void pick_sum(Study *study, double squares, bool free_pairs)
{
    Option sum;
    int64_t count;
    Step *steps = list_steps(study, free_pairs, &count, &sum);
    for (int64_t i = 0; i < count && sum.off.squares > squares; i++) {
        take(&study->block[steps[i].block], &steps[i].to);
        sum.off.squares -= steps[i].less;
    }
    wr_free(steps);
    const int all = free_pairs ? find_uniform(study, squares, wr_study_cost(study)) : -1;
    for (int64_t b = 0; all >= 0 && b < study->count; b++)
        if (study->block[b].shown)
            take(&study->block[b], &(Option){ all / LEVELS, all % LEVELS, 0, { 0, 0 } });
}

/* Greedy, as pick_sum, until the next step would exceed the cost. */
static void pick_within(Study *study, double cost, bool free_pairs)
{
    Option sum;
    int64_t count;
    Step *steps = list_steps(study, free_pairs, &count, &sum);
    cost /= 1 + SCATTERED;
    for (int64_t i = 0; i < count && sum.cost + steps[i].more <= cost; i++) {
        take(&study->block[steps[i].block], &steps[i].to);
        sum.cost += steps[i].more;
    }
    wr_free(steps);
}

/* ---- whole pick ---- */

void wr_study_pick(Study *study, const WrTolerance *tolerance, bool free_pairs)
{
    const double value = tolerance->value, rms = MARGIN_RMS * value;
    if (tolerance->kind == WR_TOLERANCE_MAX) pick_most(study, MARGIN_MAX * value, free_pairs);
    else if (tolerance->kind == WR_TOLERANCE_TIME) pick_within(study, value, free_pairs);
    else pick_sum(study, rms * rms * 3 * fmax(study->pixels, 1), free_pairs);
}

/* Several settings need a pass over the pixels for each, and their blocks are scattered. */
double wr_study_cost(const Study *study)
{
    bool used[OPTIONS] = { false };
    double sum = 0;
    int passes = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown) continue;
        const int at = block->pair * LEVELS + block->pick;
        sum += cost_of(study, block, block->pair, block->pick);
        passes += !used[at];
        used[at] = true;
    }
    const int64_t pixels = (int64_t)study->request->width * study->request->height;
    return passes > 1 ? (1 + SCATTERED) * sum + (passes - 1) * wr_price_pass(pixels) : sum;
}

Change wr_study_picked_off(const Study *study)
{
    Change sum = { 0, 0 };
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown) continue;
        const Change off = wr_study_off(study, block, block->pair, block->pick);
        sum.squares += off.squares;
        sum.most = fmax(sum.most, off.most);
    }
    return sum;
}
