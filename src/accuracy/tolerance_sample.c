/* The kinds of blocks that a picture has, what is known of every one, and a sample of them. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK WR_FRAME_BLOCK
#define PACKED ((size_t)4 * BLOCK * BLOCK) /* floats a block */
#define EVENLY 0.35 /* of the sample: what slopes and normals are off is everywhere */
#define FEW 0.04    /* of the blocks: not a stratum of its own */
#define LEAST 4     /* blocks of a stratum */
#define FLOOR 0.02  /* of the size, in the change: nothing is known to be exact */

/* What 2 x 2 samples change, root mean square of linear intensity, where one stratum ends. */
static const double lively_edge = 0.08;
static const double lively_inside[] = { 0.0015, 0.006, 0.02, 0.06 };

/* Of a stratum's blocks, from the liveliest, what the first grades hold. */
static const double grade_ends[GRADES] = { 0.02, 0.05, 0.12, 0.25, 0.5, 1 };

typedef struct Corner {
    int x, y, w, h; /* of a block, pixels */
} Corner;

static Corner corner_of(const Study *study, int64_t block)
{
    const WrFrameRequest *request = study->request;
    Corner at = { (int)(block % study->blocks_u) * BLOCK, (int)(block / study->blocks_u) * BLOCK, 0,
                  0 };
    at.w = request->width - at.x < BLOCK ? request->width - at.x : BLOCK;
    at.h = request->height - at.y < BLOCK ? request->height - at.y : BLOCK;
    return at;
}

static size_t pixel(const Study *study, int x, int y)
{
    return 4 * ((size_t)y * (size_t)study->request->width + (size_t)x);
}

/* Squared differences of R, G, B over a block. */
static double change_of(const Study *study, const float *a, const float *b, Corner at)
{
    double sum = 0;
    for (int y = at.y; y < at.y + at.h; y++) {
        const float *p = a + pixel(study, at.x, y), *q = b + pixel(study, at.x, y);
        float row[4] = { 0 };
        for (int x = 0; x < at.w; x++)
            for (int c = 0; c < 4; c++) {
                const float d = p[4 * x + c] - q[4 * x + c];
                row[c] += d * d;
            }
        sum += (double)(row[0] + row[1] + row[2]);
    }
    return sum;
}

/* ---- strata ---- */

/* Is one of the block's pixels, or one next to it, on the other side of the outline? The sample in the middle
   of a pixel does not see an edge that passes beside it, its neighbour does. */
static bool survey(const Study *study, Corner at, Block *block)
{
    const WrFrameRequest *request = study->request;
    const int x0 = at.x > 0 ? at.x - 1 : 0, y0 = at.y > 0 ? at.y - 1 : 0;
    const int x1 = at.x + at.w < request->width ? at.x + at.w + 1 : request->width;
    const int y1 = at.y + at.h < request->height ? at.y + at.h + 1 : request->height;
    bool inside = false, outside = false;
    for (int y = y0; y < y1; y++) {
        const float *one = study->one + pixel(study, x0, y),
                    *two = study->two + pixel(study, x0, y);
        for (int x = 0; x < x1 - x0; x++) {
            inside |= (one[4 * x + 3] > 0) | (two[4 * x + 3] > 0);
            outside |= (one[4 * x + 3] <= 0) | (two[4 * x + 3] < 1);
        }
    }
    for (int y = at.y; y < at.y + at.h; y++)
        for (int x = at.x; x < at.x + at.w; x++)
            block->covered += study->one[pixel(study, x, y) + 3] > 0;
    return inside && outside;
}

static int stratum_of(const Block *block, bool edge, double change, Corner at)
{
    if (!edge && block->covered == 0) return STRATUM_EMPTY;
    const double lively = sqrt(change / (3.0 * at.w * at.h));
    if (edge) return STRATUM_EDGE + (lively > lively_edge);
    int stratum = STRATUM_INSIDE;
    for (size_t i = 0; i < sizeof lively_inside / sizeof *lively_inside; i++)
        stratum += lively > lively_inside[i];
    return stratum;
}

