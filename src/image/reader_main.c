/* The reader process: reads strangers' picture files, so that a hostile one harms nobody else. See wire.h
   for what it is told and what it answers. It loads the picture library once and then forks for each
   file, so that no file meets what another one left behind; it never looks at a file itself. */
#include "base/array.h"
#include "image/mesh_make.h"
#include "image/oiio.h"
#include "image/serve.h"
#include "image/wire.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define CONTROL 0        /* descriptor of the control socket */
#define CHILDREN_MAX 256 /* files being read at once */

typedef struct Child {
    pid_t pid;
    int channel; /* our copy of its end, for DIED; -1: nobody listens any more */
} Child;

typedef struct Process {
    int signals; /* tells of children that ended */
    WR_ARRAY(Child) children;
} Process;

/* Silent, alone in its session, out of everybody's folders. */
static void settle(void)
{
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    const char *loud = getenv("WRINKLE_READER");
    if (nothing >= 0) {
        dup2(nothing, STDOUT_FILENO);
        if (!loud || strcmp(loud, "loud") != 0) dup2(nothing, STDERR_FILENO);
    }
    close_range(3, ~0U, 0);
    if (chdir("/") != 0) _exit(1);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
}

/* What every reading does first, done once for all children. Trouble shows again when a file is read. */
static void warm(void)
{
    char reason[WR_OIIO_REASON];
    const WrOiioTable *library = wr_oiio(NULL);
    int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    WrOiioReader *none = library ? library->open(nothing, "png", 1, reason) : NULL;
    if (none) library->close(none);
    if (nothing >= 0) close(nothing);
}

/* Whether every other thread of this process sleeps. */
static bool others_sleep(void)
{
    DIR *folder = opendir("/proc/self/task");
    bool asleep = true;
    if (!folder) return true;
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[64], state = 'S';
        if (entry->d_name[0] == '.' || atoi(entry->d_name) == getpid()) continue;
        snprintf(path, sizeof path, "/proc/self/task/%.20s/stat", entry->d_name);
        FILE *file = fopen(path, "re");
        if (file && fscanf(file, "%*d (%*[^)]) %c", &state) == 1 && state != 'S') asleep = false;
        if (file) fclose(file);
    }
    closedir(folder);
    return asleep;
}

/* Libraries of the picture library start threads when they are loaded. A child has none of them, but it
 * would inherit for ever what they hold at that moment; once they wait for work they hold nothing. */
static void wait_for_others(void)
{
    int quiet = 0;
    for (int ms = 0; ms < 3000 && quiet < 3; ms++) {
        quiet = others_sleep() ? quiet + 1 : 0;
        usleep(1000);
    }
}

/* ---- children ---- */

static void start_child(Process *process, const WrWireOrder *order, int file, int channel)
{
    pid_t self = getpid();
    if (process->children.count >= CHILDREN_MAX) {
        static const char full[] = "too many files are being read at once";
        wr_wire_send(channel, WR_WIRE_FAILED, full, sizeof full - 1, -1);
        close(channel);
        return;
    }
    if (order->task == WR_WIRE_MESH) wr_mesh_load(NULL); /* here, so that it is loaded but once */
    pid_t pid = fork();
    if (pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != self) _exit(1);
        wr_serve(order, file, channel);
        _exit(0);
    }
    if (pid < 0) {
        const char *reason = strerror(errno);
        wr_wire_send(channel, WR_WIRE_FAILED, reason, strlen(reason), -1);
        close(channel);
        return;
    }
    wr_array_push(&process->children, ((Child){ pid, channel }));
}

static void stop_listening(Child *child)
{
    if (child->channel >= 0) close(child->channel);
    child->channel = -1;
}

static void reap(Process *process)
{
    struct signalfd_siginfo told;
    while (read(process->signals, &told, sizeof told) > 0) continue;
    int status;
    for (pid_t pid; (pid = waitpid(-1, &status, WNOHANG)) > 0;) {
        int i = 0;
        while (i < process->children.count && process->children.data[i].pid != pid) i++;
        if (i == process->children.count) continue;
        Child *child = &process->children.data[i];
        struct {
            WrWireHead head;
            int32_t status;
        } died = { { WR_WIRE_DIED, sizeof(int32_t) }, status };
        if (child->channel >= 0)
            send(child->channel, &died, sizeof died, MSG_NOSIGNAL | MSG_DONTWAIT);
        stop_listening(child);
        *child = process->children.data[--process->children.count];
    }
}

