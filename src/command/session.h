/* session.h - the one door to a document. The window, the command line, scripts and tests all change a
   document by running command lines here; nothing else may.
   Layer 6. A session belongs to one thread; snapshots of it may be read by any. */
#pragma once
#include "base/pool.h"
#include "brush/brush.h"
#include "document/document.h"

typedef struct WrSession WrSession;

/* What a command has to say besides failing: "3 texels were not finite and became 0". */
typedef void (*WrNoteSink)(void *ctx, const char *text);

typedef struct WrSessionOptions {
    WrPool *pool;         /* borrowed; NULL: one thread */
    WrNoteSink note;      /* may be NULL */
    void *note_ctx;
    bool outputs;         /* perform output commands (only `wrinkle run` and the window do); otherwise
                             they are skipped with a note */
    const char *isa;      /* kernel set for renders: NULL or "auto" */
} WrSessionOptions;

/* Starts with an empty document. The caller owns it. */
WrSession *wr_session_new(const WrSessionOptions *options);
void wr_session_free(WrSession *session);

/* Replace the document by a file's: a document, a script (*.wrinkle, run from empty) or any picture
   with heights. On failure the session keeps what it had. */
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

/* A stroke in progress is an open command: `head` is a stroke command without points, such as
   "stroke radius=20 strength=0.1". Each sample is rounded to its printed text and then applied at once;
   the finished line replays to the same bits. While it is open, run and open fail. */
bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err);
bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err);
bool wr_session_stroke_end(WrSession *session, WrError *err); /* no samples: nothing happened */
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

/* The scene as canonical command lines, which restore it from a new document. */
void wr_session_scene_text(const WrSession *session, WrText *text);
/* The document's hash: heights, layers, scene. */
WrHash wr_session_hash(const WrSession *session);
