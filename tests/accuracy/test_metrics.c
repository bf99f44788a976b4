/* Error measures between a picture and the reference: known differences. */
#include "test.h"

#include "accuracy/metrics.h"
#include "base/memory.h"
#include "render/frame/frame.h"

#define W 40
#define H 30

/* A picture and an equal reference, fully covered. */
typedef struct Pair {
    float rgba[W * H * 4], normal[W * H * 3];
    WrReference reference;
} Pair;

static Pair *equal_pair(void)
{
    Pair *pair = wr_alloc(1, sizeof *pair);
    pair->reference.width = W, pair->reference.height = H;
    pair->reference.rgba = wr_alloc(W * H * 4, sizeof(double));
    pair->reference.normal = wr_alloc(W * H * 3, sizeof(double));
    for (int i = 0; i < W * H; i++) {
        for (int c = 0; c < 4; c++) pair->rgba[4 * i + c] = c == 3 ? 1 : 0.25f * (float)c;
        for (int c = 0; c < 3; c++) pair->normal[3 * i + c] = c == 2;
        for (int c = 0; c < 4; c++) pair->reference.rgba[4 * i + c] = (double)pair->rgba[4 * i + c];
        for (int c = 0; c < 3; c++)
            pair->reference.normal[3 * i + c] = (double)pair->normal[3 * i + c];
    }
    return pair;
}

static WrErrors measure(const Pair *pair, const unsigned char *only)
{
    WrErrors errors;
    wr_errors_measure(pair->rgba, pair->normal, &pair->reference, only, &errors);
    return errors;
}

static void free_pair(Pair *pair)
{
    wr_reference_fini(&pair->reference);
    wr_free(pair);
}

static void hc20_equal_pictures_do_not_differ_at_all(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    const WrErrors e = measure(pair, NULL);
    assert_int_equal(e.pixels, W * H);
    assert_int_equal(e.covered, W * H);
    assert_int_equal(e.edges, 0);
    assert_true(e.rms == 0 && e.rms_all == 0 && e.max == 0 && e.p999 == 0);
    assert_true(e.rms_inside == 0 && e.max_inside == 0);
    assert_true(e.angle_rms == 0 && e.angle_max == 0 && e.angle_p999 == 0);
    assert_true(e.coverage_rms == 0 && e.coverage_max == 0);
    free_pair(pair);
}

static void known_differences_have_their_mean_square_largest_and_percentile(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    /* Pixel i has an error of i / 1024 in one channel: exact in float. */
    for (int i = 0; i < W * H; i++) pair->reference.rgba[4 * i + i % 3] += i / 1024.0;
    WrErrors e = measure(pair, NULL);
    const double n = W * H;
    const double squares = (n - 1) * n * (2 * n - 1) / 6 / (1024.0 * 1024.0);
    assert_near(e.rms, sqrt(squares / (3 * n)), 1e-13);
    assert_near(e.rms_all, e.rms, 1e-15);
    assert_near(e.max, (n - 1) / 1024, 1e-15);
    assert_near(e.p999, 1198 / 1024.0, 1e-15); /* of 1200, the 1199th */
    free_pair(pair);
}

static void hc20_angles_are_kept_from_none_to_opposite(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    static const double degrees[] = { 0, 1e-5, 0.5, 90, 179, 180 };
    for (int i = 0; i < W * H; i++) {
        const double a = degrees[i % 6] * 3.14159265358979323846 / 180;
        double *n = pair->reference.normal + 3 * i;
        n[0] = sin(a), n[2] = cos(a);
    }
    WrErrors e = measure(pair, NULL);
    double squares = 0;
    for (int k = 0; k < 6; k++) squares += degrees[k] * degrees[k] / 6;
    assert_near(e.angle_max, 180, 1e-12);
    assert_near(e.angle_p999, 180, 1e-12);
    assert_near(e.angle_rms, sqrt(squares), 1e-9);
    for (int i = 0; i < W * H; i++) /* only the lowest bit: acos would return 0 */
        if (i % 6 != 1) pair->normal[3 * i + 2] = 0;
    e = measure(pair, NULL);
    assert_near(e.angle_max, 1e-5, 1e-15);
    assert_near(e.angle_rms, 1e-5, 1e-15);
    wr_errors_measure(pair->rgba, NULL, &pair->reference, NULL, &e);
    assert_true(isnan(e.angle_rms) && isnan(e.angle_max) && isnan(e.angle_p999));
    free_pair(pair);
}

