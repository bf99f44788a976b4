/* recovery_journal.h - crash-recovery journal of a session: each command line is written to disk before it runs, so that
   killing the program at any moment loses at most the running command.
   Lines are opaque text: this module handles files and hashes, not the meaning of commands. recover.h reads
   journals that were left behind.

   A journal is two neighbours in one folder:
     NAME.wj      text, one record a line, locked by an exclusive flock while its program runs, so
                  that no two programs share one, and "in use" differs from "left by a crash"
     NAME.files/  other inputs of a replay: snapshots of the document, and copies of files that
                  commands read; hard links to the copies of other journals with the
                  same content, so that the file system counts the references

   Format, version 2. Header:
     wrinkle-journal 2 CHECKSUM PROGRAM TIME KIND HASH SHA256 SNAPSHOT PATH
   then records:
     CHECKSUM SEQUENCE KIND PAYLOAD
   CHECKSUM  32 hex digits over the rest of the line, so that damage affects only the lines that it hits
   SEQUENCE  counts from 1, so that a missing or moved line is detected
   PAYLOAD   extends to the line end, with \n, \r and \\ for line ends and backslashes; in the header
             also \s for a space and \e for an empty word
   KIND      c command, d it has run ("ok", "ok HASH", "dropped"), b, s, e a stroke's begin,
             samples, end, n note, v "HASH PATH": saved to that file, g lines are missing from here on
   In version 1, which can still be read, a CHECKSUM also covered the CHECKSUM of the line before, and there was
   no v. */
#pragma once
#include "base/hash.h"
#include "system/fd.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_JOURNAL_FORMAT 2
#define WR_JOURNAL_LINE_MAX ((int64_t)64 << 20) /* bytes of one line, its end included */
#define WR_JOURNAL_FILE_MAX ((int64_t)1 << 30)  /* maximum bytes of a journal */

typedef enum WrJournalKind {
    WR_JOURNAL_EMPTY,    /* an empty document */
    WR_JOURNAL_DOCUMENT, /* the file at `path`, as opened by the session */
    WR_JOURNAL_SNAPSHOT, /* `snapshot`, a document file in NAME.files/ */
    WR_JOURNAL_KINDS
} WrJournalKind;

/* The state that the first command line starts from. Strings are borrowed for the call. */
typedef struct WrJournalStart {
    WrJournalKind kind;
    WrHash hash;          /* of that state: a replay on any other state would be wrong */
    const char *path;     /* the document's own file, NULL: none yet. Stored as an absolute path */
    const char *snapshot; /* WR_JOURNAL_SNAPSHOT: from wr_journal_snapshot_path; else NULL */
    /* WR_JOURNAL_DOCUMENT: SHA-256 of the content of `path` if it was kept with wr_journal_keep_file (it may be
       overwritten before a recovery); else NULL */
    const char *sha256;
} WrJournalStart;

/* Called once when the journal stops being safe, and once when it is safe again. */
typedef void (*WrJournalReport)(void *ctx, const char *text);

/* Zeroed: the defaults. Read only by wr_journal_begin; strings are copied. */
typedef struct WrJournalOptions {
    const char *
        folder; /* NULL: wr_journal_folder; created with mode 0700 if missing; converted to an absolute path */
    const char *program; /* version of the program; NULL: this one's */
    int64_t max_bytes;   /* request a shorter journal beyond this; 0: 64 MB */
    int64_t max_lines;   /* request a shorter journal beyond this number of lines; 0: 20000 */
    /* Longest time between syncs to disk while lines are written. 0: 1 s; negative: only by wr_journal_sync. A
       sync can take some hundredths of a second; only a power failure needs it, a kill does not. */
    double sync_seconds;
    double retry_seconds;   /* shortest time between attempts to repair a failed journal; 0: 1 s */
    WrJournalReport report; /* may be NULL */
    void *ctx;
} WrJournalOptions;

/* Request to the session, to be served between two commands: write a snapshot to wr_journal_snapshot_path and
   call wr_journal_restart (or wr_journal_put_off if that failed). */
typedef enum WrJournalWant {
    WR_JOURNAL_WANT_NOTHING,
    WR_JOURNAL_WANT_SHORTER, /* it is long: a replay would take time */
    WR_JOURNAL_WANT_WHOLE    /* lines are missing, and writing works again */
} WrJournalWant;

