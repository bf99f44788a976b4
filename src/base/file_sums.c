/* Checksums of the bytes written to a file (file_internal.h).

   The file is a list of contiguous extents in the order of their offsets, each with a checksum. A write
   at the end extends the last extent, up to EXTENT bytes. A write over earlier bytes (an encoder's
   header, the lengths in an archive) replaces extents. If it covers an extent in part, the whole extent
   is read back and compared first, then its remaining part gets its own checksum. So every byte is
   compared at least once and none is kept in memory. */
#include "base/array.h"
#include "base/file_internal.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"

#include <errno.h>
#include <string.h>

#define EXTENT ((int64_t)1 << 18) /* bytes, at most */

typedef struct Extent {
    int64_t at, length;
    WrHash hash;
} Extent;

struct WrFileSums {
    WR_ARRAY(Extent) extents;
    WrHashStream *stream; /* of the last extent while it grows */
    bool grows;
    char *block; /* [EXTENT], for reading back */
};

WrFileSums *wr_file_sums_new(void)
{
    WrFileSums *sums = wr_alloc(1, sizeof *sums);
    sums->stream = wr_hash_stream_new();
    return sums;
}

void wr_file_sums_free(WrFileSums *sums)
{
    if (!sums) return;
    wr_hash_stream_free(sums->stream);
    wr_array_free(&sums->extents);
    wr_free(sums->block);
    wr_free(sums);
}

int64_t wr_file_sums_end(const WrFileSums *sums)
{
    if (sums->extents.count == 0) return 0;
    const Extent *last = &sums->extents.data[sums->extents.count - 1];
    return last->at + last->length;
}

static WrHash hash_of(const void *bytes, int64_t length)
{
    return wr_hash_bytes(bytes, (size_t)length, (WrHash){ .low = 0, .high = 0 });
}

static void stop_growing(WrFileSums *sums)
{
    if (sums->grows)
        sums->extents.data[sums->extents.count - 1].hash = wr_hash_stream_get(sums->stream);
    sums->grows = false;
}

/* ---- at the end ---- */

static void grow(WrFileSums *sums, const char *bytes, int64_t length)
{
    while (length > 0) {
        Extent *last = sums->grows ? &sums->extents.data[sums->extents.count - 1] : NULL;
        if (!last || last->length == EXTENT) {
            stop_growing(sums);
            const Extent next = { .at = wr_file_sums_end(sums) };
            wr_array_push(&sums->extents, next);
            wr_hash_stream_begin(sums->stream);
            sums->grows = true;
            continue;
        }
        const int64_t room = EXTENT - last->length, take = length < room ? length : room;
        wr_hash_stream_add(sums->stream, bytes, (size_t)take);
        last->length += take;
        bytes += take;
        length -= take;
    }
}

/* Gaps read as zeros. */
static void grow_by_zeros(WrFileSums *sums, int64_t length)
{
    static const char zeros[1 << 14];
    for (; length > 0; length -= (int64_t)sizeof zeros)
        grow(sums, zeros, length < (int64_t)sizeof zeros ? length : (int64_t)sizeof zeros);
}

/* ---- over earlier bytes ---- */

/* Reads an extent into `block` and compares its checksum. errno EIO: the file contains other bytes. */
static bool read_back(WrFileSums *sums, int fd, const Extent *e)
{
    if (!sums->block) sums->block = wr_alloc_unset((size_t)EXTENT, 1);
    for (int64_t have = 0; have < e->length;) {
        const int64_t n =
            wr_fd_read_at(fd, sums->block + have, (size_t)(e->length - have), e->at + have);
        if (n == 0) errno = EIO;
        if (n <= 0) return false;
        have += n;
    }
    errno = EIO;
    return wr_hash_equal(hash_of(sums->block, e->length), e->hash);
}

/* Index of the first extent that ends after `at`. */
static int find(const WrFileSums *sums, int64_t at)
{
    int low = 0, high = sums->extents.count;
    while (low < high) {
        const int middle = (low + high) / 2;
        const Extent *e = &sums->extents.data[middle];
        if (e->at + e->length > at) high = middle;
        else low = middle + 1;
    }
    return low;
}

/* Replaces the extents [first, first + count) by others. */
static void replace(WrFileSums *sums, int first, int count, const Extent *others, int other_count)
{
    const int behind = sums->extents.count - first - count;
    for (int i = count; i < other_count; i++) wr_array_push(&sums->extents, others[i]);
    Extent *at = sums->extents.data + first;
    memmove(at + other_count, at + count, (size_t)behind * sizeof *at);
    memcpy(at, others, (size_t)other_count * sizeof *at);
    sums->extents.count = first + other_count + behind;
}

/* Overwrites at most EXTENT bytes, [at, at + length), all before the end. */
static bool write_over(WrFileSums *sums, int fd, const char *bytes, int64_t length, int64_t at)
{
    const int64_t end = at + length;
    const int first = find(sums, at);
    int last = first, count = 0;
    Extent others[3];
    while (sums->extents.data[last].at + sums->extents.data[last].length < end) last++;
    const Extent *a = &sums->extents.data[first], *b = &sums->extents.data[last];
    const int64_t before = at - a->at, after = b->at + b->length - end;
    if (before > 0 && !read_back(sums, fd, a)) return false;
    if (before > 0) others[count++] = (Extent){ a->at, before, hash_of(sums->block, before) };
    others[count++] = (Extent){ at, length, hash_of(bytes, length) };
    if (after > 0 && !(a == b && before > 0) && !read_back(sums, fd, b)) return false;
    if (after > 0)
        others[count++] = (Extent){ end, after, hash_of(sums->block + b->length - after, after) };
    replace(sums, first, last - first + 1, others, count);
    return true;
}

bool wr_file_sums_note(WrFileSums *sums, int fd, const void *bytes, size_t length, int64_t at)
{
    const char *from = bytes;
    const int64_t old_end = wr_file_sums_end(sums), end = at + (int64_t)length;
    if (length == 0) return true;
    if (at < old_end) stop_growing(sums);
    for (const int64_t stop = end < old_end ? end : old_end; at < stop;) {
        const int64_t piece = stop - at < EXTENT ? stop - at : EXTENT;
        if (!write_over(sums, fd, from, piece, at)) return false;
        from += piece;
        at += piece;
    }
    if (at > old_end) grow_by_zeros(sums, at - old_end);
    grow(sums, from, end - at);
    return true;
}

bool wr_file_sums_check(WrFileSums *sums, int fd)
{
    WrFileInfo info;
    if (!wr_fd_info(fd, &info)) return false;
    errno = EIO;
    if (info.bytes != wr_file_sums_end(sums)) return false;
    stop_growing(sums);
    for (int i = 0; i < sums->extents.count; i++) {
        if (wr_progress_stopped() || !read_back(sums, fd, &sums->extents.data[i])) return false;
    }
    return true;
}
