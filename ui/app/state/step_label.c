#include "ui/app/state/step_label.h"
#include "ui/toolkit/words.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "field/ops.h"
#include "generate/generator.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define WORDS_MAX 48 /* words of a line that are parsed */

/* A word of the line: "name=value", or a value alone, without quotes. */
typedef struct Word {
    char *text;  /* owned */
    char *value; /* after the '=', or NULL */
} Word;

typedef struct Words {
    Word word[WORDS_MAX];
    int count;
} Words;

static Words words_of(const char *line)
{
    Words w = { .count = 0 };
    while (*line && w.count < WORDS_MAX) {
        while (*line == ' ') line++;
        if (!*line || *line == '#') break;
        char *text = wr_alloc(strlen(line) + 1, 1), *end = text;
        for (bool quoted = false; *line && (quoted || *line != ' '); line++) {
            if (*line == '"') quoted = !quoted;
            else *end++ = *line;
        }
        char *equal = strchr(text, '=');
        w.word[w.count++] = (Word){ text, equal ? equal + 1 : NULL };
    }
    return w;
}

static void free_words(Words *w)
{
    for (int i = 0; i < w->count; i++) wr_free(w->word[i].text);
}

static const char *value_of(const Words *w, const char *name)
{
    size_t length = strlen(name);
    for (int i = 1; i < w->count; i++)
        if (w->word[i].value && strncmp(w->word[i].text, name, length) == 0 &&
            w->word[i].text[length] == '=')
            return w->word[i].value;
    return NULL;
}

/* Positional value n, from 1; NULL if there are fewer. */
static const char *plain(const Words *w, int n)
{
    for (int i = 1; i < w->count; i++)
        if (!w->word[i].value && --n == 0) return w->word[i].text;
    return NULL;
}

/* A file's name without folders and extension. */
static void file_name(const char *path, WrText *out)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    wr_text_addf(out, "%.*s", (int)(dot && dot > name ? dot - name : (ptrdiff_t)strlen(name)),
                 name);
}

static int tuples(const char *points)
{
    int count = *points != '\0';
    for (; *points; points++) count += *points == ';';
    return count;
}

static const char *brush_deed(const Words *w)
{
    static const struct {
        const char *mode, *words;
    } deeds[] = { { "lower", "lowered" },  { "erase", "erased" },   { "smooth", "smoothed" },
                  { "smear", "smeared" },  { "to", "to a height" }, { "clone", "cloned" },
                  { "level", "levelled" }, { "pinch", "pinched" },  { "sharpen", "sharpened" } };
    const char *mode = value_of(w, "mode");
    for (int i = 0; mode && i < WR_LENGTH(deeds); i++)
        if (strcmp(mode, deeds[i].mode) == 0) return deeds[i].words;
    return NULL;
}

static void brush_words(const Words *w, const char *what, WrText *out)
{
    const char *preset = value_of(w, "preset"), *tip = value_of(w, "tip"), *deed = brush_deed(w);
    const char *points = value_of(w, "points");
    wr_text_add(out, wr_words(what));
    if (preset || tip) {
        wr_text_add(out, ", ");
        file_name(preset ? preset : tip, out);
    }
    if (deed) wr_text_addf(out, ", %s", wr_words(deed));
    if (points && tuples(points) == 1) wr_text_addf(out, ", %s", wr_words("1 sample"));
    else if (points) {
        wr_text_add(out, ", ");
        wr_text_addf(out, wr_words("%d samples"), tuples(points));
    }
}

