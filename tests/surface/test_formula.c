/* Surfaces from user formulas: values of expressions, their derivatives, and refusals. */
#include "test.h"
#include "surface_points.h"

#include "base/error.h"
#include "base/text.h"
#include "surface/data.h"

static WrSurfaceData *made(const char *x, const char *y, const char *z, WrError *err)
{
    const char *const text[WR_SURFACE_TEXTS] = { x, y, z };
    return wr_surface_data_make(WR_SURFACE_formula, text, err);
}

static WrShape formula(const char *x, const char *y, const char *z)
{
    WrShape shape;
    WrError err = { "" };
    WrSurfaceData *data = made(x, y, z, &err);
    if (!data) fail_msg("%s | %s | %s: %s", x, y, z, err.text);
    wr_shape_default(WR_SURFACE_formula, &shape);
    wr_shape_borrow_data(&shape, data);
    return shape;
}

static void drop(WrShape *shape)
{
    wr_surface_data_free((WrSurfaceData *)shape->data);
}

static double value(const char *x, double u, double v)
{
    WrShape shape = formula(x, "u", "v");
    WrSurfacePoint o;
    wr_surface_at(&shape, 0, u, v, &o);
    drop(&shape);
    return o.p.x;
}

static void expressions_come_to_what_they_say(void **state)
{
    (void)state;
    const double u = 0.3717, v = 0.8291;
    const struct {
        const char *text;
        double value;
    } cases[] = {
        { "u", u },
        { " 1 + 2*3 ", 7 },
        { "1-2-3", -4 },
        { "8/4/2", 1 },
        { "-2^2", -4 },
        { "2^3^2", 512 },
        { "2^-1", 0.5 },
        { "(-2)^3", -8 },
        { "--u", u },
        { "+u", u },
        { "1.5e-1", 0.15 },
        { ".5", 0.5 },
        { "pi", WR_PI },
        { "u*v-u/(v+1)", u * v - u / (v + 1) },
        { "sin(2*pi*u)", sin(2 * WR_PI * u) },
        { "cos(u+v)", cos(u + v) },
        { "exp(-u)", exp(-u) },
        { "log(u+1)", log(1 + u) },
        { "log(exp(v))", v },
        { "sqrt(u+v+1)", sqrt(u + v + 1) },
        { "abs(u-v)", v - u },
        { "min(u,v)", u },
        { "max(u,v)", v },
        { "atan2(u-1,v-2)", atan2(u - 1, v - 2) },
        { "atan2(-1-u,-v-1)", atan2(-1 - u, -v - 1) },
        { "pow(1+u,v)", pow(1 + u, v) },
        { "(1+u)^v", pow(1 + u, v) },
        { "pow(u+1,2.5)", pow(1 + u, 2.5) },
        { "(u-2)^5", pow(u - 2, 5) },
        { "(1+u)^-3", pow(1 + u, -3) },
        { "(1+u)^40", pow(1 + u, 40) },
        { "u^0", 1 },
        { "0^0", 1 },
        { "sqrt(0)", 0 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double got = value(cases[i].text, u, v), want = cases[i].value;
        if (!(fabs(got - want) <= 4e-15 * (1 + fabs(want))))
            fail_msg("%s = %.17g, not %.17g", cases[i].text, got, want);
    }
}

/* Random expressions whose functions are smooth on the square. */
static void grow(TestRandom *random, int depth, WrText *text)
{
    static const char *const leaves[] = { "u", "v", "0.7313", "pi", "(u+1.37)", "(2.13-v)" };
    static const char *const ones[] = { "sin(",          "cos(",         "exp(0.3*",
                                        "sqrt(3.7+sin(", "log(3.1+cos(", "atan2(1.9+sin(" };
    static const char *const ends[] = { ")", ")", ")", "))", "))", "),2.3+u*v)" };
    const int pick = (int)(test_random(random) * 6);
    if (depth == 0) {
        wr_text_add(text, leaves[pick]);
        return;
    }
    const int kind = (int)(test_random(random) * 8);
    if (kind < 3) {
        wr_text_add(text, ones[pick]);
        grow(random, depth - 1, text);
        wr_text_add(text, ends[pick]);
        return;
    }
    static const char *const open[] = { "(", "(", "(", "pow(2.3+sin(", "(" };
    static const char *const middle[] = { ")+(", ")*(", ")-(", "),", ")/(3.3+sin(" };
    static const char *const shut[] = { ")", ")", ")", ")", "))" };
    wr_text_add(text, open[kind - 3]);
    grow(random, depth - 1, text);
    wr_text_add(text, middle[kind - 3]);
    grow(random, depth - 1, text);
    wr_text_add(text, shut[kind - 3]);
}

static void check_derivatives(const WrShape *shape, double u, double v, const char *what)
{
    WrSurfacePoint o;
    wr_surface_at(shape, 0, u, v, &o);
    const double steep = v3_len(o.n_u) + v3_len(o.n_v);
    for (int r = 0; r < DERIVATIVES; r++) {
        if (r > 5 && (steep > 30 || o.n_len < 1e-2 * v3_len(o.pu) * v3_len(o.pv))) continue;
        const double off = derivative_off(shape, &o, r, u, v, 1e-4);
        const double told = v3_len(member(&o, derivatives[r][2]));
        if (off > 1e-6 * (100 + told))
            fail_msg("%s at %g,%g: %s of %s: off by %g of %g", what, u, v,
                     member_names[derivatives[r][2]], member_names[derivatives[r][1]], off, told);
    }
}

static void derivatives_of_random_expressions_meet_differences(void **state)
{
    (void)state;
    TestRandom random = { 51 };
    int taken = 0;
    const int count = test_amount(300, 100);
    for (int k = 0; k < count; k++) {
        WrText x = { 0 }, y = { 0 };
        grow(&random, 1 + k % 4, &x);
        grow(&random, 1 + k % 3, &y);
        WrSurfaceData *data = made(wr_text_get(&x), wr_text_get(&y), "u+0.3*v*v", NULL);
        if (data && data->radius < 100) {
            WrShape shape;
            wr_shape_default(WR_SURFACE_formula, &shape);
            wr_shape_borrow_data(&shape, data);
            for (int i = 0; i < 4; i++)
                check_derivatives(&shape, 0.05 + 0.9 * test_random(&random),
                                  0.05 + 0.9 * test_random(&random), wr_text_get(&x));
            taken++;
        }
        wr_surface_data_free(data);
        wr_text_fini(&x);
        wr_text_fini(&y);
    }
    assert_true(3 * taken > 2 * count);
}

/* Against the closed forms: a sphere and a torus of the list. */
static void a_formula_of_a_sphere_is_the_sphere_to_its_poles(void **state)
{
    (void)state;
    WrShape own =
        formula("cos(2*pi*u)*cos(pi*(v-0.5))", "sin(2*pi*u)*cos(pi*(v-0.5))", "sin(pi*(v-0.5))");
    WrShape sphere;
    wr_shape_default(WR_SURFACE_sphere, &sphere);
    for (int i = 0; i <= 400; i++) {
        const double u = i % 20 / 19.0, v = i / 20 / 20.0;
        WrSurfacePoint a, b;
        wr_surface_at(&own, 0, u, v, &a);
        wr_surface_at(&sphere, 0, u, v, &b);
        for (int m = P; m <= PVV; m++)
            assert_near(v3_len(v3_sub(member(&a, m), member(&b, m))), 0, 1e-13);
        assert_near(v3_len(v3_sub(a.n_unit, b.n_unit)), 0, 1e-13);
    }
    assert_finite_everywhere(&own, true);
    WrSurfacePoint o;
    WrSurfacePointf of;
    both(&own, 0, 0.3f, 1, &o, &of);
    assert_near((double)of.n_unit.z, 1, 1e-5);
    drop(&own);
}

static void hc149_hc150_what_is_no_surface_is_refused_with_its_column(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        { "", "column 1: ends early" },
        { "u+", "column 3: ends early" },
        { "2e", "column 2: must be an operation" },
        { "u v", "column 3: must be an operation" },
        { "1..2", "column 1: is no number" },
        { "w", "column 1: is no name" },
        { "3*sinh(u)", "column 3: is no name" },
        { "sin u", "column 5: must be (" },
        { "pow(u)", "column 6: must be a comma" },
        { "min(u,v,1)", "column 8: must be )" },
        { "(u", "column 3: must be )" },
        { "u)", "column 2: must be an operation" },
        { "u#", "column 2: must be an operation" },
        { "1+sqrt(u)", "column 3: the root has no slope" },
        { "sqrt(u-0.5)", "column 1: the root of a number below 0" },
        { "1/(u-0.5)", "column 2: division by 0" },
        { "1/0", "column 2: division by 0" },
        { "log(u)", "column 1: the logarithm" },
        { "atan2(u-0.5,v-0.5)", "column 1: atan2(0,0)" },
        { "(u-0.5)^1.5", "column 8: a power of a number below 0" },
        { "u^1.5", "column 2: this power" },
        { "u^-1", "column 2: division by 0" },
        { "u^v", "column 2: a power of a number that is not above 0" },
        { "1e308*10*u", "column" },
        { "exp(exp(exp(10*u)))", "too large" },
        { "1e31*u", "must be 1e-30..1e+30" },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        WrError err = { "" };
        if (made(wrong[i][0], "u", "v", &err)) fail_msg("took %s", wrong[i][0]);
        if (!strstr(err.text, wrong[i][1]) || !strstr(err.text, "formula"))
            fail_msg("%s: %s", wrong[i][0], err.text);
    }
    WrError err = { "" };
    assert_null(made("1", "2", "3", &err)); /* a point */
    assert_non_null(strstr(err.text, "size"));
    assert_null(made("u", "v", "u+*v", &err));
    assert_non_null(strstr(err.text, "formula z: column 3"));
    for (int k = 0; k < 6; k++) { /* deep, and long */
        static const char *const open[] = { "(", "-", "sin(", "1+(", "2^", "u+" };
        const int lengths[] = { 60, 3900, 100000 };
        for (int n = 0; n < 3; n++) {
            WrText text = { 0 };
            for (int i = 0; i < lengths[n]; i++) wr_text_add(&text, open[k]);
            wr_text_add(&text, "u");
            WrSurfaceData *data = made(wr_text_get(&text), "u", "v", &err);
            assert_true(k == 5 && n == 0 ? data != NULL : data == NULL);
            wr_surface_data_free(data);
            wr_text_fini(&text);
        }
    }
}

