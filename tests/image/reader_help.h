/* reader_help.h - shared helpers of the tests of the reader process: process queries, and pictures that must or must
   not be readable. */
#pragma once
#include "base/error.h"
#include "test.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "image/font.h"
#include "image/image.h"
#include "image/mesh.h"
#include "system/clock.h"

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

/* ---- processes ---- */

static inline bool is_reader(pid_t pid)
{
    char path[64], name[32] = "";
    snprintf(path, sizeof path, "/proc/%d/comm", (int)pid);
    FILE *file = fopen(path, "r");
    if (!file) return false;
    if (!fgets(name, sizeof name, file)) name[0] = '\0';
    fclose(file);
    return strcmp(name, "wrinkle-reader\n") == 0;
}

/* Reader processes whose parent is `parent`; a zombie counts. Fills at most 64. */
static inline int readers_of(pid_t parent, pid_t *found)
{
    DIR *folder = opendir("/proc");
    int count = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        pid_t pid = (pid_t)atoi(entry->d_name);
        char path[64];
        int of = 0;
        if (pid <= 0 || !is_reader(pid)) continue;
        snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
        FILE *file = fopen(path, "r");
        if (file && fscanf(file, "%*d (%*[^)]) %*c %d", &of) == 1 && of == parent && count < 64)
            found[count++] = pid;
        if (file) fclose(file);
    }
    closedir(folder);
    return count;
}

/* The one process of this program. */
static inline pid_t the_process(void)
{
    pid_t found[64];
    assert_int_equal(readers_of(getpid(), found), 1);
    return found[0];
}

/* The second process, which has libraries loaded, listens on a socket; readers of files do not. */
static inline bool is_second(pid_t pid)
{
    char path[64], to[16] = "";
    snprintf(path, sizeof path, "/proc/%d/fd/0", (int)pid);
    return readlink(path, to, sizeof to - 1) > 0 && strncmp(to, "socket:", 7) == 0;
}

/* Readers of files, of both processes; at most 64. */
static inline int children(pid_t *found)
{
    pid_t seen[64];
    const int count = readers_of(the_process(), seen);
    int kept = 0;
    for (int i = 0; i < count; i++) {
        if (!is_second(seen[i])) found[kept++] = seen[i];
        else kept += readers_of(seen[i], found + kept); /* no test has 64 */
    }
    return kept;
}

/* The only child that is reading a file. Children for already closed files end a moment later. */
static inline pid_t the_child(void)
{
    pid_t found[64];
    double until = wr_clock_seconds() + 10.0;
    while (children(found) != 1) {
        if (wr_clock_seconds() > until) fail_msg("not one child");
        usleep(1000);
    }
    return found[0];
}

/* Wait: children end shortly after the request. */
static inline void expect_no_children(void)
{
    pid_t found[64];
    double until = wr_clock_seconds() + 10.0;
    while (children(found) > 0) {
        if (wr_clock_seconds() > until) fail_msg("readers are left over");
        usleep(1000);
    }
}

static inline int open_descriptors(void)
{
    DIR *folder = opendir("/proc/self/fd");
    int count = 0;
    while (readdir(folder)) count++;
    closedir(folder);
    return count;
}

/* A number in /proc/PID/status, -1 if missing. */
static inline long status_of(pid_t pid, const char *name)
{
    char path[64], line[256];
    long value = -1;
    snprintf(path, sizeof path, "/proc/%d/status", (int)pid);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0) value = atol(line + strlen(name));
    if (file) fclose(file);
    return value;
}

/* A zombie counts as gone: it has no memory. */
static inline void expect_gone(pid_t pid)
{
    double until = wr_clock_seconds() + 10.0;
    while (is_reader(pid) && status_of(pid, "VmSize:") > 0) {
        if (wr_clock_seconds() > until) fail_msg("the reader process lives on");
        usleep(1000);
    }
}

/* ---- pictures ---- */

#define SIDE 300

static inline void write_picture(const char *path)
{
    WrError err = { "" };
    uint16_t *codes = malloc(SIDE * SIDE * sizeof *codes);
    TestRandom random = { 7 };
    for (int i = 0; i < SIDE * SIDE; i++) codes[i] = (uint16_t)test_random_u64(&random);
    if (!wr_image_write_pixels(path, SIDE, SIDE, 1, WR_PIXEL_U16, true, codes, &err))
        fail_msg("%s", err.text);
    free(codes);
}

static inline void expect_good(const char *path)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    TestRandom random = { 7 };
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_true(image->data[i] == (float)(uint16_t)test_random_u64(&random) / 65535.0f);
    wr_image_free(image);
}

/* The message must be one line that begins with the file's name and contains the word. */
static inline void expect_message(const WrError *err, const char *name, const char *word)
{
    if (strncmp(err->text, name, strlen(name)) != 0 || strchr(err->text, '\n') ||
        !strstr(err->text, word))
        fail_msg("message '%s': should begin with %s and say '%s'", err->text, name, word);
}

static inline WrImageFile *open_good(const char *path)
{
    WrError err = { "" };
    WrImageFile *file = wr_image_file_open(path, &err);
    if (!file) fail_msg("%s", err.text);
    return file;
}

static inline void expect_unreadable(WrImageFile *file, const char *name, const char *word)
{
    static float out[SIDE * SIDE];
    for (int again = 0; again < 2; again++) { /* also when read a second time */
        WrError err = { "" };
        assert_false(wr_image_file_read(file, 0, out, &err));
        expect_message(&err, name, word);
    }
    assert_null(wr_image_file_attribute(file, 0, "wrinkle:anything"));
}

static inline int enter_folder(void **state)
{
    static char folder[] = "/tmp/wr_helper_XXXXXX";
    *state = mkdtemp(folder);
    unsetenv("WRINKLE_READER");
    unsetenv("WRINKLE_READER_SECONDS");
    unsetenv("WRINKLE_READER_MB");
    return *state ? chdir(folder) : -1;
}

static inline int remove_folder(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    return chdir("/") || system(command);
}
