/* system_internal.h - functions that linux.c or plain.c defines for the files that every POSIX system shares.
   Belongs to one system; private to this module. */
#pragma once
#include "system/child.h"
#include "system/fd.h"

#include <spawn.h>
#include <stdbool.h>
#include <sys/stat.h>

/* ---- child processes ---- */

WrChildEnd wr_child_end_of(int status);
/* Starts a `bound` program (WrChildStart); -1: unsupported by the system. */
int wr_child_start_bound(const WrChildStart *start, WrPid *child);
/* Sets up WrChildStart's `apart`, as far as the system supports it; returns the spawn flags. */
short wr_child_set_apart(posix_spawn_file_actions_t *actions, posix_spawnattr_t *attributes);

/* ---- descriptors ---- */

void wr_fd_info_of(const struct stat *from, WrFileInfo *to);
int wr_fd_flags(unsigned how);

/* ---- file permissions ---- */

/* Permission functions that differ between Linux and other systems. */

/* Mode of new files in the folder: rw-rw-rw- reduced by its default list or the user's mask. */
mode_t wr_rights_of_new(const char *folder);
/* Copies the access control list; false if `fd` cannot have it, or should not because its group
 * differs. */
bool wr_rights_copy_list(int fd, const char *path, bool same_group);
