/* The depth buffer: lists the primitives of each tile, then draws the tiles on all threads. */
#include "generate/zbuffer.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "generate/zbuffer_tile.h"

#include <string.h>

/* ---- bound ---- */

/* Bounds of the heights of solids over a part of a tile, and the minimum height to be visible there:
   hidden solids are not drawn. This never changes a visible bit. */

#define MARGIN 1e-9 /* more than the rounding error, relative to the heights */
#define SLACK 1e-6  /* enlargement of a unit solid's bounding box */
#define HALF 0.7072 /* of a texel's diagonal */

/* ---- bounds of a solid ---- */

/* True if its axis is vertical and its top is horizontal. */
static bool is_level(const WrZSolid *s)
{
    const double *m = s->inverse;
    bool upright = m[2] == 0.0 && m[5] == 0.0 && m[6] == 0.0 && m[7] == 0.0;
    return upright && (s->shape == WR_Z_BOX || s->shape == WR_Z_CYLINDER);
}

/* Bounds must hold for rounded heights: a bound that is too low by an ulp would hide a visible solid. */
static double with_margin(double z)
{
    return z + MARGIN * (1.0 + fabs(z));
}

/* For letters: the highest corner of their bounding box; for flat ones exactly their top. */
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

static bool is_round(const WrZSolid *s)
{
    const double *d = s->dome;
    return s->shape == WR_Z_SPHERE && d[0] == 0.0 && d[1] == 0.0 && d[3] == d[4] && d[5] == 0.0;
}

/* True for a flat ring, or an upright capsule: both are circular before they are rotated. */
static bool is_upright(const WrZSolid *s)
{
    bool turned = s->shape == WR_Z_TORUS || s->shape == WR_Z_CAPSULE;
    return turned && s->inverse[2] == 0.0 && s->inverse[5] == 0.0 && s->inverse[6] == 0.0 &&
           s->inverse[7] == 0.0;
}

void wr_zsolid_set_bounds(WrZSolid *s)
{
    s->level = is_level(s);
    s->round = is_round(s) || is_upright(s);
    s->ring = sqrt(s->pose[0] * s->pose[0] + s->pose[3] * s->pose[3]);
    s->tube = s->ring * s->param;
    s->middle = s->at[2] + (s->shape == WR_Z_CAPSULE ? fabs(s->pose[8]) * s->param : 0.0);
    s->peak = top_of(s);
}

static double beyond(double x, double low, double high)
{
    return x < low ? low - x : x > high ? x - high : 0.0;
}

/* Upper bound at distances `near` to `far` texels from the vertical axis, for rotationally symmetric
   solids. Slightly enlarged: at the rim rounding is a large part of the value under the root. */
static double top_between(const WrZSolid *s, double near, double far)
{
    if (s->shape != WR_Z_TORUS) {
        double rest = 1.0 + 1e-15 - s->dome[3] * near * near;
        return s->middle + s->dome[2] * sqrt(rest > 0.0 ? rest : 0.0);
    }
    double off = beyond(s->ring, near, far), rest = s->tube * s->tube - off * off;
    return s->middle + sqrt(rest > 0.0 ? rest : 0.0);
}

static double farthest(double x, double low, double high)
{
    double a = fabs(x - low), b = fabs(x - high);
    return a > b ? a : b;
}

/* The lowest height at such distances if it covers them all. */
static double least_between(const WrZSolid *s, double near, double far)
{
    double rest;
    if (s->shape != WR_Z_TORUS) {
        rest = 1.0 - s->dome[3] * far * far;
        return rest > MARGIN ? s->middle + s->dome[2] * sqrt(rest) : -INFINITY;
    }
    double a = fabs(near - s->ring), b = fabs(far - s->ring), off = a > b ? a : b;
    rest = s->tube * s->tube - off * off;
    return rest > MARGIN * s->tube * s->tube ? s->middle + sqrt(rest) : -INFINITY;
}

/* True if it is entirely outside. near, far: squares. */
static bool is_clear(const WrZSolid *s, double near, double far)
{
    const double more = 1.0 + 1e-6;
    if (s->shape != WR_Z_TORUS) return s->dome[3] * near > more;
    double out = s->ring + s->tube * more, in = s->ring - s->tube * more;
    return near > out * out || (in > 0.0 && far < in * in);
}

static double round_range(const WrZSolid *s, const WrZRect *r, double most, double *least)
{
    double nx = beyond(s->at[0], r->x0, r->x1), ny = beyond(s->at[1], r->y0, r->y1);
    double fx = farthest(s->at[0], r->x0, r->x1), fy = farthest(s->at[1], r->y0, r->y1);
    double near = nx * nx + ny * ny, far = fx * fx + fy * fy;
    if (is_clear(s, near, far)) return -INFINITY;
    near = sqrt(near);
    far = sqrt(far);
    double low = least_between(s, near, far), high = with_margin(top_between(s, near, far));
    if (low > -INFINITY) *least = low - MARGIN * (1.0 + fabs(low));
    return high < most ? high : most;
}

/* A convex body's top is a concave function: over a rectangle within its projection it is nowhere lower
   than at a corner, and nowhere higher above the height at the middle than the lowest corner is below
   it. */
static double convex_range(const WrZSolid *s, const WrZRect *r, double most, double *least)
{
    double x[5] = { r->x0, r->x1, r->x0, r->x1, 0.5 * (r->x0 + r->x1) };
    double y[5] = { r->y0, r->y0, r->y1, r->y1, 0.5 * (r->y0 + r->y1) };
    double z[5], low = INFINITY;
    wr_zsolid_tops(s, 5, x, y, z);
    for (int k = 0; k < 5; k++) {
        if (!(z[k] > -INFINITY)) return most;
        low = z[k] < low ? z[k] : low;
    }
    *least = s->level ? low : low - MARGIN * (1.0 + fabs(low));
    if (s->level) return most;
    double bound = z[4] + (z[4] - low);
    bound += MARGIN * (1.0 + fabs(z[4]) + fabs(low));
    return bound < most ? bound : most;
}

/* Its bounding box in the space of its unit solid, slightly enlarged for rounding. */
static void unit_box(const WrZSolid *s, double low[3], double high[3])
{
    if (s->shape == WR_Z_LETTERS) wr_zletters_box(s->letters, low, high);
    for (int k = 0; k < 3 && s->shape != WR_Z_LETTERS; k++) {
        high[k] = s->shape == WR_Z_TORUS     ? (k < 2 ? 1.0 + s->param : s->param)
                  : s->shape == WR_Z_CAPSULE ? (k < 2 ? 1.0 : 1.0 + s->param)
                                             : 1.0;
        low[k] = -high[k];
    }
    for (int k = 0; k < 3; k++) {
        low[k] -= SLACK * (1.0 + fabs(low[k]));
        high[k] += SLACK * (1.0 + fabs(high[k]));
    }
}

/* Upper bound of that box over the rectangle; -INFINITY: not there. A tilted solid is much lower on one
   side than on the other. A vertical line is a + b z there, and a depends only on x and y. So a + b z lies within low..high
   on all three axes for z between the largest of the lower and the smallest of the upper ends (the slab method), with a
   replaced by its extremes over the rectangle. */
static double box_top(const WrZSolid *s, const WrZRect *r)
{
    double low[3], high[3], top = INFINITY, bottom = -INFINITY;
    const double x0 = r->x0 - s->at[0], x1 = r->x1 - s->at[0];
    const double y0 = r->y0 - s->at[1], y1 = r->y1 - s->at[1];
    unit_box(s, low, high);
    for (int k = 0; k < 3; k++) {
        const double u = s->inverse[3 * k], v = s->inverse[3 * k + 1], b = s->inverse[3 * k + 2];
        const double least = (u < 0.0 ? u * x1 : u * x0) + (v < 0.0 ? v * y1 : v * y0);
        const double most = (u < 0.0 ? u * x0 : u * x1) + (v < 0.0 ? v * y0 : v * y1);
        if (fabs(b) <= SLACK * (fabs(u) + fabs(v))) { /* its sides are nearly vertical */
            if (b == 0.0 && (least > high[k] || most < low[k])) return -INFINITY;
            continue;
        }
        const double up = b > 0.0 ? (high[k] - least) / b : (low[k] - most) / b;
        const double down = b > 0.0 ? (low[k] - most) / b : (high[k] - least) / b;
        top = up < top ? up : top;
        bottom = down > bottom ? down : bottom;
    }
    if (bottom > with_margin(top) + MARGIN * fabs(bottom)) return -INFINITY;
    return with_margin(s->at[2] + top) + MARGIN * fabs(top);
}

