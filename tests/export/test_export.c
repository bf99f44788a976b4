/* Exports: codes and normals against their formulas, through real files. */
#include "test.h"
#include "field/scheme_list.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "document/document.h"
#include "document/document_file.h"
#include "export/export.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

/* ---- tables and files ---- */

static WrDocument *document_of(WrField *field)
{
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    return document;
}

static WrField *new_field(int width, int height, WrWrap wrap)
{
    WrField *field = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    assert_non_null(field);
    return field;
}

static WrField *random_field(int width, int height, WrWrap wrap, double low, double high)
{
    TestRandom random = { 31 };
    WrField *field = new_field(width, height, wrap);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(low + (high - low) * test_random(&random)));
    return field;
}

/* The document's scene, to be changed by the caller alone. */
static WrScene *own_scene(WrDocument *document)
{
    WrScene *scene = wr_scene_clone(document->scene);
    wr_scene_free(document->scene);
    return document->scene = scene;
}

/* A mesh for kinds that need one, else a plane. */
static void fit_surface(WrDocument *document, const WrExportKind *kind)
{
    const bool mesh = kind->on_surface && kind->make;
    wr_shape_default(mesh ? WR_SURFACE_mesh : WR_SURFACE_plane, &own_scene(document)->shape);
}

/* Options as in a command: "range=auto", ..., NULL-terminated. */
static WrExportOptions options_of(const char *kind, const char *const *settings)
{
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    for (; settings && *settings; settings++) {
        char name[32];
        const char *equals = strchr(*settings, '=');
        snprintf(name, sizeof name, "%.*s", (int)(equals - *settings), *settings);
        if (!wr_export_option(wr_export_find(kind), &options, name, equals + 1, &err))
            fail_msg("%s", err.text);
    }
    return options;
}

static WrExportReport export_to(const WrDocument *document, const char *kind,
                                const char *const *settings, const char *path)
{
    WrExportOptions options = options_of(kind, settings);
    WrExportReport report;
    WrError err = { "" };
    if (!wr_export(wr_export_find(kind), document, &options, NULL, path, &report, &err))
        fail_msg("%s", err.text);
    return report;
}

static WrImage *read_back(const char *path)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static int code_at(const WrImage *image, int i, int j, int channel)
{
    double last = image->type == WR_PIXEL_U8 ? 255.0 : 65535.0;
    double code = (double)image->data[(j * image->width + i) * image->channels + channel] * last;
    assert_near(code, round(code), 0.01);
    return (int)lround(code);
}

#define SETTINGS(...) ((const char *const[]){ __VA_ARGS__, NULL })

/* ---- heights ---- */

static void heights_in_a_range_become_the_codes_of_the_formula(void **state)
{
    (void)state;
    const struct {
        float f;
        int code16, code8;
    } known[] = {
        { -1, 0, 0 },      { 3, 65535, 255 }, { 1, 32768, 128 },          { 0, 16384, 64 },
        { 2, 49151, 191 }, { -1.5f, 0, 0 },   { 3.0000002f, 65535, 255 }, { 1e30f, 65535, 255 }
    };
    WrField *field = new_field(8, 1, WR_WRAP_PERIODIC);
    for (int i = 0; i < 8; i++) wr_field_set(field, i, 0, known[i].f);
    WrDocument *document = document_of(field);
    WrExportReport report = export_to(document, "height", SETTINGS("range=-1,3"), "h.png");
    assert_int_equal(report.depth, 16);
    assert_int_equal(report.clipped, 3);
    assert_int_equal(report.replaced, 0);
    assert_true(report.low == -1.5 && report.high == (double)1e30f && report.zero_code == -1);
    WrImage *image = read_back("h.png");
    assert_int_equal(image->channels, 1);
    for (int i = 0; i < 8; i++) assert_int_equal(code_at(image, i, 0, 0), known[i].code16);
    wr_image_free(image);
    export_to(document, "height", SETTINGS("range=-1,3", "depth=8"), "h.bmp");
    image = read_back("h.bmp");
    for (int i = 0; i < 8; i++) assert_int_equal(code_at(image, i, 0, 0), known[i].code8);
    wr_image_free(image);
    wr_document_free(document);
}

static void every_16_bit_code_survives_the_default_range(void **state)
{
    (void)state;
    WrField *field = new_field(256, 256, WR_WRAP_PERIODIC);
    for (int k = 0; k < 65536; k++) wr_field_set(field, k % 256, k / 256, (float)k / 65535.0f);
    WrDocument *document = document_of(field);
    WrExportReport report = export_to(document, "height", NULL, "all.png");
    assert_int_equal(report.clipped, 0);
    WrImage *image = read_back("all.png");
    for (int k = 0; k < 65536; k++) assert_int_equal(code_at(image, k % 256, k / 256, 0), k);
    wr_image_free(image);
    wr_document_free(document);
}

