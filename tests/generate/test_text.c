/* Text in relief: against areas and distances computed here from the outlines; invariance when a table is rolled. */
#include "test.h"
#include "generate_help.h"

#include "base/exactmath.h"
#include "base/pool.h"
#include "base/progress.h"
#include "generate/text_relief.h"
#include "image/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#define SANS 2
#define SERIF_BOLD 5
#define SANS_FILE "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"

typedef struct Text {
    const char *text;
    int font; /* index for wr_font_names */
    double size, u, v;
    const Setting *more; /* the last row has name NULL; or NULL */
    const double *points;
    int point_count;
    double lattice[2];
} Text;

static bool try_text(const Text *t, const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const WrGenerator *g = wr_generator_find("text", NULL);
    WrParamValue values[WR_GENERATOR_PARAMS];
    assert_non_null(g);
    wr_generator_defaults(g, values);
    value_of(g, values, "text")->text = t->text;
    value_of(g, values, "font")->number[0] = t->font;
    value_of(g, values, "size")->number[0] = t->size;
    value_of(g, values, "at")->number[0] = t->u;
    value_of(g, values, "at")->number[1] = t->v;
    value_of(g, values, "points")->points = t->points;
    value_of(g, values, "points")->count = t->point_count;
    if (t->lattice[0] != 0.0 || t->lattice[1] != 0.0)
        memcpy(value_of(g, values, "lattice")->number, t->lattice, sizeof t->lattice);
    for (const Setting *s = t->more; s && s->name; s++)
        value_of(g, values, s->name)->number[0] = s->value;
    return wr_generator_make(g, values, job, out, err);
}

static WrRelief relief_of(const Text *t, const WrField *like, WrPool *pool)
{
    WrError err = { "" };
    WrRelief out = { NULL, NULL };
    WrGenerateJob job = { .like = like, .pool = pool };
    if (!try_text(t, &job, &out, &err)) fail_msg("%s", err.text);
    assert_non_null(out.cover);
    return out;
}

static double sum_of(const WrField *f)
{
    double sum = 0.0;
    for (int j = 0; j < wr_field_height(f); j++)
        for (int i = 0; i < wr_field_width(f); i++) sum += (double)wr_field_get(f, i, j);
    return sum;
}

static bool same(const WrRelief *a, const WrRelief *b)
{
    return wr_hash_equal(wr_field_hash(a->heights), wr_field_hash(b->heights)) &&
           wr_hash_equal(wr_field_hash(a->cover), wr_field_hash(b->cover));
}

static WrFontText shaped(const char *path, const char *text)
{
    WrError err = { "" };
    WrFontText out = { 0 };
    WrFontRequest ask = { .text = text };
    if (!wr_font_shape(path, &ask, &out, &err)) fail_msg("%s", err.text);
    return out;
}

static WrFontOutline outline_of(const char *path, const char *text, double size)
{
    WrError err = { "" };
    WrFontOutline out = { 0 };
    WrFontText t = shaped(path, text);
    WrFontSetting setting = { size, 0.0, 1.0, WR_FONT_LEFT };
    assert_true(wr_font_outline(&t, &setting, 1.0 / 256.0, &out, &err));
    wr_font_text_fini(&t);
    return out;
}

static int contour_end(const WrFontOutline *o, int c)
{
    return c + 1 < o->first.count ? o->first.data[c + 1] : o->xy.count / 2;
}

static double area_of(const WrFontOutline *o)
{
    double sum = 0.0;
    for (int c = 0; c < o->first.count; c++)
        for (int i = o->first.data[c]; i < contour_end(o, c); i++) {
            int k = i + 1 < contour_end(o, c) ? i + 1 : o->first.data[c];
            sum += 0.5 * (o->xy.data[2 * i] * o->xy.data[2 * k + 1] -
                          o->xy.data[2 * k] * o->xy.data[2 * i + 1]);
        }
    return fabs(sum);
}

/* The nearest of all edges, one after the other. */
static double distance_to(const WrFontOutline *o, double x, double y)
{
    double least = 1e30;
    for (int c = 0; c < o->first.count; c++)
        for (int i = o->first.data[c]; i < contour_end(o, c); i++) {
            int k = i + 1 < contour_end(o, c) ? i + 1 : o->first.data[c];
            double ax = o->xy.data[2 * i], ay = o->xy.data[2 * i + 1];
            double dx = o->xy.data[2 * k] - ax, dy = o->xy.data[2 * k + 1] - ay;
            double length = dx * dx + dy * dy;
            double t = length > 0 ? ((x - ax) * dx + (y - ay) * dy) / length : 0.0;
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            least = fmin(least, hypot(x - ax - t * dx, y - ay - t * dy));
        }
    return least;
}

