/* Fonts: against FreeType itself, against fonts defined here dot by dot, and against Unicode's rules for scripts. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "image/font_internal.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <zlib.h>

#define SANS "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
#define DEVANAGARI "/usr/share/fonts/truetype/lohit-devanagari/Lohit-Devanagari.ttf"
#define TERMINUS "/usr/share/fonts/X11/misc/ter-u16n_unicode.pcf.gz"

static WrFontText shaped(const char *path, const char *text)
{
    WrError err = { "" };
    WrFontText out = { 0 };
    WrFontRequest ask = { .text = text };
    if (!wr_font_shape(path, &ask, &out, &err)) fail_msg("%s", err.text);
    return out;
}

static WrFontText shaped_bytes(const void *bytes, size_t length, const char *text)
{
    WrError err = { "" };
    WrFontText out = { 0 };
    WrFontRequest ask = { .text = text };
    if (!wr_font_shape_bytes("made", bytes, length, &ask, &out, &err)) fail_msg("%s", err.text);
    return out;
}

/* Twice the signed area of all polygons. */
static double area2(const WrFontOutline *o)
{
    double sum = 0.0;
    for (int c = 0; c < o->first.count; c++) {
        int first = o->first.data[c];
        int end = c + 1 < o->first.count ? o->first.data[c + 1] : o->xy.count / 2;
        for (int i = first; i < end; i++) {
            int k = i + 1 < end ? i + 1 : first;
            sum += o->xy.data[2 * i] * o->xy.data[2 * k + 1] -
                   o->xy.data[2 * k] * o->xy.data[2 * i + 1];
        }
    }
    return sum;
}

static bool inside(const WrFontOutline *o, double x, double y)
{
    int winding = 0;
    for (int c = 0; c < o->first.count; c++) {
        int first = o->first.data[c];
        int end = c + 1 < o->first.count ? o->first.data[c + 1] : o->xy.count / 2;
        for (int i = first; i < end; i++) {
            int k = i + 1 < end ? i + 1 : first;
            const double *a = &o->xy.data[2 * i], *b = &o->xy.data[2 * k];
            if ((a[1] <= y) == (b[1] <= y)) continue;
            if (a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) > x)
                winding += b[1] > a[1] ? 1 : -1;
        }
    }
    return winding != 0;
}

/* ---- bitmaps ---- */

static void dots_of_a_pcf_font_are_freetypes_own_bit_for_bit(void **state)
{
    (void)state;
    FT_Library library;
    FT_Face face;
    assert_int_equal(FT_Init_FreeType(&library), 0);
    assert_int_equal(FT_New_Face(library, TERMINUS, 0, &face), 0);
    for (unsigned c = '!'; c < 0x17f; c++) {
        char utf8[3] = { (char)c };
        if (c >= 0x7f && c < 0xa1) continue;
        if (c >= 0x80) utf8[0] = (char)(0xc0 | c >> 6), utf8[1] = (char)(0x80 | (c & 63));
        WrFontText text = shaped(TERMINUS, utf8);
        assert_true(text.bitmap);
        assert_int_equal(text.placed_count, 1);
        assert_int_equal(FT_Load_Char(face, c, FT_LOAD_DEFAULT), 0);
        const FT_Bitmap *b = &face->glyph->bitmap;
        const WrFontGlyph *g = &text.glyphs[0];
        assert_int_equal(g->width, b->width);
        assert_int_equal(g->height, b->rows);
        assert_int_equal(g->left, face->glyph->bitmap_left);
        assert_int_equal(g->top, face->glyph->bitmap_top);
        assert_int_equal(text.placed[0].advance, face->glyph->advance.x / 64);
        for (int y = 0; y < g->height; y++)
            for (int x = 0; x < g->width; x++)
                assert_int_equal(wr_font_dot(&text, g, x, y),
                                 (b->buffer[y * b->pitch + x / 8] >> (7 - x % 8)) & 1);
        wr_font_text_fini(&text);
    }
    FT_Done_Face(face);
    FT_Done_FreeType(library);
}

