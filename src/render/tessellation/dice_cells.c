/* Subdivision of a displaced surface: lines on texels, cells between them, and the number of cuts of each cell. */
#include "render/tessellation/dice_internal.h"

#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define CELLS 64     /* approximate number of cells along a face */
#define SMOOTH 256.0 /* number of texels assumed for a formula */
#define SHARE 0.4    /* of epsilon, for each source of a facet's error */

/* ---- lines ---- */

/* Number of texels along a whole axis of the domain. */
static double texels_along(const WrDicing *d, bool along_u)
{
    const WrScene *s = d->scene;
    const double r = fabs(along_u ? s->replicate_u : s->replicate_v);
    if (s->analytic.kind != WR_ANALYTIC_OFF) return fmin(SMOOTH * fmax(r, 1), 1e9);
    return r * (along_u ? wr_field_width(d->field) : wr_field_height(d->field));
}

/* Texels per cell: a power of two. */
static int block_of(double texels)
{
    int block = 1;
    while (block < 1 << 20 && texels / block > CELLS) block *= 2;
    return block;
}

/* Lines through texel centres, symmetric from both ends: blocks of `block` texels, and single texels where the
   two halves do not meet in the middle. */
static int lay_middles(int texels, int block, double *line)
{
    int count = 0;
    const int half = (texels - 1) / 2 / block; /* blocks from each end */
    const int between = texels - 1 - 2 * half * block;
    line[count++] = 0;
    for (int k = 0; k <= half; k++) line[count++] = (0.5 + k * block) / texels;
    for (int k = 1; k <= between; k++) line[count++] = (0.5 + half * block + k) / texels;
    for (int k = 1; k <= half; k++)
        line[count++] = (0.5 + half * block + between + k * block) / texels;
    line[count++] = 1;
    return count - 1;
}

/* The lines of one axis between low and high; returns the number of cells between them. */
static int lay_axis(double texels, bool whole, double low, double high, double **lines)
{
    const int block = block_of(texels);
    const int even = (int)fmin(4 * CELLS, fmax(8, ceil(texels / block)));
    double *line = wr_alloc((size_t)(4 * CELLS + 4 * block + 64), sizeof *line);
    int count = even;
    if (whole && texels < 4 * CELLS * (double)block && block <= WR_DICE_SIDE)
        count = lay_middles((int)texels, block, line);
    else
        for (int k = 0; k <= even; k++) line[k] = (double)k / even;
    for (int k = 0; k <= count; k++) line[k] = k == count ? high : low + (high - low) * line[k];
    *lines = line;
    return count;
}

static bool is_whole(double texels)
{
    return texels >= 1 && texels == floor(texels);
}

/* Faces that meet have the same lines along both axes, so that they have the same points where they meet. */
static void lay_face(WrDicing *d, int face)
{
    WrDiceFace *f = &d->face[face];
    const WrSurfaceCell c = wr_surface_cell(&d->scene->shape, face);
    double wide = texels_along(d, true) * (c.u1 - c.u0);
    double high = texels_along(d, false) * (c.v1 - c.v0);
    const bool own = c.u1 - c.u0 == 1 && c.v1 - c.v0 == 1 && (d->faces == 1 || wide == high) &&
                     d->scene->analytic.kind == WR_ANALYTIC_OFF;
    const bool whole_u = own && is_whole(wide), whole_v = own && is_whole(high);
    if (d->faces > 1) wide = high = fmax(wide, high);
    f->nu = lay_axis(wide, whole_u, c.u0, c.u1, &f->u);
    f->nv = lay_axis(high, whole_v, c.v0, c.v1, &f->v);
    f->aligned =
        whole_u && whole_v && block_of(wide) <= WR_DICE_SIDE && block_of(high) <= WR_DICE_SIDE;
    f->rate = wr_alloc((size_t)(f->nu + 1) * (size_t)(f->nv + 1), 2 * sizeof *f->rate);
}

/* ---- needs of a cell ---- */

