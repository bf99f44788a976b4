/* Commands dials and tolerance: accuracy against time. */
#include "base/error.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/scene.h"

#include <string.h>

static void print_dials(const WrScene *scene, WrText *text)
{
    WrText dials = { 0 };
    wr_dials_print(scene, "dials", true, &dials);
    wr_text_addf(text, "dials %s\n", wr_text_get(&dials));
    wr_text_fini(&dials);
}

static void print_tolerance(const WrScene *scene, WrText *text)
{
    const WrTolerance *tolerance = &scene->tolerance;
    const bool valued = tolerance->kind != WR_TOLERANCE_NONE;
    wr_text_addf(text, "tolerance %s%s", wr_tolerance_names[tolerance->kind], valued ? "=" : "");
    if (valued) wr_text_add_number(text, tolerance->value);
    wr_text_add(text, tolerance->kind == WR_TOLERANCE_TIME ? "s\n" : "\n");
}

static bool run_dials(WrSession *session, WrCall *call, WrError *err)
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

static bool duration_parse(const char *text, double *seconds)
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

static bool check_duration(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    double seconds;
    if (duration_parse(value, &seconds)) return true;
    return wr_fail(err, "%s=%.40s: must be a time such as 8ms or 0.5s, 0.1ms to 3600s", name,
                   value);
}

static bool check_chosen(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    if (wr_choice_check(value, err)) return true;
    wr_error_prefix(err, "%s: ", name);
    return false;
}

static bool run_tolerance(WrSession *session, WrCall *call, WrError *err)
{
    const char *const *names = wr_tolerance_names;
    WrTolerance tolerance = { WR_TOLERANCE_NONE, 0 };
    int given = 0;
    for (int i = 0; i < WR_TOLERANCE_COUNT; i++) {
        if (!wr_call_given(call, names[i])) continue;
        given++;
        tolerance.kind = (WrToleranceKind)i;
        if (i == WR_TOLERANCE_TIME)
            duration_parse(wr_call_arg(call, "time")->text, &tolerance.value);
        else if (i != WR_TOLERANCE_NONE) tolerance.value = wr_call_number(call, names[i]);
    }
    if (given != 1)
        return wr_fail(err, "tolerance: needs one of off, rms=, max= and time=, %s given",
                       given == 0 ? "none is" : "several are");
    const bool chosen = wr_call_given(call, "chosen");
    if (chosen && tolerance.kind == WR_TOLERANCE_NONE)
        return wr_fail(err, "tolerance: give off or chosen=, not both: without a tolerance the "
                            "dials are used as set");
    wr_session_keep_chosen(session, chosen ? wr_call_arg(call, "chosen")->text : NULL);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->tolerance = tolerance;
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *tolerance_off(int i)
{
    return i == 0 ? "off" : NULL;
}

static const WrArgSpec args_tolerance[] = {
    { .name = "off",
      .type = WR_ARG_CHOICE,
      .positional = true,
      .choice = tolerance_off,
      .help = "no tolerance: the dials are used as set" },
    { .name = "rms",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .above = true,
      .high = 1e6,
      .unit = "linear intensity",
      .help = "largest root mean square error over the object's pixels" },
    { .name = "max",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .above = true,
      .high = 1e6,
      .unit = "linear intensity",
      .help = "largest error of any channel of any pixel" },
    { .name = "time",
      .type = WR_ARG_TEXT,
      .shape = "8ms or 0.5s",
      .check = check_duration,
      .help = "time per frame, 0.1ms to 3600s: the smallest error within it" },
    { .name = "chosen",
      .type = WR_ARG_TEXT,
      .shape = "dials as save writes them",
      .check = check_chosen,
      .help = "choice for the last picture, used again for the same table, scene, size and turn" },
    { 0 }
};

/* One argument for each dial that this command sets. */
static bool row_dials(WrForm *out)
{
    int count = 0;
    *out = (WrForm){ 0 };
    for (int i = 0; i < WR_DIAL_COUNT; i++) {
        const WrDial *dial = &wr_dials[i];
        if (strcmp(dial->command, "dials") != 0) continue;
        out->args[count++] = (WrArgSpec){ .name = dial->name,
                                          .type = dial->choices > 0 ? WR_ARG_CHOICE : WR_ARG_NUMBER,
                                          .choice = dial->choice,
                                          .low = dial->low,
                                          .high = dial->high,
                                          .whole = dial->whole,
                                          .help = dial->help };
    }
    return true;
}

/* ---- the rows ---- */

const WrCommand wr_command_dials = { .name = "dials",
                                     .kind = WR_CLASS_SCENE,
                                     .row = row_dials,
                                     .run = run_dials,
                                     .print = print_dials,
                                     .help = "set the dials of accuracy and time",
                                     .details = "Only given arguments change.",
                                     .example = "dials aa=supersample samples=4" };

const WrCommand wr_command_tolerance = {
    .name = "tolerance",
    .kind = WR_CLASS_SCENE,
    .args = args_tolerance,
    .run = run_tolerance,
    .print = print_tolerance,
    .print_end = true,
    .help = "choose the cheapest dials within an error or a time",
    .details = "Each picture is rendered with the cheapest slopes, normal formula and samples that "
               "should meet the tolerance, checked on some of its pixels, and rendered once more "
               "with better ones if it missed. `wrinkle explain` prints the choice, and whether "
               "the tolerance was met. save stores the last picture's choice in chosen=.",
    .example = "tolerance rms=0.004"
};
