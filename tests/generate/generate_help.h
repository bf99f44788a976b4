/* generate_help.h - helpers of the generator tests. Include after test.h. */
#pragma once
#include "base/error.h"
#include "field/field.h"
#include "field/wrap.h"
#include "base/memory.h"
#include "generate/generator.h"

#include <math.h>
#include <string.h>

/* Joined notes of a job. */
typedef struct Said {
    char text[2000];
} Said;

static inline void hear(void *ctx, const char *text)
{
    Said *said = ctx;
    snprintf(said->text + strlen(said->text), sizeof said->text - strlen(said->text), "%s\n", text);
}

static inline WrField *table_of(int width, int height)
{
    return wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
}

/* The value of that parameter; it must be there. */
static inline WrParamValue *value_of(const WrGenerator *g, WrParamValue *values, const char *name)
{
    int i = wr_generator_param_find(g, name);
    if (i < 0) fail_msg("%s %s has no %s", g->family, g->name ? g->name : "", name);
    return &values[i];
}

/* Defaults, and a small formula for required parameters. */
static inline void usual_values(const WrGenerator *g, WrParamValue *values)
{
    static const double term[] = { 1, 2, 0.5, 30, 0 };
    wr_generator_defaults(g, values);
    for (int i = 0; g->params[i].name; i++)
        if (g->params[i].kind == WR_PARAM_TERMS)
            values[i] = (WrParamValue){ .points = term, .count = 1 };
}

/* Families that need files or fonts have separate tests. */
static inline bool stands_alone(const WrGenerator *g)
{
    for (int i = 0; g->params[i].name; i++)
        if ((g->params[i].kind == WR_PARAM_FILE || g->params[i].kind == WR_PARAM_TEXT) &&
            !g->params[i].fallback_text)
            return false;
    return true;
}

/* Run the generator, which must succeed; the caller frees the heights. Coverage is dropped. */
static inline WrField *made(const WrGenerator *g, const WrParamValue *values, const WrField *like,
                            WrPool *pool, bool coarse)
{
    WrError err = { "" };
    WrRelief relief = { NULL, NULL };
    WrGenerateJob job = { .like = like, .pool = pool, .coarse = coarse };
    if (!wr_generator_make(g, values, &job, &relief, &err))
        fail_msg("%s %s: %s", g->family, g->name ? g->name : "", err.text);
    wr_field_free(relief.cover);
    return relief.heights;
}

/* Run it with a list of settings: name, number, name, number, ..., NULL. */
typedef struct Setting {
    const char *name;
    double value;
} Setting;

static inline WrField *made_with(const char *family, const char *name, const Setting *settings,
                                 const WrField *like)
{
    const WrGenerator *g = wr_generator_find(family, name);
    WrParamValue values[WR_GENERATOR_PARAMS];
    assert_non_null(g);
    usual_values(g, values);
    for (; settings && settings->name; settings++)
        value_of(g, values, settings->name)->number[0] = settings->value;
    return made(g, values, like, NULL, false);
}

/* True if a[i - di, j + dj] (dj upwards) equals b[i, j] bit for bit. */
static inline bool is_rolled(const WrField *a, const WrField *b, int di, int dj)
{
    int w = wr_field_width(a), h = wr_field_height(a);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            int from_i = ((i - di) % w + w) % w, from_j = ((j + dj) % h + h) % h;
            if (!same_bits((double)wr_field_get(a, from_i, from_j), (double)wr_field_get(b, i, j)))
                return false;
        }
    return true;
}

static inline double largest_difference(const WrField *a, const WrField *b)
{
    double most = 0.0;
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            most = fmax(most, fabs((double)wr_field_get(a, i, j) - (double)wr_field_get(b, i, j)));
    return most;
}
