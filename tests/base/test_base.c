/* Numbers as text, deterministic functions, files, the pool. */
#include "test.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/kernmath.h"
#include "base/memory.h"
#include "base/hash.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/spool.h"
#include "base/text.h"
#include "base/vec.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

static void numbers_print_shortest_and_read_back(void **state)
{
    (void)state;
    const struct {
        double value;
        const char *text;
    } known[] = { { 0, "0" },
                  { 0.1, "0.1" },
                  { -3, "-3" },
                  { 40, "40" },
                  { -1e6, "-1000000" },
                  { 12345670, "12345670" },
                  { 1e20, "1e+20" },
                  { 512, "512" },
                  { 0.30000000000000004, "0.30000000000000004" },
                  { 1.0 / 3, "0.3333333333333333" },
                  { 123456.789, "123456.789" },
                  { 5e-324, "5e-324" } };
    char buffer[WR_NUMBER_SIZE];
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_string_equal(wr_number_print(known[i].value, buffer), known[i].text);
    TestRandom random = { 7 };
    for (int i = 0; i < 20000; i++) {
        uint64_t bits = test_random_u64(&random);
        double value, again;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value)) continue;
        wr_number_print(value, buffer);
        assert_true(wr_number_parse(buffer, strlen(buffer), &again));
        assert_true(value == again);
    }
}

static void words_that_are_no_numbers_are_refused(void **state)
{
    (void)state;
    const char *bad[] = { "",    "-",   ".",  "1e", "1,5",   "0x10",
                          "nan", "inf", " 1", "1 ", "1e999", "--1" };
    double value;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(wr_number_parse(bad[i], strlen(bad[i]), &value));
}

static void invalid_utf8_never_reaches_json(void **state)
{
    (void)state;
    WrText text = { 0 };
    wr_text_add_json_string(&text, "a\"\\\n\xff\xc3\xa9\xed\xa0\x80");
    assert_string_equal(
        wr_text_get(&text),
        "\"a\\\"\\\\\\u000a\xEF\xBF\xBD\xc3\xa9\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\"");
    wr_text_fini(&text);
}

static void turns_are_exact_at_quarters_in_both_precisions(void **state)
{
    (void)state;
    const double sines[] = { 0, 1, 0, -1 };
    for (int k = -9; k <= 9; k++) {
        double s, c;
        float sf, cf;
        wr_sincos_turns(k * 0.25, &s, &c);
        wr_sincos_turns_f((float)k * 0.25f, &sf, &cf);
        assert_true(s == sines[k & 3] && c == sines[(k + 1) & 3]);
        assert_true(sf == (float)sines[k & 3] && cf == (float)sines[(k + 1) & 3]);
    }
}

/* The latest angles are stored: results are the same in any order, and close to those of the system. */
static void turns_do_not_depend_on_those_before(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    static double turns[COUNT], sines[COUNT], cosines[COUNT];
    TestRandom random = { 5 };
    for (int i = 0; i < COUNT; i++) {
        turns[i] = i % 3 ? i / 64.0 : 4 * test_random(&random) - 2;
        wr_sincos_turns(turns[i], &sines[i], &cosines[i]);
        assert_near(sines[i], sin(2 * WR_PI * (turns[i] - rint(turns[i]))), 1e-15);
    }
    for (int i = 0; i < COUNT; i++) {
        const int k = (int)(test_random_u64(&random) % COUNT);
        double s, c;
        wr_sincos_turns(turns[k], &s, &c);
        assert_true(same_bits(s, sines[k]) && same_bits(c, cosines[k]));
    }
}

