/* Parser of command lines: values are read by their argument's row, then checked; a failure names the argument and
   the remedy. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "system/path.h"

#include <ctype.h>
#include <string.h>

/* ---- error messages for lines that do not parse ---- */

#define NAMED_MAX 3 /* arguments that one message suggests */
#define FORMS_MAX 2 /* forms of other commands in one message */

/* ---- lists of names ---- */

static const char *command_name(const void *ctx, int i)
{
    (void)ctx;
    return i < wr_command_count ? wr_commands[i]->name : NULL;
}

/* Arguments that are written by name in a line. */
static const char *argument_name(const void *ctx, int i)
{
    const WrCall *call = ctx;
    for (int k = 0; k < call->count; k++)
        if (!call->specs[k].positional && i-- == 0) return call->specs[k].name;
    return NULL;
}

/* A command with its forms, and storage for one form. */
typedef struct FormList {
    const WrCommand *command;
    WrForm *form;
} FormList;

static const char *form_name(const void *ctx, int i)
{
    const FormList *list = ctx;
    return list->command->form(i, list->form) ? list->form->name : NULL;
}

/* List separator: ", " between items, " or " before the last of `count`. */
static const char *joint(int i, int count)
{
    return i == 0 ? "" : i == count - 1 ? " or " : ", ";
}

/* "surface sphere or solid sphere": the commands that have a form of this name. False if there are none or too
   many. */
static bool add_commands_of_form(const char *name, WrText *text)
{
    int found[FORMS_MAX], count = 0;
    WrForm form;
    for (int i = 0; i < wr_command_count; i++)
        if (wr_commands[i]->form && wr_command_form(wr_commands[i], name, &form) >= 0) {
            if (count == FORMS_MAX) return false;
            found[count++] = i;
        }
    for (int k = 0; k < count; k++)
        wr_text_addf(text, "%s%s %s", joint(k, count), wr_commands[found[k]]->name, name);
    return count > 0;
}

/* ---- titles ---- */

static void call_add_title(const WrCall *call, WrText *text)
{
    wr_text_add(text, call->command->name);
    if (*call->form_name) wr_text_addf(text, " %s", call->form_name);
}

/* "it takes radius= strength=", or a text for commands without named arguments. */
static void add_names(const WrCall *call, WrText *text)
{
    for (int i = 0; argument_name(call, i); i++)
        wr_text_addf(text, "%s%s=", i ? " " : "", argument_name(call, i));
}

/* ---- verbs and forms ---- */

bool wr_fail_verb(const char *verb, WrError *err)
{
    char excerpt[WR_EXCERPT_SIZE];
    WrText near = { 0 };
    wr_excerpt(verb, excerpt);
    if (add_commands_of_form(verb, &near) || wr_suggest(verb, command_name, NULL, &near))
        wr_fail(err, "unknown command \"%s\": did you mean %s?", excerpt, wr_text_get(&near));
    else if (strchr(verb, '='))
        wr_fail(err, "unknown command \"%s\": the command comes first, then its names with values",
                excerpt);
    else wr_fail(err, "unknown command \"%s\": `wrinkle help` lists them all", excerpt);
    wr_text_fini(&near);
    return false;
}

/* "camera perspective or camera save": the forms that have an argument of this name (`length` bytes). */
static bool add_forms_of_argument(const WrCommand *command, const char *name, size_t length,
                                  WrText *text)
{
    WrForm form;
    WrArgSpec specs[WR_ARGS_MAX];
    int found = 0;
    for (int i = 0; found < FORMS_MAX && command->form(i, &form); i++) {
        int count = wr_command_specs(command, i, specs);
        for (int k = 0; k < count; k++)
            if (!specs[k].positional && strlen(specs[k].name) == length &&
                strncmp(specs[k].name, name, length) == 0) {
                wr_text_addf(text, "%s%s %s", found++ ? " or " : "", command->name, form.name);
                break;
            }
    }
    return found > 0;
}

