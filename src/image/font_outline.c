/* Conversion of glyphs to polygons: curves are flattened, bitmap dots traced, letters placed. Only + -
   * / sqrt, in a fixed order. */
#include "image/font_internal.h"

#include "base/error.h"

#include <math.h>
#include <string.h>

#define CHORDS_MAX 1024 /* of one curve */

typedef struct Pen {
    WrFontOutline *out;
    double scale, x, y, tolerance;
    double at_x, at_y; /* end of the last line */
} Pen;

void wr_font_outline_fini(WrFontOutline *outline)
{
    wr_array_free(&outline->xy);
    wr_array_free(&outline->first);
}

/* ---- curves ---- */

static void begin(Pen *pen, double x, double y)
{
    wr_array_push(&pen->out->first, pen->out->xy.count / 2);
    wr_array_push(&pen->out->xy, x);
    wr_array_push(&pen->out->xy, y);
    pen->at_x = x;
    pen->at_y = y;
}

static void line(Pen *pen, double x, double y)
{
    wr_array_push(&pen->out->xy, x);
    wr_array_push(&pen->out->xy, y);
    pen->at_x = x;
    pen->at_y = y;
}

/* Number of chords within the tolerance: a curve whose second derivative is at most `bend` deviates
 * from a chord over 1/n of it by up to bend/(8 n^2). */
static int chords(const Pen *pen, double bend)
{
    double n = ceil(sqrt(bend / (8.0 * pen->tolerance)));
    return n < 1.0 ? 1 : n > CHORDS_MAX ? CHORDS_MAX : (int)n;
}

/*     B(t) = (1 - t)^2 a + 2 t (1 - t) b + t^2 c,   B'' = 2 (a - 2 b + c), constant
   Evaluated by de Casteljau's scheme with t = i / n anew for each point: repeated addition of differences would accumulate
   rounding, and the outlines must be the same bits on all machines. */
static void conic(Pen *pen, double bx, double by, double cx, double cy)
{
    double ax = pen->at_x, ay = pen->at_y;
    double ddx = 2.0 * (ax - 2.0 * bx + cx), ddy = 2.0 * (ay - 2.0 * by + cy);
    int n = chords(pen, sqrt(ddx * ddx + ddy * ddy));
    for (int i = 1; i < n; i++) {
        double t = (double)i / n, s = 1.0 - t;
        line(pen, s * (s * ax + t * bx) + t * (s * bx + t * cx),
             s * (s * ay + t * by) + t * (s * by + t * cy));
    }
    line(pen, cx, cy);
}

/* B'' is linear in t, from 6 (a - 2 b + c) to 6 (b - 2 c + d); its length is therefore largest at one of the ends. */
static void cubic(Pen *pen, double bx, double by, double cx, double cy, double dx, double dy)
{
    double ax = pen->at_x, ay = pen->at_y;
    double ux = 6.0 * (ax - 2.0 * bx + cx), uy = 6.0 * (ay - 2.0 * by + cy);
    double vx = 6.0 * (bx - 2.0 * cx + dx), vy = 6.0 * (by - 2.0 * cy + dy);
    double u = ux * ux + uy * uy, v = vx * vx + vy * vy;
    int n = chords(pen, sqrt(u > v ? u : v));
    for (int i = 1; i < n; i++) {
        double t = (double)i / n, s = 1.0 - t;
        double px = s * (s * ax + t * bx) + t * (s * bx + t * cx);
        double py = s * (s * ay + t * by) + t * (s * by + t * cy);
        double qx = s * (s * bx + t * cx) + t * (s * cx + t * dx);
        double qy = s * (s * by + t * cy) + t * (s * cy + t * dy);
        line(pen, s * px + t * qx, s * py + t * qy);
    }
    line(pen, dx, dy);
}

/* Points of the font are stored in half units (hence 0.5), so that the implied middle between two control points of TrueType
   is exact. */
/* Stops beyond WR_FONT_FLAT_MAX points. */
static void draw_verbs(Pen *pen, const WrFontText *text, const WrFontGlyph *g)
{
    static const int takes[] = { 1, 1, 2, 3 };
    const WrFontPoint *p = text->points + g->first_point;
    for (int32_t i = 0; i < g->verb_count && pen->out->xy.count / 2 <= WR_FONT_FLAT_MAX; i++) {
        WrFontVerb verb = (WrFontVerb)text->verbs[g->first_verb + i];
        double x[3], y[3];
        for (int k = 0; k < takes[verb]; k++) {
            x[k] = pen->x + p[k].x * (0.5 * pen->scale);
            y[k] = pen->y + p[k].y * (0.5 * pen->scale);
        }
        if (verb == WR_FONT_MOVE) begin(pen, x[0], y[0]);
        else if (verb == WR_FONT_LINE) line(pen, x[0], y[0]);
        else if (verb == WR_FONT_CONIC) conic(pen, x[0], y[0], x[1], y[1]);
        else cubic(pen, x[0], y[0], x[1], y[1], x[2], y[2]);
        p += takes[verb];
    }
}

/* ---- dots ---- */

/* Rows from the top, each padded to whole bytes, the highest bit leftmost, as in BDF and PCF files. */
bool wr_font_dot(const WrFontText *text, const WrFontGlyph *glyph, int column, int row)
{
    if (column < 0 || row < 0 || column >= glyph->width || row >= glyph->height) return false;
    int pitch = (glyph->width + 7) / 8;
    return text->bytes[glyph->first_byte + row * pitch + column / 8] & (0x80 >> (column & 7));
}

