/* Source: OpenEXR File Layout, "Multi-Part and Deep Data", and for tiles "Regular tile image file". All
   numbers are little-endian. */
#include "image/exr_written_check.h"

#include "base/error.h"
#include "image/image.h"
#include "system/fd.h"

#include <string.h>

#define MULTIPART 0x10 /* in the file's sixth byte */
#define TILED 0x02     /* of one part */
#define TILE_NUMBERS 4 /* before a tile's length: its position and its level */
#define NAME_MAX_BYTES 255

/* An EXR file: magic 20000630 (76 2f 31 01), version and flags; headers (attributes: name, type, int32 size, value; a NUL
   ends a header, another the list of a multi-part file); a table of 8-byte offsets, one per chunk; the chunks. This program
   writes chunks in file order without gaps, so each chunk must begin where the previous one ends, and the last end must be
   the file's: OpenEXR itself accepts truncated files and missing chunks in some cases. */
typedef struct Walk {
    int fd;
    int64_t at, size;
    char text[NAME_MAX_BYTES + 1];
} Walk;

static bool take(Walk *walk, void *bytes, size_t length)
{
    if (wr_fd_read_at(walk->fd, bytes, length, walk->at) != (int64_t)length) return false;
    walk->at += (int64_t)length;
    return true;
}

static bool take_number(Walk *walk, int bytes, uint64_t *value)
{
    unsigned char raw[8];
    if (!take(walk, raw, (size_t)bytes)) return false;
    *value = 0;
    for (int i = 0; i < bytes; i++) *value |= (uint64_t)raw[i] << 8 * i;
    return true;
}

/* Reads a NUL-terminated text into walk->text. */
static bool take_name(Walk *walk)
{
    int64_t n = wr_fd_read_at(walk->fd, walk->text, sizeof walk->text, walk->at);
    const char *end = n > 0 ? memchr(walk->text, '\0', (size_t)n) : NULL;
    if (!end) return false;
    walk->at += end - walk->text + 1;
    return true;
}

/* Reads the attributes of one part; 0 chunks: there is no further part. */
static bool take_header(Walk *walk, uint64_t *chunks)
{
    *chunks = 0;
    for (bool first = true;; first = false) {
        uint64_t length;
        if (!take_name(walk)) return false;
        if (!walk->text[0]) return first || *chunks > 0;
        bool count = strcmp(walk->text, "chunkCount") == 0;
        if (!take_name(walk) || !take_number(walk, 4, &length)) return false;
        if (length > (uint64_t)(walk->size - walk->at)) return false;
        int64_t next = walk->at + (int64_t)length;
        if (count && (length != 4 || !take_number(walk, 4, chunks))) return false;
        walk->at = next;
    }
}

/* Checks one entry of the table at *table; *end is the required start of its chunk, and is advanced to
 * the chunk's end. */
static bool follow_chunk(Walk *walk, int64_t *table, uint64_t part, int64_t *end)
{
    uint64_t place, number, y, length;
    walk->at = *table;
    if (!take_number(walk, 8, &place) || place != (uint64_t)*end) return false;
    *table = walk->at;
    walk->at = *end;
    if (!take_number(walk, 4, &number) || number != part || !take_number(walk, 4, &y) ||
        !take_number(walk, 4, &length) || length > (uint64_t)(walk->size - walk->at))
        return false;
    *end = walk->at + (int64_t)length;
    return true;
}

static bool check(Walk *walk)
{
    uint64_t counts[WR_IMAGE_PARTS_MAX], all = 0;
    int parts = 0;
    for (;; parts++) {
        uint64_t chunks;
        if (!take_header(walk, &chunks)) return false;
        if (chunks == 0) break;
        if (parts == WR_IMAGE_PARTS_MAX || chunks > WR_IMAGE_MAX) return false;
        counts[parts] = chunks;
        all += chunks;
    }
    int64_t table = walk->at, end = table + (int64_t)(8 * all);
    for (int part = 0; part < parts; part++)
        for (uint64_t i = 0; i < counts[part]; i++)
            if (!follow_chunk(walk, &table, (uint64_t)part, &end)) return false;
    return end == walk->size;
}

/* Skips the attributes of the only part. */
static bool skip_header(Walk *walk)
{
    for (;;) {
        uint64_t length;
        if (!take_name(walk)) return false;
        if (!walk->text[0]) return true;
        if (!take_name(walk) || !take_number(walk, 4, &length)) return false;
        if (length > (uint64_t)(walk->size - walk->at)) return false;
        walk->at += (int64_t)length;
    }
}

/* The table ends where the first tile begins. */
static bool check_tiles(Walk *walk)
{
    uint64_t first, place, skipped, length;
    if (!skip_header(walk)) return false;
    int64_t table = walk->at, end;
    if (!take_number(walk, 8, &first) || first > (uint64_t)walk->size) return false;
    for (end = (int64_t)first; table < (int64_t)first; table += 8) {
        walk->at = table;
        if (!take_number(walk, 8, &place) || place != (uint64_t)end) return false;
        walk->at = end;
        for (int i = 0; i < TILE_NUMBERS; i++)
            if (!take_number(walk, 4, &skipped)) return false;
        if (!take_number(walk, 4, &length) || length > (uint64_t)(walk->size - walk->at))
            return false;
        end = walk->at + (int64_t)length;
    }
    return table == (int64_t)first && end == walk->size;
}

bool wr_exr_check_chunks(int fd, WrError *err)
{
    WrFileInfo info;
    unsigned char start[8];
    if (!wr_fd_info(fd, &info) ||
        wr_fd_read_at(fd, start, sizeof start, 0) != (int64_t)sizeof start)
        return wr_fail(err, "it is truncated");
    if (!(start[5] & (MULTIPART | TILED))) return true;
    Walk walk = { .fd = fd, .at = sizeof start, .size = info.bytes };
    return (start[5] & MULTIPART ? check(&walk) : check_tiles(&walk)) ||
           wr_fail(err, "its tables are incomplete");
}
