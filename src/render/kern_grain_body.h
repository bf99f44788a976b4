/* kern_grain_body.h - solid textures on strips (shade/grain.h). A part of kern_body.h. */

#define GRAIN_FAR K_(1e9) /* cells: beyond, single precision has no place within a cell */

/* The number of a lattice point, in (-1, 1); exact. */
ALWAYS REAL grain_number(uint32_t h)
{
    return (REAL)(2 * (int32_t)(h >> 9) + 1) * K_(0x1p-23) - K_(1);
}

ALWAYS REAL grain_mix(REAL a, REAL b, REAL t)
{
    return a + t * (b - a);
}

/* 10 x^3 - 15 x^4 + 6 x^5 */
ALWAYS REAL grain_fade(REAL x)
{
    return x * x * x * (K_(10) + x * (K_(6) * x - K_(15)));
}

/* Between two lattice points along z; xy: the chain of hashes as far as y goes. */
ALWAYS REAL grain_edge(uint32_t xy, uint32_t z0, uint32_t z1, REAL t)
{
    return grain_mix(grain_number(wr_lattice_hash_link(xy, z0)),
                     grain_number(wr_lattice_hash_link(xy, z1)), t);
}

/* Value noise of the lattice whose chain starts so. */
ALWAYS REAL grain_noise(uint32_t start, REAL x, REAL y, REAL z)
{
    const REAL fx = r_floor(x), fy = r_floor(y), fz = r_floor(z);
    const uint32_t ix = (uint32_t)(int32_t)fx, iy = (uint32_t)(int32_t)fy,
                   iz = (uint32_t)(int32_t)fz;
    const REAL tx = grain_fade(x - fx), ty = grain_fade(y - fy), tz = grain_fade(z - fz);
    const uint32_t x0 = wr_lattice_hash_link(start, wr_lattice_hash_part(ix, 0)),
                   x1 = wr_lattice_hash_link(start, wr_lattice_hash_part(ix + 1U, 0));
    const uint32_t y0 = wr_lattice_hash_part(iy, 1), y1 = wr_lattice_hash_part(iy + 1U, 1);
    const uint32_t z0 = wr_lattice_hash_part(iz, 2), z1 = wr_lattice_hash_part(iz + 1U, 2);
    const REAL a = grain_mix(grain_edge(wr_lattice_hash_link(x0, y0), z0, z1, tz),
                             grain_edge(wr_lattice_hash_link(x0, y1), z0, z1, tz), ty);
    const REAL b = grain_mix(grain_edge(wr_lattice_hash_link(x1, y0), z0, z1, tz),
                             grain_edge(wr_lattice_hash_link(x1, y1), z0, z1, tz), ty);
    return grain_mix(a, b, tx);
}

/* One octave into the sums of a strip. */
ALWAYS void grain_octave(const GRAIN *g, const bool creased, int octave, STRIP *strip,
                         REAL *restrict sum)
{
    const uint32_t start = g->start[octave];
    const REAL f = g->frequency[octave], amplitude = g->amplitude[octave];
    const REAL ox = g->offset[octave][0], oy = g->offset[octave][1], oz = g->offset[octave][2];
    const REAL *restrict const px = strip->px, *restrict const py = strip->py,
                               *restrict const pz = strip->pz;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL x = within(f * px[i] + ox, GRAIN_FAR);
        const REAL y = within(f * py[i] + oy, GRAIN_FAR);
        const REAL z = within(f * pz[i] + oz, GRAIN_FAR);
        const REAL n = grain_noise(start, x, y, z);
        sum[i] += amplitude * (creased ? r_abs(n) : n);
    }
}

FLAT static void grain_creased(const GRAIN *g, int octave, STRIP *strip, REAL *sum)
{
    grain_octave(g, true, octave, strip, sum);
}

FLAT static void grain_smooth(const GRAIN *g, int octave, STRIP *strip, REAL *sum)
{
    grain_octave(g, false, octave, strip, sum);
}

