/* View history: undo does not affect it, it does not make a document unsaved, but saves, scripts and recoveries
   contain it. WR_FULL=1 runs the full counts. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "command/session.h"
#include "command/recovery.h"
#include "command/command_table.h"
#include "document/history.h"
#include "scene/scene.h"

#include <glob.h>
#include <sys/stat.h>

static int count_of(int full)
{
    const char *all = getenv("WR_FULL");
    return all && *all == '1' ? full : full / 10;
}

static double turned(const WrSession *session)
{
    return doc(session)->scene->posed ? doc(session)->scene->rotate_deg.x : -1;
}

static void undo_takes_edits_back_and_leaves_the_view(void **state)
{
    (void)state;
    WrSession *s =
        session_of((const char *[]){ "table 64x64", "fill 1", "rotate 10,0,0", "fill 2",
                                     "rotate 20,0,0", "camera perspective fov=20", NULL });
    assert_int_equal(wr_session_history_count(s), 3);
    assert_string_equal(wr_session_last_command(s), "fill 2");
    must_run(s, "undo");
    assert_true(f_at(s, 3, 3) == 1 && turned(s) == 20);
    assert_true(doc(s)->scene->camera.fov_deg == 20);
    must_run(s, "rotate 30,0,0"); /* a view keeps the redo steps */
    must_run(s, "redo");
    assert_true(f_at(s, 3, 3) == 2 && turned(s) == 30);
    must_run(s, "undo 3");
    assert_true(f_at(s, 3, 3) == 0 && turned(s) == 30);
    must_fail(s, "undo", "nothing to undo");
    wr_session_free(s);
}

static void the_rest_of_the_scene_is_undone(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "rotate 5,0,0", "surface torus", "rotate 6,0,0",
                                                "light clear", "dials samples=5", NULL });
    must_run(s, "undo 3");
    assert_true(doc(s)->scene->shape.kind == WR_SURFACE_plane && turned(s) == 6);
    assert_true(doc(s)->scene->light_count == 1);
    must_run(s, "redo 3");
    assert_true(doc(s)->scene->shape.kind == WR_SURFACE_torus && turned(s) == 6);
    assert_int_equal(doc(s)->scene->light_count, 0);
    wr_session_free(s);
}

static void a_failure_leaves_the_view(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "fill 1", "rotate 40,0,0", NULL });
    must_fail(s, "image nosuch.png", "nosuch.png");
    must_fail(s, "camera perspective eye=1,1,1 target=1,1,1", "camera");
    must_fail(s, "rotate", "pose=own");
    must_fail(s, "rotate 1,2,3 pose=own", "not both");
    assert_true(turned(s) == 40);
    wr_session_free(s);
}

static void views_have_a_way_back_of_their_own(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_fail(s, "view back", "no view before");
    must_run(s, "rotate 10,0,0");
    must_run(s, "fill 1");
    must_run(s, "rotate 20,0,0");
    must_run(s, "rotate 20,0,0"); /* no change */
    must_run(s, "rotate 30,0,0");
    assert_int_equal(wr_session_view_undo_count(s), 3);
    must_run(s, "view back");
    assert_true(turned(s) == 20 && f_at(s, 3, 3) == 1);
    must_fail(s, "view back 3", "there are 2");
    must_run(s, "view back 2");
    assert_false(doc(s)->scene->posed);
    assert_int_equal(wr_session_redoable_views(s), 3);
    must_run(s, "view forward 2");
    assert_true(turned(s) == 20);
    assert_int_equal(wr_session_history_count(s), 1);
    must_run(s, "rotate pose=own");
    assert_false(doc(s)->scene->posed);
    must_fail(s, "view forward", "no view after");
    wr_session_free(s);
}

static void the_oldest_views_go_first(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    char line[32];
    for (int i = 1; i <= WR_VIEWS_MAX + 5; i++) {
        snprintf(line, sizeof line, "rotate %d,0,0", i);
        must_run(s, line);
    }
    assert_int_equal(wr_session_view_undo_count(s), WR_VIEWS_MAX - 1);
    snprintf(line, sizeof line, "view back %d", WR_VIEWS_MAX - 1);
    must_run(s, line);
    assert_true(turned(s) == 6);
    wr_session_free(s);
}

