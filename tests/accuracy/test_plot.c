/* The plot of error against time: marks where the axes' numbers say, all labels inside the page, without overlaps, each
   number beside its own point. */
#include "test.h"
#include "test_folder.h"

#include "accuracy/plot.h"
#include "accuracy/report.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/caption.h"
#include "image/image.h"

#define MAX_MOST 60
#define WIDER 1.12 /* other fonts' text, compared with Inter's */
#define LINE 1.25  /* height of a line, of the font size */

/* ---- axes ---- */

static bool is_round(double x)
{
    const double e = floor(log10(x) + 1e-9), m = x / pow(10, e);
    return fabs(m - 1) < 1e-9 || fabs(m - 2) < 1e-9 || fabs(m - 5) < 1e-9;
}

static void an_axis_holds_every_value_between_round_ends(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int k = 0; k < 500; k++) {
        double values[7];
        WrPlotAxis axis;
        for (int i = 0; i < 7; i++) values[i] = pow(10, 24 * test_random(&random) - 12);
        if (k % 2)
            for (int i = 1; i < 7; i++) values[i] = values[0];
        assert_true(wr_plot_axis(values, 7, &axis));
        assert_true(is_round(axis.low) && is_round(axis.high));
        assert_true(axis.high / axis.low > 3.1);
        for (int i = 0; i < 7; i++) {
            const double place = wr_plot_place(&axis, values[i]);
            assert_true(place > 0 && place < 1);
        }
    }
}

static void values_that_have_no_logarithm_do_not_count(void **state)
{
    (void)state;
    const double nothing[] = { 0, -1, (double)NAN, (double)INFINITY };
    const double some[] = { 0, 3, (double)NAN, (double)INFINITY, -4 };
    WrPlotAxis axis = { 1, 2 };
    assert_false(wr_plot_axis(nothing, 4, &axis));
    assert_false(wr_plot_axis(NULL, 0, &axis));
    assert_true(axis.low == 1 && axis.high == 2);
    assert_true(wr_plot_axis(some, 5, &axis));
    assert_true(axis.low < 3 && axis.high > 3 && axis.high <= 20);
    assert_true(wr_plot_place(&axis, 0) == 0 && wr_plot_place(&axis, -1) == 0);
}

static void ticks_are_round_ascend_and_are_never_too_many(void **state)
{
    (void)state;
    static const WrPlotAxis axes[] = { { 1, 10 }, { 0.002, 0.5 }, { 1e-9, 1e9 }, { 5, 20 } };
    for (size_t k = 0; k < sizeof axes / sizeof *axes; k++)
        for (int room = 2; room <= 12; room++) {
            double ticks[12];
            const int count = wr_plot_ticks(&axes[k], ticks, room);
            assert_true(count <= room);
            for (int i = 0; i < count; i++) {
                assert_true(is_round(ticks[i]));
                assert_true(ticks[i] >= axes[k].low * 0.999 && ticks[i] <= axes[k].high * 1.001);
                assert_true(i == 0 || ticks[i] > ticks[i - 1]);
            }
        }
    double ticks[12];
    assert_int_equal(wr_plot_ticks(&axes[0], ticks, 12), 4); /* 1 2 5 10 */
    assert_true(ticks[0] == 1 && ticks[1] == 2 && ticks[2] == 5 && ticks[3] == 10);
    assert_int_equal(wr_plot_ticks(&axes[0], ticks, 3), 2);  /* 1 10 */
    assert_int_equal(wr_plot_ticks(&axes[1], ticks, 12), 8); /* .002 .005 .01 .02 .05 .1 .2 .5 */
    assert_true(ticks[0] == 0.002 && ticks[7] == 0.5);
}

static void places_go_by_ratios(void **state)
{
    (void)state;
    const WrPlotAxis axis = { 0.01, 100 };
    assert_near(wr_plot_place(&axis, 0.01), 0, 1e-15);
    assert_near(wr_plot_place(&axis, 0.1), 0.25, 1e-12);
    assert_near(wr_plot_place(&axis, 1), 0.5, 1e-12);
    assert_near(wr_plot_place(&axis, 100), 1, 1e-12);
}

static void the_nearest_point_is_found_only_within_reach(void **state)
{
    (void)state;
    const WrPlotSpot points[] = { { 0, 0 }, { 10, 0 }, { 10, 4 }, { 10, 4 } };
    assert_int_equal(wr_plot_nearest(points, 4, 9, 1, 5), 1);
    assert_int_equal(wr_plot_nearest(points, 4, 10, 3, 5), 2); /* the first of two that are equal */
    assert_int_equal(wr_plot_nearest(points, 4, 5, 0, 4.9), -1);
    assert_int_equal(wr_plot_nearest(points, 4, 5, 0, 5), 0);
    assert_int_equal(wr_plot_nearest(points, 0, 5, 0, 500), -1);
}

