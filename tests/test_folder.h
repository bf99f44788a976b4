/* test_folder.h - a group of tests that runs in a folder of its own: cmocka_run_group_tests(tests,
   enter_folder, remove_folder). After test.h. */
#pragma once
#include <unistd.h>

static inline int enter_folder(void **state)
{
    static char folder[] = "/tmp/wrinkle-test-XXXXXX";
    *state = mkdtemp(folder);
    return *state ? chdir(folder) : -1;
}

static inline int remove_folder(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    return chdir("/") || system(command);
}
