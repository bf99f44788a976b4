/* session.h - the one door to a document. The window, the command line, scripts and tests all change a
   document by running command lines here; nothing else may.

   All that may take long tells the thread's own progress (base/progress.h) how far it is, and stops soon after
   that is cancelled: with the error "cancelled", and everything as it was before: the document, the history,
   the journal and all files. A script keeps what its finished lines did, as after any other failure.
   Layer 6. A session belongs to one thread; snapshots of it may be read by any. */
#pragma once
#include "accuracy/effect_savings.h"
#include "accuracy/tolerance.h"
#include "base/file_identity.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrFrame WrFrame;
typedef struct WrPool WrPool;
typedef struct WrSample WrSample;
typedef struct WrText WrText;

typedef struct WrSession WrSession;

/* What a command has to say besides failing: "3 texels were not finite and became 0". */
typedef void (*WrNoteSink)(void *ctx, const char *text);

#define WR_PICTURE_BYTES ((size_t)64 << 20) /* see below */

typedef struct WrSessionOptions {
    WrPool *pool;    /* borrowed; NULL: one thread */
    WrNoteSink note; /* may be NULL */
    void *note_ctx;
    bool foretell; /* a note before what needs much memory: how much */
    bool outputs;  /* perform output commands (only `wrinkle run` and the window do); otherwise
                             they are skipped with a note */
    bool
        full; /* pictures run what their plan could leave out, as a yardstick: WrFrameRequest.full */
    const char *isa; /* kernel set for renders: NULL or "auto"; copied, checked at first use */
    bool journal; /* keep a journal of the document, so that a crash loses at most the command under
                     way (document/journal.h) */
    bool
        composites; /* every command makes the composite too, so that nobody who looks at the document
                             afterwards has to: for the window */
    size_t picture_bytes; /* that rows of a picture may take on its way into a file, 64 of them
                             whatever it is; 0: WR_PICTURE_BYTES */
    bool smooth;          /* new documents have 2 x 2 samples a pixel, so that edges are no stairs;
                             else one. What a file says of its dials holds either way */
} WrSessionOptions;

/* Starts with an empty document. The caller owns it. */
WrSession *wr_session_new(const WrSessionOptions *options);
void wr_session_free(WrSession *session);

/* All that can be read of it as it is now, however another thread changes the session meanwhile: the document, the history,
   its file, whether the journal is safe. Nothing runs in it. It costs no more than the number of steps. The caller owns it. */
WrSession *wr_session_snapshot(const WrSession *session);

/* Change options.outputs. */
void wr_session_set_outputs(WrSession *session, bool outputs);

/* Replace the document by a file's: a document, a script (*.wrinkle, run from empty; its output commands
   are skipped with a note whatever the options say) or any picture with heights. Of a document of a newer
   version it takes what it understands, and a note says so. On failure the session keeps what it had. */
bool wr_session_open(WrSession *session, const char *path, WrError *err);
/* An empty document. */
void wr_session_reset(WrSession *session);

/* Run one command line. On failure the document is as it was before. Blank lines and comments do
   nothing. Relative file names are read from `folder` of the script that is running, else from the
   current folder. */
bool wr_session_run(WrSession *session, const char *line, WrError *err);
/* Run a line whose work is done already: `made` is the document as it is, shared, with its layers as the line
   makes them, which the caller vouches for; of a filter layer, what it makes of those below. Only lines that
   change nothing else and read no files: wr_session_takes_made. Steps, journal and all else go as in wr_session_run. */
bool wr_session_run_made(WrSession *session, const char *line, const WrDocument *made,
                         WrError *err);
bool wr_session_takes_made(const char *line);
/* Run a script file line by line; errors carry "file:line: ". Stops at the first failure: what ran
   before it stays. */
bool wr_session_run_script(WrSession *session, const char *path, WrError *err);
/* The same from an open stream (standard input), each line as soon as it is there. name stands for the
   file in errors; files are read relative to the current folder. */
bool wr_session_run_stream(WrSession *session, FILE *stream, const char *name, WrError *err);

/* A stroke in progress is an open command: `head` is a stroke command without points, such as
   "stroke radius=20 strength=0.1". Each sample is rounded to its printed text (u, v to 1e-7, pressure,
   tilt and seconds to 1e-4) and then applied at once; the finished line replays to the same bits. While
   it is open, run, open and go fail. It begins only on a layer that is shown and not locked, and keeps to
   the selection. A sample with a u or v that is not finite or beyond 1e9 is refused. */
bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err);
bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err);
/* The same in two steps, so that a large brush keeps nobody waiting: journal the samples and take them in,
   and draw what was taken in for about that long (at least one piece of work). True while more is left to
   draw. The bits do not depend on how the work was cut. */
bool wr_session_stroke_push(WrSession *session, const WrSample *samples, int count, WrError *err);
bool wr_session_stroke_work(WrSession *session, double seconds); /* false without a stroke */
/* Draws what is left. */
bool wr_session_stroke_end(WrSession *session, WrError *err); /* no samples: nothing happened */
void wr_session_stroke_cancel(
    WrSession *session); /* the document is as before it; fine without one */
bool wr_session_in_stroke(const WrSession *session);
/* Presets and tips that were read are kept, and read again only where their files changed; which file a
   preset's bare name means is looked up anew after this. For a program that has written a preset. */
void wr_session_forget_brushes(WrSession *session);

/* Borrowed until the next call that changes it. */
const WrDocument *wr_session_document(const WrSession *session);
/* The canonical text of the last command that is in force ("" if none), and the number of the state that
   it made: every state has its own, and going back brings the old one back. */
const char *wr_session_last_command(const WrSession *session);
uint64_t wr_session_revision(const WrSession *session);
/* Revision at the last save or open; the document is unsaved while they differ. */
uint64_t wr_session_saved_revision(const WrSession *session);
const char *wr_session_path(const WrSession *session); /* of the document file, "" if none */
/* What stands under that name now is not what was opened or saved here last: another program has written
   it since. False where nothing stands there. */
bool wr_session_file_changed(const WrSession *session);

/* A file that a line of this session has read - a picture, a mesh, a font, a brush - and what stood under its name
 * just before that was done first. Borrowed until the next call that changes the session. */
typedef struct WrSessionInput {
    const char *path;
    WrFileStamp stamp;
} WrSessionInput;
int wr_session_input_count(const WrSession *session);
WrSessionInput wr_session_input(const WrSession *session, int index);

/* ---- the journal ---- */

/* Change options.journal: from the next command on. */
void wr_session_set_journal(WrSession *session, bool journal);
/* True if every command so far can be recovered after a crash, or no journal is kept; else *reason says why
   not ("" if safe; valid until the next call). */
bool wr_session_journal_safe(const WrSession *session, const char **reason);
/* Would wr_session_journal_tend do something? */
bool wr_session_journal_wants(const WrSession *session);
/* When nothing else is to do: begin the journal anew from a snapshot if it has grown long, or if lines are
   missing since the disk was full. May take as long as a save. True if it did something. */
bool wr_session_journal_tend(WrSession *session);
/* Keep the journal for a recovery though the session ends (its work could not be saved). */
void wr_session_journal_leave(WrSession *session);

/* ---- what was done ---- */

/* Steps: the canonical lines of the edits and scene commands since the document was made or opened,
   oldest first, those that were undone and can be redone included. Views, output and history commands are
   not among them. */
int wr_session_history_count(const WrSession *session);
const char *wr_session_history_line(const WrSession *session, int index); /* "" out of range */
/* The heights of the active layer after `position` steps, 0 .. count, of that under it where it is a filter; NULL: they were
   given up. Borrowed until the next command. */
const WrField *wr_session_history_heights(const WrSession *session, int position);
/* How many of them are in force: steps 0 .. position - 1. */
int wr_session_history_position(const WrSession *session);
/* The lowest position that can be gone back to: older states were given up for the budget. */
int wr_session_history_oldest(const WrSession *session);
/* Go to the state after `position` steps, oldest .. count, bit for bit as it was; how it is looked at stays
   (document/history.h). The next edit drops the steps after it. Fails in a stroke. */
bool wr_session_go(WrSession *session, int position, WrError *err);

/* Views are no edits: they have a history of their own (the commands `camera`, `rotate` and `view`), and a
   document is not unsaved for them. How many can be gone back to, and forward. */
int wr_session_views_back(const WrSession *session);
int wr_session_views_forward(const WrSession *session);

/* Memory: what all kept steps cost, what one does (0 for those given up), and how much it may be: 1 GiB unless
   set. Oldest states go first; the last step can always be undone. */
size_t wr_session_history_bytes(const WrSession *session);
size_t wr_session_history_step_bytes(const WrSession *session, int index);
size_t wr_session_history_budget(const WrSession *session);
void wr_session_set_history_budget(WrSession *session, size_t bytes);

/* Write the steps that are in force as a script that makes the same document, hash and all; where the session
   opened a document, its first line opens that. Files are named relative to the script if they lie beside or
   below it, else by their whole paths. Works whatever options.outputs says. */
