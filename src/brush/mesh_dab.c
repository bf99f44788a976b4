#include "brush/mesh_dab.h"

#include "base/exactmath.h"
#include "base/memory.h"
#include "brush/paint.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

/* ---- the path ---- */

WrMeshStep wr_mesh_step_first(const WrMeshTexels *mesh, WrVec3 p)
{
    WrMeshStep step = { .spot = wr_mesh_texels_nearest(mesh, p) };
    step.right = wr_mesh_texels_along(mesh, &step.spot);
    return step;
}

/* Turns v as the normal turns from a to b, about their common perpendicular: at an edge of two faces about the
   edge. */
static WrVec3 transported(WrVec3 v, WrVec3 a, WrVec3 b)
{
    const WrVec3 k = v3_cross(a, b);
    const double cosine = v3_dot(a, b);
    if (cosine < -0.999) return v;
    const WrVec3 turned = v3_add(v3_scale(v, cosine), v3_cross(k, v));
    return v3_unit(v3_mad(turned, k, v3_dot(k, v) / (1 + cosine)), v);
}

WrMeshStep wr_mesh_step_next(const WrMeshTexels *mesh, const WrMeshStep *last, WrVec3 p)
{
    WrMeshStep next = { .spot = wr_mesh_texels_nearest(mesh, p) };
    const WrVec3 n = last->spot.n, way = v3_sub(next.spot.p, last->spot.p);
    const WrVec3 flat = v3_unit(v3_mad(way, n, -v3_dot(way, n)), last->right);
    const double length = v3_len(way) / wr_mesh_texel_side(mesh);
    next.x = last->x + length * v3_dot(flat, last->right);
    next.y = last->y - length * v3_dot(flat, v3_cross(n, last->right));
    next.right = transported(last->right, n, next.spot.n);
    return next;
}

/* The surface point at developed coordinates near the present piece: along its chord, and beside it. */
static WrMeshDisc disc_at(const WrDraw *draw, double x, double y)
{
    const WrBrushGround *ground = &draw->cover.maker.ground;
    const WrMeshStep *from = &draw->piece.from, *to = &draw->piece.to;
    const double side = wr_mesh_texel_side(ground->mesh);
    const double dx = to->x - from->x, dy = to->y - from->y, length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? ((x - from->x) * dx + (y - from->y) * dy) / length2 : 1;
    const WrMeshStep *near = t < 0.5 ? from : to;
    const double beside_x = x - from->x - t * dx, beside_y = y - from->y - t * dy;
    const WrVec3 up = v3_cross(near->spot.n, near->right);
    WrVec3 p = v3_mad(from->spot.p, v3_sub(to->spot.p, from->spot.p), t);
    p = v3_mad(v3_mad(p, near->right, side * beside_x), up, -side * beside_y);
    return (WrMeshDisc){ .centre = wr_mesh_texels_nearest(ground->mesh, p),
                         .along = near->right,
                         .clips = ground->clips,
                         .eye = ground->eye };
}

/* ---- texels ---- */

static float height_of(const WrField *field, const WrMeshTexel *at)
{
    return wr_field_get(field, at->x, at->y);
}

static float *texel_of(WrField *field, const WrMeshTexel *at)
{
    return wr_field_tile_write(field, at->x / WR_TILE, at->y / WR_TILE) +
           at->y % WR_TILE * WR_TILE + at->x % WR_TILE;
}

static double cover_at(const WrDabShape *shape, double x, double y)
{
    float fresh[WR_BRUSH_BLOCK];
    wr_shape_row(shape, y, x, WR_BRUSH_BLOCK, fresh);
    return fresh[0];
}

