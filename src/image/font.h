/* font.h - text as outlines: bitmap and outline fonts, shaped for any script.

   Fonts are untrusted, so a font file is read and text is shaped in the reader process
   (reader_protocol.h); every number of its reply is checked here. All numbers are integers in the
   font's own units, so that no library's rounding can affect a height: sizes, positions and curves are
   computed later, here, with + - * / sqrt only. Formats: TrueType, OpenType, Type 1 and other outline
   fonts of FreeType, shaped by HarfBuzz, mixed directions by FriBidi; bitmaps in PCF, BDF and OTB;
   all also compressed by gzip. */
#pragma once
#include "base/array.h"
#include "base/enum_rows.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_FONT_TEXT_MAX 262144      /* bytes of a text */
#define WR_FONT_FILE_MAX (128 << 20) /* bytes of a file, also after unpacking */
#define WR_FONT_POINTS_MAX (1 << 22) /* outline points of all distinct glyphs of a text */
#define WR_FONT_FLAT_MAX (1 << 23)   /* points of a whole text's flattened outlines */
#define WR_FONT_SIZE_MAX 65536.0     /* texels */
#define WR_FONT_OTHERS 3             /* number of fallback fonts */

/* ---- fonts by name ---- */

/* Names of fonts that text commands use; ends with NULL. The first is the default: a bitmap font. */
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
/* The family of wr_font_names[index], as in "DejaVu Serif". */
const char *wr_font_family(int index);
/* The file of wr_font_names[index], found by fontconfig; for bitmap families the best one for `size` texels: the tallest
 * that divides the size, else the tallest that is not taller. Errors: not installed, with the name of
 * its package. The caller frees with wr_free. */
char *wr_font_find(int index, double size, WrError *err);

/* Installed outline fonts that contain as many of these characters as possible: each is the font with
 * most of the characters missing in the previous ones, in fontconfig's order for the language (NULL:
 * any) and a style ("sans", "serif-bold", any of wr_font_names). The result depends on the machine:
 * commands to be replayed must store the names. paths: up to `most`; the caller frees each with
 * wr_free. Returns their number; 0 also if fontconfig fails, or if cancelled while fontconfig builds
 * its list of fonts (base/pool.h). Any thread. */
int wr_font_lenders(const uint32_t *characters, int count, const char *kind, const char *language,
                    int most, char *paths[]);

/* ---- shaping ---- */

/* Number of invalid UTF-8 sequences in a text. */
int wr_font_strange_bytes(const char *text);

/* Auto: for each line by its first strongly directional letter. */
#define WR_FONT_DIRECTIONS(X)                                                                      \
    X(WR_FONT_AUTO, "auto")                                                                        \
    X(WR_FONT_LEFT_TO_RIGHT, "left-to-right")                                                      \
    X(WR_FONT_RIGHT_TO_LEFT, "right-to-left")
typedef enum WrFontDirection {
    WR_FONT_DIRECTIONS(WR_WORD_ID) WR_FONT_DIRECTION_COUNT
} WrFontDirection;

typedef struct WrFontRequest {
    const char *text; /* UTF-8, \n between lines; up to WR_FONT_TEXT_MAX bytes. Invalid bytes count
                         as U+FFFD */
    int face;         /* index in a font collection, from 0 */
    WrFontDirection direction;
    const char *language; /* as in "ar", "hi"; NULL: unspecified */
    const char *axes;     /* of a variable font, as in "wght=650,wdth=80"; NULL: defaults. Fallback
                         fonts use the axes that they have */
    /* Fallback fonts for missing glyphs, in order; face 0 of each. A mark uses the font of its base
       character. */
    const char *others[WR_FONT_OTHERS]; /* files; the first NULL ends the list */
} WrFontRequest;

/* In halves of the glyph's units, since curves may join half way between two points; y up, the origin
   on the baseline. */
typedef struct WrFontPoint {
    int32_t x, y;
} WrFontPoint;

typedef enum WrFontVerb {
    WR_FONT_MOVE,  /* one point; begins a contour, which is closed automatically */
    WR_FONT_LINE,  /* one */
    WR_FONT_CONIC, /* two: control, end */
    WR_FONT_CUBIC  /* three */
} WrFontVerb;

