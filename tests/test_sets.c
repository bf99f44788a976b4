/* Sets of maps for other programs: names, formats, conventions, and that all files come or none. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "export/export.h"
#include "export/sets.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "system/path.h"

static WrDocument *bump_document(void)
{
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(37, 53, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < 53; j++)
        for (int i = 0; i < 37; i++)
            wr_field_set(field, i, j,
                         (float)exp(-((i - 18) * (i - 18) + (j - 26) * (j - 26)) / 50.0));
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    return document;
}

static bool write_set(const char *name, const char *const *words, int count, WrError *err)
{
    WrDocument *document = bump_document();
    WrText told = { 0 };
    WrSetOrder order = { wr_export_set_find(name), ".", "clay", words, count };
    bool good = wr_export_set(&order, document, NULL, &told, err);
    wr_text_fini(&told);
    wr_document_free(document);
    return good;
}

static void every_set_has_the_names_and_formats_of_its_program(void **state)
{
    (void)state;
    const struct {
        const char *set, *file;
        WrPixelType type;
        int channels, green; /* of the flank above the bump: 1 bright, -1 dark */
    } known[] = {
        { "blender", "clay_displacement.exr", WR_PIXEL_F32, 1, 0 },
        { "blender", "clay_normal.png", WR_PIXEL_U16, 3, 1 },
        { "gltf", "clay_normal.png", WR_PIXEL_U8, 3, 1 },
        { "unreal", "T_clay_N.png", WR_PIXEL_U8, 3, -1 },
        { "unreal", "T_clay_H.png", WR_PIXEL_U16, 1, 0 },
        { "unity", "clay_Normal.png", WR_PIXEL_U8, 3, 1 },
        { "unity", "clay_Height.png", WR_PIXEL_U16, 1, 0 },
        { "godot", "clay_normal.png", WR_PIXEL_U8, 3, 1 },
        { "godot", "clay_height.png", WR_PIXEL_U8, 1, 0 },
        { "substance", "clay_Height.png", WR_PIXEL_U16, 1, 0 },
        { "substance", "clay_Normal.png", WR_PIXEL_U16, 3, -1 },
        { "renderman", "clay_disp.exr", WR_PIXEL_F32, 1, 0 },
        { "arnold", "clay_disp.exr", WR_PIXEL_F32, 1, 0 },
        { "arnold", "clay_normal.exr", WR_PIXEL_F32, 3, 1 },
        { "povray", "clay_hf.png", WR_PIXEL_U16, 1, 0 },
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        WrError err = { "" };
        if (!write_set(known[i].set, NULL, 0, &err)) fail_msg("%s", err.text);
        WrImage *image = wr_image_read(known[i].file, &err);
        if (!image) fail_msg("%s: %s", known[i].set, err.text);
        assert_int_equal(image->type, known[i].type);
        assert_int_equal(image->channels, known[i].channels);
        if (known[i].green) {
            float green = image->data[(20 * 37 + 18) * 3 + 1];
            assert_true(known[i].green > 0 ? green > 0.52f : green < 0.48f);
        }
        wr_image_free(image);
        assert_true(wr_path_remove(known[i].file));
    }
}

static void assert_holds(const char *path, const char *text)
{
    char *bytes;
    size_t length;
    WrError err = { "" };
    if (!wr_file_read(path, 1 << 20, &bytes, &length, &err)) fail_msg("%s", err.text);
    assert_string_equal(bytes, text);
    wr_free(bytes);
}

static void count_left(int *count)
{
    WrFolder *folder = wr_folder_open(".");
    const char *name;
    *count = 0;
    while ((name = wr_folder_next(folder))) *count += strncmp(name, ".wrinkle-set", 12) == 0;
    wr_folder_close(folder);
}

/* The second file's place is taken by a folder. */
static void all_files_of_a_set_are_replaced_or_none(void **state)
{
    (void)state;
    WrError err = { "" };
    int left;
    wr_path_remove("T_clay_N.png");
    wr_path_remove("T_clay_H.png");
    assert_true(wr_file_write("T_clay_N.png", "old", 3, &err));
    assert_true(wr_folder_make("T_clay_H.png", WR_FOLDER_FOR_ALL));
    assert_false(write_set("unreal", NULL, 0, &err));
    assert_non_null(strstr(err.text, "T_clay_H.png: cannot be written"));
    assert_holds("T_clay_N.png", "old");
    assert_true(wr_path_remove("T_clay_N.png"));
    assert_false(write_set("unreal", NULL, 0, &err));
    assert_false(wr_path_is_there("T_clay_N.png"));
    assert_true(wr_folder_remove("T_clay_H.png"));
    assert_true(write_set("unreal", NULL, 0, &err));
    assert_true(wr_path_is_file("T_clay_N.png") && wr_path_is_file("T_clay_H.png"));
    count_left(&left);
    assert_int_equal(left, 0);
}

static void words_go_to_the_maps_that_have_them(void **state)
{
    (void)state;
    static const char *const cell[] = { "cell=2,1", "range=signed" }, *const none[] = { "pen=2" },
                             *const bad[] = { "cell=0,1" };
    WrError err = { "" };
    if (!write_set("unity", cell, 2, &err)) fail_msg("%s", err.text);
    assert_false(write_set("unity", none, 1, &err));
    assert_non_null(strstr(err.text, "pen=2: no map of the set unity"));
    assert_false(write_set("unity", bad, 1, &err));
    assert_non_null(strstr(err.text, "cell '0,1'"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_set_has_the_names_and_formats_of_its_program),
        cmocka_unit_test(all_files_of_a_set_are_replaced_or_none),
        cmocka_unit_test(words_go_to_the_maps_that_have_them),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
