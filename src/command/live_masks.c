/* Live masks: masks that keep the terms they come from, one row a kind. */
#include "command/live_masks.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/layer_times.h"
#include "field/field.h"
#include "field/measure.h"
#include "field/occlusion.h"
#include "field/ops.h"
#include "field/select.h"
#include "generate/generator.h"
#include "noise/octaves.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

/* The mask itself remains an ordinary field of the layer, so that composites, exports and other programs need to know
   nothing of terms. A term reads the composite of the layers below or one layer below, never above: there can be no
   cycle, and one pass from the bottom up makes everything that has changed. Painting on a live mask is refused: a mask
   painted on a layer below (which may be hidden) joins it as the term `mask of=NAME`, so that no second painted field is
   needed in files, memory and transforms. */

#define OF "of"

/* A part of a table, as a table. */
typedef struct Crop {
    const WrField *of;
    WrField *part;
} Crop;

typedef struct MaskJob {
    WrSession *session;
    int index;      /* of the masked layer */
    double relief;  /* height of one table unit in texels */
    WrField *below; /* composite of the layers below; owned; NULL: not needed yet */
    WrPool *pool;
    const WrFieldRect *block;      /* the only part to be made; NULL: the whole mask */
    int margin;                    /* of the block's inputs, texels */
    int at[2];                     /* the block's first texel in its inputs; output */
    Crop crops[2 * WR_MASK_TERMS]; /* of the block; owned */
    int crop_count;
} MaskJob;

/* ---- inputs ---- */

static const char *named_layer(const WrCall *term)
{
    for (int i = 0; i < term->count; i++)
        if (strcmp(term->specs[i].name, OF) == 0 && term->args[i].given) return term->args[i].text;
    return NULL;
}

int wr_mask_term_layer(const WrDocument *document, int index, const WrCall *term)
{
    const char *name = named_layer(term);
    return name ? wr_document_find_below(document, index, name) : -1;
}

int wr_mask_named(const WrDocument *document, int index, int named[WR_MASK_TERMS])
{
    const char *line = document->layers[index].mask_line;
    int count = 0;
    WrMaskTerms terms;
    if (!line || !strstr(line, OF "=") || !wr_mask_terms_parse(line, &terms, NULL)) return 0;
    for (int k = 0; k < terms.count; k++) {
        named[count] = wr_mask_term_layer(document, index, terms.calls[k]);
        count += named[count] >= 0;
    }
    wr_mask_terms_free(&terms);
    return count;
}

static bool takes_layer(const WrCall *term)
{
    bool takes = false;
    for (int i = 0; i < term->count; i++) takes |= strcmp(term->specs[i].name, OF) == 0;
    return takes;
}

/* The table, or the job's part of it with its margin. Borrowed. */
static const WrField *part_of(MaskJob *job, const WrField *field)
{
    if (!job->block) return field;
    for (int i = 0; i < job->crop_count; i++)
        if (job->crops[i].of == field) return job->crops[i].part;
    Crop *crop = &job->crops[job->crop_count++];
    *crop = (Crop){ field, wr_field_crop(field, job->block, job->margin, job->at) };
    return crop->part;
}

static const WrField *whole_heights(MaskJob *job, const WrCall *term)
{
    const WrDocument *document = job->session->state.document;
    const char *name = named_layer(term);
    if (name) return document->layers[wr_document_find_below(document, job->index, name)].heights;
    if (!job->below) job->below = wr_document_below(document, job->index, job->pool);
    return job->below;
}

static const WrField *heights_of(MaskJob *job, const WrCall *term)
{
    return part_of(job, whole_heights(job, term));
}

/* ---- kinds ---- */

/* The range of a measure is its mask: 1 from low= to high=, fading to 0 over soft=. Takes ownership of the measure. */
static WrField *in_range(const MaskJob *job, const WrCall *term, WrField *measure, WrError *err)
{
    WrField *made = measure ? wr_select_height(measure, wr_call_number(term, "low"),
                                               wr_call_number(term, "high"),
                                               wr_call_number(term, "soft"), job->pool, err)
                            : NULL;
    wr_field_free(measure);
    return made;
}