/* ---- one texel ---- */

static double texel(const WrTextPiece *pieces, int n, int64_t w, bool *centre)
{
    struct WrTextRim rim = { 0 };
    double part = wr_text_texel(pieces, n, w, centre, &rim);
    wr_array_free(&rim.pieces);
    return part;
}

#define U WR_TEXT_UNIT

static void one_texel_is_cut_in_closed_form(void **state)
{
    (void)state;
    bool centre;
    const double odd = 1e-5; /* corners have odd positions */
    WrTextPiece down = { U / 4 + 1, 0, U / 4 + 1, U, 0, 0 };
    assert_near(texel(&down, 1, 0, &centre), 0.75, odd); /* inside to the right */
    assert_true(centre);
    assert_near(texel(&down, 1, -1, &centre), 0.25, odd); /* and to the left */
    assert_false(centre);
    WrTextPiece slope = { 0, U / 2 + 1, U / 2 + 1, U, 0, 0 };
    assert_near(texel(&slope, 1, 1, &centre), 7.0 / 8.0, odd);
    WrTextPiece level = { 0, U / 4 + 1, U, U / 4 + 1, 0, 0 };
    assert_near(texel(&level, 1, 1, &centre), 0.25, odd);
    assert_near(texel(&level, 1, 0, &centre), 0.75, odd); /* -1 below */
    assert_near(texel(NULL, 0, 0, &centre), 0.0, 0);
    assert_near(texel(NULL, 0, 2, &centre), 1.0, 0);
}

/* Two crossing edges: the inside of an X, two triangles of a quarter each; winding numbers 1 and -1 both count as
 * inside. */
static void sides_that_cross_are_taken_apart(void **state)
{
    (void)state;
    bool centre;
    WrTextPiece x[2] = { { 1, 0, U - 1, U, 0, 0 }, { 1, U, U - 1, 0, 0, 0 } };
    assert_near(texel(x, 2, 0, &centre), 0.5, 1e-4);
    /* another turn around everything makes the lower triangle 0; two more, nothing */
    assert_near(texel(x, 2, 1, &centre), 0.75, 1e-4);
    assert_near(texel(x, 2, 2, &centre), 1.0, 0);
    WrTextPiece twice[2] = { x[0], x[0] };
    assert_near(texel(twice, 2, 0, &centre), texel(x, 1, 0, &centre), 0);
    assert_near(texel(x, 1, 0, &centre), 0.5, 1e-4);
}

/* ---- bitmaps ---- */

static void dots_of_a_whole_scale_are_squares_of_texels_exactly(void **state)
{
    (void)state;
    static const char words[] = "Rg\xc3\xa4#";
    WrFontText font = shaped("/usr/share/fonts/X11/misc/ter-u32n_unicode.pcf.gz", words);
    for (int k = 1; k <= 3; k++) {
        WrField *like = table_of(256, 128);
        Text t = { words, 0, 32.0 * k, 0.25, 0.5, NULL, NULL, 0, { 0 } };
        const Setting more[] = { { "align", 0 }, { "anchor", 1 }, { "height", 0.7 }, { NULL, 0 } };
        t.more = more;
        WrRelief r = relief_of(&t, like, NULL);
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 256; i++) {
                bool on = false;
                int pen = 64;
                for (int p = 0; p < font.placed_count; p++) {
                    const WrFontGlyph *g = &font.glyphs[font.placed[p].glyph];
                    int x = (int)floor((i - pen) / (double)k) - g->left;
                    int y = (int)floor((j - 64) / (double)k) + g->top;
                    int wrapped = (int)floor((i + 256 - pen) / (double)k) - g->left;
                    on = on || wr_font_dot(&font, g, x, y) || wr_font_dot(&font, g, wrapped, y);
                    pen += font.placed[p].advance * k;
                }
                assert_true(same_bits((double)wr_field_get(r.cover, i, j), on));
                assert_true(
                    same_bits((double)wr_field_get(r.heights, i, j), on ? (double)0.7f : 0.0));
            }
        wr_relief_fini(&r);
        wr_field_free(like);
    }
    wr_font_text_fini(&font);
}

static FT_Face face_of(FT_Library *library, const char *path)
{
    FT_Face face;
    assert_int_equal(FT_Init_FreeType(library), 0);
    assert_int_equal(FT_New_Face(*library, path, 0, &face), 0);
    return face;
}

