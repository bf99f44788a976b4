/* Command model: a stock model as the surface of the object. */
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "command/args.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "scene/scene.h"
#include "scene/stock_model.h"

/* The line of the command surface that reads the model's mesh. */
static bool surface_line(const WrStockModel *model, WrText *line, WrError *err)
{
    WrText name = { 0 }, path = { 0 };
    wr_text_addf(&name, "samples/models/%s.ply", model->name);
    const bool found = wr_data_find(wr_text_get(&name), &path);
    if (!found)
        wr_fail(err,
                "%s was not found: set WRINKLE_DATA to the folder that holds models, or install "
                "the program",
                wr_text_get(&name));
    wr_text_add(line, "surface mesh file=");
    wr_text_add_word(line, wr_text_get(&path));
    wr_text_addf(line, " crease=40 unit=mm %s", model->projection);
    wr_text_fini(&name);
    wr_text_fini(&path);
    return found;
}

static bool run_model(WrSession *session, WrCall *call, WrError *err)
{
    const WrStockModel *model = &wr_stock_models[wr_call_choice(call, "NAME")];
    WrText line = { 0 };
    WrCall *surface = NULL;
    const WrNoteSink note = session->options.note;
    session->options.note =
        NULL; /* counts of triangles and open edges are no news of these meshes */
    const bool good = surface_line(model, &line, err) &&
                      wr_call_parse(wr_text_get(&line), false, &surface, err) &&
                      surface->command->run(session, surface, err);
    session->options.note = note;
    wr_call_free(surface);
    wr_text_fini(&line);
    if (!good) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->replicate_u = scene->replicate_v = 1;
    scene->posed = true;
    scene->rotate_deg = model->rotate_deg;
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *model_name(int i)
{
    return i < WR_STOCK_MODELS ? wr_stock_models[i].name : NULL;
}

static const WrArgSpec model_args[] = { { .name = "NAME",
                                          .type = WR_ARG_CHOICE,
                                          .positional = true,
                                          .required = true,
                                          .choice = model_name,
                                          .help = "name of the model" },
                                        { 0 } };

const WrCommand wr_command_model = {
    .name = "model",
    .kind = WR_CLASS_EDIT,
    .args = model_args,
    .run = run_model,
    .help = "use a stock model as the object's surface",
    .details = "A mesh about 2 units in size, with the table on all sides by box projection, "
               "replicated once, and rotated to show its shape. The scene stores it as `surface "
               "mesh` and `rotate`, which can change it.",
    .example = "model mug"
};
