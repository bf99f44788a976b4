/* Files that take the place of others: there whole or not at all. Everything that the program writes goes
   through here. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#include <ctype.h>
#include <dirent.h>
#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdint.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#define ACL "system.posix_acl_access"
#define ACL_PASSED_ON "system.posix_acl_default"
#define ACL_MAX 65536 /* bytes of a list of rights */
#define TRIES 16      /* at a name that nobody has */

/* ---- names ---- */

/* Follow symbolic links by hand, so that a link to a file that does not exist yet works too. */
static char *resolve_links(const char *path, WrError *err)
{
    char *now = wr_strdup(path);
    for (int hops = 0; hops < 40; hops++) {
        char link[PATH_MAX];
        ssize_t n = readlink(now, link, sizeof link - 1);
        if (n < 0) return now;
        link[n] = '\0';
        char *folder = wr_path_folder(now), *next = wr_path_join(folder, link);
        wr_free(folder);
        wr_free(now);
        now = next;
    }
    wr_free(now);
    wr_fail(err, "%s: too many symbolic links", path);
    return NULL;
}

/* FOLDER/.NAME.PID-RANDOM.part.ending: whose it is, and what nobody can know beforehand. */
static char *choose_name(const char *folder, const char *name)
{
    uint64_t random = 0;
    char ending[16];
    WrText text = { 0 };
    wr_path_ending(name, ending);
    if (getrandom(&random, sizeof random, 0) != (ssize_t)sizeof random) return NULL;
    wr_text_addf(&text, "%s/.%.100s.%ld-%016llx.part%s%s", folder, name, (long)getpid(),
                 (unsigned long long)random, *ending ? "." : "", ending);
    return text.data;
}

/* Digits of the base; returns what follows them, NULL if there are none. */
static const char *skip_digits(const char *text, int base)
{
    const char *p = text;
    while (base == 10 ? isdigit((unsigned char)*p) : isxdigit((unsigned char)*p)) p++;
    return p > text ? p : NULL;
}

/* The process whose file of half the way that is, by the name alone; 0: no such file. */
static long owner_by_name(const char *name)
{
    const char *tail = NULL;
    if (name[0] != '.') return 0;
    for (const char *p = name; (p = strstr(p, ".part")); p++) tail = p;
    if (!tail || (tail[5] != '\0' && tail[5] != '.')) return 0;
    const char *dot = tail;
    while (dot > name && dot[-1] != '.') dot--;
    const char *dash = dot > name + 1 ? skip_digits(dot, 10) : NULL;
    const char *end = dash && *dash == '-' ? skip_digits(dash + 1, 16) : NULL;
    long pid = end == tail ? strtol(dot, NULL, 10) : 0;
    return pid > 0 && pid < INT_MAX ? pid : 0;
}

/* Remove one of those, if it is our user's, its process is gone and nobody holds it. */
static void sweep_one(int folder, const char *name, long pid)
{
    struct stat info, named;
    if (kill((pid_t)pid, 0) == 0 || errno != ESRCH) return;
    int fd = openat(folder, name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) return;
    if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
        flock(fd, LOCK_EX | LOCK_NB) == 0 &&
        fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && named.st_ino == info.st_ino &&
        named.st_dev == info.st_dev)
        unlinkat(folder, name, 0);
    close(fd);
}

void wr_file_sweep(const char *folder)
{
    DIR *dir = opendir(folder);
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        long pid = owner_by_name(entry->d_name);
        if (pid) sweep_one(dirfd(dir), entry->d_name, pid);
    }
    if (dir) closedir(dir);
}

/* ---- rights ---- */

static mode_t read_umask(void)
{
    char text[2048];
    int fd = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
    ssize_t n = fd < 0 ? -1 : read(fd, text, sizeof text - 1);
    if (fd >= 0) close(fd);
    text[n > 0 ? n : 0] = '\0';
    const char *line = strstr(text, "\nUmask:");
    if (line) return (mode_t)strtoul(line + 7, NULL, 8);
    mode_t mask = umask(0077); /* without /proc there is no other way to ask */
    umask(mask);
    return mask;
}

/* What a folder's list gives its new files, as a mode: owner, mask or else group, others. A list is a version of
   32 bits and entries of 64: kind, rights, whose; linux/posix_acl_xattr.h. */
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

