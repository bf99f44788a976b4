/* Scripts and several fonts: every glyph and position against direct calls of HarfBuzz, missing letters against the
   fallback font, variable fonts against FreeType. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "image/font.h"
#include "system/path.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MULTIPLE_MASTERS_H
#include <hb-ot.h>

#define SANS "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
#define SERIF "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf"
#define INTER "/usr/share/fonts/opentype/inter/Inter-Regular.otf"
#define DEVANAGARI "/usr/share/fonts/truetype/lohit-devanagari/Lohit-Devanagari.ttf"
#define TERMINUS "/usr/share/fonts/X11/misc/ter-u16n_unicode.pcf.gz"

static WrFontText shaped(const char *path, const WrFontRequest *ask)
{
    WrError err = { "" };
    WrFontText out = { 0 };
    if (!wr_font_shape(path, ask, &out, &err)) fail_msg("%s", err.text);
    return out;
}

static uint32_t id_of(const WrFontText *text, int placed)
{
    return text->glyphs[text->placed[placed].glyph].id;
}

static int font_of(const WrFontText *text, int placed)
{
    return text->glyphs[text->placed[placed].glyph].font;
}

/* ---- against HarfBuzz ---- */

typedef struct Direct {
    hb_buffer_t *buffer;
    hb_glyph_info_t *info;
    hb_glyph_position_t *at;
    unsigned count;
} Direct;

static Direct directly(const char *path, const char *text, const char *language,
                       const hb_variation_t *axis)
{
    Direct d = { .buffer = hb_buffer_create() };
    hb_blob_t *blob = hb_blob_create_from_file(path);
    hb_face_t *face = hb_face_create(blob, 0);
    hb_font_t *font = hb_font_create(face);
    if (axis) hb_font_set_variations(font, axis, 1);
    hb_buffer_add_utf8(d.buffer, text, -1, 0, -1);
    hb_buffer_guess_segment_properties(d.buffer);
    hb_buffer_set_language(d.buffer,
                           language ? hb_language_from_string(language, -1) : HB_LANGUAGE_INVALID);
    hb_shape(font, d.buffer, NULL, 0);
    d.info = hb_buffer_get_glyph_infos(d.buffer, &d.count);
    d.at = hb_buffer_get_glyph_positions(d.buffer, NULL);
    hb_font_destroy(font);
    hb_face_destroy(face);
    hb_blob_destroy(blob);
    return d;
}

/* The glyphs from `first` on equal those of HarfBuzz; the text starts at `byte`. */
static void compare(const WrFontText *text, int first, const Direct *d, int byte)
{
    for (unsigned i = 0; i < d->count; i++) {
        const WrFontPlaced *p = &text->placed[first + (int)i];
        assert_int_equal(id_of(text, first + (int)i), d->info[i].codepoint);
        assert_int_equal(p->cluster, byte + (int)d->info[i].cluster);
        assert_int_equal(p->advance, d->at[i].x_advance);
        assert_int_equal(p->dx, d->at[i].x_offset);
        assert_int_equal(p->dy, d->at[i].y_offset);
    }
}

#define KSHATRIYA                                                                                  \
    "\xe0\xa4\x95\xe0\xa5\x8d\xe0\xa4\xb7\xe0\xa4\xa4\xe0\xa5\x8d\xe0\xa4\xb0\xe0\xa4\xbf\xe0\xa4" \
    "\xaf"
#define HINDI "\xe0\xa4\xb9\xe0\xa4\xbf\xe0\xa4\xa8\xe0\xa5\x8d\xe0\xa4\xa6\xe0\xa5\x80"
#define SALAM "\xd8\xb3\xd9\x84\xd8\xa7\xd9\x85"
#define MARHABA "\xd9\x85\xd8\xb1\xd8\xad\xd8\xa8\xd8\xa7"
#define SHALOM "\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d"

