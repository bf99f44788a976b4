#include "render/visibility/uv_raster.h"

#include "base/memory.h"
#include "base/pool.h"
#include "render/visibility/raster.h"
#include "base/vec.h"

#include <float.h>
#include <math.h>
#include <string.h>

static void free_points(WrViewMesh *mesh)
{
    wr_free(mesh->v);
    wr_free(mesh->x);
    wr_free(mesh->y);
    wr_free(mesh->z);
    wr_free(mesh->sx);
    wr_free(mesh->sy);
    wr_free(mesh->close);
    wr_free(mesh->out);
    wr_free(mesh->blocks);
}

void wr_view_mesh_fini(WrViewMesh *mesh)
{
    free_points(mesh);
    *mesh = (WrViewMesh){ 0 };
}

/* Samples per kernel unit of length at the nearest point of the object. */
static double samples_per_unit(const WrView *view, const WrShape *shape)
{
    double per = view->grid_h / (2.0 * view->half_h);
    if (!view->perspective) return per;
    WrVec3 centre = v3_scale(wr_shape_centre(shape), view->scale);
    const WrVec3 s = { view->stretch[0], view->stretch[1], view->stretch[2] };
    double depth = v3_len(v3_times(v3_sub(centre, view->eye), s)) - view->radius;
    double least = 0.05 * view->radius;
    return per / (depth > least ? depth : least);
}

/* The smallest sufficient of a few fixed sizes, so that a moving view seldom changes them. At least 16, for
   which a round outline keeps 0.97 of its area however small it is (HC86). */
static int round_cells(double want, int most)
{
    static const int sizes[] = { 16,  24,  32,  48,  64,   96,   128, 192,
                                 256, 384, 512, 768, 1024, 1536, 2048 };
    const int count = (int)(sizeof sizes / sizeof *sizes);
    for (int i = 0; i < count; i++)
        if (want <= sizes[i] || sizes[i] == most) return sizes[i];
    return sizes[count - 1];
}

#define WR_MESH_CORNERS 64

/* Largest |Puu|, |Puv|, |Pvv| over the surface (sampled), in object units; cached while the shape is unchanged. */
static void measure_bend(WrViewMesh *mesh, const WrShape *shape)
{
    if (mesh->measured && memcmp(&mesh->source, shape, sizeof *shape) == 0) return;
    mesh->uu = mesh->uv = mesh->vv = 0;
    /* a user-defined curve may bend within short pieces */
    const int across = 16, up = shape->data ? 128 : 16;
    for (int j = 0; j <= up; j++)
        for (int i = 0; i <= across; i++) {
            WrSurfacePoint at;
            wr_surface_at(shape, 0, (double)i / across, (double)j / up, &at);
            mesh->uu = fmax(mesh->uu, v3_len(at.puu));
            mesh->uv = fmax(mesh->uv, v3_len(at.puv));
            mesh->vv = fmax(mesh->vv, v3_len(at.pvv));
        }
    mesh->source = *shape;
    mesh->measured = true;
}

/* The error of a cell's chord is at most (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8 (Taylor). */
static void choose_cells(const WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                         int finer, int *mu, int *mv)
{
    const double tolerance = 0.25 * view->samples; /* a quarter of a pixel, in samples */
    double k = view->scale * samples_per_unit(view, shape) / (8.0 * tolerance);
    const int most = WR_MESH_MAX; /* a ribbon of sixty turns needs 1500 along it (HC164) ... */
    double u = fmin(sqrt(2.0 * k * (mesh->uu + mesh->uv)), most);
    double v = fmin(sqrt(2.0 * k * (mesh->vv + mesh->uv)), most);
    /* ... but not in both directions */
    const double over = fmax(1.0, sqrt(u * v / (512.0 * 512.0)));
    *mu = round_cells(u / over, most);
    *mv = round_cells(v / over, most);
    *mu = round_cells(scalbn(*mu, finer), most);
    *mv = round_cells(scalbn(*mv, finer), most);
}

typedef struct MeshJob {
    WrViewMesh *mesh;
    const WrView *view;
    const WrKernels *kernels;
} MeshJob;

static void make_row(int j, int worker, void *ctx)
{
    (void)worker;
    MeshJob *job = ctx;
    WrViewMesh *mesh = job->mesh;
    float u[WR_SPAN], v[WR_SPAN];
    for (int from = 0; from <= mesh->mu; from += WR_SPAN) {
        int n = mesh->mu + 1 - from < WR_SPAN ? mesh->mu + 1 - from : WR_SPAN;
        for (int i = 0; i < n; i++) {
            u[i] = (float)(from + i) / (float)mesh->mu;
            v[i] = mesh->v[j];
        }
        size_t at = (size_t)j * (size_t)(mesh->mu + 1) + (size_t)from;
        job->kernels->points[mesh->kind](&mesh->shape, n, u, v, mesh->x + at, mesh->y + at,
                                         mesh->z + at);
    }
}