static void float_functions_keep_their_stated_error(void **state)
{
    (void)state;
    double worst_sin = 0, worst_atan = 0, worst_log = 0, worst_exp = 0, worst_pow = 0;
    for (int i = 0; i <= 100000; i++) {
        double t = i / 100000.0;
        float s, c, u = (float)(t * 4 - 2);
        wr_sincos_turns_f(u, &s, &c);
        worst_sin =
            fmax(worst_sin, fmax(fabs(s - sin(2 * WR_PI * u)), fabs(c - cos(2 * WR_PI * u))));
        float x = (float)cos(2 * WR_PI * t), y = (float)sin(2 * WR_PI * t);
        double turns = atan2(y, x) / (2 * WR_PI), d;
        d = wr_atan2_turns_f(y, x) - (turns - floor(turns));
        worst_atan = fmax(worst_atan, fabs(d - rint(d)));
        float q = (float)exp2(t * 200 - 100), near = (float)(0.9 + 0.2 * t);
        worst_log = fmax(worst_log, fabs(wr_log2_f(q) / log2(q) - 1) * (fabs(log2(q)) > 1e-3));
        if (near != 1.0f) worst_log = fmax(worst_log, fabs(wr_log2_f(near) / log2(near) - 1));
        float e = (float)(t * 240 - 120);
        worst_exp = fmax(worst_exp, fabs(wr_exp2_f(e) / exp2(e) - 1));
        worst_pow = fmax(worst_pow, fabs(wr_pow01_f((float)t, 40) - pow((float)t, 40)));
    }
    assert_near(worst_sin, 0, 1.2e-7);
    assert_near(worst_atan, 0, 1e-7);
    assert_near(worst_log, 0, 1.5e-7);
    assert_near(worst_exp, 0, 1.2e-7);
    assert_near(worst_pow, 0, 2e-6);
}

static void hc89_power_of_0_and_above_1_is_defined(void **state)
{
    (void)state;
    assert_true(wr_pow01_f(0, 0) == 1 && wr_pow01_f(0, 5) == 0 && wr_pow01_f(1, 1e5f) == 1);
    assert_true(wr_pow01_f(1.0000001f, 1e5f) == 1); /* HC90 */
    assert_true(wr_pow01_f(0.5f, 1e5f) == 0 && wr_pow01_f(0.5f, 1) == 0.5f);
}

static void length_and_unit_survive_any_scale(void **state)
{
    (void)state;
    const double scales[] = { 1, 1e20, 1e-20, 1e200, 1e-200, 1e-310 };
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        WrVec3 a = { 3 * scales[i], 0, 4 * scales[i] }, up = { 0, 1, 0 };
        assert_near(v3_len(a) / (5 * scales[i]), 1, 1e-10);
        assert_near(v3_unit(a, up).x, 0.6, 1e-10);
    }
    WrVec3 fallback = { 0, 1, 0 };
    assert_true(v3_unit((WrVec3){ 0, 0, 0 }, fallback).y == 1);
    assert_true(v3_unit((WrVec3){ NAN, 0, 0 }, fallback).y == 1);
    assert_true(v3_unit((WrVec3){ INFINITY, 0, 0 }, fallback).y == 1);
}

/* Scaling by any power of two changes no bit of the result. */
static void length_and_unit_know_no_scale(void **state)
{
    (void)state;
    TestRandom random = { 12 };
    for (int i = 0; i < 3000; i++) {
        const WrVec3 a = { test_random(&random) - 0.5, test_random(&random) - 0.5,
                           i % 3 ? test_random(&random) - 0.5 : 0 };
        const int power = (int)(1900 * test_random(&random)) - 950;
        const WrVec3 b = { scalbn(a.x, power), scalbn(a.y, power), scalbn(a.z, power) };
        const WrVec3 up = { 0, 0, 1 }, p = v3_unit(a, up), q = v3_unit(b, up);
        assert_true(v3_len(b) == scalbn(v3_len(a), power));
        assert_memory_equal(&p, &q, sizeof p);
    }
}

static void hc20_angle_between_equal_directions_is_zero(void **state)
{
    (void)state;
    WrVec3 a = { 0.1, 0.7, -0.3 }, b = { 0.1 + 1e-12, 0.7, -0.3 };
    assert_true(v3_angle_rad(a, a) == 0);
    assert_true(v3_angle_rad(a, b) > 0 && v3_angle_rad(a, b) < 1e-11);
}

static void count_piece(int index, int worker, void *ctx)
{
    (void)worker;
    __atomic_fetch_add(&((int *)ctx)[index], 1, __ATOMIC_RELAXED);
}

static void each_piece_of_a_job_runs_once(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 7; threads += 3) {
        WrPool *pool = wr_pool_new(threads);
        for (int round = 0; round < 200; round++) {
            int seen[100] = { 0 };
            wr_pool_run(pool, 100, count_piece, seen);
            for (int i = 0; i < 100; i++) assert_int_equal(seen[i], 1);
        }
        wr_pool_free(pool);
    }
}

