/* Sets of files (a map set, a file and its sidecar, mip levels, a contact sheet) with failing calls or kills: an
   error leaves every old file; after a kill the next program that accesses the folder makes the set all old or all
   new, without leftovers. And hostile lists of such sets. */
#include "test.h"
#include "test_folder.h"
#include "command/session_help.h"
#include "fault_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "command/session.h"
#include "image/image.h"
#include "system/process.h"

#include <dirent.h>
#include <errno.h>

#define OLD "what was there before"
#define MAX_FILES 3

/* A line, and its files. */
typedef struct Together {
    const char *line, *files[MAX_FILES + 1];
} Together;

static const Together groups[] = {
    { "maps two . name=tile", { "T_tile_N.png", "T_tile_H.png" } },
    { "maps two . name=tile contact=all.png", { "T_tile_N.png", "T_tile_H.png", "all.png" } },
    { "export height bare.r16 endian=big", { "bare.r16", "bare.r16.json" } },
    { "export bump-slopes six.exr sidecar=on", { "six.exr", "six.exr.json" } },
    { "export height level.png resize=3x2 mips=on depth=8", { "level.png", "level_1.png" } },
};
#define GROUPS (int)(sizeof groups / sizeof *groups)

static const Together *now;    /* current one */
static int count;              /* number of its files */
static char *fresh[MAX_FILES]; /* the bytes of an undisturbed run */
static size_t fresh_length[MAX_FILES];

static WrSession *session;
static char (*said)[256];

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void run_set(void)
{
    WrError err = { "" };
    const bool good = wr_session_run(session, now->line, &err);
    snprintf(*said, sizeof *said, "%.250s", err.text);
    _exit(good ? 0 : 1);
}

static int make_world(void **state)
{
    static const char *const lines[] = { "table 37x29", "grid cells=4x3", "dab 0.3,0.3 radius=9",
                                         NULL };
    if (enter_folder(state) != 0) return -1;
    char path[200];
    snprintf(path, sizeof path, "%s/config", (char *)*state);
    if (mkdir("config", 0700) || mkdir("config/wrinkle", 0700) ||
        mkdir("config/wrinkle/sets", 0700) || setenv("XDG_CONFIG_HOME", path, 1))
        return -1;
    put("config/wrinkle/sets/two.set", "normal-y T_*_N.png depth=8\nheight T_*_H.png depth=16\n");
    session = session_of(lines);
    wr_image_warm();
    wr_session_set_outputs(session, true);
    said = mmap(NULL, sizeof *said, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return said == MAP_FAILED || !wr_fault_state() ? -1 : 0;
}

static int end_world(void **state)
{
    wr_session_free(session);
    return remove_folder(state);
}

static void make_old(bool there)
{
    for (int i = 0; i < count; i++)
        if (there) put(now->files[i], OLD);
        else remove(now->files[i]);
}

static bool is_old(int i, bool there)
{
    if (!there) return access(now->files[i], F_OK) != 0;
    return fault_holds(now->files[i], OLD, sizeof OLD - 1);
}

static bool is_new(int i)
{
    return access(now->files[i], F_OK) == 0 &&
           fault_holds(now->files[i], fresh[i], fresh_length[i]);
}

static bool all_are(bool fresh_ones, bool there)
{
    bool all = true;
    for (int i = 0; i < count; i++) all = all && (fresh_ones ? is_new(i) : is_old(i, there));
    return all;
}

/* old: files existed before. */
static void run_fault(FaultKind kind, int64_t n, FaultMode mode, bool old, FaultTally *tally)
{
    make_old(old);
    pid_t child = fault_fork();
    if (child == 0) {
        wr_fault_arm(kind, n, mode, ENOSPC);
        run_set();
    }
    const int status = fault_wait(child);
    const FaultState *state = wr_fault_state();
    wr_fault_state()->armed = 0;
    tally->cases++;
    if (WIFSIGNALED(status)) {
        tally->kills[state->fell_place][state->fell_stage]++;
        /* as any process of the program does before it writes or opens a file here */
        wr_file_sweep(".");
        tally->killed_old += is_old(0, old), tally->killed_new += is_new(0);
    }
    const bool all_old = all_are(false, old), all_new = all_are(true, old);
    if (!all_old && !all_new)
        fail_msg("%s: %s %lld, %s: status %x: a mix (%s)", now->line, wr_fault_kinds[kind],
                 (long long)n, wr_fault_modes[mode], status, *said);
    if (WIFEXITED(status) && (WEXITSTATUS(status) == 0) != all_new)
        fail_msg("%s %lld, %s: status %x, and the files are the %s ones (%s)", wr_fault_kinds[kind],
                 (long long)n, wr_fault_modes[mode], status, all_new ? "new" : "old", *said);
    if (WIFEXITED(status)) WEXITSTATUS(status) ? tally->errors++ : tally->successes++;
    if (fault_hidden_files() != 0)
        fail_msg("%s %lld, %s: something stays", wr_fault_kinds[kind], (long long)n,
                 wr_fault_modes[mode]);
}

static FaultState count_calls(void)
{
    pid_t child = fault_fork();
    if (child == 0) {
        wr_fault_arm(FAULT_WRITE, 0, FAULT_COUNT, 0);
        run_set();
    }
    if (fault_wait(child) != 0) fail_msg("%s", *said);
    FaultState counted = *wr_fault_state();
    wr_fault_state()->armed = 0;
    return counted;
}

/* Frequency of the tested calls. For the first group all rename and sync calls; for others every other kill and all
 * series of failing renames; of writes a tenth. */
static void try_faults(const FaultState *counted, bool old, FaultTally *tally)
{
    for (int kind = 0; kind < FAULT_KINDS; kind++)
        for (int64_t n = 1; n <= counted->counts[kind] - (kind == FAULT_UNLINK && !old ? 1 : 0);
             n++)
            for (int mode = FAULT_ERROR; mode < FAULT_MODES; mode++) {
                const bool names = kind == FAULT_RENAME || kind == FAULT_LINK ||
                                   kind == FAULT_UNLINK || kind == FAULT_SYNC;
                if (mode != FAULT_PLANT && fault_fits((FaultKind)kind, (FaultMode)mode) &&
                    ((names && (now == groups || mode == FAULT_STUCK ||
                                (old && mode == FAULT_KILL && n % 2 == 0))) ||
                     fault_is_wanted(tally->cases + n, old)))
                    run_fault((FaultKind)kind, n, (FaultMode)mode, old, tally);
            }
}

static void try_group(const Together *group)
{
    FaultTally tally = { 0 };
    now = group;
    for (count = 0; group->files[count];) count++;
    make_old(true);
    const FaultState counted = count_calls();
    for (int i = 0; i < count; i++) fault_read_whole(group->files[i], &fresh[i], &fresh_length[i]);
    assert_int_equal(counted.counts[FAULT_RENAME], count);
    assert_int_equal(counted.careless, 0);
    /* the files, their list, the folder twice */
    assert_int_equal(counted.counts[FAULT_SYNC], count + 3);
    for (int old = 0; old < 2; old++) try_faults(&counted, old, &tally);
    fault_tell(group->files[0], &tally);
    assert_true(tally.killed_old > 0 && tally.killed_new > 0);
    if (group == groups) assert_true(tally.errors > 0);
    make_old(false);
    for (int i = 0; i < count; i++) wr_free(fresh[i]);
}

static void what_belongs_together_is_all_old_or_all_new(void **state)
{
    (void)state;
    for (int g = 0; g < GROUPS; g++) try_group(&groups[g]);
}

/* ---- lists ---- */

/* Create the list of an ended process, with one waiting file. */
static void plant(long process, const char *list, const char *temporary)
{
    char name[120], text[300];
    const unsigned host = (unsigned)wr_file_host();
    snprintf(name, sizeof name, ".x.%ld-%08x-00000000000000aa.part.png", process, host);
    put(name, "fresh");
    snprintf(text, sizeof text, list, temporary ? temporary : name);
    snprintf(name, sizeof name, ".files.%ld-%08x-00000000000000bb.part.together", process, host);
    put(name, text);
}

static long dead_process(void)
{
    pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, NULL, 0);
    return child;
}

