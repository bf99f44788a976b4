/* The command environment: image-based lighting. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "document/document_file.h"
#include "image/image.h"
#include "scene/param.h"
#include "scene/scene.h"

#include <string.h>

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

static void note_told(WrSession *session, const char *name, const WrEnvironmentMapTold *told)
{
    if (told->lost)
        wr_session_note(session, "%s: %lld numbers that are none became 0", name,
                        (long long)told->lost);
    if (told->below)
        wr_session_note(session, "%s: %lld numbers below 0 became 0", name, (long long)told->below);
    if (told->above)
        wr_session_note(session, "%s: %lld numbers beyond 1e9 became 1e9", name,
                        (long long)told->above);
    if (told->reduced > 1)
        wr_session_note(session, "%s: more than %d texels wide: each is the mean of %d x %d", name,
                        WR_ENVIRONMENT_MAP_WIDTH, told->reduced, told->reduced);
}

/* While a document loads, its embedded picture, else the file's. The caller frees it. */
static WrImage *find_picture(WrSession *session, WrCall *call, const char *name, WrError *err)
{
    if (session->loading) {
        const WrImage *held = session->embedded ? session->embedded[0][WR_OBJECT_SURROUND] : NULL;
        if (held) return wr_image_share(held);
        wr_fail(err, "the document names the picture %s but does not hold it", name);
        return NULL;
    }
    char *path = wr_session_input_path(session, name);
    WrImageRequest wish = wr_call_request(call);
    wish.keep_lost = true;
    WrImage *image = NULL;
    if (wr_session_check_sha256(call, path, err)) image = wr_image_read_wish(path, &wish, err);
    if (image) wr_session_note_read(session, path, image);
    wr_free(path);
    return image;
}

static WrEnvironmentMap *read_file(WrSession *session, WrCall *call, const char *name, WrError *err)
{
    WrEnvironmentMapTold told;
    WrImage *image = find_picture(session, call, name, err);
    if (!image) return NULL;
    WrEnvironmentMap *light = wr_environment_map_new(image, &told, err);
    wr_image_free(image);
    if (light) note_told(session, name, &told);
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
        return wr_fail(err, "there are no surroundings: name some");
    for (int i = 0; i < 3; i++)
        if (kind != WR_ENVIRONMENT_MAP_FILE && wr_call_given(call, of_file[i]))
            return wr_fail(err, "only a line that names a file takes %s=", of_file[i]);
    for (int i = 0; i < 2; i++)
        if (name && kind == WR_ENVIRONMENT_MAP_OFF && wr_call_given(call, of_light[i]))
            return wr_fail(err, "off takes no %s=", of_light[i]);
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

static const WrArgSpec args_file[] = { WR_ARGS_OF_FILE,
                                       { .name = "sha256",
                                         .type = WR_ARG_SHA256,
                                         .help = "of the file: another content is then an error" },
                                       { 0 } };

static bool row_environment(WrForm *out)
{
    *out = (WrForm){ .args = { { .name = "FILE|SET|off",
                                 .type = WR_ARG_PATH,
                                 .positional = true,
                                 .words = set_words,
                                 .help =
                                     "a picture by longitude and latitude, or " WR_ENVIRONMENT_SETS(
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
    .help = "surroundings that light the objects from all sides",
    .details =
        "Beside the lights; `light clear` leaves them alone. A picture is twice as wide as high, "
        "its middle is -z, its upper border straight up; float ones (EXR, HDR) are taken as "
        "linear, 8-bit and 16-bit ones decoded from sRGB. Diffuse light of them is by spherical "
        "harmonics of order 2. The picture is saved inside the document. Only what is given "
        "changes.",
    .example = "environment sky turn=30 strength=0.8"
};
