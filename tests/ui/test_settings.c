/* The settings file: written by several windows, any of which may be killed. */
#include "test.h"

#include "base/file.h"
#include "base/memory.h"
#include "document/journal_help.h"
#include "ui/app/state/settings.h"

#include <fcntl.h>
#include <sys/file.h>

static int setup(void **state)
{
    return make_place(state) == 0 ? setenv("XDG_CONFIG_HOME", *state, 1) : -1;
}

/* A window: last known state of the file, and its own settings. */
typedef struct Window {
    WrSettings known, own;
} Window;

static Window open_window(void)
{
    Window window = { .own = wr_settings_default() };
    wr_settings_load(&window.own);
    window.known = wr_settings_copy(&window.own);
    return window;
}

static void write_window(Window *window)
{
    assert_true(wr_settings_update(&window->known, &window->own, true));
    wr_settings_take_lists(&window->own, &window->known);
}

static void close_window(Window *window)
{
    wr_settings_fini(&window->known);
    wr_settings_fini(&window->own);
}

static void two_windows_keep_what_each_of_them_changed(void **state)
{
    (void)state;
    Window a = open_window(), b = open_window();
    a.own.width = 1000;
    a.own.steady_smooth = 7;
    wr_settings_set_favourite(&a.own, "wrinkle/groove", true);
    wr_settings_set_favourite(&a.own, "wrinkle/pinch", true);
    wr_settings_add_recent(&a.own, "/a.exr");
    wr_settings_set_text(&a.own.preset, "wrinkle/groove");
    wr_settings_keep_pen(&a.own, "0 0 1 1 0 0 1 Big Pen");
    write_window(&a);
    b.own.height = 700;
    b.own.steady_smooth = 9;
    wr_settings_set_favourite(&b.own, "mypaint2/pencil", true);
    wr_settings_add_recent(&b.own, "/b.exr");
    wr_settings_note_used(&b.own, "round");
    wr_settings_keep_pen(&b.own, "0 0 1 1 0 0 2 Small Pen");
    write_window(&b);
    wr_settings_set_favourite(&a.own, "wrinkle/pinch", false);
    wr_settings_add_recent(&a.own, "/c.exr");
    wr_settings_add_recent(&a.own, "/a.exr");
    wr_settings_keep_pen(&a.own, "0 0 1 1 0 0 3 Big Pen");
    write_window(&a);
    b.own.divider = 0.25;
    write_window(&b);
    Window c = open_window();
    assert_true(c.own.width == 1000 && c.own.height == 700 && c.own.divider == 0.25);
    assert_true(c.own.steady_smooth == 9); /* the later one */
    assert_string_equal(c.own.preset, "wrinkle/groove");
    const char *const recent[] = { "/a.exr", "/c.exr", "/b.exr" };
    for (int i = 0; i < 3; i++) assert_string_equal(c.own.recent[i], recent[i]);
    assert_null(c.own.recent[3]);
    assert_string_equal(c.own.favourites[0], "wrinkle/groove");
    assert_string_equal(c.own.favourites[1], "mypaint2/pencil");
    assert_null(c.own.favourites[2]);
    assert_string_equal(c.own.used[0], "round");
    assert_string_equal(c.own.pens[0], "0 0 1 1 0 0 3 Big Pen");
    assert_string_equal(c.own.pens[1], "0 0 1 1 0 0 2 Small Pen");
    assert_null(c.own.pens[2]);
    assert_true(wr_settings_equal(&b.own, &b.known));
    assert_int_equal(wr_settings_find_favourite(&b.own, "wrinkle/pinch"),
                     -1); /* visible in b too */
    close_window(&a), close_window(&b), close_window(&c);
}

static void what_one_does_to_a_full_list_is_done_to_the_others(void **state)
{
    (void)state;
    Window a = open_window(), b = open_window();
    char path[16];
    for (int i = 0; i < 2 * WR_RECENT_MAX; i++) {
        snprintf(path, sizeof path, "/%d", i);
        wr_settings_add_recent(&a.own, path);
        write_window(&a);
    }
    wr_settings_add_recent(&b.own, "/b");
    write_window(&b);
    wr_settings_add_recent(&a.own, "/10"); /* moves to the front */
    write_window(&a);
    assert_string_equal(a.own.recent[0], "/10");
    assert_string_equal(a.own.recent[1], "/b");
    assert_string_equal(a.own.recent[2], "/15");
    assert_string_equal(a.own.recent[WR_RECENT_MAX - 1], "/9");
    close_window(&a), close_window(&b);
}

