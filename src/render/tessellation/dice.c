#include "render/tessellation/dice.h"
#include "render/tessellation/mesh_relief.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "field/scheme.h"
#include "field/scheme_list.h"
#include "render/visibility/view.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- heights ---- */

/* The surface P + F n becomes triangles: each face is cut by lines into cells, each cell into nu x nv squares,
   each square into two triangles. The number of cuts follows from a bound of the distance between facet and
   surface, in pixels (epsilon). */

/* Coefficients of the interpolating spline of that periodic table, as a table; NULL: no memory.
   A fetch by bspline-fit computes its coefficients from 57 texels a side; here all are computed once, and F is
   then the plain B-spline of that table. */
static WrField *coefficients_of(const WrField *field, WrError *err)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    float *values = wr_try_alloc((size_t)w * (size_t)h, sizeof *values, "heights", err);
    WrField *made = values ? wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err) : NULL;
    if (made) {
        wr_field_read_bspline_coefficients(field, 0, 0, w, h, values, (size_t)w);
        wr_field_write(made, 0, 0, w, h, values, (size_t)w);
    }
    wr_free(values);
    return made;
}

bool wr_raised_init(WrRaised *raised, const WrScene *scene, const WrField *field, WrError *err)
{
    *raised = (WrRaised){ .field = field };
    if (scene->analytic.kind != WR_ANALYTIC_OFF || scene->scheme != WR_SCHEME_BSPLINE_FIT ||
        wr_field_wrap_u(field) != WR_WRAP_PERIODIC || wr_field_wrap_v(field) != WR_WRAP_PERIODIC) {
        raised->scene = wr_scene_share(scene);
        return true;
    }
    raised->scene = wr_scene_clone(scene);
    raised->scene->scheme = WR_SCHEME_BSPLINE;
    raised->field = raised->own = coefficients_of(field, err);
    return raised->own != NULL;
}

void wr_raised_fini(WrRaised *raised)
{
    wr_scene_free(raised->scene);
    wr_field_free(raised->own);
    *raised = (WrRaised){ 0 };
}

bool wr_is_raised(const WrScene *scene)
{
    return scene->displaced && scene->height != 0 && !wr_shape_unmoved(&scene->shape);
}

WrHash wr_raised_key(const WrScene *scene, const WrField *field)
{
    const WrAnalytic *formula = &scene->analytic;
    const bool table = formula->kind == WR_ANALYTIC_OFF;
    const uint64_t key = table ? wr_field_key(field) : 0;
    const double by[3] = { scene->height, scene->replicate_u, scene->replicate_v };
    const int how[2] = { (int)scene->scheme, (int)formula->kind };
    WrHash hash = wr_hash_bytes(&scene->shape, sizeof scene->shape, (WrHash){ 1, 1 });
    hash = wr_hash_bytes(&key, sizeof key, hash);
    hash = wr_hash_bytes(by, sizeof by, hash);
    hash = wr_hash_bytes(how, sizeof how, hash);
    for (int k = 0; k < formula->count && !table; k++) {
        const WrAnalyticTerm *term = &formula->terms[k];
        const double terms[5] = { term->i, term->j, term->a, term->phase_u_deg, term->phase_v_deg };
        hash = wr_hash_bytes(terms, sizeof terms, hash);
    }
    return hash;
}

/* A spline through a table's entries exceeds them by less than their range. */
double wr_raised_most(const WrScene *scene, const WrField *field)
{
    float low, high;
    if (scene->analytic.kind != WR_ANALYTIC_OFF)
        return fabs(scene->height) * wr_analytic_amplitude(&scene->analytic);
    wr_field_range(field, &low, &high);
    const double most = fmax(fabs((double)low), fabs((double)high)) + ((double)high - (double)low);
    return fabs(scene->height) * most;
}

/* ---- dicing ---- */

#define WR_DICE_SIDE 16      /* largest number of steps along a cell at which F is measured */
#define WR_DICE_MAX_CUTS 256 /* largest number of cuts of a cell's side */

