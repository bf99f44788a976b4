/* files.h - asking for a file: with the desktop's own dialog (its portal, portal.h, or zenity or kdialog, run without a
   shell), while the window stays alive, or with a plain panel of our own. */
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
    WR_FILE_STAMP,
    WR_FILE_GENERATE,
    WR_FILE_TABLE, /* of the chosen object */
    WR_FILE_COLOUR,
    WR_FILE_NORMALS,
    WR_FILE_ROUGHNESS,
    WR_FILE_METALNESS,
    WR_FILE_SURROUND,
    WR_FILE_MESH, /* the chosen object's surface, */
    WR_FILE_PATCHES,
    WR_FILE_TERRAIN, /* and the ground's form */
    WR_FILE_GLTF,    /* its materials and pictures */
    WR_FILE_PRESET,  /* never asked for by itself: a preset's name is typed */
    WR_FILE_PURPOSES
} WrFilePurpose;

/* Who asks. */
#define WR_FILE_WAYS(X)                                                                            \
    X(WR_FILE_WAY_AUTOMATIC,                                                                       \
      "Automatic") /* whichever of the desktop's answers soon, else our own */                     \
    X(WR_FILE_WAY_DESKTOP, "The desktop's") /* the same, and it is waited for longer */            \
    X(WR_FILE_WAY_OWN, "Wrinkle's own")
typedef enum WrFileWay { WR_FILE_WAYS(WR_WORD_ID) WR_FILE_WAY_COUNT } WrFileWay;

typedef struct WrFiles WrFiles;

/* done_event: an SDL event type that is pushed when a native dialog was closed. */
WrFiles *wr_files_new(Uint32 done_event);
void wr_files_free(WrFiles *files); /* closes a dialog that is open */

/* How the next questions are asked. window: the dialogs belong to it. */
void wr_files_choose_way(WrFiles *files, WrFileWay way);
void wr_files_set_window(WrFiles *files, SDL_Window *window);

/* Ask. name: the file name that the field starts with. True: a native dialog is open and the event will
 * come; false: there is none, and the panel must be drawn instead (wr_files_panel). */
bool wr_files_ask(WrFiles *files, WrFilePurpose purpose, const char *folder, const char *name);
/* First after the event: what has become of the question. */
typedef enum WrFilesHeard {
    WR_FILES_ANSWERED, /* or cancelled */
    WR_FILES_AGAIN, /* that dialog did not come, or went away; another is open, and the event will come again */
    WR_FILES_PANEL /* none of the desktop's comes: the panel must be drawn */
} WrFilesHeard;
WrFilesHeard wr_files_hear(WrFiles *files);
/* After the event: the path chosen, or NULL if it was cancelled. Valid until the next ask. A file to be
 * written has an ending: that of its kind where none was typed. */
const char *wr_files_answer(WrFiles *files, WrFilePurpose *purpose);
/* The native dialog has asked whether that file may be replaced, if there is one. */
bool wr_files_agreed(const WrFiles *files);
bool wr_files_writes(WrFilePurpose purpose); /* it is a file to be written */

WrFilePurpose wr_files_purpose(const WrFiles *files);
/* The panel of our own, as a dialog, with a note above its buttons or "". recent: paths whose folders it offers, NULL ends
 * them; they are looked up when it opens. 0: still open, 1: chosen (wr_files_answer), -1: cancelled. */
int wr_files_panel(WrFiles *files, const char *note, char *const recent[]);
