#include "generate/terrain.h"

#include "base/error.h"
#include "base/progress.h"
#include "field/field.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define LOOK 16384 /* numbers between cancellation checks */

size_t wr_raw_bytes(WrRawKind kind)
{
    return kind == WR_RAW_F32 ? 4 : 2;
}

/* An integer of 1 to 5 digits at *text, which is advanced; 0 if there is none. */
static int read_side(const char **text)
{
    int value = 0, digits = 0;
    for (; **text >= '0' && **text <= '9' && digits < 5; digits++, (*text)++)
        value = value * 10 + (**text - '0');
    return value;
}

static bool parse_size(const char *size, WrRaw *raw)
{
    const char *at = size;
    int width = read_side(&at);
    if (*at++ != 'x') return false;
    int height = read_side(&at);
    if (*at || width < 1 || height < 1 || width > WR_FIELD_MAX || height > WR_FIELD_MAX)
        return false;
    raw->width = width;
    raw->height = height;
    return true;
}

/* Raw files have no header. Without size= they must be square; SRTM tiles (1201 or 3601 a side) and most terrain tools' files
   are. */
bool wr_raw_size(const char *size, size_t length, WrRaw *raw, WrError *err)
{
    size_t each = wr_raw_bytes(raw->kind), count = length / each;
    int side = (int)floor(sqrt((double)count) + 0.5);
    bool square = side >= 1 && side <= WR_FIELD_MAX && (size_t)side * (size_t)side * each == length;
    if (!*size) {
        if (!square)
            return wr_fail(err,
                           "%zu bytes are not a square of numbers of %zu bytes, up to %d a side: "
                           "give columns and rows, as in size=1024x512",
                           length, each, WR_FIELD_MAX);
        raw->width = raw->height = side;
        return true;
    }
    WrRaw found = *raw;
    if (!parse_size(size, &found))
        return wr_fail(err, "size=%s: must be columns x rows, 1..%d each, as in 1024x512", size,
                       WR_FIELD_MAX);
    size_t want = (size_t)found.width * (size_t)found.height * each;
    if (want != length) {
        char hint[60] = "";
        if (square) snprintf(hint, sizeof hint, "; they would be %dx%d", side, side);
        return wr_fail(err, "size=%s of numbers of %zu bytes needs %zu bytes, the file has %zu%s",
                       size, each, want, length, hint);
    }
    *raw = found;
    return true;
}

static uint32_t number_at(const unsigned char *bytes, size_t each, bool big)
{
    uint32_t value = 0;
    for (size_t k = 0; k < each; k++) value = value << 8 | bytes[big ? k : each - 1 - k];
    return value;
}

/* Rows from the top, no padding: 16-bit integers, unsigned or two's complement, or IEEE floats, in either byte order. */
void wr_raw_decode(const WrRaw *raw, const void *bytes, double *z)
{
    size_t each = wr_raw_bytes(raw->kind), count = (size_t)raw->width * (size_t)raw->height;
    for (size_t k = 0; k < count && (k % LOOK != 0 || !wr_progress_stopped()); k++) {
        uint32_t code = number_at((const unsigned char *)bytes + k * each, each, raw->big);
        float real;
        memcpy(&real, &code, sizeof real);
        if (raw->kind == WR_RAW_U16) z[k] = (double)code;
        else if (raw->kind == WR_RAW_I16)
            z[k] = code < 32768 ? (double)code : (double)code - 65536.0;
        else z[k] = (double)real;
    }
}
