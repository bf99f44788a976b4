/* Patterns against geometric facts. */
#include "test.h"

#include "base/exactmath.h"
#include "generate/pattern.h"
#include "generate_help.h"

static double mean_of(const WrField *field)
{
    double sum = 0.0;
    int w = wr_field_width(field), h = wr_field_height(field);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) sum += (double)wr_field_get(field, i, j);
    return sum / w / h;
}

/* Compare a field with its mirror image, or with itself shifted by whole texels. */
static double moved_difference(const WrField *f, int di, int dj)
{
    int w = wr_field_width(f), h = wr_field_height(f);
    double most = 0.0;
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            most = fmax(most, fabs((double)wr_field_get(f, i, j) -
                                   (double)wr_field_get(f, (i + di) % w, (j + dj) % h)));
    return most;
}

/* ---- edges ---- */

static double profile(WrProfile p, double t)
{
    if (t <= 0.0) return 0.0;
    if (t >= 1.0) return 1.0;
    switch (p) {
    case WR_PROFILE_ROUND: return sqrt(1.0 - (1.0 - t) * (1.0 - t));
    case WR_PROFILE_SMOOTH: return t * t * (3.0 - 2.0 * t);
    case WR_PROFILE_CHAMFER: return t;
    case WR_PROFILE_COVE: return 1.0 - sqrt(1.0 - t * t);
    }
    return 0.0;
}

/* The integral over a texel by many small steps. */
static void an_edge_is_the_profile_averaged_over_one_texel(void **state)
{
    (void)state;
    static const double bevels[] = { 0.0, 0.3, 1.0, 6.5 };
    for (int p = 0; p < 4; p++)
        for (int b = 0; b < 4; b++)
            for (double d = -1.0; d <= 8.0; d += 0.37) {
                const WrEdge edge = { bevels[b], (WrProfile)p };
                double sum = 0.0;
                for (int k = 0; k < 4000; k++) {
                    double at = d - 0.5 + (k + 0.5) / 4000.0;
                    sum += bevels[b] > 0.0 ? profile((WrProfile)p, at / bevels[b]) : at > 0.0;
                }
                assert_near(wr_edge_height(&edge, d), sum / 4000.0, 3e-4);
            }
}

static void a_rounded_box_is_measured_from_its_straight_and_round_sides(void **state)
{
    (void)state;
    assert_near(wr_inside_box(0, 0, 10, 6, 0), 6, 0);
    assert_near(wr_inside_box(9, 0, 10, 6, 2), 1, 0);
    assert_near(wr_inside_box(10, 6, 10, 6, 0), 0, 0);
    assert_near(wr_inside_box(-13, -10, 10, 6, 0), -5, 1e-14);
    assert_near(wr_inside_box(10, 6, 10, 6, 2), 2 - sqrt(8), 1e-14); /* without the corner */
    assert_near(wr_inside_box(8, 4, 10, 6, 2), 2, 1e-14);
}

/* ---- areas ---- */

/* Lines of 12 texels in cells of 64, with steps: exactly 1 - (1 - 12/64)^2 of the table, though no edge is between
 * texels. */
static void a_grid_of_steps_covers_the_area_of_its_lines(void **state)
{
    (void)state;
    const Setting s[] = {
        { "across", 3 }, { "rows", 4 }, { "width", 12.7 }, { "bevel", 0 }, { 0 }
    };
    WrField *like = table_of(200, 150), *f = made_with("pattern", "grid", s, like);
    double a = 12.7 * 3.0 / 200.0, b = 12.7 * 4.0 / 150.0;
    assert_near(mean_of(f), 1.0 - (1.0 - a) * (1.0 - b), 1e-6);
    wr_field_free(f);
    wr_field_free(like);
}

static void stripes_of_steps_cover_their_part_in_any_direction(void **state)
{
    (void)state;
    static const double directions[][2] = { { 7, 0 }, { 0, 3 }, { 5, 4 }, { -3, 7 } };
    WrField *like = table_of(256, 256);
    for (int k = 0; k < 4; k++) {
        const Setting s[] = { { "across", directions[k][0] },
                              { "rows", directions[k][1] },
                              { "width", 0.3 },
                              { "bevel", 0 },
                              { 0 } };
        WrField *f = made_with("pattern", "stripes", s, like);
        assert_near(mean_of(f), 0.3, 2e-3);
        wr_field_free(f);
    }
    wr_field_free(like);
}

/* A hemisphere over a disc of radius r: volume 2/3 pi r^2 times its height. */
static void domes_hold_the_volume_of_hemispheres(void **state)
{
    (void)state;
    const Setting s[] = { { "across", 4 }, { "rows", 4 }, { "size", 0.75 }, { 0 } };
    WrField *like = table_of(512, 512), *f = made_with("pattern", "dots", s, like);
    double r = 0.5 * 0.75;
    assert_near(mean_of(f), 2.0 / 3.0 * WR_PI * r * r, 2e-3);
    assert_near((double)wr_field_get(f, 64, 64), 1.0, 1e-3);
    wr_field_free(f);
    wr_field_free(like);
}

