/* pen_curve.h - from a device's pressure to the brush's: minimum, gain, curve. No window needed. */
#pragma once
#include <stdbool.h>

#define WR_PEN_POINTS 8 /* of a curve, at most; at least 2 */

/* p = clamp((raw - minimum) / (maximum - minimum), 0, 1), then the curve through (0,0), its points and
   (1,1), monotone and smooth; at last times gain, at most 1. */
typedef struct WrPenCurve {
    double minimum, maximum;                   /* 0 <= minimum < maximum <= 1 */
    double gain;                               /* 0.1..10 */
    double x[WR_PEN_POINTS], y[WR_PEN_POINTS]; /* 0..1; x rises, y does not fall */
    int count;                                 /* of the points */
} WrPenCurve;

WrPenCurve wr_pen_curve_default(void); /* the straight line */
bool wr_pen_curve_valid(const WrPenCurve *curve);
/* raw not finite or out of range: 0, or the nearest. A curve that is not valid counts as the straight
   line. A first point on the left edge takes the place of (0,0), a last one on the right edge that of (1,1). */
double wr_pen_curve_apply(const WrPenCurve *curve, double raw);
/* Seven words for the settings file and back, all further points in the last one: "0 1 1 0.25 0.25 0.5 0.6;0.7,0.9". */
#define WR_PEN_CURVE_TEXT 512
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