static const char bdf[] =
    "STARTFONT 2.1\nFONT -made-here-medium-r-normal--5-50-75-75-c-40-iso10646-1\nSIZE 5 75 75\n"
    "FONTBOUNDINGBOX 4 5 0 -1\nSTARTPROPERTIES 2\nFONT_ASCENT 4\nFONT_DESCENT 1\nENDPROPERTIES\n"
    "CHARS 2\nSTARTCHAR A\nENCODING 65\nSWIDTH 800 0\nDWIDTH 4 0\nBBX 3 4 0 0\nBITMAP\n40\nA0\nE0\n"
    "A0\nENDCHAR\nSTARTCHAR j\nENCODING 106\nSWIDTH 600 0\nDWIDTH 3 0\nBBX 2 5 0 "
    "-1\nBITMAP\n40\n00\n"
    "40\n40\n80\nENDCHAR\nENDFONT\n";

static size_t pack_gzip(const void *bytes, size_t length, uint8_t *out, size_t room)
{
    z_stream z = { .next_in = (Bytef *)(uintptr_t)bytes, .avail_in = (uInt)length };
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
    z.next_out = out;
    z.avail_out = (uInt)room;
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    deflateEnd(&z);
    return z.total_out;
}

static void a_bdf_font_is_read_plain_and_packed(void **state)
{
    (void)state;
    static const char *const rows[2][5] = { { " #", "# #", "###", "# #", "" },
                                            { " #", "", " #", " #", "#" } };
    uint8_t packed[2000];
    size_t length = pack_gzip(bdf, sizeof bdf - 1, packed, sizeof packed);
    for (int way = 0; way < 2; way++) {
        WrFontText text =
            way ? shaped_bytes(packed, length, "Aj") : shaped_bytes(bdf, sizeof bdf - 1, "Aj");
        assert_int_equal(text.placed_count, 2);
        assert_int_equal(text.ascent, 4);
        assert_int_equal(text.descent, 1);
        assert_int_equal(text.placed[0].advance, 4);
        assert_int_equal(text.placed[1].advance, 3);
        assert_int_equal(text.glyphs[0].top, 4);
        assert_int_equal(text.glyphs[1].height - text.glyphs[1].top, 1);
        for (int g = 0; g < 2; g++)
            for (int y = 0; y < 5; y++)
                for (int x = 0; x < 4; x++)
                    assert_int_equal(wr_font_dot(&text, &text.glyphs[g], x, y),
                                     x < (int)strlen(rows[g][y]) && rows[g][y][x] == '#');
        wr_font_text_fini(&text);
    }
}

/* Every set dot of a noise pattern, touching corners included, is inside the outline and every other outside, and the
 * areas are equal. */
static void the_outline_of_dots_has_their_area_and_their_inside(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int width = 1; width <= 19; width += 3) {
        WrError err = { "" };
        WrFontText text = { 0 };
        WrFontMaking making = { .head = { 1, 11, 9, 2, 11, 0, 0, 0, 0, 0, 0, 0 } };
        WrText block = { 0 };
        for (int i = 0; i < (width + 7) / 8 * 11; i++)
            wr_array_push(&making.bytes, (uint8_t)test_random_u64(&random));
        wr_array_push(
            &making.glyphs,
            ((WrFontGlyph){ .units = 11, .left = -2, .top = 7, .width = width, .height = 11 }));
        wr_array_push(&making.lines, ((WrFontLine){ 0, 0, 0 }));
        wr_font_pack(&making, &block);
        assert_true(wr_font_unpack(block.data, block.length, 0, &text));
        WrFontOutline o = { 0 };
        assert_true(wr_font_glyph_outline(&text, 0, 3.0, 10.0, 20.0, 0.1, &o, &err));
        int dots = 0;
        for (int y = 0; y < 11; y++)
            for (int x = 0; x < width; x++) {
                bool on = wr_font_dot(&text, &text.glyphs[0], x, y);
                dots += on;
                assert_int_equal(inside(&o, 10.0 + 3.0 * (x - 2 + 0.5), 20.0 + 3.0 * (7 - y - 0.5)),
                                 on);
            }
        assert_near(fabs(area2(&o)), 2.0 * 9.0 * dots, 1e-9);
        wr_font_outline_fini(&o);
        wr_font_text_fini(&text);
        wr_font_making_fini(&making);
    }
}

