/* Bump and material sections of the scene panel. */
#include "ui/app/state/action.h"
#include "field/scheme_list.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/picture_grid.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"

#include "base/text.h"
#include "field/scheme.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "shade/bump_mode.h"
#include "shade/reflection_models.h"

/* ---- bump ---- */

static void bump(WrApp *app)
{
    const char *modes[WR_BUMP_COUNT], *schemes[WR_SCHEME_COUNT];
    const WrScene *scene = wr_app_scene(app);
    int mode = (int)scene->bump, scheme = (int)scene->scheme;
    for (int i = 0; i < WR_BUMP_COUNT; i++) modes[i] = wr_bumps[i].title;
    for (int i = 0; i < WR_SCHEME_COUNT; i++) schemes[i] = wr_schemes[i].title;
    if (!wr_gui_fold("BUMP", true)) return;
    wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_HEIGHT]);
    WrText line = { 0 };
    wr_gui_label("Normal");
    if (wr_gui_choice("mode", 0, modes, WR_BUMP_COUNT, &mode))
        wr_text_addf(&line, "bump mode=%s", wr_bumps[mode].name);
    wr_gui_tip("Normal formula: the paper's N + D, a scale-independent form of it, or the true "
               "normal of the displaced surface");
    wr_gui_label("Derivative");
    if (wr_gui_choice("scheme", 0, schemes, WR_SCHEME_COUNT, &scheme))
        wr_text_addf(&line, "bump scheme=%s", wr_schemes[scheme].name);
    wr_gui_tip(wr_schemes[scheme].help);
    if (line.length) wr_scene_run(app, &line);
    wr_text_fini(&line);
}

/* ---- material ---- */

/* True if the current reflection model uses this number. */
static bool counts(const WrReflectInfo *model, const WrSceneParam *param)
{
    const ptrdiff_t row = param - wr_scene_params;
    if (row == WR_SCENE_PARAM_SHININESS) return model->shininess;
    if (row == WR_SCENE_PARAM_ROUGHNESS) return model->roughness;
    if (row == WR_SCENE_PARAM_METALNESS) return model->metalness;
    if (row == WR_SCENE_PARAM_IOR) return model->ior;
    if (row == WR_SCENE_PARAM_SPECULAR || row == WR_SCENE_PARAM_TINT) return model->shines;
    return true;
}

/* The reflection model, and its variant if there are two. */
static void reflection(WrApp *app)
{
    const char *models[WR_REFLECT_COUNT];
    const WrMaterial *m = &wr_app_scene(app)->material;
    int model = (int)m->model, energy = (int)m->energy;
    for (int i = 0; i < WR_REFLECT_COUNT; i++) models[i] = wr_reflects[i].title;
    WrText line = { 0 };
    wr_gui_label("Reflection");
    if (wr_gui_choice("model", 0, models, WR_REFLECT_COUNT, &model))
        wr_text_addf(&line, "material model=%s", wr_reflects[model].name);
    wr_gui_tip(wr_reflects[model].help);
    if (wr_reflects[m->model].energies) {
        wr_gui_label("Energy");
        if (wr_gui_choice("energy", 0, wr_energies, WR_ENERGY_COUNT, &energy))
            wr_text_addf(&line, "material energy=%s", wr_energies[energy]);
        wr_gui_tip("Kept: conserves energy. Published: as in the model's source");
    }
    if (line.length) wr_scene_run(app, &line);
    wr_text_fini(&line);
}

static void material(WrApp *app)
{
    const WrSceneParam *param;
    if (!wr_gui_fold("MATERIAL", true)) return;
    wr_material_grid(app);
    wr_gui_label("From a file");
    if (wr_gui_chip(WR_ICON_FOLDER, "glTF...")) wr_action_run(app, WR_ACT(gltf));
    wr_gui_tip("Uses material and pictures of a .gltf or .glb file for the active object");
    reflection(app);
    const WrReflectInfo *model = &wr_reflects[wr_app_scene(app)->material.model];
    for (int i = 0; (param = wr_scene_param("material", NULL, i)) != NULL; i++)
        if (param->label && counts(model, param)) wr_param_row(app, param);
}

void wr_panel_material(WrApp *app)
{
    bump(app);
    material(app);
}
