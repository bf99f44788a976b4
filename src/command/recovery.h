/* recovery.h - documents of programs that ended before their work was saved.
   Layer 6. */
#pragma once
#include "base/text.h"

#include <stdbool.h>

typedef struct WrText WrText;
typedef struct WrError WrError;
typedef struct WrJournalClaim WrJournalClaim;
typedef struct WrSession WrSession;

/* What a program that crashed, or was killed, left behind. */
typedef struct WrRecoverable {
    char *journal;           /* names it to the functions below; owned */
    char *document;          /* the document's own file; "" if it never had one; owned */
    double started, written; /* seconds since 1970, UTC: the journal's begin and last change */
    int commands;            /* since the last save that can be brought back, up to any damage */
    int beyond;              /* those behind damage */
    int lost;                /* lines of the journal that are damaged or missing */
    bool headless;           /* damaged is its first line too: what it began with is not known */
    bool damaged;            /* something in it cannot be read */
    bool unfinished;         /* the last command had not ended: it may be what crashed */
    char *
        error; /* it cannot be read at all, and why; else NULL. Then only its name, its document ("") and
                    its last change hold; owned */
} WrRecoverable;

/* Those that no running program holds, newest first. The list is the caller's. A journal with nothing in
   it is not listed. */
bool wr_recovery_list(WrRecoverable **list, int *count, WrError *err);
void wr_recovery_list_free(WrRecoverable *list, int count);

/* How a recovery went. */
typedef struct WrRecovered {
    int commands;  /* on record since what it began with */
    int done;      /* of them brought back */
    bool whole;    /* that is all: nothing failed, nothing was damaged, nothing was missing */
    bool more;     /* there is more on record, and going on beyond what is missing could bring it */
    bool removed;  /* the old journal is gone, since a new one holds all of it */
    WrText report; /* sentences for the user, one a line */
    struct WrJournalClaim *claim; /* on the old journal while it is held */
} WrRecovered;

/* Put the document of that journal in the session's place: the file that was saved last where it still holds
 * that, else the journal's start state; then every command whose end is on record. A command that has none
 * is first tried in a process of its own; if that crashes, takes too long or fails, recovery stops before
 * it. A command that fails, and damage in the journal, end it too, unless `beyond` is set: then it goes on
 * with what follows as far as that can run, and undo and redo go no farther than to what is missing.
 *
 * Afterwards the document has its file's name and counts as unsaved. If the session keeps a journal, one of
 * its own begins with a snapshot of the document, and the old one goes if all was brought back and that
 * snapshot reads back to the same. Else it stays: where the session keeps none it is held until the caller
 * has saved the document and says so. On failure the session keeps what it had and the journal stays.
 * *out is the caller's (wr_recovered_fini), on failure too. */
bool wr_session_recover(WrSession *session, const char *journal, bool beyond, WrRecovered *out,
                        WrError *err);
/* The document was saved as that file: read it back, and if all was brought back and it holds all, remove the
   journal. False and an error if the file does not hold it; the journal stays then. */
bool wr_recovered_saved(WrRecovered *recovered, WrSession *session, const char *path, WrError *err);
void wr_recovered_fini(WrRecovered *recovered); /* lets go of the journal; fine on a zeroed one */

/* Everything in the journal that can be read as a script, with comments where something is missing. The journal
   stays. */
bool wr_recovery_script(const char *journal, WrText *text, WrError *err);

/* The file of the document that the journal is of, if it may be saved over: nobody has changed it since the
   journal saw it. Appended to `path`; else false and an error. */
bool wr_recovery_own_file(const char *journal, WrText *path, WrError *err);

/* Remove it: what it holds is lost. */
bool wr_recovery_discard(const char *journal, WrError *err);
