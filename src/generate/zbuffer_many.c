/* Many solids in a tile of the depth buffer. The tile is quartered down to its squares, and in each part those
   are left out that another hides there whole; what is left in a square is drawn, the highest first. */
#include "generate/zbuffer_tile.h"

#include "base/memory.h"

#define LEVELS 64  /* of heights, by which a square's are sorted */
#define OFTEN 4    /* draws after which what is settled is found out anew */
#define LOOKS 2048 /* bounds found between two looks at the cancel */

typedef struct Item {
    double bound, least; /* nowhere in the part is it higher, or lower: see wr_zsolid_range */
    int64_t entry;
} Item;

typedef struct Many {
    WrZSheet *sheet;
    const WrZScene *scene;
    const WrZEntry *entries;
    const WrZGoOn *go_on;
    int squares; /* done with */
    int looks;
    bool stopped;
} Many;

static bool keeps_on(Many *m)
{
    if (++m->looks % LOOKS == 0 &&
        !m->go_on->call(m->go_on->ctx, (double)m->squares / (WR_Z_SQUARES * WR_Z_SQUARES)))
        m->stopped = true;
    return !m->stopped;
}

/* The items of the part (x, y), `side` texels wide: of `from` those that can be seen there. Returns how many. */
static int64_t sift(Many *m, int x, int y, int side, const Item *from, int64_t count, Item *to)
{
    const WrZSheet *sheet = m->sheet;
    int wide = sheet->wide - x < side ? sheet->wide - x : side;
    int high = sheet->high - y < side ? sheet->high - y : side;
    double least = -INFINITY; /* that high one of them is everywhere */
    int64_t kept = 0, seen = 0, owner = -1;
    for (int64_t i = 0; i < count && keeps_on(m); i++) {
        const WrZEntry *e = &m->entries[from[i].entry];
        double left = sheet->x + x - e->dx - 0.5, top = sheet->y + y - e->dy - 0.5, floor;
        const WrZRect rect = { left, top, left + wide, top + high };
        if (from[i].bound < least) continue;
        double bound = wr_zsolid_range(&m->scene->solids[e->index], &rect, &floor);
        if (bound < sheet->floor) continue;
        if (floor > least && floor >= sheet->floor) {
            least = floor;
            owner = from[i].entry;
        }
        to[kept++] = (Item){ bound, floor, from[i].entry };
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

/* In the order of their bounds, roughly, the highest first. */
static void sort(const Item *items, int64_t count, Item *out)
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
    for (int64_t i = 0; i < count; i++) out[starts[level_of(items[i].bound, range)]++] = items[i];
}

static void draw_square(Many *m, int x, int y, const Item *items, int64_t count)
{
    Item *order = wr_alloc((size_t)count + 1, sizeof *order);
    double settled[WR_Z_SQUARE * WR_Z_SQUARE], least = -INFINITY;
    int drawn = 0;
    sort(items, count, order);
    for (int64_t i = 0; i < count && keeps_on(m); i++) {
        const WrZEntry *e = &m->entries[order[i].entry];
        const WrZSolid *solid = &m->scene->solids[e->index];
        double left = m->sheet->x + x - e->dx, top = m->sheet->y + y - e->dy;
        if (order[i].bound <= least) continue;
        if (least > -INFINITY && !wr_zsolid_changes(solid, left, top, order[i].least, settled))
            continue;
        wr_zsheet_solid_at(m->sheet, solid, e->dx, e->dy, x, y);
        if (++drawn % OFTEN == 0) least = wr_zsheet_settled(m->sheet, x, y, settled);
    }
    wr_free(order);
    m->squares++;
}

static void draw_part(Many *m, int x, int y, int side, const Item *from, int64_t count)
{
    if (x >= m->sheet->wide || y >= m->sheet->high || m->stopped) return;
    Item *items = wr_alloc((size_t)count + 1, sizeof *items);
    int64_t seen = sift(m, x, y, side, from, count, items);
    int half = side / 2;
    if (seen > 0 && side == WR_Z_SQUARE) draw_square(m, x, y, items, seen);
    else if (seen > 0)
        for (int k = 0; k < 4; k++)
            draw_part(m, x + k % 2 * half, y + k / 2 * half, half, items, seen);
    wr_free(items);
}

bool wr_zsheet_many(WrZSheet *sheet, const WrZScene *scene, const WrZEntry *entries, int64_t count,
                    const WrZGoOn *go_on)
{
    Many m = { .sheet = sheet, .scene = scene, .entries = entries, .go_on = go_on };
    Item *all = wr_alloc((size_t)count + 1, sizeof *all);
    for (int64_t i = 0; i < count; i++) all[i] = (Item){ INFINITY, -INFINITY, i };
    draw_part(&m, 0, 0, WR_TILE, all, count);
    wr_free(all);
    return !m.stopped;
}
