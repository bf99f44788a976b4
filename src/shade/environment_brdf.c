#include "shade/environment_brdf.h"

#include "base/exactmath.h"

#include <math.h>
#include <string.h>

/* Albedos for light from all sides: E(nv) = (1/pi) int (lamp formula) dl, as polynomials in sqrt(nv). A
   blurred picture times this albedo replaces the integral of light times formula (split sum, Karis 2013). */
enum { RINGS = 32, SPOKES = 24 };

/* Contribution of one lamp, as in shade/reflection_body.h: the highlight without ks. n = (0, 0, 1), v =
   (sin, 0, nv). */
typedef struct Place {
    double nl, nv, nh, vh, rv;
} Place;
typedef double Lamp(const WrReflectance *of, const WrMatter *m, Place at);

static double power(double c, double s)
{
    return s > 0 ? wr_pow(fmax(c, 0), s) : 1;
}

static double blinn(const WrReflectance *of, const WrMatter *m, Place at)
{
    (void)of;
    return power(at.nh, m->shininess);
}

static double phong(const WrReflectance *of, const WrMatter *m, Place at)
{
    const double strength = of->energy == WR_ENERGY_PUBLISHED ? 1 : m->scale * at.nl;
    return strength * power(at.rv, m->shininess);
}

/* The form with (eta^2 - 1) / (g + c)^2 equals the textbook's without the difference g - c, which cancels for
   eta near 1; eta = 1 has rs = rp = 0 exactly (HC102). */
static double fresnel(double c, double ior)
{
    const double gg = ior * ior - 1 + c * c;
    if (gg < 0) return 1;
    const double g = sqrt(gg), s = (g + c) * (g + c), p = ior * ior * c + g;
    const double rs = s > 1e-24 ? (ior * ior - 1) / s : 0;
    const double rp = p > 1e-12 ? (ior * ior * c - g) / p : 0;
    return fmin(0.5 * (rs * rs + rp * rp), 1);
}

static double cavities(const WrReflectance *of, const WrMatter *m, Place at)
{
    (void)of;
    const double a2 = m->alpha * m->alpha, w = at.nh * at.nh * (a2 - 1) + 1;
    const double g = fmin(1, fmin(2 * at.nh * at.nv / at.vh, 2 * at.nh * at.nl / at.vh));
    return m->scale * a2 / (w * w) * g * fresnel(at.vh, m->ior) / at.nv;
}

/* (1/pi) of the integral of a lamp's formula over directions, sampled by facet normals h of a GGX
 * distribution of width alpha.
 * With w = 1 + c^2 (a^2 - 1) the density of l is a^2 c / (4 pi w^2 (v.h)); each sample counts its inverse over
 * pi. t^2 (3 - 2t) crowds samples at both ends, 6 t (1 - t) is its derivative. Half of the azimuths: the other
 * half is symmetric. rv = r.v of Phong's mirror direction, 2 (n.l)(n.v) - l.v with l.v = 2 (v.h)^2 - 1. */
static double integral(Lamp *lamp, const WrReflectance *of, const WrMatter *m, double alpha,
                       double nv, bool gated)
{
    const double a2 = alpha * alpha, sv = sqrt(1 - nv * nv);
    double sum = 0;
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SPOKES; j++) {
            const double t = (i + 0.5) / RINGS, f = t * t * (3 - 2 * t); /* of the facets */
            const double c = sqrt((1 - f) / (1 + f * (a2 - 1))), s = sqrt(fmax(0, 1 - c * c));
            const double vh = sv * s * wr_cos(WR_PI * (j + 0.5) / SPOKES) + nv * c;
            const double nl = 2 * vh * c - nv, w = c * c * (a2 - 1) + 1;
            if (vh <= 0 || (gated && nl <= 0)) continue;
            const Place at = { nl, nv, c, vh, 2 * nl * nv - (2 * vh * vh - 1) };
            sum += lamp(of, m, at) * 4 * vh * w * w / (a2 * c) * 6 * t * (1 - t);
        }
    return sum / (RINGS * SPOKES);
}

/* (1/pi) of the integral of (n.l) w(l) over directions, sampled by l.
   nl = sqrt(uniform) is distributed as the cosine, so the mean of w is the integral. */
