/* simple_formats.h - readers of simple image formats, without a library.

   PNM of numbers (P1, P2, P3, P5, P6; OpenImageIO reads half of all 16-bit codes one too low, and no P1
   without spaces), GIMP's patterns (.pat), SRTM elevations (.hgt) and run-length BMP (OpenImageIO rejects
   an end of line before the end of the bitmap, which ImageMagick writes). Part of the reading of untrusted
   files: the reader process, or reading "inside".
   Private to this module. */
#pragma once
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrPlain WrPlain;

/* True if a file is one of these formats, by its first bytes or else by its extension. */
bool wr_plain_knows(const unsigned char *bytes, size_t count, const char *ending);
/* fd: open for reading, borrowed for the call. Errors: one sentence that does not name the file. */
WrPlain *wr_plain_open(int fd, bool *memory, WrError *err);
void wr_plain_close(WrPlain *plain); /* NULL is allowed */

WrImagePart wr_plain_part(const WrPlain *plain);
/* "wrinkle:no-data" if NaN marks missing values; else NULL. */
const char *wr_plain_attribute(const WrPlain *plain, const char *name);
/* Reads rows and the first `channels` channels as in WrImage. Missing elevations are NaN. */
bool wr_plain_read(WrPlain *plain, int y, int rows, int channels, float *out, WrError *err);
