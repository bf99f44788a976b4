/* stage_ambient_occlusion_body.h - ambient occlusion of ambient and environment light
   (render/textures/ambient_occlusion.h). Part of pipeline_body.h. */

static void open_share(const WrTileJob *job, const Strip *s, REAL share[WR_SPAN])
{
    const WR_T(WrKernHorizon) horizon = horizon_of(job);
    KERNELS_OF(job)->open(&horizon, s, share);
}

/* Multiplies the light added to the first sums since `before` by the unoccluded share of the sky; before NULL:
   all of it. */
static void open_strip(const WrTileJob *job, const Sums *before, REAL *const to[3], Strip *s,
                       Watch *watch)
{
    REAL share[WR_SPAN];
    if (!runs(job, WR_EFFECT_OCCLUSION)) return;
    open_share(job, s, share);
    for (int k = 0; k < 3; k++)
        KERNELS_OF(job)->veil(share, before ? before->of[k] : NULL, s->count, to[k]);
    did(watch, WR_EFFECT_OCCLUSION);
    watch_lap(watch, WR_STAGE_OCCLUSION);
}
