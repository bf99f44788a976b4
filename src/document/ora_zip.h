/* ora_zip.h - zip archives: reading of untrusted entries within limits, and output of our own. Private to this
   module. */
#pragma once
#include "base/sink.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <zip.h>

typedef struct WrError WrError;

typedef struct WrOraZip WrOraZip;

/* Opens an archive. Errors name the file. Writes no files, follows no paths, never waits on a pipe. */
WrOraZip *wr_ora_zip_open(const char *path, WrError *err);
/* Opens an archive from an open file, which it takes ownership of. */
WrOraZip *wr_ora_zip_take(const char *name, int fd, WrError *err);
void wr_ora_zip_close(WrOraZip *zip); /* NULL is fine */

/* Reads one entry, whole, with verified checksum, at most `most` bytes; owned by the caller (wr_free), followed
   by a NUL. */
bool wr_ora_zip_read(WrOraZip *zip, const char *name, size_t most, char **bytes, size_t *length,
                     WrError *err);

/* Destination of a written archive. */
typedef struct WrOraSink {
    WrByteSink to; /* must be empty */
    int64_t at, end;
    int error; /* errno of the first failure */
} WrOraSink;

/* Creates an archive in the sink, which the library neither opens nor renames. The sink must outlive it. */
zip_t *wr_ora_sink_open(WrOraSink *sink, WrError *err);
