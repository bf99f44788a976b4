/* The command light. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "scene/param.h"
#include "scene/scene.h"

static void print_light(const WrScene *scene, WrText *text)
{
    if (scene->lights_given && scene->light_count == 0) wr_text_add(text, "light clear\n");
    for (int i = 0; scene->lights_given && i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        const char *form = wr_light_kinds[light->kind].name;
        wr_text_addf(text, "light %s", form);
        wr_scene_print_params("light", form, light, text);
        wr_text_add(text, "\n");
    }
}

/* ---- lights ---- */

static bool put_light(WrScene *scene, WrLight light, int index, WrError *err)
{
    if (index > scene->light_count)
        return wr_fail(err, "index=%d: there %s %d", index,
                       scene->light_count == 1 ? "is only light" : "are only lights up to",
                       scene->light_count);
    if (index == 0 && !scene->lights_given) scene->light_count = 0; /* remove the default light */
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
    const bool clear = call->form >= WR_LIGHT_KINDS;
    bool good = true;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (clear) {
        scene->light_count = 0;
    } else {
        WrLight light = { .kind = (WrLightKind)call->form };
        wr_scene_take(call, wr_light_kinds[light.kind].name, &light);
        const bool zero = light.where.x == 0 && light.where.y == 0 && light.where.z == 0;
        int index = wr_call_given(call, "index") ? (int)wr_call_number(call, "index") : 0;
        if (!wr_light_kinds[light.kind].placed && zero)
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

/* One form for each kind of light, and one for none. */
static bool form_light(int i, WrForm *out)
{
    if (i > WR_LIGHT_KINDS) return false;
    if (i == WR_LIGHT_KINDS) {
        *out = (WrForm){ .name = "clear", .help = "no light at all" };
        return true;
    }
    *out = (WrForm){ .name = wr_light_kinds[i].name, .help = wr_light_kinds[i].help };
    const int count = wr_scene_args("light", out->name, out->args);
    out->args[count] =
        (WrArgSpec){ .name = "index",
                     .type = WR_ARG_NUMBER,
                     .low = 1,
                     .high = WR_LIGHTS_MAX,
                     .whole = true,
                     .help = "replace this light, the first is 1; without it one is added" };
    return true;
}

/* ---- the row ---- */

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
