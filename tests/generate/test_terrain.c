/* Mountains, terraces, and elevations from files. */
#include "test.h"

#include "base/file.h"
#include "generate/terrain.h"
#include "generate_help.h"
#include "image/image.h"

/* ---- fractals ---- */

static void mountains_fill_their_height_and_meet_themselves(void **state)
{
    (void)state;
    WrField *like = table_of(128, 96);
    for (int type = 0; type < 4; type++) {
        const Setting s[] = { { "type", type }, { "height", 3 }, { "level", -1 }, { NULL, 0 } };
        WrField *f = made_with("terrain", "fractal", s, like);
        float low, high;
        double step[128] = { 0.0 }, most = 0.0; /* mean squares of steps to the column before */
        wr_field_range(f, &low, &high);
        assert_near((double)low, -1.0, 1e-6);
        assert_near((double)high, 2.0, 1e-6);
        for (int k = 0; k < 128 * 96; k++) {
            int i = k % 128, j = k / 128;
            double d = (double)wr_field_get(f, i, j) - (double)wr_field_get(f, (i + 127) % 128, j);
            step[i] += d * d / 96.0;
        }
        for (int i = 1; i < 128; i++) most = fmax(most, step[i]);
        assert_true(step[0] < most && most < 0.2);
        wr_field_free(f);
    }
    wr_field_free(like);
}

/* Mean square of the second differences, below and above half the height. */
static void roughness(const WrField *f, double rough[2])
{
    double sum[2] = { 0, 0 }, count[2] = { 0, 0 };
    int w = wr_field_width(f), h = wr_field_height(f);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            double z = (double)wr_field_get(f, i, j);
            double d = 2.0 * z - (double)wr_field_get(f, (i + 1) % w, j) -
                       (double)wr_field_get(f, (i + w - 1) % w, j);
            sum[z > 0.5] += d * d;
            count[z > 0.5] += 1.0;
        }
    rough[0] = sum[0] / count[0];
    rough[1] = sum[1] / count[1];
}

static void detail_fades_towards_low_ground_as_told(void **state)
{
    (void)state;
    WrField *like = table_of(256, 256);
    double even[2], fading[2];
    Setting s[] = { { "type", 0 }, { "altitude", 0 }, { "erosion", 0 }, { NULL, 0 } };
    WrField *f = made_with("terrain", "fractal", s, like);
    roughness(f, even);
    wr_field_free(f);
    s[1].value = 1;
    f = made_with("terrain", "fractal", s, like);
    roughness(f, fading);
    assert_true(even[1] / even[0] < 1.5 && even[1] / even[0] > 0.67);
    assert_true(fading[1] / fading[0] > 3.0);
    wr_field_free(f);
    wr_field_free(like);
}

static void warped_mountains_roll_with_their_origin(void **state)
{
    (void)state;
    WrField *like = table_of(64, 64);
    Setting s[] = { { "warp", 0.5 }, { "octaves", 4 }, { NULL, 0 } };
    WrField *f = made_with("terrain", "fractal", s, like);
    const WrGenerator *g = wr_generator_find("terrain", "fractal");
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(g, values);
    value_of(g, values, "warp")->number[0] = 0.5;
    value_of(g, values, "octaves")->number[0] = 4;
    value_of(g, values, "origin")->number[0] = 10.0 / 64;
    value_of(g, values, "origin")->number[1] = 3.0 / 64;
    WrField *moved = made(g, values, like, NULL, false);
    assert_true(is_rolled(f, moved, 10, 3));
    s[0].value = 0;
    WrField *straight = made_with("terrain", "fractal", s, like);
    assert_true(largest_difference(f, straight) > 0.1);
    wr_field_free(f);
    wr_field_free(moved);
    wr_field_free(straight);
    wr_field_free(like);
}