/* "export stl cup.stl": the form that is called as this file name ends. */
static bool add_form_of_file(const WrCommand *command, const char *word, WrText *text)
{
    WrForm form;
    char ending[16];
    if (wr_command_form(command, wr_path_ending(word, ending), &form) < 0) return false;
    wr_text_addf(text, "%s %s %s", command->name, form.name, word);
    return true;
}

static bool add_command(const char *word, WrText *text)
{
    if (!wr_command_find(word)) return false;
    wr_text_add(text, word);
    return true;
}

/* "light directional to=-1,1,2": the first form with an argument that accepts this value. */
static bool add_form_for_value(const WrCommand *command, const char *value, WrText *text);

/* The form that `rest` contains as "form=" or "=form"; -1 if none. */
static int form_with_sign(const WrCommand *command, const char *rest, WrForm *form)
{
    for (int i = 0; command->form(i, form); i++) {
        const size_t length = strlen(form->name);
        for (const char *at = rest; (at = strstr(at, form->name)); at++) {
            const char before = at > rest ? at[-1] : ' ', after = at[length];
            if ((before == ' ' && after == '=') ||
                (before == '=' && (after == ' ' || after == '\0')))
                return i;
        }
    }
    return -1;
}

/* The command has no form of this name. word: NULL if the line names none. `rest` is the line after the verb; it may
   contain the form as a name ("adjust offset=3") or as a value ("light type=point"). */
static bool fail_form(const WrCommand *command, const char *word, const char *rest, WrError *err)
{
    WrForm form;
    const FormList list = { command, &form };
    WrText names = { 0 }, near = { 0 };
    char excerpt[WR_EXCERPT_SIZE] = "";
    for (int i = 0; form_name(&list, i); i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "", form_name(&list, i));
    if (word) wr_excerpt(word, excerpt);
    if (!word && form_with_sign(command, rest, &form) >= 0)
        wr_fail(err, "%s: \"%s\" stands without =: did you mean %s %s? It must be one of %s",
                command->name, form.name, command->name, form.name, wr_text_get(&names));
    else if (!word && add_forms_of_argument(command, rest + strspn(rest, " \t"),
                                            strcspn(rest + strspn(rest, " \t"), "= \t"), &near))
        wr_fail(err, "%s: %s is missing: did you mean %s? It must be one of %s", command->name,
                command->form_word, wr_text_get(&near), wr_text_get(&names));
    else if (!word)
        wr_fail(err, "%s: %s is missing: one of %s", command->name, command->form_word,
                wr_text_get(&names));
    else if (add_form_of_file(command, word, &near) || wr_suggest(word, form_name, &list, &near) ||
             add_forms_of_argument(command, word, strlen(word), &near) ||
             add_commands_of_form(word, &near) || add_command(word, &near) ||
             add_form_for_value(command, word, &near))
        wr_fail(err, "%s: unknown %s \"%s\": did you mean %s? It must be one of %s", command->name,
                command->form_word, excerpt, wr_text_get(&near), wr_text_get(&names));
    else
        wr_fail(err, "%s: unknown %s \"%s\": must be one of %s", command->name, command->form_word,
                excerpt, wr_text_get(&names));
    wr_text_fini(&near);
    wr_text_fini(&names);
    return false;
}

/* ---- values ---- */

static bool accepts(const WrArgSpec *spec, const char *value)
{
    WrArg arg = { .choice = -1 };
    bool good = wr_arg_parse(spec, "", value, &arg, NULL);
    wr_arg_fini(&arg);
    return good;
}

static bool is_wordy(WrArgType type)
{
    return type == WR_ARG_PATH || type == WR_ARG_TEXT || type == WR_ARG_NAME ||
           type == WR_ARG_PRESET || type == WR_ARG_LAYER;
}

static const char *choice_word(const void *ctx, int i)
{
    return wr_arg_word(ctx, i);
}

/* Likelihood that a positional value is meant for an argument, best first. The order decides which suggestion wins, best
   first; a text argument accepts everything and therefore comes last. */
