/* Camera section of the scene panel: camera, named views, background. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/patch/patch.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "command/command_line.h"
#include "scene/camera_control.h"
#include "scene/param.h"
#include "scene/scene.h"

#define ROW_UNITS 26

/* ---- position ---- */

static void sides(WrApp *app)
{
    WR_ROWS(buttons);
    static const struct {
        const char *label, *action;
    } buttons[WR_SIDE_COUNT] = {
        [WR_ROW(WR_SIDE_FRONT)] = { "Front", WR_ACT(from_front) },
        [WR_ROW(WR_SIDE_BACK)] = { "Back", WR_ACT(from_back) },
        [WR_ROW(WR_SIDE_LEFT)] = { "Left", WR_ACT(from_left) },
        [WR_ROW(WR_SIDE_RIGHT)] = { "Right", WR_ACT(from_right) },
        [WR_ROW(WR_SIDE_TOP)] = { "Top", WR_ACT(from_top) },
        [WR_ROW(WR_SIDE_BOTTOM)] = { "Bottom", WR_ACT(from_bottom) },
    };
    WR_ROWS_END(buttons, WR_SIDE_COUNT);
    for (int i = 0; i < WR_SIDE_COUNT; i += 2) {
        wr_gui_label(i == 0 ? "From" : "");
        if (wr_gui_chip(NULL, buttons[i].label)) wr_action_run(app, buttons[i].action);
        wr_gui_same_line(4);
        if (wr_gui_chip(NULL, buttons[i + 1].label)) wr_action_run(app, buttons[i + 1].action);
    }
}

/* Position of the eye, if the camera is placed, and its target. */
static void points(WrApp *app)
{
    static const char *const eyes[3] = { "eyex", "eyey", "eyez" }, *const targets[3] = { "tox",
                                                                                         "toy",
                                                                                         "toz" };
    static const WrNumber away = {
        .low = -5,
        .high = 5,
        .hard_low = -1e9,
        .hard_high = 1e9,
        .decimals = 2,
        .tip = "Position in the world: x to the right, y up, z to the viewer"
    };
    const WrCamera *camera = &wr_app_scene(app)->camera;
    const WrSceneParam *eye = &wr_scene_params[WR_SCENE_PARAM_EYE],
                       *target = &wr_scene_params[WR_SCENE_PARAM_TARGET];
    if (!camera->fit) wr_param_vector_row(app, eye, "Eye", eyes, &away);
    wr_param_vector_row(app, target, "Looks at", targets, &away);
}

static void placed(WrApp *app)
{
    static const char *const kinds[] = { "Perspective", "Orthographic" };
    const WrCamera *c = &wr_app_scene(app)->camera;
    int kind = c->orthographic;
    wr_gui_label("Kind");
    if (wr_gui_choice("camera", 0, kinds, 2, &kind)) {
        WrText line = { 0 };
        wr_text_addf(&line, "camera %s", wr_camera_names[kind]);
        wr_scene_run(app, &line);
    }
    if (!c->orthographic) wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_FOV]);
    points(app);
    sides(app);
    wr_gui_label("");
    if (wr_gui_chip(NULL, "Fill")) wr_action_run(app, WR_ACT(camera_fill));
    wr_gui_tip("Moves the camera so that the objects fill the picture");
    wr_gui_same_line(4);
    if (wr_gui_chip(NULL, "Reset")) wr_action_run(app, WR_ACT(camera_reset));
    wr_gui_tip("Moves the camera in front of the objects, so that they fit however they turn");
}

/* ---- named views ---- */

static void run_view(WrApp *app, const char *what, const WrNamedView *view)
{
    WrText line = { 0 };
    wr_text_addf(&line, "camera %s ", what);
    wr_text_add_word(&line, view->name);
    wr_scene_run(app, &line);
}

/* True if a command was run: the list of views has changed. */
static bool view_row(WrApp *app, int i)
{
    const WrScene *scene = wr_app_scene(app);
    const WrNamedView *view = &scene->views[i];
    const WrSceneView now = wr_scene_view(scene);
    const WrRow r = wr_gui_row_begin(i, ROW_UNITS, wr_scene_view_equal(&now, &view->view));
    const double right = wr_gui_row_width() - wr_gui_px(28);
    wr_gui_row_set_cursor(wr_gui_px(8), 0);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_TEXT, view->name, right - wr_gui_px(16));
    wr_gui_as_it_is(false);
    wr_gui_row_set_cursor(right, wr_gui_px(20));
    const bool forget = wr_gui_glyph("forget", WR_ICON_DELETE, 20, WR_COLOUR_MUTED);
    wr_gui_tip("Deletes this view");
    wr_gui_row_end();
    if (forget) run_view(app, "forget", view);
    else if (r.clicked) run_view(app, "use", view);
    return forget || r.clicked;
}

