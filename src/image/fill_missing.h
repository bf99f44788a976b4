/* fill_missing.h - missing values (NaN) of a table filled smoothly from their neighbours: a pyramid of means from coarse to
   fine, each level relaxed towards the mean of its four neighbours. */
#pragma once
#include <stdint.h>

typedef struct WrError WrError;

/* Fill the NaN values of z[height][width], row by row, in place.
 *
 * Returns  how many were filled; -1: all are missing, nothing changed; -2 and an error: cancelled or no memory, z is then
 *          partly filled */
int64_t wr_fill_missing(int width, int height, double *z, WrError *err);
