/* The map of tiles is a tree whose nodes have 8 x 8 children; a table of up to 8 x 8 tiles has one
   level of nodes, the largest has three. Nodes and tiles are reference-counted and copied on write, so
   a share is one more reference to the root. NULL, at any level, represents texels that all have the
   table's level. The level of a tree never changes, since a fill drops the tree. */
#include "field/field.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/slab.h"
#include "field/ops.h"

#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)
#define FAN_BITS 3 /* 8 children along each side of a node */
#define FAN (1 << FAN_BITS)

typedef struct Counted {
    _Atomic int refs;
} Counted;

typedef struct Tile {
    Counted counted;
    alignas(WR_ALIGN) float texels[TEXELS];
} Tile;

static WrSlabs tile_slabs = { WR_SLABS_OF(sizeof(Tile)) };

typedef struct Node {
    Counted counted;
    Counted *child[FAN * FAN]; /* nodes, or tiles in the last level; row by row from the top */
} Node;

struct WrField {
    int width, height;
    WrWrap wrap_u, wrap_v;
    float level;
    int depth;     /* levels of nodes above the tiles, 1..3 */
    Counted *root; /* NULL: every texel is `level` */
    /* Changes with each write; shares keep it, so that equal keys mean equal texels. */
    uint64_t key;
};

/* Process-wide, so that equal keys always mean equal texels. */
static uint64_t next_key(void)
{
    static _Atomic uint64_t last;
    return atomic_fetch_add_explicit(&last, 1, memory_order_relaxed) + 1;
}

static float sane(float height)
{
    return isfinite(height) ? height : 0.0f;
}

