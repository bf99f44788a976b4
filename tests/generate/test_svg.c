/* Vector drawings in relief. */
#include "test.h"
#include "generate_help.h"
#include "test_folder.h"

#include "base/file.h"
#include "base/text.h"

#define SVG                                                                                        \
    "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "

static const WrGenerator *row(void)
{
    return wr_generator_find("picture", "svg");
}

static void write_text(const char *name, const char *text)
{
    WrError err;
    if (!wr_file_write(name, text, strlen(text), &err)) fail_msg("%s", err.text);
}

/* The relief of a file with further settings, on a table; notes are joined. */
static bool draw(const char *file, const Setting *settings, const WrField *like, WrRelief *out,
                 Said *said, WrError *err)
{
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(row(), values);
    value_of(row(), values, "file")->text = file;
    for (; settings->name; settings++)
        value_of(row(), values, settings->name)->number[0] = settings->value;
    const WrGenerateJob job = { .like = like, .note = said ? hear : NULL, .note_ctx = said };
    return wr_generator_make(row(), values, &job, out, err);
}

static WrRelief drawn(const char *file, const Setting *settings, const WrField *like)
{
    WrError err = { "" };
    WrRelief relief = { NULL, NULL };
    if (!draw(file, settings, like, &relief, NULL, &err)) fail_msg("%s", err.text);
    return relief;
}

static double area_of(const WrRelief *relief, int width, int height)
{
    double sum = 0.0;
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) sum += (double)wr_field_get(relief->cover, i, j);
    return sum;
}

/* ---- outline and profile ---- */

#define RADIUS 83.3
#define BEVEL 37.0
#define OFF 0.04 /* texels: a sixth of a pixel of the raster, of 1/4 texel */

static void write_circle(void)
{
    write_text("circle.svg", SVG "viewBox=\"-7 3 400 300\"><g transform=\"translate(30 20)\">"
                                 "<circle cx=\"101.7\" cy=\"99.1\" r=\"41\"/></g></svg>");
}

static void a_circle_has_its_area_and_a_bevel_by_distance(void **state)
{
    (void)state;
    write_circle();
    WrField *like = table_of(256, 200);
    const Setting settings[] = { { "size", 2.0 * RADIUS },
                                 { "profile", 2 /* chisel */ },
                                 { "bevel", BEVEL },
                                 { "height", 1.0 },
                                 { NULL, 0 } };
    WrRelief relief = drawn("circle.svg", settings, like);
    const double off = area_of(&relief, 256, 200) - M_PI * RADIUS * RADIUS;
    if (fabs(off) > 2.0 * M_PI * RADIUS * OFF) fail_msg("the area is off by %g", off);
    double worst = 0.0;
    for (int j = 0; j < 200; j++)
        for (int i = 0; i < 256; i++) {
            const double d = RADIUS - hypot(i + 0.5 - 128.0, j + 0.5 - 100.0);
            if (d < 1.0 || fabs(d - BEVEL) < 1.0) continue; /* means over a texel */
            const double want = d < BEVEL ? d / BEVEL : 1.0;
            worst = fmax(worst, fabs((double)wr_field_get(relief.heights, i, j) - want) * BEVEL);
        }
    if (worst > OFF) fail_msg("a height is off by %g texels of distance", worst);
    wr_relief_fini(&relief);
    wr_field_free(like);
}

static void a_moved_drawing_is_a_rolled_table(void **state)
{
    (void)state;
    write_circle();
    WrField *like = table_of(128, 64);
    const Setting here[] = { { "size", 51.7 }, { "profile", 1 }, { "rotate", 31 }, { NULL, 0 } };
    const Setting there[] = { { "size", 51.7 },
                              { "profile", 1 },
                              { "rotate", 31 },
                              { "at", 0.5 + 83.0 / 128.0 },
                              { NULL, 0 } };
    WrRelief a = drawn("circle.svg", here, like), b = drawn("circle.svg", there, like);
    assert_true(is_rolled(a.heights, b.heights, 83, 0));
    assert_false(is_rolled(a.heights, b.heights, 82, 0));
    wr_relief_fini(&a);
    wr_relief_fini(&b);
    wr_field_free(like);
}

