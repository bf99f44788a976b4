/* Permissions on any POSIX system: owner, group and mode. Missing here: access control lists, which
   differ between systems. A replaced file loses its list, so nobody gets a right that the mode does not
   grant. The mask is read by setting it to the strictest value: a file that another thread creates in
   that moment is accessible by its owner only. */
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