static bool leans(const WrZSolid *s)
{
    const double *m = s->inverse;
    return m[2] != 0.0 || m[5] != 0.0 || m[6] != 0.0 || m[7] != 0.0;
}

static bool is_beside(const WrZSolid *s, const WrZRect *r)
{
    return s->at[0] + s->left > r->x1 || s->at[0] + s->right < r->x0 || s->at[1] + s->top > r->y1 ||
           s->at[1] + s->bottom < r->y0;
}

/* Upper bound of the solid over the rectangle; -inf: it is not there. *least: lower bound if it covers
   all of the rectangle; else -inf. */
static double zsolid_range(const WrZSolid *s, const WrZRect *r, double *least)
{
    *least = -INFINITY;
    if (s->round) return round_range(s, r, s->peak, least);
    if (is_beside(s, r)) return -INFINITY;
    double most = s->peak;
    if (leans(s)) {
        const double top = box_top(s, r);
        if (top == -INFINITY) return top;
        most = top < most ? top : most;
    }
    return wr_zsolid_convex(s) ? convex_range(s, r, most, least) : most;
}

/* True for a flat torus that is not thin, for which single texels can be selected. */
static bool zsolid_is_ring(const WrZSolid *s)
{
    return s->shape == WR_Z_TORUS && s->round && s->tube >= 4.0;
}

/* Distance of its middle line from a texel's centre up to which it covers the texel above the floor and
   is nowhere in it steep enough to count as an edge: then only its height at the centre matters. */
static double well_within(const WrZSolid *s, double floor)
{
    double low = floor > s->at[2] ? floor - s->at[2] : 0.0, steep = 0.866 * s->tube;
    double rest = s->tube * s->tube - low * low, wide = sqrt(rest > 0.0 ? rest : 0.0);
    return (wide < steep ? wide : steep) - HALF;
}

/* Distance of its middle line from the centre of a texel up to which it can change it. Other parts of
   it are nearer by HALF at most. */
static double reach_of(const WrZSolid *s, double within, double settled)
{
    double rise = settled - MARGIN * (1.0 + fabs(settled)) - s->at[2];
    double rest = s->tube * s->tube - (rise > 0.0 ? rise * rise : 0.0);
    double reach = sqrt(rest > 0.0 ? rest : 0.0) * (1.0 + MARGIN);
    return reach + HALF <= within ? reach : reach + HALF;
}

static void band_texel(const WrZSolid *s, WrZBand *band, int k, double settled)
{
    double reach = reach_of(s, band->within, settled);
    double low = (s->ring - reach) * (1.0 - MARGIN), high = (s->ring + reach) * (1.0 + MARGIN);
    band->low[k] = low > 0.0 ? low * low : -1.0;
    band->high[k] = high * high;
}

/* Sets the band for the ring: completely if the kind differs, else only for the changed texels (a bit
 * each, row by row). settled: from zsheet_settled. */
static void zband_set(WrZBand *band, const WrZSolid *s, double floor, const double *settled,
                      uint64_t texels)
{
    bool same = band->at == s->at[2] && band->ring == s->ring && band->tube == s->tube;
    if (!same) {
        *band = (WrZBand){ .at = s->at[2], .ring = s->ring, .tube = s->tube };
        band->within = well_within(s, floor);
        texels = ~(uint64_t)0;
    }
    for (; texels; texels &= texels - 1) {
        int k = __builtin_ctzll(texels);
        band_texel(s, band, k, settled[k]);
    }
}

/* The texels that such a ring may change. (x, y): from its axis to the square's first texel. */
static uint64_t zband_meets(const WrZBand *band, double x, double y)
{
    uint64_t met = 0;
    for (int j = 0; j < WR_Z_SQUARE; j++) {
        const double *low = band->low + j * WR_Z_SQUARE, *high = band->high + j * WR_Z_SQUARE;
        const double yy = (y + j) * (y + j);
        double in[WR_Z_SQUARE], any = 0.0;
#pragma omp simd reduction(+ : any)
        for (int i = 0; i < WR_Z_SQUARE; i++) {
            double dd = (x + i) * (x + i) + yy, above = dd > low[i] ? 1.0 : 0.0;
            in[i] = dd < high[i] ? above : 0.0;
            any += in[i];
        }
        for (int i = 0; any > 0.0 && i < WR_Z_SQUARE; i++)
            met |= (uint64_t)(in[i] > 0.0) << (j * WR_Z_SQUARE + i);
    }
    return met;
}

/* True if it lies well within those texels. */
static bool zband_is_within(const WrZBand *band, double x, double y, uint64_t texels)
{
    for (; texels; texels &= texels - 1) {
        int k = __builtin_ctzll(texels);
        double px = x + k % WR_Z_SQUARE, py = y + k / WR_Z_SQUARE;
        if (fabs(sqrt(px * px + py * py) - band->ring) > band->within) return false;
    }
    return true;
}

/* ---- minimum visible height ---- */

/* A primitive that is not higher changes nothing in a texel. If one solid covers it completely, that is
   its height; if rims cross it, the lowest of its samples, once there are two whose mean is used. */
static double zsheet_settled_texel(const WrZSheet *sheet, int at)
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

/* For each texel of the square of WR_Z_SQUARE from (x, y) on: the height below which a solid changes
   nothing there; inf beyond the table. Returns the least. */
static double zsheet_settled(const WrZSheet *sheet, int x, int y,
                             double settled[WR_Z_SQUARE * WR_Z_SQUARE])
{
    double least = INFINITY;
    for (int j = 0; j < WR_Z_SQUARE; j++)
        for (int i = 0; i < WR_Z_SQUARE; i++) {
            bool there = x + i < sheet->wide && y + j < sheet->high;
            double z = there ? zsheet_settled_texel(sheet, (y + j) * WR_TILE + x + i) : INFINITY;
            settled[j * WR_Z_SQUARE + i] = z;
            least = z < least ? z : least;
        }
    return least;
}

/* zsheet_settled for triangles, anywhere in the tile. */
static double zsheet_filled(const WrZSheet *sheet)
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

/* ---- Drawing of triangles in a tile of the depth buffer ---- */

#define FIX 1024 /* corners are rounded to this fraction of a texel */
#define WIDE 8   /* texels: longer rows are first clipped to the triangle */

const int8_t wr_z_samples[WR_Z_SAMPLES][2] = {
    { 1, 1 },  { -1, -3 }, { -3, 2 },  { 4, -1 }, { -5, -2 }, { 2, 5 },  { 5, 3 }, { 3, -5 },
    { -2, 6 }, { 0, -7 },  { -4, -6 }, { -6, 4 }, { -8, 0 },  { 7, -4 }, { 6, 7 }, { -7, -8 },
};

typedef struct Edge {
    int64_t a, b, c; /* a x + b y + c >= 0 inside, in fractions of a texel; edges by the top-left
                        rule */
    int64_t margin;  /* its maximum variation within a texel */
} Edge;

typedef struct Facet {
    Edge edges[3];
    double x, y, z, zx, zy; /* z + zx (X - x) + zy (Y - y) */
    double low, high;       /* its corners' heights */
    int x0, x1, y0, y1;     /* texels of the tile */
} Facet;

