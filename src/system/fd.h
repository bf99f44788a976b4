/* fd.h - open files (descriptors). All of them are closed in started programs.

   Functions that fail set errno.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- file information ---- */

typedef enum WrKind {
    WR_KIND_FILE,
    WR_KIND_FOLDER,
    WR_KIND_LINK,
    WR_KIND_PIPE,
    WR_KIND_SOCKET,
    WR_KIND_DEVICE,
    WR_KIND_OTHER
} WrKind;

typedef struct WrFileInfo {
    WrKind kind;
    uint64_t device, inode; /* both together identify the file */
    uint64_t links;         /* number of hard links */
    int64_t bytes;
    int64_t seconds, nanoseconds;                 /* of the last content change, since 1970 */
    int64_t changed_seconds, changed_nanoseconds; /* of the last change of content or metadata */
} WrFileInfo;

bool wr_fd_info(int fd, WrFileInfo *info);

/* ---- opening and closing ---- */

enum {
    WR_OPEN_READ = 1,
    WR_OPEN_WRITE = 2,
    WR_OPEN_CREATE = 4,    /* create it if missing */
    WR_OPEN_NEW = 8,       /* fail if it exists */
    WR_OPEN_EMPTY = 16,    /* truncate */
    WR_OPEN_APPEND = 32,   /* every write appends */
    WR_OPEN_NO_LINK = 64,  /* fail if the path is a symbolic link */
    WR_OPEN_NO_WAIT = 128, /* do not wait for the other end of a pipe; do not adopt a controlling
                              terminal */
    WR_OPEN_PRIVATE = 256  /* a new file is accessible by its owner only */
};

int wr_fd_open(const char *path, unsigned how); /* -1 */
bool wr_fd_close(int fd);
int wr_fd_copy(int fd); /* duplicate that shares the position; -1 */
/* A C stream for it, which closes it; on failure NULL, and fd is unchanged. */
FILE *wr_fd_stream(int fd, const char *mode);
bool wr_stream_seek(FILE *stream, int64_t at);
int64_t wr_stream_position(FILE *stream);
int wr_stream_byte(FILE *stream); /* getc for streams used by one thread only */
bool wr_stream_info(FILE *stream, WrFileInfo *info);

/* A name by which a library that accepts only names can open this descriptor. The second opening may
   share the position: seek first. */
#define WR_FD_NAME 32
void wr_fd_name(int fd, char name[WR_FD_NAME]);
/* Opens the file again for reading. On Linux with a position of its own. */
int wr_fd_reopen(int fd);

/* Closes all from `from` to `to` inclusive; to < 0: no upper end. */
void wr_fd_close_range(int from, int to);
/* Makes `to` a duplicate of `fd` that started programs inherit. */
bool wr_fd_place(int fd, int to);
/* A duplicate of `fd`, at least `least`, that started programs inherit. */
int wr_fd_copy_above(int fd, int least);
/* Redirects standard input, output or error, by number, to nowhere. */
#define WR_FD_IN 0
#define WR_FD_OUT 1
#define WR_FD_ERR 2
bool wr_fd_nowhere(int fd);
int wr_fd_open_nowhere(void); /* reads as empty and discards all writes; -1 */

/* ---- bytes ---- */

/* Reads up to `length` bytes, also after interrupts; 0 at the end, -1 on failure. */
int64_t wr_fd_read(int fd, void *bytes, size_t length);
int64_t wr_fd_read_at(int fd, void *bytes, size_t length, int64_t at);
/* Writes all bytes, also after interrupts. */
bool wr_fd_write(int fd, const void *bytes, size_t length);
bool wr_fd_write_at(int fd, const void *bytes, size_t length, int64_t at);
/* Position of the next byte read or written; -1. */
int64_t wr_fd_seek(int fd, int64_t at);
int64_t wr_fd_position(int fd);
bool wr_fd_cut(int fd, int64_t length);
/* Copies from both present positions to the end of `from` in the file system, which may share blocks.
   1: done; 0: unsupported, nothing was copied; -1: failed midway. */
int wr_fd_copy_blocks(int from, int to);

/* Frees the space of bytes that are no longer needed; they become 0. Does nothing where unsupported. */
void wr_fd_punch_hole(int fd, int64_t at, int64_t length);

/* Starts writing the content to the disk and returns at once. Does nothing where unsupported. */
void wr_fd_begin_sync(int fd);
bool wr_fd_sync(int fd);       /* content and metadata are on the disk */
bool wr_fd_sync_bytes(int fd); /* content and the metadata needed to find it */

/* Advisory lock of the open file; never waits. */
typedef enum WrLock { WR_LOCK_NONE, WR_LOCK_SHARED, WR_LOCK_ALONE } WrLock;
bool wr_fd_lock(int fd, WrLock lock);

/* ---- files without a name ---- */

/* An empty file in memory, or in the temporary folder where unsupported; -1. name: shown in lists of
   open files. */
int wr_fd_memory(const char *name);
/* A memory file of `bytes` zeros whose size no recipient can change; -1, also where unsupported. */
int wr_fd_memory_fixed(const char *name, size_t bytes);

/* Both ends of a pipe: [0] is read, [1] written. wait false: neither end blocks. */
bool wr_fd_pipe(int ends[2], bool wait);

/* Unpredictable bytes. */
bool wr_random_bytes(void *bytes, size_t length);

#ifdef __cplusplus
}
#endif

/* ---- memory-mapped files ---- */

typedef enum WrMapFor {
    WR_MAP_READ,  /* later writes to the file need not be visible */
    WR_MAP_WATCH, /* later writes to the file are visible */
    WR_MAP_SHARE  /* writes to the memory change the file */
} WrMapFor;

/* Maps the first `length` bytes; NULL and errno. Access beyond the file's end kills the program: use it
   only for files that cannot be shortened, or where that risk is handled. */
void *wr_map(int fd, size_t length, WrMapFor what);
void wr_map_end(const void *bytes, size_t length); /* NULL is allowed */
