/* keep.h - what lets a resting view be brought up to date by an edit: which part of the table each tile
   of the last picture looked at.
   Layer 5, private to the renderer.

   The table's cell is cut into WR_KEEP_SIDE x WR_KEEP_SIDE blocks; a tile of the picture has a bit for each
   block that one of its samples fell into. Where a table's texels differ, their blocks (and those within
   the scheme's reach) are marked, and only tiles with a marked block are rendered again: the picture has
   the bits that a whole new one would have. */
#pragma once
#include "render/kern.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_KEEP_SIDE 64

typedef struct WrBlocks {
    uint64_t row[WR_KEEP_SIDE]; /* row v, from v = 0 up; bit u */
} WrBlocks;

/* Zero-initialise; fini frees. */
typedef struct WrKeep {
    WrBlocks *seen; /* [tiles] of the last picture; NULL: nothing is kept. Owned */
    int tiles;
    WrField *field;   /* snapshot of the last picture */
    WrBlocks changed; /* since then; by wr_keep_compare */
} WrKeep;

void wr_keep_fini(WrKeep *keep);
/* Forget the picture and make room for a new one's tiles. */
void wr_keep_start(WrKeep *keep, int tiles);
/* Places in the table, 0..1, where samples looked: float or double, by the size of one. */
void wr_keep_note_places(WrBlocks *seen, int count, size_t size, const void *tu, const void *tv);
/* A place and all within reach of it, round the table's ends; reach in 0..1. */
void wr_keep_note_box(WrBlocks *seen, double tu, double tv, double reach_u, double reach_v);
/* Mark what differs between the kept field and this one, of equal size and wrap: exact texels of the
 * tiles that differ, grown by `reach` texels. False: cannot be compared, or nothing is kept. */
bool wr_keep_compare(WrKeep *keep, const WrField *field, int reach);
bool wr_keep_touches(const WrKeep *keep, int tile);
/* The picture now shows this field. */
void wr_keep_field(WrKeep *keep, const WrField *field);
