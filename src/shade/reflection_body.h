/* reflection_body.h - formulas of the reflection models for one lamp and one sample: pi f (n.l), for
   both precisions and every kernel.

   Included after light_body.h, which contains Blinn-Phong. Only ?:, no branches, so that loops over
   samples vectorise; arguments that are equal for all samples are compile-time constants. No include
   guard: compiled once per precision. The reference renderer has its own formulas.

     phong              kd (n.l) + ks (r.v)^s,  r = 2 (n.l) n - l                               Phong 1975
                        kept: ks (n.l) (s + 2)/2 (r.v)^s                                        Lewis 1994
     torrance-sparrow   kd (n.l) + ks k D G F / (n.v), D = a^4 / ((n.h)^2 a^2 + |n x h|^2)^2
                                                                          Blinn 1977, Trowbridge and Reitz 1975
                        G = min(1, 2 (n.h)(n.v)/(v.h), 2 (n.h)(n.l)/(v.h)), F Fresnel's, exact;
                        k = 1, D(0) = 1; kept: k = 1 / (4 a^2)
     oren-nayar         kd (n.l) (A + B max(0,q) / max(n.l, n.v)),  q = l.v - (n.l)(n.v)         Oren, Nayar 1994
                        kept: kd (n.l) A (1 + sigma q / t) and interreflection
                                                                          Fujii; Portsmouth, Kutz, Hill 2024
     ggx                kd (1 - metal)(n.l)(1 - F) + ks D F (n.l) V, F Schlick's
                                                                          Walter and others 2007, Heitz 2014, glTF 2.0
                        kept: (1 - E(n.l))(1 - E(n.v)) / (1 - mean E) for 1 - F
                                                                          Kelemen, Szirmay-Kalos 2001

   All are 0 unless n.l > 0. */

/* Contribution of one lamp of strength 1. */
typedef struct Reflected {
    REAL own,  /* in the surface's colour */
        white, /* in the lamp's */
        again; /* interreflection: own, times each colour's kept fraction (reflect_kept) */
} Reflected;

/* Distribution of facet slopes: covariance M in the tangent plane of n', along e, across it, and mixed;
 * alike: the material's own. */
typedef struct Facets {
    VEC e, f;
    REAL ee, ef, ff, det;
    bool alike;
} Facets;

/* Variant of a model, known at compile time. */
typedef struct Form {
    bool kept, spread, round, known_left, /* known_left: `left` is given */
        facing,                           /* n' faces the viewer: it is not bent */
        dull;                             /* and no highlight is as bright as `least` */
} Form;

/* A sample that reflects a lamp's light. */
typedef struct Incidence {
    VEC n, l, v;
    Facets facets;
    REAL spread; /* of slopes: trace of their covariance; 0 unless form.spread */
    REAL left;   /* form.known_left: fraction of diffuse light left by highlights */
} Incidence;

/* reflect_FORMULA(Incidence, Form, const MATTER *) are the formulas of shade/reflection_models.h. */

R_INLINE REAL reflect_positive(REAL x)
{
    return x > K_(0) ? x : K_(0);
}

R_INLINE REAL reflect_least(REAL a, REAL b)
{
    return a < b ? a : b;
}

/* n' for facets: where bump turned it away from the viewer of a visible point, it is bent back until
   n'.v is slightly above 0, continuously (HC105, HC106). */
R_INLINE VEC reflect_seen(VEC n, VEC v)
{
    const REAL short_of = reflect_positive(K_(1e-3) - v_dot(n, v));
    const VEC w = v_add(n, v_scale(v, short_of));
    const REAL ww = v_dot(w, w);
    return v_scale(w, short_of > K_(0) ? K_(1) / r_sqrt(ww) : K_(1));
}

/* Facet slopes of width alpha, widened by the covariance of slopes (moments): M = alpha^2 + 2 C; round:
   by its mean. det M is at least that without it (HC109). */
