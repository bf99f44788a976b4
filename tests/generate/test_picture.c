/* Heights from photographs. */
#include "test.h"
#include "generate_help.h"

#include "generate/picture.h"
#include "image/fill_missing.h"
#include "image/image.h"

static const WrWrap ring[] = { WR_WRAP_PERIODIC, WR_WRAP_PERIODIC };

/* ---- seams ---- */

/* Cloudy ground on a slope: its ends do not match at all. Twice as fine for x beyond 1. */
static double ground(double x, double y)
{
    return 0.8 * x - 0.5 * y + 0.1 * sin(23.0 * x + 3.0 * y) + 0.07 * cos(31.0 * y - 8.0 * x * x) +
           0.04 * sin(90.0 * x + 70.0 * y);
}

static WrSheet ground_of(int width, int height, double scale)
{
    WrSheet s;
    assert_true(wr_sheet_init(&s, width, height, ring, NULL));
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            s.z[j * width + i] = ground((i + 0.5) * scale, (j + 0.5) * scale);
    return s;
}

/* Root mean squares of the steps over the edges and of all others. */
static void steps_of(const WrSheet *s, double *seam, double *inner)
{
    double sum[2] = { 0.0, 0.0 }, count[2] = { 0.0, 0.0 };
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++)
            for (int a = 0; a < 2; a++) {
                int x = a == 0 ? (i + 1) % s->width : i, y = a == 1 ? (j + 1) % s->height : j;
                bool over = a == 0 ? x == 0 : y == 0;
                double d = s->z[y * s->width + x] - s->z[j * s->width + i];
                sum[over] += d * d;
                count[over] += 1.0;
            }
    *inner = sqrt(sum[0] / count[0]);
    *seam = sqrt(sum[1] / count[1]);
}

static void steps_over_the_seam_become_as_small_as_others(void **state)
{
    (void)state;
    static const WrGenerateJob job = { .pool = NULL };
    double seam, inner;
    WrSheet s = ground_of(96, 80, 0.01);
    steps_of(&s, &seam, &inner);
    assert_true(seam > 10.0 * inner);
    assert_true(wr_picture_blend(&s, &job, NULL));
    steps_of(&s, &seam, &inner);
    assert_true(seam < inner && inner > 0.005);
    wr_sheet_fini(&s);
    s = ground_of(96 + 12, 80 + 10, 0.01);
    assert_true(wr_picture_cut(&s, 96, 80, &job, NULL));
    assert_int_equal(s.width, 96);
    assert_int_equal(s.height, 80);
    steps_of(&s, &seam, &inner);
    assert_true(seam < 1.3 * inner && inner > 0.005);
    wr_sheet_fini(&s);
}

/* The subtracted part is as smooth as possible: harmonic except at the edges. */
static void blending_keeps_the_mean_and_all_curvature_inside(void **state)
{
    (void)state;
    enum { W = 40, H = 31 };
    static const WrGenerateJob job = { .pool = NULL };
    WrSheet was = ground_of(W, H, 0.02), s = ground_of(W, H, 0.02);
    double before = 0.0, after = 0.0;
    assert_true(wr_picture_blend(&s, &job, NULL));
    for (int k = 0; k < W * H; k++) before += was.z[k], after += s.z[k];
    assert_near(before, after, 1e-9);
    for (int j = 1; j < H - 1; j++)
        for (int i = 1; i < W - 1; i++) {
            double l[2];
            for (int k = 0; k < 2; k++) {
                const double *z = (k ? s.z : was.z) + j * W + i;
                l[k] = 4.0 * z[0] - z[1] - z[-1] - z[W] - z[-W];
            }
            assert_near(l[0], l[1], 1e-12);
        }
    wr_sheet_fini(&was);
    wr_sheet_fini(&s);
}

/* A clamped axis is unchanged. */
static void only_periodic_axes_are_made_to_meet(void **state)
{
    (void)state;
    static const WrGenerateJob job = { .pool = NULL };
    WrSheet s = ground_of(32, 32, 0.02);
    s.wrap[1] = WR_WRAP_CLAMP;
    double lean = 0.0;
    assert_true(wr_picture_blend(&s, &job, NULL));
    for (int i = 0; i < 32; i++) lean += (s.z[31 * 32 + i] - s.z[i]) / 32.0;
    assert_true(lean < -0.1);
    wr_sheet_fini(&s);
}

/* Without a difference the cut is invisible. */
static void a_picture_that_repeats_already_is_cut_without_a_trace(void **state)
{
    (void)state;
    enum { W = 48, H = 32 };
    static const WrGenerateJob job = { .pool = NULL };
    TestRandom r = { 12 };
    double tile[H][W];
    WrSheet s;
    assert_true(wr_sheet_init(&s, W + 6, H + 4, ring, NULL));
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) tile[j][i] = test_random(&r);
    for (int j = 0; j < H + 4; j++)
        for (int i = 0; i < W + 6; i++) s.z[j * (W + 6) + i] = tile[j % H][i % W];
    assert_true(wr_picture_cut(&s, W, H, &job, NULL));
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) assert_near(s.z[j * W + i], tile[j][i], 1e-10);
    wr_sheet_fini(&s);
}

