/* files.h - file dialog: the desktop's, by its portal (portal.h), while the window stays responsive, or a plain panel of the
   window. */
#pragma once
#include "base/enum_rows.h"

#include <SDL.h>
#include <stdbool.h>

typedef enum WrFilePurpose {
    WR_FILE_OPEN,
    WR_FILE_SAVE,
    WR_FILE_EXPORT,
    WR_FILE_RENDER,
    WR_FILE_FILM,
    WR_FILE_IMPORT,
    WR_FILE_HISTORY,
    WR_FILE_MACRO_SAVE,
    WR_FILE_MACRO,
    WR_FILE_STAMP,
    WR_FILE_GENERATE,
    WR_FILE_LOCATE,
    WR_FILE_TABLE, /* table of the active object */
    WR_FILE_COLOUR,
    WR_FILE_NORMALS,
    WR_FILE_ROUGHNESS,
    WR_FILE_METALNESS,
    WR_FILE_SURROUND,
    WR_FILE_MESH, /* mesh surface of the active object */
    WR_FILE_PATCHES,
    WR_FILE_TERRAIN, /* terrain heights of the active object */
    WR_FILE_GLTF,    /* materials and pictures of a glTF */
    WR_FILE_BAKE,    /* a detailed mesh for the active object's */
    WR_FILE_BRUSH,   /* not used in a dialog: a .myb file is dropped, or named at the start */
    WR_FILE_PRESET,  /* not used in a dialog: a preset's name is typed */
    WR_FILE_PURPOSES
} WrFilePurpose;

/* Kinds of file dialogs. AUTOMATIC: a native one if it answers soon, else the panel. DESKTOP: a native one, with a
   longer timeout. */
#define WR_FILE_WAYS(X)                                                                            \
    X(WR_FILE_WAY_AUTOMATIC, "Automatic")   /* the desktop's if it answers soon, else our own */   \
    X(WR_FILE_WAY_DESKTOP, "The desktop's") /* the same, and it is waited for longer */            \
    X(WR_FILE_WAY_OWN, "Wrinkle's own")
typedef enum WrFileWay { WR_FILE_WAYS(WR_WORD_ID) WR_FILE_WAY_COUNT } WrFileWay;

typedef struct WrFiles WrFiles;

/* done_event: an SDL event type, pushed when a native dialog was closed. */
WrFiles *wr_files_new(Uint32 done_event);
void wr_files_free(WrFiles *files); /* closes an open dialog */

/* Set the kind of the next dialogs. window: parent of the dialogs. */
void wr_files_choose_way(WrFiles *files, WrFileWay way);
void wr_files_set_window(WrFiles *files, SDL_Window *window);

/* Open a dialog. name: initial file name. True: a native dialog is open and the event will follow; false: there is
 * none, and the caller must draw the panel (wr_files_panel). */
bool wr_files_request_path(WrFiles *files, WrFilePurpose purpose, const char *folder,
                           const char *name);
/* To be called first after the event. True: answered or cancelled; false: the native dialog failed, and the caller must
 * draw the panel. */
bool wr_files_hear(WrFiles *files);
/* To be called after the event: the chosen path, or NULL if cancelled. Valid until the next dialog. A file to be
 * written has an extension: that of its kind if none was typed. */
const char *wr_files_answer(WrFiles *files, WrFilePurpose *purpose);
/* True if the native dialog has already confirmed overwriting an existing file. */
bool wr_files_agreed(const WrFiles *files);
bool wr_file_purpose_writes(WrFilePurpose purpose); /* true for a file to be written */

WrFilePurpose wr_files_purpose(const WrFiles *files);
/* The panel as a dialog, with a note above its buttons or "". recent: paths whose folders it offers, NULL-terminated;
 * read at its opening. Returns 0: still open, 1: chosen (wr_files_answer), -1: cancelled. */
int wr_files_panel(WrFiles *files, const char *note, char *const recent[]);

/* ---- shortcut folders and name filters of the file dialog ---- */

/* Tested without a window. */

typedef struct WrFilePlace {
    char *label, *path; /* owned */
    bool named;         /* the label is translatable, not a folder name */
} WrFilePlace;
#define WR_FILE_PLACES 9

/* The home folder, the folders of documents, pictures and downloads if they exist, and the folders of the paths in
 * `recent` (NULL-terminated), each once. Returns their number; the caller frees them (wr_file_places_free). */
int wr_file_places(const char *home, char *const recent[], WrFilePlace places[WR_FILE_PLACES]);
void wr_file_places_free(WrFilePlace places[], int count);

/* True if a file of that extension may be read for the purpose. All names fit if any file is allowed, or if the file
 * will be written. */
bool wr_file_fits(WrFilePurpose purpose, const char *name);
