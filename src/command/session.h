/* session.h - the one door to a document. The window, the command line, scripts and tests all change a
   document by running command lines here; nothing else may.
   Layer 6. A session belongs to one thread; snapshots of it may be read by any. */
#pragma once
#include "base/pool.h"
#include "brush/brush.h"
#include "document/document.h"
#include "render/frame.h"

typedef struct WrSession WrSession;

/* What a command has to say besides failing: "3 texels were not finite and became 0". */
typedef void (*WrNoteSink)(void *ctx, const char *text);

typedef struct WrSessionOptions {
    WrPool *pool;    /* borrowed; NULL: one thread */
    WrNoteSink note; /* may be NULL */
    void *note_ctx;
    bool outputs;    /* perform output commands (only `wrinkle run` and the window do); otherwise
                             they are skipped with a note */
    const char *isa; /* kernel set for renders: NULL or "auto"; copied, checked at first use */
    const volatile int *cancel; /* may be NULL; non-zero: scripts and renders stop with an error */
} WrSessionOptions;

/* Starts with an empty document. The caller owns it. */
WrSession *wr_session_new(const WrSessionOptions *options);
void wr_session_free(WrSession *session);

/* Change options.outputs. */
void wr_session_set_outputs(WrSession *session, bool outputs);

/* Replace the document by a file's: a document, a script (*.wrinkle, run from empty; its output commands
   are skipped with a note whatever the options say) or any picture with heights. On failure the session
   keeps what it had. */
bool wr_session_open(WrSession *session, const char *path, WrError *err);
/* An empty document. */
void wr_session_reset(WrSession *session);

/* Run one command line. On failure the document is as it was before. Blank lines and comments do
   nothing. Relative file names are read from `folder` of the script that is running, else from the
   current folder. */
bool wr_session_run(WrSession *session, const char *line, WrError *err);
/* Run a script file line by line; errors carry "file:line: ". Stops at the first failure: what ran
   before it stays. */
bool wr_session_run_script(WrSession *session, const char *path, WrError *err);
/* The same from an open stream (standard input), each line as soon as it is there. name stands for the
   file in errors; files are read relative to the current folder. */
bool wr_session_run_stream(WrSession *session, FILE *stream, const char *name, WrError *err);

/* A stroke in progress is an open command: `head` is a stroke command without points, such as
   "stroke radius=20 strength=0.1". Each sample is rounded to its printed text (u, v to 1e-7, pressure,
   tilt and seconds to 1e-4) and then applied at once; the finished line replays to the same bits. While
   it is open, run and open fail. A sample with a u or v that is not finite or beyond 1e9 is refused. */
bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err);
bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err);
bool wr_session_stroke_end(WrSession *session, WrError *err); /* no samples: nothing happened */
void wr_session_stroke_cancel(
    WrSession *session); /* the document is as before it; fine without one */
bool wr_session_in_stroke(const WrSession *session);

/* Borrowed until the next call that changes it. */
const WrDocument *wr_session_document(const WrSession *session);
/* The canonical text of the last command that ran ("" if none), and how many have run: a counter that
   changes with each edit, for "unsaved changes". */
const char *wr_session_last_command(const WrSession *session);
uint64_t wr_session_revision(const WrSession *session);
/* Revision at the last save or open; the document is unsaved while they differ. */
uint64_t wr_session_saved_revision(const WrSession *session);
const char *wr_session_path(const WrSession *session); /* of the document file, "" if none */

/* The canonical lines of the edits and scene commands that ran since the document was made or opened,
   oldest first. Output commands are not among them. */
int wr_session_history_count(const WrSession *session);
const char *wr_session_history_line(const WrSession *session, int index); /* "" out of range */

/* The scene as canonical command lines, which restore it from a new document. */
void wr_session_scene_text(const WrSession *session, WrText *text);
/* The document's hash: heights, layers, scene. */
WrHash wr_session_hash(const WrSession *session);

/* A picture of the document as it is, by the scene's dials. turn_deg: turntable angle about the world's
   y axis. *frame is borrowed until the session's next picture. */
bool wr_session_frame(WrSession *session, int width, int height, double turn_deg, WrFrame *frame,
                      WrError *err);
/* The same to a file: linear float R, G, B, A (premultiplied, background 0) for exr, tif and tiff, else
   8-bit sRGB over the scene's background. Works whatever options.outputs says. */
bool wr_session_render(WrSession *session, const char *path, int width, int height, double turn_deg,
                       WrError *err);
/* Save under that name; then path and saved_revision are set. Works whatever options.outputs says. */
bool wr_session_save(WrSession *session, const char *path, WrError *err);