/* Display names of commands that have none in the tables of the program. */
static const struct {
    const char *verb, *words;
} names[] = {
    { "table", "New table" },
    { "fill", "Fill" },
    { "grid", "Grid" },
    { "image", "Heights of a picture" },
    { "shape", "Shape" },
    { "flood", "Fill connected texels" },
    { "project", "Projection onto the mesh" },
    { "ramp", "Ramp" },
    { "rim", "Edge" },
    { "open", "Opened" },
    { "layer", "Layer" },
    { "macro", "Macro" },
    { "step", "Change of the history" },
    { "select", "Selection" },
    { "transform", "Transform" },
    { "object", "Object" },
    { "ground", "Ground" },
    { "surface", "Surface" },
    { "analytic", "Formula in place of the table" },
    { "bump", "Bump" },
    { "replicate", "Repeats" },
    { "material", "Material" },
    { "grain", "Solid texture" },
    { "colour", "Colour picture" },
    { "colouring", "Colours by height" },
    { "normalmap", "Normal map" },
    { "roughness", "Roughness" },
    { "metalness", "Metalness" },
    { "light", "Light source" },
    { "environment", "Surroundings" },
    { "background", "Background" },
    { "tone", "Exposure" },
    { "cell", "Size of the cell" },
    { "sheet", "Export sheet" },
    { "dials", "Dials" },
    { "tolerance", "Tolerance" },
    { "render", "Picture" },
    { "export", "Export" },
    { "maps", "Maps" },
    { "save", "Save" },
    { "copy", "Copy" },
    { "script", "Script" },
    { "camera", "Camera" },
    { "rotate", "Turn" },
    { "view", "View" },
    { "undo", "Undo" },
    { "redo", "Redo" },
};

static const char *name_of(const char *verb)
{
    for (int i = 0; i < WR_LENGTH(names); i++)
        if (strcmp(verb, names[i].verb) == 0) return wr_words(names[i].words);
    return NULL;
}

#define NAMED_MAX 2         /* values that are said */
#define NAMED_LENGTH_MAX 14 /* bytes of one */

const char *wr_step_word(const char *word)
{
    static char label[NAMED_LENGTH_MAX + 1];
    const char *said = wr_words(word);
    if (said != word || strlen(word) >= sizeof label) return said;
    snprintf(label, sizeof label, "%s", word);
    label[0] = (char)toupper((unsigned char)label[0]);
    said = wr_words(label);
    return said == label ? word : said;
}

/* A parameter's name in the window's language, by its label if the word itself has no translation. */
static const char *name_words(const char *name, const WrParam *params)
{
    const char *said = wr_words(name);
    for (const WrParam *p = params; said == name && p && p->name; p++)
        if (strcmp(p->name, name) == 0 && wr_words(p->label) != p->label) return wr_words(p->label);
    return said;
}

/* A value is a word of a list, or a number; names and files are not translated. */
static void add_value(const char *name, const char *value, WrText *out)
{
    static const char *const own[] = { "name", "file", "text", "font", "picture" };
    char number[NAMED_LENGTH_MAX + 1];
    bool free = false;
    for (int i = 0; i < WR_LENGTH(own); i++) free = free || strcmp(name, own[i]) == 0;
    snprintf(number, sizeof number, "%s", value);
    wr_text_add(out, free ? value : wr_step_word(wr_words_number(number)));
}

/* The first short values with a name: ", height 0.1". params: of the generator; NULL: none */
static void add_named(const Words *w, const WrParam *params, WrText *out)
{
    int said = 0;
    for (int i = 1; i < w->count && said < NAMED_MAX; i++) {
        const char *value = w->word[i].value;
        char name[40];
        if (!value || !*value || strlen(value) > NAMED_LENGTH_MAX || strchr(value, ';')) continue;
        snprintf(name, sizeof name, "%.*s", (int)(value - 1 - w->word[i].text), w->word[i].text);
        wr_text_addf(out, ", %s ", name_words(name, params));
        add_value(name, value, out);
        said++;
    }
}

/* The command's name, and its first words that specify the action. */
static void other_words(const Words *w, WrText *out)
{
    const char *name = name_of(w->word[0].text);
    if (name) wr_text_add(out, name);
    else wr_text_addf(out, "%c%s", toupper((unsigned char)w->word[0].text[0]), w->word[0].text + 1);
    for (int i = 1; i <= 2 && plain(w, i); i++) {
        wr_text_add(out, i == 1 ? ", " : " ");
        if (strchr(plain(w, i), '/')) file_name(plain(w, i), out);
        else wr_text_addf(out, "%.40s", i == 1 ? wr_step_word(plain(w, i)) : plain(w, i));
    }
    add_named(w, NULL, out);
}

