/* tip_internal.h - the inside of a tip, for those who make one.
   Private to this module. */
#pragma once
#include "brush/tip.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_TIP_LEVELS 14 /* 8192 .. 1 */
#define WR_TIP_RANKS 4   /* of a .gih, at most */

typedef enum WrTipRule { /* how the next cell is chosen along one rank */
                         WR_TIP_CONSTANT,
                         WR_TIP_INCREMENTAL,
                         WR_TIP_RANDOM,
                         WR_TIP_ANGULAR,
                         WR_TIP_PRESSURE
} WrTipRule;

typedef struct WrTipCell {
    float *values; /* all levels, one after the other; owned */
    int levels;
    int width[WR_TIP_LEVELS], height[WR_TIP_LEVELS];
    size_t start[WR_TIP_LEVELS]; /* of the level in values */
} WrTipCell;

struct WrTip {
    int refs; /* atomic */
    char *name;
    double spacing; /* of the radius; 0: nothing said */
    size_t bytes;   /* of all values */
    int ranks;      /* 1..WR_TIP_RANKS */
    int rank[WR_TIP_RANKS];
    WrTipRule rule[WR_TIP_RANKS];
    int cells;
    WrTipCell *cell; /* [cells], owned */
};

/* A tip of that many empty cells, incremental; the caller owns it. */
WrTip *wr_tip_blank(int cells);

/* Lay out the levels of one cell and check its size and the tip's; values are zeros still. what: how
 * messages call it. */
bool wr_tip_cell_alloc(WrTip *tip, int cell, int width, int height, const char *what, WrError *err);
/* Level 0 holds values in units of 1/codes (codes 0: of 1). Smooth them if there are codes, bring them to
 * 0..1 and make the other levels. */
bool wr_tip_cell_finish(WrTip *tip, int cell, int codes, WrError *err);

/* One level from the next larger one: box means by area. */
void wr_tip_halve(const float *in, int in_w, int in_h, float *out, int out_w, int out_h);
/* Smooth values in units of codes; each moves by at most 1/2. */
bool wr_tip_smooth(float *values, int width, int height, WrError *err);

/* One .gbr at the start of bytes, into a cell; *used: how long it is. name (may be NULL) and spacing are
 * given where the file has them. */
bool wr_tip_parse_gbr(WrTip *tip, int cell, const uint8_t *bytes, size_t size, size_t *used,
                      char **name, double *spacing, const char *what, WrError *err);
/* Does it begin as a .gbr does? */
bool wr_tip_is_gbr(const uint8_t *bytes, size_t size);
/* A whole .gih. */
WrTip *wr_tip_parse_gih(const uint8_t *bytes, size_t size, const char *what, WrError *err);
/* Text of a stranger's file fit to be shown: control characters and broken UTF-8 become '?'. The caller
 * frees. */
char *wr_tip_clean_name(const uint8_t *bytes, size_t size);
