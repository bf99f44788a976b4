/* Films: messages and remaining files if ffmpeg is missing, dies, hangs, writes wrong data or is cancelled. A script
   replaces the program and stores frames unchanged; tests/cli/films.sh uses the real one. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "export/film.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/thread.h"

#include <signal.h>
#include <sys/wait.h>

#define WIDTH 37
#define HEIGHT 21
#define FRAMES 5

static char path_before[4096];

/* ---- the script ---- */

/* Create a program named ffmpeg, the only one in the first folder of PATH. NULL: PATH is an empty folder. */
static void put_ffmpeg(const char *text)
{
    char path[4400], here[256];
    assert_non_null(getcwd(here, sizeof here));
    mkdir("bin", 0700);
    unlink("bin/ffmpeg");
    if (text) {
        FILE *file = fopen("bin/ffmpeg", "w");
        assert_non_null(file);
        fprintf(file, "#!/bin/sh\n%s\n", text);
        fclose(file);
        chmod("bin/ffmpeg", 0700);
        snprintf(path, sizeof path, "%s/bin:%s", here, path_before);
    } else {
        snprintf(path, sizeof path, "%s/bin", here);
    }
    setenv("PATH", path, 1);
}

/* Frames in, frames out: $FILE is the file, $READS is 1 when they are read back. */
#define CODEC                                                                                      \
    "READS=0; PREVIOUS=; FILE=\n"                                                                  \
    "for WORD; do\n"                                                                               \
    "  case $PREVIOUS in -i) [ \"$WORD\" = pipe:0 ] || FILE=${WORD#file:} ;; esac\n"               \
    "  case $WORD in pipe:1) READS=1 ;; esac\n"                                                    \
    "  PREVIOUS=$WORD\n"                                                                           \
    "done\n"                                                                                       \
    "[ $READS = 1 ] || FILE=${PREVIOUS#file:}\n"
#define KEEPS CODEC "if [ $READS = 1 ]; then cat \"$FILE\"; else cat >\"$FILE\"; fi"

/* ---- a film ---- */

static void draw(int frame, int channels, uint8_t *pixels)
{
    TestRandom random = { (uint64_t)frame * 977 + 5 };
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
        pixels[i] = (uint8_t)(test_random_u64(&random) >> 3);
}

static bool make(const char *path, double patience, WrFilmReport *report, WrError *err)
{
    uint8_t pixels[WIDTH * HEIGHT * 3];
    const WrFilmOptions options = {
        .width = WIDTH, .height = HEIGHT, .fps = 12.5, .patience = patience
    };
    WrFilm *film = wr_film_begin(path, &options, err);
    if (!film) return false;
    for (int frame = 0; frame < FRAMES; frame++) {
        draw(frame, 3, pixels);
        if (!wr_film_add(film, pixels, err)) {
            wr_film_drop(film);
            return false;
        }
    }
    return wr_film_end(film, report, err);
}

static void put_old(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("old", file);
    fclose(file);
}

static bool is_old(const char *path)
{
    char text[8] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t n = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    return n == 3 && strcmp(text, "old") == 0;
}

/* Number of files in this folder whose names begin with a dot. */
static int left_over(void)
{
    int count = 0;
    WrFolder *folder = wr_folder_open(".");
    for (const char *name; (name = wr_folder_next(folder));) count += name[0] == '.';
    wr_folder_close(folder);
    return count;
}

/* It must fail with that message and leave the old file. */
static void expect_failure(const char *script, double patience, const char *words)
{
    WrError err = { "" };
    WrFilmReport report;
    put_old("turn.apng");
    put_ffmpeg(script);
    assert_false(make("turn.apng", patience, &report, &err));
    if (!strstr(err.text, words)) fail_msg("\"%s\" does not say \"%s\"", err.text, words);
    assert_true(is_old("turn.apng"));
    assert_int_equal(left_over(), 0);
}

static void frames_go_in_and_the_file_takes_its_name(void **state)
{
    (void)state;
    WrError err = { "" };
    WrFilmReport report;
    put_ffmpeg(KEEPS);
    if (!make("turn.apng", 0, &report, &err)) fail_msg("%s", err.text);
    assert_int_equal(report.frames, FRAMES);
    assert_int_equal(report.bytes, (int64_t)FRAMES * WIDTH * HEIGHT * 3);
    assert_true(report.worst == 0.0);
    assert_int_equal(left_over(), 0);
    FILE *file = fopen("turn.apng", "rb");
    for (int frame = 0; frame < FRAMES; frame++) {
        uint8_t want[WIDTH * HEIGHT * 3], have[sizeof want];
        draw(frame, 3, want);
        assert_int_equal(fread(have, 1, sizeof have, file), sizeof have);
        assert_memory_equal(want, have, sizeof want);
    }
    fclose(file);
}