typedef enum Rank {
    RANK_REQUIRED, /* required, and accepts the value */
    RANK_WORD,     /* a choice that contains the word */
    RANK_NUMBERS,  /* accepts the numbers */
    RANK_MISTYPED, /* a choice with a similar word */
    RANK_TEXT,     /* accepts any text */
    RANK_NONE
} Rank;

static Rank rank_of(const WrCall *call, int i, const char *value)
{
    const WrArgSpec *spec = &call->specs[i];
    int places[WR_NEAREST_MAX];
    if (spec->positional || call->args[i].given || spec->type == WR_ARG_SHA256) return RANK_NONE;
    if (accepts(spec, value))
        return spec->required                ? RANK_REQUIRED
               : spec->type == WR_ARG_CHOICE ? RANK_WORD
               : is_wordy(spec->type)        ? RANK_TEXT
                                             : RANK_NUMBERS;
    bool mistyped = spec->type == WR_ARG_CHOICE && wr_nearest(value, choice_word, spec, places) > 0;
    return mistyped ? RANK_MISTYPED : RANK_NONE;
}

static Rank best_rank(const WrCall *call, const char *value)
{
    Rank best = RANK_NONE;
    for (int i = 0; i < call->count; i++) {
        Rank rank = rank_of(call, i, value);
        if (rank < best) best = rank;
    }
    return best;
}

/* True if the value fits only a named argument, though a positional argument is still free. */
static bool belongs_to_name(const WrCall *call, const char *value)
{
    return best_rank(call, value) <= RANK_NUMBERS;
}

/* "height=0.1 or width=0.1": the first `most` arguments of that rank, at most NAMED_MAX. */
static void add_named(const WrCall *call, const char *value, Rank rank, int most, WrText *text)
{
    int found[NAMED_MAX], count = 0;
    for (int i = 0; i < call->count && count < most; i++)
        if (rank_of(call, i, value) == rank) found[count++] = i;
    for (int k = 0; k < count; k++) {
        const WrArgSpec *spec = &call->specs[found[k]];
        wr_text_addf(text, "%s%s=", joint(k, count), spec->name);
        if (rank == RANK_MISTYPED) wr_suggest(value, choice_word, spec, text);
        else wr_text_add_word(text, value);
    }
}

static bool add_form_for_value(const WrCommand *command, const char *value, WrText *text)
{
    WrForm form;
    if (!isdigit((unsigned char)*value) && !strchr("+-.", *value)) return false;
    WrCall *call = wr_alloc(1, sizeof *call);
    bool found = false;
    for (int i = 0; !found && command->form(i, &form); i++) {
        call->count = wr_command_specs(command, i, call->specs);
        bool placed = false; /* the value fits a positional argument */
        for (int k = 0; k < call->count; k++) placed |= call->specs[k].positional;
        Rank rank = best_rank(call, value);
        found = !placed && rank <= RANK_NUMBERS;
        if (!found) continue;
        wr_text_addf(text, "%s %s ", command->name, form.name);
        add_named(call, value, rank, 1, text);
    }
    wr_free(call);
    return found;
}

/* The argument whose name is `value`, or its beginning before a colon, or `value` without leading dashes: a name
   separated from its value. NULL: none. */
static const WrArgSpec *name_apart(const WrCall *call, const char *value)
{
    const char *name = value + strspn(value, "-");
    const size_t length = strcspn(name, ":");
    for (int i = 0; i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        if (!spec->positional && strlen(spec->name) == length &&
            strncmp(spec->name, name, length) == 0)
            return spec;
    }
    return NULL;
}

/* The text of `last` and its continuation `value`, in quotes: "font=\"DejaVu Sans\"". */
static void add_quoted(const WrCall *call, const WrArg *last, const char *value, WrText *text)
{
    const WrArgSpec *spec = &call->specs[last - call->args];
    WrText whole = { 0 };
    /* Single quotes, which a shell accepts, are no quotes here. */
    const size_t length = strlen(value);
    const bool single = *last->text == '\'' && length > 0 && value[length - 1] == '\'';
    wr_text_addf(&whole, "%s %.*s", last->text + single, (int)(length - single), value);
    if (!spec->positional) wr_text_addf(text, "%s=", spec->name);
    wr_text_add_word(text, wr_text_get(&whole));
    wr_text_fini(&whole);
}

