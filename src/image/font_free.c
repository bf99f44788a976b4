/* Fonts read by FreeType; outlines in the font's own units, never scaled or hinted, so that the library
   does not round them. OpenType fonts are shaped by HarfBuzz, at a scale of one unit. */
#include "image/font_internal.h"

#include "base/error.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MULTIPLE_MASTERS_H
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
    WrFontFace *own;
    FT_Library library;
    FT_Face face;
    hb_font_t *shaper; /* NULL: one glyph per character */
    hb_buffer_t *buffer;
    WrFontMaking *making;
    bool too_many; /* the limit of points was exceeded */
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
        if (x < -2 * REACH || x > 2 * REACH || y < -2 * REACH || y > 2 * REACH) return 1;
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

/* A box: an outer and an inner rectangle of opposite orientation. */
static void add_box(Free *f)
{
    int32_t em = f->own->head.units, w = em / 2, h = em * 7 / 10, t = em / 20 + 1, l = em / 20;
    const WrFontPoint corners[] = {
        { l, 0 },     { w, 0 },         { w, h },         { l, h },
        { l + t, t }, { l + t, h - t }, { w - t, h - t }, { w - t, t }
    };
    for (int i = 0; i < 8; i++) {
        wr_array_push(&f->making->verbs, (uint8_t)(i % 4 ? WR_FONT_LINE : WR_FONT_MOVE));
        wr_array_push(&f->making->points, ((WrFontPoint){ 2 * corners[i].x, 2 * corners[i].y }));
    }
}

/* Adds the outline of glyph id, which may be empty. An unreadable glyph becomes empty. */
static void add_outline(Free *f, uint32_t id, WrFontGlyph *g)
{
    /* Doubled, since TrueType curves join half way between control points. */
    static const FT_Outline_Funcs funcs = { move_to, line_to, conic_to, cubic_to, 1, 0 };
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

/* Adds the dots of glyph id. Grey ones are set from half intensity on. */
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

/* Index of the glyph among the text's glyphs; -1 if it is damaged. */
static int32_t take(Free *f, uint32_t id)
{
    WrFontMaking *m = f->making;
    if (id >= (uint32_t)f->own->known.count) id = 0;
    if (f->own->known.data[id]) return f->own->known.data[id] - 1;
    WrFontGlyph g = { .id = id, .font = f->own->font, .units = f->own->head.units };
    if (f->own->head.bitmap) {
        if (!add_dots(f, id, &g)) return -1;
    } else {
        add_outline(f, id, &g);
    }
    wr_array_push(&m->glyphs, g);
    f->own->known.data[id] = m->glyphs.count;
    return m->glyphs.count - 1;
}

static int32_t bounded(long x, int32_t most)
{
    return (int32_t)(x < -most ? -most : x > most ? most : x);
}

/* ---- one glyph per character ---- */

static int32_t map(WrFontFace *face, uint32_t character, int32_t *advance)
{
    Free *f = face->ctx;
    FT_UInt id = FT_Get_Char_Index(f->face, character);
    if (id == 0) wr_font_add_missing(f->making, character);
    int32_t glyph = take(f, id);
    FT_Int32 flags = face->head.bitmap ? FT_LOAD_DEFAULT : FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP;
    if (glyph >= 0 && FT_Load_Glyph(f->face, id, flags) == 0) {
        FT_Pos step = f->face->glyph->advance.x;
        *advance = bounded(face->head.bitmap ? (step + 32) >> 6 : step, ADVANCE_MAX);
    }
    return glyph;
}

/* True also for characters that HarfBuzz composes from two. */
static bool has(const WrFontFace *face, uint32_t character)
{
    const Free *f = face->ctx;
    hb_codepoint_t a, b;
    if (FT_Get_Char_Index(f->face, character) != 0) return true;
    return f->shaper && hb_unicode_decompose(hb_unicode_funcs_get_default(), character, &a, &b) &&
           FT_Get_Char_Index(f->face, a) != 0 && (b == 0 || FT_Get_Char_Index(f->face, b) != 0);
}

/* ---- shaping ---- */

/* Reports the characters of a missing glyph: the base and its marks. */
static void add_missing(Free *f, const WrFontChars *chars, int first)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    wr_font_add_missing(f->making, chars->code[first]);
    for (int i = first + 1; i < chars->count; i++) {
        hb_unicode_general_category_t is = hb_unicode_general_category(unicode, chars->code[i]);
        if (is != HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK &&
            is != HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK)
            break;
        if (!has(f->own, chars->code[i])) wr_font_add_missing(f->making, chars->code[i]);
    }
}

