/* ora_zip.h - reading entries of a stranger's zip archive within limits, and where an archive of ours goes.
   Layer 5. Private to this room. */
#pragma once
#include "base/sink.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <zip.h>

typedef struct WrError WrError;

typedef struct WrOraZip WrOraZip;

/* Errors name the file. Writes no files, follows no paths, never waits on a pipe. */
WrOraZip *wr_ora_zip_open(const char *path, WrError *err);
/* The same of an open file, which is taken over. */
WrOraZip *wr_ora_zip_take(const char *name, int fd, WrError *err);
void wr_ora_zip_close(WrOraZip *zip); /* NULL is fine */

/* One entry, whole, checksum verified, at most `most` bytes; the caller's (wr_free), with a NUL behind it. */
bool wr_ora_zip_read(WrOraZip *zip, const char *name, size_t most, char **bytes, size_t *length,
                     WrError *err);

/* Where an archive is written to. */
typedef struct WrOraSink {
    WrByteSink to; /* empty */
    int64_t at, end;
    int error; /* errno of the first failure */
} WrOraSink;

/* A new archive in it, which the library neither opens nor renames. The sink outlives it. */
zip_t *wr_ora_sink_open(WrOraSink *sink, WrError *err);