/* A cell of a face: its needs, and its cuts. Up to `reach` they do not depend on the view.
   Layout of a cell's output: corners at `corner` + y (nu + 1) + x, triangles from `triangle` on, two for each
   square, row by row. */
struct WrDiceCell {
    int32_t face, i, j;   /* position among the face's cells */
    int steps_u, steps_v; /* steps at which F was measured */
    /* deviation of one straight step across it from the base's curve, units */
    double bend_u, bend_v;
    double kink_u, kink_v; /* largest second difference of F between the steps */
    double twist, range;   /* of F within a step; over the cell */
    WrVec3 centre;         /* of a sphere around the displaced cell, */
    double reach;          /* and its radius */
    double pixels;         /* pixels per object unit at its nearest point; 0: it is not visible */
    int32_t corner, triangle; /* index of its first corner and triangle */
    int nu, nv, edge[4];      /* columns, rows; cuts of its lower, upper, left and right edge */
};

/* A face's lines, and the rates at their corners. */
typedef struct WrDiceFace {
    double *u, *v; /* [nu + 1], [nv + 1], owned */
    int nu, nv, first;
    bool aligned; /* lines and the steps between them lie on texels */
    double *rate; /* [(nv + 1)(nu + 1)][2]: steps along all of u and all of v; owned */
} WrDiceFace;

typedef struct WrDicing {
    const WrScene *scene;
    const WrField *field;
    const WrView *view;
    double even;          /* pixels per object unit everywhere; 0: by the view */
    double epsilon, size; /* pixels; the base's radius */
    bool straight;        /* F is bilinear between texels */
    WrDiceFace face[WR_DICE_FACES];
    WrDiceCell *cells; /* [cell_count], owned */
    int faces, cell_count;
    WrTriangleCorner *corners;
    WrTriangle *triangles;
    float *height; /* [corners]: F at each */
    int64_t corner_count, triangle_count;
} WrDicing;

/* A point on the border of the domain, with its displacement f along n. */
typedef struct WrDicePoint {
    int64_t key[3]; /* position before displacement */
    int32_t index;
    WrVec3 p, n;
    double f;
} WrDicePoint;

/* ---- Welding of shared points on the domain's border: seams, poles, edges of a cube ---- */

/* Points are equal if their positions agree to 1e-6 of the radius. Comparing (u, v) would not find seams,
   poles or cube edges. */

#define FINE 1e6 /* resolution of positions: parts of the surface's radius */

static WrDicePoint dice_point(int32_t index, const WrSurfacePoint *at, double f, double size)
{
    const WrVec3 p = v3_scale(at->p, FINE / size);
    /* keeps positions with round coordinates inside a step, not on its border */
    const double off = 0.3819;
    return (WrDicePoint){ .key = { (int64_t)floor(p.x + off), (int64_t)floor(p.y + off),
                                   (int64_t)floor(p.z + off) },
                          .index = index,
                          .p = at->p,
                          .n = at->n_unit,
                          .f = f };
}

