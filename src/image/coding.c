#include "image/coding.h"

#include "base/error.h"
#include "base/progress.h"
#include "image/image.h"

#include <math.h>
#include <stddef.h>

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
