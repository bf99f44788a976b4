/* adaptive_internal.h - what the two halves of adaptive sampling share: which pixels need more samples (adaptive.c), and those
   samples (adaptive_samples.c).
   Layer 5, private to them. */
#pragma once
#include "render/frame/tile.h"
#include "render/frame/tile_internal.h"
#include "scene/objects.h"

#include <stdbool.h>

enum { WR_OPEN = 1, WR_OPEN_ALL = 2 }; /* a pixel needs more; all */

/* Of pixels with more texels than that along them the neighbours say little: K samples are taken, which have to agree better. */
#define WR_FINE 2.0f

/* What pixels that show one object go by. */
typedef struct WrRefineRule {
    float texels[2]; /* along u and v, of what is looked up */
    float most;      /* how far the estimate may be off */
    bool some;       /* K of the samples are tried before all */
    bool all;        /* fewer than all would not pay on this object */
} WrRefineRule;

typedef struct WrRefiner {
    const WrTileJob *job;                     /* where pixels go */
    const WrTileJob *objects[WR_OBJECTS_MAX]; /* that may be on the tile, the nearest first */
    int count;
    bool among; /* the picture is of several */
    int index;  /* among several: the tile's, in WrTileJob.seen */
    WrTileScratch *scratch;
    WrTilePart part;
    float contrast;
    bool by_bound;
    WrRefineRule rules[WR_OBJECTS_MAX], nothing; /* by WrTileJob.object; where nothing is seen */
    unsigned char rook[WR_TILE_SAMPLES_H];       /* the column of the one in each row */
} WrRefiner;

/* Choose the K samples that are tried first. False: there are none. */
bool wr_refine_rooks(WrRefiner *r);
/* More samples for all open pixels. */
void wr_refine_more(const WrRefiner *r);

/* May the object be on that part of the picture? */
static inline bool wr_refine_touches(const WrTileJob *job, WrTilePart part)
{
    if (wr_plan_runs(job->plan, WR_EFFECT_BESIDE)) return true;
    part = wr_tile_touched(job, part);
    return part.w > 0 && part.h > 0;
}

/* From now on samples are this object's. */
static inline void wr_refine_turn_to(const WrRefiner *r, const WrTileJob *job)
{
    if (r->among) r->scratch->notes = wr_dirty_open(job->seen, r->index, 0, 0);
}

/* What shows that or nearer hides all of the object (E52). */
static inline float wr_refine_limit(const WrTileJob *job, WrTileScratch *scratch)
{
    if (!wr_plan_runs(job->plan, WR_EFFECT_HIDDEN)) return wr_tile_hidden_from(job);
    wr_did(scratch, WR_EFFECT_HIDDEN);
    return -INFINITY;
}