static WrField *by_height(MaskJob *job, const WrCall *term, WrError *err)
{
    return in_range(job, term, wr_field_share(heights_of(job, term)), err);
}

static WrField *by_slope(MaskJob *job, const WrCall *term, WrError *err)
{
    return wr_select_slope(heights_of(job, term), job->relief, wr_call_number(term, "low"),
                           wr_call_number(term, "high"), wr_call_number(term, "soft"), job->pool,
                           err);
}

static WrField *by_direction(MaskJob *job, const WrCall *term, WrError *err)
{
    return wr_select_facing(heights_of(job, term), wr_call_number(term, "angle"),
                            wr_call_number(term, "low"), wr_call_number(term, "high"),
                            wr_call_number(term, "soft"), job->pool, err);
}

static WrField *convexity(MaskJob *job, const WrCall *term, WrError *err)
{
    return wr_measure_convexity(heights_of(job, term), job->relief, wr_call_number(term, "scale"),
                                job->pool, err);
}

static WrField *by_curvature(MaskJob *job, const WrCall *term, WrError *err)
{
    const bool concave = wr_call_choice(term, "side") == 1;
    if (concave) job->relief = -job->relief; /* the curvature of heights turned over */
    WrField *measure = convexity(job, term, err);
    if (concave) job->relief = -job->relief;
    return in_range(job, term, measure, err);
}

static WrField *by_occlusion(MaskJob *job, const WrCall *term, WrError *err)
{
    return in_range(job, term,
                    wr_measure_sky(heights_of(job, term), job->relief,
                                   (int)wr_call_number(term, "reach"), job->pool, err),
                    err);
}

static void set_param(const WrGenerator *generator, WrParamValue *values, const char *name,
                      double value)
{
    values[wr_generator_param_find(generator, name)].number[0] = value;
}

/* The tiles of the job's part, as in WrGenerateJob; the caller frees them. NULL: all */
static uint8_t *wanted_tiles(const MaskJob *job, const WrField *like)
{
    const WrFieldRect *b = job->block;
    const int tiles_u = wr_field_tiles_u(like);
    if (!b) return NULL;
    uint8_t *wanted = wr_alloc((size_t)tiles_u * (size_t)wr_field_tiles_v(like), 1);
    for (int ty = b->j0 / WR_TILE; ty * WR_TILE < b->j1; ty++)
        for (int tx = b->i0 / WR_TILE; tx * WR_TILE < b->i1; tx++) wanted[ty * tiles_u + tx] = 1;
    return wanted;
}

/* The generator `noise perlin`: level + amplitude times noise. Of a part, its margin is not made. */
static WrField *noise(MaskJob *job, const WrCall *term, double amplitude, double level,
                      WrError *err)
{
    static const char *const same[] = { "cells", "octaves", "seed" };
    const WrGenerator *generator = wr_generator_find("noise", "perlin");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrRelief relief = { NULL, NULL };
    const WrField *like = job->session->state.document->layers[job->index].heights;
    uint8_t *wanted = wanted_tiles(job, like);
    const WrGenerateJob making = {
        .like = like, .wanted = wanted, .pool = job->pool, .progress = wr_progress_here()
    };
    wr_generator_defaults(generator, values);
    for (int i = 0; i < WR_LENGTH(same); i++)
        set_param(generator, values, same[i], wr_call_number(term, same[i]));
    set_param(generator, values, "amplitude", amplitude);
    set_param(generator, values, "level", level);
    const bool good = wr_generator_make(generator, values, &making, &relief, err);
    WrField *made = NULL;
    if (good && job->block) made = wr_field_crop(relief.heights, job->block, job->margin, job->at);
    else if (good) made = wr_field_share(relief.heights);
    wr_relief_fini(&relief);
    wr_free(wanted);
    return made;
}

static WrField *by_noise(MaskJob *job, const WrCall *term, WrError *err)
{
    const WrOpOptions options = { .pool = job->pool, .progress = wr_progress_here() };
    const double unit[] = { 0.0, 1.0 };
    WrField *made = noise(job, term, 0.5, 0.5, err);
    WrField *clamped = made ? wr_op_run(wr_op_find("clamp"), made, unit, &options, err) : NULL;
    wr_field_free(made);
    return in_range(job, term, clamped, err);
}