/* Hexagons without joints cover everything, for any aspect ratio; with joints, the remaining area. */
static void hexagons_fill_the_plane_but_for_their_joints(void **state)
{
    (void)state;
    WrField *like = table_of(240, 208); /* six rows are regular to 0.1 % */
    const Setting none[] = { { "joint", 0 },  { "bevel", 0 }, { "uneven", 0 }, { "tilt", 0 },
                             { "pillow", 0 }, { "rough", 0 }, { "rows", 6 },   { 0 } };
    const Setting some[] = { { "joint", 4 },  { "bevel", 0 }, { "uneven", 0 }, { "tilt", 0 },
                             { "pillow", 0 }, { "rough", 0 }, { "across", 6 }, { 0 } };
    WrField *all = made_with("pattern", "hexagons", none, like);
    /* both neighbours cover half of a border texel: the loss is less than the length of the edges */
    assert_true(mean_of(all) > 0.96);
    WrField *part = made_with("pattern", "hexagons", some, like);
    /* 6 across of width 40: an area of sqrt(3)/2 (40 - 4)^2 of sqrt(3)/2 40^2 */
    assert_near(mean_of(part), 0.81, 2e-3);
    wr_field_free(all);
    wr_field_free(part);
    wr_field_free(like);
}

/* ---- structure ---- */

static const Setting plain_bricks[] = {
    { "wobble", 0 }, { "uneven", 0 }, { "tilt", 0 }, { "rough", 0 },
    { "across", 4 }, { "rows", 8 },   { 0 }
};

static void running_bricks_come_again_half_a_brick_on_and_a_row_up(void **state)
{
    (void)state;
    WrField *like = table_of(256, 256), *f = made_with("pattern", "bricks", plain_bricks, like);
    assert_true(moved_difference(f, 32, 32) == 0.0);
    assert_true(moved_difference(f, 64, 0) == 0.0);
    assert_true(moved_difference(f, 0, 32) > 0.9);
    assert_near((double)wr_field_get(f, 0, 0), 0.0, 0.01); /* a joint crosses the corner */
    wr_field_free(f);
    wr_field_free(like);
}

static void checks_turn_over_from_field_to_field(void **state)
{
    (void)state;
    const Setting s[] = { { "across", 4 }, { "rows", 8 }, { 0 } };
    WrField *like = table_of(128, 128), *f = made_with("pattern", "checks", s, like);
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++)
            assert_near((double)wr_field_get(f, i, j) + (double)wr_field_get(f, (i + 32) % 128, j),
                        1.0, 1e-6);
    assert_near(mean_of(f), 0.5, 1e-6);
    wr_field_free(f);
    wr_field_free(like);
}

static void plain_cloth_changes_warp_and_weft_in_the_next_thread(void **state)
{
    (void)state;
    const Setting s[] = { { "across", 8 }, { "rows", 8 }, { "fibre", 0 }, { 0 } };
    WrField *like = table_of(128, 128), *f = made_with("pattern", "weave", s, like);
    assert_true(moved_difference(f, 16, 16) < 1e-6);
    for (int j = 0; j < 128; j++) /* transposed and shifted by one thread: weft and warp swapped */
        for (int i = 0; i < 128; i++)
            assert_near((double)wr_field_get(f, i, j),
                        (double)wr_field_get(f, (127 - j + 16) % 128, 127 - i), 1e-6);
    wr_field_free(f);
    wr_field_free(like);
}

static void a_draft_that_cannot_close_is_refused_by_name(void **state)
{
    (void)state;
    static const struct {
        const char *row, *param, *want;
        double value;
    } cases[] = { { "weave", "across", "multiple of 2", 7 },
                  { "checks", "rows", "must be even", 5 },
                  { "hexagons", "rows", "must be even", 5 } };
    WrField *like = table_of(64, 64);
    for (int k = 0; k < 3; k++) {
        const WrGenerator *g = wr_generator_find("pattern", cases[k].row);
        WrParamValue values[WR_GENERATOR_PARAMS];
        WrGenerateJob job = { .like = like };
        WrRelief relief;
        WrError err = { "" };
        wr_generator_defaults(g, values);
        value_of(g, values, cases[k].param)->number[0] = cases[k].value;
        assert_false(wr_generator_make(g, values, &job, &relief, &err));
        assert_non_null(strstr(err.text, cases[k].param));
        assert_non_null(strstr(err.text, cases[k].want));
    }
    wr_field_free(like);
}