static double matt_integral(double nv, bool fresnels)
{
    const double sv = sqrt(1 - nv * nv);
    double sum = 0;
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SPOKES; j++) {
            const double nl = sqrt((i + 0.5) / RINGS), sl = sqrt(1 - nl * nl);
            const double lv = sv * sl * wr_cos(WR_PI * (j + 0.5) / SPOKES) + nl * nv;
            const double off = fmax(0, 1 - sqrt(fmax(0, (1 + lv) / 2)));
            const double q = fmax(0, lv - nl * nv) / fmax(nl, nv);
            sum += fresnels ? off * off * off * off * off : q;
        }
    return sum / (RINGS * SPOKES);
}

/* ---- diffuse light ---- */

static double published_ggx(const WrMatter *m, double mu)
{
    return (1 - m->metal) * (1 - m->f0) * (1 - matt_integral(mu, true));
}

/* Fujii's Oren-Nayar, as in shade/reflection_body.h. */
static double matt_albedo(const WrMatter *m, double mu)
{
    const double s = sqrt(fmax(0, 1 - mu * mu));
    const double rest = s * mu * (1 + s + s * s) / (1 + s) - s;
    return m->a + m->b / WR_PI * (s * (wr_acos(mu) - s * mu) + 2.0 / 3 * rest);
}

/* Kept GGX's. x = sqrt(n.v) */
static double remainder_of(const WrMatter *m, double x)
{
    return (1 - m->metal) * (m->again > 0 ? 1 - fmin(wr_albedo_at(m->albedo, x), 1) : 0);
}

static void init_matt(WrEnvironmentBrdf *g, const WrReflectance *of, const WrMatter *m)
{
    const bool published = of->energy == WR_ENERGY_PUBLISHED;
    double x[WR_ALBEDO_TERMS], matt[WR_ALBEDO_TERMS], again[WR_ALBEDO_TERMS] = { 0 };
    wr_albedo_places(x);
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) {
        const double mu = x[i] * x[i];
        switch (wr_reflects[of->model].diffuse) {
        case WR_DIFFUSE_REMAINDER:
            matt[i] = published ? published_ggx(m, mu) : remainder_of(m, x[i]);
            break;
        case WR_DIFFUSE_ROUGH:
            matt[i] = published ? m->a + m->b * matt_integral(mu, false) : matt_albedo(m, mu);
            again[i] = !published && m->again > 0 ? fmax(0, 1 - matt[i]) : 0;
            break;
        case WR_DIFFUSE_LAMBERT: matt[i] = 1; break;
        }
    }
    wr_albedo_fit(matt, g->matt);
    wr_albedo_fit(again, g->again);
    g->mean = m->mean;
}

/* ---- highlights ---- */

/* The lamp formula, and the alpha of the facets over which its integral is taken. NULL: no highlight,
   or one whose albedo has another formula.
   Shininess s has the facet width alpha^2 = 2 / (s + 2): equal D at the peak. */
static Lamp *lamp_of(const WrReflectance *of, const WrMatter *m, double *alpha)
{
    *alpha = sqrt(2 / (m->shininess + 2));
    switch (wr_reflects[of->model].highlight) {
    case WR_HIGHLIGHT_HALF: return blinn;
    case WR_HIGHLIGHT_POWER: return phong;
    case WR_HIGHLIGHT_CAVITIES: *alpha = m->alpha; return cavities;
    case WR_HIGHLIGHT_SMITH: /* wr_ggx_albedo */
    case WR_HIGHLIGHT_NONE: break;
    }
    return NULL;
}

/* An exponent s about the mirror direction is as wide as 4 s of n.h: h turns by half the angle of r. */
static void init_lobe(WrEnvironmentBrdf *g, const WrReflectance *of, const WrMatter *m)
{
    const WrReflectHighlight highlight = wr_reflects[of->model].highlight;
    const bool published = of->energy == WR_ENERGY_PUBLISHED;
    g->power = m->shininess;
    g->alpha = m->alpha;
    switch (highlight) {
    case WR_HIGHLIGHT_NONE: g->lobe = WR_LOBE_NONE; break;
    case WR_HIGHLIGHT_HALF:
        g->lobe = WR_LOBE_HALF;
        g->alpha = sqrt(2 / (g->power + 2));
        break;
    case WR_HIGHLIGHT_POWER:
        g->lobe = WR_LOBE_POWER;
        g->power += published ? 0 : 1; /* its factor n.l, taken into the lobe */
        g->alpha = sqrt(2 / (4 * g->power + 2));
        break;
    case WR_HIGHLIGHT_CAVITIES:
    case WR_HIGHLIGHT_SMITH: g->lobe = WR_LOBE_FACETS; break;
    }
}