static WrField *by_wear(MaskJob *job, const WrCall *term, WrError *err)
{
    WrField *edges = convexity(job, term, err);
    WrField *rough = edges ? noise(job, term, wr_call_number(term, "rough"), 0.0, err) : NULL;
    WrField *both = rough ? wr_measure_join(edges, rough, WR_JOIN_ADD, job->pool, err) : NULL;
    wr_field_free(edges);
    wr_field_free(rough);
    return in_range(job, term, both, err);
}

static WrField *by_mask(MaskJob *job, const WrCall *term, WrError *err)
{
    (void)err;
    const WrDocument *document = job->session->state.document;
    const WrLayer *layer =
        &document->layers[wr_document_find_below(document, job->index, named_layer(term))];
    if (layer->mask) return wr_field_share(part_of(job, layer->mask));
    const WrField *f = part_of(job, layer->heights);
    return wr_field_new(wr_field_width(f), wr_field_height(f), wr_field_wrap_u(f),
                        wr_field_wrap_v(f), 1.0f, err);
}

/* ---- the table of kinds ---- */

#define NUMBER_ARG(name_, low_, high_, default_, help_)                                            \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .low = low_, .high = high_,                          \
        .fallback = NUMBERS(default_), .help = help_                                               \
    }
#define WHOLE_ARG(name_, low_, high_, default_, help_)                                             \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .whole = true, .low = low_, .high = high_,           \
        .fallback = NUMBERS(default_), .help = help_                                               \
    }
#define RANGE_ARGS(least, most, low_, high_, soft_, measure)                                       \
    NUMBER_ARG("low", least, most, low_, "lower end of the range of " measure),                    \
        NUMBER_ARG("high", least, most, high_, "upper end of the range"),                          \
        NUMBER_ARG("soft", 0, WR_BIG_HEIGHT, soft_, "width of the fade beyond both ends")
#define OF_ARG(help_)                                                                              \
    {                                                                                              \
        .name = OF, .type = WR_ARG_LAYER, .help = help_                                            \
    }
#define SURFACE_ARG OF_ARG("a layer below whose heights count; left out, all layers below together")
#define SCALE_ARG                                                                                  \
    {                                                                                              \
        .name = "scale", .type = WR_ARG_NUMBER, .low = 0, .above = true, .high = 256,              \
        .fallback = NUMBERS(2), .unit = "texels", .help = "scale of the features, as a blur"       \
    }
#define NOISE_ARGS                                                                                 \
    WHOLE_ARG("cells", 1, 8192, 8, "of the noise, across the table"),                              \
        WHOLE_ARG("octaves", 1, WR_OCTAVES_MAX, 5, "largest number of octaves"),                   \
        WHOLE_ARG("seed", 0, 4294967295.0, 1, "any number: another noise")

static const char *const sides[] = { "convex", "concave", NULL };

typedef struct MaskKind {
    WrForm form;
    WrField *(*make)(MaskJob *job, const WrCall *term, WrError *err);
    bool scene; /* its measure depends on the scene's height */
    /* distance in texels up to which heights affect it, -1: unknown. NULL: 0 */
    int (*reach)(const WrCall *term);
} MaskKind;

#define SLOPE_REACH 4 /* of slopes and their differences, at clamped ends too */
#define WIDE_BLUR 16  /* wider blurs are approximated over the whole table */

static int slope_reach(const WrCall *term)
{
    (void)term;
    return SLOPE_REACH;
}

static int bend_reach(const WrCall *term)
{
    const double scale = wr_call_number(term, "scale");
    return scale > WIDE_BLUR ? -1 : (int)ceil(4.0 * scale) + 1 + SLOPE_REACH;
}

static int sky_reach(const WrCall *term)
{
    return (int)wr_call_number(term, "reach") + 1 + SLOPE_REACH;
}

