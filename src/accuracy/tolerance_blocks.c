/* A picture as blocks, and the strata and kinds that those are sorted into. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK WR_FRAME_BLOCK
#define FEW 0.04 /* of the blocks: not a stratum of its own */

/* What 2 x 2 samples change, root mean square of linear intensity, where one stratum ends. */
static const double lively_edge = 0.08;
static const double lively_inside[] = { 0.0015, 0.006, 0.02, 0.06 };

/* Of a stratum's blocks, from the liveliest, what the first grades hold. */
static const double grade_ends[GRADES] = { 0.02, 0.05, 0.12, 0.25, 0.5, 1 };

/* ---- blocks of pixels ---- */

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

void wr_block_take(const Study *study, const float *rgba, int64_t block, float *out)
{
    const Corner at = corner_of(study, block);
    const size_t wide = (size_t)study->request->width;
    if (at.w < BLOCK || at.h < BLOCK) memset(out, 0, BLOCK_FLOATS * sizeof *out);
    for (int y = 0; y < at.h; y++)
        memcpy(out + (size_t)4 * BLOCK * (size_t)y,
               rgba + 4 * ((size_t)(at.y + y) * wide + (size_t)at.x),
               (size_t)at.w * 4 * sizeof *out);
}

double wr_block_change(const float *a, const float *b)
{
    double sum = 0;
    for (size_t n = 0; n < BLOCK_FLOATS; n += (size_t)4 * BLOCK) {
        float row[4] = { 0 };
        for (size_t x = n; x < n + (size_t)4 * BLOCK; x += 4)
            for (size_t c = 0; c < 4; c++) {
                const float d = a[x + c] - b[x + c];
                row[c] += d * d;
            }
        sum += (double)(row[0] + row[1] + row[2]);
    }
    return sum;
}

static bool shows(const Study *study, const float *rgba, int64_t block)
{
    const Corner at = corner_of(study, block);
    const size_t wide = (size_t)study->request->width;
    for (int y = at.y; y < at.y + at.h; y++)
        for (int x = at.x; x < at.x + at.w; x++)
            if (rgba[4 * ((size_t)y * wide + (size_t)x) + 3] > 0) return true;
    return false;
}

bool wr_packed_make(const Study *study, const float *rgba, Packed *out, WrError *err)
{
    int64_t count = 0;
    out->place = wr_alloc((size_t)study->block_count, sizeof *out->place);
    for (int64_t b = 0; b < study->block_count; b++)
        out->place[b] = shows(study, rgba, b) ? count++ : -1;
    out->rgba = wr_try_alloc((size_t)count + 1, BLOCK_FLOATS * sizeof *out->rgba, "picture", err);
    for (int64_t b = 0; out->rgba && b < study->block_count; b++)
        if (out->place[b] >= 0)
            wr_block_take(study, rgba, b, out->rgba + (size_t)out->place[b] * BLOCK_FLOATS);
    return out->rgba != NULL;
}

const float *wr_packed_block(const Packed *packed, int64_t block)
{
    static const float nothing[BLOCK_FLOATS];
    const int64_t place = packed->place[block];
    return place < 0 ? nothing : packed->rgba + (size_t)place * BLOCK_FLOATS;
}

void wr_packed_fini(Packed *packed)
{
    wr_free(packed->rgba);
    wr_free(packed->place);
    *packed = (Packed){ NULL, NULL };
}

/* ---- outlines ---- */

enum { NOTHING = 1, OBJECT = 2 }; /* and both */

/* What a pixel shows, whose coverages are those: the sample in its middle does not see an edge that passes
   beside it, the others do. */
static int look(float one, float two)
{
    return (one > 0 || two > 0 ? OBJECT : 0) | (one <= 0 || two < 1 ? NOTHING : 0);
}

/* What the block shows; its pixels that the first picture covers are counted. */
static int look_at(const Study *study, int64_t b, Block *block)
{
    const float *one = wr_packed_block(&study->one, b), *two = wr_packed_block(&study->two, b);
    const Corner at = corner_of(study, b);
    int seen = 0;
    for (int y = 0; y < at.h; y++)
        for (int x = 0; x < at.w; x++) {
            const size_t n = (size_t)4 * (size_t)(y * BLOCK + x) + 3;
            seen |= look(one[n], two[n]);
            block->covered += one[n] > 0;
        }
    return seen;
}

