/* child_internal.h - functions shared by the child*.c files.
   Belongs to one system; private to this module. */
#pragma once
#include "system/child.h"

#include <spawn.h>

WrChildEnd wr_child_end_of(int status);
/* Starts a `bound` program (WrChildStart); -1: unsupported by the system. */
int wr_child_start_bound(const WrChildStart *start, WrPid *child);
/* Sets up WrChildStart's `apart`, as far as the system supports it; returns the spawn flags. */
short wr_child_set_apart(posix_spawn_file_actions_t *actions, posix_spawnattr_t *attributes);