/* A positional value too many. Suggests argument names for it. If the argument before it, `last`, is a text, suggests
   quotes around both. last: NULL for none. */
static bool fail_extra(const WrCall *call, const WrArg *last, const char *value, WrError *err)
{
    WrText title = { 0 }, names = { 0 }, right = { 0 };
    char excerpt[WR_EXCERPT_SIZE];
    const bool number = isdigit((unsigned char)*value) || strchr("+-.", *value);
    const bool after_text =
        last && last->text && is_wordy(call->specs[last - call->args].type) && !number;
    Rank rank = best_rank(call, value);
    call_add_title(call, &title);
    add_names(call, &names);
    wr_excerpt(value, excerpt);
    const WrArgSpec *apart = name_apart(call, value);
    if (apart) {
        wr_arg_expectation(apart, &right);
        wr_fail(err, "%s: \"%s\" stands apart from its value: write %s=VALUE, without spaces: %s",
                wr_text_get(&title), excerpt, apart->name, wr_text_get(&right));
    } else if (last && call->specs[last - call->args].type == WR_ARG_LIST &&
               accepts(&call->specs[last - call->args], value)) {
        wr_fail(err, "%s: \"%s\" is one value too many: %s= goes on after a semicolon: ...;%s",
                wr_text_get(&title), excerpt, call->specs[last - call->args].name, excerpt);
    } else if (after_text && rank > RANK_WORD) {
        add_quoted(call, last, value, &right);
        wr_fail(err, "%s: \"%s\" is one value too many: a text with spaces goes in quotes: %s",
                wr_text_get(&title), excerpt, wr_text_get(&right));
    } else if (rank < RANK_NONE && *value) {
        add_named(call, value, rank, NAMED_MAX, &right);
        wr_fail(err, "%s: \"%s\" needs a name: did you mean %s? It takes %s", wr_text_get(&title),
                excerpt, wr_text_get(&right), wr_text_get(&names));
    } else if (names.length) {
        wr_fail(err, "%s: \"%s\" is one value too many: further ones need a name: %s",
                wr_text_get(&title), excerpt, wr_text_get(&names));
    } else {
        wr_fail(err, "%s: \"%s\" is one value too many", wr_text_get(&title), excerpt);
    }
    wr_text_fini(&right);
    wr_text_fini(&names);
    wr_text_fini(&title);
    return false;
}

/* ---- names ---- */

/* True if the text begins with this whole word, or with "the" and this word. */
static bool begins_with_word(const char *text, const char *word)
{
    const size_t length = strlen(word);
    if (strncmp(text, "the ", 4) == 0) text += 4;
    return length > 2 && strncmp(text, word, length) == 0 && !isalnum((unsigned char)text[length]);
}

/* The only argument whose help begins with the word, such as R= of a sphere for "radius"; NULL for none or
   several. */
static const WrArgSpec *explained_by(const WrCall *call, const char *word)
{
    const WrArgSpec *found = NULL;
    for (int i = 0; i < call->count; i++) {
        if (call->specs[i].positional || !begins_with_word(call->specs[i].help, word)) continue;
        if (found) return NULL;
        found = &call->specs[i];
    }
    return found;
}

/* A free positional argument that accepts the value. */
static const WrArgSpec *place_for(const WrCall *call, const char *value)
{
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].positional && !call->args[i].given)
            return accepts(&call->specs[i], value) ? &call->specs[i] : NULL;
    return NULL;
}

/* A missing required positional argument with a component of this name ("x,y,z" for "y"); else any missing one. */
static const WrArgSpec *empty_place(const WrCall *call, const char *part)
{
    for (int i = 0; i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        if (!spec->positional || call->args[i].given) continue;
        const char *at = strstr(spec->name, part);
        const size_t length = strlen(part);
        const bool holds =
            at && (at == spec->name || at[-1] == ',') && (at[length] == ',' || at[length] == '\0');
        if (holds || spec->required) return spec;
    }
    return NULL;
}

