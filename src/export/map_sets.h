/* map_sets.h - the maps that another program wants of one cell, under the names that it looks for. A set is text, one
   map a line; those of known programs are rows of wr_set_rows, a user's own are files NAME.set in the folder `sets`
   of the user's settings ($XDG_CONFIG_HOME/wrinkle, base/file.h):

     # a comment
     about what it is for
     normal-y T_*_N.png depth=8
     height T_*_H.png depth=16 range=signed

   that is: a kind of wr_export_kinds, the file's name with a star where the cell's comes, settings of that kind.
   Such files are taken for hostile: names lead to no other folder, every line is looked at before anything is written.
   Layer 6. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrExportKind WrExportKind;
typedef struct WrExportOptions WrExportOptions;
typedef struct WrPool WrPool;
typedef struct WrText WrText;

#define WR_SET_MAPS 32         /* of a set, at most */
#define WR_SET_SETTINGS 8      /* of a map, at most */
#define WR_SET_WORDS 16        /* of the user, at most */
#define WR_SET_FILE_MOST 65536 /* bytes of a set's file */
#define WR_SET_NAME 40         /* letters of a set's name, at most */
#define WR_SETS_MOST 256       /* files in the folder that are looked at */

typedef struct WrSetMap {
    const WrExportKind *kind;
    char *before, *after; /* the cell's name in the file's; owned; after has the ending */
    char *settings[WR_SET_SETTINGS]; /* "depth=8"; owned; NULL ends the list */
} WrSetMap;

typedef struct WrSet {
    char *name, *about; /* owned */
    bool own;           /* the user's */
    WR_ARRAY(WrSetMap) maps;
} WrSet;

/* Those of known programs. */
typedef struct WrSetRow {
    const char *name, *about, *maps;
} WrSetRow;
#define WR_SET_ROWS 9
extern const WrSetRow wr_set_rows[];

/* The set of that name; a user's own goes before ours. The caller's (wr_set_free). NULL and an error: there is none,
 * with those that there are; or its file is not right, with file and line. */
WrSet *wr_set_find(const char *name, WrError *err);
void wr_set_free(WrSet *set); /* NULL is fine */
/* The same from text; errors begin with "where:line: ". */
WrSet *wr_set_parse(const char *name, const char *text, const char *where, WrError *err);

/* All names: ours in the table's order, then the user's in theirs. */
typedef struct WrSetNames {
    WR_ARRAY(char *) names; /* owned */
} WrSetNames;
WrSetNames wr_set_names(void);
void wr_set_names_free(WrSetNames *names);

/* What one set is asked for. */
typedef struct WrSetOrder {
    const WrSet *set;
    const char *folder; /* is there already */
    const char *name;   /* of the cell, in the files' names: no folder in it */
    const char *const *
        words; /* [word_count] "cell=2,1": for those maps that have the option; at least one must. "contact=FILE":
                  a contact sheet beside them */
    int word_count;
} WrSetOrder;

/* The options of that map: the set's settings, then the words. False and a message: a word that the map's kind refuses. */
bool wr_set_options(const WrSetOrder *order, int map, WrExportOptions *options, WrError *err);
/* FOLDER/T_clay_N.png */
void wr_set_file(const WrSetOrder *order, int map, WrText *path);

/* Write all files of a set, or replace none (base/file.h, wr_file_group_begin): each is written and read back, then all
 * take their places.
 *
 * told    what was written, a line a file
 * Errors  those of wr_export; a word that no map of the set takes; a folder that cannot be written; a cell's name with
 *         a slash or a control character */
bool wr_export_set(const WrSetOrder *order, const WrDocument *document, WrPool *pool, WrText *told,
                   WrError *err);
/* A file's name without folder and ending, for the cell; NULL or "": "wrinkle". */
void wr_set_cell_name(const char *path, WrText *name);