/* Rows are evenly spaced, except that the row next to a corner moves onto it; else cells would cut it off. */
static void place_rows(WrViewMesh *mesh, const WrShape *shape)
{
    double corner[WR_MESH_CORNERS];
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const int corners = info->corners ? info->corners(shape, corner, WR_MESH_CORNERS) : 0;
    for (int j = 0; j <= mesh->mv; j++) mesh->v[j] = (float)j / (float)mesh->mv;
    for (int k = 0, last = 0; k < corners; k++) {
        int j = (int)(corner[k] * mesh->mv + 0.5);
        j = j > last ? j : last + 1; /* two corners share one row: the next row moves */
        if (j >= mesh->mv) break;
        mesh->v[j] = (float)corner[k];
        for (int i = j + 1; i < mesh->mv && mesh->v[i] <= mesh->v[j]; i++) mesh->v[i] = mesh->v[j];
        last = j;
    }
}

static void project_row(int j, int worker, void *ctx)
{
    (void)worker;
    MeshJob *job = ctx;
    WrViewMesh *mesh = job->mesh;
    const size_t at = (size_t)j * (size_t)(mesh->mu + 1);
    const WrRasterRow row = { mesh->sx + at, mesh->sy + at, mesh->close + at, mesh->out + at };
    wr_raster_project_row(job->view, mesh->mu + 1, mesh->x + at, mesh->y + at, mesh->z + at, &row);
}

static void bound_row(int by, int worker, void *ctx)
{
    (void)worker;
    MeshJob *job = ctx;
    WrViewMesh *mesh = job->mesh;
    const int pitch = mesh->mu + 1;
    for (int bx = 0; bx < mesh->blocks_u; bx++) {
        WrViewMeshBlock b = { INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN, false };
        int behind = 0;
        for (int y = 0; y <= WR_MESH_BLOCK; y++)
            for (int x = 0; x <= WR_MESH_BLOCK; x++) {
                size_t at = (size_t)(by * WR_MESH_BLOCK + y) * (size_t)pitch +
                            (size_t)(bx * WR_MESH_BLOCK + x);
                if (mesh->out[at] == WR_VERTEX_BEHIND) {
                    behind++;
                    continue;
                }
                b.x0 = mesh->sx[at] < b.x0 ? mesh->sx[at] : b.x0;
                b.x1 = mesh->sx[at] > b.x1 ? mesh->sx[at] : b.x1;
                b.y0 = mesh->sy[at] < b.y0 ? mesh->sy[at] : b.y0;
                b.y1 = mesh->sy[at] > b.y1 ? mesh->sy[at] : b.y1;
            }
        /* A block entirely behind the near plane is empty: no tile overlaps its box. */
        b.clipped = behind > 0 && behind < (WR_MESH_BLOCK + 1) * (WR_MESH_BLOCK + 1);
        mesh->blocks[by * mesh->blocks_u + bx] = b;
    }
}

static void allocate(WrViewMesh *mesh, int mu, int mv)
{
    size_t count = (size_t)(mu + 1) * (size_t)(mv + 1);
    free_points(mesh);
    mesh->mu = mu, mesh->mv = mv;
    mesh->blocks_u = mu / WR_MESH_BLOCK, mesh->blocks_v = mv / WR_MESH_BLOCK;
    mesh->v = wr_alloc((size_t)mv + 1, sizeof *mesh->v);
    mesh->x = wr_alloc(count, sizeof *mesh->x);
    mesh->y = wr_alloc(count, sizeof *mesh->y);
    mesh->z = wr_alloc(count, sizeof *mesh->z);
    mesh->sx = wr_alloc(count, sizeof *mesh->sx);
    mesh->sy = wr_alloc(count, sizeof *mesh->sy);
    mesh->close = wr_alloc(count, sizeof *mesh->close);
    mesh->out = wr_alloc(count, sizeof *mesh->out);
    mesh->blocks = wr_alloc((size_t)(mesh->blocks_u * mesh->blocks_v), sizeof *mesh->blocks);
}