static void odd_sizes_of_mp4_repeat_their_last_column_and_row(void **state)
{
    (void)state;
    WrError err = { "" };
    WrFilmReport report;
    put_ffmpeg(KEEPS);
    if (!make("turn.mp4", 0, &report, &err)) fail_msg("%s", err.text);
    assert_int_equal(report.width, WIDTH + 1);
    assert_int_equal(report.height, HEIGHT + 1);
    uint8_t want[WIDTH * HEIGHT * 3], have[(WIDTH + 1) * (HEIGHT + 1) * 3];
    FILE *file = fopen("turn.mp4", "rb");
    draw(0, 3, want);
    assert_int_equal(fread(have, 1, sizeof have, file), sizeof have);
    fclose(file);
    for (int y = 0; y <= HEIGHT; y++)
        for (int x = 0; x <= WIDTH; x++) {
            const int from_x = x < WIDTH ? x : WIDTH - 1, from_y = y < HEIGHT ? y : HEIGHT - 1;
            assert_memory_equal(have + 3 * (y * (WIDTH + 1) + x),
                                want + 3 * (from_y * WIDTH + from_x), 3);
        }
}

static void without_ffmpeg_its_package_is_named(void **state)
{
    (void)state;
#ifndef __SANITIZE_THREAD__ /* the sanitizer makes a fork of a vfork, so the child's error is
                               lost */
    expect_failure(NULL, 0,
                   "films are made by the program ffmpeg, which is not installed "
                   "(Debian's package ffmpeg)");
#endif
}

static void its_death_is_told_in_its_words(void **state)
{
    (void)state;
    expect_failure("head -c 3000 >/dev/null; echo 'the encoder broke' >&2; exit 3", 0,
                   "turn.apng: ffmpeg failed: the encoder broke");
    expect_failure("head -c 3000 >/dev/null; exit 3", 0,
                   "ffmpeg failed with status 3 and without a message");
    expect_failure("head -c 3000 >/dev/null; kill -9 $$", 0, "ffmpeg was killed");
    expect_failure("head -c 3000 >/dev/null; kill -11 $$", 0, "ffmpeg crashed (Segmentation");
    expect_failure("cat >/dev/null; exit 1", 0, "ffmpeg failed with status 1");
}

static void a_full_disk_says_what_helps(void **state)
{
    (void)state;
    expect_failure("cat >/dev/null; echo '[out#0] av_interleaved_write_frame(): No space left on "
                   "device' >&2; exit 228",
                   0, "No space left on device: make room");
}

static void what_it_wrote_is_read_back(void **state)
{
    (void)state;
    expect_failure("cat >/dev/null", 0, "ffmpeg wrote nothing");
    expect_failure(CODEC "if [ $READS = 1 ]; then cat \"$FILE\"; else head -c 9324 >\"$FILE\"; "
                         "cat >/dev/null; fi", /* 4 frames of 37 x 21 x 3 */
                   0, "5 frames were passed to ffmpeg, but the file has 4");
    expect_failure(CODEC "if [ $READS = 1 ]; then cat \"$FILE\"; else head -c 11000 >\"$FILE\"; "
                         "cat >/dev/null; fi",
                   0, "4 and a piece of one");
    expect_failure(CODEC "if [ $READS = 1 ]; then cat \"$FILE\"; else cat >once; "
                         "cat once once >\"$FILE\"; rm once; fi",
                   0, "5 frames were passed to ffmpeg, but the file has more");
    /* the same colours, some of them one code brighter */
    expect_failure(CODEC "if [ $READS = 1 ]; then tr '\\100' '\\101' <\"$FILE\"; "
                         "else cat >\"$FILE\"; fi",
                   0, "other colours");
    expect_failure(CODEC "if [ $READS = 1 ]; then cat /dev/zero; else cat >\"$FILE\"; fi", 0,
                   "but the file has more");
    expect_failure(CODEC "if [ $READS = 1 ]; then echo 'Invalid data' >&2; exit 1; "
                         "else cat >\"$FILE\"; fi",
                   0, "but the file has");
}

static void hanging_is_given_up(void **state)
{
    (void)state;
    expect_failure("exec sleep 100", 0.2, "ffmpeg hangs");
    expect_failure("cat >/dev/null; exec sleep 100", 0.2, "ffmpeg hangs");
    expect_failure(CODEC "if [ $READS = 1 ]; then exec sleep 100; else cat >\"$FILE\"; fi", 0.2,
                   "ffmpeg hangs");
}

/* ---- cancelled ---- */

