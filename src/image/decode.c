#include "image/decode.h"

#include "base/error.h"
#include "base/memory.h"
#include "image/codec.h"
#include "image/format.h"
#include "image/simple_formats.h"
#include "image/png.h"
#include "system/fd.h"

#include <errno.h>
#include <string.h>

/* One of two decoders: a library's, or simple_formats.h's. */
struct WrDecoder {
    const WrCodec *library;
    WrCodecReader *reader;
    WrPlain *plain;
};

/* The format by the file's first bytes, else by its extension; "plain" for formats of simple_formats.h. */
static const char *format_of(const unsigned char *bytes, size_t count, const char *ending)
{
    const char *format = wr_image_sniff(bytes, count);
    if (wr_plain_knows(bytes, count, format ? "" : ending)) return "plain";
    return format ? format : ending;
}

bool wr_decoder_takes_module(int fd, const char *ending)
{
    unsigned char bytes[WR_IMAGE_SNIFF];
    const int64_t count = wr_fd_read_at(fd, bytes, sizeof bytes, 0);
    const char *format = format_of(bytes, count > 0 ? (size_t)count : 0, ending);
    return strcmp(format, "plain") != 0 && wr_codec_takes_module(format);
}

static const char *find_format(int fd, const char *ending, WrError *err)
{
    int copy = wr_fd_copy(fd);
    FILE *file = copy < 0 ? NULL : wr_fd_stream(copy, "rb");
    if (!file) {
        wr_fail(err, "%s", strerror(errno));
        if (copy >= 0) wr_fd_close(copy);
        return NULL;
    }
    unsigned char bytes[WR_IMAGE_SNIFF];
    rewind(file);
    size_t count = fread(bytes, 1, sizeof bytes, file);
    const char *format = format_of(bytes, count, ending);
    if (strcmp(format, "png") == 0 && !wr_png_check(file, err)) format = NULL;
    fclose(file);
    return format;
}

static bool is_memory(const char *reason)
{
    return strcmp(reason, WR_CODEC_NO_MEMORY) == 0;
}

WrDecoder *wr_decoder_open(int fd, const char *ending, int most, bool numbers, bool *memory,
                           WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    const char *format = find_format(fd, ending, err);
    if (!format) return NULL;
    if (strcmp(format, "plain") == 0) {
        WrPlain *plain = wr_plain_open(fd, memory, err);
        WrDecoder *decoder = plain ? wr_alloc(1, sizeof *decoder) : NULL;
        if (decoder) *decoder = (WrDecoder){ .plain = plain };
        return decoder;
    }
    const WrCodec *library = wr_codec(format, err);
    if (!library) return NULL;
    WrCodecReader *reader = library->open(fd, format, most, numbers, reason);
    if (!reader) {
        if (memory) *memory = is_memory(reason);
        wr_fail(err, "%s", reason);
        return NULL;
    }
    WrDecoder *decoder = wr_alloc(1, sizeof *decoder);
    *decoder = (WrDecoder){ .library = library, .reader = reader };
    return decoder;
}

void wr_decoder_close(WrDecoder *decoder)
{
    if (!decoder) return;
    if (decoder->library) decoder->library->close(decoder->reader);
    wr_plain_close(decoder->plain);
    wr_free(decoder);
}

int wr_decoder_parts(const WrDecoder *decoder)
{
    return decoder->plain ? 1 : decoder->library->parts(decoder->reader);
}

WrImagePart wr_decoder_part(const WrDecoder *decoder, int part)
{
    return decoder->plain ? wr_plain_part(decoder->plain)
                          : decoder->library->part(decoder->reader, part)->part;
}

const char *wr_decoder_attribute(const WrDecoder *decoder, int part, const char *name)
{
    if (decoder->plain) return wr_plain_attribute(decoder->plain, name);
    return decoder->library->attribute(decoder->reader, part, name);
}

bool wr_decoder_read(WrDecoder *decoder, int part, int y, int rows, int channels, float *out,
                     bool *memory, WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    if (decoder->plain) return wr_plain_read(decoder->plain, y, rows, channels, out, err);
    if (decoder->library->read(decoder->reader, part, y, rows, channels, out, reason)) return true;
    if (memory) *memory = is_memory(reason);
    return wr_fail(err, "cannot be read whole, truncated or damaged%s%s%s", *reason ? " (" : "",
                   reason, *reason ? ")" : "");
}

bool wr_decoder_digest(WrDecoder *decoder, int part, int y, int rows, int channels, WrHash *digest,
                       bool *memory, WrError *err)
{
    size_t row = (size_t)wr_decoder_part(decoder, part).width * (size_t)channels;
    int step = rows < WR_IMAGE_STRIP ? rows : WR_IMAGE_STRIP;
    float *strip = wr_try_alloc(row * (size_t)step, sizeof *strip, "rows of a picture", err);
    bool good = strip != NULL;
    if (memory) *memory = !good;
    for (int done = 0; done < rows && good; done += step) {
        int take = rows - done < step ? rows - done : step;
        good = wr_decoder_read(decoder, part, y + done, take, channels, strip, memory, err);
        if (good) wr_digest_strip(digest, strip, row * (size_t)take);
    }
    wr_free(strip);
    return good;
}
