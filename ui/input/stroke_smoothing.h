/* stroke_smoothing.h - stroke stabilizer: the drawn line follows the pointer along a smoother path. No window needed.

   Both kinds depend on the pointer's path length, not on time or the number of events: the same path results in the
   same line for any division into motions, up to rounding. Between two pointer positions the path is straight, and
   the follower has a closed form:

   smooth   p' = (q - p) / L along the pointer's path length s: for q = a + m s,
            p(s) = q(s) - L m + (p(0) - a + L m) exp(-s/L)
   string   p is on a string of length L: it rests while |q - p| < L and is then dragged along a tractrix,
            tan(t/2) = tan(t0/2) exp(-s/L), t the angle between the string and the pointer's path */
#pragma once
#include <stdbool.h>

typedef enum WrSmoothingKind {
    WR_SMOOTHING_OFF,
    WR_SMOOTHING_SMOOTH,
    WR_SMOOTHING_STRING,
    WR_SMOOTHING_COUNT
} WrSmoothingKind;

typedef struct WrSmoothingPoint {
    double x, y; /* pixels */
    double pressure, tilt_x, tilt_y, seconds;
} WrSmoothingPoint;

typedef struct WrSmoothing {
    WrSmoothingKind kind;
    double length;             /* L, pixels; 0: off */
    WrSmoothingPoint pointer;  /* newest position of the pointer */
    WrSmoothingPoint follower; /* newest position of the drawn line */
} WrSmoothing;

/* Limit of points resulting from one motion, a few pixels apart on curves. */
#define WR_SMOOTHING_POINTS 64

/* Start the line at `at`, its first point. */
void wr_smoothing_begin(WrSmoothing *steady, WrSmoothingKind kind, double length,
                        const WrSmoothingPoint *at);
/* The pointer moved straight to `to`. Returns the number of new points on the line; none while the follower rests. */
int wr_smoothing_move(WrSmoothing *steady, const WrSmoothingPoint *to,
                      WrSmoothingPoint out[WR_SMOOTHING_POINTS]);
/* End the line: a smooth one is drawn to the pointer, one on a string only if `catch_up`. Returns 0 or 1 points. */
int wr_smoothing_end(WrSmoothing *steady, bool catch_up, WrSmoothingPoint *out);
