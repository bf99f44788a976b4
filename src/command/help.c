/* The command table as text, as JSON and as Markdown. */
#include "command/help.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/message.h"
#include "command/command_line.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <string.h>

/* ---- text ---- */

/* Print the argument `name` of one canonical line, if the line contains it. False if not. */
static bool print_given(const char *line, int form, const char *name, WrText *text)
{
    WrCall *call = NULL;
    bool found = false;
    if (wr_call_parse(line, false, &call, NULL) && (form < 0 || call->form == form))
        for (int i = 0; i < call->count && !found; i++)
            if (strcmp(call->specs[i].name, name) == 0 && call->args[i].given) {
                wr_arg_print(&call->specs[i], &call->args[i], text);
                found = true;
            }
    wr_call_free(call);
    return found;
}

/* Read the value from the scene lines of a new document: from the line of that form, else from any form (the cameras
   share their eye). Initial values are read from the printed scene, not from a second table, so help cannot disagree with the
   program. */
void wr_help_initial(const WrCommand *command, int form, const char *name, WrText *text)
{
    if (!command->print) return;
    WrText lines = { 0 };
    WrScene *scene = wr_scene_new();
    wr_dials_smooth(&scene->dials);
    command->print(scene, &lines);
    wr_scene_free(scene);
    bool found = false;
    for (int pass = form < 0; pass < 2; pass++)
        for (const char *p = wr_text_get(&lines); *p && !found;) {
            size_t length = strcspn(p, "\n");
            char *line = wr_strndup(p, length);
            found = print_given(line, pass == 0 ? form : -1, name, text);
            wr_free(line);
            p += length + (p[length] == '\n');
        }
    wr_text_fini(&lines);
}

/* Syntax of a value of this type: "x,y,z". */
static const char *written(const WrArgSpec *spec)
{
    if (spec->shape) return spec->shape;
    switch (spec->type) {
    case WR_ARG_SIZE: return "WxH";
    case WR_ARG_TUPLE: return spec->components == 2 ? "x,y" : "x,y,z";
    case WR_ARG_SHA256: return "HEX";
    default: return "";
    }
}

/* Syntax for a usage line; the shape of a text is a sentence, too long for it. */
static const char *written_short(const WrArgSpec *spec)
{
    return spec->type == WR_ARG_TEXT ? "" : written(spec);
}

/* Number of a form's `count` arguments that are its own or its command's, not shared with other commands. */
static int help_own(const WrCommand *command, int count)
{
    for (const WrArgSpec *s = command->more; s && s->name; s++) count--;
    return count;
}

static void add_usage(const WrCommand *command, int form, const WrArgSpec *specs, int count,
                      WrText *text)
{
    WrForm row;
    wr_text_add(text, command->name);
    if (form >= 0 && command->form(form, &row)) wr_text_addf(text, " %s", row.name);
    else if (command->form) wr_text_addf(text, " %s", command->form_word);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < count; i++) {
            const WrArgSpec *s = &specs[i];
            if (s->positional != (pass == 0)) continue;
            wr_text_add(text, s->required ? " " : " [");
            wr_text_add(text, s->name);
            if (!s->positional) wr_text_addf(text, "=%s", written_short(s));
            if (!s->required) wr_text_add(text, "]");
        }
}

/* Usage line: "dab u,v [radius=] ...". */
static void help_usage(const WrCommand *command, int form, WrText *text)
{
    WrArgSpec specs[WR_ARGS_MAX];
    add_usage(command, form, specs, wr_command_specs(command, form, specs), text);
}

/* Print text wrapped at `width` columns, each line after `indent` blanks; the first line starts at `column`. */
static void add_wrapped(WrText *text, const char *words, int column, int indent, int width)
{
    for (const char *p = words; *p;) {
        int length = (int)strcspn(p, " ");
        if (column > indent && column + 1 + length > width) {
            wr_text_addf(text, "\n%*s", indent, "");
            column = indent;
        } else if (column > indent && p != words) {
            wr_text_add(text, " ");
            column++;
        }
        wr_text_add_n(text, p, (size_t)length);
        column += length;
        p += length;
        while (*p == ' ') p++;
    }
    wr_text_add(text, "\n");
}

