/* Generators: one command for each family, and the blending of their output into a layer. */
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "generate/generator.h"

#include <float.h>
#include <stdint.h>
#include <string.h>

/* ---- Blending of a generator's output into a layer ---- */

#define TEXELS (WR_TILE * WR_TILE)

#define BATCH 64 /* tiles processed in one parallel step */

/* Result of a layer tile. */
typedef enum Fate {
    STAYS,
    SHARED, /* shares the generated tile by reference */
    JOINED
} Fate;

typedef struct Joining {
    WrBlend blend;
    float radius;
    double offset;
    const WrField *heights, *weight; /* weight NULL: 1 everywhere */
    WrField *layer;
    WrPool *pool;
    int first; /* index of the batch's first tile */
    Fate fate[BATCH];
    float *out[BATCH];       /* output tiles */
    float (*result)[TEXELS]; /* [BATCH] */
} Joining;

static float bounded(double x)
{
    return x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : (float)x;
}

static float unit(float x)
{
    return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f;
}

static bool is_nothing(const WrField *weight, int tx, int ty)
{
    const float *tile = wr_field_tile(weight, tx, ty);
    if (!tile) return !(wr_field_level(weight) > 0.0f);
    for (int i = 0; i < TEXELS; i++)
        if (tile[i] > 0.0f) return false;
    return true;
}

typedef struct Place {
    int tx, ty;
    int columns, rows; /* part of a border tile inside the table */
} Place;

static Place place_of(const Joining *join, int index)
{
    int tiles_u = wr_field_tiles_u(join->layer), at = join->first + index;
    Place p = { .tx = at % tiles_u, .ty = at / tiles_u };
    int columns = wr_field_width(join->layer) - p.tx * WR_TILE;
    int rows = wr_field_height(join->layer) - p.ty * WR_TILE;
    p.columns = columns < WR_TILE ? columns : WR_TILE;
    p.rows = rows < WR_TILE ? rows : WR_TILE;
    return p;
}

/* Generated heights plus the base height; never -0. */
static void lift(const Joining *join, const Place *p, float *heights)
{
    const float *made = wr_field_tile(join->heights, p->tx, p->ty);
    float level = wr_field_level(join->heights);
    double offset = join->offset;
    for (int i = 0; i < TEXELS; i++)
        heights[i] = bounded((double)(made ? made[i] : level) + offset);
}

static void blend_tile(const Joining *join, const Place *p, const float *old, float *result)
{
    float heights[TEXELS], old_level = wr_field_level(join->layer);
    lift(join, p, heights);
    for (int i = 0; i < TEXELS; i++) result[i] = old ? old[i] : old_level;
    WrBlendTile tile = { .heights = heights, .cover_level = 1.0f, .mask_level = 1.0f };
    if (join->weight) {
        tile.mask = wr_field_tile(join->weight, p->tx, p->ty);
        tile.mask_level = wr_field_level(join->weight);
    }
    wr_blend_tile(join->blend, 1.0f, join->radius, &tile, TEXELS, result);
}

static bool differs(const Joining *join, const Place *p, const float *old, const float *result)
{
    float level[WR_TILE];
    for (int x = 0; x < WR_TILE; x++) level[x] = wr_field_level(join->layer);
    for (int y = 0; y < p->rows; y++)
        if (memcmp(result + y * WR_TILE, old ? old + y * WR_TILE : level,
                   (size_t)p->columns * sizeof *result) != 0)
            return true;
    return false;
}

/* True if the result equals the generated tile, so that it can be shared: it replaces the old one, and no height is
 * -0, which would become 0. */
static bool is_result(const Joining *join, const float *made)
{
    if (!made || join->weight || join->offset != 0.0 ||
        (join->blend != WR_BLEND_REPLACE && join->blend != WR_BLEND_MIX))
        return false;
    int minus = 0;
#pragma omp simd reduction(| : minus)
    for (int i = 0; i < TEXELS; i++) {
        int32_t bits;
        memcpy(&bits, &made[i], sizeof bits);
        minus |= bits == INT32_MIN;
    }
    return !minus;
}