/* Directions along the grid, y up, each turned left from the one before. */
typedef enum Way { EAST, NORTH, WEST, SOUTH } Way;

typedef struct Trace {
    const WrFontText *text;
    const WrFontGlyph *glyph;
    uint8_t *done; /* [(height + 1) * width] upper sides of set dots already traced (going west) */
} Trace;

/* The dot to the left or right of a step that starts at the corner (x, row) in direction `way`; row r
 * lies below the line r. */
static bool side_dot(const Trace *t, int x, int row, Way way, bool left)
{
    static const int left_x[] = { 0, -1, -1, 0 }, left_row[] = { -1, -1, 0, 0 };
    static const int right_x[] = { 0, 0, -1, -1 }, right_row[] = { 0, -1, -1, 0 };
    int dx = left ? left_x[way] : right_x[way], dr = left ? left_row[way] : right_row[way];
    return wr_font_dot(t->text, t->glyph, x + dx, row + dr);
}

/* Traces round dots with the set ones on the left. At corners where two set dots touch it turns left,
   * so that they are kept apart. The loop ends when corner and direction are those of the start: a corner where two dots
   touch is passed twice, in different directions. Only corners become points. `done` marks upper sides, which every loop has
   (at its top), so each loop is traced exactly once; holes are traced as well, in the opposite sense. */
static void trace_loop(const Trace *t, Pen *pen, int x, int row)
{
    static const int step_x[] = { 1, 0, -1, 0 }, step_row[] = { 0, -1, 0, 1 };
    const WrFontGlyph *g = t->glyph;
    int start_x = x, start_row = row;
    Way way = WEST, start_way = WEST;
    bool first = true;
    do {
        if (way == WEST) t->done[row * g->width + x - 1] = 1;
        x += step_x[way];
        row += step_row[way];
        Way next = (Way)((way + 1) % 4);
        if (!(side_dot(t, x, row, next, true) && !side_dot(t, x, row, next, false))) {
            next = way;
            if (!(side_dot(t, x, row, next, true) && !side_dot(t, x, row, next, false)))
                next = (Way)((way + 3) % 4);
        }
        if (next == way) continue;
        double px = pen->x + (g->left + x) * pen->scale, py = pen->y + (g->top - row) * pen->scale;
        if (first) begin(pen, px, py);
        else line(pen, px, py);
        first = false;
        way = next;
    } while (x != start_x || row != start_row || way != start_way);
}

static bool draw_dots(Pen *pen, const WrFontText *text, const WrFontGlyph *g, WrError *err)
{
    if (g->width == 0 || g->height == 0) return true;
    Trace t = { text, g, NULL };
    t.done = wr_try_alloc((size_t)(g->height + 1), (size_t)g->width, "a glyph's dots", err);
    if (!t.done) return false;
    for (int row = 0; row < g->height; row++)
        for (int x = 0; x < g->width; x++)
            if (!t.done[row * g->width + x] && wr_font_dot(text, g, x, row) &&
                !wr_font_dot(text, g, x, row - 1))
                trace_loop(&t, pen, x + 1, row);
    wr_free(t.done);
    return true;
}

/* ---- texts ---- */

bool wr_font_glyph_outline(const WrFontText *text, int glyph, double scale, double x, double y,
                           double tolerance, WrFontOutline *out, WrError *err)
{
    const WrFontGlyph *g = &text->glyphs[glyph];
    Pen pen = { out, scale, x, y, tolerance, 0.0, 0.0 };
    if (g->width > 0) {
        if (!draw_dots(&pen, text, g, err)) return false;
    } else {
        draw_verbs(&pen, text, g);
    }
    if (out->xy.count / 2 > WR_FONT_FLAT_MAX)
        return wr_fail(err, "the text's outlines have more than %d points: make it shorter",
                       WR_FONT_FLAT_MAX);
    return true;
}

double wr_font_place(const WrFontText *text, const WrFontSetting *setting, double (*place)[2])
{
    double scale = setting->size / text->units, widest = 0.0;
    for (int32_t l = 0; l < text->line_count; l++) {
        const WrFontLine *line_is = &text->lines[l];
        double x = 0.0, y = -(double)l * text->line * scale * setting->line_spacing, end = 0.0;
        int32_t last = line_is->first + line_is->count;
        for (int32_t i = line_is->first; i < last; i++) {
            const WrFontPlaced *p = &text->placed[i];
            double own = wr_font_scale(text, p, setting->size);
            place[i][0] = x + p->dx * own;
            place[i][1] = y + p->dy * own;
            x += p->advance * own;
            end = x;
            if (p->spaced) x += setting->letter_spacing;
        }
        widest = end > widest ? end : widest;
        double part = setting->align == WR_FONT_CENTRE  ? 0.5
                      : setting->align == WR_FONT_RIGHT ? 1.0
                                                        : 0.0;
        for (int32_t i = line_is->first; i < last; i++) place[i][0] -= part * end;
    }
    return widest;
}

bool wr_font_outline(const WrFontText *text, const WrFontSetting *setting, double tolerance,
                     WrFontOutline *out, WrError *err)
{
    double(*place)[2] = wr_try_alloc((size_t)text->placed_count + 1, sizeof *place, "a text", err);
    if (!place) return false;
    wr_font_place(text, setting, place);
    bool good = true;
    for (int32_t i = 0; i < text->placed_count && good; i++)
        good = wr_font_glyph_outline(text, text->placed[i].glyph,
                                     wr_font_scale(text, &text->placed[i], setting->size),
                                     place[i][0], place[i][1], tolerance, out, err);
    wr_free(place);
    return good;
}
