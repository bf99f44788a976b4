/* Maps of a whole table: against closed forms and explicit sums, for all schemes, sizes and shifted tables. */
#include "test.h"
#include "field/scheme_list.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "field/maps.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"

#define PI 3.14159265358979323846

static uint32_t seed = 20260101;

static double random_between(double low, double high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (seed / 4294967296.0);
}

static WrField *rough(int w, int h, WrWrap wrap)
{
    WrField *field = wr_field_new(w, h, wrap, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int k = 0; k < w * h; k++)
        wr_field_set(field, k % w, k / w, (float)random_between(-0.4, 1.1));
    return field;
}

typedef struct Made {
    WrMapJob job;
    int w, h;
    float *out;
} Made;

static Made made_of(const WrField *field, WrScheme scheme)
{
    const WrDerivatives ground = { field, NULL, scheme, 0.37, 1.3, 0.8 };
    Made made = { wr_map_default(&ground), wr_field_width(field), wr_field_height(field), NULL };
    made.out = wr_alloc((size_t)made.w * (size_t)made.h, sizeof(float));
    return made;
}

static void make(Made *made, WrFieldMapKind kind, WrPool *pool)
{
    const WrMapPart part = { 0, 0, made->w, made->h, (size_t)made->w };
    WrError err = { "" };
    int64_t replaced = 0;
    if (!wr_map_make(kind, &made->job, &part, pool, made->out, &replaced, &err))
        fail_msg("%s", err.text);
    assert_int_equal(replaced, 0);
}

/* ---- derivatives of a scheme ----------------------------------------------------------------------- */

/* Slopes at a point by the scheme itself, in scene units. */
static void slopes_at(const Made *made, double x, double y, double *p, double *q)
{
    const WrDerivatives *g = &made->job.ground;
    const double u = (x + 0.5) / made->w, v = 1 - (y + 0.5) / made->h;
    double fu, fv;
    wr_field_sample(g->field, g->scheme, 1, &u, &v, NULL, &fu, &fv);
    *p = g->height * fu / g->cell_w;
    *q = g->height * fv / g->cell_h;
}

/* Slightly off the centre, where bilinear's slopes jump, and off the middle between two, where those of central
   do. */
static double bend_at(const Made *made, int i, int j)
{
    const double e = 1e-7, dx = made->job.ground.cell_w / made->w,
                 dy = made->job.ground.cell_h / made->h;
    double p, q, a[2], b[2], c[2], d[2];
    slopes_at(made, i + e, j + e, &p, &q);
    slopes_at(made, i + 0.5, j + e, &a[0], &a[1]);
    slopes_at(made, i - 0.5, j + e, &b[0], &b[1]);
    slopes_at(made, i + e, j - 0.5, &c[0], &c[1]);
    slopes_at(made, i + e, j + 0.5, &d[0], &d[1]);
    const double r = (a[0] - b[0]) / dx, t = (c[1] - d[1]) / dy;
    const double s = 0.5 * ((a[1] - b[1]) / dx + (c[0] - d[0]) / dy);
    const double n = sqrt(1 + p * p + q * q);
    return -((1 + q * q) * r - 2 * p * q * s + (1 + p * p) * t) / (2 * n * n * n);
}

