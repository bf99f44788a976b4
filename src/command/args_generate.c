/* Arguments of the generators: their parameters' rows as arguments, and what they all share. */
#include "command/args.h"
#include "command/generate.h"
#include "document/blend.h"

#include <string.h>

static const char *const off_on[] = { "off", "on", NULL };

static const char *blend_name(int i)
{
    return i < WR_BLEND_COUNT ? wr_blends[i].name : NULL;
}

const char *wr_generator_argument(const WrGenerator *generator, const char *plain)
{
    static const char *const names[][2] = { { "blend", "blend-mode" },
                                            { "radius", "blend-radius" },
                                            { "offset", "blend-offset" } };
    int k = 0;
    while (strcmp(names[k][0], plain) != 0) k++;
    return names[k][wr_generator_param_find(generator, plain) >= 0];
}

static WrArgSpec argument(const WrParam *p)
{
    WrArgSpec spec = { .name = p->name,
                       .type = WR_ARG_NUMBER,
                       .positional = p->positional,
                       .low = p->low,
                       .high = p->high,
                       .above = p->above,
                       .shape = p->shape,
                       .unit = p->unit && *p->unit ? p->unit : NULL,
                       .help = p->help };
    switch (p->kind) {
    case WR_PARAM_NUMBER: spec.fallback = p->fallback; break;
    case WR_PARAM_WHOLE:
        spec.whole = true;
        spec.fallback = p->fallback;
        break;
    case WR_PARAM_CHOICE:
    case WR_PARAM_SWITCH:
        spec.type = WR_ARG_CHOICE;
        spec.words = p->kind == WR_PARAM_CHOICE ? p->words : off_on;
        spec.fallback_text = spec.words[(int)p->fallback[0]];
        break;
    case WR_PARAM_TUPLE:
        spec.type = WR_ARG_TUPLE;
        spec.components = p->components;
        spec.fallback = p->fallback;
        break;
    case WR_PARAM_POINTS:
        spec.type = WR_ARG_LIST;
        spec.components = 2;
        spec.rows_low = 1;
        spec.rows_high = WR_GENERATOR_POINTS;
        if (!spec.shape) spec.shape = "u,v;...";
        break;
    case WR_PARAM_TERMS:
        spec.type = WR_ARG_LIST;
        spec.required = true;
        spec.components = p->components;
        spec.parts = p->parts;
        spec.counts = TUPLE_OF(p->fewest) | TUPLE_OF(p->components);
        spec.rows_low = 1;
        spec.rows_high = WR_TERMS_MAX;
        break;
    case WR_PARAM_TEXT:
    case WR_PARAM_FILE:
        spec.type = p->kind == WR_PARAM_TEXT ? WR_ARG_TEXT : WR_ARG_PATH;
        spec.may_be_empty = p->kind == WR_PARAM_TEXT;
        spec.required = !p->fallback_text;
        spec.fallback_text = p->fallback_text;
        break;
    }
    return spec;
}

/* The first file's is sha256, those of others have their names and come before it (wr_call_hash_name). */
static int add_checksums(const WrGenerator *g, WrArgSpec *out)
{
    static const char *const others[][2] = { { "fallback", "fallback_sha256" },
                                             { "fallback2", "fallback2_sha256" },
                                             { "fallback3", "fallback3_sha256" } };
    int count = 0;
    bool any = false;
    for (int i = 0; g->params[i].name; i++) {
        if (g->params[i].kind != WR_PARAM_FILE) continue;
        any = true;
        for (size_t k = 0; k < sizeof others / sizeof *others; k++)
            if (strcmp(g->params[i].name, others[k][0]) == 0)
                out[count++] = (WrArgSpec){ .name = others[k][1],
                                            .type = WR_ARG_SHA256,
                                            .help = "of that file" };
    }
    if (any)
        out[count++] = (WrArgSpec){ .name = "sha256",
                                    .type = WR_ARG_SHA256,
                                    .help = "of the file: another content is then an error" };
    return count;
}

static int add_shared(const WrGenerator *g, WrArgSpec *out)
{
    static const double radius[] = { 0.1 }, offset[] = { 0.0 };
    int count = 0;
    out[count++] = (WrArgSpec){ .name = wr_generator_argument(g, "blend"),
                                .type = WR_ARG_CHOICE,
                                .choice = blend_name,
                                .fallback_text = g->blend,
                                .help = "how it joins what is there" };
    out[count++] = (WrArgSpec){ .name = wr_generator_argument(g, "radius"),
                                .type = WR_ARG_NUMBER,
                                .low = 0,
                                .high = WR_BIG_HEIGHT,
                                .fallback = radius,
                                .unit = "table units",
                                .help = "of the smooth ways to join" };
    out[count++] = (WrArgSpec){ .name = wr_generator_argument(g, "offset"),
                                .type = WR_ARG_NUMBER,
                                .low = -WR_BIG_HEIGHT,
                                .high = WR_BIG_HEIGHT,
                                .fallback = offset,
                                .unit = "table units",
                                .help = "added to its heights first" };
    return count + add_checksums(g, out + count);
}

/* One form a row of the family. */
static bool form_of(const WrGenerator *rows, int index, WrForm *out)
{
    for (int i = 0; i < index; i++)
        if (!rows[i].family) return false;
    const WrGenerator *g = &rows[index];
    if (!g->family) return false;
    int count = wr_generator_param_count(g);
    *out = (WrForm){ .name = g->name, .help = g->help };
    for (int i = 0; i < count; i++) out->args[i] = argument(&g->params[i]);
    add_shared(g, out->args + count);
    return true;
}

bool wr_form_pattern(int i, WrForm *out)
{
    return form_of(wr_patterns, i, out);
}

bool wr_form_noise(int i, WrForm *out)
{
    return form_of(wr_noise_rows, i, out);
}

bool wr_form_formula(int i, WrForm *out)
{
    return form_of(wr_formula_rows, i, out);
}

bool wr_form_solid(int i, WrForm *out)
{
    return form_of(wr_solids, i, out);
}

bool wr_form_terrain(int i, WrForm *out)
{
    return form_of(wr_terrains, i, out);
}

bool wr_form_picture(int i, WrForm *out)
{
    return form_of(wr_picture_rows, i, out);
}

bool wr_row_text(WrForm *out)
{
    return form_of(wr_text_rows, 0, out);
}