static void bytes_become_a_file_in_memory(void **state)
{
    (void)state;
    WrError err;
    static char many[200000], back[200001];
    for (size_t i = 0; i < sizeof many; i++) many[i] = (char)(i * 31 >> 3);
    int fd = wr_fd_in_memory("many", many, sizeof many, &err);
    assert_true(fd >= 0);
    size_t have = 0;
    for (ssize_t n; (n = read(fd, back + have, sizeof back - have)) > 0;) have += (size_t)n;
    assert_int_equal(have, sizeof many);
    assert_memory_equal(back, many, sizeof many);
    close(fd);
    fd = open("/dev/full", O_WRONLY);
    assert_false(wr_fd_write(fd, many, 10));
    assert_int_equal(errno, ENOSPC);
    close(fd);
}

static void a_failed_write_leaves_the_old_file_whole(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.txt"), *link = wr_path_join(folder, "link.txt");
    assert_true(wr_file_write(path, "old", 3, &err));
    assert_int_equal(chmod(path, 0640), 0);
    assert_int_equal(symlink("a.txt", link), 0);
    WrFileTarget target;
    assert_true(wr_file_begin(&target, link, &err));
    wr_file_abort(&target);
    assert_true(wr_file_write(link, "new", 3, &err)); /* through the link, with the mode kept */
    char *bytes;
    size_t length;
    struct stat info;
    assert_true(wr_file_read(path, 100, &bytes, &length, &err));
    assert_int_equal(length, 3);
    assert_string_equal(bytes, "new");
    wr_free(bytes);
    assert_int_equal(lstat(link, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_false(wr_file_write(folder, "x", 1, &err));
    assert_non_null(strstr(err.text, "is a folder"));
    assert_false(wr_file_read(folder, 100, &bytes, &length, &err));
    assert_non_null(strstr(err.text, "is a folder"));
    assert_false(wr_file_read("/dev/zero", 100, &bytes, &length, &err));
    assert_non_null(strstr(err.text, "is a device"));
    assert_false(wr_file_write("/nonexistent/x", "x", 1, &err));
    assert_non_null(strstr(err.text, "does not exist"));
    unlink(path);
    unlink(link);
    assert_int_equal(rmdir(folder), 0); /* no other file remains */
    wr_free(path);
    wr_free(link);
}

/* The name of the one hidden file in a folder. */
static bool hidden_file(const char *folder, char name[300])
{
    DIR *dir = opendir(folder);
    int count = 0;
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));) {
        if (entry->d_name[0] != '.' || !entry->d_name[1] || entry->d_name[1] == '.') continue;
        snprintf(name, 300, "%s/%s", folder, entry->d_name);
        count++;
    }
    closedir(dir);
    return count == 1;
}

static void what_is_half_written_is_nobody_elses_and_has_no_name_to_guess(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", first[300], second[300];
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.exr");
    WrFileTarget target;
    struct stat info, named;
    mode_t mask = umask(0027);
    assert_true(wr_file_begin(&target, path, &err));
    assert_true(hidden_file(folder, first));
    assert_int_equal(lstat(first, &named), 0);
    assert_int_equal(fstat(target.fd, &info), 0);
    assert_true(named.st_ino == info.st_ino && S_ISREG(named.st_mode));
    assert_int_equal(named.st_mode & 07777, 0600);
    assert_true(fcntl(target.fd, F_GETFD) & FD_CLOEXEC);
    assert_true(wr_file_put(&target, "new", 3, &err));
    assert_true(wr_file_commit(&target, &err));
    assert_int_equal(stat(path, &info), 0);
    /* Sixty-four random bits: neither the process id nor a counter predicts the next name. */
    assert_int_equal(info.st_mode & 07777, 0640);
    assert_int_equal(umask(mask), 0027);
    /* after umask, which is unchanged */
    assert_true(wr_file_begin(&target, path, &err));
    assert_true(hidden_file(folder, second));
    wr_file_abort(&target);
    const char *dash = strrchr(first, '-');
    assert_true(dash && strspn(dash + 1, "0123456789abcdef") == 16);
    assert_memory_not_equal(dash, strrchr(second, '-'), 17);
    assert_int_equal(chmod(path, 0604), 0);
    assert_true(wr_file_write(path, "newer", 5, &err));
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 07777, 0604);
    unlink(path);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
}

/* Replaces the system's random numbers: none for this many calls. */
static int known_next;

ssize_t getrandom(void *bytes, size_t length, unsigned flags)
{
    (void)flags;
    if (known_next-- > 0) memset(bytes, 7, length);
    else {
        int fd = open("/dev/urandom", O_RDONLY | O_CLOEXEC);
        ssize_t n = read(fd, bytes, length);
        close(fd);
        return n;
    }
    return (ssize_t)length;
}

