/* Journals left by ended programs: list, locks, kept files, leftovers, test runs. */
#include "test.h"
#include "journal_help.h"

#include "base/error.h"
#include "document/recovery_journal.h"

#include <fcntl.h>
#include <sys/file.h>

/* ---- who holds a journal ---- */

/* A child that begins a journal, reports its path, and waits to be killed. */
static pid_t hold_elsewhere(const char *folder, char *path, volatile long *ready)
{
    pid_t child = fork_bound();
    if (child != 0) return child;
    WrJournal *journal = begin_at(folder);
    wr_journal_command(journal, "a", NULL);
    snprintf(path, 500, "%s", wr_journal_path(journal));
    *ready = 1;
    for (;;) pause();
}

static void a_journal_in_use_is_neither_listed_nor_claimed_until_its_program_dies(void **state)
{
    char *memory = shared_memory(1024);
    volatile long *ready = (volatile long *)(void *)memory;
    char *path = memory + 64;
    WrJournalList list;
    WrError err = { "" };
    pid_t child = hold_elsewhere(*state, path, ready);
    await(ready, 1);
    assert_true(wr_journal_list(*state, &list, &err));
    assert_int_equal(list.count, 0);
    wr_journal_list_fini(&list);
    assert_null(wr_journal_claim(path, &err));
    assert_non_null(strstr(err.text, "in use"));
    kill_child(child);
    assert_true(wr_journal_list(*state, &list, &err));
    assert_int_equal(list.count, 1);
    assert_string_equal(list.entries[0].path, path);
    assert_true(list.entries[0].unfinished && list.entries[0].complete == 0);
    wr_journal_list_fini(&list);
    WrJournalClaim *claim = wr_journal_claim(path, &err);
    assert_non_null(claim);
    assert_true(wr_journal_list(*state, &list, &err)); /* now locked by this process */
    assert_int_equal(list.count, 0);
    wr_journal_list_fini(&list);
    char *files = files_of(path), *copy = in(files, "copy");
    assert_int_equal(mkdir(files, 0700), 0);
    write_bytes(copy, "x", 1);
    assert_true(wr_journal_claim_remove(claim, &err));
    assert_int_equal(count_entries(*state), 0); /* its files are removed with it */
    wr_free(files), wr_free(copy);
    munmap(memory, 1024);
}

typedef struct Race {
    volatile long ready, go, won, tried;
} Race;

static void a_journal_is_claimed_by_one_of_several_programs(void **state)
{
    Race *race = shared_memory(sizeof *race);
    WrJournal *journal = begin_at(*state);
    char *path = wr_strdup(wr_journal_path(journal));
    wr_journal_leave(journal);
    for (int round = 0; round < 10; round++) {
        pid_t children[4];
        *race = (Race){ 0 };
        for (int i = 0; i < 4; i++) {
            children[i] = fork_bound();
            if (children[i] != 0) continue;
            __atomic_add_fetch(&race->ready, 1, __ATOMIC_SEQ_CST);
            while (!race->go) sleep_seconds(0.0001);
            if (wr_journal_claim(path, NULL)) __atomic_add_fetch(&race->won, 1, __ATOMIC_SEQ_CST);
            __atomic_add_fetch(&race->tried, 1, __ATOMIC_SEQ_CST);
            for (;;) pause();
        }
        await(&race->ready, 4);
        race->go = 1;
        await(&race->tried, 4);
        assert_int_equal(race->won, 1);
        for (int i = 0; i < 4; i++) kill_child(children[i]);
    }
    wr_free(path);
    munmap(race, sizeof *race);
}

/* Between opening and locking, its name may have passed to another file. */
static void a_lock_on_a_file_that_lost_its_name_is_none(void **state)
{
    char *path = in(*state, "a.wj"), *other = in(*state, "b.wj");
    write_bytes(path, "old", 3);
    write_bytes(other, "new", 3);
    int fd = wr_journal_open(path, NULL);
    assert_true(wr_journal_lock(fd, path, LOCK_SH));
    assert_int_equal(rename(other, path), 0);
    assert_false(wr_journal_lock(fd, path, LOCK_EX));
    close(fd);
    wr_free(path), wr_free(other);
}

