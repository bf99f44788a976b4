/* test_bump_slopes.c - six-channel EXR with mip levels: slopes against forms differentiated by hand and against
   explicit stencils, levels against recomputed area means, bit-identical periodicity, and comparison with maketx
   --bumpslopes if installed. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

enum { CHANNELS = 6, LEVELS = 16 };

/* ---- writing and reading ---- */

static WrDocument *document_of(WrField *field)
{
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    return document;
}

static WrField *random_field(int width, int height, WrWrap u, WrWrap v, uint64_t seed)
{
    WrField *field = wr_field_new(width, height, u, v, 0, NULL);
    TestRandom random = { seed };
    for (int k = 0; k < width * height; k++)
        wr_field_set(field, k % width, k / width, (float)(test_random(&random) * 3.7 - 1.3));
    return field;
}

typedef struct Read {
    int count, width[LEVELS], height[LEVELS];
    float *data[LEVELS];
} Read;

static Read read_levels(const char *path)
{
    static const char *const names[] = { "b0_h",     "b1_dhds",  "b2_dhdt",
                                         "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt" };
    WrError err;
    WrImageFile *file = wr_image_file_open_levels(path, &err);
    if (!file) fail_msg("%s", err.text);
    Read read = { .count = wr_image_file_parts(file) };
    for (int k = 0; k < read.count; k++) {
        const WrImagePart part = wr_image_file_part(file, k);
        assert_int_equal(part.channels, CHANNELS);
        for (int c = 0; c < CHANNELS; c++) assert_string_equal(part.channel_names[c], names[c]);
        read.width[k] = part.width, read.height[k] = part.height;
        read.data[k] = wr_alloc((size_t)part.width * (size_t)part.height * CHANNELS, sizeof(float));
        if (!wr_image_file_read(file, k, read.data[k], &err)) fail_msg("%s", err.text);
    }
    wr_image_file_close(file);
    return read;
}

static void drop(Read *read)
{
    for (int k = 0; k < read->count; k++) wr_free(read->data[k]);
}

static Read exported(const WrDocument *document, const char *settings[][2], int count,
                     WrExportReport *report)
{
    const WrExportKind *kind = wr_export_find("bump-slopes");
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    for (int k = 0; k < count; k++)
        if (!wr_export_option(kind, &options, settings[k][0], settings[k][1], &err))
            fail_msg("%s", err.text);
    if (!wr_export(kind, document, &options, NULL, "b.exr", report, &err)) fail_msg("%s", err.text);
    return read_levels("b.exr");
}

/* ---- slopes ---- */

/* F = a cos(2 pi 3 u + 30) cos(2 pi 2 v - 45) as a formula; per texel, t down. */
static void formulas_have_their_own_slopes(void **state)
{
    (void)state;
    enum { W = 45, H = 62 };
    static const char *settings[][4][2] = {
        { { "signs", "plain" } },
        { { "signs", "renderman" } },
        { { "uvslopes", "256" } },
    };
    for (int which = 0; which < 3; which++) {
        WrDocument *document =
            document_of(wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL));
        WrScene *scene = wr_scene_clone(document->scene);
        scene->height = 17; /* ignored: heights are the table's */
        scene->analytic.kind = WR_ANALYTIC_FOURIER;
        scene->analytic.count = 1;
        scene->analytic.terms = wr_alloc(1, sizeof *scene->analytic.terms);
        scene->analytic.terms[0] =
            (WrAnalyticTerm){ .i = 3, .j = 2, .a = 0.731, .phase_u_deg = 30, .phase_v_deg = -45 };
        wr_scene_free(document->scene);
        document->scene = scene;
        Read read = exported(document, settings[which], 1, NULL);
        for (int k = 0; k < W * H; k++) {
            const double x = 6 * WR_PI * (k % W + 0.5) / W + WR_PI / 6;
            const double y = 4 * WR_PI * (1 - (k / W + 0.5) / H) - WR_PI / 4;
            const double sign = which == 1 ? -1 : 1;
            const double s = -0.731 * 6 * WR_PI * sin(x) * cos(y) * sign / (which == 2 ? 256 : W);
            const double t = 0.731 * 4 * WR_PI * cos(x) * sin(y) * sign / (which == 2 ? 256 : H);
            const float *b = read.data[0] + (size_t)k * CHANNELS;
            assert_near(b[0], 0.731 * cos(x) * cos(y), 1e-7);
            assert_near(b[1], s, 1e-7);
            assert_near(b[2], t, 1e-7);
            assert_near(b[3], s * s, 1e-7);
            assert_near(b[4], t * t, 1e-7);
            assert_near(b[5], s * t, 1e-7);
        }
        drop(&read);
        wr_document_free(document);
    }
}

