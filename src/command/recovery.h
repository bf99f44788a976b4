/* recovery.h - documents of programs that ended before their work was saved.
   Layer 6. */
#pragma once
#include "command/session.h"

/* What a program that crashed, or was killed, left behind. */
typedef struct WrRecoverable {
    char *journal;           /* names it to the functions below; owned */
    char *document;          /* the document's own file; "" if it never had one; owned */
    double started, written; /* seconds since 1970, UTC: the journal's begin and last change */
    int commands;            /* that can be brought back */
    bool damaged;            /* something at its end cannot be read and is lost */
    bool unfinished;         /* the last command had not ended: it may be what crashed */
} WrRecoverable;

/* Those that no running program holds, newest first. The list is the caller's. A journal with nothing in
   it is not listed. */
bool wr_recovery_list(WrRecoverable **list, int *count, WrError *err);
void wr_recovery_list_free(WrRecoverable *list, int count);

/* Put the document of that journal in the session's place: its start state, then every command whose end is
 * on record. A command that has none is first tried in a process of its own; if that crashes, takes too
 * long or fails, recovery stops before it and the report says so. report: sentences for the user, one a
 * line. Afterwards the document counts as unsaved, has a journal of its own (if the session keeps one),
 * and the old one is gone. On failure the session keeps what it had and the journal stays. */
bool wr_session_recover(WrSession *session, const char *journal, WrText *report, WrError *err);

/* Remove it: what it holds is lost. */
bool wr_recovery_discard(const char *journal, WrError *err);
