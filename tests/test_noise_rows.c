/* Noise as the commands make it. */
#include "test.h"

#include "generate/noise_rows.h"
#include "generate_help.h"

/* A row's values with these settings; true if they make a noise for a table of that size. */
static bool maker_of(const char *row, const Setting *s, int width, int height, WrNoiseMaker *maker,
                     WrError *err)
{
    const WrGenerator *g = wr_generator_find("noise", row);
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(g, values);
    for (; s && s->name; s++) value_of(g, values, s->name)->number[0] = s->value;
    return wr_noise_maker(g, values, width, height, maker, err);
}

static void must_make(const char *row, const Setting *s, int width, int height, WrNoiseMaker *maker)
{
    WrError err;
    if (!maker_of(row, s, width, height, maker, &err)) fail_msg("noise %s: %s", row, err.text);
}

/* Texels are what the noise is at their centres. */
static void tables_hold_what_the_noise_is_at_their_texels(void **state)
{
    (void)state;
    static const struct {
        const char *row;
        Setting s[4];
    } cases[] = { { "perlin", { { 0 } } },
                  { "gradient", { { "mode", 3 }, { 0 } } },
                  { "value", { { "mode", 1 }, { "fade", 0 }, { 0 } } },
                  { "perlin", { { "domain", 1 }, { "slice", 0.3 }, { 0 } } },
                  { "perlin", { { "domain", 2 }, { 0 } } },
                  { "value", { { "domain", 3 }, { "warp", 0.5 }, { 0 } } },
                  { "perlin", { { "warp", 0.7 }, { "octaves", 3 }, { 0 } } },
                  { "simplex", { { 0 } } },
                  { "simplex", { { "way", 0 }, { 0 } } },
                  { "simplex", { { "way", 1 }, { "mode", 2 }, { 0 } } },
                  { "sheared", { { "amplitude", 3 }, { "level", -1 }, { 0 } } },
                  { "torus", { { "octaves", 2 }, { 0 } } } };
    WrField *like = table_of(96, 64);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WrNoiseMaker maker;
        must_make(cases[k].row, cases[k].s, 96, 64, &maker);
        WrField *f = made_with("noise", cases[k].row, cases[k].s, like);
        for (int j = 0; j < 64; j += 3)
            for (int i = 0; i < 96; i += 5) {
                WrNoiseReading r;
                wr_noise_maker_at(&maker, (i + 0.5) / 96.0, 1.0 - (j + 0.5) / 64.0, &r);
                assert_near((double)wr_field_get(f, i, j), r.f, 3e-5 * fabs(maker.amplitude));
            }
        wr_field_free(f);
    }
    wr_field_free(like);
}

/* Central differences of the heights, whose error falls with the square of the step. */
static void slopes_are_those_of_the_heights(void **state)
{
    (void)state;
    static const struct {
        const char *row;
        Setting s[5];
    } cases[] = { { "perlin", { { "octaves", 3 }, { 0 } } },
                  { "perlin", { { "octaves", 2 }, { "warp", 0.5 }, { 0 } } },
                  { "gradient", { { "octaves", 2 }, { "domain", 2 }, { 0 } } },
                  { "value", { { "octaves", 2 }, { "domain", 3 }, { 0 } } },
                  { "simplex", { { "octaves", 2 }, { 0 } } },
                  { "torus", { { "octaves", 2 }, { 0 } } },
                  { "sheared", { { "octaves", 2 }, { "amplitude", 2 }, { 0 } } } };
    TestRandom random = { 5 };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WrNoiseMaker m;
        must_make(cases[k].row, cases[k].s, 512, 512, &m);
        for (int n = 0; n < 20; n++) {
            double u = test_random(&random), v = test_random(&random), h = 1e-5;
            WrNoiseReading r, left, right, low, high;
            wr_noise_maker_at(&m, u, v, &r);
            wr_noise_maker_at(&m, u - h, v, &left);
            wr_noise_maker_at(&m, u + h, v, &right);
            wr_noise_maker_at(&m, u, v - h, &low);
            wr_noise_maker_at(&m, u, v + h, &high);
            assert_near(r.fu, (right.f - left.f) / (2.0 * h), 1e-3);
            assert_near(r.fv, (high.f - low.f) / (2.0 * h), 1e-3);
            assert_near(r.f, m.level + m.amplitude * r.n, 1e-15);
        }
    }
}

