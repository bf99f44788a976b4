#include "ui/panels/call_rows.h"
#include "ui/app/state/line.h"
#include "ui/app/state/step_label.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/text.h"
#include "command/command_line.h"
#include "generate/generator.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define WORDS_MAX 64
#define TEXT_BYTES 4096
#define POINTS_MAX 4 /* of a list that has rows */

/* The generator's parameter of that name; NULL: the command is no generator, or it has none. */
static const WrParam *param_of(const WrCall *call, const char *name)
{
    const WrGenerator *generator = wr_generator_find(
        call->command->name, call->form_name[0] ? call->form_name : call->command->name);
    for (const WrParam *p = generator ? generator->params : NULL; p && p->name; p++)
        if (strcmp(p->name, name) == 0) return p;
    return NULL;
}

/* "inner-radius" as "Inner radius". */
static void add_label(const WrCall *call, int i, char label[48])
{
    const WrParam *p = param_of(call, call->specs[i].name);
    if (p && p->label) {
        snprintf(label, 48, "%s", p->label);
        return;
    }
    snprintf(label, 48, "%s", call->specs[i].name);
    for (char *c = label; *c; c++) {
        if (*c == '-' || *c == '_') *c = ' ';
        *c = (char)(c == label ? toupper((unsigned char)*c) : tolower((unsigned char)*c));
    }
}

/* ---- values ---- */

/* The next power of ten times 1, 2 or 5 from x up. */
static double round_up(double x)
{
    const double ten = pow(10.0, floor(log10(x)));
    return x <= ten ? ten : x <= 2.0 * ten ? 2.0 * ten : x <= 5.0 * ten ? 5.0 * ten : 10.0 * ten;
}

static WrNumber number_of(const WrCall *call, int i, int part, double value)
{
    const WrArgSpec *spec = &call->specs[i];
    const WrParam *p = param_of(call, spec->name);
    const double low = spec->parts ? spec->parts[part].low : spec->low;
    const double high = spec->parts ? spec->parts[part].high : spec->high;
    const double most = round_up(fmax(fabs(value), 0.5) * 2.0);
    WrNumber number = { .low = fmax(low, low < 0.0 ? -most : 0.0),
                        .high = fmin(high, most),
                        .hard_low = low,
                        .hard_high = high,
                        .reset = spec->fallback ? spec->fallback[part] : value,
                        .decimals = spec->whole || spec->type == WR_ARG_SIZE ? 0 : -1,
                        .unit = spec->unit && strlen(spec->unit) < 8 ? spec->unit : NULL,
                        .tip = spec->help };
    if (p && p->soft_low < p->soft_high) {
        number.low = p->soft_low;
        number.high = p->soft_high;
    }
    if (!(number.low < number.high)) number.high = number.low + 1.0;
    return number;
}

static WrEdit numbers_row(WrCall *call, int i)
{
    WrArg *arg = &call->args[i];
    const int count = wr_arg_width(&call->specs[i]);
    const double wide = (wr_gui_available() - (count - 1) * wr_gui_px(4)) / count;
    WrEdit done = WR_EDIT_NONE;
    for (int k = 0; k < count; k++) {
        char id[16];
        WrNumber number = number_of(call, i, k, arg->numbers[k]);
        if (count > 1) number.unit = NULL;
        snprintf(id, sizeof id, "n%d", k);
        if (k > 0) wr_gui_same_line(4);
        const WrEdit edit =
            wr_gui_number(id, k == count - 1 ? 0 : floor(wide), &number, &arg->numbers[k]);
        if (edit == WR_EDIT_NONE) continue;
        arg->numbers[k] = wr_line_round(arg->numbers[k], 7);
        done = edit;
    }
    return done;
}

static WrEdit choice_row(WrCall *call, int i)
{
    const char *words[WORDS_MAX];
    int count = 0, chosen = call->args[i].choice;
    for (const char *word; count < WORDS_MAX && (word = wr_arg_word(&call->specs[i], count));)
        words[count++] = wr_step_word(word);
    if (!wr_gui_choice("choice", 0, words, count, &chosen)) return WR_EDIT_NONE;
    call->args[i].choice = chosen;
    return WR_EDIT_DONE;
}