static void a_document_is_not_unsaved_for_a_view_and_saves_hold_it(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 8x8", "fill 1", NULL });
    if (!wr_session_save(s, "v.exr", &err)) fail_msg("%s", err.text);
    must_run(s, "rotate 15,0,0");
    must_run(s, "camera orthographic size=3");
    must_run(s, "view back");
    assert_true(wr_session_revision(s) == wr_session_saved_revision(s));
    if (!wr_session_save(s, "v.exr", &err)) fail_msg("%s", err.text);
    WrHash hash = wr_session_hash(s);
    if (!wr_session_open(s, "v.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(hash, wr_session_hash(s)) && turned(s) == 15);
    assert_int_equal(wr_session_view_undo_count(s), 0); /* another document, another history */
    must_run(s, "fill 2");
    assert_true(wr_session_revision(s) != wr_session_saved_revision(s));
    wr_session_free(s);
}

/* A document opened as an edit includes its view; undo restores the earlier view. */
static void undoing_an_open_brings_the_view_before_it_back(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 8x8", "rotate 70,0,0", NULL });
    if (!wr_session_save(s, "o.exr", &err)) fail_msg("%s", err.text);
    wr_session_reset(s);
    must_run(s, "fill 1");
    must_run(s, "rotate 10,0,0");
    WrHash before = wr_session_hash(s);
    must_run(s, "open o.exr");
    WrHash opened = wr_session_hash(s);
    assert_true(turned(s) == 70);
    must_run(s, "fill 3");
    must_run(s, "rotate 80,0,0");
    must_run(s, "undo 2");
    assert_true(turned(s) == 10 && wr_hash_equal(before, wr_session_hash(s)));
    must_run(s, "undo");
    assert_true(turned(s) == 10); /* a step without a view */
    must_run(s, "redo 2");
    assert_true(turned(s) == 70 && wr_hash_equal(opened, wr_session_hash(s)));
    must_run(s, "view back");
    assert_true(turned(s) == 10);
    wr_session_free(s);
}

/* ---- scripts ---- */

static int lines_of(const char *path, const char *verb)
{
    char *text;
    size_t length;
    WrError err;
    int count = 0;
    if (!wr_file_read(path, 100000, &text, &length, &err)) fail_msg("%s", err.text);
    for (const char *p = text; p; p = strchr(p, '\n') ? strchr(p, '\n') + 1 : NULL)
        count += strncmp(p, verb, strlen(verb)) == 0;
    wr_free(text);
    return count;
}

static void replays_to(const char *path, WrHash want)
{
    WrError err;
    WrSession *s = wr_session_new(NULL);
    if (!wr_session_run_script(s, path, &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(want, wr_session_hash(s)));
    wr_session_free(s);
}

static void scripts_hold_the_views_that_they_need(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 8x8", "rotate 1,0,0", "fill 1",
                                                "rotate 2,0,0", "rotate 3,0,0", NULL });
    assert_true(wr_session_save_history(s, "s.wrinkle", &err));
    assert_int_equal(lines_of("s.wrinkle", "rotate"), 1);
    replays_to("s.wrinkle", wr_session_hash(s));
    assert_true(wr_session_save(s, "turned.exr", &err));
    must_run(s, "view back 3"); /* as initially: no view line is needed */
    assert_true(wr_session_save_history(s, "s.wrinkle", &err));
    assert_int_equal(lines_of("s.wrinkle", "rotate") + lines_of("s.wrinkle", "camera"), 0);
    replays_to("s.wrinkle", wr_session_hash(s));
    must_run(s, "open turned.exr");
    must_run(s, "view back"); /* a pose not set by rotate */
    assert_false(doc(s)->scene->posed);
    assert_true(wr_session_save_history(s, "s.wrinkle", &err));
    replays_to("s.wrinkle", wr_session_hash(s));
    wr_session_free(s);
}

/* ---- journals ---- */

static WrSession *journaling(void)
{
    WrSessionOptions options = { .journal = true };
    return wr_session_new(&options);
}

static int journals(void)
{
    WrRecoverable *found;
    int count;
    WrError err;
    if (!wr_recovery_list(&found, &count, &err)) fail_msg("%s", err.text);
    wr_recovery_list_free(found, count);
    return count;
}

/* End the session as in a crash, and recover. */
static WrSession *crashed(WrSession *session)
{
    WrRecoverable *found;
    int count;
    WrError err;
    WrRecovered how;
    wr_session_journal_leave(session);
    wr_session_free(session);
    if (!wr_recovery_list(&found, &count, &err)) fail_msg("%s", err.text);
    assert_int_equal(count, 1);
    WrSession *s = journaling();
    if (!wr_session_recover(s, found[0].journal, false, &how, &err)) fail_msg("%s", err.text);
    if (!how.whole || !how.removed) fail_msg("%s", wr_text_get(&how.report));
    wr_recovery_list_free(found, count);
    wr_recovered_fini(&how);
    return s;
}

/* Number of snapshots beside the journals: only lines that cannot be replayed need one. */
static int snapshots(void)
{
    glob_t found;
    bool any = glob("state/journals/*.files/snapshot-*.exr", 0, NULL, &found) == 0;
    int count = any ? (int)found.gl_pathc : 0;
    if (any) globfree(&found);
    return count;
}

static void views_alone_leave_nothing_to_recover(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 8x8", "fill 1", NULL });
    assert_true(wr_session_save(s, "j.exr", &err));
    wr_session_free(s);
    s = journaling();
    if (!wr_session_open(s, "j.exr", &err)) fail_msg("%s", err.text);
    must_run(s, "rotate 25,0,0");
    must_run(s, "rotate 26,0,0");
    must_run(s, "view back");
    wr_session_journal_leave(s);
    assert_int_equal(journals(), 0);
    must_run(s, "fill 2"); /* now one is needed: with the view, on the document as opened */
    must_run(s, "rotate 27,0,0");
    assert_int_equal(snapshots(), 0);
    s = crashed(s);
    assert_true(turned(s) == 27 && f_at(s, 3, 3) == 2);
    must_run(s, "view back"); /* beyond the journal's start */
    WrHash hash = wr_session_hash(s);
    s = crashed(s);
    assert_true(wr_hash_equal(hash, wr_session_hash(s)));
    must_run(s, "fill 3");
    wr_session_free(s);
}

static void a_script_that_only_looks_is_recovered(void **state)
{
    (void)state;
    WrError err;
    static const char script[] = "rotate 11,0,0\ncamera perspective fov=20\n";
    assert_true(wr_file_write("look.wrinkle", script, sizeof script - 1, &err));
    WrSession *s = journaling();
    if (!wr_session_open(s, "look.wrinkle", &err)) fail_msg("%s", err.text);
    must_run(s, "fill 2");
    WrHash hash = wr_session_hash(s);
    s = crashed(s);
    assert_true(wr_hash_equal(hash, wr_session_hash(s)));
    wr_session_free(s);
}

/* The journal begins after the script's lines, and must contain the view that the undo restores. */
static void undoing_an_open_of_a_script_is_recovered(void **state)
{
    (void)state;
    WrError err;
    static const char script[] = "fill 1\nrotate 11,0,0\nopen turned.exr\nrotate 12,0,0\nfill 3\n";
    assert_true(wr_file_write("opens.wrinkle", script, sizeof script - 1, &err));
    WrSession *s = journaling();
    if (!wr_session_open(s, "opens.wrinkle", &err)) fail_msg("%s", err.text);
    must_run(s, "fill 4");
    must_run(s, "undo 3");
    assert_true(turned(s) == 11 && f_at(s, 3, 3) == 1);
    WrHash hash = wr_session_hash(s);
    s = crashed(s);
    assert_true(wr_hash_equal(hash, wr_session_hash(s)));
    wr_session_free(s);
}

/* Edits, undo, redo, opens, views and view undo; sometimes the journal restarts. */
static void random_line(TestRandom *random, char *line, size_t size)
{
    int steps = 1 + (int)(3 * test_random(random)), x = (int)(360 * test_random(random));
    switch ((int)(9 * test_random(random))) {
    case 0: snprintf(line, size, "rotate %d,0,0", x); break;
    case 1: snprintf(line, size, "camera perspective fov=%d", 1 + x / 4); break;
    case 2: snprintf(line, size, "view back %d", steps); break;
    case 3: snprintf(line, size, "view forward %d", steps); break;
    case 4: snprintf(line, size, "undo %d", steps); break;
    case 5: snprintf(line, size, "redo %d", steps); break;
    case 6: snprintf(line, size, "open turned.exr"); break;
    case 7: snprintf(line, size, "bump height=%d", x); break;
    default: snprintf(line, size, "fill %d", x); break;
    }
}

static void random_views_and_edits_recover_and_replay_bit_for_bit(void **state)
{
    (void)state;
    int rounds = count_of(200), done = 0;
    for (int round = 0; round < rounds; round++) {
        TestRandom random = { 900 + (uint64_t)round };
        WrSession *s = journaling();
        WrError err;
        char line[64];
        must_run(s, "table 8x8");
        for (int i = 0; i < 60; i++) {
            random_line(&random, line, sizeof line);
            done += wr_session_run(s, line, &err);
        }
        WrHash hash = wr_session_hash(s);
        if (!wr_session_save_history(s, "r.wrinkle", &err)) fail_msg("%s", err.text);
        replays_to("r.wrinkle", hash);
        s = crashed(s);
        if (!wr_hash_equal(hash, wr_session_hash(s))) fail_msg("round %d", round);
        wr_session_free(s);
    }
    assert_true(done > rounds * 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(undo_takes_edits_back_and_leaves_the_view),
        cmocka_unit_test(the_rest_of_the_scene_is_undone),
        cmocka_unit_test(a_failure_leaves_the_view),
        cmocka_unit_test(views_have_a_way_back_of_their_own),
        cmocka_unit_test(the_oldest_views_go_first),
        cmocka_unit_test(a_document_is_not_unsaved_for_a_view_and_saves_hold_it),
        cmocka_unit_test(undoing_an_open_brings_the_view_before_it_back),
        cmocka_unit_test(scripts_hold_the_views_that_they_need),
        cmocka_unit_test(views_alone_leave_nothing_to_recover),
        cmocka_unit_test(a_script_that_only_looks_is_recovered),
        cmocka_unit_test(undoing_an_open_of_a_script_is_recovered),
        cmocka_unit_test(random_views_and_edits_recover_and_replay_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}
