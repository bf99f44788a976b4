/* Cutting of outlines into pieces along the borders of texels. */
#include "generate/text.h"

#include "base/error.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define UNIT ((int64_t)WR_TEXT_UNIT)
#define REACH 0x1p20
#define FAR 0x1p30

typedef struct Point {
    int64_t x, y;
} Point;

static int64_t floor_div(int64_t a, int64_t b)
{
    int64_t q = a / b;
    return q * b > a ? q - 1 : q;
}

bool wr_text_shape_init(WrTextShape *shape, const WrField *like, bool clip, WrError *err)
{
    WrTextShape s = { .width = wr_field_width(like), .height = wr_field_height(like) };
    s.wraps_u = !clip && wr_field_wrap_u(like) == WR_WRAP_PERIODIC;
    s.wraps_v = !clip && wr_field_wrap_v(like) == WR_WRAP_PERIODIC;
    s.base = wr_try_alloc((size_t)s.height, sizeof *s.base, "a text", err);
    if (!s.base) return false;
    *shape = s;
    return true;
}

void wr_text_shape_fini(WrTextShape *shape)
{
    wr_free(shape->pieces);
    wr_free(shape->base);
    *shape = (WrTextShape){ 0 };
}

/* ---- pieces ---- */

static bool grow(WrTextShape *shape, WrError *err)
{
    int64_t room = shape->room ? 2 * shape->room : 4096;
    WrTextPiece *more = wr_try_alloc((size_t)room, sizeof *more, "the outlines of a text", err);
    if (!more) return false;
    if (shape->count) memcpy(more, shape->pieces, (size_t)shape->count * sizeof *more);
    wr_free(shape->pieces);
    shape->pieces = more;
    shape->room = room;
    return true;
}

static bool fail_many(WrError *err)
{
    return wr_fail(err,
                   "the text's outlines pass through more than %lld texels: make it smaller or "
                   "shorter",
                   (long long)WR_TEXT_PIECES_MAX);
}

static bool add_piece(WrTextShape *shape, Point a, Point b, int64_t column, int64_t row,
                      WrError *err)
{
    int64_t left = column * UNIT, top = row * UNIT;
    if (++shape->steps > WR_TEXT_PIECES_MAX) return fail_many(err);
    if (shape->wraps_u) column -= floor_div(column, shape->width) * shape->width;
    if (shape->wraps_v) row -= floor_div(row, shape->height) * shape->height;
    if (column < 0 || column >= shape->width || row < 0 || row >= shape->height) return true;
    if (shape->count == shape->room && !grow(shape, err)) return false;
    shape->pieces[shape->count++] =
        (WrTextPiece){ (int32_t)(a.x - left), (int32_t)(a.y - top), (int32_t)(b.x - left),
                       (int32_t)(b.y - top),  (uint16_t)column,     (uint16_t)row };
    return true;
}

/* From a to b within a row: cut at the columns' borders, at odd y. */
static bool cut_columns(WrTextShape *shape, Point a, Point b, int64_t row, WrError *err)
{
    int64_t column = floor_div(a.x, UNIT), last = floor_div(b.x, UNIT);
    int64_t way = last > column ? 1 : -1, low = row * UNIT + 1, high = (row + 1) * UNIT - 1;
    Point from = a;
    while (column != last) {
        int64_t x = (way > 0 ? column + 1 : column) * UNIT;
        double along = (double)(b.y - a.y) * (double)(x - a.x) / (double)(b.x - a.x);
        int64_t y = (a.y + (int64_t)floor(along)) | 1;
        Point at = { x, y < low ? low : y > high ? high : y };
        if (!add_piece(shape, from, at, column, row, err)) return false;
        from = at;
        column += way;
    }
    return add_piece(shape, from, b, column, row, err);
}

/* Records a side that crosses the upper border of `row` at x. */
static void cross(WrTextShape *shape, int64_t row, int64_t x, int sign)
{
    if (shape->wraps_v) row -= floor_div(row, shape->height) * shape->height;
    if (row < 0 || row >= shape->height) return;
    /* Counts all images of the table's left border to the right of x; the same excess for each crossing
     * cancels, since an outline is closed. */
    if (shape->wraps_u) shape->base[row] -= sign * floor_div(x, shape->width * UNIT);
    else if (x < 0) shape->base[row] += sign;
}

