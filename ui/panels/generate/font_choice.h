/* font_choice.h - font menu: the list opened from a font row, with each name in its own font. The list and the
   samples are loaded in the background, and only visible samples are rendered. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/panels/generate/generate_state.h"

#include "image/font_list.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrFontChoice WrFontChoice;

/* Row of a font parameter, replacing its few choice words; also names the installed file in use. True if another font
 * was chosen, which changes `font`, `file` and `face` of the current generator. */
bool wr_font_choice_row(WrApp *app, int param);
void wr_font_choice_free(WrApp *app);

extern const WrPart wr_part_font_choice;

/* ---- on the worker thread ---- */

/* Rendered sample of a word in a font: white, with pixel coverage as alpha. The baseline is at the same height in all
 * samples.
 *
 * sample   the font (a built-in name, or a file and its face) and the picture's size in pixels
 * argb     [h][w], allocated by the caller; top row first
 * False    the font cannot be read, or `progress` was cancelled */
typedef struct WrFontSample {
    const char *named; /* from wr_font_names; NULL: entry */
    const WrFontEntry *entry;
    int w, h;
} WrFontSample;
bool wr_font_sample(const WrFontSample *sample, WrPool *pool, const WrProgress *progress,
                    uint32_t *argb);
