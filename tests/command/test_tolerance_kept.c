/* Stored dials of a tolerance in a document: the same picture is rendered again without a new choice; they are used
   only if they fit; damaged ones are refused. */
#include "test.h"
#include "session_help.h"

#include "accuracy/tolerance.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <unistd.h>

#define SIDE 80

static char folder[] = "/tmp/wr_chosen_XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

/* A file in the test's folder; the caller removes it with gone. */
static char *test_path(const char *name)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%s/%s", folder, name);
    return text.data;
}

static void gone(char *path)
{
    unlink(path);
    wr_free(path);
}

static void expect_same_file(const char *a, const char *b)
{
    WrError err;
    char hex[2][65];
    assert_true(wr_sha256_file(a, hex[0], &err) && wr_sha256_file(b, hex[1], &err));
    assert_string_equal(hex[0], hex[1]);
}

static const char *const ball[] = { "table 64x64",
                                    "noise gradient cells=4 octaves=2 amplitude=0.6 level=0 seed=3",
                                    "surface sphere R=1", "bump mode=blinn height=0.06", NULL };
static const char *const sheet[] = { "table 64x64", "grid cells=8x8 width=2", "surface plane",
                                     "bump mode=blinn height=0.02", NULL };
static const char *const ring[] = { "table 64x64", "fill 0", "surface torus R=1 r=0.4",
                                    "material diffuse=0.9 specular=0", NULL };
static const char *const formula[] = { "analytic fourier terms=3,0,0.5,0,0;0,4,0.4,30,60",
                                       "surface cylinder", "bump mode=blinn height=0.03", NULL };

/* The table of the second object is a layer that is not in the composite. */
static const char *const worn[] = { "table 64x64",
                                    "grid cells=8x8 width=2",
                                    "layer rename 1 net",
                                    "layer add marks",
                                    "dab 0.3,0.4 radius=9 strength=0.7",
                                    "layer set marks visible=off",
                                    "surface sphere R=1",
                                    "object set layer=net",
                                    "object add ball at=1.1,0.3,-0.4 size=0.9 layer=marks",
                                    NULL };

/* Collect a session's notes, one per line. */
static void add_note(void *ctx, const char *text)
{
    wr_text_add(ctx, text);
    wr_text_add(ctx, "\n");
}

static WrSession *opened(const char *path, WrText *notes)
{
    WrError err;
    const WrSessionOptions options = { .note = add_note, .note_ctx = notes };
    WrSession *session = wr_session_new(&options);
    if (!wr_session_open(session, path, &err)) fail_msg("%s", err.text);
    return session;
}

/* The picture's hash; *studies: number of frames analysed for it. */
static WrHash picture(WrSession *session, int width, int height, int *studies)
{
    WrError err;
    WrFrame frame;
    if (!wr_session_frame(session, width, height, 0, &frame, &err)) fail_msg("%s", err.text);
    *studies = wr_session_choice(session)->studies;
    return wr_hash_bytes(frame.rgba, (size_t)4 * (size_t)width * (size_t)height * sizeof(float),
                         (WrHash){ 0, 0 });
}

/* The scene with that tolerance, rendered once and saved. */
static WrHash save_chosen(const char *const *scene, const char *tolerance, const char *path)
{
    WrError err;
    int studies;
    WrSession *session = session_of(scene);
    must_run(session, tolerance);
    const WrHash hash = picture(session, SIDE, SIDE, &studies);
    assert_int_equal(studies, 1);
    if (!wr_session_save(session, path, &err)) fail_msg("%s", err.text);
    wr_session_free(session);
    return hash;
}

static void a_saved_document_has_the_same_picture_and_chooses_nothing_anew(void **state)
{
    (void)state;
    static const char *const *const scenes[] = { ball, sheet, ring, formula };
    static const char *const tolerances[] = { "tolerance rms=0.01", "tolerance max=0.1",
                                              "tolerance rms=0.000001" };
    static const char *const names[] = { "chosen.exr", "chosen.ora" };
    for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++)
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
            int studies;
            WrText notes = { 0 };
            char *path = test_path(names[(s + t) % 2]);
            const WrHash before = save_chosen(scenes[s], tolerances[t], path);
            WrSession *session = opened(path, &notes);
            const WrHash after = picture(session, SIDE, SIDE, &studies);
            if (studies != 0) fail_msg("scene %d, %s: chosen anew", (int)s, tolerances[t]);
            assert_true(wr_hash_equal(before, after));
            assert_true(picture(session, SIDE, SIDE, &studies).low == before.low && studies == 0);
            assert_string_equal(wr_text_get(&notes), "");
            assert_non_null(strstr(wr_session_choice(session)->reason, "written down"));
            wr_text_fini(&notes);
            wr_session_free(session);
            gone(path);
        }
}

