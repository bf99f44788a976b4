/* fill_missing.h - smooth filling of missing values (NaN) of a table from their neighbours.

   Uses a pyramid of means from coarse to fine; each level is relaxed towards the mean of its four
   neighbours. */
#pragma once
#include <stdint.h>

typedef struct WrError WrError;

/* Fills the NaN values of z[height][width], row by row, in place.
 *
 * Returns  number of filled values; -1: all are missing, nothing changed; -2 and an error: cancelled or
 *          out of memory, z is then partly filled */
int64_t wr_fill_missing(int width, int height, double *z, WrError *err);
