/* The commands step and macro: changed steps are compared with a session that ran the changed lines from the beginning. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/recovery.h"
#include "command/session.h"
#include "document/document.h"

#include <unistd.h>

enum { MOST = 24 };

/* Lines of different kinds, on an odd table, so that most of them depend on the ones before. */
static void random_line(TestRandom *r, int i, char line[200])
{
    const double x = test_random(r), y = test_random(r), z = test_random(r);
    switch ((int)(test_random(r) * 9)) {
    case 0: snprintf(line, 200, "pattern bricks across=%d seed=%d", 2 + (int)(5 * x), i); break;
    case 1: snprintf(line, 200, "dab %.4f,%.4f radius=%.3f strength=0.3", x, y, 3 + 30 * z); break;
    case 2: snprintf(line, 200, "layer add a%d blend=%s", i, x < 0.5 ? "max" : "add"); break;
    case 3: snprintf(line, 200, "adjust blur sigma=%.3f", 0.5 + 3 * x); break;
    case 4: snprintf(line, 200, "bump height=%.4f", x); break;
    case 5: snprintf(line, 200, "layer set 1 opacity=%.4f", x); break;
    case 6: snprintf(line, 200, "select ellipse centre=%.3f,%.3f radii=0.31,0.17", x, y); break;
    case 7: snprintf(line, 200, "adjust add amount=%.4f", z - 0.5); break;
    default:
        snprintf(line, 200, "stroke radius=%.3f strength=0.2 points=%.4f,%.4f;%.4f,%.4f", 4 + 9 * z,
                 x, y, y, x);
    }
}

/* A list of lines as the tests keep it, beside the session's. */
typedef struct List {
    char line[MOST + 8][200];
    bool off[MOST + 8];
    char choice[MOST + 8][32]; /* of a layer, after the line; "": none */
    int count;
} List;

/* The hash after the lines that are on, and the choices of layers between them. */
static WrHash hash_of(const List *list)
{
    WrSession *session = wr_session_new(NULL);
    for (int i = 0; i < list->count; i++) {
        if (!list->off[i]) must_run(session, list->line[i]);
        if (list->choice[i][0]) must_run(session, list->choice[i]);
    }
    const WrHash hash = wr_session_hash(session);
    wr_session_free(session);
    return hash;
}

static void check(WrSession *session, const List *list)
{
    assert_int_equal(wr_session_history_count(session), list->count);
    for (int i = 0; i < list->count; i++)
        assert_int_equal(wr_session_history_is_off(session, i), list->off[i]);
    assert_true(wr_hash_equal(wr_session_hash(session), hash_of(list)));
}

static void changed_steps_are_those_of_a_new_run(void **state)
{
    (void)state;
    for (int round = 0; round < test_amount(12, 3); round++) {
        TestRandom r = { 9000 + (uint64_t)round };
        List list = { .count = 0 }, before;
        WrSession *s = wr_session_new(NULL);
        snprintf(list.line[list.count++], 200, "table 173x%d", 90 + round);
        while (list.count < MOST / 2)
            random_line(&r, list.count, list.line[list.count]), list.count++;
        for (int i = 0; i < list.count; i++) {
            must_run(s, list.line[i]);
            if (i % 3 == 0)
                snprintf(list.choice[i], sizeof list.choice[i], "layer use %d",
                         1 + i % doc(s)->layer_count);
            if (i % 3 == 0) must_run(s, list.choice[i]);
        }
        check(s, &list);
        for (int edit = 0; edit < 6; edit++) {
            const int k = 1 + (int)(test_random(&r) * (list.count - 1));
            char line[260];
            WrError err;
            before = list;
            const WrHash hash = wr_session_hash(s);
            const int undo = wr_session_undo_count(s);
            if (edit % 3 == 2) {
                snprintf(line, sizeof line, "step %s %d", list.off[k] ? "on" : "off", k + 1);
                list.off[k] = !list.off[k];
            } else {
                random_line(&r, 50 + edit, list.line[k]);
                snprintf(line, sizeof line, "step set %d line=\"%s\"", k + 1, list.line[k]);
            }
            if (!wr_session_run(s, line, &err)) { /* a later step does not fit any more */
                assert_non_null(strstr(err.text, "cannot run after this change"));
                list = before;
                assert_int_equal(wr_session_undo_count(s), undo);
                check(s, &list);
                continue;
            }
            assert_int_equal(wr_session_undo_count(s), 1 + (undo < 1 << 30 ? undo : 0));
            check(s, &list);
            must_run(s, "undo");
            assert_true(wr_hash_equal(wr_session_hash(s), hash));
            must_run(s, "redo");
            check(s, &list);
        }
        WrSession *other = wr_session_new(NULL);
        WrError err;
        assert_true(wr_session_save_history(s, "kept.wrinkle", &err));
        if (!wr_session_run_script(other, "kept.wrinkle", &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(other), wr_session_hash(s)));
        wr_session_free(other);
        wr_session_free(s);
    }
}

static WrSession *wall(void)
{
    return session_of((const char *[]){
        "table 131x77", "pattern bricks across=4", "text \"OLD MILL\" size=31", "layer add moss",
        "noise simplex octaves=3", "bump height=0.21", "layer use 1", NULL });
}

