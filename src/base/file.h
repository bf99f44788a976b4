/* file.h - whole files in, and files out that are there whole or not at all.
   Layer 0. */
#pragma once
#include "base/text.h"

/* Read a whole regular file, at most `limit` bytes. *bytes is the caller's (wr_free) and ends in a NUL
   that `length` does not count. */
bool wr_file_read(const char *path, size_t limit, char **bytes, size_t *length, WrError *err);

/* A file being replaced: write to `temporary` (same folder, same ending, so that libraries that go by
   the name know the format), then commit. The target keeps its mode and, if it is a symbolic link,
   stays one: the file behind it is replaced. */
typedef struct WrFileTarget {
    char *path;      /* what the user named, links resolved */
    char *temporary; /* does not exist before begin */
} WrFileTarget;

/* Refuses a target that is a folder, or whose folder does not exist or cannot be written, before any
   work is done. */
bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err);
/* Sync the temporary file and its folder and rename it over the target. On failure the target is as
   it was and the temporary file is gone. Releases the target either way. */
bool wr_file_commit(WrFileTarget *target, WrError *err);
/* Remove the temporary file, if any; the target stays as it was. Fine on a zeroed target. */
void wr_file_abort(WrFileTarget *target);

/* Write bytes to path as one whole replacement. */
bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err);

/* Write all bytes to an open file, whatever interrupts it. False with errno on failure. */
bool wr_fd_write(int fd, const void *bytes, size_t length);
/* The bytes as an open file that lies in memory, at its beginning; -1 on failure. name: for the error. The
 * caller closes it. */
int wr_fd_in_memory(const char *name, const void *bytes, size_t length, WrError *err);

/* The folder part of a path: "a/b.c" -> "a", "b.c" -> ".". Caller frees with wr_free. */
char *wr_path_folder(const char *path);
/* `path` as seen from `folder`; absolute paths stay. Caller frees. */
char *wr_path_join(const char *folder, const char *path);
/* The ending in lower case without its dot ("PNG" file -> "png"), "" if none. Points into `buffer`. */
const char *wr_path_ending(const char *path, char buffer[16]);

/* Find a data file that ships with the program ("samples/bricks.wrinkle"): under $WRINKLE_DATA, under
 * ../share/wrinkle beside the program's folder (installed), or in the folder above it (a build folder
 * inside a checkout). False if it is in none. */
bool wr_data_find(const char *name, WrText *path);
/* The folder that holds the running program. Caller frees with wr_free. */
char *wr_program_folder(void);
