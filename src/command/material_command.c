/* Command material: the reflectance of the surface. */
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/material_preset.h"
#include "scene/scene.h"

static void print_material(const WrScene *scene, WrText *text)
{
    wr_text_add(text, "material");
    const WrMaterial *m = &scene->material;
    if (m->model != WR_REFLECT_DEFAULT) wr_text_addf(text, " model=%s", wr_reflects[m->model].name);
    if (m->energy != WR_ENERGY_KEPT) wr_text_addf(text, " energy=%s", wr_energies[m->energy]);
    wr_scene_print_params("material", NULL, scene, text);
    wr_text_add(text, "\n");
}

static bool run_material(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrMaterial *m = &scene->material;
    if (wr_call_given(call, "preset")) {
        const bool shadow = m->shadow,
                   occlusion = m->occlusion; /* of the relief, not the material */
        *m = wr_material_presets[wr_call_choice(call, "preset")].material;
        m->shadow = shadow, m->occlusion = occlusion;
    }
    wr_scene_take(call, NULL, scene);
    if (wr_call_given(call, "model")) m->model = wr_call_choice(call, "model");
    if (wr_call_given(call, "energy")) m->energy = (WrEnergy)wr_call_choice(call, "energy");
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *model_choice(int i)
{
    return i < wr_reflect_count ? wr_reflects[i].name : NULL;
}

static const char *energy_choice(int i)
{
    return i < WR_ENERGY_COUNT ? wr_energies[i] : NULL;
}

static const char *preset_choice(int i)
{
    return i < WR_MATERIAL_PRESETS ? wr_material_presets[i].name : NULL;
}

static bool row_material(WrForm *out)
{
    *out = (WrForm){
        .args = { { .name = "preset",
                    .type = WR_ARG_CHOICE,
                    .choice = preset_choice,
                    .help = "preset of all arguments, applied before the others" },
                  { .name = "model",
                    .type = WR_ARG_CHOICE,
                    .choice = model_choice,
                    .help = "reflection model" },
                  { .name = "energy",
                    .type = WR_ARG_CHOICE,
                    .choice = energy_choice,
                    .help = "kept: conserves energy; published: as in the model's source" } }
    };
    return wr_scene_args("material", NULL, out->args + 3) > 0;
}

const WrCommand wr_command_material = {
    .name = "material",
    .kind = WR_CLASS_SCENE,
    .row = row_material,
    .run = run_material,
    .print = print_material,
    .of_object = true,
    .help = "set the material of the surface",
    .details = "Only given arguments change.",
    .example = "material model=ggx diffuse=1 specular=1 roughness=0.4"
};
