/* Joining of overlapping copies of a solid other than by the greatest height: copies are divided into groups within which none
   overlap; the Z-buffer draws each group, and their heights are combined. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "generate/pattern.h"
#include "generate/solid_places.h"
#include "generate/tile_builder.h"

#include <math.h>
#include <string.h>

#define GROUPS 64
#define MARGIN 2.0    /* texels: coverage reaches into the next texel */
#define BINS_MAX 1024 /* along an axis */

/* The box of a copy, in the plane. */
typedef struct Box {
    double middle[2], half[2];
} Box;

typedef struct Grouping {
    const Box *boxes;
    double size[2];
    bool wraps[2];
    int bins[2];
    int64_t *first, *next; /* of each bin; of each copy in its bin; -1: none */
    uint8_t *group;        /* [copies] */
} Grouping;

static Box box_of_solid(const WrZSolid *s)
{
    return (Box){ { s->at[0] + 0.5 * (s->left + s->right), s->at[1] + 0.5 * (s->top + s->bottom) },
                  { 0.5 * fabs(s->right - s->left), 0.5 * fabs(s->bottom - s->top) } };
}

static Box box_of_triangles(const WrZTriangle *t, int64_t count)
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            low[0] = fmin(low[0], t[i].x[k]);
            low[1] = fmin(low[1], t[i].y[k]);
            high[0] = fmax(high[0], t[i].x[k]);
            high[1] = fmax(high[1], t[i].y[k]);
        }
    return (Box){ { 0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]) },
                  { 0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1]) } };
}

static bool overlap(const Grouping *g, const Box *p, const Box *q)
{
    for (int a = 0; a < 2; a++) {
        double d = fabs(p->middle[a] - q->middle[a]);
        if (g->wraps[a]) d = fmin(fmod(d, g->size[a]), g->size[a] - fmod(d, g->size[a]));
        if (d > p->half[a] + q->half[a] + MARGIN) return false;
    }
    return true;
}

static int bin_of(const Grouping *g, const Box *box, int axis)
{
    double x = box->middle[axis] / g->size[axis];
    if (g->wraps[axis]) x -= floor(x);
    const double bin = floor(x * g->bins[axis]);
    return bin < 0.0 ? 0 : bin >= g->bins[axis] ? g->bins[axis] - 1 : (int)bin;
}

static size_t bin_at(const Grouping *g, int i, int j)
{
    return (size_t)wr_modulo(j, g->bins[1]) * (size_t)g->bins[0] + (size_t)wr_modulo(i, g->bins[0]);
}

/* The first group without an overlapping copy before this one; GROUPS: none. */
static int find_group(Grouping *g, int64_t k)
{
    const int x = bin_of(g, &g->boxes[k], 0), y = bin_of(g, &g->boxes[k], 1);
    uint64_t taken = 0;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            for (int64_t n = g->first[bin_at(g, i, j)]; n >= 0; n = g->next[n])
                if (!(taken >> g->group[n] & 1) && overlap(g, &g->boxes[k], &g->boxes[n]))
                    taken |= (uint64_t)1 << g->group[n];
    int group = 0;
    while (group < GROUPS && taken >> group & 1) group++;
    const size_t bin = bin_at(g, x, y);
    g->next[k] = g->first[bin];
    g->first[bin] = k;
    g->group[k] = (uint8_t)group;
    return group;
}

/* Bins at least as wide as two copies: only the eight around can hold one that overlaps. */
static bool find_groups(Grouping *g, int64_t copies, int *count, WrError *err)
{
    double wide[2] = { 0.0, 0.0 };
    for (int64_t k = 0; k < copies; k++)
        for (int a = 0; a < 2; a++) wide[a] = fmax(wide[a], 2.0 * g->boxes[k].half[a] + MARGIN);
    for (int a = 0; a < 2; a++) {
        const double bins = floor(g->size[a] / wide[a]);
        g->bins[a] = bins < 1.0 ? 1 : bins > BINS_MAX ? BINS_MAX : (int)bins;
    }
    const size_t bins = (size_t)g->bins[0] * (size_t)g->bins[1];
    g->first = wr_alloc(bins, sizeof *g->first);
    for (size_t i = 0; i < bins; i++) g->first[i] = -1;
    *count = 0;
    for (int64_t k = 0; k < copies; k++) {
        const int group = find_group(g, k);
        if (group == GROUPS)
            return wr_fail(err,
                           "more than %d copies overlap at one place: join=max has no such limit",
                           GROUPS);
        if (group + 1 > *count) *count = group + 1;
        if (k % 1024 == 0 && wr_progress_stopped()) return wr_fail(err, "cancelled");
    }
    return true;
}

/* ---- joining ---- */

typedef struct Joined {
    const WrRelief *groups; /* [count] 1 or 2; heights in texels */
    int count;
    double melt, scale;
} Joined;

static double value_at(const WrField *field, const float *tile, int k)
{
    return (double)(tile ? tile[k] : wr_field_level(field));
}

/* The formula of solid_places.h, with the greatest height m factored out, so that nothing overflows:
   h = m + melt ln(e + sum of (exp((h_i - m) / melt) - e)), e = exp(-m / melt). */
