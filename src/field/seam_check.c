/* Seams of a cell: the test of a table, and the certificate of smoothness. */
#include "field/seam_check.h"

#include "base/memory.h"
#include "base/text.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme_list.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* ---- the seam test ---- */

enum { ROOTS, SQUARES, MAX_MOST, MEANS };

/* The means of each difference along one line. */
typedef struct Line {
    double of[WR_SEAM_DIFFERENCES][MEANS];
} Line;

/* One axis of a cell. Line n is the boundary before texel n. */
typedef struct Axis {
    const WrField *field;
    bool along_v;     /* lines are columns */
    int table;        /* texels of the whole table across the lines */
    int size, length; /* texels of the cell across the lines, and along them */
    int shift;        /* offset of the neighbour along the edge */
} Axis;

/* The n-th of `looks` positions, spread evenly over `length`. */
static int place(int n, int looks, int length)
{
    return (int)((int64_t)n * length / looks);
}

static int fewer(int n)
{
    return n < WR_SEAM_LOOKS ? n : WR_SEAM_LOOKS;
}

/* Reads the texels about the edge at position k along it. The table always wraps here: an axis that
 * ends is judged like a cell repeated by another program. */
static void read_edge(const Axis *a, int k, float t[4])
{
    for (int n = 0; n < 4; n++) {
        const int across = (n - 2 + a->table) % a->table;
        const int along = n < 2 ? (k + a->shift) % a->length : k;
        t[n] = a->along_v ? wr_field_get(a->field, across, along)
                          : wr_field_get(a->field, along, across);
    }
}

/* With four texels across the edge, two on each side, before = t1 - t0, step = t2 - t1, after = t3 - t2:
       STEP   |t2 - t1|                         first difference: a jump of the heights
       BEND   |after - before|                  = |t3 - t2 - t1 + t0|: a jump of the slope
       third  |t3 - 3 t2 + 3 t1 - t0|           a jump of the curvature, and the most sensitive to a jump of heights */
static void add_place(float t0, float t1, float t2, float t3, Line *line)
{
    const double before = (double)t1 - (double)t0, step = (double)t2 - (double)t1,
                 after = (double)t3 - (double)t2;
    const double d[WR_SEAM_DIFFERENCES] = { fabs(step), fabs(after - before),
                                            fabs(after - 2 * step + before) };
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++) {
        line->of[k][ROOTS] += sqrt(d[k]);
        line->of[k][SQUARES] += d[k] * d[k];
        line->of[k][MAX_MOST] = fmax(line->of[k][MAX_MOST], d[k]);
    }
}

/* Converts sums over `places` positions to means. Three means per difference, since a fault may lie along the whole edge or
   at a few places:
       ROOTS (mean of sqrt d)^2, least affected by single peaks; SQUARES sqrt(mean of d^2); MAX_MOST the maximum */
static void finish(Line *line, int places)
{
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++) {
        const double root = line->of[k][ROOTS] / places;
        line->of[k][ROOTS] = root * root;
        line->of[k][SQUARES] = sqrt(line->of[k][SQUARES] / places);
    }
}

static Line measure_edge(const Axis *a)
{
    Line edge = { 0 };
    for (int k = 0; k < a->length; k++) {
        float t[4];
        read_edge(a, k, t);
        add_place(t[0], t[1], t[2], t[3], &edge);
    }
    finish(&edge, a->length);
    return edge;
}

/* Adds the positions of `count` lines, spread over the cell, to their sums: columns row by row, rows
 * four rows each. */
static void add_columns(const Axis *a, int count, Line *lines)
{
    const int places = fewer(a->length), inside = a->size - 3;
    float *row = wr_alloc_unset((size_t)a->size, sizeof *row);
    for (int p = 0; p < places; p++) {
        wr_field_read(a->field, 0, place(p, places, a->length), a->size, 1, row, (size_t)a->size);
        for (int n = 0; n < count; n++) {
            const float *t = row + place(n, count, inside);
            add_place(t[0], t[1], t[2], t[3], &lines[n]);
        }
    }
    wr_free(row);
}

static void add_rows(const Axis *a, int count, Line *lines)
{
    const int places = fewer(a->length), inside = a->size - 3;
    const size_t w = (size_t)a->length;
    float *rows = wr_alloc_unset(4 * w, sizeof *rows);
    for (int n = 0; n < count; n++) {
        wr_field_read(a->field, 0, place(n, count, inside), a->length, 4, rows, w);
        for (int p = 0; p < places; p++) {
            const float *t = rows + place(p, places, a->length);
            add_place(t[0], t[w], t[2 * w], t[3 * w], &lines[n]);
        }
    }
    wr_free(rows);
}

