#include "image/reader_protocol.h"

#include "base/progress.h"
#include "system/channel.h"
#include "system/clock.h"
#include "system/fd.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define CHECK_MS 20 /* interval between cancellation checks */

bool wr_wire_send(int channel, WrWireKind kind, const void *bytes, size_t length, int fd)
{
    WrWireHead head = { kind, (uint32_t)length };
    return wr_channel_send(channel, &head, sizeof head, bytes, length, &fd, fd >= 0 ? 1 : 0);
}

static WrWireGot wait_for(int channel, double deadline)
{
    for (;;) {
        int timeout = wr_progress_here() ? CHECK_MS : -1;
        if (wr_progress_stopped()) return WR_WIRE_GONE;
        if (deadline > 0.0) {
            double left = deadline - wr_clock_seconds();
            if (left <= 0.0) return WR_WIRE_LATE;
            int most = (int)ceil(left < 1e5 ? left * 1e3 : 1e8);
            timeout = timeout < 0 || most < timeout ? most : timeout;
        }
        WrChannelNews news = wr_channel_wait(channel, timeout);
        if (news != WR_CHANNEL_QUIET) return news == WR_CHANNEL_NEWS ? WR_WIRE_GOT : WR_WIRE_GONE;
    }
}

WrWireGot wr_wire_receive(int channel, void *bytes, size_t length, double deadline, int *fd)
{
    char *to = bytes;
    int came;
    if (fd) *fd = -1;
    while (length > 0) {
        WrWireGot got = wait_for(channel, deadline);
        if (got != WR_WIRE_GOT) return got;
        int64_t n = wr_channel_receive(channel, to, length, &came, 1);
        if (n == -2) continue;
        if (n <= 0) return WR_WIRE_GONE;
        if (fd && *fd < 0) *fd = came;
        else if (came >= 0) wr_fd_close(came);
        to += n;
        length -= (size_t)n;
    }
    return WR_WIRE_GOT;
}

WrWireGot wr_wire_wait(int channel, double deadline)
{
    WrWireGot got = wait_for(channel, deadline);
    if (got != WR_WIRE_GOT) return got;
    return wr_channel_has_byte(channel) ? WR_WIRE_GOT : WR_WIRE_GONE;
}
