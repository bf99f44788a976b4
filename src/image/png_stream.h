/* png_stream.h - rows of a PNG file: filters and compression of several segments at once.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrPool WrPool;
typedef struct WrPngStream WrPngStream;

/* Receives the bytes of one IDAT chunk, in order. It may leave by longjmp. */
typedef void (*WrPngChunk)(void *ctx, const uint8_t *bytes, size_t count);

/* row: bytes of a row. pixel: bytes of a pixel, 1..8. words: rows are 16-bit numbers of this processor.
   The bytes of a file do not depend on the pool, which may be NULL. NULL if out of memory. */
WrPngStream *wr_png_stream_new(size_t row, int pixel, int height, bool words, WrPool *pool);
void wr_png_stream_free(WrPngStream *stream); /* NULL is allowed */

/* Adds rows; passes chunks on as soon as there are enough rows for all threads, and the rest after the last row. False if out
   of memory. If the caller's progress is cancelled, chunks may be missing. */
bool wr_png_stream_add(WrPngStream *stream, const uint8_t *rows, int count, WrPngChunk out,
                       void *ctx);
