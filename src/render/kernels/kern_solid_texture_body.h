/* kern_solid_texture_body.h - solid textures on strips (shade/solid_texture.h). Part of kern_body.h. */

/* scale of Perlin's gradients that keeps noise within 1 */
#define GRAIN_SOFT K_(0.81649658092772603)
/* cells: beyond, single precision cannot represent a position within a cell */
#define GRAIN_FAR K_(1e9)

/* The value of a lattice point, in (-1, 1); exact.
   h >> 9 has 23 bits: 2 k + 1 is odd and below 2^24, so a float holds the result; 0 and +-1 never occur. */
ALWAYS REAL grain_number(uint32_t h)
{
    return (REAL)(2 * (int32_t)(h >> 9) + 1) * K_(0x1p-23) - K_(1);
}

ALWAYS REAL grain_mix(REAL a, REAL b, REAL t)
{
    return a + t * (b - a);
}

/* 10 x^3 - 15 x^4 + 6 x^5, and its slope. Value, slope and curvature at 0 and 1 agree with the neighbouring
   cell: noise is C^2 (Perlin 2002). */
ALWAYS REAL grain_fade(REAL x)
{
    return x * x * x * (K_(10) + x * (K_(6) * x - K_(15)));
}

ALWAYS REAL grain_fade_slope(REAL x)
{
    const REAL y = x * (K_(1) - x);
    return K_(30) * y * y;
}

/* Noise and its slopes per cell. */
typedef struct Noisy {
    REAL f, x, y, z;
} Noisy;

ALWAYS Noisy noisy_mix(Noisy a, Noisy b, REAL t)
{
    return (Noisy){ grain_mix(a.f, b.f, t), grain_mix(a.x, b.x, t), grain_mix(a.y, b.y, t),
                    grain_mix(a.z, b.z, t) };
}

/* A position in the lattice: hashes of both neighbours along each axis, and its offsets from the lower ones. */
typedef struct GrainCell {
    uint32_t x0, x1, y0, y1, z0, z1;
    REAL x, y, z, tx, ty, tz;
} GrainCell;

ALWAYS GrainCell grain_cell(uint32_t start, REAL x, REAL y, REAL z)
{
    const REAL fx = r_floor(x), fy = r_floor(y), fz = r_floor(z);
    const uint32_t ix = (uint32_t)(int32_t)fx, iy = (uint32_t)(int32_t)fy,
                   iz = (uint32_t)(int32_t)fz;
    GrainCell c = { .x = x - fx, .y = y - fy, .z = z - fz };
    c.tx = grain_fade(c.x), c.ty = grain_fade(c.y), c.tz = grain_fade(c.z);
    c.x0 = wr_lattice_hash_link(start, wr_lattice_hash_part(ix, 0));
    c.x1 = wr_lattice_hash_link(start, wr_lattice_hash_part(ix + 1U, 0));
    c.y0 = wr_lattice_hash_part(iy, 1), c.y1 = wr_lattice_hash_part(iy + 1U, 1);
    c.z0 = wr_lattice_hash_part(iz, 2), c.z1 = wr_lattice_hash_part(iz + 1U, 2);
    return c;
}

/* Contribution of a lattice corner: its value; or, soft, its gradient times the offset from there: Perlin's
   twelve gradients, the midpoints of a cube's edges, chosen by the upper bits of the hash as in
   wr_lattice_gradient. */
ALWAYS Noisy grain_corner(uint32_t xy, uint32_t z, const bool soft, REAL dx, REAL dy, REAL dz)
{
    const uint32_t h = wr_lattice_hash_link(xy, z);
    if (!soft) return (Noisy){ grain_number(h), K_(0), K_(0), K_(0) };
    const uint32_t twelfth = (12U * (h >> 16) + (12U * (h & 0xffffU) >> 16)) >> 16;
    const int32_t k = (int32_t)twelfth, pair = k >> 2;
    const REAL a = k & 1 ? -GRAIN_SOFT : GRAIN_SOFT, b = k & 2 ? -GRAIN_SOFT : GRAIN_SOFT;
    const REAL gx = pair == 2 ? K_(0) : a,
               gy = pair == 0   ? b
                    : pair == 2 ? a
                                : K_(0),
               gz = pair == 0 ? K_(0) : b;
    return (Noisy){ gx * dx + gy * dy + gz * dz, gx, gy, gz };
}