/* Stencils give the same values as the schemes' functions, evaluated at any point. */
static void slopes_and_bends_are_the_schemes_own(void **state)
{
    (void)state;
    const WrScheme schemes[] = { WR_SCHEME_BILINEAR, WR_SCHEME_CENTRAL, WR_SCHEME_BSPLINE,
                                 WR_SCHEME_BSPLINE_FIT, WR_SCHEME_CATMULL };
    WrField *field = rough(23, 17, WR_WRAP_PERIODIC);
    for (int n = 0; n < 5; n++) {
        Made made = made_of(field, schemes[n]);
        make(&made, WR_FIELD_MAP_SLOPE, NULL);
        for (int k = 0; k < 23 * 17; k++) {
            double p, q;
            slopes_at(&made, k % 23 + 1e-7, k / 23 + 1e-7, &p, &q);
            assert_near(made.out[k], atan(hypot(p, q)) * 180 / PI, 1e-3);
        }
        for (int axis = 0; axis < 2; axis++) {
            make(&made, axis ? WR_FIELD_MAP_SLOPE_V : WR_FIELD_MAP_SLOPE_U, NULL);
            for (int k = 0; k < 23 * 17; k++) {
                double s[2];
                slopes_at(&made, k % 23 + 1e-7, k / 23 + 1e-7, &s[0], &s[1]);
                assert_near(made.out[k], s[axis], 1e-5 * (1 + fabs(s[axis])));
            }
        }
        make(&made, WR_FIELD_MAP_DIRECTION, NULL);
        for (int k = 0; k < 23 * 17; k++) {
            double p, q;
            slopes_at(&made, k % 23 + 1e-7, k / 23 + 1e-7, &p, &q);
            assert_near(remainder((double)made.out[k] - atan2(-q, -p) * 180 / PI, 360), 0, 2e-3);
        }
        make(&made, WR_FIELD_MAP_CURVATURE, NULL);
        double most = 0;
        for (int k = 0; k < 23 * 17; k++) most = fmax(most, fabs((double)made.out[k]));
        for (int k = 0; k < 23 * 17; k++)
            assert_near(made.out[k], bend_at(&made, k % 23, k / 23), 1e-5 * most);
        wr_free(made.out);
    }
    wr_field_free(field);
}

/* A paraboloid on clamped axes: a r^2 has H = -a at its vertex, a dent seen from above; a saddle has 0. */
static void curvature_of_paraboloids_is_known(void **state)
{
    (void)state;
    for (int n = 0; n < 3; n++) {
        const double a = n == 1 ? -3.7 : 3.7, b = n == 2 ? -a : a;
        WrField *field = wr_field_new(31, 21, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
        for (int k = 0; k < 31 * 21; k++) {
            const double x = (k % 31 - 15) * 1.3 / 31, y = (k / 31 - 10) * 0.8 / 21;
            wr_field_set(field, k % 31, k / 31, (float)(a * x * x + b * y * y));
        }
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
            Made made = made_of(field, (WrScheme)scheme);
            make(&made, WR_FIELD_MAP_CURVATURE, NULL);
            if (scheme == WR_SCHEME_BILINEAR) { /* its slope there is that of half a texel
                                                   further */
                const double p = 0.37 * a * 1.3 / 31, q = 0.37 * b * 0.8 / 21;
                const double n2 = 1 + p * p + q * q;
                assert_near(made.out[10 * 31 + 15],
                            -0.37 * (a * (1 + q * q) + b * (1 + p * p)) / pow(n2, 1.5), 2e-3);
            } else assert_near(made.out[10 * 31 + 15], -0.37 * (a + b), 2e-3);
            wr_free(made.out);
        }
        wr_field_free(field);
    }
}

/* ---- roughness, cavity --------------------------------------------------------------------------- */

/* A wave of whole boxes: the variance of its slopes is half the square of their amplitude, so alpha^2 = base^2 + A^2
   / 2. */
static void roughness_of_a_sine_is_known(void **state)
{
    (void)state;
    const int w = 9 * 14, box = 9;
    WrField *field = wr_field_new(w, 5, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < w * 5; k++)
        wr_field_set(field, k % w, k / w, (float)(0.02 * sin(2 * PI * (k % w + 0.4) / box)));
    for (int base = 0; base < 2; base++) {
        Made made = made_of(field, WR_SCHEME_CENTRAL);
        made.job.box = box, made.job.base = 0.3 * base;
        make(&made, WR_FIELD_MAP_ROUGHNESS, NULL);
        const double steep = 0.37 * 0.02 * sin(2 * PI / box) / (1.3 / w);
        const double want = sqrt(sqrt(0.09 * base + steep * steep / 2));
        for (int k = 0; k < w * 5; k++) assert_near(made.out[k], want, 2e-5);
        wr_free(made.out);
    }
    wr_field_free(field);
}

