/* The process that reads strangers' files: that it can be killed, starved, stopped and lied about, and that
   the program notices in one sentence and goes on. */
#include "test.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "image/font.h"
#include "image/image.h"
#include "image/mesh.h"

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

/* ---- what runs ---- */

static bool is_reader(pid_t pid)
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
static int readers_of(pid_t parent, pid_t *found)
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
static pid_t the_process(void)
{
    pid_t found[64];
    assert_int_equal(readers_of(getpid(), found), 1);
    return found[0];
}

/* The one child that reads a file now. Those of files closed before end a moment later. */
static pid_t the_child(void)
{
    pid_t found[64];
    double until = wr_clock_seconds() + 10.0;
    while (readers_of(the_process(), found) != 1) {
        if (wr_clock_seconds() > until) fail_msg("not one child");
        usleep(1000);
    }
    return found[0];
}

/* Children end a moment after they were told to. */
static void expect_no_children(void)
{
    pid_t found[64];
    double until = wr_clock_seconds() + 10.0;
    while (readers_of(the_process(), found) > 0) {
        if (wr_clock_seconds() > until) fail_msg("readers are left over");
        usleep(1000);
    }
}

static int open_descriptors(void)
{
    DIR *folder = opendir("/proc/self/fd");
    int count = 0;
    while (readdir(folder)) count++;
    closedir(folder);
    return count;
}

/* A number of /proc/PID/status, -1 if it is not there. */
static long status_of(pid_t pid, const char *name)
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

/* A zombie that nobody has reaped yet counts as gone: it has no memory. */
static void expect_gone(pid_t pid)
{
    double until = wr_clock_seconds() + 10.0;
    while (is_reader(pid) && status_of(pid, "VmSize:") > 0) {
        if (wr_clock_seconds() > until) fail_msg("the reader process lives on");
        usleep(1000);
    }
}

/* ---- pictures ---- */

#define SIDE 300

static void write_picture(const char *path)
{
    WrError err = { "" };
    uint16_t *codes = malloc(SIDE * SIDE * sizeof *codes);
    TestRandom random = { 7 };
    for (int i = 0; i < SIDE * SIDE; i++) codes[i] = (uint16_t)test_random_u64(&random);
    if (!wr_image_write_pixels(path, SIDE, SIDE, 1, WR_PIXEL_U16, true, codes, &err))
        fail_msg("%s", err.text);
    free(codes);
}

static void expect_good(const char *path)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    TestRandom random = { 7 };
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_true(image->data[i] == (float)(uint16_t)test_random_u64(&random) / 65535.0f);
    wr_image_free(image);
}

/* One line that begins with the file's name and holds the word. */
static void expect_message(const WrError *err, const char *name, const char *word)
{
    if (strncmp(err->text, name, strlen(name)) != 0 || strchr(err->text, '\n') ||
        !strstr(err->text, word))
        fail_msg("message '%s': should begin with %s and say '%s'", err->text, name, word);
}

static WrImageFile *open_good(const char *path)
{
    WrError err = { "" };
    WrImageFile *file = wr_image_file_open(path, &err);
    if (!file) fail_msg("%s", err.text);
    return file;
}

static void expect_unreadable(WrImageFile *file, const char *name, const char *word)
{
    static float out[SIDE * SIDE];
    for (int again = 0; again < 2; again++) { /* and the second time as well */
        WrError err = { "" };
        assert_false(wr_image_file_read(file, 0, out, &err));
        expect_message(&err, name, word);
    }
    assert_null(wr_image_file_attribute(file, 0, "wrinkle:anything"));
}

/* ---- deaths ---- */

/* The sanitizers catch these signals and end the process themselves. */
#if SANITIZED
#define CRASH(name) ""
#else
#define CRASH(name) " (" name ")"
#endif

static void a_crash_is_one_sentence_and_the_next_file_reads(void **state)
{
    (void)state;
    const struct {
        int signal;
        const char *word;
    } deaths[] = {
        { SIGSEGV, "the reader crashed on this file" CRASH(
                       "Segmentation fault") "; it is damaged or hostile" },
        { SIGBUS, "the reader crashed on this file" CRASH("Bus error") },
        { SIGABRT, "the reader crashed on this file (Aborted)" },
        { SIGKILL, "the reader was killed while it read this file" },
        { SIGXCPU, "gave nothing to read within" },
    };
    write_picture("a.png");
    for (size_t i = 0; i < sizeof deaths / sizeof *deaths; i++) {
        WrImageFile *file = open_good("a.png");
        kill(the_child(), deaths[i].signal);
        expect_unreadable(file, "a.png: ", deaths[i].word);
        wr_image_file_close(file);
        expect_good("a.png");
    }
    expect_no_children();
}

