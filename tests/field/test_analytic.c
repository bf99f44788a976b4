/* F as a formula: values known in closed form, derivatives against finite differences. */
#include "test.h"

#include "field/analytic.h"

static const WrAnalyticTerm poly_terms[] = {
    { 2, 3, 2.0, 0, 0 }, { 0, 1, -1.5, 0, 0 }, { 5, 0, 0.75, 0, 0 }, { 0, 0, 0.125, 0, 0 }
};
static const WrAnalyticTerm wave_terms[] = { { 3, 1, 0.5, 20, -70 },
                                             { 0, 2, 0.25, 0, 45 },
                                             { -2, 5, 0.125, 90, 10 } };

/* The terms are only read. */
#define POLY ((WrAnalytic){ WR_ANALYTIC_POLY, 4, (WrAnalyticTerm *)(uintptr_t)poly_terms })
#define WAVES ((WrAnalytic){ WR_ANALYTIC_FOURIER, 3, (WrAnalyticTerm *)(uintptr_t)wave_terms })

static double value(const WrAnalytic *analytic, double u, double v)
{
    double f;
    wr_analytic_sample(analytic, u, v, &f, NULL, NULL);
    return f;
}

static void a_polynomial_has_its_value_and_slopes(void **state)
{
    (void)state;
    WrAnalytic poly = POLY;
    double f, fu, fv;
    wr_analytic_sample(&poly, 0.5, 0.25, &f, &fu, &fv);
    /* 2/4/64 - 1.5/4 + 0.75/32 + 1/8; 4/2/64 + 3.75/16; 6/4/16 - 1.5: dyadic, so exact */
    assert_true(f == 2.0 / 256 - 0.375 + 0.75 / 32 + 0.125);
    assert_true(fu == 4.0 / 128 + 3.75 / 16);
    assert_true(fv == 6.0 / 64 - 1.5);
}

static void a_wave_is_exact_at_quarter_turns(void **state)
{
    (void)state;
    WrAnalyticTerm term = { 1, 0, 3.0, 0, 0 };
    WrAnalytic wave = { WR_ANALYTIC_FOURIER, 1, &term };
    const double cosine[4] = { 1, 0, -1, 0 }, sine[4] = { 0, 1, 0, -1 };
    for (int q = 0; q < 4; q++) {
        double f, fu, fv;
        wr_analytic_sample(&wave, q / 4.0, 0.3, &f, &fu, &fv);
        assert_true(f == 3.0 * cosine[q]);
        assert_near(fu, -2.0 * M_PI * 3.0 * sine[q], 1e-14);
        assert_true(fv == 0.0);
    }
}

static void a_wave_follows_the_c_librarys_cosine(void **state)
{
    (void)state;
    WrAnalytic waves = WAVES;
    TestRandom random = { 3 };
    for (int k = 0; k < 500; k++) {
        double u = test_random(&random), v = test_random(&random), f = 0.0;
        for (int t = 0; t < 3; t++)
            f += wave_terms[t].a *
                 cos(2 * M_PI * wave_terms[t].i * u + wave_terms[t].phase_u_deg * M_PI / 180) *
                 cos(2 * M_PI * wave_terms[t].j * v + wave_terms[t].phase_v_deg * M_PI / 180);
        assert_near(value(&waves, u, v), f, 1e-13);
    }
}

/* The error of central differences with step h falls as h^2: two steps, ratio 4. */
static void check_slopes(const WrAnalytic *analytic)
{
    TestRandom random = { 5 };
    for (int k = 0; k < 50; k++) {
        double u = 0.1 + 0.8 * test_random(&random), v = 0.1 + 0.8 * test_random(&random);
        double slope[2], error[2][2];
        wr_analytic_sample(analytic, u, v, NULL, &slope[0], &slope[1]);
        for (int step = 0; step < 2; step++) {
            double h = step ? 5e-4 : 1e-3;
            double du = value(analytic, u + h, v) - value(analytic, u - h, v);
            double dv = value(analytic, u, v + h) - value(analytic, u, v - h);
            error[0][step] = du / (2 * h) - slope[0];
            error[1][step] = dv / (2 * h) - slope[1];
        }
        for (int axis = 0; axis < 2; axis++) {
            assert_near(error[axis][1], 0.0, 2e-3);
            if (fabs(error[axis][1]) > 1e-7)
                assert_near(log2(error[axis][0] / error[axis][1]), 2.0, 0.1);
        }
    }
}

static void slopes_agree_with_differences_to_second_order(void **state)
{
    (void)state;
    WrAnalytic poly = POLY, waves = WAVES;
    check_slopes(&poly);
    check_slopes(&waves);
}

static void parameters_are_reduced_like_a_tables(void **state)
{
    (void)state;
    WrAnalytic poly = POLY, waves = WAVES;
    assert_true(same_bits(value(&poly, 1.0, 2.25), value(&poly, 0.0, 0.25)));
    assert_true(same_bits(value(&poly, -0.75, -3.0), value(&poly, 0.25, 0.0)));
    assert_true(same_bits(value(&waves, NAN, INFINITY), value(&waves, 0.0, 0.0)));
    assert_near(value(&poly, -1e-17, 0.5), value(&poly, 0.0, 0.5), 0.0);
}

static void without_terms_f_is_0(void **state)
{
    (void)state;
    WrAnalytic off = { WR_ANALYTIC_OFF, 0, NULL };
    double f = 9, fu = 9, fv = 9;
    wr_analytic_sample(&off, 0.3, 0.4, &f, &fu, &fv);
    assert_true(f == 0.0 && fu == 0.0 && fv == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_polynomial_has_its_value_and_slopes),
        cmocka_unit_test(a_wave_is_exact_at_quarter_turns),
        cmocka_unit_test(a_wave_follows_the_c_librarys_cosine),
        cmocka_unit_test(slopes_agree_with_differences_to_second_order),
        cmocka_unit_test(parameters_are_reduced_like_a_tables),
        cmocka_unit_test(without_terms_f_is_0),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
