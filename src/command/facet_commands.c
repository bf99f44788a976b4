/* The commands roughness and metalness: maps that replace the material's numbers. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "command/texture_args.h"
#include "document/document.h"
#include "document/document_file.h"
#include "image/image.h"
#include "scene/scene.h"

#include <string.h>

#define LOOK 16384 /* pixels between two checks for cancellation */

/* Default channel: a glTF picture packs roughness in G and metalness in B; a grey picture has only one. */
static int channel_of(const WrImage *from, WrFacetKind kind, bool asked)
{
    if (asked || from->channels < 3) return 0;
    return kind == WR_FACET_ROUGHNESS ? 1 : 2;
}

/* Channel values 0..1 of the file, without colour conversion. */
static WrImage *numbers_of(const WrImage *from, int channel, WrError *err)
{
    WrImage *to = wr_image_new(from->width, from->height, 1, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    const size_t pixels = (size_t)from->width * (size_t)from->height;
    for (size_t i = 0; i < pixels; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) {
            wr_image_free(to);
            wr_fail(err, "cancelled");
            return NULL;
        }
        const float x = from->data[i * (size_t)from->channels + (size_t)channel];
        to->data[i] = x > 0 ? x < 1 ? x : 1 : 0;
    }
    return to;
}

static const char *const verbs[WR_FACET_KINDS] = { "roughness", "metalness" };

static void print_facets(const WrScene *scene, int kind, bool named, WrText *text)
{
    const WrFacetMap *map = &scene->facets[kind];
    if (!map->image) return;
    wr_text_add(text, verbs[kind]);
    wr_print_laid(&map->laid, named, text);
    wr_text_add(text, "\n");
}

static void print_roughness(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_ROUGHNESS, true, text);
}

static void print_roughness_content(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_ROUGHNESS, !*scene->facets[WR_FACET_ROUGHNESS].laid.sha256, text);
}

static void print_metalness(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_METALNESS, true, text);
}

static void print_metalness_content(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_METALNESS, !*scene->facets[WR_FACET_METALNESS].laid.sha256, text);
}

/* Change the settings of the present picture by a line without a file. */
static bool change(WrSession *session, const WrCall *call, WrFacetKind kind, WrError *err)
{
    static const char *const of_file[] = { "layer", "part", "sha256", NULL };
    const WrScene *now = session->state.document->scene;
    if (!now->facets[kind].image)
        return wr_fail(err, "the object has no picture of %s: name a file", verbs[kind]);
    if (!wr_refuse_without(call, of_file, "only a line that names a file takes", err)) return false;
    WrScene *scene = wr_scene_clone(now);
    wr_take_repeat(call, &scene->facets[kind].laid);
    wr_session_replace_scene(session, scene);
    return true;
}

static WrImage *read_numbers(WrSession *session, WrCall *call, const char *name, WrFacetKind kind,
                             WrError *err)
{
    const int which = kind == WR_FACET_ROUGHNESS ? WR_OBJECT_ROUGHNESS : WR_OBJECT_METALNESS;
    WrImage *file = wr_find_laid(session, call, name, which, err);
    const bool asked = session->loading || wr_call_given(call, "layer");
    WrImage *numbers = file ? numbers_of(file, channel_of(file, kind, asked), err) : NULL;
    wr_image_free(file);
    return numbers;
}

static bool run(WrSession *session, WrCall *call, WrFacetKind kind, WrError *err)
{
    static const char *const of_map[] = { "sha256", "repeat", "layer", "part", NULL };
    const WrArg *file = wr_call_arg(call, "FILE|off");
    const char *name = file->given ? file->text : NULL;
    const bool off = name && strcmp(name, "off") == 0;
    if (!name) return change(session, call, kind, err);
    if (off && !wr_refuse_without(call, of_map, "off takes no", err)) return false;
    WrImage *image = off ? NULL : read_numbers(session, call, name, kind, err);
    if (!off && !image) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrFacetMap *map = &scene->facets[kind];
    wr_image_free(map->image);
    map->image = image;
    wr_take_laid(call, off ? NULL : name, &map->laid);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_roughness(WrSession *session, WrCall *call, WrError *err)
{
    return run(session, call, WR_FACET_ROUGHNESS, err);
}

static bool run_metalness(WrSession *session, WrCall *call, WrError *err)
{
    return run(session, call, WR_FACET_METALNESS, err);
}

static const char *const off_words[] = { "off", NULL };

static const WrArgSpec args[] = {
    { .name = "FILE|off",
      .type = WR_ARG_PATH,
      .positional = true,
      .words = off_words,
      .help = "a picture that is laid over u and v, or off (a file of that name is ./off). Left "
              "out: the one that is there, of which repeat may change" },
    WR_ARGS_REPEAT,
    WR_ARGS_OF_FILE,
    WR_ARGS_SHA256,
    { 0 }
};

const WrCommand wr_command_roughness = {
    .name = "roughness",
    .kind = WR_CLASS_SCENE,
    .args = args,
    .run = run_roughness,
    .print = print_roughness,
    .print_content = print_roughness_content,
    .of_object = true,
    .help = "a picture of how rough the surface is where",
    .details =
        "In the place of the material's roughness, and of a solid texture's. Its numbers are data, "
        "0 smooth and 1 rough, and never colour-converted; of a picture of three channels G is "
        "taken, as glTF packs it, unless channel= says otherwise. Beyond its ends it goes on as "
        "the table does. Under dials aa=filter and aa=moments each pixel has the mean of what it "
        "covers. It is saved inside the document.",
    .example = "roughness worn.png repeat=once"
};

const WrCommand wr_command_metalness = {
    .name = "metalness",
    .kind = WR_CLASS_SCENE,
    .args = args,
    .run = run_metalness,
    .print = print_metalness,
    .print_content = print_metalness_content,
    .of_object = true,
    .help = "a picture of where the surface is of metal",
    .details =
        "In the place of the material's metalness, of model ggx. As roughness, but that of three "
        "channels B is taken: one packed picture of glTF serves both.",
    .example = "metalness worn.png repeat=once"
};
