/* The reader process: reads untrusted image, mesh, font and SVG files, so that a hostile one harms nothing
   else. Its protocol is reader_protocol.h. It forks for each file, so that no file is affected by
   another one. The process itself reads only the first bytes of a file, to determine whether the image
   library is needed.

   Libraries of images, meshes and drawings are loaded once, in a second process that forks for the files
   which need them: a fork copies the tables of all mapped memory, and costs ten times as much with them.
   It is started by the first such file, or when no file comes at first. */
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/decode.h"
#include "image/font_internal.h"
#include "image/mesh_decode.h"
#include "image/module_path.h"
#include "image/oiio.h"
#include "image/reader_protocol.h"
#include "image/svg.h"
#include "system/channel.h"
#include "system/child.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"
#include "system/sandbox.h"
#include "system/open_interposer.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- answers ---- */

#define CHANNEL 3
#define PICTURE WR_INTERPOSED_FILE
/* Memory for reading a small image: tables and buffers of the libraries. */
#define MEMORY_BASE ((uint64_t)512 << 20)

typedef struct Serving {
    WrDecoder *decoder;
    char *pixels;    /* the program's memory file */
    uint64_t length; /* bytes of it */
} Serving;

/* Closes all descriptors except the channel and the image, and moves these to their numbers. */
static void keep_two(int file, int channel)
{
    int far_file = wr_fd_copy_above(file, 100), far_channel = wr_fd_copy_above(channel, 100);
    wr_fd_nowhere(WR_FD_IN); /* formerly the control socket */
    wr_fd_close_range(CHANNEL, 99);
    wr_fd_place(far_channel, CHANNEL);
    wr_fd_place(far_file, PICTURE);
    wr_fd_close_range(PICTURE + 1, -1);
}

static void answer(WrWireKind kind, const void *bytes, size_t length)
{
    if (!wr_wire_send(CHANNEL, kind, bytes, length, -1)) wr_process_leave(0);
}

static void answer_failure(bool memory, const WrError *err)
{
    const char *message = wr_error_message(err);
    answer(memory ? WR_WIRE_MEMORY : WR_WIRE_FAILED, message, strlen(message));
}

/* Sends the parts: four int32 (width, height, channels, type), then names of the part and of its
 * channels, each NUL-terminated. Returns the largest number of bytes of a part's pixels. */
static uint64_t answer_parts(const Serving *serving)
{
    WrText text = { 0 };
    uint64_t most = 0;
    for (int i = 0; i < wr_decoder_parts(serving->decoder); i++) {
        WrImagePart part = wr_decoder_part(serving->decoder, i);
        int32_t numbers[4] = { part.width, part.height, part.channels, (int32_t)part.type };
        wr_text_add_n(&text, (const char *)numbers, sizeof numbers);
        wr_text_add_n(&text, part.name, strlen(part.name) + 1);
        for (int c = 0; c < part.channels; c++)
            wr_text_add_n(&text, part.channel_names[c], strlen(part.channel_names[c]) + 1);
        uint64_t bytes = (uint64_t)part.width * (uint64_t)part.height * (uint64_t)part.channels * 4;
        if (bytes > most) most = bytes;
    }
    answer(WR_WIRE_OPENED, text.data, text.length);
    wr_text_fini(&text);
    return most;
}

static void map_pixels(Serving *serving, int fd, uint64_t length)
{
    wr_map_end(serving->pixels, serving->length);
    serving->pixels = wr_map(fd, length, WR_MAP_SHARE);
    serving->length = serving->pixels ? length : 0;
    wr_fd_close(fd);
}

