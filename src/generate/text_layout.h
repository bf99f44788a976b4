/* text_layout.h - layout of a text's letters on the table: in lines, rotated, on a path, around the
   table.
   Private to this module. */
#pragma once
#include "base/enum_rows.h"
#include "generate/param.h"
#include "generate/text.h"
#include "image/font.h"

#include <stdbool.h>

/* Middle: half way between the first line's ascent and the last one's descent; the others refer to the
 * first line. */
#define WR_TEXT_ANCHORS(X)                                                                         \
    X(WR_TEXT_MIDDLE, "middle")                                                                    \
    X(WR_TEXT_BASELINE, "baseline")                                                                \
    X(WR_TEXT_TOP, "top")                                                                          \
    X(WR_TEXT_BOTTOM, "bottom")
typedef enum WrTextAnchor { WR_TEXT_ANCHORS(WR_WORD_ID) } WrTextAnchor;

/* Treatment of letters missing in the font. */
#define WR_TEXT_MISSING(X) X(WR_TEXT_BORROW, "borrow") X(WR_TEXT_SIGN, "sign")
enum { WR_TEXT_MISSING(WR_WORD_ID) };

typedef struct WrTextRequest {
    WrFontRequest ask;
    WrFontSetting setting;
    double at[2]; /* u, v */
    WrTextAnchor anchor;
    double rotate_deg;    /* anticlockwise as seen */
    const double *points; /* [point_count][2] u, v: a path; point_count 0: none */
    int point_count;
    bool around;       /* along lattice[0] tables to the right and lattice[1] up */
    double lattice[2]; /* integers */
    int repeats;       /* 0: the best number */
    bool clip;
} WrTextRequest;

/* Rows of those parameters, and of the others that select fonts. */
#define WR_P_FONT(value)                                                                           \
    {                                                                                              \
        .name = "font", .label = "Font", .help = "an installed font, where no file is named",      \
        .unit = "", .kind = WR_PARAM_CHOICE, .fallback = { value }, .words = wr_font_names         \
    }
#define WR_P_FONT_FILE                                                                             \
    { .name = "file",                                                                              \
      .label = "Font file",                                                                        \
      .help = "a font: TrueType, OpenType, Type 1, PCF, BDF, OTB, also packed by gzip",            \
      .unit = "",                                                                                  \
      .kind = WR_PARAM_FILE,                                                                       \
      .fallback_text = "" },                                                                       \
        WR_P_WHOLE("face", "Face", 0, 0, 65535, 15, "which of a collection of fonts in one file")
#define WR_P_MISSING(n, words)                                                                     \
    WR_P_CHOICE(                                                                                   \
        n, "Missing letters", WR_TEXT_BORROW, words,                                               \
        "characters that the font lacks: from other installed fonts, or drawn as its sign "        \
        "for missing ones")
#define WR_P_FALLBACK(n, l, h)                                                                     \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_FILE,                 \
        .fallback_text = ""                                                                        \
    }

/* Adds all letters' outlines to a shape. Curves are approximated within 1/64 texel. Dots of bitmap
 * fonts with an integer number of texels each, unrotated, are exactly at texels.
 * Errors   all points are equal; around= on a table that is not periodic, or without direction; those
 *          of wr_text_shape_add; cancelled */
bool wr_text_lay(const WrTextRequest *wish, const WrFontText *text, const WrGenerateJob *job,
                 WrTextShape *shape, WrError *err);