/* Texts for a layer (%.20s is its number) and for several (%d is how many). */
static const struct {
    const char *form, *argument, *value; /* as in `layer FORM N ARGUMENT=VALUE`; NULL: any */
    const char *one, *several;
} layer_deeds[] = {
    { "set", "visible", "off", "Layer %.20s hidden", "%d layers hidden" },
    { "set", "visible", "on", "Layer %.20s shown", "%d layers shown" },
    { "set", "lock", "off", "Layer %.20s unlocked", "%d layers unlocked" },
    { "set", "lock", "on", "Layer %.20s locked", "%d layers locked" },
    { "set", NULL, NULL, "Layer %.20s", "%d layers" },
    { "use", NULL, NULL, "Layer %.20s chosen", NULL },
    { "delete", NULL, NULL, "Layer %.20s deleted", "%d layers deleted" },
    { "duplicate", NULL, NULL, "Layer %.20s duplicated", "%d layers duplicated" },
    { "move", NULL, NULL, "Layer %.20s moved", "%d layers moved" },
    { "rename", NULL, NULL, "Layer %.20s renamed", NULL },
    { "merge", NULL, NULL, "Layer %.20s merged", "%d layers merged" },
    { "mask", NULL, NULL, "Mask of layer %.20s", NULL },
    { "clear", NULL, NULL, "Layer %.20s cleared", "%d layers cleared" },
    { "rasterize", NULL, NULL, "Layer %.20s rasterized", "%d layers rasterized" },
};

/* True if the line is such a change. */
static bool layer_words(const Words *w, WrText *out)
{
    const char *form = plain(w, 1), *list = plain(w, 2);
    if (!form) return false;
    if (strcmp(form, "add") == 0) {
        wr_text_add(out, wr_words("New layer"));
        if (list) wr_text_addf(out, wr_words(": %.40s"), list);
        return true;
    }
    int layers = 1;
    for (const char *p = list; p && *p; p++) layers += *p == ',';
    for (int i = 0; list && i < WR_LENGTH(layer_deeds); i++) {
        const char *argument = layer_deeds[i].argument, *several = layer_deeds[i].several;
        const char *value = argument ? value_of(w, argument) : NULL;
        if (strcmp(form, layer_deeds[i].form) != 0) continue;
        if (argument && (!value || strcmp(value, layer_deeds[i].value) != 0)) continue;
        if (layers > 1 && several) wr_text_addf(out, wr_words(several), layers);
        else wr_text_addf(out, wr_words(layer_deeds[i].one), list);
        if (!argument && strcmp(form, "set") == 0) add_named(w, NULL, out);
        return true;
    }
    return false;
}

void wr_step_label(const char *line, WrText *out)
{
    Words w = words_of(line);
    const char *verb = w.count > 0 ? w.word[0].text : "", *kind = plain(&w, 1);
    const WrGenerator *generator = kind ? wr_generator_find(verb, kind) : NULL;
    const WrOpInfo *op = kind && strcmp(verb, "adjust") == 0 ? wr_op_find(kind) : NULL;
    if (!generator && w.count > 0) generator = wr_generator_find(verb, verb);
    if (strcmp(verb, "stroke") == 0) brush_words(&w, "Stroke", out);
    else if (strcmp(verb, "sculpt") == 0) brush_words(&w, "Stroke on the mesh", out);
    else if (strcmp(verb, "dab") == 0) brush_words(&w, "Dab", out);
    else if (kind && strcmp(verb, "text") == 0) {
        wr_text_add(out, wr_words("Text"));
        wr_text_addf(out, wr_words(": %.40s"), kind);
        add_named(&w, generator ? generator->params : NULL, out);
    } else if (kind && strcmp(verb, "layer") == 0 && strcmp(kind, "paste") == 0)
        wr_text_add(out, wr_words("Pasted"));
    else if (strcmp(verb, "layer") == 0 && layer_words(&w, out)) (void)0;
    else if (op || (generator && generator->label)) {
        wr_text_add(out, wr_words(op ? op->label : generator->label));
        add_named(&w, op ? NULL : generator->params, out);
    } else if (w.count > 0) other_words(&w, out);
    free_words(&w);
}