static void read_rows(Serving *serving, const WrWireRead *want, int fd)
{
    WrError err = { "" };
    bool memory = false;
    if (fd >= 0) map_pixels(serving, fd, want->bytes);
    if (!serving->pixels) {
        answer(WR_WIRE_MEMORY, NULL, 0);
        return;
    }
    float *out = (float *)(void *)(serving->pixels + want->at);
    if (wr_decoder_read(serving->decoder, want->part, want->y, want->rows, want->channels, out,
                        &memory, &err))
        answer(WR_WIRE_DONE, NULL, 0);
    else answer_failure(memory, &err);
}

static void digest_rows(const Serving *serving, const WrWireDigest *want)
{
    WrError err = { "" };
    bool memory = false;
    WrHash digest = want->digest;
    if (wr_decoder_hash_rows(serving->decoder, want->part, want->y, want->rows, want->channels,
                             &digest, &memory, &err))
        answer(WR_WIRE_DIGEST, &digest, sizeof digest);
    else answer_failure(memory, &err);
}

static void find_text(const Serving *serving, const WrWireText *want)
{
    const char *text = wr_decoder_attribute(serving->decoder, want->part, want->name);
    answer(WR_WIRE_TEXT, text, text ? strlen(text) + 1 : 0);
}

/* The program is trusted: its requests are not validated. */
static void serve_requests(Serving *serving)
{
    for (;;) {
        WrWireHead head;
        union {
            WrWireRead read;
            WrWireDigest digest;
            WrWireText text;
        } want;
        int fd = -1, ignored;
        if (wr_wire_receive(CHANNEL, &head, sizeof head, 0.0, &fd) != WR_WIRE_GOT ||
            head.length > sizeof want ||
            wr_wire_receive(CHANNEL, &want, head.length, 0.0, &ignored) != WR_WIRE_GOT)
            return;
        if (head.kind == WR_WIRE_READ) read_rows(serving, &want.read, fd);
        if (head.kind == WR_WIRE_DIGEST) digest_rows(serving, &want.digest);
        if (head.kind == WR_WIRE_TEXT) find_text(serving, &want.text);
    }
}

/* ---- files read at once ---- */

/* Reads the whole file. NULL and an error when out of memory. */
static char *read_file(size_t *length, WrError *err)
{
    WrFileInfo info;
    int64_t size = wr_fd_info(PICTURE, &info) ? info.bytes : 0;
    char *bytes = wr_try_alloc((size_t)size + 1, 1, "the file", err);
    *length = 0;
    while (bytes && *length < (size_t)size) {
        int64_t n =
            wr_fd_read_at(PICTURE, bytes + *length, (size_t)size - *length, (int64_t)*length);
        if (n <= 0) break;
        *length += (size_t)n;
    }
    return bytes;
}

/* The program is trusted, but a file may have been shortened since the request. */
static bool make_font(const char *bytes, size_t length, const char *want, size_t want_length,
                      WrText *block, WrError *err)
{
    WrFontOrder order;
    WrFontFile files[WR_FONT_FILES];
    if (want_length < sizeof order) return wr_fail(err, "no text to shape");
    memcpy(&order, want, sizeof order);
    WrFontRequest ask = { .text = want + sizeof order,
                          .face = order.face,
                          .direction = (WrFontDirection)order.direction };
    const char *language = ask.text + order.text_length + 1;
    if (order.language_length) ask.language = language;
    if (order.axes_length) ask.axes = language + order.language_length + 1;
    for (int i = 0; i < order.file_count; i++) {
        if (order.lengths[i] > length) return wr_fail(err, "became shorter while it was read");
        files[i] = (WrFontFile){ (const uint8_t *)bytes, (size_t)order.lengths[i] };
        bytes += files[i].length;
        length -= files[i].length;
    }
    return wr_font_shape_text(files, order.file_count, &ask, block, err);
}

static bool make_svg(const char *bytes, size_t length, const char *want, size_t want_length,
                     WrText *block, bool *memory, WrError *err)
{
    WrSvgRequest ask;
    if (want_length != sizeof ask) return wr_fail(err, "no request of a drawing");
    memcpy(&ask, want, sizeof ask);
    return wr_svg_make(bytes, length, &ask, block, memory, err);
}