/* Keeps the larger one of each mean. */
static void enlarge(Line *most, const Line *line)
{
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++)
        for (int m = 0; m < MEANS; m++) most->of[k][m] = fmax(most->of[k][m], line->of[k][m]);
}

/* The largest means of the lines inside the cell that do not read across its edges. A line that reads four texels starts at 0
   .. size - 4, so none crosses the cell's edge. `rank` is the fraction of lines inside that bend less than the edge (root
   mean square). Inside, only WR_SEAM_LOOKS lines and positions are sampled; the edge is read completely. */
static Line measure_inside(const Axis *a, const Line *edge, double *rank)
{
    const int count = fewer(a->size - 3);
    Line inside = { 0 }, *lines = wr_alloc((size_t)count, sizeof *lines);
    int less = 0;
    if (a->along_v) add_columns(a, count, lines);
    else add_rows(a, count, lines);
    for (int n = 0; n < count; n++) {
        finish(&lines[n], fewer(a->length));
        enlarge(&inside, &lines[n]);
        less += lines[n].of[WR_SEAM_BEND][SQUARES] < edge->of[WR_SEAM_BEND][SQUARES];
    }
    wr_free(lines);
    *rank = (double)less / count;
    return inside;
}

/* Largest effect of rounding each texel by half a code, in codes: weights 1 1; 1 1 1 1; 1 3 3 1. */
static const double codes[WR_SEAM_DIFFERENCES] = { 1, 2, 4 };

/* The quotient of one mean of difference k at the edge and of difference l inside. Differences within
 * rounding count as 0. */
static double quotient(const Line *seam, int k, const Line *inside, int l, int mean, double noise)
{
    const double rounding = codes[k] * noise;
    return seam->of[k][mean] > rounding ? seam->of[k][mean] / (inside->of[l][mean] + rounding) : 0;
}

/* Selects the mean with the largest quotient. */
static void take_ratio(WrSeamEdge *edge, int k, const Line *seam, const Line *inside, double noise)
{
    int worst = SQUARES;
    for (int m = 0; m < MEANS; m++)
        if (quotient(seam, k, inside, k, m, noise) > quotient(seam, k, inside, k, worst, noise))
            worst = m;
    edge->across[k] = seam->of[k][worst];
    edge->inside[k] = inside->of[k][worst];
    edge->ratio[k] = quotient(seam, k, inside, k, worst, noise);
}

/* A step on a steep slope may be smaller than the slope itself. Its second difference reveals it: that
   * is larger than any change of slope inside, and three times the step. A step of height S on an otherwise smooth line has
   third differences 3 S and second differences S: the bound 4 S > bend separates it from a mere change of slope, whose second
   difference is large with a small first one. */
static bool hidden_step(const WrSeamEdge *edge, const Line *seam, const Line *inside, double noise)
{
    for (int m = 0; m < MEANS; m++)
        if (quotient(seam, WR_SEAM_BEND, inside, WR_SEAM_BEND, m, noise) > edge->limit &&
            quotient(seam, WR_SEAM_BEND, inside, WR_SEAM_SLOPE, m, noise) > edge->limit &&
            4 * seam->of[WR_SEAM_STEP][m] > seam->of[WR_SEAM_BEND][m])
            return true;
    return false;
}

/* A grid of n + 1 points repeats its first line. Mirrored cells also have two equal lines, but no bend
 * between them. */
static bool repeats(const Axis *a, const WrSeamEdge *edge)
{
    bool level = true;
    float first[4], t[4];
    if (edge->ratio[WR_SEAM_BEND] <= edge->limit) return false;
    read_edge(a, 0, first);
    for (int k = 0; k < a->length; k++) {
        read_edge(a, k, t);
        if (t[1] < t[2] || t[1] > t[2]) return false;
        level = level && !(t[1] < first[1] || t[1] > first[1]);
    }
    return !level;
}

static int order_of(const WrSeamEdge *edge, const Line *seam, const Line *inside, double noise)
{
    if (edge->ratio[WR_SEAM_STEP] > edge->limit) return -1;
    if (edge->ratio[WR_SEAM_SLOPE] > edge->limit) return 0;
    if (hidden_step(edge, seam, inside, noise)) return -1;
    if (edge->repeats) return 0;
    return edge->ratio[WR_SEAM_BEND] > edge->limit ? 1 : 2;
}

/* Rounding error of float for the largest height. */
static double float_noise(const Axis *a)
{
    double most = 0;
    for (int k = 0; k < a->length; k++) {
        float t[4];
        read_edge(a, k, t);
        for (int n = 0; n < 4; n++) most = fmax(most, fabs((double)t[n]));
    }
    return 1e-6 * most;
}

