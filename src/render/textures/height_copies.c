#include "render/textures/height_copies.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/kernmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "system/large_pages.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- quantized heights ---- */

/* Kernels read contiguous copies of the table instead of its tiles: heights, spline coefficients, or slopes.
   data has rows of `pitch` texels and an apron of WR_APRON texels on every side, filled by wrapping or
   extrapolation, so that fetches need no test at the border. A copy holds the field version it was made from
   (`seen`) and is updated from the difference. */

void wr_quantized_heights_drop(WrQuantizedHeights *rounded)
{
    wr_field_free(rounded->source);
    wr_field_free(rounded->field);
    *rounded = (WrQuantizedHeights){ 0 };
}

typedef struct Rounding {
    WrQuantizedHeights *rounded;
    const WrField *source;
} Rounding;

/* Rounds to the format and back to float: half by the nearest binary16, integers by their code over low .. high.
   An error of half a code in height is an error of code * n / 2 in slope: the terraces of HC51 and HC52. */
static float round_height(const WrQuantizedHeights *r, float f)
{
    if (r->format == WR_HEIGHTS_HALF) return wr_round_half(f);
    const double most = r->format == WR_HEIGHTS_16 ? 65535.0 : 255.0;
    const double span = (double)r->high - (double)r->low;
    if (!(span > 0.0)) return f;
    double code = rint(((double)f - (double)r->low) / span * most);
    code = code < 0.0 ? 0.0 : code > most ? most : code;
    return (float)((double)r->low + code * span / most);
}

/* A tile that the field does not store has the level everywhere. */
static void round_tile(int tx, int ty, void *ctx)
{
    Rounding *job = ctx;
    const float *in = wr_field_tile(job->source, tx, ty);
    const float level = wr_field_level(job->source);
    float *out = wr_field_tile_write(job->rounded->field, tx, ty);
    for (int i = 0; i < WR_TILE * WR_TILE; i++)
        out[i] = round_height(job->rounded, in ? in[i] : level);
}

static bool same_layout(const WrField *a, const WrField *b)
{
    return a && wr_field_width(a) == wr_field_width(b) &&
           wr_field_height(a) == wr_field_height(b) && wr_field_wrap_u(a) == wr_field_wrap_u(b) &&
           wr_field_wrap_v(a) == wr_field_wrap_v(b);
}

const WrField *wr_quantized_heights_update(WrQuantizedHeights *rounded, const WrField *field,
                                           WrHeights format, float low, float high, WrError *err)
{
    if (format == WR_HEIGHTS_DOUBLE || format == WR_HEIGHTS_FLOAT) {
        wr_quantized_heights_drop(rounded);
        return field;
    }
    Rounding job = { rounded, field };
    const bool ranged = format != WR_HEIGHTS_HALF;
    if (same_layout(rounded->source, field) && rounded->format == format &&
        (!ranged || (rounded->low == low && rounded->high == high)) &&
        wr_field_level(rounded->source) == wr_field_level(field)) {
        wr_field_changes(rounded->source, field, round_tile, &job);
    } else {
        wr_quantized_heights_drop(rounded);
        rounded->format = format;
        rounded->low = low, rounded->high = high;
        rounded->field =
            wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                         wr_field_wrap_v(field), round_height(rounded, wr_field_level(field)), err);
        if (!rounded->field) return NULL;
        for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
            for (int tx = 0; tx < wr_field_tiles_u(field); tx++)
                if (wr_field_tile(field, tx, ty)) round_tile(tx, ty, &job);
    }
    wr_field_free(rounded->source);
    rounded->source = wr_field_share(field);
    return rounded->field;
}

/* Fills part of a copy: texels [i, i + w) x [j, j + h), including indices outside the table. */
typedef void (*FillRect)(const WrField *field, int i, int j, int w, int h, float *out,
                         size_t pitch);

static float narrow(double x)
{
    return (float)(x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : x);
}

/* The texels of a rectangle with a border of one texel. */
typedef struct Ring {
    float *t; /* [h + 2][pitch], owned */
    size_t pitch;
    double half_w, half_h; /* half the size of the table, texels */
} Ring;

