/* font_inner.h - what the files of fonts share.
   Layer 1, private to font*.c and the reader process.

   A shaped text travels as one block: a WrFontHead, then the arrays in the order of its counts. */
#pragma once
#include "base/text.h"
#include "image/font.h"

#define WR_FONT_MISSING_MAX 64

typedef struct WrFontHead {
    int32_t bitmap, units, ascent, descent, line;
    int32_t lines, placed, glyphs, points, missing, verbs, bytes; /* counts */
} WrFontHead;

/* What the program asks; the text, its NUL and the language follow it, and a NUL. */
typedef struct WrFontOrder {
    int32_t face, direction, text_length, language_length;
} WrFontOrder;

/* A shaped text being made, in the process that reads the font. */
typedef struct WrFontMaking {
    WrFontHead head; /* counts are set at the end */
    WR_ARRAY(WrFontLine) lines;
    WR_ARRAY(WrFontPlaced) placed;
    WR_ARRAY(WrFontGlyph) glyphs;
    WR_ARRAY(WrFontPoint) points;
    WR_ARRAY(uint32_t) missing;
    WR_ARRAY(uint8_t) verbs;
    WR_ARRAY(uint8_t) bytes;
    WR_ARRAY(int32_t) known; /* glyph id -> its place in glyphs + 1; 0: not there yet */
} WrFontMaking;

void wr_font_making_fini(WrFontMaking *making);
/* All of it as one block. */
void wr_font_pack(const WrFontMaking *making, WrText *out);

/* Check a block from a stranger and make a text of it; takes the block over if it is good. */
bool wr_font_unpack(char *block, size_t length, size_t text_length, WrFontText *out);

/* Read a font and shape the text by it, in this process. bytes: the file, packed or not.
 * Errors   one sentence that does not name the file */
bool wr_font_make(const void *bytes, size_t length, const WrFontAsk *ask, WrText *block,
                  WrError *err);

/* Unpack a gzip file, up to `limit` bytes. *out is the caller's (wr_free). */
bool wr_font_gunzip(const uint8_t *bytes, size_t length, size_t limit, uint8_t **out, size_t *count,
                    WrError *err);

/* The next character of UTF-8 text[0..length), moving *at past it; what is not UTF-8 gives U+FFFD, byte by
 * byte. */
uint32_t wr_font_character(const char *text, size_t length, size_t *at);
void wr_font_add_missing(WrFontMaking *making, uint32_t character);

/* ---- PSF ---- */

/* Does it begin as a PSF file does? */
bool wr_psf_is(const uint8_t *bytes, size_t length);
bool wr_psf_make(const uint8_t *bytes, size_t length, const WrFontAsk *ask, WrFontMaking *out,
                 WrError *err);

/* Make lines of a text by a plain map from characters to glyphs, one a character, with widths of glyphs as
 * they are, in visual order: for fonts that know no shaping. glyph: the place in making->glyphs, or -1 for
 * a character that the font lacks; advance: of that glyph. */
typedef int32_t (*WrFontMap)(void *ctx, uint32_t character, int32_t *advance);
bool wr_font_lay_plain(WrFontMaking *making, const WrFontAsk *ask, WrFontMap map, void *ctx,
                       WrError *err);

/* A part of a line in one direction, in visual order, left to right. */
typedef struct WrFontRun {
    int first, count; /* characters of the line, in logical order */
    bool leftwards;
} WrFontRun;
/* Characters of a line, NUL-free, with the byte that each begins at. */
typedef struct WrFontChars {
    uint32_t *code;
    int32_t *byte;
    int count;
} WrFontChars;
/* Call with each line's characters; cuts at \n (\r before it is dropped). runs: its parts by direction. */
typedef bool (*WrFontLineMake)(void *ctx, const WrFontChars *chars, const WrFontRun *runs,
                               int run_count, WrError *err);
bool wr_font_lines(WrFontMaking *making, const WrFontAsk *ask, WrFontLineMake make, void *ctx,
                   WrError *err);

/* Shape by what FreeType reads. */
bool wr_font_make_free(const uint8_t *bytes, size_t length, const WrFontAsk *ask, WrFontMaking *out,
                       WrError *err);
