/* file.h - whole files in, and files out that are there whole or not at all.
   Layer 0. */
#pragma once
#include "base/sink.h"
#include "system/fd.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* ---- files that somebody else names: people, scripts, other files ---- */

#define WR_FILE_MOST ((uint64_t)64 << 30) /* bytes of a file that nothing else limits */

/* The one door to them: open a file, or what stands behind a link to one, for reading. Whatever else is
 * there (a device, a pipe, a socket, a folder) is refused by what it is; nothing is ever waited for.
 * *length, if wanted, is its size now, at most `limit`: whoever reads goes no further, so that what has no end
 * (and says 0, as in /proc) gives nothing. -1 and an error that names the file. */
int wr_file_open(const char *path, uint64_t limit, uint64_t *length, WrError *err);
/* The same for files of our own, where a link was put there by somebody else. */
int wr_file_open_no_link(const char *path, uint64_t limit, uint64_t *length, WrError *err);
/* The first `count` bytes of such a file, to see what it is; returns how many there are. */
size_t wr_file_peek(const char *path, void *bytes, size_t count);
/* A file that is written bit by bit, emptied if it is there; a pipe that nobody reads is not waited for. */
int wr_file_create(const char *path, WrError *err);

/* Read a whole regular file, at most `limit` bytes. *bytes is the caller's (wr_free) and ends in a NUL
   that `length` does not count. */
bool wr_file_read(const char *path, size_t limit, char **bytes, size_t *length, WrError *err);

/* A file being replaced. What is written goes to a file of its own in the same folder that nobody else can read, guess
   or have put there; commit gives it the target's name once it is whole and holds the very bytes that were handed over:
   their checksums are kept (xxHash) and compared with those of what the file gives back. So a disk that loses or
   changes something is noticed for every kind of file in this one place; that a picture decodes to the right
   values is for whoever writes it to see. The target keeps its mode, owner and list of rights as far as we may give them; if it is
   a symbolic link, it stays one: the file behind it is replaced. A kill leaves that file behind, under
   a name that tells the process; wr_file_sweep removes it. */
typedef struct WrFileTarget {
    char *path;      /* what the user named, links resolved */
    char *temporary; /* ".NAME.PID-HOST-RANDOM.part.ending" beside it */
    int fd; /* of the temporary file, to be read. What is written to it past wr_file_write_at fails commit */
    struct WrFileSums *sums; /* of what was handed over */
} WrFileTarget;

/* Refuses a target that is a folder, or whose folder does not exist or cannot be written, before any
   work is done. Sweeps the folder. From the first call on a limit on file sizes is an error, no signal. */
bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err);
/* The one way in: bytes at an offset, before the end or behind it; what nobody writes is 0. False and errno. */
bool wr_file_write_at(WrFileTarget *target, const void *bytes, size_t length, int64_t at);
/* At the end; false and an error that names the file. */
bool wr_file_put(WrFileTarget *target, const void *bytes, size_t length, WrError *err);
/* The target as a sink; it outlives that. */
WrByteSink wr_file_sink(WrFileTarget *target);
/* Compare all bytes with what was handed over, sync the temporary file, give it the target's rights and name, and sync
   the folder. On failure the target is as it was and the temporary file is gone. Releases the target either way.
   Errors: those of the system; "does not read back as it was written"; "cancelled", where there is much to read. */
bool wr_file_commit(WrFileTarget *target, WrError *err);
/* Remove the temporary file, if any; the target stays as it was. Fine on a zeroed target. */
void wr_file_abort(WrFileTarget *target);
/* "PATH: cannot be written (reason)". */
bool wr_file_fail(const WrFileTarget *target, const char *reason, WrError *err);
/* What the system says of a write that failed (errno), and what would help; kept in text where words are put
   together. */
#define WR_FILE_WHY 160
const char *wr_file_why(int error, char text[WR_FILE_WHY]);
/* The same where a library tells of it in words of its own, among them the system's; else those words. */
const char *wr_file_why_told(const char *reason, char text[WR_FILE_WHY]);

/* ---- several files together ---- */

/* Files that take their places together. From begin on, what this thread commits (wr_file_commit) stays under its
 * temporary name, whole and on the disk, and is only noted; commit then gives all of them their names, and where one
 * fails puts back what stood there before. A kill on the way leaves a list of them in their folder, by which
 * wr_file_sweep, that is the next program that writes or opens something there, gives the rest their names too.
 *
 * Threads  a group belongs to one, and there is one group at a time
 * Errors   those of writing; then every target is as it was, but for those that the error names: the disk did not let
 *          what stood there be put back
 * Links to files of another folder get their files as well, but a kill may come between those and the others. */
typedef struct WrFileGroup WrFileGroup;
WrFileGroup *wr_file_group_begin(void);
bool wr_file_group_commit(WrFileGroup *group, WrError *err); /* ends it either way */
void wr_file_group_abort(WrFileGroup *group);                /* likewise; NULL is fine */
bool wr_file_group_is_open(void);                            /* of this thread */
/* Where the file that was committed last lies meanwhile; NULL: there is none. Valid until the group's end. */
const char *wr_file_group_last(void);

/* Remove what killed programs of this user left half-written in a folder, and end what they had begun with a group of
   whole files: the name must tell a process of this machine that is gone, and nobody may hold the file. */
void wr_file_sweep(const char *folder);
/* A number of this machine, by its name: HOST above, in hexadecimal. */
uint32_t wr_file_host(void);

/* Write bytes to path as one whole replacement. */
bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err);

/* Have a limit on file sizes be an error of write(), not the end of the program. */
void wr_file_outlive_size_limit(void);

/* The bytes as an open file that lies in memory, at its beginning; -1 on failure. name: for the error. The
 * caller closes it. */
int wr_fd_in_memory(const char *name, const void *bytes, size_t length, WrError *err);

/* The folder part of a path: "a/b.c" -> "a", "b.c" -> ".". Caller frees with wr_free. */
char *wr_path_folder(const char *path);
/* `path` as seen from `folder`; absolute paths stay. Caller frees. */
char *wr_path_join(const char *folder, const char *path);
/* The ending in lower case without its dot ("PNG" file -> "png"), "" if none. Points into `buffer`. */
const char *wr_path_ending(const char *path, char buffer[16]);

/* A file of the user's settings: NAME in the folder wrinkle of $XDG_CONFIG_HOME, or of ~/.config. Caller frees with
   wr_free; NULL where neither is known. */
char *wr_config_path(const char *name);

/* Find a data file that ships with the program ("samples/bricks.wrinkle"): under $WRINKLE_DATA, under
 * ../share/wrinkle beside the program's folder (installed), in the folder above it (a build folder inside a
 * checkout), or in the checkout that it was built from, while it lies in its build folder. False if it is in
 * none. */
bool wr_data_find(const char *name, WrText *path);
/* The folder that holds the running program. Caller frees with wr_free. */
char *wr_program_folder(void);