/* The nearest integer, |x| < 2^40; rint without a call. */
static int64_t fix(double x)
{
    const double magic = 0x1.8p52;
    return (int64_t)((x * FIX + magic) - magic);
}

static int floor_of(double x)
{
    int i = (int)x;
    return i - ((double)i > x);
}

/* The edge from p to q, inside on the side of the third corner; x right, y down. Edge function in exact integers, a x + b y +
   c with a = p_y - q_y, b = q_x - p_x: 64 bits hold products of coordinates up to 2^20 texels in 1/1024. Of two triangles
   with a common side exactly one covers a point on it: c is lowered by 1 on all but top and left sides. */
static Edge edge_of(const int64_t p[2], const int64_t q[2])
{
    Edge e = { .a = p[1] - q[1], .b = q[0] - p[0] };
    e.c = -(e.a * p[0] + e.b * p[1]);
    bool top_left = e.a > 0 || (e.a == 0 && e.b > 0);
    if (!top_left) e.c -= 1;
    e.margin = ((e.a < 0 ? -e.a : e.a) + (e.b < 0 ? -e.b : e.b)) * (FIX / 2);
    return e;
}

static void set_box(Facet *f, const WrZTriangle *t, const WrZSheet *sheet, double dx, double dy)
{
    double box[4] = { t->x[0], t->x[0], t->y[0], t->y[0] };
    f->low = f->high = t->z[0];
    for (int k = 1; k < 3; k++) {
        f->low = t->z[k] < f->low ? t->z[k] : f->low;
        f->high = t->z[k] > f->high ? t->z[k] : f->high;
        box[0] = t->x[k] < box[0] ? t->x[k] : box[0];
        box[1] = t->x[k] > box[1] ? t->x[k] : box[1];
        box[2] = t->y[k] < box[2] ? t->y[k] : box[2];
        box[3] = t->y[k] > box[3] ? t->y[k] : box[3];
    }
    double left = dx - sheet->x, top = dy - sheet->y;
    /* a texel extends half a texel beyond its centre, and corners are rounded by half a unit */
    f->x0 = wr_z_clip(floor_of(box[0] + left + 0.49), 0, sheet->wide);
    f->x1 = wr_z_clip(floor_of(box[1] + left + 0.51), -1, sheet->wide - 1);
    f->y0 = wr_z_clip(floor_of(box[2] + top + 0.49), 0, sheet->high);
    f->y1 = wr_z_clip(floor_of(box[3] + top + 0.51), -1, sheet->high - 1);
}

/* The plane through its corners; slivers have extreme slopes, see facet_z. */
static void set_plane(Facet *f, const WrZTriangle *t, double left, double top)
{
    double x1 = t->x[1] - t->x[0], y1 = t->y[1] - t->y[0], z1 = t->z[1] - t->z[0];
    double x2 = t->x[2] - t->x[0], y2 = t->y[2] - t->y[0], z2 = t->z[2] - t->z[0];
    /* Cramer's rule for z_x, z_y from z1 = z_x x1 + z_y y1 and z2 = z_x x2 + z_y y2. */
    double det = x1 * y2 - x2 * y1;
    f->x = t->x[0] + left;
    f->y = t->y[0] + top;
    f->z = t->z[0];
    f->zx = det != 0.0 ? (z1 * y2 - z2 * y1) / det : 0.0;
    f->zy = det != 0.0 ? (x1 * z2 - x2 * z1) / det : 0.0;
}

/* False for a triangle without area, or outside the tile. */
static bool facet_of(const WrZTriangle *t, const WrZSheet *sheet, double dx, double dy, Facet *f)
{
    set_box(f, t, sheet, dx, dy);
    if (f->x0 > f->x1 || f->y0 > f->y1 || f->high < sheet->floor) return false;
    int64_t p[3][2];
    for (int k = 0; k < 3; k++) {
        p[k][0] = fix(t->x[k] + dx - sheet->x);
        p[k][1] = fix(t->y[k] + dy - sheet->y);
    }
    int64_t area =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    if (area == 0) return false;
    int second = area > 0 ? 1 : 2, third = 3 - second;
    f->edges[0] = edge_of(p[0], p[second]);
    f->edges[1] = edge_of(p[second], p[third]);
    f->edges[2] = edge_of(p[third], p[0]);
    set_plane(f, t, dx - sheet->x, dy - sheet->y);
    return true;
}

/* Heights are clamped between those of the corners; NaN becomes the lowest. */
static double facet_z(const Facet *f, double x, double y)
{
    double z = f->z + (f->zx * (x - f->x) + f->zy * (y - f->y));
    return !(z > f->low) ? f->low : z > f->high ? f->high : z;
}

/* Covered samples of a texel whose centre has the edge values e[3]. */
static unsigned wide_samples(const Facet *f, const int64_t e[3])
{
    unsigned seen = 0;
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        bool in = true;
        for (int k = 0; k < 3; k++)
            in = in && e[k] + (FIX / 16) * (f->edges[k].a * wr_z_samples[s][0] +
                                            f->edges[k].b * wr_z_samples[s][1]) >=
                           0;
        seen |= (unsigned)in << s;
    }
    return seen;
}

/* wide_samples in 32 bits: an edge farther than its margin is on one side of all samples, so its value
   * may be clamped to the margin. The 16 samples lie at multiples of 1/16 texel, one in each row and column of a 16 x 16
   grid, so that near-vertical and near-horizontal edges are resolved in 16 steps. */
static unsigned facet_samples(const Facet *f, const int64_t e[3])
{
    static const int32_t across[WR_Z_SAMPLES] = { 1,  -1, -3, 4,  -5, 2, 5, 3,
                                                  -2, 0,  -4, -6, -8, 7, 6, -7 };
    static const int32_t down[WR_Z_SAMPLES] = { 1, -3, 2,  -1, -2, 5,  3, -5,
                                                6, -7, -6, 4,  0,  -4, 7, -8 };
    int32_t value[3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        const Edge *edge = &f->edges[k];
        if (edge->margin > 1 << 29) return wide_samples(f, e);
        value[k] = (int32_t)(e[k] > edge->margin ? edge->margin : e[k]);
        a[k] = (int32_t)edge->a * (FIX / 16);
        b[k] = (int32_t)edge->b * (FIX / 16);
    }
    int32_t seen = 0;
#pragma omp simd reduction(| : seen)
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        int32_t x = across[s], y = down[s];
        int32_t out = (value[0] + a[0] * x + b[0] * y) | (value[1] + a[1] * x + b[1] * y) |
                      (value[2] + a[2] * x + b[2] * y);
        seen |= out >= 0 ? 1 << s : 0;
    }
    return (unsigned)seen;
}

/* Samples below the floor are not covered. */
static unsigned above_floor(const Facet *f, const WrZSheet *sheet, int x, int y, unsigned seen)
{
    if (f->low >= sheet->floor) return seen;
    for (unsigned left = seen; left; left &= left - 1) {
        int s = __builtin_ctz(left);
        double px = x + wr_z_samples[s][0] / 16.0, py = y + wr_z_samples[s][1] / 16.0;
        if (facet_z(f, px, py) < sheet->floor) seen &= ~(1U << s);
    }
    return seen;
}

static void facet_texel(WrZSheet *sheet, const Facet *f, int x, int y, const int64_t e[3])
{
    bool all = true, centre = true;
    for (int k = 0; k < 3; k++) {
        if (e[k] + f->edges[k].margin < 0) return;
        all = all && e[k] - f->edges[k].margin >= 0;
        centre = centre && e[k] >= 0;
    }
    int at = y * WR_TILE + x;
    unsigned seen = above_floor(f, sheet, x, y, all ? WR_Z_FULL : facet_samples(f, e));
    sheet->mask[at] |= (uint16_t)seen;
    double z = facet_z(f, x, y);
    if (centre && z >= sheet->floor) wr_z_raise(&sheet->depth[at], z);
    else if (seen) {
        const int8_t *s = wr_z_samples[__builtin_ctz(seen)];
        wr_z_raise(&sheet->edge[at], facet_z(f, x + s[0] / 16.0, y + s[1] / 16.0));
    }
}

