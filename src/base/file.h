/* file.h - whole-file reading and atomic file writes. */
#pragma once
#include "base/spool.h"
#include "system/fd.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* ---- files named by people, scripts or other files ---- */

#define WR_FILE_MAX ((uint64_t)64 << 30) /* bytes; limit of a file that has no other limit */

/* Opens a file, or the target of a link, for reading. All files from outside are opened by this
 * function. Other kinds (device, pipe, socket, folder) are rejected with an error that names the kind;
 * the call never blocks. *length, if wanted, is the present size, at most `limit`. Callers must read no
 * further, so that endless files (size 0, as in /proc) yield no bytes. Returns -1 and an error that
 * names the file on failure. */
int wr_file_open(const char *path, uint64_t limit, uint64_t *length, WrError *err);
/* Opens one of the program's own files the same way, but rejects a symbolic link, which somebody else
 * may have placed. */
int wr_file_open_no_link(const char *path, uint64_t limit, uint64_t *length, WrError *err);
/* Reads the first `count` bytes of a file to detect its format; returns the number of bytes read. */
size_t wr_file_peek(const char *path, void *bytes, size_t count);
/* Creates or truncates a file for incremental writing. Does not wait for a reader of a pipe. */
int wr_file_open_truncate(const char *path, WrError *err);

/* Reads a whole regular file, at most `limit` bytes. *bytes is owned by the caller (wr_free) and ends
   in a NUL that `length` does not count. */
bool wr_file_read(const char *path, size_t limit, char **bytes, size_t *length, WrError *err);

/* An atomic file replacement. The data is written to a temporary file in the same folder with an
   unpredictable name and owner-only access. wr_file_commit reads it back, compares checksums (xxHash)
   with those of the bytes passed in, and renames it to the target. So a disk that loses or changes
   bytes is detected here for every file format; the writer of a format checks that its content decodes
   correctly. The target keeps its mode, owner and access control list as far as permissions allow. A
   target that is a symbolic link stays a link: the file it points to is replaced. A killed process
   leaves the temporary file, whose name contains the process id; wr_file_sweep removes it. */
typedef struct WrFileTarget {
    char *path;      /* path from the user, links resolved */
    char *temporary; /* ".NAME.PID-HOST-RANDOM.part.ending" beside it */
    int fd; /* of the temporary file, open for reading; bytes written to it without wr_file_write_at
               make commit fail */
    struct WrFileSums *sums; /* checksums of the bytes passed in */
} WrFileTarget;

/* Rejects a target that is a folder, or whose folder does not exist or is not writable, before any work
   is done. Sweeps the folder. From the first call on, exceeding the file size limit is an error, not a
   signal. */
bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err);
/* Writes bytes at an offset, before or beyond the end; gaps read as 0. All writes use this function. On
 * failure returns false and sets errno. */
bool wr_file_write_at(WrFileTarget *target, const void *bytes, size_t length, int64_t at);
/* Appends bytes; on failure returns false and an error that names the file. */
bool wr_file_put(WrFileTarget *target, const void *bytes, size_t length, WrError *err);
/* A sink that writes to the target; the target must outlive it. */
WrByteSink wr_file_sink(WrFileTarget *target);
/* Compares all bytes with those passed in, syncs the temporary file, applies the target's permissions,
   renames it and syncs the folder. On failure the target is unchanged and the temporary file is
   removed. Releases the target in both cases. Errors: those of the system; "does not read back as it
   was written"; "cancelled" while reading back. */
bool wr_file_commit(WrFileTarget *target, WrError *err);
/* Removes the temporary file, if any; the target is unchanged. A zeroed target is allowed. */
void wr_file_abort(WrFileTarget *target);
/* Fails with "PATH: cannot be written (reason)". */
bool wr_file_fail(const WrFileTarget *target, const char *reason, WrError *err);
/* Describes a failed write (errno) with a remedy. `text` stores the message if it has to be assembled. */
#define WR_FILE_WHY 160
const char *wr_file_why(int error, char text[WR_FILE_WHY]);
/* Describes a failed write reported by a library: if its message contains a system message, that one is
 * described; otherwise the library's message is returned. */
const char *wr_file_why_of_library(const char *reason, char text[WR_FILE_WHY]);

