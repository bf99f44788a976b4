/* pen_curve.h - mapping from a device's pressure to the brush's: minimum, gain, curve. No window needed. */
#pragma once
#include <stdbool.h>

#define WR_PEN_POINTS 8 /* limit of curve points; at least 2 */

/* p = clamp((raw - minimum) / (maximum - minimum), 0, 1), then the monotone smooth curve through (0,0), its points
   and (1,1), then multiplied by gain and limited to 1. */
typedef struct WrPenCurve {
    double minimum, maximum;                   /* 0 <= minimum < maximum <= 1 */
    double gain;                               /* 0.1..10 */
    double x[WR_PEN_POINTS], y[WR_PEN_POINTS]; /* 0..1; x increases, y does not decrease */
    int count;                                 /* number of points */
} WrPenCurve;

WrPenCurve wr_pen_curve_default(void); /* the straight line */
bool wr_pen_curve_valid(const WrPenCurve *curve);
/* raw that is not finite or out of range: 0, or the nearest limit. An invalid curve counts as the straight line. A
   first point on the left edge replaces (0,0), a last one on the right edge (1,1). */
double wr_pen_curve_apply(const WrPenCurve *curve, double raw);
/* Convert to and from seven words for the settings file; the last word holds all further points: "0 1 1 0.25 0.25 0.5
   0.6;0.7,0.9". */
#define WR_PEN_CURVE_TEXT 512
void wr_pen_curve_print(const WrPenCurve *curve, char *text, int size);
bool wr_pen_curve_parse(const char *text, WrPenCurve *curve);

/* Simulated pressure of a mouse: by speed (slow is high), or constant, set by keys. */
typedef struct WrFakePressure {
    bool by_speed;
    /* pixels per second: pressure 1 at slow or below, `least` at fast or above */
    double slow, fast;
    double least; /* 0..1 */
    double held;  /* 0..1: value if it does not depend on speed */
    double now;   /* smoothed state; starts at held or 1 */
} WrFakePressure;
/* Pressure after a motion of `distance` pixels in `seconds` (0: as before). */
double wr_fake_pressure(WrFakePressure *fake, double distance, double seconds);