/* ---- outlines ---- */

/* Green's theorem on each quadratic curve: twice its area to the origin is
 * 2/3 p0 x p1 + 2/3 p1 x p2 + 1/3 p0 x p2. */
static double exact_area2(const WrFontText *t, const WrFontGlyph *g)
{
    double sum = 0.0, x = 0, y = 0, start_x = 0, start_y = 0;
    const WrFontPoint *p = t->points + g->first_point;
    for (int i = 0; i < g->verb_count; i++) {
        int verb = t->verbs[g->first_verb + i];
        if (verb == WR_FONT_MOVE) {
            sum += x * start_y - start_x * y;
            start_x = p->x;
            start_y = p->y;
        } else if (verb == WR_FONT_LINE) {
            sum += x * p->y - p->x * y;
        } else {
            assert_int_equal(verb, WR_FONT_CONIC);
            sum += (2.0 * (x * p->y - p->x * y) +
                    2.0 * ((double)p->x * p[1].y - (double)p[1].x * p->y) +
                    (x * p[1].y - p[1].x * y)) /
                   3.0;
            p++;
        }
        x = p->x;
        y = p->y;
        p++;
    }
    return (sum + x * start_y - start_x * y) / 4.0; /* of points in half units */
}

static void straightened_curves_keep_their_area_to_second_order(void **state)
{
    (void)state;
    WrFontText text = shaped(SANS, "&");
    double exact = exact_area2(&text, &text.glyphs[0]), wrong[2];
    for (int k = 0; k < 2; k++) {
        WrError err = { "" };
        WrFontOutline o = { 0 };
        assert_true(wr_font_glyph_outline(&text, 0, 1.0, 7.0, -3.0, k ? 0.25 : 4.0, &o, &err));
        wrong[k] = fabs(area2(&o) - exact);
        wr_font_outline_fini(&o);
    }
    assert_true(wrong[0] < 4.0 * 2.0 * 2048 * 12); /* tolerance times length, twice */
    assert_true(wrong[1] < wrong[0] / 8.0);        /* a 16th of the tolerance */
    assert_true(wrong[1] > 0.0);
    wr_font_text_fini(&text);
}

static void advances_and_outlines_are_in_the_fonts_units(void **state)
{
    (void)state;
    WrFontText text = shaped(SANS, "l");
    FT_Library library;
    FT_Face face;
    assert_int_equal(FT_Init_FreeType(&library), 0);
    assert_int_equal(FT_New_Face(library, SANS, 0, &face), 0);
    assert_int_equal(FT_Load_Char(face, 'l', FT_LOAD_NO_SCALE), 0);
    assert_int_equal(text.units, face->units_per_EM);
    assert_int_equal(text.placed[0].advance, face->glyph->metrics.horiAdvance);
    assert_int_equal(face->glyph->outline.n_points, 4); /* a rectangle, closed by its first point */
    assert_int_equal(text.point_count, 5);
    for (int i = 0; i < 4; i++) {
        bool found = false;
        for (int k = 0; k < 4; k++)
            found = found || (text.points[i].x == 2 * face->glyph->outline.points[k].x &&
                              text.points[i].y == 2 * face->glyph->outline.points[k].y);
        assert_true(found);
    }
    FT_Done_Face(face);
    FT_Done_FreeType(library);
    wr_font_text_fini(&text);
}

/* ---- scripts ---- */

static void arabic_letters_join_and_run_from_right_to_left(void **state)
{
    (void)state;
    WrFontText one = shaped(SANS, "\xd8\xa8"), three = shaped(SANS, "\xd8\xa8\xd8\xa8\xd8\xa8");
    assert_int_equal(three.placed_count, 3);
    assert_int_equal(three.lines[0].leftwards, 1);
    assert_int_equal(three.placed[0].cluster, 4);
    assert_int_equal(three.placed[2].cluster, 0);
    uint32_t ids[3];
    for (int i = 0; i < 3; i++) ids[i] = three.glyphs[three.placed[i].glyph].id;
    assert_true(ids[0] != ids[1] && ids[1] != ids[2] && ids[0] != ids[2]);
    assert_true(one.glyphs[0].id != ids[1]);
    wr_font_text_fini(&one);
    wr_font_text_fini(&three);
}

