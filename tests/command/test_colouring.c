/* `colouring`: colours by height, slope and cavity, against their formula. Updates are tested with layer terrains
   (test_terrain_layer.c), and rendering with colour textures. */
#include "test.h"
#include "session_help.h"

#include "base/exactmath.h"
#include "base/memory.h"
#include "field/wrap.h"
#include "image/image.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/patches.h"
#include "surface/terrain.h"

static WrHeightColormap ramp(void)
{
    return (WrHeightColormap){ .count = 4,
                               .stops = { { 0.1, { 0.2, 0.4, 0.9 } },
                                          { 0.35, { 0.7, 0.1, 0.3 } },
                                          { 0.35, { 0.05, 0.55, 0.15 } },
                                          { 0.8, { 2.5, 0.25, 0.6 } } },
                               .steep = true,
                               .steep_rgb = { 0.33, 0.21, 0.11 },
                               .slope = { 20, 47 } };
}

static void colour_at(double height, double slope, double out[3])
{
    const WrHeightColormap own = ramp();
    wr_height_colormap_at(&own, height, slope, out);
}

static void stops_are_met_and_steps_are_steps(void **state)
{
    (void)state;
    double c[3];
    colour_at(-3, 0, c);
    assert_near(c[2], 0.9, 0);
    colour_at(0.1625, 0, c); /* a quarter of the way */
    assert_near(c[0], 0.2 + 0.25 * 0.5, 1e-15);
    assert_near(c[1], 0.4 - 0.25 * 0.3, 1e-15);
    colour_at(0.35 - 1e-12, 0, c);
    assert_near(c[0], 0.7, 1e-10);
    colour_at(0.35, 0, c);
    assert_near(c[0], 0.05, 0);
    colour_at(9, 19, c);
    assert_near(c[0], 2.5, 0);
    colour_at(9, 26.75, c); /* t = 1/4: 1/16 (3 - 1/2) = 5/32 */
    assert_near(c[0], 2.5 + (0.33 - 2.5) * 5 / 32, 1e-14);
    colour_at(9, 47, c);
    assert_near(c[1], 0.21, 1e-15);
}

static void expect_colour(const WrImage *image, int k, double height, double slope, double off)
{
    double want[3];
    colour_at(height, slope, want);
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)image->data[3 * k + c] - want[c]) <= off))
            fail_msg("texel %d, %d: %g, not %g", k, c, (double)image->data[3 * k + c], want[c]);
}

/* For linearly increasing heights the spline is a plane, except at the ends. */
static void a_plane_has_the_colours_of_its_heights(void **state)
{
    (void)state;
    enum { W = 66, H = 30 };
    float heights[W * H], (*points)[48];
    const double rise = 0.9, a = 1.7, b = 0.8;
    for (int k = 0; k < W * H; k++) heights[k] = (float)((k % W + 0.5) / W);
    const WrTerrain terrain = {
        .ctx = heights, .w = W, .h = H, .a = a, .b = b, .height = rise, .cells = 22
    };
    int columns, rows;
    assert_true(wr_terrain_points(&terrain, &points, &columns, &rows, NULL));
    WrTriangles *made =
        wr_patches_new((const float(*)[48])points, columns * rows, WR_PATCH_SPLIT, NULL);
    const WrHeightColormap own = ramp();
    WrImage *image = wr_height_colormap_bake_terrain(&own, made->patches, rise, 53, 19, NULL);
    for (int k = 0; k < 53 * 19; k++) {
        const double u = (k % 53 + 0.5) / 53;
        if (u < 0.12 || u > 0.88 || fabs(u - 0.35) < 0.01) continue;
        expect_colour(image, k, u, atan(rise / a) * 180 / WR_PI, 2e-5);
    }
    wr_image_free(image);
    wr_triangles_free(made);
    wr_free(points);
}

static void a_table_has_the_colours_of_its_heights_and_slopes(void **state)
{
    (void)state;
    enum { W = 41, H = 73 };
    WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    TestRandom random = { 5 };
    for (int k = 0; k < W * H; k++) wr_field_set(field, k % W, k / W, (float)test_random(&random));
    const WrHeightColormap own = ramp();
    const double height = 0.017;
    WrImage *image = wr_height_colormap_table(&own, field, height, NULL);
    assert_int_equal(image->width, W);
    assert_int_equal(image->height, H);
    for (int k = 0; k < W * H; k++) {
        const int i = k % W, j = k / W;
        const double l = (double)wr_field_get(field, (i + W - 1) % W, j),
                     r = (double)wr_field_get(field, (i + 1) % W, j),
                     above = (double)wr_field_get(field, i, (j + H - 1) % H),
                     below = (double)wr_field_get(field, i, (j + 1) % H);
        const double slope = atan(height * hypot((r - l) / (2.0 / W), (above - below) / (2.0 / H)));
        expect_colour(image, k, (double)wr_field_get(field, i, j), slope * 180 / WR_PI, 1e-6);
    }
    wr_image_free(image);
    wr_field_free(field);
}