/* A document saved again without a picture keeps the stored dials. */
static void what_a_document_keeps_stays_when_it_is_saved_again(void **state)
{
    (void)state;
    WrError err;
    WrText notes = { 0 };
    int studies;
    char *first = test_path("first.exr"), *second = test_path("second.exr");
    const WrHash before = save_chosen(ring, "tolerance rms=0.01", first);
    WrSession *session = opened(first, &notes);
    assert_true(wr_session_save(session, second, &err));
    wr_session_free(session);
    expect_same_file(first, second);
    session = opened(second, &notes);
    assert_true(wr_hash_equal(picture(session, SIDE, SIDE, &studies), before));
    assert_int_equal(studies, 0);
    wr_session_free(session);
    wr_text_fini(&notes);
    gone(first);
    gone(second);
}

static void another_picture_than_the_kept_one_is_chosen_anew_with_a_note(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int side;
        const char *what;
    } changes[] = {
        { "dab 0.5,0.5 radius=6 strength=0.4", SIDE, "another table" },
        { "bump height=0.05", SIDE, "another scene" },
        { "camera perspective fov=33", SIDE, "another scene" },
        { "# as it was", SIDE - 1, "another size" },
    };
    char *path = test_path("changed.exr");
    save_chosen(ball, "tolerance rms=0.01", path);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        int studies;
        WrText notes = { 0 };
        WrSession *session = opened(path, &notes);
        must_run(session, changes[i].line);
        picture(session, changes[i].side, changes[i].side, &studies);
        assert_int_equal(studies, 1);
        if (!strstr(wr_text_get(&notes), changes[i].what))
            fail_msg("%s: noted \"%s\"", changes[i].line, wr_text_get(&notes));
        wr_text_fini(&notes);
        wr_session_free(session);
    }
    gone(path);
}

/* A stroke on the table of one object changes the picture, though the composite is unchanged; a stroke on an unused
   layer does not. */
static void dials_are_for_what_objects_wear(void **state)
{
    (void)state;
    static const char *const edits[][2] = { { "layer use marks", "dab 0.6,0.5 radius=8" },
                                            { "layer add unseen", "dab 0.6,0.5 radius=8" } };
    char *path = test_path("worn.exr");
    const WrHash before = save_chosen(worn, "tolerance rms=0.01", path);
    for (int i = 0; i < 2; i++) {
        int studies;
        WrText notes = { 0 };
        WrSession *session = opened(path, &notes);
        must_run(session, edits[i][0]);
        must_run(session, edits[i][1]);
        assert_int_equal(wr_hash_equal(picture(session, SIDE, SIDE, &studies), before), i == 1);
        assert_int_equal(studies, i == 0);
        assert_int_equal(strstr(wr_text_get(&notes), "another table") != NULL, i == 0);
        wr_text_fini(&notes);
        wr_session_free(session);
    }
    gone(path);
}

/* An edit that is undone leaves the stored dials valid; a new tolerance does not. */
static void kept_dials_are_for_the_document_as_it_was_saved(void **state)
{
    (void)state;
    int studies;
    WrText notes = { 0 };
    char *path = test_path("undone.exr");
    const WrHash before = save_chosen(ball, "tolerance rms=0.01", path);
    WrSession *session = opened(path, &notes);
    must_run(session, "dab 0.5,0.5 radius=6 strength=0.4");
    must_run(session, "undo");
    assert_true(wr_hash_equal(picture(session, SIDE, SIDE, &studies), before));
    assert_int_equal(studies, 0);
    must_run(session, "tolerance rms=0.02");
    picture(session, SIDE, SIDE, &studies);
    assert_int_equal(studies, 1);
    assert_string_equal(wr_text_get(&notes), "");
    wr_session_free(session);
    wr_text_fini(&notes);
    gone(path);
}