/* nv is at least 1e-3, where the kernels bend the normal back too (HC105). */
static void init_shine(WrEnvironmentBrdf *g, const WrReflectance *of, const WrMatter *m, double ks,
                       double tint)
{
    double x[WR_ALBEDO_TERMS], own[WR_ALBEDO_TERMS] = { 0 }, white[WR_ALBEDO_TERMS] = { 0 };
    wr_albedo_places(x);
    double alpha;
    Lamp *const lamp = lamp_of(of, m, &alpha);
    for (int i = 0; i < WR_ALBEDO_TERMS && lamp; i++)
        white[i] = integral(lamp, of, m, alpha, fmax(x[i] * x[i], 1e-3), g->gated);
    const bool smith = wr_reflects[of->model].highlight == WR_HIGHLIGHT_SMITH;
    for (int i = 0; i < WR_ALBEDO_TERMS && smith; i++) {
        double e[2];
        wr_ggx_albedo(m->alpha, x[i] * x[i], e);
        own[i] = m->metal * e[0];
        white[i] = (1 - m->metal) * (m->f0 * e[0] + e[1]) + m->metal * e[1];
    }
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) {
        own[i] = ks * (own[i] + tint * white[i]);
        white[i] *= ks * (1 - tint);
    }
    wr_albedo_fit(own, g->own);
    wr_albedo_fit(white, g->white);
}

static void find_gloss(WrEnvironmentBrdf *g, const WrReflectance *of, const WrMatter *m, double ks,
                       double tint, bool gated)
{
    const WrReflectInfo *model = &wr_reflects[of->model];
    *g = (WrEnvironmentBrdf){ .gated = gated || model->highlight != WR_HIGHLIGHT_HALF };
    g->plain = model->diffuse == WR_DIFFUSE_LAMBERT;
    if (g->plain) g->matt[0] = 1;
    else init_matt(g, of, m);
    init_lobe(g, of, m);
    if (ks > 0 && g->lobe != WR_LOBE_NONE) init_shine(g, of, m, ks, tint);
    else g->lobe = WR_LOBE_NONE;
}

typedef struct Kept {
    WrReflectance of;
    double ks, tint;
    bool gated, there;
    WrEnvironmentBrdf gloss;
} Kept;

static bool same(const Kept *kept, const WrReflectance *of, double ks, double tint, bool gated)
{
    const WrReflectance *own = &kept->of;
    return kept->there && own->model == of->model && own->energy == of->energy &&
           own->shininess == of->shininess && own->roughness == of->roughness &&
           own->metalness == of->metalness && own->ior == of->ior && kept->ks == ks &&
           kept->tint == tint && kept->gated == gated;
}

/* The last few results are cached, since every picture needs them. */
void wr_environment_brdf_init(WrEnvironmentBrdf *g, const WrReflectance *of, const WrMatter *m,
                              double ks, double tint, bool gated)
{
    enum { KEPT = 8 };
    static _Thread_local Kept kept[KEPT];
    static _Thread_local int next;
    int i = 0;
    while (i < KEPT && !same(&kept[i], of, ks, tint, gated)) i++;
    if (i == KEPT) {
        i = next = (next + 1) % KEPT;
        kept[i] = (Kept){ *of, ks, tint, gated, true, { 0 } };
        find_gloss(&kept[i].gloss, of, m, ks, tint, gated);
    }
    *g = kept[i].gloss;
}

/* c is the cosine from the mirror direction r, so n.h = cos of half that angle for n = v = r: nh^2 = (1 + c) /
   2 = 1 - below / 2. */
double wr_environment_brdf_lobe(const WrEnvironmentBrdf *g, double c, double below)
{
    if (g->gated && c <= 0) return 0;
    if (g->lobe == WR_LOBE_POWER) return wr_pow(c, g->power);
    if (g->lobe == WR_LOBE_HALF) return wr_pow(1 - 0.5 * below, 0.5 * g->power);
    /* nh^2 = 1 - below / 2 */
    const double a2 = g->alpha * g->alpha, w = a2 + 0.5 * below * (1 - a2);
    return c * a2 / (w * w);
}
