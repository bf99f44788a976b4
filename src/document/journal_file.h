/* journal_file.h - files of journals: the folder with its locks and neighbouring files, and the encoding of lines.
   Private to this module. */
#pragma once
#include "document/journal.h"
#include "document/recover.h"
#include "system/fd.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* 32 hex digits as wr_hash_print writes them. */
bool wr_journal_parse_hash(const char *text, WrHash *hash);
/* 64 lower-case hex digits. */
bool wr_journal_is_sha256(const char *text);
/* True for a plain file name: not empty, no slash, no leading dot. */
bool wr_journal_is_name(const char *text);

/* ---- file operations of the journal folder: creation, locks, neighbouring files, removal ---- */

#define WR_JOURNAL_ENDING ".wj"
#define WR_JOURNAL_FILES_ENDING ".files"
#define WR_JOURNAL_SNAPSHOT_NAME "snapshot-%d.exr"
#define WR_JOURNAL_LEFTOVER_SECONDS 86400 /* age at which leftovers are removed */

/* Creates a folder and its parents, mode 0700 each; succeeds if it exists. */
bool wr_journal_make_folder(const char *path, WrError *err);
/* "X/NAME.wj" -> "X/NAME.files". Caller frees. */
char *wr_journal_files_folder(const char *journal_path);

/* The name of the last snapshot in NAME.files/. Caller frees; NULL if there is none. */
char *wr_journal_newest_snapshot(const char *files);

/* Syncs a file, or a folder so that its names are on the disk. Some file systems cannot sync folders; that is
   not a failure. */
bool wr_journal_sync_path(const char *path, WrError *err);

/* Opens a journal without following a link or waiting for a pipe: -1 with an error unless it is a regular file. */
int wr_journal_open(const char *path, WrError *err);
/* Locks without waiting. False: another program has the lock, or `path` no longer names this file. */
bool wr_journal_lock(int fd, const char *path, WrLock how);

/* wr_journal_keep_named for the journal whose files are in `files`. */

/* Removes the files of NAME.files/ except those named keep_a or (before its extension) keep_b, either NULL; also
   the folder if it is then empty. */
void wr_journal_clear_files(const char *files, const char *keep_a, const char *keep_b);
/* Removes incomplete files of killed programs from the folder, if they are older than a day. */
void wr_journal_sweep(const char *folder);

/* wr_journal_read for an open, unread file; `path` is used for messages and for the snapshot's path. The caller
   closes fd. */
bool wr_journal_read_fd(int fd, const char *path, WrJournalRead *out, WrError *err);
