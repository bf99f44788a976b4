#include "render/environment/env_lookup.h"

#include "base/error.h"
#include "base/memory.h"
#include "image/image.h"
#include "shade/environment_blur.h"

#include <string.h>

void wr_env_lookup_drop(WrEnvLookup *mirror)
{
    wr_environment_map_free(mirror->source);
    wr_free(mirror->rgba);
    *mirror = (WrEnvLookup){ 0 };
}

static bool holds(const WrEnvLookup *mirror, const WrEnvironmentMap *surround,
                  const WrEnvironmentBrdf *gloss, double fine)
{
    const WrEnvironmentBrdf *own = &mirror->gloss;
    if (mirror->source != surround) return false;
    if (!gloss) return own->lobe == WR_LOBE_NONE;
    return own->lobe == gloss->lobe && own->alpha == gloss->alpha && own->power == gloss->power &&
           own->gated == gloss->gated && mirror->fine == fine;
}

/* Copies row j >= 0 of rgb into the padded table. */
static void put_row(WrEnvLookup *mirror, int j, const float *rgb)
{
    const int w = mirror->width;
    float *out = mirror->rgba + (size_t)(j + 1) * (size_t)mirror->pitch * 4;
    for (int i = -1; i <= w; i++, out += 4)
        memcpy(out, rgb + (size_t)((i + w) % w) * 3, 3 * sizeof *out);
}

/* Fills the row above the first or below the last so that the pole is the mean of that row. */
static void put_pole(WrEnvLookup *mirror, int from, int to)
{
    const int w = mirror->width;
    const size_t row = (size_t)mirror->pitch * 4;
    const float *in = mirror->rgba + (size_t)(from + 1) * row;
    float *out = mirror->rgba + (size_t)(to + 1) * row;
    for (int c = 0; c < 3; c++) {
        double mean = 0;
        for (int i = 1; i <= w; i++) mean += (double)in[4 * i + c] / w;
        for (int i = 0; i < mirror->pitch; i++)
            out[4 * i + c] = (float)(2 * mean - (double)in[4 * i + c]);
    }
}

static bool fill(WrEnvLookup *mirror, const float *rgb, WrError *err)
{
    mirror->pitch = mirror->width + 2;
    mirror->rgba = wr_try_alloc((size_t)mirror->pitch * (size_t)(mirror->height + 2),
                                4 * sizeof(float), "surroundings", err);
    if (!mirror->rgba) return false;
    for (int j = 0; j < mirror->height; j++)
        put_row(mirror, j, rgb + (size_t)j * (size_t)mirror->width * 3);
    put_pole(mirror, 0, -1);
    put_pole(mirror, mirror->height - 1, mirror->height);
    return true;
}

static bool fill_blurred(WrEnvLookup *mirror, const WrEnvironmentBrdf *gloss, WrPool *pool,
                         WrError *err)
{
    mirror->width = wr_blur_width(gloss, mirror->fine);
    mirror->height = mirror->width / 2;
    float *rgb = wr_try_alloc((size_t)mirror->width * (size_t)mirror->height, 3 * sizeof *rgb,
                              "blurred surroundings", err);
    const bool good =
        rgb && wr_environment_map_blur(mirror->source, gloss, mirror->width, pool, rgb, err) &&
        fill(mirror, rgb, err);
    wr_free(rgb);
    return good;
}

bool wr_env_lookup_update(WrEnvLookup *mirror, const WrEnvironmentMap *surround,
                          const WrEnvironmentBrdf *gloss, double fine, WrPool *pool, WrError *err)
{
    if (holds(mirror, surround, gloss, fine)) return true;
    wr_env_lookup_drop(mirror);
    mirror->source = wr_environment_map_share(surround);
    mirror->fine = fine;
    if (gloss) mirror->gloss = *gloss;
    mirror->width = surround->image->width, mirror->height = surround->image->height;
    if (gloss ? fill_blurred(mirror, gloss, pool, err) : fill(mirror, surround->image->data, err))
        return true;
    wr_env_lookup_drop(mirror);
    return false;
}
