/* field.h - the height table F(u,v): W x H float32 texels in tiles of 64 x 64, shared by reference and
   copied on write, so that a snapshot is one pointer and an edit costs what it touches.
   Knows nothing of files, windows, brushes or commands.

   Texel (i, j): column i from the left, row j from the TOP; its centre is u = (i + 0.5)/W,
   v = 1 - (j + 0.5)/H. Heights are in table units, unbounded, always finite; 0 is the ground. */
#pragma once
#include "base/hash.h"
#include "field/wrap.h"

#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef struct WrField WrField;

/* A table of width x height texels (1..WR_FIELD_MAX each), every one `height`. NULL and an error for a
   size out of range. The caller owns it. Costs no memory for texels until they differ. */
WrField *wr_field_new(int width, int height, WrWrap wrap_u, WrWrap wrap_v, float level,
                      WrError *err);

/* A second table with the same texels, in constant time; later writes to either do not show in the
   other. The caller owns it. Any number of threads may share one source at once as long as none
   writes to it. */
WrField *wr_field_share(const WrField *field);
void wr_field_free(WrField *field); /* NULL is fine */
/* What freed tables leave for the next one goes back to the system. Any thread. */
void wr_field_trim(void);

int wr_field_width(const WrField *field);
int wr_field_height(const WrField *field);
WrWrap wr_field_wrap_u(const WrField *field);
WrWrap wr_field_wrap_v(const WrField *field);

/* Changes with every write to this table, equal for shares that nobody wrote to since: a cache
   compares one number. Unique over the life of the process. */
uint64_t wr_field_key(const WrField *field);

/* One texel; 0 <= i < W, 0 <= j < H. */
float wr_field_get(const WrField *field, int i, int j);
/* For single texels; not finite becomes 0, beyond float's range is clamped. Loops should write tiles. */
void wr_field_set(WrField *field, int i, int j, float height);

/* Every texel becomes `height`; drops all tiles. */
void wr_field_fill(WrField *field, float height);

/* The 64 x 64 texels of tile (tx, ty), row by row from the top, texel (64 tx + x, 64 ty + y) at
   [64 y + x]; NULL while the whole tile still has the value wr_field_level. Texels beyond the table's
   edge are unused and hold the level. Valid until the next write. 64-byte aligned. */
const float *wr_field_tile(const WrField *field, int tx, int ty);
float wr_field_level(const WrField *field);
/* The same for writing: copied first if shared, made if it was NULL. Unused texels must stay as they
   are; heights written must be finite. Not for several threads at once on one field (fetch all
   pointers first, then fill them in parallel). */
float *wr_field_tile_write(WrField *field, int tx, int ty);
/* The same with whatever texels the memory held before: the caller writes all of them, the unused ones
   with the level. */
float *wr_field_tile_fresh(WrField *field, int tx, int ty);
/* Texels of a tile that no table has yet, of any content; any thread. They are to be put into one: */
float *wr_field_tile_make(void);
/* whose tile they then are, in the place of what it had. */
void wr_field_tile_put(WrField *field, int tx, int ty, float *texels);
/* Tile (tx, ty) of `to` becomes that of `from`, a table of the same size; later writes to either do not show in the
   other. By reference, but where unused texels stand for another level. */
void wr_field_tile_share(WrField *to, const WrField *from, int tx, int ty);
/* The tile's texels have the level again, without memory. */
void wr_field_tile_drop(WrField *field, int tx, int ty);
int wr_field_tiles_u(const WrField *field); /* ceil(W / 64) */
int wr_field_tiles_v(const WrField *field);

/* Copy the rectangle of count_i x count_j texels at (i, j) to out, `pitch` floats a row; indices may
   lie outside the table, on either side and by any amount: they wrap on a periodic axis and are
   extrapolated to second order on a clamped one (T[-1] = 3 T[0] - 3 T[1] + T[2], the quadratic
   through the three edge texels; repeated where the axis has fewer than 3). */
void wr_field_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                   size_t pitch);
/* A hint: these texels of a row will be read soon. Indices outside the table are fine. */
void wr_field_expect(const WrField *field, int i, int j, int count_i);
/* Write a rectangle that lies inside the table. Non-finite heights become 0; returns how many. */
int64_t wr_field_write(WrField *field, int i, int j, int count_i, int count_j, const float *in,
                       size_t pitch);

/* Have both the same size and wrap? */
bool wr_field_alike(const WrField *a, const WrField *b);
/* Call changed(tx, ty, ctx) for each tile whose texels may differ between a and b: those whose
   pointers differ. The sizes must be equal. Costs what differs, not what the tables hold. */
typedef void (*WrTileVisitor)(int tx, int ty, void *ctx);
void wr_field_changes(const WrField *a, const WrField *b, WrTileVisitor changed, void *ctx);
/* The texels of tile (tx, ty) whose bits differ between a and b, of equal size, lie in columns i0 <= i < i1 and rows
   j0 <= j < j1 of the table; all 0: there are none. */
typedef struct WrFieldRect {
    int i0, i1, j0, j1;
} WrFieldRect;
WrFieldRect wr_field_difference(const WrField *a, const WrField *b, int tx, int ty);

/* Size, wrap and every texel's bits; equal for equal contents however they came about. */
WrHash wr_field_hash(const WrField *field);
/* Smallest and largest height. */
void wr_field_range(const WrField *field, float *low, float *high);
/* Bytes of tiles that this table refers to (shared ones included). */
size_t wr_field_bytes(const WrField *field);

/* The one place where a parameter is brought to the table's period:
 *   U = r u;  U -= floor(U);  if !(U < 1) U = 0        (NUMERICS: HC35-HC41)
 * Any finite or non-finite input gives 0 <= U < 1; NaN and infinity give 0. In double, so that r = 1e6
 * is still right to 1e-3 texel of 64 (HC40). */
static inline double wr_field_reduce(double u, double replicate)
{
    double x = replicate * u;
    x -= __builtin_floor(x);
    return x < 1.0 && x >= 0.0 ? x : 0.0;
}
