#include "surface/terrain.h"

#include "base/error.h"
#include "base/memory.h"

#include <math.h>

#define KNOTS 67 /* of 64 cells and one beyond each end */

/* The mean over [low, high) of the axis, in whole texels, at least the nearest. */
static void span_of(double at, double half, int count, int *from, int *to)
{
    const int nearest = (int)fmin(fmax(floor(at), 0), count - 1);
    *from = (int)fmin(fmax(ceil(at - half - 0.5), 0), nearest);
    *to = (int)fmin(fmax(floor(at + half - 0.5), nearest), count - 1);
}

static double mean_at(const WrTerrain *t, double u, double v, int columns, int rows)
{
    int i0, i1, j0, j1;
    double sum = 0;
    span_of(u * t->w, 0.5 * t->w / columns, t->w, &i0, &i1);
    span_of((1 - v) * t->h, 0.5 * t->h / rows, t->h, &j0, &j1);
    for (int j = j0; j <= j1; j++)
        for (int i = i0; i <= i1; i++)
            sum += (double)t->heights[(size_t)j * (size_t)t->w + (size_t)i];
    return sum / ((double)(i1 - i0 + 1) * (j1 - j0 + 1));
}

/* The Bezier points of the spline with these coefficients, `step` apart; beyond the ends it runs on straight. */
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

/* All points' heights, [3 rows + 1][3 columns + 1]. */
static void spline_grid(const WrTerrain *t, int columns, int rows, double *grid)
{
    const int wide = 3 * columns + 1;
    double knots[KNOTS];
    for (int j = 0; j <= rows; j++) {
        for (int i = 0; i <= columns; i++)
            knots[i] = t->height * mean_at(t, (double)i / columns, (double)j / rows, columns, rows);
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
    double *grid =
        wr_try_alloc((size_t)wide * (size_t)(3 * up + 1), sizeof *grid, "a terrain", err);
    float(*out)[48] =
        grid ? wr_try_alloc((size_t)across * (size_t)up, sizeof *out, "a terrain", err) : NULL;
    if (out) spline_grid(t, across, up, grid);
    for (int k = 0; out && k < 16 * across * up; k++) {
        const int patch = k / 16, x = 3 * (patch % across) + k % 4,
                  y = 3 * (patch / across) + k % 16 / 4;
        float *to = out[patch] + 3 * (k % 16);
        to[0] = (float)(t->a * x / (3 * across));
        to[1] = (float)(t->b * y / (3 * up));
        to[2] = (float)grid[(size_t)y * (size_t)wide + (size_t)x] + 0.0f;
    }
    wr_free(grid);
    *points = out;
    *columns = across, *rows = up;
    return out != NULL;
}