static void a_bitmap_text_is_freetypes_own_bitmap_bit_for_bit(void **state)
{
    (void)state;
    static const char path[] = "/usr/share/fonts/X11/misc/ter-u16n_unicode.pcf.gz";
    static const FT_ULong codes[] = { 'W', 'r', 0xe4, 0x20ac, 'k' };
    static float want[64][128];
    FT_Library library;
    FT_Face face = face_of(&library, path);
    for (int c = 0, pen = 20; c < 5; c++) {
        assert_int_equal(FT_Load_Char(face, codes[c], FT_LOAD_RENDER | FT_LOAD_TARGET_MONO), 0);
        const FT_GlyphSlot g = face->glyph;
        assert_int_equal(g->bitmap.pixel_mode, FT_PIXEL_MODE_MONO);
        for (unsigned y = 0; y < g->bitmap.rows; y++)
            for (unsigned x = 0; x < g->bitmap.width; x++)
                if (g->bitmap.buffer[(int)y * g->bitmap.pitch + (int)x / 8] & (0x80 >> (x & 7)))
                    want[40 - g->bitmap_top + (int)y][pen + g->bitmap_left + (int)x] = 1.0f;
        pen += (int)(g->advance.x / 64);
    }
    FT_Done_Face(face);
    FT_Done_FreeType(library);
    WrField *like = table_of(128, 64);
    const Setting more[] = { { "align", 0 }, { "anchor", 1 }, { NULL, 0 } };
    Text t = {
        "Wr\xc3\xa4\xe2\x82\xack", 0, 16.0, 20.0 / 128.0, 24.0 / 64.0, more, NULL, 0, { 0 }
    };
    WrRelief r = relief_of(&t, like, NULL);
    double set = 0.0;
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 128; i++) {
            assert_true(same_bits((double)wr_field_get(r.cover, i, j), (double)want[j][i]));
            set += (double)want[j][i];
        }
    assert_true(set > 100.0);
    wr_relief_fini(&r);
    wr_field_free(like);
}

#define FINE 8

/* The mean of FreeType's coverage in one texel: FINE x FINE of its pixels. */
static double mean_of(const FT_GlyphSlot g, int i, int j)
{
    double sum = 0.0;
    for (int k = 0; k < FINE * FINE; k++) {
        int x = FINE * (i - 64) + k % FINE - g->bitmap_left;
        int y = FINE * (j - 192) + k / FINE + g->bitmap_top;
        if (x >= 0 && y >= 0 && x < (int)g->bitmap.width && y < (int)g->bitmap.rows)
            sum += g->bitmap.buffer[y * g->bitmap.pitch + x] / 255.0;
    }
    return sum / (FINE * FINE);
}

/* Our chords stay within 1/64 texel of a curve, FreeType's within 1/11 of its pixels, which are an eighth of a texel;
 * a slanted edge is up to 1.42 long in a texel. */
static void coverage_is_that_of_freetypes_own_rasterizer(void **state)
{
    (void)state;
    FT_Library library;
    FT_Face face = face_of(&library, SANS_FILE);
    WrField *like = table_of(256, 256);
    static const char *const letters[] = { "S", "g", "&", "8" };
    assert_int_equal(FT_Set_Pixel_Sizes(face, 0, 170 * FINE), 0);
    for (int k = 0; k < 4; k++) {
        const Setting more[] = { { "align", 0 }, { "anchor", 1 }, { NULL, 0 } };
        Text t = { letters[k], SANS, 170.0, 0.25, 0.25, more, NULL, 0, { 0 } };
        WrRelief r = relief_of(&t, like, NULL);
        double sum = 0.0;
        assert_int_equal(FT_Load_Char(face, (FT_ULong)letters[k][0],
                                      FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP | FT_LOAD_RENDER),
                         0);
        for (int j = 0; j < 256; j++)
            for (int i = 0; i < 256; i++) {
                double want = mean_of(face->glyph, i, j);
                assert_near((double)wr_field_get(r.cover, i, j), want,
                            1.42 * (1.0 / 64.0 + 1.0 / (11.0 * FINE)));
                sum += want;
            }
        assert_true(sum > 2000.0);
        assert_near(sum_of(r.cover) / sum, 1.0, 1.0 / 512.0);
        wr_relief_fini(&r);
    }
    wr_field_free(like);
    FT_Done_Face(face);
    FT_Done_FreeType(library);
}

/* ---- area and distance ---- */

