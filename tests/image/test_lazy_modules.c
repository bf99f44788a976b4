/* Modules and lists loaded on first use (base/pool.h): a caller waiting for a slow one can be cancelled, and
   the result serves the next caller. */
#include "test.h"
#include "test_folder.h"

#include "base/progress.h"
#include "image/font.h"
#include "image/module_path.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/wait.h>

#define PATIENCE 120 /* seconds before a hanging test is ended */

static long loadings(void)
{
    struct stat info;
    return stat("began", &info) == 0 ? (long)info.st_size : 0;
}

static void make_file(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
}

/* A separate module, since a loaded one stays. */
static void put_module(const char *file)
{
    char command[512];
    snprintf(command, sizeof command, "cp '%s' %s", SLOW_MODULE, file);
    assert_int_equal(system(command), 0);
}

static void name_module(WrModule *module, const char *file)
{
    remove("go");
    remove("began");
    *module = (WrModule){ .file = file,
                          .serves = "slow files",
                          .symbol = "slow_table",
                          .version = 3,
                          .loading = { .work = wr_module_load, .ctx = module } };
}

/* ---- who cancels once the loading has begun ---- */

static void *cancel_then(void *cancel)
{
    while (loadings() == 0) usleep(1000);
    __atomic_store_n((volatile int *)cancel, 1, __ATOMIC_RELAXED);
    return NULL;
}

/* Request it and be cancelled meanwhile. */
static void ask_and_cancel(WrModule *module)
{
    WrError err = { "" };
    volatile int cancel = 0;
    WrProgress progress = { .cancel = &cancel };
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, cancel_then, (void *)&cancel), 0);
    wr_progress_set(&progress);
    const void *table = wr_module_table(module, &err);
    wr_progress_set(NULL);
    pthread_join(thread, NULL);
    assert_null(table);
    assert_string_equal(err.text, "cancelled");
}

static void *ask(void *module)
{
    volatile int cancel = 0;
    WrProgress progress = { .cancel = &cancel };
    wr_progress_set(&progress);
    return (void *)wr_module_table(module, NULL);
}

static void who_is_cancelled_does_not_wait_and_the_next_takes_it(void **state)
{
    (void)state;
    put_module("slow1.so");
    static WrModule module; /* it may be loading after a failed test */
    name_module(&module, "slow1.so");
    for (int i = 0; i < 3; i++) ask_and_cancel(&module); /* without waiting for "go" */
    enum { COUNT = 4 };
    pthread_t threads[COUNT];
    const int *first = NULL;
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, ask, &module), 0);
    make_file("go");
    for (int i = 0; i < COUNT; i++) {
        void *table;
        pthread_join(threads[i], &table);
        assert_non_null(table);
        if (!first) first = table;
        assert_ptr_equal(table, first);
    }
    assert_int_equal(*first, 3);
    assert_int_equal(loadings(), 1);
    assert_ptr_equal(wr_module_table(&module, NULL), first);
}

static void warming_returns_at_once_and_loads_once(void **state)
{
    (void)state;
    WrError err = { "" };
    put_module("slow2.so");
    static WrModule module; /* it may be loading after a failed test */
    name_module(&module, "slow2.so");
    for (int i = 0; i < 3; i++) wr_once_async_begin(&module.loading);
    make_file("go");
    /* this caller cannot be cancelled: it waits too */
    assert_non_null(wr_module_table(&module, &err));
    wr_once_async_begin(&module.loading);
    assert_int_equal(loadings(), 1);
}

static void a_failure_is_told_and_not_kept(void **state)
{
    (void)state;
    volatile int cancel = 0;
    const WrProgress some = { .cancel = &cancel }, *const who[] = { NULL, &some };
    static WrModule module; /* it may be loading after a failed test */
    name_module(&module, "slow3.so");
    make_file("go");
    for (int i = 0; i < 2; i++) {
        WrError err = { "" };
        wr_progress_set(who[i]);
        assert_null(wr_module_table(&module, &err));
        assert_non_null(
            strstr(err.text, "slow files need the module slow3.so, which was not found at: "));
    }
    put_module("slow3.so");
    assert_non_null(wr_module_table(&module, NULL));
    wr_progress_set(NULL);
}

