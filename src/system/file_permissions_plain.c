/* Rights as every POSIX system has them: owner, group and mode. Missing here: lists of rights, which each system keeps
   in a way of its own; a file that is replaced loses the one it had, and so gives nobody a right that its mode does not
   give. The mask is asked for by setting it: a file that another thread makes in that moment is nobody else's. */
#include "system/file_permissions_internal.h"

mode_t wr_rights_of_new(const char *folder)
{
    (void)folder;
    mode_t mask = umask(0077);
    umask(mask);
    return ~mask;
}

bool wr_rights_copy_list(int fd, const char *path, bool same_group)
{
    (void)fd;
    (void)path;
    (void)same_group;
    return true;
}
