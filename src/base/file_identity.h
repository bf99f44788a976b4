/* file_identity.h - identity of the file under a path, to detect that it was replaced or changed since
   it was read. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrFileIdentity {
    bool there; /* false: no such file; the other members are 0 */
    uint64_t device, inode;
    int64_t bytes;
    int64_t seconds, nanoseconds; /* of the last content change, since 1970 */
} WrFileIdentity;

/* Returns the identity of the file under this path; symbolic links are followed. */
WrFileIdentity wr_file_identity(const char *path);
/* True for the same unchanged file, or if both are missing. */
bool wr_file_identity_same(const WrFileIdentity *a, const WrFileIdentity *b);
