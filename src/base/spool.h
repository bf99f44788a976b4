/* spool.h - a memory file for libraries and programs that write to nothing but a file's name, on its way to where its
   bytes belong (sink.h).
   Layer 0.

   So those bytes go through the same door as all others, however they were written. Of a large file the part behind
   the first WR_SPOOL_HEAD bytes goes on while the rest is being written, and its memory is given back: whoever writes
   there may return to the first bytes, where headers and tables lie, and once it is at its end to what it wrote last; to
   nothing else. */
#pragma once
#include "base/sink.h"

#define WR_SPOOL_HEAD ((int64_t)64 << 20) /* bytes that stay until the end */

typedef struct WrSpool {
    int fd;        /* to be written by whoever needs a name (system/fd.h, wr_fd_name) */
    int64_t moved; /* bytes behind the head up to here have gone on */
} WrSpool;

bool wr_spool_open(WrSpool *spool); /* false and errno */
/* What was written so far, but for the head and the last few bytes, which may not be complete. */
bool wr_spool_move(
    WrSpool *spool,
    const WrByteSink *to); /* false and errno; errno ECANCELED: it was told to stop */
/* All that is left; nobody writes any more. */
bool wr_spool_end(WrSpool *spool, const WrByteSink *to);
void wr_spool_close(WrSpool *spool); /* fine twice, and when it was never opened (fd -1) */
