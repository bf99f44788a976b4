/* Snapshot of a session: its content is unaffected by later changes of the session, and commands are rejected. */
#include "test.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"

#include <stdlib.h>

#define STEPS 4

static WrSession *some_session(void)
{
    return session_of((const char *[]){
        "table 67x41", "noise perlin cells=5 seed=71", "dab 0.31,0.73 radius=9.5 strength=0.37",
        "surface torus R=1.1 r=0.43", "camera from left", "camera from top", NULL });
}

/* All readable data as text. */
static void describe(const WrSession *session, WrText *text)
{
    const char *reason;
    char hash[33];
    wr_hash_print(wr_session_hash(session), hash);
    wr_text_addf(text, "%s %s %d %d %d %d %d %zu %zu %llu %llu %d\n", hash,
                 wr_session_path(session), wr_session_history_count(session),
                 wr_session_history_position(session), wr_session_history_oldest(session),
                 wr_session_view_undo_count(session), wr_session_redoable_views(session),
                 wr_session_history_bytes(session), wr_session_history_budget(session),
                 (unsigned long long)wr_session_revision(session),
                 (unsigned long long)wr_session_saved_revision(session),
                 (int)wr_session_journal_safe(session, &reason));
    for (int i = 0; i < wr_session_history_count(session); i++)
        wr_text_addf(text, "%s (%zu)\n", wr_session_history_line(session, i),
                     wr_session_history_step_bytes(session, i));
    for (int i = 0; i <= wr_session_history_count(session); i++) {
        const WrField *heights = wr_session_history_heights(session, i);
        wr_text_addf(text, "%llx\n", heights ? (unsigned long long)wr_field_key(heights) : 0ULL);
    }
    wr_session_scene_text(session, text);
}

static void must_show(const WrSession *still, const WrText *before)
{
    WrText now = { 0 };
    describe(still, &now);
    assert_string_equal(wr_text_get(&now), wr_text_get(before));
    wr_text_fini(&now);
}

static void a_still_stays_as_it_was(void **state)
{
    (void)state;
    WrSession *session = some_session();
    WrText before = { 0 };
    must_run(session, "undo");
    describe(session, &before);
    assert_int_equal(wr_session_history_count(session), STEPS);
    WrSession *still = wr_session_snapshot(session);
    must_show(still, &before);
    must_run(session, "camera from right"); /* a new view of the present state */
    must_show(still, &before);
    must_run(session, "undo 2");
    must_run(session, "redo 3");
    must_show(still, &before);
    must_run(session, "fill 0.37"); /* the steps after it are dropped */
    must_run(session, "layer add");
    must_show(still, &before);
    wr_session_set_history_budget(session, 1); /* the oldest states are dropped */
    assert_true(wr_session_history_oldest(session) > 0);
    must_show(still, &before);
    wr_session_reset(session);
    must_show(still, &before);
    wr_session_free(session); /* the snapshot does not depend on the session */
    must_show(still, &before);
    wr_session_free(still);
    wr_text_fini(&before);
}

static void nothing_runs_in_a_still(void **state)
{
    (void)state;
    WrError err = { "" };
    WrSession *session = some_session(), *still = wr_session_snapshot(session);
    must_fail(still, "fill 0.37", "busy: ");
    must_fail(still, "undo", "busy: ");
    assert_false(wr_session_history_go(still, 0, &err));
    assert_false(wr_session_stroke_begin(still, "stroke radius=7", &err));
    assert_false(wr_session_save(still, "still.exr", &err));
    wr_session_free(still);
    must_run(session, "undo 2"); /* and shared data is intact */
    must_run(session, "redo");
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_stays_as_it_was),
        cmocka_unit_test(nothing_runs_in_a_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