/* A new file's: as if it had been created so. Where the folder has a list of what it passes on, that counts in
   the place of the umask. */
static bool give_new_rights(int fd, const char *path)
{
    char list[ACL_MAX], *folder = wr_path_folder(path);
    ssize_t length = getxattr(folder, ACL_PASSED_ON, list, sizeof list);
    wr_free(folder);
    mode_t most = length > 0 ? passed_on(list, (size_t)length) : ~read_umask();
    return fchmod(fd, 0666 & most) == 0;
}

/* Those of the file that is replaced: owner and group where we may give them, mode, list of rights. Rights of
 * a group that is another now, and those to act as the owner, are not passed on. */
static bool give_old_rights(int fd, const char *path, const struct stat *old)
{
    struct stat now;
    mode_t mode = old->st_mode & 07777;
    char list[ACL_MAX];
    if (fstat(fd, &now) != 0) return false;
    if ((now.st_uid != old->st_uid || now.st_gid != old->st_gid) &&
        fchown(fd, old->st_uid, old->st_gid) != 0 && fchown(fd, (uid_t)-1, old->st_gid) != 0)
        mode &= (mode_t)~070;
    if (fstat(fd, &now) != 0) return false;
    if (now.st_uid != old->st_uid || now.st_gid != old->st_gid) mode &= (mode_t)~06000;
    ssize_t length = getxattr(path, ACL, list, sizeof list);
    if (length <= 0) fremovexattr(fd, ACL); /* which the folder may have passed on */
    /* With such a list the mode's middle bits are no group's rights but the most that anyone has. */
    else if (now.st_gid != old->st_gid || fsetxattr(fd, ACL, list, (size_t)length, 0) != 0)
        mode &= (mode_t)~070;
    return fchmod(fd, mode) == 0;
}

/* ---- writing ---- */

void wr_file_outlive_size_limit(void)
{
    struct sigaction now;
    if (sigaction(SIGXFSZ, NULL, &now) != 0 || now.sa_handler != SIG_DFL) return;
    now.sa_handler = SIG_IGN;
    sigaction(SIGXFSZ, &now, NULL);
}

/* ---- what the system says ---- */

static const struct {
    int error;
    const char *help;
} helps[] = {
    { ENOSPC, "make room, or write to another disk" },
    { EDQUOT, "make room, or write where there is no quota" },
    { EROFS, "write to another disk" },
    { EIO, "the disk may be failing: write to another" },
    { EFBIG, NULL }, /* by the limit */
};

const char *wr_file_why(int error, char text[WR_FILE_WHY])
{
    struct rlimit limit;
    const char *said = strerror(error), *help = NULL;
    for (size_t i = 0; i < sizeof helps / sizeof *helps; i++)
        if (helps[i].error == error) help = helps[i].help;
    if (error == EFBIG && getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
        snprintf(text, WR_FILE_WHY, "%s: at most %llu bytes are allowed here (ulimit -f)", said,
                 (unsigned long long)limit.rlim_cur);
        return text;
    }
    snprintf(text, WR_FILE_WHY, "%s%s%s", said, help ? ": " : "", help ? help : "");
    return text;
}

const char *wr_file_why_told(const char *reason, char text[WR_FILE_WHY])
{
    for (size_t i = 0; i < sizeof helps / sizeof *helps; i++)
        if (strstr(reason, strerror(helps[i].error))) return wr_file_why(helps[i].error, text);
    return reason;
}

bool wr_file_fail(const WrFileTarget *target, const char *reason, WrError *err)
{
    return wr_fail(err, "%s: cannot be written%s%s%s", target->path, *reason ? " (" : "", reason,
                   *reason ? ")" : "");
}

static bool fail_by_system(const WrFileTarget *target, WrError *err)
{
    char text[WR_FILE_WHY];
    return wr_file_fail(target, wr_file_why(errno, text), err);
}

/* ---- the target ---- */

static bool check_place(const char *path, const char *real, const char *folder, WrError *err)
{
    struct stat info;
    bool exists = stat(real, &info) == 0;
    if (exists && S_ISDIR(info.st_mode))
        return wr_fail(err, "%s: is a folder; a file name is needed", path);
    if (exists && !S_ISREG(info.st_mode)) return wr_fail(err, "%s: is not a regular file", path);
    if (access(folder, F_OK) != 0) return wr_fail(err, "%s: its folder does not exist", path);
    if (access(folder, W_OK | X_OK) != 0)
        return wr_fail(err, "%s: its folder cannot be written (%s)", path, strerror(errno));
    if (exists && access(real, W_OK) != 0)
        return wr_fail(err, "%s: cannot be written (%s)", path, strerror(errno));
    return true;
}

