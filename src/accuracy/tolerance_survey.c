/* First survey of a picture: one sample a pixel everywhere, 2 x 2 at outlines and on a few of the insides. The
   change by 2 x 2 on the others is predicted from the differences of neighbouring pixels, which are small on
   smooth insides: most of a calm picture is never rendered a second time. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

#define BLOCK WR_FRAME_BLOCK

/* One inside of this many is rendered at 2 x 2, to calibrate the predictions of the others. */
#define LOOKED_AT 10
#define LOOKED_LEAST 12
#define LIVELIER 16.0 /* ratio of predicted squares from which a neighbour counts as lively */
#define LIVELIEST 6   /* in root mean squares: predicted largest error of a block's pixels */

/* The default mesh has an outline error of up to a quarter of a pixel, typically a twentieth, which samples
   cannot reduce; each step of the dial reduces it to a quarter. Largest part of the tolerance that it may use: */
#define MESH_OFF 0.05
#define MESH_PART 0.3
#define FINE_MESH 2

/* ---- the surface's mesh ---- */

static bool mesh_matters(const Study *study)
{
    const WrDial *mesh = &wr_dials[WR_DIAL_MESH];
    return !mesh->matters || mesh->matters(study->request->scene);
}

/* Squares caused in a block by an outline error of one pixel. */
static double outline_squares(const Study *study, int64_t b)
{
    const Corner at = wr_study_corner(study, b);
    const float *rgba = study->block[b].rgba[0];
    double sum = 0;
    for (int y = 0; y < at.h; y++)
        for (int x = 0; x < at.w; x++) {
            const float *p = rgba + (size_t)4 * (size_t)(y * BLOCK + x);
            const bool right = x + 1 < at.w && (p[3] > 0) != (p[7] > 0);
            const bool down = y + 1 < at.h && (p[3] > 0) != (p[4 * BLOCK + 3] > 0);
            if (!right && !down) continue;
            const float *in = p[3] > 0 ? p : right ? p + 4 : p + (size_t)4 * BLOCK;
            for (int c = 0; c < 3; c++) sum += (double)in[c] * (double)in[c];
        }
    return sum;
}

/* Uses a finer mesh from the second level on, if the default mesh would use a significant part of the tolerance. */
static void choose_mesh(Study *study, const WrTolerance *tolerance)
{
    double sum = 0;
    int64_t covered = 0;
    if (tolerance->kind != WR_TOLERANCE_RMS || !mesh_matters(study)) return;
    for (int64_t b = 0; b < study->count; b++) {
        sum += outline_squares(study, b);
        covered += study->block[b].covered;
    }
    const double rms = MESH_OFF * sqrt(sum / (3 * fmax(1, (double)covered)));
    study->mesh_from = 1;
    while (study->mesh < FINE_MESH && rms > MESH_PART * tolerance->value * (1 << 2 * study->mesh))
        study->mesh++;
}

/* ---- prediction of the change by 2 x 2 ---- */

/* The mean of 2 x 2 differs from the pixel's centre by 1/32 of the pixels' second difference if the picture is
   smooth, by 1/4 of it if the pixels are independent; the ratio of the second to the first difference
   distinguishes them. */
static double foretell(const float *rgba)
{
    double first = 0, second = 0;
    for (int y = 1; y + 1 < BLOCK; y++)
        for (int x = 1; x + 1 < BLOCK; x++) {
            const float *p = rgba + (size_t)4 * (size_t)(y * BLOCK + x);
            for (int c = 0; c < 3; c++) {
                const float right = p[4 + c] - p[c], left = p[c - 4] - p[c];
                const float down = p[4 * BLOCK + c] - p[c], up = p[c - 4 * BLOCK] - p[c];
                const float bend = right + left + down + up;
                first += (double)(right * right + down * down);
                second += (double)(bend * bend);
            }
        }
    if (!(first > 0)) return 0;
    const double rough = fmin(1, second / (5 * first));
    const double inner = (double)((BLOCK - 2) * (BLOCK - 2)) / (BLOCK * BLOCK);
    return second / inner * fmax(1.0 / 1024, rough / 16);
}

