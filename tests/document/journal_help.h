/* journal_help.h - shared helpers of the journal tests: a temporary folder, files, children. */
#pragma once
#include "base/text.h"
#include "base/file.h"
#include "base/memory.h"
#include "document/recover.h"

#include <dirent.h>
#include <ftw.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static inline int remove_one(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)info, (void)type, (void)place;
    return remove(path);
}

static inline void remove_tree(const char *path)
{
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* A new empty folder; *state is its path. On a memory disk if there is one: these tests sync often, and only a power
   failure could show a difference. $TMPDIR sets another place. */
static inline int make_place(void **state)
{
    const char *above = getenv("TMPDIR");
    if (!above || !*above) above = access("/dev/shm", W_OK | X_OK) == 0 ? "/dev/shm" : "/tmp";
    *state = wr_path_join(above, "wrinkle-journal-XXXXXX");
    return mkdtemp(*state) ? 0 : -1;
}

static inline int remove_place(void **state)
{
    remove_tree(*state);
    wr_free(*state);
    return 0;
}

static inline char *in(const char *folder, const char *name)
{
    return wr_path_join(folder, name);
}

static inline void write_bytes(const char *path, const void *bytes, size_t length)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

static inline WrText read_bytes(const char *path)
{
    WrText text = { 0 };
    size_t length;
    assert_true(wr_file_read(path, (size_t)1 << 28, &text.data, &length, NULL));
    text.length = length;
    return text;
}

static inline bool exists(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0;
}

/* Number of entries in a folder, without . and ..; 0 if it does not exist. */
static inline int count_entries(const char *path)
{
    int count = -2;
    DIR *dir = opendir(path);
    if (!dir) return 0;
    while (readdir(dir)) count++;
    closedir(dir);
    return count;
}

static inline void sleep_seconds(double seconds)
{
    struct timespec time = { (time_t)seconds, (long)((seconds - floor(seconds)) * 1e9) };
    nanosleep(&time, NULL);
}

/* A journal that never syncs by itself: tests that only kill processes need no sync. */
static inline WrJournal *begin_at(const char *folder)
{
    WrJournalOptions options = { .folder = folder, .program = "9.9", .sync_seconds = -1 };
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY, .hash = { 1, 2 } };
    return wr_journal_begin(&options, &start);
}

/* NAME.files beside a journal. The caller frees it. */
static inline char *files_of(const char *journal_path)
{
    WrText text = { 0 };
    wr_text_add_n(&text, journal_path, strlen(journal_path) - strlen(".wj"));
    wr_text_add(&text, ".files");
    return text.data;
}

/* Memory shared by a child and its parent. */
static inline void *shared_memory(size_t bytes)
{
    void *block = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(block != MAP_FAILED);
    return block;
}

/* Wait until a child's counter is at least `want`; the child must not end. */
static inline void await(const volatile long *counter, long want)
{
    for (int i = 0; i < 20000 && *counter < want; i++) sleep_seconds(0.0005);
    assert_true(*counter >= want);
}

/* fork, but the child ends with its parent, so that a failed test leaves no process. */
static inline pid_t fork_bound(void)
{
    pid_t child = fork();
    if (child == 0) prctl(PR_SET_PDEATHSIG, SIGKILL);
    return child;
}

static inline void kill_child(pid_t child)
{
    int status;
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

/* Run a function in a child, where it may change limits, users and mounts. Returns 0, or the line of the failed
   check; 77 means that the system does not allow it. */
static inline int run_apart(int (*function)(const char *place), const char *place)
{
    int status, *line = shared_memory(sizeof *line);
    pid_t child = fork_bound();
    if (child == 0) {
        alarm(60);
        *line = function(place);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    int failed = *line;
    munmap(line, sizeof *line);
    if (WIFSIGNALED(status)) fail_msg("the child was ended by signal %d", WTERMSIG(status));
    if (failed != 0 && failed != 77) fail_msg("the check in line %d failed in the child", failed);
    return failed;
}
#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) return __LINE__;                                                         \
    } while (0)
