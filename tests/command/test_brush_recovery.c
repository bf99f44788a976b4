/* A crash after painting with presets and tips: the painting is recovered though their files have changed or
   vanished. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "command/session.h"
#include "command/recovery.h"
#include "image/image.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static void write_tip(const char *path, int shade)
{
    uint8_t grey[16 * 16];
    WrError err;
    for (int i = 0; i < 256; i++) grey[i] = (uint8_t)(i / 2 + shade);
    if (!wr_image_write_pixels(path, 16, 16, 1, WR_PIXEL_U8, true, grey, &err))
        fail_msg("%s", err.text);
}

/* With the tip beside it if it names one. */
static void write_preset(const char *path, double radius, const char *tip)
{
    char text[1024], more[300] = "", hex[65];
    WrError err;
    if (tip) {
        char *folder = wr_path_folder(path), *beside = wr_path_join(folder, tip);
        assert_true(wr_sha256_file(beside, hex, &err));
        snprintf(more, sizeof more, ", \"wrinkle\": {\"tip\" : \"%s\", \"tip_sha256\": \"%s\"}",
                 tip, hex);
        wr_free(folder);
        wr_free(beside);
    }
    snprintf(text, sizeof text,
             "{\"version\": 3, \"comment\": \"the \\\"tip\\\": no file\", \"settings\": {"
             "\"radius_logarithmic\": {\"base_value\": %g, \"inputs\": {}},"
             "\"opaque\": {\"base_value\": 0.8, \"inputs\": {}}}%s}",
             radius, more);
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

/* Recover the only journal. */
static WrHash recovered(void)
{
    WrRecoverable *found;
    WrError err = { "" };
    int count;
    WrRecovered how;
    assert_true(wr_recovery_list(&found, &count, &err));
    assert_int_equal(count, 1);
    WrSessionOptions options = { .journal = true };
    WrSession *s = wr_session_new(&options);
    if (!wr_session_recover(s, found[0].journal, false, &how, &err)) fail_msg("%s", err.text);
    if (!how.whole || !how.removed) fail_msg("%s", wr_text_get(&how.report));
    WrHash hash = wr_session_hash(s);
    wr_session_free(s);
    wr_recovery_list_free(found, count);
    wr_recovered_fini(&how);
    return hash;
}

static const char *const lines[] = {
    "table 128x128",
    "stroke points=0.1,0.2;0.5,0.6,0.5;0.9,0.3 preset=a/plain.myb tip=a/own.png radius=20",
    "dab 0.3,0.3 preset=a/plain.myb",
    "stroke points=0.9,0.9;0.1,0.8 preset=b/stamp.myb radius=15",
    "shape rectangle a=0.2,0.2 b=0.7,0.7 tip=b/leaf.png radius=9",
};
#define LINES (sizeof lines / sizeof *lines)

static void make_brushes(void)
{
    mkdir("a", 0700);
    mkdir("b", 0700);
    write_tip("a/own.png", 10);
    write_tip("b/leaf.png", 90);
    write_preset("a/plain.myb", 2.5, NULL);
    write_preset("b/stamp.myb", 2.8, "leaf.png");
}

/* Run the lines, draw half a stroke, and be killed; returns the document's hash. */
static WrHash paint_and_be_killed(void)
{
    int pipes[2], status;
    const WrSample samples[] = { { .u = 0.2, .v = 0.3, .pressure = 1 },
                                 { .u = 0.5, .v = 0.6, .pressure = 0.7 } };
    WrHash hash;
    assert_int_equal(pipe(pipes), 0);
    pid_t child = fork();
    if (child == 0) {
        WrSessionOptions options = { .journal = true };
        WrSession *s = wr_session_new(&options);
        bool good = true;
        for (size_t i = 0; i < LINES; i++) good = good && wr_session_run(s, lines[i], NULL);
        good = good && wr_session_stroke_begin(s, "stroke preset=b/stamp.myb radius=30", NULL) &&
               wr_session_stroke_push(s, samples, 2, NULL);
        if (good && write(pipes[1], "x", 1) == 1)
            for (;;) pause();
        _exit(1);
    }
    char byte = 0;
    close(pipes[1]);
    assert_int_equal(read(pipes[0], &byte, 1), 1);
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    close(pipes[0]);
    WrSession *s = wr_session_new(NULL);
    for (size_t i = 0; i < LINES; i++) must_run(s, lines[i]);
    must_run(s, "stroke points=0.2,0.3;0.5,0.6,0.7 preset=b/stamp.myb radius=30");
    hash = wr_session_hash(s);
    wr_session_free(s);
    return hash;
}

static void killed_and_recovered_with_the_files_as_they_were(void **state)
{
    (void)state;
    make_brushes();
    WrHash want = paint_and_be_killed();
    assert_true(wr_hash_equal(want, recovered()));
}

static void killed_and_recovered_though_the_files_changed(void **state)
{
    (void)state;
    make_brushes();
    WrHash want = paint_and_be_killed();
    write_tip("a/own.png", 50);
    write_tip("b/leaf.png", 30);
    write_preset("a/plain.myb", 3, NULL);
    write_preset("b/stamp.myb", 2, "leaf.png");
    assert_true(wr_hash_equal(want, recovered()));
}

static void killed_and_recovered_though_the_files_are_gone(void **state)
{
    (void)state;
    make_brushes();
    WrHash want = paint_and_be_killed();
    assert_int_equal(unlink("a/own.png") | unlink("b/leaf.png") | unlink("a/plain.myb") |
                         unlink("b/stamp.myb"),
                     0);
    assert_true(wr_hash_equal(want, recovered()));
}

/* A redo to a state before the journal restarts it from a snapshot, without its former copies. */
static void a_journal_that_begins_anew_keeps_the_files_again(void **state)
{
    (void)state;
    make_brushes();
    WrSession *s = session_of((const char *[]){ "table 80x80", "dab 0.2,0.5 preset=a/plain.myb",
                                                "fill 0.5", "undo", NULL });
    wr_session_set_journal(s, true);
    must_run(s, "redo");
    must_run(s, "dab 0.7,0.5 preset=a/plain.myb");
    WrHash want = wr_session_hash(s);
    wr_session_journal_leave(s);
    wr_session_free(s);
    unlink("a/plain.myb");
    assert_true(wr_hash_equal(want, recovered()));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(killed_and_recovered_with_the_files_as_they_were),
        cmocka_unit_test(killed_and_recovered_though_the_files_changed),
        cmocka_unit_test(killed_and_recovered_though_the_files_are_gone),
        cmocka_unit_test(a_journal_that_begins_anew_keeps_the_files_again),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}
