/* reflection.h - how a surface reflects a lamp: the models by name, which of a material's numbers each goes by, and what
   its formulas need worked out once. The formulas of one sample are in shade/reflection_body.h.
   Layer 3. The reference renderer has formulas of its own, on purpose.

   A lamp of strength 1 gives pi f (n.l), f the model's reflectance: so matt white is n.l. The albedo E(n.v) is the
   integral of f (n.l) over all directions: what a white furnace shows. */
#pragma once
#include <stdbool.h>

typedef enum WrReflect {
    WR_REFLECT_BLINN_PHONG, /* diffuse light and max(0, n.h)^s, as in light_body.h */
    WR_REFLECT_PHONG,
    WR_REFLECT_TORRANCE_SPARROW,
    WR_REFLECT_OREN_NAYAR,
    WR_REFLECT_GGX,
    WR_REFLECT_COUNT
} WrReflect;

/* Of a model's forms the one that never reflects more than comes, or the one that its source gives. */
typedef enum WrEnergy { WR_ENERGY_KEPT, WR_ENERGY_PUBLISHED, WR_ENERGY_COUNT } WrEnergy;

typedef struct WrReflectInfo {
    const char *name;  /* as in commands: "ggx" */
    const char *title; /* in lists of the window */
    const char *help;
    bool shines;                               /* it has a highlight */
    bool shininess, roughness, metalness, ior; /* the numbers that it goes by */
    bool facets;                               /* small mirrors: n' is bent into view */
    bool energies;                             /* its two forms differ */
    double
        most; /* albedo of white as published, the largest that there is at `specular` or `diffuse` 1 */
} WrReflectInfo;
extern const WrReflectInfo wr_reflects[WR_REFLECT_COUNT];
extern const char *const wr_energies[WR_ENERGY_COUNT];

#define WR_ALBEDO_TERMS 11

/* What the formulas go by. */
typedef struct WrMatter {
    double kd, ks;    /* 0: that part is left out */
    double colour[3]; /* C */
    double shininess;
    double
        scale; /* of the highlight: phong (s + 2) / 2, torrance-sparrow its energy's; kept; else 1 and alpha^2 */
    double alpha; /* width of the facets' slopes, roughness^2, no less than WR_ALPHA_LEAST */
    double ior, f0, metal;
    double sigma, a, b; /* oren-nayar */
    double mean;        /* of 1 the share that is reflected at once, over all directions */
    double again;       /* 1 / (1 - mean); 0 where nothing is left */
    double albedo[WR_ALBEDO_TERMS]; /* ggx, kept: E = sum of albedo[i] x^i, x = sqrt(n.v) */
} WrMatter;

#define WR_ALPHA_LEAST                                                                             \
    1e-3 /* a lamp's mirror image would be a point: smoother there is none (HC100) */

/* A material's own numbers. */
typedef struct WrReflectance {
    WrReflect model;
    WrEnergy energy;
    double shininess, roughness, metalness, ior;
} WrReflectance;

/* All but kd, ks and colour. Numbers outside their range are taken as its ends, no number as 0 (HC100, HC102, HC110). */
void wr_matter_init(WrMatter *matter, const WrReflectance *of);

/* The albedo of GGX facets of width alpha at n.v = mu, split by Schlick's Fresnel term: E = f0 out[0] + out[1]. By
   quadrature. */
void wr_ggx_albedo(double alpha, double mu, double out[2]);

/* The polynomial in x = sqrt(n.v), terms of x^0 on, through values y at Chebyshev's places; y is used up. And its value. */
void wr_albedo_places(double x[WR_ALBEDO_TERMS]);
void wr_albedo_fit(double y[WR_ALBEDO_TERMS], double out[WR_ALBEDO_TERMS]);
double wr_albedo_at(const double terms[WR_ALBEDO_TERMS], double x);
