/* Continuity at the edges for each scheme: against explicit differences of texels, and against the scheme itself
   slightly before and after the edge. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/text.h"
#include "field/analytic.h"
#include "field/seam_check.h"
#include "field/field.h"

#define W 37
#define H 23

static WrField *random_table(WrWrap u, WrWrap v)
{
    TestRandom random = { 77 };
    WrField *field = wr_field_new(W, H, u, v, 0.0f, NULL);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            wr_field_set(field, i, j, (float)(3.0 + 0.7137 * test_random(&random)));
    return field;
}

static double texel(const WrField *field, int i, int j)
{
    return wr_field_get(field, (i % W + W) % W, (j % H + H) % H);
}

/* At the knot of the texel n steps right of (below) the edge: size of the scheme's first discontinuity, per texel. */
static double kink(const WrField *field, WrScheme scheme, bool in_u, int n, int line)
{
    double t[5];
    for (int k = -2; k <= 2; k++)
        t[k + 2] = in_u ? texel(field, n + k, line) : texel(field, line, n + k);
    const double third = t[4] - 2 * t[3] + 2 * t[1] - t[0];
    switch (scheme) {
    case WR_SCHEME_BILINEAR: return t[3] - 2 * t[2] + t[1];
    case WR_SCHEME_CENTRAL: return third / 2;
    case WR_SCHEME_CATMULL: return 1.25 * third;
    default: return 0;
    }
}

