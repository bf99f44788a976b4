/* PNG by libpng: integrity check, reading, writing. */
#include "image/png.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/oiio.h"
#include "image/png_stream.h"
#include "system/fd.h"

#include <errno.h>
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- integrity check ---- */

static uint32_t big_endian(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Checks one chunk: length, four letters, data, CRC-32 of letters and data. */
static bool check_chunk(FILE *file, char name[5], WrError *err)
{
    unsigned char head[8], tail[4], block[16384];
    if (fread(head, 1, sizeof head, file) != sizeof head)
        return wr_fail(err, "truncated: the PNG file ends without its last chunk");
    uint32_t length = big_endian(head);
    memcpy(name, head + 4, 4);
    name[4] = '\0';
    for (int i = 0; i < 4; i++)
        if (!((name[i] >= 'a' && name[i] <= 'z') || (name[i] >= 'A' && name[i] <= 'Z')))
            return wr_fail(err, "damaged: a PNG chunk has an impossible name");
    if (length > 0x7fffffffU)
        return wr_fail(err, "damaged: PNG chunk %s of %u bytes", name, length);
    uLong crc = crc32(0, head + 4, 4);
    while (length > 0) {
        size_t want = length < sizeof block ? length : sizeof block;
        if (fread(block, 1, want, file) != want)
            return wr_fail(err, "truncated: the file ends inside PNG chunk %s", name);
        crc = crc32(crc, block, (uInt)want);
        length -= (uint32_t)want;
    }
    if (fread(tail, 1, sizeof tail, file) != sizeof tail)
        return wr_fail(err, "truncated: the file ends inside PNG chunk %s", name);
    if (big_endian(tail) != crc)
        return wr_fail(err, "damaged: the checksum of PNG chunk %s is wrong", name);
    return true;
}

/* libpng reports damage only when it reaches it, after rows were delivered; checking all chunks first costs one pass over the
   compressed bytes. 8: the signature. */
bool wr_png_check(FILE *file, WrError *err)
{
    char name[5] = "";
    if (fseek(file, 8, SEEK_SET) != 0) return wr_fail(err, "cannot be read");
    while (strcmp(name, "IEND") != 0)
        if (!check_chunk(file, name, err)) return false;
    return true;
}

/* ---- errors and memory of libpng ---- */

/* Error and memory callbacks of libpng; png_get_error_ptr and png_get_mem_ptr point to this. */
typedef struct WrPngTrouble {
    char why[160];  /* the first error, on one line */
    bool no_memory; /* the error was lack of memory */
} WrPngTrouble;

static void on_failure(png_structp png, png_const_charp why)
{
    WrPngTrouble *trouble = png_get_error_ptr(png);
    if (!trouble->why[0]) snprintf(trouble->why, sizeof trouble->why, "%s", why);
    png_longjmp(png, 1);
}

/* ignores warnings */
static void on_warning(png_structp png, png_const_charp why)
{
    (void)png;
    (void)why;
}

static png_voidp take_memory(png_structp png, png_alloc_size_t bytes)
{
    WrPngTrouble *trouble = png_get_mem_ptr(png);
    void *memory = malloc(bytes);
    if (!memory) trouble->no_memory = true;
    return memory;
}

static void release_memory(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

/* 16-bit codes have the other byte order in files */
static bool swaps(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* Always false; the reason is WR_CODEC_NO_MEMORY, or "before (why)". */
static bool report_trouble(const WrPngTrouble *trouble, const char *before, char *reason)
{
    if (trouble->no_memory) snprintf(reason, WR_CODEC_REASON, "%s", WR_CODEC_NO_MEMORY);
    else if (!*before) snprintf(reason, WR_CODEC_REASON, "%s", trouble->why);
    else snprintf(reason, WR_CODEC_REASON, "%s (%s)", before, trouble->why);
    return false;
}

/* ---- reading ---- */

/* Reading PNG (png.h). Runs sandboxed in the reader process: the file may be hostile. */

#define BLOCK (1 << 16)
#define ORIENTATION 0x0112 /* the tag of TIFF and Exif */

typedef struct Text {
    char *name, *text; /* owned */
} Text;

/* libpng pulls bytes from `take` and delivers rows in order; codes hold one row, or all rows of an interlaced picture. */
struct WrCodecReader {
    int fd;
    int64_t at; /* bytes of the file read into the block so far */
    uint8_t *block;
    size_t held, taken; /* bytes in the block, and those already passed to libpng */
    WrPngTrouble trouble;
    png_structp png;
    png_infop info;
    WrCodecPart part;
    WR_ARRAY(Text) texts;
    int next;       /* next row */
    uint8_t *codes; /* codes of one row; of an interlaced image all rows */
    bool interlaced;
};

/* ---- the file ---- */

static void take(png_structp png, png_bytep bytes, size_t count)
{
    WrCodecReader *reader = png_get_io_ptr(png);
    for (size_t done = 0; done < count;) {
        if (reader->taken == reader->held) {
            const int64_t n = wr_fd_read_at(reader->fd, reader->block, BLOCK, reader->at);
            if (n <= 0) png_error(png, "the file ends too early");
            reader->at += n;
            reader->held = (size_t)n;
            reader->taken = 0;
        }
        size_t some = reader->held - reader->taken;
        if (some > count - done) some = count - done;
        memcpy(bytes + done, reader->block + reader->taken, some);
        reader->taken += some;
        done += some;
    }
}

/* ---- text attributes ---- */

static void keep_text(WrCodecReader *reader, const char *name, size_t name_length, const char *text,
                      size_t length)
{
    for (int i = 0; i < reader->texts.count; i++)
        if (strlen(reader->texts.data[i].name) == name_length &&
            memcmp(reader->texts.data[i].name, name, name_length) == 0)
            return; /* the first one wins */
    const Text kept = { wr_strndup(name, name_length), wr_strndup(text, length) };
    wr_array_push(&reader->texts, kept);
}

/* The program's attributes are lines name=text of the description. */
static void keep_lines(WrCodecReader *reader, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, "\n"), equals = strcspn(text, "=\n");
        if (equals < length && strncmp(text, "wrinkle:", 8) == 0)
            keep_text(reader, text, equals, text + equals + 1, length - equals - 1);
        text += length + (text[length] == '\n');
    }
}

static unsigned number(const uint8_t *bytes, int count, bool big)
{
    unsigned value = 0;
    for (int i = 0; i < count; i++) value = value << 8 | bytes[big ? i : count - 1 - i];
    return value;
}

/* The orientation of an Exif block: a TIFF header and its first directory. 0: none. TIFF: "MM" or "II", 42, offset of the
   directory; a directory is a 16-bit count, then entries of 12 bytes: tag, type, count, value. */
static unsigned orientation_of(const uint8_t *exif, size_t length)
{
    if (length < 8 || exif[0] != exif[1] || (exif[0] != 'M' && exif[0] != 'I')) return 0;
    const bool big = exif[0] == 'M';
    const size_t start = number(exif + 4, 4, big);
    if (start > length - 2 || length - start < 2) return 0;
    const size_t entries = number(exif + start, 2, big);
    for (size_t i = 0; i < entries && start + 2 + 12 * (i + 1) <= length; i++) {
        const uint8_t *entry = exif + start + 2 + 12 * i;
        if (number(entry, 2, big) == ORIENTATION) return number(entry + 8, 2, big);
    }
    return 0;
}

static void keep_texts(WrCodecReader *reader)
{
    png_textp texts = NULL;
    png_bytep exif = NULL;
    png_uint_32 length = 0;
    char words[16];
    const int count = png_get_text(reader->png, reader->info, &texts, NULL);
    if (!png_get_eXIf_1(reader->png, reader->info, &length, &exif)) length = 0;
    snprintf(words, sizeof words, "%u", orientation_of(exif, length));
    keep_text(reader, "wrinkle:orientation", 19, words, strlen(words));
    for (int i = 0; i < count; i++)
        if (strcmp(texts[i].key, "Description") == 0) keep_lines(reader, texts[i].text);
}

static bool check_size(const WrCodecReader *reader, char *reason)
{
    const unsigned width = png_get_image_width(reader->png, reader->info);
    const unsigned height = png_get_image_height(reader->png, reader->info);
    if (width <= WR_IMAGE_MAX && height <= WR_IMAGE_MAX) return true;
    snprintf(reason, WR_CODEC_REASON, "picture of %ux%u: each side must be 1..%d", width, height,
             WR_IMAGE_MAX);
    return false;
}

static void describe(WrCodecReader *reader)
{
    static const char *const names[4][4] = {
        { "Y" }, { "Y", "A" }, { "R", "G", "B" }, { "R", "G", "B", "A" }
    };
    const int channels = png_get_channels(reader->png, reader->info);
    const bool wide = png_get_bit_depth(reader->png, reader->info) == 16;
    reader->part = (WrCodecPart){
        .part = { .name = "",
                  .width = (int)png_get_image_width(reader->png, reader->info),
                  .height = (int)png_get_image_height(reader->png, reader->info),
                  .channels = channels,
                  .channel_names = names[channels - 1],
                  .type = wide ? WR_PIXEL_U16 : WR_PIXEL_U8 },
        .divisor = wide ? 65535 : 255,
    };
}

/* ---- beginning ---- */

static void end(WrCodecReader *reader)
{
    png_destroy_read_struct(&reader->png, &reader->info, NULL);
    wr_free(reader->codes);
    reader->codes = NULL;
}

/* Reads up to the first row; libpng reports errors by longjmp. Functions NAME_or_jump hold setjmp: no variable of theirs is
   changed after it, since such values are undefined after a jump. */
static bool begin_or_jump(WrCodecReader *reader, char *reason)
{
    if (setjmp(png_jmpbuf(reader->png)))
        return report_trouble(&reader->trouble, "cannot be opened, truncated or damaged", reason);
    png_set_user_limits(reader->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_benign_errors(reader->png, 1);
    png_set_read_fn(reader->png, reader, take);
    png_read_info(reader->png, reader->info);
    if (!check_size(reader, reason)) return false;
    png_set_expand(reader->png);
    if (swaps()) png_set_swap(reader->png);
    reader->interlaced = png_set_interlace_handling(reader->png) > 1;
    png_read_update_info(reader->png, reader->info);
    return true;
}

static bool begin(WrCodecReader *reader, char *reason)
{
    end(reader);
    reader->at = 0;
    reader->held = reader->taken = 0;
    reader->next = 0;
    reader->png =
        png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader->trouble, on_failure, on_warning,
                                 &reader->trouble, take_memory, release_memory);
    reader->info = reader->png ? png_create_info_struct(reader->png) : NULL;
    reader->trouble.no_memory |= !reader->info;
    if (!reader->info) return report_trouble(&reader->trouble, "", reason);
    return begin_or_jump(reader, reason);
}

static void png_close(WrCodecReader *reader)
{
    end(reader);
    for (int i = 0; i < reader->texts.count; i++) {
        wr_free(reader->texts.data[i].name);
        wr_free(reader->texts.data[i].text);
    }
    wr_array_free(&reader->texts);
    wr_free(reader->block);
    wr_free(reader);
}

static WrCodecReader *png_open(int fd, const char *format, int most, bool numbers, char *reason)
{
    (void)format;
    (void)most;
    (void)numbers; /* PNG has no tag for it */
    WrCodecReader *reader = wr_alloc(1, sizeof *reader);
    reader->fd = fd;
    reader->block = wr_alloc(BLOCK, 1);
    if (begin(reader, reason)) {
        describe(reader);
        keep_texts(reader);
        return reader;
    }
    png_close(reader);
    return NULL;
}

static int png_parts(const WrCodecReader *reader)
{
    (void)reader;
    return 1;
}

static const WrCodecPart *png_part(const WrCodecReader *reader, int part)
{
    (void)part;
    return &reader->part;
}

static const char *png_attribute(const WrCodecReader *reader, int part, const char *name)
{
    (void)part;
    for (int i = 0; i < reader->texts.count; i++)
        if (strcmp(reader->texts.data[i].name, name) == 0) return reader->texts.data[i].text;
    return NULL;
}

/* ---- rows ---- */

static size_t row_bytes(const WrCodecReader *reader)
{
    return png_get_rowbytes(reader->png, reader->info);
}

/* Allocates a row, or all of an interlaced image, whose rows come in seven passes. */
static bool make_codes(WrCodecReader *reader, char *reason)
{
    const size_t rows = reader->interlaced ? (size_t)reader->part.part.height : 1;
    if (!reader->codes)
        reader->codes = wr_try_alloc(rows, row_bytes(reader), "rows of a picture", NULL);
    if (!reader->codes) snprintf(reason, WR_CODEC_REASON, "%s", WR_CODEC_NO_MEMORY);
    return reader->codes != NULL;
}

static void read_passes(WrCodecReader *reader)
{
    const int passes = png_set_interlace_handling(reader->png), height = reader->part.part.height;
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < height; y++)
            png_read_row(reader->png, reader->codes + (size_t)y * row_bytes(reader), NULL);
}