/* Finds insides that may be predicted: without an outline in them or next to them. Sets them to 0 in
   study->mask, all others to 1. If the largest error counts, every block is rendered. */
static int64_t find_insides(Study *study, const WrTolerance *tolerance)
{
    int64_t found = 0;
    for (int64_t b = 0; b < study->count; b++) {
        study->mask[b] = wr_study_look(study, b) != OBJECT || tolerance->kind == WR_TOLERANCE_MAX ||
                         study->block[b].covered < BLOCK * BLOCK ||
                         wr_study_look_around(study, b) != OBJECT;
        found += !study->mask[b];
    }
    return found;
}

typedef struct Inside {
    int64_t block;
    double off;
} Inside;

static int by_off(const void *a, const void *b)
{
    const Inside *x = a, *y = b;
    if (x->off != y->off) return x->off < y->off ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

/* Adds every n-th block, from calm to lively, to the mask, including the liveliest. */
static void look_at_some(Study *study, Inside *list, int64_t count)
{
    const int64_t wanted = count / LOOKED_AT > LOOKED_LEAST ? count / LOOKED_AT : LOOKED_LEAST;
    qsort(list, (size_t)count, sizeof *list, by_off);
    for (int64_t i = 0; i < wanted; i++)
        study->mask[list[count - 1 - i * count / wanted].block] = 1;
}

/* A calm block beside a lively one may contain the end of the feature that makes it lively, between its pixels'
   centres. */
static void look_beside_lively(Study *study, const Inside *list, int64_t count)
{
    double *off = wr_alloc((size_t)study->count, sizeof *off), sum = 0;
    for (int64_t i = 0; i < count; i++) sum += off[list[i].block] = list[i].off;
    for (int64_t i = 0; i < count; i++) {
        const int u = (int)(list[i].block % study->blocks_u);
        const int v = (int)(list[i].block / study->blocks_u);
        for (int n = 0; n < 9; n++) {
            const int other_u = u + n % 3 - 1, other_v = v + n / 3 - 1;
            if (other_u < 0 || other_v < 0 || other_u >= study->blocks_u ||
                other_v >= study->blocks_v)
                continue;
            const double beside = off[(int64_t)other_v * study->blocks_u + other_u];
            if (beside * (double)count > sum && beside > LIVELIER * list[i].off)
                study->mask[list[i].block] = 1;
        }
    }
    wr_free(off);
}

/* Corrects the predictions of the others by the results of those rendered. */
static void correct(Study *study, const Inside *list, int64_t count)
{
    double sum = 0, shares = 0, squares = 0;
    int64_t seen = 0;
    for (int64_t i = 0; i < count; i++) sum += list[i].off;
    const double floor_off = 0.5 * sum / (double)count + 1e-15;
    for (int64_t i = 0; i < count; i++) {
        const Block *block = &study->block[list[i].block];
        if (!block->rgba[1]) continue;
        const double share =
            wr_block_change(block->rgba[0], block->rgba[1]).squares / (list[i].off + floor_off);
        shares += share;
        squares += share * share;
        seen++;
    }
    const double factor = wr_study_factor(shares, squares, seen) / 1.5;
    for (int64_t i = 0; i < count; i++) {
        Block *block = &study->block[list[i].block];
        const double off = factor * (list[i].off + floor_off);
        if (!block->rgba[1])
            block->change[1] = (Change){ off, LIVELIEST * sqrt(off / (3.0 * BLOCK * BLOCK)) };
    }
}

/* ---- block contents and outlines ---- */

/* An outline that passes beside a block may cut a corner of it that neither picture hit: the change of one row
   of the liveliest neighbour may be hidden there. */
static void doubt_corner(Study *study, int64_t b)
{
    const int u = (int)(b % study->blocks_u), v = (int)(b / study->blocks_u);
    Change *own = &study->block[b].change[1];
    for (int j = v > 0 ? v - 1 : 0; j <= v + 1 && j < study->blocks_v; j++)
        for (int i = u > 0 ? u - 1 : 0; i <= u + 1 && i < study->blocks_u; i++) {
            const Block *other = &study->block[(int64_t)j * study->blocks_u + i];
            if (!other->lined) continue;
            own->most = fmax(own->most, other->change[1].most);
            own->squares = fmax(own->squares, other->change[1].squares / BLOCK);
        }
}

/* Determines each block's content and frees the empty ones. */
static void sort_blocks(Study *study)
{
    unsigned char *seen = wr_alloc((size_t)study->count, 1);
    study->pixels = 0;
    for (int64_t b = 0; b < study->count; b++) seen[b] = (unsigned char)wr_study_look(study, b);
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        block->edge = (seen[b] | wr_study_look_around(study, b)) == (NOTHING | OBJECT);
        block->shown = block->edge || seen[b] == OBJECT;
        block->lined = seen[b] == (NOTHING | OBJECT);
        block->level = block->rgba[1] != NULL;
        if (block->level > 0) wr_block_compare(block, 1);
        study->pixels += block->covered;
    }
    for (int64_t b = 0; b < study->count; b++)
        if (study->block[b].edge && !study->block[b].lined) doubt_corner(study, b);
    for (int64_t b = 0; b < study->count; b++)
        for (int level = 0; level < 2 && !study->block[b].shown; level++)
            wr_study_drop(&study->block[b], level);
    wr_free(seen);
}