/* "cells= or size=": similar names. */
static bool add_near_names(const WrCall *call, const char *name, WrText *text)
{
    int places[WR_NEAREST_MAX];
    const int count = wr_nearest(name, argument_name, call, places);
    for (int k = 0; k < count; k++)
        wr_text_addf(text, "%s%s=", k ? " or " : "", argument_name(call, places[k]));
    return count > 0;
}

/* No argument has this name. Suggests a similar name, or the argument that the value fits. */
static bool fail_name(const WrCall *call, const char *name, const char *value, WrError *err)
{
    char excerpt[WR_EXCERPT_SIZE];
    WrText names = { 0 }, title = { 0 }, near = { 0 };
    add_names(call, &names);
    call_add_title(call, &title);
    wr_excerpt(name, excerpt);
    const WrArgSpec *place = place_for(call, value), *other = explained_by(call, name);
    const bool nearly = add_near_names(call, name, &near);
    const WrArgSpec *empty = empty_place(call, name);
    if (!nearly && other) wr_text_addf(&near, "%s=", other->name);
    if (!nearly && place && (place->required || !other)) {
        WrText word = { 0 };
        wr_text_add_word(&word, value);
        wr_fail(err, "%s: unknown name \"%s\": %s has none: did you mean %s %s?",
                wr_text_get(&title), excerpt, place->name, wr_text_get(&title), wr_text_get(&word));
        wr_text_fini(&word);
    } else if (!nearly && !other && empty) {
        WrText right = { 0 };
        wr_arg_expectation(empty, &right);
        wr_fail(err, "%s: unknown name \"%s\": %s stands without a name: must be %s",
                wr_text_get(&title), excerpt, empty->name, wr_text_get(&right));
        wr_text_fini(&right);
    } else if (!names.length) {
        wr_fail(err,
                "%s: unknown name \"%s\": it takes no names (a file name that holds a = goes in "
                "quotes)",
                wr_text_get(&title), excerpt);
    } else if (nearly || other) {
        wr_fail(err, "%s: unknown name \"%s\": did you mean %s? It takes %s", wr_text_get(&title),
                excerpt, wr_text_get(&near), wr_text_get(&names));
    } else {
        wr_fail(err, "%s: unknown name \"%s\": it takes %s", wr_text_get(&title), excerpt,
                wr_text_get(&names));
    }
    wr_text_fini(&near);
    wr_text_fini(&names);
    wr_text_fini(&title);
    return false;
}

/* A required argument is missing. */
static bool fail_missing(const WrCall *call, const WrArgSpec *spec, WrError *err)
{
    WrText right = { 0 }, title = { 0 };
    wr_arg_expectation(spec, &right);
    call_add_title(call, &title);
    wr_fail(err, "%s: %s%s is missing (%s): must be %s", wr_text_get(&title), spec->name,
            spec->positional ? "" : "=", spec->help, wr_text_get(&right));
    wr_text_fini(&right);
    wr_text_fini(&title);
    return false;
}

void wr_call_add_hint(const WrCall *call, WrError *err)
{
    WrFileInfo info;
    for (int i = 0; err && i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        if (spec->type != WR_ARG_PATH || !spec->words || !wr_call_names_file(call, i)) continue;
        WrText near = { 0 };
        if (!wr_path_info(call->args[i].text, &info) &&
            wr_suggest(call->args[i].text, wr_word_of_array, spec->words, &near)) {
            const WrError whole = *err;
            wr_fail(err, "%s: did you mean %s?", wr_error_message(&whole), wr_text_get(&near));
        }
        wr_text_fini(&near);
    }
}

/* ---- words ---- */

static bool is_in_name(char c)
{
    return (unsigned char)c < 128 && (isalnum((unsigned char)c) || c == '_' || c == '-');
}

