#include "field/certificate.h"

#include "base/memory.h"
#include "base/text.h"
#include "field/analytic.h"
#include "field/field.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define CATMULL_BETWEEN 1.25 /* of what stands at texels' centres; see certificate.h */
#define FORMULA_LOOKS 1024   /* along an edge */

/* ---- a table ---- */

/* The texels about one edge of one axis: `count` lines along it, 4 taps each in a piece. */
typedef struct Strip {
    const WrField *field;
    WrScheme scheme;
    bool along_v; /* the edge runs along v */
    int size;     /* across the edge */
    int length;   /* along it */
} Strip;

/* Texels first .. first + 3 across the edge and all along it from -1 to length + 1; as across[along + 1][4]. */
static double *read_piece(const Strip *strip, int first)
{
    const int lines = strip->length + 3;
    const size_t count = (size_t)lines * 4;
    double *out = wr_alloc(count, sizeof *out), *raw = wr_alloc(count, sizeof *raw);
    const int i = strip->along_v ? first : -1, j = strip->along_v ? -1 : first;
    const int w = strip->along_v ? 4 : lines, h = strip->along_v ? lines : 4;
    if (wr_schemes[strip->scheme].taps == WR_TAPS_FITTED) {
        wr_field_read_fitted_double(strip->field, i, j, w, h, raw, (size_t)w);
    } else {
        float *texels = wr_alloc(count, sizeof *texels);
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

/* F, F' and F'' across the edge, per texel, on line l at `a` of 0..1 within the piece. F' of the scheme itself is a
   polynomial of degree 2 at most, so that three of it tell F''. */
static void sample(const Strip *strip, const double *piece, int l, double a, double out[3])
{
    double slope[3];
    const WrSchemeEval eval = wr_schemes[strip->scheme].eval;
    for (int k = 0; k < 3; k++) {
        double got[3];
        eval(piece + (size_t)l * 4, 0.5 * k, 0.0, got);
        slope[k] = got[1];
    }
    double got[3];
    eval(piece + (size_t)l * 4, a, 0.0, got);
    out[0] = got[0];
    out[1] = got[1];
    const double at_start = -3.0 * slope[0] + 4.0 * slope[1] - slope[2];
    const double at_end = slope[0] - 4.0 * slope[1] + 3.0 * slope[2];
    out[2] = at_start + a * (at_end - at_start);
}

/* Where piece `before` at a and piece `after` at b are the same place; the largest jumps join jump. */
static void compare(const Strip *strip, int before, double a, int after, double b, double jump[3],
                    double *most)
{
    double *left = read_piece(strip, before), *right = read_piece(strip, after);
    for (int l = 0; l < strip->length; l++) {
        double x[3], y[3];
        sample(strip, left, l, a, x);
        sample(strip, right, l, b, y);
        for (int k = 0; k < 3; k++) jump[k] = fmax(jump[k], fabs(y[k] - x[k]));
        *most = fmax(*most, fmax(fabs(x[0]), fabs(y[0])));
    }
    wr_free(left);
    wr_free(right);
}

/* Jumps per texel become those per unit; smaller ones than rounding leaves are none. */
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

/* Piece p holds texels p .. p + 3, the place being between p + 1 and p + 2; of nearest at p + 1. */
static WrCertificateEdge certify(const Strip *strip, bool ends)
{
    WrCertificateEdge edge = { .ends = ends };
    double jump[3] = { 0 }, most = 0.0;
    const int last = strip->size - 1;
    if (wr_schemes[strip->scheme].taps == WR_TAPS_CENTRED) {
        compare(strip, (ends ? last : -1) - 1, 0.0, -1, 0.0, jump, &most);
    } else {
        if (ends) compare(strip, last - 1, 0.5, -2, 0.5, jump, &most);
        compare(strip, (ends ? last : -1) - 2, 1.0, (ends ? last : -1) - 1, 0.0, jump, &most);
        compare(strip, -2, 1.0, -1, 0.0, jump, &most);
    }
    if (strip->scheme == WR_SCHEME_CATMULL)
        for (int k = 0; k < 3; k++) jump[k] *= CATMULL_BETWEEN;
    settle(&edge, jump, most, strip->size);
    return edge;
}

WrCertificate wr_certificate_table(const WrField *field, WrScheme scheme)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const Strip u = { field, scheme, true, w, h }, v = { field, scheme, false, h, w };
    return (WrCertificate){ certify(&u, wr_field_wrap_u(field) != WR_WRAP_PERIODIC),
                            certify(&v, wr_field_wrap_v(field) != WR_WRAP_PERIODIC) };
}

/* ---- a formula ---- */

/* x^n differentiated k times: its value at 1 less its value at 0. */
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

/* Of a polynomial: what it and its derivatives differ by between the edges, along them. */
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
    if (analytic->kind == WR_ANALYTIC_POLY)
        return (WrCertificate){ certify_polynomial(analytic, true),
                                certify_polynomial(analytic, false) };
    /* whole periods in the cell */
    return (WrCertificate){ { .order = 2 }, { .order = 2 } };
}

/* ---- words ---- */

int wr_certificate_order(const WrCertificate *certificate)
{
    const int u = certificate->u.order, v = certificate->v.order;
    return u < v ? u : v;
}

const char *wr_certificate_word(int order)
{
    static const char *const words[] = { "none", "C0", "C1", "C2" };
    return words[order + 1];
}

/* What is the first to jump. */
static void add_edge(const WrCertificateEdge *edge, WrText *text)
{
    static const char *const names[] = { "F", "F'", "F''" };
    wr_text_add(text, wr_certificate_word(edge->order));
    if (edge->order + 1 < WR_CERTIFICATE_ORDERS)
        wr_text_addf(text, ", %s jumps by up to %.3g", names[edge->order + 1],
                     edge->jump[edge->order + 1]);
    if (edge->ends) wr_text_add(text, ", the axis ends");
}

void wr_certificate_text(const WrCertificate *certificate, WrText *text)
{
    WrText u = { 0 }, v = { 0 };
    add_edge(&certificate->u, &u);
    add_edge(&certificate->v, &v);
    if (strcmp(wr_text_get(&u), wr_text_get(&v)) == 0) {
        wr_text_addf(text, "seam %s", wr_text_get(&u));
    } else {
        wr_text_addf(text, "seam in u %s; in v %s", wr_text_get(&u), wr_text_get(&v));
    }
    wr_text_fini(&u);
    wr_text_fini(&v);
}