static int64_t floor_divide(int64_t a, int64_t b) /* b > 0 */
{
    int64_t q = a / b;
    return q - (a % b < 0);
}

/* The texels of a row that may be covered. */
static void row_span(const Facet *f, int y, int *x0, int *x1)
{
    int64_t first = f->x0, last = f->x1;
    for (int k = 0; k < 3; k++) {
        const Edge *edge = &f->edges[k];
        int64_t step = edge->a * FIX, start = edge->b * FIX * y + edge->c + edge->margin;
        if (step > 0) { /* start + step x >= 0 */
            int64_t from = -floor_divide(start, step);
            if (from > first) first = from;
        } else if (step < 0) {
            int64_t to = floor_divide(start, -step);
            if (to < last) last = to;
        } else if (start < 0) {
            last = first - 1;
        }
    }
    *x0 = (int)first;
    *x1 = last < first ? (int)first - 1 : (int)last;
}

/* Draws one image of a primitive, moved by (dx, dy) whole texels. */
static void zsheet_triangle(WrZSheet *sheet, const WrZTriangle *triangle, double dx, double dy)
{
    Facet f;
    if (!facet_of(triangle, sheet, dx, dy, &f)) return;
    for (int y = f.y0; y <= f.y1; y++) {
        int x0 = f.x0, x1 = f.x1;
        if (x1 - x0 >= WIDE) row_span(&f, y, &x0, &x1);
        int64_t e[3];
        for (int k = 0; k < 3; k++)
            e[k] = f.edges[k].a * x0 * FIX + f.edges[k].b * y * FIX + f.edges[k].c;
        for (int x = x0; x <= x1; x++) {
            facet_texel(sheet, &f, x, y, e);
            for (int k = 0; k < 3; k++) e[k] += f.edges[k].a * FIX;
        }
    }
}

/* ---- Drawing of solids in a tile of the depth buffer ---- */

#define SQUARE WR_Z_SQUARE
#define STEP                                                                                       \
    1.0 /* height difference in texels between a texel's centre and its corners above which it
           counts as an edge */

typedef struct Body {
    const WrZSolid *solid;
    double dx, dy; /* from the tile's first texel to the solid's space */
    int x0, x1, y0, y1;
} Body;

/* Heights at positions of the tile; -inf: uncovered, or below the floor. At most WR_Z_SAMPLES + 1. */
static void body_tops(const WrZSheet *sheet, const Body *body, int count, double *x, double *y,
                      double *z)
{
    for (int i = 0; i < count; i++) {
        x[i] += body->dx;
        y[i] += body->dy;
    }
    wr_zsolid_tops(body->solid, count, x, y, z);
    for (int i = 0; i < count; i++) z[i] = z[i] >= sheet->floor ? z[i] : -INFINITY;
}

/* body_tops along a row: from x on, one texel apart. */
static void row_tops(const WrZSheet *sheet, const Body *body, int count, double x, double y,
                     double *z)
{
    double at_x[SQUARE + 1], at_y[SQUARE + 1];
    for (int i = 0; i < count; i++) {
        at_x[i] = x + i;
        at_y[i] = y;
    }
    body_tops(sheet, body, count, at_x, at_y, z);
}

static WrZBlock *block_of(WrZSheet *sheet, int at)
{
    if (!sheet->block[at]) {
        WrZBlock none;
        for (int s = 0; s < WR_Z_SAMPLES; s++) none.z[s] = -INFINITY;
        wr_array_push(&sheet->blocks, none);
        sheet->block[at] = sheet->blocks.count;
    }
    return &sheet->blocks.data[sheet->block[at] - 1];
}

static void meet(WrZSheet *sheet, int at, unsigned seen)
{
    sheet->mask[at] |= (uint16_t)seen;
    if (sheet->bodies[at] < 2) sheet->bodies[at]++;
}

static void draw_body_part(WrZSheet *sheet, const Body *body, int x, int y)
{
    int at = y * WR_TILE + x;
    unsigned seen = 0;
    double at_x[WR_Z_SAMPLES + 1], at_y[WR_Z_SAMPLES + 1], z[WR_Z_SAMPLES + 1];
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        at_x[s] = x + wr_z_samples[s][0] / 16.0;
        at_y[s] = y + wr_z_samples[s][1] / 16.0;
    }
    at_x[WR_Z_SAMPLES] = x;
    at_y[WR_Z_SAMPLES] = y;
    body_tops(sheet, body, WR_Z_SAMPLES + 1, at_x, at_y, z);
    for (int s = 0; s < WR_Z_SAMPLES; s++) seen |= (unsigned)(z[s] > -INFINITY) << s;
    double centre = z[WR_Z_SAMPLES];
    if (centre > -INFINITY) wr_z_raise(&sheet->depth[at], centre);
    else if (seen) wr_z_raise(&sheet->edge[at], z[__builtin_ctz(seen)]);
    if (!seen) return;
    WrZBlock *block = block_of(sheet, at);
    for (int s = 0; s < WR_Z_SAMPLES; s++) wr_z_raise(&block->z[s], z[s]);
    meet(sheet, at, seen);
}

/* z: at its centre, covered. */
static void draw_whole(WrZSheet *sheet, int at, double z)
{
    wr_z_raise(&sheet->depth[at], z);
    wr_z_raise(&sheet->whole[at], z);
    meet(sheet, at, WR_Z_FULL);
}

/* True if an edge of a solid crosses the texel and hides a lower part of the same solid. */
static bool hides_itself(const Body *body, double z, double corners)
{
    return !wr_zsolid_convex(body->solid) && z > -INFINITY && fabs(0.25 * corners - z) > STEP;
}

/* Draws texels one by one: a texel with four covered corners counts as covered. This is exact for
 * convex solids; in others a gap narrower than a texel may close. */
static void draw_texels(WrZSheet *sheet, const Body *body, int x0, int x1, int y0, int y1)
{
    double corners[2][SQUARE + 1], middles[SQUARE];
    for (int y = y0; y <= y1 + 1; y++) {
        double *row = corners[y & 1], *above = corners[(y + 1) & 1];
        row_tops(sheet, body, x1 - x0 + 2, x0 - 0.5, y - 0.5, row);
        if (y > y0) row_tops(sheet, body, x1 - x0 + 1, x0, y - 1, middles);
        for (int x = x0; y > y0 && x <= x1; x++) {
            int k = x - x0, at = (y - 1) * WR_TILE + x;
            double sum = row[k] + row[k + 1] + above[k] + above[k + 1];
            bool all = sum > -INFINITY, edge = all && hides_itself(body, middles[k], sum);
            if (all && !edge && middles[k] > -INFINITY) {
                draw_whole(sheet, at, middles[k]);
                continue;
            }
            if (!all && wr_zsolid_far(body->solid, x + body->dx, y - 1 + body->dy, 0.75)) continue;
            draw_body_part(sheet, body, x, y - 1);
            if (edge) sheet->bodies[at] = 2;
        }
    }
}

/* True if all corners are covered, and so the whole square for a convex solid: the part above the floor
 * and its projection are convex too. */
static bool is_all_covered(const WrZSheet *sheet, const Body *body, int x0, int x1, int y0, int y1)
{
    double x[4] = { x0 - 0.5, x1 + 0.5, x0 - 0.5, x1 + 0.5 };
    double y[4] = { y0 - 0.5, y0 - 0.5, y1 + 0.5, y1 + 0.5 }, z[4];
    if (!wr_zsolid_convex(body->solid)) return false;
    body_tops(sheet, body, 4, x, y, z);
    return z[0] > -INFINITY && z[1] > -INFINITY && z[2] > -INFINITY && z[3] > -INFINITY;
}