static void coverage_adds_up_to_the_outlines_area_at_any_angle(void **state)
{
    (void)state;
    WrFontOutline o = outline_of(SANS_FILE, "o&", 90.0);
    double area = area_of(&o);
    static const double turns[] = { 0, 33.3, 90, -120.7 };
    WrField *like = table_of(200, 200);
    for (int k = 0; k < 4; k++) {
        const Setting more[] = { { "rotate", turns[k] }, { NULL, 0 } };
        Text t = { "o&", SANS, 90.0, 0.513, 0.477, more, NULL, 0, { 0 } };
        WrRelief r = relief_of(&t, like, NULL);
        /* chords of 1/64 texel, all inside convex curves, over some 700 texels of edge */
        assert_near(sum_of(r.cover), area, 700.0 / 64.0);
        assert_true(area > 1500.0);
        wr_relief_fini(&r);
    }
    wr_field_free(like);
    wr_font_outline_fini(&o);
}

/* A bevel of height 1 over `bevel` texels is the distance itself, averaged over a texel, which changes nothing on a
 * straight slope. */
static void slopes_follow_the_exact_distance_from_the_outline(void **state)
{
    (void)state;
    const double bevel = 9.0;
    WrFontOutline o = outline_of(SANS_FILE, "B", 150.0);
    WrField *like = table_of(192, 192);
    for (int ridge = 0; ridge < 2; ridge++) {
        const Setting more[] = { { "profile", ridge ? WR_TEXT_RIDGE : WR_TEXT_CHISEL },
                                 { "bevel", bevel },
                                 { "align", 0 },
                                 { "anchor", 1 },
                                 { NULL, 0 } };
        Text t = { "B", SANS, 150.0, 0.25, 0.25, more, NULL, 0, { 0 } };
        WrRelief r = relief_of(&t, like, NULL);
        int checked = 0;
        for (int j = 0; j < 192; j++)
            for (int i = 0; i < 192; i++) {
                if (wr_field_get(r.cover, i, j) < 1.0f) continue;
                double d = distance_to(&o, i + 0.5 - 48.0, 144.0 - (j + 0.5));
                if (d < 0.75 || (!ridge && d > bevel - 0.75)) continue;
                assert_near((double)wr_field_get(r.heights, i, j) * bevel, d, 1.0 / 32.0);
                checked++;
            }
        assert_true(checked > 1500);
        wr_relief_fini(&r);
    }
    wr_field_free(like);
    wr_font_outline_fini(&o);
}

/* The profile's formula, far from corners: on the stem of an l. */
static void each_profile_has_its_formula_on_a_straight_stem(void **state)
{
    (void)state;
    WrField *like = table_of(128, 256);
    for (int p = 0; p <= WR_TEXT_ENGRAVED; p++) {
        const Setting more[] = { { "profile", p }, { "bevel", 8 }, { "height", 2 }, { NULL, 0 } };
        Text t = { "l", SANS, 256.0, 0.5, 0.5, more, NULL, 0, { 0 } };
        WrRelief r = relief_of(&t, like, NULL);
        int first = 0;
        while (wr_field_get(r.cover, first, 128) < 1.0f) first++;
        /* position of the edge */
        double edge = first - (double)wr_field_get(r.cover, first - 1, 128);
        for (int i = first + 1; i < first + 10; i++) {
            double d = i + 0.5 - edge, mean = 0.0;
            for (int k = 0; k < 1000; k++) {
                double x = (d - 0.5 + (k + 0.5) / 1000.0) / 8.0, c = x < 1.0 ? x : 1.0;
                mean += p == WR_TEXT_FLAT    ? 1.0
                        : p == WR_TEXT_ROUND ? sqrt(1.0 - (1.0 - c) * (1.0 - c))
                        : p == WR_TEXT_RIDGE ? x
                                             : c;
            }
            mean *= (p == WR_TEXT_ENGRAVED ? -2.0 : 2.0) / 1000.0;
            assert_near((double)wr_field_get(r.heights, i, 128), mean, 2e-4);
        }
        wr_relief_fini(&r);
    }
    wr_field_free(like);
}

/* The same letters drawn twice at the same position equal the letters once, bit for bit: the winding number
   counts. */
static void overlapping_letters_are_one_shape(void **state)
{
    (void)state;
    WrFontText font = shaped(SANS_FILE, "O");
    double advance = font.placed[0].advance * 80.0 / font.units;
    WrField *like = table_of(128, 128);
    const Setting once[] = { { "profile", 1 }, { "align", 0 }, { NULL, 0 } };
    const Setting laid[] = {
        { "profile", 1 }, { "align", 0 }, { "letters", -advance }, { NULL, 0 }
    };
    Text a = { "O", SANS, 80.0, 0.2, 0.5, once, NULL, 0, { 0 } };
    Text b = { "OO", SANS, 80.0, 0.2, 0.5, laid, NULL, 0, { 0 } };
    WrRelief ra = relief_of(&a, like, NULL), rb = relief_of(&b, like, NULL);
    assert_near(largest_difference(ra.cover, rb.cover), 0.0, 0);
    assert_near(largest_difference(ra.heights, rb.heights), 0.0, 1e-6);
    wr_relief_fini(&ra);
    wr_relief_fini(&rb);
    wr_field_free(like);
    wr_font_text_fini(&font);
}

