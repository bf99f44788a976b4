/* A killed program loses at most the running command. A child runs commands through a session with a journal and is
   killed; the parent recovers and compares hashes with those of an undisturbed run. WR_FULL=1 runs the full counts,
   else a tenth. */
#include "test.h"
#include "recovery_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "command/recovery.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

#include <dirent.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#define COMMANDS 80

static uint64_t seed = 77;
static char folder[64];

static int count_of(int full)
{
    const char *all = getenv("WR_FULL");
    return all && *all == '1' ? full : full / 10;
}

static int setup(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "%s/wrinkle-recovery-XXXXXX",
             access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
    if (!mkdtemp(folder)) return -1;
    return setenv("WRINKLE_STATE", folder, 1);
}

static int teardown(void **state)
{
    (void)state;
    char line[128];
    snprintf(line, sizeof line, "rm -rf '%s'", folder);
    return system(line);
}

/* ---- commands ---- */

/* A command that changes the document each time, or an undo or redo. */
static void make_line(TestRandom *random, int index, char *line, size_t size)
{
    double a = test_random(random), b = test_random(random), c = test_random(random);
    if (index == 0) {
        snprintf(line, size, "table 96x80");
        return;
    }
    if (index <= 3) {
        static const char *const begin[] = { "filter blur sigma=1.3 name=soft",
                                             "layer group both of=1..2", "layer use 1" };
        snprintf(line, size, "%s", begin[index - 1]);
        return;
    }
    switch ((int)(7 * test_random(random))) {
    case 0:
    case 1:
        snprintf(line, size, "dab %.3f,%.3f radius=%.1f strength=%.2f", a, b, 2 + 20 * c, c);
        break;
    case 2:
    case 3:
        snprintf(line, size, "stroke points=%.3f,%.3f;%.3f,%.3f;%.3f,%.3f,0.5 radius=%.1f", a, b, b,
                 c, c, a, 2 + 9 * a);
        break;
    case 4:
        if (b < 0.5) snprintf(line, size, "bump height=%.4f", a);
        else snprintf(line, size, "filter blur sigma=%.4f layer=soft", 5 * a);
        break;
    case 5: snprintf(line, size, index > 4 && c < 0.7 ? "undo" : "rotate %.0f,0,0", 90 * a); break;
    default: snprintf(line, size, "layer add opacity=%.2f%s", a, b < 0.3 ? " in=both" : ""); break;
    }
}

typedef struct Plan {
    char lines[COMMANDS][160];
    WrHash hashes[COMMANDS + 1]; /* after each number of commands */
} Plan;

static WrSession *new_session(bool journal)
{
    WrSessionOptions options = { .journal = journal };
    return wr_session_new(&options);
}

static Plan *make_plan(void)
{
    Plan *plan = wr_alloc(1, sizeof *plan);
    TestRandom random = { seed };
    WrSession *session = new_session(false);
    WrError err = { "" };
    plan->hashes[0] = wr_session_hash(session);
    for (int i = 0; i < COMMANDS; i++) {
        make_line(&random, i, plan->lines[i], sizeof plan->lines[i]);
        if (!wr_session_run(session, plan->lines[i], &err))
            fail_msg("%s: %s", plan->lines[i], err.text);
        plan->hashes[i + 1] = wr_session_hash(session);
    }
    wr_session_free(session);
    return plan;
}

/* ---- children ---- */

typedef struct Shared {
    volatile int done; /* commands that have ended */
} Shared;

static Shared *share(void)
{
    Shared *shared =
        mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(shared != MAP_FAILED);
    return shared;
}

/* Run all commands in a child; at the end it waits to be killed. */
static pid_t start(const Plan *plan, Shared *shared)
{
    shared->done = 0;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child > 0) return child;
    WrSession *session = new_session(true);
    for (int i = 0; i < COMMANDS; i++) {
        if (!wr_session_run(session, plan->lines[i], NULL)) _exit(1);
        __atomic_store_n(&shared->done, i + 1, __ATOMIC_SEQ_CST);
    }
    for (;;) pause();
}

static void end(pid_t child)
{
    int status;
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
}

/* Recover the only journal: the document's hash. False if there is none. */
static bool recovered(WrHash *hash, WrText *report)
{
    WrRecoverable *found;
    WrError err = { "" };
    int count;
    if (!wr_recovery_list(&found, &count, &err)) fail_msg("%s", err.text);
    assert_true(count <= 1);
    if (count == 1) {
        WrSession *session = new_session(true);
        WrRecovered how;
        if (!wr_session_recover(session, found[0].journal, false, &how, &err))
            fail_msg("%s", err.text);
        wr_text_add(report, wr_text_get(&how.report));
        assert_int_equal(how.removed, how.whole);
        if (!how.removed) assert_true(wr_recovery_discard(found[0].journal, NULL));
        wr_recovered_fini(&how);
        assert_true(wr_session_revision(session) != wr_session_saved_revision(session));
        *hash = wr_session_hash(session);
        wr_session_free(session);
    }
    wr_recovery_list_free(found, count);
    return count == 1;
}

