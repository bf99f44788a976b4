#include "base/text.h"

#include "base/error.h"
#include "base/memory.h"
#include "system/locale.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void wr_text_fini(WrText *text)
{
    wr_free(text->data);
    *text = (WrText){ 0 };
}

void wr_text_clear(WrText *text)
{
    text->length = 0;
    if (text->data) text->data[0] = '\0';
}

const char *wr_text_get(const WrText *text)
{
    return text->data ? text->data : "";
}

static void reserve(WrText *text, size_t more)
{
    size_t need = text->length + more + 1;
    if (need <= text->capacity) return;
    size_t grown = text->capacity ? text->capacity * 2 : 64;
    if (grown < need) grown = need;
    text->data = wr_realloc(text->data, text->length, grown, 1);
    text->capacity = grown;
}

void wr_text_add_n(WrText *text, const char *bytes, size_t length)
{
    reserve(text, length);
    memcpy(text->data + text->length, bytes, length);
    text->length += length;
    text->data[text->length] = '\0';
}

void wr_text_add(WrText *text, const char *bytes)
{
    wr_text_add_n(text, bytes, strlen(bytes));
}

void wr_text_addf(WrText *text, const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int n = vsnprintf(NULL, 0, format, args);
    va_end(args);
    if (n > 0) {
        reserve(text, (size_t)n);
        vsnprintf(text->data + text->length, (size_t)n + 1, format, again);
        text->length += (size_t)n;
    }
    va_end(again);
}

/* Prints with `digits` significant digits in the C locale. */
static void print_digits(double value, int digits, char *buffer)
{
    wr_locale_print_plain(buffer, WR_NUMBER_SIZE, value, digits);
}

/* "4e+01" is less readable than "40": integers below 1e15 are written out. */
static char *write_out(double value, char *buffer)
{
    if (strchr(buffer, 'e') && fabs(value) >= 1 && fabs(value) < 1e15)
        print_digits(value, 15, buffer);
    return buffer;
}

/* The shortest decimal that reads back as the same double, as scripts and documents must be exact and readable. Attempts go
   by digits: 1..6 find most typed values, 15 to 17 the rest; 7 to 14 are tried only if the text is long. */
char *wr_number_print(double value, char *buffer)
{
    if (!isfinite(value)) return strcpy(buffer, isnan(value) ? "nan" : value < 0 ? "-inf" : "inf");
    for (int digits = 1; digits <= 17; digits++) {
        if (digits > 6 && digits < 15)
            continue; /* few values need so few digits; this saves most attempts */
        print_digits(value, digits, buffer);
        if (wr_locale_read_double(buffer, NULL) == value) break;
    }
    /* 15 digits may hide a shorter form of 7 to 14. */
    for (int digits = 7; digits < 15; digits++) {
        char shorter[WR_NUMBER_SIZE];
        if (strlen(buffer) <= 7) break;
        print_digits(value, digits, shorter);
        if (wr_locale_read_double(shorter, NULL) == value)
            return write_out(value, strcpy(buffer, shorter));
    }
    return write_out(value, buffer);
}

char *wr_number_print_float(float value, char *buffer)
{
    if (!isfinite(value)) return wr_number_print((double)value, buffer);
    for (int digits = 1; digits <= 9; digits++) {
        print_digits((double)value, digits, buffer);
        if (wr_locale_read_float(buffer, NULL) == value) break;
    }
    return write_out((double)value, buffer);
}

void wr_text_add_number(WrText *text, double value)
{
    char buffer[WR_NUMBER_SIZE];
    wr_text_add(text, wr_number_print(value, buffer));
}

/* True if text[0..length) has the form [+-] digits [. digits] [e [+-] digits]. */
static bool looks_decimal(const char *text, size_t length)
{
    size_t i = 0, digits = 0;
    if (i < length && (text[i] == '+' || text[i] == '-')) i++;
    while (i < length && isdigit((unsigned char)text[i])) i++, digits++;
    if (i < length && text[i] == '.') {
        i++;
        while (i < length && isdigit((unsigned char)text[i])) i++, digits++;
    }
    if (digits == 0) return false;
    if (i < length && (text[i] == 'e' || text[i] == 'E')) {
        i++;
        if (i < length && (text[i] == '+' || text[i] == '-')) i++;
        size_t start = i;
        while (i < length && isdigit((unsigned char)text[i])) i++;
        if (i == start) return false;
    }
    return i == length;
}

