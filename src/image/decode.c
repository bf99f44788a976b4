/* Decoding of image files: simple formats without a library, and the choice of the reader. */
#include "image/decode.h"

#include "base/error.h"
#include "base/memory.h"
#include "image/codec.h"
#include "image/exr.h"
#include "image/format.h"
#include "image/image.h"
#include "image/png.h"
#include "system/fd.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef struct WrPlain WrPlain;

/* NULL is allowed */
static void plain_close(WrPlain *plain);

/* ---- simple formats: an open file ---- */

typedef enum Coding { CODES_8, CODES_16, METRES, DECODED } Coding; /* 16 bits: big-endian */

struct WrPlain {
    FILE *file; /* owned */
    int width, height, channels;
    Coding coding;
    double most;     /* the largest code */
    int64_t data;    /* offset of the pixels */
    uint16_t *codes; /* DECODED: all codes, owned; else NULL */
    uint8_t *row;    /* otherwise: one raw row, owned */
};

static const char *const names[4][4] = {
    { "Y" }, { "Y", "A" }, { "R", "G", "B" }, { "R", "G", "B", "A" }
};

static uint32_t big32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static bool is_pnm(const unsigned char *bytes, size_t count)
{
    return count >= 3 && bytes[0] == 'P' && strchr("12356", bytes[1]) && bytes[1] &&
           (strchr(" \t\r\n#", bytes[2]) && bytes[2]);
}

static bool is_pat(const unsigned char *bytes, size_t count)
{
    return count >= 24 && memcmp(bytes + 20, "GPAT", 4) == 0;
}

