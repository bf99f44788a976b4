/* kern_slope_moments_body.h - highlights widened by the spread of slopes inside a pixel. Part of kern_body.h.

   A slope's change (dFu, dFv) moves grad F by dg = dFu a + dFv b, a = (Pv x n)/|N|, b = (n x Pu)/|N|, and turns
   n' = (n - g)/|n - g| along a direction e across n' by e . dg (n . n'), as a tangent. So the covariance of
   those tangents is C = (n . n')^2 J S J^T, J = (e . a, e . b; f . a, f . b) with e, f any two perpendicular
   unit vectors across n'.

   The program's lobe cos^s is close to exp(-s tan^2 / 2), a Gaussian of covariance I/s in those tangents. Its
   mean over slopes with covariance C is the Gaussian of covariance C + I/s, lower by
   1/sqrt(det(I + s C)). Written as a cosine's power again:

     LEAN      cos^s',  s' = t^T (C + I/s)^-1 t / t^T t,  t the direction from n' to h across n'
     Toksvig   s' = s / (1 + s c),  c = trace(C) / 2, lower by 1/(1 + s c)

   Where C = 0, s' = s to the bit. Diffuse light is that of the mean slope. For `invariant` a and b are
   normalised; for `exact` the terms in F are left out of a and b. */

/* Two unit vectors perpendicular to the unit vector n and to each other. */
typedef struct Across {
    VEC e, f;
} Across;

ALWAYS Across across(VEC n)
{
    REAL sign = n.z < K_(0) ? K_(-1) : K_(1);
    REAL a = K_(-1) / (sign + n.z), b = n.x * n.y * a;
    return (Across){ { K_(1) + sign * n.x * n.x * a, sign * b, -sign * n.x },
                     { b, sign + n.y * n.y * a, -n.y } };
}

ALWAYS REAL capped(REAL x)
{
    return x < K_(1e8) ? x : K_(1e8); /* wider than any lobe */
}

FLAT static void kern_widen(bool unit_tangents, STRIP *strip)
{
    const int count = strip->count;
    const REAL unit = unit_tangents ? K_(1) : K_(0);
    SIMD for (int i = 0; i < count; i++)
    {
        VEC n = LOAD3(strip, n, i), bent = LOAD3(strip, b, i);
        VEC a = v_cross(LOAD3(strip, pv, i), n), b = v_cross(n, LOAD3(strip, pu, i));
        REAL area = strip->n_len[i];
        REAL la = r_sqrt(v_dot(a, a)), lb = r_sqrt(v_dot(b, b));
        REAL da = unit != K_(0) ? la : area, db = unit != K_(0) ? lb : area;
        REAL c = v_dot(n, bent);
        REAL ka = c / (da > K_(1e-12) ? da : K_(1e-12)), kb = c / (db > K_(1e-12) ? db : K_(1e-12));
        Across at = across(bent);
        REAL ea = v_dot(at.e, a) * ka, eb = v_dot(at.e, b) * kb;
        REAL fa = v_dot(at.f, a) * ka, fb = v_dot(at.f, b) * kb;
        REAL suu = strip->suu[i], suv = strip->suv[i], svv = strip->svv[i];
        REAL see = capped(suu * ea * ea + K_(2) * suv * ea * eb + svv * eb * eb);
        REAL sff = capped(suu * fa * fa + K_(2) * suv * fa * fb + svv * fb * fb);
        REAL sef = suu * ea * fa + suv * (ea * fb + eb * fa) + svv * eb * fb;
        see = see > K_(0) ? see : K_(0); /* HC93; NaN as well */
        sff = sff > K_(0) ? sff : K_(0);
        REAL most = r_sqrt(see) * r_sqrt(sff);
        sef = sef < most ? sef : most;
        STORE3(strip, e, i, at.e);
        strip->see[i] = see;
        strip->sff[i] = sff;
        strip->sef[i] = sef > -most ? sef : -most;
    }
}

ALWAYS void add_shine(const LIGHT *light, const SHINE *shine, REAL power, REAL factor, Half half,
                      STRIP *strip, int i)
{
    REAL lobe = light_lobe(half.c, half.below, power) * factor;
    lobe = light_shown(lobe, shine->gate, strip->n_dot_l[i], half.there);
    strip->sr[i] += shine->ks * light->rgb[0] * lobe;
    strip->sg[i] += shine->ks * light->rgb[1] * lobe;
    strip->sb[i] += shine->ks * light->rgb[2] * lobe;
}

FLAT static void kern_specular_lean(const LIGHT *light, const SHINE *shine, STRIP *strip)
{
    const REAL s = shine->shininess;
    const LIGHT lamp = *light;
    const SHINE glow = *shine;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        Half half = half_of(strip, i);
        VEC e = LOAD3(strip, e, i), f = v_cross(LOAD3(strip, b, i), e);
        REAL te = v_dot(half.h, e), tf = v_dot(half.h, f);
        /* (I + s C)^-1 by its adjoint */
        REAL cee = K_(1) + s * strip->see[i], cff = K_(1) + s * strip->sff[i];
        REAL cef = s * strip->sef[i], det = cee * cff - cef * cef;
        det = det > K_(1) ? det : K_(1);
        REAL tt = te * te + tf * tf;
        REAL form = cff * te * te - K_(2) * cef * te * tf + cee * tf * tf;
        REAL share = form / (tt > K_(1e-30) ? tt : K_(1)) / det;
        const bool alike = (strip->see[i] + strip->sff[i] == K_(0)) & (strip->sef[i] == K_(0));
        share = tt > K_(1e-30) && !alike ? (share > K_(0) ? (share < K_(1) ? share : K_(1)) : K_(0))
                                         : K_(1);
        const REAL lower = K_(1) / r_sqrt(det);
        add_shine(&lamp, &glow, s * share, alike ? K_(1) : lower, half, strip, i);
    }
}

FLAT static void kern_specular_toksvig(const LIGHT *light, const SHINE *shine, STRIP *strip)
{
    const REAL s = shine->shininess;
    const LIGHT lamp = *light;
    const SHINE glow = *shine;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        Half half = half_of(strip, i);
        REAL share = K_(1) / (K_(1) + s * (K_(0.5) * (strip->see[i] + strip->sff[i])));
        add_shine(&lamp, &glow, s * share, share, half, strip, i);
    }
}
