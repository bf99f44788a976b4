/* file_permissions.h - who may do what with a file that replaces another.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>

/* A new file's: as if it had been created in that folder by anybody else's program. Where the folder has a list of
 * what it passes on, that counts in the place of the user's mask. */
bool wr_rights_give_new(int fd, const char *folder);

/* Those of the file at `path`, which `fd` is about to replace: owner and group where we may give them, mode, list of
 * rights where the system has such. Rights of a group that is another now, and those to act as the owner, are not
 * passed on. */
bool wr_rights_give_old(int fd, const char *path);
