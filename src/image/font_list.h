/* font_list.h - the fonts that are installed. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrError WrError;

typedef struct WrFontEntry {
    char *family, *style; /* owned; UTF-8 of one line */
    char *path;           /* owned; UTF-8 of one line */
    char *sample; /* owned: its family's name if it has those letters, else some of its own */
    int face;     /* of a collection, from 0; else 0 */
} WrFontEntry;
typedef WR_ARRAY(WrFontEntry) WrFontList;

/* All that fontconfig knows and that have outlines, but those of pictures; by family, from light to bold, upright ones
 * first. What a font says of itself is a stranger's: names are made short and of one line.
 *
 * list     zeroed; the caller's (wr_font_list_fini)
 * Errors   fontconfig does not work, or falls over one of the fonts; cancelled
 * Threads  any; takes seconds where fontconfig has kept no list */
bool wr_font_list(WrFontList *list, WrError *err);
void wr_font_list_fini(WrFontList *list);
void wr_font_entry_fini(WrFontEntry *entry); /* what it owns */