/* The state must be that after `least` commands, or one more. Different counts may give equal documents (undo). */
static void expect(const Plan *plan, int least, WrHash hash, const WrText *report)
{
    for (int k = least; k <= least + 1 && k <= COMMANDS; k++)
        if (wr_hash_equal(plan->hashes[k], hash)) return;
    fail_msg(
        "killed after %d commands: what was recovered is neither their state nor the next (%s)",
        least, wr_text_get(report));
}

static void kill_at_random_moments_loses_at_most_the_command_under_way(void **state)
{
    (void)state;
    printf("seed %llu\n", (unsigned long long)seed);
    Plan *plan = make_plan();
    Shared *shared = share();
    TestRandom random = { seed + 1 };
    for (int round = 0; round < count_of(200); round++) {
        pid_t child = start(plan, shared);
        int target = (int)(COMMANDS * test_random(&random));
        while (__atomic_load_n(&shared->done, __ATOMIC_SEQ_CST) < target) usleep(20);
        usleep((useconds_t)(400 * test_random(&random)));
        end(child);
        int done = __atomic_load_n(&shared->done, __ATOMIC_SEQ_CST);
        WrText report = { 0 };
        WrHash hash;
        if (recovered(&hash, &report)) expect(plan, done, hash, &report);
        else assert_int_equal(done, 0);
        wr_text_fini(&report);
    }
    munmap(shared, sizeof *shared);
    wr_free(plan);
}

/* ---- damage ---- */

/* A journal of the whole plan, left as by a crash: its path. The caller frees it. */
static char *left_behind(const Plan *plan)
{
    WrSession *session = new_session(true);
    for (int i = 0; i < COMMANDS; i++) assert_true(wr_session_run(session, plan->lines[i], NULL));
    wr_session_journal_leave(session);
    wr_session_free(session);
    return only_journal();
}

static void write_file(const char *path, const char *bytes, size_t length)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

/* Recover from these bytes: the result must be a state of the plan, or nothing, or an error; never a crash. Returns
   true if a document was recovered. */
static bool any_state(const Plan *plan, const char *path, const char *bytes, size_t length)
{
    write_file(path, bytes, length);
    WrRecovered how;
    WrError err = { "" };
    WrSession *session = new_session(false);
    bool good = wr_session_recover(session, path, false, &how, &err), known = false;
    WrHash hash = wr_session_hash(session);
    for (int k = 0; k <= COMMANDS; k++) known |= wr_hash_equal(plan->hashes[k], hash);
    if (!known)
        fail_msg("%zu bytes: a state that never was (%s)", length, wr_text_get(&how.report));
    if (!good) assert_true(err.text[0] != '\0');
    assert_int_equal(access(path, F_OK), 0); /* not saved yet */
    wr_session_free(session);
    wr_recovered_fini(&how);
    return good;
}

static void a_journal_cut_at_every_byte_of_its_end_gives_a_state_that_was(void **state)
{
    (void)state;
    Plan *plan = make_plan();
    char *path = left_behind(plan), *bytes;
    size_t length, from;
    int lines = 0, step = count_of(10);
    assert_true(wr_file_read(path, 1 << 24, &bytes, &length, NULL));
    for (from = length; from > 0 && lines < 4; from--) lines += bytes[from - 1] == '\n';
    for (size_t cut = from; cut<length; cut += step> 1 ? 1 : 3)
        assert_true(any_state(plan, path, bytes, cut));
    unlink(path);
    wr_free(bytes);
    wr_free(path);
    wr_free(plan);
}

static void random_flips_of_bytes_give_a_state_that_was_or_an_error(void **state)
{
    (void)state;
    Plan *plan = make_plan();
    char *path = left_behind(plan), *bytes;
    size_t length;
    TestRandom random = { seed + 2 };
    int back = 0;
    assert_true(wr_file_read(path, 1 << 24, &bytes, &length, NULL));
    char *damaged = wr_alloc(length, 1);
    for (int round = 0; round < count_of(400); round++) {
        memcpy(damaged, bytes, length);
        for (int k = 0; k < 3; k++)
            damaged[(size_t)(test_random(&random) * (double)length)] ^= (char)(1 << (round % 8));
        back += any_state(plan, path, damaged, length);
    }
    assert_true(back > 0);
    unlink(path);
    wr_free(damaged);
    wr_free(bytes);
    wr_free(path);
    wr_free(plan);
}

/* ---- the rest ---- */

