/* png.h - integrity check of a PNG file before libpng reads it.

   libpng allocates the size that a damaged length gives, and tolerates a missing end.
   Private to this module.
   Source: PNG specification (ISO/IEC 15948), 5.3 chunk layout, annex D. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

typedef struct WrError WrError;

/* Walks the chunks of an open file that starts with the PNG signature: lengths must stay inside the
 * file, every CRC must be right, the last chunk must be IEND. The message does not name the file. */
bool wr_png_check(FILE *file, WrError *err);
