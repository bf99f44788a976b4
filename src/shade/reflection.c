#include "shade/reflection.h"

#include "base/enum_rows.h"
#include "base/exactmath.h"
#include "shade/reflection_models.h"

#include <math.h>
#include <string.h>

#define ROW(ID, ...) [WR_REFLECT_##ID] = WR_REFLECTION_INFO(ID, __VA_ARGS__),
const WrReflectInfo wr_reflects[] = { WR_REFLECTION_MODELS(ROW) };
const int wr_reflect_count = WR_REFLECT_COUNT;

WR_ROWS(wr_energies);
const char *const wr_energies[WR_ENERGY_COUNT] = {
    [WR_ROW(WR_ENERGY_KEPT)] = "kept",
    [WR_ROW(WR_ENERGY_PUBLISHED)] = "published",
};
WR_ROWS_END(wr_energies, WR_ENERGY_COUNT);

static const double pi = 3.14159265358979323846;

/* ---- GGX: single-scattering albedo ---- */

enum { RINGS = 24, SPOKES = 24, CHECKS = 48 };

/* Normal of a visible facet for the view (sin, 0, mu), from two numbers of 0..1 (Heitz 2018).
   Heitz 2018: stretch the view to a configuration of roughness 1, sample its projected disc, unstretch. s is
   the share of the disc that the visible half of the hemisphere covers. */
static void seen_facet(double alpha, double mu, double radius, double turn, double h[3])
{
    const double across = alpha * sqrt(1 - mu * mu), len = sqrt(across * across + mu * mu);
    const double x = across / len, z = mu / len, s = 0.5 * (1 + z);
    const double t1 = radius * wr_cos(turn), up = sqrt(1 - t1 * t1);
    const double t2 = (1 - s) * up + s * radius * wr_sin(turn);
    const double t3 = sqrt(fmax(0, 1 - t1 * t1 - t2 * t2));
    /* axes: (0,1,0), (-z,0,x), (x,0,z) */
    const double a = alpha * (x * t3 - z * t2), b = alpha * t1, c = fmax(1e-12, z * t3 + x * t2);
    const double inv = 1 / sqrt(a * a + b * b + c * c);
    h[0] = a * inv, h[1] = b * inv, h[2] = c * inv;
}

/* Fraction of the light from this facet to the viewer that other facets do not block: G2 / G1.
   G1 cancels against the density of visible facets; the ratio is bounded by 1 and has no singularity at
   grazing angles. */
static double unmasked(double alpha, double nv, double nl)
{
    const double a2 = alpha * alpha;
    const double v = sqrt(nv * nv * (1 - a2) + a2), l = sqrt(nl * nl * (1 - a2) + a2);
    return nl * (nv + v) / (nl * v + nv * l);
}

/* out[0] + out[1] is the albedo for F = 1; Schlick's F = f0 + (1 - f0) p splits it into the parts times f0 and
   times 1: E = f0 out[0] + out[1], so one integration serves every colour and every f0. */
void wr_ggx_albedo(double alpha, double mu, double out[2])
{
    const double whole = RINGS - 0.5 / RINGS; /* sum of the rings' weights */
    out[0] = out[1] = 0;
    mu = fmax(mu, 1e-6);
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SPOKES; j++) { /* the other half is symmetric */
            /* rings of the disc are narrower towards its rim, where the steep facets are */
            const double t = (i + 0.5) / RINGS, w = t * t;
            double h[3];
            seen_facet(alpha, mu, sqrt(1 - w * w), pi * ((j + 0.5) / SPOKES - 0.5), h);
            const double vh = sqrt(1 - mu * mu) * h[0] + mu * h[2], nl = 2 * vh * h[2] - mu;
            if (nl <= 0 || vh <= 0) continue;
            const double off = 1 - fmin(vh, 1), p = off * off * off * off * off;
            const double share = 4 * w * t * unmasked(alpha, mu, nl) / (whole * SPOKES);
            out[0] += (1 - p) * share;
            out[1] += p * share;
        }
}

/* By Newton's divided differences.
   Interpolation at Chebyshev nodes (wr_albedo_places), converted to powers of x; 11 terms in 0..1 keep enough
   digits in double. */
static void fit(const double x[WR_ALBEDO_TERMS], double y[WR_ALBEDO_TERMS],
                double out[WR_ALBEDO_TERMS])
{
    const int n = WR_ALBEDO_TERMS;
    for (int k = 1; k < n; k++)
        for (int i = n - 1; i >= k; i--) y[i] = (y[i] - y[i - 1]) / (x[i] - x[i - k]);
    memset(out, 0, (size_t)n * sizeof *out);
    for (int k = n - 1; k >= 0; k--) {
        for (int i = n - 1; i > 0; i--) out[i] = out[i - 1] - x[k] * out[i];
        out[0] = y[k] - x[k] * out[0];
    }
}

void wr_albedo_places(double x[WR_ALBEDO_TERMS])
{
    for (int i = 0; i < WR_ALBEDO_TERMS; i++)
        x[i] = 0.5 - 0.5 * wr_cos(pi * (i + 0.5) / WR_ALBEDO_TERMS);
}

void wr_albedo_fit(double y[WR_ALBEDO_TERMS], double out[WR_ALBEDO_TERMS])
{
    double x[WR_ALBEDO_TERMS];
    wr_albedo_places(x);
    fit(x, y, out);
}

double wr_albedo_at(const double terms[WR_ALBEDO_TERMS], double x)
{
    double sum = 0;
    for (int i = WR_ALBEDO_TERMS - 1; i >= 0; i--) sum = sum * x + terms[i];
    return sum;
}