R_INLINE Facets reflect_facets(VEC n, VEC e, REAL see, REAL sef, REAL sff, bool round, REAL a2)
{
    const REAL mean = see + sff;
    const REAL ee = a2 + (round ? mean : K_(2) * see), ff = a2 + (round ? mean : K_(2) * sff);
    const REAL ef = round ? K_(0) : K_(2) * sef, det = ee * ff - ef * ef, least = a2 * a2;
    const bool alike = (see + sff == K_(0)) & (sef == K_(0));
    return (Facets){ e, v_cross(n, e), ee, ef, ff, det > least ? det : least, alike };
}

/* pi D, with |n x h| from the vectors: 1 - (n.h)^2 would lose the digits of narrow highlights (HC99). */
R_INLINE REAL reflect_d(VEC n, VEC h, REAL a2)
{
    const VEC x = v_cross(n, h);
    const REAL nh = v_dot(n, h), w = a2 * nh * nh + v_dot(x, x);
    return a2 / (w * w);
}

R_INLINE REAL reflect_d_wide(VEC n, VEC h, Facets m)
{
    const REAL te = v_dot(h, m.e), tf = v_dot(h, m.f), nh = v_dot(n, h);
    const REAL form = (m.ff * te * te - K_(2) * m.ef * te * tf + m.ee * tf * tf) / m.det;
    const REAL w = nh * nh + reflect_positive(form);
    return K_(1) / (r_sqrt(m.det) * w * w);
}

/* pi D for the facets; with the material's own distribution bit for bit reflect_d (E39). */
R_INLINE REAL reflect_lobe(VEC n, VEC h, Facets wide, Form form, REAL a2)
{
    const REAL own = reflect_d(n, h, a2);
    if (!form.spread) return own;
    const REAL d = reflect_d_wide(n, h, wide);
    return wide.alike ? own : d;
}

/* sqrt(cos^2 + w^T M w) for a direction w, used by its shadowing. */
R_INLINE REAL reflect_long(REAL cosine, REAL a2)
{
    return r_sqrt(cosine * cosine * (K_(1) - a2) + a2);
}

R_INLINE REAL reflect_long_wide(VEC w, REAL cosine, Facets m)
{
    const REAL te = v_dot(w, m.e), tf = v_dot(w, m.f);
    const REAL form = m.ee * te * te + K_(2) * m.ef * te * tf + m.ff * tf * tf;
    return r_sqrt(cosine * cosine + reflect_positive(form));
}

/* Fresnel's reflectance of unpolarised light, c = v.h, without cancellation (HC102). */
R_INLINE REAL reflect_fresnel(REAL c, REAL ior)
{
    const REAL i2 = ior * ior, gg = i2 - K_(1) + c * c;
    const REAL g = r_sqrt(reflect_positive(gg)), s = g + c, p = i2 * c + g, ss = s * s;
    const REAL rs = (i2 - K_(1)) / (ss > K_(1e-24) ? ss : K_(1));
    const REAL rp = (i2 * c - g) / (p > K_(1e-12) ? p : K_(1));
    const REAL f = K_(0.5) * (rs * rs + rp * rp);
    return gg < K_(0) ? K_(1) : reflect_least(f, K_(1));
}

/* (1 - c)^5 */
R_INLINE REAL reflect_fifth(REAL c)
{
    const REAL off = reflect_positive(K_(1) - c), two = off * off;
    return two * two * off;
}

/* reflect_long for the facets. */
R_INLINE REAL reflect_span(VEC w, REAL cosine, Facets wide, Form form, REAL a2)
{
    const REAL own = reflect_long(cosine, a2);
    if (!form.spread) return own;
    const REAL span = reflect_long_wide(w, cosine, wide);
    return wide.alike ? own : span;
}

