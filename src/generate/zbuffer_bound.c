/* How high solids can be over a part of a tile, and how high one must be to be seen there at all: what is hidden
   is not drawn. Nothing of that changes a bit of what is seen. */
#include "generate/zbuffer_tile.h"

#define MARGIN 1e-9 /* more than rounding can add, as a part of the heights */

/* ---- how high a solid can be ---- */

/* Its axis stands upright, and its top is level. */
static bool is_level(const WrZSolid *s)
{
    const double *m = s->inverse;
    bool upright = m[2] == 0.0 && m[5] == 0.0 && m[6] == 0.0 && m[7] == 0.0;
    return upright && (s->shape == WR_Z_BOX || s->shape == WR_Z_CYLINDER);
}

static double with_margin(double z)
{
    return z + MARGIN * (1.0 + fabs(z));
}

/* Of letters: the highest corner of the box about them; of those that lie flat exactly their top. */
static double letters_top(const WrZSolid *s)
{
    double low[3], high[3], sum = 0.0;
    wr_zletters_box(s->letters, low, high);
    if (s->inverse[2] == 0.0 && s->inverse[5] == 0.0 && s->inverse[6] == 0.0 &&
        s->inverse[7] == 0.0 && s->inverse[8] > 0.0)
        return s->at[2] + (high[2] - 0.0) / s->inverse[8];
    for (int k = 0; k < 3; k++) {
        double p = s->pose[6 + k] * low[k], q = s->pose[6 + k] * high[k];
        sum += p > q ? p : q;
    }
    return with_margin(s->at[2] + sum);
}

static double top_of(const WrZSolid *s)
{
    double z;
    if (s->shape == WR_Z_LETTERS) return letters_top(s);
    if (is_level(s) && wr_zsolid_top(s, s->at[0], s->at[1], &z)) return z;
    return with_margin(s->at[2] + wr_zsolid_rise(s));
}

static double beyond(double x, double low, double high)
{
    return x < low ? low - x : x > high ? x - high : 0.0;
}

static bool is_round(const WrZSolid *s)
{
    const double *d = s->dome;
    return s->shape == WR_Z_SPHERE && d[0] == 0.0 && d[1] == 0.0 && d[3] == d[4] && d[5] == 0.0;
}

static bool is_flat_ring(const WrZSolid *s)
{
    return s->shape == WR_Z_TORUS && s->inverse[2] == 0.0 && s->inverse[5] == 0.0 &&
           s->inverse[6] == 0.0 && s->inverse[7] == 0.0;
}

/* Over places that are `near` to `far` texels from its upright axis, for what is round about that. */
static double top_between(const WrZSolid *s, double near, double far)
{
    if (s->shape == WR_Z_SPHERE) {
        double rest = 1.0 - s->dome[3] * near * near;
        return s->at[2] + s->dome[2] * sqrt(rest > 0.0 ? rest : 0.0);
    }
    double ring = sqrt(s->pose[0] * s->pose[0] + s->pose[3] * s->pose[3]), tube = ring * s->param;
    double off = beyond(ring, near, far), rest = tube * tube - off * off;
    return s->at[2] + sqrt(rest > 0.0 ? rest : 0.0);
}

static double farthest(double x, double low, double high)
{
    double a = fabs(x - low), b = fabs(x - high);
    return a > b ? a : b;
}

/* A convex body's top is a concave function: over a rectangle within its shadow it is nowhere higher than by as
   much over the middle as the lowest corner is under it. */
static double top_of_convex(const WrZSolid *s, const WrZRect *r, double most)
{
    const double x[5] = { r->x0, r->x1, r->x0, r->x1, 0.5 * (r->x0 + r->x1) };
    const double y[5] = { r->y0, r->y0, r->y1, r->y1, 0.5 * (r->y0 + r->y1) };
    double z[5], low = INFINITY;
    wr_zsolid_tops(s, 5, x, y, z);
    for (int k = 0; k < 5; k++) {
        if (!(z[k] > -INFINITY)) return most;
        low = z[k] < low ? z[k] : low;
    }
    double bound = z[4] + (z[4] - low);
    bound += MARGIN * (1.0 + fabs(z[4]) + fabs(low));
    return bound < most ? bound : most;
}