/* A texel, beyond the edges too. */
static double texel(const WrField *field, int i, int j)
{
    float value;
    wr_field_read(field, i, j, 1, 1, &value, 1);
    return (double)value;
}

static double across(const WrField *f, int i, int j, bool forward)
{
    return forward ? texel(f, i + 1, j) - texel(f, i, j)
                   : (texel(f, i + 1, j) - texel(f, i - 1, j)) / 2;
}

static double down(const WrField *f, int i, int j, bool forward)
{
    return forward ? texel(f, i, j + 1) - texel(f, i, j)
                   : (texel(f, i, j + 1) - texel(f, i, j - 1)) / 2;
}

static void tables_have_the_stencils_of_their_schemes(void **state)
{
    (void)state;
    static const char *const names[] = { "nearest", "bilinear", "central", "catmull", "bspline" };
    static const WrWrap wraps[][2] = { { WR_WRAP_PERIODIC, WR_WRAP_PERIODIC },
                                       { WR_WRAP_CLAMP, WR_WRAP_PERIODIC },
                                       { WR_WRAP_PERIODIC, WR_WRAP_CLAMP },
                                       { WR_WRAP_CLAMP, WR_WRAP_CLAMP } };
    for (int k = 0; k < 20; k++) {
        const int w = k % 2 ? 37 : 270, h = k % 3 ? 21 : 2;
        const bool forward = k % 5 == 1, spline = k % 5 == 4;
        WrField *f = random_field(w, h, wraps[k / 5][0], wraps[k / 5][1], 77 + (uint64_t)k);
        WrDocument *document = document_of(f);
        const char *settings[][2] = { { "scheme", names[k % 5] } };
        Read read = exported(document, settings, 1, NULL);
        for (int n = 0; n < w * h; n++) {
            const int i = n % w, j = n / w;
            double s = across(f, i, j, forward), t = down(f, i, j, forward), at = texel(f, i, j);
            if (spline) {
                s = (across(f, i, j - 1, false) + 4 * s + across(f, i, j + 1, false)) / 6;
                t = (down(f, i - 1, j, false) + 4 * t + down(f, i + 1, j, false)) / 6;
                at = 0;
                for (int m = 0; m < 9; m++)
                    at += texel(f, i + m % 3 - 1, j + m / 3 - 1) * (m % 3 == 1 ? 4 : 1) *
                          (m / 3 == 1 ? 4 : 1) / 36;
            }
            const float *b = read.data[0] + (size_t)n * CHANNELS;
            if (!spline) assert_true(b[0] == (float)at);
            assert_near(b[0], at, 1e-6);
            assert_near(b[1], s, 1e-6);
            assert_near(b[2], t, 1e-6);
            assert_near(b[3], s * s, 4e-6);
            assert_near(b[4], t * t, 4e-6);
            assert_near(b[5], s * t, 4e-6);
        }
        drop(&read);
        wr_document_free(document);
    }
}

/* The spline through samples of a wave approximates its slopes to third order: an error of 1/8 for half the
   spacing. */
