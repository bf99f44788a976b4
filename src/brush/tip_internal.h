/* tip_internal.h - the data of a tip, for its constructors.
   Private to this module. */
#pragma once
#include "brush/tip.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_TIP_LEVELS 14 /* 8192 .. 1 */
#define WR_TIP_RANKS 4   /* maximum ranks of a .gih */

typedef enum WrTipRule { /* selection rule of the next cell along one rank */
                         WR_TIP_CONSTANT,
                         WR_TIP_INCREMENTAL,
                         WR_TIP_RANDOM,
                         WR_TIP_ANGULAR,
                         WR_TIP_PRESSURE
} WrTipRule;

typedef struct WrTipCell {
    float *values; /* all levels, consecutively; owned */
    int levels;
    int width[WR_TIP_LEVELS], height[WR_TIP_LEVELS];
    size_t start[WR_TIP_LEVELS]; /* offset of each level in values */
} WrTipCell;

struct WrTip {
    int refs; /* atomic */
    char *name;
    double spacing; /* relative to the radius; 0: unspecified */
    size_t bytes;   /* of all values */
    int ranks;      /* 1..WR_TIP_RANKS */
    int rank[WR_TIP_RANKS];
    WrTipRule rule[WR_TIP_RANKS];
    int cells;
    WrTipCell *cell; /* [cells], owned */
};

/* A tip of this many empty cells, incremental; the caller owns it. */
WrTip *wr_tip_blank(int cells);

/* Allocates the levels of one cell and checks its size and the tip's; values are zero. what: its name
 * in messages. */
bool wr_tip_cell_alloc(WrTip *tip, int cell, int width, int height, const char *what, WrError *err);
/* Level 0 contains values in units of 1/codes (codes 0: of 1). Smooths them if there are codes, scales
 * them to 0..1 and computes the other levels. */
bool wr_tip_cell_build_levels(WrTip *tip, int cell, int codes, WrError *err);
