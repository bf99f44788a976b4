/* font_internal.h - internals shared by the font files.
   Private to font*.c and the reader process.
   A shaped text is transferred as one block: a WrFontHead, then the arrays in the order of its counts. */
#pragma once
#include "image/font.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_FONT_MISSING_MAX 64

typedef struct WrFontHead {
    int32_t bitmap, units, ascent, descent, line;
    int32_t lines, placed, glyphs, points, missing, verbs, bytes; /* counts */
} WrFontHead;

/* A request of the program; the text, the language and the axes follow it, each NUL-terminated. The
   font files are sent as one concatenated file. */
#define WR_FONT_FILES (1 + WR_FONT_OTHERS)
typedef struct WrFontOrder {
    int32_t face, direction, text_length, language_length, axes_length, file_count;
    uint64_t lengths[WR_FONT_FILES];
} WrFontOrder;

/* A font file in memory, compressed or not; borrowed. */
typedef struct WrFontFile {
    const uint8_t *bytes;
    size_t length;
} WrFontFile;

/* A shaped text under construction, in the process that reads the font. */
typedef struct WrFontMaking {
    WrFontHead head; /* counts are set at the end */
    WR_ARRAY(WrFontLine) lines;
    WR_ARRAY(WrFontPlaced) placed;
    WR_ARRAY(WrFontGlyph) glyphs;
    WR_ARRAY(WrFontPoint) points;
    WR_ARRAY(uint32_t) missing;
    WR_ARRAY(uint8_t) verbs;
    WR_ARRAY(uint8_t) bytes;
} WrFontMaking;

void wr_font_making_fini(WrFontMaking *making);
/* Serialises it as one block. */
void wr_font_pack(const WrFontMaking *making, WrText *out);

/* Checks an untrusted block and converts it to a text; owns the block on success. */
bool wr_font_unpack(char *block, size_t length, size_t text_length, WrFontText *out);

/* Reads the fonts, 1..WR_FONT_FILES, the first of which is the main one, and shapes the text, in this
 * process.
 * Errors   one sentence that does not name the file */
bool wr_font_shape_text(const WrFontFile *files, int count, const WrFontRequest *ask, WrText *block,
                        WrError *err);

/* Unpacks a gzip file, up to `limit` bytes. *out is owned by the caller (wr_free). */
bool wr_font_gunzip(const uint8_t *bytes, size_t length, size_t limit, uint8_t **out, size_t *count,
                    WrError *err);

/* The next character of UTF-8 text[0..length), advances *at; invalid bytes yield U+FFFD each. */
uint32_t wr_font_character(const char *text, size_t length, size_t *at);

/* Characters of a line, without NUL, with the byte offset of each. */
typedef struct WrFontChars {
    uint32_t *code;
    int32_t *byte;
    int count;
} WrFontChars;

/* ---- open fonts ---- */

/* An open font in the process that reads it. */
typedef struct WrFontFace {
    void *ctx;
    WrFontMaking *making; /* receives the shaped glyphs */
    const WrFontRequest *ask;
    int32_t font;            /* as in WrFontGlyph */
    WrFontHead head;         /* its measures */
    WR_ARRAY(int32_t) known; /* glyph id -> its index in glyphs + 1; 0: not there yet */
    bool (*has)(const struct WrFontFace *face, uint32_t character);
    /* Appends the characters from .. from + count - 1, all of one script (an ISO 15924 tag of HarfBuzz)
       and direction, from left to right. */
    bool (*shape)(struct WrFontFace *face, const WrFontChars *chars, int from, int count,
                  bool leftwards, uint32_t script, WrError *err);
    void (*close)(struct WrFontFace *face);
} WrFontFace;

/* Shaping for fonts without shaping tables: one glyph per character. map: returns the index in
 * making->glyphs and the advance. */
typedef int32_t (*WrFontMap)(WrFontFace *face, uint32_t character, int32_t *advance);

/* ---- lines ---- */

/* A part of a line in one direction, in visual order, left to right. */
typedef struct WrFontRun {
    int first, count; /* characters of the line, in logical order */
    bool leftwards;
} WrFontRun;
/* Called with each line's characters; lines are split at \n (a preceding \r is dropped). runs: its
 * parts by direction. */
typedef bool (*WrFontLineMake)(void *ctx, const WrFontChars *chars, const WrFontRun *runs,
                               int run_count, WrError *err);
