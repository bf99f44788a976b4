/* file_identity.h - which file stands under a name: to see that another one has taken its place, or that its bytes are
   no longer those that were read.
   Layer 0. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrFileStamp {
    bool there; /* false: no file stood there, and the rest is 0 */
    uint64_t device, inode;
    int64_t bytes;
    int64_t seconds, nanoseconds; /* of the last change to its bytes, since 1970 */
} WrFileStamp;

/* What stands under the name now; symbolic links are followed. */
WrFileStamp wr_file_stamp(const char *path);
/* The same file, untouched since; or none both times. */
bool wr_file_stamp_same(const WrFileStamp *a, const WrFileStamp *b);
