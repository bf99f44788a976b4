/* test_normal_map.c - normal maps of known tables, in all formats and both signs of green, are read to within the
   format's bound. */
#include "test.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "image/image.h"
#include "scene/normal_map.h"

#define W 53
#define H 38
#define TEXELS (W * H)

/* Slopes of a height field along u and v, v up. */
static void slopes_at(int kind, int i, int j, double *p, double *q)
{
    const double x = 2 * WR_PI * (i + 0.5) / W, y = 2 * WR_PI * (1 - (j + 0.5) / H);
    if (kind == 0) { /* 0.2 sin(x + 2 y) + 0.1 cos(3 x - y), in radians */
        *p = 0.2 * cos(x + 2 * y) - 0.3 * sin(3 * x - y);
        *q = 0.4 * cos(x + 2 * y) + 0.1 * sin(3 * x - y);
    } else { /* f(u) + g(v) */
        *p = 0.7 * cos(3 * x);
        *q = -0.5 * sin(2 * y);
    }
}

/* bits 8, 16; 32: in 0..1; -32: signed. */
static WrImage *map_of(int kind, int bits, bool down, int channels)
{
    WrImage *image = wr_image_new(W, H, channels, NULL);
    image->type = bits == 8 ? WR_PIXEL_U8 : bits == 16 ? WR_PIXEL_U16 : WR_PIXEL_F32;
    const double last = bits == 8 ? 255 : 65535;
    for (int t = 0; t < TEXELS; t++) {
        double p, q;
        slopes_at(kind, t % W, t / W, &p, &q);
        const double length = sqrt(1 + p * p + q * q);
        const double n[3] = { -p / length, (down ? q : -q) / length, 1 / length };
        for (int c = 0; c < channels; c++) {
            const double half = n[c] / 2 + 0.5;
            image->data[channels * t + c] = (float)(bits == -32  ? n[c]
                                                    : bits == 32 ? half
                                                                 : floor(last * half + 0.5) / last);
        }
    }
    return image;
}

static double angle_off(const float *got, double p, double q)
{
    const double length = sqrt(1 + p * p + q * q);
    const double d[3] = { (double)got[0] + p / length, (double)got[1] + q / length,
                          (double)got[2] - 1 / length };
    return 2 * asin(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / 2) * 180 / WR_PI;
}

static void maps_of_all_formats_are_read_within_their_bound(void **state)
{
    /* asin(sqrt(3)/M); two channels: error for z from 0.78 up; float: rounding */
    const struct {
        int bits;
        double three, two;
    } formats[] = {
        { 8, 0.389, 0.5 }, { 16, 0.00152, 0.002 }, { 32, 2e-5, 4e-5 }, { -32, 2e-5, 4e-5 }
    };
    (void)state;
    for (int k = 0; k < 4 * 2 * 2 * 2; k++) {
        const int f = k % 4, channels = 2 + (k / 4) % 2;
        const bool down = k / 8 % 2, found = k / 16;
        WrNormalMapReport told;
        WrImage *file = map_of(0, formats[f].bits, down, channels);
        WrImage *map = wr_normal_map_decode(file,
                                            found  ? WR_GREEN_AUTO
                                            : down ? WR_GREEN_DOWN
                                                   : WR_GREEN_UP,
                                            0, WR_CODING_AUTO, &told, NULL);
        assert_non_null(map);
        assert_true(told.green_down == down && !told.undecided && told.channels == channels);
        assert_true(told.away == 0 && !told.centred && !told.converted);
        assert_true(told.own == (formats[f].bits == -32));
        double worst = 0;
        for (int t = 0; t < TEXELS; t++) {
            double p, q, back_p, back_q;
            slopes_at(0, t % W, t / W, &p, &q);
            worst = fmax(worst, angle_off(map->data + 3 * t, p, q));
            wr_normal_map_slopes(map->data + 3 * t, &back_p, &back_q);
            assert_true(fabs(back_p - p) + fabs(back_q - q) < 0.03);
        }
        if (!(worst <= (channels == 3 ? formats[f].three : formats[f].two)))
            fail_msg("%d bits, %d channels: %g degrees", formats[f].bits, channels, worst);
        wr_image_free(map);
        wr_image_free(file);
    }
}