/* Unchanged tiles stay shared with the old layer. */
static void judge_tile(int index, int worker, void *ctx)
{
    (void)worker;
    Joining *join = ctx;
    Place p = place_of(join, index);
    const float *made = wr_field_tile(join->heights, p.tx, p.ty);
    const float *old = wr_field_tile(join->layer, p.tx, p.ty);
    join->fate[index] = STAYS;
    if (join->weight && is_nothing(join->weight, p.tx, p.ty)) return;
    bool itself = is_result(join, made);
    if (!itself) blend_tile(join, &p, old, join->result[index]);
    if (differs(join, &p, old, itself ? made : join->result[index]))
        join->fate[index] = itself ? SHARED : JOINED;
}

static void write_tile(int index, int worker, void *ctx)
{
    (void)worker;
    const Joining *join = ctx;
    Place p = place_of(join, index);
    for (int y = 0; y < p.rows && join->out[index]; y++)
        memcpy(join->out[index] + y * WR_TILE, join->result[index] + y * WR_TILE,
               (size_t)p.columns * sizeof(float));
}

/* Serial: only this thread may change the tree of tiles. */
static void fetch_tiles(Joining *join, int count)
{
    for (int k = 0; k < count; k++) {
        Place p = place_of(join, k);
        bool whole = p.columns == WR_TILE && p.rows == WR_TILE;
        join->out[k] = NULL;
        if (join->fate[k] == SHARED) wr_field_tile_share(join->layer, join->heights, p.tx, p.ty);
        if (join->fate[k] == JOINED)
            join->out[k] =
                (whole ? wr_field_tile_fresh : wr_field_tile_write)(join->layer, p.tx, p.ty);
    }
}

static bool join_all(Joining *join, const WrProgress *progress, WrError *err)
{
    int tiles = wr_field_tiles_u(join->layer) * wr_field_tiles_v(join->layer);
    for (join->first = 0; join->first < tiles; join->first += BATCH) {
        if (!wr_progress_step(progress, (double)join->first / tiles))
            return wr_fail(err, "cancelled");
        int count = tiles - join->first < BATCH ? tiles - join->first : BATCH;
        if (!wr_pool_run(join->pool, count, judge_tile, join)) return wr_fail(err, "cancelled");
        fetch_tiles(join, count);
        if (!wr_pool_run(join->pool, count, write_tile, join)) return wr_fail(err, "cancelled");
    }
    return true;
}

/* Blend weight: coverage times selection. A new field, or NULL for 1 everywhere. */
static WrField *weight_of(const WrField *cover, const WrField *selection)
{
    if (!cover && !selection) return NULL;
    if (!cover || !selection) return wr_field_share(cover ? cover : selection);
    WrField *weight = wr_field_share(cover);
    float *row = wr_alloc((size_t)wr_field_width(cover), 2 * sizeof *row);
    int width = wr_field_width(cover);
    for (int j = 0; j < wr_field_height(cover) && !wr_progress_stopped(); j++) {
        wr_field_read(cover, 0, j, width, 1, row, (size_t)width);
        wr_field_read(selection, 0, j, width, 1, row + width, (size_t)width);
        for (int i = 0; i < width; i++) row[i] = unit(row[i]) * unit(row[width + i]);
        wr_field_write(weight, 0, j, width, 1, row, (size_t)width);
    }
    wr_free(row);
    return weight;
}

bool wr_call_join(const WrCall *call, const WrRelief *relief, const WrField *selection,
                  WrLayer *layer, WrPool *pool, const WrProgress *progress, WrError *err)
{
    float(*result)[TEXELS] = wr_try_alloc(BATCH, sizeof *result, "tiles to be joined", err);
    if (!result) return false;
    const WrGenerator *generator = wr_call_generator(call);
    WrField *weight =
        weight_of(relief->cover, wr_family_find(generator->family)->beyond ? NULL : selection);
    Joining joining = {
        .blend = (WrBlend)wr_call_choice(call, wr_generator_argument(generator, "blend")),
        .radius = (float)wr_call_number(call, wr_generator_argument(generator, "radius")),
        .offset = wr_call_number(call, wr_generator_argument(generator, "offset")),
        .heights = relief->heights,
        .weight = weight,
        .layer = layer->heights,
        .pool = pool,
        .result = result,
    };
    bool good = join_all(&joining, progress, err);
    if (good) wr_edit_mark(layer->cover, weight);
    wr_field_free(weight);
    wr_free(result);
    return good;
}