static const MaskKind kinds[] = {
    { .form = { .name = "height",
                .help = "where heights lie in a range",
                .args = { RANGE_ARGS(-WR_BIG_HEIGHT, WR_BIG_HEIGHT, -WR_BIG_HEIGHT, WR_BIG_HEIGHT,
                                     0, "heights"),
                          SURFACE_ARG } },
      .make = by_height },
    { .form = { .name = "slope",
                .help = "where the slope lies in a range",
                .args = { RANGE_ARGS(0, 90, 0, 90, 0, "degrees"), SURFACE_ARG } },
      .make = by_slope,
      .scene = true,
      .reach = slope_reach },
    { .form = { .name = "direction",
                .help = "where the surface faces an azimuth; level places face none",
                .args = { NUMBER_ARG("angle", -360, 360, 90,
                                     "the azimuth, degrees anticlockwise from u, v up"),
                          RANGE_ARGS(0, 180, 0, 45, 45, "degrees away from it"), SURFACE_ARG } },
      .make = by_direction,
      .reach = slope_reach },
    { .form = { .name = "curvature",
                .help = "mean curvature of the heights blurred by scale, times scale; above 0 on "
                        "ridges",
                .args = { { .name = "side",
                            .type = WR_ARG_CHOICE,
                            .words = sides,
                            .fallback_text = "convex",
                            .help = "convex: ridges and edges; concave: grooves" },
                          SCALE_ARG,
                          RANGE_ARGS(-WR_BIG_HEIGHT, WR_BIG_HEIGHT, 0.1, 1000, 0.1, "curvatures"),
                          SURFACE_ARG } },
      .make = by_curvature,
      .scene = true,
      .reach = bend_reach },
    { .form = { .name = "occlusion",
                .help = "where the visible share of the sky lies in a range; below 1 in hollows "
                        "and on steep sides",
                .args = { { .name = "reach",
                            .type = WR_ARG_NUMBER,
                            .whole = true,
                            .low = 1,
                            .high = WR_OCCLUSION_FARTHEST,
                            .fallback = NUMBERS(32),
                            .unit = "texels",
                            .help = "distance within which heights hide the sky" },
                          RANGE_ARGS(0, 1, 0, 0.6, 0.3, "parts of the sky"),
                          SURFACE_ARG } },
      .make = by_occlusion,
      .scene = true,
      .reach = sky_reach },
    { .form = { .name = "wear",
                .help = "worn edges: curvature, as above, plus noise",
                .args = { SCALE_ARG,
                          NUMBER_ARG("rough", 0, 1000, 0.1, "how much the noise adds or takes"),
                          NOISE_ARGS,
                          RANGE_ARGS(-WR_BIG_HEIGHT, WR_BIG_HEIGHT, 0.15, 1000, 0.05, "their sum"),
                          SURFACE_ARG } },
      .make = by_wear,
      .scene = true,
      .reach = bend_reach },
    { .form = { .name = "noise",
                .help = "where noise, 0 to 1, lies in a range",
                .args = { NOISE_ARGS, RANGE_ARGS(0, 1, 0.55, 1, 0.1, "the noise") } },
      .make = by_noise },
    { .form = { .name = "mask",
                .help = "the mask of a layer below, such as a painted one; the layer may be hidden",
                .args = { { .name = OF,
                            .type = WR_ARG_LAYER,
                            .required = true,
                            .help = "the layer" } } },
      .make = by_mask },
};

static bool form_of_term(int i, WrForm *out)
{
    if (i >= WR_LENGTH(kinds)) return false;
    *out = kinds[i].form;
    return true;
}

static const char *const joins[] = { "multiply", "subtract", "max", NULL }; /* as in WrJoin */

static const WrArgSpec term_args[] = { { .name = "op",
                                         .type = WR_ARG_CHOICE,
                                         .words = joins,
                                         .fallback_text = "multiply",
                                         .help = "how it is combined with the terms before it" },
                                       { .name = "invert",
                                         .type = WR_ARG_CHOICE,
                                         .words = wr_off_on,
                                         .fallback_text = "off",
                                         .help = "on: 1 minus its value" },
                                       { 0 } };

/* A term has the syntax of a command with this row, without the command's name. */
#define TERM "mask"
static const WrCommand term_row = {
    .name = TERM, .form_word = "KIND", .form = form_of_term, .args = term_args
};

const char *wr_mask_kind(int i)
{
    return i < WR_LENGTH(kinds) ? kinds[i].form.name : NULL;
}

