/* The reader process: reads untrusted image, mesh and font files, so that a hostile one harms nothing
   else. Its protocol is reader_protocol.h. It forks for each file, so that no file is affected by
   another one. The process itself reads only the first bytes of a file, to determine whether the image
   library is needed. The library is loaded once: when a file needs it, or when the process is idle. */
#include "base/array.h"
#include "image/decode.h"
#include "image/mesh_decode.h"
#include "image/oiio.h"
#include "image/reader_child.h"
#include "image/reader_protocol.h"
#include "system/channel.h"
#include "system/child.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CONTROL 0        /* descriptor of the control socket */
#define CHILDREN_MAX 256 /* files being read at once */
#define IDLE_MS 200      /* a program that wanted one small file has ended by then */

typedef struct Child {
    WrPid pid;
    int channel; /* our copy of its end, for DIED; -1: closed */
} Child;

typedef struct Process {
    int signals; /* reports ended children */
    WR_ARRAY(Child) children;
    bool warm; /* the image library is loaded, as far as possible */
} Process;

/* Silences output, starts a new session, leaves the current folder. */
static void settle(void)
{
    const char *loud = getenv("WRINKLE_READER");
    wr_process_stand_alone();
    wr_fd_nowhere(WR_FD_OUT);
    if (!loud || strcmp(loud, "loud") != 0) wr_fd_nowhere(WR_FD_ERR);
    wr_fd_close_range(WR_FD_ERR + 1, -1);
    if (!wr_process_leave_folder()) wr_process_leave(1);
    wr_process_keep_rights();
}

/* One-time initialisation of the library, shared by all children. Errors recur when a file is read.
   Dependencies of the library start threads when they are loaded. A child has none of these threads,
   but would inherit the locks they hold at that moment; waiting until they sleep ensures that they hold
   none. */
static void warm(Process *process)
{
    char reason[WR_CODEC_REASON];
    const WrCodec *library = wr_oiio(NULL);
    int nothing = wr_fd_open_nowhere();
    WrCodecReader *none = library ? library->open(nothing, "tiff", 1, false, reason) : NULL;
    if (none) library->close(none);
    if (nothing >= 0) wr_fd_close(nothing);
    wr_process_wait_for_threads();
    process->warm = true;
}

/* ---- children ---- */

static void start_child(Process *process, const WrWireOrder *order, int file, int channel)
{
    WrPid self = wr_process_id();
    if (process->children.count >= CHILDREN_MAX) {
        static const char full[] = "too many files are being read at once";
        wr_wire_send(channel, WR_WIRE_FAILED, full, sizeof full - 1, -1);
        wr_fd_close(channel);
        return;
    }
    if (!process->warm && order->task == WR_WIRE_PICTURE &&
        wr_decoder_takes_module(file, order->ending))
        warm(process);
    /* loaded in the parent, so that it is loaded only once */
    if (order->task == WR_WIRE_MESH) wr_mesh_load(NULL);
    WrPid pid = wr_child_fork();
    if (pid == 0) {
        if (!wr_process_die_with(self)) wr_process_leave(1);
        wr_serve(order, file, channel);
        wr_process_leave(0);
    }
    if (pid < 0) {
        const char *reason = strerror(errno);
        wr_wire_send(channel, WR_WIRE_FAILED, reason, strlen(reason), -1);
        wr_fd_close(channel);
        return;
    }
    wr_array_push(&process->children, ((Child){ pid, channel }));
}

static void stop_listening(Child *child)
{
    if (child->channel >= 0) wr_fd_close(child->channel);
    child->channel = -1;
}

static void reap(Process *process)
{
    WrChildEnd end;
    for (WrPid pid; (pid = wr_children_next(process->signals, &end)) > 0;) {
        int i = 0;
        while (i < process->children.count && process->children.data[i].pid != pid) i++;
        if (i == process->children.count) continue;
        Child *child = &process->children.data[i];
        struct {
            WrWireHead head;
            WrWireDied how;
        } died = { { WR_WIRE_DIED, sizeof(WrWireDied) }, { (int32_t)end.why, end.number } };
        if (child->channel >= 0) wr_channel_try_send(child->channel, &died, sizeof died);
        stop_listening(child);
        *child = process->children.data[--process->children.count];
    }
}

/* ---- orders ---- */

/* Receives one packet: an order and two descriptors. False when the program has ended. */
static bool take_order(Process *process)
{
    WrWireOrder order = { 0 };
    int fds[2];
    int64_t n = wr_channel_receive(CONTROL, &order, sizeof order, fds, 2);
    if (n < 0) return n == -2;
    if (n == 0) return false;
    order.ending[sizeof order.ending - 1] = '\0';
    static const char other[] = "the reader process is of another version of the program";
    if (n == (int64_t)sizeof order && order.version == WR_WIRE_VERSION && fds[1] >= 0)
        start_child(process, &order, fds[0], fds[1]);
    else if (fds[1] >= 0) {
        wr_wire_send(fds[1], WR_WIRE_FAILED, other, sizeof other - 1, -1);
        wr_fd_close(fds[1]);
    }
    if (fds[0] >= 0) wr_fd_close(fds[0]);
    return true;
}

/* Runs until the program closes the control socket. */
static void work(Process *process)
{
    WR_ARRAY(WrWaited) waited = { 0 };
    for (bool going = true; going;) {
        waited.count = 0;
        wr_array_push(&waited, ((WrWaited){ .fd = CONTROL, .reads = true }));
        wr_array_push(&waited, ((WrWaited){ .fd = process->signals, .reads = true }));
        for (int i = 0; i < process->children.count; i++)
            wr_array_push(&waited, ((WrWaited){ .fd = process->children.data[i].channel }));
        bool news;
        if (!wr_channel_wait_for_any(waited.data, waited.count, process->warm ? -1 : IDLE_MS,
                                     &news))
            continue;
        if (!news) warm(process);
        for (int i = 0; i < process->children.count; i++) {
            if (!waited.data[2 + i].gone) continue;
            wr_child_kill(process->children.data[i].pid);
            stop_listening(&process->children.data[i]);
        }
        if (waited.data[1].news) reap(process);
        if (waited.data[0].news) going = take_order(process);
    }
}

#if defined(__SANITIZE_THREAD__)
/* Decoders start threads in a child, which this sanitizer forbids if the parent had threads too. */
const char *__tsan_default_options(void);
const char *__tsan_default_options(void)
{
    return "die_after_fork=0";
}
#endif

int main(void)
{
    if (!wr_channel_is_one(CONTROL)) {
        fputs("wrinkle-reader: is started by wrinkle itself, to read picture files\n", stderr);
        return 2;
    }
    Process process = { .signals = -1 };
    settle();
    wr_children_hold(); /* before the libraries start threads */
    process.signals = wr_children_watch();
    if (process.signals >= 0) work(&process);
    for (int i = 0; i < process.children.count; i++) wr_child_kill(process.children.data[i].pid);
    wr_children_wait_for_all();
    wr_process_leave(0);
}
