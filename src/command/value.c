#include "command/command_line.h"

#include "base/error.h"
#include "base/file.h"
#include "base/length_unit.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "document/document.h"
#include "surface/surface.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

WR_ROWS(wr_arg_type_names);
const char *const wr_arg_type_names[WR_ARG_TYPES] = {
    [WR_ROW(WR_ARG_NUMBER)] = "number", [WR_ROW(WR_ARG_SIZE)] = "size",
    [WR_ROW(WR_ARG_TUPLE)] = "tuple",   [WR_ROW(WR_ARG_LIST)] = "list",
    [WR_ROW(WR_ARG_CHOICE)] = "choice", [WR_ROW(WR_ARG_PATH)] = "path",
    [WR_ROW(WR_ARG_TEXT)] = "text",     [WR_ROW(WR_ARG_SHA256)] = "sha256",
    [WR_ROW(WR_ARG_NAME)] = "name",     [WR_ROW(WR_ARG_LAYER)] = "layer",
    [WR_ROW(WR_ARG_PRESET)] = "preset",
};
WR_ROWS_END(wr_arg_type_names, WR_ARG_TYPES);

const char *wr_arg_word(const WrArgSpec *spec, int i)
{
    return spec->words ? spec->words[i] : spec->choice(i);
}

int wr_arg_width(const WrArgSpec *spec)
{
    if (spec->type == WR_ARG_NUMBER) return 1;
    if (spec->type == WR_ARG_SIZE) return 2;
    return spec->components;
}

void wr_arg_fini(WrArg *arg)
{
    wr_free(arg->text);
    wr_free(arg->numbers);
    wr_free(arg->counts);
    *arg = (WrArg){ .choice = -1 };
}

/* Messages have limited space: at most 48 bytes, cut before a whole UTF-8 sequence (continuation bytes are 10xxxxxx). */
const char *wr_excerpt(const char *bytes, char buffer[WR_EXCERPT_SIZE])
{
    size_t n = strlen(bytes), keep = n;
    if (n > 48) {
        keep = 45;
        while (keep > 0 && ((unsigned char)bytes[keep] & 0xC0) == 0x80) keep--;
    }
    memcpy(buffer, bytes, keep);
    for (size_t i = 0; i < keep; i++)
        if ((unsigned char)buffer[i] < 0x20 || buffer[i] == 0x7F) buffer[i] = '?';
    strcpy(buffer + keep, keep < n ? "..." : "");
    return buffer;
}

/* ---- descriptions of allowed values ---- */

/* Powers of ten from a million on are written as such: "1e9". */
static void add_limit(WrText *text, double limit)
{
    const int power = fabs(limit) >= 1e6 ? (int)lround(log10(fabs(limit))) : 0;
    if (power > 0 && power < 23 && fabs(limit) == pow(10.0, power))
        wr_text_addf(text, "%s1e%d", limit < 0 ? "-" : "", power);
    else wr_text_add_number(text, limit);
}

static void add_range(WrText *text, double low, double high, bool above)
{
    if (low == -WR_BIG_HEIGHT && high == WR_BIG_HEIGHT) {
        wr_text_add(text, "-3.4e38..3.4e38");
        return;
    }
    if (above) {
        wr_message_addf(text, "above ");
        add_limit(text, low);
        wr_message_addf(text, ", up to ");
    } else {
        add_limit(text, low);
        wr_text_add(text, "..");
    }
    if (high == WR_BIG_HEIGHT) wr_text_add(text, "3.4e38");
    else add_limit(text, high);
}

static void add_choices(WrText *text, const WrArgSpec *spec)
{
    for (int i = 0; wr_arg_word(spec, i); i++)
        wr_text_addf(text, "%s%s", i ? ", " : "", wr_arg_word(spec, i));
}

/* The smaller number of numbers that a tuple of one of two lengths may have; else its only length. */
static int fewest_of(const WrArgSpec *spec)
{
    for (int n = 1; n < spec->components; n++)
        if (spec->counts == ((1U << n) | (1U << spec->components))) return n;
    return spec->components;
}