/* Interpolates along z, then y, then x. sloped: with slopes.
   d/dz (low + t (high - low)): mixed slopes of both corners, and t'(z) (high - low) by the weight itself. */
ALWAYS Noisy grain_edge(uint32_t xy, const GrainCell *c, const bool soft, const bool sloped,
                        REAL dx, REAL dy)
{
    const Noisy low = grain_corner(xy, c->z0, soft, dx, dy, c->z);
    const Noisy high = grain_corner(xy, c->z1, soft, dx, dy, c->z - K_(1));
    if (!sloped) return (Noisy){ grain_mix(low.f, high.f, c->tz), K_(0), K_(0), K_(0) };
    Noisy at = noisy_mix(low, high, c->tz);
    at.z += grain_fade_slope(c->z) * (high.f - low.f);
    return at;
}

ALWAYS Noisy grain_side(uint32_t x, const GrainCell *c, const bool soft, const bool sloped, REAL dx)
{
    const Noisy low = grain_edge(wr_lattice_hash_link(x, c->y0), c, soft, sloped, dx, c->y);
    const Noisy high =
        grain_edge(wr_lattice_hash_link(x, c->y1), c, soft, sloped, dx, c->y - K_(1));
    if (!sloped) return (Noisy){ grain_mix(low.f, high.f, c->ty), K_(0), K_(0), K_(0) };
    Noisy at = noisy_mix(low, high, c->ty);
    at.y += grain_fade_slope(c->y) * (high.f - low.f);
    return at;
}

/* Noise of the lattice whose hash chain starts with `start`. */
ALWAYS Noisy grain_noise(uint32_t start, const bool soft, const bool sloped, REAL x, REAL y, REAL z)
{
    const GrainCell c = grain_cell(start, x, y, z);
    const Noisy low = grain_side(c.x0, &c, soft, sloped, c.x);
    const Noisy high = grain_side(c.x1, &c, soft, sloped, c.x - K_(1));
    if (!sloped) return (Noisy){ grain_mix(low.f, high.f, c.tx), K_(0), K_(0), K_(0) };
    Noisy at = noisy_mix(low, high, c.tx);
    at.x += grain_fade_slope(c.x) * (high.f - low.f);
    return at;
}

/* Sums of a strip's noise, and each pixel's extent in space. */
typedef struct GrainStrip {
    _Alignas(64) REAL sum[WR_SPAN];             /* of octaves */
    REAL gx[WR_SPAN], gy[WR_SPAN], gz[WR_SPAN]; /* its slopes */
    REAL lost[WR_SPAN];                         /* variance of the octaves that have faded */
    REAL ax[WR_SPAN], ay[WR_SPAN], az[WR_SPAN]; /* step of P for one pixel to the right */
    REAL wx[WR_SPAN], wy[WR_SPAN], wz[WR_SPAN]; /* and for one pixel down */
    REAL size[WR_SPAN];                         /* sum of their squares */
    REAL value[WR_SPAN];                        /* the pattern, 0..1 */
    REAL least;                                 /* minimum of size */
} GrainStrip;

/* Adds one octave to the sums of a strip; faded: as far as pixels can resolve it, with slopes.
   Octave F is replaced by left F + (1 - left) mean, with left the share that a pixel of squared size `held`
   (in cells) resolves. The variance that is lost widens the pattern's edges instead. |n| of soft
   noise has the slope sign(n) grad n. */