static Ring read_ring(const WrField *field, int i, int j, int w, int h)
{
    Ring ring = { .pitch = (size_t)w + 2,
                  .half_w = 0.5 * wr_field_width(field),
                  .half_h = 0.5 * wr_field_height(field) };
    ring.t = wr_alloc(ring.pitch * ((size_t)h + 2), sizeof *ring.t);
    wr_field_read(field, i - 1, j - 1, w + 2, h + 2, ring.t, ring.pitch);
    return ring;
}

/* Fu = (T[i+1] - T[i-1]) W/2, Fv = (T[j-1] - T[j+1]) H/2 (rows run down). Differences are in double, so neither
   a large level nor FLT_MAX beside -FLT_MAX does harm (HC48, HC50). */
static inline void slopes_at(const Ring *ring, int x, int y, double *fu, double *fv)
{
    const float *mid = ring->t + (size_t)(y + 1) * ring->pitch + (size_t)x + 1;
    *fu = ((double)mid[1] - (double)mid[-1]) * ring->half_w;
    *fv = ((double)*(mid - ring->pitch) - (double)mid[ring->pitch]) * ring->half_h;
}

static void fill_gradient(const WrField *field, int i, int j, int w, int h, float *out,
                          size_t pitch)
{
    const Ring ring = read_ring(field, i, j, w, h);
    for (int y = 0; y < h; y++) {
        float *restrict row = out + 2 * (size_t)y * pitch;
#pragma omp simd
        for (int x = 0; x < w; x++) {
            double fu, fv;
            slopes_at(&ring, x, y, &fu, &fv);
            row[2 * x] = narrow(fu);
            row[2 * x + 1] = narrow(fv);
        }
    }
    wr_free(ring.t);
}

/* Fills part of a copy in double precision. */
typedef void (*FillFine)(const WrField *field, int i, int j, int w, int h, double *out,
                         size_t pitch);

static void fine_gradient(const WrField *field, int i, int j, int w, int h, double *out,
                          size_t pitch)
{
    Ring ring = read_ring(field, i, j, w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            double *slopes = out + 2 * ((size_t)y * pitch + (size_t)x);
            slopes_at(&ring, x, y, &slopes[0], &slopes[1]);
        }
    wr_free(ring.t);
}

WR_ROWS(kinds);
static const struct {
    FillRect fill;
    FillFine fine; /* NULL: heights, which are single-precision numbers */
    int floats;    /* floats per texel */
    int reach;     /* a changed texel of F changes the copy up to this distance */
    const char *what;
} kinds[WR_COPY_COUNT] = {
    [WR_ROW(WR_COPY_HEIGHTS)] = { wr_field_read, NULL, 1, 0, "heights for the picture" },
    [WR_ROW(WR_COPY_FITTED)] = { wr_field_read_bspline_coefficients,
                                 wr_field_read_bspline_coefficients_double, 1, WR_PREFILTER_REACH,
                                 "spline coefficients" },
    [WR_ROW(WR_COPY_GRADIENT)] = { fill_gradient, fine_gradient, 2, 1, "gradient table" },
};
WR_ROWS_END(kinds, WR_COPY_COUNT);

static int tile_count(const WrField *field)
{
    return wr_field_tiles_u(field) * wr_field_tiles_v(field);
}

void wr_table_init(WrTable *table)
{
    memset(table, 0, sizeof *table);
}

void wr_table_drop(WrTable *table, WrCopyKind kind)
{
    WrTableCopy *copy = &table->copies[kind];
    wr_field_free(copy->seen);
    wr_free(copy->data);
    wr_free(copy->fine);
    *copy = (WrTableCopy){ 0 };
    if (kind != WR_COPY_GRADIENT) return;
    wr_free(table->steep);
    table->steep = NULL;
}

void wr_table_fini(WrTable *table)
{
    for (int kind = 0; kind < WR_COPY_COUNT; kind++) wr_table_drop(table, (WrCopyKind)kind);
    wr_field_free(table->ranged);
    wr_free(table->low);
    wr_free(table->high);
    memset(table, 0, sizeof *table);
}

/* ---- ranges ------------------------------------------------------------------------------------ */

/* low and high are indexed by tile: exact, because comparisons do not round. `ranged` is the version they
   belong to. */

typedef struct RangeJob {
    WrTable *table;
    const WrField *field;
} RangeJob;

