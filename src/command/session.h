/* session.h - the only write access to a document. The window, the command line, scripts and tests all change a
   document by running command lines here.

   Long operations report to the thread's progress (base/progress.h) and stop soon after it is cancelled. They then
   fail with the error "cancelled" and leave the document, the history, the journal and all files unchanged. A
   cancelled or failed script keeps the effect of its finished lines. A session belongs to one thread; any thread may
   read snapshots of it. */
#pragma once
#include "accuracy/effect_savings.h"
#include "accuracy/tolerance.h"
#include "base/file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrExportKind WrExportKind;
typedef struct WrFrame WrFrame;
typedef struct WrPool WrPool;
typedef struct WrRayTree WrRayTree;
typedef struct WrReceipt WrReceipt;
typedef struct WrSample WrSample;
typedef struct WrText WrText;
typedef struct WrTriangles WrTriangles;

typedef struct WrSession WrSession;

/* Callback for notes that are not errors: "3 texels were not finite and became 0". */
typedef void (*WrNoteSink)(void *ctx, const char *text);

/* Callback for receipts of files that commands have written; borrowed. */
typedef void (*WrReceiptSink)(void *ctx, const WrReceipt *receipt);

#define WR_PICTURE_BYTES ((size_t)64 << 20) /* default of picture_bytes */

typedef struct WrSessionOptions {
    WrPool *pool;    /* borrowed; NULL: one thread */
    WrNoteSink note; /* may be NULL */
    void *note_ctx;
    WrReceiptSink receipt; /* for each written file; may be NULL */
    void *receipt_ctx;
    bool note_messages; /* notes are messages (base/message.h), to be translated; else plain text */
    bool foretell;      /* note the required memory before a command that needs much */
    /* perform output commands (only `wrinkle run` and the window do); otherwise they are skipped
       with a note */
    bool outputs;
    /* pictures run the stages that their plan could skip, as a reference: WrFrameRequest.full */
    bool full;
    const char *isa; /* kernel set for renders: NULL or "auto"; copied, checked at first use */
    /* keep a journal of the document: a crash loses at most the running command
       (document/recovery_journal.h) */
    bool journal;
    /* every command also updates the composite, so that readers need not compute it; for the
       window */
    bool composites;
    /* memory for rows of a picture while it is written to a file; at least 64 rows; 0:
       WR_PICTURE_BYTES */
    size_t picture_bytes;
    /* new documents have 2 x 2 samples per pixel (anti-aliased edges); else one. Dials stored in a
       file take precedence */
    bool smooth;
} WrSessionOptions;

/* Starts with an empty document. The caller owns it. */
WrSession *wr_session_new(const WrSessionOptions *options);
void wr_session_free(WrSession *session);
/* A session of a copy of that document, without its history, journal and file: for the files of its variants. The caller
   owns it. */
WrSession *wr_session_of(const WrDocument *document, WrPool *pool);

/* A read-only snapshot of the document, the history, its file name and the journal's state; unaffected by later
   changes of the session in another thread. Commands are rejected. The cost is proportional to the number of steps.
   The caller owns it. */
WrSession *wr_session_snapshot(const WrSession *session);

/* A snapshot becomes a session of its own, with its history, in the thread that calls this; without a journal. */
void wr_session_let_run(WrSession *snapshot, WrPool *pool);

/* Change options.outputs. */
void wr_session_set_outputs(WrSession *session, bool outputs);

/* Replace the document by the content of a file: a document, a script (*.wrinkle, run from empty; its output commands
   are skipped with a note whatever options.outputs is) or any picture with heights. From a document of a newer
   version, only the known parts are loaded, with a note. On failure the session is unchanged. */
bool wr_session_open(WrSession *session, const char *path, WrError *err);
/* Replace the document by an empty one. */
void wr_session_reset(WrSession *session);

/* Run one command line. On failure the document is unchanged. Blank lines and comments do nothing. Relative file
   names are resolved in the folder of the running script, else in the current folder. */