static void the_sea_is_flat(void **state)
{
    (void)state;
    WrField *like = table_of(64, 64);
    static const Setting s[] = { { "sea", 0.5 }, { NULL, 0 } };
    WrField *f = made_with("terrain", "fractal", s, like);
    WrField *dry = made_with("terrain", "fractal", NULL, like);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++)
            assert_true(wr_field_get(f, i, j) == fmaxf(0.5f, wr_field_get(dry, i, j)));
    wr_field_free(f);
    wr_field_free(dry);
    wr_field_free(like);
}

/* ---- terraces ---- */

static WrField *slope_of_256(void)
{
    WrField *f = table_of(256, 4);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 256; i++) wr_field_set(f, i, j, (float)i / 255.0f);
    return f;
}

/* Half of each of 4 steps is flat, at 0, 1/4, 1/2, 3/4; then it rises to the next. */
static void terraces_are_flat_and_as_high_as_steps_say(void **state)
{
    (void)state;
    WrField *slope = slope_of_256();
    static const Setting s[] = { { "steps", 4 },  { "sharpness", 1 }, { "riser", 0.5 },
                                 { "jitter", 0 }, { "uneven", 0 },    { NULL, 0 } };
    WrField *f = made_with("terrain", "terraces", s, slope);
    for (int i = 0; i < 256; i++) {
        double x = 4.0 * i / 255.0, k = floor(x), t = fmax(0.0, 2.0 * (x - k) - 1.0);
        assert_near((double)wr_field_get(f, i, 2), 0.25 * (k + t * t * (3.0 - 2.0 * t)), 1e-6);
    }
    wr_field_free(f);
    wr_field_free(slope);
}

static void terraces_without_sharpness_change_nothing(void **state)
{
    (void)state;
    WrField *slope = slope_of_256();
    static const Setting s[] = { { "sharpness", 0 }, { NULL, 0 } };
    WrField *f = made_with("terrain", "terraces", s, slope);
    assert_true(largest_difference(f, slope) < 1e-6);
    WrField *flat = table_of(30, 30), *same = made_with("terrain", "terraces", NULL, flat);
    assert_true(is_rolled(flat, same, 0, 0));
    wr_field_free(f);
    wr_field_free(slope);
    wr_field_free(flat);
    wr_field_free(same);
}

/* For any jitter: within a step and its unevenness of the original. */
static void terraces_stay_near_what_lies_there(void **state)
{
    (void)state;
    WrField *like = table_of(128, 128), *hills = made_with("terrain", "fractal", NULL, like);
    static const Setting s[] = { { "steps", 10 }, { "jitter", 1 }, { "uneven", 1 }, { NULL, 0 } };
    WrField *f = made_with("terrain", "terraces", s, hills);
    assert_true(largest_difference(f, hills) < 0.18 && largest_difference(f, hills) > 0.03);
    wr_field_free(f);
    wr_field_free(hills);
    wr_field_free(like);
}

/* ---- elevations ---- */

static char said_text[2000];

static WrField *elevation(const char *path, const char *size, const Setting *s, const WrField *like,
                          WrError *err)
{
    const WrGenerator *g = wr_generator_find("terrain", "elevation");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrRelief relief = { NULL, NULL };
    Said said = { "" };
    WrGenerateJob job = { .like = like, .note = hear, .note_ctx = &said };
    wr_generator_defaults(g, values);
    value_of(g, values, "file")->text = path;
    if (size) value_of(g, values, "size")->text = size;
    for (; s && s->name; s++) value_of(g, values, s->name)->number[0] = s->value;
    bool good = wr_generator_make(g, values, &job, &relief, err);
    snprintf(said_text, sizeof said_text, "%s", said.text);
    return good ? relief.heights : NULL;
}

static const char *const raw = WR_BINARY_DIR "/test_terrain.r16";