/* Strata of few blocks join their livelier neighbours: each costs a least number of drawn ones. The last
   joins the one before. */
static void merge(const int64_t blocks[STRATA], int first, int last, int to[STRATA])
{
    int64_t all = 0, held = 0;
    int kept = -1;
    for (int s = 1; s < STRATA; s++) all += blocks[s];
    const double few = FEW * (double)all;
    for (int s = first; s <= last; s++) {
        held += blocks[s];
        to[s] = s;
        if ((double)held <= few) continue;
        for (int i = kept < 0 ? first : kept + 1; i <= s; i++) to[i] = s;
        kept = s;
        held = 0;
    }
    for (int i = kept < 0 ? first : kept + 1; i <= last; i++) to[i] = kept < 0 ? last : kept;
}

static void merge_strata(Study *study)
{
    int to[STRATA] = { 0 };
    merge(study->all, STRATUM_EDGE, STRATUM_INSIDE - 1, to);
    merge(study->all, STRATUM_INSIDE, STRATA - 1, to);
    memset(study->all, 0, sizeof study->all);
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        block->stratum = (unsigned char)to[block->stratum];
        study->all[block->stratum]++;
    }
}

/* ---- what is known of every block ---- */

/* What 2 x 2 samples may be off where the outline steps from p to the next pixel across it and does just the same
   beside: of the object's colour 1/4 at most, evenly. A channel's squares. */
static double step_off(const float *p, const float *across, const float *p_beside,
                       const float *across_beside)
{
    double sum = 0;
    if (p[3] == across[3] || p[3] != p_beside[3] || across[3] != across_beside[3]) return 0;
    const float *in = p[3] > across[3] ? p : across;
    for (int c = 0; c < 3; c++) {
        const double colour = (double)in[c] / (double)in[3];
        sum += colour * colour / 48;
    }
    return sum;
}

/* Do outlines run with the rows or the columns here? Then every pixel along them has the same coverage, and
   what two counts of samples agree on may be off all the same. */
static double aligned(const Study *study, Corner at)
{
    const WrFrameRequest *request = study->request;
    double sum = 0;
    for (int y = at.y; y < at.y + at.h && y + 1 < request->height; y++)
        for (int x = at.x; x < at.x + at.w && x + 1 < request->width; x++) {
            const float *p = study->two + pixel(study, x, y);
            const float *right = p + 4, *down = study->two + pixel(study, x, y + 1);
            sum += step_off(p, right, down, down + 4) + step_off(p, down, right, down + 4);
        }
    return sum;
}

static void add_up(const Study *study, Control *control)
{
    memset(control->sum, 0, sizeof control->sum);
    for (int64_t b = 0; b < study->block_count; b++)
        control->sum[study->block[b].kind] += (double)control->of[b];
}

void wr_control_fini(Control *control)
{
    wr_free(control->of);
    control->of = NULL;
}

typedef struct Ranked {
    float size;
    int64_t block;
} Ranked;