/* ---- edges ---- */

/* HC78: over edges and corners, wider than the table, and far away: a shift by whole texels rolls the table, bit for
 * bit. */
static void hc78_a_moved_text_is_the_rolled_table(void **state)
{
    (void)state;
    static const int moves[][2] = { { 1, 0 }, { 0, 1 }, { 37, -50 }, { 64, 64 }, { -99, 3 } };
    WrField *like = table_of(160, 96);
    for (int k = 0; k < 10; k++) {
        const Setting more[] = { { "profile", k / 2 },
                                 { "rotate", k % 2 ? 27.5 : 0 },
                                 { NULL, 0 } };
        Text t = { "Wrap\nit", k % 3 ? SERIF_BOLD : 0, k % 3 ? 71.3 : 80, 0.31, 0.62, more, NULL, 0,
                   { 0 } };
        WrRelief r = relief_of(&t, like, NULL);
        const int *m = moves[k % 5];
        t.u += m[0] / 160.0;
        t.v += m[1] / 96.0;
        WrRelief moved = relief_of(&t, like, NULL);
        assert_true(is_rolled(r.heights, moved.heights, m[0], m[1]));
        assert_true(is_rolled(r.cover, moved.cover, m[0], m[1]));
        wr_relief_fini(&r);
        wr_relief_fini(&moved);
    }
    wr_field_free(like);
}

/* HC78: on a small table a large glyph overlaps itself; unrolled on a large one it shows which texels are completely
 * inside or outside all images. */
static void hc78_a_glyph_wider_than_the_table_wraps_onto_itself(void **state)
{
    (void)state;
    WrField *small = table_of(48, 40), *large = table_of(480, 480);
    Text t = { "S", SERIF_BOLD, 300.0, 0.5, 0.5, NULL, NULL, 0, { 0 } };
    WrRelief folded = relief_of(&t, small, NULL), whole = relief_of(&t, large, NULL);
    int inside = 0;
    for (int j = 0; j < 40; j++)
        for (int i = 0; i < 48; i++) {
            double most = 0.0;
            for (int y = j; y < 480; y += 40)
                for (int x = i; x < 480; x += 48)
                    most = fmax(most, (double)wr_field_get(whole.cover, (x + 240 - 24) % 480,
                                                           (y + 240 - 20) % 480));
            double is = (double)wr_field_get(folded.cover, i, j);
            assert_true(is >= most - 1e-4);
            if (most == 1.0) {
                assert_near(is, 1.0, 0);
                inside++;
            }
            if (most == 0.0) assert_near(is, 0.0, 0);
        }
    assert_true(inside > 1000);
    wr_relief_fini(&folded);
    wr_relief_fini(&whole);
    wr_field_free(small);
    wr_field_free(large);
}

/* HC78: when clipped, the part on the table equals that on a table twice as large, and nothing wraps around. */
static void hc78_clipping_leaves_what_is_on_the_table(void **state)
{
    (void)state;
    WrField *small = table_of(128, 128), *large = table_of(256, 256);
    static const double at[][2] = { { 0.0, 0.5 }, { 1.0, 0.9 }, { 0.1, 0.02 }, { 0.5, 0.5 } };
    for (int k = 0; k < 4; k++) {
        const Setting more[] = { { "edge", 1 }, { "rotate", 10.0 * k }, { NULL, 0 } };
        Text t = { "Clip", SANS, 60.0, at[k][0], at[k][1], more, NULL, 0, { 0 } };
        WrRelief cut = relief_of(&t, small, NULL);
        t.u = 0.25 + at[k][0] / 2;
        t.v = 0.25 + at[k][1] / 2;
        WrRelief whole = relief_of(&t, large, NULL);
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 128; i++) {
                assert_true(same_bits((double)wr_field_get(cut.cover, i, j),
                                      (double)wr_field_get(whole.cover, i + 64, j + 64)));
                assert_true(same_bits((double)wr_field_get(cut.heights, i, j),
                                      (double)wr_field_get(whole.heights, i + 64, j + 64)));
            }
        assert_true(sum_of(cut.cover) > 100.0);
        wr_relief_fini(&cut);
        wr_relief_fini(&whole);
    }
    const Setting clip[] = { { "edge", 1 }, { NULL, 0 } };
    Text off = { "Clip", SANS, 60.0, 3.0, -7.0, clip, NULL, 0, { 0 } };
    WrRelief nothing = relief_of(&off, small, NULL);
    assert_near(sum_of(nothing.cover), 0.0, 0);
    wr_relief_fini(&nothing);
    wr_field_free(small);
    wr_field_free(large);
}

