/* The journal with failing calls and kills during its start, its lines, its compaction into snapshots and its end.
   Reading it back yields every command up to the last one in progress or finished; a journal that failed once becomes
   safe again. Kills at every call; a tenth in every run, all with WR_FULL=1. */
#include "test.h"
#include "fault_help.h"
#include "document/journal_help.h"

#include "base/error.h"
#include "document/document.h"
#include "base/hash.h"
#include "document/document_file.h"
#include "image/oiio.h"

#include <errno.h>

#define COMMANDS 14
#define COMPACT 5 /* commands between snapshots */

typedef struct Shared {
    int begun, ended; /* commands */
    int closed;       /* the journal ended while safe */
} Shared;

static Shared *shared;

/* A journal that claims to be safe must exist under its name. */
static void must_be_there(const WrJournal *journal)
{
    if (wr_journal_state(journal).safe && access(wr_journal_path(journal), F_OK) != 0) _exit(5);
}

/* Restart the journal from a snapshot after `count` commands. */
static bool restart(WrJournal *journal, const WrDocument *document, int count)
{
    WrText path = { 0 };
    WrError err;
    bool good = wr_journal_snapshot_path(journal, &path, &err) &&
                wr_document_save(document, "", wr_text_get(&path), NULL, &err);
    WrJournalStart start = { .kind = WR_JOURNAL_SNAPSHOT,
                             .hash = { (uint64_t)count, 1 },
                             .snapshot = wr_text_get(&path) };
    good = good && wr_journal_restart(journal, &start, &err);
    must_be_there(journal);
    if (!good) wr_journal_put_off(journal);
    wr_text_fini(&path);
    return good;
}

/* Upkeep between two commands, as in a session. */
static void tend(WrJournal *journal, const WrDocument *document, int count)
{
    if (wr_journal_state(journal).want != WR_JOURNAL_WANT_NOTHING)
        restart(journal, document, count);
}

/* Copy a file into the journal's folder: complete, or refused. */
static void keep(WrJournal *journal, const char *folder)
{
    WrText file = { 0 }, copy = { 0 };
    char hex[65];
    wr_text_addf(&file, "%s.kept.png", folder);
    wr_sha256_bytes("pixels", 6, hex);
    const char *path = wr_text_get(&file);
    if (wr_journal_keep_file(journal, path, hex, NULL) &&
        !(wr_journal_find_input_copy(wr_journal_path(journal), hex, path, &copy, NULL) &&
          wr_file_peek(wr_text_get(&copy), hex, 6) == 6 && memcmp(hex, "pixels", 6) == 0))
        _exit(4);
    wr_text_fini(&file);
    wr_text_fini(&copy);
}

static void run_journal(const char *folder)
{
    WrDocument *document = wr_document_new();
    WrJournalOptions options = { .folder = folder, .sync_seconds = 1e-9, .retry_seconds = 1e-9 };
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY, .hash = { 0, 1 } };
    WrJournal *journal = wr_journal_begin(&options, &start);
    must_be_there(journal);
    keep(journal, folder);
    for (int i = 1; i <= COMMANDS; i++) {
        char line[32];
        WrHash hash = { (uint64_t)i, 1 };
        shared->begun = i;
        snprintf(line, sizeof line, "fill %d", i);
        wr_journal_command(journal, line, NULL);
        wr_journal_done(journal, WR_JOURNAL_OK, &hash, NULL);
        shared->ended = i;
        tend(journal, document, i);
        if (i % COMPACT == 0) restart(journal, document, i);
    }
    /* If the fault has just occurred, the next commands make the journal try again. */
    for (int i = 0; i < 3 && !wr_journal_state(journal).safe; i++) {
        wr_journal_note(journal, "", NULL);
        restart(journal, document, COMMANDS);
    }
    shared->closed = wr_journal_state(journal).safe;
    wr_journal_leave(journal);
    wr_document_free(document);
    _exit(0);
}

/* The only journal in a folder, or NULL. */
static char *find_journal(const char *folder)
{
    char *found = NULL;
    DIR *dir = opendir(folder);
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        size_t length = strlen(entry->d_name);
        if (entry->d_name[0] == '.' || length < 3 || strcmp(entry->d_name + length - 3, ".wj") != 0)
            continue;
        if (found) fail_msg("two journals");
        found = wr_path_join(folder, entry->d_name);
    }
    if (dir) closedir(dir);
    return found;
}

/* The snapshot at a journal's start is a complete document. */
static void check_snapshot(const char *path, const char *what)
{
    WrLoaded loaded;
    WrError err;
    int64_t replaced;
    if (!wr_document_load(path, &loaded, &replaced, &err)) fail_msg("%s: %s", what, err.text);
    wr_document_free(loaded.document);
    wr_image_free(loaded.pictures[0][WR_OBJECT_COLOUR]);
    wr_free(loaded.scene_text);
}

