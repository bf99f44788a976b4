/* The command grain: the solid texture of an object. */
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "scene/scene.h"
#include "shade/solid_texture.h"

#include <string.h>

/* True if there is no solid texture and all its numbers are the defaults. */
static bool untouched(const WrSolidTexture *grain)
{
    const WrSolidTexture *usual = &wr_grains[WR_SOLID_TEXTURE_OFF].usual;
    return grain->kind == WR_SOLID_TEXTURE_OFF && grain->axis == usual->axis &&
           grain->drives == usual->drives &&
           memcmp(grain->light, usual->light, sizeof grain->light) == 0 &&
           memcmp(grain->dark, usual->dark, sizeof grain->dark) == 0 &&
           memcmp(grain->roughness, usual->roughness, sizeof grain->roughness) == 0 &&
           grain->rings == usual->rings && grain->share == usual->share &&
           grain->amount == usual->amount && grain->cells == usual->cells &&
           grain->octaves == usual->octaves && grain->ratio == usual->ratio &&
           grain->edge == usual->edge && grain->height == usual->height;
}

static void print_grain(const WrScene *scene, WrText *text)
{
    const WrSolidTexture *grain = &scene->grain;
    if (untouched(grain)) return;
    wr_text_addf(text, "grain %s axis=%s", wr_grains[grain->kind].name,
                 wr_solid_texture_axes[grain->axis]);
    if (grain->drives != WR_SOLID_TEXTURE_COLOURS)
        wr_text_addf(text, " drives=%s", wr_solid_texture_drives[grain->drives]);
    wr_scene_print_params("grain", NULL, scene, text);
    wr_text_add(text, "\n");
}

static bool run_grain(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    const WrArg *kind = wr_call_arg(call, "KIND");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrSolidTexture *grain = &scene->grain;
    if (kind->given && kind->choice != (int)grain->kind) *grain = wr_grains[kind->choice].usual;
    wr_scene_take(call, NULL, scene);
    if (wr_call_given(call, "axis")) grain->axis = (WrSolidTextureAxis)wr_call_choice(call, "axis");
    if (wr_call_given(call, "drives")) grain->drives = 1 + wr_call_choice(call, "drives");
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *axis_choice(int i)
{
    return i < WR_SOLID_TEXTURE_AXES ? wr_solid_texture_axes[i] : NULL;
}

static const char *drive_choice(int i)
{
    return i + 1 < WR_SOLID_TEXTURE_DRIVES ? wr_solid_texture_drives[i + 1] : NULL;
}

static const char *kind_choice(int i)
{
    return i < WR_SOLID_TEXTURE_KINDS ? wr_grains[i].name : NULL;
}

static bool row_grain(WrForm *out)
{
    *out =
        (WrForm){ .args = { { .name = "KIND",
                              .type = WR_ARG_CHOICE,
                              .positional = true,
                              .choice = kind_choice,
                              .help = "rings about the axis, moved by noise; bands along it, moved "
                                      "by creased noise; cubes of two colours; specks; one colour "
                                      "going over into the other. Left out: that which is there" },
                            { .name = "axis",
                              .type = WR_ARG_CHOICE,
                              .choice = axis_choice,
                              .help = "of the object, which rings go round and bands along" },
                            { .name = "drives",
                              .type = WR_ARG_CHOICE,
                              .choice = drive_choice,
                              .help = "what the pattern changes; colour unless told" } } };
    return wr_scene_args("grain", NULL, out->args + 3) > 0;
}

const WrCommand wr_command_grain = {
    .name = "grain",
    .kind = WR_CLASS_SCENE,
    .row = row_grain,
    .run = run_grain,
    .print = print_grain,
    .of_object = true,
    .help = "a solid texture that the object is cut out of",
    .details = "It goes through the object and turns with it: rings of wood end where it is cut "
               "open. Its colours are multiplied with the material's and the colour picture's; as "
               "bump it is a height that turns the normal, and as roughness it goes from smooth "
               "to rough. Under dials aa=filter or moments, and on ground without end, what is "
               "finer than a pixel is its mean. Of another kind than before all numbers that are "
               "not given are that kind's usual ones; else only what is given changes. off "
               "forgets them all.",
    .example = "grain wood rings=12 amount=0.6"
};
