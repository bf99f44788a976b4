/* material, colour, light, camera, dials, tolerance. */
#include "command/inner.h"

#include "base/memory.h"

#include <string.h>

/* Where the line gives a value, take it. */
static void take_number(const WrCall *call, const char *name, double *value)
{
    if (wr_call_given(call, name)) *value = wr_call_number(call, name);
}

static void take_vec3(const WrCall *call, const char *name, WrVec3 *value)
{
    if (wr_call_given(call, name)) *value = wr_call_vec3(call, name);
}

bool wr_run_material(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrMaterial *m = &scene->material;
    take_number(call, "ambient", &m->ambient);
    take_number(call, "diffuse", &m->diffuse);
    take_number(call, "specular", &m->specular);
    take_number(call, "shininess", &m->shininess);
    take_vec3(call, "colour", &m->colour);
    if (wr_call_given(call, "gate")) m->gate = wr_call_choice(call, "gate") == 1;
    wr_session_replace_scene(session, scene);
    return true;
}

/* ---- colour ---- */

/* Linear RGB, or grey as one channel, without alpha; codes of 8 and 16 bits are decoded from sRGB. */
static WrImage *linear_colour(const WrImage *from, WrError *err)
{
    int channels = from->channels < 3 ? 1 : 3;
    WrImage *to = wr_image_new(from->width, from->height, channels, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    size_t pixels = (size_t)from->width * (size_t)from->height;
    bool decode = from->type != WR_PIXEL_F32;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < channels; c++) {
            float x = from->data[i * (size_t)from->channels + (size_t)c];
            if (decode) x = wr_srgb_decode(x);
            to->data[i * (size_t)channels + (size_t)c] = x > 0 ? x : 0;
        }
    return to;
}

/* The picture of a colour line: inside a document it is the one that the document carries. */
static bool find_colour(WrSession *session, WrCall *call, const char *name, WrImage **colour,
                        WrError *err)
{
    if (session->loading) {
        *colour = session->embedded ? linear_colour(session->embedded, err) : NULL;
        if (!session->embedded)
            return wr_fail(err, "the document names the picture %s but does not hold it", name);
        return *colour != NULL;
    }
    WrImage *image = wr_session_read_image(session, call, name, err);
    if (!image) return false;
    *colour = linear_colour(image, err);
    wr_image_free(image);
    return *colour != NULL;
}

bool wr_run_colour(WrSession *session, WrCall *call, WrError *err)
{
    const char *name = wr_call_arg(call, "FILE|off")->text;
    bool off = strcmp(name, "off") == 0;
    WrImage *colour = NULL;
    if (off && wr_call_given(call, "sha256")) return wr_fail(err, "off takes no sha256=");
    if (!off && !find_colour(session, call, name, &colour, err)) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_image_free(scene->colour);
    wr_free(scene->colour_path);
    scene->colour = colour;
    scene->colour_path = off ? NULL : wr_strdup(name);
    memset(scene->colour_sha256, 0, sizeof scene->colour_sha256);
    const char *hex = wr_call_arg(call, "sha256")->text;
    if (hex) memcpy(scene->colour_sha256, hex, 64);
    wr_session_replace_scene(session, scene);
    return true;
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

bool wr_run_light(WrSession *session, WrCall *call, WrError *err)
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

bool wr_run_camera(WrSession *session, WrCall *call, WrError *err)
{
    WrPlacement unused;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrCamera *camera = &scene->camera;
    camera->orthographic = strcmp(call->form_name, "orthographic") == 0;
    take_vec3(call, "eye", &camera->eye);
    take_vec3(call, "target", &camera->target);
    take_vec3(call, "up", &camera->up);
    if (camera->orthographic) take_number(call, "size", &camera->size);
    else take_number(call, "fov", &camera->fov_deg);
    if (wr_call_given(call, "eye")) camera->fit = false;
    if (wr_call_given(call, "fit")) camera->fit = wr_call_choice(call, "fit") == 1;
    if (!wr_scene_place(scene, 0, 1, &unused, err)) {
        wr_scene_free(scene);
        return false;
    }
    wr_session_replace_scene(session, scene);
    return true;
}

bool wr_run_dials(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    for (int i = 0; i < WR_DIAL_COUNT; i++) {
        const WrDial *dial = &wr_dials[i];
        if (strcmp(dial->command, "dials") != 0 || !wr_call_given(call, dial->name)) continue;
        dial->set(scene, dial->choices > 0 ? wr_call_choice(call, dial->name)
                                           : wr_call_number(call, dial->name));
    }
    wr_session_replace_scene(session, scene);
    return true;
}

/* ---- tolerance ---- */

bool wr_duration_parse(const char *text, double *seconds)
{
    const size_t length = strlen(text);
    const bool ms = length > 2 && strcmp(text + length - 2, "ms") == 0;
    const bool s = !ms && length > 1 && text[length - 1] == 's';
    double value;
    if (!wr_number_parse(text, length - (ms ? 2 : s ? 1 : 0), &value)) return false;
    value *= ms ? 1e-3 : 1;
    if (!(value >= 1e-4 && value <= 3600)) return false;
    *seconds = value;
    return true;
}

bool wr_check_duration(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    double seconds;
    if (wr_duration_parse(value, &seconds)) return true;
    return wr_fail(err, "%s=%.40s: must be a time such as 8ms or 0.5s, 0.1ms to 3600s", name,
                   value);
}

bool wr_check_chosen(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    if (wr_choice_check(value, err)) return true;
    wr_error_prefix(err, "%s: ", name);
    return false;
}

bool wr_run_tolerance(WrSession *session, WrCall *call, WrError *err)
{
    static const char *const names[] = { "off", "rms", "max", "time" };
    WrTolerance tolerance = { WR_TOLERANCE_NONE, 0 };
    int given = 0;
    for (int i = 0; i < WR_TOLERANCE_COUNT; i++) {
        if (!wr_call_given(call, names[i])) continue;
        given++;
        tolerance.kind = (WrToleranceKind)i;
        if (i == WR_TOLERANCE_TIME)
            wr_duration_parse(wr_call_arg(call, "time")->text, &tolerance.value);
        else if (i != WR_TOLERANCE_NONE) tolerance.value = wr_call_number(call, names[i]);
    }
    if (given != 1)
        return wr_fail(err, "tolerance: needs one of off, rms=, max= and time=, %s given",
                       given == 0 ? "none is" : "several are");
    const bool chosen = wr_call_given(call, "chosen");
    if (chosen && tolerance.kind == WR_TOLERANCE_NONE)
        return wr_fail(err, "tolerance: off and chosen= do not go together: without a tolerance "
                            "the dials hold as they are set");
    wr_session_keep_chosen(session, chosen ? wr_call_arg(call, "chosen")->text : NULL);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->tolerance = tolerance;
    wr_session_replace_scene(session, scene);
    return true;
}
