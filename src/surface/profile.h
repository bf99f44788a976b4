/* profile.h - the profile of a surface of revolution: a smooth curve through points (r, z), as cubics
   along v.

   v is proportional to the chord length between the points, 0..1, so that the table is stretched
   evenly. Between corners the curve is the cubic spline with continuous curvature, with natural ends. A
   point given twice in a row is a corner. An end on the axis is a smooth pole, as if the curve
   continued mirrored beyond it: z' = 0 and r'' = 0 there; given twice it is a tip. A profile without
   corners whose last point equals its first is a ring, smooth everywhere. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

#define WR_PROFILE_POINTS 65 /* a corner uses two */
#define WR_PROFILE_PIECES 64 /* a power of two */

/* Pieces are Bezier cubics, four r and four z each. from: 2 for unused pieces. */
typedef struct WrProfiled {
    double from[WR_PROFILE_PIECES], to[WR_PROFILE_PIECES],
        inv[WR_PROFILE_PIECES]; /* 1 / (to - from) */
    double r[4 * WR_PROFILE_PIECES], z[4 * WR_PROFILE_PIECES];
    int count;
} WrProfiled;
typedef struct WrProfilef {
    float from[WR_PROFILE_PIECES], to[WR_PROFILE_PIECES], inv[WR_PROFILE_PIECES];
    float r[4 * WR_PROFILE_PIECES], z[4 * WR_PROFILE_PIECES];
} WrProfilef;

/* Parses "r,z;r,z;...". Errors: not such a list; the curve touches or crosses the axis other than at
   its ends (the message contains the v); distinct points nearer to each other than 1e-5 of the length; too
   many points. */
bool wr_profile_make(const char *text, WrProfiled *out, WrError *err);
/* Parses only the points, r and z, without checking the curve: their number, 0 if the text is not such
 * a list. */
int wr_profile_points(const char *text, double points[WR_PROFILE_POINTS][2]);
void wr_profile_narrow(const WrProfiled *from, WrProfilef *to);
/* Positions where the direction may jump, 0 < v < 1: their number, at most `most`. */
int wr_profile_corners(const WrProfiled *profile, double *v, int most);
/* The middle of its z, and the radius of the bounding sphere about (0, 0, middle). */
void wr_profile_extent(const WrProfiled *profile, double *middle, double *radius);
