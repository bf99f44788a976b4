/* journal_line.h - one line of a journal as bytes: escapes, checksums, the header.
   Layer 5. Private to this room. */
#pragma once
#include "document/journal.h"

/* A header as read; strings point into the line that it was read from. */
typedef struct WrJournalHeader {
    WrJournalStart start; /* snapshot: the name without a folder; path and sha256 may be NULL */
    const char *program;
    int64_t time; /* seconds since 1970 */
} WrJournalHeader;

/* Append the header line with its line end. *chain becomes its checksum. */
void wr_journal_print_header(WrText *line, const WrJournalHeader *header, WrHash *chain);
/* Read a header line, without its line end; `line` is changed in place. No file in errors. */
bool wr_journal_parse_header(char *line, size_t length, WrJournalHeader *out, WrHash *chain,
                             WrError *err);

/* Append a record with its line end. *chain: the line before's checksum, then this one's. */
void wr_journal_print_line(WrText *line, uint64_t sequence, char kind, const char *payload,
                           WrHash *chain);
/* Read a record, without its line end. On success *chain moves on, and *payload is the unescaped
   text, ended with a NUL, inside `line` (which has room for the NUL). On failure `line` is as it
   was. */
bool wr_journal_parse_line(char *line, size_t length, uint64_t sequence, WrHash *chain, char *kind,
                           char **payload, size_t *payload_length, WrError *err);

/* 32 hex digits as wr_hash_print writes them. */
bool wr_journal_parse_hash(const char *text, WrHash *hash);
/* 64 lower-case hex digits. */
bool wr_journal_is_sha256(const char *text);
/* A plain file name: not empty, no slash, no dot in front. */
bool wr_journal_is_name(const char *text);
