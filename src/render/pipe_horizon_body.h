/* pipe_horizon_body.h - a plane without end: slopes ease off and the plane fades where a pixel holds much of it. A part of
   pipe_body.h.

   A pixel's step dx of the ray's way d moves the point eye + z d, on the plane of normal n, by z (dx - d (dx.n) / (d.n)), where
   z = -eye.n / (d.n): nothing is taken from a point far away, so that eyes a hair above the plane lose no digits. In u and v
   that is its footprint: of the picture's pixels, whatever the samples. */

/* 1 up to a quarter, 0 from 1 on, and smooth between. */
static REAL ease(REAL wide)
{
    REAL t = (wide - (REAL)0.25) / (REAL)0.75;
    t = t > 0 ? (t < 1 ? t : 1) : 0;
    return 1 - t * t * (3 - 2 * t);
}

/* How much a pixel holds there of ru x rv, in parts of it: the root of the sum of its steps' squares. Infinite or NaN where
   the ray goes along the plane, which counts as much. */
static REAL held_by_pixel(const WrTileJob *job, const Rays *rays, REAL x, REAL y, REAL ru, REAL rv)
{
    const WrView *view = job->view;
    const Rays *pixel = &VIEWED(&view->grids[0], rays);
    const REAL *const step[2] = { pixel->dx, pixel->dy };
    const REAL a = ru * VIEWED(view, quads)[0].eu[0], b = rv * VIEWED(view, quads)[0].ev[1];
    REAL d[3], sum = 0;
    for (int c = 0; c < 3; c++) d[c] = rays->d0[c] + x * rays->dx[c] + y * rays->dy[c];
    const REAL deep = -(REAL)view->eye.z / d[2];
    for (int k = 0; k < 2; k++) {
        const REAL part = step[k][2] / d[2];
        const REAL du = a * deep * (step[k][0] - part * d[0]);
        const REAL dv = b * deep * (step[k][1] - part * d[1]);
        sum += du * du + dv * dv;
    }
    return sum < (REAL)1e30 ? (REAL)sqrt((double)sum) : (REAL)1e15;
}

/* From half a period a pixel on, no wave of the table can be shown: their mean slope is none. */
static void ease_slopes(const WrTileJob *job, const Rays *rays, Strip *strip)
{
    const REAL ru = (REAL)(2 * fmax(1, fabs(job->scene->replicate_u)));
    const REAL rv = (REAL)(2 * fmax(1, fabs(job->scene->replicate_v)));
    for (int i = 0; i < strip->count; i++) {
        const REAL left = ease(held_by_pixel(job, rays, strip->x[i], strip->y[i], ru, rv));
        strip->fu[i] *= left;
        strip->fv[i] *= left;
    }
}

/* What is stored already becomes as much of itself as covers its sample. */
static void fade_strip(const WrTileJob *job, const Rays *rays, const WrSink *sink,
                       const Strip *strip, const Watch *watch)
{
    if (!sink->rgba) return;
    for (int i = 0; i < strip->count; i++) {
        float *out = sink->rgba + 4 * strip->index[i];
        const float cover = (float)ease(held_by_pixel(job, rays, strip->x[i], strip->y[i], 1, 1));
        for (int c = 0; c < 4; c++) out[c] *= cover;
    }
    did(watch, WR_EFFECT_HORIZON);
}
