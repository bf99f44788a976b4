/* What the samples of a resting view look at (sight.h): when it is known, and when it is noted. */
#include "render/frame_inner.h"

#define SIGHT_MOST (1 << 24) /* pixels; 8 bytes each */

/* Against the planner nothing is noted: what is drawn is not what it would be. */
static bool is_forced(const WrFrameRequest *request)
{
    const WrForce *force = request->force;
    return request->full || (force && (force[WR_EFFECT_DEPTH] || force[WR_EFFECT_NEWTON] ||
                                       force[WR_EFFECT_BESIDE] || force[WR_EFFECT_HIDDEN]));
}

/* What the samples of a resting view look at: known from before, or noted from now on. One a pixel, in single
   precision. */
static bool bring_sight(WrRenderer *renderer, const WrFrameRequest *request, WrHash beside,
                        bool anew)
{
    const WrPlan *plan = &renderer->plan;
    const int64_t objects = renderer->among ? renderer->among : 1;
    WrSightKey key;
    if (!renderer->mesh) wr_sight_fini(&renderer->sight);
    const bool small = objects * request->width * request->height <= SIGHT_MOST;
    renderer->sighting = small && wr_frame_may_keep(request) && renderer->mesh &&
                         plan->newton != 0 && plan->sampling == WR_SAMPLING_ONE &&
                         !plan->shading_double && !is_forced(request);
    if (!renderer->sighting) return false;
    const WrTileJob job = { .plan = plan, .scene = renderer->scene };
    wr_sight_key(&key, renderer->mesh, &renderer->view, wr_tile_exact(&job), renderer->kernels);
    key.beside = beside;
    if (wr_sight_bring(&renderer->sight, &key)) return true;
    renderer->sighting = renderer->sight.u != NULL && anew;
    return false;
}

void wr_frame_bring_sight(WrRenderer *renderer, const WrFrameRequest *request, WrHash beside,
                          bool anew)
{
    WrPlanAsk *ask = &renderer->ask;
    ask->facts.sighted = renderer->sighted = bring_sight(renderer, request, beside, anew);
    wr_plan_again(&renderer->plan, ask);
}
