/* journal.h - the record of a session on disk: each command line is written before it runs, so that
   killing the program at any moment loses at most the command under way.
   Layer 5. Lines are opaque text: this module knows files and hashes, not what commands mean.
   Reading a journal that was left behind is recover.h.

   A journal is two neighbours in one folder:
     NAME.wj      text, one record a line, held with an exclusive flock while its program lives, so
                  that no two programs share one, and "in use" differs from "left by a crash"
     NAME.files/  what a replay needs besides: snapshots of the document, and copies of files that
                  commands read; hard links to the copies of other journals where they have the
                  same, so that the file system counts the references and nobody has to

   Format, version 2. Header:
     wrinkle-journal 2 CHECKSUM PROGRAM TIME KIND HASH SHA256 SNAPSHOT PATH
   then records:
     CHECKSUM SEQUENCE KIND PAYLOAD
   CHECKSUM  32 hex digits over the rest of the line, so that damage costs the lines that it hits
   SEQUENCE  counts from 1, so that no line can vanish or change places unnoticed
   PAYLOAD   runs to the line end, with \n, \r and \\ for line ends and backslashes; in the header
             also \s for a space and \e for an empty word
   KIND      c command, d it has run ("ok", "ok HASH", "dropped"), b, s, e a stroke's begin,
             samples, end, n note, v "HASH PATH": it was saved there, g lines are missing from here on
   In version 1, which is still read, a CHECKSUM went over the line before's CHECKSUM too, and v was
   not known. */
#pragma once
#include "base/hash.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_JOURNAL_FORMAT 2
#define WR_JOURNAL_LINE_MAX ((int64_t)64 << 20) /* bytes of one line, its end included */
#define WR_JOURNAL_FILE_MAX ((int64_t)1 << 30)  /* bytes of a journal */

typedef enum WrJournalKind {
    WR_JOURNAL_EMPTY,    /* an empty document */
    WR_JOURNAL_DOCUMENT, /* the file at `path`, as the session opened it */
    WR_JOURNAL_SNAPSHOT, /* `snapshot`, a document file in NAME.files/ */
    WR_JOURNAL_KINDS
} WrJournalKind;

/* The state that the first command line is to be run on. Strings are borrowed for the call. */
typedef struct WrJournalStart {
    WrJournalKind kind;
    WrHash hash;          /* of that state: a replay on anything else would be wrong */
    const char *path;     /* the document's own file, NULL: none yet. Stored as an absolute path */
    const char *snapshot; /* WR_JOURNAL_SNAPSHOT: as wr_journal_snapshot_path gave it; else NULL */
    const char *sha256;   /* WR_JOURNAL_DOCUMENT: the content of `path` if it was kept with
                    wr_journal_keep_file (it may be overwritten before a recovery); else NULL */
} WrJournalStart;

/* Called once when the journal stops being safe, and once when it is safe again. */
typedef void (*WrJournalReport)(void *ctx, const char *text);

/* Zeroed: the defaults. Read once by wr_journal_begin; strings are copied. */
typedef struct WrJournalOptions {
    const char *
        folder; /* NULL: wr_journal_folder; made with mode 0700 if missing, absolute from here on */
    const char *program; /* version of the program; NULL: this one's */
    int64_t max_bytes;   /* ask for a shorter journal beyond this; 0: 64 MB */
    int64_t max_lines;   /* the same in lines; 0: 20000 */
    /* Wait for the disk itself at most this often, while lines come. 0: 1 s; negative: only when
       wr_journal_sync says so. Waiting can take some hundredths of a second; only a loss of power
       needs it, a kill does not. */
    double sync_seconds;
    double retry_seconds;   /* try a journal that failed again this often at most; 0: 1 s */
    WrJournalReport report; /* may be NULL */
    void *ctx;
} WrJournalOptions;

/* What the journal would like the session to do between two commands: write a snapshot to
   wr_journal_snapshot_path and call wr_journal_restart (or wr_journal_put_off if that failed). */
typedef enum WrJournalWant {
    WR_JOURNAL_WANT_NOTHING,
    WR_JOURNAL_WANT_SHORTER, /* it is long: a replay would take time */
    WR_JOURNAL_WANT_WHOLE    /* lines are missing, and writing works again */
} WrJournalWant;

typedef struct WrJournalState {
    bool safe;          /* every command so far can be recovered */
    const char *reason; /* why not; "" while safe; valid until the next call */
    WrJournalWant want;
    bool busy; /* a command or a stroke is open: no restart now */
    /* Commands and strokes begun since the start state. An undo that reaches farther back cannot be
       replayed: restart with a snapshot instead. */
    int64_t commands;
    int64_t lines; /* in the file */
    int64_t bytes; /* of the file */
} WrJournalState;

typedef enum WrJournalOutcome {
    WR_JOURNAL_OK,     /* it ran */
    WR_JOURNAL_DROPPED /* it failed or was cancelled: the document is as before it, and a replay
                          leaves it out */
} WrJournalOutcome;