static WrField *empty_like(const WrField *field)
{
    return wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                        wr_field_wrap_v(field), 0.0f, NULL);
}

/* Modes that weigh a layer by its coverage need the heights themselves; the others need heights times coverage. Either
   way the composite is w * h blended into the layers below, as by the plain command. */
bool wr_call_lay(const WrCall *call, const WrRelief *relief, WrLayer *layer, WrPool *pool,
                 const WrProgress *progress, WrError *err)
{
    float(*result)[TEXELS] = wr_try_alloc(BATCH, sizeof *result, "tiles to be joined", err);
    if (!result) return false;
    const bool weighs = wr_blends[layer->blend].uses_cover;
    WrField *heights = empty_like(relief->heights);
    const char *offset = wr_generator_argument(wr_call_generator(call), "offset");
    Joining joining = { .blend = weighs ? WR_BLEND_REPLACE : WR_BLEND_ADD,
                        .offset = wr_call_number(call, offset),
                        .heights = relief->heights,
                        .weight = weighs ? NULL : relief->cover,
                        .layer = heights,
                        .pool = pool,
                        .result = result };
    const bool good = join_all(&joining, progress, err);
    wr_free(result);
    if (!good) {
        wr_field_free(heights);
        return false;
    }
    wr_field_free(layer->heights);
    wr_field_free(layer->cover);
    layer->heights = heights;
    layer->cover = relief->cover ? wr_field_share(relief->cover) : NULL;
    return true;
}

/* ---- One command for each generator family ---- */

const WrGenerator *wr_call_generator(const WrCall *call)
{
    const WrFamily *family = call->command ? wr_family_find(call->command->name) : NULL;
    return family ? &family->rows[call->form > 0 ? call->form : 0] : NULL;
}

void wr_call_values(const WrCall *call, const WrGenerator *generator, WrParamValue *values)
{
    wr_generator_defaults(generator, values);
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        const WrArg *arg = wr_call_arg(call, p->name);
        if (p->kind == WR_PARAM_CHOICE || p->kind == WR_PARAM_SWITCH) {
            values[i].number[0] = arg->choice;
        } else if (p->kind == WR_PARAM_POINTS || p->kind == WR_PARAM_TERMS) {
            values[i].points = arg->numbers;
            values[i].count = arg->rows;
        } else if (p->kind == WR_PARAM_TEXT || p->kind == WR_PARAM_FILE) {
            if (arg->text) values[i].text = arg->text;
        } else {
            int count = p->kind == WR_PARAM_TUPLE ? p->components : 1;
            memcpy(values[i].number, arg->numbers, (size_t)count * sizeof *arg->numbers);
        }
    }
}

/* ---- layers ---- */

WrArg *wr_call_layer_argument(const WrCall *call)
{
    const WrGenerator *generator = wr_call_generator(call);
    for (const WrParam *p = generator ? generator->params : NULL; p && p->name; p++) {
        WrArg *arg = p->layer ? wr_call_arg(call, p->name) : NULL;
        if (arg && arg->text && *arg->text) return arg;
    }
    return NULL;
}

bool wr_layers_below_find(void *ctx, const char *name, const WrField **heights,
                          const WrField **cover, WrError *err)
{
    const WrLayersBelow *below = ctx;
    const int i = wr_document_find_below(below->document, below->index, name);
    if (i < 0) return wr_fail(err, "layer=%s: no layer below has this name", name);
    *heights = below->document->layers[i].heights;
    *cover = below->document->layers[i].cover;
    return true;
}

/* ---- texts and files ---- */

char *wr_generator_text(const char *text)
{
    WrText out = { 0 };
    for (const char *p = text; *p; p++) {
        bool pair = *p == '\\' && (p[1] == 'n' || p[1] == '\\');
        if (pair) p++;
        wr_text_add_n(&out, pair && *p == 'n' ? "\n" : p, 1);
    }
    char *made = wr_strdup(wr_text_get(&out));
    wr_text_fini(&out);
    return made;
}

/* Check the line's checksum of a parameter's file, or set it. */
static bool check_file(WrCall *call, const char *param, const char *path, WrError *err)
{
    char hex[65];
    const char *name = wr_call_hash_argument(call, (int)(wr_call_arg(call, param) - call->args));
    return wr_input_sha256(path, hex, err) &&
           wr_call_check_sha256(call, name ? name : "sha256", path, hex, err);
}

