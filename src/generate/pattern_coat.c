/* Overlapping pieces: shingles and scales. Higher rows lie on top; each piece is highest at its lower
   end and falls towards the next row. */
#include "generate/pattern.h"

#include "base/error.h"

#include <math.h>

typedef struct Coat {
    WrCells cells;
    WrPieces pieces;
    double gap;    /* texels between neighbours */
    double ragged; /* variation of the lower ends, as a fraction of a row's height */
    double corner; /* texels; scales: 0 */
    double ridge;  /* of scales: height of the bulge along the middle */
    double wood;   /* of shingles: depth of the grain */
    double radius; /* of scales: texels */
    WrNoise fibre;
} Coat;

/* The piece of a row nearest to x: its column, and the distance of x to the right of its middle. A row
 * beyond the edge is the row at the other end, shift included. So the table also closes with an odd
 * number of rows: the first and the last row, which meet at the edge, then have the same shift. */
static int nearest_column(const Coat *c, int row, double x, double *dx)
{
    double shift = wr_modulo(row, c->cells.rows) % 2 * 0.5 + 0.5;
    double place = x / c->cells.cell_width - shift;
    int column = (int)floor(place + 0.5);
    *dx = (place - column) * c->cells.cell_width;
    return wr_modulo(column, c->cells.across);
}

/* Blends a piece over the previous height. */
static double laid(double under, double top, double cover)
{
    return under + (top - under) * cover;
}

/* ---- shingles ---- */

