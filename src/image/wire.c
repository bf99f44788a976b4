#include "image/wire.h"

#include "base/clock.h"
#include "base/progress.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define LOOK_MS 20 /* between two looks at whether somebody wants it to stop */

typedef union Control {
    struct cmsghdr align;
    char bytes[CMSG_SPACE(4 * sizeof(int))];
} Control;

static bool send_all(int channel, const char *bytes, size_t length)
{
    while (length > 0) {
        ssize_t n = send(channel, bytes, length, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n;
        length -= (size_t)n;
    }
    return true;
}

bool wr_wire_send(int channel, WrWireKind kind, const void *bytes, size_t length, int fd)
{
    WrWireHead head = { kind, (uint32_t)length };
    struct iovec parts[2] = { { &head, sizeof head }, { (void *)bytes, length } };
    struct msghdr message = { .msg_iov = parts, .msg_iovlen = length ? 2 : 1 };
    Control control;
    if (fd >= 0) {
        memset(&control, 0, sizeof control);
        message.msg_control = control.bytes;
        message.msg_controllen = CMSG_SPACE(sizeof fd);
        struct cmsghdr *right = CMSG_FIRSTHDR(&message);
        right->cmsg_level = SOL_SOCKET;
        right->cmsg_type = SCM_RIGHTS;
        right->cmsg_len = CMSG_LEN(sizeof fd);
        memcpy(CMSG_DATA(right), &fd, sizeof fd);
    }
    ssize_t n;
    do n = sendmsg(channel, &message, MSG_NOSIGNAL);
    while (n < 0 && errno == EINTR);
    if (n < (ssize_t)sizeof head) return false; /* heads are far smaller than any socket's buffer */
    size_t sent = (size_t)n - sizeof head;
    return send_all(channel, (const char *)bytes + sent, length - sent);
}

static WrWireGot wait_for(int channel, double deadline)
{
    for (;;) {
        int timeout = wr_progress_here() ? LOOK_MS : -1;
        if (wr_progress_stopped()) return WR_WIRE_GONE;
        if (deadline > 0.0) {
            double left = deadline - wr_clock_seconds();
            if (left <= 0.0) return WR_WIRE_LATE;
            int most = (int)ceil(left < 1e5 ? left * 1e3 : 1e8);
            timeout = timeout < 0 || most < timeout ? most : timeout;
        }
        struct pollfd ready = { .fd = channel, .events = POLLIN };
        int n = poll(&ready, 1, timeout);
        if (n > 0) return WR_WIRE_GOT;
        if (n < 0 && errno != EINTR) return WR_WIRE_GONE;
    }
}

/* Keep the first descriptor of a message, close all others. */
static void take_descriptors(struct msghdr *message, int *keep)
{
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_RIGHTS) continue;
        size_t count = (c->cmsg_len - CMSG_LEN(0)) / sizeof(int);
        for (size_t i = 0; i < count; i++) {
            int fd;
            memcpy(&fd, CMSG_DATA(c) + i * sizeof fd, sizeof fd);
            if (keep && *keep < 0) *keep = fd;
            else close(fd);
        }
    }
}

WrWireGot wr_wire_receive(int channel, void *bytes, size_t length, double deadline, int *fd)
{
    char *to = bytes;
    if (fd) *fd = -1;
    while (length > 0) {
        WrWireGot got = wait_for(channel, deadline);
        if (got != WR_WIRE_GOT) return got;
        Control control;
        struct iovec part = { to, length };
        struct msghdr message = { .msg_iov = &part,
                                  .msg_iovlen = 1,
                                  .msg_control = control.bytes,
                                  .msg_controllen = sizeof control.bytes };
        ssize_t n = recvmsg(channel, &message, MSG_CMSG_CLOEXEC);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return WR_WIRE_GONE;
        take_descriptors(&message, fd);
        to += n;
        length -= (size_t)n;
    }
    return WR_WIRE_GOT;
}

WrWireGot wr_wire_wait(int channel, double deadline)
{
    char byte;
    WrWireGot got = wait_for(channel, deadline);
    if (got != WR_WIRE_GOT) return got;
    return recv(channel, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 1 ? WR_WIRE_GOT : WR_WIRE_GONE;
}