static void one_undo_takes_a_change_back_and_more_go_on(void **state)
{
    (void)state;
    WrSession *s = wall();
    const WrHash first = wr_session_hash(s);
    must_run(s, "step set 3 change=\"\\\"NEW MILL\\\" size=17\"");
    assert_non_null(strstr(wr_session_history_line(s, 2), "NEW MILL"));
    const WrHash second = wr_session_hash(s);
    assert_false(wr_hash_equal(first, second));
    must_run(s, "dab 0.3,0.2 radius=7 strength=0.4");
    must_run(s, "step set 2 change=\"across=3\"");
    const WrHash third = wr_session_hash(s);
    must_run(s, "undo 2"); /* the change and the dab */
    assert_true(wr_hash_equal(wr_session_hash(s), second));
    must_run(s, "undo");
    assert_true(wr_hash_equal(wr_session_hash(s), first));
    assert_non_null(strstr(wr_session_history_line(s, 2), "OLD MILL"));
    must_run(s, "undo 2");
    assert_int_equal(wr_session_history_position(s), 4);
    must_run(s, "redo 5");
    assert_true(wr_hash_equal(wr_session_hash(s), third));
    must_fail(s, "redo", "nothing to redo");
    must_run(s, "undo 9");
    assert_int_equal(wr_session_history_position(s), 0);
    must_fail(s, "undo", "nothing to undo");
    must_run(s, "redo 3");
    must_run(s, "fill 0.5"); /* the other lists can no longer be reached */
    assert_int_equal(wr_session_redo_count(s), 0);
    wr_session_free(s);
}

static void steps_are_removed_and_moved(void **state)
{
    (void)state;
    WrSession *s = wall(), *other;
    const WrHash first = wr_session_hash(s);
    must_run(s, "step move 6 to=3"); /* the bump does not depend on the heights */
    assert_true(wr_hash_equal(wr_session_hash(s), first));
    assert_string_equal(wr_session_history_line(s, 2), "bump height=0.21");
    must_run(s, "step move 3 to=6");
    assert_string_equal(wr_session_history_line(s, 5), "bump height=0.21");
    must_run(s, "step delete 2,6");
    other =
        session_of((const char *[]){ "table 131x77", "text \"OLD MILL\" size=31", "layer add moss",
                                     "noise simplex octaves=3", "layer use 1", NULL });
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    must_run(s, "step off 2..4");
    assert_int_equal(wr_session_history_count(s), 4);
    must_run(other, "undo 3");
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    wr_session_free(other);
    wr_session_free(s);
}

/* A refused change leaves every bit, the list, and the undone steps. */
static void impossible_changes_are_refused(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 131x77", "layer add moss", "layer rename 2 x", "fill 0.25", "fill 0.5", NULL });
    must_run(s, "undo");
    must_fail(s, "step off 2", "step 3 cannot run after this change: layer");
    must_fail(s, "step set 5 line=\"fill 0.3\"", "step 5 is undone");
    must_fail(s, "step set 6 line=\"fill 0.3\"", "step 6: there are 5");
    must_fail(s, "step set 2 line=\"undo\"", "must be an edit");
    must_fail(s, "step set 2 line=\"save x.exr\"", "must be an edit");
    must_fail(s, "step set 2", "give line= or change=");
    must_fail(s, "step set 2 change=\"nothing=1\"", "unknown name");
    must_fail(s, "step off 0", "must be numbers of steps");
    must_fail(s, "step off 2..", "must be numbers of steps");
    must_fail(s, "step off 1,,2", "must be numbers of steps");
    must_fail(s, "step delete 99999999999", "must be numbers of steps");
    must_fail(s, "step delete 3..9", "step 9: there are 5");
    assert_int_equal(wr_session_redo_count(s), 1);
    must_run(s, "redo");
    must_run(s, "history budget=1"); /* only the last state and the one before are kept */
    must_fail(s, "step set 2 change=\"blend=max\"", "5 is the first that can be changed");
    must_run(s, "step set 5 line=\"fill 0.75\"");
    wr_session_free(s);
}

/* ---- cancelling, and the journal ---- */

typedef struct Stop {
    volatile int cancel;
    int left;
} Stop;

static void count_down(void *ctx, double fraction)
{
    (void)fraction;
    Stop *stop = ctx;
    if (stop->left-- <= 0) stop->cancel = 1;
}

static void a_cancelled_change_leaves_no_trace(void **state)
{
    (void)state;
    WrSession *s = wall();
    const WrHash before = wr_session_hash(s);
    int stopped = 0;
    for (int left = 0; left < 200; left++) {
        Stop stop = { .left = left };
        WrError err;
        const WrProgress progress = { .cancel = &stop.cancel, .report = count_down, .ctx = &stop };
        const WrProgress *outer = wr_progress_set(&progress);
        const bool good = wr_session_run(s, "step set 2 change=\"across=3 bevel=0.3\"", &err);
        wr_progress_set(outer);
        if (good) break;
        stopped++;
        assert_string_equal(err.text, "step: cancelled");
        assert_true(wr_hash_equal(wr_session_hash(s), before));
        assert_int_equal(wr_session_undo_count(s), 6);
    }
    assert_true(stopped > 3 && wr_session_undo_count(s) == 7);
    wr_session_free(s);
}

