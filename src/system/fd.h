/* fd.h - open files by their numbers. Every one is closed in programs that are started from here.
   Where a function fails, errno says why.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what a file is ---- */

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
    uint64_t device, inode; /* together: which file it is */
    uint64_t links;         /* names that it has */
    int64_t bytes;
    int64_t seconds, nanoseconds;                 /* of the last change to its bytes, since 1970 */
    int64_t changed_seconds, changed_nanoseconds; /* of the last change to anything of it */
} WrFileInfo;

bool wr_fd_info(int fd, WrFileInfo *info);

/* ---- opening and closing ---- */

enum {
    WR_OPEN_READ = 1,
    WR_OPEN_WRITE = 2,
    WR_OPEN_CREATE = 4,    /* if it is not there */
    WR_OPEN_NEW = 8,       /* it must not be there */
    WR_OPEN_EMPTY = 16,    /* what is in it goes */
    WR_OPEN_APPEND = 32,   /* every write goes to its end */
    WR_OPEN_NO_LINK = 64,  /* a link at the end of the path is an error */
    WR_OPEN_NO_WAIT = 128, /* for nobody at the other end of a pipe; no terminal becomes ours */
    WR_OPEN_PRIVATE = 256  /* a new one is nobody else's to read */
};

int wr_fd_open(const char *path, unsigned how); /* -1 */
bool wr_fd_close(int fd);
int wr_fd_copy(int fd); /* another number of the same opening; -1 */
/* The C library's stream of it, which closes it; NULL, and fd is as it was. */
FILE *wr_fd_stream(int fd, const char *mode);
bool wr_stream_seek(FILE *stream, int64_t at);
int64_t wr_stream_tell(FILE *stream);
int wr_stream_byte(FILE *stream); /* as getc, for who has the stream to himself */
bool wr_stream_info(FILE *stream, WrFileInfo *info);

/* A name under which a library that takes nothing but names can open what is open here. Opening it again need not
   give a position of its own: seek first. */
#define WR_FD_NAME 32
void wr_fd_name(int fd, char name[WR_FD_NAME]);
/* Open for reading once more. On Linux with a position of its own. */
int wr_fd_again(int fd);

/* Close all from `from` to `to`, both counted in; to < 0: all from `from`. */
void wr_fd_close_range(int from, int to);
/* `to` becomes another number of `fd`, which stays in programs that are started. */
bool wr_fd_place(int fd, int to);
/* Another number of `fd` that is at least `least`; likewise. */
int wr_fd_copy_above(int fd, int least);
/* Standard input, output and error, by their numbers, lead nowhere. */
#define WR_FD_IN 0
#define WR_FD_OUT 1
#define WR_FD_ERR 2
bool wr_fd_nowhere(int fd);
int wr_fd_open_nowhere(void); /* what reads as empty and forgets what is written; -1 */

/* ---- bytes ---- */

/* Up to `length` bytes, whatever interrupts it; 0 at the end, -1. */
int64_t wr_fd_read(int fd, void *bytes, size_t length);
int64_t wr_fd_read_at(int fd, void *bytes, size_t length, int64_t at);
/* All of them, whatever interrupts it. */
bool wr_fd_write(int fd, const void *bytes, size_t length);
bool wr_fd_write_at(int fd, const void *bytes, size_t length, int64_t at);
/* Where the next byte is read or written; -1. */
int64_t wr_fd_seek(int fd, int64_t at);
int64_t wr_fd_tell(int fd);
bool wr_fd_cut(int fd, int64_t length);
/* From where both are to the end of `from`, by the file system itself, which may share blocks. 1: done; 0: it
   cannot, nothing was copied; -1: it failed on the way. */
int wr_fd_copy_blocks(int from, int to);

/* Give back the room of bytes that nobody will read again, which become 0; where that cannot be, nothing happens. */
void wr_fd_forget(int fd, int64_t at, int64_t length);

bool wr_fd_sync(int fd);       /* bytes and facts are on the disk */
bool wr_fd_sync_bytes(int fd); /* the bytes, and what finding them needs */

/* A lock that goes with the opening, for those who ask for one; nobody waits. */
typedef enum WrLock { WR_LOCK_NONE, WR_LOCK_SHARED, WR_LOCK_ALONE } WrLock;
bool wr_fd_lock(int fd, WrLock lock);

/* ---- files without a name ---- */

/* An empty file in memory, or where that cannot be in the folder for temporary files; -1. name: for those who list
   open files. */
int wr_fd_memory(const char *name);
/* One of `bytes` zeros that nobody who gets it can make shorter or longer; -1, also where the system knows no such
   thing. */
int wr_fd_memory_fixed(const char *name, size_t bytes);

/* Both ends of a pipe: [0] is read, [1] written. wait false: neither end ever waits. */
bool wr_fd_pipe(int ends[2], bool wait);

/* Bytes that nobody can know beforehand. */
bool wr_random_bytes(void *bytes, size_t length);

#ifdef __cplusplus
}
#endif