static bool keep_shaped(Free *f, const WrFontChars *chars, WrError *err)
{
    unsigned count = 0;
    const hb_glyph_info_t *info = hb_buffer_get_glyph_infos(f->buffer, &count);
    const hb_glyph_position_t *at = hb_buffer_get_glyph_positions(f->buffer, NULL);
    if (!hb_buffer_allocation_successful(f->buffer) ||
        (int64_t)f->making->placed.count + count > PLACED_MAX)
        return wr_fail(err, "shaping returned more glyphs than possible: is the font damaged?");
    for (unsigned i = 0; i < count; i++) {
        uint32_t character = info[i].cluster < (unsigned)chars->count ? info[i].cluster : 0;
        if (info[i].codepoint == 0) add_missing(f, chars, (int)character);
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

static bool shape(WrFontFace *face, const WrFontChars *chars, int from, int count, bool leftwards,
                  uint32_t script, WrError *err)
{
    Free *f = face->ctx;
    if (!f->shaper) {
        wr_font_shape_plain(face, chars, from, count, leftwards, map);
    } else {
        hb_buffer_clear_contents(f->buffer);
        hb_buffer_add_codepoints(f->buffer, chars->code, chars->count, (unsigned)from, count);
        hb_buffer_set_direction(f->buffer, leftwards ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
        hb_buffer_set_script(f->buffer, (hb_script_t)script);
        if (face->ask->language)
            hb_buffer_set_language(f->buffer, hb_language_from_string(face->ask->language, -1));
        hb_shape(f->shaper, f->buffer, NULL, 0);
        if (!keep_shaped(f, chars, err)) return false;
    }
    if (!f->too_many) return true;
    return wr_fail(err, "its outlines have more than %d points", WR_FONT_POINTS_MAX);
}

/* ---- the font ---- */

static bool open_face(Free *f, const uint8_t *bytes, size_t length, WrError *err)
{
    if (FT_Init_FreeType(&f->library) != 0) {
        f->library = NULL;
        return wr_fail(err, "FreeType does not start");
    }
    int face = f->own->font == 0 ? f->own->ask->face : 0;
    if (FT_New_Memory_Face(f->library, bytes, (FT_Long)length, face, &f->face) != 0) {
        f->face = NULL;
        return wr_fail(
            err, face > 0 ? "is no font, or has no face %d" : "is no font that can be read", face);
    }
    if (f->face->num_glyphs < 1 || f->face->num_glyphs > GLYPHS_MAX)
        return wr_fail(err, "has %ld glyphs: must be 1..%d", f->face->num_glyphs, GLYPHS_MAX);
    if (!f->face->charmap && f->face->num_charmaps > 0)
        FT_Set_Charmap(f->face, f->face->charmaps[0]);
    return true;
}

static bool measure(Free *f, WrError *err)
{
    WrFontHead *head = &f->own->head;
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

/* ---- axes of variable fonts ---- */

#define AXES_MAX 64

/* Sets one axis in design units of 1/65536. False: the font has no axis of that tag. */
static bool set_axis(const FT_MM_Var *axes, const hb_variation_t *wish, FT_Fixed *at)
{
    for (FT_UInt i = 0; i < axes->num_axis && i < AXES_MAX; i++) {
        if (axes->axis[i].tag != wish->tag) continue;
        double low = (double)axes->axis[i].minimum / 65536.0;
        double high = (double)axes->axis[i].maximum / 65536.0;
        double value = (double)wish->value;
        value = value < low ? low : value > high ? high : value;
        at[i] = (FT_Fixed)(value * 65536.0);
        return true;
    }
    return false;
}

/* Parses tag=value items separated by commas. */
static bool take_axes(const Free *f, const FT_MM_Var *axes, FT_Fixed *at, WrError *err)
{
    for (const char *p = f->own->ask->axes; *p;) {
        size_t length = strcspn(p, ",");
        hb_variation_t wish;
        if (!hb_variation_from_string(p, (int)length, &wish) || !memchr(p, '=', length) ||
            !(wish.value >= -32000.0f && wish.value <= 32000.0f))
            return wr_fail(err, "axes: \"%.*s\" must be as in wght=650",
                           length < 40 ? (int)length : 40, p);
        if (!set_axis(axes, &wish, at) && f->own->font == 0)
            return wr_fail(err, "axes: the font has no axis %.4s", p);
        p += length;
        if (*p) p++;
    }
    return true;
}

static bool vary(Free *f, WrError *err)
{
    const char *wish = f->own->ask->axes;
    FT_MM_Var *axes = NULL;
    FT_Fixed at[AXES_MAX];
    if (!wish || !*wish) return true;
    if (FT_Get_MM_Var(f->face, &axes) != 0) {
        if (f->own->font > 0) return true;
        return wr_fail(err, "axes: the font is not variable");
    }
    FT_UInt count = axes->num_axis < AXES_MAX ? axes->num_axis : AXES_MAX;
    for (FT_UInt i = 0; i < count; i++) at[i] = axes->axis[i].def;
    bool good = take_axes(f, axes, at, err);
    if (good && FT_Set_Var_Design_Coordinates(f->face, count, at) != 0)
        good = wr_fail(err, "axes: its variations are damaged");
    if (good && f->shaper) {
        hb_variation_t all[AXES_MAX];
        for (FT_UInt i = 0; i < count; i++)
            all[i] = (hb_variation_t){ (hb_tag_t)axes->axis[i].tag, (float)at[i] / 65536.0f };
        hb_font_set_variations(f->shaper, all, count);
    }
    FT_Done_MM_Var(f->library, axes);
    return good;
}

/* ---- opening and closing ---- */

static void start_shaper(Free *f)
{
    if (!FT_IS_SFNT(f->face) || f->own->head.bitmap) return;
    hb_face_t *face = hb_ft_face_create_referenced(f->face);
    f->buffer = hb_buffer_create();
    f->shaper = hb_font_create(face); /* reads the tables itself, in font units */
    hb_face_destroy(face);
    hb_font_set_scale(f->shaper, f->own->head.units, f->own->head.units);
}

static void close(WrFontFace *face)
{
    Free *f = face->ctx;
    if (f->shaper) hb_font_destroy(f->shaper);
    if (f->buffer) hb_buffer_destroy(f->buffer);
    if (f->face) FT_Done_Face(f->face);
    if (f->library) FT_Done_FreeType(f->library);
    wr_array_free(&face->known);
    wr_free(f);
}

bool wr_font_open_free(WrFontFace *face, const uint8_t *bytes, size_t length, WrError *err)
{
    Free *f = wr_alloc(1, sizeof *f);
    *f = (Free){ .own = face, .making = face->making };
    face->ctx = f;
    face->has = has;
    face->shape = shape;
    face->close = close;
    bool good = open_face(f, bytes, length, err) && measure(f, err);
    if (good) {
        wr_font_face_expect(face, (int)f->face->num_glyphs);
        start_shaper(f);
        good = vary(f, err);
    }
    if (!good) close(face);
    return good;
}