bool wr_session_save_history(WrSession *session, const char *path, WrError *err);

/* The scene as canonical command lines, which restore it from a new document. */
void wr_session_scene_text(const WrSession *session, WrText *text);
/* The document's hash: all that is saved (layers, selection, scene), but for the name of the colour picture's
   file, whose content counts. */
WrHash wr_session_hash(const WrSession *session);

/* A picture of the document as it is, by the scene's dials. turn_deg: turntable angle about the world's
   y axis. *frame is borrowed until the session's next picture. */
bool wr_session_frame(WrSession *session, int width, int height, double turn_deg, WrFrame *frame,
                      WrError *err);
/* What each effect costs that picture, and what leaving it out saves: takes seconds. Under a tolerance of its dials as
   they were chosen, without the choosing. */
bool wr_session_savings(WrSession *session, int width, int height, double turn_deg,
                        WrSaving savings[WR_EFFECT_COUNT], WrError *err);
/* Draw it once more, and note what each pixel took: map [height][width], bits of WrMapBit; 0 where blocks are left out
   that show nothing. */
bool wr_session_map(WrSession *session, int width, int height, double turn_deg, uint8_t *map,
                    WrError *err);
/* Where the scene has a tolerance: choose its dials once for all pictures of a turn, which the next ones of that size
   then have; a note tells what was chosen on which. */
bool wr_session_turn(WrSession *session, int width, int height, const double *turn_deg, int count,
                     WrError *err);
/* What the last picture chose under the scene's tolerance; count is 0 if it had none. */
const WrChoice *wr_session_choice(const WrSession *session);
/* The dials that the document keeps for its tolerance (wr_choice_write), or NULL. Valid until they change. */
const char *wr_session_chosen(const WrSession *session);
/* It keeps that text from now on; NULL: none. Saved only as long as table and scene are those that it is for. */
void wr_session_keep_chosen(WrSession *session, const char *text);
/* Where *choice is not for the request's picture: take kept dials (NULL: there are none), if they are. What they are not
   for, "table", "scene", "size" or "turn"; else NULL. For pictures of any renderer, in any thread. */
const char *wr_chosen_recall(const char *kept, const WrFrameRequest *request, WrChoice *choice);
/* A choice as the document keeps it. */
void wr_chosen_write(const WrChoice *choice, const WrFrameRequest *request, WrText *text);
/* The same to a file: linear float R, G, B, A (premultiplied, background 0) for exr, tif and tiff, else
   8-bit sRGB over the scene's background. A large one is drawn and written by bands of rows, the same bits;
   under a tolerance, which all of a picture keeps to together, it is held whole. Works whatever options.outputs
   says. */
bool wr_session_render(WrSession *session, const char *path, int width, int height, double turn_deg,
                       WrError *err);
/* The same into memory: 8-bit sRGB over the background, or with `alpha` over nothing, [height][width][3 or 4]. */
bool wr_session_pixels(WrSession *session, int width, int height, double turn_deg, bool alpha,
                       uint8_t *out, WrError *err);

/* Frames of a turntable: as many files where the path holds #### for the frame's number, else one film, of a kind that
   export/film.h has. */
typedef struct WrTurntable {
    int width, height; /* pixels */
    int first, last;   /* frames, 0 <= first <= last; frame f is turned by f steps */
    int of;            /* frames of the whole turn; 0: those are all */
    bool stepped;      /* `step_deg` is given; else a whole turn is divided among them */
    double step_deg;   /* a frame, about the world's y axis */
    double turn_deg;   /* of frame 0 */
    bool missing;      /* files that are there, whole, are left out */
    double fps;        /* of a film: frames a second; 0: not given, 25 */
    int loop;          /* of a film: how often it is played, 0: for ever; -1: not given, for ever */
} WrTurntable;
WrTurntable wr_turntable_default(void); /* 512x512, frames 1-120 */
/* Refuse what cannot be written, before a document is loaded for it. */
bool wr_turntable_check(const WrTurntable *turntable, const char *path, WrError *err);
bool wr_session_turntable(WrSession *session, const char *path, const WrTurntable *turntable,
                          WrError *err);
/* Is such a picture's file there, of that size, and can it be read to its end? What it shows nobody knows. */
bool wr_session_has_rendered(const WrSession *session, const char *path, int width, int height);
/* Save under that name; then path and saved_revision are set. Refuses to save over a file of a newer version
   that was opened here. Works whatever options.outputs says. */
bool wr_session_save(WrSession *session, const char *path, WrError *err);
