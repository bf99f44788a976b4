/* test_file_labels.c - labels of exported files are read back: heights of any range, signed ones, normal maps; forged
   labels are ignored. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "image/image.h"

static const char table[] = "noise perlin cells=3 octaves=4 amplitude=2.3 level=-1.1 seed=5";

/* A table of random slopes with odd and unequal sides, about -3..1. */
static WrSession *rough_table(Said *said)
{
    WrSession *s = listening(said);
    must_run(s, "table 45x62");
    must_run(s, table);
    return s;
}

static double farthest(const WrSession *a, const WrSession *b)
{
    double most = 0;
    for (int k = 0; k < 45 * 62; k++)
        most = fmax(most, fabs((double)f_at(a, k % 45, k / 45) - (double)f_at(b, k % 45, k / 45)));
    return most;
}

static void heights_come_back_from_every_range(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        double step; /* half a code */
    } cases[] = {
        { "export height h.png", 4.0 / 65535 },
        { "export height h.png depth=8", 4.0 / 255 },
        { "export height h.png range=-4,3", 4.0 / 65535 },
        { "export height h.tif range=signed depth=16", 4.0 / 65535 },
        { "export height h.png range=signed depth=8", 4.0 / 255 },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Said said, other;
        char line[100];
        WrSession *s = rough_table(&said), *back = listening(&other);
        must_run(s, cases[k].line);
        snprintf(line, sizeof line, "image %s", k == 3 ? "h.tif" : "h.png");
        must_run(back, line);
        assert_near(farthest(s, back), 0, cases[k].step);
        assert_non_null(strstr(other.text, "by its metadata"));
        strcat(line, " labels=ignore");
        other.text[0] = '\0';
        must_run(back, line);
        assert_true(farthest(s, back) > 0.5);
        assert_string_equal(other.text, "");
        wr_session_free(s);
        wr_session_free(back);
    }
}

/* For floats the label's range is only informative: the numbers are the heights. */
static void floats_are_heights_whatever_their_range(void **state)
{
    (void)state;
    static const char *const lines[][3] = {
        { "export height h.exr", "image h.exr", "terrain elevation h.exr" },
        { "export height h.tif depth=32", "image h.tif", "terrain elevation h.tif" },
        { "export height h.r32 endian=big", "image h.r32", "picture paste h.r32 at=0.5,0.5" },
        { "export height h.exr depth=16", "image h.exr", "terrain elevation h.exr" },
    };
    for (int k = 0; k < 4; k++) {
        Said said, other;
        WrSession *s = rough_table(&said), *back = listening(&other);
        must_run(s, lines[k][0]);
        for (int door = 1; door < 3; door++) {
            if (door == 2) must_run(back, "table 45x62");
            must_run(back, lines[k][door]);
            assert_near(farthest(s, back), 0, k == 3 ? 0x1p-10 : 0);
        }
        wr_session_free(s);
        wr_session_free(back);
    }
}

/* The same by other commands that read pictures. */
static void elevations_and_photographs_go_by_labels_too(void **state)
{
    (void)state;
    Said said, other;
    WrSession *s = rough_table(&said), *back = listening(&other);
    must_run(back, "table 45x62");
    must_run(s, "export height h.png");
    must_run(back, "terrain elevation h.png");
    assert_near(farthest(s, back), 0, 4.0 / 65535);
    assert_non_null(strstr(other.text, "its label states"));
    must_run(back, "terrain elevation h.png scale=-1 labels=ignore");
    assert_true(farthest(s, back) > 0.5);
    must_run(back, "terrain elevation h.png values=code");
    assert_true(farthest(s, back) > 0.5);
    /* codes proportional to heights, as for a photograph */
    WrSession *codes = listening(&other);
    must_run(codes, "image h.png labels=ignore");
    must_run(back, "picture photo h.png highpass=0 seamless=off height=1");
    assert_near(farthest(codes, back), 0, 1e-6);
    must_run(back, "picture photo h.png highpass=0 seamless=off height=1 labels=ignore");
    assert_true(farthest(codes, back) > 0.1);
    wr_session_free(s);
    wr_session_free(back);
    wr_session_free(codes);
}

