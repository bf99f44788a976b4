/* recover.h - journals that were left behind: which there are, what is in them, and trying a
   command that may have crashed.
   Layer 5. Everything read here is checked: a torn, damaged or hostile journal gives the lines
   whose checksums hold, and says which of them stand behind damage, or a clear error.

   A recovery: wr_journal_list; wr_journal_claim the one chosen, so that no other program recovers
   it too; wr_journal_read; bring the start state back, or the file that was saved last, and compare
   its hash; run the lines, comparing hashes where they have one; if the last did not finish,
   wr_journal_trial it or ask; save the result, or give the session a journal of its own that starts
   from a snapshot of it; read that back; and only where all was brought back, wr_journal_claim_remove. */
#pragma once
#include "document/journal.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_JOURNAL_COMMANDS_MAX 1000000 /* in one journal; what follows is dropped */

/* One command to run. */
typedef struct WrJournalLine {
    const char *text; /* a whole command line; strokes put together. Lives with the WrJournalRead */
    bool stroke;      /* it was drawn as a stroke */
    bool done;        /* its end is on record, or lines that came after it */
    bool hashed;      /* `hash` holds */
    bool holed;       /* some samples of the stroke are lost */
    WrHash hash;      /* of the document after it ran */
    int lost;         /* lines of the file between the command before and this one that are lost */
} WrJournalLine;

/* The last save on record. */
typedef struct WrJournalSave {
    const char *path; /* absolute; NULL: there was none */
    WrHash hash;      /* of the document then */
    int at;           /* lines[0..at) came before it */
} WrJournalSave;

typedef struct WrJournalRead {
    WrJournalStart start; /* snapshot is a whole path here; strings live as long as this struct */
    const char *program;  /* version that wrote it */
    int64_t started;      /* seconds since 1970, UTC */
    /* The first line is damaged: all of the above is a guess (what of it makes sense, or the newest snapshot
       beside the journal), and a hash of 0 stands for none. */
    bool headless;
    /* [total], owned; those that failed or were cancelled are left out. The first `count` stand before any
       damage, the others behind it: what led to them may be missing. */
    WrJournalLine *lines;
    int count, total;
    WrJournalSave saved;
    bool unfinished; /* the last line of all has no end on record: it may be the one that crashed */
    bool in_stroke;  /* and it is a stroke that was still being drawn */
    int lost;        /* lines of the file that are damaged or missing, as far as is known */
    int lost_at_end; /* of them, those after the last command and the last save */
    int64_t dropped_bytes; /* after the last line before any damage; 0: the file is whole */
    char damage[256];      /* the first: "line 7: ..."; "" */
    char gap[256];  /* the program itself said that lines are missing at the end, and why; "" */
    char *owned[4]; /* header, snapshot path, texts, the saved file's path */
} WrJournalRead;

/* Read and verify a journal, in use or not. Damaged lines are stepped over.
 * Fails, with *out untouched, if it is no regular file, no journal, its header is damaged and no line
 * behind it is whole, or it was written by a newer program (the message says so; the file stays). Memory:
 * at most 1 GB of the file is read, and up to three times what was read is needed meanwhile. */
bool wr_journal_read(const char *path, WrJournalRead *out, WrError *err);
/* How far the lines from `from` on can be run without a gap: the index of the first one that has lost lines in
   front of it, or points. known: so is the state that `from` begins with; else only with the header whole. */
int wr_journal_sound_end(const WrJournalRead *read, int from, bool known);
void wr_journal_read_fini(WrJournalRead *read); /* fine on a zeroed one */

/* A journal that no program holds. */
typedef struct WrJournalEntry {
    char *path;         /* of the .wj file; owned */
    char *document;     /* the document's own file, "" if it never had one; owned */
    WrJournalKind kind; /* of the start state */
    int64_t started;    /* seconds since 1970, UTC */
    int64_t written;    /* the same: when it last changed */
    int64_t bytes;      /* size of the file */
    int complete;       /* commands since the last save that finished, those before any damage */
    int beyond;         /* the same behind damage */
    bool unfinished;    /* one more, that did not */
    bool nothing;       /* nothing to recover: no commands, and the start state is there anyway */
    bool headless;      /* as in WrJournalRead */
    int lost;           /* the same */
    int64_t dropped_bytes; /* the same */
    char damage[256];      /* the same */
    /* It cannot be read at all, and why; else "". Then only path, written and bytes hold. */
    char error[256];
} WrJournalEntry;

typedef struct WrJournalList {
    WrJournalEntry *entries; /* [count], owned; the newest first */
    int count;
} WrJournalList;

/* The journals of a folder (NULL: wr_journal_folder) that are not in use. A folder that does not
   exist has none. Those with nothing to recover are removed on the way when they are a day old. */
bool wr_journal_list(const char *folder, WrJournalList *out, WrError *err);
/* The same; what followed a save counts only from the first line on for which counts(line) holds. */
typedef bool (*WrJournalCounts)(const char *line);
bool wr_journal_list_that(const char *folder, WrJournalCounts counts, WrJournalList *out,
                          WrError *err);
void wr_journal_list_fini(WrJournalList *list); /* fine on a zeroed one */

/* Hold a journal that was left behind, against all other programs. NULL and an error if one that
   lives holds it, or it is gone. */
typedef struct WrJournalClaim WrJournalClaim;
WrJournalClaim *wr_journal_claim(const char *path, WrError *err);
void wr_journal_claim_free(WrJournalClaim *claim); /* leaves the journal; NULL is fine */
/* Remove the journal and its files; frees the claim either way. */
bool wr_journal_claim_remove(WrJournalClaim *claim, WrError *err);

/* The kept copy of a file that a command of the journal at `journal_path` reads, by its SHA-256.
   named: the file's name in the command, for the copy with the same ending where there are several;
   may be NULL. False if there is none. */
bool wr_journal_kept_file(const char *journal_path, const char *sha256, const char *named,
                          WrText *path, WrError *err);

typedef enum WrEditPreviewEnd {
    WR_EDIT_PREVIEW_TRUE,    /* the function returned true */
    WR_EDIT_PREVIEW_FALSE,   /* it returned false: *err has its message */
    WR_EDIT_PREVIEW_CRASHED, /* a signal, or an exit, ended it: *err says which */
    WR_EDIT_PREVIEW_TIMEOUT, /* it took too long and was killed */
    WR_EDIT_PREVIEW_UNABLE   /* no child could be started: nothing is known */
} WrEditPreviewEnd;

/* Run function(ctx) in a forked child and say how that ended. Nothing that it does to memory shows
 * here; what it does to files does, so it must do nothing to files. Its standard output and error
 * go nowhere.
 *
 * seconds  real time that it may take, over 0
 * bytes    memory that it may take besides what this program has now; 0: any (sanitizers need that)
 * Threads  the child has only the thread that called: the function may use no lock, pool or library
 *          that other threads of this program may hold at that moment. `wrinkle recover` calls this
 *          before any thread is started. */
typedef bool (*WrEditPreviewFunction)(void *ctx, WrError *err);
WrEditPreviewEnd wr_journal_trial(WrEditPreviewFunction function, void *ctx, double seconds,
                                  size_t bytes, WrError *err);
