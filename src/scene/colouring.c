#include "scene/colouring.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/vec.h"
#include "field/field.h"
#include "image/image.h"
#include "surface/surface.h"
#include "surface/terrain.h"

#include <math.h>
#include <string.h>

const char *const wr_colouring_names[WR_COLOURINGS] = { "form", "table" };

void wr_colouring_default(WrColouring *out)
{
    static const WrStop stops[] = {
        { 0, { 0.02, 0.07, 0.16 } },    { 0.3, { 0.08, 0.28, 0.36 } },
        { 0.32, { 0.62, 0.54, 0.33 } }, { 0.37, { 0.26, 0.33, 0.1 } },
        { 0.55, { 0.08, 0.17, 0.05 } }, { 0.72, { 0.25, 0.21, 0.15 } },
        { 0.82, { 0.42, 0.4, 0.38 } },  { 0.9, { 0.88, 0.9, 0.93 } },
    };
    *out = (WrColouring){ .count = sizeof stops / sizeof *stops, .slope = { 30, 45 } };
    memcpy(out->stops, stops, sizeof stops);
}

static void mix(const double a[3], const double b[3], double t, double out[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[c] + t * (b[c] - a[c]);
}

void wr_colouring_at(const WrColouring *colouring, double height, double slope_deg, double rgb[3])
{
    const WrStop *stops = colouring->stops;
    int above = 0;
    while (above < colouring->count && stops[above].height <= height) above++;
    const WrStop *low = &stops[above > 0 ? above - 1 : 0];
    const WrStop *high = &stops[above < colouring->count ? above : colouring->count - 1];
    const double span = high->height - low->height;
    mix(low->rgb, high->rgb, span > 0 ? fmax(0, (height - low->height) / span) : 0, rgb);
    if (!colouring->steep) return;
    const double *slope = colouring->slope, room = slope[1] - slope[0];
    const double t = room > 0 ? fmin(fmax((slope_deg - slope[0]) / room, 0), 1)
                              : (slope_deg >= slope[0] ? 1 : 0);
    const double from[3] = { rgb[0], rgb[1], rgb[2] };
    mix(from, colouring->steep_rgb, t * t * (3 - 2 * t), rgb);
}

static void put(const WrColouring *colouring, double height, double slope, float *out)
{
    double rgb[3];
    wr_colouring_at(colouring, height, slope * 180 / WR_PI, rgb);
    for (int c = 0; c < 3; c++) out[c] = (float)rgb[c];
}

static WrImage *picture_of(int w, int h, WrError *err)
{
    WrImage *image = wr_image_new(w, h, 3, err);
    if (image) image->type = WR_PIXEL_F32;
    return image;
}

/* Where somebody wants it to stop, before another row: the picture goes. */
static bool stopped(WrImage **image, double done, WrError *err)
{
    if (wr_progress_tell(done)) return false;
    wr_image_free(*image);
    *image = NULL;
    wr_fail(err, "cancelled");
    return true;
}

/* ---- of a form ---- */

WrImage *wr_colouring_form(const WrColouring *colouring, const WrPatches *set, double height, int w,
                           int h, WrError *err)
{
    WrImage *image = picture_of(w, h, err);
    for (int k = 0; image && k < w * h; k++) {
        if (k % w == 0 && stopped(&image, (double)(k / w) / h, err)) break;
        WrSurfacePoint at;
        wr_terrain_at(set, (k % w + 0.5) / w, 1 - (k / w + 0.5) / h, &at);
        put(colouring, height != 0 ? at.p.z / height : 0, acos(fmin(fabs(at.n_unit.z), 1)),
            image->data + 3 * (size_t)k);
    }
    return image;
}

/* ---- of a table ---- */

WrImage *wr_colouring_table(const WrColouring *colouring, const WrField *field, double height,
                            WrError *err)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const size_t pitch = (size_t)w + 2;
    WrImage *image = picture_of(w, h, err);
    float *rows = wr_alloc(3 * pitch, sizeof *rows);
    for (int j = 0; image && j < h && !stopped(&image, (double)j / h, err); j++) {
        wr_field_read(field, -1, j - 1, w + 2, 3, rows, pitch);
        for (int i = 0; i < w; i++) {
            const float *at = rows + pitch + 1 + i;
            const double fu = ((double)at[1] - (double)at[-1]) * 0.5 * w * height;
            const double fv =
                ((double)at[-(ptrdiff_t)pitch] - (double)at[pitch]) * 0.5 * h * height;
            put(colouring, (double)*at, atan(hypot(fu, fv)),
                image->data + 3 * ((size_t)j * (size_t)w + (size_t)i));
        }
    }
    wr_free(rows);
    return image;
}