static void scales_end_at_round_numbers_and_numbers_are_short(void **state)
{
    (void)state;
    char text[16];
    assert_near(wr_plot_round_up(0.7), 1, 1e-12);
    assert_near(wr_plot_round_up(1), 1, 1e-12);
    assert_near(wr_plot_round_up(1.01), 2, 1e-12);
    assert_near(wr_plot_round_up(0.0021), 0.005, 1e-15);
    assert_near(wr_plot_round_up(51), 100, 1e-9);
    assert_near(wr_plot_round_up(0), 1, 0);
    assert_near(wr_plot_round_up((double)NAN), 1, 0);
    TestRandom random = { 9 };
    for (int i = 0; i < 1000; i++) {
        const double x = pow(10, 40 * test_random(&random) - 20) * (i % 2 ? 1 : -1);
        assert_true(strlen(wr_plot_number(x, text)) <= 8);
        assert_near(strtod(text, NULL) / x, 1, 0.06);
    }
    assert_string_equal(wr_plot_number(0, text), "0");
    assert_string_equal(wr_plot_number(0.02, text), "0.02");
    assert_string_equal(wr_plot_number(250, text), "250");
}

/* ---- places of numbers ---- */

static const WrPlotBox frame = { 100, 0, 985, 590 };

/* Points as in accuracy benchmarks: many at one height, the front falling from left to right. */
static int draw_points(TestRandom *random, WrPlotSpot *out, int numbers, double crowd)
{
    const int count = numbers + (int)(test_random(random) * (MAX_MOST - numbers));
    for (int i = 0; i < count; i++) {
        const bool front = i < numbers;
        const double along = front ? (i + test_random(random)) / numbers : test_random(random);
        const double down = front ? (i + test_random(random)) / numbers : test_random(random) / 4;
        out[i] = (WrPlotSpot){ frame.x + frame.w * (0.05 + 0.9 * crowd * along),
                               frame.h * (0.95 - 0.9 * crowd * down) };
    }
    return count;
}

static bool inside(const WrPlotBox *box, const WrPlotBox *of)
{
    return box->x >= of->x && box->y >= of->y && box->x + box->w <= of->x + of->w &&
           box->y + box->h <= of->y + of->h;
}

static double far_from(WrPlotSpot a, WrPlotSpot b)
{
    return hypot(a.x - b.x, a.y - b.y);
}

/* Number of labels nearer to another point than to their own. */
static int check_places(const WrPlotSpot *points, int count, int numbers, const WrPlotBox *taken,
                        const WrPlotSpot *places)
{
    int strayed = 0;
    for (int i = 0; i < numbers; i++) {
        const WrPlotBox box = wr_plot_number_box(places[i], i + 1);
        bool nearer = false;
        assert_true(inside(&box, &frame));
        assert_true(wr_plot_apart(&box, taken));
        for (int k = 0; k < count; k++) {
            const WrPlotBox mark = { points[k].x - WR_PLOT_MARK, points[k].y - WR_PLOT_MARK,
                                     2 * WR_PLOT_MARK, 2 * WR_PLOT_MARK };
            assert_true(wr_plot_apart(&box, &mark));
            nearer |= far_from(points[k], points[i]) >= 1 &&
                      far_from(places[i], points[k]) < far_from(places[i], points[i]);
        }
        for (int k = 0; k < i; k++) {
            const WrPlotBox other = wr_plot_number_box(places[k], k + 1);
            assert_true(wr_plot_apart(&box, &other));
        }
        strayed += nearer;
    }
    return strayed;
}

static void numbers_stand_free_and_near_their_points(void **state)
{
    (void)state;
    TestRandom random = { 7 };
    WrPlotSpot points[MAX_MOST], places[MAX_MOST];
    const WrPlotBox taken = { 110, 100, 290, 18 };
    int strayed = 0, all = 0;
    for (int round = 0; round < 200; round++) {
        const int numbers = 1 + (int)(test_random(&random) * 16);
        const double crowd = round % 4 == 0 ? 0.1 : 1;
        const int count = draw_points(&random, points, numbers, crowd);
        wr_plot_number_places(&frame, points, count, numbers, &taken, 1, places);
        const int here = check_places(points, count, numbers, &taken, places);
        strayed += crowd == 1 ? here : 0; /* in a crowd they must; a line connects them */
        all += crowd == 1 ? numbers : 0;
    }
    assert_true(strayed * 100 < all);
}

