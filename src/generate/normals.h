/* normals.h - heights from normal maps by least squares: Frankot and Chellappa (1988) on a torus, the
   corresponding method with free edges on a plane.
   Private to this module. */
#pragma once
#include "base/enum_rows.h"
#include "field/fft_plane.h"
#include "generate/sheet.h"
#include "image/normal_encoding.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrGenerateJob WrGenerateJob;
typedef struct WrImage WrImage;

/* Slopes: not normals, but height over width to the right and up; bump slopes: per texel to the right
 * and down, channels b1_dhds and b2_dhdt. `unsigned` and `signed` are old names of the normal codings
 * unit and signed. */
#define WR_NORMAL_CODES(X)                                                                         \
    X(WR_NORMALS_AUTO, "auto")                                                                     \
    X(WR_NORMALS_UNSIGNED, "unsigned")                                                             \
    X(WR_NORMALS_SIGNED, "signed")                                                                 \
    X(WR_NORMALS_SLOPES, "slopes")                                                                 \
    X(WR_NORMALS_BUMP_SLOPES, "bump-slopes")
typedef enum WrNormalCodes { WR_NORMAL_CODES(WR_WORD_ID) } WrNormalCodes;

/* A map as slopes: scene units of height per unit of width; y up is assumed. */
typedef struct WrNormals {
    int width, height;
    double *p, *q;   /* [height][width], owned: to the right, and DOWN the rows */
    WrCoding coding; /* coding used, for normals */
    int64_t unknown; /* number of texels whose normal does not face up: slope 0 */
    int64_t steep;   /* number of slopes limited to 100 */
} WrNormals;

/* Decodes a map of 2 (z is derived) to 4 channels. In integer files both codes beside the middle
 * represent 0, so that a flat map is flat. Errors: one channel, out of memory, coding=signed for codes. */
bool wr_normals_decode(const WrImage *image, WrCoding coding, WrNormals *out, WrError *err);
/* Decodes slopes: the first two channels times these factors, to the right and down. */
void wr_normals_fini(WrNormals *normals);

/* Correlation that reveals the direction of the green axis: heights have dp/dy = dq/dx, so
 *
 *   r = sum(p_y q_x) / sqrt(sum(p_y^2) sum(q_x^2)),   differences over two texels
 *
 * (for any texel shape) is 1 if it points up, -1 if it points down, and near 0 if the map does not
 * determine it: it is flat, or every slope is along an axis. */
double wr_normals_upward(const WrNormals *normals);
/* Inverts the green axis. */
void wr_normals_flip(WrNormals *normals);

typedef struct WrIntegral {
    WrEnds ends[2]; /* u, v */
    bool central;   /* on a ring: slopes are central differences; else of the smoothest function */
    double unit[2]; /* factor from slopes to table units per texel */
    double residual_deg; /* out: root mean square angle between the map's normals and the heights'
                            own */
    double tilt_deg[2];  /* out: on a ring, the mean slope, which periodic heights cannot have */
} WrIntegral;

/* The heights whose slopes are nearest to the map's in the least-squares sense; mean 0. On a free axis
 * slopes are summed from texel to texel to fourth order (third at the ends). sheet: created, of the
 * map's size. Errors: out of memory, "cancelled". */
bool wr_normals_integrate(const WrNormals *normals, WrIntegral *how, const WrGenerateJob *job,
                          WrSheet *sheet, WrError *err);
