/* Fonts read by FreeType; outlines in the font's own units, never scaled or hinted, so that the library
   does not round them. OpenType fonts are shaped by HarfBuzz, at a scale of one unit. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/font_internal.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MULTIPLE_MASTERS_H
#include FT_OUTLINE_H
#include <fribidi.h>
#include <hb-ft.h>
#include <hb-ot.h>
#include <hb.h>
#include <string.h>
#include <zlib.h>

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

/* Points are int32 in half font units: a TrueType curve's implied point between two control points has a half coordinate.
   Verbs and points are two parallel arrays; a move or line has one point, a conic two, a cubic three. */
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
                /* Bits of a packed row run from the highest to the lowest; each row begins at a byte. */
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
    /* known[id] is 1 + the glyph's index in the text, 0: not used yet; each glyph is converted once. */
    f->own->known.data[id] = m->glyphs.count;
    return m->glyphs.count - 1;
}

static int32_t bounded(long x, int32_t most)
{
    return (int32_t)(x < -most ? -most : x > most ? most : x);
}

/* ---- one glyph per character ---- */

static void font_add_missing(WrFontMaking *making, uint32_t character);

static int32_t map_character(WrFontFace *face, uint32_t character, int32_t *advance)
{
    Free *f = face->ctx;
    FT_UInt id = FT_Get_Char_Index(f->face, character);
    if (id == 0) font_add_missing(f->making, character);
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
    font_add_missing(f->making, chars->code[first]);
    for (int i = first + 1; i < chars->count; i++) {
        hb_unicode_general_category_t is = hb_unicode_general_category(unicode, chars->code[i]);
        if (is != HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK &&
            is != HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK)
            break;
        if (!has(f->own, chars->code[i])) font_add_missing(f->making, chars->code[i]);
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
        /* Letter spacing is added once after each cluster, not between a base and its marks. */
        placed.spaced = i + 1 == count || info[i + 1].cluster != info[i].cluster;
        wr_array_push(&f->making->placed, placed);
    }
    return true;
}

static void font_shape_plain(WrFontFace *face, const WrFontChars *chars, int from, int count,
                             bool leftwards, WrFontMap map);

