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
        wr_slab_give(&tile_slabs, thing);
        return;
    }
    Node *node = (Node *)thing;
    for (int i = 0; i < FAN * FAN; i++) release(node->child[i], depth - 1);
    wr_free(thing);
}

/* Acquire: reads by a former sharer happen before our writes. */
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
    Tile *tile = wr_slab_take(&tile_slabs);
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

/* Index of tile (tx, ty) in a node that has `below` levels of nodes under it. */
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

/* The hash covers only the used texels: their common height, or their bytes. */
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