ALWAYS void grain_octave(const GRAIN *g, const bool soft, const bool faded, int octave,
                         const STRIP *strip, GrainStrip *to)
{
    const uint32_t start = g->start[octave];
    const REAL f = g->frequency[octave], amplitude = g->amplitude[octave];
    const REAL ox = g->offset[octave][0], oy = g->offset[octave][1], oz = g->offset[octave][2];
    const REAL mean = g->mean, variance = g->variance, fading = g->fading * f * f;
    const REAL *restrict const px = strip->px, *restrict const py = strip->py,
                               *restrict const pz = strip->pz;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL x = within(f * px[i] + ox, GRAIN_FAR);
        const REAL y = within(f * py[i] + oy, GRAIN_FAR);
        const REAL z = within(f * pz[i] + oz, GRAIN_FAR);
        const Noisy n = grain_noise(start, soft, faded, x, y, z);
        const REAL value = soft ? r_abs(n.f) : n.f;
        if (!faded) {
            to->sum[i] += amplitude * value;
        } else {
            const REAL held = fading * to->size[i], left = grain_left(held), gone = K_(1) - left;
            const REAL way = !soft ? K_(1) : n.f < K_(0) ? K_(-1) : n.f > K_(0) ? K_(1) : K_(0);
            const REAL by = amplitude * grain_left_slope(held) * f * way;
            to->sum[i] += amplitude * (left * value + gone * mean);
            to->lost[i] += amplitude * amplitude * grain_within(held) * variance;
            to->gx[i] += by * n.x, to->gy[i] += by * n.y, to->gz[i] += by * n.z;
        }
    }
}

#define GRAIN_OCTAVE(name, soft, faded)                                                            \
    FLAT static void grain_##name(const GRAIN *g, int octave, const STRIP *strip, GrainStrip *to)  \
    {                                                                                              \
        grain_octave(g, soft, faded, octave, strip, to);                                           \
    }
GRAIN_OCTAVE(smooth, false, false)
GRAIN_OCTAVE(smooth_faded, false, true)
GRAIN_OCTAVE(soft, true, false)
GRAIN_OCTAVE(soft_faded, true, true)

/* Adds an octave that no pixel of the strip resolves. */
FLAT static void grain_gone(const GRAIN *g, int octave, int count, GrainStrip *to)
{
    const REAL amplitude = g->amplitude[octave], mean = amplitude * g->mean;
    const REAL variance = amplitude * amplitude * g->variance;
    SIMD for (int i = 0; i < count; i++)
    {
        to->sum[i] += mean;
        to->lost[i] += variance;
    }
}

/* Steps of P from pixel to pixel on the plane across n (kern_filter_body.h). */
FLAT static void grain_steps(const RAYS *rays, const STRIP *strip, GrainStrip *to)
{
    const VEC qx = { rays->qx[0], rays->qx[1], rays->qx[2] };
    const VEC qy = { rays->qy[0], rays->qy[1], rays->qy[2] };
    const VEC dx = { rays->dx[0], rays->dx[1], rays->dx[2] };
    const VEC dy = { rays->dy[0], rays->dy[1], rays->dy[2] };
    const int count = strip->count;
    REAL least = VAST;
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC q = RAY_Q(rays, strip->y[i], strip->x[i]);
        const VEC d = RAY_D(rays, strip->y[i], strip->x[i]), n = LOAD3(strip, n, i);
        const REAL dd = v_dot(d, d), low = K_(1e-6) * r_sqrt(dd), size = v_dot(n, d);
        const REAL dn = r_abs(size) > low ? size : low;
        const REAL s = v_dot(v_sub(LOAD3(strip, p, i), q), d) / dd;
        const VEC a = step_on_plane(n, d, v_mad(qx, dx, s), dn);
        const VEC w = step_on_plane(n, d, v_mad(qy, dy, s), dn);
        to->ax[i] = within(a.x, VAST), to->ay[i] = within(a.y, VAST), to->az[i] = within(a.z, VAST);
        to->wx[i] = within(w.x, VAST), to->wy[i] = within(w.y, VAST), to->wz[i] = within(w.z, VAST);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC a = LOAD3(to, a, i), w = LOAD3(to, w, i);
        to->size[i] = v_dot(a, a) + v_dot(w, w);
    }
    for (int i = 0; i < count; i++) least = smaller(least, to->size[i]);
    to->least = least;
}