/* The mean about texel (i, j) of a periodic table, summed texel by texel. */
static double mean_about(const WrField *field, int i, int j, double sigma)
{
    const int w = wr_field_width(field), h = wr_field_height(field), reach = (int)ceil(5 * sigma);
    double sum = 0, all = 0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const double weight = exp(-0.5 * (x * x + y * y) / (sigma * sigma));
            sum +=
                weight * (double)wr_field_get(field, ((i + x) % w + w) % w, ((j + y) % h + h) % h);
            all += weight;
        }
    return sum / all;
}

static void hollows_have_their_colour(void **state)
{
    (void)state;
    enum { W = 23, H = 37 };
    WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    TestRandom random = { 77 };
    for (int k = 0; k < W * H; k++) wr_field_set(field, k % W, k / W, (float)test_random(&random));
    WrHeightColormap own = ramp();
    own.steep = false;
    WrImage *plain = wr_height_colormap_table(&own, field, 1, NULL);
    own.hollow = true, own.within = 1.9, own.depth[0] = 0.07, own.depth[1] = 0.31;
    own.hollow_rgb[0] = 0.02, own.hollow_rgb[1] = 0.63, own.hollow_rgb[2] = 1.4;
    WrImage *image = wr_height_colormap_table(&own, field, 1, NULL);
    int untouched = 0, alone = 0;
    for (int k = 0; k < W * H; k++) {
        const double below =
            mean_about(field, k % W, k / W, own.within) - (double)wr_field_get(field, k % W, k / W);
        const double t = fmin(fmax((below - 0.07) / (0.31 - 0.07), 0), 1);
        const double share = t * t * (3 - 2 * t);
        untouched += t <= 0, alone += t >= 1;
        for (int c = 0; c < 3; c++) {
            const double from = (double)plain->data[3 * k + c];
            /* the blur omits 6e-5 of its weight */
            assert_near(image->data[3 * k + c], from + share * (own.hollow_rgb[c] - from), 2e-3);
        }
    }
    assert_true(untouched > 100 && alone > 50);
    wr_image_free(plain);
    wr_image_free(image);
    wr_field_free(field);
}

static const WrScene *scene_in(const WrSession *session)
{
    return doc(session)->scene;
}

static void it_takes_the_place_of_a_colour_picture(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *const[]){ "table 30x20", "noise perlin cells=4", NULL });
    must_run(s, "colouring ramp steep=0.1,0.2,0.3");
    assert_int_equal(scene_in(s)->colouring.of, WR_HEIGHT_COLORMAP_TABLE);
    assert_int_equal(scene_in(s)->colour->width, 30);
    const WrImage *first = scene_in(s)->colour;
    must_run(s, "camera orbit 5,5"); /* none of its inputs */
    assert_ptr_equal(scene_in(s)->colour, first);
    must_run(s, "bump height=0.07"); /* slopes */
    assert_ptr_not_equal(scene_in(s)->colour, first);
    must_run(s, "colouring ramp stops=0,1,0,0");
    assert_int_equal(scene_in(s)->colouring.count, 1);
    assert_true(scene_in(s)->colouring.steep); /* it stays */
    must_run(s, "undo");
    assert_int_equal(scene_in(s)->colouring.count, 8);
    must_fail(s, "colouring ramp of=form", "only a terrain has one");
    must_fail(s, "colouring ramp stops=1,0,0,0;0.5,0,0,0", "stops must rise");
    must_fail(s, "colouring ramp slope=50,40", "must not be less");
    must_fail(s, "colouring ramp depth=0.5,0.4", "must not be less");
    must_fail(s, "colouring ramp within=0", "within");
    must_run(s, "colouring ramp cavity=0.1,0.2,0.3 within=2.5");
    must_run(s, "colouring ramp depth=0.05,0.0625");
    assert_true(scene_in(s)->colouring.hollow && scene_in(s)->colouring.within == 2.5);
    assert_true(scene_in(s)->colouring.depth[1] == 0.0625);
    must_fail(s, "colour repeat=once", "no colour picture");
    must_run(s, "surface terrain layer=1");
    must_run(s, "colouring ramp of=form");
    assert_true(scene_in(s)->colour_laid.own);
    must_run(s, "surface sphere"); /* no terrain: from the table again */
    assert_false(scene_in(s)->colour_laid.own);
    must_run(s, "colour off");
    assert_null(scene_in(s)->colour);
    assert_int_equal(scene_in(s)->colouring.count, 0);
    must_run(s, "colouring ramp");
    must_run(s, "colouring off");
    assert_null(scene_in(s)->colour);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stops_are_met_and_steps_are_steps),
        cmocka_unit_test(a_plane_has_the_colours_of_its_heights),
        cmocka_unit_test(a_table_has_the_colours_of_its_heights_and_slopes),
        cmocka_unit_test(hollows_have_their_colour),
        cmocka_unit_test(it_takes_the_place_of_a_colour_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