void wr_mask_kind_explain(int i, WrText *text)
{
    WrArgSpec specs[WR_ARGS_MAX];
    wr_text_add(text, kinds[i].form.help);
    const int count = wr_command_specs(&term_row, i, specs);
    for (int k = 0; k < count; k++) {
        WrText value = { 0 };
        wr_arg_fallback_print(&specs[k], &value);
        wr_text_addf(text, "%s%s=", k ? ", " : ": ", specs[k].name);
        if (value.length && fabs(specs[k].fallback ? *specs[k].fallback : 0.0) < WR_BIG_HEIGHT)
            wr_text_add(text, wr_text_get(&value));
        wr_text_fini(&value);
    }
}

/* ---- lines ---- */

void wr_mask_terms_free(WrMaskTerms *terms)
{
    for (int i = 0; i < terms->count; i++) wr_call_free(terms->calls[i]);
    terms->count = 0;
}

/* Length of a term: up to the next ; outside quotes. */
static size_t term_length(const char *p)
{
    bool quoted = false;
    size_t n = 0;
    for (; p[n] && (quoted || p[n] != ';'); n++) {
        if (p[n] == '"') quoted = !quoted;
        if (quoted && p[n] == '\\' && p[n + 1]) n++;
    }
    return n;
}

bool wr_mask_terms_parse(const char *line, WrMaskTerms *terms, WrError *err)
{
    *terms = (WrMaskTerms){ 0 };
    bool good = true;
    for (const char *p = line; good; p++) {
        const size_t length = term_length(p);
        char *words = wr_strndup(p, length);
        good = terms->count < WR_MASK_TERMS
                   ? wr_call_parse_words(&term_row, words, &terms->calls[terms->count], err)
                   : wr_fail(err, "a mask has up to %d terms", WR_MASK_TERMS);
        if (good) terms->count++;
        wr_free(words);
        p += length;
        if (!*p) break;
    }
    if (!good) wr_mask_terms_free(terms);
    return good;
}

void wr_mask_terms_print(const WrMaskTerms *terms, WrText *line)
{
    for (int i = 0; i < terms->count; i++) {
        WrText term = { 0 };
        wr_call_print(terms->calls[i], &term);
        wr_text_addf(line, "%s%s", i ? "; " : "", wr_text_get(&term) + sizeof TERM);
        wr_text_fini(&term);
    }
}

bool wr_check_mask_line(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    WrMaskTerms terms;
    if (strcmp(value, "off") == 0) return true;
    if (!wr_mask_terms_parse(value, &terms, err)) {
        wr_error_prefix(err, "%s=: ", name);
        return false;
    }
    wr_mask_terms_free(&terms);
    return true;
}

/* Names a layer by its name, since numbers change; it must be below. */
static bool name_layer(const WrSession *session, int index, WrCall *term, WrError *err)
{
    const WrDocument *document = session->state.document;
    const char *word = named_layer(term);
    if (!word && takes_layer(term) && index == 0)
        return wr_fail(err, "%s: layer 1 has no layers below that its mask could read",
                       term->form_name);
    if (!word) return true;
    int found = wr_document_find_below(document, index, word);
    if (found < 0 && !wr_session_find_layer(session, word, &found, err)) return false;
    WrText name = { 0 };
    wr_session_layer_name(session, found, &name);
    bool good = true;
    if (found >= index)
        good = wr_fail(err, "%s is not below layer %d: a live mask reads layers below its own",
                       wr_text_get(&name), index + 1);
    else if (wr_document_find_below(document, index, document->layers[found].name) != found)
        good =
            wr_fail(err, "%s has the name of another layer: rename it first", wr_text_get(&name));
    else if (strcmp(term->form_name, "mask") != 0 && !wr_layer_holds(&document->layers[found]))
        good = wr_fail(err, "%s is a filter layer or a group, which has no heights of its own",
                       wr_text_get(&name));
    else wr_call_set_text(term, OF, document->layers[found].name);
    wr_text_fini(&name);
    return good;
}

/* ---- making ---- */

static MaskJob job_of(WrSession *session, int index)
{
    const WrDocument *document = session->state.document;
    const WrScene *first = wr_scene_object(document->scene, 0);
    const double texels = fabs(first->height) * wr_field_width(document->layers[0].heights);
    /* the first object's height, so that choosing an object changes no mask; never 0 */
    return (MaskJob){ .session = session,
                      .index = index,
                      .relief = fmax(texels, 1e-30),
                      .pool = session->options.pool };
}

