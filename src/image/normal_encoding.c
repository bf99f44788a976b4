#include "image/normal_encoding.h"

#include "base/error.h"
#include "base/progress.h"
#include "image/image.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define ROUNDING 0.02 /* values below minus this are not rounding errors of a unit coding */
#define STRETCH 16384 /* texels between cancellation checks */

const char *const wr_codings[] = { WR_CODINGS(WR_WORD) NULL };

/* Distance from 1 of a vector's length, given its square. */
static double misfit(double square, int channels)
{
    const double off = channels == 2 ? square - 1 : fabs(square - 1);
    return fmax(0, fmin(1, off));
}

static void add_texel(const float *texel, int channels, double *as_signed, double *as_unit)
{
    double own = 0, twice = 0;
    bool below = false;
    for (int c = 0; c < channels; c++) {
        const double x = (double)texel[c];
        own += x * x, twice += (2 * x - 1) * (2 * x - 1);
        below = below || x < -ROUNDING;
    }
    *as_signed += misfit(own, channels);
    *as_unit += below ? 1 : misfit(twice, channels);
}

bool wr_coding_find(const WrImage *image, int channels, WrCoding wanted, WrCoding *found,
                    WrError *err)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    double as_signed = 0, as_unit = 0;
    *found = WR_CODING_UNIT;
    if (image->type != WR_PIXEL_F32)
        return wanted != WR_CODING_SIGNED ||
               wr_fail(err,
                       "coding=signed needs a file of floats; this one holds codes of %d bits, "
                       "which are unit",
                       image->type == WR_PIXEL_U8 ? 8 : 16);
    if (wanted != WR_CODING_AUTO) {
        *found = wanted;
        return true;
    }
    for (size_t i = 0; i < count; i++) {
        if (i % STRETCH == 0 && wr_progress_stopped()) return wr_fail(err, "cancelled");
        add_texel(image->data + i * (size_t)image->channels, channels, &as_signed, &as_unit);
    }
    if (as_signed < as_unit) *found = WR_CODING_SIGNED;
    return true;
}

/* ---- ICC profiles ---- */

#define HEADER 128
#define TAGS 10

typedef struct Writer {
    uint8_t *bytes;
    size_t at;
} Writer;

static void put32(Writer *w, uint32_t x)
{
    for (int k = 3; k >= 0; k--) w->bytes[w->at++] = (uint8_t)(x >> (8 * k));
}

static void put_name(Writer *w, const char name[4])
{
    memcpy(w->bytes + w->at, name, 4);
    w->at += 4;
}

/* s15Fixed16Number */
static void put_fixed(Writer *w, double x)
{
    put32(w, (uint32_t)(int32_t)lround(65536 * x));
}

static void put_fixeds(Writer *w, const char type[4], const double *x, int count)
{
    put_name(w, type);
    put32(w, 0);
    for (int i = 0; i < count; i++) put_fixed(w, x[i]);
}

/* multiLocalizedUnicodeType of one English text, to a multiple of four bytes. */
static void put_text(Writer *w, const char *text)
{
    size_t length = strlen(text), end = (w->at + 28 + 2 * length + 3) & ~(size_t)3;
    put_name(w, "mluc");
    put32(w, 0);
    put32(w, 1);
    put32(w, 12);
    put_name(w, "enUS");
    put32(w, (uint32_t)(2 * length));
    put32(w, 28);
    for (; *text; text++) {
        w->bytes[w->at++] = 0;
        w->bytes[w->at++] = (uint8_t)*text;
    }
    w->at = end;
}

static const double d50[3] = { 0.9642, 1.0, 0.8249 };

static void put_header(Writer *w)
{
    put32(w, WR_SRGB_PROFILE_SIZE);
    put32(w, 0);
    put32(w, 0x04200000);
    put_name(w, "mntr");
    put_name(w, "RGB ");
    put_name(w, "XYZ ");
    memcpy(w->bytes + 24, (const uint8_t[]){ 0x07, 0xd4, 0, 1, 0, 1 }, 6);
    memcpy(w->bytes + 36, "acsp", 4);
    w->at = 68;
    for (int i = 0; i < 3; i++) put_fixed(w, d50[i]);
    w->at = HEADER;
}

/* Writes the content of a tag; tags with equal content share it. */
static void put_tag(Writer *w, int index)
{
    static const double primaries[3][3] = { { 0.43607, 0.22249, 0.01392 },
                                            { 0.38515, 0.71687, 0.09708 },
                                            { 0.14307, 0.06061, 0.71410 } };
    static const double adaptation[9] = { 1.04788,  0.02292,  -0.05022, 0.02959, 0.99048,
                                          -0.01707, -0.00925, 0.01508,  0.75168 };
    static const double curve[5] = { 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045 };
    switch (index) {
    case 0: put_text(w, "sRGB"); break;
    case 1: put_text(w, "No copyright"); break;
    case 2: put_fixeds(w, "XYZ ", d50, 3); break;
    case 3: put_fixeds(w, "sf32", adaptation, 9); break;
    case 4:
    case 5:
    case 6: put_fixeds(w, "XYZ ", primaries[index - 4], 3); break;
    default:
        put_name(w, "para");
        put32(w, 0);
        put32(w, 3u << 16); /* Y = (a X + b)^g where X >= d, else c X */
        for (int i = 0; i < 5; i++) put_fixed(w, curve[i]);
    }
}

void wr_srgb_profile(uint8_t out[WR_SRGB_PROFILE_SIZE])
{
    static const char names[TAGS][5] = { "desc", "cprt", "wtpt", "chad", "rXYZ",
                                         "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC" };
    memset(out, 0, WR_SRGB_PROFILE_SIZE);
    Writer table = { out, 0 }, data = { out, HEADER + 4 + 12 * TAGS };
    put_header(&table);
    put32(&table, TAGS);
    size_t from = 0, size = 0;
    for (int i = 0; i < TAGS; i++) {
        if (i <= 7) { /* the three curves are shared */
            from = data.at;
            put_tag(&data, i);
            size = data.at - from;
        }
        put_name(&table, names[i]);
        put32(&table, (uint32_t)from);
        put32(&table, (uint32_t)size);
    }
    WR_ASSERT(data.at == WR_SRGB_PROFILE_SIZE);
}