static int compare(const void *a, const void *b)
{
    const WrDicePoint *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

/* Sorts points so that those at one position are neighbours. */
static void dice_sort(WrDicePoint *points, int32_t count)
{
    qsort(points, (size_t)count, sizeof *points, compare);
}

/* One past the last point at the position of `from`. */
static int32_t dice_run(const WrDicePoint *points, int32_t from, int32_t count)
{
    int32_t end = from + 1;
    while (end < count && points[end].key[0] == points[from].key[0] &&
           points[end].key[1] == points[from].key[1] && points[end].key[2] == points[from].key[2])
        end++;
    return end;
}

/* x of A x = b with a symmetric A of columns a0, a1, a2.
   Cramer's rule. damp keeps A regular if all normals are equal; the solution is then the mean displacement
   along n. */
static WrVec3 solve(WrVec3 a0, WrVec3 a1, WrVec3 a2, WrVec3 b)
{
    const double det = v3_dot(a0, v3_cross(a1, a2));
    return (WrVec3){ v3_dot(b, v3_cross(a1, a2)) / det, v3_dot(a0, v3_cross(b, a2)) / det,
                     v3_dot(a0, v3_cross(a1, b)) / det };
}

/* d with n_i . d = f_i, by least squares, if it is at most twice the largest f; else the mean displacement.
   Faces that meet at an edge or a corner displace a shared point differently; a common d lies on all displaced
   tangent planes, as a mitre joint does. At a sharp edge d would be very long: hence the limit (HC124). */
static WrVec3 dice_move(const WrDicePoint *points, int32_t count)
{
    const double damp = 1e-9 * count;
    WrVec3 a0 = { damp, 0, 0 }, a1 = { 0, damp, 0 }, a2 = { 0, 0, damp }, b = { 0, 0, 0 };
    WrVec3 mean = { 0, 0, 0 };
    double most = 0, sum = 0;
    for (int32_t i = 0; i < count; i++) {
        const WrVec3 n = points[i].n;
        const double f = points[i].f;
        a0 = v3_mad(a0, n, n.x), a1 = v3_mad(a1, n, n.y), a2 = v3_mad(a2, n, n.z);
        b = v3_mad(b, n, f);
        mean = v3_add(mean, n);
        most = fmax(most, fabs(f));
        sum += f;
    }
    const WrVec3 d = solve(a0, a1, a2, b);
    if (v3_len(d) <= 2 * most) return d;
    return v3_scale(v3_unit(mean, (WrVec3){ 0, 0, 0 }), sum / count);
}

/* ---- cells ---- */

/* Subdivision of a displaced surface: lines on texels, cells between them, and the number of cuts of each cell. */

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

/* Texels per cell: a power of two.
   A power of two, so that lines stay on texels at every size of a block. */
static int block_of(double texels)
{
    int block = 1;
    while (block < 1 << 20 && texels / block > CELLS) block *= 2;
    return block;
}

/* Lines through texel centres, symmetric from both ends: blocks of `block` texels, and single texels where the
   two halves do not meet in the middle.
   F of a bilinear table bends only at texel centres: facets between such lines follow it exactly. */
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

/* The lines of one axis between low and high; returns the number of cells between them.
   Room: at most 4 CELLS even lines, or the two halves of lay_middles with the single texels between. */
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

/* A straight step of length h deviates from the curve by at most h^2 |P'_uu| / 8, with (NUMERICS-LIGHT d)
       |P'_uu| <= |P_uu| + 2 |F_u| |n_u| + |F| |n_uu| + |F_uu|.
   The first three terms are `bend`, measured on the base; the last is `kink`, measured on F itself, because F
   varies on a much finer scale. A square is cut along one diagonal, which deviates from the bilinear patch by
   |F_uv| du dv / 4: `twist`. */

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

/* Pixels per object unit at distance 1 of kernel space. */
static double pixels_per_unit(const WrView *view)
{
    return view->grid_h / (2.0 * view->half_h) / view->samples * view->scale;
}

/* Pixels per object unit for a moving view: at the nearest point of the bounding sphere, rounded up to a power of
   two. From the sphere's surface to half its radius above it, all distances count as the latter. */
static double even_pixels(const WrView *view)
{
    const double away = fmax(v3_len(view->eye) - view->radius, 0.5 * view->radius);
    return wr_exp2(ceil(wr_log2(pixels_per_unit(view) / (view->perspective ? away : 1.0))));
}

/* Pixels per object unit at the nearest point of a sphere around p; 0: it is outside the picture.
   The sphere is tested against the sides of the view pyramid: distance from a side is (x - z w) / sqrt(1 +
   w^2). */
static double pixels_at(const WrView *view, double even, WrVec3 p, double radius)
{
    if (even > 0) return even;
    const double k = view->scale, per = pixels_per_unit(view);
    const WrVec3 w = v3_sub(v3_scale(p, k), view->eye);
    const double x = fabs(v3_dot(w, view->right)), y = fabs(v3_dot(w, view->up));
    const double z = v3_dot(w, view->forward), r = radius * k;
    if (!view->perspective) return x > view->half_w + r || y > view->half_h + r ? 0 : per;
    const double aside = sqrt(1 + view->half_w * view->half_w);
    const double above = sqrt(1 + view->half_h * view->half_h);
    if (z < -r || x > z * view->half_w + r * aside || y > z * view->half_h + r * above) return 0;
    return per / fmax(z - r, 0.01 * view->radius);
}

/* Curvature of the base over the cell, and its position. slope_*: over a step; most: of |F|.
   n_uu is not available in closed form: a difference of n_u over the cell, plus |n_u|^2 for its part along n. */
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
    c->centre = at[4].p;
    c->reach = 1.5 * radius + most;
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

/* Computes lines and cells of all faces. */
static void lay_cells(WrDicing *d)
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
}