/* Heights far outside 0..1: by default the range is the table's own, and the label records it. */
static void nothing_is_clipped_unless_it_is_asked_for(void **state)
{
    (void)state;
    static const char *const files[] = { "own.png", "own.tif", "own.bmp" };
    static const char *const depths[] = { "depth=16", "depth=8", "depth=8" };
    for (int k = 0; k < 3; k++) {
        WrDocument *document = document_of(random_field(37, 51, WR_WRAP_PERIODIC, -3.3f, 7.1f));
        WrExportReport report = export_to(document, "height", SETTINGS(depths[k]), files[k]);
        float low, high;
        wr_field_range(wr_document_field(document), &low, &high);
        assert_int_equal(report.clipped, 0);
        assert_true(report.code_low == (double)low && report.code_high == (double)high);
        WrImage *image = read_back(files[k]);
        const double last = image->type == WR_PIXEL_U8 ? 255 : 65535;
        if (k < 2) { /* BMP stores no text */
            assert_int_equal(image->label.kind, WR_LABEL_HEIGHT);
            assert_true(wr_image_apply_range(image));
            for (int t = 0; t < 37 * 51; t++)
                assert_near(image->data[t],
                            wr_field_get(wr_document_field(document), t % 37, t / 37),
                            0.51 * (high - low) / last + 1e-6);
        }
        wr_image_free(image);
        wr_document_free(document);
    }
}

/* The table after a round trip through an integer file with range 0,1. */
static WrField *through_file(const WrDocument *document, const char *depth, const char *path)
{
    export_to(document, "height", SETTINGS(depth, "range=0,1"), path);
    WrImage *image = read_back(path);
    const WrField *f = wr_document_field(document);
    WrField *back = wr_import_heights(image, 0, 0, wr_field_wrap_u(f), wr_field_wrap_v(f), NULL);
    wr_image_free(image);
    return back;
}

/* amplitude 1, n texels per unit: a slope is a multiple of n / (2 codes), so a gentle slope becomes terraces */
static void hc51_hc52_slopes_of_integer_heights_are_multiples_of_the_quantum(void **state)
{
    (void)state;
    const struct {
        const char *depth;
        double codes, quantum_deg[3];
    } files[] = { { "depth=8", 255, { 7.2, 26.7, 63.5 } },
                  { "depth=16", 65535, { 0.028, 0.11, 0.45 } } };
    const int sizes[3] = { 64, 256, 1024 };
    for (int d = 0; d < 2; d++)
        for (int k = 0; k < 3; k++) {
            int n = sizes[k];
            double quantum = n / (2 * files[d].codes);
            assert_near(atan(quantum) * 180 / WR_PI, files[d].quantum_deg[k], 0.06);
            WrField *field = new_field(n, 1, WR_WRAP_CLAMP);
            for (int i = 0; i < n; i++)
                wr_field_set(field, i, 0, (float)(0.3 + 0.01 * i / n)); /* slope 0.01 */
            WrDocument *document = document_of(field);
            WrField *back = through_file(document, files[d].depth, "q.png");
            int steps = 0;
            for (int i = 1; i < n - 1; i++) {
                double f = wr_field_get(field, i, 0), g = wr_field_get(back, i, 0);
                /* half a code, and float precision */
                assert_near(g, f, 0.5 / files[d].codes + 1e-7);
                double slope =
                    n * (wr_field_get(back, i + 1, 0) - wr_field_get(back, i - 1, 0)) / 2;
                double error = slope - 0.01;
                assert_near(slope / quantum, round(slope / quantum), 0.02);
                assert_true(fabs(error) <= quantum + 1e-4);
                steps += fabs(slope) < quantum / 2;
            }
            if (d == 0) assert_true(steps > n / 2); /* most of an 8-bit ramp is flat: terraces */
            wr_field_free(back);
            wr_document_free(document);
        }
}

static void hc53_a_second_trip_through_an_integer_file_changes_nothing(void **state)
{
    (void)state;
    const char *paths[2][2] = { { "a16.png", "b16.png" }, { "a8.tif", "b8.tif" } };
    for (int d = 0; d < 2; d++) {
        const char *depth = d == 0 ? "depth=16" : "depth=8";
        WrDocument *first = document_of(random_field(70, 50, WR_WRAP_PERIODIC, 0, 1));
        WrDocument *second = document_of(through_file(first, depth, paths[d][0]));
        WrField *third = through_file(second, depth, paths[d][1]);
        assert_true(wr_hash_equal(wr_field_hash(third), wr_field_hash(wr_document_field(second))));
        char *a, *b;
        size_t length_a, length_b;
        assert_true(wr_file_read(paths[d][0], 1 << 20, &a, &length_a, NULL));
        assert_true(wr_file_read(paths[d][1], 1 << 20, &b, &length_b, NULL));
        assert_int_equal(length_a, length_b);
        assert_memory_equal(a, b, length_a);
        wr_free(a);
        wr_free(b);
        wr_field_free(third);
        wr_document_free(first);
        wr_document_free(second);
    }
}