static void the_process_is_started_again_when_it_was_killed(void **state)
{
    (void)state;
    write_picture("a.png");
    expect_good("a.png");
    pid_t before = the_process();
    WrImageFile *file = open_good("a.png");
    pid_t child = the_child();
    kill(before, SIGKILL);
    expect_gone(child); /* it goes with its parent */
    expect_unreadable(file, "a.png: ", "was killed");
    wr_image_file_close(file);
    expect_good("a.png");
    assert_int_not_equal(the_process(), before); /* one, and no zombie of the old one */
    /* Killed while it still loads. */
    kill(the_process(), SIGKILL);
    wr_image_warm();
    expect_good("a.png");
    kill(the_process(), SIGKILL);
    usleep(50000);
    wr_image_warm();
    expect_good("a.png");
    the_process();
}

typedef struct Killer {
    pthread_t thread;
    volatile int stop;
    int killed;
} Killer;

static void *kill_children(void *ctx)
{
    Killer *killer = ctx;
    TestRandom random = { 5 };
    pid_t process = the_process(), found[64];
    while (!__atomic_load_n(&killer->stop, __ATOMIC_ACQUIRE)) {
        usleep((unsigned)(test_random(&random) * 4000));
        int count = readers_of(process, found);
        for (int i = 0; i < count; i++) killer->killed += kill(found[i], SIGSEGV) == 0;
    }
    return NULL;
}

static void killed_at_random_moments_gives_a_picture_or_a_sentence(void **state)
{
    (void)state;
    Killer killer = { 0 };
    write_picture("a.png");
    expect_good("a.png");
    pthread_create(&killer.thread, NULL, kill_children, &killer);
    int good = 0, bad = 0;
    for (int i = 0; i < 200 && (i < 40 || bad == 0); i++) {
        WrError err = { "" };
        WrImage *image = wr_image_read("a.png", &err);
        if (!image) expect_message(&err, "a.png: ", "the reader");
        good += image != NULL;
        bad += image == NULL;
        wr_image_free(image);
    }
    __atomic_store_n(&killer.stop, 1, __ATOMIC_RELEASE);
    pthread_join(killer.thread, NULL);
    assert_true(bad > 0); /* else nothing was tried */
    expect_good("a.png");
    expect_no_children();
}

/* ---- limits ---- */

static void a_reader_that_says_nothing_is_ended(void **state)
{
    (void)state;
    write_picture("slow.png");
    expect_good("slow.png");
    setenv("WRINKLE_READER_SECONDS", "1", 1);
    WrImageFile *file = open_good("slow.png");
    pid_t child = the_child();
    kill(child, SIGSTOP);
    double begin = wr_clock_seconds();
    expect_unreadable(file, "slow.png: ", "gave nothing to read within 1 s");
    double took = wr_clock_seconds() - begin;
    assert_true(took >= 0.99 && took < 5.0);
    expect_no_children(); /* a stopped process can be killed */
    wr_image_file_close(file);
    /* The whole process stopped: opening does not wait for ever either. */
    pid_t process = the_process();
    kill(process, SIGSTOP);
    WrError err = { "" };
    assert_null(wr_image_read("slow.png", &err));
    expect_message(&err, "slow.png: ", "gave nothing to read within 1 s");
    kill(process, SIGCONT);
    unsetenv("WRINKLE_READER_SECONDS");
    expect_good("slow.png");
    expect_no_children();
}

