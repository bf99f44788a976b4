/* Writing of every kind of file while the disk fails or is full, or the program is killed. The result is an error
   with the old file intact, or success with exactly the bytes of an undisturbed run. After a kill the file is the old
   or the new one, and the next write removes all leftovers.

   The C library's calls are intercepted (fault.h), in child processes, so that libraries are started only once. A
   tenth of the cases in every run, all with WR_FULL=1. */
#include "test.h"
#include "test_folder.h"
#include "command/session_help.h"
#include "fault_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "command/session.h"
#include "document/recover.h"
#include "image/oiio.h"

#include <dirent.h>
#include <errno.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

#define OLD "what was there before, and is worth keeping\n"
#define VICTIM "victim" /* a file that no test refers to */

/* A written file: one of each kind and way of writing. */
typedef struct Job {
    const char *file, *line;
    bool plain; /* for the document of one layer */
} Job;

static const Job jobs[] = {
    { "one.exr", "save one.exr", true },
    { "many.exr", "save many.exr", false },
    { "layers.ora", "save layers.ora", false },
    { "float.exr", "export height float.exr", true },
    { "deep.png", "export height deep.png depth=16", true },
    { "float.tif", "export height float.tif", true },
    { "deep.tif", "export normal+y deep.tif depth=16", true },
    { "flat.jpg", "export normal-y flat.jpg", true },
    { "flat.bmp", "export height flat.bmp", true },
    { "flat.tga", "export normal+y flat.tga", true },
    { "half.exr", "export height half.exr depth=16", true },
    { "normals.exr", "export normal+y normals.exr depth=16", true },
    { "horizon.exr", "export horizon horizon.exr directions=4", true },
    { "copy.exr", "copy copy.exr", true },
    { "copy.tif", "copy copy.tif of=composite", true },
    { "flat.ppm", "export normal+y flat.ppm", true },
    { "flat.pgm", "export height flat.pgm", true },
    { "look.png", "render look.png size=40x30", true },
    { "look.tif", "render look.tif size=40x30", true },
    { "lines.svg", "export lines lines.svg", true },
    { "profile.svg", "export profile profile.svg", true },
    { "lines.png", "export lines lines.png size=60x40", true },
    { "lines.pdf", "export lines lines.pdf lines=9x7", true },
    { "slopes.exr", "export bump-slopes slopes.exr", true },
    { "body.stl", "export stl body.stl error=2", true },
    { "body.ply", "export ply body.ply error=2", true },
    { "body.obj", "export obj body.obj error=2", true },
    { "look.exr", "render look.exr size=40x30", true },
    { "contact.png", "export contact contact.png tile=32 maps=height;normal+y", true },
    { "done.wrinkle", "script done.wrinkle", false },
};
#define JOBS (int)(sizeof jobs / sizeof *jobs)

typedef struct World {
    char folder[64];
    WrSession *plain, *rich;
    char (*said)[256]; /* the child's error */
    FaultTally all;
} World;

static World world;
static void make_old(const Job *job);

/* Common initialisation, done once: child processes inherit the libraries and use the same reader. */
static void warm(void)
{
    wr_image_warm();
    assert_non_null(wr_oiio(NULL));
}

