/* bench_libmypaint.h - speed comparison of the brush with libmypaint's own surface. Only for the
   program's benchmark. One motion with libmypaint's default brush (hardness 0.8, two dabs per radius)
   is drawn three times: by the library's MyPaintFixedTiledSurface (16-bit RGBA), by our engine into our
   tiles, and as our plain round dabs at the same distance. All on one thread, with all memory pages
   touched before. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

typedef struct WrBrushPace {
    double radius;                          /* texels */
    int table;                              /* texels along a side */
    int events;                             /* of the motion, 16 texels and 8 ms apart */
    int peer_dabs, engine_dabs, round_dabs; /* resulting number of dabs */
} WrBrushPace;

/* Computes the length of the motion for about that many dabs, and their exact numbers. */
bool wr_brush_pace(int table, double radius, int dabs, WrBrushPace *pace, WrError *err);

typedef struct WrBrushRace WrBrushRace; /* tables and brushes reused in all rounds */
WrBrushRace *wr_brush_race_new(const WrBrushPace *pace, WrError *err);
void wr_brush_race_free(WrBrushRace *race); /* NULL is allowed */
/* Seconds of one round. */
double wr_brush_race_peer(WrBrushRace *race);
double wr_brush_race_engine(WrBrushRace *race);
double wr_brush_race_round(WrBrushRace *race);
