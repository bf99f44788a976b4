/* journal_line.h - encoding of one line of a journal: escapes, checksums, the header. Private to this module. */
#pragma once
#include "document/journal.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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
