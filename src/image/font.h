/* font.h - text as outlines: font files of all kinds, bitmap and outline, shaped for any script.

   A font file is read and text is shaped by it in the reader process (reader_protocol.h), since fonts come from
   strangers; what it answers is checked here number by number. All of it is whole numbers in the font's
   own units, so that no library's rounding can reach a height: sizes, places and curves come after,
   here, by + - * / sqrt alone.

   Kinds: TrueType, OpenType, Type 1 and what else FreeType reads as outlines, shaped by HarfBuzz, mixed
   directions by FriBidi; bitmaps in PCF, BDF, PSF 1 and 2, all also compressed by gzip. */
#pragma once
#include "base/array.h"
#include "base/enum_rows.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_FONT_TEXT_MAX 262144      /* bytes of a text */
#define WR_FONT_FILE_MAX (128 << 20) /* bytes of a file, unpacked as well */
#define WR_FONT_POINTS_MAX (1 << 22) /* of all outlines of a text's different glyphs */
#define WR_FONT_FLAT_MAX (1 << 23)   /* points of a whole text's outlines, made straight */
#define WR_FONT_SIZE_MAX 65536.0     /* texels */
#define WR_FONT_OTHERS 3             /* fonts besides that lend what one lacks */

/* ---- fonts by name ---- */

/* The names of fonts that Debian packages put in known places; ends with NULL. The first is the default:
   a bitmap font. */
#define WR_FONT_FAMILIES(X)                                                                        \
    X(WR_FONT_TERMINUS, "terminus")                                                                \
    X(WR_FONT_TERMINUS_BOLD, "terminus-bold")                                                      \
    X(WR_FONT_SANS, "sans")                                                                        \
    X(WR_FONT_SANS_BOLD, "sans-bold")                                                              \
    X(WR_FONT_SERIF, "serif")                                                                      \
    X(WR_FONT_SERIF_BOLD, "serif-bold")                                                            \
    X(WR_FONT_MONO, "mono")                                                                        \
    X(WR_FONT_MONO_BOLD, "mono-bold")                                                              \
    X(WR_FONT_INTER, "inter")                                                                      \
    X(WR_FONT_INTER_BOLD, "inter-bold")
enum { WR_FONT_FAMILIES(WR_WORD_ID) WR_FONT_FAMILY_COUNT };
extern const char *const wr_font_names[];
/* The file of wr_font_names[index], for bitmap families the one that fits `size` texels best: the tallest
 * that goes into it a whole number of times, else the tallest that is not taller. Errors: not installed,
 * and in which package it is. The caller frees with wr_free. */
char *wr_font_find(int index, double size, WrError *err);

/* Installed fonts with outlines that have as much as possible of these characters: each the one that has
 * most of what those before it lack, by fontconfig's order for the language (NULL: any) and for a kind of
 * letters ("sans", "serif-bold", any of wr_font_names). Which ones depends on the machine: what is to be
 * replayed must keep their names. paths: up to `most`; the caller frees each with wr_free. Returns how
 * many; 0 also where fontconfig does not work, and where it is cancelled while that makes its list of fonts
 * (base/once_async.h). Any thread. */
int wr_font_lenders(const uint32_t *characters, int count, const char *kind, const char *language,
                    int most, char *paths[]);

/* ---- shaping ---- */

/* How many places of a text are not UTF-8. */
int wr_font_strange_bytes(const char *text);

/* Auto: of each line by its first letter that has one. */
#define WR_FONT_DIRECTIONS(X)                                                                      \
    X(WR_FONT_AUTO, "auto")                                                                        \
    X(WR_FONT_LEFT_TO_RIGHT, "left-to-right")                                                      \
    X(WR_FONT_RIGHT_TO_LEFT, "right-to-left")
typedef enum WrFontDirection {
    WR_FONT_DIRECTIONS(WR_WORD_ID) WR_FONT_DIRECTION_COUNT
} WrFontDirection;

typedef struct WrFontAsk {
    const char *text; /* UTF-8, \n between lines; up to WR_FONT_TEXT_MAX bytes. What is not UTF-8
                         counts as U+FFFD */
    int face;         /* of a collection of fonts, from 0 */
    WrFontDirection direction;
    const char *language; /* as in "ar", "hi"; NULL: unsaid */
    const char *axes; /* of a variable font, as in "wght=650,wdth=80"; NULL: as it is. Other fonts
                             take those of these axes that they have */
    /* Fonts whose glyphs take the place of those that the font lacks, the first that has them; face 0 of
       each. A mark stays with what it stands on. */
    const char *others[WR_FONT_OTHERS]; /* files; the first NULL ends the list */
} WrFontAsk;

/* In halves of the glyph's units, since curves may meet half way between two points; y up, the origin on the
   baseline. */
typedef struct WrFontPoint {
    int32_t x, y;
} WrFontPoint;

typedef enum WrFontVerb {
    WR_FONT_MOVE,  /* one point; begins a contour, which closes itself */
    WR_FONT_LINE,  /* one */
    WR_FONT_CONIC, /* two: control, end */
    WR_FONT_CUBIC  /* three */
} WrFontVerb;

