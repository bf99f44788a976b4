/* kern_intensity_bound_body.h - rigorous bounds of the deviation of a pixel's intensity from that at its centre.
   Part of kern_body.h.

   Steps: the area of the pixel on the surface (u, v, |P - P0|, and |n - n0| = turn); the least and largest
   slopes there, from the RANGE pyramid, since bilinear interpolation stays within its taps; the change of n' =
   (n - g)/|n - g|, g = Fu a + Fv b, by
       |n' - n0'| <= |n - n0| + |g - g0|        (both vectors have length 1 or more: the projection to the
                                                 unit ball increases no distance)
   and of each light's share, since max(0, n'.l) changes by at most |n' - n0'| + |l - l0| and c^s increases with
   c. NO_BOUND where a step has no bound. A margin for rounding is added. */

#define NO_BOUND ((REAL)FLT_MAX) /* not INFINITY: the fast sets assume finite numbers */
#define LOOSE K_(1.0001)         /* margin: bounds are computed in rounded arithmetic */

/* A corner of the pixel on the quad's plane. */
typedef struct Corner {
    REAL u, v;
    bool front; /* beyond the near plane, on the side of the centre */
} Corner;

ALWAYS Corner corner_at(const RAYS *rays, const QUAD *quad, REAL x, REAL y, REAL side)
{
    const VEC o = { quad->origin[0], quad->origin[1], quad->origin[2] };
    const VEC n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const VEC eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const VEC ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    VEC q = RAY_Q(rays, y, x), d = RAY_D(rays, y, x);
    REAL dn = v_dot(d, n), s = v_dot(v_sub(o, q), n) / (dn != K_(0) ? dn : K_(1));
    VEC p = v_sub(v_mad(q, d, s), o);
    return (Corner){ v_dot(p, eu), v_dot(p, ev), (dn * side > K_(0)) & (s > rays->s_min) };
}

/* A plane is seen through a projective map: the pixel is the quadrilateral of its corners. */
FLAT static void kern_bound_quad(const RAYS *rays, const QUAD *quad, REAL pixel, STRIP *strip)
{
    const VEC eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const VEC ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    const VEC n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const REAL len_u = K_(1) / v_dot(eu, eu), len_v = K_(1) / v_dot(ev, ev); /* |Pu|^2, |Pv|^2 */
    const REAL h = K_(0.5) * pixel;
    const REAL inside = K_(1.5e-6); /* larger than a joint (view.c) */
    const RAYS r = *rays;
    const QUAD face = *quad;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        REAL x = strip->x[i], y = strip->y[i], u = strip->u[i], v = strip->v[i];
        REAL side = v_dot(RAY_D(&r, y, x), n);
        Corner a = corner_at(&r, &face, x - h, y - h, side);
        Corner b = corner_at(&r, &face, x + h, y - h, side);
        Corner c = corner_at(&r, &face, x - h, y + h, side);
        Corner d = corner_at(&r, &face, x + h, y + h, side);
        REAL u0 = smaller(smaller(a.u, b.u), smaller(c.u, d.u));
        REAL u1 = larger(larger(a.u, b.u), larger(c.u, d.u));
        REAL v0 = smaller(smaller(a.v, b.v), smaller(c.v, d.v));
        REAL v1 = larger(larger(a.v, b.v), larger(c.v, d.v));
        bool whole = a.front & b.front & c.front & d.front;
        whole = whole & (u0 > face.u0 + inside) & (u1 < face.u1 - inside);
        whole = whole & (v0 > face.v0 + inside) & (v1 < face.v1 - inside);
        REAL du = larger(u1 - u, u - u0), dv = larger(v1 - v, v - v0);
        strip->u_low[i] = u0, strip->u_high[i] = u1;
        strip->v_low[i] = v0, strip->v_high[i] = v1;
        strip->reach[i] = LOOSE * r_sqrt(du * du * len_u + dv * dv * len_v);
        strip->turn[i] = K_(0);
        strip->bound[i] = whole ? K_(0) : NO_BOUND;
    }
}

/* On a sphere of radius R a ray whose distance from the centre is rho hits the surface at an angle of sine rho /
   R. Within the pixel rho grows at most by the distance between rays, r; so P moves at most r / cos along the
   sphere. */