static int steps_of(double width, double texels)
{
    int steps = 1;
    while (steps < WR_DICE_SIDE && steps < width * texels * (1 - 1e-9)) steps *= 2;
    return steps;
}

typedef struct Heights {
    double f[WR_DICE_SIDE + 1][WR_DICE_SIDE + 1];
} Heights;

static void measure_heights(const WrDicing *d, WrDiceCell *c, Heights *h)
{
    const WrDiceFace *face = &d->face[c->face];
    const double u0 = face->u[c->i], v0 = face->v[c->j];
    const double du = face->u[c->i + 1] - u0, dv = face->v[c->j + 1] - v0;
    c->steps_u = steps_of(du, texels_along(d, true));
    c->steps_v = steps_of(dv, texels_along(d, false));
    for (int y = 0; y <= c->steps_v; y++) {
        double u[WR_DICE_SIDE + 1], v[WR_DICE_SIDE + 1];
        for (int x = 0; x <= c->steps_u; x++)
            u[x] = u0 + du * x / c->steps_u, v[x] = v0 + dv * y / c->steps_v;
        wr_scene_heights(d->scene, d->field, c->steps_u + 1, u, v, h->f[y]);
    }
}

/* Differences of F between the steps: the largest first differences along u and v, second differences, and the
   largest |F|. */
static void differ(WrDiceCell *c, const Heights *h, double *slope_u, double *slope_v, double *most)
{
    double low = INFINITY, high = -INFINITY;
    for (int y = 0; y <= c->steps_v; y++)
        for (int x = 0; x <= c->steps_u; x++) {
            const double f = h->f[y][x];
            low = fmin(low, f), high = fmax(high, f);
            if (x > 0) *slope_u = fmax(*slope_u, fabs(f - h->f[y][x - 1]));
            if (y > 0) *slope_v = fmax(*slope_v, fabs(f - h->f[y - 1][x]));
            if (x > 1) c->kink_u = fmax(c->kink_u, fabs(f - 2 * h->f[y][x - 1] + h->f[y][x - 2]));
            if (y > 1) c->kink_v = fmax(c->kink_v, fabs(f - 2 * h->f[y - 1][x] + h->f[y - 2][x]));
            if (x > 0 && y > 0)
                c->twist =
                    fmax(c->twist, fabs(f - h->f[y][x - 1] - h->f[y - 1][x] + h->f[y - 1][x - 1]));
        }
    c->range = high - low;
    *most = fmax(fabs(low), fabs(high));
}

/* Pixels per object unit at the nearest point of a sphere around p; 0: it is outside the picture. */
static double pixels_at(const WrView *view, WrVec3 p, double radius)
{
    const double k = view->scale, per = view->grid_h / (2.0 * view->half_h) / view->samples * k;
    const WrVec3 w = v3_sub(v3_scale(p, k), view->eye);
    const double x = fabs(v3_dot(w, view->right)), y = fabs(v3_dot(w, view->up));
    const double z = v3_dot(w, view->forward), r = radius * k;
    if (!view->perspective) return x > view->half_w + r || y > view->half_h + r ? 0 : per;
    const double aside = sqrt(1 + view->half_w * view->half_w);
    const double above = sqrt(1 + view->half_h * view->half_h);
    if (z < -r || x > z * view->half_w + r * aside || y > z * view->half_h + r * above) return 0;
    return per / fmax(z - r, 0.01 * view->radius);
}