static void a_journal_that_restarts_stays_held(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrJournalList list;
    for (int i = 0; i < 5; i++) {
        assert_true(
            wr_journal_restart(journal, &(WrJournalStart){ .kind = WR_JOURNAL_EMPTY }, NULL));
        assert_null(wr_journal_claim(wr_journal_path(journal), NULL));
        assert_true(wr_journal_list(*state, &list, NULL));
        assert_int_equal(list.count, 0);
        wr_journal_list_fini(&list);
    }
    wr_journal_finish(journal);
    assert_int_equal(count_entries(*state), 0);
}

/* ---- listing ---- */

static void leave_at(const char *folder, const WrJournalStart *start, int commands, bool last_open,
                     int64_t written)
{
    WrJournalOptions options = { .folder = folder, .sync_seconds = -1 };
    WrJournal *journal = wr_journal_begin(&options, start);
    char *path = wr_strdup(wr_journal_path(journal));
    for (int i = 0; i < commands; i++) {
        wr_journal_command(journal, "a", NULL);
        if (i < commands - 1 || !last_open) wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    }
    wr_journal_leave(journal);
    struct timespec times[2] = { { .tv_sec = written }, { .tv_sec = written } };
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
    wr_free(path);
}

static void a_listing_tells_what_there_is_to_recover_newest_first(void **state)
{
    WrJournalList list;
    WrJournalStart empty = { .kind = WR_JOURNAL_EMPTY };
    WrJournalStart document = { .kind = WR_JOURNAL_DOCUMENT, .path = "/home/x/a.exr" };
    int64_t then = (int64_t)time(NULL) - 80000; /* not a day ago */
    leave_at(*state, &empty, 0, false, then + 1000);
    leave_at(*state, &document, 3, false, then + 3000);
    leave_at(*state, &empty, 5, true, then + 2000);
    assert_true(wr_journal_list(*state, &list, NULL));
    assert_int_equal(list.count, 3);
    const WrJournalEntry *e = list.entries;
    assert_true(e[0].written == then + 3000 && e[1].written == then + 2000);
    assert_true(e[2].written == then + 1000);
    assert_string_equal(e[0].document, "/home/x/a.exr");
    assert_string_equal(e[1].document, "");
    assert_true(e[0].kind == WR_JOURNAL_DOCUMENT && e[1].kind == WR_JOURNAL_EMPTY);
    assert_true(e[0].complete == 3 && e[1].complete == 4 && e[2].complete == 0);
    assert_true(!e[0].unfinished && e[1].unfinished && !e[2].unfinished);
    assert_true(!e[0].nothing && !e[1].nothing && e[2].nothing);
    for (int i = 0; i < 3; i++) {
        struct stat info;
        assert_true(stat(e[i].path, &info) == 0 && info.st_size == e[i].bytes);
        assert_true(llabs(e[i].started - (int64_t)time(NULL)) < 60);
        assert_true(!*e[i].error && !*e[i].damage && e[i].dropped_bytes == 0);
    }
    wr_journal_list_fini(&list);
}

