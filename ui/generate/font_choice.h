/* font_choice.h - choosing among the fonts that are installed: a list that opens from the row of a font, each name in
   letters of its own. The list and the letters are made in the background, only of those that are seen. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/generate/generate_state.h"

#include "image/font_list.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrFontChoice WrFontChoice;

/* The row of a parameter that names a font, in place of its few words: of which installed file it is if it is one.
 * Whether another font was chosen, which changes `font`, `file` and `face` of what is in hand. */
bool wr_font_choice_row(WrApp *app, int param);
void wr_font_choice_free(WrApp *app);

extern const WrPart wr_part_font_choice;

/* ---- font_sample.c: on the job's thread ---- */

/* What a word looks like in a font, white, as opaque as it covers a pixel; the baseline stands at the same height in all.
 *
 * sample   the font, a named one or a file and a face of it, and the picture's size in pixels
 * argb     [h][w], the caller's; top row first
 * False    the font cannot be read, or `progress` was cancelled */
typedef struct WrFontSample {
    const char *named; /* of wr_font_names; NULL: entry */
    const WrFontEntry *entry;
    int w, h;
} WrFontSample;
bool wr_font_sample(const WrFontSample *sample, WrPool *pool, const WrProgress *progress,
                    uint32_t *argb);
