/* journal_folder.h - file operations of the journal folder: creation, locks, neighbouring files, removal.
   Private to this module. */
#pragma once
#include "document/recover.h"

#include "system/fd.h"

#include <stdbool.h>

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

/* wr_journal_keep_file for the journal whose files are in `files`, inside `folder`. from: a descriptor at the
   beginning of the content, or -1: the file at `path` is read. */
bool wr_journal_keep(const char *folder, const char *files, const char *path, int from,
                     const char *sha256, WrError *err);

/* wr_journal_keep_named for the journal whose files are in `files`. */
bool wr_journal_keep_as_named(const char *files, const char *path, WrError *err);

/* Removes the files of NAME.files/ except those named keep_a or (before its extension) keep_b, either NULL; also
   the folder if it is then empty. */
void wr_journal_clear_files(const char *files, const char *keep_a, const char *keep_b);
/* Removes incomplete files of killed programs from the folder, if they are older than a day. */
void wr_journal_sweep(const char *folder);

/* wr_journal_read for an open, unread file; `path` is used for messages and for the snapshot's path. The caller
   closes fd. */
bool wr_journal_read_fd(int fd, const char *path, WrJournalRead *out, WrError *err);
