/* field.h - the height table F(u,v): W x H float32 texels in tiles of 64 x 64, shared by reference and
   copied on write.

   A snapshot is one pointer, and the cost of an edit depends only on the tiles it changes. Independent
   of files, windows, brushes and commands.

   Texel (i, j): column i from the left, row j from the TOP; its centre is u = (i + 0.5)/W, v = 1 - (j +
   0.5)/H. Heights are in table units, unbounded, always finite; 0 is the undisplaced surface. */
#pragma once
#include "base/hash.h"
#include "field/wrap.h"

#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef struct WrField WrField;

/* A table of width x height texels (1..WR_FIELD_MAX each), all at `level`. NULL and an error for a size
   out of range. The caller owns it. Texels use no memory until they differ. */
WrField *wr_field_new(int width, int height, WrWrap wrap_u, WrWrap wrap_v, float level,
                      WrError *err);

/* A second table with the same texels, in constant time; later writes to one do not affect the other.
   The caller owns it. Any number of threads may share one source at once while nobody writes to it. */
WrField *wr_field_share(const WrField *field);
void wr_field_free(WrField *field); /* NULL is allowed */
/* Returns the tile memory cached from freed tables to the system. Any thread. */
void wr_field_trim(void);

int wr_field_width(const WrField *field);
int wr_field_height(const WrField *field);
WrWrap wr_field_wrap_u(const WrField *field);
WrWrap wr_field_wrap_v(const WrField *field);

/* Changes with every write to this table; equal for shares without later writes, so a cache compares
   one number. Unique over the life of the process. */
uint64_t wr_field_key(const WrField *field);

/* One texel; 0 <= i < W, 0 <= j < H. */
float wr_field_get(const WrField *field, int i, int j);
/* For single texels; non-finite values become 0, values beyond float's range are clamped. Loops should
 * write tiles. */
void wr_field_set(WrField *field, int i, int j, float height);

/* Sets every texel to `height`; drops all tiles. */
void wr_field_fill(WrField *field, float height);

/* The 64 x 64 texels of tile (tx, ty), row by row from the top, texel (64 tx + x, 64 ty + y) at
   [64 y + x]; NULL while the whole tile still has the value wr_field_level. Texels beyond the table's
   edge are unused and hold the level. Valid until the next write. 64-byte aligned. */
const float *wr_field_tile(const WrField *field, int tx, int ty);
float wr_field_level(const WrField *field);
/* The tile for writing: copied first if shared, allocated if it was NULL. Unused texels must not
   change; heights written must be finite. Not for several threads at once on one field (fetch all
   pointers first, then fill them in parallel). */
float *wr_field_tile_write(WrField *field, int tx, int ty);
/* The same in two steps: the place of each tile, on one thread; then their texels, by any number of threads, each tile by one.
   A place belongs to the field, and is valid until the field is shared, freed or changed by another function. */
typedef struct WrFieldPlace WrFieldPlace;
WrFieldPlace *wr_field_tile_place(WrField *field, int tx, int ty);
float *wr_field_place_write(const WrField *field, WrFieldPlace *place);
/* The tile for writing with undefined content: the caller writes all texels, the unused ones with the
   level. */
float *wr_field_tile_fresh(WrField *field, int tx, int ty);
/* Allocates a tile that belongs to no table yet, with undefined content; any thread. Pass it to
 * wr_field_tile_put: */
float *wr_field_tile_make(void);
void wr_field_tile_free(float *texels); /* while it belongs to no table; NULL is allowed */
/* replaces tile (tx, ty) by `texels` and owns them. */
void wr_field_tile_put(WrField *field, int tx, int ty, float *texels);
/* Copies tile (tx, ty) from `from`, a table of the same size; later writes to one do not affect the
   other. By reference, except where unused texels have another level. */
void wr_field_tile_share(WrField *to, const WrField *from, int tx, int ty);
/* Shares the tiles of `field` that have the bits of `before`, so that composites and the history handle only the others.
   made: [tiles_v][tiles_u] from the top, 0: the tile was not made, and is taken from `before`; NULL: all were made.
   Nothing happens if either field is NULL, or their sizes, wraps or levels differ. */
void wr_field_share_equal(WrField *field, const WrField *before, const uint8_t *made);
/* Resets the tile's texels to the level and frees its memory. */
void wr_field_tile_drop(WrField *field, int tx, int ty);
int wr_field_tiles_u(const WrField *field); /* ceil(W / 64) */
int wr_field_tiles_v(const WrField *field);

/* Copies the rectangle of count_i x count_j texels at (i, j) to out, `pitch` floats a row. Indices may
   lie outside the table, on either side and by any amount: they wrap on a periodic axis and are
   extrapolated to second order on a clamped one (T[-1] = 3 T[0] - 3 T[1] + T[2], the quadratic through
   the three edge texels; repeated where the axis has fewer than 3). */
void wr_field_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                   size_t pitch);
/* A prefetch hint for texels of a row. Indices outside the table are allowed. */
void wr_field_expect(const WrField *field, int i, int j, int count_i);
/* Writes a rectangle that lies inside the table. Non-finite heights become 0; returns their number. */
int64_t wr_field_write(WrField *field, int i, int j, int count_i, int count_j, const float *in,
                       size_t pitch);

/* True if size and wrap are equal. */
bool wr_field_alike(const WrField *a, const WrField *b);
/* Calls changed(tx, ty, ctx) for each tile that may differ between a and b: those whose pointers
   differ. The sizes must be equal. The cost depends on the differences, not on the table size. */
typedef void (*WrTileVisitor)(int tx, int ty, void *ctx);
void wr_field_changes(const WrField *a, const WrField *b, WrTileVisitor changed, void *ctx);
/* The number of those tiles. */
int wr_field_changed_tiles(const WrField *a, const WrField *b);
/* Bounding box of the texels of tile (tx, ty) whose bits differ between a and b, of equal size: columns
   i0 <= i < i1 and rows j0 <= j < j1 of the table; all 0 if none differs. */
typedef struct WrFieldRect {
    int i0, i1, j0, j1;
} WrFieldRect;
WrFieldRect wr_field_difference(const WrField *a, const WrField *b, int tx, int ty);

/* Hash of size, wrap and every texel's bits; equal for equal contents, however they were produced. */
WrHash wr_field_hash(const WrField *field);
/* Smallest and largest height. */
void wr_field_range(const WrField *field, float *low, float *high);
/* Bytes of the tiles referenced by this table (shared ones included). */
size_t wr_field_bytes(const WrField *field);

/* Reduces a parameter to the table's period; every reduction uses this function:
 *
 *   U = r u;  U -= floor(U);  if !(U < 1) U = 0        (NUMERICS: HC35-HC41)
 *
 * For any input 0 <= U < 1; NaN and infinity give 0. In double, so that r = 1e6 is still right to
 * 1e-3 texel of 64 (HC40). */
static inline double wr_field_reduce(double u, double replicate)
{
    double x = replicate * u;
    x -= __builtin_floor(x);
    return x < 1.0 && x >= 0.0 ? x : 0.0;
}
