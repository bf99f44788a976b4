/* kern_light_body.h - ambient, diffuse and highlight over strips. A part of kern_body.h;
   the formulas are in shade/light_body.h. */

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
        VEC w = light_toward(LOAD3(strip, p, i), eye);
        STORE3(strip, v, i, w);
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
            VEC w = light_toward(LOAD3(strip, p, i), where);
            STORE3(strip, l, i, w);
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
        REAL lit = light_lit(strip->n_dot_l[i]);
        strip->dr[i] += r * lit;
        strip->dg[i] += g * lit;
        strip->db[i] += b * lit;
    }
}

ALWAYS Half half_of(const STRIP *strip, int i)
{
    return light_half(LOAD3(strip, l, i), LOAD3(strip, v, i), LOAD3(strip, b, i));
}

FLAT static void kern_specular(const LIGHT *light, REAL ks, REAL shininess, bool gate, STRIP *strip)
{
    const REAL r = ks * light->rgb[0], g = ks * light->rgb[1], b = ks * light->rgb[2];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        Half half = half_of(strip, i);
        REAL shine = light_lobe(half.c, half.below, shininess);
        shine = light_shown(shine, gate, strip->n_dot_l[i], half.there);
        strip->sr[i] += r * shine;
        strip->sg[i] += g * shine;
        strip->sb[i] += b * shine;
    }
}

FLAT static void kern_finish(const REAL colour[3], STRIP *strip)
{
    const REAL r = colour[0], g = colour[1], b = colour[2];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        strip->cr[i] = light_sum(r, strip->cr[i], strip->dr[i], strip->sr[i]);
        strip->cg[i] = light_sum(g, strip->cg[i], strip->dg[i], strip->sg[i]);
        strip->cb[i] = light_sum(b, strip->cb[i], strip->db[i], strip->sb[i]);
    }
}
