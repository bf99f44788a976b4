/* bench_libmypaint.h - the yardstick of the brush's speed: libmypaint's own surface.
   For the program's benchmark alone.
   The same motion, with libmypaint's default brush (hardness 0.8, two dabs a radius): by the library's
   MyPaintFixedTiledSurface (16-bit RGBA), by our engine into our tiles, and as plain round dabs of ours at
   the same distance. All on one thread, pages touched once before. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

typedef struct WrBrushPace {
    double radius;                          /* texels */
    int table;                              /* texels along a side */
    int events;                             /* of the motion, 16 texels and 8 ms apart */
    int peer_dabs, engine_dabs, round_dabs; /* that it makes */
} WrBrushPace;

/* How much motion there is for about that many dabs, and how many there are exactly. */
bool wr_brush_pace(int table, double radius, int dabs, WrBrushPace *pace, WrError *err);

typedef struct WrBrushRace WrBrushRace; /* tables and brushes that stay from round to round */
WrBrushRace *wr_brush_race_new(const WrBrushPace *pace, WrError *err);
void wr_brush_race_free(WrBrushRace *race); /* NULL is fine */
/* Seconds of one round. */
double wr_brush_race_peer(WrBrushRace *race);
double wr_brush_race_engine(WrBrushRace *race);
double wr_brush_race_round(WrBrushRace *race);
