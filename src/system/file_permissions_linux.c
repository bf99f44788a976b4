/* Access control lists, which Linux stores as extended attributes, and the user's mask. */
#include "system/file_permissions_internal.h"

#include "system/fd.h"

#include <endian.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/xattr.h>

#define ACL "system.posix_acl_access"
#define ACL_PASSED_ON "system.posix_acl_default"
#define ACL_MAX 65536 /* bytes of an access control list */

static mode_t read_umask(void)
{
    char text[2048];
    int fd = wr_fd_open("/proc/self/status", WR_OPEN_READ);
    int64_t n = fd < 0 ? -1 : wr_fd_read(fd, text, sizeof text - 1);
    if (fd >= 0) wr_fd_close(fd);
    text[n > 0 ? n : 0] = '\0';
    const char *line = strstr(text, "\nUmask:");
    if (line) return (mode_t)strtoul(line + 7, NULL, 8);
    mode_t mask = umask(0077); /* without /proc the mask can be read only by setting it */
    umask(mask);
    return mask;
}

/* Rights that a folder's default list sets for new files, as a mode: owner, mask or else group, others.
   A list consists of a 32-bit version and 64-bit entries: kind, rights, id; linux/posix_acl_xattr.h. */
static mode_t passed_on(const char *list, size_t length)
{
    mode_t owner = 0, group = 0, mask = 0, others = 0;
    bool masked = false;
    for (size_t at = 4; at + 8 <= length; at += 8) {
        uint16_t kind, may;
        memcpy(&kind, list + at, sizeof kind);
        memcpy(&may, list + at + 2, sizeof may);
        kind = le16toh(kind);
        may = le16toh(may);
        if (kind == 1) owner = may;
        if (kind == 4) group = may;
        if (kind == 16) mask = may;
        if (kind == 32) others = may;
        masked = masked || kind == 16;
    }
    return (owner & 7) << 6 | ((masked ? mask : group) & 7) << 3 | (others & 7);
}

mode_t wr_rights_of_new(const char *folder)
{
    char list[ACL_MAX];
    ssize_t length = getxattr(folder, ACL_PASSED_ON, list, sizeof list);
    return length > 0 ? passed_on(list, (size_t)length) : ~read_umask();
}

bool wr_rights_copy_list(int fd, const char *path, bool same_group)
{
    char list[ACL_MAX];
    ssize_t length = getxattr(path, ACL, list, sizeof list);
    if (length > 0) return same_group && fsetxattr(fd, ACL, list, (size_t)length, 0) == 0;
    fremovexattr(fd, ACL); /* may have been inherited from the folder */
    return true;
}
