/* kern_light_body.h - ambient light, diffuse light and highlights over strips. Part of kern_body.h; the formulas
   are in shade/light_body.h. */

/* v is constant for parallel rays; otherwise (e - P) / |e - P|. */
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

/* l is constant for a distant lamp; otherwise (L - P) / |L - P|. n'.l is kept unclamped: the gate and the dark
   test need its sign. */
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

/* D += kd I max(n'.l, 0). */
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

/* S += ks I (n'.h)^s. Where n'.h is near 1, the power uses 1 - n'.h (`below`), computed without cancellation
   (light_body.h). */
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

/* colour C D + S, with C of the picture and D with ambient light; a tinted highlight goes another way
   (kern_tint). */
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

/* ---- all of a single light in one pass: no intermediate results are stored. The formulas and their order are
   those of the separate stages, so the bits are equal with exact arithmetic. ---- */

ALWAYS REAL bent_dot(const STRIP *strip, int i, VEC l)
{
    return strip->bx[i] * l.x + strip->by[i] * l.y + strip->bz[i] * l.z;
}

/* Highlights, and the bases of their powers. Short loops, each of a few dozen operations: a processor reorders
   only a limited number of them, so one long chain of operations per sample would leave it waiting. */
typedef struct Lobes {
    REAL c[WR_SPAN], below[WR_SPAN]; /* of `half` */
    REAL shown[WR_SPAN];             /* 1, or 0 where there is no highlight */
    REAL lobe[WR_SPAN];
    REAL vx[WR_SPAN], vy[WR_SPAN], vz[WR_SPAN]; /* unit, towards the viewer */
} Lobes;

ALWAYS void find_lobes(const RAYS *rays, const LIGHT *light, const SHINE *shine, const bool point,
                       const bool near, const STRIP *strip, Lobes *lobes)
{
    const VEC where = { light->where[0], light->where[1], light->where[2] };
    const REAL *from = near ? rays->eye : rays->toward;
    const VEC viewer = { from[0], from[1], from[2] };
    const REAL power = shine->shininess;
    const bool gate = shine->gate;
    const int count = WHOLE(strip->count);
    if (near) {
        SIMD for (int i = 0; i < count; i++)
        {
            VEC v = light_toward(LOAD3(strip, p, i), viewer);
            lobes->vx[i] = v.x, lobes->vy[i] = v.y, lobes->vz[i] = v.z;
        }
    }
    SIMD for (int i = 0; i < count; i++)
    {
        VEC p = LOAD3(strip, p, i), bent = LOAD3(strip, b, i);
        VEC l = point ? light_toward(p, where) : where;
        VEC v = near ? LOAD3(lobes, v, i) : viewer;
        Half half = light_half(l, v, bent);
        lobes->c[i] = half.c;
        lobes->below[i] = half.below;
        lobes->shown[i] = light_shown(K_(1), gate, bent_dot(strip, i, l), half.there);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        REAL lobe = light_lobe(lobes->c[i], lobes->below[i], power);
        lobes->lobe[i] = lobes->shown[i] != K_(0) ? lobe : K_(0);
    }
}

ALWAYS void shade_one(const RAYS *rays, const LIGHT *light, const SHINE *shine,
                      const MATERIAL *material, const bool point, const bool near,
                      const bool shines, const bool pictured, STRIP *strip)
{
    const VEC where = { light->where[0], light->where[1], light->where[2] };
    const REAL kd = material->kd, ks = shine->ks;
    const REAL dr = kd * light->rgb[0], dg = kd * light->rgb[1], db = kd * light->rgb[2];
    const REAL sr = ks * light->rgb[0], sg = ks * light->rgb[1], sb = ks * light->rgb[2];
    const REAL r = material->rgb[0], g = material->rgb[1], b = material->rgb[2];
    const REAL ambient = material->ambient;
    const int count = WHOLE(strip->count);
    Lobes lobes;
    if (shines) find_lobes(rays, light, shine, point, near, strip, &lobes);
    SIMD for (int i = 0; i < count; i++)
    {
        VEC l = point ? light_toward(LOAD3(strip, p, i), where) : where;
        REAL lit = light_lit(bent_dot(strip, i, l)), lobe = shines ? lobes.lobe[i] : K_(0);
        REAL pr = pictured ? strip->cr[i] : K_(1), pg = pictured ? strip->cg[i] : K_(1);
        REAL pb = pictured ? strip->cb[i] : K_(1);
        strip->cr[i] = light_sum(r, pr, ambient + dr * lit, sr * lobe);
        strip->cg[i] = light_sum(g, pg, ambient + dg * lit, sg * lobe);
        strip->cb[i] = light_sum(b, pb, ambient + db * lit, sb * lobe);
    }
}

#ifndef WR_KERN_DOUBLE
/* All 16 combinations are compiled: `point`, `near`, `shines`, `pictured` are constants in each loop, so no
   lane has a branch. */
#define SHADE(point, near, shines, pictured)                                                       \
    FLAT static void kern_shade_##point##near##shines##pictured(                                   \
        const RAYS *rays, const LIGHT *light, const SHINE *shine, const MATERIAL *material,        \
        STRIP *strip)                                                                              \
    {                                                                                              \
        shade_one(rays, light, shine, material, point, near, shines, pictured, strip);             \
    }
#define SHADES(point, near)                                                                        \
    SHADE(point, near, 0, 0)                                                                       \
    SHADE(point, near, 0, 1) SHADE(point, near, 1, 0) SHADE(point, near, 1, 1)
SHADES(0, 0)
SHADES(0, 1)
SHADES(1, 0)
SHADES(1, 1)
#define SHADE_ROWS(point, near)                                                                    \
    {                                                                                              \
        { kern_shade_##point##near##00, kern_shade_##point##near##01 },                            \
        {                                                                                          \
            kern_shade_##point##near##10, kern_shade_##point##near##11                             \
        }                                                                                          \
    }
#endif
