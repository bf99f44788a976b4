/* journal_line.h - one line of a journal as bytes: escapes, checksums, the header.
   Layer 5. Private to this room. */
#pragma once
#include "document/journal.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A header as read; strings point into the line that it was read from. */
typedef struct WrJournalHeader {
    WrJournalStart start; /* snapshot: the name without a folder; path and sha256 may be NULL */
    const char *program;
    int64_t time; /* seconds since 1970 */
} WrJournalHeader;

/* How the lines of a journal prove that they are whole. Zeroed: not known, since the header is damaged; then
   either way counts. */
typedef struct WrJournalSeal {
    int format;   /* of the header, 1..WR_JOURNAL_FORMAT; 0: not known */
    WrHash chain; /* format 1: the checksum that the line before has written */
} WrJournalSeal;

/* Append the header line with its line end. */
void wr_journal_print_header(WrText *line, const WrJournalHeader *header);
/* Read a header line, without its line end; `line` is changed in place. No file in errors. */
bool wr_journal_parse_header(char *line, size_t length, WrJournalHeader *out, WrJournalSeal *seal,
                             WrError *err);
/* What a damaged header may have said: it makes sense, but nothing proves it. `line` is changed. */
bool wr_journal_guess_header(char *line, size_t length, WrJournalHeader *out);

/* Append a record with its line end. */
void wr_journal_print_line(WrText *line, uint64_t sequence, char kind, const char *payload);
/* Read a record, without its line end. On success *sequence is its number, and *payload is the unescaped
   text, ended with a NUL, inside `line` (which has room for the NUL). On failure `line` is as it
   was. Either way *seal is ready for the line after it. */
bool wr_journal_parse_line(char *line, size_t length, WrJournalSeal *seal, uint64_t *sequence,
                           char *kind, char **payload, size_t *payload_length, WrError *err);

/* 32 hex digits as wr_hash_print writes them. */
bool wr_journal_parse_hash(const char *text, WrHash *hash);
/* 64 lower-case hex digits. */
bool wr_journal_is_sha256(const char *text);
/* A plain file name: not empty, no slash, no dot in front. */
bool wr_journal_is_name(const char *text);
