#include "base/stamp.h"

#include <sys/stat.h>

WrFileStamp wr_file_stamp(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0) return (WrFileStamp){ 0 };
    return (WrFileStamp){ .there = true,
                          .device = (uint64_t)info.st_dev,
                          .inode = (uint64_t)info.st_ino,
                          .bytes = (int64_t)info.st_size,
                          .seconds = (int64_t)info.st_mtim.tv_sec,
                          .nanoseconds = (int64_t)info.st_mtim.tv_nsec };
}

bool wr_file_stamp_same(const WrFileStamp *a, const WrFileStamp *b)
{
    return a->there == b->there && a->device == b->device && a->inode == b->inode &&
           a->bytes == b->bytes && a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}