static void a_crash_after_a_change_loses_nothing(void **state)
{
    (void)state;
    WrSessionOptions options = { .journal = true };
    WrSession *s = wr_session_new(&options), *other = wr_session_new(NULL);
    WrRecoverable *list;
    int count;
    WrError err;
    static const char *const lines[] = { "table 131x77",
                                         "pattern bricks across=4",
                                         "layer add moss",
                                         "layer use 1",
                                         "dab 0.2,0.7 radius=11",
                                         "step set 2 change=across=3",
                                         "fill 0.25",
                                         "undo 2",
                                         "dab 0.6,0.7 radius=11",
                                         "step off 4",
                                         "layer use 2",
                                         "dab 0.4,0.7 radius=11" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) must_run(s, lines[i]);
    const WrHash hash = wr_session_hash(s);
    wr_session_journal_leave(s);
    assert_true(wr_recovery_list(&list, &count, &err));
    assert_int_equal(count, 1);
    WrRecovered result = { 0 };
    if (!wr_session_recover(other, list[0].journal, false, &result, &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(other), hash));
    wr_recovered_fini(&result);
    wr_recovery_list_free(list, count);
    wr_session_free(other);
    wr_session_free(s);
}

/* ---- macros ---- */

static void a_macro_is_one_step_with_other_values(void **state)
{
    (void)state;
    WrSession *s, *other;
    WrError err;
    WrSessionOptions options = { .outputs = true };
    other = wr_session_new(&options);
    must_run(other, "table 131x77");
    must_run(other, "pattern bricks across=4");
    must_run(other, "text \"OLD MILL\" size=31");
    must_run(other, "rim kind=bevel width=3");
    must_run(other, "script m.wrinkle steps=3..4");
    s = session_of((const char *[]){ "table 200x90", "fill 0.1", NULL });
    must_run(s, "macro m.wrinkle values=\"2: width=5 ; 1: \\\"A;B: C\\\" size=23\"");
    wr_session_free(other);
    other = session_of((const char *[]){ "table 200x90", "fill 0.1", "text \"A;B: C\" size=23",
                                         "rim kind=bevel width=5", NULL });
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    assert_int_equal(wr_session_history_count(s), 3);
    must_fail(s, "macro m.wrinkle values=\"2: width\"", "m.wrinkle:2:");
    must_fail(s, "macro m.wrinkle values=\"width=2\"", "must be numbers of lines");
    must_fail(s, "macro m.wrinkle values=\"2: a=\\\"b\"", "must be numbers of lines");
    assert_true(wr_file_write("bad.wrinkle", "fill 0.5\nundo\n", 14, &err));
    must_fail(s, "macro bad.wrinkle", "writes no files");
    assert_true(wr_file_write("bad.wrinkle", "fill 0.5\nsave x.exr\n", 20, &err));
    must_fail(s, "macro bad.wrinkle", "writes no files");
    must_fail(s, "macro none.wrinkle", "none.wrinkle");
    must_run(s, "step set 3 change=\"values=\\\"2: width=7\\\"\"");
    wr_session_free(other);
    other = session_of((const char *[]){ "table 200x90", "fill 0.1", "text \"OLD MILL\" size=31",
                                         "rim kind=bevel width=7", NULL });
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    wr_session_free(other);
    wr_session_free(s);
}

/* ---- choices ---- */

static void the_choice_of_a_layer_is_no_step(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 61x47", "layer add a",
                                                "layer mask 2 from=white", "layer add b", NULL });
    const uint64_t revision = wr_session_revision(s);
    must_run(s, "layer use a part=mask");
    must_run(s, "layer use 3");
    must_run(s, "layer use a");
    assert_true(wr_session_revision(s) == revision && wr_session_history_count(s) == 4);
    must_run(s, "dab 0.5,0.5 radius=9 mode=lower strength=0.5");
    const WrHash hash = wr_session_hash(s);
    must_run(s, "undo");
    assert_int_equal(doc(s)->active, 1); /* the choice before the dab */
    must_run(s, "redo");
    assert_true(wr_hash_equal(wr_session_hash(s), hash));
    WrSession *other = wr_session_new(NULL);
    WrError err;
    assert_true(wr_session_save_history(s, "choices.wrinkle", &err));
    if (!wr_session_run_script(other, "choices.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(other), hash));
    wr_session_free(other);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_steps_are_those_of_a_new_run),
        cmocka_unit_test(one_undo_takes_a_change_back_and_more_go_on),
        cmocka_unit_test(steps_are_removed_and_moved),
        cmocka_unit_test(impossible_changes_are_refused),
        cmocka_unit_test(a_cancelled_change_leaves_no_trace),
        cmocka_unit_test(a_crash_after_a_change_loses_nothing),
        cmocka_unit_test(a_macro_is_one_step_with_other_values),
        cmocka_unit_test(the_choice_of_a_layer_is_no_step),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}