void wr_arg_expectation(const WrArgSpec *spec, WrText *text)
{
    switch (spec->type) {
    case WR_ARG_NUMBER:
        wr_message_addf(text, spec->whole ? "a whole number, " : "a number, ");
        break;
    case WR_ARG_SIZE:
        wr_message_addf(text, "%s, two whole numbers, each ", spec->shape ? spec->shape : "WxH");
        break;
    case WR_ARG_TUPLE:
        if (fewest_of(spec) < spec->components)
            wr_message_addf(text,
                            spec->whole ? "%d or %d whole numbers separated by commas"
                                        : "%d or %d numbers separated by commas",
                            fewest_of(spec), spec->components);
        else
            wr_message_addf(text,
                            spec->whole ? "%d whole numbers separated by commas"
                                        : "%d numbers separated by commas",
                            spec->components);
        if (!spec->parts) wr_message_addf(text, ", each ");
        break;
    case WR_ARG_LIST:
        if (spec->rows_low == spec->rows_high)
            wr_message_addf(text, "%d tuples separated by semicolons", spec->rows_low);
        else wr_message_addf(text, "tuples separated by semicolons");
        if (!spec->parts) wr_message_addf(text, ", each of %d numbers ", spec->components);
        break;
    case WR_ARG_CHOICE:
        wr_message_addf(text, "one of ");
        add_choices(text, spec);
        return;
    case WR_ARG_PATH: wr_message_addf(text, "a file name"); return;
    case WR_ARG_TEXT:
        wr_message_addf(text, "%s", spec->shape ? spec->shape : WR_MESSAGE("a text"));
        return;
    case WR_ARG_SHA256: wr_message_addf(text, "64 hexadecimal digits"); return;
    case WR_ARG_NAME: wr_message_addf(text, "a name of up to %d bytes", WR_LAYER_NAME_MAX); return;
    case WR_ARG_LAYER:
        if (spec->several)
            wr_message_addf(text,
                            "layers' numbers, from 1 at the bottom, or names, separated by commas, "
                            "or ranges of them, such as 2..5");
        else wr_message_addf(text, "a layer's number, from 1 at the bottom, or name");
        return;
    case WR_ARG_PRESET:
        wr_message_addf(text, "a preset's name, or a file that ends in .myb");
        return;
    case WR_ARG_TYPES: break;
    }
    if (!spec->parts) add_range(text, spec->low, spec->high, spec->above);
    if (spec->unit) wr_message_addf(text, " %s", spec->unit);
    if (spec->length) wr_message_addf(text, ", or with its unit, such as 2.5cm or 1in");
    if (spec->share) wr_message_addf(text, ", or a share of the side between -1 and 1");
}

void wr_arg_fallback_print(const WrArgSpec *spec, WrText *text)
{
    if (spec->fallback_text) wr_text_add(text, spec->fallback_text);
    if (!spec->fallback) return;
    int width = wr_arg_width(spec), rows = spec->type == WR_ARG_LIST ? spec->fallback_rows : 1;
    for (int i = 0; i < rows * width; i++) {
        if (i > 0) wr_text_add(text, i % width == 0 ? ";" : spec->type == WR_ARG_SIZE ? "x" : ",");
        wr_text_add_number(text, spec->fallback[i]);
    }
}

static const char *choice_word(const void *ctx, int i)
{
    return wr_arg_word(ctx, i);
}

/* "dab: radius=-1: must be a number, 0..1e9 texels" */
static bool fail_value(const WrArgSpec *spec, const char *where, const char *value, WrError *err)
{
    WrText right = { 0 };
    char excerpt[WR_EXCERPT_SIZE];
    wr_arg_expectation(spec, &right);
    wr_fail(err, "%s%s%s: must be %s", where, spec->positional ? " " : "=",
            wr_excerpt(value, excerpt), wr_text_get(&right));
    wr_text_fini(&right);
    return false;
}

/* ---- numbers ---- */

