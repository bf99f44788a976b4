/* pen_curve.h - from a device's pressure to the brush's: minimum, gain, curve. No window needed. */
#pragma once
#include <stdbool.h>

/* p = clamp((raw - minimum) / (maximum - minimum), 0, 1), then the curve through (0,0), two points and
   (1,1), monotone and smooth; at last times gain, at most 1. */
typedef struct WrPenCurve {
    double minimum, maximum; /* 0 <= minimum < maximum <= 1 */
    double gain;             /* 0.1..10 */
    double x[2], y[2];       /* 0..1, x[0] < x[1], y[0] <= y[1] */
} WrPenCurve;

WrPenCurve wr_pen_curve_default(void); /* the straight line */
bool wr_pen_curve_valid(const WrPenCurve *curve);
/* raw not finite or out of range: 0, or the nearest. A curve that is not valid counts as the straight
   line. A point on the left edge takes the place of (0,0), one on the right edge that of (1,1). */
double wr_pen_curve_apply(const WrPenCurve *curve, double raw);
/* One line for the settings file and back. */
void wr_pen_curve_print(const WrPenCurve *curve, char *text, int size);
bool wr_pen_curve_parse(const char *text, WrPenCurve *curve);

/* Pressure for a mouse: by speed (slow presses hard), or as held by keys. */
typedef struct WrFakePressure {
    bool by_speed;
    double slow, fast; /* pixels a second: pressure 1 at slow or below, `least` at fast or above */
    double least;      /* 0..1 */
    double held;       /* 0..1: where it is not by speed */
    double now;        /* smoothed state; starts at held or 1 */
} WrFakePressure;
/* One motion of `distance` pixels in `seconds` (0: as before). Returns the pressure. */
double wr_fake_pressure(WrFakePressure *fake, double distance, double seconds);
