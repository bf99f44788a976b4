/* engine_internal.h - the two halves of the engine: calls of the library (engine.c), and the path
   (engine_path.c).
   Private to this module. */
#pragma once
#include <libmypaint/mypaint-brush.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/array.h"
#include "brush/engine.h"

typedef struct WrKnot {
    WrEnginePoint point;
    bool jump; /* the pen jumps here from the previous knot without drawing */
} WrKnot;

struct WrEngine {
    MyPaintSurface2 surface; /* first member: the callbacks receive its address */
    MyPaintBrush *brush;
    WrPreset *preset; /* shared */
    WrDabSink sink;
    double unit;           /* texels per pixel of the library */
    WrBrush look;          /* the brush, for the properties it adds to dabs; its preset and tip are
                              shared */
    uint64_t number;       /* of the next dab */
    bool angles;           /* the preset determines the rotation of its dabs */
    double radius, flow;   /* texels; 0..1 */
    bool erases, smudges;  /* of the preset */
    bool begun, finished;  /* positioned; pen lifted */
    bool ended;            /* stepped to the last point */
    bool muted;            /* steps without drawing: dabs are ignored */
    int dabs;              /* of the present step */
    bool drew, touched;    /* a dab was ever made; the library made one, even if empty */
    double last_x, last_y; /* of the previous dab, texels */
    double origin_x, origin_y; /* texels */
    WR_ARRAY(WrKnot) knots;    /* `seconds` is the engine's own monotonic time */
    int at;                    /* `now` is within knots[at] .. knots[at + 1] */
    double given;              /* original time of the last point */
    double now;                /* engine time of the last step */
    double left;               /* time not yet passed to the library */
    double steps;              /* number of whole steps in it */
    WrEnginePoint pen;         /* its position in the library */
};

static inline double clamp(double x, double low, double high)
{
    return x > low ? (x < high ? x : high) : low; /* NaN becomes low */
}

/* Starts at a stroke's first point, with its pressure and tilt, and the height there for dragging. */
void wr_engine_begin(WrEngine *engine, const WrEnginePoint *first);
/* Moves to a point, which makes dabs. */
void wr_engine_go(WrEngine *engine, const WrEnginePoint *to, double seconds);
/* The library's own estimate of the number of dabs on that segment, for its present states. */
double wr_engine_count(const WrEngine *engine, const WrEnginePoint *to, double seconds);
/* The accumulated fraction of the next dab, 0..1. */
double wr_engine_due(const WrEngine *engine);
/* Makes one dab at the pen, if the brush makes any. */
void wr_engine_tap(WrEngine *engine);