/* From a to b: cut at the rows' borders, at odd x. */
static bool cut_rows(WrTextShape *shape, Point a, Point b, WrError *err)
{
    int64_t row = floor_div(a.y, UNIT), last = floor_div(b.y, UNIT);
    int64_t way = last > row ? 1 : -1;
    int64_t left = a.x < b.x ? a.x : b.x, right = a.x < b.x ? b.x : a.x;
    Point from = a;
    while (row != last) {
        int64_t y = (way > 0 ? row + 1 : row) * UNIT;
        double along = (double)(b.x - a.x) * (double)(y - a.y) / (double)(b.y - a.y);
        int64_t x = a.x + 2 * (int64_t)floor(0.5 * along + 0.5);
        Point at = { x < left ? left : x > right ? right : x, y };
        if (!cut_columns(shape, from, at, row, err)) return false;
        cross(shape, way > 0 ? row + 1 : row, at.x, (int)way);
        from = at;
        row += way;
    }
    return cut_columns(shape, from, b, row, err);
}

/* ---- polygons ---- */

/* A clipped outline completely above, below or beside the table is skipped. */
static bool is_off(const WrTextShape *shape, const double *xy, int count, const double move[2])
{
    double low[2] = { xy[0], xy[1] }, high[2] = { xy[0], xy[1] };
    for (int i = 1; i < count; i++)
        for (int k = 0; k < 2; k++) {
            double x = xy[2 * i + k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
        }
    return (!shape->wraps_u && (high[0] + move[0] < -1 || low[0] + move[0] > shape->width + 1)) ||
           (!shape->wraps_v && (high[1] + move[1] < -1 || low[1] + move[1] > shape->height + 1));
}

bool wr_text_shape_add(WrTextShape *shape, const double *xy, int count, const double move[2],
                       WrError *err)
{
    if (!(fabs(move[0]) <= FAR && fabs(move[1]) <= FAR))
        return wr_fail(err, "a letter stands more than %.0f texels away", FAR);
    for (int i = 0; i < 2 * count; i++)
        if (!(fabs(xy[i]) <= REACH))
            return wr_fail(err, "a letter reaches farther than %.0f texels: make it smaller",
                           REACH);
    if (count < 2 || is_off(shape, xy, count, move)) return true;
    shape->steps += count;
    if (shape->steps > WR_TEXT_PIECES_MAX) return fail_many(err);
    int64_t x = 2 * (int64_t)floor(move[0] * WR_TEXT_SUB + 0.5) + 1;
    int64_t y = 2 * (int64_t)floor(move[1] * WR_TEXT_SUB + 0.5) + 1;
    Point before = { 0, 0 }, first = { 0, 0 };
    for (int i = 0; i <= count; i++) {
        const double *p = &xy[2 * (i < count ? i : 0)];
        Point at = { x + 2 * (int64_t)floor(p[0] * WR_TEXT_SUB + 0.5),
                     y + 2 * (int64_t)floor(p[1] * WR_TEXT_SUB + 0.5) };
        if (i == 0) first = at;
        if (i == count) at = first;
        if (i > 0 && (at.x != before.x || at.y != before.y) && !cut_rows(shape, before, at, err))
            return false;
        before = at;
    }
    return true;
}

bool wr_text_shape_side(WrTextShape *shape, const double a[2], const double b[2], WrError *err)
{
    const double *ends[2] = { a, b };
    Point at[2];
    for (int k = 0; k < 2; k++) {
        if (!(fabs(ends[k][0]) <= REACH && fabs(ends[k][1]) <= REACH))
            return wr_fail(err, "an edge reaches farther than %.0f texels", REACH);
        at[k] = (Point){ 2 * (int64_t)floor(ends[k][0] * WR_TEXT_SUB + 0.5) + 1,
                         2 * (int64_t)floor(ends[k][1] * WR_TEXT_SUB + 0.5) + 1 };
    }
    return (at[0].x == at[1].x && at[0].y == at[1].y) || cut_rows(shape, at[0], at[1], err);
}
