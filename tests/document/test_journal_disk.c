/* The journal when the disk is full, the folder is gone, or writing is forbidden: reported once, harmless, and
   recoverable. */
#include "test.h"
#include "journal_help.h"

#include "base/error.h"

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

typedef struct Reports {
    int count;
    char last[512];
} Reports;

static void hear_report(void *ctx, const char *text)
{
    Reports *reports = ctx;
    reports->count++;
    snprintf(reports->last, sizeof reports->last, "%s", text);
}

static WrJournal *begin_reporting(const char *folder, Reports *reports)
{
    WrJournalOptions options = { .folder = folder,
                                 .sync_seconds = -1,
                                 .retry_seconds = 0.01,
                                 .report = hear_report,
                                 .ctx = reports };
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY };
    return wr_journal_begin(&options, &start);
}

/* Append numbered commands of about 1 KB until one fails; returns the number of written ones. -1: none failed. */
static int write_until_full(WrJournal *journal, WrError *err)
{
    char text[1024];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    for (int i = 0; i < 5000; i++) {
        int digits = snprintf(text, sizeof text, "%d", i);
        text[digits] = ' ';
        if (!wr_journal_command(journal, text, err)) return i;
        if (!wr_journal_done(journal, WR_JOURNAL_OK, NULL, err)) return i + 1;
    }
    return -1;
}

/* Retry until the journal requests a fresh start; false if it never does. */
static bool asks_for_all(WrJournal *journal)
{
    for (int i = 0; i < 25; i++) {
        sleep_seconds(0.011);
        wr_journal_command(journal, "lost", NULL);
        wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
        if (wr_journal_state(journal).want == WR_JOURNAL_WANT_WHOLE) return true;
    }
    return false;
}

/* Write a snapshot and restart from it, as a session does. */
static bool restart_from_snapshot(WrJournal *journal)
{
    WrText path = { 0 };
    bool ok = wr_journal_snapshot_path(journal, &path, NULL) &&
              wr_file_write(wr_text_get(&path), "heights", 7, NULL);
    WrJournalStart start = { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = wr_text_get(&path) };
    ok = ok && wr_journal_restart(journal, &start, NULL);
    wr_text_fini(&path);
    return ok;
}

/* The journal holds exactly the commands 0 .. count-1 and reports the gap. */
static int check_prefix(const WrJournal *journal, int count)
{
    WrJournalRead read;
    CHECK(wr_journal_read(wr_journal_path(journal), &read, NULL));
    CHECK(read.count == count && read.dropped_bytes == 0 && !*read.damage);
    for (int i = 0; i < count; i++) CHECK(atoi(read.lines[i].text) == i);
    wr_journal_read_fini(&read);
    return 0;
}

/* Checks after the failure, and after space is available again, for every kind of full disk. */
static int check_failed(WrJournal *journal, const Reports *reports, int written)
{
    WrError err = { "" };
    CHECK(reports->count == 1 && strstr(reports->last, "not safe"));
    CHECK(!wr_journal_state(journal).safe && *wr_journal_state(journal).reason);
    CHECK(!wr_journal_command(journal, "lost", &err) && strstr(err.text, "not safe"));
    CHECK(!wr_journal_done(journal, WR_JOURNAL_OK, NULL, &err));
    CHECK(!wr_journal_sync(journal, &err));
    CHECK(!asks_for_all(journal));
    CHECK(reports->count == 1);
    return check_prefix(journal, written);
}

static int check_recovered(WrJournal *journal, const Reports *reports, int written)
{
    WrJournalRead read;
    CHECK(asks_for_all(journal));
    CHECK(check_prefix(journal, written) == 0); /* no half-written record */
    CHECK(wr_journal_read(wr_journal_path(journal), &read, NULL));
    CHECK(*read.gap);
    wr_journal_read_fini(&read);
    CHECK(restart_from_snapshot(journal));
    CHECK(wr_journal_state(journal).safe && !*wr_journal_state(journal).reason);
    CHECK(reports->count == 2 && strstr(reports->last, "safe again"));
    CHECK(wr_journal_command(journal, "new", NULL));
    CHECK(wr_journal_read(wr_journal_path(journal), &read, NULL));
    CHECK(read.start.kind == WR_JOURNAL_SNAPSHOT && read.count == 1 && !*read.gap);
    CHECK(exists(read.start.snapshot) && strcmp(read.lines[0].text, "new") == 0);
    wr_journal_read_fini(&read);
    return 0;
}