static char *receive_ask(uint32_t *length)
{
    WrWireHead head;
    if (wr_wire_receive(CHANNEL, &head, sizeof head, 0.0, NULL) != WR_WIRE_GOT) wr_process_leave(0);
    char *ask = wr_alloc((size_t)head.length + 1, 1);
    if (head.length > 0 && wr_wire_receive(CHANNEL, ask, head.length, 0.0, NULL) != WR_WIRE_GOT)
        wr_process_leave(0);
    *length = head.length;
    return ask;
}

static void serve_block(const WrWireOrder *order)
{
    WrError err = { "" };
    WrText block = { 0 };
    uint32_t ask_length;
    size_t length;
    bool memory = false;
    char *ask = receive_ask(&ask_length), *bytes = read_file(&length, &err);
    bool good = false;
    if (!bytes) memory = true;
    else if (order->task == WR_WIRE_MESH)
        good = wr_mesh_make(bytes, length, order->ending, ask_length > 0, &block, &memory, &err);
    else if (order->task == WR_WIRE_SVG)
        good = make_svg(bytes, length, ask, ask_length, &block, &memory, &err);
    else good = make_font(bytes, length, ask, ask_length, &block, &err);
    wr_free(bytes);
    wr_free(ask);
    if (good && block.length > WR_WIRE_MAX) good = wr_fail(&err, "is too large");
    if (good) answer(WR_WIRE_BLOCK, block.data, block.length);
    else answer_failure(memory, &err);
}

/* ---- all ---- */

/* warm: loading the library was tried; a child cannot load it. */
static void serve(const WrWireOrder *order, int file, int channel, bool warm)
{
    WrError err = { "" };
    bool memory = false;
    keep_two(file, channel);
    wr_modules_seal();
    uint64_t space = wr_sandbox_space();
    wr_process_hear_signals();
    if (!wr_sandbox_enter(order->memory, order->seconds)) {
        wr_fail(&err,
                "cannot be read safely: the system does not allow limits on the reader process");
        answer_failure(false, &err);
        return;
    }
    if (order->task != WR_WIRE_PICTURE) {
        serve_block(order);
        return;
    }
    if (!warm && wr_decoder_lacks_module(PICTURE, order->most)) {
        answer(WR_WIRE_LIBRARY, NULL, 0);
        return;
    }
    Serving serving = { .decoder = wr_decoder_open(PICTURE, order->ending, order->most,
                                                   order->numbers == 1, &memory, &err) };
    if (!serving.decoder) {
        answer_failure(memory, &err);
        return;
    }
    /* Some decoders store a whole image, in the file's type and again in another order. */
    uint64_t bytes = answer_parts(&serving), enough = MEMORY_BASE + 3 * bytes;
    if (order->memory && enough < order->memory) wr_sandbox_memory(space, enough);
    serve_requests(&serving);
}

/* ---- the process ---- */

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
    bool used;  /* an order came */
    int second; /* control socket of the second process; -1: not started */
    WrPid second_id;
    /* of the second process: */
    bool has_libraries; /* it is the second one */
    bool warm;          /* loading the image library was tried */
    bool loaded;        /* with success */
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

/* One-time initialisation of the library, shared by all children. The children report its error; the next file tries again,
   since the library may have been installed meanwhile. Dependencies of the library start threads when they are loaded. A child has none of these threads,
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
    process->loaded = library != NULL;
}

/* ---- the second process ---- */

static void refuse(int channel, const char *reason)
{
    wr_wire_send(channel, WR_WIRE_FAILED, reason, strlen(reason), -1);
    wr_fd_close(channel);
}

static void run(Process *process);

