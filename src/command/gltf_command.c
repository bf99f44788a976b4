/* The command gltf: load the material of a glTF file for the active object. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "image/gltf_material.h"
#include "scene/scene.h"

#include <string.h>

/* Run another command's line as a part of this one. */
static bool run_line(WrSession *session, const WrText *line, WrError *err)
{
    WrCall *call = NULL;
    const bool good = wr_call_parse(wr_text_get(line), false, &call, err) &&
                      call->command->run(session, call, err);
    wr_call_free(call);
    return good;
}

static bool take_numbers(WrSession *session, const WrGltfLook *look, WrError *err)
{
    WrText line = { 0 };
    wr_text_add(&line,
                "material model=ggx energy=kept diffuse=1 specular=1 ior=1.5 tint=0 colour=");
    for (int k = 0; k < 3; k++) {
        if (k) wr_text_add(&line, ",");
        wr_text_add_number(&line, look->colour[k]);
    }
    wr_text_add(&line, " metalness=");
    wr_text_add_number(&line, look->metalness);
    wr_text_add(&line, " roughness=");
    wr_text_add_number(&line, look->roughness);
    const bool good = run_line(session, &line, err);
    wr_text_fini(&line);
    return good;
}

/* Counts for the note: used and unused parts of the file. */
typedef struct Told {
    WrText taken, left;
} Told;

static void list(WrText *text, const char *what)
{
    if (text->length > 0) wr_text_add(text, ", ");
    wr_text_add(text, what);
}

/* Load a picture of the file by running another command; -1: no picture, which removes the present one. An unreadable
   picture is skipped with a note. */
static bool take_picture(WrSession *session, const char *file, int image, const char *verb,
                         const char *rest, const char *what, Told *told, WrError *err)
{
    WrText line = { 0 }, name = { 0 };
    WrError why = { "" };
    wr_text_addf(&name, "%s#%d", file, image);
    wr_text_addf(&line, "%s ", verb);
    if (image < 0) wr_text_add(&line, "off");
    else wr_text_add_word(&line, wr_text_get(&name));
    if (image >= 0) wr_text_add(&line, rest);
    const bool good = run_line(session, &line, &why);
    wr_text_fini(&line);
    wr_text_fini(&name);
    if (!good && wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (!good && image < 0) return wr_fail(err, "%s", wr_error_message(&why));
    if (good && image >= 0) list(&told->taken, what);
    if (!good) {
        WrText both = { 0 };
        wr_text_addf(&both, "the picture of %s (%s)", what, why.text);
        list(&told->left, wr_text_get(&both));
        wr_text_fini(&both);
    }
    return good || take_picture(session, file, -1, verb, "", what, told, err);
}

/* Note roughness and metalness factors that a picture replaces. */
static void note_factors(const WrScene *scene, const WrGltfLook *look, Told *told)
{
    const double factor[WR_FACET_KINDS] = {
        [WR_FACET_ROUGHNESS] = look->roughness, [WR_FACET_METALNESS] = look->metalness
    };
    static const char *const names[WR_FACET_KINDS] = {
        [WR_FACET_ROUGHNESS] = "roughness", [WR_FACET_METALNESS] = "metalness"
    };
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        if (!scene->facets[k].image || factor[k] == 1) continue;
        WrText words = { 0 };
        wr_text_addf(&words, "the factor ");
        wr_text_add_number(&words, factor[k]);
        wr_text_addf(&words, " of its picture of %s", names[k]);
        list(&told->left, wr_text_get(&words));
        wr_text_fini(&words);
    }
}