static int by_size(const void *a, const void *b)
{
    const Ranked *x = a, *y = b;
    if (x->size != y->size) return x->size < y->size ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

/* A stratum's blocks, small to large; the caller frees. */
static Ranked *rank(const Study *study, int stratum)
{
    Ranked *ranked = wr_alloc((size_t)study->all[stratum] + 1, sizeof *ranked);
    int64_t n = 0;
    for (int64_t b = 0; b < study->block_count; b++)
        if (study->block[b].stratum == stratum) ranked[n++] = (Ranked){ study->size.of[b], b };
    qsort(ranked, (size_t)n, sizeof *ranked, by_size);
    return ranked;
}

static void grade(Study *study)
{
    memset(study->blocks, 0, sizeof study->blocks);
    memset(study->covered, 0, sizeof study->covered);
    for (int s = 1; s < STRATA; s++) {
        const int64_t all = study->all[s];
        Ranked *ranked = rank(study, s);
        for (int64_t i = 0; i < all; i++) {
            const double share = ((double)(all - 1 - i) + 0.5) / (double)all;
            int g = 0;
            while (g < GRADES - 1 && share > grade_ends[g]) g++;
            study->block[ranked[i].block].kind = (unsigned char)wr_kind(s, g);
        }
        wr_free(ranked);
    }
    for (int64_t b = 0; b < study->block_count; b++) {
        study->blocks[study->block[b].kind]++;
        study->covered[study->block[b].kind] += study->block[b].covered;
    }
}

double wr_study_sort(Study *study)
{
    double change[STRATA] = { 0 }, sum = 0;
    float *size = study->size.of = wr_alloc((size_t)study->block_count, sizeof *size);
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        const Corner at = corner_of(study, b);
        *block = (Block){ 0 };
        const bool edge = survey(study, at, block);
        size[b] = (float)change_of(study, study->one, study->two, at);
        sum += (double)size[b];
        block->stratum = (unsigned char)stratum_of(block, edge, (double)size[b], at);
        /* One sample changes that into 2 x 2 by three times what those are off. */
        if (edge) size[b] += (float)(3 * aligned(study, at));
        study->all[block->stratum]++;
        study->pixels += block->covered;
    }
    merge_strata(study);
    for (int64_t b = 0; b < study->block_count; b++)
        change[study->block[b].stratum] += (double)size[b];
    /* Calm blocks are drawn too: some of what 2 x 2 samples show as calm is not. */
    for (int64_t b = 0; b < study->block_count; b++) {
        const int s = study->block[b].stratum;
        size[b] += (float)(0.5 * change[s] / (double)study->all[s] + 1e-12);
    }
    grade(study);
    add_up(study, &study->size);
    return sqrt(sum / (3 * fmax(study->pixels, 1)));
}

void wr_study_control(Study *study, const float *rgba, Pair *pair)
{
    pair->change.of = wr_alloc((size_t)study->block_count, sizeof(float));
    pair->formula.of = wr_alloc((size_t)study->block_count, sizeof(float));
    for (int64_t b = 0; b < study->block_count; b++) {
        if (study->block[b].stratum == STRATUM_EMPTY) continue;
        const Corner at = corner_of(study, b);
        const double least = FLOOR * (double)study->size.of[b];
        pair->change.of[b] = (float)(change_of(study, rgba, study->two, at) + least);
        pair->formula.of[b] = (float)change_of(study, rgba, study->one, at);
    }
    add_up(study, &pair->change);
    add_up(study, &pair->formula);
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
    Ranked *ranked = rank(study, stratum);
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

void wr_study_draw(Study *study, double share)
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
        wanted = wanted < LEAST ? LEAST : wanted;
        draw_stratum(study, s, wanted < study->all[s] ? wanted : study->all[s]);
    }
    for (int64_t b = 0; b < study->block_count; b++) {
        study->chosen[study->block[b].stratum] += study->block[b].sampled;
        study->sample_count += study->block[b].sampled;
    }
}

size_t wr_study_floats(const Study *study)
{
    return (size_t)study->sample_count * PACKED;
}

void wr_study_gather(const Study *study, const float *rgba, float *out)
{
    for (int64_t b = 0; b < study->block_count; b++) {
        if (!study->block[b].sampled) continue;
        const Corner at = corner_of(study, b);
        memset(out, 0, PACKED * sizeof *out);
        for (int y = 0; y < at.h; y++)
            memcpy(out + (size_t)4 * BLOCK * (size_t)y, rgba + pixel(study, at.x, at.y + y),
                   (size_t)at.w * 4 * sizeof *out);
        out += PACKED;
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
        for (size_t n = 0; n < PACKED; n += 4)
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
        a += PACKED;
        b += PACKED;
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
        rgba += PACKED;
    }
}