typedef struct WrJournalState {
    bool safe;          /* every command so far can be recovered */
    const char *reason; /* reason if not safe; "" while safe; valid until the next call */
    WrJournalWant want;
    bool busy; /* a command or a stroke is open: restart is not possible */
    /* Commands and strokes begun since the start state. An undo that goes farther back cannot be replayed:
       restart with a snapshot instead. */
    int64_t commands;
    int64_t lines; /* in the file */
    int64_t bytes; /* of the file */
} WrJournalState;

typedef enum WrJournalOutcome {
    WR_JOURNAL_OK, /* it ran */
    /* it failed or was cancelled: the document is unchanged, and a replay skips it */
    WR_JOURNAL_DROPPED
} WrJournalOutcome;

typedef struct WrJournal WrJournal;

/* Default folder: $WRINKLE_STATE/journals if that is set, else $XDG_STATE_HOME/wrinkle/journals (which must be
   absolute), else ~/.local/state/wrinkle/journals. Fails only without a home folder. */
bool wr_journal_folder(WrText *path, WrError *err);

/* Begins a journal under a new unique name. Never fails: if the folder is not writable the journal exists but is
   not safe (see wr_journal_state), painting continues, and the rules for a failed journal apply. If SIGXFSZ
   would kill the program it is set to be ignored, so that a file-size limit is an error like a full disk. Also
   removes leftovers of interrupted begins that are a day old or more.

   The caller owns the journal until wr_journal_finish or wr_journal_leave. One thread at a time. A process
   forked from this one also holds the lock until it exits or runs another program. */
WrJournal *wr_journal_begin(const WrJournalOptions *options, const WrJournalStart *start);
/* Removes the journal and its files, after the document is saved or discarded. NULL is allowed. */
void wr_journal_finish(WrJournal *journal);
/* Closes the journal and leaves it for a recovery, as a crash would. NULL is allowed. */
void wr_journal_leave(WrJournal *journal);

/* The functions that write return true when the line is in the file (in the system's memory: a kill cannot undo
   that; wr_journal_sync protects it from a power failure). On false the journal is not safe: the caller
   continues, the reason was reported once. Such a journal ends before the first missing line; nothing already
   written is harmed. It retries at later calls and, when writing works, requests a restart
   (WR_JOURNAL_WANT_WHOLE). err may be NULL. */

/* Call before a command runs. text: UTF-8. */
bool wr_journal_command(WrJournal *journal, const char *text, WrError *err);
/* Call after it ran, and after a stroke's end; hash of the document then, or NULL. An open stroke that is
   dropped was cancelled. No effect if no command is open. */
bool wr_journal_done(WrJournal *journal, WrJournalOutcome outcome, const WrHash *hash,
                     WrError *err);
/* A stroke: `head` and its samples as they arrive. The reader returns it as one line: head, then all samples
   with ';' between the texts of two calls; so head is "stroke radius=20 points=" and samples "0.1,0.2;0.3,0.2".
   A stroke without samples has no effect. */
bool wr_journal_stroke_begin(WrJournal *journal, const char *head, WrError *err);
bool wr_journal_stroke_add(WrJournal *journal, const char *samples, WrError *err);
bool wr_journal_stroke_end(WrJournal *journal, WrError *err);
/* For people who read the file; ignored by a replay. */
bool wr_journal_note(WrJournal *journal, const char *text, WrError *err);
/* Records that the document with that hash was saved to that file. A recovery continues from the file, under
   that name, if it still has that content; else the lines before are replayed. Not while a command is open. */
bool wr_journal_saved(WrJournal *journal, const char *path, const WrHash *hash, WrError *err);
/* Marks the start state as different from the header, if the header could not be rewritten: as if lines were
   missing from the first on. */
void wr_journal_break(WrJournal *journal, const char *reason);
/* Returns true when everything written so far is on the disk; for a stroke's end, and when idle. Also detects
   that the file was removed or moved away. */
bool wr_journal_sync(WrJournal *journal, WrError *err);

WrJournalState wr_journal_state(const WrJournal *journal);
const char *wr_journal_path(const WrJournal *journal); /* of NAME.wj; "" without a folder */

/* Keeps a copy of a file that a command reads, named by its content's SHA-256 (64 lower-case hex digits) and the
   extension of its name, for wr_journal_find_input_copy. If the content differs from the hash the copy is refused. A
   failure does not harm the journal: a replay then depends on the file itself; but if the journal starts from
   a document of that hash, and the content differs, it is not safe any more. A file of 4 MB or more is opened
   here and copied by a thread, for which the functions that close or restart the journal wait: true then means
   only that the copy has begun. */
bool wr_journal_keep_file(WrJournal *journal, const char *path, const char *sha256, WrError *err);

