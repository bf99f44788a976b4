#include "image/reader_process.h"

#include "base/once_async.h"
#include "base/error.h"
#include "base/text.h"
#include "image/module_path.h"
#include "system/channel.h"
#include "system/child.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"
#include "system/thread.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define READER_FILE "wrinkle-reader"
/* time for a regular exit; it has no unsaved data, and a cancelled user waits */
#define GRACE_MS 20

/* The program's end of the control socket, or -1. The reader process is state of the program's process,
   like modules (module_path.c). A forked copy of the program continues to use the same one. */
typedef struct Process {
    WrMutex lock;
    int control;
    WrPid pid; /* of the reader process */
    WrPid
        owner; /* the program's process when it started the reader; a forked copy has another id */
} Process;

static Process *the_process(void)
{
    static Process process = { WR_MUTEX_READY, -1, 0, 0 };
    return &process;
}

static bool find_reader(WrText *path, WrError *err)
{
    WrText looked = { 0 };
    bool found = false;
    for (int place = 0; place < WR_MODULE_PLACES && !found; place++) {
        if (!wr_module_path(place, READER_FILE, path)) continue;
        wr_text_addf(&looked, "%s%s", looked.length ? ", " : "", wr_text_get(path));
        found = wr_path_can_run(wr_text_get(path));
    }
    if (!found)
        wr_fail(err, "picture files need the program " READER_FILE ", looked for at: %s",
                wr_text_get(&looked));
    wr_text_fini(&looked);
    return found;
}

/* Starts the process with the socket as its standard input. */
static int spawn(const char *path, int socket, WrPid *pid)
{
    const char *const arguments[] = { READER_FILE, NULL };
    WrChildStart it = {
        .program = path, .arguments = arguments, .in = socket, .out = -1, .err = -1, .apart = true
    };
    return wr_child_start(&it, pid);
}

/* At the program's exit: the process ends when its control socket is closed; waits for that, so that no
 * zombie remains on systems that do not reap orphans. A forked copy does nothing. */
static void leave(void)
{
    WrChildEnd end;
    Process *process = the_process();
    if (process->control < 0 || process->owner != wr_process_id()) return;
    wr_fd_close(process->control);
    process->control = -1;
    for (int ms = 0; ms < GRACE_MS; ms++) {
        if (wr_child_is_gone(process->pid)) return;
        wr_thread_sleep_ms(1);
    }
    wr_child_kill(process->pid); /* it may still be loading libraries */
    wr_child_wait(process->pid, &end);
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
    if (!wr_channel_pair(ends, true)) {
        trouble = errno;
    } else {
        trouble = spawn(wr_text_get(&path), ends[1], &process->pid);
        wr_fd_close(ends[1]);
        if (trouble != 0) {
            wr_fd_close(ends[0]);
        } else {
            /* registered before our handler, which therefore runs first */
            wr_once_async_watch_end();
            if (process->owner != wr_process_id()) atexit(leave);
            process->owner = wr_process_id();
            process->control = ends[0];
        }
    }
    if (trouble != 0) wr_fail(err, "%s: cannot be started (%s)", path.data, strerror(trouble));
    wr_text_fini(&path);
    return trouble == 0;
}

/* Resets the state after the process has ended, and reaps it. (In a forked copy of the program it is no
 * child.) */
static void forget(Process *process)
{
    WrChildEnd end;
    wr_fd_close(process->control);
    process->control = -1;
    if (wr_child_is_gone(process->pid)) return;
    wr_child_kill(process->pid);
    wr_child_wait(process->pid, &end);
}

bool wr_process_start(WrError *err)
{
    Process *process = the_process();
    wr_mutex_lock(&process->lock);
    bool good = start(process, err);
    wr_mutex_unlock(&process->lock);
    return good;
}

static bool send_order(int control, const WrWireOrder *order, int file, int channel)
{
    int fds[2] = { file, channel };
    return wr_channel_send(control, order, sizeof *order, NULL, 0, fds, 2);
}

bool wr_process_order(const WrWireOrder *order, int file, int channel, WrError *err)
{
    Process *process = the_process();
    bool sent = false;
    wr_mutex_lock(&process->lock);
    for (int attempt = 0; attempt < 2 && !sent; attempt++) {
        if (!start(process, err)) break;
        sent = send_order(process->control, order, file, channel);
        if (sent) continue;
        wr_fail(err, "the reader process cannot be reached (%s)", strerror(errno));
        forget(process);
    }
    wr_mutex_unlock(&process->lock);
    return sent;
}