static void range_tile(int tx, int ty, void *ctx)
{
    RangeJob *job = ctx;
    const WrField *field = job->field;
    int at = ty * wr_field_tiles_u(field) + tx;
    const float *tile = wr_field_tile(field, tx, ty);
    float low = wr_field_level(field), high = low;
    if (tile) {
        int w = wr_field_width(field) - tx * WR_TILE, h = wr_field_height(field) - ty * WR_TILE;
        low = high = tile[0];
        for (int y = 0; y < h && y < WR_TILE; y++)
            wr_extent_add(tile + y * WR_TILE, w < WR_TILE ? w : WR_TILE, &low, &high);
    }
    job->table->low[at] = low;
    job->table->high[at] = high;
}

/* E6: the table is flat if every tile has low = high = the first tile's value. */
bool wr_table_flat(WrTable *table, const WrField *field)
{
    RangeJob job = { table, field };
    int count = tile_count(field);
    if (same_layout(table->ranged, field)) {
        wr_field_changes(table->ranged, field, range_tile, &job);
    } else {
        wr_free(table->low);
        wr_free(table->high);
        table->low = wr_alloc((size_t)count, sizeof *table->low);
        table->high = wr_alloc((size_t)count, sizeof *table->high);
        for (int ty = 0; ty < wr_field_tiles_v(field) && !wr_progress_stopped(); ty++)
            for (int tx = 0; tx < wr_field_tiles_u(field); tx++) range_tile(tx, ty, &job);
    }
    wr_field_free(table->ranged);
    table->ranged = wr_progress_stopped() ? NULL : wr_field_share(field);
    if (!table->ranged) return false;
    for (int i = 0; i < count; i++)
        if (table->low[i] != table->high[i] || table->low[i] != table->low[0]) return false;
    return true;
}

void wr_table_range(const WrTable *table, float *low, float *high)
{
    const int count = tile_count(table->ranged);
    float other = *high = table->high[0];
    *low = table->low[0];
    wr_extent_add(table->low, count, low, &other);
    other = *low;
    wr_extent_add(table->high, count, &other, high);
}

/* ---- copies ------------------------------------------------------------------------------------ */

/* The texels of a tile of the copy that are computed again. */
typedef struct Part {
    int tile; /* ty * tiles_u + tx */
    WrFieldRect box;
} Part;

typedef struct CopyJob {
    WrTable *table;
    WrTableCopy *copy;
    WrCopyKind kind;
    const WrField *field;
    bool skips;  /* tiles that stay empty are left out */
    int changed; /* tiles */
    bool border; /* a texel that the apron repeats has changed */
    WR_ARRAY(Part) parts;
} CopyJob;

static size_t place(const CopyJob *job, int i, int j)
{
    size_t at = (size_t)(j + WR_APRON) * (size_t)job->copy->pitch + (size_t)(i + WR_APRON);
    return at * (size_t)kinds[job->kind].floats;
}

/* Fills a rectangle of a double-precision copy from the single-precision numbers.
   Slopes of a double-precision copy are computed in double; heights and coefficients without such a function
   are widened. */
static void widen(CopyJob *job, int i, int j, int w, int h)
{
    const size_t row = (size_t)w * (size_t)kinds[job->kind].floats;
    float *t = wr_alloc(row * (size_t)h, sizeof *t);
    kinds[job->kind].fill(job->field, i, j, w, h, t, (size_t)w);
    for (int y = 0; y < h; y++) {
        double *out = job->copy->fine + place(job, i, j + y);
        for (size_t x = 0; x < row; x++) out[x] = (double)t[(size_t)y * row + x];
    }
    wr_free(t);
}

/* True if texels near (x, y) are not stored, now and when the copy was made. */
static bool empty_at(const CopyJob *job, int x, int y)
{
    const int w = wr_field_width(job->field), h = wr_field_height(job->field);
    const bool wraps_u = wr_field_wrap_u(job->field) == WR_WRAP_PERIODIC;
    const bool wraps_v = wr_field_wrap_v(job->field) == WR_WRAP_PERIODIC;
    x = wraps_u ? (x % w + w) % w : x < 0 ? 0 : x >= w ? w - 1 : x;
    y = wraps_v ? (y % h + h) % h : y < 0 ? 0 : y >= h ? h - 1 : y;
    const WrField *seen = job->copy->seen;
    return !wr_field_tile(job->field, x / WR_TILE, y / WR_TILE) &&
           (!seen || !wr_field_tile(seen, x / WR_TILE, y / WR_TILE));
}