bool wr_number_parse(const char *text, size_t length, double *value)
{
    char small[64], *copy = small;
    if (!looks_decimal(text, length)) return false;
    if (length >= sizeof small) copy = wr_alloc(length + 1, 1);
    memcpy(copy, text, length);
    copy[length] = '\0';
    double v = wr_locale_read_double(copy, NULL);
    if (copy != small) wr_free(copy);
    if (!isfinite(v)) return false;
    *value = v;
    return true;
}

/* Length of the valid UTF-8 sequence at s, 0 if there is none. Rejects overlong forms, surrogates and
   values beyond U+10FFFF. */
static size_t utf8_length(const unsigned char *s)
{
    if (s[0] < 0x80) return 1;
    size_t n = s[0] >= 0xF0 && s[0] <= 0xF4 ? 4 : s[0] >= 0xE0 ? 3 : s[0] >= 0xC2 ? 2 : 0;
    if (n == 0 || s[0] > 0xF4) return 0;
    for (size_t i = 1; i < n; i++)
        if ((s[i] & 0xC0) != 0x80) return 0;
    if (s[0] == 0xE0 && s[1] < 0xA0) return 0;
    if (s[0] == 0xED && s[1] > 0x9F) return 0;
    if (s[0] == 0xF0 && s[1] < 0x90) return 0;
    if (s[0] == 0xF4 && s[1] > 0x8F) return 0;
    return n;
}

bool wr_text_is_utf8(const char *bytes)
{
    size_t n = 1;
    for (const unsigned char *s = (const unsigned char *)bytes; *s && n; s += n) n = utf8_length(s);
    return n > 0;
}

void wr_text_add_json_string(WrText *text, const char *bytes)
{
    const unsigned char *s = (const unsigned char *)bytes;
    wr_text_add(text, "\"");
    while (*s) {
        size_t n = utf8_length(s);
        if (n == 0) {
            wr_text_add(text, "\xEF\xBF\xBD");
            s++;
            continue;
        }
        if (*s == '"' || *s == '\\') wr_text_addf(text, "\\%c", *s);
        else if (*s < 0x20) wr_text_addf(text, "\\u%04x", *s);
        else wr_text_add_n(text, (const char *)s, n);
        s += n;
    }
    wr_text_add(text, "\"");
}

void wr_text_add_json_number(WrText *text, double value)
{
    if (!isfinite(value)) wr_text_add(text, "null");
    else wr_text_add_number(text, value + 0.0); /* no negative zero */
}

bool wr_text_same_letters(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == tolower((unsigned char)*b)) a++, b++;
    return *a == *b;
}

static int length_of_word(const char *word)
{
    const char *end = memchr(word, '\0', WR_WORD_MAX);
    return end ? (int)(end - word) : WR_WORD_MAX;
}

/* Optimal string alignment (Damerau-Levenshtein without overlapping edits): d[i][j] is the least number of insertions,
   deletions, substitutions and swaps of neighbours between the first i letters of a and the first j of b. */
int wr_word_distance(const char *a, const char *b)
{
    int n = length_of_word(a), m = length_of_word(b);
    int d[WR_WORD_MAX + 1][WR_WORD_MAX + 1];
    for (int i = 0; i <= n; i++) d[i][0] = i;
    for (int j = 0; j <= m; j++) d[0][j] = j;
    for (int i = 1; i <= n; i++)
        for (int j = 1; j <= m; j++) {
            int best = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            if (d[i - 1][j] + 1 < best) best = d[i - 1][j] + 1;
            if (d[i][j - 1] + 1 < best) best = d[i][j - 1] + 1;
            bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped && d[i - 2][j - 2] + 1 < best) best = d[i - 2][j - 2] + 1;
            d[i][j] = best;
        }
    return d[n][m];
}

/* ---- spelling suggestions ---- */

/* Scores are twice the edits, so that a matching prefix ranks between one edit and two. */
#define SCORE_OF_BEGINNING 3
#define SHORTEST_BEGINNING 2

/* Words of Blender, Krita, Substance, ImageMagick and POV-Ray with their equivalents here. A list may
   contain only some of them; one word may have different equivalents in different lists. */