static bool same_float(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void retain(Counted *thing)
{
    if (thing) atomic_fetch_add_explicit(&thing->refs, 1, memory_order_relaxed);
}

/* depth: levels of nodes from this one down; 0 for a tile. */
static void release(Counted *thing, int depth)
{
    if (!thing || atomic_fetch_sub_explicit(&thing->refs, 1, memory_order_acq_rel) != 1) return;
    if (depth == 0) {
        wr_slab_free(&tile_slabs, thing);
        return;
    }
    Node *node = (Node *)thing;
    for (int i = 0; i < FAN * FAN; i++) release(node->child[i], depth - 1);
    wr_free(thing);
}

/* Acquire: reads by a former sharer happen before our writes. A count of 1 cannot rise meanwhile: only holders of a reference
   can share, and this table's writer is the only holder. */
static bool is_ours(Counted *thing)
{
    return thing && atomic_load_explicit(&thing->refs, memory_order_acquire) == 1;
}

/* Makes *slot a node with no other reference. */
static Node *own_node(Counted **slot, int depth)
{
    if (is_ours(*slot)) return (Node *)*slot;
    Node *node = wr_alloc(1, sizeof *node);
    atomic_init(&node->counted.refs, 1);
    if (*slot) {
        memcpy(node->child, ((Node *)*slot)->child, sizeof node->child);
        for (int i = 0; i < FAN * FAN; i++) retain(node->child[i]);
        release(*slot, depth);
    }
    *slot = &node->counted;
    return node;
}

static Tile *new_tile(void)
{
    Tile *tile = wr_slab_alloc(&tile_slabs);
    atomic_init(&tile->counted.refs, 1);
    return tile;
}

static Counted *counted_of(const float *texels)
{
    return (Counted *)((char *)(uintptr_t)texels - offsetof(Tile, texels));
}

void wr_field_trim(void)
{
    wr_slab_trim(&tile_slabs);
    wr_memory_trim();
}

static Tile *own_tile(Counted **slot, float level)
{
    if (is_ours(*slot)) return (Tile *)*slot;
    Tile *tile = new_tile();
    if (*slot) {
        memcpy(tile->texels, ((Tile *)*slot)->texels, sizeof tile->texels);
        release(*slot, 0);
    } else {
        for (int i = 0; i < TEXELS; i++) tile->texels[i] = level;
    }
    *slot = &tile->counted;
    return tile;
}

/* Index of tile (tx, ty) in a node that has `below` levels of nodes under it. 3 bits of tx and ty select the child on each
   level, the highest bits at the root. */
static int child_of(int tx, int ty, int below)
{
    int shift = FAN_BITS * below, mask = FAN - 1;
    return ((ty >> shift) & mask) << FAN_BITS | ((tx >> shift) & mask);
}

WrField *wr_field_new(int width, int height, WrWrap wrap_u, WrWrap wrap_v, float level,
                      WrError *err)
{
    if (width < 1 || width > WR_FIELD_MAX || height < 1 || height > WR_FIELD_MAX) {
        wr_fail(err, "table %dx%d: each side must be 1..%d texels", width, height, WR_FIELD_MAX);
        return NULL;
    }
    WrField *field = wr_alloc(1, sizeof *field);
    int tiles = ((width > height ? width : height) + WR_TILE - 1) / WR_TILE;
    field->width = width;
    field->height = height;
    field->wrap_u = wrap_u;
    field->wrap_v = wrap_v;
    field->level = sane(level);
    field->depth = tiles <= FAN ? 1 : tiles <= FAN * FAN ? 2 : 3;
    field->key = next_key();
    return field;
}

WrField *wr_field_share(const WrField *field)
{
    WrField *share = wr_alloc(1, sizeof *share);
    *share = *field;
    retain(share->root);
    return share;
}

void wr_field_free(WrField *field)
{
    if (!field) return;
    release(field->root, field->depth);
    wr_free(field);
}

int wr_field_width(const WrField *field)
{
    return field->width;
}

int wr_field_height(const WrField *field)
{
    return field->height;
}

WrWrap wr_field_wrap_u(const WrField *field)
{
    return field->wrap_u;
}

WrWrap wr_field_wrap_v(const WrField *field)
{
    return field->wrap_v;
}

uint64_t wr_field_key(const WrField *field)
{
    return field->key;
}

float wr_field_level(const WrField *field)
{
    return field->level;
}

int wr_field_tiles_u(const WrField *field)
{
    return (field->width + WR_TILE - 1) / WR_TILE;
}

int wr_field_tiles_v(const WrField *field)
{
    return (field->height + WR_TILE - 1) / WR_TILE;
}

const float *wr_field_tile(const WrField *field, int tx, int ty)
{
    WR_ASSERT(tx >= 0 && tx < wr_field_tiles_u(field) && ty >= 0 && ty < wr_field_tiles_v(field));
    const Counted *thing = field->root;
    for (int below = field->depth - 1; thing && below >= 0; below--)
        thing = ((const Node *)thing)->child[child_of(tx, ty, below)];
    return thing ? ((const Tile *)thing)->texels : NULL;
}

/* Slot of the tile, in nodes owned by this table alone; for a write. */
static Counted **own_slot(WrField *field, int tx, int ty)
{
    WR_ASSERT(tx >= 0 && tx < wr_field_tiles_u(field) && ty >= 0 && ty < wr_field_tiles_v(field));
    Counted **slot = &field->root;
    for (int below = field->depth - 1; below >= 0; below--)
        slot = &own_node(slot, below + 1)->child[child_of(tx, ty, below)];
    field->key = next_key();
    return slot;
}

float *wr_field_tile_write(WrField *field, int tx, int ty)
{
    return own_tile(own_slot(field, tx, ty), field->level)->texels;
}

WrFieldPlace *wr_field_tile_place(WrField *field, int tx, int ty)
{
    return (WrFieldPlace *)own_slot(field, tx, ty);
}

float *wr_field_place_write(const WrField *field, WrFieldPlace *place)
{
    return own_tile((Counted **)place, field->level)->texels;
}

/* Like wr_field_tile_write, but the caller overwrites every texel: a shared tile is not copied first. */
float *wr_field_tile_fresh(WrField *field, int tx, int ty)
{
    Counted **slot = own_slot(field, tx, ty);
    if (!is_ours(*slot)) {
        release(*slot, 0);
        *slot = &new_tile()->counted;
    }
    return ((Tile *)*slot)->texels;
}

float *wr_field_tile_make(void)
{
    return new_tile()->texels;
}

void wr_field_tile_free(float *texels)
{
    if (texels) release(counted_of(texels), 0);
}

void wr_field_tile_put(WrField *field, int tx, int ty, float *texels)
{
    Counted **slot = own_slot(field, tx, ty);
    release(*slot, 0);
    *slot = counted_of(texels);
}

void wr_field_tile_drop(WrField *field, int tx, int ty)
{
    Counted **slot = own_slot(field, tx, ty);
    release(*slot, 0);
    *slot = NULL;
}

float wr_field_get(const WrField *field, int i, int j)
{
    WR_ASSERT(i >= 0 && i < field->width && j >= 0 && j < field->height);
    const float *tile = wr_field_tile(field, i / WR_TILE, j / WR_TILE);
    return tile ? tile[j % WR_TILE * WR_TILE + i % WR_TILE] : field->level;
}

void wr_field_set(WrField *field, int i, int j, float height)
{
    WR_ASSERT(i >= 0 && i < field->width && j >= 0 && j < field->height);
    float *tile = wr_field_tile_write(field, i / WR_TILE, j / WR_TILE);
    tile[j % WR_TILE * WR_TILE + i % WR_TILE] = sane(height);
}

void wr_field_fill(WrField *field, float height)
{
    release(field->root, field->depth);
    field->root = NULL;
    field->level = sane(height);
    field->key = next_key();
}

/* Visits the tiles of a subtree whose pointers differ between a and b, or all of them if the levels
   differ, so that even two NULLs are different heights. tx, ty: the subtree's first tile. */
typedef struct Comparison {
    int tiles_u, tiles_v;
    bool same_level;
    WrTileVisitor changed;
    void *ctx;
} Comparison;

static void compare(const Comparison *c, const Counted *a, const Counted *b, int depth, int tx,
                    int ty)
{
    if (tx >= c->tiles_u || ty >= c->tiles_v) return;
    if (a == b && (a || c->same_level)) return;
    if (depth == 0) {
        c->changed(tx, ty, c->ctx);
        return;
    }
    int side = 1 << FAN_BITS * (depth - 1); /* tiles along a child's side */
    for (int i = 0; i < FAN * FAN; i++)
        compare(c, a ? ((const Node *)a)->child[i] : NULL, b ? ((const Node *)b)->child[i] : NULL,
                depth - 1, tx + i % FAN * side, ty + i / FAN * side);
}

bool wr_field_alike(const WrField *a, const WrField *b)
{
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b) &&
           wr_field_wrap_u(a) == wr_field_wrap_u(b) && wr_field_wrap_v(a) == wr_field_wrap_v(b);
}