/* Pictures and tables of all small sizes, with hardly any overlap. */
static void small_tables_are_made_seamless_too(void **state)
{
    (void)state;
    static const int sizes[] = { 1, 2, 3, 5, 15, 16, 17, 23 };
    for (int k = 0; k < 128; k++) {
        int width = sizes[k % 8], height = sizes[k / 8 % 8];
        WrField *like = wr_field_new(width, height, WR_WRAP_PERIODIC,
                                     k % 3 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP, 0.0f, NULL);
        const WrGenerateJob job = { .like = like };
        WrSheet s = ground_of(1 + k % 13, 1 + k % 7, 0.1);
        assert_true(wr_picture_fit(&s, k < 64 ? WR_SEAMLESS_CUT : WR_SEAMLESS_BLEND, &job, NULL));
        assert_int_equal(s.width, width);
        assert_int_equal(s.height, height);
        for (int n = 0; n < width * height; n++) assert_true(fabs(s.z[n]) < 10.0);
        wr_sheet_fini(&s);
        wr_field_free(like);
    }
}

/* ---- holes ---- */

static void holes_take_heights_between_those_around_them(void **state)
{
    (void)state;
    WrSheet s = ground_of(50, 37, 0.01);
    for (int k = 0; k < 50 * 37; k++) s.z[k] = k % 50; /* a ramp */
    for (int j = 10; j < 20; j++)
        for (int i = 20; i < 30; i++) s.z[j * 50 + i] = NAN;
    s.z[0] = NAN;
    assert_int_equal(wr_fill_missing(s.width, s.height, s.z, NULL), 101);
    for (int j = 0; j < 37; j++)
        for (int i = 0; i < 50; i++) {
            bool hole = (i >= 20 && i < 30 && j >= 10 && j < 20) || (i == 0 && j == 0);
            if (!hole) assert_true(s.z[j * 50 + i] == i);
            else assert_near(s.z[j * 50 + i], i, 2.0);
        }
    wr_sheet_fini(&s);
}

static void a_picture_of_holes_is_told(void **state)
{
    (void)state;
    WrSheet s = ground_of(5, 4, 0.01);
    for (int k = 0; k < 20; k++) s.z[k] = NAN;
    assert_int_equal(wr_fill_missing(s.width, s.height, s.z, NULL), -1);
    s.z[7] = 3.0;
    assert_int_equal(wr_fill_missing(s.width, s.height, s.z, NULL), 19);
    for (int k = 0; k < 20; k++) assert_true(s.z[k] == 3.0);
    wr_sheet_fini(&s);
}

/* ---- the row ---- */

static const char *const path = WR_BINARY_DIR "/test_picture.png";

static WrField *photo_of(int width, int height, int channels, const void *codes, WrPixelType type,
                         const Setting *settings, WrError *err)
{
    const WrGenerator *g = wr_generator_find("picture", "photo");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrRelief relief = { NULL, NULL };
    assert_true(wr_image_write_pixels(path, width, height, channels, type, true, codes, NULL));
    wr_generator_defaults(g, values);
    value_of(g, values, "file")->text = path;
    for (; settings && settings->name; settings++)
        value_of(g, values, settings->name)->number[0] = settings->value;
    WrField *like = table_of(width, height);
    WrGenerateJob job = { .like = like };
    bool good = wr_generator_make(g, values, &job, &relief, err);
    wr_field_free(like);
    return good ? relief.heights : NULL;
}