/* An attacker who guesses the name has put a link there: it is not followed, and another name is used. */
static void a_planted_link_is_not_written_through(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", planted[300], text[8] = "";
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.exr"), *victim = wr_path_join(folder, "victim");
    assert_true(wr_file_write(victim, "whole", 5, &err));
    snprintf(planted, sizeof planted, "%s/.a.exr.%ld-%08x-0707070707070707.part.exr", folder,
             (long)getpid(), (unsigned)wr_file_host());
    for (int hard = 0; hard < 2; hard++) {
        assert_int_equal(hard ? link(victim, planted) : symlink(victim, planted), 0);
        known_next = 1;
        assert_true(wr_file_write(path, "other", 5, &err));
        assert_true(known_next <= 0); /* it was called */
        int fd = open(victim, O_RDONLY | O_CLOEXEC);
        assert_int_equal(read(fd, text, sizeof text), 5);
        close(fd);
        assert_memory_equal(text, "whole", 5);
        assert_int_equal(unlink(planted), 0);
    }
    unlink(path);
    unlink(victim);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
    wr_free(victim);
}

/* Create a file NAME in the folder as a killed program leaves it; true if it is still there after a sweep. */
static bool stays(const char *folder, const char *name)
{
    char *path = wr_path_join(folder, name);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    assert_true(fd >= 0);
    close(fd);
    wr_file_sweep(folder);
    bool there = access(path, F_OK) == 0;
    unlink(path);
    wr_free(path);
    return there;
}

static void what_dead_processes_left_is_swept_and_nothing_else(void **state)
{
    (void)state;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", name[200];
    assert_non_null(mkdtemp(folder));
    pid_t dead = fork();
    if (dead == 0) _exit(0);
    assert_int_equal(waitpid(dead, NULL, 0), dead);
    const struct {
        const char *form;
        bool swept;
    } names[] = {
        { ".a.exr.%d-%08x-0123456789abcdef.part.exr", true },
        { ".a.exr.%d-%07x0-0123456789abcdef.part.exr", false }, /* of another machine */
        { ".a.exr.%d-%08x-0123456789abcdef-1.part.exr", false },
        { ".a.exr.%d-%08x-.part.exr", false },
        /* of older versions, as are the next two */
        { ".a.exr.%d-0123456789abcdef.part.exr", true },
        { ".a.%d-f.part", true },
        { ".a.part.exr.%d-17.part.exr", true },
        { "a.exr.%d-0123456789abcdef.part.exr", false },
        { ".a.exr.%d-.part.exr", false },
        { ".a.exr.-12.part.exr", false },
        { ".a.exr.%d-xyz.part.exr", false },
        { ".a.exr.%d-12zz.part.exr", false },
        { ".a.exr.%d-12.parts", false },
        { ".a.exr.x%d-12.part.exr", false },
        { ".%d.part", false },
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(name, sizeof name, names[i].form, (int)dead, (unsigned)wr_file_host());
        if (stays(folder, name) == names[i].swept) fail_msg("%s", name);
    }
    snprintf(name, sizeof name, ".a.exr.%d-12.part.exr", (int)getppid()); /* a running process */
    assert_true(stays(folder, name));
    /* A locked file is in use, whatever its name: for example by a process of another container. */
    snprintf(name, sizeof name, "%s/.a.exr.%d-12.part.exr", folder, (int)dead);
    int fd = open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
    assert_int_equal(flock(fd, LOCK_EX), 0);
    wr_file_sweep(folder);
    assert_int_equal(access(name, F_OK), 0);
    close(fd);
    if (geteuid() == 0) { /* of another user */
        assert_int_equal(chown(name, 12345, 12345), 0);
        wr_file_sweep(folder);
        assert_int_equal(access(name, F_OK), 0);
    }
    unlink(name);
    assert_int_equal(symlink("nothing", name), 0); /* temporary files are never links */
    wr_file_sweep(folder);
    struct stat info;
    assert_int_equal(lstat(name, &info), 0);
    unlink(name);
    assert_int_equal(rmdir(folder), 0);
}