static void a_stroke_in_progress_survives(void **state)
{
    (void)state;
    Shared *shared = share();
    shared->done = 0;
    const WrSample samples[] = { { .u = 0.2, .v = 0.3, .pressure = 1 },
                                 { .u = 0.5, .v = 0.6, .pressure = 0.7 },
                                 { .u = 0.8, .v = 0.2, .pressure = 1 } };
    pid_t child = fork();
    if (child == 0) {
        WrSession *session = new_session(true);
        bool good = wr_session_run(session, "fill 0.25", NULL) &&
                    wr_session_stroke_begin(session, "stroke radius=9", NULL) &&
                    wr_session_stroke_add(session, samples, 3, NULL);
        __atomic_store_n(&shared->done, good ? 1 : -1, __ATOMIC_SEQ_CST);
        for (;;) pause();
    }
    while (__atomic_load_n(&shared->done, __ATOMIC_SEQ_CST) == 0) usleep(50);
    assert_int_equal(shared->done, 1);
    end(child);
    WrSession *whole = new_session(false);
    assert_true(wr_session_run(whole, "fill 0.25", NULL));
    assert_true(wr_session_run(whole, "stroke points=0.2,0.3;0.5,0.6,0.7;0.8,0.2 radius=9", NULL));
    WrText report = { 0 };
    WrHash hash;
    assert_true(recovered(&hash, &report));
    assert_true(wr_hash_equal(hash, wr_session_hash(whole)));
    wr_text_fini(&report);
    wr_session_free(whole);
    munmap(shared, sizeof *shared);
}

static void a_file_that_a_command_read_may_change_or_vanish_afterwards(void **state)
{
    (void)state;
    char path[128];
    WrError err = { "" };
    uint8_t grey[16 * 16];
    for (int i = 0; i < 256; i++) grey[i] = (uint8_t)i;
    snprintf(path, sizeof path, "%s/heights.png", folder);
    assert_true(wr_image_write_pixels(path, 16, 16, 1, WR_PIXEL_U8, true, grey, &err));
    char line[160];
    snprintf(line, sizeof line, "image %s", path);
    WrSession *session = new_session(true);
    if (!wr_session_run(session, line, &err)) fail_msg("%s", err.text);
    WrHash heights = wr_field_hash(wr_document_field(wr_session_document(session)));
    wr_session_journal_leave(session);
    wr_session_free(session);
    assert_int_equal(unlink(path), 0);

    WrRecoverable *found;
    int count;
    WrRecovered how;
    assert_true(wr_recovery_list(&found, &count, &err));
    assert_int_equal(count, 1);
    session = new_session(true);
    if (!wr_session_recover(session, found[0].journal, false, &how, &err)) fail_msg("%s", err.text);
    assert_true(how.whole && how.removed);
    WrHash again = wr_field_hash(wr_document_field(wr_session_document(session)));
    if (!wr_hash_equal(again, heights)) fail_msg("%s", wr_text_get(&how.report));
    wr_session_free(session);
    wr_recovery_list_free(found, count);
    wr_recovered_fini(&how);
}

static void nothing_is_left_when_a_session_ends_in_order(void **state)
{
    (void)state;
    WrSession *session = new_session(true);
    assert_true(wr_session_run(session, "dab 0.5,0.5", NULL));
    const char *reason;
    assert_true(wr_session_journal_safe(session, &reason));
    wr_session_free(session);
    WrRecoverable *found;
    int count;
    assert_true(wr_recovery_list(&found, &count, NULL));
    assert_int_equal(count, 0);
    wr_recovery_list_free(found, count);
}

static void undoing_past_a_fresh_start_of_the_journal_can_be_recovered(void **state)
{
    (void)state;
    WrSession *session = new_session(false);
    assert_true(wr_session_run(session, "dab 0.2,0.2", NULL));
    assert_true(wr_session_run(session, "dab 0.4,0.4", NULL));
    wr_session_set_journal(session, true);
    assert_true(wr_session_run(session, "dab 0.6,0.6", NULL));
    assert_true(wr_session_run(session, "undo 3", NULL));
    assert_true(wr_session_run(session, "redo 1", NULL));
    assert_true(wr_session_history_go(session, 2, NULL));
    WrHash want = wr_session_hash(session), hash;
    wr_session_journal_leave(session);
    wr_session_free(session);
    WrText report = { 0 };
    assert_true(recovered(&hash, &report));
    assert_true(wr_hash_equal(want, hash));
    wr_text_fini(&report);
}

int main(void)
{
    const char *chosen = getenv("WR_SEED");
    if (chosen) seed = strtoull(chosen, NULL, 10);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kill_at_random_moments_loses_at_most_the_command_under_way),
        cmocka_unit_test(a_journal_cut_at_every_byte_of_its_end_gives_a_state_that_was),
        cmocka_unit_test(random_flips_of_bytes_give_a_state_that_was_or_an_error),
        cmocka_unit_test(a_stroke_in_progress_survives),
        cmocka_unit_test(a_file_that_a_command_read_may_change_or_vanish_afterwards),
        cmocka_unit_test(nothing_is_left_when_a_session_ends_in_order),
        cmocka_unit_test(undoing_past_a_fresh_start_of_the_journal_can_be_recovered),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
