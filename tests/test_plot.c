/* The plot of error against time: all labels inside the picture, without overlaps, each number connected to its own
   point. */
#include "test.h"

#include "accuracy/plot_labels.h"
#include "accuracy/report.h"
#include "base/memory.h"

#define MOST 60
/* Width of a character relative to the font size: more than the average of any setting's text. */
#define CHARACTER 0.83
#define LINE 1.5

/* ---- places of numbers ---- */

static const WrPlotBox frame = { 100, 0, 985, 590 };

/* Points as in ladders: many at one height, the front falling from left to right. */
static int draw_points(TestRandom *random, WrPlotSpot *out, int numbers, double crowd)
{
    const int count = numbers + (int)(test_random(random) * (MOST - numbers));
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
    WrPlotSpot points[MOST], places[MOST];
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

/* ---- the whole script ---- */

/* A ladder with many settings on its front, with names of maximal length. */
static void make_ladder(WrLadder *ladder, int fronts, const char *setting, bool present_on_front)
{
    *ladder = (WrLadder){ .width = 256, .height = 256, .threads = 1 };
    ladder->rungs = wr_alloc((size_t)fronts + 1, sizeof *ladder->rungs);
    ladder->reference.last_rms = 1e-4;
    for (int i = 0; i <= fronts; i++) {
        WrRung *rung = &ladder->rungs[ladder->count++];
        *rung = (WrRung){ .axis = WR_AXIS_COUNT, .front = i < fronts, .runs = 9 };
        rung->current = present_on_front ? i == 0 : i == fronts;
        rung->seconds = 1e-3 * pow(1.4, i);
        rung->errors.rms = i < fronts ? 0.1 * pow(0.7, i) : 0.1;
        snprintf(rung->full, sizeof rung->full, "%s", setting);
    }
}

typedef struct Label {
    char text[400];
    WrPlotBox box;
} Label;

static double number_after(const char *at, const char *word)
{
    const char *found = strstr(at, word);
    assert_non_null(found);
    return strtod(found + strlen(word), NULL);
}

/* Parse "set label 5 'text' ... at screen X, screen Y [left|center|right] font ',SIZE'". */
static void read_label(const char *line, double width, double height, Label *out)
{
    const char *from = strchr(line, '\'') + 1, *at = strstr(from, "' "), *end = strchr(line, '\n');
    const size_t length = (size_t)(at - from);
    char rest[400];
    assert_true(length < sizeof out->text);
    memcpy(out->text, from, length);
    out->text[length] = '\0';
    snprintf(rest, sizeof rest, "%.*s", (int)(end - at), at);
    const double size = number_after(rest, "font ',") * 4 / 3;
    const double x = number_after(rest, "screen ") * width;
    const double y = number_after(rest, ", screen ") * height;
    const double w = CHARACTER * 0.75 * size * (double)length, h = LINE * size;
    const double left = strstr(rest, " center") ? x - w / 2 : strstr(rest, " right") ? x - w : x;
    out->box = (WrPlotBox){ left, y - h / 2, w, h };
}

static int read_labels(const char *script, Label *out, int room)
{
    const char *size = strstr(script, " size ");
    char *after;
    assert_non_null(size);
    const double width = strtod(size + 6, &after), height = strtod(after + 1, NULL);
    int count = 0;
    for (const char *at = script; (at = strstr(at, "\nset label ")); at++) {
        assert_true(count < room);
        read_label(at + 1, width, height, &out[count++]);
    }
    for (int i = 0; i < count; i++) {
        const WrPlotBox picture = { 0, 0, width, height };
        if (!inside(&out[i].box, &picture)) fail_msg("leaves the picture: %s", out[i].text);
        for (int k = 0; k < i; k++)
            if (!wr_plot_apart(&out[i].box, &out[k].box))
                fail_msg("stands over '%s': %s", out[k].text, out[i].text);
    }
    return count;
}

/* A setting is printed completely, in as many lines as necessary. */
static void check_told(const Label *labels, int count, const char *setting)
{
    char told[1000] = "";
    for (int i = 0; i < count; i++)
        if (strcmp(labels[i].text, "setting") == 0)
            for (i += 4; i < count && strlen(told) < strlen(setting); i++)
                snprintf(told + strlen(told), sizeof told - strlen(told), "%s%s",
                         *told && strlen(told) + 1 < sizeof told ? " " : "", labels[i].text);
    assert_string_equal(told, setting);
}

static void no_name_leaves_the_picture_or_covers_another(void **state)
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
    static Label labels[400];
    for (size_t s = 0; s < sizeof settings / sizeof *settings; s++)
        for (int fronts = 0; fronts <= 24; fronts += 6) {
            WrLadder ladder;
            WrText script = { 0 };
            make_ladder(&ladder, fronts, settings[s], fronts % 4 == 0 && fronts > 0);
            wr_report_plot_script(&ladder, "a name.wrinkle", "pngcairo", &script);
            const int count = read_labels(wr_text_get(&script), labels, 400);
            assert_true(count > 2 * fronts);
            if (fronts > 0) check_told(labels, count, settings[s]);
            wr_text_fini(&script);
            wr_free(ladder.rungs);
        }
}

static void a_long_title_keeps_its_end(void **state)
{
    (void)state;
    WrLadder ladder;
    WrText script = { 0 };
    char name[256];
    memset(name, 'n', sizeof name);
    snprintf(name + 200, sizeof name - 200, "\xc3\xa4 the end.wrinkle");
    make_ladder(&ladder, 2, "scheme=central", true);
    wr_report_plot_script(&ladder, name, "svg", &script);
    const char *title = strstr(wr_text_get(&script), "set title '...");
    assert_non_null(title);
    assert_true(strchr(title, '\n') - title < 140);
    assert_non_null(strstr(title, "the end.wrinkle: error against time"));
    wr_text_fini(&script);
    wr_free(ladder.rungs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_stand_free_and_near_their_points),
        cmocka_unit_test(a_number_alone_stands_beside_its_point),
        cmocka_unit_test(no_name_leaves_the_picture_or_covers_another),
        cmocka_unit_test(a_long_title_keeps_its_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