static void old_journals_of_what_was_saved_are_removed_others_never(void **state)
{
    WrJournalStart empty = { .kind = WR_JOURNAL_EMPTY };
    WrJournalList list;
    int64_t now = (int64_t)time(NULL);
    /* Saved and old; saved just now; old and not saved; saved, with later work, lost lines, or failed writes. */
    for (int i = 0; i < 6; i++) {
        WrJournalOptions options = { .folder = *state, .sync_seconds = -1 };
        WrJournal *journal = wr_journal_begin(&options, &empty);
        char *path = wr_strdup(wr_journal_path(journal));
        wr_journal_command(journal, "a", NULL);
        wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
        if (i != 2) wr_journal_saved(journal, "/home/x/b.exr", &(WrHash){ 1, 2 }, NULL);
        if (i == 3) wr_journal_command(journal, "b", NULL);
        if (i == 3) wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
        if (i == 5) wr_journal_break(journal, "the disk is full");
        wr_journal_leave(journal);
        FILE *file = fopen(path, "a");
        if (i == 4) fputs("a line that nobody can read any more\n", file);
        fclose(file);
        struct timespec times[2] = { { .tv_sec = now - (i == 1 ? 10 : 200000 + i) } };
        times[1] = times[0];
        assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
        wr_free(path);
    }
    assert_true(wr_journal_list(*state, &list, NULL));
    assert_int_equal(list.count, 5);
    assert_true(list.entries[0].nothing);
    for (int i = 1; i < 5; i++) assert_false(list.entries[i].nothing);
    assert_string_equal(list.entries[0].document, "/home/x/b.exr");
    assert_int_equal(list.entries[1].complete, 1);
    assert_int_equal(list.entries[2].complete, 1);
    assert_int_equal(count_entries(*state), 5);
    wr_journal_list_fini(&list);
}

static void a_listing_shows_damage_and_passes_over_what_is_no_journal(void **state)
{
    WrJournalList list;
    WrJournalStart empty = { .kind = WR_JOURNAL_EMPTY };
    leave_at(*state, &empty, 2, false, 4000); /* old, but not empty */
    assert_true(wr_journal_list(*state, &list, NULL));
    FILE *file = fopen(list.entries[0].path, "a");
    assert_true(file && fputs("torn", file) >= 0 && fclose(file) == 0);
    wr_journal_list_fini(&list);
    char *newer = in(*state, "newer.wj"), *folder = in(*state, "folder.wj");
    char *link = in(*state, "link.wj"), *other = in(*state, "other.txt");
    write_bytes(newer, "wrinkle-journal 9 x\n", 20);
    write_bytes(other, "x", 1);
    assert_true(mkdir(folder, 0700) == 0 && symlink(newer, link) == 0);
    assert_true(wr_journal_list(*state, &list, NULL));
    assert_int_equal(list.count, 2);
    int damaged = *list.entries[0].error ? 1 : 0;
    assert_int_equal(list.entries[damaged].complete, 2);
    assert_int_equal(list.entries[damaged].dropped_bytes, 4);
    assert_non_null(strstr(list.entries[damaged].damage, "truncated"));
    assert_non_null(strstr(list.entries[1 - damaged].error, "newer"));
    assert_true(exists(newer));
    wr_journal_list_fini(&list);
    wr_free(newer), wr_free(folder), wr_free(link), wr_free(other);
}

static void a_folder_that_does_not_exist_has_no_journals(void **state)
{
    WrJournalList list;
    WrError err = { "" };
    char *none = in(*state, "none"), *file = in(*state, "file");
    assert_true(wr_journal_list(none, &list, &err));
    assert_true(list.count == 0);
    wr_journal_list_fini(&list);
    write_bytes(file, "x", 1);
    assert_false(wr_journal_list(file, &list, &err));
    assert_non_null(strstr(err.text, file));
    wr_free(none), wr_free(file);
}

