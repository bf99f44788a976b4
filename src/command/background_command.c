/* The command background: the backdrop of the scene. */
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "scene/param.h"
#include "scene/scene.h"

#include <string.h>

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
        [WR_ROW(WR_BACKGROUND_PLAIN)] = "one colour",
        [WR_ROW(WR_BACKGROUND_GRADIENT)] = "one colour goes over into another, from top to bottom",
        [WR_ROW(WR_BACKGROUND_NONE)] = "none: files that hold alpha have it, such as PNG",
        [WR_ROW(WR_BACKGROUND_SURROUNDINGS)] =
            "the surroundings (`environment`), as the camera sees them",
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
    .help = "what stands behind the objects",
    .details = "Of 8-bit pictures, and in the window. Only what is given changes. EXR and TIFF "
               "hold coverage in its place. Files without alpha, such as JPEG, have the plain "
               "colour where there is none, and so has a scene without surroundings. An "
               "orthographic camera sees one direction of them.",
    .example = "background gradient top=0.12,0.16,0.24 bottom=0.5,0.47,0.42"
};
