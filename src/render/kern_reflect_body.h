/* kern_reflect_body.h - a lamp on strips of other models than Blinn-Phong's. A part of kern_body.h; the formulas are in
   shade/reflect_body.h. After `light` and `view`; the colour picture's C is in the strip already. */

ALWAYS Facets facets_of(const STRIP *strip, int i, bool spread, bool round, REAL a2)
{
    const VEC n = LOAD3(strip, b, i), none = { K_(0), K_(0), K_(0) };
    if (!spread) return (Facets){ none, none, K_(0), K_(0), K_(0), K_(1) };
    return reflect_facets(n, LOAD3(strip, e, i), strip->see[i], strip->sef[i], strip->sff[i], round,
                          a2);
}

/* told: what highlights leave to diffuse light is `left`. */
ALWAYS Reflected reflect_at(const STRIP *strip, int i, const WrReflect model, const bool kept,
                            const bool spread, const bool round, const bool told, REAL left,
                            const MATTER *m)
{
    const VEC n = LOAD3(strip, b, i), l = LOAD3(strip, l, i), v = LOAD3(strip, v, i);
    const Facets wide = facets_of(strip, i, spread, round, m->alpha * m->alpha);
    if (model == WR_REFLECT_PHONG)
        return reflect_phong(n, l, v, spread ? strip->see[i] + strip->sff[i] : K_(0), kept, m);
    if (model == WR_REFLECT_TORRANCE_SPARROW)
        return reflect_torrance_sparrow(n, l, v, wide, spread, m);
    if (model == WR_REFLECT_OREN_NAYAR) return reflect_oren_nayar(n, l, v, kept, m);
    return reflect_ggx(n, l, v, wide, spread, kept, told, left, m);
}

ALWAYS void reflect_strip(const LIGHT *light, const MATTER *matter, const WrReflect model,
                          const bool kept, const bool spread, const bool round, STRIP *strip)
{
    const MATTER m = *matter;
    const REAL r = light->rgb[0], g = light->rgb[1], b = light->rgb[2];
    const REAL own_r = m.kd * m.colour[0], own_g = m.kd * m.colour[1], own_b = m.kd * m.colour[2];
    const bool twice = kept && model == WR_REFLECT_OREN_NAYAR;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const Reflected got = reflect_at(strip, i, model, kept, spread, round, false, K_(0), &m);
        REAL again_r = K_(0), again_g = K_(0), again_b = K_(0);
        if (twice) {
            again_r = got.again * reflect_kept(own_r * strip->cr[i], m.mean);
            again_g = got.again * reflect_kept(own_g * strip->cg[i], m.mean);
            again_b = got.again * reflect_kept(own_b * strip->cb[i], m.mean);
        }
        strip->dr[i] += r * (got.own + again_r);
        strip->dg[i] += g * (got.own + again_g);
        strip->db[i] += b * (got.own + again_b);
        strip->sr[i] += r * got.white;
        strip->sg[i] += g * got.white;
        strip->sb[i] += b * got.white;
    }
}

/* Highlights in the surface's colour to the share t. */
FLAT static void kern_tint(REAL t, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        strip->dr[i] += t * strip->sr[i], strip->sr[i] -= t * strip->sr[i];
        strip->dg[i] += t * strip->sg[i], strip->sg[i] -= t * strip->sg[i];
        strip->db[i] += t * strip->sb[i], strip->sb[i] -= t * strip->sb[i];
    }
}

#define REFLECT(name, MODEL, kept)                                                                 \
    FLAT static void kern_##name##_##kept(const LIGHT *light, const MATTER *m,                     \
                                          WrReflectSpread how, STRIP *strip)                       \
    {                                                                                              \
        if (how == WR_REFLECT_AS_IT_IS) reflect_strip(light, m, MODEL, kept, false, false, strip); \
        else reflect_strip(light, m, MODEL, kept, true, how == WR_REFLECT_ROUND, strip);           \
    }
REFLECT(phong, WR_REFLECT_PHONG, 0)
REFLECT(phong, WR_REFLECT_PHONG, 1)
REFLECT(facets, WR_REFLECT_TORRANCE_SPARROW, 0)
REFLECT(matt, WR_REFLECT_OREN_NAYAR, 0)
REFLECT(matt, WR_REFLECT_OREN_NAYAR, 1)
REFLECT(ggx, WR_REFLECT_GGX, 0)
REFLECT(ggx, WR_REFLECT_GGX, 1)
