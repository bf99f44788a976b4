/* The report of an export after its read-back. */
#include "test.h"
#include "test_folder.h"

#include <sys/resource.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "export/export.h"
#include "export/job.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

static WrDocument *random_document(void)
{
    TestRandom random = { 77 };
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(61, 139, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < 139; j++)
        for (int i = 0; i < 61; i++)
            wr_field_set(field, i, j, (float)(0.03 + 0.17 * test_random(&random)));
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    return document;
}

static WrExportReport export_good(const WrDocument *document, const WrExportKind *kind,
                                  const WrExportOptions *options, const char *path)
{
    WrExportReport report;
    WrError err = { "" };
    if (!wr_export(kind, document, options, NULL, path, &report, &err)) fail_msg("%s", err.text);
    assert_true(report.seen);
    return report;
}

static WrImage *read_file(const char *path)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

/* The largest error of the file's heights, from its own range, computed independently of the program. */
static void heights_of(const WrDocument *document, WrExportOptions options, const char *path)
{
    WrExportReport report = export_good(document, wr_export_find("height"), &options, path);
    WrImage *image = read_file(path);
    const WrField *field = document->layers[0].heights;
    double worst = 0.0, last = wr_pixel_type_max(image->type);
    for (int j = 0; j < 139; j++)
        for (int i = 0; i < 61; i++) {
            double f = (double)image->data[j * 61 + i], g = wr_field_get(field, i, j);
            if (last > 0)
                f = report.code_low + round(f * last) / last * (report.code_high - report.code_low);
            g = options.range == WR_EXPORT_RANGE_GIVEN ? fmin(fmax(g, options.low), options.high)
                                                       : g;
            worst = fmax(worst, fabs(f - g));
        }
    assert_near(report.worst, worst, 1e-7 * (worst + 1e-6) + 1e-9);
    if (last > 0) assert_true(worst > 0.3 * (report.code_high - report.code_low) / last);
    wr_image_free(image);
}

static void the_largest_error_of_heights_is_that_of_the_file(void **state)
{
    (void)state;
    WrDocument *document = random_document();
    WrExportOptions options = wr_export_default();
    heights_of(document, options, "float.exr");
    heights_of(document, options, "auto.png");
    options.depth = 8;
    heights_of(document, options, "eight.png");
    options.dither = true;
    heights_of(document, options, "dither.png");
    options.range = WR_EXPORT_RANGE_SIGNED;
    heights_of(document, options, "dithered-signed.png");
    options.dither = false;
    options.depth = 16;
    heights_of(document, options, "signed.png");
    options.range = WR_EXPORT_RANGE_GIVEN;
    options.low = 0.0621;
    options.high = 0.1873;
    heights_of(document, options, "given.png");
    wr_document_free(document);
}

static void direction(const WrImage *image, int i, double n[3])
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        n[c] = 2.0 * (double)image->data[3 * i + c] - 1.0;
        sum += n[c] * n[c];
    }
    for (int c = 0; c < 3; c++) n[c] /= sqrt(sum);
}

static void the_largest_error_of_normals_is_an_angle(void **state)
{
    (void)state;
    WrDocument *document = random_document();
    WrExportOptions options = wr_export_default();
    const WrExportKind *kind = wr_export_find("normal-y");
    options.cell_w = 1.7;
    assert_near(export_good(document, kind, &options, "n.exr").worst, 0.0, 0.0);
    options.depth = 8;
    WrExportReport report = export_good(document, kind, &options, "n.png");
    WrImage *floats = read_file("n.exr"), *codes = read_file("n.png");
    double worst = 0.0;
    for (int i = 0; i < 61 * 139; i++) {
        double a[3], b[3], chord = 0.0;
        direction(floats, i, a);
        direction(codes, i, b);
        for (int c = 0; c < 3; c++) chord += (a[c] - b[c]) * (a[c] - b[c]);
        worst = fmax(worst, 2.0 * asin(sqrt(chord) / 2.0) * 180.0 / acos(-1.0));
    }
    assert_near(report.worst, worst, 1e-4);
    assert_true(worst > 0.1 && worst < 0.4);
    wr_image_free(floats);
    wr_image_free(codes);
    wr_document_free(document);
}

/* A kind of export with one value wrong by `wrong` codes. */
static int wrong;
static void wrong_rows(WrExportJob *job, int y, int rows, void *out)
{
    bool normals = job->kind->green != 0.0;
    wr_export_find(normals ? "normal+y" : "height")->rows(job, y, rows, out);
    if (job->options.depth == 8 && y <= 100 && 100 < y + rows) {
        uint8_t *code = (uint8_t *)out + (100 - y) * job->width * job->kind->channels + 7;
        *code = (uint8_t)(*code < 128 ? *code + wrong : *code - wrong);
    }
}

