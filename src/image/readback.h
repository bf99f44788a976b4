/* readback.h - reading back a picture file that was just written, by the reader process.
   Private to this module. */
#pragma once
#include "image/format.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrHash WrHash;
typedef struct WrImageOut WrImageOut;

/* Does a file hold what was written to it?
 *
 * name     of the file, for its ending
 * fd       the file; borrowed, its position stays
 * format   where it keeps numbers exactly, every texel is compared; else all rows must be readable
 * digests  [count] of the parts' rows (decode.h) as they were given to the writer
 * Errors   what is wrong with it, without its name */
bool wr_image_verify(const char *name, int fd, const WrImageFormat *format, const WrImageOut *parts,
                     int count, const WrHash *digests, WrError *err);
