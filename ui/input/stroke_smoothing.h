/* stroke_smoothing.h - a steadier hand: what is drawn follows the pointer along a smoother way. No window needed.

   Both kinds go by the way that the pointer goes, not by time or by the number of events: the same path
   gives the same line however it was cut into motions, up to rounding. Between two places of the pointer
   its path is straight, and what follows it has a closed form:

   smooth   p' = (q - p) / L along the pointer's way s: for q = a + m s,
            p(s) = q(s) - L m + (p(0) - a + L m) exp(-s/L)
   string   p hangs on a string of length L: it rests while |q - p| < L and then is dragged along a tractrix,
            tan(t/2) = tan(t0/2) exp(-s/L), t the angle between the string and the pointer's way */
#pragma once
#include <stdbool.h>

typedef enum WrRelightKind {
    WR_RELIGHT_OFF,
    WR_RELIGHT_SMOOTH,
    WR_RELIGHT_STRING,
    WR_RELIGHT_COUNT
} WrRelightKind;

typedef struct WrRelightPoint {
    double x, y; /* pixels */
    double pressure, tilt_x, tilt_y, seconds;
} WrRelightPoint;

typedef struct WrRelight {
    WrRelightKind kind;
    double length;           /* L, pixels; 0: off */
    WrRelightPoint pointer;  /* newest place of the pointer */
    WrRelightPoint follower; /* and of what is drawn */
} WrRelight;

/* What comes out of one motion: at most this many points, a few pixels apart on curves. */
#define WR_RELIGHT_POINTS 64

/* The line begins at `at`, which is its first point. */
void wr_relight_begin(WrRelight *steady, WrRelightKind kind, double length,
                      const WrRelightPoint *at);
/* The pointer moved on straight to `to`. Returns how many points follow on the line. A follower that rests
 * gives none. */
int wr_relight_move(WrRelight *steady, const WrRelightPoint *to,
                    WrRelightPoint out[WR_RELIGHT_POINTS]);
/* The line ends: a smooth one comes to the pointer; one on a string does so only if `catch_up`. Returns 0 or
 * 1 points. */
int wr_relight_end(WrRelight *steady, bool catch_up, WrRelightPoint *out);
