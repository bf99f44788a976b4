/* Hard cases of surfaces defined by exponents and by text: superellipsoids, profiles, formulas. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/text.h"
#include "surface/data.h"

#include <string.h>

/* n at (u, v) of each kernel set and of the formula, compared with the expected one. */
static void angles(WrHardGauge *g, const WrShape *shape, double u, double v, WrVec3 want)
{
    WrSurfacePoint at;
    wr_surface_at(shape, 0, u, v, &at);
    wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, want));
    for (int k = 0; k < g->sets; k++) {
        WrSurfacePointf atf = wr_hard_point(g, k, shape, 1.0, 0, (float)u, (float)v);
        wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(wr_hard_vec(atf.n_unit), want));
    }
}

static bool hc143(WrHardGauge *g, WrError *err)
{
    (void)err;
    WrShape shape = wr_hard_shape(WR_SURFACE_superellipsoid);
    const double forms[4] = { 0.1, 1, 1.9, 3.9 };
    for (int k = 0; k < 16; k++) {
        const double e1 = forms[k % 4], e2 = forms[k / 4];
        shape.value[3] = e1, shape.value[4] = e2;
        /* The pole, from any direction except along a cusp; the arm along x; the side of the arm along x. */
        for (int pole = 0; pole < 2; pole++)
            if (e1 < 2) angles(g, &shape, 0.125, pole, (WrVec3){ 0, 0, pole ? 1 : -1 });
        if (e1 < 2 && e2 < 2) angles(g, &shape, 0, 0.5, (WrVec3){ 1, 0, 0 });
        if (e1 < 2 && e2 > 2) angles(g, &shape, 0, 0.5, (WrVec3){ 0, 1, 0 });
        if (e1 > 2 && e2 < 2) angles(g, &shape, 0, 0.5, (WrVec3){ 0, 0, 1 });
    }
    return true;
}

static WrSurfaceData *made(WrSurfaceKind kind, const char *one, WrError *err)
{
    const char *const text[WR_SURFACE_TEXTS] = { one };
    return wr_surface_data_make(kind, text, err);
}

static bool hc144(WrHardGauge *g, WrError *err)
{
    static const char *const wrong[3] = { "1,0;0,0.5;1,1", "1,0;0.01,0.5;0.01,1.5;1,2",
                                          "1,0;1,0;0,0.5;0,0.5;1,1" };
    WrSurfaceData *egg = made(WR_SURFACE_revolution, "0,-1.125;0.8125,-0.75;0,0.875", err);
    if (!egg) return false;
    WrShape shape = wr_hard_shape(WR_SURFACE_revolution);
    wr_shape_take_data(&shape, egg);
    for (int i = 0; i < 32; i++)
        angles(g, &shape, i / 16.0 / 2, i % 2, (WrVec3){ 0, 0, i % 2 ? 1 : -1 });
    wr_surface_data_free(egg);
    for (int k = 0; k < 3; k++) {
        WrError why = { "" };
        WrSurfaceData *data = made(WR_SURFACE_revolution, wrong[k], &why);
        wr_hard_near(g, WR_HARD_DOUBLE, data == NULL && strstr(why.text, "axis at v = 0."), 1);
        wr_surface_data_free(data);
    }
    return true;
}

/* The expression is refused, and the message names the column. */
static void refused(WrHardGauge *g, const char *expression, const char *column)
{
    WrError why = { "" };
    WrSurfaceData *data = made(WR_SURFACE_formula, expression, &why);
    wr_hard_holds(g, WR_HARD_DOUBLE, data == NULL && strstr(why.text, column));
    wr_surface_data_free(data);
}

static bool hc149(WrHardGauge *g, WrError *err)
{
    (void)err;
    refused(g, "1+sqrt(u)", "column 3");
    refused(g, "2*atan2(u-0.5,v-0.5)", "column 3");
    refused(g, "1/(u-0.5)", "column 2");
    refused(g, "log(u)", "column 1");
    refused(g, "u+(v-0.5)^1.5", "column 10");
    WrSurfaceData *data = made(WR_SURFACE_formula, "0^0+(u-0.5)^0", NULL);
    wr_hard_holds(g, WR_HARD_DOUBLE, data != NULL);
    if (!data) return true;
    WrShape shape = wr_hard_shape(WR_SURFACE_formula);
    WrSurfacePoint at;
    wr_shape_take_data(&shape, data);
    wr_surface_at(&shape, 0, 0.5, 0.25, &at);
    wr_hard_holds(g, WR_HARD_DOUBLE, at.p.x == 2 && at.pu.x == 0 && at.puu.x == 0);
    wr_surface_data_free(data);
    return true;
}

static bool hc150(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const char *const open[5] = { "(", "-", "sin(", "2^", "1+(" };
    for (int k = 0; k < 5; k++)
        for (int length = 100; length <= 100000; length *= 10) {
            WrText text = { 0 };
            for (int i = 0; i < length; i++) wr_text_add(&text, open[k]);
            wr_text_add(&text, "u");
            refused(g, wr_text_get(&text), "");
            wr_text_fini(&text);
        }
    refused(g, "1e308*10*u", "column");
    refused(g, "exp(exp(exp(10*u)))", "too large");
    return true;
}

#define GEOMETRY(number, situation, rule, u, in_float, in_double, script)                          \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
static const WrHardCase rows[] = {
    GEOMETRY(143, "superellipsoids with exponents of 0.1 to 3.9 at their axes and poles",
             "n is the limit: the axis, or square to the arm of a cusp", "rad", 1e-6, 1e-14,
             "table 64x64\ngrid cells=8x8 width=2\nsurface superellipsoid e1=3.9 e2=3.9\nbump "
             "height=0.1"),
    GEOMETRY(144, "a profile that ends on the axis, and some that touch it before",
             "the poles have one normal; contact is refused with its v", "rad", 1e-6, 1e-14,
             "table 64x64\ngrid cells=8x8 width=2\nsurface revolution "
             "profile=0,-1.125;0.8125,-0.75;0,0.875\nrotate 15,0,0\nbump height=0.1"),
    GEOMETRY(149, "formulas without a value or a slope somewhere",
             "they are refused with their column, and 0^0 is 1", "violations", NAN, 0, NULL),
    GEOMETRY(150, "formulas of 100000 parentheses, and numbers beyond all bounds",
             "they are refused, and the stack stays as deep as it may", "violations", NAN, 0, NULL),
};
WR_HARD_LIST(forms, rows);