static void signed_zero_comes_back_as_zero(void **state)
{
    (void)state;
    Said said;
    for (int depth = 8; depth <= 16; depth += 8) {
        WrSession *s = listening(&said);
        char line[100];
        must_run(s, "table 9x7");
        must_run(s, "dab 0.3,0.6 radius=1.7 hardness=1 strength=-0.7317");
        snprintf(line, sizeof line, "export height z.png range=signed depth=%d", depth);
        must_run(s, line);
        WrSession *back = listening(&said);
        must_run(back, "image z.png");
        for (int k = 0; k < 63; k++) {
            const float was = f_at(s, k % 9, k / 9), is = f_at(back, k % 9, k / 9);
            if (was == 0) assert_true(is == 0);
            assert_near(is, was, depth == 8 ? 0.7317 / 250 : 0.7317 / 65000);
        }
        wr_session_free(s);
        wr_session_free(back);
    }
}

/* A normal map is converted back to heights, for either sign of green, any cell and height scale. */
static void normal_maps_come_back_as_their_heights(void **state)
{
    (void)state;
    static const char *const kinds[] = { "normal+y", "normal-y" };
    for (int k = 0; k < 4; k++) {
        Said said, other;
        char line[100];
        WrSession *s = listening(&said), *back = listening(&other);
        must_run(s, "table 45x62");
        must_run(s, "noise perlin cells=3 octaves=1 amplitude=0.7 seed=5");
        must_run(s, k < 2 ? "bump height=0.25" : "bump height=-0.25");
        snprintf(line, sizeof line, "export %s n.png cell=2,3 depth=16", kinds[k % 2]);
        must_run(s, line);
        must_run(back, "image n.png");
        assert_non_null(strstr(other.text, "normal map"));
        double low = 1e9, high = -1e9;
        for (int t = 0; t < 45 * 62; t++) {
            const double d = (double)f_at(back, t % 45, t / 45) - (double)f_at(s, t % 45, t / 45);
            low = fmin(low, d);
            high = fmax(high, d);
        }
        if (high - low > 0.02) fail_msg("%s, %d: off by %g", kinds[k % 2], k, high - low);
        wr_session_free(s);
        wr_session_free(back);
    }
}

static bool three_codes(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)ctx, (void)y, (void)rows, (void)err;
    const uint16_t codes[] = { 0, 20000, 65535 };
    memcpy(out, codes, sizeof codes);
    return true;
}

static void labels_that_make_no_sense_are_not_believed(void **state)
{
    (void)state;
    static const char *const ranges[] = { "nan,1",        "0,inf",    "3,-4",     "1,1",
                                          "-1e300,1e300", "0,1,2,3",  "",         ",",
                                          "-infinity,0",  "0x10,99z", "1e39,2e39" };
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++) {
        const WrImageAttribute says[] = { { "wrinkle:kind", "height" },
                                          { "wrinkle:range", ranges[k] } };
        const WrImageOut out = { .width = 3,
                                 .height = 1,
                                 .channels = 1,
                                 .type = WR_PIXEL_U16,
                                 .attributes = says,
                                 .attribute_count = 2,
                                 .data = true,
                                 .rows = three_codes };
        WrError err;
        Said said;
        if (!wr_image_write("wrong.png", &out, 1, &err)) fail_msg("%s", err.text);
        WrSession *s = listening(&said);
        must_run(s, "image wrong.png");
        if (!strstr(said.text, "is invalid")) fail_msg("%s: %s", ranges[k], said.text);
        assert_true(f_at(s, 0, 0) == 0 && f_at(s, 2, 0) == 1);
        assert_near(f_at(s, 1, 0), 20000 / 65535.0, 1e-7);
        wr_session_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_come_back_from_every_range),
        cmocka_unit_test(floats_are_heights_whatever_their_range),
        cmocka_unit_test(elevations_and_photographs_go_by_labels_too),
        cmocka_unit_test(signed_zero_comes_back_as_zero),
        cmocka_unit_test(normal_maps_come_back_as_their_heights),
        cmocka_unit_test(labels_that_make_no_sense_are_not_believed),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
