/* Heights from normal maps. */
#include "test.h"
#include "generate_help.h"

#include "base/memory.h"
#include "generate/normals.h"
#include "image/image.h"

static const double tau = 6.283185307179586;
static const WrGenerateJob alone = { .pool = NULL };

/* A height with its slopes at x, y (down), 0..1. */
typedef double (*Surface)(double x, double y, double *fx, double *fy);

/* Periodic waves without symmetry about either axis. */
static double waves(double x, double y, double *fx, double *fy)
{
    double a = tau * (2 * x + y), b = tau * (x - 3 * y) + 1.0, c = tau * 4 * x + 0.5;
    *fx = tau * (0.2 * cos(a) - 0.05 * sin(b) + 0.08 * cos(c));
    *fy = tau * (0.1 * cos(a) + 0.15 * sin(b));
    return 0.1 * sin(a) + 0.05 * cos(b) + 0.02 * sin(c);
}

/* A hill on a slope, not periodic. */
static double hill(double x, double y, double *fx, double *fy)
{
    double a = x - 0.3, b = y - 0.6, e = 0.5 * exp(-4.0 * (a * a + b * b));
    *fx = -8.0 * a * e + 0.3 + 0.4 * y;
    *fy = -8.0 * b * e + 0.4 * x;
    return e + 0.3 * x + 0.4 * x * y;
}

static WrNormals slopes_of(Surface surface, int width, int height)
{
    size_t count = (size_t)width * (size_t)height;
    WrNormals n = { .width = width, .height = height };
    n.p = wr_alloc(count, sizeof *n.p);
    n.q = wr_alloc(count, sizeof *n.q);
    for (size_t k = 0; k < count; k++) {
        double x = (double)(k % (size_t)width), y = (double)(k / (size_t)width);
        surface((x + 0.5) / width, (y + 0.5) / height, &n.p[k], &n.q[k]);
    }
    return n;
}

static WrIntegral usual(const WrNormals *n, WrEnds ends)
{
    return (WrIntegral){ .ends = { ends, ends }, .unit = { 1.0 / n->width, 1.0 / n->height } };
}

/* Largest error of the heights, up to a constant. */
static double error_of(Surface surface, int width, int height, WrEnds ends)
{
    WrNormals n = slopes_of(surface, width, height);
    WrIntegral how = usual(&n, ends);
    WrSheet sheet;
    double low = 1e9, high = -1e9, unused;
    assert_true(wr_normals_integrate(&n, &how, &alone, &sheet, NULL));
    for (int k = 0; k < width * height; k++) {
        double d = sheet.z[k] -
                   surface((k % width + 0.5) / width, (k / width + 0.5) / height, &unused, &unused);
        low = fmin(low, d);
        high = fmax(high, d);
    }
    wr_sheet_fini(&sheet);
    wr_normals_fini(&n);
    return 0.5 * (high - low);
}

static void periodic_heights_come_back_to_rounding(void **state)
{
    (void)state;
    assert_true(error_of(waves, 32, 24, WR_ENDS_RING) < 1e-13);
    assert_true(error_of(waves, 45, 31, WR_ENDS_RING) < 1e-13);
}

/* Third order at the ends, fourth inside. */
static void free_heights_come_back_to_third_order_or_better(void **state)
{
    (void)state;
    double coarse = error_of(hill, 24, 32, WR_ENDS_FREE),
           fine = error_of(hill, 48, 64, WR_ENDS_FREE);
    assert_true(coarse < 1e-4 && fine > 1e-12);
    assert_true(coarse / fine > 7.0);
}

static void slopes_by_central_differences_give_their_heights_exactly(void **state)
{
    (void)state;
    enum { W = 27, H = 35 }; /* odd, so that every height has a slope */
    TestRandom r = { 3 };
    double f[H][W], mean = 0.0;
    WrNormals n = slopes_of(waves, W, H);
    WrIntegral how = { .central = true, .unit = { 1.0, 1.0 } };
    WrSheet sheet;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) mean += (f[j][i] = test_random(&r)) / (W * H);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            n.p[j * W + i] = 0.5 * (f[j][(i + 1) % W] - f[j][(i + W - 1) % W]);
            n.q[j * W + i] = 0.5 * (f[(j + 1) % H][i] - f[(j + H - 1) % H][i]);
        }
    assert_true(wr_normals_integrate(&n, &how, &alone, &sheet, NULL));
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) assert_near(sheet.z[j * W + i], f[j][i] - mean, 1e-10);
    assert_near(how.residual_deg, 0.0, 1e-7);
    wr_sheet_fini(&sheet);
    wr_normals_fini(&n);
}