static bool in_range(const WrArgSpec *spec, int part, double value)
{
    double low = spec->low, high = spec->high;
    bool whole = spec->whole || spec->type == WR_ARG_SIZE;
    if (spec->parts) {
        low = spec->parts[part].low;
        high = spec->parts[part].high;
        whole = spec->parts[part].whole;
    }
    if (!(value >= low && value <= high)) return false;
    if (spec->above && value == low) return false;
    return !whole || value == floor(value) || (spec->share && fabs(value) < 1);
}

/* One number of a tuple, [text, text + length). */
static bool parse_part(const WrArgSpec *spec, const char *where, const char *value, int part,
                       const char *text, size_t length, double *out, WrError *err)
{
    if ((spec->length ? wr_length_parse : wr_number_parse)(text, length, out) &&
        in_range(spec, part, *out))
        return true;
    if (!spec->parts) return fail_value(spec, where, value, err);
    const WrComponent *c = &spec->parts[part];
    WrText range = { 0 };
    char excerpt[WR_EXCERPT_SIZE], *word = wr_strndup(text, length);
    add_range(&range, c->low, c->high, false);
    wr_fail(err, "%s: %s is \"%s\": must be %s%s", where, c->name, wr_excerpt(word, excerpt),
            c->whole ? WR_MESSAGE("a whole number, ") : WR_MESSAGE("a number, "),
            wr_text_get(&range));
    wr_free(word);
    wr_text_fini(&range);
    return false;
}

/* One tuple, [text, end), into out[width]; returns how many numbers it has, 0 on failure. */
static int parse_tuple(const WrArgSpec *spec, const char *where, const char *value,
                       const char *text, const char *end, double *out, WrError *err)
{
    int width = wr_arg_width(spec), n = 0;
    char separator = spec->type == WR_ARG_SIZE ? 'x' : ',';
    for (const char *p = text;; n++) {
        const char *stop = memchr(p, separator, (size_t)(end - p));
        if (!stop || spec->type == WR_ARG_NUMBER) stop = end;
        if (n == width) goto wrong_count;
        if (!parse_part(spec, where, value, n, p, (size_t)(stop - p), &out[n], err)) return 0;
        if (stop == end) break;
        p = stop + 1;
    }
    n++;
    if (spec->counts ? spec->counts >> n & 1 : n == width) return n;
wrong_count:
    if (spec->type == WR_ARG_LIST) {
        char excerpt[WR_EXCERPT_SIZE], *word = wr_strndup(text, (size_t)(end - text));
        const char *shape = spec->shape ? spec->shape : "as many numbers as the others";
        wr_fail(err, "%s: \"%s\": each tuple must be %.*s", where, wr_excerpt(word, excerpt),
                (int)strcspn(shape, ";"), shape);
        wr_free(word);
    } else {
        fail_value(spec, where, value, err);
    }
    return 0;
}

static void reserve_rows(WrArg *arg, int width, int rows)
{
    if (arg->capacity >= rows) return;
    int grown = arg->capacity ? arg->capacity * 2 : 1;
    if (grown < rows) grown = rows;
    arg->numbers = wr_realloc(arg->numbers, (size_t)arg->rows * (size_t)width,
                              (size_t)grown * (size_t)width, sizeof *arg->numbers);
    arg->counts = wr_realloc(arg->counts, (size_t)arg->rows, (size_t)grown, 1);
    arg->capacity = grown;
}

static void add_row(WrArg *arg, int width, const double *numbers, int count)
{
    reserve_rows(arg, width, arg->rows + 1);
    double *row = arg->numbers + (size_t)arg->rows * (size_t)width;
    for (int i = 0; i < width; i++) row[i] = i < count ? numbers[i] : 0;
    arg->counts[arg->rows++] = (unsigned char)count;
}

