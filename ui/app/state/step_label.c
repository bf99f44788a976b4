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
    { "light", "Light" },
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

/* The command's name, and its first words that specify the action. */
static void other_words(const Words *w, WrText *out)
{
    const char *name = name_of(w->word[0].text);
    if (name) wr_text_add(out, name);
    else wr_text_addf(out, "%c%s", toupper((unsigned char)w->word[0].text[0]), w->word[0].text + 1);
    for (int i = 1; i <= 2 && plain(w, i); i++) {
        wr_text_add(out, i == 1 ? ", " : " ");
        if (strchr(plain(w, i), '/')) file_name(plain(w, i), out);
        else wr_text_addf(out, "%.40s", plain(w, i));
    }
}

/* Text for a change of the settings of several layers; %d is their number. */
static const char *layers_deed(const Words *w)
{
    const char *visible = value_of(w, "visible"), *lock = value_of(w, "lock");
    if (visible) return strcmp(visible, "off") == 0 ? "%d layers hidden" : "%d layers shown";
    if (lock) return strcmp(lock, "off") == 0 ? "%d layers unlocked" : "%d layers locked";
    return NULL;
}

/* Text for a click on a layer; %.20s is the layer's number. */
static const char *layer_deed(const Words *w)
{
    const char *deed = plain(w, 1), *visible = value_of(w, "visible"), *lock = value_of(w, "lock");
    if (!deed || !plain(w, 2)) return NULL;
    if (strcmp(deed, "use") == 0) return "Layer %.20s at hand";
    if (strcmp(deed, "set") != 0) return NULL;
    if (visible && strcmp(visible, "off") == 0) return "Layer %.20s hidden";
    if (visible) return "Layer %.20s shown";
    if (lock && strcmp(lock, "off") == 0) return "Layer %.20s unlocked";
    return lock ? "Layer %.20s locked" : NULL;
}

/* True if the line is such a change. */
static bool layer_words(const Words *w, WrText *out)
{
    const char *deed = layer_deed(w), *list = plain(w, 2);
    if (!deed) return false;
    int layers = 1;
    for (const char *p = list; *p; p++) layers += *p == ',';
    if (layers > 1 && layers_deed(w)) wr_text_addf(out, wr_words(layers_deed(w)), layers);
    else wr_text_addf(out, wr_words(deed), list);
    return true;
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
    else if (kind && strcmp(verb, "text") == 0)
        wr_text_addf(out, "%s: %.40s", wr_words("Text"), kind);
    else if (kind && strcmp(verb, "layer") == 0 && strcmp(kind, "paste") == 0)
        wr_text_add(out, wr_words("Pasted"));
    else if (strcmp(verb, "layer") == 0 && layer_words(&w, out)) (void)0;
    else if (op) wr_text_add(out, wr_words(op->label));
    else if (generator && generator->label) wr_text_add(out, wr_words(generator->label));
    else if (w.count > 0) other_words(&w, out);
    free_words(&w);
}