/* HC140 */
static void of_a_sum_of_profiles_the_sign_is_undecided(void **state)
{
    const int bits[] = { 8, 16, 32, -32 };
    (void)state;
    for (int k = 0; k < 8; k++) {
        WrNormalMapReport told;
        WrImage *file = map_of(1, bits[k % 4], k / 4, 3);
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_AUTO, 0, WR_CODING_AUTO, &told, NULL);
        if (!(told.undecided && !told.green_down)) fail_msg("%d bits", bits[k % 4]);
        wr_image_free(map);
        wr_image_free(file);
    }
}

/* HC137: codes with 0 at 128, and at 32768. */
static void codes_that_are_flat_at_the_middle_are_centred(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrNormalMapReport told;
        WrImage *file = wr_image_new(4, 4, 3, NULL);
        const double last = k ? 65535 : 255, middle = k ? 32768 : 128;
        file->type = k ? WR_PIXEL_U16 : WR_PIXEL_U8;
        for (int i = 0; i < 48; i++) file->data[i] = (float)((i % 3 < 2 ? middle : last) / last);
        file->data[0] = 1, file->data[2] = (float)(middle / last); /* straight along u */
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, NULL);
        assert_true(told.centred && told.away == 1);
        assert_true(map->data[3] == 0 && map->data[4] == 0 && map->data[5] == 1);
        assert_true(map->data[0] > 0.99f && map->data[1] == 0);
        wr_image_free(map);
        for (int i = 0; i < 24; i++) /* half of them 127: now 0 is in between */
            if (i % 3 < 2) file->data[i] = (float)((middle - 1) / last);
        map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, NULL);
        assert_false(told.centred);
        assert_near((double)map->data[3], -1 / last, 1e-7);
        wr_image_free(map);
        wr_image_free(file);
    }
}

/* Vectors on a ring about the axis, coded or not, in floats. */
static WrImage *ring_of_floats(bool coded, double lean)
{
    WrImage *file = wr_image_new(40, 10, 3, NULL);
    file->type = WR_PIXEL_F32;
    for (int i = 0; i < 400; i++) {
        const double turn = 0.1 * i,
                     n[3] = { lean * cos(turn), lean * sin(turn), sqrt(1 - lean * lean) };
        for (int c = 0; c < 3; c++) file->data[3 * i + c] = (float)(coded ? n[c] / 2 + 0.5 : n[c]);
    }
    return file;
}

/* Largest angle between the read vectors and the ring's, in degrees. */
static double worst_angle(const WrImage *map, double lean)
{
    double worst = 0;
    for (int i = 0; i < 400; i++) {
        const double turn = 0.1 * i,
                     n[3] = { lean * cos(turn), lean * sin(turn), sqrt(1 - lean * lean) };
        double square = 0;
        for (int c = 0; c < 3; c++) square += pow((double)map->data[3 * i + c] - n[c], 2);
        worst = fmax(worst, 2 * asin(sqrt(square) / 2) * 57.29577951308232);
    }
    return worst;
}

/* Float bakes have a blue of 1.00001, and filters leave numbers slightly below 0: neither makes them coded
   vectors. */
static void floats_are_read_by_their_distribution(void **state)
{
    (void)state;
    static const double leans[] = { 0.01, 0.2, 0.6, 0.95 };
    for (int k = 0; k < 16; k++) {
        const bool coded = k % 2, stray = k / 2 % 2;
        const double lean = leans[k / 4];
        WrNormalMapReport told;
        WrImage *file = ring_of_floats(coded, lean);
        if (stray) { /* of one texel in forty */
            for (int i = 0; i < 400; i += 40)
                file->data[3 * i + 2] *= 1.00002f, file->data[3 * i] -= 1e-5f;
            if (coded) file->data[2] = 1.00001f;
        }
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, NULL);
        assert_int_equal(told.own, !coded);
        /* only texel 0, with the stray blue, has another angle */
        if (!stray && worst_angle(map, lean) > 1e-3)
            fail_msg("case %d: off by %.3g degrees", k, worst_angle(map, lean));
        wr_image_free(map);
        map = wr_normal_map_decode(file, WR_GREEN_UP, 0, coded ? WR_CODING_UNIT : WR_CODING_SIGNED,
                                   &told, NULL);
        assert_int_equal(told.own, !coded);
        wr_image_free(map);
        wr_image_free(file);
    }
}