/* The table that a term reads; NULL: none. */
static const WrField *input_of(MaskJob *job, const WrCall *term)
{
    const WrDocument *document = job->session->state.document;
    if (!takes_layer(term)) return NULL;
    if (strcmp(term->form_name, "mask") != 0) return whole_heights(job, term);
    return document->layers[wr_document_find_below(document, job->index, named_layer(term))].mask;
}

/* Hash of the line and all that it reads. */
static WrHash read_hash(MaskJob *job, const WrMaskTerms *terms, const char *line)
{
    WrHash hash = wr_hash_bytes(line, strlen(line), (WrHash){ 0, 0 });
    const WrField *same = NULL;
    WrHash field = hash;
    for (int i = 0; i < terms->count; i++) {
        const WrCall *term = terms->calls[i];
        const WrField *f = input_of(job, term);
        if (f && f != same) field = wr_field_hash(f);
        if (f) {
            same = f;
            hash = wr_hash_bytes(&field, sizeof field, hash);
        }
        if (kinds[term->form].scene) hash = wr_hash_bytes(&job->relief, sizeof job->relief, hash);
    }
    return hash;
}

/* Join the terms in order. The first begins the mask: on 1 for multiply and subtract, on 0 for max. */
static WrField *make_mask(MaskJob *job, const WrMaskTerms *terms, WrError *err)
{
    WrPool *pool = job->pool;
    WrField *mask = NULL;
    for (int i = 0; i < terms->count; i++) {
        const WrCall *term = terms->calls[i];
        const WrJoin join = (WrJoin)wr_call_choice(term, "op");
        const bool first = i == 0;
        bool invert = wr_call_choice(term, "invert") == 1;
        /* its steps can be cancelled, but report no fraction: each would begin at 0 */
        WrProgressPart part;
        const double done = (double)i / terms->count;
        const WrProgress *whole = wr_progress_enter(&part, done, done);
        WrField *made = kinds[term->form].make(job, term, err), *joined = NULL;
        if (first && join == WR_JOIN_SUBTRACT) invert = !invert;
        if (made && invert) {
            WrField *other = wr_select_invert(made);
            wr_field_free(made);
            made = other;
        }
        if (made && first) joined = wr_field_share(made);
        else if (made) joined = wr_measure_join(mask, made, join, pool, err);
        wr_field_free(made);
        wr_field_free(mask);
        mask = joined;
        wr_progress_set(whole);
        if (!mask) return NULL;
    }
    if (wr_progress_report(1.0)) return mask;
    wr_fail(err, "cancelled");
    wr_field_free(mask);
    return NULL;
}

/* ---- masks made again near changes ---- */

static WrInputs inputs_of(MaskJob *job, const WrMaskTerms *terms, const char *line)
{
    WrInputs inputs = { .count = terms->count };
    inputs.values = wr_hash_bytes(line, strlen(line), (WrHash){ 0, 0 });
    inputs.values = wr_hash_bytes(&job->relief, sizeof job->relief, inputs.values);
    for (int i = 0; i < terms->count; i++) inputs.of[i] = input_of(job, terms->calls[i]);
    return inputs;
}

static int reach_of(const WrMaskTerms *terms)
{
    int most = 0;
    for (int i = 0; i < terms->count; i++) {
        const MaskKind *kind = &kinds[terms->calls[i]->form];
        const int reach = kind->reach ? kind->reach(terms->calls[i]) : 0;
        if (reach < 0) return -1;
        most = reach > most ? reach : most;
    }
    return most;
}

typedef struct Blocks {
    const MaskJob *job;
    const WrMaskTerms *terms;
    const WrFieldRect *block; /* [count] */
    int count, margin;
    WrField **made; /* [count] */
    int (*at)[2];   /* [count] */
} Blocks;

static void make_block(int index, int worker, void *ctx)
{
    (void)worker;
    Blocks *blocks = ctx;
    WrError err;
    MaskJob job = *blocks->job;
    job.pool = NULL;
    job.block = &blocks->block[index];
    job.margin = blocks->margin;
    blocks->made[index] = make_mask(&job, blocks->terms, &err);
    memcpy(blocks->at[index], job.at, sizeof job.at);
    for (int i = 0; i < job.crop_count; i++) wr_field_free(job.crops[i].part);
}

