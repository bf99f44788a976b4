#include "shade/vary.h"

#include <math.h>
#include <string.h>

#define TERMS (WR_ALBEDO_TERMS * sizeof(double))

void wr_vary_init(WrVary *vary, const WrReflectance *of, double ks, double tint, bool gated)
{
    memset(vary, 0, sizeof *vary);
    for (int i = 0; i < WR_VARY_STEPS; i++)
        for (int metal = 0; metal < 2; metal++) {
            WrReflectance at = *of;
            WrMatter m;
            WrGloss gloss;
            at.roughness = (double)i / (WR_VARY_STEPS - 1), at.metalness = metal;
            wr_matter_init(&m, &at);
            wr_gloss_init(&gloss, &at, &m, ks, tint, gated);
            memcpy(vary->own[metal][i], gloss.own, TERMS);
            memcpy(vary->white[metal][i], gloss.white, TERMS);
            if (metal) continue;
            vary->mean[i] = m.mean, vary->again[i] = m.again;
            memcpy(vary->albedo[i], m.albedo, TERMS);
            memcpy(vary->matt[i], gloss.matt, TERMS);
            memcpy(vary->twice[i], gloss.again, TERMS);
        }
}

void wr_vary_rung(const WrGloss *gloss, int rung, WrGloss *out)
{
    const double alpha = ldexp(1, -rung), power = fmax(2 / (alpha * alpha) - 2, 0);
    *out = (WrGloss){ .lobe = gloss->lobe, .gated = gloss->gated, .alpha = alpha };
    if (gloss->lobe == WR_LOBE_HALF) out->power = power;
    if (gloss->lobe == WR_LOBE_POWER) out->power = power / 4;
}