static void a_number_alone_stands_beside_its_point(void **state)
{
    (void)state;
    const WrPlotSpot point = { 500, 300 };
    WrPlotSpot place;
    wr_plot_number_places(&frame, &point, 1, 1, NULL, 0, &place);
    assert_true(far_from(point, place) < 30);
}

/* ---- the page, read back as a reader would ---- */

/* A benchmark with many settings on its front, with names of maximal length, of all axes in turn. The last rung could not
   be measured. */
static void make_benchmark(WrAccuracyBenchmark *benchmark, int fronts, const char *setting,
                           bool present_on_front)
{
    *benchmark = (WrAccuracyBenchmark){ .width = 256, .height = 256, .threads = 1 };
    benchmark->rungs = wr_alloc((size_t)fronts + 2, sizeof *benchmark->rungs);
    benchmark->reference.last_rms = 1e-4;
    for (int i = 0; i <= fronts + 1; i++) {
        WrRung *rung = &benchmark->rungs[benchmark->count++];
        *rung = (WrRung){ .axis = i % (WR_AXIS_COUNT + 1), .front = i < fronts, .runs = 9 };
        rung->current = present_on_front ? i == 0 : i == fronts;
        rung->seconds = 1e-3 * pow(1.4, i);
        rung->spread = 0.1 * rung->seconds;
        rung->errors.rms = i < fronts ? 0.1 * pow(0.7, i) : 0.1;
        snprintf(rung->full, sizeof rung->full, "%s", setting);
        if (i > fronts) snprintf(rung->note.text, sizeof rung->note.text, "no measurement");
    }
}

typedef struct Label {
    char text[400];
    double x, y, anchor; /* y: middle of the line */
    WrPlotBox box;
} Label;

typedef struct Dot {
    char colour[8];
    double x, y;
} Dot;

#define LABELS 400
#define DOTS 80
typedef struct Page {
    double width, height;
    WrPlotBox frame;
    Label labels[LABELS];
    Dot dots[DOTS]; /* one in each mark */
    int label_count, dot_count;
} Page;

static double number_after(const char *at, const char *word)
{
    const char *found = strstr(at, word);
    assert_non_null(found);
    return strtod(found + strlen(word), NULL);
}

/* <text ... font-size="15" x="100" y="200" text-anchor="end">words</text> */
static void read_label(const char *at, Label *out)
{
    const char *from = strchr(at, '>') + 1, *end = strstr(from, "</text>");
    const double size = number_after(at, "font-size=\"");
    assert_true((size_t)(end - from) < sizeof out->text);
    snprintf(out->text, sizeof out->text, "%.*s", (int)(end - from), from);
    const char *anchor = strstr(at, "text-anchor=\"") + 13;
    out->anchor = *anchor == 's' ? 0 : *anchor == 'm' ? 0.5 : 1;
    out->x = number_after(at, " x=\"");
    out->y = number_after(at, " y=\"") - 0.36 * size;
    WrLabel *font = wr_label_new((int)size, NULL);
    const double w = font ? WIDER * wr_label_width(font, out->text) : 0;
    wr_label_free(font);
    out->box = (WrPlotBox){ out->x - out->anchor * w, out->y - LINE * size / 2, w, LINE * size };
}

/* The lines of a path: of the frame's, its corners; of one that ends where it begins at once, a dot. */
static void read_path(const char *at, Page *page)
{
    const char *colour = strstr(at, "stroke=\"") + 8;
    const char *line = strstr(at, " d=\"") + 4;
    for (; *line == 'M'; line = strchr(line, '\n') + 1) {
        double p[8][2];
        int count = 0;
        for (const char *c = line; *c != '\n' && count < 8; count++) {
            char *after;
            p[count][0] = strtod(c + 1, &after);
            p[count][1] = strtod(after, &after);
            c = after;
        }
        if (count == 5 && p[2][0] - p[0][0] > 0.5 * page->width)
            page->frame = (WrPlotBox){ p[0][0], p[0][1], p[2][0] - p[0][0], p[2][1] - p[0][1] };
        if (count != 2 || p[0][0] != p[1][0] || p[0][1] != p[1][1]) continue;
        assert_true(page->dot_count < DOTS);
        Dot *dot = &page->dots[page->dot_count++];
        snprintf(dot->colour, sizeof dot->colour, "%.7s", colour);
        dot->x = p[0][0];
        dot->y = p[0][1];
    }
}