/* Take the name of "name=" at *p, or NULL (*p is then unchanged). The caller frees it. */
static char *take_name(const char **p)
{
    const char *s = *p;
    if (!is_in_name(*s) || isdigit((unsigned char)*s) || *s == '-') return NULL;
    while (is_in_name(*s)) s++;
    if (*s != '=') return NULL;
    char *name = wr_strndup(*p, (size_t)(s - *p));
    *p = s + 1;
    return name;
}

/* Grammar of a line: verb (value | name=value)* [# comment]; a value is a word without blanks or "..." with \" and \\. There
   is one line per command, so scripts, journals and history need no other format. */
static bool ends_word(char c)
{
    return c == '\0' || c == ' ' || c == '\t' || c == '#';
}

/* Read "..." with \" and \\; *p is at the opening quote. */
static bool take_quoted(const char **p, WrText *value, WrError *err)
{
    const char *s = *p + 1;
    for (; *s && *s != '"'; s++) {
        if (*s == '\\' && s[1] != '"' && s[1] != '\\')
            return wr_fail(err,
                           "in double quotes, write \\\\ for a backslash and \\\" for a quote");
        if (*s == '\\') s++;
        wr_text_add_n(value, s, 1);
    }
    if (!*s) return wr_fail(err, "a quote is not closed");
    if (!ends_word(s[1])) return wr_fail(err, "a closing quote must be followed by a space");
    *p = s + 1;
    return true;
}

/* Read one word's value; *p is at its first byte. */
static bool take_value(const char **p, WrText *value, WrError *err)
{
    wr_text_clear(value);
    if (**p == '"') return take_quoted(p, value, err);
    const char *s = *p;
    while (!ends_word(*s) && *s != '"') s++;
    if (*s == '"') return wr_fail(err, "a quote may only open a value");
    wr_text_add_n(value, *p, (size_t)(s - *p));
    *p = s;
    return true;
}

static const char *skip_blanks(const char *p)
{
    while (*p == ' ' || *p == '\t') p++;
    return p;
}

/* A command is one line: control characters are an error, or the file is not text. */
static bool check_bytes(const char *line, WrError *err)
{
    for (const char *p = line; *p; p++)
        if (((unsigned char)*p < 0x20 && *p != '\t') || *p == 0x7F)
            return wr_fail(err,
                           "a command is one line of text: it holds the control character 0x%02x",
                           (unsigned char)*p);
    return true;
}

/* ---- a line ---- */

/* Set the default values. */
static void set_fallback(const WrArgSpec *spec, WrArg *arg)
{
    WrText text = { 0 };
    wr_arg_fallback_print(spec, &text);
    WrError unused;
    if (text.length && wr_arg_parse(spec, "", wr_text_get(&text), arg, &unused)) arg->given = false;
    wr_text_fini(&text);
}

static WrCall *new_call(const WrCommand *command, int form, const char *name)
{
    WrCall *call = wr_alloc(1, sizeof *call);
    call->command = command;
    call->form = form;
    call->form_name = name;
    if (command) call->count = wr_command_specs(command, form, call->specs);
    for (int i = 0; i < WR_ARGS_MAX; i++) call->args[i].choice = -1;
    return call;
}

/* Target of the next positional value; NULL past the last. */
static WrArg *next_positional(WrCall *call)
{
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].positional && !call->args[i].given) return &call->args[i];
    return NULL;
}

static WrArg *find_named(WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        if ((!spec->positional && strcmp(spec->name, name) == 0) ||
            (spec->also && strcmp(spec->also, name) == 0))
            return &call->args[i];
    }
    return NULL;
}

/* Parse a value of this argument. If the argument is optional and the value fits only a named one, the error names
   that one. */
static bool take_argument(WrCall *call, WrArg *arg, const char *value, WrError *err)
{
    const WrArgSpec *spec = &call->specs[arg - call->args];
    WrText where = { 0 };
    call_add_title(call, &where);
    wr_text_addf(&where, ": %s", spec->name);
    bool good = wr_arg_parse(spec, wr_text_get(&where), value, arg, err);
    wr_text_fini(&where);
    if (!good && spec->positional && !spec->required && belongs_to_name(call, value))
        return fail_extra(call, NULL, value, err);
    return good;
}

