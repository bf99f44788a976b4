#include "document/ora_show.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"

#include <string.h>

#define THUMBNAIL 256 /* maximum pixels along a side */

static double clamp01(double x)
{
    return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0;
}

static double grey_of(const WrOraRange *range, float height)
{
    return clamp01(((double)height - range->low) / ((double)range->high - range->low));
}

WrOraShowing wr_ora_showing(WrBlend blend)
{
    switch (blend) {
    case WR_BLEND_ADD: return WR_ORA_SUM;
    case WR_BLEND_SUBTRACT: return WR_ORA_TAKEN;
    case WR_BLEND_MIX: return WR_ORA_MIXED;
    case WR_BLEND_MULTIPLY: return WR_ORA_FACTOR;
    case WR_BLEND_MAX:
    case WR_BLEND_MIN:
    case WR_BLEND_SMOOTH_MAX:
    case WR_BLEND_SMOOTH_MIN:
    case WR_BLEND_REPLACE:
    case WR_BLEND_COUNT: break;
    }
    return WR_ORA_HEIGHTS;
}

void wr_ora_show(WrOraShowing showing, const WrOraRange *range, float height, float cover_of,
                 float mask_of, double *grey, double *alpha)
{
    double part = clamp01((double)height / ((double)range->high - range->low));
    double cover = clamp01(cover_of), mask = clamp01(mask_of);
    *grey = grey_of(range, height);
    *alpha = cover * mask;
    switch (showing) {
    case WR_ORA_HEIGHTS: break;
    case WR_ORA_MIXED: *alpha = mask; break;
    case WR_ORA_SUM: /* alpha as large as the height needs, if the coverage is smaller */
        if (part > cover) cover = part;
        *grey = cover > 0.0 ? part / cover : 0.0;
        *alpha = cover * mask;
        break;
    case WR_ORA_TAKEN:
        *grey = part;
        *alpha = cover > 0.0 || height != 0.0f ? mask : 0.0;
        break;
    case WR_ORA_FACTOR: *grey = clamp01(height); break;
    }
}

/* Each pixel is the mean of the greys that it covers. */
uint8_t *wr_ora_thumbnail(const WrField *f, const WrOraRange *range, int *width, int *height,
                          WrError *err)
{
    int w = wr_field_width(f), h = wr_field_height(f), most = w > h ? w : h;
    int tw = most <= THUMBNAIL ? w : w * THUMBNAIL / most;
    int th = most <= THUMBNAIL ? h : h * THUMBNAIL / most;
    tw = tw < 1 ? 1 : tw;
    th = th < 1 ? 1 : th;
    float *row = wr_try_alloc((size_t)w, sizeof *row, "a thumbnail", err);
    if (!row) return NULL;
    uint8_t *out = wr_alloc((size_t)tw * (size_t)th, 4);
    double sums[THUMBNAIL];
    for (int y = 0; y < th; y++) {
        int top = (int)((int64_t)y * h / th), bottom = (int)((int64_t)(y + 1) * h / th);
        memset(sums, 0, sizeof sums);
        for (int j = top; j < bottom && !wr_progress_stopped(); j++) {
            wr_field_read(f, 0, j, w, 1, row, (size_t)w);
            for (int x = 0; x < tw; x++)
                for (int i = (int)((int64_t)x * w / tw); i < (int)((int64_t)(x + 1) * w / tw); i++)
                    sums[x] += grey_of(range, row[i]);
        }
        for (int x = 0; x < tw; x++) {
            int64_t columns = (int64_t)(x + 1) * w / tw - (int64_t)x * w / tw;
            double mean = sums[x] / ((double)columns * (bottom - top));
            uint8_t *pixel = out + 4 * ((size_t)y * (size_t)tw + (size_t)x);
            pixel[0] = pixel[1] = pixel[2] = (uint8_t)(255.0 * clamp01(mean) + 0.5);
            pixel[3] = 255;
        }
    }
    wr_free(row);
    *width = tw;
    *height = th;
    return out;
}