double wr_mesh_height(WrDraw *draw, double x, double y, double radius)
{
    const WrBrushGround *ground = &draw->cover.maker.ground;
    WrMeshDisc disc = disc_at(draw, x, y);
    int count;
    const double r = radius > 1.0 ? radius : 1.0;
    disc.radius = r * wr_mesh_texel_side(ground->mesh);
    const WrMeshTexel *texels = wr_mesh_texels_disc(ground->mesh, &disc, &count);
    double sum = 0, weights = 0;
    for (int i = 0; i < count; i++) {
        const double w = 1 - (texels[i].dx * texels[i].dx + texels[i].dy * texels[i].dy) / (r * r);
        sum += w * height_of(ground->field, &texels[i]);
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

/* ---- moving dabs ---- */

/* Heights of the disc on a grid of its plane, one texel apart, on which moving modes work. */
typedef struct Grid {
    WrMoveBox box;
    float *before, *known; /* [side * side] heights before; 0: no texel is near */
    int side, half;
} Grid;

static void splat(Grid *grid, const WrField *field, const WrMeshTexel *texels, int count)
{
    const int side = grid->side;
    for (int i = 0; i < count; i++) {
        const double x = grid->half + texels[i].dx, y = grid->half + texels[i].dy;
        const int cx = (int)floor(x), cy = (int)floor(y);
        const float h = height_of(field, &texels[i]);
        for (int k = 0; k < 4; k++) {
            const int gx = cx + k % 2, gy = cy + k / 2;
            const double w = (1 - fabs(x - gx)) * (1 - fabs(y - gy));
            if (gx < 0 || gy < 0 || gx >= side || gy >= side || !(w > 0)) continue;
            const size_t at = (size_t)gy * (size_t)grid->box.pitch + (size_t)gx;
            grid->before[at] += (float)w * h;
            grid->known[at] += (float)w;
        }
    }
    const size_t all = (size_t)grid->box.pitch * (size_t)side;
    for (size_t i = 0; i < all; i++)
        if (grid->known[i] > 0) grid->before[i] /= grid->known[i];
}

/* Closes holes where the table's texels are farther apart than the grid's, ring by ring: the mean of known
   neighbours. */
static void fill(Grid *grid, int rings)
{
    const int side = grid->side, pitch = grid->box.pitch;
    for (int ring = 1; ring <= rings; ring++)
        for (int i = 0; i < side * side; i++) {
            const int x = i % side, y = i / side;
            double sum = 0, count = 0;
            if (grid->known[y * pitch + x] != 0) continue;
            for (int k = 0; k < 9; k++) {
                const int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
                if (nx < 0 || ny < 0 || nx >= side || ny >= side) continue;
                const float known = grid->known[ny * pitch + nx];
                if (!(known > 0) && !(known < 0 && known > (float)-ring)) continue;
                sum += grid->before[ny * pitch + nx], count++;
            }
            if (count == 0) continue;
            grid->before[y * pitch + x] = (float)(sum / count);
            grid->known[y * pitch + x] = (float)-ring;
        }
}

/* Points that are still unknown, as beyond open edges, take the nearest known value of their row, or the row beside: modes
   read them, but do not move them. */
static void extend(Grid *grid)
{
    const int side = grid->side, pitch = grid->box.pitch;
    for (int y = 0; y < side; y++)
        for (int pass = 0; pass < 2; pass++) {
            float *row = grid->before + (size_t)y * (size_t)pitch;
            float *known = grid->known + (size_t)y * (size_t)pitch;
            for (int k = 1; k < side; k++) {
                const int x = pass ? side - 1 - k : k, from = pass ? x + 1 : x - 1;
                if (known[x] == 0 && known[from] != 0) row[x] = row[from], known[x] = -1;
            }
        }
    for (int pass = 0; pass < 2; pass++)
        for (int k = 1; k < side; k++) {
            const int y = pass ? side - 1 - k : k, from = pass ? y + 1 : y - 1;
            const size_t to = (size_t)y * (size_t)pitch, at = (size_t)from * (size_t)pitch;
            if (grid->known[to] != 0 || grid->known[at] == 0) continue;
            memcpy(grid->before + to, grid->before + at, (size_t)side * sizeof(float));
            grid->known[to] = -1;
        }
}

static double sample(const Grid *grid, const float *from, double x, double y)
{
    const double gx = fmin(fmax(grid->half + x, 0), grid->side - 1.001);
    const double gy = fmin(fmax(grid->half + y, 0), grid->side - 1.001);
    const int cx = (int)gx, cy = (int)gy;
    const float *at = from + (size_t)cy * (size_t)grid->box.pitch + (size_t)cx;
    const double fx = gx - cx, fy = gy - cy, upper = at[0] * (1 - fx) + at[1] * fx;
    at += grid->box.pitch;
    return upper * (1 - fy) + (at[0] * (1 - fx) + at[1] * fx) * fy;
}

/* Lays out the grid in the mover's memory; false: no memory. */
static bool grid_new(WrDraw *draw, const WrDabShape *shape, int half, Grid *grid)
{
    grid->half = half, grid->side = 2 * half + 1;
    const int pitch = (grid->side + WR_BRUSH_BLOCK - 1) / WR_BRUSH_BLOCK * WR_BRUSH_BLOCK;
    const size_t all = (size_t)pitch * (size_t)grid->side;
    const size_t spare = 6 * ((size_t)pitch + 2 * WR_REACH_MAX);
    float *memory = wr_mover_reserve(&draw->mover, 5 * all + spare);
    if (!memory) return false;
    memset(memory, 0, 5 * all * sizeof *memory);
    grid->box.width = grid->box.height = grid->side;
    grid->box.pitch = pitch;
    grid->box.x = grid->box.y = half;
    grid->box.reach = (int)draw->cover.maker.brush.reach;
    grid->box.kernels = shape->kernels;
    grid->before = memory, grid->known = memory + all;
    grid->box.weights = memory + 2 * all;
    grid->box.heights = memory + 3 * all, grid->box.fresh = memory + 4 * all;
    grid->box.spare = memory + 5 * all;
    return true;
}

static bool move_grid(WrDraw *draw, const WrDab *dab, const WrDabShape *shape,
                      const WrMeshTexel *texels, int count, int half, Grid *grid)
{
    const WrStrokeResolver *maker = &draw->cover.maker;
    if (!grid_new(draw, shape, half, grid)) return false;
    grid->box.dx = dab->dx, grid->box.dy = dab->dy, grid->box.radius = dab->radius;
    splat(grid, maker->ground.field, texels, count);
    fill(grid, 2);
    float *weights = grid->known + (size_t)grid->box.pitch * (size_t)grid->side;
    for (int i = 0; i < grid->side * grid->side; i++) {
        const int at = i / grid->side * grid->box.pitch + i % grid->side;
        const double w = cover_at(shape, i % grid->side - half, i / grid->side - half);
        if (grid->known[at] != 0) weights[at] = (float)(w * maker->brush.opacity);
    }
    extend(grid);
    memcpy(grid->box.heights, grid->before,
           (size_t)grid->box.pitch * (size_t)grid->side * sizeof(float));
    maker->work->move(&grid->box);
    return true;
}

/* A covering mode's result for coverage 1. */
static double covered(WrDraw *draw, const WrMeshTexel *at, float f)
{
    const WrStrokeResolver *maker = &draw->cover.maker;
    float start[WR_BRUSH_BLOCK] = { f }, ones[WR_BRUSH_BLOCK] = { 1 }, out[WR_BRUSH_BLOCK];
    float target[WR_BRUSH_BLOCK] = { 0 };
    const float *tile = wr_coverage_target(&draw->cover, at->x / WR_TILE, at->y / WR_TILE);
    if (tile) target[0] = tile[at->y % WR_TILE * WR_TILE + at->x % WR_TILE];
    maker->work->cover(&maker->args, start, ones, target, WR_BRUSH_BLOCK, out);
    return out[0];
}

static double selected(const WrBrushGround *ground, const WrMeshTexel *at)
{
    const double s = ground->selection ? wr_field_get(ground->selection, at->x, at->y) : 1;
    return s > 0 ? fmin(s, 1) : 0;
}

/* The grid's change moves each texel; a texel's own detail, which the grid does not resolve, fades by its weight. */
static void move(WrDraw *draw, const WrDab *dab, const WrDabShape *shape, const WrMeshTexel *texels,
                 int count, int half)
{
    const WrStrokeResolver *maker = &draw->cover.maker;
    Grid grid = { .half = 0 };
    if (maker->work->move && !move_grid(draw, dab, shape, texels, count, half, &grid)) return;
    for (int i = 0; i < count; i++) {
        const WrMeshTexel *at = &texels[i];
        const double part = at->weight * selected(&maker->ground, at);
        const double w = cover_at(shape, at->dx, at->dy) * maker->brush.opacity;
        if (!(w * part > 0)) continue;
        float *height = texel_of(maker->ground.field, at);
        const double f = *height;
        double made;
        if (maker->work->move)
            made = sample(&grid, grid.box.heights, at->dx, at->dy) +
                   (1 - w) * (f - sample(&grid, grid.before, at->dx, at->dy));
        else made = f * (1 - w) + covered(draw, at, *height) * w;
        if (dab->drag > 0 && isfinite(dab->dragged)) {
            const double drag = fmin(dab->drag, 1);
            made = f + w * drag * (dab->dragged - f) + (1 - drag) * (made - f);
        }
        *height = wr_finite_float(f + part * (made - f));
        const float weight = (float)(w * part);
        if (maker->ground.mark)
            wr_move_write_mark(maker, &weight, 1, texel_of(maker->ground.mark, at));
    }
}

/* ---- modes that look around ---- */

/* Texels beside a dab that the targets of sharpen, dilate and erode read. */
static int looks_around(const WrStrokeResolver *maker)
{
    const WrBlendTargetKind kind = maker->targets.kind;
    const bool does = kind == WR_BLEND_TARGET_SHARP || kind == WR_BLEND_TARGET_LARGEST ||
                      kind == WR_BLEND_TARGET_SMALLEST;
    return does ? maker->targets.reach : 0;
}

/* The grid's heights become the targets there. */
static void target_grid(const WrStrokeResolver *maker, Grid *grid)
{
    float tile[WR_TILE * WR_TILE];
    const int side = grid->side;
    WrTargets targets = maker->targets;
    WrField *field = wr_field_new(side, side, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    for (int i = 0; i < side * side; i++)
        wr_field_tile_write(field, i % side / WR_TILE,
                            i / side / WR_TILE)[i / side % WR_TILE * WR_TILE + i % side % WR_TILE] =
            grid->before[i / side * grid->box.pitch + i % side];
    targets.start = field;
    for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++) {
            wr_targets_compute_tile(&targets, tx, ty, tile);
            for (int k = 0; k < WR_TILE * WR_TILE; k++) {
                const int x = tx * WR_TILE + k % WR_TILE, y = ty * WR_TILE + k / WR_TILE;
                if (x < side && y < side) grid->box.heights[y * grid->box.pitch + x] = tile[k];
            }
        }
    wr_field_free(field);
}

/* Blend targets from a grid on the surface, for dabs that reach over a seam of the table. The grid is coarser than the
   texels: so a largest height is never below the texel's own, a smallest one never above it. */
static void set_targets(WrDraw *draw, const WrDabShape *shape, const WrMeshTexel *texels, int count,
                        int half)
{
    const WrStrokeResolver *maker = &draw->cover.maker;
    const WrBlendTargetKind kind = maker->targets.kind;
    Grid grid;
    if (!grid_new(draw, shape, half, &grid)) return;
    splat(&grid, maker->start, texels, count);
    fill(&grid, 2);
    extend(&grid);
    target_grid(maker, &grid);
    for (int i = 0; i < count; i++) {
        const WrMeshTexel *at = &texels[i];
        const double f = height_of(maker->start, at);
        double target = sample(&grid, grid.box.heights, at->dx, at->dy);
        if (!(at->weight * cover_at(shape, at->dx, at->dy) > 0)) continue;
        if (kind == WR_BLEND_TARGET_LARGEST) target = fmax(target, f);
        else if (kind == WR_BLEND_TARGET_SMALLEST) target = fmin(target, f);
        else target += f - sample(&grid, grid.before, at->dx, at->dy);
        wr_coverage_set_target(&draw->cover, at->x, at->y, wr_finite_float(target));
    }
}

/* ---- dabs ---- */

static WrVec3 reflected(WrVec3 v, unsigned axes)
{
    return (WrVec3){ axes & 1 ? -v.x : v.x, axes & 2 ? -v.y : v.y, axes & 4 ? -v.z : v.z };
}

/* Sets *out to the disc in the mirrors across these axes. False: the mesh is not there, it has no such symmetry. */
static bool mirror_disc(const WrBrushGround *ground, const WrMeshDisc *disc, unsigned axes,
                        WrMeshDisc *out)
{
    const WrVec3 at = ground->mirror_at;
    const WrVec3 p = v3_add(at, reflected(v3_sub(disc->centre.p, at), axes));
    *out = *disc;
    out->centre = wr_mesh_texels_nearest(ground->mesh, p);
    out->along = reflected(disc->along, axes);
    out->eye = v3_add(at, reflected(v3_sub(disc->eye, at), axes));
    out->mirrored = __builtin_popcount(axes) % 2 == 1;
    return v3_len(v3_sub(out->centre.p, p)) < disc->radius;
}

static void lay_disc(WrDraw *draw, const WrDab *dab, const WrDabShape *shape,
                     const WrMeshDisc *disc)
{
    int count;
    const WrMeshTexel *texels = wr_mesh_texels_disc(draw->cover.maker.ground.mesh, disc, &count);
    double most = 0; /* the mesh may be smaller than the dab */
    for (int i = 0; i < count; i++) most = fmax(most, fmax(fabs(texels[i].dx), fabs(texels[i].dy)));
    const int half = (int)ceil(most) + 2;
    if (draw->moves) {
        move(draw, dab, shape, texels, count, half);
        return;
    }
    if (looks_around(&draw->cover.maker) && wr_mesh_texels_crossed(draw->cover.maker.ground.mesh))
        set_targets(draw, shape, texels, count, half);
    for (int i = 0; i < count; i++) {
        const double c = texels[i].weight * cover_at(shape, texels[i].dx, texels[i].dy);
        if (c > 0) wr_coverage_add_texel(&draw->cover, texels[i].x, texels[i].y, (float)c);
    }
}

void wr_mesh_dab(WrDraw *draw, const WrDab *dab)
{
    static const WrCopy same = { .a = 1, .d = 1 };
    const WrStrokeResolver *maker = &draw->cover.maker;
    WrMeshTexels *mesh = maker->ground.mesh;
    WrDab local = *dab;
    WrDabShape shape;
    local.x = local.y = 0;
    local.radius = fmax(dab->radius, 1); /* single texels have no size on a surface */
    if (!wr_shape_of_dab(maker->ground.field, maker->brush.tip, &local, &same, &shape)) return;
    const double reach =
        shape.kind == WR_SHAPE_TIP ? wr_hypot(shape.reach_x, shape.reach_y) : local.radius;
    const WrMoveMargin margin = draw->moves ? maker->work->margin : NULL;
    const double beside = margin        ? margin(local.radius, dab->dx, dab->dy)
                          : draw->moves ? 1
                                        : looks_around(maker);
    WrMeshDisc disc = disc_at(draw, dab->x, dab->y), mirrored;
    disc.radius = (reach + beside) * wr_mesh_texel_side(mesh);
    lay_disc(draw, &local, &shape, &disc);
    for (unsigned axes = 1; axes <= maker->ground.mirrors; axes++)
        if ((axes & ~maker->ground.mirrors) == 0 &&
            mirror_disc(&maker->ground, &disc, axes, &mirrored))
            lay_disc(draw, &local, &shape, &mirrored);
}