static void make_old(const char *path)
{
    struct timespec times[2] = { { .tv_sec = time(NULL) - 200000 },
                                 { .tv_sec = time(NULL) - 200000 } };
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static void leftovers_of_killed_programs_are_removed_after_a_day(void **state)
{
    const char *names[] = { ".a.new",  ".b.new", "c.files", "d.files",
                            "e.files", "e.wj",   "f.new",   ".g.new" };
    const bool old[] = { true, false, true, false, true, true, true, true };
    const bool stays[] = { false, true, false, true, true, true, true, true };
    char *paths[8];
    for (int i = 0; i < 8; i++) {
        paths[i] = in(*state, names[i]);
        if (strstr(names[i], ".files")) {
            char *inside = in(paths[i], "snapshot-1.exr");
            assert_int_equal(mkdir(paths[i], 0700), 0);
            write_bytes(inside, "x", 1);
            wr_free(inside);
        } else {
            write_bytes(paths[i], "x", 1);
        }
        if (old[i]) make_old(paths[i]);
    }
    int held = open(paths[7], O_RDONLY); /* a program that needs a day to start */
    assert_int_equal(flock(held, LOCK_EX), 0);
    wr_journal_finish(begin_at(*state));
    close(held);
    for (int i = 0; i < 8; i++) {
        if (exists(paths[i]) != stays[i]) fail_msg("%s: stays %d", names[i], !stays[i]);
        wr_free(paths[i]);
    }
}

/* ---- kept files ---- */

/* A file with that content; its SHA-256 in hex. The caller frees the path. */
static char *make_file(const char *folder, const char *name, const char *content, char hex[65])
{
    char *path = in(folder, name);
    write_bytes(path, content, strlen(content));
    wr_sha256_bytes(content, strlen(content), hex);
    return path;
}

static void assert_kept(const char *journal, const char *hex, const char *named,
                        const char *content, struct stat *info)
{
    WrText path = { 0 };
    WrError err = { "" };
    if (!wr_journal_find_input_copy(journal, hex, named, &path, &err)) fail_msg("%s", err.text);
    WrText bytes = read_bytes(wr_text_get(&path));
    assert_string_equal(wr_text_get(&bytes), content);
    if (named) assert_non_null(strstr(wr_text_get(&path), strrchr(named, '.')));
    if (info) assert_int_equal(stat(wr_text_get(&path), info), 0);
    wr_text_fini(&bytes);
    wr_text_fini(&path);
}

static void kept_files_are_shared_and_go_with_their_last_journal(void **state)
{
    char hex[65];
    char *folder = in(*state, "journals"), *file = make_file(*state, "a.PNG", "pixels", hex);
    struct stat one, two;
    WrJournal *first = begin_at(folder), *second = begin_at(folder);
    assert_true(wr_journal_keep_file(first, file, hex, NULL));
    assert_true(wr_journal_keep_file(first, file, hex, NULL));  /* again: no work */
    write_bytes(file, "other pixels", 12);                      /* painted over since */
    assert_true(wr_journal_keep_file(second, file, hex, NULL)); /* from the first one's copy */
    assert_kept(wr_journal_path(first), hex, "x/y.png", "pixels", &one);
    assert_kept(wr_journal_path(second), hex, NULL, "pixels", &two);
    assert_true(one.st_ino == two.st_ino && one.st_nlink == 2);
    wr_journal_finish(first);
    assert_kept(wr_journal_path(second), hex, NULL, "pixels", &two);
    assert_int_equal(two.st_nlink, 1);
    wr_journal_finish(second);
    assert_int_equal(count_entries(folder), 0);
    wr_free(folder), wr_free(file);
}

static void a_copy_of_another_content_is_refused(void **state)
{
    char hex[65], bad[65];
    char *folder = in(*state, "journals"), *file = make_file(*state, "a.png", "pixels", hex);
    WrError err = { "" };
    WrText path = { 0 };
    WrJournal *journal = begin_at(folder);
    memset(bad, '0', 64);
    bad[64] = '\0';
    assert_false(wr_journal_keep_file(journal, file, bad, &err));
    assert_non_null(strstr(err.text, "content"));
    assert_false(wr_journal_keep_file(journal, file, "../../x", &err));
    assert_false(wr_journal_keep_file(journal, folder, hex, &err)); /* a folder */
    char *files = files_of(wr_journal_path(journal));
    assert_int_equal(count_entries(files), 0);
    assert_false(wr_journal_find_input_copy(wr_journal_path(journal), bad, NULL, &path, &err));
    assert_non_null(strstr(err.text, "no copy"));
    assert_false(wr_journal_find_input_copy(wr_journal_path(journal), "../x", NULL, &path, &err));
    WrText half = { 0 };
    wr_text_addf(&half, "%s/%s.png.new", files, bad);
    write_bytes(wr_text_get(&half), "pi", 2); /* cut short */
    assert_false(wr_journal_find_input_copy(wr_journal_path(journal), bad, "x.png", &path, &err));
    wr_text_fini(&half);
    assert_true(wr_journal_state(journal).safe && path.length == 0);
    wr_journal_finish(journal);
    wr_free(folder), wr_free(file), wr_free(files);
}

/* A file that is copied by a thread. */
static char *make_large_file(const char *folder, const char *name, char hex[65])
{
    const size_t count = (size_t)9 << 19;
    uint32_t *words = wr_alloc(count / 4, 4);
    for (uint32_t i = 0; i < count / 4; i++) words[i] = i * 2654435761u;
    char *path = in(folder, name);
    write_bytes(path, words, count);
    assert_true(wr_sha256_file(path, hex, NULL));
    wr_free(words);
    return path;
}

static void a_large_file_is_copied_while_work_goes_on(void **state)
{
    char hex[65], have[65];
    char *folder = in(*state, "journals"), *file = make_large_file(*state, "large.exr", hex);
    WrText copy = { 0 };
    WrJournal *journal = begin_at(folder);
    char *path = wr_strdup(wr_journal_path(journal));
    assert_true(wr_journal_keep_file(journal, file, hex, NULL));
    assert_true(wr_journal_command(journal, "noise", NULL));
    assert_true(wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL));
    wr_journal_leave(journal); /* waits for the copy */
    assert_true(wr_journal_find_input_copy(path, hex, file, &copy, NULL));
    assert_true(wr_sha256_file(wr_text_get(&copy), have, NULL));
    assert_string_equal(have, hex);
    journal = begin_at(folder);
    assert_true(wr_journal_keep_file(journal, file, hex, NULL)); /* linked or copied */
    char *files = files_of(wr_journal_path(journal));
    wr_journal_finish(journal); /* nothing of an unfinished copy stays */
    assert_false(exists(files));
    wr_text_fini(&copy);
    wr_free(folder), wr_free(file), wr_free(path), wr_free(files);
}

