#include "generate/text_layout.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/progress.h"

#include <math.h>
#include <string.h>

#define TOLERANCE (1.0 / 64.0) /* texels */
#define SMOOTH 32              /* straight pieces between two points of a path */

/* A position and the direction of writing there; y down. */
typedef struct Stand {
    double x, y, cosine, sine; /* sine > 0: uphill as seen */
} Stand;

/* A path as a polyline. */
typedef struct Path {
    WR_ARRAY(double) xy;     /* texels, y down */
    WR_ARRAY(double) length; /* from the start to each point */
} Path;

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

/* ---- paths ---- */

static void path_fini(Path *path)
{
    wr_array_free(&path->xy);
    wr_array_free(&path->length);
}

static void path_add(Path *path, double x, double y)
{
    int n = path->length.count;
    double so_far = 0.0;
    if (n > 0) {
        double dx = x - path->xy.data[2 * n - 2], dy = y - path->xy.data[2 * n - 1];
        if (dx == 0.0 && dy == 0.0) return;
        so_far = path->length.data[n - 1] + sqrt(dx * dx + dy * dy);
    }
    wr_array_push(&path->xy, x);
    wr_array_push(&path->xy, y);
    wr_array_push(&path->length, so_far);
}

/* Catmull-Rom between b and c. */
static double smooth(double a, double b, double c, double d, double t)
{
    return b +
           0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

/* The curve through the points; it continues straight beyond its ends. */
static bool path_make(Path *path, const Lay *lay, WrError *err)
{
    const double *p = lay->wish->points;
    int n = lay->wish->point_count;
    for (int i = 0; i + 1 < n; i++)
        for (int k = i ? 1 : 0; k <= SMOOTH; k++) {
            double t = (double)k / SMOOTH, at[2];
            for (int c = 0; c < 2; c++) {
                double b0 = p[2 * i + c], c0 = p[2 * i + 2 + c];
                double a0 = i > 0 ? p[2 * i - 2 + c] : 2.0 * b0 - c0;
                double d0 = i + 2 < n ? p[2 * i + 4 + c] : 2.0 * c0 - b0;
                at[c] = smooth(a0, b0, c0, d0, t);
            }
            path_add(path, at[0] * lay->width, (1.0 - at[1]) * lay->height);
        }
    if (path->length.count >= 2) return true;
    return wr_fail(err, "points: a path needs two different places");
}

static double path_length(const Path *path)
{
    return path->length.data[path->length.count - 1];
}

static Stand path_at(const Path *path, double s)
{
    int low = 0, high = path->length.count - 2;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (path->length.data[middle] <= s) low = middle;
        else high = middle - 1;
    }
    const double *a = &path->xy.data[2 * (ptrdiff_t)low];
    double run = path->length.data[low + 1] - path->length.data[low];
    double dx = (a[2] - a[0]) / run, dy = (a[3] - a[1]) / run, t = s - path->length.data[low];
    return (Stand){ a[0] + t * dx, a[1] + t * dy, dx, -dy };
}

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
static bool draw(Lay *lay, int32_t placed, const Stand *stand, double x, double y, WrError *err)
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

static double nearest(const Lay *lay, double x)
{
    return lay->on_texels ? floor(x + 0.5) : x;
}

static bool lay_lines(Lay *lay, WrError *err)
{
    const WrTextRequest *wish = lay->wish;
    Stand stand = { nearest(lay, wish->at[0] * lay->width),
                    nearest(lay, (1.0 - wish->at[1]) * lay->height), 1.0, 0.0 };
    double up = rise(lay);
    wr_sincos_turns(wish->rotate_deg / 360.0, &stand.sine, &stand.cosine);
    for (int32_t i = 0; i < lay->text->placed_count; i++)
        if (!draw(lay, i, &stand, nearest(lay, lay->place[i][0]),
                  nearest(lay, lay->place[i][1] + up), err))
            return false;
    return true;
}

/* Each letter is perpendicular to the path at its middle. */
static bool lay_path(Lay *lay, WrError *err)
{
    Path path = { 0 };
    double part = lay->wish->setting.align == WR_FONT_CENTRE  ? 0.5
                  : lay->wish->setting.align == WR_FONT_RIGHT ? 1.0
                                                              : 0.0;
    bool good = path_make(&path, lay, err);
    double from = good ? part * path_length(&path) : 0.0, up = rise(lay);
    for (int32_t i = 0; i < lay->text->placed_count && good; i++) {
        const WrFontPlaced *p = &lay->text->placed[i];
        double scale = scale_of(lay, p), half = 0.5 * p->advance * scale, own = p->dx * scale;
        Stand stand = path_at(&path, from + lay->place[i][0] - own + half);
        good = draw(lay, i, &stand, own - half, lay->place[i][1] + up, err);
    }
    path_fini(&path);
    return good;
}

/* ---- around the table ---- */

/* One line, repeated so often that the spacing changes least, and spaced so that it closes. */
static bool lay_round(Lay *lay, int32_t index, const Stand *stand, double length, double up,
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
    Stand stand = { wish->at[0] * lay->width, (1.0 - wish->at[1]) * lay->height, dx / length,
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