bool wr_session_run(WrSession *session, const char *line, WrError *err);
/* Run a line whose result is already computed. `made` shares the current document, with its layers as the line would
   change them (of a filter layer: its result over the layers below); the caller guarantees that. Allowed only for
   lines that change nothing else and read no files: wr_session_takes_made. Steps, journal and all else are the same
   as in wr_session_run. */
bool wr_session_run_made(WrSession *session, const char *line, const WrDocument *made,
                         WrError *err);
bool wr_session_takes_made(const char *line);
/* Run a script file line by line; errors begin with "file:line: ". Stops at the first failure; the effect of earlier
   lines remains. */
bool wr_session_run_script(WrSession *session, const char *path, WrError *err);
/* Run a script from an open stream (standard input), each line as soon as it arrives. `name` replaces the file name
   in errors; relative file names are resolved in the current folder. */
bool wr_session_run_stream(WrSession *session, FILE *stream, const char *name, WrError *err);

/* Prepare strokes on the active object's mesh, which take a second for a million triangles; else the first stroke
   does. The document stays as it is. */
bool wr_session_mesh_needs_preparing(const WrSession *session);
bool wr_session_prepare_mesh(WrSession *session, WrError *err);
/* The ray tree of that mesh if it is prepared, else NULL. Borrowed until the next stroke or command. */
const WrRayTree *wr_session_mesh_tree(const WrSession *session, const WrTriangles *mesh);

/* A stroke in progress is an open command: `head` is a stroke command without points, such as "stroke radius=20
   strength=0.1". Each sample is rounded to its printed text (u, v to 1e-7, pressure, tilt and seconds to 1e-4, turn
   to 0.01 degrees) and then applied at once; replaying the finished line is bit-identical. While a stroke is open, run, open and go
   fail.
   The active layer must be visible and unlocked; the stroke is limited to the selection. A sample with a u or v that
   is not finite or beyond 1e9 is refused. */
bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err);
bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err);
/* wr_session_stroke_add in two steps, so that a large brush does not block the caller: push journals and queues the
   samples; work draws queued samples for about `seconds` (at least one unit of work) and returns true while more is
   left. The result does not depend on the division of the work. */
bool wr_session_stroke_push(WrSession *session, const WrSample *samples, int count, WrError *err);
bool wr_session_stroke_work(WrSession *session, double seconds); /* false without a stroke */
/* Number of the stroke's samples that the table holds; 0 without a stroke. */
int64_t wr_session_stroke_drawn(const WrSession *session);
/* End the stroke after drawing all queued samples. A stroke without samples has no effect. */
bool wr_session_stroke_end(WrSession *session, WrError *err);
void wr_session_stroke_cancel(
    WrSession *session); /* restores the document; without a stroke nothing happens */
bool wr_session_in_stroke(const WrSession *session);

/* The document; borrowed until the next call that changes the session. */
const WrDocument *wr_session_document(const WrSession *session);
/* True if the active layer, or its mask while that is edited, can be painted on; else the error is the reason: locked, hidden,
   or a filter. */
bool wr_session_check_layer(const WrSession *session, WrError *err);
/* True if layer `index` (from 0) is unlocked; else the error names it. */
bool wr_session_check_unlocked(const WrSession *session, int index, WrError *err);
/* The canonical text of the last command in force ("" if none), and the number of the state after it. Each state has
   a unique number; undo returns to the earlier number. */
const char *wr_session_last_command(const WrSession *session);
uint64_t wr_session_revision(const WrSession *session);
/* Revision at the last save or open; the document is unsaved if it differs from wr_session_revision. */
uint64_t wr_session_saved_revision(const WrSession *session);
const char *wr_session_path(const WrSession *session); /* path of the document file, "" if none */
/* The name of a file to write: <UDIM> in it becomes the number of the object's tile (base/udim.h). The caller frees it.
   NULL and an error: the object has no tile. */
char *wr_session_output_name(const WrSession *session, const char *path, WrError *err);
/* True if another program has changed the document file since it was opened or saved here. False if the file does not
   exist. */
bool wr_session_file_changed(const WrSession *session);

