#include "render/reference/reference_reflection.h"

#include "shade/reflection_models.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Cosines of lamp and viewer relative to the microfacets' normal. */
typedef struct Facing {
    double nl, nv, nh, vh;
    double c, s; /* cosine and sine of the angle between n and h */
} Facing;

static double dot(WrVec3 a, WrVec3 b)
{
    return v3_dot(a, b);
}

static WrVec3 unit_of(WrVec3 a)
{
    return v3_scale(a, 1 / sqrt(dot(a, a)));
}

/* Rule for normals that bump turned away from the viewer. */
static WrVec3 bent_back(WrVec3 n, WrVec3 v)
{
    const double short_of = 1e-3 - dot(n, v);
    return short_of > 0 ? unit_of(v3_mad(n, v, short_of)) : n;
}

/* False where microfacets reflect nothing. */
static bool face(WrVec3 n, WrVec3 l, WrVec3 v, Facing *out)
{
    const WrVec3 seen = bent_back(n, v), sum = v3_add(l, v);
    if (!(dot(sum, sum) > 1e-12) || !(dot(n, l) > 0) || !(dot(seen, l) > 0)) return false;
    const WrVec3 h = unit_of(sum), across = v3_cross(seen, h);
    *out = (Facing){ .nl = dot(seen, l), .nv = dot(seen, v), .nh = dot(seen, h), .vh = dot(v, h) };
    const double side = sqrt(dot(across, across)), whole = sqrt(side * side + out->nh * out->nh);
    out->c = out->nh / whole, out->s = side / whole;
    return true;
}

/* Blinn 1977 with Cook's form of Fresnel's equation: g^2 = ior^2 + c^2 - 1. */
static double fresnel(double c, double ior)
{
    const double gg = ior * ior + c * c - 1;
    if (gg < 0) return 1;
    if (ior == 1) return 0;
    const double g = sqrt(gg), a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return fmin(0.5 * a * a * (1 + b * b), 1);
}

/* Directions, unit, n facing the viewer; colour: C of the surface. */
typedef struct Incidence {
    WrVec3 n, l, v;
    const double *colour;
} Incidence;

/* Formulas of the models named in shade/reflection_models.h. On entry own is Lambert's and white 0. */

/* Phong's lobe (r.v)^s with r = 2 (n.l) n - l, gated by n.l > 0. Near 1 the cosine is 1 - |r - v|^2 / 2, whose
   power keeps its digits. Energy-conserving form: times (s + 2) / 2 n.l. */
static double power_lobe(const WrMatter *m, WrEnergy energy, WrVec3 n, WrVec3 l, WrVec3 v)
{
    const double nl = dot(n, l);
    if (!(nl > 0)) return 0;
    const WrVec3 r = v3_sub(v3_scale(n, 2 * nl), l), off = v3_sub(r, v);
    const double c = dot(r, v), s = m->shininess;
    const double strength = energy == WR_ENERGY_KEPT ? nl * (s + 2) / 2 : 1;
    if (s == 0) return m->ks * strength;
    if (!(c > 0)) return 0;
    return m->ks * strength * (c > 0.5 ? exp(s * log1p(-dot(off, off) / 2)) : pow(c, s));
}

/* D G F / (n.v) as in Blinn 1977, with D = (c3^2 / (cos^2 (c3^2 - 1) + 1))^2, here c3 for c3^2; 1 - cos^2 is
   written as sin^2, which keeps its digits near the peak. */
static double cavities(const WrMatter *m, WrEnergy energy, WrVec3 n, WrVec3 l, WrVec3 v)
{
    Facing at;
    if (!face(n, l, v, &at)) return 0;
    const double c = at.c, s = at.s, c3 = m->alpha * m->alpha;
    const double root = c3 / (c * c * c3 + s * s), d = root * root;
    const double whole = energy == WR_ENERGY_KEPT ? 1 / (4 * c3) : 1;
    const double g = fmin(1, fmin(2 * at.nh * at.nv / at.vh, 2 * at.nh * at.nl / at.vh));
    return m->ks * whole * d * g * fresnel(at.vh, m->ior) / at.nv;
}

static void phong(const WrMatter *m, WrEnergy energy, const Incidence *at, double own[3],
                  double *white)
{
    (void)own;
    *white = power_lobe(m, energy, at->n, at->l, at->v);
}

static void torrance_sparrow(const WrMatter *m, WrEnergy energy, const Incidence *at, double own[3],
                             double *white)
{
    (void)own;
    *white = cavities(m, energy, at->n, at->l, at->v);
}

