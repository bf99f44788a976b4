/* document.h - document commands of the window: new, open, save, and the question before unsaved work is lost. */
#pragma once
#include "ui/app/state/line.h"
#include "ui/app/state/app_state.h"
#include "ui/app/jobs/files.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Action to continue with after the question about unsaved work. */
typedef enum WrAfter {
    WR_AFTER_NOTHING,
    WR_AFTER_NEW,
    WR_AFTER_OPEN,
    WR_AFTER_PATH,
    WR_AFTER_LINES, /* after_path holds command lines */
    WR_AFTER_QUIT
} WrAfter;

/* Range mapped to the integer values of exported heights. */
enum { WR_RANGE_AUTO, WR_RANGE_UNIT, WR_RANGE_SIGNED, WR_RANGES };

typedef struct WrForms { /* values of open dialogs */
    double film_width, film_height, film_frames, film_fps;
    double width, height, picture_width, picture_height, fill, cells_u, cells_v, line_width, low,
        high;
    bool all_variants;                               /* export a file for each variant */
    double solid_size, solid_error, solid_thickness; /* mm; thickness 0: default of the export */
    double mesh_size;                                /* mm; 0: the file's unit */
    int mesh_round, mesh_limited;                    /* of a mesh as a solid: 0 or 1 */
    char export_more[200];                           /* further options of the line, as typed */
    char bake_file[4096];                            /* detailed mesh to bake; "": none */
    int bake_map, bake_match, bake_size; /* WrBakeKind; 0 or 1; texels a side, 0: as the table */
    double bake_cage;                    /* 0: automatic */
    double bake_samples, bake_padding;
    int film_kind;         /* index into wr_film_kinds */
    int wrap, kind, range; /* range: a WR_RANGE_ value */
    bool fit;
    WrNewForm fresh; /* new document */
} WrForms;

/* Data of the window about the document, besides the session. */
typedef struct WrDocumentState {
    WrAfter after;
    char *after_path;    /* owned */
    char *picture;       /* picture whose heights were opened; owned, NULL: none */
    const char *opening; /* file being opened; borrowed, NULL: none */
    /* additional revision that counts as saved: a starter made by commands */
    uint64_t clean_revision;
    bool starter;          /* the document is the starter */
    bool unread;           /* the requested document could not be opened */
    struct WrAhead *ahead; /* starter being loaded; owned */
} WrDocumentState;

void wr_app_compact_journal(WrApp *app); /* idle-time upkeep of the journal */
/* Load the starter document, if nothing else was requested, on a separate thread while the window opens. No other
   code may use the session until wr_app_start or wr_app_start_join. */
void wr_app_start_ahead(WrApp *app);
/* Open the starter, or the requested document, which may continue in the background. False: it cannot be opened. */
bool wr_app_start(WrApp *app, WrError *err);
void wr_app_start_join(WrApp *app); /* wait for the thread; may be called at any time */
void wr_app_new_document(WrApp *app);
void wr_app_open(WrApp *app);
void wr_app_open_path(WrApp *app, const char *path); /* with the question about unsaved work */
/* Run command lines on the document, one step each; not inside a frame. A failure becomes a message. */
void wr_app_add_lines(WrApp *app, const char *lines);
/* New document by command lines, with the question about unsaved work. */
void wr_app_open_lines(WrApp *app, const char *lines);
/* New document by command lines, without the question. */
void wr_app_new_of(WrApp *app, const char *lines);
bool wr_app_save(WrApp *app); /* false: not saved yet (a dialog is open, or it failed) */
void wr_app_save_as(WrApp *app);
void wr_app_save_history(WrApp *app); /* opens a file dialog */
/* Reset data that belonged to the previous document. */
void wr_app_changed_document(WrApp *app);
void wr_app_quit(WrApp *app);
void wr_app_go_on(WrApp *app); /* continue with `after` */
/* Handle the file name of a file dialog: read the file, or write it after the question about overwriting. */
void wr_app_file_chosen(WrApp *app, WrFilePurpose purpose, const char *path);
/* Handlers for each purpose, without the question. */
void wr_file_take_open(WrApp *app, const char *path);
void wr_file_take_save(WrApp *app, const char *path);
void wr_file_take_import(WrApp *app, const char *path);
void wr_file_take_gltf(WrApp *app, const char *path);
void wr_app_choose_gltf(WrApp *app);    /* choose a file whose material the active object gets */
void wr_app_choose_mesh(WrApp *app);    /* choose a mesh that the active object becomes */
bool wr_app_can_bake(const WrApp *app); /* the active object is a mesh of a file */
void wr_file_take_export(WrApp *app, const char *path);
void wr_file_take_history(WrApp *app, const char *path);
