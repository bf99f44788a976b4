/* environment_map.h - environment lighting: a longitude-latitude picture of the incoming light, from a
   file or a built-in set, and its diffuse lighting.

   y is up. The picture's middle is -z, +x is at three quarters of its width, as seen from inside:

     u = 1/2 + atan2(x, -z) / 2 pi,   v = 1/2 + atan2(y, hypot(x, z)) / pi

   Bilinear between texels; columns wrap; at the poles it is the mean of the nearest row, from every
   side, so that it is continuous everywhere (HC111). */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;

/* The built-in sets, one row each: enumerator; word in commands; label in the window, English; function in
   environment_map.c of the light from a direction. */
#define WR_ENVIRONMENT_SETS(X)                                                                     \
    X(STUDIO, "studio", "Studio", studio)                                                          \
    X(SKY, "sky", "Sky", sky)                                                                      \
    X(RAKING, "raking", "Raking", raking)                                                          \
    X(OVERCAST, "overcast", "Overcast", overcast)                                                  \
    X(WINDOW, "window", "Window", window)                                                          \
    X(SUNSET, "sunset", "Sunset", sunset)

typedef enum WrEnvironmentMapKind {
    WR_ENVIRONMENT_MAP_OFF,
#define WR_X(KIND, word, label, light) WR_ENVIRONMENT_MAP_##KIND,
    WR_ENVIRONMENT_SETS(WR_X)
#undef WR_X
        WR_ENVIRONMENT_MAP_FILE,
    WR_ENVIRONMENT_MAP_KINDS
} WrEnvironmentMapKind;
extern const char *const wr_environment_map_names[WR_ENVIRONMENT_MAP_KINDS];
extern const char *const wr_environment_map_labels[WR_ENVIRONMENT_MAP_KINDS]; /* English */

#define WR_ENVIRONMENT_MAP_MAX                                                                     \
    1e9f /* largest texel value; larger values and infinity are replaced by it (HC114) */
#define WR_ENVIRONMENT_MAP_WIDTH 4096 /* wider pictures are reduced by averaging texels */
#define WR_HARMONICS 9                /* of orders 0, 1, 2 */

typedef struct WrEnvironmentMap {
    int refs;          /* atomic */
    WrImage *image;    /* three channels, linear, 0..WR_ENVIRONMENT_MAP_MAX; owned */
    bool even;         /* constant colour */
    double pole[2][3]; /* means of the first row and of the last */
    /* L_lm of real harmonics: 1; y, z, x; xy, yz, 3zz - 1, xz, xx - yy, each with its normalisation */
    double harmonic[WR_HARMONICS][3];
} WrEnvironmentMap;

/* Changes made to a file's numbers. */
typedef struct WrEnvironmentMapChanges {
    /* numbers replaced: NaN by 0, negative ones by 0, larger ones and infinity by WR_ENVIRONMENT_MAP_MAX */
    int64_t not_numbers, negative, too_large;
    int reduced; /* side in texels of the averaged blocks; 1: none */
} WrEnvironmentMapChanges;

/* Creates a map from any picture, which is unchanged: codes are decoded from sRGB, alpha is ignored.
 * Errors: out of memory, cancelled. */
WrEnvironmentMap *wr_environment_map_new(const WrImage *image, WrEnvironmentMapChanges *changes,
                                         WrError *err);
/* A built-in set; kind: not off and not file. */
WrEnvironmentMap *wr_environment_map_built(WrEnvironmentMapKind kind, WrError *err);
WrEnvironmentMap *wr_environment_map_share(const WrEnvironmentMap *map); /* NULL is allowed */
void wr_environment_map_free(WrEnvironmentMap *map);                     /* NULL is allowed */

/* The direction of u, v, and the inverse; the zero vector maps to the middle. */
WrVec3 wr_environment_map_direction(double u, double v);
void wr_environment_map_place(WrVec3 direction, double *u, double *v);
/* The light at a position of the picture, and from a direction of any length. */
void wr_environment_map_at_place(const WrEnvironmentMap *map, double u, double v, double rgb[3]);
void wr_environment_map_at(const WrEnvironmentMap *map, WrVec3 direction, double rgb[3]);

/* Row-major rotation from world directions to the picture's, for surroundings turned about the world's
   y by any angle; whole turns are subtracted exactly (HC116). */
void wr_environment_map_turn(double turn_deg, double out[9]);

#define WR_FORM_TERMS 10
/* Diffuse light over pi, in the scale of a lamp's n.l: E / pi = k + b n + n Q n, for Lambert's cosine
   (Ramamoorthi, Hanrahan 2001), as k, bx by bz, Qxx Qyy Qzz, 2Qxy 2Qyz 2Qxz for each colour. axes:
   row-major, from the space of n to the picture's directions. order: 0, 1 or 2: higher orders are
   dropped. For surroundings that are nowhere negative the error is -19/480 to 3/32 of the integral of L
   at most, and the result may be negative. */
void wr_environment_map_form(const WrEnvironmentMap *map, const double axes[9], double strength,
                             int order, double out[3][WR_FORM_TERMS]);
