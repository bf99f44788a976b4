/* Vector drawings opened as documents, and texts recognised as drawings or paths. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/svg.h"

#define SVG "<svg xmlns=\"http://www.w3.org/2000/svg\" "

static void write_text(const char *name, const char *text)
{
    WrError err;
    if (!wr_file_write(name, text, strlen(text), &err)) fail_msg("%s", err.text);
}

/* A page of 90 x 30 with a rectangle of 36 x 12 at 9, 6, not in its middle. */
static void write_page(void)
{
    write_text("logo one.svg",
               SVG "width=\"90\" height=\"30\"><rect x=\"9\" y=\"6\" width=\"36\" height=\"12\"/>"
                   "</svg>");
}

static double sum_of(const WrSession *s)
{
    const WrField *f = wr_document_field(doc(s));
    double sum = 0.0;
    for (int j = 0; j < wr_field_height(f); j++)
        for (int i = 0; i < wr_field_width(f); i++) sum += (double)wr_field_get(f, i, j);
    return sum;
}

/* 1024 texels are 90 units; 1024 * 30 / 90 = 341.3 is rounded, and the page's middle is the table's. */
static void check_page(const WrSession *s)
{
    const double scale = 1024.0 / 90.0, middle = 341 / 2.0;
    assert_int_equal(doc(s)->layer_count, 2);
    assert_string_equal(doc(s)->layers[1].name, "logo one");
    assert_non_null(strstr(doc(s)->layers[1].line, "/logo one.svg"));
    const WrField *f = wr_document_field(doc(s));
    assert_int_equal(wr_field_width(f), 1024);
    assert_int_equal(wr_field_height(f), 341);
    const double left = 9 * scale, right = 45 * scale;
    const double top = middle + (6 - 15) * scale, bottom = middle + (18 - 15) * scale;
    const double x[] = { left - 2, left + 2, right - 2, right + 2 };
    const double y[] = { top - 2, top + 2, bottom - 2, bottom + 2 };
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            const bool in = (i == 1 || i == 2) && (j == 1 || j == 2);
            if (f_at(s, (int)x[i], (int)y[j]) != (in ? 1.0f : 0.0f))
                fail_msg("texel %g,%g: %g", x[i], y[j], (double)f_at(s, (int)x[i], (int)y[j]));
        }
    const double area = 36 * 12 * scale * scale, off = sum_of(s) - area;
    if (fabs(off) > 2 * 48 * scale * 0.05) fail_msg("the area is off by %g", off);
}

static void a_drawing_opens_as_a_table_of_its_pages_proportions(void **state)
{
    (void)state;
    write_page();
    WrSession *s = wr_session_new(NULL),
              *by_line = session_of((const char *[]){ "fill 0.3", NULL });
    WrError err;
    if (!wr_session_open(s, "logo one.svg", &err)) fail_msg("%s", err.text);
    check_page(s);
    assert_string_equal(wr_session_path(s), ""); /* saving needs a name */
    must_run(by_line, "open \"logo one.svg\"");
    check_page(by_line);
    assert_int_equal(wr_session_history_count(by_line), 2);
    must_run(by_line, "undo");
    assert_true(f_at(by_line, 1, 1) == 0.3f);
    wr_session_free(s);
    wr_session_free(by_line);
}

static void a_drawing_keeps_the_tables_edges_and_can_be_changed(void **state)
{
    (void)state;
    write_page();
    WrSession *s =
        session_of((const char *[]){ "table 7x5 wrap=clamp-v", "open \"logo one.svg\"", NULL });
    const WrField *f = wr_document_field(doc(s));
    assert_int_equal(wr_field_wrap_u(f), WR_WRAP_PERIODIC);
    assert_int_equal(wr_field_wrap_v(f), WR_WRAP_CLAMP);
    must_run(s, "layer set 2 change=\"height=0.25\"");
    assert_true(f_at(s, 300, 150) == 0.25f);
    wr_session_free(s);
}

static void a_damaged_drawing_leaves_the_document(void **state)
{
    (void)state;
    write_text("cut.svg", SVG "width=\"9\" height=\"9\"><rect width=\"3\" hei");
    write_text("empty.svg", SVG "width=\"9\" height=\"9\"></svg>");
    WrSession *s = session_of((const char *[]){ "table 33x21", "fill 0.7", NULL });
    must_fail(s, "open cut.svg", "cut.svg");
    must_fail(s, "open empty.svg", "empty.svg");
    must_fail(s, "open none.svg", "none.svg");
    const WrHash before = wr_session_hash(s);
    WrError err = { "" };
    assert_false(wr_session_open(s, "cut.svg", &err));
    assert_non_null(strstr(err.text, "cut.svg"));
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

static void texts_are_recognised_as_drawings_and_single_paths(void **state)
{
    (void)state;
    static const struct {
        const char *text, *path;
        bool drawing;
    } texts[] = {
        { SVG "viewBox=\"0 0 9 9\"><path d=\"M1,2 L3 4Z\"/></svg>", "M1,2 L3 4Z", true },
        { "\n <?xml version=\"1.0\"?>\n" SVG "fill=\"none\"><path id='a' d='m1 2h3v4z' fill='red'/>"
          "</svg>",
          "m1 2h3v4z", true },
        { "<!-- x -->" SVG "><path d=\"M1,2 L3 4Z\" transform=\"scale(2)\"/></svg>", NULL, true },
        { SVG "><path d=\"M1,2 L3 4Z\"/><path d=\"M1,2\"/></svg>", NULL, true },
        { SVG "><path d=\"M1,2 L3 4Z\"/><rect width=\"3\"/></svg>", NULL, true },
        { SVG "fill=\"none\"><path d=\"M1,2 L3 4Z\"/></svg>", NULL, true },
        { SVG "><path d=\"M1,2 L3 4Z\" fill-rule=\"evenodd\"/></svg>", NULL, true },
        { SVG "><path d=\"M1,2 javascript\"/></svg>", NULL, true },
        { SVG "><path d=\"M1,2", NULL, true },
        { SVG "><path d=\"M1,2>", NULL, true },
        { SVG, NULL, true },
        { " M 10,-2.5 C1 2 3 4 5 6 z", " M 10,-2.5 C1 2 3 4 5 6 z", false },
        { "Meet me at 9", NULL, false },
        { "M", NULL, false },
        { "<html><svg></svg>", NULL, false },
        { "<?xml version=\"1.0\"?><html/>", NULL, false },
        { "", NULL, false },
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char *path = wr_svg_one_path(texts[i].text);
        if (wr_svg_is_text(texts[i].text) != texts[i].drawing) fail_msg("%s", texts[i].text);
        if (!path != !texts[i].path || (path && strcmp(path, texts[i].path) != 0))
            fail_msg("%s: %s", texts[i].text, path ? path : "no path");
        wr_free(path);
    }
    assert_true(wr_svg_named("a/B.SVG") && wr_svg_named("b.svgz") && !wr_svg_named("svg.png"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_drawing_opens_as_a_table_of_its_pages_proportions),
        cmocka_unit_test(a_drawing_keeps_the_tables_edges_and_can_be_changed),
        cmocka_unit_test(a_damaged_drawing_leaves_the_document),
        cmocka_unit_test(texts_are_recognised_as_drawings_and_single_paths),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