static void words_of_one_script_are_harfbuzzs_own_glyphs_at_its_places(void **state)
{
    (void)state;
    static const struct {
        const char *font, *text, *language;
        int fewer; /* glyphs than characters: joined or dropped */
    } words[] = {
        { SANS, SALAM, NULL, 1 }, /* lam and alef are one glyph */
        { SANS, MARHABA, NULL, 0 },
        { SANS, "\xd9\x84\xd9\x8e\xd8\xa7", "ar", 0 }, /* a mark on the lam */
        { SANS, SHALOM, NULL, 0 },
        { DEVANAGARI, KSHATRIYA, "hi", 4 },
        { DEVANAGARI, HINDI, NULL, 0 },
        { SERIF, "office waffle AVATAR To", NULL, 0 },
        { INTER, "AVATAR -> 12x30 (A)", NULL, 0 },
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        WrFontRequest ask = { .text = words[i].text, .language = words[i].language };
        WrFontText text = shaped(words[i].font, &ask);
        Direct d = directly(words[i].font, words[i].text, words[i].language, NULL);
        assert_int_equal(text.placed_count, d.count);
        assert_int_equal(text.missing_count, 0);
        compare(&text, 0, &d, 0);
        int characters = 0;
        for (const char *p = words[i].text; *p; p++) characters += (*p & 0xc0) != 0x80;
        if (words[i].fewer > 0) assert_true((int)d.count <= characters - words[i].fewer);
        hb_buffer_destroy(d.buffer);
        wr_font_text_fini(&text);
    }
}

/* True if the glyph reaches its left and its right end. */
static void reaches(const WrFontText *text, int placed, bool *left, bool *right)
{
    const WrFontGlyph *g = &text->glyphs[text->placed[placed].glyph];
    *left = *right = false;
    for (int i = 0; i < g->point_count; i++) {
        const WrFontPoint *p = &text->points[g->first_point + i];
        *left = *left || p->x <= 0;
        *right = *right || p->x >= 2 * text->placed[placed].advance;
    }
}

/* Joining: the last, the middle and the first letter of a word, from left to right, touch only their neighbours; a
 * single letter touches nothing. */
static void arabic_letters_touch_their_neighbours(void **state)
{
    (void)state;
    WrFontRequest three = { .text = "\xd8\xa8\xd8\xa8\xd8\xa8" }, one = { .text = "\xd8\xa8" };
    WrFontText word = shaped(SANS, &three), alone = shaped(SANS, &one);
    bool left, right;
    assert_int_equal(word.placed_count, 3);
    for (int i = 0; i < 3; i++) {
        reaches(&word, i, &left, &right);
        assert_int_equal(left, i > 0);
        assert_int_equal(right, i < 2);
    }
    reaches(&alone, 0, &left, &right);
    assert_false(left || right);
    wr_font_text_fini(&word);
    wr_font_text_fini(&alone);
}

/* ---- fallback fonts ---- */

static int units_of(const char *path)
{
    hb_blob_t *blob = hb_blob_create_from_file(path);
    hb_face_t *face = hb_face_create(blob, 0);
    int units = (int)hb_face_get_upem(face);
    hb_face_destroy(face);
    hb_blob_destroy(blob);
    return units;
}

static void what_a_font_lacks_comes_from_the_next_that_has_it(void **state)
{
    (void)state;
    static const char text[] = "AV " KSHATRIYA " To";
    int after = 3 + (int)strlen(KSHATRIYA);
    WrFontRequest ask = { .text = text, .others = { DEVANAGARI } };
    WrFontText t = shaped(INTER, &ask);
    Direct before = directly(INTER, "AV ", NULL, NULL);
    Direct middle = directly(DEVANAGARI, KSHATRIYA, NULL, NULL);
    assert_int_equal(t.missing_count, 0);
    compare(&t, 0, &before, 0);
    compare(&t, (int)before.count, &middle, 3);
    const int units[] = { units_of(INTER), units_of(DEVANAGARI) };
    assert_true(units[0] != units[1]);
    for (int i = 0; i < t.placed_count; i++) {
        int c = t.placed[i].cluster, lent = c >= 3 && c < after;
        assert_int_equal(font_of(&t, i), lent);
        assert_int_equal(t.glyphs[t.placed[i].glyph].units, units[lent]);
    }
    hb_buffer_destroy(before.buffer);
    hb_buffer_destroy(middle.buffer);
    wr_font_text_fini(&t);
}

/* A line of three fonts in both directions: clusters are in Unicode's order, whichever font draws them. */
static void lent_letters_stand_in_unicodes_order(void **state)
{
    (void)state;
    static const char text[] = "ab " SHALOM " " HINDI " 12";
    WrFontRequest ask = { .text = text, .others = { SANS, DEVANAGARI } };
    WrFontText t = shaped(TERMINUS, &ask);
    static const int hebrew[] = { 9, 7, 5, 3 };
    int found = 0;
    assert_true(t.bitmap);
    for (int i = 0; i < t.placed_count; i++) {
        int c = t.placed[i].cluster, font = c >= 12 && c < 12 + 18 ? 2 : 0;
        if (c < 3 || c > 9) assert_int_equal(font_of(&t, i), font);
        if (c >= 3 && c <= 9) {
            assert_int_equal(c, hebrew[found++]);
        }
    }
    assert_int_equal(found, 4);
    assert_int_equal(t.missing_count, 0);
    wr_font_text_fini(&t);
}