/* Assign one word to its argument. *last: argument of the previous word, then of this one. */
static bool assign(WrCall *call, const char *name, const char *value, WrArg **last, WrError *err)
{
    WrArg *arg = name ? find_named(call, name) : next_positional(call);
    if (!arg && name) return fail_name(call, name, value, err);
    if (!arg) return fail_extra(call, *last, value, err);
    *last = arg;
    if (!arg->given) return take_argument(call, arg, value, err);
    WrText title = { 0 };
    call_add_title(call, &title);
    wr_fail(err, "%s: %s= is given twice", wr_text_get(&title), name);
    wr_text_fini(&title);
    return false;
}

/* Read the words from p. skip_form: skip the first positional value, which named the form. */
static bool read_words(WrCall *call, const char *p, bool skip_form, WrError *err)
{
    WrText value = { 0 };
    WrArg *last = NULL;
    bool good = true;
    for (p = skip_blanks(p); good && *p && *p != '#'; p = skip_blanks(p)) {
        char *name = take_name(&p);
        good =
            (!name || *p != '#' ||
             wr_fail(err, "%s= has no value: # begins a comment, unless it is in quotes", name)) &&
            take_value(&p, &value, err);
        if (!good) wr_error_prefix(err, "%s: ", call->command->name);
        else if (!name && skip_form) skip_form = false;
        else good = assign(call, name, wr_text_get(&value), &last, err);
        wr_free(name);
    }
    wr_text_fini(&value);
    return good;
}

/* The arguments that the words name are forgotten first, all of them, so that a second value for one is an error as in
   every line. */
static bool forget_named(WrCall *call, const char *p, WrError *err)
{
    WrText value = { 0 };
    bool good = true, placed = false;
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].type == WR_ARG_SHA256) wr_arg_fini(&call->args[i]);
    for (p = skip_blanks(p); good && *p && *p != '#'; p = skip_blanks(p)) {
        char *name = take_name(&p);
        WrArg *arg = name ? find_named(call, name) : NULL;
        if (arg) wr_arg_fini(arg);
        for (int i = 0; !name && !placed && i < call->count; i++)
            if (call->specs[i].positional) wr_arg_fini(&call->args[i]);
        placed |= !name;
        good = take_value(&p, &value, err);
        wr_free(name);
    }
    wr_text_fini(&value);
    return good;
}

/* The first positional value from p on, or "". */
static bool first_value(const char *p, WrText *value, WrError *err)
{
    for (p = skip_blanks(p); *p && *p != '#'; p = skip_blanks(p)) {
        char *name = take_name(&p);
        bool named = name != NULL;
        wr_free(name);
        if (!take_value(&p, value, err)) return false;
        if (!named) return true;
    }
    wr_text_clear(value);
    return true;
}

static bool check_missing(const WrCall *call, bool open, WrError *err)
{
    for (int i = 0; i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        if (!spec->required || call->args[i].given) continue;
        if (open && spec->type == WR_ARG_LIST) continue;
        return fail_missing(call, spec, err);
    }
    return true;
}

/* A call of the verb with its form, before its words are read. */
static WrCall *begin_call(const WrCommand *command, const char *rest, WrError *err)
{
    if (!command->form) return new_call(command, -1, "");
    WrText word = { 0 };
    WrForm form;
    WrCall *call = NULL;
    if (!first_value(rest, &word, err)) {
        wr_error_prefix(err, "%s: ", command->name);
    } else {
        int index = word.length ? wr_command_form(command, wr_text_get(&word), &form) : -1;
        if (index >= 0) call = new_call(command, index, form.name);
        else fail_form(command, word.length ? wr_text_get(&word) : NULL, rest, err);
    }
    wr_text_fini(&word);
    return call;
}

