/* library.h - where presets are found.
   A preset's id is its collection and its path without ending: "wrinkle/groove", "user/mine",
   "mypaint2/classic/charcoal", "mypaint1/deevad/rounded". A name without collection means the first that
   has it, in that order: user, wrinkle, mypaint2, mypaint1. */
#pragma once
#include "brush/preset.h"

typedef struct WrPresetEntry {
    char *id, *path;        /* owned by the library */
    const char *name;       /* id without its collection */
    const char *collection; /* "wrinkle", ... */
    char *group;            /* as order.conf or the folder says; owned */
    char *picture;          /* a thumbnail's file beside it, NULL without; owned */
} WrPresetEntry;

typedef struct WrLibrary WrLibrary;

/* Looks through the folders; reads no preset yet. Folders that are not there are simply empty. Our own:
 * "brushes" beside the sources or the program's data; the user's: $XDG_DATA_HOME/wrinkle/brushes. */
WrLibrary *wr_library_new(void);
void wr_library_free(WrLibrary *library); /* NULL is fine */
int wr_library_count(const WrLibrary *library);
const WrPresetEntry *wr_library_entry(const WrLibrary *library,
                                      int index); /* by collection, then group */

/* The file that a name or id means; or, where it ends with .myb, that file itself. The caller frees the
 * path. Error: what was looked for, and the nearest name. */
char *wr_library_find(const char *name, WrError *err);
/* Find and read it. */
WrPreset *wr_library_read(const char *name, WrError *err);
/* The folder of the user's own presets, made if it is not there. The caller frees it. */
char *wr_library_user_folder(WrError *err);
