/* Estimate of whether adaptive sampling pays in this view: a few small blocks of the picture are refined and
   counted. */
#include "render/pipeline/pipeline.h"

#include <string.h>

#define BLOCK_W 8 /* pixels */
#define BLOCK_H 4
#define AREA 3000 /* pixels of the view for each block, ... */
#define LEAST 16  /* ... and the least number of blocks */
#define MOST 128
/* mesh blocks: above this each probe is slow, because it traverses them all, so only ... */
#define HEAVY 4096
#define FEW 5   /* ... this many probes are taken */
#define SURE 12 /* after this many blocks the answer may be clear */

/* Measured costs, in samples of plain supersampling. With a mesh each sample costs more, so the overhead counts
   less. */
#define FIRST 1.9 /* a first sample, its share of the ring, and the test */
#define FIRST_MESH 1.7
#define FIRST_BOUND 7.0 /* with a bound */
#define MORE 1.6        /* each further sample: they are scattered */
#define MORE_MESH 1.2
#define DEPTH 0.15 /* one cell of the depth tile, which is filled for all of them */
#define GAIN 0.85  /* of plain supersampling's cost: above this the gain is too small */

typedef struct Spent {
    double adaptive, plain;
} Spent;

/* Counts the first samples of the block that hit something: inside it, and with the ring. */
static void count_first(const WrTileScratch *scratch, int w, int h, int ring, int *within, int *all)
{
    *within = *all = 0;
    for (int y = -ring; y < h + ring; y++)
        for (int x = -ring; x < w + ring; x++) {
            const bool met = scratch->centre[y + WR_REFINE_RING][x + WR_REFINE_RING][3] > 0;
            *all += met;
            *within += met && y >= 0 && y < h && x >= 0 && x < w;
        }
}

static void spend_block(const WrTileJob *job, int x, int y, WrTileScratch *scratch, Spent *spent)
{
    WrTileJob own = *job;
    const int w = job->width < BLOCK_W ? job->width : BLOCK_W;
    const int h = job->height < BLOCK_H ? job->height : BLOCK_H;
    const bool bound = job->plan->refine == WR_REFINE_BOUND;
    const double cells = (double)job->samples * job->samples;
    int within, all;
    own.rgba = scratch->mean[0];
    own.rgba_pitch = (size_t)w;
    own.x0 = x < 0 ? 0 : x > job->width - w ? job->width - w : x;
    own.y0 = y < 0 ? 0 : y > job->height - h ? job->height - h : y;
    memset(scratch->mean, 0, (size_t)(w * h) * sizeof *scratch->mean);
    wr_refine_tile(&own, own.x0, own.y0, w, h, scratch);
    count_first(scratch, w, h, bound ? 0 : WR_REFINE_RING, &within, &all);
    const double more = (double)(scratch->met - all);
    double area = 0;
    for (int i = 0; i < w * h; i++) area += (double)scratch->mean[i][3];
    spent->plain += cells * area;
    const bool tiled = job->mesh || job->triangles;
    const double first = bound ? FIRST_BOUND : tiled ? FIRST_MESH : FIRST;
    spent->adaptive += first * within + (tiled ? MORE_MESH : MORE) * more +
                       (tiled && more > 0 ? DEPTH * cells * area : 0);
}

/* True if more blocks would hardly change the answer. */
static bool clear(const Spent *spent)
{
    return spent->plain > 0 &&
           (spent->adaptive > 1.3 * spent->plain || spent->adaptive < 0.5 * spent->plain);
}

/* Blocks are spread evenly over the view, but not in rows, with which relief may be in step: they lie at
   multiples of 1/p and 1/p^2, p the plastic number. */
#define ACROSS 0xc13fa9a9U /* of 2^32 */
#define DOWN 0x91e10da5U

static int place(int k, uint32_t step, int room)
{
    return (int)(((uint64_t)((uint32_t)(k + 1) * step) * (uint64_t)room) >> 32);
}

/* True if each probe is slow: cells near the eye that need clipping are visited by every one. */
static bool is_heavy(const WrViewMesh *mesh)
{
    const int count = mesh->blocks_u * mesh->blocks_v;
    for (int i = 0; i < count; i++)
        if (mesh->blocks[i].clipped) return true;
    return count > HEAVY;
}

bool wr_refine_pays(const WrTileJob *job, WrTileScratch *scratch)
{
    const WrView *view = job->view;
    const int w = view->x1 - view->x0, h = view->y1 - view->y0;
    if (w < 6 * BLOCK_W || h < 6 * BLOCK_W) return true; /* too small to measure */
    WrTileJob own = *job;
    Spent spent = { 0 };
    own.codes = NULL, own.normals = NULL, own.map = NULL, own.seen = NULL;
    scratch->notes = (WrDirtyNotes){ 0 };
    const int64_t area = (int64_t)w * h / AREA;
    const bool heavy = job->triangles || (job->mesh && is_heavy(job->mesh));
    const int count = heavy ? FEW : area < LEAST ? LEAST : area > MOST ? MOST : (int)area;
    for (int k = 0; k < count && !(k >= SURE && clear(&spent)); k++)
        spend_block(&own, view->x0 + place(k, ACROSS, w - BLOCK_W),
                    view->y0 + place(k, DOWN, h - BLOCK_H), scratch, &spent);
    return !(spent.adaptive > GAIN * spent.plain);
}
