/* The command environment: arguments, notes, refusals, and storage in documents. */
#include "test.h"
#include "recovery_help.h"
#include "test_folder.h"
#include "session_help.h"

#include "image/image.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <unistd.h>

static const WrEnvironment *of(const WrSession *session)
{
    return &doc(session)->scene->environment;
}

static void write_sky(const char *path, bool strange)
{
    float data[12 * 6 * 3];
    WrError err = { "" };
    for (int i = 0; i < 12 * 6 * 3; i++) data[i] = 0.37f + 0.0173f * (float)(i * 7 % 31);
    if (strange) data[5] = NAN, data[6] = INFINITY, data[100] = -2.5f, data[101] = 1e30f;
    if (!wr_image_write_pixels(path, 12, 6, 3, WR_PIXEL_F32, false, data, &err))
        fail_msg("%s", err.text);
}

static void sets_files_and_settings_are_taken(void **state)
{
    (void)state;
    write_sky("sky.exr", false);
    WrSession *s = wr_session_new(NULL);
    assert_int_equal(of(s)->kind, WR_ENVIRONMENT_MAP_OFF);
    must_fail(s, "environment turn=3", "no environment");
    must_fail(s, "environment off strength=2", "strength");
    must_fail(s, "environment sky layer=R", "layer");
    must_fail(s, "environment missing.exr", "missing.exr");
    must_run(s, "environment studio turn=12.5");
    must_run(s, "environment strength=0.7");
    assert_true(of(s)->kind == WR_ENVIRONMENT_MAP_STUDIO && of(s)->turn_deg == 12.5);
    must_run(s, "environment sky.exr turn=-7");
    assert_true(of(s)->kind == WR_ENVIRONMENT_MAP_FILE && of(s)->turn_deg == -7);
    assert_true(of(s)->strength == 0.7 && of(s)->light->image->width == 12);
    must_run(s, "undo");
    assert_true(of(s)->kind == WR_ENVIRONMENT_MAP_STUDIO && of(s)->turn_deg == 12.5);
    must_run(s, "environment off");
    assert_true(of(s)->kind == WR_ENVIRONMENT_MAP_OFF && !of(s)->light && of(s)->strength == 1);
    wr_session_free(s);
}

/* HC114: an arbitrary file is accepted; invalid light values are reported. */
static void what_is_no_light_is_told(void **state)
{
    (void)state;
    Said said = { "" };
    const WrSessionOptions options = { .note = hear_note, .note_ctx = &said, .outputs = true };
    WrSession *s = wr_session_new(&options);
    write_sky("strange.exr", true);
    must_run(s, "environment strange.exr");
    if (!strstr(said.text, "1 values were not numbers") || !strstr(said.text, "1 values below 0") ||
        !strstr(said.text, "2 values above"))
        fail_msg("told: %s", said.text);
    assert_true(of(s)->light->image->data[6] == 1e9f && of(s)->light->image->data[5] == 0);
    wr_session_free(s);
}

static void reopened_as(const WrSession *s, const char *path)
{
    WrError err = { "" };
    WrSession *t = wr_session_new(NULL);
    if (!wr_session_open(t, path, &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(t)));
    assert_int_equal(of(t)->kind, of(s)->kind);
    assert_true(of(t)->turn_deg == of(s)->turn_deg && of(t)->strength == of(s)->strength);
    const WrImage *was = of(s)->light->image, *is = of(t)->light->image;
    assert_true(is->width == was->width && is->height == was->height);
    assert_memory_equal(is->data, was->data,
                        (size_t)was->width * (size_t)was->height * 3 * sizeof *was->data);
    wr_session_free(t);
}

/* Also with several objects, whichever is active; the file itself may be deleted. */
static void documents_keep_them(void **state)
{
    (void)state;
    static const char *const more[] = { "object add ball", "object choose \"object 1\"",
                                        "environment raking strength=3" };
    WrError err = { "" };
    write_sky("gone.exr", false);
    WrSession *s = wr_session_new(NULL);
    must_run(s, "environment gone.exr turn=31.7 strength=0.43");
    assert_int_equal(unlink("gone.exr"), 0);
    for (int i = 0; i <= 3; i++) {
        if (!wr_session_save(s, "kept.exr", &err)) fail_msg("%s", err.text);
        reopened_as(s, "kept.exr");
        if (!wr_session_save(s, "kept.ora", &err)) fail_msg("%s", err.text);
        reopened_as(s, "kept.ora");
        if (i < 3) must_run(s, more[i]);
    }
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_files_and_settings_are_taken),
        cmocka_unit_test(what_is_no_light_is_told),
        cmocka_unit_test(documents_keep_them),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}
