/* simple_formats.h - pictures of formats so plain that they are read here, without a library: PNM of numbers (P2, P3, P5,
   P6; OpenImageIO gives half of 16-bit codes one too low), GIMP's patterns (.pat), SRTM elevations (.hgt) and run-length
   BMP (OpenImageIO refuses the end of line before the end of the bitmap, which ImageMagick writes).
   Part of what reads strangers' files: the reader process, or reading "inside".
   Private to this module. */
#pragma once
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrPlain WrPlain;

/* Whether a file that begins so, or failing that whose name ends so, is one of these. */
bool wr_plain_knows(const unsigned char *bytes, size_t count, const char *ending);
/* fd: open for reading, borrowed for the call. Errors: one sentence that does not name the file. */
WrPlain *wr_plain_open(int fd, bool *memory, WrError *err);
void wr_plain_close(WrPlain *plain); /* NULL is fine */

WrImagePart wr_plain_part(const WrPlain *plain);
/* "wrinkle:no-data" where NaN marks missing values; else NULL. */
const char *wr_plain_attribute(const WrPlain *plain, const char *name);
/* Rows and the first `channels` channels as WrImage has them. What an elevation does not know is NaN. */
bool wr_plain_read(WrPlain *plain, int y, int rows, int channels, float *out, WrError *err);
