#include "render/textures/slope_bounds.h"

#include "field/field.h"

#include <math.h>

#define REACH 3       /* texels: those that a fetch reads beside its position, and rounding */
#define TILES_MOST 64 /* largest number of tiles of a box */

/* Texels of an axis, from <= to; on a periodic one they may extend past both ends. */
typedef struct Run {
    int from, to;
} Run;

static double limited(double x)
{
    return x > 0 ? fmin(x, 1) : 0;
}

/* Positions a .. b of the axis; flipped: texel 0 is at 1. */
static Run run_of(double a, double b, int size, bool periodic, bool flipped)
{
    const Run all = { 0, size - 1 };
    const double low = fmin(a, b), high = fmax(a, b), turns = periodic ? floor(low) : 0;
    double from = low - turns, to = high - turns;
    if (!(to - from < 1) || (periodic && to >= 1)) return all;
    if (!periodic) from = limited(from), to = limited(to);
    const Run run = { (int)floor(size * (flipped ? 1 - to : from)) - REACH,
                      (int)floor(size * (flipped ? 1 - from : to)) + REACH };
    if (run.to - run.from >= size) return all;
    if (periodic) return run;
    return (Run){ run.from > 0 ? run.from : 0, run.to < size ? run.to : size - 1 };
}

static int around(int i, int size)
{
    return i < 0 ? i + size : i >= size ? i - size : i;
}

/* The first texel of the next tile. */
static int next_tile(int i, int size)
{
    const int at = around(i, size), end = at - at % WR_TILE + WR_TILE;
    return i + (end < size ? end : size) - at;
}

/* Adds the slopes of tile `at`, including those to tile `first`. */
static void add_tile(const WrLevel *level, int at, int first, float steepest[2])
{
    const bool even =
        !level->steep && level->low[at] == level->high[at] && level->low[at] == level->low[first];
    for (int c = 0; c < 2; c++) {
        const float steep = level->steep ? level->steep[at][c] : even ? 0 : INFINITY;
        steepest[c] = steep > steepest[c] ? steep : steepest[c];
    }
}

void wr_level_box(const WrLevel *level, double u0, double u1, double v0, double v1,
                  float steepest[2])
{
    const int width = level->width, height = level->height;
    for (int c = 0; c < 2; c++) steepest[c] = level->steepest[c];
    if (!(u0 <= u1 && v0 <= v1)) return; /* NaN included */
    const Run x = run_of(level->ru * u0, level->ru * u1, width, level->periodic_u, false);
    const Run y = run_of(level->rv * v0, level->rv * v1, height, level->periodic_v, true);
    float most[2] = { 0, 0 };
    int tiles = 0, first = -1;
    for (int j = y.from; j <= y.to; j = next_tile(j, height))
        for (int i = x.from; i <= x.to; i = next_tile(i, width)) {
            const int tu = around(i, width) / WR_TILE, tv = around(j, height) / WR_TILE;
            const int at = tv * level->tiles_u + tu;
            first = first < 0 ? at : first;
            if (++tiles > TILES_MOST) return;
            add_tile(level, at, first, most);
        }
    for (int c = 0; c < 2; c++) steepest[c] = most[c];
}
