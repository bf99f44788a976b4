#include "ui/patch/preview/overexposure.h"

#include <stddef.h>
#include <string.h>

#define STRIPE 4 /* pixels */

static void stripe(uint8_t *pixel, bool dark)
{
    pixel[0] = dark ? 0 : 230;
    pixel[1] = 0;
    pixel[2] = dark ? 0 : 200;
}

/* Number of pixels in a row with a value of 255. */
static int count_row(const uint8_t *bgra, int width)
{
    int count = 0;
#pragma omp simd reduction(+ : count)
    for (int x = 0; x < width; x++) {
        uint32_t pixel;
        memcpy(&pixel, bgra + 4 * (size_t)x, 4);
        /* A byte of 0 wherever one of 255 was; the fourth is ignored. */
        const uint32_t none = ~pixel;
        count += (none & 0xffu) == 0 || (none & 0xff00u) == 0 || (none & 0xff0000u) == 0;
    }
    return count;
}

double wr_overexposed(uint8_t *bgra, int width, int height, bool mark)
{
    int64_t clipped = 0;
    for (int y = 0; y < height; y++) {
        uint8_t *row = bgra + 4 * (size_t)y * (size_t)width;
        const int count = count_row(row, width);
        clipped += count;
        for (int x = 0; mark && count > 0 && x < width; x++) {
            uint8_t *p = row + 4 * (size_t)x;
            if (p[0] == 255 || p[1] == 255 || p[2] == 255) stripe(p, (x + y) / STRIPE & 1);
        }
    }
    return (double)clipped / ((double)width * height);
}
