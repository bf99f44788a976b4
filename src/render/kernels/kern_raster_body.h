/* kern_raster_body.h - mesh visibility: samples covered by a triangle, and covered samples of a row. Part of
   kern_body.h. */

#ifndef WR_KERN_DOUBLE

_Static_assert(LANES <= WR_WALK_PAD, "what is written past the end");

/* The three edge values of a triangle at the first of LANES samples. */
typedef struct Edges {
    int32_t a, b, c;
} Edges;

/* Their differences from the first of LANES samples to the others. */
typedef struct EdgeSteps {
    int32_t a[LANES], b[LANES], c[LANES];
} EdgeSteps;

ALWAYS float on_plane(WrPlane plane, float l1, float l2)
{
    return plane.base + l1 * plane.d1 + l2 * plane.d2;
}

/* Covers LANES samples, of which the first `count` may be written. */
ALWAYS void cover_lanes(const WrWalk *walk, Edges first, const EdgeSteps *steps, int count,
                        const bool perspective, float *restrict close, float *restrict u,
                        float *restrict v)
{
    const WrPlane near_by = walk->close, u_by = walk->u, v_by = walk->v;
    const float inv = walk->inv;
    SIMD for (int i = 0; i < LANES; i++)
    {
        const int32_t a = first.a + steps->a[i], b = first.b + steps->b[i],
                      c = first.c + steps->c[i];
        const float l1 = (float)b * inv, l2 = (float)c * inv, near = on_plane(near_by, l1, l2);
        const float w = perspective ? 1.0f / near : 1.0f;
        const float new_u = on_plane(u_by, l1, l2) * w, new_v = on_plane(v_by, l1, l2) * w;
        const bool nearer = ((a | b | c) >= 0) & (i < count) & (near > close[i]);
        close[i] = nearer ? near : close[i];
        u[i] = nearer ? new_u : u[i];
        v[i] = nearer ? new_v : v[i];
    }
}

/* True if one edge excludes all LANES samples. */
ALWAYS bool edges_miss(Edges first, const EdgeSteps *steps)
{
    const int last = LANES - 1;
    return ((first.a & (first.a + steps->a[last])) | (first.b & (first.b + steps->b[last])) |
            (first.c & (first.c + steps->c[last]))) < 0;
}

ALWAYS void cover(const WrWalk *walk, const bool perspective, float *close, float *u, float *v)
{
    const Edges step = { walk->step_x[0], walk->step_x[1], walk->step_x[2] };
    EdgeSteps steps;
    SIMD for (int i = 0; i < LANES; i++)
    {
        steps.a[i] = i * step.a;
        steps.b[i] = i * step.b;
        steps.c[i] = i * step.c;
    }
    Edges row = { walk->at[0], walk->at[1], walk->at[2] };
    for (int y = walk->y0; y < walk->y1; y++) {
        const size_t at = (size_t)y * (size_t)walk->pitch;
        Edges first = row;
        for (int x = walk->x0; x < walk->x1; x += LANES) {
            const size_t cell = at + (size_t)x;
            if (!edges_miss(first, &steps))
                cover_lanes(walk, first, &steps, walk->x1 - x, perspective, close + cell, u + cell,
                            v + cell);
            if (x + LANES >= walk->x1) break;
            first.a += LANES * step.a, first.b += LANES * step.b, first.c += LANES * step.c;
        }
        row.a += walk->step_y[0], row.b += walk->step_y[1], row.c += walk->step_y[2];
    }
}

FLAT static void kern_cover(const WrWalk *walk, float *close, float *u, float *v)
{
    if (walk->perspective) cover(walk, true, close, u, v);
    else cover(walk, false, close, u, v);
}
#endif

/* Stores the grid positions of a row's hits from (gx, gy) on; returns `hits`. */
ALWAYS int put_places(REAL gx, REAL gy, int hits, STRIP *strip)
{
    SIMD for (int i = 0; i < hits; i++)
    {
        strip->x[i] = gx + (REAL)strip->index[i];
        strip->y[i] = gy;
    }
    return hits;
}

/* Covered samples of a row from (gx, gy) on. */
FLAT static int kern_covered(const float *close, const float *u, const float *v, REAL gx, REAL gy,
                             int count, STRIP *strip)
{
    SIMD for (int i = 0; i < count; i++)
    {
        strip->s[i] = close[i] > -FLT_MAX ? K_(0) : K_(MISS);
        strip->u[i] = (REAL)u[i];
        strip->v[i] = (REAL)v[i];
    }
    REAL *const move[] = { strip->u, strip->v };
    const int hits = compact(count, strip, move, 2);
    return put_places(gx, gy, hits, strip);
}

/* Samples of a row from (gx, gy) on that are in the uv cache. */
FLAT static int kern_recall(const float *u, const float *v, REAL gx, REAL gy, int count,
                            STRIP *strip)
{
    SIMD for (int i = 0; i < count; i++)
    {
        const float at = wr_bits_float(wr_float_bits(u[i]) & INT32_MAX);
        strip->s[i] = at <= 1.0f ? K_(0) : K_(MISS);
        strip->u[i] = (REAL)at;
        strip->v[i] = (REAL)v[i];
        strip->wx[i] = wr_float_bits(u[i]) < 0 ? K_(0) : K_(1);
    }
    REAL *const move[] = { strip->u, strip->v, strip->wx };
    const int hits = compact(count, strip, move, 3);
    return put_places(gx, gy, hits, strip);
}