/* An explicit choice applies to any numbers; integer formats ignore it. */
static void a_coding_that_is_told_is_taken(void **state)
{
    (void)state;
    WrNormalMapReport told;
    WrError err = { "" };
    WrImage *file = ring_of_floats(true, 0.2);
    WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_SIGNED, &told, NULL);
    assert_true(told.own && map->data[0] > 0.3f); /* 0.6, 0.5, 0.99 unchanged */
    wr_image_free(map);
    file->type = WR_PIXEL_U8;
    assert_null(wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_SIGNED, &told, &err));
    assert_non_null(strstr(err.text, "coding=signed needs a file of floats"));
    map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_UNIT, &told, NULL);
    assert_false(told.own);
    wr_image_free(map);
    /* two channels: slopes of both signs are plain vectors, those around one half are codes */
    file->type = WR_PIXEL_F32;
    map = wr_normal_map_decode(file, WR_GREEN_UP, 2, WR_CODING_AUTO, &told, NULL);
    assert_false(told.own);
    wr_image_free(map);
    wr_image_free(file);
    file = ring_of_floats(false, 0.2);
    map = wr_normal_map_decode(file, WR_GREEN_UP, 2, WR_CODING_AUTO, &told, NULL);
    assert_true(told.own);
    wr_image_free(map);
    wr_image_free(file);
}

/* HC138, HC139: beyond the horizon, backwards, without a direction. */
static void what_looks_away_is_clamped_and_counted(void **state)
{
    const float texels[5][3] = {
        { 0, 0, 0 }, { 1, 1, 0.5f }, { 0.5f, 0.5f, 0.5f }, { 0.75f, 0.5f, 0.25f }, { 0.5f, 0.5f, 1 }
    };
    (void)state;
    for (int channels = 2; channels <= 3; channels++) {
        WrNormalMapReport told;
        WrImage *file = wr_image_new(5, 1, 3, NULL);
        file->type = WR_PIXEL_U16;
        memcpy(file->data, texels, sizeof texels);
        WrImage *map =
            wr_normal_map_decode(file, WR_GREEN_UP, channels, WR_CODING_AUTO, &told, NULL);
        assert_int_equal(told.away, channels == 3 ? 4 : 2);
        for (int t = 0; t < 5; t++) {
            const float *n = map->data + 3 * t;
            double p, q;
            wr_normal_map_slopes(n, &p, &q);
            assert_true(isfinite(p) && isfinite(q) && n[2] > 0);
            assert_near((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1, 1e-6);
            if (t == 0) assert_true(p > 500 && q > 500); /* signs of x and y kept, not inverted */
            if (t == 1) assert_true(p < -500 && q < -500);
        }
        wr_image_free(map);
        wr_image_free(file);
    }
    WrError err = { "" };
    WrNormalMapReport told;
    WrImage *grey = wr_image_new(2, 2, 1, NULL);
    assert_null(wr_normal_map_decode(grey, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, &err));
    assert_non_null(strstr(err.text, "channels"));
    wr_image_free(grey);
}

/* HC141 */
static void a_colour_conversion_is_told(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        WrNormalMapReport told;
        WrImage *file = map_of(0, 8, false, 3);
        for (int i = 0; i < 3 * TEXELS && k; i++) {
            const double x = (double)file->data[i];
            file->data[i] = (float)(k == 1 ? pow(x, 2.2) : pow(x, 1 / 2.2));
        }
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, NULL);
        assert_int_equal(told.converted, k > 0);
        wr_image_free(map);
        wr_image_free(file);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_of_all_formats_are_read_within_their_bound),
        cmocka_unit_test(of_a_sum_of_profiles_the_sign_is_undecided),
        cmocka_unit_test(codes_that_are_flat_at_the_middle_are_centred),
        cmocka_unit_test(floats_are_read_by_their_distribution),
        cmocka_unit_test(a_coding_that_is_told_is_taken),
        cmocka_unit_test(what_looks_away_is_clamped_and_counted),
        cmocka_unit_test(a_colour_conversion_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
