/* Reading fonts, in any process: unpacking, then opening by format. */
#include "image/font_internal.h"

#include "base/error.h"
#include "base/text.h"

#include <string.h>

typedef struct Opened {
    WrFontFace faces[WR_FONT_FILES];
    uint8_t *unpacked[WR_FONT_FILES]; /* owned */
    int count;
} Opened;

void wr_font_face_expect(WrFontFace *face, int count)
{
    wr_array_reserve(&face->known, count);
    face->known.count = count;
    memset(face->known.data, 0, (size_t)count * sizeof *face->known.data);
}

/* PSF, version 1 or 2, which FreeType does not read. bytes: [4] */
static bool is_console_font(const uint8_t *bytes)
{
    return memcmp(bytes, "\x36\x04", 2) == 0 || memcmp(bytes, "\x72\xb5\x4a\x86", 4) == 0;
}

/* Opens the next file. */
static bool open_file(Opened *all, const WrFontFile *file, WrFontMaking *making,
                      const WrFontRequest *ask, WrError *err)
{
    WrFontFace *face = &all->faces[all->count];
    WrFontFile in = *file;
    *face = (WrFontFace){ .making = making, .ask = ask, .font = all->count };
    if (in.length >= 4 && in.bytes[0] == 0x1f && in.bytes[1] == 0x8b) {
        uint8_t **unpacked = &all->unpacked[all->count];
        if (!wr_font_gunzip(file->bytes, file->length, WR_FONT_FILE_MAX, unpacked, &in.length, err))
            return false;
        in.bytes = *unpacked;
    }
    if (in.length < 4) return wr_fail(err, "is no font that can be read");
    if (is_console_font(in.bytes))
        return wr_fail(err, "is a font of the text console (PSF), which cannot be read; use the "
                            "same font as PCF, OTB or "
                            "BDF, such as Terminus in Debian's package xfonts-terminus");
    const bool good = wr_font_open_free(face, in.bytes, in.length, err);
    if (good) all->count++;
    return good;
}

/* Rejects damaged glyphs, which have no outline data. */
static bool check_placed(const WrFontMaking *making, WrError *err)
{
    for (int i = 0; i < making->placed.count; i++)
        if (making->placed.data[i].glyph < 0)
            return wr_fail(err, "has coloured dots or dots of a wrong size, which cannot be used");
    return true;
}

bool wr_font_make(const WrFontFile *files, int count, const WrFontRequest *ask, WrText *block,
                  WrError *err)
{
    WrFontMaking making = { 0 };
    Opened all = { .count = 0 };
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        good = open_file(&all, &files[i], &making, ask, err);
        if (!good && i > 0) wr_error_prefix(err, "the font number %d to take letters from ", i);
    }
    if (good) {
        making.head = all.faces[0].head;
        good = wr_font_parts(all.faces, all.count, err) && check_placed(&making, err);
    }
    if (good) wr_font_pack(&making, block);
    for (int i = 0; i < all.count; i++) all.faces[i].close(&all.faces[i]);
    for (int i = 0; i < WR_FONT_FILES; i++) wr_free(all.unpacked[i]);
    wr_font_making_fini(&making);
    return good;
}