/* A strip's numbers along the texture's axis z, and across it. */
typedef struct GrainTurned {
    const REAL *px, *py, *pz, *gx, *gy, *gz, *ax, *ay, *az, *wx, *wy, *wz;
    const REAL *sum, *lost;
    REAL *bx, *by, *bz;
} GrainTurned;

ALWAYS GrainTurned grain_turned(WrSolidTextureAxis axis, STRIP *strip, const GrainStrip *at)
{
    const REAL *p[] = { strip->px, strip->py, strip->pz };
    const REAL *g[] = { at->gx, at->gy, at->gz }, *a[] = { at->ax, at->ay, at->az };
    const REAL *w[] = { at->wx, at->wy, at->wz };
    REAL *b[] = { strip->bx, strip->by, strip->bz };
    const int x = (axis + 1) % 3, y = (axis + 2) % 3, z = axis;
    return (GrainTurned){ p[x], p[y], p[z], g[x],    g[y],     g[z], a[x], a[y], a[z],
                          w[x], w[y], w[z], at->sum, at->lost, b[x], b[y], b[z] };
}

#define TURNED3(at, name, i) ((VEC){ (at).name##x[i], (at).name##y[i], (at).name##z[i] })

/* Squared extent of a pixel in a quantity of slope g: of a box with the variance of the pixel's parallelogram.
   A parallelogram with sides a, w has the variance (a^2 + w^2) / 12 of a box of width sqrt(a^2 + w^2). */
ALWAYS REAL grain_held(GrainTurned at, int i, VEC g)
{
    const REAL a = v_dot(g, TURNED3(at, a, i)), w = v_dot(g, TURNED3(at, w, i));
    return a * a + w * w;
}

/* 0 for even numbers, 1 for odd ones; the argument is whole. */
ALWAYS REAL grain_odd(REAL whole)
{
    return whole - K_(2) * r_floor(whole * K_(0.5));
}

/* A sample's position in the pattern, its extent there, and the change along the axes. */
typedef struct GrainPlace {
    REAL t, w;
    VEC slope;
} GrainPlace;

/* t = k |xy| + a sum (wood), k z + a sum (marble), 1/2 + a/2 sum (noise). w^2 = extent^2 + 12 a^2 lost +
   edge^2: a box of width w has the variance w^2 / 12. */
ALWAYS GrainPlace grain_place(const GRAIN *g, const WrSolidTextureKind kind, const bool wide,
                              GrainTurned at, int i)
{
    const VEC zero = { K_(0), K_(0), K_(0) }, p = TURNED3(at, p, i);
    const bool wood = kind == WR_SOLID_TEXTURE_WOOD, marble = kind == WR_SOLID_TEXTURE_MARBLE;
    const REAL k = g->rings, a = kind == WR_SOLID_TEXTURE_NOISE ? K_(0.5) * g->amount : g->amount;
    const REAL from = r_sqrt(p.x * p.x + p.y * p.y), moved = a * at.sum[i];
    GrainPlace out = { moved, K_(0), zero };
    if (wood) out.t = k * from + moved;
    if (marble) out.t = k * p.z + moved;
    if (kind == WR_SOLID_TEXTURE_NOISE) out.t = K_(0.5) + moved;
    if (!wide) return out;
    const REAL per = from > K_(1e-20) ? k / from : K_(0); /* on the axis, rings have slope 0 */
    const VEC own = { wood ? per * p.x : K_(0), wood ? per * p.y : K_(0), marble ? k : K_(0) };
    out.slope = v_mad(own, TURNED3(at, g, i), a);
    const REAL held = grain_held(at, i, out.slope) + K_(12) * a * a * at.lost[i];
    out.w = r_sqrt(held + g->edge * g->edge);
    return out;
}

/* Value of the pattern at that position.
   The mean over a box of width w about t: a difference of the integral for pulse and ramp; for the sine a
   factor, as its means are sines. */
