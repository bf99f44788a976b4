/* spool.h - a destination of bytes with random access, written by encoders and archives.

   For C and C++. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrByteSink {
    /* Writes all bytes at an offset, which may be before or beyond the end; on failure false and errno. */
    bool (*write)(void *to, const void *bytes, size_t length, int64_t at);
    void *to; /* context of the caller */
} WrByteSink;

/* ---- memory file ---- */

/* A memory file for libraries that can write only to a file name, forwarded to a byte sink
   (WrByteSink).

   So these bytes are written and checked like all others. For large files, the part after the first
   WR_SPOOL_HEAD bytes is forwarded during writing and its memory is released. The writer may return
   only to the first bytes, which contain headers and tables, and near its end to the bytes it wrote
   last. */

#define WR_SPOOL_HEAD ((int64_t)64 << 20) /* bytes kept until the end */

typedef struct WrSpool {
    int fd;        /* written under its name (system/fd.h, wr_fd_name) */
    int64_t moved; /* offset up to which bytes after the head were forwarded */
} WrSpool;

bool wr_spool_open(WrSpool *spool); /* false and errno */
/* Forwards the bytes written so far, except the head and the last few bytes, which may be incomplete. */
bool wr_spool_move(
    WrSpool *spool,
    const WrByteSink *to); /* on failure false and errno; errno ECANCELED: the work was cancelled */
/* Forwards all remaining bytes; the writer has finished. */
bool wr_spool_end(WrSpool *spool, const WrByteSink *to);
void wr_spool_close(WrSpool *spool); /* may be called twice, and on a spool never opened (fd -1) */
