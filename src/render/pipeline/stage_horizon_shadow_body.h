/* stage_horizon_shadow_body.h - self-shadowing of the relief: a lamp is visible if it stands above the table's
   horizon in its direction (render/kernels/kern_horizon_body.h). Part of pipeline_body.h. */

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

/* Reads the lamp's cached visibility. False: it is unknown for some sample. */
static bool recall_seen(const WrTileJob *job, const float *known, const Strip *s,
                        REAL share[WR_SPAN], WrSeen *seen)
{
    int whole = 0, not = 0, decided = 0;
    for (int i = 0; i < s->count; i++) {
        share[i] = (REAL)known[share_place(job, s, i)];
        decided += share[i] >= (REAL)0;
        whole += !(share[i] < (REAL)1);
        not += !(share[i] > (REAL)0);
    }
    *seen = whole == s->count ? WR_SEEN_WHOLE : not == s->count ? WR_SEEN_NOT : WR_SEEN_PART;
    return decided == s->count;
}

/* Visibility of a lamp at the strip's samples. */
static WrSeen seen_of(const WrTileJob *job, const WR_T(WrKernLight) * light, const Strip *s,
                      REAL share[WR_SPAN], Watch *watch)
{
    const WR_T(WrKernHorizon) horizon = horizon_of(job);
    float *known = job->lamps ? job->lamps[light - VIEWED(job->view, lights)].relief : NULL;
    WrSeen seen;
    if (known && recall_seen(job, known, s, share, &seen)) return seen;
    did(watch, WR_EFFECT_SHADOW);
    seen = KERNELS_OF(job)->shadow(light, &horizon, s, share);
    for (int i = 0; i < s->count && known; i++) known[share_place(job, s, i)] = (float)share[i];
    return seen;
}

/* Light sums before a lamp is added. */
typedef struct Sums {
    REAL of[6][WR_SPAN];
} Sums;

static void keep_sums(const Strip *s, Sums *sums)
{
    const REAL *const from[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    for (int k = 0; k < 6; k++) memcpy(sums->of[k], from[k], (size_t)s->count * sizeof(REAL));
}

/* Multiplies the lamp's light, already added to the strip, by its visibility. */
static void shadow_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, const Sums *before,
                         Strip *s, Watch *watch)
{
    REAL *const to[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    REAL share[WR_SPAN];
    const bool any = seen_of(job, light, s, share, watch) != WR_SEEN_WHOLE;
    for (int k = 0; k < 6 && any; k++) KERNELS_OF(job)->veil(share, before->of[k], s->count, to[k]);
    watch_lap(watch, WR_STAGE_SHADOW);
}