static void roughness_is_the_variance_of_a_box(void **state)
{
    (void)state;
    WrField *field = rough(13, 300, WR_WRAP_PERIODIC);
    Made made = made_of(field, WR_SCHEME_BSPLINE);
    made.job.ground.height = 0.02;
    made.job.box = 5, made.job.base = 0.1;
    make(&made, WR_FIELD_MAP_ROUGHNESS, NULL);
    for (int k = 0; k < 13 * 300; k += 7) {
        double p, q, sum[4] = { 0 };
        for (int n = 0; n < 25; n++) {
            slopes_at(&made, k % 13 + n % 5 - 2, k / 13 + n / 5 - 2, &p, &q);
            sum[0] += p / 25, sum[1] += q / 25, sum[2] += p * p / 25, sum[3] += q * q / 25;
        }
        const double spread = sum[2] - sum[0] * sum[0] + sum[3] - sum[1] * sum[1];
        assert_near(made.out[k], fmin(1, sqrt(sqrt(0.01 + spread))), 1e-5);
    }
    wr_free(made.out);
    wr_field_free(field);
}

/* Depth of a texel below the mean of all others, weighted by a Gaussian of their distance on the torus. */
static void a_cavity_is_what_lies_below_its_blur(void **state)
{
    (void)state;
    enum { W = 19, H = 14 };
    WrField *field = rough(W, H, WR_WRAP_PERIODIC);
    Made made = made_of(field, WR_SCHEME_CENTRAL);
    made.job.sigma = 1.7;
    make(&made, WR_FIELD_MAP_CAVITY, NULL);
    int deep = 0;
    for (int k = 0; k < W * H; k++) {
        double sum = 0, weight = 0;
        for (int n = 0; n < 33 * 33; n++) {
            const int x = n % 33 - 16, y = n / 33 - 16;
            const double g = exp(-(x * x + y * y) / (2 * 1.7 * 1.7));
            sum +=
                g * (double)wr_field_get(field, (k % W + x + 2 * W) % W, (k / W + y + 2 * H) % H);
            weight += g;
        }
        const double want =
            fmin(0, 0.37 * ((double)wr_field_get(field, k % W, k / W) - sum / weight));
        assert_near(made.out[k], want, 2e-4);
        deep += made.out[k] < 0;
    }
    assert_in_range(deep, W * H / 4, 3 * W * H / 4);
    wr_free(made.out);
    wr_field_free(field);
}

/* ---- all of them --------------------------------------------------------------------------------- */

/* HC155: 1x1, 1xN, 2x3 and odd sizes, in all schemes, with all threads; bit-identical after shifts by whole
   texels. */
static void moved_tables_give_moved_maps(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 37 }, { 2, 3 }, { 67, 29 }, { 40, 131 } };
    WrPool *pool = wr_pool_new(3);
    for (int n = 0; n < 5 * WR_FIELD_MAP_COUNT; n++) {
        const int w = sizes[n % 5][0], h = sizes[n % 5][1], dx = w / 3 + 1, dy = h / 2;
        const WrFieldMapKind kind = (WrFieldMapKind)(n / 5);
        const WrScheme scheme = (WrScheme)(n * 5 / 3 % WR_SCHEME_COUNT);
        WrField *field = rough(w, h, WR_WRAP_PERIODIC);
        WrField *moved = rough(w, h, WR_WRAP_PERIODIC);
        for (int k = 0; k < w * h; k++)
            wr_field_set(moved, (k % w + dx) % w, (k / w + dy) % h,
                         wr_field_get(field, k % w, k / w));
        Made a = made_of(field, scheme), b = made_of(moved, scheme);
        make(&a, kind, NULL);
        make(&b, kind, pool);
        for (int k = 0; k < w * h; k++)
            if (a.out[k] != b.out[(k / w + dy) % h * w + (k % w + dx) % w])
                fail_msg("%s, %s, %dx%d", wr_field_maps[kind].name, wr_schemes[scheme].name, w, h);
        wr_free(a.out), wr_free(b.out);
        wr_field_free(field), wr_field_free(moved);
    }
    wr_pool_free(pool);
}

