/* map_sets.h - sets of maps of one cell for other programs, with the file names that they expect. A set is text,
   one map a line; those of known programs are rows of wr_map_set_rows, the user's are files NAME.set in the folder
   `sets` of the user's settings ($XDG_CONFIG_HOME/wrinkle, base/file.h):

     # a comment
     about purpose of the set
     material mtlx,usda
     normal-y T_*_N.png depth=8
     height T_*_H.png depth=16 range=signed

   A line has a kind of wr_export_kinds, the file's name with a star for the cell's name, and settings of that
   kind. `material` names the material files that are written besides (material_files.h). Such files are untrusted: names cannot contain folders, and every line is validated before anything is
   written. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrExportKind WrExportKind;
typedef struct WrExportOptions WrExportOptions;
typedef struct WrPool WrPool;
typedef struct WrReceipts WrReceipts;
typedef struct WrText WrText;

#define WR_MAP_SET_ENTRIES_MAX 32 /* maximum maps of a set */
#define WR_MAP_SET_SETTINGS_MAX 8 /* maximum settings of a map */
#define WR_MAP_SET_WORDS_MAX 16   /* maximum words of the user */
#define WR_MAP_SET_FILE_MAX 65536 /* maximum bytes of a set's file */
#define WR_MAP_SET_NAME_MAX 40    /* maximum letters of a set's name */
#define WR_MAP_SETS_MAX 256       /* maximum files of the folder that are read */

typedef struct WrMapSetEntry {
    const WrExportKind *kind;
    /* parts of the file's name around the cell's name; owned; after includes the extension */
    char *before, *after;
    char *settings[WR_MAP_SET_SETTINGS_MAX]; /* "depth=8"; owned; NULL ends the list */
} WrMapSetEntry;

typedef struct WrMapSet {
    char *name, *about; /* owned */
    bool own;           /* defined by the user */
    unsigned
        materials; /* bits of wr_material_formats that are written besides, unless `material=` names others */
    WR_ARRAY(WrMapSetEntry) maps;
} WrMapSet;

/* The sets of known programs. */
typedef struct WrMapSetRow {
    const char *name, *about, *maps;
} WrMapSetRow;
#define WR_MAP_SET_ROWS 10
extern const WrMapSetRow wr_map_set_rows[];
/* Their names in order, for help texts. */
#define WR_MAP_SET_NAMES                                                                           \
    "blender, gltf, unreal, unity, godot, substance, renderman, arnold, povray, blender-live"

/* The set of that name; the user's have priority. Owned by the caller (wr_map_set_free). NULL and an error: there is
   none, with a list of the existing ones; or its file is invalid, with file and line. */
WrMapSet *wr_map_set_find(const char *name, WrError *err);
void wr_map_set_free(WrMapSet *set); /* NULL is fine */
/* Parses a set from text; errors begin with "where:line: ". */
WrMapSet *wr_map_set_parse(const char *name, const char *text, const char *where, WrError *err);

/* All names: built-in ones in the table's order, then the user's in theirs. */
typedef struct WrMapSetNames {
    WR_ARRAY(char *) names; /* owned */
} WrMapSetNames;
WrMapSetNames wr_map_set_names(void);
void wr_map_set_names_free(WrMapSetNames *names);

/* Request to write one set. */
typedef struct WrMapSetRequest {
    const WrMapSet *set;
    const char *folder; /* must exist */
    const char *name;   /* of the cell, used in the files' names: without a folder */
    const char *const *
        words; /* [word_count] "cell=2,1": applied to the maps that have the option; at least one must.
                  "contact=FILE": a contact sheet beside them. "material=mtlx,gltf", "all" or "none": material files beside them, instead of the set's. "udim=1002" or "udim=none": tile before the endings of the files' names, instead of the object's */
    int word_count;
    WrReceipts *receipts; /* receives one for each file; NULL: none are wanted */
} WrMapSetRequest;

/* Options of one map: the set's settings, then the words. False and a message: a word that the map's kind
   refuses. */
bool wr_map_set_options(const WrMapSetRequest *order, int map, WrExportOptions *options,
                        WrError *err);
/* Path of one map: FOLDER/T_clay_N.png, of a tile FOLDER/T_clay_N.1002.png */
void wr_map_set_file(const WrMapSetRequest *order, const WrDocument *document, int map,
                     WrText *path);

/* Writes all files of a set, or replaces none (base/file.h, wr_file_group_begin): each is written and verified,
   then all are renamed.

   list    list of the written files, one per line
   Errors  those of wr_export; a word that no map of the set accepts; a read-only folder; a cell's name with
           a slash or a control character */
bool wr_export_map_set(const WrMapSetRequest *order, const WrDocument *document, WrPool *pool,
                       WrText *list, WrError *err);
/* The cell's name from a file's name, without folder and extension; NULL or "": "wrinkle". */
void wr_map_set_cell_name(const char *path, WrText *name);