static int cell_size(int table, int copies)
{
    return copies > 1 ? table / copies : table;
}

static WrSeamEdge measure(const WrField *field, bool along_v, const WrSeamOptions *o)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int cell_w = cell_size(w, o->copies[0]), cell_h = cell_size(h, o->copies[1]);
    const WrWrap wrap = along_v ? wr_field_wrap_u(field) : wr_field_wrap_v(field);
    const Axis a = { .field = field,
                     .along_v = along_v,
                     .table = along_v ? w : h,
                     .size = along_v ? cell_w : cell_h,
                     .length = along_v ? cell_h : cell_w,
                     .shift = o->shift[along_v ? 0 : 1] };
    WrSeamEdge edge = { .ends = wrap != WR_WRAP_PERIODIC, .order = 2 };
    edge.measured = a.size >= WR_SEAM_MIN && a.length > 0;
    if (!edge.measured) return edge;
    const double noise = o->noise + float_noise(&a);
    const Line seam = measure_edge(&a), inside = measure_inside(&a, &seam, &edge.rank);
    edge.limit = WR_SEAM_CLEARLY + WR_SEAM_FEW / fewer(a.size - 3);
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++) take_ratio(&edge, k, &seam, &inside, noise);
    edge.repeats = repeats(&a, &edge);
    edge.order = order_of(&edge, &seam, &inside, noise);
    return edge;
}

WrSeam wr_seam_measure(const WrField *field, const WrSeamOptions *options)
{
    const WrSeamOptions plain = { 0 }, *o = options ? options : &plain;
    return (WrSeam){ measure(field, true, o), measure(field, false, o) };
}

int wr_seam_worst(const WrSeamEdge *edge)
{
    static const int by_order[] = { WR_SEAM_STEP, WR_SEAM_SLOPE, WR_SEAM_BEND };
    const double *r = edge->ratio;
    if (edge->order < 1 && r[edge->order + 1] <= edge->limit) return WR_SEAM_BEND;
    if (edge->order < 2) return by_order[edge->order + 1];
    return r[WR_SEAM_STEP] >= r[WR_SEAM_SLOPE] ? WR_SEAM_STEP : WR_SEAM_SLOPE;
}

bool wr_seam_shows(const WrSeamEdge *edge)
{
    return edge->order < 1;
}

void wr_seam_text(const WrSeamEdge *edge, WrText *text)
{
    static const char *const names[] = { "height differs", "slope changes",
                                         "second difference changes" };
    const int k = wr_seam_worst(edge);
    if (edge->across[k] <= 0 && edge->inside[k] <= 0) {
        wr_text_add(text, "level ground");
        return;
    }
    wr_text_addf(text,
                 "%s by %.3g across the edge, by %.3g across the worst line inside: %.3g times",
                 names[k], edge->across[k], edge->inside[k], edge->ratio[k]);
}

/* ---- seam continuity: constants ---- */

/* ratio of Catmull-Rom's largest jump between texel centres to that at the centres; see seam_check.h */
#define CATMULL_BETWEEN 1.25
#define FORMULA_SAMPLES 1024 /* samples along an edge */

/* ---- seam continuity of a table ---- */

/* The texels about one edge of one axis: `count` lines along it, 4 taps each in a piece. */
typedef struct Strip {
    const WrField *field;
    WrScheme scheme;
    bool along_v; /* the edge is parallel to v */
    int size;     /* across the edge */
    int length;   /* along it */
} Strip;

/* Reads texels first .. first + 3 across the edge and all along it from -1 to length + 1; as
 * across[along + 1][4]. */
static double *read_piece(const Strip *strip, int first)
{
    const int lines = strip->length + 3;
    const size_t count = (size_t)lines * 4;
    double *out = wr_alloc_unset(count, sizeof *out), *raw = wr_alloc_unset(count, sizeof *raw);
    const int i = strip->along_v ? first : -1, j = strip->along_v ? -1 : first;
    const int w = strip->along_v ? 4 : lines, h = strip->along_v ? lines : 4;
    if (wr_schemes[strip->scheme].taps == WR_TAPS_FITTED) {
        wr_field_read_bspline_coefficients_double(strip->field, i, j, w, h, raw, (size_t)w);
    } else {
        float *texels = wr_alloc_unset(count, sizeof *texels);
        wr_field_read(strip->field, i, j, w, h, texels, (size_t)w);
        for (size_t k = 0; k < count; k++) raw[k] = texels[k];
        wr_free(texels);
    }
    for (int l = 0; l < lines; l++)
        for (int k = 0; k < 4; k++)
            out[4 * l + k] = strip->along_v ? raw[4 * l + k] : raw[k * lines + l];
    wr_free(raw);
    return out;
}