typedef struct Albedo {
    double alpha;
    double part[2][WR_ALBEDO_TERMS]; /* as wr_ggx_albedo's */
    double check[2][CHECKS];         /* albedos at points between the nodes */
} Albedo;

static double between(int i)
{
    return (i + 0.5) / CHECKS;
}

static void find_albedo(double alpha, Albedo *out)
{
    double x[WR_ALBEDO_TERMS], y[2][WR_ALBEDO_TERMS], e[2];
    wr_albedo_places(x);
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) {
        wr_ggx_albedo(alpha, x[i] * x[i], e);
        y[0][i] = e[0], y[1][i] = e[1];
    }
    for (int i = 0; i < CHECKS; i++) {
        wr_ggx_albedo(alpha, between(i) * between(i), e);
        out->check[0][i] = e[0], out->check[1][i] = e[1];
    }
    wr_albedo_fit(y[0], out->part[0]);
    wr_albedo_fit(y[1], out->part[1]);
    out->alpha = alpha;
}

/* The last few widths are cached, since every picture needs them. */
static const Albedo *albedo_of(double alpha)
{
    enum { KEPT = 8 };
    static _Thread_local Albedo kept[KEPT];
    static _Thread_local int next;
    for (int i = 0; i < KEPT; i++)
        if (kept[i].alpha == alpha) return &kept[i];
    next = (next + 1) % KEPT;
    find_albedo(alpha, &kept[next]);
    return &kept[next];
}

/* Raises the polynomial so that it is nowhere below the albedo, mostly towards grazing angles, where
   the error is largest: then the remainder for diffuse light is never too large.
   `more` is 0.02 + (1 - x^2)^5, in powers of x. */
static void raise_fit(double *terms, const Albedo *albedo, double f0)
{
    static const double more[WR_ALBEDO_TERMS] = { 1.02, 0, -5, 0, 10, 0, -10, 0, 5, 0, -1 };
    double most = 0; /* more: .02 + (1 - mu)^5 */
    for (int i = 0; i < CHECKS; i++) {
        const double exact = f0 * albedo->check[0][i] + albedo->check[1][i];
        const double low = exact - wr_albedo_at(terms, between(i));
        most = fmax(most, low / wr_albedo_at(more, between(i)));
    }
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) terms[i] += most * more[i];
    terms[0] += 1e-4 + 1e-3 * f0; /* error of the quadrature */
}

/* mean = 2 int E(mu) mu dmu; with mu = x^2 a term x^i integrates to 4 / (i + 4). A furnace with E_s + c (1 -
   E_s) is then never above 1 (HC103). */
static void init_ggx(WrMatter *m)
{
    const Albedo *albedo = albedo_of(m->alpha);
    for (int i = 0; i < WR_ALBEDO_TERMS; i++)
        m->albedo[i] = m->f0 * albedo->part[0][i] + albedo->part[1][i];
    raise_fit(m->albedo, albedo, m->f0);
    m->mean = 0; /* 2 E(mu) mu dmu = 4 E x^3 dx */
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) m->mean += 4 * m->albedo[i] / (i + 4);
    m->again = m->mean < 1 - 1e-6 ? 1 / (1 - m->mean) : 0;
}

/* ---- other models ---- */

/* Oren and Nayar 1994, the qualitative model; kept: as improved by Fujii, with interreflection. */
static void init_oren_nayar(WrMatter *m, bool published)
{
    const double s = m->sigma, ss = s * s;
    if (published) {
        m->a = 1 - 0.5 * ss / (ss + 0.33), m->b = 0.45 * ss / (ss + 0.09);
        return;
    }
    m->a = 1 / (1 + (0.5 - 2 / (3 * pi)) * s);
    m->b = m->a * s;
    m->mean = m->a * (1 + (2.0 / 3 - 28 / (15 * pi)) * s);
    m->again = s > 1e-6 ? 1 / (1 - m->mean) : 0;
}

static double within(double x, double low, double high)
{
    return x > low ? (x < high ? x : high) : low;
}

/* All inputs are clamped here, once (HC100, HC110); NaN becomes the lower bound because comparisons with it
   are false. */
void wr_matter_init(WrMatter *m, const WrReflectance *of)
{
    const bool published = of->energy == WR_ENERGY_PUBLISHED;
    const double rough = within(of->roughness, 0, 1);
    *m = (WrMatter){ .shininess = within(of->shininess, 0, 1e6),
                     .scale = 1,
                     .alpha = fmax(rough * rough, WR_ALPHA_MIN),
                     .ior = within(of->ior, 0.01, 1e4),
                     .metal = within(of->metalness, 0, 1),
                     .sigma = rough };
    const double f = (m->ior - 1) / (m->ior + 1);
    m->f0 = f * f;
    const WrReflectInfo *model = &wr_reflects[of->model];
    switch (model->highlight) {
    case WR_HIGHLIGHT_POWER:
        if (!published) m->scale = 0.5 * (m->shininess + 2);
        break;
    case WR_HIGHLIGHT_CAVITIES: m->scale = published ? m->alpha * m->alpha : 0.25; break;
    case WR_HIGHLIGHT_NONE:
    case WR_HIGHLIGHT_HALF:
    case WR_HIGHLIGHT_SMITH: break;
    }
    switch (model->diffuse) {
    case WR_DIFFUSE_ROUGH: init_oren_nayar(m, published); break;
    case WR_DIFFUSE_REMAINDER:
        if (!published) init_ggx(m);
        break;
    case WR_DIFFUSE_LAMBERT: break;
    }
}