/* The codes of row y, which is not above the next one. */
static const uint8_t *codes_of(WrCodecReader *reader, int y)
{
    if (reader->interlaced) {
        if (reader->next == 0) read_passes(reader);
        reader->next = reader->part.part.height;
        return reader->codes + (size_t)y * row_bytes(reader);
    }
    for (; reader->next <= y; reader->next++) png_read_row(reader->png, reader->codes, NULL);
    return reader->codes;
}

static void divide(const WrCodecReader *reader, const uint8_t *codes, int channels, float *out)
{
    const int all = reader->part.part.channels;
    const uint16_t *wide = (const uint16_t *)(const void *)codes;
    const bool is_wide = reader->part.part.type == WR_PIXEL_U16;
    for (int x = 0; x < reader->part.part.width; x++)
        for (int c = 0; c < channels; c++)
            *out++ =
                is_wide ? (float)wide[x * all + c] / 65535.0f : (float)codes[x * all + c] / 255.0f;
}

static bool read_or_jump(WrCodecReader *reader, int y, int rows, int channels, float *out,
                         char *reason)
{
    const size_t row = (size_t)reader->part.part.width * (size_t)channels;
    if (setjmp(png_jmpbuf(reader->png))) return report_trouble(&reader->trouble, "", reason);
    for (int i = 0; i < rows; i++)
        divide(reader, codes_of(reader, y + i), channels, out + (size_t)i * row);
    return true;
}

