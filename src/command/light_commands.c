/* Commands for light in the scene: light, environment, background, tone. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "document/document_file.h"
#include "image/image.h"
#include "scene/light_preset.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

/* ---- The command light ---- */

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

enum { LIGHT_CLEAR = WR_LIGHT_KINDS, LIGHT_PRESET, LIGHT_FORMS };

static bool run_light(WrSession *session, WrCall *call, WrError *err)
{
    const bool clear = call->form == LIGHT_CLEAR;
    bool good = true;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (clear) {
        scene->light_count = 0;
    } else if (call->form == LIGHT_PRESET) {
        good = wr_light_preset_apply(&wr_light_presets[wr_call_choice(call, "NAME")], scene, err);
    } else {
        WrLight light = { .kind = (WrLightKind)call->form };
        wr_scene_take(call, wr_light_kinds[light.kind].name, &light);
        const bool zero = light.where.x == 0 && light.where.y == 0 && light.where.z == 0;
        int index = wr_call_given(call, "index") ? (int)wr_call_number(call, "index") : 0;
        if (!wr_light_kinds[light.kind].placed && zero)
            good = wr_fail(err, "to=0,0,0: has no direction; one number must not be 0");
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

static const char *light_preset_name(int i)
{
    return i < WR_LIGHT_PRESETS ? wr_light_presets[i].name : NULL;
}

/* One form for each kind of light, one for none, and one for presets. */
static bool form_light(int i, WrForm *out)
{
    if (i >= LIGHT_FORMS) return false;
    if (i == LIGHT_CLEAR) {
        *out = (WrForm){ .name = "clear", .help = "remove all lights" };
        return true;
    }
    if (i == LIGHT_PRESET) {
        *out =
            (WrForm){ .name = "preset",
                      .help = "a preset of lights and environment, which replaces the present ones",
                      .args = { { .name = "NAME",
                                  .type = WR_ARG_CHOICE,
                                  .positional = true,
                                  .required = true,
                                  .choice = light_preset_name,
                                  .help = "name of the preset" } } };
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
                     .help = "number of the light to replace, from 1; left out, a light is added" };
    return true;
}

/* ---- the row ---- */

const WrCommand wr_command_light = { .name = "light",
                                     .kind = WR_CLASS_SCENE,
                                     .form_word = "KIND",
                                     .form = form_light,
                                     .run = run_light,
                                     .print = print_light,
                                     .help = "add, replace or remove lights",
                                     .details = "The first light replaces that of a new document.",
                                     .example = "light directional to=-1,1,2 strength=0.9" };

/* ---- The command environment: image-based lighting ---- */

#define WORD(KIND, word, label, light) word,
#define LISTED(KIND, word, label, light) word ", "
static const char *const set_words[] = { "off", WR_ENVIRONMENT_SETS(WORD) NULL };

static void print_environment_line(const WrScene *scene, bool named, WrText *text)
{
    const WrEnvironment *own = &scene->environment;
    if (own->kind == WR_ENVIRONMENT_MAP_OFF) return;
    wr_text_add(text, "environment");
    if (own->kind != WR_ENVIRONMENT_MAP_FILE)
        wr_text_addf(text, " %s", wr_environment_map_names[own->kind]);
    else if (named) wr_text_add(text, " "), wr_text_add_word(text, own->path);
    wr_print_word("channel", own->channel, text);
    wr_print_word("part", own->part, text);
    if (*own->sha256) wr_text_addf(text, " sha256=%s", own->sha256);
    wr_scene_print_params("environment", NULL, scene, text);
    wr_text_add(text, "\n");
}

static void print_environment(const WrScene *scene, WrText *text)
{
    print_environment_line(scene, true, text);
}

static void print_environment_content(const WrScene *scene, WrText *text)
{
    print_environment_line(scene, !*scene->environment.sha256, text);
}

static void note_changes(WrSession *session, const char *name,
                         const WrEnvironmentMapChanges *changes)
{
    if (changes->not_numbers)
        wr_session_note(session, "%s: %lld values were not numbers and became 0", name,
                        (long long)changes->not_numbers);
    if (changes->negative)
        wr_session_note(session, "%s: %lld values below 0 became 0", name,
                        (long long)changes->negative);
    if (changes->too_large)
        wr_session_note(session, "%s: %lld values above 1e9 became 1e9", name,
                        (long long)changes->too_large);
    if (changes->reduced > 1)
        wr_session_note(session, "%s: more than %d texels wide: each is the mean of %d x %d", name,
                        WR_ENVIRONMENT_MAP_WIDTH, changes->reduced, changes->reduced);
}

/* While a document loads, its embedded picture, else the file's. The caller frees it. */
static WrImage *find_picture(WrSession *session, WrCall *call, const char *name, WrError *err)
{
    if (session->loading) {
        const WrImage *held = session->embedded ? session->embedded[0][WR_OBJECT_SURROUND] : NULL;
        if (held) return wr_image_share(held);
        wr_fail(err, "the document refers to the picture %s but does not contain it", name);
        return NULL;
    }
    char *path = wr_session_input_path(session, name);
    WrImageRequest wish = wr_call_request(call);
    wish.keep_lost = true;
    WrImage *image = NULL;
    if (wr_session_check_sha256(call, path, err)) image = wr_image_read_request(path, &wish, err);
    if (image) wr_session_note_read(session, path, image);
    wr_free(path);
    return image;
}

static WrEnvironmentMap *read_file(WrSession *session, WrCall *call, const char *name, WrError *err)
{
    WrEnvironmentMapChanges changes;
    WrImage *image = find_picture(session, call, name, err);
    if (!image) return NULL;
    WrEnvironmentMap *light = wr_environment_map_new(image, &changes, err);
    wr_image_free(image);
    if (light) note_changes(session, name, &changes);
    return light;
}

static WrEnvironmentMapKind kind_of(const char *name)
{
    for (int i = 0; set_words[i]; i++)
        if (strcmp(name, set_words[i]) == 0) return (WrEnvironmentMapKind)i;
    return WR_ENVIRONMENT_MAP_FILE;
}

static bool take_light(WrSession *session, WrCall *call, const char *name, WrEnvironment *to,
                       WrError *err)
{
    const WrEnvironmentMapKind kind = kind_of(name);
    const bool file = kind == WR_ENVIRONMENT_MAP_FILE;
    WrEnvironmentMap *light = NULL;
    if (file) light = read_file(session, call, name, err);
    else if (kind != WR_ENVIRONMENT_MAP_OFF) light = wr_environment_map_built(kind, err);
    if (!light && kind != WR_ENVIRONMENT_MAP_OFF) return false;
    wr_environment_set(to, kind, light, file ? name : NULL,
                       file ? wr_call_arg(call, "sha256")->text : NULL);
    const WrImageRequest wish = wr_call_request(call);
    if (file) to->channel = wr_strdup(wish.channel), to->part = wr_strdup(wish.part);
    return true;
}

/* File arguments require a file name; `off` accepts no other arguments. */
static bool check_line(const WrCall *call, const WrScene *now, const char *name, WrError *err)
{
    static const char *const of_file[] = { "layer", "part", "sha256" };
    static const char *const of_light[] = { "turn", "strength" };
    const WrEnvironmentMapKind kind = name ? kind_of(name) : WR_ENVIRONMENT_MAP_OFF;
    if (!name && now->environment.kind == WR_ENVIRONMENT_MAP_OFF)
        return wr_fail(err, "no environment is set: name a picture or a built-in one");
    for (int i = 0; i < 3; i++)
        if (kind != WR_ENVIRONMENT_MAP_FILE && wr_call_given(call, of_file[i]))
            return wr_fail(err, "%s= needs a file", of_file[i]);
    for (int i = 0; i < 2; i++)
        if (name && kind == WR_ENVIRONMENT_MAP_OFF && wr_call_given(call, of_light[i]))
            return wr_fail(err, "%s= cannot be given with off", of_light[i]);
    return true;
}

static bool run_environment(WrSession *session, WrCall *call, WrError *err)
{
    const WrScene *now = session->state.document->scene;
    const WrArg *file = wr_call_arg(call, "FILE|SET|off");
    const char *name = file->given ? file->text : NULL;
    if (!check_line(call, now, name, err)) return false;
    WrScene *scene = wr_scene_clone(now);
    if (name && !take_light(session, call, name, &scene->environment, err)) {
        wr_scene_free(scene);
        return false;
    }
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static const WrArgSpec args_file[] = {
    WR_ARGS_OF_FILE,
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the file; a file with other content is an error" },
    { 0 }
};

static bool row_environment(WrForm *out)
{
    *out = (WrForm){ .args = { { .name = "FILE|SET|off",
                                 .type = WR_ARG_PATH,
                                 .positional = true,
                                 .words = set_words,
                                 .help = "an equirectangular picture, or " WR_ENVIRONMENT_SETS(
                                     LISTED) "or off (a file of that name is ./sky). Left out: "
                                             "those that are there" } } };
    return wr_scene_args("environment", NULL, out->args + 1) > 0;
}

const WrCommand wr_command_environment = {
    .name = "environment",
    .kind = WR_CLASS_SCENE,
    .row = row_environment,
    .more = args_file,
    .run = run_environment,
    .print = print_environment,
    .print_content = print_environment_content,
    .help = "set the environment, which lights the objects from all sides",
    .details = "The environment is independent of the lights: `light clear` does not remove it. A "
               "picture is twice as wide as high; its centre is -z, its upper border straight up. "
               "Float pictures (EXR, HDR) are linear, 8-bit and 16-bit ones are decoded from sRGB. "
               "Its diffuse light is computed by spherical harmonics of order 2. The picture is "
               "saved in the document. Only given arguments change.",
    .example = "environment sky turn=30 strength=0.8"
};

/* ---- The command background: the backdrop of the scene ---- */

static void print_kind(WrBackgroundKind kind, const WrScene *scene, WrText *text)
{
    const char *form = wr_background_names[kind];
    wr_text_addf(text, "background %s", form);
    wr_scene_print_params("background", form, scene, text);
    wr_text_add(text, "\n");
}

/* Hidden colours are saved too, by an extra line before; a new document's colours need none. */
static void print_background(const WrScene *scene, WrText *text)
{
    const WrBackground *own = &scene->background;
    const double *usual = wr_scene_params[WR_SCENE_PARAM_BACKGROUND].fallback;
    const bool top = memcmp(own->top, usual, sizeof own->top) != 0,
               bottom = memcmp(own->bottom, usual, sizeof own->bottom) != 0;
    if (bottom || own->kind == WR_BACKGROUND_GRADIENT)
        print_kind(WR_BACKGROUND_GRADIENT, scene, text);
    const bool colourless =
        own->kind == WR_BACKGROUND_NONE || own->kind == WR_BACKGROUND_SURROUNDINGS;
    if (own->kind == WR_BACKGROUND_PLAIN ? top || bottom : top && !bottom && colourless)
        print_kind(WR_BACKGROUND_PLAIN, scene, text);
    if (colourless) print_kind(own->kind, scene, text);
}

static bool run_background(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->background.kind = (WrBackgroundKind)call->form;
    wr_scene_take(call, wr_background_names[call->form], scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool form_background(int i, WrForm *out)
{
    WR_ROWS(help);
    static const char *const help[WR_BACKGROUND_KINDS] = {
        [WR_ROW(WR_BACKGROUND_PLAIN)] = "a plain colour",
        [WR_ROW(WR_BACKGROUND_GRADIENT)] = "a vertical gradient",
        [WR_ROW(WR_BACKGROUND_NONE)] = "transparent in files with alpha, such as PNG",
        [WR_ROW(WR_BACKGROUND_SURROUNDINGS)] = "the environment",
    };
    WR_ROWS_END(help, WR_BACKGROUND_KINDS);
    if (i >= WR_BACKGROUND_KINDS) return false;
    *out = (WrForm){ .name = wr_background_names[i], .help = help[i] };
    wr_scene_args("background", out->name, out->args);
    return true;
}

const WrCommand wr_command_background = {
    .name = "background",
    .kind = WR_CLASS_SCENE,
    .form_word = "KIND",
    .form = form_background,
    .run = run_background,
    .print = print_background,
    .help = "set the background behind the objects",
    .details =
        "Used in the window and in 8-bit pictures; EXR and TIFF files store coverage instead. "
        "Files without alpha, such as JPEG, show the plain colour in place of a transparent "
        "background, and a scene without an environment in place of the environment. An "
        "orthographic camera shows one direction of the environment. Only given arguments change.",
    .example = "background gradient top=0.12,0.16,0.24 bottom=0.5,0.47,0.42"
};

/* ---- The command tone: mapping from light to pixel values ---- */

#define VIEW_OFF "off"

static void print_unless_empty(const char *name, const char *word, WrText *text)
{
    wr_print_word(name, *word ? word : NULL, text);
}

static void print_tone(const WrScene *scene, WrText *text)
{
    const WrTone *tone = &scene->tone;
    if (!tone->view && wr_tone_curve_params(tone).plain) return;
    wr_text_addf(text, "tone %s", wr_tone_names[tone->kind]);
    wr_scene_print_params("tone", NULL, scene, text);
    if (tone->view) {
        const WrDisplayViewNames *names = &tone->view->names;
        wr_print_word("view", names->view, text);
        print_unless_empty("display", names->display, text);
        print_unless_empty("ocio", names->config, text);
        print_unless_empty("space", names->space, text);
    }
    wr_text_add(text, "\n");
}

static const char *tone_word(int i)
{
    return i < WR_TONE_KINDS ? wr_tone_names[i] : NULL;
}

/* Absolute, since the scene may be saved to another folder. "" if not given. The caller frees it. */
static char *config_path(WrSession *session, const char *given)
{
    if (!given) return wr_strdup("");
    char *path = wr_session_input_path(session, given), *real = wr_path_real(path);
    char *kept = wr_strdup(real ? real : path);
    wr_free(path);
    free(real);
    return kept;
}

/* Configurations are parsed outside the sandbox, and documents and scripts may be strangers': those that are only opened
   use the user's own configuration, $OCIO, and no other. */
static const WrDisplayView *view_of_file(WrSession *session, const WrDisplayViewNames *names)
{
    const char *own = getenv("OCIO");
    char *real = own ? wr_path_real(own) : NULL;
    const WrDisplayView *view = NULL;
    WrError why = { 0 };
    if (!*names->config || (real && strcmp(real, names->config) == 0))
        view = wr_display_view_load(names, &why);
    free(real);
    if (view) return view;
    if (*why.text)
        wr_session_note(session, "the view %s is not shown: %s", names->view,
                        wr_error_message(&why));
    else
        wr_session_note(session,
                        "the view %s is not shown: its colour configuration is not "
                        "$OCIO; `tone view=\"%s\" ocio=\"%s\"` shows it",
                        names->view, names->view, names->config);
    return wr_display_view_named(names);
}

/* Sets the view that the call names, if any. */
static bool take_view(WrSession *session, WrCall *call, WrTone *tone, WrError *err)
{
    static const char *const of_view[] = { "display", "ocio", "space" };
    const char *text[3];
    for (int i = 0; i < 3; i++) text[i] = wr_call_arg(call, of_view[i])->text;
    const char *view = wr_call_arg(call, "view")->text;
    const bool off = view && strcmp(view, VIEW_OFF) == 0;
    for (int i = 0; i < 3 && (!view || off); i++)
        if (text[i]) return wr_fail(err, "%s= needs view=NAME", of_view[i]);
    if (!view || off) {
        if (off) tone->view = NULL;
        return true;
    }
    const bool opened = session->loading || session->skip_outputs;
    char *config = config_path(session, text[1]);
    const WrDisplayViewNames names = { config, text[0] ? text[0] : "", view,
                                       text[2] ? text[2] : "" };
    const WrDisplayView *found =
        opened ? view_of_file(session, &names) : wr_display_view_load(&names, err);
    wr_free(config);
    if (found) tone->view = found;
    return found != NULL;
}

static bool run_tone(WrSession *session, WrCall *call, WrError *err)
{
    const WrArg *kind = wr_call_arg(call, "clip|soft");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (!take_view(session, call, &scene->tone, err)) {
        wr_scene_free(scene);
        return false;
    }
    if (kind->given) scene->tone.kind = (WrToneKind)kind->choice;
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool row_tone(WrForm *out)
{
    *out = (WrForm){
        .args = { { .name = "clip|soft",
                    .type = WR_ARG_CHOICE,
                    .positional = true,
                    .choice = tone_word,
                    .help = "clip: light above 1 is white; soft: light above 1/2 is compressed and "
                            "never becomes quite white, so that highlights keep their shape" } }
    };
    return wr_scene_args("tone", NULL, out->args + 1) > 0;
}

static const WrArgSpec args_view[] = {
    { .name = "view",
      .type = WR_ARG_TEXT,
      .shape = "NAME",
      .help = "view of an OpenColorIO configuration, such as Filmic, in place of clip or soft and "
              "sRGB; off: none" },
    { .name = "display",
      .type = WR_ARG_TEXT,
      .shape = "NAME",
      .help = "display of the view; left out, the configuration's default" },
    { .name = "ocio",
      .type = WR_ARG_TEXT,
      .shape = "FILE",
      .help = "configuration file, config.ocio; left out, $OCIO" },
    { .name = "space",
      .type = WR_ARG_TEXT,
      .shape = "NAME",
      .help = "colour space of the rendered light in the configuration; left out, its role "
              "scene_linear" },
    { 0 }
};

const WrCommand wr_command_tone = {
    .name = "tone",
    .kind = WR_CLASS_SCENE,
    .row = row_tone,
    .more = args_view,
    .run = run_tone,
    .print = print_tone,
    .help = "set exposure and tone mapping",
    .details = "Used in the window and in 8-bit pictures; EXR and TIFF files store unchanged "
               "light. The background is tone mapped too. Views never affect heights, normals and "
               "other maps. A document stores the names of its view; when a document or script is "
               "opened, only the configuration in $OCIO is read. Only given arguments change.",
    .example = "tone soft exposure=-0.5"
};