static void wrong_codes_are_noticed(const char *name)
{
    static const char old[] = "the old file";
    WrDocument *document = random_document();
    WrExportKind kind = *wr_export_find(name);
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    char *bytes;
    size_t length;
    kind.rows = wrong_rows;
    options.depth = 8;
    wrong = 0;
    assert_true(wr_export(&kind, document, &options, NULL, "w.png", NULL, &err));
    wrong = 1;
    assert_true(wr_file_write("w.png", old, sizeof old, &err));
    assert_false(wr_export(&kind, document, &options, NULL, "w.png", NULL, &err));
    assert_non_null(strstr(err.text, "row 100 differs by"));
    assert_non_null(strstr(err.text, "w.png"));
    assert_true(wr_file_read("w.png", 4096, &bytes, &length, &err));
    assert_int_equal(length, sizeof old);
    assert_string_equal(bytes, old);
    wr_free(bytes);
    wr_document_free(document);
}

static void codes_beyond_their_bound_are_errors_and_leave_the_old_file(void **state)
{
    (void)state;
    wrong_codes_are_noticed("height");
    wrong_codes_are_noticed("normal+y");
}

static void every_kind_is_read_back_within_its_bound(void **state)
{
    (void)state;
    WrDocument *document = random_document();
    WrScene *scene = wr_scene_clone(document->scene);
    wr_scene_free(document->scene);
    document->scene = scene;
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++) {
        const WrExportKind *kind = &wr_export_kinds[i];
        WrExportOptions options = wr_export_default();
        options.feather = 0.7; /* a mask of 0 and 1 would be exact */
        if (kind->write) continue;
        if (kind->on_surface && kind->make) wr_shape_default(WR_SURFACE_mesh, &scene->shape);
        assert_near(export_good(document, kind, &options, "k.exr").worst, 0.0, 0.0);
        for (options.depth = 8; !kind->floats && options.depth <= 16; options.depth += 8) {
            options.dither = options.depth == 8;
            assert_true(export_good(document, kind, &options, "k.png").worst > 0.0);
        }
    }
    wr_document_free(document);
}

static void the_sentence_tells_what_was_seen(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrExportReport report = { .width = 8, .height = 4, .channels = 3, .depth = 16 };
    report.convention = "+Y (green up)";
    report.seen = true;
    report.worst = 0.00123;
    report.seam.u.order = report.seam.v.order = 2;
    report.seam.pattern.u.order = report.seam.pattern.v.order = 2;
    wr_export_report_text(&report, &text);
    assert_string_equal(wr_text_get(&text), "8x4, 16 bits, +Y (green up); read back: wrong by at "
                                            "most 0.00123 degrees; seam C2");
    wr_text_fini(&text);
}

/* The reader process transfers 64 rows at a time, twice, and the limit on file sizes applies to these too: 2 x 64 x
   515 x 4 bytes here. The flat file is smaller. */
static void what_was_not_compared_is_said(void **state)
{
    (void)state;
    struct rlimit old, small;
    WrError err = { "" };
    WrExportReport report;
    WrText text = { 0 };
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(515, 70, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.3f, NULL);
    WrExportOptions options = wr_export_default();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small = (struct rlimit){ 260000, old.rlim_max };
    for (int limited = 0; limited < 2; limited++) {
        if (limited) setrlimit(RLIMIT_FSIZE, &small);
        bool good = wr_export(wr_export_find("height"), document, &options, NULL, "flat.png",
                              &report, &err);
        setrlimit(RLIMIT_FSIZE, &old);
        if (!good) fail_msg("%s", err.text);
        assert_true(report.seen == !limited && report.unseen == limited);
        wr_text_clear(&text);
        wr_export_report_text(&report, &text);
        char *said = strstr(text.data, "; read back"), *seam = strstr(text.data, "; seam C2");
        assert_non_null(seam);
        *seam = '\0';
        assert_string_equal(said, limited ? "; read back whole, but not compared with the table: a "
                                            "limit on file sizes (ulimit -f) leaves no room for "
                                            "its rows"
                                          : "; read back: exact");
    }
    wr_text_fini(&text);
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_largest_error_of_heights_is_that_of_the_file),
        cmocka_unit_test(the_largest_error_of_normals_is_an_angle),
        cmocka_unit_test(codes_beyond_their_bound_are_errors_and_leave_the_old_file),
        cmocka_unit_test(every_kind_is_read_back_within_its_bound),
        cmocka_unit_test(the_sentence_tells_what_was_seen),
        cmocka_unit_test(what_was_not_compared_is_said),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