/* "ab" Hebrew "cd": in a left-to-right line only the Hebrew part is reversed; in a right-to-left line the Latin parts
 * are exchanged. */
static void mixed_directions_follow_unicodes_order(void **state)
{
    (void)state;
    static const char text[] = "ab \xd7\x90\xd7\x91 cd";
    static const int rightwards[] = { 0, 1, 2, 5, 3, 7, 8, 9 };
    static const int leftwards[] = { 8, 9, 7, 5, 3, 2, 0, 1 };
    for (int way = 1; way <= 2; way++) {
        WrError err = { "" };
        WrFontText t = { 0 };
        WrFontRequest ask = { .text = text, .direction = (WrFontDirection)way };
        assert_true(wr_font_shape(SANS, &ask, &t, &err));
        assert_int_equal(t.placed_count, 8);
        for (int i = 0; i < 8; i++)
            assert_int_equal(t.placed[i].cluster, way == 1 ? rightwards[i] : leftwards[i]);
        wr_font_text_fini(&t);
    }
}

/* The vowel sign i is written before its consonant though spoken after it, and ksha is one glyph. */
static void devanagari_is_reordered_and_ligated(void **state)
{
    (void)state;
    WrFontText k = shaped(DEVANAGARI, "\xe0\xa4\x95"),
               ki = shaped(DEVANAGARI, "\xe0\xa4\x95\xe0\xa4\xbf");
    WrFontText ksha = shaped(DEVANAGARI, "\xe0\xa4\x95\xe0\xa5\x8d\xe0\xa4\xb7");
    assert_int_equal(ki.placed_count, 2);
    assert_int_equal(ki.glyphs[ki.placed[1].glyph].id, k.glyphs[k.placed[0].glyph].id);
    assert_int_equal(ksha.placed_count, 1);
    assert_int_equal(ksha.missing_count, 0);
    wr_font_text_fini(&k);
    wr_font_text_fini(&ki);
    wr_font_text_fini(&ksha);
}

static void missing_characters_are_told_once_and_drawn(void **state)
{
    (void)state;
    WrFontText text = shaped(DEVANAGARI, "\xe4\xb8\xad\xe4\xb8\xad\xe6\x96\x87");
    assert_int_equal(text.missing_count, 2);
    assert_int_equal(text.missing[0], 0x4e2d);
    assert_int_equal(text.missing[1], 0x6587);
    assert_int_equal(text.placed_count, 3);
    assert_true(text.glyphs[text.placed[0].glyph].verb_count > 0);
    wr_font_text_fini(&text);
}

static void what_is_not_utf8_becomes_replacement_characters(void **state)
{
    (void)state;
    static const char *const bad[] = { "\xff", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                                       "\xe2\x82" };
    static const int counts[] = { 1, 2, 3, 4, 2 };
    for (int i = 0; i < 5; i++) {
        size_t at = 0, length = strlen(bad[i]);
        int count = 0;
        for (; at < length; count++)
            assert_int_equal(wr_font_character(bad[i], length, &at), 0xfffd);
        assert_int_equal(count, counts[i]);
        WrFontText text = shaped(SANS, bad[i]);
        assert_int_equal(text.placed_count, counts[i]);
        wr_font_text_fini(&text);
    }
    /* a stray byte is lost alone, whatever follows */
    WrFontText text = shaped(SANS, "\x80"
                                   "continued for long");
    assert_int_equal(text.placed_count, 19);
    wr_font_text_fini(&text);
}

/* ---- places ---- */

static void lines_are_aligned_and_spaced_as_asked(void **state)
{
    (void)state;
    WrFontText text = shaped(TERMINUS, "ab\nabcd\r\n");
    assert_int_equal(text.line_count, 3);
    assert_int_equal(text.placed_count, 6);
    double place[6][2];
    for (int align = 0; align < 3; align++) {
        WrFontSetting setting = { 32.0, 1.5, 2.0, (WrFontAlign)align };
        assert_near(wr_font_place(&text, &setting, place), 4 * 16 + 3 * 1.5, 0);
        double short_line = 2 * 16 + 1.5, part = 0.5 * align;
        assert_near(place[0][0], -part * short_line, 1e-12);
        assert_near(place[1][0] - place[0][0], 17.5, 1e-12);
        assert_near(place[2][0], -part * (4 * 16 + 3 * 1.5), 1e-12);
        assert_near(place[0][1], 0.0, 0);
        assert_near(place[2][1], -2.0 * 32.0, 0);
    }
    wr_font_text_fini(&text);
}