/* Writing a file in a folder removes leftovers of the previous write. */
static void a_killed_write_is_cleared_away_by_the_next(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", left[300];
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.txt"), *other = wr_path_join(folder, "b.txt");
    pid_t child = fork();
    if (child == 0) {
        WrFileTarget target;
        if (wr_file_begin(&target, path, &err) && wr_file_put(&target, "half", 4, &err)) abort();
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    assert_true(hidden_file(folder, left));
    assert_true(wr_file_write(other, "whole", 5, &err));
    assert_int_not_equal(access(left, F_OK), 0);
    unlink(other);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
    wr_free(other);
}

/* Replaces the system's functions: a disk that corrupts written data. */
static bool disk_lies;

ssize_t pread(int fd, void *bytes, size_t length, off_t at)
{
    ssize_t n = syscall(SYS_pread64, fd, bytes, length, at);
    if (disk_lies && n > 0) *(char *)bytes ^= 1;
    return n;
}

static void what_does_not_read_back_is_not_written(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", name[300], text[8] = "";
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.exr");
    assert_true(wr_file_write(path, "whole", 5, &err));
    disk_lies = true;
    assert_false(wr_file_write(path, "other", 5, &err));
    disk_lies = false;
    assert_non_null(strstr(err.text, "does not read back"));
    assert_int_equal(wr_file_peek(path, text, sizeof text), 5);
    assert_string_equal(text, "whole");
    assert_false(hidden_file(folder, name));
    unlink(path);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
}

/* Number of opened files in that folder since `watch` was created or last read. */
static int opened(int watch)
{
    char events[4096] __attribute__((aligned(8)));
    int count = 0;
    ssize_t n = read(watch, events, sizeof events);
    for (ssize_t at = 0; at < n;) {
        const struct inotify_event *event = (const void *)(events + at);
        count += (event->mask & IN_OPEN) != 0;
        at += (ssize_t)sizeof *event + event->len;
    }
    return count;
}

/* Opening a pipe wakes the process at its other end; opening a device may have any effect. */
static void what_is_no_file_is_neither_opened_nor_replaced(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", bytes[4];
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    assert_true(inotify_add_watch(watch, path, IN_OPEN) >= 0);
    alarm(60); /* none of this may block */
    assert_int_equal(wr_file_open(path, 100, NULL, &err), -1);
    assert_non_null(strstr(err.text, "is a pipe"));
    assert_int_equal(wr_file_peek(path, bytes, sizeof bytes), 0);
    assert_int_equal(opened(watch), 0);
    assert_false(wr_file_write(path, "text", 4, &err));
    assert_non_null(strstr(err.text, "not a regular file"));
    assert_int_equal(wr_file_open_truncate(path, &err), -1); /* no reader */
    alarm(0);
    struct stat info;
    assert_true(lstat(path, &info) == 0 && S_ISFIFO(info.st_mode));
    close(watch);
    unlink(path);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
}

/* Lengths around whole blocks; one hash of all hashes, computed by Python's hashlib. */
static void sha256_is_that_of_the_standard(void **state)
{
    (void)state;
    static const int lengths[] = { 0, 1, 55, 56, 63, 64, 65, 119, 120, 128, 191, 1000 };
    uint8_t bytes[1000];
    char all[12 * 64 + 1] = "", hex[65];
    for (int k = 0; k < 12; k++) {
        for (int i = 0; i < lengths[k]; i++) bytes[i] = (uint8_t)(7 * i + lengths[k]);
        wr_sha256_bytes(bytes, (size_t)lengths[k], hex);
        memcpy(all + 64 * k, hex, sizeof hex);
    }
    wr_sha256_bytes(all, sizeof all - 1, hex);
    assert_string_equal(hex, "4cbaf5c993b05890a6043b8a4d08c8b3b38a1366af55c75bf27b16ae599a65aa");
    char *million = wr_alloc(1000000, 1);
    memset(million, 'a', 1000000);
    wr_sha256_bytes(million, 1000000, hex);
    wr_free(million);
    assert_string_equal(hex, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

static void a_limit_is_what_may_still_be_read(void **state)
{
    (void)state;
    WrError err;
    char path[] = "/tmp/wrinkle-test-XXXXXX", *bytes, hex[65];
    size_t length;
    int fd = mkstemp(path), stop = 1;
    assert_int_equal(write(fd, "12345", 5), 5);
    close(fd);
    assert_true(wr_file_read(path, 5, &bytes, &length, &err));
    assert_int_equal(length, 5);
    wr_free(bytes);
    assert_false(wr_file_read(path, 4, &bytes, &length, &err));
    assert_non_null(strstr(err.text, "over the limit"));
    assert_true(wr_sha256_file(path, hex, &err));
    char beside[65];
    assert_true(wr_sha256_end(wr_sha256_begin(path), beside, &err));
    assert_string_equal(beside, hex);
    assert_false(wr_sha256_end(wr_sha256_begin("/nowhere/at/all"), beside, &err));
    assert_non_null(strstr(err.text, "/nowhere/at/all"));
    const WrProgress stopped = { .cancel = &stop };
    const WrProgress *before = wr_progress_set(&stopped);
    assert_false(wr_sha256_file(path, hex, &err)); /* no hash of a part */
    assert_false(wr_sha256_end(wr_sha256_begin(path), hex, &err));
    wr_progress_set(before);
    assert_non_null(strstr(err.text, "cancelled"));
    unlink(path);
}

/* A world-writable folder with a file of user 54321 that is writable for group and others and has the set-user-id
   bit. */
static void make_anothers(const char *folder, const char *path)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    assert_true(fd >= 0);
    assert_int_equal(fchown(fd, 54321, 54321), 0);
    assert_int_equal(fchmod(fd, 06777), 0);
    close(fd);
    assert_int_equal(chmod(folder, 0777), 0);
}

static void rights_of_another_group_are_not_passed_on(void **state)
{
    (void)state;
    if (geteuid() != 0) skip();
    char folder[] = "/tmp/wrinkle-test-XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.exr");
    make_anothers(folder, path);
    pid_t child = fork();
    if (child == 0) {
        WrError err;
        struct stat info;
        const gid_t group = 12345;
        if (setgroups(1, &group) != 0 || setgid(12345) != 0 || setuid(12345) != 0) _exit(2);
        if (!wr_file_write(path, "text", 4, &err) || stat(path, &info) != 0) _exit(3);
        _exit(info.st_uid != 12345 ? 4 : (info.st_mode & 07777) != 0707 ? 5 : 0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    unlink(path);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
}

/* Binary form of an access control list: a version, then entries of user kinds with permissions. */
typedef struct Rights {
    uint32_t version;
    struct {
        uint16_t kind, may;
        uint32_t id;
    } entries[5];
} Rights;

static mode_t mode_in_folder_with(const Rights *rights, int entries, mode_t mask)
{
    WrError err;
    struct stat info;
    char folder[] = "/tmp/wrinkle-test-XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.exr");
    size_t length = 4 + 8 * (size_t)entries;
    bool listed = setxattr(folder, "system.posix_acl_default", rights, length, 0) == 0;
    mode_t before = umask(mask);
    if (listed) assert_true(wr_file_write(path, "text", 4, &err));
    umask(before);
    if (listed) assert_int_equal(stat(path, &info), 0);
    if (listed) unlink(path);
    assert_int_equal(rmdir(folder), 0);
    wr_free(path);
    if (!listed) skip(); /* this file system does not support such lists */
    return info.st_mode & 07777;
}

/* Such a list replaces the umask, whether it names users or not. */
static void what_a_folder_passes_on_a_new_file_has(void **state)
{
    (void)state;
    const Rights named = {
        2, { { 1, 7, ~0u }, { 2, 7, 12345 }, { 4, 5, ~0u }, { 16, 7, ~0u }, { 32, 0, ~0u } }
    };
    const Rights plain = { 2, { { 1, 7, ~0u }, { 4, 5, ~0u }, { 32, 0, ~0u } } };
    assert_int_equal(mode_in_folder_with(&named, 5, 0077), 0660);
    assert_int_equal(mode_in_folder_with(&plain, 3, 0), 0640);
}

/* ---- checksums of written data ---- */

#define MAX_MOST 3000000 /* file size limit in bytes */

/* Writes of any length at any position, as encoders and archives make them: the file equals a copy in memory. */
static void bytes_written_in_any_order_are_checked(void **state)
{
    (void)state;
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", *bytes;
    size_t length;
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.bin");
    TestRandom random = { 11 };
    uint8_t *model = calloc(MAX_MOST, 1), *piece = malloc(MAX_MOST);
    for (int run = 0; run < 30; run++) {
        WrFileTarget target;
        int64_t end = 0;
        memset(model, 0, MAX_MOST);
        assert_true(wr_file_begin(&target, path, &err));
        for (int k = 0; k < 60; k++) {
            const int64_t most = run % 3 == 0 ? 700000 : run % 3 == 1 ? 40 : 5000;
            const int64_t many = 1 + (int64_t)(test_random(&random) * (double)most);
            int64_t at = test_random(&random) < 0.5
                             ? end /* or over existing bytes, or after them */
                             : (int64_t)(test_random(&random) * 1.2 * (double)end);
            if (at + many > MAX_MOST) at = MAX_MOST - many;
            for (int64_t i = 0; i < many; i++) piece[i] = (uint8_t)test_random_u64(&random);
            memcpy(model + at, piece, (size_t)many);
            assert_true(wr_file_write_at(&target, piece, (size_t)many, at));
            if (at + many > end) end = at + many;
        }
        if (!wr_file_commit(&target, &err)) fail_msg("run %d: %s", run, err.text);
        assert_true(wr_file_read(path, MAX_MOST, &bytes, &length, &err));
        assert_int_equal(length, end);
        assert_memory_equal(bytes, model, length);
        wr_free(bytes);
    }
    free(model);
    free(piece);
    unlink(path);
    rmdir(folder);
    wr_free(path);
}

/* One flipped bit of 600 000 bytes, at the start, in the middle, at the end; or a file that is longer or shorter. */
static void a_byte_that_changes_on_the_disk_fails_the_commit(void **state)
{
    (void)state;
    static const int64_t places[] = { 0, 1, 262143, 262144, 300000, 599999, 600000, -1 };
    WrError err;
    char folder[] = "/tmp/wrinkle-test-XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.bin"), *zeros = calloc(600000, 1);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        WrFileTarget target;
        assert_true(wr_file_write(path, "old", 3, &err));
        assert_true(wr_file_begin(&target, path, &err));
        assert_true(wr_file_put(&target, zeros, 600000, &err));
        if (places[i] < 0) assert_int_equal(ftruncate(target.fd, 599999), 0);
        else assert_int_equal(pwrite(target.fd, "\1", 1, (off_t)places[i]), 1);
        assert_false(wr_file_commit(&target, &err));
        assert_non_null(strstr(err.text, "cannot be written (it does not read back as it was"));
        struct stat info;
        assert_true(stat(path, &info) == 0 && info.st_size == 3);
    }
    /* A corruption before a later write to neighbouring bytes is still detected. */
    WrFileTarget target;
    assert_true(wr_file_begin(&target, path, &err));
    assert_true(wr_file_put(&target, zeros, 600000, &err));
    assert_int_equal(pwrite(target.fd, "\1", 1, 270000), 1);
    assert_false(wr_file_write_at(&target, "header", 6, 280000));
    assert_int_equal(errno, EIO);
    wr_file_abort(&target);
    free(zeros);
    unlink(path);
    rmdir(folder);
    wr_free(path);
}

