/* Coverage of one texel by outlines. The texel is divided into bands wherever a piece begins or ends or
 * two cross; within a band no two cross, so that between neighbours there are trapezoids. The winding
 * number left of the texel changes at its left border: where a side enters to the right it is one less
 * from there down, and one more where a side leaves. */
#include "generate/text.h"

#include <math.h>
#include <string.h>

#define UNIT ((double)WR_TEXT_UNIT)
#define RIM_MAX (1 << 22)        /* pieces of a strip's rim; far more than in real fonts */
#define MANY 48                  /* pieces; for more, only the winding numbers' areas are summed */
#define EVENTS (2 * MANY + 2048) /* crossings beyond these are ignored */
#define LEAST 1.0                /* units: shorter horizontal rims are ignored */

typedef struct Strand {
    double x0, y0, x1, y1; /* y0 < y1 */
    int sign;              /* +1 where it runs downwards */
    bool border;           /* represents the part left of the texel */
    double from, to;       /* y: the part found to be rim but not output yet; from > to: none */
} Strand;

typedef struct Mark {
    double top, bottom; /* x at the band's upper and lower end */
    int sign;
    bool border;
    int strand; /* index; -1: the texel's border */
} Mark;

typedef struct Span {
    double left, right;
} Span;

typedef struct Texel {
    Strand strands[2 * MANY];
    int strand_count;
    double events[EVENTS];
    int event_count;
    Mark marks[2 * MANY + 1];
    Span ended[MANY + 1]; /* spans of the band above, at its lower end */
    int ended_count;
    int64_t w;
    double area; /* units^2 */
    bool centre;
    const WrTextPiece *cell;
    struct WrTextRim *rim;
} Texel;

static int32_t whole(double x)
{
    return (int32_t)floor(x + 0.5);
}

static void add_rim(Texel *t, double x0, double y0, double x1, double y1)
{
    if (t->rim->pieces.count >= RIM_MAX) return;
    WrTextPiece piece = { whole(x0), whole(y0), whole(x1), whole(y1), t->cell->i, t->cell->j };
    wr_array_push(&t->rim->pieces, piece);
}

/* ---- strands and events ---- */

static void add_strand(Texel *t, double x0, double y0, double x1, double y1, int sign, bool border)
{
    if (y0 == y1) return;
    t->strands[t->strand_count++] = y0 < y1 ? (Strand){ x0, y0, x1, y1, sign, border, 1.0, 0.0 }
                                            : (Strand){ x1, y1, x0, y0, -sign, border, 1.0, 0.0 };
}

static void add_event(Texel *t, double y)
{
    if (y > 0.0 && y < UNIT && t->event_count < EVENTS) t->events[t->event_count++] = y;
}

static void take_piece(Texel *t, const WrTextPiece *p)
{
    add_strand(t, p->x0, p->y0, p->x1, p->y1, 1, false);
    if (p->x0 == 0) add_strand(t, 0.0, p->y0, 0.0, UNIT, -1, true);
    if (p->x1 == 0) add_strand(t, 0.0, p->y1, 0.0, UNIT, 1, true);
    add_event(t, p->y0);
    add_event(t, p->y1);
}

static double x_at(const Strand *s, double y)
{
    if (y <= s->y0) return s->x0;
    if (y >= s->y1) return s->x1;
    return s->x0 + (s->x1 - s->x0) * ((y - s->y0) / (s->y1 - s->y0));
}

/* The crossing of two strands, within their common range. */
static void add_crossing(Texel *t, const Strand *a, const Strand *b)
{
    double top = a->y0 > b->y0 ? a->y0 : b->y0, bottom = a->y1 < b->y1 ? a->y1 : b->y1;
    if (!(top < bottom)) return;
    double above = x_at(a, top) - x_at(b, top), below = x_at(a, bottom) - x_at(b, bottom);
    if (!((above < 0.0 && below > 0.0) || (above > 0.0 && below < 0.0))) return;
    add_event(t, top + (bottom - top) * (above / (above - below)));
}

static void sort_events(Texel *t)
{
    double *e = t->events;
    int kept = 0;
    for (int i = 1; i < t->event_count; i++) {
        double x = e[i];
        int k = i;
        for (; k > 0 && e[k - 1] > x; k--) e[k] = e[k - 1];
        e[k] = x;
    }
    for (int i = 0; i < t->event_count; i++)
        if (kept == 0 || e[i] > e[kept - 1]) e[kept++] = e[i];
    t->event_count = kept;
}

/* ---- bands ---- */

static bool comes_first(const Mark *a, const Mark *b)
{
    double left = a->top + a->bottom, right = b->top + b->bottom;
    if (left != right) return left < right;
    if (a->border != b->border) return a->border;
    if (a->top != b->top) return a->top < b->top;
    return a->sign < b->sign;
}

static int find_marks(Texel *t, double top, double bottom)
{
    int count = 0;
    for (int i = 0; i < t->strand_count; i++) {
        const Strand *s = &t->strands[i];
        if (s->y0 > top || s->y1 < bottom) continue;
        Mark mark = { x_at(s, top), x_at(s, bottom), s->sign, s->border, i };
        int k = count++;
        for (; k > 0 && comes_first(&mark, &t->marks[k - 1]); k--) t->marks[k] = t->marks[k - 1];
        t->marks[k] = mark;
    }
    return count;
}