/* Keeps bytes in memory that stand for the file, as wr_journal_keep_file: a glTF with embedded parts. sha256: of
   the bytes. */
bool wr_journal_keep_bytes(WrJournal *journal, const char *path, const void *bytes, size_t length,
                           const char *sha256, WrError *err);

/* Keeps a copy under the file's own name, for a kept file that refers to it by that name. If another file of
   that name is already kept, that one stays and this fails. */
bool wr_journal_keep_named(WrJournal *journal, const char *path, WrError *err);

/* Path for the next snapshot; creates the folder. Ends in ".exr". */
bool wr_journal_snapshot_path(WrJournal *journal, WrText *path, WrError *err);
/* Restarts from another start state, atomically: at any moment either the old journal exists or the new one.
   Afterwards older snapshots and kept files are removed, and the journal is safe. Fails, without a change, if a
   command is open or the new file cannot be written. */
bool wr_journal_restart(WrJournal *journal, const WrJournalStart *start, WrError *err);
/* The snapshot could not be written: delays the next request (10 s, doubling to 5 minutes). */
void wr_journal_put_off(WrJournal *journal);

/* ---- encoding of one line of a journal: escapes, checksums, the header ---- */

/* A parsed header; strings point into its line. */
typedef struct WrJournalHeader {
    WrJournalStart start; /* snapshot: the name without a folder; path and sha256 may be NULL */
    const char *program;
    int64_t time; /* seconds since 1970 */
} WrJournalHeader;

/* State for verifying the lines of a journal. Zeroed: unknown, since the header is damaged; then both formats
   are accepted. */
typedef struct WrJournalSeal {
    int format;   /* of the header, 1..WR_JOURNAL_FORMAT; 0: unknown */
    WrHash chain; /* format 1: the checksum stored in the line before */
} WrJournalSeal;

bool wr_journal_is_sha256(const char *text); /* 64 lower-case hex digits */
/* True for a plain file name: not empty, no slash, no leading dot. */
bool wr_journal_is_name(const char *text);

/* Appends the header line with its line end. */
void wr_journal_print_header(WrText *line, const WrJournalHeader *header);
/* Parses a header line, without its line end; `line` is modified. Errors do not name the file. */
bool wr_journal_parse_header(char *line, size_t length, WrJournalHeader *out, WrJournalSeal *seal,
                             WrError *err);
/* Guesses the contents of a damaged header: they are plausible, but unproven. `line` is modified. */
bool wr_journal_guess_header(char *line, size_t length, WrJournalHeader *out);

/* Appends a record with its line end. */
void wr_journal_print_line(WrText *line, uint64_t sequence, char kind, const char *payload);
/* Parses a record, without its line end. On success *sequence is its number, and *payload is the unescaped text,
   ended with a NUL, inside `line` (which has room for the NUL). On failure `line` is unchanged. In both cases
   *seal is ready for the next line. */
bool wr_journal_parse_line(char *line, size_t length, WrJournalSeal *seal, uint64_t *sequence,
                           char *kind, char **payload, size_t *payload_length, WrError *err);

/* ---- file operations of the journal folder: creation, locks, neighbouring files, removal ---- */

#define WR_JOURNAL_ENDING ".wj"
#define WR_JOURNAL_FILES_ENDING ".files"
#define WR_JOURNAL_SNAPSHOT_NAME "snapshot-%d.exr"
#define WR_JOURNAL_LEFTOVER_SECONDS 86400 /* age at which leftovers are removed */

/* "X/NAME.wj" -> "X/NAME.files". Caller frees. */
char *wr_journal_files_folder(const char *journal_path);

/* The name of the last snapshot in NAME.files/. Caller frees; NULL if there is none. */
char *wr_journal_newest_snapshot(const char *files);

/* Opens a journal without following a link or waiting for a pipe: -1 with an error unless it is a regular file. */
int wr_journal_open(const char *path, WrError *err);
/* Locks without waiting. False: another program has the lock, or `path` no longer names this file. */
bool wr_journal_lock(int fd, const char *path, WrLock how);

/* Removes the files of NAME.files/ except those named keep_a or (before its extension) keep_b, either NULL; also
   the folder if it is then empty. */
void wr_journal_clear_files(const char *files, const char *keep_a, const char *keep_b);

typedef struct WrJournalRead WrJournalRead;
/* wr_journal_read for an open, unread file; `path` is used for messages and for the snapshot's path. The caller
   closes fd. */
bool wr_journal_read_fd(int fd, const char *path, WrJournalRead *out, WrError *err);
