#include "image/png.h"

#include "base/error.h"

#include <stdint.h>
#include <string.h>

typedef struct Crc {
    uint32_t table[256];
    uint32_t now;
} Crc;

static void crc_init(Crc *crc)
{
    for (uint32_t n = 0; n < 256; n++) {
        uint32_t c = n;
        for (int k = 0; k < 8; k++) c = c & 1 ? 0xedb88320U ^ c >> 1 : c >> 1;
        crc->table[n] = c;
    }
}

static void crc_add(Crc *crc, const unsigned char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        crc->now = crc->table[(crc->now ^ bytes[i]) & 255] ^ crc->now >> 8;
}

static uint32_t big_endian(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Checks one chunk: length, four letters, data, CRC of letters and data. */
static bool check_chunk(FILE *file, Crc *crc, char name[5], WrError *err)
{
    unsigned char head[8], tail[4], block[16384];
    if (fread(head, 1, sizeof head, file) != sizeof head)
        return wr_fail(err, "truncated: the PNG file ends without its last chunk");
    uint32_t length = big_endian(head);
    memcpy(name, head + 4, 4);
    name[4] = '\0';
    for (int i = 0; i < 4; i++)
        if (!((name[i] >= 'a' && name[i] <= 'z') || (name[i] >= 'A' && name[i] <= 'Z')))
            return wr_fail(err, "damaged: a PNG chunk has an impossible name");
    if (length > 0x7fffffffU)
        return wr_fail(err, "damaged: PNG chunk %s of %u bytes", name, length);
    crc->now = 0xffffffffU;
    crc_add(crc, head + 4, 4);
    while (length > 0) {
        size_t want = length < sizeof block ? length : sizeof block;
        if (fread(block, 1, want, file) != want)
            return wr_fail(err, "truncated: the file ends inside PNG chunk %s", name);
        crc_add(crc, block, want);
        length -= (uint32_t)want;
    }
    if (fread(tail, 1, sizeof tail, file) != sizeof tail)
        return wr_fail(err, "truncated: the file ends inside PNG chunk %s", name);
    if (big_endian(tail) != (crc->now ^ 0xffffffffU))
        return wr_fail(err, "damaged: the checksum of PNG chunk %s is wrong", name);
    return true;
}

bool wr_png_check(FILE *file, WrError *err)
{
    Crc crc;
    char name[5] = "";
    crc_init(&crc);
    if (fseek(file, 8, SEEK_SET) != 0) return wr_fail(err, "cannot be read");
    while (strcmp(name, "IEND") != 0)
        if (!check_chunk(file, &crc, name, err)) return false;
    return true;
}
