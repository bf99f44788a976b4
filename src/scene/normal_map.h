/* normal_map.h - pictures of normals, as programs write them, read as unit vectors of the tangent plane and as slopes.
   A picture of normals is data: its numbers are never colour-converted. They are decoded once, when a file is
   read: what is kept of it, in memory and in documents, are unit vectors, of which nothing is rebuilt or made unit again
   for a picture (E59).

   Numbers   codes of 8 and 16 bits are 2 c/M - 1; float ones by their coding (image/coding.h).
             Where more than half of the texels have x and y at the code above the middle (128, 32768), which stands for
             0 then, codes count from it, and the rest is as far as before at either end.
   Vectors   made unit. Of two channels z = sqrt(1 - x^2 - y^2); where x^2 + y^2 > 1, z is as for what looks away.
   Away      z of WR_NORMAL_LEAST and less is WR_NORMAL_LEAST, and counted: slopes stay finite, of their own sign. The two
             codes beside the middle are z = 0 as rounding leaves it: `level` counts those of them.
   Green     up: y runs against the picture's rows, as v does. Where it is not told it is found: a height table has
             d/dv (dF/du) = d/du (dF/dv), so with the right sign of q the sum of D_v p D_u q over all texels, D central
             differences round the ends, is that of F_uv^2; with the wrong one minus that. Undecided where it is below
             what rounding of the codes can bring: of f(u) + g(v) it always is. */
#pragma once
#include "image/coding.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;

#define WR_NORMAL_LEAST 1e-3

typedef enum WrGreen { WR_GREEN_AUTO, WR_GREEN_UP, WR_GREEN_DOWN } WrGreen;

/* What there is to tell of one that was read. */
typedef struct WrNormalTold {
    bool green_down; /* its second number ran with the rows, and was turned */
    bool undecided;  /* which was to be found, and could not be: up was taken */
    int channels;    /* that were read: 2 or 3 */
    bool own;        /* float numbers that are the vector's own */
    bool centred;    /* its codes stand for 0 at 128 or 32768 */
    bool converted;  /* its x and y have the mean that a colour conversion gives: it may be bent */
    int64_t away;    /* texels that looked away, or lay beyond the rim */
    int64_t level; /* those of them that lie on it as far as rounding of z to codes lets one say */
    double off, off_mean; /* how far the lengths of three numbers are from 1: at most, on average */
} WrNormalTold;

/* Unit vectors, x along u, y along v, z >= about WR_NORMAL_LEAST: a picture of three channels. channels: 2, 3, or 0: as
   many as there are, at most 3. NULL and an error where it has fewer, or where the coding does not fit. */
WrImage *wr_normal_map_read(const WrImage *from, WrGreen green, int channels, WrCoding coding,
                            WrNormalTold *told, WrError *err);
/* The same along the object's axes: three channels, and no direction looks away. green_down: its second number is turned. */
WrImage *wr_normal_map_read_object(const WrImage *from, bool green_down, WrCoding coding,
                                   WrNormalTold *told, WrError *err);
/* A copy whose second numbers run the other way. */
WrImage *wr_normal_map_turned(const WrImage *map, WrError *err);
/* Vectors of any direction as ones of the tangent plane: z of WR_NORMAL_LEAST and less is that, and counted. */
WrImage *wr_normal_map_raised(const WrImage *map, int64_t *away, WrError *err);
/* What a document holds, which is as reading made it: the same picture, shared. An error where it is something else, by
   more than 4 ulp of |n|^2. */
WrImage *wr_normal_map_keep(const WrImage *held, bool object, WrError *err);
/* Slopes of such a vector along u and v, of a unit cell. */
void wr_normal_map_slopes(const float n[3], double *p, double *q);