/* Without scattered offsets, lattice points lie at multiples of 1/cells. */
static void hc59_perlin_noise_is_exactly_0_at_lattice_points(void **state)
{
    (void)state;
    const Setting s[] = { { "scatter", 0 }, { "octaves", 3 }, { "cells", 4 }, { 0 } };
    const Setting line[] = {
        { "scatter", 0 }, { "octaves", 1 }, { "cells", 4 }, { "domain", 2 }, { 0 }
    };
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            WrNoiseMaker m;
            WrNoiseReading r;
            must_make("perlin", s, 512, 512, &m);
            wr_noise_maker_at(&m, i / 4.0, j / 4.0, &r);
            assert_true(r.n == 0.0);
            assert_true(fabs(r.nu) + fabs(r.nv) > 0.0);
            must_make("perlin", line, 512, 512, &m);
            wr_noise_maker_at(&m, i / 4.0, 0.37, &r);
            assert_true(r.n == 0.0 && r.nv == 0.0);
        }
}

static void hc60_noise_goes_on_below_0_and_comes_back_after_1(void **state)
{
    (void)state;
    static const char *const rows[] = { "perlin",  "gradient", "value", "simplex",
                                        "sheared", "torus",    "cubes" };
    for (int k = 0; k < 7; k++) {
        WrNoiseMaker m;
        must_make(rows[k], NULL, 512, 512, &m);
        for (int n = 0; n < 20; n++) {
            double u = n / 32.0, v = (n * 7 % 32) / 32.0;
            WrNoiseReading a, b, c;
            wr_noise_maker_at(&m, u, v, &a);
            wr_noise_maker_at(&m, u - 3.0, v + 2.0, &b);
            assert_true(same_bits(a.n, b.n) && same_bits(a.nu, b.nu) && same_bits(a.nv, b.nv));
            wr_noise_maker_at(&m, u - 1e-9, v, &c);
            assert_near(c.n, a.n, 1e-6);
        }
    }
}

static void hc61_far_places_and_far_origins_are_harmless(void **state)
{
    (void)state;
    WrNoiseMaker m;
    WrNoiseReading a, b;
    must_make("perlin", NULL, 512, 512, &m);
    wr_noise_maker_at(&m, 1e16, 1e300, &a);
    wr_noise_maker_at(&m, 0.0, 0.0, &b);
    assert_true(same_bits(a.n, b.n)); /* both are whole numbers of periods */
    wr_noise_maker_at(&m, INFINITY, NAN, &a);
    assert_true(isfinite(a.n) && isfinite(a.nu) && isfinite(a.f));
}

/* 4 cells doubled: octaves of 4, 8, .. 64 cells fit 128 texels; the next would have a cell a texel. */
static void hc62_octaves_beyond_nyquist_are_left_out_and_said_to_be(void **state)
{
    (void)state;
    const WrGenerator *g = wr_generator_find("noise", "perlin");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrField *like = table_of(128, 128);
    Said said = { "" };
    WrGenerateJob job = { .like = like, .note = hear, .note_ctx = &said };
    WrNormalMips relief = { NULL, NULL };
    wr_generator_defaults(g, values);
    value_of(g, values, "octaves")->number[0] = 8;
    assert_true(wr_generator_make(g, values, &job, &relief, NULL));
    assert_non_null(strstr(said.text, "octave 6 and finer"));
    value_of(g, values, "octaves")->number[0] = 5;
    WrField *five = made(g, values, like, NULL, false);
    assert_true(is_rolled(relief.heights, five, 0, 0));
    said.text[0] = '\0';
    WrNormalMips again = { NULL, NULL };
    assert_true(wr_generator_make(g, values, &job, &again, NULL));
    assert_string_equal(said.text, "");
    wr_normal_mips_fini(&again);
    wr_normal_mips_fini(&relief);
    wr_field_free(five);
    wr_field_free(like);
}