/* ---- orders ---- */

/* One packet: an order and two descriptors. False when the program is gone. */
static bool take_order(Process *process)
{
    WrWireOrder order = { 0 };
    union {
        struct cmsghdr align;
        char bytes[CMSG_SPACE(2 * sizeof(int))];
    } control;
    struct iovec part = { &order, sizeof order };
    struct msghdr message = { .msg_iov = &part,
                              .msg_iovlen = 1,
                              .msg_control = control.bytes,
                              .msg_controllen = sizeof control.bytes };
    ssize_t n = recvmsg(CONTROL, &message, MSG_CMSG_CLOEXEC);
    if (n < 0) return errno == EINTR || errno == EAGAIN;
    if (n == 0) return false;
    struct cmsghdr *rights = CMSG_FIRSTHDR(&message);
    int fds[2] = { -1, -1 };
    if (rights && rights->cmsg_type == SCM_RIGHTS && rights->cmsg_len == CMSG_LEN(sizeof fds))
        memcpy(fds, CMSG_DATA(rights), sizeof fds);
    order.ending[sizeof order.ending - 1] = '\0';
    static const char other[] = "the reader process is of another version of the program";
    if (n == sizeof order && order.version == WR_WIRE_VERSION && fds[1] >= 0)
        start_child(process, &order, fds[0], fds[1]);
    else if (fds[1] >= 0) {
        wr_wire_send(fds[1], WR_WIRE_FAILED, other, sizeof other - 1, -1);
        close(fds[1]);
    }
    if (fds[0] >= 0) close(fds[0]);
    return true;
}

/* Until the program closes the control socket. */
static void work(Process *process)
{
    WR_ARRAY(struct pollfd) ready = { 0 };
    for (bool going = true; going;) {
        ready.count = 0;
        wr_array_push(&ready, ((struct pollfd){ .fd = CONTROL, .events = POLLIN }));
        wr_array_push(&ready, ((struct pollfd){ .fd = process->signals, .events = POLLIN }));
        for (int i = 0; i < process->children.count; i++)
            wr_array_push(&ready, ((struct pollfd){ .fd = process->children.data[i].channel }));
        if (poll(ready.data, (nfds_t)ready.count, -1) < 0) continue;
        for (int i = 0; i < process->children.count; i++) {
            if (!(ready.data[2 + i].revents & (POLLHUP | POLLERR))) continue;
            kill(process->children.data[i].pid, SIGKILL);
            stop_listening(&process->children.data[i]);
        }
        if (ready.data[1].revents) reap(process);
        if (ready.data[0].revents) going = take_order(process);
    }
}

#if defined(__SANITIZE_THREAD__)
/* Decoders start threads in a child, which this sanitizer forbids where the parent had threads as well. */
const char *__tsan_default_options(void);
const char *__tsan_default_options(void)
{
    return "die_after_fork=0";
}
#endif

int main(void)
{
    struct sockaddr_storage name;
    socklen_t length = sizeof name;
    if (getsockname(CONTROL, (struct sockaddr *)&name, &length) != 0 || name.ss_family != AF_UNIX) {
        fputs("wrinkle-reader: is started by wrinkle itself, to read picture files\n", stderr);
        return 2;
    }
    Process process = { .signals = -1 };
    settle();
    /* Before the libraries start threads of their own, which would swallow it. */
    sigset_t ended;
    sigemptyset(&ended);
    sigaddset(&ended, SIGCHLD);
    sigprocmask(SIG_BLOCK, &ended, NULL);
    warm();
    wait_for_others();
    process.signals = signalfd(-1, &ended, SFD_CLOEXEC | SFD_NONBLOCK);
    if (process.signals >= 0) work(&process);
    for (int i = 0; i < process.children.count; i++) kill(process.children.data[i].pid, SIGKILL);
    while (waitpid(-1, NULL, 0) > 0) continue;
    _exit(0);
}