static void signed_heights_keep_zero_exact_and_mirror(void **state)
{
    (void)state;
    const float values[5] = { 0, 2.5f, -2.5f, 1.0f, -1.0f };
    WrField *field = new_field(5, 1, WR_WRAP_PERIODIC);
    for (int i = 0; i < 5; i++) wr_field_set(field, i, 0, values[i]);
    WrDocument *document = document_of(field);
    WrExportReport report = export_to(document, "height", SETTINGS("range=signed"), "s.png");
    assert_true(report.zero_code == 32768 && report.amplitude == 2.5);
    WrImage *image = read_back("s.png");
    const int codes16[5] = { 32768, 65535, 1, 32768 + 13107, 32768 - 13107 };
    for (int i = 0; i < 5; i++) assert_int_equal(code_at(image, i, 0, 0), codes16[i]);
    wr_image_free(image);
    report = export_to(document, "height", SETTINGS("range=signed", "depth=8"), "s.png");
    assert_int_equal(report.zero_code, 128);
    image = read_back("s.png");
    const int codes8[5] = { 128, 255, 1, 128 + 51, 128 - 51 }; /* 127 / 2.5 = 50.8 */
    for (int i = 0; i < 5; i++) assert_int_equal(code_at(image, i, 0, 0), codes8[i]);
    wr_image_free(image);
    wr_field_set(field, 2, 0, -5.0f); /* the deepest dent determines the scale too */
    report = export_to(document, "height", SETTINGS("range=signed"), "s.png");
    assert_true(report.amplitude == 5.0 && report.clipped == 0);
    image = read_back("s.png");
    assert_int_equal(code_at(image, 2, 0, 0), 1);
    assert_int_equal(code_at(image, 1, 0, 0), 32768 + 16384); /* 16383.5 */
    wr_image_free(image);
    wr_document_free(document);
    document = document_of(new_field(2, 2, WR_WRAP_PERIODIC)); /* no amplitude */
    export_to(document, "height", SETTINGS("range=signed"), "s.png");
    image = read_back("s.png");
    assert_int_equal(code_at(image, 1, 1, 0), 32768);
    wr_image_free(image);
    wr_document_free(document);
}

static void the_automatic_range_uses_all_codes_and_flat_tables_are_code_0(void **state)
{
    (void)state;
    WrField *field = random_field(40, 30, WR_WRAP_PERIODIC, -3, -2);
    wr_field_set(field, 7, 8, -5.0f);
    wr_field_set(field, 9, 1, 11.0f);
    WrDocument *document = document_of(field);
    WrExportReport report = export_to(document, "height", SETTINGS("range=auto"), "auto.png");
    assert_true(report.code_low == -5 && report.code_high == 11 && report.clipped == 0);
    WrImage *image = read_back("auto.png");
    assert_int_equal(code_at(image, 7, 8, 0), 0);
    assert_int_equal(code_at(image, 9, 1, 0), 65535);
    wr_image_free(image);
    const float levels[] = { 0.0f, -7.5f, 3e38f };
    for (int k = 0; k < 3; k++) {
        wr_field_fill(field, levels[k]);
        report = export_to(document, "height", SETTINGS("range=auto"), "auto.png");
        assert_true(report.code_low == levels[k] && report.code_high > report.code_low);
        image = read_back("auto.png");
        assert_int_equal(code_at(image, 20, 20, 0), 0);
        wr_image_free(image);
    }
    wr_document_free(document);
}

static void float_heights_leave_unchanged(void **state)
{
    (void)state;
    const char *paths[] = { "f.exr", "f.tif" };
    WrDocument *document = document_of(random_field(130, 70, WR_WRAP_CLAMP, -1e6, 1e6));
    for (int k = 0; k < 2; k++) {
        WrExportReport report = export_to(document, "height", NULL, paths[k]);
        assert_true(report.depth == 32 && !report.ranged);
        WrImage *image = read_back(paths[k]);
        assert_true(image->type == WR_PIXEL_F32 && image->channels == 1);
        const WrField *f = wr_document_field(document);
        for (int i = 0; i < 130 * 70; i++)
            assert_true(image->data[i] == wr_field_get(f, i % 130, i / 130));
        wr_image_free(image);
    }
    assert_false(wr_document_recognise("f.exr"));
    wr_document_free(document);
}

static void files_say_what_they_hold(void **state)
{
    (void)state;
    WrDocument *document = document_of(random_field(8, 8, WR_WRAP_CLAMP, 0, 1));
    own_scene(document)->height = 0.25;
    export_to(document, "height", SETTINGS("range=-1,2.5"), "say.png");
    WrImageFile *file = wr_image_file_open("say.png", NULL);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:kind"), "height");
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:range"), "-1,2.5");
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:wrap"), "clamp");
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:height"), "0.25");
    wr_image_file_close(file);
    export_to(document, "height", SETTINGS("range=signed"), "say.tif");
    export_to(document, "normal-y", SETTINGS("cell=2,0.5", "scheme=bspline"), "say.exr");
    file = wr_image_file_open("say.exr", NULL);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:convention"), "-Y");
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:cell"), "2,0.5");
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:scheme"), "bspline");
    wr_image_file_close(file);
    wr_document_free(document);
}

