#include "image/reader_client.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/pool.h"
#include "base/text.h"
#include "image/module_path.h"
#include "system/channel.h"
#include "system/child.h"
#include "system/clock.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"
#include "system/thread.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* ---- the process ---- */

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
        wr_fail(err,
                "pictures, meshes and fonts need the program " READER_FILE
                ", which was not found at: %s",
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

static bool start_order(int control, const WrWireOrder *order, int file, int channel)
{
    int fds[2] = { file, channel };
    return wr_channel_send(control, order, sizeof *order, NULL, 0, fds, 2);
}

/* Sends it an order with the file and one end of a channel, both borrowed for the call. Any thread. */
static bool process_order(const WrWireOrder *order, int file, int channel, WrError *err)
{
    Process *process = the_process();
    bool sent = false;
    wr_mutex_lock(&process->lock);
    for (int attempt = 0; attempt < 2 && !sent; attempt++) {
        if (!start(process, err)) break;
        sent = start_order(process->control, order, file, channel);
        if (sent) continue;
        wr_fail(err, "the reader process cannot be reached (%s)", strerror(errno));
        forget(process);
    }
    wr_mutex_unlock(&process->lock);
    return sent;
}

/* ---- requests ---- */

#define SECONDS 60       /* time limit without a reply */
#define BLOCK_SECONDS 20 /* time limit without a reply for files read at once */
#define MEGABYTES 4096   /* memory limit */
/* maximum bytes of rows transferred at once, unless a row is larger */
#define CHUNK ((size_t)16 << 20)

typedef struct Attribute {
    int part;
    char *name, *text; /* owned; text NULL: absent */
} Attribute;

struct WrReader {
    char *name; /* of the file, for messages */
    int channel;
    unsigned seconds, megabytes;
    char *answer; /* reply of OPENED; the parts point into it */
    WrImagePart *parts;
    int count;
    const char **names; /* of all channels of all parts */
    WR_ARRAY(Attribute) attributes;
    const char *shared; /* memory written by the child: two chunks of rows */
    size_t shared_bytes;
    int last_part, last_end; /* the part, and the row below those read last */
    WrWireRead ahead;        /* chunk that was requested in advance; rows 0: none */
    bool lacks;              /* the child needs the library, which was not loaded */
    bool dead;               /* the child has ended; the reason is in `end` */
    WrError end;
};

bool wr_reader_inside(void)
{
    const char *where = getenv("WRINKLE_READER");
    return where && strcmp(where, "inside") == 0;
}

int wr_reader_file(const char *path, uint64_t limit, WrError *err)
{
    uint64_t length;
    int fd = wr_file_open(path, limit, &length, err);
    if (fd < 0 || length > 0) return fd;
    wr_fail(err, "%s: is empty", path);
    wr_fd_close(fd);
    return -1;
}

typedef struct Answer {
    WrWireHead head;
    char *bytes; /* [head.length] and a NUL; NULL for length 0 */
} Answer;

/* ---- messages ---- */

static unsigned setting(const char *name, unsigned otherwise)
{
    const char *text = getenv(name);
    double value;
    if (!text || !wr_number_parse(text, strlen(text), &value)) return otherwise;
    return value >= 1 && value <= 1e6 ? (unsigned)value : otherwise;
}

/* Ends this reading with an error. Closing the channel ends the child if it still runs. */
static bool die(WrReader *reader, const char *why)
{
    if (reader->channel >= 0) wr_fd_close(reader->channel);
    reader->channel = -1;
    reader->dead = true;
    return wr_fail(&reader->end, "%s: %s", reader->name, why);
}

static bool die_of_nonsense(WrReader *reader)
{
    return die(reader, "the reader's answer makes no sense; the file is damaged or hostile");
}

static bool die_of_time(WrReader *reader)
{
    WrError why;
    wr_fail(&why, "no data was read from it within %u s; the file is damaged or hostile",
            reader->seconds);
    return die(reader, wr_error_message(&why));
}

static bool die_of_status(WrReader *reader, const Answer *answer)
{
    WrWireDied report;
    WrError why;
    if (answer->head.length != sizeof report) return die_of_nonsense(reader);
    memcpy(&report, answer->bytes, sizeof report);
    const WrChildEnd end = { (WrChildWhy)report.why, report.number };
    if (end.why == WR_CHILD_LATE) return die_of_time(reader);
    if (end.why == WR_CHILD_KILLED)
        return die(reader, "the reader was killed while it read this file (by hand, or for want of "
                           "memory)");
    const char *name = end.why == WR_CHILD_CRASHED ? wr_child_crash(end.number) : NULL;
    wr_fail(&why, "the reader crashed on this file%s%s%s; it is damaged or hostile",
            name ? " (" : "", name ? name : "", name ? ")" : "");
    return die(reader, wr_error_message(&why));
}

/* Fails with the message of the reader's error, reduced to one line. */
static bool fail_sentence(const WrReader *reader, Answer *answer, WrError *err)
{
    for (uint32_t i = 0; i < answer->head.length; i++)
        if (((unsigned char)answer->bytes[i] < ' ' &&
             !memchr(WR_MESSAGE_MARKS, answer->bytes[i], 3)) ||
            answer->bytes[i] == 127)
            answer->bytes[i] = ' ';
    return wr_fail(err, "%s: %s", reader->name, answer->bytes ? answer->bytes : "");
}

static bool fail_memory(const WrReader *reader, WrError *err)
{
    return wr_fail(err, "%s: needs more than %u MB of memory to be read", reader->name,
                   reader->megabytes);
}

/* Deadline of a reply awaited from now on. */
static double deadline_of(const WrReader *reader)
{
    return wr_clock_seconds() + reader->seconds;
}

static bool receive_whole(WrReader *reader, double deadline, Answer *answer)
{
    *answer = (Answer){ 0 };
    WrWireGot got =
        wr_wire_receive(reader->channel, &answer->head, sizeof answer->head, deadline, NULL);
    if (got == WR_WIRE_GOT && answer->head.length > WR_WIRE_MAX) return die_of_nonsense(reader);
    if (got == WR_WIRE_GOT && answer->head.length > 0) {
        WrError err;
        answer->bytes = wr_try_alloc((size_t)answer->head.length + 1, 1, "an answer", &err);
        if (!answer->bytes) return die(reader, wr_error_message(&err));
        got = wr_wire_receive(reader->channel, answer->bytes, answer->head.length, deadline, NULL);
    }
    if (got == WR_WIRE_LATE) return die_of_time(reader);
    if (got == WR_WIRE_GONE) return die(reader, "the reader was killed while it read this file");
    if (answer->head.kind == WR_WIRE_DIED) return die_of_status(reader, answer);
    return true;
}

/* Waits for a reply of this kind. On success the caller frees answer->bytes. */
static bool receive_by(WrReader *reader, double deadline, WrWireKind kind, Answer *answer,
                       WrError *err)
{
    bool good = receive_whole(reader, deadline, answer);
    if (good && answer->head.kind == kind) return true;
    if (good && answer->head.kind == WR_WIRE_FAILED) fail_sentence(reader, answer, err);
    else if (good && answer->head.kind == WR_WIRE_MEMORY) fail_memory(reader, err);
    else if (good && answer->head.kind == WR_WIRE_LIBRARY && !reader->lacks) reader->lacks = true;
    else {
        if (good) die_of_nonsense(reader);
        wr_fail(err, "%s", wr_error_message(&reader->end));
    }
    wr_free(answer->bytes);
    answer->bytes = NULL;
    return false;
}

static bool receive(WrReader *reader, WrWireKind kind, Answer *answer, WrError *err)
{
    return receive_by(reader, deadline_of(reader), kind, answer, err);
}

/* Receives and ignores a reply. */
static void discard_reply(WrReader *reader)
{
    Answer ignored;
    if (reader->dead) return;
    receive_whole(reader, deadline_of(reader), &ignored);
    wr_free(ignored.bytes);
}

static void forget_ahead(WrReader *reader)
{
    if (reader->ahead.rows > 0) discard_reply(reader);
    reader->ahead.rows = 0;
}

/* ---- opening ---- */

/* The next of several NUL-terminated texts, or NULL. */
static const char *take_text(const char **at, const char *end)
{
    const char *text = *at, *stop = memchr(text, '\0', (size_t)(end - text));
    if (!stop) return NULL;
    *at = stop + 1;
    return text;
}

static bool take_part(WrReader *reader, const char **at, const char *end, int *names)
{
    int32_t numbers[4];
    if ((size_t)(end - *at) < sizeof numbers || reader->count >= WR_IMAGE_PARTS_MAX) return false;
    memcpy(numbers, *at, sizeof numbers);
    *at += sizeof numbers;
    if (numbers[0] < 1 || numbers[0] > WR_IMAGE_MAX || numbers[1] < 1 ||
        numbers[1] > WR_IMAGE_MAX || numbers[2] < 1 || numbers[2] > WR_IMAGE_CHANNELS_MAX ||
        numbers[3] < 0 || numbers[3] > WR_PIXEL_F32)
        return false;
    WrImagePart part = { .name = take_text(at, end),
                         .width = numbers[0],
                         .height = numbers[1],
                         .channels = numbers[2],
                         .type = (WrPixelType)numbers[3] };
    if (!part.name) return false;
    reader->names = wr_realloc(reader->names, (size_t)*names, (size_t)(*names + part.channels),
                               sizeof *reader->names);
    for (int c = 0; c < part.channels; c++) {
        const char *name = take_text(at, end);
        if (!name) return false;
        reader->names[(*names)++] = name;
    }
    reader->parts = wr_realloc(reader->parts, (size_t)reader->count, (size_t)reader->count + 1,
                               sizeof *reader->parts);
    reader->parts[reader->count++] = part;
    return true;
}

/* Parses the parts sent by reader_main.c. The reader owns the reply. */
static bool take_parts(WrReader *reader, const Answer *answer, int most)
{
    reader->answer = answer->bytes;
    const char *at = answer->bytes, *end = at + answer->head.length;
    int names = 0;
    while (at != end)
        if (!take_part(reader, &at, end, &names)) return false;
    const char **next = reader->names;
    for (int i = 0; i < reader->count; i++) {
        reader->parts[i].channel_names = next;
        next += reader->parts[i].channels;
    }
    return reader->count >= 1 && (most < 0 || reader->count <= most);
}

/* Sends the order to the process; the reader gets its channel. */
static bool send_order(WrReader *reader, const WrWireOrder *order, int fd, WrError *err)
{
    int ends[2];
    if (!wr_channel_pair(ends, false))
        return wr_fail(err, "%s: no socket to the reader process", reader->name);
    bool sent = process_order(order, fd, ends[1], err);
    wr_fd_close(ends[1]);
    reader->channel = ends[0];
    reader->dead = false;
    if (!sent) wr_error_prefix(err, "%s: ", reader->name);
    return sent;
}

/* One of several attempts that share a deadline. Fails without a message if the child needs the library.
 * *gone: no reply at all, not even the child's exit status: the process itself may have ended. */
static bool open_once(WrReader *reader, const WrWireOrder *order, int fd, double deadline,
                      bool *gone, WrError *err)
{
    Answer answer;
    *gone = false;
    if (!send_order(reader, order, fd, err)) return false;
    *gone = wr_wire_wait(reader->channel, deadline) == WR_WIRE_GONE;
    if (!receive_by(reader, deadline, WR_WIRE_OPENED, &answer, err)) return false;
    if (take_parts(reader, &answer, order->most)) return true;
    die_of_nonsense(reader);
    return wr_fail(err, "%s", wr_error_message(&reader->end));
}

static WrReader *new_reader(const char *name, int fd, WrWireTask task, int most, WrWireOrder *order)
{
    WrFileInfo info;
    double size = wr_fd_info(fd, &info) ? (double)info.bytes : 0.0;
    WrReader *reader = wr_alloc(1, sizeof *reader);
    reader->name = wr_strdup(name);
    reader->channel = -1;
    bool picture = task == WR_WIRE_PICTURE;
    unsigned patience = picture ? SECONDS : BLOCK_SECONDS;
    reader->seconds = setting("WRINKLE_READER_SECONDS", patience + (unsigned)(size / 1e6));
    reader->megabytes = setting("WRINKLE_READER_MB", MEGABYTES);
    *order = (WrWireOrder){ .version = WR_WIRE_VERSION,
                            .task = task,
                            .most = most,
                            .memory = (uint64_t)reader->megabytes << 20,
                            .seconds = (picture ? 10 : 1) * reader->seconds };
    wr_path_ending(name, order->ending);
    return reader;
}

WrReader *wr_reader_open(const char *name, int fd, int most, bool numbers, WrError *err)
{
    WrWireOrder order;
    WrReader *reader = new_reader(name, fd, WR_WIRE_PICTURE, most, &order);
    order.numbers = numbers;
    double deadline = deadline_of(reader);
    bool gone = true, good = false;
    for (int attempt = 0; attempt < 3 && !good && (gone || reader->lacks != order.library);
         attempt++) {
        if (reader->channel >= 0) wr_fd_close(reader->channel);
        order.library = reader->lacks;
        good = open_once(reader, &order, fd, deadline, &gone, err);
    }
    if (good) return reader;
    wr_reader_close(reader);
    return NULL;
}

void wr_reader_close(WrReader *reader)
{
    if (!reader) return;
    if (reader->channel >= 0) wr_fd_close(reader->channel);
    wr_map_end(reader->shared, reader->shared_bytes);
    for (int i = 0; i < reader->attributes.count; i++) {
        wr_free(reader->attributes.data[i].name);
        wr_free(reader->attributes.data[i].text);
    }
    wr_array_free(&reader->attributes);
    wr_free(reader->parts);
    wr_free((void *)reader->names);
    wr_free(reader->answer);
    wr_free(reader->name);
    wr_free(reader);
}

int wr_reader_parts(const WrReader *reader)
{
    return reader->count;
}

WrImagePart wr_reader_part(const WrReader *reader, int part)
{
    return reader->parts[part];
}

const char *wr_reader_attribute(WrReader *reader, int part, const char *name)
{
    for (int i = 0; i < reader->attributes.count; i++) {
        const Attribute *known = &reader->attributes.data[i];
        if (known->part == part && strcmp(known->name, name) == 0) return known->text;
    }
    WrWireText want = { .part = part };
    Answer answer;
    forget_ahead(reader);
    if (reader->dead || strlen(name) >= sizeof want.name) return NULL;
    strcpy(want.name, name);
    if (!wr_wire_send(reader->channel, WR_WIRE_TEXT, &want, sizeof want, -1) ||
        !receive(reader, WR_WIRE_TEXT, &answer, NULL))
        return NULL;
    wr_array_push(&reader->attributes, ((Attribute){ part, wr_strdup(name), answer.bytes }));
    return answer.bytes;
}

/* ---- pixels ---- */

/* Memory of at least `bytes` that the child may write and nobody can shrink. Returns its descriptor to
 * be sent, -1 if the child already has it, or -2 and an error. */
static int share(WrReader *reader, size_t bytes, WrError *err)
{
    if (reader->shared && reader->shared_bytes >= bytes) return -1;
    wr_map_end(reader->shared, reader->shared_bytes);
    reader->shared = NULL;
    int fd = wr_fd_memory_fixed("wrinkle rows", bytes);
    const void *map = fd >= 0 ? wr_map(fd, bytes, WR_MAP_WATCH) : NULL;
    if (!map) {
        if (fd >= 0) wr_fd_close(fd);
        wr_fail(err, "%s: not enough memory for %.0f MB of rows", reader->name,
                (double)bytes / 1e6);
        return -2;
    }
    reader->shared = map;
    reader->shared_bytes = bytes;
    return fd;
}

/* Rows are transferred in chunks, two at a time: one is decoded while the other is copied. If a part is read downwards, the
   chunk below is decoded while the caller works on its rows. */
typedef struct Rows {
    int part, y, rows, channels;
    size_t row;  /* bytes */
    int step;    /* rows of a chunk */
    int count;   /* chunks */
    size_t slot; /* bytes of a chunk */
} Rows;

static int chunk_rows(const Rows *rows, int chunk)
{
    int left = rows->rows - chunk * rows->step;
    return left < rows->step ? left : rows->step;
}

static WrWireRead chunk_at(const Rows *rows, int chunk)
{
    return (WrWireRead){ .part = rows->part,
                         .y = rows->y + chunk * rows->step,
                         .rows = chunk_rows(rows, chunk),
                         .channels = rows->channels,
                         .at = (uint64_t)(chunk & 1) * rows->slot };
}

static void ask(const WrReader *reader, WrWireRead want, int fd)
{
    want.bytes = fd >= 0 ? reader->shared_bytes : 0;
    /* If the child has ended, its last messages are read later. */
    wr_wire_send(reader->channel, WR_WIRE_READ, &want, sizeof want, fd);
}

/* True if this chunk was requested already. */
static bool is_ahead(const WrReader *reader, const WrWireRead *want)
{
    const WrWireRead *ahead = &reader->ahead;
    return ahead->part == want->part && ahead->y == want->y && ahead->rows == want->rows &&
           ahead->channels == want->channels;
}

/* Requests the chunk below these rows, if it is likely to be read next. */
static void look_ahead(WrReader *reader, const Rows *rows)
{
    const bool downwards =
        rows->y == 0 || (rows->part == reader->last_part && rows->y == reader->last_end);
    Rows next = *rows;
    next.y += rows->rows;
    reader->last_part = rows->part;
    reader->last_end = next.y;
    const int left = reader->parts[rows->part].height - next.y;
    if (next.rows > left) next.rows = left;
    if (!downwards || left <= 0) return;
    reader->ahead = chunk_at(&next, 0);
    ask(reader, reader->ahead, -1);
}

bool wr_reader_read(WrReader *reader, int part, int y, int rows, int channels, float *out,
                    WrError *err)
{
    Rows all = { .part = part, .y = y, .rows = rows, .channels = channels };
    all.row = (size_t)reader->parts[part].width * (size_t)channels * sizeof(float);
    all.step = CHUNK / all.row >= WR_IMAGE_STRIP ? WR_IMAGE_STRIP
               : CHUNK / all.row > 1             ? (int)(CHUNK / all.row)
                                                 : 1;
    all.count = (rows + all.step - 1) / all.step;
    all.slot = all.row * (size_t)all.step;
    const WrWireRead first = chunk_at(&all, 0);
    int asked = is_ahead(reader, &first) ? 1 : 0, done = 0, fd = -1;
    if (asked) reader->ahead.rows = 0;
    else forget_ahead(reader);
    if (reader->dead) return wr_fail(err, "%s", wr_error_message(&reader->end));
    if (!asked && (fd = share(reader, 2 * all.slot, err)) == -2) return false;
    bool good = true;
    while (good && done < all.count) {
        for (; asked < all.count && asked - done < 2; asked++)
            ask(reader, chunk_at(&all, asked), asked == 0 ? fd : -1);
        Answer answer;
        good = receive(reader, WR_WIRE_DONE, &answer, err);
        if (!good) break;
        wr_free(answer.bytes);
        memcpy((char *)out + (size_t)done * all.slot,
               reader->shared + (size_t)(done & 1) * all.slot,
               all.row * (size_t)chunk_rows(&all, done));
        done++;
    }
    if (fd >= 0) wr_fd_close(fd);
    if (!good && asked - done > 1) discard_reply(reader);
    if (good) look_ahead(reader, &all);
    return good;
}

bool wr_reader_digest(WrReader *reader, int part, int y, int rows, int channels, WrHash *digest,
                      WrError *err)
{
    WrWireDigest want = { part, y, rows, channels, *digest };
    Answer answer;
    forget_ahead(reader);
    if (reader->dead) return wr_fail(err, "%s", wr_error_message(&reader->end));
    wr_wire_send(reader->channel, WR_WIRE_DIGEST, &want, sizeof want, -1);
    if (!receive(reader, WR_WIRE_DIGEST, &answer, err)) return false;
    bool good = answer.head.length == sizeof *digest;
    if (good) memcpy(digest, answer.bytes, sizeof *digest);
    wr_free(answer.bytes);
    return good || die_of_nonsense(reader) || wr_fail(err, "%s", wr_error_message(&reader->end));
}

/* ---- other files ---- */

bool wr_reader_block(const char *name, int fd, WrWireTask task, const void *ask, size_t ask_length,
                     char **block, size_t *length, WrError *err)
{
    WrWireOrder order;
    WrReader *reader = new_reader(name, fd, task, 1, &order);
    Answer answer = { 0 };
    double deadline = deadline_of(reader);
    bool good = false, gone = true;
    for (int attempt = 0; attempt < 2 && gone && !good; attempt++) {
        if (reader->channel >= 0) wr_fd_close(reader->channel);
        reader->channel = -1;
        if (!send_order(reader, &order, fd, err)) break;
        /* If the child has ended, its last messages are read below. */
        wr_wire_send(reader->channel, WR_WIRE_ASK, ask, ask_length, -1);
        gone = wr_wire_wait(reader->channel, deadline) == WR_WIRE_GONE;
        good = receive_by(reader, deadline, WR_WIRE_BLOCK, &answer, err);
    }
    if (good) {
        *block = answer.bytes ? answer.bytes : wr_alloc(1, 1);
        *length = answer.head.length;
    }
    wr_reader_close(reader);
    return good;
}