static void a_file_that_is_gone_or_empty_is_written_anew(void **state)
{
    Window a = open_window();
    char *path = in(*state, "wrinkle/window.conf");
    wr_settings_set_favourite(&a.own, "wrinkle/groove", true);
    write_window(&a);
    for (int i = 0; i < 2; i++) {
        if (i == 0) assert_int_equal(unlink(path), 0);
        else write_bytes(path, "", 0);
        a.own.width += 10;
        write_window(&a);
        Window b = open_window();
        assert_int_equal(wr_settings_find_favourite(&b.own, "wrinkle/groove"), 0);
        assert_int_equal(b.own.width, a.own.width);
        close_window(&b);
    }
    close_window(&a);
    wr_free(path);
}

/* A lock file cannot be used to create other files. */
static void a_planted_link_is_no_lock(void **state)
{
    Window a = open_window();
    char *lock = in(*state, "wrinkle/window.lock"), *victim = in(*state, "victim");
    write_window(&a);
    unlink(lock);
    assert_int_equal(symlink(victim, lock), 0);
    a.own.width += 10;
    write_window(&a); /* at the end of the program it is written in any case */
    assert_false(exists(victim));
    Window b = open_window();
    assert_int_equal(b.own.width, a.own.width);
    unlink(lock);
    close_window(&a), close_window(&b);
    wr_free(lock), wr_free(victim);
}

static void while_another_writes_it_waits(void **state)
{
    (void)state;
    Window a = open_window();
    write_window(&a);
    volatile long *ready = shared_memory(sizeof *ready);
    pid_t child = fork_bound();
    if (child == 0) { /* holds the lock */
        char *path = wr_config_path("window.lock");
        int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        *ready = fd >= 0 && flock(fd, LOCK_EX) == 0 ? 1 : -1;
        for (;;) pause();
    }
    await(ready, 1);
    a.own.width = 777;
    assert_false(wr_settings_update(&a.known, &a.own, false));
    assert_false(wr_settings_equal(&a.known, &a.own)); /* so it is tried again */
    kill_child(child);
    assert_true(wr_settings_update(&a.known, &a.own, false));
    Window b = open_window();
    assert_int_equal(b.own.width, 777);
    close_window(&a), close_window(&b);
    munmap((void *)ready, sizeof *ready);
}

/* Two windows that write continuously, one of which is killed: the settings last written by each are in the file. */
static void killed_while_writing_nothing_that_was_written_is_lost(void **state)
{
    (void)state;
    const char *full = getenv("WR_FULL");
    TestRandom random = { 5 };
    volatile long *written = shared_memory(sizeof *written);
    for (int round = 0; round < (full && *full == '1' ? 200 : 20); round++) {
        *written = 0;
        pid_t child = fork_bound();
        if (child == 0) {
            Window a = open_window();
            for (int i = 1;; i++) {
                char id[24];
                snprintf(id, sizeof id, "child/%d", i % 8);
                wr_settings_set_favourite(&a.own, id, i % 16 < 8);
                a.own.width = 1000 + i % 1000;
                if (!wr_settings_update(&a.known, &a.own, true)) _exit(1);
                wr_settings_take_lists(&a.own, &a.known);
                *written = i;
            }
        }
        Window b = open_window();
        char own[24];
        snprintf(own, sizeof own, "parent/%d", round);
        await(written, 1 + (long)(8 * test_random(&random)));
        wr_settings_set_favourite(&b.own, own, true);
        write_window(&b);
        sleep_seconds(0.002 * test_random(&random));
        kill_child(child);
        long last = *written;
        Window c = open_window();
        bool is_last = c.own.width == 1000 + last % 1000,
             is_next = c.own.width == 1001 + last % 1000;
        if (!is_last && !is_next) fail_msg("width %d after %ld", c.own.width, last);
        assert_true(wr_settings_find_favourite(&c.own, own) >= 0);
        wr_settings_set_favourite(&c.own, own, false);
        write_window(&c);
        close_window(&b), close_window(&c);
    }
    munmap((void *)written, sizeof *written);
}

#define PLACED(test) cmocka_unit_test_setup_teardown(test, setup, remove_place)

int main(void)
{
    const struct CMUnitTest tests[] = {
        PLACED(two_windows_keep_what_each_of_them_changed),
        PLACED(what_one_does_to_a_full_list_is_done_to_the_others),
        PLACED(a_file_that_is_gone_or_empty_is_written_anew),
        PLACED(a_planted_link_is_no_lock),
        PLACED(while_another_writes_it_waits),
        PLACED(killed_while_writing_nothing_that_was_written_is_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
