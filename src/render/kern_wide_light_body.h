/* kern_lamp_body.h - all of one lamp in one pass, where highlights are narrow. A part of kern_wide_*.c.
   The formulas are those of shade/light_body.h, but for what narrow highlights spare: they are worked out only where
   some sample of a vector has one of 2^-FAINT of what the picture shows, and there 1 - n'.h is small, so that its
   logarithm takes no exponent. */
#define FAINT 15 /* fainter highlights are none: 2^-15 is a sixth of the bound of a stage */

/* 1 - n'.h up to which a highlight counts: (1 - x)^s <= e^(-s x). */
static float widest(const WrKernLight *light, const WrKernShine *shine)
{
    const float *rgb = light->rgb;
    const float most = shine->ks * fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
    const int power = (wr_float_bits(most > 1.0f ? most : 1.0f) >> 23) - 127;
    return (float)(FAINT + 1 + power) * 0.693147182f / shine->shininess;
}

#define NARROW 0.5f /* the lobe's polynomials are good up to there */

/* (1 - x)^s, 0 <= x <= NARROW: within 1e-5 of itself. */
ALWAYS Wide narrow_lobe(Wide x, Wide s)
{
    const Wide slope =
        w_all(-1.44269621f) +
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

typedef struct Lamp {
    WideVec where, viewer;
    Wide shininess, limit;
    bool gate;
} Lamp;

/* The highlight of samples i and on, of normal `bent`; 0 where there is none. */
ALWAYS Wide narrow_highlight(const Lamp *lamp, WideVec l, Wide n_dot_l, WideVec bent,
                             const bool near, const WrStrip *strip, int i)
{
    const Wide least = w_all(1e-24f);
    WideVec v = lamp->viewer;
    if (near) {
        v = w_sub(v, W_LOAD3(strip, p, i));
        v = w_scale(v, w_rsqrt(w_max(w_dot(v, v), w_all(1e-30f))));
    }
    const WideVec h = { l.x + v.x, l.y + v.y, l.z + v.z };
    const Wide hh = w_dot(h, h);
    const WideVec off = w_mad(bent, h, -w_rsqrt(w_max(hh, least)));
    const Wide below = w_all(0.5f) * w_dot(off, off);
    WideMask shown = w_both(w_less(below, lamp->limit), w_less(least, hh));
    if (lamp->gate) shown = w_both(shown, w_less(w_all(0.0f), n_dot_l));
    if (!w_any(shown)) return w_all(0.0f);
    return w_kept(shown, narrow_lobe(below, lamp->shininess));
}

/* What each channel is made of. */
typedef struct Channel {
    Wide own, diffuse, specular;
} Channel;

ALWAYS Channel channel_of(const WrKernLight *light, const WrKernShine *shine, const WrKernMaterial *material, int c)
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

ALWAYS void shade_narrow(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                         const WrKernMaterial *material, float limit, const bool point, const bool near,
                         const bool pictured, WrStrip *strip)
{
    const Lamp lamp = { w_alike(light->where), w_alike(near ? rays->eye : rays->toward),
                        w_all(shine->shininess), w_all(limit), shine->gate };
    const Channel red = channel_of(light, shine, material, 0);
    const Channel green = channel_of(light, shine, material, 1);
    const Channel blue = channel_of(light, shine, material, 2);
    const bool grey = !pictured && are_alike(light->rgb) && are_alike(material->rgb);
    const Wide zero = w_all(0.0f), one = w_all(1.0f), ambient = w_all(material->ambient);
    const int count = strip->count;
    for (int i = 0; i < count; i += WIDE) {
        const WideVec bent = W_LOAD3(strip, b, i);
        WideVec l = lamp.where;
        if (point) {
            l = w_sub(l, W_LOAD3(strip, p, i));
            l = w_scale(l, w_rsqrt(w_max(w_dot(l, l), w_all(1e-30f))));
        }
        const Wide n_dot_l = w_dot(bent, l), lit = w_max(n_dot_l, zero);
        const Wide lobe = narrow_highlight(&lamp, l, n_dot_l, bent, near, strip, i);
        const Wide r = channel_lit(red, pictured ? w_load(strip->cr + i) : one, ambient, lit, lobe);
        Wide g = r, b = r;
        if (!grey) {
            g = channel_lit(green, pictured ? w_load(strip->cg + i) : one, ambient, lit, lobe);
            b = channel_lit(blue, pictured ? w_load(strip->cb + i) : one, ambient, lit, lobe);
        }
        w_store(strip->cr + i, r), w_store(strip->cg + i, g), w_store(strip->cb + i, b);
    }
}

static bool wide_shade(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                       const WrKernMaterial *material, bool pictured, WrStrip *strip)
{
    const float limit = widest(light, shine);
    const bool point = light->point, near = rays->perspective;
    if (!(limit <= NARROW)) return false;
    if (point && near && pictured) shade_narrow(rays, light, shine, material, limit, true, true, true, strip);
    else if (point && near) shade_narrow(rays, light, shine, material, limit, true, true, false, strip);
    else if (point && pictured) shade_narrow(rays, light, shine, material, limit, true, false, true, strip);
    else if (point) shade_narrow(rays, light, shine, material, limit, true, false, false, strip);
    else if (near && pictured) shade_narrow(rays, light, shine, material, limit, false, true, true, strip);
    else if (near) shade_narrow(rays, light, shine, material, limit, false, true, false, strip);
    else if (pictured) shade_narrow(rays, light, shine, material, limit, false, false, true, strip);
    else shade_narrow(rays, light, shine, material, limit, false, false, false, strip);
    return true;
}
