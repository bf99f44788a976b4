/* engine_internal.h - the two halves of the engine: how the library is driven (engine.c), and the path that it
   is driven along (engine_path.c).
   Private to this module. */
#pragma once
#include <libmypaint/mypaint-brush.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/array.h"
#include "brush/engine.h"

typedef struct WrKnot {
    WrEnginePoint point;
    bool jump; /* the pen comes here from the knot before without a way */
} WrKnot;

struct WrEngine {
    MyPaintSurface2 surface; /* first: the callbacks get its address */
    MyPaintBrush *brush;
    WrPreset *preset; /* shared */
    WrDabSink sink;
    double unit;           /* texels a pixel of the library's */
    WrBrush look;          /* the brush, for what it adds to dabs; its preset and tip are shared */
    uint64_t number;       /* of the next dab */
    bool angles;           /* the preset says how its dabs are turned */
    double radius, flow;   /* texels; 0..1 */
    bool erases, smudges;  /* of the preset */
    bool begun, finished;  /* placed; the pen is up */
    bool ended;            /* stepped to the last point */
    bool muted;            /* steps over nothing: no dab counts */
    int dabs;              /* of the step under way */
    bool drew, touched;    /* a dab was made ever; the library made one, be it empty */
    double last_x, last_y; /* of the dab before, texels */
    double origin_x, origin_y; /* texels */
    WR_ARRAY(WrKnot) knots;    /* `seconds` is the engine's own time, which never falls */
    int at;                    /* knots[at] .. knots[at + 1] holds `now` */
    double given;              /* the last point's seconds as they were given */
    double now;                /* engine time that was stepped to */
    double left;               /* seconds of it that the library was not told yet */
    double steps;              /* whole ones of them */
    WrEnginePoint pen;         /* where the library thinks it */
};

static inline double clamp(double x, double low, double high)
{
    return x > low ? (x < high ? x : high) : low; /* NaN gives low */
}

/* Put down at a stroke's first point, with its pressure and tilt, and with the height there to drag. */
void wr_engine_begin(WrEngine *engine, const WrEnginePoint *first);
/* Go to a point, which makes dabs. */
void wr_engine_go(WrEngine *engine, const WrEnginePoint *to, double seconds);
/* The library's own count: how many dabs it would make on that way, as its states are now. */
double wr_engine_count(const WrEngine *engine, const WrEnginePoint *to, double seconds);
/* The part of a dab that is due already, 0..1. */
double wr_engine_due(const WrEngine *engine);
/* One dab where the pen is, if the brush makes any. */
void wr_engine_tap(WrEngine *engine);