/* True if the copy is 0 in a rectangle, and stays so. Extrapolation at clamped ends depends on 3 texels. */
static bool stays_empty(const CopyJob *job, int i, int j, int w, int h)
{
    const int more = kinds[job->kind].reach + 3;
    const int right = i + w - 1 + more, bottom = j + h - 1 + more;
    if (!job->skips) return false;
    for (int y = j - more;; y = y + WR_TILE < bottom ? y + WR_TILE : bottom) {
        for (int x = i - more;; x = x + WR_TILE < right ? x + WR_TILE : right) {
            if (!empty_at(job, x, y)) return false;
            if (x == right) break;
        }
        if (y == bottom) return true;
    }
}

static void fill(CopyJob *job, int i, int j, int w, int h)
{
    const WrTableCopy *copy = job->copy;
    if (copy->data)
        kinds[job->kind].fill(job->field, i, j, w, h, copy->data + place(job, i, j),
                              (size_t)copy->pitch);
    else if (copy->precision == WR_PRECISION_DOUBLE && kinds[job->kind].fine)
        kinds[job->kind].fine(job->field, i, j, w, h, copy->fine + place(job, i, j),
                              (size_t)copy->pitch);
    else widen(job, i, j, w, h);
    __atomic_fetch_add(&job->table->texels_refreshed, (int64_t)w * h, __ATOMIC_RELAXED);
}

/* The end of the tile that holds x, or `end` if that is nearer. */
static int tile_end(int x, int end)
{
    const int next = (x & -WR_TILE) + WR_TILE;
    return next < end ? next : end;
}

/* Memory of empty tiles is not touched, and costs nothing: a new table of 16384 x 16384 would need 2 GB for its slopes. */
static void refresh(CopyJob *job, int i, int j, int w, int h)
{
    if (w <= 0 || h <= 0) return;
    if (!job->skips) {
        fill(job, i, j, w, h);
        return;
    }
    for (int y = j, y1; y < j + h; y = y1) {
        y1 = tile_end(y, j + h);
        for (int x = i, x1; x < i + w; x = x1) {
            x1 = tile_end(x, i + w);
            if (stays_empty(job, x, y, x1 - x, y1 - y)) continue;
            for (int next; x1 < i + w; x1 = next) {
                next = tile_end(x1, i + w);
                if (stays_empty(job, x1, y, next - x1, y1 - y)) break;
            }
            fill(job, x, y, x1 - x, y1 - y);
        }
    }
}

/* Non-negative floats have the same order as their bits; NaN sorts last.
   So maxima of |slope| are integer maxima, which vectorise, and NaN counts as steeper than all (HC49). */
static int32_t magnitude(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (int32_t)(bits & 0x7fffffffU);
}

/* The largest absolute values of `count` pairs, as bits. */
static void add_steepest(const float *slopes, int count, int32_t most[2])
{
    int32_t u = most[0], v = most[1];
#pragma omp simd reduction(max : u, v)
    for (int i = 0; i < count; i++) {
        const int32_t su = magnitude(slopes[2 * i]), sv = magnitude(slopes[2 * i + 1]);
        u = su > u ? su : u;
        v = sv > v ? sv : v;
    }
    most[0] = u, most[1] = v;
}

static bool any_slope(const double *slopes, int count)
{
    for (int i = 0; i < 2 * count; i++)
        if (slopes[i] != 0.0) return true;
    return false;
}

/* The texels of a tile along one axis, from <= to. At the ends of a clamped axis two more, which fetches near
   the end read: the extrapolated slopes there may be steeper than all of the table. */
typedef struct Reach {
    int from, to;
} Reach;

static Reach reach_of(int tile, int size, WrWrap wrap)
{
    const int from = tile * WR_TILE, end = from + WR_TILE < size ? from + WR_TILE : size;
    const int more = wrap == WR_WRAP_PERIODIC ? 0 : 2;
    return (Reach){ tile == 0 ? -more : from, end == size ? end + more : end };
}

/* steep[tile] bounds |Fu|, |Fv| at the tile's texels. Bilinear fetches of the gradient copy stay within the
   bounds of the texels around, and slope_bounds relies on that. */