/* Store a value chosen by the generator in the line. */
static bool keep_choice(void *ctx, const char *param, const char *value, WrError *err)
{
    WrCall *call = ctx;
    WrArg *arg = wr_call_arg(call, param);
    const WrArgSpec *spec = &call->specs[arg - call->args];
    if (spec->type == WR_ARG_CHOICE) {
        for (int i = 0; spec->words && spec->words[i]; i++) {
            if (strcmp(spec->words[i], value) != 0) continue;
            arg->choice = i;
            arg->given = true;
            return true;
        }
    } else {
        wr_call_set_text(call, param, value);
    }
    return check_file(call, param, value, err);
}

/* Resolve text escapes and file paths in the values: owned[i] if not NULL. */
static bool resolve(WrSession *session, WrCall *call, const WrGenerator *generator,
                    WrParamValue *values, char **owned, WrError *err)
{
    for (int i = 0; generator->params[i].name; i++) {
        WrParamKind kind = generator->params[i].kind;
        if (kind == WR_PARAM_TEXT && values[i].text) {
            values[i].text = owned[i] = wr_generator_text(values[i].text);
        } else if (kind == WR_PARAM_FILE && values[i].text && *values[i].text) {
            values[i].text = owned[i] = wr_session_input_path(session, values[i].text);
            if (!check_file(call, generator->params[i].name, owned[i], err)) return false;
        }
    }
    return true;
}

static void note(void *ctx, const char *text)
{
    wr_session_note(ctx, "%s", text);
}

bool wr_call_make(WrSession *session, WrCall *call, WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const WrGenerator *generator = wr_call_generator(call);
    WrParamValue values[WR_GENERATOR_PARAMS];
    char *owned[WR_GENERATOR_PARAMS] = { NULL };
    job->pool = session->options.pool;
    job->note = note;
    job->note_ctx = session;
    job->chose = keep_choice;
    job->chose_ctx = call;
    wr_call_values(call, generator, values);
    const bool good = resolve(session, call, generator, values, owned, err) &&
                      wr_generator_make(generator, values, job, out, err);
    for (int i = 0; i < WR_GENERATOR_PARAMS; i++) wr_free(owned[i]);
    return good;
}

static bool run_generate(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    WrProgressPart making, joining;
    const WrDocument *document = session->state.document;
    WrLayersBelow below = { document, document->active };
    WrGenerateJob job = { .like = layer->heights,
                          .layer = wr_layers_below_find,
                          .layer_ctx = &below,
                          .selection = document->selection,
                          .mask = document->layers[document->active].mask,
                          .progress = wr_progress_part(&making, wr_progress_here(), 0.0, 0.9) };
    WrRelief relief = { NULL, NULL };
    const bool good = wr_call_make(session, call, &job, &relief, err) &&
                      wr_call_join(call, &relief, document->selection, layer, job.pool,
                                   wr_progress_part(&joining, wr_progress_here(), 0.9, 1.0), err);
    wr_relief_fini(&relief);
    return good;
}

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
                       .also = p->also,
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
        spec.words = p->kind == WR_PARAM_CHOICE ? p->words : wr_off_on;
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

/* The first file's checksum is sha256=; further files have NAME_sha256=, placed before it (wr_call_hash_argument). */
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
                                            .help = "SHA-256 of that file" };
    }
    if (any)
        out[count++] =
            (WrArgSpec){ .name = "sha256",
                         .type = WR_ARG_SHA256,
                         .help = "SHA-256 of the file; a file with other content is an error" };
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
                                .help = "how the result is combined with the present heights" };
    out[count++] = (WrArgSpec){ .name = wr_generator_argument(g, "radius"),
                                .type = WR_ARG_NUMBER,
                                .low = 0,
                                .high = WR_BIG_HEIGHT,
                                .fallback = radius,
                                .unit = "table units",
                                .help = "radius of the smooth blends" };
    out[count++] = (WrArgSpec){ .name = wr_generator_argument(g, "offset"),
                                .type = WR_ARG_NUMBER,
                                .low = -WR_BIG_HEIGHT,
                                .high = WR_BIG_HEIGHT,
                                .fallback = offset,
                                .unit = "table units",
                                .help = "added to the result before it is combined" };
    return count + add_checksums(g, out + count);
}