/* Number of commands in a recovery; -1: there is no journal. *gap: it reports missing ones. */
static int commands_in(const char *folder, bool *gap, const char *what)
{
    WrJournalRead read = { 0 };
    WrError err;
    char *path = find_journal(folder);
    *gap = false;
    if (!path) return -1;
    if (!wr_journal_read(path, &read, &err)) fail_msg("%s: %s", what, err.text);
    int base = 0;
    if (read.start.kind == WR_JOURNAL_SNAPSHOT) {
        base = (int)read.start.hash.low;
        check_snapshot(read.start.snapshot, what);
    }
    for (int i = 0; i < read.count; i++) {
        char want[32];
        snprintf(want, sizeof want, "fill %d", base + i + 1);
        if (strcmp(read.lines[i].text, want) != 0)
            fail_msg("%s: '%s', not '%s'", what, read.lines[i].text, want);
    }
    *gap = read.gap[0] != '\0';
    int count = base + read.count;
    wr_journal_read_fini(&read);
    wr_free(path);
    return count;
}

static void check(const char *folder, int status, const char *what, FaultTally *tally)
{
    bool gap;
    int have = commands_in(folder, &gap, what);
    tally->cases++;
    if (WIFSIGNALED(status)) {
        if (WTERMSIG(status) != SIGKILL) fail_msg("%s: signal %d", what, WTERMSIG(status));
        tally->kills[wr_fault_state()->fell_place][wr_fault_state()->fell_stage]++;
        if (have < 0 ? shared->begun > 1 : have != shared->ended && have != shared->begun)
            fail_msg("%s: %d commands are kept, %d begun, %d ended", what, have, shared->begun,
                     shared->ended);
        if (have == shared->begun) tally->killed_new++;
        else tally->killed_old++;
        return;
    }
    assert_int_equal(status, 0);
    tally->successes++;
    if (!shared->closed) fail_msg("%s: the journal did not come back to be safe", what);
    if (have != COMMANDS || gap) fail_msg("%s: %d of %d commands are kept", what, have, COMMANDS);
}

static int run_case(const char *folder, FaultKind kind, int64_t n, FaultMode mode)
{
    static const int errors[] = { ENOSPC, EIO, EDQUOT };
    WrText victim = { 0 };
    wr_text_addf(&victim, "%s.victim", folder); /* a file that no test refers to */
    write_bytes(wr_text_get(&victim), "whole", 5);
    remove_tree(folder);
    *shared = (Shared){ 0 };
    pid_t child = fault_fork();
    if (child == 0) {
        wr_fault_arm(kind, n, mode, errors[n % 3]);
        snprintf(wr_fault_state()->victim, sizeof wr_fault_state()->victim, "%s",
                 wr_text_get(&victim));
        run_journal(folder);
    }
    int status = fault_wait(child);
    FaultState *state = wr_fault_state();
    state->armed = 0;
    WrText left = read_bytes(wr_text_get(&victim));
    if (strcmp(wr_text_get(&left), "whole") != 0)
        fail_msg("%s %d: another file was written to", wr_fault_kinds[kind], (int)n);
    if (state->careless) fail_msg("%s %d: renamed unsynced", wr_fault_kinds[kind], (int)n);
    wr_text_fini(&left);
    wr_text_fini(&victim);
    return status;
}

static void the_journal_recovers_whatever_fails(void **state)
{
    char *folder = in(*state, "journals"), *kept = in(*state, "journals.kept.png");
    write_bytes(kept, "pixels", 6);
    wr_free(kept);
    FaultTally tally = { 0 };
    int64_t index = 0;
    assert_int_equal(run_case(folder, FAULT_WRITE, 0, FAULT_COUNT), 0);
    FaultState counted = *wr_fault_state();
    check(folder, 0, "no fault", &tally);
    assert_true(counted.counts[FAULT_RENAME] >= 2 && counted.counts[FAULT_OPEN] >= 4 &&
                counted.counts[FAULT_SYNC] > COMMANDS);
    for (int kind = 0; kind < FAULT_KINDS; kind++)
        for (int64_t n = 1; n <= counted.counts[kind]; n++)
            for (int mode = 0; mode < FAULT_MODES; mode++) {
                char what[80];
                /* A journal is read only after a crash; a line with a wrong checksum ends the recovery. It becomes
                   safe again when the disk works. */
                if (mode == FAULT_FLIP || mode == FAULT_DROP || mode == FAULT_STUCK ||
                    !fault_fits((FaultKind)kind, (FaultMode)mode) ||
                    (!fault_is_wanted(index++, 0) && mode != FAULT_PLANT && kind != FAULT_RENAME))
                    continue;
                snprintf(what, sizeof what, "%s %lld, %s", wr_fault_kinds[kind], (long long)n,
                         wr_fault_modes[mode]);
                check(folder, run_case(folder, (FaultKind)kind, n, (FaultMode)mode), what, &tally);
            }
    fault_tell("journal", &tally);
    wr_free(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_journal_recovers_whatever_fails, make_place,
                                        remove_place),
    };
    shared = shared_memory(sizeof *shared);
    wr_image_warm();
    if (!wr_oiio(NULL) || !wr_fault_state()) return 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