/* ---- untrusted fonts ---- */

static void refused(const char *name, const void *bytes, size_t length, const char *word)
{
    WrError err = { "" };
    WrFontText text = { .units = 77 };
    WrFontRequest ask = { .text = "Ag" };
    if (wr_font_shape_bytes(name, bytes, length, &ask, &text, &err)) fail_msg("%s: read", name);
    if (!strstr(err.text, word)) fail_msg("%s", err.text);
    assert_int_equal(text.units, 77);
}

static void what_is_no_font_is_refused_with_a_reason(void **state)
{
    (void)state;
    static uint8_t zeros[1 << 20], packed[1 << 16];
    WrError err = { "" };
    WrFontText text = { 0 };
    WrFontRequest ask = { .text = "A" };
    refused("words", "this is no font at all", 22, "not a readable font");
    refused("zeros", zeros, sizeof zeros, "not a readable font");
    refused("empty", zeros, 0, "empty");
    refused("short gzip", "\x1f\x8b\x08", 3, "not a readable font");
    refused("bad gzip", "\x1f\x8b\x08\0\0\0\0\0\0\0junk", 14, "gzip");
    refused("psf 1", "\x36\x04\x02\x10", 4, "xfonts-terminus");
    refused("psf 2", "\x72\xb5\x4a\x86", 4, "xfonts-terminus");
    size_t length = pack_gzip(zeros, sizeof zeros, packed, sizeof packed);
    refused("packed zeros", packed, length, "not a readable font");
    assert_false(wr_font_shape("/usr/share/fonts", &ask, &text, &err));
    assert_non_null(strstr(err.text, "folder"));
    assert_false(wr_font_shape("/nonexistent.ttf", &ask, &text, &err));
    assert_non_null(strstr(err.text, "/nonexistent.ttf"));
}

static void unpacking_stops_at_its_limit(void **state)
{
    (void)state;
    static uint8_t zeros[1 << 20], packed[1 << 16];
    WrError err = { "" };
    uint8_t *out = NULL;
    size_t count = 0, length = pack_gzip(zeros, sizeof zeros, packed, sizeof packed);
    assert_false(wr_font_gunzip(packed, length, sizeof zeros - 1, &out, &count, &err));
    assert_non_null(strstr(err.text, "more than"));
    assert_true(wr_font_gunzip(packed, length, sizeof zeros, &out, &count, &err));
    assert_int_equal(count, sizeof zeros);
    wr_free(out);
}

static void a_text_that_is_too_long_is_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    WrFontText text = { 0 };
    char *million = wr_alloc(1000001, 1);
    memset(million, 'a', 1000000);
    WrFontRequest ask = { .text = million };
    assert_false(wr_font_shape(TERMINUS, &ask, &text, &err));
    assert_non_null(strstr(err.text, "1000000 bytes: must be up to 262144"));
    wr_free(million);
}

/* Truncated anywhere and with changed bytes: refused or read, and the process survives. */
static void damaged_fonts_do_no_harm(void **state)
{
    (void)state;
    WrError err = { "" };
    char *bytes;
    size_t length;
    TestRandom random = { 11 };
    assert_true(wr_file_read(DEVANAGARI, 1 << 24, &bytes, &length, &err));
    for (int i = 0; i < 30; i++) {
        WrFontText text = { 0 };
        WrFontRequest ask = { .text = "\xe0\xa4\x95\xe0\xa4\xbf Ag" };
        size_t keep = i % 2 ? length : (size_t)(test_random(&random) * (double)length) + 1;
        for (int k = 0; k < 20; k++)
            bytes[(size_t)(test_random(&random) * 3000.0)] = (char)test_random_u64(&random);
        err.text[0] = '\0';
        if (wr_font_shape_bytes("damaged", bytes, keep, &ask, &text, &err))
            wr_font_text_fini(&text);
        else assert_true(err.text[0] != '\0');
    }
    wr_free(bytes);
    WrFontText good = shaped(SANS, "still there");
    wr_font_text_fini(&good);
}

