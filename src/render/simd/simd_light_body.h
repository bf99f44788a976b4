/* simd_light_body.h - SIMD light of one lamp in one pass, for highlights that are narrow or have a whole
   exponent. Part of simd_set_body.h.
   The formulas are those of shade/light_body.h. Narrow highlights are computed only if some sample of a vector
   has one above 2^-FAINT of full scale. There 1 - n'.h is small, so its logarithm needs no exponent. */
#define FAINT 15 /* fainter highlights are omitted: 2^-15 is a sixth of the bound of a stage */

/* Largest 1 - n'.h of a visible highlight: (1 - x)^s <= e^(-s x). */
static float widest(const WrKernLight *light, const WrKernShine *shine)
{
    const float *rgb = light->rgb;
    const float most = shine->ks * fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
    const int power = (wr_float_bits(most > 1.0f ? most : 1.0f) >> 23) - 127;
    return (float)(FAINT + 1 + power) * 0.693147182f / shine->shininess;
}

#define NARROW 0.5f /* range of the lobe's polynomials */

/* (1 - x)^s, 0 <= x <= NARROW: relative error below 1e-5. */
ALWAYS Wide narrow_lobe(Wide x, Wide s)
{
    const Wide slope = w_all(-1.44269621f) +
                       x * (w_all(-0.721112967f) +
                            x * (w_all(-0.488225251f) +
                                 x * (w_all(-0.276858598f) +
                                      x * (w_all(-0.729325235f) +
                                           x * (w_all(0.875417769f) + x * w_all(-1.39874518f))))));
    const Wide e = w_max(s * (x * slope), w_all(-100.0f)), n = w_nearest(e), f = e - n;
    const Wide p =
        w_all(1.0f) +
        f * (w_all(0.693121016f) +
             f * (w_all(0.240223497f) + f * (w_all(0.0559219755f) + f * w_all(0.00966636837f))));
    return p * w_power(n);
}

#define WHOLE 128 /* the largest exponent: a power multiplies the rounding error of n'.h by it */

/* The exponent if it is a supported whole number, else 0. */
static int whole_exponent(const WrKernShine *shine)
{
    const float s = shine->shininess;
    return s >= 1.0f && s <= (float)WHOLE && s == floorf(s) ? (int)s : 0;
}

/* Smaller cosines have no visible highlight of such an exponent; their powers would be denormal numbers. */
static float least_cosine(int whole)
{
    if (whole <= 4) return 0x1p-24f;
    return whole <= 16 ? 0x1p-6f : whole <= 32 ? 0x1p-3f : 0.5825f; /* 2^-0.78 */
}

/* Power by repeated squaring. */
ALWAYS Wide whole_power(Wide base, int exponent)
{
    while (!(exponent & 1)) base = base * base, exponent >>= 1;
    Wide power = base;
    while (exponent >>= 1) {
        base = base * base;
        if (exponent & 1) power = power * base;
    }
    return power;
}

typedef struct Lamp {
    WideVec where, viewer;
    Wide shininess, limit; /* limit: of 2 (1 - n'.h) */
    Wide least;            /* for whole exponents: smallest n'.h */
    int whole;             /* the exponent, or 0 */
    bool gate;
} Lamp;

ALWAYS WideVec unit_towards(WideVec from, WideVec to)
{
    const WideVec v = w_sub(to, from);
    return w_scale(v, w_rsqrt(w_max(w_dot(v, v), w_all(1e-30f))));
}

/* Highlight seen along v; 0 if there is none. */
ALWAYS Wide narrow_highlight(const Lamp *lamp, WideVec l, Wide n_dot_l, WideVec bent, WideVec v)
{
    /* 0 if l and v are opposite: off is n' */
    const WideVec h = { l.x + v.x, l.y + v.y, l.z + v.z };
    const WideVec off = w_mad(bent, h, -w_rsqrt(w_max(w_dot(h, h), w_all(1e-24f))));
    const Wide twice = w_dot(off, off);
    WideMask shown = w_less(twice, lamp->limit);
    if (lamp->gate) shown = w_both(shown, w_less(w_all(0.0f), n_dot_l));
    if (!w_any(shown)) return w_all(0.0f);
    if (lamp->whole == 0) return w_kept(shown, narrow_lobe(w_all(0.5f) * twice, lamp->shininess));
    return whole_power(w_kept(shown, w_all(1.0f) - w_all(0.5f) * twice), lamp->whole);
}

/* Factors of one channel. */
typedef struct Channel {
    Wide own, diffuse, specular;
} Channel;