/* A saved line for a picture of 16 x 16 pixels, with its first `where` replaced by `bad`. */
static void expect_damaged(const char *where, const char *bad, const char *what)
{
#define HASH "0123456789abcdef0123456789abcdef"
    static const char good[] = "3 16x16 turn=0 table=" HASH " scene=" HASH
                               " met=yes rms=0.003 max=0.1 dials=central,exact,4,0";
    char message[40], value[1200], line[1400];
    WrError err = { "" };
    const char *at = strstr(good, where);
    snprintf(value, sizeof value, "%.*s%s%s", (int)(at - good), good, bad, at + strlen(where));
    snprintf(line, sizeof line, "tolerance rms=0.1 chosen=\"%s\"", value);
    snprintf(message, sizeof message, "damaged in its %s", what);
    WrSession *session = wr_session_new(NULL);
    assert_true(wr_choice_check(good, &err));
    must_fail(session, line, message);
    wr_session_free(session);
}

static void damaged_dials_are_refused_with_one_clear_error(void **state)
{
    (void)state;
    expect_damaged("3 16x16", "4 16x16", "version");
    expect_damaged("3 16x16", "16x16", "version");
    expect_damaged("16x16", "0x16", "size");
    expect_damaged("16x16", "16x99999999", "size");
    expect_damaged("16x16", "16.5x16", "size");
    expect_damaged("16x16", "-16x16", "size");
    expect_damaged("turn=0", "turn=nan", "turn");
    expect_damaged("turn=0", "turn=0x", "turn");
    expect_damaged("table=0", "table=g", "table");
    expect_damaged("table=01", "table=0", "table");
    expect_damaged("scene=01", "scene=0", "scene");
    expect_damaged("met=yes", "met=may", "met");
    expect_damaged("rms=0.003", "rms=-1", "rms");
    expect_damaged("max=0.1", "max=inf", "max");
    expect_damaged("central", "centra", "dials");
    expect_damaged("exact", "exact2", "dials");
    expect_damaged(",4,0", ",0,0", "dials");
    expect_damaged(",4,0", ",17,0", "dials");
    expect_damaged(",4,0", ",4,9", "dials");
    expect_damaged(",4,0", ",4,0,", "dials");
    expect_damaged(",4,0", ",4", "dials");
    expect_damaged(" dials=central,exact,4,0", "", "dials"); /* truncated */
    WrSession *session = wr_session_new(NULL);
    must_fail(session, "tolerance off chosen=x", "chosen");
    must_fail(session, "tolerance rms=0.1 chosen=\"\"", "chosen");
    wr_session_free(session);
}

/* Earlier versions wrote a setting for each block: such a document opens, and its dials are chosen anew. */
static void dials_of_blocks_from_earlier_versions_are_chosen_anew(void **state)
{
    (void)state;
    int studies;
    char line[400];
    for (int version = 1; version <= 2; version++) {
        WrText notes = { 0 };
        const WrSessionOptions options = { .note = add_note, .note_ctx = &notes };
        WrSession *session = wr_session_new(&options);
        snprintf(line, sizeof line,
                 "tolerance rms=0.02 chosen=\"%d 40x24 turn=0 table=%s scene=%s met=yes rms=0.003 "
                 "max=0.1 parts=central,exact,1,0,3;nearest,blinn,2,0,3 blocks=ab.bab\"",
                 version, HASH, HASH);
        must_run(session, line);
        picture(session, 40, 24, &studies);
        assert_int_equal(studies, 1);
        assert_non_null(
            strstr(wr_text_get(&notes), "chosen for another program, and are chosen again"));
        wr_text_fini(&notes);
        wr_session_free(session);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_saved_document_has_the_same_picture_and_chooses_nothing_anew),
        cmocka_unit_test(what_a_document_keeps_stays_when_it_is_saved_again),
        cmocka_unit_test(another_picture_than_the_kept_one_is_chosen_anew_with_a_note),
        cmocka_unit_test(dials_are_for_what_objects_wear),
        cmocka_unit_test(kept_dials_are_for_the_document_as_it_was_saved),
        cmocka_unit_test(damaged_dials_are_refused_with_one_clear_error),
        cmocka_unit_test(dials_of_blocks_from_earlier_versions_are_chosen_anew),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