static void a_bond_that_does_not_close_is_said_and_so_is_stretch(void **state)
{
    (void)state;
    static const struct {
        const char *row, *param, *want;
        double value;
    } cases[] = { { "bricks", "rows", "multiple of 2", 9 },
                  { "hexagons", "across", "stretched", 7 } };
    WrField *like = table_of(64, 64);
    for (int k = 0; k < 2; k++) {
        const WrGenerator *g = wr_generator_find("pattern", cases[k].row);
        WrParamValue values[WR_GENERATOR_PARAMS];
        Said said = { "" };
        WrGenerateJob job = { .like = like, .note = hear, .note_ctx = &said };
        WrRelief relief = { NULL, NULL };
        wr_generator_defaults(g, values);
        value_of(g, values, cases[k].param)->number[0] = cases[k].value;
        assert_true(wr_generator_make(g, values, &job, &relief, NULL));
        assert_non_null(strstr(said.text, cases[k].want));
        wr_relief_fini(&relief);
    }
    wr_field_free(like);
}

/* Joints of 7 texels leave nothing of rows of 6.4; a knurl of four texels a turn is grey. */
static void a_pattern_without_pieces_is_said(void **state)
{
    (void)state;
    static const struct {
        const char *row, *param;
        double value;
        int side;
        bool flat;
    } cases[] = { { "bricks", "joint", 7, 64, true },   { "bricks", "joint", 2, 64, false },
                  { "bricks", "height", 0, 64, false }, { "tiles", "joint", 5, 16, true },
                  { "knurl", "height", 1, 32, true },   { "knurl", "height", 1, 64, false } };
    for (int k = 0; k < 6; k++) {
        const WrGenerator *g = wr_generator_find("pattern", cases[k].row);
        WrParamValue values[WR_GENERATOR_PARAMS];
        WrField *like = table_of(cases[k].side, cases[k].side);
        Said said = { "" };
        WrGenerateJob job = { .like = like, .note = hear, .note_ctx = &said };
        WrRelief relief = { NULL, NULL };
        wr_generator_defaults(g, values);
        value_of(g, values, cases[k].param)->number[0] = cases[k].value;
        assert_true(wr_generator_make(g, values, &job, &relief, NULL));
        assert_int_equal(strstr(said.text, "all texels have the same height") != NULL,
                         cases[k].flat);
        wr_relief_fini(&relief);
        wr_field_free(like);
    }
}

/* With points at the centres of square cells, f1 is the distance to the cell's centre. */
static void voronoi_of_unscattered_points_is_known(void **state)
{
    (void)state;
    const Setting s[] = { { "across", 4 }, { "rows", 4 }, { "scatter", 0 }, { 0 } };
    const Setting second[] = {
        { "across", 4 }, { "rows", 4 }, { "scatter", 0 }, { "value", 1 }, { 0 }
    };
    WrField *like = table_of(64, 64), *f = made_with("pattern", "voronoi", s, like);
    WrField *g = made_with("pattern", "voronoi", second, like);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            double x = fabs((i % 16 + 0.5) / 16.0 - 0.5), y = fabs((j % 16 + 0.5) / 16.0 - 0.5);
            double far = fmax(x, y), near = fmin(x, y);
            assert_near((double)wr_field_get(f, i, j), sqrt(x * x + y * y), 1e-6);
            assert_near((double)wr_field_get(g, i, j),
                        sqrt((1.0 - far) * (1.0 - far) + near * near), 1e-6);
        }
    wr_field_free(f);
    wr_field_free(g);
    wr_field_free(like);
}

/* The nearest point is found for any displacement of points: compared with all points and all their images. */
static void voronoi_finds_the_nearest_of_all_scattered_points(void **state)
{
    (void)state;
    enum { N = 4, SIDE = 32 };
    WrField *like = table_of(SIDE, SIDE);
    for (int metric = 0; metric < 3; metric++) {
        const Setting s[] = { { "across", N }, { "rows", N },        { "scatter", 1 },
                              { "seed", 3 },   { "metric", metric }, { 0 } };
        WrField *f = made_with("pattern", "voronoi", s, like);
        for (int j = 0; j < SIDE; j++)
            for (int i = 0; i < SIDE; i++) {
                double u = (i + 0.5) * N / SIDE, v = (SIDE - 1 - j + 0.5) * N / SIDE, best = 1e9;
                for (int b = -N; b < 2 * N; b++)
                    for (int a = -N; a < 2 * N; a++) {
                        int ca = (a + N) % N, cb = (b + N) % N;
                        double x = fabs(a + wr_chance(3, ca, cb, 10) - u);
                        double y = fabs(b + wr_chance(3, ca, cb, 11) - v);
                        best = fmin(best, metric == 0   ? hypot(x, y)
                                          : metric == 1 ? x + y
                                                        : fmax(x, y));
                    }
                assert_near((double)wr_field_get(f, i, j), best, 1e-6);
            }
        wr_field_free(f);
    }
    wr_field_free(like);
}

