/* kern_light_body.h - ambient, diffuse and highlight over strips. A part of kern_body.h. */

FLAT static void kern_view(const RAYS *rays, STRIP *strip)
{
    const int count = strip->count;
    if (!rays->perspective) {
        const VEC toward = { rays->toward[0], rays->toward[1], rays->toward[2] };
        SIMD for (int i = 0; i < count; i++)
        {
            STORE3(strip, v, i, toward);
        }
        return;
    }
    const VEC eye = { rays->eye[0], rays->eye[1], rays->eye[2] };
    SIMD for (int i = 0; i < count; i++)
    {
        VEC w = v_sub(eye, LOAD3(strip, p, i));
        REAL ww = v_dot(w, w), inv = 1.0f / r_sqrt(ww > 1e-30f ? ww : 1.0f);
        STORE3(strip, v, i, v_scale(w, inv));
    }
}

/* The sums start at the ambient light; C(u,v) is 1 unless a picture follows. */
FLAT static void kern_begin(REAL ambient, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        strip->dr[i] = strip->dg[i] = strip->db[i] = ambient;
        strip->sr[i] = strip->sg[i] = strip->sb[i] = 0.0f;
        strip->cr[i] = strip->cg[i] = strip->cb[i] = 1.0f;
    }
}

FLAT static void kern_light(const LIGHT *light, STRIP *strip)
{
    const VEC where = { light->where[0], light->where[1], light->where[2] };
    const int count = strip->count;
    if (!light->point) {
        SIMD for (int i = 0; i < count; i++)
        {
            STORE3(strip, l, i, where);
        }
    } else {
        SIMD for (int i = 0; i < count; i++)
        {
            VEC w = v_sub(where, LOAD3(strip, p, i));
            REAL ww = v_dot(w, w), inv = 1.0f / r_sqrt(ww > 1e-30f ? ww : 1.0f);
            STORE3(strip, l, i, v_scale(w, inv));
        }
    }
    SIMD for (int i = 0; i < count; i++)
    {
        strip->n_dot_l[i] =
            strip->bx[i] * strip->lx[i] + strip->by[i] * strip->ly[i] + strip->bz[i] * strip->lz[i];
    }
}

FLAT static void kern_diffuse(const LIGHT *light, REAL kd, STRIP *strip)
{
    const REAL r = kd * light->rgb[0], g = kd * light->rgb[1], b = kd * light->rgb[2];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        REAL lit = strip->n_dot_l[i] > 0.0f ? strip->n_dot_l[i] : 0.0f;
        strip->dr[i] += r * lit;
        strip->dg[i] += g * lit;
        strip->db[i] += b * lit;
    }
}

/* The half vector h = (l + v) / |l + v|. What a high power is taken of is 1 - n'.h: near 1 that is
   |n' - h|^2 / 2, to which rounding of the lengths of n' and h does nothing (HC89). */
typedef struct Half {
    VEC h;         /* unit; 0 where l and v are opposite */
    REAL c, below; /* n'.h; 1 - n'.h */
    bool there;
} Half;

ALWAYS Half half_of(const STRIP *strip, int i)
{
    VEC h = v_add(LOAD3(strip, l, i), LOAD3(strip, v, i)), bent = LOAD3(strip, b, i);
    REAL hh = v_dot(h, h);
    bool there = hh > 1e-24f;
    h = v_scale(h, there ? K_(1) / r_sqrt(there ? hh : K_(1)) : K_(0));
    REAL c = v_dot(bent, h);
    VEC off = v_sub(bent, h);
    return (Half){ h, c, c > K_(0.5) ? K_(0.5) * v_dot(off, off) : K_(1) - c, there };
}

/* max(0, n'.h)^s; 0 where l and v are opposite (HC91). */
FLAT static void kern_specular(const LIGHT *light, REAL ks, REAL shininess, bool gate, STRIP *strip)
{
    const REAL r = ks * light->rgb[0], g = ks * light->rgb[1], b = ks * light->rgb[2];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        Half half = half_of(strip, i);
        REAL shine = r_pow_below(half.c > 0.0f ? half.c : 0.0f, half.below, shininess);
        shine = (!gate || strip->n_dot_l[i] > 0.0f) && half.there ? shine : 0.0f;
        strip->sr[i] += r * shine;
        strip->sg[i] += g * shine;
        strip->sb[i] += b * shine;
    }
}

/* I = C (ambient + diffuse) + specular */
FLAT static void kern_finish(const REAL colour[3], STRIP *strip)
{
    const REAL r = colour[0], g = colour[1], b = colour[2];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        strip->cr[i] = r * strip->cr[i] * strip->dr[i] + strip->sr[i];
        strip->cg[i] = g * strip->cg[i] * strip->dg[i] + strip->sg[i];
        strip->cb[i] = b * strip->cb[i] * strip->db[i] + strip->sb[i];
    }
}
