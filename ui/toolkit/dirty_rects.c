#include "ui/toolkit/dirty_rects.h"

#include "base/memory.h"

#include <stdbool.h>
#include <string.h>

#define SIDE_BITS 5 /* squares of 32 x 32 pixels */
#define SIDE (1 << SIDE_BITS)
/* Pixels drawn unnecessarily that are acceptable for one rectangle less. */
#define SPARE (8 * SIDE * SIDE)

/* Per square a 64-bit sum of everything drawn in it during this frame and during the frame before. A change is missed only if
   two different sequences have equal sums, about 2^-64 per changed square. */
struct WrDirtyRects {
    int width, height, columns, rows;
    uint64_t *now, *before; /* [rows][columns]; owned */
    bool *touched;          /* [rows][columns]; owned */
    bool all;
};

WrDirtyRects *wr_dirty_rects_new(void)
{
    WrDirtyRects *damage = wr_alloc(1, sizeof *damage);
    damage->all = true;
    return damage;
}

/* `all` holds from creation, and after wr_dirty_rects_forget, until the end of one frame: there is no valid frame before to
   compare with. */
static void free_squares(WrDirtyRects *damage)
{
    wr_free(damage->now);
    wr_free(damage->before);
    wr_free(damage->touched);
}

void wr_dirty_rects_free(WrDirtyRects *damage)
{
    if (!damage) return;
    free_squares(damage);
    wr_free(damage);
}

static size_t squares(const WrDirtyRects *damage)
{
    return (size_t)damage->columns * (size_t)damage->rows;
}

void wr_dirty_rects_begin(WrDirtyRects *damage, int width, int height)
{
    if (width != damage->width || height != damage->height) {
        free_squares(damage);
        damage->width = width;
        damage->height = height;
        damage->columns = (width + SIDE - 1) >> SIDE_BITS;
        damage->rows = (height + SIDE - 1) >> SIDE_BITS;
        damage->now = wr_alloc(squares(damage), sizeof *damage->now);
        damage->before = wr_alloc(squares(damage), sizeof *damage->before);
        damage->touched = wr_alloc(squares(damage), sizeof *damage->touched);
        damage->all = true;
    }
    memset(damage->now, 0, squares(damage) * sizeof *damage->now);
}

/* Range of squares touched by a box; false: none. */
static bool reach(const WrDirtyRects *damage, const SDL_Rect *box, SDL_Point *first,
                  SDL_Point *last)
{
    const SDL_Rect room = { 0, 0, damage->width, damage->height };
    SDL_Rect seen;
    if (!SDL_IntersectRect(box, &room, &seen)) return false;
    *first = (SDL_Point){ seen.x >> SIDE_BITS, seen.y >> SIDE_BITS };
    *last = (SDL_Point){ (seen.x + seen.w - 1) >> SIDE_BITS, (seen.y + seen.h - 1) >> SIDE_BITS };
    return true;
}

/*     sum <- g((sum ^ what) * m),   g(t) = t ^ t >> 29
   The map is bijective in `sum` for a fixed `what` and depends on the order: the same operations in another order have
   another sum, as their pixels may differ. */
void wr_dirty_rects_add(WrDirtyRects *damage, const SDL_Rect *box, uint64_t what)
{
    SDL_Point first, last;
    if (!reach(damage, box, &first, &last)) return;
    for (int y = first.y; y <= last.y; y++) {
        uint64_t *row = damage->now + (size_t)y * (size_t)damage->columns;
        for (int x = first.x; x <= last.x; x++) {
            /* odd, so the product is bijective */
            const uint64_t mixed = (row[x] ^ what) * 0x9e3779b97f4a7c15u;
            row[x] = mixed ^ mixed >> 29;
        }
    }
}

void wr_dirty_rects_touch(WrDirtyRects *damage, const SDL_Rect *box)
{
    SDL_Point first, last;
    if (!damage->touched || !reach(damage, box, &first, &last)) return;
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++)
            damage->touched[(size_t)y * (size_t)damage->columns + (size_t)x] = true;
}

void wr_dirty_rects_forget(WrDirtyRects *damage)
{
    damage->all = true;
}

/* ---- rectangles ---- */

static int64_t area(const SDL_Rect *r)
{
    return (int64_t)r->w * r->h;
}

