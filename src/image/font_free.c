/* Fonts that FreeType reads; outlines in the font's own units, never scaled or hinted, so that no rounding
   of that library shows. OpenType fonts are shaped by HarfBuzz, at a scale of one unit. */
#include "image/font_inner.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <hb-ft.h>
#include <hb-ot.h>

#include <string.h>

#define SIDE_MAX 4096 /* dots of a bitmap glyph */
#define REACH (1 << 22)
#define GLYPHS_MAX 65536
#define PLACED_MAX (1 << 22)
#define ADVANCE_MAX (1 << 18)

typedef struct Free {
    FT_Library library;
    FT_Face face;
    hb_font_t *shaper; /* NULL: a character, a glyph */
    hb_buffer_t *buffer;
    const WrFontAsk *ask;
    WrFontMaking *making;
    bool too_many; /* points */
} Free;

/* ---- glyphs ---- */

static int add_point(Free *f, WrFontVerb verb, int count, const FT_Vector *const *points)
{
    WrFontMaking *m = f->making;
    if (m->points.count + count > WR_FONT_POINTS_MAX) f->too_many = true;
    if (f->too_many) return 1;
    wr_array_push(&m->verbs, (uint8_t)verb);
    for (int i = 0; i < count; i++) {
        FT_Pos x = points[i]->x, y = points[i]->y;
        if (x < -REACH || x > REACH || y < -REACH || y > REACH) return 1;
        wr_array_push(&m->points, ((WrFontPoint){ (int32_t)x, (int32_t)y }));
    }
    return 0;
}

static int move_to(const FT_Vector *to, void *f)
{
    return add_point(f, WR_FONT_MOVE, 1, (const FT_Vector *const[]){ to });
}

static int line_to(const FT_Vector *to, void *f)
{
    return add_point(f, WR_FONT_LINE, 1, (const FT_Vector *const[]){ to });
}

static int conic_to(const FT_Vector *by, const FT_Vector *to, void *f)
{
    return add_point(f, WR_FONT_CONIC, 2, (const FT_Vector *const[]){ by, to });
}

static int cubic_to(const FT_Vector *a, const FT_Vector *b, const FT_Vector *to, void *f)
{
    return add_point(f, WR_FONT_CUBIC, 3, (const FT_Vector *const[]){ a, b, to });
}

/* Two rectangles, one in the other, turned against each other. */
static void add_box(Free *f)
{
    int32_t em = f->making->head.units, w = em / 2, h = em * 7 / 10, t = em / 20 + 1, l = em / 20;
    const WrFontPoint corners[] = {
        { l, 0 },     { w, 0 },         { w, h },         { l, h },
        { l + t, t }, { l + t, h - t }, { w - t, h - t }, { w - t, t }
    };
    for (int i = 0; i < 8; i++) {
        wr_array_push(&f->making->verbs, (uint8_t)(i % 4 ? WR_FONT_LINE : WR_FONT_MOVE));
        wr_array_push(&f->making->points, corners[i]);
    }
}

/* The outline of glyph id, which may be empty. A glyph that cannot be read is left empty. */
static void add_outline(Free *f, uint32_t id, WrFontGlyph *g)
{
    static const FT_Outline_Funcs funcs = { move_to, line_to, conic_to, cubic_to, 0, 0 };
    WrFontMaking *m = f->making;
    g->first_verb = m->verbs.count;
    g->first_point = m->points.count;
    bool good = FT_Load_Glyph(f->face, id, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP) == 0 &&
                f->face->glyph->format == FT_GLYPH_FORMAT_OUTLINE &&
                FT_Outline_Decompose(&f->face->glyph->outline, &funcs, f) == 0;
    if (!good) {
        m->verbs.count = g->first_verb;
        m->points.count = g->first_point;
    }
    if (id == 0 && m->verbs.count == g->first_verb) add_box(f);
    g->verb_count = m->verbs.count - g->first_verb;
    g->point_count = m->points.count - g->first_point;
}

/* The dots of glyph id. Grey ones count from half on. */
static bool add_dots(Free *f, uint32_t id, WrFontGlyph *g)
{
    WrFontMaking *m = f->making;
    g->first_byte = m->bytes.count;
    if (FT_Load_Glyph(f->face, id, FT_LOAD_DEFAULT) != 0) return true;
    const FT_Bitmap *dots = &f->face->glyph->bitmap;
    bool mono = dots->pixel_mode == FT_PIXEL_MODE_MONO;
    if (dots->width == 0 || dots->rows == 0 || !dots->buffer) return true;
    if ((!mono && dots->pixel_mode != FT_PIXEL_MODE_GRAY) || dots->width > SIDE_MAX ||
        dots->rows > SIDE_MAX)
        return false;
    g->left = f->face->glyph->bitmap_left;
    g->top = f->face->glyph->bitmap_top;
    g->width = (int32_t)dots->width;
    g->height = (int32_t)dots->rows;
    for (int y = 0; y < g->height; y++) {
        const unsigned char *row = dots->buffer + (ptrdiff_t)y * dots->pitch;
        for (int x = 0; x < g->width; x += 8) {
            unsigned byte = 0;
            for (int k = 0; k < 8 && x + k < g->width; k++) {
                bool on = mono ? row[x / 8] & (0x80 >> k) : row[x + k] >= 128;
                if (on) byte |= 0x80U >> k;
            }
            wr_array_push(&m->bytes, (uint8_t)byte);
        }
    }
    return m->bytes.count <= WR_FONT_FILE_MAX / 2;
}

