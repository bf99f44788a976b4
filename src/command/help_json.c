#include "command/help.h"

#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "surface/surface.h"

#include <string.h>

/* Print ,"name": */
static void add_key(WrText *text, const char *name)
{
    char last = text->length ? text->data[text->length - 1] : '{';
    if (last != '{' && last != '[') wr_text_add(text, ",");
    wr_text_add_json_string(text, name);
    wr_text_add(text, ":");
}

static void add_string(WrText *text, const char *name, const char *value)
{
    if (!value) return;
    add_key(text, name);
    wr_text_add_json_string(text, value);
}

static void add_number(WrText *text, const char *name, double value)
{
    add_key(text, name);
    wr_text_add_json_number(text, value);
}

static void add_bool(WrText *text, const char *name, bool value)
{
    add_key(text, name);
    wr_text_add(text, value ? "true" : "false");
}

static bool is_numeric(const WrArgSpec *spec)
{
    return spec->type <= WR_ARG_LIST;
}

/* Print a value's text as JSON: 5, [5,6], [[1,2],[3,4]] or "blinn". */
static void add_value(WrText *text, const WrArgSpec *spec, const char *value)
{
    WrArg arg = { .choice = -1 };
    if (!is_numeric(spec)) {
        wr_text_add_json_string(text, value);
        return;
    }
    if (!wr_arg_parse(spec, "", value, &arg, NULL)) {
        wr_text_add(text, "null");
        return;
    }
    int width = wr_arg_width(spec);
    bool list = spec->type == WR_ARG_LIST, array = spec->type != WR_ARG_NUMBER;
    if (list) wr_text_add(text, "[");
    for (int r = 0; r < arg.rows; r++) {
        wr_text_add(text, r ? "," : "");
        wr_text_add(text, array ? "[" : "");
        for (int i = 0; i < arg.counts[r]; i++) {
            wr_text_add(text, i ? "," : "");
            wr_text_add_json_number(text, arg.numbers[r * width + i]);
        }
        wr_text_add(text, array ? "]" : "");
    }
    if (list) wr_text_add(text, "]");
    wr_arg_fini(&arg);
}

static void add_default(WrText *text, const WrCommand *command, int form, const WrArgSpec *spec)
{
    WrText value = { 0 };
    wr_arg_fallback_print(spec, &value);
    bool keeps = !value.length && !spec->required;
    if (keeps) wr_help_initial(command, form, spec->name, &value);
    add_key(text, "default");
    if (value.length) add_value(text, spec, wr_text_get(&value));
    else wr_text_add(text, "null");
    if (keeps && value.length) add_bool(text, "keeps", true);
    wr_text_fini(&value);
}

static void add_range(WrText *text, const WrArgSpec *spec)
{
    if (spec->parts) {
        add_key(text, "parts");
        wr_text_add(text, "[");
        for (int i = 0; i < spec->components; i++) {
            const WrComponent *part = &spec->parts[i];
            wr_text_add(text, i ? ",{" : "{");
            add_string(text, "name", part->name);
            add_number(text, "low", part->low);
            add_number(text, "high", part->high);
            add_bool(text, "whole", part->whole);
            wr_text_add(text, "}");
        }
        wr_text_add(text, "]");
    } else {
        add_number(text, "low", spec->low);
        add_number(text, "high", spec->high);
        if (spec->above) add_bool(text, "above", true);
        add_bool(text, "whole", spec->whole || spec->type == WR_ARG_SIZE);
        if (spec->share) add_bool(text, "share", true);
    }
    add_number(text, "components", wr_arg_width(spec));
    if (spec->type != WR_ARG_LIST) return;
    add_key(text, "counts");
    wr_text_add(text, "[");
    for (int n = 1, any = 0; n <= spec->components; n++)
        if (spec->counts ? spec->counts >> n & 1 : n == spec->components)
            wr_text_addf(text, "%s%d", any++ ? "," : "", n);
    wr_text_addf(text, "],\"rows\":[%d,%d]", spec->rows_low, spec->rows_high);
}

