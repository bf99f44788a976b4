/* dirty_regions.h - what lets a resting view be brought up to date by an edit: which part of the table each patch of the last
   picture's pixels looked at.
   Layer 5, private to the renderer.

   A tile of the picture is cut into patches; of each the smallest box of the table's cell is kept that holds all places
   where its samples looked, round the cell's ends. Where a table's texels differ, boxes hold them, grown by the scheme's
   reach; only patches whose box meets one of those are rendered again: the picture has the bits that a whole new one
   would have. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrField WrField;

/* Of a patch, pixels. Higher ones would be drawn in fewer strips, wider ones in longer rows; smaller ones are fewer
   pixels that an edit does not reach. */
#define WR_DIRTY_W 16
#define WR_DIRTY_H 8
#define WR_DIRTY_CHANGES 48 /* boxes that differ, at most: then the nearest two become one */

/* Of the cell: from `u + low_u` to `u + high_u`, likewise v, round the ends; u, v in 0..1. high below low: nothing. */
typedef struct WrDirtyBox {
    float u, v, low_u, high_u, low_v, high_v;
} WrDirtyBox;

/* Zero-initialise; fini frees. */
typedef struct WrDirty {
    WrDirtyBox *patches; /* [tiles][down][across] of the last picture; NULL: nothing kept. Owned */
    WrDirtyBox *whole;   /* [tiles] what holds those of each. Owned */
    int tiles, across, down;
    int tile_w, tile_h, patch_w, patch_h; /* pixels */
    WrField *field;                       /* snapshot of the last picture's; NULL: none. Owned */
    WrDirtyBox changed[WR_DIRTY_CHANGES]; /* since then; by wr_dirty_compare */
    int changes;
} WrDirty;

/* A tile's patches, while they are noted. */
typedef struct WrDirtyNotes {
    WrDirtyBox *patches; /* NULL: nothing is noted */
    int across;
    bool single; /* there is one, wherever samples stand */
    int x, y;    /* pixels: the tile's place */
} WrDirtyNotes;

void wr_dirty_fini(WrDirty *keep);
/* Forget the picture and make room for a new one's tiles, of tile_w x tile_h pixels. whole: each is one patch. */
void wr_dirty_start(WrDirty *keep, int tiles, int tile_w, int tile_h, bool whole);
/* Note what is looked at from a tile that holds the pixel x, y; keep NULL: nothing. */
WrDirtyNotes wr_dirty_open(WrDirty *keep, int tile, int x, int y);
/* All of the tile was noted. */
void wr_dirty_close(WrDirty *keep, int tile);
/* Places in the table, 0..1, where up to WR_SPAN samples looked that stand at x, y in the grid of k a side of a pixel:
   float or double, by the size of one. */
void wr_dirty_note_places(const WrDirtyNotes *notes, int k, int count, size_t size, const void *x,
                          const void *y, const void *tu, const void *tv);
/* One such place, and all within reach of it; reach in 0..1. */
void wr_dirty_note_box(const WrDirtyNotes *notes, int k, double x, double y, double tu, double tv,
                       double reach_u, double reach_v);
/* Find what differs between the kept field and this one, of equal size and wrap: exact texels of the
 * tiles that differ, grown by `reach` texels. False: cannot be compared, or nothing is kept. */
bool wr_dirty_compare(WrDirty *keep, const WrField *field, int reach);
/* After wr_dirty_compare: besides, texels of the field that are marked (not 0), [height][width], and all within a texel of
   them. */
void wr_dirty_add_texels(WrDirty *keep, const WrField *field, const unsigned char *marked);
/* Do changes reach anything of the tile? */
bool wr_dirty_touches(const WrDirty *keep, int tile);
/* Do they reach patch `column`, `row` of it? */
bool wr_dirty_touches_patch(const WrDirty *keep, int tile, int column, int row);
/* The picture now shows this field. */
void wr_dirty_field(WrDirty *keep, const WrField *field);
