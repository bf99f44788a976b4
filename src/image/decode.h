/* decode.h - a picture file read within this process: finds out the format and drives the module. What
   the reader process does for strangers' files, and what reading "inside" does without it.
   Private to this module. */
#pragma once
#include "base/hash.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

typedef struct WrDecoder WrDecoder;

/* Whether reading the file takes the module that holds OpenImageIO (oiio.h): its first bytes, and the ending of its
 * name where they tell nothing, say so. */
bool wr_decoder_takes_module(int fd, const char *ending);

/* Open a picture.
 *
 * fd       a regular file or a memory file, open for reading; borrowed, and kept until close
 * ending   of the file's name: what it is believed to be where its first bytes tell nothing
 * most     parts up to this many; more is an error
 * numbers  integers that are measurements are read as numbers (codec.h)
 * memory   set to whether the failure was one of memory; may be NULL
 * Errors   one sentence that does not name the file */
WrDecoder *wr_decoder_open(int fd, const char *ending, int most, bool numbers, bool *memory,
                           WrError *err);
void wr_decoder_close(WrDecoder *decoder); /* NULL is fine */

int wr_decoder_parts(const WrDecoder *decoder);
WrImagePart wr_decoder_part(const WrDecoder *decoder, int part); /* valid until close */
/* A text attribute or NULL; valid until close. */
const char *wr_decoder_attribute(const WrDecoder *decoder, int part, const char *name);
/* Rows [y, y + rows) and the first `channels` channels as WrImage has them, interleaved. */
bool wr_decoder_read(WrDecoder *decoder, int part, int y, int rows, int channels, float *out,
                     bool *memory, WrError *err);

/* The digest of a part: its values, WR_IMAGE_STRIP rows at a time, each strip's chained into the one above. */
static inline void wr_digest_strip(WrHash *digest, const float *values, size_t count)
{
    *digest = wr_hash_bytes(values, count * sizeof *values, *digest);
}
/* Chain rows [y, y + rows) into *digest, y a multiple of WR_IMAGE_STRIP. Holds one strip. */
bool wr_decoder_digest(WrDecoder *decoder, int part, int y, int rows, int channels, WrHash *digest,
                       bool *memory, WrError *err);