static double light(double code)
{
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

static void luminance_is_taken_in_linear_light(void **state)
{
    (void)state;
    static const uint8_t colours[][3] = { { 188, 188, 188 }, { 255, 0, 0 },     { 10, 200, 3 },
                                          { 0, 0, 0 },       { 255, 255, 255 }, { 5, 5, 250 } };
    static const Setting off[] = { { "seamless", 0 }, { NULL, 0 } };
    WrError err;
    WrField *f = photo_of(6, 1, 3, colours, WR_PIXEL_U8, off, &err);
    for (int i = 0; i < 6; i++) {
        double want = 0.2126 * light(colours[i][0] / 255.0) +
                      0.7152 * light(colours[i][1] / 255.0) + 0.0722 * light(colours[i][2] / 255.0);
        assert_near((double)wr_field_get(f, i, 0), want, 1e-7);
    }
    wr_field_free(f);
    static const uint16_t greys[] = { 0, 1000, 30000, 65535 };
    f = photo_of(4, 1, 1, greys, WR_PIXEL_U16, off, &err);
    for (int i = 0; i < 4; i++)
        assert_near((double)wr_field_get(f, i, 0), light(greys[i] / 65535.0), 1e-7);
    wr_field_free(f);
}

static void channels_and_levels_are_what_they_say(void **state)
{
    (void)state;
    static const uint8_t codes[] = { 51, 102, 204, 153 }; /* 0.2, 0.4, 0.8, 0.6 */
    static const struct {
        Setting s[8];
        double want;
    } cases[] = {
        { { { "channel", 1 } }, 0.2 },
        { { { "channel", 2 } }, 0.4 },
        { { { "channel", 3 } }, 0.8 },
        { { { "channel", 4 } }, 0.6 },
        { { { "channel", 5 } }, 0.8 },
        { { { "channel", 2 }, { "invert", 1 } }, 0.6 },
        { { { "channel", 2 }, { "low", 0.3 }, { "high", 0.5 } }, 0.5 },
        { { { "channel", 2 }, { "low", 0.5 } }, 0.0 },
        { { { "channel", 3 }, { "gamma", 0.5 } }, 0.64 },
        { { { "channel", 3 }, { "height", 10 }, { "level", 1 } }, 9.0 },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Setting s[10] = { { "light", 1 }, { "seamless", 0 } };
        WrError err;
        memcpy(s + 2, cases[k].s, sizeof cases[k].s);
        WrField *f = photo_of(1, 1, 4, codes, WR_PIXEL_U8, s, &err);
        if (!f) fail_msg("case %zu: %s", k, err.text);
        assert_near((double)wr_field_get(f, 0, 0), cases[k].want, 1e-6);
        wr_field_free(f);
    }
}

/* The gradient of light from left to right is removed, the grain stays. */
static void a_high_pass_takes_away_what_is_wide(void **state)
{
    (void)state;
    static uint8_t codes[64][128];
    static const Setting pass[] = { { "highpass", 8 }, { "light", 1 }, { NULL, 0 } };
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 128; i++)
            codes[j][i] = (uint8_t)(128.0 + 80.0 * sin(i * 6.283185307179586 / 128.0) +
                                    (i % 4 < 2 ? 15 : -15));
    WrError err;
    WrField *f = photo_of(128, 64, 1, codes, WR_PIXEL_U8, pass, &err);
    double wide = 0.0, fine = 0.0;
    for (int i = 0; i < 128; i++) {
        wide += (double)wr_field_get(f, i, 9) * sin(i * 6.283185307179586 / 128.0) / 64.0;
        fine += (double)wr_field_get(f, i, 9) * (i % 4 < 2 ? 1 : -1) / 128.0;
    }
    assert_true(fabs(wide) < 0.1 * 80.0 / 255.0);
    assert_near(fine, 15.0 / 255.0, 0.003);
    wr_field_free(f);
}

static void mistakes_in_pictures_are_told(void **state)
{
    (void)state;
    static const uint8_t grey[] = { 1, 2, 3, 4 };
    static const Setting alpha[] = { { "channel", 4 }, { NULL, 0 } };
    static const Setting levels[] = { { "low", 0.5 }, { "high", 0.5 }, { NULL, 0 } };
    WrError err = { "" };
    assert_null(photo_of(2, 2, 1, grey, WR_PIXEL_U8, alpha, &err));
    assert_non_null(strstr(err.text, "alpha"));
    assert_null(photo_of(2, 2, 1, grey, WR_PIXEL_U8, levels, &err));
    assert_non_null(strstr(err.text, "low=0.5"));
    const WrGenerator *g = wr_generator_find("picture", "photo");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrField *like = table_of(4, 4);
    WrGenerateJob job = { .like = like };
    WrRelief relief = { NULL, NULL };
    wr_generator_defaults(g, values);
    assert_false(wr_generator_make(g, values, &job, &relief, &err));
    assert_non_null(strstr(err.text, "file is missing"));
    value_of(g, values, "file")->text = WR_BINARY_DIR "/no_such_picture.png";
    assert_false(wr_generator_make(g, values, &job, &relief, &err));
    assert_non_null(strstr(err.text, "no_such_picture.png"));
    assert_null(relief.heights);
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_over_the_seam_become_as_small_as_others),
        cmocka_unit_test(blending_keeps_the_mean_and_all_curvature_inside),
        cmocka_unit_test(only_periodic_axes_are_made_to_meet),
        cmocka_unit_test(a_picture_that_repeats_already_is_cut_without_a_trace),
        cmocka_unit_test(small_tables_are_made_seamless_too),
        cmocka_unit_test(holes_take_heights_between_those_around_them),
        cmocka_unit_test(a_picture_of_holes_is_told),
        cmocka_unit_test(luminance_is_taken_in_linear_light),
        cmocka_unit_test(channels_and_levels_are_what_they_say),
        cmocka_unit_test(a_high_pass_takes_away_what_is_wide),
        cmocka_unit_test(mistakes_in_pictures_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