static void raw_codes_are_scaled_by_65535_in_either_byte_order(void **state)
{
    (void)state;
    static const uint8_t bytes[] = { 0, 0, 0xff, 0xff, 0x34, 0x12, 1, 0, 0, 0x80, 0xff, 0x7f };
    WrField *like = table_of(3, 2);
    for (int big = 0; big < 2; big++) {
        const Setting s[] = { { "order", big }, { "low", -1 }, { "high", 1 }, { NULL, 0 } };
        WrError err;
        assert_true(wr_file_write(raw, bytes, sizeof bytes, NULL));
        WrField *f = elevation(raw, "3x2", s, like, &err);
        if (!f) fail_msg("%s", err.text);
        for (int k = 0; k < 6; k++) {
            int code =
                big ? bytes[2 * k] * 256 + bytes[2 * k + 1] : bytes[2 * k + 1] * 256 + bytes[2 * k];
            assert_near((double)wr_field_get(f, k % 3, k / 3), 2.0 * code / 65535.0 - 1.0, 1e-7);
        }
        wr_field_free(f);
    }
    wr_field_free(like);
}

static void signed_metres_are_real_and_what_is_not_known_is_filled(void **state)
{
    (void)state;
    int16_t metres[16];
    for (int k = 0; k < 16; k++) metres[k] = (int16_t)(100 + 10 * (k % 4));
    metres[5] = -32768;
    metres[10] = -9999;
    metres[15] = 777;
    static const Setting s[] = {
        { "sample", 2 }, { "scale", 0.01 }, { "nodata", 777 }, { NULL, 0 }
    };
    WrField *like = table_of(4, 4);
    WrError err;
    assert_true(wr_file_write(raw, metres, sizeof metres, NULL));
    WrField *f = elevation(raw, NULL, s, like, &err); /* a square of 16 */
    if (!f) fail_msg("%s", err.text);
    for (int k = 0; k < 16; k++) {
        double z = (double)wr_field_get(f, k % 4, k / 4);
        if (k == 5 || k == 10 || k == 15) assert_true(z >= 1.0 && z <= 1.3);
        else assert_near(z, 1.0 + 0.1 * (k % 4), 1e-6);
    }
    assert_non_null(strstr(said_text, "3 of 16"));
    wr_field_free(f);
    wr_field_free(like);
}

static void raw_floats_lose_nan_and_infinity(void **state)
{
    (void)state;
    const char *path = WR_BINARY_DIR "/test_terrain.r32";
    const float z[] = { 5.0f, NAN, INFINITY, 5.0f, -3.4e38f, 5.0f };
    WrField *like = table_of(6, 1);
    WrError err;
    assert_true(wr_file_write(path, z, sizeof z, NULL));
    WrField *f = elevation(path, "6x1", NULL, like, &err);
    if (!f) fail_msg("%s", err.text);
    for (int i = 0; i < 6; i++) assert_true(wr_field_get(f, i, 0) == 5.0f);
    assert_non_null(strstr(said_text, "3 of 6"));
    wr_field_free(f);
    const float none[] = { NAN, NAN };
    assert_true(wr_file_write(path, none, sizeof none, NULL));
    assert_null(elevation(path, "2x1", NULL, like, &err));
    assert_non_null(strstr(err.text, "contains no elevation"));
    wr_field_free(like);
}

static void wrong_sizes_are_told_with_what_would_fit(void **state)
{
    (void)state;
    static const struct {
        const char *size, *tells;
        size_t bytes;
    } cases[] = { { "4x3", "24 bytes, the file has 32; they would be 4x4", 32 },
                  { "", "give columns and rows", 30 },
                  { "", "give columns and rows", 1 },
                  { "x4", "as in 1024x512", 32 },
                  { "4x4 ", "as in 1024x512", 32 },
                  { "0x4", "as in 1024x512", 32 },
                  { "4x99999", "as in 1024x512", 32 },
                  { "-4x4", "as in 1024x512", 32 },
                  { "4x444444444444444", "as in 1024x512", 32 },
                  { "4x4", "the file has 31", 31 } };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WrRaw r = { .kind = WR_RAW_U16, .width = 7 };
        WrError err = { "" };
        assert_false(wr_raw_size(cases[k].size, cases[k].bytes, &r, &err));
        if (!strstr(err.text, cases[k].tells)) fail_msg("%zu: %s", k, err.text);
        assert_int_equal(r.width, 7);
    }
    WrError err;
    WrField *like = table_of(4, 4);
    assert_true(wr_file_write(raw, "", 0, NULL));
    assert_null(elevation(raw, NULL, NULL, like, &err));
    assert_non_null(strstr(err.text, "test_terrain.r16"));
    assert_null(elevation(WR_BINARY_DIR "/none_such.raw", NULL, NULL, like, &err));
    wr_field_free(like);
}