static uint32_t little32(const uint8_t *p)
{
    return (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

/* True for a Windows bitmap with compression 1 (RLE8) or 2 (RLE4). */
static bool is_rle_bmp(const unsigned char *bytes, size_t count)
{
    return count >= 34 && bytes[0] == 'B' && bytes[1] == 'M' && little32(bytes + 14) >= 40 &&
           (little32(bytes + 30) == 1 || little32(bytes + 30) == 2);
}

/* True if a file is one of these formats, by its first bytes or else by its extension. */
static bool plain_knows(const unsigned char *bytes, size_t count, const char *ending)
{
    return is_pnm(bytes, count) || is_pat(bytes, count) || is_rle_bmp(bytes, count) ||
           strcmp(ending, "hgt") == 0;
}

static bool check_size(uint32_t width, uint32_t height, WrError *err)
{
    if (width >= 1 && width <= WR_IMAGE_MAX && height >= 1 && height <= WR_IMAGE_MAX) return true;
    return wr_fail(err, "picture of %ux%u: each side must be 1..%d", width, height, WR_IMAGE_MAX);
}

static bool truncated(WrError *err)
{
    return wr_fail(err,
                   "cannot be opened, truncated or damaged (it is shorter than its header says)");
}

/* ---- simple formats: PNM ---- */

/* "P5", width, height, the largest code, one white space; comments from # to the line's end. */

static int next_letter(FILE *file)
{
    int c = getc(file);
    while (c == '#') {
        while (c != EOF && c != '\n' && c != '\r') c = getc(file);
    }
    return c;
}

static int skip_space(FILE *file)
{
    int c = next_letter(file);
    while (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f')
        c = next_letter(file);
    return c;
}

/* The next number, up to about 65535; consumes the letter after it. */
static bool read_number(FILE *file, uint32_t *number)
{
    int c = skip_space(file);
    if (c < '0' || c > '9') return false;
    for (*number = 0; c >= '0' && c <= '9'; c = getc(file)) {
        *number = *number * 10 + (uint32_t)(c - '0');
        if (*number > 1000000) return false;
    }
    if (c == '#') ungetc(c, file);
    return true;
}

/* A pixel of P1, white space before it is optional; 1 is black. */
static bool read_bit(FILE *file, uint32_t *code)
{
    const int c = skip_space(file);
    *code = c == '0';
    return c == '0' || c == '1';
}

static bool read_text(WrPlain *p, bool bits, int64_t length, WrError *err)
{
    const size_t count = (size_t)p->width * (size_t)p->height * (size_t)p->channels;
    /* A pixel of P1 has at least one byte, one of P2 and P3 two, a digit and a blank. */
    if ((uint64_t)length < (bits ? (uint64_t)count : 2 * (uint64_t)count - 1))
        return truncated(err); /* before memory is allocated */
    p->codes = wr_try_alloc(count, sizeof *p->codes, "a picture", err);
    for (size_t k = 0; p->codes && k < count; k++) {
        uint32_t code;
        if (!(bits ? read_bit : read_number)(p->file, &code)) return truncated(err);
        p->codes[k] = (uint16_t)(code < p->most ? code : p->most);
    }
    return p->codes != NULL;
}

static bool open_pnm(WrPlain *p, int64_t length, WrError *err)
{
    uint32_t width, height, most = 1;
    getc(p->file);
    const int kind = getc(p->file);
    if (!read_number(p->file, &width) || !read_number(p->file, &height) ||
        (kind != '1' && !read_number(p->file, &most)))
        return wr_fail(err, "cannot be opened, truncated or damaged (its header)");
    if (!check_size(width, height, err)) return false;
    if (most < 1 || most > 65535) return wr_fail(err, "largest code %u: must be 1..65535", most);
    p->width = (int)width, p->height = (int)height, p->most = most;
    p->channels = kind == '3' || kind == '6' ? 3 : 1;
    p->coding = kind <= '3' ? DECODED : most > 255 ? CODES_16 : CODES_8;
    p->data = wr_stream_position(p->file);
    return p->coding != DECODED || read_text(p, kind == '1', length, err);
}

/* ---- .pat: big-endian numbers of 32 bits: length of the header, version 1, width, height, bytes a pixel,
   "GPAT", a name to the header's end; then the pixels, the top row first ---- */

static bool open_pat(WrPlain *p, const unsigned char *bytes, WrError *err)
{
    const uint32_t header = big32(bytes), version = big32(bytes + 4);
    const uint32_t width = big32(bytes + 8), height = big32(bytes + 12),
                   channels = big32(bytes + 16);
    if (version != 1) return wr_fail(err, "GIMP pattern of version %u: must be 1", version);
    if (header < 24 || header > 65536)
        return wr_fail(err, "GIMP pattern with a header of %u bytes: must be 24..65536", header);
    if (channels < 1 || channels > 4)
        return wr_fail(err, "GIMP pattern of %u bytes a pixel: must be 1..4", channels);
    if (!check_size(width, height, err)) return false;
    p->width = (int)width, p->height = (int)height, p->channels = (int)channels;
    p->coding = CODES_8;
    p->most = 255;
    p->data = header;
    return true;
}

/* ---- .hgt: only metres, signed 16 bits, from the north-west eastwards ---- */

static bool open_hgt(WrPlain *p, int64_t length, WrError *err)
{
    /* SRTM tiles cover one degree with a sample on both borders: 3 or 1 arc seconds apart. */
    static const int sides[] = { 1201, 3601 };
    for (int k = 0; k < 2; k++)
        if (length == (int64_t)2 * sides[k] * sides[k]) p->width = p->height = sides[k];
    if (p->width == 0)
        return wr_fail(err,
                       "elevations (.hgt) of %lld bytes: must be 1201x1201 or 3601x3601 "
                       "numbers of 2 bytes",
                       (long long)length);
    p->channels = 1;
    p->coding = METRES;
    return true;
}

/* ---- run-length BMP: file header (14 bytes), info header (40 or more), palette of blue, green, red,
   0; then pairs of a count and a palette index, rows upwards. After a count of 0 follows 0: end of
   line, 1: end of the bitmap, 2: a step right and up, 3 or more: this many indices, padded to 2 bytes.
   RLE4 stores two indices per byte, the high half first. ---- */

typedef struct Rle {
    FILE *file;
    bool halves;             /* RLE4 */
    uint8_t palette[256][3]; /* red, green, blue */
    int width, height, x, y; /* y from the bottom */
    uint16_t *codes;         /* [height][width][3], the top row first */
} Rle;

static void put_index(Rle *rle, unsigned index)
{
    if (rle->x >= rle->width || rle->y >= rle->height) return; /* clipped, as in other readers */
    uint16_t *to = rle->codes +
                   3 * ((size_t)(rle->height - 1 - rle->y) * (size_t)rle->width + (size_t)rle->x++);
    for (int c = 0; c < 3; c++) to[c] = rle->palette[index][c];
}

static void put_run(Rle *rle, int count, int value)
{
    for (int k = 0; k < count; k++)
        put_index(rle, !rle->halves ? (unsigned)value
                       : k % 2 == 0 ? (unsigned)value >> 4
                                    : (unsigned)value & 15);
}

static bool put_literal(Rle *rle, int count)
{
    const int bytes = rle->halves ? (count + 1) / 2 : count;
    for (int k = 0; k < bytes; k++) {
        const int value = getc(rle->file);
        if (value == EOF) return false;
        put_run(rle, !rle->halves ? 1 : count - 2 * k < 2 ? 1 : 2, value);
    }
    return bytes % 2 == 0 || getc(rle->file) != EOF;
}

/* Pixels without a run have index 0. A file may lack an end mark. */
static bool decode_rle(Rle *rle)
{
    for (int count = getc(rle->file); count != EOF; count = getc(rle->file)) {
        const int second = getc(rle->file);
        if (second == EOF) return false;
        if (count > 0) {
            put_run(rle, count, second);
        } else if (second == 0) {
            rle->x = 0;
            if (rle->y < rle->height) rle->y++;
        } else if (second == 1) {
            return true;
        } else if (second == 2) {
            const int right = getc(rle->file), up = getc(rle->file);
            if (up == EOF) return false;
            rle->x += rle->x < rle->width ? right : 0;
            rle->y += rle->y < rle->height ? up : 0;
        } else if (!put_literal(rle, second)) {
            return false;
        }
    }
    return rle->y >= rle->height || (rle->y == rle->height - 1 && rle->x >= rle->width);
}

static bool read_palette(Rle *rle, int64_t at, uint32_t colours)
{
    if (!wr_stream_seek(rle->file, at)) return false;
    for (uint32_t k = 0; k < colours; k++) {
        uint8_t entry[4];
        if (fread(entry, 1, 4, rle->file) != 4) return false;
        for (int c = 0; c < 3; c++) rle->palette[k][c] = entry[2 - c];
    }
    return true;
}

static bool open_rle_bmp(WrPlain *p, WrError *err)
{
    uint8_t head[54];
    if (fread(head, 1, sizeof head, p->file) != sizeof head) return truncated(err);
    const uint32_t width = little32(head + 18), height = little32(head + 22),
                   info = little32(head + 14);
    if (!check_size(width, height, err)) return false;
    Rle rle = { .file = p->file,
                .halves = little32(head + 30) == 2,
                .width = (int)width,
                .height = (int)height };
    const uint32_t most = rle.halves ? 16 : 256, used = little32(head + 46);
    if (used > most || info > 1024)
        return wr_fail(err, "a BMP palette of %u colours: must be 0..%u", used, most);
    p->codes = wr_try_alloc((size_t)3 * width * height, sizeof *p->codes, "a picture", err);
    if (!p->codes) return false;
    memset(p->codes, 0, (size_t)3 * width * height * sizeof *p->codes);
    rle.codes = p->codes;
    if (!read_palette(&rle, 14 + (int64_t)info, used ? used : most)) return truncated(err);
    for (size_t k = 0; k < (size_t)width * height; k++)
        for (int c = 0; c < 3; c++) p->codes[3 * k + (size_t)c] = rle.palette[0][c];
    p->width = rle.width, p->height = rle.height, p->channels = 3;
    p->coding = DECODED, p->most = 255;
    if (!wr_stream_seek(p->file, (int64_t)little32(head + 10)) || !decode_rle(&rle))
        return truncated(err);
    return true;
}

/* ---- all simple formats ---- */

static size_t row_bytes(const WrPlain *p)
{
    return (size_t)p->width * (size_t)p->channels * (p->coding == CODES_8 ? 1 : 2);
}

static bool open_any(WrPlain *p, bool *memory, WrError *err)
{
    unsigned char bytes[WR_IMAGE_SNIFF];
    WrFileInfo info;
    if (!wr_stream_seek(p->file, 0) || !wr_stream_info(p->file, &info))
        return wr_fail(err, "%s", strerror(errno));
    const size_t count = fread(bytes, 1, sizeof bytes, p->file);
    if (!wr_stream_seek(p->file, 0)) return wr_fail(err, "%s", strerror(errno));
    if (!(is_pnm(bytes, count)       ? open_pnm(p, info.bytes, err)
          : is_pat(bytes, count)     ? open_pat(p, bytes, err)
          : is_rle_bmp(bytes, count) ? open_rle_bmp(p, err)
                                     : open_hgt(p, info.bytes, err)))
        return false;
    if (p->coding == DECODED) return true;
    if ((uint64_t)(info.bytes - p->data) < (uint64_t)row_bytes(p) * (uint64_t)p->height)
        return truncated(err);
    p->row = wr_try_alloc(row_bytes(p), 1, "a row", err);
    if (!p->row && memory) *memory = true;
    return p->row != NULL;
}

/* fd: open for reading, borrowed for the call. Errors: one sentence that does not name the file. */
static WrPlain *plain_open(int fd, bool *memory, WrError *err)
{
    const int copy = wr_fd_copy(fd);
    FILE *file = copy < 0 ? NULL : wr_fd_stream(copy, "rb");
    if (!file) {
        wr_fail(err, "%s", strerror(errno));
        if (copy >= 0) wr_fd_close(copy);
        return NULL;
    }
    WrPlain *plain = wr_alloc(1, sizeof *plain);
    *plain = (WrPlain){ .file = file };
    if (open_any(plain, memory, err)) return plain;
    plain_close(plain);
    return NULL;
}

static void plain_close(WrPlain *plain)
{
    if (!plain) return;
    fclose(plain->file);
    wr_free(plain->codes);
    wr_free(plain->row);
    wr_free(plain);
}

static WrImagePart plain_part(const WrPlain *p)
{
    const WrPixelType type = p->coding == METRES ? WR_PIXEL_F32
                             : p->most > 255     ? WR_PIXEL_U16
                                                 : WR_PIXEL_U8;
    return (WrImagePart){ .name = "",
                          .width = p->width,
                          .height = p->height,
                          .channels = p->channels,
                          .type = type,
                          .channel_names = names[p->channels - 1] };
}

/* "wrinkle:no-data" if NaN marks missing values; else NULL. */
static const char *plain_attribute(const WrPlain *p, const char *name)
{
    return p->coding == METRES && strcmp(name, "wrinkle:no-data") == 0 ? "1" : NULL;
}

/* SRTM's value for missing elevations. */
#define VOID_METRES (-32768)

static float value_of(const WrPlain *p, size_t at, int y)
{
    const uint8_t *two = p->row + 2 * at;
    if (p->coding == DECODED)
        return (float)p->codes[(size_t)y * (size_t)p->width * (size_t)p->channels + at] /
               (float)p->most;
    if (p->coding == CODES_8) return p->row[at] < p->most ? p->row[at] / (float)p->most : 1.0f;
    const int code = two[0] << 8 | two[1];
    if (p->coding == CODES_16) return code < p->most ? (float)code / (float)p->most : 1.0f;
    const int metres = code < 32768 ? code : code - 65536;
    return metres == VOID_METRES ? NAN : (float)metres;
}

/* Reads rows and the first `channels` channels as in WrImage. Missing elevations are NaN. */
static bool plain_read(WrPlain *p, int y, int rows, int channels, float *out, WrError *err)
{
    for (int j = y; j < y + rows; j++) {
        if (p->coding != DECODED &&
            (!wr_stream_seek(p->file, p->data + (int64_t)row_bytes(p) * j) ||
             fread(p->row, 1, row_bytes(p), p->file) != row_bytes(p)))
            return wr_fail(err, "is truncated or damaged");
        for (int i = 0; i < p->width; i++)
            for (int c = 0; c < channels; c++)
                *out++ = value_of(p, (size_t)i * (size_t)p->channels + (size_t)c, j);
    }
    return true;
}

/* ---- the choice of the reader ---- */

/* One of two decoders: a library's, or decode.c's. */
struct WrDecoder {
    const WrCodec *library;
    WrCodecReader *reader;
    WrPlain *plain;
};

/* The format by the file's first bytes, else by its extension; "plain" for formats of decode.c. */
static const char *format_of(const unsigned char *bytes, size_t count, const char *ending)
{
    const char *format = wr_image_sniff(bytes, count);
    if (plain_knows(bytes, count, format ? "" : ending)) return "plain";
    return format ? format : ending;
}

bool wr_decoder_takes_module(int fd, const char *ending)
{
    unsigned char bytes[WR_IMAGE_SNIFF];
    const int64_t count = wr_fd_read_at(fd, bytes, sizeof bytes, 0);
    const char *format = format_of(bytes, count > 0 ? (size_t)count : 0, ending);
    return strcmp(format, "plain") != 0 && strcmp(format, "openexr") != 0 &&
           wr_codec_takes_module(format);
}

bool wr_decoder_lacks_module(int fd, int most)
{
    unsigned char bytes[WR_IMAGE_SNIFF];
    char reason[WR_CODEC_REASON];
    const int64_t count = wr_fd_read_at(fd, bytes, sizeof bytes, 0);
    const char *format = wr_image_sniff(bytes, count > 0 ? (size_t)count : 0);
    if (!format || strcmp(format, "openexr") != 0) return false;
    WrCodecReader *reader = wr_exr_codec.open(fd, format, most, false, reason);
    if (reader) wr_exr_codec.close(reader);
    return !reader;
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
    size_t count = fseek(file, 0, SEEK_SET) == 0 ? fread(bytes, 1, sizeof bytes, file) : 0;
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
        WrPlain *plain = plain_open(fd, memory, err);
        WrDecoder *decoder = plain ? wr_alloc(1, sizeof *decoder) : NULL;
        if (decoder) *decoder = (WrDecoder){ .plain = plain };
        return decoder;
    }
    const WrCodec *library = &wr_exr_codec;
    WrCodecReader *reader = NULL;
    if (strcmp(format, "openexr") == 0) reader = library->open(fd, format, most, numbers, reason);
    if (!reader) {
        library = wr_codec(format, err);
        if (!library) return NULL;
        reader = library->open(fd, format, most, numbers, reason);
    }
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
    plain_close(decoder->plain);
    wr_free(decoder);
}

int wr_decoder_parts(const WrDecoder *decoder)
{
    return decoder->plain ? 1 : decoder->library->parts(decoder->reader);
}

WrImagePart wr_decoder_part(const WrDecoder *decoder, int part)
{
    return decoder->plain ? plain_part(decoder->plain)
                          : decoder->library->part(decoder->reader, part)->part;
}

const char *wr_decoder_attribute(const WrDecoder *decoder, int part, const char *name)
{
    if (decoder->plain) return plain_attribute(decoder->plain, name);
    return decoder->library->attribute(decoder->reader, part, name);
}

bool wr_decoder_read(WrDecoder *decoder, int part, int y, int rows, int channels, float *out,
                     bool *memory, WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    if (decoder->plain) return plain_read(decoder->plain, y, rows, channels, out, err);
    if (decoder->library->read(decoder->reader, part, y, rows, channels, out, reason)) return true;
    if (memory) *memory = is_memory(reason);
    return wr_fail(err, "is truncated or damaged%s%s%s", *reason ? " (" : "", reason,
                   *reason ? ")" : "");
}

bool wr_decoder_hash_rows(WrDecoder *decoder, int part, int y, int rows, int channels,
                          WrHash *digest, bool *memory, WrError *err)
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
