/* kern_hit_body.h - visibility in closed form. A part of kern_body.h. */

/* |q + s d| = R. With m = q.d / d.d the foot of the perpendicular is f = q - m d, and
   s = -m -+ sqrt((R^2 - f.f) / d.d): no difference of large squares. s is kept relative to the foot. */
FLAT static int kern_hit_sphere(const WrRays *rays, const WrShapef *shape, float gx, float gy,
                                int count, WrStrip *strip)
{
    const float r = shape->value[0], r2 = r * r, s_min = rays->s_min;
    const Row row = row_at(rays, gy);
    SIMD for (int i = 0; i < count; i++)
    {
        float g = gx + (float)i;
        WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);
        float dd = v3f_dot(d, d), m = v3f_dot(q, d) / dd;
        WrVec3f f = v3f_mad(q, d, -m);
        float left = r2 - v3f_dot(f, f);
        float half = sqrtf((left > 0.0f ? left : 0.0f) / dd);
        float near = -half - m > s_min ? -half : half;
        strip->s[i] = left >= 0.0f && near - m > s_min ? near : MISS;
    }
    int hits = compact(count, strip);
    SIMD for (int i = 0; i < hits; i++)
    {
        float g = gx + (float)strip->index[i];
        WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);
        float m = v3f_dot(q, d) / v3f_dot(d, d);
        WrVec3f p = v3f_mad(v3f_mad(q, d, -m), d, strip->s[i]);
        float rho = sqrtf(p.x * p.x + p.y * p.y);
        float a = wr_atan2_turns_f(p.z, rho);
        a = a > 0.5f ? a - 1.0f : a;
        strip->u[i] = wr_atan2_turns_f(p.y, p.x);
        strip->v[i] = clamp01(0.5f + 2.0f * a);
    }
    return hits;
}

/* The samples that hit a body of revolution of height h: u goes round the axis, v up it. */
static inline int place_round(const WrRays *rays, Row row, float gx, int count, float h,
                              WrStrip *strip)
{
    int hits = compact(count, strip);
    SIMD for (int i = 0; i < hits; i++)
    {
        float g = gx + (float)strip->index[i];
        WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);
        WrVec3f p = v3f_mad(q, d, strip->s[i]);
        strip->u[i] = wr_atan2_turns_f(p.y, p.x);
        strip->v[i] = clamp01(0.5f + p.z / h);
    }
    return hits;
}

/* x^2 + y^2 = R^2, |z| <= H/2, open at both ends: the nearer root if it lies on the tube, else the other. */
FLAT static int kern_hit_cylinder(const WrRays *rays, const WrShapef *shape, float gx, float gy,
                                  int count, WrStrip *strip)
{
    const float r = shape->value[0], r2 = r * r, h = shape->value[1], top = 0.5f * h;
    const float s_min = rays->s_min;
    const Row row = row_at(rays, gy);
    SIMD for (int i = 0; i < count; i++)
    {
        float g = gx + (float)i;
        WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);
        float dd = d.x * d.x + d.y * d.y;
        float inv = 1.0f / (dd > 1e-30f ? dd : 1.0f), m = (q.x * d.x + q.y * d.y) * inv;
        float fx = q.x - m * d.x, fy = q.y - m * d.y;
        float left = r2 - (fx * fx + fy * fy);
        float half = sqrtf((left > 0.0f ? left : 0.0f) * inv);
        float s0 = -m - half, s1 = -m + half;
        float z0 = fabsf(q.z + s0 * d.z), z1 = fabsf(q.z + s1 * d.z);
        float second = z1 <= top && s1 > s_min ? s1 : MISS;
        float s = z0 <= top && s0 > s_min ? s0 : second;
        strip->s[i] = left >= 0.0f && dd > 1e-30f ? s : MISS;
    }
    return place_round(rays, row, gx, count, h, strip);
}

/* x^2 + y^2 = (R/H)^2 w^2 with w = H/2 - z in 0..H: a s^2 + 2 b s + c = 0, roots in the stable form
   t / a and c / t with t = -(b +- sqrt(b^2 - a c)). */
FLAT static int kern_hit_cone(const WrRays *rays, const WrShapef *shape, float gx, float gy,
                              int count, WrStrip *strip)
{
    const float h = shape->value[1], k = shape->value[0] / h, k2 = k * k, s_min = rays->s_min;
    const Row row = row_at(rays, gy);
    SIMD for (int i = 0; i < count; i++)
    {
        float g = gx + (float)i;
        WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);
        float w = 0.5f * h - q.z;
        float a = d.x * d.x + d.y * d.y - k2 * d.z * d.z;
        float b = q.x * d.x + q.y * d.y + k2 * w * d.z;
        float c = q.x * q.x + q.y * q.y - k2 * w * w;
        float disc = b * b - a * c;
        float root = sqrtf(disc > 0.0f ? disc : 0.0f);
        float t = b > 0.0f ? -b - root : -b + root;
        float sa = a != 0.0f ? t / a : MISS, sc = t != 0.0f ? c / t : 0.0f;
        float s0 = sa < sc ? sa : sc, s1 = sa < sc ? sc : sa;
        float w0 = w - s0 * d.z, w1 = w - s1 * d.z;
        float second = w1 >= 0.0f && w1 <= h && s1 > s_min ? s1 : MISS;
        float s = w0 >= 0.0f && w0 <= h && s0 > s_min ? s0 : second;
        strip->s[i] = disc >= 0.0f ? s : MISS;
    }
    return place_round(rays, row, gx, count, h, strip);
}

FLAT static int kern_hit_quad(const WrRays *rays, const WrQuad *quad, float gx, float gy, int count,
                              WrStrip *strip)
{
    const WrVec3f o = { quad->origin[0], quad->origin[1], quad->origin[2] };
    const WrVec3f n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const WrVec3f eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const WrVec3f ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    const float s_min = rays->s_min;
    const Row row = row_at(rays, gy);
    SIMD for (int i = 0; i < count; i++)
    {
        float g = gx + (float)i;
        WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);
        float dn = v3f_dot(d, n);
        float s = v3f_dot(v3f_sub(o, q), n) / (dn != 0.0f ? dn : 1.0f);
        WrVec3f p = v3f_sub(v3f_mad(q, d, s), o);
        float u = v3f_dot(p, eu), v = v3f_dot(p, ev);
        bool in = u >= 0.0f && u <= 1.0f && v >= 0.0f && v <= 1.0f;
        strip->px[i] = u;
        strip->py[i] = v;
        strip->s[i] = in && s > s_min && s < MISS && dn != 0.0f ? s : MISS;
    }
    int hits = compact(count, strip);
    for (int i = 0; i < hits; i++) {
        strip->u[i] = strip->px[strip->index[i]];
        strip->v[i] = strip->py[strip->index[i]];
    }
    return hits;
}
