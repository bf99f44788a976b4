/* file_permissions.h - owner, mode and access control list of a file that replaces another.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>

/* Permissions of a new file, as if created in that folder by any program. A default access control list
 * of the folder replaces the user's mask. */
bool wr_rights_give_new(int fd, const char *folder);

/* Copies the permissions of the file at `path`, which `fd` is about to replace: owner and group where
 * allowed, mode, access control list where the system has one. Group rights are dropped if the group
 * differs; set-id bits are dropped. */
bool wr_rights_give_old(int fd, const char *path);