static void add_level(Texel *t, double left, double right, double y)
{
    if (right - left > LEAST) add_rim(t, left, y, right, y);
}

/* Where one of two bands that meet at y is inside and the other is not, the rim is horizontal. */
static void compare_bands(Texel *t, const Span *next, int count, double y)
{
    int a = 0, b = 0;
    double from = 0.0;
    bool in_a = false, in_b = false;
    while (a < 2 * t->ended_count || b < 2 * count) {
        double at_a = a < 2 * t->ended_count
                          ? (a & 1 ? t->ended[a / 2].right : t->ended[a / 2].left)
                          : 2.0 * UNIT;
        double at_b = b < 2 * count ? (b & 1 ? next[b / 2].right : next[b / 2].left) : 2.0 * UNIT;
        double to = at_a < at_b ? at_a : at_b;
        if (in_a != in_b) add_level(t, from, to, y);
        if (at_a <= at_b) in_a = !in_a, a++;
        else in_b = !in_b, b++;
        from = to;
    }
}

static void put_rim(Texel *t, Strand *s)
{
    if (s->from < s->to) add_rim(t, x_at(s, s->from), s->from, x_at(s, s->to), s->to);
    s->from = 1.0;
    s->to = 0.0;
}

/* Usually a strand stays rim from band to band, and its part is extended. */
static void extend_rim(Texel *t, Strand *s, double top, double bottom)
{
    if (!(s->from < s->to && s->to == top)) {
        put_rim(t, s);
        s->from = top;
    }
    s->to = bottom;
}

static void band(Texel *t, double top, double bottom)
{
    Span begun[MANY + 1], ended[MANY + 1];
    int spans = 0, count = find_marks(t, top, bottom);
    double high = bottom - top, half = 0.5 * UNIT;
    int64_t w = t->w;
    bool has_centre = top <= half && half < bottom, centre = false;
    Mark open = { 0.0, 0.0, 0, true, -1 };
    for (int i = 0; i <= count; i++) {
        const Mark end = { UNIT, UNIT, 0, true, -1 }, *m = i < count ? &t->marks[i] : &end;
        int64_t before = w;
        w += m->sign;
        if (before == 0 && w != 0) open = *m;
        if (before == 0 || (w != 0 && i < count)) continue;
        double at = (half - top) / high;
        double left = open.top + (open.bottom - open.top) * at;
        if (has_centre && left <= half && m->top + (m->bottom - m->top) * at > half) centre = true;
        t->area += 0.5 * high * (m->top + m->bottom - open.top - open.bottom);
        if (!open.border) extend_rim(t, &t->strands[open.strand], top, bottom);
        if (!m->border) extend_rim(t, &t->strands[m->strand], top, bottom);
        if (spans <= MANY) {
            begun[spans] = (Span){ open.top, m->top };
            ended[spans++] = (Span){ open.bottom, m->bottom };
        }
    }
    if (has_centre) t->centre = centre;
    if (top > 0.0) compare_bands(t, begun, spans, top);
    memcpy(t->ended, ended, (size_t)spans * sizeof *ended);
    t->ended_count = spans;
}

/* ---- the texel ---- */

/* For too many pieces: the winding number's mean, which is exact wherever it is 0 or 1. */
static double mean_winding(const WrTextPiece *pieces, int n, int64_t w)
{
    double sum = (double)w;
    for (int i = 0; i < n; i++) {
        const WrTextPiece *p = &pieces[i];
        double high = ((double)p->y1 - p->y0) / UNIT;
        sum += high * (1.0 - 0.5 * ((double)p->x0 + p->x1) / UNIT);
        if (p->x0 == 0) sum -= 1.0 - p->y0 / UNIT;
        if (p->x1 == 0) sum += 1.0 - p->y1 / UNIT;
    }
    sum = fabs(sum);
    return sum < 1.0 ? sum : 1.0;
}

double wr_text_texel(const WrTextPiece *pieces, int n, int64_t w, bool *centre_inside,
                     struct WrTextRim *rim)
{
    if (n > MANY) {
        double part = mean_winding(pieces, n, w);
        for (int i = 0; i < n && rim->pieces.count < RIM_MAX; i++)
            wr_array_push(&rim->pieces, pieces[i]);
        *centre_inside = part >= 0.5;
        return part;
    }
    Texel t;
    t.strand_count = t.event_count = t.ended_count = 0;
    t.w = w;
    t.area = 0.0;
    t.centre = false;
    t.cell = pieces;
    t.rim = rim;
    for (int i = 0; i < n; i++) take_piece(&t, &pieces[i]);
    for (int i = 0; i < t.strand_count; i++)
        for (int k = 0; k < i; k++)
            if (!t.strands[i].border && !t.strands[k].border)
                add_crossing(&t, &t.strands[i], &t.strands[k]);
    sort_events(&t);
    double top = 0.0;
    for (int i = 0; i <= t.event_count; i++) {
        double bottom = i < t.event_count ? t.events[i] : UNIT;
        band(&t, top, bottom);
        top = bottom;
    }
    for (int i = 0; i < t.strand_count; i++) put_rim(&t, &t.strands[i]);
    *centre_inside = t.centre;
    double part = t.area / (UNIT * UNIT);
    return part < 0x1p-14 ? 0.0 : part > 1.0 - 0x1p-14 ? 1.0 : part;
}