void wr_field_changes(const WrField *a, const WrField *b, WrTileVisitor changed, void *ctx)
{
    WR_ASSERT(a->width == b->width && a->height == b->height);
    Comparison c = { .tiles_u = wr_field_tiles_u(a),
                     .tiles_v = wr_field_tiles_v(a),
                     .same_level = same_float(a->level, b->level),
                     .changed = changed,
                     .ctx = ctx };
    compare(&c, a->root, b->root, a->depth, 0, 0);
}

static void count_tile(int tx, int ty, void *ctx)
{
    (void)tx, (void)ty;
    ++*(int *)ctx;
}

int wr_field_changed_tiles(const WrField *a, const WrField *b)
{
    int tiles = 0;
    wr_field_changes(a, b, count_tile, &tiles);
    return tiles;
}

/* Number of used texels of tile index t along an axis of n texels. */
static int used(int t, int n)
{
    int rest = n - t * WR_TILE;
    return rest < WR_TILE ? rest : WR_TILE;
}

static void copy_tile(WrField *to, const WrField *from, int tx, int ty)
{
    const float *tile = wr_field_tile(from, tx, ty);
    float *out = wr_field_tile_write(to, tx, ty);
    int count_i = used(tx, to->width), count_j = used(ty, to->height);
    for (int j = 0; j < count_j; j++)
        for (int i = 0; i < count_i; i++)
            out[j * WR_TILE + i] = tile ? tile[j * WR_TILE + i] : from->level;
}

