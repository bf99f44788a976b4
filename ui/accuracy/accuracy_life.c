/* Creation and destruction of the accuracy state. */
#include "ui/accuracy/accuracy.h"
#include "ui/accuracy/accuracy_work.h"
#include "ui/state/app_options.h"
#include "ui/state/app_state.h"
#include "ui/state/input_router.h"
#include "ui/state/layout.h"
#include "ui/state/settings.h"
#include "ui/tools/stroke_input.h"
#include "ui/jobs/job.h"

#include "base/array.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "scene/scene.h"

#include <SDL.h>

void wr_accuracy_new(WrApp *app)
{
    WrAccuracy *a = app->accuracy = wr_alloc(1, sizeof *a);
    WrWorkTools tools = { .isa = app->options->isa };
    a->measure_tools = a->look_tools = a->probe_tools = tools;
    /* One thread each, so that strokes and the preview are not slowed down. */
    a->measure = wr_job_new(&wr_work_jobs, 1, app->job_event);
    a->looker = wr_job_new(&wr_work_jobs, 1, app->job_event);
    a->prober = wr_job_new(&wr_work_jobs, 1, app->job_event);
    a->split = 0.5;
    a->plot_hot = -1;
    a->state = 1;
}

static void layer_forget(WrPatchLayer *layer)
{
    if (layer->texture) SDL_DestroyTexture(layer->texture);
    *layer = (WrPatchLayer){ 0 };
}

void wr_accuracy_forget(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    for (int i = 0; i < 2; i++) layer_forget(&a->pair[i]);
    layer_forget(&a->map);
    a->look_of = 0;
}

void wr_accuracy_free(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    if (!a) return;
    wr_job_free(a->measure);
    wr_job_free(a->looker);
    wr_job_free(a->prober);
    wr_work_tools_fini(&a->measure_tools);
    wr_work_tools_fini(&a->look_tools);
    wr_work_tools_fini(&a->probe_tools);
    wr_accuracy_forget(app);
    wr_work_free(a->error);
    wr_work_free(a->plot);
    wr_work_free(a->illusion);
    wr_free(a->plot_base);
    wr_free(a->cases.report);
    wr_field_free(a->field);
    if (a->scene) wr_scene_free(a->scene);
    wr_tables_free(a->tables);
    wr_free(a);
    app->accuracy = NULL;
}

bool wr_accuracy_rests(const WrApp *app)
{
    bool turns = app->settings->turning && app->visible;
    bool held = app->hand->grab != WR_GRAB_NONE && app->hand->grab != WR_GRAB_SPLIT;
    return !turns && !held && !app->live && app->brush->jobs.count == 0 &&
           !wr_session_in_stroke(app->session) && app->layout->patch.w > 0;
}