/* Data beyond the head of a spool is passed on while it is written; the writer then returns to the head. */
static void a_spool_passes_on_what_lies_behind_its_head(void **state)
{
    (void)state;
    WrError err;
    const int64_t whole = WR_SPOOL_HEAD + (20 << 20) + 12345, step = 3 << 20;
    char folder[] = "/tmp/wrinkle-test-XXXXXX", *bytes;
    size_t length;
    assert_non_null(mkdtemp(folder));
    char *path = wr_path_join(folder, "a.bin");
    uint32_t *model = malloc((size_t)whole + 4);
    for (int64_t i = 0; i < whole / 4 + 1; i++) model[i] = wr_mix32((uint32_t)i);
    WrFileTarget target;
    WrSpool spool;
    assert_true(wr_file_begin(&target, path, &err) && wr_spool_open(&spool));
    const WrByteSink to = wr_file_sink(&target);
    for (int64_t at = 0; at < whole; at += step) {
        const int64_t left = whole - at;
        assert_true(wr_fd_write(spool.fd, (char *)model + at, (size_t)(left < step ? left : step)));
        assert_true(wr_spool_move(&spool, &to));
    }
    /* some data was passed on, and its memory is freed: */
    assert_true(spool.moved > WR_SPOOL_HEAD);
    struct stat info;
    assert_int_equal(fstat(spool.fd, &info), 0);
    assert_true((int64_t)info.st_blocks * 512 < whole - (8 << 20));
    memcpy(model, "patched!", 8);
    assert_true(wr_fd_write_at(spool.fd, "patched!", 8, 0));
    assert_true(wr_spool_end(&spool, &to));
    wr_spool_close(&spool);
    if (!wr_file_commit(&target, &err)) fail_msg("%s", err.text);
    assert_true(wr_file_read(path, (size_t)whole, &bytes, &length, &err));
    assert_int_equal(length, whole);
    assert_true(memcmp(bytes, model, length) == 0);
    wr_free(bytes);
    free(model);
    unlink(path);
    rmdir(folder);
    wr_free(path);
}

