#include "field/certificate.h"

#include "base/memory.h"
#include "field/scheme_list.h"
#include "base/text.h"
#include "field/analytic.h"
#include "field/field.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ratio of Catmull-Rom's largest jump between texel centres to that at the centres; see certificate.h */
#define CATMULL_BETWEEN 1.25
#define FORMULA_LOOKS 1024 /* samples along an edge */

/* ---- a table ---- */

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
        wr_field_read_fitted_double(strip->field, i, j, w, h, raw, (size_t)w);
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

static void enlarge(double *most, double x)
{
    *most = x > *most ? x : *most;
}

/* Compares the piece before with the piece after, at their positions x and y. */
static void compare(const Strip *strip, const Look *before, int x, const Look *after, int y,
                    Jumps *jumps)
{
    for (int l = 0; l < strip->length; l++) {
        const Look *a = before + l, *b = after + l;
        enlarge(&jumps->jump[0], fabs(b->value[y] - a->value[x]));
        enlarge(&jumps->jump[1], fabs(b->slope[y] - a->slope[x]));
        enlarge(&jumps->jump[2], fabs(bend(b, y) - bend(a, x)));
        enlarge(&jumps->most, fabs(a->value[x]));
        enlarge(&jumps->most, fabs(b->value[y]));
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

/* ---- a formula ---- */

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
    for (int l = 0; l <= FORMULA_LOOKS; l++) {
        double sum[3] = { 0 };
        for (int t = 0; t < analytic->count; t++) {
            const WrAnalyticTerm *term = &analytic->terms[t];
            const int across = in_u ? term->i : term->j, along = in_u ? term->j : term->i;
            const double value = term->a * power(l * (1.0 / FORMULA_LOOKS), along);
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

/* ---- text ---- */

static int lower(int a, int b)
{
    return a < b ? a : b;
}

int wr_certificate_order(const WrCertificate *c)
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
