#include "render/keep.h"

#include "base/memory.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

void wr_keep_fini(WrKeep *keep)
{
    wr_free(keep->seen);
    wr_field_free(keep->field);
    *keep = (WrKeep){ 0 };
}

void wr_keep_start(WrKeep *keep, int tiles)
{
    wr_keep_fini(keep);
    keep->seen = wr_alloc((size_t)tiles, sizeof *keep->seen);
    keep->tiles = tiles;
}

static void note(WrBlocks *seen, int u, int v)
{
    u = u < WR_KEEP_SIDE ? u : WR_KEEP_SIDE - 1; /* 1 itself, on clamped axes */
    v = v < WR_KEEP_SIDE ? v : WR_KEEP_SIDE - 1;
    seen->row[v] |= 1ULL << u;
}

void wr_keep_note_places(WrBlocks *seen, int count, size_t size, const void *tu, const void *tv)
{
    if (size == sizeof(float)) {
        const float *u = tu, *v = tv;
        for (int i = 0; i < count; i++)
            note(seen, (int)(u[i] * WR_KEEP_SIDE), (int)(v[i] * WR_KEEP_SIDE));
    } else {
        const double *u = tu, *v = tv;
        for (int i = 0; i < count; i++)
            note(seen, (int)(u[i] * WR_KEEP_SIDE), (int)(v[i] * WR_KEEP_SIDE));
    }
}

/* The blocks from a to b as a mask, round the ends: what is too much on a clamped axis does no harm. */
static uint64_t span(double a, double b)
{
    if (!(b - a < 1.0)) return ~0ULL;
    int first = (int)floor(a * WR_KEEP_SIDE), last = (int)floor(b * WR_KEEP_SIDE);
    uint64_t mask = 0;
    for (int k = first; k <= last; k++)
        mask |= 1ULL << ((k % WR_KEEP_SIDE + WR_KEEP_SIDE) % WR_KEEP_SIDE);
    return mask;
}

void wr_keep_note_box(WrBlocks *seen, double tu, double tv, double reach_u, double reach_v)
{
    const uint64_t columns = span(tu - reach_u, tu + reach_u);
    const uint64_t rows = span(tv - reach_v, tv + reach_v);
    for (int v = 0; v < WR_KEEP_SIDE; v++)
        if (rows >> v & 1) seen->row[v] |= columns;
}

/* Texels that differ, columns [i0, i1) and rows [j0, j1) from the top. */
typedef struct Rect {
    int i0, i1, j0, j1;
} Rect;

typedef struct Compare {
    const WrField *old, *now;
    int reach;
    WrBlocks *changed;
} Compare;

static Rect difference(const Compare *compare, int tx, int ty)
{
    const float *a = wr_field_tile(compare->old, tx, ty), *b = wr_field_tile(compare->now, tx, ty);
    const float level_a = wr_field_level(compare->old), level_b = wr_field_level(compare->now);
    Rect r = { WR_TILE, 0, WR_TILE, 0 };
    for (int y = 0; y < WR_TILE; y++)
        for (int x = 0; x < WR_TILE; x++) {
            float fa = a ? a[y * WR_TILE + x] : level_a, fb = b ? b[y * WR_TILE + x] : level_b;
            if (memcmp(&fa, &fb, sizeof fa) == 0) continue;
            r.i0 = x < r.i0 ? x : r.i0;
            r.i1 = x + 1 > r.i1 ? x + 1 : r.i1;
            r.j0 = y < r.j0 ? y : r.j0;
            r.j1 = y + 1 > r.j1 ? y + 1 : r.j1;
        }
    return (Rect){ tx * WR_TILE + r.i0, tx * WR_TILE + r.i1, ty * WR_TILE + r.j0,
                   ty * WR_TILE + r.j1 };
}

/* The blocks that texels [a, b) of n touch, as a mask; round the end, or cut there. */
static uint64_t blocks_of(int a, int b, int n, WrWrap wrap)
{
    if (b - a >= n) return ~0ULL;
    int first = (int)((int64_t)a * WR_KEEP_SIDE / n) - 1; /* a may be negative: one block more */
    int last = (int)((int64_t)b * WR_KEEP_SIDE / n) + 1;
    uint64_t mask = 0;
    for (int k = first; k <= last; k++) {
        if (wrap == WR_WRAP_PERIODIC)
            mask |= 1ULL << ((k % WR_KEEP_SIDE + WR_KEEP_SIDE) % WR_KEEP_SIDE);
        else if (k >= 0 && k < WR_KEEP_SIDE) mask |= 1ULL << k;
    }
    return mask;
}

static void mark(int tx, int ty, void *ctx)
{
    const Compare *compare = ctx;
    const WrField *field = compare->now;
    const int w = wr_field_width(field), h = wr_field_height(field), reach = compare->reach;
    Rect r = difference(compare, tx, ty);
    if (r.i0 >= r.i1) return;
    uint64_t columns = blocks_of(r.i0 - reach, r.i1 + reach, w, wr_field_wrap_u(field));
    /* Rows run down, v runs up. */
    uint64_t rows = blocks_of(h - r.j1 - reach, h - r.j0 + reach, h, wr_field_wrap_v(field));
    for (int v = 0; v < WR_KEEP_SIDE; v++)
        if (rows >> v & 1) compare->changed->row[v] |= columns;
}

bool wr_keep_compare(WrKeep *keep, const WrField *field, int reach)
{
    const WrField *old = keep->field;
    if (!keep->seen || !old || wr_field_width(old) != wr_field_width(field) ||
        wr_field_height(old) != wr_field_height(field) ||
        wr_field_wrap_u(old) != wr_field_wrap_u(field) ||
        wr_field_wrap_v(old) != wr_field_wrap_v(field))
        return false;
    memset(&keep->changed, 0, sizeof keep->changed);
    Compare compare = { old, field, reach, &keep->changed };
    wr_field_changes(old, field, mark, &compare);
    return true;
}

bool wr_keep_touches(const WrKeep *keep, int tile)
{
    for (int v = 0; v < WR_KEEP_SIDE; v++)
        if (keep->seen[tile].row[v] & keep->changed.row[v]) return true;
    return false;
}

void wr_keep_field(WrKeep *keep, const WrField *field)
{
    wr_field_free(keep->field);
    keep->field = wr_field_share(field);
}
