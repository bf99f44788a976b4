/* Scene parameters as arguments of commands, and the scene as command lines. */
#include "base/error.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/command_line.h"
#include "command/session_internal.h"
#include "scene/objects.h"
#include "scene/param.h"
#include "scene/scene.h"

#include <string.h>

/* ---- text of a value ---- */

void wr_param_text(const WrSceneParam *param, const double *values, WrText *text)
{
    if (param->components == 0) wr_text_add(text, wr_off_on[values[0] != 0]);
    for (int i = 0; i < param->components; i++) {
        if (i > 0) wr_text_add(text, ",");
        wr_text_add_number(text, values[i]);
    }
}

/* ---- arguments ---- */

int wr_scene_args(const char *command, const char *form, WrArgSpec *out)
{
    int count = 0;
    const WrSceneParam *p;
    while ((p = wr_scene_param(command, form, count)) != NULL)
        out[count++] = (WrArgSpec){ .name = p->name,
                                    .type = p->components == 0   ? WR_ARG_CHOICE
                                            : p->components == 1 ? WR_ARG_NUMBER
                                                                 : WR_ARG_TUPLE,
                                    .positional = p->positional,
                                    .required = p->required,
                                    .low = p->low,
                                    .high = p->high,
                                    .components = p->components > 1 ? p->components : 0,
                                    .words = p->components == 0 ? wr_off_on : NULL,
                                    .shape = p->shape,
                                    .fallback = p->filled ? p->fallback : NULL,
                                    .unit = p->unit,
                                    .help = p->help };
    return count;
}

void wr_scene_take(const WrCall *call, const char *form, void *owner)
{
    const WrSceneParam *p;
    for (int i = 0; (p = wr_scene_param(call->command->name, form, i)) != NULL; i++) {
        if (!p->filled && !wr_call_given(call, p->name)) continue;
        const double on =
            p->components == 0 && wr_call_choice(call, p->name) > 0; /* -1: not given */
        wr_scene_param_set(p, owner,
                           p->components == 0 ? &on : wr_call_arg(call, p->name)->numbers);
    }
}

bool wr_scene_take_turn(const char *text, WrScene *scene, WrError *err)
{
    scene->posed = strcmp(text, WR_OWN_TURN) != 0;
    scene->rotate_deg = (WrVec3){ 0 };
    if (!scene->posed) return true;
    WrError why;
    WrArg numbers = { .choice = -1 };
    const WrArgSpec spec = { .name = "turn",
                             .type = WR_ARG_TUPLE,
                             .components = 3,
                             .low = -1e9,
                             .high = 1e9,
                             .shape = "x,y,z" };
    if (!wr_arg_parse(&spec, "turn", text, &numbers, &why))
        return wr_fail(err, "%s, or " WR_OWN_TURN, wr_error_message(&why));
    scene->rotate_deg = (WrVec3){ numbers.numbers[0], numbers.numbers[1], numbers.numbers[2] };
    wr_arg_fini(&numbers);
    return true;
}

void wr_scene_print_value(const WrSceneParam *param, const void *owner, WrText *text)
{
    double values[3];
    wr_scene_param_get(param, owner, values);
    wr_param_text(param, values, text);
}

void wr_print_word(const char *name, const char *word, WrText *text)
{
    if (!word) return;
    wr_text_addf(text, " %s=", name);
    wr_text_add_word(text, word);
}

void wr_scene_print_vec(WrVec3 v, WrText *text)
{
    const double numbers[3] = { v.x, v.y, v.z };
    for (int i = 0; i < 3; i++) {
        if (i > 0) wr_text_add(text, ",");
        wr_text_add_number(text, numbers[i]);
    }
}

void wr_scene_print_params(const char *command, const char *form, const void *owner, WrText *text)
{
    const WrSceneParam *p;
    for (int i = 0; (p = wr_scene_param(command, form, i)) != NULL; i++) {
        double values[3] = { 0 };
        wr_scene_param_get(p, owner, values);
        if (p->positional || (p->sparse && values[0] == p->fallback[0])) continue;
        wr_text_addf(text, " %s=", p->name);
        wr_scene_print_value(p, owner, text);
    }
}

/* ---- the scene as lines ---- */

/* The scene as the canonical lines that restore it from a new document. Every setting is printed, defaults too, so
   that a document keeps its meaning if a later version has other defaults. Only the default light, the surface's
   default pose and a missing picture have no line. */

typedef void Printer(const WrCommand *command, const WrScene *scene, WrText *text);

static void print_named(const WrCommand *command, const WrScene *scene, WrText *text)
{
    command->print(scene, text);
}

static void print_content(const WrCommand *command, const WrScene *scene, WrText *text)
{
    (command->print_content ? command->print_content : command->print)(scene, text);
}

/* Lines of one object; its rotation is printed with its position. */
static void print_own(const WrScene *scene, int object, Printer *printer, WrText *text)
{
    wr_print_object(scene, object, text);
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        if (command->of_object && !command->in_object)
            printer(command, wr_scene_object(scene, object), text);
    }
}

static void print_scene(const WrScene *scene, Printer *printer, WrScenePart *after, void *ctx,
                        WrText *text)
{
    const bool several = wr_scene_object_count(scene) > 1;
    for (int i = 0; several && i < wr_scene_object_count(scene); i++)
        print_own(scene, i, printer, text);
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        if (!command->print || (several && command->of_object)) continue;
        printer(command, scene, text);
        if (after) after(ctx, command, text);
    }
    wr_print_chosen(scene, text);
}

void wr_print_scene(const WrScene *scene, WrScenePart *after, void *ctx, WrText *text)
{
    print_scene(scene, print_named, after, ctx, text);
}

void wr_print_identity(const WrScene *scene, WrText *text)
{
    print_scene(scene, print_content, NULL, NULL, text);
}
