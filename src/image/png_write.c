/* Writing PNG (png_codec.h). */
#include "image/png_codec.h"

#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

#define BLOCK (1 << 16)
/* With libpng's default filters: half the time of its default, 6 and Z_FILTERED, for files 2 % larger. */
#define LEVEL 4

struct WrCodecWriter {
    WrByteSink sink;
    int64_t at; /* bytes written so far */
    int error;  /* errno of the write that failed */
    uint8_t *block;
    size_t held;
    WrPngTrouble trouble;
    png_structp png;
    png_infop info;
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
    if (!writer->error) return wr_png_report(&writer->trouble, "", reason);
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

static void describe(const WrCodecWriter *writer, const char *description)
{
    char key[] = "Description";
    png_text text = { .compression = PNG_TEXT_COMPRESSION_NONE,
                      .key = key,
                      .text = (char *)description,
                      .text_length = strlen(description) };
    if (*description) png_set_text(writer->png, writer->info, &text, 1);
}

static bool begin_or_jump(WrCodecWriter *writer, const WrImageOut *part, const char *description,
                          char *reason)
{
    static const int kinds[] = { PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA };
    const bool wide = part->type == WR_PIXEL_U16;
    writer->row = (size_t)part->width * (size_t)part->channels * (wide ? 2 : 1);
    if (setjmp(png_jmpbuf(writer->png))) return tell(writer, reason);
    png_set_benign_errors(writer->png, 1);
    png_set_write_fn(writer->png, writer, put, flush);
    png_set_IHDR(writer->png, writer->info, (png_uint_32)part->width, (png_uint_32)part->height,
                 wide ? 16 : 8, kinds[part->channels - 1], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_compression_level(writer->png, LEVEL);
    png_set_compression_strategy(writer->png, Z_DEFAULT_STRATEGY);
    tag_colours(writer, part);
    describe(writer, description);
    png_write_info(writer->png, writer->info);
    if (wide && wr_png_swaps()) png_set_swap(writer->png);
    return true;
}

static void release(WrCodecWriter *writer)
{
    png_destroy_write_struct(&writer->png, &writer->info);
    wr_free(writer->block);
    wr_free(writer);
}

WrCodecWriter *wr_png_create(const WrByteSink *to, int spool, const char *format,
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
        png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &writer->trouble, wr_png_fail, wr_png_warn,
                                  &writer->trouble, wr_png_alloc, wr_png_free);
    writer->info = writer->png ? png_create_info_struct(writer->png) : NULL;
    writer->trouble.no_memory |= !writer->info;
    for (int i = 0; i < parts[0].attribute_count; i++)
        wr_text_addf(&description, "%s=%s\n", parts[0].attributes[i].name,
                     parts[0].attributes[i].text);
    const bool good = writer->info
                          ? begin_or_jump(writer, &parts[0], wr_text_get(&description), reason)
                          : tell(writer, reason);
    wr_text_fini(&description);
    if (good) return writer;
    release(writer);
    return NULL;
}

/* ---- rows ---- */

bool wr_png_write(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason)
{
    (void)y;
    if (setjmp(png_jmpbuf(writer->png))) return tell(writer, reason);
    for (int i = 0; i < rows; i++)
        png_write_row(writer->png, (png_const_bytep)pixels + (size_t)i * writer->row);
    return true;
}

bool wr_png_next(WrCodecWriter *writer, char *reason)
{
    (void)writer;
    snprintf(reason, WR_CODEC_REASON, "the format holds one part");
    return false;
}

static bool end_or_jump(WrCodecWriter *writer, char *reason)
{
    if (setjmp(png_jmpbuf(writer->png))) return tell(writer, reason);
    png_write_end(writer->png, NULL);
    empty(writer);
    return true;
}

bool wr_png_finish(WrCodecWriter *writer, bool keep, char *reason)
{
    const bool good = !keep || end_or_jump(writer, reason);
    release(writer);
    return good;
}
