/* keep.h - what lets a resting view be brought up to date by an edit: which part of the table each tile
   of the last picture looked at.
   Layer 5, private to the renderer.

   The table's cell is cut into WR_KEEP_SIDE x WR_KEEP_SIDE blocks; a tile of the picture has a bit for each
   block that one of its samples fell into. Where a table's texels differ, their blocks (and those within
   the scheme's reach) are marked, and only tiles with a marked block are rendered again: the picture has
   the bits that a whole new one would have. */
#pragma once
#include "render/kern.h"

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
/* The strip's samples, whose places in the table are known (after a look-up). */
void wr_keep_note(WrBlocks *seen, const WrStrip *strip);
/* Mark what differs between the kept field and this one, of equal size and wrap: exact texels of the
 * tiles that differ, grown by `reach` texels. False: cannot be compared, or nothing is kept. */
bool wr_keep_compare(WrKeep *keep, const WrField *field, int reach);
bool wr_keep_touches(const WrKeep *keep, int tile);
/* The picture now shows this field. */
void wr_keep_field(WrKeep *keep, const WrField *field);
