/* window.h - group of tests with a hidden window: cmocka_run_group_tests(tests, enter_window, remove_folder).
   Include after test.h. */
#pragma once
#include "test_folder.h"

#include <stdlib.h>

/* A temporary folder, also for settings and journals. */
static inline int enter_window(void **state)
{
    int trouble = enter_folder(state);
    setenv("XDG_CONFIG_HOME", *state, 1);
    setenv("XDG_STATE_HOME", *state, 1);
    setenv("XDG_DATA_HOME", *state, 1);
    setenv("WRINKLE_DATA", WR_SOURCE_DIR, 1);
    setenv("WRINKLE_RENDERER", "software", 1);
    unsetenv("DBUS_SESSION_BUS_ADDRESS"); /* excludes the user's portal */
    unsetenv("XDG_RUNTIME_DIR");
    return trouble;
}
