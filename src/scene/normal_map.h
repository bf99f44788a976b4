/* normal_map.h - reading of normal maps of other programs, as unit vectors of the tangent plane and as
   slopes.

   A normal map is data: its numbers are never colour-converted. It is decoded once, when a file is
   read: memory and documents store unit vectors, which are neither reconstructed nor renormalised for a
   picture (E59).

   Numbers   codes of 8 and 16 bits are 2 c/M - 1; floats depend on their coding (image/normal_encoding.h). If
             more than half of the texels have x and y at the code above the middle (128, 32768), that
             code represents 0, and codes are relative to it, with the same distance to either end.
   Vectors   normalised. With two channels z = sqrt(1 - x^2 - y^2); if x^2 + y^2 > 1, z is that of a
             vector that faces away.
   Away      z of WR_NORMAL_MIN and less becomes WR_NORMAL_MIN, and is counted: slopes stay finite,
             with their own sign. The two codes beside the middle are z = 0 within rounding: `level` is
             their number among those.
   Green     up: y runs against the picture's rows, like v. If unknown it is detected: a height table
             has d/dv (dF/du) = d/du (dF/dv), so with the right sign of q the sum of D_v p D_u q over
             all texels, D periodic central differences, is that of F_uv^2; with the wrong one its
             negative. Undecided if it is below the effect of rounding of the codes: always so for f(u)
             + g(v). */
#pragma once
#include "image/normal_encoding.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;

#define WR_NORMAL_MIN 1e-3

typedef enum WrGreen { WR_GREEN_AUTO, WR_GREEN_UP, WR_GREEN_DOWN } WrGreen;

/* Report on a map that was read. */
typedef struct WrNormalMapReport {
    bool green_down; /* its second number ran with the rows, and was inverted */
    bool undecided;  /* the direction could not be detected: up was assumed */
    int channels;    /* number of channels read: 2 or 3 */
    bool own;        /* float numbers that are the vector itself */
    bool centred;    /* its codes represent 0 by 128 or 32768 */
    bool converted;  /* its x and y have the mean of a colour conversion: it may be distorted */
    int64_t away;    /* texels that faced away, or were beyond the unit circle */
    int64_t level;   /* those of them that are level within the rounding of z to codes */
    double off, off_mean; /* distance of the lengths of three numbers from 1: maximum, mean */
} WrNormalMapReport;

/* Reads unit vectors, x along u, y along v, z >= about WR_NORMAL_MIN: a picture of three channels.
   channels: 2, 3, or 0: all, at most 3. NULL and an error if it has fewer, or if the coding does not
   match. */
WrImage *wr_normal_map_decode(const WrImage *from, WrGreen green, int channels, WrCoding coding,
                              WrNormalMapReport *report, WrError *err);
/* Reads a map in the object's axes: three channels, all directions allowed. green_down: its second
 * number is inverted. */
WrImage *wr_normal_map_read_object(const WrImage *from, bool green_down, WrCoding coding,
                                   WrNormalMapReport *report, WrError *err);
/* A copy with inverted second numbers. */
WrImage *wr_normal_map_turned(const WrImage *map, WrError *err);
/* Converts vectors of any direction to tangent space: z of WR_NORMAL_MIN and less becomes that, and
 * is counted. */
WrImage *wr_normal_map_raised(const WrImage *map, int64_t *away, WrError *err);
/* Shares a document's map, which must have the form of read maps. An error if it differs by more than 4
   ulp of |n|^2. */
WrImage *wr_normal_map_share(const WrImage *held, bool object, WrError *err);
/* Slopes of such a vector along u and v, for a unit cell. */
void wr_normal_map_slopes(const float n[3], double *p, double *q);
