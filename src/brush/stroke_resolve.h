/* stroke_resolve.h - computation of heights from those before the stroke and its coverage.
   Private to this module. */
#pragma once
#include "brush/blend_target.h"

#include <stdbool.h>

typedef struct WrMaker {
    WrBrushGround ground; /* borrowed */
    WrBrush brush;        /* sane */
    WrField *start;       /* the table before the stroke; owned */
    WrField *mark_start;  /* the mark before the stroke, if erasing lowers it; owned, or NULL */
    const WrModeWork *work;
    WrModeArgs args;
    WrTargets targets;
} WrMaker;

void wr_maker_init(WrMaker *maker, const WrBrushGround *ground, const WrBrush *brush);
void wr_maker_fini(WrMaker *maker);
/* Sets flatten's height: that of the texel at (x, y), before the stroke. */
void wr_maker_first(WrMaker *maker, double x, double y);

/* A rectangle of one tile's texels. */
typedef struct WrStrokeResolve {
    int tx, ty;
    int low_y, high_y;                  /* rows in the tile */
    int low_x, count;                   /* columns in the tile: whole blocks */
    const float *cover, *rest, *target; /* of the tile; rest and target may be NULL */
    bool within_1;                      /* no coverage is above 1 */
    float *out, *mark;                  /* of the tile; for wr_stroke_resolve */
} WrStrokeResolve;

/* True if nothing is selected in that tile. */
bool wr_maker_closed(const WrMaker *maker, int tx, int ty);
/* True if any texel of it may change, judging by coverage and selection. */
bool wr_stroke_resolve_needed(const WrMaker *maker, const WrStrokeResolve *make);
/* Opens the tile for writing: sets out and mark. Not for several threads at once. */
void wr_stroke_resolve_open(const WrMaker *maker, WrStrokeResolve *make);
/* Any number of threads, on different tiles. */
void wr_stroke_resolve(const WrMaker *maker, const WrStrokeResolve *make);
