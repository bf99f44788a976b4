/* png.h - PNG files: a codec based on libpng, and an integrity check before libpng reads a file.

   The codec is available at once; loading OpenImageIO needs a quarter of a second. Results equal those of OpenImageIO:
   palettes as colours, codes of fewer than 8 bits as 8, transparency as alpha, the program's texts from the
   description. libpng allocates the size that a damaged length implies, and tolerates a missing end; hence the check.
   Private to this module.
   Source: PNG specification (ISO/IEC 15948), 5.3 chunk layout, annex D. */
#pragma once
#include "image/codec.h"

#include <stdbool.h>
#include <stdio.h>

/* Walks the chunks of an open file that starts with the PNG signature: lengths must stay inside the
 * file, every CRC must be right, the last chunk must be IEND. The message does not name the file. */
bool wr_png_check(FILE *file, WrError *err);

extern const WrCodec wr_png_codec; /* format: "png", one part */