static bool shape(WrFontFace *face, const WrFontChars *chars, int from, int count, bool leftwards,
                  uint32_t script, WrError *err)
{
    Free *f = face->ctx;
    if (!f->shaper) {
        font_shape_plain(face, chars, from, count, leftwards, map_character);
    } else {
        hb_buffer_clear_contents(f->buffer);
        /* The whole line is passed with the part's range: the neighbours beyond it determine joining forms at its ends
           (Arabic). */
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
        return wr_fail(err, "FreeType cannot be initialised");
    }
    int face = f->own->font == 0 ? f->own->ask->face : 0;
    if (FT_New_Memory_Face(f->library, bytes, (FT_Long)length, face, &f->face) != 0) {
        f->face = NULL;
        return wr_fail(
            err, face > 0 ? "is not a font, or has no face %d" : "is not a readable font", face);
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
            return wr_fail(err, "has neither outlines nor bitmaps");
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

static void close_face(WrFontFace *face)
{
    Free *f = face->ctx;
    if (f->shaper) hb_font_destroy(f->shaper);
    if (f->buffer) hb_buffer_destroy(f->buffer);
    if (f->face) FT_Done_Face(f->face);
    if (f->library) FT_Done_FreeType(f->library);
    wr_array_free(&face->known);
    wr_free(f);
}

static void font_face_expect(WrFontFace *face, int count);

/* Opens a font with FreeType over bytes that stay valid; face->making, ask and font must be set. On failure there is
   nothing to close. */
static bool font_open_free(WrFontFace *face, const uint8_t *bytes, size_t length, WrError *err)
{
    Free *f = wr_alloc(1, sizeof *f);
    *f = (Free){ .own = face, .making = face->making };
    face->ctx = f;
    face->has = has;
    face->shape = shape;
    face->close = close_face;
    bool good = open_face(f, bytes, length, err) && measure(f, err);
    if (good) {
        font_face_expect(face, (int)f->face->num_glyphs);
        start_shaper(f);
        good = vary(f, err);
    }
    if (!good) close_face(face);
    return good;
}

/* ---- compressed files ---- */

#define STEP ((size_t)1 << 16)

bool wr_font_gunzip(const uint8_t *bytes, size_t length, size_t limit, uint8_t **out, size_t *count,
                    WrError *err)
{
    z_stream z = { .next_in = (Bytef *)(uintptr_t)bytes, .avail_in = (uInt)length };
    WrText text = { 0 };
    char *step = wr_alloc(STEP, 1);
    int state = inflateInit2(&z, 15 + 16); /* gzip only */
    bool started = state == Z_OK;
    while (state == Z_OK && text.length <= limit) {
        z.next_out = (Bytef *)step;
        z.avail_out = STEP;
        state = inflate(&z, Z_NO_FLUSH);
        if (state == Z_OK || state == Z_STREAM_END) wr_text_add_n(&text, step, STEP - z.avail_out);
    }
    if (started) inflateEnd(&z);
    wr_free(step);
    bool good = state == Z_STREAM_END && text.length <= limit && text.length > 0;
    if (good) {
        *count = text.length;
        *out = (uint8_t *)text.data;
        return true;
    }
    bool large = text.length > limit;
    wr_text_fini(&text);
    if (large) return wr_fail(err, "unpacks to more than %zu MB", limit >> 20);
    return wr_fail(err, "its gzip data is damaged or truncated");
}

/* ---- lines of a text ---- */

/* Splits a text into lines, and lines into parts by direction (Unicode's bidirectional algorithm, by FriBidi).
   libraqm would do this and shape too, but through FreeType's scaled font; here HarfBuzz shapes in font units
   (FreeType, above), and fonts without a shaper use the same parts. */

/* UTF-8: the lead byte determines the length (0xc0, 0xc1 and 0xf5.. never occur); overlong forms, surrogates and values above
   U+10FFFF are invalid. An invalid byte counts as one U+FFFD, and reading continues with the next byte. */
uint32_t wr_font_character(const char *text, size_t length, size_t *at)
{
    const uint8_t *p = (const uint8_t *)text + *at;
    size_t left = length - *at;
    uint32_t first = p[0], code = first;
    size_t more = first < 0x80 ? 0 : first < 0xc2 ? 9 : first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
    bool good = more <= 3 && more < left && first < 0xf5;
    if (good && more > 0) code = first & (0x3fU >> more);
    for (size_t i = 1; good && i <= more; i++) {
        good = (p[i] & 0xc0) == 0x80;
        code = code << 6 | (p[i] & 0x3fU);
    }
    static const uint32_t least[] = { 0, 0x80, 0x800, 0x10000 };
    good = good && code >= least[more] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
    *at += good ? 1 + more : 1;
    return good ? code : 0xfffd;
}

int wr_font_strange_bytes(const char *text)
{
    size_t length = strlen(text);
    int count = 0;
    for (size_t at = 0; at < length;) {
        size_t before = at;
        count += wr_font_character(text, length, &at) == 0xfffd && at == before + 1;
    }
    return count;
}

static void font_add_missing(WrFontMaking *making, uint32_t character)
{
    for (int i = 0; i < making->missing.count; i++)
        if (making->missing.data[i] == character) return;
    if (making->missing.count < WR_FONT_MISSING_MAX) wr_array_push(&making->missing, character);
}

/* ---- directions ---- */

typedef struct Level {
    WrFontRun run;
    int level;
} Level;

typedef struct Lines {
    WrFontMaking *making;
    WrFontLineMake make;
    void *ctx;
    WrFontChars chars;
    FriBidiCharType *types;
    FriBidiBracketType *brackets;
    FriBidiLevel *levels;
    WR_ARRAY(Level) parts;
    WR_ARRAY(WrFontRun) runs;
    WrFontDirection direction;
} Lines;

/* Rule L2: from the highest level down to the lowest odd one, reverses every sequence at that level or
 * higher. */
static void put_in_visual_order(Level *parts, int count, int highest)
{
    for (int level = highest; level >= 1; level--)
        for (int i = 0; i < count;) {
            int end = i;
            while (end < count && parts[end].level >= level) end++;
            for (int a = i, b = end - 1; a < b; a++, b--) {
                Level swap = parts[a];
                parts[a] = parts[b];
                parts[b] = swap;
            }
            i = end > i ? end : i + 1;
        }
}

/* The line's parts from left to right. False when out of memory. */
static bool find_runs(Lines *lines, bool *leftwards)
{
    int count = lines->chars.count, highest = 0;
    FriBidiParType base = lines->direction == WR_FONT_LEFT_TO_RIGHT   ? FRIBIDI_PAR_LTR
                          : lines->direction == WR_FONT_RIGHT_TO_LEFT ? FRIBIDI_PAR_RTL
                                                                      : FRIBIDI_PAR_ON;
    lines->parts.count = lines->runs.count = 0;
    *leftwards = base == FRIBIDI_PAR_RTL;
    if (count == 0) return true;
    fribidi_get_bidi_types(lines->chars.code, count, lines->types);
    fribidi_get_bracket_types(lines->chars.code, count, lines->types, lines->brackets);
    if (!fribidi_get_par_embedding_levels_ex(lines->types, lines->brackets, count, &base,
                                             lines->levels))
        return false;
    *leftwards = FRIBIDI_IS_RTL(base);
    for (int i = 0; i < count; i++) {
        int level = lines->levels[i];
        highest = level > highest ? level : highest;
        if (i == 0 || level != lines->parts.data[lines->parts.count - 1].level)
            wr_array_push(&lines->parts, ((Level){ { i, 0, (level & 1) != 0 }, level }));
        lines->parts.data[lines->parts.count - 1].run.count++;
    }
    put_in_visual_order(lines->parts.data, lines->parts.count, highest);
    for (int i = 0; i < lines->parts.count; i++)
        wr_array_push(&lines->runs, lines->parts.data[i].run);
    return true;
}

/* ---- lines ---- */

static bool make_line(Lines *lines, WrError *err)
{
    bool leftwards;
    int first = lines->making->placed.count;
    if (!find_runs(lines, &leftwards))
        return wr_fail(err, "not enough memory to order the letters of a line");
    if (!lines->make(lines->ctx, &lines->chars, lines->runs.data, lines->runs.count, err))
        return false;
    wr_array_push(&lines->making->lines,
                  ((WrFontLine){ first, lines->making->placed.count - first, leftwards }));
    return true;
}

static void free_lines(Lines *lines)
{
    wr_free(lines->chars.code);
    wr_free(lines->chars.byte);
    wr_free(lines->types);
    wr_free(lines->brackets);
    wr_free(lines->levels);
    wr_array_free(&lines->parts);
    wr_array_free(&lines->runs);
}

static bool font_lines(WrFontMaking *making, const WrFontRequest *ask, WrFontLineMake make,
                       void *ctx, WrError *err)
{
    size_t length = strlen(ask->text), at = 0;
    Lines lines = { .making = making, .make = make, .ctx = ctx, .direction = ask->direction };
    lines.chars.code = wr_alloc(length + 1, sizeof *lines.chars.code);
    lines.chars.byte = wr_alloc(length + 1, sizeof *lines.chars.byte);
    lines.types = wr_alloc(length + 1, sizeof *lines.types);
    lines.brackets = wr_alloc(length + 1, sizeof *lines.brackets);
    lines.levels = wr_alloc(length + 1, sizeof *lines.levels);
    bool good = true;
    while (good && at < length) {
        int32_t byte = (int32_t)at;
        uint32_t code = wr_font_character(ask->text, length, &at);
        if (code == '\n') {
            good = make_line(&lines, err);
            lines.chars.count = 0;
            continue;
        }
        if (code == '\t') code = ' ';
        if (code < 0x20 || code == 0x7f) continue;
        lines.chars.code[lines.chars.count] = code;
        lines.chars.byte[lines.chars.count++] = byte;
    }
    good = good && make_line(&lines, err);
    free_lines(&lines);
    return good;
}

/* ---- without shaping ---- */

static void font_shape_plain(WrFontFace *face, const WrFontChars *chars, int from, int count,
                             bool leftwards, WrFontMap map)
{
    for (int k = 0; k < count; k++) {
        int i = from + (leftwards ? count - 1 - k : k);
        uint32_t code = chars->code[i];
        FriBidiChar mirrored;
        int32_t advance = 0;
        if (leftwards && fribidi_get_mirror_char(code, &mirrored)) code = mirrored;
        int32_t glyph = map(face, code, &advance);
        wr_array_push(&face->making->placed,
                      ((WrFontPlaced){ glyph, advance, 0, 0, chars->byte[i], 1 }));
    }
}

/* ---- faces ---- */

/* Reading fonts, in any process: unpacking, then opening by format. */

typedef struct Opened {
    WrFontFace faces[WR_FONT_FILES];
    uint8_t *unpacked[WR_FONT_FILES]; /* owned */
    int count;
} Opened;

/* Allocates the table of `count` glyphs, all unknown. */
static void font_face_expect(WrFontFace *face, int count)
{
    wr_array_reserve(&face->known, count);
    face->known.count = count;
    memset(face->known.data, 0, (size_t)count * sizeof *face->known.data);
}

/* PSF, version 1 or 2, which FreeType does not read. bytes: [4] */
static bool is_console_font(const uint8_t *bytes)
{
    return memcmp(bytes, "\x36\x04", 2) == 0 || memcmp(bytes, "\x72\xb5\x4a\x86", 4) == 0;
}

/* Opens the next file. */
static bool open_file(Opened *all, const WrFontFile *file, WrFontMaking *making,
                      const WrFontRequest *ask, WrError *err)
{
    WrFontFace *face = &all->faces[all->count];
    WrFontFile in = *file;
    *face = (WrFontFace){ .making = making, .ask = ask, .font = all->count };
    if (in.length >= 4 && in.bytes[0] == 0x1f && in.bytes[1] == 0x8b) {
        uint8_t **unpacked = &all->unpacked[all->count];
        if (!wr_font_gunzip(file->bytes, file->length, WR_FONT_FILE_MAX, unpacked, &in.length, err))
            return false;
        in.bytes = *unpacked;
    }
    if (in.length < 4) return wr_fail(err, "is not a readable font");
    if (is_console_font(in.bytes))
        return wr_fail(err, "is a font of the text console (PSF), which cannot be read; use the "
                            "same font as PCF, OTB or "
                            "BDF, such as Terminus in Debian's package xfonts-terminus");
    const bool good = font_open_free(face, in.bytes, in.length, err);
    if (good) all->count++;
    return good;
}

/* Rejects damaged glyphs, which have no outline data. */
static bool check_placed(const WrFontMaking *making, WrError *err)
{
    for (int i = 0; i < making->placed.count; i++)
        if (making->placed.data[i].glyph < 0)
            return wr_fail(err,
                           "has coloured bitmaps or bitmaps of a wrong size, which cannot be used");
    return true;
}

static bool font_parts(WrFontFace *faces, int count, WrError *err);

bool wr_font_shape_text(const WrFontFile *files, int count, const WrFontRequest *ask, WrText *block,
                        WrError *err)
{
    WrFontMaking making = { 0 };
    Opened all = { .count = 0 };
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        good = open_file(&all, &files[i], &making, ask, err);
        if (!good && i > 0) wr_error_prefix(err, "fallback font %d: ", i);
    }
    if (good) {
        making.head = all.faces[0].head;
        good = font_parts(all.faces, all.count, err) && check_placed(&making, err);
    }
    if (good) wr_font_pack(&making, block);
    for (int i = 0; i < all.count; i++) all.faces[i].close(&all.faces[i]);
    for (int i = 0; i < WR_FONT_FILES; i++) wr_free(all.unpacked[i]);
    wr_font_making_fini(&making);
    return good;
}

/* ---- packed glyphs ---- */

/* Serialisation of a shaped text as one block, and checks of an untrusted block. */

#define COORDINATE_MAX (1 << 23) /* half units */
#define DOTS_MAX 4096            /* side of a bitmap glyph in dots */

void wr_font_making_fini(WrFontMaking *making)
{
    wr_array_free(&making->lines);
    wr_array_free(&making->placed);
    wr_array_free(&making->glyphs);
    wr_array_free(&making->points);
    wr_array_free(&making->missing);
    wr_array_free(&making->verbs);
    wr_array_free(&making->bytes);
}

void wr_font_text_fini(WrFontText *text)
{
    wr_free(text->block);
    *text = (WrFontText){ 0 };
}

/* ---- packing ---- */

static void add(WrText *out, const void *data, int count, size_t size)
{
    if (count > 0) wr_text_add_n(out, data, (size_t)count * size);
}

/* The block crosses the boundary of the sandboxed reader process: WrFontHead with the counts, then the arrays in this order
   without padding. The receiver treats every number in it as hostile (wr_font_unpack). */
void wr_font_pack(const WrFontMaking *making, WrText *out)
{
    WrFontHead head = making->head;
    head.lines = making->lines.count;
    head.placed = making->placed.count;
    head.glyphs = making->glyphs.count;
    head.points = making->points.count;
    head.missing = making->missing.count;
    head.verbs = making->verbs.count;
    head.bytes = making->bytes.count;
    add(out, &head, 1, sizeof head);
    add(out, making->lines.data, head.lines, sizeof *making->lines.data);
    add(out, making->placed.data, head.placed, sizeof *making->placed.data);
    add(out, making->glyphs.data, head.glyphs, sizeof *making->glyphs.data);
    add(out, making->points.data, head.points, sizeof *making->points.data);
    add(out, making->missing.data, head.missing, sizeof *making->missing.data);
    add(out, making->verbs.data, head.verbs, 1);
    add(out, making->bytes.data, head.bytes, 1);
}

/* ---- checking ---- */

static bool within(int32_t x, int32_t most)
{
    return x >= -most && x <= most;
}

/* True if `count` items from `first` lie within `all`. */
static bool part_of(int32_t first, int32_t count, int32_t all)
{
    return first >= 0 && count >= 0 && first <= all && count <= all - first;
}

static bool check_head(const WrFontHead *h)
{
    return (h->bitmap == 0 || h->bitmap == 1) && h->units >= 1 && h->units <= 16384 &&
           within(h->ascent, 1 << 17) && within(h->descent, 1 << 17) && within(h->line, 1 << 18) &&
           h->lines >= 1 && h->lines <= WR_FONT_TEXT_MAX + 1 && h->placed >= 0 &&
           h->placed <= PLACED_MAX && h->glyphs >= 0 && h->glyphs <= 65536 * 2 && h->points >= 0 &&
           h->points <= WR_FONT_POINTS_MAX && h->missing >= 0 &&
           h->missing <= WR_FONT_MISSING_MAX && h->verbs >= 0 && h->verbs <= WR_FONT_POINTS_MAX &&
           h->bytes >= 0 && h->bytes <= WR_FONT_FILE_MAX;
}

static size_t block_size(const WrFontHead *h)
{
    return sizeof *h + (size_t)h->lines * sizeof(WrFontLine) +
           (size_t)h->placed * sizeof(WrFontPlaced) + (size_t)h->glyphs * sizeof(WrFontGlyph) +
           (size_t)h->points * sizeof(WrFontPoint) + (size_t)h->missing * sizeof(uint32_t) +
           (size_t)h->verbs + (size_t)h->bytes;
}

/* The verbs must begin with a move and use exactly the glyph's points. */
static bool check_verbs(const WrFontText *text, const WrFontGlyph *g)
{
    static const int32_t takes[] = { 1, 1, 2, 3 };
    int64_t points = 0;
    for (int32_t i = 0; i < g->verb_count; i++) {
        uint8_t verb = text->verbs[g->first_verb + i];
        if (verb > WR_FONT_CUBIC || (i == 0 && verb != WR_FONT_MOVE)) return false;
        points += takes[verb];
    }
    return points == g->point_count;
}

static bool check_glyph(const WrFontText *text, const WrFontGlyph *g)
{
    if (!part_of(g->first_verb, g->verb_count, text->verb_count) ||
        !part_of(g->first_point, g->point_count, text->point_count) || !check_verbs(text, g))
        return false;
    if (g->units < 1 || g->units > 16384 || g->font < 0 || g->font >= WR_FONT_FILES) return false;
    if (!within(g->left, 1 << 16) || !within(g->top, 1 << 16) || g->width < 0 || g->height < 0 ||
        g->width > DOTS_MAX || g->height > DOTS_MAX)
        return false;
    return part_of(g->first_byte, (g->width + 7) / 8 * g->height, text->byte_count);
}

static bool check_packed(const WrFontText *text, const WrFontPlaced *p, size_t text_length)
{
    return p->glyph >= 0 && p->glyph < text->glyph_count && within(p->advance, 1 << 18) &&
           within(p->dx, 1 << 18) && within(p->dy, 1 << 18) && p->cluster >= 0 &&
           (size_t)p->cluster <= text_length && (p->spaced == 0 || p->spaced == 1);
}

static bool check_parts(const WrFontText *text, size_t text_length)
{
    int32_t next = 0;
    for (int32_t i = 0; i < text->line_count; i++) {
        const WrFontLine *line = &text->lines[i];
        if (line->first != next || !part_of(line->first, line->count, text->placed_count) ||
            (line->leftwards != 0 && line->leftwards != 1))
            return false;
        next += line->count;
    }
    if (next != text->placed_count) return false;
    for (int32_t i = 0; i < text->placed_count; i++)
        if (!check_packed(text, &text->placed[i], text_length)) return false;
    for (int32_t i = 0; i < text->glyph_count; i++)
        if (!check_glyph(text, &text->glyphs[i])) return false;
    for (int32_t i = 0; i < text->point_count; i++)
        if (!within(text->points[i].x, COORDINATE_MAX) ||
            !within(text->points[i].y, COORDINATE_MAX))
            return false;
    for (int32_t i = 0; i < text->missing_count; i++)
        if (text->missing[i] > 0x10ffff) return false;
    return true;
}

bool wr_font_unpack(char *block, size_t length, size_t text_length, WrFontText *out)
{
    WrFontHead h;
    if (length < sizeof h) return false;
    memcpy(&h, block, sizeof h);
    if (!check_head(&h) || block_size(&h) != length) return false;
    WrFontText text = { .bitmap = h.bitmap != 0,
                        .units = h.units,
                        .ascent = h.ascent,
                        .descent = h.descent,
                        .line = h.line,
                        .line_count = h.lines,
                        .placed_count = h.placed,
                        .glyph_count = h.glyphs,
                        .verb_count = h.verbs,
                        .point_count = h.points,
                        .byte_count = h.bytes,
                        .missing_count = h.missing };
    text.lines = (const void *)(block + sizeof h);
    text.placed = (const void *)(text.lines + h.lines);
    text.glyphs = (const void *)(text.placed + h.placed);
    text.points = (const void *)(text.glyphs + h.glyphs);
    text.missing = (const void *)(text.points + h.points);
    text.verbs = (const void *)(text.missing + h.missing);
    text.bytes = text.verbs + h.verbs;
    if (!check_parts(&text, text_length)) return false;
    text.block = block;
    *out = text;
    return true;
}

/* ---- runs of one script ---- */

/* Splits lines into parts of one direction, one script and one font. */

typedef struct Parts {
    WrFontFace *faces;
    int count;
    WR_ARRAY(uint8_t) owner; /* font of each character of a line */
} Parts;

/* ---- choice of fonts ---- */

/* The first font that has all of code[first..end), or -1. */
static int font_of(const Parts *parts, const uint32_t *code, int first, int end)
{
    for (int f = 0; f < parts->count; f++) {
        int i = first;
        while (i < end && parts->faces[f].has(&parts->faces[f], code[i])) i++;
        if (i == end) return f;
    }
    return -1;
}

static bool is_mark(hb_unicode_general_category_t is)
{
    return is == HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK ||
           is == HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK ||
           is == HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK;
}

/* Joiners and other invisible characters use the font of the preceding character; marks use that of
 * their base, if necessary in another font that has all of them. */
static void choose_fonts(Parts *parts, const WrFontChars *chars)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    int base = 0; /* base character of the marks */
    parts->owner.count = 0;
    for (int i = 0; i < chars->count; i++) {
        hb_unicode_general_category_t is = hb_unicode_general_category(unicode, chars->code[i]);
        int before = i > 0 ? parts->owner.data[i - 1] : -1, font;
        if (before >= 0 && is == HB_UNICODE_GENERAL_CATEGORY_FORMAT) {
            font = before;
        } else if (before >= 0 && is_mark(is)) {
            font = before;
            if (!parts->faces[before].has(&parts->faces[before], chars->code[i])) {
                int whole = font_of(parts, chars->code, base, i + 1);
                for (int k = base; k < i && whole >= 0; k++) parts->owner.data[k] = (uint8_t)whole;
                font = whole >= 0 ? whole : before;
            }
        } else {
            base = i;
            font = font_of(parts, chars->code, i, i + 1);
        }
        wr_array_push(&parts->owner, (uint8_t)(font < 0 ? 0 : font));
    }
}

