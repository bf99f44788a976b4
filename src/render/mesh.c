#include "render/mesh.h"

#include "base/memory.h"
#include "base/pool.h"
#include "render/raster.h"
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

/* Samples that one kernel unit of length may cover, at the nearest point of the object. */
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

/* The smallest of these that is enough: a few fixed sizes, so that a moving view seldom changes them. Not
   fewer than 16, of which a round outline keeps 0.97 of its area however small it is (HC86). */
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

/* Largest |Puu|, |Puv|, |Pvv| over the surface (sampled), in object units; kept while the shape stays. */
static void measure_bend(WrViewMesh *mesh, const WrShape *shape)
{
    if (mesh->measured && memcmp(&mesh->source, shape, sizeof *shape) == 0) return;
    mesh->uu = mesh->uv = mesh->vv = 0;
    const int across = 16,
              up = shape->data ? 128 : 16; /* a curve of the user's own may bend in short pieces */
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

/* A cell's chord is off by at most (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8 (Taylor). */
static void choose_cells(const WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                         int finer, int *mu, int *mv)
{
    const double tolerance = 0.25 * view->samples; /* a quarter of a pixel, in samples */
    double k = view->scale * samples_per_unit(view, shape) / (8.0 * tolerance);
    const int most = 2048; /* a ribbon of sixty turns takes 1500 along it (HC164) ... */
    double u = fmin(sqrt(2.0 * k * (mesh->uu + mesh->uv)), most);
    double v = fmin(sqrt(2.0 * k * (mesh->vv + mesh->uv)), most);
    const double over = fmax(1.0, sqrt(u * v / (512.0 * 512.0))); /* ... but not both ways */
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

/* Rows lie evenly; the one next to a corner lies on it, else cells would cut it off. */
static void place_rows(WrViewMesh *mesh, const WrShape *shape)
{
    double corner[WR_MESH_CORNERS];
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const int corners = info->corners ? info->corners(shape, corner, WR_MESH_CORNERS) : 0;
    for (int j = 0; j <= mesh->mv; j++) mesh->v[j] = (float)j / (float)mesh->mv;
    for (int k = 0, last = 0; k < corners; k++) {
        int j = (int)(corner[k] * mesh->mv + 0.5);
        j = j > last ? j : last + 1; /* two corners, one row: the next one moves */
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
    const size_t row = (size_t)j * (size_t)(mesh->mu + 1);
    for (int i = 0; i <= mesh->mu; i++) {
        size_t at = row + (size_t)i;
        WrVec3 p = { mesh->x[at], mesh->y[at], mesh->z[at] };
        WrRasterVertex vertex;
        mesh->out[at] = WR_VERTEX_IN;
        if (!wr_raster_project(job->view, p, 0, 0, &vertex))
            mesh->out[at] = wr_raster_bound(job->view, p, &vertex.x, &vertex.y) ? WR_VERTEX_OUT
                                                                                : WR_VERTEX_BEHIND;
        mesh->sx[at] = vertex.x;
        mesh->sy[at] = vertex.y;
        mesh->close[at] = vertex.close;
    }
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
        /* Of a block wholly behind nothing is left: no tile meets its box. */
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
                              const WrMeshAsk *ask)
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

WrViewSight wr_view_sight(const WrView *view)
{
    return (WrViewSight){ .eye = view->eye,
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
                          const WrMeshAsk *ask, const WrKernels *kernels, WrPool *pool)
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
    const WrViewSight sight = wr_view_sight(view);
    if (same && memcmp(&mesh->sight, &sight, sizeof sight) == 0) return;
    mesh->sight = sight;
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

static WrRasterVertex vertex_at(const WrViewMesh *mesh, int i, int j)
{
    size_t at = (size_t)j * (size_t)(mesh->mu + 1) + (size_t)i;
    return (WrRasterVertex){ mesh->sx[at], mesh->sy[at], mesh->close[at],
                             (float)i / (float)mesh->mu, mesh->v[j] };
}

static void raster_clipped(const WrViewMesh *mesh, const WrView *view, const int ij[3][2],
                           WrDepthTile *tile)
{
    WrClipVertex corner[3];
    for (int k = 0; k < 3; k++) {
        size_t at = (size_t)ij[k][1] * (size_t)(mesh->mu + 1) + (size_t)ij[k][0];
        corner[k] = wr_raster_clip_vertex(view, (WrVec3){ mesh->x[at], mesh->y[at], mesh->z[at] },
                                          (double)ij[k][0] / mesh->mu, (double)mesh->v[ij[k][1]]);
    }
    wr_raster_clipped(view, corner, tile);
}

/* Do all four corners lie beyond the same side of the tile? */
static bool cell_misses(const int32_t *top, const int32_t *low, int64_t from, int64_t to)
{
    const int64_t a = top[0], b = top[1], c = low[0], d = low[1];
    return (a < from && b < from && c < from && d < from) || (a > to && b > to && c > to && d > to);
}

static void raster_cell(const WrViewMesh *mesh, const WrView *view, const WrRasterBounds *bounds,
                        int i, int j, WrDepthTile *tile)
{
    size_t at = (size_t)j * (size_t)(mesh->mu + 1) + (size_t)i, next = at + (size_t)mesh->mu + 1;
    const unsigned char *top = mesh->out + at, *low = mesh->out + next;
    const bool out = top[0] | top[1] | low[0] | low[1];
    const int behind = (top[0] == WR_VERTEX_BEHIND) + (top[1] == WR_VERTEX_BEHIND) +
                       (low[0] == WR_VERTEX_BEHIND) + (low[1] == WR_VERTEX_BEHIND);
    if (behind == 4) return;
    if (behind == 0 && (cell_misses(mesh->sy + at, mesh->sy + next, bounds->y0, bounds->y1) ||
                        cell_misses(mesh->sx + at, mesh->sx + next, bounds->x0, bounds->x1)))
        return;
    if (out) {
        raster_clipped(mesh, view, (const int[3][2]){ { i, j }, { i + 1, j }, { i + 1, j + 1 } },
                       tile);
        raster_clipped(mesh, view, (const int[3][2]){ { i, j }, { i + 1, j + 1 }, { i, j + 1 } },
                       tile);
        return;
    }
    WrRasterVertex a = vertex_at(mesh, i, j), b = vertex_at(mesh, i + 1, j);
    WrRasterVertex c = vertex_at(mesh, i, j + 1), d = vertex_at(mesh, i + 1, j + 1);
    wr_raster_triangle(view, a, b, d, tile);
    wr_raster_triangle(view, a, d, c, tile);
}

void wr_view_mesh_raster(const WrViewMesh *mesh, const WrView *view, WrDepthTile *tile)
{
    const WrRasterBounds bounds = wr_raster_bounds(tile, view->samples);
    for (int i = 0; i < tile->w * tile->h; i++) tile->close[i] = -FLT_MAX;
    for (int b = 0; b < mesh->blocks_u * mesh->blocks_v; b++) {
        if (!wr_raster_meets(&mesh->blocks[b], &bounds)) continue;
        int i0 = b % mesh->blocks_u * WR_MESH_BLOCK, j0 = b / mesh->blocks_u * WR_MESH_BLOCK;
        for (int j = j0; j < j0 + WR_MESH_BLOCK; j++)
            for (int i = i0; i < i0 + WR_MESH_BLOCK; i++)
                raster_cell(mesh, view, &bounds, i, j, tile);
    }
}