static void read_page(const WrAccuracyBenchmark *benchmark, const char *name, Page *page)
{
    WrError err;
    char *svg;
    size_t length;
    if (!wr_report_plot(benchmark, name, "plot.svg", &err)) fail_msg("%s", err.text);
    assert_true(wr_file_read("plot.svg", 1 << 20, &svg, &length, &err));
    memset(page, 0, sizeof *page);
    page->width = number_after(svg, " width=\"");
    page->height = number_after(svg, " height=\"");
    for (const char *at = svg; (at = strstr(at, "<text ")); at++) {
        assert_true(page->label_count < LABELS);
        read_label(at, &page->labels[page->label_count++]);
    }
    for (const char *at = svg; (at = strstr(at, "<path ")); at++) read_path(at, page);
    wr_free(svg);
}

static void check_labels(const Page *page)
{
    const WrPlotBox whole = { 0, 0, page->width, page->height };
    for (int i = 0; i < page->label_count; i++) {
        const Label *label = &page->labels[i];
        if (!inside(&label->box, &whole)) fail_msg("leaves the page: %s", label->text);
        for (int k = 0; k < i; k++)
            if (!wr_plot_apart(&label->box, &page->labels[k].box))
                fail_msg("stands over '%s': %s", page->labels[k].text, label->text);
    }
}

/* An axis as its ticks' labels show it: pixels of the outermost two, and their values. */
typedef struct Scale {
    double from, to, low, high;
    int count;
} Scale;

static void widen(Scale *scale, double at, double value)
{
    if (scale->count++ == 0) *scale = (Scale){ at, at, value, value, 1 };
    if (value < scale->low) scale->from = at, scale->low = value;
    if (value > scale->high) scale->to = at, scale->high = value;
}

static double on_scale(const Scale *scale, double value)
{
    return scale->from +
           (scale->to - scale->from) * log(value / scale->low) / log(scale->high / scale->low);
}

/* Ticks of time are below the frame, those of error left of it. */
static void read_scales(const Page *page, Scale *time, Scale *error)
{
    const WrPlotBox *f = &page->frame;
    *time = *error = (Scale){ 0 };
    for (int i = 0; i < page->label_count; i++) {
        const Label *label = &page->labels[i];
        char *end;
        const double value = strtod(label->text, &end);
        if (*end) continue;
        if (label->anchor == 0.5 && label->y > f->y + f->h) widen(time, label->x, value);
        if (label->anchor == 1 && label->x < f->x && label->y < f->y + f->h + 1)
            widen(error, label->y, value);
    }
    assert_true(time->count >= 3 && error->count >= 3);
}

/* The colour of the mark beside that label in the key. */
static const char *colour_of(const Page *page, const char *words)
{
    for (int i = 0; i < page->label_count; i++)
        for (int k = 0; k < page->dot_count; k++)
            if (strcmp(page->labels[i].text, words) == 0 &&
                page->dots[k].x > page->frame.x + page->frame.w &&
                fabs(page->dots[k].y - page->labels[i].y) < 0.1)
                return page->dots[k].colour;
    fail_msg("the key lacks %s", words);
    return "";
}

/* Every measured rung has a mark at its time and error, but not below the reference's own error, in its axis' colour;
   there are no others. */
static void check_marks(const WrAccuracyBenchmark *benchmark, const Page *page)
{
    Scale time, error;
    int inner = 0, measured = 0;
    read_scales(page, &time, &error);
    for (int k = 0; k < page->dot_count; k++)
        inner += page->dots[k].x < page->frame.x + page->frame.w;
    for (int i = 0; i < benchmark->count; i++) {
        const WrRung *rung = &benchmark->rungs[i];
        if (rung->note.text[0]) continue;
        const double x = on_scale(&time, 1e3 * rung->seconds),
                     y = on_scale(&error, fmax(rung->errors.rms, benchmark->reference.last_rms));
        const char *colour = colour_of(page, rung->axis < WR_AXIS_COUNT ? wr_axis_labels[rung->axis]
                                                                        : "combinations");
        bool found = false;
        for (int k = 0; k < page->dot_count; k++)
            found |= hypot(page->dots[k].x - x, page->dots[k].y - y) < 0.1 &&
                     strcmp(page->dots[k].colour, colour) == 0;
        if (!found) fail_msg("no mark at %g ms, %g", 1e3 * rung->seconds, rung->errors.rms);
        measured++;
    }
    assert_int_equal(inner, measured);
}

