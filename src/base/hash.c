#include "base/hash.h"

#include "base/cpu.h"
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
#ifdef __x86_64__
#include <immintrin.h>
#endif

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

/* Whole blocks by the processor's own instructions, four times as fast as the library, with the reading. Saving and
   opening hash the whole file. */
#ifdef __x86_64__
/* FIPS 180-4, 4.2.2. */
static const uint32_t sha256_k[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2
};

/* The instructions keep the state as the words A B E F and C D G H, the highest first. w: 16 words of the schedule, four
   of which are replaced in each step. */
__attribute__((target("sha,sse4.1"))) static void sha256_blocks(uint32_t state[8],
                                                                const uint8_t *bytes, size_t count)
{
    const __m128i big = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
    __m128i abef = _mm_set_epi32((int)state[0], (int)state[1], (int)state[4], (int)state[5]);
    __m128i cdgh = _mm_set_epi32((int)state[2], (int)state[3], (int)state[6], (int)state[7]);
    for (; count > 0; count--, bytes += SHA256_BLOCK_LENGTH) {
        const __m128i abef_before = abef, cdgh_before = cdgh;
        __m128i w[4];
        for (int i = 0; i < 4; i++)
            w[i] = _mm_shuffle_epi8(_mm_loadu_si128((const __m128i *)(const void *)bytes + i), big);
#pragma GCC unroll 16
        for (int i = 0; i < 16; i++) {
            const __m128i k = _mm_loadu_si128((const __m128i *)(const void *)(sha256_k + 4 * i));
            const __m128i sum = _mm_add_epi32(w[i % 4], k), last = w[(i + 3) % 4];
            cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
            abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0e));
            const __m128i seven = _mm_alignr_epi8(last, w[(i + 2) % 4], 4);
            const __m128i first = _mm_sha256msg1_epu32(w[i % 4], w[(i + 1) % 4]);
            w[i % 4] = _mm_sha256msg2_epu32(_mm_add_epi32(first, seven), last);
        }
        abef = _mm_add_epi32(abef, abef_before);
        cdgh = _mm_add_epi32(cdgh, cdgh_before);
    }
    state[0] = (uint32_t)_mm_extract_epi32(abef, 3),
    state[1] = (uint32_t)_mm_extract_epi32(abef, 2);
    state[4] = (uint32_t)_mm_extract_epi32(abef, 1),
    state[5] = (uint32_t)_mm_extract_epi32(abef, 0);
    state[2] = (uint32_t)_mm_extract_epi32(cdgh, 3),
    state[3] = (uint32_t)_mm_extract_epi32(cdgh, 2);
    state[6] = (uint32_t)_mm_extract_epi32(cdgh, 1),
    state[7] = (uint32_t)_mm_extract_epi32(cdgh, 0);
}
#else
static void sha256_blocks(uint32_t state[8], const uint8_t *bytes, size_t count)
{
    (void)state, (void)bytes, (void)count;
}
#endif

/* Whole blocks before the last call only: the library counts their bits and pads the end. */
static void sha256_add(SHA2_CTX *ctx, const uint8_t *bytes, size_t count, bool fast)
{
    const size_t blocks = count / SHA256_BLOCK_LENGTH, whole = blocks * SHA256_BLOCK_LENGTH;
    if (ctx->bitcount[0] % (8 * SHA256_BLOCK_LENGTH) != 0 || !fast) {
        SHA256Update(ctx, bytes, count);
        return;
    }
    sha256_blocks(ctx->state.st32, bytes, blocks);
    ctx->bitcount[0] += (uint64_t)whole * 8;
    SHA256Update(ctx, bytes + whole, count - whole);
}

void wr_sha256_bytes(const void *bytes, size_t count, char hex[65])
{
    uint8_t digest[SHA256_DIGEST_LENGTH];
    SHA2_CTX ctx;
    SHA256Init(&ctx);
    sha256_add(&ctx, bytes, count, wr_cpu_has_sha());
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
    const bool fast = wr_cpu_has_sha(); /* once: slow in a virtual machine */
    int64_t n = 1;
    while (left > 0 && n != 0 && !wr_progress_stopped()) {
        n = wr_fd_read(fd, block, left < sizeof block ? (size_t)left : sizeof block);
        if (n < 0) break;
        sha256_add(&ctx, block, (size_t)n, fast);
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