/* p = -psi_y, q = psi_x is a pure rotation: no height explains any of it. */
static void what_no_height_can_explain_is_told_as_an_angle(void **state)
{
    (void)state;
    WrNormals n = slopes_of(waves, 40, 40);
    WrIntegral how = usual(&n, WR_ENDS_RING);
    WrSheet sheet;
    double sum = 0.0;
    for (int k = 0; k < 1600; k++) {
        double p = n.p[k];
        n.p[k] = -n.q[k];
        n.q[k] = p;
        sum += pow(atan(hypot(n.p[k], n.q[k])) * 360.0 / tau, 2.0) / 1600.0;
    }
    assert_true(wr_normals_integrate(&n, &how, &alone, &sheet, NULL));
    for (int k = 0; k < 1600; k++) assert_near(sheet.z[k], 0.0, 1e-14);
    assert_near(how.residual_deg, sqrt(sum), 1e-9);
    assert_true(sqrt(sum) > 10.0);
    wr_sheet_fini(&sheet);
    wr_normals_fini(&n);
}

/* A tilt of atan(0.1): removed from a ring with a note, kept on an open axis. */
static void a_lean_is_kept_with_free_edges_and_told_on_a_ring(void **state)
{
    (void)state;
    WrNormals n = slopes_of(waves, 16, 16);
    WrSheet sheet;
    for (int k = 0; k < 256; k++) n.p[k] = 0.1, n.q[k] = 0.0;
    WrIntegral ring = usual(&n, WR_ENDS_RING), sheets = usual(&n, WR_ENDS_FREE);
    assert_true(wr_normals_integrate(&n, &ring, &alone, &sheet, NULL));
    assert_near(sheet.z[15] - sheet.z[0], 0.0, 1e-14);
    assert_near(ring.tilt_deg[0], atan(0.1) * 360.0 / tau, 1e-9);
    wr_sheet_fini(&sheet);
    assert_true(wr_normals_integrate(&n, &sheets, &alone, &sheet, NULL));
    assert_near(sheet.z[15] - sheet.z[0], 0.1 * 15.0 / 16.0, 1e-12);
    assert_near(sheets.residual_deg, 0.0, 1e-9);
    wr_sheet_fini(&sheet);
    wr_normals_fini(&n);
}

static void maps_of_all_small_sizes_are_integrated(void **state)
{
    (void)state;
    for (int k = 0; k < 100; k++) {
        WrNormals n = slopes_of(hill, 1 + k % 5, 1 + k / 5 % 5);
        WrIntegral how = usual(&n, k < 50 ? WR_ENDS_RING : WR_ENDS_FREE);
        WrSheet sheet;
        how.central = k / 25 % 2;
        how.ends[1] = k % 3 ? WR_ENDS_RING : WR_ENDS_FREE;
        assert_true(wr_normals_integrate(&n, &how, &alone, &sheet, NULL));
        for (int t = 0; t < n.width * n.height; t++) assert_true(fabs(sheet.z[t]) < 10.0);
        assert_true(how.residual_deg >= 0.0 && how.residual_deg < 180.0);
        wr_sheet_fini(&sheet);
        wr_normals_fini(&n);
    }
}

/* ---- maps ---- */

/* A map as written by tools: 8-bit codes, green up or down. */
static WrImage *map_of(Surface surface, int size, bool up)
{
    WrImage *image = wr_image_new(size, size, 3, NULL);
    image->type = WR_PIXEL_U8;
    for (int k = 0; k < size * size; k++) {
        double p, q;
        surface((k % size + 0.5) / size, (k / size + 0.5) / size, &p, &q);
        double l = 1.0 / sqrt(1.0 + p * p + q * q);
        const double n[] = { -p * l, up ? q * l : -q * l, l };
        for (int a = 0; a < 3; a++)
            image->data[3 * k + a] = (float)(rint(255.0 * (0.5 * n[a] + 0.5)) / 255.0);
    }
    return image;
}