/* Curvature of the base over the cell, and its position on screen. slope_*: over a step; most: of |F|. */
static void measure_base(const WrDicing *d, WrDiceCell *c, double slope_u, double slope_v,
                         double most)
{
    const WrDiceFace *face = &d->face[c->face];
    const double du = face->u[c->i + 1] - face->u[c->i], dv = face->v[c->j + 1] - face->v[c->j];
    WrSurfacePoint at[5];
    double radius = 0;
    for (int k = 0; k < 5; k++) {
        const double x = k == 4 ? 0.5 : k & 1, y = k == 4 ? 0.5 : k >> 1;
        wr_surface_at(&d->scene->shape, c->face, face->u[c->i] + x * du, face->v[c->j] + y * dv,
                      &at[k]);
    }
    double uu = 0, vv = 0;
    const double fu = slope_u * c->steps_u / du, fv = slope_v * c->steps_v / dv;
    for (int k = 0; k < 5; k++) {
        const double turn_u = v3_len(at[k].n_u), turn_v = v3_len(at[k].n_v);
        const double nuu = v3_len(v3_sub(at[1].n_u, at[0].n_u)) / du + turn_u * turn_u;
        const double nvv = v3_len(v3_sub(at[2].n_v, at[0].n_v)) / dv + turn_v * turn_v;
        uu = fmax(uu, v3_len(at[k].puu) + 2 * fu * turn_u + most * nuu);
        vv = fmax(vv, v3_len(at[k].pvv) + 2 * fv * turn_v + most * nvv);
        radius = fmax(radius, v3_len(v3_sub(at[k].p, at[4].p)));
    }
    c->bend_u = uu * du * du / 8;
    c->bend_v = vv * dv * dv / 8;
    c->pixels = pixels_at(d->view, at[4].p, 1.5 * radius + most);
}

static void measure_cell(int index, int worker, void *ctx)
{
    (void)worker;
    const WrDicing *d = ctx;
    WrDiceCell *c = &d->cells[index];
    Heights h;
    double slope_u = 0, slope_v = 0, most = 0;
    measure_heights(d, c, &h);
    differ(c, &h, &slope_u, &slope_v, &most);
    measure_base(d, c, slope_u, slope_v, most);
}

void wr_dice_lay(WrDicing *d, WrPool *pool)
{
    for (int f = 0; f < d->faces; f++) {
        lay_face(d, f);
        d->face[f].first = d->cell_count;
        d->cell_count += d->face[f].nu * d->face[f].nv;
    }
    d->cells = wr_alloc((size_t)d->cell_count, sizeof *d->cells);
    for (int f = 0, at = 0; f < d->faces; f++)
        for (int k = 0; k < d->face[f].nu * d->face[f].nv; k++)
            d->cells[at++] =
                (WrDiceCell){ .face = f, .i = k % d->face[f].nu, .j = k / d->face[f].nu };
    wr_pool_run(pool, d->cell_count, measure_cell, d);
}

/* ---- number of cuts ---- */

/* Steps across a cell along one axis. per: pixels per unit, divided by epsilon's share. */
static double steps_for(const WrDicing *d, const WrDiceCell *c, double bend, double kink, int steps)
{
    const double per = c->pixels / (SHARE * d->epsilon);
    const double base = sqrt(bend * per);
    if (c->range * per <= 1) return base;
    double own = steps * sqrt(kink * per / 8);
    if (d->straight && d->face[c->face].aligned) own = fmin(own, steps);
    return fmax(fmax(base, own), steps * sqrt(c->twist * per / 4));
}

static void raise_to(double *rate, double want)
{
    *rate = fmax(*rate, fmin(want, 1e9)); /* NaN is ignored */
}

/* Share of the face's lines in cell i. Faces with different cells of the table count equally where they meet. */
static double share_of(const double *line, int count, int i)
{
    return (line[i + 1] - line[i]) / (line[count] - line[0]);
}

/* Raises the rates at the cell's corners to the cell's needs. */
static void ask_corners(const WrDicing *d, const WrDiceCell *c)
{
    const WrDiceFace *f = &d->face[c->face];
    const double u = steps_for(d, c, c->bend_u, c->kink_u, c->steps_u);
    const double v = steps_for(d, c, c->bend_v, c->kink_v, c->steps_v);
    for (int k = 0; k < 4; k++) {
        double *rate = f->rate + 2 * ((c->j + (k >> 1)) * (f->nu + 1) + c->i + (k & 1));
        raise_to(&rate[0], u / share_of(f->u, f->nu, c->i));
        raise_to(&rate[1], v / share_of(f->v, f->nv, c->j));
    }
}

