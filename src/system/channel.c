/* Local sockets. Features missing on older systems are used where the headers have them; otherwise a
   descriptor is marked close-on-exec after its creation. */
#include "system/channel.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#if defined(WR_PLAIN_SYSTEM) || !defined(MSG_CMSG_CLOEXEC) || !defined(SOCK_CLOEXEC)
#define MARK_AFTER 1
#define RECEIVE_MARKED 0
#define MAKE_MARKED 0
#else
#define MARK_AFTER 0
#define RECEIVE_MARKED MSG_CMSG_CLOEXEC
#define MAKE_MARKED SOCK_CLOEXEC
#endif
#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0
#endif

typedef union Control {
    struct cmsghdr first;
    char bytes[CMSG_SPACE(WR_CHANNEL_FILES * sizeof(int))];
} Control;

static void mark(int fd)
{
    if (MARK_AFTER) fcntl(fd, F_SETFD, FD_CLOEXEC);
#ifdef SO_NOSIGPIPE
    int yes = 1;
    setsockopt(fd, SOL_SOCKET, SO_NOSIGPIPE, &yes, sizeof yes);
#endif
}

bool wr_channel_pair(int ends[2], bool packets)
{
    int type = packets ? SOCK_SEQPACKET : SOCK_STREAM;
    if (socketpair(AF_UNIX, type | MAKE_MARKED, 0, ends) != 0) return false;
    mark(ends[0]);
    mark(ends[1]);
    return true;
}

bool wr_channel_is_one(int fd)
{
    struct sockaddr_storage name = { 0 };
    socklen_t length = sizeof name;
    return getsockname(fd, (struct sockaddr *)&name, &length) == 0 && name.ss_family == AF_UNIX;
}

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

static void add_files(struct msghdr *message, Control *control, const int *files, int count)
{
    size_t bytes = (size_t)count * sizeof *files;
    memset(control, 0, sizeof *control);
    message->msg_control = control->bytes;
    message->msg_controllen = (socklen_t)CMSG_SPACE(bytes);
    struct cmsghdr *rights = &control->first;
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = (socklen_t)CMSG_LEN(bytes);
    memcpy(CMSG_DATA(rights), files, bytes);
}

bool wr_channel_send(int channel, const void *head, size_t head_length, const void *body,
                     size_t length, const int *files, int count)
{
    struct iovec parts[2] = { { (void *)head, head_length }, { (void *)body, length } };
    struct msghdr message = { .msg_iov = parts, .msg_iovlen = length ? 2 : 1 };
    Control control;
    if (count > 0) add_files(&message, &control, files, count);
    ssize_t n;
    do n = sendmsg(channel, &message, MSG_NOSIGNAL);
    while (n < 0 && errno == EINTR);
    if (n < (ssize_t)head_length) return false;
    size_t sent = (size_t)n - head_length;
    return sent == length || send_all(channel, (const char *)body + sent, length - sent);
}

void wr_channel_try_send(int channel, const void *bytes, size_t length)
{
    send(channel, bytes, length, MSG_NOSIGNAL | MSG_DONTWAIT);
}

int64_t wr_channel_put(int channel, const void *bytes, size_t length)
{
    ssize_t n;
    do n = send(channel, bytes, length, MSG_NOSIGNAL | MSG_DONTWAIT);
    while (n < 0 && errno == EINTR);
    if (n >= 0) return (int64_t)n;
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS ? 0 : -1;
}

bool wr_channel_wait_room(int channel, int ms)
{
    struct pollfd ready = { .fd = channel, .events = POLLOUT };
    return poll(&ready, 1, ms) > 0;
}

void wr_channel_end(int channel)
{
    shutdown(channel, SHUT_WR);
}

/* Keeps the first descriptors of a message and closes all others. */
static void take_files(struct msghdr *message, int *files, int count)
{
    int have = 0;
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_RIGHTS) continue;
        size_t came = (c->cmsg_len - CMSG_LEN(0)) / sizeof(int);
        for (size_t i = 0; i < came; i++) {
            int fd;
            memcpy(&fd, CMSG_DATA(c) + i * sizeof fd, sizeof fd);
            mark(fd);
            if (have < count) files[have++] = fd;
            else close(fd);
        }
    }
}

int64_t wr_channel_receive(int channel, void *bytes, size_t length, int *files, int count)
{
    Control control;
    struct iovec part = { bytes, length };
    struct msghdr message = { .msg_iov = &part,
                              .msg_iovlen = 1,
                              .msg_control = control.bytes,
                              .msg_controllen = sizeof control.bytes };
    for (int i = 0; i < count; i++) files[i] = -1;
    ssize_t n = recvmsg(channel, &message, RECEIVE_MARKED);
    if (n < 0) return errno == EINTR || errno == EAGAIN ? -2 : -1;
    take_files(&message, files, count);
    return (int64_t)n;
}

WrChannelNews wr_channel_wait(int channel, int ms)
{
    struct pollfd ready = { .fd = channel, .events = POLLIN };
    int n = poll(&ready, 1, ms);
    if (n > 0) return WR_CHANNEL_NEWS;
    return n == 0 || errno == EINTR ? WR_CHANNEL_QUIET : WR_CHANNEL_FAILED;
}

bool wr_channel_has_byte(int channel)
{
    char byte;
    return recv(channel, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 1;
}

bool wr_channel_wait_for_any(WrWaited *waited, int count, int ms, bool *news)
{
    struct pollfd *ready = calloc((size_t)count, sizeof *ready);
    if (!ready) abort();
    for (int i = 0; i < count; i++)
        ready[i] = (struct pollfd){ .fd = waited[i].fd, .events = waited[i].reads ? POLLIN : 0 };
    const int changed = poll(ready, (nfds_t)count, ms);
    const bool good = changed >= 0;
    *news = changed > 0;
    for (int i = 0; i < count; i++) {
        waited[i].news = good && ready[i].revents != 0;
        waited[i].gone = good && (ready[i].revents & (POLLHUP | POLLERR)) != 0;
    }
    free(ready);
    return good;
}
