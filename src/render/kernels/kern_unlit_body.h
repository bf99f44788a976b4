/* kern_unlit_body.h - test for samples that lights are behind, however the table bends their normals, and the
   light that remains there. Part of kern_body.h.

   n' lies along s (|N| n + D), D = n x (Fu Pv - Fv Pu), s the viewer's side. So towards a light l it has
     s |N| n.l + s (Fu Pv - Fv Pu).c,  c = l x n:  at most  s |N| n.l + |Fu| |Pv.c| + |Fv| |Pu.c|.
   If, with the largest slopes that can be fetched, that is below 0 by more than rounding, n'.l is not above 0. */

#define DARK_BY K_(1e-5) /* of the terms' size; rounding is a hundredth of that */

ALWAYS REAL spread_of(VEC a)
{
    return r_abs(a.x) + r_abs(a.y) + r_abs(a.z);
}

/* 1: the light may reach the sample; 0: it is behind. fu, fv: the largest slopes, either sign. */
ALWAYS int may_shine(Viewer viewer, Viewer lamp, const bool bumped, REAL fu, REAL fv,
                     const STRIP *strip, int i)
{
    VEC p = LOAD3(strip, p, i), n = LOAD3(strip, n, i);
    VEC l = v_mad(lamp.at, p, -lamp.near);
    REAL most = v_dot(n, l) * side_of(viewer, strip, i), size = spread_of(l);
    if (bumped) {
        VEC c = v_cross(l, n), pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
        REAL n_len = strip->n_len[i];
        most = most * n_len + fu * r_abs(v_dot(pv, c)) + fv * r_abs(v_dot(pu, c));
        size *= n_len + fu * spread_of(pv) + fv * spread_of(pu);
    }
    return most < -DARK_BY * size ? 0 : 1;
}

ALWAYS bool all_behind(const RAYS *rays, const LIGHT *light, const bool bumped, REAL fu, REAL fv,
                       int step, const STRIP *strip)
{
    const Viewer viewer = viewer_of(rays);
    const Viewer lamp = { { light->where[0], light->where[1], light->where[2] },
                          light->point ? K_(1) : K_(0) };
    const int count = strip->count;
    int shown = 0;
    if (step > 1) {
        for (int i = 0; i < count; i += step)
            shown += may_shine(viewer, lamp, bumped, fu, fv, strip, i);
        return shown == 0;
    }
    SIMD_SUM(shown) for (int i = 0; i < count; i++)
    {
        shown += may_shine(viewer, lamp, bumped, fu, fv, strip, i);
    }
    return shown == 0;
}

FLAT static bool kern_behind(const RAYS *rays, const LIGHT *light, int step, const STRIP *strip)
{
    return all_behind(rays, light, false, K_(0), K_(0), step, strip);
}

FLAT static bool kern_behind_bumped(const RAYS *rays, const LIGHT *light, const REAL steepest[2],
                                    int step, const STRIP *strip)
{
    return all_behind(rays, light, true, steepest[0], steepest[1], step, strip);
}

#ifdef WR_KERN_PLAIN
#define SIMD_BOX
#else
#define SIMD_BOX _Pragma("omp simd reduction(min : u0, v0) reduction(max : u1, v1)")
#endif

FLAT static void kern_reach(const STRIP *strip, double box[4])
{
    const int count = strip->count;
    REAL u0 = strip->u[0], u1 = u0, v0 = strip->v[0], v1 = v0;
    SIMD_BOX for (int i = 0; i < count; i++)
    {
        u0 = strip->u[i] < u0 ? strip->u[i] : u0;
        u1 = strip->u[i] > u1 ? strip->u[i] : u1;
        v0 = strip->v[i] < v0 ? strip->v[i] : v0;
        v1 = strip->v[i] > v1 ? strip->v[i] : v1;
    }
    box[0] = (double)u0, box[1] = (double)u1, box[2] = (double)v0, box[3] = (double)v1;
}

/* I = C ambient + 0: the bits of the full computation where no light adds anything. */
FLAT static void kern_ambient(const MATERIAL *material, bool pictured, STRIP *strip)
{
    const REAL r = material->rgb[0], g = material->rgb[1], b = material->rgb[2];
    const REAL ambient = material->ambient;
    const int count = strip->count;
    if (!pictured) {
        const REAL one_r = light_sum(r, K_(1), ambient, K_(0));
        const REAL one_g = light_sum(g, K_(1), ambient, K_(0));
        const REAL one_b = light_sum(b, K_(1), ambient, K_(0));
        SIMD for (int i = 0; i < count; i++)
        {
            strip->cr[i] = one_r, strip->cg[i] = one_g, strip->cb[i] = one_b;
        }
        return;
    }
    SIMD for (int i = 0; i < count; i++)
    {
        strip->cr[i] = light_sum(r, strip->cr[i], ambient, K_(0));
        strip->cg[i] = light_sum(g, strip->cg[i], ambient, K_(0));
        strip->cb[i] = light_sum(b, strip->cb[i], ambient, K_(0));
    }
}
