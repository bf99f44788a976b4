/* The command ground: a floor below the objects; an ordinary object of the scene that does not turn with the
   others. */
#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/camera_control.h"
#include "scene/objects.h"
#include "surface/surface.h"

#define GROUND "ground"
#define WIDE 12.0 /* times the radius of the objects on it */
#define ENDLESS 2 /* index of a plane parameter */

enum { FORM_ON, FORM_OFF, GROUND_FORMS };

/* A flat, matt plane with its normal up. It has no table, so that painting on other objects does not show on it. */
static WrScene *new_ground(const WrScene *scene)
{
    WrScene *made = wr_scene_add_object(scene, false);
    wr_free(made->name);
    made->name = wr_strdup(GROUND);
    made->still = true;
    made->posed = true;
    made->rotate_deg = (WrVec3){ -90, 0, 0 };
    made->bump = WR_BUMP_NONE;
    made->material.specular = 0;
    made->shape.value[ENDLESS] = 1;
    made->material.colour = (WrVec3){ 0.4, 0.4, 0.4 };
    made->size = WIDE * wr_scene_ball(scene, false);
    return made;
}

/* Prints nothing: the object's own lines hold the result. */
static void print_nothing(const WrScene *scene, WrText *text)
{
    (void)scene;
    (void)text;
}

/* Set whether the floor reaches the horizon. A new floor with a size ends there. */
static bool set_end(const WrCall *call, bool fresh, WrScene *made, WrError *err)
{
    double *endless = &made->shape.value[ENDLESS];
    if (!wr_call_given(call, "endless")) {
        if (fresh && wr_call_given(call, "size")) *endless = 0;
        return true;
    }
    if (made->shape.kind != WR_SURFACE_plane)
        return wr_fail(err, "endless=: the ground is a %s by now; only a plane has a horizon",
                       wr_surfaces[made->shape.kind]->name);
    *endless = wr_call_choice(call, "endless");
    return true;
}

static bool run_on(const WrCall *call, const WrScene *scene, int index, WrScene **out, WrError *err)
{
    double height;
    if (wr_call_given(call, "height")) height = wr_call_number(call, "height");
    else if (!wr_camera_control_lowest(scene, &height, err)) return false;
    WrScene *made = index < 0 ? new_ground(scene) : wr_scene_choose(scene, index);
    made->at.y = height;
    made->hidden = false;
    if (wr_call_given(call, "size")) made->size = wr_call_number(call, "size");
    if (!set_end(call, index < 0, made, err)) {
        wr_scene_free(made);
        return false;
    }
    if (wr_call_given(call, "colour")) {
        const double *rgb = wr_call_arg(call, "colour")->numbers;
        made->material.colour = (WrVec3){ rgb[0], rgb[1], rgb[2] };
    }
    *out = wr_scene_choose(made, scene->chosen);
    wr_scene_free(made);
    return true;
}

static bool run_ground(WrSession *session, WrCall *call, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    const int index = wr_scene_object_find(scene, GROUND);
    WrScene *made;
    if (index >= 0 && !wr_scene_object(scene, index)->still)
        return wr_fail(err, "an object is called \"" GROUND "\" and turns with the others: `object "
                            "choose " GROUND "`, then `object set name=` gives it another name");
    if (call->form == FORM_ON) {
        if (index < 0 && wr_scene_object_count(scene) == WR_OBJECTS_MAX)
            return wr_fail(err, "a scene holds at most %d objects", WR_OBJECTS_MAX);
        if (!run_on(call, scene, index, &made, err)) return false;
    } else {
        if (index < 0) return wr_fail(err, "there is no ground: `ground on` lays one");
        if (wr_scene_object_count(scene) == 1)
            return wr_fail(err, "the last object stays: a scene has at least one");
        made = wr_scene_remove_object(scene, index);
    }
    wr_session_replace_scene(session, made);
    return true;
}

WR_ROWS(ground_forms);
static const WrForm ground_forms[] = {
    [WR_ROW(FORM_ON)] = { .name = "on",
                          .help = "lay it, or lay it anew",
                          .args = { { .name = "height",
                                      .type = WR_ARG_NUMBER,
                                      .low = -1e9,
                                      .high = 1e9,
                                      .unit = "scene units",
                                      .help = "its y; left out: where the lowest of the objects "
                                              "that are shown stands now" },
                                    { .name = "size",
                                      .type = WR_ARG_NUMBER,
                                      .low = 1e-9,
                                      .high = 1e9,
                                      .unit = "scene units",
                                      .help = "of its sides; left out: as it is, at first 12 times "
                                              "what stands on it" },
                                    { .name = "colour",
                                      .type = WR_ARG_TUPLE,
                                      .components = 3,
                                      .shape = "r,g,b",
                                      .high = 1e6,
                                      .help = "linear; left out: as it is" },
                                    { .name = "endless",
                                      .type = WR_ARG_CHOICE,
                                      .words = wr_off_on,
                                      .help = "it goes on to the horizon, where it fades; left "
                                              "out: as it is, at first on "
                                              "unless size= is given" } } },
    [WR_ROW(FORM_OFF)] = { .name = "off", .help = "take it away" },
};
WR_ROWS_END(ground_forms, GROUND_FORMS);

WR_FORMS(form_ground, ground_forms)

const WrCommand wr_command_ground = {
    .name = "ground",
    .kind = WR_CLASS_SCENE,
    .form_word = "WHAT",
    .form = form_ground,
    .run = run_ground,
    .print = print_nothing,
    .help = "a floor under the objects",
    .details = "It is an object of the name " GROUND
               ": a plane that looks up, goes on to the horizon and stands still "
               "(`object set still=on`) while the turntable turns the others. The chosen object "
               "stays the chosen one; choose the ground to give it a surface or bumps of its own. "
               "Seen from below a plane that stands still is left out of the picture.",
    .example = "ground on colour=0.3,0.25,0.2"
};
