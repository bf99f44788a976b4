/* profile.h - the profile of a surface of revolution: a smooth curve through points (r, z), as cubics along v.

   v goes by the length of the chords between the points, 0..1, so that the table is stretched alike all along. Between
   corners the curve is the cubic spline with continuous curvature, straight at its ends. A point given twice in a row is
   a corner. An end on the axis is a smooth pole, as if the curve went on beyond it in the mirror: z' = 0 and r'' = 0
   there; given twice it is a tip. A profile without corners whose last point is its first is a ring, smooth all round. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

#define WR_PROFILE_POINTS 65 /* of which corners take two */
#define WR_PROFILE_PIECES 64 /* a power of two */

/* Pieces are Bezier cubics, four r and four z each. from: 2 where there is no piece. */
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

/* Of "r,z;r,z;...". Refused: what is no such list, a curve that touches or crosses the axis but at its ends (the message
   says at which v), points that are nearer to each other than 1e-5 of the length and not the same, more points than fit. */
bool wr_profile_make(const char *text, WrProfiled *out, WrError *err);
/* The points alone, r and z, without asking what curve goes through them: how many, 0 where the text is no such list. */
int wr_profile_points(const char *text, double points[WR_PROFILE_POINTS][2]);
void wr_profile_narrow(const WrProfiled *from, WrProfilef *to);
/* Where the direction may jump, 0 < v < 1: how many, at most `most`. */
int wr_profile_corners(const WrProfiled *profile, double *v, int most);
/* The middle of its z, and the radius of the ball about (0, 0, middle) that holds the surface. */
void wr_profile_extent(const WrProfiled *profile, double *middle, double *radius);