/* One form for each row of the family. */
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

static bool form_pattern(int i, WrForm *out)
{
    return form_of(wr_patterns, i, out);
}

static bool form_noise(int i, WrForm *out)
{
    return form_of(wr_noise_rows, i, out);
}

static bool form_formula(int i, WrForm *out)
{
    return form_of(wr_formula_rows, i, out);
}

static bool form_solid(int i, WrForm *out)
{
    return form_of(wr_solids, i, out);
}

static bool form_terrain(int i, WrForm *out)
{
    return form_of(wr_terrains, i, out);
}

static bool form_picture(int i, WrForm *out)
{
    return form_of(wr_picture_rows, i, out);
}

static bool row_rim(WrForm *out)
{
    return form_of(wr_rim_rows, 0, out);
}

static bool row_text(WrForm *out)
{
    return form_of(wr_text_rows, 0, out);
}

/* ---- the rows ---- */

const WrCommand wr_command_pattern = {
    .name = "pattern",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_pattern,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "generate bricks, tiles, cloth, cells and other patterns",
    .details = "Patterns tile at the table's edges; origin= shifts them. The result is combined "
               "with the active layer inside the selection by blend=: replace, unless the list "
               "below gives another default.",
    .example = "pattern bricks across=4 rows=10 joint=5"
};

const WrCommand wr_command_noise = {
    .name = "noise",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_noise,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "generate sums of value, gradient or simplex noise",
    .details =
        "Heights become level + amplitude N, where N is the sum of octaves of ratio^-i noise. "
        "Octave i has cells step^i cells, rounded, so that every octave tiles. Octaves that would "
        "alias are left out. `wrinkle inspect --noise` prints N at any point.",
    .example = "noise perlin cells=6 octaves=5 amplitude=0.3"
};

const WrCommand wr_command_formula = {
    .name = "formula",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_formula,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "generate a polynomial or a Fourier series",
    .details = "The function of `analytic`, as heights that can be painted on.",
    .example = "formula fourier terms=3,0,0.5;0,5,0.25,90,0"
};

const WrCommand wr_command_text = {
    .name = "text",
    .kind = WR_CLASS_EDIT,
    .row = row_text,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "write letters of any font and script in relief",
    .details = "The letters are added to the active layer unless blend= is given. \\\\n in quotes "
               "starts a new line. Overlapping letters are one shape.",
    .example = "text Wrinkle font=serif size=90 profile=round bevel=6"
};

const WrCommand wr_command_rim = {
    .name = "rim",
    .kind = WR_CLASS_EDIT,
    .row = row_rim,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "bevel, round, ridge, outline or emboss along an edge",
    .details = "The edge is where the selection or the layer's mask is 1/2, or where the layer's "
               "heights cross a level. The result is not limited to the selection.",
    .example = "rim kind=round width=8"
};

const WrCommand wr_command_solid = {
    .name = "solid",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_solid,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "add solids, letters and meshes seen from above (Z-buffer)",
    .details = "Solids stand on the ground, which hides everything below height 0, and are "
               "combined with the active layer by max unless blend= is given. across= and rows= "
               "place copies on a lattice that tiles exactly.",
    .example = "solid sphere across=8 rows=8 radius=16"
};

const WrCommand wr_command_terrain = {
    .name = "terrain",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_terrain,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "generate mountains, load real elevations, erode them",
    .details = "fractal and elevation make ground; hydraulic, thermal and terraces change the "
               "active layer. Erosion only moves ground: the mean height stays.",
    .example = "terrain hydraulic rain=2"
};

const WrCommand wr_command_picture = {
    .name = "picture",
    .kind = WR_CLASS_EDIT,
    .form_word = "KIND",
    .form = form_picture,
    .run = run_generate,
    .generates = true,
    .prework = WR_PREWORK_TABLES,
    .help = "convert pictures and normal maps to heights",
    .details = "photo uses the brightness of a picture, made seamless; normals integrates a normal "
               "map, and detects whether its green points up or down.",
    .example = "picture normals rock_normal.png height=0.1"
};