static void hc78_an_empty_text_covers_nothing(void **state)
{
    (void)state;
    static const char *const empty[] = { "", " ", "\n\n", "\xe2\x80\x8b" };
    WrField *like = table_of(64, 64);
    for (int k = 0; k < 4; k++) {
        Text t = { empty[k], SANS, 40.0, 0.5, 0.5, NULL, NULL, 0, { 0 } };
        WrRelief r = relief_of(&t, like, NULL);
        assert_null(wr_field_tile(r.cover, 0, 0));
        assert_near((double)wr_field_level(r.cover), 0.0, 0);
        wr_relief_fini(&r);
    }
    wr_field_free(like);
}

static void hc78_a_second_line_stands_one_line_below(void **state)
{
    (void)state;
    WrField *like = table_of(64, 128);
    const Setting more[] = { { "anchor", 1 }, { "align", 0 }, { NULL, 0 } };
    Text both = { "ab\ncd", 0, 32.0, 0.25, 0.75, more, NULL, 0, { 0 } };
    Text first = both, second = both;
    first.text = "ab";
    second.text = "cd";
    second.v = 0.5; /* 32 texels */
    WrRelief r = relief_of(&both, like, NULL), a = relief_of(&first, like, NULL),
             b = relief_of(&second, like, NULL);
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 64; i++)
            assert_near((double)wr_field_get(r.cover, i, j),
                        (double)wr_field_get(a.cover, i, j) + (double)wr_field_get(b.cover, i, j),
                        0);
    wr_relief_fini(&r);
    wr_relief_fini(&a);
    wr_relief_fini(&b);
    wr_field_free(like);
}

/* ---- around and along ---- */

static void text_around_the_table_repeats_exactly(void **state)
{
    (void)state;
    WrField *like = table_of(256, 64);
    const Setting more[] = { { "around", 1 }, { "repeats", 4 }, { "profile", 1 }, { NULL, 0 } };
    Text t = { "ab ", SANS, 40.0, 0.1, 0.5, more, NULL, 0, { 0 } };
    WrRelief r = relief_of(&t, like, NULL);
    assert_true(is_rolled(r.heights, r.heights, 64, 0));
    assert_false(is_rolled(r.heights, r.heights, 32, 0));
    assert_true(sum_of(r.cover) > 500.0);
    wr_relief_fini(&r);
    wr_field_free(like);
}

/* Along the diagonal of a square table: a shift by one repeat, (1,1)/2 of the table, changes nothing. */
static void text_along_a_lattice_direction_closes(void **state)
{
    (void)state;
    WrField *like = table_of(128, 128);
    const Setting more[] = { { "around", 3 }, { "repeats", 2 }, { NULL, 0 } };
    Text t = { "ring ", SANS, 20.0, 0.1, 0.3, more, NULL, 0, { 1, 1 } };
    WrRelief r = relief_of(&t, like, NULL);
    assert_true(is_rolled(r.cover, r.cover, 64, 64));
    assert_true(sum_of(r.cover) > 300.0);
    wr_relief_fini(&r);
    WrError err = { "" };
    WrRelief out = { NULL, NULL };
    WrGenerateJob job = { .like = like };
    t.lattice[0] = 0.5;
    assert_false(try_text(&t, &job, &out, &err));
    assert_non_null(strstr(err.text, "whole numbers"));
    wr_field_free(like);
}

/* A straight path to the right is a line of text; one upwards is the same rotated by 90 degrees. */
static void a_straight_path_is_a_turned_line(void **state)
{
    (void)state;
    static const double right[] = { 0.25, 0.5, 0.75, 0.5 }, up[] = { 0.5, 0.25, 0.5, 0.75 };
    WrField *like = table_of(128, 128);
    for (int k = 0; k < 2; k++) {
        const Setting more[] = { { "rotate", 90.0 * k }, { NULL, 0 } };
        Text line = { "path", SANS, 36.0, 0.5, 0.5, more, NULL, 0, { 0 } };
        Text path = { "path", SANS, 36.0, 0.1, 0.1, NULL, k ? up : right, 2, { 0 } };
        WrRelief a = relief_of(&line, like, NULL), b = relief_of(&path, like, NULL);
        assert_near(largest_difference(a.cover, b.cover), 0.0, 1e-3);
        assert_true(sum_of(a.cover) > 500.0);
        wr_relief_fini(&a);
        wr_relief_fini(&b);
    }
    wr_field_free(like);
}