R_INLINE Reflected reflect_phong(Incidence at, Form form, const MATTER *m)
{
    const VEC n = at.n, l = at.l, v = at.v;
    const REAL nl = v_dot(n, l), lit = reflect_positive(nl);
    const VEC r = v_sub(v_scale(n, K_(2) * nl), l), off = v_sub(r, v);
    const REAL c = v_dot(r, v), below = c > K_(0.5) ? K_(0.5) * v_dot(off, off) : K_(1) - c;
    /* the mirrored direction turns twice as far as n' */
    const REAL share = K_(1) / (K_(1) + K_(2) * m->shininess * at.spread), s = m->shininess * share;
    const REAL strength = form.kept ? lit * K_(0.5) * (s + K_(2)) : share;
    const REAL lobe = r_pow_below(reflect_positive(c), below, s) * strength;
    return (Reflected){ m->kd * lit, nl > K_(0) ? m->ks * lobe : K_(0), K_(0) };
}

R_INLINE Reflected reflect_torrance_sparrow(Incidence at, Form form, const MATTER *m)
{
    const VEC n = at.n, l = at.l, v = at.v;
    const VEC seen = form.facing ? n : reflect_seen(n, v), sum = v_add(l, v);
    const REAL hh = v_dot(sum, sum);
    const bool there = hh > K_(1e-12);
    const REAL len = r_sqrt(there ? hh : K_(1)), vh = reflect_least(K_(0.5) * len, K_(1));
    const VEC h = v_scale(sum, K_(1) / len);
    const REAL nl = v_dot(seen, l), nv = v_dot(seen, v), nh = v_dot(seen, h), lit = v_dot(n, l);
    const REAL d = reflect_lobe(seen, h, at.facets, form, m->alpha * m->alpha);
    const REAL over = K_(1) / nv, cavity = K_(2) * nh / vh;
    const REAL g = reflect_least(over, reflect_least(cavity, cavity * nl * over));
    const REAL shine = m->ks * m->scale * d * g * reflect_fresnel(vh, m->ior);
    const bool shows = there && nl > K_(0) && lit > K_(0) && shine >= m->least && !form.dull;
    return (Reflected){ m->kd * reflect_positive(lit), shows ? shine : K_(0), K_(0) };
}

/* The albedo of Fujii's Oren-Nayar, exact except for the arc cosine (Abramowitz, Stegun 1964, 4.4.46:
 * within 2e-8). */
R_INLINE REAL reflect_matt_albedo(REAL mu, const MATTER *m)
{
    const REAL s = r_sqrt(reflect_positive(K_(1) - mu * mu));
    REAL arc = K_(-.0012624911);
    arc = arc * mu + K_(.0066700901);
    arc = arc * mu + K_(-.0170881256);
    arc = arc * mu + K_(.0308918810);
    arc = arc * mu + K_(-.0501743046);
    arc = arc * mu + K_(.0889789874);
    arc = arc * mu + K_(-.2145988016);
    arc = (arc * mu + K_(1.5707963050)) * r_sqrt(K_(1) - mu);
    const REAL rest = s * mu * (K_(1) + s + s * s) / (K_(1) + s) - s;
    const REAL g = s * (arc - s * mu) + K_(0.66666666666666667) * rest;
    return m->a + m->b * K_(0.31830988618379067) * g;
}

R_INLINE Reflected reflect_oren_nayar(Incidence at, Form form, const MATTER *m)
{
    const VEC n = at.n, l = at.l, v = at.v;
    const REAL nl = v_dot(n, l), lit = reflect_least(reflect_positive(nl), K_(1));
    const REAL nv = reflect_least(reflect_positive(v_dot(n, v)), K_(1));
    const REAL q = v_dot(l, v) - lit * nv, most = lit > nv ? lit : nv;
    const REAL over = K_(1) / (most > K_(1e-12) ? most : K_(1));
    if (!form.kept) {
        const REAL rough = m->a + m->b * reflect_positive(q) * over;
        return (Reflected){ m->kd * lit * rough, K_(0), K_(0) };
    }
    const REAL once = m->a + m->b * q * (q > K_(0) ? over : K_(1));
    const REAL left = (K_(1) - reflect_matt_albedo(lit, m)) * (K_(1) - reflect_matt_albedo(nv, m));
    return (Reflected){ m->kd * lit * once, K_(0),
                        m->kd * lit * reflect_positive(left) * m->again };
}