static int fill_a_small_disk(const char *place)
{
    Reports reports = { 0 };
    WrError err = { "" };
    char *disk = in(place, "disk"), *filler = in(disk, "filler"), *folder = in(disk, "journals");
    char block[65536] = { 0 };
    if (mkdir(disk, 0700) != 0 || unshare(CLONE_NEWNS) != 0 ||
        mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) != 0 ||
        mount("tmpfs", disk, "tmpfs", 0, "size=1m") != 0)
        return 77;
    FILE *file = fopen(filler, "wb");
    for (int i = 0; i < 14; i++) CHECK(fwrite(block, sizeof block, 1, file) == 1);
    CHECK(fclose(file) == 0);
    WrJournal *journal = begin_reporting(folder, &reports);
    int written = write_until_full(journal, &err);
    CHECK(written > 50 && strstr(err.text, "No space left"));
    int line = check_failed(journal, &reports, written);
    if (line) return line;
    CHECK(unlink(filler) == 0);
    line = check_recovered(journal, &reports, written);
    if (line) return line;
    wr_journal_finish(journal);
    CHECK(count_entries(folder) == 0);
    wr_free(disk), wr_free(filler), wr_free(folder);
    return 0;
}

static int reach_a_size_limit(const char *place)
{
    Reports reports = { 0 };
    WrError err = { "" };
    struct sigaction action = { .sa_handler = SIG_DFL };
    struct rlimit limit;
    char *folder = in(place, "journals");
    CHECK(sigaction(SIGXFSZ, &action, NULL) == 0); /* the default action would kill */
    WrJournal *journal = begin_reporting(folder, &reports);
    CHECK(getrlimit(RLIMIT_FSIZE, &limit) == 0);
    rlim_t before = limit.rlim_cur;
    limit.rlim_cur = 20000;
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    int written = write_until_full(journal, &err);
    CHECK(written >= 15 && written <= 20 && strstr(err.text, "File too large"));
    int line = check_failed(journal, &reports, written);
    if (line) return line;
    limit.rlim_cur = before;
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    line = check_recovered(journal, &reports, written);
    if (line) return line;
    wr_journal_finish(journal);
    CHECK(count_entries(folder) == 0);
    wr_free(folder);
    return 0;
}

static int begin_where_nobody_may_write(const char *place)
{
    Reports reports = { 0 };
    char *locked = in(place, "locked"), *folder = in(locked, "journals");
    CHECK(chmod(place, 0755) == 0 && mkdir(locked, 0555) == 0);
    if (getuid() == 0) CHECK(setegid(65534) == 0 && seteuid(65534) == 0);
    WrJournal *journal = begin_reporting(folder, &reports);
    CHECK(reports.count == 1 && strstr(reports.last, "Permission denied"));
    CHECK(!wr_journal_state(journal).safe && !asks_for_all(journal));
    WrText path = { 0 };
    WrError err = { "" };
    CHECK(!wr_journal_snapshot_path(journal, &path, &err) && strstr(err.text, "Permission denied"));
    CHECK(!restart_from_snapshot(journal) && reports.count == 1);
    wr_journal_finish(journal);
    if (getuid() == 0) CHECK(seteuid(0) == 0);
    wr_free(locked), wr_free(folder);
    return 0;
}

static void a_full_disk_is_reported_once_harms_nothing_and_is_overcome(void **state)
{
    if (run_apart(fill_a_small_disk, *state) == 77) skip(); /* only root may mount */
}

static void a_size_limit_does_not_kill_and_is_overcome(void **state)
{
    run_apart(reach_a_size_limit, *state);
}

static void a_folder_that_cannot_be_written_is_reported(void **state)
{
    run_apart(begin_where_nobody_may_write, *state);
}

static void a_folder_that_can_be_written_later_is_used_then(void **state)
{
    Reports reports = { 0 };
    char *folder = in(*state, "state/journals"), *above = in(*state, "state");
    write_bytes(above, "a file", 6); /* in place of the folder */
    WrJournal *journal = begin_reporting(folder, &reports);
    assert_int_equal(reports.count, 1);
    assert_false(asks_for_all(journal));
    unlink(above);
    assert_true(asks_for_all(journal));
    assert_true(restart_from_snapshot(journal));
    assert_true(wr_journal_state(journal).safe && reports.count == 2);
    wr_journal_finish(journal);
    assert_int_equal(count_entries(folder), 0);
    wr_free(folder), wr_free(above);
}

static void a_folder_that_vanishes_is_noticed_and_made_again(void **state)
{
    Reports reports = { 0 };
    WrError err = { "" };
    char *folder = in(*state, "journals");
    WrJournal *journal = begin_reporting(folder, &reports);
    assert_true(wr_journal_command(journal, "a", NULL));
    remove_tree(folder);
    assert_false(wr_journal_done(journal, WR_JOURNAL_OK, NULL, &err));
    assert_non_null(strstr(err.text, "removed"));
    assert_int_equal(reports.count, 1);
    assert_true(asks_for_all(journal) && restart_from_snapshot(journal));
    assert_true(wr_journal_command(journal, "b", NULL) && exists(wr_journal_path(journal)));
    wr_journal_finish(journal);
    assert_int_equal(count_entries(folder), 0);
    wr_free(folder);
}