/* Computes the cells' needs, or copies those of the same shape in another view. */
static void dice_lay(WrDicing *d, WrDice *dice, WrHash shape, WrPool *pool)
{
    lay_cells(d);
    const size_t count = (size_t)d->cell_count;
    if (!dice->cells || !wr_hash_equal(dice->shape, shape)) {
        wr_pool_run(pool, d->cell_count, measure_cell, d);
        wr_free(dice->cells);
        dice->cells = wr_alloc(count, sizeof *dice->cells);
        memcpy(dice->cells, d->cells, count * sizeof *d->cells);
        dice->shape = shape;
    } else memcpy(d->cells, dice->cells, count * sizeof *d->cells);
    for (int i = 0; i < d->cell_count; i++)
        d->cells[i].pixels = pixels_at(d->view, d->even, d->cells[i].centre, d->cells[i].reach);
}

/* ---- number of cuts ---- */

/* A source of error below SHARE epsilon needs no cuts. Second differences over `steps` shrink by (steps / n)^2
   for n cuts, so n = steps sqrt(kink per / 8); bilinear heights never need more cuts than texels. */

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

/* Rates are steps along a whole side of the face; a corner's rate is the largest need of the cells around it. */
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

/* Sets equal rates for corners at one position: along a seam for each axis, along the edges of a cube for both.
   Without this, both sides of a seam could choose different cuts and leave a crack. */
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
            points[at] = dice_point(at, &p, 0, d->size);
            at++;
        }
    }
    dice_sort(points, count);
    for (int32_t i = 0, end; i < count; i = end) {
        double most[2] = { 0, 0 };
        end = dice_run(points, i, count);
        for (int32_t k = i; k < end; k++)
            for (int c = 0; c < 2; c++) most[c] = fmax(most[c], rate[points[k].index][c]);
        if (d->faces > 1) most[0] = most[1] = fmax(most[0], most[1]);
        for (int32_t k = i; k < end; k++) memcpy(rate[points[k].index], most, sizeof most);
    }
    wr_free(rate);
    wr_free(points);
}

/* Smallest sufficient power of two.
   Powers of two: the points of a coarser edge are a subset of those of a finer one. The factor 1 - 1e-9 keeps
   rounding of the product from doubling the cuts. */
static int cuts_for(double rate, double width)
{
    const double want = rate * width * (1 - 1e-9);
    int cuts = 1;
    while (cuts < WR_DICE_MAX_CUTS && cuts < want) cuts *= 2;
    return cuts;
}

/* An edge's cuts follow from its two ends only, so both cells at it choose the same number; the inside has the
   larger of two opposite edges (NUMERICS-LIGHT d, "crack-free"). */
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

