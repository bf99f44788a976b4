/* What is known of every block, and a sample of them. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define BLOCK WR_FRAME_BLOCK
#define EVENLY 0.35 /* of the sample: what slopes and normals are off is everywhere */
#define FLOOR 0.02  /* of the size, in the change: nothing is known to be exact */

void wr_control_add_up(const Study *study, Control *control)
{
    memset(control->sum, 0, sizeof control->sum);
    for (int64_t b = 0; b < study->block_count; b++)
        control->sum[study->block[b].kind] += (double)control->of[b];
}

void wr_control_strata(const Control *control, double out[STRATA])
{
    memset(out, 0, STRATA * sizeof *out);
    for (int k = 1; k < KINDS; k++) out[wr_stratum(k)] += control->sum[k];
}

void wr_control_fini(Control *control)
{
    wr_free(control->of);
    control->of = NULL;
}

void wr_study_control(Study *study, const float *rgba, Pair *pair)
{
    pair->change.of = wr_alloc((size_t)study->block_count, sizeof(float));
    pair->formula.of = wr_alloc((size_t)study->block_count, sizeof(float));
    for (int64_t b = 0; b < study->block_count; b++) {
        float taken[BLOCK_FLOATS];
        const float *one = wr_packed_block(&study->one, b), *block = rgba ? taken : one;
        if (study->block[b].stratum == STRATUM_EMPTY) continue;
        if (rgba) wr_block_take(study, rgba, b, taken);
        pair->change.of[b] = (float)(wr_block_change(block, wr_packed_block(&study->two, b)) +
                                     FLOOR * (double)study->size.of[b]);
        pair->formula.of[b] = (float)wr_block_change(block, one);
    }
    wr_control_add_up(study, &pair->change);
    wr_control_add_up(study, &pair->formula);
}

double wr_study_formula_rms(const Study *study, const Pair *pair)
{
    double sum = 0;
    for (int k = 1; k < KINDS; k++) sum += pair->formula.sum[k];
    return wr_study_rms(study, sum);
}

/* ---- the sample ---- */

/* Blocks of one stratum, ranked by size, at equal steps of the sizes' running sum: every block is drawn with a
   chance as its size, and stands for the stratum's sum by its inverse. A block that is longer than a step is
   drawn more than once, that is, counts for more. */
static void draw_stratum(Study *study, int stratum, int64_t wanted)
{
    const int64_t all = study->all[stratum];
    Ranked *ranked = wr_study_rank(study, stratum);
    double sum = 0, passed = 0;
    int64_t drawn = 0;
    for (int64_t i = 0; i < all; i++) sum += (double)ranked[i].size;
    for (int64_t i = 0; i < all; i++) {
        Block *block = &study->block[ranked[i].block];
        const double size = (double)ranked[i].size;
        passed += size;
        for (; drawn < wanted && passed >= sum * ((double)drawn + 0.5) / (double)wanted; drawn++)
            block->weight += (float)(sum / (size * (double)wanted));
        block->sampled = block->weight > 0;
    }
    wr_free(ranked);
}

void wr_study_draw(Study *study, double share, int64_t least)
{
    double change[STRATA] = { 0 }, weight[STRATA], sum = 0;
    int64_t all = 0;
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        block->sampled = false;
        block->weight = 0;
        change[block->stratum] += (double)study->size.of[b];
    }
    /* Between as many blocks as there are and as much change as there is. */
    for (int s = 1; s < STRATA; s++) {
        weight[s] = sqrt((double)study->all[s] * change[s]);
        sum += weight[s];
        all += study->all[s];
    }
    study->sample_count = 0;
    memset(study->chosen, 0, sizeof study->chosen);
    for (int s = 1; s < STRATA; s++) {
        if (study->all[s] == 0) continue;
        int64_t wanted = (int64_t)rint(share * (EVENLY * (double)study->all[s] +
                                                (1 - EVENLY) * (double)all * weight[s] / sum));
        wanted = wanted < least ? least : wanted;
        draw_stratum(study, s, wanted < study->all[s] ? wanted : study->all[s]);
    }
    for (int64_t b = 0; b < study->block_count; b++) {
        study->chosen[study->block[b].stratum] += study->block[b].sampled;
        study->sample_count += study->block[b].sampled;
    }
}