static void mark_steep(CopyJob *job, int tx, int ty)
{
    const WrField *field = job->field;
    const Reach x = reach_of(tx, wr_field_width(field), wr_field_wrap_u(field));
    const Reach y = reach_of(ty, wr_field_height(field), wr_field_wrap_v(field));
    const int32_t unknown = magnitude(INFINITY);
    int32_t most[2] = { 0, 0 };
    for (int j = y.from; j < y.to; j++) {
        const size_t row = place(job, x.from, j);
        const int w = x.to - x.from;
        if (job->copy->data) add_steepest(job->copy->data + row, w, most);
        else if (any_slope(job->copy->fine + row, w)) most[0] = most[1] = unknown;
    }
    float *steep = job->table->steep[ty * wr_field_tiles_u(field) + tx];
    for (int c = 0; c < 2; c++) {
        most[c] = most[c] < unknown ? most[c] : unknown;
        memcpy(&steep[c], &most[c], sizeof steep[c]);
    }
}

/* Builds a strip of tile rows in a full build, apron columns included. */
static void build_strip(int strip, int worker, void *ctx)
{
    (void)worker;
    CopyJob *job = ctx;
    const int w = wr_field_width(job->field), h = wr_field_height(job->field);
    int top = strip * WR_TILE, bottom = top + WR_TILE < h ? top + WR_TILE : h;
    int from = strip == 0 ? -WR_APRON : top;
    int to = bottom == h ? h + WR_APRON : bottom;
    refresh(job, -WR_APRON, from, w + 2 * WR_APRON, to - from);
    if (job->kind == WR_COPY_GRADIENT)
        for (int tx = 0; tx < wr_field_tiles_u(job->field); tx++)
            if (!stays_empty(job, tx * WR_TILE, top, WR_TILE, WR_TILE)) mark_steep(job, tx, strip);
}

/* Interval [a, b) of one axis, split into pieces inside [0, n): a periodic axis wraps.
   On a periodic axis an interval may reach over both ends: the parts shifted by -n, 0 and n that fall into the
   table. */
typedef struct Pieces {
    int from[3], to[3], count;
    bool border; /* near an end of the axis */
} Pieces;

static Pieces cut(int a, int b, int n, WrWrap wrap)
{
    Pieces p = { .count = 0 };
    if (wrap == WR_WRAP_PERIODIC && b - a >= n) {
        p.from[0] = 0, p.to[0] = n, p.count = 1;
        return p;
    }
    for (int shift = -1; shift <= 1; shift++) {
        if (shift != 0 && wrap != WR_WRAP_PERIODIC) continue;
        int from = a + shift * n, to = b + shift * n;
        from = from < 0 ? 0 : from;
        to = to > n ? n : to;
        if (from >= to) continue;
        p.from[p.count] = from;
        p.to[p.count++] = to;
    }
    return p;
}

/* Texels that depend on texels [a, b) of an axis of n. On a clamped axis the extrapolated end depends on the
   last 3. */
static Pieces reach_from(int a, int b, int reach, int n, WrWrap wrap)
{
    const bool ends = wrap != WR_WRAP_PERIODIC;
    const int edge = reach + WR_APRON;
    Pieces p = cut(ends && a < 3 ? 0 : a - reach, ends && b > n - 3 ? n : b + reach, n, wrap);
    p.border = a < edge || b > n - edge;
    return p;
}

/* The parts of the copy that depend on a changed tile's texels.
   wr_field_difference narrows a changed tile to the rectangle of changed texels. */
static void reached(const CopyJob *job, int tx, int ty, Pieces *u, Pieces *v)
{
    const WrField *field = job->field;
    const int w = wr_field_width(field), h = wr_field_height(field), reach = kinds[job->kind].reach;
    const WrFieldRect own = wr_field_difference(job->copy->seen, field, tx, ty);
    *u = *v = (Pieces){ .count = 0 };
    if (own.i0 == own.i1) return;
    *u = reach_from(own.i0, own.i1, reach, w, wr_field_wrap_u(field));
    *v = reach_from(own.j0, own.j1, reach, h, wr_field_wrap_v(field));
}