/* A letter and its mark come from one font, even if the first font has the letter. */
static void marks_stay_with_what_they_stand_on(void **state)
{
    (void)state;
    FT_Library library;
    FT_Face face;
    assert_int_equal(FT_Init_FreeType(&library), 0);
    assert_int_equal(FT_New_Face(library, DEVANAGARI, 0, &face), 0);
    assert_true(FT_Get_Char_Index(face, 'x') != 0 && FT_Get_Char_Index(face, 0x301) == 0);
    FT_Done_Face(face);
    FT_Done_FreeType(library);
    WrFontRequest ask = { .text = "axx\xcc\x81x", .others = { SANS } };
    WrFontText t = shaped(DEVANAGARI, &ask);
    for (int i = 0; i < t.placed_count; i++)
        assert_int_equal(font_of(&t, i), t.placed[i].cluster == 2 || t.placed[i].cluster == 3);
    assert_int_equal(t.missing_count, 0);
    wr_font_text_fini(&t);
}

/* Dots and curves in one text: each with its own scale. */
static void bitmaps_and_outlines_are_as_large_as_asked(void **state)
{
    (void)state;
    WrError err = { "" };
    WrFontOutline both = { 0 }, own = { 0 };
    WrFontRequest ask = { .text = "i\xe0\xa4\x95", .others = { DEVANAGARI } };
    WrFontRequest alone = { .text = "\xe0\xa4\x95" };
    WrFontText t = shaped(TERMINUS, &ask), k = shaped(DEVANAGARI, &alone);
    WrFontSetting setting = { 64.0, 0.0, 1.0, WR_FONT_LEFT };
    double place[2][2];
    assert_true(t.bitmap);
    assert_int_equal(t.units, 16);
    assert_int_equal(t.placed_count, 2);
    double width = k.placed[0].advance * 64.0 / k.units;
    assert_near(wr_font_place(&t, &setting, place), 8 * 4 + width, 1e-9);
    assert_true(wr_font_outline(&t, &setting, 0.1, &both, &err));
    assert_true(wr_font_outline(&k, &setting, 0.1, &own, &err));
    int last = both.xy.count - own.xy.count;
    assert_true(last > 0);
    for (int i = 0; i < own.xy.count; i++) /* 32 texels to the right of its position alone */
        assert_near(both.xy.data[last + i], own.xy.data[i] + (i % 2 ? 0.0 : 32.0), 1e-9);
    wr_font_outline_fini(&both);
    wr_font_outline_fini(&own);
    wr_font_text_fini(&t);
    wr_font_text_fini(&k);
}

static void fonts_that_cannot_lend_are_named(void **state)
{
    (void)state;
    WrError err = { "" };
    WrFontText t = { .units = 77 };
    WrFontRequest gone = { .text = "a", .others = { "/nonexistent.ttf" } };
    assert_false(wr_font_shape(SANS, &gone, &t, &err));
    assert_non_null(strstr(err.text, "/nonexistent.ttf"));
    WrFontRequest folder = { .text = "a", .others = { DEVANAGARI, "/usr/share" } };
    assert_false(wr_font_shape(SANS, &folder, &t, &err));
    assert_non_null(strstr(err.text, "/usr/share: is a folder"));
    WrFontRequest none = { .text = "a", .others = { WR_SOURCE_DIR "/README.md" } };
    assert_false(wr_font_shape(SANS, &none, &t, &err));
    assert_non_null(strstr(err.text, "fallback font 1: "));
    assert_non_null(strstr(err.text, "not a readable font"));
    assert_int_equal(t.units, 77);
}

/* Fonts named by fontconfig do contain the letters. */
static void installed_fonts_that_have_letters_are_found(void **state)
{
    (void)state;
    static const uint32_t hindi[] = { 0x939, 0x93f, 0x928, 0x94d, 0x926, 0x940 };
    char *paths[2] = { NULL, NULL };
    int count = wr_font_lenders(hindi, 6, "serif-bold", NULL, 2, paths);
    assert_int_equal(count, 1); /* the first has all of them */
    WrFontRequest ask = { .text = HINDI };
    WrFontText t = shaped(paths[0], &ask);
    assert_int_equal(t.missing_count, 0);
    assert_false(t.bitmap);
    wr_font_text_fini(&t);
    wr_free(paths[0]);
    static const uint32_t nobody[] = { 0x10fffd };
    assert_int_equal(wr_font_lenders(nobody, 1, "sans", "hi", 1, paths), 0);
    assert_int_equal(wr_font_lenders(NULL, 0, "sans", NULL, 1, paths), 0);
}

