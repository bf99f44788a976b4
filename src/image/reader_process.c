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
#define GRACE_MS 20 /* to end in order; it has nothing to lose, and who cancelled waits */

/* The program's end of the control socket, or -1. That there is a reader process is a fact of this
   process, as the module is (module_path.c). A forked copy of the program goes on using the same one. */
typedef struct Process {
    WrMutex lock;
    int control;
    WrPid pid;   /* of the reader process */
    WrPid owner; /* this process when it started that one; a forked copy is another */
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

/* The process gets the socket as its standard input. */
static int spawn(const char *path, int socket, WrPid *pid)
{
    const char *const arguments[] = { READER_FILE, NULL };
    WrChildStart it = {
        .program = path, .arguments = arguments, .in = socket, .out = -1, .err = -1, .apart = true
    };
    return wr_child_start(&it, pid);
}

/* At the end of the program: the process ends with its control socket; wait for that, so that no zombie
 * stays where nobody reaps orphans. A forked copy leaves it alone. */
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
    wr_child_kill(process->pid); /* it may still be loading */
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
            wr_once_async_watch_end(); /* before our own, which thus comes first */
            if (process->owner != wr_process_id()) atexit(leave);
            process->owner = wr_process_id();
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
