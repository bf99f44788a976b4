/* Shadow casters of each object of a picture, found before it is planned. */
#include "render/frame/frame_internal.h"
#include "scene/objects.h"

/* True if forced effects request even casters that cannot hide a lamp. */
static bool wants_all(const WrFrameRequest *request)
{
    return request->full || (request->force && request->force[WR_EFFECT_CAST] == WR_FORCE_ON);
}

/* True if forced effects replace even displaced casters by their bases. */
static bool keeps_bases(const WrFrameRequest *request)
{
    return request->force && request->force[WR_EFFECT_DISPLACED] == WR_FORCE_OFF;
}

bool wr_frame_casts(WrRenderer *const *renderers, const WrScene *const *scenes,
                    const WrField *const *fields, int count, const WrFrameRequest *request,
                    WrError *err)
{
    const WrDials *dials = request->dials ? request->dials : &request->scene->dials;
    WrShadowRaysBody *bodies[WR_OBJECTS_MAX];
    for (int i = 0; i < count; i++) {
        renderers[i]->cast.count = renderers[i]->cast.all = 0;
        bodies[i] = &renderers[i]->body;
    }
    if (dials->rays == 0 || !wr_shadow_rays_asked(request->scene)) return true;
    for (int i = 0; i < count; i++) {
        const WrShadowRaysRequest ask = { .scenes = scenes,
                                          .fields = fields,
                                          .bodies = bodies,
                                          .count = count,
                                          .at = i,
                                          .rays = dials->rays,
                                          .all = wants_all(request),
                                          .moves = !keeps_bases(request),
                                          .turn_deg = request->turn_deg,
                                          .aspect = (double)request->width / request->height };
        if (!wr_shadow_rays_prepare(&renderers[i]->cast, &ask, err)) return false;
    }
    return true;
}