static bool png_read(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                     char *reason)
{
    (void)part;
    /* Rows come in order; a request for an earlier one decodes the file again from the start. */
    if (!reader->interlaced && y < reader->next && !begin(reader, reason)) return false;
    return make_codes(reader, reason) && read_or_jump(reader, y, rows, channels, out, reason);
}

/* ---- writing ---- */

struct WrCodecWriter {
    WrByteSink sink;
    int64_t at; /* bytes written so far */
    int error;  /* errno of the write that failed */
    uint8_t *block;
    size_t held;
    WrPngTrouble trouble;
    png_structp png;
    png_infop info;
    WrPngStream *stream;
    size_t row; /* bytes */
};

/* ---- the file ---- */

static void empty(WrCodecWriter *writer)
{
    const WrByteSink *to = &writer->sink;
    if (writer->held > 0 && !to->write(to->to, writer->block, writer->held, writer->at)) {
        writer->error = errno;
        png_error(writer->png, "the file cannot be written");
    }
    writer->at += (int64_t)writer->held;
    writer->held = 0;
}

static void put(png_structp png, png_bytep bytes, size_t count)
{
    WrCodecWriter *writer = png_get_io_ptr(png);
    for (size_t done = 0; done < count;) {
        if (writer->held == BLOCK) empty(writer);
        size_t some = BLOCK - writer->held;
        if (some > count - done) some = count - done;
        memcpy(writer->block + writer->held, bytes + done, some);
        writer->held += some;
        done += some;
    }
}