size_t wr_study_floats(const Study *study)
{
    return (size_t)study->sample_count * BLOCK_FLOATS;
}

void wr_study_gather(const Study *study, const float *rgba, float *out)
{
    for (int64_t b = 0; b < study->block_count; b++) {
        if (!study->block[b].sampled) continue;
        wr_block_take(study, rgba, b, out);
        out += BLOCK_FLOATS;
    }
}

void wr_study_gather_packed(const Study *study, const Packed *packed, float *out)
{
    for (int64_t b = 0; b < study->block_count; b++) {
        if (!study->block[b].sampled) continue;
        memcpy(out, wr_packed_block(packed, b), BLOCK_FLOATS * sizeof *out);
        out += BLOCK_FLOATS;
    }
}

/* Sums over a stratum's drawn blocks, each with its weight: of the error t and of the control c. */
typedef struct Sums {
    double t, c, tt, tc, cc;
    int64_t count;
} Sums;

/* Standard error of t/c from what is left of each block, t - (t/c) c: by linearisation. Of few blocks that is
   itself uncertain. */
static double spread_of(const Sums *sums)
{
    if (sums->count < 2 || !(sums->c > 0)) return 0;
    const double n = (double)sums->count, r = sums->t / sums->c;
    const double rest = fmax(0, sums->tt - 2 * r * sums->tc + r * r * sums->cc);
    return sqrt(n / (n - 1) * (1 + 4 / n) * rest) / sums->c;
}

void wr_study_compare(const Study *study, const float *a, const float *b, const float *control,
                      Rate *out)
{
    Sums sums[STRATA] = { { 0 } };
    *out = (Rate){ 0 };
    for (int64_t i = 0; i < study->block_count; i++) {
        const Block *block = &study->block[i];
        if (!block->sampled) continue;
        Sums *of = &sums[block->stratum];
        double t = 0;
        float most = 0;
        for (size_t n = 0; n < BLOCK_FLOATS; n += 4)
            for (int c = 0; c < 3; c++) {
                const float d = a[n + (size_t)c] - b[n + (size_t)c];
                t += (double)(d * d);
                most = fabsf(d) > most ? fabsf(d) : most;
            }
        out->most[block->stratum] = fmax(out->most[block->stratum], (double)most);
        t *= (double)block->weight;
        const double c = (double)block->weight * (double)control[i];
        of->t += t, of->c += c, of->tt += t * t, of->tc += t * c, of->cc += c * c;
        of->count++;
        a += BLOCK_FLOATS;
        b += BLOCK_FLOATS;
    }
    for (int s = 1; s < STRATA; s++) {
        out->ratio[s] = sums[s].c > 0 ? sums[s].t / sums[s].c : 0;
        out->spread[s] = study->chosen[s] < study->all[s] ? spread_of(&sums[s]) : 0;
        out->weighed[s] = sums[s].c;
    }
}

/* Is this pixel half covered, exactly as the one before it? */
static bool runs_on(const float *p, const float *before)
{
    return p[3] > 0 && p[3] < 1 && p[3] == before[3];
}

void wr_study_aligned(const Study *study, const float *rgba, int k, double squares[STRATA])
{
    memset(squares, 0, STRATA * sizeof *squares);
    for (int64_t i = 0; i < study->block_count; i++) {
        const Block *block = &study->block[i];
        if (!block->sampled) continue;
        for (int y = 0; y < BLOCK; y++)
            for (int x = 0; x < BLOCK; x++) {
                const float *p = rgba + 4 * (y * BLOCK + x);
                if (!(x > 0 && runs_on(p, p - 4)) && !(y > 0 && runs_on(p, p - 4 * BLOCK)))
                    continue;
                /* The object's own colour there, off by at most 1/(2k): between that, squared, and the mean
                   square of what is uniform within it. */
                for (int c = 0; c < 3; c++) {
                    const double colour = (double)p[c] / (double)p[3];
                    squares[block->stratum] +=
                        (double)block->weight * colour * colour / (6.0 * k * k);
                }
            }
        rgba += BLOCK_FLOATS;
    }
}