/* Octaves that would fall on every texel are among those left out: the table is level there. */
static void hc63_noise_of_a_cell_a_texel_leaves_the_level(void **state)
{
    (void)state;
    const Setting s[] = { { "cells", 64 }, { "level", 0.25 }, { 0 } };
    WrField *like = table_of(64, 64), *f = made_with("noise", "value", s, like);
    float low, high;
    wr_field_range(f, &low, &high);
    assert_true(low == 0.25f && high == 0.25f);
    wr_field_free(f);
    wr_field_free(like);
}

static void hc64_sums_that_do_not_converge_are_refused_by_name(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double value;
    } bad[] = { { "octaves", 0 }, { "octaves", 64 }, { "octaves", 1e6 }, { "ratio", 1 },
                { "ratio", 0.5 }, { "step", 1 },     { "step", -2 },     { "cells", 0 } };
    const WrGenerator *g = wr_generator_find("noise", "perlin");
    WrField *like = table_of(16, 16);
    WrGenerateJob job = { .like = like };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        WrParamValue values[WR_GENERATOR_PARAMS];
        WrNormalMips relief;
        WrError err = { "" };
        wr_generator_defaults(g, values);
        value_of(g, values, bad[k].name)->number[0] = bad[k].value;
        assert_false(wr_generator_make(g, values, &job, &relief, &err));
        assert_non_null(strstr(err.text, bad[k].name));
    }
    wr_field_free(like);
}

/* Turbulence of one octave is |f|: its slope is f's, turned where f is negative, and 0 on the crease. */
static void hc65_turbulence_is_creased_where_noise_is_0(void **state)
{
    (void)state;
    const Setting plain[] = { { "octaves", 1 }, { "scatter", 0 }, { 0 } };
    const Setting folded[] = { { "octaves", 1 }, { "scatter", 0 }, { "mode", 1 }, { 0 } };
    WrNoiseMaker a, b;
    WrNoiseReading f, t;
    must_make("perlin", plain, 512, 512, &a);
    must_make("perlin", folded, 512, 512, &b);
    for (int k = 0; k < 50; k++) {
        wr_noise_maker_at(&a, k / 50.0 + 0.003, k * 0.37, &f);
        wr_noise_maker_at(&b, k / 50.0 + 0.003, k * 0.37, &t);
        assert_true(t.n == fabs(f.n) && t.nu == (f.n < 0.0 ? -f.nu : f.nu));
    }
    wr_noise_maker_at(&b, 0.25, 0.5, &t);
    assert_true(t.n == 0.0 && t.nu == 0.0 && t.nv == 0.0);
}

/* A change of the seed changes everything, and the lecture's numbers are others than the hash's. */
static void hc66_random_numbers_go_by_the_seed_alone(void **state)
{
    (void)state;
    const Setting one[] = { { "seed", 1 }, { 0 } }, two[] = { { "seed", 2 }, { 0 } };
    const Setting old[] = { { "source", 1 }, { 0 } };
    WrField *like = table_of(64, 64);
    WrField *a = made_with("noise", "value", one, like),
            *b = made_with("noise", "value", two, like);
    WrField *c = made_with("noise", "value", old, like),
            *d = made_with("noise", "value", one, like);
    assert_true(largest_difference(a, b) > 0.1);
    assert_true(largest_difference(a, c) > 0.1);
    assert_true(is_rolled(a, d, 0, 0));
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(c);
    wr_field_free(d);
    wr_field_free(like);
}

/* On lines where a simplex has a face, both sides agree. */
static void hc67_simplex_noise_is_continuous_across_faces(void **state)
{
    (void)state;
    const Setting s[] = { { "octaves", 1 }, { "scatter", 0 }, { "cells", 6 }, { 0 } };
    WrNoiseMaker m;
    must_make("simplex", s, 512, 512, &m);
    for (int k = 0; k < 200; k++) {
        double p = k / 200.0;
        WrNoiseReading a, b, c;
        wr_noise_maker_at(&m, p, p, &a);
        wr_noise_maker_at(&m, p + 1e-13, p - 1e-13, &b);
        wr_noise_maker_at(&m, p - 1e-13, p + 1e-13, &c);
        assert_near(a.n, b.n, 1e-11);
        assert_near(a.n, c.n, 1e-11);
    }
}

