#include "base/file_identity.h"

#include "system/path.h"

WrFileIdentity wr_file_identity(const char *path)
{
    WrFileInfo info;
    if (!wr_path_info(path, &info)) return (WrFileIdentity){ 0 };
    return (WrFileIdentity){ .there = true,
                             .device = info.device,
                             .inode = info.inode,
                             .bytes = info.bytes,
                             .seconds = info.seconds,
                             .nanoseconds = info.nanoseconds };
}

bool wr_file_identity_same(const WrFileIdentity *a, const WrFileIdentity *b)
{
    return a->there == b->there && a->device == b->device && a->inode == b->inode &&
           a->bytes == b->bytes && a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}
