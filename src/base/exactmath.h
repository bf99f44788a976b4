/* exactmath.h - transcendental functions with the same bits on every processor (SLEEF's FMA-free scalar
   functions).

   Used for heights and for the double-precision path. The results of libm differ between processors, so
   no computation of a height may call it. */
#pragma once
#include <math.h>

/* sin and cos of 2 pi u, u in turns, any finite value. The reduction is exact: whole, half and quarter
   turns return exactly 0, 1 or -1. Error under 1 ulp. */
void wr_sincos_turns(double u, double *sine, double *cosine);

double wr_exp2(double x);            /* 1 ulp */
double wr_log2(double x);            /* 1 ulp; x > 0 */
double wr_pow(double x, double y);   /* 1 ulp; pow(0,0) = 1 */
double wr_hypot(double x, double y); /* 1 ulp */
double wr_sin(double x);             /* 1 ulp, radians */
double wr_cos(double x);             /* 1 ulp, radians */
double wr_tan(double x);             /* 1 ulp, radians */
double wr_atan(double x);            /* 1 ulp, radians */
double wr_atan2(double y, double x); /* 1 ulp, radians */
double wr_asin(double x);            /* 1 ulp, radians */
double wr_acos(double x);            /* 1 ulp, radians */

#define WR_PI 3.14159265358979323846
#define WR_RAD_PER_DEG (WR_PI / 180.0)
#define WR_DEG_PER_RAD (180.0 / WR_PI)

/* The equal angle in -180..180; for a difference of angles, the short way. */
static inline double wr_signed_degrees(double degrees)
{
    return degrees - 360.0 * rint(degrees / 360.0);
}
