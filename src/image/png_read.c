/* Reading PNG (png_codec.h). Runs sandboxed in the reader process: the file may be hostile. */
#include "image/png_codec.h"

#include "base/array.h"
#include "base/memory.h"
#include "system/fd.h"

#include <stdio.h>
#include <string.h>

#define BLOCK (1 << 16)
#define ORIENTATION 0x0112 /* the tag of TIFF and Exif */

typedef struct Text {
    char *name, *text; /* owned */
} Text;

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

/* The orientation of an Exif block: a TIFF header and its first directory. 0: none. */
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

/* Reads up to the first row; libpng reports errors by longjmp. */
static bool begin_or_jump(WrCodecReader *reader, char *reason)
{
    if (setjmp(png_jmpbuf(reader->png)))
        return wr_png_report(&reader->trouble, "cannot be opened, truncated or damaged", reason);
    png_set_user_limits(reader->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_benign_errors(reader->png, 1);
    png_set_read_fn(reader->png, reader, take);
    png_read_info(reader->png, reader->info);
    if (!check_size(reader, reason)) return false;
    png_set_expand(reader->png);
    if (wr_png_swaps()) png_set_swap(reader->png);
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
        png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader->trouble, wr_png_fail, wr_png_warn,
                                 &reader->trouble, wr_png_alloc, wr_png_free);
    reader->info = reader->png ? png_create_info_struct(reader->png) : NULL;
    reader->trouble.no_memory |= !reader->info;
    if (!reader->info) return wr_png_report(&reader->trouble, "", reason);
    return begin_or_jump(reader, reason);
}

WrCodecReader *wr_png_open(int fd, const char *format, int most, bool numbers, char *reason)
{
    (void)format;
    (void)most;
    (void)numbers; /* PNG has no tag that says so */
    WrCodecReader *reader = wr_alloc(1, sizeof *reader);
    reader->fd = fd;
    reader->block = wr_alloc(BLOCK, 1);
    if (begin(reader, reason)) {
        describe(reader);
        keep_texts(reader);
        return reader;
    }
    wr_png_close(reader);
    return NULL;
}

void wr_png_close(WrCodecReader *reader)
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

int wr_png_parts(const WrCodecReader *reader)
{
    (void)reader;
    return 1;
}

const WrCodecPart *wr_png_part(const WrCodecReader *reader, int part)
{
    (void)part;
    return &reader->part;
}

const char *wr_png_attribute(const WrCodecReader *reader, int part, const char *name)
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
    if (setjmp(png_jmpbuf(reader->png))) return wr_png_report(&reader->trouble, "", reason);
    for (int i = 0; i < rows; i++)
        divide(reader, codes_of(reader, y + i), channels, out + (size_t)i * row);
    return true;
}

bool wr_png_read(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                 char *reason)
{
    (void)part;
    if (!reader->interlaced && y < reader->next && !begin(reader, reason)) return false;
    return make_codes(reader, reason) && read_or_jump(reader, y, rows, channels, out, reason);
}
