/* png.h - whether a PNG file is whole, before the library sees it: libpng allocates what a damaged length
   says, and forgives a missing end.
   Private to this module. Source: PNG specification (ISO/IEC 15948), 5.3 chunk layout, annex D. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

typedef struct WrError WrError;

/* Walks the chunks of an open file that starts with the PNG signature: lengths stay inside the file,
 * every CRC is right, the last chunk is IEND. The message does not name the file. */
bool wr_png_check(FILE *file, WrError *err);
