/* file_identity.h - identity of the file under a path, to detect that it was replaced or changed since
   it was read. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrFileStamp {
    bool there; /* false: no such file; the other members are 0 */
    uint64_t device, inode;
    int64_t bytes;
    int64_t seconds, nanoseconds; /* of the last content change, since 1970 */
} WrFileStamp;

/* Returns the identity of the file under this path; symbolic links are followed. */
WrFileStamp wr_file_stamp(const char *path);
/* True for the same unchanged file, or if both are missing. */
bool wr_file_stamp_same(const WrFileStamp *a, const WrFileStamp *b);
