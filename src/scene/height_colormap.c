#include "scene/height_colormap.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/vec.h"
#include "field/field.h"
#include "field/ops.h"
#include "image/image.h"
#include "surface/surface.h"
#include "surface/terrain.h"

#include <math.h>
#include <string.h>

const char *const wr_height_colormap_names[WR_COLOURINGS] = { "form", "table" };

void wr_height_colormap_default(WrHeightColormap *out)
{
    static const WrStop stops[] = {
        { 0, { 0.02, 0.07, 0.16 } },    { 0.3, { 0.08, 0.28, 0.36 } },
        { 0.32, { 0.62, 0.54, 0.33 } }, { 0.37, { 0.26, 0.33, 0.1 } },
        { 0.55, { 0.08, 0.17, 0.05 } }, { 0.72, { 0.25, 0.21, 0.15 } },
        { 0.82, { 0.42, 0.4, 0.38 } },  { 0.9, { 0.88, 0.9, 0.93 } },
    };
    *out = (WrHeightColormap){ .count = sizeof stops / sizeof *stops,
                               .slope = { 30, 45 },
                               .depth = { 0.01, 0.1 },
                               .within = 8 };
    memcpy(out->stops, stops, sizeof stops);
}

static void mix(const double a[3], const double b[3], double t, double out[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[c] + t * (b[c] - a[c]);
}

/* The colour appears from where[0] on, and is full from where[1] on. */
static void ease(const double own[3], const double where[2], double at, double rgb[3])
{
    const double room = where[1] - where[0];
    const double t = room > 0 ? fmin(fmax((at - where[0]) / room, 0), 1) : (at >= where[0] ? 1 : 0);
    const double from[3] = { rgb[0], rgb[1], rgb[2] };
    mix(from, own, t * t * (3 - 2 * t), rgb);
}

/* Stops are in ascending order of height; below the first and above the last the colour is constant. */
void wr_height_colormap_at(const WrHeightColormap *colouring, double height, double slope_deg,
                           double rgb[3])
{
    const WrStop *stops = colouring->stops;
    int above = 0;
    while (above < colouring->count && stops[above].height <= height) above++;
    const WrStop *low = &stops[above > 0 ? above - 1 : 0];
    const WrStop *high = &stops[above < colouring->count ? above : colouring->count - 1];
    const double span = high->height - low->height;
    mix(low->rgb, high->rgb, span > 0 ? fmax(0, (height - low->height) / span) : 0, rgb);
    if (colouring->steep) ease(colouring->steep_rgb, colouring->slope, slope_deg, rgb);
}

/* Blends with the colour of hollows in the same way, for a place this far below its surroundings. */
static void height_colormap_hollow(const WrHeightColormap *colouring, double below, double rgb[3])
{
    if (colouring->hollow) ease(colouring->hollow_rgb, colouring->depth, below, rgb);
}

/* Colours one texel from its height, slope and local mean (NULL if hollows have no colour). */
static void put(const WrHeightColormap *colouring, double height, double slope, const float *mean,
                float *out)
{
    double rgb[3];
    wr_height_colormap_at(colouring, height, slope * 180 / WR_PI, rgb);
    if (mean) height_colormap_hollow(colouring, (double)*mean - height, rgb);
    for (int c = 0; c < 3; c++) out[c] = (float)rgb[c];
}

static WrImage *picture_of(int w, int h, WrError *err)
{
    WrImage *image = wr_image_new(w, h, 3, err);
    if (image) image->type = WR_PIXEL_F32;
    return image;
}

/* Checks for cancellation before another row; frees the image if cancelled. */
static bool stopped(WrImage **image, double done, WrError *err)
{
    if (wr_progress_report(done)) return false;
    wr_image_free(*image);
    *image = NULL;
    wr_fail(err, "cancelled");
    return true;
}

/* Local means, for hollows. */
static WrField *means_of(const WrHeightColormap *colouring, const WrField *field, WrError *err)
{
    const double sigma = colouring->within;
    return wr_op_run(wr_op_find("blur"), field, &sigma, NULL, err);
}

/* ---- for a terrain ---- */

/* Computes its heights, and its colours without hollows, on a table of w x h.
   Heights of the terrain without its exaggeration, so that a colour stays at its place when `height` changes. */
static bool form_rows(const WrHeightColormap *colouring, const WrPatches *set, double height,
                      WrField *heights, WrImage **image, WrError *err)
{
    const int w = (*image)->width, h = (*image)->height;
    for (int k = 0; k < w * h; k++) {
        if (k % w == 0 && stopped(image, (double)(k / w) / h, err)) return false;
        WrSurfacePoint at;
        wr_terrain_at(set, (k % w + 0.5) / w, 1 - (k / w + 0.5) / h, &at);
        const double own = height != 0 ? at.p.z / height : 0;
        put(colouring, own, wr_acos(fmin(fabs(at.n_unit.z), 1)), NULL,
            (*image)->data + 3 * (size_t)k);
        if (heights) wr_field_set(heights, k % w, k / w, (float)own);
    }
    return true;
}

static void fill_hollows(const WrHeightColormap *colouring, const WrField *heights,
                         const WrField *means, WrImage *image)
{
    for (int k = 0; k < image->width * image->height; k++) {
        const int i = k % image->width, j = k / image->width;
        float *at = image->data + 3 * (size_t)k;
        double rgb[3] = { (double)at[0], (double)at[1], (double)at[2] };
        height_colormap_hollow(
            colouring, (double)wr_field_get(means, i, j) - (double)wr_field_get(heights, i, j),
            rgb);
        for (int c = 0; c < 3; c++) at[c] = (float)rgb[c];
    }
}

WrImage *wr_height_colormap_bake_terrain(const WrHeightColormap *colouring, const WrPatches *set,
                                         double height, int w, int h, WrError *err)
{
    WrImage *image = picture_of(w, h, err);
    WrField *heights = NULL, *means = NULL;
    if (image && colouring->hollow)
        heights = wr_field_new(w, h, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, err);
    if (image && (heights || !colouring->hollow) &&
        form_rows(colouring, set, height, heights, &image, err) && heights)
        means = means_of(colouring, heights, err);
    if (means) fill_hollows(colouring, heights, means, image);
    if (colouring->hollow && !means) {
        wr_image_free(image);
        image = NULL;
    }
    wr_field_free(means);
    wr_field_free(heights);
    return image;
}

/* ---- for a table ---- */

/* Row j; rows: those above, at and below it, each with one more texel at both ends.
   Central differences over two texels, in scene units of a cell of size 1; rows run down, so v has the
   opposite order. */
static void table_row(const WrHeightColormap *colouring, double height, int j, const float *rows,
                      const float *means, WrImage *image)
{
    const int w = image->width, h = image->height;
    const ptrdiff_t pitch = w + 2;
    for (int i = 0; i < w; i++) {
        const float *at = rows + pitch + 1 + i;
        const double fu = ((double)at[1] - (double)at[-1]) * 0.5 * w * height;
        const double fv = ((double)at[-pitch] - (double)at[pitch]) * 0.5 * h * height;
        put(colouring, (double)*at, wr_atan(wr_hypot(fu, fv)), means ? means + i : NULL,
            image->data + 3 * ((size_t)j * (size_t)w + (size_t)i));
    }
}

/* rows holds three rows of w + 2 floats and a fourth for the means; reading beyond the table wraps or extends
   as the table does. */
WrImage *wr_height_colormap_table(const WrHeightColormap *colouring, const WrField *field,
                                  double height, WrError *err)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const size_t pitch = (size_t)w + 2;
    WrField *means = colouring->hollow ? means_of(colouring, field, err) : NULL;
    if (colouring->hollow && !means) return NULL;
    WrImage *image = picture_of(w, h, err);
    float *rows = wr_alloc(4 * pitch, sizeof *rows), *mean = means ? rows + 3 * pitch : NULL;
    for (int j = 0; image && j < h && !stopped(&image, (double)j / h, err); j++) {
        wr_field_read(field, -1, j - 1, w + 2, 3, rows, pitch);
        if (mean) wr_field_read(means, 0, j, w, 1, mean, pitch);
        table_row(colouring, height, j, rows, mean, image);
    }
    wr_free(rows);
    wr_field_free(means);
    return image;
}