/* 16 bits are exact; half of the texels are means of four. */
static void pictures_are_exact_and_averaged_by_area(void **state)
{
    (void)state;
    const char *path = WR_BINARY_DIR "/test_terrain.png";
    uint16_t codes[8][8];
    TestRandom r = { 2 };
    for (int k = 0; k < 64; k++) codes[k / 8][k % 8] = (uint16_t)test_random_u64(&r);
    assert_true(wr_image_write_pixels(path, 8, 8, 1, WR_PIXEL_U16, true, codes, NULL));
    for (int size = 8; size >= 4; size /= 2) {
        WrField *like = table_of(size, size);
        WrError err;
        WrField *f = elevation(path, NULL, NULL, like, &err);
        if (!f) fail_msg("%s", err.text);
        int n = 8 / size;
        for (int j = 0; j < size; j++)
            for (int i = 0; i < size; i++) {
                double sum = 0.0;
                for (int k = 0; k < n * n; k++) sum += codes[n * j + k / n][n * i + k % n];
                assert_near((double)wr_field_get(f, i, j), sum / (n * n) / 65535.0, 1e-7);
            }
        assert_null(elevation(path, "8x8", NULL, like, &err));
        assert_non_null(strstr(err.text, "its own size"));
        wr_field_free(f);
        wr_field_free(like);
    }
}

/* NaN becomes 0 when pictures are read; its positions are still known. */
static void pictures_of_floats_are_real_and_their_nan_is_filled(void **state)
{
    (void)state;
    const char *path = WR_BINARY_DIR "/test_terrain.exr";
    float z[36];
    for (int k = 0; k < 36; k++) z[k] = 800.0f + (float)(k % 6);
    z[14] = NAN;
    assert_true(wr_image_write_pixels(path, 6, 6, 1, WR_PIXEL_F32, true, z, NULL));
    WrField *like = table_of(6, 6);
    WrError err;
    WrField *f = elevation(path, NULL, NULL, like, &err);
    if (!f) fail_msg("%s", err.text);
    for (int k = 0; k < 36; k++)
        assert_near((double)wr_field_get(f, k % 6, k / 6), 800.0 + k % 6, k == 14 ? 1.0 : 0.0);
    assert_true(strstr(said_text, "1 of 36") || z[14] == 0.0f);
    wr_field_free(f);
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mountains_fill_their_height_and_meet_themselves),
        cmocka_unit_test(detail_fades_towards_low_ground_as_told),
        cmocka_unit_test(warped_mountains_roll_with_their_origin),
        cmocka_unit_test(the_sea_is_flat),
        cmocka_unit_test(terraces_are_flat_and_as_high_as_steps_say),
        cmocka_unit_test(terraces_without_sharpness_change_nothing),
        cmocka_unit_test(terraces_stay_near_what_lies_there),
        cmocka_unit_test(raw_codes_are_scaled_by_65535_in_either_byte_order),
        cmocka_unit_test(signed_metres_are_real_and_what_is_not_known_is_filled),
        cmocka_unit_test(raw_floats_lose_nan_and_infinity),
        cmocka_unit_test(wrong_sizes_are_told_with_what_would_fit),
        cmocka_unit_test(pictures_are_exact_and_averaged_by_area),
        cmocka_unit_test(pictures_of_floats_are_real_and_their_nan_is_filled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
