/* normals.h - heights out of normal maps, by least squares: Frankot and Chellappa's (1988) on a ring, the
   same with free edges on a sheet.
   Private to this module. */
#pragma once
#include "base/enum_rows.h"
#include "generate/fft_plane.h"
#include "generate/terrain.h"
#include "image/coding.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrGenerateJob WrGenerateJob;
typedef struct WrImage WrImage;

/* Slopes: no normals, but height over width to the right and up; bump slopes: per texel to the right and down, channels
 * b1_dhds and b2_dhdt. Of normals unsigned and signed are the codings unit and signed by their old names. */
#define WR_NORMAL_CODES(X)                                                                         \
    X(WR_NORMALS_AUTO, "auto")                                                                     \
    X(WR_NORMALS_UNSIGNED, "unsigned")                                                             \
    X(WR_NORMALS_SIGNED, "signed")                                                                 \
    X(WR_NORMALS_SLOPES, "slopes")                                                                 \
    X(WR_NORMALS_BUMP_SLOPES, "bump-slopes")
typedef enum WrNormalCodes { WR_NORMAL_CODES(WR_WORD_ID) } WrNormalCodes;

/* A map as slopes: scene units of height for each of width; y up is taken for granted. */
typedef struct WrNormals {
    int width, height;
    double *p, *q;   /* [height][width], owned: to the right, and DOWN the rows */
    WrCoding coding; /* that was taken, of normals */
    int64_t unknown; /* texels whose normal does not face up: slope 0 */
    int64_t steep;   /* slopes that were brought down to 100 */
} WrNormals;

/* Decode a map of 2 (z follows) to 4 channels. In integer files the two codes beside the middle stand for 0
 * both, so that a flat map is flat. Errors: one channel, no memory, coding=signed of codes. */
bool wr_normals_decode(const WrImage *image, WrCoding coding, WrNormals *out, WrError *err);
/* The same of slopes: the first two channels times these factors, to the right and down. */
bool wr_normals_from_slopes(const WrImage *image, double right, double down, WrNormals *out,
                            WrError *err);
void wr_normals_fini(WrNormals *normals);

/* Whether the green axis points up: heights have dp/dy = dq/dx, so
 *   r = sum(p_y q_x) / sqrt(sum(p_y^2) sum(q_x^2)),   differences over two texels
 * (whatever the texels' shape) is 1 where it does, -1 where it points down, and near 0 where the map does
 * not tell: it is flat, or every slope runs along an axis. */
double wr_normals_upward(const WrNormals *normals);
/* Turn the green axis round. */
void wr_normals_flip(WrNormals *normals);

typedef struct WrIntegral {
    WrEnds ends[2]; /* u, v */
    bool central;   /* on a ring: slopes are central differences; else of the smoothest function */
    double unit[2]; /* slopes times this are table units a texel */
    double residual_deg; /* out: root mean square angle from the map to the heights' own normals */
    double tilt_deg[2];  /* out: on a ring, the mean slope, which it cannot have */
} WrIntegral;

/* The heights whose slopes are nearest to the map's in the sense of least squares; mean 0. On a free axis
 * slopes are summed from texel to texel to fourth order (third at the ends). sheet: made, of the map's
 * size. Errors: no memory, "cancelled". */
bool wr_normals_integrate(const WrNormals *normals, WrIntegral *how, const WrGenerateJob *job,
                          WrSheet *sheet, WrError *err);
