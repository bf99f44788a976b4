#include "image/serve.h"

#include "base/memory.h"
#include "image/cage.h"
#include "image/decode.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define CHANNEL 3
#define PICTURE 4
/* What reading a small picture may take: tables and buffers of the libraries. */
#define MEMORY_BASE ((uint64_t)512 << 20)

typedef struct Serving {
    WrDecoder *decoder;
    char *pixels;    /* the program's memory file */
    uint64_t length; /* bytes of it */
} Serving;

/* Nothing stays open but the channel and the picture, under their numbers. */
static void keep_two(int file, int channel)
{
    int far_file = fcntl(file, F_DUPFD, 100), far_channel = fcntl(channel, F_DUPFD, 100);
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nothing >= 0) dup2(nothing, STDIN_FILENO); /* the control socket was there */
    close_range(3, 99, 0);
    dup2(far_channel, CHANNEL);
    dup2(far_file, PICTURE);
    close_range(5, ~0U, 0);
}

static void answer(WrWireKind kind, const void *bytes, size_t length)
{
    if (!wr_wire_send(CHANNEL, kind, bytes, length, -1)) _exit(0);
}

static void answer_failure(bool memory, const WrError *err)
{
    answer(memory ? WR_WIRE_MEMORY : WR_WIRE_FAILED, err->text, strlen(err->text));
}

/* Parts as: four int32 (width, height, channels, type), then names of the part and of its channels, each
 * with its NUL. Returns the largest number of bytes that a part's pixels take. */
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
    if (serving->pixels) munmap(serving->pixels, serving->length);
    void *map = mmap(NULL, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    serving->pixels = map == MAP_FAILED ? NULL : map;
    serving->length = serving->pixels ? length : 0;
    close(fd);
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

static void find_text(const Serving *serving, const WrWireText *want)
{
    const char *text = wr_decoder_attribute(serving->decoder, want->part, want->name);
    answer(WR_WIRE_TEXT, text, text ? strlen(text) + 1 : 0);
}

/* The program is trusted: its requests are as they should be. */
static void serve_requests(Serving *serving)
{
    for (;;) {
        WrWireHead head;
        union {
            WrWireRead read;
            WrWireText text;
        } want;
        int fd = -1, ignored;
        if (wr_wire_receive(CHANNEL, &head, sizeof head, 0.0, &fd) != WR_WIRE_GOT ||
            head.length > sizeof want ||
            wr_wire_receive(CHANNEL, &want, head.length, 0.0, &ignored) != WR_WIRE_GOT)
            return;
        if (head.kind == WR_WIRE_READ) read_rows(serving, &want.read, fd);
        if (head.kind == WR_WIRE_TEXT) find_text(serving, &want.text);
    }
}

void wr_serve(const WrWireOrder *order, int file, int channel)
{
    WrError err = { "" };
    bool memory = false;
    uint64_t space = wr_cage_space();
    keep_two(file, channel);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    if (!wr_cage_enter(PICTURE, order->memory, order->seconds)) {
        wr_fail(&err, "cannot be read safely here: the system refuses to limit the reader process");
        answer_failure(false, &err);
        return;
    }
    Serving serving = { .decoder =
                            wr_decoder_open(PICTURE, order->ending, order->most, &memory, &err) };
    if (!serving.decoder) {
        answer_failure(memory, &err);
        return;
    }
    /* Some decoders hold a whole picture, in the file's type and once more in another order. */
    uint64_t bytes = answer_parts(&serving), enough = MEMORY_BASE + 3 * bytes;
    if (order->memory && enough < order->memory) wr_cage_memory(space, enough);
    serve_requests(&serving);
}