static void flush(png_structp png)
{
    (void)png; /* everything is flushed at the end */
}

static bool tell(const WrCodecWriter *writer, char *reason)
{
    if (!writer->error) return report_trouble(&writer->trouble, "", reason);
    snprintf(reason, WR_CODEC_REASON, "%s", strerror(writer->error));
    return false;
}

/* ---- metadata ---- */

/* Colours are declared as sRGB, or by their profile. Numbers are not declared: a gAMA of 1, which would
   be true, would make ImageMagick, browsers and others change them on conversion or display. */
static void tag_colours(const WrCodecWriter *writer, const WrImageOut *part)
{
    if (part->profile)
        png_set_iCCP(writer->png, writer->info, "profile", PNG_COMPRESSION_TYPE_BASE, part->profile,
                     (png_uint_32)part->profile_size);
    else if (!part->data)
        png_set_sRGB_gAMA_and_cHRM(writer->png, writer->info, PNG_sRGB_INTENT_ABSOLUTE);
}

static void write_texts(const WrCodecWriter *writer, const char *description)
{
    char key[] = "Description";
    png_text text = { .compression = PNG_TEXT_COMPRESSION_NONE,
                      .key = key,
                      .text = (char *)description,
                      .text_length = strlen(description) };
    if (*description) png_set_text(writer->png, writer->info, &text, 1);
}