static bool take_pictures(WrSession *session, const char *file, const WrGltfLook *look, Told *told,
                          WrError *err)
{
    WrText strength = { 0 };
    /* a factor of 0 cancels the picture */
    const int rough = look->roughness > 0 ? look->facets : -1;
    const int metal = look->metalness > 0 ? look->facets : -1;
    wr_text_add(&strength, " repeat=once space=tangent green=up strength=");
    wr_text_add_number(&strength, look->normal_scale);
    const bool good =
        take_picture(session, file, look->base, "colour", " repeat=once", "colours", told, err) &&
        take_picture(session, file, rough, "roughness", " repeat=once", "roughness", told, err) &&
        take_picture(session, file, metal, "metalness", " repeat=once", "metalness", told, err) &&
        take_picture(session, file, look->normal, "normalmap", wr_text_get(&strength), "normals",
                     told, err);
    wr_text_fini(&strength);
    return good;
}

static void note(WrSession *session, const char *path, const WrGltfLook *look, const Told *told)
{
    WrText text = { 0 };
    char shown[WR_EXCERPT_SIZE];
    wr_text_addf(&text, "%s: material %d of %d", path, look->index + 1, look->count);
    if (look->name[0]) wr_text_addf(&text, " \"%s\"", wr_excerpt(look->name, shown));
    wr_text_add(&text, ": its numbers");
    if (told->taken.length > 0)
        wr_text_addf(&text, ", and pictures of %s", wr_text_get(&told->taken));
    WrText left = { 0 };
    if (told->left.length > 0) list(&left, wr_text_get(&told->left));
    if (look->left[0]) list(&left, look->left);
    if (look->alpha != 1) list(&left, "the opacity of its colour");
    if (look->count > 1) list(&left, "other materials: an object has one (part= takes another)");
    wr_text_addf(&text, left.length > 0 ? "; not taken: %s" : "%s", wr_text_get(&left));
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&left);
    wr_text_fini(&text);
}

static bool take(WrSession *session, const char *name, const char *path, const WrGltfLook *look,
                 WrError *err)
{
    Told told = { 0 };
    WrScene *before = wr_scene_clone(session->state.document->scene);
    const bool good =
        take_numbers(session, look, err) && take_pictures(session, name, look, &told, err);
    if (good) {
        note_factors(session->state.document->scene, look, &told);
        note(session, path, look, &told);
        wr_scene_free(before);
    } else {
        wr_session_replace_scene(session, before);
    }
    wr_text_fini(&told.taken);
    wr_text_fini(&told.left);
    return good;
}

/* Prints nothing: the lines of material, colour and so on hold the result. */
static void print_gltf(const WrScene *scene, WrText *text)
{
    (void)scene, (void)text;
}

static bool run_gltf(WrSession *session, WrCall *call, WrError *err)
{
    WrGltfLook look;
    if (session->loading) return wr_fail(err, "gltf is no command of a document: it opens files");
    const char *name = wr_call_arg(call, "FILE")->text;
    const char *part = wr_call_given(call, "part") ? wr_call_arg(call, "part")->text : NULL;
    char *path = wr_session_input_path(session, name);
    const bool good = wr_session_check_sha256(call, path, err) &&
                      wr_gltf_look(path, part, &look, err) && take(session, name, path, &look, err);
    wr_free(path);
    return good;
}

static const WrArgSpec args[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a .gltf or .glb file" },
    { .name = "part",
      .type = WR_ARG_NAME,
      .shape = "N or NAME",
      .help = "of its materials; left out: that of its first triangles" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "of the file: another content is then an error" },
    { 0 }
};

const WrCommand wr_command_gltf = {
    .name = "gltf",
    .kind = WR_CLASS_SCENE,
    .args = args,
    .run = run_gltf,
    .print = print_gltf,
    .of_object = true,
    .help = "the material of a glTF file",
    .details =
        "Base colour, metalness, roughness and the strength of its normals become those of the "
        "object's material, of model ggx, and its pictures of colours, of normals, of roughness "
        "(G) and metalness (B) are laid over the mesh once, out of the file or from beside it, as "
        "colour, normalmap, roughness and metalness lay them: there they are called FILE.glb#N, N "
        "the image's place in the file from 0. What is not taken is told.",
    .example = "gltf helmet.glb"
};
