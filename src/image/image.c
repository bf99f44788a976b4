#include "image/image.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

WrImage *wr_image_new(int width, int height, int channels, WrError *err)
{
    if (width < 1 || width > WR_IMAGE_MAX || height < 1 || height > WR_IMAGE_MAX) {
        wr_fail(err, "picture of %dx%d: each side must be 1..%d", width, height, WR_IMAGE_MAX);
        return NULL;
    }
    if (channels < 1 || channels > 4) {
        wr_fail(err, "picture of %d channels: must be 1..4", channels);
        return NULL;
    }
    size_t count = (size_t)width * (size_t)height * (size_t)channels;
    float *data = wr_try_alloc(count, sizeof *data, "a picture", err);
    if (!data) return NULL;
    WrImage *image = wr_alloc(1, sizeof *image);
    *image = (WrImage){ .refs = 1,
                        .width = width,
                        .height = height,
                        .channels = channels,
                        .type = WR_PIXEL_F32,
                        .data = data };
    return image;
}

WrImage *wr_image_share(const WrImage *image)
{
    WrImage *shared = (WrImage *)image; /* only the reference count changes, atomically */
    if (shared) __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_image_free(WrImage *image)
{
    if (!image || __atomic_sub_fetch(&image->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_free(image->data);
    wr_free(image);
}

/* IEC 61966-2-1. Uses wr_pow, not libm's, so that images are the same on every processor. */
float wr_srgb_encode(float linear)
{
    double x = linear;
    return (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * wr_pow(x, 1.0 / 2.4) - 0.055);
}

float wr_srgb_decode(float code)
{
    double x = code;
    return (float)(x <= 0.04045 ? x / 12.92 : wr_pow((x + 0.055) / 1.055, 2.4));
}

float wr_image_luma(const float *pixel, int channels)
{
    if (channels < 3) return pixel[0];
    return (float)(0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]);
}

static int64_t finite_floats(const float *in, size_t count, float *out)
{
    int64_t replaced = 0;
    for (size_t i = 0; i < count; i++) {
        bool good = isfinite(in[i]);
        out[i] = good ? in[i] : 0.0f;
        replaced += !good;
    }
    return replaced;
}

int64_t wr_image_codes(WrPixelType type, const float *in, size_t count, void *out, int64_t *clipped)
{
    int64_t replaced = 0, outside = 0;
    if (type == WR_PIXEL_F32) {
        replaced = finite_floats(in, count, out);
    } else {
        double last = wr_pixel_last(type);
        for (size_t i = 0; i < count; i++) {
            double x = in[i];
            replaced += !isfinite(x);
            if (!isfinite(x)) x = 0.0;
            outside += x < 0.0 || x > 1.0;
            x = x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
            unsigned code = (unsigned)floor(last * x + 0.5); /* 24 + 16 bits: the sum is exact */
            if (type == WR_PIXEL_U8) ((uint8_t *)out)[i] = (uint8_t)code;
            else ((uint16_t *)out)[i] = (uint16_t)code;
        }
    }
    if (clipped) *clipped = outside;
    return replaced;
}
