/* adaptive_internal.h - state shared by the two halves of adaptive sampling: choosing pixels (adaptive.c) and
   sampling them (adaptive_samples.c).
   Private to these two files. */
#pragma once
#include "render/frame/tile.h"
#include "render/frame/tile_internal.h"
#include "scene/objects.h"

#include <stdbool.h>

enum { WR_OPEN = 1, WR_OPEN_ALL = 2 }; /* the pixel needs more samples; needs all of them */

/* Above this many texels per pixel, neighbours predict little: K samples are taken and have to agree more
   closely. */
#define WR_FINE 2.0f

/* Thresholds for the pixels that show one object. */
typedef struct WrRefineRule {
    float texels[2]; /* per pixel along u and v, of the fetched textures */
    float most;      /* largest error allowed of the estimate */
    bool some;       /* K samples are tried before all K x K */
    bool all;        /* for this object, fewer than all would cost more */
} WrRefineRule;

typedef struct WrRefiner {
    const WrTileJob *job; /* target of the pixels */
    /* objects that may cover the tile, the nearest first */
    const WrTileJob *objects[WR_OBJECTS_MAX];
    int count;
    bool among; /* the picture has several objects */
    int index;  /* several objects: the tile's index, for WrTileJob.seen */
    WrTileScratch *scratch;
    WrTilePart part;
    float contrast;
    bool by_bound;
    /* by WrTileJob.object; `nothing`: the background's */
    WrRefineRule rules[WR_OBJECTS_MAX], nothing;
    unsigned char rook[WR_TILE_SAMPLES_H]; /* column of the chosen sample in each row */
} WrRefiner;

/* Chooses the K samples that are tried first. False: K has no such set. */
bool wr_refine_rooks(WrRefiner *r);
/* Takes more samples for all open pixels. */
void wr_refine_more(const WrRefiner *r);

/* True if the object may cover that part of the picture. */
static inline bool wr_refine_touches(const WrTileJob *job, WrTilePart part)
{
    if (wr_plan_runs(job->plan, WR_EFFECT_BESIDE)) return true;
    part = wr_tile_touched(job, part);
    return part.w > 0 && part.h > 0;
}

/* Makes `job` the object of the following samples. */
static inline void wr_refine_turn_to(const WrRefiner *r, const WrTileJob *job)
{
    if (r->among) r->scratch->notes = wr_dirty_open(job->seen, r->index, 0, 0);
}

/* Depth beyond which the whole object is hidden (E52). */
static inline float wr_refine_limit(const WrTileJob *job, WrTileScratch *scratch)
{
    if (!wr_plan_runs(job->plan, WR_EFFECT_HIDDEN)) return wr_tile_hidden_from(job);
    wr_did(scratch, WR_EFFECT_HIDDEN);
    return -INFINITY;
}
