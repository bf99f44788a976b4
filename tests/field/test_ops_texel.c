/* Table operations that move texels or change each one separately. */
#include "test.h"

#include "ops_tables.h"

#include <float.h>

static void offset_and_flips_carry_each_texel_to_its_place(void **state)
{
    (void)state;
    WrField *in = noisy_table(131, 70, P, C, 7);
    wr_field_set(in, 5, 5, -0.0f);
    WrField *moved = run("offset", in, 13, 4); /* right and up: rows run down */
    WrField *across = run("flip-u", in, 0), *over = run("flip-v", in, 0);
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 131; i++) {
            float f = wr_field_get(in, i, j);
            assert_true(same_bits(wr_field_get(moved, i, j), at(in, i - 13, j + 4)));
            assert_true(same_bits(wr_field_get(across, 130 - i, j), f));
            assert_true(same_bits(wr_field_get(over, i, 69 - j), f));
        }
    wr_field_free(moved);
    wr_field_free(across);
    wr_field_free(over);
    wr_field_free(in);
}

static void quarter_turns_are_counter_clockwise_and_four_are_none(void **state)
{
    (void)state;
    WrField *in = noisy_table(301, 70, P, C, 8);
    WrField *quarter = run("rotate", in, 0), *half = run("rotate", in, 1);
    WrField *back = run("rotate", in, 2), *twice = run("rotate", quarter, 0);
    WrField *none = run("rotate", quarter, 2);
    assert_true(wr_field_width(quarter) == 70 && wr_field_height(quarter) == 301);
    assert_true(wr_field_wrap_u(quarter) == C && wr_field_wrap_v(quarter) == P);
    assert_true(wr_field_get(quarter, 0, 0) ==
                wr_field_get(in, 300, 0)); /* top right to top left */
    assert_true(wr_field_get(quarter, 0, 300) ==
                wr_field_get(in, 0, 0)); /* top left to bottom left */
    assert_true(wr_field_get(quarter, 69, 0) ==
                wr_field_get(in, 300, 69)); /* bottom right to top right */
    assert_true(same_table(twice, half) && same_table(none, in) && !same_table(half, in));
    WrField *third = run("rotate", half, 0);
    assert_true(same_table(third, back));
    WrField *all[] = { in, quarter, half, back, twice, none, third };
    for (int k = 0; k < 7; k++) wr_field_free(all[k]);
}

static void crop_takes_a_rectangle_across_the_seam_too(void **state)
{
    (void)state;
    WrField *in = noisy_table(100, 80, P, C, 9), *out = run("crop", in, 90, 7, 30, 73);
    assert_true(wr_field_width(out) == 30 && wr_field_height(out) == 73);
    assert_true(wr_field_wrap_u(out) == P && wr_field_wrap_v(out) == P);
    for (int j = 0; j < 73; j++)
        for (int i = 0; i < 30; i++)
            assert_true(wr_field_get(out, i, j) == wr_field_get(in, (90 + i) % 100, 7 + j));
    wr_field_free(in);
    wr_field_free(out);
}

static void levels_are_the_formula_and_gamma_bends_only_above_low(void **state)
{
    (void)state;
    WrField *in = noisy_table(90, 70, P, P, 10);
    WrField *out = run("levels", in, -0.1, 0.3, 2.2, 5.0, 3.0);
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 90; i++) {
            double t = (wr_field_get(in, i, j) + 0.1) / 0.4;
            if (t > 0) t = pow(t, 1 / 2.2);
            assert_near(wr_field_get(out, i, j), 5.0 - 2.0 * t, 1e-6);
        }
    wr_field_free(in);
    wr_field_free(out);
}

static void normalise_meets_both_ends_exactly(void **state)
{
    (void)state;
    WrField *in = noisy_table(90, 70, P, P, 11), *out = run("normalise", in, 0.1, 7.3);
    float low, high, in_low, in_high;
    wr_field_range(out, &low, &high);
    wr_field_range(in, &in_low, &in_high);
    assert_true(low == 0.1f && high == 7.3f);
    double t = ((double)wr_field_get(in, 3, 3) - in_low) / ((double)in_high - in_low);
    assert_near(wr_field_get(out, 3, 3), 0.1 + t * 7.2, 1e-6);
    wr_field_free(out);
    wr_field_free(in);
    in = flat_table(10, 10, P, P, 4.0f);
    out = run("normalise", in, -2.0, 3.0);
    wr_field_range(out, &low, &high);
    assert_true(low == -2.0f && high == -2.0f);
    wr_field_free(out);
    wr_field_free(in);
}

static void invert_twice_is_the_table_and_keeps_its_range(void **state)
{
    (void)state;
    WrField *in = noisy_table(90, 70, P, P, 12);
    WrField *once = run("invert", in, 0), *twice = run("invert", once, 0),
            *sign = run("invert", in, 1);
    float low, high, in_low, in_high;
    wr_field_range(once, &low, &high);
    wr_field_range(in, &in_low, &in_high);
    assert_true(low == in_low && high == in_high);
    assert_true(distance(twice, in) < 1e-7 && distance(once, in) > 0.5);
    assert_true(wr_field_get(sign, 4, 4) == -wr_field_get(in, 4, 4));
    wr_field_free(in);
    wr_field_free(once);
    wr_field_free(twice);
    wr_field_free(sign);
}

static void add_multiply_and_clamp_are_what_they_say(void **state)
{
    (void)state;
    WrField *in = noisy_table(90, 70, P, P, 13);
    WrField *sum = run("add", in, 0.7), *product = run("multiply", in, -2.5);
    WrField *cut = run("clamp", in, -0.2, 0.05), *far = run("multiply", in, FLT_MAX);
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 90; i++) {
            float f = wr_field_get(in, i, j);
            assert_true(wr_field_get(sum, i, j) == (float)(f + 0.7));
            assert_true(wr_field_get(product, i, j) == (float)(f * -2.5));
            assert_true(wr_field_get(cut, i, j) == fminf(fmaxf(f, -0.2f), 0.05f));
            assert_true(fabsf(wr_field_get(far, i, j)) <= FLT_MAX);
        }
    WrField *all[] = { in, sum, product, cut, far };
    for (int k = 0; k < 5; k++) wr_field_free(all[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(offset_and_flips_carry_each_texel_to_its_place),
        cmocka_unit_test(quarter_turns_are_counter_clockwise_and_four_are_none),
        cmocka_unit_test(crop_takes_a_rectangle_across_the_seam_too),
        cmocka_unit_test(levels_are_the_formula_and_gamma_bends_only_above_low),
        cmocka_unit_test(normalise_meets_both_ends_exactly),
        cmocka_unit_test(invert_twice_is_the_table_and_keeps_its_range),
        cmocka_unit_test(add_multiply_and_clamp_are_what_they_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