/* ---- normals ---- */

static void set_wave(WrScene *scene, int k, int l, double a)
{
    scene->analytic.kind = WR_ANALYTIC_FOURIER;
    scene->analytic.count = 1;
    scene->analytic.terms = wr_alloc(1, sizeof *scene->analytic.terms);
    scene->analytic.terms[0] = (WrAnalyticTerm){ .i = k, .j = l, .a = a, .phase_u_deg = 30 };
}

/* F = a cos(2 pi 3 u + 30 deg) cos(2 pi 2 v), differentiated by hand. */
static void wave_normal(double a, double height, double w, double h, int i, int j, int n,
                        double out[3])
{
    double u = (i + 0.5) / n, v = 1 - (j + 0.5) / n;
    double fu = -a * 6 * WR_PI * sin(6 * WR_PI * u + WR_PI / 6) * cos(4 * WR_PI * v);
    double fv = -a * 4 * WR_PI * cos(6 * WR_PI * u + WR_PI / 6) * sin(4 * WR_PI * v);
    double x = -height * fu / w, y = -height * fv / h, length = sqrt(x * x + y * y + 1);
    out[0] = x / length;
    out[1] = y / length;
    out[2] = 1 / length;
}

static void normals_of_a_wave_agree_with_its_closed_form_within_half_a_code(void **state)
{
    (void)state;
    const struct {
        const char *path, *depth;
        double step; /* of a stored value; 0: float */
    } files[] = { { "w8.png", "depth=8", 255 },
                  { "w16.png", "depth=16", 65535 },
                  { "w.exr", "depth=32", 0 } };
    enum { N = 48 };
    WrDocument *document = document_of(new_field(N, N, WR_WRAP_PERIODIC));
    WrScene *scene = own_scene(document);
    set_wave(scene, 3, 2, 0.05);
    scene->height = 1.5;
    for (int sign = -1; sign <= 1; sign += 2)
        for (int d = 0; d < 3; d++) {
            export_to(document, sign > 0 ? "normal+y" : "normal-y",
                      SETTINGS(files[d].depth, "cell=2,0.7"), files[d].path);
            WrImage *image = read_back(files[d].path);
            double tolerance = files[d].step > 0 ? 0.5 / files[d].step + 1e-7 : 1e-7;
            for (int j = 0; j < N; j++)
                for (int i = 0; i < N; i++) {
                    double n[3];
                    wave_normal(0.05, 1.5, 2, 0.7, i, j, N, n);
                    const float *p = image->data + 3 * (j * N + i);
                    assert_near(p[0], n[0] / 2 + 0.5, tolerance);
                    assert_near(p[1], sign * n[1] / 2 + 0.5, tolerance);
                    assert_near(p[2], n[2] / 2 + 0.5, tolerance);
                }
            wr_image_free(image);
        }
    wr_document_free(document);
}

static void heights_of_a_formula_are_its_values_at_texel_centres(void **state)
{
    (void)state;
    WrDocument *document = document_of(random_field(60, 20, WR_WRAP_PERIODIC, 5, 6)); /* unused */
    set_wave(own_scene(document), 3, 2, 0.5);
    WrExportReport report = export_to(document, "height", NULL, "formula.exr");
    WrImage *image = read_back("formula.exr");
    double low = 1, high = -1;
    for (int j = 0; j < 20; j++)
        for (int i = 0; i < 60; i++) {
            double u = (i + 0.5) / 60, v = 1 - (j + 0.5) / 20;
            double f = 0.5 * cos(6 * WR_PI * u + WR_PI / 6) * cos(4 * WR_PI * v);
            assert_near(image->data[60 * j + i], f, 1e-7);
            low = fmin(low, image->data[60 * j + i]);
            high = fmax(high, image->data[60 * j + i]);
        }
    assert_true(report.low == low && report.high == high);
    wr_image_free(image);
    wr_document_free(document);
}