ALWAYS Channel channel_of(const WrKernLight *light, const WrKernShine *shine,
                          const WrKernMaterial *material, int c)
{
    return (Channel){ w_all(material->rgb[c]), w_all(material->kd * light->rgb[c]),
                      w_all(shine->ks * light->rgb[c]) };
}

ALWAYS Wide channel_lit(Channel of, Wide picture, Wide ambient, Wide lit, Wide lobe)
{
    return of.own * picture * (ambient + of.diffuse * lit) + of.specular * lobe;
}

ALWAYS bool are_alike(const float c[3])
{
    return c[0] == c[1] && c[0] == c[2];
}

/* A lamp and a material. */
typedef struct Scenery {
    Lamp lamp;
    Channel red, green, blue;
    Wide ambient;
    bool grey; /* without a picture, all channels are equal */
} Scenery;

ALWAYS Scenery scenery_of(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                          const WrKernMaterial *material)
{
    const int whole = whole_exponent(shine);
    const float least = least_cosine(whole), wide = widest(light, shine);
    const float limit = whole && wide > 1 - least ? 1 - least : wide;
    return (
        Scenery){ { w_alike(light->where), w_alike(rays->perspective ? rays->eye : rays->toward),
                    w_all(shine->shininess), w_all(2 * limit), w_all(least), whole, shine->gate },
                  channel_of(light, shine, material, 0),
                  channel_of(light, shine, material, 1),
                  channel_of(light, shine, material, 2),
                  w_all(material->ambient),
                  are_alike(light->rgb) && are_alike(material->rgb) };
}

/* Stores the colours of the vector at i, at p with n' `bent`, seen along v. Returns n'.l. */
ALWAYS Wide put_colour(const Scenery *s, const bool point, const bool pictured, WideVec p,
                       WideVec bent, WideVec v, WrStrip *strip, int i)
{
    const WideVec l = point ? unit_towards(p, s->lamp.where) : s->lamp.where;
    const Wide n_dot_l = w_dot(bent, l), lit = w_max(n_dot_l, w_all(0.0f)), one = w_all(1.0f);
    const Wide lobe = narrow_highlight(&s->lamp, l, n_dot_l, bent, v);
    const Wide r = pictured ? w_load(strip->cr + i) : one;
    const Wide red = channel_lit(s->red, r, s->ambient, lit, lobe);
    Wide green = red, blue = red;
    if (pictured || !s->grey) {
        const Wide g = pictured ? w_load(strip->cg + i) : one;
        const Wide b = pictured ? w_load(strip->cb + i) : one;
        green = channel_lit(s->green, g, s->ambient, lit, lobe);
        blue = channel_lit(s->blue, b, s->ambient, lit, lobe);
    }
    w_store(strip->cr + i, red), w_store(strip->cg + i, green), w_store(strip->cb + i, blue);
    return n_dot_l;
}

ALWAYS void shade_narrow(const Scenery *s, const bool point, const bool near, const bool pictured,
                         WrStrip *strip)
{
    const int count = strip->count;
    for (int i = 0; i < count; i += WIDE) {
        const WideVec p = point || near ? W_LOAD3(strip, p, i) : s->lamp.viewer;
        const WideVec v = near ? unit_towards(p, s->lamp.viewer) : s->lamp.viewer;
        put_colour(s, point, pictured, p, W_LOAD3(strip, b, i), v, strip, i);
    }
}

static bool narrow(const WrKernLight *light, const WrKernShine *shine)
{
    return whole_exponent(shine) > 0 || widest(light, shine) <= NARROW;
}

static bool wide_shade(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                       const WrKernMaterial *material, bool pictured, WrStrip *strip)
{
    if (!narrow(light, shine)) return false;
    const Scenery s = scenery_of(rays, light, shine, material);
    const int which = (light->point ? 4 : 0) + (rays->perspective ? 2 : 0) + (pictured ? 1 : 0);
    switch (which) {
    case 0: shade_narrow(&s, false, false, false, strip); break;
    case 1: shade_narrow(&s, false, false, true, strip); break;
    case 2: shade_narrow(&s, false, true, false, strip); break;
    case 3: shade_narrow(&s, false, true, true, strip); break;
    case 4: shade_narrow(&s, true, false, false, strip); break;
    case 5: shade_narrow(&s, true, false, true, strip); break;
    case 6: shade_narrow(&s, true, true, false, strip); break;
    default: shade_narrow(&s, true, true, true, strip); break;
    }
    return true;
}