/* A file read by a line of this session (picture, mesh, font or brush), and its identity just before the first read.
 * Borrowed until the next call that changes the session. */
typedef struct WrSessionInput {
    const char *path;
    WrFileIdentity stamp;
} WrSessionInput;
/* An error if an export of this kind would replace such a file by a solid or a model. */
bool wr_session_check_export(const WrSession *session, const WrExportKind *kind, const char *path,
                             WrError *err);
int wr_session_input_count(const WrSession *session);
WrSessionInput wr_session_input(const WrSession *session, int index);

/* ---- the journal ---- */

/* Change options.journal; takes effect at the next command. */
void wr_session_set_journal(WrSession *session, bool journal);
/* True if every command so far can be recovered after a crash, or no journal is kept. Else *reason is the cause (""
   if safe; valid until the next call). */
bool wr_session_journal_safe(const WrSession *session, const char **reason);
/* True if wr_session_journal_compact has work to do. */
bool wr_session_journal_needs_compacting(const WrSession *session);
/* Idle-time upkeep: restart the journal from a snapshot if it has grown long, or if lines are missing because the
   disk was full. May take as long as a save. True if it did something. */
bool wr_session_journal_compact(WrSession *session);
/* Keep the journal for recovery when the session ends (its work could not be saved). */
void wr_session_journal_leave(WrSession *session);

/* ---- history ---- */

/* Steps: canonical lines of the edits and scene commands since the document was created or opened, oldest first,
   including undone ones that can be redone. View, output and history commands are not steps, nor is the choice of a
   layer. The command `step` changes earlier steps. */
int wr_session_history_count(const WrSession *session);
const char *wr_session_history_line(const WrSession *session, int index); /* "" out of range */
bool wr_session_history_is_off(const WrSession *session, int index); /* switched off: no effect */
/* Running time of the steps in force from this one on, measured when they ran, in seconds. */
double wr_session_history_seconds(const WrSession *session, int index);
/* Steps that `undo` and `redo` can go: a change of a step (command `step`) is one of them. */
int wr_session_undo_count(const WrSession *session);
int wr_session_redo_count(const WrSession *session);
/* Heights of the active layer after `position` steps, 0 .. count; for a filter layer, those of the layer below it.
   NULL if that state was dropped. Borrowed until the next command. */
const WrField *wr_session_history_heights(const WrSession *session, int position);
/* Number of steps in force: 0 .. position - 1. */
int wr_session_history_position(const WrSession *session);
/* The lowest position that undo can reach; older states were dropped to stay within the memory budget. */
int wr_session_history_oldest(const WrSession *session);
/* Go to the state after `position` steps, oldest .. count, bit-identical; the view is unchanged (document/history.h).
   The next edit drops the later steps. Fails during a stroke. */
bool wr_session_history_go(WrSession *session, int position, WrError *err);
/* The command line that does it. */
#define WR_GO_LINE 32
void wr_session_history_go_line(const WrSession *session, int position, char line[WR_GO_LINE]);

/* Numbers of views that can be undone and redone. Views are not edits: they have their own history (commands
   `camera`, `rotate` and `view`) and do not make a document unsaved. */
int wr_session_view_undo_count(const WrSession *session);
int wr_session_redoable_views(const WrSession *session);

/* Memory of all kept steps, memory of one step (0 if dropped), and the budget in bytes: 1 GiB by default. The oldest
   states are dropped first; the last step can always be undone. */
size_t wr_session_history_bytes(const WrSession *session);
size_t wr_session_history_step_bytes(const WrSession *session, int index);
size_t wr_session_history_budget(const WrSession *session);
void wr_session_set_history_budget(WrSession *session, size_t bytes);

/* Write the steps in force as a script that recreates the document with the same hash. If the session opened a
   document, the first line opens it. File names are relative to the script if the files are in its folder or below,
   else absolute. Works whatever options.outputs is. */
bool wr_session_save_history(WrSession *session, const char *path, WrError *err);

/* The scene as canonical command lines that restore it from a new document. */
void wr_session_scene_text(const WrSession *session, WrText *text);
/* Hash of all saved data (layers, selection, scene). Of the colour picture its content counts, not its file name. */
WrHash wr_session_hash(const WrSession *session);