/* A table's normals against the sampling functions of the field module, which do not use stencils. */
static void check_scheme(int scheme, WrWrap wrap)
{
    enum { W = 32, H = 64 }; /* powers of two: texel centres are exact, also for creased bilinear */
    WrDocument *document = document_of(random_field(W, H, wrap, -0.02, 0.02));
    char setting[40];
    snprintf(setting, sizeof setting, "scheme=%s", wr_schemes[scheme].name);
    export_to(document, "normal+y", SETTINGS(setting), "scheme.exr");
    WrImage *image = read_back("scheme.exr");
    double height = document->scene->height;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double u = (i + 0.5) / W, v = 1 - (j + 0.5) / H, fu, fv;
            wr_field_sample(wr_document_field(document), (WrScheme)scheme, 1, &u, &v, NULL, &fu,
                            &fv);
            double length = sqrt(height * height * (fu * fu + fv * fv) + 1);
            const float *p = image->data + 3 * (j * W + i);
            if (fabs(p[0] - (0.5 - height * fu / length / 2)) > 1e-6 ||
                fabs(p[1] - (0.5 - height * fv / length / 2)) > 1e-6)
                fail_msg("%s, wrap %d, texel %d,%d: %g %g, want %g %g", wr_schemes[scheme].name,
                         wrap, i, j, p[0], p[1], 0.5 - height * fu / length / 2,
                         0.5 - height * fv / length / 2);
        }
    wr_image_free(image);
    wr_document_free(document);
}

static void normals_of_a_table_follow_every_scheme(void **state)
{
    (void)state;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        check_scheme(scheme, WR_WRAP_PERIODIC);
        check_scheme(scheme, WR_WRAP_CLAMP);
    }
}

/* A table on a level of a million has the normals of one on 0: heights differ by multiples of 1/8, which both
   represent exactly. */
static void a_high_level_leaves_normals_as_they_were(void **state)
{
    (void)state;
    enum { W = 21, H = 34 };
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        WrImage *images[2];
        for (int k = 0; k < 2; k++) {
            WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0, NULL);
            TestRandom random = { 9 };
            for (int t = 0; t < W * H; t++)
                wr_field_set(field, t % W, t / W,
                             (float)(k * 1e6 + floor(16 * test_random(&random)) / 8));
            WrDocument *document = document_of(field);
            char setting[40];
            snprintf(setting, sizeof setting, "scheme=%s", wr_schemes[scheme].name);
            export_to(document, "normal+y", SETTINGS(setting), "level.exr");
            images[k] = read_back("level.exr");
            wr_document_free(document);
        }
        for (int c = 0; c < 3 * W * H; c++)
            assert_near(images[1]->data[c], images[0]->data[c], 1e-7);
        wr_image_free(images[0]);
        wr_image_free(images[1]);
    }
}

static void flat_tables_face_straight_up(void **state)
{
    (void)state;
    WrField *field = new_field(5, 4, WR_WRAP_CLAMP);
    wr_field_fill(field, 1e6f);
    WrDocument *document = document_of(field);
    export_to(document, "normal+y", SETTINGS("depth=8"), "flat.png");
    WrImage *image = read_back("flat.png");
    for (int i = 0; i < 20; i++) {
        assert_int_equal(code_at(image, i % 5, i / 5, 0), 128);
        assert_int_equal(code_at(image, i % 5, i / 5, 1), 128);
        assert_int_equal(code_at(image, i % 5, i / 5, 2), 255);
    }
    wr_image_free(image);
    wr_document_free(document);
}

static void the_upper_flank_of_a_bump_is_bright_green_in_plus_y_only(void **state)
{
    (void)state;
    WrField *field = new_field(32, 32, WR_WRAP_PERIODIC);
    for (int j = 0; j < 32; j++)
        for (int i = 0; i < 32; i++)
            wr_field_set(field, i, j,
                         (float)exp(-((i - 16) * (i - 16) + (j - 16) * (j - 16)) / 30.0));
    WrDocument *document = document_of(field);
    export_to(document, "normal+y", NULL, "plus.png");
    export_to(document, "normal-y", NULL, "minus.png");
    WrImage *plus = read_back("plus.png"), *minus = read_back("minus.png");
    assert_true(code_at(plus, 16, 12, 1) > 40000 && code_at(plus, 16, 20, 1) < 25000);
    assert_true(code_at(minus, 16, 12, 1) < 25000 && code_at(minus, 16, 20, 1) > 40000);
    assert_true(code_at(plus, 20, 16, 0) > 40000 &&
                code_at(plus, 12, 16, 0) < 25000); /* red: right flank */
    for (int i = 0; i < 32 * 32; i++) {
        assert_int_equal(code_at(plus, i % 32, i / 32, 0), code_at(minus, i % 32, i / 32, 0));
        int sum = code_at(plus, i % 32, i / 32, 1) + code_at(minus, i % 32, i / 32, 1);
        assert_true(sum == 65535 || sum == 65536); /* 65536 if both round up from the middle */
    }
    wr_image_free(plus);
    wr_image_free(minus);
    wr_document_free(document);
}

static void replication_and_surface_are_not_in_the_cell(void **state)
{
    (void)state;
    WrDocument *document = document_of(random_field(16, 16, WR_WRAP_PERIODIC, 0, 1));
    export_to(document, "normal+y", NULL, "once.tif");
    WrScene *scene = own_scene(document);
    scene->replicate_u = 7;
    wr_shape_default((WrSurfaceKind)(WR_SURFACE_COUNT - 1), &scene->shape);
    export_to(document, "normal+y", NULL, "many.tif");
    assert_int_equal(system("cmp -s once.tif many.tif"), 0);
    wr_document_free(document);
}