/* Cuts texels i0 <= i < i1, j0 <= j < j1 at the tiles' edges. */
static void add_parts(CopyJob *job, int i0, int i1, int j0, int j1)
{
    for (int j = j0, bottom; j < j1; j = bottom) {
        bottom = tile_end(j, j1);
        for (int i = i0, right; i < i1; i = right) {
            right = tile_end(i, i1);
            const int tile = j / WR_TILE * wr_field_tiles_u(job->field) + i / WR_TILE;
            wr_array_push(&job->parts, ((Part){ tile, { i, right, j, bottom } }));
        }
    }
}

/* Counts a changed tile. Beyond half of all tiles the whole copy will be built, which needs no list. */
static void list_change(int tx, int ty, void *ctx)
{
    CopyJob *job = ctx;
    Pieces u, v;
    if (++job->changed > tile_count(job->field) / 2 || wr_progress_stopped()) return;
    reached(job, tx, ty, &u, &v);
    for (int b = 0; b < v.count; b++)
        for (int a = 0; a < u.count; a++) add_parts(job, u.from[a], u.to[a], v.from[b], v.to[b]);
    job->border |= u.border || v.border;
}

static int by_tile(const void *a, const void *b)
{
    const Part *p = a, *q = b;
    return (p->tile > q->tile) - (p->tile < q->tile);
}

/* One part for each tile, so that threads can share the work: the box around those that its own change and those of its
   neighbours reach. */
static void join_parts(CopyJob *job)
{
    Part *part = job->parts.data;
    int count = 0;
    if (job->parts.count > 1) qsort(part, (size_t)job->parts.count, sizeof *part, by_tile);
    for (int i = 0; i < job->parts.count; i++) {
        if (count == 0 || part[count - 1].tile != part[i].tile) {
            part[count++] = part[i];
            continue;
        }
        WrFieldRect *box = &part[count - 1].box;
        const WrFieldRect *more = &part[i].box;
        box->i0 = more->i0 < box->i0 ? more->i0 : box->i0;
        box->i1 = more->i1 > box->i1 ? more->i1 : box->i1;
        box->j0 = more->j0 < box->j0 ? more->j0 : box->j0;
        box->j1 = more->j1 > box->j1 ? more->j1 : box->j1;
    }
    job->parts.count = count;
}

static void refresh_part(int index, int worker, void *ctx)
{
    (void)worker;
    CopyJob *job = ctx;
    const WrFieldRect *box = &job->parts.data[index].box;
    refresh(job, box->i0, box->j0, box->i1 - box->i0, box->j1 - box->j0);
}

static void mark_part(int index, int worker, void *ctx)
{
    (void)worker;
    CopyJob *job = ctx;
    const int tile = job->parts.data[index].tile, across = wr_field_tiles_u(job->field);
    mark_steep(job, tile % across, tile / across);
}

/* The whole apron: cheap beside a frame, and simpler than its parts. */
static void refresh_apron(CopyJob *job)
{
    const int w = wr_field_width(job->field), h = wr_field_height(job->field), a = WR_APRON;
    refresh(job, -a, -a, w + 2 * a, a);
    refresh(job, -a, h, w + 2 * a, a);
    refresh(job, -a, 0, a, h);
    refresh(job, w, 0, a, h);
}

/* Slope bounds of the whole table, from those of its tiles. */
static void sum_steep(WrTable *table, int count)
{
    const float(*steep)[2] = (const float(*)[2])table->steep;
    float u0 = steep[0][0], u1 = u0, v0 = steep[0][1], v1 = v0;
    int sloped = 0;
#pragma omp simd reduction(min : u0, v0) reduction(max : u1, v1) reduction(+ : sloped)
    for (int i = 0; i < count; i++) {
        const float u = steep[i][0], v = steep[i][1];
        u0 = u < u0 ? u : u0, u1 = u > u1 ? u : u1;
        v0 = v < v0 ? v : v0, v1 = v > v1 ? v : v1;
        sloped += (u > 0) | (v > 0);
    }
    table->gentlest[0] = u0, table->gentlest[1] = v0;
    table->steepest[0] = u1, table->steepest[1] = v1;
    table->sloped = sloped;
}

#define SHARED_PARTS 64 /* tiles worth several threads */

