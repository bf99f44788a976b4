#include "system/file_permissions.h"

#include "system/system_internal.h"

#include <unistd.h>

bool wr_rights_give_new(int fd, const char *folder)
{
    const mode_t most = wr_rights_of_new(folder);
    return fchmod(fd, 0666 & most) == 0;
}

bool wr_rights_give_old(int fd, const char *path)
{
    struct stat old, now;
    if (stat(path, &old) != 0 || fstat(fd, &now) != 0) return false;
    mode_t mode = old.st_mode & 07777;
    if ((now.st_uid != old.st_uid || now.st_gid != old.st_gid) &&
        fchown(fd, old.st_uid, old.st_gid) != 0 && fchown(fd, (uid_t)-1, old.st_gid) != 0)
        mode &= (mode_t)~070;
    if (fstat(fd, &now) != 0) return false;
    if (now.st_uid != old.st_uid || now.st_gid != old.st_gid) mode &= (mode_t)~06000;
    /* With such a list, the group bits of the mode are the mask of the maximum rights, not those of the
       group. */
    if (!wr_rights_copy_list(fd, path, now.st_gid == old.st_gid)) mode &= (mode_t)~070;
    return fchmod(fd, mode) == 0;
}