/* One of a text's different glyphs. Of bitmaps a unit is a dot. */
typedef struct WrFontGlyph {
    uint32_t id;   /* the font's number of it */
    int32_t font;  /* which: 0, or 1 + the place in WrFontAsk.others */
    int32_t units; /* of an em of that font; bitmaps: dots of height; 1..16384 */
    int32_t first_verb, verb_count, first_point, point_count;
    int32_t left, top, width, height; /* bitmaps: left edge, upper edge above the baseline, dots */
    int32_t first_byte;               /* bitmaps: rows from the top, bit 7 leftmost, each row whole
                                         bytes */
} WrFontGlyph;

/* In its glyph's units, y up. */
typedef struct WrFontPlaced {
    int32_t glyph;   /* which of the text's glyphs */
    int32_t advance; /* to the next one, to the right */
    int32_t dx, dy;  /* where it is drawn, from the pen */
    int32_t cluster; /* byte of the text that it stands for, 0.. */
    int32_t spaced;  /* 1: letter spacing comes after it (the last glyph of its cluster) */
} WrFontPlaced;

typedef struct WrFontLine {
    int32_t first, count; /* placed glyphs, from left to right */
    int32_t leftwards;    /* 1: the line as a whole runs from right to left */
} WrFontLine;

/* A shaped text. Zeroed is empty; fini frees. */
typedef struct WrFontText {
    bool bitmap;             /* the first font is one */
    int32_t units;           /* of the first font, and so are the measures */
    int32_t ascent, descent; /* above and below the baseline, usually > 0 both */
    int32_t line;            /* from baseline to baseline */
    int32_t line_count, placed_count, glyph_count, verb_count, point_count, byte_count,
        missing_count;
    const WrFontLine *lines;
    const WrFontPlaced *placed;
    const WrFontGlyph *glyphs;
    const WrFontPoint *points;
    const uint32_t *missing; /* characters that no font has a glyph for, each once, at most 64; they
                                are drawn as the first one's .notdef, or as a box if it has none */
    const uint8_t *verbs;    /* WrFontVerb */
    const uint8_t *bytes;
    char *block; /* owned: all of these */
} WrFontText;

/* Shape a text by a font file. out: untouched on failure; the caller's.
 * Errors   name the file: it cannot be read, is no font, is damaged or hostile, too large, has none of the
 *          axes; the text is too long
 * Threads  any number at once */
bool wr_font_shape(const char *path, const WrFontAsk *ask, WrFontText *out, WrError *err);
/* The same from bytes in memory; `name` is for messages. */
bool wr_font_shape_bytes(const char *name, const void *bytes, size_t length, const WrFontAsk *ask,
                         WrFontText *out, WrError *err);
void wr_font_text_fini(WrFontText *text);

/* Texels of one of the glyph's units. */
static inline double wr_font_scale(const WrFontText *text, const WrFontPlaced *placed, double size)
{
    return size / text->glyphs[placed->glyph].units;
}

/* Is that dot of a bitmap glyph set? Outside of it: no. */
bool wr_font_dot(const WrFontText *text, const WrFontGlyph *glyph, int column, int row);

/* ---- straight outlines ---- */

/* Closed polygons of all contours; inside is where the winding number is not 0. */
typedef struct WrFontOutline {
    WR_ARRAY(double) xy;     /* x, y, x, y, ... */
    WR_ARRAY(int32_t) first; /* [contours] of each its first point; the last contour ends with xy */
} WrFontOutline;
void wr_font_outline_fini(WrFontOutline *outline);

/* Append one glyph's outline: times `scale` per unit, moved by (x, y), y up. Curves become chords that stay
 * within `tolerance` of them (> 0, in the units of the result). Bitmaps: the outline of its dots, one
 * square each, touching corners kept apart. False and an error beyond WR_FONT_FLAT_MAX points. */
bool wr_font_glyph_outline(const WrFontText *text, int glyph, double scale, double x, double y,
                           double tolerance, WrFontOutline *out, WrError *err);

#define WR_FONT_ALIGNS(X)                                                                          \
    X(WR_FONT_LEFT, "left")                                                                        \
    X(WR_FONT_CENTRE, "centre")                                                                    \
    X(WR_FONT_RIGHT, "right")
typedef enum WrFontAlign { WR_FONT_ALIGNS(WR_WORD_ID) } WrFontAlign;

typedef struct WrFontSetting {
    double size;           /* texels of an em (bitmaps: of the dots' height) */
    double letter_spacing; /* texels added between letters, of any sign */
    double line_spacing;   /* times the font's own; 1 */
    WrFontAlign align;
} WrFontSetting;

/* Where glyphs stand: the pen of each, y up, the first baseline at y = 0; x from the left edge, the middle
 * or the right edge of the lines as aligned. place: [placed_count][2]. Returns the widest line. */
double wr_font_place(const WrFontText *text, const WrFontSetting *setting, double (*place)[2]);

/* The outlines of a whole text: shape, place and straighten in one. */
bool wr_font_outline(const WrFontText *text, const WrFontSetting *setting, double tolerance,
                     WrFontOutline *out, WrError *err);
