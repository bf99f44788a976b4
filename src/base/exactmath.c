#include "base/exactmath.h"

#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sleef.h>

static void sincos_turns(double u, double *sine, double *cosine)
{
    double r = u - rint(u);       /* -1/2 .. 1/2, exact */
    double q = rint(4.0 * r);     /* nearest quarter turn, times 4: -2 .. 2 */
    double x = 2.0 * (r - q / 4); /* distance from it in turns, -1/8 .. 1/8, exact */
    double s = Sleef_cinz_sinpid1_u05purec(x), c = Sleef_cinz_cospid1_u05purec(x);
    switch ((int)q & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
    }
    *sine += 0.0; /* no negative zero */
    *cosine += 0.0;
}

#define LATEST_BITS 6

/* Points of a grid share their coordinates: most angles are among the latest of a thread. */
void wr_sincos_turns(double u, double *sine, double *cosine)
{
    static _Thread_local struct {
        double u, sine, cosine; /* both 0: empty */
    } latest[1 << LATEST_BITS];
    uint64_t bits;
    memcpy(&bits, &u, sizeof bits);
    const int at = (int)(bits * 0x9e3779b97f4a7c15U >> (64 - LATEST_BITS));
    if (latest[at].u != u || (latest[at].sine == 0 && latest[at].cosine == 0)) {
        sincos_turns(u, &latest[at].sine, &latest[at].cosine);
        latest[at].u = u;
    }
    *sine = latest[at].sine;
    *cosine = latest[at].cosine;
}

double wr_exp2(double x)
{
    return Sleef_cinz_exp2d1_u10purec(x);
}

double wr_log2(double x)
{
    return Sleef_cinz_log2d1_u10purec(x);
}

double wr_pow(double x, double y)
{
    return Sleef_cinz_powd1_u10purec(x, y);
}

double wr_hypot(double x, double y)
{
    return Sleef_cinz_hypotd1_u05purec(x, y);
}

double wr_sin(double x)
{
    return Sleef_cinz_sind1_u10purec(x);
}

double wr_cos(double x)
{
    return Sleef_cinz_cosd1_u10purec(x);
}

double wr_tan(double x)
{
    return Sleef_cinz_tand1_u10purec(x);
}

double wr_atan(double x)
{
    return Sleef_cinz_atand1_u10purec(x);
}

double wr_atan2(double y, double x)
{
    return Sleef_cinz_atan2d1_u10purec(y, x);
}

double wr_asin(double x)
{
    return Sleef_cinz_asind1_u10purec(x);
}

double wr_acos(double x)
{
    return Sleef_cinz_acosd1_u10purec(x);
}
