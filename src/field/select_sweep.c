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
#include "field/select.h"

#include "base/array.h"
#include "base/error.h"
#include "base/pool.h"
#include "field/field.h"
#include "field/select_internal.h"

#include <math.h>
#include <string.h>

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

WrField *wr_select_polygon(const WrField *like, const WrSelectVertex *vertices, int count,
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
    WrField *field = wr_select_build(like, 0.0f, polygon_rows, &sweep, pool, NULL, err);
    for (int i = 0; i < threads; i++) free_work(&sweep.work[i]);
    wr_free(sweep.work);
    wr_free(sweep.sides);
    return field;
}