static void draw_body_square(WrZSheet *sheet, const Body *body, int x0, int y0)
{
    int x1 = (x0 | (SQUARE - 1)) < body->x1 ? x0 | (SQUARE - 1) : body->x1;
    int y1 = (y0 | (SQUARE - 1)) < body->y1 ? y0 | (SQUARE - 1) : body->y1;
    double mid_x = 0.5 * (x0 + x1) + body->dx, mid_y = 0.5 * (y0 + y1) + body->dy;
    if (wr_zsolid_far(body->solid, mid_x, mid_y, 0.75 * SQUARE)) return;
    sheet->squares++;
    if (!is_all_covered(sheet, body, x0, x1, y0, y1)) {
        draw_texels(sheet, body, x0, x1, y0, y1);
        return;
    }
    for (int y = y0; y <= y1; y++) {
        double row[SQUARE];
        row_tops(sheet, body, x1 - x0 + 1, x0, y, row);
        for (int x = x0; x <= x1; x++) {
            if (row[x - x0] > -INFINITY) draw_whole(sheet, y * WR_TILE + x, row[x - x0]);
            else draw_body_part(sheet, body, x, y);
        }
    }
}

static Body body_of(const WrZSheet *sheet, const WrZSolid *solid, double dx, double dy)
{
    Body body = { .solid = solid, .dx = sheet->x - dx, .dy = sheet->y - dy };
    double x = solid->at[0] - body.dx, y = solid->at[1] - body.dy;
    body.x0 = wr_z_clip(floor(x + solid->left), 0, sheet->wide);
    body.x1 = wr_z_clip(ceil(x + solid->right), -1, sheet->wide - 1);
    body.y0 = wr_z_clip(floor(y + solid->top), 0, sheet->high);
    body.y1 = wr_z_clip(ceil(y + solid->bottom), -1, sheet->high - 1);
    return body;
}

/* Squares are aligned to the tile, so that they do not depend on the bounding box's rounding. */
static void zsheet_solid(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy)
{
    Body body = body_of(sheet, solid, dx, dy);
    for (int y0 = body.y0 - body.y0 % SQUARE; y0 <= body.y1; y0 += SQUARE)
        for (int x0 = body.x0 - body.x0 % SQUARE; x0 <= body.x1; x0 += SQUARE)
            draw_body_square(sheet, &body, x0 > body.x0 ? x0 : body.x0,
                             y0 > body.y0 ? y0 : body.y0);
}

/* Draws only its part in the square whose first texel is (x, y) of the tile. dx, dy may be fractional
 * positions from wr_z_place. */
static void zsheet_solid_at(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy, int x,
                            int y)
{
    Body body = body_of(sheet, solid, dx, dy);
    if (body.x1 < x || body.x0 >= x + SQUARE || body.y1 < y || body.y0 >= y + SQUARE) return;
    draw_body_square(sheet, &body, x > body.x0 ? x : body.x0, y > body.y0 ? y : body.y0);
}

/* Draws it there, where only its height at the centre matters. (x, y): the square's first texel;
 * texels: not 0. */
static void zsheet_ring_at(WrZSheet *sheet, const WrZSolid *ring, double dx, double dy, int x,
                           int y, uint64_t texels)
{
    double at_x[SQUARE * SQUARE], at_y[SQUARE * SQUARE], z[SQUARE * SQUARE];
    int at[SQUARE * SQUARE], count = 0;
    do {
        int k = __builtin_ctzll(texels), i = x + k % SQUARE, j = y + k / SQUARE;
        at[count] = j * WR_TILE + i;
        at_x[count] = i + (sheet->x - dx);
        at_y[count++] = j + (sheet->y - dy);
        texels &= texels - 1;
    } while (texels);
    sheet->squares++;
    wr_zsolid_tops(ring, count, at_x, at_y, z);
    for (int k = 0; k < count; k++) draw_whole(sheet, at[k], z[k]);
}

/* ---- many ---- */

/* Many solids in a tile of the depth buffer. The tile is quartered down to its squares, and in each
   part the solids hidden by another over the whole part are removed; the rest of a square is drawn, the
   highest first. */

#define DEPTH 8    /* greater than the number of subdivisions of a tile, plus one */
#define LEVELS 64  /* height classes for sorting a square's items */
#define OFTEN 4    /* draws after which the settled heights are recomputed */
#define LOOKS 2048 /* bounds computed between cancellation checks */

/* Copies are evaluated with the data of the first of their kind, so that the others are not fetched
   from memory repeatedly. */
typedef struct Item {
    double bound, least;  /* upper and lower bound in the part: see zsolid_range */
    double dx, dy;        /* texels: exact offset from the kind's position */
    const WrZSolid *kind; /* the same solid at another position */
    int32_t entry;        /* below WR_Z_ENTRIES */
} Item;

typedef struct Many {
    WrZSheet *sheet;
    const WrZScene *scene;
    const WrZEntry *entries;
    const WrZGoOn *go_on;
    int squares; /* finished ones */
    int looks;
    bool stopped;
    Item *items[DEPTH]; /* of the present part, of its parent, and so on */
    int32_t *order;     /* of a square's items */
    int64_t room[DEPTH], order_room;
} Many;

static Item *items_at(Many *m, int depth, int64_t count)
{
    if (m->room[depth] < count) {
        wr_free(m->items[depth]);
        m->items[depth] = wr_alloc((size_t)count, sizeof *m->items[depth]);
        m->room[depth] = count;
    }
    return m->items[depth];
}

static int32_t *order_of(Many *m, int64_t count)
{
    if (m->order_room < count) {
        wr_free(m->order);
        m->order = wr_alloc((size_t)count, sizeof *m->order);
        m->order_room = count;
    }
    return m->order;
}

static bool keeps_on(Many *m)
{
    if (++m->looks % LOOKS == 0 &&
        !m->go_on->call(m->go_on->ctx, (double)m->squares / (WR_Z_SQUARES * WR_Z_SQUARES)))
        m->stopped = true;
    return !m->stopped;
}

/* Items of the part (x, y), `side` texels wide: those of `from` that are visible there. Returns their
   * number. The part's `least` is the highest lower bound of all solids that cover it; a solid whose upper bound is not above
   it is hidden everywhere in the part and in all of its quarters. The owner of the bound itself is kept. */
static int64_t sift(Many *m, int x, int y, int side, const Item *from, int64_t count, Item *to)
{
    const WrZSheet *sheet = m->sheet;
    int wide = sheet->wide - x < side ? sheet->wide - x : side;
    int high = sheet->high - y < side ? sheet->high - y : side;
    double least = -INFINITY; /* one of them is at least this high everywhere */
    int64_t kept = 0, seen = 0, owner = -1;
    for (int64_t i = 0; i < count && keeps_on(m); i++) {
        double left = sheet->x + x - from[i].dx - 0.5, top = sheet->y + y - from[i].dy - 0.5, floor;
        const WrZRect rect = { left, top, left + wide, top + high };
        if (from[i].bound < least) continue;
        double bound = zsolid_range(from[i].kind, &rect, &floor);
        if (bound < sheet->floor) continue;
        if (floor > least && floor >= sheet->floor) {
            least = floor;
            owner = from[i].entry;
        }
        to[kept] = from[i];
        to[kept].bound = bound;
        to[kept++].least = floor;
    }
    for (int64_t i = 0; i < kept; i++)
        if (to[i].bound > least || to[i].entry == owner) to[seen++] = to[i];
    return seen;
}

static int level_of(double bound, const double range[2])
{
    double part = (range[1] - bound) / (range[1] - range[0]);
    int level = part > 0.0 ? (int)(part * LEVELS) : 0;
    return level < LEVELS ? level : LEVELS - 1;
}

/* Sorts roughly by their bounds, the highest first. Counting sort into LEVELS classes: an exact order is not needed, since
   each texel keeps the maximum. */
