/* child_internal.h - what the files of processes know of one another.
   Belongs to one system; private to this module. */
#pragma once
#include "system/child.h"

#include <spawn.h>

WrChildEnd wr_child_end_of(int status);
/* Start one that is bound (WrChildStart); -1: the system knows no such thing. */
int wr_child_start_bound(const WrChildStart *start, WrPid *child);
/* Ask for WrChildStart's `apart`, as far as the system can; returns the flags for it. */
short wr_child_set_apart(posix_spawn_file_actions_t *actions, posix_spawnattr_t *attributes);
