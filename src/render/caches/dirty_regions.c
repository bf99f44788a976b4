#include "render/caches/dirty_regions.h"

#include "base/memory.h"
#include "field/field.h"
#include "render/textures/height_copies.h"
#include "render/kernels/kern.h"

#include <math.h>
#include <string.h>

#define CELL 16 /* texels of a side: all marked texels of one cell become one box */

void wr_dirty_fini(WrDirty *keep)
{
    wr_free(keep->patches);
    wr_free(keep->whole);
    wr_field_free(keep->field);
    *keep = (WrDirty){ 0 };
}

/* A box is a reference point (u, v) with offsets low <= 0 <= high, on the torus of the periodic table: boxes
   across the seam need no special case. high < low marks the empty box. */
static const WrDirtyBox nothing = { .high_u = -1, .high_v = -1 };

static bool is_empty(const WrDirtyBox *box)
{
    return box->high_u < box->low_u;
}

/* patches [tiles][down][across] are boxes of the texture positions that each patch of pixels has fetched;
   whole [tiles] bounds a tile's patches. */
void wr_dirty_start(WrDirty *keep, int tiles, int tile_w, int tile_h, bool whole)
{
    wr_dirty_fini(keep);
    keep->tiles = tiles;
    keep->tile_w = tile_w, keep->tile_h = tile_h;
    keep->patch_w = whole ? tile_w : WR_DIRTY_W;
    keep->patch_h = whole ? tile_h : WR_DIRTY_H;
    keep->across = (tile_w + keep->patch_w - 1) / keep->patch_w;
    keep->down = (tile_h + keep->patch_h - 1) / keep->patch_h;
    const size_t patches = (size_t)tiles * (size_t)keep->across * (size_t)keep->down;
    keep->patches = wr_alloc(patches, sizeof *keep->patches);
    keep->whole = wr_alloc((size_t)tiles, sizeof *keep->whole);
    for (size_t i = 0; i < patches; i++) keep->patches[i] = nothing;
    for (int i = 0; i < tiles; i++) keep->whole[i] = nothing;
}

static WrDirtyBox *patches_of(const WrDirty *keep, int tile)
{
    return keep->patches + (size_t)tile * (size_t)keep->across * (size_t)keep->down;
}

/* ---- recording ---- */

WrDirtyNotes wr_dirty_open(WrDirty *keep, int tile, int x, int y)
{
    if (!keep) return (WrDirtyNotes){ 0 };
    return (WrDirtyNotes){ .patches = patches_of(keep, tile),
                           .across = keep->across,
                           .single = keep->across * keep->down == 1,
                           .x = x - x % keep->tile_w,
                           .y = y - y % keep->tile_h };
}

/* Signed distance from `from` to x on a circle of length 1: -1/2 .. 1/2. */
static inline float apart(float x, float from)
{
    const float d = x - from;
    return d > 0.5f ? d - 1.0f : d < -0.5f ? d + 1.0f : d;
}

/* Grows `box` to contain `more`. */
static void add_box(WrDirtyBox *box, const WrDirtyBox *more)
{
    if (is_empty(more)) return;
    if (is_empty(box)) *box = (WrDirtyBox){ .u = more->u, .v = more->v };
    const float du = apart(more->u, box->u), dv = apart(more->v, box->v);
    box->low_u = fminf(box->low_u, du + more->low_u);
    box->high_u = fmaxf(box->high_u, du + more->high_u);
    box->low_v = fminf(box->low_v, dv + more->low_v);
    box->high_v = fmaxf(box->high_v, dv + more->high_v);
}

/* Smallest and largest offset of the values from the first one, on a circle of length 1. */
static void extent_round(int count, const float *x, float *low, float *high)
{
    *low = *high = 0;
    for (int i = 0; i < count; i++) {
        const float d = apart(x[i], x[0]);
        *low = fminf(*low, d);
        *high = fmaxf(*high, d);
    }
    *low += x[0], *high += x[0];
}

/* Grows `box` to contain `count` more points.
   Points within half a turn have an ordinary extent; only others are measured around the circle. */
static inline void add_places(WrDirtyBox *box, int count, const float *u, const float *v)
{
    float u0 = u[0], u1 = u[0], v0 = v[0], v1 = v[0];
    wr_extent_add(u, count, &u0, &u1);
    wr_extent_add(v, count, &v0, &v1);
    if (u1 - u0 > 0.5f) extent_round(count, u, &u0, &u1);
    if (v1 - v0 > 0.5f) extent_round(count, v, &v0, &v1);
    const WrDirtyBox more = { u[0], v[0], u0 - u[0], u1 - u[0], v0 - v[0], v1 - v[0] };
    add_box(box, &more);
}

/* Index of the patch that contains sample x, with k samples a pixel.
   x is the sample's index plus a shift of less than 1/2: adding 1/2 and truncating returns the index. */
