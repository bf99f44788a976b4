/* dirty_regions.h - dirty-region tracking for a static view: the part of the table that each patch of pixels
   used (E29). Private to the renderer.

   A tile of the picture is cut into patches. For each patch the cache stores the smallest box, in the table's
   periodic cell, that contains every (u,v) its samples fetched. After an edit, boxes are built around the texels
   that differ and are grown by the interpolation scheme's reach. Only patches whose box meets one of those are
   rendered again. The picture has the same bits as a full new render. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrField WrField;

/* Patch size, pixels. Higher patches would be drawn in fewer strips, wider ones in longer rows; smaller ones
   exclude more pixels that an edit does not reach. */
#define WR_DIRTY_W 16
#define WR_DIRTY_H 8
/* maximum number of changed boxes; beyond it the nearest two are merged */
#define WR_DIRTY_CHANGES 48

/* A box of the periodic cell: from `u + low_u` to `u + high_u`, and from `v + low_v` to `v + high_v`, round the
   ends. u, v in 0..1. high below low: empty. */
typedef struct WrDirtyBox {
    float u, v, low_u, high_u, low_v, high_v;
} WrDirtyBox;

/* Zero-initialise; fini frees. */
typedef struct WrDirty {
    /* [tiles][down][across] of the last picture; NULL: nothing recorded. Owned */
    WrDirtyBox *patches;
    WrDirtyBox *whole; /* [tiles] bounding box of each tile's patches. Owned */
    int tiles, across, down;
    int tile_w, tile_h, patch_w, patch_h; /* pixels */
    WrField *field; /* snapshot of the last picture's field; NULL: none. Owned */
    /* regions changed since then; written by wr_dirty_compare */
    WrDirtyBox changed[WR_DIRTY_CHANGES];
    int changes;
} WrDirty;

/* The patches of one tile while they are recorded. */
typedef struct WrDirtyNotes {
    WrDirtyBox *patches; /* NULL: nothing is recorded */
    int across;
    bool single; /* the tile is one patch, wherever its samples lie */
    int x, y;    /* pixels: the tile's position */
} WrDirtyNotes;

void wr_dirty_fini(WrDirty *keep);
/* Clears the record and allocates it for the tiles of a new picture, tile_w x tile_h pixels each. whole: each
   tile is one patch. */
void wr_dirty_start(WrDirty *keep, int tiles, int tile_w, int tile_h, bool whole);
/* Begins the record of the tile that contains pixel x, y. keep NULL: nothing is recorded. */
WrDirtyNotes wr_dirty_open(WrDirty *keep, int tile, int x, int y);
/* Ends the record of a tile. */
void wr_dirty_close(WrDirty *keep, int tile);
/* Records the table positions, 0..1, of up to WR_SPAN samples at x, y in a grid of k x k samples a pixel. size:
   sizeof(float) or sizeof(double), the element type of the four arrays. */
void wr_dirty_add_places(const WrDirtyNotes *notes, int k, int count, size_t size, const void *x,
                         const void *y, const void *tu, const void *tv);
/* Records one table position and everything within reach of it; reach in 0..1. */
void wr_dirty_add_box(const WrDirtyNotes *notes, int k, double x, double y, double tu, double tv,
                      double reach_u, double reach_v);
/* Finds the differences between the stored field and this one, of equal size and wrap: the differing texels of
   changed tiles, grown by `reach` texels. False: the fields cannot be compared, or nothing is stored. */
bool wr_dirty_compare(WrDirty *keep, const WrField *field, int reach);
/* Adds further texels after wr_dirty_compare: those marked (not 0) in [height][width], and their neighbours
   within one texel. */
void wr_dirty_add_texels(WrDirty *keep, const WrField *field, const unsigned char *marked);
/* True if a change reaches the tile. */
bool wr_dirty_touches(const WrDirty *keep, int tile);
/* True if a change reaches patch `column`, `row` of the tile. */
bool wr_dirty_touches_patch(const WrDirty *keep, int tile, int column, int row);
/* Stores a snapshot of the field that the picture now shows. */
void wr_dirty_store_field(WrDirty *keep, const WrField *field);
