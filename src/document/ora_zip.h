/* ora_zip.h - reading entries of a stranger's zip archive within limits.
   Layer 5. Private to this room. */
#pragma once
#include "base/text.h"

typedef struct WrOraZip WrOraZip;

/* Errors name the file. Writes no files, follows no paths, never waits on a pipe. */
WrOraZip *wr_ora_zip_open(const char *path, WrError *err);
void wr_ora_zip_close(WrOraZip *zip); /* NULL is fine */

/* One entry, whole, checksum verified, at most `most` bytes; the caller's (wr_free), with a NUL behind it. */
bool wr_ora_zip_read(WrOraZip *zip, const char *name, size_t most, char **bytes, size_t *length,
                     WrError *err);