static WrNewton choose_newton(const WrViewMesh *mesh, const WrSurfaceInfo *info, double scale,
                              const WrMeshRequest *ask)
{
    const int enough = mesh->mu < 64 || mesh->mv < 64 ? 3 : 2;
    return (WrNewton){ .reach_u = 1.0f / (float)mesh->mu,
                       .reach_v = 1.0f / (float)mesh->mv,
                       .enough_u = (float)fmin(ask->texels / fmax(ask->table_w, 1e-9), 1.0),
                       .enough_v = (float)fmin(ask->texels / fmax(ask->table_h, 1e-9), 1.0),
                       .uu = (float)(mesh->uu * scale),
                       .uv = (float)(mesh->uv * scale),
                       .vv = (float)(mesh->vv * scale),
                       .closed_u = info->closed_u,
                       .closed_v = info->closed_v,
                       .steps = ask->newton < 0 ? enough : ask->newton };
}

WrViewProjection wr_view_projection(const WrView *view)
{
    return (WrViewProjection){ .eye = view->eye,
                               .right = view->right,
                               .up = view->up,
                               .forward = view->forward,
                               .half_w = view->half_w,
                               .half_h = view->half_h,
                               .near = view->near,
                               .grid_w = view->grid_w,
                               .grid_h = view->grid_h,
                               .perspective = view->perspective };
}

void wr_view_mesh_prepare(WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                          const WrMeshRequest *ask, const WrKernels *kernels, WrPool *pool)
{
    MeshJob job = { mesh, view, kernels };
    int mu, mv;
    measure_bend(mesh, shape);
    choose_cells(mesh, shape, view, ask->mesh, &mu, &mv);
    bool same = mesh->mu == mu && mesh->mv == mv && mesh->kind == shape->kind &&
                memcmp(&mesh->shape, &view->shape, sizeof view->shape) == 0;
    if (!same) {
        allocate(mesh, mu, mv);
        mesh->kind = shape->kind;
        mesh->shape = view->shape;
        place_rows(mesh, shape);
        wr_pool_run(pool, mv + 1, make_row, &job);
    }
    mesh->newton = choose_newton(mesh, wr_surfaces[shape->kind], view->scale, ask);
    const WrViewProjection projection = wr_view_projection(view);
    if (same && memcmp(&mesh->projection, &projection, sizeof projection) == 0) return;
    mesh->projection = projection;
    wr_pool_run(pool, mv + 1, project_row, &job);
    wr_pool_run(pool, mesh->blocks_v, bound_row, &job);
}

bool wr_view_mesh_box(const WrViewMesh *mesh, const WrView *view, const WrDepthTile *tile,
                      double box[4])
{
    const WrRasterBounds bounds = wr_raster_bounds(tile, view->samples);
    box[0] = box[1] = INFINITY;
    box[2] = box[3] = -INFINITY;
    for (int i = 0; i < mesh->blocks_u * mesh->blocks_v; i++) {
        const WrViewMeshBlock *b = &mesh->blocks[i];
        if (!wr_raster_meets(b, &bounds)) continue;
        box[0] = fmin(box[0], b->clipped ? -INFINITY : b->x0 / 256.0);
        box[1] = fmin(box[1], b->clipped ? -INFINITY : b->y0 / 256.0);
        box[2] = fmax(box[2], b->clipped ? INFINITY : b->x1 / 256.0);
        box[3] = fmax(box[3], b->clipped ? INFINITY : b->y1 / 256.0);
    }
    return box[0] <= box[2];
}

static void raster_clipped(const WrViewMesh *mesh, const WrView *view, const int ij[3][2],
                           WrDepthTile *tile)
{
    WrClipVertex corner[3];
    for (int k = 0; k < 3; k++) {
        size_t at = (size_t)ij[k][1] * (size_t)(mesh->mu + 1) + (size_t)ij[k][0];
        corner[k] = wr_raster_camera_vertex(view, (WrVec3){ mesh->x[at], mesh->y[at], mesh->z[at] },
                                            (double)ij[k][0] / mesh->mu, (double)mesh->v[ij[k][1]]);
    }
    wr_raster_clipped(view, corner, tile);
}

/* A block of cells while a tile of samples is drawn. */
typedef struct Block {
    const WrViewMesh *mesh;
    const WrView *view;
    WrRasterBounds bounds; /* of the tile */
    bool culls; /* back faces are detected before vertices are converted to the tile's grid */
    bool mirrored;
    float u[WR_MESH_BLOCK + 1]; /* of the vertices */
    int i0;
} Block;

/* Bits of the sides of the tile that each vertex of a row is outside of; 0 if it has no position. */
static void find_sides(const Block *block, size_t at, unsigned char sides[WR_MESH_BLOCK + 1])
{
    const WrViewMesh *mesh = block->mesh;
    const WrRasterBounds *tile = &block->bounds;
    for (size_t i = 0; i <= WR_MESH_BLOCK; i++) {
        const int64_t x = mesh->sx[at + i], y = mesh->sy[at + i];
        const int beyond =
            (x < tile->x0) | (x > tile->x1) << 1 | (y < tile->y0) << 2 | (y > tile->y1) << 3;
        sides[i] = (unsigned char)(mesh->out[at + i] == WR_VERTEX_BEHIND ? 0 : beyond);
    }
}