static void hc96_values_that_are_not_finite_are_replaced_and_counted(void **state)
{
    (void)state;
    WrDocument *document = document_of(new_field(16, 4, WR_WRAP_PERIODIC));
    WrScene *scene = own_scene(document);
    set_wave(scene, 0, 0, 1e300); /* overflows float everywhere */
    const char *paths[] = { "inf.png", "inf.exr" };
    for (int k = 0; k < 2; k++) {
        WrExportReport report = export_to(document, "height", NULL, paths[k]);
        assert_int_equal(report.replaced, 64);
        WrImage *image = read_back(paths[k]);
        assert_true(image->data[5] == 0.0f && image->replaced == 0);
        wr_image_free(image);
    }
    scene->analytic.terms[0].i = 1;
    scene->height = 1e300; /* the slope overflows double: straight up */
    WrExportReport report = export_to(document, "normal+y", NULL, "inf.png");
    assert_true(report.replaced > 0);
    WrImage *image = read_back("inf.png");
    for (int i = 0; i < 64; i++) assert_int_equal(code_at(image, i % 16, i / 16, 2) > 0, 1);
    wr_image_free(image);
    wr_document_free(document);
}

/* ---- all kinds ---- */

static void the_bytes_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    const int threads[2][2] = { { 1, 7 }, { 1, 2 } };
    const int width = test_amount(117, 37), height = test_amount(151, 53);
    WrDocument *table = document_of(random_field(width, height, WR_WRAP_CLAMP, -1, 2));
    WrDocument *formula = document_of(new_field(width, height, WR_WRAP_PERIODIC));
    set_wave(own_scene(formula), 3, 2, 0.5);
    for (int kind = 0; kind < WR_EXPORT_KIND_COUNT; kind++)
        for (int which = kind % test_step(1, 2); which < 2; which += test_step(1, 2)) {
            WrExportReport first = { 0 };
            for (int t = 0; t < 2; t++) {
                const char *name = wr_export_kinds[kind].name;
                fit_surface(which ? formula : table, &wr_export_kinds[kind]);
                bool drawn = wr_export_kinds[kind].write || wr_export_kinds[kind].floats;
                WrExportOptions options =
                    options_of(name, drawn ? NULL : SETTINGS("depth=8", "dither=on"));
                options.range = WR_EXPORT_RANGE_AUTO;
                options.scheme = WR_SCHEME_BSPLINE_FIT;
                WrPool *pool = wr_pool_new(threads[which][t]);
                WrExportReport report;
                const char *ending = wr_export_kinds[kind].ending;
                char path[16], line[64];
                snprintf(path, sizeof path, "%s.%s", t == 0 ? "first" : "other",
                         ending ? ending : "tif");
                options.solid_error = 4;
                assert_true(wr_export(wr_export_find(name), which ? formula : table, &options, pool,
                                      path, t == 0 ? &first : &report, NULL));
                wr_pool_free(pool);
                if (t == 0) continue;
                snprintf(line, sizeof line, "cmp -s first.%s %s", ending ? ending : "tif", path);
                assert_int_equal(system(line), 0);
                assert_true(report.clipped == first.clipped && report.low == first.low);
            }
        }
    wr_document_free(table);
    wr_document_free(formula);
}

static void dither_keeps_the_mean_and_whole_codes(void **state)
{
    (void)state;
    WrField *field = new_field(128, 128, WR_WRAP_PERIODIC);
    WrDocument *document = document_of(field);
    for (int k = 0; k <= 10; k++) {
        double code = 100 + k / 10.0, sum = 0;
        wr_field_fill(field, (float)(code / 255));
        export_to(document, "height", SETTINGS("depth=8", "dither=on", "range=0,1"), "d.png");
        WrImage *image = read_back("d.png");
        for (int i = 0; i < 128 * 128; i++) {
            int got = code_at(image, i % 128, i / 128, 0);
            assert_true(got >= 100 && got <= 101);
            if (k == 0) assert_int_equal(got, 100);
            sum += got;
        }
        /* any 8 x 8 texels have nearly the mean: no clumps (random dither would deviate by 0.06) */
        for (int at = 0; at < 120; at += 5) {
            double block = 0;
            for (int i = 0; i < 64; i++) block += code_at(image, at + i % 8, at + i / 8, 0);
            assert_near(block / 64, code, 0.08);
        }
        assert_near(sum / (128 * 128), code, 0.003);
        wr_image_free(image);
    }
    wr_document_free(document);
}

