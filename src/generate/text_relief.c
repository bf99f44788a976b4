#include "base/error.h"
#include "base/exactmath.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "generate/path.h"
#include "generate/pattern.h"
#include "generate/text_relief.h"

#include <math.h>
#include <string.h>

/* ---- layout ---- */

#define TOLERANCE (1.0 / 64.0) /* texels */

typedef struct Lay {
    const WrTextRequest *wish;
    const WrFontText *text;
    const WrGenerateJob *job;
    WrTextShape *shape;
    WrFontOutline *outlines; /* [glyph_count], created on first use */
    bool *made;              /* [glyph_count] */
    double (*place)[2];      /* [placed_count] */
    double scale;            /* texels per unit of the first font */
    double width, height;    /* of the table */
    bool on_texels;
    WR_ARRAY(double) turned;
    int64_t points; /* of all outlines */
} Lay;

/* ---- letters ---- */

static double scale_of(const Lay *lay, const WrFontPlaced *placed)
{
    return wr_font_scale(lay->text, placed, lay->wish->setting.size);
}

static bool make_outline(Lay *lay, int glyph, WrError *err)
{
    if (lay->made[glyph]) return true;
    lay->made[glyph] = true;
    double scale = lay->wish->setting.size / lay->text->glyphs[glyph].units;
    if (!wr_font_glyph_outline(lay->text, glyph, scale, 0.0, 0.0, TOLERANCE, &lay->outlines[glyph],
                               err))
        return false;
    lay->points += lay->outlines[glyph].xy.count / 2;
    if (lay->points <= WR_FONT_FLAT_MAX) return true;
    return wr_fail(err, "the letters' outlines have more than %d points: make them smaller",
                   WR_FONT_FLAT_MAX);
}

/* Adds one letter with its pen at (x, y) from the stand, y up along its normal. */
static bool draw(Lay *lay, int32_t placed, const WrStand *stand, double x, double y, WrError *err)
{
    int glyph = lay->text->placed[placed].glyph;
    if (wr_progress_cancelled(lay->job->progress)) return wr_fail(err, "cancelled");
    if (!make_outline(lay, glyph, err)) return false;
    const WrFontOutline *outline = &lay->outlines[glyph];
    int count = outline->xy.count / 2;
    double c = stand->cosine, s = stand->sine;
    double move[2] = { stand->x + (c * x - s * y), stand->y - (s * x + c * y) };
    lay->turned.count = 0;
    wr_array_reserve(&lay->turned, 2 * count + 2);
    for (int i = 0; i < count; i++) {
        double px = outline->xy.data[2 * i], py = outline->xy.data[2 * i + 1];
        lay->turned.data[2 * i] = c * px - s * py;
        lay->turned.data[2 * i + 1] = -(s * px + c * py);
    }
    for (int k = 0; k < outline->first.count; k++) {
        int first = outline->first.data[k];
        int end = k + 1 < outline->first.count ? outline->first.data[k + 1] : count;
        if (!wr_text_shape_add(lay->shape, lay->turned.data + 2 * (ptrdiff_t)first, end - first,
                               move, err))
            return false;
    }
    return true;
}

/* ---- lines ---- */

/* Height of the first baseline above the anchor. */
static double rise(const Lay *lay)
{
    const WrFontText *text = lay->text;
    double top = text->ascent * lay->scale;
    double bottom = -(text->descent + (double)(text->line_count - 1) * text->line *
                                          lay->wish->setting.line_spacing) *
                    lay->scale;
    switch (lay->wish->anchor) {
    case WR_TEXT_BASELINE: return 0.0;
    case WR_TEXT_TOP: return -top;
    case WR_TEXT_BOTTOM: return -bottom;
    case WR_TEXT_MIDDLE: break;
    }
    return -0.5 * (top + bottom);
}

static double nearest_copy(const Lay *lay, double x)
{
    return lay->on_texels ? floor(x + 0.5) : x;
}

