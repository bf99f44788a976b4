/* The command tone: mapping from light to pixel values. */
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "scene/param.h"
#include "scene/scene.h"

static void print_tone(const WrScene *scene, WrText *text)
{
    if (wr_tone_curve(&scene->tone).plain) return;
    wr_text_addf(text, "tone %s", wr_tone_names[scene->tone.kind]);
    wr_scene_print_params("tone", NULL, scene, text);
    wr_text_add(text, "\n");
}

static const char *tone_word(int i)
{
    return i < WR_TONE_KINDS ? wr_tone_names[i] : NULL;
}

static bool run_tone(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    const WrArg *kind = wr_call_arg(call, "clip|soft");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (kind->given) scene->tone.kind = (WrToneKind)kind->choice;
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool row_tone(WrForm *out)
{
    *out =
        (WrForm){ .args = { { .name = "clip|soft",
                              .type = WR_ARG_CHOICE,
                              .positional = true,
                              .choice = tone_word,
                              .help = "light beyond 1 is white, or from 1/2 on it bends over and "
                                      "never quite becomes white, so that highlights keep their "
                                      "form" } } };
    return wr_scene_args("tone", NULL, out->args + 1) > 0;
}

const WrCommand wr_command_tone = {
    .name = "tone",
    .kind = WR_CLASS_SCENE,
    .row = row_tone,
    .run = run_tone,
    .print = print_tone,
    .help = "exposure, and what becomes of light too bright for a picture",
    .details = "Of 8-bit pictures, and in the window; EXR and TIFF keep light as it is. The "
               "background is developed with the rest. Only what is given changes.",
    .example = "tone soft exposure=-0.5"
};