/* Share that microfacets reflect directly, and the rest, for multiple reflection. */
static double matt_albedo(const WrMatter *m, double mu)
{
    const double s = sqrt(fmax(0, 1 - mu * mu));
    const double g = s * (acos(mu) - s * mu) + 2.0 / 3 * (s * mu * (1 + s + s * s) / (1 + s) - s);
    return m->a * (1 + m->sigma / pi * g);
}

static void oren_nayar(const WrMatter *m, WrEnergy energy, const Incidence *at, double own[3],
                       double *white)
{
    const WrVec3 n = at->n, l = at->l, v = at->v;
    const double nl = fmin(fmax(0, dot(n, l)), 1), nv = fmin(fmax(0, dot(n, v)), 1);
    const double q = dot(l, v) - nl * nv, most = fmax(nl, nv);
    *white = own[0] = own[1] = own[2] = 0;
    if (!(nl > 0)) return;
    if (energy == WR_ENERGY_PUBLISHED) {
        const double rough = m->a + m->b * fmax(0, q) / most;
        for (int c = 0; c < 3; c++) own[c] = m->kd * nl * rough;
        return;
    }
    const double once = m->a * (1 + m->sigma * q / (q > 0 ? most : 1));
    const double mean = m->a * (1 + (2.0 / 3 - 28 / (15 * pi)) * m->sigma);
    const double left = (1 - matt_albedo(m, nl)) * (1 - matt_albedo(m, nv));
    for (int c = 0; c < 3; c++) {
        const double rho = fmin(fmax(0, m->kd * at->colour[c]), 1);
        const double again =
            m->sigma > 1e-6 ? left / (1 - mean) * rho * mean / (1 - rho * (1 - mean)) : 0;
        own[c] = m->kd * nl * (once + again);
    }
}

static double kept_albedo(const WrMatter *m, double mu)
{
    const double x = sqrt(fmin(fmax(0, mu), 1));
    double sum = 0, power = 1;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++, power *= x) sum += m->albedo[i] * power;
    return fmin(sum, 1);
}

/* GGX's D with sin^2 for 1 - cos^2, times Smith's height-correlated masking, n.l and pi; Schlick's Fresnel term
   with v.h = |l + v| / 2. Metal (share m->metal) reflects in the surface's colour. */
static void ggx(const WrMatter *m, WrEnergy energy, const Incidence *by, double own[3],
                double *white)
{
    const WrVec3 n = by->n, l = by->l, v = by->v;
    Facing at;
    const double lit = dot(n, l), nv = dot(bent_back(n, v), v), a2 = m->alpha * m->alpha;
    *own = *white = 0;
    if (!(lit > 0)) return;
    double f = m->f0, lobe = 0, p = 0;
    const WrVec3 sum = v3_add(l, v);
    const double off = fmax(0, 1 - 0.5 * sqrt(dot(sum, sum)));
    p = off * off * off * off * off;
    f += (1 - m->f0) * p;
    if (face(n, l, v, &at)) {
        const double c = at.c, s = at.s, root = c * c * a2 + s * s;
        const double d = a2 / (root * root);
        lobe = m->ks * d * at.nl * 0.5 /
               (at.nl * sqrt(at.nv * at.nv * (1 - a2) + a2) +
                at.nv * sqrt(at.nl * at.nl * (1 - a2) + a2));
    }
    const double matt = m->kd * (1 - m->metal);
    const double left = matt == 0 ? 0
                        : energy == WR_ENERGY_KEPT
                            ? (1 - kept_albedo(m, lit)) * (1 - kept_albedo(m, nv)) * m->again
                            : 1 - f;
    own[0] = own[1] = own[2] = matt * lit * left + m->metal * (1 - p) * lobe;
    *white = (1 - m->metal) * f * lobe + m->metal * p * lobe;
}

#define CASE_STAGES(ID, formula)                                                                   \
    case WR_REFLECT_##ID:                                                                          \
        break; /* wr_reference_lamp */
#define CASE_UNIFORM(ID, formula)                                                                  \
    case WR_REFLECT_##ID:                                                                          \
        formula(m, energy, &at, own, white);                                                       \
        break;
#define CASE_ROUGH CASE_UNIFORM
#define CASE_METAL CASE_UNIFORM
#define CASE(ID, formula, LOOPS, ...) CASE_##LOOPS(ID, formula)

void wr_reference_reflect(const WrMatter *m, int model, WrEnergy energy, WrVec3 n, WrVec3 l,
                          WrVec3 v, const double colour[3], double own[3], double *white)
{
    const Incidence at = { n, l, v, colour };
    *white = 0;
    own[0] = own[1] = own[2] = m->kd * fmax(0, dot(n, l));
    switch ((WrReflect)model) {
        WR_REFLECTION_MODELS(CASE)
    case WR_REFLECT_COUNT: break;
    }
}
