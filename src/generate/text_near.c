/* Distances of texels from the rim. A tile is recursively quartered; each quarter keeps the pieces that
 * can be the nearest of any of its texels, judged by the pieces' centres, which lie within HALF of
 * every point of a piece, since a piece does not leave its texel. Centres are compared in float with a
 * tolerance SLACK; the distances themselves are computed in double from the pieces' integers, so that
 * only the pieces determine them. */
#include "generate/text.h"

#include <math.h>
#include <string.h>

#define HALF 0.7072f
#define SLACK 0.02f
#define LEAF 4

typedef struct Search {
    WrTextNear *near;
    const bool *want;
    float *distance;
    double reach;
    int columns, rows; /* of the tile's part inside the table */
} Search;

void wr_text_near_fini(WrTextNear *near)
{
    wr_array_free(&near->x);
    wr_array_free(&near->y);
    wr_array_free(&near->ends);
    wr_array_free(&near->list);
}

/* ---- collection ---- */

static int modulo(int i, int n)
{
    int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

static void take_piece(WrTextNear *near, const WrTextPiece *p, int x, int y)
{
    const double unit = 1.0 / WR_TEXT_UNIT;
    double ends[4] = { x + p->x0 * unit, y + p->y0 * unit, x + p->x1 * unit, y + p->y1 * unit };
    wr_array_push(&near->x, (float)(0.5 * (ends[0] + ends[2])));
    wr_array_push(&near->y, (float)(0.5 * (ends[1] + ends[3])));
    for (int k = 0; k < 4; k++) wr_array_push(&near->ends, ends[k]);
}

/* Adds the row's pieces in columns from .. to - 1 of the table, shifted `shift` columns to the right of
 * the tile's coordinates. */
static void take_columns(WrTextNear *near, const struct WrTextRim *rim, int row, int from, int to,
                         int shift, int y)
{
    int low = rim->first[row], high = rim->first[row + 1], end = high;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (rim->pieces.data[middle].i < from) low = middle + 1;
        else high = middle;
    }
    for (; low < end && rim->pieces.data[low].i < to; low++)
        take_piece(near, &rim->pieces.data[low], rim->pieces.data[low].i + shift, y);
}

/* Adds all pieces in rows y0 .. y1 - 1 and columns x0 .. x1 - 1 in the tile's coordinates. */
static void gather(WrTextNear *near, const WrTextShape *shape, const WrTextInside *inside,
                   const WrGenerateBlock *b, int x0, int x1, int y0, int y1)
{
    near->x.count = near->y.count = near->ends.count = 0;
    for (int y = y0; y < y1; y++) {
        int j = b->j + y;
        if (shape->wraps_v) j = modulo(j, shape->height);
        if (j < 0 || j >= shape->height) continue;
        const struct WrTextRim *rim = &inside->rims[j / WR_TILE];
        for (int x = x0; x < x1;) {
            int i = b->i + x;
            if (shape->wraps_u) i = modulo(i, shape->width);
            int end = x1 - x < shape->width - i ? i + x1 - x : shape->width;
            take_columns(near, rim, j % WR_TILE, i < 0 ? 0 : i, end, x - i, y);
            if (!shape->wraps_u) break;
            x += end - i;
        }
    }
}

/* ---- search ---- */

static double distance2(const double *e, double x, double y)
{
    double dx = e[2] - e[0], dy = e[3] - e[1], px = x - e[0], py = y - e[1];
    double along = px * dx + py * dy, length = dx * dx + dy * dy;
    if (along > 0.0 && length > 0.0) {
        double t = along >= length ? 1.0 : along / length;
        px -= t * dx;
        py -= t * dy;
    }
    return px * px + py * py;
}

static void leaf(const Search *s, int x0, int y0, int size, const int *list, int count)
{
    for (int y = y0; y < y0 + size && y < s->rows; y++)
        for (int x = x0; x < x0 + size && x < s->columns; x++) {
            if (!s->want[y * WR_TILE + x]) continue;
            double least = s->reach * s->reach;
            for (int k = 0; k < count; k++) {
                double d = distance2(s->near->ends.data + 4 * (ptrdiff_t)list[k], x + 0.5, y + 0.5);
                least = d < least ? d : least;
            }
            s->distance[y * WR_TILE + x] = (float)sqrt(least);
        }
}