/* A part equals that part of the whole, if its texels are within the support; for the cavity up to rounding. */
static void parts_are_those_of_the_whole(void **state)
{
    (void)state;
    WrField *field = rough(150, 110, WR_WRAP_PERIODIC);
    const WrMapPart part = { 101, 64, 49, 46, 52 };
    for (int kind = 0; kind < WR_FIELD_MAP_COUNT; kind++) {
        Made made = made_of(field, WR_SCHEME_BSPLINE_FIT);
        made.job.reach = 13, made.job.sigma = 2.5;
        make(&made, (WrFieldMapKind)kind, NULL);
        float *out = wr_alloc(52 * 46, sizeof *out);
        WrError err = { "" };
        assert_true(wr_map_make((WrFieldMapKind)kind, &made.job, &part, NULL, out, NULL, &err));
        for (int k = 0; k < 49 * 46; k++) {
            const double whole = (double)made.out[(64 + k / 49) * 150 + 101 + k % 49];
            assert_near(out[k / 49 * 52 + k % 49], whole, kind == WR_FIELD_MAP_CAVITY ? 1e-6 : 0);
        }
        wr_free(out);
        wr_free(made.out);
    }
    wr_field_free(field);
}

/* An edit changes nothing beyond the support, and something within it. */
static void an_edit_reaches_no_farther_than_the_support(void **state)
{
    (void)state;
    enum { N = 161 };
    for (int kind = 0; kind < WR_FIELD_MAP_COUNT; kind++)
        for (int scheme = WR_SCHEME_CENTRAL; scheme < WR_SCHEME_COUNT; scheme++) {
            WrField *field = rough(N, N, WR_WRAP_PERIODIC);
            Made a = made_of(field, (WrScheme)scheme);
            a.job.reach = 9, a.job.sigma = 2, a.job.box = 7;
            a.job.ground.height = 0.004; /* roughness under 1 */
            make(&a, (WrFieldMapKind)kind, NULL);
            wr_field_set(field, 80, 80, 1.9f);
            Made b = a;
            b.out = wr_alloc(N * N, sizeof(float));
            make(&b, (WrFieldMapKind)kind, NULL);
            int far = 0;
            for (int k = 0; k < N * N; k++)
                if (a.out[k] != b.out[k])
                    far = (int)fmax(far, fmax(abs(k % N - 80), abs(k / N - 80)));
            assert_in_range(far, 1, wr_field_maps[kind].support(&a.job));
            wr_free(a.out), wr_free(b.out);
            wr_field_free(field);
        }
}

/* ---- exports ------------------------------------------------------------------------------------- */

