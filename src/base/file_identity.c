#include "base/file_identity.h"

#include "system/path.h"

WrFileStamp wr_file_stamp(const char *path)
{
    WrFileInfo info;
    if (!wr_path_info(path, &info)) return (WrFileStamp){ 0 };
    return (WrFileStamp){ .there = true,
                          .device = info.device,
                          .inode = info.inode,
                          .bytes = info.bytes,
                          .seconds = info.seconds,
                          .nanoseconds = info.nanoseconds };
}

bool wr_file_stamp_same(const WrFileStamp *a, const WrFileStamp *b)
{
    return a->there == b->there && a->device == b->device && a->inode == b->inode &&
           a->bytes == b->bytes && a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}
