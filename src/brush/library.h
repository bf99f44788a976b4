/* library.h - search of brush presets in the program's and the user's folders.

   A preset's id is its collection and its path without extension: "wrinkle/groove", "user/mine",
   "mypaint2/classic/charcoal", "mypaint1/deevad/rounded". A name without collection selects the first
   match in this order: user, wrinkle, mypaint2, mypaint1. */
#pragma once
#include "brush/preset.h"

typedef struct WrPresetEntry {
    char *id, *path;        /* owned by the library */
    const char *name;       /* id without its collection */
    const char *collection; /* "wrinkle", ... */
    char *group;            /* from order.conf or the folder; owned */
    char *picture;          /* path of a thumbnail, or NULL; owned */
} WrPresetEntry;

typedef struct WrLibrary WrLibrary;

/* Scans the folders without reading presets. Missing folders count as empty. The program's: "brushes"
 * beside the sources or the program's data; the user's: $XDG_DATA_HOME/wrinkle/brushes. */
WrLibrary *wr_library_new(void);
void wr_library_free(WrLibrary *library); /* NULL is allowed */
int wr_library_count(const WrLibrary *library);
const WrPresetEntry *wr_library_entry(const WrLibrary *library,
                                      int index); /* sorted by collection, then group */

/* The file of a name or id, or the name itself if it ends in .myb. The caller frees the path. Errors
 * include the searched places and the nearest name. */
char *wr_library_find(const char *name, WrError *err);
/* Finds and reads a preset. */
WrPreset *wr_library_read(const char *name, WrError *err);
/* The folder of the user's presets, created if missing. The caller frees it. */
char *wr_library_user_folder(WrError *err);
