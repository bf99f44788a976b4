/* Horizon and ambient occlusion tables of the height field, updated with each frame. */
#include "base/memory.h"
#include "field/field.h"
#include "render/frame/frame_internal.h"

void wr_frame_drop_horizon(WrRenderer *renderer)
{
    wr_horizon_drop(&renderer->horizon);
    wr_field_free(renderer->horizon_field);
    wr_free(renderer->horizon_edit);
    renderer->horizon_field = NULL;
    renderer->horizon_edit = NULL;
}

/* Updates the horizons after an edit of the table. */
static bool update_horizon(WrRenderer *renderer, WrError *err)
{
    WrHorizon *horizon = &renderer->horizon;
    const size_t texels = (size_t)horizon->width * (size_t)horizon->height;
    if (!renderer->horizon_edit)
        renderer->horizon_edit = wr_try_alloc(texels, 1, "horizons of the table", err);
    if (!renderer->horizon_edit ||
        !wr_horizon_update(horizon, renderer->horizon_field, renderer->looked,
                           renderer->horizon_sign, renderer->horizon_edit, renderer->pool, err)) {
        wr_frame_drop_horizon(renderer);
        return false;
    }
    wr_field_free(renderer->horizon_field);
    renderer->horizon_field = wr_field_share(renderer->looked);
    renderer->horizon_before = renderer->horizon_key;
    renderer->horizon_key = wr_field_key(renderer->looked);
    return true;
}

/* Updates the table's horizons; after an edit, only the changed ones. */
bool wr_frame_update_horizon(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const double sign = request->scene->height < 0 ? -1 : 1;
    const uint64_t key = wr_field_key(renderer->looked);
    WrHorizon *horizon = &renderer->horizon;
    const WrPlan *plan = &renderer->plan;
    if (!wr_plan_runs(plan, WR_EFFECT_SHADOW) && !wr_plan_runs(plan, WR_EFFECT_OCCLUSION)) {
        if (!request->hold) wr_frame_drop_horizon(renderer);
        return true;
    }
    const bool like = horizon->slope && renderer->horizon_sign == sign &&
                      horizon->directions == plan->horizons &&
                      wr_field_alike(renderer->horizon_field, renderer->looked);
    if (like && renderer->horizon_key == key) return true;
    if (like) return update_horizon(renderer, err);
    wr_frame_drop_horizon(renderer);
    renderer->horizon_key = key, renderer->horizon_sign = sign;
    renderer->horizon_field = wr_field_share(renderer->looked);
    return wr_horizon_make(horizon, renderer->looked, plan->horizons, sign, renderer->pool, err);
}

bool wr_frame_update_occlusion(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_OCCLUSION))
        return wr_occlusion_map_table_update(&renderer->opening, request->scene, renderer->looked,
                                             &(WrOcclusionMapEdit){ renderer->horizon_key,
                                                                    renderer->horizon_before,
                                                                    renderer->horizon_edit },
                                             &renderer->horizon, renderer->pool, err);
    if (!request->hold) wr_occlusion_map_table_drop(&renderer->opening);
    return true;
}
