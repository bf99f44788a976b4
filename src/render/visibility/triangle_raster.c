#include "render/visibility/triangle_raster.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "render/visibility/raster.h"

#include <float.h>
#include <string.h>

#define CHUNK 4096 /* corners projected by one task */

void wr_view_triangles_fini(WrViewTriangles *to)
{
    wr_triangles_free(to->source);
    wr_free(to->cones);
    wr_free(to->sx);
    wr_free(to->sy);
    wr_free(to->close);
    wr_free(to->out);
    wr_free(to->blocks);
    wr_free(to->groups);
    *to = (WrViewTriangles){ 0 };
}

static bool allocate(WrViewTriangles *to, const WrTriangles *source, WrError *err)
{
    const size_t corners = (size_t)source->corner_count;
    to->block_count = (source->triangle_count + WR_TRIANGLE_BLOCK - 1) / WR_TRIANGLE_BLOCK;
    to->group_count = (to->block_count + WR_TRIANGLE_GROUP - 1) / WR_TRIANGLE_GROUP;
    to->sx = wr_try_alloc(corners, sizeof *to->sx, "a mesh's view", err);
    to->sy = to->sx ? wr_try_alloc(corners, sizeof *to->sy, "a mesh's view", err) : NULL;
    to->close = to->sy ? wr_try_alloc(corners, sizeof *to->close, "a mesh's view", err) : NULL;
    to->out = to->close ? wr_try_alloc(corners, sizeof *to->out, "a mesh's view", err) : NULL;
    to->cones = to->out
                    ? wr_try_alloc((size_t)to->block_count, sizeof *to->cones, "a mesh's view", err)
                    : NULL;
    if (!to->cones) return false;
    to->blocks = wr_alloc((size_t)to->block_count, sizeof *to->blocks);
    to->groups = wr_alloc((size_t)to->group_count, sizeof *to->groups);
    return true;
}

/* ---- blocks ---- */

static int32_t block_end(const WrViewTriangles *to, int32_t block)
{
    const int32_t end = (block + 1) * WR_TRIANGLE_BLOCK, all = to->source->triangle_count;
    return end < all ? end : all;
}