/* What the pixels next to a block show. */
static int look_around(const Study *study, int64_t b)
{
    const Corner at = corner_of(study, b);
    int seen = 0;
    for (int y = at.y - 1; y <= at.y + at.h; y++) {
        const bool beside = y >= at.y && y < at.y + at.h;
        for (int x = at.x - 1; x <= at.x + at.w; x += beside ? at.w + 1 : 1) {
            if (x < 0 || y < 0 || x >= study->request->width || y >= study->request->height)
                continue;
            const int64_t other = (int64_t)(y / BLOCK) * study->blocks_u + x / BLOCK;
            const size_t n = (size_t)4 * (size_t)(y % BLOCK * BLOCK + x % BLOCK) + 3;
            seen |= look(wr_packed_block(&study->one, other)[n],
                         wr_packed_block(&study->two, other)[n]);
        }
    }
    return seen;
}

/* Do all blocks round it show just the same? */
static bool alone(const Study *study, const unsigned char *seen, int64_t b)
{
    const int u = (int)(b % study->blocks_u), v = (int)(b / study->blocks_u);
    for (int j = v - 1; j <= v + 1; j++)
        for (int i = u - 1; i <= u + 1; i++)
            if (i >= 0 && j >= 0 && i < study->blocks_u && j < study->blocks_v &&
                seen[(int64_t)j * study->blocks_u + i] != seen[b])
                return false;
    return true;
}

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
static double aligned(const Study *study, int64_t b)
{
    const Corner at = corner_of(study, b);
    const float *two = wr_packed_block(&study->two, b);
    double sum = 0;
    for (int y = 0; y + 1 < at.h; y++)
        for (int x = 0; x + 1 < at.w; x++) {
            const float *p = two + (size_t)4 * (size_t)(y * BLOCK + x);
            const float *right = p + 4, *down = p + (size_t)4 * BLOCK;
            sum += step_off(p, right, down, down + 4) + step_off(p, down, right, down + 4);
        }
    return sum;
}

/* ---- strata ---- */

static int stratum_of(const Study *study, int64_t b, bool edge, double change)
{
    const Corner at = corner_of(study, b);
    if (!edge && study->block[b].covered == 0) return STRATUM_EMPTY;
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

static int by_size(const void *a, const void *b)
{
    const Ranked *x = a, *y = b;
    if (x->size != y->size) return x->size < y->size ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

Ranked *wr_study_rank(const Study *study, int stratum)
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
        Ranked *ranked = wr_study_rank(study, s);
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

/* What 2 x 2 samples change in each block, and its stratum. Returns the sum of the changes. */
static double sort_blocks(Study *study, float *size)
{
    unsigned char *seen = wr_alloc((size_t)study->block_count, 1);
    double sum = 0;
    for (int64_t b = 0; b < study->block_count; b++) {
        study->block[b] = (Block){ 0 };
        seen[b] = (unsigned char)look_at(study, b, &study->block[b]);
    }
    for (int64_t b = 0; b < study->block_count; b++) {
        const bool edge =
            seen[b] == (NOTHING | OBJECT) ||
            (!alone(study, seen, b) && (seen[b] | look_around(study, b)) == (NOTHING | OBJECT));
        if (edge || seen[b] == OBJECT)
            size[b] = (float)wr_block_change(wr_packed_block(&study->one, b),
                                             wr_packed_block(&study->two, b));
        sum += (double)size[b];
        study->block[b].stratum = (unsigned char)stratum_of(study, b, edge, (double)size[b]);
        /* One sample changes that into 2 x 2 by three times what those are off. */
        if (edge) size[b] += (float)(3 * aligned(study, b));
        study->all[study->block[b].stratum]++;
        study->pixels += study->block[b].covered;
    }
    wr_free(seen);
    return sum;
}

double wr_study_sort(Study *study)
{
    double change[STRATA] = { 0 };
    float *size = study->size.of = wr_alloc((size_t)study->block_count, sizeof *size);
    const double sum = sort_blocks(study, size);
    merge_strata(study);
    for (int64_t b = 0; b < study->block_count; b++)
        change[study->block[b].stratum] += (double)size[b];
    /* Calm blocks are drawn too: some of what 2 x 2 samples show as calm is not. */
    for (int64_t b = 0; b < study->block_count; b++) {
        const int s = study->block[b].stratum;
        size[b] += (float)(0.5 * change[s] / (double)study->all[s] + 1e-12);
    }
    grade(study);
    wr_control_add_up(study, &study->size);
    return sqrt(sum / (3 * fmax(study->pixels, 1)));
}