double wr_zsolid_bound(const WrZSolid *s, const WrZRect *r)
{
    double most = top_of(s);
    if (is_level(s)) return most;
    if (is_round(s) || is_flat_ring(s)) {
        double nx = beyond(s->at[0], r->x0, r->x1), ny = beyond(s->at[1], r->y0, r->y1);
        double fx = farthest(s->at[0], r->x0, r->x1), fy = farthest(s->at[1], r->y0, r->y1);
        double bound =
            with_margin(top_between(s, sqrt(nx * nx + ny * ny), sqrt(fx * fx + fy * fy)));
        return bound < most ? bound : most;
    }
    return wr_zsolid_convex(s) ? top_of_convex(s, r, most) : most;
}

/* ---- how high it must be ---- */

/* Whatever is not higher changes nothing of a texel. Where one solid covers it whole, that is its height; where
   rims cross it, the lowest of what is seen at its samples, once there are two of which the mean is taken. */
static double settled_texel(const WrZSheet *sheet, int at)
{
    if (sheet->mask[at] != WR_Z_FULL) return -INFINITY;
    double whole = sheet->whole[at];
    if (!sheet->block[at]) return sheet->depth[at] == whole ? whole : -INFINITY;
    if (sheet->bodies[at] < 2) return -INFINITY;
    const WrZBlock *block = &sheet->blocks.data[sheet->block[at] - 1];
    double least = sheet->depth[at];
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        double z = block->z[s] > whole ? block->z[s] : whole;
        least = z < least ? z : least;
    }
    return least;
}

static double settled_square(const WrZSheet *sheet, int square)
{
    int x0 = square % WR_Z_SQUARES * WR_Z_SQUARE, y0 = square / WR_Z_SQUARES * WR_Z_SQUARE;
    double least = INFINITY;
    for (int y = y0; y < y0 + WR_Z_SQUARE && y < sheet->high; y++)
        for (int x = x0; x < x0 + WR_Z_SQUARE && x < sheet->wide; x++) {
            double z = settled_texel(sheet, y * WR_TILE + x);
            if (!(z > -INFINITY)) return -INFINITY;
            least = z < least ? z : least;
        }
    return least;
}

double wr_zsheet_settled(WrZSheet *sheet, int square)
{
    enum { OFTEN = 4 };
    if (sheet->draws[square] < OFTEN) return sheet->settled[square];
    sheet->draws[square] = 0;
    sheet->settled[square] = settled_square(sheet, square);
    sheet->least = INFINITY;
    for (int k = 0; k < WR_Z_SQUARES * WR_Z_SQUARES; k++)
        if (sheet->settled[k] < sheet->least) sheet->least = sheet->settled[k];
    return sheet->settled[square];
}

double wr_zsheet_filled(const WrZSheet *sheet)
{
    double least = INFINITY;
    for (int y = 0; y < sheet->high; y++)
        for (int x = 0; x < sheet->wide; x++) {
            int at = y * WR_TILE + x;
            if (sheet->mask[at] != WR_Z_FULL) return -INFINITY;
            least = sheet->depth[at] < least ? sheet->depth[at] : least;
        }
    return least;
}

void wr_zsheet_cull(WrZSheet *sheet)
{
    sheet->culls = true;
    sheet->least = -INFINITY;
    for (int k = 0; k < WR_Z_SQUARES * WR_Z_SQUARES; k++) {
        bool there = k % WR_Z_SQUARES * WR_Z_SQUARE < sheet->wide &&
                     k / WR_Z_SQUARES * WR_Z_SQUARE < sheet->high;
        sheet->settled[k] = there ? -INFINITY : INFINITY;
    }
}
