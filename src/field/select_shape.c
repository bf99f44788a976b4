/* Selections as shapes: the area that a polygon covers, rectangles, ellipses and lassos, and outlines of a
   selection. */
#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/select.h"
#include "field/select_internal.h"

#include <math.h>
#include <string.h>

/* ---- coverage of a polygon ---- */

/* The area that a polygon and its periodic images cover of each texel.
 *
 * A strip of texel rows is swept from the top. A new band begins wherever a side begins or ends, and at
 * each row's border. Within a band all sides run from top to bottom, so between two neighbours that do
 * not cross there is a trapezoid, whose area in each texel has a closed form. Where neighbours cross,
 * the band is halved until it is about FINEST high; then they are ordered by their positions at
 * mid-height.
 *
 * All numbers are integers: positions in 1/65536 texel, areas in 2^-32 of a texel, summed exactly, so
 * neither the order of sums nor the table's origin can change a bit. */

/* Bands of at most this height are not halved; with many sides the limit grows by FINEST for each MANY
 * of them, so that the worst lasso still finishes. */
#define FINEST (WR_SUB / 512)
#define MANY 64

/* A side of the polygon that is not level; y0 < y1. */
typedef struct Side {
    int64_t x0, y0, x1, y1;
} Side;

/* The part of a side's image inside a strip. */
typedef struct Active {
    int64_t x0, y0; /* upper end, y from the strip's top */
    int64_t dx, dy;
    int32_t from, to; /* y, from the strip's top */
    int image;        /* index of the polygon's image, counted downwards */
} Active;

/* The intersections of a side with a band's upper and lower border. */
typedef struct Cross {
    int64_t top, bottom;
    int image;
} Cross;

typedef struct Span {
    Cross left, right;
} Span;

/* Scratch memory of one thread. */
typedef struct Work {
    int64_t *area; /* [width] of texels that a side passes through */
    int64_t
        *whole; /* [width + 1] change of the area that each texel has in full, from left to right */
    WR_ARRAY(Active) actives; /* sorted by `from` */
    WR_ARRAY(int32_t) events;
    WR_ARRAY(int) current; /* actives in this band */
    WR_ARRAY(Cross) crosses;
    WR_ARRAY(Span) spans;
} Work;

typedef struct Sweep {
    int width, height;
    bool periodic_u, periodic_v;
    bool overlaps; /* images may overlap each other */
    Side *sides;   /* [count] */
    int count;
    Work *work; /* [threads] */
} Sweep;

static int64_t floor_div(int64_t a, int64_t b)
{
    int64_t q = a / b;
    return q * b > a ? q - 1 : q;
}

static int64_t mid2(Cross c) /* twice the middle */
{
    return c.top + c.bottom;
}

static int64_t x_at(const Active *a, int64_t y)
{
    double along = (double)a->dx * (double)(y - a->y0) / (double)a->dy;
    return a->x0 + (int64_t)floor(along + 0.5);
}

static int compare_actives(const void *a, const void *b)
{
    const Active *p = a, *q = b;
    return (p->from > q->from) - (p->from < q->from);
}

