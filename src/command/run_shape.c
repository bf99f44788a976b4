/* surface, rotate, analytic, bump, replicate. */
#include "command/inner.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* HC41: on a closed surface a replication that is not whole leaves a seam. */
static void warn_seam(WrSession *session, const WrScene *scene)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    double u = scene->replicate_u, v = scene->replicate_v;
    if ((info->closed_u && u != floor(u)) || (info->closed_v && v != floor(v)))
        wr_session_note(
            session,
            "replicate %g,%g leaves a seam on the %s, which is closed: whole numbers do not", u, v,
            info->name);
}

bool wr_run_surface(WrSession *session, WrCall *call, WrError *err)
{
    WrShape shape = { .kind = (WrSurfaceKind)call->form };
    wr_shape_default(shape.kind, &shape);
    for (int i = 0; i < call->count; i++) {
        if (!call->args[i].given) continue;
        int offset = wr_surface_param_offset(shape.kind, call->specs[i].name);
        WR_ASSERT(offset >= 0);
        memcpy(shape.value + offset, call->args[i].numbers,
               (size_t)call->args[i].rows * (size_t)wr_arg_width(&call->specs[i]) * sizeof(double));
    }
    if (!wr_shape_check(&shape, err)) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->shape = shape;
    warn_seam(session, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

bool wr_run_rotate(WrSession *session, WrCall *call, WrError *err)
{
    bool own = wr_call_given(call, "pose"), turned = wr_call_given(call, "x,y,z");
    if (own == turned) return wr_fail(err, "needs one of x,y,z and pose=own");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->posed = turned;
    scene->rotate_deg = turned ? wr_call_vec3(call, "x,y,z") : (WrVec3){ 0 };
    wr_session_replace_scene(session, scene);
    return true;
}

bool wr_run_analytic(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    static const struct {
        const char *form, *list;
        WrAnalyticKind kind;
    } forms[] = { { "poly", "c", WR_ANALYTIC_POLY },
                  { "fourier", "terms", WR_ANALYTIC_FOURIER },
                  { "off", NULL, WR_ANALYTIC_OFF } };
    int which = 0;
    while (strcmp(forms[which].form, call->form_name) != 0) which++;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_free(scene->analytic.terms);
    scene->analytic = (WrAnalytic){ .kind = forms[which].kind };
    if (forms[which].list) {
        const WrArg *list = wr_call_arg(call, forms[which].list);
        size_t width = forms[which].kind == WR_ANALYTIC_POLY ? 3 : 5;
        scene->analytic.terms = wr_alloc((size_t)list->rows, sizeof *scene->analytic.terms);
        scene->analytic.count = list->rows;
        for (int i = 0; i < list->rows; i++) {
            const double *row = list->numbers + width * (size_t)i;
            scene->analytic.terms[i] =
                (WrAnalyticTerm){ (int)row[0], (int)row[1], row[2], width > 3 ? row[3] : 0,
                                  width > 3 ? row[4] : 0 };
        }
    }
    wr_session_replace_scene(session, scene);
    return true;
}

bool wr_run_bump(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (wr_call_given(call, "mode")) scene->bump = (WrBumpMode)wr_call_choice(call, "mode");
    if (wr_call_given(call, "scheme")) scene->scheme = (WrScheme)wr_call_choice(call, "scheme");
    if (wr_call_given(call, "height")) scene->height = wr_call_number(call, "height");
    wr_session_replace_scene(session, scene);
    return true;
}

bool wr_run_replicate(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    const WrArg *arg = wr_call_arg(call, "ru,rv");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->replicate_u = arg->numbers[0];
    scene->replicate_v = arg->numbers[1];
    warn_seam(session, scene);
    wr_session_replace_scene(session, scene);
    return true;
}