/* The copy of the document that a journal starts from turns out to be another file. */
static void a_journal_of_a_changed_document_is_not_safe(void **state)
{
    char hex[65], old[65];
    char *folder = in(*state, "journals"), *file = make_large_file(*state, "large.exr", hex);
    memset(old, 'a', 64);
    old[64] = '\0';
    for (int large = 0; large < 2; large++) {
        if (!large) write_bytes(file, "small", 5);
        else wr_free(file), file = make_large_file(*state, "large.exr", hex);
        WrJournalOptions options = { .folder = folder };
        WrJournalStart start = { .kind = WR_JOURNAL_DOCUMENT, .path = file, .sha256 = old };
        WrJournal *journal = wr_journal_begin(&options, &start);
        assert_true(wr_journal_state(journal).safe);
        assert_int_equal(wr_journal_keep_file(journal, file, old, NULL), large);
        while (wr_journal_state(journal).safe) wr_journal_sync(journal, NULL);
        assert_non_null(strstr(wr_journal_state(journal).reason, "changed"));
        wr_journal_finish(journal);
    }
    wr_free(folder), wr_free(file);
}

static void a_damaged_copy_of_another_journal_is_not_shared(void **state)
{
    char hex[65];
    char *folder = in(*state, "journals"), *file = make_file(*state, "a.obj", "a mesh", hex);
    WrText path = { 0 };
    WrJournal *first = begin_at(folder), *second = begin_at(folder);
    assert_true(wr_journal_keep_file(first, file, hex, NULL));
    assert_true(wr_journal_find_input_copy(wr_journal_path(first), hex, file, &path, NULL));
    write_bytes(wr_text_get(&path), "a mess", 6);
    assert_true(wr_journal_keep_file(second, file, hex, NULL));
    assert_kept(wr_journal_path(second), hex, file, "a mesh", NULL);
    wr_text_fini(&path);
    wr_journal_finish(first);
    wr_journal_finish(second);
    wr_free(folder), wr_free(file);
}