static int compare_events(const void *a, const void *b)
{
    int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static int compare_crosses(const void *a, const void *b)
{
    const Cross *p = a, *q = b;
    if (p->image != q->image) return p->image < q->image ? -1 : 1;
    int64_t left = mid2(*p), right = mid2(*q);
    if (left != right) return left < right ? -1 : 1;
    return (p->top > q->top) - (p->top < q->top);
}

static int compare_places(const void *a, const void *b)
{
    const Cross *p = a, *q = b;
    int64_t left = mid2(*p), right = mid2(*q);
    if (left == right) left = p->top, right = q->top;
    return (left > right) - (left < right);
}

static int compare_spans(const void *a, const void *b)
{
    const Span *p = a, *q = b;
    int left = compare_places(&p->left, &q->left);
    return left ? left : compare_places(&p->right, &q->right);
}

/* a is left of b at one border and right of it at the other. */
static bool cross_over(Cross a, Cross b)
{
    return (a.top < b.top && a.bottom > b.bottom) || (a.top > b.top && a.bottom < b.bottom);
}

/* Sides of one image form pairs: the inside is between the first and the second. */
static bool make_spans(Work *work)
{
    bool clean = true;
    work->spans.count = 0;
    for (int i = 0; i + 1 < work->crosses.count; i++) {
        Cross a = work->crosses.data[i], b = work->crosses.data[i + 1];
        if (a.image == b.image && cross_over(a, b)) clean = false;
    }
    for (int i = 0; i + 1 < work->crosses.count; i += 2) {
        Span span = { work->crosses.data[i], work->crosses.data[i + 1] };
        if (span.left.top != span.right.top || span.left.bottom != span.right.bottom)
            wr_array_push(&work->spans, span);
    }
    return clean;
}

static Cross moved(Cross c, int64_t by)
{
    return (Cross){ c.top + by, c.bottom + by, c.image };
}

/* Shifted so that its middle is in the table. */
static Cross wrapped(Cross c, int64_t period)
{
    return period ? moved(c, -floor_div(mid2(c), 2 * period) * period) : c;
}

/* True if any two ends of spans, or their images, cross in the band. They do not if all neighbours in
 * the order at mid-height have the same order at its borders. */
static bool ends_cross(Work *work, int64_t period)
{
    work->crosses.count = 0;
    for (int i = 0; i < work->spans.count; i++) {
        wr_array_push(&work->crosses, wrapped(work->spans.data[i].left, period));
        wr_array_push(&work->crosses, wrapped(work->spans.data[i].right, period));
    }
    Cross *ends = work->crosses.data;
    int count = work->crosses.count;
    if (count == 0) return false;
    qsort(ends, (size_t)count, sizeof *ends, compare_places);
    for (int i = 0; i + 1 < count; i++)
        if (cross_over(ends[i], ends[i + 1])) return true;
    return period && cross_over(ends[count - 1], moved(ends[0], period));
}

/* Merges s into *span, which does not begin later, if they touch at mid-height. */
static bool merge(Span *span, Span s)
{
    if (mid2(s.left) > mid2(span->right)) return false;
    if (compare_places(&s.right, &span->right) > 0) span->right = s.right;
    return true;
}

/* Replaces the spans by their union, on a line (period 0) or around the table. */
static void unite(Work *work, int64_t period)
{
    Span *spans = work->spans.data;
    int count = 0, first = 0;
    if (work->spans.count == 0) return;
    for (int i = 0; i < work->spans.count; i++) {
        Cross left = wrapped(spans[i].left, period);
        spans[i] = (Span){ left, moved(spans[i].right, left.top - spans[i].left.top) };
    }
    qsort(spans, (size_t)work->spans.count, sizeof *spans, compare_spans);
    for (int i = 0; i < work->spans.count; i++)
        if (count == 0 || !merge(&spans[count - 1], spans[i])) spans[count++] = spans[i];
    work->spans.count = count;
    if (!period) return;
    /* it includes the spans that it reaches across the table's edge */
    Span *last = &spans[count - 1];
    for (; first < count - 1; first++)
        if (!merge(last,
                   (Span){ moved(spans[first].left, period), moved(spans[first].right, period) }))
            break;
    if (mid2(last->right) - mid2(last->left) >= 2 * period)
        *last = (Span){ { 0, 0, 0 }, { period, period, 0 } };
    memmove(spans, spans + first, sizeof *spans * (size_t)(count - first));
    work->spans.count = count - first;
}

/* Adds to one texel; its column is reduced to the table. */
static void add_area(const Sweep *sweep, Work *work, int64_t column, int64_t area)
{
    if (sweep->periodic_u) column -= floor_div(column, sweep->width) * sweep->width;
    if (column >= 0 && column < sweep->width) work->area[column] += area;
}

/* Adds to the texels of columns from .. to - 1. */
static void add_whole(const Sweep *sweep, Work *work, int64_t from, int64_t to, int64_t area)
{
    if (to < from) {
        add_whole(sweep, work, to, from, -area);
        return;
    }
    int64_t width = sweep->width;
    if (!sweep->periodic_u) {
        from = from < 0 ? 0 : from > width ? width : from;
        to = to < 0 ? 0 : to > width ? width : to;
        work->whole[from] += area;
        work->whole[to] -= area;
        return;
    }
    int64_t rounds = (to - from) / width, rest = (to - from) % width;
    from -= floor_div(from, width) * width;
    work->whole[0] += rounds * area;
    work->whole[from] += area;
    if (from + rest > width) {
        work->whole[0] += area;
        rest -= width;
    }
    work->whole[from + rest] -= area;
}

/* The area to the right of a side, in a band `high` high, in each texel that the side passes through.
 * With p(X) the part of the band where the side lies left of X, the area in a texel is the integral of p
 * over it; the integral up to X is
 *   high (X - a)^2 / (2 (b - a)) for a <= X <= b,   high (X - (a + b)/2) beyond b.
 * Returns the first column that lies wholly to the right. */
static int64_t add_side(const Sweep *sweep, Work *work, Cross side, int64_t high, int sign)
{
    int64_t a = side.top < side.bottom ? side.top : side.bottom;
    int64_t b = side.top < side.bottom ? side.bottom : side.top;
    int64_t column = floor_div(a, WR_SUB), end = -floor_div(-b, WR_SUB), before = 0;
    for (; column < end; column++) {
        double x = (double)((column + 1) * WR_SUB - a), run = (double)(b - a);
        double integral =
            x < run ? (double)high * (x * x / (2.0 * run)) : (double)high * (x - 0.5 * run);
        int64_t now = (int64_t)floor(integral + 0.5);
        add_area(sweep, work, column, sign * (now - before));
        before = now;
    }
    return end;
}

/* Adds the area of a band; halves the band if its sides cross. */
static void add_band(const Sweep *sweep, Work *work, int32_t top, int32_t bottom)
{
    work->crosses.count = 0;
    for (int i = 0; i < work->current.count; i++) {
        const Active *a = &work->actives.data[work->current.data[i]];
        Cross cross = { x_at(a, top), x_at(a, bottom), a->image };
        wr_array_push(&work->crosses, cross);
    }
    if (work->crosses.count > 1)
        qsort(work->crosses.data, (size_t)work->crosses.count, sizeof(Cross), compare_crosses);
    int64_t period = sweep->periodic_u ? (int64_t)sweep->width * WR_SUB : 0;
    bool clean = make_spans(work) && !(sweep->overlaps && ends_cross(work, period));
    if (!clean && bottom - top > FINEST + FINEST / MANY * work->current.count) {
        int32_t middle = top + (bottom - top) / 2;
        add_band(sweep, work, top, middle);
        add_band(sweep, work, middle, bottom);
        return;
    }
    if (sweep->overlaps) unite(work, period);
    int64_t high = bottom - top;
    for (int i = 0; i < work->spans.count; i++) {
        int64_t from = add_side(sweep, work, work->spans.data[i].left, high, 1);
        int64_t to = add_side(sweep, work, work->spans.data[i].right, high, -1);
        add_whole(sweep, work, from, to, high * WR_SUB);
    }
}

/* Collects the images of a side that reach into rows j .. j + rows - 1. */
static void gather_side(const Sweep *sweep, Work *work, const Side *s, int j, int rows)
{
    int64_t strip = (int64_t)j * WR_SUB, high = (int64_t)rows * WR_SUB;
    int64_t period = (int64_t)sweep->height * WR_SUB, first = 0, last = 0;
    if (sweep->periodic_v) {
        first = floor_div(s->y0 - strip - high, period) + 1;
        last = -floor_div(strip - s->y1, period) - 1;
    }
    for (int64_t k = first; k <= last; k++) {
        int64_t y0 = s->y0 - strip - k * period, y1 = s->y1 - strip - k * period;
        if (y1 <= 0 || y0 >= high) continue;
        Active a = { s->x0,
                     y0,
                     s->x1 - s->x0,
                     s->y1 - s->y0,
                     (int32_t)(y0 < 0 ? 0 : y0),
                     (int32_t)(y1 > high ? high : y1),
                     (int)k };
        wr_array_push(&work->actives, a);
        wr_array_push(&work->events, a.from);
        wr_array_push(&work->events, a.to);
    }
}

/* Selects the sides in the band below `top`; *next is the first that has not begun yet. */
static void step(Work *work, int32_t top, int *next)
{
    int kept = 0;
    for (int i = 0; i < work->current.count; i++) {
        int index = work->current.data[i];
        if (work->actives.data[index].to > top) work->current.data[kept++] = index;
    }
    work->current.count = kept;
    for (; *next < work->actives.count && work->actives.data[*next].from <= top; ++*next)
        wr_array_push(&work->current, *next);
}

/* Outputs one finished row. */
static void put_row(Work *work, int width, float *out)
{
    int64_t whole = 0;
    for (int i = 0; i < width; i++) {
        whole += work->whole[i];
        double covered = (double)(work->area[i] + whole) * 0x1p-32;
        out[i] = (float)(covered < 0.0 ? 0.0 : covered > 1.0 ? 1.0 : covered);
    }
    memset(work->area, 0, sizeof *work->area * (size_t)width);
    memset(work->whole, 0, sizeof *work->whole * (size_t)(width + 1));
}

static bool polygon_rows(void *ctx, int worker, int j, int rows, float *out)
{
    const Sweep *sweep = ctx;
    Work *work = &sweep->work[worker];
    work->actives.count = work->events.count = work->current.count = 0;
    for (int i = 0; i < sweep->count; i++) gather_side(sweep, work, &sweep->sides[i], j, rows);
    if (work->actives.count == 0) return true;
    for (int32_t row = 0; row <= rows; row++) wr_array_push(&work->events, row * WR_SUB);
    qsort(work->actives.data, (size_t)work->actives.count, sizeof(Active), compare_actives);
    qsort(work->events.data, (size_t)work->events.count, sizeof(int32_t), compare_events);
    int next = 0;
    for (int i = 0; i + 1 < work->events.count; i++) {
        int32_t top = work->events.data[i], bottom = work->events.data[i + 1];
        if (top == bottom) continue;
        step(work, top, &next);
        if (work->current.count) add_band(sweep, work, top, bottom);
        if (bottom % WR_SUB == 0)
            put_row(work, sweep->width, out + (size_t)(bottom / WR_SUB - 1) * (size_t)sweep->width);
    }
    return true;
}

/* Stores the sides that are not level, and whether the polygon is larger than the table. */
static void take_sides(Sweep *sweep, const WrSelectVertex *vertices, int count)
{
    WrSelectVertex low = vertices[0], high = vertices[0];
    for (int i = 0; i < count; i++) {
        WrSelectVertex a = vertices[i], b = vertices[i + 1 < count ? i + 1 : 0];
        low.x = a.x < low.x ? a.x : low.x;
        low.y = a.y < low.y ? a.y : low.y;
        high.x = a.x > high.x ? a.x : high.x;
        high.y = a.y > high.y ? a.y : high.y;
        if (a.y < b.y) sweep->sides[sweep->count++] = (Side){ a.x, a.y, b.x, b.y };
        else if (a.y > b.y) sweep->sides[sweep->count++] = (Side){ b.x, b.y, a.x, a.y };
    }
    sweep->overlaps = (sweep->periodic_u && high.x - low.x > (int64_t)sweep->width * WR_SUB) ||
                      (sweep->periodic_v && high.y - low.y > (int64_t)sweep->height * WR_SUB);
}

static void free_work(Work *work)
{
    wr_free(work->area);
    wr_free(work->whole);
    wr_array_free(&work->actives);
    wr_array_free(&work->events);
    wr_array_free(&work->current);
    wr_array_free(&work->crosses);
    wr_array_free(&work->spans);
}

/* The polygon's coverage, even-odd, with its periodic images. */
static WrField *select_polygon(const WrField *like, const WrSelectVertex *vertices, int count,
                               WrPool *pool, WrError *err)
{
    Sweep sweep = { .width = wr_field_width(like),
                    .height = wr_field_height(like),
                    .periodic_u = wr_field_wrap_u(like) == WR_WRAP_PERIODIC,
                    .periodic_v = wr_field_wrap_v(like) == WR_WRAP_PERIODIC };
    sweep.sides = wr_try_alloc((size_t)count, sizeof *sweep.sides, "selection", err);
    if (!sweep.sides) return NULL;
    take_sides(&sweep, vertices, count);
    int threads = wr_pool_threads(pool);
    sweep.work = wr_alloc((size_t)threads, sizeof *sweep.work);
    for (int i = 0; i < threads; i++) {
        sweep.work[i].area = wr_alloc((size_t)sweep.width, sizeof *sweep.work[i].area);
        sweep.work[i].whole = wr_alloc((size_t)sweep.width + 1, sizeof *sweep.work[i].whole);
    }
    WrField *field = wr_select_from_rows(like, 0.0f, polygon_rows, &sweep, pool, NULL, err);
    for (int i = 0; i < threads; i++) free_work(&sweep.work[i]);
    wr_free(sweep.work);
    wr_free(sweep.sides);
    return field;
}

/* ---- rectangles, ellipses and lassos ---- */

static int64_t min64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t max64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* False and an error unless the point is finite and in range. */
static bool select_vertex(const WrField *like, WrSelectPoint point, WrSelectVertex *vertex,
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
    if (!select_vertex(like, a, &p, err) || !select_vertex(like, b, &q, err)) return false;
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
    WrField *field = wr_select_from_rows(like, 0.0f, rectangle_rows, &r, pool, NULL, err);
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
    WrField *field = select_polygon(like, vertices, count, pool, err);
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
        good = select_vertex(like, points[i], &vertices[i], err);
    WrField *field = good ? select_polygon(like, vertices, count, pool, err) : NULL;
    wr_free(vertices);
    return field;
}

/* ---- outlines by marching squares ---- */

/* Outlines by marching squares: cells lie between the centres of four texels; where two neighbours are
   on different sides of 1/2, the outline passes between them. Each such crossing belongs to one loop,
   which is followed from cell to cell with the inside on its left. */

/* Sides of a cell, and corners: side k lies between corners k and k + 1. */
enum { TOP, RIGHT, BOTTOM, LEFT, SIDES };

static const int corner_i[SIDES] = { 0, 1, 1, 0 };
static const int corner_j[SIDES] = { 0, 0, 1, 1 };

/* The cell whose top left corner is the centre of texel (i, j), anywhere in the unrolled plane, and the
 * side through which the loop entered. */
typedef struct Walker {
    int64_t i, j;
    int side;
} Walker;

typedef struct Trace {
    const WrField *field;
    int width, height;
    bool periodic_u, periodic_v;
    int across, down; /* lattice: centres, with a ring of empty ones round clamped axes */
    uint8_t *seen;    /* bits [2][down][across]: visited crossings to the right and down from each
                         centre */
    WR_ARRAY(WrSelectPoint)
    points; /* x, y in texels from the first centre, until finish_points */
    WR_ARRAY(WrOutlineLoop) loops;
    int passed; /* crossings so far, joined or not */
} Trace;

static int64_t wrap64(int64_t i, int64_t n)
{
    int64_t rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* Value of a texel; selections end at clamped edges. */
static float value_at(const Trace *t, int64_t i, int64_t j)
{
    if (t->periodic_u) i = wrap64(i, t->width);
    if (t->periodic_v) j = wrap64(j, t->height);
    if (i < 0 || i >= t->width || j < 0 || j >= t->height) return 0.0f;
    return wr_field_get(t->field, (int)i, (int)j);
}

static float corner(const Trace *t, const Walker *w, int k)
{
    return value_at(t, w->i + corner_i[k % SIDES], w->j + corner_j[k % SIDES]);
}

static bool is_inside(float a)
{
    return a >= 0.5f;
}

/* The side through which a loop that entered by w->side leaves the cell. */
static int way_out(const Trace *t, const Walker *w)
{
    bool in[SIDES + 1];
    float c[SIDES];
    int passages = 0, other = w->side;
    for (int k = 0; k < SIDES; k++) in[k] = is_inside(c[k] = corner(t, w, k));
    in[SIDES] = in[0];
    for (int k = 0; k < SIDES; k++)
        if (in[k] != in[k + 1]) {
            passages++;
            if (k != w->side) other = k;
        }
    if (passages == 2) return other;
    /* A saddle: the loop turns round a corner whose value differs from the middle. Side k joins corners
     * k and k + 1; around corner k it turns to side k - 1, around k + 1 to side k + 1. */
    bool middle = is_inside((c[0] + c[1] + c[2] + c[3]) * 0.25f);
    return in[w->side] != middle ? (w->side + 3) % SIDES : (w->side + 1) % SIDES;
}

/* Lattice index of a side's crossing: from the centre (i, j) to the right, or down. */
static size_t passage_of(const Trace *t, const Walker *w)
{
    int64_t i = w->i + (w->side == RIGHT), j = w->j + (w->side == BOTTOM);
    int64_t column = t->periodic_u ? wrap64(i, t->width) : i + 1;
    int64_t row = t->periodic_v ? wrap64(j, t->height) : j + 1;
    bool down = w->side == RIGHT || w->side == LEFT;
    return ((size_t)down * (size_t)t->down + (size_t)row) * (size_t)t->across + (size_t)column;
}

static bool see(Trace *t, size_t passage)
{
    uint8_t bit = (uint8_t)(1U << passage % 8);
    bool seen = t->seen[passage / 8] & bit;
    t->seen[passage / 8] |= bit;
    return seen;
}

/* Position of the outline on a side, in texels from the first centre. */
static WrSelectPoint point_on(const Trace *t, const Walker *w)
{
    bool level = w->side == TOP || w->side == BOTTOM;
    int64_t i = w->i + (w->side == RIGHT), j = w->j + (w->side == BOTTOM);
    double a = value_at(t, i, j), b = level ? value_at(t, i + 1, j) : value_at(t, i, j + 1);
    double part = (0.5 - a) / (b - a);
    return (WrSelectPoint){ (double)i + (level ? part : 0.0), (double)j + (level ? 0.0 : part) };
}

/* Adds a point to the open loop; removes the previous one if it is in the middle of a straight run. */
static void add_point(Trace *t, int first, WrSelectPoint p)
{
    if (t->points.count - first >= 2) {
        WrSelectPoint *last = &t->points.data[t->points.count - 1], *before = last - 1;
        double ax = last->u - before->u, ay = last->v - before->v;
        double bx = p.u - last->u, by = p.v - last->v;
        if (ax * by == ay * bx && ax * bx + ay * by > 0.0) {
            *last = p;
            return;
        }
    }
    wr_array_push(&t->points, p);
}

/* Moves through `side` into the next cell. */
static void cross_side(Walker *w, int side)
{
    w->i += side == RIGHT ? 1 : side == LEFT ? -1 : 0;
    w->j += side == BOTTOM ? 1 : side == TOP ? -1 : 0;
    w->side = (side + 2) % SIDES;
}

/* Follows one loop from a walker that just entered a cell. */
static bool follow(Trace *t, Walker w, WrError *err)
{
    Walker start = w;
    WrOutlineLoop loop = { .first = t->points.count };
    while (!see(t, passage_of(t, &w))) {
        if (++t->passed > WR_OUTLINE_POINTS)
            return wr_fail(err, "outline of the selection: over %d points, too fine to draw",
                           WR_OUTLINE_POINTS);
        if (t->passed % 65536 == 0 && wr_progress_stopped()) return wr_fail(err, "cancelled");
        add_point(t, loop.first, point_on(t, &w));
        cross_side(&w, way_out(t, &w));
    }
    WrSelectPoint again = t->points.data[loop.first];
    again.u += (double)(w.i - start.i);
    again.v += (double)(w.j - start.j);
    add_point(t, loop.first, again); /* only to test whether the last point is on a straight run */
    loop.count = --t->points.count - loop.first;
    loop.wind_u = (int)((w.i - start.i) / t->width);
    loop.wind_v = (int)((start.j - w.j) / t->height); /* v runs up */
    wr_array_push(&t->loops, loop);
    return true;
}

/* Starts loops at the crossings from the centre (i, j) to the right and down. With the inside on the
 * left, a loop runs down between two neighbours of a row if the right one is inside, and to the right
 * between two of a column if the upper one is. (On the left as seen with v up, and on the page.) */
static bool start_at(Trace *t, int i, int j, WrError *err)
{
    bool here = is_inside(value_at(t, i, j));
    bool right = is_inside(value_at(t, i + 1, j)), below = is_inside(value_at(t, i, j + 1));
    Walker across = { i, right ? j : j - 1, right ? TOP : BOTTOM };
    Walker along = { here ? i : i - 1, j, here ? LEFT : RIGHT };
    size_t seen = passage_of(t, &across);
    if (here != right && !(t->seen[seen / 8] >> seen % 8 & 1) && !follow(t, across, err))
        return false;
    seen = passage_of(t, &along);
    return here == below || t->seen[seen / 8] >> seen % 8 & 1 || follow(t, along, err);
}

/* True if an outline may start in the tile. Not if it and those to its right and below are NULL, except
 * that a table selected everywhere ends at its clamped edges. */
static bool may_start(const Trace *t, int tx, int ty)
{
    int tiles_u = wr_field_tiles_u(t->field), tiles_v = wr_field_tiles_v(t->field);
    int right = (tx + 1) % tiles_u, below = (ty + 1) % tiles_v;
    if (wr_field_tile(t->field, tx, ty) || wr_field_tile(t->field, right, ty) ||
        wr_field_tile(t->field, tx, below))
        return true;
    bool edge_u = !t->periodic_u && (tx == 0 || tx == tiles_u - 1);
    bool edge_v = !t->periodic_v && (ty == 0 || ty == tiles_v - 1);
    return is_inside(wr_field_level(t->field)) && (edge_u || edge_v);
}

/* in[y][x]: texel (i + x, j + y) is inside. Rows and columns 0..WR_TILE + 1; most of them belong to the
 * tile and are read directly. */
typedef struct Patch {
    int i, j, count_i, count_j;
    bool in[WR_TILE + 2][WR_TILE + 2];
} Patch;

static void read_patch(const Trace *t, int tx, int ty, Patch *p)
{
    const float *tile = wr_field_tile(t->field, tx, ty);
    bool level = is_inside(wr_field_level(t->field));
    for (int y = 0; y < p->count_j; y++)
        for (int x = 0; x < p->count_i; x++) {
            int i = p->i + x - tx * WR_TILE, j = p->j + y - ty * WR_TILE;
            bool mine = i >= 0 && i < WR_TILE && j >= 0 && j < WR_TILE && p->i + x < t->width &&
                        p->j + y < t->height;
            if (!mine) p->in[y][x] = is_inside(value_at(t, p->i + x, p->j + y));
            else p->in[y][x] = tile ? is_inside(tile[j * WR_TILE + i]) : level;
        }
}

static bool trace_tile(Trace *t, int tx, int ty, WrError *err)
{
    Patch p;
    /* the ring of empty centres round a clamped table belongs to the tiles at its left and top */
    p.i = tx == 0 && !t->periodic_u ? -1 : tx * WR_TILE;
    p.j = ty == 0 && !t->periodic_v ? -1 : ty * WR_TILE;
    int i1 = (tx + 1) * WR_TILE < t->width ? (tx + 1) * WR_TILE : t->width;
    int j1 = (ty + 1) * WR_TILE < t->height ? (ty + 1) * WR_TILE : t->height;
    p.count_i = i1 + 1 - p.i;
    p.count_j = j1 + 1 - p.j;
    read_patch(t, tx, ty, &p);
    for (int y = 0; y < p.count_j - 1; y++)
        for (int x = 0; x < p.count_i - 1; x++) {
            bool here = p.in[y][x];
            if (here == p.in[y][x + 1] && here == p.in[y + 1][x]) continue;
            if (!start_at(t, p.i + x, p.j + y, err)) return false;
        }
    return true;
}

/* Converts texels to u, v, with each loop's first point in the cell [0,1). */
static void finish_points(Trace *t)
{
    for (int k = 0; k < t->loops.count; k++) {
        WrOutlineLoop loop = t->loops.data[k];
        WrSelectPoint *p = t->points.data + loop.first;
        double i = t->periodic_u ? floor((p->u + 0.5) / t->width) * t->width : 0.0;
        double j = t->periodic_v ? floor((p->v + 0.5) / t->height) * t->height : 0.0;
        for (int n = 0; n < loop.count; n++, p++) {
            p->u = (p->u - i + 0.5) / t->width;
            p->v = 1.0 - (p->v - j + 0.5) / t->height;
        }
    }
}

bool wr_select_outline(const WrField *selection, WrOutline *outline, WrError *err)
{
    Trace t = { .field = selection,
                .width = wr_field_width(selection),
                .height = wr_field_height(selection),
                .periodic_u = wr_field_wrap_u(selection) == WR_WRAP_PERIODIC,
                .periodic_v = wr_field_wrap_v(selection) == WR_WRAP_PERIODIC };
    t.across = t.width + (t.periodic_u ? 0 : 2);
    t.down = t.height + (t.periodic_v ? 0 : 2);
    size_t passages = 2 * (size_t)t.across * (size_t)t.down;
    t.seen = wr_try_alloc(passages / 8 + 1, 1, "outline of the selection", err);
    if (!t.seen) return false;
    bool good = true;
    for (int ty = 0; good && ty < wr_field_tiles_v(selection); ty++) {
        good = !wr_progress_stopped() || wr_fail(err, "cancelled");
        for (int tx = 0; good && tx < wr_field_tiles_u(selection); tx++)
            if (may_start(&t, tx, ty)) good = trace_tile(&t, tx, ty, err);
    }
    wr_free(t.seen);
    if (!good) {
        wr_array_free(&t.points);
        wr_array_free(&t.loops);
        return false;
    }
    finish_points(&t);
    *outline = (WrOutline){ t.points.data, t.loops.data, t.points.count, t.loops.count };
    return true;
}

void wr_outline_fini(WrOutline *outline)
{
    wr_free(outline->points);
    wr_free(outline->loops);
    *outline = (WrOutline){ 0 };
}