static WrEdit text_row(WrCall *call, int i)
{
    char text[TEXT_BYTES];
    snprintf(text, sizeof text, "%s", call->args[i].text ? call->args[i].text : "");
    if (strlen(text) + 1 == sizeof text) return WR_EDIT_NONE; /* too long for a row */
    if (!wr_gui_hint_field("##text", "none", 0, text, sizeof text)) return WR_EDIT_NONE;
    wr_call_set_text(call, call->specs[i].name, text);
    return WR_EDIT_DONE;
}

static bool is_text(const WrArgSpec *spec)
{
    return spec->type == WR_ARG_PATH || spec->type == WR_ARG_TEXT || spec->type == WR_ARG_NAME ||
           spec->type == WR_ARG_LAYER || spec->type == WR_ARG_PRESET;
}

static bool has_row(const WrCall *call, int i)
{
    const WrArg *arg = &call->args[i];
    switch (call->specs[i].type) {
    case WR_ARG_NUMBER:
    case WR_ARG_SIZE:
    case WR_ARG_TUPLE: return arg->numbers != NULL;
    case WR_ARG_CHOICE: return arg->choice >= 0;
    default: return is_text(&call->specs[i]);
    }
}

static void forget_checksums(WrCall *call)
{
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].type == WR_ARG_SHA256) wr_arg_fini(&call->args[i]);
}

static WrEdit row(WrCall *call, int i)
{
    char label[48];
    const WrArgSpec *spec = &call->specs[i];
    add_label(call, i, label);
    wr_gui_push_id(i);
    wr_gui_label(label);
    wr_gui_tip(spec->help);
    const WrEdit edit = is_text(spec)                 ? text_row(call, i)
                        : spec->type == WR_ARG_CHOICE ? choice_row(call, i)
                                                      : numbers_row(call, i);
    if (spec->type != WR_ARG_NUMBER) wr_gui_tip(spec->help);
    wr_gui_pop_id();
    if (edit == WR_EDIT_NONE) return edit;
    call->args[i].given = true;
    forget_checksums(call);
    return edit;
}

static WrEdit rows(WrCall *call, bool given)
{
    for (int i = 0; i < call->count; i++) {
        if (call->args[i].given != given || !has_row(call, i)) continue;
        const WrEdit edit = row(call, i);
        if (edit != WR_EDIT_NONE) return edit;
    }
    return WR_EDIT_NONE;
}

WrEdit wr_call_rows(WrCall *call)
{
    int others = 0;
    for (int i = 0; i < call->count; i++) others += !call->args[i].given && has_row(call, i);
    WrEdit edit = rows(call, true);
    if (others > 0 && wr_gui_fold("Other values", false) && edit == WR_EDIT_NONE)
        edit = rows(call, false);
    return edit;
}

/* ---- differences ---- */

static bool same_value(const WrArgSpec *spec, const WrArg *a, const WrArg *b)
{
    WrText x = { 0 }, y = { 0 };
    if (!a->given || !b->given) return a->given == b->given;
    wr_arg_print(spec, a, &x);
    wr_arg_print(spec, b, &y);
    const bool same = strcmp(wr_text_get(&x), wr_text_get(&y)) == 0;
    wr_text_fini(&x);
    wr_text_fini(&y);
    return same;
}

/* One changed value without a name brings all of them. */
void wr_call_difference(const WrCall *from, const WrCall *call, WrText *words)
{
    bool plain = false;
    for (int i = 0; i < call->count; i++)
        plain |= call->specs[i].positional &&
                 !same_value(&call->specs[i], &from->args[i], &call->args[i]);
    for (int i = 0; i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        const WrArg *arg = &call->args[i];
        const bool differs = spec->positional ? plain : !same_value(spec, &from->args[i], arg);
        if (!differs || !arg->given || spec->type == WR_ARG_SHA256) continue;
        if (words->length) wr_text_add(words, " ");
        if (!spec->positional) wr_text_addf(words, "%s=", spec->name);
        wr_arg_print(spec, arg, words);
    }
}