static WrImage *exported(WrDocument *document, const char *kind, const char *const *words,
                         const char *path, WrExportReport *report)
{
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    for (; words && words[0]; words += 2)
        if (!wr_export_option(wr_export_find(kind), &options, words[0], words[1], &err))
            fail_msg("%s", err.text);
    if (!wr_export(wr_export_find(kind), document, &options, NULL, path, report, &err))
        fail_msg("%s", err.text);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static WrDocument *document_of(WrField *field)
{
    WrDocument *document = wr_document_new();
    WrScene *scene = wr_scene_clone(document->scene);
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    scene->height = 0.37;
    wr_scene_free(document->scene);
    document->scene = scene;
    return document;
}

#define WORDS(...)                                                                                 \
    (const char *const[])                                                                          \
    {                                                                                              \
        __VA_ARGS__, NULL                                                                          \
    }

static void masks_and_displacements_are_of_heights(void **state)
{
    (void)state;
    WrField *field = rough(12, 9, WR_WRAP_PERIODIC);
    WrDocument *document = document_of(field);
    WrExportReport report;
    float low, high;
    wr_field_range(field, &low, &high);
    WrImage *soft =
        exported(document, "mask", WORDS("low", "0.2", "high", "0.6", "feather", "0.25"),
                 "soft.exr", &report);
    WrImage *sharp = exported(document, "mask", NULL, "sharp.png", &report);
    WrImage *over =
        exported(document, "displacement", WORDS("ground", "lowest"), "over.exr", &report);
    WrImage *code =
        exported(document, "displacement", WORDS("ground", "0.3", "scale", "-2", "range", "signed"),
                 "code.png", &report);
    assert_int_equal(report.zero_code, 32768);
    for (int k = 0; k < 12 * 9; k++) {
        const double f = (double)wr_field_get(field, k % 12, k / 12);
        double m = f < 0.2 ? 1 - (0.2 - f) / 0.25 : f > 0.6 ? 1 - (f - 0.6) / 0.25 : 1;
        m = fmin(fmax(m, 0), 1);
        assert_near(soft->data[k], m, 1e-6);
        assert_near(sharp->data[k], f >= 0.5 * ((double)low + (double)high), 0);
        assert_near(over->data[k], 0.37 * (f - (double)low), 1e-6);
        const double back =
            (round(65535 * (double)code->data[k]) - 32768) / 32767 * report.amplitude;
        assert_near(back, -2 * (f - 0.3), 0.51 / 32767 * report.amplitude);
    }
    wr_image_free(soft), wr_image_free(sharp), wr_image_free(over), wr_image_free(code);
    wr_document_free(document);
}

static void parts_of_curvature_and_wear_are_as_defined(void **state)
{
    (void)state;
    WrDocument *document = document_of(rough(31, 22, WR_WRAP_PERIODIC));
    WrExportReport report;
    WrImage *both = exported(document, "curvature", NULL, "both.exr", &report);
    WrImage *up = exported(document, "curvature", WORDS("part", "convex"), "up.exr", &report);
    WrImage *down =
        exported(document, "curvature", WORDS("part", "concave", "full", "7"), "down.png", &report);
    assert_true(report.clipped > 0);
    WrImage *wear =
        exported(document, "wear", WORDS("full", "11", "threshold", "0.3"), "w.exr", &report);
    WrImage *usual = exported(document, "wear", WORDS("threshold", "0"), "u.exr", &report);
    WrImage *noisy = exported(document, "wear", WORDS("noise", "0.8", "full", "11", "grain", "9"),
                              "n.exr", &report);
    int whole = 0, other = 0;
    for (int k = 0; k < 31 * 22; k++) {
        const double c = (double)both->data[k], convex = fmax(c, 0);
        assert_near(up->data[k], convex, 0);
        assert_near(7 * (double)down->data[k], fmin(fmax(-c, 0), 7), 7 * 0.51 / 65535);
        assert_near(wear->data[k], fmax(0, fmin(convex / 11, 1) - 0.3) / 0.7, 1e-6);
        whole += usual->data[k] == 1.0f;
        other += noisy->data[k] != wear->data[k];
        assert_true(noisy->data[k] >= 0 && noisy->data[k] <= 1 && (c > 0 || noisy->data[k] == 0));
    }
    assert_in_range(whole, 31 * 22 / 50, 31 * 22 / 50 + 1);
    assert_true(other > 50);
    wr_image_free(both), wr_image_free(up), wr_image_free(down);
    wr_image_free(wear), wr_image_free(usual), wr_image_free(noisy);
    wr_document_free(document);
}

/* One direction equals its channel in the whole; names contain degrees. */
static void horizons_leave_one_by_one_or_together(void **state)
{
    (void)state;
    WrDocument *document = document_of(rough(17, 12, WR_WRAP_PERIODIC));
    WrExportReport report;
    wr_image_free(exported(document, "horizon", WORDS("toward", "all", "directions", "8"),
                           "all.exr", &report));
    WrImage *one = exported(document, "horizon", WORDS("toward", "146", "directions", "8"),
                            "one.exr", &report);
    WrError err = { "" };
    WrImageFile *all = wr_image_file_open("all.exr", &err);
    float *slopes = wr_alloc(17 * 12 * 8, sizeof *slopes);
    assert_non_null(all);
    assert_int_equal(wr_image_file_part(all, 0).channels, 8);
    assert_string_equal(wr_image_file_part(all, 0).channel_names[3],
                        "h03_125"); /* texels are not square */
    assert_true(wr_image_file_read(all, 0, slopes, &err));
    for (int k = 0; k < 17 * 12; k++) assert_near(one->data[k], slopes[8 * k + 3], 0);
    wr_image_file_close(all);
    wr_free(slopes);
    WrImage *code = exported(document, "horizon", WORDS("toward", "135", "directions", "8"),
                             "one.png", &report);
    for (int k = 0; k < 17 * 12; k++)
        assert_near(report.code_high * (double)code->data[k], one->data[k],
                    0.51 / 65535 * report.code_high);
    WrExportOptions options = wr_export_default();
    options.toward = -1;
    assert_false(
        wr_export(wr_export_find("horizon"), document, &options, NULL, "all.png", &report, &err));
    assert_non_null(strstr(err.text, "exr"));
    wr_image_free(one), wr_image_free(code);
    wr_document_free(document);
}

/* A formula in place of the table: its own slopes, and heights at the texels. */
static void maps_of_a_formula_are_those_of_its_table(void **state)
{
    (void)state;
    const char *const kinds[] = { "occlusion", "cavity",    "curvature",
                                  "direction", "roughness", "displacement" };
    enum { W = 120, H = 96 };
    WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < W * H; k++)
        wr_field_set(field, k % W, k / W,
                     (float)(0.5 * cos(2 * PI * 2 * (k % W + 0.5) / W) *
                             cos(2 * PI * (1 - (k / W + 0.5) / H))));
    WrDocument *table = document_of(field);
    table->scene->scheme = WR_SCHEME_BSPLINE_FIT;
    WrDocument *formula =
        document_of(wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL));
    formula->scene->analytic.kind = WR_ANALYTIC_FOURIER;
    formula->scene->analytic.count = 1;
    formula->scene->analytic.terms = wr_alloc(1, sizeof *formula->scene->analytic.terms);
    formula->scene->analytic.terms[0] = (WrAnalyticTerm){ .i = 2, .j = 1, .a = 0.5 };
    for (int n = 0; n < 6; n++) {
        WrExportReport report;
        WrImage *a = exported(table, kinds[n], NULL, "a.exr", &report);
        WrImage *b = exported(formula, kinds[n], NULL, "b.exr", &report);
        const double most = fmax(fabs(report.low), fabs(report.high));
        for (int k = 0; k < W * H; k++) {
            double off = (double)a->data[k] - (double)b->data[k];
            if (n == 3) off = remainder(off, 360);
            assert_near(off, 0, 2e-3 * most);
        }
        wr_image_free(a), wr_image_free(b);
    }
    wr_document_free(table), wr_document_free(formula);
}

