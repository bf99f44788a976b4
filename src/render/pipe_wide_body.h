/* pipe_wide_body.h - what goes to the kernels of several stages at once (kern_wide.h), where there are such. A part of
   pipe_body.h. */

#ifdef HAS_WIDE
/* The light of the single lamp. False: the stages do it. */
static bool shaded_wide(const WrTileJob *job, const Rays *rays, const WrKernShine *shine,
                        const WrKernMaterial *material, Strip *strip)
{
    return job->wide &&
           job->wide->shade(rays, job->view->lights, shine, material, pictured(job), strip);
}
#else
static bool shaded_wide(const WrTileJob *job, const Rays *rays, const WR_T(WrKernShine) * shine,
                        const WR_T(WrKernMaterial) * material, const Strip *strip)
{
    (void)job, (void)rays, (void)shine, (void)material, (void)strip;
    return false;
}
#endif