/* ---- console fonts ---- */

/* ---- variable fonts ---- */

/* The file's name in Inter 3, or in Inter 4. */
static const char *variable_font(void)
{
    static const char old[] = "/usr/share/fonts/truetype/inter-vf/Inter-roman.var.ttf";
    return wr_path_is_there(old) ? old : "/usr/share/fonts/truetype/inter-vf/InterVariable.ttf";
}

static void axes_of_a_variable_font_are_freetypes_and_harfbuzzs(void **state)
{
    (void)state;
    FT_Library library;
    FT_Face face;
    FT_MM_Var *axes;
    FT_Fixed at[16];
    const hb_variation_t wish = { HB_TAG('w', 'g', 'h', 't'), 650.0f };
    assert_int_equal(FT_Init_FreeType(&library), 0);
    assert_int_equal(FT_New_Face(library, variable_font(), 0, &face), 0);
    assert_int_equal(FT_Get_MM_Var(face, &axes), 0);
    for (FT_UInt i = 0; i < axes->num_axis; i++)
        at[i] = axes->axis[i].tag == wish.tag ? 650 * 65536 : axes->axis[i].def;
    assert_int_equal(FT_Set_Var_Design_Coordinates(face, axes->num_axis, at), 0);
    WrFontRequest ask = { .text = "H", .axes = "wght=650" }, plain = { .text = "H" };
    WrFontText bold = shaped(variable_font(), &ask), thin = shaped(variable_font(), &plain);
    Direct d = directly(variable_font(), "H", NULL, &wish);
    compare(&bold, 0, &d, 0);
    assert_true(bold.placed[0].advance != thin.placed[0].advance);
    assert_int_equal(FT_Load_Char(face, 'H', FT_LOAD_NO_SCALE), 0);
    int differ = 0;
    for (int i = 0; i < bold.point_count; i++) {
        int found = 0;
        for (int k = 0; k < face->glyph->outline.n_points; k++)
            found += 2 * face->glyph->outline.points[k].x == bold.points[i].x &&
                     2 * face->glyph->outline.points[k].y == bold.points[i].y;
        assert_true(found > 0);
        differ += bold.points[i].x != thin.points[i].x;
    }
    assert_true(differ > 4);
    hb_buffer_destroy(d.buffer);
    wr_font_text_fini(&bold);
    wr_font_text_fini(&thin);
    FT_Done_MM_Var(library, axes);
    FT_Done_Face(face);
    FT_Done_FreeType(library);
}

static void wrong_axes_are_told(void **state)
{
    (void)state;
    const char *const wrong[][3] = { { SANS, "wght=500", "not variable" },
                                     { variable_font(), "wdth=80", "no axis wdth" },
                                     { variable_font(), "heavy", "as in wght=650" },
                                     { variable_font(), "wght=", "as in wght=650" },
                                     { variable_font(), "wght=1e9", "as in wght=650" },
                                     { variable_font(), "wght=500,,", "as in wght=650" } };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        WrError err = { "" };
        WrFontText t = { 0 };
        WrFontRequest ask = { .text = "a", .axes = wrong[i][1] };
        assert_false(wr_font_shape(wrong[i][0], &ask, &t, &err));
        if (!strstr(err.text, wrong[i][2])) fail_msg("%s: %s", wrong[i][1], err.text);
    }
    /* beyond its range an axis is clamped */
    WrFontRequest far = { .text = "a", .axes = "wght=5000" },
                  end = { .text = "a", .axes = "wght=900" };
    WrFontText a = shaped(variable_font(), &far), b = shaped(variable_font(), &end);
    assert_int_equal(a.placed[0].advance, b.placed[0].advance);
    wr_font_text_fini(&a);
    wr_font_text_fini(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_of_one_script_are_harfbuzzs_own_glyphs_at_its_places),
        cmocka_unit_test(arabic_letters_touch_their_neighbours),
        cmocka_unit_test(what_a_font_lacks_comes_from_the_next_that_has_it),
        cmocka_unit_test(lent_letters_stand_in_unicodes_order),
        cmocka_unit_test(marks_stay_with_what_they_stand_on),
        cmocka_unit_test(bitmaps_and_outlines_are_as_large_as_asked),
        cmocka_unit_test(fonts_that_cannot_lend_are_named),
        cmocka_unit_test(installed_fonts_that_have_letters_are_found),
        cmocka_unit_test(axes_of_a_variable_font_are_freetypes_and_harfbuzzs),
        cmocka_unit_test(wrong_axes_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
