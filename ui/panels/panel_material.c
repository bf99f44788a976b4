/* The scene's panel: bump and material. */
#include "ui/desk/desk.h"
#include "ui/desk/scene_line.h"
#include "ui/desk/session_view.h"
#include "ui/gui/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"

#include "base/text.h"
#include "field/scheme.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "shade/bump_mode.h"

/* ---- bump ---- */

static void bump(WrApp *app)
{
    const char *modes[WR_BUMP_COUNT], *schemes[WR_SCHEME_COUNT];
    const WrScene *scene = wr_app_scene(app);
    int mode = (int)scene->bump, scheme = (int)scene->scheme;
    for (int i = 0; i < WR_BUMP_COUNT; i++) modes[i] = wr_bumps[i].title;
    for (int i = 0; i < WR_SCHEME_COUNT; i++) schemes[i] = wr_schemes[i].title;
    wr_gui_space(8);
    wr_gui_heading("BUMP");
    wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_HEIGHT]);
    WrText line = { 0 };
    wr_gui_label("Normal");
    if (wr_gui_choice("mode", 0, modes, WR_BUMP_COUNT, &mode))
        wr_text_addf(&line, "bump mode=%s", wr_bumps[mode].name);
    wr_gui_tip(
        "How the normal is made: the paper's N + D, the same whatever the scale, or the true "
        "normal of the displaced surface");
    wr_gui_label("Derivative");
    if (wr_gui_choice("scheme", 0, schemes, WR_SCHEME_COUNT, &scheme))
        wr_text_addf(&line, "bump scheme=%s", wr_schemes[scheme].name);
    wr_gui_tip(wr_schemes[scheme].help);
    if (line.length) wr_scene_run(app, &line);
    wr_text_fini(&line);
}

/* ---- material ---- */

static void material(WrApp *app)
{
    const WrSceneParam *param;
    wr_gui_space(8);
    wr_gui_heading("MATERIAL");
    for (int i = 0; (param = wr_scene_param("material", NULL, i)) != NULL; i++)
        if (param->label) wr_param_row(app, param);
}

void wr_panel_material(WrApp *app)
{
    bump(app);
    material(app);
}
