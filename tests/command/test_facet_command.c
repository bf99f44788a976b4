/* The commands roughness and metalness: file contents, changes and refusals; storage in documents, and their
   versions. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/hash.h"
#include "command/recovery.h"
#include "image/image.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <unistd.h>

static const WrFacetMap *map_of(const WrSession *session, WrFacetKind kind)
{
    return &doc(session)->scene->facets[kind];
}

/* Codes that differ by channel; sRGB conversion would change each. */
static void write_codes(const char *path, int channels)
{
    enum { SIDE = 6 };
    uint8_t codes[SIDE * SIDE * 3];
    WrError err = { "" };
    for (int i = 0; i < SIDE * SIDE * channels; i++)
        codes[i] = (uint8_t)(50 * (1 + i % channels) + i / channels);
    if (!wr_image_write_pixels(path, SIDE, SIDE, channels, WR_PIXEL_U8, true, codes, &err))
        fail_msg("%s", err.text);
}

static void expect_first(const WrSession *s, WrFacetKind kind, int code)
{
    assert_non_null(map_of(s, kind)->image);
    assert_int_equal(map_of(s, kind)->image->channels, 1);
    assert_near((double)map_of(s, kind)->image->data[0], code / 255.0, 1e-6);
}

static void channels_are_those_of_gltf(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    write_codes("packed.png", 3), write_codes("grey.png", 1);
    must_run(s, "roughness packed.png repeat=once");
    must_run(s, "metalness packed.png");
    expect_first(s, WR_FACET_ROUGHNESS, 100);
    expect_first(s, WR_FACET_METALNESS, 150);
    assert_true(map_of(s, WR_FACET_ROUGHNESS)->laid.own &&
                !map_of(s, WR_FACET_METALNESS)->laid.own);
    must_run(s, "metalness grey.png");
    expect_first(s, WR_FACET_METALNESS, 50);
    must_run(s, "roughness packed.png channel=R");
    expect_first(s, WR_FACET_ROUGHNESS, 50);
    must_run(s, "roughness repeat=2,-0.5");
    assert_true(map_of(s, WR_FACET_ROUGHNESS)->laid.rv == -0.5);
    must_run(s, "undo 2");
    expect_first(s, WR_FACET_ROUGHNESS, 100);
    must_run(s, "roughness off");
    assert_null(map_of(s, WR_FACET_ROUGHNESS)->image);
    must_fail(s, "roughness repeat=once", "no picture of roughness");
    must_fail(s, "roughness off repeat=once", "repeat=");
    must_fail(s, "metalness nowhere.png", "nowhere.png");
    must_fail(s, "metalness grey.png repeat=often", "often");
    wr_session_free(s);
}

static void expect_version(const char *path, const char *version)
{
    WrError err = { "" };
    WrImageFile *file = wr_image_file_open(path, &err);
    if (!file) fail_msg("%s", err.text);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:version"), version);
    wr_image_file_close(file);
}

/* Documents store the pictures themselves, also with several objects; their files may be deleted. */
static void documents_keep_them(void **state)
{
    static const char *const names[] = { "kept.exr", "kept.ora" };
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrError err = { "" };
        WrSession *s = wr_session_new(NULL), *t = wr_session_new(NULL);
        write_codes("worn.png", 3);
        must_run(s, "material model=ggx");
        must_run(s, "roughness worn.png repeat=3,0.5");
        must_run(s, "object add other at=1,0,0");
        must_run(s, "metalness worn.png");
        assert_true(wr_session_save(s, names[k], &err));
        assert_int_equal(unlink("worn.png"), 0);
        if (!wr_session_open(t, names[k], &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(t)));
        const WrFacetMap *rough = &wr_scene_object(doc(t)->scene, 0)->facets[WR_FACET_ROUGHNESS];
        assert_true(rough->image && rough->laid.ru == 3);
        assert_near((double)rough->image->data[0], 100 / 255.0, 1e-6);
        expect_first(t, WR_FACET_METALNESS, 150);
        wr_session_free(s);
        wr_session_free(t);
    }
    expect_version("kept.exr", "8");
}

/* A document's version protects older programs from unknown words: each word requires the first version that has it. */
static void what_is_newer_has_a_newer_version(void **state)
{
    static const struct {
        const char *line, *version;
    } rows[] = {
        { "bump height=0.123", "3" },
        { "cell 2,3", "7" },
        { "tone soft", "7" },
        { "grain wood", "7" },
        { "material shadow=on", "7" },
        { "bump displaced=on", "7" },
        { "grain wood drives=roughness", "8" },
        { "material occlusion=on", "8" },
        { "light directional to=0,0,1 size=3", "8" },
        { "dials horizons=16", "8" },
        { "light directional to=0,0,1 shadow=on", "8" },
        { "camera perspective fov=40", "3" },
        { "camera perspective frame=1.5", "8" },
        { "colouring ramp cavity=0.1,0.1,0.1", "8" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrError err = { "" };
        WrSession *s = wr_session_new(NULL);
        must_run(s, "table 16x16");
        must_run(s, rows[i].line);
        if (!wr_session_save(s, "version.exr", &err)) fail_msg("%s", err.text);
        WrImageFile *file = wr_image_file_open("version.exr", &err);
        assert_non_null(file);
        const char *version = wr_image_file_attribute(file, 0, "wrinkle:version");
        if (strcmp(version, rows[i].version) != 0) fail_msg("%s: %s", rows[i].line, version);
        wr_image_file_close(file);
        wr_session_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_are_those_of_gltf),
        cmocka_unit_test(documents_keep_them),
        cmocka_unit_test(what_is_newer_has_a_newer_version),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
