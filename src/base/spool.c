#include "base/spool.h"

#include "base/memory.h"
#include "base/progress.h"
#include "system/fd.h"

#include <errno.h>

#define TAIL ((int64_t)1 << 20)  /* bytes before the end that may be incomplete */
#define LEAST ((int64_t)8 << 20) /* smallest number of bytes worth moving */
#define BLOCK ((int64_t)1 << 18)

bool wr_spool_open(WrSpool *spool)
{
    *spool = (WrSpool){ .fd = wr_fd_memory("wrinkle spool"), .moved = WR_SPOOL_HEAD };
    return spool->fd >= 0;
}

void wr_spool_close(WrSpool *spool)
{
    if (spool->fd >= 0) wr_fd_close(spool->fd);
    spool->fd = -1;
}

/* Copies bytes [from, end) of the memory file. */
static bool copy(const WrSpool *spool, int64_t from, int64_t end, const WrByteSink *to)
{
    char *block = wr_alloc_unset((size_t)BLOCK, 1);
    bool good = true;
    while (good && from < end) {
        const size_t want = (size_t)(end - from < BLOCK ? end - from : BLOCK);
        const int64_t n = wr_fd_read_at(spool->fd, block, want, from);
        if (n == 0) errno = EIO;
        good = n > 0 && to->write(to->to, block, (size_t)n, from);
        if (good && wr_progress_stopped()) errno = ECANCELED, good = false;
        from += n;
    }
    wr_free(block);
    return good;
}

static bool move_up_to(WrSpool *spool, int64_t end, const WrByteSink *to)
{
    if (!copy(spool, spool->moved, end, to)) return false;
    wr_fd_punch_hole(spool->fd, spool->moved, end - spool->moved);
    spool->moved = end;
    return true;
}

bool wr_spool_move(WrSpool *spool, const WrByteSink *to)
{
    WrFileInfo info;
    if (!wr_fd_info(spool->fd, &info)) return false;
    const int64_t end = info.bytes - TAIL;
    return end - spool->moved < LEAST || move_up_to(spool, end, to);
}

bool wr_spool_end(WrSpool *spool, const WrByteSink *to)
{
    WrFileInfo info;
    if (!wr_fd_info(spool->fd, &info)) return false;
    const int64_t head = info.bytes < WR_SPOOL_HEAD ? info.bytes : WR_SPOOL_HEAD;
    return copy(spool, 0, head, to) &&
           (info.bytes <= spool->moved || move_up_to(spool, info.bytes, to));
}