/* The system's reason is repeated; without a package the searched paths are listed too. */
static void a_library_that_is_missing_is_named_with_its_package(void **state)
{
    (void)state;
    static WrModule module;
    WrError err = { "" };
    name_module(&module, "broken.so");
    FILE *file = fopen("broken.so", "w");
    assert_non_null(file);
    assert_true(fputs("not a library", file) >= 0 && fclose(file) == 0);
    assert_null(wr_module_table(&module, &err));
    assert_non_null(
        strstr(err.text, "slow files need the module broken.so, which was not found at: "));
    assert_non_null(strstr(err.text, "/broken.so (/")); /* its path begins the reason */
    module.package = "libslow1";
    assert_null(wr_module_table(&module, &err));
    assert_non_null(strstr(err.text, "need the module broken.so, which cannot be loaded: /"));
    assert_non_null(
        strstr(err.text, "/broken.so: file too short (on Debian: apt install libslow1)"));
    remove("broken.so"); /* as in a sandbox */
    wr_modules_seal();
    assert_null(wr_module_table(&module, &err));
    assert_non_null(
        strstr(err.text, "/broken.so: file too short (on Debian: apt install libslow1)"));
}

/* The program's end does not wait for an unneeded load, and keeps its exit status and output. */
static void the_program_ends_while_one_loads(void **state)
{
    (void)state;
    put_module("slow4.so");
    static WrModule module; /* it may be loading when the test has failed */
    name_module(&module, "slow4.so");
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        alarm(PATIENCE);
        ask_and_cancel(&module);
        FILE *words = fopen("words", "w");
        fputs("said\n", words);
        exit(7);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 7);
    struct stat info;
    assert_int_equal(stat("words", &info), 0);
    assert_int_equal(info.st_size, 5);
    assert_int_not_equal(access("go", F_OK), 0);
}

/* it may be loading after a failed test */

/* Loading starts when this fifo is read, and continues when data arrives. */
static void *cancel_at_fifo(void *cancel)
{
    int file = open("fonts.conf", O_WRONLY | O_CLOEXEC);
    __atomic_store_n((volatile int *)cancel, 1, __ATOMIC_RELAXED);
    return (void *)(intptr_t)file;
}

static void a_list_of_fonts_that_takes_long_can_be_cancelled(void **state)
{
    (void)state;
    static const char empty[] = "<?xml version=\"1.0\"?><fontconfig></fontconfig>";
    const uint32_t letter = 'a';
    char path[256], *lender = NULL;
    volatile int cancel = 0;
    WrProgress progress = { .cancel = &cancel };
    pthread_t thread;
    void *file;
    snprintf(path, sizeof path, "%s/fonts.conf", getenv("WRINKLE_MODULES"));
    setenv("FONTCONFIG_FILE", path, 1);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(pthread_create(&thread, NULL, cancel_at_fifo, (void *)&cancel), 0);
    wr_progress_set(&progress);
    assert_int_equal(wr_font_lenders(&letter, 1, "sans", NULL, 1, &lender), 0);
    assert_int_equal(cancel, 1);
    wr_progress_set(NULL);
    pthread_join(thread, &file);
    /* The copy that reads first has the fifo open; later ones find a file. */
    assert_int_equal(unlink(path), 0);
    FILE *plain = fopen(path, "w");
    assert_non_null(plain);
    assert_true(fputs(empty, plain) >= 0 && fclose(plain) == 0);
    assert_true(write((int)(intptr_t)file, empty, sizeof empty - 1) == sizeof empty - 1);
    close((int)(intptr_t)file);
    assert_int_equal(wr_font_lenders(&letter, 1, "sans", NULL, 1, &lender), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_is_cancelled_does_not_wait_and_the_next_takes_it),
        cmocka_unit_test(warming_returns_at_once_and_loads_once),
        cmocka_unit_test(a_failure_is_told_and_not_kept),
        cmocka_unit_test(the_program_ends_while_one_loads),
        cmocka_unit_test(a_list_of_fonts_that_takes_long_can_be_cancelled),
        cmocka_unit_test(
            a_library_that_is_missing_is_named_with_its_package), /* last: it seals the modules */
    };
    char here[64];
    alarm(PATIENCE);
    void *folder = NULL;
    if (enter_folder(&folder) != 0 || !getcwd(here, sizeof here)) return 1;
    setenv("WRINKLE_MODULES", here, 1);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return remove_folder(&folder) || failed;
}
