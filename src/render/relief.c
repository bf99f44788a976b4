#include "render/relief.h"

#include "image/image.h"
#include "scene/normal_map.h"

void wr_relief_drop(WrRelief *relief)
{
    wr_image_free((WrImage *)relief->source);
    wr_pyramid_drop(&relief->pyramid);
    *relief = (WrRelief){ 0 };
}

static void fill(WrPyramid *pyramid, const WrImage *image)
{
    const WrPyramidLevel *at = &pyramid->level[1];
    for (int j = 0; j < image->height; j++)
        for (int i = 0; i < image->width; i++) {
            const size_t place = (size_t)j * (size_t)image->width + (size_t)i;
            float *out = at->data + (size_t)((j + 1) * at->pitch + i + 1) * (size_t)pyramid->floats;
            double p, q;
            wr_normal_map_slopes(image->data + 3 * place, &p, &q);
            out[0] = (float)p, out[1] = (float)q;
        }
}

bool wr_relief_bring(WrRelief *relief, const WrImage *image, WrWrap wrap_u, WrWrap wrap_v,
                     WrPool *pool, WrError *err)
{
    if (relief->source == image && relief->wrap_u == wrap_u && relief->wrap_v == wrap_v)
        return true;
    wr_relief_drop(relief);
    WrPyramid *pyramid = &relief->pyramid;
    if (!wr_pyramid_allocate(pyramid, WR_PYRAMID_MOMENTS, 2 * image->width, 2 * image->height, err))
        return false;
    fill(pyramid, image);
    if (!wr_pyramid_finish(pyramid, wrap_u, wrap_v, pool, err)) return false;
    relief->source = wr_image_share(image);
    relief->wrap_u = wrap_u, relief->wrap_v = wrap_v;
    return true;
}