static void a_line_drawing_leaves_as_a_picture_and_as_vectors(void **state)
{
    (void)state;
    WrDocument *document = document_of(random_field(20, 12, WR_WRAP_PERIODIC, 0, 1));
    export_to(document, "lines", SETTINGS("size=320x200"), "drawn.png");
    WrImage *image = read_back("drawn.png");
    assert_int_equal(image->width, 320);
    assert_int_equal(image->height, 200);
    assert_int_equal(image->channels, 1);
    assert_near(image->data[0], 1.0, 0); /* paper */
    int64_t inked = 0;
    for (int i = 0; i < 320 * 200; i++) inked += image->data[i] < 0.5f;
    assert_true(inked > 320 && inked < 320 * 200 / 2);
    wr_image_free(image);
    export_to(document, "lines", SETTINGS("hidden=on"), "drawn.svg");
    char *text;
    size_t length;
    WrError err;
    assert_true(wr_file_read("drawn.svg", 1 << 20, &text, &length, &err));
    int strokes = 0; /* one path per line: 12 along u, 20 along v, none broken */
    for (size_t i = 0; i < length; i++) strokes += text[i] == 'M';
    assert_int_equal(strokes, 12 + 20);
    assert_non_null(strstr(text, "viewBox=\"0 0 1024 768\""));
    wr_free(text);
    wr_document_free(document);
}

/* Expected value of a single texel of height 0.3: as a code from 0 to 1, and as a float. NULL-terminated. */
static const struct {
    const char *kind;
    double code, number;
} lone[] = { { "slopes", 0, 0 },    { "slope", 0, 0 },     { "curvature", 32768 / 65535.0, 0 },
             { "occlusion", 1, 1 }, { "horizon", 0, 0 },   { "cavity", 1, 0 },
             { "direction", 0, 0 }, { "roughness", 0, 0 }, { "displacement", 0, 0.3 * 0.1 },
             { "mask", 1, 1 },      { "wear", 0, 0 },      { "packed", 1, 1 },
             { NULL, 0, 0 } };

static void hc95_a_single_texel_leaves_as_every_kind(void **state)
{
    (void)state;
    const char *paths[] = { "one.png", "one.exr", "one.tif" };
    WrField *field = new_field(1, 1, WR_WRAP_PERIODIC);
    wr_field_set(field, 0, 0, 0.3f);
    WrDocument *document = document_of(field);
    own_scene(document)->height = 0.1;
    for (int kind = 0; kind < WR_EXPORT_KIND_COUNT; kind++)
        for (int k = wr_export_kinds[kind].floats; k < 3 && !wr_export_kinds[kind].write; k++) {
            if (wr_export_kinds[kind].levels) continue; /* tested in test_bump_slopes */
            fit_surface(document, &wr_export_kinds[kind]);
            export_to(document, wr_export_kinds[kind].name, NULL, paths[k]);
            WrImage *image = read_back(paths[k]);
            assert_int_equal(image->width * image->height, 1);
            if (wr_export_kinds[kind].green != 0) assert_near(image->data[2], 1.0, 0);
            for (int row = 0; lone[row].kind; row++)
                if (strcmp(lone[row].kind, wr_export_kinds[kind].name) == 0)
                    assert_near(image->data[0], k == 0 ? lone[row].code : lone[row].number, 1e-6);
            wr_image_free(image);
        }
    wr_document_free(document);
}

static void options_out_of_range_are_errors_that_name_them(void **state)
{
    (void)state;
    const struct {
        const char *kind, *name, *value, *word;
    } bad[] = { { "height", "depth", "12", "8, 16 or 32" },
                { "height", "depth", "", "8, 16 or 32" },
                { "height", "range", "1,1", "LOW below HIGH" },
                { "height", "range", "2,1", "LOW below" },
                { "height", "range", "0", "auto or signed" },
                { "height", "range", "0,inf", "auto" },
                { "height", "range", "0,1,2", "auto" },
                { "height", "dither", "yes", "on or off" },
                { "height", "signs", "plain", "must be one of depth, range, cell" },
                { "normal+y", "cell", "0,1", "above 0" },
                { "normal+y", "cell", "1", "above 0" },
                { "normal-y", "cell", "1,-1", "above 0" },
                { "normal-y", "scheme", "cubic", "bilinear" },
                { "normal-y", "range", "auto", "unknown name" } };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrExportOptions options = wr_export_default(), before = options;
        WrError err = { "" };
        assert_false(wr_export_option(wr_export_find(bad[i].kind), &options, bad[i].name,
                                      bad[i].value, &err));
        if (!strstr(err.text, bad[i].word) || !strstr(err.text, bad[i].name))
            fail_msg("'%s'", err.text);
        assert_true(options.depth == before.depth && options.low == before.low &&
                    options.range == before.range && options.cell_w == before.cell_w);
    }
    assert_null(wr_export_find("bump"));
    assert_null(wr_export_find(""));
    assert_ptr_equal(wr_export_find("height"), &wr_export_kinds[0]);
}

