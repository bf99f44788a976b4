/* fuzz_font.c - untrusted fonts: for any bytes, a font is refused with a message or produces a text with a valid result,
   in which every outline can be drawn. The first byte selects the prefix: none, a valid BDF font with the fuzzer's
   bytes written over it, a compressed file, or an installed font of each kind with the bytes written over it. */
#include "base/error.h"
#include "base/text.h"
#include "image/font_internal.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MUST(condition)                                                                            \
    do {                                                                                           \
        if (!(condition)) abort();                                                                 \
    } while (0)

static const char bdf[] =
    "STARTFONT 2.1\nFONT f\nSIZE 5 75 75\nFONTBOUNDINGBOX 4 5 0 -1\nCHARS 1\n"
    "STARTCHAR A\nENCODING 65\nSWIDTH 800 0\nDWIDTH 4 0\nBBX 3 4 0 0\nBITMAP\n"
    "40\nA0\nE0\nA0\nENDCHAR\nENDFONT\n";

/* Depending on its length the font is used alone, with a valid fallback, or as a fallback for one. */
static void shape_varied(const uint8_t *bytes, size_t length, const char *axes)
{
    const WrFontFile own = { bytes, length };
    const WrFontFile sound = { (const uint8_t *)bdf, sizeof bdf - 1 };
    const WrFontFile first = length % 3 == 2 ? sound : own;
    const WrFontFile files[] = { first, length % 3 == 2 ? own : sound };
    WrError err = { "" };
    WrText block = { 0 };
    WrFontRequest ask = { .text = "A \xd8\xa8\xd9\x84\xd8\xa7 fi\n\xe0\xa4\x95\xe0\xa4\xbf",
                          .axes = axes };
    if (!wr_font_shape_text(files, length % 3 == 0 ? 1 : 2, &ask, &block, &err)) {
        MUST(err.text[0] != '\0');
        wr_text_fini(&block);
        return;
    }
    WrFontText text = { 0 };
    WrFontOutline outline = { 0 };
    WrFontSetting setting = { 20.0, 1.0, 1.0, WR_FONT_CENTRE };
    MUST(wr_font_unpack(block.data, block.length, strlen(ask.text), &text));
    MUST(text.line_count == 2);
    if (!wr_font_outline(&text, &setting, 0.1, &outline, &err)) MUST(err.text[0] != '\0');
    wr_font_outline_fini(&outline);
    wr_font_text_fini(&text);
}

static void shape(const uint8_t *bytes, size_t length)
{
    shape_varied(bytes, length, NULL);
}

/* Pairs of an offset (two bytes) and a value are written over the file. */
static void change(uint8_t *file, size_t length, const uint8_t *data, size_t size)
{
    for (; size >= 3; data += 3, size -= 3)
        file[((size_t)data[0] << 8 | data[1]) % length] = data[2];
}

/* A valid font that is always installed with the program. */
static const uint8_t *whole_font(const char *path, size_t *length)
{
    uint8_t *bytes = NULL;
    FILE *file = fopen(path, "rb");
    *length = 0;
    if (!file) return NULL;
    bytes = malloc(1 << 20);
    *length = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

/* The starts of tables contain the most sensitive fields. */
static void shape_changed(const char *path, const char *axes, const uint8_t *data, size_t size)
{
    size_t length;
    uint8_t *file = (uint8_t *)(uintptr_t)whole_font(path, &length);
    if (length > 0) {
        change(file, length < 65536 ? length : 65536, data, size);
        shape_varied(file, length - size % 3, axes);
    }
    free(file);
}

static void shape_packed(const uint8_t *data, size_t size)
{
    uint8_t packed[8192];
    z_stream z = { .next_in = (Bytef *)(uintptr_t)data, .avail_in = (uInt)size };
    if (deflateInit2(&z, 1, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY) != Z_OK) return;
    z.next_out = packed;
    z.avail_out = sizeof packed;
    if (deflate(&z, Z_FINISH) == Z_STREAM_END) shape(packed, z.total_out);
    deflateEnd(&z);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t file[8192];
    size_t start = 0;
    if (size < 1 || size > 4096) return 0;
    int way = data[0] % 6;
    data++;
    size--;
    if (way == 1) start = sizeof bdf - 1, memcpy(file, bdf, start);
    memcpy(file + start, data, size);
    if (way == 1) {
        change(file, start, data, size);
        shape(file, start);
    } else if (way == 2) {
        shape_packed(data, size);
    } else if (way == 3) {
        shape_changed("/usr/share/fonts/truetype/lohit-devanagari/Lohit-Devanagari.ttf", NULL, data,
                      size);
    } else if (way == 4) {
        shape_changed("/usr/share/fonts/X11/misc/ter-u16n_unicode.pcf.gz", NULL, data, size);
    } else if (way == 5) {
        shape_changed("/usr/share/fonts/truetype/inter-vf/Inter-roman.var.ttf", "wght=650,slnt=-3",
                      data, size);
    } else {
        shape(file, start + size);
    }
    return 0;
}