static void bad_options_name_themselves(void **state)
{
    (void)state;
    const char *const bad[][4] = { { "occlusion", "directions", "12", "4, 8, 16 or 32" },
                                   { "occlusion", "reach", "0", "or all" },
                                   { "horizon", "toward", "-1", "0..360" },
                                   { "cavity", "radius", "0", "0.1..512" },
                                   { "curvature", "part", "up", "concave" },
                                   { "roughness", "box", "8", "odd" },
                                   { "displacement", "ground", "floor", "lowest" },
                                   { "mask", "feather", "-1", "0 or above" },
                                   { "wear", "threshold", "1", "0.999" } };
    for (int n = 0; n < 9; n++) {
        WrExportOptions options = wr_export_default();
        WrError err = { "" };
        assert_false(
            wr_export_option(wr_export_find(bad[n][0]), &options, bad[n][1], bad[n][2], &err));
        assert_non_null(strstr(err.text, bad[n][1]));
        assert_non_null(strstr(err.text, bad[n][2]));
        assert_non_null(strstr(err.text, bad[n][3]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_and_bends_are_the_schemes_own),
        cmocka_unit_test(curvature_of_paraboloids_is_known),
        cmocka_unit_test(roughness_of_a_sine_is_known),
        cmocka_unit_test(roughness_is_the_variance_of_a_box),
        cmocka_unit_test(a_cavity_is_what_lies_below_its_blur),
        cmocka_unit_test(moved_tables_give_moved_maps),
        cmocka_unit_test(parts_are_those_of_the_whole),
        cmocka_unit_test(an_edit_reaches_no_farther_than_the_support),
        cmocka_unit_test(masks_and_displacements_are_of_heights),
        cmocka_unit_test(parts_of_curvature_and_wear_are_as_defined),
        cmocka_unit_test(horizons_leave_one_by_one_or_together),
        cmocka_unit_test(maps_of_a_formula_are_those_of_its_table),
        cmocka_unit_test(bad_options_name_themselves),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
