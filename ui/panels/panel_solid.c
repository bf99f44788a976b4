/* Relief section of the scene panel: effects of the relief besides normals, and the solid texture. */
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "scene/param.h"
#include "scene/scene.h"

/* A switch of the scene. */
static void flag(WrApp *app, WrSceneParamId id, const char *label, const char *tip)
{
    const WrSceneParam *param = &wr_scene_params[id];
    double values[3];
    wr_scene_param_get(param, wr_app_scene(app), values);
    bool on = values[0] != 0;
    const bool changed = wr_gui_check(label, &on);
    wr_gui_tip(tip);
    if (!changed) return;
    WrText line = { 0 };
    values[0] = on;
    wr_text_add(&line, param->command);
    wr_line_param(&line, param, values);
    wr_scene_run(app, &line);
}

static void relief(WrApp *app)
{
    if (!wr_gui_fold("RELIEF", true)) return;
    flag(app, WR_SCENE_PARAM_SHADOW, "Self-shadowing",
         "The relief casts shadows on itself, for lights but not for the environment");
    flag(app, WR_SCENE_PARAM_OCCLUSION, "Ambient occlusion",
         "Darkens cavities: ambient and environment light by the visible part of the sky");
    flag(app, WR_SCENE_PARAM_PARALLAX, "Parallax",
         "Continues rays from the base surface to the relief: between bump mapping and true "
         "displacement. Silhouettes are correct on planes, spheres and cylinders; on other "
         "surfaces they are those of the base");
    flag(app, WR_SCENE_PARAM_DISPLACED, "Displacement",
         "True displacement, silhouettes included, in place of bump mapping. Slower: each edit "
         "tessellates the surface again");
}

/* True if this solid texture uses the number. */
static bool counts(const WrSolidTexture *grain, WrSceneParamId id)
{
    const WrSolidTextureInfo *info = &wr_grains[grain->kind];
    switch (id) {
    case WR_SCENE_PARAM_GRAIN_LIGHT:
    case WR_SCENE_PARAM_GRAIN_DARK: return grain->drives & WR_SOLID_TEXTURE_COLOURS;
    case WR_SCENE_PARAM_GRAIN_HEIGHT: return grain->drives & WR_SOLID_TEXTURE_BUMPS;
    case WR_SCENE_PARAM_GRAIN_ROUGH_LIGHT:
    case WR_SCENE_PARAM_GRAIN_ROUGH_DARK: return grain->drives & WR_SOLID_TEXTURE_ROUGHENS;
    case WR_SCENE_PARAM_GRAIN_EDGE: return info->stepped;
    case WR_SCENE_PARAM_GRAIN_RINGS: return info->ringed;
    case WR_SCENE_PARAM_GRAIN_SHARE: return info->shared;
    case WR_SCENE_PARAM_GRAIN_AMOUNT:
    case WR_SCENE_PARAM_GRAIN_CELLS:
    case WR_SCENE_PARAM_GRAIN_OCTAVES:
    case WR_SCENE_PARAM_GRAIN_RATIO: return info->noisy;
    default: return true;
    }
}

static void choose(WrApp *app, const char *id, const char *const *names, int count, int now,
                   const char *format, const char *const *words)
{
    if (!wr_gui_choice(id, 0, names, count, &now)) return;
    WrText line = { 0 };
    wr_text_add(&line, format);
    wr_text_add(&line, words[now]);
    wr_scene_run(app, &line);
}

static void solid(WrApp *app)
{
    static const char *const axes[WR_SOLID_TEXTURE_AXES] = { "X", "Y", "Z" };
    static const char *const drives[WR_SOLID_TEXTURE_DRIVES - 1] = {
        "Colour", "Roughness", "Colour, roughness", "Bump", "Colour, bump", "Roughness, bump", "All"
    };
    const char *titles[WR_SOLID_TEXTURE_KINDS], *words[WR_SOLID_TEXTURE_KINDS];
    const WrSolidTexture *grain = &wr_app_scene(app)->grain;
    const WrSolidTextureInfo *info = &wr_grains[grain->kind];
    for (int i = 0; i < WR_SOLID_TEXTURE_KINDS; i++)
        titles[i] = wr_grains[i].title, words[i] = wr_grains[i].name;
    if (!wr_gui_fold("SOLID TEXTURE", false)) return;
    wr_gui_label("Pattern");
    choose(app, "grain", titles, WR_SOLID_TEXTURE_KINDS, (int)grain->kind, "grain ", words);
    wr_gui_tip(
        "A 3D pattern through the object, such as wood; its colours multiply the base colour");
    if (wr_app_scene(app)->grain.kind == WR_SOLID_TEXTURE_OFF) return;
    wr_gui_label("Drives");
    choose(app, "drives", drives, WR_SOLID_TEXTURE_DRIVES - 1, grain->drives - 1,
           "grain drives=", wr_solid_texture_drives + 1);
    wr_gui_tip("Effect of the pattern: colour, roughness, or heights that tilt the normal");
    if (info->ringed && info->noisy) {
        wr_gui_label("Axis");
        choose(app, "axis", axes, WR_SOLID_TEXTURE_AXES, (int)grain->axis,
               "grain axis=", wr_solid_texture_axes);
    }
    for (int id = WR_SCENE_PARAM_GRAIN_LIGHT; id <= WR_SCENE_PARAM_GRAIN_ROUGH_DARK; id++)
        if (counts(grain, (WrSceneParamId)id)) wr_param_row(app, &wr_scene_params[id]);
}

void wr_panel_solid(WrApp *app)
{
    relief(app);
    solid(app);
}