/* Chooses the cuts of all cells for d->epsilon; sets corner_count and triangle_count. */
static void dice_choose(WrDicing *d)
{
    for (int f = 0; f < d->faces; f++)
        memset(d->face[f].rate, 0,
               (size_t)(d->face[f].nu + 1) * (size_t)(d->face[f].nv + 1) * 2 * sizeof(double));
    for (int i = 0; i < d->cell_count; i++) ask_corners(d, &d->cells[i]);
    join_corners(d);
    d->corner_count = d->triangle_count = 0;
    for (int i = 0; i < d->cell_count; i++) cut_cell(d, &d->cells[i]);
}

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
        double u[WR_DICE_MAX_CUTS + 1], v[WR_DICE_MAX_CUTS + 1], f[WR_DICE_MAX_CUTS + 1];
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

/* The corner in column x and row y; on an edge that is cut less often, the nearest existing one before it.
   The number of skipped columns is a power of two, so the remainder finds the last existing point. corner_of
   repeats a corner instead of making a fan: degenerate triangles cover nothing in the raster. */
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
                points[count] = dice_point(i, &at, (double)d->height[i], d->size);
            }
            count++;
        }
    return count;
}

/* Moves points that share one position to one common position. */
static void weld(const WrDicing *d, const WrDicePoint *points, int32_t count)
{
    const WrVec3 p = v3_add(points[0].p, dice_move(points, count));
    for (int32_t i = 0; i < count; i++) {
        WrTriangleCorner *corner = &d->corners[points[i].index];
        put(corner, p, (double)corner->u, (double)corner->v);
    }
}