static void views(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    wr_gui_label("Views");
    const bool keep = wr_gui_chip(WR_ICON_PLUS, "Keep this view");
    wr_gui_tip("Stores the present camera in the document");
    for (int i = 0; i < scene->view_count; i++) {
        wr_gui_push_id(1000 + i);
        const bool changed = view_row(app, i);
        wr_gui_pop_id();
        if (changed) return;
    }
    if (keep) wr_action_run(app, WR_ACT(view_keep));
}

/* ---- background ---- */

static void background(WrApp *app)
{
    WR_ROWS(kinds);
    static const char *const kinds[WR_BACKGROUND_KINDS] = {
        [WR_ROW(WR_BACKGROUND_PLAIN)] = "One colour",
        [WR_ROW(WR_BACKGROUND_GRADIENT)] = "Gradient",
        [WR_ROW(WR_BACKGROUND_NONE)] = "None",
        [WR_ROW(WR_BACKGROUND_SURROUNDINGS)] = "Environment",
    };
    WR_ROWS_END(kinds, WR_BACKGROUND_KINDS);
    int kind = (int)wr_app_scene(app)->background.kind;
    if (!wr_gui_fold("BACKGROUND", false)) return;
    wr_gui_label("Kind");
    if (wr_gui_choice("background", 0, kinds, WR_BACKGROUND_KINDS, &kind)) {
        WrText line = { 0 };
        wr_text_addf(&line, "background %s", wr_background_names[kind]);
        wr_scene_run(app, &line);
    }
    wr_gui_tip("Background of the patch and of 8-bit pictures. None: transparent in formats with "
               "alpha, such as PNG. Environment: the HDRI.");
    const WrSceneParam *param;
    for (int i = 0; (param = wr_scene_param("background", wr_background_names[kind], i)); i++)
        wr_param_row(app, param);
}

/* ---- tone mapping ---- */

static void tone(WrApp *app)
{
    WR_ROWS(kinds);
    static const char *const kinds[WR_TONE_KINDS] = {
        [WR_ROW(WR_TONE_CLIP)] = "Clip",
        [WR_ROW(WR_TONE_SOFT)] = "Soft",
    };
    WR_ROWS_END(kinds, WR_TONE_KINDS);
    WrText line = { 0 };
    if (!wr_gui_fold("EXPOSURE", false)) return;
    wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_EXPOSURE]);
    const WrTone *tone = &wr_app_scene(app)->tone; /* of the scene that the row may have made */
    int kind = (int)tone->kind;
    if (tone->view) {
        const WrDisplayView *view = tone->view;
        if (view->ready) wr_text_addf(&line, wr_words("View: %s"), view->names.view);
        else wr_text_addf(&line, wr_words("View: %s, not found"), view->names.view);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, wr_text_get(&line));
        wr_text_clear(&line);
        if (wr_gui_button("Without the view", false)) {
            wr_text_add(&line, "tone view=off");
            wr_scene_run(app, &line);
        }
        wr_gui_tip("The view of a colour configuration converts light to the codes of the picture. "
                   "The command tone sets it");
    } else {
        wr_gui_label("Highlights");
        if (wr_gui_choice("tone", 0, kinds, WR_TONE_KINDS, &kind)) {
            wr_text_addf(&line, "tone %s", wr_tone_names[kind]);
            wr_scene_run(app, &line);
        }
        wr_gui_tip("Clip: light above 1 is white. Soft: highlights above one half are compressed. "
                   "Used here and in 8-bit pictures; EXR and TIFF stay linear.");
    }
    wr_gui_check("Mark clipped parts", &app->patch->look.marked);
    wr_gui_tip("Marks over-exposed pixels with stripes");
    char clipped[120];
    wr_words_print(clipped, sizeof clipped, wr_words("%.1f %% of the picture is clipped"),
                   100 * app->patch->clipped);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, clipped);
    wr_text_fini(&line);
}

void wr_panel_camera(WrApp *app)
{
    if (wr_gui_fold("CAMERA", false)) {
        placed(app);
        views(app);
    }
    background(app);
    tone(app);
}
