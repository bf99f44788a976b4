/* hash.h - checksums: a fast 128-bit hash that identifies heights, SHA-256 for files read by commands,
   and integer mixing for random choices. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef struct WrHash {
    uint64_t low, high;
} WrHash;

/* XXH3, 128 bits: the same on every processor. seed chains one hash into the next. */
WrHash wr_hash_bytes(const void *bytes, size_t count, WrHash seed);
/* Incremental XXH3 with seed 0. begin restarts it; get does not change the state. */
typedef struct WrHashStream WrHashStream;
WrHashStream *wr_hash_stream_new(void);
void wr_hash_stream_begin(WrHashStream *stream);
void wr_hash_stream_add(WrHashStream *stream, const void *bytes, size_t count);
WrHash wr_hash_stream_get(const WrHashStream *stream);
void wr_hash_stream_free(WrHashStream *stream); /* NULL is fine */

bool wr_hash_equal(WrHash a, WrHash b);
/* 32 hex digits and a NUL. */
#define WR_HASH_DIGITS 32
void wr_hash_print(WrHash hash, char text[WR_HASH_DIGITS + 1]);
/* The hash that wr_hash_print printed. False for any other text; *hash is then unchanged. */
bool wr_hash_parse(const char *text, WrHash *hash);

/* SHA-256 as 64 lower-case hex digits and a NUL. */
void wr_sha256_bytes(const void *bytes, size_t count, char hex[65]);
bool wr_sha256_file(const char *path, char hex[65], WrError *err);

/* SHA-256 of a file on a helper thread, while the caller does other work. Every begin needs one end.
 * Stops when the work of the calling thread is cancelled. */
typedef struct WrSha256Work WrSha256Work;
WrSha256Work *wr_sha256_begin(const char *path);
bool wr_sha256_end(WrSha256Work *work, char hex[65], WrError *err); /* waits for the result and
                                                                       frees `work` */

/* A well-mixed 32-bit value of x (bijective). */
static inline uint32_t wr_mix32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ x >> 16;
}
