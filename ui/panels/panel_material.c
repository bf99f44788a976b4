/* The scene's panel: bump and material. */
#include "ui/desk/desk.h"
#include "ui/desk/line.h"
#include "ui/desk/scene_line.h"
#include "ui/desk/session_view.h"
#include "ui/gui/gui.h"
#include "ui/panels/panels.h"

#include "base/text.h"
#include "base/vec.h"
#include "field/scheme.h"
#include "scene/scene.h"
#include "shade/bump.h"

#include <math.h>
#include <stddef.h>

/* ---- bump ---- */

static void bump(WrApp *app)
{
    const char *modes[WR_BUMP_COUNT], *schemes[WR_SCHEME_COUNT];
    static const WrNumber spec = { .low = 0,
                                   .high = 0.3,
                                   .hard_low = -1e30,
                                   .hard_high = 1e30,
                                   .reset = 0.1,
                                   .decimals = 4,
                                   .tip = "Displacement, in scene units, where the table is 1" };
    const WrScene *scene = wr_app_scene(app);
    int mode = (int)scene->bump, scheme = (int)scene->scheme;
    double height = scene->height;
    for (int i = 0; i < WR_BUMP_COUNT; i++) modes[i] = wr_bumps[i].title;
    for (int i = 0; i < WR_SCHEME_COUNT; i++) schemes[i] = wr_schemes[i].title;
    wr_gui_space(8);
    wr_gui_heading("BUMP");
    wr_gui_label("Height");
    WrEdit edit = wr_gui_number("height", 0, &spec, &height);
    if (edit != WR_EDIT_NONE) wr_scene_live_number(app, offsetof(WrScene, height), height);
    WrText line = { 0 };
    if (edit == WR_EDIT_DONE) {
        wr_text_add(&line, "bump");
        wr_line_number(&line, "height", height);
    }
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
    static const struct {
        const char *label, *name, *tip;
        size_t place;
        double high, reset;
        bool log;
    } rows[] = {
        { "Ambient", "ambient", "ka: light from everywhere", offsetof(WrScene, material.ambient), 1,
          0.08, false },
        { "Diffuse", "diffuse", "kd: matt reflection", offsetof(WrScene, material.diffuse), 1, 0.72,
          false },
        { "Specular", "specular", "ks: strength of the highlight",
          offsetof(WrScene, material.specular), 1, 0.35, false },
        { "Shininess", "shininess", "s: the highlight's exponent; higher is smaller",
          offsetof(WrScene, material.shininess), 500, 40, true },
    };
    wr_gui_space(8);
    wr_gui_heading("MATERIAL");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double value = *(const double *)((const char *)wr_app_scene(app) + rows[i].place);
        WrNumber spec = { .low = rows[i].log ? 1 : 0,
                          .high = rows[i].high,
                          .hard_low = 0,
                          .hard_high = rows[i].log ? 1e6 : 1000,
                          .reset = rows[i].reset,
                          .decimals = rows[i].log ? -1 : 3,
                          .logarithmic = rows[i].log,
                          .tip = rows[i].tip };
        wr_gui_label(rows[i].label);
        WrEdit edit = wr_gui_number(rows[i].name, 0, &spec, &value);
        if (edit != WR_EDIT_NONE) wr_scene_live_number(app, rows[i].place, value);
        if (edit != WR_EDIT_DONE) continue;
        WrText line = { 0 };
        wr_text_add(&line, "material");
        wr_line_number(&line, rows[i].name, value);
        wr_scene_run(app, &line);
    }
    WrVec3 c = wr_app_scene(app)->material.colour;
    double rgb[3] = { c.x, c.y, c.z };
    wr_gui_label("Colour");
    WrEdit edit = wr_gui_colour("colour", 0, rgb);
    if (edit != WR_EDIT_NONE)
        wr_app_live(app)->material.colour = (WrVec3){ rgb[0], rgb[1], rgb[2] };
    if (edit != WR_EDIT_DONE) return;
    WrText line = { 0 };
    wr_text_add(&line, "material");
    wr_line_vec(&line, "colour", (WrVec3){ rgb[0], rgb[1], rgb[2] });
    wr_scene_run(app, &line);
}

void wr_panel_material(WrApp *app)
{
    bump(app);
    material(app);
}
