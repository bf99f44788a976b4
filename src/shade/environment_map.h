/* environment_map.h - surroundings as a light: a picture by longitude and latitude of what comes from each direction, out of a
   file or of a built-in set, and what diffuse light takes of it.

   y is up. The picture's middle is -z, +x is at three quarters of its width, as seen from inside:
     u = 1/2 + atan2(x, -z) / 2 pi,   v = 1/2 + atan2(y, hypot(x, z)) / pi
   bilinear between texels; columns wrap; straight up and down it is the mean of the nearest row, from every side, so that
   it is continuous everywhere (HC111). */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;

typedef enum WrEnvironmentMapKind {
    WR_ENVIRONMENT_MAP_OFF,
    WR_ENVIRONMENT_MAP_STUDIO,
    WR_ENVIRONMENT_MAP_SKY,
    WR_ENVIRONMENT_MAP_RAKING,
    WR_ENVIRONMENT_MAP_FILE,
    WR_ENVIRONMENT_MAP_KINDS
} WrEnvironmentMapKind;
extern const char
    *const wr_environment_map_names[WR_ENVIRONMENT_MAP_KINDS]; /* "off", "studio" ... "file" */

#define WR_ENVIRONMENT_MAP_MOST                                                                    \
    1e9f /* what a texel may hold; more, and infinity, becomes that (HC114) */
#define WR_ENVIRONMENT_MAP_WIDTH 4096 /* wider pictures are reduced to means of their texels */
#define WR_HARMONICS 9                /* of order 0, 1, 2 */

typedef struct WrEnvironmentMap {
    int refs;          /* atomic */
    WrImage *image;    /* three channels, linear, 0..WR_ENVIRONMENT_MAP_MOST; owned */
    bool even;         /* one colour everywhere */
    double pole[2][3]; /* means of the first row and of the last */
    /* L_lm by real harmonics 1; y, z, x; xy, yz, 3zz - 1, xz, xx - yy, each times its root */
    double harmonic[WR_HARMONICS][3];
} WrEnvironmentMap;

/* What of a file's numbers had to be changed. */
typedef struct WrEnvironmentMapTold {
    int64_t lost, below, above; /* no numbers: 0; negative: 0; beyond WR_ENVIRONMENT_MAP_MOST */
    int reduced;                /* texels a side that each one is the mean of; 1: none */
} WrEnvironmentMapTold;

/* Of any picture, which is not changed: codes are decoded from sRGB, alpha is left out. Errors: no memory, cancelled. */
WrEnvironmentMap *wr_environment_map_new(const WrImage *image, WrEnvironmentMapTold *told,
                                         WrError *err);
/* A built-in set; not off and not a file's. */
WrEnvironmentMap *wr_environment_map_built(WrEnvironmentMapKind kind, WrError *err);
WrEnvironmentMap *wr_environment_map_share(const WrEnvironmentMap *surround); /* NULL is fine */
void wr_environment_map_free(WrEnvironmentMap *surround);                     /* NULL is fine */

/* The direction of u, v and back; of no direction (0,0,0) the middle. */
WrVec3 wr_environment_map_direction(double u, double v);
void wr_environment_map_place(WrVec3 direction, double *u, double *v);
/* What comes from a place of the picture, and from a direction of any length. */
void wr_environment_map_at_place(const WrEnvironmentMap *surround, double u, double v,
                                 double rgb[3]);
void wr_environment_map_at(const WrEnvironmentMap *surround, WrVec3 direction, double rgb[3]);

/* Row-major: a direction of the world -> the same of the picture, where the surroundings are turned about the world's y
   by an angle of any size; whole turns are taken off exactly (HC116). */
void wr_environment_map_turn(double turn_deg, double out[9]);

#define WR_FORM_TERMS 10
/* Diffuse light over pi, as a lamp's n.l: E / pi = k + b n + n Q n, by Lambert's cosine (Ramamoorthi, Hanrahan 2001), as
   k, bx by bz, Qxx Qyy Qzz, 2Qxy 2Qyz 2Qxz for each colour. axes: row-major, what n is of -> the picture's directions.
   order: 0, 1 or 2: what is beyond it is left out. Of surroundings that are nowhere below 0 it is off by -19/480 to 3/32 of the integral of L at most, and may be below 0. */
void wr_environment_map_form(const WrEnvironmentMap *surround, const double axes[9],
                             double strength, int order, double out[3][WR_FORM_TERMS]);
