/* recover.h - recovery of journals that were left behind: listing, reading, and a trial run of a command that
   may have crashed. All input is validated: a torn, damaged or hostile journal yields the lines with valid
   checksums, marks those after damage, or causes a clear error.

   Steps of a recovery: wr_journal_list; wr_journal_claim for the chosen one, so that no other program recovers
   it too; wr_journal_read; restore the start state, or the file that was saved last, and compare its hash; run
   the lines, comparing hashes where they have one; if the last did not finish, wr_journal_trial it or ask the
   user; save the result, or start a journal of the session from a snapshot of it; read that file again; and only
   if everything was restored, wr_journal_claim_remove. */
#pragma once
#include "document/recovery_journal.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_JOURNAL_COMMANDS_MAX 1000000 /* in one journal; further ones are dropped */

/* One command to replay. */
typedef struct WrJournalLine {
    /* a whole command line; strokes are joined. Valid as long as the WrJournalRead */
    const char *text;
    bool stroke; /* it was drawn as a stroke */
    bool done;   /* its end is recorded, or later lines are */
    bool hashed; /* `hash` is valid */
    bool holed;  /* some samples of the stroke are lost */
    WrHash hash; /* of the document after it ran */
    int lost;    /* lost lines of the file between the previous command and this one */
} WrJournalLine;

/* The last recorded save. */
typedef struct WrJournalSave {
    const char *path; /* absolute; NULL: none */
    WrHash hash;      /* of the document then */
    int at;           /* lines[0..at) were before it */
} WrJournalSave;

typedef struct WrJournalRead {
    WrJournalStart start; /* snapshot is a full path; strings are valid as long as this struct */
    const char *program;  /* version of the program that wrote it */
    int64_t started;      /* seconds since 1970, UTC */
    /* The first line is damaged: everything above is a guess (its plausible parts, or the newest snapshot beside
       the journal), and a hash of 0 means none. */
    bool headless;
    /* [total], owned, without commands that failed or were cancelled. The first `count` are before any damage,
       the others after it: their preconditions may be missing. */
    WrJournalLine *lines;
    int count, total;
    WrJournalSave saved;
    bool unfinished;       /* the last line has no recorded end: it may have caused the crash */
    bool in_stroke;        /* and it is an unfinished stroke */
    int lost;              /* damaged or missing lines of the file, as far as known */
    int lost_at_end;       /* those of them after the last command and the last save */
    int64_t dropped_bytes; /* after the last line before any damage; 0: the file is undamaged */
    char damage[256];      /* the first damage: "line 7: ..."; "" */
    char gap[256];  /* the program recorded that lines are missing at the end, and the reason; "" */
    char *owned[4]; /* header, snapshot path, texts, the saved file's path */
} WrJournalRead;

/* Reads and verifies a journal, in use or not. Damaged lines are skipped.
   Fails, with *out untouched, if it is not a regular file or not a journal, if its header is damaged and no
   later line is whole, or if it was written by a newer program (the message reports it; the file stays). Memory:
   reads at most 1 GB of the file, and temporarily needs up to three times that. */
bool wr_journal_read(const char *path, WrJournalRead *out, WrError *err);
/* End of the lines from `from` on that can be run without a gap: the index of the first one that has lost lines
   before it, or gaps in a stroke. known: the state before `from` is certain; else that requires an undamaged
   header. */
int wr_journal_sound_end(const WrJournalRead *read, int from, bool known);
void wr_journal_read_fini(WrJournalRead *read); /* also for a zeroed one */

/* A journal that no program holds. */
typedef struct WrJournalEntry {
    char *path;         /* of the .wj file; owned */
    char *document;     /* path of the document's own file, "" if it has none; owned */
    WrJournalKind kind; /* of the start state */
    int64_t started;    /* seconds since 1970, UTC */
    int64_t written;    /* last modification, seconds since 1970, UTC */
    int64_t bytes;      /* size of the file */
    int complete;       /* finished commands since the last save, before any damage */
    int beyond;         /* finished commands since the last save, after damage */
    bool unfinished;    /* one more command that did not finish */
    bool nothing;       /* nothing to recover: no commands, and the start state exists elsewhere */
    bool headless;      /* as in WrJournalRead */
    int lost;           /* as in WrJournalRead */
    int64_t dropped_bytes; /* as in WrJournalRead */
    char damage[256];      /* as in WrJournalRead */
    /* Reason why it cannot be read; else "". If set, only path, written and bytes are valid. */
    char error[256];
} WrJournalEntry;

typedef struct WrJournalList {
    WrJournalEntry *entries; /* [count], owned; the newest first */
    int count;
} WrJournalList;

/* Lists the journals of a folder (NULL: wr_journal_folder) that are not in use. A folder that does not exist has
   none. Journals with nothing to recover that are a day old are removed. */
bool wr_journal_list(const char *folder, WrJournalList *out, WrError *err);
/* wr_journal_list, but commands after a save count only from the first line on for which counts(line) is true. */
typedef bool (*WrJournalCounts)(const char *line);
bool wr_journal_list_that(const char *folder, WrJournalCounts counts, WrJournalList *out,
                          WrError *err);
void wr_journal_list_fini(WrJournalList *list); /* also for a zeroed one */

/* Locks a journal that was left behind, against all other programs. NULL and an error if a running program holds
   it, or it is gone. */
typedef struct WrJournalClaim WrJournalClaim;
WrJournalClaim *wr_journal_claim(const char *path, WrError *err);
void wr_journal_claim_free(WrJournalClaim *claim); /* leaves the journal; NULL is fine */
/* Removes the journal and its files; frees the claim in any case. */
bool wr_journal_claim_remove(WrJournalClaim *claim, WrError *err);

/* Path of the kept copy of a file that a command of the journal at `journal_path` reads, by its SHA-256. named:
   the file's name in the command, for the copy with that extension if there are several; may be NULL. False if
   there is none. */
bool wr_journal_find_input_copy(const char *journal_path, const char *sha256, const char *named,
                                WrText *path, WrError *err);

typedef enum WrProbeEnd {
    WR_PROBE_TRUE,    /* the function returned true */
    WR_PROBE_FALSE,   /* it returned false: *err has the message */
    WR_PROBE_CRASHED, /* a signal or an exit ended it: *err names it */
    WR_PROBE_TIMEOUT, /* it exceeded the time limit and was killed */
    WR_PROBE_UNABLE   /* no child could be started: the result is unknown */
} WrProbeEnd;

/* Runs function(ctx) in a forked child and reports its end. Changes of memory are not visible in this process;
   changes of files are, so it must not change files. Its standard output and error are discarded.

   seconds  limit of real time, above 0
   bytes    limit of memory in addition to this program's current memory; 0: none (sanitizers need that) Threads
   the child has only the calling thread: the function must not use a lock, pool or library
            that other threads of this program may hold at that moment. `wrinkle recover` calls this
            before any thread is started. */
typedef bool (*WrProbeFunction)(void *ctx, WrError *err);
WrProbeEnd wr_journal_trial(WrProbeFunction function, void *ctx, double seconds, size_t bytes,
                            WrError *err);