static bool lay_lines(Lay *lay, WrError *err)
{
    const WrTextRequest *wish = lay->wish;
    WrStand stand = { nearest_copy(lay, wish->at[0] * lay->width),
                      nearest_copy(lay, (1.0 - wish->at[1]) * lay->height), 1.0, 0.0 };
    double up = rise(lay);
    wr_sincos_turns(wish->rotate_deg / 360.0, &stand.sine, &stand.cosine);
    for (int32_t i = 0; i < lay->text->placed_count; i++)
        if (!draw(lay, i, &stand, nearest_copy(lay, lay->place[i][0]),
                  nearest_copy(lay, lay->place[i][1] + up), err))
            return false;
    return true;
}

/* Each letter is perpendicular to the path at its middle. */
static bool lay_path(Lay *lay, WrError *err)
{
    WrPath path = { 0 };
    double part = lay->wish->setting.align == WR_FONT_CENTRE  ? 0.5
                  : lay->wish->setting.align == WR_FONT_RIGHT ? 1.0
                                                              : 0.0;
    bool good = wr_path_make(&path, lay->wish->points, lay->wish->point_count, false, lay->width,
                             lay->height, err);
    double from = good ? part * wr_path_length(&path) : 0.0, up = rise(lay);
    for (int32_t i = 0; i < lay->text->placed_count && good; i++) {
        const WrFontPlaced *p = &lay->text->placed[i];
        double scale = scale_of(lay, p), half = 0.5 * p->advance * scale, own = p->dx * scale;
        WrStand stand = wr_path_at(&path, from + lay->place[i][0] - own + half);
        good = draw(lay, i, &stand, own - half, lay->place[i][1] + up, err);
    }
    wr_path_fini(&path);
    return good;
}

/* ---- around the table ---- */

/* One line, repeated so often that the spacing changes least, and spaced so that it closes. */
static bool lay_round(Lay *lay, int32_t index, const WrStand *stand, double length, double up,
                      WrError *err)
{
    const WrFontText *text = lay->text;
    const WrFontLine *line = &text->lines[index];
    double width = 0.0, spacing = lay->wish->setting.letter_spacing;
    int gaps = 0;
    for (int32_t i = line->first; i < line->first + line->count; i++) {
        const WrFontPlaced *p = &text->placed[i];
        width += p->advance * scale_of(lay, p) + (p->spaced ? spacing : 0.0);
        gaps += p->spaced;
    }
    if (gaps == 0) return true;
    double fit = width > 0.0 ? floor(length / width + 0.5) : 1.0;
    int repeats = lay->wish->repeats > 0 ? lay->wish->repeats
                  : fit < 1.0            ? 1
                  : fit > 4096.0         ? 4096
                                         : (int)fit;
    /* The rest of the circumference is shared by all gaps: letters keep their shapes, and the text closes exactly. */
    double more = (length / repeats - width) / gaps;
    wr_generate_note(lay->job, "around: %d time%s, letter spacing %+.3g texels", repeats,
                     repeats == 1 ? "" : "s", more);
    for (int r = 0; r < repeats; r++) {
        double x = length * r / repeats;
        for (int32_t i = line->first; i < line->first + line->count; i++) {
            const WrFontPlaced *p = &text->placed[i];
            if (!draw(lay, i, stand, x + p->dx * scale_of(lay, p), lay->place[i][1] + up, err))
                return false;
            x += p->advance * scale_of(lay, p) + (p->spaced ? spacing + more : 0.0);
        }
    }
    return true;
}

static bool lay_around(Lay *lay, WrError *err)
{
    const WrTextRequest *wish = lay->wish;
    double i = wish->lattice[0], j = wish->lattice[1];
    if (i != floor(i) || j != floor(j) || (i == 0.0 && j == 0.0))
        return wr_fail(err, "lattice=%g,%g: must be whole numbers, not both 0", i, j);
    if ((i != 0.0 && !lay->shape->wraps_u) || (j != 0.0 && !lay->shape->wraps_v))
        return wr_fail(err, "around: the table must be periodic in %s, and edge=wrap",
                       i != 0.0 && !lay->shape->wraps_u ? "u" : "v");
    double dx = i * lay->width, dy = j * lay->height, length = sqrt(dx * dx + dy * dy);
    WrStand stand = { wish->at[0] * lay->width, (1.0 - wish->at[1]) * lay->height, dx / length,
                      dy / length };
    double up = rise(lay);
    for (int32_t line = 0; line < lay->text->line_count; line++)
        if (!lay_round(lay, line, &stand, length, up, err)) return false;
    return true;
}