/* The mask before, with its blocks made again. NULL: cancelled, or out of memory. */
static WrField *make_blocks(Blocks *blocks, const WrField *before)
{
    blocks->made = wr_alloc((size_t)blocks->count + 1, sizeof *blocks->made);
    blocks->at = wr_alloc((size_t)blocks->count + 1, sizeof *blocks->at);
    bool good = wr_pool_run(blocks->job->pool, blocks->count, make_block, blocks);
    for (int k = 0; k < blocks->count; k++) good &= blocks->made[k] != NULL;
    WrField *mask = good ? wr_field_share(before) : NULL;
    for (int k = 0; k < blocks->count; k++) {
        if (good) wr_field_put_block(mask, &blocks->block[k], blocks->made[k], blocks->at[k]);
        wr_field_free(blocks->made[k]);
    }
    wr_free(blocks->made);
    wr_free(blocks->at);
    return mask;
}

/* Its present mask, made again near the changes of its inputs; NULL: it must be made whole. */
static WrField *make_changes(const MaskJob *job, const WrMaskTerms *terms, const WrInputs *inputs)
{
    const WrLayer *layer = &job->session->state.document->layers[job->index];
    const int reach = reach_of(terms);
    WrFieldRect *rects = NULL;
    Blocks blocks = { .job = job, .terms = terms, .margin = reach };
    if (!layer->mask || layer->mask_made != wr_field_key(layer->mask) ||
        !wr_made_from_changes(job->session->made_from, layer->mask_made, inputs, reach, &rects,
                              &blocks.count))
        return NULL;
    blocks.block = rects;
    WrField *mask = make_blocks(&blocks, layer->mask);
    wr_free(rects);
    return mask;
}

static bool put_mask(MaskJob *job, const WrMaskTerms *terms, const char *line, WrHash read,
                     WrError *err)
{
    WrSession *session = job->session;
    WrLayer *layer = &session->state.document->layers[job->index];
    const double began = wr_clock_seconds();
    const WrInputs inputs = inputs_of(job, terms, line);
    WrField *mask = make_changes(job, terms, &inputs);
    if (!mask) {
        mask = make_mask(job, terms, err);
        if (!mask) return false;
        wr_field_share_equal(mask, layer->mask, NULL);
    }
    wr_field_free(layer->mask);
    layer->mask = mask;
    char *kept = wr_strdup(line);
    wr_layer_set_mask_line(layer, kept, read);
    wr_made_from_note(&session->made_from, layer->mask_made, &inputs);
    wr_layer_time_note(layer->mask_made, wr_clock_seconds() - began, 0);
    wr_free(kept);
    return true;
}

bool wr_session_set_live_mask(WrSession *session, int index, const char *line, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    if (strcmp(line, "off") == 0) {
        if (!layer->mask_line)
            return wr_fail(err, "live=off: layer %d has no live mask", index + 1);
        if (!wr_session_make_all_layers(session, err)) return false;
        wr_layer_set_mask_line(layer, NULL, layer->mask_read);
        return true;
    }
    WrMaskTerms terms;
    if (!wr_mask_terms_parse(line, &terms, err)) return false;
    MaskJob job = job_of(session, index);
    bool good = true;
    for (int i = 0; good && i < terms.count; i++)
        good = name_layer(session, index, terms.calls[i], err);
    WrText text = { 0 };
    wr_mask_terms_print(&terms, &text);
    good = good && put_mask(&job, &terms, wr_text_get(&text),
                            read_hash(&job, &terms, wr_text_get(&text)), err);
    wr_text_fini(&text);
    wr_mask_terms_free(&terms);
    wr_field_free(job.below);
    return good;
}

/* ---- after each command ---- */

/* A number for the layers below, as far as the mask reads them, and the scene's height. */
static uint64_t seen_key(const MaskJob *job, const char *line)
{
    WrBelowKey key;
    wr_session_below_key(job->session->state.document, job->index, &key);
    const WrHash layers = strstr(line, OF "=") ? key.all : key.shown;
    return wr_hash_bytes(&job->relief, sizeof job->relief, layers).low | 1;
}

