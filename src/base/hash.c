#include "base/hash.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "system/fd.h"
#include "system/thread.h"

#include <errno.h>
#include <sha256.h>
#include <string.h>
#include <xxhash.h>

/* XXH3, 128 bits: not cryptographic; it detects changes and damage. The library's seed has 64 bits, so a chain of hashes
   passes on 64 bits of each. SHA-256 identifies files from outside, where somebody may construct equal hashes. */
WrHash wr_hash_bytes(const void *bytes, size_t count, WrHash seed)
{
    XXH128_hash_t h = XXH3_128bits_withSeed(bytes, count, seed.low ^ (seed.high << 1));
    return (WrHash){ h.low64, h.high64 };
}

struct WrHashStream {
    XXH3_state_t *state; /* the library aligns it */
};

WrHashStream *wr_hash_stream_new(void)
{
    WrHashStream *stream = wr_alloc(1, sizeof *stream);
    stream->state = XXH3_createState();
    WR_ASSERT(stream->state);
    wr_hash_stream_begin(stream);
    return stream;
}

void wr_hash_stream_begin(WrHashStream *stream)
{
    XXH3_128bits_reset(stream->state);
}

void wr_hash_stream_add(WrHashStream *stream, const void *bytes, size_t count)
{
    XXH3_128bits_update(stream->state, bytes, count);
}

WrHash wr_hash_stream_get(const WrHashStream *stream)
{
    XXH128_hash_t h = XXH3_128bits_digest(stream->state);
    return (WrHash){ h.low64, h.high64 };
}

void wr_hash_stream_free(WrHashStream *stream)
{
    if (stream) XXH3_freeState(stream->state);
    wr_free(stream);
}

bool wr_hash_equal(WrHash a, WrHash b)
{
    return a.low == b.low && a.high == b.high;
}

void wr_hash_print(WrHash hash, char text[33])
{
    snprintf(text, 33, "%016llx%016llx", (unsigned long long)hash.high,
             (unsigned long long)hash.low);
}

static bool parse_hex(const char *text, int digits, uint64_t *value)
{
    uint64_t v = 0;
    for (int i = 0; i < digits; i++) {
        char c = text[i];
        if (c >= '0' && c <= '9') v = v << 4 | (uint64_t)(c - '0');
        else if (c >= 'a' && c <= 'f') v = v << 4 | (uint64_t)(c - 'a' + 10);
        else return false;
    }
    *value = v;
    return true;
}

bool wr_hash_parse(const char *text, WrHash *hash)
{
    WrHash h;
    if (memchr(text, '\0', WR_HASH_DIGITS + 1) != text + WR_HASH_DIGITS) return false;
    if (!parse_hex(text, 16, &h.high) || !parse_hex(text + 16, 16, &h.low)) return false;
    *hash = h;
    return true;
}

static void hex_of(const uint8_t digest[SHA256_DIGEST_LENGTH], char hex[65])
{
    for (int i = 0; i < SHA256_DIGEST_LENGTH; i++) snprintf(hex + 2 * i, 3, "%02x", digest[i]);
}

void wr_sha256_bytes(const void *bytes, size_t count, char hex[65])
{
    uint8_t digest[SHA256_DIGEST_LENGTH];
    SHA2_CTX ctx;
    SHA256Init(&ctx);
    SHA256Update(&ctx, bytes, count);
    SHA256Final(digest, &ctx);
    hex_of(digest, hex);
}

bool wr_sha256_file(const char *path, char hex[65], WrError *err)
{
    uint64_t left;
    int fd = wr_file_open(path, WR_FILE_MAX, &left, err);
    if (fd < 0) return false;
    uint8_t block[65536], digest[SHA256_DIGEST_LENGTH];
    SHA2_CTX ctx;
    SHA256Init(&ctx);
    int64_t n = 1;
    while (left > 0 && n != 0 && !wr_progress_stopped()) {
        n = wr_fd_read(fd, block, left < sizeof block ? (size_t)left : sizeof block);
        if (n < 0) break;
        SHA256Update(&ctx, block, (size_t)n);
        left -= (uint64_t)n;
    }
    wr_fd_close(fd);
    if (n < 0) return wr_fail(err, "%s: cannot be read (%s)", path, strerror(errno));
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    SHA256Final(digest, &ctx);
    hex_of(digest, hex);
    return true;
}

/* ---- on a helper thread ---- */

struct WrSha256Work {
    char *path;
    const WrProgress *progress;
    WrThread thread;
    bool threaded, good;
    char hex[65];
    WrError err;
};

static void *hash_beside(void *arg)
{
    WrSha256Work *work = arg;
    const WrProgress *before = wr_progress_set(work->progress);
    work->good = wr_sha256_file(work->path, work->hex, &work->err);
    wr_progress_set(before);
    return NULL;
}

WrSha256Work *wr_sha256_begin(const char *path)
{
    WrSha256Work *work = wr_alloc(1, sizeof *work);
    work->path = wr_strdup(path);
    work->progress = wr_progress_here();
    work->threaded = wr_thread_begin(&work->thread, hash_beside, work);
    if (!work->threaded) hash_beside(work);
    return work;
}

bool wr_sha256_end(WrSha256Work *work, char hex[65], WrError *err)
{
    if (work->threaded) wr_thread_join(work->thread);
    const bool good = work->good;
    if (good) memcpy(hex, work->hex, sizeof work->hex);
    else wr_fail(err, "%s", wr_error_message(&work->err));
    wr_free(work->path);
    wr_free(work);
    return good;
}
