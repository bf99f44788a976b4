/* mip_files.h - a picture and ever smaller ones of it, each half as large (rounded down, at least 1) and its texels the exact
   means of what they cover: the level above has the same mean, whatever the sizes.
   Layer 6. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

#define WR_LEVEL_CHANNELS 6
#define WR_LEVELS_MAX 15 /* of 16384 texels */

typedef struct WrLevel {
    int width, height;
    float *
        data; /* [height][width][WR_LEVEL_CHANNELS], owned; NULL of the first, which the caller has */
} WrLevel;

typedef struct WrLevels {
    int count;
    WrLevel level[WR_LEVELS_MAX];
} WrLevels;

/* Rows [y, y + rows) of level 0; on any thread. */
typedef void (*WrLevelRows)(void *ctx, int y, int rows, float *out);

/* Where level[0].data is there already, taken over, that is level 0 and `rows` is not asked; levels is otherwise an output.
 * Sums are in double and in a fixed order: the same bits for any number of threads.
 * pool  may be NULL    Errors  no memory, "cancelled"    Owner  the caller, wr_levels_free */
bool wr_levels_make(WrLevels *levels, int width, int height, WrLevelRows rows, void *ctx,
                    WrPool *pool, WrError *err);
void wr_levels_free(WrLevels *levels);