ALWAYS REAL grain_level(const GRAIN *g, const WrSolidTextureKind kind, const bool wide,
                        GrainPlace at)
{
    if (kind == WR_SOLID_TEXTURE_WOOD)
        return wide ? grain_pulse_mean(at.t, at.w, g->share) : grain_pulse(at.t, g->share);
    if (kind == WR_SOLID_TEXTURE_MARBLE) {
        REAL sine, cosine;
        r_sincos_turns(at.t - r_floor(at.t), &sine, &cosine);
        return K_(0.5) + K_(0.5) * (wide ? sine * grain_fading(at.w) : sine);
    }
    return wide ? grain_ramp_mean(at.t, at.w) : grain_clamp(at.t);
}

/* Slope of the pattern by t.
   The derivative of that mean: the difference quotient of the pattern over the box. w has a lower limit of
   1e-3, so that edges have finite slopes. */
ALWAYS REAL grain_rise(const GRAIN *g, const WrSolidTextureKind kind, GrainPlace at)
{
    const REAL wide = at.w > K_(1e-3) ? at.w : K_(1e-3), half = K_(0.5) * wide;
    if (kind == WR_SOLID_TEXTURE_WOOD)
        return (grain_pulse(at.t + half, g->share) - grain_pulse(at.t - half, g->share)) / wide;
    if (kind == WR_SOLID_TEXTURE_MARBLE) {
        REAL sine, cosine;
        r_sincos_turns(at.t - r_floor(at.t), &sine, &cosine);
        return K_(3.14159265358979323846) * cosine * grain_fading(at.w);
    }
    const REAL inside = ((at.t > K_(0)) & (at.t < K_(1))) ? K_(1) : K_(0);
    const REAL mean = (grain_clamp(at.t + half) - grain_clamp(at.t - half)) / wide;
    return at.w > K_(1e-3) ? mean : inside;
}

/* Checker along one axis: 1 in even cells, -1 in odd ones, and its slope. */
typedef struct GrainCells {
    REAL mean, rise;
} GrainCells;

ALWAYS GrainCells grain_cells(const GRAIN *g, REAL p, REAL a, REAL w)
{
    const REAL k = g->rings, held = k * k * (a * a + w * w);
    const REAL wide = r_sqrt(held + g->edge * g->edge), x = k * p;
    const REAL least = wide > K_(1e-3) ? wide : K_(1e-3), half = K_(0.5) * least;
    const REAL up = grain_pulse(K_(0.5) * (x + half), K_(0.5));
    const REAL down = grain_pulse(K_(0.5) * (x - half), K_(0.5));
    return (GrainCells){ grain_square_mean(x, wide), K_(2) * k * (down - up) / least };
}

/* The pattern at one sample, and its slope along the axes. */
typedef struct GrainAt {
    REAL value;
    VEC slope;
} GrainAt;

ALWAYS GrainAt grain_board(const GRAIN *g, GrainTurned at, int i)
{
    const GrainCells x = grain_cells(g, at.px[i], at.ax[i], at.wx[i]);
    const GrainCells y = grain_cells(g, at.py[i], at.ay[i], at.wy[i]);
    const GrainCells z = grain_cells(g, at.pz[i], at.az[i], at.wz[i]);
    const REAL half = K_(-0.5);
    return (GrainAt){ K_(0.5) + half * x.mean * y.mean * z.mean,
                      { half * x.rise * y.mean * z.mean, half * x.mean * y.rise * z.mean,
                        half * x.mean * y.mean * z.rise } };
}

ALWAYS GrainAt grain_at(const GRAIN *g, const WrSolidTextureKind kind, const bool wide,
                        const bool rising, GrainTurned at, int i)
{
    if (kind == WR_SOLID_TEXTURE_CHECKER && wide) return grain_board(g, at, i);
    if (kind == WR_SOLID_TEXTURE_CHECKER) {
        const REAL k = g->rings;
        const REAL x = grain_odd(r_floor(k * at.px[i])), y = grain_odd(r_floor(k * at.py[i]));
        return (GrainAt){ grain_odd(x + y + grain_odd(r_floor(k * at.pz[i]))),
                          { K_(0), K_(0), K_(0) } };
    }
    const GrainPlace place = grain_place(g, kind, wide, at, i);
    return (GrainAt){ grain_level(g, kind, wide, place),
                      rising ? v_scale(place.slope, grain_rise(g, kind, place)) : place.slope };
}