static void sort(const Item *items, int64_t count, int32_t *order)
{
    double range[2] = { INFINITY, -INFINITY };
    int64_t starts[LEVELS + 1] = { 0 };
    for (int64_t i = 0; i < count; i++) {
        double z = items[i].bound;
        range[0] = z < range[0] ? z : range[0];
        range[1] = z > range[1] ? z : range[1];
    }
    for (int64_t i = 0; i < count; i++) starts[level_of(items[i].bound, range) + 1]++;
    for (int k = 0; k < LEVELS; k++) starts[k + 1] += starts[k];
    for (int64_t i = 0; i < count; i++)
        order[starts[level_of(items[i].bound, range)]++] = (int32_t)i;
}

/* State of a square while it is drawn. */
typedef struct Square {
    int x, y; /* its first texel in the tile */
    int drawn;
    double least, settled[WR_Z_SQUARE * WR_Z_SQUARE]; /* see zsheet_settled */
    uint64_t changed;                                 /* texels not yet updated in the band */
    WrZBand band;
} Square;

static void draw_item(Many *m, Square *q, const Item *item)
{
    zsheet_solid_at(m->sheet, item->kind, item->dx, item->dy, q->x, q->y);
    if (++q->drawn % OFTEN == 0) {
        q->least = zsheet_settled(m->sheet, q->x, q->y, q->settled);
        q->changed = ~(uint64_t)0;
    }
}

static void settle(Many *m, Square *q, uint64_t texels)
{
    q->changed |= texels;
    for (; texels; texels &= texels - 1) {
        int k = __builtin_ctzll(texels), x = q->x + k % WR_Z_SQUARE, y = q->y + k / WR_Z_SQUARE;
        q->settled[k] = zsheet_settled_texel(m->sheet, y * WR_TILE + x);
    }
    q->least = INFINITY;
    for (int k = 0; k < WR_Z_SQUARE * WR_Z_SQUARE; k++)
        q->least = q->settled[k] < q->least ? q->settled[k] : q->least;
}

/* For a ring, draws only the texels that it changes. */
static void draw_ring(Many *m, Square *q, const Item *item)
{
    const WrZSolid *ring = item->kind;
    double x = m->sheet->x + q->x - item->dx - ring->at[0];
    double y = m->sheet->y + q->y - item->dy - ring->at[1];
    zband_set(&q->band, ring, m->sheet->floor, q->settled, q->changed);
    q->changed = 0;
    uint64_t met = zband_meets(&q->band, x, y);
    if (!met) return;
    if (!zband_is_within(&q->band, x, y, met)) {
        draw_item(m, q, item);
        return;
    }
    zsheet_ring_at(m->sheet, ring, item->dx, item->dy, q->x, q->y, met);
    settle(m, q, met);
}

static void draw_many_square(Many *m, int x, int y, const Item *items, int64_t count)
{
    int32_t *order = order_of(m, count);
    Square q = { .x = x, .y = y };
    q.least = zsheet_settled(m->sheet, x, y, q.settled);
    sort(items, count, order);
    for (int64_t i = 0; i < count && keeps_on(m); i++) {
        const Item *item = &items[order[i]];
        if (item->bound <= q.least) continue;
        if (zsolid_is_ring(item->kind)) draw_ring(m, &q, item);
        else draw_item(m, &q, item);
    }
    m->squares++;
}

static void draw_many_part(Many *m, int depth, int x, int y, int side, int64_t count)
{
    if (x >= m->sheet->wide || y >= m->sheet->high || m->stopped) return;
    Item *items = items_at(m, depth + 1, count);
    int64_t seen = sift(m, x, y, side, m->items[depth], count, items);
    int half = side / 2;
    if (seen > 0 && side == WR_Z_SQUARE) draw_many_square(m, x, y, items, seen);
    else if (seen > 0)
        for (int k = 0; k < 4; k++)
            draw_many_part(m, depth + 1, x + k % 2 * half, y + k / 2 * half, half, seen);
}

static bool is_kind(const WrZSolid *a, const WrZSolid *b)
{
    return a->shape == b->shape && a->param == b->param && a->letters == b->letters &&
           a->at[2] == b->at[2] && memcmp(a->pose, b->pose, sizeof a->pose) == 0 &&
           memcmp(a->inverse, b->inverse, sizeof a->inverse) == 0;
}

/* At most two kinds alternate: see solid_places. */
static void list_all(const Many *m, int64_t count, Item *all)
{
    const WrZSolid *kinds[2] = { NULL, NULL };
    for (int64_t i = 0; i < count; i++) {
        const WrZEntry *e = &m->entries[i];
        const WrZSolid *solid = &m->scene->solids[e->index];
        bool first = kinds[0] && is_kind(solid, kinds[0]);
        if (!first && !(kinds[1] && is_kind(solid, kinds[1]))) {
            kinds[1] = kinds[0];
            kinds[0] = solid;
            first = true;
        }
        const WrZSolid *kind = kinds[first ? 0 : 1];
        all[i] = (Item){ INFINITY,
                         -INFINITY,
                         e->dx + (solid->at[0] - kind->at[0]),
                         e->dy + (solid->at[1] - kind->at[1]),
                         kind,
                         (int32_t)i };
    }
}

/* Draws the visible images of solids [count]. Drawing hidden ones too would change no bit. False:
   cancelled. */
static bool zsheet_many(WrZSheet *sheet, const WrZScene *scene, const WrZEntry *entries,
                        int64_t count, const WrZGoOn *go_on)
{
    Many m = { .sheet = sheet, .scene = scene, .entries = entries, .go_on = go_on };
    _Static_assert(WR_Z_SQUARE << (DEPTH - 2) >= WR_TILE, "each part has its place in items");
    list_all(&m, count, items_at(&m, 0, count));
    draw_many_part(&m, 0, 0, 0, WR_TILE, count);
    for (int k = 0; k < DEPTH; k++) wr_free(m.items[k]);
    wr_free(m.order);
    return !m.stopped;
}

#define TEXELS (WR_TILE * WR_TILE)
#define BATCH 64     /* tiles between two reports */
#define CHECKED 4096 /* primitives between two checks for cancellation */
#define MANY_SLOW 4
#define MANY 64         /* images in a tile from which on hidden-surface culling pays off */
#define SORT_LEVELS 512 /* height classes for sorting */

typedef struct Bin { /* of a tile */
    int64_t first, count;
} Bin;

typedef struct Box {
    double x0, y0, x1, y1; /* texels, closed */
} Box;

typedef struct Drawing {
    const WrZScene *scene;
    const WrField *like;
    int width, height, tiles_u, tiles_v;
    Bin *bins;         /* [tiles_v][tiles_u] */
    WrZEntry *entries; /* sorted by primitive within each bin; NULL during counting */
    int64_t total;     /* counted so far */
    int *busy;         /* tiles with entries */
    int busy_count;
    int first;                             /* first of the busy tiles being drawn */
    float *heights[BATCH], *covers[BATCH]; /* their texels */
    const WrProgress *progress;
} Drawing;

/* ---- bins ---- */

static Box box_of(const WrZScene *scene, int64_t index)
{
    if (index < scene->solid_count) {
        const WrZSolid *s = &scene->solids[index];
        return (Box){ s->at[0] + s->left, s->at[1] + s->top, s->at[0] + s->right,
                      s->at[1] + s->bottom };
    }
    const WrZTriangle *t = &scene->triangles[index - scene->solid_count];
    Box box = { t->x[0], t->y[0], t->x[0], t->y[0] };
    for (int k = 1; k < 3; k++) {
        box.x0 = t->x[k] < box.x0 ? t->x[k] : box.x0;
        box.x1 = t->x[k] > box.x1 ? t->x[k] : box.x1;
        box.y0 = t->y[k] < box.y0 ? t->y[k] : box.y0;
        box.y1 = t->y[k] > box.y1 ? t->y[k] : box.y1;
    }
    return box;
}

