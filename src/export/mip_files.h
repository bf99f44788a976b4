/* mip_files.h - mip levels of a picture for files: each of half the size (rounded down, at least 1), with texels
   that are exact means of the covered ones. So every level has the same mean, for any size. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

#define WR_LEVEL_CHANNELS 6
#define WR_LEVELS_MAX 15 /* for 16384 texels */

typedef struct WrLevel {
    int width, height;
    float *
        data; /* [height][width][WR_LEVEL_CHANNELS], owned; NULL for the first level, if the caller keeps it */
} WrLevel;

typedef struct WrLevels {
    int count;
    WrLevel level[WR_LEVELS_MAX];
} WrLevels;

/* Computes rows [y, y + rows) of level 0; called on any thread. */
typedef void (*WrLevelRows)(void *ctx, int y, int rows, float *out);

/* Computes the levels. If level[0].data is set, it is level 0, ownership passes, and `rows` is not called;
   levels is otherwise an output. Sums are in double and in a fixed order: the same bits for any number of
   threads. pool  may be NULL    Errors  no memory, "cancelled"    Owner  the caller, wr_levels_free */
bool wr_levels_make(WrLevels *levels, int width, int height, WrLevelRows rows, void *ctx,
                    WrPool *pool, WrError *err);
void wr_levels_free(WrLevels *levels);