static int make_world(void **state)
{
    static const char *const lines[] = { "table 64x48", "grid cells=4x3", "dab 0.3,0.3 radius=9",
                                         NULL };
    if (enter_folder(state) != 0) return -1;
    world.plain = session_of(lines);
    world.rich = session_of(lines);
    must_run(world.rich, "layer add b");
    must_run(world.rich, "dab 0.6,0.3 radius=12");
    must_run(world.rich, "select rect from=0.1,0.1 to=0.5,0.5");
    must_run(world.rich, "layer mask 2 from=selection");
    warm();
    wr_session_set_outputs(world.plain, true);
    wr_session_set_outputs(world.rich, true);
    make_old(&(Job){ .file = VICTIM });
    world.said =
        mmap(NULL, sizeof *world.said, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return world.said == MAP_FAILED || !wr_fault_state() ? -1 : 0;
}

static int end_world(void **state)
{
    fault_tell("in all", &world.all);
    wr_session_free(world.plain);
    wr_session_free(world.rich);
    return remove_folder(state);
}

/* ---- one run ---- */

/* Run the job; the process ends with 0, or 1 and an error message. */
static void run_job(const Job *job)
{
    WrError err = { "" };
    bool good = wr_session_run(job->plain ? world.plain : world.rich, job->line, &err);
    snprintf(*world.said, sizeof *world.said, "%.250s", err.text);
    _exit(good ? 0 : 1);
}

static int run_clean(const Job *job)
{
    pid_t child = fault_fork();
    if (child == 0) run_job(job);
    return fault_wait(child);
}

static bool is_old(const char *path)
{
    return fault_holds(path, OLD, sizeof OLD - 1);
}

/* Bytes of an undisturbed run. */
typedef struct Good {
    char *bytes;
    size_t length;
} Good;

static bool is_new(const char *path, const Good *good)
{
    return fault_holds(path, good->bytes, good->length);
}

static void make_old(const Job *job)
{
    WrError err;
    if (!wr_file_write(job->file, OLD, sizeof OLD - 1, &err)) fail_msg("%s", err.text);
}

static Good make_good(const Job *job)
{
    Good good;
    *world.said[0] = '\0';
    if (run_clean(job) != 0) fail_msg("%s: %s", job->line, *world.said);
    fault_read_whole(job->file, &good.bytes, &good.length);
    return good;
}

/* Checks after every run; restores the old file. */
static void check_end(const Job *job, const Good *good, int status, FaultTally *tally,
                      const char *what)
{
    tally->cases++;
    bool old = is_old(job->file);
    if (!old && !is_new(job->file, good))
        fail_msg("%s: %s: the file is neither the old nor the new one (status %x)", job->line, what,
                 status);
    if (WIFSIGNALED(status)) {
        if (WTERMSIG(status) != SIGKILL)
            fail_msg("%s: %s: signal %d", job->line, what, WTERMSIG(status));
        if (old) tally->killed_old++;
        else tally->killed_new++;
        if (run_clean(job) != 0) fail_msg("%s after %s: %s", job->line, what, *world.said);
        if (!is_new(job->file, good)) fail_msg("%s after %s: another file", job->line, what);
    } else if (WEXITSTATUS(status) == 0) {
        tally->successes++;
        if (old) fail_msg("%s: %s: success, and nothing was written", job->line, what);
    } else {
        tally->errors++;
        if (WEXITSTATUS(status) != 1 || !old)
            fail_msg("%s: %s: an error (%s), and the old file is gone", job->line, what,
                     *world.said);
        if (!strstr(*world.said, "cannot be written"))
            fail_msg("%s: %s: the error is '%s'", job->line, what, *world.said);
    }
    if (fault_hidden_files() != 0) fail_msg("%s: %s: something stays", job->line, what);
    if (!is_old(job->file)) make_old(job);
}

/* ---- failing calls and kills ---- */

static void run_fault(const Job *job, const Good *good, FaultKind kind, int64_t n, FaultMode mode,
                      FaultTally *tally)
{
    static const int errors[] = { ENOSPC, EIO, EDQUOT };
    char what[80];
    snprintf(what, sizeof what, "%s %lld, %s", wr_fault_kinds[kind], (long long)n,
             wr_fault_modes[mode]);
    pid_t child = fault_fork();
    if (child == 0) {
        wr_fault_arm(kind, n, mode, errors[n % 3]);
        strcpy(wr_fault_state()->victim, VICTIM);
        run_job(job);
    }
    int status = fault_wait(child);
    FaultState *state = wr_fault_state();
    state->armed = 0;
    if (!state->fell) fail_msg("%s: %s: there was no such call", job->line, what);
    bool late = state->fell_place == FAULT_PART && state->fell_stage == FAULT_SYNCED;
    if (kind == FAULT_CLOSE && mode == FAULT_ERROR && late && status == 0)
        fail_msg("%s: %s: passed over", job->line, what);
    if (state->careless) fail_msg("%s: %s: renamed before it was synced", job->line, what);
    for (int i = 0; i < 3 && *state->planted[i]; i++) unlink(state->planted[i]);
    if (!is_old(VICTIM)) fail_msg("%s: %s: another file was written to", job->line, what);
    if (WIFSIGNALED(status)) tally->kills[state->fell_place][state->fell_stage]++;
    check_end(job, good, status, tally, what);
}

/* Important cases, each guarded by a single line of code: run every time, for some of the jobs. Of many calls, such as the
   closing of a contact sheet's inputs, the first, the last and a seventh. */
static bool is_telling(int job, FaultKind kind, FaultMode mode, int64_t n, int64_t count)
{
    if (n > 9 && n < count - 9 && n % test_step(7, 7) != 0) return false;
    bool end = kind == FAULT_SYNC || kind == FAULT_RENAME || kind == FAULT_CLOSE;
    return kind == FAULT_UNLINK || (mode == FAULT_ERROR && end && job % 7 == 0);
}

/* For each write to disk, or the ends and a fifth of many: flip a bit, or drop it, though success is reported. */
static void try_silent(const Job *job, const Good *good, int64_t writes, FaultTally *tally)
{
    for (int64_t n = 1; n <= writes; n++)
        for (int mode = FAULT_FLIP; mode <= FAULT_DROP; mode++)
            if (n < 9 || n > writes - 4 || (n + mode) % test_step(5, 5) == 0)
                run_fault(job, good, FAULT_WRITE, n, (FaultMode)mode, tally);
}

static void every_call_may_fail(void **state)
{
    (void)state;
    int64_t index = 0;
    for (int i = 0; i < JOBS; i++) {
        const Job *job = &jobs[i];
        Good good = make_good(job);
        FaultTally tally = { 0 };
        make_old(job);
        pid_t child = fault_fork();
        if (child == 0) {
            wr_fault_arm(FAULT_WRITE, 0, FAULT_COUNT, 0);
            run_job(job);
        }
        assert_int_equal(fault_wait(child), 0);
        FaultState counted = *wr_fault_state();
        wr_fault_state()->armed = 0;
        make_old(job);
        const int64_t on_disk =
            counted.counts[FAULT_WRITE] - counted.seen[FAULT_WRITE][FAULT_MEMORY];
        try_silent(job, &good, on_disk, &tally);
        assert_true(counted.counts[FAULT_WRITE] > 0 && counted.counts[FAULT_RENAME] == 1);
        /* the folder is synced after the rename */
        assert_int_equal(counted.seen[FAULT_SYNC][FAULT_FOLDER], 1);
        assert_int_equal(counted.careless, 0);
        for (int kind = 0; kind < FAULT_KINDS; kind++)
            for (int64_t n = 1; n <= counted.counts[kind]; n++)
                for (int mode = 0; mode < FAULT_MODES; mode++)
                    if (mode < FAULT_FLIP && fault_fits((FaultKind)kind, (FaultMode)mode) &&
                        (fault_is_wanted(index++, i) ||
                         is_telling(i, (FaultKind)kind, (FaultMode)mode, n, counted.counts[kind])))
                        run_fault(job, &good, (FaultKind)kind, n, (FaultMode)mode, &tally);
        fault_tell(job->file, &tally);
        fault_add(&world.all, &tally);
        wr_free(good.bytes);
        unlink(job->file);
    }
}

/* ---- the journal of unsaved work ---- */

/* Number of journals with the work. */
static int journals(void)
{
    DIR *dir = opendir("state/journals");
    int count = 0;
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        size_t length = strlen(entry->d_name);
        if (length < 3 || strcmp(entry->d_name + length - 3, ".wj") != 0) continue;
        char path[400];
        WrJournalRead read;
        WrError err;
        snprintf(path, sizeof path, "state/journals/%s", entry->d_name);
        if (!wr_journal_read(path, &read, &err)) fail_msg("%s", err.text);
        count += read.count == 2;
        wr_journal_read_fini(&read);
    }
    if (dir) closedir(dir);
    return count;
}

