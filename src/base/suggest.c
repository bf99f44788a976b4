#include "base/suggest.h"

#include "base/error.h"
#include "base/text.h"

#include <ctype.h>
#include <string.h>

/* Scores are twice the edits, so that a matching prefix ranks between one edit and two. */
#define SCORE_OF_BEGINNING 3
#define SHORTEST_BEGINNING 2

/* Words of Blender, Krita, Substance, ImageMagick and POV-Ray with their equivalents here. A list may
   contain only some of them; one word may have different equivalents in different lists. */
static const struct {
    const char *typed, *meant[4]; /* unused places: NULL */
} habits[] = {
    { "add", { "raise" } },
    { "albedo", { "colour" } },
    { "ambient-occlusion", { "occlusion" } },
    { "ao", { "occlusion" } },
    { "background-color", { "background" } },
    { "ball", { "sphere" } },
    { "basecolor", { "colour" } },
    { "bg", { "background" } },
    { "bits", { "depth" } },
    { "box", { "cube" } },
    { "brightness", { "strength" } },
    { "brush", { "stroke", "dab", "preset" } },
    { "bump", { "height" } },
    { "bumpmap", { "height", "bump" } },
    { "canvas", { "table" } },
    { "circle", { "ellipse" } },
    { "convert", { "export" } },
    { "delete", { "remove", "clear" } },
    { "dest", { "-o" } },
    { "diameter", { "size", "radius" } },
    { "directx", { "normal-y" } },
    { "directory", { "folder" } },
    { "displace", { "displacement", "displaced", "warp" } },
    { "distance", { "spacing", "reach", "radius" } },
    { "donut", { "torus" } },
    { "draw", { "stroke", "shape" } },
    { "env", { "environment" } },
    { "file", { "-o" } },
    { "flip", { "mirror", "flip-u", "flip-v" } },
    { "format", { "--as", "depth" } },
    { "frequency", { "cells", "across" } },
    { "gaussian", { "blur" } },
    { "gaussian-blur", { "blur" } },
    { "gloss", { "shininess" } },
    { "glossiness", { "shininess" } },
    { "hdri", { "environment" } },
    { "heightmap", { "height", "image" } },
    { "intensity", { "strength" } },
    { "jobs", { "--threads" } },
    { "kind", { "--as" } },
    { "lamp", { "light" } },
    { "load", { "open", "image" } },
    { "location", { "at" } },
    { "man", { "help" } },
    { "metallic", { "metalness", "metal" } },
    { "negate", { "invert" } },
    { "new", { "table", "add" } },
    { "normal", { "normal+y", "normal-y" } },
    { "normal-map", { "normal+y", "normal-y", "normalmap" } },
    { "opengl", { "normal+y" } },
    { "paint", { "stroke" } },
    { "pixels", { "size" } },
    { "pos", { "at" } },
    { "position", { "at" } },
    { "quality", { "samples" } },
    { "radius", { "sigma", "size" } },
    { "rect", { "rectangle" } },
    { "resolution", { "--size", "size" } },
    { "rotation", { "turn", "rotate", "angle" } },
    { "scale", { "cells", "size" } },
    { "sharpness", { "hardness" } },
    { "size", { "radius", "cells" } },
    { "sky", { "environment", "background" } },
    { "smooth", { "blur" } },
    { "softness", { "hardness", "size" } },
    { "spp", { "samples" } },
    { "strength", { "height" } },
    { "subtract", { "lower" } },
    { "sun", { "directional" } },
    { "texture", { "colour" } },
    { "tile", { "repeat", "replicate" } },
    { "tiles", { "repeat" } },
    { "tiling", { "repeat", "replicate" } },
    { "to", { "-o" } },
    { "transparency", { "opacity" } },
    { "type", { "--as", "mode", "kind" } },
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
    int edits = wr_text_distance(word, candidate);
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

bool wr_fail_word(WrError *err, const char *what, const char *word, WrWordList list,
                  const void *ctx)
{
    WrText names = { 0 }, near = { 0 };
    for (int i = 0; list(ctx, i); i++) wr_text_addf(&names, "%s%s", i ? ", " : "", list(ctx, i));
    if (wr_suggest(word, list, ctx, &near))
        wr_fail(err, "%s: did you mean %s? It must be one of %s", what, wr_text_get(&near),
                wr_text_get(&names));
    else wr_fail(err, "%s: must be one of %s", what, wr_text_get(&names));
    wr_text_fini(&near);
    wr_text_fini(&names);
    return false;
}