/* Seconds of processor time that children of the reader process took which it has seen ending. */
static double seconds_of_children(void)
{
    char path[64];
    unsigned long user = 0, system = 0;
    snprintf(path, sizeof path, "/proc/%d/stat", (int)the_process());
    FILE *file = fopen(path, "r");
    if (!file ||
        fscanf(file, "%*d (%*[^)]) %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %lu %lu",
               &user, &system) != 2)
        fail_msg("%s cannot be read", path);
    fclose(file);
    return (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
}

/* One face of so many corners that cutting it up takes minutes. */
static void write_busy_mesh(WrText *text)
{
    wr_text_add(text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    for (int i = 0; i < 200000; i++) wr_text_addf(text, " %d", i % 3 + 1);
    wr_text_add(text, "\n");
}

static void a_mesh_gets_its_time_once(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrMesh mesh;
    WrError err = { "" };
    write_busy_mesh(&text);
    write_picture("a.png");
    expect_good("a.png"); /* the process is there, with its libraries */
    expect_no_children();
    double before = seconds_of_children();
    setenv("WRINKLE_READER_SECONDS", "2", 1);
    assert_false(wr_mesh_read_bytes("busy.obj", text.data, text.length, &mesh, &err));
    unsetenv("WRINKLE_READER_SECONDS");
    expect_message(&err, "busy.obj: ", "gave nothing to read within 2 s");
    expect_no_children();
    assert_true(seconds_of_children() - before < 2.5);
    wr_text_fini(&text);
}

/* ---- nothing comes at all ---- */

typedef bool (*Reading)(WrError *err);

static bool read_picture_file(WrError *err)
{
    return wr_image_read("a.png", err) != NULL;
}

static bool read_mesh_file(WrError *err)
{
    WrMesh mesh;
    return wr_mesh_read("a.png", &mesh, err);
}

static bool read_font_file(WrError *err)
{
    WrFontText text;
    WrFontAsk ask = { .text = "a" };
    return wr_font_shape("a.png", &ask, &text, err);
}

static void *wait_for_nothing(void *reading)
{
    double begin = wr_clock_seconds();
    WrError err = { "" };
    assert_false((*(Reading *)reading)(&err));
    expect_message(&err, "a.png: ", "gave nothing to read within 4 s");
    double took = wr_clock_seconds() - begin;
    return took >= 3.99 && took < 7.0 ? NULL : reading;
}

static void every_kind_of_file_waits_for_its_time_once(void **state)
{
    (void)state;
    Reading readings[] = { read_picture_file, read_mesh_file, read_font_file };
    pthread_t threads[3];
    write_picture("a.png");
    expect_good("a.png");
    setenv("WRINKLE_READER_SECONDS", "4", 1);
    pid_t process = the_process();
    kill(process, SIGSTOP);
    for (int i = 0; i < 3; i++) pthread_create(&threads[i], NULL, wait_for_nothing, &readings[i]);
    for (int i = 0; i < 3; i++) {
        void *wrong;
        pthread_join(threads[i], &wrong);
        assert_null(wrong);
    }
    kill(process, SIGCONT);
    unsetenv("WRINKLE_READER_SECONDS");
    expect_good("a.png");
    expect_no_children();
}

static uint32_t crc_of(const unsigned char *bytes, size_t count)
{
    uint32_t crc = 0xffffffffU;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320U ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

static size_t put32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> (24 - 8 * i));
    return 4;
}

static size_t put_chunk(unsigned char *at, const char *name, const void *data, uint32_t length)
{
    put32(at, length);
    memcpy(at + 4, name, 4);
    if (length) memcpy(at + 8, data, length);
    put32(at + 8 + length, crc_of(at + 4, 4 + (size_t)length));
    return 12 + (size_t)length;
}

/* A sound PNG header that claims side x side pixels of four 16-bit channels, and next to no data. */
static void write_claim(const char *path, uint32_t side, bool interlaced)
{
    static const unsigned char data[] = { 0x78, 0x9c, 0x63, 0x60, 0x60, 0x00, 0x00 };
    unsigned char png[256] = "\x89PNG\r\n\x1a\n", header[13] = { 0 };
    size_t n = 8;
    put32(header, side);
    put32(header + 4, side);
    header[8] = 16;
    header[9] = 6;
    header[12] = interlaced;
    n += put_chunk(png + n, "IHDR", header, sizeof header);
    n += put_chunk(png + n, "IDAT", data, sizeof data);
    n += put_chunk(png + n, "IEND", NULL, 0);
    WrError err;
    assert_true(wr_file_write(path, png, n, &err));
}

static void a_claim_of_gigabytes_is_one_sentence(void **state)
{
    (void)state;
    WrError err = { "" };
    write_claim("claim.png", 16384, false);
    assert_null(wr_image_read("claim.png", &err));
    expect_message(&err, "claim.png: ", "truncated or damaged");
    if (SANITIZED) return; /* they have no limit on memory */
    /* An interlaced picture is decoded as a whole: 2 GB. */
    write_claim("claim.png", 16384, true);
    setenv("WRINKLE_READER_MB", "700", 1);
    assert_null(wr_image_read("claim.png", &err));
    expect_message(&err, "claim.png: ", "needs more than 700 MB of memory to be read");
    write_picture("small.png");
    expect_good("small.png");
    unsetenv("WRINKLE_READER_MB");
    write_claim("claim.png", 16385, false);
    assert_null(wr_image_read("claim.png", &err));
    expect_message(&err, "claim.png: ", "each side must be 1..16384");
}

/* ---- many ---- */

static void read_one(int index, int worker, void *ctx)
{
    (void)worker;
    (void)index;
    WrError err;
    WrImage *image = wr_image_read("a.png", &err);
    if (image && image->width == SIDE) __atomic_fetch_add((int *)ctx, 1, __ATOMIC_RELAXED);
    wr_image_free(image);
}

static void many_readings_leave_no_process_and_no_descriptor(void **state)
{
    (void)state;
    write_picture("a.png");
    expect_good("a.png");
    pid_t process = the_process();
    int before = open_descriptors(), good = 0;
    WrPool *pool = wr_pool_new(7);
    wr_pool_run(pool, 70, read_one, &good);
    wr_pool_free(pool);
    assert_int_equal(good, 70);
    assert_int_equal(the_process(), process); /* one process for all */
    expect_no_children();
    assert_int_equal(open_descriptors(), before);
}

static void files_that_are_open_together_do_not_mix(void **state)
{
    (void)state;
    enum { FILES = 20 };
    WrImageFile *files[FILES];
    char path[32];
    WrError err = { "" };
    for (int i = 0; i < FILES; i++) {
        float value[4] = { (float)i, 1, 2, 3 };
        snprintf(path, sizeof path, "f%d.exr", i);
        assert_true(wr_image_write_pixels(path, 2, 2, 1, WR_PIXEL_F32, true, value, &err));
        files[i] = open_good(path);
    }
    for (int i = FILES - 1; i >= 0; i--) {
        float out[4];
        assert_true(wr_image_file_read(files[i], 0, out, &err));
        assert_true(out[0] == (float)i && out[3] == 3.0f);
        wr_image_file_close(files[i]);
    }
    expect_no_children();
}

static void a_picture_in_memory_reads_like_its_file(void **state)
{
    (void)state;
    char *bytes;
    size_t length;
    WrError err = { "" };
    write_picture("a.png");
    assert_true(wr_file_read("a.png", 1 << 24, &bytes, &length, &err));
    WrImage *file = wr_image_read("a.png", &err);
    WrImage *image = wr_image_read_bytes("data/one.png", bytes, length, &err);
    if (!image) fail_msg("%s", err.text);
    assert_memory_equal(image->data, file->data, SIDE * SIDE * sizeof(float));
    wr_image_free(image);
    wr_image_free(file);
    assert_null(wr_image_read_bytes("data/one.png", bytes, length / 2, &err));
    expect_message(&err, "data/one.png: ", "truncated");
    assert_null(wr_image_read_bytes("data/one.png", bytes, 0, &err));
    expect_message(&err, "data/one.png: ", "is empty");
    wr_free(bytes);
}

/* ---- what it must not do ---- */

static void a_reader_holds_its_file_its_channel_and_no_rights(void **state)
{
    (void)state;
    write_picture("a.png");
    FILE *mine = fopen("secret", "w"); /* not closed on exec */
    WrImageFile *file = open_good("a.png");
    pid_t child = the_child();
    char path[64], target[256];
    snprintf(path, sizeof path, "/proc/%d/fd", (int)child);
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (entry->d_name[0] == '.') continue;
        char link[400];
        snprintf(link, sizeof link, "%s/%s", path, entry->d_name);
        ssize_t n = readlink(link, target, sizeof target - 1);
        target[n > 0 ? n : 0] = '\0';
        if (strcmp(target, "/dev/null") != 0 && strncmp(target, "socket:", 7) != 0 &&
            !strstr(target, "/a.png"))
            fail_msg("descriptor %s is %s", entry->d_name, target);
    }
    closedir(folder);
    assert_int_equal(status_of(child, "NoNewPrivs:"), 1);
    if (!SANITIZED) assert_int_equal(status_of(child, "Seccomp:"), 2); /* a filter */
    wr_image_file_close(file);
    fclose(mine);
}

