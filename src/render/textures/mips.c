#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "image/image.h"
#include "render/textures/mips.h"
#include "scene/normal_map.h"
#include "surface/tangent_frames.h"

#include <string.h>

/* ---- colours ---- */

void wr_color_mips_drop(WrColorMips *tint)
{
    wr_image_free((WrImage *)tint->source);
    wr_free(tint->rgba);
    wr_pyramid_drop(&tint->pyramid);
    *tint = (WrColorMips){ 0 };
}

/* rgba [h + 2][w + 2][4] with a border of one texel; the fourth number is padding, so that a texel is one
   vector load. Grey pictures repeat their channel. */
bool wr_color_mips_update(WrColorMips *tint, const WrImage *image, WrWrap wrap_u, WrWrap wrap_v,
                          WrError *err)
{
    if (tint->source == image && tint->wrap_u == wrap_u && tint->wrap_v == wrap_v) return true;
    wr_color_mips_drop(tint);
    const int w = image->width, h = image->height, c = image->channels;
    tint->rgba =
        wr_try_alloc((size_t)(w + 2) * (size_t)(h + 2), 4 * sizeof(float), "colour picture", err);
    if (!tint->rgba) return false;
    tint->source = wr_image_share(image);
    tint->wrap_u = wrap_u, tint->wrap_v = wrap_v;
    tint->pitch = w + 2;
    for (int j = -1; j <= h; j++)
        for (int i = -1; i <= w; i++) {
            const size_t place = (size_t)wr_pyramid_fold(j, h, wrap_v) * (size_t)w +
                                 (size_t)wr_pyramid_fold(i, w, wrap_u);
            const float *in = image->data + place * (size_t)c;
            float *out = tint->rgba + ((size_t)(j + 1) * (size_t)tint->pitch + (size_t)(i + 1)) * 4;
            out[0] = in[0];
            out[1] = c >= 3 ? in[1] : in[0];
            out[2] = c >= 3 ? in[2] : in[0];
        }
    return true;
}

/* ---- the pyramid --------------------------------------------------------------------------------- */

typedef struct Job {
    WrColorMips *tint;
    int level; /* level to build */
} Job;

/* Row j of the picture or of the apron, from its first texel on; level 0 is the picture. */
static float *row_of(const WrColorMips *tint, int level, int j)
{
    const WrPyramidLevel *at = &tint->pyramid.level[level];
    return (level ? at->data : tint->rgba) + ((size_t)(j + 1) * (size_t)at->pitch + 1) * 4;
}

/* Box weights as for slopes (slope_pyramid.c): means are preserved at odd sizes (HC55). */
static void make_row(int j, int worker, void *ctx)
{
    (void)worker;
    const Job *job = ctx;
    const WrPyramidLevel *to = &job->tint->pyramid.level[job->level], *from = to - 1;
    const WrShare v = wr_pyramid_box_weights(j, from->height, to->height);
    float *out = row_of(job->tint, job->level, j);
    if (wr_progress_stopped()) return;
    for (int i = 0; i < to->width; i++) {
        const WrShare u = wr_pyramid_box_weights(i, from->width, to->width);
        double sum[3] = { 0 };
        for (int b = 0; b < v.count; b++) {
            const float *in = row_of(job->tint, job->level - 1, v.from + b) + 4 * u.from;
            for (int a = 0; a < u.count; a++)
                for (int c = 0; c < 3; c++)
                    sum[c] += u.weight[a] * v.weight[b] * (double)in[4 * a + c];
        }
        for (int c = 0; c < 3; c++) out[4 * i + c] = (float)sum[c];
    }
}

static void make_apron(const WrColorMips *tint, int level)
{
    const WrPyramidLevel *at = &tint->pyramid.level[level];
    const int w = at->width, h = at->height;
    for (int j = 0; j < h; j++) {
        float *row = row_of(tint, level, j);
        memcpy(row - 4, row + 4 * wr_pyramid_fold(-1, w, tint->wrap_u), 4 * sizeof *row);
        memcpy(row + 4 * w, row + 4 * wr_pyramid_fold(w, w, tint->wrap_u), 4 * sizeof *row);
    }
    const size_t bytes = (size_t)at->pitch * 4 * sizeof(float);
    const int above = wr_pyramid_fold(-1, h, tint->wrap_v),
              below = wr_pyramid_fold(h, h, tint->wrap_v);
    memcpy(row_of(tint, level, -1) - 4, row_of(tint, level, above) - 4, bytes);
    memcpy(row_of(tint, level, h) - 4, row_of(tint, level, below) - 4, bytes);
}

bool wr_color_mips_update_pyramid(WrColorMips *tint, WrPool *pool, WrError *err)
{
    WrPyramid *pyramid = &tint->pyramid;
    Job job = { .tint = tint };
    if (pyramid->levels > 0) return true;
    if (!wr_pyramid_allocate(pyramid, WR_PYRAMID_COLOUR, tint->source->width, tint->source->height,
                             err))
        return false;
    for (job.level = 1; job.level < pyramid->levels; job.level++) {
        wr_pool_run(pool, pyramid->level[job.level].height, make_row, &job);
        make_apron(tint, job.level);
    }
    if (!wr_progress_stopped()) return true;
    wr_pyramid_drop(pyramid); /* incomplete */
    return wr_fail(err, "cancelled");
}

/* ---- normal maps ---- */

void wr_normal_mips_drop(WrNormalMips *relief)
{
    wr_image_free((WrImage *)relief->source);
    wr_pyramid_drop(&relief->pyramid);
    *relief = (WrNormalMips){ 0 };
}

/* Moments are those of slopes, not of vectors: means of p, q and their covariance (NUMERICS-SCENES b). Maps in
   object space have no slopes and average their vectors. */
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

/* The pyramid is allocated for twice the size, so that the map itself is level 1 and is built like the levels
   of a table. */
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

/* Six floats per corner: t, and b or, for mikk, the sign from which b is computed per sample. */
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