/* ---- remaining time ---- */

/* Report fraction(t) every `step` seconds until `end`, where the work ends. Each promise must be within a factor of 2 of
   the rest. Returns the number of promises. */
static int promises(double (*fraction)(double t), double end, double step)
{
    WrTimeLeft task = { .last = 0 };
    int count = 0;
    for (double t = step; t < end; t += step) {
        const double left = wr_time_left(&task, fraction(t), t), rest = end - t;
        if (isnan(left)) continue;
        count++;
        assert_true(left >= rest / 2.0 && left <= rest * 2.0);
    }
    return count;
}

static double evenly(double t)
{
    return t / 83.0;
}

/* A quick tenth of the time does nine tenths of the fraction. */
static double quick_then_slow(double t)
{
    return t < 8.3 ? 0.9 * t / 8.3 : 0.9 + 0.1 * (t - 8.3) / 74.7;
}

static double in_rounds(double t)
{
    return fmod(t, 27.7) / 27.7;
}

static void time_is_promised_only_at_a_steady_rate(void **state)
{
    (void)state;
    WrTimeLeft task = { .last = 0 };
    assert_in_range(promises(evenly, 83.0, 0.37), 210, 224);
    /* after the change of rate nothing is promised until the new rate holds for long */
    for (double t = 0.37; t < 8.3; t += 0.37) wr_time_left(&task, quick_then_slow(t), t);
    for (double t = 10.4; t < 30.0; t += 0.37)
        assert_true(isnan(wr_time_left(&task, quick_then_slow(t), t)));
    /* a fraction that begins again is not that of the whole work */
    task = (WrTimeLeft){ .last = 0 };
    for (double t = 0.37; t < 83.0; t += 0.37) {
        const double left = wr_time_left(&task, in_rounds(t), t);
        assert_true(t < 27.7 || isnan(left));
    }
    /* fewer seconds: another task, which begins without a promise */
    assert_true(isnan(wr_time_left(&task, 0.1, 0.3)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(time_is_promised_only_at_a_steady_rate),
        cmocka_unit_test(bytes_written_in_any_order_are_checked),
        cmocka_unit_test(a_byte_that_changes_on_the_disk_fails_the_commit),
        cmocka_unit_test(a_spool_passes_on_what_lies_behind_its_head),
        cmocka_unit_test(numbers_print_shortest_and_read_back),
        cmocka_unit_test(words_that_are_no_numbers_are_refused),
        cmocka_unit_test(invalid_utf8_never_reaches_json),
        cmocka_unit_test(turns_are_exact_at_quarters_in_both_precisions),
        cmocka_unit_test(turns_do_not_depend_on_those_before),
        cmocka_unit_test(float_functions_keep_their_stated_error),
        cmocka_unit_test(hc89_power_of_0_and_above_1_is_defined),
        cmocka_unit_test(length_and_unit_survive_any_scale),
        cmocka_unit_test(length_and_unit_know_no_scale),
        cmocka_unit_test(hc20_angle_between_equal_directions_is_zero),
        cmocka_unit_test(each_piece_of_a_job_runs_once),
        cmocka_unit_test(bytes_become_a_file_in_memory),
        cmocka_unit_test(a_failed_write_leaves_the_old_file_whole),
        cmocka_unit_test(what_is_half_written_is_nobody_elses_and_has_no_name_to_guess),
        cmocka_unit_test(a_planted_link_is_not_written_through),
        cmocka_unit_test(what_dead_processes_left_is_swept_and_nothing_else),
        cmocka_unit_test(a_killed_write_is_cleared_away_by_the_next),
        cmocka_unit_test(what_does_not_read_back_is_not_written),
        cmocka_unit_test(what_is_no_file_is_neither_opened_nor_replaced),
        cmocka_unit_test(sha256_is_that_of_the_standard),
        cmocka_unit_test(a_limit_is_what_may_still_be_read),
        cmocka_unit_test(rights_of_another_group_are_not_passed_on),
        cmocka_unit_test(what_a_folder_passes_on_a_new_file_has),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