static int patch_at(float x, int k, int from, int side)
{
    const int sample = (int)(x + 0.5f);
    return (int)((unsigned)((k == 1 ? sample : sample / k) - from) / (unsigned)side);
}

/* Records a run of neighbouring samples in one row, one sample a pixel. */
static void note_row(const WrDirtyNotes *notes, int x, int count, const float *u, const float *v,
                     WrDirtyBox *patch)
{
    const int first = WR_DIRTY_W - (x - notes->x) % WR_DIRTY_W;
    int run = first < count ? first : count;
    add_places(patch++, run, u, v);
    for (; count - run >= WR_DIRTY_W; run += WR_DIRTY_W)
        add_places(patch++, WR_DIRTY_W, u + run, v + run);
    if (run < count) add_places(patch, count - run, u + run, v + run);
}

/* Number of samples, from the first one on, that lie in the patch `column`, `row` of the tile. */
static int run_of(const WrDirtyNotes *notes, int k, int count, const float *x, const float *y,
                  int column, int row)
{
    const int px = notes->x + column * WR_DIRTY_W, py = notes->y + row * WR_DIRTY_H;
    const float x0 = (float)(px * k) - 0.5f, x1 = (float)((px + WR_DIRTY_W) * k) - 0.5f;
    const float y0 = (float)(py * k) - 0.5f, y1 = (float)((py + WR_DIRTY_H) * k) - 0.5f;
    int run = 1;
    while (run < count && x[run] >= x0 && x[run] < x1 && y[run] >= y0 && y[run] < y1) run++;
    return run;
}

/* Records samples at any positions of the tile, or of one row of it. */
static void note_samples(const WrDirtyNotes *notes, int k, int count, const float *x,
                         const float *y, const float *u, const float *v)
{
    for (int i = 0, run; i < count; i += run) {
        const int column = patch_at(x[i], k, notes->x, WR_DIRTY_W);
        const int row = patch_at(y[i], k, notes->y, WR_DIRTY_H);
        WrDirtyBox *patch = notes->patches + row * notes->across + column;
        const int last = count - 1;
        const bool beside = k == 1 && y[i] == y[last] && x[last] - x[i] == (float)(last - i);
        if (beside) {
            note_row(notes, (int)(x[i] + 0.5f), count - i, u + i, v + i, patch);
            return;
        }
        run = run_of(notes, k, count - i, x + i, y + i, column, row);
        add_places(patch, run, u + i, v + i);
    }
}

/* Converts to single precision: [count] floats or doubles, by `size`. */
static const float *narrowed(int count, size_t size, const void *numbers, float *room)
{
    const double *from = numbers;
    if (size == sizeof(float)) return numbers;
    for (int i = 0; i < count; i++) room[i] = (float)from[i];
    return room;
}

void wr_dirty_add_places(const WrDirtyNotes *notes, int k, int count, size_t size, const void *x,
                         const void *y, const void *tu, const void *tv)
{
    float room[4][WR_SPAN];
    const float *at_x = narrowed(count, size, x, room[0]),
                *at_y = narrowed(count, size, y, room[1]);
    const float *u = narrowed(count, size, tu, room[2]), *v = narrowed(count, size, tv, room[3]);
    if (notes->single && count > 0) add_places(notes->patches, count, u, v);
    else note_samples(notes, k, count, at_x, at_y, u, v);
}

void wr_dirty_add_box(const WrDirtyNotes *notes, int k, double x, double y, double tu, double tv,
                      double reach_u, double reach_v)
{
    const float u = (float)reach_u, v = (float)reach_v;
    const WrDirtyBox box = { (float)tu, (float)tv, -u, u, -v, v };
    const int column = notes->single ? 0 : patch_at((float)x, k, notes->x, WR_DIRTY_W);
    const int row = notes->single ? 0 : patch_at((float)y, k, notes->y, WR_DIRTY_H);
    add_box(notes->patches + row * notes->across + column, &box);
}

void wr_dirty_close(WrDirty *keep, int tile)
{
    if (!keep) return;
    const WrDirtyBox *patches = patches_of(keep, tile);
    keep->whole[tile] = nothing;
    for (int i = 0; i < keep->across * keep->down; i++) add_box(&keep->whole[tile], &patches[i]);
}

/* ---- comparing ---- */

typedef struct Compare {
    const WrField *old, *now;
    int reach;
    WrDirty *keep;
} Compare;

/* Smallest box that contains both, joined across the shorter gap round the ends. */
static WrDirtyBox joined(const WrDirtyBox *a, const WrDirtyBox *b)
{
    WrDirtyBox box = *a;
    add_box(&box, b);
    return box;
}

static float area(const WrDirtyBox *box)
{
    return fminf(box->high_u - box->low_u, 1) * fminf(box->high_v - box->low_v, 1);
}

/* Extra area of the joined box over the two separate boxes. */
static float waste(const WrDirtyBox *a, const WrDirtyBox *b)
{
    const WrDirtyBox box = joined(a, b);
    return area(&box) - area(a) - area(b);
}