/* The pattern of a strip; wide: averaged over pixels, else at points. */
ALWAYS void grain_values(const GRAIN *grain, const WrSolidTextureKind kind, const bool wide,
                         STRIP *strip, GrainStrip *to)
{
    const GRAIN g = *grain;
    const GrainTurned at = grain_turned(g.axis, strip, to);
    const int count = strip->count;
    REAL *restrict const value = to->value;
    SIMD for (int i = 0; i < count; i++)
    {
        value[i] = grain_at(&g, kind, wide, false, at, i).value;
    }
}

/* n' = unit(n - (s - (s.n) n)), s the slope of the pattern's height. */
ALWAYS void grain_bends(const RAYS *rays, const GRAIN *grain, const WrSolidTextureKind kind,
                        STRIP *strip, GrainStrip *to)
{
    const GRAIN g = *grain;
    const GrainTurned at = grain_turned(g.axis, strip, to);
    const Viewer viewer = viewer_of(rays);
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC n = TURNED3(at, b, i), rise = grain_at(&g, kind, true, true, at, i).slope;
        const VEC s = v_scale(rise, g.height * side_of(viewer, strip, i));
        const VEC bent = v_sub(n, v_mad(s, n, -v_dot(s, n)));
        const REAL inv = K_(1) / r_sqrt(v_dot(bent, bent));
        at.bx[i] = bent.x * inv, at.by[i] = bent.y * inv, at.bz[i] = bent.z * inv;
    }
}

#define GRAIN_KIND(name, KIND)                                                                     \
    FLAT static void grain_##name(const GRAIN *g, bool wide, STRIP *strip, GrainStrip *to)         \
    {                                                                                              \
        if (wide) grain_values(g, KIND, true, strip, to);                                          \
        else grain_values(g, KIND, false, strip, to);                                              \
    }                                                                                              \
    FLAT static void grain_##name##_bends(const RAYS *rays, const GRAIN *g, STRIP *strip,          \
                                          GrainStrip *to)                                          \
    {                                                                                              \
        grain_bends(rays, g, KIND, strip, to);                                                     \
    }
GRAIN_KIND(wood, WR_SOLID_TEXTURE_WOOD)
GRAIN_KIND(marble, WR_SOLID_TEXTURE_MARBLE)
GRAIN_KIND(checker, WR_SOLID_TEXTURE_CHECKER)
GRAIN_KIND(granite, WR_SOLID_TEXTURE_GRANITE)
GRAIN_KIND(plain, WR_SOLID_TEXTURE_NOISE)

/* C times the texture's colour; over: C is the colour picture's, else 1. */
ALWAYS void grain_colour(const GRAIN *grain, const REAL *restrict value, const bool over,
                         STRIP *strip)
{
    const GRAIN g = *grain;
    const REAL r = g.dark[0] - g.light[0], gr = g.dark[1] - g.light[1], b = g.dark[2] - g.light[2];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL cr = g.light[0] + value[i] * r, cg = g.light[1] + value[i] * gr,
                   cb = g.light[2] + value[i] * b;
        strip->cr[i] = over ? strip->cr[i] * cr : cr;
        strip->cg[i] = over ? strip->cg[i] * cg : cg;
        strip->cb[i] = over ? strip->cb[i] * cb : cb;
    }
}

FLAT static void grain_over(const GRAIN *g, const REAL *value, STRIP *strip)
{
    grain_colour(g, value, true, strip);
}

FLAT static void grain_alone(const GRAIN *g, const REAL *value, STRIP *strip)
{
    grain_colour(g, value, false, strip);
}

