/* The command cell: physical size of the unit cell, used by exports, solids and labels. */
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "scene/param.h"
#include "scene/scene.h"

static void print_cell(const WrScene *scene, WrText *text)
{
    if (!wr_cell_size_given(&scene->cell)) return;
    wr_text_add(text, "cell ");
    wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_CELL_SIZE], scene, text);
    wr_scene_print_params("cell", NULL, scene, text);
    wr_text_add(text, "\n");
}

static bool run_cell(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool row_cell(WrForm *out)
{
    *out = (WrForm){ 0 };
    return wr_scene_args("cell", NULL, out->args) > 0;
}

const WrCommand wr_command_cell = {
    .name = "cell",
    .kind = WR_CLASS_SCENE,
    .row = row_cell,
    .run = run_cell,
    .print = print_cell,
    .help = "how large the unit cell is outside",
    .details =
        "Slopes and normals that are exported go by it, so do solids of a plane, and files "
        "tell it in their labels; pictures of the scene do not. In millimetres F = 1 is as high as "
        "height= says; in scene units as `bump height=` says. "
        "Only what is given changes.",
    .example = "cell 120,80 mm=on height=2.5"
};
