/* stroke_resolve.h - heights made anew from those before the stroke and from its coverage.
   Private to this module. */
#pragma once
#include "brush/blend_target.h"

#include <stdbool.h>

typedef struct WrMaker {
    WrBrushGround ground; /* borrowed */
    WrBrush brush;        /* sane */
    WrField *start;       /* the table as it was; owned */
    WrField *mark_start;  /* the same of the mark, where erasing lowers it; owned, or NULL */
    const WrModeWork *work;
    WrModeArgs args;
    WrTargets targets;
} WrMaker;

void wr_maker_init(WrMaker *maker, const WrBrushGround *ground, const WrBrush *brush);
void wr_maker_fini(WrMaker *maker);
/* Flatten goes by the texel that holds (x, y), of the table as it was. */
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

/* Is nothing selected in that tile at all? */
bool wr_maker_closed(const WrMaker *maker, int tx, int ty);
/* Does any texel of it change, as far as coverage and selection say? */
bool wr_stroke_resolve_needed(const WrMaker *maker, const WrStrokeResolve *make);
/* Open the tile for writing: sets out and mark. Not for several threads at once. */
void wr_stroke_resolve_open(const WrMaker *maker, WrStrokeResolve *make);
/* Any number of threads, on tiles that differ. */
void wr_stroke_resolve(const WrMaker *maker, const WrStrokeResolve *make);