static void outlines_are_told_apart_from_what_lies_within(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    double *theirs = pair->reference.rgba;
    theirs[3] = 0.5, theirs[0] = 4; /* an edge pixel with a large error */
    pair->rgba[4 + 3] = 0;          /* covered in the reference alone */
    for (int c = 0; c < 4; c++) pair->rgba[8 + c] = 0, theirs[8 + c] = 0; /* nothing in either */
    theirs[12] += 0.25;                                                   /* inside */
    const WrErrors e = measure(pair, NULL);
    assert_int_equal(e.covered, W * H - 1);
    assert_int_equal(e.edges, 2);
    assert_near(e.coverage_max, 1, 0);
    assert_near(e.coverage_rms, sqrt((0.25 + 1) / 2), 1e-15);
    assert_near(e.max_inside, 0.25, 0);
    assert_near(e.max, 4, 0);
    assert_near(e.rms_inside, sqrt(0.0625 / (3.0 * (W * H - 3))), 1e-15);
    assert_near(e.rms, sqrt((16 + 0.0625) / (3.0 * (W * H - 1))), 1e-15);
    assert_near(e.rms_all, sqrt((16 + 0.0625) / (3.0 * W * H)), 1e-15);
    free_pair(pair);
}

static void a_picture_of_nothing_but_edges_has_nothing_inside(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    for (int i = 0; i < W * H; i++) pair->reference.rgba[4 * i + 3] = i < 10 ? 0.5 : 0;
    for (int i = 10; i < W * H; i++) pair->rgba[4 * i + 3] = 0;
    for (int i = 0; i < 10; i++) pair->reference.rgba[4 * i] += 0.5;
    const WrErrors e = measure(pair, NULL);
    assert_int_equal(e.edges, 10);
    assert_near(e.max, 0.5, 1e-15);
    assert_near(e.rms, sqrt(0.25 / 3), 1e-15);
    assert_true(e.rms_inside == 0 && e.max_inside == 0);
    free_pair(pair);
}

static void only_the_blocks_that_count_are_measured(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    const int across = (W + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    const int down = (H + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    unsigned char *only = wr_alloc((size_t)(across * down), 1);
    only[0] = 1;
    pair->reference.rgba[4 * (H * W - 1)] += 3; /* in the last block */
    WrErrors e = measure(pair, only);
    const int w = WR_FRAME_BLOCK < W ? WR_FRAME_BLOCK : W;
    const int h = WR_FRAME_BLOCK < H ? WR_FRAME_BLOCK : H;
    assert_int_equal(e.pixels, w * h);
    assert_true(across * down == 1 || e.max == 0);
    only[across * down - 1] = 1;
    e = measure(pair, only);
    assert_near(e.max, 3, 1e-15);
    wr_free(only);
    free_pair(pair);
}

static void what_is_not_a_number_is_an_endless_error(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    pair->rgba[4 * 7] = NAN;
    const WrErrors e = measure(pair, NULL);
    assert_true(isinf(e.max) && isinf(e.rms));
    uint8_t *picture = wr_alloc(W * H * 3, 1);
    wr_errors_picture(pair->rgba, &pair->reference, 0, picture);
    assert_int_equal(picture[3 * 7], 255);
    assert_int_equal(picture[3 * 8], 0);
    wr_free(picture);
    free_pair(pair);
}

static void a_difference_picture_goes_from_black_to_white(void **state)
{
    (void)state;
    Pair *pair = equal_pair();
    uint8_t *picture = wr_alloc(W * H * 3, 1), rgb[3], last[3] = { 0, 0, 0 };
    for (int i = 0; i < W * H; i++) pair->reference.rgba[4 * i + 1] += i / 1024.0;
    wr_errors_picture(pair->rgba, &pair->reference, 0, picture);
    assert_true(picture[0] == 0 && picture[1] == 0 && picture[2] == 0);
    for (int c = 0; c < 3; c++) assert_int_equal(picture[3 * (W * H - 1) + c], 255);
    wr_errors_picture(pair->rgba, &pair->reference, 512 / 1024.0, picture);
    wr_heat_colour(0.5, rgb);
    assert_memory_equal(picture + 3 * 256, rgb, 3);
    for (int k = 0; k <= 100; k++) { /* lightness never decreases */
        wr_heat_colour(k / 100.0, rgb);
        assert_true(2 * rgb[0] + 7 * rgb[1] + rgb[2] >= 2 * last[0] + 7 * last[1] + last[2]);
        memcpy(last, rgb, 3);
    }
    wr_heat_colour(NAN, rgb);
    assert_int_equal(rgb[0], 0);
    wr_free(picture);
    free_pair(pair);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc20_equal_pictures_do_not_differ_at_all),
        cmocka_unit_test(known_differences_have_their_mean_square_largest_and_percentile),
        cmocka_unit_test(hc20_angles_are_kept_from_none_to_opposite),
        cmocka_unit_test(outlines_are_told_apart_from_what_lies_within),
        cmocka_unit_test(a_picture_of_nothing_but_edges_has_nothing_inside),
        cmocka_unit_test(only_the_blocks_that_count_are_measured),
        cmocka_unit_test(what_is_not_a_number_is_an_endless_error),
        cmocka_unit_test(a_difference_picture_goes_from_black_to_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
