/* The command camera: placing, moving and named views. */
#include "base/error.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/camera_control.h"
#include "scene/camera.h"
#include "scene/param.h"
#include "scene/scene.h"

enum {
    FORM_PERSPECTIVE,
    FORM_ORTHOGRAPHIC,
    FORM_FROM,
    FORM_ORBIT,
    FORM_PAN,
    FORM_DOLLY,
    FORM_FILL,
    FORM_SAVE,
    FORM_USE,
    FORM_FORGET,
    CAMERA_FORMS
};

#define OWN WR_OWN_TURN

/* ---- as lines ---- */

/* The parameters of the inactive camera kind are saved too, by a line of their own before. */
void wr_print_camera(const WrScene *scene, WrText *text)
{
    const WrSceneParam *own = &wr_scene_params[WR_SCENE_PARAM_FOV],
                       *other = &wr_scene_params[WR_SCENE_PARAM_CAMERA_SIZE];
    const bool swap = scene->camera.orthographic;
    if (swap) other = own;
    wr_text_addf(text, "camera %s %s=", other->form, other->name);
    wr_scene_print_value(other, scene, text);
    wr_text_addf(text, "\ncamera %s", wr_camera_names[swap]);
    wr_scene_print_params("camera", wr_camera_names[swap], scene, text);
    wr_text_add(text, "\n");
}

/* One line of a named view; includes the rotation if it is the one of a scene's only object. */
static void print_named(const WrScene *like, const WrNamedView *named, WrText *text)
{
    WrScene *scene = wr_scene_clone(like);
    scene->camera = named->view.camera;
    scene->rotate_deg = named->view.rotate_deg;
    wr_text_add(text, "camera save ");
    wr_text_add_word(text, named->name);
    wr_text_addf(text, " kind=%s", wr_camera_names[scene->camera.orthographic]);
    wr_scene_print_params("camera", NULL, scene, text);
    if (named->view.of_one) {
        wr_text_add(text, " turn=");
        if (named->view.posed)
            wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_ROTATE], scene, text);
        else wr_text_add(text, OWN);
    }
    wr_text_add(text, "\n");
    wr_scene_free(scene);
}

static void print_all(const WrScene *scene, WrText *text)
{
    for (int i = 0; i < scene->view_count; i++) print_named(scene, &scene->views[i], text);
    wr_print_camera(scene, text);
}

/* ---- named views ---- */

static void give_numbers(WrCall *call, const WrSceneParam *param, const WrScene *scene)
{
    WrArg *arg = wr_call_arg(call, param->name);
    double values[3];
    if (arg->given) return;
    wr_scene_param_get(param, scene, values);
    if (param->components > 0) wr_call_add_row(call, param->name, values, param->components);
    else arg->choice = values[0] != 0;
    arg->given = true;
}

/* Fill in the values that the line omits from the present camera. The stored line is complete, so that it has the
   same meaning wherever it is run. */
static void give_view(WrCall *call, const WrScene *scene)
{
    const WrSceneParam *param;
    WrArg *kind = wr_call_arg(call, "kind");
    if (!kind->given) kind->choice = scene->camera.orthographic;
    kind->given = true;
    for (int i = 0; (param = wr_scene_param("camera", NULL, i)) != NULL; i++)
        give_numbers(call, param, scene);
    if (scene->other_count > 0 || wr_call_given(call, "turn")) return;
    WrText turn = { 0 };
    if (scene->posed) wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_ROTATE], scene, &turn);
    wr_call_set_text(call, "turn", scene->posed ? wr_text_get(&turn) : OWN);
    wr_text_fini(&turn);
}

static bool run_save(WrCall *call, WrScene *scene, WrError *err)
{
    WrPlacement unused;
    const char *name = wr_call_arg(call, "NAME")->text;
    if (scene->view_count == WR_NAMED_VIEWS_MAX && wr_scene_find_view(scene, name) < 0)
        return wr_fail(err, "a document has at most %d views: delete one first (`camera forget`)",
                       WR_NAMED_VIEWS_MAX);
    const bool fits = wr_call_given(call, "eye") && !wr_call_given(call, "fit");
    WrScene *seen = wr_scene_clone(scene);
    if (fits) seen->camera.fit = false;
    give_view(call, seen);
    seen->camera.orthographic = wr_call_choice(call, "kind");
    wr_scene_take(call, NULL, seen);
    const WrArg *turn = wr_call_arg(call, "turn");
    bool good = !turn->given || wr_scene_take_turn(turn->text, seen, err);
    good = good && wr_scene_place(seen, 0, 1, &unused, err);
    WrSceneView view = wr_scene_view(seen);
    view.of_one = turn->given;
    view.posed = turn->given && seen->posed;
    view.rotate_deg = view.posed ? seen->rotate_deg : (WrVec3){ 0 };
    if (good) wr_scene_name_view(scene, name, &view);
    wr_scene_free(seen);
    return good;
}