/* Only border points are sorted: O(n log n) in the circumference. */
static void weld_all(const WrDicing *d)
{
    int32_t count = 0, at = 0;
    for (int i = 0; i < d->cell_count; i++) count += find_ends(d, &d->cells[i], NULL);
    WrDicePoint *points = wr_alloc((size_t)count, sizeof *points);
    for (int i = 0; i < d->cell_count; i++) at += find_ends(d, &d->cells[i], points + at);
    dice_sort(points, count);
    for (int32_t i = 0, end; i < count; i = end) {
        end = dice_run(points, i, count);
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

/* `end` holds the first triangle after each face, so that a triangle's face is found by comparison. */
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
    dice->triangles = t;
    dice->faces = d->faces;
    dice->epsilon = d->epsilon;
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

/* ---- relief on a mesh ---- */

typedef struct WrMeshDicing {
    const WrView *view;
    double even, epsilon, rise; /* as in WrDicing; largest |F| */
} WrMeshDicing;

static double mesh_error(const void *ctx, WrVec3 centre, double radius)
{
    const WrMeshDicing *d = ctx;
    const double pixels = pixels_at(d->view, d->even, centre, radius + d->rise);
    return pixels > 0 ? d->epsilon / pixels : INFINITY;
}

static bool dice_mesh(WrDice *dice, const WrDiceRequest *request, double even, double epsilon,
                      WrError *err)
{
    const WrScene *scene = request->scene;
    const WrTriangles *own = scene->triangles;
    WrMeshDicing dicing = { request->view, even, epsilon, wr_raised_most(scene, request->field) };
    WrMeshRelief relief = { 0 };
    wr_free(dice->cells);
    *dice = (WrDice){ .faces = 1, .base = own ? wr_triangles_share(own) : wr_triangles_square() };
    const WrMeshReliefRequest ask = { .scene = scene,
                                      .field = request->field,
                                      .pool = request->pool,
                                      .mesh = dice->base,
                                      .stretch = { 1, 1, 1 },
                                      .scale = 1,
                                      .error = 1e-6 * dice->base->radius,
                                      .error_at = mesh_error,
                                      .ctx = &dicing,
                                      .most = request->moving
                                                  ? dice->base->triangle_count + WR_DICE_MOVING_MAX
                                                  : WR_DICE_MAX,
                                      .cancel = request->cancel };
    bool good = wr_mesh_relief_make(&relief, &ask, err);
    /* Of a moving view the first facets up to that number are kept: to search for an error takes longer than a frame. */
    while (good && relief.full && !request->moving && dicing.epsilon < 1e30) {
        dicing.epsilon *= 2;
        wr_mesh_relief_fini(&relief);
        good = wr_mesh_relief_make(&relief, &ask, err);
    }
    if (good) dice->triangles = wr_mesh_relief_triangles(&relief, &dice->base_of, err);
    good = good && dice->triangles;
    if (good) dice->end[0] = dice->triangles->triangle_count;
    dice->epsilon = dicing.epsilon;
    dice->rise = fmax(fabs(relief.low), fabs(relief.high));
    wr_mesh_relief_fini(&relief);
    if (!good) wr_dice_fini(dice);
    return good;
}

/* Too many triangles: epsilon grows by at least 1.5 and is chosen again. Cells are measured once, only the
   choice is repeated. */
static bool dice_cells(WrDice *dice, const WrDiceRequest *request, double even, double epsilon,
                       WrError *err)
{
    const WrScene *scene = request->scene;
    const int most = request->moving ? WR_DICE_MOVING_MAX : WR_DICE_MAX;
    WrDicing d = { .scene = scene,
                   .field = request->field,
                   .view = request->view,
                   .even = even,
                   .epsilon = epsilon,
                   .size = wr_shape_radius(&scene->shape),
                   .straight =
                       scene->analytic.kind == WR_ANALYTIC_OFF &&
                       (scene->scheme == WR_SCHEME_BILINEAR || scene->scheme == WR_SCHEME_CENTRAL),
                   .faces = wr_surfaces[scene->shape.kind]->faces };
    dice_lay(&d, dice, wr_raised_key(scene, request->field), request->pool);
    dice_choose(&d);
    while (d.triangle_count > most && d.epsilon < 1e30) {
        d.epsilon *= fmax(1.5, 0.5 * (double)d.triangle_count / most);
        dice_choose(&d);
    }
    const bool room = allocate(&d, err);
    if (room) {
        wr_pool_run(request->pool, d.cell_count, make_cell, &d);
        weld_all(&d);
        hand_over(&d, dice);
    }
    fini(&d);
    return room;
}

/* ---- kept facets ---- */

/* Of a moving view only the scale counts, else everything that pixels_at reads. */
static WrHash key_of(const WrDiceRequest *request, double even)
{
    const WrView *view = request->view;
    const WrVec3 axes[4] = { view->eye, view->right, view->up, view->forward };
    const double numbers[] = { request->epsilon,      even,         view->scale,
                               pixels_per_unit(view), view->half_w, view->half_h,
                               view->perspective,     view->radius };
    const WrHash hash = wr_raised_key(request->scene, request->field);
    if (even > 0) return wr_hash_bytes(numbers, 2 * sizeof *numbers, hash);
    return wr_hash_bytes(axes, sizeof axes, wr_hash_bytes(numbers, sizeof numbers, hash));
}

/* Frees all but the cells' needs. */
static void free_facets(WrDice *dice)
{
    wr_triangles_free(dice->triangles);
    wr_triangles_free(dice->base);
    wr_free(dice->base_of);
    *dice = (WrDice){ .cells = dice->cells, .shape = dice->shape };
}

bool wr_dice_update(WrDice *dice, const WrDiceRequest *request, WrError *err)
{
    const double even = request->moving ? even_pixels(request->view) : 0.0;
    const double epsilon = request->moving ? 2 * request->epsilon : request->epsilon;
    const WrHash key = key_of(request, even);
    WrDiceRequest own = *request;
    WrRaised raised;
    if (dice->triangles && wr_hash_equal(dice->key, key)) return true;
    free_facets(dice);
    bool good = wr_raised_init(&raised, request->scene, request->field, err);
    own.scene = raised.scene, own.field = raised.field;
    if (good && wr_surfaces[own.scene->shape.kind]->held)
        good = dice_mesh(dice, &own, even, epsilon, err);
    else good = good && dice_cells(dice, &own, even, epsilon, err);
    wr_raised_fini(&raised);
    dice->key = key;
    return good;
}

void wr_dice_fini(WrDice *dice)
{
    free_facets(dice);
    wr_free(dice->cells);
    *dice = (WrDice){ 0 };
}