/* Print the meanings of the choice words, in their order. */
static void add_meanings(WrText *text, const WrArgSpec *spec)
{
    if (!spec->explain) return;
    add_key(text, "meanings");
    wr_text_add(text, "[");
    for (int i = 0; wr_arg_word(spec, i); i++) {
        WrText meaning = { 0 };
        spec->explain(i, &meaning);
        wr_text_add(text, i ? "," : "");
        wr_text_add_json_string(text, wr_text_get(&meaning));
        wr_text_fini(&meaning);
    }
    wr_text_add(text, "]");
}

static void add_arg(WrText *text, const WrCommand *command, int form, const WrArgSpec *spec)
{
    wr_text_add(text, "{");
    add_string(text, "name", spec->name);
    add_string(text, "type", wr_arg_type_names[spec->type]);
    add_bool(text, "positional", spec->positional);
    add_bool(text, "required", spec->required);
    add_default(text, command, form, spec);
    if (is_numeric(spec)) add_range(text, spec);
    if (spec->type == WR_ARG_CHOICE) {
        add_key(text, "choices");
        wr_text_add(text, "[");
        for (int i = 0; wr_arg_word(spec, i); i++) {
            wr_text_add(text, i ? "," : "");
            wr_text_add_json_string(text, wr_arg_word(spec, i));
        }
        wr_text_add(text, "]");
        add_meanings(text, spec);
    }
    add_string(text, "unit", spec->unit);
    add_string(text, "shape", spec->shape);
    add_string(text, "help", spec->help);
    wr_text_add(text, "}");
}

static void add_args(WrText *text, const char *key, const WrCommand *command, int form,
                     const WrArgSpec *specs, int count)
{
    add_key(text, key);
    wr_text_add(text, "[");
    for (int i = 0; i < count; i++) {
        wr_text_add(text, i ? "," : "");
        add_arg(text, command, form, &specs[i]);
    }
    wr_text_add(text, "]");
}

static int count_args(const WrArgSpec *specs)
{
    int count = 0;
    while (specs[count].name) count++;
    return count;
}

static void add_command(WrText *text, const WrCommand *command)
{
    WrForm row;
    WrArgSpec specs[WR_ARGS_MAX];
    WrText usage = { 0 };
    wr_help_usage(command, -1, &usage);
    wr_text_add(text, "{");
    add_string(text, "name", command->name);
    add_string(text, "class", wr_class_names[command->kind]);
    add_string(text, "help", command->help);
    add_string(text, "details", command->details);
    add_string(text, "example", command->example);
    add_string(text, "usage", wr_text_get(&usage));
    int count = wr_command_specs(command, -1, specs);
    add_args(text, "args", command, -1, specs, count);
    if (command->form) {
        add_string(text, "form_word", command->form_word);
        add_key(text, "forms");
        wr_text_add(text, "[");
        for (int i = 0; command->form(i, &row); i++) {
            wr_text_add(text, i ? ",{" : "{");
            add_string(text, "name", row.name);
            add_string(text, "help", row.help);
            add_args(text, "args", command, i, row.args, count_args(row.args));
            wr_text_add(text, "}");
        }
        wr_text_add(text, "]");
    }
    wr_text_add(text, "}");
    wr_text_fini(&usage);
}

void wr_help_json(WrText *text)
{
    wr_text_add(text, "{\"commands\":[");
    for (int i = 0; i < wr_command_count; i++) {
        wr_text_add(text, i ? ",\n" : "\n");
        add_command(text, wr_commands[i]);
    }
    wr_text_add(text, "\n],\"surfaces\":[");
    const WrCommand *surface = wr_command_find("surface");
    WrForm row;
    for (int i = 0; surface->form(i, &row); i++) {
        wr_text_add(text, i ? ",\n{" : "\n{");
        add_string(text, "name", wr_surfaces[i]->name);
        add_string(text, "label", wr_surfaces[i]->label);
        add_string(text, "help", wr_surfaces[i]->help);
        add_args(text, "params", surface, i, row.args, count_args(row.args));
        wr_text_add(text, "}");
    }
    wr_text_add(text, "\n]}\n");
}