/* Positions within a piece: its start, middle and end. */
enum { START, MIDDLE, END, PLACES };

/* F and F' across the edge, per texel, on one line of a piece. */
typedef struct Look {
    double value[PLACES], slope[PLACES];
} Look;

/* Samples the piece that begins at texel `first`: [length] lines; the caller frees it. */
static Look *look_at(const Strip *strip, int first)
{
    const WrSchemeEval eval = wr_schemes[strip->scheme].eval;
    double *taps = read_piece(strip, first);
    Look *looks = wr_alloc_unset((size_t)strip->length, sizeof *looks);
    for (int l = 0; l < strip->length; l++)
        for (int k = 0; k < PLACES; k++) {
            double got[3];
            eval(taps + (size_t)l * 4, 0.5 * k, 0.0, got);
            looks[l].value[k] = got[0];
            looks[l].slope[k] = got[1];
        }
    wr_free(taps);
    return looks;
}

/* F''. F' of every scheme is a polynomial of degree 2 at most, so three values determine it. */
static double bend(const Look *look, int place)
{
    const double *slope = look->slope;
    const double at_start = -3.0 * slope[START] + 4.0 * slope[MIDDLE] - slope[END];
    const double at_end = slope[START] - 4.0 * slope[MIDDLE] + 3.0 * slope[END];
    return at_start + 0.5 * place * (at_end - at_start);
}

/* The largest jumps so far, and the largest height on either side. */
typedef struct Jumps {
    double jump[WR_CERTIFICATE_ORDERS], most;
} Jumps;

static void raise_to(double *most, double x)
{
    *most = x > *most ? x : *most;
}

/* Compares the piece before with the piece after, at their positions x and y. */
static void compare(const Strip *strip, const Look *before, int x, const Look *after, int y,
                    Jumps *jumps)
{
    for (int l = 0; l < strip->length; l++) {
        const Look *a = before + l, *b = after + l;
        raise_to(&jumps->jump[0], fabs(b->value[y] - a->value[x]));
        raise_to(&jumps->jump[1], fabs(b->slope[y] - a->slope[x]));
        raise_to(&jumps->jump[2], fabs(bend(b, y) - bend(a, x)));
        raise_to(&jumps->most, fabs(a->value[x]));
        raise_to(&jumps->most, fabs(b->value[y]));
    }
}

/* Converts jumps per texel to jumps per unit; jumps within rounding error become 0. */
static void settle(WrCertificateEdge *edge, const double jump[3], double most, int size)
{
    edge->order = -1;
    double scale = 1.0;
    bool joined = true;
    for (int k = 0; k < WR_CERTIFICATE_ORDERS; k++) {
        const bool jumps = jump[k] > 4.0 * FLT_EPSILON * most;
        edge->jump[k] = jumps ? jump[k] * scale : 0.0;
        joined = joined && !jumps;
        if (joined) edge->order = k;
        scale *= size;
    }
}

/* For `nearest` and the schemes centred on texels: the pieces p .. p + 3 texels about the edge, which
 * is between p + 1 and p + 2. */
static void certify_centred(const Strip *strip, int last, Jumps *jumps)
{
    Look *before = look_at(strip, last - 1), *after = look_at(strip, -1);
    compare(strip, before, START, after, START, jumps);
    wr_free(before);
    wr_free(after);
}

/* Compares the edge's own piece with its neighbours at both joints; on an axis that ends, the pieces at
 * both ends. */
static void certify_pieces(const Strip *strip, int last, bool ends, Jumps *jumps)
{
    Look *outer = look_at(strip, last - 2), *left = look_at(strip, last - 1);
    Look *right = ends ? look_at(strip, -2) : left, *inner = look_at(strip, -1);
    if (ends) compare(strip, left, MIDDLE, right, MIDDLE, jumps);
    compare(strip, outer, END, left, START, jumps);
    compare(strip, right, END, inner, START, jumps);
    if (ends) wr_free(right);
    wr_free(outer);
    wr_free(left);
    wr_free(inner);
}

static WrCertificateEdge certify(const Strip *strip, bool ends)
{
    WrCertificateEdge edge = { .ends = ends };
    Jumps jumps = { 0 };
    const int last = ends ? strip->size - 1 : -1;
    if (wr_schemes[strip->scheme].taps == WR_TAPS_CENTRED) certify_centred(strip, last, &jumps);
    else certify_pieces(strip, last, ends, &jumps);
    if (strip->scheme == WR_SCHEME_CATMULL)
        for (int k = 0; k < WR_CERTIFICATE_ORDERS; k++) jumps.jump[k] *= CATMULL_BETWEEN;
    settle(&edge, jumps.jump, jumps.most, strip->size);
    return edge;
}

