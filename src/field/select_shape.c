/* Rectangles, ellipses and lassos, converted to integers in 1/65536 texel. */
#include "field/select.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/select_internal.h"

#include <math.h>

static int64_t floor_div(int64_t a, int64_t b)
{
    int64_t q = a / b;
    return q * b > a ? q - 1 : q;
}

static int64_t min64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t max64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

bool wr_select_vertex(const WrField *like, WrSelectPoint point, WrSelectVertex *vertex,
                      WrError *err)
{
    if (!(fabs(point.u) <= WR_SELECT_REACH) || !(fabs(point.v) <= WR_SELECT_REACH))
        return wr_fail(err, "point %.9g,%.9g of a selection: each must be %d..%d", point.u, point.v,
                       -WR_SELECT_REACH, WR_SELECT_REACH);
    vertex->x = (int64_t)floor(point.u * wr_field_width(like) * WR_SUB + 0.5);
    vertex->y = (int64_t)floor((1.0 - point.v) * wr_field_height(like) * WR_SUB + 0.5);
    return true;
}

/* The box with corners a and b; low is its top left. */
static bool read_box(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrSelectVertex *low,
                     WrSelectVertex *high, WrError *err)
{
    WrSelectVertex p, q;
    if (!wr_select_vertex(like, a, &p, err) || !wr_select_vertex(like, b, &q, err)) return false;
    *low = (WrSelectVertex){ min64(p.x, q.x), min64(p.y, q.y) };
    *high = (WrSelectVertex){ max64(p.x, q.x), max64(p.y, q.y) };
    return true;
}

/* Coverage of each texel along an axis by the interval a .. b and its images, 0..WR_SUB. */
static void cover_axis(int count, WrWrap wrap, int64_t a, int64_t b, int32_t *cover)
{
    int64_t period = (int64_t)count * WR_SUB;
    bool periodic = wrap == WR_WRAP_PERIODIC;
    if (periodic && b - a >= period) a = 0, b = period;
    int64_t shift = periodic ? floor_div(a, period) * period : 0;
    a -= shift;
    b -= shift;
    for (int i = 0; i < count; i++) {
        int64_t from = (int64_t)i * WR_SUB, to = from + WR_SUB;
        int64_t covered = max64(0, min64(to, b) - max64(from, a));
        if (periodic) covered += max64(0, min64(to, b - period) - max64(from, a - period));
        cover[i] = (int32_t)covered;
    }
}

typedef struct Rectangle {
    int width;
    int32_t *across, *down; /* coverage of columns and rows */
} Rectangle;

/* The images of a product of intervals are the product of the intervals' images, so coverage is the
 * product of the axes' coverages. */
static bool rectangle_rows(void *ctx, int worker, int j, int rows, float *out)
{
    (void)worker;
    const Rectangle *r = ctx;
    for (int y = 0; y < rows; y++) {
        float *row = out + (size_t)y * (size_t)r->width;
        double part = r->down[j + y] * 0x1p-32;
        for (int i = 0; i < r->width; i++) row[i] = (float)(part * r->across[i]);
    }
    return true;
}

WrField *wr_select_rectangle(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrPool *pool,
                             WrError *err)
{
    WrSelectVertex low, high;
    if (!read_box(like, a, b, &low, &high, err)) return NULL;
    int width = wr_field_width(like), height = wr_field_height(like);
    Rectangle r = { width, wr_alloc((size_t)width, sizeof *r.across),
                    wr_alloc((size_t)height, sizeof *r.down) };
    cover_axis(width, wr_field_wrap_u(like), low.x, high.x, r.across);
    cover_axis(height, wr_field_wrap_v(like), low.y, high.y, r.down);
    WrField *field = wr_select_build(like, 0.0f, rectangle_rows, &r, pool, NULL, err);
    wr_free(r.across);
    wr_free(r.down);
    return field;
}

/* Half of low + high plus `offset`, rounded; a shift of both by whole texels shifts the result. */
static int64_t from_middle(int64_t low, int64_t high, double offset)
{
    int64_t half = floor_div(low + high, 2);
    double rest = (low + high - 2 * half) * 0.5;
    return half + (int64_t)floor(offset + rest + 0.5);
}

/* An inscribed polygon. The arc of a side rises r (1 - cos(pi/n)) ~ r pi^2 / (2 n^2) above its chord; n
 * is chosen to make that 1/2048 texel for the larger radius. */
WrField *wr_select_ellipse(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrPool *pool,
                           WrError *err)
{
    WrSelectVertex low, high;
    if (!read_box(like, a, b, &low, &high, err)) return NULL;
    double rx = (double)(high.x - low.x) * 0.5, ry = (double)(high.y - low.y) * 0.5;
    double texels = (rx > ry ? rx : ry) / WR_SUB;
    int count = 16 + (int)ceil(WR_PI * sqrt(1024.0 * texels));
    WrSelectVertex *vertices =
        wr_try_alloc((size_t)count, sizeof *vertices, "elliptic selection", err);
    if (!vertices) return NULL;
    for (int i = 0; i < count; i++) {
        double sine, cosine;
        wr_sincos_turns((double)i / count, &sine, &cosine);
        vertices[i].x = from_middle(low.x, high.x, rx * cosine);
        vertices[i].y = from_middle(low.y, high.y, ry * sine);
    }
    WrField *field = wr_select_polygon(like, vertices, count, pool, err);
    wr_free(vertices);
    return field;
}

WrField *wr_select_lasso(const WrField *like, const WrSelectPoint *points, int count, WrPool *pool,
                         WrError *err)
{
    if (count < 3 || count > WR_SELECT_POINTS) {
        wr_fail(err, "lasso of %d points: must be 3..%d", count, WR_SELECT_POINTS);
        return NULL;
    }
    WrSelectVertex *vertices = wr_try_alloc((size_t)count, sizeof *vertices, "lasso", err);
    if (!vertices) return NULL;
    bool good = true;
    for (int i = 0; good && i < count; i++)
        good = wr_select_vertex(like, points[i], &vertices[i], err);
    WrField *field = good ? wr_select_polygon(like, vertices, count, pool, err) : NULL;
    wr_free(vertices);
    return field;
}