/* Print the meaning of each choice word, one a line. */
static void add_meanings(WrText *text, const WrArgSpec *spec)
{
    for (int i = 0; spec->explain && wr_arg_word(spec, i); i++) {
        WrText meaning = { 0 };
        spec->explain(i, &meaning);
        wr_text_addf(text, "%21s%-9s ", "", wr_arg_word(spec, i));
        add_wrapped(text, wr_text_get(&meaning), 31, 31, 96);
        wr_text_fini(&meaning);
    }
}

/* Meaning, allowed values and default of an argument: "of the brush; a number, 0..9 (default 1)". */
static void help_argument(const WrCommand *command, int form, const WrArgSpec *spec, WrText *text)
{
    WrText value = { 0 };
    if (spec->type == WR_ARG_TEXT && spec->shape) wr_text_addf(text, "%s: ", spec->shape);
    wr_text_add(text, spec->help);
    if ((spec->type < WR_ARG_PATH || spec->type == WR_ARG_LAYER) && !spec->parts &&
        !spec->explain) {
        wr_text_add(text, "; ");
        char plain[1024];
        WrText right = { 0 };
        wr_arg_expectation(spec, &right);
        wr_text_add(text, wr_message_print(wr_text_get(&right), NULL, plain, sizeof plain));
        wr_text_fini(&right);
    }
    wr_arg_fallback_print(spec, &value);
    if (value.length && value.length < 60) {
        wr_text_addf(text, " (default %s)", wr_text_get(&value));
    } else if (!value.length) {
        wr_help_initial(command, form, spec->name, &value);
        if (value.length && !spec->required)
            wr_text_addf(text, " (at first %s)", wr_text_get(&value));
    }
    wr_text_fini(&value);
}

/* Argument name as in usage lines: "radius=", "at=u,v", "FILE". */
static void help_argument_name(const WrArgSpec *spec, WrText *text)
{
    wr_text_addf(text, "%s%s%s", spec->name, spec->positional ? "" : "=",
                 spec->positional ? "" : written_short(spec));
}

static void add_argument(WrText *text, const WrCommand *command, int form, const WrArgSpec *spec)
{
    WrText left = { 0 }, right = { 0 };
    help_argument_name(spec, &left);
    help_argument(command, form, spec, &right);
    if (spec->explain) wr_text_add(&right, ":");
    if (left.length < 15) wr_text_addf(text, "    %-15s", wr_text_get(&left));
    else wr_text_addf(text, "    %s\n%19s", wr_text_get(&left), "");
    add_wrapped(text, wr_text_get(&right), 19, 19, 96);
    add_meanings(text, spec);
    wr_text_fini(&left);
    wr_text_fini(&right);
}

static void add_arguments(WrText *text, const WrCommand *command, int form, const WrArgSpec *specs,
                          int count)
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < count; i++)
            if (specs[i].positional == (pass == 0)) add_argument(text, command, form, &specs[i]);
}

/* Print a form; arguments shared with other commands follow once, after all forms. */
static void add_form(WrText *text, const WrCommand *command, int form)
{
    WrArgSpec specs[WR_ARGS_MAX];
    WrForm row;
    WrText usage = { 0 };
    int count = wr_command_specs(command, form, specs);
    if (form >= 0) count = help_own(command, count);
    add_usage(command, form, specs, count, &usage);
    if (form >= 0 && command->more) wr_text_add(&usage, " ...");
    wr_text_add(text, "  ");
    add_wrapped(text, wr_text_get(&usage), 2, 4, 96);
    wr_text_fini(&usage);
    if (form >= 0 && command->form(form, &row)) {
        wr_text_add(text, "    ");
        add_wrapped(text, row.help, 4, 4, 96);
    }
    add_arguments(text, command, form, specs, count);
}