static void the_page_or_the_dark_parts_are_chosen(void **state)
{
    (void)state;
    write_text("two.svg",
               SVG "width=\"80\" height=\"40\"><rect width=\"20\" height=\"40\" fill=\"#ffd\"/>"
                   "<rect x=\"10\" y=\"10\" width=\"7\" height=\"11\" fill=\"#312\"/>"
                   "<text x=\"3\" y=\"9\">no</text></svg>");
    WrField *like = table_of(128, 128);
    /* 80 pixels of the page become 120 texels: 1.5 texels each */
    const Setting all[] = { { "size", 120 }, { "box", 1 }, { NULL, 0 } };
    const Setting dark[] = { { "size", 120 }, { "box", 1 }, { "take", 1 }, { NULL, 0 } };
    const Setting light[] = { { "size", 120 }, { "box", 1 }, { "take", 2 }, { NULL, 0 } };
    const double pixels[] = { 20 * 40, 7 * 11, 20 * 40 - 7 * 11 };
    const Setting *const settings[] = { all, dark, light };
    for (int k = 0; k < 3; k++) {
        Said said = { "" };
        WrError err;
        WrRelief relief = { NULL, NULL };
        assert_true(draw("two.svg", settings[k], like, &relief, &said, &err));
        const double area = area_of(&relief, 128, 128), want = pixels[k] * 1.5 * 1.5;
        if (fabs(area - want) > 0.05 * 2.0 * (20 + 40 + 7 + 11) * 1.5)
            fail_msg("%d: %g texels, not %g", k, area, want);
        assert_non_null(strstr(said.text, "its text is left out"));
        wr_relief_fini(&relief);
    }
    wr_field_free(like);
}

/* ---- hostile files ---- */

static void write_bombs(void)
{
    WrText text = { 0 };
    wr_text_add(&text, "<!DOCTYPE svg [<!ENTITY a0 \"<rect width='1' height='1'/>\">");
    for (int i = 0; i < 9; i++) {
        wr_text_addf(&text, "<!ENTITY a%d \"", i + 1);
        for (int k = 0; k < 10; k++) wr_text_addf(&text, "&a%d;", i);
        wr_text_add(&text, "\">");
    }
    wr_text_add(&text, "]>" SVG "width=\"9\" height=\"9\">&a9;</svg>");
    write_text("entities.svg", wr_text_get(&text));
    wr_text_clear(&text);
    wr_text_add(&text, SVG "width=\"9\" height=\"9\">");
    for (int i = 0; i < 5000; i++) wr_text_add(&text, "<g>");
    write_text("deep.svg", wr_text_get(&text));
    wr_text_fini(&text);
}

static void hostile_files_give_one_error_that_names_them(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text, *says;
    } files[] = {
        { "missing.svg", NULL, "No such file" },
        { "void.svg", "", "is empty" },
        { "plain.svg", "hello", "is not an SVG file" },
        { "cut.svg", SVG "width=\"9\" height=\"9\"><rect width=\"3\" hei", "is not an SVG file" },
        { "entities.svg", NULL, "is not an SVG file" },
        { "deep.svg", NULL, "is not an SVG file" },
        { "nothing.svg", SVG "width=\"9\" height=\"9\"></svg>", "draws nothing" },
        { "outside.svg",
          "<!DOCTYPE svg [<!ENTITY x SYSTEM \"circle.svg\">]>" SVG
          "width=\"9\" height=\"9\">&x;</svg>",
          "is not an SVG file" },
        { "image.svg",
          SVG "width=\"9\" height=\"9\"><image xlink:href=\"circle.svg\" width=\"9\" height=\"9\"/>"
              "</svg>",
          "draws nothing" },
        { "huge.svg",
          SVG "width=\"1e300\" height=\"1e300\"><rect width=\"1e299\" height=\"1e200\"/></svg>",
          "" },
        { "nan.svg", SVG "width=\"9\" height=\"9\"><path d=\"M1e400 1L5 5L3-1e400Z\"/></svg>", "" },
    };
    write_circle();
    write_bombs();
    WrField *like = table_of(64, 64);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const Setting settings[] = { { "size", 40 }, { NULL, 0 } };
        WrError err = { "" };
        WrRelief relief = { NULL, NULL };
        if (files[i].text) write_text(files[i].name, files[i].text);
        if (draw(files[i].name, settings, like, &relief, NULL, &err))
            fail_msg("%s is taken", files[i].name);
        const char *text = err.text;
        if (strncmp(text, files[i].name, strlen(files[i].name)) != 0 ||
            !strstr(text, files[i].says) || strchr(text, '\n'))
            fail_msg("%s: %s", files[i].name, text);
        assert_null(relief.heights);
    }
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_circle_has_its_area_and_a_bevel_by_distance),
        cmocka_unit_test(a_moved_drawing_is_a_rolled_table),
        cmocka_unit_test(the_page_or_the_dark_parts_are_chosen),
        cmocka_unit_test(hostile_files_give_one_error_that_names_them),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
