#include "render/tessellation/dice_internal.h"

#include "base/error.h"
#include "field/scheme_list.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/scheme.h"
#include "scene/scene.h"

#include <math.h>

/* ---- points ---- */

static WrVec3 moved(const WrSurfacePoint *at, double f)
{
    return v3_mad(at->p, at->n_unit, f);
}

static void put(WrTriangleCorner *corner, WrVec3 p, double u, double v)
{
    /* + 0 turns -0 into +0, whose bits differ */
    *corner = (WrTriangleCorner){ .p = { (float)p.x + 0.0f, (float)p.y + 0.0f, (float)p.z + 0.0f },
                                  .u = (float)u,
                                  .v = (float)v };
}

/* Position of column x and of row y of the cell: equal numbers from both cells at an edge. */
static double column(const WrDicing *d, const WrDiceCell *c, int x)
{
    const double *u = d->face[c->face].u + c->i;
    return x == c->nu ? u[1] : u[0] + (u[1] - u[0]) * x / c->nu;
}

static double row(const WrDicing *d, const WrDiceCell *c, int y)
{
    const double *v = d->face[c->face].v + c->j;
    return y == c->nv ? v[1] : v[0] + (v[1] - v[0]) * y / c->nv;
}

/* All points of a cell are stored, including those that a coarser edge leaves unused: indices stay regular. */
static void make_points(const WrDicing *d, const WrDiceCell *c)
{
    int32_t at = c->corner;
    for (int y = 0; y <= c->nv; y++, at += c->nu + 1) {
        double u[WR_DICE_MOST_CUTS + 1], v[WR_DICE_MOST_CUTS + 1], f[WR_DICE_MOST_CUTS + 1];
        for (int x = 0; x <= c->nu; x++) u[x] = column(d, c, x), v[x] = row(d, c, y);
        wr_scene_heights(d->scene, d->field, c->nu + 1, u, v, f);
        for (int x = 0; x <= c->nu; x++) {
            WrSurfacePoint p;
            wr_surface_at(&d->scene->shape, c->face, u[x], v[x], &p);
            put(&d->corners[at + x], moved(&p, f[x]), u[x], v[x]);
            d->height[at + x] = (float)f[x];
        }
    }
}

/* The corner in column x and row y; on an edge that is cut less often, the nearest existing one before it. */
static int32_t corner_of(const WrDiceCell *c, int x, int y)
{
    if (y == 0) x -= x % (c->nu / c->edge[0]);
    if (y == c->nv) x -= x % (c->nu / c->edge[1]);
    if (x == 0) y -= y % (c->nv / c->edge[2]);
    if (x == c->nu) y -= y % (c->nv / c->edge[3]);
    return c->corner + y * (c->nu + 1) + x;
}

/* Two triangles per square. Where an edge has fewer cuts, corner_of repeats corners and some triangles are
   degenerate, but no gap opens. */
static void make_triangles(const WrDicing *d, const WrDiceCell *c)
{
    WrTriangle *out = d->triangles + c->triangle;
    for (int y = 0; y < c->nv; y++)
        for (int x = 0; x < c->nu; x++, out += 2) {
            const int32_t a = corner_of(c, x, y), b = corner_of(c, x + 1, y);
            const int32_t e = corner_of(c, x, y + 1), f = corner_of(c, x + 1, y + 1);
            out[0] = (WrTriangle){ { a, b, f } };
            out[1] = (WrTriangle){ { a, f, e } };
        }
}

static void make_cell(int index, int worker, void *ctx)
{
    (void)worker;
    const WrDicing *d = ctx;
    make_points(d, &d->cells[index]);
    make_triangles(d, &d->cells[index]);
}

/* ---- borders of the domain ---- */

static bool ends_at(const WrDicing *d, const WrDiceCell *c, int x, int y)
{
    const WrDiceFace *f = &d->face[c->face];
    return (c->i == 0 && x == 0) || (c->i + 1 == f->nu && x == c->nu) || (c->j == 0 && y == 0) ||
           (c->j + 1 == f->nv && y == c->nv);
}

/* The cell's points on the border; points NULL: only counts them. */
static int32_t find_ends(const WrDicing *d, const WrDiceCell *c, WrDicePoint *points)
{
    const WrDiceFace *face = &d->face[c->face];
    int32_t count = 0;
    if (c->i > 0 && c->j > 0 && c->i + 1 < face->nu && c->j + 1 < face->nv) return 0;
    for (int y = 0; y <= c->nv; y++)
        for (int x = 0; x <= c->nu; x++) {
            if (!ends_at(d, c, x, y)) continue;
            if (points) {
                const int32_t i = c->corner + y * (c->nu + 1) + x;
                WrSurfacePoint at;
                wr_surface_at(&d->scene->shape, c->face, column(d, c, x), row(d, c, y), &at);
                points[count] = wr_dice_point(i, &at, (double)d->height[i], d->size);
            }
            count++;
        }
    return count;
}

