/* exr_written_check.h - completeness check of a multi-part or tiled OpenEXR file just written in sequential
   order.
   Private to this module.

   The library writes the tables of chunk offsets when it closes a file, and does not report failures.
   Readers then find zeros; some search the file, others fail. Here every entry must be the end of the
   chunk before it, and the last chunk must end at the end of the file. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Single-part scanline files are skipped: the library reports their failures. Errors do not name the
 * file. */
bool wr_exr_check_chunks(int fd, WrError *err);