static void joints_of_cells_that_repeat_are_those_of_their_scheme(void **state)
{
    (void)state;
    static const int orders[WR_SCHEME_COUNT] = { -1, 0, 1, 2, 2, 1 };
    WrField *field = random_table(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    for (int s = 0; s < WR_SCHEME_COUNT; s++) {
        const WrCertificate c = wr_certificate_table(field, (WrScheme)s, NULL);
        for (int in_u = 0; in_u < 2; in_u++) {
            const WrCertificateEdge *edge = in_u ? &c.u : &c.v;
            const int length = in_u ? H : W, size = in_u ? W : H, order = orders[s];
            assert_int_equal(edge->order, order);
            assert_false(edge->ends);
            for (int k = 0; k <= order; k++) assert_true(edge->jump[k] == 0);
            if (s == WR_SCHEME_NEAREST || order == 2) continue;
            double most = 0;
            for (int l = 0; l < length; l++)
                for (int n = -1; n <= 0; n++)
                    most = fmax(most, fabs(kink(field, (WrScheme)s, in_u, n, l)));
            most *= pow(size, order + 1);
            if (fabs(edge->jump[order + 1] - most) > 1e-9 * most)
                fail_msg("scheme %d: %.17g, not %.17g", s, edge->jump[order + 1], most);
        }
        assert_int_equal(wr_certificate_continuity(&c), orders[s]);
    }
    wr_field_free(field);
}

/* F and its slope slightly before and after the edge, along it. */
static void measure(const WrField *field, WrScheme scheme, bool in_u, double jump[2])
{
    jump[0] = jump[1] = 0;
    const int length = in_u ? H : W;
    for (int l = 0; l < length; l++) {
        const double along = in_u ? 1 - (l + 0.5) / H : (l + 0.5) / W;
        double f[2], fu[2], fv[2], at[2] = { 1e-13, 1 - 1e-13 }, same[2] = { along, along };
        wr_field_sample(field, scheme, 2, in_u ? at : same, in_u ? same : at, f, fu, fv);
        const double *slope = in_u ? fu : fv;
        jump[0] = fmax(jump[0], fabs(f[0] - f[1]));
        jump[1] = fmax(jump[1], fabs(slope[0] - slope[1]));
    }
}

static void edges_that_end_are_laid_side_by_side(void **state)
{
    (void)state;
    WrField *field = random_table(WR_WRAP_CLAMP, WR_WRAP_CLAMP);
    for (int s = 0; s < WR_SCHEME_COUNT; s++) {
        const WrCertificate c = wr_certificate_table(field, (WrScheme)s, NULL);
        for (int in_u = 0; in_u < 2; in_u++) {
            const WrCertificateEdge *edge = in_u ? &c.u : &c.v;
            const double factor = s == WR_SCHEME_CATMULL ? 1.25 : 1;
            double jump[2];
            measure(field, (WrScheme)s, in_u, jump);
            assert_int_equal(edge->order, -1);
            assert_true(edge->ends);
            if (fabs(edge->jump[0] - factor * jump[0]) > 1e-9)
                fail_msg("scheme %d: F by %.12g, not %.12g", s, edge->jump[0], factor * jump[0]);
            if (edge->jump[1] < factor * jump[1] * (1 - 1e-9))
                fail_msg("scheme %d: slope by %.12g, not %.12g", s, edge->jump[1],
                         factor * jump[1]);
        }
    }
    wr_field_free(field);
}

static void level_ground_is_smooth_whatever_its_height(void **state)
{
    (void)state;
    for (int clamp = 0; clamp < 2; clamp++) {
        const WrWrap wrap = clamp ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(5, 1, wrap, WR_WRAP_PERIODIC, 12345.678f, NULL);
        for (int s = 0; s < WR_SCHEME_COUNT; s++) {
            const WrCertificate c = wr_certificate_table(field, (WrScheme)s, NULL);
            assert_int_equal(wr_certificate_continuity(&c), 2);
        }
        wr_field_free(field);
    }
}

static void formulas_are_judged_from_edge_to_edge(void **state)
{
    (void)state;
    WrAnalyticTerm terms[] = { { .i = 1, .j = 2, .a = 0.73 }, { .i = 2, .j = 2, .a = -0.73 } };
    const WrAnalytic bow = { .kind = WR_ANALYTIC_POLY, .count = 2, .terms = terms };
    const WrCertificate c = wr_certificate_formula(&bow);
    /* 0.73 (u - u^2) v^2: equal at u = 0 and 1, with slopes of 0.73 and -0.73 times v^2 */
    assert_int_equal(c.u.order, 0);
    assert_true(fabs(c.u.jump[1] - 1.46) < 1e-12 && c.u.jump[2] == 0);
    /* along v it steps by at most 0.73 / 4, its slope by twice that, its curvature not at all */
    assert_int_equal(c.v.order, -1);
    assert_true(fabs(c.v.jump[0] - 0.1825) < 1e-12 && fabs(c.v.jump[1] - 0.365) < 1e-12);
    assert_true(c.v.jump[2] == 0);
    WrAnalyticTerm wave = { .i = 3, .j = -2, .a = 0.4, .phase_u_deg = 17 };
    const WrAnalytic waves = { .kind = WR_ANALYTIC_FOURIER, .count = 1, .terms = &wave };
    const WrCertificate w = wr_certificate_formula(&waves);
    assert_int_equal(wr_certificate_continuity(&w), 2);
}

static void the_words_tell_the_first_that_jumps(void **state)
{
    (void)state;
    WrText text = { 0 };
    const WrSeamEdge meets = { .order = 2 };
    WrCertificate c = { { .order = 2 }, { .order = 2 }, { meets, meets } };
    wr_certificate_text(&c, &text);
    assert_string_equal(wr_text_get(&text), "seam C2");
    c.v = (WrCertificateEdge){ .ends = true, .order = -1, .jump = { 0.3, 5, 7 } };
    wr_text_clear(&text);
    wr_certificate_text(&c, &text);
    assert_string_equal(wr_text_get(&text),
                        "seam in u C2; in v none, F jumps by up to 0.3, the axis ends");
    c.u = c.v = (WrCertificateEdge){ .order = 1, .jump = { 0, 0, 12.34 } };
    wr_text_clear(&text);
    wr_certificate_text(&c, &text);
    assert_string_equal(wr_text_get(&text), "seam C1, F'' jumps by up to 12.3");
    c.pattern.v = (WrSeamEdge){
        .measured = true, .order = -1, .across = { 0.3 }, .inside = { 0.05 }, .ratio = { 6 }
    };
    wr_text_clear(&text);
    wr_certificate_text(&c, &text);
    assert_string_equal(wr_text_get(&text),
                        "seam in u C1, F'' jumps by up to 12.3; in v none, height differs by 0.3 "
                        "across the edge, by 0.05 across the worst line inside: 6 times");
    wr_text_fini(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_of_cells_that_repeat_are_those_of_their_scheme),
        cmocka_unit_test(edges_that_end_are_laid_side_by_side),
        cmocka_unit_test(level_ground_is_smooth_whatever_its_height),
        cmocka_unit_test(formulas_are_judged_from_edge_to_edge),
        cmocka_unit_test(the_words_tell_the_first_that_jumps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