static void fitted_splines_come_near_the_wave(void **state)
{
    (void)state;
    double worst[2] = { 0, 0 };
    for (int k = 0; k < 2; k++) {
        const int n = k ? 96 : 48;
        WrField *f = wr_field_new(n, n, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        for (int m = 0; m < n * n; m++)
            wr_field_set(f, m % n, m / n, (float)(0.5 + sin(6 * WR_PI * (m % n + 0.5) / n + 0.3)));
        WrDocument *document = document_of(f);
        const char *settings[][2] = { { "scheme", "bspline-fit" }, { "uvslopes", "1" } };
        Read read = exported(document, settings, 2, NULL);
        for (int m = 0; m < n * n; m++) {
            const double s = 6 * WR_PI * cos(6 * WR_PI * (m % n + 0.5) / n + 0.3);
            const float *b = read.data[0] + (size_t)m * CHANNELS;
            assert_true(b[0] == wr_field_get(f, m % n, m / n));
            worst[k] = fmax(worst[k], fabs((double)b[1] - s));
            assert_near(b[2], 0, 1e-9);
        }
        drop(&read);
        wr_document_free(document);
    }
    if (!(worst[0] < 0.02 && worst[1] < worst[0] / 4)) fail_msg("%g %g", worst[0], worst[1]);
}

/* ---- levels ---- */

static double overlap(double a, double b, double c, double d)
{
    return fmax(0.0, fmin(b, d) - fmax(a, c));
}

/* The mean over the area of texel (i, j) of level k in the level below. */
static double covered_mean(const Read *read, int k, int i, int j, int c)
{
    const int n = read->width[k - 1], rows = read->height[k - 1];
    const double x = (double)n / read->width[k], y = (double)rows / read->height[k];
    double sum = 0;
    for (int b = (int)(j * y); b < rows && b < (j + 1) * y; b++)
        for (int a = (int)(i * x); a < n && a < (i + 1) * x; a++)
            sum +=
                overlap(a, a + 1, i * x, (i + 1) * x) * overlap(b, b + 1, j * y, (j + 1) * y) *
                (double)
                    read->data[k - 1][((size_t)b * (size_t)n + (size_t)a) * CHANNELS + (size_t)c];
    return sum / (x * y);
}

static double mean_of(const Read *read, int k, int c)
{
    double sum = 0;
    const size_t count = (size_t)read->width[k] * (size_t)read->height[k];
    for (size_t m = 0; m < count; m++) sum += (double)read->data[k][m * CHANNELS + (size_t)c];
    return sum / (double)count;
}

static void levels_are_means_down_to_one_texel(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 64, 32 }, { 45, 62 }, { 129, 7 }, { 1, 19 }, { 1, 1 } };
    for (int which = 0; which < 5; which++) {
        const int w = sizes[which][0], h = sizes[which][1];
        WrDocument *document =
            document_of(random_field(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 5));
        Read read = exported(document, NULL, 0, NULL);
        assert_true(read.width[0] == w && read.height[0] == h);
        assert_true(read.width[read.count - 1] == 1 && read.height[read.count - 1] == 1);
        for (int k = 1; k < read.count; k++) {
            assert_int_equal(read.width[k], w >> k ? w >> k : 1);
            assert_int_equal(read.height[k], h >> k ? h >> k : 1);
            for (int m = 0; m < read.width[k] * read.height[k]; m++) {
                const float *b = read.data[k] + (size_t)m * CHANNELS;
                for (int c = 0; c < CHANNELS; c++)
                    assert_near(b[c],
                                covered_mean(&read, k, m % read.width[k], m / read.width[k], c),
                                1e-6);
                assert_true(b[3] >= b[1] * b[1] - 1e-6f && b[4] >= b[2] * b[2] - 1e-6f);
            }
            for (int c = 0; c < CHANNELS; c++)
                assert_near(mean_of(&read, k, c), mean_of(&read, 0, c), 1e-6);
        }
        drop(&read);
        wr_document_free(document);
    }
}

/* Rolled tables give rolled maps: level 0 by any step, level k where the step is a multiple of 2^k. */
static void shifted_tables_give_shifted_maps(void **state)
{
    (void)state;
    enum { W = 128, H = 64 };
    static const char *const schemes[] = { "central", "bilinear", "bspline", "bspline-fit" };
    for (int which = 0; which < 4; which++) {
        const int right = which % 2 ? 24 : 37, under = which % 2 ? 8 : 19;
        WrField *f = random_field(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 9);
        WrField *g = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        for (int m = 0; m < W * H; m++)
            wr_field_set(g, (m % W + right) % W, (m / W + under) % H,
                         wr_field_get(f, m % W, m / W));
        WrDocument *one = document_of(f), *two = document_of(g);
        const char *settings[][2] = { { "scheme", schemes[which] } };
        Read a = exported(one, settings, 1, NULL), b = exported(two, settings, 1, NULL);
        for (int k = 0; k <= (which % 2 ? 3 : 0); k++) {
            const int w = W >> k, h = H >> k;
            for (int m = 0; m < w * h; m++) {
                const int i = (m % w + (right >> k)) % w, j = (m / w + (under >> k)) % h;
                assert_memory_equal(a.data[k] + (size_t)m * CHANNELS,
                                    b.data[k] + ((size_t)j * (size_t)w + (size_t)i) * CHANNELS,
                                    CHANNELS * sizeof(float));
            }
        }
        drop(&a), drop(&b);
        wr_document_free(one);
        wr_document_free(two);
    }
}