WrCertificate wr_certificate_table(const WrField *field, WrScheme scheme, const WrSeamOptions *seam)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const Strip u = { field, scheme, true, w, h }, v = { field, scheme, false, h, w };
    return (WrCertificate){ certify(&u, wr_field_wrap_u(field) != WR_WRAP_PERIODIC),
                            certify(&v, wr_field_wrap_v(field) != WR_WRAP_PERIODIC),
                            wr_seam_measure(field, seam) };
}

/* ---- seam continuity of a formula ---- */

/* The k-th derivative of x^n: its value at 1 minus its value at 0. */
static double rise(int n, int k)
{
    double falling = 1.0;
    for (int i = 0; i < k; i++) falling *= n - i;
    return n == k ? 0.0 : falling;
}

static double power(double x, int n)
{
    double out = 1.0;
    while (n-- > 0) out *= x;
    return out;
}

/* Jumps of a polynomial and its derivatives between the edges. */
static WrCertificateEdge certify_polynomial(const WrAnalytic *analytic, bool in_u)
{
    WrCertificateEdge edge = { .ends = false };
    double jump[3] = { 0 }, most = 0.0;
    for (int l = 0; l <= FORMULA_SAMPLES; l++) {
        double sum[3] = { 0 };
        for (int t = 0; t < analytic->count; t++) {
            const WrAnalyticTerm *term = &analytic->terms[t];
            const int across = in_u ? term->i : term->j, along = in_u ? term->j : term->i;
            const double value = term->a * power(l * (1.0 / FORMULA_SAMPLES), along);
            for (int k = 0; k < 3; k++) sum[k] += value * rise(across, k);
            most = fmax(most, fabs(value));
        }
        for (int k = 0; k < 3; k++) jump[k] = fmax(jump[k], fabs(sum[k]));
    }
    settle(&edge, jump, most, 1);
    return edge;
}

WrCertificate wr_certificate_formula(const WrAnalytic *analytic)
{
    /* otherwise the cell contains whole periods */
    const bool polynomial = analytic->kind == WR_ANALYTIC_POLY;
    const WrCertificateEdge whole = { .order = 2 };
    WrCertificate out = { polynomial ? certify_polynomial(analytic, true) : whole,
                          polynomial ? certify_polynomial(analytic, false) : whole,
                          { { 0 }, { 0 } } };
    out.pattern.u.order = out.u.order;
    out.pattern.v.order = out.v.order;
    return out;
}

/* ---- seam continuity as text ---- */

static int lower(int a, int b)
{
    return a < b ? a : b;
}

int wr_certificate_continuity(const WrCertificate *c)
{
    return lower(lower(c->u.order, c->v.order), lower(c->pattern.u.order, c->pattern.v.order));
}

const char *wr_certificate_word(int order)
{
    static const char *const words[] = { "none", "C0", "C1", "C2" };
    return words[order + 1];
}

/* Appends the first break: that of the pattern, or of the scheme. */
static void add_edge(const WrCertificateEdge *edge, const WrSeamEdge *pattern, WrText *text)
{
    static const char *const names[] = { "F", "F'", "F''" };
    const bool torn = pattern->order < edge->order;
    wr_text_add(text, wr_certificate_word(torn ? pattern->order : edge->order));
    if (torn) {
        wr_text_add(text, ", ");
        wr_seam_text(pattern, text);
    } else if (edge->order + 1 < WR_CERTIFICATE_ORDERS) {
        wr_text_addf(text, ", %s jumps by up to %.3g", names[edge->order + 1],
                     edge->jump[edge->order + 1]);
    }
    if (edge->ends) wr_text_add(text, ", the axis ends");
}

void wr_certificate_text(const WrCertificate *certificate, WrText *text)
{
    WrText u = { 0 }, v = { 0 };
    add_edge(&certificate->u, &certificate->pattern.u, &u);
    add_edge(&certificate->v, &certificate->pattern.v, &v);
    if (strcmp(wr_text_get(&u), wr_text_get(&v)) == 0) {
        wr_text_addf(text, "seam %s", wr_text_get(&u));
    } else {
        wr_text_addf(text, "seam in u %s; in v %s", wr_text_get(&u), wr_text_get(&v));
    }
    wr_text_fini(&u);
    wr_text_fini(&v);
}
