#include "command/scene_args.h"

#include "base/error.h"
#include "base/text.h"
#include "command/args.h"
#include "command/param_text.h"
#include "scene/param.h"
#include "scene/scene.h"

#include <string.h>

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