static bool parse_numbers(const WrArgSpec *spec, const char *where, const char *value, WrArg *arg,
                          WrError *err)
{
    double row[WR_SURFACE_VALUES];
    for (const char *p = value;;) {
        const char *end = spec->type == WR_ARG_LIST ? strchr(p, ';') : NULL;
        if (!end) end = p + strlen(p);
        if (spec->type == WR_ARG_LIST && arg->rows == spec->rows_high)
            return wr_fail(err, "%s: more than %d tuples", where, spec->rows_high);
        int n = parse_tuple(spec, where, value, p, end, row, err);
        if (n == 0) return false;
        add_row(arg, wr_arg_width(spec), row, n);
        if (!*end) break;
        p = end + 1;
    }
    if (spec->type == WR_ARG_LIST && arg->rows < spec->rows_low)
        return wr_fail(err, "%s: %d tuples: must be at least %d", where, arg->rows, spec->rows_low);
    return true;
}

/* ---- words ---- */

static bool parse_choice(const WrArgSpec *spec, const char *where, const char *value, WrArg *arg,
                         WrError *err)
{
    for (int i = 0; wr_arg_word(spec, i); i++)
        if (strcmp(wr_arg_word(spec, i), value) == 0) {
            arg->choice = i;
            arg->rows = 1;
            return true;
        }
    WrText what = { 0 };
    char excerpt[WR_EXCERPT_SIZE];
    wr_text_addf(&what, "%s%s%s", where, spec->positional ? " " : "=", wr_excerpt(value, excerpt));
    wr_fail_word(err, wr_text_get(&what), value, choice_word, spec);
    wr_text_fini(&what);
    return false;
}

static bool parse_text(const WrArgSpec *spec, const char *where, const char *value, WrArg *arg,
                       WrError *err)
{
    if (!*value && !spec->may_be_empty) return fail_value(spec, where, value, err);
    if (spec->type == WR_ARG_NAME && strlen(value) > WR_LAYER_NAME_MAX)
        return fail_value(spec, where, value, err);
    if (spec->type == WR_ARG_SHA256 &&
        (strlen(value) != 64 || strspn(value, "0123456789abcdefABCDEF") != 64))
        return fail_value(spec, where, value, err);
    WrError why;
    if (spec->check && !spec->check(spec->check_ctx, spec->name, value, &why)) {
        /* the message contains the argument's name itself */
        const char *colon = strrchr(where, ':');
        return wr_fail(err, "%.*s: %s", colon ? (int)(colon - where) : 0, where,
                       wr_error_message(&why));
    }
    arg->text = wr_strdup(value);
    arg->rows = 1;
    if (spec->type == WR_ARG_SHA256)
        for (char *p = arg->text; *p; p++) *p = (char)tolower((unsigned char)*p);
    return true;
}

bool wr_arg_parse(const WrArgSpec *spec, const char *where, const char *value, WrArg *arg,
                  WrError *err)
{
    WrArg made = { .choice = -1 };
    bool good;
    switch (spec->type) {
    case WR_ARG_CHOICE: good = parse_choice(spec, where, value, &made, err); break;
    case WR_ARG_PATH:
    case WR_ARG_TEXT:
    case WR_ARG_NAME:
    case WR_ARG_LAYER:
    case WR_ARG_PRESET:
    case WR_ARG_SHA256: good = parse_text(spec, where, value, &made, err); break;
    default: good = parse_numbers(spec, where, value, &made, err); break;
    }
    if (!good) {
        wr_arg_fini(&made);
        return false;
    }
    made.given = true;
    *arg = made;
    return true;
}

/* ---- values as text ---- */

void wr_text_add_word(WrText *text, const char *word)
{
    bool bare = *word != '\0';
    for (const char *p = word; *p && bare; p++)
        bare = (unsigned char)*p < 128 && (isalnum((unsigned char)*p) || strchr("_-./+:@%~^,", *p));
    if (bare) {
        wr_text_add(text, word);
        return;
    }
    wr_text_add(text, "\"");
    for (const char *p = word; *p; p++) {
        if (*p == '"' || *p == '\\') wr_text_add(text, "\\");
        wr_text_add_n(text, p, 1);
    }
    wr_text_add(text, "\"");
}