static void add_common(WrText *text, const WrCommand *command)
{
    int count = 0;
    while (command->more[count].name) count++;
    wr_text_add(text, "\n  ... are, for all of them\n");
    add_arguments(text, command, -1, command->more, count);
}

static bool is_called(const WrArgSpec *spec, const char *name)
{
    return strcmp(spec->name, name) == 0 || (spec->also && strcmp(spec->also, name) == 0);
}

/* True if this form of the command has an argument of that name. */
static bool has_argument(const WrCommand *command, int form, const char *name)
{
    WrArgSpec specs[WR_ARGS_MAX];
    int count = wr_command_specs(command, form, specs);
    for (int i = 0; i < count; i++)
        if (is_called(&specs[i], name)) return true;
    return false;
}

bool wr_help_has_part(const WrCommand *command, const char *part)
{
    WrForm row;
    if (!command->form) return has_argument(command, -1, part);
    for (int i = 0; command->form(i, &row); i++)
        if (strcmp(row.name, part) == 0 || has_argument(command, i, part)) return true;
    return false;
}

/* Words accepted by wr_help_has_part: forms, then the arguments of each form. */
typedef struct Parts {
    const WrCommand *command;
    WrForm form;
    WrArgSpec specs[WR_ARGS_MAX];
} Parts;

static const char *part_at(const void *ctx, int i)
{
    Parts *parts = (Parts *)ctx;
    const WrCommand *command = parts->command;
    int forms = 0;
    while (command->form && command->form(forms, &parts->form)) {
        if (i-- == 0) return parts->form.name;
        forms++;
    }
    for (int f = command->form ? 0 : -1; f < forms; f++) {
        int count = wr_command_specs(command, f, parts->specs);
        if (i < count) return parts->specs[i].name;
        i -= count;
    }
    return NULL;
}

static bool fail_part(const WrCommand *command, const char *part, WrError *err)
{
    Parts parts = { .command = command };
    WrText near = { 0 };
    char excerpt[WR_EXCERPT_SIZE];
    wr_excerpt(part, excerpt);
    if (wr_suggest(part, part_at, &parts, &near))
        wr_fail(err, "help %s: unknown argument \"%s\": did you mean %s?", command->name, excerpt,
                wr_text_get(&near));
    else
        wr_fail(err, "help %s: unknown argument \"%s\": `wrinkle help %s` lists them all",
                command->name, excerpt, command->name);
    wr_text_fini(&near);
    return false;
}

/* Print the rows of one argument as in `help`. */
static void add_named_arguments(WrText *text, const WrCommand *command, int form, const char *name)
{
    WrArgSpec specs[WR_ARGS_MAX];
    int count = wr_command_specs(command, form, specs);
    for (int i = 0; i < count; i++)
        if (is_called(&specs[i], name)) add_argument(text, command, form, &specs[i]);
}

/* Print one argument of all forms; forms with identical rows share one heading. */
static void add_argument_of_forms(WrText *text, const WrCommand *command, const char *name)
{
    WrText rows = { 0 }, done = { 0 }, other = { 0 };
    WrForm row;
    for (int i = 0; command->form(i, &row); i++) {
        if (!has_argument(command, i, name)) continue;
        wr_text_clear(&rows);
        add_named_arguments(&rows, command, i, name);
        if (strstr(wr_text_get(&done), wr_text_get(&rows))) continue;
        wr_text_add(&done, wr_text_get(&rows));
        WrText forms = { 0 };
        wr_text_addf(&forms, "%s %s", command->name, row.name);
        for (int k = i + 1; command->form(k, &row); k++) {
            wr_text_clear(&other);
            add_named_arguments(&other, command, k, name);
            if (strcmp(wr_text_get(&other), wr_text_get(&rows)) == 0)
                wr_text_addf(&forms, ", %s", row.name);
        }
        wr_text_add(text, "  ");
        add_wrapped(text, wr_text_get(&forms), 2, 4, 96);
        wr_text_add(text, wr_text_get(&rows));
        wr_text_fini(&forms);
    }
    wr_text_fini(&other);
    wr_text_fini(&done);
    wr_text_fini(&rows);
}