/* ---- choice of scripts ---- */

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

/* End of the part that begins at `i`: before the first character of another script. */
static int script_end(const WrFontChars *chars, int i, int end, hb_script_t script)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    for (; i < end; i++) {
        hb_script_t is = hb_unicode_script(unicode, chars->code[i]);
        if (!is_plain_script(is) && is != script) return i;
    }
    return end;
}

/* ---- parts ---- */

typedef struct Part {
    int from, count, font;
    hb_script_t script;
} Part;

/* The parts of a leftward run are ordered from right to left. */
static bool shape_run(Parts *parts, const WrFontChars *chars, const WrFontRun *run, WrError *err)
{
    WR_ARRAY(Part) list = { 0 };
    int end = run->first + run->count;
    bool good = true;
    for (int i = run->first; i < end;) {
        hb_script_t script = script_from(chars, i, end);
        int stop = script_end(chars, i, end, script);
        for (int from = i; from < stop; from = i) {
            int font = parts->owner.data[from];
            while (i < stop && parts->owner.data[i] == font) i++;
            wr_array_push(&list, ((Part){ from, i - from, font, script }));
        }
    }
    for (int k = 0; k < list.count && good; k++) {
        Part p = list.data[run->leftwards ? list.count - 1 - k : k];
        WrFontFace *face = &parts->faces[p.font];
        good = face->shape(face, chars, p.from, p.count, run->leftwards, p.script, err);
    }
    wr_array_free(&list);
    return good;
}

static bool shape_line(void *ctx, const WrFontChars *chars, const WrFontRun *runs, int run_count,
                       WrError *err)
{
    Parts *parts = ctx;
    choose_fonts(parts, chars);
    for (int i = 0; i < run_count; i++)
        if (!shape_run(parts, chars, &runs[i], err)) return false;
    return true;
}

/* Shapes the text with open fonts, each part with the first one that contains it. */
static bool font_parts(WrFontFace *faces, int count, WrError *err)
{
    Parts parts = { .faces = faces, .count = count };
    bool good = font_lines(faces[0].making, faces[0].ask, shape_line, &parts, err);
    wr_array_free(&parts.owner);
    return good;
}
