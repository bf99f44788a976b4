#include "ui/preview/checkerboard.h"

#include "image/image.h"
#include "render/frame/frame.h"

#include <math.h>
#include <string.h>

#define SQUARE 8.0 /* pixels of the window */

static const float greys[2] = { 0.32f, 0.13f }; /* linear; 8-bit values 155 and 101 */

/* Composite a tone-mapped premultiplied colour over a display grey. */
static void put(const float *from, float grey, const WrTone *tone, uint8_t *to)
{
    for (int c = 0; c < 3; c++) {
        const float own = from[3] > 0.0f ? from[3] * wr_tone_at(tone, from[c] / from[3]) : 0.0f;
        const float sum = own + (1.0f - from[3]) * grey;
        const float code = wr_srgb_encode(fminf(fmaxf(sum, 0.0f), 1.0f));
        to[2 - c] = (uint8_t)(code * 255.0f + 0.5f);
    }
    to[3] = 255;
}

void wr_chequer_behind(const WrFrame *frame, const WrTone *tone, double scale, uint8_t *bgra)
{
    static const float nothing[4] = { 0, 0, 0, 0 };
    const double side = fmax(1.0, SQUARE * scale);
    uint8_t bare[2][4]; /* uncovered pixels, which are the majority */
    for (int k = 0; k < 2; k++) put(nothing, greys[k], tone, bare[k]);
    for (int y = 0; y < frame->height; y++) {
        const int row = (int)(y / side);
        for (int x = 0; x < frame->width; x++) {
            const size_t at = 4 * ((size_t)y * (size_t)frame->width + (size_t)x);
            const float *from = frame->rgba + at;
            if (!(from[3] < 1.0f)) continue;
            const int which = (row + (int)(x / side)) & 1;
            if (from[3] > 0.0f) put(from, greys[which], tone, bgra + at);
            else memcpy(bgra + at, bare[which], 4);
        }
    }
}