/* Its place among the text's glyphs; -1 for one that is damaged. */
static int32_t take(Free *f, uint32_t id)
{
    WrFontMaking *m = f->making;
    if (id >= (uint32_t)m->known.count) id = 0;
    if (m->known.data[id]) return m->known.data[id] - 1;
    WrFontGlyph g = { .id = id };
    if (m->head.bitmap) {
        if (!add_dots(f, id, &g)) return -1;
    } else {
        add_outline(f, id, &g);
    }
    wr_array_push(&m->glyphs, g);
    m->known.data[id] = m->glyphs.count;
    return m->glyphs.count - 1;
}

static int32_t bounded(long x, int32_t most)
{
    return (int32_t)(x < -most ? -most : x > most ? most : x);
}

/* ---- a character, a glyph ---- */

static int32_t map(void *ctx, uint32_t character, int32_t *advance)
{
    Free *f = ctx;
    FT_UInt id = FT_Get_Char_Index(f->face, character);
    if (id == 0) wr_font_add_missing(f->making, character);
    int32_t glyph = take(f, id);
    FT_Int32 flags =
        f->making->head.bitmap ? FT_LOAD_DEFAULT : FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP;
    if (glyph >= 0 && FT_Load_Glyph(f->face, id, flags) == 0) {
        FT_Pos step = f->face->glyph->advance.x;
        *advance = bounded(f->making->head.bitmap ? (step + 32) >> 6 : step, ADVANCE_MAX);
    }
    return glyph;
}

/* ---- shaping ---- */

static bool keep_shaped(Free *f, const WrFontChars *chars, WrError *err)
{
    unsigned count = 0;
    const hb_glyph_info_t *info = hb_buffer_get_glyph_infos(f->buffer, &count);
    const hb_glyph_position_t *at = hb_buffer_get_glyph_positions(f->buffer, NULL);
    if (!hb_buffer_allocation_successful(f->buffer) ||
        (int64_t)f->making->placed.count + count > PLACED_MAX)
        return wr_fail(err, "shaping gives more glyphs than there can be: is the font damaged?");
    for (unsigned i = 0; i < count; i++) {
        uint32_t character = info[i].cluster < (unsigned)chars->count ? info[i].cluster : 0;
        if (info[i].codepoint == 0) wr_font_add_missing(f->making, chars->code[character]);
        int32_t glyph = take(f, info[i].codepoint);
        if (f->too_many)
            return wr_fail(err, "its outlines have more than %d points", WR_FONT_POINTS_MAX);
        WrFontPlaced placed = { .glyph = glyph,
                                .advance = bounded(at[i].x_advance, ADVANCE_MAX),
                                .dx = bounded(at[i].x_offset, ADVANCE_MAX),
                                .dy = bounded(at[i].y_offset, ADVANCE_MAX),
                                .cluster = chars->byte[character] };
        placed.spaced = i + 1 == count || info[i + 1].cluster != info[i].cluster;
        wr_array_push(&f->making->placed, placed);
    }
    return true;
}

/* The characters from .. from + count - 1, all of one script and direction. */
static bool shape_part(Free *f, const WrFontChars *chars, int from, int count, bool leftwards,
                       hb_script_t script, WrError *err)
{
    hb_buffer_clear_contents(f->buffer);
    hb_buffer_add_codepoints(f->buffer, chars->code, chars->count, (unsigned)from, count);
    hb_buffer_set_direction(f->buffer, leftwards ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
    hb_buffer_set_script(f->buffer, script);
    if (f->ask->language)
        hb_buffer_set_language(f->buffer, hb_language_from_string(f->ask->language, -1));
    hb_shape(f->shaper, f->buffer, NULL, 0);
    return keep_shaped(f, chars, err);
}

static bool is_plain_script(hb_script_t script)
{
    return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED ||
           script == HB_SCRIPT_UNKNOWN;
}

/* The first script from `i` on, or common. */
static hb_script_t script_from(const WrFontChars *chars, int i, int end)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    for (; i < end; i++) {
        hb_script_t script = hb_unicode_script(unicode, chars->code[i]);
        if (!is_plain_script(script)) return script;
    }
    return HB_SCRIPT_COMMON;
}

/* Where the part that begins at `i` ends: before the first character of another script. */
static int script_end(const WrFontChars *chars, int i, int end, hb_script_t script)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    for (; i < end; i++) {
        hb_script_t is = hb_unicode_script(unicode, chars->code[i]);
        if (!is_plain_script(is) && is != script) return i;
    }
    return end;
}