void wr_field_tile_share(WrField *to, const WrField *from, int tx, int ty)
{
    WR_ASSERT(to->width == from->width && to->height == from->height);
    const float *tile = wr_field_tile(from, tx, ty);
    bool whole = used(tx, to->width) == WR_TILE && used(ty, to->height) == WR_TILE;
    if (!same_float(to->level, from->level) && (!tile || !whole)) {
        copy_tile(to, from, tx, ty);
        return;
    }
    Counted **slot = own_slot(to, tx, ty), *shared = NULL;
    if (tile) shared = counted_of(tile);
    retain(shared);
    release(*slot, 0);
    *slot = shared;
}

void wr_field_share_equal(WrField *field, const WrField *before, const uint8_t *made)
{
    if (!field || !before || !wr_field_alike(field, before)) return;
    const float was = wr_field_level(before), now = wr_field_level(field);
    if (memcmp(&was, &now, sizeof was) != 0) return;
    for (int ty = 0, k = 0; ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++, k++) {
            const float *a = wr_field_tile(field, tx, ty), *b = wr_field_tile(before, tx, ty);
            const bool equal = a && b && memcmp(a, b, WR_TILE * WR_TILE * sizeof *a) == 0;
            if (equal || (made && !made[k])) wr_field_tile_share(field, before, tx, ty);
        }
}

/* The hash covers only the used texels: their common height, or their bytes. A flat tile and an absent one of the same level
   have equal hashes, so that the hash depends on heights, not on the history of edits. Texels beyond the table's edge in the
   last tiles are undefined and stay out. */
static WrHash hash_tile(const float *texels, int count_i, int count_j)
{
    bool flat = true;
    for (int j = 0; flat && j < count_j; j++)
        for (int i = 0; i < count_i; i++) flat &= same_float(texels[j * WR_TILE + i], texels[0]);
    if (flat) return wr_hash_bytes(texels, sizeof *texels, (WrHash){ 1, 0 });
    if (count_i == WR_TILE)
        return wr_hash_bytes(texels, sizeof *texels * WR_TILE * (size_t)count_j, (WrHash){ 2, 0 });
    float packed[TEXELS];
    for (int j = 0; j < count_j; j++)
        memcpy(packed + j * count_i, texels + j * WR_TILE, sizeof *packed * (size_t)count_i);
    return wr_hash_bytes(packed, sizeof *packed * (size_t)(count_i * count_j), (WrHash){ 2, 0 });
}

/* Two-level: a hash for each tile, and a chain over rows of tiles from the top. Journals and tests compare the result between
   runs and machines: neither order nor seeds may change. */
WrHash wr_field_hash(const WrField *field)
{
    int32_t head[4] = { field->width, field->height, (int32_t)field->wrap_u,
                        (int32_t)field->wrap_v };
    WrHash hash = wr_hash_bytes(head, sizeof head, (WrHash){ 0, 0 });
    WrHash level = wr_hash_bytes(&field->level, sizeof field->level, (WrHash){ 1, 0 });
    WrHash row[WR_FIELD_MAX / WR_TILE];
    int tiles_u = wr_field_tiles_u(field), tiles_v = wr_field_tiles_v(field);
    for (int ty = 0; ty < tiles_v && !wr_progress_stopped(); ty++) {
        for (int tx = 0; tx < tiles_u; tx++) {
            const float *tile = wr_field_tile(field, tx, ty);
            row[tx] =
                tile ? hash_tile(tile, used(tx, field->width), used(ty, field->height)) : level;
        }
        hash = wr_hash_bytes(row, sizeof *row * (size_t)tiles_u, hash);
    }
    return hash;
}

/* Results of a walk over the existing tiles. */
typedef struct Survey {
    const WrField *field;
    int64_t tiles;
    float low, high;
    bool heights; /* read the texels, not only the tree */
    bool stopped; /* cancelled: nothing more is read */
} Survey;

static void survey_tile(Survey *s, const float *texels, int tx, int ty)
{
    s->tiles++;
    s->stopped = s->heights && wr_progress_stopped();
    if (!s->heights || s->stopped) return;
    int count_i = used(tx, s->field->width), count_j = used(ty, s->field->height);
    float low = s->low, high = s->high;
    for (int j = 0; j < count_j; j++)
        for (int i = 0; i < count_i; i++) {
            float f = texels[j * WR_TILE + i];
            low = f < low ? f : low;
            high = f > high ? f : high;
        }
    s->low = low;
    s->high = high;
}