void wr_text_add_file_name(WrText *text, const char *path)
{
    char excerpt[WR_EXCERPT_SIZE];
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    char *stem = wr_strndup(name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
    wr_text_add_word(text, wr_excerpt(stem, excerpt));
    wr_free(stem);
}

void wr_arg_print(const WrArgSpec *spec, const WrArg *arg, WrText *text)
{
    if (spec->type == WR_ARG_CHOICE) {
        wr_text_add(text, wr_arg_word(spec, arg->choice));
        return;
    }
    if (arg->text) {
        wr_text_add_word(text, arg->text);
        return;
    }
    int width = wr_arg_width(spec);
    for (int r = 0; r < arg->rows; r++) {
        if (r > 0) wr_text_add(text, ";");
        for (int i = 0; i < arg->counts[r]; i++) {
            if (i > 0) wr_text_add(text, spec->type == WR_ARG_SIZE ? "x" : ",");
            wr_text_add_number(text, arg->numbers[(size_t)r * (size_t)width + (size_t)i]);
            if (spec->length) wr_text_add(text, "mm");
        }
    }
}

/* ---- reading values ---- */

static int arg_index(const WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0) return i;
    return -1;
}

WrArg *wr_call_arg(const WrCall *call, const char *name)
{
    static double zeros[4]; /* default of a tuple; read only */
    static const WrArg none = { .choice = -1, .numbers = zeros };
    int i = arg_index(call, name);
    WR_ASSERT(i >= 0); /* tests/repository/arguments.sh checks every name passed here */
    if (i >= 0) return (WrArg *)&call->args[i];
    return (WrArg *)&none;
}

WrCommandClass wr_call_class(const WrCall *call)
{
    const WrCommand *command = call->command;
    return command->class_of ? command->class_of(call->form) : command->kind;
}

bool wr_call_of_views(const WrCall *call)
{
    const WrCommandClass kind = wr_call_class(call);
    return kind == WR_CLASS_VIEW || kind == WR_CLASS_CHOICE || call->command->of_views;
}

bool wr_call_given(const WrCall *call, const char *name)
{
    return wr_call_arg(call, name)->given;
}

double wr_call_number(const WrCall *call, const char *name)
{
    const WrArg *arg = wr_call_arg(call, name);
    WR_ASSERT(arg->numbers);
    return arg->numbers[0];
}

int wr_call_choice(const WrCall *call, const char *name)
{
    return wr_call_arg(call, name)->choice;
}

const char *wr_call_hash_argument(const WrCall *call, int index)
{
    const WrArgSpec *spec = &call->specs[index];
    if (spec->type != WR_ARG_PATH && spec->type != WR_ARG_PRESET) return NULL;
    char name[64];
    snprintf(name, sizeof name, "%s_sha256", spec->name);
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].type == WR_ARG_SHA256 &&
            (strcmp(call->specs[i].name, name) == 0 || strcmp(call->specs[i].name, "sha256") == 0))
            return call->specs[i].name;
    return NULL;
}

bool wr_call_names_file(const WrCall *call, int index)
{
    const WrArg *arg = &call->args[index];
    if (!arg->given || !arg->text) return false;
    const char *const *word = call->specs[index].words;
    for (; call->specs[index].type == WR_ARG_PATH && word && *word; word++)
        if (strcmp(*word, arg->text) == 0) return false;
    if (call->specs[index].type == WR_ARG_PATH) return true;
    return call->specs[index].type == WR_ARG_PRESET && wr_names_preset_file(arg->text);
}

bool wr_names_preset_file(const char *word)
{
    char buffer[16];
    return strcmp(wr_path_ending(word, buffer), "myb") == 0;
}

void wr_call_set_text(WrCall *call, const char *name, const char *text)
{
    WrArg *arg = wr_call_arg(call, name);
    wr_arg_fini(arg);
    arg->text = wr_strdup(text);
    arg->rows = 1;
    arg->given = true;
}

void wr_call_add_row(WrCall *call, const char *name, const double *numbers, int count)
{
    WrArg *arg = wr_call_arg(call, name);
    add_row(arg, wr_arg_width(&call->specs[arg - call->args]), numbers, count);
    arg->given = true;
}