/* The copy has the same loop; the first process's files and children are not its own. */
static bool start_second(Process *process, bool warm_at_once)
{
    int ends[2];
    WrPid self = wr_process_id();
    if (!wr_channel_pair(ends, true)) return false;
    WrPid pid = wr_child_fork();
    if (pid == 0) {
        Process second = { .signals = -1, .second = -1, .has_libraries = true };
        if (!wr_process_die_with(self)) wr_process_leave(1);
        wr_fd_place(ends[1], CONTROL);
        wr_fd_close_range(WR_FD_ERR + 1, -1);
        if (warm_at_once) warm(&second);
        run(&second);
    }
    wr_fd_close(ends[1]);
    if (pid < 0) wr_fd_close(ends[0]);
    else process->second = ends[0], process->second_id = pid;
    return pid > 0;
}

static void pass_on(Process *process, const WrWireOrder *order, int file, int channel)
{
    const int files[2] = { file, channel };
    bool sent = false;
    for (int tries = 0; tries < 2 && !sent; tries++) { /* it may just have been killed */
        if (process->second < 0 && !start_second(process, false)) break;
        sent = wr_channel_send(process->second, order, sizeof *order, NULL, 0, files, 2);
        if (sent) continue;
        wr_fd_close(process->second);
        process->second = -1;
    }
    if (sent) wr_fd_close(channel);
    else refuse(channel, "the process for this type of file cannot be started");
}

/* ---- children ---- */

static bool needs_library(const Process *process, const WrWireOrder *order, int file)
{
    if (order->task == WR_WIRE_PICTURE)
        return !process->loaded && (order->library || wr_decoder_takes_module(file, order->ending));
    return order->task == WR_WIRE_MESH || order->task == WR_WIRE_SVG;
}

static void start_child(Process *process, const WrWireOrder *order, int file, int channel)
{
    WrPid self = wr_process_id();
    process->used = true;
    if (process->children.count >= CHILDREN_MAX) {
        refuse(channel, "too many files are being read at once");
        return;
    }
    if (needs_library(process, order, file)) {
        if (!process->has_libraries) {
            pass_on(process, order, file, channel);
            return;
        }
        if (order->task == WR_WIRE_PICTURE) warm(process);
        if (order->task == WR_WIRE_MESH) wr_mesh_load(NULL);
        if (order->task == WR_WIRE_SVG) wr_svg_load(NULL);
    }
    WrPid pid = wr_child_fork();
    if (pid == 0) {
        if (!wr_process_die_with(self)) wr_process_leave(1);
        serve(order, file, channel, process->warm);
        wr_process_leave(0);
    }
    if (pid < 0) {
        refuse(channel, strerror(errno));
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
        if (process->second >= 0 && pid == process->second_id) {
            wr_fd_close(process->second);
            process->second = -1; /* the next file that needs libraries starts another one */
        }
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
    else if (fds[1] >= 0) refuse(fds[1], other);
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
        /* started ahead of need, by the window; documents need no library */
        const bool idle = !process->has_libraries && process->second < 0 && !process->used;
        if (!wr_channel_wait_for_any(waited.data, waited.count, idle ? IDLE_MS : -1, &news))
            continue;
        if (!news && !start_second(process, true)) process->used = true;
        for (int i = 0; i < process->children.count; i++) {
            if (!waited.data[2 + i].gone) continue;
            wr_child_kill(process->children.data[i].pid);
            stop_listening(&process->children.data[i]);
        }
        if (waited.data[1].news) reap(process);
        if (waited.data[0].news) going = take_order(process);
    }
}

static void run(Process *process)
{
    process->signals = wr_children_watch();
    if (process->signals >= 0) work(process);
    if (process->second >= 0) wr_fd_close(process->second); /* it ends */
    for (int i = 0; i < process->children.count; i++) wr_child_kill(process->children.data[i].pid);
    wr_children_wait_for_all();
    wr_process_leave(0);
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
    Process process = { .signals = -1, .second = -1 };
    settle();
    wr_children_hold(); /* before the libraries start threads */
    run(&process);
}