static bool find_view(const WrCall *call, const WrScene *scene, int *index, WrError *err)
{
    const char *name = wr_call_arg(call, "NAME")->text;
    *index = wr_scene_find_view(scene, name);
    if (*index >= 0) return true;
    if (scene->view_count == 0)
        return wr_fail(err, "no view \"%s\": `camera save` stores the present one", name);
    return wr_fail(err, "no view \"%s\": there are %d, from \"%s\" to \"%s\"", name,
                   scene->view_count, scene->views[0].name,
                   scene->views[scene->view_count - 1].name);
}

static bool run_named(const WrCall *call, WrScene *scene, WrError *err)
{
    int index;
    if (!find_view(call, scene, &index, err)) return false;
    if (call->form == FORM_FORGET) wr_scene_forget_view(scene, index);
    else wr_scene_set_pose(scene, &scene->views[index].view);
    return true;
}

/* ---- moving ---- */

static bool run_kind(const WrCall *call, WrScene *scene)
{
    WrCamera *camera = &scene->camera;
    camera->orthographic = call->form == FORM_ORTHOGRAPHIC;
    if (wr_call_given(call, "eye")) camera->fit = false;
    wr_scene_take(call, wr_camera_names[camera->orthographic], scene);
    return true;
}

static bool run_move(WrCall *call, WrScene *scene, WrError *err)
{
    const double *by;
    switch (call->form) {
    case FORM_FROM:
        wr_camera_control_side(scene, (WrSide)wr_call_choice(call, "SIDE"));
        return true;
    case FORM_ORBIT:
        by = wr_call_arg(call, "right,up")->numbers;
        wr_camera_control_orbit(scene, by[0], by[1]);
        return true;
    case FORM_PAN:
        by = wr_call_arg(call, "right,up")->numbers;
        return wr_camera_control_pan(scene, by[0], by[1], wr_call_number(call, "aspect"), err);
    case FORM_DOLLY:
        return wr_camera_control_dolly(scene, wr_call_number(call, "factor"),
                                       wr_call_number(call, "aspect"), err);
    case FORM_FILL:
        by = wr_call_arg(call, "turn")->numbers;
        return wr_camera_control_fill(scene, wr_call_number(call, "aspect"), by[0], by[1], err);
    case FORM_SAVE: return run_save(call, scene, err);
    case FORM_USE:
    case FORM_FORGET: return run_named(call, scene, err);
    default: return run_kind(call, scene);
    }
}

static bool run_camera(WrSession *session, WrCall *call, WrError *err)
{
    WrPlacement unused;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (!run_move(call, scene, err) || !wr_scene_place(scene, 0, 1, &unused, err)) {
        wr_scene_free(scene);
        return false;
    }
    wr_session_replace_scene(session, scene);
    return true;
}

/* ---- the row ---- */

static WrCommandClass class_of(int form)
{
    return form == FORM_SAVE || form == FORM_FORGET ? WR_CLASS_SCENE : WR_CLASS_VIEW;
}

static const char *side_word(int i)
{
    return i < WR_SIDE_COUNT ? wr_side_names[i] : NULL;
}

static const char *camera_word(int i)
{
    return i < 2 ? wr_camera_names[i] : NULL;
}

#define ASPECT                                                                                     \
    {                                                                                              \
        .name = "aspect", .type = WR_ARG_NUMBER, .low = 1e-4, .high = 1e4, .fallback = NUMBERS(1), \
        .help = "aspect ratio of the picture, width over height"                                   \
    }
#define VIEW_NAME                                                                                  \
    {                                                                                              \
        PLACE("NAME"), .type = WR_ARG_NAME, .help = "name of the view"                             \
    }

