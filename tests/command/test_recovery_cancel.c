/* Progress and cancellation of a recovery: after a cancellation the session is unchanged and the journal complete. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/progress.h"
#include "command/session.h"
#include "command/recovery.h"

#include <sys/stat.h>
#include <sys/wait.h>

#define COMMANDS 24 /* and "table" */

typedef struct Stop {
    volatile int cancel;
    int reports, at; /* reports so far; the one to cancel at, 0: never */
    double fraction;
} Stop;

static void hear(void *ctx, double fraction)
{
    Stop *stop = ctx;
    assert_true(fraction >= stop->fraction && fraction <= 1.0);
    stop->fraction = fraction;
    if (++stop->reports == stop->at) __atomic_store_n(&stop->cancel, 1, __ATOMIC_RELAXED);
}

/* A program that ended silently; returns its document's hash. saved: it had a file by then. */
static WrHash leave_journal(bool saved)
{
    int ends[2];
    WrHash hash;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        WrError err;
        WrSession *s = wr_session_new(&(WrSessionOptions){ .journal = true, .outputs = true });
        must_run(s, "table 64x48");
        for (int i = 0; i < COMMANDS; i++) {
            char line[80];
            snprintf(line, sizeof line, "dab 0.%d,0.4 radius=9 strength=0.%d", 10 + i, 1 + i % 9);
            must_run(s, line);
            if (saved && i == 3 && !wr_session_save(s, "work.exr", &err)) _exit(1);
        }
        hash = wr_session_hash(s);
        _exit(write(ends[1], &hash, sizeof hash) != (ssize_t)sizeof hash);
    }
    int status;
    assert_int_equal(read(ends[0], &hash, sizeof hash), (ssize_t)sizeof hash);
    assert_true(waitpid(child, &status, 0) == child && status == 0);
    close(ends[0]);
    close(ends[1]);
    return hash;
}

/* Cancel at that report, or not. Returns true if cancelled. */
static bool recover_until(WrSession *session, int at, const char *journal)
{
    WrRecovered recovered = { 0 };
    WrError err = { "" };
    Stop stop = { .at = at };
    const WrProgress progress = { &stop.cancel, hear, &stop };
    wr_progress_set(&progress);
    bool good = wr_session_recover(session, journal, false, &recovered, &err);
    wr_progress_set(NULL);
    if (stop.cancel && stop.reports - at > 2) fail_msg("%d reports afterwards", stop.reports - at);
    if (stop.cancel) assert_false(good);
    if (stop.cancel) assert_non_null(strstr(err.text, "cancelled"));
    if (!stop.cancel) assert_true(good && recovered.whole);
    if (!at) assert_true(stop.reports >= COMMANDS / 2 && stop.fraction > 0.9);
    wr_recovered_fini(&recovered);
    return stop.cancel;
}

static void given_up(bool saved)
{
    WrHash hash = leave_journal(saved);
    for (int at = 1;; at++) {
        WrRecoverable *list;
        int count;
        assert_true(wr_recovery_list(&list, &count, NULL));
        assert_int_equal(count, 1);
        WrSession *s = wr_session_new(NULL);
        must_run(s, "table 32x32");
        must_run(s, "fill 3");
        WrHash before = wr_session_hash(s);
        bool stopped = recover_until(s, at, list[0].journal);
        WrHash after = wr_session_hash(s);
        assert_true(wr_hash_equal(after, stopped ? before : hash));
        if (stopped) assert_int_equal(wr_session_history_position(s), 2);
        wr_session_free(s);
        if (!stopped) {
            assert_true(at > COMMANDS / 2);
            s = wr_session_new(NULL);
            assert_false(recover_until(s, 0, list[0].journal));
            wr_session_free(s);
            assert_true(wr_recovery_discard(list[0].journal, NULL));
        }
        wr_recovery_list_free(list, count);
        if (!stopped) return;
    }
}

static void a_recovery_that_is_given_up_keeps_the_journal(void **state)
{
    (void)state;
    given_up(false);
}

static void the_same_from_the_file_that_was_saved(void **state)
{
    (void)state;
    given_up(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_recovery_that_is_given_up_keeps_the_journal),
        cmocka_unit_test(the_same_from_the_file_that_was_saved),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}