/* Adds a box. It is merged with a box that it fits; when the list is full, with the box where the waste is
   least.
   A short list keeps the comparison with every patch cheap; merging costs pixels that are rendered for
   nothing. */
static void add_change(WrDirty *keep, const WrDirtyBox *box)
{
    int best = 0;
    float least = INFINITY;
    for (int i = 0; i < keep->changes; i++) {
        const float more = waste(&keep->changed[i], box);
        if (more < least) best = i, least = more;
    }
    if (least <= 0.25f * area(box) || keep->changes == WR_DIRTY_CHANGES)
        keep->changed[best] = joined(&keep->changed[best], box);
    else keep->changed[keep->changes++] = *box;
}

/* Adds a rectangle of texels of the field, grown by `reach`.
   reach: texels that a fetch reads beside its position (the scheme's support). */
static void add_rect(WrDirty *keep, const WrField *field, WrFieldRect r, int reach)
{
    const float w = (float)wr_field_width(field), h = (float)wr_field_height(field);
    if (r.i0 >= r.i1) return;
    const float half_u = 0.5f * (float)(r.i1 - r.i0) + (float)reach;
    const float half_v = 0.5f * (float)(r.j1 - r.j0) + (float)reach;
    /* Rows run down, v runs up. */
    const WrDirtyBox box = { .u = 0.5f * (float)(r.i0 + r.i1) / w,
                             .v = 1 - 0.5f * (float)(r.j0 + r.j1) / h,
                             .low_u = -half_u / w,
                             .high_u = half_u / w,
                             .low_v = -half_v / h,
                             .high_v = half_v / h };
    add_change(keep, &box);
}

static void mark(int tx, int ty, void *ctx)
{
    const Compare *compare = ctx;
    const WrFieldRect r = wr_field_difference(compare->old, compare->now, tx, ty);
    add_rect(compare->keep, compare->now, r, compare->reach);
}

/* Bounding rectangle of the marked texels in one CELL x CELL cell of the field. */
static WrFieldRect marked_in(const WrField *field, const unsigned char *marked, int i0, int j0)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    WrFieldRect r = { w, 0, h, 0 };
    for (int j = j0; j < j0 + CELL && j < h; j++)
        for (int i = i0; i < i0 + CELL && i < w; i++) {
            if (!marked[(size_t)j * (size_t)w + (size_t)i]) continue;
            r.i0 = i < r.i0 ? i : r.i0, r.i1 = i >= r.i1 ? i + 1 : r.i1;
            r.j0 = j < r.j0 ? j : r.j0, r.j1 = j >= r.j1 ? j + 1 : r.j1;
        }
    return r;
}

void wr_dirty_add_texels(WrDirty *keep, const WrField *field, const unsigned char *marked)
{
    for (int j = 0; j < wr_field_height(field); j += CELL)
        for (int i = 0; i < wr_field_width(field); i += CELL) /* one more texel for rounding */
            add_rect(keep, field, marked_in(field, marked, i, j), 2);
}

bool wr_dirty_compare(WrDirty *keep, const WrField *field, int reach)
{
    const WrField *old = keep->field;
    if (!keep->patches || !old || !wr_field_alike(old, field)) return false;
    keep->changes = 0;
    Compare compare = { old, field, reach, keep };
    wr_field_changes(old, field, mark, &compare);
    return true;
}

/* True if the intervals overlap on a circle of length 1. Both contain a point in 0..1. */
static bool overlap(float a0, float a1, float b0, float b1)
{
    if (a1 - a0 >= 1 || b1 - b0 >= 1) return true;
    for (int turn = -1; turn <= 1; turn++)
        if (a0 + (float)turn <= b1 && a1 + (float)turn >= b0) return true;
    return false;
}

static bool meets(const WrDirtyBox *a, const WrDirtyBox *b)
{
    return overlap(a->u + a->low_u, a->u + a->high_u, b->u + b->low_u, b->u + b->high_u) &&
           overlap(a->v + a->low_v, a->v + a->high_v, b->v + b->low_v, b->v + b->high_v);
}

static bool meets_any(const WrDirty *keep, const WrDirtyBox *box)
{
    if (is_empty(box)) return false;
    for (int i = 0; i < keep->changes; i++)
        if (meets(&keep->changed[i], box)) return true;
    return false;
}

bool wr_dirty_touches(const WrDirty *keep, int tile)
{
    return meets_any(keep, &keep->whole[tile]);
}

bool wr_dirty_touches_patch(const WrDirty *keep, int tile, int column, int row)
{
    return meets_any(keep, &patches_of(keep, tile)[row * keep->across + column]);
}

void wr_dirty_store_field(WrDirty *keep, const WrField *field)
{
    wr_field_free(keep->field);
    keep->field = wr_field_share(field);
}
