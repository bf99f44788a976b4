/* Sets of maps for other programs: names, formats, conventions, and atomic writing of all files. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "export/export.h"
#include "export/map_sets.h"
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
    WrMapSet *set = wr_map_set_find(name, err);
    WrMapSetRequest order = { set, ".", "clay", words, count, NULL };
    bool good = set && wr_export_map_set(&order, document, NULL, &told, err);
    wr_map_set_free(set);
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
        int channels, green; /* on the side above the bump: 1 bright, -1 dark */
    } known[] = {
        { "blender", "clay_displacement.exr", WR_PIXEL_F32, 1, 0 },
        { "blender", "clay_normal.png", WR_PIXEL_U16, 3, 1 },
        { "blender", "clay_ao.png", WR_PIXEL_U8, 1, 0 },
        { "blender", "clay_roughness.png", WR_PIXEL_U8, 1, 0 },
        { "gltf", "clay_normal.png", WR_PIXEL_U8, 3, 1 },
        { "gltf", "clay_occlusionRoughnessMetallic.png", WR_PIXEL_U8, 3, 0 },
        { "unreal", "T_clay_N.png", WR_PIXEL_U8, 3, -1 },
        { "unreal", "T_clay_H.png", WR_PIXEL_U16, 1, 0 },
        { "unreal", "T_clay_ORM.png", WR_PIXEL_U8, 3, 0 },
        { "unity", "clay_Normal.png", WR_PIXEL_U8, 3, 1 },
        { "unity", "clay_MaskMap.png", WR_PIXEL_U8, 4, 0 },
        { "unity", "clay_Height.png", WR_PIXEL_U16, 1, 0 },
        { "godot", "clay_normal.png", WR_PIXEL_U8, 3, 1 },
        { "godot", "clay_height.png", WR_PIXEL_U8, 1, 0 },
        { "godot", "clay_ao.png", WR_PIXEL_U8, 1, 0 },
        { "godot", "clay_roughness.png", WR_PIXEL_U8, 1, 0 },
        { "substance", "clay_Height.png", WR_PIXEL_U16, 1, 0 },
        { "substance", "clay_AmbientOcclusion.png", WR_PIXEL_U16, 1, 0 },
        { "substance", "clay_Roughness.png", WR_PIXEL_U16, 1, 0 },
        { "substance", "clay_Normal.png", WR_PIXEL_U16, 3, -1 },
        { "substance", "clay_Curvature.png", WR_PIXEL_U16, 1, 0 },
        { "renderman", "clay_disp.exr", WR_PIXEL_F32, 1, 0 },
        { "arnold", "clay_disp.exr", WR_PIXEL_F32, 1, 0 },
        { "arnold", "clay_normal.exr", WR_PIXEL_F32, 3, 1 },
        { "arnold", "clay_ao.exr", WR_PIXEL_F32, 1, 0 },
        { "arnold", "clay_roughness.exr", WR_PIXEL_F32, 1, 0 },
        { "povray", "clay_hf.png", WR_PIXEL_U16, 1, 0 },
        { "blender-live", "clay_displacement.exr", WR_PIXEL_F32, 1, 0 },
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

/* At the foot of the bump, which is darker than the surroundings: occlusion in red, in Unity's in green, whose alpha
 * is smoothness; the material's shininess of 40 is a roughness of 0.467. */
static void packed_maps_have_their_channels_where_programs_look(void **state)
{
    (void)state;
    static const struct {
        const char *set, *file;
        int channels, occlusion, metal, rough, full;
    } known[] = { { "gltf", "clay_occlusionRoughnessMetallic.png", 3, 0, 2, 1, -1 },
                  { "unreal", "T_clay_ORM.png", 3, 0, 2, 1, -1 },
                  { "unity", "clay_MaskMap.png", 4, 1, 0, 3, 2 } };
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        WrError err = { "" };
        if (!write_set(known[k].set, NULL, 0, &err)) fail_msg("%s", err.text);
        WrImage *image = wr_image_read(known[k].file, &err);
        if (!image) fail_msg("%s", err.text);
        const int n = known[k].channels;
        const float *far = image->data, *foot = image->data + (14 * 37 + 18) * n;
        const float level = n == 4 ? 1 - far[known[k].rough] : far[known[k].rough];
        assert_near(far[known[k].occlusion], 1, 0.02);
        assert_true(foot[known[k].occlusion] < far[known[k].occlusion] - 0.01f);
        assert_near(level, 0.467, 0.003);
        assert_true(n == 4 ? foot[3] < far[3] : foot[1] > far[1]);
        assert_near(far[known[k].metal], 0, 0);
        if (known[k].full >= 0) assert_near(far[known[k].full], 1, 0);
        wr_image_free(image);
        assert_true(wr_path_remove(known[k].file));
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
    while ((name = wr_folder_next(folder))) *count += name[0] == '.';
    wr_folder_close(folder);
}

/* The second file's name is taken by a folder. */
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
    assert_non_null(strstr(err.text, "T_clay_H.png: is a folder"));
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

/* ---- the user's own ---- */

static void own_set(const char *name, const char *text)
{
    WrError err = { "" };
    char path[80];
    snprintf(path, sizeof path, "config/wrinkle/sets/%s.set", name);
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

static void an_own_set_is_written_as_its_lines_say(void **state)
{
    (void)state;
    WrError err = { "" };
    own_set("studio",
            "\r\n# ours\nabout a renderer of our own\r\n\tnormal-y  N_*.v1.png depth=8 \r\n"
            "height *-h.tif depth=16 range=signed\nlines *.svg lines=4x4");
    WrMapSet *set = wr_map_set_find("studio", &err);
    if (!set) fail_msg("%s", err.text);
    assert_true(set->own && set->maps.count == 3);
    assert_string_equal(set->about, "a renderer of our own");
    wr_map_set_free(set);
    if (!write_set("studio", NULL, 0, &err)) fail_msg("%s", err.text);
    static const char *const files[] = { "N_clay.v1.png", "clay-h.tif", "clay.svg" };
    for (int i = 0; i < 3; i++) assert_true(wr_path_remove(files[i]));
    WrMapSetNames names = wr_map_set_names();
    assert_int_equal(names.names.count, WR_MAP_SET_ROWS + 1);
    assert_string_equal(names.names.data[WR_MAP_SET_ROWS], "studio");
    wr_map_set_names_free(&names);
}

static void an_own_set_goes_before_ours(void **state)
{
    (void)state;
    WrError err = { "" };
    own_set("gltf", "height *_mine.png");
    wr_path_remove("clay_normal.png");
    if (!write_set("gltf", NULL, 0, &err)) fail_msg("%s", err.text);
    assert_true(wr_path_remove("clay_mine.png"));
    assert_false(wr_path_is_there("clay_normal.png"));
    assert_true(wr_path_remove("config/wrinkle/sets/gltf.set"));
}

static void wrong_lines_are_refused_by_number(void **state)
{
    (void)state;
    char many[4000] = "", settings[400] = "height *.png";
    for (int i = 0; i <= WR_MAP_SET_ENTRIES_MAX; i++)
        snprintf(many + strlen(many), sizeof many - strlen(many), "height %d_*.png\n", i);
    for (int i = 0; i <= 12; i++) strcat(settings, " range=auto");
    const struct {
        const char *text, *says;
    } wrong[] = {
        { "# a\nnorml *_N.png", "bad.set:2: 'norml' is no kind of map: must be one of height" },
        { "height", "bad.set:1: height: needs a file's name" },
        { "height ../*_x.png", "without a folder" },
        { "height /tmp/*_x.png", "without a folder" },
        { "height .*.png", "without a folder" },
        { "height x.png", "must have one *" },
        { "height *_*.png", "must have one *" },
        { "height *", "must have one *" },
        { "height *.xyz", "extension 'xyz'" },
        { "height *.png depth=7", "bad.set:1: depth '7': must be 8, 16 or 32" },
        { "height *.png depth", "must be a setting, name=value" },
        { "height *.png nosuch=1", "height: unknown name \"nosuch\": must be one of depth" },
        { "height *.png depth=8 depth=16", "depth= is given twice" },
        { "height *.png\n\nnormal+y *.png", "bad.set:3: '*.png' is written twice" },
        { "height *.jpg depth=16", "JPEG holds 8 bits" },
        { "slopes *.png", "PNG holds 8 or 16 bits" },
        { "stl *.ply", "stl files end in .stl" },
        { "height \033*.png", "control character" },
        { "about nothing", "bad.set: no map in it" },
        { many, "bad.set:33: more than 32 maps" },
        { settings, "more than 8 settings" },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        WrError err = { "" };
        own_set("bad", wrong[i].text);
        WrMapSet *set = wr_map_set_find("bad", &err);
        if (set) fail_msg("taken: %s", wrong[i].text);
        if (!strstr(err.text, wrong[i].says))
            fail_msg("%s: says %s, without %s", wrong[i].text, err.text, wrong[i].says);
    }
}

static void hostile_files_and_names_are_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    char *large = malloc(WR_MAP_SET_FILE_MAX + 2);
    memset(large, '#', WR_MAP_SET_FILE_MAX + 1);
    large[WR_MAP_SET_FILE_MAX + 1] = '\0';
    own_set("bad", large);
    free(large);
    assert_null(wr_map_set_find("bad", &err));
    assert_non_null(strstr(err.text, "65537 bytes: a set has at most 65536"));
    assert_true(wr_file_write("config/wrinkle/sets/bad.set", "height\0*.png", 12, &err));
    assert_null(wr_map_set_find("bad", &err));
    assert_non_null(strstr(err.text, "NUL byte"));
    assert_null(wr_map_set_find("../sets/studio", &err));
    assert_non_null(strstr(err.text, "must be one of blender, gltf"));
    assert_true(wr_path_remove("config/wrinkle/sets/bad.set"));
    assert_true(wr_folder_make("config/wrinkle/sets/bad.set", WR_FOLDER_FOR_ALL));
    assert_null(wr_map_set_find("bad", &err));
    assert_true(wr_folder_remove("config/wrinkle/sets/bad.set"));
    WrDocument *document = bump_document();
    WrText told = { 0 };
    WrMapSet *set = wr_map_set_find("unity", &err);
    static const char *const names[] = { "../x", "a\nb", "" };
    for (int i = 0; i < 3; i++) {
        WrMapSetRequest order = { set, ".", names[i], NULL, 0, NULL };
        assert_false(wr_export_map_set(&order, document, NULL, &told, &err));
        assert_non_null(strstr(err.text, "must be the cell's name"));
    }
    WrMapSetRequest order = { set, "nowhere", "clay", NULL, 0, NULL };
    assert_false(wr_export_map_set(&order, document, NULL, &told, &err));
    assert_non_null(strstr(err.text, "nowhere: is not a folder"));
    wr_map_set_free(set);
    wr_text_fini(&told);
    wr_document_free(document);
}

static int enter_with_settings(void **state)
{
    if (enter_folder(state) != 0) return -1;
    char path[200];
    snprintf(path, sizeof path, "%s/config", (char *)*state);
    return mkdir("config", 0700) || mkdir("config/wrinkle", 0700) ||
                   mkdir("config/wrinkle/sets", 0700)
               ? -1
               : setenv("XDG_CONFIG_HOME", path, 1);
}

static void the_list_of_names_is_that_of_the_table(void **state)
{
    (void)state;
    WrText names = { 0 };
    for (int i = 0; i < WR_MAP_SET_ROWS; i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "", wr_map_set_rows[i].name);
    assert_string_equal(WR_MAP_SET_NAMES, wr_text_get(&names));
    wr_text_fini(&names);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_list_of_names_is_that_of_the_table),
        cmocka_unit_test(every_set_has_the_names_and_formats_of_its_program),
        cmocka_unit_test(packed_maps_have_their_channels_where_programs_look),
        cmocka_unit_test(all_files_of_a_set_are_replaced_or_none),
        cmocka_unit_test(words_go_to_the_maps_that_have_them),
        cmocka_unit_test(an_own_set_is_written_as_its_lines_say),
        cmocka_unit_test(an_own_set_goes_before_ours),
        cmocka_unit_test(wrong_lines_are_refused_by_number),
        cmocka_unit_test(hostile_files_and_names_are_refused),
    };
    return cmocka_run_group_tests(tests, enter_with_settings, remove_folder);
}