static void survey(Survey *s, const Counted *thing, int depth, int tx, int ty)
{
    if (!thing || s->stopped) return;
    if (depth == 0) {
        survey_tile(s, ((const Tile *)thing)->texels, tx, ty);
        return;
    }
    int side = 1 << FAN_BITS * (depth - 1);
    for (int i = 0; i < FAN * FAN; i++)
        survey(s, ((const Node *)thing)->child[i], depth - 1, tx + i % FAN * side,
               ty + i / FAN * side);
}

void wr_field_range(const WrField *field, float *low, float *high)
{
    Survey s = { .field = field, .low = FLT_MAX, .high = -FLT_MAX, .heights = true };
    survey(&s, field->root, field->depth, 0, 0);
    /* The walk visits existing tiles only; if one is absent, the level is a height of the table, too. */
    if (s.tiles < (int64_t)wr_field_tiles_u(field) * wr_field_tiles_v(field)) {
        s.low = field->level < s.low ? field->level : s.low;
        s.high = field->level > s.high ? field->level : s.high;
    }
    *low = s.low;
    *high = s.high;
}

size_t wr_field_bytes(const WrField *field)
{
    Survey s = { .field = field };
    survey(&s, field->root, field->depth, 0, 0);
    return (size_t)s.tiles * sizeof(Tile);
}

/* ---- rectangles ---- */

/* Copying rectangles between a table and plain memory. The part inside the table is copied tile by
   tile; a rectangle that extends beyond it is first cut into parts that do not. */

static int64_t min64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int wrap_index(int64_t i, int n)
{
    int64_t rest = i % n;
    return (int)(rest < 0 ? rest + n : rest);
}

/* Copies by pieces of constant sizes: for one row of a tile the compiler would use a string instruction
 * whose start-up needs longer than the copy. */
static inline void copy_texels(const float *restrict in, int count, float *restrict out)
{
    int k = 0;
    for (; k + 16 <= count; k += 16) memcpy(out + k, in + k, 16 * sizeof *out);
    if (count & 8) memcpy(out + k, in + k, 8 * sizeof *out), k += 8;
    if (count & 4) memcpy(out + k, in + k, 4 * sizeof *out), k += 4;
    if (count & 2) memcpy(out + k, in + k, 2 * sizeof *out), k += 2;
    if (count & 1) out[k] = in[k];
}

static void copy_block(const float *tile, float level, int x, int y, int count_i, int count_j,
                       float *out, size_t pitch)
{
    for (int row = 0; row < count_j; row++, out += pitch) {
        if (tile) copy_texels(tile + (y + row) * WR_TILE + x, count_i, out);
        else
            for (int col = 0; col < count_i; col++) out[col] = level;
    }
}

/* A rectangle that lies inside the table. */
static void read_inside(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                        size_t pitch)
{
    float level = wr_field_level(field);
    for (int row = 0; row < count_j;) {
        int y = (j + row) % WR_TILE, rows = (int)min64(WR_TILE - y, count_j - row);
        for (int col = 0; col < count_i;) {
            int x = (i + col) % WR_TILE, cols = (int)min64(WR_TILE - x, count_i - col);
            const float *tile = wr_field_tile(field, (i + col) / WR_TILE, (j + row) / WR_TILE);
            copy_block(tile, level, x, y, cols, rows, out + (size_t)row * pitch + col, pitch);
            col += cols;
        }
        row += rows;
    }
}

void wr_field_expect(const WrField *field, int i, int j, int count_i)
{
    enum { LINE = WR_ALIGN / (int)sizeof(float) };
    const int width = wr_field_width(field), end = count_i < width - i ? i + count_i : width;
    if (i < 0 || j < 0 || j >= wr_field_height(field)) return;
    for (int after; i < end; i = after) {
        const float *tile = wr_field_tile(field, i / WR_TILE, j / WR_TILE);
        after = (i / WR_TILE + 1) * WR_TILE;
        for (int k = i / LINE * LINE; tile && k < after && k < end; k += LINE)
            __builtin_prefetch(tile + j % WR_TILE * WR_TILE + k % WR_TILE);
    }
}

