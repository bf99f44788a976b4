#include "surface/terrain.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/patches.h"

#include <math.h>

/* The heights become the coefficients of a uniform cubic B-spline, one per grid corner: a mean over the texels
   around it. The spline is C2, so the base has no creases, and stays within the range of its coefficients. */
#define MAX_MOST 1e29 /* largest height: patches are limited to 1e30 */
#define KNOTS 67      /* for 64 cells and one beyond each end */

/* The range of texels within [low, high) of the axis, in whole texels, at least the nearest. */
static void span_of(double at, double half, int count, int *from, int *to)
{
    const int nearest = (int)fmin(fmax(floor(at), 0), count - 1);
    *from = (int)fmin(fmax(ceil(at - half - 0.5), 0), nearest);
    *to = (int)fmin(fmax(floor(at + half - 0.5), nearest), count - 1);
}

/* Mean heights about all grid corners, [rows + 1][columns + 1], v = 0 first; each row of heights is read once.
   Sums over rows of corners whose range contains row r; ranges overlap, so a row of heights counts for two
   rows of corners. */
static void means_of(const WrTerrain *t, int columns, int rows, float *room, double *means)
{
    for (int r = 0; r < t->h; r++) {
        const float *row =
            t->row ? t->row(t->ctx, r, room) : (const float *)t->ctx + (size_t)r * (size_t)t->w;
        for (int k = 0; k < (columns + 1) * (rows + 1); k++) {
            int i0, i1, j0, j1;
            span_of((1 - (double)(k / (columns + 1)) / rows) * t->h, 0.5 * t->h / rows, t->h, &j0,
                    &j1);
            if (r < j0 || r > j1) {
                k += columns - k % (columns + 1); /* none in this row of corners */
                continue;
            }
            span_of((double)(k % (columns + 1)) / columns * t->w, 0.5 * t->w / columns, t->w, &i0,
                    &i1);
            double sum = r > j0 ? means[k] : 0;
            for (int i = i0; i <= i1; i++) sum += (double)row[i];
            means[k] = r < j1 ? sum : sum / ((double)(i1 - i0 + 1) * (j1 - j0 + 1));
        }
    }
}

/* Bezier points of the spline with these coefficients, `step` apart; extrapolated linearly beyond the
 * ends.
 * A cubic B-spline piece with coefficients a, b, c, d has the Bezier points (a + 4b + c)/6, (2b + c)/3, (b +
 * 2c)/3, (b + 4c + d)/6. */
static void spline_points(const double *knots, int cells, double *out, int step)
{
    double k[KNOTS];
    for (int i = 0; i <= cells; i++) k[i + 1] = knots[i];
    k[0] = 2 * k[1] - k[2];
    k[cells + 2] = 2 * k[cells + 1] - k[cells];
    for (int i = 0; i <= cells; i++) {
        const double *at = k + i;
        out[3 * i * step] = (at[0] + 4 * at[1] + at[2]) / 6;
        if (i == cells) break;
        out[(3 * i + 1) * step] = (2 * at[1] + at[2]) / 3;
        out[(3 * i + 2) * step] = (at[1] + 2 * at[2]) / 3;
    }
}

/* Heights of all points, [3 rows + 1][3 columns + 1].
   A tensor product: first all rows along u, then all columns along v, in place. */
static void spline_grid(const WrTerrain *t, const double *means, int columns, int rows,
                        double *grid)
{
    const int wide = 3 * columns + 1;
    double knots[KNOTS];
    for (int j = 0; j <= rows; j++) {
        for (int i = 0; i <= columns; i++)
            knots[i] = fmin(fmax(t->height * means[j * (columns + 1) + i], -MAX_MOST), MAX_MOST);
        spline_points(knots, columns, grid + (size_t)j * (size_t)wide, 1);
    }
    for (int i = 0; i < wide; i++) {
        for (int j = 0; j <= rows; j++) knots[j] = grid[(size_t)j * (size_t)wide + (size_t)i];
        spline_points(knots, rows, grid + i, wide);
    }
}

static int cells_of(const WrTerrain *t, double side)
{
    const int cells = (int)lround(t->cells * side / fmax(t->a, t->b));
    return cells < 1 ? 1 : cells;
}

bool wr_terrain_points(const WrTerrain *t, float (**points)[48], int *columns, int *rows,
                       WrError *err)
{
    const int across = cells_of(t, t->a), up = cells_of(t, t->b), wide = 3 * across + 1;
    const size_t points_at = (size_t)wide * (size_t)(3 * up + 1);
    double *grid = wr_try_alloc(points_at + KNOTS * KNOTS, sizeof *grid, "a terrain", err);
    float *room = grid ? wr_try_alloc((size_t)t->w, sizeof *room, "a terrain", err) : NULL;
    float(*out)[48] =
        room ? wr_try_alloc((size_t)across * (size_t)up, sizeof *out, "a terrain", err) : NULL;
    if (out) {
        means_of(t, across, up, room, grid + points_at);
        spline_grid(t, grid + points_at, across, up, grid);
    }
    for (int k = 0; out && k < 16 * across * up; k++) {
        const int patch = k / 16, x = 3 * (patch % across) + k % 4,
                  y = 3 * (patch / across) + k % 16 / 4;
        float *to = out[patch] + 3 * (k % 16);
        to[0] = (float)(t->a * x / (3 * across));
        to[1] = (float)(t->b * y / (3 * up));
        to[2] = (float)grid[(size_t)y * (size_t)wide + (size_t)x] + 0.0f;
    }
    wr_free(room);
    wr_free(grid);
    *points = out;
    *columns = across, *rows = up;
    return out != NULL;
}

/* Cell of `count` at a position, and the fraction in it. */
static int cell_of(double at, int count, double *within)
{
    const int cell = (int)fmin(fmax(floor(at * count), 0), count - 1);
    *within = at * count - cell;
    return cell;
}

/* The patch's parameters run 0 .. 1 over one cell, so derivatives by the terrain's u and v have the factors c
   and r. */
void wr_terrain_at(const WrPatches *set, double u, double v, WrSurfacePoint *out)
{
    const double c = set->columns, r = set->rows;
    double x, y;
    const int i = cell_of(u, set->columns, &x), j = cell_of(v, set->rows, &y);
    const float *points = set->patch[j * set->columns + i].point;
    WrShape shape;
    wr_shape_default(WR_SURFACE_bezier, &shape);
    for (int k = 0; k < 48; k++) shape.value[k] = (double)points[k];
    wr_surface_at(&shape, 0, x, y, out);
    out->pu = v3_scale(out->pu, c), out->pv = v3_scale(out->pv, r);
    out->puu = v3_scale(out->puu, c * c), out->pvv = v3_scale(out->pvv, r * r);
    out->puv = v3_scale(out->puv, c * r);
    out->n = v3_scale(out->n, c * r), out->n_len *= c * r;
    out->n_u = v3_scale(out->n_u, c), out->n_v = v3_scale(out->n_v, r);
}
