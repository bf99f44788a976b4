/* font_list.h - the list of installed fonts. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrError WrError;

typedef struct WrFontEntry {
    char *family, *style; /* owned; UTF-8 of one line */
    char *path;           /* owned; UTF-8 of one line */
    char *sample; /* owned: its family's name if the font has those letters, else some of its own */
    int face;     /* index in a collection, from 0; else 0 */
} WrFontEntry;
typedef WR_ARRAY(WrFontEntry) WrFontList;

/* All outline fonts of fontconfig, except pictogram fonts; by family, from light to bold, upright ones
 * first. Names come from untrusted files: they are shortened to one line.
 *
 * list     zeroed; owned by the caller (wr_font_list_fini)
 * Errors   fontconfig does not work, or crashes on a font; cancelled
 * Threads  any; needs seconds if fontconfig has no cache */
bool wr_font_list(WrFontList *list, WrError *err);
void wr_font_list_fini(WrFontList *list);
void wr_font_entry_fini(WrFontEntry *entry); /* frees its members */

/* The file of an installed upright font; NULL: none.
 *
 * families  exact names, in order of preference, or "sans-serif", the desktop's choice; ends with NULL
 * weight    of OpenType: 400 regular, 600 semi-bold, 700 bold
 * Result    the caller frees it with wr_free
 * Threads   any */
char *wr_font_file(const char *const *families, int weight);

/* ---- Fontconfig ---- */

/* Loads its list of installed fonts, once. Without a cache fontconfig reads every font itself, which
 * needs seconds, and fonts are untrusted: so this is tried first in a copy of the process, which may
 * crash.
 *
 * Errors   it fails, or a font makes it crash or hang; "cancelled". The next call tries again
 * Threads  any */
bool wr_font_config(WrError *err);
void wr_font_config_begin(void); /* starts it in advance, and returns at once */
bool wr_font_config_done(void);  /* true if the list is loaded; does not wait */
