/* stage_frame_body.h - SIMD versions of n after Newton's method, and of Blinn's n'. Part of pipeline_body.h. */

#ifdef HAS_WIDE
/* Each uses hand-written vectors. False: the stages do the work. */
static bool crossed_wide(const WrTileJob *job, Strip *strip)
{
    return job->wide_newton && job->wide->cross(job->sheet.noise, strip);
}
static bool bent_wide(const WrTileJob *job, WrBumpMode bump, const Rays *rays, Strip *strip)
{
    return job->wide && bump == WR_BUMP_BLINN && job->wide->blinn(rays, strip);
}
#else
static bool crossed_wide(const WrTileJob *job, const Strip *strip)
{
    (void)job, (void)strip;
    return false;
}
static bool bent_wide(const WrTileJob *job, WrBumpMode bump, const Rays *rays, const Strip *strip)
{
    (void)job, (void)bump, (void)rays, (void)strip;
    return false;
}
#endif

/* n at the points that Newton's method found. */
static void frame_strip(const WrTileJob *job, Strip *strip)
{
    const WrSurfaceKind kind = job->view->shape_d.kind;
    if (crossed_wide(job, strip)) return;
    if (job->wide_newton) KERNELS_OF(job)->geometry[kind](&VIEWED(job->view, shape), 0, strip);
    else KERNELS_OF(job)->frame[kind](&VIEWED(job->view, shape), strip);
}
