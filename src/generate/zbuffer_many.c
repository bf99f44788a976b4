/* Many solids in a tile of the depth buffer. The tile is quartered down to its squares, and in each
   part the solids hidden by another over the whole part are removed; the rest of a square is drawn, the
   highest first. */
#include "generate/zbuffer_tile.h"

#include "base/memory.h"

#include <string.h>

#define DEPTH 8    /* greater than the number of subdivisions of a tile, plus one */
#define LEVELS 64  /* height classes for sorting a square's items */
#define OFTEN 4    /* draws after which the settled heights are recomputed */
#define LOOKS 2048 /* bounds computed between cancellation checks */

/* Copies are evaluated with the data of the first of their kind, so that the others are not fetched
   from memory repeatedly. */
typedef struct Item {
    double bound, least;  /* upper and lower bound in the part: see wr_zsolid_range */
    double dx, dy;        /* texels: exact offset from the kind's position */
    const WrZSolid *kind; /* the same solid at another position */
    int32_t entry;        /* below WR_Z_ENTRIES */
} Item;

typedef struct Many {
    WrZSheet *sheet;
    const WrZScene *scene;
    const WrZEntry *entries;
    const WrZGoOn *go_on;
    int squares; /* finished ones */
    int looks;
    bool stopped;
    Item *items[DEPTH]; /* of the present part, of its parent, and so on */
    int32_t *order;     /* of a square's items */
    int64_t room[DEPTH], order_room;
} Many;

static Item *items_at(Many *m, int depth, int64_t count)
{
    if (m->room[depth] < count) {
        wr_free(m->items[depth]);
        m->items[depth] = wr_alloc((size_t)count, sizeof *m->items[depth]);
        m->room[depth] = count;
    }
    return m->items[depth];
}

static int32_t *order_of(Many *m, int64_t count)
{
    if (m->order_room < count) {
        wr_free(m->order);
        m->order = wr_alloc((size_t)count, sizeof *m->order);
        m->order_room = count;
    }
    return m->order;
}

static bool keeps_on(Many *m)
{
    if (++m->looks % LOOKS == 0 &&
        !m->go_on->call(m->go_on->ctx, (double)m->squares / (WR_Z_SQUARES * WR_Z_SQUARES)))
        m->stopped = true;
    return !m->stopped;
}

/* Items of the part (x, y), `side` texels wide: those of `from` that are visible there. Returns their
 * number. */
static int64_t sift(Many *m, int x, int y, int side, const Item *from, int64_t count, Item *to)
{
    const WrZSheet *sheet = m->sheet;
    int wide = sheet->wide - x < side ? sheet->wide - x : side;
    int high = sheet->high - y < side ? sheet->high - y : side;
    double least = -INFINITY; /* one of them is at least this high everywhere */
    int64_t kept = 0, seen = 0, owner = -1;
    for (int64_t i = 0; i < count && keeps_on(m); i++) {
        double left = sheet->x + x - from[i].dx - 0.5, top = sheet->y + y - from[i].dy - 0.5, floor;
        const WrZRect rect = { left, top, left + wide, top + high };
        if (from[i].bound < least) continue;
        double bound = wr_zsolid_range(from[i].kind, &rect, &floor);
        if (bound < sheet->floor) continue;
        if (floor > least && floor >= sheet->floor) {
            least = floor;
            owner = from[i].entry;
        }
        to[kept] = from[i];
        to[kept].bound = bound;
        to[kept++].least = floor;
    }
    for (int64_t i = 0; i < kept; i++)
        if (to[i].bound > least || to[i].entry == owner) to[seen++] = to[i];
    return seen;
}

static int level_of(double bound, const double range[2])
{
    double part = (range[1] - bound) / (range[1] - range[0]);
    int level = part > 0.0 ? (int)(part * LEVELS) : 0;
    return level < LEVELS ? level : LEVELS - 1;
}

/* Sorts roughly by their bounds, the highest first. */
static void sort(const Item *items, int64_t count, int32_t *order)
{
    double range[2] = { INFINITY, -INFINITY };
    int64_t starts[LEVELS + 1] = { 0 };
    for (int64_t i = 0; i < count; i++) {
        double z = items[i].bound;
        range[0] = z < range[0] ? z : range[0];
        range[1] = z > range[1] ? z : range[1];
    }
    for (int64_t i = 0; i < count; i++) starts[level_of(items[i].bound, range) + 1]++;
    for (int k = 0; k < LEVELS; k++) starts[k + 1] += starts[k];
    for (int64_t i = 0; i < count; i++)
        order[starts[level_of(items[i].bound, range)]++] = (int32_t)i;
}

/* State of a square while it is drawn. */
typedef struct Square {
    int x, y; /* its first texel in the tile */
    int drawn;
    double least, settled[WR_Z_SQUARE * WR_Z_SQUARE]; /* see wr_zsheet_settled */
    uint64_t changed;                                 /* texels not yet updated in the band */
    WrZBand band;
} Square;

