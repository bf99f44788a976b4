/* readback.h - verification of a newly written image file by the reader process.
   Private to this module. */
#pragma once
#include "image/format.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrHash WrHash;
typedef struct WrImageOut WrImageOut;

/* Compares a file with the data written to it.
 *
 * name     of the file, for its extension
 * fd       the file; borrowed, its position is unchanged
 * format   if lossless, every texel is compared; else all rows must be readable
 * digests  [count] of the parts' rows (decode.h) as passed to the writer
 * Errors   the difference, without the file's name */
bool wr_image_verify(const char *name, int fd, const WrImageFormat *format, const WrImageOut *parts,
                     int count, const WrHash *digests, WrError *err);