/* A block with any changed bytes is refused, or can be traversed completely. */
static void answers_are_checked_number_by_number(void **state)
{
    (void)state;
    WrError err = { "" };
    WrText block = { 0 };
    WrFontRequest ask = { .text = "O\ni" };
    char *bytes;
    size_t length;
    TestRandom random = { 3 };
    int refusals = 0, taken = 0;
    assert_true(wr_file_read(SANS, 1 << 24, &bytes, &length, &err));
    const WrFontFile file = { (const uint8_t *)bytes, length };
    assert_true(wr_font_shape_text(&file, 1, &ask, &block, &err));
    for (int i = 0; i < 4000; i++) {
        char *copy = wr_alloc(block.length, 1);
        memcpy(copy, block.data, block.length);
        size_t at = (size_t)(test_random(&random) * (double)block.length);
        copy[at] = (char)test_random_u64(&random);
        WrFontText text = { 0 };
        if (!wr_font_unpack(copy, block.length, 3, &text)) {
            refusals++;
            wr_free(copy);
            continue;
        }
        taken++;
        WrFontOutline o = { 0 };
        WrFontSetting setting = { 20.0, 0.0, 1.0, WR_FONT_LEFT };
        assert_true(wr_font_outline(&text, &setting, 0.1, &o, &err));
        wr_font_outline_fini(&o);
        wr_font_text_fini(&text);
    }
    assert_true(refusals > 500 && taken > 100);
    assert_false(wr_font_unpack(block.data, block.length - 1, 3, &(WrFontText){ 0 }));
    wr_text_fini(&block);
    wr_free(bytes);
}

static void the_named_fonts_are_there_and_bitmaps_fit_the_size(void **state)
{
    (void)state;
    for (int i = 0; wr_font_names[i]; i++) {
        WrError err = { "" };
        char *path = wr_font_find(i, 32.0, &err);
        if (!path) fail_msg("%s", err.text);
        WrFontText text = shaped(path, "A");
        assert_int_equal(text.bitmap, i < 2);
        assert_int_equal(text.missing_count, 0);
        wr_font_text_fini(&text);
        wr_free(path);
    }
    static const double sizes[] = { 64, 48, 60, 13, 5, 33, 56 };
    static const int dots[] = { 32, 24, 20, 12, 12, 32, 28 };
    for (int i = 0; i < 7; i++) {
        WrError err = { "" };
        char *path = wr_font_find(0, sizes[i], &err), want[16];
        snprintf(want, sizeof want, "ter-u%d", dots[i]);
        if (!strstr(path, want)) fail_msg("%g: %s", sizes[i], path);
        wr_free(path);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dots_of_a_pcf_font_are_freetypes_own_bit_for_bit),
        cmocka_unit_test(a_bdf_font_is_read_plain_and_packed),
        cmocka_unit_test(the_outline_of_dots_has_their_area_and_their_inside),
        cmocka_unit_test(straightened_curves_keep_their_area_to_second_order),
        cmocka_unit_test(advances_and_outlines_are_in_the_fonts_units),
        cmocka_unit_test(arabic_letters_join_and_run_from_right_to_left),
        cmocka_unit_test(mixed_directions_follow_unicodes_order),
        cmocka_unit_test(devanagari_is_reordered_and_ligated),
        cmocka_unit_test(missing_characters_are_told_once_and_drawn),
        cmocka_unit_test(what_is_not_utf8_becomes_replacement_characters),
        cmocka_unit_test(lines_are_aligned_and_spaced_as_asked),
        cmocka_unit_test(what_is_no_font_is_refused_with_a_reason),
        cmocka_unit_test(unpacking_stops_at_its_limit),
        cmocka_unit_test(a_text_that_is_too_long_is_refused),
        cmocka_unit_test(damaged_fonts_do_no_harm),
        cmocka_unit_test(answers_are_checked_number_by_number),
        cmocka_unit_test(the_named_fonts_are_there_and_bitmaps_fit_the_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