/* Fractions of a step are rounded to whole cells: the seam is no steeper than the rest. */
static void hc68_sums_with_a_step_that_is_not_whole_still_tile(void **state)
{
    (void)state;
    static const char *const rows[] = { "perlin", "value", "simplex", "sheared", "torus" };
    const Setting s[] = { { "step", 1.99 }, { "octaves", 4 }, { 0 } };
    for (int k = 0; k < 5; k++) {
        WrNoiseMaker m;
        must_make(rows[k], s, 512, 256, &m);
        for (int n = 0; n < 32; n++) {
            WrNoiseReading a, b;
            wr_noise_maker_at(&m, 0.0, n / 32.0, &a);
            wr_noise_maker_at(&m, 1.0, n / 32.0, &b);
            assert_true(same_bits(a.n, b.n));
            wr_noise_maker_at(&m, n / 32.0, 1.0, &a);
            wr_noise_maker_at(&m, n / 32.0, 0.0, &b);
            assert_true(same_bits(a.n, b.n));
        }
    }
}

/* Cells stay square on a table that is not. */
static void rows_of_cells_follow_the_tables_shape(void **state)
{
    (void)state;
    const Setting own[] = { { "rows", 7 }, { 0 } };
    WrNoiseMaker m;
    must_make("perlin", NULL, 512, 128, &m);
    assert_int_equal(m.plan.octave[0].noise.lattice.period[0], 4);
    assert_int_equal(m.plan.octave[0].noise.lattice.period[1], 1);
    must_make("perlin", own, 512, 128, &m);
    assert_int_equal(m.plan.octave[0].noise.lattice.period[1], 7);
}

static void a_slice_moves_through_space_and_comes_back(void **state)
{
    (void)state;
    const Setting here[] = { { "slice", 0.25 }, { 0 } }, there[] = { { "slice", 0.26 }, { 0 } };
    const Setting round[] = { { "slice", 7.25 }, { 0 } };
    WrField *like = table_of(64, 64);
    WrField *a = made_with("noise", "simplex", here, like);
    WrField *b = made_with("noise", "simplex", there, like);
    WrField *c = made_with("noise", "simplex", round, like);
    double moved = largest_difference(a, b);
    assert_true(moved > 1e-3 && moved < 0.5);
    assert_true(is_rolled(a, c, 0, 0));
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(c);
    wr_field_free(like);
}

static void what_does_not_fit_together_is_refused(void **state)
{
    (void)state;
    const Setting space[] = { { "domain", 1 }, { "source", 1 }, { 0 } };
    WrNoiseMaker m;
    WrError err = { "" };
    assert_false(maker_of("value", space, 64, 64, &m, &err));
    assert_non_null(strstr(err.text, "source"));
    assert_non_null(strstr(err.text, "domain"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_hold_what_the_noise_is_at_their_texels),
        cmocka_unit_test(slopes_are_those_of_the_heights),
        cmocka_unit_test(hc59_perlin_noise_is_exactly_0_at_lattice_points),
        cmocka_unit_test(hc60_noise_goes_on_below_0_and_comes_back_after_1),
        cmocka_unit_test(hc61_far_places_and_far_origins_are_harmless),
        cmocka_unit_test(hc62_octaves_beyond_nyquist_are_left_out_and_said_to_be),
        cmocka_unit_test(hc63_noise_of_a_cell_a_texel_leaves_the_level),
        cmocka_unit_test(hc64_sums_that_do_not_converge_are_refused_by_name),
        cmocka_unit_test(hc65_turbulence_is_creased_where_noise_is_0),
        cmocka_unit_test(hc66_random_numbers_go_by_the_seed_alone),
        cmocka_unit_test(hc67_simplex_noise_is_continuous_across_faces),
        cmocka_unit_test(hc68_sums_with_a_step_that_is_not_whole_still_tile),
        cmocka_unit_test(rows_of_cells_follow_the_tables_shape),
        cmocka_unit_test(a_slice_moves_through_space_and_comes_back),
        cmocka_unit_test(what_does_not_fit_together_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