static SDL_Rect join(const SDL_Rect *a, const SDL_Rect *b)
{
    SDL_Rect both;
    SDL_UnionRect(a, b, &both);
    return both;
}

/* Add to the list, or merge into the rectangle that grows least if that is cheap or the list is full. */
static void collect(SDL_Rect rects[WR_DIRTY_RECTS_MAX], int *count, const SDL_Rect *more)
{
    int best = -1;
    int64_t least = INT64_MAX;
    for (int i = 0; i < *count; i++) {
        const SDL_Rect both = join(&rects[i], more);
        const int64_t wasted = area(&both) - area(&rects[i]) - area(more);
        if (wasted < least) least = wasted, best = i;
    }
    if (best < 0 || (least > SPARE && *count < WR_DIRTY_RECTS_MAX)) rects[(*count)++] = *more;
    else rects[best] = join(&rects[best], more);
}

/* Merge overlapping rectangles until none overlap. Overlaps would be drawn twice: correct, since each
   drawing starts with the clear, but slow. Each join reduces the count by one, so the
   loop ends after at most WR_DIRTY_RECTS_MAX joins. */
static void part(SDL_Rect rects[WR_DIRTY_RECTS_MAX], int *count)
{
    for (int i = 0; i < *count; i++)
        for (int j = i + 1; j < *count; j++) {
            if (!SDL_HasIntersection(&rects[i], &rects[j])) continue;
            rects[i] = join(&rects[i], &rects[j]);
            rects[j] = rects[--*count];
            i = -1; /* from the start: it may overlap others now */
            break;
        }
}

static bool contains(const SDL_Rect *a, const SDL_Rect *b)
{
    return b->x >= a->x && b->y >= a->y && b->x + b->w <= a->x + a->w && b->y + b->h <= a->y + a->h;
}

/* True if a rectangle had to grow. */
static bool take_whole(SDL_Rect *rects, int count, const SDL_Rect *box)
{
    for (int i = 0; i < count; i++) {
        if (!SDL_HasIntersection(&rects[i], box) || contains(&rects[i], box)) continue;
        rects[i] = join(&rects[i], box);
        return true;
    }
    return false;
}

/* Runs of dirty squares in one row of squares are offered as one rectangle; `collect` joins runs of adjacent rows, since such
   a union wastes little. */
static void find(const WrDirtyRects *damage, SDL_Rect rects[WR_DIRTY_RECTS_MAX], int *count)
{
    for (int y = 0; y < damage->rows; y++)
        for (int x = 0, end; x < damage->columns; x = end + 1) {
            const size_t row = (size_t)y * (size_t)damage->columns;
            for (end = x; end < damage->columns; end++) {
                const size_t i = row + (size_t)end;
                if (damage->now[i] == damage->before[i] && !damage->touched[i]) break;
            }
            if (end > x)
                collect(
                    rects, count,
                    &(SDL_Rect){ x << SIDE_BITS, y << SIDE_BITS, (end - x) << SIDE_BITS, SIDE });
        }
}

/* Alternates between growing rectangles to whole boxes and joining overlaps until neither applies. Both only enlarge the
   covered area within the window, so it ends. The buffers of sums are swapped, not copied; wr_dirty_rects_begin clears the
   new `now`. */
int wr_dirty_rects_end(WrDirtyRects *damage, const SDL_Rect *whole, int count,
                       SDL_Rect rects[WR_DIRTY_RECTS_MAX])
{
    const SDL_Rect room = { 0, 0, damage->width, damage->height };
    int found = 0;
    if (damage->all) rects[found++] = room;
    else find(damage, rects, &found);
    part(rects, &found);
    for (int i = 0; i < count && found > 0; i++) {
        SDL_Rect seen;
        if (!SDL_IntersectRect(&whole[i], &room, &seen) || !take_whole(rects, found, &seen))
            continue;
        part(rects, &found);
        i = -1; /* it may touch other boxes now */
    }
    for (int i = 0; i < found; i++) SDL_IntersectRect(&rects[i], &room, &rects[i]);
    uint64_t *spare = damage->before;
    damage->before = damage->now;
    damage->now = spare;
    memset(damage->touched, 0, squares(damage) * sizeof *damage->touched);
    damage->all = false;
    return found;
}