/* One of a text's distinct glyphs. For bitmaps a unit is a dot. */
typedef struct WrFontGlyph {
    uint32_t id;   /* glyph index in the font */
    int32_t font;  /* 0: the first font; else 1 + index in WrFontRequest.others */
    int32_t units; /* units per em of that font; bitmaps: dots of height; 1..16384 */
    int32_t first_verb, verb_count, first_point, point_count;
    int32_t left, top, width, height; /* bitmaps: left edge, upper edge above the baseline, dots */
    /* bitmaps: rows from the top, bit 7 leftmost, each row padded to bytes */
    int32_t first_byte;
} WrFontGlyph;

/* A positioned glyph, in its glyph's units, y up. */
typedef struct WrFontPlaced {
    int32_t glyph;   /* index in the text's glyphs */
    int32_t advance; /* to the next one, to the right */
    int32_t dx, dy;  /* drawing offset from the pen */
    int32_t cluster; /* byte offset of its character in the text */
    int32_t spaced;  /* 1: letter spacing follows (last glyph of its cluster) */
} WrFontPlaced;

typedef struct WrFontLine {
    int32_t first, count; /* placed glyphs, from left to right */
    int32_t leftwards;    /* 1: the line's direction is right to left */
} WrFontLine;

/* A shaped text. Zeroed is empty; fini frees. */
typedef struct WrFontText {
    bool bitmap;             /* the first font is a bitmap font */
    int32_t units;           /* units of the first font, used by the measures */
    int32_t ascent, descent; /* above and below the baseline, usually both > 0 */
    int32_t line;            /* distance between baselines */
    int32_t line_count, placed_count, glyph_count, verb_count, point_count, byte_count,
        missing_count;
    const WrFontLine *lines;
    const WrFontPlaced *placed;
    const WrFontGlyph *glyphs;
    const WrFontPoint *points;
    const uint32_t *missing; /* characters without a glyph in any font, each once, at most 64; drawn
                                as the first font's .notdef, or as a box if it has none */
    const uint8_t *verbs;    /* WrFontVerb */
    const uint8_t *bytes;
    char *block; /* owned: memory of all arrays */
} WrFontText;

/* Shapes a text with a font file. out: unchanged on failure; owned by the caller.
 * Errors   name the file: unreadable, not a font, damaged or hostile, too large, none of the axes
 *          exists; the text is too long
 * Threads  any number at once */
bool wr_font_shape(const char *path, const WrFontRequest *ask, WrFontText *out, WrError *err);
/* wr_font_shape for bytes in memory; `name` is for messages. */
bool wr_font_shape_bytes(const char *name, const void *bytes, size_t length,
                         const WrFontRequest *ask, WrFontText *out, WrError *err);
void wr_font_text_fini(WrFontText *text);

/* Texels per unit of the glyph. */
static inline double wr_font_scale(const WrFontText *text, const WrFontPlaced *placed, double size)
{
    return size / text->glyphs[placed->glyph].units;
}

/* True if that dot of a bitmap glyph is set; false outside the glyph. */
bool wr_font_dot(const WrFontText *text, const WrFontGlyph *glyph, int column, int row);

/* ---- flattened outlines ---- */

/* Closed polygons of all contours; filled by the nonzero winding rule. */
typedef struct WrFontOutline {
    WR_ARRAY(double) xy; /* x, y, x, y, ... */
    WR_ARRAY(int32_t)
    first; /* [contours] index of each contour's first point; the last contour
                                ends with xy */
} WrFontOutline;
void wr_font_outline_fini(WrFontOutline *outline);

/* Appends one glyph's outline: scaled by `scale` per unit, moved by (x, y), y up. Curves become chords
 * within `tolerance` of them (> 0, in the units of the result). Bitmaps: the outline of the dots, one
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
    double letter_spacing; /* texels added between letters; may be negative */
    double line_spacing;   /* factor of the font's own spacing; default 1 */
    WrFontAlign align;
} WrFontSetting;

/* Pen positions of the glyphs, y up, the first baseline at y = 0; x from the left edge, the middle or
 * the right edge of the lines according to align. place: [placed_count][2]. Returns the width of the
 * widest line. */
double wr_font_place(const WrFontText *text, const WrFontSetting *setting, double (*place)[2]);

/* The outlines of a whole text: placed and flattened. */
bool wr_font_outline(const WrFontText *text, const WrFontSetting *setting, double tolerance,
                     WrFontOutline *out, WrError *err);
