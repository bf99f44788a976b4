#include "generate/pattern.h"

#include "base/error.h"
#include "base/kernmath.h"
#include "field/field.h"

#include <math.h>

/* ---- sampling ---- */

typedef struct Drawing {
    WrPatternAt at;
    const void *ctx;
    WrOrigin across, up;
    int samples;
    double height;
} Drawing;

static double wrapped(double x, double size)
{
    return x < 0.0 ? x + size : x >= size ? x - size : x;
}

/* The mean over one texel, summed in a fixed order. Samples lie at (a + 1/2) / n - 1/2 texels from the centre: an n x n box
   filter for patterns with edges that have no closed-form filter. wr_edge_height already filters straight edges, so most patterns
   take one sample. */
static double texel(const Drawing *d, double x, double y)
{
    int n = d->samples;
    if (n == 1) return d->at(d->ctx, x, y);
    double sum = 0.0;
    for (int b = 0; b < n; b++) {
        double row = wrapped(y + (b + 0.5) / n - 0.5, d->up.size);
        for (int a = 0; a < n; a++)
            sum += d->at(d->ctx, wrapped(x + (a + 0.5) / n - 0.5, d->across.size), row);
    }
    return sum / (n * n);
}

static void fill(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                 float *cover)
{
    (void)worker;
    (void)cover;
    const Drawing *d = ctx;
    for (int j = 0; j < b->count_j; j++) {
        double y = wr_origin_at(&d->up, b->height - 1 - (b->j + j));
        for (int i = 0; i < b->count_i; i++)
            heights[j * WR_TILE + i] =
                (float)(d->height * texel(d, wr_origin_at(&d->across, b->i + i), y));
    }
}

/* Joints as wide as the cells leave no piece, and cells of a few texels average to grey. */
static void note_flat(const WrGenerateJob *job, const WrField *heights)
{
    float low, high;
    wr_field_range(heights, &low, &high);
    if (low == high)
        wr_generate_note(job,
                         "all texels have the same height: cells are too small for %dx%d texels: "
                         "fewer of them (across=, rows=), narrower joints and lines, or a larger "
                         "table",
                         wr_field_width(heights), wr_field_height(heights));
}

bool wr_pattern_make(const WrParams *params, const WrGenerateJob *job, WrPatternAt at,
                     const void *ctx, int samples, WrRelief *out, WrError *err)
{
    const double *origin = wr_param_value(params, "origin")->number;
    Drawing d = { .at = at,
                  .ctx = ctx,
                  .across = wr_origin(wr_field_width(job->like), origin[0]),
                  .up = wr_origin(wr_field_height(job->like), origin[1]),
                  .samples = job->coarse ? 1 : samples,
                  .height = wr_param_number(params, "height") };
    if (!wr_generate_build(job, fill, &d, false, 0.0, out, err)) return false;
    if (d.height != 0.0 && !job->coarse) note_flat(job, out->heights);
    return true;
}

/* ---- cells ---- */

static WrCells cells(double width, double height, int across, int rows)
{
    return (WrCells){ .width = width,
                      .height = height,
                      .across = across,
                      .rows = rows,
                      .cell_width = width / across,
                      .cell_height = height / rows };
}

WrCells wr_cell_grid_make(const WrField *like, int across, int rows)
{
    return cells(wr_field_width(like), wr_field_height(like), across, rows);
}

WrCells wr_cells_of(const WrParams *params, const WrField *like)
{
    return wr_cell_grid_make(like, wr_param_whole(params, "across"),
                             wr_param_whole(params, "rows"));
}

WrCells wr_cells_directed(const WrParams *params, const WrField *like)
{
    if (wr_param_whole(params, "along") == WR_ALONG_U) return wr_cells_of(params, like);
    WrCells turned = cells(wr_field_height(like), wr_field_width(like),
                           wr_param_whole(params, "across"), wr_param_whole(params, "rows"));
    turned.turned = true;
    return turned;
}

/* 24 bits of an integer hash: the quotient is exact in float and double, so all builds agree (HC66). */
double wr_chance(uint32_t seed, int i, int j, int use)
{
    const uint32_t c[3] = { (uint32_t)i, (uint32_t)j, (uint32_t)use };
    return (double)(wr_lattice_hash(seed, c, 3) >> 8) * 0x1p-24;
}

void wr_note_rows(const WrGenerateJob *job, int rows, int multiple, const char *what)
{
    if (rows % multiple != 0)
        wr_generate_note(job,
                         "rows=%d: %s closes at the table's edge where rows is a multiple of %d",
                         rows, what, multiple);
}

double wr_ripple(double turns)
{
    float sine, cosine;
    wr_sincos_turns_f((float)(turns - floor(turns)), &sine, &cosine);
    return (double)sine;
}

/* ---- pieces ---- */

