#include "ui/preview/clipped.h"

#include <stddef.h>

#define STRIPE 4 /* pixels */

static void stripe(uint8_t *pixel, bool dark)
{
    pixel[0] = dark ? 0 : 230;
    pixel[1] = 0;
    pixel[2] = dark ? 0 : 200;
}

double wr_clipped(uint8_t *bgra, int width, int height, bool mark)
{
    int64_t clipped = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint8_t *p = bgra + 4 * ((size_t)y * (size_t)width + (size_t)x);
            if (p[0] != 255 && p[1] != 255 && p[2] != 255) continue;
            if (mark) stripe(p, (x + y) / STRIPE & 1);
            clipped++;
        }
    return (double)clipped / ((double)width * height);
}