FLAT static void kern_bound_sphere(const RAYS *rays, const SHAPE *shape, REAL pixel, STRIP *strip)
{
    const REAL R = shape->value[0], h = K_(0.5) * pixel;
    const VEC qx = { rays->qx[0], rays->qx[1], rays->qx[2] };
    const VEC qy = { rays->qy[0], rays->qy[1], rays->qy[2] };
    const VEC dx = { rays->dx[0], rays->dx[1], rays->dx[2] };
    const VEC dy = { rays->dy[0], rays->dy[1], rays->dy[2] };
    const REAL ee =
        rays->eye[0] * rays->eye[0] + rays->eye[1] * rays->eye[1] + rays->eye[2] * rays->eye[2];
    const bool far = !rays->perspective || ee > K_(1.02) * R * R;
    const RAYS r = *rays;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        VEC q = RAY_Q(&r, strip->y[i], strip->x[i]), d = RAY_D(&r, strip->y[i], strip->x[i]);
        REAL dd = v_dot(d, d), m = v_dot(q, d) / dd, long_ = K_(2) * R / r_sqrt(dd);
        VEC foot = v_mad(q, d, -m);
        REAL rho = r_sqrt(v_dot(foot, foot)), s0 = -m - long_, s1 = -m + long_;
        VEC x0 = v_mad(qx, dx, s0), x1 = v_mad(qx, dx, s1);
        VEC y0 = v_mad(qy, dy, s0), y1 = v_mad(qy, dy, s1);
        REAL along = r_sqrt(larger(v_dot(x0, x0), v_dot(x1, x1)));
        REAL down = r_sqrt(larger(v_dot(y0, y0), v_dot(y1, y1)));
        REAL apart = LOOSE * h * (along + down), sine = LOOSE * (rho + apart) / R;
        REAL cosine2 = K_(1) - sine * sine;
        REAL turn = LOOSE * apart / (R * r_sqrt(larger(cosine2, K_(1e-6))));
        REAL z = strip->nz[i], lat = r_sqrt(larger(K_(1) - z * z, K_(0))) - turn;
        REAL lng = turn / larger(lat, K_(1e-6));
        REAL du = lng * K_(0.15915495), dv = turn * K_(0.31830990);
        strip->u_low[i] = strip->u[i] - du, strip->u_high[i] = strip->u[i] + du;
        strip->v_low[i] = strip->v[i] - dv, strip->v_high[i] = strip->v[i] + dv;
        strip->reach[i] = turn * R;
        strip->turn[i] = turn;
        strip->bound[i] = (far & (cosine2 > K_(1e-4)) & (lat > K_(0.05))) ? K_(0) : NO_BOUND;
    }
}

/* The texels of one axis that an interval of the parameter reads: one run of them, or two across the end. */
typedef struct Reach {
    int first[2], last[2], runs;
    int span; /* number of texels; 0: unknown */
} Reach;

static inline Reach reach_of(double low, double high, int n, bool periodic)
{
    const double slack = 0.02; /* texels */
    double from = n * low - 0.5 - slack, to = n * high - 0.5 + slack;
    Reach reach = { { 0 }, { n - 1 }, 1, n };
    if (!periodic && !(from >= 0.0 && to <= n - 1.0)) return (Reach){ { 0 }, { 0 }, 0, 0 };
    if (!(to - from < n - 2.0) || !(from > -1e9) || !(to < 1e9)) return reach;
    int first = (int)__builtin_floor(from), last = (int)__builtin_floor(to) + 1;
    int i0 = (first % n + n) % n, i1 = (last % n + n) % n;
    reach.span = last - first + 1;
    reach.first[0] = i0, reach.last[0] = i1;
    if (i1 < i0) reach.runs = 2, reach.last[0] = n - 1, reach.last[1] = i1;
    return reach;
}

/* Least and largest slopes of those texels, from blocks so large that only a few are read. */
static inline void look_range(const WrPyramid *range, Reach u, Reach v, float out[4])
{
    const int span = u.span > v.span ? u.span : v.span;
    int level = 0;
    while (level + 1 < range->levels && span >> level > 4) level++;
    const WrPyramidLevel *at = &range->level[level];
    out[0] = out[2] = FLT_MAX, out[1] = out[3] = -FLT_MAX;
    for (int b = 0; b < v.runs; b++)
        for (int j = v.first[b] >> level; j <= v.last[b] >> level; j++)
            for (int a = 0; a < u.runs; a++)
                for (int i = u.first[a] >> level; i <= u.last[a] >> level; i++) {
                    const float *t =
                        at->data + 4 * ((size_t)(j + 1) * (size_t)at->pitch + (size_t)(i + 1));
                    out[0] = t[0] < out[0] ? t[0] : out[0];
                    out[1] = t[1] > out[1] ? t[1] : out[1];
                    out[2] = t[2] < out[2] ? t[2] : out[2];
                    out[3] = t[3] > out[3] ? t[3] : out[3];
                }
}