static const struct {
    const char *typed, *meant[4]; /* unused places: NULL */
} habits[] = {
    { "activate", { "use" } },
    { "add", { "raise" } },
    { "albedo", { "colour" } },
    { "alpha", { "opacity" } },
    { "ambient-occlusion", { "occlusion" } },
    { "ao", { "occlusion" } },
    { "background-color", { "background" } },
    { "bake", { "rasterize" } },
    { "ball", { "sphere" } },
    { "basecolor", { "colour" } },
    { "below", { "above" } },
    { "bg", { "background" } },
    { "bits", { "depth" } },
    { "box", { "cube" } },
    { "brightness", { "strength" } },
    { "brush", { "stroke", "dab", "preset" } },
    { "bump", { "height" } },
    { "bumpmap", { "height", "bump" } },
    { "canvas", { "table" } },
    { "cavity", { "occlusion", "curvature" } },
    { "circle", { "ellipse" } },
    { "clone", { "duplicate" } },
    { "convert", { "export" } },
    { "copy", { "duplicate" } },
    { "delete", { "remove", "clear" } },
    { "dest", { "-o" } },
    { "diameter", { "size", "radius" } },
    { "directory", { "folder" } },
    { "directx", { "normal-y" } },
    { "dirt", { "occlusion" } },
    { "displace", { "displacement", "displaced", "warp" } },
    { "distance", { "spacing", "reach", "radius" } },
    { "donut", { "torus" } },
    { "draw", { "stroke", "shape" } },
    { "edge", { "wear", "curvature" } },
    { "edge-wear", { "wear" } },
    { "edges", { "wear", "curvature" } },
    { "edit", { "set" } },
    { "env", { "environment" } },
    { "file", { "-o" } },
    { "flip", { "mirror", "flip-u", "flip-v" } },
    { "format", { "--as", "depth" } },
    { "frequency", { "cells", "across" } },
    { "gaussian", { "blur" } },
    { "gaussian-blur", { "blur" } },
    { "generator", { "from" } },
    { "gloss", { "shininess" } },
    { "glossiness", { "shininess" } },
    { "gradient", { "ramp", "slope" } },
    { "hdri", { "environment" } },
    { "heightmap", { "height", "image" } },
    { "hidden", { "visible" } },
    { "hide", { "visible", "set" } },
    { "instance", { "link", "duplicate" } },
    { "intensity", { "strength" } },
    { "jobs", { "--threads" } },
    { "kind", { "--as", "live" } },
    { "lamp", { "light" } },
    { "layers", { "layer" } },
    { "line", { "from" } },
    { "link", { "duplicate" } },
    { "load", { "open", "image" } },
    { "location", { "at" } },
    { "man", { "help" } },
    { "mask", { "layer" } },
    { "merge-down", { "merge" } },
    { "mergedown", { "merge" } },
    { "metallic", { "metalness", "metal" } },
    { "mode", { "blend" } },
    { "name", { "rename" } },
    { "negate", { "invert" } },
    { "new", { "table", "add" } },
    { "normal", { "normal+y", "normal-y" } },
    { "normal-map", { "normal+y", "normal-y", "normalmap" } },
    { "opengl", { "normal+y" } },
    { "order", { "move" } },
    { "paint", { "stroke", "sculpt" } },
    { "pixels", { "size" } },
    { "pos", { "at" } },
    { "position", { "at" } },
    { "quality", { "samples" } },
    { "radius", { "sigma", "size" } },
    { "rect", { "rectangle" } },
    { "remove", { "delete", "clear" } },
    { "resolution", { "--size", "size" } },
    { "rm", { "delete", "remove" } },
    { "rotation", { "turn", "rotate", "angle" } },
    { "scale", { "cells", "size" } },
    { "select", { "use" } },
    { "sharpness", { "hardness" } },
    { "show", { "visible", "set" } },
    { "size", { "radius", "cells" } },
    { "sky", { "environment", "background" } },
    { "smooth", { "blur" } },
    { "snapshot", { "variant" } },
    { "softness", { "hardness", "size" } },
    { "spp", { "samples" } },
    { "steepness", { "slope" } },
    { "strength", { "height" } },
    { "subtract", { "lower" } },
    { "sun", { "directional" } },
    { "switch", { "use" } },
    { "texture", { "colour" } },
    { "tile", { "repeat", "replicate" } },
    { "tiles", { "repeat" } },
    { "tiling", { "repeat", "replicate" } },
    { "to", { "-o" } },
    { "transparency", { "opacity" } },
    { "type", { "--as", "mode", "kind", "from" } },
    { "unlink", { "rasterize" } },
    { "wavelength", { "cells" } },
    { "weight", { "opacity", "strength" } },
    { "width", { "--size" } },
    { "world", { "environment" } },
    { "zoom", { "size", "fov" } },
};

