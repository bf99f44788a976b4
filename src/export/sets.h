/* sets.h - the maps that another program wants of one cell, under the names that it looks for. One row in
   wr_export_sets a program; a row lists its maps, each an export of its own (export.h).
   Layer 6. */
#pragma once
#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrText WrText;

#define WR_SET_MAPS 4     /* of a set, at most */
#define WR_SET_SETTINGS 3 /* of a map, at most */
#define WR_SET_WORDS 16   /* of the user, at most */

typedef struct WrExportMap {
    const char *kind;                      /* of wr_export_kinds; NULL ends the list */
    const char *settings[WR_SET_SETTINGS]; /* "depth=8"; NULL ends the list */
    const char *prefix, *suffix;           /* around the cell's name; the suffix has the ending */
} WrExportMap;

typedef struct WrExportSet {
    const char *name, *help;
    WrExportMap maps[WR_SET_MAPS + 1];
} WrExportSet;

#define WR_EXPORT_SET_COUNT 9
extern const WrExportSet wr_export_sets[];
const WrExportSet *wr_export_set_find(const char *name); /* NULL if there is none */

/* What one set is asked for. */
typedef struct WrSetOrder {
    const WrExportSet *set;
    const char *folder; /* is there already */
    const char *name;   /* of the cell, in the files' names: no folder in it */
    const char *const *
        words; /* [word_count] "cell=2,1": for those maps that have the option; at least one must */
    int word_count;
} WrSetOrder;

/* Write all files of a set, or replace none: they are written and read back in a folder of their own inside
 * `folder`, then take their places; where one cannot, those before it go back.
 *
 * told   what was written, a line a file
 * Errors  those of wr_export; a word that no map of the set takes; a folder that cannot be written */
bool wr_export_set(const WrSetOrder *order, const WrDocument *document, WrPool *pool, WrText *told,
                   WrError *err);
