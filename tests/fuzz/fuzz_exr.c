/* Damaged documents: a valid file with changed bytes is refused, or all rows of its parts are read within bounds. The first
   byte chooses the number of rows read at once; each three bytes after it are a place and a change. */
#include "base/file.h"
#include "base/memory.h"
#include "image/exr.h"
#include "system/fd.h"

#include <stdint.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define ROOM 8192
#define WIDTH 60
#define HEIGHT 37

typedef struct File {
    char bytes[ROOM];
    size_t length;
} File;

static bool add_bytes(void *to, const void *bytes, size_t length, int64_t at)
{
    File *file = to;
    if (at < 0 || (size_t)at + length > ROOM) return false;
    memcpy(file->bytes + at, bytes, length);
    if ((size_t)at + length > file->length) file->length = (size_t)at + length;
    return true;
}

/* Two parts, with steps that compress. */
static void make(File *file)
{
    static const WrImageAttribute mark = { "wrinkle:version", "2" };
    const WrImageOut part = {
        .width = WIDTH, .height = HEIGHT, .channels = 1, .type = WR_PIXEL_F32
    };
    WrImageOut parts[2] = { part, part };
    parts[0].part_name = "F", parts[0].attributes = &mark, parts[0].attribute_count = 1;
    parts[1].part_name = "colour", parts[1].channels = 3;
    const WrByteSink sink = { add_bytes, file };
    char reason[WR_CODEC_REASON];
    float rows[3 * WIDTH * HEIGHT];
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) rows[i] = (float)(i / 50 % 7);
    WrCodecWriter *writer = wr_exr_codec.create(&sink, -1, "openexr", parts, 2, reason);
    wr_exr_codec.write(writer, 0, HEIGHT, rows, reason);
    wr_exr_codec.next(writer, reason);
    wr_exr_codec.write(writer, 0, HEIGHT, rows, reason);
    wr_exr_codec.finish(writer, true, reason);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static File whole;
    char reason[WR_CODEC_REASON] = "";
    if (whole.length == 0) make(&whole);
    if (size < 1) return 0;
    File file = whole;
    for (size_t k = 1; k + 2 < size; k += 3)
        file.bytes[(data[k] << 8 | data[k + 1]) % file.length] ^= (char)data[k + 2];
    const int fd = wr_fd_in_memory("fuzz.exr", file.bytes, file.length, NULL);
    WrCodecReader *reader = wr_exr_codec.open(fd, "openexr", 16, false, reason);
    for (int i = 0; reader && i < wr_exr_codec.parts(reader); i++) {
        const WrImagePart is = wr_exr_codec.part(reader, i)->part;
        const int step = 1 + data[0] % 40;
        if ((size_t)is.width * (size_t)is.height > 1 << 16) continue;
        float *out = wr_alloc((size_t)is.width * (size_t)is.channels * (size_t)step, sizeof *out);
        for (int y = 0; y < is.height; y += step)
            wr_exr_codec.read(reader, i, y, is.height - y < step ? is.height - y : step,
                              is.channels, out, reason);
        wr_free(out);
    }
    if (reader) wr_exr_codec.close(reader);
    wr_fd_close(fd);
    return 0;
}
