#include "render/textures/normal_mips.h"

#include "base/memory.h"
#include "image/image.h"
#include "scene/normal_map.h"
#include "surface/tangent_frames.h"

#include <string.h>

void wr_normal_mips_drop(WrNormalMips *relief)
{
    wr_image_free((WrImage *)relief->source);
    wr_pyramid_drop(&relief->pyramid);
    *relief = (WrNormalMips){ 0 };
}

static void fill(WrPyramid *pyramid, const WrImage *image)
{
    const WrPyramidLevel *at = &pyramid->level[1];
    for (int j = 0; j < image->height; j++)
        for (int i = 0; i < image->width; i++) {
            const size_t place = (size_t)j * (size_t)image->width + (size_t)i;
            float *out = at->data + (size_t)((j + 1) * at->pitch + i + 1) * (size_t)pyramid->floats;
            double p, q;
            if (pyramid->kind == WR_PYRAMID_SLOPES) {
                memcpy(out, image->data + 3 * place, 3 * sizeof *out);
                continue;
            }
            wr_normal_map_slopes(image->data + 3 * place, &p, &q);
            out[0] = (float)p, out[1] = (float)q;
        }
}

bool wr_normal_mips_update(WrNormalMips *relief, const WrImage *image, bool vectors, WrWrap wrap_u,
                           WrWrap wrap_v, WrPool *pool, WrError *err)
{
    if (relief->source == image && relief->vectors == vectors && relief->wrap_u == wrap_u &&
        relief->wrap_v == wrap_v)
        return true;
    wr_normal_mips_drop(relief);
    WrPyramid *pyramid = &relief->pyramid;
    const WrPyramidKind kind = vectors ? WR_PYRAMID_SLOPES : WR_PYRAMID_MOMENTS;
    if (!wr_pyramid_allocate(pyramid, kind, 2 * image->width, 2 * image->height, err)) return false;
    fill(pyramid, image);
    if (!wr_pyramid_finish(pyramid, wrap_u, wrap_v, pool, err)) return false;
    relief->source = wr_image_share(image);
    relief->wrap_u = wrap_u, relief->wrap_v = wrap_v;
    relief->vectors = vectors;
    return true;
}

/* ---- tangent frames ------------------------------------------------------------------------------ */

void wr_frames_drop(WrFrames *frames)
{
    wr_triangles_free((WrTriangles *)frames->source);
    wr_free(frames->corner);
    *frames = (WrFrames){ 0 };
}

static void put_frame(const WrTangent *from, bool mikk, float *out)
{
    const WrVec3 b = from->b, sign = { from->sign, 0, 0 }, second = mikk ? sign : b;
    out[0] = (float)from->t.x, out[1] = (float)from->t.y, out[2] = (float)from->t.z;
    out[3] = (float)second.x, out[4] = (float)second.y, out[5] = (float)second.z;
}

bool wr_frames_update(WrFrames *frames, const WrTriangles *triangles, WrNormalFrame kind,
                      WrError *err)
{
    const size_t corners = 3 * (size_t)triangles->triangle_count;
    const bool mikk = kind == WR_FRAME_MIKK;
    if (frames->source == triangles && frames->kind == kind) return true;
    wr_frames_drop(frames);
    WrTangent *made = wr_try_alloc(corners, sizeof *made, "tangent frames", err);
    frames->corner =
        made ? wr_try_alloc(corners, WR_CORNER_FRAME * sizeof(float), "tangent frames", err) : NULL;
    const bool good = frames->corner && (mikk ? wr_tangents_mikk : wr_tangents_average)(
                                            triangles->corners, triangles->triangles,
                                            triangles->triangle_count, made, err);
    for (size_t i = 0; i < corners && good; i++)
        put_frame(&made[i], mikk, frames->corner + i * WR_CORNER_FRAME);
    wr_free(made);
    if (!good) {
        wr_frames_drop(frames);
        return false;
    }
    frames->source = wr_triangles_share(triangles);
    frames->kind = kind;
    return true;
}