/* True if the pattern is averaged over pixels, or has soft edges. */
ALWAYS bool grain_wide(const GRAIN *g)
{
    return g->faded || g->edge > K_(0);
}

/* Shared by all kinds: the noise at a strip's samples; wide: with slopes and pixel steps, which are 0 at points. */
static void grain_sums(const RAYS *rays, const GRAIN *g, bool wide, const STRIP *strip,
                       GrainStrip *to)
{
    static void (*const octave[WR_SOLID_TEXTURE_NOISES][2])(const GRAIN *, int, const STRIP *,
                                                            GrainStrip *) = {
        [WR_SOLID_TEXTURE_SMOOTH] = { grain_smooth, grain_smooth_faded },
        [WR_SOLID_TEXTURE_SOFT] = { grain_soft, grain_soft_faded },
    };
    REAL *const clear[] = { to->sum, to->gx, to->gy, to->gz, to->lost, to->ax,
                            to->ay,  to->az, to->wx, to->wy, to->wz,   to->size };
    const size_t bytes = (size_t)strip->count * sizeof *to->sum;
    for (int k = 0; k < (wide ? 12 : 1); k++) memset(clear[k], 0, bytes);
    to->least = K_(0);
    if (g->faded) grain_steps(rays, strip, to);
    for (int i = 0; i < g->octaves; i++) {
        const REAL least = g->fading * g->frequency[i] * g->frequency[i] * to->least;
        if (wide && least >= GRAIN_GONE) grain_gone(g, i, strip->count, to);
        else octave[g->noise][wide](g, i, strip, to);
    }
}

/* The pattern at a strip's samples; 0 without a texture. */
static void grain_pattern(const RAYS *rays, const GRAIN *g, STRIP *strip, GrainStrip *at)
{
    static void (*const kinds[WR_SOLID_TEXTURE_KINDS])(const GRAIN *, bool, STRIP *,
                                                       GrainStrip *) = {
        [WR_SOLID_TEXTURE_WOOD] = grain_wood,       [WR_SOLID_TEXTURE_MARBLE] = grain_marble,
        [WR_SOLID_TEXTURE_CHECKER] = grain_checker, [WR_SOLID_TEXTURE_GRANITE] = grain_granite,
        [WR_SOLID_TEXTURE_NOISE] = grain_plain,
    };
    memset(at->value, 0, sizeof at->value);
    if (!kinds[g->kind]) return;
    grain_sums(rays, g, grain_wide(g), strip, at);
    kinds[g->kind](g, grain_wide(g), strip, at);
}

static void kern_grain(const RAYS *rays, const GRAIN *g, bool over, STRIP *strip)
{
    GrainStrip at;
    grain_pattern(rays, g, strip, &at);
    (over ? grain_over : grain_alone)(g, at.value, strip);
}

FLAT static void rough_by(const REAL *restrict value, REAL low, REAL high, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        strip->rough[i] = low + value[i] * (high - low);
    }
}

static void kern_grain_rough(const RAYS *rays, const GRAIN *g, REAL low, REAL high, STRIP *strip)
{
    GrainStrip at;
    grain_pattern(rays, g, strip, &at);
    rough_by(at.value, low, high, strip);
}

static void kern_grain_bump(const RAYS *rays, const GRAIN *g, STRIP *strip)
{
    static void (*const kinds[WR_SOLID_TEXTURE_KINDS])(const RAYS *, const GRAIN *, STRIP *,
                                                       GrainStrip *) = {
        [WR_SOLID_TEXTURE_WOOD] = grain_wood_bends,
        [WR_SOLID_TEXTURE_MARBLE] = grain_marble_bends,
        [WR_SOLID_TEXTURE_CHECKER] = grain_checker_bends,
        [WR_SOLID_TEXTURE_GRANITE] = grain_granite_bends,
        [WR_SOLID_TEXTURE_NOISE] = grain_plain_bends,
    };
    GrainStrip at;
    if (!kinds[g->kind]) return;
    grain_sums(rays, g, true, strip, &at);
    kinds[g->kind](rays, g, strip, &at);
}