/* ---- several files together ---- */

/* Files that are replaced together. After begin, wr_file_commit in this thread leaves each file under
 * its temporary name, complete and synced. wr_file_group_commit then renames all of them; if one rename
 * fails, it restores the previous files. If the process is killed meanwhile, a list in the folder lets
 * the next wr_file_sweep (the next program that writes or opens a file there) finish the renames.
 *
 * Threads  a group belongs to one thread; one group at a time
 * Errors   write errors; then every target is unchanged, except those named in the error, whose
 *          previous file the disk could not restore
 * Limits   links to files of other folders are supported, but a kill may separate those from the rest
 *          of the group */
typedef struct WrFileGroup WrFileGroup;
WrFileGroup *wr_file_group_begin(void);
bool wr_file_group_commit(WrFileGroup *group, WrError *err); /* releases it in both cases */
void wr_file_group_abort(WrFileGroup *group);                /* NULL is allowed */
bool wr_file_group_is_open(void);                            /* true if this thread has a group */
/* Temporary path of the last committed file of the group; NULL if none. Valid until the group ends. */
const char *wr_file_group_last(void);

/* Removes the half-written files of this user's killed programs from a folder, and finishes their
   interrupted group commits. Only files are removed whose name contains a dead process of this machine
   and that nobody has locked. */
void wr_file_sweep(const char *folder);
/* Hash of this machine's name: HOST above, in hexadecimal. */
uint32_t wr_file_host(void);

/* Writes bytes to path as one atomic replacement. */
bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err);

/* Makes exceeding the file size limit an error of write() instead of a fatal signal. */
void wr_file_outlive_size_limit(void);

/* Returns a memory file that contains the bytes, positioned at its start; -1 on failure. name: for the
 * error. The caller closes it. */
int wr_fd_in_memory(const char *name, const void *bytes, size_t length, WrError *err);

/* The folder part of a path: "a/b.c" -> "a", "b.c" -> ".". Caller frees with wr_free. */
char *wr_path_folder(const char *path);
/* `path` relative to `folder`; absolute paths are unchanged. Caller frees. */
char *wr_path_join(const char *folder, const char *path);
/* The extension in lower case without its dot ("PNG" file -> "png"), "" if none. Points into `buffer`. */
const char *wr_path_ending(const char *path, char buffer[16]);

/* Makes a folder for temporary files, in $TMPDIR or /tmp, accessible by this user only. wr_scratch_free removes it with its
   files. NULL and an error. */
char *wr_scratch_new(WrError *err);
void wr_scratch_free(char *folder); /* NULL is allowed */

/* Path of a settings file: NAME in the folder wrinkle of $XDG_CONFIG_HOME, or of ~/.config. Caller
   frees with wr_free; NULL if neither is known. */
char *wr_config_path(const char *name);

/* Finds a data file that ships with the program ("samples/bricks.wrinkle"). Search order:
 * $WRINKLE_DATA, ../share/wrinkle beside the program's folder (installed), the folder above it (a build
 * folder inside a checkout), the checkout that the file wrinkle.checkout in its folder names (any build
 * folder). Returns false if not found. */
bool wr_data_find(const char *name, WrText *path);
/* Finds a file or folder that another program installs ("gimp/2.0/brushes") in the folders of
 * $XDG_DATA_DIRS; the first match wins. Returns false if not found. */
bool wr_shared_find(const char *name, WrText *path);
/* Folder of the running program. Caller frees with wr_free. */
char *wr_program_folder(void);
/* Sets it, for libraries in other programs; NULL: as above. Call it before other functions use the folder. */
void wr_program_folder_set(const char *folder);

/* ---- identity ---- */

/* Identity of the file under a path, to detect that it was replaced or changed since
   it was read. */

typedef struct WrFileIdentity {
    bool there; /* false: no such file; the other members are 0 */
    uint64_t device, inode;
    int64_t bytes;
    int64_t seconds, nanoseconds; /* of the last content change, since 1970 */
} WrFileIdentity;

/* Returns the identity of the file under this path; symbolic links are followed. */
WrFileIdentity wr_file_identity(const char *path);
/* True for the same unchanged file, or if both are missing. */
bool wr_file_identity_same(const WrFileIdentity *a, const WrFileIdentity *b);
