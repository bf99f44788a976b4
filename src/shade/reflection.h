/* reflection.h - reflection models: their traits, the parameters of their formulas, and albedos of
   microfacets.

   The models themselves are the table shade/reflection_models.h; the formulas of one sample are in
   shade/reflection_body.h. The reference renderer intentionally has formulas of its own. This header is
   included widely, so a model's number is an int here: 0 <= model < wr_reflect_count, a WrReflect. A
   lamp of strength 1 yields pi f (n.l), f the model's reflectance: so matt white is n.l. The albedo
   E(n.v) is the integral of f (n.l) over all directions: its colour in a white furnace. */
#pragma once
#include <stdbool.h>

/* Choice between a model's two formulas: energy-conserving, or as published. */
typedef enum WrEnergy { WR_ENERGY_KEPT, WR_ENERGY_PUBLISHED, WR_ENERGY_COUNT } WrEnergy;

/* Loops over samples that a model needs. */
typedef enum WrReflectLoops {
    WR_REFLECT_LOOPS_STAGES, /* none of its own: the stages `diffuse` and `specular`; only one model */
    WR_REFLECT_LOOPS_UNIFORM, /* its parameters are the same for all samples */
    WR_REFLECT_LOOPS_ROUGH,   /* roughness may vary from sample to sample */
    WR_REFLECT_LOOPS_METAL    /* roughness and metalness may */
} WrReflectLoops;

/* Shape of the highlight. Everything that differs by it is a switch without a default, so that a new one stops the
   compiler wherever it is needed. */
typedef enum WrReflectHighlight {
    WR_HIGHLIGHT_NONE,
    WR_HIGHLIGHT_HALF,  /* (n.h)^s: also below the horizon, unless the material gates it */
    WR_HIGHLIGHT_POWER, /* (r.v)^s, r the mirrored direction to the lamp */
    WR_HIGHLIGHT_CAVITIES, /* microfacets in V-shaped cavities, Fresnel's exact reflectance: none at ior 1 */
    WR_HIGHLIGHT_SMITH /* microfacets with Smith's masking and Schlick's reflectance */
} WrReflectHighlight;

#define WR_HIGHLIGHT_IS_OF_FACETS(highlight)                                                       \
    ((highlight) == WR_HIGHLIGHT_CAVITIES || (highlight) == WR_HIGHLIGHT_SMITH)

/* Diffuse light. Every difference is a switch without a default, as for highlights. */
typedef enum WrReflectDiffuse {
    WR_DIFFUSE_LAMBERT,
    WR_DIFFUSE_ROUGH,    /* matt facets, Lambert's at roughness 0; kept: including interreflection
                         between them */
    WR_DIFFUSE_REMAINDER /* light that the highlight does not reflect; none of metal */
} WrReflectDiffuse;

/* Traits of a model; a row of shade/reflection_models.h. */
typedef struct WrReflectInfo {
    const char *name;  /* as in commands: "ggx" */
    const char *title; /* in lists of the window */
    const char *help;
    bool energies; /* its two formulas differ */
    WrReflectLoops loops;
    WrReflectHighlight highlight;
    WrReflectDiffuse diffuse;
    /* Derived from the columns above: */
    bool shines;                               /* it has a highlight */
    bool facets;                               /* of microfacets: n' is bent into view */
    bool shininess, roughness, metalness, ior; /* the parameters that it uses */
} WrReflectInfo;
extern const WrReflectInfo wr_reflects[];
extern const int wr_reflect_count;
extern const char *const wr_energies[WR_ENERGY_COUNT];

/* The model of a new scene, which the stages compute: WR_REFLECT_LOOPS_STAGES. */
#define WR_REFLECT_DEFAULT 0

/* kept: the energy-conserving formula. True if diffuse light is reduced by the albedo of the highlight. */
static inline bool wr_reflect_shares(const WrReflectInfo *model, bool kept)
{
    return kept && model->diffuse == WR_DIFFUSE_REMAINDER;
}

/* kept: the energy-conserving formula. True if there is interreflected light, tinted by the colour
 * again. */
static inline bool wr_reflect_again(const WrReflectInfo *model, bool kept)
{
    return kept && model->diffuse == WR_DIFFUSE_ROUGH;
}

#define WR_ALBEDO_TERMS 11

/* Coefficients of the formulas. */
typedef struct WrMatter {
    double kd, ks;    /* 0: that part is skipped */
    double colour[3]; /* C */
    double shininess;
    double scale; /* of the highlight: phong (s + 2) / 2, torrance-sparrow its normalisation; kept;
                  else 1 and alpha^2 */
    double alpha; /* width of the facets' slope distribution, roughness^2, at least WR_ALPHA_MIN */
    double ior, f0, metal;
    double sigma, a, b; /* oren-nayar */
    double mean;        /* fraction of light reflected at once, averaged over all directions */
    double again;       /* 1 / (1 - mean); 0 if nothing is left */
    double albedo[WR_ALBEDO_TERMS]; /* ggx, kept: E = sum of albedo[i] x^i, x = sqrt(n.v) */
} WrMatter;

#define WR_ALPHA_MIN 1e-3 /* minimum, since a lamp's mirror image would be a point (HC100) */

/* The parameters of a material. */
typedef struct WrReflectance {
    int model; /* WrReflect */
    WrEnergy energy;
    double shininess, roughness, metalness, ior;
} WrReflectance;

/* Initialises all members except kd, ks and colour. Numbers outside their range are clamped, NaN
 * becomes 0 (HC100, HC102, HC110). */
void wr_matter_init(WrMatter *matter, const WrReflectance *of);

/* The albedo of GGX facets of width alpha at n.v = mu, split by Schlick's Fresnel term: E = f0 out[0] +
   out[1]. By quadrature. */
void wr_ggx_albedo(double alpha, double mu, double out[2]);

/* The Chebyshev nodes of x = sqrt(n.v); the polynomial, coefficients from x^0 on, through values y at
 * the nodes (y is overwritten); and its value. */
void wr_albedo_places(double x[WR_ALBEDO_TERMS]);
void wr_albedo_fit(double y[WR_ALBEDO_TERMS], double out[WR_ALBEDO_TERMS]);
double wr_albedo_at(const double terms[WR_ALBEDO_TERMS], double x);
