#include "ui/panels/param_row.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"

#include "base/text.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

WrNumber wr_param_slider(const WrSceneParam *param)
{
    return (WrNumber){ .low = param->soft_low,
                       .high = param->soft_high,
                       .hard_low = param->low,
                       .hard_high = param->high,
                       .reset = param->fallback[0],
                       .decimals = param->decimals,
                       .unit =
                           param->unit && strcmp(param->unit, "degrees") == 0 ? "\xc2\xb0" : NULL,
                       .logarithmic = param->logarithmic,
                       .tip = param->help };
}

static void run(WrApp *app, const WrSceneParam *param, const double *values)
{
    WrText line = { 0 };
    wr_text_addf(&line, "%s", param->command);
    if (param->form) wr_text_addf(&line, " %s", param->form);
    else if (strcmp(param->command, "camera") == 0)
        wr_text_addf(&line, " %s", wr_camera_names[wr_app_scene(app)->camera.orthographic]);
    wr_line_param(&line, param, values);
    wr_scene_run(app, &line);
}

void wr_param_row(WrApp *app, const WrSceneParam *param)
{
    const WrScene *scene = wr_app_scene(app);
    WrNumber spec = wr_param_slider(param);
    double values[3];
    /* Built-in surfaces have a radius near 1; a mesh in millimetres needs other heights. */
    if (param == &wr_scene_params[WR_SCENE_PARAM_HEIGHT] && scene->triangles)
        spec.high *= fmax(1, scene->triangles->radius);
    wr_scene_param_get(param, scene, values);
    wr_gui_label(param->label);
    const WrEdit edit = param->components == 1 ? wr_gui_number(param->name, 0, &spec, values)
                                               : wr_gui_colour(param->name, 0, values);
    if (edit != WR_EDIT_NONE) wr_scene_param_set(param, wr_app_live_begin(app), values);
    if (edit == WR_EDIT_DONE) run(app, param, values);
}

WrEdit wr_param_vector(const char *label, const char *const id[3], const WrNumber *spec,
                       double v[3])
{
    WrEdit edit = WR_EDIT_NONE;
    wr_gui_label(label);
    const double third = (wr_gui_available() - wr_gui_px(8)) / 3;
    for (int i = 0; i < 3; i++) {
        const WrEdit own = wr_gui_number(id[i], third, spec, &v[i]);
        if (own > edit) edit = own;
        if (i < 2) wr_gui_same_line(4);
    }
    return edit;
}

void wr_param_vector_row(WrApp *app, const WrSceneParam *param, const char *label,
                         const char *const id[3], const WrNumber *spec)
{
    double values[3];
    wr_scene_param_get(param, wr_app_scene(app), values);
    const WrEdit edit = wr_param_vector(label, id, spec, values);
    if (edit != WR_EDIT_NONE) wr_scene_param_set(param, wr_app_live_begin(app), values);
    if (edit == WR_EDIT_DONE) run(app, param, values);
}