/* The fraction of interreflected light kept by a surface of reflectance rho: rho mean / (1 - rho (1 -
 * mean)). */
R_INLINE REAL reflect_kept(REAL rho, REAL mean)
{
    const REAL r = reflect_least(reflect_positive(rho), K_(1)); /* HC110 */
    return r * mean / (K_(1) - r * (K_(1) - mean));
}

/* wr_albedo_fit's polynomial. */
R_INLINE REAL reflect_terms(const REAL *a, REAL x)
{
    const REAL xx = x * x, x4 = xx * xx;
    const REAL low = (a[0] + a[1] * x) + (a[2] + a[3] * x) * xx;
    const REAL mid = (a[4] + a[5] * x) + (a[6] + a[7] * x) * xx;
    const REAL high = (a[8] + a[9] * x) + a[10] * xx;
    return low + (mid + high * x4) * x4;
}

/* Argument of an albedo's polynomial. */
R_INLINE REAL reflect_root(REAL mu)
{
    return r_sqrt(reflect_least(reflect_positive(mu), K_(1)));
}

R_INLINE REAL reflect_albedo(REAL mu, const MATTER *m)
{
    return reflect_least(reflect_terms(m->albedo, reflect_root(mu)), K_(1));
}

/* known_left: the fraction of diffuse light left by highlights is at.left; else, kept, it follows from the
   material's albedo. A highlight that is nowhere as bright as `least` is 0. */
R_INLINE Reflected reflect_ggx(Incidence at, Form form, const MATTER *m)
{
    const VEC n = at.n, l = at.l, v = at.v;
    const Facets wide = at.facets;
    const VEC seen = form.facing ? n : reflect_seen(n, v), sum = v_add(l, v);
    const REAL hh = v_dot(sum, sum), a2 = m->alpha * m->alpha;
    const bool there = hh > K_(1e-12);
    const REAL len = r_sqrt(there ? hh : K_(1));
    const VEC h = v_scale(sum, K_(1) / len);
    const REAL nl = v_dot(seen, l), nv = v_dot(seen, v),
               p = reflect_fifth(there ? K_(0.5) * len : K_(0));
    const REAL lit = v_dot(n, l), d = reflect_lobe(seen, h, wide, form, a2);
    const REAL up = reflect_positive(nl);
    const REAL long_v = reflect_span(v, nv, wide, form, a2);
    const REAL long_l = reflect_span(l, nl, wide, form, a2);
    const REAL lobe = m->ks * d * K_(0.5) * up / (up * long_v + nv * long_l);
    const REAL f = m->f0 + (K_(1) - m->f0) * p, matt = m->kd * (K_(1) - m->metal);
    const REAL most = f * (K_(1) - m->metal) + m->metal; /* for a colour up to 1 */
    const bool shows = there && nl > K_(0) && lit > K_(0) && lobe * most >= m->least && !form.dull;
    const REAL shown = shows ? lobe : K_(0);
    const REAL left =
        form.known_left ? at.left
        : form.kept ? (K_(1) - reflect_albedo(lit, m)) * (K_(1) - reflect_albedo(nv, m)) * m->again
                    : K_(1) - f;
    /* metal: f0 is the colour, c + (1 - c) p = c (1 - p) + p */
    return (Reflected){ matt * reflect_positive(lit) * left + m->metal * (K_(1) - p) * shown,
                        (f * (K_(1) - m->metal) + m->metal * p) * shown, K_(0) };
}