/* ---- threads, notes, limits ---- */

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    WrField *like = table_of(500, 300);
    const Setting more[] = { { "profile", 1 }, { "rotate", 12.0 }, { NULL, 0 } };
    Text t = {
        "\xd8\xb3\xd9\x84\xd8\xa7\xd9\x85 and\nthreads", SANS, 99.0, 0.9, 0.5, more, NULL, 0, { 0 }
    };
    WrRelief one = relief_of(&t, like, NULL);
    for (int threads = 2; threads <= 7; threads += 5) {
        WrPool *pool = wr_pool_new(threads);
        WrRelief many = relief_of(&t, like, pool);
        assert_true(same(&one, &many));
        wr_relief_fini(&many);
        wr_pool_free(pool);
    }
    wr_relief_fini(&one);
    wr_field_free(like);
}

typedef struct Kept {
    char text[2000];
} Kept;

static bool keep(void *ctx, const char *param, const char *value, WrError *err)
{
    Kept *kept = ctx;
    (void)err;
    snprintf(kept->text + strlen(kept->text), sizeof kept->text - strlen(kept->text), "%s=%s\n",
             param, value);
    return true;
}

/* U+10FFFD is in no font, the Hindi word in none named sans. */
static void hc78_missing_glyphs_are_told_and_drawn(void **state)
{
    (void)state;
    static const char hindi[] = "\xe0\xa4\xb9\xe0\xa4\xbf", nobodys[] = "\xf4\x8f\xbf\xbd";
    WrField *like = table_of(64, 64);
    for (int borrow = 0; borrow < 2; borrow++) {
        Said said = { "" };
        Kept kept = { "" };
        WrError err = { "" };
        WrRelief out = { NULL, NULL };
        WrGenerateJob job = {
            .like = like, .note = hear, .note_ctx = &said, .chose = keep, .chose_ctx = &kept
        };
        const Setting more[] = { { "missing", borrow ? 0 : 1 }, { NULL, 0 } };
        Text t = { borrow ? nobodys : hindi, SANS, 40.0, 0.5, 0.5, more, NULL, 0, { 0 } };
        assert_true(try_text(&t, &job, &out, &err));
        assert_non_null(strstr(said.text, borrow ? "U+10FFFD; no installed" : "U+0939, U+093F"));
        assert_int_equal(strstr(kept.text, "missing=sign") != NULL, borrow);
        assert_true(sum_of(out.cover) > 50.0);
        wr_relief_fini(&out);
    }
    wr_field_free(like);
}

static void hc78_bytes_that_are_not_utf8_are_told_and_drawn(void **state)
{
    (void)state;
    WrField *like = table_of(128, 64);
    Said said = { "" };
    WrError err = { "" };
    WrRelief bad = { NULL, NULL }, sign = { NULL, NULL };
    WrGenerateJob job = { .like = like, .note = hear, .note_ctx = &said };
    Text t = { "a\xff\xc0"
               "b",
               SANS,
               30.0,
               0.5,
               0.5,
               NULL,
               NULL,
               0,
               { 0 } };
    assert_true(try_text(&t, &job, &bad, &err));
    assert_string_equal(said.text, "2 bytes of the text are not UTF-8: drawn as U+FFFD\n");
    t.text = "a\xef\xbf\xbd\xef\xbf\xbd"
             "b"; /* the next character is valid */
    assert_true(try_text(&t, &job, &sign, &err));
    assert_int_equal(strlen(said.text),
                     strlen("2 bytes of the text are not UTF-8: drawn as U+FFFD\n"));
    assert_true(same(&bad, &sign));
    wr_relief_fini(&bad);
    wr_relief_fini(&sign);
    wr_field_free(like);
}