/* Computes the listed parts again. Slopes near an end of a clamped axis are bounded with the apron. */
static void refresh_parts(CopyJob *job, WrPool *pool)
{
    join_parts(job);
    if (job->parts.count < SHARED_PARTS) pool = NULL;
    wr_pool_run(pool, job->parts.count, refresh_part, job);
    if (job->border) refresh_apron(job);
    if (job->kind == WR_COPY_GRADIENT) wr_pool_run(pool, job->parts.count, mark_part, job);
}

#define MANY_TILES 4096

/* True if less than an eighth of a large table is stored. */
static bool is_sparse(const WrField *field)
{
    const size_t tile = WR_TILE * WR_TILE * sizeof(float), tiles = (size_t)tile_count(field);
    return tiles >= MANY_TILES && wr_field_bytes(field) < tiles * tile / 8;
}

/* Of whole tiles at 0, as new documents are. */
static bool may_skip(const WrField *field)
{
    return field && wr_field_level(field) == 0.0f && wr_field_width(field) % WR_TILE == 0 &&
           wr_field_height(field) % WR_TILE == 0;
}

static bool allocate(CopyJob *job, WrError *err)
{
    int w = wr_field_width(job->field), h = wr_field_height(job->field);
    int pitch = (w + 2 * WR_APRON + 15) / 16 * 16;
    if (pitch % 512 == 0) pitch += 16; /* avoids conflicts of rows in the same cache sets */
    wr_table_drop(job->table, job->kind);
    const bool single = job->table->precision == WR_PRECISION_SINGLE;
    void *data =
        wr_try_alloc((size_t)pitch * (size_t)(h + 2 * WR_APRON),
                     (size_t)kinds[job->kind].floats * (single ? sizeof(float) : sizeof(double)),
                     kinds[job->kind].what, err);
    if (!data) return false;
    job->copy->sparse = is_sparse(job->field);
    if (job->copy->sparse)
        wr_pages_small(data, (size_t)pitch * (size_t)(h + 2 * WR_APRON) *
                                 (size_t)kinds[job->kind].floats * sizeof(float));
    if (single) job->copy->data = data;
    else job->copy->fine = data;
    job->copy->precision = job->table->precision;
    job->copy->pitch = pitch;
    if (job->kind == WR_COPY_GRADIENT)
        job->table->steep = wr_alloc((size_t)tile_count(job->field), sizeof *job->table->steep);
    return true;
}

/* Updates the copy's texels; false and an error if there is no memory. With changes in more than half of the tiles a full build is
   faster. */
static bool update(CopyJob *job, WrPool *pool, WrError *err)
{
    WrTableCopy *copy = job->copy;
    const WrField *field = job->field;
    const bool same = same_layout(copy->seen, field);
    job->skips = may_skip(field) && (!copy->seen || wr_field_level(copy->seen) == 0.0f);
    if (same && job->changed <= tile_count(field) / 2) {
        refresh_parts(job, pool);
        return true;
    }
    if (!(same && (!copy->sparse || is_sparse(field)))) {
        if (!allocate(job, err)) return false;
        job->skips = may_skip(field);
    }
    wr_pool_run(pool, wr_field_tiles_v(field), build_strip, job);
    return true;
}

bool wr_table_update(WrTable *table, WrCopyKind kind, const WrField *field, WrPool *pool,
                     WrError *err)
{
    CopyJob job = { .table = table, .copy = &table->copies[kind], .kind = kind, .field = field };
    WrTableCopy *copy = job.copy;
    table->texels_refreshed = 0;
    if (copy->precision != table->precision) wr_table_drop(table, kind);
    if (same_layout(copy->seen, field)) {
        wr_field_changes(copy->seen, field, list_change, &job);
        if (job.changed == 0) return true;
    }
    const bool good = update(&job, pool, err);
    wr_array_free(&job.parts);
    if (!good) return false;
    if (wr_progress_stopped()) {
        wr_table_drop(table, kind); /* incomplete */
        return wr_fail(err, "cancelled");
    }
    if (kind == WR_COPY_GRADIENT) sum_steep(table, tile_count(field));
    wr_field_free(copy->seen);
    copy->seen = wr_field_share(field);
    return true;
}

bool wr_table_slope_free(const WrTable *table)
{
    return table->copies[WR_COPY_GRADIENT].seen && table->sloped == 0;
}