static bool is_in_reach(const WrZScene *scene, int64_t index)
{
    double sum = 0.0;
    if (index < scene->solid_count) {
        Box box = box_of(scene, index);
        return fabs(box.x0) <= WR_Z_REACH && fabs(box.x1) <= WR_Z_REACH &&
               fabs(box.y0) <= WR_Z_REACH && fabs(box.y1) <= WR_Z_REACH &&
               isfinite(scene->solids[index].at[2]);
    }
    const WrZTriangle *t = &scene->triangles[index - scene->solid_count];
    for (int k = 0; k < 3; k++) {
        if (!(fabs(t->x[k]) <= WR_Z_REACH && fabs(t->y[k]) <= WR_Z_REACH)) return false;
        sum += t->z[k];
    }
    return isfinite(sum);
}

static bool check_reach(const WrZScene *scene, int64_t index, WrError *err)
{
    if (is_in_reach(scene, index)) return true;
    bool triangle = index >= scene->solid_count;
    Box box = box_of(scene, index);
    return wr_fail(err,
                   "%s %lld extends from %g,%g to %g,%g texels: must be finite, within %g of 0",
                   triangle ? "triangle" : "solid",
                   (long long)(triangle ? index - scene->solid_count : index) + 1, box.x0, box.y0,
                   box.x1, box.y1, WR_Z_REACH);
}

/* The images along one axis that meet the table: shifted by first, first + 1, ... whole periods. */
static int images(double low, double high, int n, WrWrap wrap, int *first)
{
    *first = 0;
    if (wrap == WR_WRAP_CLAMP) return high >= -1.0 && low <= n;
    *first = (int)ceil((-1.0 - high) / n);
    return (int)floor((n - low) / n) - *first + 1;
}

static int tile_of(double x, int tiles)
{
    double t = floor(x / WR_TILE);
    return t < 0.0 ? 0 : t > tiles - 1 ? tiles - 1 : (int)t;
}

/* Counts an image's tiles, or adds it to their lists. A texel about the box is added on each side: a texel extends half a
   texel beyond its centre, and boxes are rounded. */
static void put_image(Drawing *d, int64_t index, const Box *box, double dx, double dy)
{
    int x0 = tile_of(box->x0 + dx - 1.0, d->tiles_u), x1 = tile_of(box->x1 + dx + 1.0, d->tiles_u);
    int y0 = tile_of(box->y0 + dy - 1.0, d->tiles_v), y1 = tile_of(box->y1 + dy + 1.0, d->tiles_v);
    d->total += (int64_t)(x1 - x0 + 1) * (y1 - y0 + 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            Bin *bin = &d->bins[(size_t)y * (size_t)d->tiles_u + (size_t)x];
            if (d->entries) d->entries[bin->first + bin->count] = (WrZEntry){ index, dx, dy };
            bin->count++;
        }
}

/* Images of a primitive larger than the table: all of the same size, so one represents their number. */
static bool put_all(Drawing *d, WrError *err)
{
    int64_t count = d->scene->solid_count + d->scene->triangle_count;
    for (int64_t index = 0; index < count; index++) {
        if (index % CHECKED == 0 && wr_progress_cancelled(d->progress))
            return wr_fail(err, "cancelled");
        Box box = box_of(d->scene, index);
        int first_x, first_y;
        int nx = images(box.x0, box.x1, d->width, wr_field_wrap_u(d->like), &first_x);
        int ny = images(box.y0, box.y1, d->height, wr_field_wrap_v(d->like), &first_y);
        if (nx <= 0 || ny <= 0) continue;
        if ((int64_t)nx * ny + d->total > WR_Z_ENTRIES)
            return wr_fail(err, "objects larger than the table cover it %lld times: at most %d",
                           (long long)nx * ny, WR_Z_ENTRIES);
        for (int j = 0; j < ny; j++) {
            if (wr_progress_cancelled(d->progress)) return wr_fail(err, "cancelled");
            for (int i = 0; i < nx; i++)
                put_image(d, index, &box, (double)(first_x + i) * d->width,
                          (double)(first_y + j) * d->height);
        }
        if (d->total > WR_Z_ENTRIES)
            return wr_fail(err,
                           "all objects together cover more than %d tiles of the table: use fewer "
                           "or smaller ones",
                           WR_Z_ENTRIES);
    }
    return true;
}

/* Two passes over all primitives: counts per tile, prefix sums, then entries; one array without gaps instead of a list per
   tile. */
static bool fill_bins(Drawing *d, WrError *err)
{
    size_t tiles = (size_t)d->tiles_u * (size_t)d->tiles_v;
    d->bins = wr_alloc(tiles, sizeof *d->bins);
    d->busy = wr_alloc(tiles, sizeof *d->busy);
    if (!put_all(d, err)) return false;
    int64_t total = 0;
    for (size_t i = 0; i < tiles; i++) {
        if (d->bins[i].count) d->busy[d->busy_count++] = (int)i;
        d->bins[i].first = total;
        total += d->bins[i].count;
        d->bins[i].count = 0;
    }
    d->entries = wr_try_alloc((size_t)total + 1, sizeof *d->entries, "a depth buffer's lists", err);
    d->total = 0;
    return d->entries && put_all(d, err);
}

/* ---- tiles ---- */

/* A texel shared by several solids and crossed by the rim of one: the mean over its samples. */
static double mean_depth(const WrZSheet *sheet, int at)
{
    const WrZBlock *block = &sheet->blocks.data[sheet->block[at] - 1];
    double sum = 0.0, whole = sheet->whole[at];
    int count = 0;
    bool hidden = whole > -INFINITY; /* only rims: then the mean must not be rounded */
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        double z = block->z[s] > whole ? block->z[s] : whole;
        hidden = hidden && !(block->z[s] > whole);
        if (!(z > -INFINITY)) continue;
        sum += z;
        count++;
    }
    return hidden ? whole : sum / count;
}

static double depth_at(const WrZSheet *sheet, int at)
{
    if (sheet->bodies[at] > 1 && sheet->block[at]) return mean_depth(sheet, at);
    return sheet->depth[at] > -INFINITY ? sheet->depth[at] : sheet->edge[at];
}

static double cover_at(const WrZSheet *sheet, const WrZScene *scene, int at, double z)
{
    double cover = (double)__builtin_popcount(sheet->mask[at]) / WR_Z_SAMPLES;
    if (!(scene->soft > 0.0)) return cover;
    double t = (z - scene->floor) / scene->soft;
    return t < 1.0 ? cover * (t * t * (3.0 - 2.0 * t)) : cover;
}

static void finish_tile(const Drawing *d, const WrZSheet *sheet, float *heights, float *cover)
{
    for (int y = 0; y < sheet->high; y++)
        for (int x = 0; x < sheet->wide; x++) {
            int at = y * WR_TILE + x;
            if (!sheet->mask[at]) continue;
            double z = depth_at(sheet, at), h = d->scene->offset + d->scene->scale * z;
            heights[at] = isfinite((float)h) ? (float)h : 0.0f;
            cover[at] = (float)cover_at(sheet, d->scene, at, z);
        }
}

static double top_of_triangle(const WrZTriangle *t)
{
    const double *z = t->z;
    return z[0] > z[1] ? (z[0] > z[2] ? z[0] : z[2]) : z[1] > z[2] ? z[1] : z[2];
}

/* Only the thread that started the work may report progress. */
static bool go_on(const Drawing *d, int busy, double part)
{
    if (d->progress && d->progress == wr_progress_here())
        return wr_progress_step(d->progress, (busy + part) / d->busy_count);
    return !wr_progress_cancelled(d->progress);
}

static void draw_entry(const Drawing *d, const WrZEntry *e, WrZSheet *sheet)
{
    int64_t triangle = e->index - d->scene->solid_count;
    if (triangle < 0) zsheet_solid(sheet, &d->scene->solids[e->index], e->dx, e->dy);
    else zsheet_triangle(sheet, &d->scene->triangles[triangle], e->dx, e->dy);
}

typedef struct Going {
    const Drawing *d;
    int busy;
} Going;

