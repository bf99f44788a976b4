/* journal_folder.h - the folder of journals: making it, locks, what lies beside a journal, removal.
   Layer 5. Private to this room. */
#pragma once
#include "document/recover.h"

#include "system/fd.h"

#include <stdbool.h>

#define WR_JOURNAL_ENDING ".wj"
#define WR_JOURNAL_FILES_ENDING ".files"
#define WR_JOURNAL_SNAPSHOT_NAME "snapshot-%d.exr"
#define WR_JOURNAL_LEFTOVER_SECONDS 86400 /* a leftover that nobody needs stays that long */

/* Make a folder and those above it, mode 0700 each; fine if it is there. */
bool wr_journal_make_folder(const char *path, WrError *err);
/* "X/NAME.wj" -> "X/NAME.files". Caller frees. */
char *wr_journal_files_folder(const char *journal_path);

/* The name of the last snapshot that was begun in NAME.files/. Caller frees; NULL if there is none. */
char *wr_journal_newest_snapshot(const char *files);

/* Sync a file, or a folder so that the names in it are on the disk. Some file systems cannot sync
   folders; that is no failure. */
bool wr_journal_sync_path(const char *path, WrError *err);

/* Open a journal without following a link or waiting for a pipe: -1 with an error unless it is a
   regular file. */
int wr_journal_open(const char *path, WrError *err);
/* Lock without waiting. False: another program has it, or `path`
   no longer names this file. */
bool wr_journal_lock(int fd, const char *path, WrLock how);

/* wr_journal_keep_file for the journal whose files are in `files`, one of those of `folder`. from: its content, open at
   its beginning, or -1: that of the file at `path`. */
bool wr_journal_keep(const char *folder, const char *files, const char *path, int from,
                     const char *sha256, WrError *err);

/* wr_journal_keep_named. */
bool wr_journal_keep_as_named(const char *files, const char *path, WrError *err);

/* Remove the files of NAME.files/ but those called keep_a or (in front of its ending) keep_b,
   either NULL; the folder too if it is empty then. */
void wr_journal_clear_files(const char *files, const char *keep_a, const char *keep_b);
/* Remove what killed programs left half made in the folder, if it is older than a day. */
void wr_journal_sweep(const char *folder);

/* wr_journal_read of an open file of which nothing has been read; `path` is for messages and for
   the snapshot's place. The caller closes fd. */
bool wr_journal_read_fd(int fd, const char *path, WrJournalRead *out, WrError *err);
