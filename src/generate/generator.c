#include "generate/generator.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/text.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

/* Order of menus and help. `beyond`: the heights continue outside the selection, since the generator uses it as its shape. */
const WrFamily wr_families[] = {
    { .name = "pattern",
      .label = "Patterns",
      .help = "generate bricks, tiles, cloth, cells and other patterns",
      .example = "pattern bricks across=4 rows=10 joint=5",
      .rows = wr_patterns },
    { .name = "noise",
      .label = "Noise",
      .help = "generate sums of value, gradient or simplex noise",
      .example = "noise perlin cells=6 octaves=5",
      .rows = wr_noise_rows },
    { .name = "formula",
      .label = "Formulas",
      .help = "generate a polynomial or a Fourier series",
      .example = "formula fourier terms=3,0,0.5;0,5,0.25,90,0",
      .rows = wr_formula_rows },
    { .name = "text",
      .label = "Text",
      .help = "letters of any font",
      .example = "text Wrinkle",
      .rows = wr_text_rows },
    { .name = "rim",
      .label = "Edges",
      .help = "bevels, cords and steps along the edge of the selection",
      .example = "rim kind=round width=8",
      .rows = wr_rim_rows,
      .beyond = true },
    { .name = "solid",
      .label = "Solids",
      .help = "solids seen from above by a Z-buffer",
      .example = "solid sphere",
      .rows = wr_solids },
    { .name = "terrain",
      .label = "Terrain",
      .help = "mountains, and their erosion by weather",
      .example = "terrain fractal cells=3",
      .rows = wr_terrains },
    { .name = "picture",
      .label = "Pictures",
      .help = "convert pictures and normal maps to heights",
      .example = "picture normals FILE",
      .rows = wr_picture_rows },
    { .name = NULL },
};

void wr_relief_fini(WrRelief *relief)
{
    wr_field_free(relief->heights);
    wr_field_free(relief->cover);
    *relief = (WrRelief){ NULL, NULL };
}

const WrFamily *wr_family_find(const char *name)
{
    for (const WrFamily *f = wr_families; f->name; f++)
        if (strcmp(f->name, name) == 0) return f;
    return NULL;
}

const WrGenerator *wr_generator_find(const char *family, const char *name)
{
    const WrFamily *f = wr_family_find(family);
    for (const WrGenerator *g = f ? f->rows : NULL; g && g->family; g++)
        if (name && g->name ? strcmp(g->name, name) == 0 : name == g->name) return g;
    return NULL;
}

int wr_generator_param_count(const WrGenerator *generator)
{
    int count = 0;
    while (generator->params[count].name) count++;
    return count;
}

int wr_generator_param_find(const WrGenerator *generator, const char *name)
{
    for (int i = 0; generator->params[i].name; i++)
        if (strcmp(generator->params[i].name, name) == 0) return i;
    return -1;
}

void wr_generator_defaults(const WrGenerator *generator, WrParamValue *values)
{
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        values[i] = (WrParamValue){ .text = p->fallback_text };
        memcpy(values[i].number, p->fallback, sizeof p->fallback);
    }
}

/* ---- checks ---- */

static void add_title(WrText *text, const WrGenerator *g)
{
    wr_text_add(text, g->family);
    if (g->name) wr_text_addf(text, " %s", g->name);
}

/* "pattern bricks: joint=-1: must be a number, 0..16384 texels" */
static bool fail_number(const WrGenerator *g, const WrParam *p, const WrParamPart *part,
                        double value, WrError *err)
{
    WrText text = { 0 };
    add_title(&text, g);
    wr_text_addf(&text, ": %s", p->name);
    if (part) wr_text_addf(&text, ": %s", part->name);
    wr_text_add(&text, "=");
    wr_text_add_number(&text, value);
    bool whole = part ? part->whole : p->kind == WR_PARAM_WHOLE, above = !part && p->above;
    WrText range = { 0 };
    wr_message_addf(&range, whole ? "a whole number, " : "a number, ");
    if (above) wr_message_addf(&range, "above ");
    wr_text_add_number(&range, part ? part->low : p->low);
    if (above) wr_message_addf(&range, ", up to ");
    else wr_text_add(&range, "..");
    wr_text_add_number(&range, part ? part->high : p->high);
    if (p->unit && *p->unit) wr_message_addf(&range, " %s", p->unit);
    wr_fail(err, "%s: must be %s", wr_text_get(&text), wr_text_get(&range));
    wr_text_fini(&range);
    wr_text_fini(&text);
    return false;
}