/* Any bytes, and any words of the language: refused, or finite everywhere. */
static void noise_is_refused_or_finite(void **state)
{
    (void)state;
    static const char *const words[] = { "u",    "v",    "pi",     "1",     "0",    "0.5",
                                         "+",    "-",    "*",      "/",     "^",    "(",
                                         ")",    ",",    "sin(",   "sqrt(", "log(", "exp(",
                                         "abs(", "pow(", "atan2(", "min(",  "1e9",  "2" };
    TestRandom random = { 52 };
    int taken = 0;
    for (int k = 0; k < 15000; k++) {
        char text[80];
        int length = 0;
        const int count = 1 + (int)(test_random(&random) * 8);
        for (int i = 0; i < count; i++) {
            if (k % 3)
                length += snprintf(text + length, sizeof text - (size_t)length, "%s",
                                   words[(int)(test_random(&random) * 24)]);
            else text[length++] = (char)(1 + (int)(test_random(&random) * 255));
        }
        text[length] = '\0';
        WrSurfaceData *data = made(text, "u*v", "v+u", NULL);
        if (!data) continue;
        WrShape shape;
        wr_shape_default(WR_SURFACE_formula, &shape);
        wr_shape_borrow_data(&shape, data);
        if (taken++ % 20 == 0) assert_finite_everywhere(&shape, true);
        drop(&shape);
    }
    assert_true(taken > 100);
}

/* Poles between the sampled points are NaN; pictures contain none. */
static void what_has_no_value_between_the_places_looked_at_stays_finite(void **state)
{
    (void)state;
    WrShape shape = formula("1/(u-0.3)+sqrt(abs(v-0.7))", "u", "v");
    for (int i = 0; i < 2; i++) {
        WrSurfacePoint o;
        WrSurfacePointf of;
        both(&shape, 0, 0.3f, 0.7f, &o, &of);
        assert_true(all_finite_f(&of));
        wr_surface_at(&shape, 0, 0.3, 0.7, &o);
        assert_true(all_finite(&o));
    }
    drop(&shape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(expressions_come_to_what_they_say),
        cmocka_unit_test(derivatives_of_random_expressions_meet_differences),
        cmocka_unit_test(a_formula_of_a_sphere_is_the_sphere_to_its_poles),
        cmocka_unit_test(hc149_hc150_what_is_no_surface_is_refused_with_its_column),
        cmocka_unit_test(noise_is_refused_or_finite),
        cmocka_unit_test(what_has_no_value_between_the_places_looked_at_stays_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
