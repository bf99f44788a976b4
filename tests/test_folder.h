/* test_folder.h - temporary folder for a group of tests: cmocka_run_group_tests(tests, enter_folder, remove_folder).
   Include after test.h. */
#pragma once
#include <sys/stat.h>
#include <unistd.h>

static inline int enter_folder(void **state)
{
    static char folder[] = "/tmp/wrinkle-test-XXXXXX";
    *state = mkdtemp(folder);
    return *state ? chdir(folder) : -1;
}

/* Temporary folder for each test of a group: cmocka_unit_test_setup_teardown(test, enter_own_folder,
   leave_own_folder). */
static inline int enter_own_folder(void **state)
{
    char name[] = "/tmp/wrinkle-test-XXXXXX";
    if (!mkdtemp(name) || chdir(name) != 0) return -1;
    *state = strdup(name);
    return *state ? 0 : -1;
}

static inline int leave_own_folder(void **state)
{
    char command[100];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    free(*state);
    if (chdir("/") != 0) return -1;
    return system(command);
}

/* With a subfolder `state` for the program's files, which is not checked for leftovers. */
static inline int enter_state_folder(void **state)
{
    if (enter_folder(state) != 0) return -1;
    char path[128];
    snprintf(path, sizeof path, "%s/state", (char *)*state);
    return mkdir(path, 0700) == 0 ? setenv("WRINKLE_STATE", path, 1) : -1;
}

static inline int remove_folder(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    return chdir("/") || system(command);
}
