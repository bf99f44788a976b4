/* The kinds of blocks that a picture has, and a sample of them. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK WR_FRAME_BLOCK
#define PACKED ((size_t)4 * BLOCK * BLOCK) /* floats a block */
#define EVENLY 0.35 /* of the sample: what slopes and normals are off is everywhere */
#define FEW 0.04    /* of the blocks: not a kind of its own */
#define LEAST 4     /* blocks of a kind */

/* What 2 x 2 samples change, root mean square of linear intensity, where one kind ends. */
static const double lively_edge = 0.08;
static const double lively_inside[] = { 0.0015, 0.006, 0.02, 0.06 };

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

static const float *pixel(const WrFrame *frame, int x, int y)
{
    return frame->rgba + 4 * ((size_t)y * (size_t)frame->width + (size_t)x);
}

static double difference(const float *p, const float *q)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const double d = (double)p[c] - (double)q[c];
        sum += d * d;
    }
    return sum;
}

/* What changed in the block. Is one of its pixels, or one next to it, on the other side of the outline? The
   sample in the middle of a pixel does not see an edge that passes beside it, its neighbour does. */
static bool survey(const float *one, const WrFrame *two, Corner at, Block *block)
{
    int inside = 0, outside = 0;
    for (int y = at.y - 1; y <= at.y + at.h; y++)
        for (int x = at.x - 1; x <= at.x + at.w; x++) {
            if (x < 0 || y < 0 || x >= two->width || y >= two->height) continue;
            const size_t n = 4 * ((size_t)y * (size_t)two->width + (size_t)x);
            const bool own = x >= at.x && y >= at.y && x < at.x + at.w && y < at.y + at.h;
            const float covered = two->rgba[n + 3];
            inside += one[n + 3] > 0 || covered > 0;
            outside += one[n + 3] <= 0 || covered < 1;
            if (!own) continue;
            block->covered += one[n + 3] > 0;
            block->change += difference(one + n, two->rgba + n);
        }
    return inside > 0 && outside > 0;
}

static int kind_of(const Block *block, bool edge, Corner at)
{
    if (!edge && block->covered == 0) return KIND_EMPTY;
    const double lively = sqrt(block->change / (3.0 * at.w * at.h));
    if (edge) return KIND_EDGE + (lively > lively_edge);
    int kind = KIND_INSIDE;
    for (size_t i = 0; i < sizeof lively_inside / sizeof *lively_inside; i++)
        kind += lively > lively_inside[i];
    return kind;
}

/* Kinds of few blocks join their livelier neighbours: each costs a least number of drawn ones. The last
   joins the one before. */
static void merge(const int64_t blocks[WR_CHOICE_KINDS], int first, int last,
                  int to[WR_CHOICE_KINDS])
{
    int64_t all = 0, held = 0;
    int kept = -1;
    for (int k = 1; k < WR_CHOICE_KINDS; k++) all += blocks[k];
    const double few = FEW * (double)all;
    for (int k = first; k <= last; k++) {
        held += blocks[k];
        to[k] = k;
        if ((double)held <= few) continue;
        for (int i = kept < 0 ? first : kept + 1; i <= k; i++) to[i] = k;
        kept = k;
        held = 0;
    }
    for (int i = kept < 0 ? first : kept + 1; i <= last; i++) to[i] = kept < 0 ? last : kept;
}

static void merge_kinds(Study *study)
{
    int to[WR_CHOICE_KINDS] = { 0 };
    merge(study->blocks, KIND_EDGE, KIND_INSIDE - 1, to);
    merge(study->blocks, KIND_INSIDE, WR_CHOICE_KINDS - 1, to);
    memset(study->blocks, 0, sizeof study->blocks);
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        block->kind = (unsigned char)to[block->kind];
        study->blocks[block->kind]++;
    }
}

void wr_study_sort(Study *study, const WrFrame *two)
{
    double change[WR_CHOICE_KINDS] = { 0 };
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        const Corner at = corner_of(study, b);
        *block = (Block){ 0 };
        const bool edge = survey(study->one, two, at, block);
        block->kind = (unsigned char)kind_of(block, edge, at);
        study->blocks[block->kind]++;
        study->pixels += block->covered;
    }
    merge_kinds(study);
    for (int64_t b = 0; b < study->block_count; b++)
        change[study->block[b].kind] += study->block[b].change;
    /* Calm blocks are drawn too: some of what 2 x 2 samples show as calm is not. */
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        const double mean = change[block->kind] / (double)study->blocks[block->kind];
        block->size = (float)(block->change + 0.5 * mean + 1e-12);
    }
}

/* ---- the sample ---- */

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

/* Blocks of one kind, ranked by size, at equal steps of the sizes' running sum: every block is drawn with a
   chance as its size, and stands for the kind's sum by its inverse. A block that is longer than a step is
   drawn more than once, that is, counts for more. */
