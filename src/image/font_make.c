/* Reading a font, in whichever process: unpacked, then by its kind. */
#include "image/font_inner.h"

#include <string.h>

static bool make(const uint8_t *bytes, size_t length, const WrFontAsk *ask, WrText *block,
                 WrError *err)
{
    WrFontMaking making = { 0 };
    bool good = wr_psf_is(bytes, length) ? wr_psf_make(bytes, length, ask, &making, err)
                                         : wr_font_make_free(bytes, length, ask, &making, err);
    if (good) wr_font_pack(&making, block);
    wr_font_making_fini(&making);
    return good;
}

bool wr_font_make(const void *bytes, size_t length, const WrFontAsk *ask, WrText *block,
                  WrError *err)
{
    const uint8_t *from = bytes;
    if (length < 4) return wr_fail(err, "is no font that can be read");
    if (from[0] != 0x1f || from[1] != 0x8b) return make(from, length, ask, block, err);
    uint8_t *unpacked;
    if (!wr_font_gunzip(from, length, WR_FONT_FILE_MAX, &unpacked, &length, err)) return false;
    bool good = length >= 4 ? make(unpacked, length, ask, block, err)
                            : wr_fail(err, "is no font that can be read");
    wr_free(unpacked);
    return good;
}