/* The quadratic through t0, t1, t2 at 0, 1, 2, extrapolated to `x` < 0, in Newton's form of
 * differences, so that equal heights stay exactly equal; at -1 it is 3 t0 - 3 t1 + t2. */
static float beyond(float t0, float t1, float t2, double x)
{
    double first = (double)t1 - t0, second = ((double)t2 - t1) - first;
    double value = t0 + x * first + 0.5 * x * (x - 1.0) * second;
    if (value > FLT_MAX) return FLT_MAX;
    return value < -FLT_MAX ? -FLT_MAX : (float)value;
}

/* Position of index i outside a clamped axis of n texels, as a coordinate that runs inwards from the
   * nearer end: -1 is the first missing texel. *end is that end's index, *step points inwards. step 0: tables narrower than 3
   have no quadratic, so all three taps are the edge texel and the extension is constant. */
static double outside(int64_t i, int n, int *end, int *step)
{
    *end = i < 0 ? 0 : n - 1;
    *step = n < 3 ? 0 : i < 0 ? 1 : -1;
    return (double)(i < 0 ? i : n - 1 - i);
}

/* Rows j .. j + count_j - 1, all inside the table; columns anywhere on a clamped axis. */
static void read_rows_clamped(const WrField *field, int64_t i, int j, int64_t count_i, int count_j,
                              float *out, size_t pitch)
{
    int width = wr_field_width(field);
    int64_t first = i < 0 ? min64(-i, count_i) : 0; /* columns left of the table */
    int64_t inside = min64(width - (i + first), count_i - first);
    if (inside > 0)
        read_inside(field, (int)(i + first), j, (int)inside, count_j, out + first, pitch);
    for (int row = 0; row < count_j; row++, out += pitch)
        for (int64_t col = 0; col < count_i; col++) {
            if (col == first && inside > 0) {
                col += inside - 1;
                continue;
            }
            int end, step;
            double x = outside(i + col, width, &end, &step);
            out[col] =
                beyond(wr_field_get(field, end, j + row), wr_field_get(field, end + step, j + row),
                       wr_field_get(field, end + 2 * step, j + row), x);
        }
}

static void read_rows(const WrField *field, int64_t i, int j, int64_t count_i, int count_j,
                      float *out, size_t pitch)
{
    if (wr_field_wrap_u(field) == WR_WRAP_CLAMP) {
        read_rows_clamped(field, i, j, count_i, count_j, out, pitch);
        return;
    }
    int width = wr_field_width(field);
    for (int64_t col = 0; col < count_i;) {
        int from = wrap_index(i + col, width);
        int cols = (int)min64(width - from, count_i - col);
        read_inside(field, from, j, cols, count_j, out + col, pitch);
        col += cols;
    }
}

/* One row above or below a clamped table, from the three rows at that end. */
static void read_row_outside(const WrField *field, int64_t i, int64_t j, int64_t count_i,
                             float *out)
{
    enum { PART = 256 };
    float rows[3][PART];
    int end, step;
    double y = outside(j, wr_field_height(field), &end, &step);
    for (int64_t col = 0; col < count_i; col += PART) {
        int64_t cols = min64(PART, count_i - col);
        for (int k = 0; k < 3; k++) read_rows(field, i + col, end + k * step, cols, 1, rows[k], 0);
        for (int64_t c = 0; c < cols; c++)
            out[col + c] = beyond(rows[0][c], rows[1][c], rows[2][c], y);
    }
}

void wr_field_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                   size_t pitch)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    if (count_i <= 0 || count_j <= 0) return;
    if (i >= 0 && j >= 0 && count_i <= width - i && count_j <= height - j) {
        read_inside(field, i, j, count_i, count_j, out, pitch);
        return;
    }
    bool clamped = wr_field_wrap_v(field) == WR_WRAP_CLAMP;
    for (int64_t row = 0; row < count_j;) {
        int64_t at = j + row, rows = 1;
        float *to = out + (size_t)row * pitch;
        if (clamped && (at < 0 || at >= height)) {
            read_row_outside(field, i, at, count_i, to);
        } else {
            int from = wrap_index(at, height);
            rows = min64(height - from, count_j - row);
            read_rows(field, i, from, count_i, (int)rows, to, pitch);
        }
        row += rows;
    }
}