static bool tile_goes_on(const void *ctx, double part)
{
    const Going *going = ctx;
    return go_on(going->d, going->busy, part);
}

static void draw_few(const Drawing *d, int busy, const Bin *bin, WrZSheet *sheet)
{
    for (int64_t i = 0; i < bin->count; i++) {
        if (i % 64 == 0 && !go_on(d, busy, (double)i / (double)bin->count)) return;
        draw_entry(d, &d->entries[bin->first + i], sheet);
    }
}

/* Height class, the highest first. */
static int sort_level_of(double bound, const double range[2])
{
    double part = (range[1] - bound) / (range[1] - range[0]);
    int level = part > 0.0 ? (int)(part * SORT_LEVELS) : 0;
    return level < SORT_LEVELS ? level : SORT_LEVELS - 1;
}

/* Sorts triangles roughly by their highest corners, the highest first. False: cancelled. */
static bool sort_triangles(const Drawing *d, int busy, const Bin *bin, double *tops, int32_t *order)
{
    double range[2] = { INFINITY, -INFINITY };
    int64_t starts[SORT_LEVELS + 1] = { 0 };
    for (int64_t i = 0; i < bin->count; i++) {
        if (i % CHECKED == 0 && !go_on(d, busy, 0.0)) return false;
        int64_t index = d->entries[bin->first + i].index - d->scene->solid_count;
        double z = tops[i] = top_of_triangle(&d->scene->triangles[index]);
        range[0] = z < range[0] ? z : range[0];
        range[1] = z > range[1] ? z : range[1];
    }
    for (int64_t i = 0; i < bin->count; i++) starts[sort_level_of(tops[i], range) + 1]++;
    for (int k = 0; k < SORT_LEVELS; k++) starts[k + 1] += starts[k];
    for (int64_t i = 0; i < bin->count; i++)
        order[starts[sort_level_of(tops[i], range)]++] = (int32_t)i;
    return true;
}

/* Draws the highest first, so that hidden ones can be skipped. The order changes no bit: each texel
   keeps only the greatest heights. */
static void draw_many_triangles(const Drawing *d, int busy, const Bin *bin, WrZSheet *sheet)
{
    double *tops = wr_alloc((size_t)bin->count, sizeof *tops), filled = -INFINITY;
    int32_t *order = wr_alloc((size_t)bin->count, sizeof *order);
    bool going = sort_triangles(d, busy, bin, tops, order);
    int drawn = 0;
    for (int64_t i = 0; i < bin->count && going; i++) {
        if (i % 64 == 0) going = go_on(d, busy, (double)i / (double)bin->count);
        if (!going || tops[order[i]] <= filled) continue;
        draw_entry(d, &d->entries[bin->first + order[i]], sheet);
        if (++drawn % 256 == 0) filled = zsheet_filled(sheet);
    }
    wr_free(order);
    wr_free(tops);
}

/* Letters and rings are expensive per texel. */
static int many_of(const Drawing *d, const Bin *solids)
{
    if (solids->count == 0) return MANY;
    const WrZShape shape = d->scene->solids[d->entries[solids->first].index].shape;
    return shape == WR_Z_LETTERS || shape == WR_Z_TORUS ? MANY_SLOW : MANY;
}

static void draw_bin(const Drawing *d, int busy, const Bin *bin, WrZSheet *sheet)
{
    const Going going = { d, busy };
    const WrZGoOn goes_on = { tile_goes_on, &going };
    Bin solids = { bin->first, 0 };
    while (solids.count < bin->count &&
           d->entries[bin->first + solids.count].index < d->scene->solid_count)
        solids.count++;
    Bin triangles = { bin->first + solids.count, bin->count - solids.count };
    const WrZEntry *first = &d->entries[solids.first];
    if (solids.count < many_of(d, &solids)) draw_few(d, busy, &solids, sheet);
    else if (!zsheet_many(sheet, d->scene, first, solids.count, &goes_on)) return;
    if (triangles.count < MANY) draw_few(d, busy, &triangles, sheet);
    else draw_many_triangles(d, busy, &triangles, sheet);
}

static int64_t squares; /* atomic */

int64_t wr_zbuffer_squares(void)
{
    return __atomic_load_n(&squares, __ATOMIC_RELAXED);
}

static void draw_tile(int index, int worker, void *ctx)
{
    (void)worker;
    Drawing *d = ctx;
    int busy = d->first + index, tile = d->busy[busy];
    if (wr_progress_cancelled(d->progress)) return;
    WrZSheet *sheet = wr_alloc(1, sizeof *sheet);
    sheet->x = tile % d->tiles_u * WR_TILE;
    sheet->y = tile / d->tiles_u * WR_TILE;
    sheet->wide = d->width - sheet->x < WR_TILE ? d->width - sheet->x : WR_TILE;
    sheet->high = d->height - sheet->y < WR_TILE ? d->height - sheet->y : WR_TILE;
    sheet->floor = d->scene->floor;
    /* -infinity: nothing here. A texel's final height is depth (the highest at its centre), else edge (the highest at a
       sample where only part of the texel is covered), or the mean over samples if the rims of several solids cross it. */
    for (int i = 0; i < TEXELS; i++) sheet->depth[i] = sheet->edge[i] = sheet->whole[i] = -INFINITY;
    if (d->scene->hidden) draw_few(d, busy, &d->bins[tile], sheet);
    else draw_bin(d, busy, &d->bins[tile], sheet);
    finish_tile(d, sheet, d->heights[index], d->covers[index]);
    __atomic_fetch_add(&squares, sheet->squares, __ATOMIC_RELAXED);
    wr_array_free(&sheet->blocks);
    wr_free(sheet);
}

/* Tiles are allocated batch by batch: for the largest tables all of them would take seconds. */
static bool run_tiles(Drawing *d, const WrGenerateJob *job, WrRelief *relief)
{
    for (d->first = 0; d->first < d->busy_count; d->first += BATCH) {
        const int left = d->busy_count - d->first, count = left < BATCH ? left : BATCH;
        if (!wr_progress_step(job->progress, (double)d->first / d->busy_count)) return false;
        for (int i = 0; i < count; i++) {
            int tx = d->busy[d->first + i] % d->tiles_u, ty = d->busy[d->first + i] / d->tiles_u;
            d->heights[i] = wr_field_tile_write(relief->heights, tx, ty);
            d->covers[i] = wr_field_tile_write(relief->cover, tx, ty);
        }
        wr_pool_run(job->pool, count, draw_tile, d);
    }
    return wr_progress_step(job->progress, 1.0);
}

static bool draw(Drawing *d, const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    WrRelief relief = { 0 };
    WrWrap wrap_u = wr_field_wrap_u(d->like), wrap_v = wr_field_wrap_v(d->like);
    relief.heights = wr_field_new(d->width, d->height, wrap_u, wrap_v, 0.0f, err);
    relief.cover = wr_field_new(d->width, d->height, wrap_u, wrap_v, 0.0f, err);
    bool good = relief.heights && relief.cover;
    if (good && !run_tiles(d, job, &relief)) good = wr_fail(err, "cancelled");
    if (good) *out = relief;
    else wr_relief_fini(&relief);
    return good;
}

bool wr_zbuffer_draw(const WrZScene *scene, const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const WrField *like = job->like;
    for (int64_t i = 0; i < scene->solid_count + scene->triangle_count; i++) {
        if (i % CHECKED == 0 && wr_progress_cancelled(job->progress))
            return wr_fail(err, "cancelled");
        if (!check_reach(scene, i, err)) return false;
    }
    Drawing d = { .scene = scene,
                  .like = like,
                  .width = wr_field_width(like),
                  .height = wr_field_height(like),
                  .tiles_u = wr_field_tiles_u(like),
                  .tiles_v = wr_field_tiles_v(like),
                  .progress = job->progress };
    bool good = fill_bins(&d, err) && draw(&d, job, out, err);
    wr_free(d.bins);
    wr_free(d.busy);
    wr_free(d.entries);
    return good;
}
