/* stage_infinite_plane_body.h - anti-aliasing of an infinite plane: slopes and the plane itself fade out where a
   pixel covers much of it. Part of pipeline_body.h.

   One pixel step dx of the ray's direction d moves the point eye + z d, on the plane of normal n, by z (dx - d
   (dx.n) / (d.n)), where z = -eye.n / (d.n). No far point is subtracted, so an eye just above the plane loses no
   digits. The step in u and v is the footprint, of the picture's pixels, however many samples a pixel has. */

/* 1 up to a quarter, 0 from 1 on, smooth in between. */
static REAL ease(REAL wide)
{
    REAL t = (wide - (REAL)0.25) / (REAL)0.75;
    t = t > 0 ? (t < 1 ? t : 1) : 0;
    return 1 - t * t * (3 - 2 * t);
}

/* Squared size of a pixel at each sample, in units of ru x rv: the sum of its steps' squares. Infinite or NaN
   where the ray is parallel to the plane, which counts as large. Returns the number of samples that fade. */
static int held_by_pixels(const WrTileJob *job, const Rays *rays, const Strip *strip, REAL ru,
                          REAL rv, REAL *restrict held)
{
    const WrView *view = job->view;
    const Rays *pixel = &VIEWED(&view->grids[0], rays);
    const REAL *const sx = pixel->dx, *const sy = pixel->dy;
    const REAL *const d0 = rays->d0, *const dx = rays->dx, *const dy = rays->dy;
    const REAL a = ru * VIEWED(view, quads)[0].eu[0], b = rv * VIEWED(view, quads)[0].ev[1];
    const REAL eye = -(REAL)view->eye.z;
    const REAL *restrict x = strip->x, *restrict y = strip->y;
    int easing = 0;
#pragma omp simd reduction(+ : easing)
    for (int i = 0; i < strip->count; i++) {
        const REAL d = d0[0] + x[i] * dx[0] + y[i] * dy[0];
        const REAL e = d0[1] + x[i] * dx[1] + y[i] * dy[1];
        const REAL f = d0[2] + x[i] * dx[2] + y[i] * dy[2];
        const REAL deep = eye / f, part_x = sx[2] / f, part_y = sy[2] / f;
        const REAL ux = a * deep * (sx[0] - part_x * d), vx = b * deep * (sx[1] - part_x * e);
        const REAL uy = a * deep * (sy[0] - part_y * d), vy = b * deep * (sy[1] - part_y * e);
        const REAL sum = (ux * ux + vx * vx) + (uy * uy + vy * vy);
        held[i] = sum;
        easing += !(sum <= (REAL)(0.25 * 0.25));
    }
    return easing;
}

/* Weight that remains for such a pixel size. */
static REAL eased(REAL held)
{
    return ease(held < (REAL)1e30 ? (REAL)sqrt((double)held) : (REAL)1e15);
}

/* From half a period per pixel on, no wave of the table can be displayed: the mean slope is 0. */
static void ease_slopes(const WrTileJob *job, const Rays *rays, Strip *strip)
{
    REAL held[WR_SPAN];
    const REAL ru = (REAL)(2 * fmax(1, fabs(job->scene->replicate_u)));
    const REAL rv = (REAL)(2 * fmax(1, fabs(job->scene->replicate_v)));
    if (held_by_pixels(job, rays, strip, ru, rv, held) == 0) return;
    for (int i = 0; i < strip->count; i++) {
        const REAL left = eased(held[i]);
        strip->fu[i] *= left;
        strip->fv[i] *= left;
    }
}

/* Multiplies the stored result by the sample's coverage. */
static void fade_strip(const WrTileJob *job, const Rays *rays, const WrSink *sink,
                       const Strip *strip, const Watch *watch)
{
    REAL held[WR_SPAN];
    if (!sink->rgba) return;
    const bool fades = held_by_pixels(job, rays, strip, 1, 1, held) > 0;
    for (int i = 0; i < strip->count && fades; i++) {
        float *out = sink->rgba + 4 * strip->index[i];
        const float cover = (float)eased(held[i]);
        for (int c = 0; c < 4; c++) out[c] *= cover;
    }
    did(watch, WR_EFFECT_HORIZON);
}
