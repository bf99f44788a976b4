#include "ui/canvas/thumb.h"

#include "field/field.h"

#include <math.h>

#define NOTHING 0x48 /* grey of uncovered areas */

static float texel(const WrField *field, double u, double v)
{
    int w = wr_field_width(field), h = wr_field_height(field);
    int i = (int)(u * w), j = (int)(v * h);
    return wr_field_get(field, i < w ? i : w - 1, j < h ? j : h - 1);
}

/* Mean of four texels for pixel (x, y). */
static float pixel(const WrField *field, int x, int y, int side)
{
    double sum = 0.0;
    for (int k = 0; k < 4; k++)
        sum += (double)texel(field, (x + 0.25 + 0.5 * (k & 1)) / side,
                             (y + 0.25 + 0.5 * (k >> 1)) / side);
    return (float)(sum / 4.0);
}

void wr_thumb_draw(const WrField *field, const WrField *cover, bool unit, int side, uint32_t *argb)
{
    float heights[WR_THUMB_MAX * WR_THUMB_MAX], low = INFINITY, high = -INFINITY;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            float f = pixel(field, x, y, side);
            heights[y * side + x] = f;
            low = f < low ? f : low;
            high = f > high ? f : high;
        }
    if (unit || !(high > low)) {
        low = 0.0f;
        high = 1.0f;
    } else if (cover) {
        high = -low > high ? -low : high;
        low = -high;
    }
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double grey = ((double)heights[y * side + x] - (double)low) /
                          ((double)high - (double)low) * 255.0;
            grey = grey > 0.0 ? grey < 255.0 ? grey : 255.0 : 0.0;
            double c = cover ? (double)pixel(cover, x, y, side) : 1.0;
            c = c > 0.0 ? c < 1.0 ? c : 1.0 : 0.0;
            uint32_t g = (uint32_t)lrint(NOTHING + c * (grey - NOTHING));
            argb[y * side + x] = 0xff000000u | g << 16 | g << 8 | g;
        }
}
