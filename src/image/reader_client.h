/* reader_client.h - a picture or font file read by the reader process (reader_protocol.h), so that a hostile file can harm that
   process alone. The same functions as decode.h has.
   Private to this module.

   Every number and text that comes back is checked here as if a stranger had sent it. A reading that
   gives no sign of life for a minute (and a second more for each MB of the file) is ended; so is one that
   takes over 4 GB of memory, less where the picture is small. The environment can set both:
   WRINKLE_READER_SECONDS, WRINKLE_READER_MB. */
#pragma once
#include "image/image.h"
#include "image/reader_protocol.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrReader WrReader;

/* Is reading done in this process (WRINKLE_READER=inside)? */
bool wr_reader_inside(void);
/* A file of at most `limit` bytes that may be worth reading, open: -1 and an error if it cannot be opened or is empty. */
int wr_reader_file(const char *path, uint64_t limit, WrError *err);

/* Open a picture.
 *
 * name     for messages, and for what the file is believed to be where its first bytes tell nothing
 * fd       a regular file or a memory file, open for reading; borrowed for the call
 * most, numbers   as wr_decoder_open has them
 * Errors   one sentence that names the file
 * Threads  any number at once; each reader belongs to one at a time */
WrReader *wr_reader_open(const char *name, int fd, int most, bool numbers, WrError *err);
void wr_reader_close(WrReader *reader); /* NULL is fine */

int wr_reader_parts(const WrReader *reader);
WrImagePart wr_reader_part(const WrReader *reader, int part); /* valid until close */
/* A text attribute or NULL; valid until close. */
const char *wr_reader_attribute(WrReader *reader, int part, const char *name);
bool wr_reader_read(WrReader *reader, int part, int y, int rows, int channels, float *out,
                    WrError *err);

/* Chain rows of a part into *digest, as wr_image_digest does; no pixels travel. */
bool wr_reader_digest(WrReader *reader, int part, int y, int rows, int channels, WrHash *digest,
                      WrError *err);

/* Have a file of another kind read in one go.
 *
 * task     what kind; ask: [ask_length] bytes that its reader in the process understands
 * block    what it answers, [*length] and a NUL; the caller's (wr_free). A stranger may have sent it
 * Errors   one sentence that names the file
 * Threads  any number at once */
bool wr_reader_block(const char *name, int fd, WrWireTask task, const void *ask, size_t ask_length,
                     char **block, size_t *length, WrError *err);
