/* Bounds of the heights of solids over a part of a tile, and the minimum height to be visible there:
   hidden solids are not drawn. This never changes a visible bit. */
#include "generate/zbuffer_tile.h"

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
   side than on the other. A vertical line is a + b z there, and a depends only on x and y. */
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

double wr_zsolid_range(const WrZSolid *s, const WrZRect *r, double *least)
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

bool wr_zsolid_is_ring(const WrZSolid *s)
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

void wr_zband_set(WrZBand *band, const WrZSolid *s, double floor, const double *settled,
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

uint64_t wr_zband_meets(const WrZBand *band, double x, double y)
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

bool wr_zband_is_within(const WrZBand *band, double x, double y, uint64_t texels)
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
double wr_zsheet_settled_texel(const WrZSheet *sheet, int at)
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

double wr_zsheet_settled(const WrZSheet *sheet, int x, int y,
                         double settled[WR_Z_SQUARE * WR_Z_SQUARE])
{
    double least = INFINITY;
    for (int j = 0; j < WR_Z_SQUARE; j++)
        for (int i = 0; i < WR_Z_SQUARE; i++) {
            bool there = x + i < sheet->wide && y + j < sheet->high;
            double z = there ? wr_zsheet_settled_texel(sheet, (y + j) * WR_TILE + x + i) : INFINITY;
            settled[j * WR_Z_SQUARE + i] = z;
            least = z < least ? z : least;
        }
    return least;
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
