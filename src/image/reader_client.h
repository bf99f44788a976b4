/* reader_client.h - management of the reader process: started on first use, restarted after a crash,
   and kept for the next file.
   Private to this module. */
#pragma once
#include "image/image.h"
#include "image/reader_protocol.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- the process ---- */

/* Starts the process if there is none; returns at once, while it still loads. Any thread. */
bool wr_process_start(WrError *err);

/* ---- requests ---- */

/* Reading of image, mesh and font files by the reader process (reader_protocol.h).

   A hostile file can harm only that process. The functions are those of decode.h.
   Every reply is checked as untrusted data. A reading without a reply for a minute (and a second more
   for each MB of the file) is aborted; so is one that uses over 4 GB of memory, less for small images.
   The environment can set both limits: WRINKLE_READER_SECONDS, WRINKLE_READER_MB. */

typedef struct WrReader WrReader;

/* True if files are read in this process (WRINKLE_READER=inside). */
bool wr_reader_inside(void);
/* Opens a file of at most `limit` bytes: -1 and an error if it cannot be opened or is empty. */
int wr_reader_file(const char *path, uint64_t limit, WrError *err);

/* Opens an image.
 *
 * name     for messages, and for the assumed format if the first bytes are not characteristic
 * fd       a regular file or a memory file, open for reading; borrowed for the call
 * most, numbers   as for wr_decoder_open
 * Errors   one sentence that names the file
 * Threads  any number at once; each reader belongs to one at a time */
WrReader *wr_reader_open(const char *name, int fd, int most, bool numbers, WrError *err);
void wr_reader_close(WrReader *reader); /* NULL is allowed */

int wr_reader_parts(const WrReader *reader);
WrImagePart wr_reader_part(const WrReader *reader, int part); /* valid until close */
/* A text attribute or NULL; valid until close. */
const char *wr_reader_attribute(WrReader *reader, int part, const char *name);
bool wr_reader_read(WrReader *reader, int part, int y, int rows, int channels, float *out,
                    WrError *err);

/* Chains rows of a part into *digest, like wr_decoder_hash_rows; no pixels are transferred. */
bool wr_reader_digest(WrReader *reader, int part, int y, int rows, int channels, WrHash *digest,
                      WrError *err);

/* Reads a file of another kind at once.
 *
 * task     kind of the file; ask: [ask_length] bytes for its reader in the process
 * block    the reply, [*length] and a NUL; owned by the caller (wr_free). Untrusted
 * Errors   one sentence that names the file
 * Threads  any number at once */
bool wr_reader_block(const char *name, int fd, WrWireTask task, const void *ask, size_t ask_length,
                     char **block, size_t *length, WrError *err);