static double join_heights(const double *h, int count, double melt)
{
    const double log2_e = 1.4426950408889634;
    double most = 0.0, sum = 0.0;
    for (int i = 0; i < count; i++) {
        most = fmax(most, h[i]);
        sum += h[i];
    }
    if (melt == 0.0) return sum;
    const double e = wr_exp2(-most / melt * log2_e);
    sum = e;
    for (int i = 0; i < count; i++) sum += wr_exp2((h[i] - most) / melt * log2_e) - e;
    return most + melt * wr_log2(sum) / log2_e;
}

static void fill_block(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                       float *cover)
{
    (void)worker;
    const Joined *joined = ctx;
    const float *z[2], *c[2];
    for (int n = 0; n < joined->count; n++) {
        z[n] = wr_field_tile(joined->groups[n].heights, b->i / WR_TILE, b->j / WR_TILE);
        c[n] = wr_field_tile(joined->groups[n].cover, b->i / WR_TILE, b->j / WR_TILE);
    }
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++) {
            const int k = y * WR_TILE + x;
            double h[2], free = 1.0, alone = 0.0;
            int there = 0;
            for (int n = 0; n < joined->count; n++) {
                const double part = value_at(joined->groups[n].cover, c[n], k);
                if (!(part > 0.0)) continue;
                alone = value_at(joined->groups[n].heights, z[n], k);
                h[there++] = part * alone;
                free *= 1.0 - part;
            }
            if (there == 0) continue;
            if (there > 1) alone = join_heights(h, there, joined->melt) / (1.0 - free);
            heights[k] = (float)(joined->scale * alone);
            cover[k] = (float)(1.0 - free);
        }
}

/* ---- all ---- */

/* Draws the copies of one group. */
static bool draw_group(const WrZScene *scene, int64_t copies, const uint8_t *groups, int group,
                       const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const int64_t solids = scene->solid_count / copies, triangles = scene->triangle_count / copies;
    int64_t count = 0;
    for (int64_t k = 0; k < copies; k++) count += groups[k] == group;
    WrZSolid *s = wr_try_alloc((size_t)(count * solids) + 1, sizeof *s, "solids", err);
    WrZTriangle *t =
        s ? wr_try_alloc((size_t)(count * triangles) + 1, sizeof *t, "triangles", err) : NULL;
    WrZScene part = {
        .solids = s, .triangles = t, .floor = scene->floor, .soft = scene->soft, .scale = 1.0
    };
    for (int64_t k = 0; t && k < copies; k++) {
        if (groups[k] != group) continue;
        if (solids) s[part.solid_count] = scene->solids[k];
        if (triangles)
            memcpy(t + part.triangle_count, scene->triangles + k * triangles,
                   (size_t)triangles * sizeof *t);
        part.solid_count += solids;
        part.triangle_count += triangles;
    }
    const bool good = t && wr_zbuffer_draw(&part, job, out, err);
    wr_free(s);
    wr_free(t);
    return good;
}

bool wr_solid_join(const WrZScene *scene, int64_t copies, double melt, const WrGenerateJob *job,
                   WrRelief *out, WrError *err)
{
    const int64_t triangles = scene->triangle_count / copies;
    WrRelief made[2] = { { NULL, NULL }, { NULL, NULL } }; /* the groups so far, the next one */
    Grouping g = { .size = { wr_field_width(job->like), wr_field_height(job->like) },
                   .wraps = { wr_field_wrap_u(job->like) == WR_WRAP_PERIODIC,
                              wr_field_wrap_v(job->like) == WR_WRAP_PERIODIC } };
    Box *boxes = wr_try_alloc((size_t)copies, sizeof *boxes, "copies", err);
    if (boxes) g.next = wr_try_alloc((size_t)copies, sizeof *g.next, "copies", err);
    if (g.next) g.group = wr_try_alloc((size_t)copies, sizeof *g.group, "copies", err);
    bool good = g.group != NULL;
    for (int64_t k = 0; good && k < copies; k++)
        boxes[k] = scene->solid_count
                       ? box_of_solid(&scene->solids[k])
                       : box_of_triangles(scene->triangles + k * triangles, triangles);
    g.boxes = boxes;
    int count = 0;
    good = good && find_groups(&g, copies, &count, err);
    /* the formula is associative: each group joins those before it */
    for (int n = 0; good && n < count; n++) {
        WrProgressPart step, last;
        WrGenerateJob part = *job;
        WrRelief sum = { NULL, NULL };
        part.progress =
            wr_progress_part(&step, job->progress, (double)n / count, (n + 0.8) / count);
        good = draw_group(scene, copies, g.group, n, &part, &made[1], err);
        part.progress =
            wr_progress_part(&last, job->progress, (n + 0.8) / count, (n + 1.0) / count);
        const Joined joined = { n > 0 ? made : made + 1, n > 0 ? 2 : 1, melt,
                                n + 1 == count ? scene->scale : 1.0 };
        good = good && wr_generate_build(&part, fill_block, &joined, true, 0.0, &sum, err);
        wr_relief_fini(&made[0]);
        wr_relief_fini(&made[1]);
        made[0] = sum;
    }
    if (good) *out = made[0];
    wr_free(boxes);
    wr_free(g.first);
    wr_free(g.next);
    wr_free(g.group);
    return good;
}
