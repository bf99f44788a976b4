/* Drawing of triangles in a tile of the depth buffer. */
#include "generate/zbuffer_tile.h"

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

/* The edge from p to q, inside on the side of the third corner; x right, y down. */
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
 * may be clamped to the margin. */
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

void wr_zsheet_triangle(WrZSheet *sheet, const WrZTriangle *triangle, double dx, double dy)
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