static void both_directions_of_green_are_found(void **state)
{
    (void)state;
    static const Surface surfaces[] = { waves, hill };
    for (int k = 0; k < 4; k++) {
        WrImage *image = map_of(surfaces[k / 2], 64, k % 2 == 0);
        WrNormals n;
        assert_true(wr_normals_decode(image, WR_CODING_AUTO, &n, NULL));
        double r = wr_normals_upward(&n);
        if (k % 2 == 0 ? r < 0.5 : r > -0.5) fail_msg("map %d: %g", k, r);
        wr_normals_flip(&n);
        assert_near(wr_normals_upward(&n), -r, 1e-15);
        for (int t = 0; t < 64 * 64; t++) n.p[t] *= 3.0; /* texels that are not square */
        assert_near(wr_normals_upward(&n), -r, 1e-12);
        wr_normals_fini(&n);
        wr_image_free(image);
    }
}

static void flat_maps_of_either_middle_code_are_flat(void **state)
{
    (void)state;
    static const struct {
        WrPixelType type;
        double code, most;
    } cases[] = { { WR_PIXEL_U8, 127, 255 },
                  { WR_PIXEL_U8, 128, 255 },
                  { WR_PIXEL_U16, 32767, 65535 },
                  { WR_PIXEL_U16, 32768, 65535 } };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        WrImage *image = wr_image_new(8, 4, 3, NULL);
        image->type = cases[c].type;
        for (int k = 0; k < 96; k++)
            image->data[k] = k % 3 == 2 ? 1.0f : (float)(cases[c].code / cases[c].most);
        WrNormals n;
        assert_true(wr_normals_decode(image, WR_CODING_AUTO, &n, NULL));
        for (int k = 0; k < 32; k++) assert_true(n.p[k] == 0.0 && n.q[k] == 0.0);
        assert_true(wr_normals_upward(&n) == 0.0);
        wr_normals_fini(&n);
        wr_image_free(image);
    }
}

static void floats_are_read_as_they_are_or_as_codes(void **state)
{
    (void)state;
    for (int as_codes = 0; as_codes < 2; as_codes++) {
        WrImage *image = wr_image_new(4, 4, 3, NULL);
        image->type = WR_PIXEL_F32;
        for (int k = 0; k < 16; k++) {
            const float n[] = { 0.6f, 0.0f, 0.8f };
            for (int a = 0; a < 3; a++)
                image->data[3 * k + a] = as_codes ? 0.5f * n[a] + 0.5f : n[a];
        }
        WrNormals n;
        assert_true(wr_normals_decode(image, WR_CODING_AUTO, &n, NULL));
        assert_near(n.p[5], -0.75, 1e-6);
        assert_near(n.q[5], 0.0, 1e-6);
        wr_normals_fini(&n);
        wr_image_free(image);
    }
}

static void normals_that_do_not_face_up_are_flat_and_counted(void **state)
{
    (void)state;
    static const float odd[][3] = {
        { 0, 0, 0 }, { 0.5f, 0, -0.5f }, { 1, 0, 1e-9f }, { 3e38f, 0, 1 }
    };
    WrImage *image = wr_image_new(4, 1, 3, NULL);
    image->type = WR_PIXEL_F32;
    memcpy(image->data, odd, sizeof odd);
    WrNormals n;
    assert_true(wr_normals_decode(image, WR_CODING_SIGNED, &n, NULL));
    assert_int_equal(n.unknown, 3);
    assert_int_equal(n.steep, 1);
    assert_true(n.p[0] == 0.0 && n.p[1] == 0.0 && n.p[2] == -100.0 && n.p[3] == 0.0);
    wr_normals_fini(&n);
    wr_image_free(image);
    WrError err;
    image = wr_image_new(4, 4, 1, NULL);
    assert_false(wr_normals_decode(image, WR_CODING_AUTO, &n, &err));
    assert_non_null(strstr(err.text, "2 channels"));
    wr_image_free(image);
}

/* ---- the row ---- */

static WrField *heights_of(const WrImage *map, double height, const char *y, Said *said)
{
    const WrGenerator *g = wr_generator_find("picture", "normals");
    const char *path = WR_BINARY_DIR "/test_normals.png";
    size_t count = (size_t)map->width * (size_t)map->height * 3;
    uint8_t *codes = wr_alloc(count, 1);
    wr_image_codes(WR_PIXEL_U8, map->data, count, codes, NULL);
    assert_true(
        wr_image_write_pixels(path, map->width, map->height, 3, WR_PIXEL_U8, true, codes, NULL));
    wr_free(codes);
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(g, values);
    value_of(g, values, "file")->text = path;
    value_of(g, values, "height")->number[0] = height;
    value_of(g, values, "y")->number[0] = strcmp(y, "auto") == 0 ? 0 : strcmp(y, "up") == 0 ? 1 : 2;
    WrField *like = table_of(map->width, map->height);
    WrGenerateJob job = { .like = like, .note = hear, .note_ctx = said };
    WrRelief relief = { NULL, NULL };
    WrError err;
    if (!wr_generator_make(g, values, &job, &relief, &err)) fail_msg("%s", err.text);
    wr_field_free(like);
    return relief.heights;
}