/* ---- all ---- */

/* True if all dots cover whole texels, without rotation: then letters must be at whole texels. */
static bool is_on_texels(const Lay *lay)
{
    double turns = lay->wish->rotate_deg / 90.0;
    return lay->text->bitmap && lay->scale == floor(lay->scale) && turns == floor(turns) &&
           lay->wish->point_count == 0 && !lay->wish->around;
}

bool wr_text_lay(const WrTextRequest *wish, const WrFontText *text, const WrGenerateJob *job,
                 WrTextShape *shape, WrError *err)
{
    size_t glyphs = (size_t)text->glyph_count;
    Lay lay = { .wish = wish,
                .text = text,
                .job = job,
                .shape = shape,
                .scale = wish->setting.size / text->units,
                .width = shape->width,
                .height = shape->height };
    lay.on_texels = is_on_texels(&lay);
    lay.outlines = wr_alloc(glyphs + 1, sizeof *lay.outlines);
    lay.made = wr_alloc(glyphs + 1, sizeof *lay.made);
    lay.place = wr_try_alloc((size_t)text->placed_count + 1, sizeof *lay.place, "a text", err);
    bool good = lay.place != NULL;
    if (good) {
        wr_font_place(text, &wish->setting, lay.place);
        good = wish->around            ? lay_around(&lay, err)
               : wish->point_count > 0 ? lay_path(&lay, err)
                                       : lay_lines(&lay, err);
    }
    for (size_t i = 0; i < glyphs; i++) wr_font_outline_fini(&lay.outlines[i]);
    wr_free(lay.outlines);
    wr_free(lay.made);
    wr_free(lay.place);
    wr_array_free(&lay.turned);
    return good;
}

/* ---- relief ---- */

/* A profile over the distance from the rim. */

/* ---- Cutting of outlines into pieces along the borders of texels ---- */

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

/* Coordinates are integers of 1/UNIT texel, relative to the texel. All corners of outlines are odd multiples, all borders of
   texels even ones: no corner lies on a border, and no rule for ties is needed. */
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

/* Records a side that crosses the upper border of `row` at x. base[row] is the winding number at the left border of the table
   at the upper border of the row; make_row adds the crossings of pieces from there to the right. */
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
        return wr_fail(err, "a letter is more than %.0f texels away", FAR);
    for (int i = 0; i < 2 * count; i++)
        if (!(fabs(xy[i]) <= REACH))
            return wr_fail(err, "a letter extends beyond %.0f texels: make it smaller", REACH);
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
            return wr_fail(err, "an edge extends beyond %.0f texels", REACH);
        at[k] = (Point){ 2 * (int64_t)floor(ends[k][0] * WR_TEXT_SUB + 0.5) + 1,
                         2 * (int64_t)floor(ends[k][1] * WR_TEXT_SUB + 0.5) + 1 };
    }
    return (at[0].x == at[1].x && at[0].y == at[1].y) || cut_rows(shape, at[0], at[1], err);
}

/* ---- From pieces to the coverage of each texel, row by row, and to the rim ---- */

#define ROWS WR_TILE
#define BATCH 16 /* strips of ROWS rows between reports */

typedef struct Work {
    const WrTextShape *shape;
    WrTextPiece *sorted;  /* by row; each row is sorted by column when it is processed */
    const int64_t *first; /* [height + 1] start of each row */
    const WrProgress *progress;
    WrTextInside *out;
    int strip;    /* first of the batch */
    float *cover; /* [BATCH][ROWS][width] */
} Work;

/* ---- sorting ---- */