#define FIRST "files that belong together\n"

static void a_list_is_followed_only_where_it_is_whole_and_of_its_folder(void **state)
{
    (void)state;
    const struct {
        const char *list, *temporary;
        bool taken;
    } lists[] = {
        /* truncated */
        { FIRST "%s/x.png\n/\n", NULL, true },      { FIRST "%s/x.png\n", NULL, false },
        { "%s/x.png\n/\n", NULL, false },           /* no first line */
        { FIRST "%s/../x.png\n/\n", NULL, false },  /* another folder */
        { FIRST "%s/sub/x.png\n/\n", NULL, false }, /* another folder */
        { FIRST "%s/x.png\n/\n", "kept", false },   /* a file that is not waiting */
        { FIRST "%s/.\n/\n", NULL, false },         { FIRST "%s\n/\n", NULL, false },
    };
    assert_int_equal(mkdir("lists", 0777), 0);
    assert_int_equal(chdir("lists"), 0); /* so that the folder above belongs to the test too */
    assert_int_equal(mkdir("sub", 0777), 0);
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        put("x.png", OLD);
        put("kept", "kept");
        plant(dead_process(), lists[i].list, lists[i].temporary);
        wr_file_sweep(".");
        if (fault_holds("x.png", "fresh", 5) != lists[i].taken) fail_msg("list %zu", i);
        assert_true(fault_holds("kept", "kept", 4));
        assert_int_equal(access("../x.png", F_OK), -1);
        assert_int_equal(access("sub/x.png", F_OK), -1);
        if (fault_hidden_files() != 0) fail_msg("list %zu: something stays", i);
    }
}

static void a_list_of_a_process_that_lives_is_left_alone(void **state)
{
    (void)state;
    put("x.png", OLD);
    plant((long)wr_process_id(), FIRST "%s/x.png\n/\n", NULL);
    wr_file_sweep(".");
    assert_true(fault_holds("x.png", OLD, sizeof OLD - 1));
    assert_int_equal(fault_hidden_files(), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_belongs_together_is_all_old_or_all_new),
        cmocka_unit_test(a_list_is_followed_only_where_it_is_whole_and_of_its_folder),
        cmocka_unit_test(a_list_of_a_process_that_lives_is_left_alone),
    };
    return cmocka_run_group_tests(tests, make_world, end_world);
}
