/* Maps of the table's derivatives: slopes, steepness and curvature against forms differentiated by hand. */
#include "test.h"
#include "field/scheme_list.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"

enum { W = 240, H = 200 };
#define CELL_W 2.25
#define CELL_H 0.75
#define HEIGHT 1.5
#define AMPLITUDE 0.05

/* F = a cos(2 pi 3 u + 30 deg) cos(2 pi 2 v), whole waves over the cell, in scene units x = w u, y = h v. */
typedef struct Wave {
    double f, p, q, r, s, t;
} Wave;

static Wave wave_at(double u, double v)
{
    const double k = 6 * WR_PI, l = 4 * WR_PI, a = AMPLITUDE * HEIGHT;
    const double cu = cos(k * u + WR_PI / 6), su = sin(k * u + WR_PI / 6), cv = cos(l * v),
                 sv = sin(l * v);
    const double x = k / CELL_W, y = l / CELL_H;
    return (Wave){ AMPLITUDE * cu * cv,  -a * x * su * cv,    -a * y * cu * sv,
                   -a * x * x * cu * cv, a * x * y * su * sv, -a * y * y * cu * cv };
}

/* Minus div of (p, q) / sqrt(1 + p p + q q), halved: another form of the mean curvature. */
static double convexity(const Wave *w)
{
    const double n = sqrt(1 + w->p * w->p + w->q * w->q), n3 = n * n * n;
    const double along = (w->r * n * n - w->p * (w->p * w->r + w->q * w->s)) / n3;
    const double up = (w->t * n * n - w->q * (w->p * w->s + w->q * w->t)) / n3;
    return -0.5 * (along + up);
}

static WrDocument *document_of_wave(bool formula)
{
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    WrScene *scene = wr_scene_clone(document->scene);
    for (int j = 0; j < H && !formula; j++)
        for (int i = 0; i < W; i++)
            wr_field_set(field, i, j, (float)wave_at((i + 0.5) / W, 1 - (j + 0.5) / H).f);
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    scene->height = HEIGHT;
    scene->scheme = WR_SCHEME_BSPLINE_FIT;
    if (formula) {
        scene->analytic.kind = WR_ANALYTIC_FOURIER;
        scene->analytic.count = 1;
        scene->analytic.terms = wr_alloc(1, sizeof *scene->analytic.terms);
        scene->analytic.terms[0] =
            (WrAnalyticTerm){ .i = 3, .j = 2, .a = AMPLITUDE, .phase_u_deg = 30 };
    }
    wr_scene_free(document->scene);
    document->scene = scene;
    return document;
}

static WrImage *exported(const WrDocument *document, const char *kind, const char *path,
                         double full, WrExportReport *report)
{
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    options.cell_w = CELL_W, options.cell_h = CELL_H, options.full = full;
    if (!wr_export(wr_export_find(kind), document, &options, NULL, path, report, &err))
        fail_msg("%s", err.text);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    assert_true(image->width == W && image->height == H);
    return image;
}

/* part: allowed error of a number, relative to the largest. */
static void floats_agree(bool formula, double part)
{
    WrDocument *document = document_of_wave(formula);
    WrExportReport report;
    WrImage *slopes = exported(document, "slopes", "slopes.exr", 0, &report),
            *angle = exported(document, "slope", "slope.exr", 0, &report),
            *bend = exported(document, "curvature", "bend.exr", 0, &report);
    assert_int_equal(slopes->channels, 2);
    double most = 0;
    for (int i = 0; i < W * H; i++) most = fmax(most, fabs((double)bend->data[i]));
    assert_near(fmax(-report.low, report.high), most, 1e-5 * most);
    for (int i = 0; i < W * H; i++) {
        const Wave w = wave_at((i % W + 0.5) / W, 1 - (i / W + 0.5) / H);
        assert_near(slopes->data[2 * i], w.p, part * 1.5);
        assert_near(slopes->data[2 * i + 1], w.q, part * 1.5);
        assert_near(angle->data[i], atan(hypot(w.p, w.q)) * 180 / WR_PI, part * 90);
        /* differences over a texel have errors of second order, for waves 80 and 100 texels long */
        assert_near(bend->data[i], convexity(&w), most * (part + 2e-3));
    }
    wr_image_free(slopes), wr_image_free(angle), wr_image_free(bend);
    wr_document_free(document);
}

static void maps_of_a_wave_are_those_of_its_derivatives(void **state)
{
    (void)state;
    floats_agree(true, 1e-6);
    floats_agree(false, 1e-4);
}

/* Codes: level is exactly the middle, ridges are above it, `full` is white and clips. */
static void codes_say_what_the_label_says(void **state)
{
    (void)state;
    WrDocument *document = document_of_wave(true);
    WrExportReport report;
    WrImage *floats = exported(document, "curvature", "c.exr", 0, &report);
    WrImage *codes = exported(document, "curvature", "c.png", 0, &report);
    assert_int_equal(report.zero_code, 32768);
    assert_int_equal(report.clipped, 0);
    for (int i = 0; i < W * H; i++) {
        const double code = 65535 * (double)codes->data[i];
        const double back = (code - 32768) / 32767 * report.amplitude;
        assert_near(back, floats->data[i], 0.51 / 32767 * report.amplitude);
    }
    wr_image_free(codes);
    const double full = report.amplitude / 3;
    codes = exported(document, "curvature", "c8.png", full, &report);
    int beyond = 0;
    for (int i = 0; i < W * H; i++) beyond += fabs((double)floats->data[i]) > full;
    assert_true(beyond > 1000);
    assert_near((double)report.clipped, beyond, 0.001 * beyond);
    wr_image_free(codes);
    WrImage *angle = exported(document, "slope", "s.png", 0, &report);
    wr_image_free(floats);
    floats = exported(document, "slope", "s.exr", 0, &report);
    for (int i = 0; i < W * H; i++)
        assert_near(90 * (double)angle->data[i], floats->data[i], 90 * 0.51 / 65535 + 1e-5);
    wr_image_free(angle), wr_image_free(floats);
    wr_document_free(document);
}

static void a_flat_table_is_level_and_slopes_want_floats(void **state)
{
    (void)state;
    WrDocument *document = wr_document_new();
    WrExportOptions options = wr_export_default();
    WrExportReport report;
    WrError err = { "" };
    assert_true(wr_export(wr_export_find("curvature"), document, &options, NULL, "flat.png",
                          &report, &err));
    WrImage *image = wr_image_read("flat.png", &err);
    for (int i = 0; i < image->width * image->height; i++)
        assert_near(65535 * (double)image->data[i], 32768, 0.01);
    wr_image_free(image);
    assert_false(
        wr_export(wr_export_find("slopes"), document, &options, NULL, "s.png", &report, &err));
    assert_non_null(strstr(err.text, "exr"));
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_of_a_wave_are_those_of_its_derivatives),
        cmocka_unit_test(codes_say_what_the_label_says),
        cmocka_unit_test(a_flat_table_is_level_and_slopes_want_floats),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