static WrRasterVertex vertex_at(const Block *block, size_t at, int i, int j)
{
    const WrViewMesh *mesh = block->mesh;
    return (WrRasterVertex){ mesh->sx[at], mesh->sy[at], mesh->close[at], block->u[i - block->i0],
                             mesh->v[j] };
}

/* True if the triangle faces away or is degenerate, with the same decision as wr_raster_triangle. */
static bool looks_away(const Block *block, size_t a, size_t b, size_t c)
{
    const int32_t *x = block->mesh->sx, *y = block->mesh->sy;
    const int64_t area = ((int64_t)x[b] - x[a]) * ((int64_t)y[c] - y[a]) -
                         ((int64_t)y[b] - y[a]) * ((int64_t)x[c] - x[a]);
    return block->culls && (area == 0 || (area > 0) != block->mirrored);
}

/* Draws a cell whose four vertices are in front of the eye and near the picture. */
static void raster_whole(const Block *block, size_t at, int i, int j, WrDepthTile *tile)
{
    const size_t low = at + (size_t)block->mesh->mu + 1;
    const bool one = !looks_away(block, at, at + 1, low + 1);
    const bool two = !looks_away(block, at, low + 1, low);
    if (!one && !two) return;
    const WrRasterVertex a = vertex_at(block, at, i, j);
    const WrRasterVertex d = vertex_at(block, low + 1, i + 1, j + 1);
    if (one) wr_raster_triangle(block->view, a, vertex_at(block, at + 1, i + 1, j), d, tile);
    if (two) wr_raster_triangle(block->view, a, d, vertex_at(block, low, i, j + 1), tile);
}

static void raster_cell(const Block *block, size_t at, int i, int j, WrDepthTile *tile)
{
    const unsigned char *top = block->mesh->out + at, *low = top + block->mesh->mu + 1;
    if (!(top[0] | top[1] | low[0] | low[1])) {
        raster_whole(block, at, i, j, tile);
        return;
    }
    if (top[0] == WR_VERTEX_BEHIND && top[1] == WR_VERTEX_BEHIND && low[0] == WR_VERTEX_BEHIND &&
        low[1] == WR_VERTEX_BEHIND)
        return;
    const int one[3][2] = { { i, j }, { i + 1, j }, { i + 1, j + 1 } };
    const int two[3][2] = { { i, j }, { i + 1, j + 1 }, { i, j + 1 } };
    raster_clipped(block->mesh, block->view, one, tile);
    raster_clipped(block->mesh, block->view, two, tile);
}

/* Draws the cells of block b that may overlap the tile: those whose corners are not all outside the same side. */
static void raster_block(Block *block, int b, WrDepthTile *tile)
{
    const WrViewMesh *mesh = block->mesh;
    const size_t pitch = (size_t)mesh->mu + 1;
    const int i0 = b % mesh->blocks_u * WR_MESH_BLOCK, j0 = b / mesh->blocks_u * WR_MESH_BLOCK;
    unsigned char sides[2][WR_MESH_BLOCK + 1];
    block->i0 = i0;
    for (int i = 0; i <= WR_MESH_BLOCK; i++) block->u[i] = (float)(i0 + i) / (float)mesh->mu;
    for (int j = 0; j <= WR_MESH_BLOCK; j++) {
        const size_t at = (size_t)(j0 + j) * pitch + (size_t)i0;
        const unsigned char *here = sides[j % 2], *over = sides[(j + 1) % 2];
        find_sides(block, at, sides[j % 2]);
        for (int i = 0; i < WR_MESH_BLOCK && j > 0; i++)
            if (!(over[i] & over[i + 1] & here[i] & here[i + 1]))
                raster_cell(block, at - pitch + (size_t)i, i0 + i, j0 + j - 1, tile);
    }
}

void wr_view_mesh_raster(const WrViewMesh *mesh, const WrView *view, WrDepthTile *tile)
{
    const bool own_grid = tile->k <= 0 || tile->k == view->samples;
    Block block = { .mesh = mesh,
                    .view = view,
                    .bounds = wr_raster_bounds(tile, view->samples),
                    .culls = view->cull && own_grid,
                    .mirrored = view->stretch[0] * view->stretch[1] * view->stretch[2] < 0 };
    for (int i = 0; i < tile->w * tile->h; i++) tile->close[i] = -FLT_MAX;
    for (int b = 0; b < mesh->blocks_u * mesh->blocks_v; b++)
        if (wr_raster_meets(&mesh->blocks[b], &block.bounds)) raster_block(&block, b, tile);
}