/* Render the document with the scene's dials. turn_deg: turntable angle about the world's y axis. *frame is borrowed
   until the session's next picture. */
bool wr_session_frame(WrSession *session, int width, int height, double turn_deg, WrFrame *frame,
                      WrError *err);
/* Cost of each effect in that picture, and the saving without it; needs seconds. Under a tolerance the already chosen
   dials are used; the choice is not part of the measurement. */
bool wr_session_savings(WrSession *session, int width, int height, double turn_deg,
                        WrSaving savings[WR_EFFECT_COUNT], WrError *err);
/* Render again and record the effects of each pixel: map [height][width], bits of WrMapBit; 0 in skipped blocks that
   show nothing. */
bool wr_session_map(WrSession *session, int width, int height, double turn_deg, uint8_t *map,
                    WrError *err);
/* Dials chosen for the last picture under the scene's tolerance; its dials are NULL if it had none. */
const WrChoice *wr_session_choice(const WrSession *session);
/* Stored dials of the document for its tolerance (wr_choice_write), or NULL. Valid until they change. */
const char *wr_session_chosen(const WrSession *session);
/* Store that text in the document; NULL: none. It is saved only while the table and the scene are the ones it was
   made for. */
void wr_session_keep_chosen(WrSession *session, const char *text);
/* If *choice does not fit the request's picture, use the stored dials `kept` (NULL: none) if they fit. Returns the
   cause if they do not, "table", "scene", "size" or "turn"; else NULL. Works with pictures of any renderer, in any
   thread. */
const char *wr_chosen_recall(const char *kept, const WrFrameRequest *request, WrChoice *choice);
/* Text form of a choice for storage in the document. */
void wr_chosen_write(const WrChoice *choice, const WrFrameRequest *request, WrText *text);
/* Rows of a picture, counted from 0 at its top. */
typedef struct WrPictureRows {
    int first, count;
} WrPictureRows;
/* Render to a file: linear float R, G, B, A (premultiplied, background 0) for exr, tif and tiff, else 8-bit sRGB over
   the scene's background. Large pictures are rendered and written in bands of rows, with the same result. Under a
   tolerance the whole picture is kept in memory, since the error bound applies to all of it. Works whatever
   options.outputs is. rows: the only ones to be written, with the same pixels as in the whole picture; NULL: all. */
bool wr_session_render(WrSession *session, const char *path, int width, int height,
                       const WrPictureRows *rows, double turn_deg, WrError *err);

/* Frames of a turntable. A path with #### for the frame number makes one file for each frame; any other path makes
   one film, of a format in export/film.h. */
typedef struct WrTurntable {
    int width, height; /* pixels */
    int first, last;   /* frames, 0 <= first <= last; frame f is rotated by f steps */
    int of;            /* frames of the whole turn; 0: the number of frames above */
    bool stepped;      /* `step_deg` is given; else a whole turn is divided evenly */
    double step_deg;   /* per frame, about the world's y axis */
    double turn_deg;   /* of frame 0 */
    bool missing;      /* skip frames whose files exist and are complete */
    double fps;        /* film: frames per second; 0: not given, 25 */
    int loop;          /* film: number of loops, 0: endless; -1: not given, endless */
} WrTurntable;
WrTurntable wr_turntable_default(void); /* 512x512, frames 1-120 */
/* Check the settings and the path before a document is loaded. */
bool wr_turntable_check(const WrTurntable *turntable, const char *path, WrError *err);
bool wr_session_turntable(WrSession *session, const char *path, const WrTurntable *turntable,
                          WrError *err);
/* True if that picture file exists, has that size and can be read to its end. Its content is not checked. */
bool wr_session_has_rendered(const WrSession *session, const char *path, int width, int height);
/* Save to that path; sets path and saved_revision. Refuses to overwrite a file of a newer version that was opened
   here. Works whatever options.outputs is. */
bool wr_session_save(WrSession *session, const char *path, WrError *err);
