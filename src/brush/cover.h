/* cover.h - a stroke's coverage: pages of 64 x 64 texels beside the tiles, and the heights made of them.
   Layer 2, inside this room.
   Dabs only add to the coverage; the heights of all that changed are made at once, when they are wanted.
   That is the same whenever it happens, since they come from the heights before the stroke. */
#pragma once
#include "base/array.h"
#include "brush/make.h"
#include "brush/scan.h"

#include <stdbool.h>

typedef enum WrCoverRule {
    WR_COVER_MAX,
    WR_COVER_OVER, /* 1 - (1 - A) (1 - a) */
    WR_COVER_SUM
} WrCoverRule;

typedef struct WrPage {
    float cover[WR_TILE * WR_TILE]; /* unused texels of the last tiles stay 0 */
    float *rest;                    /* sums: what rounding lost; owned, or NULL */
    float *target;                  /* owned, or NULL */
    int tx, ty;
    bool listed;                      /* among cover->changed */
    int low_x, high_x, low_y, high_y; /* changed since heights were made; high_x <= low_x: nothing;
                                         columns before high_x, rows up to high_y */
} WrPage;

typedef struct WrCover {
    WrMaker maker;
    WrCoverRule rule;
    int tiles_u;
    WrPage **pages; /* [tiles]; NULL: no coverage; owned */
    WR_ARRAY(WrPage *) made, changed;
    WR_ARRAY(WrMake) makes; /* scratch */
} WrCover;

void wr_cover_init(WrCover *cover, const WrBrushGround *ground, const WrBrush *brush,
                   WrCoverRule rule);
void wr_cover_fini(WrCover *cover);
void wr_cover_add(WrCover *cover, const WrDabShape *shape);
/* Make the heights of what changed, until that time of the clock (HUGE_VAL: all), at least a few tiles. True
 * if some are left. */
bool wr_cover_make(WrCover *cover, double until);
/* The targets of a tile, made when they are first asked for; NULL where the mode has none. */
const float *wr_cover_target(WrCover *cover, int tx, int ty);