const char *wr_word_of_array(const void *ctx, int i)
{
    return ((const char *const *)ctx)[i];
}

static void fold(const char *word, char out[WR_WORD_MAX + 1])
{
    int n = 0;
    for (; word[n] && n < WR_WORD_MAX; n++)
        out[n] = word[n] == '_' ? '-' : (char)tolower((unsigned char)word[n]);
    out[n] = '\0';
}

static int most_edits(size_t length)
{
    return length < 5 ? 1 : length < 8 ? 2 : 3;
}

/* Skips the dashes of an option, which all options share. */
static const char *letters_of(const char *word)
{
    return word + strspn(word, "-");
}

static bool begins(const char *word, const char *whole)
{
    size_t length = strlen(word);
    return strlen(letters_of(word)) >= SHORTEST_BEGINNING && strlen(whole) > length &&
           strncmp(word, whole, length) == 0;
}

/* -1: too far. A word without a letter in common with the typed word is never suggested. */
static int score_of(const char *word, const char *candidate)
{
    int edits = wr_word_distance(word, candidate);
    bool near =
        edits <= most_edits(strlen(letters_of(word))) && edits < (int)strlen(letters_of(candidate));
    int score = near ? 2 * edits : -1;
    if (begins(word, candidate) && (!near || score > SCORE_OF_BEGINNING))
        score = SCORE_OF_BEGINNING;
    return score;
}

/* Indices of the words that `meant` lists, at most WR_NEAREST_MAX, in its order. */
static int find_meant(const char *const meant[4], WrWordList list, const void *ctx,
                      int places[WR_NEAREST_MAX])
{
    int count = 0;
    for (int k = 0; k < 4 && meant[k]; k++)
        for (int i = 0; list(ctx, i) && count < WR_NEAREST_MAX; i++)
            if (strcmp(list(ctx, i), meant[k]) == 0) {
                places[count++] = i;
                break;
            }
    return count;
}

/* `typed` is folded. */
static int find_habit(const char *typed, WrWordList list, const void *ctx,
                      int places[WR_NEAREST_MAX])
{
    for (size_t row = 0; row < sizeof habits / sizeof *habits; row++)
        if (strcmp(habits[row].typed, letters_of(typed)) == 0)
            return find_meant(habits[row].meant, list, ctx, places);
    return 0;
}

int wr_nearest(const char *word, WrWordList list, const void *ctx, int places[WR_NEAREST_MAX])
{
    char typed[WR_WORD_MAX + 1], candidate[WR_WORD_MAX + 1], nearest[WR_WORD_MAX + 1] = "";
    int best = -1, count = 0, habit[WR_NEAREST_MAX] = { 0 };
    fold(word, typed);
    for (int i = 0; list(ctx, i); i++) {
        fold(list(ctx, i), candidate);
        int score = score_of(typed, candidate);
        if (score < 0 || (best >= 0 && score > best)) continue;
        if (score != best) count = 0;
        else if (strcmp(candidate, nearest) == 0) continue; /* duplicate word in the list */
        best = score;
        strcpy(nearest, candidate);
        if (count < WR_NEAREST_MAX) places[count] = i;
        count++;
    }
    if (count > 0 && best <= 2) return count <= WR_NEAREST_MAX ? count : 0;
    int meant = find_habit(typed, list, ctx, habit);
    if (meant > 0) memcpy(places, habit, sizeof habit);
    return meant > 0 ? meant : count <= WR_NEAREST_MAX ? count : 0;
}

bool wr_suggest(const char *word, WrWordList list, const void *ctx, WrText *text)
{
    int places[WR_NEAREST_MAX];
    int count = wr_nearest(word, list, ctx, places);
    for (int k = 0; k < count; k++)
        wr_text_addf(text, "%s%s", k ? " or " : "", list(ctx, places[k]));
    return count > 0;
}

bool wr_fail_word(WrError *err, const char *argument, const char *word, WrWordList list,
                  const void *ctx)
{
    WrText names = { 0 }, near = { 0 };
    for (int i = 0; list(ctx, i); i++) wr_text_addf(&names, "%s%s", i ? ", " : "", list(ctx, i));
    if (wr_suggest(word, list, ctx, &near))
        wr_fail(err, "%s: did you mean %s? It must be one of %s", argument, wr_text_get(&near),
                wr_text_get(&names));
    else wr_fail(err, "%s: must be one of %s", argument, wr_text_get(&names));
    wr_text_fini(&near);
    wr_text_fini(&names);
    return false;
}