static void a_journal_that_is_moved_away_is_noticed_at_the_next_sync(void **state)
{
    Reports reports = { 0 };
    WrError err = { "" };
    char *away = in(*state, "away.wj");
    WrJournal *journal = begin_reporting(*state, &reports);
    assert_true(wr_journal_sync(journal, &err));
    assert_int_equal(rename(wr_journal_path(journal), away), 0);
    assert_false(wr_journal_sync(journal, &err));
    assert_non_null(strstr(err.text, "moved"));
    assert_true(asks_for_all(journal) && restart_from_snapshot(journal));
    wr_journal_finish(journal);
    /* the moved file no longer belongs to the journal */
    assert_int_equal(count_entries(*state), 1);
    wr_free(away);
}

/* A new file under its name belongs to another program: neither synced nor removed. */
static void another_file_of_its_name_is_not_taken_for_it(void **state)
{
    Reports reports = { 0 };
    WrError err = { "" };
    char *away = in(*state, "away.wj");
    WrJournal *journal = begin_reporting(*state, &reports);
    char *path = wr_strdup(wr_journal_path(journal));
    assert_int_equal(rename(path, away), 0);
    write_bytes(path, "other", 5);
    assert_false(wr_journal_sync(journal, &err));
    assert_non_null(strstr(err.text, "moved"));
    wr_journal_finish(journal);
    WrText left = read_bytes(path);
    assert_string_equal(wr_text_get(&left), "other");
    wr_text_fini(&left);
    wr_free(path), wr_free(away);
}

/* A sync is detected by its discovery that the file was moved; writing alone does not discover it. */
static void lines_are_synced_by_themselves_as_often_as_was_asked(void **state)
{
    char *away = in(*state, "away.wj");
    const double seconds[] = { 0.02, -1 };
    for (int i = 0; i < 2; i++) {
        WrJournalOptions options = { .folder = *state, .sync_seconds = seconds[i] };
        WrJournal *journal = wr_journal_begin(&options, &(WrJournalStart){ .path = "/a" });
        assert_int_equal(rename(wr_journal_path(journal), away), 0);
        sleep_seconds(0.03);
        assert_int_equal(wr_journal_note(journal, "due", NULL), seconds[i] < 0);
        wr_journal_finish(journal);
    }
    wr_free(away);
}

static void a_restart_that_fails_changes_nothing(void **state)
{
    Reports reports = { 0 };
    WrError err = { "" };
    WrText path = { 0 };
    WrJournalRead read;
    WrJournal *journal = begin_reporting(*state, &reports);
    wr_journal_command(journal, "a", NULL);
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY };
    assert_false(wr_journal_restart(journal, &start, &err)); /* "a" is running */
    assert_non_null(strstr(err.text, "while a command runs"));
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    assert_true(wr_journal_snapshot_path(journal, &path, &err));
    char *files = wr_path_folder(wr_text_get(&path)), *deeper = in(files, "deeper");
    char *inner = in(deeper, "snapshot-1.exr");
    assert_int_equal(mkdir(deeper, 0700), 0);
    write_bytes(inner, "x", 1);
    const WrJournalStart bad[] = {
        { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = inner },
        { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = wr_text_get(&path) }, /* was not written */
        { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = "/etc/passwd" },
        { .kind = WR_JOURNAL_SNAPSHOT },
        { .kind = WR_JOURNAL_DOCUMENT },
        { .kind = WR_JOURNAL_DOCUMENT, .path = "/a.exr", .sha256 = "12" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(wr_journal_restart(journal, &bad[i], &err));
    assert_true(wr_journal_command(journal, "b", NULL) && wr_journal_state(journal).safe);
    assert_true(wr_journal_read(wr_journal_path(journal), &read, NULL));
    assert_true(read.count == 2 && read.start.kind == WR_JOURNAL_EMPTY && reports.count == 0);
    wr_journal_read_fini(&read);
    wr_text_fini(&path);
    remove_tree(deeper);
    wr_free(files), wr_free(deeper), wr_free(inner);
    wr_journal_finish(journal);
}

static void a_long_journal_asks_to_be_shortened(void **state)
{
    WrJournalOptions options = { .folder = *state, .max_lines = 9, .sync_seconds = -1 };
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY };
    WrJournal *journal = wr_journal_begin(&options, &start);
    for (int i = 0; i < 4; i++) { /* header and 4 * 2 lines: not over 9 */
        wr_journal_command(journal, "a", NULL);
        wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    }
    assert_int_equal(wr_journal_state(journal).want, WR_JOURNAL_WANT_NOTHING);
    assert_int_equal(wr_journal_state(journal).commands, 4);
    wr_journal_command(journal, "a", NULL);
    assert_int_equal(wr_journal_state(journal).want, WR_JOURNAL_WANT_NOTHING); /* busy */
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    assert_int_equal(wr_journal_state(journal).want, WR_JOURNAL_WANT_SHORTER);
    wr_journal_put_off(journal);
    assert_int_equal(wr_journal_state(journal).want, WR_JOURNAL_WANT_NOTHING);
    assert_true(wr_journal_command(journal, "a", NULL)); /* continues all the same */
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    assert_true(restart_from_snapshot(journal));
    assert_int_equal(wr_journal_state(journal).lines, 1);
    assert_int_equal(wr_journal_state(journal).commands, 0);
    wr_journal_finish(journal);

    options = (WrJournalOptions){ .folder = *state, .max_bytes = 1000, .sync_seconds = -1 };
    journal = wr_journal_begin(&options, &start);
    while (wr_journal_state(journal).bytes <= 1000) {
        assert_int_equal(wr_journal_state(journal).want, WR_JOURNAL_WANT_NOTHING);
        wr_journal_note(journal, "some bytes", NULL);
    }
    assert_int_equal(wr_journal_state(journal).want, WR_JOURNAL_WANT_SHORTER);
    wr_journal_finish(journal);
}

