/* document.h - the document behind the window: new, open, save, and what is asked before work is lost. */
#pragma once
#include "ui/state/new_lines.h"
#include "ui/state/app_state.h"
#include "ui/jobs/files.h"

#include <stdbool.h>
#include <stdint.h>

/* What to do once unsaved work is dealt with. */
typedef enum WrAfter {
    WR_AFTER_NOTHING,
    WR_AFTER_NEW,
    WR_AFTER_OPEN,
    WR_AFTER_PATH,
    WR_AFTER_LINES, /* after_path holds commands, a line each */
    WR_AFTER_QUIT
} WrAfter;

/* What the codes of exported heights hold. */
enum { WR_RANGE_AUTO, WR_RANGE_UNIT, WR_RANGE_SIGNED, WR_RANGES };

typedef struct WrForms { /* what the dialogs hold while they are open */
    double film_width, film_height, film_frames, film_fps;
    double width, height, picture_width, picture_height, fill, cells_u, cells_v, line_width, low,
        high;
    double solid_size, solid_error, solid_thickness; /* mm; thickness 0: as the export thinks fit */
    char export_more[200]; /* further options of the line, as they are typed */
    int film_kind;         /* of wr_film_kinds */
    int wrap, kind, range; /* range: a WR_RANGE_ */
    bool fit;
    WrNewForm fresh; /* of a new document */
} WrForms;

/* What the window knows of the document beside the session. */
typedef struct WrDocumentHand {
    WrAfter after;
    char *after_path;        /* owned */
    char *picture;           /* whose heights were opened; owned, NULL: none */
    uint64_t clean_revision; /* also counts as saved: a starter made by commands */
    bool starter;            /* the document is the starter */
    struct WrAhead *ahead;   /* it is being made; owned */
} WrDocumentHand;

void wr_app_tend(WrApp *app); /* the journal, when nothing else is to do */
/* The starter, where nothing else was asked for, is made on a thread of its own while the window opens: until start or
   start_end nobody else touches the session. */
void wr_app_start_ahead(WrApp *app);
void wr_app_start(WrApp *app);     /* the starter is there, or what was asked for */
void wr_app_start_end(WrApp *app); /* waits for it; may be called at any time */
void wr_app_new(WrApp *app);
void wr_app_open(WrApp *app);
void wr_app_open_path(WrApp *app, const char *path); /* asks first if work is unsaved */
/* The same for a new document that command lines make. */
void wr_app_open_lines(WrApp *app, const char *lines);
/* The same without asking. */
void wr_app_new_of(WrApp *app, const char *lines);
bool wr_app_save(WrApp *app); /* false: not saved yet (a dialog is open, or it failed) */
void wr_app_save_as(WrApp *app);
void wr_app_save_history(WrApp *app); /* asks for the file */
/* The document is another one: forget what belonged to the old one. */
void wr_app_changed_document(WrApp *app);
void wr_app_quit(WrApp *app);
void wr_app_go_on(WrApp *app); /* with `after` */
/* A dialog gave that name: read it, or write it, after asking where another file would go. */
void wr_app_file_chosen(WrApp *app, WrFilePurpose purpose, const char *path);
/* Without asking, for each purpose. */
void wr_file_take_open(WrApp *app, const char *path);
void wr_file_take_save(WrApp *app, const char *path);
void wr_file_take_import(WrApp *app, const char *path);
void wr_file_take_gltf(WrApp *app, const char *path);
void wr_app_ask_gltf(WrApp *app); /* for the file whose material the object at hand shall have */
void wr_file_take_export(WrApp *app, const char *path);
void wr_file_take_history(WrApp *app, const char *path);