/* Work in a journaled session, and save while the n-th call fails. */
static void save_journaled(FaultKind kind, int64_t n, FaultMode mode)
{
    WrError err;
    WrSessionOptions options = { .outputs = true, .journal = true };
    WrSession *session = wr_session_new(&options);
    if (!wr_session_run(session, "table 64x48", &err) || !wr_session_run(session, "fill 3", &err))
        _exit(2);
    wr_fault_arm(kind, n, mode, ENOSPC);
    bool good = wr_session_save(session, "work.exr", &err);
    wr_fault_state()->armed = 0;
    _exit(good ? 0 : 1); /* as in a crash */
}

static void a_save_that_fails_keeps_the_journal(void **state)
{
    (void)state;
    static const FaultKind kinds[] = { FAULT_WRITE, FAULT_SYNC, FAULT_RENAME, FAULT_CLOSE };
    assert_int_equal(setenv("WRINKLE_STATE", "state", 1), 0);
    for (int k = 0; k < 4; k++)
        for (int mode = FAULT_ERROR; mode <= FAULT_KILL; mode += FAULT_KILL - FAULT_ERROR) {
            pid_t child = fault_fork();
            if (child == 0) save_journaled(kinds[k], 1, (FaultMode)mode);
            int status = fault_wait(child);
            bool there = access("work.exr", F_OK) == 0;
            /* After a save the journal stays, and the report mentions it. */
            if (there != (status == 0) || (!there && journals() != 1))
                fail_msg("%s, %s: status %x, %d journals", wr_fault_kinds[kinds[k]],
                         wr_fault_modes[mode], status, journals());
            unlink("work.exr");
            assert_int_equal(system("rm -rf state"), 0);
        }
    pid_t child = fault_fork();
    if (child == 0) save_journaled(FAULT_WRITE, 0, FAULT_COUNT);
    assert_int_equal(fault_wait(child), 0);
    assert_int_equal(fault_hidden_files(), 0);
    unsetenv("WRINKLE_STATE");
    unlink("work.exr");
    assert_int_equal(system("rm -rf state"), 0);
}