typedef struct WrJournal WrJournal;

/* $WRINKLE_STATE/journals if that is set, else $XDG_STATE_HOME/wrinkle/journals (which must be
   absolute), else ~/.local/state/wrinkle/journals. Fails only where there is no home folder. */
bool wr_journal_folder(WrText *path, WrError *err);

/* Begin a journal under a name of its own. Never fails: if the folder cannot be written the journal
 * is there but not safe (see wr_journal_state), painting goes on, and the rules for a journal that
 * failed hold. Where SIGXFSZ would kill the program it is set to be ignored, so that a file-size
 * limit is an error like a full disk. Also removes leftovers of begins that were killed, a day old
 * or more.
 *
 * The journal is the caller's: wr_journal_finish or wr_journal_leave. One thread at a time.
 * A process forked from this one holds the lock too until it exits or runs another program. */
WrJournal *wr_journal_begin(const WrJournalOptions *options, const WrJournalStart *start);
/* The document is saved or given up: removes the journal and its files. NULL is fine. */
void wr_journal_finish(WrJournal *journal);
/* Close and leave it for a recovery, as a crash would. NULL is fine. */
void wr_journal_leave(WrJournal *journal);

/* The functions that write return true when the line is in the file (the system's memory: a kill
 * cannot take it back; wr_journal_sync makes it outlive the power). On false the journal is not
 * safe: the caller goes on, the reason was reported once. Such a journal ends before the first line
 * that is missing; nothing already written is harmed. It tries again at later calls and, when
 * writing works, asks for a fresh start (WR_JOURNAL_WANT_WHOLE). err may be NULL. */

/* Before a command runs. text: UTF-8. */
bool wr_journal_command(WrJournal *journal, const char *text, WrError *err);
/* After it ran, and after a stroke's end; hash of the document then, or NULL. An open stroke that
   is dropped was cancelled. Does nothing if no command is open. */
bool wr_journal_done(WrJournal *journal, WrJournalOutcome outcome, const WrHash *hash,
                     WrError *err);
/* A stroke: `head` and its samples as they come. It is given back as one line: head, then all
   samples with ';' between two calls' texts; so head is "stroke radius=20 points=" and samples
   "0.1,0.2;0.3,0.2". Without samples nothing happened. */
bool wr_journal_stroke_begin(WrJournal *journal, const char *head, WrError *err);
bool wr_journal_stroke_add(WrJournal *journal, const char *samples, WrError *err);
bool wr_journal_stroke_end(WrJournal *journal, WrError *err);
/* For people who read the file; a replay passes over it. */
bool wr_journal_note(WrJournal *journal, const char *text, WrError *err);
/* The document as it is now, of that hash, was saved as that file: a recovery goes on from there, under that
   name, where the file still holds it; else the lines before it make it again. Not while a command is open. */
bool wr_journal_saved(WrJournal *journal, const char *path, const WrHash *hash, WrError *err);
/* The start state is not what the header says, and could not be written: as if lines were missing, from the first
   on. */
void wr_journal_break(WrJournal *journal, const char *reason);
/* Everything written so far is on the disk when this returns true: at a stroke's end, when idle.
   Also finds out whether the file was removed or moved away. */
bool wr_journal_sync(WrJournal *journal, WrError *err);

WrJournalState wr_journal_state(const WrJournal *journal);
const char *wr_journal_path(const WrJournal *journal); /* of NAME.wj; "" without a folder */

/* Keep a copy of a file that a command reads, under its content's SHA-256 (64 lower-case hex
 * digits) and the ending of its name, for wr_journal_kept_file. A copy of another content is
 * refused. Fails without harm to the journal: a replay then depends on the file itself. */
bool wr_journal_keep_file(WrJournal *journal, const char *path, const char *sha256, WrError *err);

/* The same of bytes in memory that stand for the file: a glTF with its parts in it. sha256: of the bytes. */
bool wr_journal_keep_bytes(WrJournal *journal, const char *path, const void *bytes, size_t length,
                           const char *sha256, WrError *err);

/* Keep a copy under the file's own name, for a kept file that names it as its neighbour. Where another file
 * of that name is kept already, that one stays: then this fails. */
bool wr_journal_keep_named(WrJournal *journal, const char *path, WrError *err);

/* Where to write the next snapshot; makes the folder. Ends in ".exr". */
bool wr_journal_snapshot_path(WrJournal *journal, WrText *path, WrError *err);
/* Begin anew from another start state, in one step: at any moment either the old journal is there
 * or the new one. Afterwards older snapshots and kept files are gone, and the journal is safe.
 * Fails, and changes nothing, when a command is open or the new file cannot be written. */
bool wr_journal_restart(WrJournal *journal, const WrJournalStart *start, WrError *err);
/* The snapshot could not be written: do not ask again for a while (10 s, doubling to 5 minutes). */
void wr_journal_put_off(WrJournal *journal);
