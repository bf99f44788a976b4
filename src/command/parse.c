#include "command/command_line.h"
#include "command/parse_fail.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"

#include <ctype.h>
#include <string.h>

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
            return wr_fail(err, "a backslash in quotes must stand before a quote or a backslash");
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
    wr_call_add_title(call, &where);
    wr_text_addf(&where, ": %s", spec->name);
    bool good = wr_arg_parse(spec, wr_text_get(&where), value, arg, err);
    wr_text_fini(&where);
    if (!good && spec->positional && !spec->required && wr_belongs_to_name(call, value))
        return wr_fail_extra(call, NULL, value, err);
    return good;
}

/* Assign one word to its argument. *last: argument of the previous word, then of this one. */
static bool assign(WrCall *call, const char *name, const char *value, WrArg **last, WrError *err)
{
    WrArg *arg = name ? find_named(call, name) : next_positional(call);
    if (!arg && name) return wr_fail_name(call, name, value, err);
    if (!arg) return wr_fail_extra(call, *last, value, err);
    *last = arg;
    if (!arg->given) return take_argument(call, arg, value, err);
    WrText title = { 0 };
    wr_call_add_title(call, &title);
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
        return wr_fail_missing(call, spec, err);
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
        else wr_fail_form(command, word.length ? wr_text_get(&word) : NULL, rest, err);
    }
    wr_text_fini(&word);
    return call;
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
    if (!call) return false;
    if (!read_words(call, p, call->command->form != NULL, err) || !check_missing(call, open, err)) {
        wr_call_free(call);
        return false;
    }
    for (int i = 0; i < call->count; i++)
        if (!call->args[i].given) set_fallback(&call->specs[i], &call->args[i]);
    *out = call;
    return true;
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
    wr_call_add_title(call, text);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < call->count; i++) {
            const WrArgSpec *spec = &call->specs[i];
            if (!call->args[i].given || spec->positional != (pass == 0)) continue;
            wr_text_add(text, " ");
            if (!spec->positional) wr_text_addf(text, "%s=", spec->name);
            wr_arg_print(spec, &call->args[i], text);
        }
}