/* A setting is printed completely, in as many lines as necessary. */
static void check_told(const Page *page, const char *setting)
{
    char told[1000] = "";
    for (int i = 0; i < page->label_count; i++)
        if (strcmp(page->labels[i].text, "setting") == 0)
            for (i += 4; i < page->label_count && strlen(told) < strlen(setting); i++)
                snprintf(told + strlen(told), sizeof told - strlen(told), "%s%s", *told ? " " : "",
                         page->labels[i].text);
    assert_string_equal(told, setting);
}

static void marks_stand_at_their_values_and_no_label_covers_another(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "scheme=central mode=blinn aa=point",
        "scheme=bspline-fit mode=exact aa=adaptive samples=8 spread=regular refine=contrast "
        "contrast=0.01",
        "scheme=bspline-fit mode=invariant aa=adaptive samples=16 spread=jittered refine=contrast "
        "contrast=0.005 mesh=4 newton=-1 texels=0.0009765625 heights=double shading=double "
        "arithmetic=exact footprint=anisotropic moments=toksvig",
    };
    static Page page;
    for (size_t s = 0; s < sizeof settings / sizeof *settings; s++)
        for (int fronts = 0; fronts <= 24; fronts += 6) {
            WrAccuracyBenchmark benchmark;
            make_benchmark(&benchmark, fronts, settings[s], fronts % 4 == 0 && fronts > 0);
            read_page(&benchmark, "a name.wrinkle", &page);
            assert_true(page.label_count > 2 * fronts);
            check_labels(&page);
            check_marks(&benchmark, &page);
            if (fronts > 0) check_told(&page, settings[s]);
            wr_free(benchmark.rungs);
        }
}

static void a_long_title_keeps_its_end(void **state)
{
    (void)state;
    static Page page;
    WrAccuracyBenchmark benchmark;
    char name[256];
    memset(name, 'n', sizeof name);
    snprintf(name + 200, sizeof name - 200, "\xc3\xa4 the end.wrinkle");
    make_benchmark(&benchmark, 2, "scheme=central", true);
    read_page(&benchmark, name, &page);
    assert_memory_equal(page.labels[0].text, "...", 3);
    assert_true(strlen(page.labels[0].text) < 120);
    assert_non_null(strstr(page.labels[0].text, "the end.wrinkle: error against time"));
    wr_free(benchmark.rungs);
}

/* A picture shows each series in its colour; PDF has the same page. */
static void a_plot_is_a_drawing_or_a_picture_by_its_ending(void **state)
{
    (void)state;
    WrError err;
    WrAccuracyBenchmark benchmark;
    char *pdf;
    size_t length;
    make_benchmark(&benchmark, 6, "scheme=central", true);
    assert_true(wr_report_plot(&benchmark, "", "plot.png", &err));
    assert_true(wr_report_plot(&benchmark, "", "plot.pdf", &err));
    assert_false(wr_report_plot(&benchmark, "", "plot.bmp", &err));
    assert_non_null(strstr(err.text, ".pdf, .png or .svg"));
    WrImage *image = wr_image_read("plot.png", &err);
    assert_non_null(image);
    assert_int_equal(image->width, 1280);
    assert_int_equal(image->channels, 3);
    bool blue = false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        blue |= image->data[3 * i] < 0.01f && image->data[3 * i + 2] > 0.4f;
    assert_true(blue);
    wr_image_free(image);
    assert_true(wr_file_read("plot.pdf", 1 << 20, &pdf, &length, &err));
    assert_non_null(strstr(pdf, " 0.000 0.447 0.698 RG\n")); /* 0, 114, 178 of 255 */
    wr_free(pdf);
    wr_free(benchmark.rungs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_axis_holds_every_value_between_round_ends),
        cmocka_unit_test(values_that_have_no_logarithm_do_not_count),
        cmocka_unit_test(ticks_are_round_ascend_and_are_never_too_many),
        cmocka_unit_test(places_go_by_ratios),
        cmocka_unit_test(the_nearest_point_is_found_only_within_reach),
        cmocka_unit_test(scales_end_at_round_numbers_and_numbers_are_short),
        cmocka_unit_test(numbers_stand_free_and_near_their_points),
        cmocka_unit_test(a_number_alone_stands_beside_its_point),
        cmocka_unit_test(marks_stand_at_their_values_and_no_label_covers_another),
        cmocka_unit_test(a_long_title_keeps_its_end),
        cmocka_unit_test(a_plot_is_a_drawing_or_a_picture_by_its_ending),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
