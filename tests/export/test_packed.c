/* Packed maps: each channel equals the separately exported map of that name, in 0..1; the material's numbers; sets
   with such files. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/memory.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

#define WIDE 37
#define HIGH 53

static WrDocument *rough_document(void)
{
    uint32_t seed = 71;
    WrDocument *document = wr_document_new();
    WrScene *scene = wr_scene_clone(document->scene);
    WrField *field = wr_field_new(WIDE, HIGH, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0.0f, NULL);
    for (int k = 0; k < WIDE * HIGH; k++) {
        seed = seed * 1664525u + 1013904223u;
        wr_field_set(field, k % WIDE, k / WIDE, (float)(seed / 4294967296.0 * 1.3 - 0.4));
    }
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    scene->height = 0.07;
    scene->material.model = WR_REFLECT_GGX;
    scene->material.metalness = 0.3;
    scene->material.roughness = 0.45;
    wr_scene_free(document->scene);
    document->scene = scene;
    return document;
}

#define WORDS(...) ((const char *const[]){ __VA_ARGS__, NULL })

static WrImage *exported(const WrDocument *document, const char *kind, const char *const *words,
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

/* The map alone as floats, scaled to 0..1 by its kind. */
static void assert_channel(const WrDocument *document, const WrImage *packed, int c,
                           const char *kind, double low, double high, double bound)
{
    WrExportReport report;
    WrImage *alone = exported(document, kind, NULL, "alone.exr", &report);
    if (isnan(low)) low = report.low, high = report.high;
    for (int i = 0; i < WIDE * HIGH; i++) {
        const double x = ((double)alone->data[i] - low) / (high - low);
        const double got = (double)packed->data[i * packed->channels + c];
        if (!(fabs(got - x) <= bound)) fail_msg("%s at %d: %g, not %g", kind, i, got, x);
    }
    wr_image_free(alone);
}

static void each_channel_is_the_map_of_its_name(void **state)
{
    (void)state;
    WrDocument *document = rough_document();
    WrExportReport report;
    WrImage *image = exported(
        document, "packed",
        WORDS("red", "height", "green", "cavity", "blue", "mask", "alpha", "wear"), "p.exr", NULL);
    assert_int_equal(image->channels, 4);
    assert_channel(document, image, 0, "displacement", NAN, NAN, 1e-6);
    WrImage *cavity = exported(document, "cavity", NULL, "c.exr", &report);
    assert_channel(document, image, 1, "cavity", report.low, 0, 1e-6);
    assert_channel(document, image, 2, "mask", 0, 1, 1e-6);
    assert_channel(document, image, 3, "wear", 0, 1, 1e-6);
    wr_image_free(cavity);
    wr_image_free(image);
    image =
        exported(document, "packed", WORDS("blue", "curvature", "alpha", "0.25"), "p.exr", NULL);
    WrImage *curvature = exported(document, "curvature", NULL, "c.exr", &report);
    const double full = fmax(-report.low, report.high);
    assert_channel(document, image, 0, "occlusion", 0, 1, 1e-6);
    assert_channel(document, image, 1, "roughness", 0, 1, 1e-6);
    assert_channel(document, image, 2, "curvature", -full, full, 1e-6);
    for (int i = 0; i < WIDE * HIGH; i++) assert_near(image->data[4 * i + 3], 0.25, 0);
    wr_image_free(curvature);
    wr_image_free(image);
    wr_document_free(document);
}

/* 8-bit codes, alpha too: no channel is multiplied by it. Half a code of error each. */
static void codes_are_rounded_and_alpha_is_a_channel_like_others(void **state)
{
    (void)state;
    static const char *const files[] = { "p.png", "p.tif", "p.tga" };
    WrDocument *document = rough_document();
    for (int k = 0; k < 3; k++) {
        WrExportReport report;
        WrImage *image = exported(document, "packed",
                                  WORDS("depth", "8", "red", "metalness", "green", "occlusion",
                                        "blue", "1", "alpha", "smoothness"),
                                  files[k], &report);
        assert_int_equal(image->channels, 4);
        assert_int_equal(image->type, WR_PIXEL_U8);
        assert_true(report.seen && report.worst > 0 && report.worst <= 0.5 / 255 + 1e-4);
        assert_channel(document, image, 1, "occlusion", 0, 1, 0.5 / 255 + 1e-6);
        assert_channel(document, image, 3, "roughness", 1, 0, 0.5 / 255 + 1e-6);
        for (int i = 0; i < WIDE * HIGH; i++) {
            assert_near(image->data[4 * i], 77 / 255.0, 1e-6); /* 0.3 */
            assert_near(image->data[4 * i + 2], 1, 0);
        }
        wr_image_free(image);
    }
    wr_document_free(document);
}

/* Where the table is level, roughness is the material's: the facets' own; for shininess s the alpha with s = 2 /
 * alpha^2 - 2, which is 0.2182 for 40. */
static void a_level_table_is_as_rough_as_its_material(void **state)
{
    (void)state;
    WrDocument *document = rough_document();
    WrScene *scene = wr_scene_clone(document->scene);
    wr_field_fill(document->layers[0].heights, 0.3f);
    WrImage *image = exported(document, "packed", WORDS("base", "material"), "p.exr", NULL);
    assert_near(image->data[0], 1, 1e-6);
    assert_near(image->data[1], 0.45, 1e-6);
    assert_near(image->data[2], 0.3, 1e-6);
    wr_image_free(image);
    scene->material.model = WR_REFLECT_BLINN_PHONG;
    scene->material.shininess = 40;
    wr_scene_free(document->scene);
    document->scene = scene;
    image = exported(document, "packed", WORDS("base", "material"), "p.exr", NULL);
    assert_near(image->data[1], sqrt(0.218217890), 1e-6);
    assert_near(image->data[2], 0, 0); /* a model without metals */
    wr_image_free(image);
    wr_document_free(document);
}

static void what_no_channel_can_hold_is_refused(void **state)
{
    (void)state;
    WrExportOptions options = wr_export_default();
    const WrExportKind *kind = wr_export_find("packed");
    static const char *const bad[] = { "normal+y", "1.001", "-0.1", "", "nan" };
    for (int i = 0; i < 5; i++) {
        WrError err = { "" };
        assert_false(wr_export_option(kind, &options, "green", bad[i], &err));
        assert_non_null(strstr(err.text, "green '"));
        assert_non_null(strstr(err.text, "must be one of occlusion, roughness"));
    }
    WrError err = { "" };
    assert_false(wr_export_option(kind, &options, "base", "stone", &err));
    assert_non_null(strstr(err.text, "or material"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_channel_is_the_map_of_its_name),
        cmocka_unit_test(codes_are_rounded_and_alpha_is_a_channel_like_others),
        cmocka_unit_test(a_level_table_is_as_rough_as_its_material),
        cmocka_unit_test(what_no_channel_can_hold_is_refused),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
