/* file_permissions_internal.h - permission functions that differ between Linux and other systems.
   Belongs to one system; private to this module. */
#pragma once
#include <stdbool.h>
#include <sys/stat.h>

/* Mode of new files in the folder: rw-rw-rw- reduced by its default list or the user's mask. */
mode_t wr_rights_of_new(const char *folder);
/* Copies the access control list; false if `fd` cannot have it, or should not because its group
 * differs. */
bool wr_rights_copy_list(int fd, const char *path, bool same_group);
