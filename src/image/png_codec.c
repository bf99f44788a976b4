#include "image/png_codec.h"

#include "base/error.h"
#include "image/oiio.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void wr_png_fail(png_structp png, png_const_charp why)
{
    WrPngTrouble *trouble = png_get_error_ptr(png);
    if (!trouble->why[0]) snprintf(trouble->why, sizeof trouble->why, "%s", why);
    png_longjmp(png, 1);
}

void wr_png_warn(png_structp png, png_const_charp why)
{
    (void)png;
    (void)why;
}

png_voidp wr_png_alloc(png_structp png, png_alloc_size_t bytes)
{
    WrPngTrouble *trouble = png_get_mem_ptr(png);
    void *memory = malloc(bytes);
    if (!memory) trouble->no_memory = true;
    return memory;
}

void wr_png_free(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

bool wr_png_swaps(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 1;
}

bool wr_png_report(const WrPngTrouble *trouble, const char *before, char *reason)
{
    if (trouble->no_memory) snprintf(reason, WR_CODEC_REASON, "%s", WR_CODEC_NO_MEMORY);
    else if (!*before) snprintf(reason, WR_CODEC_REASON, "%s", trouble->why);
    else snprintf(reason, WR_CODEC_REASON, "%s (%s)", before, trouble->why);
    return false;
}

const WrCodec wr_png_codec = {
    .open = wr_png_open,
    .close = wr_png_close,
    .parts = wr_png_parts,
    .part = wr_png_part,
    .attribute = wr_png_attribute,
    .read = wr_png_read,
    .create = wr_png_create,
    .write = wr_png_write,
    .next = wr_png_next,
    .finish = wr_png_finish,
};

bool wr_codec_takes_module(const char *format)
{
    return strcmp(format, "png") != 0;
}

const WrCodec *wr_codec(const char *format, WrError *err)
{
    return wr_codec_takes_module(format) ? wr_oiio(err) : &wr_png_codec;
}
