/* inner.h - the inside of a session, for the commands' functions only.
   Layer 6, private to src/command. */
#pragma once
#include "base/array.h"
#include "command/call.h"
#include "command/session.h"

/* What is replaced as a whole by open and reset, and put back where open fails. */
typedef struct WrSessionState {
    WrDocument *document;     /* owned */
    WR_ARRAY(char *) history; /* owned canonical lines of the commands that ran, oldest first */
    uint64_t revision, saved_revision;
    char *path; /* of the document file; owned; NULL: none */
} WrSessionState;

struct WrSession {
    WrSessionOptions options; /* isa is a copy, owned */
    WrSessionState state;
    char *folder;         /* of the script that is running; borrowed; NULL: the current folder */
    bool skip_outputs;    /* while a script is opened rather than run */
    bool loading;         /* the scene's lines of a document are running */
    WrImage *embedded;    /* while loading: the document's colour picture; borrowed; NULL: none */
    WrRenderer *renderer; /* made on first use; owned */

    WrStroke *stroke;          /* open stroke, or NULL; owned */
    WrCall *stroke_call;       /* its line so far; owned */
    WrDocument *stroke_before; /* snapshot from before it; owned */
};

/* Say something that is no failure. */
void wr_session_note(WrSession *session, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* `path` as a command of the running script means it for reading. Caller frees. */
char *wr_session_input_path(const WrSession *session, const char *path);
/* Put a new document (taken) in place of the old state, which is returned: then keep the new one as
   opened, or put the old one back. Either consumes *old. */
WrSessionState wr_session_begin_state(WrSession *session, WrDocument *document);
void wr_session_keep_state(WrSession *session, WrSessionState *old);
void wr_session_restore_state(WrSession *session, WrSessionState *old);
/* The layer that edits change, for writing. */
WrField *wr_session_field(WrSession *session);
void wr_session_replace_field(WrSession *session, WrField *field); /* takes it */
/* Put a changed clone in the document's place for its scene; takes it. */
void wr_session_replace_scene(WrSession *session, WrScene *scene);
/* Read the picture that a line names; checks its sha256= argument, or sets it. The caller owns it. */
WrImage *wr_session_read_image(WrSession *session, WrCall *call, const char *name, WrError *err);
/* The brush that a dab's or stroke's arguments describe. */
WrBrush wr_call_brush(const WrCall *call);

/* The commands' functions, by subject: see commands.c. */
typedef bool WrHandler(WrSession *session, WrCall *call, WrError *err);
WrHandler wr_run_table, wr_run_fill, wr_run_grid, wr_run_image; /* run_table.c */
WrHandler wr_run_dab, wr_run_stroke;                            /* run_brush.c */
WrHandler wr_run_analytic, wr_run_surface, wr_run_bump, wr_run_replicate,
    wr_run_rotate; /* run_shape.c */
WrHandler wr_run_material, wr_run_colour, wr_run_light, wr_run_camera,
    wr_run_dials;                                    /* run_look.c */
WrHandler wr_run_save, wr_run_export, wr_run_render; /* run_output.c */

/* The scene's canonical lines, by subject: scene_text.c. */
typedef void WrScenePrinter(const WrScene *scene, WrText *text);
WrScenePrinter wr_print_analytic, wr_print_surface, wr_print_bump, wr_print_replicate,
    wr_print_rotate, wr_print_material, wr_print_colour, wr_print_light, wr_print_camera,
    wr_print_dials;

/* Words of choices, index past the last gives NULL. */
const char *wr_camera_kind_name(int i);