/* The result is at most `height`; tilted and rough pieces may exceed it by the amount stated in the help. */
static void patterns_keep_to_the_height_that_they_promise(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 256, 256 }, { 131, 97 } };
    for (const WrGenerator *g = wr_patterns; g->family; g++)
        for (int k = 0; k < 8; k++) {
            if (strcmp(g->name, "scratches") == 0) continue; /* its height is a depth */
            WrField *like = table_of(sizes[k % 2][0], sizes[k % 2][1]);
            WrParamValue values[WR_GENERATOR_PARAMS];
            usual_values(g, values);
            int seed = wr_generator_param_find(g, "seed"),
                tilt = wr_generator_param_find(g, "tilt");
            int rough = wr_generator_param_find(g, "rough");
            if (seed >= 0) values[seed].number[0] = k / 2 + 1;
            double more = 0;
            if (rough >= 0 && tilt >= 0) {
                assert_non_null(
                    strstr(g->params[wr_generator_param_find(g, "height")].help, "half of rough"));
                more = values[tilt].number[0] + 0.5 * values[rough].number[0];
            }
            value_of(g, values, "height")->number[0] = 2;
            WrField *f = made(g, values, like, NULL, false);
            float low, high;
            wr_field_range(f, &low, &high);
            if (low < 0 || (double)high > 2 * (1 + more) + 1e-6)
                fail_msg("%s: %g to %g of height=2, %g more", g->name, low, high, more);
            wr_field_free(f);
            wr_field_free(like);
        }
}

static void scratches_only_lower_where_there_is_no_burr_and_height_scales_them(void **state)
{
    (void)state;
    const Setting one[] = { { "ridge", 0 }, { "height", 0.25 }, { 0 } };
    const Setting two[] = { { "ridge", 0 }, { "height", 0.5 }, { 0 } };
    WrField *like = table_of(128, 128);
    WrField *a = made_with("pattern", "scratches", one, like);
    WrField *b = made_with("pattern", "scratches", two, like);
    float low, high;
    wr_field_range(a, &low, &high);
    assert_true(high == 0.0f && low < -0.1f && low >= -0.25f);
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++)
            assert_true(2.0f * wr_field_get(a, i, j) == wr_field_get(b, i, j));
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(like);
}

/* Links as solids: the chain's highest line is the top of the upright links, outer radius above the base. */
static void a_chain_is_highest_along_its_upright_links(void **state)
{
    (void)state;
    const Setting s[] = {
        { "across", 1 }, { "rows", 1 }, { "width", 0.5 }, { "wire", 0.25 }, { 0 }
    };
    WrField *like = table_of(256, 128), *f = made_with("pattern", "chain", s, like);
    float low, high;
    wr_field_range(f, &low, &high);
    assert_near((double)high, 1.0, 1e-3);
    assert_true(low == 0.0f);
    assert_near((double)wr_field_get(f, 128, 63), 1.0, 2e-3);
    /* the flat link's side at the edge of the table: wire radius 8 of bend 24 + wire 8 */
    assert_near((double)wr_field_get(f, 0, 64 + 24), 8.0 / 32.0, 0.02);
    wr_field_free(f);
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patterns_keep_to_the_height_that_they_promise),
        cmocka_unit_test(an_edge_is_the_profile_averaged_over_one_texel),
        cmocka_unit_test(a_rounded_box_is_measured_from_its_straight_and_round_sides),
        cmocka_unit_test(a_grid_of_steps_covers_the_area_of_its_lines),
        cmocka_unit_test(stripes_of_steps_cover_their_part_in_any_direction),
        cmocka_unit_test(domes_hold_the_volume_of_hemispheres),
        cmocka_unit_test(hexagons_fill_the_plane_but_for_their_joints),
        cmocka_unit_test(running_bricks_come_again_half_a_brick_on_and_a_row_up),
        cmocka_unit_test(checks_turn_over_from_field_to_field),
        cmocka_unit_test(plain_cloth_changes_warp_and_weft_in_the_next_thread),
        cmocka_unit_test(a_draft_that_cannot_close_is_refused_by_name),
        cmocka_unit_test(a_bond_that_does_not_close_is_said_and_so_is_stretch),
        cmocka_unit_test(a_pattern_without_pieces_is_said),
        cmocka_unit_test(voronoi_of_unscattered_points_is_known),
        cmocka_unit_test(voronoi_finds_the_nearest_of_all_scattered_points),
        cmocka_unit_test(scratches_only_lower_where_there_is_no_burr_and_height_scales_them),
        cmocka_unit_test(a_chain_is_highest_along_its_upright_links),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