/* 1 in the last part d of each ring. */
ALWAYS REAL grain_ring(REAL t, REAL d)
{
    return t - r_floor(t) >= K_(1) - d ? K_(1) : K_(0);
}

/* 0 of even numbers, 1 of odd ones; whole. */
ALWAYS REAL grain_odd(REAL whole)
{
    return whole - K_(2) * r_floor(whole * K_(0.5));
}

ALWAYS REAL grain_at(const GRAIN *g, const WrGrainKind kind, REAL x, REAL y, REAL z, REAL sum)
{
    const REAL k = g->rings, a = g->amount * sum;
    if (kind == WR_GRAIN_WOOD) return grain_ring(k * r_sqrt(x * x + y * y) + a, g->share);
    if (kind == WR_GRAIN_MARBLE) {
        const REAL t = k * z + a;
        REAL sine, cosine;
        r_sincos_turns(t - r_floor(t), &sine, &cosine);
        return K_(0.5) + K_(0.5) * sine;
    }
    if (kind == WR_GRAIN_CHECKER)
        return grain_odd(grain_odd(r_floor(k * x)) + grain_odd(r_floor(k * y)) +
                         grain_odd(r_floor(k * z)));
    const REAL level = kind == WR_GRAIN_GRANITE ? a : K_(0.5) + K_(0.5) * a;
    return level < K_(0) ? K_(0) : level < K_(1) ? level : K_(1);
}

ALWAYS void grain_strip(const GRAIN *grain, const WrGrainKind kind, const STRIP *strip,
                        REAL *restrict value)
{
    const GRAIN g = *grain;
    const REAL *p[] = { strip->px, strip->py, strip->pz, strip->px, strip->py };
    const REAL *x = p[g.axis + 1], *y = p[g.axis + 2 > 4 ? 1 : g.axis + 2], *z = p[g.axis];
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        value[i] = grain_at(&g, kind, x[i], y[i], z[i], value[i]);
    }
}

FLAT static void grain_wood(const GRAIN *g, const STRIP *strip, REAL *value)
{
    grain_strip(g, WR_GRAIN_WOOD, strip, value);
}

FLAT static void grain_marble(const GRAIN *g, const STRIP *strip, REAL *value)
{
    grain_strip(g, WR_GRAIN_MARBLE, strip, value);
}

FLAT static void grain_checker(const GRAIN *g, const STRIP *strip, REAL *value)
{
    grain_strip(g, WR_GRAIN_CHECKER, strip, value);
}

FLAT static void grain_granite(const GRAIN *g, const STRIP *strip, REAL *value)
{
    grain_strip(g, WR_GRAIN_GRANITE, strip, value);
}

FLAT static void grain_plain(const GRAIN *g, const STRIP *strip, REAL *value)
{
    grain_strip(g, WR_GRAIN_NOISE, strip, value);
}

/* C times the texture's colour; over: the colour picture has brought C, which is 1 else. */
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

static void kern_grain(const GRAIN *g, bool over, STRIP *strip)
{
    static void (*const kinds[WR_GRAIN_KINDS])(const GRAIN *, const STRIP *, REAL *) = {
        [WR_GRAIN_WOOD] = grain_wood,       [WR_GRAIN_MARBLE] = grain_marble,
        [WR_GRAIN_CHECKER] = grain_checker, [WR_GRAIN_GRANITE] = grain_granite,
        [WR_GRAIN_NOISE] = grain_plain,
    };
    _Alignas(64) REAL value[WR_SPAN];
    memset(value, 0, sizeof value);
    for (int i = 0; i < g->octaves; i++)
        (g->creased ? grain_creased : grain_smooth)(g, i, strip, value);
    if (kinds[g->kind]) kinds[g->kind](g, strip, value);
    (over ? grain_over : grain_alone)(g, value, strip);
}
