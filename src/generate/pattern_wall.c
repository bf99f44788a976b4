/* Adjacent pieces: bricks, tiles, hexagons, planks. */
#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "generate/pattern.h"

#include <math.h>

/* ---- bricks ---- */

#define BONDS(X)                                                                                   \
    X(RUNNING, "running")                                                                          \
    X(THIRD, "third")                                                                              \
    X(QUARTER, "quarter")                                                                          \
    X(STACK, "stack")                                                                              \
    X(ENGLISH, "english")                                                                          \
    X(FLEMISH, "flemish")
typedef enum Bond { BONDS(WR_WORD_ID) } Bond;
static const char *const bonds[] = { BONDS(WR_WORD) NULL };

/* Period of a bond in rows. */
WR_ROWS(closes);
static const int closes[] = { [WR_ROW(RUNNING)] = 2, [WR_ROW(THIRD)] = 3,   [WR_ROW(QUARTER)] = 2,
                              [WR_ROW(STACK)] = 1,   [WR_ROW(ENGLISH)] = 2, [WR_ROW(FLEMISH)] = 2 };
WR_ROWS_END(closes, WR_LENGTH(bonds) - 1);

const WrParam wr_params_bricks[] = {
    WR_P_WHOLE("across", "Across", 4, 1, WR_CELLS_MAX, 32, "bricks in a row"),
    WR_P_ROWS(10),
    WR_P_CHOICE("bond", "Bond", RUNNING, bonds, "offset of the rows"),
    WR_P_TEXELS("joint", "Joint", 7, 64, "width of the mortar"),
    WR_P_BEVEL(7),
    WR_P_PROFILE,
    WR_P_TEXELS("corner", "Corners", 5, 64, "radius of the corners"),
    WR_P_TEXELS("wobble", "Wobble", 2, 16, "irregularity of the edges"),
    WR_P_PIECES(0.2, 0.25, 0.08, 0.1),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Bricks {
    WrCells cells;
    WrPieces pieces;
    Bond bond;
    double joint, corner, wobble;
    WrNoise stray_x[2], stray_y[2];
} Bricks;

/* One brick of a row: its start and length, in whole bricks, including the joint. English bond: rows of stretchers and of
   headers (half bricks) in turn. Flemish: stretchers of 2/3 and headers of 1/3 in each row. */
static void find_brick(const Bricks *b, int row, double place, double *begin, double *length)
{
    double cell = floor(place), part = place - cell;
    *begin = cell;
    *length = 1.0;
    if (b->bond == ENGLISH && row % 2 == 1) {
        *length = 0.5;
        *begin = part < 0.5 ? cell : cell + 0.5;
    } else if (b->bond == FLEMISH) {
        bool header = part >= 2.0 / 3.0;
        *length = header ? 1.0 / 3.0 : 2.0 / 3.0;
        *begin = header ? cell + 2.0 / 3.0 : cell;
    }
}

/* Shift of a row in whole bricks. The pattern closes at the upper edge if the number of rows is a multiple of closes[bond]. */
static double row_shift(Bond bond, int row)
{
    switch (bond) {
    case RUNNING:
    case FLEMISH: return row % 2 * 0.5;
    case THIRD: return row % 3 / 3.0;
    case QUARTER:
    case ENGLISH: return row % 2 * 0.25;
    case STACK: break;
    }
    return 0.0;
}

static double wrapped(double x, double size)
{
    x -= size * floor(x / size);
    return x < size ? x : 0.0;
}

static double brick_at(const void *ctx, double x, double y)
{
    const Bricks *b = ctx;
    const WrCells *c = &b->cells;
    double px = x, py = y;
    if (b->wobble > 0.0) {
        px = wrapped(x + b->wobble * wr_piece_roughness(b->stray_x, &b->pieces, x, y), c->width);
        py = wrapped(y + b->wobble * wr_piece_roughness(b->stray_y, &b->pieces, x, y), c->height);
    }
    double up = py / c->cell_height, begin, length;
    int row = (int)floor(up);
    if (row >= c->rows) row = c->rows - 1;
    double place = wrapped(px / c->cell_width + row_shift(b->bond, row), c->across);
    find_brick(b, row, place, &begin, &length);
    double dx = (place - begin - 0.5 * length) * c->cell_width;
    double dy = (up - row - 0.5) * c->cell_height;
    double half_x = 0.5 * (length * c->cell_width - b->joint);
    double half_y = 0.5 * (c->cell_height - b->joint);
    if (half_x <= 0.0 || half_y <= 0.0) return 0.0;
    double d = wr_inside_box(dx, dy, half_x, half_y, b->corner);
    return wr_piece(&b->pieces, d, dx / half_x, dy / half_y, (int)floor(begin * 6.0 + 0.5), row, x,
                    y);
}

bool wr_pattern_bricks(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { wr_params_bricks, values };
    Bricks b = { .cells = wr_cells_of(&params, job->like),
                 .bond = (Bond)wr_param_whole(&params, "bond"),
                 .joint = wr_param_number(&params, "joint"),
                 .corner = wr_param_number(&params, "corner"),
                 .wobble = wr_param_number(&params, "wobble") };
    b.pieces = wr_pieces_of(&params, &b.cells);
    for (int k = 0; k < 2; k++) {
        double across = b.cells.across * (k == 0 ? 3.0 : 9.0);
        double up = b.cells.rows * (k == 0 ? 1.5 : 4.0);
        b.stray_x[k] = wr_pattern_noise(b.pieces.seed + 91U + (uint32_t)k, across, up);
        b.stray_y[k] = wr_pattern_noise(b.pieces.seed + 95U + (uint32_t)k, across, up);
    }
    wr_note_rows(job, b.cells.rows, closes[b.bond], "the bond");
    return wr_pattern_make(&params, job, brick_at, &b, 1, out, err);
}

/* ---- tiles ---- */

/* The corner cut, in half widths. */
#define TILES(X) X(1.0, "square") X(0.70710678118654752, "octagon") X(0.5, "diamond")
static const double tile_cuts[] = { TILES(WR_WORD_ID) };
static const char *const tile_shapes[] = { TILES(WR_WORD) NULL };

const WrParam wr_params_tiles[] = {
    WR_P_ACROSS(6),
    WR_P_ROWS(6),
    WR_P_CHOICE("shape", "Shape", 0, tile_shapes, "shape of the tiles"),
    WR_P_TEXELS("joint", "Joint", 5, 64, "width of the grout"),
    WR_P_BEVEL(6),
    WR_P_PROFILE,
    WR_P_TEXELS("corner", "Corners", 4, 64, "shape=square: radius of the corners"),
    WR_P_PIECES(0.1, 0.15, 0.1, 0),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Tiles {
    WrCells cells;
    WrPieces pieces;
    double joint, corner;
    double
        cut; /* a tile is |dx|/cell_width + |dy|/cell_height <= cut; 1: a square, 1/2: a diamond */
} Tiles;

static double tile_at(const void *ctx, double x, double y)
{
    const Tiles *t = ctx;
    const WrCells *c = &t->cells;
    double u = x / c->cell_width, v = y / c->cell_height;
    int i = (int)floor(u), j = (int)floor(v);
    double dx = u - i - 0.5, dy = v - j - 0.5; /* of a cell */
    double half_x = 0.5 * (c->cell_width - t->joint), half_y = 0.5 * (c->cell_height - t->joint);
    if (half_x <= 0.0 || half_y <= 0.0) return 0.0;
    double corner = t->cut < 1.0 ? 0.0 : t->corner;
    double d = wr_inside_box(dx * c->cell_width, dy * c->cell_height, half_x, half_y, corner);
    if (t->cut < 1.0) {
        double per_u = 1.0 / c->cell_width, per_v = 1.0 / c->cell_height;
        double steep = sqrt(per_u * per_u + per_v * per_v);
        /* The oblique side is |dx| + |dy| = cut. Its gradient is `steep` per texel: dividing by it makes the excess a
           distance. */
        double past = (fabs(dx) + fabs(dy) - t->cut) / steep; /* texels beyond the cut */
        if (past > 0.0) {                                     /* the tile about the cell's corner */
            int ci = wr_modulo(i + (dx > 0.0), c->across), cj = wr_modulo(j + (dy > 0.0), c->rows);
            double reach = 1.0 - t->cut;
            double px = (fabs(dx) - 0.5) / reach, py = (fabs(dy) - 0.5) / reach;
            px = dx > 0.0 ? px : -px;
            py = dy > 0.0 ? py : -py;
            return wr_piece(&t->pieces, past - 0.5 * t->joint, px, py, ci, cj - c->rows, x, y);
        }
        if (t->cut == 0.5 || -past - 0.5 * t->joint < d) d = -past - 0.5 * t->joint;
    }
    return wr_piece(&t->pieces, d, 2.0 * dx, 2.0 * dy, i, j, x, y);
}

bool wr_pattern_tiles(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams params = { wr_params_tiles, values };
    Tiles t = { .cells = wr_cells_of(&params, job->like),
                .joint = wr_param_number(&params, "joint"),
                .corner = wr_param_number(&params, "corner"),
                .cut = tile_cuts[wr_param_whole(&params, "shape")] };
    t.pieces = wr_pieces_of(&params, &t.cells);
    return wr_pattern_make(&params, job, tile_at, &t, 1, out, err);
}

/* ---- hexagons ---- */

const WrParam wr_params_hexagons[] = {
    WR_P_ACROSS(7),
    WR_P_WHOLE("rows", "Rows", 0, 0, WR_CELLS_MAX, 32,
               "number of rows, even; 0: the number that makes the hexagons most regular"),
    WR_P_TEXELS("joint", "Joint", 5, 64, "width of the gap"),
    WR_P_BEVEL(8),
    WR_P_PROFILE,
    WR_P_PIECES(0.1, 0.2, 0.1, 0.05),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Hexagons {
    WrCells cells;
    WrPieces pieces;
    double joint;
    double side[4][2], reach[4]; /* half the distance to its neighbours: unit vectors, lengths */
} Hexagons;

/* The nearest hexagon centre; centres are (i + 1/2 (j odd), j) cells from the origin; dx, dy from it. */
static void nearest_hexagon(const WrCells *c, double x, double y, double *dx, double *dy, int *i,
                            int *j)
{
    int below = (int)floor(y / c->cell_height);
    double best = INFINITY;
    for (int row = below - 1; row <= below + 2; row++) {
        double shift = wr_modulo(row, 2) * 0.5;
        int column = (int)floor(x / c->cell_width - shift + 0.5);
        double ex = x - (column + shift) * c->cell_width, ey = y - row * c->cell_height;
        if (ex * ex + ey * ey >= best) continue;
        best = ex * ex + ey * ey;
        *dx = ex;
        *dy = ey;
        *i = wr_modulo(column, c->across);
        *j = wr_modulo(row, c->rows);
    }
}

/* The hexagon is the Voronoi cell of the lattice of centres: the distance to its border is the least of half the distance to
   a neighbour minus the projection on its direction; four directions and their opposites contain all neighbours, also of
   stretched ones. */
static double hexagon_at(const void *ctx, double x, double y)
{
    const Hexagons *h = ctx;
    double dx = 0.0, dy = 0.0, d = INFINITY;
    int i = 0, j = 0;
    nearest_hexagon(&h->cells, x, y, &dx, &dy, &i, &j);
    for (int k = 0; k < 4; k++) {
        double to = h->reach[k] - fabs(dx * h->side[k][0] + dy * h->side[k][1]);
        d = to < d ? to : d;
    }
    double px = 2.0 * dx / h->cells.cell_width, py = 1.5 * dy / h->cells.cell_height;
    return wr_piece(&h->pieces, d - 0.5 * h->joint, px, py, i, j, x, y);
}

/* The even number of rows for which a hexagon's height is nearest to sqrt(3)/2 of its width. */
static int regular_rows(const WrField *like, int across)
{
    double rows = across * 2.0 / sqrt(3.0) * wr_field_height(like) / wr_field_width(like);
    int pairs = (int)floor(0.5 * rows + 0.5);
    return pairs < 1 ? 2 : pairs > WR_CELLS_MAX / 2 ? WR_CELLS_MAX : 2 * pairs;
}

bool wr_pattern_hexagons(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                         WrError *err)
{
    const WrParams params = { wr_params_hexagons, values };
    int across = wr_param_whole(&params, "across"), rows = wr_param_whole(&params, "rows");
    if (rows % 2 != 0)
        return wr_fail(
            err, "pattern hexagons: rows=%d: must be even, or the honeycomb does not tile", rows);
    if (rows == 0) rows = regular_rows(job->like, across);
    Hexagons h = { .cells = wr_cell_grid_make(job->like, across, rows),
                   .joint = wr_param_number(&params, "joint") };
    h.pieces = wr_pieces_of(&params, &h.cells);
    double w = h.cells.cell_width, t = h.cells.cell_height;
    const double to[4][2] = { { w, 0 }, { 0.5 * w, t }, { 0.5 * w, -t }, { 0, 2.0 * t } };
    for (int k = 0; k < 4; k++) {
        double length = sqrt(to[k][0] * to[k][0] + to[k][1] * to[k][1]);
        h.side[k][0] = to[k][0] / length;
        h.side[k][1] = to[k][1] / length;
        h.reach[k] = 0.5 * length;
    }
    double stretch = 100.0 * (t / (0.5 * sqrt(3.0) * w) - 1.0);
    if (fabs(stretch) > 0.05)
        wr_generate_note(job, "%d rows: the hexagons are stretched upwards by %.1f %%", rows,
                         stretch);
    return wr_pattern_make(&params, job, hexagon_at, &h, 1, out, err);
}

/* ---- planks ---- */

const WrParam wr_params_planks[] = {
    WR_P_WHOLE("across", "Across", 2, 1, WR_CELLS_MAX, 32, "planks end to end"),
    WR_P_WHOLE("rows", "Rows", 6, 1, WR_CELLS_MAX, 32, "planks side by side"),
    WR_P_ALONG,
    WR_P_TEXELS("joint", "Joint", 3, 64, "width of the gap"),
    WR_P_BEVEL(5),
    WR_P_PROFILE,
    WR_P_PART("wood", "Grain", 0.25, "depth of the wood grain, as a share of the height"),
    WR_P_WHOLE("rings", "Rings", 6, 1, 64, 16, "number of growth rings across a plank"),
    WR_P_PIECES(0.15, 0.1, 0.05, 0),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Planks {
    WrCells cells;
    WrPieces pieces;
    double joint, wood;
    int rings;
    WrNoise bend, fibre;
} Planks;

/* Wavy rings along the plank, and fibres; 0..1. Each plank uses another part of the noise. */
static double wood(const Planks *p, double u, double v, double py, int i, int j)
{
    const int *n = p->bend.lattice.period, *m = p->fibre.lattice.period;
    double du = floor(1024.0 * wr_chance(p->pieces.seed, i, j, 5));
    double dv = floor(1024.0 * wr_chance(p->pieces.seed, i, j, 6));
    const double bend_at[2] = { u * n[0] + du, v * n[1] + dv };
    const double fibre_at[2] = { u * m[0] + du, v * m[1] + dv };
    double sine, cosine, bend = wr_noise_at(&p->bend, bend_at, NULL);
    /* Rings are circles about the heart of the trunk cut by the plank: the phase grows with the square of the distance from
       the heart, bent by noise. */
    double heart = 2.0 * wr_chance(p->pieces.seed, i, j, 7) - 1.0;
    wr_sincos_turns(0.5 * p->rings * (py - heart) * (py - heart) + 1.6 * bend, &sine, &cosine);
    double ring = 0.5 + 0.5 * sine;
    return 0.65 * ring * ring + 0.35 * (0.5 + 0.5 * wr_noise_at(&p->fibre, fibre_at, NULL));
}

static double plank_at(const void *ctx, double x, double y)
{
    const Planks *p = ctx;
    const WrCells *c = &p->cells;
    wr_cells_turn(&p->cells, &x, &y);
    double up = y / c->cell_height;
    int row = (int)floor(up);
    if (row >= c->rows) row = c->rows - 1;
    double place = wrapped(x / c->cell_width + wr_chance(p->pieces.seed, row, 0, 4), c->across);
    int column = (int)floor(place);
    double dx = (place - column - 0.5) * c->cell_width, dy = (up - row - 0.5) * c->cell_height;
    double half_x = 0.5 * (c->cell_width - p->joint), half_y = 0.5 * (c->cell_height - p->joint);
    if (half_x <= 0.0 || half_y <= 0.0) return 0.0;
    double d = wr_inside_box(dx, dy, half_x, half_y, p->pieces.edge.bevel * 0.5);
    double h = wr_piece(&p->pieces, d, dx / half_x, dy / half_y, column, row, x, y);
    if (h <= 0.0 || p->wood == 0.0) return h;
    return h * (1.0 - p->wood * wood(p, x / c->width, y / c->height, dy / half_y, column, row));
}

bool wr_pattern_planks(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { wr_params_planks, values };
    Planks p = { .cells = wr_cells_directed(&params, job->like),
                 .joint = wr_param_number(&params, "joint"),
                 .wood = wr_param_number(&params, "wood"),
                 .rings = wr_param_whole(&params, "rings") };
    p.pieces = wr_pieces_of(&params, &p.cells);
    p.bend = wr_pattern_noise(p.pieces.seed + 7U, p.cells.across * 3.0, p.cells.rows * 2.0);
    double fine = p.cells.rows * 24.0; /* fibres of at least three texels */
    if (fine > p.cells.height / 3.0) fine = p.cells.height / 3.0;
    p.fibre = wr_pattern_noise(p.pieces.seed + 8U, p.cells.across * 6.0, fine);
    return wr_pattern_make(&params, job, plank_at, &p, 1, out, err);
}