/* Letters missing in the font come from a fallback font, with a note; requested by that name they are the same. */
static void hc78_lent_letters_are_told_and_come_again_by_name(void **state)
{
    (void)state;
    WrField *like = table_of(128, 64);
    Said said = { "" };
    Kept kept = { "" };
    WrError err = { "" };
    WrRelief lent = { NULL, NULL }, named = { NULL, NULL };
    WrGenerateJob job = {
        .like = like, .note = hear, .note_ctx = &said, .chose = keep, .chose_ctx = &kept
    };
    Text t = { "ab \xe0\xa4\xb9\xe0\xa4\xbf", SANS, 32.0, 0.5, 0.5, NULL, NULL, 0, { 0 } };
    assert_true(try_text(&t, &job, &lent, &err));
    assert_non_null(strstr(said.text, "2 glyphs are from /"));
    assert_null(strstr(said.text, "sign"));
    char *path = strstr(kept.text, "\nfallback=");
    assert_non_null(path);
    path += strlen("\nfallback=");
    *strchr(path, '\n') = '\0';
    assert_true(strncmp(kept.text, "font=" SANS_FILE "\n", 5 + strlen(SANS_FILE) + 1) == 0);
    WrParamValue values[WR_GENERATOR_PARAMS];
    const WrGenerator *g = wr_generator_find("text", NULL);
    wr_generator_defaults(g, values);
    value_of(g, values, "text")->text = t.text;
    value_of(g, values, "file")->text = SANS_FILE;
    value_of(g, values, "size")->number[0] = 32.0;
    value_of(g, values, "fallback2")->text = path; /* the position in the list does not matter */
    assert_true(wr_generator_make(g, values, &job, &named, &err));
    assert_true(same(&lent, &named));
    wr_relief_fini(&lent);
    wr_relief_fini(&named);
    wr_field_free(like);
}

static void hc78_endless_texts_meet_a_limit_or_are_cancelled(void **state)
{
    (void)state;
    WrField *like = table_of(64, 64);
    char *million = wr_alloc(1000001, 1);
    memset(million, 'a', 1000000);
    WrError err = { "" };
    WrRelief out = { NULL, NULL };
    volatile int cancel = 1;
    WrProgress progress = { .cancel = &cancel };
    WrGenerateJob job = { .like = like };
    Text t = { million, SANS, 40.0, 0.5, 0.5, NULL, NULL, 0, { 0 } };
    assert_false(try_text(&t, &job, &out, &err));
    assert_non_null(strstr(err.text, "262144"));
    million[5000] = '\0';
    WrRelief r = relief_of(&t, like, NULL); /* 120 000 texels long, on 64 */
    assert_true(sum_of(r.cover) > 500.0);
    wr_relief_fini(&r);
    job.progress = &progress;
    assert_false(try_text(&t, &job, &out, &err));
    assert_string_equal(err.text, "cancelled");
    assert_null(out.heights);
    wr_free(million);
    wr_field_free(like);
}

static void around_wants_a_periodic_table(void **state)
{
    (void)state;
    WrField *like = wr_field_new(64, 64, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0.0f, NULL);
    WrError err = { "" };
    WrRelief out = { NULL, NULL };
    WrGenerateJob job = { .like = like };
    const Setting more[] = { { "around", 1 }, { NULL, 0 } };
    Text t = { "a", SANS, 40.0, 0.5, 0.5, more, NULL, 0, { 0 } };
    assert_false(try_text(&t, &job, &out, &err));
    assert_non_null(strstr(err.text, "periodic in u"));
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_texel_is_cut_in_closed_form),
        cmocka_unit_test(sides_that_cross_are_taken_apart),
        cmocka_unit_test(dots_of_a_whole_scale_are_squares_of_texels_exactly),
        cmocka_unit_test(a_bitmap_text_is_freetypes_own_bitmap_bit_for_bit),
        cmocka_unit_test(coverage_is_that_of_freetypes_own_rasterizer),
        cmocka_unit_test(coverage_adds_up_to_the_outlines_area_at_any_angle),
        cmocka_unit_test(slopes_follow_the_exact_distance_from_the_outline),
        cmocka_unit_test(each_profile_has_its_formula_on_a_straight_stem),
        cmocka_unit_test(overlapping_letters_are_one_shape),
        cmocka_unit_test(hc78_a_moved_text_is_the_rolled_table),
        cmocka_unit_test(hc78_a_glyph_wider_than_the_table_wraps_onto_itself),
        cmocka_unit_test(hc78_clipping_leaves_what_is_on_the_table),
        cmocka_unit_test(hc78_an_empty_text_covers_nothing),
        cmocka_unit_test(hc78_a_second_line_stands_one_line_below),
        cmocka_unit_test(text_around_the_table_repeats_exactly),
        cmocka_unit_test(text_along_a_lattice_direction_closes),
        cmocka_unit_test(a_straight_path_is_a_turned_line),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(hc78_missing_glyphs_are_told_and_drawn),
        cmocka_unit_test(hc78_bytes_that_are_not_utf8_are_told_and_drawn),
        cmocka_unit_test(hc78_lent_letters_are_told_and_come_again_by_name),
        cmocka_unit_test(hc78_endless_texts_meet_a_limit_or_are_cancelled),
        cmocka_unit_test(around_wants_a_periodic_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
