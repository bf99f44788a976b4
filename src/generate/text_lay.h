/* text_lay.h - where a text's letters stand on the table: in lines, turned, on a path, around the table.
   Layer 4, private to this room. */
#pragma once
#include "generate/text.h"
#include "image/font.h"

typedef enum WrTextAnchor {
    WR_TEXT_MIDDLE,   /* half way between the first line's ascent and the last one's descent */
    WR_TEXT_BASELINE, /* of the first line */
    WR_TEXT_TOP,
    WR_TEXT_BOTTOM
} WrTextAnchor;

typedef struct WrTextWish {
    WrFontAsk ask;
    WrFontSetting setting;
    double at[2]; /* u, v */
    WrTextAnchor anchor;
    double rotate_deg;    /* anticlockwise as seen */
    const double *points; /* [point_count][2] u, v: a path; point_count 0: none */
    int point_count;
    bool around;       /* along lattice[0] tables to the right and lattice[1] up */
    double lattice[2]; /* whole numbers */
    int repeats;       /* 0: as many as fit best */
    bool clip;
} WrTextWish;

/* Add all letters' outlines to a shape. Curves are kept within 1/64 texel. Dots of bitmap fonts at a whole
 * number of texels each, unturned, stand exactly on texels.
 * Errors   points at one place; around= on a table that is not periodic, or in no direction; those of
 *          wr_text_shape_add; cancelled */
bool wr_text_lay(const WrTextWish *wish, const WrFontText *text, const WrGenerateJob *job,
                 WrTextShape *shape, WrError *err);