static WrVec3 corner_at(const WrTriangles *t, int32_t i, int k)
{
    const float *p = t->corners[t->triangles[i].corner[k]].p;
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

static WrVec3 face_normal(const WrTriangles *t, int32_t i)
{
    const WrVec3 a = corner_at(t, i, 0), none = { 0, 0, 0 };
    return v3_unit(v3_cross(v3_sub(corner_at(t, i, 1), a), v3_sub(corner_at(t, i, 2), a)), none);
}

/* Bounding sphere and normal cone of a block: the axis is the mean of the face normals, and the margin of 1e-9
   covers rounding. */
static void make_cone(int block, int worker, void *ctx)
{
    (void)worker;
    WrViewTriangles *to = ctx;
    const WrTriangles *t = to->source;
    const int32_t from = block * WR_TRIANGLE_BLOCK, end = block_end(to, block);
    WrTriangleCone cone = { .cosine = 1 };
    WrVec3 sum = { 0, 0, 0 };
    for (int32_t i = from; i < end; i++) {
        sum = v3_add(sum, face_normal(t, i));
        for (int k = 0; k < 3; k++)
            cone.centre = v3_mad(cone.centre, corner_at(t, i, k), 1.0 / (3 * (end - from)));
    }
    cone.axis = v3_unit(sum, (WrVec3){ 0, 0, 0 });
    for (int32_t i = from; i < end; i++) {
        cone.cosine = fmin(cone.cosine, v3_dot(cone.axis, face_normal(t, i)));
        for (int k = 0; k < 3; k++)
            cone.radius = fmax(cone.radius, v3_len(v3_sub(corner_at(t, i, k), cone.centre)));
    }
    cone.cosine -= 1e-9;
    cone.radius *= 1 + 1e-9;
    cone.sine = sqrt(fmax(0, 1 - cone.cosine * cone.cosine));
    to->cones[block] = cone;
}

/* True if all faces of the block certainly face away from the eye. With the axis at angle b from the direction
   to the eye and normals within a of it, n . (eye - P) <= |w| cos(b - a) + radius. */
static bool looks_away(const WrTriangleCone *cone, const WrView *view)
{
    if (cone->cosine < 0) return false;
    WrVec3 w = v3_neg(view->ahead);
    double radius = 0, length = 1;
    if (view->perspective) {
        w = v3_sub(view->eye, v3_scale(cone->centre, view->scale));
        radius = cone->radius * view->scale;
        length = v3_len(w);
    }
    const double cos_b = v3_dot(cone->axis, w) / (length > 0 ? length : 1);
    const double sin_b = sqrt(fmax(0, 1 - cos_b * cos_b));
    /* the axis is within the cone's angle of that direction */
    if (cos_b > cone->cosine) return false;
    const double most = cos_b * cone->cosine + sin_b * cone->sine;
    return most * length + radius < -1e-6 * length;
}

typedef struct Job {
    WrViewTriangles *to;
    const WrView *view;
    bool apart;
} Job;

static void project_chunk(int chunk, int worker, void *ctx)
{
    (void)worker;
    const Job *job = ctx;
    WrViewTriangles *to = job->to;
    const int32_t end = (chunk + 1) * CHUNK, all = to->source->corner_count;
    for (int32_t i = chunk * CHUNK; i < (end < all ? end : all); i++) {
        const float *from = to->source->corners[i].p;
        const WrVec3 p = v3_scale((WrVec3){ (double)from[0], (double)from[1], (double)from[2] },
                                  job->view->scale);
        WrRasterVertex vertex;
        to->out[i] = WR_VERTEX_IN;
        if (!wr_raster_project(job->view, p, 0, 0, &vertex))
            to->out[i] = wr_raster_bound(job->view, p, &vertex.x, &vertex.y) ? WR_VERTEX_OUT
                                                                             : WR_VERTEX_BEHIND;
        to->sx[i] = vertex.x;
        to->sy[i] = vertex.y;
        to->close[i] = vertex.close;
    }
}

static const WrViewMeshBlock nothing = { INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN, false };

static void include_box(WrViewMeshBlock *in, const WrViewMeshBlock *b)
{
    in->x0 = b->x0 < in->x0 ? b->x0 : in->x0;
    in->x1 = b->x1 > in->x1 ? b->x1 : in->x1;
    in->y0 = b->y0 < in->y0 ? b->y0 : in->y0;
    in->y1 = b->y1 > in->y1 ? b->y1 : in->y1;
    in->clipped |= b->clipped;
}

/* Bounds of the projected corners. Corners behind the near plane have no position: a block with some of them has
   unknown bounds, one with only such corners is empty. */
static WrViewMeshBlock bound_block(const WrViewTriangles *to, int32_t block)
{
    WrViewMeshBlock b = nothing;
    int behind = 0, before = 0;
    for (int32_t i = block * WR_TRIANGLE_BLOCK; i < block_end(to, block); i++)
        for (int k = 0; k < 3; k++) {
            const int32_t c = to->source->triangles[i].corner[k];
            if (to->out[c] == WR_VERTEX_BEHIND) {
                behind++;
                continue;
            }
            before++;
            include_box(&b,
                        &(WrViewMeshBlock){ to->sx[c], to->sy[c], to->sx[c], to->sy[c], false });
        }
    b.clipped = behind > 0 && before > 0;
    return b;
}

static void bound_group(int group, int worker, void *ctx)
{
    (void)worker;
    const Job *job = ctx;
    WrViewTriangles *to = job->to;
    WrViewMeshBlock all = nothing;
    for (int32_t i = group * WR_TRIANGLE_GROUP;
         i < (group + 1) * WR_TRIANGLE_GROUP && i < to->block_count; i++) {
        const bool away = job->apart && job->view->cull && looks_away(&to->cones[i], job->view);
        to->blocks[i] = away ? nothing : bound_block(to, i);
        include_box(&all, &to->blocks[i]);
    }
    to->groups[group] = all;
}

bool wr_view_triangles_prepare(WrViewTriangles *to, const WrTriangles *source, const WrView *view,
                               bool blocks_apart, WrPool *pool, WrError *err)
{
    Job job = { to, view, blocks_apart };
    if (to->source != source || (blocks_apart && !to->coned)) {
        WrTriangles *shared = wr_triangles_share(source);
        wr_view_triangles_fini(to);
        to->source = shared;
        if (!allocate(to, source, err)) {
            wr_view_triangles_fini(to);
            return false;
        }
        if (blocks_apart) wr_pool_run(pool, to->block_count, make_cone, to);
        to->coned = blocks_apart;
        to->whole = false;
    }
    const WrViewProjection projection = wr_view_projection(view);
    const bool apart = blocks_apart && view->cull;
    if (to->whole && to->scale == view->scale && to->cull == apart &&
        memcmp(&to->projection, &projection, sizeof projection) == 0)
        return true;
    to->projection = projection, to->scale = view->scale, to->cull = apart;
    wr_pool_run(pool, (source->corner_count + CHUNK - 1) / CHUNK, project_chunk, &job);
    wr_pool_run(pool, to->group_count, bound_group, &job);
    to->whole = true;
    return true;
}

/* ---- tiles ---- */

static WrRasterVertex vertex_of(const WrViewTriangles *from, int32_t c)
{
    return (WrRasterVertex){ from->sx[c], from->sy[c], from->close[c], 0, 0 };
}

static void raster_out(const WrViewTriangles *from, const WrView *view, int32_t i,
                       WrDepthTile *tile)
{
    WrClipVertex corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = wr_raster_camera_vertex(
            view, v3_scale(corner_at(from->source, i, k), view->scale), 0, 0);
    wr_raster_clipped_marked(view, corner, (float)i, tile);
}

/* True if all three are outside the same side. */
static bool beyond(int32_t a, int32_t b, int32_t c, int64_t from, int64_t to)
{
    return (a < from && b < from && c < from) || (a > to && b > to && c > to);
}

static void raster_one(const WrViewTriangles *from, const WrView *view,
                       const WrRasterBounds *bounds, int32_t i, WrDepthTile *tile)
{
    const int32_t *c = from->source->triangles[i].corner;
    const unsigned char *out = from->out;
    const int behind = (out[c[0]] == WR_VERTEX_BEHIND) + (out[c[1]] == WR_VERTEX_BEHIND) +
                       (out[c[2]] == WR_VERTEX_BEHIND);
    if (behind == 3) return;
    if (behind == 0 &&
        (beyond(from->sy[c[0]], from->sy[c[1]], from->sy[c[2]], bounds->y0, bounds->y1) ||
         beyond(from->sx[c[0]], from->sx[c[1]], from->sx[c[2]], bounds->x0, bounds->x1)))
        return;
    if (out[c[0]] | out[c[1]] | out[c[2]]) {
        raster_out(from, view, i, tile);
        return;
    }
    const WrRasterVertex corner[3] = { vertex_of(from, c[0]), vertex_of(from, c[1]),
                                       vertex_of(from, c[2]) };
    wr_raster_marked(view, corner, (float)i, tile);
}

void wr_view_triangles_raster(const WrViewTriangles *from, const WrView *view, WrDepthTile *tile)
{
    const WrRasterBounds bounds = wr_raster_bounds(tile, view->samples);
    for (int i = 0; i < tile->w * tile->h; i++) tile->close[i] = -FLT_MAX;
    for (int32_t b = 0; b < from->block_count; b++) {
        if (b % WR_TRIANGLE_GROUP == 0 &&
            !wr_raster_meets(&from->groups[b / WR_TRIANGLE_GROUP], &bounds)) {
            b += WR_TRIANGLE_GROUP - 1;
            continue;
        }
        if (!wr_raster_meets(&from->blocks[b], &bounds)) continue;
        const int32_t end = block_end(from, b);
        for (int32_t i = b * WR_TRIANGLE_BLOCK; i < end; i++)
            raster_one(from, view, &bounds, i, tile);
    }
}

bool wr_view_triangles_box(const WrViewTriangles *from, const WrView *view, const WrDepthTile *tile,
                           double box[4])
{
    const WrRasterBounds bounds = wr_raster_bounds(tile, view->samples);
    WrViewMeshBlock all = nothing;
    for (int32_t i = 0; i < from->group_count; i++) {
        if (!wr_raster_meets(&from->groups[i], &bounds)) continue;
        const int32_t end = (i + 1) * WR_TRIANGLE_GROUP;
        for (int32_t b = i * WR_TRIANGLE_GROUP; b < end && b < from->block_count; b++)
            if (wr_raster_meets(&from->blocks[b], &bounds)) include_box(&all, &from->blocks[b]);
    }
    box[0] = all.clipped ? -INFINITY : all.x0 / 256.0;
    box[1] = all.clipped ? -INFINITY : all.y0 / 256.0;
    box[2] = all.clipped ? INFINITY : all.x1 / 256.0;
    box[3] = all.clipped ? INFINITY : all.y1 / 256.0;
    return box[0] <= box[2];
}