static bool is_wanted(const Search *s, int x0, int y0, int size)
{
    for (int y = y0; y < y0 + size && y < s->rows; y++)
        for (int x = x0; x < x0 + size && x < s->columns; x++)
            if (s->want[y * WR_TILE + x]) return true;
    return false;
}

/* Appends the pieces of the list that may be nearest to any texel of the square. */
static int cull(const Search *s, int x0, int y0, int size, int first, int count)
{
    WrTextNear *near = s->near;
    float cx = (float)x0 + 0.5f * (float)size, cy = (float)y0 + 0.5f * (float)size;
    float half = 0.7072f * (float)(size - 1), least = (float)s->reach + half + HALF + SLACK;
    least *= least;
    for (int k = 0; k < count; k++) {
        int p = near->list.data[first + k];
        float dx = near->x.data[p] - cx, dy = near->y.data[p] - cy, d = dx * dx + dy * dy;
        least = d < least ? d : least;
    }
    float most = sqrtf(least) + 2.0f * half + HALF + SLACK;
    most *= most;
    int kept = 0;
    near->list.count = first + count;
    wr_array_reserve(&near->list, first + 2 * count);
    for (int k = 0; k < count; k++) {
        int p = near->list.data[first + k];
        float dx = near->x.data[p] - cx, dy = near->y.data[p] - cy;
        if (dx * dx + dy * dy <= most) near->list.data[first + count + kept++] = p;
    }
    return kept;
}

static void search(const Search *s, int x0, int y0, int size, int first, int count)
{
    if (!is_wanted(s, x0, y0, size)) return;
    int kept = cull(s, x0, y0, size, first, count), next = first + count;
    if (size <= LEAF) {
        leaf(s, x0, y0, size, s->near->list.data + next, kept);
        return;
    }
    int half = size / 2;
    for (int q = 0; q < 4; q++)
        search(s, x0 + (q & 1) * half, y0 + (q >> 1) * half, half, next, kept);
}

/* The distance of the nearest centre from the tile's centre, or -1. */
static double nearest(const WrTextNear *near)
{
    float least = -1.0f;
    for (int k = 0; k < near->x.count; k++) {
        float dx = near->x.data[k] - 0.5f * WR_TILE, dy = near->y.data[k] - 0.5f * WR_TILE;
        float d = dx * dx + dy * dy;
        least = least < 0.0f || d < least ? d : least;
    }
    return least < 0.0f ? -1.0 : sqrt((double)least);
}

void wr_text_distances(const WrTextShape *shape, const WrTextInside *inside,
                       const WrGenerateBlock *block, double reach, const bool *want,
                       WrTextNear *near, float *distance)
{
    Search s = { near, want, distance, reach, block->count_i, block->count_j };
    if (!is_wanted(&s, 0, 0, WR_TILE)) return;
    /* Widens the search until nothing outside can be nearest. */
    const double corner = 0.7072 * WR_TILE;
    int around = 8, most = (int)ceil(reach) + 1;
    for (;; around *= 2) {
        if (around > most) around = most;
        gather(near, shape, inside, block, -around, WR_TILE + around, -around, WR_TILE + around);
        double least = nearest(near);
        if (around == most || (least >= 0.0 && least + corner + 1.0 <= around)) break;
        double enough = least + corner + 2.0;
        if (least >= 0.0 && enough > around) {
            around = enough < most ? (int)enough + 1 : most;
            gather(near, shape, inside, block, -around, WR_TILE + around, -around,
                   WR_TILE + around);
            break;
        }
    }
    near->list.count = 0;
    wr_array_reserve(&near->list, near->x.count + 1);
    for (int k = 0; k < near->x.count; k++) near->list.data[k] = k;
    search(&s, 0, 0, WR_TILE, 0, near->x.count);
}
