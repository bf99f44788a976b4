/* Line drawings as PDF: object table, page, lines compared with those of the same drawing as SVG, text. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/vector_drawing.h"

/* The same drawing into a file of either kind: lines of two pens, a bend, negative positions, a word. */
static void draw(const char *path, int width, int height)
{
    WrError err;
    WrVectorDrawing *ink = wr_vector_drawing_new(path, width, height, 1, &err);
    TestRandom random = { 11 };
    assert_non_null(ink);
    for (int line = 0; line < 40; line++) {
        WrVectorDrawingPoint points[5];
        if (line % 10 == 0) wr_vector_drawing_pen(ink, 0.35 + line, line / 40.0);
        for (int i = 0; i < 5; i++)
            points[i] =
                (WrVectorDrawingPoint){ (float)(test_random(&random) * 1.2 * width - 0.1 * width),
                                        (float)(test_random(&random) * height) };
        wr_vector_drawing_line(ink, points, 2 + line % 4);
    }
    wr_vector_drawing_word(ink, "-0.5 (a\\b)", 100.25, 50, 14, 1.0);
    if (!wr_vector_drawing_write(ink, &err)) fail_msg("%s", err.text);
    wr_vector_drawing_free(ink);
}

static void read_all(const char *path, char **text, size_t *length)
{
    WrError err;
    if (!wr_file_read(path, 1 << 22, text, length, &err)) fail_msg("%s", err.text);
}

/* The object at the position in the table. */
static void every_object_is_where_the_table_says(void **state)
{
    (void)state;
    size_t length;
    draw("a.pdf", 1023, 517);
    char *text;
    read_all("a.pdf", &text, &length);
    assert_memory_equal(text, "%PDF-1.4\n", 9);
    assert_string_equal(text + length - 6, "%%EOF\n");
    char *start = strstr(text, "startxref\n");
    assert_non_null(start);
    const size_t table = (size_t)strtoul(start + 10, NULL, 10);
    assert_memory_equal(text + table, "xref\n0 ", 7);
    const int count = (int)strtol(text + table + 7, NULL, 10);
    assert_true(count > 5);
    const char *row = strchr(text + table + 7, '\n') + 1;
    assert_memory_equal(row, "0000000000 65535 f \n", 20);
    for (int i = 1; i < count; i++) {
        char want[24];
        snprintf(want, sizeof want, "%d 0 obj\n", i);
        assert_memory_equal(row + 20 * i + 10, " 00000 n \n", 10);
        assert_memory_equal(text + strtoul(row + 20 * i, NULL, 10), want, strlen(want));
    }
    assert_memory_equal(row + 20 * count, "trailer\n", 8);
    const char *stream = strstr(text, "stream\n") + 7, *end = strstr(stream, "endstream");
    const char *says = strstr(end, " 0 obj\n") + 7;
    assert_int_equal(strtol(says, NULL, 10), end - stream);
    assert_non_null(strstr(text, "/MediaBox [0 0 767.25 387.75]")); /* a pixel is 3/4 point */
    wr_free(text);
}

static void its_lines_are_those_of_the_svg(void **state)
{
    (void)state;
    size_t pdf_length, svg_length;
    draw("b.pdf", 800, 600);
    draw("b.svg", 800, 600);
    char *pdf, *svg;
    read_all("b.pdf", &pdf, &pdf_length);
    read_all("b.svg", &svg, &svg_length);
    const char *at = strstr(pdf, "1 J 1 j\n") + 8;
    int places = 0;
    for (const char *s = strstr(svg, "<path"); s && *s; s++) {
        if (strncmp(s, "stroke=\"#", 9) == 0) { /* the next pen: breadth and grey */
            double breadth, grey;
            while (*at && strncmp(at, " w ", 3) != 0) at++;
            assert_int_equal(sscanf(at, " w %lf G", &grey), 1);
            const char *b = at;
            while (b[-1] != '\n') b--;
            breadth = strtod(b, NULL);
            assert_near(grey, strtol((char[3]){ s[9], s[10], 0 }, NULL, 16) / 255.0, 0.0006);
            assert_near(breadth, strtod(strstr(s, "stroke-width=\"") + 14, NULL), 0.005);
            at = strchr(at, 'G') + 2;
        }
        if (strncmp(s, "</svg", 5) == 0 || strncmp(s, "<text", 5) == 0) break;
        if ((*s != 'M' && *s != 'L') || !strchr("-0123456789", s[1])) continue;
        double x, y, px, py;
        char word;
        assert_int_equal(sscanf(s + 1, "%lf %lf", &x, &y), 2);
        while (*at == ' ' || *at == 'S' || *at == '\n' || *at == 'm' || *at == 'l') at++;
        assert_int_equal(sscanf(at, "%lf %lf %c", &px, &py, &word), 3);
        assert_int_equal(word, *s == 'M' ? 'm' : 'l');
        assert_near(px, x, 1e-9);
        assert_near(py, y, 1e-9);
        at = strchr(at, word) + 1;
        places++;
    }
    assert_true(places > 100);
    assert_true(strchr(strstr(pdf, "1 J"), 'e') > strstr(pdf, "BT")); /* no exponents */
    /* Ends at x: "-0.5 (a\b)" is 333 + 556 + 278 + 556 + 278 + 333 + 556 + 278 + 556 + 333 thousandths of 14 wide. */
    const char *word = strstr(pdf, " Tf 1 0 0 -1 ");
    assert_non_null(word);
    assert_near(strtod(word + 13, NULL), 100.25 - 4.057 * 14, 0.006);
    assert_non_null(strstr(pdf, "(-0.5 \\(a\\\\b\\)) Tj"));
    wr_free(pdf);
    wr_free(svg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_object_is_where_the_table_says),
        cmocka_unit_test(its_lines_are_those_of_the_svg),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
