#include "ui/input/pen_curve.h"

#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define KNOTS (WR_PEN_POINTS + 2)

WrPenCurve wr_pen_curve_default(void)
{
    return (WrPenCurve){ .minimum = 0.0,
                         .maximum = 1.0,
                         .gain = 1.0,
                         .x = { 0.25, 0.75 },
                         .y = { 0.25, 0.75 },
                         .count = 2 };
}

/* Rejects NaN too, since all comparisons with NaN are false. */
bool wr_pen_curve_valid(const WrPenCurve *c)
{
    bool valid = c->minimum >= 0.0 && c->minimum < c->maximum && c->maximum <= 1.0 &&
                 c->gain >= 0.1 && c->gain <= 10.0 && c->count >= 2 && c->count <= WR_PEN_POINTS;
    if (!valid) return false;
    valid = c->x[0] >= 0.0 && c->y[0] >= 0.0;
    for (int i = 1; i < c->count; i++)
        valid = valid && c->x[i - 1] < c->x[i] && c->y[i - 1] <= c->y[i];
    return valid && c->x[c->count - 1] <= 1.0 && c->y[c->count - 1] <= 1.0;
}

static double clamp01(double x)
{
    return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; /* NaN becomes 0 */
}

/* ---- interpolation: cubic Hermite pieces with the slope limit of Fritsch and Carlson, so that the curve is monotone
   where the points are and never overshoots ---- */

/* A point on the left (right) edge replaces (0,0) ((1,1)). */
static int knots_of(const WrPenCurve *c, double x[KNOTS], double y[KNOTS])
{
    int count = 0;
    if (c->x[0] > 0.0) x[count] = 0.0, y[count++] = 0.0;
    for (int i = 0; i < c->count; i++) x[count] = c->x[i], y[count++] = c->y[i];
    if (c->x[c->count - 1] < 1.0) x[count] = 1.0, y[count++] = 1.0;
    return count;
}

static bool is_straight(const WrPenCurve *c)
{
    bool straight = true;
    for (int i = 0; i < c->count; i++) straight = straight && c->x[i] == c->y[i];
    return straight;
}

/* Inner points: the harmonic mean of the two secants, weighted by their lengths; 0 if one is flat. */
static double slope_inside(double h0, double h1, double d0, double d1)
{
    if (d0 <= 0.0 || d1 <= 0.0) return 0.0;
    double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
    return (w0 + w1) / (w0 / d0 + w1 / d1);
}

/* End points: the parabola's slope, limited to 0 .. three times the first secant. */
static double slope_at_end(double h0, double h1, double d0, double d1)
{
    double s = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    return s < 0.0 ? 0.0 : s > 3.0 * d0 ? 3.0 * d0 : s;
}

static double curve_at(const WrPenCurve *c, double p)
{
    if (is_straight(c)) return p; /* exact */
    double x[KNOTS], y[KNOTS], h[KNOTS], d[KNOTS], s[KNOTS];
    int n = knots_of(c, x, y), i = 0;
    if (p <= x[0]) return y[0];
    if (p >= x[n - 1]) return y[n - 1];
    for (int k = 0; k + 1 < n; k++) {
        h[k] = x[k + 1] - x[k];
        d[k] = (y[k + 1] - y[k]) / h[k];
    }
    if (n == 2) return y[0] + d[0] * (p - x[0]);
    s[0] = slope_at_end(h[0], h[1], d[0], d[1]);
    s[n - 1] = slope_at_end(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
    for (int k = 1; k + 1 < n; k++) s[k] = slope_inside(h[k - 1], h[k], d[k - 1], d[k]);
    while (p > x[i + 1]) i++;
    double t = (p - x[i]) / h[i], u = 1.0 - t;
    double rise = t * t * (3.0 - 2.0 * t) * d[i] + t * u * u * s[i] - t * t * u * s[i + 1];
    return y[i] + h[i] * rise;
}

double wr_pen_curve_apply(const WrPenCurve *curve, double raw)
{
    WrPenCurve plain = wr_pen_curve_default();
    if (!wr_pen_curve_valid(curve)) curve = &plain;
    double p = clamp01((clamp01(raw) - curve->minimum) / (curve->maximum - curve->minimum));
    return clamp01(clamp01(curve_at(curve, p)) * curve->gain);
}

/* ---- text form ---- */

void wr_pen_curve_print(const WrPenCurve *c, char *text, int size)
{
    const double values[] = { c->minimum, c->maximum, c->gain, c->x[0], c->y[0], c->x[1], c->y[1] };
    WrText line = { 0 };
    for (int i = 0; i < 7; i++) {
        if (i > 0) wr_text_add(&line, " ");
        wr_text_add_number(&line, values[i]);
    }
    for (int i = 2; i < c->count; i++) {
        wr_text_add(&line, ";");
        wr_text_add_number(&line, c->x[i]);
        wr_text_add(&line, ",");
        wr_text_add_number(&line, c->y[i]);
    }
    snprintf(text, (size_t)size, "%s", wr_text_get(&line));
    wr_text_fini(&line);
}

/* Parse a number that ends at one of the marks; *text moves to the mark. */
static bool number(const char **text, const char *marks, double *value)
{
    const size_t length = strcspn(*text, marks);
    const bool good = wr_number_parse(*text, length, value);
    *text += length;
    return good;
}

bool wr_pen_curve_parse(const char *text, WrPenCurve *curve)
{
    double values[7];
    for (int i = 0; i < 7; i++) {
        if (!number(&text, i < 6 ? " " : ";", &values[i])) return false;
        if (*text == ' ' && i < 6) text++;
    }
    WrPenCurve c = { .minimum = values[0],
                     .maximum = values[1],
                     .gain = values[2],
                     .x = { values[3], values[5] },
                     .y = { values[4], values[6] },
                     .count = 2 };
    while (*text == ';') {
        text++;
        if (c.count == WR_PEN_POINTS || !number(&text, ",", &c.x[c.count]) || *text++ != ',' ||
            !number(&text, ";", &c.y[c.count]))
            return false;
        c.count++;
    }
    if (!wr_pen_curve_valid(&c)) return false;
    *curve = c;
    return true;
}

/* ---- simulated pressure of a mouse ---- */

#define SETTLE_SECONDS 0.04 /* half-life of a change of speed */

double wr_fake_pressure(WrFakePressure *fake, double distance, double seconds)
{
    if (!fake->by_speed) return fake->now = clamp01(fake->held);
    fake->now = clamp01(fake->now);
    if (!(distance >= 0.0 && seconds > 0.0)) return fake->now;
    double speed = distance / seconds, least = clamp01(fake->least), t;
    if (speed <= fake->slow) t = 0.0;
    else t = speed < fake->fast ? (speed - fake->slow) / (fake->fast - fake->slow) : 1.0;
    double target = 1.0 + clamp01(t) * (least - 1.0);
    double share = seconds < 1e6 ? seconds / (seconds + SETTLE_SECONDS) : 1.0;
    return fake->now = clamp01(fake->now + share * (target - fake->now));
}