/* ---- the file ---- */

static uint64_t number_at(const unsigned char *bytes, int count)
{
    uint64_t value = 0;
    for (int i = 0; i < count; i++) value |= (uint64_t)bytes[i] << 8 * i;
    return value;
}

/* After the attributes (name, type, length and bytes each), and a 0. */
static const unsigned char *behind_header(const unsigned char *at)
{
    at += 8;
    while (*at) {
        at += strlen((const char *)at) + 1;
        at += strlen((const char *)at) + 1;
        at += 4 + number_at(at, 4);
    }
    return at + 1;
}

/* Readers that do not search a file need the tile table, which the library writes last. */
static void every_tile_lies_where_the_table_says(void **state)
{
    (void)state;
    enum { W = 150, H = 70 };
    WrDocument *document = document_of(random_field(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 8));
    Read read = exported(document, NULL, 0, NULL);
    size_t size;
    char *file;
    WrError err;
    if (!wr_file_read("b.exr", 1 << 24, &file, &size, &err)) fail_msg("%s", err.text);
    const unsigned char *bytes = (unsigned char *)file, *table = behind_header(bytes);
    int count = 0;
    for (int k = 0; k < read.count; k++)
        for (int y = 0; y < read.height[k]; y += 64)
            for (int x = 0; x < read.width[k]; x += 64, count++) {
                const uint64_t place = number_at(table + 8 * count, 8);
                assert_in_range(place, 1, size - 20);
                assert_int_equal(number_at(bytes + place, 4), x / 64);
                assert_int_equal(number_at(bytes + place + 4, 4), y / 64);
                assert_int_equal(number_at(bytes + place + 8, 4), k);
                assert_int_equal(number_at(bytes + place + 12, 4), k);
            }
    assert_int_equal(number_at(table, 8), table + 8 * count - bytes);
    wr_free(file);
    drop(&read);
    wr_document_free(document);
}

/* ---- hard cases (HC142) ---- */

static void cliffs_stay_finite(void **state)
{
    (void)state;
    WrField *f = random_field(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 3);
    for (int k = 0; k < 16; k++) wr_field_set(f, k, 5, k % 2 ? 3e38f : -1e20f);
    WrDocument *document = document_of(f);
    WrExportReport report;
    Read read = exported(document, NULL, 0, &report);
    assert_true(report.replaced > 0);
    for (int k = 0; k < read.count; k++)
        for (int m = 0; m < read.width[k] * read.height[k]; m++) {
            const float *b = read.data[k] + (size_t)m * CHANNELS;
            for (int c = 0; c < CHANNELS; c++) assert_true(isfinite(b[c]));
            assert_true((double)b[3] >= (double)b[1] * (double)b[1] * (1 - 1e-6));
            assert_true((double)b[4] >= (double)b[2] * (double)b[2] * (1 - 1e-6));
        }
    drop(&read);
    wr_document_free(document);
}

static void halves_are_rounded_or_refused(void **state)
{
    (void)state;
    WrDocument *document = document_of(random_field(45, 30, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 3));
    const char *settings[][2] = { { "depth", "16" } };
    Read full = exported(document, NULL, 0, NULL);
    Read read = exported(document, settings, 1, NULL);
    for (int k = 0; k < read.count; k++)
        for (int m = 0; m < read.width[k] * read.height[k] * CHANNELS; m++)
            assert_near(read.data[k][m], full.data[k][m],
                        fabsf(full.data[k][m]) * 0x1p-11f + 0x1p-25f);
    drop(&full), drop(&read);
    wr_field_set(document->layers[0].heights, 7, 11, 70000);
    WrError err = { "" };
    WrExportOptions options = wr_export_default();
    options.depth = 16;
    unlink("b.exr");
    assert_false(
        wr_export(wr_export_find("bump-slopes"), document, &options, NULL, "b.exr", NULL, &err));
    if (!strstr(err.text, "65504")) fail_msg("%s", err.text);
    assert_int_equal(access("b.exr", F_OK), -1);
    wr_document_free(document);
}