static void journals_are_private_and_made_where_the_environment_says(void **state)
{
    struct stat info;
    WrText path = { 0 };
    char *own = in(*state, "own"), *xdg = in(*state, "xdg"), *home = in(*state, "home");
    setenv("HOME", home, 1);
    setenv("XDG_STATE_HOME", "relative/is/ignored", 1);
    unsetenv("WRINKLE_STATE");
    assert_true(wr_journal_folder(&path, NULL));
    assert_non_null(strstr(wr_text_get(&path), "/home/.local/state/wrinkle/journals"));
    setenv("XDG_STATE_HOME", xdg, 1);
    wr_text_clear(&path);
    assert_true(wr_journal_folder(&path, NULL));
    assert_non_null(strstr(wr_text_get(&path), "/xdg/wrinkle/journals"));
    setenv("WRINKLE_STATE", own, 1);
    wr_text_clear(&path);
    assert_true(wr_journal_folder(&path, NULL));
    assert_non_null(strstr(wr_text_get(&path), "/own/journals"));
    mode_t mask = umask(0);
    WrJournal *journal = begin_at(NULL);
    umask(mask);
    assert_memory_equal(wr_journal_path(journal), wr_text_get(&path), path.length);
    assert_true(stat(own, &info) == 0 && (info.st_mode & 07777) == 0700);
    assert_true(stat(wr_text_get(&path), &info) == 0 && (info.st_mode & 07777) == 0700);
    assert_true(stat(wr_journal_path(journal), &info) == 0 && (info.st_mode & 07777) == 0600);
    wr_journal_finish(journal);
    wr_text_fini(&path);
    wr_free(own), wr_free(xdg), wr_free(home);
}

static void relative_document_paths_are_stored_as_absolute_ones(void **state)
{
    WrJournalOptions options = { .folder = *state };
    WrJournalStart start = { .kind = WR_JOURNAL_DOCUMENT, .path = "some/a.exr" };
    WrJournal *journal = wr_journal_begin(&options, &start);
    WrJournalRead read;
    char here[4096];
    assert_non_null(getcwd(here, sizeof here - 20));
    strcat(here, "/some/a.exr");
    assert_true(wr_journal_read(wr_journal_path(journal), &read, NULL));
    assert_string_equal(read.start.path, here);
    wr_journal_read_fini(&read);
    wr_journal_finish(journal);
}

int main(void)
{
#define PLACED(test) cmocka_unit_test_setup_teardown(test, make_place, remove_place)
    const struct CMUnitTest tests[] = {
        PLACED(a_full_disk_is_reported_once_harms_nothing_and_is_overcome),
        PLACED(a_size_limit_does_not_kill_and_is_overcome),
        PLACED(a_folder_that_cannot_be_written_is_reported),
        PLACED(a_folder_that_can_be_written_later_is_used_then),
        PLACED(a_folder_that_vanishes_is_noticed_and_made_again),
        PLACED(a_journal_that_is_moved_away_is_noticed_at_the_next_sync),
        PLACED(another_file_of_its_name_is_not_taken_for_it),
        PLACED(lines_are_synced_by_themselves_as_often_as_was_asked),
        PLACED(a_restart_that_fails_changes_nothing),
        PLACED(a_long_journal_asks_to_be_shortened),
        PLACED(journals_are_private_and_made_where_the_environment_says),
        PLACED(relative_document_paths_are_stored_as_absolute_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