/* The first layer that the terms name and that is not below any more; NULL: all are. */
static const char *lost_layer(const MaskJob *job, const WrMaskTerms *terms)
{
    const WrDocument *document = job->session->state.document;
    for (int i = 0; i < terms->count; i++) {
        const char *name = named_layer(terms->calls[i]);
        if (name && wr_document_find_below(document, job->index, name) < 0) return name;
    }
    return NULL;
}

static bool follow_terms(WrSession *session, MaskJob *job, const WrMaskTerms *terms, WrError *err)
{
    const WrLayer *layer = &session->state.document->layers[job->index];
    const char *lost = lost_layer(job, terms);
    WrError why = { "" };
    if (lost) {
        wr_fail(&why, "no layer \"%s\" is below it", lost);
    } else {
        const WrHash read = read_hash(job, terms, layer->mask_line);
        if (wr_hash_equal(read, layer->mask_read) &&
            wr_field_key(layer->mask) == layer->mask_made) {
            const WrInputs inputs = inputs_of(job, terms, layer->mask_line);
            wr_made_from_note(&session->made_from, layer->mask_made, &inputs);
            return true;
        }
        if (put_mask(job, terms, layer->mask_line, read, &why)) return true;
    }
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    WrText name = { 0 };
    wr_session_note(session, "%s: its live mask stays as it is (%s)",
                    wr_session_layer_name(session, job->index, &name), wr_error_message(&why));
    wr_text_fini(&name);
    return true;
}

bool wr_session_follow_mask(WrSession *session, int index, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    if (!layer->mask) wr_layer_set_mask_line(layer, NULL, layer->mask_read);
    if (!layer->mask_line) return true;
    MaskJob job = job_of(session, index);
    const uint64_t key = seen_key(&job, layer->mask_line);
    WrMaskTerms terms;
    if ((layer->mask_seen == key && layer->mask_made == wr_field_key(layer->mask)) ||
        !wr_mask_terms_parse(layer->mask_line, &terms,
                             NULL)) /* of another version: the mask stays */
        return true;
    WrProgressPart part; /* the command itself is done */
    const WrProgress *whole = wr_progress_enter(&part, 1.0, 1.0);
    const bool good = follow_terms(session, &job, &terms, err);
    wr_progress_set(whole);
    if (good) layer->mask_seen = key;
    wr_mask_terms_free(&terms);
    wr_field_free(job.below);
    return good;
}

void wr_session_note_mask(WrSession *session, int index)
{
    const WrLayer *layer = &session->state.document->layers[index];
    WrMaskTerms terms;
    WrError why = { "" };
    WrText name = { 0 };
    if (!layer->mask_line) return;
    if (wr_mask_terms_parse(layer->mask_line, &terms, &why)) wr_mask_terms_free(&terms);
    else
        wr_session_note(session, "%s: its live mask stays as it is (%s)",
                        wr_session_layer_name(session, index, &name), wr_error_message(&why));
    wr_text_fini(&name);
}

char *wr_mask_line_renamed(const WrDocument *document, int of, const char *line, int index,
                           const char *name)
{
    WrMaskTerms terms;
    if (of <= index || !line || !wr_mask_terms_parse(line, &terms, NULL)) return NULL;
    bool names = false;
    for (int k = 0; k < terms.count; k++) {
        const char *word = named_layer(terms.calls[k]);
        if (!word || wr_document_find_below(document, of, word) != index) continue;
        wr_call_set_text(terms.calls[k], OF, name);
        names = true;
    }
    WrText renamed = { 0 };
    if (names) wr_mask_terms_print(&terms, &renamed);
    wr_mask_terms_free(&terms);
    return renamed.data;
}

void wr_session_rename_in_masks(WrSession *session, int index, const char *name)
{
    WrDocument *document = session->state.document;
    for (int i = index + 1; i < document->layer_count; i++) {
        WrLayer *layer = &document->layers[i];
        char *line = wr_mask_line_renamed(document, i, layer->mask_line, index, name);
        if (line) wr_layer_set_mask_line(layer, line, layer->mask_read);
        wr_free(line);
    }
}
