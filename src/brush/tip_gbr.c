/* GIMP's .gbr: one picture. Big-endian numbers of 32 bits: length of the header, version, width,
   height, bytes per pixel (1: grey, 255 is full paint; 4: RGBA), in version 2 also "GIMP" and the
   spacing in per cent of the width; then the name and a NUL to the header's end, then the pixels, the
   top row first. */
#include "brush/tip_internal.h"

#include "base/error.h"
#include "base/memory.h"

#include <string.h>

#define WR_GBR_V1 20u      /* bytes before the name */
#define WR_GBR_V2 28u      /* bytes before the name in version 2 */
#define WR_GBR_NAME 65536u /* maximum bytes of a name */

static uint32_t big32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

bool wr_tip_is_gbr(const uint8_t *bytes, size_t size)
{
    if (size < WR_GBR_V1) return false;
    uint32_t version = big32(bytes + 4);
    if (size >= WR_GBR_V2 && memcmp(bytes + 20, "GIMP", 4) == 0) return true;
    return version == 1 && big32(bytes) >= WR_GBR_V1 && big32(bytes) < WR_GBR_V1 + WR_GBR_NAME;
}

/* The length of a valid UTF-8 sequence at p, 0 if none. */
static size_t utf8_length(const uint8_t *p, size_t size)
{
    static const uint32_t smallest[5] = { 0, 0, 0x80, 0x800, 0x10000 };
    size_t n = p[0] < 0x80 ? 1 : p[0] < 0xc0 ? 0 : p[0] < 0xe0 ? 2 : p[0] < 0xf0 ? 3 : 4;
    if (n == 0 || n > size || p[0] >= 0xf8) return 0;
    if (n == 1) return 1;
    uint32_t code = p[0] & (0x7fu >> n);
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (p[i] & 0x3fu);
    }
    bool good = code >= smallest[n] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
    return good ? n : 0;
}

char *wr_tip_clean_name(const uint8_t *bytes, size_t size)
{
    char *name = wr_alloc(size + 1, 1);
    size_t length = 0;
    for (size_t i = 0; i < size && bytes[i];) {
        size_t n = utf8_length(bytes + i, size - i);
        bool shown = n > 1 || (n == 1 && bytes[i] >= 0x20 && bytes[i] != 0x7f);
        if (!shown) n = 1;
        for (size_t k = 0; k < n; k++) name[length++] = shown ? (char)bytes[i + k] : '?';
        i += n;
    }
    return name;
}

typedef struct Header {
    uint32_t length, version, width, height, bytes;
    uint32_t fixed; /* bytes before the name */
    double spacing;
} Header;

static bool read_header(const uint8_t *bytes, size_t size, Header *header, const char *what,
                        WrError *err)
{
    if (size < WR_GBR_V1)
        return wr_fail(err, "%s: a .gbr brush of %zu bytes: its header alone has 20", what, size);
    Header h = { big32(bytes),
                 big32(bytes + 4),
                 big32(bytes + 8),
                 big32(bytes + 12),
                 big32(bytes + 16),
                 WR_GBR_V1,
                 0.5 };
    if (h.version != 1 && h.version != 2)
        return wr_fail(err, "%s: a .gbr brush of version %u: must be 1 or 2", what, h.version);
    if (h.version == 2) {
        h.fixed = WR_GBR_V2;
        if (size < WR_GBR_V2 || memcmp(bytes + 20, "GIMP", 4) != 0)
            return wr_fail(err, "%s: not a .gbr brush: \"GIMP\" is missing at byte 20", what);
        uint32_t percent = big32(bytes + 24);
        h.spacing = (percent > 500 ? 500 : percent) * 0.02; /* of the width -> of the radius */
    }
    if (h.length < h.fixed || h.length - h.fixed > WR_GBR_NAME || h.length > size)
        return wr_fail(err, "%s: a .gbr header of %u bytes: must be %u..%zu", what, h.length,
                       h.fixed, size);
    if (h.bytes != 1 && h.bytes != 4)
        return wr_fail(err, "%s: a .gbr brush of %u bytes a pixel: must be 1 or 4", what, h.bytes);
    if (h.width < 1 || h.width > WR_TIP_SIDE || h.height < 1 || h.height > WR_TIP_SIDE)
        return wr_fail(err, "%s: a .gbr brush of %ux%u pixels: each side must be 1..%d", what,
                       h.width, h.height, WR_TIP_SIDE);
    size_t need = (size_t)h.width * h.height * h.bytes;
    if (need > size - h.length)
        return wr_fail(err, "%s: cut short: %ux%u pixels need %zu bytes, %zu are there", what,
                       h.width, h.height, need, size - h.length);
    *header = h;
    return true;
}

/* In codes 0..255: grey unchanged, or Rec. 709 luma times alpha. */
static void read_pixels(const uint8_t *in, size_t count, uint32_t bytes, float *out)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = in + i * bytes;
        if (bytes == 1) out[i] = p[0];
        else out[i] = (float)((0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) * (p[3] / 255.0));
    }
}

bool wr_tip_parse_gbr(WrTip *tip, int cell, const uint8_t *bytes, size_t size, size_t *used,
                      char **name, double *spacing, const char *what, WrError *err)
{
    Header h = { 0 };
    if (!read_header(bytes, size, &h, what, err)) return false;
    if (!wr_tip_cell_alloc(tip, cell, (int)h.width, (int)h.height, what, err)) return false;
    size_t count = (size_t)h.width * h.height;
    read_pixels(bytes + h.length, count, h.bytes, tip->cell[cell].values);
    if (!wr_tip_cell_finish(tip, cell, 255, err)) return false;
    *used = h.length + count * h.bytes;
    if (name) *name = wr_tip_clean_name(bytes + h.fixed, h.length - h.fixed);
    if (spacing) *spacing = h.spacing;
    return true;
}
