/* decode.h - image decoding in the present process: format detection and calls of the codec.

   Called in the reader process for untrusted files, and directly if the reader runs "inside".
   Private to this module. */
#pragma once
#include "base/hash.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

typedef struct WrDecoder WrDecoder;

/* True if reading the file needs the module with OpenImageIO (oiio.h), judged by its first bytes or
 * else the extension of its name. False for all OpenEXR files: wr_decoder_lacks_module. */
bool wr_decoder_takes_module(int fd, const char *ending);
/* True for an OpenEXR file that needs that module. Parses its header: only in a sandbox. most: as below. */
bool wr_decoder_lacks_module(int fd, int most);

/* Opens an image.
 *
 * fd       a regular file or a memory file, open for reading; borrowed until close
 * ending   extension of the file's name: its assumed format if the first bytes are not characteristic
 * most     maximum number of parts; more is an error
 * numbers  integers that are measurements are read as numbers (codec.h)
 * memory   set to true if the failure was lack of memory; may be NULL
 * Errors   one sentence that does not name the file */
WrDecoder *wr_decoder_open(int fd, const char *ending, int most, bool numbers, bool *memory,
                           WrError *err);
void wr_decoder_close(WrDecoder *decoder); /* NULL is allowed */

int wr_decoder_parts(const WrDecoder *decoder);
WrImagePart wr_decoder_part(const WrDecoder *decoder, int part); /* valid until close */
/* A text attribute or NULL; valid until close. */
const char *wr_decoder_attribute(const WrDecoder *decoder, int part, const char *name);
/* Rows [y, y + rows) and the first `channels` channels as WrImage has them, interleaved. */
bool wr_decoder_read(WrDecoder *decoder, int part, int y, int rows, int channels, float *out,
                     bool *memory, WrError *err);

/* Digest of a part: hash of its values in strips of WR_IMAGE_STRIP rows, each chained to the strip
 * above. */
static inline void wr_digest_strip(WrHash *digest, const float *values, size_t count)
{
    *digest = wr_hash_bytes(values, count * sizeof *values, *digest);
}
/* Chains rows [y, y + rows) into *digest, y a multiple of WR_IMAGE_STRIP. Uses memory for one strip. */
bool wr_decoder_hash_rows(WrDecoder *decoder, int part, int y, int rows, int channels,
                          WrHash *digest, bool *memory, WrError *err);