/* Print one argument of all commands; false if none has it. */
static bool add_argument_of_commands(WrText *text, const char *name)
{
    const size_t before = text->length;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        if (command->form) {
            add_argument_of_forms(text, command, name);
        } else if (has_argument(command, -1, name)) {
            wr_text_addf(text, "  %s\n", command->name);
            add_named_arguments(text, command, -1, name);
        }
    }
    return text->length > before;
}

bool wr_help_command_part(const WrCommand *command, const char *part, WrText *text, WrError *err)
{
    WrForm row;
    if (!wr_help_has_part(command, part)) return fail_part(command, part, err);
    int form = wr_command_form(command, part, &row);
    if (form >= 0) {
        add_form(text, command, form);
        if (command->more) add_common(text, command);
    } else if (command->form) {
        add_argument_of_forms(text, command, part);
    } else {
        wr_text_addf(text, "  %s\n", command->name);
        add_named_arguments(text, command, -1, part);
    }
    return true;
}

bool wr_help_command(const char *name, WrText *text, WrError *err)
{
    const WrCommand *command = wr_command_find(name);
    if (!command && add_argument_of_commands(text, name)) return true;
    if (!command) {
        wr_fail_verb(name, err);
        wr_error_prefix(err, "%s: ", "help"); /* the command's name is not translated */
        return false;
    }
    wr_text_addf(text, "%s - %s (%s)\n\n", command->name, command->help,
                 wr_class_names[command->kind]);
    WrForm row;
    if (!command->form) add_form(text, command, -1);
    for (int i = 0; command->form && command->form(i, &row); i++) {
        if (i > 0) wr_text_add(text, "\n");
        add_form(text, command, i);
    }
    if (command->form && command->more) add_common(text, command);
    if (command->details) {
        wr_text_add(text, "\n  ");
        add_wrapped(text, command->details, 2, 2, 96);
    }
    wr_text_addf(text, "\n  example: %s\n", command->example);
    return true;
}

void wr_help_overview(WrText *text)
{
    WR_ROWS(titles);
    static const char *const titles[WR_CLASS_COUNT] = {
        [WR_ROW(WR_CLASS_EDIT)] = "Edits of the table",
        [WR_ROW(WR_CLASS_SCENE)] = "The scene",
        [WR_ROW(WR_CLASS_VIEW)] = "Views",
        [WR_ROW(WR_CLASS_CHOICE)] = NULL,
        [WR_ROW(WR_CLASS_OUTPUT)] = "Files",
        [WR_ROW(WR_CLASS_HISTORY)] = "History",
    };
    WR_ROWS_END(titles, WR_CLASS_COUNT);
    for (int kind = 0; kind < WR_CLASS_COUNT; kind++) {
        if (!titles[kind]) continue; /* only forms of commands of other classes */
        wr_text_addf(text, "%s%s\n", kind ? "\n" : "", titles[kind]);
        for (int i = 0; i < wr_command_count; i++)
            if ((int)wr_commands[i]->kind == kind)
                wr_text_addf(text, "  %-10s %s\n", wr_commands[i]->name, wr_commands[i]->help);
    }
    wr_text_add(text, "\nOne command a line: verb value... name=value...   # comment\n"
                      "Positions are u,v in 0..1 (v up), lengths in the table are texels, angles "
                      "degrees,\ncolours linear r,g,b. `wrinkle help VERB` tells more.\n");
}

/* ---- JSON ---- */

/* Print ,"name": JSON is built front to back: a comma precedes every key whose predecessor is not an opening bracket. */
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
static void add_meanings_json(WrText *text, const WrArgSpec *spec)
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
        add_meanings_json(text, spec);
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
    help_usage(command, -1, &usage);
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

