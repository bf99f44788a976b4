/* recovery.h - crash recovery: documents of programs that ended before their work was saved. */
#pragma once
#include "base/text.h"

#include <stdbool.h>

typedef struct WrText WrText;
typedef struct WrError WrError;
typedef struct WrJournalClaim WrJournalClaim;
typedef struct WrSession WrSession;

/* A journal left by a program that crashed or was killed. */
typedef struct WrRecoverable {
    char *journal;           /* its path, the identifier for the functions below; owned */
    char *document;          /* path of the document's file; "" if it never had one; owned */
    double started, written; /* seconds since 1970, UTC: start and last change of the journal */
    int commands;            /* recoverable commands since the last save, up to any damage */
    int beyond;              /* commands after the damage */
    int lost;                /* damaged or missing lines of the journal */
    bool headless;           /* the first line is damaged too: the start state is unknown */
    bool damaged;            /* part of the journal cannot be read */
    bool unfinished;         /* the last command had not ended: it may have caused the crash */
    char *
        error; /* reason if nothing can be read; else NULL. With an error only journal, document ("") and written are
                  valid; owned */
} WrRecoverable;

/* Journals not in use by a running program, newest first. The caller owns the list. Empty journals are left out. */
bool wr_recovery_list(WrRecoverable **list, int *count, WrError *err);
void wr_recovery_list_free(WrRecoverable *list, int count);

/* Result of a recovery. */
typedef struct WrRecovered {
    int commands;    /* recorded since the start state */
    int done;        /* recovered commands */
    bool whole;      /* complete: nothing failed, was damaged or was missing */
    bool more;       /* more commands are recorded; continuing past the damage might recover them */
    bool removed;    /* the old journal was removed, since a new one holds all of it */
    WrText report;   /* sentences for the user, one for each line */
    WrText messages; /* the same as messages (base/message.h), for translation */
    struct WrJournalClaim *claim; /* lock on the old journal while it is held */
} WrRecovered;

/* Replace the session's document by the recovered one. Recovery starts from the last saved file if that is unchanged,
 * else from the journal's start state. It then runs every command whose end is recorded. A command without a recorded
 * end first runs in a separate process; if that crashes, times out or fails, recovery stops before the command. A
 * failed command or damage in the journal also stops recovery, unless `beyond` is set: then later commands run as far
 * as possible, and undo and redo stop at the gap.
 *
 * Afterwards the document has its file's name and counts as unsaved. If the session keeps a journal, it begins a new
 * one with a snapshot of the document. The old journal is removed if everything was recovered and that snapshot reads
 * back identically. Otherwise it stays; a session without a journal holds it until the caller has saved the document
 * (wr_recovered_saved). On failure the session and the journal are unchanged. The caller owns *out
 * (wr_recovered_fini), on failure too. */
bool wr_session_recover(WrSession *session, const char *journal, bool beyond, WrRecovered *out,
                        WrError *err);
/* To be called after the document was saved to `path`: read the file back, and remove the journal if everything was
   recovered and the file holds it. False and an error if the file does not; the journal then stays. */
bool wr_recovered_saved(WrRecovered *recovered, WrSession *session, const char *path, WrError *err);
void wr_recovered_fini(WrRecovered *recovered); /* releases the journal; a zeroed one is allowed */

/* The readable part of the journal as a script, with comments at gaps. The journal stays. */
bool wr_recovery_script(const char *journal, WrText *text, WrError *err);

/* Path of the journal's document file if it may be overwritten: the file is unchanged since the journal recorded it.
   Appended to `path`; else false and an error. */
bool wr_recovery_own_file(const char *journal, WrText *path, WrError *err);

/* Remove the journal; its content is lost. */
bool wr_recovery_discard(const char *journal, WrError *err);