/* Number of border corner k, of 2 (nu + nv), of the face. */
static int border_corner(const WrDiceFace *f, int k)
{
    const int row = f->nu + 1;
    if (k < row) return k;
    if (k < 2 * row) return f->nv * row + k - row;
    const int left = k - 2 * row;
    return left < f->nv - 1 ? (left + 1) * row : (left - (f->nv - 1) + 1) * row + f->nu;
}

/* Gives corners at one position equal rates: along a seam for each axis, along the edges of a cube for both. */
static void join_corners(WrDicing *d)
{
    int32_t count = 0;
    for (int f = 0; f < d->faces; f++) count += 2 * (d->face[f].nu + d->face[f].nv);
    WrDicePoint *points = wr_alloc((size_t)count, sizeof *points);
    double **rate = wr_alloc((size_t)count, sizeof *rate);
    int32_t at = 0;
    for (int face = 0; face < d->faces; face++) {
        const WrDiceFace *f = &d->face[face];
        for (int k = 0; k < 2 * (f->nu + f->nv); k++) {
            WrSurfacePoint p;
            const int corner = border_corner(f, k);
            wr_surface_at(&d->scene->shape, face, f->u[corner % (f->nu + 1)],
                          f->v[corner / (f->nu + 1)], &p);
            rate[at] = f->rate + 2 * corner;
            points[at] = wr_dice_point(at, &p, 0, d->size);
            at++;
        }
    }
    wr_dice_sort(points, count);
    for (int32_t i = 0, end; i < count; i = end) {
        double most[2] = { 0, 0 };
        end = wr_dice_run(points, i, count);
        for (int32_t k = i; k < end; k++)
            for (int c = 0; c < 2; c++) most[c] = fmax(most[c], rate[points[k].index][c]);
        if (d->faces > 1) most[0] = most[1] = fmax(most[0], most[1]);
        for (int32_t k = i; k < end; k++) memcpy(rate[points[k].index], most, sizeof most);
    }
    wr_free(rate);
    wr_free(points);
}

/* Smallest sufficient power of two. */
static int cuts_for(double rate, double width)
{
    const double want = rate * width * (1 - 1e-9);
    int cuts = 1;
    while (cuts < WR_DICE_MOST_CUTS && cuts < want) cuts *= 2;
    return cuts;
}

static void cut_cell(WrDicing *d, WrDiceCell *c)
{
    const WrDiceFace *f = &d->face[c->face];
    const double du = share_of(f->u, f->nu, c->i), dv = share_of(f->v, f->nv, c->j);
    const double *low = f->rate + 2 * (c->j * (f->nu + 1) + c->i), *up = low + 2 * (f->nu + 1);
    c->edge[0] = cuts_for(fmax(low[0], low[2]), du);
    c->edge[1] = cuts_for(fmax(up[0], up[2]), du);
    c->edge[2] = cuts_for(fmax(low[1], up[1]), dv);
    c->edge[3] = cuts_for(fmax(low[3], up[3]), dv);
    c->nu = c->edge[0] > c->edge[1] ? c->edge[0] : c->edge[1];
    c->nv = c->edge[2] > c->edge[3] ? c->edge[2] : c->edge[3];
    c->corner = (int32_t)d->corner_count;
    c->triangle = (int32_t)d->triangle_count;
    d->corner_count += (int64_t)(c->nu + 1) * (c->nv + 1);
    d->triangle_count += 2 * (int64_t)c->nu * c->nv;
}

void wr_dice_choose(WrDicing *d)
{
    for (int f = 0; f < d->faces; f++)
        memset(d->face[f].rate, 0,
               (size_t)(d->face[f].nu + 1) * (size_t)(d->face[f].nv + 1) * 2 * sizeof(double));
    for (int i = 0; i < d->cell_count; i++) ask_corners(d, &d->cells[i]);
    join_corners(d);
    d->corner_count = d->triangle_count = 0;
    for (int i = 0; i < d->cell_count; i++) cut_cell(d, &d->cells[i]);
}