/* A completed save or stroke survives a power failure: returns 0 if no data waits for a sync. */
static void work_in_safety(void)
{
    WrError err;
    WrSample samples[2] = { { .u = 0.2, .v = 0.3, .pressure = 1 },
                            { .u = 0.7, .v = 0.3, .pressure = 1 } };
    WrSessionOptions options = { .outputs = true, .journal = true };
    WrSession *session = wr_session_new(&options);
    const FaultState *state = wr_fault_state();
    bool good = wr_session_run(session, "table 64x48", &err);
    wr_fault_arm(FAULT_WRITE, 0, FAULT_COUNT, 0);
    good = good && wr_session_run(session, "fill 3", &err) &&
           wr_session_save(session, "work.exr", &err);
    if (!good || state->unsynced > 0 || state->careless > 0) _exit(2);
    good = wr_session_stroke_begin(session, "stroke radius=5", &err) &&
           wr_session_stroke_add(session, samples, 2, &err) && wr_session_stroke_end(session, &err);
    _exit(good && state->unsynced == 0 && state->careless == 0 ? 0 : 3);
}

static void what_is_saved_or_drawn_is_on_the_disk(void **state)
{
    (void)state;
    assert_int_equal(setenv("WRINKLE_STATE", "state", 1), 0);
    pid_t child = fault_fork();
    if (child == 0) work_in_safety();
    assert_int_equal(fault_wait(child), 0);
    wr_fault_state()->armed = 0;
    unsetenv("WRINKLE_STATE");
    unlink("work.exr");
    assert_int_equal(system("rm -rf state"), 0);
}

