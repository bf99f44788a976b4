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