static void draw_kind(Study *study, int kind, int64_t wanted)
{
    const int64_t all = study->blocks[kind];
    Ranked *ranked = wr_alloc((size_t)all, sizeof *ranked);
    double sum = 0, passed = 0;
    int64_t n = 0, drawn = 0;
    for (int64_t b = 0; b < study->block_count; b++)
        if (study->block[b].kind == kind) {
            ranked[n++] = (Ranked){ study->block[b].size, b };
            sum += (double)study->block[b].size;
        }
    qsort(ranked, (size_t)n, sizeof *ranked, by_size);
    for (int64_t i = 0; i < n; i++) {
        Block *block = &study->block[ranked[i].block];
        passed += (double)block->size;
        for (; drawn < wanted && passed >= sum * ((double)drawn + 0.5) / (double)wanted; drawn++)
            block->weight += (float)(sum / ((double)block->size * (double)wanted));
        block->sampled = block->weight > 0;
    }
    wr_free(ranked);
}

void wr_study_draw(Study *study, double share)
{
    double change[WR_CHOICE_KINDS] = { 0 }, weight[WR_CHOICE_KINDS], sum = 0;
    int64_t all = 0;
    for (int64_t b = 0; b < study->block_count; b++) {
        Block *block = &study->block[b];
        block->sampled = false;
        block->weight = 0;
        change[block->kind] += (double)block->size;
    }
    /* Between as many blocks as there are and as much change as there is. */
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        weight[k] = sqrt((double)study->blocks[k] * change[k]);
        sum += weight[k];
        all += study->blocks[k];
    }
    study->sample_count = 0;
    memset(study->chosen, 0, sizeof study->chosen);
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        int64_t wanted = (int64_t)rint(share * (EVENLY * (double)study->blocks[k] +
                                                (1 - EVENLY) * (double)all * weight[k] / sum));
        wanted = wanted < LEAST ? LEAST : wanted;
        draw_kind(study, k, wanted < study->blocks[k] ? wanted : study->blocks[k]);
    }
    for (int64_t b = 0; b < study->block_count; b++) {
        study->chosen[study->block[b].kind] += study->block[b].sampled;
        study->sample_count += study->block[b].sampled;
    }
}

size_t wr_study_floats(const Study *study)
{
    return (size_t)study->sample_count * PACKED;
}

void wr_study_gather(const Study *study, const WrFrame *frame, float *out)
{
    for (int64_t b = 0; b < study->block_count; b++) {
        if (!study->block[b].sampled) continue;
        const Corner at = corner_of(study, b);
        memset(out, 0, PACKED * sizeof *out);
        for (int y = 0; y < at.h; y++)
            memcpy(out + (size_t)4 * BLOCK * (size_t)y, pixel(frame, at.x, at.y + y),
                   (size_t)at.w * 4 * sizeof *out);
        out += PACKED;
    }
}

/* What a kind's drawn blocks say of its sum, each for itself: their mean, and how uncertain that is. */
typedef struct Sum {
    double sum, squares;
    int64_t count;
} Sum;

static double variance_of(const Sum *sum)
{
    if (sum->count < 2) return 0;
    const double n = (double)sum->count; /* the n estimates are n * part */
    return fmax(0, n * sum->squares - sum->sum * sum->sum) / (n - 1);
}

void wr_study_compare(const Study *study, const float *a, const float *b, Measure *out)
{
    Sum sums[WR_CHOICE_KINDS] = { { 0 } };
    *out = (Measure){ 0 };
    for (int64_t i = 0; i < study->block_count; i++) {
        const Block *block = &study->block[i];
        if (!block->sampled) continue;
        Sum *of_kind = &sums[block->kind];
        double sum = 0;
        for (size_t n = 0; n < PACKED; n++) {
            if (n % 4 == 3) continue;
            const double d = (double)a[n] - (double)b[n];
            sum += d * d;
            out->most[block->kind] = fmax(out->most[block->kind], fabs(d));
        }
        sum *= (double)block->weight;
        of_kind->sum += sum;
        of_kind->squares += sum * sum;
        of_kind->count++;
        a += PACKED;
        b += PACKED;
    }
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        out->sum[k] = sums[k].sum;
        out->variance[k] = study->chosen[k] < study->blocks[k] ? variance_of(&sums[k]) : 0;
    }
}

void wr_study_whole(const Study *study, const WrFrame *frame, double squares[WR_CHOICE_KINDS])
{
    memset(squares, 0, WR_CHOICE_KINDS * sizeof *squares);
    for (int64_t b = 0; b < study->block_count; b++) {
        const Corner at = corner_of(study, b);
        for (int y = at.y; y < at.y + at.h; y++)
            for (int x = at.x; x < at.x + at.w; x++) {
                const size_t n = 4 * ((size_t)y * (size_t)frame->width + (size_t)x);
                squares[study->block[b].kind] += difference(study->one + n, frame->rgba + n);
            }
    }
}

/* Is this pixel half covered, exactly as the one before it? */
static bool runs_on(const float *p, const float *before)
{
    return p[3] > 0 && p[3] < 1 && p[3] == before[3];
}

void wr_study_aligned(const Study *study, const float *rgba, int k, double squares[WR_CHOICE_KINDS])
{
    memset(squares, 0, WR_CHOICE_KINDS * sizeof *squares);
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
                    squares[block->kind] += (double)block->weight * colour * colour / (6.0 * k * k);
                }
            }
        rgba += PACKED;
    }
}