static bool begin_file_or_jump(WrCodecWriter *writer, const WrImageOut *part,
                               const char *description, char *reason)
{
    static const int kinds[] = { PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA };
    const bool wide = part->type == WR_PIXEL_U16;
    if (setjmp(png_jmpbuf(writer->png))) return tell(writer, reason);
    png_set_benign_errors(writer->png, 1);
    png_set_write_fn(writer->png, writer, put, flush);
    png_set_IHDR(writer->png, writer->info, (png_uint_32)part->width, (png_uint_32)part->height,
                 wide ? 16 : 8, kinds[part->channels - 1], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    tag_colours(writer, part);
    write_texts(writer, description);
    png_write_info(writer->png, writer->info);
    return true;
}

static void release(WrCodecWriter *writer)
{
    wr_png_stream_free(writer->stream);
    png_destroy_write_struct(&writer->png, &writer->info);
    wr_free(writer->block);
    wr_free(writer);
}

static WrCodecWriter *png_create(const WrByteSink *to, int spool, const char *format,
                                 const WrImageOut *parts, int count, char *reason)
{
    (void)spool;
    (void)format;
    (void)count;
    WrCodecWriter *writer = wr_alloc(1, sizeof *writer);
    WrText description = { 0 };
    writer->sink = *to;
    writer->block = wr_alloc(BLOCK, 1);
    writer->png =
        png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &writer->trouble, on_failure, on_warning,
                                  &writer->trouble, take_memory, release_memory);
    writer->info = writer->png ? png_create_info_struct(writer->png) : NULL;
    const int pixel = parts[0].channels * (parts[0].type == WR_PIXEL_U16 ? 2 : 1);
    writer->row = (size_t)parts[0].width * (size_t)pixel;
    writer->stream = wr_png_stream_new(writer->row, pixel, parts[0].height,
                                       parts[0].type == WR_PIXEL_U16, parts[0].pool);
    writer->trouble.no_memory |= !writer->info || !writer->stream;
    for (int i = 0; i < parts[0].attribute_count; i++)
        wr_text_addf(&description, "%s=%s\n", parts[0].attributes[i].name,
                     parts[0].attributes[i].text);
    const bool good = !writer->trouble.no_memory
                          ? begin_file_or_jump(writer, &parts[0], wr_text_get(&description), reason)
                          : tell(writer, reason);
    wr_text_fini(&description);
    if (good) return writer;
    release(writer);
    return NULL;
}

/* ---- rows ---- */

static void put_chunk(void *ctx, const uint8_t *bytes, size_t count)
{
    const WrCodecWriter *writer = ctx;
    png_write_chunk(writer->png, (png_const_bytep) "IDAT", bytes, count);
}

static bool png_write(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason)
{
    (void)y;
    if (setjmp(png_jmpbuf(writer->png))) return tell(writer, reason);
    writer->trouble.no_memory |=
        !wr_png_stream_add(writer->stream, pixels, rows, put_chunk, writer);
    return !writer->trouble.no_memory || tell(writer, reason);
}

static bool png_next(WrCodecWriter *writer, char *reason)
{
    (void)writer;
    snprintf(reason, WR_CODEC_REASON, "the format holds one part");
    return false;
}

static bool end_or_jump(WrCodecWriter *writer, char *reason)
{
    if (setjmp(png_jmpbuf(writer->png))) return tell(writer, reason);
    png_write_chunk(writer->png, (png_const_bytep) "IEND", NULL, 0);
    empty(writer);
    return true;
}

static bool png_finish(WrCodecWriter *writer, bool keep, char *reason)
{
    const bool good = !keep || end_or_jump(writer, reason);
    release(writer);
    return good;
}

/* ---- the codec ---- */

const WrCodec wr_png_codec = {
    .open = png_open,
    .close = png_close,
    .parts = png_parts,
    .part = png_part,
    .attribute = png_attribute,
    .read = png_read,
    .create = png_create,
    .write = png_write,
    .next = png_next,
    .finish = png_finish,
};

bool wr_codec_takes_module(const char *format)
{
    return strcmp(format, "png") != 0;
}

const WrCodec *wr_codec(const char *format, WrError *err)
{
    return wr_codec_takes_module(format) ? wr_oiio(err) : &wr_png_codec;
}