/* SGI pictures: the library's reader of them takes nothing but a path, and no path can be opened there. */
static void a_format_that_insists_on_a_path_reads_too(void **state)
{
    (void)state;
    unsigned char sgi[512 + 4] = { 0x01, 0xda, 0, 1, 0, 2, 0, 2, 0, 2, 0, 1 };
    WrError err = { "" };
    for (int i = 0; i < 4; i++) sgi[512 + i] = (unsigned char)(50 * i); /* the lowest row first */
    sgi[19] = 255;                                                      /* the largest value */
    assert_true(wr_file_write("a.sgi", sgi, sizeof sgi, &err));
    WrImage *image = wr_image_read("a.sgi", &err);
    if (!image) fail_msg("%s", err.text);
    const float want[4] = { 100 / 255.0f, 150 / 255.0f, 0, 50 / 255.0f };
    assert_memory_equal(image->data, want, sizeof want);
    wr_image_free(image);
}

static void a_forked_copy_of_the_program_reads_too_and_leaves_the_process_alone(void **state)
{
    (void)state;
    write_picture("a.png");
    expect_good("a.png");
    pid_t before = the_process(), pid = fork();
    if (pid == 0) {
        WrError err;
        WrImage *image = wr_image_read("a.png", &err);
        _exit(image && image->width == SIDE ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_int_equal(status, 0);
    expect_good("a.png");
    assert_int_equal(the_process(), before);
}

/* This program as another one: reads a file and ends, or is killed. */
static void the_process_ends_with_the_program(void **state)
{
    (void)state;
    write_picture("a.png");
    char program[1024];
    ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    program[n > 0 ? n : 0] = '\0';
    for (int killed = 0; killed < 2; killed++) {
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        pid_t pid = fork();
        if (pid == 0) {
            dup2(ends[1], STDOUT_FILENO);
            execl(program, program, killed ? "--hold" : "--read", "a.png", (char *)NULL);
            _exit(9);
        }
        close(ends[1]);
        char line[64] = "";
        ssize_t got = read(ends[0], line, sizeof line - 1);
        assert_true(got > 0);
        pid_t reader = (pid_t)atoi(line);
        assert_true(reader > 0);
        if (killed) kill(pid, SIGKILL);
        waitpid(pid, NULL, 0);
        expect_gone(reader);
        close(ends[0]);
    }
}

static int as_another_program(const char *path, bool hold)
{
    WrError err;
    pid_t found[64];
    WrImageFile *file = wr_image_file_open(path, &err);
    if (!file || readers_of(getpid(), found) != 1) return 3;
    printf("%d\n", (int)found[0]);
    fflush(stdout);
    if (hold) pause();
    wr_image_file_close(file);
    return 0;
}

static int enter_folder(void **state)
{
    static char folder[] = "/tmp/wr_helper_XXXXXX";
    *state = mkdtemp(folder);
    unsetenv("WRINKLE_READER");
    unsetenv("WRINKLE_READER_SECONDS");
    unsetenv("WRINKLE_READER_MB");
    return *state ? chdir(folder) : -1;
}

static int remove_folder(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    return chdir("/") || system(command);
}

int main(int argc, char **argv)
{
    if (argc == 3) return as_another_program(argv[2], strcmp(argv[1], "--hold") == 0);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crash_is_one_sentence_and_the_next_file_reads),
        cmocka_unit_test(the_process_is_started_again_when_it_was_killed),
        cmocka_unit_test(killed_at_random_moments_gives_a_picture_or_a_sentence),
        cmocka_unit_test(a_reader_that_says_nothing_is_ended),
        cmocka_unit_test(a_mesh_gets_its_time_once),
        cmocka_unit_test(every_kind_of_file_waits_for_its_time_once),
        cmocka_unit_test(a_claim_of_gigabytes_is_one_sentence),
        cmocka_unit_test(many_readings_leave_no_process_and_no_descriptor),
        cmocka_unit_test(files_that_are_open_together_do_not_mix),
        cmocka_unit_test(a_picture_in_memory_reads_like_its_file),
        cmocka_unit_test(a_reader_holds_its_file_its_channel_and_no_rights),
        cmocka_unit_test(a_format_that_insists_on_a_path_reads_too),
        cmocka_unit_test(a_forked_copy_of_the_program_reads_too_and_leaves_the_process_alone),
        cmocka_unit_test(the_process_ends_with_the_program),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