/* Moves points that share one position to one common position. */
static void weld(const WrDicing *d, const WrDicePoint *points, int32_t count)
{
    const WrVec3 p = v3_add(points[0].p, wr_dice_move(points, count));
    for (int32_t i = 0; i < count; i++) {
        WrTriangleCorner *corner = &d->corners[points[i].index];
        put(corner, p, (double)corner->u, (double)corner->v);
    }
}

static void weld_all(const WrDicing *d)
{
    int32_t count = 0, at = 0;
    for (int i = 0; i < d->cell_count; i++) count += find_ends(d, &d->cells[i], NULL);
    WrDicePoint *points = wr_alloc((size_t)count, sizeof *points);
    for (int i = 0; i < d->cell_count; i++) at += find_ends(d, &d->cells[i], points + at);
    wr_dice_sort(points, count);
    for (int32_t i = 0, end; i < count; i = end) {
        end = wr_dice_run(points, i, count);
        if (end > i + 1) weld(d, points + i, end - i);
    }
    wr_free(points);
}

/* ---- whole surface ---- */

static bool allocate(WrDicing *d, WrError *err)
{
    const size_t corners = (size_t)d->corner_count, triangles = (size_t)d->triangle_count;
    d->corners = wr_try_alloc(corners, sizeof *d->corners, "a displaced surface", err);
    d->height =
        d->corners ? wr_try_alloc(corners, sizeof *d->height, "a displaced surface", err) : NULL;
    d->triangles = d->height
                       ? wr_try_alloc(triangles, sizeof *d->triangles, "a displaced surface", err)
                       : NULL;
    if (d->triangles) return true;
    wr_free(d->corners);
    return false;
}

static void hand_over(WrDicing *d, WrDice *dice)
{
    WrTriangles *t = wr_alloc(1, sizeof *t);
    *t = (WrTriangles){ .refs = 1,
                        .corners = d->corners,
                        .triangles = d->triangles,
                        .corner_count = (int32_t)d->corner_count,
                        .triangle_count = (int32_t)d->triangle_count,
                        .faceted = true,
                        .mapped = true,
                        .radius = d->size };
    *dice = (WrDice){ .triangles = t, .faces = d->faces, .epsilon = d->epsilon };
    for (int64_t i = 0; i < d->corner_count; i++)
        dice->rise = fmax(dice->rise, (double)fabsf(d->height[i]));
    for (int f = 0; f < d->faces; f++)
        dice->end[f] =
            f + 1 < d->faces ? d->cells[d->face[f + 1].first].triangle : (int32_t)d->triangle_count;
}

static void fini(WrDicing *d)
{
    for (int f = 0; f < d->faces; f++) {
        wr_free(d->face[f].u);
        wr_free(d->face[f].v);
        wr_free(d->face[f].rate);
    }
    wr_free(d->cells);
    wr_free(d->height);
}

bool wr_dice_make(WrDice *dice, const WrScene *scene, const WrField *field, const WrView *view,
                  double epsilon, WrPool *pool, WrError *err)
{
    WrDicing d = { .scene = scene,
                   .field = field,
                   .view = view,
                   .epsilon = epsilon,
                   .size = wr_shape_radius(&scene->shape),
                   .straight =
                       scene->analytic.kind == WR_ANALYTIC_OFF &&
                       (scene->scheme == WR_SCHEME_BILINEAR || scene->scheme == WR_SCHEME_CENTRAL),
                   .faces = wr_surfaces[scene->shape.kind]->faces };
    wr_dice_fini(dice);
    wr_dice_lay(&d, pool);
    wr_dice_choose(&d);
    while (d.triangle_count > WR_DICE_MOST && d.epsilon < 1e30) {
        d.epsilon *= fmax(1.5, 0.5 * (double)d.triangle_count / WR_DICE_MOST);
        wr_dice_choose(&d);
    }
    const bool room = allocate(&d, err);
    if (room) {
        wr_pool_run(pool, d.cell_count, make_cell, &d);
        weld_all(&d);
        hand_over(&d, dice);
    }
    fini(&d);
    return room;
}

void wr_dice_fini(WrDice *dice)
{
    wr_triangles_free(dice->triangles);
    *dice = (WrDice){ 0 };
}