/* ---- interface ---- */

bool wr_study_begin(Study *study, const WrTolerance *tolerance, WrError *err)
{
    if (tolerance->kind == WR_TOLERANCE_MAX && mesh_matters(study)) study->mesh = FINE_MESH;
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = 1;
    return wr_study_render(study, 0, 0, true, NULL, err);
}

/* Part of the samples that are beside those of the first picture: outlines. */
#define BESIDE 1.1

bool wr_study_best_is_cheaper(const Study *study, const WrTolerance *tolerance)
{
    const double side = wr_level_side(TOP), seen = (double)study->shaded;
    const double pass = wr_price_pass((int64_t)study->request->width * study->request->height);
    const double best = BESIDE * study->pair[0].price * side * side * seen + pass;
    if (tolerance->kind == WR_TOLERANCE_TIME) return best <= tolerance->value;
    /* 2 x 2, one step up from there, a probe of each; no time per sample. */
    return seen > 0 && best <= 4 * pass;
}

bool wr_study_take_best(Study *study, WrError *err)
{
    for (int64_t b = 0; b < study->count; b++) study->mask[b] = 1;
    study->mesh = mesh_matters(study) ? FINE_MESH : study->mesh;
    if (!wr_study_render(study, 0, TOP, true, NULL, err)) return false;
    study->pixels = 0;
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        /* The finest level shows outlines: it stands for the second level, which was not rendered. */
        block->rgba[1] = block->rgba[TOP];
        const int seen = wr_study_look(study, b);
        block->rgba[1] = NULL;
        block->shown = (seen & OBJECT) != 0;
        block->edge = block->lined = seen == (NOTHING | OBJECT);
        block->change[1] = wr_block_change(block->rgba[0], block->rgba[TOP]);
        block->level = 1;
        block->pick = TOP;
        block->step[1] = block->step[TOP];
        study->pixels += block->covered;
    }
    return true;
}

bool wr_study_survey(Study *study, const WrTolerance *tolerance, WrError *err)
{
    const int64_t count = find_insides(study, tolerance);
    const bool some = count > (int64_t)LOOKED_LEAST;
    Inside *list = wr_alloc((size_t)count + 1, sizeof *list);
    int64_t n = 0;
    for (int64_t b = 0; b < study->count; b++)
        if (!study->mask[b]) list[n++] = (Inside){ b, foretell(study->block[b].rgba[0]) };
    choose_mesh(study, tolerance);
    if (some) {
        look_at_some(study, list, count);
        look_beside_lively(study, list, count);
    }
    for (int64_t b = 0; b < study->count && !some; b++) study->mask[b] = 1;
    const bool good = wr_study_render(study, 0, 1, true, NULL, err);
    if (good && some) correct(study, list, count);
    if (good) sort_blocks(study);
    wr_free(list);
    return good;
}