/* A run's parts by script stand from right to left where it is leftwards. */
static bool shape_run(Free *f, const WrFontChars *chars, const WrFontRun *run, WrError *err)
{
    typedef struct Part {
        int from, count;
        hb_script_t script;
    } Part;
    WR_ARRAY(Part) parts = { 0 };
    int end = run->first + run->count;
    bool good = true;
    for (int i = run->first; i < end;) {
        hb_script_t script = script_from(chars, i, end);
        int stop = script_end(chars, i, end, script);
        wr_array_push(&parts, ((Part){ i, stop - i, script }));
        i = stop;
    }
    for (int k = 0; k < parts.count && good; k++) {
        Part p = parts.data[run->leftwards ? parts.count - 1 - k : k];
        good = shape_part(f, chars, p.from, p.count, run->leftwards, p.script, err);
    }
    wr_array_free(&parts);
    return good;
}

static bool shape_line(void *ctx, const WrFontChars *chars, const WrFontRun *runs, int run_count,
                       WrError *err)
{
    for (int i = 0; i < run_count; i++)
        if (!shape_run(ctx, chars, &runs[i], err)) return false;
    return true;
}

/* ---- the font ---- */

static bool open_face(Free *f, const uint8_t *bytes, size_t length, WrError *err)
{
    if (FT_Init_FreeType(&f->library) != 0) {
        f->library = NULL;
        return wr_fail(err, "FreeType does not start");
    }
    if (FT_New_Memory_Face(f->library, bytes, (FT_Long)length, f->ask->face, &f->face) != 0) {
        f->face = NULL;
        return wr_fail(
            err, f->ask->face > 0 ? "is no font, or has no face %d" : "is no font that can be read",
            f->ask->face);
    }
    if (f->face->num_glyphs < 1 || f->face->num_glyphs > GLYPHS_MAX)
        return wr_fail(err, "has %ld glyphs: must be 1..%d", f->face->num_glyphs, GLYPHS_MAX);
    if (!f->face->charmap && f->face->num_charmaps > 0)
        FT_Set_Charmap(f->face, f->face->charmaps[0]);
    return true;
}

static bool measure(Free *f, WrError *err)
{
    WrFontHead *head = &f->making->head;
    FT_Face face = f->face;
    long ascent = face->ascender, descent = -(long)face->descender, line = face->height;
    long units = face->units_per_EM;
    if (!FT_IS_SCALABLE(face)) {
        if (face->num_fixed_sizes < 1 || FT_Select_Size(face, 0) != 0)
            return wr_fail(err, "has neither outlines nor dots");
        head->bitmap = 1;
        const FT_Size_Metrics *size = &face->size->metrics;
        units = face->available_sizes[0].height;
        ascent = (size->ascender + 32) >> 6;
        descent = (32 - size->descender) >> 6;
        line = units;
    }
    if (units < 1 || units > 16384)
        return wr_fail(err, "has %ld units to the em: must be 1..16384", units);
    head->units = (int32_t)units;
    head->ascent = bounded(ascent, 1 << 16);
    head->descent = bounded(descent, 1 << 16);
    head->line = bounded(line > 0 ? line : units, 1 << 16);
    return true;
}

static void start_shaper(Free *f)
{
    if (!FT_IS_SFNT(f->face) || f->making->head.bitmap) return;
    hb_face_t *face = hb_ft_face_create_referenced(f->face);
    f->buffer = hb_buffer_create();
    f->shaper = hb_font_create(face); /* reads the tables itself, in font units */
    hb_face_destroy(face);
    hb_font_set_scale(f->shaper, f->making->head.units, f->making->head.units);
}

/* A damaged glyph, of which nothing is known. */
static bool check_placed(const WrFontMaking *making, WrError *err)
{
    for (int i = 0; i < making->placed.count; i++)
        if (making->placed.data[i].glyph < 0)
            return wr_fail(err, "has coloured dots or dots of a wrong size, which cannot be used");
    return true;
}

bool wr_font_make_free(const uint8_t *bytes, size_t length, const WrFontAsk *ask, WrFontMaking *out,
                       WrError *err)
{
    Free f = { .ask = ask, .making = out };
    bool good = open_face(&f, bytes, length, err) && measure(&f, err);
    if (good) {
        int count = (int)f.face->num_glyphs;
        wr_array_reserve(&out->known, count);
        out->known.count = count;
        memset(out->known.data, 0, (size_t)count * sizeof *out->known.data);
        start_shaper(&f);
        good = f.shaper ? wr_font_lines(out, ask, shape_line, &f, err)
                        : wr_font_lay_plain(out, ask, map, &f, err);
        if (good && f.too_many)
            good = wr_fail(err, "its outlines have more than %d points", WR_FONT_POINTS_MAX);
        good = good && check_placed(out, err);
    }
    if (f.shaper) hb_font_destroy(f.shaper);
    if (f.buffer) hb_buffer_destroy(f.buffer);
    if (f.face) FT_Done_Face(f.face);
    if (f.library) FT_Done_FreeType(f.library);
    return good;
}