WrNoise wr_pattern_noise(uint32_t seed, double cells_u, double cells_v)
{
    double u = floor(cells_u + 0.5), v = floor(cells_v + 0.5);
    WrNoise noise = { .kind = WR_NOISE_PERLIN, .fade = WR_FADE_QUINTIC, .dim = 2 };
    noise.lattice.seed = seed;
    noise.lattice.period[0] = (int)(u < 1.0 ? 1.0 : u > 65536.0 ? 65536.0 : u);
    noise.lattice.period[1] = (int)(v < 1.0 ? 1.0 : v > 65536.0 ? 65536.0 : v);
    return noise;
}

WrPieces wr_pieces_of(const WrParams *params, const WrCells *c)
{
    WrPieces pieces = { .edge = wr_edge_of(params),
                        .uneven = wr_param_number(params, "uneven"),
                        .tilt = wr_param_number(params, "tilt"),
                        .pillow = wr_param_number(params, "pillow"),
                        .rough = wr_param_number(params, "rough"),
                        .seed = wr_param_seed(params),
                        .width = c->width,
                        .height = c->height };
    double side = c->cell_width < c->cell_height ? c->cell_width : c->cell_height;
    for (int k = 0; k < 2; k++) { /* a fifth and a sixteenth of a piece, but at least four texels */
        double grain = side / (k == 0 ? 5.0 : 16.0);
        if (grain < 4.0) grain = 4.0;
        pieces.grain[k] =
            wr_pattern_noise(pieces.seed + 71U + (uint32_t)k, c->width / grain, c->height / grain);
    }
    return pieces;
}

double wr_piece_roughness(const WrNoise grain[2], const WrPieces *pieces, double x, double y)
{
    double u = x / pieces->width, v = y / pieces->height, sum = 0.0;
    for (int k = 0; k < 2; k++) {
        const int *period = grain[k].lattice.period;
        const double t[2] = { u * period[0], v * period[1] };
        sum += wr_noise_at(&grain[k], t, NULL) * (k == 0 ? 1.0 : 0.6);
    }
    return sum;
}

/* Height of one piece at the point (px, py), -1..1 within it, d texels inside its edge:
     edge(d) (1 - uneven c0 + tilt (c1 px + c2 py) - pillow (px^2 + py^2) / 2 + rough n / 2)
   with random c of the piece (i, j) and noise n. At least 0.05 remains, so that joints are the lowest places. */
double wr_piece(const WrPieces *p, double d, double px, double py, int i, int j, double x, double y)
{
    double e = wr_edge_height(&p->edge, d);
    if (e <= 0.0) return 0.0;
    double top = 1.0 - p->uneven * wr_chance(p->seed, i, j, 0);
    double lean_x = wr_chance(p->seed, i, j, 1) - 0.5, lean_y = wr_chance(p->seed, i, j, 2) - 0.5;
    top += p->tilt * (lean_x * px + lean_y * py);
    top -= p->pillow * 0.5 * (px * px + py * py);
    if (p->rough > 0.0) top += p->rough * 0.5 * wr_piece_roughness(p->grain, p, x, y);
    return e * (top > 0.05 ? top : 0.05);
}

/* ---- the table ---- */

#define ROW(id, label, help, blend)                                                                \
    WR_GENERATOR("pattern", #id, label, help, blend, wr_params_##id, wr_pattern_##id)

const WrGenerator wr_patterns[] = {
    ROW(bricks, "Bricks", "a wall of bricks in one of the bonds", "replace"),
    ROW(tiles, "Tiles", "square tiles, diamonds, or octagons with small squares between",
        "replace"),
    ROW(hexagons, "Hexagons", "a honeycomb, stretched so that it tiles", "replace"),
    ROW(planks, "Planks", "boards with wood grain, each row cut at random places", "replace"),
    ROW(shingles, "Shingles", "a roof of wooden shingles", "replace"),
    ROW(scales, "Scales", "round scales, row over row", "replace"),
    ROW(weave, "Weave", "woven cloth: plain, twill, basket or satin", "replace"),
    ROW(rope, "Rope", "ropes side by side, twisted from strands", "replace"),
    ROW(chain, "Chain", "chains side by side, link through link", "replace"),
    ROW(grid, "Grid", "lines between cells, with rounded edges", "replace"),
    ROW(checks, "Checks", "a checkerboard of high and low fields", "replace"),
    ROW(stripes, "Stripes", "stripes in any direction that tiles", "replace"),
    ROW(waves, "Waves", "waves in any direction that tiles", "replace"),
    ROW(knurl, "Knurling", "knurling: crossed grooves that leave pyramids", "replace"),
    ROW(dots, "Dots", "domes, cones or discs, in rows or scattered", "replace"),
    ROW(voronoi, "Voronoi cells", "distances to scattered points (Worley)", "replace"),
    ROW(cracks, "Cracks", "cells between cracks: dry earth, cobbles, crocodile skin", "replace"),
    ROW(scratches, "Scratches", "random straight or bent scratches", "add"),
    { .family = NULL },
};
