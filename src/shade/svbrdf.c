#include "shade/svbrdf.h"

#include <math.h>
#include <string.h>

#define TERMS (WR_ALBEDO_TERMS * sizeof(double))

/* All parameters that depend on roughness, at evenly spaced steps, for metalness 0 and 1: between them
   everything is linear in metalness. The diffuse part of a metal is 0, so those rows exist for metalness 0
   only. */
void wr_svbrdf_init(WrSvbrdf *vary, const WrReflectance *of, double ks, double tint, bool gated)
{
    memset(vary, 0, sizeof *vary);
    for (int i = 0; i < WR_SVBRDF_STEPS; i++)
        for (int metal = 0; metal < 2; metal++) {
            WrReflectance at = *of;
            WrMatter m;
            WrEnvironmentBrdf gloss;
            at.roughness = (double)i / (WR_SVBRDF_STEPS - 1), at.metalness = metal;
            wr_matter_init(&m, &at);
            wr_environment_brdf_init(&gloss, &at, &m, ks, tint, gated);
            memcpy(vary->own[metal][i], gloss.own, TERMS);
            memcpy(vary->white[metal][i], gloss.white, TERMS);
            if (metal) continue;
            vary->mean[i] = m.mean, vary->again[i] = m.again;
            memcpy(vary->albedo[i], m.albedo, TERMS);
            memcpy(vary->matt[i], gloss.matt, TERMS);
            memcpy(vary->twice[i], gloss.again, TERMS);
        }
}

/* Rung i has alpha = 2^-i; s = 2 / alpha^2 - 2 is the exponent of equal width, a quarter of it for Phong's
   lobe. */
void wr_svbrdf_rung(const WrEnvironmentBrdf *gloss, int rung, WrEnvironmentBrdf *out)
{
    const double alpha = ldexp(1, -rung), power = fmax(2 / (alpha * alpha) - 2, 0);
    *out = (WrEnvironmentBrdf){ .lobe = gloss->lobe, .gated = gloss->gated, .alpha = alpha };
    if (gloss->lobe == WR_LOBE_HALF) out->power = power;
    if (gloss->lobe == WR_LOBE_POWER) out->power = power / 4;
}
