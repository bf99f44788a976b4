#include "scene/background.h"

#include "base/enum_rows.h"
#include "image/image.h"

#include <string.h>

WR_ROWS(wr_background_names);
const char *const wr_background_names[WR_BACKGROUND_KINDS] = {
    [WR_ROW(WR_BACKGROUND_PLAIN)] = "plain",
    [WR_ROW(WR_BACKGROUND_GRADIENT)] = "gradient",
    [WR_ROW(WR_BACKGROUND_NONE)] = "none",
    [WR_ROW(WR_BACKGROUND_SURROUNDINGS)] = "surroundings",
};
WR_ROWS_END(wr_background_names, WR_BACKGROUND_KINDS);

/* Interpolates two values evenly for the eye. Above 1, where codes are saturated, it is linear in
   light. */
static float between(double top, double bottom, double share)
{
    if (top == bottom) return (float)top;
    if (top > 1 || bottom > 1) return (float)(top + (bottom - top) * share);
    const double a = (double)wr_srgb_encode((float)top), b = (double)wr_srgb_encode((float)bottom);
    return wr_srgb_decode((float)(a + (b - a) * share));
}

void wr_background_row(const WrBackground *background, int row, int height, float out[3])
{
    const bool gradient = background->kind == WR_BACKGROUND_GRADIENT;
    for (int c = 0; c < 3; c++) {
        const double top = background->top[c], bottom = background->bottom[c];
        if (!gradient || row <= 0 || height <= 1) out[c] = (float)top;
        else if (row >= height - 1) out[c] = (float)bottom;
        else out[c] = between(top, bottom, row / (height - 1.0));
    }
}

bool wr_background_equal(const WrBackground *a, const WrBackground *b)
{
    return a->kind == b->kind && memcmp(a->top, b->top, sizeof a->top) == 0 &&
           (a->kind != WR_BACKGROUND_GRADIENT ||
            memcmp(a->bottom, b->bottom, sizeof a->bottom) == 0);
}