static int compare(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

/* Orders by column, then by content: an order independent of the table's origin. */
static int compare_pieces(const void *a, const void *b)
{
    const WrTextPiece *p = a, *q = b;
    if (p->i != q->i) return p->i < q->i ? -1 : 1;
    if (p->y0 != q->y0) return compare(p->y0, q->y0);
    if (p->x0 != q->x0) return compare(p->x0, q->x0);
    if (p->y1 != q->y1) return compare(p->y1, q->y1);
    return compare(p->x1, q->x1);
}

/* Sorts the shape's pieces by row; *first receives the start of each row. */
static bool sort_rows(WrTextShape *shape, int64_t **first, WrError *err)
{
    size_t height = (size_t)shape->height, count = (size_t)shape->count;
    WrTextPiece *sorted = wr_try_alloc(count + 1, sizeof *sorted, "the outlines of a text", err);
    int64_t *at = sorted ? wr_try_alloc(height + 2, sizeof *at, "the rows of a text", err) : NULL;
    if (!at) {
        wr_free(sorted);
        return false;
    }
    for (size_t k = 0; k < count; k++) at[shape->pieces[k].j + 2]++;
    for (size_t j = 2; j < height + 2; j++) at[j] += at[j - 1];
    for (size_t k = 0; k < count; k++) sorted[at[shape->pieces[k].j + 1]++] = shape->pieces[k];
    wr_free(shape->pieces);
    shape->pieces = sorted;
    shape->room = (int64_t)count + 1;
    *first = at;
    return true;
}

/* ---- rows ---- */

static void fill(float *row, int from, int to, int64_t w)
{
    for (int i = from; i < to && w != 0; i++) row[i] = 1.0f;
}

static void make_row(const Work *work, int j, float *row, struct WrTextRim *rim)
{
    WrTextPiece *p = work->sorted + work->first[j];
    int64_t count = work->first[j + 1] - work->first[j], w = work->shape->base[j];
    int from = 0;
    if (count > 1) qsort(p, (size_t)count, sizeof *p, compare_pieces);
    for (int64_t k = 0; k < count;) {
        /* Pieces of one texel are adjacent after sorting. Between two texels with pieces the winding number w is constant:
           these texels are entirely inside (w != 0, the nonzero rule) or outside. */
        int64_t end = k, crossing = 0;
        for (; end < count && p[end].i == p[k].i; end++)
            crossing += (p[end].y0 == 0) - (p[end].y1 == 0);
        bool centre;
        int many = end - k < 1 << 30 ? (int)(end - k) : 1 << 30;
        fill(row, from, p[k].i, w);
        double part = wr_text_texel(p + k, many, w, &centre, rim);
        /* The sign holds whether the centre is inside: coverage alone cannot decide the sign of the distance. */
        row[p[k].i] = (float)(centre ? part : -part);
        from = p[k].i + 1;
        w += crossing;
        k = end;
    }
    fill(row, from, work->shape->width, w);
}

static void make_strip(int index, int worker, void *ctx)
{
    (void)worker;
    Work *work = ctx;
    int strip = work->strip + index, width = work->shape->width;
    struct WrTextRim *rim = &work->out->rims[strip];
    float *cover = work->cover + (size_t)index * ROWS * (size_t)width;
    if (wr_progress_cancelled(work->progress)) return;
    memset(cover, 0, (size_t)ROWS * (size_t)width * sizeof *cover);
    for (int y = 0; y < ROWS; y++) {
        rim->first[y] = rim->pieces.count;
        int j = strip * ROWS + y;
        if (j < work->shape->height) make_row(work, j, cover + (size_t)y * (size_t)width, rim);
    }
    rim->first[ROWS] = rim->pieces.count;
}

/* Empty tiles allocate no memory. */
static void keep_strip(const Work *work, int index)
{
    int width = work->shape->width, strip = work->strip + index;
    const float *cover = work->cover + (size_t)index * ROWS * (size_t)width;
    for (int i = 0; i < width; i += WR_TILE) {
        size_t columns = (size_t)(width - i < WR_TILE ? width - i : WR_TILE);
        float *tile = NULL;
        for (int y = 0; y < ROWS; y++) {
            const float *row = cover + (size_t)y * (size_t)width + i;
            for (size_t x = 0; x < columns && !tile; x++)
                if (row[x] != 0.0f)
                    tile = wr_field_tile_write(work->out->cover, i / WR_TILE, strip);
            if (tile) memcpy(tile + y * WR_TILE, row, columns * sizeof *row);
        }
    }
}

static bool run(Work *work, const WrGenerateJob *job, double from, double to)
{
    int strips = (work->shape->height + ROWS - 1) / ROWS;
    for (work->strip = 0; work->strip < strips; work->strip += BATCH) {
        int count = strips - work->strip < BATCH ? strips - work->strip : BATCH;
        if (!wr_progress_step(job->progress, from + (to - from) * work->strip / strips))
            return false;
        wr_pool_run(job->pool, count, make_strip, work);
        if (wr_progress_cancelled(job->progress)) return false;
        for (int k = 0; k < count; k++) keep_strip(work, k);
    }
    return true;
}

void wr_text_inside_fini(WrTextInside *inside, int height)
{
    for (int s = 0; inside->rims && s < (height + ROWS - 1) / ROWS; s++)
        wr_array_free(&inside->rims[s].pieces);
    wr_free(inside->rims);
    wr_field_free(inside->cover);
    *inside = (WrTextInside){ NULL, NULL };
}

/* Sorts the shape's pieces. */
static bool text_inside(WrTextShape *shape, const WrGenerateJob *job, double from, double to,
                        WrTextInside *out, WrError *err)
{
    WrTextInside inside = { NULL, NULL };
    int64_t *first = NULL;
    Work work = { .shape = shape, .progress = job->progress, .out = &inside };
    size_t strips = (size_t)((shape->height + ROWS - 1) / ROWS), width = (size_t)shape->width;
    size_t batch = strips < BATCH ? strips : BATCH;
    inside.rims = wr_try_alloc(strips, sizeof *inside.rims, "the rim of a text", err);
    bool good = inside.rims && sort_rows(shape, &first, err);
    if (good) {
        inside.cover = wr_field_new(shape->width, shape->height, wr_field_wrap_u(job->like),
                                    wr_field_wrap_v(job->like), 0.0f, err);
        work.cover = wr_try_alloc(batch * ROWS, width * sizeof *work.cover, "a text", err);
        good = inside.cover && work.cover;
    }
    work.sorted = shape->pieces;
    work.first = first;
    if (good && !run(&work, job, from, to)) good = wr_fail(err, "cancelled");
    wr_free(first);
    wr_free(work.cover);
    if (good) *out = inside;
    else wr_text_inside_fini(&inside, shape->height);
    return good;
}

/* ---- text near ---- */

/* Distances of texels from the rim. A tile is recursively quartered; each quarter keeps the pieces that
 * can be the nearest of any of its texels, judged by the pieces' centres, which lie within HALF of
 * every point of a piece, since a piece does not leave its texel. Centres are compared in float with a
 * tolerance SLACK; the distances themselves are computed in double from the pieces' integers, so that
 * only the pieces determine them. */

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

/* ---- text texel ---- */

/* Coverage of one texel by outlines. The texel is divided into bands wherever a piece begins or ends or
 * two cross; within a band no two cross, so that between neighbours there are trapezoids. The winding
 * number left of the texel changes at its left border: where a side enters to the right it is one less
 * from there down, and one more where a side leaves. */

#define UNIT_REAL ((double)WR_TEXT_UNIT)
#define RIM_MAX (1 << 22)        /* pieces of a strip's rim; far more than in real fonts */
#define MANY 48                  /* pieces; for more, only the winding numbers' areas are summed */
#define EVENTS (2 * MANY + 2048) /* crossings beyond these are ignored */
#define LEAST 1.0                /* units: shorter horizontal rims are ignored */

typedef struct Strand {
    double x0, y0, x1, y1; /* y0 < y1 */
    int sign;              /* +1 where it runs downwards */
    bool border;           /* represents the part left of the texel */
    double from, to;       /* y: the part found to be rim but not output yet; from > to: none */
} Strand;

typedef struct Mark {
    double top, bottom; /* x at the band's upper and lower end */
    int sign;
    bool border;
    int strand; /* index; -1: the texel's border */
} Mark;

typedef struct Span {
    double left, right;
} Span;

typedef struct Texel {
    Strand strands[2 * MANY];
    int strand_count;
    double events[EVENTS];
    int event_count;
    Mark marks[2 * MANY + 1];
    Span ended[MANY + 1]; /* spans of the band above, at its lower end */
    int ended_count;
    int64_t w;
    double area; /* units^2 */
    bool centre;
    const WrTextPiece *cell;
    struct WrTextRim *rim;
} Texel;

static int32_t whole(double x)
{
    return (int32_t)floor(x + 0.5);
}

static void add_rim(Texel *t, double x0, double y0, double x1, double y1)
{
    if (t->rim->pieces.count >= RIM_MAX) return;
    WrTextPiece piece = { whole(x0), whole(y0), whole(x1), whole(y1), t->cell->i, t->cell->j };
    wr_array_push(&t->rim->pieces, piece);
}

/* ---- strands and events ---- */

static void add_strand(Texel *t, double x0, double y0, double x1, double y1, int sign, bool border)
{
    if (y0 == y1) return;
    t->strands[t->strand_count++] = y0 < y1 ? (Strand){ x0, y0, x1, y1, sign, border, 1.0, 0.0 }
                                            : (Strand){ x1, y1, x0, y0, -sign, border, 1.0, 0.0 };
}

static void add_event(Texel *t, double y)
{
    if (y > 0.0 && y < UNIT_REAL && t->event_count < EVENTS) t->events[t->event_count++] = y;
}

static void add_crossings(Texel *t, const WrTextPiece *p)
{
    add_strand(t, p->x0, p->y0, p->x1, p->y1, 1, false);
    if (p->x0 == 0) add_strand(t, 0.0, p->y0, 0.0, UNIT_REAL, -1, true);
    if (p->x1 == 0) add_strand(t, 0.0, p->y1, 0.0, UNIT_REAL, 1, true);
    add_event(t, p->y0);
    add_event(t, p->y1);
}

static double x_at(const Strand *s, double y)
{
    if (y <= s->y0) return s->x0;
    if (y >= s->y1) return s->x1;
    return s->x0 + (s->x1 - s->x0) * ((y - s->y0) / (s->y1 - s->y0));
}

/* The crossing of two strands, within their common range. */
static void add_crossing(Texel *t, const Strand *a, const Strand *b)
{
    double top = a->y0 > b->y0 ? a->y0 : b->y0, bottom = a->y1 < b->y1 ? a->y1 : b->y1;
    if (!(top < bottom)) return;
    double above = x_at(a, top) - x_at(b, top), below = x_at(a, bottom) - x_at(b, bottom);
    if (!((above < 0.0 && below > 0.0) || (above > 0.0 && below < 0.0))) return;
    add_event(t, top + (bottom - top) * (above / (above - below)));
}

static void sort_events(Texel *t)
{
    double *e = t->events;
    int kept = 0;
    for (int i = 1; i < t->event_count; i++) {
        double x = e[i];
        int k = i;
        for (; k > 0 && e[k - 1] > x; k--) e[k] = e[k - 1];
        e[k] = x;
    }
    for (int i = 0; i < t->event_count; i++)
        if (kept == 0 || e[i] > e[kept - 1]) e[kept++] = e[i];
    t->event_count = kept;
}

/* ---- bands ---- */

static bool comes_first(const Mark *a, const Mark *b)
{
    double left = a->top + a->bottom, right = b->top + b->bottom;
    if (left != right) return left < right;
    if (a->border != b->border) return a->border;
    if (a->top != b->top) return a->top < b->top;
    return a->sign < b->sign;
}

static int find_marks(Texel *t, double top, double bottom)
{
    int count = 0;
    for (int i = 0; i < t->strand_count; i++) {
        const Strand *s = &t->strands[i];
        if (s->y0 > top || s->y1 < bottom) continue;
        Mark mark = { x_at(s, top), x_at(s, bottom), s->sign, s->border, i };
        int k = count++;
        for (; k > 0 && comes_first(&mark, &t->marks[k - 1]); k--) t->marks[k] = t->marks[k - 1];
        t->marks[k] = mark;
    }
    return count;
}

static void add_level(Texel *t, double left, double right, double y)
{
    if (right - left > LEAST) add_rim(t, left, y, right, y);
}

/* Where one of two bands that meet at y is inside and the other is not, the rim is horizontal. */
static void compare_bands(Texel *t, const Span *next, int count, double y)
{
    int a = 0, b = 0;
    double from = 0.0;
    bool in_a = false, in_b = false;
    while (a < 2 * t->ended_count || b < 2 * count) {
        double at_a = a < 2 * t->ended_count
                          ? (a & 1 ? t->ended[a / 2].right : t->ended[a / 2].left)
                          : 2.0 * UNIT_REAL;
        double at_b =
            b < 2 * count ? (b & 1 ? next[b / 2].right : next[b / 2].left) : 2.0 * UNIT_REAL;
        double to = at_a < at_b ? at_a : at_b;
        if (in_a != in_b) add_level(t, from, to, y);
        if (at_a <= at_b) in_a = !in_a, a++;
        else in_b = !in_b, b++;
        from = to;
    }
}

static void put_rim(Texel *t, Strand *s)
{
    if (s->from < s->to) add_rim(t, x_at(s, s->from), s->from, x_at(s, s->to), s->to);
    s->from = 1.0;
    s->to = 0.0;
}

/* Usually a strand stays rim from band to band, and its part is extended. */
static void extend_rim(Texel *t, Strand *s, double top, double bottom)
{
    if (!(s->from < s->to && s->to == top)) {
        put_rim(t, s);
        s->from = top;
    }
    s->to = bottom;
}

static void band(Texel *t, double top, double bottom)
{
    Span begun[MANY + 1], ended[MANY + 1];
    int spans = 0, count = find_marks(t, top, bottom);
    double high = bottom - top, half = 0.5 * UNIT_REAL;
    int64_t w = t->w;
    bool has_centre = top <= half && half < bottom, centre = false;
    Mark open = { 0.0, 0.0, 0, true, -1 };
    for (int i = 0; i <= count; i++) {
        const Mark end = { UNIT_REAL, UNIT_REAL, 0, true, -1 },
                   *m = i < count ? &t->marks[i] : &end;
        int64_t before = w;
        w += m->sign;
        if (before == 0 && w != 0) open = *m;
        if (before == 0 || (w != 0 && i < count)) continue;
        double at = (half - top) / high;
        double left = open.top + (open.bottom - open.top) * at;
        if (has_centre && left <= half && m->top + (m->bottom - m->top) * at > half) centre = true;
        t->area += 0.5 * high * (m->top + m->bottom - open.top - open.bottom);
        if (!open.border) extend_rim(t, &t->strands[open.strand], top, bottom);
        if (!m->border) extend_rim(t, &t->strands[m->strand], top, bottom);
        if (spans <= MANY) {
            begun[spans] = (Span){ open.top, m->top };
            ended[spans++] = (Span){ open.bottom, m->bottom };
        }
    }
    if (has_centre) t->centre = centre;
    if (top > 0.0) compare_bands(t, begun, spans, top);
    memcpy(t->ended, ended, (size_t)spans * sizeof *ended);
    t->ended_count = spans;
}

/* ---- the texel ---- */

/* For too many pieces: the winding number's mean, which is exact wherever it is 0 or 1. */
static double mean_winding(const WrTextPiece *pieces, int n, int64_t w)
{
    double sum = (double)w;
    for (int i = 0; i < n; i++) {
        const WrTextPiece *p = &pieces[i];
        double high = ((double)p->y1 - p->y0) / UNIT_REAL;
        sum += high * (1.0 - 0.5 * ((double)p->x0 + p->x1) / UNIT_REAL);
        if (p->x0 == 0) sum -= 1.0 - p->y0 / UNIT_REAL;
        if (p->x1 == 0) sum += 1.0 - p->y1 / UNIT_REAL;
    }
    sum = fabs(sum);
    return sum < 1.0 ? sum : 1.0;
}

double wr_text_texel(const WrTextPiece *pieces, int n, int64_t w, bool *centre_inside,
                     struct WrTextRim *rim)
{
    if (n > MANY) {
        double part = mean_winding(pieces, n, w);
        for (int i = 0; i < n && rim->pieces.count < RIM_MAX; i++)
            wr_array_push(&rim->pieces, pieces[i]);
        *centre_inside = part >= 0.5;
        return part;
    }
    Texel t;
    t.strand_count = t.event_count = t.ended_count = 0;
    t.w = w;
    t.area = 0.0;
    t.centre = false;
    t.cell = pieces;
    t.rim = rim;
    for (int i = 0; i < n; i++) add_crossings(&t, &pieces[i]);
    for (int i = 0; i < t.strand_count; i++)
        for (int k = 0; k < i; k++)
            if (!t.strands[i].border && !t.strands[k].border)
                add_crossing(&t, &t.strands[i], &t.strands[k]);
    sort_events(&t);
    double top = 0.0;
    for (int i = 0; i <= t.event_count; i++) {
        double bottom = i < t.event_count ? t.events[i] : UNIT_REAL;
        band(&t, top, bottom);
        top = bottom;
    }
    for (int i = 0; i < t.strand_count; i++) put_rim(&t, &t.strands[i]);
    *centre_inside = t.centre;
    double part = t.area / (UNIT_REAL * UNIT_REAL);
    return part < 0x1p-14 ? 0.0 : part > 1.0 - 0x1p-14 ? 1.0 : part;
}

typedef struct Relief {
    const WrTextShape *shape;
    const WrTextInside *inside;
    const WrTextFinish *finish;
    double reach;
    WrTextNear *near; /* [threads] */
} Relief;

/* The integral of a linear slope from the rim to d, in units of height times texels. */
static double roof_area(double bevel, double d)
{
    return d > 0.0 ? 0.5 * d * d / bevel : 0.0;
}

/* The profile at d texels inside the rim, averaged over one texel across it, as a fraction of the
 * height. */
static double profile(const WrTextFinish *f, double d)
{
    WrEdge edge = { f->bevel, f->profile == WR_TEXT_ROUND ? WR_PROFILE_ROUND : WR_PROFILE_CHAMFER };
    if (f->profile == WR_TEXT_RIDGE)
        return roof_area(f->bevel, d + 0.5) - roof_area(f->bevel, d - 0.5);
    return wr_edge_height(&edge, d);
}

/* On a partly covered texel, the profile's mean applies only to the covered part. */
float wr_text_height(const WrTextFinish *f, double cover, bool centre, double distance)
{
    double height = f->profile == WR_TEXT_ENGRAVED ? -f->height : f->height;
    if (f->profile == WR_TEXT_FLAT || f->bevel == 0.0) return (float)height;
    double d = centre ? distance : -distance, mean = profile(f, d);
    if (cover < 1.0) {
        double most = profile(f, fabs(d) + 0.5);
        mean = mean / cover < most ? mean / cover : most;
    }
    return (float)(height * mean);
}

static bool needs_distance(const WrTextFinish *f)
{
    return f->profile != WR_TEXT_FLAT && f->bevel > 0.0;
}

static void fill_block(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                       float *cover)
{
    const Relief *r = ctx;
    float distance[WR_TILE * WR_TILE];
    bool want[WR_TILE * WR_TILE];
    const float *tile = wr_field_tile(r->inside->cover, b->i / WR_TILE, b->j / WR_TILE);
    if (!tile) return;
    memset(want, 0, sizeof want);
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++) want[y * WR_TILE + x] = tile[y * WR_TILE + x] != 0.0f;
    if (needs_distance(r->finish))
        wr_text_distances(r->shape, r->inside, b, r->reach, want, &r->near[worker], distance);
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++) {
            int k = y * WR_TILE + x;
            if (!want[k]) continue;
            double part = fabs((double)tile[k]);
            double d = needs_distance(r->finish) ? (double)distance[k] : 0.0;
            heights[k] = wr_text_height(r->finish, part, tile[k] > 0.0f, d);
            cover[k] = (float)part;
        }
}

bool wr_text_relief(WrTextShape *shape, const WrTextFinish *finish, const WrGenerateJob *job,
                    WrRelief *out, WrError *err)
{
    WrTextInside inside = { NULL, NULL };
    if (!text_inside(shape, job, 0.1, 0.5, &inside, err)) return false;
    int threads = wr_pool_threads(job->pool);
    double across = (double)shape->width + shape->height;
    Relief relief = { .shape = shape,
                      .inside = &inside,
                      .finish = finish,
                      .reach = finish->profile == WR_TEXT_RIDGE || finish->bevel + 1.0 > across
                                   ? across
                                   : finish->bevel + 1.0 };
    relief.near = wr_alloc((size_t)threads, sizeof *relief.near);
    bool good = wr_generate_build(job, fill_block, &relief, true, 0.5, out, err);
    for (int t = 0; t < threads; t++) wr_text_near_fini(&relief.near[t]);
    wr_free(relief.near);
    wr_text_inside_fini(&inside, shape->height);
    return good;
}