static void draw_item(Many *m, Square *q, const Item *item)
{
    wr_zsheet_solid_at(m->sheet, item->kind, item->dx, item->dy, q->x, q->y);
    if (++q->drawn % OFTEN == 0) {
        q->least = wr_zsheet_settled(m->sheet, q->x, q->y, q->settled);
        q->changed = ~(uint64_t)0;
    }
}

static void settle(Many *m, Square *q, uint64_t texels)
{
    q->changed |= texels;
    for (; texels; texels &= texels - 1) {
        int k = __builtin_ctzll(texels), x = q->x + k % WR_Z_SQUARE, y = q->y + k / WR_Z_SQUARE;
        q->settled[k] = wr_zsheet_settled_texel(m->sheet, y * WR_TILE + x);
    }
    q->least = INFINITY;
    for (int k = 0; k < WR_Z_SQUARE * WR_Z_SQUARE; k++)
        q->least = q->settled[k] < q->least ? q->settled[k] : q->least;
}

/* For a ring, draws only the texels that it changes. */
static void draw_ring(Many *m, Square *q, const Item *item)
{
    const WrZSolid *ring = item->kind;
    double x = m->sheet->x + q->x - item->dx - ring->at[0];
    double y = m->sheet->y + q->y - item->dy - ring->at[1];
    wr_zband_set(&q->band, ring, m->sheet->floor, q->settled, q->changed);
    q->changed = 0;
    uint64_t met = wr_zband_meets(&q->band, x, y);
    if (!met) return;
    if (!wr_zband_is_within(&q->band, x, y, met)) {
        draw_item(m, q, item);
        return;
    }
    wr_zsheet_ring_at(m->sheet, ring, item->dx, item->dy, q->x, q->y, met);
    settle(m, q, met);
}

static void draw_square(Many *m, int x, int y, const Item *items, int64_t count)
{
    int32_t *order = order_of(m, count);
    Square q = { .x = x, .y = y };
    q.least = wr_zsheet_settled(m->sheet, x, y, q.settled);
    sort(items, count, order);
    for (int64_t i = 0; i < count && keeps_on(m); i++) {
        const Item *item = &items[order[i]];
        if (item->bound <= q.least) continue;
        if (wr_zsolid_is_ring(item->kind)) draw_ring(m, &q, item);
        else draw_item(m, &q, item);
    }
    m->squares++;
}

static void draw_part(Many *m, int depth, int x, int y, int side, int64_t count)
{
    if (x >= m->sheet->wide || y >= m->sheet->high || m->stopped) return;
    Item *items = items_at(m, depth + 1, count);
    int64_t seen = sift(m, x, y, side, m->items[depth], count, items);
    int half = side / 2;
    if (seen > 0 && side == WR_Z_SQUARE) draw_square(m, x, y, items, seen);
    else if (seen > 0)
        for (int k = 0; k < 4; k++)
            draw_part(m, depth + 1, x + k % 2 * half, y + k / 2 * half, half, seen);
}

static bool is_kind(const WrZSolid *a, const WrZSolid *b)
{
    return a->shape == b->shape && a->param == b->param && a->letters == b->letters &&
           a->at[2] == b->at[2] && memcmp(a->pose, b->pose, sizeof a->pose) == 0 &&
           memcmp(a->inverse, b->inverse, sizeof a->inverse) == 0;
}

/* At most two kinds alternate: see wr_solid_places. */
static void list_all(const Many *m, int64_t count, Item *all)
{
    const WrZSolid *kinds[2] = { NULL, NULL };
    for (int64_t i = 0; i < count; i++) {
        const WrZEntry *e = &m->entries[i];
        const WrZSolid *solid = &m->scene->solids[e->index];
        bool first = kinds[0] && is_kind(solid, kinds[0]);
        if (!first && !(kinds[1] && is_kind(solid, kinds[1]))) {
            kinds[1] = kinds[0];
            kinds[0] = solid;
            first = true;
        }
        const WrZSolid *kind = kinds[first ? 0 : 1];
        all[i] = (Item){ INFINITY,
                         -INFINITY,
                         e->dx + (solid->at[0] - kind->at[0]),
                         e->dy + (solid->at[1] - kind->at[1]),
                         kind,
                         (int32_t)i };
    }
}

bool wr_zsheet_many(WrZSheet *sheet, const WrZScene *scene, const WrZEntry *entries, int64_t count,
                    const WrZGoOn *go_on)
{
    Many m = { .sheet = sheet, .scene = scene, .entries = entries, .go_on = go_on };
    _Static_assert(WR_Z_SQUARE << (DEPTH - 2) >= WR_TILE, "each part has its place in items");
    list_all(&m, count, items_at(&m, 0, count));
    draw_part(&m, 0, 0, 0, WR_TILE, count);
    for (int k = 0; k < DEPTH; k++) wr_free(m.items[k]);
    wr_free(m.order);
    return !m.stopped;
}