static void a_restart_removes_what_no_replay_needs_any_more(void **state)
{
    char hex[65], own[65];
    char *folder = in(*state, "journals"), *file = make_file(*state, "a.png", "pixels", hex);
    char *document = make_file(*state, "b.exr", "heights", own);
    WrText one = { 0 }, two = { 0 };
    WrJournal *journal = begin_at(folder);
    char *files = files_of(wr_journal_path(journal));
    assert_true(wr_journal_keep_file(journal, file, hex, NULL));
    assert_true(wr_journal_snapshot_path(journal, &one, NULL));
    write_bytes(wr_text_get(&one), "1", 1);
    WrJournalStart start = { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = wr_text_get(&one) };
    assert_true(wr_journal_restart(journal, &start, NULL));
    assert_true(count_entries(files) == 1 && exists(wr_text_get(&one)));
    assert_true(wr_journal_snapshot_path(journal, &two, NULL));
    assert_string_not_equal(wr_text_get(&one), wr_text_get(&two)); /* the old one is still needed */
    write_bytes(wr_text_get(&two), "2", 1);
    start.snapshot = wr_text_get(&two);
    assert_true(wr_journal_restart(journal, &start, NULL));
    assert_true(count_entries(files) == 1 && exists(wr_text_get(&two)));
    assert_true(wr_journal_keep_file(journal, document, own, NULL));
    start = (WrJournalStart){ .kind = WR_JOURNAL_DOCUMENT, .path = document, .sha256 = own };
    assert_true(wr_journal_restart(journal, &start, NULL));
    assert_kept(wr_journal_path(journal), own, document, "heights", NULL);
    assert_int_equal(count_entries(files), 1);
    wr_journal_finish(journal);
    assert_int_equal(count_entries(folder), 0);
    wr_text_fini(&one), wr_text_fini(&two);
    wr_free(folder), wr_free(file), wr_free(document), wr_free(files);
}

/* ---- trials ---- */

static int touched;

static bool succeeds(void *ctx, WrError *err)
{
    (void)err;
    touched = 1;
    printf("not to be seen\n");
    return *(int *)ctx == 5;
}

static bool fails(void *ctx, WrError *err)
{
    (void)ctx;
    return wr_fail(err, "no such brush");
}

static bool dies(void *ctx, WrError *err)
{
    (void)err;
    raise(*(int *)ctx);
    return true;
}

static bool leaves(void *ctx, WrError *err)
{
    (void)err;
    if (!ctx) _exit(3);
    return true;
}

static bool loops(void *ctx, WrError *err)
{
    (void)err;
    volatile int *zero = ctx;
    while (*zero == 0) continue;
    return true;
}

static bool starts_another(void *ctx, WrError *err)
{
    (void)err;
    pid_t child = fork();
    if (child == 0)
        for (;;) pause();
    *(volatile pid_t *)ctx = child;
    return true;
}

static bool takes_much_memory(void *ctx, WrError *err)
{
    (void)ctx;
    void *block = wr_try_alloc((size_t)1 << 30, 1, "much", err);
    if (!block) return false;
    wr_free(block);
    return true;
}

static void a_trial_tells_true_from_false_and_leaves_memory_alone(void **state)
{
    (void)state;
    int five = 5, six = 6;
    WrError err = { "untouched" };
    assert_int_equal(wr_journal_trial(succeeds, &five, 20, 0, &err), WR_PROBE_TRUE);
    assert_string_equal(err.text, "untouched");
    assert_int_equal(wr_journal_trial(succeeds, &six, 20, 0, &err), WR_PROBE_FALSE);
    assert_int_equal(wr_journal_trial(fails, NULL, 20, 0, &err), WR_PROBE_FALSE);
    assert_string_equal(err.text, "no such brush");
    assert_int_equal(touched, 0);
}