static bool fail_missing(const WrGenerator *g, const WrParam *p, WrError *err)
{
    WrText title = { 0 };
    add_title(&title, g);
    wr_fail(err, "%s: %s is missing: must be %s", wr_text_get(&title), p->name, p->help);
    wr_text_fini(&title);
    return false;
}

static bool fits(const WrParam *p, double value)
{
    if (!(value >= p->low && value <= p->high)) return false;
    if (p->above && value == p->low) return false;
    return p->kind != WR_PARAM_WHOLE || value == floor(value);
}

static bool check_numbers(const WrGenerator *g, const WrParam *p, const WrParamValue *value,
                          WrError *err)
{
    int count = p->kind == WR_PARAM_TUPLE ? p->components : 1;
    for (int i = 0; i < count; i++)
        if (!fits(p, value->number[i])) return fail_number(g, p, NULL, value->number[i], err);
    return true;
}

static bool check_word(const WrGenerator *g, const WrParam *p, const WrParamValue *value,
                       WrError *err)
{
    int count = 2;
    if (p->kind == WR_PARAM_CHOICE)
        for (count = 0; p->words[count];) count++;
    double x = value->number[0];
    if (x >= 0.0 && x < count && x == floor(x)) return true;
    const WrParam range = { .name = p->name, .kind = WR_PARAM_WHOLE, .high = count - 1 };
    return fail_number(g, &range, NULL, x, err);
}

static bool check_points(const WrGenerator *g, const WrParam *p, const WrParamValue *value,
                         WrError *err)
{
    if (value->count < 0 || value->count > WR_GENERATOR_POINTS)
        return wr_fail(err, "%s: %d points: must be 0..%d", p->name, value->count,
                       WR_GENERATOR_POINTS);
    for (int i = 0; i < 2 * value->count; i++)
        if (!fits(p, value->points[i])) return fail_number(g, p, NULL, value->points[i], err);
    return true;
}

static bool check_terms(const WrGenerator *g, const WrParam *p, const WrParamValue *value,
                        WrError *err)
{
    if (value->count < 1) return fail_missing(g, p, err);
    for (int i = 0; i < value->count * p->components; i++) {
        const WrParamPart *part = &p->parts[i % p->components];
        double x = value->points[i];
        if (!(x >= part->low && x <= part->high) || (part->whole && x != floor(x)))
            return fail_number(g, p, part, x, err);
    }
    return true;
}

static bool check(const WrGenerator *g, const WrParam *p, const WrParamValue *value, WrError *err)
{
    switch (p->kind) {
    case WR_PARAM_NUMBER:
    case WR_PARAM_WHOLE:
    case WR_PARAM_TUPLE: return check_numbers(g, p, value, err);
    case WR_PARAM_CHOICE:
    case WR_PARAM_SWITCH: return check_word(g, p, value, err);
    case WR_PARAM_POINTS: return check_points(g, p, value, err);
    case WR_PARAM_TERMS: return check_terms(g, p, value, err);
    case WR_PARAM_TEXT:
    case WR_PARAM_FILE: break;
    }
    /* a text or file whose fallback is "" is optional */
    return value->text || p->fallback_text ? true : fail_missing(g, p, err);
}

bool wr_generator_make(const WrGenerator *generator, const WrParamValue *values,
                       const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    for (int i = 0; generator->params[i].name; i++)
        if (!check(generator, &generator->params[i], &values[i], err)) return false;
    return generator->make(values, job, out, err);
}

/* ---- parameters ---- */

const WrParamValue *wr_param_value(const WrParams *params, const char *name)
{
    int i = 0;
    while (params->params[i].name && strcmp(params->params[i].name, name) != 0) i++;
    WR_ASSERT(params->params[i].name);
    return &params->values[i];
}

double wr_param_number(const WrParams *params, const char *name)
{
    return wr_param_value(params, name)->number[0];
}

int wr_param_whole(const WrParams *params, const char *name)
{
    return (int)wr_param_number(params, name);
}

uint32_t wr_param_seed(const WrParams *params)
{
    return (uint32_t)wr_param_number(params, "seed");
}

WrOrigin wr_origin(int size, double origin)
{
    double moved = (origin - floor(origin)) * size, whole = floor(moved + 0.5);
    return (WrOrigin){ .size = size, .shift = (int)whole % size, .rest = moved - whole };
}

bool wr_generate_layer(const WrGenerateJob *job, const char *name, const WrField **heights,
                       const WrField **cover, WrError *err)
{
    if (job->layer) return job->layer(job->layer_ctx, name, heights, cover, err);
    return wr_fail(err, "layer=%s: there are no layers here", name);
}
