/* Lights and the camera. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/scene.h"

#include <string.h>

static void print_light(const WrScene *scene, WrText *text)
{
    if (scene->lights_given && scene->light_count == 0) wr_text_add(text, "light clear\n");
    for (int i = 0; scene->lights_given && i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        bool point = light->kind == WR_LIGHT_POINT;
        wr_text_addf(text, "light %s", point ? "point" : "directional");
        wr_print_named_vec3(text, point ? "at" : "to", light->where);
        wr_print_named_vec3(text, "colour", light->colour);
        wr_print_named(text, "strength", light->strength);
        wr_text_add(text, "\n");
    }
}

/* The number of the other kind of camera is kept too, by a line of its own before. */
void wr_print_camera(const WrScene *scene, WrText *text)
{
    const WrCamera *camera = &scene->camera;
    wr_text_addf(text, "camera %s", wr_camera_kind_name(camera->orthographic ? 0 : 1));
    wr_print_named(text, camera->orthographic ? "fov" : "size",
                   camera->orthographic ? camera->fov_deg : camera->size);
    wr_text_addf(text, "\ncamera %s", wr_camera_kind_name(camera->orthographic ? 1 : 0));
    wr_print_named_vec3(text, "eye", camera->eye);
    wr_print_named_vec3(text, "target", camera->target);
    wr_print_named_vec3(text, "up", camera->up);
    wr_text_addf(text, " fit=%s", camera->fit ? "on" : "off");
    wr_print_named(text, camera->orthographic ? "size" : "fov",
                   camera->orthographic ? camera->size : camera->fov_deg);
    wr_text_add(text, "\n");
}

/* ---- lights ---- */

static bool put_light(WrScene *scene, WrLight light, int index, WrError *err)
{
    if (index > scene->light_count)
        return wr_fail(err, "index=%d: there %s %d", index,
                       scene->light_count == 1 ? "is only light" : "are only lights up to",
                       scene->light_count);
    if (index == 0 && !scene->lights_given) scene->light_count = 0; /* the default light goes */
    if (index == 0 && scene->light_count == WR_LIGHTS_MAX)
        return wr_fail(err, "a scene holds at most %d lights", WR_LIGHTS_MAX);
    if (index == 0) {
        size_t count = (size_t)scene->light_count;
        scene->lights = wr_realloc(scene->lights, count, count + 1, sizeof *scene->lights);
        index = ++scene->light_count;
    }
    scene->lights[index - 1] = light;
    return true;
}

static bool run_light(WrSession *session, WrCall *call, WrError *err)
{
    bool clear = strcmp(call->form_name, "clear") == 0, good = true;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (clear) {
        scene->light_count = 0;
    } else {
        bool point = strcmp(call->form_name, "point") == 0;
        WrLight light = { .kind = point ? WR_LIGHT_POINT : WR_LIGHT_DIRECTIONAL,
                          .where = wr_call_vec3(call, point ? "at" : "to"),
                          .colour = wr_call_vec3(call, "colour"),
                          .strength = wr_call_number(call, "strength") };
        bool zero = light.where.x == 0 && light.where.y == 0 && light.where.z == 0;
        int index = wr_call_given(call, "index") ? (int)wr_call_number(call, "index") : 0;
        if (!point && zero)
            good = wr_fail(err, "to=0,0,0 points nowhere: one number must not be 0");
        else good = put_light(scene, light, index, err);
    }
    if (!good) {
        wr_scene_free(scene);
        return false;
    }
    scene->lights_given = true;
    wr_session_replace_scene(session, scene);
    return true;
}

/* ---- camera and dials ---- */

static bool run_camera(WrSession *session, WrCall *call, WrError *err)
{
    WrPlacement unused;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrCamera *camera = &scene->camera;
    camera->orthographic = strcmp(call->form_name, "orthographic") == 0;
    wr_call_take_vec3(call, "eye", &camera->eye);
    wr_call_take_vec3(call, "target", &camera->target);
    wr_call_take_vec3(call, "up", &camera->up);
    if (camera->orthographic) wr_call_take_number(call, "size", &camera->size);
    else wr_call_take_number(call, "fov", &camera->fov_deg);
    if (wr_call_given(call, "eye")) camera->fit = false;
    if (wr_call_given(call, "fit")) camera->fit = wr_call_choice(call, "fit") == 1;
    if (!wr_scene_place(scene, 0, 1, &unused, err)) {
        wr_scene_free(scene);
        return false;
    }
    wr_session_replace_scene(session, scene);
    return true;
}