static void exports_that_cannot_be_leave_no_file(void **state)
{
    (void)state;
    const struct {
        const char *path, *setting, *word;
    } bad[] = { { "no.png", "depth=32", "PNG holds 8 or 16 bits; for floats use EXR or TIFF" },
                { "no.exr", "depth=8", "EXR holds 32-bit floats" },
                { "no.jpg", "depth=16", "JPEG holds 8 bits" },
                { "no.hdr", "depth=32", "HDR" },
                { "no.what", "depth=8", "'what' is not a picture format" },
                { "no.png", "dither=on", "dither needs 8 bits" },
                { "nowhere/no.png", "depth=8", "folder does not exist" },
                { ".", "depth=8", "is not a picture format" } };
    WrDocument *document = document_of(random_field(4, 4, WR_WRAP_PERIODIC, 0, 1));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrError err = { "" };
        WrExportReport report = { .width = 42 };
        WrExportOptions options = options_of("height", SETTINGS(bad[i].setting));
        assert_false(wr_export(wr_export_find("height"), document, &options, NULL, bad[i].path,
                               &report, &err));
        if (!strstr(err.text, bad[i].word)) fail_msg("'%s'", err.text);
        assert_int_equal(report.width, 42);
    }
    wr_document_free(document);
    assert_int_equal(system("ls -A | grep -q -e '^no' -e part"), 256); /* grep found no file */
}

static void a_full_disk_leaves_nothing_half_written(void **state)
{
    (void)state;
    const char *paths[] = { "full.png", "full.exr", "full.tif" };
    WrDocument *document = document_of(random_field(300, 300, WR_WRAP_PERIODIC, 0, 1));
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    small = old;
    small.rlim_cur = 50000;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (int k = 0; k < 3; k++) {
        WrError err = { "" };
        WrExportOptions options = wr_export_default();
        setrlimit(RLIMIT_FSIZE, &small);
        bool ok =
            wr_export(wr_export_find("height"), document, &options, NULL, paths[k], NULL, &err);
        setrlimit(RLIMIT_FSIZE, &old);
        assert_false(ok);
        if (!strstr(err.text, "cannot be written") || strchr(err.text, '\n'))
            fail_msg("'%s'", err.text);
    }
    signal(SIGXFSZ, handler);
    assert_int_equal(system("ls -A | grep -q full"), 256);
    wr_document_free(document);
}

static void the_report_reads_as_a_sentence(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrExportReport report = {
        .width = 8,
        .height = 4,
        .channels = 1,
        .depth = 16,
        .clipped = 1,
        .low = -0.5,
        .high = 1.25,
        .ranged = true,
        .code_high = 1,
        .zero_code = -1,
        .seam = { .u.order = 2, .v.order = 2, .pattern = { { .order = 2 }, { .order = 2 } } }
    };
    wr_export_report_text(&report, &text);
    assert_string_equal(wr_text_get(&text), "8x4, 16 bits, heights -0.5 to 1.25, codes are 0 to 1; "
                                            "1 texel outside the range, clipped; seam C2");
    wr_text_fini(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_in_a_range_become_the_codes_of_the_formula),
        cmocka_unit_test(every_16_bit_code_survives_the_default_range),
        cmocka_unit_test(nothing_is_clipped_unless_it_is_asked_for),
        cmocka_unit_test(hc51_hc52_slopes_of_integer_heights_are_multiples_of_the_quantum),
        cmocka_unit_test(hc53_a_second_trip_through_an_integer_file_changes_nothing),
        cmocka_unit_test(signed_heights_keep_zero_exact_and_mirror),
        cmocka_unit_test(the_automatic_range_uses_all_codes_and_flat_tables_are_code_0),
        cmocka_unit_test(float_heights_leave_unchanged),
        cmocka_unit_test(files_say_what_they_hold),
        cmocka_unit_test(normals_of_a_wave_agree_with_its_closed_form_within_half_a_code),
        cmocka_unit_test(heights_of_a_formula_are_its_values_at_texel_centres),
        cmocka_unit_test(normals_of_a_table_follow_every_scheme),
        cmocka_unit_test(a_high_level_leaves_normals_as_they_were),
        cmocka_unit_test(flat_tables_face_straight_up),
        cmocka_unit_test(the_upper_flank_of_a_bump_is_bright_green_in_plus_y_only),
        cmocka_unit_test(replication_and_surface_are_not_in_the_cell),
        cmocka_unit_test(hc96_values_that_are_not_finite_are_replaced_and_counted),
        cmocka_unit_test(the_bytes_do_not_depend_on_the_number_of_threads),
        cmocka_unit_test(dither_keeps_the_mean_and_whole_codes),
        cmocka_unit_test(a_line_drawing_leaves_as_a_picture_and_as_vectors),
        cmocka_unit_test(hc95_a_single_texel_leaves_as_every_kind),
        cmocka_unit_test(options_out_of_range_are_errors_that_name_them),
        cmocka_unit_test(exports_that_cannot_be_leave_no_file),
        cmocka_unit_test(a_full_disk_leaves_nothing_half_written),
        cmocka_unit_test(the_report_reads_as_a_sentence),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