static volatile int cancel;

static void *cancel_when_it_runs(void *ctx)
{
    while (access(ctx, F_OK) != 0) wr_thread_sleep_ms(1);
    __atomic_store_n(&cancel, 1, __ATOMIC_RELAXED);
    return NULL;
}

static void cancelled(const char *script)
{
    WrThread thread;
    const WrProgress progress = { .cancel = &cancel };
    cancel = 0;
    unlink("runs");
    assert_true(wr_thread_begin(&thread, cancel_when_it_runs, "runs"));
    const WrProgress *before = wr_progress_set(&progress);
    expect_failure(script, 0, "cancelled");
    wr_progress_set(before);
    wr_thread_join(thread);
}

static void cancel_ends_it_wherever_it_is(void **state)
{
    (void)state;
    cancelled(": >runs; exec sleep 100");                 /* reads nothing */
    cancelled("cat >/dev/null; : >runs; exec sleep 100"); /* does not end */
    cancelled(CODEC "if [ $READS = 1 ]; then : >runs; exec sleep 100; else cat >\"$FILE\"; fi");
}

/* ---- end of the child process ---- */

static bool runs(long pid)
{
    char path[64], state = 'Z';
    snprintf(path, sizeof path, "/proc/%ld/stat", pid);
    FILE *file = fopen(path, "r");
    if (!file) return false;
    const int got = fscanf(file, "%*d (%*[^)]) %c", &state);
    fclose(file);
    return got == 1 && state != 'Z';
}

static long pid_in(const char *path)
{
    long pid = 0;
    while (pid == 0) {
        FILE *file = fopen(path, "r");
        if (file && fscanf(file, "%ld\n", &pid) != 1) pid = 0;
        if (file) fclose(file);
        wr_thread_sleep_ms(1);
    }
    return pid;
}

static void it_is_killed_with_this_program(void **state)
{
    (void)state;
    WrError err;
    WrFilmReport report;
    put_ffmpeg("echo $$ >pid.part; mv pid.part pid; exec sleep 100");
    unlink("pid");
    const pid_t child = fork();
    if (child == 0) {
        make("turn.apng", 0, &report, &err);
        _exit(0);
    }
    const long pid = pid_in("pid");
    assert_true(runs(pid));
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    while (runs(pid)) wr_thread_sleep_ms(1); /* otherwise the test hangs */
    put_ffmpeg(KEEPS);
    if (!make("turn.apng", 0, &report, &err)) fail_msg("%s", err.text);
    assert_int_equal(left_over(), 0); /* its partial file was removed */
}

/* ---- refusals ---- */

static void expect_refusal(const char *path, WrFilmOptions options, const char *words)
{
    WrError err = { "" };
    WrFilm *film = wr_film_begin(path, &options, &err);
    assert_null(film);
    if (!strstr(err.text, words)) fail_msg("\"%s\" does not say \"%s\"", err.text, words);
}

static void what_a_format_lacks_is_refused(void **state)
{
    (void)state;
    const WrFilmOptions good = { .width = 8, .height = 8, .fps = 25 };
    WrFilmOptions o = good;
    put_ffmpeg("exit 9");
    expect_refusal("x.avi", good, "must end in gif, apng, webp or mp4");
    o.fps = 51;
    expect_refusal("x.gif", o, "0.1..50 frames a second of GIF");
    o.fps = NAN;
    expect_refusal("x.mp4", o, "frames a second");
    o = good;
    o.loop = 2;
    expect_refusal("x.mp4", o, "do not store a number of repetitions");
    o.loop = 65536;
    expect_refusal("x.gif", o, "0 (endless) to 65535");
    o = good;
    o.width = 8193;
    expect_refusal("x.mp4", o, "1 to 8192 pixels");
    o = good;
    o.alpha = true;
    expect_refusal("x.gif", o, "GIF has no transparency");
    expect_refusal("nowhere/x.gif", good, "nowhere");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_go_in_and_the_file_takes_its_name),
        cmocka_unit_test(odd_sizes_of_mp4_repeat_their_last_column_and_row),
        cmocka_unit_test(without_ffmpeg_its_package_is_named),
        cmocka_unit_test(its_death_is_told_in_its_words),
        cmocka_unit_test(a_full_disk_says_what_helps),
        cmocka_unit_test(what_it_wrote_is_read_back),
        cmocka_unit_test(hanging_is_given_up),
        cmocka_unit_test(cancel_ends_it_wherever_it_is),
        cmocka_unit_test(it_is_killed_with_this_program),
        cmocka_unit_test(what_a_format_lacks_is_refused),
    };
    snprintf(path_before, sizeof path_before, "%s", getenv("PATH"));
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
