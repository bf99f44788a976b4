/* pipe_shadow_body.h - shadows that the relief throws on itself: a lamp is seen where it stands above the horizon of the
   table in its direction (render/kern_shadow_body.h). A part of pipe_body.h. */

static WR_T(WrKernHorizon) horizon_of(const WrTileJob *job)
{
    const WrHorizon *h = job->horizon;
    return (WR_T(WrKernHorizon)){ .slope = h->slope,
                                  .open = job->opening->open,
                                  .width = h->width,
                                  .height = h->height,
                                  .directions = h->directions,
                                  .ru = (REAL)job->look_double.ru,
                                  .rv = (REAL)job->look_double.rv,
                                  .relief = (REAL)job->relief_height,
                                  .steepest = (REAL)h->steepest };
}

/* What the strip's samples see of a lamp. */
static WrSeen seen_of(const WrTileJob *job, const WR_T(WrKernLight) * light, const Strip *s,
                      REAL share[WR_SPAN])
{
    const WR_T(WrKernHorizon) horizon = horizon_of(job);
    return KERNELS_OF(job)->shadow(light, &horizon, s, share);
}

/* The sums of the light so far, before a lamp adds to them. */
typedef struct Sums {
    REAL of[6][WR_SPAN];
} Sums;

static void keep_sums(const Strip *s, Sums *sums)
{
    const REAL *const from[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    for (int k = 0; k < 6; k++) memcpy(sums->of[k], from[k], (size_t)s->count * sizeof(REAL));
}

/* The lamp, which the strip has added, as far as it is seen. */
static void shadow_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, const Sums *before,
                         Strip *s, Watch *watch)
{
    REAL *const to[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    REAL share[WR_SPAN];
    const bool any = seen_of(job, light, s, share) != WR_SEEN_WHOLE;
    for (int k = 0; k < 6 && any; k++) KERNELS_OF(job)->veil(share, before->of[k], s->count, to[k]);
    did(watch, WR_EFFECT_SHADOW);
    watch_lap(watch, WR_STAGE_SHADOW);
}