static void a_trial_outlives_crashes(void **state)
{
    (void)state;
    int signals[] = { SIGSEGV, SIGABRT, SIGFPE, SIGKILL, SIGBUS, SIGTERM };
    WrError err;
    for (int i = 0; i < 6; i++) {
        char number[32];
        snprintf(number, sizeof number, "signal %d", signals[i]);
        assert_int_equal(wr_journal_trial(dies, &signals[i], 20, 0, &err), WR_PROBE_CRASHED);
        assert_non_null(strstr(err.text, number));
    }
    assert_int_equal(wr_journal_trial(leaves, NULL, 20, 0, &err), WR_PROBE_CRASHED);
    assert_non_null(strstr(err.text, "status 3"));
}

static void a_trial_that_takes_too_long_is_ended(void **state)
{
    (void)state;
    int zero = 0;
    WrError err;
    assert_int_equal(wr_journal_trial(loops, &zero, 0.1, 0, &err), WR_PROBE_TIMEOUT);
    assert_non_null(strstr(err.text, "0.1 s"));
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* no child is left */
}

static void what_a_trial_starts_ends_with_it(void **state)
{
    (void)state;
    volatile pid_t *started = shared_memory(sizeof *started);
    WrError err;
    assert_int_equal(wr_journal_trial(starts_another, (void *)started, 20, 0, &err), WR_PROBE_TRUE);
    char path[64], line[512] = "";
    snprintf(path, sizeof path, "/proc/%ld/stat", (long)*started);
    for (int i = 0; i < 2000; i++) { /* gone, or ended and not yet reaped by its new parent */
        FILE *file = fopen(path, "r");
        if (!file) return;
        if (!fgets(line, sizeof line, file)) line[0] = '\0';
        fclose(file);
        if (!*line || strstr(line, ") Z") || strstr(line, ") X")) return;
        sleep_seconds(0.001);
    }
    fail_msg("still there: %s", line);
}

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define BOUNDED false /* sanitizers reserve terabytes of addresses */
#else
#define BOUNDED true
#endif

static void a_trial_is_held_to_its_memory(void **state)
{
    (void)state;
    WrError err;
    assert_int_equal(wr_journal_trial(takes_much_memory, NULL, 20, 0, &err), WR_PROBE_TRUE);
    if (!BOUNDED) skip();
    assert_int_equal(wr_journal_trial(takes_much_memory, NULL, 20, (size_t)64 << 20, &err),
                     WR_PROBE_FALSE);
    assert_non_null(strstr(err.text, "not enough memory"));
    assert_int_equal(wr_journal_trial(takes_much_memory, NULL, 20, (size_t)2 << 30, &err),
                     WR_PROBE_TRUE);
}

int main(void)
{
#define PLACED(test) cmocka_unit_test_setup_teardown(test, make_place, remove_place)
    const struct CMUnitTest tests[] = {
        PLACED(a_journal_in_use_is_neither_listed_nor_claimed_until_its_program_dies),
        PLACED(a_journal_is_claimed_by_one_of_several_programs),
        PLACED(a_lock_on_a_file_that_lost_its_name_is_none),
        PLACED(a_journal_that_restarts_stays_held),
        PLACED(a_listing_tells_what_there_is_to_recover_newest_first),
        PLACED(old_journals_of_what_was_saved_are_removed_others_never),
        PLACED(a_listing_shows_damage_and_passes_over_what_is_no_journal),
        PLACED(a_folder_that_does_not_exist_has_no_journals),
        PLACED(leftovers_of_killed_programs_are_removed_after_a_day),
        PLACED(kept_files_are_shared_and_go_with_their_last_journal),
        PLACED(a_copy_of_another_content_is_refused),
        PLACED(a_large_file_is_copied_while_work_goes_on),
        PLACED(a_journal_of_a_changed_document_is_not_safe),
        PLACED(a_damaged_copy_of_another_journal_is_not_shared),
        PLACED(a_restart_removes_what_no_replay_needs_any_more),
        cmocka_unit_test(a_trial_tells_true_from_false_and_leaves_memory_alone),
        cmocka_unit_test(a_trial_outlives_crashes),
        cmocka_unit_test(a_trial_that_takes_too_long_is_ended),
        cmocka_unit_test(what_a_trial_starts_ends_with_it),
        cmocka_unit_test(a_trial_is_held_to_its_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