/* A file that was not there before, nobody else's to read, and locked as long as it is ours. */
static bool create(WrFileTarget *target, const char *folder, WrError *err)
{
    const char *slash = strrchr(target->path, '/'), *name = slash ? slash + 1 : target->path;
    errno = EEXIST;
    for (int i = 0; i < TRIES && target->fd < 0 && errno == EEXIST; i++) {
        wr_free(target->temporary);
        target->temporary = choose_name(folder, name);
        if (!target->temporary) break;
        target->fd =
            open(target->temporary, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    }
    if (target->fd < 0) return fail_by_system(target, err);
    flock(target->fd, LOCK_EX | LOCK_NB); /* some file systems cannot; the name tells the process */
    return true;
}

static void release(WrFileTarget *target)
{
    if (target->path && target->fd >= 0) close(target->fd);
    wr_free(target->path);
    wr_free(target->temporary);
    *target = (WrFileTarget){ 0 };
}

bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err)
{
    *target = (WrFileTarget){ 0 };
    if (!*path) return wr_fail(err, "the name of the file to write is empty");
    wr_file_outlive_size_limit();
    char *real = resolve_links(path, err);
    if (!real) return false;
    *target = (WrFileTarget){ .path = real, .fd = -1 };
    char *folder = wr_path_folder(real);
    bool good = check_place(path, real, folder, err);
    if (good) wr_file_sweep(folder);
    good = good && create(target, folder, err);
    wr_free(folder);
    if (!good) release(target);
    return good;
}

bool wr_file_put(WrFileTarget *target, const void *bytes, size_t length, WrError *err)
{
    const char *from = bytes;
    char block[65536];
    if (!wr_fd_write(target->fd, bytes, length)) return fail_by_system(target, err);
    off_t end = lseek(target->fd, 0, SEEK_CUR), at = end - (off_t)length;
    if (end < (off_t)length) return wr_file_fail(target, "its size is wrong", err);
    while (at < end) {
        size_t want = (size_t)(end - at) < sizeof block ? (size_t)(end - at) : sizeof block;
        ssize_t n = pread(target->fd, block, want, at);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail_by_system(target, err);
        if (n == 0 || memcmp(block, from, (size_t)n) != 0)
            return wr_file_fail(target, "it does not read back as it was written", err);
        from += n;
        at += n;
    }
    return true;
}

void wr_file_verified(WrFileTarget *target)
{
    target->verified = true;
}

static void sync_folder(const char *path)
{
    char *folder = wr_path_folder(path);
    int fd = open(folder, O_RDONLY | O_CLOEXEC | O_DIRECTORY);
    if (fd >= 0) {
        fsync(fd); /* some file systems cannot; the rename itself stands */
        close(fd);
    }
    wr_free(folder);
}

bool wr_file_commit(WrFileTarget *target, WrError *err)
{
    struct stat old;
    WR_ASSERT(target->verified);
    bool replaces = stat(target->path, &old) == 0;
    bool good = (replaces ? give_old_rights(target->fd, target->path, &old)
                          : give_new_rights(target->fd, target->path)) &&
                fsync(target->fd) == 0;
    int fd = target->fd;
    target->fd = -1;
    if (!good) {
        int saved = errno;
        close(fd);
        errno = saved;
    }
    /* Only a file that was closed without trouble: some file systems tell then what went wrong. */
    good = good && close(fd) == 0 && rename(target->temporary, target->path) == 0;
    if (!good) {
        fail_by_system(target, err);
        wr_file_abort(target);
        return false;
    }
    sync_folder(target->path);
    release(target);
    return true;
}

void wr_file_abort(WrFileTarget *target)
{
    /* Once more where it will not go: nobody else removes it before this process has ended. */
    if (target->temporary && unlink(target->temporary) != 0 && errno != ENOENT)
        unlink(target->temporary);
    release(target);
}

bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (!wr_file_put(&target, bytes, length, err)) {
        wr_file_abort(&target);
        return false;
    }
    wr_file_verified(&target);
    return wr_file_commit(&target, err);
}