#define LIGHT_ARGS                                                                                 \
    { .name = "colour",                                                                            \
      .type = WR_ARG_TUPLE,                                                                        \
      .components = 3,                                                                             \
      .low = 0,                                                                                    \
      .high = 1e6,                                                                                 \
      .shape = "r,g,b",                                                                            \
      .fallback = NUMBERS(1, 1, 1),                                                                \
      .help = "linear" },                                                                          \
        { .name = "strength",                                                                      \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1e6,                                                                             \
          .fallback = NUMBERS(1),                                                                  \
          .help = "times the colour" },                                                            \
    {                                                                                              \
        .name = "index", .type = WR_ARG_NUMBER, .low = 1, .high = WR_LIGHTS_MAX, .whole = true,    \
        .help = "replace this light, the first is 1; without it one is added"                      \
    }

static const WrForm light_forms[] = {
    { .name = "directional",
      .help = "light from far away",
      .args = { { .name = "to",
                  .type = WR_ARG_TUPLE,
                  .required = true,
                  .components = 3,
                  .low = -1e9,
                  .high = 1e9,
                  .help = "from the surface to the light, any length" },
                LIGHT_ARGS } },
    { .name = "point",
      .help = "light from a point",
      .args = { { .name = "at",
                  .type = WR_ARG_TUPLE,
                  .required = true,
                  .components = 3,
                  .low = -1e9,
                  .high = 1e9,
                  .unit = "scene units",
                  .help = "where it stands" },
                LIGHT_ARGS } },
    { .name = "clear", .help = "no light at all" },
};

WR_FORMS(form_light, light_forms)

const char *wr_camera_kind_name(int i)
{
    return i == 0 ? "perspective" : i == 1 ? "orthographic" : NULL;
}

#define CAMERA_ARGS                                                                                \
    { .name = "eye",                                                                               \
      .type = WR_ARG_TUPLE,                                                                        \
      .components = 3,                                                                             \
      .low = -1e9,                                                                                 \
      .high = 1e9,                                                                                 \
      .unit = "scene units",                                                                       \
      .help = "where the camera stands" },                                                         \
        { .name = "target",                                                                        \
          .type = WR_ARG_TUPLE,                                                                    \
          .components = 3,                                                                         \
          .low = -1e9,                                                                             \
          .high = 1e9,                                                                             \
          .unit = "scene units",                                                                   \
          .help = "what it looks at" },                                                            \
        { .name = "up",                                                                            \
          .type = WR_ARG_TUPLE,                                                                    \
          .components = 3,                                                                         \
          .low = -1e9,                                                                             \
          .high = 1e9,                                                                             \
          .help = "what is up in the picture" },                                                   \
    {                                                                                              \
        .name = "fit", .type = WR_ARG_CHOICE, .words = wr_off_on,                                  \
        .help =                                                                                    \
            "on: stand so far from the target, towards the eye, that the object just fits; eye= "  \
            "turns it off"                                                                         \
    }

static const WrForm camera_forms[] = {
    { .name = "perspective",
      .help = "nearer is larger",
      .args = { CAMERA_ARGS,
                { .name = "fov",
                  .type = WR_ARG_NUMBER,
                  .low = 0.01,
                  .high = 179,
                  .unit = "degrees",
                  .help = "angle of view from bottom to top" } } },
    { .name = "orthographic",
      .help = "all distances alike",
      .args = { CAMERA_ARGS,
                { .name = "size",
                  .type = WR_ARG_NUMBER,
                  .low = 0,
                  .high = 1e9,
                  .unit = "scene units",
                  .help = "height of the view; 0: so that the object just fits" } } },
};

WR_FORMS(form_camera, camera_forms)

/* ---- the rows ---- */

const WrCommand wr_command_light = {
    .name = "light",
    .kind = WR_CLASS_SCENE,
    .form_word = "KIND",
    .form = form_light,
    .run = run_light,
    .print = print_light,
    .help = "add, replace or remove lights",
    .details = "The first light takes the place of the one that a new document has.",
    .example = "light directional to=-1,1,2 strength=0.9"
};

const WrCommand wr_command_camera = {
    .name = "camera",
    .kind = WR_CLASS_VIEW,
    .form_word = "KIND",
    .form = form_camera,
    .run = run_camera,
    .print = wr_print_camera,
    .help = "where the picture is taken from",
    .details = "Only what is given changes. A view is no edit: undo leaves it as it is, `view "
               "back` goes back.",
    .example = "camera perspective eye=0,1,4 fov=30"
};