const WrParam wr_params_shingles[] = {
    WR_P_ACROSS(6),
    WR_P_ROWS(8),
    WR_P_TEXELS("joint", "Gap", 4, 64, "gap between neighbours"),
    WR_P_BEVEL(3),
    WR_P_PROFILE,
    WR_P_PART("ragged", "Ragged", 0.2, "random variation of the lower ends, in rows"),
    WR_P_TEXELS("corner", "Corners", 3, 64, "radius of the corners"),
    WR_P_PART("wood", "Grain", 0.15, "depth of the wood grain, as a share of the height"),
    WR_P_PIECES(0.15, 0.2, 0.1, 0),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

static double shingle_top(const Coat *c, double dx, double half, int i, int j, double x, double y,
                          double up)
{
    const WrPieces *p = &c->pieces;
    double top = 1.0 - 0.7 * up - p->uneven * wr_chance(p->seed, i, j, 0);
    double across = dx / half;
    top += p->tilt * 0.5 * (wr_chance(p->seed, i, j, 1) - 0.5) * across;
    top -= p->pillow * 0.5 * across * across;
    if (p->rough > 0.0) top += p->rough * 0.5 * wr_piece_roughness(p->grain, p, x, y);
    if (c->wood > 0.0) {
        const int *n = c->fibre.lattice.period;
        const double t[2] = { x / c->cells.width * n[0] +
                                  floor(512.0 * wr_chance(p->seed, i, j, 3)),
                              y / c->cells.height * n[1] };
        top += c->wood * (wr_noise_at(&c->fibre, t, NULL) - 0.3);
    }
    return top > 0.05 ? top : 0.05;
}

static double shingle_at(const void *ctx, double x, double y)
{
    const Coat *c = ctx;
    const WrCells *cells = &c->cells;
    double up = y / cells->cell_height, h = 0.0;
    int own = (int)floor(up);
    /* the row below is visible in gaps; the one above reaches down with its ragged ends */
    for (int row = own - 1; row <= own + 1; row++) {
        double dx, half = 0.5 * (cells->cell_width - c->gap);
        int i = nearest_column(c, row, x, &dx), j = wr_modulo(row, cells->rows);
        if (half <= 0.0) continue;
        double low = row - c->ragged * wr_chance(c->pieces.seed, i, j, 4);
        double length = 2.5 * cells->cell_height; /* far below the rows above */
        double middle = (up - low) * cells->cell_height - 0.5 * length;
        double d = wr_inside_box(dx, middle, half, 0.5 * length, c->corner);
        double cover = wr_edge_height(&c->pieces.edge, d);
        if (cover > 0.0) h = laid(h, shingle_top(c, dx, half, i, j, x, y, up - low), cover);
    }
    return h;
}

static Coat coat_of(const WrParams *params, const WrGenerateJob *job)
{
    Coat c = { .cells = wr_cells_of(params, job->like) };
    c.pieces = wr_pieces_of(params, &c.cells);
    return c;
}

bool wr_pattern_shingles(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                         WrError *err)
{
    const WrParams params = { wr_params_shingles, values };
    Coat c = coat_of(&params, job);
    c.gap = wr_param_number(&params, "joint");
    c.ragged = wr_param_number(&params, "ragged");
    c.corner = wr_param_number(&params, "corner");
    c.wood = wr_param_number(&params, "wood");
    double fine = c.cells.across * 24.0; /* fibres of at least three texels */
    if (fine > c.cells.width / 3.0) fine = c.cells.width / 3.0;
    c.fibre = wr_pattern_noise(c.pieces.seed + 9U, fine, c.cells.rows * 2.0);
    wr_note_rows(job, c.cells.rows, 2, "the bond");
    return wr_pattern_make(&params, job, shingle_at, &c, 1, out, err);
}

/* ---- scales ---- */

const WrParam wr_params_scales[] = {
    WR_P_ACROSS(8),
    WR_P_ROWS(16),
    WR_P_NUMBER("size", "Size", 1.08, 0.1, 2, 1.5, "", "width, in cells"),
    WR_P_BEVEL(4),
    WR_P_PROFILE,
    WR_P_PART("ridge", "Ridge", 0.3, "height of the bulge along the middle"),
    WR_P_PIECES(0.1, 0.15, 0, 0.02),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

/* Distance inside a scale: a disc below its middle, straight sides above. */
static double inside_scale(const Coat *c, double dx, double dy)
{
    if (dy > c->radius) return c->radius - fabs(dx);
    double ey = dy - c->radius;
    return c->radius - sqrt(dx * dx + ey * ey);
}

static double scale_top(const Coat *c, double dx, double dy, int i, int j, double x, double y)
{
    const WrPieces *p = &c->pieces;
    double across = dx / c->radius, up = dy / (2.0 * c->cells.cell_height);
    double top = 1.0 - 0.6 * up - p->uneven * wr_chance(p->seed, i, j, 0);
    top += p->tilt * 0.5 * (wr_chance(p->seed, i, j, 1) - 0.5) * across;
    top -= (c->ridge + 0.5 * p->pillow) * across * across;
    if (p->rough > 0.0) top += p->rough * 0.5 * wr_piece_roughness(p->grain, p, x, y);
    return top > 0.05 ? top : 0.05;
}

static double scale_at(const void *ctx, double x, double y)
{
    const Coat *c = ctx;
    const WrCells *cells = &c->cells;
    double h = 0.0;
    int own = (int)floor(y / cells->cell_height);
    for (int row = own - 3; row <= own + 1; row++) {
        double dy = y - row * cells->cell_height, dx;
        int near = nearest_column(c, row, x, &dx), j = wr_modulo(row, cells->rows);
        for (int side = -1; side <= 1; side++) { /* its left and right neighbours may overlap it */
            double ex = dx - side * cells->cell_width;
            double cover = wr_edge_height(&c->pieces.edge, inside_scale(c, ex, dy));
            int i = wr_modulo(near + side, cells->across);
            if (cover <= 0.0) continue;
            double top = scale_top(c, ex, dy, i, j, x, y) * cover;
            h = row == own - 3 || side == -1 || top > h ? laid(h, top, cover) : h;
        }
    }
    return h;
}

bool wr_pattern_scales(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { wr_params_scales, values };
    Coat c = coat_of(&params, job);
    c.ridge = wr_param_number(&params, "ridge");
    c.radius = 0.5 * wr_param_number(&params, "size") * c.cells.cell_width;
    wr_note_rows(job, c.cells.rows, 2, "the bond");
    return wr_pattern_make(&params, job, scale_at, &c, 2, out, err);
}