/* Read the words of a call from p on. On failure the call is freed. */
static bool finish_call(WrCall *call, const char *p, bool open, WrCall **out, WrError *err)
{
    if (!read_words(call, p, call->command->form != NULL, err) || !check_missing(call, open, err)) {
        wr_call_free(call);
        return false;
    }
    for (int i = 0; i < call->count; i++)
        if (!call->args[i].given) set_fallback(&call->specs[i], &call->args[i]);
    *out = call;
    return true;
}

bool wr_call_parse(const char *line, bool open, WrCall **out, WrError *err)
{
    if (!check_bytes(line, err)) return false;
    const char *p = skip_blanks(line);
    if (!*p || *p == '#') {
        *out = new_call(NULL, -1, "");
        return true;
    }
    WrText verb = { 0 };
    WrCall *call = NULL;
    if (take_value(&p, &verb, err)) {
        const WrCommand *command = wr_command_find(wr_text_get(&verb));
        if (command) call = begin_call(command, p, err);
        else wr_fail_verb(wr_text_get(&verb), err);
    }
    wr_text_fini(&verb);
    return call && finish_call(call, p, open, out, err);
}

bool wr_call_parse_words(const WrCommand *command, const char *words, WrCall **out, WrError *err)
{
    if (!check_bytes(words, err)) return false;
    WrCall *call = begin_call(command, words, err);
    return call && finish_call(call, words, false, out, err);
}

bool wr_call_change(WrCall *call, const char *words, WrError *err)
{
    if (!check_bytes(words, err) || !forget_named(call, words, err) ||
        !read_words(call, words, false, err) || !check_missing(call, false, err))
        return false;
    for (int i = 0; i < call->count; i++)
        if (!call->args[i].given) {
            wr_arg_fini(&call->args[i]);
            set_fallback(&call->specs[i], &call->args[i]);
        }
    return true;
}

/* ---- a command line within a command line ---- */

bool wr_check_layer_line(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    WrCall *call = NULL;
    if (!wr_call_parse(value, false, &call, err)) {
        wr_error_prefix(err, "%s=: ", name);
        return false;
    }
    const WrCommand *command = call->command;
    wr_call_free(call);
    if (command && command->generates) return true;
    WrText all = { 0 };
    for (int i = 0; i < wr_command_count; i++)
        if (wr_commands[i]->generates)
            wr_text_addf(&all, "%s%s", all.length ? ", " : "", wr_commands[i]->name);
    wr_fail(err, "%s=: \"%s\" generates no layer: must be a line of %s", name,
            command ? command->name : "", wr_text_get(&all));
    wr_text_fini(&all);
    return false;
}

static int inner_argument(const WrCall *call)
{
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].check == wr_check_layer_line && call->args[i].given) return i;
    return -1;
}

WrCall *wr_call_inner(const WrCall *call)
{
    const int i = inner_argument(call);
    WrCall *inner = NULL;
    return i >= 0 && wr_call_parse(call->args[i].text, false, &inner, NULL) ? inner : NULL;
}

void wr_call_visit(WrCall *call, WrCallVisit *visit, void *ctx)
{
    WrText text = { 0 };
    WrCall *inner = wr_call_inner(call);
    visit(call, ctx);
    if (!inner) return;
    visit(inner, ctx);
    wr_call_print(inner, &text);
    wr_call_set_text(call, call->specs[inner_argument(call)].name, wr_text_get(&text));
    wr_call_free(inner);
    wr_text_fini(&text);
}

void wr_call_free(WrCall *call)
{
    if (!call) return;
    for (int i = 0; i < WR_ARGS_MAX; i++) wr_arg_fini(&call->args[i]);
    wr_free(call);
}

void wr_call_print(const WrCall *call, WrText *text)
{
    if (!call->command) return;
    call_add_title(call, text);
    /* Positional values first, then names, each in the order of the row: two calls with equal arguments print equal lines. */
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < call->count; i++) {
            const WrArgSpec *spec = &call->specs[i];
            if (!call->args[i].given || spec->positional != (pass == 0)) continue;
            wr_text_add(text, " ");
            if (!spec->positional) wr_text_addf(text, "%s=", spec->name);
            wr_arg_print(spec, &call->args[i], text);
        }
}