void wr_help_json_command(const WrCommand *command, WrText *text)
{
    add_command(text, command);
    wr_text_add(text, "\n");
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

/* ---- Markdown ---- */

void wr_help_markdown_cell(WrText *text, const char *words)
{
    for (const char *p = words; *p; p++)
        if (strchr("|*<\\", *p)) wr_text_addf(text, "\\%c", *p);
        else wr_text_add_n(text, p, 1);
}

/* Print the meanings of the choice words. */
static void add_meanings_markdown(WrText *text, const WrArgSpec *spec)
{
    for (int i = 0; spec->explain && wr_arg_word(spec, i); i++) {
        WrText meaning = { 0 };
        spec->explain(i, &meaning);
        wr_text_addf(text, "%s `%s` ", i ? ";" : ":", wr_arg_word(spec, i));
        wr_help_markdown_cell(text, wr_text_get(&meaning));
        wr_text_fini(&meaning);
    }
}

static void add_argument_markdown(WrText *text, const WrCommand *command, int form,
                                  const WrArgSpec *spec)
{
    WrText words = { 0 };
    wr_text_add(text, "| `");
    help_argument_name(spec, text);
    wr_text_add(text, spec->required ? "` | required: " : "` | ");
    help_argument(command, form, spec, &words);
    wr_help_markdown_cell(text, wr_text_get(&words));
    add_meanings_markdown(text, spec);
    wr_text_add(text, " |\n");
    wr_text_fini(&words);
}

/* head: title of the first column. Without arguments nothing is printed. */
static void add_arguments_markdown(WrText *text, const WrCommand *command, int form,
                                   const char *head, const WrArgSpec *specs, int count)
{
    if (count == 0) return;
    wr_text_addf(text, "\n| %s | |\n| --- | --- |\n", head);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < count; i++)
            if (specs[i].positional == (pass == 0))
                add_argument_markdown(text, command, form, &specs[i]);
}

static void add_form_markdown(WrText *text, const WrCommand *command, int form)
{
    WrArgSpec specs[WR_ARGS_MAX];
    WrForm row;
    int count = wr_command_specs(command, form, specs);
    if (form >= 0 && command->form(form, &row)) {
        count = help_own(command, count);
        wr_text_addf(text, "\n### %s %s\n\n", command->name, row.name);
        wr_help_markdown_cell(text, row.help);
        wr_text_add(text, ".\n");
    }
    add_arguments_markdown(text, command, form, "argument", specs, count);
}

static void add_common_markdown(WrText *text, const WrCommand *command)
{
    int count = 0;
    while (command->more[count].name) count++;
    add_arguments_markdown(text, command, -1, "all of them also take", command->more, count);
}

bool wr_help_markdown(const char *name, WrText *text, WrError *err)
{
    WrText plain = { 0 };
    const WrCommand *command = wr_command_find(name);
    bool known = wr_help_command(name, &plain, err); /* the error suggests similar names */
    wr_text_fini(&plain);
    if (!known) return false;
    wr_text_addf(text, "## %s\n\n", command->name);
    wr_help_markdown_cell(text, command->help);
    wr_text_addf(text, " (%s). For example\n\n    %s\n", wr_class_names[command->kind],
                 command->example);
    if (command->details) wr_text_add(text, "\n");
    if (command->details) wr_help_markdown_cell(text, command->details);
    if (command->details) wr_text_add(text, "\n");
    WrForm row;
    if (!command->form) add_form_markdown(text, command, -1);
    for (int i = 0; command->form && command->form(i, &row); i++)
        add_form_markdown(text, command, i);
    if (command->form && command->more) add_common_markdown(text, command);
    return true;
}

void wr_help_markdown_verbs(WrText *text)
{
    wr_text_add(text, "| verb | class | |\n| --- | --- | --- |\n");
    for (int i = 0; i < wr_command_count; i++) {
        wr_text_addf(text, "| `%s` | %s | ", wr_commands[i]->name,
                     wr_class_names[wr_commands[i]->kind]);
        wr_help_markdown_cell(text, wr_commands[i]->help);
        wr_text_add(text, " |\n");
    }
}