/* 8-bit codes have an error of at most 1/510; heights far less than that times the map's width. */
static void a_file_gives_heights_in_table_units_and_tells_what_it_found(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++) {
        Said said = { "" };
        WrImage *map = map_of(waves, 64, up);
        WrField *f = heights_of(map, 0.5, "auto", &said);
        double low = 1e9, high = -1e9, unused;
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 64; i++) {
                double want = waves((i + 0.5) / 64, (j + 0.5) / 64, &unused, &unused) / 0.5;
                low = fmin(low, (double)wr_field_get(f, i, j) - want);
                high = fmax(high, (double)wr_field_get(f, i, j) - want);
            }
        assert_true(high - low < 0.004); /* of a relief of 0.6 */
        float lowest, highest;
        wr_field_range(f, &lowest, &highest);
        assert_true(lowest == 0.0f && highest > 0.5f);
        assert_non_null(strstr(said.text, up ? "up (+Y)" : "down (-Y)"));
        assert_non_null(strstr(said.text, "degrees (rms)"));
        wr_field_free(f);
        wr_image_free(map);
    }
}

/* Rough ground by central differences, where the two kinds of slopes differ. */
static double jagged(double x, double y, double *fx, double *fy)
{
    double f[3][3];
    for (int k = 0; k < 9; k++) {
        double a = x + (k % 3 - 1) / 64.0, b = y + (k / 3 - 1) / 64.0;
        f[k / 3][k % 3] = 0.02 * sin(tau * (19 * a + 3 * b)) * cos(tau * (5 * a - 14 * b));
    }
    *fx = 32.0 * (f[1][2] - f[1][0]);
    *fy = 32.0 * (f[2][1] - f[0][1]);
    return f[1][1];
}

static void central_differences_are_recognised(void **state)
{
    (void)state;
    static const Surface surfaces[] = { waves, jagged };
    for (int k = 0; k < 2; k++) {
        Said said = { "" };
        WrImage *map = map_of(surfaces[k], 64, true);
        WrField *f = heights_of(map, 1.0, "auto", &said);
        double low = 1e9, high = -1e9, unused;
        for (int t = 0; t < 4096; t++) {
            double d = (double)wr_field_get(f, t % 64, t / 64) -
                       surfaces[k]((t % 64 + 0.5) / 64, (t / 64 + 0.5) / 64, &unused, &unused);
            low = fmin(low, d);
            high = fmax(high, d);
        }
        assert_true(high - low < 0.004);
        assert_int_equal(strstr(said.text, "central differences") != NULL, k == 1);
        wr_field_free(f);
        wr_image_free(map);
    }
}

static void a_sign_against_the_maps_own_is_told(void **state)
{
    (void)state;
    Said said = { "" };
    WrImage *map = map_of(waves, 64, true);
    WrField *f = heights_of(map, 1.0, "down", &said);
    assert_non_null(strstr(said.text, "opposite"));
    wr_field_free(f);
    wr_image_free(map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(periodic_heights_come_back_to_rounding),
        cmocka_unit_test(free_heights_come_back_to_third_order_or_better),
        cmocka_unit_test(slopes_by_central_differences_give_their_heights_exactly),
        cmocka_unit_test(what_no_height_can_explain_is_told_as_an_angle),
        cmocka_unit_test(a_lean_is_kept_with_free_edges_and_told_on_a_ring),
        cmocka_unit_test(maps_of_all_small_sizes_are_integrated),
        cmocka_unit_test(both_directions_of_green_are_found),
        cmocka_unit_test(flat_maps_of_either_middle_code_are_flat),
        cmocka_unit_test(floats_are_read_as_they_are_or_as_codes),
        cmocka_unit_test(normals_that_do_not_face_up_are_flat_and_counted),
        cmocka_unit_test(a_file_gives_heights_in_table_units_and_tells_what_it_found),
        cmocka_unit_test(central_differences_are_recognised),
        cmocka_unit_test(a_sign_against_the_maps_own_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
