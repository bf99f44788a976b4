#include "image/process.h"

#include "base/aside.h"
#include "base/error.h"
#include "base/text.h"
#include "image/module.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define READER_FILE "wrinkle-reader"
#define GRACE_MS 20 /* to end in order; it has nothing to lose, and who cancelled waits */

/* The program's end of the control socket, or -1. That there is a reader process is a fact of this
   process, as the module is (module.c). A forked copy of the program goes on using the same one. */
typedef struct Process {
    pthread_mutex_t lock;
    int control;
    pid_t pid;   /* of the reader process */
    pid_t owner; /* this process when it started that one; a forked copy is another */
} Process;

static Process *the_process(void)
{
    static Process process = { PTHREAD_MUTEX_INITIALIZER, -1, 0, 0 };
    return &process;
}

static bool find_reader(WrText *path, WrError *err)
{
    WrText looked = { 0 };
    bool found = false;
    for (int place = 0; place < WR_MODULE_PLACES && !found; place++) {
        if (!wr_module_path(place, READER_FILE, path)) continue;
        wr_text_addf(&looked, "%s%s", looked.length ? ", " : "", wr_text_get(path));
        found = access(wr_text_get(path), X_OK) == 0;
    }
    if (!found)
        wr_fail(err, "picture files need the program " READER_FILE ", looked for at: %s",
                wr_text_get(&looked));
    wr_text_fini(&looked);
    return found;
}

/* The process gets the socket as its standard input, nothing else that is open here but standard output
 * and error, signals as they are at birth, and a session of its own, so that an interrupt from the
 * terminal is the program's affair. */
static int spawn(const char *path, int socket, pid_t *pid)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    char *const arguments[] = { (char *)READER_FILE, NULL };
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, socket, STDIN_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&actions, 3);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID);
    int trouble = posix_spawn(pid, path, &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return trouble;
}

/* At the end of the program: the process ends with its control socket; wait for that, so that no zombie
 * stays where nobody reaps orphans. A forked copy leaves it alone. */
static void leave(void)
{
    Process *process = the_process();
    if (process->control < 0 || process->owner != getpid()) return;
    close(process->control);
    process->control = -1;
    for (int ms = 0; ms < GRACE_MS; ms++) {
        if (waitpid(process->pid, NULL, WNOHANG) != 0) return;
        usleep(1000);
    }
    kill(process->pid, SIGKILL); /* it may still be loading */
    waitpid(process->pid, NULL, 0);
}

static bool start(Process *process, WrError *err)
{
    WrText path = { 0 };
    int ends[2], trouble;
    if (process->control >= 0) return true;
    if (!find_reader(&path, err)) {
        wr_text_fini(&path);
        return false;
    }
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
        trouble = errno;
    } else {
        trouble = spawn(wr_text_get(&path), ends[1], &process->pid);
        close(ends[1]);
        if (trouble != 0) {
            close(ends[0]);
        } else {
            wr_aside_watch_end(); /* before our own, which thus comes first */
            if (process->owner != getpid()) atexit(leave);
            process->owner = getpid();
            process->control = ends[0];
        }
    }
    if (trouble != 0) wr_fail(err, "%s: cannot be started (%s)", path.data, strerror(trouble));
    wr_text_fini(&path);
    return trouble == 0;
}

/* It died: forget it, and leave no zombie. (In a forked copy of the program it is no child.) */
static void forget(Process *process)
{
    close(process->control);
    process->control = -1;
    if (waitpid(process->pid, NULL, WNOHANG) != 0) return;
    kill(process->pid, SIGKILL);
    waitpid(process->pid, NULL, 0);
}

bool wr_process_start(WrError *err)
{
    Process *process = the_process();
    pthread_mutex_lock(&process->lock);
    bool good = start(process, err);
    pthread_mutex_unlock(&process->lock);
    return good;
}

static bool send_order(int control, const WrWireOrder *order, int file, int channel)
{
    int fds[2] = { file, channel };
    union {
        struct cmsghdr align;
        char bytes[CMSG_SPACE(sizeof fds)];
    } room;
    memset(&room, 0, sizeof room);
    struct iovec part = { (void *)order, sizeof *order };
    struct msghdr message = { .msg_iov = &part,
                              .msg_iovlen = 1,
                              .msg_control = room.bytes,
                              .msg_controllen = sizeof room.bytes };
    struct cmsghdr *rights = CMSG_FIRSTHDR(&message);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof fds);
    memcpy(CMSG_DATA(rights), fds, sizeof fds);
    ssize_t n;
    do n = sendmsg(control, &message, MSG_NOSIGNAL);
    while (n < 0 && errno == EINTR);
    return n == (ssize_t)sizeof *order;
}

bool wr_process_order(const WrWireOrder *order, int file, int channel, WrError *err)
{
    Process *process = the_process();
    bool sent = false;
    pthread_mutex_lock(&process->lock);
    for (int attempt = 0; attempt < 2 && !sent; attempt++) {
        if (!start(process, err)) break;
        sent = send_order(process->control, order, file, channel);
        if (sent) continue;
        wr_fail(err, "the reader process cannot be reached (%s)", strerror(errno));
        forget(process);
    }
    pthread_mutex_unlock(&process->lock);
    return sent;
}