/* ---- too little space ---- */

static void no_room_by_a_limit(void **state)
{
    (void)state;
    static const size_t missing[] = { 0, 1, 2, 9, 65, 100, 513, 1000, 4096, 8192, 20000 };
    FaultTally tally = { 0 };
    int64_t index = 0;
    for (int i = 0; i < JOBS; i++) {
        const Job *job = &jobs[i];
        Good good = make_good(job);
        make_old(job);
        for (size_t k = 0; k < sizeof missing / sizeof *missing; k++) {
            if (missing[k] > good.length || (k > 1 && !fault_is_wanted(index++, i))) continue;
            char what[80];
            snprintf(what, sizeof what, "a limit %zu bytes below", missing[k]);
            pid_t child = fault_fork();
            if (child == 0) {
                const struct rlimit limit = { good.length - missing[k], good.length - missing[k] };
                setrlimit(RLIMIT_FSIZE, &limit);
                run_job(job);
            }
            int status = fault_wait(child);
            if ((missing[k] == 0) != (status == 0))
                fail_msg("%s: %s: status %x (%s)", job->line, what, status, *world.said);
            check_end(job, &good, status, &tally, what);
        }
        wr_free(good.bytes);
        unlink(job->file);
    }
    fault_tell("limits", &tally);
    fault_add(&world.all, &tally);
}

/* A disk of a few pages. False if the system does not allow mounting. */
static bool mount_disk(size_t pages)
{
    char options[64];
    snprintf(options, sizeof options, "size=%zu", pages * 4096);
    return mount("tmpfs", "disk", "tmpfs", 0, options) == 0;
}

static void no_room_on_the_disk(void **state)
{
    (void)state;
    FaultTally tally = { 0 };
    int64_t index = 0;
    assert_int_equal(mkdir("disk", 0700), 0);
    for (int i = 0; i < JOBS; i++) {
        const Job *job = &jobs[i];
        Good good = make_good(job);
        size_t pages = (good.length + 4095) / 4096;
        unlink(job->file);
        for (size_t room = 1; room <= pages + 1; room++) { /* one page holds the old file */
            bool edge = room >= pages;
            if (!edge && !fault_is_wanted(index++, i)) continue;
            if (!mount_disk(room)) {
                printf("skipped: no small disk can be mounted here (%s)\n", strerror(errno));
                rmdir("disk");
                wr_free(good.bytes);
                return;
            }
            char what[80];
            snprintf(what, sizeof what, "a disk of %zu pages for %zu and 1", room, pages);
            assert_int_equal(chdir("disk"), 0);
            if (room > 0) make_old(job);
            int status = run_clean(job);
            if ((room > pages) != (status == 0))
                fail_msg("%s: %s: status %x (%s)", job->line, what, status, *world.said);
            check_end(job, &good, status, &tally, what);
            assert_int_equal(chdir(".."), 0);
            /* a reader process may still be ending */
            assert_int_equal(umount2("disk", MNT_DETACH), 0);
        }
        wr_free(good.bytes);
    }
    assert_int_equal(rmdir("disk"), 0);
    fault_tell("disks", &tally);
    fault_add(&world.all, &tally);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_may_fail),
        cmocka_unit_test(a_save_that_fails_keeps_the_journal),
        cmocka_unit_test(what_is_saved_or_drawn_is_on_the_disk),
        cmocka_unit_test(no_room_by_a_limit),
        cmocka_unit_test(no_room_on_the_disk),
    };
    return cmocka_run_group_tests(tests, make_world, end_world);
}
