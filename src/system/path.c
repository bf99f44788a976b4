#include "system/path.h"

#include "system/system_internal.h"

#include <dirent.h>
#include <fcntl.h>
#include <pwd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

bool wr_path_info(const char *path, WrFileInfo *info)
{
    struct stat got;
    if (stat(path, &got) != 0) return false;
    wr_fd_info_of(&got, info);
    return true;
}

bool wr_path_is_folder(const char *path)
{
    WrFileInfo info;
    return wr_path_info(path, &info) && info.kind == WR_KIND_FOLDER;
}

bool wr_path_is_file(const char *path)
{
    WrFileInfo info;
    return wr_path_info(path, &info) && info.kind == WR_KIND_FILE;
}

bool wr_path_is_there(const char *path)
{
    return access(path, F_OK) == 0;
}

bool wr_path_can_read(const char *path)
{
    return access(path, R_OK) == 0;
}

bool wr_path_can_write(const char *path)
{
    return access(path, W_OK) == 0;
}

bool wr_path_can_run(const char *path)
{
    return access(path, X_OK) == 0;
}

bool wr_path_remove(const char *path)
{
    return unlink(path) == 0;
}

bool wr_path_rename(const char *from, const char *to)
{
    return rename(from, to) == 0;
}

bool wr_path_link(const char *from, const char *to)
{
    return link(from, to) == 0;
}

bool wr_path_read_link(const char *path, char *to, size_t size)
{
    ssize_t n = readlink(path, to, size - 1);
    to[n > 0 ? n : 0] = '\0';
    return n >= 0;
}

char *wr_path_real(const char *path)
{
    return realpath(path, NULL);
}

/* A buffer allocated by getcwd itself would not be standard. */
char *wr_path_here(void)
{
    for (size_t size = 256;; size *= 2) {
        char *path = malloc(size);
        if (!path || getcwd(path, size)) return path;
        free(path);
        if (size > 1 << 20) return NULL;
    }
}

bool wr_path_home(char *path, size_t size)
{
    char buffer[4096];
    struct passwd user, *found = NULL;
    if (getpwuid_r(getuid(), &user, buffer, sizeof buffer, &found) != 0 || !found) return false;
    int length = snprintf(path, size, "%s", user.pw_dir);
    return length >= 0 && (size_t)length < size;
}

/* ---- folders ---- */

bool wr_folder_make(const char *path, WrFolderFor whose)
{
    return mkdir(path, whose == WR_FOLDER_FOR_ME ? 0700 : 0777) == 0;
}

bool wr_folder_make_temporary(char *path)
{
    return mkdtemp(path) != NULL;
}

bool wr_folder_remove(const char *path)
{
    return rmdir(path) == 0;
}

struct WrFolder {
    DIR *dir;
};

WrFolder *wr_folder_open(const char *path)
{
    WrFolder *folder = malloc(sizeof *folder);
    if (!folder) return NULL;
    folder->dir = opendir(path);
    if (folder->dir) return folder;
    free(folder);
    return NULL;
}

void wr_folder_close(WrFolder *folder)
{
    if (!folder) return;
    closedir(folder->dir);
    free(folder);
}

const char *wr_folder_next(WrFolder *folder)
{
    for (struct dirent *entry; (entry = readdir(folder->dir));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            return entry->d_name;
    return NULL;
}

bool wr_folder_entry_info(WrFolder *folder, const char *name, WrFileInfo *info)
{
    struct stat got;
    if (fstatat(dirfd(folder->dir), name, &got, AT_SYMLINK_NOFOLLOW) != 0) return false;
    wr_fd_info_of(&got, info);
    return true;
}

bool wr_folder_remove_entry(WrFolder *folder, const char *name)
{
    return unlinkat(dirfd(folder->dir), name, 0) == 0;
}

int wr_folder_open_unheld(WrFolder *folder, const char *name)
{
    struct stat info;
    int fd = openat(dirfd(folder->dir), name,
                    wr_fd_flags(WR_OPEN_READ | WR_OPEN_NO_LINK | WR_OPEN_NO_WAIT));
    if (fd < 0) return -1;
    if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
        flock(fd, LOCK_EX | LOCK_NB) == 0)
        return fd;
    close(fd);
    return -1;
}

void wr_folder_remove_unheld_entry(WrFolder *folder, const char *name)
{
    struct stat info, named;
    int in = dirfd(folder->dir), fd = wr_folder_open_unheld(folder, name);
    if (fd < 0) return;
    if (fstat(fd, &info) == 0 && fstatat(in, name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
        named.st_ino == info.st_ino && named.st_dev == info.st_dev)
        unlinkat(in, name, 0);
    close(fd);
}
