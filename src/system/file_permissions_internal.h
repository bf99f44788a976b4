/* file_permissions_internal.h - the part of rights that only Linux has.
   Belongs to one system; private to this module. */
#pragma once
#include <stdbool.h>
#include <sys/stat.h>

/* Of new files in the folder: what its list or the user's mask leaves of rw-rw-rw-. */
mode_t wr_rights_of_new(const char *folder);
/* Copy the list of rights; false if `fd` could not get it, or shall not, since its group is another now. */
bool wr_rights_copy_list(int fd, const char *path, bool same_group);
