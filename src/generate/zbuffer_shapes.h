/* zbuffer_shapes.h - intersections of a line a + b t with simple bodies.
   Private to the depth buffer. */
#pragma once
#include <math.h>
#include <stdbool.h>

typedef struct WrZSpan {
    double low, high; /* of t; empty where low > high */
} WrZSpan;

static inline WrZSpan wr_zspan_meet(WrZSpan a, WrZSpan b)
{
    return (WrZSpan){ a.low > b.low ? a.low : b.low, a.high < b.high ? a.high : b.high };
}

/* The interval with |a + b t| <= r on one axis. */
WrZSpan wr_zspan_slab(double a, double b, double r);
/* The interval with (a + b t) within r of the origin, by its first `axes` coordinates; the third is
 * first lowered by shift. */
WrZSpan wr_zspan_round(const double a[3], const double b[3], int axes, double shift, double r);

/* The largest t inside the torus of a ring of radius 1 in the plane of the first two coordinates and a
 * tube of radius `tube`; false if the line misses it. b is not 0. */
bool wr_ztorus_top(const double a[3], const double b[3], double tube, double *t);
