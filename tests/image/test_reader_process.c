/* The reader process: it can be killed, starved, stopped and fed wrong data; the program reports each case in one
   message and continues. */
#include "reader_help.h"

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
        { SIGXCPU, "no data was read from it within" },
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
    expect_gone(child); /* it ends with its parent */
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
    int bad = 0;
    for (int i = 0; i < 200 && (i < 40 || bad == 0); i++) {
        WrError err = { "" };
        WrImage *image = wr_image_read("a.png", &err);
        if (!image) expect_message(&err, "a.png: ", "the reader");
        bad += image == NULL;
        wr_image_free(image);
    }
    __atomic_store_n(&killer.stop, 1, __ATOMIC_RELEASE);
    pthread_join(killer.thread, NULL);
    assert_true(bad > 0); /* otherwise nothing was tested */
    expect_good("a.png");
    expect_no_children();
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

/* ---- forbidden actions ---- */

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
    if (!SANITIZED) assert_int_equal(status_of(child, "Seccomp:"), 2); /* a filter is set */
    wr_image_file_close(file);
    fclose(mine);
}

/* SGI pictures: the library's reader accepts only a path, and no path can be opened there. */
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

/* A picture of its own code is read by a fork without the library, which is large; the library's process may die. */
static void libraries_are_loaded_in_a_process_of_their_own(void **state)
{
    (void)state;
    pid_t found[64], second = 0;
    write_picture("a.png");
    write_picture("a.tif");
    for (int round = 0; round < 3; round++) {
        expect_good("a.tif");
        expect_no_children();
        assert_int_equal(readers_of(the_process(), found), 1);
        assert_int_not_equal(found[0], second); /* a new one */
        second = found[0];
        WrImageFile *file = open_good("a.png");
        assert_int_equal(readers_of(second, found), 0);
        assert_int_equal(readers_of(the_process(), found), 2);
        wr_image_file_close(file);
        kill(second, SIGKILL);
        expect_gone(second);
    }
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

int main(int argc, char **argv)
{
    if (argc == 3) return as_another_program(argv[2], strcmp(argv[1], "--hold") == 0);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crash_is_one_sentence_and_the_next_file_reads),
        cmocka_unit_test(the_process_is_started_again_when_it_was_killed),
        cmocka_unit_test(killed_at_random_moments_gives_a_picture_or_a_sentence),
        cmocka_unit_test(many_readings_leave_no_process_and_no_descriptor),
        cmocka_unit_test(files_that_are_open_together_do_not_mix),
        cmocka_unit_test(a_picture_in_memory_reads_like_its_file),
        cmocka_unit_test(a_reader_holds_its_file_its_channel_and_no_rights),
        cmocka_unit_test(a_format_that_insists_on_a_path_reads_too),
        cmocka_unit_test(libraries_are_loaded_in_a_process_of_their_own),
        cmocka_unit_test(a_forked_copy_of_the_program_reads_too_and_leaves_the_process_alone),
        cmocka_unit_test(the_process_ends_with_the_program),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