static void a_full_disk_leaves_nothing_half_written(void **state)
{
    (void)state;
    WrDocument *document =
        document_of(random_field(300, 300, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1));
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    small = old;
    small.rlim_cur = 50000;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    WrError err = { "" };
    const WrExportOptions options = wr_export_default();
    setrlimit(RLIMIT_FSIZE, &small);
    const bool good =
        wr_export(wr_export_find("bump-slopes"), document, &options, NULL, "full.exr", NULL, &err);
    setrlimit(RLIMIT_FSIZE, &old);
    signal(SIGXFSZ, handler);
    assert_false(good);
    if (!strstr(err.text, "cannot be written")) fail_msg("%s", err.text);
    assert_int_equal(system("ls -A | grep -q full"), 256);
    wr_document_free(document);
}

/* ---- another program ---- */

/* maketx uses Sobel's mean across, which for f(u) + g(v) is the central difference; at the border it repeats the edge
 * texel, where ours wraps: there its slope is half of a one-sided difference. */
static void maketx_agrees_inside_and_not_at_the_border(void **state)
{
    (void)state;
    enum { W = 64, H = 32 };
    if (system("maketx --help 2>&1 | grep -q -e --bumpslopes") != 0) skip();
    WrField *f = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int m = 0; m < W * H; m++)
        wr_field_set(
            f, m % W, m / W,
            (float)(sin(2 * WR_PI * (m % W) / W + 0.4) + 0.3 * sin(4 * WR_PI * (m / W) / H)));
    WrDocument *document = document_of(f);
    const WrExportOptions options = wr_export_default();
    WrError err = { "" };
    if (!wr_export(wr_export_find("height"), document, &options, NULL, "h.exr", NULL, &err))
        fail_msg("%s", err.text);
    assert_int_equal(system("maketx --bumpslopes --wrap periodic h.exr -o m.exr >/dev/null"), 0);
    Read ours = exported(document, NULL, 0, NULL), theirs = read_levels("m.exr");
    assert_int_equal(ours.count, theirs.count);
    double border = 0, steepest = 0;
    for (int k = 0; k < ours.count; k++)
        for (int m = 0; m < ours.width[k] * ours.height[k]; m++) {
            const int w = ours.width[k], h = ours.height[k], i = m % w, j = m / w;
            const float *a = ours.data[k] + (size_t)m * CHANNELS;
            const float *b = theirs.data[k] + (size_t)m * CHANNELS;
            assert_true(w == theirs.width[k] && h == theirs.height[k]);
            assert_near(a[0], b[0], 1e-6);
            if (i > 0 && i < w - 1 && j > 0 && j < h - 1)
                for (int c = 1; c < CHANNELS; c++) assert_near(a[c], b[c], 1e-6);
            if (k > 0 || j == 0 || j == h - 1) continue;
            steepest = fmax(steepest, fabs((double)a[1]));
            if (i == 0) {
                const double half = (double)(wr_field_get(f, 1, j) - wr_field_get(f, 0, j)) / 2;
                assert_near(b[1], half, 1e-6);
                border = fmax(border, fabs((double)a[1] - half));
            }
        }
    assert_true(border > 0.4 * steepest);
    drop(&ours), drop(&theirs);
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formulas_have_their_own_slopes),
        cmocka_unit_test(tables_have_the_stencils_of_their_schemes),
        cmocka_unit_test(fitted_splines_come_near_the_wave),
        cmocka_unit_test(levels_are_means_down_to_one_texel),
        cmocka_unit_test(shifted_tables_give_shifted_maps),
        cmocka_unit_test(every_tile_lies_where_the_table_says),
        cmocka_unit_test(cliffs_stay_finite),
        cmocka_unit_test(halves_are_rounded_or_refused),
        cmocka_unit_test(a_full_disk_leaves_nothing_half_written),
        cmocka_unit_test(maketx_agrees_inside_and_not_at_the_border),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