WR_ROWS(camera_forms);
static const WrForm camera_forms[] = {
    [WR_ROW(FORM_PERSPECTIVE)] = { .name = "perspective", .help = "perspective projection" },
    [WR_ROW(FORM_ORTHOGRAPHIC)] = { .name = "orthographic", .help = "parallel projection" },
    [WR_ROW(FORM_FROM)] = { .name = "from",
                            .help = "look at one of the six sides, from the present distance; the "
                                    "only object of a scene is turned back to its own axes",
                            .args = { { PLACE("SIDE"), .type = WR_ARG_CHOICE, .choice = side_word,
                                        .help = "front is the world's +z, right its +x, top its "
                                                "+y" } } },
    [WR_ROW(FORM_ORBIT)] = { .name = "orbit",
                             .help = "move the camera around its target",
                             .args = { { PLACE("right,up"), .type = WR_ARG_TUPLE, .components = 2,
                                         .low = -1e9, .high = 1e9, .unit = "degrees",
                                         .help = "angles to the right, about the world's y axis, "
                                                 "and upwards, at most to the pole" } } },
    [WR_ROW(FORM_PAN)] = { .name = "pan",
                           .help = "move the camera and its target sideways; switches fit= off",
                           .args = { { PLACE("right,up"), .type = WR_ARG_TUPLE, .components = 2,
                                       .low = -1e6, .high = 1e6,
                                       .help = "distances to the right and upwards, in picture "
                                               "heights at the target" },
                                     ASPECT } },
    [WR_ROW(FORM_DOLLY)] = { .name = "dolly",
                             .help =
                                 "move the camera towards its target or away; switches fit= off",
                             .args = { { PLACE("factor"), .type = WR_ARG_NUMBER, .low = 1e-6,
                                         .high = 1e6,
                                         .help = "factor of the distance, or of the view's height "
                                                 "if orthographic" },
                                       ASPECT } },
    [WR_ROW(FORM_FILL)] = { .name = "fill",
                            .help =
                                "move the camera along its view until the objects fill the picture",
                            .args = { ASPECT,
                                      { .name = "turn",
                                        .type = WR_ARG_TUPLE,
                                        .components = 2,
                                        .shape = "from,to",
                                        .low = -1e9,
                                        .high = 1e9,
                                        .fallback = NUMBERS(0, 0),
                                        .unit = "degrees",
                                        .help = "turn of the turntable, in degrees: everything it "
                                                "shows within that turn fits" } } },
    [WR_ROW(FORM_SAVE)] = { .name = "save", .help = "save the present view under a name" },
    [WR_ROW(FORM_USE)] = { .name = "use", .help = "go to a saved view", .args = { VIEW_NAME } },
    [WR_ROW(
        FORM_FORGET)] = { .name = "forget", .help = "delete a saved view", .args = { VIEW_NAME } },
};
WR_ROWS_END(camera_forms, CAMERA_FORMS);

static bool form_camera(int i, WrForm *out)
{
    static const WrArgSpec name = VIEW_NAME;
    static const WrArgSpec kind = {
        .name = "kind", .type = WR_ARG_CHOICE, .choice = camera_word, .help = "projection"
    };
    static const WrArgSpec turn = { .name = "turn",
                                    .type = WR_ARG_TEXT,
                                    .shape = "x,y,z or " OWN,
                                    .help = "rotation of the scene's only object, as in `rotate`" };
    if (i >= CAMERA_FORMS) return false;
    *out = camera_forms[i];
    if (i <= FORM_ORTHOGRAPHIC) return wr_scene_args("camera", out->name, out->args) > 0;
    if (i != FORM_SAVE) return true;
    out->args[0] = name, out->args[1] = kind;
    const int count = 2 + wr_scene_args("camera", NULL, out->args + 2);
    out->args[count] = turn;
    return true;
}

const WrCommand wr_command_camera = {
    .name = "camera",
    .kind = WR_CLASS_VIEW,
    .class_of = class_of,
    .form_word = "KIND",
    .form = form_camera,
    .run = run_camera,
    .print = print_all,
    .help = "set the camera",
    .details =
        "Only given arguments change. Moving the camera is not an edit: undo does not change it, "
        "`view back` goes back. Saving or forgetting a view is an edit, stored in the document. "
        "With fit=on everything stays in the picture however it turns. `camera fill` leaves a "
        "margin of at most 2 %; pictures narrower than its aspect= still show all of it (frame=).",
    .example = "camera perspective eye=0,1,4 fov=30"
};