static bool all_equal(const float *in, size_t pitch, int count_i, int count_j, float level)
{
    for (int row = 0; row < count_j; row++, in += pitch)
        for (int col = 0; col < count_i; col++)
            if (memcmp(&in[col], &level, sizeof level) != 0) return false;
    return true;
}

static int64_t write_block(float *tile, int x, int y, int count_i, int count_j, const float *in,
                           size_t pitch)
{
    int64_t mended = 0;
    for (int row = 0; row < count_j; row++, in += pitch) {
        float *to = tile + (y + row) * WR_TILE + x;
        for (int col = 0; col < count_i; col++) {
            bool finite = fabsf(in[col]) <= FLT_MAX;
            to[col] = finite ? in[col] : 0.0f;
            mended += !finite;
        }
    }
    return mended;
}

int64_t wr_field_write(WrField *field, int i, int j, int count_i, int count_j, const float *in,
                       size_t pitch)
{
    WR_ASSERT(i >= 0 && j >= 0 && count_i <= wr_field_width(field) - i &&
              count_j <= wr_field_height(field) - j);
    float level = wr_field_level(field);
    int64_t mended = 0;
    for (int row = 0; row < count_j;) {
        int y = (j + row) % WR_TILE, rows = (int)min64(WR_TILE - y, count_j - row);
        for (int col = 0; col < count_i;) {
            int x = (i + col) % WR_TILE, cols = (int)min64(WR_TILE - x, count_i - col);
            int tx = (i + col) / WR_TILE, ty = (j + row) / WR_TILE;
            const float *from = in + (size_t)row * pitch + col;
            /* unchanged heights allocate no tile */
            if (wr_field_tile(field, tx, ty) || !all_equal(from, pitch, cols, rows, level))
                mended +=
                    write_block(wr_field_tile_write(field, tx, ty), x, y, cols, rows, from, pitch);
            col += cols;
        }
        row += rows;
    }
    return mended;
}

/* ---- differences --------------------------------------------------------------------------------- */

/* Columns that differ between two rows of a tile, from *first to before *end; false: none. */
static bool rows_differ(const float *a, const float *b, int count, int *first, int *end)
{
    if (memcmp(a, b, (size_t)count * sizeof *a) == 0) return false;
    *first = 0, *end = count;
    while (memcmp(&a[*first], &b[*first], sizeof *a) == 0) ++*first;
    while (memcmp(&a[*end - 1], &b[*end - 1], sizeof *a) == 0) --*end;
    return true;
}

WrFieldRect wr_field_difference(const WrField *a, const WrField *b, int tx, int ty)
{
    const float *of_a = wr_field_tile(a, tx, ty), *of_b = wr_field_tile(b, tx, ty);
    const int left = tx * WR_TILE, top = ty * WR_TILE;
    const int w = wr_field_width(a) - left, h = wr_field_height(a) - top;
    float level_a[WR_TILE], level_b[WR_TILE];
    WrFieldRect all = { WR_TILE, 0, WR_TILE, 0 };
    for (int i = 0; i < WR_TILE; i++)
        level_a[i] = wr_field_level(a), level_b[i] = wr_field_level(b);
    for (int y = 0; y < WR_TILE && y < h; y++) {
        const float *row_a = of_a ? of_a + y * WR_TILE : level_a;
        const float *row_b = of_b ? of_b + y * WR_TILE : level_b;
        int first, end;
        if (!rows_differ(row_a, row_b, w < WR_TILE ? w : WR_TILE, &first, &end)) continue;
        all.i0 = first < all.i0 ? first : all.i0;
        all.i1 = end > all.i1 ? end : all.i1;
        all.j0 = y < all.j0 ? y : all.j0;
        all.j1 = y + 1;
    }
    if (all.i1 == 0) return (WrFieldRect){ 0, 0, 0, 0 };
    return (WrFieldRect){ left + all.i0, left + all.i1, top + all.j0, top + all.j1 };
}
