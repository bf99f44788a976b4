/* Lights section of the scene panel. */
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"
#include "ui/panels/picture_grid.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "base/vec.h"
#include "command/command_line.h"
#include "scene/param.h"
#include "scene/scene.h"

#include <stdio.h>

/* True if a command was run: the list of lights has changed. */
static bool one_light(WrApp *app, int i)
{
    const char *kinds[WR_LIGHT_KINDS];
    for (int k = 0; k < WR_LIGHT_KINDS; k++) kinds[k] = wr_light_kinds[k].label;
    const WrSceneParam *power = &wr_scene_params[WR_SCENE_PARAM_LIGHT_STRENGTH],
                       *tint = &wr_scene_params[WR_SCENE_PARAM_LIGHT_COLOUR],
                       *round = &wr_scene_params[WR_SCENE_PARAM_LIGHT_SIZE],
                       *hides = &wr_scene_params[WR_SCENE_PARAM_LIGHT_SHADOW];
    const WrNumber strength = wr_param_slider(power), size = wr_param_slider(round);
    WrLight light = wr_app_scene(app)->lights[i];
    char label[24];
    int kind = (int)light.kind;
    double rgb[3] = { light.colour.x, light.colour.y, light.colour.z };
    snprintf(label, sizeof label, wr_words("Light %d"), i + 1);
    wr_gui_label(label);
    bool chosen = wr_gui_choice("kind", 0, kinds, WR_LIGHT_KINDS, &kind);
    wr_gui_tip("Drag the small sun on the patch to move the light");
    wr_gui_label(power->label);
    WrEdit a = wr_gui_number(power->name, 0, &strength, &light.strength);
    wr_gui_label(tint->label);
    WrEdit b = wr_gui_colour(tint->name, 0, rgb);
    wr_gui_label(round->label);
    WrEdit c = wr_gui_number(round->name, 0, &size, &light.size_deg);
    wr_gui_tip("Angular radius of the light in degrees, which softens shadows");
    const bool thrown = wr_gui_check(hides->label, &light.shadow);
    wr_gui_tip("Objects cast shadows in this light, on each other and on themselves");
    light.colour = (WrVec3){ rgb[0], rgb[1], rgb[2] };
    if (a != WR_EDIT_NONE || b != WR_EDIT_NONE || c != WR_EDIT_NONE)
        wr_app_live_begin(app)->lights[i] = light;
    if (chosen && kind != (int)light.kind) {
        light.kind = (WrLightKind)kind;
        WrVec3 unit = v3_unit(light.where, (WrVec3){ 0, 0, 1 });
        light.where = wr_line_round_vec(v3_scale(unit, wr_light_kinds[kind].placed ? 4.0 : 1.0), 3);
    }
    if (!chosen && !thrown && a != WR_EDIT_DONE && b != WR_EDIT_DONE && c != WR_EDIT_DONE)
        return false;
    WrText line = { 0 };
    wr_line_light(&line, &light, i);
    wr_scene_run(app, &line);
    return true;
}

static void lights(WrApp *app)
{
    if (!wr_gui_fold("LIGHT", true)) return;
    wr_light_grid(app);
    for (int i = 0; i < wr_app_scene(app)->light_count; i++) {
        wr_gui_push_id(i);
        bool changed = one_light(app, i);
        wr_gui_pop_id();
        if (changed) break;
    }
    wr_gui_label("");
    if (wr_gui_chip(WR_ICON_PLUS, "Add a light")) {
        WrText line = { 0 };
        wr_text_add(&line, "light directional to=0.6,0.5,0.6 strength=0.5");
        wr_scene_run(app, &line);
    }
}

/* ---- environment ---- */

void wr_light_take_surround(WrApp *app, const char *path)
{
    WrText line = { 0 };
    wr_text_add(&line, "environment ");
    wr_text_add_word(&line, path);
    wr_scene_run(app, &line);
}

static void choose_surround(WrApp *app, WrEnvironmentMapKind kind)
{
    if (kind != WR_ENVIRONMENT_MAP_FILE)
        wr_light_take_surround(app, wr_environment_map_names[kind]);
    else if (!wr_files_request_path(app->files, WR_FILE_SURROUND, NULL, ""))
        wr_dialog_open(app, WR_DIALOG_FILE);
}

static void surroundings(WrApp *app)
{
    const WrEnvironment *now = &wr_app_scene(app)->environment;
    int kind = (int)now->kind;
    if (!wr_gui_fold("ENVIRONMENT", true)) return;
    wr_gui_label("Kind");
    if (wr_gui_choice("surroundings", 0, wr_environment_map_labels, WR_ENVIRONMENT_MAP_KINDS,
                      &kind)) {
        choose_surround(app, (WrEnvironmentMapKind)kind);
        return;
    }
    wr_gui_tip(now->path
                   ? now->path
                   : "Image-based light from all sides, built in or an equirectangular HDRI (HDR "
                     "or EXR). Shift and dragging with the right button on the patch rotates it");
    if (now->kind == WR_ENVIRONMENT_MAP_OFF) return;
    wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_ENVIRONMENT_TURN]);
    wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_ENVIRONMENT_STRENGTH]);
}

void wr_panel_lights(WrApp *app)
{
    lights(app);
    surroundings(app);
}