FLAT static void kern_bound_slopes(const LOOK *look, STRIP *strip)
{
    const double ru = look->ru, rv = look->rv;
    const int count = strip->count;
    for (int k = 0; k < count; k++) {
        if (!(strip->bound[k] < NO_BOUND)) continue;
        double u0 = ru * (double)strip->u_low[k], u1 = ru * (double)strip->u_high[k];
        double v0 = 1.0 - rv * (double)strip->v_high[k], v1 = 1.0 - rv * (double)strip->v_low[k];
        Reach u = reach_of(u0 < u1 ? u0 : u1, u0 < u1 ? u1 : u0, look->width, look->periodic_u);
        Reach v = reach_of(v0 < v1 ? v0 : v1, v0 < v1 ? v1 : v0, look->height, look->periodic_v);
        if (u.span == 0 || v.span == 0) {
            strip->bound[k] = NO_BOUND;
            continue;
        }
        float slopes[4];
        look_range(look->range, u, v, slopes);
        REAL a = (REAL)slopes[0] * look->scale_u, b = (REAL)slopes[1] * look->scale_u;
        REAL c = (REAL)slopes[2] * look->scale_v, d = (REAL)slopes[3] * look->scale_v;
        strip->fu_low[k] = smaller(a, b), strip->fu_high[k] = larger(a, b);
        strip->fv_low[k] = smaller(c, d), strip->fv_high[k] = larger(c, d);
    }
}

/* On the sphere a = e_phi / (2 pi R cos), b = e_lambda / (pi R): they change with the latitude and rotate with
   the position; on a plane they are constant. */
FLAT static void kern_bound_normal(bool sphere, bool bumped, STRIP *strip)
{
    const REAL curved = sphere ? K_(1) : K_(0), bump = bumped ? K_(1) : K_(0);
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        VEC pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
        REAL lu = r_sqrt(v_dot(pu, pu)), lv = r_sqrt(v_dot(pv, pv));
        REAL area = strip->n_len[i] > K_(1e-20) ? strip->n_len[i] : K_(1e-20);
        REAL turn = strip->turn[i], a = lv / area, b = lu / area;
        REAL fu = strip->fu[i], fv = strip->fv[i];
        REAL du = larger(strip->fu_high[i] - fu, fu - strip->fu_low[i]);
        REAL dv = larger(strip->fv_high[i] - fv, fv - strip->fv_low[i]);
        REAL lat = K_(0.5) * lu / lv, least = larger(lat - turn, K_(1e-3));
        REAL most_a = curved != K_(0) ? a * lat / least : a, lng = turn / least;
        REAL flat = most_a * du + b * dv;
        REAL bent = r_abs(fu) * ((most_a - a) + a * lng) + r_abs(fv) * b * (turn + lng);
        REAL swing = turn + bump * (flat + curved * bent);
        strip->swing[i] = LOOSE * swing + K_(1e-6);
    }
}

/* Change of the direction of a vector of that length when it moves by at most `move`. */
ALWAYS REAL turn_of(REAL move, REAL length)
{
    REAL left = length - move;
    REAL turn = move / (left > K_(1e-6) ? left : K_(1e-6));
    return turn < K_(2) ? turn : K_(2);
}

FLAT static void kern_bound_light(const RAYS *rays, const LIGHT *light, const SHINE *shine, REAL kd,
                                  STRIP *strip)
{
    const REAL most = larger(light->rgb[0], larger(light->rgb[1], light->rgb[2]));
    const VEC where = { light->where[0], light->where[1], light->where[2] };
    const VEC eye = { rays->eye[0], rays->eye[1], rays->eye[2] };
    const REAL near_light = light->point ? K_(1) : K_(0);
    const REAL near_eye = rays->perspective ? K_(1) : K_(0);
    const bool gate = shine->gate;
    const REAL s = shine->shininess;
    const REAL diffuse = kd * most, specular = shine->ks * most;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        VEC p = LOAD3(strip, p, i), wl = v_sub(where, p), we = v_sub(eye, p);
        REAL move = strip->reach[i];
        REAL dl = near_light * turn_of(move, r_sqrt(v_dot(wl, wl)));
        REAL de = near_eye * turn_of(move, r_sqrt(v_dot(we, we)));
        REAL d = strip->n_dot_l[i], dd = strip->swing[i] + dl;
        REAL d0 = larger(d - dd, K_(0)), d1 = larger(d + dd, K_(0)), lit = light_lit(d);
        REAL change = diffuse * larger(smaller(d1, K_(1)) - lit, lit - d0);

        Half half = half_of(strip, i);
        VEC lv = v_add(LOAD3(strip, l, i), LOAD3(strip, v, i));
        REAL dh = turn_of(dl + de, r_sqrt(v_dot(lv, lv)));
        REAL c = larger(half.c, K_(0)), dc = strip->swing[i] + dh;
        REAL c0 = larger(c - dc, K_(0)), c1 = smaller(c + dc, K_(1));
        REAL low = light_lobe(c0, half.below + dc, s), high = light_lobe(c1, half.below - dc, s);
        REAL now = light_lobe(smaller(c, K_(1)), half.below, s);
        low = light_shown(low, gate, d - dd, half.there);
        high = light_shown(high, gate, d + dd, true);
        now = light_shown(now, gate, d, half.there);
        change += specular * larger(high - now, now - low);
        strip->bound[i] += LOOSE * change + K_(1e-7);
    }
}
